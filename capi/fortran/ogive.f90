! Ogive for Fortran hosts: thin wrappers with optional arguments over the interfaces of module ogive_c, which this module passes
! on, so that whatever ogive.h declares can be called as well.
!
! A simulation owns a world. Every call sets its `status` (OGIVE_OK is 0) and gives it to the optional argument `status`; the
! text of a failure is message(). Nothing is printed and nothing stops. Arrays of vectors are (3, n), of tensors (6, n) and
! (9, n); they go to the library as they lie in memory, without copies, and must therefore be contiguous.
! Optional arguments that are absent leave the engine's defaults, which ogive.h states.
module ogive
  use ogive_c
  implicit none
  private :: text_of_c

  type :: ogive_simulation
    type(c_ptr) :: world = c_null_ptr
    integer(c_int32_t) :: status = OGIVE_OK
  contains
    procedure :: create
    procedure :: destroy
    procedure :: message
    procedure :: set_grid
    procedure :: set_numerics
    procedure :: set_contact
    procedure :: set_pair
    procedure :: add_wall
    procedure :: set_motion
    procedure :: set_stop
    procedure :: add_clamp
    procedure :: add_load
    procedure :: set_load
    procedure :: add_material
    procedure :: add_particles
    procedure :: add_solid
    procedure :: prepare
    procedure :: plan
    procedure :: stable_time_step
    procedure :: step
    procedure :: advance
    procedure :: progress
    procedure :: ledger
    procedure :: check_energy
    procedure :: find_body
    procedure :: body_result
    procedure :: pair_result
    procedure :: load_result
    procedure, private :: get_scalars
    procedure, private :: get_vectors
    procedure, private :: set_scalars
    procedure, private :: set_vectors
    generic :: get_field => get_scalars, get_vectors
    generic :: set_field => set_scalars, set_vectors
    procedure :: view_vectors
  end type ogive_simulation

