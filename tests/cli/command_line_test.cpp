// The command line: help, versions, wrong options, --set from a shell, check, voxelise.
#include <gtest/gtest.h>

#include "program.hpp"

namespace {

using namespace cli_test;

std::string data(const std::string& name) { return (std::filesystem::path(OGIVE_CLI_DATA) / name).string(); }

TEST(CommandLine, help_of_everything) {
  const ScratchDirectory scratch;
  const Outcome general = run_program(scratch.path(), {"--help"});
  EXPECT_EQ(general.exit_code, 0);
  EXPECT_EQ(general.errors, "");
  for (const char* command : {"run", "restart", "check", "study", "voxelise", "info"}) {
    EXPECT_NE(general.output.find(std::string("  ") + command + ' '), std::string::npos);
    const Outcome outcome = run_program(scratch.path(), {command, "--help"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.output.find(std::string("Usage: ogive ") + command), 0U);
    EXPECT_NE(outcome.output.find("Exit codes:"), std::string::npos);
    EXPECT_NE(outcome.output.find("--help"), std::string::npos);
  }
  EXPECT_NE(run_program(scratch.path(), {"run", "--help"}).output.find("--until"), std::string::npos);
}

TEST(CommandLine, version) {
  const Outcome outcome = run_program(".", {"--version"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output.find("ogive "), 0U);
}

TEST(CommandLine, wrong_ones_give_code_2_and_one_line) {
  const std::vector<std::vector<std::string>> wrong = {{},
                                                       {"rnu", "scene.toml"},
                                                       {"run"},
                                                       {"run", "a.toml", "b.toml"},
                                                       {"run", "a.toml", "--colour"},
                                                       {"run", "a.toml", "--unti", "3"},
                                                       {"run", "a.toml", "--until", "soon"},
                                                       {"run", "a.toml", "--set"},
                                                       {"run", data("two_boxes.toml"), "-o", ""},
                                                       {"restart"},
                                                       {"study"},
                                                       {"study", "s.toml", "--jobs", "0"},
                                                       {"voxelise", "a.stl"},
                                                       {"voxelise", "a.stl", "--spacing", "0", "-o", "b.csv"}};
  for (const auto& arguments : wrong) {
    const Outcome outcome = run_program(".", arguments);
    EXPECT_EQ(outcome.exit_code, 2) << testing::PrintToString(arguments);
    EXPECT_EQ(count_of(outcome.errors, "\n"), 1U) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
  }
  EXPECT_NE(run_program(".", {"rnu"}).errors.find("did you mean \"run\"?"), std::string::npos);
}

TEST(CommandLine, check_prints_the_plan_and_writes_nothing) {
  const ScratchDirectory scratch;
  const Outcome outcome = run_program(scratch.path(), {"check", data("two_boxes.toml")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  for (const char* part :
       {"two boxes collide", "plan:", "bodies:", "left: soft, 512 particles", "right: soft, 288 particles",
        "particles: 800", "memory: ", "steps: about ", "time: about "}) {
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part << "\nis not in\n" << outcome.output;
  }
  EXPECT_TRUE(names_in(scratch.path()).empty());
}

TEST(CommandLine, settings_from_a_shell_need_no_quoting) {
  const ScratchDirectory scratch;
  const std::string command = "ogive run " + data("two_boxes.toml") +
                              " --set parameters.V0=30 --set contact.method=\"huang_first\" --set title=other"
                              " --set bodies.left.velocity.0=V0/2 --until 0.004 --output results";
  const Outcome outcome = run_in_shell(scratch.path(), command);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const nlohmann::json summary = read_json(scratch / "results" / "summary.json");
  EXPECT_EQ(summary.at("parameters").at("V0"), 30.0);
  EXPECT_EQ(summary.at("title"), "other");
  EXPECT_EQ(summary.at("time"), 0.004);
  EXPECT_NEAR(summary.at("bodies").at("left").at("initial_speed"), 15.0, 1e-10);
}

TEST(CommandLine, an_instruction_set_that_is_not_there_is_refused) {
  const ScratchDirectory scratch;
  const std::string check = " ogive check " + data("two_boxes.toml");
  const Outcome refused = run_in_shell(scratch.path(), "OGIVE_ISA=x86-64-v9" + check);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.errors.find("OGIVE_ISA (environment): must be an instruction set that this processor and this build have ("),
            std::string::npos)
      << refused.errors;
  EXPECT_NE(refused.errors.find("generic), got \"x86-64-v9\""), std::string::npos) << refused.errors;
  const Outcome generic = run_in_shell(scratch.path(), "OGIVE_ISA=generic" + check);
  EXPECT_EQ(generic.exit_code, 0) << generic.errors;
}

TEST(CommandLine, voxelise_writes_particles_that_a_scene_can_use) {
  const ScratchDirectory scratch;
  const Outcome outcome =
      run_program(scratch.path(), {"voxelise", data("cube.stl"), "--spacing", "0.5", "--scale", "2", "-o", "cube.csv"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("512 particles"), std::string::npos) << outcome.output;
  EXPECT_EQ(count_of(read_file(scratch / "cube.csv"), "\n"), 513U);
  write_file(
      scratch / "scene.toml",
      scene_text("two_boxes.toml",
                 {{"box = { size = [4.0, 4.0, 4.0], centre = [-2.3, 0.0, 0.0] }\nspacing = 0.5\nvelocity = [\"V0\"",
                   "particles = \"cube.csv\"\nvelocity = [\"V0\""},
                  {"centre = [2.3, 0.3, 0.0]", "centre = [4.5, 0.3, 0.0]"}}));
  const Outcome checked = run_program(scratch.path(), {"check", "scene.toml"});
  EXPECT_EQ(checked.exit_code, 0) << checked.errors;
  EXPECT_NE(checked.output.find("left: soft, 512 particles, mass 0.064 g"), std::string::npos) << checked.output;
}

}  // namespace
