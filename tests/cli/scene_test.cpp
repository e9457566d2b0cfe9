// Scenes are read without an engine: values, expressions, --set, and every message with its place.
#include "scene.hpp"

#include <gtest/gtest.h>
#include <ogive.h>

#include <cmath>

#include "expression.hpp"
#include "failure.hpp"
#include "mesh_section.hpp"
#include "text.hpp"

namespace {

using driver::Document;
using driver::Failure;
using driver::Scene;

constexpr const char* kScene = R"toml([units]
length = "mm"
time = "ms"
mass = "g"
[parameters]
half = "V0/2"
V0 = 100
[grid]
cell_size = 1
lower = [0, 0, 0]
upper = [10, 10, 10]
[materials.zinc]
density = 1
[materials.zinc.elastic]
youngs_modulus = 10
poisson_ratio = 0.25
[bodies.target]
material = "zinc"
box = { size = [1, 1, 1], centre = [5, 5, 5] }
spacing = 0.5
[bodies.ball]
material = "zinc"
sphere = { radius = 1 }
spacing = [0.5, 0.25, 0.5]
velocity = ["half*cos(60*deg)", "-V0", 1.5]
[stop]
time = 2
)toml";

Scene scene_of(const std::vector<std::pair<std::string, std::string>>& settings = {}, const std::string& more = "") {
  Document document = Document::from_text(kScene + more, "scene.toml");
  for (const auto& [path, value] : settings) document.set(path, value, "--set " + path + "=" + value);
  return driver::read_scene(document, "scene.toml");
}

/// The message that reading ends with, "" if it does not.
std::string refusal(const std::vector<std::pair<std::string, std::string>>& settings, const std::string& more = "") {
  try {
    scene_of(settings, more);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), driver::kExitInput);
    return failure.what();
  }
  return "";
}

TEST(Scene, values_and_expressions) {
  const Scene scene = scene_of();
  EXPECT_EQ(scene.grid.cell_size, 1.0);
  EXPECT_EQ(scene.parameters.at("half"), 50.0);
  ASSERT_EQ(scene.bodies.size(), 2U);
  EXPECT_EQ(scene.bodies[0].name, "target");  // the order of the file, not of the alphabet
  EXPECT_NEAR(scene.bodies[1].velocity[0], 25.0, 1e-13);
  EXPECT_EQ(scene.bodies[1].velocity[1], -100.0);
  EXPECT_EQ(scene.bodies[1].velocity[2], 1.5);
  const auto& ball = std::get<driver::SolidShape>(scene.bodies[1].shape);
  EXPECT_EQ(ball.solid, OGIVE_SOLID_SPHERE);
  EXPECT_EQ(ball.spacing[1], 0.25);
  EXPECT_EQ(scene.stop.time, 2.0);
  EXPECT_EQ(scene.units.speed(), "m/s");
  EXPECT_EQ(scene.units.energy(), "mJ");
}

TEST(Scene, thick_plate_example) {
  const std::string file = std::string(OGIVE_SCENES) + "/thick_plate/scene.toml";
  const Document document = Document::from_file(file, {"parameters.V0=400", "contact.method=huang_first"});
  const Scene scene = driver::read_scene(document, file);
  EXPECT_EQ(scene.contact.method, OGIVE_CONTACT_HUANG_FIRST);
  EXPECT_EQ(scene.bodies[0].name, "rod");
  EXPECT_NEAR(scene.bodies[0].velocity[0], 200.0, 1e-12);
  EXPECT_EQ(scene.grid.faces[2], OGIVE_FACE_SYMMETRY);
  EXPECT_EQ(std::get<driver::MeshShape>(scene.bodies[0].shape).file,
            std::filesystem::path(OGIVE_SCENES) / "thick_plate/rod.stl");
  ASSERT_EQ(scene.output.results.size(), 1U);
  EXPECT_EQ(scene.output.results[0].name, "residual_velocity");
  EXPECT_EQ(scene.output.results[0].body, "rod");
}

