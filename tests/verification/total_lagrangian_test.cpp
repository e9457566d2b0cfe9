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
  const ogive_body_id body = scene.add("cube", lagrangian(scene.material("steel", steel()), {300, 20, -10}),
                                       box_between({4, 4, 6}, {8, 8, 9}, 0.5));
  scene.prepare();
  const std::vector<double> before = scene.field(body, "position");
  scene.advance(0.05);
  const std::vector<double> after = scene.field(body, "position");
  double worst = 0;
  for (std::size_t i = 0; i < after.size(); ++i)
    worst = std::max(worst, std::abs(after[i] - before[i] - 0.05 * Vec3{300, 20, -10}[i % 3]));
  measured("displacement_error", worst);
  EXPECT_LE(worst, 1e-11);  // measured 1.3e-13
  measured("stress", maximum(scene.field(body, "stress")));
  EXPECT_LE(maximum(scene.field(body, "stress")), 1e-6);  // of 2e5 MPa; measured 4e-9
  const ogive_ledger ledger = scene.ledger();
  EXPECT_LE(std::abs(ledger.residual_relative), 1e-12);
}

TEST(TotalLagrangian, ASpinningBodyKeepsEnergyAndAngularMomentum) {
  Scene scene;
  scene.grid(1, {-8, -8, -8}, {8, 8, 8}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.8);
  const ogive_body_id body =
      scene.add("cube", lagrangian(scene.material("rubber", neo_hookean(1e-3, 100, 0.3)), {}, {0, 3, 20}),
                box_between({-3, -2, -1}, {3, 2, 1}, 0.5));
  scene.prepare();
  const ogive_body_result before = scene.result(body);
  scene.advance(2 * pi / 20 * 5);
  const ogive_body_result after = scene.result(body);
  const ogive_ledger ledger = scene.ledger();
  measured("residual", ledger.residual_relative);
  EXPECT_LE(std::abs(ledger.residual_relative), 5e-4);  // measured 1.4e-4: it is stretched by its spin and rings
  double worst = 0, scale = 0;
  for (int c = 0; c < 3; ++c) {
    worst = std::max(worst, std::abs(after.angular_momentum[c] - before.angular_momentum[c]));
    scale = std::max(scale, std::abs(before.angular_momentum[c]));
  }
  measured("angular_momentum_error", worst / scale);
  EXPECT_LE(worst, 1e-13 * scale);  // measured 2e-16
}

// Held at x = 0, free at L: v = V0 sin(k x) cos(w t), k = pi / 2L, w = k sqrt(E / rho). Velocities belong to the middle
// of steps.
TEST(TotalLagrangian, AVibratingBarConvergesWithSecondOrderAndKeepsItsEnergy) {
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
      EXPECT_LE(drift, 1.2e-3 * std::pow(20.0 / cells, 2));  // of second order; measured 9.6e-4 with 20 cells
    }
  // Measured: 2.00, 1.97; 1.98, 1.99. Largest errors with 80 cells 3.8e-5 and 1.6e-4.
  for (const std::size_t i : {1, 2, 4, 5}) EXPECT_GE(std::log2(errors[i - 1] / errors[i]), 1.9);
  EXPECT_LE(errors[2], 5e-5);
  EXPECT_LE(errors[5], 2e-4);
}

namespace {

enum class Partner { Lagrangian, Updated, Wall, Rigid };

struct Meeting {
  const char* name;
  Partner partner;
  double residual, rebound;
};

class BarMeets : public testing::TestWithParam<Meeting> {};

}  // namespace

