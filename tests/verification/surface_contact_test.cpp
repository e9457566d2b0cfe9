// Contact by the true surface: momentum, rolling, no leak, friction, all methods, deformable owners, partial models, threads,
// restart.
#include <algorithm>
#include <numbers>

#include "store.hpp"

using namespace verification;

namespace {

constexpr std::int32_t free_body = OGIVE_FORMULATION_RIGID_FREE, prescribed = OGIVE_FORMULATION_RIGID_PRESCRIBED;
constexpr std::int32_t by_surface = OGIVE_DETECTION_SURFACE;

// A rigid sphere or cylinder of radius 1.6 from rest on a wall or on a rigid slab inclined by `angle`: its way over the exact
// one. Huang et al. 2010, Eq. (36).
double rolling(double angle, double friction, double cell, bool sphere, bool slab) {
  const double g = 10, radius = 1.6;
  Scene scene;
  scene.grid(cell, {-2.4, -2.4, -1.2}, {12, 2.4, 4.8})
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4, {g * std::sin(angle), 0, -g * std::cos(angle)}, 1, {},
                OGIVE_UPDATE_STRESS_FIRST, 5e-3)
      .contact(OGIVE_CONTACT_HUANG_SECOND, by_surface, friction);
  const ogive_material_id stuff = scene.material("stuff", elastic(1, 1e3, 0.3));
  ogive_solid_def solid = Scene::solid(sphere ? OGIVE_SOLID_SPHERE : OGIVE_SOLID_CYLINDER, {0, 0, radius},
                                       {radius, sphere ? 0 : 1.6, 0}, 0.5 * cell);
  const double axis[3] = {0, sphere ? 0.0 : 1.0, sphere ? 1.0 : 0.0};
  std::copy_n(axis, 3, solid.axis);
  const ogive_body_id body = scene.add("body", Scene::rigid(stuff, free_body, {0, 0, 0}), solid);
  if (slab)
    scene.add("plane", Scene::rigid(stuff, prescribed, {0, 0, 0}),
              Scene::solid(OGIVE_SOLID_BOX, {4.8, 0, -0.4}, {14.4, 4.8, 0.8}, 0.5 * cell));
  else
    scene.wall({0, 0, 0}, {0, 0, 1}, friction, {}, OGIVE_CONTACT_HUANG_SECOND, by_surface);
  scene.prepare();
  const ogive_ledger before = scene.ledger();
  scene.advance(1.2);
  const ogive_ledger after = scene.ledger();
  EXPECT_LE(momentum_miss(before, after), 1e-10 * after.mass);
  const ogive_body_result result = scene.result(body);
  const double part = sphere ? 0.4 : 0.5;
  const bool slips = std::tan(angle) > friction * (1 + 1 / part);
  const double acceleration =
      slips ? g * (std::sin(angle) - friction * std::cos(angle)) : g * std::sin(angle) / (1 + part);
  measured("height", result.centre[2] / radius - 1);
  measured("spin", result.angular_velocity[1] * radius / result.velocity[0]);
  measured("energy", after.residual / after.external_work);
  return result.centre[0] / (0.5 * acceleration * 1.2 * 1.2);
}

}  // namespace

TEST(SurfaceContact, RigidSpheresAndCylindersRollAndSlipAsTheExactSolutionSays) {
  const double steep = std::numbers::pi / 3, flat = std::numbers::pi / 4;
  for (const bool sphere : {true, false})
    for (const bool slab : {false, true}) {
      std::printf("%s on a %s\n", sphere ? "sphere" : "cylinder", slab ? "slab" : "wall");
      const double slip = rolling(steep, 0.2, 0.4, sphere, slab), stick = rolling(flat, 0.4, 0.4, sphere, slab),
                   fine = rolling(flat, 0.4, 0.2, sphere, slab);
      measured("slip", slip - 1);
      measured("stick", stick - 1);
      measured("stick_fine", fine - 1);
      // Measured +0.0042 (a time step in 240: velocity is ahead of place), -0.0005 and +0.0026 (sphere; its particles' inertia
      // is 1.6 and 0.4 % too large, which makes -0.0045 and -0.0012), -0.0067 and +0.0006 (cylinder). At the nodes' smeared
      // surfaces: -0.040, -0.025.
      EXPECT_NEAR(slip, 1, 0.006);
      EXPECT_NEAR(stick, 1, 0.008);
      EXPECT_NEAR(fine, 1, 0.004);
    }
}

