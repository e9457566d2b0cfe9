// Particles to which nothing has happened yet are left out of a step, and no bit of anything that a world knows depends on it.
//
// Each case runs twice, with and without. Clock and stable time step are compared after every step, and at the end everything
// that a save holds: particles in the engine's own order, ledger, forces, memory of contact.
#include <functional>

#include "store.hpp"

using namespace verification;

namespace {

using Build = std::function<void(Scene&, bool skip, std::int32_t threads)>;

struct Case {
  std::string name;
  Build build;
  int steps = 40;
  double least_part = 0.1;  // of the particle-steps, that are left out
  std::int32_t threads = 1;  // of the run that is interrupted
  bool sudden = false;       // and a layer of particles at the end of a block moves at once
};

Scene built(const Build& build, bool skip, std::int32_t threads = 1) {
  Scene scene;
  build(scene, skip, threads);
  scene.prepare();
  return scene;
}

// The layer 61.5 < x < 62 of body 1. Blocks of the grid end at 62: what the layer moves in a step lies as many blocks away as can
// be, and, unlike ahead of a wave, moves by more than what counts as none.
void move_layer(Scene& scene) {
  const std::vector<double> position = scene.field({1}, "position");
  std::vector<double> velocity = scene.field({1}, "velocity");
  for (std::size_t i = 0; i < position.size(); i += 3)
    if (position[i] > 61.5 && position[i] < 62) velocity[i] = 100, velocity[i + 1] = 30;
  scene.set_field({1}, "velocity", velocity);
}

Scene begun(const Case& of, bool skip, std::int32_t threads = 1) {
  Scene scene = built(of.build, skip, threads);
  if (of.sudden) move_layer(scene);
  return scene;
}

double part_left_out(const Scene& scene) {
  const ogive_progress progress = scene.progress();
  return static_cast<double>(progress.resting_particle_steps) / static_cast<double>(progress.particle_steps);
}

// All that the worlds would save, but the choice itself and the count of what it left out.
void expect_same_saves(const Scene& a, const Scene& b) {
  Store one, other;
  one.save(a);
  other.save(b);
  ASSERT_EQ(one.arrays.size(), other.arrays.size());
  for (const auto& [name, array] : one.arrays) {
    if (name == "model/numerics/skip_resting" || name == "state/resting_particle_steps") continue;
    ASSERT_TRUE(other.arrays.count(name)) << name;
    EXPECT_TRUE(array.bytes == other.arrays.at(name).bytes) << name;
  }
  expect_same_bits(a, b);
}

void step_both(Scene& a, Scene& b, int steps) {
  for (int i = 0; i < steps; ++i) {
    a.steps(1);
    b.steps(1);
    ASSERT_EQ(a.stable_time_step(), b.stable_time_step()) << "step " << i;
    ASSERT_EQ(a.progress().time, b.progress().time) << "step " << i;
  }
}

void compare(const Case& of) {
  Scene skipping = begun(of, true), computing = begun(of, false);
  step_both(skipping, computing, of.steps);
  expect_same_saves(skipping, computing);
  measured("left out", part_left_out(skipping));
  EXPECT_GT(part_left_out(skipping), of.least_part);
  EXPECT_EQ(computing.progress().resting_particle_steps, 0);

  // An interruption half-way, some with two threads.
  Scene interrupted = begun(of, true, of.threads);
  interrupted.steps(of.steps / 2);
  Store store;
  store.save(interrupted);
  Scene loaded;
  store.load(loaded);
  loaded.check(ogive_world_set_threads(loaded.get(), of.threads));
  loaded.steps(of.steps - of.steps / 2);
  expect_same_saves(skipping, loaded);
  EXPECT_EQ(loaded.progress().resting_particle_steps, skipping.progress().resting_particle_steps);
}

class Resting : public testing::TestWithParam<Case> {};

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

// ------------------------------------------------------------------------------------------------------ a long bar

struct Bar {
  std::int32_t shape = OGIVE_SHAPE_QUADRATIC_BSPLINE, transfer = OGIVE_TRANSFER_AFFINE_FLIP, order = OGIVE_UPDATE_STRESS_FIRST;
  std::int32_t xpic_order = 2;
  double pic_fraction = 0;
  std::int32_t space = OGIVE_SPACE_THREE_DIMENSIONAL;
  std::array<std::int32_t, 6> faces = {};
  ogive_material_def law = steel();
  double length = 160;
  std::function<void(Scene&)> more = [](Scene&) {};

