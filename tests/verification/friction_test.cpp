// The heat of friction in the ledger: what sliding bodies lose, and nothing where they stick.
#include <cmath>

#include "scene.hpp"

using namespace verification;

namespace {

struct Numerics {
  const char* name;
  std::int32_t shape, order, method;
  bool on_wall;
};

class FrictionHeat : public testing::TestWithParam<Numerics> {};

struct Outcome {
  double way, heat, kinetic, residual;
};

// An elastic block of 4 x 4 x 2 mm and 0.032 g on a wall, or on a slab that is fixed below; it weighs 0.032 mN.
Outcome slid(const Numerics& numerics, double speed, double pull, double friction, double time) {
  Scene scene;
  scene.grid(1, {-4, -4, -2}, {12, 4, 5}, {0, 0, 0, 0, numerics.on_wall ? 0 : OGIVE_FACE_FIXED, 0})
      // Next to no work is done where it sticks, so that any growth of the energy is large beside it: no limit to that.
      .numerics(numerics.shape, 0.3, {pull, 0, -1}, 1, {}, numerics.order, {}, 2, 1e30)
      .contact(numerics.method, OGIVE_DETECTION_GAP, friction, OGIVE_NORMAL_MASTER);
  const ogive_material_id soft = scene.material("soft", elastic(1e-3, 20, 0.3));
  // The slab, the first body, gives the normals: with the average the block's edges would plough.
  if (numerics.on_wall)
    scene.wall({0, 0, 0}, {0, 0, 1}, friction, {}, numerics.method);
  else
    scene.box("slab", soft, {-4, -4, -2}, {12, 4, 0}, 0.5, {});
  const ogive_body_id block = scene.box("block", soft, {-2, -2, 0}, {2, 2, 2}, 0.5, {speed, 0, 0});
  scene.prepare();
  const double start = scene.result(block).centre[0];
  scene.advance(time);
  const ogive_ledger ledger = scene.ledger();
  return {scene.result(block).centre[0] - start, ledger.friction_dissipation, ledger.kinetic, ledger.residual};
}

}  // namespace

TEST_P(FrictionHeat, OfASlidingBlockIsItsForceTimesItsWay) {
  const double weight = 0.032, friction = 0.3, speed = 2, time = 4;
  const Outcome block = slid(GetParam(), speed, 0, friction, time);
  const double expected = friction * weight * block.way, lost = 0.5 * weight * speed * speed - block.kinetic;
  measured("way", block.way / (speed * time - 0.5 * friction * time * time));
  measured("heat", block.heat / expected);
  measured("heat_of_lost", block.heat / lost);
  measured("residual", block.residual / expected);
  // Measured: way within 0.001, heat of its way within 0.0044 (Pan; others 0.0011), of what the block lost within 0.0052.
  EXPECT_NEAR(block.way, speed * time - 0.5 * friction * time * time, 0.002 * block.way);
  EXPECT_NEAR(block.heat, expected, 0.008 * expected);
  EXPECT_NEAR(block.heat, lost, 0.01 * expected);
}

// Pulled with half of what would make it slide. Compared with the heat if it slid freely at that friction.
TEST_P(FrictionHeat, OfABlockThatSticksIsNone) {
  const double weight = 0.032, friction = 0.5, pull = 0.25, time = 4;
  const Outcome block = slid(GetParam(), 0, pull, friction, time);
  const double free = friction * weight * 0.5 * pull * time * time;
  measured("way", block.way);
  measured("heat", block.heat / free);
  // Measured: way 0.0001 to 0.0013 (Pan 0.0098), heat 0.00004 to 0.0004 (Pan 0.0007): the block is pulled from rest at once.
  EXPECT_LE(std::abs(block.way), 0.015);
  EXPECT_LE(std::abs(block.heat), 0.001 * free);
}

INSTANTIATE_TEST_SUITE_P(
    All, FrictionHeat,
    testing::Values(
        Numerics{"WallBSpline", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_UPDATE_STRESS_FIRST, OGIVE_CONTACT_HUANG_SECOND, true},
        Numerics{"SlabBSpline", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_UPDATE_STRESS_FIRST, OGIVE_CONTACT_HUANG_SECOND, false},
        Numerics{"SlabBSplineFirst", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_UPDATE_STRESS_FIRST, OGIVE_CONTACT_HUANG_FIRST, false},
        Numerics{"SlabBSplinePan", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_UPDATE_STRESS_FIRST, OGIVE_CONTACT_PAN_2008, false},
        Numerics{"WallPersistent", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_UPDATE_STRESS_FIRST, OGIVE_CONTACT_PERSISTENT, true},
        Numerics{"SlabPersistent", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_UPDATE_STRESS_FIRST, OGIVE_CONTACT_PERSISTENT, false},
        Numerics{"SlabLinear", OGIVE_SHAPE_LINEAR, OGIVE_UPDATE_STRESS_LAST, OGIVE_CONTACT_HUANG_SECOND, false}),
    [](const auto& info) { return info.param.name; });

// A sphere that rolls down an elastic slab without slipping: only creep in the patch of contact rubs.
TEST(FrictionHeat, OfASphereThatRollsWithoutSlippingIsASmallPartOfItsEnergy) {
  const double angle = 0.25 * 3.14159265358979, g = 10;
  Scene scene;  // m, s, kg
  scene.grid(0.4, {-2.4, 0, -0.8}, {12.8, 2.4, 4}, {0, 0, OGIVE_FACE_SYMMETRY, 0, OGIVE_FACE_FIXED, 0})
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5, {g * std::sin(angle), 0, -g * std::cos(angle)})
      .contact(OGIVE_CONTACT_HUANG_SECOND, OGIVE_DETECTION_GAP, 0.4);
  const double E = 9 * 7e6 * 1.5e6 / (3 * 7e6 + 1.5e6), nu = E / (2 * 1.5e6) - 1;
  const ogive_material_id soft = scene.material("soft", elastic(1000, E, nu)), hard = scene.material("hard", elastic(1e4, 10 * E, nu));
  scene.add("sphere", Scene::body(soft, {}), Scene::solid(OGIVE_SOLID_SPHERE, {0, 0, 1.6}, {1.6, 0, 0}, 0.2));
  scene.box("slab", hard, {-2, -2, -0.8}, {12, 2, 0}, 0.2, {});
  scene.prepare();
  scene.advance(1.5);
  const ogive_ledger ledger = scene.ledger();
  measured("heat", ledger.friction_dissipation / ledger.external_work);
  measured("residual", ledger.residual / ledger.external_work);
  // Measured: 0.0175 with 4 cells in the radius. (A slip of the trial velocities would book 0.049.)
  EXPECT_GT(ledger.friction_dissipation, 0);
  EXPECT_LE(ledger.friction_dissipation, 0.025 * ledger.external_work);
}
