// Rigid bodies and walls: momentum, angular momentum and energy, rolling, prescribed motion, partial models, restart.
#include <algorithm>
#include <numbers>

#include "store.hpp"

using namespace verification;

namespace {

constexpr std::int32_t free_body = OGIVE_FORMULATION_RIGID_FREE, prescribed = OGIVE_FORMULATION_RIGID_PRESCRIBED;

double distance(const double (&a)[3], const double (&b)[3]) {
  return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}
double size(const double (&a)[3]) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

}  // namespace

TEST(RigidBody, HasTheInertiaOfItsSolid) {
  Scene scene;
  scene.grid(1, {-12, -12, -12}, {12, 12, 12})
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5, {}, 1, {}, OGIVE_UPDATE_STRESS_FIRST, 1e-3);
  const ogive_material_id metal = scene.material("steel", steel());
  const Vec3 w = {0.3, -0.2, 0.5};
  const ogive_body_id box = scene.add("box", Scene::rigid(metal, free_body, {0, 0, 0}, w, {0, 0, 5}),
                                      Scene::solid(OGIVE_SOLID_BOX, {0, 0, 5}, {4, 6, 2}, 0.5));
  const ogive_body_id ball = scene.add("ball", Scene::rigid(metal, free_body, {0, 0, 0}, w, {0, 0, -5}),
                                       Scene::solid(OGIVE_SOLID_SPHERE, {0, 0, -5}, {4, 0, 0}, 0.5));
  scene.prepare();
  const ogive_body_result of_box = scene.result(box), of_ball = scene.result(ball);
  const double m = of_box.mass / 12, inertia[3] = {m * (36 + 4), m * (16 + 4), m * (16 + 36)};
  double energy = 0;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(of_box.angular_momentum[c], inertia[c] * w[c], 1e-12 * m * 50);
    energy += 0.5 * inertia[c] * w[c] * w[c];
  }
  EXPECT_NEAR(of_box.kinetic, energy, 1e-12 * energy);
  const double of_sphere = 0.4 * of_ball.mass * 16;
  measured("sphere_inertia_error", of_ball.angular_momentum[2] / (of_sphere * w[2]) - 1);
  EXPECT_NEAR(of_ball.angular_momentum[2] / (of_sphere * w[2]), 1, 0.02);  // measured +0.016: a cubic lattice of 16 particles across
}

TEST(RigidBody, TurningFreelyKeepsItsAngularMomentumExactlyAndItsEnergyToSecondOrder) {
  // About the middle axis, where rotation is unstable: the body turns over and over, seen along its angular momentum.
  double error[2] = {};
  for (int fine = 0; fine < 2; ++fine) {
    Scene scene;
    scene.grid(1, {-12, -12, -12}, {12, 12, 12})
        .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5, {}, 1, {}, OGIVE_UPDATE_STRESS_FIRST, fine ? 0.005 : 0.01);
    const ogive_body_id body =
        scene.add("box", Scene::rigid(scene.material("steel", steel()), free_body, {1, 0, 0}, {3, 0.2, 0.2}),
                  Scene::solid(OGIVE_SOLID_BOX, {0, 0, 0}, {3, 4, 2}, 0.5));
    scene.prepare();
    const ogive_body_result before = scene.result(body);
    double along = 0;
    // Of the diagonal from the first particle to the last along x.
    const auto diagonal = [&] {
      const std::vector<double> x = scene.field(body, "position");
      return x[x.size() - 3] - x[0];
    };
    double least = diagonal();
    EXPECT_NEAR(least, 2.5, 1e-12);
    for (int i = 0; i < (fine ? 1600 : 800); ++i) {
      scene.steps(1);
      const ogive_body_result now = scene.result(body);
      error[fine] = std::max(error[fine], std::abs(now.kinetic / before.kinetic - 1));
      along = std::max(along, distance(now.angular_momentum, before.angular_momentum));
      if (i % 20 == 0) least = std::min(least, diagonal());
    }
    measured("angular_momentum_drift", along / size(before.angular_momentum));
    measured("energy_error", error[fine]);
    measured("least", least);
    EXPECT_LT(least, -2);  // it did turn over
    EXPECT_LE(along, 1e-12 * size(before.angular_momentum));
    EXPECT_NEAR(scene.result(body).centre[0], 8, 1e-11);
  }
  EXPECT_LE(error[0], 1e-3);
  EXPECT_GT(error[0] / error[1], 3);  // measured 4
}