  // Struck at x = 0 (axisymmetric: y = 0) by a hammer of its own section.
  void operator()(Scene& scene, bool skip, std::int32_t threads) const {
    const bool rings = space == OGIVE_SPACE_AXISYMMETRIC;
    const Vec3 lower = {-6, -2, -2}, upper = {length + 2, 4, 4};
    std::array<std::int32_t, 6> sides = faces;
    if (rings) sides[0] = OGIVE_FACE_SYMMETRY;
    scene.grid(1, rings ? Vec3{0, -6, -2} : lower, rings ? Vec3{4, length + 2, 4} : upper, sides, space);
    ogive_numerics_def def;
    ogive_numerics_def_init(&def, sizeof def);
    def.shape_function = shape;
    def.transfer = transfer;
    def.update_order = order;
    def.xpic_order = xpic_order;
    def.pic_fraction = pic_fraction;
    def.time_step_factor = 0.4;
    def.threads = threads;
    def.skip_resting = skip;
    scene.check(ogive_world_set_numerics(scene.get(), &def));
    const ogive_material_id hard = scene.material("steel", steel()), soft = scene.material("bar", law);
    const auto box = [&](const char* name, ogive_material_id of, double begin, double end, double speed) {
      Vec3 centre = {0.5 * (begin + end), 1, 1}, size = {end - begin, 2, 2}, velocity = {speed, 0, 0};
      if (rings) centre = {0, centre[0], 0}, size = {4, size[0], 4}, velocity = {0, speed, 0};
      if (space == OGIVE_SPACE_PLANE_STRAIN) centre[2] = 0;
      scene.add(name, Scene::body(of, velocity), Scene::solid(OGIVE_SOLID_BOX, centre, size, 0.5));
    };
    box("hammer", hard, -4.3, -0.3, 20);
    box("bar", soft, 0, length, 0);
    more(scene);
  }
};

std::vector<Case> schemes() {
  std::vector<Case> cases;
  for (const std::int32_t shape : {OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_SHAPE_GIMP})
    for (const std::int32_t order : {OGIVE_UPDATE_STRESS_FIRST, OGIVE_UPDATE_STRESS_LAST, OGIVE_UPDATE_STRESS_LAST_AS_IS}) {
      const std::string where =
          shape_name(shape) + (order == OGIVE_UPDATE_STRESS_FIRST ? "First" : order == OGIVE_UPDATE_STRESS_LAST ? "Last" : "AsIs");
      const auto add = [&](const std::string& name, Bar bar) {
        bar.shape = shape;
        bar.order = order;
        cases.push_back({where + name, bar, 25, 0.1, 1, true});
      };
      add("Flip", {.transfer = OGIVE_TRANSFER_FLIP});
      add("FlipWithPic", {.transfer = OGIVE_TRANSFER_FLIP, .pic_fraction = 0.1});
      add("Affine", {});
      add("Apic", {.transfer = OGIVE_TRANSFER_APIC});
      add("Pic", {.transfer = OGIVE_TRANSFER_XPIC, .xpic_order = 1});
      add("Xpic2", {.transfer = OGIVE_TRANSFER_XPIC, .xpic_order = 2});
      add("Xpic5", {.transfer = OGIVE_TRANSFER_XPIC, .xpic_order = 5});
    }
  return cases;
}

std::vector<Case> laws() {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const ogive_material_def& law, std::int32_t order = OGIVE_UPDATE_STRESS_FIRST) {
    cases.push_back({name, Bar{.order = order, .law = law}, 30, 0.2});
  };
  ogive_material_def def = elastic(2.7e-3, 69e3, 0.3);
  add("Elastic", def);
  def.eos = OGIVE_EOS_MIE_GRUNEISEN, def.eos_sound_speed = 5350, def.eos_slope = 1.34, def.gruneisen = 2;
  add("MieGruneisen", def);
  def = elastic(2.7e-3, 69e3, 0.3);
  def.strength = OGIVE_STRENGTH_NEO_HOOKEAN;
  add("NeoHookean", def);
  def.yield_stress = 10, def.hardening_modulus = 100;
  def.strength = OGIVE_STRENGTH_J2_POWER, def.hardening_exponent = 0.5;
  add("J2", def);
  def.hardening_exponent = 1, def.isotropic_fraction = 0.5;
  def.strength = OGIVE_STRENGTH_J2_MIXED;
  add("J2Mixed", def);
  def.strength = OGIVE_STRENGTH_J2_MULTIPLICATIVE;
  add("J2Multiplicative", def);
  def = failing_aluminium();
  def.yield_stress = 10;
  add("JohnsonCook", def);
  def.viscosity_linear = 0.1, def.viscosity_quadratic = 1;
  add("Viscous", def);
  add("ViscousStressLast", def, OGIVE_UPDATE_STRESS_LAST);
  return cases;
}

