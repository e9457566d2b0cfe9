// Elastic bodies without dissipation: a vibrating bar, and two spheres that collide as Hertz has it.
#include <algorithm>
#include <numbers>

#include "scene.hpp"

using namespace verification;

namespace {

constexpr double pi = std::numbers::pi;

struct Scheme {
  const char* name;
  std::int32_t transfer, order;
  bool free_end;
  double least_order, largest_error;  // with 80 cells
};

class VibratingBar : public testing::TestWithParam<Scheme> {};

}  // namespace

// Held at x = 0, free at x = L: v = V0 sin(k x) cos(w t), k = pi / 2L, w = k sqrt(E / rho); held at both ends: k = pi /
// L. Poisson ratio 0: uniaxial stress. With the stress last velocities belong to the middle of the steps and are given
// and read there. With the stress first the stress, which starts from zero, is half a step behind: an error of first
// order.
TEST_P(VibratingBar, FollowsItsFirstMode) {
  const bool free_end = GetParam().free_end, stress_last = GetParam().order == OGIVE_UPDATE_STRESS_LAST;
  const double L = 100, E = 200e3, density = 7.85e-3, V0 = 0.1, k = pi / (free_end ? 2 * L : L),
               w = k * std::sqrt(E / density);
  std::vector<double> errors;
  for (const int cells : {10, 20, 40, 80}) {
    const double cell = L / cells;
    Scene scene;
    constexpr std::int32_t held = OGIVE_FACE_SYMMETRY;
    scene
        .grid(cell, {0, 0, 0}, {free_end ? L + 3 * cell : L, 3 * cell, 3 * cell},
              {held, free_end ? OGIVE_FACE_FREE : held, held, held, held, held})
        .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5, {}, 1, GetParam().transfer, GetParam().order);
    const ogive_body_id bar = scene.box("bar", scene.material("steel", elastic(density, E, 0)), {0, 0, 0},
                                        {L, 3 * cell, 3 * cell}, cell / 2, {});
    scene.prepare();
    const double end = 1.125 * 2 * pi / w;  // where velocity and displacement are equally large
    const auto steps = static_cast<int>(std::ceil(end / (0.8 * scene.stable_time_step())));
    const double dt = end / steps, shift = stress_last ? 0.5 * dt : 0;
    const std::vector<double> X = scene.field(bar, "position");
    const auto exact = [&](std::size_t p, double t) { return V0 * std::sin(k * X[3 * p]) * std::cos(w * t); };
    std::vector<double> v(X.size());
    for (std::size_t p = 0; p < X.size() / 3; ++p) v[3 * p] = exact(p, -shift);
    scene.check(ogive_field_set(scene.get(), bar, "velocity", v.data(), static_cast<std::int64_t>(v.size())));
    for (int step = 0; step < steps; ++step) scene.step(dt);
    v = scene.field(bar, "velocity");
    double sum = 0;
    for (std::size_t p = 0; p < X.size() / 3; ++p) sum += std::pow(v[3 * p] - exact(p, end - shift), 2);
    errors.push_back(std::sqrt(sum / (static_cast<double>(X.size()) / 3)) / V0);
    measured("error_" + std::to_string(cells), errors.back());
  }
  const double order = std::log2(errors[errors.size() - 2] / errors.back());
  measured("order", order);
  EXPECT_GE(order, GetParam().least_order);
  EXPECT_LE(errors.back(), GetParam().largest_error);
}

// Measured: order and error with 80 cells -0.17, 0.0025; 1.98, 0.0014; 1.98, 0.0007; 2.88, 0.0004; 0.90, 0.0018; 2.10,
// 0.0003. With the stress first the two errors, in space and in time, have opposite signs, so that the order is not one
// of a power.
INSTANTIATE_TEST_SUITE_P(
    Convergence, VibratingBar,
    testing::Values(
        Scheme{"HeldFlipStressFirst", OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_FIRST, false, -0.5, 0.004},
        Scheme{"HeldFlipStressLast", OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_LAST, false, 1.9, 0.002},
        Scheme{"HeldAffineStressLast", OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_LAST, false, 1.9, 0.001},
        Scheme{"FreeFlipStressLast", OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_LAST, true, 1.9, 0.001},
        Scheme{"FreeAffineStressFirst", OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_FIRST, true, 0.8, 0.003},
        Scheme{"FreeAffineStressLast", OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_LAST, true, 1.9, 0.0005}),
    [](const auto& info) { return info.param.name; });

// Two equal elastic spheres at the relative speed v, slow against sound (1.5 %). Hertz: with reduced mass m, radius R/2
// and modulus E* = E / (2 (1 - nu^2)), force F = (4/3) E* sqrt(R/2) d^(3/2); greatest approach d = (15 m v^2 / (16 E*
// sqrt(R/2)))^(2/5), contact time 2.94328 d / v. Quarter model.
struct Method {
  const char* name;
  std::int32_t method;
  double energy_tolerance;
};

