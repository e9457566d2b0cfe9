/* Every function of the C headers does what its header says when it is called as it should be. (tests/capi/coverage.py checks
 * that none is left out.) Arguments: a directory to write to, tests/data. */
#include <math.h>
#include <ogive_geometry.h>
#include <stdlib.h>
#include <unistd.h>

#include "small_world.h"

static char path_buffer[4][4096];
static const char* in_directory(const char* directory, const char* name) {
  static int next;
  char* path = path_buffer[next++ % 4];
  snprintf(path, sizeof path_buffer[0], "%s/%s", directory, name);
  return path;
}

static int logged[4];
static char last_log[512];
static void count_log(void* user, int32_t level, const char* text) {
  CHECK(user == logged);
  CHECK(level >= OGIVE_LOG_INFO && level <= OGIVE_LOG_ERROR);
  ++logged[level];
  snprintf(last_log, sizeof last_log, "%s", text);
}

static void versions_and_names(void) {
  char expected[32];
  snprintf(expected, sizeof expected, "%d.%d.%d", OGIVE_VERSION_MAJOR, OGIVE_VERSION_MINOR, OGIVE_VERSION_PATCH);
  CHECK(strcmp(ogive_version(), expected) == 0);
  CHECK(ogive_abi_version() == OGIVE_ABI);
  CHECK(strcmp(ogive_status_name(OGIVE_OK), "ok") == 0);
  for (ogive_status a = OGIVE_OK; a <= OGIVE_ERROR_INTERNAL; ++a)
    for (ogive_status b = OGIVE_OK; b < a; ++b) CHECK(strcmp(ogive_status_name(a), ogive_status_name(b)) != 0);
}

static void definitions_begin_with_their_defaults(void) {
  ogive_numerics_def numerics;
  ogive_clamp_def clamp;
  ogive_contact_def contact;
  ogive_stop_def stop;
  ogive_load_def load;
  ogive_numerics_def_init(&numerics, sizeof numerics);
  CHECK(numerics.struct_size == sizeof numerics && numerics.time_step_factor == 0.5 && numerics.threads == 1);
  CHECK(numerics.drop_debris == 0);
  CHECK(numerics.shape_function == OGIVE_SHAPE_QUADRATIC_BSPLINE && isinf(numerics.maximum_time_step));
  ogive_clamp_def_init(&clamp, sizeof clamp);
  CHECK(clamp.struct_size == sizeof clamp && clamp.body.index == -1 && clamp.axes == 7);
  ogive_contact_def_init(&contact, sizeof contact);
  CHECK(contact.method == OGIVE_CONTACT_PERSISTENT && contact.gap_offset == 0.3 && contact.master.index == -1);
  ogive_stop_def_init(&stop, sizeof stop);
  CHECK(stop.body.index == -1 && stop.stop_when_out == 1 && stop.exchange_window == 0 && stop.exchange_tolerance == 0.001);
  ogive_load_def_init(&load, sizeof load);
  CHECK(load.kind == OGIVE_LOAD_ACCELERATION && load.region == OGIVE_REGION_EVERYWHERE && load.axes == 7);
  CHECK(load.struct_size == sizeof load && load.body.index == -1);
}

static void numerics_contact_clamps_and_stops_are_taken(small_world* small) {
  ogive_world* world = small->world;
  ogive_numerics_def numerics;
  ogive_contact_def contact;
  ogive_clamp_def clamp;
  ogive_stop_def stop;
  ogive_numerics_def_init(&numerics, sizeof numerics);
  numerics.time_step_factor = 0.4;
  numerics.drop_debris = 1;
  CHECK_OK(world, ogive_world_set_numerics(world, &numerics));
  CHECK_OK(world, ogive_world_set_threads(world, 2));
  ogive_contact_def_init(&contact, sizeof contact);
  contact.friction = 0.2;
  CHECK_OK(world, ogive_world_set_contact(world, &contact));
  contact.friction = 0.1;
  CHECK_OK(world, ogive_contact_set_pair(world, small->left, small->right, &contact));
  ogive_clamp_def_init(&clamp, sizeof clamp);
  set3(clamp.a, 4, -4, -4);
  set3(clamp.b, 6, 4, 4);
  CHECK_OK(world, ogive_clamp_add(world, &clamp));
  ogive_stop_def_init(&stop, sizeof stop);
  stop.body = small->left;
  stop.exchange_window = 10;
  CHECK_OK(world, ogive_world_set_stop(world, &stop));
}

