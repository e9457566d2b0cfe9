// What every contact method and every rule for normals must do, and what tells them apart.
#include <algorithm>
#include <ctime>
#include <tuple>

#include "scene.hpp"

using namespace verification;

namespace {

double momentum_drift(const ogive_ledger& before, const ogive_ledger& after, double scale) {
  double worst = 0;
  for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(after.momentum[c] - before.momentum[c]));
  return worst / scale;
}

std::string method_of(std::int32_t method) { return ogive_contact_method_name(method); }

// method, shape function (trilinear at shared nodes, B-spline with the gap rule), update order
using Choice = std::tuple<std::int32_t, std::int32_t, std::int32_t>;

class Methods : public testing::TestWithParam<Choice> {};

std::string name_of(const testing::TestParamInfo<Choice>& info) {
  const auto [method, shape, order] = info.param;
  const char* const orders[] = {"First", "Last", "LastAsIs"};
  const char* shapes[] = {"_linear_", "_bspline_", "_gimp_"};
  return method_of(method) + shapes[shape] + orders[order];
}

const auto all_methods = testing::Range(0, static_cast<int>(ogive_contact_method_count()));

// Two cubes of unequal density that meet obliquely. A pair rule, so that single_field has fields of its own as well.
struct Cubes {
  Scene scene;
  ogive_body_id a{}, b{};

  Cubes(std::int32_t method, std::int32_t shape, std::int32_t order, std::int32_t normal, int threads = 1,
        std::int32_t transfer = OGIVE_TRANSFER_AFFINE_FLIP, bool swapped = false) {
    const std::int32_t detection = shape == OGIVE_SHAPE_LINEAR ? OGIVE_DETECTION_SHARED_NODE : OGIVE_DETECTION_GAP;
    scene.grid(1, {-12, -8, -8}, {12, 8, 8})
        .numerics(shape, 0.4, {}, threads, transfer, order)
        .contact(OGIVE_CONTACT_HUANG_FIRST);
    const ogive_material_id light = scene.material("light", elastic(2.7e-3, 69e3, 0.3));
    const ogive_material_id heavy = scene.material("heavy", steel());
    const auto first = [&] { a = scene.box("a", light, {-4.2, -2, -2}, {-0.2, 2, 2}, 0.5, {30, 8, -3}); };
    if (!swapped) first();
    b = scene.box("b", heavy, {0.1, -1.7, -2.3}, {4.1, 2.3, 1.7}, 0.5, {-20, 1, 4});
    if (swapped) first();
    const ogive_contact_def def = Scene::contact_def(method, detection, 0.3, normal);
    scene.check(ogive_contact_set_pair(scene.get(), b, a, &def));
    scene.prepare();
  }
};

}  // namespace

TEST_P(Methods, KeepMomentumInAnObliqueCollision) {
  const auto [method, shape, order] = GetParam();
  Cubes cubes(method, shape, order, OGIVE_NORMAL_AVERAGE);
  const ogive_ledger before = cubes.scene.ledger();
  const double first = cubes.scene.result(cubes.a).momentum[0];
  const double scale = std::abs(first) + std::abs(cubes.scene.result(cubes.b).momentum[0]);
  cubes.scene.steps(order == OGIVE_UPDATE_STRESS_LAST_AS_IS ? 100 : 250);
  const ogive_ledger after = cubes.scene.ledger();
  const double exchanged = std::abs(cubes.scene.result(cubes.a).momentum[0] - first) / std::abs(first);
  measured("momentum_drift", momentum_drift(before, after, scale));
  measured("exchanged", exchanged);
  measured("residual", after.residual_relative);
  EXPECT_GT(exchanged, 0.4);
  EXPECT_LE(momentum_drift(before, after, scale), 1e-13);  // measured at most 2.4e-16
}

