// A run that is stopped, killed or damaged goes on from a checkpoint and ends as if nothing had happened, to the bit.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <random>
#include <thread>

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
  for (const char* key : {"wall_seconds", "particle_steps_per_second", "peak_memory_bytes"}) summary.erase(key);
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

TEST_F(Restart, refuses_while_the_run_is_still_at_work) {
  RunningProgram program(scratch_.path(), long_run("results"));
  wait_for_checkpoint(program, scratch_ / "results");
  const Outcome refused = run_program(scratch_.path(), {"restart", "results"});
  EXPECT_EQ(refused.exit_code, 4);
  EXPECT_NE(refused.errors.find("is being written by another run"), std::string::npos) << refused.errors;
  ASSERT_EQ(program.wait().exit_code, 0);
  expect_same_results(scratch_ / "results", reference());
}

}  // namespace
