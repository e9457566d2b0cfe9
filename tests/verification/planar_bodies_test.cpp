// Two-dimensional models: sections of bodies, rigid bodies, walls and loads, and what is refused.
#include "scene.hpp"

using namespace verification;

namespace {

constexpr double pi = 3.141592653589793238;

ogive_solid_def solid_along(std::int32_t kind, Vec3 centre, Vec3 size, Vec3 axis, double spacing) {
  ogive_solid_def def = Scene::solid(kind, centre, size, spacing);
  for (int c = 0; c < 3; ++c) def.axis[c] = axis[c];
  return def;
}

Scene world(std::int32_t space, double thickness = 1) {
  Scene scene;
  scene.grid(1, {space == OGIVE_SPACE_AXISYMMETRIC ? 0.0 : -30.0, -30, 0}, {30, 30, 0}, {}, space, thickness);
  return scene;
}

double mass_of(std::int32_t space, const ogive_solid_def& solid, double thickness = 1) {
  Scene scene = world(space, thickness);
  scene.add("body", Scene::body(scene.material("unit", elastic(1, 1, 0.3)), {}), solid);
  scene.prepare();
  return scene.ledger().mass;
}

// The message of the call that fails.
template <class Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(PlanarBodies, SectionsHaveTheMassOfTheBodiesThatTheyStandFor) {
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, down{0, -1, 0}, z{0, 0, 1}, aslant{1, 1, 0};
  const double rod = [] {  // of the whole rod in three dimensions
    Scene scene;
    scene.grid(1, {-30, -30, -30}, {30, 30, 30});
    scene.add("body", Scene::body(scene.material("unit", elastic(1, 1, 0.3)), {}),
              solid_along(OGIVE_SOLID_OGIVE_ROD, {}, {4, 20, 3}, {0, 0, 1}, 1));
    scene.prepare();
    return scene.ledger().mass;
  }();
  struct Case {
    std::int32_t space;
    ogive_solid_def solid;
    double mass;
  };
  const std::int32_t ring = OGIVE_SPACE_AXISYMMETRIC, plane = OGIVE_SPACE_PLANE_STRAIN;
  const std::vector<Case> cases = {
      {ring, solid_along(OGIVE_SOLID_CYLINDER, {0, 3, 0}, {5, 8, 0}, y, 0.4), pi * 25 * 8},
      {ring, solid_along(OGIVE_SOLID_CYLINDER, {0, 3, 0}, {5, 8, 2}, y, 0.4), pi * (25 - 4) * 8},
      {ring, solid_along(OGIVE_SOLID_CYLINDER, {0, 3, 0}, {5, 8, 0}, x, 0.4), pi * 16 * 10},
      {ring, solid_along(OGIVE_SOLID_CYLINDER, {12, 3, 0}, {5, 8, 2}, z, 0.4), 2 * pi * 12 * pi * (25 - 4)},
      {ring, solid_along(OGIVE_SOLID_CYLINDER, {12, 3, 0}, {2, 8, 0}, aslant, 0.4), 2 * pi * 12 * 4 * 8},
      {ring, solid_along(OGIVE_SOLID_SPHERE, {0, 0, 0}, {5, 0, 0}, y, 0.4), 4.0 / 3.0 * pi * 125},
      {ring, solid_along(OGIVE_SOLID_SPHERE, {9, 0, 0}, {5, 0, 0}, y, 0.4), 2 * pi * 9 * pi * 25},
      {ring, solid_along(OGIVE_SOLID_OGIVE_ROD, {0, 0, 0}, {4, 20, 3}, down, 0.4), rod},
      {ring, Scene::solid(OGIVE_SOLID_BOX, {0, 0, 0}, {9, 4, 1}, 0.4), pi * 4.5 * 4.5 * 4},
      {ring, Scene::solid(OGIVE_SOLID_BOX, {10, 0, 0}, {9, 4, 1}, 0.4), 2 * pi * 10 * 36},
      {plane, solid_along(OGIVE_SOLID_CYLINDER, {1, 3, 0}, {5, 8, 2}, z, 0.4), 2.5 * pi * (25 - 4)},
      {plane, solid_along(OGIVE_SOLID_CYLINDER, {1, 3, 0}, {5, 8, 2}, aslant, 0.4), 2.5 * 8 * 6},
      {plane, solid_along(OGIVE_SOLID_BOX, {1, 3, 0}, {5, 8, 2}, y, 0.4), 2.5 * 5 * 2},
  };
  for (const Case& c : cases)
    EXPECT_NEAR(mass_of(c.space, c.solid, c.space == plane ? 2.5 : 1) / c.mass, 1, 1e-12)
        << "solid " << c.solid.solid << " at " << c.solid.centre[0];
  // The rod's section against a fine sum of its outline.
  double area = 0;
  const double rho = 24, nose = 4 * std::sqrt(4 * 3.0 - 1);
  const int strips = 200000;
  for (int i = 0; i < strips; ++i) {
    const double d = (i + 0.5) * nose / strips;
    area += 2 * (std::sqrt(rho * rho - (nose - d) * (nose - d)) - (rho - 4)) * nose / strips;
  }
  area += 8 * (20 - nose);
  EXPECT_NEAR(mass_of(plane, solid_along(OGIVE_SOLID_OGIVE_ROD, {}, {4, 20, 3}, aslant, 0.4)) / area, 1, 1e-9);
}

TEST(PlanarBodies, BodiesMayTouchButNotOverlap) {
  for (const std::int32_t space : {OGIVE_SPACE_PLANE_STRAIN, OGIVE_SPACE_AXISYMMETRIC})
    for (const double shift : {0.0, 2.0}) {
      const std::string message = refusal([&] {
        Scene scene = world(space);
        const ogive_material_id material = scene.material("steel", steel());
        scene.box("lower", material, {2, -4, -1}, {6, 0, 1}, 0.5, {});
        scene.box("upper", material, {2, -shift, -1}, {6, 4 - shift, 1}, 0.5, {});
        scene.prepare();
      });
      if (shift == 0)
        EXPECT_EQ(message, "");
      else
        EXPECT_NE(message.find("must not overlap"), std::string::npos) << message;
    }
}

TEST(PlanarBodies, WhatLeavesThePlaneIsRefusedByName) {
  const auto in = [](std::int32_t space, auto&& call) {
    return refusal([&] {
      Scene scene = world(space);
      const ogive_material_id material = scene.material("steel", steel());
      call(scene, material);
      scene.prepare();
    });
  };
  const std::int32_t ring = OGIVE_SPACE_AXISYMMETRIC, plane = OGIVE_SPACE_PLANE_STRAIN;
  const ogive_solid_def box = Scene::solid(OGIVE_SOLID_BOX, {5, 0, 0}, {4, 4, 4}, 0.5);
  const auto body = [&](Vec3 velocity, Vec3 angular = {}) {
    return [=](Scene& scene, ogive_material_id m) { scene.add("body", Scene::body(m, velocity, angular), box); };
  };
  const auto solid = [&](const ogive_solid_def& def) {
    return [=](Scene& scene, ogive_material_id m) { scene.add("body", Scene::body(m, {}), def); };
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {in(plane, body({0, 0, 1})), "velocity[z]"},
      {in(plane, body({}, {1, 0, 0})), "angular_velocity[x]"},
      {in(ring, body({1, 0, 0})), "velocity[x]"},
      {in(ring, body({}, {0, 0, 1})), "angular_velocity[z]"},
      {in(plane, solid(Scene::solid(OGIVE_SOLID_BOX, {5, 0, 1}, {4, 4, 4}, 0.5))), "centre[2]"},
      {in(plane, solid(solid_along(OGIVE_SOLID_CYLINDER, {}, {2, 4, 0}, {0, 1, 1}, 0.5))), "axis"},
      {in(plane, solid(solid_along(OGIVE_SOLID_BOX, {}, {2, 4, 3}, {0, 1, 1}, 0.5))), "axis"},
      {in(plane, solid(solid_along(OGIVE_SOLID_OGIVE_ROD, {}, {2, 14, 3}, {0, 0, 1}, 0.5))), "axis"},
      {in(ring, solid(solid_along(OGIVE_SOLID_OGIVE_ROD, {9, 0, 0}, {2, 14, 3}, {0, 1, 0}, 0.5))), "centre[0]"},
      {in(ring, solid(solid_along(OGIVE_SOLID_SPHERE, {3, 0, 0}, {4, 0, 0}, {0, 1, 0}, 0.5))), "centre[0]"},
      {in(plane,
          [&](Scene& s, ogive_material_id m) {
            s.numerics(1, 0.5, {0, 0, -9.81}).add("b", Scene::body(m, {}), box);
          }),
       "gravity[z]"},
      {in(ring,
          [&](Scene& s, ogive_material_id m) {
            s.numerics(1, 0.5, {1, 0, 0}).add("b", Scene::body(m, {}), box);
          }),
       "gravity[x]"},
      {in(plane,
          [&](Scene& s, ogive_material_id m) {
            s.wall({0, -9, 0}, {0, 1, 1}).add("b", Scene::body(m, {}), box);
          }),
       "wall normal[z]"},
      {in(plane,
          [&](Scene& s, ogive_material_id m) {
            s.contact(OGIVE_CONTACT_PERSISTENT, OGIVE_DETECTION_SURFACE).add("b", Scene::body(m, {}), box);
          }),
       "contact detection"},
      {in(plane,
          [&](Scene& s, ogive_material_id m) {
            const ogive_body_def def = Scene::body(m, {});
            const double xyz[] = {1, 1, 0.5}, volume[] = {1};
            s.check(ogive_body_add_particles(s.get(), "b", &def, 1, xyz, volume, nullptr));
          }),
       "position[z]"},
      {in(ring,
          [&](Scene& s, ogive_material_id m) {
            const ogive_body_def def = Scene::body(m, {});
            const double xyz[] = {0, 1, 0}, volume[] = {1};
            s.check(ogive_body_add_particles(s.get(), "b", &def, 1, xyz, volume, nullptr));
          }),
       "position[x]"},
      {refusal([] {
         Scene().grid(1, {-1, 0, 0}, {5, 5, 0}, {}, OGIVE_SPACE_AXISYMMETRIC);
       }),
       "domain_min[x]"},
      {refusal([] {
         Scene().grid(1, {0, 0, 0}, {5, 5, 0}, {}, 3);
       }),
       "space"},
      {refusal([] {
         Scene().grid(1, {0, 0, 0}, {5, 5, 0}, {}, OGIVE_SPACE_PLANE_STRAIN, 0);
       }),
       "thickness"},
  };
  for (std::size_t i = 0; i < cases.size(); ++i)
    EXPECT_NE(cases[i].first.find(cases[i].second), std::string::npos)
        << "case " << i << ": expected " << cases[i].second << " in \"" << cases[i].first << '"';

  Scene scene = world(ring);
  const ogive_body_id ball = scene.add("body", Scene::body(scene.material("steel", steel()), {}), box);
  scene.prepare();
  for (const char* name : {"velocity", "position", "stress", "affine_velocity", "force"}) {
    std::vector<double> values = std::string(name) == "force"
                                     ? std::vector<double>(scene.field(ball, "velocity").size())
                                     : scene.field(ball, name);
    EXPECT_EQ(refusal([&] { scene.set_field(ball, name, values); }), "") << name;
    values[std::string(name) == "stress" ? 3 : 2] = 0.25;
    EXPECT_NE(refusal([&] { scene.set_field(ball, name, values); }).find("two-dimensional"), std::string::npos) << name;
  }
}

TEST(PlanarBodies, AFreeRigidBodyOfRevolutionFallsAndIsCaughtByAWall) {
  Scene scene = world(OGIVE_SPACE_AXISYMMETRIC);
  scene.numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5, {0, -10, 0}, 1, {}, OGIVE_UPDATE_STRESS_FIRST, 0.001)
      .wall({0, -5, 0}, {0, 1, 0});
  // A ring off the axis must not move inwards or outwards, whatever pushes it.
  const ogive_body_id ring =
      scene.add("ring", Scene::rigid(scene.material("steel", steel()), OGIVE_FORMULATION_RIGID_FREE, {}),
                Scene::solid(OGIVE_SOLID_BOX, {6, 0, 0}, {4, 4, 1}, 0.5));
  scene.prepare();
  scene.advance(0.5);
  EXPECT_NEAR(scene.result(ring).velocity[1], -5, 1e-9);
  EXPECT_NEAR(scene.result(ring).centre[1], -1.25, 0.01);
  scene.advance(1.5);
  measured("velocity_at_rest", scene.result(ring).velocity[1]);
  measured("lowest", scene.result(ring).lower[1]);
  EXPECT_NEAR(scene.result(ring).velocity[1], 0, 0.02);
  EXPECT_NEAR(scene.result(ring).lower[1], -4.75, 0.5);
  EXPECT_NEAR(scene.result(ring).lower[0], 4.25, 1e-12);
  EXPECT_EQ(scene.result(ring).angular_velocity[2], 0);
  const ogive_ledger ledger = scene.ledger();
  EXPECT_NEAR(ledger.momentum[1], ledger.external_impulse[1] + ledger.boundary_impulse[1],
              1e-9 * std::abs(ledger.external_impulse[1]));
}

