# The example hosts: the same case from the program, C and Fortran to the last digit; the spring's conservation.
if(TARGET example_spring_coupling AND NOT OGIVE_SANITIZE)
  ogive_add_check(Hosts.ASpringConservesEnergyAndMomentumAcrossTheInterface example_spring_coupling)
endif()
if(TARGET example_thick_plate AND TARGET ogive_driver AND NOT OGIVE_SANITIZE)
  set(hosts $<TARGET_FILE:example_thick_plate>)
  if(TARGET example_thick_plate_fortran)
    list(APPEND hosts $<TARGET_FILE:example_thick_plate_fortran>)
  endif()
  ogive_add_check(Hosts.ThickPlateFromCAndFortranIsTheProgramsToTheLastDigit
                  ${CMAKE_CURRENT_SOURCE_DIR}/same_result.py ${PROJECT_SOURCE_DIR}/examples/scenes/thick_plate ${scratch}
                  $<TARGET_FILE:ogive_driver> ${hosts})
endif()

# The Fortran interfaces are what the headers say, and lay out structs as the C compiler does.
ogive_add_check(Fortran.InterfacesAreWhatTheHeadersSay ${PROJECT_SOURCE_DIR}/tools/fortran_bindings.py --check)
if(OGIVE_FORTRAN)
  set(layout ${CMAKE_CURRENT_BINARY_DIR}/layout)
  add_custom_command(OUTPUT ${layout}/layout.c ${layout}/layout.f90
                     COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/layout.py ${PROJECT_SOURCE_DIR} ${layout}
                     DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/layout.py ${PROJECT_SOURCE_DIR}/tools/c_header.py
                             ${PROJECT_SOURCE_DIR}/capi/ogive.h ${PROJECT_SOURCE_DIR}/geometry/ogive_geometry.h)
  add_executable(ogive_layout_c ${layout}/layout.c)
  target_link_libraries(ogive_layout_c PRIVATE ogive ogive_geometry)
  add_executable(ogive_layout_fortran ${layout}/layout.f90)
  target_link_libraries(ogive_layout_fortran PRIVATE ogive_fortran)
  ogive_add_check(Fortran.StructsAreLaidOutAsInC ${CMAKE_CURRENT_SOURCE_DIR}/same_output.py $<TARGET_FILE:ogive_layout_c>
                  $<TARGET_FILE:ogive_layout_fortran>)
  add_executable(ogive_fortran_test fortran_test.f90)
  target_link_libraries(ogive_fortran_test PRIVATE ogive_fortran ogive ogive_io ogive_flags)
  # message() only reads: it does not matter whether it is evaluated.
  target_compile_options(ogive_fortran_test PRIVATE $<$<Fortran_COMPILER_ID:GNU>:-Wno-function-elimination>)
  ogive_add_check(Fortran.WrappersDoWhatTheInterfaceDoes ogive_fortran_test ${scratch})
endif()
