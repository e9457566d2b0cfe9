// A run whose model is changed on the way: what stays consistent is taken, what cannot be is refused by name.
#include <functional>

#include "impact.hpp"
#include "store.hpp"

using namespace verification;

namespace {

const Impact impact{.half_y = true, .off_centre = 1.5};
constexpr int before = 60, after = 60;  // steps; some particles have failed in the first ones

void reopen(Scene& scene) { scene.check(ogive_world_reopen(scene.get())); }

// What the impact's world is refused as by ogive_world_prepare, once changed.
std::string refusal(Scene& scene, const std::function<void()>& change) {
  reopen(scene);
  change();
  EXPECT_EQ(ogive_world_prepare(scene.get()), OGIVE_ERROR_ARGUMENT);
  return ogive_world_message(scene.get());
}

ogive_numerics_def numerics_of_impact() {
  ogive_numerics_def def;
  ogive_numerics_def_init(&def, sizeof def);
  def.time_step_factor = 0.4;
  return def;
}

}  // namespace

TEST(Change, OfNothingLeavesEveryBit) {
  Scene straight = impact.build(), reopened = impact.build();
  straight.steps(before + after);
  reopened.steps(before);
  reopen(reopened);
  reopened.prepare();
  reopened.steps(after);
  expect_same_bits(straight, reopened);
}

TEST(Change, AfterALoadEqualsTheSameChangeInTheRun) {
  Scene straight = impact.build(), loaded;
  straight.steps(before);
  Store store;
  store.save(straight);
  store.load(loaded);
  for (Scene* scene : {&straight, &loaded}) {
    reopen(*scene);
    scene->contact(OGIVE_CONTACT_HUANG_FIRST, OGIVE_DETECTION_GAP, 0.3);
    scene->prepare();
    scene->steps(after);
  }
  expect_same_bits(straight, loaded);
  Scene unchanged = impact.build();
  unchanged.steps(before + after);
  EXPECT_NE(straight.ledger().friction_dissipation, unchanged.ledger().friction_dissipation);
}

TEST(Change, OfHardeningIsFeltFromThePresentPlasticStrainOn) {
  // A yield stress ten times as high: the plate, which yielded, goes on elastically; the present yield stress of every particle
  // is that of the new law at its own strain, so that no particle is beyond its yield surface by the old one.
  Scene scene = impact.build();
  scene.steps(before);
  const double dissipated = scene.ledger().plastic_dissipation;
  ogive_material_def hard = impact.plate();
  hard.yield_stress *= 10;  // above the shock that is on its way
  reopen(scene);
  scene.check(ogive_material_change(scene.get(), {1}, &hard));
  scene.prepare();
  scene.steps(after);
  Scene unchanged = impact.build();
  unchanged.steps(before + after);
  const double more = scene.ledger().plastic_dissipation - dissipated,
               usual = unchanged.ledger().plastic_dissipation - dissipated;
  measured("plastic work after the change by that without it", more / usual);  // 0.85 was measured
  EXPECT_LT(more, 0.95 * usual);
  EXPECT_NEAR(scene.ledger().residual_relative, unchanged.ledger().residual_relative, 5e-3);
}

