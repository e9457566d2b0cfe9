// Nonsense is found within two steps of its coming to be, and told with particle, place, time and probable cause. Each is put into
// one random particle of a running impact.
#include <random>

#include "impact.hpp"

using namespace verification;

namespace {

constexpr std::int64_t most_steps = 2;

struct Nonsense {
  const char* name;
  std::int32_t body;  // 0: an elastic ball, 1: a plate that yields, heats and fails
  const char* field;
  double value;
  const char* word;  // in the message
};

class Breakdown : public testing::TestWithParam<Nonsense> {};

}  // namespace

TEST_P(Breakdown, IsFoundWithinTwoStepsWithParticlePlaceTimeAndCause) {
  const Nonsense& nonsense = GetParam();
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  Scene scene = Impact{.half_y = true, .off_centre = 1.5}.build();
  scene.steps(std::uniform_int_distribution<int>(1, 60)(random));
  std::vector<double> values = scene.field({nonsense.body}, nonsense.field);
  values[std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(random)] = nonsense.value;
  scene.check(ogive_field_set(scene.get(), {nonsense.body}, nonsense.field, values.data(), static_cast<std::int64_t>(values.size())));
  const std::int64_t start = scene.progress().steps;
  ogive_status status = OGIVE_OK;
  for (std::int64_t i = 0; i < most_steps && status == OGIVE_OK; ++i) status = ogive_world_step(scene.get(), 0);
  ASSERT_EQ(status, OGIVE_ERROR_NUMERICAL);
  const std::string message = ogive_world_message(scene.get());
  measured("steps", static_cast<double>(scene.progress().steps - start + 1));
  EXPECT_NE(message.find(nonsense.word), std::string::npos) << message;
  for (const char* part : {"body \"", "particle ", " at (", ", step ", ", time ", "probable cause: "})
    EXPECT_NE(message.find(part), std::string::npos) << message;
  // The world can be looked at, not advanced.
  EXPECT_EQ(ogive_world_step(scene.get(), 0), OGIVE_ERROR_STATE);
  EXPECT_GT(scene.result({1}).particles, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Breakdown,
    testing::Values(Nonsense{"RunawayVelocity", 1, "velocity", 2e5, "runs away"},
                    Nonsense{"OverflowingVelocity", 0, "velocity", 1e200, ""},
                    Nonsense{"CrushedVolume", 1, "volume_ratio", 1e-9, "volume ratio"},
                    Nonsense{"TornVolume", 0, "volume_ratio", 1e9, "volume ratio"},
                    Nonsense{"OverflowingStress", 0, "stress", 1e300, ""},
                    Nonsense{"RunawayByStress", 0, "stress", 1e9, ""},
                    Nonsense{"OverflowingEnergy", 1, "energy", 1e305, ""},
                    Nonsense{"OverflowingAffineVelocity", 1, "affine_velocity", 1e200, ""}),
    [](const auto& info) { return info.param.name; });

TEST(Breakdown, OfAFastBodyAsAWholeIsNone) {
  // A soft block that gravity has made ten times as fast as its waves: no particle runs away from the others.
  Scene scene;
  scene.grid(1, {-4, -4, -1000}, {4, 4, 10}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5, {0, 0, -20});
  const ogive_material_id soft = scene.material("gel", elastic(1e-3, 1e-4, 0.3));  // waves of 0.37 m/s
  scene.box("block", soft, {-1, -1, 2}, {1, 1, 4}, 0.5, {0, 0, 0});
  scene.prepare();
  while (scene.result({0}).speed < 20) scene.steps(1);
  measured("speed by that of waves", scene.result({0}).speed / std::sqrt(1.3462e-4 / 1e-3));
  EXPECT_NEAR(scene.result({0}).velocity[2], -20 * scene.progress().time, 1e-6);
}