TEST(RigidBody, StrikingAnotherObliquelyKeepsMomentumAndAngularMomentum) {
  for (const bool deformable : {false, true})
    for (const double friction : {0.0, 0.4}) {
      Scene scene;
      scene.grid(1, {-14, -10, -10}, {14, 10, 10})
          .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4, {}, 1, {}, OGIVE_UPDATE_STRESS_FIRST, 1e-3)
          .contact(OGIVE_CONTACT_HUANG_SECOND, OGIVE_DETECTION_GAP, friction);
      const ogive_material_id metal = scene.material("steel", steel());
      const ogive_body_id a = scene.add("a", Scene::rigid(metal, free_body, {20, 3, 0}, {0, 0, 1}, {-4, 0.7, 0}),
                                        Scene::solid(OGIVE_SOLID_SPHERE, {-4, 0.7, 0}, {3, 0, 0}, 0.5));
      const ogive_solid_def block = Scene::solid(OGIVE_SOLID_BOX, {2.2, 0, 0}, {6, 5, 4}, 0.5);
      const ogive_body_id b =
          deformable ? scene.add("b", Scene::body(scene.material("soft", elastic(2.7e-3, 500, 0.3)), {-5, 0, 0}), block)
                     : scene.add("b", Scene::rigid(metal, free_body, {-5, 0, 0}), block);
      scene.prepare();
      const ogive_ledger before = scene.ledger();
      const double start = scene.result(a).momentum[0];
      scene.advance(0.3);
      const ogive_ledger after = scene.ledger();
      const std::string name = std::string(deformable ? "block_" : "rigid_") + (friction > 0 ? "rough" : "smooth");
      measured("exchanged_" + name, (start - scene.result(a).momentum[0]) / start);
      measured("momentum_" + name, momentum_miss(before, after) / start);
      double couple[3];
      for (int c = 0; c < 3; ++c) couple[c] = after.angular_momentum[c] - after.contact_couple[c];
      measured("angular_momentum_" + name, distance(before.angular_momentum, couple) / (start * 3));
      measured("couple_" + name, size(after.contact_couple) / (start * 3));
      measured("energy_" + name, after.total / before.total - 1);
      measured("spin_" + name, scene.result(a).angular_velocity[2]);
      EXPECT_GT((start - scene.result(a).momentum[0]) / start, 0.3);
      EXPECT_LE(momentum_miss(before, after), 1e-12 * start);
      // Between rigid bodies the impulses act at nodes, equal and opposite; a deformable body's particles see them with the
      // error of the affine transfer and of forces on a moving grid.
      EXPECT_LE(distance(before.angular_momentum, couple), (deformable ? 2e-2 : 1e-11) * start * 3);
      if (deformable)
        EXPECT_NEAR(after.total / before.total, 1, 0.06);  // measured +0.027, +0.043
      else
        EXPECT_LT(after.total, before.total);  // plastic contact
      EXPECT_GT(scene.result(b).velocity[0], -5);
    }
}

TEST(RigidBody, WithPrescribedMotionDoesTheWorkThatTheLedgerSays) {
  Scene scene;
  scene.grid(1, {-3, -3, -1}, {3, 3, 24}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4);
  const ogive_material_id metal = scene.material("metal", elastic(2.7e-3, 69e3, 0.3));
  const ogive_body_id punch = scene.add("punch", Scene::rigid(metal, prescribed, {0, 0, 0}),
                                        Scene::solid(OGIVE_SOLID_BOX, {0, 0, 1}, {4, 4, 2}, 0.5));
  const ogive_body_id bar = scene.box("bar", metal, {-2, -2, 2.1}, {2, 2, 14}, 0.5, {0, 0, 0});
  const double time[] = {0, 0.002, 0.01}, velocity[] = {0, 0, 0, 0, 0, 20, 0, 0, 20};
  scene.check(ogive_body_set_motion(scene.get(), punch, 3, time, velocity, nullptr));
  scene.prepare();
  const ogive_ledger before = scene.ledger();
  const double start = scene.result(punch).centre[2];
  scene.advance(0.012);
  const ogive_ledger after = scene.ledger();
  const double moved = scene.result(punch).centre[2] - start;
  measured("moved", moved);
  measured("work", after.prescribed_work);
  measured("energy_gain", after.kinetic + after.internal);
  measured("residual_over_work", after.residual / after.prescribed_work);
  measured("momentum_miss", momentum_miss(before, after) / after.momentum[2]);
  EXPECT_NEAR(moved, 20 * 0.001 + 20 * 0.01, 1e-3);  // exact but in the steps with a knot inside
  EXPECT_NEAR(scene.result(punch).velocity[2], 20, 1e-12);
  EXPECT_GT(scene.result(bar).velocity[2], 10);
  EXPECT_LE(momentum_miss(before, after), 1e-12 * after.momentum[2]);
  EXPECT_LE(std::abs(after.residual), 0.05 * after.prescribed_work);
}

