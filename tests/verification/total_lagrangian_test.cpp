// Total Lagrangian bodies: exact motions, energy, loads, mirrors, and the same bits for threads and restarts.
#include <algorithm>
#include <numbers>

#include "scene.hpp"
#include "store.hpp"

using namespace verification;

namespace {

constexpr double pi = std::numbers::pi;

ogive_body_def lagrangian(ogive_material_id material, Vec3 velocity, Vec3 angular = {}, Vec3 about = {}) {
  ogive_body_def def = Scene::body(material, velocity, angular, about);
  def.formulation = OGIVE_FORMULATION_TOTAL_LAGRANGIAN;
  return def;
}

ogive_solid_def box_between(Vec3 lower, Vec3 upper, double spacing) {
  Vec3 centre, size;
  for (int c = 0; c < 3; ++c) {
    centre[c] = 0.5 * (lower[c] + upper[c]);
    size[c] = upper[c] - lower[c];
  }
  return Scene::solid(OGIVE_SOLID_BOX, centre, size, spacing);
}

ogive_material_def neo_hookean(double density, double E, double nu) {
  ogive_material_def def = elastic(density, E, nu);
  def.strength = OGIVE_STRENGTH_NEO_HOOKEAN;
  return def;
}

}  // namespace

TEST(TotalLagrangian, ABodyInFreeFlightKeepsItsShapeAndCrossesCellsWithoutStress) {
  Scene scene;
  scene.grid(1, {0, 0, 0}, {40, 12, 12}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.8);
  const ogive_body_id body =
      scene.add("cube", lagrangian(scene.material("steel", steel()), {300, 20, -10}), box_between({4, 4, 6}, {8, 8, 9}, 0.5));
  scene.prepare();
  const std::vector<double> before = scene.field(body, "position");
  scene.advance(0.05);
  const std::vector<double> after = scene.field(body, "position");
  double worst = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    worst = std::max(worst, std::abs(after[i] - before[i] - 0.05 * Vec3{300, 20, -10}[i % 3]));
  measured("displacement_error", worst);
  EXPECT_LE(worst, 1e-11);  // measured 2e-14
  measured("stress", maximum(scene.field(body, "stress")));
  EXPECT_LE(maximum(scene.field(body, "stress")), 1e-6);  // of 2e5 MPa; measured 2e-9
  const ogive_ledger ledger = scene.ledger();
  EXPECT_LE(std::abs(ledger.residual_relative), 1e-12);
}

TEST(TotalLagrangian, ASpinningBodyKeepsEnergyAndAngularMomentum) {
  Scene scene;
  scene.grid(1, {-8, -8, -8}, {8, 8, 8}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.8);
  const ogive_body_id body = scene.add("cube", lagrangian(scene.material("rubber", neo_hookean(1e-3, 100, 0.3)), {}, {0, 3, 20}),
                                       box_between({-3, -2, -1}, {3, 2, 1}, 0.5));
  scene.prepare();
  const ogive_body_result before = scene.result(body);
  scene.advance(2 * pi / 20 * 5);
  const ogive_body_result after = scene.result(body);
  const ogive_ledger ledger = scene.ledger();
  measured("residual", ledger.residual_relative);
  EXPECT_LE(std::abs(ledger.residual_relative), 2e-3);
  double worst = 0, scale = 0;
  for (int c = 0; c < 3; ++c) {
    worst = std::max(worst, std::abs(after.angular_momentum[c] - before.angular_momentum[c]));
    scale = std::max(scale, std::abs(before.angular_momentum[c]));
  }
  measured("angular_momentum_error", worst / scale);
  EXPECT_LE(worst, 1e-10 * scale);
}

TEST(TotalLagrangian, AVibratingBarKeepsItsPeriodAndItsEnergy) {
  const double L = 100, E = 200e3, density = 7.85e-3, V0 = 0.1, k = pi / (2 * L), w = k * std::sqrt(E / density);
  std::vector<double> errors;
  for (const std::int32_t shape : {OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE})
    for (const int cells : {20, 40, 80}) {
      const double cell = L / cells;
      Scene scene;
      constexpr std::int32_t held = OGIVE_FACE_SYMMETRY;
      scene.grid(cell, {0, 0, 0}, {L + 3 * cell, 3 * cell, 3 * cell}, {held, 0, held, held, held, held})
          .numerics(shape, 0.8);
      const ogive_body_id bar = scene.add("bar", lagrangian(scene.material("steel", neo_hookean(density, E, 0)), {}),
                                          box_between({0, 0, 0}, {L, 3 * cell, 3 * cell}, cell / 2));
      scene.prepare();
      const double end = 1.125 * 2 * pi / w;
      const auto steps = static_cast<int>(std::ceil(end / (0.99 * scene.stable_time_step())));
      const double dt = end / steps;
      const std::vector<double> X = scene.field(bar, "position");
      const auto exact = [&](std::size_t p, double t) { return V0 * std::sin(k * X[3 * p]) * std::cos(w * t); };
      std::vector<double> v(X.size());
      for (std::size_t p = 0; p < X.size() / 3; ++p) v[3 * p] = exact(p, 0);
      scene.check(ogive_field_set(scene.get(), bar, "velocity", v.data(), static_cast<std::int64_t>(v.size())));
      const double energy = scene.ledger().total;
      double drift = 0;
      for (int step = 0; step < steps; ++step) {
        scene.step(dt);
        drift = std::max(drift, std::abs(scene.ledger().total / energy - 1));
      }
      v = scene.field(bar, "velocity");
      double sum = 0;
      for (std::size_t p = 0; p < X.size() / 3; ++p) sum += std::pow(v[3 * p] - exact(p, end - 0.5 * dt), 2);
      errors.push_back(std::sqrt(sum / (static_cast<double>(X.size()) / 3)) / V0);
      const std::string name = (shape == OGIVE_SHAPE_LINEAR ? "linear_" : "spline_") + std::to_string(cells);
      measured("error_" + name, errors.back());
      measured("drift_" + name, drift);
    }
}