// ------------------------------------------------------------------------------------------------- what holds a bar

std::vector<Case> surroundings() {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const Bar& bar, int steps = 40) { cases.push_back({name, bar, steps, 0.1}); };
  constexpr std::int32_t symmetry = OGIVE_FACE_SYMMETRY, fixed = OGIVE_FACE_FIXED, open = OGIVE_FACE_FREE;
  add("PlaneStrain", {.space = OGIVE_SPACE_PLANE_STRAIN});
  add("Axisymmetric", {.space = OGIVE_SPACE_AXISYMMETRIC});
  add("AxisymmetricLinearStressLast",
      {.shape = OGIVE_SHAPE_LINEAR, .order = OGIVE_UPDATE_STRESS_LAST, .space = OGIVE_SPACE_AXISYMMETRIC});
  // The bar fills the domain between the faces y, z = -2 and 4 only in part, so that they are planes of its own at y = 0.
  for (const std::int32_t shape : {OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_SHAPE_GIMP})
    for (const std::int32_t transfer : {OGIVE_TRANSFER_APIC, OGIVE_TRANSFER_XPIC}) {
      const std::string of = shape_name(shape) + (transfer == OGIVE_TRANSFER_APIC ? "Apic" : "Xpic");
      Bar bar{.shape = shape, .transfer = transfer, .xpic_order = 3};
      add("SymmetryFaces" + of, {.shape = shape, .transfer = transfer, .xpic_order = 3, .faces = {open, open, open, symmetry, open, symmetry},
                                 .more = [](Scene& scene) {
                                   // Beside the struck bar, at the faces.
                                   scene.box("guide", {0}, {-4, 2.2, 1}, {162, 4, 4}, 0.5, {0, 0, 0});
                                 }});
      add("FixedFaces" + of, {.shape = shape, .transfer = transfer, .xpic_order = 3, .faces = {open, fixed, open, fixed, open, open},
                              .more = [](Scene& scene) { scene.box("guide", {0}, {-4, 2.2, 1}, {162, 4, 4}, 0.5, {0, 0, 0}); }});
    }
  add("Wall", {.more = [](Scene& scene) { scene.wall({0, 0, 0}, {0, 0, 1}, 0.2, {}, OGIVE_CONTACT_PERSISTENT); }});
  add("WallStressLast", {.order = OGIVE_UPDATE_STRESS_LAST,
                         .more = [](Scene& scene) { scene.wall({0, 0, 0}, {0, 0, 1}, 0.2, {}, OGIVE_CONTACT_PERSISTENT); }});
  add("Clamp", {.more = [](Scene& scene) {
        ogive_clamp_def def;
        ogive_clamp_def_init(&def, sizeof def);
        def.a[0] = 10, def.a[1] = def.a[2] = -1;
        def.b[0] = 60, def.b[1] = 3, def.b[2] = 0.5;
        scene.check(ogive_clamp_add(scene.get(), &def));
      }});
  const auto load = [](std::int32_t kind, double begin, double end, Vec3 value) {
    return [=](Scene& scene) {
      ogive_load_def def;
      ogive_load_def_init(&def, sizeof def);
      def.kind = kind;
      def.region = OGIVE_REGION_BOX;
      def.body = {1};
      def.a[0] = begin, def.a[1] = def.a[2] = -1;
      def.b[0] = end, def.b[1] = def.b[2] = 3;
      def.area = 4;
      for (int c = 0; c < 3; ++c) def.value[c] = value[c];
      scene.check(ogive_load_add(scene.get(), &def, nullptr));
    };
  };
  add("Traction", {.more = load(OGIVE_LOAD_TRACTION, 159.6, 161, {30, 0, 0})});
  add("Acceleration", {.more = load(OGIVE_LOAD_ACCELERATION, 100, 101, {1e3, 0, 0})});
  add("DrivenNodes", {.more = load(OGIVE_LOAD_VELOCITY, 100, 101, {0, 5, 0})});
  add("DrivenNodesStressLast", {.order = OGIVE_UPDATE_STRESS_LAST, .more = load(OGIVE_LOAD_VELOCITY, 100, 101, {0, 5, 0})});
  return cases;
}

