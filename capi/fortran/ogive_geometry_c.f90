! The interfaces of ogive_geometry.h in Fortran, name by name. Made by tools/fortran_bindings.py: do not edit.
! What the types, fields and functions mean stands in ogive_geometry.h. Strings end with c_null_char; a type(c_ptr)
! argument is a handle, or the address of an array that may be absent (c_null_ptr).
module ogive_geometry_c
  use, intrinsic :: iso_c_binding
  use ogive_c
  implicit none
  public


  type, bind(C) :: ogive_mesh_read_def
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: reserved0
    real(c_double) :: scale
  end type ogive_mesh_read_def

  type, bind(C) :: ogive_mesh_info
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: checked
    integer(c_int64_t) :: facets
    integer(c_int64_t) :: vertices
    real(c_double) :: area
    real(c_double) :: lower(3)
    real(c_double) :: upper(3)
    real(c_double) :: volume
    integer(c_int32_t) :: shells
    integer(c_int32_t) :: cavities
    integer(c_int64_t) :: dropped_degenerate
    integer(c_int64_t) :: dropped_duplicate
    integer(c_int64_t) :: removed_flat
    integer(c_int64_t) :: turned
    integer(c_int64_t) :: open_edges
    integer(c_int64_t) :: crowded_edges
    integer(c_int64_t) :: touching_vertices
    integer(c_int64_t) :: intersecting_pairs
  end type ogive_mesh_info

  type, bind(C) :: ogive_voxelise_def
    integer(c_int32_t) :: struct_size
    integer(c_int32_t) :: reserved0
    real(c_double) :: spacing(3)
    real(c_double) :: lattice_axis(3)
    real(c_double) :: lattice_reference(3)
    real(c_double) :: lattice_origin(3)
    real(c_double) :: axis(3)
    real(c_double) :: reference(3)
    real(c_double) :: position(3)
  end type ogive_voxelise_def

  interface
    function ogive_mesh_create(mesh) bind(C)
      import
      implicit none
      type(c_ptr), intent(out) :: mesh
      integer(c_int32_t) :: ogive_mesh_create
    end function
    subroutine ogive_mesh_destroy(mesh) bind(C)
      import
      implicit none
      type(c_ptr), value :: mesh
    end subroutine
    function ogive_mesh_message(mesh) bind(C)
      import
      implicit none
      type(c_ptr), value :: mesh
      type(c_ptr) :: ogive_mesh_message
    end function
    subroutine ogive_mesh_read_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_mesh_read_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_mesh_read(mesh, path, def) bind(C)
      import
      implicit none
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(in) :: path(*)
      type(ogive_mesh_read_def), intent(in) :: def
      integer(c_int32_t) :: ogive_mesh_read
    end function
    function ogive_mesh_set_facets(mesh, vertex_count, xyz, facet_count, corners) bind(C)
      import
      implicit none
      type(c_ptr), value :: mesh
      integer(c_int64_t), value :: vertex_count
      real(c_double), intent(in) :: xyz(*)
      integer(c_int64_t), value :: facet_count
      integer(c_int32_t), intent(in) :: corners(*)
      integer(c_int32_t) :: ogive_mesh_set_facets
    end function
    function ogive_mesh_check(mesh) bind(C)
      import
      implicit none
      type(c_ptr), value :: mesh
      integer(c_int32_t) :: ogive_mesh_check
    end function
    function ogive_mesh_report(mesh, text, capacity, needed) bind(C)
      import
      implicit none
      type(c_ptr), value :: mesh
      character(kind=c_char), intent(inout) :: text(*)
      integer(c_size_t), value :: capacity
      integer(c_size_t), intent(inout) :: needed
      integer(c_int32_t) :: ogive_mesh_report
    end function
    function ogive_mesh_info_get(mesh, info) bind(C)
      import
      implicit none
      type(c_ptr), value :: mesh
      type(ogive_mesh_info), intent(inout) :: info
      integer(c_int32_t) :: ogive_mesh_info_get
    end function
    subroutine ogive_voxelise_def_init(def, size) bind(C)
      import
      implicit none
      type(ogive_voxelise_def), intent(inout) :: def
      integer(c_size_t), value :: size
    end subroutine
    function ogive_mesh_voxelise(mesh, def, count, xyz, volume) bind(C)
      import
      implicit none
      type(c_ptr), value :: mesh
      type(ogive_voxelise_def), intent(in) :: def
      integer(c_int64_t), intent(inout) :: count
      type(c_ptr), value :: xyz
      type(c_ptr), value :: volume
      integer(c_int32_t) :: ogive_mesh_voxelise
    end function
    function ogive_mesh_surface(mesh, def, vertex_count, triangle_count, xyz, corners) bind(C)
      import
      implicit none
      type(c_ptr), value :: mesh
      type(ogive_voxelise_def), intent(in) :: def
      integer(c_int64_t), intent(inout) :: vertex_count(*)
      integer(c_int64_t), intent(inout) :: triangle_count(*)
      real(c_double), intent(inout) :: xyz(*)
      integer(c_int32_t), intent(inout) :: corners(*)
      integer(c_int32_t) :: ogive_mesh_surface
    end function
  end interface
end module ogive_geometry_c