TEST(RigidBody, ThatTurnsAsPrescribedComesRoundToWhereItWas) {
  Scene scene;
  scene.grid(1, {-8, -8, -8}, {8, 8, 8})
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4, {}, 1, {}, OGIVE_UPDATE_STRESS_FIRST, 1e-3);
  const double w = 2 * std::numbers::pi;
  const ogive_body_id body =
      scene.add("box", Scene::rigid(scene.material("steel", steel()), prescribed, {0, 0, 1}, {0, 0, w}, {1, 0, 0}),
                Scene::solid(OGIVE_SOLID_BOX, {0, 0, 0}, {4, 3, 2}, 0.5));
  scene.prepare();
  const ogive_ledger before = scene.ledger();
  const std::vector<double> start = scene.field(body, "position");
  scene.advance(1);
  const std::vector<double> end = scene.field(body, "position");
  double worst = 0;
  for (std::size_t i = 0; i < end.size(); ++i) worst = std::max(worst, std::abs(end[i] - start[i] - (i % 3 == 2 ? 1 : 0)));
  measured("miss", worst);
  EXPECT_LE(worst, 1e-11);
  EXPECT_NEAR(scene.ledger().residual, 0, 1e-11 * before.total);
  EXPECT_LE(momentum_miss(before, scene.ledger()), 1e-11 * scene.result(body).mass * w);
}

namespace {

// A rigid sphere of radius 1.6 on a wall that is inclined by `angle`, from rest; the z axis is normal to the wall.
// Distance of its centre along the wall over that of the exact solution.
double rolling(double angle, double friction, double cell, bool sphere = true, std::int32_t shape = OGIVE_SHAPE_QUADRATIC_BSPLINE,
               bool of_particles = false) {
  const double g = 10, radius = 1.6;
  Scene scene;
  scene.grid(cell, {-2.4, -2.4, -1.2}, {12, 2.4, 4.8})
      .numerics(shape, 0.4, {g * std::sin(angle), 0, -g * std::cos(angle)}, 1, {}, OGIVE_UPDATE_STRESS_FIRST, 5e-3)
      .contact(OGIVE_CONTACT_HUANG_SECOND, OGIVE_DETECTION_GAP, friction, OGIVE_NORMAL_AVERAGE, 0.1);
  const ogive_material_id stuff = scene.material("stuff", elastic(1, 1e3, 0.3));
  ogive_solid_def solid = Scene::solid(sphere ? OGIVE_SOLID_SPHERE : OGIVE_SOLID_CYLINDER, {0, 0, radius},
                                       {radius, sphere ? 0 : 1.6, 0}, 0.5 * cell);
  const double axis[3] = {0, sphere ? 0.0 : 1.0, sphere ? 1.0 : 0.0};
  std::copy_n(axis, 3, solid.axis);
  const ogive_body_id body = scene.add("body", Scene::rigid(stuff, free_body, {0, 0, 0}), solid);
  if (of_particles)
    scene.add("plane", Scene::rigid(stuff, prescribed, {0, 0, 0}),
              Scene::solid(OGIVE_SOLID_BOX, {4.8, 0, -0.4}, {14.4, 4.8, 0.8}, 0.5 * cell));
  else
    scene.wall({0, 0, 0}, {0, 0, 1}, friction, 0.1);
  scene.prepare();
  const ogive_ledger before = scene.ledger();
  scene.advance(1.2);
  const ogive_ledger after = scene.ledger();
  EXPECT_LE(momentum_miss(before, after), 1e-10 * after.mass);
  const double part = sphere ? 0.4 : 0.5;  // I = part m r^2
  const bool slips = std::tan(angle) > friction * (1 + 1 / part);
  const double acceleration =
      slips ? g * (std::sin(angle) - friction * std::cos(angle)) : g * std::sin(angle) / (1 + part);
  measured("height", scene.result(body).centre[2] / radius);
  measured("energy", after.residual / after.external_work);
  measured("spin", scene.result(body).angular_velocity[1] * radius / scene.result(body).velocity[0]);
  return scene.result(body).centre[0] / (0.5 * acceleration * 1.2 * 1.2);
}

}  // namespace