TEST_P(Methods, SayTheForceThatChangesTheMomentum) {
  const auto [method, shape, order] = GetParam();
  Cubes cubes(method, shape, order, OGIVE_NORMAL_AVERAGE);
  double worst = 0, largest = 0;
  Vec3 before{};
  for (int c = 0; c < 3; ++c) before[c] = cubes.scene.result(cubes.a).momentum[c];
  for (int i = 0; i < 60; ++i) {
    cubes.scene.steps(1);
    const ogive_body_result now = cubes.scene.result(cubes.a);
    const double dt = cubes.scene.progress().last_time_step;
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(now.momentum[c] - before[c] - now.contact_force[c] * dt));
      largest = std::max(largest, std::abs(now.contact_force[c] * dt));
      before[c] = now.momentum[c];
    }
  }
  measured("miss", worst / largest);
  EXPECT_GT(largest, 0);
  EXPECT_LE(worst, 1e-10 * largest);  // measured at most 1.2e-14
}

INSTANTIATE_TEST_SUITE_P(Contact, Methods,
                         testing::Combine(all_methods,
                                          testing::Values(OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE),
                                          testing::Values(OGIVE_UPDATE_STRESS_FIRST, OGIVE_UPDATE_STRESS_LAST)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(ContactGimp, Methods,
                         testing::Combine(all_methods, testing::Values(OGIVE_SHAPE_GIMP),
                                          testing::Values(OGIVE_UPDATE_STRESS_FIRST)),
                         name_of);
// With trilinear functions that order breaks down at once; see below.
INSTANTIATE_TEST_SUITE_P(ContactLastAsIs, Methods,
                         testing::Combine(all_methods, testing::Values(OGIVE_SHAPE_QUADRATIC_BSPLINE),
                                          testing::Values(OGIVE_UPDATE_STRESS_LAST_AS_IS)),
                         name_of);

TEST(UpdateOrder, StressLastAsItIsBreaksDownAtNodesWithNextToNoMassWhereTheOthersDoNot) {
  // Nodal velocities at the end of a step, force over mass, have no bound there; mapped anew from the particles they have.
  Cubes stable(OGIVE_CONTACT_HUANG_FIRST, OGIVE_SHAPE_LINEAR, OGIVE_UPDATE_STRESS_LAST, OGIVE_NORMAL_AVERAGE);
  stable.scene.steps(100);
  EXPECT_LT(stable.scene.ledger().maximum_speed_ever, 100);
  Cubes unstable(OGIVE_CONTACT_HUANG_FIRST, OGIVE_SHAPE_LINEAR, OGIVE_UPDATE_STRESS_LAST_AS_IS, OGIVE_NORMAL_AVERAGE);
  EXPECT_THROW(unstable.scene.steps(100), std::runtime_error);
}

namespace {

class Normals : public testing::TestWithParam<std::int32_t> {};

}  // namespace

TEST_P(Normals, KeepMomentumWhateverTheOrderOfTheBodies) {
  Cubes cubes(OGIVE_CONTACT_HUANG_SECOND, OGIVE_SHAPE_QUADRATIC_BSPLINE, 0, GetParam());
  Cubes swapped(OGIVE_CONTACT_HUANG_SECOND, OGIVE_SHAPE_QUADRATIC_BSPLINE, 0, GetParam(), 1, OGIVE_TRANSFER_AFFINE_FLIP,
                true);
  const ogive_ledger before = cubes.scene.ledger();
  const double first = cubes.scene.result(cubes.a).momentum[0];
  const double scale = std::abs(first) + std::abs(cubes.scene.result(cubes.b).momentum[0]);
  cubes.scene.steps(200);
  swapped.scene.steps(200);
  const double exchanged = std::abs(cubes.scene.result(cubes.a).momentum[0] - first) / std::abs(first);
  measured("momentum_drift", momentum_drift(before, cubes.scene.ledger(), scale));
  measured("exchanged", exchanged);
  measured("residual", cubes.scene.ledger().residual_relative);
  EXPECT_GT(exchanged, 0.5);
  EXPECT_LE(momentum_drift(before, cubes.scene.ledger(), scale), 1e-13);
  // The master is the first of the pair: that one is another body then.
  if (GetParam() == OGIVE_NORMAL_MASTER) return;
  const std::vector<double> v = cubes.scene.field(cubes.a, "velocity"), w = swapped.scene.field(swapped.a, "velocity");
  double worst = 0;
  for (std::size_t i = 0; i < v.size(); ++i) worst = std::max(worst, std::abs(v[i] - w[i]));
  measured("difference", worst / 50);
  EXPECT_LE(worst / 50, 1e-10);
}

TEST_P(Normals, LieInASymmetryPlaneSoThatAHalfModelIsTheFullOne) {
  const auto build = [&](bool half) {
    Scene scene;
    std::array<std::int32_t, 6> faces{};
    if (half) faces[2] = OGIVE_FACE_SYMMETRY;
    scene.grid(1, {-8, half ? 0.0 : -6.0, -8}, {8, 6, 8}, faces)
        .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4)
        .contact(OGIVE_CONTACT_HUANG_SECOND, OGIVE_DETECTION_GAP, 0.2, GetParam());
    const ogive_material_id metal = scene.material("metal", elastic(2.7e-3, 69e3, 0.3));
    scene.add("ball", Scene::body(metal, {3, 0, -40}), Scene::solid(OGIVE_SOLID_SPHERE, {0.4, 0, 3.1}, {3, 0, 0}, 0.5));
    scene.box("block", metal, {-4, -3, -4}, {4, 3, 0}, 0.5, {0, 0, 0});
    scene.prepare();
    return scene;
  };
  Scene whole = build(false), half = build(true);
  whole.steps(80);
  half.steps(80);
  EXPECT_LT(whole.result({0}).velocity[2], 0);
  EXPECT_GT(whole.result({0}).velocity[2], -39);
  double worst = 0;
  for (int c = 0; c < 3; ++c)
    worst = std::max(worst, std::abs(whole.result({0}).velocity[c] - half.result({0}).velocity[c] * (c == 1 ? 0 : 1)));
  measured("difference", worst / 40);
  EXPECT_LE(worst / 40, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Contact, Normals, testing::Range(0, static_cast<int>(ogive_contact_normal_count())),
                         [](const auto& info) { return std::string(ogive_contact_normal_name(info.param)); });

TEST(Contact, SingleFieldAsARuleOfAPairIsTheSingleFieldToRoundOff) {
  for (const std::int32_t order :
       {OGIVE_UPDATE_STRESS_FIRST, OGIVE_UPDATE_STRESS_LAST, OGIVE_UPDATE_STRESS_LAST_AS_IS})
    for (const std::int32_t transfer : {OGIVE_TRANSFER_FLIP, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_TRANSFER_APIC}) {
      Cubes pair(OGIVE_CONTACT_SINGLE_FIELD, OGIVE_SHAPE_QUADRATIC_BSPLINE, order, OGIVE_NORMAL_AVERAGE, 1, transfer);
      Scene one;
      one.grid(1, {-12, -8, -8}, {12, 8, 8})
          .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4, {}, 1, transfer, order)
          .contact(OGIVE_CONTACT_SINGLE_FIELD);
      one.box("a", one.material("light", elastic(2.7e-3, 69e3, 0.3)), {-4.2, -2, -2}, {-0.2, 2, 2}, 0.5, {30, 8, -3});
      one.box("b", one.material("heavy", steel()), {0.1, -1.7, -2.3}, {4.1, 2.3, 1.7}, 0.5, {-20, 1, 4});
      one.prepare();
      const int count = order == OGIVE_UPDATE_STRESS_LAST_AS_IS ? 40 : 100;
      one.steps(count);
      pair.scene.steps(count);
      double worst = 0;
      for (int body = 0; body < 2; ++body) {
        const std::vector<double> v = one.field({body}, "velocity"), w = pair.scene.field({body}, "velocity");
        for (std::size_t i = 0; i < v.size(); ++i) worst = std::max(worst, std::abs(v[i] - w[i]) / 50);
      }
      measured("difference_order_" + std::to_string(order) + "_transfer_" + std::to_string(transfer), worst);
      EXPECT_LE(worst, 1e-9);
      EXPECT_NEAR(one.ledger().transfer_dissipation, pair.scene.ledger().transfer_dissipation,
                  1e-9 * one.ledger().initial_total);
    }
}

namespace {

// Two bars along x meet head on with equal and opposite velocities. Relative velocity of their centres afterwards over that
// before, with what the ledger cannot account for.
struct Rebound {
  double restitution, residual;
};

Rebound bars(std::int32_t method, double friction = 0) {
  Scene scene;
  scene.grid(1, {-16, -3, -3}, {16, 3, 3}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4).contact(method, OGIVE_DETECTION_GAP, friction);
  const ogive_material_id metal = scene.material("metal", elastic(2.7e-3, 69e3, 0.0));
  const ogive_body_id a = scene.box("a", metal, {-10, -2, -2}, {-0.05, 2, 2}, 0.5, {5, 0, 0});
  const ogive_body_id b = scene.box("b", metal, {0.05, -2, -2}, {10, 2, 2}, 0.5, {-5, 0, 0});
  scene.prepare();
  scene.advance(0.03);  // a wave needs 0.004 to and fro
  return {(scene.result(b).velocity[0] - scene.result(a).velocity[0]) / 10, scene.ledger().residual_relative};
}

}  // namespace

TEST(Contact, BarsThatMeetReboundButForTheMethodsThatHoldOnToThem) {
  for (std::int32_t method = 1; method < ogive_contact_method_count(); ++method) {
    const Rebound rebound = bars(method);
    measured("restitution_" + method_of(method), rebound.restitution);
    measured("residual_" + method_of(method), rebound.residual);
    if (method == OGIVE_CONTACT_HU_CHEN || method == OGIVE_CONTACT_BARDENHAGEN_2001) {
      // Measured -0.62 and 0.25: a common normal velocity until the bodies no longer share nodes, or feel a traction that
      // pulls, holds them as they part.
      EXPECT_LT(rebound.restitution, 0.3) << method_of(method);
    } else {
      EXPECT_GT(rebound.restitution, 0.85) << method_of(method);  // measured 0.860 .. 0.908
      EXPECT_LT(std::abs(rebound.residual), 0.09) << method_of(method);  // measured -0.084 .. +0.009
      if (method == OGIVE_CONTACT_PERSISTENT) {
        EXPECT_LT(std::abs(rebound.residual), 0.002);  // measured 0.0003
      }
    }
  }
}

TEST(Contact, ManyBodiesCostWhatTheNodesCostWhereTheyMeet) {
  // Cubes of 8 particles in four rows, each beside its neighbours. Work grows with the bodies, not with their square.
  const auto seconds = [](int count) {
    const double pitch = 1.1;
    Scene scene;
    scene.grid(1, {-2, -2, -2}, {pitch * count + 2, 16 + 2, 4}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4);
    const ogive_material_id metal = scene.material("metal", elastic(2.7e-3, 69e3, 0.3));
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < 4; ++j) {
        const std::string name = "b" + std::to_string(4 * i + j);
        scene.box(name.c_str(), metal, {pitch * i, 4.0 * j, 0}, {pitch * i + 1, 4.0 * j + 1, 1}, 0.5, {0, 0, 0});
      }
    scene.prepare();
    scene.steps(3);
    const std::clock_t start = std::clock();
    scene.steps(20);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  const double some = seconds(50), many = seconds(400);
  measured("seconds_200_bodies", some);
  measured("seconds_1600_bodies", many);
  // Measured 15 times for 8 times the bodies, whose grid no longer fits the cache; by the square it would be 64.
  EXPECT_LE(many, 3 * 8 * some);
}