TEST(Scene, every_shape_function_has_a_name) {
  const std::string file = std::string(OGIVE_SCENES) + "/thick_plate/scene.toml";
  for (const auto& [name, value] : {std::pair{"linear", OGIVE_SHAPE_LINEAR},
                                    std::pair{"quadratic_bspline", OGIVE_SHAPE_QUADRATIC_BSPLINE},
                                    std::pair{"gimp", OGIVE_SHAPE_GIMP}}) {
    const Document document = Document::from_file(file, {std::string("numerics.shape_function=") + name});
    EXPECT_EQ(driver::read_scene(document, file).numerics.shape_function, value) << name;
  }
}

TEST(Scene, a_file_of_settings_is_merged_in_its_turn) {
  const std::string file = std::string(OGIVE_SCENES) + "/thick_plate/scene.toml";
  const std::string settings = std::string(OGIVE_SCENES) + "/../settings/huang2010.toml";
  const Document document =
      Document::from_file(file, {"contact.gap_offset=0.5", "@" + settings, "numerics.pic_fraction=0.01"});
  const Scene scene = driver::read_scene(document, file);
  EXPECT_EQ(scene.numerics.shape_function, OGIVE_SHAPE_LINEAR);
  EXPECT_EQ(scene.contact.gap_offset, 0.8);         // the file after what stood before it
  EXPECT_EQ(scene.numerics.pic_fraction, 0.01);     // what stands after it wins
  EXPECT_EQ(scene.contact.normal, OGIVE_NORMAL_MASTER);  // the scene's own, beside merged keys of the same table
  EXPECT_EQ(driver::place_of(document.places(), "contact.gap_offset"), settings + ":16:14");
  EXPECT_THROW(Document::from_file(file, {"@" + settings + ".absent"}), driver::Failure);
}

TEST(Scene, merged_text_reads_back_as_the_same_scene) {
  const Scene first =
      scene_of({{"stop.time", "0.1"}, {"title", "say \"hello\" \\ there"}, {"bodies.ball.velocity.2", "V0/3"}});
  const Scene second = driver::read_scene(Document::from_text(first.text, "copy"), "scene.toml");
  EXPECT_EQ(second.stop.time, 0.1);
  EXPECT_EQ(second.title, "say \"hello\" \\ there");
  EXPECT_EQ(second.parameters, first.parameters);
  EXPECT_EQ(second.text, first.text);
}

TEST(Scene, settings_are_toml_or_text) {
  EXPECT_EQ(scene_of({{"contact.method", "huang_first"}}).contact.method, OGIVE_CONTACT_HUANG_FIRST);
  EXPECT_EQ(scene_of({{"contact.method", "\"huang_first\""}}).contact.method, OGIVE_CONTACT_HUANG_FIRST);
  EXPECT_EQ(scene_of({{"stop.time", "3*V0"}}).stop.time, 300.0);
  EXPECT_EQ(scene_of({{"grid.upper", "[20, 20, 20]"}}).grid.upper[1], 20.0);
  EXPECT_EQ(scene_of({{"grid.upper.1", "30"}}).grid.upper[1], 30.0);
  EXPECT_EQ(scene_of({{"numerics.gravity", "[0, 0, -9.81]"}}).numerics.gravity[2], -9.81);
  EXPECT_EQ(scene_of({{"grid.faces.x_min", "fixed"}}).grid.faces[0], OGIVE_FACE_FIXED);
}

TEST(Scene, materials_of_every_law) {
  const Scene scene = scene_of({}, R"toml([materials.rubber]
density = 2
neo_hookean = { bulk_modulus = 5, shear_modulus = 1 }
viscosity = { linear = 0.06, quadratic = 1.5 }
[materials.copper]
density = 3
j2_power = { youngs_modulus = 10, poisson_ratio = 0.3, A = 1, B = 2, n = 0.5 }
failure = { plastic_strain = 1.5 }
[materials.steel]
density = 4
mie_gruneisen = { c0 = 1, s = 2, gamma0 = 3 }
[materials.steel.johnson_cook]
youngs_modulus = 10
poisson_ratio = 0.3
A = 1
C = 0.01
reference_strain_rate = 0.001
m = 1
melt_temperature = 1800
specific_heat = 400
)toml");
  ASSERT_EQ(scene.materials.size(), 4U);
  EXPECT_EQ(scene.materials[1].strength, OGIVE_STRENGTH_NEO_HOOKEAN);
  EXPECT_EQ(scene.materials[1].viscosity_quadratic, 1.5);
  EXPECT_EQ(scene.materials[2].strength, OGIVE_STRENGTH_J2_POWER);
  EXPECT_EQ(scene.materials[2].failure_strain, 1.5);
  EXPECT_EQ(scene.materials[3].strength, OGIVE_STRENGTH_JOHNSON_COOK);
  EXPECT_EQ(scene.materials[3].equation_of_state, OGIVE_EOS_MIE_GRUNEISEN);
  EXPECT_EQ(scene.materials[3].gruneisen, 3.0);
}