// Two bars of 100 mm at 1 m/s each, or one and what does not give way: 39.62 MPa for 39.62 us, then -1 m/s. 50 cells.
TEST_P(BarMeets, WithItsForceForItsTimeAndGivesTheEnergyBack) {
  const double L = 100, cell = 2, W = 4 * cell, shift = 0.3;
  const Partner partner = GetParam().partner;
  constexpr std::int32_t held = OGIVE_FACE_SYMMETRY;
  Scene scene;
  scene.grid(cell, {-140, 0, 0}, {140, W, W}, {0, 0, held, held, held, held})
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5)
      .contact(OGIVE_CONTACT_HUANG_SECOND);
  const ogive_material_id material = scene.material("steel", elastic(7.85e-3, 200e3, 0));
  const ogive_body_id bar =
      scene.add("bar", lagrangian(material, {1, 0, 0}), box_between({shift - L, 0, 0}, {shift, W, W}, cell / 2));
  if (partner == Partner::Wall) {
    scene.wall({shift, 0, 0}, {-1, 0, 0});
  } else if (partner == Partner::Rigid) {
    scene.add("block", Scene::rigid(material, OGIVE_FORMULATION_RIGID_PRESCRIBED, {}),
              box_between({shift, 0, 0}, {shift + 20, W, W}, cell / 2));
  } else {
    ogive_body_def def = lagrangian(material, {-1, 0, 0});
    if (partner == Partner::Updated) def.formulation = OGIVE_FORMULATION_DEFORMABLE;
    scene.add("other", def, box_between({shift, 0, 0}, {shift + L, W, W}, cell / 2));
  }
  scene.prepare();
  const ogive_ledger start = scene.ledger();
  double force = 0, momentum_error = 0, deepest = 0, last_contact = 0;
  int count = 0;
  while (scene.progress().time < 0.06) {
    scene.steps(1);
    const ogive_body_result result = scene.result(bar);
    const ogive_ledger ledger = scene.ledger();
    const double time = scene.progress().time, pressure = -result.contact_force[0] / (W * W);
    if (time > 0.01 && time < 0.03) {
      force += pressure;
      ++count;
    }
    if (pressure > 1) last_contact = time;
    momentum_error =
        std::max(momentum_error, std::abs(ledger.momentum[0] - start.momentum[0] - ledger.boundary_impulse[0]));
    // Its end was half a particle from the outermost centres.
    if (partner == Partner::Wall || partner == Partner::Rigid)
      deepest = std::max(deepest, result.upper[0] + cell / 4 - shift);
  }
  const ogive_ledger end = scene.ledger();
  const double mass = scene.result(bar).mass;
  measured("pressure", force / count);
  measured("last_contact", last_contact);
  measured("rebound", scene.result(bar).velocity[0]);
  measured("residual", end.residual / start.kinetic);
  measured("contact_dissipation", end.contact_dissipation / start.kinetic);
  measured("momentum_error", momentum_error / mass);
  measured("penetration_cells", deepest / cell);
  EXPECT_NEAR(force / count, 39.62, 0.1);
  EXPECT_NEAR(last_contact, 0.03962, 0.001);
  EXPECT_NEAR(scene.result(bar).velocity[0], -GetParam().rebound, 0.01);
  EXPECT_LE(std::abs(end.residual / start.kinetic), GetParam().residual);
  EXPECT_LE(momentum_error / mass, 1e-12);
  EXPECT_LE(deepest / cell, 1e-3);
}

// Measured: residual +0.03 %, -2.3 %, +0.03 %, +0.02 %; rebound 0.956, 0.965, 0.947, 0.941. What contact takes is the
// impact of the layer of nodes that meets, 3.4 to 6.4 %, and halves with the cells. Momentum to 2e-14; at most 6e-5
// cells deep.
INSTANTIATE_TEST_SUITE_P(TotalLagrangian, BarMeets,
                         testing::Values(Meeting{"LagrangianBar", Partner::Lagrangian, 1e-3, 0.956},
                                         Meeting{"UpdatedBar", Partner::Updated, 0.03, 0.966},
                                         Meeting{"Wall", Partner::Wall, 1e-3, 0.946},
                                         Meeting{"RigidBlock", Partner::Rigid, 1e-3, 0.942}),
                         [](const auto& info) { return info.param.name; });