namespace {

const std::int32_t methods_with_normals[] = {
    OGIVE_CONTACT_HUANG_FIRST,      OGIVE_CONTACT_HUANG_SECOND,    OGIVE_CONTACT_YORK,    OGIVE_CONTACT_HU_CHEN,
    OGIVE_CONTACT_BARDENHAGEN_2000, OGIVE_CONTACT_BARDENHAGEN_2001, OGIVE_CONTACT_PAN_2008, OGIVE_CONTACT_PERSISTENT};

// A free rigid ball of radius 3 that spins strikes an elastic block beside its middle, with friction.
struct Strike {
  Scene scene;
  ogive_body_id ball{}, block{};

  // Least distance of the block's particles from the ball's surface, over the radius.
  double depth() const {
    const ogive_body_result result = scene.result(ball);
    const std::vector<double> x = scene.field(block, "position");
    double least = INFINITY;
    for (std::size_t i = 0; i < x.size(); i += 3)
      least = std::min(least, std::hypot(x[i] - result.centre[0], x[i + 1] - result.centre[1], x[i + 2] - result.centre[2]));
    return least - 3;
  }
};

Strike strike(std::int32_t method, std::int32_t shape, std::int32_t order = OGIVE_UPDATE_STRESS_FIRST,
              std::optional<std::int32_t> transfer = {}) {
  Strike made;
  made.scene.grid(1, {-12, -10, -12}, {12, 10, 8})
      .numerics(shape, 0.3, {}, 1, transfer, order)
      .contact(method, by_surface, 0.3);
  const ogive_material_id hard = made.scene.material("steel", steel());
  const ogive_material_id soft = made.scene.material("soft", elastic(2.7e-3, 2e3, 0.3));
  made.ball = made.scene.add("ball", Scene::rigid(hard, free_body, {10, 0, -40}, {0, 5, 0}, {1.5, 0.6, 3.1}),
                             Scene::solid(OGIVE_SOLID_SPHERE, {1.5, 0.6, 3.1}, {3, 0, 0}, 0.5));
  made.block = made.scene.box("block", soft, {-6, -6, -4}, {6, 6, 0}, 0.5, {0, 0, 0});
  made.scene.prepare();
  return made;
}

}  // namespace

TEST(SurfaceContact, OfARigidBallKeepsMomentumWithEveryMethodAndLetsNothingThrough) {
  for (const std::int32_t shape : {OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE})
    for (const std::int32_t method : methods_with_normals) {
      Strike made = strike(method, shape);
      const ogive_ledger before = made.scene.ledger();
      double worst = 0, deepest = INFINITY;
      for (int i = 0; i < 5; ++i) {
        made.scene.advance(0.02 * (i + 1));
        worst = std::max(worst, momentum_miss(before, made.scene.ledger()) / (before.mass * 40));
        deepest = std::min(deepest, made.depth());
      }
      std::printf("%s, %s\n", ogive_contact_method_name(method), shape == OGIVE_SHAPE_LINEAR ? "trilinear" : "B-spline");
      measured("momentum", worst);
      measured("least_distance", deepest);
      measured("energy", made.scene.ledger().residual_relative);
      measured("velocity", made.scene.result(made.ball).velocity[2]);
      EXPECT_LE(worst, 1e-13);    // measured 2e-15
      EXPECT_GT(deepest, 0.2);    // measured 0.222 to 0.243: particles keep their half size of 0.25 but for a tenth of it
      EXPECT_GT(made.scene.result(made.ball).velocity[2], -35);
    }
}

TEST(SurfaceContact, OfARigidBallKeepsAngularMomentumButForTheCoupleThatIsBooked) {
  // With APIC and B-splines the block itself keeps its angular momentum.
  for (const std::int32_t method : {OGIVE_CONTACT_HUANG_FIRST, OGIVE_CONTACT_HUANG_SECOND}) {
    Strike made = strike(method, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_UPDATE_STRESS_FIRST, OGIVE_TRANSFER_APIC);
    const ogive_ledger before = made.scene.ledger();
    made.scene.advance(0.1);
    const ogive_ledger after = made.scene.ledger();
    double worst = 0, couple = 0;
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(after.angular_momentum[c] - after.contact_couple[c] - before.angular_momentum[c]));
      couple = std::max(couple, std::abs(after.contact_couple[c]));
    }
    measured("angular_momentum", worst / (before.mass * 40 * 5));
    measured("couple", couple / (before.mass * 40 * 5));
    EXPECT_LE(worst, 1e-12 * before.mass * 40 * 5);
    EXPECT_GT(couple, 1e-6 * before.mass * 40 * 5);  // friction acts a particle's half size beside its centre
  }
}

