! Files of Ogive for Fortran hosts: module ogive with checkpoints and particle files. Link libogive_io as well.
module ogive_io
  use ogive
  implicit none

contains

  subroutine write_checkpoint(simulation, path, status)
    class(ogive_simulation), intent(inout) :: simulation
    character(len=*), intent(in) :: path
    integer(c_int32_t), intent(out), optional :: status
    simulation%status = ogive_checkpoint_write(simulation%world, trim(path)//c_null_char)
    if (present(status)) status = simulation%status
  end subroutine write_checkpoint

  ! Into a simulation fresh from create.
  subroutine read_checkpoint(simulation, path, status)
    class(ogive_simulation), intent(inout) :: simulation
    character(len=*), intent(in) :: path
    integer(c_int32_t), intent(out), optional :: status
    simulation%status = ogive_checkpoint_read(simulation%world, trim(path)//c_null_char)
    if (present(status)) status = simulation%status
  end subroutine read_checkpoint

  subroutine write_particles(simulation, path, status)
    class(ogive_simulation), intent(inout) :: simulation
    character(len=*), intent(in) :: path
    integer(c_int32_t), intent(out), optional :: status
    simulation%status = ogive_particles_write(simulation%world, trim(path)//c_null_char)
    if (present(status)) status = simulation%status
  end subroutine write_particles

end module ogive_io