static void solids_give_their_particles(ogive_world* world) {
  ogive_solid_def box = small_box(0);
  int64_t count = 0;
  double xyz[3 * 64], volume[64], sum = 0;
  CHECK_OK(world, ogive_solid_particles(world, &box, &count, NULL, NULL));
  CHECK(count == 64);
  CHECK_OK(world, ogive_solid_particles(world, &box, &count, xyz, volume));
  for (int i = 0; i < 64; ++i) sum += volume[i];
  CHECK(fabs(sum - 8) < 1e-12);
}

static int32_t stop_at_third(ogive_world* world, void* user) {
  int* calls = user;
  ogive_progress progress = {.struct_size = sizeof progress};
  const double value[3] = {0, 0, 2};
  CHECK_OK(world, ogive_world_progress(world, &progress));
  CHECK_OK(world, ogive_load_set(world, (ogive_load_id){0}, value)); /* a callback may set loads */
  return ++*calls == 3;
}

static void a_run_advances(small_world* small) {
  ogive_world* world = small->world;
  ogive_progress progress = {.struct_size = sizeof progress};
  size_t needed = 0;
  char plan[8192];
  double dt = 0;
  int calls = 0;
  CHECK_OK(world, ogive_world_plan(world, NULL, 0, &needed));
  CHECK(needed > 100 && needed < sizeof plan);
  CHECK_OK(world, ogive_world_plan(world, plan, sizeof plan, &needed));
  CHECK(strlen(plan) + 1 == needed && strstr(plan, "body \"left\": 64 particles"));
  CHECK_OK(world, ogive_world_stable_time_step(world, &dt));
  CHECK(dt > 1e-6 && dt < 1e-3);
  CHECK_OK(world, ogive_world_step(world, 0));
  CHECK_OK(world, ogive_world_progress(world, &progress));
  CHECK(progress.steps == 1 && progress.last_time_step == dt && progress.time == dt && progress.particles == 128);
  CHECK_OK(world, ogive_world_stable_time_step(world, &dt));
  CHECK_OK(world, ogive_world_step(world, 0.25 * dt)); /* the host's own step */
  CHECK_OK(world, ogive_world_progress(world, &progress));
  CHECK(progress.last_time_step == 0.25 * dt);
  CHECK_OK(world, ogive_world_advance(world, 1.0, 0, stop_at_third, &calls));
  CHECK_OK(world, ogive_world_progress(world, &progress));
  CHECK(calls == 3 && progress.steps == 5);
  CHECK_OK(world, ogive_world_advance(world, 0.005, 0, NULL, NULL));
  CHECK_OK(world, ogive_world_progress(world, &progress));
  CHECK(progress.time == 0.005); /* exactly */
  CHECK_OK(world, ogive_world_advance(world, 1.0, 2, NULL, NULL));
  CHECK_OK(world, ogive_world_set_threads(world, 1));
}

/* A run goes on with more friction and another yield stress. */
static void a_run_is_changed(small_world* small) {
  ogive_world* world = small->world;
  ogive_contact_def contact;
  ogive_material_def copper = small_material();
  ogive_ledger ledger = {.struct_size = sizeof ledger};
  ogive_contact_def_init(&contact, sizeof contact);
  contact.friction = 0.2;
  copper.yield_stress = 100;
  CHECK_OK(world, ogive_world_reopen(world));
  CHECK_OK(world, ogive_contact_set_pair(world, small->left, small->right, &contact));
  CHECK_OK(world, ogive_material_change(world, small->copper, &copper));
  CHECK_OK(world, ogive_world_ledger(world, &ledger));
  CHECK_OK(world, ogive_world_prepare(world));
  CHECK_OK(world, ogive_world_step(world, 0));
}