contains

  ! The text at an address of C.
  function text_of_c(address) result(text)
    type(c_ptr), intent(in) :: address
    character(len=:), allocatable :: text
    character(kind=c_char), pointer :: characters(:)
    integer :: length
    if (.not. c_associated(address)) then
      text = ""
      return
    end if
    call c_f_pointer(address, characters, [65536])
    length = 0
    do while (characters(length + 1) /= c_null_char)
      length = length + 1
    end do
    allocate (character(len=length) :: text)
    if (length > 0) text = transfer(characters(1:length), text)
  end function text_of_c

  ! "0.2.0"
  function version() result(text)
    character(len=:), allocatable :: text
    text = text_of_c(ogive_version())
  end function version

  subroutine create(self, status)
    class(ogive_simulation), intent(inout) :: self
    integer(c_int32_t), intent(out), optional :: status
    call self%destroy()
    self%status = ogive_world_create(self%world)
    if (present(status)) status = self%status
  end subroutine create

  subroutine destroy(self)
    class(ogive_simulation), intent(inout) :: self
    call ogive_world_destroy(self%world)
    self%world = c_null_ptr
  end subroutine destroy

  ! Of the last call that failed.
  function message(self) result(text)
    class(ogive_simulation), intent(in) :: self
    character(len=:), allocatable :: text
    text = text_of_c(ogive_world_message(self%world))
  end function message

  subroutine set_grid(self, cell_size, domain_min, domain_max, face, status)
    class(ogive_simulation), intent(inout) :: self
    real(c_double), intent(in) :: cell_size, domain_min(3), domain_max(3)
    integer(c_int32_t), intent(in), optional :: face(6)
    integer(c_int32_t), intent(out), optional :: status
    type(ogive_grid_def) :: def
    call ogive_grid_def_init(def, c_sizeof(def))
    def%cell_size = cell_size
    def%domain_min = domain_min
    def%domain_max = domain_max
    if (present(face)) def%face = face
    self%status = ogive_world_set_grid(self%world, def)
    if (present(status)) status = self%status
  end subroutine set_grid

  subroutine set_numerics(self, shape_function, time_step_factor, maximum_time_step, threads, gravity, transfer, &
                          update_order, pic_fraction, xpic_order, drop_debris, skip_resting, energy_warning, &
                          energy_limit, energy_loss_limit, status)
    class(ogive_simulation), intent(inout) :: self
    integer(c_int32_t), intent(in), optional :: shape_function, threads, transfer, update_order, xpic_order
    real(c_double), intent(in), optional :: time_step_factor, maximum_time_step, gravity(3), pic_fraction
    real(c_double), intent(in), optional :: energy_warning, energy_limit, energy_loss_limit
    logical, intent(in), optional :: drop_debris, skip_resting
    integer(c_int32_t), intent(out), optional :: status
    type(ogive_numerics_def) :: def
    call ogive_numerics_def_init(def, c_sizeof(def))
    if (present(shape_function)) def%shape_function = shape_function
    if (present(time_step_factor)) def%time_step_factor = time_step_factor
    if (present(maximum_time_step)) def%maximum_time_step = maximum_time_step
    if (present(threads)) def%threads = threads
    if (present(gravity)) def%gravity = gravity
    if (present(transfer)) def%transfer = transfer
    if (present(update_order)) def%update_order = update_order
    if (present(pic_fraction)) def%pic_fraction = pic_fraction
    if (present(xpic_order)) def%xpic_order = xpic_order
    if (present(drop_debris)) def%drop_debris = merge(1_c_int32_t, 0_c_int32_t, drop_debris)
    if (present(skip_resting)) def%skip_resting = merge(1_c_int32_t, 0_c_int32_t, skip_resting)
    if (present(energy_warning)) def%energy_warning = energy_warning
    if (present(energy_limit)) def%energy_limit = energy_limit
    if (present(energy_loss_limit)) def%energy_loss_limit = energy_loss_limit
    self%status = ogive_world_set_numerics(self%world, def)
    if (present(status)) status = self%status
  end subroutine set_numerics

  function contact_def(method, normal, master, friction, detection, gap_offset) result(def)
    integer(c_int32_t), intent(in), optional :: method, normal, detection
    type(ogive_body_id), intent(in), optional :: master
    real(c_double), intent(in), optional :: friction, gap_offset
    type(ogive_contact_def) :: def
    call ogive_contact_def_init(def, c_sizeof(def))
    if (present(method)) def%method = method
    if (present(normal)) def%normal = normal
    if (present(master)) def%master = master
    if (present(friction)) def%friction = friction
    if (present(detection)) def%detection = detection
    if (present(gap_offset)) def%gap_offset = gap_offset
  end function contact_def

  subroutine set_contact(self, method, normal, master, friction, detection, gap_offset, status)
    class(ogive_simulation), intent(inout) :: self
    integer(c_int32_t), intent(in), optional :: method, normal, detection
    type(ogive_body_id), intent(in), optional :: master
    real(c_double), intent(in), optional :: friction, gap_offset
    integer(c_int32_t), intent(out), optional :: status
    self%status = ogive_world_set_contact(self%world, contact_def(method, normal, master, friction, detection, gap_offset))
    if (present(status)) status = self%status
  end subroutine set_contact

  subroutine set_pair(self, a, b, method, normal, master, friction, detection, gap_offset, status)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_body_id), intent(in) :: a, b
    integer(c_int32_t), intent(in), optional :: method, normal, detection
    type(ogive_body_id), intent(in), optional :: master
    real(c_double), intent(in), optional :: friction, gap_offset
    integer(c_int32_t), intent(out), optional :: status
    self%status = ogive_contact_set_pair(self%world, a, b, &
                                         contact_def(method, normal, master, friction, detection, gap_offset))
    if (present(status)) status = self%status
  end subroutine set_pair

  subroutine add_wall(self, point, normal, method, friction, detection, gap_offset, status)
    class(ogive_simulation), intent(inout) :: self
    real(c_double), intent(in), optional :: point(3), normal(3), friction, gap_offset
    integer(c_int32_t), intent(in), optional :: method, detection
    integer(c_int32_t), intent(out), optional :: status
    type(ogive_wall_def) :: def
    call ogive_wall_def_init(def, c_sizeof(def))
    if (present(point)) def%point = point
    if (present(normal)) def%normal = normal
    if (present(method)) def%method = method
    if (present(friction)) def%friction = friction
    if (present(detection)) def%detection = detection
    if (present(gap_offset)) def%gap_offset = gap_offset
    self%status = ogive_wall_add(self%world, def)
    if (present(status)) status = self%status
  end subroutine add_wall

  ! times(n), velocity(3, n), angular_velocity(3, n) of a rigid body whose motion is prescribed
  subroutine set_motion(self, body, times, velocity, angular_velocity, status)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_body_id), intent(in) :: body
    real(c_double), contiguous, intent(in) :: times(:), velocity(:, :)
    real(c_double), contiguous, intent(in), optional :: angular_velocity(:, :)
    integer(c_int32_t), intent(out), optional :: status
    real(c_double), allocatable :: at_rest(:, :)
    logical :: fits
    fits = size(velocity, 1) == 3 .and. size(velocity, 2) == size(times)
    if (fits .and. present(angular_velocity)) fits = all(shape(angular_velocity) == shape(velocity))
    if (.not. fits) then
      self%status = ogive_world_report(self%world, OGIVE_ERROR_ARGUMENT, &
                                       "velocity, angular_velocity: must be (3, n), n being the size of times"//c_null_char)
    else if (present(angular_velocity)) then
      self%status = ogive_body_set_motion(self%world, body, size(times, kind=c_int32_t), times, velocity, angular_velocity)
    else
      allocate (at_rest(3, size(times)), source=0.0_c_double)
      self%status = ogive_body_set_motion(self%world, body, size(times, kind=c_int32_t), times, velocity, at_rest)
    end if
    if (present(status)) status = self%status
  end subroutine set_motion

  subroutine set_stop(self, body, settle_window, settle_tolerance, stop_when_stopped, stop_when_out, exchange_window, &
                      exchange_tolerance, status)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_body_id), intent(in), optional :: body
    real(c_double), intent(in), optional :: settle_window, settle_tolerance, exchange_window, exchange_tolerance
    logical, intent(in), optional :: stop_when_stopped, stop_when_out
    integer(c_int32_t), intent(out), optional :: status
    type(ogive_stop_def) :: def
    call ogive_stop_def_init(def, c_sizeof(def))
    if (present(body)) def%body = body
    if (present(settle_window)) def%settle_window = settle_window
    if (present(settle_tolerance)) def%settle_tolerance = settle_tolerance
    if (present(stop_when_stopped)) def%stop_when_stopped = merge(1_c_int32_t, 0_c_int32_t, stop_when_stopped)
    if (present(stop_when_out)) def%stop_when_out = merge(1_c_int32_t, 0_c_int32_t, stop_when_out)
    if (present(exchange_window)) def%exchange_window = exchange_window
    if (present(exchange_tolerance)) def%exchange_tolerance = exchange_tolerance
    self%status = ogive_world_set_stop(self%world, def)
    if (present(status)) status = self%status
  end subroutine set_stop

  subroutine add_clamp(self, a, b, region, radius, body, axes, status)
    class(ogive_simulation), intent(inout) :: self
    real(c_double), intent(in), optional :: a(3), b(3), radius
    integer(c_int32_t), intent(in), optional :: region, axes
    type(ogive_body_id), intent(in), optional :: body
    integer(c_int32_t), intent(out), optional :: status
    type(ogive_clamp_def) :: def
    call ogive_clamp_def_init(def, c_sizeof(def))
    if (present(a)) def%a = a
    if (present(b)) def%b = b
    if (present(region)) def%region = region
    if (present(radius)) def%radius = radius
    if (present(body)) def%body = body
    if (present(axes)) def%axes = axes
    self%status = ogive_clamp_add(self%world, def)
    if (present(status)) status = self%status
  end subroutine add_clamp

  subroutine add_load(self, kind, value, body, region, a, b, radius, area, axes, load, status)
    class(ogive_simulation), intent(inout) :: self
    integer(c_int32_t), intent(in) :: kind
    real(c_double), intent(in), optional :: value(3), a(3), b(3), radius, area
    type(ogive_body_id), intent(in), optional :: body
    integer(c_int32_t), intent(in), optional :: region, axes
    type(ogive_load_id), intent(out), optional :: load
    integer(c_int32_t), intent(out), optional :: status
    type(ogive_load_def) :: def
    type(ogive_load_id) :: id
    call ogive_load_def_init(def, c_sizeof(def))
    def%kind = kind
    if (present(value)) def%value = value
    if (present(body)) def%body = body
    if (present(region)) def%region = region
    if (present(a)) def%a = a
    if (present(b)) def%b = b
    if (present(radius)) def%radius = radius
    if (present(area)) def%area = area
    if (present(axes)) def%axes = axes
    id%index = -1
    self%status = ogive_load_add(self%world, def, id)
    if (present(load)) load = id
    if (present(status)) status = self%status
  end subroutine add_load

  subroutine set_load(self, load, value, status)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_load_id), intent(in) :: load
    real(c_double), intent(in) :: value(3)
    integer(c_int32_t), intent(out), optional :: status
    self%status = ogive_load_set(self%world, load, value)
    if (present(status)) status = self%status
  end subroutine set_load

  ! def: filled by material(), then by the caller.
  subroutine add_material(self, name, def, material, status)
    class(ogive_simulation), intent(inout) :: self
    character(len=*), intent(in) :: name
    type(ogive_material_def), intent(in) :: def
    type(ogive_material_id), intent(out) :: material
    integer(c_int32_t), intent(out), optional :: status
    material%index = -1
    self%status = ogive_material_add(self%world, trim(name)//c_null_char, def, material)
    if (present(status)) status = self%status
  end subroutine add_material

  ! A material with the engine's defaults.
  function material(density) result(def)
    real(c_double), intent(in) :: density
    type(ogive_material_def) :: def
    call ogive_material_def_init(def, c_sizeof(def))
    def%density = density
  end function material

  function body_def(material, velocity, angular_velocity, angular_centre, formulation) result(def)
    type(ogive_material_id), intent(in) :: material
    real(c_double), intent(in), optional :: velocity(3), angular_velocity(3), angular_centre(3)
    integer(c_int32_t), intent(in), optional :: formulation
    type(ogive_body_def) :: def
    call ogive_body_def_init(def, c_sizeof(def))
    def%material = material
    if (present(velocity)) def%velocity = velocity
    if (present(angular_velocity)) def%angular_velocity = angular_velocity
    if (present(angular_centre)) def%angular_centre = angular_centre
    if (present(formulation)) def%formulation = formulation
  end function body_def

  ! positions(3, n), volumes(n)
  subroutine add_particles(self, name, material, positions, volumes, velocity, angular_velocity, angular_centre, body, &
                           formulation, status)
    class(ogive_simulation), intent(inout) :: self
    character(len=*), intent(in) :: name
    type(ogive_material_id), intent(in) :: material
    real(c_double), contiguous, intent(in) :: positions(:, :), volumes(:)
    real(c_double), intent(in), optional :: velocity(3), angular_velocity(3), angular_centre(3)
    integer(c_int32_t), intent(in), optional :: formulation
    type(ogive_body_id), intent(out), optional :: body
    integer(c_int32_t), intent(out), optional :: status
    type(ogive_body_id) :: id
    id%index = -1
    if (size(positions, 1) /= 3 .or. size(positions, 2) /= size(volumes)) then
      self%status = ogive_world_report(self%world, OGIVE_ERROR_ARGUMENT, &
                                       "positions: must be (3, n), n being the size of volumes"//c_null_char)
    else
      self%status = ogive_body_add_particles(self%world, trim(name)//c_null_char, &
                                             body_def(material, velocity, angular_velocity, angular_centre, formulation), &
                                             size(volumes, kind=c_int64_t), positions, volumes, id)
    end if
    if (present(body)) body = id
    if (present(status)) status = self%status
  end subroutine add_particles

  subroutine add_solid(self, name, material, solid, size, spacing, centre, axis, reference, lattice, velocity, &
                       angular_velocity, angular_centre, body, formulation, status)
    class(ogive_simulation), intent(inout) :: self
    character(len=*), intent(in) :: name
    type(ogive_material_id), intent(in) :: material
    integer(c_int32_t), intent(in) :: solid
    real(c_double), intent(in) :: size(3), spacing(3)
    real(c_double), intent(in), optional :: centre(3), axis(3), reference(3)
    integer(c_int32_t), intent(in), optional :: lattice
    real(c_double), intent(in), optional :: velocity(3), angular_velocity(3), angular_centre(3)
    integer(c_int32_t), intent(in), optional :: formulation
    type(ogive_body_id), intent(out), optional :: body
    integer(c_int32_t), intent(out), optional :: status
    type(ogive_solid_def) :: def
    type(ogive_body_id) :: id
    call ogive_solid_def_init(def, c_sizeof(def))
    def%solid = solid
    def%size = size
    def%spacing = spacing
    if (present(centre)) def%centre = centre
    if (present(axis)) def%axis = axis
    if (present(reference)) def%reference = reference
    if (present(lattice)) def%lattice = lattice
    id%index = -1
    self%status = ogive_body_add_solid(self%world, trim(name)//c_null_char, &
                                       body_def(material, velocity, angular_velocity, angular_centre, formulation), def, id)
    if (present(body)) body = id
    if (present(status)) status = self%status
  end subroutine add_solid

  subroutine prepare(self, status)
    class(ogive_simulation), intent(inout) :: self
    integer(c_int32_t), intent(out), optional :: status
    self%status = ogive_world_prepare(self%world)
    if (present(status)) status = self%status
  end subroutine prepare

  function plan(self) result(text)
    class(ogive_simulation), intent(inout) :: self
    character(len=:), allocatable :: text
    character(kind=c_char), allocatable :: buffer(:)
    integer(c_size_t) :: needed
    allocate (buffer(1))
    needed = 0
    self%status = ogive_world_plan(self%world, buffer, size(buffer, kind=c_size_t), needed)
    text = ""
    if (self%status /= OGIVE_OK) return
    deallocate (buffer)
    allocate (buffer(needed))
    self%status = ogive_world_plan(self%world, buffer, needed, needed)
    if (self%status /= OGIVE_OK) return
    deallocate (text)
    allocate (character(len=needed - 1) :: text)
    text = transfer(buffer(1:needed - 1), text)
  end function plan

  function stable_time_step(self) result(dt)
    class(ogive_simulation), intent(inout) :: self
    real(c_double) :: dt
    dt = 0
    self%status = ogive_world_stable_time_step(self%world, dt)
  end function stable_time_step

  ! dt absent: the stable time step.
  subroutine step(self, dt, status)
    class(ogive_simulation), intent(inout) :: self
    real(c_double), intent(in), optional :: dt
    integer(c_int32_t), intent(out), optional :: status
    real(c_double) :: own
    own = 0
    if (present(dt)) own = dt
    self%status = ogive_world_step(self%world, own)
    if (present(status)) status = self%status
  end subroutine step

  ! callback: c_funloc of a function(world, user) bind(C) as ogive_step_callback in ogive.h; user: an address that it gets.
  subroutine advance(self, time, max_steps, callback, user, status)
    class(ogive_simulation), intent(inout) :: self
    real(c_double), intent(in) :: time
    integer(c_int64_t), intent(in), optional :: max_steps
    type(c_funptr), intent(in), optional :: callback
    type(c_ptr), intent(in), optional :: user
    integer(c_int32_t), intent(out), optional :: status
    integer(c_int64_t) :: limit
    type(c_funptr) :: called
    type(c_ptr) :: given
    limit = 0
    called = c_null_funptr
    given = c_null_ptr
    if (present(max_steps)) limit = max_steps
    if (present(callback)) called = callback
    if (present(user)) given = user
    self%status = ogive_world_advance(self%world, time, limit, called, given)
    if (present(status)) status = self%status
  end subroutine advance

  function progress(self) result(found)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_progress) :: found
    found%struct_size = int(c_sizeof(found), c_int32_t)
    self%status = ogive_world_progress(self%world, found)
  end function progress

  function ledger(self) result(found)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_ledger) :: found
    found%struct_size = int(c_sizeof(found), c_int32_t)
    self%status = ogive_world_ledger(self%world, found)
  end function ledger

  subroutine check_energy(self, status)
    class(ogive_simulation), intent(inout) :: self
    integer(c_int32_t), intent(out), optional :: status
    self%status = ogive_world_check_energy(self%world)
    if (present(status)) status = self%status
  end subroutine check_energy

  function find_body(self, name) result(body)
    class(ogive_simulation), intent(inout) :: self
    character(len=*), intent(in) :: name
    type(ogive_body_id) :: body
    body%index = -1
    self%status = ogive_body_find(self%world, trim(name)//c_null_char, body)
  end function find_body

  function body_result(self, body) result(found)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_body_id), intent(in) :: body
    type(ogive_body_result) :: found
    found%struct_size = int(c_sizeof(found), c_int32_t)
    self%status = ogive_body_result_get(self%world, body, found)
  end function body_result

  function pair_result(self, a, b) result(found)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_body_id), intent(in) :: a, b
    type(ogive_pair_result) :: found
    found%struct_size = int(c_sizeof(found), c_int32_t)
    self%status = ogive_pair_result_get(self%world, a, b, found)
  end function pair_result

  function load_result(self, load) result(found)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_load_id), intent(in) :: load
    type(ogive_load_result) :: found
    found%struct_size = int(c_sizeof(found), c_int32_t)
    self%status = ogive_load_result_get(self%world, load, found)
  end function load_result

  subroutine get_scalars(self, body, name, values, status)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_body_id), intent(in) :: body
    character(len=*), intent(in) :: name
    real(c_double), contiguous, intent(inout) :: values(:)
    integer(c_int32_t), intent(out), optional :: status
    self%status = ogive_field_get(self%world, body, trim(name)//c_null_char, values, size(values, kind=c_int64_t))
    if (present(status)) status = self%status
  end subroutine get_scalars

  subroutine get_vectors(self, body, name, values, status)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_body_id), intent(in) :: body
    character(len=*), intent(in) :: name
    real(c_double), contiguous, intent(inout) :: values(:, :)
    integer(c_int32_t), intent(out), optional :: status
    self%status = ogive_field_get(self%world, body, trim(name)//c_null_char, values, size(values, kind=c_int64_t))
    if (present(status)) status = self%status
  end subroutine get_vectors

  subroutine set_scalars(self, body, name, values, status)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_body_id), intent(in) :: body
    character(len=*), intent(in) :: name
    real(c_double), contiguous, intent(in) :: values(:)
    integer(c_int32_t), intent(out), optional :: status
    self%status = ogive_field_set(self%world, body, trim(name)//c_null_char, values, size(values, kind=c_int64_t))
    if (present(status)) status = self%status
  end subroutine set_scalars

  subroutine set_vectors(self, body, name, values, status)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_body_id), intent(in) :: body
    character(len=*), intent(in) :: name
    real(c_double), contiguous, intent(in) :: values(:, :)
    integer(c_int32_t), intent(out), optional :: status
    self%status = ogive_field_set(self%world, body, trim(name)//c_null_char, values, size(values, kind=c_int64_t))
    if (present(status)) status = self%status
  end subroutine set_vectors

  ! Positions, velocities or forces where the engine keeps them, as values(4, places), of which the first three count, and the
  ! particle numbers, 0-based and -1 in padding. They live as long as ogive.h says of ogive_field_view_get.
  subroutine view_vectors(self, body, name, values, numbers, status)
    class(ogive_simulation), intent(inout) :: self
    type(ogive_body_id), intent(in) :: body
    character(len=*), intent(in) :: name
    real(c_double), pointer, intent(out) :: values(:, :)
    integer(c_int32_t), pointer, intent(out) :: numbers(:)
    integer(c_int32_t), intent(out), optional :: status
    type(ogive_field_view) :: view
    nullify (values, numbers)
    view%struct_size = int(c_sizeof(view), c_int32_t)
    self%status = ogive_field_view_get(self%world, body, trim(name)//c_null_char, view)
    if (self%status == OGIVE_OK .and. (view%components /= 3 .or. view%stride /= 4)) &
      self%status = ogive_world_report(self%world, OGIVE_ERROR_ARGUMENT, &
                                       "field: must be one of three components in records of four"//c_null_char)
    if (self%status == OGIVE_OK) then
      call c_f_pointer(view%component(1), values, [view%stride, view%places])
      call c_f_pointer(view%number, numbers, [view%places])
    end if
    if (present(status)) status = self%status
  end subroutine view_vectors

end module ogive
