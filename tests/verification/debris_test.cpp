// Debris beyond the reach of anything is dropped and booked; what can still meet something is not.
#include <functional>
#include <ostream>

#include "scene.hpp"
#include "store.hpp"

using namespace verification;

namespace {

constexpr int block_particles = 16 * 16 * 16, fragment_particles = 8;

void add_cube(std::vector<double>& xyz, std::vector<double>& volume, Vec3 centre, int across) {
  for (int k = 0; k < across; ++k)
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i) {
        xyz.push_back(centre[0] + 0.5 * (i - 0.5 * (across - 1)));
        xyz.push_back(centre[1] + 0.5 * (j - 0.5 * (across - 1)));
        xyz.push_back(centre[2] + 0.5 * (k - 0.5 * (across - 1)));
        volume.push_back(0.125);
      }
}

struct Fragment {
  Vec3 centre, velocity, spin{};
};

/// A block of 8 x 8 x 8 cells at rest around the origin, and fragments of it, of one cell each, that fly.
struct Debris {
  std::vector<Fragment> fragments = {{{0, 0, 12}, {1, 2, 100}}};
  std::array<std::int32_t, 6> faces{};
  Vec3 gravity{};
  std::int32_t threads = 1;
  bool drop = true, ringing = false;
  double maximum_time_step = 1e-3;
  int across = 2;  // particles along the edge of a fragment
  std::function<void(Scene&, ogive_material_id)> more;

  Scene build() const {
    Scene scene;
    scene.grid(1, {-20, -20, -30}, {20, 20, 30}, faces);
    ogive_numerics_def numerics;
    ogive_numerics_def_init(&numerics, sizeof numerics);
    numerics.drop_debris = drop;
    numerics.threads = threads;
    numerics.maximum_time_step = maximum_time_step;
    for (int c = 0; c < 3; ++c) numerics.gravity[c] = gravity[c];
    scene.check(ogive_world_set_numerics(scene.get(), &numerics));
    const ogive_material_id soft = scene.material("soft", elastic(2.7e-3, 690, 0.3));
    std::vector<double> xyz, volume;
    add_cube(xyz, volume, {0, 0, 0}, 16);
    for (const Fragment& fragment : fragments) add_cube(xyz, volume, fragment.centre, across);
    const ogive_body_def def = Scene::body(soft, {0, 0, 0});
    ogive_body_id body{-1};
    scene.check(ogive_body_add_particles(scene.get(), "block", &def, static_cast<std::int64_t>(volume.size()), xyz.data(),
                                         volume.data(), &body));
    if (more) more(scene, soft);
    scene.prepare();
    std::vector<double> velocity = scene.field(body, "velocity");
    for (int p = 0; ringing && p < block_particles; ++p) velocity[3 * p] = 10 * std::sin(0.4 * xyz[3 * p]);
    std::size_t p = block_particles;
    for (const Fragment& fragment : fragments)
      for (int i = 0; i < across * across * across; ++i, ++p)
        for (int c = 0; c < 3; ++c) {
          const int d = (c + 1) % 3, e = (c + 2) % 3;
          velocity[3 * p + c] = fragment.velocity[c] + fragment.spin[d] * (xyz[3 * p + e] - fragment.centre[e]) -
                                fragment.spin[e] * (xyz[3 * p + d] - fragment.centre[d]);
        }
    scene.set_field(body, "velocity", velocity);
    return scene;
  }
};

constexpr ogive_body_id block{0};

std::int64_t dropped_after(const Debris& debris, int steps) {
  Scene scene = debris.build();
  scene.steps(steps);
  return scene.result(block).dropped_particles;
}

/// A box at rest or moving, as another body.
std::function<void(Scene&, ogive_material_id)> another(Vec3 lower, Vec3 upper, Vec3 velocity = {}) {
  return [=](Scene& scene, ogive_material_id soft) { scene.box("other", soft, lower, upper, 0.5, velocity); };
}

std::function<void(Scene&, ogive_material_id)> a_wall(double z, double normal) {
  return [=](Scene& scene, ogive_material_id) { scene.wall({0, 0, z}, {0, 0, normal}); };
}

std::function<void(Scene&, ogive_material_id)> an_oblique_wall(Vec3 point, Vec3 normal) {
  return [=](Scene& scene, ogive_material_id) { scene.wall(point, normal); };
}

