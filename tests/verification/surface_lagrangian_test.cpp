// Contact by the true surface of total Lagrangian bodies: momentum, energy, rebound, rolling, partial models, threads, restart.
#include <algorithm>
#include <numbers>

#include "store.hpp"

using namespace verification;

namespace {

constexpr std::int32_t by_surface = OGIVE_DETECTION_SURFACE;
const std::int32_t methods_with_normals[] = {
    OGIVE_CONTACT_HUANG_FIRST,      OGIVE_CONTACT_HUANG_SECOND,    OGIVE_CONTACT_YORK,    OGIVE_CONTACT_HU_CHEN,
    OGIVE_CONTACT_BARDENHAGEN_2000, OGIVE_CONTACT_BARDENHAGEN_2001, OGIVE_CONTACT_PAN_2008, OGIVE_CONTACT_PERSISTENT};

ogive_body_def lagrangian(ogive_material_id material, Vec3 velocity, Vec3 angular = {}, Vec3 about = {}) {
  ogive_body_def def = Scene::body(material, velocity, angular, about);
  def.formulation = OGIVE_FORMULATION_TOTAL_LAGRANGIAN;
  return def;
}

enum class Partner { Updated, TotalLagrangian, RigidFree, Wall };

// A total Lagrangian elastic ball of radius 3 that spins strikes a block, or a wall.
Scene strike(Partner partner, std::int32_t method, std::int32_t shape, double friction = 0.3,
             std::int32_t order = OGIVE_UPDATE_STRESS_FIRST) {
  Scene scene;
  scene.grid(1, {-12, -10, -12}, {12, 10, 8})
      .numerics(shape, 0.3, {}, 1, OGIVE_TRANSFER_FLIP, order, {}, 2, 1e9)
      .contact(method, by_surface, friction);
  const ogive_material_id metal = scene.material("metal", elastic(7.8e-3, 20e3, 0.3));
  const ogive_material_id soft = scene.material("soft", elastic(2.7e-3, 2e3, 0.3));
  scene.add("ball", lagrangian(metal, {10, 0, -40}, {0, 5, 0}, {1.5, 0.6, 3.1}),
            Scene::solid(OGIVE_SOLID_SPHERE, {1.5, 0.6, 3.1}, {3, 0, 0}, 0.5));
  const ogive_solid_def block = Scene::solid(OGIVE_SOLID_BOX, {0, 0, -2}, {12, 12, 4}, 0.5);
  if (partner == Partner::Updated) scene.add("block", Scene::body(soft, {0, 0, 0}), block);
  if (partner == Partner::TotalLagrangian) scene.add("block", lagrangian(soft, {0, 0, 0}), block);
  if (partner == Partner::RigidFree)
    scene.add("block", Scene::rigid(soft, OGIVE_FORMULATION_RIGID_FREE, {0, 0, 0}), block);
  if (partner == Partner::Wall) scene.wall({0, 0, 0}, {0, 0, 1}, friction, {}, method, by_surface);
  scene.prepare();
  return scene;
}

}  // namespace

TEST(SurfaceOfTotalLagrangianBodies, KeepsMomentumWithEveryMethodAndPartner) {
  const char* const names[] = {"updated", "total Lagrangian", "rigid", "wall"};
  for (const Partner partner : {Partner::Updated, Partner::TotalLagrangian, Partner::RigidFree, Partner::Wall})
    for (const std::int32_t shape : {OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE})
      for (const std::int32_t method : methods_with_normals) {
        Scene scene = strike(partner, method, shape);
        const ogive_ledger before = scene.ledger();
        scene.advance(0.04);
        const ogive_ledger after = scene.ledger();
        std::printf("%s, %s, %s\n", names[static_cast<int>(partner)], ogive_contact_method_name(method),
                    shape == OGIVE_SHAPE_LINEAR ? "trilinear" : "B-spline");
        const double miss = momentum_miss(before, after) / (before.mass * 40);
        measured("momentum", miss);
        measured("energy", after.residual_relative);
        measured("velocity", scene.result({0}).velocity[2]);
        EXPECT_LE(miss, 1e-13);  // measured 2e-14 and less
        // Measured -2e-4 to 1e-3: all that contact takes is booked.
        if (partner != Partner::Updated) {
          EXPECT_NEAR(after.residual_relative, 0, 2e-3);
        } else if (method == OGIVE_CONTACT_PERSISTENT) {
          EXPECT_NEAR(after.residual_relative, 0, 0.03);  // measured +0.022 in the middle of contact, 0.002 at its end
        }
      }
}