TEST(PlanarBodies, ARigidPunchDrivesABarAndAFreeBlockTurnsInItsPlane) {
  Scene scene = world(OGIVE_SPACE_PLANE_STRAIN, 2);
  scene.numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5).contact(OGIVE_CONTACT_PERSISTENT);
  const ogive_material_id material = scene.material("steel", steel());
  scene.add("punch", Scene::rigid(material, OGIVE_FORMULATION_RIGID_PRESCRIBED, {20, 0, 0}),
            Scene::solid(OGIVE_SOLID_BOX, {-6, 0, 0}, {4, 4, 1}, 0.5));
  const ogive_body_id block = scene.add("block", Scene::rigid(material, OGIVE_FORMULATION_RIGID_FREE, {}),
                                        Scene::solid(OGIVE_SOLID_BOX, {0, 3, 0}, {6, 8, 1}, 0.5));
  const ogive_body_id bar =
      scene.add("bar", Scene::body(material, {}), Scene::solid(OGIVE_SOLID_BOX, {8, 3, 0}, {9, 4, 1}, 0.5));
  scene.prepare();
  scene.advance(0.2);
  const ogive_body_result turned = scene.result(block);
  measured("spin", turned.angular_velocity[2]);
  measured("bar_velocity", scene.result(bar).velocity[0]);
  EXPECT_GT(turned.angular_velocity[2], 0.1);  // pushed below its centre
  EXPECT_EQ(turned.angular_velocity[0], 0);
  EXPECT_EQ(turned.velocity[2], 0);
  EXPECT_GT(scene.result(bar).velocity[0], 1);
  EXPECT_EQ(scene.result(bar).upper[2], 0);
  const ogive_ledger ledger = scene.ledger();
  for (int c = 0; c < 2; ++c)
    EXPECT_NEAR(ledger.momentum[c] - ledger.boundary_impulse[c], 7.85e-3 * 16 * 2 * (c == 0 ? 20 : 0), 1e-10);
}