// ---------------------------------------------------------------------------------------------------------- impacts

struct Strike {
  std::int32_t method = OGIVE_CONTACT_PERSISTENT, detection = OGIVE_DETECTION_GAP, normal = OGIVE_NORMAL_AVERAGE;
  double friction = 0.2;
  std::int32_t shape = OGIVE_SHAPE_QUADRATIC_BSPLINE, transfer = OGIVE_TRANSFER_AFFINE_FLIP, order = OGIVE_UPDATE_STRESS_FIRST;
  std::int32_t formulation = OGIVE_FORMULATION_DEFORMABLE;
  bool half = false;

  // A ball strikes a long plate aslant near its end; the plate lies on a backing plate.
  void operator()(Scene& scene, bool skip, std::int32_t threads) const {
    std::array<std::int32_t, 6> faces = {};
    if (half) faces[2] = OGIVE_FACE_SYMMETRY;
    scene.grid(1, {-10, half ? 0.0 : -8.0, -8}, {86, 8, 6}, faces)
        .numerics(shape, 0.4, {}, threads, transfer, order, {}, 3, {}, skip)
        .contact(method, detection, friction, normal);
    const ogive_material_id hard = scene.material("steel", steel()), soft = scene.material("aluminium", failing_aluminium());
    ogive_body_def ball = Scene::body(hard, {150, 0, -300});
    ball.formulation = formulation;
    scene.add("ball", ball, Scene::solid(OGIVE_SOLID_SPHERE, {-1, 0, 2.2}, {2, 0, 0}, 0.5));
    scene.box("plate", soft, {-8, -6, -3}, {84, 6, 0}, 0.5, {0, 0, 0});
    scene.box("backing", hard, {-8, -6, -5}, {84, 6, -3}, 0.5, {0, 0, 0});
  }
};

