/* Every function of the C headers refuses what it cannot use: null pointers, values that are not numbers or outside their range,
 * wrong sizes, unknown ids, calls in the wrong order. It says which field, changes nothing, and the world goes on working.
 * (tests/capi/coverage.py checks that no function is left out.) Argument: a directory to write to. */
#include <math.h>
#include <ogive_geometry.h>
#include <stdlib.h>

#include "small_world.h"

static const double motion_time[1] = {0};
static const ogive_body_id stale = {7}, none = {-1}, below = {-5};

static void null_worlds(void) {
  ogive_body_id body;
  double number;
  int64_t count = 0;
  size_t needed;
  const void* data;
  const double value[3] = {0, 0, 0};
  CHECK(ogive_world_create(NULL) == OGIVE_ERROR_ARGUMENT);
  ogive_world_destroy(NULL);
  CHECK(strcmp(ogive_world_message(NULL), "") == 0);
  CHECK(ogive_world_report(NULL, OGIVE_OK, "") == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_set_log(NULL, NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_set_grid(NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_set_numerics(NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_set_threads(NULL, 1) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_clamp_add(NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_load_add(NULL, NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_load_set(NULL, (ogive_load_id){0}, value) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_load_result_get(NULL, (ogive_load_id){0}, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_material_add(NULL, "m", NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_body_add_particles(NULL, "b", NULL, 0, NULL, NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_body_add_solid(NULL, "b", NULL, NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_body_add_particle_file(NULL, "b", NULL, "x", NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_solid_particles(NULL, NULL, &count, NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_set_contact(NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_contact_set_pair(NULL, none, none, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_wall_add(NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_body_set_surface(NULL, none, 4, value, 4, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_body_set_surface_solid(NULL, none, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_body_set_motion(NULL, none, 1, &number, NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_contact_method_name(-1) == NULL && ogive_contact_method_name(ogive_contact_method_count()) == NULL);
  CHECK(ogive_contact_normal_name(-1) == NULL && ogive_contact_normal_name(ogive_contact_normal_count()) == NULL);
  CHECK(ogive_world_set_stop(NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_prepare(NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_reopen(NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_material_change(NULL, (ogive_material_id){0}, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_plan(NULL, NULL, 0, &needed) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_stable_time_step(NULL, &number) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_step(NULL, 0) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_advance(NULL, 1, 0, NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_progress(NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_ledger(NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_check_energy(NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_body_count(NULL) == 0);
  CHECK(ogive_body_name(NULL, none) == NULL);
  CHECK(ogive_body_find(NULL, "b", &body) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_body_result_get(NULL, none, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_pair_result_get(NULL, none, none, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_field_count(NULL, none) == 0);
  CHECK(ogive_field_name(NULL, none, 0, NULL) == NULL);
  CHECK(ogive_field_get(NULL, none, "mass", &number, 1) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_field_set(NULL, none, "velocity", &number, 1) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_field_view_get(NULL, none, "mass", NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_attach(NULL, "a", &number, 8) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_attachment(NULL, "a", &data, &count) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_save(NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_world_load(NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_checkpoint_write(NULL, "x") == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_checkpoint_read(NULL, "x") == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_particles_write(NULL, "x") == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_series_write(NULL, "x", 0, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_status_name(99)[0] != 0);
}

/* An init function writes what the caller has room for, and nothing through a null pointer. */
#define INIT_KEEPS_TO_ITS_SIZE(type)                                                  \
  do {                                                                                \
    unsigned char bytes[sizeof(type)];                                                \
    memset(bytes, 0xa5, sizeof bytes);                                                \
    type##_init(NULL, sizeof(type));                                                  \
    type##_init((type*)(void*)bytes, 0);                                              \
    CHECK(bytes[0] == 0xa5);                                                          \
    type##_init((type*)(void*)bytes, 8);                                              \
    CHECK(bytes[0] == 8 && bytes[8] == 0xa5);                                         \
    type##_init((type*)(void*)bytes, sizeof(type));                                   \
    CHECK(((type*)(void*)bytes)->struct_size == sizeof(type));                        \
  } while (0)

static void init_functions(void) {
  INIT_KEEPS_TO_ITS_SIZE(ogive_grid_def);
  INIT_KEEPS_TO_ITS_SIZE(ogive_numerics_def);
  INIT_KEEPS_TO_ITS_SIZE(ogive_clamp_def);
  INIT_KEEPS_TO_ITS_SIZE(ogive_load_def);
  INIT_KEEPS_TO_ITS_SIZE(ogive_material_def);
  INIT_KEEPS_TO_ITS_SIZE(ogive_body_def);
  INIT_KEEPS_TO_ITS_SIZE(ogive_solid_def);
  INIT_KEEPS_TO_ITS_SIZE(ogive_contact_def);
  INIT_KEEPS_TO_ITS_SIZE(ogive_stop_def);
  INIT_KEEPS_TO_ITS_SIZE(ogive_mesh_read_def);
  INIT_KEEPS_TO_ITS_SIZE(ogive_voxelise_def);
}

/* The call with one field of a good definition changed for the worse. */
#define WITH(def, field, value, call, word)   \
  do {                                        \
    const __typeof__(def) kept = def;         \
    def.field = value;                        \
    CHECK_REFUSED(world, call, word);         \
    def = kept;                               \
  } while (0)

#define BAD_SIZES(def, call)                              \
  do {                                                    \
    WITH(def, struct_size, 0, call, "struct_size");       \
    WITH(def, struct_size, 4, call, "struct_size");       \
    WITH(def, struct_size, sizeof def + 8, call, "struct_size"); \
  } while (0)

static void definitions(void) {
  ogive_world* world = NULL;
  ogive_grid_def grid = small_grid();
  ogive_numerics_def numerics;
  ogive_clamp_def clamp;
  ogive_load_def load;
  ogive_material_def copper = small_material();
  ogive_material_id material = {-1};
  ogive_body_def body;
  ogive_solid_def box = small_box(0);
  ogive_contact_def contact;
  ogive_stop_def stop;
  int64_t count = 0;
  const double xyz[6] = {0.25, 0.25, 0.25, 0.75, 0.25, 0.25}, volume[2] = {0.125, 0.125};
  double bad_xyz[6] = {0.25, NAN, 0.25, 0.75, 0.25, 0.25}, bad_volume[2] = {0.125, -1};
  char long_name[100];
  memset(long_name, 'x', sizeof long_name);
  long_name[sizeof long_name - 1] = 0;
  CHECK(ogive_world_create(&world) == OGIVE_OK);

  CHECK_ORDER(world, ogive_world_prepare(world), "grid");
  CHECK_ORDER(world, ogive_world_reopen(world), "prepared");
  CHECK_ORDER(world, ogive_material_change(world, (ogive_material_id){0}, &copper), "prepared");
  CHECK_REFUSED(world, ogive_world_set_grid(world, NULL), "def");
  BAD_SIZES(grid, ogive_world_set_grid(world, &grid));
  WITH(grid, cell_size, 0, ogive_world_set_grid(world, &grid), "cell_size");
  WITH(grid, cell_size, NAN, ogive_world_set_grid(world, &grid), "cell_size");
  WITH(grid, domain_max[1], -9, ogive_world_set_grid(world, &grid), "domain_max[y]");
  WITH(grid, domain_min[2], -INFINITY, ogive_world_set_grid(world, &grid), "domain_min[z]");
  WITH(grid, face[5], 3, ogive_world_set_grid(world, &grid), "face z max");
  WITH(grid, space, 3, ogive_world_set_grid(world, &grid), "space");
  WITH(grid, space, OGIVE_SPACE_AXISYMMETRIC, ogive_world_set_grid(world, &grid), "domain_min[x]");
  WITH(grid, thickness, 0, ogive_world_set_grid(world, &grid), "thickness");

  ogive_numerics_def_init(&numerics, sizeof numerics);
  CHECK_REFUSED(world, ogive_world_set_numerics(world, NULL), "def");
  BAD_SIZES(numerics, ogive_world_set_numerics(world, &numerics));
  WITH(numerics, time_step_factor, NAN, ogive_world_set_numerics(world, &numerics), "time_step_factor");
  WITH(numerics, time_step_factor, 2, ogive_world_set_numerics(world, &numerics), "time_step_factor");
  WITH(numerics, maximum_time_step, 0, ogive_world_set_numerics(world, &numerics), "maximum_time_step");
  WITH(numerics, energy_warning, 0, ogive_world_set_numerics(world, &numerics), "energy_warning");
  WITH(numerics, energy_limit, NAN, ogive_world_set_numerics(world, &numerics), "energy_limit");
  WITH(numerics, energy_loss_limit, 0, ogive_world_set_numerics(world, &numerics), "energy_loss_limit");
  WITH(numerics, drop_debris, 2, ogive_world_set_numerics(world, &numerics), "drop_debris");
  WITH(numerics, skip_resting, 2, ogive_world_set_numerics(world, &numerics), "skip_resting");
  WITH(numerics, gravity[0], NAN, ogive_world_set_numerics(world, &numerics), "gravity");
  WITH(numerics, threads, -1, ogive_world_set_numerics(world, &numerics), "threads");
  WITH(numerics, pic_fraction, 1.5, ogive_world_set_numerics(world, &numerics), "pic_fraction");
  CHECK_REFUSED(world, ogive_world_set_threads(world, 1025), "threads");

  CHECK_REFUSED(world, ogive_material_add(world, "copper", NULL, &material), "def");
  CHECK_REFUSED(world, ogive_material_add(world, NULL, &copper, &material), "name");
  CHECK_REFUSED(world, ogive_material_add(world, "", &copper, &material), "name");
  CHECK_REFUSED(world, ogive_material_add(world, long_name, &copper, &material), "name");
  BAD_SIZES(copper, ogive_material_add(world, "copper", &copper, &material));
  WITH(copper, density, -1, ogive_material_add(world, "copper", &copper, &material), "density");
  WITH(copper, poisson_ratio, NAN, ogive_material_add(world, "copper", &copper, &material), "poisson_ratio");
  WITH(copper, strength, 77, ogive_material_add(world, "copper", &copper, &material), "strength");
  WITH(copper, failure_strain, 0, ogive_material_add(world, "copper", &copper, &material), "failure_strain");
  CHECK_OK(world, ogive_material_add(world, "copper", &copper, &material));
  CHECK_REFUSED(world, ogive_material_add(world, "copper", &copper, &material), "taken");

  ogive_body_def_init(&body, sizeof body);
  body.material = material;
  CHECK_ORDER(world, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL), "grid");
  CHECK_OK(world, ogive_world_set_grid(world, &grid));
  CHECK_REFUSED(world, ogive_body_add_particles(world, "pair", NULL, 2, xyz, volume, NULL), "def");
  CHECK_REFUSED(world, ogive_body_add_particles(world, NULL, &body, 2, xyz, volume, NULL), "name");
  CHECK_REFUSED(world, ogive_body_add_particles(world, "pair", &body, 0, xyz, volume, NULL), "at least one particle");
  CHECK_REFUSED(world, ogive_body_add_particles(world, "pair", &body, -1, xyz, volume, NULL), "at least one particle");
  CHECK_REFUSED(world, ogive_body_add_particles(world, "pair", &body, INT64_MAX, xyz, volume, NULL), "2^31");
  CHECK_REFUSED(world, ogive_body_add_particles(world, "pair", &body, 2, NULL, volume, NULL), "xyz");
  CHECK_REFUSED(world, ogive_body_add_particles(world, "pair", &body, 2, xyz, NULL, NULL), "volume");
  CHECK_REFUSED(world, ogive_body_add_particles(world, "pair", &body, 2, bad_xyz, volume, NULL), "position of particle 0");
  CHECK_REFUSED(world, ogive_body_add_particles(world, "pair", &body, 2, xyz, bad_volume, NULL), "volume of particle 1");
  bad_xyz[1] = 99;
  CHECK_REFUSED(world, ogive_body_add_particles(world, "pair", &body, 2, bad_xyz, volume, NULL), "inside the domain");
  BAD_SIZES(body, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL));
  WITH(body, material.index, 3, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL), "material");
  WITH(body, velocity[2], INFINITY, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL), "velocity");
  WITH(body, coarse_beyond, -1, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL), "coarse_beyond");
  WITH(body, coarse_beyond, NAN, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL), "coarse_beyond");
  WITH(body, coarse_beyond, INFINITY, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL), "coarse_beyond");
  WITH(body, coarse_from[1], NAN, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL), "coarse_from");
  WITH(body, coarse_to[0], INFINITY, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL), "coarse_to");
  body.coarse_beyond = 1;
  WITH(body, formulation, OGIVE_FORMULATION_RIGID_FREE, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL), "coarse_beyond");
  WITH(body, formulation, OGIVE_FORMULATION_TOTAL_LAGRANGIAN, ogive_body_add_particles(world, "pair", &body, 2, xyz, volume, NULL), "coarse_beyond");
  body.coarse_beyond = 0;

  CHECK_REFUSED(world, ogive_body_add_solid(world, "box", &body, NULL, NULL), "solid");
  BAD_SIZES(box, ogive_body_add_solid(world, "box", &body, &box, NULL));
  WITH(box, size[0], NAN, ogive_body_add_solid(world, "box", &body, &box, NULL), "size");
  WITH(box, spacing[1], 0, ogive_body_add_solid(world, "box", &body, &box, NULL), "spacing");
  WITH(box, solid, 9, ogive_solid_particles(world, &box, &count, NULL, NULL), "solid");
  CHECK_REFUSED(world, ogive_solid_particles(world, &box, NULL, NULL, NULL), "count");
  count = 3;
  CHECK_REFUSED(world, ogive_solid_particles(world, &box, &count, bad_xyz, bad_volume), "room for 64");
  CHECK_OK(world, ogive_body_add_solid(world, "box", &body, &box, NULL));
  CHECK_REFUSED(world, ogive_body_add_solid(world, "box", &body, &box, NULL), "taken");
  CHECK_ORDER(world, ogive_world_set_grid(world, &grid), "before the bodies");
  CHECK(ogive_body_count(world) == 1);

  ogive_clamp_def_init(&clamp, sizeof clamp);
  CHECK_REFUSED(world, ogive_clamp_add(world, NULL), "def");
  BAD_SIZES(clamp, ogive_clamp_add(world, &clamp));
  WITH(clamp, a[0], NAN, ogive_clamp_add(world, &clamp), "clamp a");
  WITH(clamp, b[0], -1, ogive_clamp_add(world, &clamp), "clamp b");
  WITH(clamp, axes, 0, ogive_clamp_add(world, &clamp), "axes");
  WITH(clamp, region, OGIVE_REGION_OUTSIDE_CYLINDER, ogive_clamp_add(world, &clamp), "radius");

  ogive_load_def_init(&load, sizeof load);
  CHECK_REFUSED(world, ogive_load_add(world, NULL, NULL), "def");
  BAD_SIZES(load, ogive_load_add(world, &load, NULL));
  WITH(load, kind, 3, ogive_load_add(world, &load, NULL), "load kind");
  WITH(load, kind, OGIVE_LOAD_TRACTION, ogive_load_add(world, &load, NULL), "load area");
  WITH(load, region, -1, ogive_load_add(world, &load, NULL), "load region");
  WITH(load, value[1], NAN, ogive_load_add(world, &load, NULL), "load value[1]");
  WITH(load, body, below, ogive_load_add(world, &load, NULL), "load body");
  load.kind = OGIVE_LOAD_VELOCITY;
  WITH(load, axes, 8, ogive_load_add(world, &load, NULL), "load axes");

  ogive_contact_def_init(&contact, sizeof contact);
  CHECK_REFUSED(world, ogive_world_set_contact(world, NULL), "def");
  BAD_SIZES(contact, ogive_world_set_contact(world, &contact));
  WITH(contact, method, 99, ogive_world_set_contact(world, &contact), "method");
  WITH(contact, friction, -0.1, ogive_world_set_contact(world, &contact), "friction");
  WITH(contact, gap_offset, NAN, ogive_world_set_contact(world, &contact), "gap_offset");
  WITH(contact, master, below, ogive_world_set_contact(world, &contact), "master");
  CHECK_REFUSED(world, ogive_contact_set_pair(world, (ogive_body_id){0}, stale, &contact), "body");
  CHECK_REFUSED(world, ogive_contact_set_pair(world, (ogive_body_id){0}, (ogive_body_id){0}, &contact), "two bodies");

  ogive_wall_def wall;
  ogive_wall_def_init(&wall, sizeof wall);
  CHECK_REFUSED(world, ogive_wall_add(world, NULL), "def");
  BAD_SIZES(wall, ogive_wall_add(world, &wall));
  WITH(wall, method, -1, ogive_wall_add(world, &wall), "method");
  WITH(wall, normal[2], 0, ogive_wall_add(world, &wall), "normal");
  WITH(wall, point[0], NAN, ogive_wall_add(world, &wall), "point");
  WITH(wall, friction, -1, ogive_wall_add(world, &wall), "friction");
  WITH(wall, detection, 3, ogive_wall_add(world, &wall), "detection");
  static const double tetrahedron[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  static const int32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, open[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 0, 2, 1};
  ogive_solid_def no_solid;
  ogive_solid_def_init(&no_solid, sizeof no_solid);
  CHECK_REFUSED(world, ogive_body_set_surface(world, stale, 4, tetrahedron, 4, faces), "body");
  CHECK_REFUSED(world, ogive_body_set_surface(world, (ogive_body_id){0}, 3, tetrahedron, 4, faces), "vertex_count");
  CHECK_REFUSED(world, ogive_body_set_surface(world, (ogive_body_id){0}, 4, tetrahedron, 3, faces), "triangle_count");
  CHECK_REFUSED(world, ogive_body_set_surface(world, (ogive_body_id){0}, 4, NULL, 4, faces), "xyz");
  CHECK_REFUSED(world, ogive_body_set_surface(world, (ogive_body_id){0}, 4, tetrahedron, 4, NULL), "corners");
  CHECK_REFUSED(world, ogive_body_set_surface(world, (ogive_body_id){0}, 4, tetrahedron, 4, open), "surface");
  CHECK_REFUSED(world, ogive_body_set_surface_solid(world, stale, &no_solid), "body");
  CHECK_REFUSED(world, ogive_body_set_surface_solid(world, (ogive_body_id){0}, NULL), "solid");
  CHECK_REFUSED(world, ogive_body_set_surface_solid(world, (ogive_body_id){0}, &no_solid), "size");
  CHECK_REFUSED(world, ogive_body_set_motion(world, stale, 1, motion_time, NULL, NULL), "body");
  CHECK_REFUSED(world, ogive_body_set_motion(world, (ogive_body_id){0}, 1, motion_time, NULL, NULL), "PRESCRIBED");

  ogive_stop_def_init(&stop, sizeof stop);
  CHECK_REFUSED(world, ogive_world_set_stop(world, NULL), "def");
  BAD_SIZES(stop, ogive_world_set_stop(world, &stop));
  WITH(stop, settle_window, -1, ogive_world_set_stop(world, &stop), "settle_window");
  WITH(stop, settle_window, 1, ogive_world_set_stop(world, &stop), "settle_tolerance");
  WITH(stop, exchange_window, -1, ogive_world_set_stop(world, &stop), "exchange_window");
  WITH(stop, exchange_tolerance, 0, ogive_world_set_stop(world, &stop), "exchange_tolerance");
  WITH(stop, exchange_tolerance, 1, ogive_world_set_stop(world, &stop), "exchange_tolerance");
  WITH(stop, body, below, ogive_world_set_stop(world, &stop), "stop body");

  /* Ids that are found to be unknown when the model is whole; then it can be mended. */
  stop.body = stale;
  CHECK_OK(world, ogive_world_set_stop(world, &stop));
  CHECK_REFUSED(world, ogive_world_prepare(world), "stop body");
  stop.body = none;
  CHECK_OK(world, ogive_world_set_stop(world, &stop));
  CHECK_OK(world, ogive_world_prepare(world));
  ogive_world_destroy(world);

  /* Bodies that overlap, a traction that meets nothing. */
  small_world small = build_small_world();
  world = small.world;
  body.material = small.copper;
  load.kind = OGIVE_LOAD_TRACTION;
  load.body = small.left;
  load.area = 4;
  load.region = OGIVE_REGION_BOX;
  set3(load.a, 3, -1, -1);
  set3(load.b, 4, 1, 1);
  CHECK_OK(world, ogive_load_add(world, &load, NULL));
  CHECK_REFUSED(world, ogive_world_prepare(world), "load 1: a traction must meet particles");
  box = small_box(0.5);
  CHECK_OK(world, ogive_body_add_solid(world, "third", &body, &box, NULL));
  CHECK_REFUSED(world, ogive_world_prepare(world), "must not overlap");
  ogive_world_destroy(world);
}

static void before_it_is_prepared(void) {
  small_world small = build_small_world();
  ogive_world* world = small.world;
  ogive_progress progress = {.struct_size = sizeof progress};
  ogive_ledger ledger = {.struct_size = sizeof ledger};
  ogive_body_result result = {.struct_size = sizeof result};
  ogive_pair_result pair = {.struct_size = sizeof pair};
  ogive_load_result load = {.struct_size = sizeof load};
  ogive_field_view view = {.struct_size = sizeof view};
  ogive_writer writer = {sizeof writer, 0, NULL, NULL};
  double values[3 * 64];
  size_t needed;
  CHECK_ORDER(world, ogive_world_plan(world, NULL, 0, &needed), "prepare");
  CHECK_ORDER(world, ogive_world_stable_time_step(world, values), "prepare");
  CHECK_ORDER(world, ogive_world_step(world, 0), "prepare");
  CHECK_ORDER(world, ogive_world_advance(world, 1, 0, NULL, NULL), "prepare");
  CHECK_ORDER(world, ogive_world_progress(world, &progress), "prepare");
  CHECK_ORDER(world, ogive_world_ledger(world, &ledger), "prepare");
  CHECK_ORDER(world, ogive_world_check_energy(world), "prepare");
  CHECK_ORDER(world, ogive_body_result_get(world, small.left, &result), "prepare");
  CHECK_ORDER(world, ogive_pair_result_get(world, small.left, small.right, &pair), "prepare");
  CHECK_ORDER(world, ogive_load_result_get(world, small.load, &load), "prepare");
  CHECK_ORDER(world, ogive_field_get(world, small.left, "position", values, 3 * 64), "prepare");
  CHECK_ORDER(world, ogive_field_set(world, small.left, "velocity", values, 3 * 64), "prepare");
  CHECK_ORDER(world, ogive_field_view_get(world, small.left, "velocity", &view), "prepare");
  CHECK_ORDER(world, ogive_world_save(world, &writer), "prepare");
  CHECK_ORDER(world, ogive_checkpoint_write(world, "/tmp/never"), "prepare");
  CHECK_ORDER(world, ogive_particles_write(world, "/tmp/never"), "prepare");
  ogive_world_destroy(world);
}

static int32_t misbehave(ogive_world* world, void* user) {
  const ogive_reader reader = {sizeof reader, 0, NULL, NULL, NULL};
  CHECK_ORDER(world, ogive_world_step(world, 0), "callback");
  CHECK_ORDER(world, ogive_world_advance(world, 1, 0, NULL, NULL), "callback");
  CHECK_ORDER(world, ogive_world_load(world, &reader), "callback");
  ++*(int*)user;
  return 0;
}

static ogive_status refuse_to_write(void* user, const char* name, int32_t type, int64_t count, const void* data) {
  (void)user, (void)name, (void)type, (void)count, (void)data;
  return OGIVE_ERROR_FILE;
}

static void once_it_is_prepared(const char* directory) {
  small_world small = build_small_world();
  ogive_world* world = small.world;
  ogive_grid_def grid = small_grid();
  ogive_material_def copper = small_material();
  ogive_solid_def box = small_box(3);
  ogive_numerics_def numerics;
  ogive_clamp_def clamp;
  ogive_load_def load_def;
  ogive_body_def body;
  ogive_contact_def contact;
  ogive_stop_def stop;
  ogive_progress progress = {.struct_size = sizeof progress};
  ogive_ledger ledger = {.struct_size = sizeof ledger};
  ogive_body_result result = {.struct_size = sizeof result};
  ogive_pair_result pair = {.struct_size = sizeof pair};
  ogive_load_result load = {.struct_size = sizeof load};
  ogive_field_view view = {.struct_size = sizeof view};
  ogive_writer writer = {sizeof writer, 0, NULL, NULL};
  ogive_reader reader = {sizeof reader, 0, NULL, NULL, NULL};
  double values[9 * 64], dt = 0;
  const double value[3] = {0, 0, 0}, bad_value[3] = {0, INFINITY, 0};
  const void* data;
  int64_t size;
  size_t needed;
  int calls = 0;
  char path[4096], text[256];
  ogive_numerics_def_init(&numerics, sizeof numerics);
  ogive_clamp_def_init(&clamp, sizeof clamp);
  ogive_load_def_init(&load_def, sizeof load_def);
  ogive_body_def_init(&body, sizeof body);
  ogive_contact_def_init(&contact, sizeof contact);
  ogive_stop_def_init(&stop, sizeof stop);
  body.material = small.copper;
  CHECK_OK(world, ogive_world_prepare(world));

  /* The model is frozen. */
  CHECK_ORDER(world, ogive_world_prepare(world), "frozen");
  CHECK_ORDER(world, ogive_world_set_grid(world, &grid), "frozen");
  CHECK_ORDER(world, ogive_world_set_numerics(world, &numerics), "frozen");
  CHECK_ORDER(world, ogive_clamp_add(world, &clamp), "frozen");
  CHECK_ORDER(world, ogive_load_add(world, &load_def, NULL), "frozen");
  CHECK_ORDER(world, ogive_material_add(world, "more", &copper, NULL), "frozen");
  CHECK_ORDER(world, ogive_body_add_solid(world, "more", &body, &box, NULL), "frozen");
  CHECK_ORDER(world, ogive_body_add_particles(world, "more", &body, 1, value, values, NULL), "frozen");
  CHECK_ORDER(world, ogive_world_set_contact(world, &contact), "frozen");
  CHECK_ORDER(world, ogive_contact_set_pair(world, small.left, small.right, &contact), "frozen");
  CHECK_ORDER(world, ogive_world_set_stop(world, &stop), "frozen");
  CHECK_ORDER(world, ogive_body_set_surface(world, small.left, 4, values, 4, NULL), "frozen");
  CHECK_ORDER(world, ogive_body_set_surface_solid(world, small.left, &box), "frozen");
  CHECK_ORDER(world, ogive_world_load(world, &reader), "fresh");

  CHECK_REFUSED(world, ogive_world_stable_time_step(world, NULL), "dt");
  CHECK_OK(world, ogive_world_stable_time_step(world, &dt));
  CHECK_REFUSED(world, ogive_world_step(world, 1.01 * dt), "dt");
  CHECK_REFUSED(world, ogive_world_step(world, -dt), "dt");
  CHECK_REFUSED(world, ogive_world_step(world, NAN), "dt");
  CHECK_REFUSED(world, ogive_world_advance(world, -1, 0, NULL, NULL), "time");
  CHECK_REFUSED(world, ogive_world_advance(world, NAN, 0, NULL, NULL), "time");
  CHECK_REFUSED(world, ogive_world_advance(world, INFINITY, 0, NULL, NULL), "time");
  CHECK_REFUSED(world, ogive_world_advance(world, 1, -1, NULL, NULL), "max_steps");
  CHECK_OK(world, ogive_world_advance(world, 1, 2, misbehave, &calls));
  CHECK(calls == 2);

  CHECK_REFUSED(world, ogive_load_set(world, (ogive_load_id){1}, value), "load");
  CHECK_REFUSED(world, ogive_load_set(world, (ogive_load_id){-1}, value), "load");
  CHECK_REFUSED(world, ogive_load_set(world, small.load, NULL), "value");
  CHECK_REFUSED(world, ogive_load_set(world, small.load, bad_value), "load value[1]");
  CHECK_REFUSED(world, ogive_load_result_get(world, (ogive_load_id){4}, &load), "load");
  CHECK_REFUSED(world, ogive_load_result_get(world, small.load, NULL), "result");
  BAD_SIZES(load, ogive_load_result_get(world, small.load, &load));
  BAD_SIZES(progress, ogive_world_progress(world, &progress));
  BAD_SIZES(ledger, ogive_world_ledger(world, &ledger));
  BAD_SIZES(result, ogive_body_result_get(world, small.left, &result));
  BAD_SIZES(pair, ogive_pair_result_get(world, small.left, small.right, &pair));
  BAD_SIZES(view, ogive_field_view_get(world, small.left, "velocity", &view));
  CHECK_REFUSED(world, ogive_world_progress(world, NULL), "progress");
  CHECK_REFUSED(world, ogive_world_ledger(world, NULL), "ledger");
  CHECK_REFUSED(world, ogive_body_result_get(world, small.left, NULL), "result");
  CHECK_REFUSED(world, ogive_body_result_get(world, stale, &result), "body");
  CHECK_REFUSED(world, ogive_pair_result_get(world, small.left, small.left, &pair), "two bodies");
  CHECK_REFUSED(world, ogive_pair_result_get(world, small.left, stale, &pair), "body");
  CHECK_REFUSED(world, ogive_pair_result_get(world, small.left, small.right, NULL), "result");
  CHECK(ogive_body_name(world, stale) == NULL && ogive_body_name(world, none) == NULL);
  CHECK_REFUSED(world, ogive_body_find(world, "nobody", &small.left), "nobody");
  CHECK_REFUSED(world, ogive_body_find(world, NULL, &small.left), "name");
  CHECK_REFUSED(world, ogive_body_find(world, "left", NULL), "body");

  CHECK(ogive_field_count(world, stale) == 0);
  CHECK(ogive_field_name(world, small.left, -1, NULL) == NULL);
  CHECK(ogive_field_name(world, small.left, 99, NULL) == NULL);
  CHECK(ogive_field_name(world, stale, 0, NULL) == NULL);
  CHECK_REFUSED(world, ogive_field_get(world, stale, "mass", values, 64), "body");
  CHECK_REFUSED(world, ogive_field_get(world, small.left, NULL, values, 64), "name");
  CHECK_REFUSED(world, ogive_field_get(world, small.left, "colour", values, 64), "colour");
  CHECK_REFUSED(world, ogive_field_get(world, small.left, "mass", values, 63), "count");
  CHECK_REFUSED(world, ogive_field_get(world, small.left, "mass", values, -64), "count");
  CHECK_REFUSED(world, ogive_field_get(world, small.left, "mass", NULL, 64), "values");
  CHECK_REFUSED(world, ogive_field_get(world, small.left, "deformation_gradient", values, 9 * 64), "does not keep");
  CHECK_REFUSED(world, ogive_field_get(world, small.left, "force", values, 3 * 64), "does not keep");
  memset(values, 0, sizeof values);
  CHECK_REFUSED(world, ogive_field_set(world, small.left, "mass", values, 64), "cannot be set");
  CHECK_REFUSED(world, ogive_field_set(world, small.left, "velocity", values, 64), "count");
  CHECK_REFUSED(world, ogive_field_set(world, small.left, "velocity", NULL, 3 * 64), "values");
  CHECK_REFUSED(world, ogive_field_set(world, stale, "velocity", values, 3 * 64), "body");
  CHECK_REFUSED(world, ogive_field_set(world, small.left, "volume_ratio", values, 64), "values[0]");
  values[5] = NAN;
  CHECK_REFUSED(world, ogive_field_set(world, small.left, "velocity", values, 3 * 64), "values[5]");
  CHECK_REFUSED(world, ogive_field_set(world, small.left, "force", values, 3 * 64), "values[5]");
  values[5] = -1;
  CHECK_REFUSED(world, ogive_field_set(world, small.left, "plastic_strain", values, 64), "values[5]");
  values[5] = 99;
  CHECK_REFUSED(world, ogive_field_set(world, small.left, "position", values, 3 * 64), "inside the domain");
  CHECK_REFUSED(world, ogive_field_view_get(world, small.left, "pressure", &view), "on demand");
  CHECK_REFUSED(world, ogive_field_view_get(world, small.left, NULL, &view), "name");
  CHECK_REFUSED(world, ogive_field_view_get(world, small.left, "velocity", NULL), "view");

  CHECK_REFUSED(world, ogive_world_attach(world, NULL, values, 8), "name");
  CHECK_REFUSED(world, ogive_world_attach(world, "two\nlines", values, 8), "one line");
  CHECK_REFUSED(world, ogive_world_attach(world, "a", NULL, 8), "data");
  CHECK_REFUSED(world, ogive_world_attach(world, "a", values, -8), "size");
  CHECK_REFUSED(world, ogive_world_attachment(world, "a", &data, &size), "\"a\"");
  CHECK_REFUSED(world, ogive_world_attachment(world, "a", NULL, &size), "data");
  CHECK_REFUSED(world, ogive_world_save(world, NULL), "writer");
  CHECK_REFUSED(world, ogive_world_save(world, &writer), "put");
  writer.put = refuse_to_write;
  CHECK_STATUS(world, ogive_world_save(world, &writer), OGIVE_ERROR_FILE, "version");

  CHECK_REFUSED(world, ogive_checkpoint_write(world, NULL), "path");
  CHECK_REFUSED(world, ogive_checkpoint_write(world, ""), "path");
  CHECK_STATUS(world, ogive_checkpoint_write(world, "/nowhere/at/all.h5"), OGIVE_ERROR_FILE, "/nowhere/at/all.h5");
  CHECK_STATUS(world, ogive_particles_write(world, "/nowhere/at/all.h5"), OGIVE_ERROR_FILE, "/nowhere/at/all.h5");
  CHECK_REFUSED(world, ogive_particles_write(world, NULL), "path");
  CHECK_REFUSED(world, ogive_series_write(world, NULL, 0, NULL), "path");
  snprintf(path, sizeof path, "%s/none.xdmf", directory);
  CHECK_REFUSED(world, ogive_series_write(world, path, -1, NULL), "count");

  /* After all this the run goes on. */
  CHECK_OK(world, ogive_world_step(world, 0));
  ogive_world_destroy(world);

  CHECK(ogive_world_create(&world) == OGIVE_OK);
  CHECK_REFUSED(world, ogive_world_load(world, NULL), "reader");
  CHECK_REFUSED(world, ogive_world_load(world, &reader), "reader.find");
  CHECK_STATUS(world, ogive_checkpoint_read(world, "/nowhere.h5"), OGIVE_ERROR_FILE, "/nowhere.h5");
  CHECK_REFUSED(world, ogive_checkpoint_read(world, NULL), "path");
  snprintf(path, sizeof path, "%s/foreign.h5", directory);
  FILE* file = fopen(path, "w");
  if (file) {
    fputs("no checkpoint\n1,2,3\n", file);
    fclose(file);
  }
  CHECK_STATUS(world, ogive_checkpoint_read(world, path), OGIVE_ERROR_FORMAT, "foreign.h5");
  CHECK(ogive_file_verify(path, text, sizeof text, &needed) == OGIVE_ERROR_FORMAT);
  CHECK(ogive_file_info(path, text, sizeof text, &needed) == OGIVE_ERROR_FORMAT);
  CHECK(ogive_file_verify(NULL, text, sizeof text, &needed) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_file_info(NULL, NULL, 0, NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK_OK(world, ogive_world_set_grid(world, &grid));
  CHECK_REFUSED(world, ogive_body_add_particle_file(world, "b", &body, NULL, NULL), "path");
  CHECK_STATUS(world, ogive_body_add_particle_file(world, "b", &body, "/nowhere.csv", NULL), OGIVE_ERROR_FILE, "/nowhere.csv");
  CHECK_STATUS(world, ogive_body_add_particle_file(world, "b", &body, path, NULL), OGIVE_ERROR_FORMAT, "foreign.h5:2");
  ogive_world_destroy(world);
}

/* A run that breaks down keeps its last state to look at, and says so when it is to go on. */
static void after_a_breakdown(void) {
  small_world small = build_small_world();
  ogive_world* world = small.world;
  ogive_body_result result = {.struct_size = sizeof result};
  double values[64];
  ogive_status status = OGIVE_OK;
  CHECK_OK(world, ogive_world_prepare(world));
  for (int i = 0; i < 64; ++i) values[i] = 1e250; /* an energy that no law bears */
  CHECK_OK(world, ogive_field_get(world, small.left, "volume_ratio", values, 64));
  for (int i = 0; i < 64; ++i) values[i] = i % 2 ? 1e-300 : 1e300;
  CHECK_OK(world, ogive_field_set(world, small.left, "volume_ratio", values, 64));
  for (int i = 0; i < 20 && status == OGIVE_OK; ++i) status = ogive_world_step(world, 0);
  CHECK(status == OGIVE_ERROR_NUMERICAL);
  CHECK(strlen(ogive_world_message(world)) > 10);
  CHECK_ORDER(world, ogive_world_step(world, 0), "broken down");
  CHECK_ORDER(world, ogive_world_advance(world, 1, 0, NULL, NULL), "broken down");
  CHECK_OK(world, ogive_body_result_get(world, small.right, &result));
  ogive_world_destroy(world);
}

#define MESH_REFUSED(call, word)                                                                                   \
  do {                                                                                                             \
    const ogive_status status_ = (call);                                                                           \
    CHECK(status_ == OGIVE_ERROR_ARGUMENT && strstr(ogive_mesh_message(mesh), word));                              \
  } while (0)

static void meshes(void) {
  ogive_mesh* mesh = NULL;
  ogive_mesh_read_def read;
  ogive_voxelise_def fill;
  ogive_mesh_info info = {.struct_size = sizeof info};
  const double corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, not_a_number[9] = {NAN, 0, 0, 1, 0, 0, 0, 1, 0};
  const int32_t facets[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, beyond[3] = {0, 1, 4};
  int64_t count = 0;
  size_t needed;
  CHECK(ogive_mesh_create(NULL) == OGIVE_ERROR_ARGUMENT);
  ogive_mesh_destroy(NULL);
  CHECK(strcmp(ogive_mesh_message(NULL), "") == 0);
  CHECK(ogive_mesh_read(NULL, "x", NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_mesh_set_facets(NULL, 4, corners, 4, facets) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_mesh_check(NULL) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_mesh_report(NULL, NULL, 0, &needed) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_mesh_info_get(NULL, &info) == OGIVE_ERROR_ARGUMENT);
  CHECK(ogive_mesh_voxelise(NULL, NULL, &count, NULL, NULL) == OGIVE_ERROR_ARGUMENT);

  CHECK(ogive_mesh_create(&mesh) == OGIVE_OK);
  ogive_mesh_read_def_init(&read, sizeof read);
  ogive_voxelise_def_init(&fill, sizeof fill);
  CHECK(ogive_mesh_check(mesh) == OGIVE_ERROR_STATE);
  CHECK(ogive_mesh_info_get(mesh, &info) == OGIVE_ERROR_STATE);
  MESH_REFUSED(ogive_mesh_read(mesh, NULL, &read), "path");
  MESH_REFUSED(ogive_mesh_read(mesh, "x", NULL), "def");
  CHECK(ogive_mesh_read(mesh, "/nowhere.stl", &read) == OGIVE_ERROR_FILE);
  read.scale = NAN;
  MESH_REFUSED(ogive_mesh_read(mesh, "x", &read), "scale");
  read.struct_size = 4;
  MESH_REFUSED(ogive_mesh_read(mesh, "x", &read), "struct_size");
  MESH_REFUSED(ogive_mesh_set_facets(mesh, -1, corners, 4, facets), "vertex_count");
  MESH_REFUSED(ogive_mesh_set_facets(mesh, 4, NULL, 4, facets), "xyz");
  CHECK(ogive_mesh_set_facets(mesh, 3, not_a_number, 1, facets) != OGIVE_OK);
  CHECK(ogive_mesh_set_facets(mesh, 4, corners, 1, beyond) != OGIVE_OK);
  CHECK(ogive_mesh_set_facets(mesh, 4, corners, 4, facets) == OGIVE_OK);
  MESH_REFUSED(ogive_mesh_report(mesh, NULL, 0, NULL), "needed");
  MESH_REFUSED(ogive_mesh_info_get(mesh, NULL), "info");
  info.struct_size = sizeof info + 1;
  MESH_REFUSED(ogive_mesh_info_get(mesh, &info), "struct_size");
  set3(fill.spacing, 0.1, 0.1, 0.1);
  CHECK(ogive_mesh_voxelise(mesh, &fill, &count, NULL, NULL) == OGIVE_ERROR_STATE);
  CHECK(ogive_mesh_check(mesh) == OGIVE_OK);
  MESH_REFUSED(ogive_mesh_voxelise(mesh, NULL, &count, NULL, NULL), "def");
  MESH_REFUSED(ogive_mesh_voxelise(mesh, &fill, NULL, NULL, NULL), "count");
  MESH_REFUSED(ogive_mesh_voxelise(mesh, &fill, &count, &fill.spacing[0], NULL), "xyz and volume");
  CHECK(ogive_mesh_surface(NULL, &fill, &count, &count, NULL, NULL) == OGIVE_ERROR_ARGUMENT);
  MESH_REFUSED(ogive_mesh_surface(mesh, NULL, &count, &count, NULL, NULL), "def");
  MESH_REFUSED(ogive_mesh_surface(mesh, &fill, NULL, &count, NULL, NULL), "vertex_count");
  MESH_REFUSED(ogive_mesh_surface(mesh, &fill, &count, NULL, NULL, NULL), "triangle_count");
  MESH_REFUSED(ogive_mesh_surface(mesh, &fill, &count, &count, &fill.spacing[0], NULL), "xyz and corners");
  fill.spacing[1] = -1;
  MESH_REFUSED(ogive_mesh_voxelise(mesh, &fill, &count, NULL, NULL), "spacing");
  ogive_mesh_destroy(mesh);
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  null_worlds();
  init_functions();
  definitions();
  before_it_is_prepared();
  once_it_is_prepared(argv[1]);
  after_a_breakdown();
  meshes();
  if (failures == 0) printf("all good\n");
  return failures != 0;
}
