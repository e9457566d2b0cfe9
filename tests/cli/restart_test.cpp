// A run that is stopped, killed or damaged goes on from a checkpoint and ends as if nothing had happened, to the bit.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "program.hpp"

namespace {

using namespace cli_test;
using namespace std::chrono_literals;

std::string scene_file() { return (std::filesystem::path(OGIVE_CLI_DATA) / "two_boxes.toml").string(); }

/// The small scene with steps so short that it takes a second or two.
std::vector<std::string> long_run(const std::string& directory) {
  return {"run",   scene_file(),
          "-o",    directory,
          "--set", "numerics.maximum_time_step=1e-5",
          "--set", "output.checkpoint_steps=100"};
}

std::filesystem::path newest_checkpoint(const std::filesystem::path& directory) {
  std::filesystem::path newest;
  for (const std::string& name : names_in(directory)) {
    const bool whole = name.rfind("checkpoint-", 0) == 0 && name.substr(name.size() - 3) == ".h5";
    if (whole) newest = directory / name;
  }
  return newest;
}

/// What must not depend on how often the run was interrupted.
nlohmann::json without_machine_figures(const std::filesystem::path& directory) {
  nlohmann::json summary = read_json(directory / "summary.json");
  for (const char* key : {"wall_seconds", "particle_steps_per_second", "peak_memory_bytes", "cpu_seconds"}) summary.erase(key);
  return summary;
}

void expect_same_results(const std::filesystem::path& directory, const std::filesystem::path& reference) {
  EXPECT_EQ(without_machine_figures(directory), without_machine_figures(reference));
  EXPECT_EQ(read_file(directory / "history.csv"), read_file(reference / "history.csv"));
  for (const std::string& name : names_in(reference)) {
    if (name.rfind("particles", 0) != 0) continue;
    EXPECT_TRUE(read_file(directory / name) == read_file(reference / name)) << name;
  }
  EXPECT_EQ(names_in(directory), names_in(reference));
}

class Restart : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    reference_ = new ScratchDirectory;
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(run_program(reference_->path(), long_run("results")).exit_code, 0);
    duration_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  static void TearDownTestSuite() { delete reference_; }
  static std::filesystem::path reference() { return *reference_ / "results"; }

  static void wait_for_checkpoint(RunningProgram& program, const std::filesystem::path& directory) {
    while (newest_checkpoint(directory).empty() && !program.ended()) std::this_thread::sleep_for(1ms);
  }

  ScratchDirectory scratch_;
  static ScratchDirectory* reference_;
  static double duration_;  // seconds of the whole run
};
ScratchDirectory* Restart::reference_ = nullptr;
double Restart::duration_ = 0;

TEST_F(Restart, after_a_signal) {
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    SCOPED_TRACE(signal);
    const std::string name = "results-" + std::to_string(signal);
    RunningProgram program(scratch_.path(), long_run(name));
    wait_for_checkpoint(program, scratch_ / name);
    program.send(signal);
    const Outcome interrupted = program.wait();
    ASSERT_EQ(interrupted.exit_code, 75) << interrupted.errors;
    EXPECT_NE(interrupted.output.find("to go on: ogive restart " + name + "/checkpoint-"), std::string::npos)
        << interrupted.output;
    EXPECT_FALSE(std::filesystem::exists(scratch_ / name / "summary.json"));

    const Outcome restarted = run_program(scratch_.path(), {"restart", newest_checkpoint(scratch_ / name).string()});
    ASSERT_EQ(restarted.exit_code, 0) << restarted.errors;
    // The checkpoint of the interruption stands among those that were kept, or has been removed by later ones.
    expect_same_results(scratch_ / name, reference());
  }
}

TEST_F(Restart, after_kill_at_a_random_time) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  for (int round = 0; round < 3; ++round) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
    const std::string name = "results-" + std::to_string(round);
    {
      RunningProgram program(scratch_.path(), long_run(name));
      wait_for_checkpoint(program, scratch_ / name);
      std::this_thread::sleep_for(
          std::chrono::duration<double>(std::uniform_real_distribution<double>(0.0, 0.8 * duration_)(random)));
      program.send(SIGKILL);
      program.wait();
    }
    const Outcome restarted = run_program(scratch_.path(), {"restart", name});
    ASSERT_EQ(restarted.exit_code, 0) << restarted.errors;
    expect_same_results(scratch_ / name, reference());
  }
}