TEST(RigidBody, RollsDownAnInclinedWallAsTheExactSolutionSays) {
  const double steep = std::numbers::pi / 3, flat = std::numbers::pi / 4;
  for (const bool sphere : {true, false}) {
    const double slip = rolling(steep, 0.2, 0.4, sphere), stick = rolling(flat, 0.4, 0.4, sphere),
                 fine = rolling(flat, 0.4, 0.2, sphere);
    measured("slip", slip);
    measured("stick", stick);
    measured("stick_fine", fine);
    EXPECT_NEAR(slip, 1, 0.01);  // measured +0.004
    EXPECT_NEAR(stick, 1, 0.045);  // measured -0.040, cylinder -0.039: the patch of nodes resists rolling
    EXPECT_NEAR(fine, 1, 0.03);    // measured -0.025
    EXPECT_LT(std::abs(fine - 1), std::abs(stick - 1));
  }
  const double linear = rolling(flat, 0.4, 0.4, true, OGIVE_SHAPE_LINEAR);
  measured("linear", linear);
  EXPECT_NEAR(linear, 1, 0.045);  // measured -0.037
  const double of_particles = rolling(flat, 0.4, 0.4, true, OGIVE_SHAPE_QUADRATIC_BSPLINE, true);
  measured("on_particles", of_particles);
  EXPECT_NEAR(of_particles, 1, 0.045);  // measured -0.030
}

TEST(Wall, TurnsAnElasticBlockBackAndBooksItsImpulse) {
  const auto thrown = [](bool wall, std::int32_t shape, std::int32_t method) {
    Scene scene;
    std::array<std::int32_t, 6> faces{};
    if (!wall) faces[4] = OGIVE_FACE_SYMMETRY;
    scene.grid(1, {-6, -6, wall ? -3.0 : 0.0}, {6, 6, 16}, faces).numerics(shape, 0.4);
    if (wall) scene.wall({0, 0, 0}, {0, 0, 2}, 0, 0.1, method);
    scene.box("block", scene.material("metal", elastic(2.7e-3, 69e3, 0.3)), {-2, -2, 0.5}, {2, 2, 6.5}, 0.5, {0, 0, -20});
    scene.prepare();
    const ogive_ledger before = scene.ledger();
    scene.advance(0.06);
    EXPECT_LE(momentum_miss(before, scene.ledger()), 1e-12 * before.mass * 20);
    measured(wall ? "residual_wall" : "residual_mirror", scene.ledger().residual_relative);
    // Measured +0.0015 trilinear, +0.0010 B-spline; the other methods -0.20 to +0.23.
    if (wall && method == OGIVE_CONTACT_PERSISTENT) {
      EXPECT_LE(std::abs(scene.ledger().residual_relative), 0.004);
    }
    return scene.result({0}).velocity[2];
  };
  for (const std::int32_t shape : {OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE}) {
    for (const std::int32_t method : {OGIVE_CONTACT_HUANG_FIRST, OGIVE_CONTACT_HUANG_SECOND, OGIVE_CONTACT_YORK,
                                      OGIVE_CONTACT_BARDENHAGEN_2000, OGIVE_CONTACT_PAN_2008, OGIVE_CONTACT_PERSISTENT}) {
      const double speed = thrown(true, shape, method);
      measured(std::string("wall_") + ogive_contact_method_name(method), speed);
      EXPECT_GT(speed, 12.5);  // measured 16.9 .. 18.3 trilinear with FLIP, 13.0 .. 17.7 B-spline with affine FLIP
    }
  }
  // A mirror image is of the same velocity field: with trilinear functions the block has not left it yet.
  measured("mirror", thrown(false, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_CONTACT_HUANG_SECOND));
}

TEST(Wall, StopsARigidBodyThatFallsOnItAndRubsOneThatSlides) {
  // v0 sliding under friction mu: stops after v0^2 / (2 mu g).
  Scene scene;
  scene.grid(1, {-4, -4, -2}, {16, 4, 6})
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4, {0, 0, -10}, 1, {}, OGIVE_UPDATE_STRESS_FIRST, 2e-3)
      .wall({0, 0, 0}, {0, 0, 1}, 0.5, 0.0);
  const ogive_body_id body = scene.add("box", Scene::rigid(scene.material("steel", steel()), free_body, {6, 0, 0}),
                                       Scene::solid(OGIVE_SOLID_BOX, {0, 0, 0.5}, {4, 4, 1}, 0.5));
  scene.prepare();
  const double start = scene.result(body).centre[2];
  scene.advance(2);
  const ogive_ledger after = scene.ledger();
  measured("way", scene.result(body).centre[0] / 3.6);
  measured("sunk", start - scene.result(body).centre[2]);
  measured("speed", scene.result(body).speed);
  measured("heat", after.friction_dissipation / after.initial_total);
  EXPECT_NEAR(scene.result(body).centre[0], 3.6, 0.05);
  EXPECT_NEAR(scene.result(body).centre[2], start, 0.05);
  EXPECT_LE(scene.result(body).speed, 1e-9);
  EXPECT_NEAR(after.friction_dissipation, after.initial_total, 0.02 * after.initial_total);
}