namespace {

// A steel ball strikes a plate obliquely, with friction, at a symmetry plane.
void ball_on_plate(Scene& scene, std::int32_t method, bool lagrangian_plate, std::int32_t threads = 1,
                   std::int32_t order = OGIVE_UPDATE_STRESS_FIRST, std::int32_t shape = OGIVE_SHAPE_QUADRATIC_BSPLINE) {
  scene.grid(1, {-8, 0, -6}, {8, 6, 8}, {0, 0, OGIVE_FACE_SYMMETRY, 0, 0, 0})
      .numerics(shape, 0.5, {}, threads, OGIVE_TRANSFER_FLIP, order)
      .contact(method, OGIVE_DETECTION_GAP, 0.3);
  ogive_material_def aluminium = elastic(2.7e-3, 69e3, 0.3);
  aluminium.strength = OGIVE_STRENGTH_J2_POWER;
  aluminium.yield_stress = 200;
  aluminium.hardening_modulus = 300;
  const ogive_material_id ball = scene.material("steel", steel()), plate = scene.material("aluminium", aluminium);
  scene.add("ball", lagrangian(ball, {60, 0, -120}), Scene::solid(OGIVE_SOLID_SPHERE, {-1, 0, 2.6}, {2, 0, 0}, 0.5));
  ogive_body_def def = lagrangian(plate, {});
  if (!lagrangian_plate) def.formulation = OGIVE_FORMULATION_DEFORMABLE;
  scene.add("plate", def, Scene::solid(OGIVE_SOLID_BOX, {0, 0, -1.5}, {12, 8, 4}, 0.5));
  scene.prepare();
}

}  // namespace

TEST(TotalLagrangian, EveryContactMethodKeepsMomentumBetweenAnyFormulations) {
  for (std::int32_t method = 0; method < ogive_contact_method_count(); ++method)
    for (const bool lagrangian_plate : {false, true})
      for (const std::int32_t order : {OGIVE_UPDATE_STRESS_FIRST, OGIVE_UPDATE_STRESS_LAST}) {
        Scene scene;
        ball_on_plate(scene, method, lagrangian_plate, 1, order);
        const ogive_ledger before = scene.ledger();
        scene.steps(100);
        const ogive_ledger after = scene.ledger();
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(after.momentum[c] - before.momentum[c], after.boundary_impulse[c], 1e-11)
              << method;  // 1e-13 of 16
        // It was stopped, whatever the method: nothing passes.
        EXPECT_GT(scene.result({0}).velocity[2], -100) << ogive_contact_method_name(method);
        if (lagrangian_plate) {
          EXPECT_LE(std::abs(after.residual_relative), 1e-3) << method;
        }
      }
}

TEST(TotalLagrangian, ResultsDoNotDependOnThreadsAndGoOnFromASaveToTheSameBits) {
  for (const bool lagrangian_plate : {false, true}) {
    Scene one, two, loaded;
    ball_on_plate(one, OGIVE_CONTACT_HUANG_SECOND, lagrangian_plate, 1);
    ball_on_plate(two, OGIVE_CONTACT_HUANG_SECOND, lagrangian_plate, 3);
    one.steps(60);
    two.steps(60);
    const auto same = [](const Scene& a, const Scene& b) {
      auto left = a.all_fields(), right = b.all_fields();
      ASSERT_EQ(left.size(), right.size());
      for (const auto& [name, values] : left) {
        ASSERT_EQ(values.size(), right[name].size()) << name;
        EXPECT_TRUE(same_bits(values.data(), right[name].data(), 8 * values.size())) << name;
      }
      EXPECT_EQ(a.ledger().total, b.ledger().total);
    };
    same(one, two);
    Store store;
    store.save(one);
    store.load(loaded);
    one.steps(30);
    loaded.steps(30);
    same(one, loaded);
  }
}

TEST(TotalLagrangian, AHalfModelIsTheWholeOne) {
  // Two balls that meet off their line, cut by y = 0 or whole.
  const auto run = [](bool half, std::vector<double>& position, std::vector<double>& velocity) {
    Scene scene;
    scene.grid(1, {-8, half ? 0.0 : -8.0, -8}, {8, 8, 8}, {0, 0, half ? OGIVE_FACE_SYMMETRY : 0, 0, 0, 0})
        .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.8);
    const ogive_material_id rubber = scene.material("rubber", neo_hookean(1e-3, 100, 0.3));
    const ogive_body_id a =
        scene.add("a", lagrangian(rubber, {20, 0, 0}), Scene::solid(OGIVE_SOLID_SPHERE, {-3.2, 0, 0}, {3, 0, 0}, 0.5));
    scene.add("b", lagrangian(rubber, {-20, 0, 0}), Scene::solid(OGIVE_SOLID_SPHERE, {3.2, 0, 0.4}, {3, 0, 0}, 0.5));
    scene.prepare();
    for (int i = 0; i < 150; ++i) scene.step(1.5e-3);
    const std::vector<double> x = scene.field(a, "position"), v = scene.field(a, "velocity");
    for (std::size_t p = 0; p < x.size(); p += 3)
      if (x[p + 1] > 0)
        for (int c = 0; c < 3; ++c) {
          position.push_back(x[p + c]);
          velocity.push_back(v[p + c]);
        }
  };
  std::vector<double> x_half, v_half, x_whole, v_whole;
  run(true, x_half, v_half);
  run(false, x_whole, v_whole);
  ASSERT_EQ(x_half.size(), x_whole.size());
  double worst_x = 0, worst_v = 0;
  for (std::size_t i = 0; i < x_half.size(); ++i) {
    worst_x = std::max(worst_x, std::abs(x_half[i] - x_whole[i]));
    worst_v = std::max(worst_v, std::abs(v_half[i] - v_whole[i]));
  }
  measured("position_difference", worst_x);
  measured("velocity_difference", worst_v);
  EXPECT_LE(worst_x, 1e-12);  // measured 7e-15
  EXPECT_LE(worst_v, 1e-10);  // measured 8e-13
}