std::vector<Case> strikes() {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, const Strike& strike) { cases.push_back({name, strike, 20, 0.2, strike.half ? 2 : 1}); };
  static const char* const methods[] = {"SingleField",     "HuangFirst",      "HuangSecond", "York",      "HuChen",
                                        "Bardenhagen2000", "Bardenhagen2001", "Pan2008",     "Persistent"};
  for (std::int32_t method = 0; method < ogive_contact_method_count(); ++method) {
    add(std::string(methods[method]) + "Gap", {.method = method});
    add(std::string(methods[method]) + "SharedNode",
        {.method = method, .detection = OGIVE_DETECTION_SHARED_NODE, .shape = OGIVE_SHAPE_LINEAR, .transfer = OGIVE_TRANSFER_FLIP, .half = true});
    add(std::string(methods[method]) + "StressLast", {.method = method, .order = OGIVE_UPDATE_STRESS_LAST, .half = true});
  }
  add("GimpXpic", {.shape = OGIVE_SHAPE_GIMP, .transfer = OGIVE_TRANSFER_XPIC});
  add("VolumeGradient", {.normal = OGIVE_NORMAL_VOLUME_GRADIENT, .half = true});
  add("OccupiedCell", {.normal = OGIVE_NORMAL_OCCUPIED_CELL, .half = true});
  add("LogisticRegression", {.normal = OGIVE_NORMAL_LOGISTIC_REGRESSION, .half = true});
  add("RigidFree", {.formulation = OGIVE_FORMULATION_RIGID_FREE});
  add("RigidFreeStressLast", {.method = OGIVE_CONTACT_HUANG_SECOND, .order = OGIVE_UPDATE_STRESS_LAST, .formulation = OGIVE_FORMULATION_RIGID_FREE});
  add("RigidPrescribed", {.formulation = OGIVE_FORMULATION_RIGID_PRESCRIBED});
  add("TotalLagrangian", {.formulation = OGIVE_FORMULATION_TOTAL_LAGRANGIAN});
  return cases;
}

}  // namespace

TEST_P(Resting, PartsThatNothingHasReachedAreLeftOutWithoutChangingABit) { compare(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Scheme, Resting, testing::ValuesIn(schemes()), name_of);
INSTANTIATE_TEST_SUITE_P(Law, Resting, testing::ValuesIn(laws()), name_of);
INSTANTIATE_TEST_SUITE_P(Surroundings, Resting, testing::ValuesIn(surroundings()), name_of);
INSTANTIATE_TEST_SUITE_P(Impact, Resting, testing::ValuesIn(strikes()), name_of);

TEST(RestingParticles, AreWokenByAHostThatSetsTheirVelocityStressForceOrPlace) {
  struct Setting {
    const char* field;
    int components, component;
    double value;
    bool moves;
  };
  for (const Setting& set : {Setting{"velocity", 3, 1, 3, true}, Setting{"stress", 6, 0, 50, true}, Setting{"affine_velocity", 9, 4, 2, true},
                             Setting{"force", 3, 2, 40, true}, Setting{"energy", 1, 0, 30, false}, Setting{"volume_ratio", 1, 0, 0.99, true},
                             Setting{"position", 3, 0, 0, false}, Setting{"plastic_strain", 1, 0, 0.1, false}}) {
    SCOPED_TRACE(set.field);
    Bar bar;
    bar.law = failing_aluminium();
    Scene skipping = built(bar, true), computing = built(bar, false);
    step_both(skipping, computing, 5);
    const std::vector<double> positions = skipping.field({1}, "position");
    for (Scene* scene : {&skipping, &computing}) {
      const std::size_t size = static_cast<std::size_t>(set.components);
      std::vector<double> values(positions.size() / 3 * size, 0.0);
      const std::string field(set.field);
      if (field != "force") values = scene->field({1}, set.field);
      for (std::size_t p = 0; p < positions.size() / 3; ++p) {
        const double x = positions[3 * p];
        if (x < 120 || x > 122) continue;
        double& value = values[size * p + static_cast<std::size_t>(set.component)];
        value = field == "position" ? value + 0.05 : set.value;
      }
      scene->set_field({1}, set.field, values);
    }
    step_both(skipping, computing, 10);
    expect_same_saves(skipping, computing);
    // It began there, not with the wave from the hammer.
    const std::vector<double> velocity = skipping.field({1}, "velocity");
    double there = 0, between = 0;
    for (std::size_t p = 0; p < positions.size() / 3; ++p) {
      const double speed = std::abs(velocity[3 * p]) + std::abs(velocity[3 * p + 1]) + std::abs(velocity[3 * p + 2]);
      if (positions[3 * p] > 119 && positions[3 * p] < 123) there = std::max(there, speed);
      if (positions[3 * p] > 70 && positions[3 * p] < 76) between = std::max(between, speed);
    }
    EXPECT_TRUE(!set.moves || there > 1e-3) << there;
    EXPECT_EQ(between, 0);
    EXPECT_GT(part_left_out(skipping), 0.2);
  }
}

TEST(RestingParticles, ThatNothingHasReachedAreExactlyAsTheyWereGiven) {
  Scene scene = built(Bar{}, true);
  const auto before = scene.all_fields();
  scene.steps(20);
  const auto after = scene.all_fields();
  const std::vector<double>& position = before.at("bar/position");
  int far = 0;
  for (const auto& [name, values] : before) {
    if (name.rfind("bar/", 0) != 0) continue;
    const std::size_t particles = position.size() / 3, components = values.size() / particles;
    for (std::size_t p = 0; p < particles; ++p) {
      if (position[3 * p] < 100) continue;
      ++far;
      EXPECT_TRUE(same_bits(&values[components * p], &after.at(name)[components * p], components * sizeof(double)))
          << name << " of particle " << p;
    }
  }
  EXPECT_GT(far, 1000);
}

TEST(RestingParticles, AreNoneUnderGravityAndWhereContactIsBySurfaces) {
  for (const bool surface : {false, true}) {
    const Build build = [&](Scene& scene, bool skip, std::int32_t) {
      scene.grid(1, {-6, -2, -2}, {62, 4, 4})
          .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4, surface ? Vec3{} : Vec3{0, 0, -1e-3}, 1, {}, OGIVE_UPDATE_STRESS_FIRST, {}, 2, {}, skip);
      if (surface) scene.wall({0, 0, 0}, {0, 0, 1}, 0, {}, OGIVE_CONTACT_PERSISTENT, OGIVE_DETECTION_SURFACE);
      scene.box("bar", scene.material("steel", steel()), {0, 0, 0.1}, {60, 2, 2}, 0.5, {0, 0, 0});
    };
    Scene skipping = built(build, true), computing = built(build, false);
    step_both(skipping, computing, 5);
    EXPECT_EQ(skipping.progress().resting_particle_steps, 0);
    expect_same_saves(skipping, computing);
    std::string plan(4000, ' ');
    skipping.check(ogive_world_plan(skipping.get(), plan.data(), plan.size(), nullptr));
    EXPECT_NE(plan.find(surface ? "computed as all others (contact by surfaces" : "computed as all others (gravity"), std::string::npos)
        << plan;
  }
}

