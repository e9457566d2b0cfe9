// Plane waves in thin columns between symmetry faces against exact shock states.
#include <algorithm>
#include <functional>

#include "scene.hpp"

using namespace verification;

namespace {

constexpr double cell = 0.5;
constexpr std::array<std::int32_t, 6> side_faces = {OGIVE_FACE_FREE,     OGIVE_FACE_FREE,     OGIVE_FACE_SYMMETRY,
                                                    OGIVE_FACE_SYMMETRY, OGIVE_FACE_SYMMETRY, OGIVE_FACE_SYMMETRY};
constexpr double width = 3 * cell;

// Linear shape functions gain energy at a factor of 0.5 behind a shock (measured: pressure 55 % too high).
double factor(std::int32_t shape) { return shape == OGIVE_SHAPE_LINEAR ? 0.2 : 0.5; }

ogive_material_def hydrodynamic(double density, double c0, double s, double gamma, double E, double nu, double Y) {
  ogive_material_def def = elastic(density, E, nu);
  def.strength = OGIVE_STRENGTH_J2_POWER;
  def.eos = OGIVE_EOS_MIE_GRUNEISEN;
  def.yield_stress = Y;
  def.eos_sound_speed = c0;
  def.eos_slope = s;
  def.gruneisen = gamma;
  def.viscosity_quadratic = 1.5;
  def.viscosity_linear = 0.06;
  return def;
}

// Strength a ten-thousandth of the pressure: a fluid. A shear modulus of zero is not plastic, so a small one.
ogive_material_def fluid_aluminium() { return hydrodynamic(2.7e-3, 5350, 1.34, 2.0, 100, 0.3, 0.1); }
ogive_material_def fluid_copper() { return hydrodynamic(8.93e-3, 3940, 1.489, 1.99, 100, 0.3, 0.1); }

// Means over particles with lower <= x < upper.
struct Means {
  double pressure = 0, density = 0, velocity = 0, axial = 0;
  int count = 0;
};

Means means(const Scene& scene, ogive_body_id body, double lower, double upper) {
  const std::vector<double> x = scene.field(body, "position"), v = scene.field(body, "velocity"),
                            p = scene.field(body, "pressure"), m = scene.field(body, "mass"),
                            volume = scene.field(body, "volume"), stress = scene.field(body, "stress");
  Means sum;
  double mass = 0, space = 0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (x[3 * i] < lower || x[3 * i] >= upper) continue;
    sum.pressure += p[i];
    sum.velocity += v[3 * i];
    sum.axial -= stress[6 * i];
    mass += m[i];
    space += volume[i];
    ++sum.count;
  }
  sum.pressure /= sum.count;
  sum.velocity /= sum.count;
  sum.axial /= sum.count;
  sum.density = mass / space;
  return sum;
}

// Where -stress_xx, averaged over layers, falls through `level` when coming from the far end at large x.
double front(const Scene& scene, ogive_body_id body, double level) {
  const std::vector<double> x = scene.field(body, "position"), stress = scene.field(body, "stress");
  std::map<std::int64_t, std::array<double, 3>> layers;  // by tenth of a cell: sum x, sum s, count
  for (std::size_t i = 0; i < x.size() / 3; ++i) {
    auto& layer = layers[std::llround(x[3 * i] / (0.1 * cell))];
    layer[0] += x[3 * i];
    layer[1] -= stress[6 * i];
    layer[2] += 1;
  }
  double outer_x = 0, outer_s = 0;
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
    const double at = layer->second[0] / layer->second[2], s = layer->second[1] / layer->second[2];
    if (s >= level && layer != layers.rbegin()) return outer_x + (level - outer_s) / (s - outer_s) * (at - outer_x);
    outer_x = at;
    outer_s = s;
  }
  return NAN;
}

struct Hugoniot {
  double density, c0, s;
  double shock(double up) const { return c0 + s * up; }
  double pressure(double up) const { return density * shock(up) * up; }
  double compressed(double up) const { return density * shock(up) / (shock(up) - up); }
};

void expect_relative(const char* name, double value, double exact, double tolerance) {
  measured(name, value / exact - 1);
  EXPECT_LE(std::abs(value / exact - 1), tolerance) << name << ": " << value << ", exact " << exact;
}