TEST(TotalLagrangian, PrescribedVelocitiesHoldAtTheParticlesThemselves) {
  Scene scene;
  scene.grid(1, {0, -2, -2}, {30, 6, 6}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.8);
  ogive_material_def metal = elastic(7.85e-3, 210e3, 0.28);
  metal.strength = OGIVE_STRENGTH_J2_MULTIPLICATIVE;
  metal.yield_stress = 200;
  metal.hardening_modulus = 2100;
  metal.isotropic_fraction = 0.5;
  const ogive_body_id bar =
      scene.add("bar", lagrangian(scene.material("steel", metal), {}), box_between({5, 0, 0}, {15, 4, 4}, 0.5));
  ogive_clamp_def clamp;
  ogive_clamp_def_init(&clamp, sizeof clamp);
  for (int c = 0; c < 3; ++c) clamp.a[c] = -2, clamp.b[c] = c == 0 ? 6 : 6;
  scene.check(ogive_clamp_add(scene.get(), &clamp));
  ogive_load_def pull;
  ogive_load_def_init(&pull, sizeof pull);
  ogive_load_id load{-1};
  pull.kind = OGIVE_LOAD_VELOCITY;
  pull.region = OGIVE_REGION_BOX;
  pull.body = bar;
  for (int c = 0; c < 3; ++c) pull.a[c] = c == 0 ? 14 : -2, pull.b[c] = c == 0 ? 16 : 6;
  pull.value[0] = 20;
  scene.check(ogive_load_add(scene.get(), &pull, &load));
  scene.prepare();
  const std::vector<double> X = scene.field(bar, "position");
  scene.advance(0.02);
  const std::vector<double> x = scene.field(bar, "position"), v = scene.field(bar, "velocity");
  double worst = 0;
  for (std::size_t p = 0; p < X.size(); p += 3)
    for (int c = 0; c < 3; ++c) {
      if (X[p] < 6) worst = std::max(worst, std::abs(v[p + c]) + std::abs(x[p + c] - X[p + c]));
      if (X[p] > 14) worst = std::max(worst, std::abs(v[p + c] - (c == 0 ? 20 : 0)));
    }
  measured("velocity_error", worst);
  EXPECT_LE(worst, 1e-6);  // of 20
  const ogive_ledger ledger = scene.ledger();
  measured("residual_of_work", ledger.residual / ledger.external_work);
  EXPECT_LE(std::abs(ledger.residual / ledger.external_work), 2e-3);
  EXPECT_GT(ledger.plastic_dissipation, 0.5 * ledger.external_work);
}

