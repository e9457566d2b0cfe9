// Manufactured solutions: a motion is chosen, the body force that makes it exact is derived and given to every particle
// by the host, and the error must fall with the cell as measured. After Kamojjala, Brannon, Sadeghirad, Guilkey (Eng.
// with Computers 31 (2015) 193) and Wallstedt, Guilkey (J. Comput. Phys. 227 (2008) 9628). Neo-Hookean, T11:
//   P = (lambda ln J - G) F^-T + G F.
#include <functional>
#include <numbers>

#include "scene.hpp"

using namespace verification;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double density = 1e-3, young = 1, poisson = 0.3;
constexpr double shear = young / (2 * (1 + poisson)), lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson));

struct Motion {
  std::function<Vec3(Vec3 X, double t)> position;
  std::function<Vec3(Vec3 X, double t)> velocity;
  std::function<Vec3(Vec3 X, double t)> acceleration;  // body force per mass
};

ogive_material_def soft() {
  ogive_material_def def = elastic(density, young, poisson);
  def.strength = OGIVE_STRENGTH_NEO_HOOKEAN;
  return def;
}

void set(const Scene& scene, ogive_body_id body, const char* field, const std::vector<double>& values) {
  scene.check(ogive_field_set(scene.get(), body, field, values.data(), static_cast<std::int64_t>(values.size())));
}

std::vector<double> at_particles(const std::vector<double>& X, double t,
                                 const std::function<Vec3(Vec3, double)>& field) {
  std::vector<double> values(X.size());
  for (std::size_t p = 0; p < X.size() / 3; ++p) {
    const Vec3 value = field({X[3 * p], X[3 * p + 1], X[3 * p + 2]}, t);
    for (int c = 0; c < 3; ++c) values[3 * p + c] = value[c];
  }
  return values;
}

// Root mean square distance of the particles from their exact places at `end`, with steps of one size. With the stress
// last the scheme is a leapfrog: stress and places at the steps, velocities half a step before. So begun, its error in
// time is of second order. With the stress first the stress is half a step behind the velocity, and begins with that
// error: first order.
double error(Scene& scene, ogive_body_id body, const Motion& motion, double end, bool stress_last) {
  const std::vector<double> X = scene.field(body, "position"), mass = scene.field(body, "mass");
  const auto steps = static_cast<int>(std::ceil(end / (0.4 * scene.stable_time_step())));
  const double dt = end / steps;
  set(scene, body, "velocity", at_particles(X, stress_last ? -0.5 * dt : 0, motion.velocity));
  for (int step = 0; step < steps; ++step) {
    std::vector<double> force = at_particles(X, step * dt, motion.acceleration);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] *= mass[i / 3];
    set(scene, body, "force", force);
    scene.step(dt);
  }
  const std::vector<double> x = scene.field(body, "position"), exact = at_particles(X, end, motion.position);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - exact[i]) * (x[i] - exact[i]);
  return std::sqrt(sum / static_cast<double>(mass.size()));
}

// u_i = a sin(pi X_i) sin(c pi t + phase_i) in x and y on a unit square between faces without friction; none in z.
Motion axis_aligned(double a) {
  const double c = std::sqrt(young / density);
  const auto phase = [](int axis) { return axis == 0 ? 0.0 : pi; };
  Motion m;
  m.position = [=](Vec3 X, double t) {
    for (int i = 0; i < 2; ++i) X[i] += a * std::sin(pi * X[i]) * std::sin(c * pi * t + phase(i));
    return X;
  };
  m.velocity = [=](Vec3 X, double t) {
    Vec3 v{};
    for (int i = 0; i < 2; ++i) v[i] = a * c * pi * std::sin(pi * X[i]) * std::cos(c * pi * t + phase(i));
    return v;
  };
  m.acceleration = [=](Vec3 X, double t) {
    double F[2], J = 1;
    for (int i = 0; i < 2; ++i) J *= F[i] = 1 + a * pi * std::cos(pi * X[i]) * std::sin(c * pi * t + phase(i));
    Vec3 b{};
    for (int i = 0; i < 2; ++i) {
      const double u = a * std::sin(pi * X[i]) * std::sin(c * pi * t + phase(i)), slope = -pi * pi * u;  // dF_i / dX_i
      const double divergence = slope * ((lame * (1 - std::log(J)) + shear) / (F[i] * F[i]) + shear);
      b[i] = -c * c * pi * pi * u - divergence / density;
    }
    return b;
  };
  return m;
}