class HertzContact : public testing::TestWithParam<Method> {};

TEST_P(HertzContact, OfTwoSpheresHasItsTimeAndForceAndGivesTheVelocityBack) {
  const double R = 4, E = 1000, nu = 0.3, density = 1000, v = 0.016;
  const double mass = density * 4.0 / 3.0 * pi * R * R * R, m = mass / 2, radius = R / 2,
               modulus = E / (2 * (1 - nu * nu));
  const double depth = std::pow(15 * m * v * v / (16 * modulus * std::sqrt(radius)), 0.4);
  const double force = 4.0 / 3.0 * modulus * std::sqrt(radius) * std::pow(depth, 1.5), time = 2.94328 * depth / v;
  std::vector<double> force_errors, time_errors, losses;
  for (const double cell : {0.5, 0.25}) {
    Scene scene;
    scene.grid(cell, {-9, 0, 0}, {9, 5, 5}, {0, 0, OGIVE_FACE_SYMMETRY, 0, OGIVE_FACE_SYMMETRY, 0})
        .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.25, {}, 1, OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_LAST)
        .contact(GetParam().method);
    const ogive_material_id soft = scene.material("soft", elastic(density, E, nu));
    const ogive_body_id a = scene.add("a", Scene::body(soft, {v / 2, 0, 0}),
                                      Scene::solid(OGIVE_SOLID_SPHERE, {-R - 0.1, 0, 0}, {R, 0, 0}, cell / 2));
    scene.add("b", Scene::body(soft, {-v / 2, 0, 0}),
              Scene::solid(OGIVE_SOLID_SPHERE, {R + 0.1, 0, 0}, {R, 0, 0}, cell / 2));
    scene.prepare();
    // The force of a single step is noisy: the largest mean over a fiftieth of the contact time, from the momentum.
    double first = 0, last = 0, largest = 0, at = 0, momentum = scene.result(a).momentum[0];
    const double window = time / 50;
    while (scene.progress().time < 0.2 / v + 1.6 * time) {
      scene.steps(1);
      const ogive_body_result result = scene.result(a);
      const double now = scene.progress().time;
      if (std::abs(result.contact_force[0]) > 0.01 * force / 4) {
        if (first == 0) first = now;
        last = now;
      }
      if (now - at < window) continue;
      largest = std::max(largest, 4 * (momentum - result.momentum[0]) / (now - at));
      momentum = result.momentum[0];
      at = now;
    }
    const std::string suffix = cell == 0.5 ? "_8" : "_16";
    force_errors.push_back(largest / force - 1);
    time_errors.push_back((last - first) / time - 1);
    const double restitution = -scene.result(a).velocity[0] / (v / 2);
    measured("force_error" + suffix, force_errors.back());
    measured("time_error" + suffix, time_errors.back());
    measured("restitution" + suffix, restitution);
    measured("energy_drift" + suffix, scene.ledger().residual_relative);
    losses.push_back(1 - restitution);
    EXPECT_LE(std::abs(scene.ledger().residual_relative), GetParam().energy_tolerance);
  }
  // Hertz's bodies are half spaces; here the contact's radius is a fifth of the sphere's, which makes the whole softer.
  EXPECT_LE(std::abs(force_errors[1]), 0.12);
  EXPECT_LE(std::abs(time_errors[1]), 0.05);
  EXPECT_LT(std::abs(time_errors[1]), std::abs(time_errors[0]));
  EXPECT_LE(std::abs(losses[1]), 0.04);
  EXPECT_LT(std::abs(losses[1]), 0.5 * losses[0]);
}

// Measured with 8 and 16 cells to the radius: force -3.6, -9.0 % (persistent), -3.7, -7.8 % (second), -6.6, -10.4 %
// (first), -3.6, -9.0 % (Pan); time -5.1, -2.8; -9.2, -3.7; -3.7, -1.5; -5.1, -2.9 %; restitution 0.933, 0.981; 0.912, 0.989; 0.934,
// 0.975; 0.934, 0.985; energy 0.0, -0.3; +1.4, +5.1; -1.7, -2.2; 0.0, +1.1 %.
INSTANTIATE_TEST_SUITE_P(Elastic, HertzContact,
                         testing::Values(Method{"Persistent", OGIVE_CONTACT_PERSISTENT, 0.005},
                                         Method{"HuangSecond", OGIVE_CONTACT_HUANG_SECOND, 0.06},
                                         Method{"HuangFirst", OGIVE_CONTACT_HUANG_FIRST, 0.03},
                                         Method{"Pan", OGIVE_CONTACT_PAN_2008, 0.015}),
                         [](const auto& info) { return info.param.name; });