TEST(TotalLagrangian, GravityAndTractionDoTheWorkThatIsBooked) {
  Scene scene;
  scene.grid(1, {-2, -2, -2}, {12, 6, 6}, {OGIVE_FACE_SYMMETRY, 0, 0, 0, 0, 0})
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5, {0, -50, 0});
  const ogive_body_id bar = scene.add("bar", lagrangian(scene.material("rubber", neo_hookean(1e-3, 100, 0.3)), {}),
                                      box_between({-2, 0, 0}, {8, 4, 4}, 0.5));
  ogive_load_def traction;
  ogive_load_def_init(&traction, sizeof traction);
  traction.kind = OGIVE_LOAD_TRACTION;
  traction.region = OGIVE_REGION_BOX;
  traction.body = bar;
  for (int c = 0; c < 3; ++c) traction.a[c] = c == 0 ? 7.5 : -1, traction.b[c] = c == 0 ? 9 : 5;
  traction.area = 16;
  traction.value[0] = 2;
  scene.check(ogive_load_add(scene.get(), &traction, nullptr));
  scene.prepare();
  const ogive_ledger before = scene.ledger();
  scene.advance(0.4);
  const ogive_ledger after = scene.ledger();
  measured("work", after.external_work);
  measured("residual_of_work", (after.residual - before.residual) / after.external_work);
  EXPECT_LE(std::abs(after.residual / after.external_work), 1e-3);  // measured 2e-4
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(after.momentum[c] - before.momentum[c], after.external_impulse[c] + after.boundary_impulse[c], 1e-10);
}

TEST(TotalLagrangian, ADistortedBodyGoesOnUpdatedWithItsMassMomentumAndEnergyOrStopsWhereThatIsForbidden) {
  for (const bool forbidden : {false, true}) {
    Scene scene;
    scene.grid(1, {-8, -8, -8}, {8, 8, 8}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5);
    ogive_body_def def = lagrangian(scene.material("rubber", neo_hookean(1e-3, 20, 0.3)), {20, 0, -3}, {0, 10, 0});
    def.distortion_limit = 1.05;
    if (forbidden) def.when_distorted = OGIVE_DISTORTED_STOP;
    const ogive_body_id ball = scene.add("ball", def, Scene::solid(OGIVE_SOLID_SPHERE, {-3, 0, 0}, {3, 0, 0}, 0.5));
    scene.wall({1, 0, 0}, {-1, 0, 0}).prepare();
    const ogive_body_result start = scene.result(ball);
    EXPECT_EQ(start.formulation, OGIVE_FORMULATION_TOTAL_LAGRANGIAN);
    bool switched = false;
    ogive_status status = OGIVE_OK;
    int after_switch = 0;
    for (int i = 0; i < 400 && status == OGIVE_OK && after_switch < 20; ++i) {
      after_switch += switched;
      const ogive_ledger before = scene.ledger();
      status = ogive_world_step(scene.get(), 0);
      if (status != OGIVE_OK) break;
      const ogive_body_result now = scene.result(ball);
      if (switched || now.formulation != OGIVE_FORMULATION_DEFORMABLE) continue;
      switched = true;
      const ogive_ledger after = scene.ledger();
      EXPECT_NEAR(now.mass / start.mass, 1, 1e-13);  // the order of the sum is another
      EXPECT_EQ(now.particles, start.particles);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(after.momentum[c] - before.momentum[c], after.boundary_impulse[c] - before.boundary_impulse[c],
                    1e-12);
      measured("energy_jump", (after.total - before.total) / before.total);
      measured("booked", (after.transfer_dissipation - before.transfer_dissipation) / before.total);
      // Measured -3.6e-3, of first order in the step: with the stress first the energies of a step belong to other
      // times.
      EXPECT_NEAR(after.total / before.total, 1, 5e-3);
    }
    if (forbidden) {
      EXPECT_EQ(status, OGIVE_ERROR_NUMERICAL);
      EXPECT_NE(std::string(ogive_world_message(scene.get())).find("distortion |F| |F^-1| / 3 must be at most 1.05"),
                std::string::npos)
          << ogive_world_message(scene.get());
    } else {
      EXPECT_TRUE(switched);
      EXPECT_EQ(status, OGIVE_OK);
    }
  }
}

