/* Perforation of a thick aluminium plate by an ogive-nosed rod: examples/scenes/thick_plate on a coarse grid, from a C host.
 *
 *   thick_plate PATH/TO/rod.stl [IMPACT_SPEED]
 *
 * Units mm, ms, g: speeds in m/s, stresses in MPa. Prints the residual velocity to the last digit, the same that
 *   ogive run scene.toml --set grid.cell_size=4 --set bodies.plate.spacing=2 --set "bodies.rod.spacing=[1.24,1.24,2]"
 * writes into summary.json. */
#include <math.h>
#include <ogive.h>
#include <ogive_geometry.h>
#include <stdio.h>
#include <stdlib.h>

static ogive_world* world;

/* A host decides itself what a failed call means: here the end of the program. */
static void require(ogive_status status, const char* message) {
  if (status == OGIVE_OK) return;
  fprintf(stderr, "thick_plate: %s: %s\n", ogive_status_name(status), message);
  exit(1);
}

static void set_vector(double* to, double x, double y, double z) {
  to[0] = x;
  to[1] = y;
  to[2] = z;
}

/* The rod's surface, filled with particles that are axial layers of a square lattice. */
static void fill_rod(const char* path, const double* direction, int64_t* count, double** xyz, double** volume) {
  ogive_mesh* mesh = NULL;
  ogive_mesh_read_def read;
  ogive_voxelise_def fill;
  require(ogive_mesh_create(&mesh), "a mesh");
  ogive_mesh_read_def_init(&read, sizeof read);
  require(ogive_mesh_read(mesh, path, &read), ogive_mesh_message(mesh));
  require(ogive_mesh_check(mesh), ogive_mesh_message(mesh));
  ogive_voxelise_def_init(&fill, sizeof fill);
  set_vector(fill.spacing, 1.24, 1.24, 2.0);
  set_vector(fill.axis, direction[0], direction[1], direction[2]);
  set_vector(fill.position, 0.0, 0.0, -4.0);
  require(ogive_mesh_voxelise(mesh, &fill, count, NULL, NULL), ogive_mesh_message(mesh));
  *xyz = malloc(3 * (size_t)*count * sizeof **xyz);
  *volume = malloc((size_t)*count * sizeof **volume);
  if (!*xyz || !*volume) require(OGIVE_ERROR_MEMORY, "the rod's particles");
  require(ogive_mesh_voxelise(mesh, &fill, count, *xyz, *volume), ogive_mesh_message(mesh));
  ogive_mesh_destroy(mesh);
}