std::function<void(Scene&, ogive_material_id)> a_clamp(std::int32_t region, Vec3 a, Vec3 b, double radius = 1,
                                                       std::int32_t body = -1) {
  return [=](Scene& scene, ogive_material_id) {
    ogive_clamp_def def;
    ogive_clamp_def_init(&def, sizeof def);
    def.region = region;
    def.radius = radius;
    def.body.index = body;
    for (int c = 0; c < 3; ++c) {
      def.a[c] = a[c];
      def.b[c] = b[c];
    }
    scene.check(ogive_clamp_add(scene.get(), &def));
  };
}

std::function<void(Scene&, ogive_material_id)> a_load(std::int32_t kind, double lower, double upper) {
  return [=](Scene& scene, ogive_material_id) {
    ogive_load_def def;
    ogive_load_def_init(&def, sizeof def);
    def.kind = kind;
    def.region = OGIVE_REGION_BOX;
    for (int c = 0; c < 3; ++c) {
      def.a[c] = c < 2 ? -20 : lower;
      def.b[c] = c < 2 ? 20 : upper;
    }
    scene.check(ogive_load_add(scene.get(), &def, nullptr));
  };
}

/// A rigid block far behind, at rest until 1 ms and then moving with the velocity along z.
std::function<void(Scene&, ogive_material_id)> a_guided_block(double later) {
  return [=](Scene& scene, ogive_material_id soft) {
    const ogive_body_id body = scene.add("guided", Scene::rigid(soft, OGIVE_FORMULATION_RIGID_PRESCRIBED, {}),
                                         Scene::solid(OGIVE_SOLID_BOX, {0, 0, -24}, {4, 4, 4}, 0.5));
    const double time[] = {0, 1, 2}, velocity[] = {0, 0, 0, 0, 0, 0, 0, 0, later};
    scene.check(ogive_body_set_motion(scene.get(), body, 3, time, velocity, nullptr));
  };
}

struct NamedCase {
  const char* name;
  Debris debris;

  friend std::ostream& operator<<(std::ostream& to, const NamedCase& named) { return to << named.name; }
};

Debris with(std::function<void(Scene&, ogive_material_id)> more) {
  Debris debris;
  debris.more = std::move(more);
  return debris;
}

Debris with_face(int face, std::int32_t kind) {
  Debris debris;
  debris.faces[face] = kind;
  return debris;
}

Debris with_fragments(std::vector<Fragment> fragments) {
  Debris debris;
  debris.fragments = std::move(fragments);
  return debris;
}

Debris with_gravity() {
  Debris debris;
  debris.gravity = {0, 0, -1};
  return debris;
}

Debris larger() {
  Debris debris;
  debris.across = 4;  // 1.5 % of the body
  return debris;
}

Debris off() {
  Debris debris;
  debris.drop = false;
  return debris;
}

// Each beside what differs in the point that is tried alone and is dropped, below.
std::vector<NamedCase> kept_cases() {
  return {
      {"ABodyLiesInItsWay", with(another({-2, -2, 20}, {2, 2, 22}))},
      {"AFasterBodyComesFromBehind", with(another({6, -2, -20}, {10, 2, -16}, {-10, 0, 400}))},
      {"ABodyMayKickItsOwnAfterIt", with(another({-2, -2, -28}, {2, 2, -24}, {0, 0, 300}))},
      {"AGuidedBodyWillComeAfterIt", with(a_guided_block(1000))},
      {"ItFliesTowardsAWall", with(a_wall(28, -1))},
      {"ItFliesTowardsAnObliqueWall", with(an_oblique_wall({30, 0, 0}, {-1, 0, -1}))},
      {"ItFliesTowardsASymmetryPlane", with_face(5, OGIVE_FACE_SYMMETRY)},
      {"ItFliesTowardsAFixedFace", with_face(5, OGIVE_FACE_FIXED)},
      {"AClampLiesInItsWay", with(a_clamp(OGIVE_REGION_BOX, {-5, -5, 26}, {5, 5, 28}))},
      {"AClampOfItsBodyLiesInItsWay", with([](Scene& scene, ogive_material_id soft) {
         another({-2, -2, -20}, {2, 2, -16})(scene, soft);
         a_clamp(OGIVE_REGION_BOX, {-5, -5, 26}, {5, 5, 28}, 1, 0)(scene, soft);
       })},
      {"AClampSurroundsIt", with(a_clamp(OGIVE_REGION_OUTSIDE_CYLINDER, {0, 0, 0}, {0, 0, 2}, 4))},
      {"AClampIsEverywhere", with(a_clamp(OGIVE_REGION_EVERYWHERE, {}, {}))},
      {"VelocityIsPrescribedInItsWay", with(a_load(OGIVE_LOAD_VELOCITY, 26, 28))},
      {"ALoadIsForIt", with(a_load(OGIVE_LOAD_ACCELERATION, 10, 14))},
      {"GravityActs", with_gravity()},
      {"ItIsNearItsBodyAndMovesWithIt", with_fragments({{{0, 0, 7.2}, {}}})},
      {"ItFliesBackToItsBody", with_fragments({{{0, 0, 12}, {0, 0, -10}}})},
      {"ItMeetsAnotherFragment", with_fragments({{{6, 0, 12}, {-60, 0, 40}}, {{-6, 0, 12}, {60, 0, 40}}})},
      {"ItIsMuchOfItsBody", larger()},
      {"NobodyAskedForIt", off()},
  };
}

