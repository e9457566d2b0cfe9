/* A small host as an outside project would have it: two blocks meet, and momentum stays. Prints the speed of one. */
#include <math.h>
#include <ogive.h>
#include <stdio.h>

int main(void) {
  ogive_world* world = NULL;
  ogive_grid_def grid;
  ogive_material_def steel;
  ogive_material_id material;
  ogive_body_def body;
  ogive_solid_def box;
  ogive_body_id left, right;
  ogive_body_result result = {.struct_size = sizeof result};
  ogive_ledger ledger = {.struct_size = sizeof ledger};
  if (ogive_abi_version() < OGIVE_ABI || ogive_world_create(&world) != OGIVE_OK) return 1;
  ogive_grid_def_init(&grid, sizeof grid);
  ogive_material_def_init(&steel, sizeof steel);
  ogive_body_def_init(&body, sizeof body);
  ogive_solid_def_init(&box, sizeof box);
  grid.cell_size = 1.0;
  steel.density = 7.85e-3, steel.youngs_modulus = 200e3, steel.poisson_ratio = 0.3;
  box.solid = OGIVE_SOLID_BOX;
  for (int c = 0; c < 3; ++c) grid.domain_min[c] = -6.0, grid.domain_max[c] = 6.0, box.size[c] = 2.0, box.spacing[c] = 0.5;
  ogive_world_set_grid(world, &grid);
  ogive_material_add(world, "steel", &steel, &material);
  body.material = material;
  body.velocity[0] = 50.0, box.centre[0] = -1.0;
  ogive_body_add_solid(world, "left", &body, &box, &left);
  body.velocity[0] = 0.0, box.centre[0] = 1.0;
  ogive_body_add_solid(world, "right", &body, &box, &right);
  if (ogive_world_prepare(world) || ogive_world_advance(world, 0.005, 0, NULL, NULL) ||
      ogive_body_result_get(world, right, &result) || ogive_world_ledger(world, &ledger)) {
    fprintf(stderr, "%s\n", ogive_world_message(world));
    return 1;
  }
  printf("right block: %.17g\n", result.velocity[0]);
  const double momentum = 8.0 * steel.density * 50.0;
  ogive_world_destroy(world);
  return result.velocity[0] > 5.0 && fabs(ledger.momentum[0] - momentum) < 1e-9 * momentum ? 0 : 1;
}
