/* Two small blocks that meet; what the tests of the interface work on. mm, ms, g. */
#ifndef OGIVE_TESTS_CAPI_SMALL_WORLD_H
#define OGIVE_TESTS_CAPI_SMALL_WORLD_H

#include "check.h"

typedef struct small_world {
  ogive_world* world;
  ogive_material_id copper;
  ogive_body_id left, right;
  ogive_load_id load;
} small_world;

static inline ogive_grid_def small_grid(void) {
  ogive_grid_def grid;
  ogive_grid_def_init(&grid, sizeof grid);
  grid.cell_size = 1.0;
  set3(grid.domain_min, -6, -4, -4);
  set3(grid.domain_max, 6, 4, 4);
  return grid;
}

static inline ogive_material_def small_material(void) {
  ogive_material_def copper;
  ogive_material_def_init(&copper, sizeof copper);
  copper.strength = OGIVE_STRENGTH_JOHNSON_COOK;
  copper.density = 8.93e-3;
  copper.youngs_modulus = 117e3;
  copper.poisson_ratio = 0.35;
  copper.yield_stress = 90;
  copper.hardening_modulus = 290;
  copper.hardening_exponent = 0.31;
  copper.thermal_exponent = 1.09;
  copper.melt_temperature = 1356;
  copper.specific_heat = 383;
  copper.failure = OGIVE_FAILURE_PLASTIC_STRAIN;
  copper.failure_strain = 2;
  return copper;
}

static inline ogive_solid_def small_box(double x) {
  ogive_solid_def box;
  ogive_solid_def_init(&box, sizeof box);
  box.solid = OGIVE_SOLID_BOX;
  set3(box.size, 2, 2, 2);
  set3(box.centre, x, 0, 0);
  set3(box.spacing, 0.5, 0.5, 0.5);
  return box;
}

/* Complete but for ogive_world_prepare. */
static inline small_world build_small_world(void) {
  small_world small = {NULL, {-1}, {-1}, {-1}, {-1}};
  ogive_grid_def grid = small_grid();
  ogive_material_def copper = small_material();
  ogive_solid_def box = small_box(-1);
  ogive_body_def body;
  ogive_load_def load;
  if (ogive_world_create(&small.world) != OGIVE_OK) return small;
  CHECK_OK(small.world, ogive_world_set_grid(small.world, &grid));
  CHECK_OK(small.world, ogive_material_add(small.world, "copper", &copper, &small.copper));
  ogive_body_def_init(&body, sizeof body);
  body.material = small.copper;
  set3(body.velocity, 50, 0, 0);
  CHECK_OK(small.world, ogive_body_add_solid(small.world, "left", &body, &box, &small.left));
  box = small_box(1);
  set3(body.velocity, -50, 0, 0);
  CHECK_OK(small.world, ogive_body_add_solid(small.world, "right", &body, &box, &small.right));
  ogive_load_def_init(&load, sizeof load);
  load.body = small.right;
  set3(load.value, 0, 0, 1);
  CHECK_OK(small.world, ogive_load_add(small.world, &load, &small.load));
  return small;
}

#endif