TEST(Scene, contact_pairs_and_clamps) {
  const Scene scene = scene_of({{"contact.friction", "0.2"}}, R"toml([[contact.pairs]]
bodies = ["ball", "target"]
friction = 0.5
normal = "master"
master = "ball"
[[clamps]]
region = "box"
lower = [0, 0, 0]
upper = [1, 1, 1]
body = "target"
axes = "xz"
[[clamps]]
region = "outside_cylinder"
centre = [5, 5, 5]
axis = [0, 0, 2]
radius = 4
)toml");
  ASSERT_EQ(scene.contact_pairs.size(), 1U);
  EXPECT_EQ(scene.contact.friction, 0.2);
  EXPECT_EQ(scene.contact_pairs[0].rule.friction, 0.5);
  EXPECT_EQ(scene.contact_pairs[0].rule.master, "ball");
  ASSERT_EQ(scene.clamps.size(), 2U);
  EXPECT_EQ(scene.clamps[0].axes, 5);
  EXPECT_EQ(scene.clamps[1].axes, 7);
  EXPECT_EQ(scene.clamps[1].radius, 4.0);
}

TEST(Scene, messages_name_place_key_value_and_expectation) {
  EXPECT_EQ(refusal({{"materials.zinc.density", "-7850"}}),
            "--set materials.zinc.density=-7850: materials.zinc.density: must be > 0, got -7850");
  EXPECT_EQ(refusal({{"grid.cell_sise", "1"}}),
            "--set grid.cell_sise=1: grid.cell_sise: unknown key; did you mean \"cell_size\"? "
            "(known here: cell_size, lower, upper, faces, space, thickness)");
  EXPECT_EQ(refusal({{"stop.time", "nan"}}), "--set stop.time=nan: stop.time: must be finite, got nan");
  EXPECT_EQ(refusal({{"stop.time", "V1*2"}}),
            "--set stop.time=V1*2: stop.time: must be a number or an expression, got \"V1*2\": the name \"V1\" is "
            "unknown; did you mean \"V0\"? (known: V0, half, deg, pi)");
  EXPECT_EQ(refusal({{"grid.upper.1", "-1"}}),
            "--set grid.upper.1=-1: grid.upper[1]: must be > grid.lower[1] (0), got -1");
  EXPECT_EQ(refusal({{"contact.method", "huang_frist"}}),
            "--set contact.method=huang_frist: contact.method: must be one of single_field, huang_first, huang_second, "
            "york, hu_chen, bardenhagen_2000, bardenhagen_2001, pan_2008, persistent, got \"huang_frist\"; did you mean \"huang_first\"?");
  EXPECT_EQ(
      refusal({{"bodies.ball.material", "zink"}}),
      "--set bodies.ball.material=zink: bodies.ball.material: must be the name of a material of the scene (zinc), "
      "got \"zink\"; did you mean \"zinc\"?");
  EXPECT_EQ(refusal({{"units.length", "furlong"}}),
            "--set units.length=furlong: units.length: must be one of m, cm, mm, um, in, ft, got \"furlong\"");
}

TEST(Scene, messages_give_line_and_column) {
  EXPECT_EQ(refusal({}, "when = 3\n"),
            "scene.toml:28:1: stop.when: unknown key (known here: time, body, settle_window, "
            "settle_tolerance, stop_when_stopped, stop_when_out, exchange_window, exchange_tolerance, max_steps)");
  EXPECT_EQ(refusal({}, "[output]\nhistory_interval = 0\n"),
            "scene.toml:29:20: output.history_interval: must be > 0, got 0");
  EXPECT_EQ(refusal({}, "[numerics\n").substr(0, 32), "scene.toml:28:10: not valid TOML");
  EXPECT_EQ(refusal({}, "[materials.lead]\ndensity = 1\n").substr(0, 40), "scene.toml:28:1: materials.lead: needs e");
}