int main(int argc, char** argv) {
  const double pi = 3.14159265358979323846, obliquity = 30.0 * (pi / 180.0);
  const double speed = argc > 2 ? atof(argv[2]) : 575.0;
  double direction[3];
  ogive_grid_def grid;
  ogive_numerics_def numerics;
  ogive_material_def steel_def, aluminium_def;
  ogive_material_id steel, aluminium;
  ogive_body_def rod_def, plate_def;
  ogive_solid_def box;
  ogive_body_id rod, plate;
  ogive_contact_def contact;
  ogive_stop_def stop;
  ogive_body_result initial = {.struct_size = sizeof initial}, final = {.struct_size = sizeof final};
  int64_t count = 0;
  double *xyz = NULL, *volume = NULL, forward = 0;

  if (argc < 2) {
    fprintf(stderr, "usage: thick_plate PATH/TO/rod.stl [IMPACT_SPEED]\n");
    return 2;
  }
  set_vector(direction, sin(obliquity), 0.0, cos(obliquity));
  require(ogive_world_create(&world), "a world");

  ogive_grid_def_init(&grid, sizeof grid);
  grid.cell_size = 4.0;
  set_vector(grid.domain_min, -100.0, 0.0, -120.0);
  set_vector(grid.domain_max, 160.0, 60.0, 160.0);
  grid.face[2] = OGIVE_FACE_SYMMETRY; /* y = 0: half of it is modelled */
  require(ogive_world_set_grid(world, &grid), ogive_world_message(world));

  ogive_numerics_def_init(&numerics, sizeof numerics);
  numerics.time_step_factor = 0.5;
  require(ogive_world_set_numerics(world, &numerics), ogive_world_message(world));

  ogive_material_def_init(&steel_def, sizeof steel_def);
  steel_def.density = 7.85e-3;
  steel_def.youngs_modulus = 200e3;
  steel_def.poisson_ratio = 0.3;
  require(ogive_material_add(world, "steel", &steel_def, &steel), ogive_world_message(world));

  ogive_material_def_init(&aluminium_def, sizeof aluminium_def);
  aluminium_def.strength = OGIVE_STRENGTH_JOHNSON_COOK;
  aluminium_def.eos = OGIVE_EOS_MIE_GRUNEISEN;
  aluminium_def.failure = OGIVE_FAILURE_PLASTIC_STRAIN;
  aluminium_def.density = 2.70e-3;
  aluminium_def.youngs_modulus = 69e3;
  aluminium_def.poisson_ratio = 0.3;
  aluminium_def.yield_stress = 262.0;
  aluminium_def.hardening_modulus = 52.1;
  aluminium_def.hardening_exponent = 0.41;
  aluminium_def.thermal_exponent = 0.859;
  aluminium_def.melt_temperature = 875.0;
  aluminium_def.room_temperature = 293.0;
  aluminium_def.specific_heat = 896.0;
  aluminium_def.eos_sound_speed = 5350.0;
  aluminium_def.eos_slope = 1.34;
  aluminium_def.gruneisen = 2.0;
  aluminium_def.failure_strain = 1.6;
  require(ogive_material_add(world, "aluminium", &aluminium_def, &aluminium), ogive_world_message(world));

  fill_rod(argv[1], direction, &count, &xyz, &volume);
  ogive_body_def_init(&rod_def, sizeof rod_def);
  rod_def.material = steel;
  set_vector(rod_def.velocity, speed * direction[0], 0.0, speed * direction[2]);
  require(ogive_body_add_particles(world, "rod", &rod_def, count, xyz, volume, &rod), ogive_world_message(world));
  free(xyz);
  free(volume);

  ogive_body_def_init(&plate_def, sizeof plate_def);
  plate_def.material = aluminium;
  ogive_solid_def_init(&box, sizeof box);
  box.solid = OGIVE_SOLID_BOX;
  set_vector(box.size, 120.0, 120.0, 26.3);
  set_vector(box.centre, 10.0, 0.0, 13.15);
  set_vector(box.spacing, 2.0, 2.0, 2.0);
  require(ogive_body_add_solid(world, "plate", &plate_def, &box, &plate), ogive_world_message(world));

  ogive_contact_def_init(&contact, sizeof contact);
  contact.method = OGIVE_CONTACT_HUANG_SECOND;
  contact.normal = OGIVE_NORMAL_MASTER;
  contact.master = rod;
  contact.detection = OGIVE_DETECTION_GAP;
  contact.gap_offset = 0.1;
  require(ogive_world_set_contact(world, &contact), ogive_world_message(world));

  ogive_stop_def_init(&stop, sizeof stop);
  stop.body = rod;
  stop.settle_window = 0.03;
  stop.settle_tolerance = 1.0;
  require(ogive_world_set_stop(world, &stop), ogive_world_message(world));

  require(ogive_world_prepare(world), ogive_world_message(world));
  require(ogive_body_result_get(world, rod, &initial), ogive_world_message(world));
  require(ogive_world_advance(world, 0.6, 0, NULL, NULL), ogive_world_message(world));
  require(ogive_body_result_get(world, rod, &final), ogive_world_message(world));

  /* A rod that does not go forward any more has no residual velocity. */
  for (int c = 0; c < 3; ++c) forward += final.velocity[c] * initial.velocity[c];
  printf("residual velocity %.17g m/s\n", forward > 0 ? final.speed : 0.0);
  ogive_world_destroy(world);
  return 0;
}
