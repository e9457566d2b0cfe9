! Perforation of a thick aluminium plate by an ogive-nosed rod: examples/scenes/thick_plate on a coarse grid, from a Fortran host.
!
!   thick_plate PATH/TO/rod.stl
!
! Units mm, ms, g. Prints the residual velocity to the last digit: the same as examples/c/thick_plate.c and the program ogive.
program thick_plate
  use, intrinsic :: iso_c_binding, only: c_double
  use, intrinsic :: iso_fortran_env, only: error_unit
  use ogive
  use ogive_geometry, only: fill_surface
  implicit none

  real(c_double), parameter :: pi = 3.14159265358979323846_c_double, obliquity = 30*(pi/180), speed = 575
  type(ogive_simulation) :: simulation
  type(ogive_material_def) :: steel_def, aluminium_def
  type(ogive_material_id) :: steel, aluminium
  type(ogive_body_id) :: rod, plate
  type(ogive_body_result) :: initial, final
  real(c_double), allocatable, target :: positions(:, :), volumes(:)
  real(c_double) :: direction(3), residual
  character(len=:), allocatable :: reason
  character(len=1024) :: path
  integer(c_int32_t) :: status

  call get_command_argument(1, path)
  if (path == "") call fail("usage: thick_plate PATH/TO/rod.stl")
  direction = [sin(obliquity), 0.0_c_double, cos(obliquity)]

  call simulation%create()
  call simulation%set_grid(4.0_c_double, [-100.0_c_double, 0.0_c_double, -120.0_c_double], &
                           [160.0_c_double, 60.0_c_double, 160.0_c_double], &
                           face=[OGIVE_FACE_FREE, OGIVE_FACE_FREE, OGIVE_FACE_SYMMETRY, OGIVE_FACE_FREE, &
                                 OGIVE_FACE_FREE, OGIVE_FACE_FREE])
  call check()
  call simulation%set_numerics(time_step_factor=0.5_c_double)
  call check()

  steel_def = material(7.85e-3_c_double)
  steel_def%youngs_modulus = 200e3_c_double
  steel_def%poisson_ratio = 0.3_c_double
  call simulation%add_material("steel", steel_def, steel)
  call check()
  aluminium_def = material(2.70e-3_c_double)
  aluminium_def%strength = OGIVE_STRENGTH_JOHNSON_COOK
  aluminium_def%eos = OGIVE_EOS_MIE_GRUNEISEN
  aluminium_def%failure = OGIVE_FAILURE_PLASTIC_STRAIN
  aluminium_def%youngs_modulus = 69e3_c_double
  aluminium_def%poisson_ratio = 0.3_c_double
  aluminium_def%yield_stress = 262
  aluminium_def%hardening_modulus = 52.1_c_double
  aluminium_def%hardening_exponent = 0.41_c_double
  aluminium_def%thermal_exponent = 0.859_c_double
  aluminium_def%melt_temperature = 875
  aluminium_def%room_temperature = 293
  aluminium_def%specific_heat = 896
  aluminium_def%eos_sound_speed = 5350
  aluminium_def%eos_slope = 1.34_c_double
  aluminium_def%gruneisen = 2
  aluminium_def%failure_strain = 1.6_c_double
  call simulation%add_material("aluminium", aluminium_def, aluminium)
  call check()

  call fill_surface(path, [1.24_c_double, 1.24_c_double, 2.0_c_double], positions, volumes, status, reason, &
                    axis=direction, position=[0.0_c_double, 0.0_c_double, -4.0_c_double])
  if (status /= OGIVE_OK) call fail(reason)
  call simulation%add_particles("rod", steel, positions, volumes, velocity=speed*direction, body=rod)
  call check()
  call simulation%add_solid("plate", aluminium, OGIVE_SOLID_BOX, [120.0_c_double, 120.0_c_double, 26.3_c_double], &
                            [2.0_c_double, 2.0_c_double, 2.0_c_double], &
                            centre=[10.0_c_double, 0.0_c_double, 13.15_c_double], body=plate)
  call check()
  call simulation%set_contact(method=OGIVE_CONTACT_HUANG_SECOND, normal=OGIVE_NORMAL_MASTER, master=rod, &
                              detection=OGIVE_DETECTION_GAP, gap_offset=0.1_c_double)
  call check()
  call simulation%set_stop(rod, settle_window=0.03_c_double, settle_tolerance=1.0_c_double)
  call check()

  call simulation%prepare()
  call check()
  initial = simulation%body_result(rod)
  call simulation%advance(0.6_c_double)
  call check()
  final = simulation%body_result(rod)
  call check()

  ! A rod that does not go forward any more has no residual velocity.
  residual = 0
  if (dot_product(final%velocity, initial%velocity) > 0) residual = final%speed
  print "(a, es24.16, a)", "residual velocity", residual, " m/s"
  call simulation%destroy()

contains

  subroutine check()
    if (simulation%status /= OGIVE_OK) call fail(simulation%message())
  end subroutine check

  subroutine fail(reason)
    character(len=*), intent(in) :: reason
    write (error_unit, "(a)") "thick_plate: "//reason
    stop 1
  end subroutine fail

end program thick_plate