TEST(TotalLagrangian, ABarThatYieldsAtAWallIsTheSameInBothFormulationsWithEitherLaw) {
  for (const std::int32_t strength : {OGIVE_STRENGTH_J2_MIXED, OGIVE_STRENGTH_J2_MULTIPLICATIVE}) {
    double length[2], plastic[2];
    for (const bool updated : {false, true}) {
      Scene scene;
      scene.grid(1, {0, 0, 0}, {26, 8, 8}, {0, 0, OGIVE_FACE_SYMMETRY, 0, OGIVE_FACE_SYMMETRY, 0})
          .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5);
      ogive_material_def metal = elastic(8.93e-3, 117e3, 0.35);
      metal.strength = strength;
      metal.yield_stress = 400;
      metal.hardening_modulus = 300;
      metal.isotropic_fraction = 0.5;
      ogive_body_def def = lagrangian(scene.material("copper", metal), {-100, 0, 0});
      if (updated) def.formulation = OGIVE_FORMULATION_DEFORMABLE;
      const ogive_body_id bar = scene.add("bar", def, box_between({2, -3, -3}, {22, 3, 3}, 0.5));
      scene.wall({2, 0, 0}, {1, 0, 0}).prepare();
      scene.advance(0.03);
      const ogive_body_result result = scene.result(bar);
      length[updated] = result.upper[0] - result.lower[0];
      plastic[updated] = scene.ledger().plastic_dissipation / scene.ledger().initial_total;
    }
    measured("length", length[0]);
    measured("length_updated", length[1]);
    measured("plastic", plastic[0]);
    measured("plastic_updated", plastic[1]);
    EXPECT_NEAR(length[0] / length[1], 1, 0.005);
    EXPECT_NEAR(plastic[0] / plastic[1], 1, 0.05);
  }
}

TEST(TotalLagrangian, WhatCannotBeIsRefusedWithFieldAndValue) {
  Scene scene;
  scene.grid(1, {0, 0, 0}, {10, 10, 10});
  ogive_material_def metal = elastic(1, 1, 0.3);
  metal.strength = OGIVE_STRENGTH_J2_MIXED;
  metal.yield_stress = 1;
  ogive_material_id material{-1};
  const auto message_of = [&](ogive_status status) {
    EXPECT_EQ(status, OGIVE_ERROR_ARGUMENT);
    return std::string(ogive_world_message(scene.get()));
  };
  metal.isotropic_fraction = 1.5;
  EXPECT_NE(message_of(ogive_material_add(scene.get(), "m", &metal, &material))
                .find("isotropic_fraction: must be 0..1, got 1.5"),
            std::string::npos);
  metal.isotropic_fraction = 0.5;
  metal.hardening_exponent = 0.5;
  EXPECT_NE(message_of(ogive_material_add(scene.get(), "m", &metal, &material)).find("hardening_exponent: must be 1"),
            std::string::npos);
  metal.hardening_exponent = 1;
  scene.check(ogive_material_add(scene.get(), "m", &metal, &material));
  const ogive_solid_def box = box_between({2, 2, 2}, {5, 5, 5}, 0.5);
  ogive_body_def def = lagrangian(material, {});
  ogive_body_id body{-1};
  def.distortion_limit = 1;
  EXPECT_NE(message_of(ogive_body_add_solid(scene.get(), "b", &def, &box, &body)).find("distortion_limit: must be > 1"),
            std::string::npos);
  def.distortion_limit = 5;
  def.when_distorted = 2;
  EXPECT_NE(
      message_of(ogive_body_add_solid(scene.get(), "b", &def, &box, &body)).find("when_distorted: must be 0..1, got 2"),
      std::string::npos);
  def.when_distorted = OGIVE_DISTORTED_STOP;
  scene.check(ogive_body_add_solid(scene.get(), "b", &def, &box, &body));
  scene.prepare();
  const std::vector<double> x = scene.field(body, "position");
  EXPECT_NE(message_of(ogive_field_set(scene.get(), body, "position", x.data(), static_cast<std::int64_t>(x.size())))
                .find("the body is total Lagrangian"),
            std::string::npos);
}