// Generalised vortex: the ring 0.75 < R < 1.25 turns by alpha = A sin(pi t / T) h(R), h = 1 - 32 (R-1)^2 + 256 (R-1)^4,
// which rests at both edges. With q = R d alpha / dR and J = 1 the stresses about the turned axes are s_rt = G q and
// s_tt = G q^2, so
//   b_r = -R alpha_t^2 + G q^2 / (rho R),  b_t = R alpha_tt - (G / rho) (3 alpha' + R alpha'').
Motion vortex(double amplitude, double period) {
  struct Angle {
    double value, rate, second, slope, curvature;
  };
  const auto angle = [=](double R, double t) {
    const double s = R - 1, h = 1 - 32 * s * s + 256 * s * s * s * s, dh = -64 * s + 1024 * s * s * s,
                 ddh = -64 + 3072 * s * s;
    const double w = pi / period, g = amplitude * std::sin(w * t);
    return Angle{g * h, amplitude * w * std::cos(w * t) * h, -w * w * g * h, g * dh, g * ddh};
  };
  const auto polar = [](Vec3 X) { return std::pair{std::hypot(X[0], X[1]), std::atan2(X[1], X[0])}; };
  Motion m;
  m.position = [=](Vec3 X, double t) {
    const auto [R, theta] = polar(X);
    const double phi = theta + angle(R, t).value;
    return Vec3{R * std::cos(phi), R * std::sin(phi), X[2]};
  };
  m.velocity = [=](Vec3 X, double t) {
    const auto [R, theta] = polar(X);
    const Angle a = angle(R, t);
    const double phi = theta + a.value;
    return Vec3{-R * a.rate * std::sin(phi), R * a.rate * std::cos(phi), 0};
  };
  m.acceleration = [=](Vec3 X, double t) {
    const auto [R, theta] = polar(X);
    const Angle a = angle(R, t);
    const double phi = theta + a.value, q = R * a.slope;
    const double radial = -R * a.rate * a.rate + shear * q * q / (density * R);
    const double tangential = R * a.second - shear / density * (3 * a.slope + R * a.curvature);
    return Vec3{radial * std::cos(phi) - tangential * std::sin(phi),
                radial * std::sin(phi) + tangential * std::cos(phi), 0};
  };
  return m;
}

struct Scheme {
  const char* name;
  std::int32_t shape, transfer, order;
  double square_order, vortex_order;  // least order of convergence
};

class Manufactured : public testing::TestWithParam<Scheme> {
 protected:
  static constexpr std::int32_t free = OGIVE_FACE_FREE, mirror = OGIVE_FACE_SYMMETRY;

  bool stress_last() const { return GetParam().order == OGIVE_UPDATE_STRESS_LAST; }

  // Three cells thick between symmetry faces: plane strain.
  Scene start(double cell, Vec3 lower, Vec3 upper, std::int32_t side) const {
    Scene scene;
    scene.grid(cell, lower, upper, {side, side, side, side, mirror, mirror})
        .numerics(GetParam().shape, 0.4, {}, 1, GetParam().transfer, GetParam().order);
    return scene;
  }
};

void expect_order(const char* name, const std::vector<double>& errors, double least) {
  for (std::size_t i = 0; i < errors.size(); ++i)
    measured(std::string(name) + "_error_" + std::to_string(i), errors[i]);
  const double order = std::log2(errors[errors.size() - 2] / errors.back());
  measured(std::string(name) + "_order", order);
  EXPECT_GE(order, least);
}

}  // namespace

TEST_P(Manufactured, AxisAlignedDisplacementConverges) {
  std::vector<double> errors;
  for (const int cells : {8, 16, 32}) {
    const double cell = 1.0 / cells;
    Scene scene = start(cell, {0, 0, 0}, {1, 1, 3 * cell}, mirror);
    const ogive_body_id body =
        scene.box("square", scene.material("soft", soft()), {0, 0, 0}, {1, 1, 3 * cell}, cell / 2, {});
    scene.prepare();
    errors.push_back(error(scene, body, axis_aligned(0.05), 0.75 / std::sqrt(young / density), stress_last()));
  }
  expect_order("square", errors, GetParam().square_order);
}

TEST_P(Manufactured, GeneralisedVortexConverges) {
  const double period = 2 / std::sqrt(young / density);
  std::vector<double> errors;
  for (const int cells : {8, 16}) {  // across the ring's width
    const double cell = 0.5 / cells;
    Scene scene = start(cell, {-1.5, -1.5, 0}, {1.5, 1.5, 3 * cell}, free);
    ogive_solid_def ring = Scene::solid(OGIVE_SOLID_CYLINDER, {0, 0, 0}, {1.25, 6 * cell, 0.75}, cell / 2);
    ring.lattice = OGIVE_LATTICE_POLAR;
    const ogive_body_id body = scene.add("ring", Scene::body(scene.material("soft", soft()), {}), ring);
    scene.prepare();
    errors.push_back(error(scene, body, vortex(0.2, period), 0.5 * period, stress_last()));
  }
  expect_order("vortex", errors, GetParam().vortex_order);
}

constexpr std::int32_t spline = OGIVE_SHAPE_QUADRATIC_BSPLINE;
// Orders measured, square (16 to 32 cells): 0.70, 1.53, 0.87, 1.48, 1.34, 1.61. Below 2, since particles wander through
// cells and no longer fill them evenly. Vortex (8 to 16 cells): 1.82, 1.92, 1.91, 1.94, 2.02, 2.36; from 16 to 32 cells
// (not run here, minutes) 1.11, 1.19, 1.24, 1.15, 1.82, 2.08: what particles keep of velocities that the grid cannot
// see does not fall with the cell.
INSTANTIATE_TEST_SUITE_P(
    Convergence, Manufactured,
    testing::Values(
        Scheme{"FlipStressFirst", spline, OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_FIRST, 0.6, 1.7},
        Scheme{"FlipStressLast", spline, OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_LAST, 1.4, 1.8},
        Scheme{"AffineFlipStressFirst", spline, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_FIRST, 0.8, 1.8},
        Scheme{"AffineFlipStressLast", spline, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_LAST, 1.4, 1.8},
        Scheme{"ApicStressLast", spline, OGIVE_TRANSFER_APIC, OGIVE_UPDATE_STRESS_LAST, 1.25, 1.9},
        Scheme{"XpicStressLast", spline, OGIVE_TRANSFER_XPIC, OGIVE_UPDATE_STRESS_LAST, 1.5, 2.2}),
    [](const auto& info) { return info.param.name; });