TEST_F(Restart, into_another_directory_and_with_other_threads) {
  const std::filesystem::path checkpoint = newest_checkpoint(reference()).parent_path();
  std::filesystem::path middle;
  for (const std::string& name : names_in(checkpoint)) {
    if (name.rfind("checkpoint-", 0) == 0 && middle.empty()) middle = checkpoint / name;
  }
  const Outcome outcome =
      run_program(scratch_.path(), {"restart", middle.string(), "--output", "elsewhere", "--threads", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const nlohmann::json summary = read_json(scratch_ / "elsewhere" / "summary.json");
  EXPECT_EQ(summary.at("results"), read_json(reference() / "summary.json").at("results"));
  EXPECT_EQ(summary.at("bodies"), read_json(reference() / "summary.json").at("bodies"));
  EXPECT_EQ(summary.at("threads"), 2);
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "elsewhere" / "history.csv"));
  EXPECT_EQ(run_program(scratch_.path(), {"restart", middle.string(), "--output", "elsewhere"}).exit_code, 4);
}

TEST_F(Restart, refuses_a_damaged_checkpoint_and_takes_the_one_before) {
  std::filesystem::copy(reference(), scratch_ / "copy", std::filesystem::copy_options::recursive);
  const std::filesystem::path newest = newest_checkpoint(scratch_ / "copy");
  std::string content = read_file(newest);
  content[content.size() / 2] = static_cast<char>(content[content.size() / 2] ^ 0x10);
  write_file(newest, content);

  EXPECT_EQ(run_program(scratch_.path(), {"info", newest.string(), "--verify"}).exit_code, 5);
  const Outcome refused = run_program(scratch_.path(), {"restart", newest.string()});
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_EQ(count_of(refused.errors, "\n"), 1U) << refused.errors;
  EXPECT_NE(refused.errors.find("the one before it is "), std::string::npos) << refused.errors;

  const Outcome restarted = run_program(scratch_.path(), {"restart", "copy"});
  ASSERT_EQ(restarted.exit_code, 0) << restarted.errors;
  EXPECT_NE(restarted.output.find("refused: "), std::string::npos) << restarted.output;
  expect_same_results(scratch_ / "copy", reference());
}

TEST_F(Restart, refuses_a_history_that_is_not_its_own) {
  std::filesystem::copy(reference(), scratch_ / "copy", std::filesystem::copy_options::recursive);
  std::string history = read_file(scratch_ / "copy" / "history.csv");
  history[history.size() / 4] = '#';
  write_file(scratch_ / "copy" / "history.csv", history);
  const Outcome refused = run_program(scratch_.path(), {"restart", "copy"});
  EXPECT_EQ(refused.exit_code, 4);
  EXPECT_NE(refused.errors.find("is not the history that the checkpoint continues"), std::string::npos);
  EXPECT_EQ(read_file(scratch_ / "copy" / "history.csv"), history);
}