TEST(Scene, refuses_what_does_not_go_together) {
  EXPECT_NE(refusal({{"bodies.ball.box.size", "[1,1,1]"}}).find("needs exactly one of mesh, box"), std::string::npos);
  EXPECT_NE(refusal({{"bodies.ball.scale", "2"}}).find("bodies.ball.scale: unknown key"), std::string::npos);
  EXPECT_NE(refusal({{"materials.zinc.elastic.bulk_modulus", "2"}}).find("got some of both"), std::string::npos);
  EXPECT_NE(refusal({{"stop.settle_window", "2"}}).find("needs stop.body"), std::string::npos);
  EXPECT_NE(refusal({{"stop.exchange_tolerance", "0.1"}}).find("needs stop.exchange_window"), std::string::npos);
  EXPECT_NE(refusal({{"stop.exchange_window", "1"}, {"stop.exchange_tolerance", "1"}}).find("must be > 0 and < 1, got 1"),
            std::string::npos);
  EXPECT_NE(refusal({{"numerics.drop_debris", "1"}}).find("numerics.drop_debris"), std::string::npos);
  EXPECT_NE(refusal({{"parameters.pi", "3"}}).find("constant of its own"), std::string::npos);
  EXPECT_NE(refusal({{"parameters.V0", "half+1"}}).find("in a circle"), std::string::npos);
  EXPECT_NE(refusal({{"numerics.threads", "1.5"}}).find("must be a whole number from 0 to 1024, got 1.5"),
            std::string::npos);
  EXPECT_NE(refusal({{"grid.lower", "7"}}).find("must be a list of 3 numbers, got the number 7"), std::string::npos);
  EXPECT_NE(refusal({{"bodies", "{}"}}).find("must hold at least one body"), std::string::npos);
  EXPECT_NE(refusal({{"bodies.ball.velocity", "[1, 2]"}}).find("must be a list of 3 numbers, got 2"),
            std::string::npos);
}

TEST(Scene, has_two_dimensions_where_the_grid_says_so) {
  EXPECT_EQ(scene_of({}).grid.space, OGIVE_SPACE_THREE_DIMENSIONAL);
  const Scene plane = scene_of({{"grid.space", "plane_strain"}, {"grid.thickness", "2*half"},
                                {"grid.upper.2", "0"}});
  EXPECT_EQ(plane.grid.space, OGIVE_SPACE_PLANE_STRAIN);
  EXPECT_EQ(plane.grid.thickness, 2 * plane.parameters.at("half"));
  EXPECT_EQ(scene_of({{"grid.space", "axisymmetric"}}).grid.space, OGIVE_SPACE_AXISYMMETRIC);
  EXPECT_NE(refusal({{"grid.thickness", "2"}}).find("grid.thickness: needs space = \"plane_strain\""), std::string::npos);
  EXPECT_NE(refusal({{"grid.space", "axisymetric"}}).find("did you mean \"axisymmetric\""), std::string::npos);
}

namespace {

// A prism from y = -1 to 1 over a ring of n points (x, z), closed by fans; corners counter-clockwise from outside.
void prism(const std::vector<std::array<double, 2>>& ring, std::vector<double>& vertices, std::vector<int32_t>& corners) {
  const int32_t n = static_cast<int32_t>(ring.size());
  for (const double y : {-1.0, 1.0})
    for (const auto& [x, z] : ring) vertices.insert(vertices.end(), {x, y, z});
  for (int32_t i = 0; i < n; ++i) {
    const int32_t next = (i + 1) % n;
    corners.insert(corners.end(), {i, n + i, n + next, i, n + next, next});
    if (i > 0 && next > 0) corners.insert(corners.end(), {0, i, next, n, n + next, n + i});
  }
}

}  // namespace