static void results_agree_with_each_other(small_world* small) {
  ogive_world* world = small->world;
  ogive_ledger ledger = {.struct_size = sizeof ledger};
  ogive_body_result left = {.struct_size = sizeof left}, right = {.struct_size = sizeof right};
  ogive_pair_result pair = {.struct_size = sizeof pair};
  ogive_load_result load = {.struct_size = sizeof load};
  ogive_body_id found = {-1};
  CHECK(ogive_body_count(world) == 2);
  CHECK(strcmp(ogive_body_name(world, small->right), "right") == 0);
  CHECK_OK(world, ogive_body_find(world, "right", &found));
  CHECK(found.index == small->right.index);
  CHECK_OK(world, ogive_world_ledger(world, &ledger));
  CHECK_OK(world, ogive_world_check_energy(world));
  CHECK_OK(world, ogive_body_result_get(world, small->left, &left));
  CHECK_OK(world, ogive_body_result_get(world, small->right, &right));
  CHECK_OK(world, ogive_pair_result_get(world, small->left, small->right, &pair));
  CHECK_OK(world, ogive_load_result_get(world, small->load, &load));
  CHECK(fabs(ledger.mass - left.mass - right.mass) < 1e-12);
  CHECK(fabs(left.mass - 8 * 8.93e-3) < 1e-12);
  CHECK(left.velocity[0] < 50 && pair.impulse[0] < 0);
  CHECK(fabs(pair.force[0] - left.contact_force[0]) <= 1e-9 * fabs(pair.force[0]));
  CHECK(load.value[2] == 2 && fabs(load.force[2] - 2 * right.mass) < 1e-12);
  CHECK(fabs(load.impulse[2] - ledger.external_impulse[2]) < 1e-15);
}

/* Each field of the body that may be set is set to other values, read back, and put as it was. */
static void fields_are_read_set_and_viewed(small_world* small) {
  ogive_world* world = small->world;
  static const char* const settable[] = {"position", "velocity", "affine_velocity", "stress", "energy", "plastic_strain",
                                         "temperature", "volume_ratio"};
  static const int32_t sizes[] = {3, 3, 9, 6, 1, 1, 1, 1};
  double values[9 * 64], others[9 * 64], back[9 * 64], force[3 * 64];
  int found = 0;
  CHECK(ogive_field_count(world, small->left) >= 14);
  for (int32_t f = 0; f < ogive_field_count(world, small->left); ++f) {
    int32_t components = 0;
    const char* name = ogive_field_name(world, small->left, f, &components);
    CHECK_OK(world, ogive_field_get(world, small->left, name, values, (int64_t)64 * components));
    for (int s = 0; s < 8; ++s) {
      const int64_t count = (int64_t)64 * sizes[s];
      if (strcmp(name, settable[s]) != 0) continue;
      ++found;
      CHECK(components == sizes[s]);
      for (int64_t i = 0; i < count; ++i) others[i] = 0.999 * values[i] + (s == 0 ? 0.0 : 0.125);
      CHECK_OK(world, ogive_field_set(world, small->left, name, others, count));
      CHECK_OK(world, ogive_field_get(world, small->left, name, back, count));
      for (int64_t i = 0; i < count; ++i) CHECK(fabs(others[i] - back[i]) <= 1e-15 * fabs(others[i]));
      CHECK_OK(world, ogive_field_set(world, small->left, name, values, count));
    }
  }
  CHECK(found == 8);
  for (int i = 0; i < 3 * 64; ++i) force[i] = 0.01 * i;
  CHECK_OK(world, ogive_field_set(world, small->left, "force", force, 3 * 64));
  CHECK_OK(world, ogive_field_get(world, small->left, "force", back, 3 * 64));
  CHECK(memcmp(force, back, sizeof force) == 0);

  static const char* const viewed[] = {"position", "velocity", "mass", "stress", "plastic_strain", "temperature",
                                       "volume_ratio", "affine_velocity", "force"};
  for (int v = 0; v < 9; ++v) {
    ogive_field_view view = {.struct_size = sizeof view};
    int64_t seen = 0;
    CHECK_OK(world, ogive_field_view_get(world, small->left, viewed[v], &view));
    CHECK_OK(world, ogive_field_get(world, small->left, viewed[v], values, (int64_t)64 * view.components));
    for (int64_t i = 0; i < view.places; ++i) {
      if (view.number[i] < 0) continue;
      ++seen;
      for (int32_t c = 0; c < view.components; ++c)
        CHECK(view.component[c][i * view.stride] == values[view.components * view.number[i] + c]);
    }
    CHECK(seen == 64);
    for (int32_t c = view.components; c < 9; ++c) CHECK(view.component[c] == NULL);
  }
  CHECK_OK(world, ogive_world_advance(world, 0.008, 0, NULL, NULL));
}