TEST_F(Restart, later_end_time) {
  std::filesystem::copy(reference(), scratch_ / "copy", std::filesystem::copy_options::recursive);
  const Outcome outcome = run_program(scratch_.path(), {"restart", "copy", "--until", "0.051"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(read_json(scratch_ / "copy" / "summary.json").at("time"), 0.051);
  EXPECT_EQ(run_program(scratch_.path(), {"restart", "copy", "--until", "0.01"}).exit_code, 2);
}

TEST_F(Restart, from_the_checkpoint_alone_without_scene_and_mesh) {
  write_file(scratch_ / "cube.stl", read_file(std::filesystem::path(OGIVE_CLI_DATA) / "cube.stl"));
  write_file(scratch_ / "scene.toml",
             scene_text("two_boxes.toml",
                        {{"box = { size = [4.0, 4.0, 4.0], centre = [-2.3, 0.0, 0.0] }",
                          "mesh = \"cube.stl\"\nposition = [-2.3, 0, 0]"}}));
  ASSERT_EQ(run_program(scratch_.path(), {"run", "scene.toml", "-o", "whole"}).exit_code, 0);
  const Outcome part = run_program(scratch_.path(), {"run", "scene.toml", "-o", "part", "--until", "0.02"});
  ASSERT_EQ(part.exit_code, 0) << part.errors;
  std::filesystem::create_directory(scratch_ / "elsewhere");
  for (const std::string& name : names_in(scratch_ / "part")) {
    if (name.rfind("checkpoint-", 0) == 0 && names_in(scratch_ / "elsewhere").empty())
      std::filesystem::copy(scratch_ / "part" / name, scratch_ / "elsewhere" / name);
  }
  for (const char* name : {"cube.stl", "scene.toml"}) std::filesystem::remove(scratch_ / name);
  std::filesystem::remove_all(scratch_ / "part");
  const Outcome restarted = run_program(scratch_ / "elsewhere", {"restart", ".", "--until", "0.05"});
  ASSERT_EQ(restarted.exit_code, 0) << restarted.errors;
  const nlohmann::json a = read_json(scratch_ / "elsewhere" / "summary.json"), b = read_json(scratch_ / "whole" / "summary.json");
  for (const char* key : {"bodies", "energy", "steps", "results"}) EXPECT_EQ(a.at(key), b.at(key)) << key;
}

TEST_F(Restart, with_other_output_changes_no_result) {
  std::filesystem::copy(reference(), scratch_ / "copy", std::filesystem::copy_options::recursive);
  const std::filesystem::path oldest = scratch_ / "copy" / names_in(reference()).front();
  const Outcome outcome = run_program(scratch_.path(), {"restart", oldest.string(), "--set", "output.history_interval=0.0005",
                                                        "--set", "output.particle_interval=0", "--set",
                                                        "output.checkpoint_keep=1"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  nlohmann::json summary = without_machine_figures(scratch_ / "copy");
  EXPECT_EQ(summary.at("changes").size(), 3U);
  EXPECT_NE(summary.at("changes")[0].get<std::string>().find(": --set output.history_interval=0.0005"), std::string::npos);
  summary["changes"] = nlohmann::json::array();
  EXPECT_EQ(summary, without_machine_figures(reference()));
}

TEST_F(Restart, with_another_model_asks_for_consent_and_refuses_what_cannot_be) {
  const std::string oldest = (reference() / names_in(reference()).front()).string();
  const auto restart = [&](const std::string& directory, std::vector<std::string> more) {
    std::vector<std::string> command = {"restart", oldest, "-o", directory};
    command.insert(command.end(), more.begin(), more.end());
    return run_program(scratch_.path(), command);
  };
  const Outcome unasked = restart("a", {"--set", "contact.friction=0.5"});
  EXPECT_EQ(unasked.exit_code, 2);
  EXPECT_NE(unasked.errors.find("changes contact of a run that has begun"), std::string::npos) << unasked.errors;
  const Outcome asked = restart("b", {"--set", "contact.friction=0.5", "--set", "materials.soft.j2_power.A=2", "--change-model"});
  EXPECT_EQ(asked.exit_code, 0) << asked.errors;
  EXPECT_NE(read_json(scratch_ / "b" / "summary.json").at("energy"), read_json(reference() / "summary.json").at("energy"));
  EXPECT_EQ(read_json(scratch_ / "b" / "summary.json").at("changes").size(), 2U);
  // What it wrote goes on with the changed model.
  const Outcome on = run_program(scratch_.path(), {"restart", "b", "--until", "0.06"});
  EXPECT_EQ(on.exit_code, 0) << on.errors;
  for (const auto& [setting, words] : std::vector<std::pair<std::string, std::string>>{
           {"bodies.left.spacing=0.4", "bodies: cannot be changed by a restart"},
           {"parameters.V0=60", "bodies: cannot be changed by a restart"},
           {"grid.cell_size=0.5", "grid: cannot be changed by a restart"},
           {"materials.soft.density=1", "density: cannot be changed in a run"},
           {"materials.soft.j2_power.youngs_modulus=50", "modulus: cannot be changed in a run"},
           {"numerics.transfer=flip", "transfer: cannot be changed in a run"},
           {"numerics.update_order=stress_last", "update_order: cannot be changed in a run"}}) {
    const Outcome refused = restart("c", {"--set", setting, "--change-model"});
    EXPECT_EQ(refused.exit_code, 2) << setting;
    EXPECT_NE(refused.errors.find(words), std::string::npos) << refused.errors;
    EXPECT_EQ(count_of(refused.errors, "\n"), 1U) << refused.errors;
  }
}

TEST_F(Restart, refuses_while_the_run_is_still_at_work) {
  RunningProgram program(scratch_.path(), long_run("results"));
  wait_for_checkpoint(program, scratch_ / "results");
  const Outcome refused = run_program(scratch_.path(), {"restart", "results"});
  EXPECT_EQ(refused.exit_code, 4);
  EXPECT_NE(refused.errors.find("is being written by another run"), std::string::npos) << refused.errors;
  ASSERT_EQ(program.wait().exit_code, 0);
  expect_same_results(scratch_ / "results", reference());
}

// Since save version 6 the impulses of contact by surfaces are found to 1e-3 of the approach, before to 1e-5 of the impulses:
// measured 1.2e-4 in these speeds. (Nor had the latter converged in the 100 passes that there are.)
constexpr double other_impulses = 3e-4;

// Restarts a kept checkpoint and compares the speeds at its end with those that the version which wrote it came to. Another
// processor's rounding moves them by less than 1e-9.
void expect_kept(const std::string& file, double time, const std::vector<std::pair<std::string, double>>& speeds,
                 double tolerance = 1e-9) {
  const ScratchDirectory scratch;
  const std::filesystem::path kept = std::filesystem::path(OGIVE_CLI_DATA).parent_path() / file;
  const Outcome outcome = run_program(scratch.path(), {"restart", kept.string(), "-o", "results"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const nlohmann::json summary = read_json(scratch / "results" / "summary.json");
  EXPECT_EQ(summary.at("time"), time);
  for (const auto& [body, speed] : speeds)
    EXPECT_NEAR(summary.at("bodies").at(body).at("speed").get<double>() / speed, 1, tolerance) << body;
}

TEST(KeptCheckpoint, of_0_2_0_goes_on_to_what_that_version_came_to) {
  // A ball between a wall and a free rigid block, with symmetry, gravity, friction, heat and failure, at step 60: all that save
  // version 2 brought. tests/capi/good_test.c does the same with a file of 0.1.0.
  expect_kept("checkpoint_0.2.0.h5", 0.008, {{"ball", 75.43808180928767}});
}

TEST(KeptCheckpoint, of_save_version_3_goes_on_to_what_that_version_came_to) {
  // At step 40: a total Lagrangian bar of mixed hardening between free rigid boxes, a heated block with bulk viscosity that one of
  // them touches by its true surface.
  expect_kept("checkpoint_save3.h5", 0.01,
              {{"ball", 76.87968592030562}, {"bar", 73.71074858854328}, {"block", 105.91353942371867}, {"cap", 106.03193345251914}},
              other_impulses);
}

TEST(KeptCheckpoint, of_save_version_4_goes_on_to_what_that_version_came_to) {
  // The same with debris dropped, the energy exchange watched and a block of fewer particles.
  expect_kept("checkpoint_save4.h5", 0.01,
              {{"ball", 65.97570801545385}, {"bar", 84.0455546703123}, {"block", 92.89113141655855}, {"cap", 105.30986403655177}});
}

TEST(KeptCheckpoint, of_save_version_5_goes_on_to_what_that_version_came_to) {
  // At step 100: a total Lagrangian ball that strikes a block and has a wall below, all by its own surface, before a mirror.
  expect_kept("checkpoint_save5.h5", 0.04, {{"ball", 40.04442163601388}, {"block", 3.0071535181329505}},
              10 * other_impulses);  // measured 2.9e-3 of the block's, which is 1/17 of the impact's; with 1e-7 it is 3.00972
}

TEST(KeptCheckpoint, of_save_version_6_goes_on_to_what_that_version_came_to) {
  // At step 60: half a block before a mirror, its lower part in a clamp, where what moved at the beginning is stopped. Limits of the
  // energy.
  expect_kept("checkpoint_save6.h5", 0.02, {{"block", 18.014808875941924}});
}

}  // namespace