namespace {

// The surface of a box as triangles, each face divided n (even) times along its edges.
void set_box_surface(const Scene& scene, ogive_body_id body, Vec3 lower, Vec3 upper, int n) {
  std::map<std::array<int, 3>, std::int32_t> number;
  std::vector<double> xyz;
  std::vector<std::int32_t> corners;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [found, fresh] = number.try_emplace(at, static_cast<std::int32_t>(number.size()));
    if (fresh)
      for (int c = 0; c < 3; ++c) xyz.push_back(lower[c] + (upper[c] - lower[c]) * at[c] / n);
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto place = [&](int a, int b) {
            std::array<int, 3> at{};
            at[axis] = side * n;
            at[(axis + 1) % 3] = i + a;
            at[(axis + 2) % 3] = j + b;
            return vertex(at);
          };
          const std::int32_t a = place(0, 0), b = place(1, 0), c = place(1, 1), d = place(0, 1);
          // The diagonals are mirrored with the rest.
          std::array<std::int32_t, 6> pair = {a, b, c, a, c, d};
          if ((2 * i < n) != (2 * j < n)) pair = {a, b, d, b, c, d};
          if (side == 0) std::swap(pair[0], pair[1]), std::swap(pair[3], pair[4]);
          corners.insert(corners.end(), pair.begin(), pair.end());
        }
  scene.check(ogive_body_set_surface(scene.get(), body, static_cast<std::int64_t>(xyz.size() / 3), xyz.data(),
                                     static_cast<std::int64_t>(corners.size() / 3), corners.data()));
}

// Two elastic blocks meet obliquely: the upper one carries its surface.
struct Blocks {
  Scene scene;
  ogive_body_id upper{}, lower{};
};

Blocks blocks(std::int32_t method, std::int32_t detection, std::int32_t shape, double friction = 0.2,
              std::int32_t order = OGIVE_UPDATE_STRESS_FIRST, std::optional<std::int32_t> transfer = {}, int threads = 1,
              bool half = false) {
  Blocks made;
  std::array<std::int32_t, 6> faces{};
  if (half) faces[2] = OGIVE_FACE_SYMMETRY;
  made.scene.grid(1, {-8, half ? 0.0 : -8.0, -10}, {8, 8, 10}, faces)
      .numerics(shape, 0.3, {}, threads, transfer, order)
      .contact(method, detection, friction, OGIVE_NORMAL_AVERAGE, 0.1);
  const ogive_material_id metal = made.scene.material("metal", elastic(2.7e-3, 7e3, 0.3));
  made.upper = made.scene.box("upper", metal, {-2, -2, 0.02}, {2, 2, 4.02}, 0.5, {4, 0, -20});
  made.lower = made.scene.box("lower", metal, {-3, -3, -4}, {3, 3, 0}, 0.5, {0, 0, 20});
  set_box_surface(made.scene, made.upper, {-2, -2, 0.02}, {2, 2, 4.02}, 8);
  made.scene.prepare();
  return made;
}

double difference(const Scene& a, const Scene& b, int bodies) {
  double worst = 0;
  for (int i = 0; i < bodies; ++i) {
    const ogive_body_result first = a.result({i}), second = b.result({i});
    for (int c = 0; c < 3; c += 2) worst = std::max(worst, std::abs(first.velocity[c] - second.velocity[c]));
    worst = std::max(worst, std::abs(first.angular_velocity[1] - second.angular_velocity[1]));
  }
  return worst;
}

