# The binary interface: what the libraries export, what they need, and the types of the interface against what was recorded of
# the last release. Also the installed tree as outside projects see it, the manual and the snippets of docs/embedding.md.
set(libraries ogive ogive_io ogive_geometry)

ogive_add_check(Abi.ExportsAreTheHeadersFunctionsAndNothingElse ${CMAKE_CURRENT_SOURCE_DIR}/exports.py ${PROJECT_SOURCE_DIR}
                $<TARGET_FILE:ogive> $<TARGET_FILE:ogive_io> $<TARGET_FILE:ogive_geometry>)

find_program(OGIVE_ABIDIFF abidiff)
if(OGIVE_ABIDIFF)
  # The interface's translation unit of each library with debug information, which a release has not.
  set(ogive_unit ${PROJECT_SOURCE_DIR}/capi/ogive.cpp)
  set(ogive_io_unit ${PROJECT_SOURCE_DIR}/capi/ogive_io.cpp)
  set(ogive_geometry_unit ${PROJECT_SOURCE_DIR}/geometry/ogive_geometry.cpp)
  set(ogive_symbols ${PROJECT_SOURCE_DIR}/capi/exported_symbols.txt)
  set(ogive_io_symbols ${PROJECT_SOURCE_DIR}/capi/exported_symbols_io.txt)
  set(ogive_geometry_symbols ${PROJECT_SOURCE_DIR}/geometry/exported_symbols.txt)
  foreach(library ${libraries})
    add_library(${library}_abi SHARED ${${library}_unit})
    target_compile_definitions(${library}_abi PRIVATE OGIVE_BUILDING)
    target_compile_options(${library}_abi PRIVATE -g -O0)
    target_include_directories(${library}_abi PRIVATE ${PROJECT_SOURCE_DIR}/capi ${PROJECT_SOURCE_DIR}/geometry
                               ${PROJECT_SOURCE_DIR}/lib ${PROJECT_SOURCE_DIR}/lib/io)
    target_link_options(${library}_abi PRIVATE LINKER:--version-script=${${library}_symbols}
                                               LINKER:--unresolved-symbols=ignore-all)
    set_target_properties(${library}_abi PROPERTIES OUTPUT_NAME ${library} VERSION ${PROJECT_VERSION}
                          SOVERSION ${PROJECT_VERSION_MAJOR} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/abi)
    ogive_add_check(Abi.${library}_HasAllOf010 ${CMAKE_CURRENT_SOURCE_DIR}/abi.py ${OGIVE_ABIDIFF} ${PROJECT_SOURCE_DIR}
                    ${CMAKE_CURRENT_SOURCE_DIR}/abi/lib${library}-0.1.0.abi $<TARGET_FILE:${library}_abi>)
  endforeach()
else()
  message(STATUS "tests of the ABI are left out: abidiff (package abigail-tools) is not installed")
endif()

find_program(OGIVE_DOXYGEN doxygen)
if(OGIVE_DOXYGEN)
  ogive_add_check(Manual.DoxygenHasNothingToSay ${CMAKE_CURRENT_SOURCE_DIR}/manual.py ${OGIVE_DOXYGEN} ${PROJECT_SOURCE_DIR}
                  ${CMAKE_CURRENT_BINARY_DIR}/manual)
endif()

if(TARGET ogive_driver AND TARGET ogive_fortran AND OGIVE_INSTALL)
  # Configures, builds and runs outside projects: a minute in all, most of it the engine inside another project.
  ogive_add_check(Consumers.BuildAgainstTheInstalledTreeAndRun ${PROJECT_SOURCE_DIR}/tests/consumer/run.py ${PROJECT_SOURCE_DIR}
                  ${PROJECT_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR}/consumer)
  ogive_add_check(Consumers.BuildTheEngineAsASubdirectory ${PROJECT_SOURCE_DIR}/tests/consumer/subdirectory.py
                  ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/subdirectory)
  ogive_add_check(Embedding.EverySnippetCompilesAndRuns ${CMAKE_CURRENT_SOURCE_DIR}/snippets.py ${PROJECT_SOURCE_DIR}
                  ${PROJECT_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR}/snippets)
  set_tests_properties(capi.Embedding.EverySnippetCompilesAndRuns PROPERTIES TIMEOUT 300)
endif()