// A column moving at -up against a symmetry face at x = 0; measured in the frame of the column.
void against_wall(const ogive_material_def& material, const Hugoniot& exact, double up, double length,
                  std::int32_t shape) {
  Scene scene;
  auto faces = side_faces;
  faces[0] = OGIVE_FACE_SYMMETRY;
  scene.grid(cell, {0, 0, 0}, {length + 2, width, width}, faces).numerics(shape, factor(shape));
  const ogive_body_id column =
      scene.box("column", scene.material("metal", material), {0, 0, 0}, {length, width, width}, 0.5 * cell, {-up, 0, 0});
  scene.prepare();
  // The front runs at Us - up in this frame.
  const double speed = exact.shock(up) - up;
  scene.advance(0.35 * length / speed);
  const double first = front(scene, column, 0.5 * exact.pressure(up)), t1 = scene.progress().time;
  scene.advance(0.75 * length / speed);
  const double second = front(scene, column, 0.5 * exact.pressure(up)), t2 = scene.progress().time;
  const Means behind = means(scene, column, 5 * cell, second - 8 * cell);
  EXPECT_GT(behind.count, 1000);
  // Measured errors stand in the comments of the tests.
  expect_relative("pressure", behind.pressure, exact.pressure(up), 0.01);
  expect_relative("density", behind.density, exact.compressed(up), 0.01);
  expect_relative("particle_velocity", behind.velocity + up, up, 0.01);
  expect_relative("shock_speed", (second - first) / (t2 - t1) + up, exact.shock(up), 0.01);
}

constexpr Hugoniot aluminium = {2.7e-3, 5350, 1.34};
constexpr Hugoniot copper = {8.93e-3, 3940, 1.489};

}  // namespace

class PlateImpact : public testing::TestWithParam<std::int32_t> {};

TEST_P(PlateImpact, OfCopperOnARigidWallReachesTheHugoniot) {
  // Reference states: 8.672 GPa, 4278 m/s, 9430.4 kg/m3.
  ASSERT_NEAR(copper.pressure(227), 8672, 1);
  ASSERT_NEAR(copper.shock(227), 4278, 0.1);
  ASSERT_NEAR(copper.compressed(227), 9430.4e-6, 0.1e-6);
  against_wall(fluid_copper(), copper, 227, 60, GetParam());
}

TEST_P(PlateImpact, OfAluminiumOnARigidWallReachesTheHugoniot) {
  // Reference states: 3.8374 GPa, 5685 m/s, 2824.2 kg/m3.
  ASSERT_NEAR(aluminium.pressure(250), 3837.4, 0.1);
  ASSERT_NEAR(aluminium.shock(250), 5685, 0.1);
  ASSERT_NEAR(aluminium.compressed(250), 2824.2e-6, 0.1e-6);
  against_wall(fluid_aluminium(), aluminium, 250, 60, GetParam());
}

TEST(PlateImpactThroughContact, OfTwoEqualAluminiumPlatesAt500MetresPerSecondReachesTheHugoniot) {
  // Measured at most: pressure 0.22 %, density 0.01 %, velocity 0.14 %, speed 0.33 %. (Pure FLIP: 2 % in pressure and velocity;
  // trilinear FLIP 34 %.)
  const double up = 250, length = 60;
  Scene scene;
  scene.grid(cell, {-length - 20, 0, 0}, {length + 20, width, width}, side_faces)
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, factor(OGIVE_SHAPE_QUADRATIC_BSPLINE))
      .contact(OGIVE_CONTACT_HUANG_SECOND, OGIVE_DETECTION_GAP);
  const ogive_material_id metal = scene.material("metal", fluid_aluminium());
  const ogive_body_id flyer = scene.box("flyer", metal, {-length, 0, 0}, {0, width, width}, 0.5 * cell, {2 * up, 0, 0});
  const ogive_body_id target = scene.box("target", metal, {0, 0, 0}, {length, width, width}, 0.5 * cell, {0, 0, 0});
  scene.prepare();
  scene.advance(0.35 * length / aluminium.shock(up));
  const double level = 0.5 * aluminium.pressure(up);
  const double first = front(scene, target, level), t1 = scene.progress().time;
  scene.advance(0.75 * length / aluminium.shock(up));
  const double second = front(scene, target, level), t2 = scene.progress().time, interface = up * t2;
  for (const ogive_body_id body : {flyer, target}) {
    // The flyer's front runs at up * 2 - Us; its compressed zone mirrors the target's about the interface.
    const double inner = 5 * cell, outer = second - interface - 8 * cell;
    const Means behind = body.index == target.index ? means(scene, body, interface + inner, interface + outer)
                                                    : means(scene, body, interface - outer, interface - inner);
    EXPECT_GT(behind.count, 1000);
    const std::string side = body.index == target.index ? "target_" : "flyer_";
    expect_relative((side + "pressure").c_str(), behind.pressure, aluminium.pressure(up), 0.005);
    expect_relative((side + "density").c_str(), behind.density, aluminium.compressed(up), 0.001);
    expect_relative((side + "particle_velocity").c_str(), behind.velocity, up, 0.005);
  }
  expect_relative("shock_speed", (second - first) / (t2 - t1), aluminium.shock(up), 0.01);
}