// A rigid ball and a rod with an ogive nose strike a block that carries its surface, before a wall; symmetric about y = 0.
Scene many(bool half, int threads, std::int32_t method, std::int32_t order = OGIVE_UPDATE_STRESS_FIRST) {
  Scene scene;
  std::array<std::int32_t, 6> faces{};
  if (half) faces[2] = OGIVE_FACE_SYMMETRY;
  scene.grid(1, {-10, half ? 0.0 : -8.0, -8}, {10, 8, 12}, faces)
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4, {0, 0, -50}, threads, {}, order)
      .contact(method, by_surface, 0.3)
      .wall({0, 0, -4}, {0.2, 0, 1}, 0.2, {}, method, by_surface);
  const ogive_material_id hard = scene.material("steel", steel());
  const ogive_material_id soft = scene.material("soft", elastic(2.7e-3, 2e3, 0.3));
  scene.add("ball", Scene::rigid(hard, free_body, {10, 0, -40}, {0, 1, 0}, {1.5, 0, 3.1}),
            Scene::solid(OGIVE_SOLID_SPHERE, {1.5, 0, 3.1}, {3, 0, 0}, 0.5));
  const ogive_body_id block = scene.box("block", soft, {-5, -3, -2.5}, {5, 3, 0}, 0.5, {0, 0, 0});
  set_box_surface(scene, block, {-5, -3, -2.5}, {5, 3, 0}, 8);
  ogive_solid_def rod = Scene::solid(OGIVE_SOLID_OGIVE_ROD, {-3.5, 0, 0.3}, {1.2, 6, 1.5}, 0.4);
  rod.axis[0] = 0.3;
  rod.axis[2] = -1;
  scene.add("rod", Scene::rigid(hard, prescribed, {6, 0, -20}, {0, 2, 0}, {-3.5, 0, 0.3}), rod);
  scene.box("plate", soft, {5.6, -2, -2}, {7, 2, 1}, 0.5, {-15, 0, 0});
  scene.prepare();
  return scene;
}

}  // namespace

TEST(SurfaceContact, OfElasticBlocksKeepsMomentumAndPartsThemAsGapDetectionDoes) {
  for (const std::int32_t method : methods_with_normals) {
    Blocks made = blocks(method, by_surface, OGIVE_SHAPE_QUADRATIC_BSPLINE);
    const ogive_ledger before = made.scene.ledger();
    made.scene.advance(0.06);
    const ogive_ledger after = made.scene.ledger();
    Blocks other = blocks(method, OGIVE_DETECTION_GAP, OGIVE_SHAPE_QUADRATIC_BSPLINE);
    other.scene.advance(0.06);
    std::printf("%s\n", ogive_contact_method_name(method));
    const double miss = momentum_miss(before, after) / (before.mass * 20);
    measured("momentum", miss);
    measured("upper", made.scene.result(made.upper).velocity[2]);
    measured("upper_by_gap", other.scene.result(other.upper).velocity[2]);
    measured("energy", after.residual_relative);
    measured("energy_by_gap", other.scene.ledger().residual_relative);
    EXPECT_LE(miss, 1e-13);  // measured 1.7e-15
    if (method > OGIVE_CONTACT_HUANG_SECOND) continue;
    EXPECT_GT(made.scene.result(made.upper).velocity[2], 21);  // measured 22.9 and 23.7; by the gap 27.2 and 27.8
    EXPECT_LT(made.scene.ledger().residual_relative, 0.01);    // measured -0.107 and -0.053; by the gap -0.038 and +0.051
  }
}

TEST(SurfaceContact, OfAnElasticBlockAndAWallTurnsItBack) {
  for (const std::int32_t shape : {OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE})
    for (const std::int32_t order : {OGIVE_UPDATE_STRESS_FIRST, OGIVE_UPDATE_STRESS_LAST})
      for (const std::int32_t method : {OGIVE_CONTACT_HUANG_FIRST, OGIVE_CONTACT_HUANG_SECOND, OGIVE_CONTACT_BARDENHAGEN_2001}) {
        if (order == OGIVE_UPDATE_STRESS_LAST && method == OGIVE_CONTACT_BARDENHAGEN_2001) continue;
        Scene scene;
        scene.grid(1, {-6, -6, -3}, {6, 6, 16})
            .numerics(shape, 0.4, {}, 1, {}, order)
            .wall({0, 0, 0}, {0, 0, 2}, 0, {}, method, by_surface);
        scene.box("block", scene.material("metal", elastic(2.7e-3, 69e3, 0.3)), {-2, -2, 0.2}, {2, 2, 6.2}, 0.5, {0, 0, -20});
        scene.prepare();
        const ogive_ledger before = scene.ledger();
        scene.advance(0.06);
        EXPECT_LE(momentum_miss(before, scene.ledger()), 1e-12 * before.mass * 20);
        std::printf("%s, shape %d, order %d\n", ogive_contact_method_name(method), shape, order);
        measured("speed", scene.result({0}).velocity[2]);
        measured("energy", scene.ledger().residual_relative);
        EXPECT_NEAR(scene.result({0}).velocity[2], 15, 0.8);  // measured 14.6 to 15.4; by the gap 12.5 to 18.8
        EXPECT_NEAR(scene.ledger().residual_relative, -0.12, 0.06);  // measured -0.164 to -0.076; by the gap -0.08 to +0.20
      }
}