std::vector<NamedCase> dropped_cases() {
  return {
      {"ABodyLiesBesideItsWay", with(another({12, -2, 20}, {16, 2, 22}))},
      {"ASlowerBodyComesFromBehind", with(another({6, -2, -20}, {10, 2, -16}, {-10, 0, 50}))},
      {"ASlowerBodyMayKickItsOwnAfterIt", with(another({-2, -2, -28}, {2, 2, -24}, {0, 0, 50}))},
      {"AGuidedBodyWillNotReachIt", with(a_guided_block(50))},
      {"ItFliesAwayFromAWall", with(a_wall(-28, 1))},
      {"ItFliesAlongAnObliqueWall", with(an_oblique_wall({30, 0, 0}, {-1, 0, 1}))},
      {"ItFliesAwayFromASymmetryPlane", with_face(4, OGIVE_FACE_SYMMETRY)},
      {"ItFliesAwayFromAFixedFace", with_face(4, OGIVE_FACE_FIXED)},
      {"AClampLiesBesideItsWay", with(a_clamp(OGIVE_REGION_BOX, {12, -5, 26}, {18, 5, 28}))},
      {"AClampOfAnotherBodyLiesInItsWay", with([](Scene& scene, ogive_material_id soft) {
         another({-2, -2, -20}, {2, 2, -16})(scene, soft);
         a_clamp(OGIVE_REGION_BOX, {-5, -5, 26}, {5, 5, 28}, 1, 1)(scene, soft);
       })},
      {"AClampSurroundsItFarOff", with(a_clamp(OGIVE_REGION_OUTSIDE_CYLINDER, {0, 0, 0}, {0, 0, 2}, 8))},
      {"VelocityIsPrescribedBesideItsWay", with(a_load(OGIVE_LOAD_VELOCITY, -28, -26))},
      {"ALoadIsForItsBody", with(a_load(OGIVE_LOAD_ACCELERATION, -4, 4))},
      {"ItIsNotNearItsBodyAndMovesWithIt", with_fragments({{{0, 0, 8.2}, {}}})},
      {"ItMissesAnotherFragment", with_fragments({{{6, 0, 12}, {60, 0, 40}}, {{-6, 0, 12}, {-60, 0, 40}}})},
  };
}

class KeptDebris : public testing::TestWithParam<NamedCase> {};
class DroppedDebris : public testing::TestWithParam<NamedCase> {};

std::string case_name(const testing::TestParamInfo<NamedCase>& info) { return info.param.name; }

}  // namespace

TEST_P(KeptDebris, IsKept) { EXPECT_EQ(dropped_after(GetParam().debris, 101), 0); }
INSTANTIATE_TEST_SUITE_P(Where, KeptDebris, testing::ValuesIn(kept_cases()), case_name);

TEST_P(DroppedDebris, IsDropped) {
  const int fragments = static_cast<int>(GetParam().debris.fragments.size());
  EXPECT_EQ(dropped_after(GetParam().debris, 51), fragments * fragment_particles);
}
INSTANTIATE_TEST_SUITE_P(Where, DroppedDebris, testing::ValuesIn(dropped_cases()), case_name);

TEST(Debris, AForceOfTheHostKeepsAFragment) {
  for (const double force : {0.0, 1e-3}) {
    Scene scene = Debris{}.build();
    std::vector<double> forces(3 * (block_particles + fragment_particles), 0.0);
    forces.back() = force;
    scene.set_field(block, "force", forces);
    scene.steps(51);
    EXPECT_EQ(scene.result(block).dropped_particles, force == 0 ? fragment_particles : 0);
  }
}