TEST(Change, LeavesQueriesToTheModelAsItWasUntilItIsPrepared) {
  // The model to come has fields that the state lacks.
  Scene scene = impact.build();
  scene.steps(1);
  const auto fields = scene.all_fields();
  ogive_material_def other = steel();
  other.strength = OGIVE_STRENGTH_NEO_HOOKEAN;
  reopen(scene);
  scene.check(ogive_material_change(scene.get(), {0}, &other));
  EXPECT_EQ(scene.all_fields(), fields);
  double value = 0;
  EXPECT_EQ(ogive_field_get(scene.get(), {0}, "deformation_gradient", &value, 1), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(ogive_world_prepare(scene.get()), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(scene.all_fields(), fields);
}

TEST(Change, OfTheTimeStepFactorScalesTheNextStep) {
  Scene scene = impact.build();
  scene.steps(before);
  const double dt = scene.stable_time_step();
  ogive_numerics_def def = numerics_of_impact();
  def.time_step_factor = 0.2;
  reopen(scene);
  scene.check(ogive_world_set_numerics(scene.get(), &def));
  scene.prepare();
  EXPECT_NEAR(scene.stable_time_step(), 0.5 * dt, 1e-15 * dt);
}

TEST(Change, ThatCannotBeConsistentIsRefusedByNameAndCanBeTakenBack) {
  Scene scene = impact.build();
  scene.steps(before);
  ASSERT_GT(scene.result({1}).failed_particles, 0);
  const auto material = [&](const std::function<void(ogive_material_def&)>& edit) {
    return refusal(scene, [&] {
      ogive_material_def def = impact.plate();
      edit(def);
      scene.check(ogive_material_change(scene.get(), {1}, &def));
    });
  };
  const auto take_back = [&] {
    const ogive_material_def def = impact.plate();
    const ogive_numerics_def numerics = numerics_of_impact();
    scene.check(ogive_material_change(scene.get(), {1}, &def));
    scene.check(ogive_world_set_numerics(scene.get(), &numerics));
    scene.prepare();
  };
  EXPECT_NE(material([](auto& m) { m.density *= 2; }).find("density: cannot be changed"), std::string::npos);
  take_back();
  EXPECT_NE(material([](auto& m) { m.youngs_modulus *= 2; }).find("modulus: cannot be changed"), std::string::npos);
  take_back();
  EXPECT_NE(material([](auto& m) { m.gruneisen = 1; }).find("gruneisen: cannot be changed"), std::string::npos);
  take_back();
  EXPECT_NE(material([](auto& m) { m.thermal_exponent = 0; }).find("thermal softening"), std::string::npos);
  take_back();
  EXPECT_NE(material([](auto& m) { m.failure_strain = 5; }).find("would be whole again"), std::string::npos);
  take_back();
  for (const auto& [edit, word] : std::vector<std::pair<std::function<void(ogive_numerics_def&)>, std::string>>{
           {[](auto& n) { n.transfer = OGIVE_TRANSFER_FLIP; }, "transfer"},
           {[](auto& n) { n.update_order = OGIVE_UPDATE_STRESS_LAST; }, "update_order"}}) {
    const auto change = [&] {
      ogive_numerics_def def = numerics_of_impact();
      edit(def);
      scene.check(ogive_world_set_numerics(scene.get(), &def));
    };
    EXPECT_NE(refusal(scene, change).find(word + ": cannot be changed"), std::string::npos);
    take_back();
  }
  scene.steps(after);
  Scene straight = impact.build();
  straight.steps(before + after);
  expect_same_bits(straight, scene);
}

// A surface that no rule asked for has not moved with its body.
TEST(Change, ToContactByASurfaceThatHasNotMovedIsRefused) {
  Scene scene;
  scene.grid(1, {-6, -6, -6}, {6, 6, 6});
  const ogive_material_id metal = scene.material("metal", steel());
  const ogive_body_id ball = scene.add("ball", Scene::rigid(metal, OGIVE_FORMULATION_RIGID_FREE, {0, 0, -5}),
                                       Scene::solid(OGIVE_SOLID_SPHERE, {0, 0, 3}, {2, 0, 0}, 0.5));
  const ogive_body_id block = scene.box("block", metal, {-3, -3, -1}, {3, 3, 0.9}, 0.5, {0, 0, 0});
  ogive_body_def lagrangian = Scene::body(metal, {0, 0, 0});
  lagrangian.formulation = OGIVE_FORMULATION_TOTAL_LAGRANGIAN;
  scene.add("bar", lagrangian, Scene::solid(OGIVE_SOLID_BOX, {0, 0, -3.5}, {4, 4, 3}, 0.5));
  const ogive_contact_def by_surface = Scene::contact_def(OGIVE_CONTACT_PERSISTENT, OGIVE_DETECTION_SURFACE);
  scene.check(ogive_contact_set_pair(scene.get(), ball, block, &by_surface));
  scene.prepare();
  scene.steps(10);
  const std::string words = refusal(scene, [&] { scene.check(ogive_world_set_contact(scene.get(), &by_surface)); });
  EXPECT_NE(words.find("contact detection: cannot be changed"), std::string::npos) << words;
  EXPECT_NE(words.find("\"bar\""), std::string::npos) << words;
}
