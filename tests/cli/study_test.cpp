// ogive study: which cases a study stands for, that none is run twice, what is recorded of those that fail.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "program.hpp"

namespace {

using namespace cli_test;
using nlohmann::json;

const char* const kQuick = "settings = [\"output.particle_interval=0\", \"output.checkpoint_steps=0\", \"stop.time=0.01\"]\n";

/// A study of the two boxes in `directory`.
void write_study(const std::filesystem::path& file, const std::string& rest) {
  const std::string scene = (std::filesystem::path(OGIVE_CLI_DATA) / "two_boxes.toml").string();
  std::filesystem::copy_file(scene, file.parent_path() / "two_boxes.toml", std::filesystem::copy_options::overwrite_existing);
  write_file(file, "scene = \"two_boxes.toml\"\n" + rest);
}

const char* const kProduct =
    "[[sweeps]]\nname = \"product\"\n"
    "[[sweeps.axes]]\nname = \"speed\"\nkey = \"parameters.V0\"\nvalues = [20, 40.5]\n"
    "[[sweeps.axes]]\nname = \"numerics\"\n"
    "[[sweeps.axes.points]]\nlabel = \"linear\"\nsettings = []\n"
    "[[sweeps.axes.points]]\nlabel = \"B-spline\"\nsettings = [\"numerics.shape_function=quadratic_bspline\", \"@more.toml\"]\n"
    "[[sweeps]]\nname = \"list\"\nlabels = { numerics = \"linear\" }\n"
    "[[sweeps.axes]]\nname = \"speed\"\n"
    "[[sweeps.axes.points]]\nlabel = \"30\"\nsettings = [\"parameters.V0=30\", \"contact.friction=0\"]\n"
    "[[sweeps.axes.points]]\nlabel = \"20\"\nsettings = [\"parameters.V0=20\"]\n";

std::vector<std::filesystem::path> records(const std::filesystem::path& cache) {
  std::vector<std::filesystem::path> found;
  for (const std::string& name : names_in(cache)) {
    if (std::filesystem::exists(cache / name / "case.json")) found.push_back(cache / name / "case.json");
  }
  return found;
}

bool wait_until(const std::function<bool()>& holds) {
  for (int i = 0; i < 3000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST(Study, products_and_lists_become_cases_with_their_settings) {
  const ScratchDirectory scratch;
  write_study(scratch / "s.toml", kQuick + std::string(kProduct));
  write_file(scratch / "more.toml", "[numerics]\ntime_step_factor = 0.3\n");
  const Outcome listed = run_program(scratch.path(), {"study", "s.toml", "--list"});
  EXPECT_EQ(listed.exit_code, 0) << listed.errors;
  EXPECT_NE(listed.output.find("6 cases"), std::string::npos) << listed.output;
  EXPECT_FALSE(std::filesystem::exists(scratch / "s-study"));

  EXPECT_NE(run_program(scratch.path(), {"study", "s.toml", "--list", "--only", "speed=20", "--only", "numerics=linear"}).output.find("2 cases"),
            std::string::npos);
  EXPECT_EQ(run_program(scratch.path(), {"study", "s.toml", "--only", "sped=20"}).exit_code, 2);

  const Outcome outcome = run_program(scratch.path(), {"study", "s.toml", "-j", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const json study = read_json(scratch / "s-study" / "study.json");
  ASSERT_EQ(study.at("cases").size(), 6U);
  EXPECT_EQ(study.at("axes"), json::parse(R"(["speed", "numerics"])"));
  std::vector<std::string> labels;
  for (const json& of : study.at("cases")) {
    labels.push_back(of.at("labels").at("speed").get<std::string>() + ' ' + of.at("labels").at("numerics").get<std::string>());
    EXPECT_EQ(of.at("ending"), "done");
    EXPECT_GT(of.at("cost").at("cpu_seconds"), 0.0);
    EXPECT_GT(of.at("cost").at("particle_steps"), 0);
    EXPECT_GT(of.at("cost").at("memory_bytes"), 1000000);
  }
  EXPECT_EQ(labels, (std::vector<std::string>{"20 linear", "20 B-spline", "40.5 linear", "40.5 B-spline", "30 linear", "20 linear"}));
  // The settings did reach the runs: the step that "@more.toml" makes shorter, the speed; the same case twice is one run.
  const json& cases = study.at("cases");
  EXPECT_GT(cases[1].at("cost").at("steps"), cases[0].at("cost").at("steps"));
  EXPECT_GT(cases[2].at("fastest_particle"), cases[0].at("fastest_particle"));
  EXPECT_EQ(cases[0].at("key"), cases[5].at("key"));
  EXPECT_EQ(records(scratch / "s-study" / "cases").size(), 5U);
  EXPECT_EQ(count_of(read_file(scratch / "s-study" / "study.csv"), "\n"), 7U);
}

TEST(Study, a_case_is_never_run_twice) {
  const ScratchDirectory scratch;
  const std::string sweep = "[[sweeps]]\n[[sweeps.axes]]\nname = \"speed\"\nkey = \"parameters.V0\"\nvalues = ";
  write_study(scratch / "a.toml", kQuick + sweep + "[20, 30]\n");
  write_study(scratch / "b.toml", kQuick + sweep + "[30, 40]\n");
  ASSERT_EQ(run_program(scratch.path(), {"study", "a.toml", "--cache", "cases"}).exit_code, 0);
  const std::vector<std::filesystem::path> first = records(scratch / "cases");
  ASSERT_EQ(first.size(), 2U);
  std::vector<std::filesystem::file_time_type> times;
  for (const auto& file : first) times.push_back(std::filesystem::last_write_time(file));

  const Outcome again = run_program(scratch.path(), {"study", "a.toml", "--cache", "cases"});
  EXPECT_NE(again.output.find("2 cases, 2 of them were there already"), std::string::npos) << again.output;
  const Outcome other = run_program(scratch.path(), {"study", "b.toml", "--cache", "cases"});
  EXPECT_NE(other.output.find("2 cases, 1 of them were there already"), std::string::npos) << other.output;
  EXPECT_EQ(records(scratch / "cases").size(), 3U);
  for (size_t i = 0; i < first.size(); ++i) EXPECT_EQ(std::filesystem::last_write_time(first[i]), times[i]);

  // What decides the result decides whether it is the same case: a title does not, a value of the scene does.
  const std::string scene = read_file(scratch / "two_boxes.toml");
  write_file(scratch / "two_boxes.toml", scene_text("two_boxes.toml", {{"two boxes collide", "another title"}}));
  EXPECT_NE(run_program(scratch.path(), {"study", "a.toml", "--cache", "cases"}).output.find("2 of them were there"), std::string::npos);
  write_file(scratch / "two_boxes.toml", scene_text("two_boxes.toml", {{"friction = 0.1", "friction = 0.2"}}));
  EXPECT_NE(run_program(scratch.path(), {"study", "a.toml", "--cache", "cases"}).output.find("0 of them were there"), std::string::npos);
}

TEST(Study, a_changed_mesh_file_is_another_case) {
  const ScratchDirectory scratch;
  write_study(scratch / "s.toml", kQuick + std::string("[[sweeps]]\n"));
  std::string cube = read_file(std::filesystem::path(OGIVE_CLI_DATA) / "cube.stl");
  write_file(scratch / "cube.stl", cube);
  write_file(scratch / "two_boxes.toml",
             scene_text("two_boxes.toml", {{"box = { size = [4.0, 4.0, 4.0], centre = [-2.3, 0.0, 0.0] }", "mesh = \"cube.stl\"\nposition = [-4.0, 0.0, 0.0]"}}));
  EXPECT_NE(run_program(scratch.path(), {"study", "s.toml"}).output.find("0 of them were there"), std::string::npos);
  EXPECT_NE(run_program(scratch.path(), {"study", "s.toml"}).output.find("1 of them were there"), std::string::npos);
  write_file(scratch / "cube.stl", cube + "\n");
  EXPECT_NE(run_program(scratch.path(), {"study", "s.toml"}).output.find("0 of them were there"), std::string::npos);
}

TEST(Study, goes_on_after_a_kill_and_leaves_nothing_running) {
  const ScratchDirectory scratch;
  write_study(scratch / "s.toml",
              "settings = [\"output.particle_interval=0\", \"output.checkpoint_steps=0\", \"stop.time=0.5\"]\n"
              "[[sweeps]]\n[[sweeps.axes]]\nname = \"speed\"\nkey = \"parameters.V0\"\nvalues = [0.1, 1, 2, 3]\n");
  const std::filesystem::path cache = scratch / "s-study" / "cases";
  std::filesystem::path kept;
  std::filesystem::file_time_type time;
  {
    RunningProgram program(scratch.path(), {"study", "s.toml"});
    ASSERT_TRUE(wait_until([&] { return !records(cache).empty() && names_in(cache).size() > records(cache).size(); }));
    program.send(SIGKILL);
    EXPECT_EQ(program.wait().signal, SIGKILL);
    kept = records(cache).front();
    time = std::filesystem::last_write_time(kept);
  }
  EXPECT_FALSE(std::filesystem::exists(scratch / "s-study" / "study.json"));
  // The case that was at work ends with the study: its history grows no more.
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const size_t done = records(cache).size();
  const auto size = [&] {
    uintmax_t sum = 0;
    for (const std::string& name : names_in(cache)) {
      std::error_code none;
      const uintmax_t bytes = std::filesystem::file_size(cache / name / "history.csv", none);
      if (!none) sum += bytes;
    }
    return sum;
  };
  const uintmax_t before = size();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(size(), before);
  ASSERT_LT(done, 4U);

  const Outcome outcome = run_program(scratch.path(), {"study", "s.toml"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("4 cases, " + std::to_string(done) + " of them were there already"), std::string::npos) << outcome.output;
  EXPECT_EQ(std::filesystem::last_write_time(kept), time);
  EXPECT_EQ(read_json(scratch / "s-study" / "study.json").at("cases").size(), 4U);
}

TEST(Study, an_interruption_leaves_what_is_done) {
  const ScratchDirectory scratch;
  // So many cases that the signal comes long before the last: one takes some 50 ms.
  constexpr size_t cases = 60;
  std::string speeds;
  for (size_t speed = 1; speed <= cases; ++speed) speeds += std::to_string(speed) + ", ";
  write_study(scratch / "s.toml",
              "settings = [\"output.particle_interval=0\", \"output.checkpoint_steps=0\", \"stop.time=0.5\"]\n"
              "[[sweeps]]\n[[sweeps.axes]]\nname = \"speed\"\nkey = \"parameters.V0\"\nvalues = [" + speeds + "]\n");
  RunningProgram program(scratch.path(), {"study", "s.toml"});
  ASSERT_TRUE(wait_until([&] { return !records(scratch / "s-study" / "cases").empty(); }));
  program.send(SIGTERM);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 75);
  const json study = read_json(scratch / "s-study" / "study.json");
  EXPECT_EQ(study.at("complete"), false);
  EXPECT_GE(study.at("cases").size(), 1U);
  EXPECT_LT(study.at("cases").size(), cases);
}

TEST(Study, cases_that_fail_are_results) {
  const ScratchDirectory scratch;
  write_study(scratch / "s.toml",
              "settings = [\"output.particle_interval=0\", \"output.checkpoint_steps=0\"]\n"
              "[verdict]\ndrift = 0.5\nfailure = 1.0\nspeed = \"3*V0\"\n"
              "[[sweeps]]\n[[sweeps.axes]]\nname = \"case\"\n"
              "[[sweeps.axes.points]]\nlabel = \"good\"\nsettings = []\n"
              "[[sweeps.axes.points]]\nlabel = \"crushed\"\nsettings = [\"parameters.V0=5000\", \"grid.faces.x_min=fixed\", "
              "\"grid.faces.x_max=fixed\", \"grid.faces.y_min=fixed\", \"grid.faces.y_max=fixed\", \"grid.faces.z_min=fixed\", "
              "\"grid.faces.z_max=fixed\"]\n"
              "[[sweeps.axes.points]]\nlabel = \"impossible\"\nsettings = [\"bodies.right.box.centre=[-2, 0, 0]\"]\n"
              "[[sweeps.axes.points]]\nlabel = \"endless\"\nsettings = [\"parameters.V0=0.001\", \"stop.time=1000\"]\n");
  const Outcome outcome = run_program(scratch.path(), {"study", "s.toml", "--timeout", "1"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const json cases = read_json(scratch / "s-study" / "study.json").at("cases");
  EXPECT_EQ(cases[0].at("verdict"), "stable") << cases[0];
  EXPECT_EQ(cases[1].at("ending"), "broke down");
  EXPECT_EQ(cases[1].at("verdict"), "fails");
  EXPECT_NE(cases[1].at("how").get<std::string>().find("the computation broke down: "), std::string::npos) << cases[1];
  EXPECT_TRUE(cases[1].at("when").is_number());
  EXPECT_EQ(cases[2].at("ending"), "refused") << cases[2];
  EXPECT_EQ(cases[3].at("ending"), "timed out");
  // Known failures are not tried again, but one that ran out of time is, when there is more of it.
  EXPECT_NE(run_program(scratch.path(), {"study", "s.toml", "--timeout", "1"}).output.find("4 of them were there"), std::string::npos);
  EXPECT_NE(run_program(scratch.path(), {"study", "s.toml", "--timeout", "2"}).output.find("3 of them were there"), std::string::npos);
}

TEST(Study, errors_are_those_of_the_values_that_the_runs_left) {
  const ScratchDirectory scratch;
  write_study(scratch / "s.toml", std::string(kQuick) +
                                      "[measures.slow]\nsummary = \"results.residual_velocity\"\nunit = \"mm/s\"\n"
                                      "by = \"V0\"\nreferences = { 20 = 10000, 40 = \"V0*500\" }\n"
                                      "[measures.push]\nhistory = \"left.momentum_x\"\nat = 0\nunit = \"g m/s\"\nreference = \"0.064*V0 - 1\"\nerror = \"absolute\"\n"
                                      "[measures.sum]\nexpression = \"push + V0\"\n"
                                      "[[sweeps]]\n[[sweeps.axes]]\nname = \"V0\"\nkey = \"parameters.V0\"\nvalues = [20, 40]\n");
  const Outcome outcome = run_program(scratch.path(), {"study", "s.toml"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const json cases = read_json(scratch / "s-study" / "study.json").at("cases");
  for (size_t i = 0; i < 2; ++i) {
    const double V0 = i == 0 ? 20 : 40;
    const json& values = cases[i].at("values");
    const json summary = read_json(scratch / "s-study" / "cases" / cases[i].at("key").get<std::string>() / "summary.json");
    const double slow = summary.at("results").at("residual_velocity").get<double>() * 1000;
    EXPECT_NEAR(values.at("slow").at("value"), slow, 1e-9 * slow);
    EXPECT_NEAR(values.at("slow").at("error"), slow / (500 * V0) - 1, 1e-9);
    EXPECT_NEAR(values.at("push").at("value"), 0.064 * V0, 1e-9);
    EXPECT_NEAR(values.at("push").at("error"), 1.0, 1e-9);
    EXPECT_NEAR(values.at("sum").at("value"), 1.064 * V0, 1e-9);
    EXPECT_TRUE(values.at("sum").at("error").is_null());
  }
  EXPECT_EQ(cases[0].at("on_front").get<bool>() || cases[1].at("on_front").get<bool>(), true);
}

TEST(Study, halving_brackets_the_largest_stable_value) {
  const ScratchDirectory scratch;
  // "Stable" means here that nothing is faster than 50 m/s: the bound on V0 is known.
  write_study(scratch / "s.toml", std::string(kQuick) +
                                      "[verdict]\ndrift = 10\nfailure = 10\nspeed = 50\n"
                                      "[[sweeps]]\n"
                                      "[[sweeps.axes]]\nname = \"V0\"\nkey = \"parameters.V0\"\nbisect = [10, 90]\ntolerance = 6\n"
                                      "[[sweeps.axes]]\nname = \"friction\"\nkey = \"contact.friction\"\nvalues = [0, 0.5]\n");
  const Outcome outcome = run_program(scratch.path(), {"study", "s.toml", "-j", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const json study = read_json(scratch / "s-study" / "study.json");
  ASSERT_EQ(study.at("bisections").size(), 2U);
  for (const json& found : study.at("bisections")) {
    const double stable = found.at("largest_stable"), unstable = found.at("smallest_unstable");
    EXPECT_GT(unstable, stable);
    EXPECT_LE(unstable - stable, 6.0);
    EXPECT_LE(stable, 50.0);
    EXPECT_GE(stable, 20.0);  // particles run ahead of the body at the impact, so the bound on V0 lies below 50
    EXPECT_NE(found.at("how").get<std::string>().find("faster than 50"), std::string::npos);
  }
}

TEST(Study, mistakes_are_named_with_their_place_and_nothing_is_written) {
  const std::string sweep = "[[sweeps]]\n[[sweeps.axes]]\nname = \"V0\"\n";
  struct Mistake {
    std::string text;
    std::vector<std::string> said;
  };
  const std::vector<Mistake> mistakes = {
      {sweep + "key = \"parameters.V0\"\nvalues = [1]\n[charts]\neror = \"x\"\n", {"s.toml:8:1: charts.eror: unknown key; did you mean \"error\"?"}},
      {sweep + "key = \"contact.methd\"\nvalues = [\"york\"]\n", {"s.toml:6:10", "contact.methd: unknown key; did you mean \"method\"?"}},
      {sweep + "key = \"contact.method\"\nvalues = [\"york\", \"yorck\"]\n", {"s.toml:6:10", "V0 yorck", "did you mean \"york\"?"}},
      {sweep + "key = \"parameters.V0\"\n", {"s.toml:3:1: sweeps[0].axes[0]: needs exactly one of values, points, points_from, bisect"}},
      {sweep + "key = \"parameters.V0\"\nvalues = [1, 1]\n", {"has two points of the label \"1\""}},
      {sweep + "key = \"parameters.V0\"\nbisect = [1, 0]\ntolerance = 0.1\n", {"s.toml:6:10: sweeps[0].axes[0].bisect: must be [lowest, highest]"}},
      {sweep + "key = \"parameters.V0\"\nvalues = [1]\n[measures.a]\nsummary = \"steps\"\nby = \"VO\"\nreferences = { 1 = 2 }\n", {"s.toml:9:6: measures.a.by: must be the name of an axis (V0), got \"VO\"; did you mean \"V0\"?"}},
      {"[[sweeps]]\nsettings = [\"numerics\"]\n", {"s.toml:3:12: sweeps[0].settings: must be of the form \"path.to.key=value\" or \"@file\", got \"numerics\""}},
      {"[[sweeps]]\nsettings = [\"@nowhere.toml\"]\n", {"s.toml:3:12", "nowhere.toml"}},
      {"", {"sweeps: missing"}},
  };
  for (const Mistake& mistake : mistakes) {
    const ScratchDirectory scratch;
    write_study(scratch / "s.toml", mistake.text);
    const Outcome outcome = run_program(scratch.path(), {"study", "s.toml"});
    EXPECT_EQ(outcome.exit_code, 2) << mistake.text << outcome.output;
    EXPECT_EQ(count_of(outcome.errors, "\n"), 1U) << outcome.errors;
    for (const std::string& said : mistake.said) EXPECT_NE(outcome.errors.find(said), std::string::npos) << said << "\nnot in\n" << outcome.errors;
    EXPECT_FALSE(std::filesystem::exists(scratch / "s-study"));
  }
}

TEST(Study, a_measure_that_is_not_there_is_named) {
  const ScratchDirectory scratch;
  write_study(scratch / "s.toml", std::string(kQuick) + "[measures.a]\nsummary = \"results.residual\"\n[[sweeps]]\n");
  const Outcome outcome = run_program(scratch.path(), {"study", "s.toml"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.errors.find("s.toml:3:1: measures.a: summary: there is no number \"results.residual\" in summary.json"), std::string::npos)
      << outcome.errors;
}

}  // namespace
