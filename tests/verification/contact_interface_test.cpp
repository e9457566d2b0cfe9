// What the C interface refuses about contact, walls and rigid bodies, and what the plan says of them.
#include "scene.hpp"

using namespace verification;

namespace {

struct Setting {
  Scene scene;
  ogive_material_id metal;
  Setting() {
    scene.grid(1, {0, -4, -4}, {8, 4, 4}, {OGIVE_FACE_SYMMETRY, 0, 0, 0, 0, 0})
        .numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4);
    metal = scene.material("metal", elastic(2.7e-3, 69e3, 0.3));
  }
  // The message of a call that must fail.
  std::string refusal(ogive_status status) {
    EXPECT_EQ(status, OGIVE_ERROR_ARGUMENT);
    return ogive_world_message(scene.get());
  }
  ogive_body_id add(const char* name, const ogive_body_def& def, Vec3 centre) {
    return scene.add(name, def, Scene::solid(OGIVE_SOLID_BOX, centre, {2, 2, 2}, 0.5));
  }
};

}  // namespace

TEST(ContactInterface, RefusesWhatIsNoMethodRuleWallOrMotion) {
  Setting s;
  ogive_contact_def contact = Scene::contact_def(9);
  EXPECT_EQ(s.refusal(ogive_world_set_contact(s.scene.get(), &contact)), "contact method: must be 0..8, got 9");
  contact = Scene::contact_def(OGIVE_CONTACT_YORK, OGIVE_DETECTION_GAP, 0, 5);
  EXPECT_EQ(s.refusal(ogive_world_set_contact(s.scene.get(), &contact)), "contact normal: must be 0..4, got 5");
  ogive_wall_def wall;
  ogive_wall_def_init(&wall, sizeof wall);
  wall.normal[2] = 0;
  EXPECT_EQ(s.refusal(ogive_wall_add(s.scene.get(), &wall)), "wall normal: must be a direction that is not zero");
  wall.normal[2] = 3;
  wall.friction = -1;
  EXPECT_EQ(s.refusal(ogive_wall_add(s.scene.get(), &wall)), "wall friction: must be >= 0 and finite, got -1");
  const ogive_body_id soft = s.add("soft", Scene::body(s.metal, {0, 0, 0}), {3, 0, 0});
  const double times[] = {0, 1, 1};
  EXPECT_EQ(s.refusal(ogive_body_set_motion(s.scene.get(), soft, 3, times, nullptr, nullptr)),
            "body \"soft\": motion: needs the formulation OGIVE_FORMULATION_RIGID_PRESCRIBED");
  const ogive_body_id guided = s.add("guided", Scene::rigid(s.metal, OGIVE_FORMULATION_RIGID_PRESCRIBED, {0, 0, 0}), {6, 0, 0});
  EXPECT_EQ(s.refusal(ogive_body_set_motion(s.scene.get(), guided, 3, times, nullptr, nullptr)),
            "body \"guided\": motion time: must be above the one before it, 1, got 1");
  ogive_body_def def = Scene::rigid(s.metal, 4, {0, 0, 0});
  ogive_solid_def solid = Scene::solid(OGIVE_SOLID_BOX, {3, 0, 0}, {2, 2, 2}, 0.5);
  EXPECT_EQ(s.refusal(ogive_body_add_solid(s.scene.get(), "odd", &def, &solid, nullptr)),
            "body \"odd\": formulation: must be 0..3, got 4");
  ogive_clamp_def clamp;
  ogive_clamp_def_init(&clamp, sizeof clamp);
  clamp.body = guided;
  s.scene.check(ogive_clamp_add(s.scene.get(), &clamp));
  EXPECT_EQ(s.refusal(ogive_world_prepare(s.scene.get())),
            "clamp body: must be deformable (give a rigid body a prescribed motion instead), got \"guided\"");
}

TEST(ContactInterface, RefusesARigidMotionThatItsMirrorCannotFollow) {
  Setting s;
  ogive_body_def def = Scene::rigid(s.metal, OGIVE_FORMULATION_RIGID_FREE, {1, 0, 0});
  ogive_solid_def solid = Scene::solid(OGIVE_SOLID_BOX, {0, 0, 0}, {2, 2, 2}, 0.5);
  EXPECT_EQ(s.refusal(ogive_body_add_solid(s.scene.get(), "cut", &def, &solid, nullptr)),
            "body \"cut\": velocity and angular_velocity: must fit the x symmetry face that cuts the rigid body (no velocity "
            "across it, rotation about its normal alone)");
  def.velocity[0] = 0;
  def.velocity[1] = 2;
  s.scene.check(ogive_body_add_solid(s.scene.get(), "cut", &def, &solid, nullptr));
  EXPECT_EQ(s.refusal(ogive_world_prepare(s.scene.get())),
            "maximum_time_step: must be given where every body is rigid (no wave limits the step)");
}

TEST(ContactInterface, OlderCallersGetTheDefaultsOfWhatTheyDoNotKnow) {
  Setting s;
  ogive_body_def def = Scene::rigid(s.metal, 77, {0, 0, 0});
  def.struct_size = offsetof(ogive_body_def, formulation);  // as it was before rigid bodies
  ogive_solid_def solid = Scene::solid(OGIVE_SOLID_BOX, {3, 0, 0}, {2, 2, 2}, 0.5);
  ogive_body_id body{-1};
  s.scene.check(ogive_body_add_solid(s.scene.get(), "old", &def, &solid, &body));
  s.scene.prepare();
  EXPECT_NO_THROW(s.scene.field(body, "stress"));
}

TEST(ContactInterface, ThePlanSaysWhichMethodHoldsWhichPairAndWhatARigidBodyLeavesOut) {
  Setting s;
  s.scene.contact(OGIVE_CONTACT_PAN_2008, OGIVE_DETECTION_SHARED_NODE, 0.2, OGIVE_NORMAL_OCCUPIED_CELL);
  s.scene.wall({0, 0, -4}, {0, 0, 1}, 0.1);
  const ogive_body_id a = s.add("a", Scene::body(s.metal, {0, 0, 0}), {3, 0, 0});
  const ogive_body_id b = s.add("b", Scene::rigid(s.metal, OGIVE_FORMULATION_RIGID_FREE, {0, 0, 0}), {6, 0, 0});
  const ogive_contact_def york = Scene::contact_def(OGIVE_CONTACT_YORK, OGIVE_DETECTION_GAP, 0.3);
  s.scene.check(ogive_contact_set_pair(s.scene.get(), b, a, &york));
  s.scene.prepare();
  std::string plan(8000, ' ');
  std::size_t needed = 0;
  s.scene.check(ogive_world_plan(s.scene.get(), plan.data(), plan.size(), &needed));
  plan.resize(needed - 1);
  for (const char* part :
       {"contact: pan_2008, ", "normals: occupied_cell; at shared nodes; friction 0.2", "of \"a\" and \"b\": york, ",
        "caution: this method has no friction; the coefficient 0.3 is not used", "wall 0: huang_second, ",
        "body \"b\": 64 particles, mass 0.0216, rigid: moves freely", "left out: strain and stress (it is rigid)"})
    EXPECT_NE(plan.find(part), std::string::npos) << part << " in\n" << plan;
}
