// Two equal elastic bars collide end to end, which each sees as a rigid wall: 39.62 MPa, 39.62 us, rebound at -1 m/s.
#include <algorithm>

#include "scene.hpp"

using namespace verification;

struct Scheme {
  const char* name;
  std::int32_t shape;
  std::int32_t transfer;
  double factor;
  std::int32_t method;
  double energy_tolerance;   // of the internal energy at the transit time
  double rebound_tolerance;
  double drift;              // of the total energy
};

class ElasticBar : public testing::TestWithParam<Scheme> {};

TEST_P(ElasticBar, OnAnEqualBarIsStressedForTwoTransitTimesAndRebounds) {
  // E 200 GPa, density 7850 kg/m3, 100 mm, 1 m/s. Poisson ratio 0 makes a free bar's uniaxial stress exact in 3D.
  const double length = 100, wave = std::sqrt(200e3 / 7.85e-3), transit = length / wave;
  Scene scene;
  scene.grid(1, {-115, -4, -4}, {115, 4, 4})
      .numerics(GetParam().shape, GetParam().factor, {}, 1, GetParam().transfer)
      .contact(GetParam().method, OGIVE_DETECTION_SHARED_NODE);
  const ogive_material_id material = scene.material("steel", elastic(7.85e-3, 200e3, 0));
  const ogive_body_id left = scene.box("left", material, {-length, -2, -2}, {0, 2, 2}, 0.5, {1, 0, 0});
  const ogive_body_id right = scene.box("right", material, {0, -2, -2}, {length, 2, 2}, 0.5, {-1, 0, 0});
  scene.prepare();

  scene.advance(transit);
  double stress = 0, spread = 0;
  int count = 0;
  const std::vector<double> x = scene.field(left, "position"), s = scene.field(left, "stress");
  for (std::size_t p = 0; p < x.size() / 3; ++p)
    if (x[3 * p] > -85 && x[3 * p] < -5) stress -= s[6 * p], ++count;
  stress /= count;
  for (std::size_t p = 0; p < x.size() / 3; ++p)
    if (x[3 * p] > -85 && x[3 * p] < -5) spread = std::max(spread, std::abs(-s[6 * p] / stress - 1));
  measured("stress", stress);
  measured("spread_of_stress", spread);
  measured("internal_over_kinetic", scene.ledger().internal / scene.ledger().initial_total);
  EXPECT_NEAR(stress, 39.62, 0.01 * 39.62);  // measured 39.87 linear, 39.51 B-spline
  // At the transit time all kinetic energy has become elastic, but for what rings between the waves' fronts and grid. A method
  // that gains energy hides that part.
  EXPECT_NEAR((scene.ledger().internal + scene.ledger().transfer_dissipation) / scene.ledger().initial_total, 1,
              GetParam().energy_tolerance);
  EXPECT_NEAR(scene.ledger().internal / scene.ledger().initial_total, 1, GetParam().energy_tolerance);

  // Contact lasts until the impulse is complete: the time by which the total impulse over the plateau's force.
  const double force = 39.62 * 16;
  double last_contact = 0;
  while (scene.progress().time < 3 * transit) {
    scene.steps(1);
    if (std::abs(scene.result(left).contact_force[0]) > 0.5 * force) last_contact = scene.progress().time;
  }
  const double rebound = scene.result(left).velocity[0];
  measured("contact_time_us", 1e3 * last_contact);
  measured("rebound_speed", rebound);
  measured("energy_drift", scene.ledger().residual_relative);
  EXPECT_NEAR(1e3 * last_contact, 39.62, 0.02 * 39.62);  // measured 39.30 in both
  EXPECT_NEAR(rebound, -1, GetParam().rebound_tolerance);
  EXPECT_NEAR(scene.result(right).velocity[0], 1, GetParam().rebound_tolerance);
  EXPECT_LE(std::abs(scene.ledger().residual_relative), GetParam().drift);
}

// Measured: internal energy 1.002, 1.002, 0.989, 0.989, 0.985, 0.985; rebound -0.989, -1.001, -0.985, -0.980, -0.976, -0.980; drift of
// the total energy +0.014, +0.046, +0.008, +0.0007, -0.0009, -0.0004.
constexpr std::int32_t second = OGIVE_CONTACT_HUANG_SECOND, persistent = OGIVE_CONTACT_PERSISTENT;
INSTANTIATE_TEST_SUITE_P(
    Contact, ElasticBar,
    testing::Values(
        Scheme{"LinearSecond", OGIVE_SHAPE_LINEAR, OGIVE_TRANSFER_FLIP, 0.8, second, 0.01, 0.02, 0.06},
        Scheme{"BSplineSecond", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_TRANSFER_FLIP, 0.8, second, 0.01, 0.02, 0.06},
        Scheme{"BSplineAffineSecond", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_TRANSFER_AFFINE_FLIP, 0.5, second, 0.015, 0.02, 0.06},
        Scheme{"LinearPersistent", OGIVE_SHAPE_LINEAR, OGIVE_TRANSFER_FLIP, 0.8, persistent, 0.018, 0.03, 0.002},
        Scheme{"BSplinePersistent", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_TRANSFER_FLIP, 0.8, persistent, 0.018, 0.03, 0.002},
        Scheme{"BSplineAffinePersistent", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_TRANSFER_AFFINE_FLIP, 0.5, persistent, 0.018,
               0.03, 0.002},
        Scheme{"GimpSecond", OGIVE_SHAPE_GIMP, OGIVE_TRANSFER_FLIP, 0.8, second, 0.01, 0.02, 0.06},
        Scheme{"GimpPersistent", OGIVE_SHAPE_GIMP, OGIVE_TRANSFER_FLIP, 0.8, persistent, 0.018, 0.03, 0.002}),
    [](const auto& info) { return info.param.name; });
