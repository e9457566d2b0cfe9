/* A host with files and a mesh: a tetrahedron filled with particles flies, is saved, loaded and flies on. Argument: directory. */
#include <ogive.h>
#include <ogive_geometry.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  const double corners[12] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 4};
  const int32_t facets[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  ogive_mesh* mesh = NULL;
  ogive_world *world = NULL, *again = NULL;
  ogive_voxelise_def fill;
  ogive_grid_def grid;
  ogive_material_def steel;
  ogive_material_id material;
  ogive_body_def body;
  ogive_body_id id;
  ogive_body_result result = {.struct_size = sizeof result};
  int64_t count = 0;
  char path[4096];
  if (argc != 2) return 2;
  snprintf(path, sizeof path, "%s/consumer.h5", argv[1]);
  ogive_voxelise_def_init(&fill, sizeof fill);
  for (int c = 0; c < 3; ++c) fill.spacing[c] = 0.5;
  if (ogive_mesh_create(&mesh) || ogive_mesh_set_facets(mesh, 4, corners, 4, facets) || ogive_mesh_check(mesh) ||
      ogive_mesh_voxelise(mesh, &fill, &count, NULL, NULL))
    return 1;
  double* xyz = malloc(3 * (size_t)count * sizeof *xyz);
  double* volume = malloc((size_t)count * sizeof *volume);
  if (!xyz || !volume || ogive_mesh_voxelise(mesh, &fill, &count, xyz, volume)) return 1;
  ogive_mesh_destroy(mesh);
  if (ogive_world_create(&world) || ogive_world_create(&again)) return 1;
  ogive_grid_def_init(&grid, sizeof grid);
  ogive_material_def_init(&steel, sizeof steel);
  ogive_body_def_init(&body, sizeof body);
  grid.cell_size = 1.0;
  for (int c = 0; c < 3; ++c) grid.domain_min[c] = -4.0, grid.domain_max[c] = 8.0;
  steel.density = 7.85e-3, steel.youngs_modulus = 200e3, steel.poisson_ratio = 0.3;
  if (ogive_world_set_grid(world, &grid) || ogive_material_add(world, "steel", &steel, &material)) return 1;
  body.material = material;
  body.velocity[2] = 100.0;
  if (ogive_body_add_particles(world, "tetrahedron", &body, count, xyz, volume, &id) || ogive_world_prepare(world) ||
      ogive_world_advance(world, 0.005, 0, NULL, NULL) || ogive_checkpoint_write(world, path) ||
      ogive_checkpoint_read(again, path) || ogive_world_advance(again, 0.01, 0, NULL, NULL) ||
      ogive_body_result_get(again, id, &result)) {
    fprintf(stderr, "%s%s\n", ogive_world_message(world), ogive_world_message(again));
    return 1;
  }
  free(xyz);
  free(volume);
  ogive_world_destroy(world);
  ogive_world_destroy(again);
  printf("%lld particles, centre at z = %.6f\n", (long long)result.particles, result.centre[2]);
  return result.centre[2] > 1.9 && result.centre[2] < 2.1 ? 0 : 1; /* 1 mm + 100 m/s x 0.01 ms */
}
