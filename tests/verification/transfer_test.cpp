// How velocity travels between particles and grid: linear fields, angular momentum, the ledger, and stress first or last.
#include <algorithm>
#include <cmath>

#include "scene.hpp"

using namespace verification;

namespace {

struct Scheme {
  const char* name;
  std::int32_t shape, transfer, order;
};

std::string name_of(const testing::TestParamInfo<Scheme>& info) { return info.param.name; }

Vec3 angular_momentum(const Scene& scene, ogive_body_id body, double cell, bool affine) {
  const std::vector<double> x = scene.field(body, "position"), v = scene.field(body, "velocity"),
                            m = scene.field(body, "mass");
  const std::vector<double> C = affine ? scene.field(body, "affine_velocity") : std::vector<double>(9 * m.size());
  Vec3 sum{};
  for (std::size_t p = 0; p < m.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      const int d = (c + 1) % 3, e = (c + 2) % 3;
      sum[c] += m[p] * (x[3 * p + d] * v[3 * p + e] - x[3 * p + e] * v[3 * p + d]);
      // The particle's own spin: second moment h^2/4 along each axis.
      sum[c] += m[p] * 0.25 * cell * cell * (C[9 * p + 3 * e + d] - C[9 * p + 3 * d + e]);
    }
  return sum;
}

}  // namespace

class Affine : public testing::TestWithParam<Scheme> {};