TEST(MeshSection, has_the_area_and_the_volume_of_revolution_of_the_surface) {
  // A cylinder of 256 sides about y whose vertices lie in the plane too; then a bar beside the axis.
  std::vector<std::array<double, 2>> ring;
  for (int i = 0; i < 256; ++i) ring.push_back({3 * std::cos(i * M_PI / 128), 3 * std::sin(i * M_PI / 128)});
  std::vector<double> vertices;
  std::vector<int32_t> corners;
  prism(ring, vertices, corners);
  const auto sum = [](const driver::ParticleList& particles) {
    double total = 0;
    for (const double volume : particles.volumes) total += volume;
    return total;
  };
  const driver::ParticleList plane = driver::fill_mesh_section(vertices, corners, {0, 0}, {0.25, 0.5}, {false, 7}, "mesh");
  EXPECT_EQ(plane.volumes.size(), 24U * 4);
  EXPECT_NEAR(sum(plane), 6 * 2 * 7, 1e-10);
  const driver::ParticleList rings = driver::fill_mesh_section(vertices, corners, {0, 0}, {0.25, 0.5}, {true, 1}, "mesh");
  EXPECT_EQ(rings.volumes.size(), 12U * 4);
  EXPECT_NEAR(sum(rings), M_PI * 9 * 2, 1e-10);
  for (size_t p = 0; p < rings.volumes.size(); ++p) {
    EXPECT_NEAR(rings.volumes[p], 2 * M_PI * rings.positions[3 * p] * 0.25 * 0.5, 1e-12);
    EXPECT_EQ(rings.positions[3 * p + 2], 0);
  }
  for (size_t v = 0; v < vertices.size(); v += 3) vertices[v] += 10;
  EXPECT_NEAR(sum(driver::fill_mesh_section(vertices, corners, {0, 0}, {0.25, 0.5}, {true, 1}, "mesh")), 2 * M_PI * 10 * 12, 1e-9);
  const auto refusal_of = [&](double spacing) -> std::string {
    try {
      driver::fill_mesh_section(vertices, corners, {0, 0}, {spacing, 0.5}, {true, 1}, "mesh");
    } catch (const driver::Failure& failure) {
      return failure.what();
    }
    return "";
  };
  EXPECT_NE(refusal_of(1000).find("no particle centre"), std::string::npos);
  EXPECT_NE(refusal_of(1e-12).find("spacing"), std::string::npos);
  for (size_t v = 2; v < vertices.size(); v += 3) vertices[v] += 10;
  EXPECT_NE(refusal_of(0.25).find("cut by the plane"), std::string::npos);
}

TEST(Setting, path_must_lead_somewhere) {
  EXPECT_NE(refusal({{"grid.cell_size.x", "1"}}).find("cannot be set inside the number 1"), std::string::npos);
  EXPECT_NE(refusal({{"grid.lower.3", "1"}}).find("cannot be set inside a list"), std::string::npos);
  EXPECT_NE(refusal({{"grid..lower", "1"}}).find("expected path.to.key=value"), std::string::npos);
  EXPECT_NE(refusal({{"", "1"}}).find("expected path.to.key=value"), std::string::npos);
}

TEST(Expression, evaluates_or_says_why_not) {
  driver::Expressions expressions;
  EXPECT_EQ(expressions.define("a", 3), "");
  std::string problem;
  EXPECT_EQ(expressions.evaluate("a^2 + 1e1", problem), 19.0);
  EXPECT_EQ(problem, "");
  EXPECT_NEAR(expressions.evaluate("sin(30*deg) + pi", problem), 0.5 + M_PI, 1e-15);
  for (const char* wrong : {"a+", "b", "1, 2", "", "sin()", "(a", "a = 3"}) {
    expressions.evaluate(wrong, problem);
    EXPECT_NE(problem, "") << wrong;
  }
  EXPECT_NE(expressions.define("deg", 3), "");
  EXPECT_NE(expressions.define("two words", 3), "");
}

TEST(Text, nearest_word) {
  const std::vector<std::string> known = {"density", "elastic", "viscosity"};
  EXPECT_EQ(driver::nearest_word("desnity", known), "density");
  EXPECT_EQ(driver::nearest_word("Elastic", known), "elastic");
  EXPECT_EQ(driver::nearest_word("colour", known), "");
}

