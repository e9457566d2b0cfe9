! A small Fortran host as an outside project would have it: host.c once more.
program host
  use ogive
  implicit none
  type(ogive_simulation) :: simulation
  type(ogive_material_def) :: def
  type(ogive_material_id) :: steel
  type(ogive_body_id) :: left, right
  type(ogive_body_result) :: found
  real(c_double), parameter :: size(3) = 2, spacing(3) = 0.5_c_double
  call simulation%create()
  call simulation%set_grid(1.0_c_double, [-6.0_c_double, -6.0_c_double, -6.0_c_double], &
                           [6.0_c_double, 6.0_c_double, 6.0_c_double])
  def = material(7.85e-3_c_double)
  def%youngs_modulus = 200e3_c_double
  def%poisson_ratio = 0.3_c_double
  call simulation%add_material("steel", def, steel)
  call simulation%add_solid("left", steel, OGIVE_SOLID_BOX, size, spacing, centre=[-1.0_c_double, 0.0_c_double, 0.0_c_double], &
                            velocity=[50.0_c_double, 0.0_c_double, 0.0_c_double], body=left)
  call simulation%add_solid("right", steel, OGIVE_SOLID_BOX, size, spacing, centre=[1.0_c_double, 0.0_c_double, 0.0_c_double], &
                            body=right)
  call simulation%prepare()
  call simulation%advance(0.005_c_double)
  if (simulation%status /= OGIVE_OK) then
    print "(a)", simulation%message()
    stop 1
  end if
  found = simulation%body_result(right)
  print "(a, es24.16)", "right block: ", found%velocity(1)
  call simulation%destroy()
  if (left%index /= 0 .or. found%velocity(1) < 5) stop 1
end program host
