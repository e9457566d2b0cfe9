! Surface meshes of Ogive for Fortran hosts. Link libogive_geometry as well.
module ogive_geometry
  use ogive_geometry_c
  implicit none

contains

  ! Reads a surface (STL or OFF), checks it and fills it with particles: positions(3, n), volumes(n). Optional arguments as in
  ! ogive_voxelise_def; scale multiplies the file's coordinates. message tells what is wrong where status is not OGIVE_OK.
  subroutine fill_surface(path, spacing, positions, volumes, status, message, scale, axis, reference, position)
    character(len=*), intent(in) :: path
    real(c_double), intent(in) :: spacing(3)
    real(c_double), allocatable, target, intent(out) :: positions(:, :), volumes(:)
    integer(c_int32_t), intent(out) :: status
    character(len=:), allocatable, intent(out), optional :: message
    real(c_double), intent(in), optional :: scale, axis(3), reference(3), position(3)
    type(c_ptr) :: mesh
    type(ogive_mesh_read_def) :: read_def
    type(ogive_voxelise_def) :: def
    integer(c_int64_t) :: count
    call ogive_mesh_read_def_init(read_def, c_sizeof(read_def))
    if (present(scale)) read_def%scale = scale
    call ogive_voxelise_def_init(def, c_sizeof(def))
    def%spacing = spacing
    if (present(axis)) def%axis = axis
    if (present(reference)) def%reference = reference
    if (present(position)) def%position = position
    mesh = c_null_ptr
    count = 0
    status = ogive_mesh_create(mesh)
    if (status == OGIVE_OK) status = ogive_mesh_read(mesh, trim(path)//c_null_char, read_def)
    if (status == OGIVE_OK) status = ogive_mesh_check(mesh)
    if (status == OGIVE_OK) status = ogive_mesh_voxelise(mesh, def, count, c_null_ptr, c_null_ptr)
    allocate (positions(3, count), volumes(count))
    if (status == OGIVE_OK) status = ogive_mesh_voxelise(mesh, def, count, c_loc(positions), c_loc(volumes))
    if (present(message)) message = text_of_c(ogive_mesh_message(mesh))
    call ogive_mesh_destroy(mesh)
  end subroutine fill_surface

  ! The text at an address of C.
  function text_of_c(address) result(text)
    type(c_ptr), intent(in) :: address
    character(len=:), allocatable :: text
    character(kind=c_char), pointer :: characters(:)
    integer :: length
    text = ""
    if (.not. c_associated(address)) return
    call c_f_pointer(address, characters, [65536])
    length = 0
    do while (characters(length + 1) /= c_null_char)
      length = length + 1
    end do
    deallocate (text)
    allocate (character(len=length) :: text)
    if (length > 0) text = transfer(characters(1:length), text)
  end function text_of_c

end module ogive_geometry