TEST(Text, numbers_for_people) {
  EXPECT_EQ(driver::grouped(1234567), "1 234 567");
  EXPECT_EQ(driver::grouped(-123), "-123");
  EXPECT_EQ(driver::grouped(-1234), "-1 234");
  EXPECT_EQ(driver::duration(245), "4 min 05 s");
  EXPECT_EQ(driver::duration(7380), "2 h 03 min");
  EXPECT_EQ(driver::bytes(1230000000), "1.23 GB");
  EXPECT_EQ(driver::shortest(0.1), "0.1");
  EXPECT_EQ(std::stod(driver::exact(0.1)), 0.1);
}

TEST(Scene, rigid_bodies_walls_and_pairs_with_methods_of_their_own) {
  const std::string more = R"toml([bodies.incline]
material = "zinc"
box = { size = [8, 2, 1], centre = [5, 5, 1], axis = ["-sin(30*deg)", 0, "cos(30*deg)"] }
spacing = 0.5
formulation = "rigid_prescribed"
[bodies.punch]
material = "zinc"
box = { size = [1, 1, 1], centre = [8, 8, 8] }
spacing = 0.5
formulation = "rigid_prescribed"
angular_centre = [8, 8, 8]
[[bodies.punch.motion]]
time = 0
[[bodies.punch.motion]]
time = "V0/50"
velocity = [0, 0, "-V0"]
angular_velocity = [0, 0, 1]
[contact]
method = "pan_2008"
normal = "occupied_cell"
friction = 0.25
[[contact.pairs]]
bodies = ["ball", "target"]
method = "york"
friction = 0
[[walls]]
point = [0, 0, 0.5]
normal = [0, "-sin(10*deg)", "cos(10*deg)"]
[[walls]]
point = [0, 0, 9]
normal = [0, 0, -1]
method = "huang_first"
friction = 0
)toml";
  const Scene scene = scene_of({{"bodies.ball.formulation", "rigid"}, {"numerics.transfer", "xpic"}, {"numerics.xpic_order", "5"}, {"numerics.skip_resting", "false"}}, more);
  EXPECT_EQ(scene.numerics.xpic_order, 5);
  EXPECT_EQ(scene.numerics.skip_resting, 0);
  EXPECT_EQ(scene.bodies[1].formulation, OGIVE_FORMULATION_RIGID_FREE);
  EXPECT_EQ(scene.bodies[2].formulation, OGIVE_FORMULATION_RIGID_PRESCRIBED);
  ASSERT_EQ(scene.bodies[3].motion.size(), 2U);
  EXPECT_EQ(scene.bodies[3].motion[1].time, 2.0);
  EXPECT_EQ(scene.bodies[3].motion[1].velocity[2], -100.0);
  EXPECT_EQ(scene.contact.method, OGIVE_CONTACT_PAN_2008);
  ASSERT_EQ(scene.contact_pairs.size(), 1U);
  EXPECT_EQ(scene.contact_pairs[0].rule.method, OGIVE_CONTACT_YORK);
  EXPECT_EQ(scene.contact_pairs[0].rule.normal, OGIVE_NORMAL_OCCUPIED_CELL);  // the scene's
  ASSERT_EQ(scene.walls.size(), 2U);
  EXPECT_EQ(scene.walls[0].rule.method, OGIVE_CONTACT_PAN_2008);
  EXPECT_EQ(scene.walls[0].rule.friction, 0.25);
  EXPECT_EQ(scene.walls[1].rule.method, OGIVE_CONTACT_HUANG_FIRST);
  EXPECT_EQ(refusal({{"bodies.ball.formulation", "rigd"}}),
            "--set bodies.ball.formulation=rigd: bodies.ball.formulation: must be one of deformable, rigid, "
            "rigid_prescribed, total_lagrangian, got \"rigd\"; did you mean \"rigid\"?");
  EXPECT_NE(refusal({}, "[[bodies.extra.motion]]\ntime = 0\n[bodies.extra]\nmaterial = \"zinc\"\nsphere = { radius = 1 }\n"
                        "spacing = 0.5\n").find("bodies.extra.motion: needs formulation = \"rigid_prescribed\""),
            std::string::npos);
  EXPECT_NE(refusal({}, "[[walls]]\npoint = [0, 0, 0]\n").find("walls[0].normal: missing"), std::string::npos);
}

}  // namespace
