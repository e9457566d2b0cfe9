// What a body weighs.
#include <numbers>

#include "scene.hpp"

using namespace verification;

namespace {

constexpr double pi = std::numbers::pi;

double mass_of(const ogive_solid_def& solid, std::array<std::int32_t, 6> faces = {}, Vec3 lower = {-40, -40, -40}) {
  Scene scene;
  scene.grid(1, lower, {40, 40, 40}, faces);
  const ogive_material_id material = scene.material("steel", steel());
  const ogive_body_id body = scene.add("body", Scene::body(material, {}), solid);
  scene.prepare();
  EXPECT_NEAR(scene.ledger().mass, scene.result(body).mass, 1e-12 * scene.ledger().mass);
  return scene.result(body).mass;
}

void expect_mass(const ogive_solid_def& solid, double volume, const char* name) {
  const double error = mass_of(solid) / (7.85e-3 * volume) - 1;
  measured(name, error);
  EXPECT_LE(std::abs(error), 1e-12);  // measured: sums of a few thousand terms, 1e-14
}

}  // namespace

TEST(Bodies, MassIsDensityTimesTheSolidsVolume) {
  expect_mass(Scene::solid(OGIVE_SOLID_BOX, {1, 2, 3}, {7, 5, 3}, 0.5), 7 * 5 * 3, "box");
  expect_mass(Scene::solid(OGIVE_SOLID_SPHERE, {0, 0, 0}, {5, 0, 0}, 0.5), 4.0 / 3.0 * pi * 125, "sphere");
  expect_mass(Scene::solid(OGIVE_SOLID_CYLINDER, {0, 0, 0}, {5, 8, 0}, 0.5), pi * 25 * 8, "cylinder");
  ogive_solid_def ring = Scene::solid(OGIVE_SOLID_CYLINDER, {0, 0, 0}, {5, 8, 3}, 0.5);
  expect_mass(ring, pi * (25 - 9) * 8, "ring");
  ring.lattice = OGIVE_LATTICE_POLAR;
  expect_mass(ring, pi * (25 - 9) * 8, "polar_ring");
  // Tangent ogive of radius R, arc rho = 2 crh R, nose length L: integral of pi r(x)^2 by Simpson's rule, plus the shank.
  const double R = 3, crh = 2, length = 20, rho = 2 * crh * R, L = std::sqrt(rho * rho - (rho - R) * (rho - R));
  double nose = 0;
  const int n = 20000;
  for (int i = 0; i <= n; ++i) {
    const double x = L * i / n, r = std::sqrt(rho * rho - (L - x) * (L - x)) - (rho - R);
    nose += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * pi * r * r * L / n / 3;
  }
  const ogive_solid_def rod = Scene::solid(OGIVE_SOLID_OGIVE_ROD, {0, 0, 10}, {R, length, crh}, 0.5);
  const double error = mass_of(rod) / (7.85e-3 * (nose + pi * R * R * (length - L))) - 1;
  measured("ogive_rod", error);
  EXPECT_LE(std::abs(error), 1e-9);  // Simpson's rule
}

TEST(Bodies, ASymmetryFaceThroughTheCentreKeepsHalfTheMassAndTwoKeepAQuarter) {
  const ogive_solid_def ball = Scene::solid(OGIVE_SOLID_SPHERE, {0, 0, 0}, {5, 0, 0}, 0.5);
  const double whole = mass_of(ball);
  const double half = mass_of(ball, {0, 0, OGIVE_FACE_SYMMETRY, 0, 0, 0}, {-40, 0, -40});
  const double quarter = mass_of(ball, {OGIVE_FACE_SYMMETRY, 0, OGIVE_FACE_SYMMETRY, 0, 0, 0}, {0, 0, -40});
  EXPECT_NEAR(half / whole, 0.5, 1e-13);
  EXPECT_NEAR(quarter / whole, 0.25, 1e-13);
}