TEST(SurfaceOfTotalLagrangianBodies, BringsABallBackFromAWallWithItsEnergy) {
  for (const std::int32_t shape : {OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE}) {
    Scene scene;
    scene.grid(1, {-5, -5, -2}, {5, 5, 10})
        .numerics(shape, 0.3)
        .wall({0, 0, 0}, {0, 0, 1}, 0, {}, OGIVE_CONTACT_PERSISTENT, by_surface);
    scene.add("ball", lagrangian(scene.material("metal", elastic(7.8e-3, 20e3, 0.3)), {0, 0, -10}),
              Scene::solid(OGIVE_SOLID_SPHERE, {0, 0, 3.1}, {3, 0, 0}, 0.5));
    scene.prepare();
    const ogive_ledger before = scene.ledger();
    scene.advance(0.12);
    const ogive_ledger after = scene.ledger();
    measured("velocity", scene.result({0}).velocity[2]);
    measured("taken_by_contact", after.contact_dissipation / before.total);
    measured("energy", after.residual_relative);
    // Measured 9.74, 8.50; 9.87, 9.57 with half the cells; by the gap 6.4, 4.8.
    EXPECT_GT(scene.result({0}).velocity[2], shape == OGIVE_SHAPE_LINEAR ? 9.6 : 8.3);
    EXPECT_LT(after.contact_dissipation, 0.03 * before.total);  // measured 0.016, 0.026; 0.003, 0.013; by the gap 0.55, 0.63
    EXPECT_NEAR(after.residual_relative, 0, 5e-4);  // measured 2.3e-4, 2.4e-4
  }
}

namespace {

// A total Lagrangian sphere of radius 1.6 rolls from rest on a plane inclined by `angle`: its way over that of a rigid one.
double rolling(double angle, double friction, double cell, std::int32_t shape, bool slab) {
  const double g = 10, radius = 1.6, time = 0.8;
  Scene scene;
  scene.grid(cell, {-2.4, -2.4, -1.2}, {8, 2.4, 4.8})
      .numerics(shape, 0.4, {g * std::sin(angle), 0, -g * std::cos(angle)})
      .contact(OGIVE_CONTACT_PERSISTENT, by_surface, friction);
  const ogive_material_id stuff = scene.material("stuff", elastic(1, 1e5, 0.3));
  scene.add("ball", lagrangian(stuff, {0, 0, 0}), Scene::solid(OGIVE_SOLID_SPHERE, {0, 0, radius}, {radius, 0, 0}, 0.5 * cell));
  if (slab)
    scene.add("plane", Scene::rigid(stuff, OGIVE_FORMULATION_RIGID_PRESCRIBED, {0, 0, 0}),
              Scene::solid(OGIVE_SOLID_BOX, {2.8, 0, -0.4}, {10.4, 4.8, 0.8}, 0.5 * cell));
  else
    scene.wall({0, 0, 0}, {0, 0, 1}, friction, {}, OGIVE_CONTACT_PERSISTENT, by_surface);
  scene.prepare();
  const ogive_ledger before = scene.ledger();
  scene.advance(time);
  EXPECT_LE(momentum_miss(before, scene.ledger()), 1e-10 * before.mass);
  const bool slips = std::tan(angle) > friction * 3.5;
  const double acceleration = slips ? g * (std::sin(angle) - friction * std::cos(angle)) : g * std::sin(angle) / 1.4;
  const ogive_body_result result = scene.result({0});
  measured("height", result.centre[2] / radius - 1);
  measured("energy", scene.ledger().residual / scene.ledger().external_work);
  return result.centre[0] / (0.5 * acceleration * time * time) - 1;
}

}  // namespace

TEST(SurfaceOfTotalLagrangianBodies, RollsAndSlipsAsTheExactSolutionSays) {
  const double steep = std::numbers::pi / 3, flat = std::numbers::pi / 4;
  for (const std::int32_t shape : {OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE})
    for (const bool slab : {false, true}) {
      std::printf("%s, %s\n", shape == OGIVE_SHAPE_LINEAR ? "trilinear" : "B-spline", slab ? "slab" : "wall");
      const double slip = rolling(steep, 0.2, 0.4, shape, slab), stick = rolling(flat, 0.4, 0.4, shape, slab);
      measured("slip", slip);
      measured("stick", stick);
      EXPECT_NEAR(slip, 0, 0.002);  // measured -0.0002, +0.0003
      // Measured -0.0085 and -0.0033; +0.0058 and +0.0139 with half the cells. The ball gives way by 0.3 to 0.7 % of its radius.
      EXPECT_NEAR(stick, 0, 0.015);
    }
}

