// Rigid motion makes no stress, no heat and no plastic strain.
#include <algorithm>
#include <numbers>
#include <tuple>

#include "scene.hpp"

using namespace verification;

namespace {

enum class Law { Elastic, NeoHookean, JohnsonCook };

// So soft that a block turns once in a few hundred steps (E 100 MPa, wave speed about 200 m/s).
ogive_material_def soft(Law law) {
  ogive_material_def def = elastic(2.7e-3, 100, 0.3);
  if (law == Law::NeoHookean) def.strength = OGIVE_STRENGTH_NEO_HOOKEAN;
  if (law == Law::JohnsonCook) {
    def = failing_aluminium();
    def.youngs_modulus = 100;
    def.yield_stress = 5;
    def.eos_sound_speed = 175;
  }
  return def;
}

using Choice = std::tuple<std::int32_t, Law>;
std::string name_of(const testing::TestParamInfo<Choice>& info) {
  const char* laws[] = {"Elastic", "NeoHookean", "JohnsonCook"};
  return shape_name(std::get<0>(info.param)) +
         laws[static_cast<int>(std::get<1>(info.param))];
}

class RigidMotion : public testing::TestWithParam<Choice> {};

}  // namespace

TEST_P(RigidMotion, TranslationLeavesStressEnergyAndShapeAlone) {
  const auto [shape, law] = GetParam();
  Scene scene;
  scene.grid(1, {-6, -6, -6}, {30, 20, 6}).numerics(shape, 0.8);
  const Vec3 v = {100, 37, -11};
  const ogive_body_id body = scene.box("block", scene.material("soft", soft(law)), {-2.1, -2, -1.9}, {1.9, 2, 2.1}, 0.5, v);
  scene.prepare();
  const std::vector<double> start = scene.field(body, "position");
  scene.advance(0.2);
  EXPECT_GT(scene.progress().steps, 50);
  const std::vector<double> end = scene.field(body, "position"), velocity = scene.field(body, "velocity");
  double shape_error = 0, velocity_error = 0;
  for (std::size_t i = 0; i < end.size(); ++i) {
    shape_error = std::max(shape_error, std::abs(end[i] - start[i] - 0.2 * v[i % 3]));
    velocity_error = std::max(velocity_error, std::abs(velocity[i] - v[i % 3]) / 100);
  }
  const double stress = maximum(scene.field(body, "stress")) / 100, energy = maximum(scene.field(body, "energy"));
  measured("position_error_mm", shape_error);
  measured("velocity_error", velocity_error);
  measured("stress_over_E", stress);
  measured("largest_particle_energy_mJ", energy);
  EXPECT_LE(shape_error, 1e-11);
  EXPECT_LE(velocity_error, 1e-12);
  EXPECT_LE(stress, 1e-12);
  EXPECT_LE(energy, 1e-12);  // a particle's kinetic energy is 2
  EXPECT_LE(std::abs(scene.ledger().residual_relative), 1e-12);
  if (law == Law::JohnsonCook) {
    EXPECT_EQ(maximum(scene.field(body, "plastic_strain")), 0);
    EXPECT_EQ(scene.result(body).maximum_temperature, 293);
  }
}

TEST_P(RigidMotion, ABlockThatTurnsIsNeitherHeatedNorStrainedPlasticallyAndKeepsItsEnergy) {
  const auto [shape, law] = GetParam();
  const bool bspline = shape == OGIVE_SHAPE_QUADRATIC_BSPLINE;
  Scene scene;
  scene.grid(1, {-8, -8, -8}, {8, 8, 8})
      .numerics(shape, bspline ? 0.5 : 0.8, {}, 1, bspline ? OGIVE_TRANSFER_AFFINE_FLIP : OGIVE_TRANSFER_FLIP);
  const double omega = 2;  // the corner of the block runs at 7 m/s, 1/28 of the wave speed
  const Vec3 axis = {2.0 / 3.0 * omega, 1.0 / 3.0 * omega, 2.0 / 3.0 * omega};
  const ogive_material_id material = scene.material("soft", soft(law));
  const ogive_body_id body = scene.add("block", Scene::body(material, {}, axis, {0, 0, 0}),
                                       Scene::solid(OGIVE_SOLID_BOX, {0, 0, 0}, {4, 4, 4}, 0.5));
  scene.prepare();
  const std::vector<double> start = scene.field(body, "position");
  const double kinetic = scene.ledger().kinetic;
  const double half_turn = std::numbers::pi / omega;
  double largest_stress = 0;
  for (int i = 1; i <= 20; ++i) {
    scene.advance(i * half_turn / 10);
    largest_stress = std::max(largest_stress, maximum(scene.field(body, "von_mises")));
  }
  const std::vector<double> end = scene.field(body, "position");
  double displaced = 0;
  for (std::size_t i = 0; i < end.size(); ++i) displaced = std::max(displaced, std::abs(end[i] - start[i]));
  const double centrifugal = 2.7e-3 * omega * omega * 12;  // density times corner speed squared
  measured("steps", static_cast<double>(scene.progress().steps));
  measured("return_error_mm", displaced);
  measured("stress_over_centrifugal", largest_stress / centrifugal);
  measured("kinetic_change", scene.ledger().kinetic / kinetic - 1);
  measured("energy_drift", scene.ledger().residual_relative);
  measured("kinetic_and_internal_change", (scene.ledger().kinetic + scene.ledger().internal) / kinetic - 1);
  if (bspline) {
    // With affine velocities a block four cells across comes round to its place.
    EXPECT_LE(displaced, 0.2);  // mm, of 21.8 mm that the corner travels; measured 0.13
    EXPECT_LE(std::abs(scene.ledger().kinetic / kinetic - 1), 0.009);                                      // measured 0.0064
    EXPECT_LE(std::abs((scene.ledger().kinetic + scene.ledger().internal) / kinetic - 1), 0.009);          // measured 0.0067
    EXPECT_LE(std::abs(scene.ledger().residual_relative), 0.035);  // measured 0.028, the transfer's loss being booked
    EXPECT_LE(largest_stress, 0.45 * centrifugal);                 // measured 0.31
  } else {
    // With trilinear FLIP a third of the spin goes into shear at the surface nodes (nodal velocities there are those of a
    // centre of mass nearer the axis); the energy is kept: measured 6e-2. GIMP with FLIP likewise: 2e-2, stress 23.
    EXPECT_LE(std::abs(scene.ledger().residual_relative), 0.09);
    EXPECT_LE(largest_stress, 45 * centrifugal);  // measured 34
  }
  if (law == Law::JohnsonCook) {
    EXPECT_EQ(maximum(scene.field(body, "plastic_strain")), 0);
    EXPECT_EQ(scene.result(body).maximum_temperature, 293);
    EXPECT_EQ(scene.ledger().plastic_dissipation, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, RigidMotion,
                         testing::Combine(testing::Values(OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_SHAPE_GIMP),
                                          testing::Values(Law::Elastic, Law::NeoHookean, Law::JohnsonCook)),
                         name_of);
