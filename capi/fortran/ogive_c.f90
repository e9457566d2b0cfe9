! The interfaces of ogive.h in Fortran, name by name. Made by tools/fortran_bindings.py: do not edit.
! What the types, fields and functions mean stands in ogive.h. Strings end with c_null_char; a type(c_ptr)
! argument is a handle, or the address of an array that may be absent (c_null_ptr).
module ogive_c
  use, intrinsic :: iso_c_binding
  implicit none
  public

  integer(c_int32_t), parameter :: OGIVE_VERSION_MAJOR = 0
  integer(c_int32_t), parameter :: OGIVE_VERSION_MINOR = 2
  integer(c_int32_t), parameter :: OGIVE_VERSION_PATCH = 0
  integer(c_int32_t), parameter :: OGIVE_ABI = 2
  integer(c_int32_t), parameter :: OGIVE_OK = 0
  integer(c_int32_t), parameter :: OGIVE_ERROR_ARGUMENT = 1
  integer(c_int32_t), parameter :: OGIVE_ERROR_STATE = 2
  integer(c_int32_t), parameter :: OGIVE_ERROR_MEMORY = 3
  integer(c_int32_t), parameter :: OGIVE_ERROR_NUMERICAL = 4
  integer(c_int32_t), parameter :: OGIVE_ERROR_FILE = 5
  integer(c_int32_t), parameter :: OGIVE_ERROR_FORMAT = 6
  integer(c_int32_t), parameter :: OGIVE_ERROR_INTERNAL = 7
  integer(c_int32_t), parameter :: OGIVE_LOG_INFO = 1
  integer(c_int32_t), parameter :: OGIVE_LOG_WARNING = 2
  integer(c_int32_t), parameter :: OGIVE_LOG_ERROR = 3
  integer(c_int32_t), parameter :: OGIVE_FACE_FREE = 0
  integer(c_int32_t), parameter :: OGIVE_FACE_SYMMETRY = 1
  integer(c_int32_t), parameter :: OGIVE_FACE_FIXED = 2
  integer(c_int32_t), parameter :: OGIVE_SPACE_THREE_DIMENSIONAL = 0
  integer(c_int32_t), parameter :: OGIVE_SPACE_PLANE_STRAIN = 1
  integer(c_int32_t), parameter :: OGIVE_SPACE_AXISYMMETRIC = 2
  integer(c_int32_t), parameter :: OGIVE_SHAPE_LINEAR = 0
  integer(c_int32_t), parameter :: OGIVE_SHAPE_QUADRATIC_BSPLINE = 1
  integer(c_int32_t), parameter :: OGIVE_SHAPE_GIMP = 2
  integer(c_int32_t), parameter :: OGIVE_TRANSFER_FLIP = 0
  integer(c_int32_t), parameter :: OGIVE_TRANSFER_AFFINE_FLIP = 1
  integer(c_int32_t), parameter :: OGIVE_TRANSFER_APIC = 2
  integer(c_int32_t), parameter :: OGIVE_TRANSFER_XPIC = 3
  integer(c_int32_t), parameter :: OGIVE_UPDATE_STRESS_FIRST = 0
  integer(c_int32_t), parameter :: OGIVE_UPDATE_STRESS_LAST = 1
  integer(c_int32_t), parameter :: OGIVE_UPDATE_STRESS_LAST_AS_IS = 2
  integer(c_int32_t), parameter :: OGIVE_REGION_BOX = 0
  integer(c_int32_t), parameter :: OGIVE_REGION_OUTSIDE_CYLINDER = 1
  integer(c_int32_t), parameter :: OGIVE_REGION_EVERYWHERE = 2
  integer(c_int32_t), parameter :: OGIVE_LOAD_ACCELERATION = 0
  integer(c_int32_t), parameter :: OGIVE_LOAD_TRACTION = 1
  integer(c_int32_t), parameter :: OGIVE_LOAD_VELOCITY = 2
  integer(c_int32_t), parameter :: OGIVE_STRENGTH_ELASTIC = 0
  integer(c_int32_t), parameter :: OGIVE_STRENGTH_NEO_HOOKEAN = 1
  integer(c_int32_t), parameter :: OGIVE_STRENGTH_J2_POWER = 2
  integer(c_int32_t), parameter :: OGIVE_STRENGTH_JOHNSON_COOK = 3
  integer(c_int32_t), parameter :: OGIVE_STRENGTH_J2_MIXED = 4
  integer(c_int32_t), parameter :: OGIVE_STRENGTH_J2_MULTIPLICATIVE = 5
  integer(c_int32_t), parameter :: OGIVE_EOS_LINEAR = 0
  integer(c_int32_t), parameter :: OGIVE_EOS_MIE_GRUNEISEN = 1
  integer(c_int32_t), parameter :: OGIVE_FAILURE_NONE = 0
  integer(c_int32_t), parameter :: OGIVE_FAILURE_PLASTIC_STRAIN = 1
  integer(c_int32_t), parameter :: OGIVE_FORMULATION_DEFORMABLE = 0
  integer(c_int32_t), parameter :: OGIVE_FORMULATION_RIGID_FREE = 1
  integer(c_int32_t), parameter :: OGIVE_FORMULATION_RIGID_PRESCRIBED = 2
  integer(c_int32_t), parameter :: OGIVE_FORMULATION_TOTAL_LAGRANGIAN = 3
  integer(c_int32_t), parameter :: OGIVE_DISTORTED_UPDATE = 0
  integer(c_int32_t), parameter :: OGIVE_DISTORTED_STOP = 1
  integer(c_int32_t), parameter :: OGIVE_SOLID_BOX = 0
  integer(c_int32_t), parameter :: OGIVE_SOLID_CYLINDER = 1
  integer(c_int32_t), parameter :: OGIVE_SOLID_SPHERE = 2
  integer(c_int32_t), parameter :: OGIVE_SOLID_OGIVE_ROD = 3
  integer(c_int32_t), parameter :: OGIVE_LATTICE_CARTESIAN = 0
  integer(c_int32_t), parameter :: OGIVE_LATTICE_POLAR = 1
  integer(c_int32_t), parameter :: OGIVE_CONTACT_SINGLE_FIELD = 0
  integer(c_int32_t), parameter :: OGIVE_CONTACT_HUANG_FIRST = 1
  integer(c_int32_t), parameter :: OGIVE_CONTACT_HUANG_SECOND = 2
  integer(c_int32_t), parameter :: OGIVE_CONTACT_YORK = 3
  integer(c_int32_t), parameter :: OGIVE_CONTACT_HU_CHEN = 4
  integer(c_int32_t), parameter :: OGIVE_CONTACT_BARDENHAGEN_2000 = 5
  integer(c_int32_t), parameter :: OGIVE_CONTACT_BARDENHAGEN_2001 = 6
  integer(c_int32_t), parameter :: OGIVE_CONTACT_PAN_2008 = 7
  integer(c_int32_t), parameter :: OGIVE_CONTACT_PERSISTENT = 8
  integer(c_int32_t), parameter :: OGIVE_NORMAL_MASTER = 0
  integer(c_int32_t), parameter :: OGIVE_NORMAL_AVERAGE = 1
  integer(c_int32_t), parameter :: OGIVE_NORMAL_VOLUME_GRADIENT = 2
  integer(c_int32_t), parameter :: OGIVE_NORMAL_OCCUPIED_CELL = 3
  integer(c_int32_t), parameter :: OGIVE_NORMAL_LOGISTIC_REGRESSION = 4
  integer(c_int32_t), parameter :: OGIVE_DETECTION_SHARED_NODE = 0
  integer(c_int32_t), parameter :: OGIVE_DETECTION_GAP = 1
  integer(c_int32_t), parameter :: OGIVE_DETECTION_SURFACE = 2
  integer(c_int32_t), parameter :: OGIVE_STOP_NONE = 0
  integer(c_int32_t), parameter :: OGIVE_STOP_SETTLED = 1
  integer(c_int32_t), parameter :: OGIVE_STOP_STOPPED = 2
  integer(c_int32_t), parameter :: OGIVE_STOP_OUT = 3
  integer(c_int32_t), parameter :: OGIVE_STOP_EXCHANGE_ENDED = 4
  integer(c_int32_t), parameter :: OGIVE_TYPE_FLOAT64 = 1
  integer(c_int32_t), parameter :: OGIVE_TYPE_INT32 = 2
  integer(c_int32_t), parameter :: OGIVE_TYPE_INT64 = 3
  integer(c_int32_t), parameter :: OGIVE_TYPE_UINT8 = 4

  type, bind(C) :: ogive_material_id
    integer(c_int32_t) :: index
  end type ogive_material_id

  type, bind(C) :: ogive_body_id
    integer(c_int32_t) :: index
  end type ogive_body_id

  type, bind(C) :: ogive_load_id
    integer(c_int32_t) :: index
  end type ogive_load_id

  type, bind(C) :: ogive_grid_def
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: reserved0
    real(c_double) :: cell_size
    real(c_double) :: domain_min(3)
    real(c_double) :: domain_max(3)
    integer(c_int32_t) :: face(6)
    integer(c_int32_t) :: space
    integer(c_int32_t) :: reserved1
    real(c_double) :: thickness
  end type ogive_grid_def

  type, bind(C) :: ogive_numerics_def
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: shape_function
    real(c_double) :: time_step_factor
    real(c_double) :: maximum_time_step
    integer(c_int32_t) :: threads
    integer(c_int32_t) :: reserved0
    real(c_double) :: gravity(3)
    integer(c_int32_t) :: transfer
    integer(c_int32_t) :: update_order
    real(c_double) :: pic_fraction
    integer(c_int32_t) :: xpic_order
    integer(c_int32_t) :: reserved1
    real(c_double) :: energy_warning
    real(c_double) :: energy_limit
    integer(c_int32_t) :: drop_debris
    integer(c_int32_t) :: skip_resting
    real(c_double) :: energy_loss_limit
  end type ogive_numerics_def

  type, bind(C) :: ogive_clamp_def
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: region
    real(c_double) :: a(3)
    real(c_double) :: b(3)
    real(c_double) :: radius
    type(ogive_body_id) :: body
    integer(c_int32_t) :: axes
  end type ogive_clamp_def

  type, bind(C) :: ogive_load_def
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: kind
    integer(c_int32_t) :: region
    type(ogive_body_id) :: body
    real(c_double) :: a(3)
    real(c_double) :: b(3)
    real(c_double) :: radius
    real(c_double) :: value(3)
    real(c_double) :: area
    integer(c_int32_t) :: axes
    integer(c_int32_t) :: reserved0
  end type ogive_load_def

  type, bind(C) :: ogive_material_def
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: strength
    integer(c_int32_t) :: eos
    integer(c_int32_t) :: failure
    real(c_double) :: density
    real(c_double) :: youngs_modulus
    real(c_double) :: poisson_ratio
    real(c_double) :: bulk_modulus
    real(c_double) :: shear_modulus
    real(c_double) :: yield_stress
    real(c_double) :: hardening_modulus
    real(c_double) :: hardening_exponent
    real(c_double) :: rate_coefficient
    real(c_double) :: reference_strain_rate
    real(c_double) :: thermal_exponent
    real(c_double) :: melt_temperature
    real(c_double) :: room_temperature
    real(c_double) :: specific_heat
    real(c_double) :: taylor_quinney
    real(c_double) :: eos_sound_speed
    real(c_double) :: eos_slope
    real(c_double) :: gruneisen
    real(c_double) :: failure_strain
    real(c_double) :: viscosity_linear
    real(c_double) :: viscosity_quadratic
    real(c_double) :: isotropic_fraction
  end type ogive_material_def

  type, bind(C) :: ogive_body_def
    integer(c_int32_t) :: struct_size
    type(ogive_material_id) :: material
    real(c_double) :: velocity(3)
    real(c_double) :: angular_velocity(3)
    real(c_double) :: angular_centre(3)
    integer(c_int32_t) :: formulation
    integer(c_int32_t) :: reserved0
    real(c_double) :: distortion_limit
    integer(c_int32_t) :: when_distorted
    integer(c_int32_t) :: reserved1
    real(c_double) :: coarse_from(3)
    real(c_double) :: coarse_to(3)
    real(c_double) :: coarse_beyond
  end type ogive_body_def

  type, bind(C) :: ogive_solid_def
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: solid
    integer(c_int32_t) :: lattice
    integer(c_int32_t) :: reserved0
    real(c_double) :: size(3)
    real(c_double) :: centre(3)
    real(c_double) :: axis(3)
    real(c_double) :: reference(3)
    real(c_double) :: spacing(3)
  end type ogive_solid_def

  type, bind(C) :: ogive_contact_def
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: method
    integer(c_int32_t) :: normal
    type(ogive_body_id) :: master
    real(c_double) :: friction
    integer(c_int32_t) :: detection
    integer(c_int32_t) :: reserved0
    real(c_double) :: gap_offset
  end type ogive_contact_def

  type, bind(C) :: ogive_wall_def
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: method
    real(c_double) :: point(3)
    real(c_double) :: normal(3)
    real(c_double) :: friction
    integer(c_int32_t) :: detection
    integer(c_int32_t) :: reserved0
    real(c_double) :: gap_offset
  end type ogive_wall_def

  type, bind(C) :: ogive_stop_def
    integer(c_int32_t) :: struct_size
    type(ogive_body_id) :: body
    real(c_double) :: settle_window
    real(c_double) :: settle_tolerance
    integer(c_int32_t) :: stop_when_stopped
    integer(c_int32_t) :: stop_when_out
    real(c_double) :: exchange_window
    real(c_double) :: exchange_tolerance
  end type ogive_stop_def

  type, bind(C) :: ogive_progress
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: stop
    real(c_double) :: time
    real(c_double) :: last_time_step
    integer(c_int64_t) :: steps
    integer(c_int64_t) :: particles
    integer(c_int64_t) :: particle_steps
    integer(c_int64_t) :: memory_bytes
    integer(c_int64_t) :: resting_particle_steps
  end type ogive_progress

  type, bind(C) :: ogive_ledger
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: reserved0
    real(c_double) :: time
    real(c_double) :: mass
    real(c_double) :: left_domain_mass
    real(c_double) :: momentum(3)
    real(c_double) :: left_domain_momentum(3)
    real(c_double) :: boundary_impulse(3)
    real(c_double) :: external_impulse(3)
    real(c_double) :: kinetic
    real(c_double) :: internal
    real(c_double) :: plastic_dissipation
    real(c_double) :: viscous_dissipation
    real(c_double) :: failure_loss
    real(c_double) :: left_domain_energy
    real(c_double) :: friction_dissipation
    real(c_double) :: transfer_dissipation
    real(c_double) :: contact_work
    real(c_double) :: boundary_work
    real(c_double) :: external_work
    real(c_double) :: initial_total
    real(c_double) :: total
    real(c_double) :: residual
    real(c_double) :: residual_relative
    real(c_double) :: maximum_speed
    real(c_double) :: maximum_speed_ever
    real(c_double) :: prescribed_work
    real(c_double) :: angular_momentum(3)
    real(c_double) :: contact_couple(3)
    real(c_double) :: energy_growth
    real(c_double) :: energy_growth_time
    real(c_double) :: energy_warning_time
    real(c_double) :: contact_dissipation
    real(c_double) :: dropped_mass
    real(c_double) :: dropped_momentum(3)
    real(c_double) :: dropped_angular_momentum(3)
    real(c_double) :: dropped_energy
    real(c_double) :: energy_unaccounted
  end type ogive_ledger

  type, bind(C) :: ogive_body_result
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: reserved0
    integer(c_int64_t) :: particles
    integer(c_int64_t) :: failed_particles
    integer(c_int64_t) :: left_domain
    real(c_double) :: mass
    real(c_double) :: failed_mass
    real(c_double) :: left_domain_mass
    real(c_double) :: first_failure_time
    real(c_double) :: failure_loss
    real(c_double) :: centre(3)
    real(c_double) :: momentum(3)
    real(c_double) :: velocity(3)
    real(c_double) :: speed
    real(c_double) :: initial_speed
    real(c_double) :: kinetic
    real(c_double) :: internal
    real(c_double) :: contact_force(3)
    real(c_double) :: lower(3)
    real(c_double) :: upper(3)
    real(c_double) :: maximum_plastic_strain
    real(c_double) :: maximum_temperature
    real(c_double) :: angular_momentum(3)
    real(c_double) :: angular_velocity(3)
    integer(c_int32_t) :: formulation
    integer(c_int32_t) :: reserved1
    integer(c_int64_t) :: dropped_particles
    real(c_double) :: dropped_mass
  end type ogive_body_result

  type, bind(C) :: ogive_load_result
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: reserved0
    real(c_double) :: value(3)
    real(c_double) :: force(3)
    real(c_double) :: impulse(3)
    real(c_double) :: work
  end type ogive_load_result

  type, bind(C) :: ogive_pair_result
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: reserved0
    real(c_double) :: force(3)
    real(c_double) :: impulse(3)
    real(c_double) :: friction_dissipation
    real(c_double) :: contact_work
  end type ogive_pair_result

  type, bind(C) :: ogive_field_view
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: components
    integer(c_int64_t) :: places
    integer(c_int64_t) :: stride
    type(c_ptr) :: component(9)
    type(c_ptr) :: number
  end type ogive_field_view

  type, bind(C) :: ogive_writer
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: reserved0
    type(c_ptr) :: user
    type(c_funptr) :: put
  end type ogive_writer

  type, bind(C) :: ogive_reader
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: reserved0
    type(c_ptr) :: user
    type(c_funptr) :: find
    type(c_funptr) :: get
  end type ogive_reader

  interface
    function ogive_version() bind(C)
      import
      implicit none
      type(c_ptr) :: ogive_version
    end function
    function ogive_abi_version() bind(C)
      import
      implicit none
      integer(c_int32_t) :: ogive_abi_version
    end function
    function ogive_status_name(status) bind(C)
      import
      implicit none
      integer(c_int32_t), value :: status
      type(c_ptr) :: ogive_status_name
    end function
    function ogive_world_create(world) bind(C)
      import
      implicit none
      type(c_ptr), intent(out) :: world
      integer(c_int32_t) :: ogive_world_create
    end function
    subroutine ogive_world_destroy(world) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
    end subroutine
    function ogive_world_message(world) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(c_ptr) :: ogive_world_message
    end function
    function ogive_world_report(world, status, message) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      integer(c_int32_t), value :: status
      character(kind=c_char), intent(in) :: message(*)
      integer(c_int32_t) :: ogive_world_report
    end function
    function ogive_world_set_log(world, callback, user) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(c_funptr), value :: callback
      type(c_ptr), value :: user
      integer(c_int32_t) :: ogive_world_set_log
    end function
    subroutine ogive_grid_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_grid_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_world_set_grid(world, def) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_grid_def), intent(in) :: def
      integer(c_int32_t) :: ogive_world_set_grid
    end function
    subroutine ogive_numerics_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_numerics_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_world_set_numerics(world, def) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_numerics_def), intent(in) :: def
      integer(c_int32_t) :: ogive_world_set_numerics
    end function
    function ogive_world_set_threads(world, threads) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      integer(c_int32_t), value :: threads
      integer(c_int32_t) :: ogive_world_set_threads
    end function
    subroutine ogive_clamp_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_clamp_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_clamp_add(world, def) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_clamp_def), intent(in) :: def
      integer(c_int32_t) :: ogive_clamp_add
    end function
    subroutine ogive_load_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_load_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_load_add(world, def, id) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_load_def), intent(in) :: def
      type(ogive_load_id), intent(inout) :: id
      integer(c_int32_t) :: ogive_load_add
    end function
    function ogive_load_set(world, load, value) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_load_id), value :: load
      real(c_double), intent(in) :: value(*)
      integer(c_int32_t) :: ogive_load_set
    end function
    subroutine ogive_material_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_material_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_material_add(world, name, def, id) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: name(*)
      type(ogive_material_def), intent(in) :: def
      type(ogive_material_id), intent(inout) :: id
      integer(c_int32_t) :: ogive_material_add
    end function
    subroutine ogive_body_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_body_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_body_add_particles(world, name, def, count, xyz, volume, id) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: name(*)
      type(ogive_body_def), intent(in) :: def
      integer(c_int64_t), value :: count
      real(c_double), intent(in) :: xyz(*)
      real(c_double), intent(in) :: volume(*)
      type(ogive_body_id), intent(inout) :: id
      integer(c_int32_t) :: ogive_body_add_particles
    end function
    function ogive_body_set_motion(world, body, count, time, velocity, angular_velocity) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: body
      integer(c_int32_t), value :: count
      real(c_double), intent(in) :: time(*)
      real(c_double), intent(in) :: velocity(*)
      real(c_double), intent(in) :: angular_velocity(*)
      integer(c_int32_t) :: ogive_body_set_motion
    end function
    subroutine ogive_solid_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_solid_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_body_add_solid(world, name, def, solid, id) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: name(*)
      type(ogive_body_def), intent(in) :: def
      type(ogive_solid_def), intent(in) :: solid
      type(ogive_body_id), intent(inout) :: id
      integer(c_int32_t) :: ogive_body_add_solid
    end function
    function ogive_solid_particles(world, solid, count, xyz, volume) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_solid_def), intent(in) :: solid
      integer(c_int64_t), intent(inout) :: count
      type(c_ptr), value :: xyz
      type(c_ptr), value :: volume
      integer(c_int32_t) :: ogive_solid_particles
    end function
    function ogive_body_set_surface(world, body, vertex_count, xyz, triangle_count, corners) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: body
      integer(c_int64_t), value :: vertex_count
      real(c_double), intent(in) :: xyz(*)
      integer(c_int64_t), value :: triangle_count
      integer(c_int32_t), intent(in) :: corners(*)
      integer(c_int32_t) :: ogive_body_set_surface
    end function
    function ogive_body_set_surface_solid(world, body, solid) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: body
      type(ogive_solid_def), intent(in) :: solid
      integer(c_int32_t) :: ogive_body_set_surface_solid
    end function
    subroutine ogive_contact_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_contact_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_world_set_contact(world, def) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_contact_def), intent(in) :: def
      integer(c_int32_t) :: ogive_world_set_contact
    end function
    function ogive_contact_set_pair(world, a, b, def) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: a
      type(ogive_body_id), value :: b
      type(ogive_contact_def), intent(in) :: def
      integer(c_int32_t) :: ogive_contact_set_pair
    end function
    function ogive_contact_method_count() bind(C)
      import
      implicit none
      integer(c_int32_t) :: ogive_contact_method_count
    end function
    function ogive_contact_method_name(method) bind(C)
      import
      implicit none
      integer(c_int32_t), value :: method
      type(c_ptr) :: ogive_contact_method_name
    end function
    function ogive_contact_normal_count() bind(C)
      import
      implicit none
      integer(c_int32_t) :: ogive_contact_normal_count
    end function
    function ogive_contact_normal_name(normal) bind(C)
      import
      implicit none
      integer(c_int32_t), value :: normal
      type(c_ptr) :: ogive_contact_normal_name
    end function
    subroutine ogive_wall_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_wall_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_wall_add(world, def) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_wall_def), intent(in) :: def
      integer(c_int32_t) :: ogive_wall_add
    end function
    subroutine ogive_stop_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_stop_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_world_set_stop(world, def) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_stop_def), intent(in) :: def
      integer(c_int32_t) :: ogive_world_set_stop
    end function
    function ogive_world_prepare(world) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      integer(c_int32_t) :: ogive_world_prepare
    end function
    function ogive_world_reopen(world) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      integer(c_int32_t) :: ogive_world_reopen
    end function
    function ogive_material_change(world, material, def) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_material_id), value :: material
      type(ogive_material_def), intent(in) :: def
      integer(c_int32_t) :: ogive_material_change
    end function
    function ogive_world_plan(world, text, capacity, needed) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(inout) :: text(*)
      integer(c_size_t), value :: capacity
      integer(c_size_t), intent(inout) :: needed
      integer(c_int32_t) :: ogive_world_plan
    end function
    function ogive_world_stable_time_step(world, dt) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      real(c_double), intent(inout) :: dt
      integer(c_int32_t) :: ogive_world_stable_time_step
    end function
    function ogive_world_step(world, dt) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      real(c_double), value :: dt
      integer(c_int32_t) :: ogive_world_step
    end function
    function ogive_world_advance(world, time, max_steps, callback, user) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      real(c_double), value :: time
      integer(c_int64_t), value :: max_steps
      type(c_funptr), value :: callback
      type(c_ptr), value :: user
      integer(c_int32_t) :: ogive_world_advance
    end function
    function ogive_world_progress(world, progress) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_progress), intent(inout) :: progress
      integer(c_int32_t) :: ogive_world_progress
    end function
    function ogive_world_ledger(world, ledger) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_ledger), intent(inout) :: ledger
      integer(c_int32_t) :: ogive_world_ledger
    end function
    function ogive_world_check_energy(world) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      integer(c_int32_t) :: ogive_world_check_energy
    end function
    function ogive_body_count(world) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      integer(c_int32_t) :: ogive_body_count
    end function
    function ogive_body_name(world, body) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: body
      type(c_ptr) :: ogive_body_name
    end function
    function ogive_body_find(world, name, body) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: name(*)
      type(ogive_body_id), intent(inout) :: body
      integer(c_int32_t) :: ogive_body_find
    end function
    function ogive_body_result_get(world, body, result) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: body
      type(ogive_body_result), intent(inout) :: result
      integer(c_int32_t) :: ogive_body_result_get
    end function
    function ogive_load_result_get(world, load, result) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_load_id), value :: load
      type(ogive_load_result), intent(inout) :: result
      integer(c_int32_t) :: ogive_load_result_get
    end function
    function ogive_pair_result_get(world, a, b, result) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: a
      type(ogive_body_id), value :: b
      type(ogive_pair_result), intent(inout) :: result
      integer(c_int32_t) :: ogive_pair_result_get
    end function
    function ogive_field_count(world, body) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: body
      integer(c_int32_t) :: ogive_field_count
    end function
    function ogive_field_name(world, body, index, components) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: body
      integer(c_int32_t), value :: index
      integer(c_int32_t), intent(inout) :: components
      type(c_ptr) :: ogive_field_name
    end function
    function ogive_field_get(world, body, name, values, count) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: body
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(inout) :: values(*)
      integer(c_int64_t), value :: count
      integer(c_int32_t) :: ogive_field_get
    end function
    function ogive_field_set(world, body, name, values, count) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: body
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(in) :: values(*)
      integer(c_int64_t), value :: count
      integer(c_int32_t) :: ogive_field_set
    end function
    function ogive_field_view_get(world, body, name, view) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_body_id), value :: body
      character(kind=c_char), intent(in) :: name(*)
      type(ogive_field_view), intent(inout) :: view
      integer(c_int32_t) :: ogive_field_view_get
    end function
    function ogive_world_attach(world, name, data, size) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: name(*)
      type(c_ptr), value :: data
      integer(c_int64_t), value :: size
      integer(c_int32_t) :: ogive_world_attach
    end function
    function ogive_world_attachment(world, name, data, size) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: name(*)
      type(c_ptr), intent(out) :: data
      integer(c_int64_t), intent(inout) :: size
      integer(c_int32_t) :: ogive_world_attachment
    end function
    function ogive_world_save(world, writer) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_writer), intent(in) :: writer
      integer(c_int32_t) :: ogive_world_save
    end function
    function ogive_world_load(world, reader) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      type(ogive_reader), intent(in) :: reader
      integer(c_int32_t) :: ogive_world_load
    end function
    function ogive_checkpoint_write(world, path) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int32_t) :: ogive_checkpoint_write
    end function
    function ogive_checkpoint_read(world, path) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int32_t) :: ogive_checkpoint_read
    end function
    function ogive_file_verify(path, text, capacity, needed) bind(C)
      import
      implicit none
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: text(*)
      integer(c_size_t), value :: capacity
      integer(c_size_t), intent(inout) :: needed
      integer(c_int32_t) :: ogive_file_verify
    end function
    function ogive_file_info(path, text, capacity, needed) bind(C)
      import
      implicit none
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: text(*)
      integer(c_size_t), value :: capacity
      integer(c_size_t), intent(inout) :: needed
      integer(c_int32_t) :: ogive_file_info
    end function
    function ogive_body_add_particle_file(world, name, def, path, id) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: name(*)
      type(ogive_body_def), intent(in) :: def
      character(kind=c_char), intent(in) :: path(*)
      type(ogive_body_id), intent(inout) :: id
      integer(c_int32_t) :: ogive_body_add_particle_file
    end function
    function ogive_particles_write(world, path) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int32_t) :: ogive_particles_write
    end function
    function ogive_series_write(world, path, count, files) bind(C)
      import
      implicit none
      type(c_ptr), value :: world
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int32_t), value :: count
      type(c_ptr), intent(in) :: files(*)
      integer(c_int32_t) :: ogive_series_write
    end function
  end interface
end module ogive_c