namespace {

// A total Lagrangian rod with an ogive nose, beside a rigid ball, strikes a block, before a wall; symmetric about y = 0.
Scene many(bool half, int threads, std::int32_t method, std::int32_t order = OGIVE_UPDATE_STRESS_FIRST,
           double distortion_limit = 10) {
  Scene scene;
  std::array<std::int32_t, 6> faces{};
  if (half) faces[2] = OGIVE_FACE_SYMMETRY;
  scene.grid(1, {-10, half ? 0.0 : -8.0, -8}, {10, 8, 12}, faces)
      .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4, {0, 0, -50}, threads, {}, order)
      .contact(method, by_surface, 0.3)
      .wall({0, 0, -4}, {0.2, 0, 1}, 0.2, {}, method, by_surface);
  const ogive_material_id metal = scene.material("metal", elastic(7.8e-3, 20e3, 0.3));
  const ogive_material_id soft = scene.material("soft", elastic(2.7e-3, 2e3, 0.3));
  ogive_solid_def rod = Scene::solid(OGIVE_SOLID_OGIVE_ROD, {-3.5, 0, 0.3}, {1.5, 7, 1.5}, 0.5);
  rod.axis[0] = 0.3;
  rod.axis[2] = -1;
  ogive_body_def def = lagrangian(metal, {6, 0, -40}, {0, 2, 0}, {-3.5, 0, 0.3});
  def.distortion_limit = distortion_limit;
  scene.add("rod", def, rod);
  scene.add("ball", Scene::rigid(metal, OGIVE_FORMULATION_RIGID_FREE, {10, 0, -40}, {0, 1, 0}, {2.5, 0, 3.1}),
            Scene::solid(OGIVE_SOLID_SPHERE, {2.5, 0, 3.1}, {3, 0, 0}, 0.5));
  scene.add("block", Scene::body(soft, {0, 0, 0}), Scene::solid(OGIVE_SOLID_BOX, {0, 0, -1.25}, {10, 6, 2.5}, 0.5));
  scene.add("plate", lagrangian(soft, {-15, 0, 0}), Scene::solid(OGIVE_SOLID_BOX, {6.3, 0, -0.5}, {1.5, 4, 3}, 0.5));
  scene.prepare();
  return scene;
}

}  // namespace

TEST(SurfaceOfTotalLagrangianBodies, OfAHalfModelIsThatOfTheWholeOne) {
  for (const std::int32_t method : {OGIVE_CONTACT_HUANG_FIRST, OGIVE_CONTACT_HUANG_SECOND, OGIVE_CONTACT_PERSISTENT}) {
    Scene whole = many(false, 1, method), half = many(true, 1, method);
    const ogive_ledger first = half.ledger();
    double worst = 0, miss = 0;
    for (int i = 0; i < 10; ++i) {
      whole.steps(20);
      half.steps(20);
      for (int b = 0; b < 4; ++b) {
        const ogive_body_result a = whole.result({b}), c = half.result({b});
        for (int axis = 0; axis < 3; axis += 2) worst = std::max(worst, std::abs(a.velocity[axis] - c.velocity[axis]));
      }
      miss = std::max(miss, momentum_miss(first, half.ledger()) / (first.mass * 40));
    }
    measured("difference", worst);
    measured("momentum", miss);
    measured("rod_velocity", whole.result({0}).velocity[2]);
    measured("energy", half.ledger().residual_relative);
    EXPECT_GT(whole.result({0}).velocity[2], -39);
    EXPECT_LE(worst, 1e-10);  // measured 1.1e-12
    EXPECT_LE(miss, 1e-13);   // measured 5.6e-15
    EXPECT_NEAR(whole.ledger().total, 2 * half.ledger().total, 1e-9 * whole.ledger().total);
    EXPECT_NEAR(whole.ledger().boundary_impulse[0], 2 * half.ledger().boundary_impulse[0], 1e-9);
  }
}

TEST(SurfaceOfTotalLagrangianBodies, MovesToTheSameBitsWithAnyNumberOfThreadsAndOverARestart) {
  const std::pair<std::int32_t, std::int32_t> cases[] = {{OGIVE_CONTACT_HUANG_SECOND, OGIVE_UPDATE_STRESS_FIRST},
                                                         {OGIVE_CONTACT_PERSISTENT, OGIVE_UPDATE_STRESS_FIRST},
                                                         {OGIVE_CONTACT_HUANG_SECOND, OGIVE_UPDATE_STRESS_LAST},
                                                         {OGIVE_CONTACT_PAN_2008, OGIVE_UPDATE_STRESS_FIRST}};
  for (const auto& [method, order] : cases) {
    const auto make = [method = method, order = order](int threads) { return many(true, threads, method, order); };
    expect_same_bits_with_threads_and_over_a_restart(make, 150, 91);
  }
}

// A body that is distorted too much goes on updated Lagrangian, its surface with it.
TEST(SurfaceOfTotalLagrangianBodies, GoesOnWithABodyThatIsDistorted) {
  Scene scene = many(true, 1, OGIVE_CONTACT_PERSISTENT, OGIVE_UPDATE_STRESS_FIRST, 1.001);
  const ogive_ledger before = scene.ledger();
  scene.steps(250);
  const ogive_ledger after = scene.ledger();
  EXPECT_LE(momentum_miss(before, after), 1e-13 * before.mass * 40);
  EXPECT_NEAR(after.mass, before.mass, 1e-14 * before.mass);
  measured("energy", after.residual_relative);
  measured("rod_velocity", scene.result({0}).velocity[2]);
}