TEST(PlanarBodies, ATractionGivesARingItsForce) {
  Scene scene = world(OGIVE_SPACE_AXISYMMETRIC);
  scene.numerics(OGIVE_SHAPE_GIMP, 0.5);
  const ogive_body_id body = scene.add("disc", Scene::body(scene.material("steel", steel()), {}),
                                       solid_along(OGIVE_SOLID_CYLINDER, {}, {6, 4, 0}, {0, 1, 0}, 0.5));
  ogive_load_def load;
  ogive_load_def_init(&load, sizeof load);
  load.kind = OGIVE_LOAD_TRACTION;
  load.region = OGIVE_REGION_BOX;
  load.body = body;
  const double low[] = {0, 1.5, -1}, high[] = {9, 2, 1};
  std::copy(low, low + 3, load.a);
  std::copy(high, high + 3, load.b);
  load.value[1] = -7;
  load.area = pi * 36;
  ogive_load_id id{-1};
  scene.check(ogive_load_add(scene.get(), &load, &id));
  scene.prepare();
  scene.advance(0.01);
  const ogive_ledger ledger = scene.ledger();
  EXPECT_NEAR(ledger.momentum[1] / (-7 * pi * 36 * 0.01), 1, 1e-12);
  EXPECT_NEAR(ledger.external_impulse[1], ledger.momentum[1], 1e-12 * std::abs(ledger.momentum[1]));
  EXPECT_LE(std::abs(ledger.residual) / ledger.kinetic, 1e-3);
  const double aslant[] = {0, 0, 1};
  EXPECT_NE(refusal([&] { scene.check(ogive_load_set(scene.get(), id, aslant)); }).find("value[z]"), std::string::npos);
}