static void a_deformation_gradient_is_kept_and_set(void) {
  ogive_world* world = NULL;
  ogive_grid_def grid = small_grid();
  ogive_material_def rubber;
  ogive_material_id material;
  ogive_body_def body;
  ogive_body_id id;
  const double xyz[6] = {0.25, 0.25, 0.25, 0.75, 0.25, 0.25}, volume[2] = {0.125, 0.125};
  double f[18] = {1.1, 0, 0, 0, 1, 0, 0, 0, 1, 1.1, 0, 0, 0, 1, 0, 0, 0, 1}, back[18];
  CHECK(ogive_world_create(&world) == OGIVE_OK);
  ogive_material_def_init(&rubber, sizeof rubber);
  rubber.strength = OGIVE_STRENGTH_NEO_HOOKEAN;
  rubber.density = 1e-3;
  rubber.youngs_modulus = 10;
  rubber.poisson_ratio = 0.4;
  CHECK_OK(world, ogive_world_set_grid(world, &grid));
  CHECK_OK(world, ogive_material_add(world, "rubber", &rubber, &material));
  ogive_body_def_init(&body, sizeof body);
  body.material = material;
  CHECK_OK(world, ogive_body_add_particles(world, "pad", &body, 2, xyz, volume, &id));
  CHECK_OK(world, ogive_world_prepare(world));
  CHECK_OK(world, ogive_field_set(world, id, "deformation_gradient", f, 18));
  CHECK_OK(world, ogive_field_get(world, id, "deformation_gradient", back, 18));
  CHECK(memcmp(f, back, sizeof f) == 0);
  CHECK_OK(world, ogive_world_step(world, 0));
  ogive_world_destroy(world);
}

static ogive_status count_arrays(void* user, const char* name, int32_t type, int64_t count, const void* data) {
  CHECK(name && type >= OGIVE_TYPE_FLOAT64 && type <= OGIVE_TYPE_UINT8 && count >= 0 && data);
  ++*(int*)user;
  return OGIVE_OK;
}
static ogive_status find_nothing(void* user, const char* name, int32_t* type, int64_t* count) {
  (void)user, (void)name, (void)type, (void)count;
  return OGIVE_ERROR_FORMAT;
}
static ogive_status get_nothing(void* user, const char* name, int64_t count, void* data) {
  (void)user, (void)name, (void)count, (void)data;
  return OGIVE_ERROR_FORMAT;
}

