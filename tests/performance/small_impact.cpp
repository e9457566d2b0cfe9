// A small impact for the count of instructions: a steel block strikes an aluminium plate (Johnson-Cook, Mie-Grueneisen, failure),
// second contact method, symmetry face, 8,000 particles, 30 steps.
//
//   ogive_small_impact linear_flip | bspline_affine | stress_last | gimp_flip
#include <cstdio>
#include <cstring>

#include "ogive.h"

int main(int argc, char** argv) {
  const char* const name = argc > 1 ? argv[1] : "";
  const bool linear = std::strcmp(name, "linear_flip") == 0, last = std::strcmp(name, "stress_last") == 0,
             gimp = std::strcmp(name, "gimp_flip") == 0;
  if (!linear && !last && !gimp && std::strcmp(name, "bspline_affine") != 0) return 2;

  ogive_world* world = nullptr;
  if (ogive_world_create(&world)) return 1;
  ogive_grid_def grid;
  ogive_grid_def_init(&grid, sizeof grid);
  grid.cell_size = 2;
  for (int axis = 0; axis < 3; ++axis) grid.domain_min[axis] = axis == 1 ? 0 : -24, grid.domain_max[axis] = 24;
  grid.face[2] = OGIVE_FACE_SYMMETRY;
  ogive_numerics_def numerics;
  ogive_numerics_def_init(&numerics, sizeof numerics);
  numerics.threads = 1;
  numerics.shape_function = linear ? OGIVE_SHAPE_LINEAR : gimp ? OGIVE_SHAPE_GIMP : OGIVE_SHAPE_QUADRATIC_BSPLINE;
  numerics.transfer = linear || gimp ? OGIVE_TRANSFER_FLIP : OGIVE_TRANSFER_AFFINE_FLIP;
  numerics.update_order = last ? OGIVE_UPDATE_STRESS_LAST : OGIVE_UPDATE_STRESS_FIRST;
  numerics.time_step_factor = 0.4;

  ogive_material_def steel, aluminium;
  ogive_material_def_init(&steel, sizeof steel);
  steel.density = 7.85e-3, steel.youngs_modulus = 200e3, steel.poisson_ratio = 0.3;
  ogive_material_def_init(&aluminium, sizeof aluminium);
  aluminium.density = 2.7e-3, aluminium.youngs_modulus = 69e3, aluminium.poisson_ratio = 0.3;
  aluminium.strength = OGIVE_STRENGTH_JOHNSON_COOK, aluminium.eos = OGIVE_EOS_MIE_GRUNEISEN;
  aluminium.yield_stress = 262, aluminium.hardening_modulus = 52.1, aluminium.hardening_exponent = 0.41;
  aluminium.thermal_exponent = 0.859, aluminium.melt_temperature = 875, aluminium.specific_heat = 896;
  aluminium.eos_sound_speed = 5350, aluminium.eos_slope = 1.34, aluminium.gruneisen = 2;
  aluminium.failure = OGIVE_FAILURE_PLASTIC_STRAIN, aluminium.failure_strain = 1.6;

  ogive_material_id materials[2];
  ogive_body_def block, plate;
  ogive_body_def_init(&block, sizeof block);
  ogive_body_def_init(&plate, sizeof plate);
  block.velocity[2] = 600;
  ogive_solid_def of_block, of_plate;
  ogive_solid_def_init(&of_block, sizeof of_block);
  ogive_solid_def_init(&of_plate, sizeof of_plate);
  const double block_size[3] = {8, 4, 12}, plate_size[3] = {36, 18, 12};
  of_block.solid = of_plate.solid = OGIVE_SOLID_BOX;
  for (int axis = 0; axis < 3; ++axis) {
    of_block.size[axis] = block_size[axis], of_plate.size[axis] = plate_size[axis];
    of_block.spacing[axis] = of_plate.spacing[axis] = 1;
  }
  of_block.centre[1] = 2, of_block.centre[2] = -6.5, of_plate.centre[1] = 9, of_plate.centre[2] = 6;
  ogive_body_id body;
  bool good = !ogive_world_set_grid(world, &grid) && !ogive_world_set_numerics(world, &numerics) &&
              !ogive_material_add(world, "steel", &steel, &materials[0]) &&
              !ogive_material_add(world, "aluminium", &aluminium, &materials[1]);
  block.material = materials[0], plate.material = materials[1];
  good = good && !ogive_body_add_solid(world, "block", &block, &of_block, &body) &&
         !ogive_body_add_solid(world, "plate", &plate, &of_plate, &body) && !ogive_world_prepare(world) &&
         !ogive_world_advance(world, 1, 30, nullptr, nullptr);
  if (!good) std::fprintf(stderr, "%s\n", ogive_world_message(world));
  ogive_world_destroy(world);
  return good ? 0 : 1;
}
