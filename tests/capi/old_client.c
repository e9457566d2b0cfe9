/* A host of 0.1.0: compiled with the header that was kept of it (tests/capi/abi/include-0.1.0) and run on today's library. Two
 * blocks meet; the structs have the sizes of then. Argument: a directory to write to. */
#include <math.h>
#include <ogive.h>
#include <stdio.h>
#include <string.h>

#if OGIVE_VERSION_MAJOR != 0 || OGIVE_VERSION_MINOR != 1 || defined(OGIVE_ABI)
#error "this must be compiled with the header of 0.1.0"
#endif

#define NEED(condition)                                                                            \
  do {                                                                                             \
    if (!(condition)) {                                                                            \
      printf("%s:%d: %s: %s\n", __FILE__, __LINE__, #condition, world ? ogive_world_message(world) : ""); \
      return 1;                                                                                    \
    }                                                                                              \
  } while (0)

static int32_t count_steps(ogive_world* world, void* user) {
  (void)world;
  return ++*(int*)user >= 100;
}

int main(int argc, char** argv) {
  ogive_world* world = NULL;
  ogive_grid_def grid;
  ogive_numerics_def numerics;
  ogive_clamp_def clamp;
  ogive_material_def copper;
  ogive_material_id material;
  ogive_body_def body;
  ogive_solid_def box;
  ogive_body_id left, right;
  ogive_contact_def contact;
  ogive_stop_def stop;
  /* Each with a mark behind it, which nothing may overwrite. */
  struct { ogive_body_result result; double mark; } a = {{.struct_size = sizeof(ogive_body_result)}, 7};
  struct { ogive_ledger ledger; double mark; } l = {{.struct_size = sizeof(ogive_ledger)}, 7};
  struct { ogive_progress progress; double mark; } p = {{.struct_size = sizeof(ogive_progress)}, 7};
  int steps = 0;
  char path[4096];
  NEED(argc == 2);
  NEED(ogive_world_create(&world) == OGIVE_OK);
  ogive_grid_def_init(&grid, sizeof grid);
  grid.cell_size = 1;
  for (int c = 0; c < 3; ++c) grid.domain_min[c] = -6, grid.domain_max[c] = 6;
  NEED(ogive_world_set_grid(world, &grid) == OGIVE_OK);
  ogive_numerics_def_init(&numerics, sizeof numerics);
  NEED(numerics.struct_size == sizeof numerics && numerics.time_step_factor == 0.5);
  NEED(ogive_world_set_numerics(world, &numerics) == OGIVE_OK);
  ogive_clamp_def_init(&clamp, sizeof clamp);
  clamp.a[0] = 5, clamp.b[0] = 6;
  NEED(ogive_clamp_add(world, &clamp) == OGIVE_OK);
  ogive_material_def_init(&copper, sizeof copper);
  copper.density = 8.93e-3, copper.youngs_modulus = 117e3, copper.poisson_ratio = 0.35;
  NEED(ogive_material_add(world, "copper", &copper, &material) == OGIVE_OK);
  ogive_body_def_init(&body, sizeof body);
  body.material = material;
  ogive_solid_def_init(&box, sizeof box);
  box.solid = OGIVE_SOLID_BOX;
  for (int c = 0; c < 3; ++c) box.size[c] = 2, box.spacing[c] = 0.5;
  box.centre[0] = -1, body.velocity[0] = 50;
  NEED(ogive_body_add_solid(world, "left", &body, &box, &left) == OGIVE_OK);
  box.centre[0] = 1, body.velocity[0] = -50;
  NEED(ogive_body_add_solid(world, "right", &body, &box, &right) == OGIVE_OK);
  ogive_contact_def_init(&contact, sizeof contact);
  NEED(ogive_world_set_contact(world, &contact) == OGIVE_OK);
  ogive_stop_def_init(&stop, sizeof stop);
  NEED(ogive_world_set_stop(world, &stop) == OGIVE_OK);
  NEED(ogive_world_prepare(world) == OGIVE_OK);
  NEED(ogive_world_advance(world, 1, 0, count_steps, &steps) == OGIVE_OK);
  NEED(steps == 100);
  NEED(ogive_world_progress(world, &p.progress) == OGIVE_OK && p.progress.steps == 100 && p.mark == 7);
  NEED(ogive_body_result_get(world, left, &a.result) == OGIVE_OK && a.mark == 7);
  NEED(a.result.struct_size == sizeof(ogive_body_result));
  NEED(ogive_world_ledger(world, &l.ledger) == OGIVE_OK && l.mark == 7);
  /* Mirror images: they have bounced, or at least met. */
  NEED(a.result.velocity[0] < 49 && fabs(l.ledger.momentum[0]) < 1e-9);
  snprintf(path, sizeof path, "%s/old_client.h5", argv[1]);
  NEED(ogive_checkpoint_write(world, path) == OGIVE_OK);
  ogive_world_destroy(world);
  world = NULL;
  NEED(ogive_world_create(&world) == OGIVE_OK);
  NEED(ogive_checkpoint_read(world, path) == OGIVE_OK);
  NEED(ogive_world_step(world, 0) == OGIVE_OK);
  ogive_world_destroy(world);
  printf("library %s, program of %d.%d.%d: all good\n", ogive_version(), OGIVE_VERSION_MAJOR, OGIVE_VERSION_MINOR,
         OGIVE_VERSION_PATCH);
  return 0;
}
