// Wrong scenes and meshes: each ends with exit code 2 and one message that names place, value and expectation, and
// leaves nothing behind.
#include <gtest/gtest.h>

#include "program.hpp"

namespace {

using namespace cli_test;
using Replacements = std::vector<std::pair<std::string, std::string>>;

struct WrongInput {
  std::string name;
  Replacements replacements;           // in two_boxes.toml
  std::vector<std::string> arguments;  // after the scene
  std::vector<std::string> expected;   // parts of the message, its beginning first
};

std::ostream& operator<<(std::ostream& stream, const WrongInput& input) { return stream << input.name; }

const std::string kLeftBox = "box = { size = [4.0, 4.0, 4.0], centre = [-2.3, 0.0, 0.0] }";
const std::string kRightBox = "box = { size = [4.0, 3.0, 3.0], centre = [2.3, 0.3, 0.0] }";

const std::vector<WrongInput> kWrongInputs = {
    {"unknown_key",
     {{"density = 1.0e-3", "desnity = 1.0e-3"}},
     {},
     {"scene.toml:28:1: materials.soft.desnity: unknown key; did you mean \"density\"?"}},
    {"negative_density",
     {{"density = 1.0e-3", "density = -7850"}},
     {},
     {"scene.toml:28:11: materials.soft.density: must be > 0, got -7850"}},
    {"not_a_number",
     {{"density = 1.0e-3", "density = nan"}},
     {},
     {"scene.toml:28:11: materials.soft.density: must be finite, got nan"}},
    {"expression_that_is_not_finite",
     {{"velocity = [\"V0\", 0.0, 0.0]", "velocity = [\"V0/0\", 0.0, 0.0]"}},
     {},
     {"scene.toml:41:13: bodies.left.velocity[0]: must be finite, got inf from \"V0/0\""}},
    {"expression_of_an_unknown_name",
     {{"velocity = [\"V0\", 0.0, 0.0]", "velocity = [\"V1\", 0.0, 0.0]"}},
     {},
     {"scene.toml:41:13: bodies.left.velocity[0]: ", "\"V1\" is unknown; did you mean \"V0\"?"}},
    {"zero_cell_size",
     {{"cell_size = 1.0", "cell_size = 0.0"}},
     {},
     {"scene.toml:14:13: grid.cell_size: must be > 0, got 0"}},
    {"wrong_type",
     {{"cell_size = 1.0", "cell_size = [1.0]"}},
     {},
     {"scene.toml:14:13: grid.cell_size: must be a number, got a list"}},
    {"missing_key",
     {{"cell_size = 1.0\n", ""}},
     {},
     {"scene.toml:13:1: grid.cell_size: missing; expected a number > 0"}},
    {"domain_upside_down",
     {{"upper = [8.0, 4.0, 4.0]", "upper = [8.0, -4.5, 4.0]"}},
     {},
     {"scene.toml:16:15: grid.upper[1]: must be > grid.lower[1] (-4), got -4.5"}},
    {"unknown_unit",
     {{"length = \"mm\"", "length = \"furlong\""}},
     {},
     {"scene.toml:9:10: units.length: must be one of m, cm, mm, um, in, ft, got \"furlong\""}},
    {"unknown_material",
     {{"material = \"soft\"", "material = \"sofd\""}},
     {},
     {"scene.toml:38:12: bodies.left.material: must be the name of a material of the scene (soft), got \"sofd\"; did "
      "you "
      "mean \"soft\"?"}},
    {"no_strength",
     {{"[materials.soft.j2_power]", "[materials.soft.viscosity]"}},
     {},
     {"scene.toml:27:1: materials.soft: needs exactly one of"}},
    {"syntax_error", {{"cell_size = 1.0", "cell_size = = 1.0"}}, {}, {"scene.toml:14:13: not valid TOML: "}},
    {"bad_method_name",
     {},
     {"--set", "contact.method=huang_frist"},
     {"--set contact.method=huang_frist: contact.method: must be one of single_field, huang_first, huang_second, "
      "york, hu_chen, bardenhagen_2000, bardenhagen_2001, pan_2008, persistent, got \"huang_frist\"; did you mean \"huang_first\"?"}},
    {"bad_normal",
     {},
     {"--set", "contact.normal=averge"},
     {"--set contact.normal=averge: contact.normal: must be one of master, average, volume_gradient, occupied_cell, "
      "logistic_regression, got \"averge\"; did you mean \"average\"?"}},
    {"xpic_order_without_xpic",
     {},
     {"--set", "numerics.xpic_order=3"},
     {"--set numerics.xpic_order=3: numerics.xpic_order: needs transfer = \"xpic\""}},
    {"skip_resting_as_a_number",
     {},
     {"--set", "numerics.skip_resting=2"},
     {"--set numerics.skip_resting=2: numerics.skip_resting: must be true or false, got the number 2"}},
    {"bad_set_path",
     {},
     {"--set", "contact.methd=huang_first"},
     {"--set contact.methd=huang_first: contact.methd: unknown key; did you mean \"method\"?"}},
    {"set_without_value", {}, {"--set", "contact.method"}, {"--set contact.method: expected path.to.key=value"}},
    {"set_inside_a_number",
     {},
     {"--set", "stop.time.x=1"},
     {"--set stop.time.x=1: \"x\" cannot be set inside the number"}},
    {"negative_until", {}, {"--until", "-1"}, {"--until -1: stop.time: must be > 0, got -1"}},
    {"too_many_threads",
     {},
     {"--threads", "5000"},
     {"--threads 5000: numerics.threads: must be a whole number from 0 to"}},
    {"body_outside_the_domain",
     {{kRightBox, "box = { size = [4.0, 3.0, 3.0], centre = [7.25, 0.3, 0.0] }"}},
     {},
     {"scene.toml:43:1: bodies.right: "}},
    {"overlapping_bodies",
     {{kRightBox, "box = { size = [4.0, 3.0, 3.0], centre = [0.0, 0.3, 0.0] }"}},
     {},
     {"scene.toml:43:1: bodies.right: "}},
    {"missing_mesh",
     {{kLeftBox, "mesh = \"nowhere.stl\""}},
     {},
     {"scene.toml:39:8: bodies.left.mesh: ", "nowhere.stl"}},
    {"open_mesh", {{kLeftBox, "mesh = \"open_cube.stl\""}}, {}, {"scene.toml:39:8: bodies.left.mesh: ", "edge"}},
    {"foreign_mesh", {{kLeftBox, "mesh = \"scene.toml\""}}, {}, {"scene.toml:39:8: bodies.left.mesh: ", "scene.toml"}},
    {"empty_body_spacing_too_large",
     {{kLeftBox + "\nspacing = 0.5", "mesh = \"cube.stl\"\nspacing = 5.0"}},
     {},
     {"scene.toml:39:8: bodies.left.mesh: ", "spacing"}},
    {"negative_spacing",
     {{"spacing = 0.5", "spacing = -0.5"}},
     {},
     {"scene.toml:40:11: bodies.left.spacing: must be > 0"}},
    {"missing_particles",
     {{kLeftBox + "\nspacing = 0.5", "particles = \"nowhere.csv\""}},
     {},
     {"scene.toml:39:13: bodies.left.particles: ", "nowhere.csv", "expected a CSV file of x,y,z,volume"}},
    {"wrong_particles",
     {{kLeftBox + "\nspacing = 0.5", "particles = \"wrong.csv\""}},
     {},
     {"scene.toml:39:13: bodies.left.particles: ", "wrong.csv:3: expected four numbers x,y,z,volume, got \"1,2,x,4\""}},
    {"two_shapes",
     {{"spacing = 0.5", "spacing = 0.5\nsphere = { radius = 1 }"}},
     {},
     {"scene.toml:37:1: bodies.left: needs exactly one of mesh, box, ", "got box, sphere"}},
    {"no_bodies", {{"[bodies.left]", "[bodies]\n[[clamps]]"}, {"[bodies.right]", "[[clamps]]"}}, {}, {"scene.toml:"}},
    {"unknown_body_in_results",
     {{"results.residual_velocity = \"left\"", "results.residual_velocity = \"lift\""}},
     {},
     {"scene.toml:55:29: output.results.residual_velocity: must be the name of a body of the scene (left, right), got "
      "\"lift\"; did you mean \"left\"?"}},
    {"face_off_the_grid",
     {{"upper = [8.0, 4.0, 4.0]", "upper = [8.0, 4.0, 4.3]\nfaces = { z_max = \"symmetry\" }"}},
     {},
     {"scene.toml:13:1: grid: "}},
    {"poisson_ratio_of_an_incompressible_body",
     {{"poisson_ratio = 0.3", "poisson_ratio = 0.5"}},
     {},
     {"scene.toml:32:17: materials.soft.j2_power.poisson_ratio: must be > -1 and < 0.5, got 0.5"}},
};

class BadInput : public testing::TestWithParam<WrongInput> {
 protected:
  void SetUp() override {
    for (const char* file : {"cube.stl", "open_cube.stl"}) {
      write_file(scratch_ / file, read_file(std::filesystem::path(OGIVE_CLI_DATA) / file));
    }
    write_file(scratch_ / "wrong.csv", "x,y,z,volume\n0,0,0,1\n1,2,x,4\n");
    write_file(scratch_ / "scene.toml", scene_text("two_boxes.toml", GetParam().replacements));
  }
  ScratchDirectory scratch_;
};

TEST_P(BadInput, one_clear_message_and_nothing_left) {
  const std::vector<std::string> before = names_in(scratch_.path());
  std::vector<std::string> arguments = {"run", "scene.toml", "--output", "results"};
  arguments.insert(arguments.end(), GetParam().arguments.begin(), GetParam().arguments.end());
  const Outcome outcome = run_program(scratch_.path(), arguments);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(count_of(outcome.errors, "\n"), 1U) << outcome.errors;
  EXPECT_EQ(outcome.errors.find(GetParam().expected.front()), 0U) << outcome.errors;
  for (const std::string& part : GetParam().expected) {
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << part << "\nis not in: " << outcome.errors;
  }
  EXPECT_EQ(names_in(scratch_.path()), before);
  std::cout << outcome.errors;
}

INSTANTIATE_TEST_SUITE_P(Scene, BadInput, testing::ValuesIn(kWrongInputs),
                         [](const auto& information) { return information.param.name; });

TEST(Refusal, missing_scene) {
  const ScratchDirectory scratch;
  const Outcome outcome = run_program(scratch.path(), {"run", "nowhere.toml"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.errors, "nowhere.toml: cannot be read; expected a scene file (TOML)\n");
  EXPECT_TRUE(names_in(scratch.path()).empty());
}

TEST(Refusal, check_refuses_the_same) {
  const ScratchDirectory scratch;
  write_file(scratch / "scene.toml", scene_text("two_boxes.toml", {{"density = 1.0e-3", "density = 0"}}));
  const Outcome outcome = run_program(scratch.path(), {"check", "scene.toml"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.errors, "scene.toml:28:11: materials.soft.density: must be > 0, got 0\n");
}

TEST(Refusal, voxelise_refuses_an_open_mesh) {
  const ScratchDirectory scratch;
  write_file(scratch / "open.stl", read_file(std::filesystem::path(OGIVE_CLI_DATA) / "open_cube.stl"));
  const Outcome outcome = run_program(scratch.path(), {"voxelise", "open.stl", "--spacing", "0.5", "-o", "out.csv"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(count_of(outcome.errors, "\n"), 1U) << outcome.errors;
  EXPECT_EQ(names_in(scratch.path()), std::vector<std::string>{"open.stl"});
}

TEST(Refusal, foreign_checkpoint) {
  const ScratchDirectory scratch;
  write_file(scratch / "foreign.h5", "this is not HDF5");
  for (const char* command : {"restart", "info"}) {
    const Outcome outcome = run_program(scratch.path(), {command, "foreign.h5"});
    EXPECT_EQ(outcome.exit_code, 5) << command;
    EXPECT_EQ(count_of(outcome.errors, "\n"), 1U) << outcome.errors;
    EXPECT_EQ(count_of(outcome.errors, "foreign.h5"), 1U) << outcome.errors;
    EXPECT_EQ(run_program(scratch.path(), {command, "nowhere.h5"}).exit_code, 4) << command;
  }
  EXPECT_EQ(names_in(scratch.path()), std::vector<std::string>{"foreign.h5"});
}

}  // namespace