TEST(PlanarBodies, AHollowCylinderUnderRadialLoadKeepsItsFormOfEquilibrium) {
  // Lame's tube: inner pressure p as a radial force on the innermost layer, brought up slowly and damped by the
  // transfer; the outer surface moves by u = 2 p r_i^2 r_o (1 - nu^2) / (E (r_o^2 - r_i^2)) in plane strain.
  const double E = 1000, nu = 0.3, inner = 6, outer = 12, pressure = 1, length = 3;
  Scene scene;
  scene
      .grid(0.5, {0, 0, 0}, {15, length, 0}, {0, 0, OGIVE_FACE_SYMMETRY, OGIVE_FACE_SYMMETRY, 0, 0},
            OGIVE_SPACE_AXISYMMETRIC)
      .numerics(OGIVE_SHAPE_GIMP, 0.5, {}, 1, OGIVE_TRANSFER_APIC);
  const ogive_body_id tube =
      scene.add("tube", Scene::body(scene.material("soft", elastic(1e-3, E, nu)), {}),
                solid_along(OGIVE_SOLID_CYLINDER, {0, length / 2, 0}, {outer, length, inner}, {0, 1, 0}, 0.25));
  ogive_load_def load;
  ogive_load_def_init(&load, sizeof load);
  load.kind = OGIVE_LOAD_TRACTION;
  load.region = OGIVE_REGION_BOX;
  load.body = tube;
  load.a[1] = -1, load.a[2] = -1;
  load.b[0] = inner + 0.25, load.b[1] = length + 1, load.b[2] = 1;
  load.area = 2 * pi * inner * length;
  ogive_load_id id{-1};
  scene.check(ogive_load_add(scene.get(), &load, &id));
  scene.prepare();
  const double before = scene.result(tube).upper[0], ramp = 0.5;
  for (int i = 1; i <= 100; ++i) {
    const double value[] = {pressure * std::min(1.0, i / 80.0), 0, 0};
    scene.check(ogive_load_set(scene.get(), id, value));
    scene.advance(i * ramp / 100);
  }
  const double moved = scene.result(tube).upper[0] - before;
  const double exact = 2 * pressure * inner * inner * outer * (1 - nu * nu) / (E * (outer * outer - inner * inner));
  measured("displacement_over_exact", moved / exact);
  EXPECT_NEAR(moved / exact, 1, 0.03);
}