static void saves_and_files(small_world* small, const char* directory, const char* data) {
  ogive_world* world = small->world;
  ogive_world* again = NULL;
  ogive_progress before = {.struct_size = sizeof before}, after = {.struct_size = sizeof after};
  ogive_body_result a = {.struct_size = sizeof a}, b = {.struct_size = sizeof b};
  const void* attachment = NULL;
  int64_t size = 0;
  int arrays = 0;
  char text[4096];
  size_t needed = 0;
  const char* checkpoint = in_directory(directory, "checkpoint.h5");
  const char* particles = in_directory(directory, "particles.h5");
  const ogive_writer writer = {sizeof writer, 0, &arrays, count_arrays};
  const ogive_reader reader = {sizeof reader, 0, NULL, find_nothing, get_nothing};
  CHECK_OK(world, ogive_world_attach(world, "note", "seven", 6));
  CHECK_OK(world, ogive_world_attachment(world, "note", &attachment, &size));
  CHECK(size == 6 && strcmp(attachment, "seven") == 0);
  CHECK_OK(world, ogive_world_save(world, &writer));
  CHECK(arrays > 50);
  CHECK_OK(world, ogive_checkpoint_write(world, checkpoint));
  CHECK(ogive_world_create(&again) == OGIVE_OK);
  CHECK_STATUS(again, ogive_world_load(again, &reader), OGIVE_ERROR_FORMAT, "version"); /* asked for, and not there */
  CHECK_OK(again, ogive_checkpoint_read(again, checkpoint));
  CHECK_OK(again, ogive_world_attachment(again, "note", &attachment, &size));
  CHECK_OK(world, ogive_world_advance(world, 0.012, 0, NULL, NULL));
  CHECK_OK(again, ogive_world_advance(again, 0.012, 0, NULL, NULL));
  CHECK_OK(world, ogive_world_progress(world, &before));
  CHECK_OK(again, ogive_world_progress(again, &after));
  CHECK(before.steps == after.steps && before.time == after.time);
  for (int32_t i = 0; i < 2; ++i) {
    CHECK_OK(world, ogive_body_result_get(world, (ogive_body_id){i}, &a));
    CHECK_OK(again, ogive_body_result_get(again, (ogive_body_id){i}, &b));
    CHECK(memcmp(&a, &b, sizeof a) == 0); /* loads and forces went on as well */
  }
  ogive_world_destroy(again);

  CHECK_OK(world, ogive_particles_write(world, particles));
  CHECK_OK(world, ogive_series_write(world, in_directory(directory, "particles.xdmf"), 1, &particles));
  CHECK(ogive_file_verify(particles, text, sizeof text, &needed) == OGIVE_OK && strstr(text, "undamaged"));
  CHECK(ogive_file_info(checkpoint, text, sizeof text, &needed) == OGIVE_OK && strstr(text, "Ogive checkpoint"));

  /* Two particles from a text file. */
  const char* csv = in_directory(directory, "two.csv");
  FILE* file = fopen(csv, "w");
  CHECK(file != NULL);
  if (!file) return;
  fprintf(file, "x,y,z,volume\n# two\n0.25,0.25,0.25,0.125\n\n0.75, 0.25, 0.25, 0.125\n");
  fclose(file);
  CHECK(ogive_world_create(&again) == OGIVE_OK);
  ogive_grid_def grid = small_grid();
  ogive_material_def copper = small_material();
  ogive_material_id material;
  ogive_body_def body;
  ogive_body_id id = {-1};
  CHECK_OK(again, ogive_world_set_grid(again, &grid));
  CHECK_OK(again, ogive_material_add(again, "copper", &copper, &material));
  ogive_body_def_init(&body, sizeof body);
  body.material = material;
  CHECK_OK(again, ogive_body_add_particle_file(again, "pair", &body, csv, &id));
  CHECK_OK(again, ogive_world_prepare(again));
  CHECK_OK(again, ogive_body_result_get(again, id, &a));
  CHECK(a.particles == 2 && fabs(a.mass - 0.25 * 8.93e-3) < 1e-15);
  CHECK(ogive_world_report(again, OGIVE_ERROR_FILE, "a word of the host") == OGIVE_ERROR_FILE);
  CHECK(strcmp(ogive_world_message(again), "a word of the host") == 0);
  ogive_world_destroy(again);

  /* A checkpoint of 0.1.0 at step 50 goes on to what 0.1.0 came to: it is read as it was meant. */
  CHECK(ogive_world_create(&again) == OGIVE_OK);
  char old[4096];
  snprintf(old, sizeof old, "%s/checkpoint_0.1.0.h5", data);
  CHECK_OK(again, ogive_checkpoint_read(again, old));
  CHECK_OK(again, ogive_world_progress(again, &after));
  CHECK(after.steps == 50);
  CHECK_OK(again, ogive_world_advance(again, 0.01, 0, NULL, NULL));
  CHECK_OK(again, ogive_body_result_get(again, (ogive_body_id){0}, &a));
  /* Its value; another processor's rounding moves it by less than 1e-9. */
  CHECK(fabs(a.speed / 18.744086404637073 - 1) < 1e-9);
  ogive_world_destroy(again);
}