// A mirror cuts the clamped part: what the mirror takes of the clamps' impulses is booked too. Gravity does no work on what is held.
TEST(TotalLagrangian, ClampsAcrossAMirrorGiveTheMomentumThatIsBooked) {
  Scene scene;
  scene.grid(1, {0, -4, -4}, {12, 8, 8}, {OGIVE_FACE_SYMMETRY, 0, 0, 0, 0, 0})
      .numerics(OGIVE_SHAPE_LINEAR, 0.5, {3e4, -2e4, 1e4});
  const ogive_body_id bar = scene.add("bar", lagrangian(scene.material("steel", steel()), {-3, 40, -20}),
                                      box_between({0, 0, 0}, {6, 3, 3}, 0.5));
  ogive_clamp_def clamp;
  ogive_clamp_def_init(&clamp, sizeof clamp);
  for (int c = 0; c < 3; ++c) clamp.a[c] = c == 0 ? 0 : -1, clamp.b[c] = c == 0 ? 2 : 4;
  scene.check(ogive_clamp_add(scene.get(), &clamp));
  scene.prepare();
  const ogive_body_result before = scene.result(bar);
  scene.advance(0.01);
  const ogive_body_result after = scene.result(bar);
  const ogive_ledger ledger = scene.ledger();
  double worst = 0, scale = 0;
  for (int c = 0; c < 3; ++c) {
    const double given = ledger.boundary_impulse[c] + ledger.external_impulse[c];
    worst = std::max(worst, std::abs(after.momentum[c] - before.momentum[c] - given));
    scale = std::max({scale, std::abs(before.momentum[c]), std::abs(given)});
  }
  measured("momentum_error", worst / scale);
  EXPECT_LE(worst, 1e-13 * scale);  // measured 4e-14; 0.3 where the mirror's part was forgotten

  Scene held;
  held.grid(1, {0, 0, 0}, {8, 8, 8}).numerics(OGIVE_SHAPE_LINEAR, 0.5, {3e4, -2e4, 1e4});
  held.add("bar", lagrangian(held.material("steel", steel()), {}), box_between({2, 2, 2}, {5, 5, 5}, 0.5));
  for (int c = 0; c < 3; ++c) clamp.a[c] = 0, clamp.b[c] = 8;
  held.check(ogive_clamp_add(held.get(), &clamp));
  held.prepare();
  held.advance(0.01);
  const double fall = 0.5 * held.result({0}).mass * 1.4e9 * 0.01 * 0.01;  // m g^2 t^2 / 2, free
  measured("work_of_fall", held.ledger().external_work / fall);
  EXPECT_LE(std::abs(held.ledger().external_work), 1e-9 * fall);

  // A wall that it is pressed against stops nothing that the clamp does not hold already: contact takes no energy.
  Scene pressed;
  pressed.grid(1, {0, 0, 0}, {8, 8, 8}).numerics(OGIVE_SHAPE_LINEAR, 0.5, {0, 0, -3e4});
  pressed.add("bar", lagrangian(pressed.material("steel", steel()), {}), box_between({2, 2, 2}, {5, 5, 5}, 0.5));
  pressed.check(ogive_clamp_add(pressed.get(), &clamp));
  ogive_wall_def wall;
  ogive_wall_def_init(&wall, sizeof wall);
  wall.point[2] = 2;
  wall.normal[2] = 1;
  pressed.check(ogive_wall_add(pressed.get(), &wall));
  pressed.prepare();
  pressed.advance(0.01);
  measured("taken_by_contact", pressed.ledger().contact_dissipation / fall);
  EXPECT_LE(std::abs(pressed.ledger().contact_dissipation), 1e-9 * fall);
}

TEST(TotalLagrangian, WhatItCannotBeJoinedWithIsRefusedBeforeTheFirstStep) {
  const auto refusal = [](auto&& change) {
    Scene scene;
    scene.grid(1, {0, 0, 0}, {12, 12, 12});
    scene.add("rod", lagrangian(scene.material("steel", steel()), {}), box_between({2, 2, 2}, {5, 5, 5}, 0.5));
    scene.add("plate", Scene::body(ogive_material_id{0}, {}), box_between({6, 2, 2}, {9, 5, 5}, 0.5));
    change(scene);
    EXPECT_EQ(ogive_world_prepare(scene.get()), OGIVE_ERROR_ARGUMENT);
    return std::string(ogive_world_message(scene.get()));
  };
  const std::string rod = "body \"rod\": a total Lagrangian body needs ";
  EXPECT_EQ(refusal([](Scene& scene) { scene.numerics(OGIVE_SHAPE_GIMP, 0.5); }),
            rod + "shape_function \"linear\" or \"quadratic_bspline\", got \"gimp\"");
  Scene flat;
  flat.grid(1, {0, 0, 0}, {12, 12, 0}, {}, OGIVE_SPACE_PLANE_STRAIN);
  flat.add("rod", lagrangian(flat.material("steel", steel()), {}),
           Scene::solid(OGIVE_SOLID_BOX, {4, 4, 0}, {2, 2, 2}, 0.5));
  EXPECT_EQ(ogive_world_prepare(flat.get()), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(std::string(ogive_world_message(flat.get())),
            rod + "a three-dimensional model: space must be \"three_dimensional\"");
}