namespace {

// Elastic-plastic uniaxial strain with p = -K ln J and yield stress Y: with e = -ln J the axial stress is M e up to
// e = Y / (2 G) and K e + 2 Y / 3 beyond. Jumps: (P2 - P1)(J1 - J2) = rho0 (u2 - u1)^2.
struct UniaxialStrain {
  double density = 2.7e-3, E = 69e3, nu = 0.3, Y = 262;
  double K() const { return E / (3 * (1 - 2 * nu)); }
  double G() const { return E / (2 * (1 + nu)); }
  double M() const { return K() + 4.0 / 3.0 * G(); }
  double yield_strain() const { return Y / (2 * G()); }
  double elastic_limit() const { return M() * yield_strain(); }
  double limit_velocity() const {
    return std::sqrt(elastic_limit() * (1 - std::exp(-yield_strain())) / density);
  }
  double stress(double u) const {
    const bool plastic = u > limit_velocity();
    const double e1 = plastic ? yield_strain() : 0, P1 = plastic ? elastic_limit() : 0, u1 = plastic ? limit_velocity() : 0;
    const auto axial = [&](double e) { return plastic ? K() * e + 2.0 / 3.0 * Y : M() * e; };
    double low = e1, high = 0.5;
    for (int i = 0; i < 200; ++i) {
      const double e = 0.5 * (low + high);
      ((axial(e) - P1) * (std::exp(-e1) - std::exp(-e)) < density * (u - u1) * (u - u1) ? low : high) = e;
    }
    return axial(low);
  }
};

ogive_material_def elastic_plastic() {
  const UniaxialStrain exact;
  ogive_material_def def = elastic(exact.density, exact.E, exact.nu);
  def.strength = OGIVE_STRENGTH_J2_POWER;
  def.yield_stress = exact.Y;
  def.viscosity_quadratic = 1.5;
  def.viscosity_linear = 0.06;
  return def;
}

struct Piston {
  Scene scene;
  ogive_body_id column{-1};
  Piston(double up, double length, double time, std::int32_t shape) {
    auto faces = side_faces;
    faces[0] = OGIVE_FACE_SYMMETRY;
    scene.grid(cell, {0, 0, 0}, {length + 2, width, width}, faces).numerics(shape, factor(shape));
    column = scene.box("column", scene.material("metal", elastic_plastic()), {0, 0, 0}, {length, width, width}, 0.5 * cell,
                       {-up, 0, 0});
    scene.prepare();
    scene.advance(time);
  }
};

}  // namespace

TEST_P(PlateImpact, OfAnElasticPistonAt20MetresPerSecondMakesTheElasticWave) {
  const UniaxialStrain exact;
  const double time = 40 / 5865.3;
  // Measured, linear / B-spline: stress +0.3 / -0.1 %, velocity -0.1 / -0.1 %, front -0.7 / -1.0 %.
  Piston piston(20, 60, time, GetParam());
  const Means behind = means(piston.scene, piston.column, 5 * cell, 40 - 8 * cell);
  measured("stress", behind.axial);
  expect_relative("stress_exact", behind.axial, exact.stress(20), 0.005);
  expect_relative("stress_linear", behind.axial, 316.7, 0.01);
  expect_relative("particle_velocity", behind.velocity + 20, 20, 0.005);
  expect_relative("front", front(piston.scene, piston.column, 0.5 * 316.7), time * (5865.3 - 20), 0.02);
  // The front overshoots.
  measured("plastic_strain", piston.scene.result(piston.column).maximum_plastic_strain);
  EXPECT_LE(piston.scene.result(piston.column).maximum_plastic_strain, 5e-4);  // measured 0 / 3.7e-4
}

TEST_P(PlateImpact, OfAPlasticPistonAt100MetresPerSecondMakesAPrecursorAndAPlasticWave) {
  const UniaxialStrain exact;
  EXPECT_NEAR(exact.elastic_limit(), 458.5, 0.1);
  const double time = 80 / 5865.3, plastic_front = time * (4614.8 - 100);
  // Measured: stress -2.0 / -0.15 %, precursor +1.9 / +1.8 %, its velocity +1.7 / +2.5 %, velocity -0.4 / -0.1 %. With
  // trilinear functions the stress behind the plastic wave wanders with time (+4.9 % at twice this length).
  const double tolerance = GetParam() == OGIVE_SHAPE_LINEAR ? 0.025 : 0.005;
  Piston piston(100, 100, time, GetParam());
  const Means behind = means(piston.scene, piston.column, 5 * cell, plastic_front - 8 * cell);
  const Means precursor = means(piston.scene, piston.column, plastic_front + 8 * cell, 80 * (1 - 100 / 5865.3) - 8 * cell);
  EXPECT_GT(precursor.count, 100);
  measured("stress", behind.axial);
  measured("precursor", precursor.axial);
  expect_relative("stress_exact", behind.axial, exact.stress(100), tolerance);
  expect_relative("stress_linear", behind.axial, 1343.7, tolerance + 0.005);
  expect_relative("precursor_exact", precursor.axial, exact.elastic_limit(), 0.025);
  expect_relative("precursor_velocity", precursor.velocity + 100, exact.limit_velocity(), 0.035);
  expect_relative("particle_velocity", behind.velocity + 100, 100, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Exact, PlateImpact, testing::Values(OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_SHAPE_GIMP),
                         [](const auto& info) { return shape_name(info.param); });
