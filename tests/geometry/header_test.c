/* The header is C: a host in C compiles it and can set up its structs. */
#include "ogive_geometry.h"

int geometry_header_compiles_as_c(void);

int geometry_header_compiles_as_c(void) {
  ogive_mesh_info info = {0};
  ogive_mesh_read_def read;
  ogive_voxelise_def fill;
  info.struct_size = sizeof info;
  ogive_mesh_read_def_init(&read, sizeof read);
  ogive_voxelise_def_init(&fill, sizeof fill);
  return info.struct_size == sizeof info && read.struct_size == sizeof read && read.scale == 1.0 &&
         fill.struct_size == sizeof fill && fill.axis[2] == 1.0 && fill.lattice_axis[2] == 1.0 &&
         fill.spacing[0] == 0.0;
}