TEST_P(Affine, ARotatingCloudOfDustKeepsItsAngularMomentumAndFliesOn) {
  // So soft that no stress matters: only the transfer acts.
  Scene scene;
  scene.grid(1, {-10, -10, -10}, {10, 10, 10})
      .numerics(GetParam().shape, 0.5, {}, 1, GetParam().transfer, GetParam().order);
  const Vec3 spin = {1, -2, 3};
  const ogive_material_id dust = scene.material("dust", elastic(2.7e-3, 1e-20, 0.2));
  const ogive_body_id body = scene.add("cloud", Scene::body(dust, {5, 0, -3}, spin, {0.3, 0, 0}),
                                       Scene::solid(OGIVE_SOLID_BOX, {0.2, 0.1, -0.3}, {5, 4, 3}, 0.5));
  scene.prepare();
  const std::vector<double> v0 = scene.field(body, "velocity");
  const Vec3 before = angular_momentum(scene, body, 1, true);
  const double kinetic = scene.ledger().kinetic;
  double fastest = 0, scale = 0;
  for (const double v : v0) fastest = std::max(fastest, std::abs(v));
  for (const double l : before) scale = std::max(scale, std::abs(l));
  for (int i = 0; i < 10; ++i) scene.step(1e-3);
  const std::vector<double> v1 = scene.field(body, "velocity");
  double changed = 0;
  for (std::size_t i = 0; i < v0.size(); ++i) changed = std::max(changed, std::abs(v1[i] - v0[i]));
  const Vec3 after = angular_momentum(scene, body, 1, true);
  double turned = 0;
  for (int c = 0; c < 3; ++c) turned = std::max(turned, std::abs(after[c] - before[c]));
  measured("velocity_change", changed / fastest);
  measured("angular_momentum_change", turned / scale);
  measured("kinetic_change", scene.ledger().kinetic / kinetic - 1);
  // APIC keeps angular momentum by construction; affine FLIP lets the spin of a cloud that disperses go (1.5e-4).
  EXPECT_LE(turned, (GetParam().transfer == OGIVE_TRANSFER_APIC ? 1e-13 : 3e-4) * scale);  // APIC: measured 1.1e-14
  if (GetParam().transfer == OGIVE_TRANSFER_AFFINE_FLIP) {
    EXPECT_LE(changed, 1e-13 * fastest);  // no force, no increment
  }
  EXPECT_LE(std::abs(scene.ledger().residual_relative), 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Transfer, Affine,
                         testing::Values(Scheme{"AffineFlip", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_TRANSFER_AFFINE_FLIP,
                                                OGIVE_UPDATE_STRESS_FIRST},
                                         Scheme{"AffineFlipStressLast", OGIVE_SHAPE_QUADRATIC_BSPLINE,
                                                OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_LAST},
                                         Scheme{"Apic", OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_TRANSFER_APIC,
                                                OGIVE_UPDATE_STRESS_FIRST}),
                         name_of);

class EveryTransfer : public testing::TestWithParam<Scheme> {};

// Two elastic blocks collide and ring: what is lost is booked, momentum is kept, and none of it depends on threads.
TEST_P(EveryTransfer, OfAnElasticImpactKeepsMomentumAndBooksWhatItTakes) {
  const Scheme s = GetParam();
  const auto run = [&](std::int32_t threads) {
    Scene scene;
    scene.grid(1, {-14, -6, -6}, {14, 6, 6})
        .numerics(s.shape, 0.4, {}, threads, s.transfer, s.order)
        .contact(OGIVE_CONTACT_HUANG_SECOND, OGIVE_DETECTION_SHARED_NODE);
    const ogive_material_id material = scene.material("steel", steel());
    scene.box("a", material, {-8, -2, -2}, {0, 2, 2}, 0.5, {5, 0, 0});
    scene.box("b", material, {0, -2, -2}, {8, 2, 2}, 0.5, {-3, 0, 0});
    scene.prepare();
    scene.steps(150);
    return scene;
  };
  const Scene one = run(1), two = run(2);
  const ogive_ledger l = one.ledger();
  measured("energy_drift", l.residual_relative);
  measured("transfer_dissipation", l.transfer_dissipation / l.initial_total);
  double momentum = 0;
  for (int c = 0; c < 3; ++c) momentum = std::max(momentum, std::abs(l.momentum[c] - (c == 0 ? 0.5 * l.mass * 2 : 0)));
  measured("momentum_drift", momentum / (l.mass * 4));
  EXPECT_LE(momentum, 1e-13 * l.mass * 4);
  EXPECT_LT(one.result({0}).velocity[0], -1);  // rebounded
  if (s.transfer == OGIVE_TRANSFER_FLIP) {
    EXPECT_LE(std::abs(l.transfer_dissipation), 1e-12 * l.initial_total);
  } else {
    EXPECT_GT(l.transfer_dissipation, 0);
  }
  EXPECT_LE(std::abs(l.residual_relative), 0.07);  // measured at most 0.057 (B-spline APIC)
  for (std::int32_t b = 0; b < 2; ++b) {
    EXPECT_EQ(one.field({b}, "velocity"), two.field({b}, "velocity"));
    EXPECT_EQ(one.field({b}, "stress"), two.field({b}, "stress"));
  }
  EXPECT_EQ(l.transfer_dissipation, two.ledger().transfer_dissipation);
}

constexpr std::int32_t hat = OGIVE_SHAPE_LINEAR, spline = OGIVE_SHAPE_QUADRATIC_BSPLINE, gimp = OGIVE_SHAPE_GIMP;
INSTANTIATE_TEST_SUITE_P(
    Transfer, EveryTransfer,
    testing::Values(Scheme{"LinearFlip", hat, OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_FIRST},
                    Scheme{"LinearFlipStressLast", hat, OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_LAST},
                    Scheme{"LinearAffineFlip", hat, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_FIRST},
                    Scheme{"LinearAffineFlipStressLast", hat, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_LAST},
                    Scheme{"LinearApic", hat, OGIVE_TRANSFER_APIC, OGIVE_UPDATE_STRESS_FIRST},
                    Scheme{"BSplineFlip", spline, OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_FIRST},
                    Scheme{"BSplineFlipStressLast", spline, OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_LAST},
                    Scheme{"BSplineAffineFlip", spline, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_FIRST},
                    Scheme{"BSplineAffineFlipStressLast", spline, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_LAST},
                    Scheme{"BSplineApic", spline, OGIVE_TRANSFER_APIC, OGIVE_UPDATE_STRESS_FIRST},
                    Scheme{"GimpFlip", gimp, OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_FIRST},
                    Scheme{"GimpFlipStressLast", gimp, OGIVE_TRANSFER_FLIP, OGIVE_UPDATE_STRESS_LAST},
                    Scheme{"GimpAffineFlip", gimp, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_FIRST},
                    Scheme{"GimpAffineFlipStressLast", gimp, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_LAST},
                    Scheme{"GimpApic", gimp, OGIVE_TRANSFER_APIC, OGIVE_UPDATE_STRESS_FIRST}),
    name_of);

// A free elastic block that breathes is damped by every transfer but FLIP. Nothing else happens to it, so that what the ledger
// books is what it loses.
class Damping : public testing::TestWithParam<Scheme> {};

TEST_P(Damping, OfARingingBlockIsBookedAsItIs) {
  const Scheme s = GetParam();
  Scene scene;
  scene.grid(1, {-5, -5, -5}, {5, 5, 5}).numerics(s.shape, 0.3, {}, 1, s.transfer, s.order);
  const ogive_body_id block = scene.box("block", scene.material("steel", steel()), {-2, -2, -2}, {2, 2, 2}, 0.5, {});
  scene.prepare();
  std::vector<double> v = scene.field(block, "position");
  for (double& c : v) c *= 5;
  scene.check(ogive_field_set(scene.get(), block, "velocity", v.data(), static_cast<std::int64_t>(v.size())));
  const ogive_ledger before = scene.ledger();  // no stress yet, so that velocities may belong to any time
  scene.steps(600);
  const ogive_ledger after = scene.ledger();
  const double energy = before.kinetic + before.internal, lost = energy - after.kinetic - after.internal,
               booked = after.transfer_dissipation - before.transfer_dissipation;
  measured("lost", lost / energy);
  measured("booked_of_lost", booked / lost);
  EXPECT_GT(lost, 0.05 * energy);
  EXPECT_NEAR(booked, lost, 0.003 * lost);  // measured within 0.0005
}

INSTANTIATE_TEST_SUITE_P(
    Transfer, Damping,
    testing::Values(Scheme{"AffineFlip", spline, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_FIRST},
                    Scheme{"AffineFlipStressLast", spline, OGIVE_TRANSFER_AFFINE_FLIP, OGIVE_UPDATE_STRESS_LAST},
                    Scheme{"Apic", spline, OGIVE_TRANSFER_APIC, OGIVE_UPDATE_STRESS_FIRST},
                    Scheme{"Xpic", spline, OGIVE_TRANSFER_XPIC, OGIVE_UPDATE_STRESS_FIRST}),
    name_of);