static void meshes_become_particles(const char* directory, const char* data) {
  ogive_mesh* mesh = NULL;
  ogive_mesh_read_def read;
  ogive_voxelise_def fill;
  ogive_mesh_info info = {.struct_size = sizeof info};
  const double corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const int32_t facets[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  char text[4096], cube[4096];
  size_t needed = 0;
  int64_t count = 0;
  (void)directory;
  snprintf(cube, sizeof cube, "%s/cli/cube.stl", data);
  CHECK(ogive_mesh_create(&mesh) == OGIVE_OK);
  ogive_mesh_read_def_init(&read, sizeof read);
  CHECK(read.scale == 1);
  CHECK(ogive_mesh_read(mesh, cube, &read) == OGIVE_OK);
  CHECK(ogive_mesh_check(mesh) == OGIVE_OK);
  CHECK(ogive_mesh_set_facets(mesh, 4, corners, 4, facets) == OGIVE_OK);
  CHECK(ogive_mesh_check(mesh) == OGIVE_OK);
  CHECK(strcmp(ogive_mesh_message(mesh), "") == 0);
  CHECK(ogive_mesh_report(mesh, text, sizeof text, &needed) == OGIVE_OK && needed == strlen(text) + 1);
  CHECK(ogive_mesh_info_get(mesh, &info) == OGIVE_OK);
  CHECK(info.checked == 1 && info.facets == 4 && fabs(info.volume - 1.0 / 6) < 1e-15);
  ogive_voxelise_def_init(&fill, sizeof fill);
  set3(fill.spacing, 0.1, 0.1, 0.1);
  CHECK(ogive_mesh_voxelise(mesh, &fill, &count, NULL, NULL) == OGIVE_OK);
  CHECK(count > 100 && count < 250);
  double* xyz = malloc(3 * (size_t)count * sizeof *xyz);
  double* volume = malloc((size_t)count * sizeof *volume);
  CHECK(ogive_mesh_voxelise(mesh, &fill, &count, xyz, volume) == OGIVE_OK);
  double sum = 0;
  for (int64_t i = 0; i < count; ++i) sum += volume[i];
  CHECK(fabs(sum - 1.0 / 6) < 1e-12);
  int64_t vertices = 0, triangles = 0;
  double placed[12];
  int32_t numbers[12];
  set3(fill.position, 5, 0, 0);
  CHECK(ogive_mesh_surface(mesh, &fill, &vertices, &triangles, NULL, NULL) == OGIVE_OK);
  CHECK(vertices == 4 && triangles == 4);
  CHECK(ogive_mesh_surface(mesh, &fill, &vertices, &triangles, placed, numbers) == OGIVE_OK);
  for (int i = 0; i < 12; ++i) {
    CHECK(numbers[i] >= 0 && numbers[i] < 4);
    CHECK(placed[i] == corners[i] + (i % 3 == 0 ? 5 : 0));
  }
  free(xyz);
  free(volume);
  ogive_mesh_destroy(mesh);
}

/* A rigid box and one given by its particles and triangles meet by their true surfaces: momentum passes, nothing is lost. */
static void bodies_meet_by_their_surfaces(void) {
  static const double xyz[24] = {0.1, -1, -1, 2.1, -1, -1, 0.1, 1, -1, 2.1, 1, -1, 0.1, -1, 1, 2.1, -1, 1, 0.1, 1, 1, 2.1, 1, 1};
  static const int32_t corners[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                      2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  ogive_grid_def grid = small_grid();
  ogive_material_def copper = small_material();
  ogive_material_id material;
  ogive_solid_def box = small_box(-1);
  ogive_body_def body;
  ogive_body_id left, right, third;
  ogive_contact_def contact;
  ogive_body_result result;
  ogive_world* world = NULL;
  double momentum;
  CHECK(ogive_world_create(&world) == OGIVE_OK);
  CHECK_OK(world, ogive_world_set_grid(world, &grid));
  CHECK_OK(world, ogive_material_add(world, "copper", &copper, &material));
  ogive_contact_def_init(&contact, sizeof contact);
  contact.detection = OGIVE_DETECTION_SURFACE;
  CHECK_OK(world, ogive_world_set_contact(world, &contact));
  ogive_body_def_init(&body, sizeof body);
  body.material = material;
  box = small_box(1.1);
  CHECK_OK(world, ogive_body_add_solid(world, "right", &body, &box, &right));
  CHECK_OK(world, ogive_body_set_surface(world, right, 8, xyz, 12, corners));
  body.formulation = OGIVE_FORMULATION_RIGID_FREE;
  set3(body.velocity, 100, 0, 0);
  box = small_box(-1);
  int64_t count = 0;
  CHECK_OK(world, ogive_solid_particles(world, &box, &count, NULL, NULL));
  double* places = malloc(3 * (size_t)count * sizeof *places);
  double* volume = malloc((size_t)count * sizeof *volume);
  CHECK_OK(world, ogive_solid_particles(world, &box, &count, places, volume));
  CHECK_OK(world, ogive_body_add_particles(world, "left", &body, count, places, volume, &left));
  CHECK_OK(world, ogive_body_set_surface_solid(world, left, &box));
  set3(body.velocity, 0, 0, 0);
  box = small_box(3.2);
  CHECK_OK(world, ogive_body_add_solid(world, "third", &body, &box, &third));
  CHECK_OK(world, ogive_world_prepare(world));
  result.struct_size = sizeof result;
  CHECK_OK(world, ogive_body_result_get(world, left, &result));
  momentum = result.momentum[0];
  CHECK_OK(world, ogive_world_advance(world, 2e-3, 0, NULL, NULL));
  double sum = 0;
  for (int32_t b = 0; b < 3; ++b) {
    CHECK_OK(world, ogive_body_result_get(world, (ogive_body_id){b}, &result));
    sum += result.momentum[0];
    if (b == left.index) CHECK(result.velocity[0] < 90);
    if (b == right.index) CHECK(result.velocity[0] > 10);
  }
  CHECK(fabs(sum - momentum) < 1e-12 * momentum);
  free(places);
  free(volume);
  ogive_world_destroy(world);
}

/* The same block in the plane: its section, and a ring of the same section. */
static void worlds_may_have_two_dimensions(void) {
  const double pi = 3.14159265358979324;
  for (int32_t space = OGIVE_SPACE_PLANE_STRAIN; space <= OGIVE_SPACE_AXISYMMETRIC; ++space) {
    ogive_world* world = NULL;
    ogive_grid_def grid;
    ogive_material_def copper = small_material();
    ogive_material_id material;
    ogive_body_def body;
    ogive_solid_def box = small_box(3);
    ogive_body_id id;
    int64_t count = 0;
    ogive_body_result result = {.struct_size = sizeof result};
    ogive_grid_def_init(&grid, sizeof grid);
    CHECK(grid.space == OGIVE_SPACE_THREE_DIMENSIONAL && grid.thickness == 1);
    grid = small_grid();
    grid.space = space;
    grid.thickness = 7;
    grid.domain_min[0] = 0;
    CHECK(ogive_world_create(&world) == OGIVE_OK);
    CHECK_OK(world, ogive_world_set_grid(world, &grid));
    CHECK_OK(world, ogive_material_add(world, "copper", &copper, &material));
    CHECK_OK(world, ogive_solid_particles(world, &box, &count, NULL, NULL));
    CHECK(count == 16);
    ogive_body_def_init(&body, sizeof body);
    body.material = material;
    set3(body.velocity, 0, 3, 0);
    CHECK_OK(world, ogive_body_add_solid(world, "block", &body, &box, &id));
    CHECK_OK(world, ogive_world_prepare(world));
    CHECK_OK(world, ogive_world_advance(world, 1, 5, NULL, NULL));
    CHECK_OK(world, ogive_body_result_get(world, id, &result));
    CHECK(fabs(result.mass / (copper.density * 4 * (space == OGIVE_SPACE_AXISYMMETRIC ? 2 * pi * 3 : 7)) - 1) < 1e-14);
    CHECK(result.upper[2] == 0 && fabs(result.velocity[1] - 3) < 1e-13);
    ogive_world_destroy(world);
  }
}

/* A rigid block that a host drives pushes a free one, which its own forces push back. */
static void rigid_bodies_move_as_the_host_says(void) {
  small_world small = {NULL, {-1}, {-1}, {-1}, {-1}};
  ogive_grid_def grid = small_grid();
  ogive_material_def copper = small_material();
  ogive_solid_def box = small_box(-1.5);
  ogive_body_def body;
  ogive_wall_def wall;
  ogive_numerics_def numerics;
  const double still[1] = {0}, rest[3] = {0, 0, 0}, away[3] = {-20, 0, 0};
  double forces[3 * 64], mass = 0, x_before = 0, x_after = 0;
  ogive_body_result before = {.struct_size = sizeof before}, after = {.struct_size = sizeof after};
  ogive_ledger ledger = {.struct_size = sizeof ledger};
  CHECK(ogive_contact_method_count() == OGIVE_CONTACT_PERSISTENT + 1);
  CHECK(strcmp(ogive_contact_method_name(OGIVE_CONTACT_HUANG_SECOND), "huang_second") == 0);
  CHECK(ogive_contact_normal_count() == OGIVE_NORMAL_LOGISTIC_REGRESSION + 1);
  CHECK(strcmp(ogive_contact_normal_name(OGIVE_NORMAL_AVERAGE), "average") == 0);
  CHECK(ogive_world_create(&small.world) == OGIVE_OK);
  ogive_world* const world = small.world;
  CHECK_OK(world, ogive_world_set_grid(world, &grid));
  ogive_numerics_def_init(&numerics, sizeof numerics);
  numerics.maximum_time_step = 1e-4; /* no wave limits it */
  CHECK_OK(world, ogive_world_set_numerics(world, &numerics));
  CHECK_OK(world, ogive_material_add(world, "copper", &copper, &small.copper));
  ogive_body_def_init(&body, sizeof body);
  body.material = small.copper;
  body.formulation = OGIVE_FORMULATION_RIGID_PRESCRIBED;
  CHECK_OK(world, ogive_body_add_solid(world, "driven", &body, &box, &small.left));
  CHECK_OK(world, ogive_body_set_motion(world, small.left, 1, still, rest, NULL));
  box = small_box(2);
  body.formulation = OGIVE_FORMULATION_RIGID_FREE;
  CHECK_OK(world, ogive_body_add_solid(world, "free", &body, &box, &small.right));
  ogive_wall_def_init(&wall, sizeof wall);
  CHECK(wall.method == OGIVE_CONTACT_PERSISTENT && wall.normal[2] == 1);
  set3(wall.point, 0, 0, -3.5);
  CHECK_OK(world, ogive_wall_add(world, &wall));
  CHECK_OK(world, ogive_world_prepare(world));
  for (int i = 0; i < 64; ++i) set3(forces + 3 * i, 0.5, 0, 0);
  CHECK_OK(world, ogive_field_set(world, small.right, "force", forces, 3 * 64));
  CHECK_OK(world, ogive_body_result_get(world, small.right, &before));
  mass = before.mass;
  for (int i = 0; i < 10; ++i) CHECK_OK(world, ogive_world_step(world, 1e-5));
  CHECK_OK(world, ogive_body_result_get(world, small.right, &after));
  /* 64 forces of 0.5 for 1e-4: momentum and work, exact but for round-off. */
  CHECK(fabs(after.momentum[0] - 32e-4) < 1e-15 && fabs(after.velocity[0] - 32e-4 / mass) < 1e-12);
  CHECK_OK(world, ogive_world_ledger(world, &ledger));
  CHECK(fabs(ledger.external_work - 0.5 * 32e-4 * 32e-4 / mass) < 1e-14);
  CHECK(fabs(ledger.residual) < 1e-14);
  /* The host turns the driven block away; what its guide does is booked. */
  CHECK_OK(world, ogive_body_result_get(world, small.left, &before));
  CHECK_OK(world, ogive_body_set_motion(world, small.left, 1, still, away, NULL));
  x_before = before.centre[0];
  for (int i = 0; i < 10; ++i) CHECK_OK(world, ogive_world_step(world, 1e-5));
  CHECK_OK(world, ogive_body_result_get(world, small.left, &after));
  x_after = after.centre[0];
  CHECK(fabs(x_after - x_before + 20 * 1e-4) < 1e-12 && fabs(after.velocity[0] + 20) < 1e-12);
  CHECK_OK(world, ogive_world_ledger(world, &ledger));
  CHECK(fabs(ledger.residual) < 1e-12 * ledger.kinetic);
  ogive_world_destroy(world);
}

int main(int argc, char** argv) {
  small_world small = build_small_world();
  if (argc != 3) return 2;
  versions_and_names();
  definitions_begin_with_their_defaults();
  numerics_contact_clamps_and_stops_are_taken(&small);
  solids_give_their_particles(small.world);
  CHECK_OK(small.world, ogive_world_set_log(small.world, count_log, logged));
  CHECK_OK(small.world, ogive_world_prepare(small.world));
  CHECK(logged[OGIVE_LOG_INFO] == 1 && strstr(last_log, "prepared: 2 bodies, 128 particles"));
  a_run_advances(&small);
  a_run_is_changed(&small);
  results_agree_with_each_other(&small);
  fields_are_read_set_and_viewed(&small);
  a_deformation_gradient_is_kept_and_set();
  bodies_meet_by_their_surfaces();
  rigid_bodies_move_as_the_host_says();
  worlds_may_have_two_dimensions();
  saves_and_files(&small, argv[1], argv[2]);
  CHECK(logged[OGIVE_LOG_ERROR] == 0);
  CHECK_REFUSED(small.world, ogive_world_step(small.world, -1), "dt");
  CHECK(logged[OGIVE_LOG_ERROR] == 1 && strcmp(last_log, ogive_world_message(small.world)) == 0);
  meshes_become_particles(argv[1], argv[2]);
  ogive_world_destroy(small.world);
  if (failures == 0) printf("all good\n");
  return failures != 0;
}