namespace {

// A rigid ball strikes an elastic block off its middle in x; symmetric about y = 0.
Scene struck(bool half, int threads, std::int32_t method = OGIVE_CONTACT_HUANG_SECOND) {
  Scene scene;
  std::array<std::int32_t, 6> faces{};
  if (half) faces[2] = OGIVE_FACE_SYMMETRY;
  scene.grid(1, {-10, half ? 0.0 : -8.0, -8}, {10, 8, 10}, faces)
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4, {0, 0, -50}, threads)
      .contact(method, OGIVE_DETECTION_GAP, 0.3)
      .wall({0, 0, -4}, {0.2, 0, 1}, 0.2);
  const ogive_material_id hard = scene.material("steel", steel());
  const ogive_material_id soft = scene.material("soft", elastic(2.7e-3, 2e3, 0.3));
  scene.add("ball", Scene::rigid(hard, free_body, {10, 0, -40}, {0, 1, 0}, {0.5, 0, 3.1}),
            Scene::solid(OGIVE_SOLID_SPHERE, {0.5, 0, 3.1}, {3, 0, 0}, 0.5));
  scene.box("block", soft, {-5, -3, -2.5}, {5, 3, 0}, 0.5, {0, 0, 0});
  scene.add("stop", Scene::rigid(hard, prescribed, {-1, 0, 0}, {0, 2, 0}, {7, 0, 0}),
            Scene::solid(OGIVE_SOLID_BOX, {7, 0, 0}, {2, 6, 4}, 0.5));
  scene.prepare();
  return scene;
}

}  // namespace

TEST(RigidBody, CutByASymmetryFaceMovesAsTheWholeOne) {
  Scene whole = struck(false, 1), half = struck(true, 1);
  double worst = 0;
  for (int i = 0; i < 20; ++i) {
    whole.steps(10);
    half.steps(10);
    for (int b = 0; b < 3; ++b) {
      const ogive_body_result w = whole.result({b}), h = half.result({b});
      EXPECT_NEAR(w.mass, 2 * h.mass, 1e-12 * w.mass);
      worst = std::max({worst, std::abs(w.velocity[0] - h.velocity[0]) / 40, std::abs(w.velocity[2] - h.velocity[2]) / 40,
                        std::abs(w.angular_velocity[1] - h.angular_velocity[1]) / 10});
    }
  }
  measured("difference", worst);
  measured("ball_velocity", whole.result({0}).velocity[2]);
  measured("ball_spin", whole.result({0}).angular_velocity[1]);
  EXPECT_GT(whole.result({0}).velocity[2], -35);
  EXPECT_LE(worst, 1e-10);
  EXPECT_NEAR(whole.ledger().total, 2 * half.ledger().total, 1e-9 * whole.ledger().total);
}

TEST(RigidBody, MovesToTheSameBitsWithAnyNumberOfThreadsAndOverARestart) {
  for (const std::int32_t method : {OGIVE_CONTACT_HUANG_SECOND, OGIVE_CONTACT_PAN_2008, OGIVE_CONTACT_BARDENHAGEN_2001}) {
    Scene one = struck(false, 1, method), two = struck(false, 2, method), first = struck(false, 1, method), second;
    one.steps(120);
    two.steps(120);
    expect_same_bits(one, two);
    first.steps(71);
    Store store;
    store.save(first);
    store.load(second);
    expect_same_bits(first, second);
    second.steps(49);
    expect_same_bits(one, second);
  }
}

TEST(RigidBodies, OfASaveThatIsCutByNoFaceAreRefused) {
  Scene scene;
  scene.grid(1, {-6, -6, -6}, {6, 6, 6});
  scene.add("ball", Scene::rigid(scene.material("steel", steel()), OGIVE_FORMULATION_RIGID_FREE, {0, 0, 0}),
            Scene::solid(OGIVE_SOLID_SPHERE, {0, 0, 0}, {2, 0, 0}, 0.5));
  scene.box("block", ogive_material_id{0}, {3, -1, -1}, {5, 1, 1}, 0.5, {0, 0, 0});
  scene.prepare();
  Store store;
  store.save(scene);
  const std::int32_t cut = -127;
  std::memcpy(store.arrays.at("model/bodies/0/cut").bytes.data(), &cut, sizeof cut);
  Scene other;
  try {
    store.load(other);
    FAIL() << "a body of 2^-127 images";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("cut must be 0 or 1, found -127"), std::string::npos) << error.what();
  }
}