// What the first phase keeps from particles, those that take the grid's velocity see: the mirror's share of it is booked too.
TEST(SurfaceContact, BesideAMirrorKeepsMomentumWhateverParticlesTakeOfTheGrid) {
  for (const std::int32_t shape : {OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE})
    for (const std::int32_t transfer : {OGIVE_TRANSFER_APIC, OGIVE_TRANSFER_XPIC, OGIVE_TRANSFER_AFFINE_FLIP})
      for (const std::int32_t method : {OGIVE_CONTACT_PERSISTENT, OGIVE_CONTACT_YORK, OGIVE_CONTACT_HUANG_SECOND}) {
        Scene scene;
        scene.grid(1, {-8, -8, 0}, {8, 8, 10}, {0, 0, 0, 0, OGIVE_FACE_SYMMETRY, 0}).numerics(shape, 0.3, {}, 1, transfer)
            .contact(method, by_surface, 0.2);
        const ogive_material_id metal = scene.material("metal", elastic(2.7e-3, 7e3, 0.3));
        const ogive_body_id block = scene.box("block", metal, {-2, -2, 1.02}, {2, 2, 3.02}, 0.5, {4, 0, -20});
        scene.box("plate", metal, {-4, -4, 0}, {4, 4, 1}, 0.5, {0, 0, 0});
        set_box_surface(scene, block, {-2, -2, 1.02}, {2, 2, 3.02}, 8);
        scene.prepare();
        const ogive_ledger before = scene.ledger();
        scene.steps(80);
        const double miss = momentum_miss(before, scene.ledger()) / (before.mass * 20);
        measured("momentum_miss", miss);  // 1e-14; 0.01 to 0.05 were missing where the mirror's share was not booked
        EXPECT_LT(miss, 1e-12);
        EXPECT_GT(scene.ledger().momentum[2], before.momentum[2] + 0.1 * before.mass);
      }
}

TEST(SurfaceContact, OfAHalfModelIsThatOfTheWholeOne) {
  for (const std::int32_t method : {OGIVE_CONTACT_HUANG_FIRST, OGIVE_CONTACT_HUANG_SECOND}) {
    Scene whole = many(false, 1, method), half = many(true, 1, method);
    double worst = 0;
    for (int i = 0; i < 10; ++i) {
      whole.steps(15);
      half.steps(15);
      worst = std::max(worst, difference(whole, half, 4));
    }
    measured("difference", worst);
    measured("ball_velocity", whole.result({0}).velocity[2]);
    EXPECT_GT(whole.result({0}).velocity[2], -39);
    EXPECT_LE(worst, 1e-10);  // measured 8e-13
    EXPECT_NEAR(whole.ledger().total, 2 * half.ledger().total, 1e-9 * whole.ledger().total);
    EXPECT_NEAR(whole.ledger().boundary_impulse[0], 2 * half.ledger().boundary_impulse[0], 1e-9);
  }
}

TEST(SurfaceContact, MovesToTheSameBitsWithAnyNumberOfThreadsAndOverARestart) {
  const std::pair<std::int32_t, std::int32_t> cases[] = {{OGIVE_CONTACT_HUANG_SECOND, OGIVE_UPDATE_STRESS_FIRST},
                                                         {OGIVE_CONTACT_HUANG_SECOND, OGIVE_UPDATE_STRESS_LAST},
                                                         {OGIVE_CONTACT_PAN_2008, OGIVE_UPDATE_STRESS_FIRST},
                                                         {OGIVE_CONTACT_BARDENHAGEN_2001, OGIVE_UPDATE_STRESS_FIRST}};
  for (const auto& [method, order] : cases) {
    const auto make = [method = method, order = order](int threads) { return many(true, threads, method, order); };
    expect_same_bits_with_threads_and_over_a_restart(make, 90, 51);
  }
}

TEST(SurfaceContact, IsRefusedWhereNoBodyOfAPairHasASurface) {
  Scene scene;
  scene.grid(1, {-6, -6, -6}, {6, 6, 6}).contact(OGIVE_CONTACT_HUANG_SECOND, by_surface);
  const ogive_body_def def = Scene::body(scene.material("metal", steel()), {0, 0, 0});
  const double volume = 0.1;
  for (const char* name : {"upper", "lower"}) {
    const double place[] = {0, 0, name[0] == 'u' ? 2.0 : -2.0};
    ogive_body_id id{};
    scene.check(ogive_body_add_particles(scene.get(), name, &def, 1, place, &volume, &id));
  }
  try {
    scene.prepare();
    FAIL() << "bodies given by particles alone have no surface";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("\"upper\" or \"lower\""), std::string::npos) << error.what();
  }
}
