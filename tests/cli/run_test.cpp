// A small scene run to its end: what it leaves, what it refuses.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "program.hpp"

namespace {

using namespace cli_test;

std::string scene_file() { return (std::filesystem::path(OGIVE_CLI_DATA) / "two_boxes.toml").string(); }

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

TEST(Run, leaves_valid_files) {
  const ScratchDirectory scratch;
  const Outcome outcome = run_program(scratch.path(), {"run", scene_file(), "--threads", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  // The boxes are four cells wide: 2.1 % of the energy is lost, and told.
  EXPECT_EQ(outcome.errors.find("WARNING: the energy ledger does not close: -2."), 0U) << outcome.errors;
  EXPECT_EQ(count_of(outcome.errors, "\n"), 1U) << outcome.errors;
  EXPECT_NE(outcome.output.find("residual velocity of left: "), std::string::npos);
  EXPECT_NE(outcome.output.find(" m/s\n"), std::string::npos);

  const std::filesystem::path results = scratch / "two_boxes-out";
  const std::vector<std::string> names = names_in(results);
  for (const std::string& name : names) {
    if (name.substr(name.size() - 3) != ".h5") continue;
    const Outcome info = run_program(results, {"info", name, "--verify"});
    EXPECT_EQ(info.exit_code, 0) << info.errors;
    EXPECT_NE(info.output, "");
  }
  EXPECT_EQ(count_of(testing::PrintToString(names), "checkpoint-"), 3U) << testing::PrintToString(names);
  for (const char* name :
       {"history.csv", "summary.json", "particles.xdmf", "particles-00000.h5", "particles-00003.h5"}) {
    EXPECT_TRUE(std::filesystem::exists(results / name)) << name;
  }
  EXPECT_EQ(count_of(testing::PrintToString(names), ".part"), 0U);
  const std::string series = read_file(results / "particles.xdmf");
  EXPECT_NE(series.find("particles-00000.h5"), std::string::npos);
  EXPECT_NE(series.find("particles-00003.h5"), std::string::npos);

  std::istringstream history(read_file(results / "history.csv"));
  std::string line;
  std::getline(history, line);
  const std::vector<std::string> heading = fields_of(line);
  const std::vector<std::string> known = {"step",
                                          "time",
                                          "kinetic",
                                          "residual_relative",
                                          "left.speed",
                                          "left.centre_x",
                                          "right.failed_particles",
                                          "left.mass",
                                          "right.momentum_x",
                                          "right.contact_force_x"};
  for (const std::string& name : known) {
    EXPECT_NE(std::find(heading.begin(), heading.end(), name), heading.end()) << name;
  }
  std::vector<double> times;
  while (std::getline(history, line)) {
    const std::vector<std::string> fields = fields_of(line);
    ASSERT_EQ(fields.size(), heading.size());
    for (const std::string& field : fields) EXPECT_TRUE(std::isfinite(std::stod(field))) << field;
    times.push_back(std::stod(fields[1]));
  }
  ASSERT_EQ(times.size(), 26U);
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_EQ(times.back(), 0.05);

  const nlohmann::json summary = read_json(results / "summary.json");
  EXPECT_EQ(summary.at("scene"), scene_file());
  EXPECT_EQ(summary.at("threads"), 2);
  EXPECT_EQ(summary.at("time"), 0.05);
  EXPECT_EQ(summary.at("stop_reason"), "time");
  EXPECT_EQ(summary.at("particles"), 800);
  for (const char* key : {"version", "title", "steps", "wall_seconds", "particle_steps_per_second", "peak_memory_bytes",
                          "momentum", "maximum_speed_ever", "parameters"}) {
    EXPECT_TRUE(summary.contains(key)) << key;
  }
  const nlohmann::json& left = summary.at("bodies").at("left");
  EXPECT_EQ(left.at("failed_particles"), 0);
  EXPECT_EQ(left.at("left_domain"), 0);
  EXPECT_NEAR(left.at("mass"), 0.064, 1e-12);
  EXPECT_EQ(left.at("velocity").size(), 3U);
  EXPECT_EQ(summary.at("results").at("residual_velocity"), left.at("speed"));
  EXPECT_LT(left.at("speed"), 39.0);  // they did meet
  const nlohmann::json& energy = summary.at("energy");
  for (const char* key : {"kinetic", "internal", "plastic_dissipation", "total", "initial_total"}) {
    EXPECT_TRUE(energy.at(key).is_number()) << key;
  }
  EXPECT_LT(std::abs(energy.at("residual_relative").get<double>()), 0.2);
  EXPECT_NEAR(summary.at("momentum").at(0), 0.064 * 40, 1e-10);
}

TEST(Run, output_does_not_change_results) {
  const ScratchDirectory scratch;
  ASSERT_EQ(run_program(scratch.path(), {"run", scene_file(), "-o", "often"}).exit_code, 0);
  ASSERT_EQ(run_program(scratch.path(),
                        {"run", scene_file(), "-o", "seldom", "--set", "output.history_interval=0.0333", "--set",
                         "output.particle_interval=0", "--set", "output.checkpoint_steps=0", "--threads", "2"})
                .exit_code,
            0);
  const nlohmann::json often = read_json(scratch / "often" / "summary.json");
  const nlohmann::json seldom = read_json(scratch / "seldom" / "summary.json");
  for (const char* key : {"steps", "time", "bodies", "energy", "momentum", "results", "maximum_speed_ever"}) {
    EXPECT_EQ(often.at(key), seldom.at(key)) << key;
  }
  EXPECT_EQ(names_in(scratch / "seldom"), (std::vector<std::string>{"history.csv", "summary.json"}));
}

TEST(Run, neither_environment_nor_current_directory_changes_results) {
  const ScratchDirectory scratch;
  ASSERT_EQ(run_program(scratch.path(), {"run", scene_file(), "-o", "plain"}).exit_code, 0);
  std::filesystem::create_directory(scratch / "below");
  write_file(scratch / "below" / "scene.toml", scene_text("two_boxes.toml", {}));
  const Outcome other = run_in_shell(scratch / "below",
                                     "env -u HOME OMP_NUM_THREADS=3 OMP_DYNAMIC=true OMP_SCHEDULE=dynamic LC_ALL=de_DE.UTF-8 "
                                     "LANG=de_DE.UTF-8 TZ=Asia/Tokyo TMPDIR=/nowhere HDF5_USE_FILE_LOCKING=BEST_EFFORT "
                                     "MALLOC_PERTURB_=165 ogive run scene.toml -o ../other");
  ASSERT_EQ(other.exit_code, 0) << other.errors;
  for (const std::string& name : names_in(scratch / "plain")) {
    if (name == "summary.json" || name.rfind("checkpoint-", 0) == 0) continue;  // scene's name and wall time are in them
    EXPECT_TRUE(read_file(scratch / "plain" / name) == read_file(scratch / "other" / name)) << name;
  }
}

TEST(Run, writes_nothing_outside_its_directory) {
  const ScratchDirectory scratch;
  write_file(scratch / "scene.toml", scene_text("two_boxes.toml", {{"title = \"two boxes collide\"", "title = \"../../escape\""}}));
  ASSERT_EQ(run_program(scratch.path(), {"run", "scene.toml", "-o", "results"}).exit_code, 0);
  EXPECT_EQ(names_in(scratch.path()), (std::vector<std::string>{"results", "scene.toml"}));
  // No name that becomes a file's or a group's can lead elsewhere.
  const Outcome refused = run_program(scratch.path(), {"run", "scene.toml", "-o", "other", "--set",
                                                       "bodies.x/y.material=soft"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(names_in(scratch.path()), (std::vector<std::string>{"results", "scene.toml"}));
  // A device in place of particles is refused, not read without end.
  write_file(scratch / "device.toml",
             scene_text("two_boxes.toml", {{"box = { size = [4.0, 4.0, 4.0], centre = [-2.3, 0.0, 0.0] }\nspacing = 0.5",
                                            "particles = \"/dev/zero\""}}));
  EXPECT_EQ(run_program(scratch.path(), {"run", "device.toml", "-o", "other"}).exit_code, 2);
}

TEST(Run, refuses_a_directory_that_holds_a_run) {
  const ScratchDirectory scratch;
  const std::vector<std::string> command = {"run", scene_file(), "-o", "results", "--until", "0.002"};
  ASSERT_EQ(run_program(scratch.path(), command).exit_code, 0);
  write_file(scratch / "results" / "notes.txt", "mine");
  const std::string before = read_file(scratch / "results" / "summary.json");
  const Outcome refused = run_program(scratch.path(), command);
  EXPECT_EQ(refused.exit_code, 4);
  EXPECT_EQ(count_of(refused.errors, "\n"), 1U);
  EXPECT_NE(refused.errors.find("--overwrite"), std::string::npos) << refused.errors;
  EXPECT_EQ(read_file(scratch / "results" / "summary.json"), before);

  std::vector<std::string> again = command;
  again.push_back("--overwrite");
  EXPECT_EQ(run_program(scratch.path(), again).exit_code, 0);
  EXPECT_EQ(read_file(scratch / "results" / "notes.txt"), "mine");
}

TEST(Run, output_that_cannot_be_written_gives_code_4) {
  const ScratchDirectory scratch;
  write_file(scratch / "file", "");
  for (const char* directory : {"file", "file/below", "/proc/nowhere"}) {
    const Outcome outcome = run_program(scratch.path(), {"run", scene_file(), "-o", directory});
    EXPECT_EQ(outcome.exit_code, 4) << directory;
    EXPECT_EQ(count_of(outcome.errors, "\n"), 1U) << outcome.errors;
  }
  EXPECT_EQ(names_in(scratch.path()), std::vector<std::string>{"file"});
}

TEST(Run, ends_when_everything_has_left_the_domain) {
  const ScratchDirectory scratch;
  ASSERT_EQ(run_program(scratch.path(), {"run", scene_file(), "-o", "results", "--until", "5", "--set",
                                         "bodies.left.velocity=[0,0,900]", "--set", "bodies.right.velocity=[0,0,900]"})
                .exit_code,
            0);
  const nlohmann::json summary = read_json(scratch / "results" / "summary.json");
  EXPECT_EQ(summary.at("stop_reason"), "empty");
  EXPECT_EQ(summary.at("particles"), 0);
}

TEST(Run, max_steps_ends_it) {
  const ScratchDirectory scratch;
  ASSERT_EQ(run_program(scratch.path(), {"run", scene_file(), "-o", "results", "--set", "stop.max_steps=7"}).exit_code,
            0);
  const nlohmann::json summary = read_json(scratch / "results" / "summary.json");
  EXPECT_EQ(summary.at("steps"), 7);
  EXPECT_EQ(summary.at("stop_reason"), "max_steps");
}

TEST(Run, ends_when_the_energy_exchange_has_ended) {
  const ScratchDirectory scratch;
  const Outcome outcome =
      run_program(scratch.path(), {"run", scene_file(), "-o", "results", "--until", "5", "--set", "stop.exchange_window=0.03", "--set",
                                   "stop.exchange_tolerance=0.05", "--set", "numerics.drop_debris=true"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("ended (exchange_ended)"), std::string::npos) << outcome.output;
  const nlohmann::json summary = read_json(scratch / "results" / "summary.json");
  EXPECT_EQ(summary.at("stop_reason"), "exchange_ended");
  EXPECT_LT(summary.at("time"), 1);
  EXPECT_EQ(summary.at("bodies").at("left").at("dropped_particles"), 0);
  EXPECT_EQ(summary.at("energy").at("dropped_energy"), 0);
  // An end that a restart gives is another: it goes on.
  const Outcome on = run_program(scratch.path(), {"restart", "results", "--until", "6", "--set", "stop.exchange_window=0"});
  ASSERT_EQ(on.exit_code, 0) << on.errors;
  EXPECT_NE(read_json(scratch / "results" / "summary.json").at("stop_reason"), "exchange_ended");
}

TEST(Run, growing_energy_is_said_loudly_and_stops_the_run_above_the_limit) {
  const ScratchDirectory scratch;
  // A soft block turns by 0.02 rad a step, of which the stress first makes energy (docs/stability.md).
  std::vector<std::string> command = {"run", scene_file(), "-o", "results"};
  for (const char* setting : {"numerics.shape_function=quadratic_bspline", "numerics.energy_limit=0.05", "parameters.V0=0", "stop.time=0.5",
                              "materials.soft.j2_power.A=1e9", "bodies.left.angular_velocity=[0, 0, 20]",
                              "bodies.left.angular_centre=[-2.3, 0, 0]", "bodies.right.box.centre=[5.5, 0.3, 0.0]"}) {
    command.insert(command.end(), {"--set", setting});
  }
  const Outcome stopped = run_program(scratch.path(), command);
  EXPECT_EQ(stopped.exit_code, 3) << stopped.errors;
  for (const char* part : {"warning: the energy has grown by ", "the computation broke down: at time ", "energy_limit: 5",
                           "probable cause: a body turns by 0.0", "failed-state.h5"})
    EXPECT_NE(stopped.errors.find(part), std::string::npos) << part << "\nis not in\n" << stopped.errors;
  EXPECT_FALSE(std::filesystem::exists(scratch / "results" / "summary.json"));

  command.insert(command.end(), {"--overwrite", "--set", "numerics.energy_limit=1e30"});
  const Outcome ended = run_program(scratch.path(), command);
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_NE(ended.errors.find("WARNING: the energy grew by "), std::string::npos) << ended.errors;
  const nlohmann::json summary = read_json(scratch / "results" / "summary.json");
  EXPECT_EQ(summary.at("warnings").size(), 1U);
  EXPECT_GT(summary.at("energy").at("growth"), 0.01);
  EXPECT_TRUE(summary.at("energy").at("warning_time").is_number());
}

TEST(Run, that_ends_with_more_energy_lost_than_its_limit_is_no_result) {
  const ScratchDirectory scratch;
  const std::vector<std::string> command = {"run", scene_file(), "-o", "results", "--set", "contact.detection=shared_node",
                                            "--set", "numerics.energy_loss_limit=1e-12", "--set", "stop.max_steps=24"};
  const Outcome stopped = run_program(scratch.path(), command);
  EXPECT_EQ(stopped.exit_code, 3) << stopped.errors;
  EXPECT_EQ(count_of(stopped.errors, "\n"), 1U) << stopped.errors;
  for (const char* part : {"the computation broke down: at time ", "step 24, ", "lost, unaccounted for (energy_loss_limit: ",
                           "probable cause: ", "it had come to its end, the results are in results"})
    EXPECT_NE(stopped.errors.find(part), std::string::npos) << part << "\nis not in\n" << stopped.errors;
  const nlohmann::json summary = read_json(scratch / "results" / "summary.json");
  EXPECT_LT(summary.at("energy").at("unaccounted"), -1e-12);
}

/// Crushed between rigid walls at Mach 13, with a law that knows no shocks.
std::vector<std::string> breaking_run() {
  std::vector<std::string> command = {"run", scene_file(), "-o", "results", "--set", "parameters.V0=5000"};
  for (const char* face : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}) {
    command.insert(command.end(), {"--set", std::string("grid.faces.") + face + "=fixed"});
  }
  return command;
}

TEST(Run, breakdown_gives_code_3_and_keeps_the_state) {
  const ScratchDirectory scratch;
  const Outcome outcome = run_program(scratch.path(), breaking_run());
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(count_of(outcome.errors, "\n"), 1U) << outcome.errors;
  EXPECT_EQ(outcome.errors.find("the computation broke down: "), 0U) << outcome.errors;
  EXPECT_EQ(run_program(scratch.path(), {"info", "results/failed-state.h5", "--verify"}).exit_code, 0);
  EXPECT_EQ(run_program(scratch.path(), {"info", "results/failed-particles.h5", "--verify"}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(scratch / "results" / "summary.json"));
  for (const char* part : {"particle ", " at (", ", step ", ", time ", "probable cause: "})
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;

  // The state is that before the step that broke down: it breaks down there again, with the same words.
  const std::string cause = outcome.errors.substr(0, outcome.errors.find("; the particles are in"));
  const Outcome again = run_program(scratch.path(), {"restart", "results/failed-state.h5", "-o", "again"});
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_EQ(again.errors.substr(0, again.errors.find("; the particles are in")), cause);
  EXPECT_NE(again.output.find("from results/failed-state.h5: step "), std::string::npos) << again.output;
}

TEST(Run, a_state_before_a_breakdown_goes_on_with_a_shorter_time_step) {
  const ScratchDirectory scratch;
  const Outcome broken = run_program(scratch.path(), breaking_run());
  ASSERT_EQ(broken.exit_code, 3) << broken.errors;
  const Outcome on = run_program(scratch.path(), {"restart", "results/failed-state.h5", "--change-model", "--set",
                                                  "numerics.time_step_factor=0.02", "--set", "stop.max_steps=60"});
  EXPECT_EQ(on.exit_code, 0) << on.errors;
  EXPECT_FALSE(std::filesystem::exists(scratch / "results" / "failed-state.h5"));
  const nlohmann::json changes = read_json(scratch / "results" / "summary.json").at("changes");
  EXPECT_EQ(changes.size(), 2U);
}

TEST(Run, two_in_one_directory_are_refused_and_the_first_goes_on) {
  const ScratchDirectory scratch;
  std::vector<std::string> command = {"run", scene_file(), "-o", "results", "--set", "numerics.maximum_time_step=2e-5",
                                      "--set", "output.checkpoint_steps=1000"};
  RunningProgram first(scratch.path(), command);
  while (!std::filesystem::exists(scratch / "results" / "history.csv") && !first.ended()) {
  }
  command.push_back("--overwrite");
  const Outcome second = run_program(scratch.path(), command);
  EXPECT_EQ(second.exit_code, 4);
  EXPECT_NE(second.errors.find("is being written by another run (process "), std::string::npos) << second.errors;
  EXPECT_EQ(first.wait().exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(scratch / "results" / "summary.json"));
}

}  // namespace