TEST(RestingParticles, GoOnToTheSameBitsWhenTheChoiceIsChangedHalfway) {
  const Bar bar;
  Scene changed = built(bar, true), straight = built(bar, true);
  step_both(changed, straight, 10);
  changed.check(ogive_world_reopen(changed.get()));
  ogive_numerics_def def;
  ogive_numerics_def_init(&def, sizeof def);
  def.time_step_factor = 0.4;
  def.skip_resting = 0;
  changed.check(ogive_world_set_numerics(changed.get(), &def));
  changed.prepare();
  const std::int64_t left_out = changed.progress().resting_particle_steps;
  EXPECT_GT(left_out, 0);
  step_both(changed, straight, 10);
  EXPECT_EQ(changed.progress().resting_particle_steps, left_out);
  expect_same_saves(changed, straight);
}

TEST(RestingParticles, ThatMoveByGravityForAWhileRestNoMore) {
  const Bar bar{.length = 60};
  Scene skipping = built(bar, true), computing = built(bar, false);
  for (const double gravity : {1e-3, 0.0})
    for (Scene* scene : {&skipping, &computing}) {
      scene->check(ogive_world_reopen(scene->get()));
      ogive_numerics_def def;
      ogive_numerics_def_init(&def, sizeof def);
      def.time_step_factor = 0.4;
      def.gravity[2] = gravity;
      def.skip_resting = scene == &skipping;
      scene->check(ogive_world_set_numerics(scene->get(), &def));
      scene->prepare();
      scene->steps(5);
    }
  EXPECT_EQ(skipping.progress().resting_particle_steps, 0);
  expect_same_saves(skipping, computing);
}