TEST(Debris, WhatIsDroppedIsBookedAndTheLedgerStaysClosed) {
  Scene scene = with_fragments({{{0, 0, 12}, {1, 2, 100}, {3, -2, 5}}}).build();
  scene.steps(50);
  EXPECT_EQ(scene.result(block).dropped_particles, 0);  // looked for when the 51st step begins
  const ogive_ledger before = scene.ledger();
  const std::vector<double> m = scene.field(block, "mass"), x = scene.field(block, "position"), v = scene.field(block, "velocity"),
                            C = scene.field(block, "affine_velocity"), e = scene.field(block, "energy");
  double mass = 0, energy = 0;
  Vec3 momentum{}, angular{};
  for (std::size_t p = block_particles; p < m.size(); ++p) {
    mass += m[p];
    energy += e[p];
    for (int c = 0; c < 3; ++c) {
      const int d = (c + 1) % 3, f = (c + 2) % 3;
      momentum[c] += m[p] * v[3 * p + c];
      energy += 0.5 * m[p] * v[3 * p + c] * v[3 * p + c];
      angular[c] += m[p] * (x[3 * p + d] * v[3 * p + f] - x[3 * p + f] * v[3 * p + d]) +
                    0.25 * m[p] * (C[9 * p + 3 * f + d] - C[9 * p + 3 * d + f]);
    }
    for (int c = 0; c < 9; ++c) energy += 0.125 * m[p] * C[9 * p + c] * C[9 * p + c];
  }
  scene.steps(1);
  const ogive_ledger after = scene.ledger();
  const ogive_body_result result = scene.result(block);
  EXPECT_EQ(result.dropped_particles, fragment_particles);
  EXPECT_EQ(result.particles, block_particles);
  EXPECT_EQ(result.left_domain, 0);
  EXPECT_NEAR(result.dropped_mass, mass, 1e-14 * mass);
  EXPECT_NEAR(after.dropped_mass, mass, 1e-14 * mass);
  EXPECT_NEAR(after.dropped_energy, energy, 1e-14 * energy);
  const double largest = m[0] * 100 * 8, arm = 15 * largest;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(after.dropped_momentum[c], momentum[c], 1e-14 * largest);
    EXPECT_NEAR(after.dropped_angular_momentum[c], angular[c], 1e-14 * arm);
    EXPECT_NEAR(after.momentum[c] + after.dropped_momentum[c], before.momentum[c], 1e-13 * largest);
    EXPECT_NEAR(after.angular_momentum[c] + after.dropped_angular_momentum[c], before.angular_momentum[c], 1e-13 * arm);
    EXPECT_EQ(after.left_domain_momentum[c], 0);
  }
  EXPECT_NEAR(after.mass + after.dropped_mass, before.mass, 1e-13 * before.mass);
  // The block is at rest: nothing else has changed in the step.
  EXPECT_NEAR(after.total, before.total, 1e-13 * before.total);
  EXPECT_NEAR(after.energy_growth, before.energy_growth, 1e-13);
  EXPECT_EQ(after.left_domain_energy, 0);
}

TEST(Debris, TheRestMovesToTheSameBitsUntilTheDebrisWouldHaveBeenBinnedOrLimitedTheTimeStep) {
  // Particles lie a quarter of a cell from its faces, so that at 0.01 cells a step the fragment stays in its group for 74 steps.
  Debris debris;
  debris.maximum_time_step = 1e-4;
  debris.ringing = true;
  Scene with = debris.build();
  debris.drop = false;
  Scene without = debris.build();
  with.steps(70);
  without.steps(70);
  EXPECT_EQ(with.result(block).dropped_particles, fragment_particles);
  EXPECT_EQ(with.progress().time, without.progress().time);
  for (const auto& [name, values] : with.all_fields()) {
    const std::vector<double> all = without.all_fields().at(name);
    ASSERT_LT(values.size(), all.size());
    EXPECT_TRUE(same_bits(values.data(), all.data(), values.size() * sizeof(double))) << name;  // the block's come first
  }
}

TEST(Debris, TheTimeStepIsNoLongerThatOfTheDebris) {
  Scene scene = Debris{}.build();
  scene.steps(50);
  const double before = scene.stable_time_step();
  scene.steps(1);
  // h/(c + v) without v = 100 of c + v = 686.
  measured("time_step_ratio", scene.stable_time_step() / before);
  EXPECT_GT(scene.stable_time_step(), 1.15 * before);
}

