// A world saved to a checkpoint and loaded again continues to the same bits, whatever the shape functions and threads.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>

#include "ogive.h"
#include "scratch.hpp"

namespace {

struct Destroy {
  void operator()(ogive_world* world) const { ogive_world_destroy(world); }
};
using World = std::unique_ptr<ogive_world, Destroy>;

World empty_world() {
  ogive_world* world = nullptr;
  EXPECT_EQ(ogive_world_create(&world), OGIVE_OK);
  return World(world);
}

#define REQUIRE_OK(call) ASSERT_EQ(call, OGIVE_OK) << ogive_world_message(world.get())

struct Settings {
  std::int32_t shape;
  std::int32_t threads;
  std::int32_t method;
  std::int32_t transfer = OGIVE_TRANSFER_AFFINE_FLIP;
  std::int32_t order = OGIVE_UPDATE_STRESS_FIRST;
};

std::string text_of(const Settings& settings) {
  const char* methods[] = {"SingleField", "HuangFirst",      "HuangSecond",     "York",      "HuChen",
                           "Bardenhagen2000", "Bardenhagen2001", "Pan2008", "Persistent"};
  const char* shapes[] = {"Linear", "BSpline", "Gimp"};
  return std::string(shapes[settings.shape]) + methods[settings.method] +
         (settings.transfer == OGIVE_TRANSFER_FLIP ? "Flip" : "") +
         (settings.order == OGIVE_UPDATE_STRESS_LAST ? "StressLast" : "") +
         std::to_string(settings.threads) + "Threads";
}
void PrintTo(const Settings& settings, std::ostream* out) { *out << text_of(settings); }

// A steel ball strikes a Johnson-Cook aluminium plate that can fail: contact, friction, heat, failure, a symmetry
// plane, and free faces that particles can leave by.
void build(World& world, const Settings& settings) {
  world = empty_world();
  ogive_grid_def grid;
  ogive_grid_def_init(&grid, sizeof grid);
  grid.cell_size = 1.0;
  const double lower[3] = {-10, 0, -6}, upper[3] = {10, 10, 10};
  std::copy_n(lower, 3, grid.domain_min);
  std::copy_n(upper, 3, grid.domain_max);
  grid.face[2] = OGIVE_FACE_SYMMETRY;
  REQUIRE_OK(ogive_world_set_grid(world.get(), &grid));

  ogive_numerics_def numerics;
  ogive_numerics_def_init(&numerics, sizeof numerics);
  numerics.shape_function = settings.shape;
  numerics.time_step_factor = 0.4;
  numerics.threads = settings.threads;
  numerics.transfer = settings.transfer;
  numerics.update_order = settings.order;
  REQUIRE_OK(ogive_world_set_numerics(world.get(), &numerics));

  ogive_contact_def contact;
  ogive_contact_def_init(&contact, sizeof contact);
  contact.method = settings.method;
  contact.friction = 0.2;
  contact.normal = OGIVE_NORMAL_AVERAGE;
  REQUIRE_OK(ogive_world_set_contact(world.get(), &contact));

  ogive_material_def steel;
  ogive_material_def_init(&steel, sizeof steel);
  steel.density = 7.85e-3;
  steel.youngs_modulus = 200e3;
  steel.poisson_ratio = 0.3;
  ogive_material_id steel_id;
  REQUIRE_OK(ogive_material_add(world.get(), "steel", &steel, &steel_id));

  ogive_material_def aluminium;
  ogive_material_def_init(&aluminium, sizeof aluminium);
  aluminium.strength = OGIVE_STRENGTH_JOHNSON_COOK;
  aluminium.eos = OGIVE_EOS_MIE_GRUNEISEN;
  aluminium.failure = OGIVE_FAILURE_PLASTIC_STRAIN;
  aluminium.density = 2.7e-3;
  aluminium.youngs_modulus = 69e3;
  aluminium.poisson_ratio = 0.3;
  aluminium.yield_stress = 262;
  aluminium.hardening_modulus = 52.1;
  aluminium.hardening_exponent = 0.41;
  aluminium.thermal_exponent = 0.859;
  aluminium.melt_temperature = 875;
  aluminium.specific_heat = 896;
  aluminium.eos_sound_speed = 5350;
  aluminium.eos_slope = 1.34;
  aluminium.gruneisen = 2.0;
  aluminium.failure_strain = 0.3;
  aluminium.viscosity_linear = 0.06;
  ogive_material_id aluminium_id;
  REQUIRE_OK(ogive_material_add(world.get(), "aluminium", &aluminium, &aluminium_id));

  ogive_body_def body;
  ogive_body_def_init(&body, sizeof body);
  body.material = steel_id;
  body.velocity[0] = 150;
  body.velocity[2] = 600;
  ogive_solid_def ball;
  ogive_solid_def_init(&ball, sizeof ball);
  ball.solid = OGIVE_SOLID_SPHERE;
  ball.size[0] = 2.5;
  ball.centre[2] = -2.8;
  std::fill_n(ball.spacing, 3, 0.5);
  ogive_body_id ball_id;
  REQUIRE_OK(ogive_body_add_solid(world.get(), "ball", &body, &ball, &ball_id));

  ogive_body_def_init(&body, sizeof body);
  body.material = aluminium_id;
  ogive_solid_def plate;
  ogive_solid_def_init(&plate, sizeof plate);
  plate.solid = OGIVE_SOLID_BOX;
  const double size[3] = {12, 12, 2}, centre[3] = {0, 0, 1};
  std::copy_n(size, 3, plate.size);
  std::copy_n(centre, 3, plate.centre);
  std::fill_n(plate.spacing, 3, 0.5);
  ogive_body_id plate_id;
  REQUIRE_OK(ogive_body_add_solid(world.get(), "plate", &body, &plate, &plate_id));
  REQUIRE_OK(ogive_world_prepare(world.get()));
  REQUIRE_OK(ogive_world_attach(world.get(), "host/state", "\x01\x02", 2));
}

void advance(World& world, int steps) {
  for (int i = 0; i < steps; ++i) REQUIRE_OK(ogive_world_step(world.get(), 0));
}

std::vector<double> field(const World& world, ogive_body_id body, std::int32_t index, std::string* name) {
  std::int32_t components = 0;
  *name = ogive_field_name(world.get(), body, index, &components);
  ogive_body_result result{};
  result.struct_size = sizeof result;
  EXPECT_EQ(ogive_body_result_get(world.get(), body, &result), OGIVE_OK);
  std::vector<double> values(static_cast<std::size_t>(result.particles * components));
  EXPECT_EQ(ogive_field_get(world.get(), body, name->c_str(), values.data(), static_cast<std::int64_t>(values.size())),
            OGIVE_OK);
  return values;
}

template <class Struct>
bool same_bits(const Struct& a, const Struct& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// Every field of every particle, the ledger, and what is known of each body.
void expect_same_bits(const World& a, const World& b) {
  ASSERT_EQ(ogive_body_count(a.get()), ogive_body_count(b.get()));
  for (std::int32_t i = 0; i < ogive_body_count(a.get()); ++i) {
    const ogive_body_id body{i};
    EXPECT_STREQ(ogive_body_name(a.get(), body), ogive_body_name(b.get(), body));
    ASSERT_EQ(ogive_field_count(a.get(), body), ogive_field_count(b.get(), body));
    for (std::int32_t index = 0; index < ogive_field_count(a.get(), body); ++index) {
      std::string name_a, name_b;
      const auto values_a = field(a, body, index, &name_a);
      const auto values_b = field(b, body, index, &name_b);
      EXPECT_EQ(name_a, name_b);
      ASSERT_EQ(values_a.size(), values_b.size());
      EXPECT_TRUE(values_a.empty() ||
                  std::memcmp(values_a.data(), values_b.data(), values_a.size() * sizeof(double)) == 0)
          << name_a << " of body " << i;
    }
    ogive_body_result result_a{}, result_b{};
    result_a.struct_size = result_b.struct_size = sizeof result_a;
    EXPECT_EQ(ogive_body_result_get(a.get(), body, &result_a), OGIVE_OK);
    EXPECT_EQ(ogive_body_result_get(b.get(), body, &result_b), OGIVE_OK);
    EXPECT_TRUE(same_bits(result_a, result_b)) << "result of body " << i;
  }
  ogive_ledger ledger_a{}, ledger_b{};
  ledger_a.struct_size = ledger_b.struct_size = sizeof ledger_a;
  EXPECT_EQ(ogive_world_ledger(a.get(), &ledger_a), OGIVE_OK);
  EXPECT_EQ(ogive_world_ledger(b.get(), &ledger_b), OGIVE_OK);
  EXPECT_TRUE(same_bits(ledger_a, ledger_b)) << "ledger";
  ogive_progress progress_a{}, progress_b{};
  progress_a.struct_size = progress_b.struct_size = sizeof progress_a;
  EXPECT_EQ(ogive_world_progress(a.get(), &progress_a), OGIVE_OK);
  EXPECT_EQ(ogive_world_progress(b.get(), &progress_b), OGIVE_OK);
  EXPECT_EQ(progress_a.time, progress_b.time);
  EXPECT_EQ(progress_a.steps, progress_b.steps);
  EXPECT_EQ(progress_a.particle_steps, progress_b.particle_steps);
}

class Restart : public testing::TestWithParam<Settings> {};

TEST_P(Restart, FromACheckpointAtARandomStepContinuesToTheSameBits) {
  const scratch::Directory directory;
  World world, loaded = empty_world();
  build(world, GetParam());
  if (HasFatalFailure()) return;
  // Repeatable, yet another step for each case.
  std::mt19937 random(static_cast<unsigned>(10 * GetParam().shape + 100 * GetParam().method + GetParam().threads));
  const int before = 20 + static_cast<int>(random() % 60);
  advance(world, before);
  if (HasFatalFailure()) return;

  REQUIRE_OK(ogive_checkpoint_write(world.get(), (directory / "c.h5").c_str()));
  ASSERT_EQ(ogive_checkpoint_read(loaded.get(), (directory / "c.h5").c_str()), OGIVE_OK)
      << ogive_world_message(loaded.get());
  expect_same_bits(world, loaded);
  const void* attached = nullptr;
  std::int64_t size = 0;
  ASSERT_EQ(ogive_world_attachment(loaded.get(), "host/state", &attached, &size), OGIVE_OK);
  EXPECT_EQ(std::string(static_cast<const char*>(attached), static_cast<std::size_t>(size)), "\x01\x02");

  advance(world, 50);
  advance(loaded, 50);
  if (HasFatalFailure()) return;
  expect_same_bits(world, loaded);
  // The scene is worth the test only if something happened in it.
  ogive_body_result plate{};
  plate.struct_size = sizeof plate;
  REQUIRE_OK(ogive_body_result_get(world.get(), ogive_body_id{1}, &plate));
  EXPECT_GT(plate.maximum_plastic_strain, 0.0);
}

TEST_P(Restart, WithAnotherNumberOfThreadsContinuesToTheSameBits) {
  const scratch::Directory directory;
  World world, loaded = empty_world();
  build(world, GetParam());
  if (HasFatalFailure()) return;
  advance(world, 30);
  REQUIRE_OK(ogive_checkpoint_write(world.get(), (directory / "c.h5").c_str()));
  ASSERT_EQ(ogive_checkpoint_read(loaded.get(), (directory / "c.h5").c_str()), OGIVE_OK);
  ASSERT_EQ(ogive_world_set_threads(loaded.get(), GetParam().threads == 1 ? 2 : 1), OGIVE_OK);
  advance(world, 50);
  advance(loaded, 50);
  expect_same_bits(world, loaded);
}

INSTANTIATE_TEST_SUITE_P(Cases, Restart,
                         testing::Values(Settings{OGIVE_SHAPE_LINEAR, 1, OGIVE_CONTACT_HUANG_SECOND},
                                         Settings{OGIVE_SHAPE_LINEAR, 2, OGIVE_CONTACT_HUANG_FIRST},
                                         Settings{OGIVE_SHAPE_QUADRATIC_BSPLINE, 1, OGIVE_CONTACT_HUANG_SECOND},
                                         Settings{OGIVE_SHAPE_QUADRATIC_BSPLINE, 2, OGIVE_CONTACT_HUANG_SECOND},
                                         Settings{OGIVE_SHAPE_QUADRATIC_BSPLINE, 2, OGIVE_CONTACT_PERSISTENT},
                                         Settings{OGIVE_SHAPE_QUADRATIC_BSPLINE, 2, OGIVE_CONTACT_SINGLE_FIELD},
                                         Settings{OGIVE_SHAPE_LINEAR, 2, OGIVE_CONTACT_HUANG_SECOND, OGIVE_TRANSFER_FLIP},
                                         Settings{OGIVE_SHAPE_LINEAR, 2, OGIVE_CONTACT_HUANG_SECOND,
                                                  OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_LAST},
                                         Settings{OGIVE_SHAPE_GIMP, 2, OGIVE_CONTACT_HUANG_SECOND},
                                         Settings{OGIVE_SHAPE_QUADRATIC_BSPLINE, 1, OGIVE_CONTACT_HUANG_FIRST,
                                                  OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_LAST}),
                         [](const auto& info) { return text_of(info.param); });

TEST(Checkpoint, OfTheSameStateIsEqualByteForByteAfterARestart) {
  const scratch::Directory directory;
  World world, loaded = empty_world();
  build(world, Settings{OGIVE_SHAPE_QUADRATIC_BSPLINE, 1, OGIVE_CONTACT_HUANG_SECOND});
  if (HasFatalFailure()) return;
  advance(world, 25);
  REQUIRE_OK(ogive_checkpoint_write(world.get(), (directory / "a.h5").c_str()));
  ASSERT_EQ(ogive_checkpoint_read(loaded.get(), (directory / "a.h5").c_str()), OGIVE_OK);
  ASSERT_EQ(ogive_checkpoint_write(loaded.get(), (directory / "b.h5").c_str()), OGIVE_OK);
  EXPECT_EQ(scratch::content(directory / "a.h5"), scratch::content(directory / "b.h5"));
}

TEST(Checkpoint, ThatIsDamagedLeavesAFreshWorldThatCanStillLoadAGoodOne) {
  const scratch::Directory directory;
  World world, loaded = empty_world();
  build(world, Settings{OGIVE_SHAPE_LINEAR, 1, OGIVE_CONTACT_HUANG_SECOND});
  if (HasFatalFailure()) return;
  advance(world, 5);
  REQUIRE_OK(ogive_checkpoint_write(world.get(), (directory / "good.h5").c_str()));
  std::string bytes = scratch::content(directory / "good.h5");
  bytes[bytes.size() / 2] ^= 16;
  scratch::write(directory / "bad.h5", bytes);
  EXPECT_EQ(ogive_checkpoint_read(loaded.get(), (directory / "bad.h5").c_str()), OGIVE_ERROR_FORMAT);
  EXPECT_NE(std::string(ogive_world_message(loaded.get())).find("damaged"), std::string::npos);
  EXPECT_EQ(ogive_checkpoint_read(loaded.get(), (directory / "good.h5").c_str()), OGIVE_OK)
      << ogive_world_message(loaded.get());
  expect_same_bits(world, loaded);
}

TEST(Particles, OfARunAreASeriesOfCheckedFiles) {
  const scratch::Directory directory;
  World world;
  build(world, Settings{OGIVE_SHAPE_LINEAR, 1, OGIVE_CONTACT_HUANG_SECOND});
  if (HasFatalFailure()) return;
  const char* files[] = {"p0.h5", "p1.h5"};
  for (const char* file : files) {
    REQUIRE_OK(ogive_particles_write(world.get(), (directory / file).c_str()));
    EXPECT_EQ(ogive_file_verify((directory / file).c_str(), nullptr, 0, nullptr), OGIVE_OK);
    advance(world, 10);
  }
  REQUIRE_OK(ogive_series_write(world.get(), (directory / "p.xdmf").c_str(), 2, files));
  EXPECT_NE(scratch::content(directory / "p.xdmf").find("p1.h5:/plate/stress"), std::string::npos);
}

}  // namespace
