! The Fortran wrappers: a small scene with everything, results beside what the C interface gives, errors as statuses.
module fortran_test_callback
  use, intrinsic :: iso_c_binding
  implicit none

contains

  function enough(world, user) bind(C) result(stop_now)
    type(c_ptr), value :: world, user
    integer(c_int32_t) :: stop_now
    integer(c_int32_t), pointer :: number
    call c_f_pointer(user, number)
    number = number + 1
    stop_now = merge(1, 0, number == 5 .and. c_associated(world))
  end function enough

end module fortran_test_callback

program fortran_test
  use fortran_test_callback
  use ogive
  use ogive_io
  implicit none
  type(ogive_simulation) :: a, b
  type(ogive_material_def) :: def
  type(ogive_material_id) :: steel
  type(ogive_body_id) :: left, right
  type(ogive_load_id) :: load
  type(ogive_body_result) :: one, two
  type(ogive_pair_result) :: there, back
  type(ogive_ledger) :: sums
  type(ogive_progress) :: clock
  type(ogive_load_result) :: work
  real(c_double) :: positions(3, 27), volumes(27), velocity(3, 27), stress(6, 27), force(3, 27), mass(27)
  real(c_double), pointer :: seen(:, :)
  integer(c_int32_t), pointer :: numbers(:)
  integer(c_int32_t), target :: calls
  integer(c_int32_t) :: status
  integer :: i, failures
  character(len=4096) :: directory
  failures = 0
  call get_command_argument(1, directory)

  call check(version() == "0.2.0", "version")
  call a%create(status)
  call check(status == OGIVE_OK .and. a%status == OGIVE_OK, "create")
  call a%set_grid(-1.0_c_double, [0.0_c_double, 0.0_c_double, 0.0_c_double], [1.0_c_double, 1.0_c_double, 1.0_c_double])
  call check(a%status == OGIVE_ERROR_ARGUMENT .and. index(a%message(), "cell_size") == 1, "a refusal and its message")
  call a%set_grid(1.0_c_double, [-6.0_c_double, -4.0_c_double, -4.0_c_double], [6.0_c_double, 4.0_c_double, 4.0_c_double])
  call check(a%status == OGIVE_OK, "set_grid")
  call a%set_numerics(energy_warning=-1.0_c_double)
  call check(a%status == OGIVE_ERROR_ARGUMENT .and. index(a%message(), "energy_warning") > 0, "a warning below 0")
  call a%set_numerics(skip_resting=.false., energy_limit=0.0_c_double)
  call check(a%status == OGIVE_ERROR_ARGUMENT .and. index(a%message(), "energy_limit") > 0, "a limit of 0")
  call a%set_numerics(energy_loss_limit=-1.0_c_double)
  call check(a%status == OGIVE_ERROR_ARGUMENT .and. index(a%message(), "energy_loss_limit") > 0, "a limit below 0")
  call a%set_numerics(time_step_factor=0.4_c_double, threads=1, gravity=[0.0_c_double, 0.0_c_double, -1.0_c_double], &
                       drop_debris=.true.)
  call a%set_contact(friction=0.1_c_double)
  call check(a%status == OGIVE_OK, "set_contact")
  def = material(7.85e-3_c_double)
  def%youngs_modulus = 200e3_c_double
  def%poisson_ratio = 0.3_c_double
  call a%add_material("steel", def, steel)
  call check(a%status == OGIVE_OK .and. steel%index == 0, "add_material")
  do i = 0, 26
    positions(:, i + 1) = -[mod(i, 3), mod(i/3, 3), i/9]*0.5_c_double - 0.25_c_double
  end do
  volumes = 0.125_c_double
  call a%add_particles("left", steel, positions(1:2, :), volumes)
  call check(a%status == OGIVE_ERROR_ARGUMENT .and. index(a%message(), "(3, n)") > 0, "positions of a wrong shape")
  call a%add_particles("left", steel, positions, volumes, velocity=[60.0_c_double, 60.0_c_double, 60.0_c_double], body=left)
  call check(a%status == OGIVE_OK .and. left%index == 0, "add_particles")
  call a%add_solid("right", steel, OGIVE_SOLID_BOX, [2.0_c_double, 2.0_c_double, 2.0_c_double], &
                   [0.5_c_double, 0.5_c_double, 0.5_c_double], centre=[1.0_c_double, 1.0_c_double, 1.0_c_double], body=right)
  call check(a%status == OGIVE_OK .and. right%index == 1, "add_solid")
  call a%set_pair(left, right, friction=0.2_c_double)
  call check(a%status == OGIVE_OK, "set_pair")
  call a%add_clamp(a=[5.0_c_double, -4.0_c_double, -4.0_c_double], b=[6.0_c_double, 4.0_c_double, 4.0_c_double])
  call check(a%status == OGIVE_OK, "add_clamp")
  call a%add_load(OGIVE_LOAD_ACCELERATION, value=[0.0_c_double, 5.0_c_double, 0.0_c_double], body=right, load=load)
  call check(a%status == OGIVE_OK .and. load%index == 0, "add_load")
  call a%set_stop(left, stop_when_stopped=.false.)
  call check(a%status == OGIVE_OK, "set_stop")
  call a%set_stop(exchange_window=0.1_c_double, exchange_tolerance=2.0_c_double)
  call check(a%status == OGIVE_ERROR_ARGUMENT .and. index(a%message(), "exchange_tolerance") > 0, "a tolerance above 1")
  call a%prepare()
  call check(a%status == OGIVE_OK, "prepare")
  call check(index(a%plan(), 'body "left": 27 particles') > 0, "plan")
  call check(a%stable_time_step() > 0, "stable_time_step")

  ! Arrays: (3, n) and (6, n) as they lie.
  call a%get_field(left, "position", velocity)
  call check(all(abs(velocity - positions) <= 0), "positions come back as they were given")
  call a%get_field(left, "velocity", velocity)
  call check(all(abs(velocity - 60) < 1e-12), "velocity")
  velocity(2, :) = 61
  call a%set_field(left, "velocity", velocity)
  call a%get_field(left, "mass", mass)
  call check(all(abs(mass - 0.125_c_double*7.85e-3_c_double) < 1e-15), "mass")
  call a%view_vectors(left, "velocity", seen, numbers)
  call check(a%status == OGIVE_OK .and. count(numbers >= 0) == 27, "view_vectors")
  do i = 1, size(numbers)
    if (numbers(i) >= 0) call check(all(abs(seen(1:3, i) - velocity(:, numbers(i) + 1)) <= 0), "the view is the field")
  end do
  call a%get_field(left, "velocity", mass)
  call check(a%status == OGIVE_ERROR_ARGUMENT .and. index(a%message(), "count") == 1, "a field into too short an array")
  force = 0.25_c_double
  call a%set_field(left, "force", force)
  call check(a%status == OGIVE_OK, "set_field force")
  call a%step()
  call a%step(0.5_c_double*a%stable_time_step())
  call check(a%status == OGIVE_OK, "step")
  calls = 0
  call a%advance(1.0_c_double, callback=c_funloc(enough), user=c_loc(calls))
  clock = a%progress()
  call check(calls == 5 .and. clock%steps == 7, "advance with a callback")
  call a%advance(0.02_c_double)
  call a%get_field(left, "stress", stress)
  call check(a%status == OGIVE_OK .and. maxval(abs(stress)) > 1, "stress")

  one = a%body_result(a%find_body("left"))
  there = a%pair_result(left, right)
  back = a%pair_result(right, left)
  call check(all(abs(there%impulse + back%impulse) <= 0) .and. there%impulse(1) < 0, "pair_result")
  call a%set_load(load, [0.0_c_double, 6.0_c_double, 0.0_c_double])
  work = a%load_result(load)
  call check(abs(work%value(2) - 6) <= 0 .and. work%impulse(2) > 0, "load_result")
  sums = a%ledger()
  two = a%body_result(right)
  call check(abs(sums%mass - one%mass - two%mass) < 1e-12, "ledger")

  call write_checkpoint(a, trim(directory)//"/fortran.h5")
  call check(a%status == OGIVE_OK, "write_checkpoint")
  call write_particles(a, trim(directory)//"/fortran_particles.h5")
  call check(a%status == OGIVE_OK, "write_particles")
  call b%create()
  call read_checkpoint(b, trim(directory)//"/nothing.h5", status)
  call check(status == OGIVE_ERROR_FILE, "read_checkpoint of nothing")
  call read_checkpoint(b, trim(directory)//"/fortran.h5")
  call check(b%status == OGIVE_OK, "read_checkpoint: "//b%message())
  call a%advance(0.03_c_double)
  call b%advance(0.03_c_double)
  one = a%body_result(left)
  two = b%body_result(left)
  call check(all(abs(one%velocity - two%velocity) <= 0) .and. abs(one%internal - two%internal) <= 0, "the same bits")
  call a%destroy()
  call a%destroy()

  ! A rigid block that the host moves, over a wall.
  call a%create()
  call a%set_grid(1.0_c_double, [-6.0_c_double, -4.0_c_double, -4.0_c_double], [6.0_c_double, 4.0_c_double, 4.0_c_double])
  call a%set_numerics(maximum_time_step=1e-4_c_double, transfer=OGIVE_TRANSFER_XPIC, xpic_order=2_c_int32_t)
  call a%add_material("steel", elastic_steel(), steel)
  call a%add_wall(point=[0.0_c_double, 0.0_c_double, -3.5_c_double])
  call check(a%status == OGIVE_OK, "add_wall: "//a%message())
  call a%add_wall(normal=[0.0_c_double, 0.0_c_double, 0.0_c_double])
  call check(a%status == OGIVE_ERROR_ARGUMENT, "a wall without direction")
  call a%add_solid("block", steel, OGIVE_SOLID_BOX, [2.0_c_double, 2.0_c_double, 2.0_c_double], &
                   [0.5_c_double, 0.5_c_double, 0.5_c_double], body=left, formulation=OGIVE_FORMULATION_RIGID_PRESCRIBED)
  call a%set_motion(left, [0.0_c_double], reshape([1.0_c_double], [1, 1]))
  call check(a%status == OGIVE_ERROR_ARGUMENT, "a motion of the wrong shape")
  call a%prepare()
  call check(a%status == OGIVE_OK, "prepare: "//a%message())
  call a%set_motion(left, [0.0_c_double], reshape([0.0_c_double, 3.0_c_double, 0.0_c_double], [3, 1]))
  call a%step(1e-4_c_double)
  one = a%body_result(left)
  call check(a%status == OGIVE_OK .and. abs(one%velocity(2) - 3) < 1e-12, "set_motion")
  call a%destroy()
  call b%destroy()
  if (failures > 0) stop 1
  print "(a)", "all good"

contains

  function elastic_steel() result(def)
    type(ogive_material_def) :: def
    def = material(7.85e-3_c_double)
    def%youngs_modulus = 200e3_c_double
    def%poisson_ratio = 0.3_c_double
  end function elastic_steel

  subroutine check(holds, what)
    logical, intent(in) :: holds
    character(len=*), intent(in) :: what
    if (holds) return
    failures = failures + 1
    print "(a)", "failed: "//what
  end subroutine check

end program fortran_test