namespace {

/// Fragments that come to be far enough from their body, and from each other, at different times.
Debris burst() {
  Debris debris = with_fragments({{{0, 0, 7}, {0, 0, 60}, {1, 2, 3}},
                                  {{0, 0, -7}, {0, 0, -20}},
                                  {{7, 0, 0}, {30, 0, 0}},
                                  {{-7, 0, 0}, {-12, 0, 0}},
                                  {{0, 12, 0}, {0, 100, 0}}});
  debris.ringing = true;
  return debris;
}

}  // namespace

TEST(Debris, OneAndTwoThreadsDropTheSame) {
  Debris debris = burst();
  Scene one = debris.build();
  debris.threads = 2;
  Scene two = debris.build();
  std::int64_t last = 0;
  int times = 0;
  for (int i = 0; i < 3; ++i) {
    one.steps(51);
    two.steps(51);
    expect_same_bits(one, two);
    times += one.result(block).dropped_particles > last;
    last = one.result(block).dropped_particles;
  }
  measured("dropped", static_cast<double>(last));
  EXPECT_GE(times, 2);
}

TEST(Debris, ARestartDropsTheSame) {
  Scene straight = burst().build();
  straight.steps(220);
  EXPECT_GE(straight.result(block).dropped_particles, 3 * fragment_particles);
  for (const int interruption : {50, 51, 77, 100, 199}) {
    SCOPED_TRACE(interruption);
    Scene first = burst().build(), second;
    first.steps(interruption);
    Store store;
    store.save(first);
    store.load(second);
    expect_same_bits(first, second);
    second.steps(220 - interruption);
    expect_same_bits(straight, second);
  }
}

TEST(Debris, ItIsDroppedInPlaneStrainToo) {
  Scene scene;
  scene.grid(1, {-20, -20, 0}, {20, 20, 1}, {}, OGIVE_SPACE_PLANE_STRAIN);
  ogive_numerics_def numerics;
  ogive_numerics_def_init(&numerics, sizeof numerics);
  numerics.drop_debris = 1;
  scene.check(ogive_world_set_numerics(scene.get(), &numerics));
  const ogive_material_id soft = scene.material("soft", elastic(2.7e-3, 690, 0.3));
  std::vector<double> xyz, volume;
  for (int j = 0; j < 33; ++j)
    for (int i = 0; i < (j < 32 ? 32 : 1); ++i) {
      xyz.insert(xyz.end(), {-8 + 0.5 * i, j < 32 ? -8 + 0.5 * j : 15.0, 0});
      volume.push_back(0.25);
    }
  const ogive_body_def def = Scene::body(soft, {0, 0, 0});
  scene.check(ogive_body_add_particles(scene.get(), "block", &def, 1025, xyz.data(), volume.data(), nullptr));
  scene.prepare();
  scene.steps(51);
  EXPECT_EQ(scene.result(block).dropped_particles, 1);
}

TEST(Debris, AnAxisymmetricModelRefusesIt) {
  Scene scene;
  scene.grid(1, {0, -20, 0}, {20, 20, 1}, {OGIVE_FACE_SYMMETRY}, OGIVE_SPACE_AXISYMMETRIC);
  ogive_numerics_def numerics;
  ogive_numerics_def_init(&numerics, sizeof numerics);
  numerics.drop_debris = 1;
  scene.check(ogive_world_set_numerics(scene.get(), &numerics));
  const ogive_material_id soft = scene.material("soft", elastic(2.7e-3, 690, 0.3));
  scene.add("ball", Scene::body(soft, {}), Scene::solid(OGIVE_SOLID_SPHERE, {0, 0, 0}, {4, 0, 0}, 0.5));
  EXPECT_EQ(ogive_world_prepare(scene.get()), OGIVE_ERROR_ARGUMENT);
  EXPECT_NE(std::string(ogive_world_message(scene.get())).find("drop_debris: must be 0 in an axisymmetric model"), std::string::npos);
}

TEST(Debris, ThePlanTellsOfIt) {
  const auto plan_of = [](const Debris& debris) {
    Scene scene = debris.build();
    std::string text(8192, '\0');
    std::size_t needed = 0;
    scene.check(ogive_world_plan(scene.get(), text.data(), text.size(), &needed));
    return text.substr(0, needed - 1);
  };
  EXPECT_NE(plan_of({}).find("debris: parts of at most 1 % of their body"), std::string::npos);
  EXPECT_NE(plan_of(with_gravity()).find("caution: gravity acts"), std::string::npos);
  EXPECT_EQ(plan_of(off()).find("debris"), std::string::npos);
}
