// ogive study: runs the cases, writes study.json, study.csv and study.html, and has the charts drawn.
#include "study.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "files.hpp"
#include "embedded.hpp"
#include "study_cases.hpp"
#include "study_file.hpp"
#include "study_results.hpp"
#include "text.hpp"

namespace driver {
namespace {

std::string labels_in_words(const StudyCase& of) {
  std::string words;
  for (const auto& [axis, label] : of.labels) words += (words.empty() ? "" : ", ") + axis + ' ' + label;
  return words;
}

void replace(std::string& text, const std::string& mark, const std::string& by) {
  const size_t at = text.find(mark);
  if (at != std::string::npos) text.replace(at, mark.size(), by);
}

/// The page with the chart library and the results in it: it needs no network and no other file.
std::string page_of(const nlohmann::ordered_json& json) {
  std::string data = json.dump();
  // "</script>" in a text would end the element that holds it.
  for (size_t at = data.find("</"); at != std::string::npos; at = data.find("</", at + 3)) data.replace(at, 2, "<\\/");
  std::string page(study_page_template);
  replace(page, "@CHART_LIBRARY@", std::string(chart_library));
  replace(page, "@STUDY@", data);
  return page;
}

/// tools/plot_study.py: beside an installed program, or in the source tree of one that was built.
std::filesystem::path plotting_tool() {
  std::error_code problem;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", problem);
  for (const std::filesystem::path& place :
       {program.parent_path() / "../share/ogive/plot_study.py", std::filesystem::path(OGIVE_SOURCE_TOOLS) / "plot_study.py"}) {
    if (std::filesystem::exists(place, problem)) return place.lexically_normal();
  }
  return {};
}

/// Pictures are a help, not a result: what hinders them is said and no more.
void draw(const std::filesystem::path& directory) {
  const std::filesystem::path tool = plotting_tool();
  if (tool.empty()) {
    std::printf("no pictures: plot_study.py is not installed; it draws them from study.json\n");
    return;
  }
  std::fflush(stdout);
  const pid_t process = ::fork();
  if (process == 0) {
    ::execl("/usr/bin/python3", "python3", tool.c_str(), directory.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  int status = -1;
  if (process > 0) ::waitpid(process, &status, 0);
  if (status != 0) std::printf("no pictures: %s could not draw them (it needs python3-matplotlib)\n", tool.filename().c_str());
}

}  // namespace

ExitCode study(const StudyOptions& options) {
  const Study study = read_study(options.study_file);
  const std::filesystem::path directory =
      options.output ? std::filesystem::path(*options.output) : std::filesystem::path(study.file.stem().string() + "-study");
  CaseOptions cases;
  cases.cache = options.cache ? std::filesystem::path(*options.cache) : directory / "cases";
  cases.jobs = options.jobs;
  cases.timeout = options.timeout.value_or(study.timeout);
  cases.only_list = options.list;

  for (const std::string& wanted : options.only) {
    const size_t equals = wanted.find('=');
    const std::vector<std::string> axes = axis_names(study);
    const std::string axis = wanted.substr(0, equals);
    if (equals == std::string::npos || std::find(axes.begin(), axes.end(), axis) == axes.end()) {
      throw Failure(kExitInput, "--only " + wanted + ": expected axis=label with one of the axes " + joined(axes) + suggestion(axis, axes));
    }
    cases.only.emplace_back(axis, wanted.substr(equals + 1));
  }

  size_t there = 0;
  const StudyRun run = run_cases(
      study, cases,
      [&](const StudyCase& of) {
        const CaseResult result = result_of(study, of);
        return result.verdict == "stable" ? std::string() : result.verdict + ": " + result.how;
      },
      [&](const StudyCase& of, size_t ended, size_t known) {
        there += of.was_there ? 1 : 0;
        if (of.was_there) return;
        std::printf("%zu of %zu: %s: %s%s%s, %s\n", ended, known, labels_in_words(of).c_str(), of.outcome.ending.c_str(),
                    of.outcome.message.empty() ? "" : ": ", of.outcome.message.c_str(), duration(of.outcome.cpu_seconds).c_str());
        std::fflush(stdout);
      });
  if (run.cases.empty() && !run.interrupted) throw Failure(kExitInput, "--only: leaves no case of " + options.study_file);
  if (options.list) {
    for (const StudyCase& of : run.cases) std::printf("%s  %s\n", of.key.c_str(), labels_in_words(of).c_str());
    std::printf("%zu cases\n", run.cases.size());
    return kExitOk;
  }
  const StudyResults results = results_of(study, run);
  const nlohmann::ordered_json json = study_json(study, run, results);
  std::error_code problem;
  std::filesystem::create_directories(directory, problem);
  if (problem) throw Failure(kExitFile, directory.string() + ": cannot be made: " + problem.message());
  write_whole_file(directory / "study.json", json.dump(1) + '\n');
  write_whole_file(directory / "study.csv", study_csv(study, run, results));
  write_whole_file(directory / "study.html", page_of(json));
  if (run.interrupted) {
    std::printf("interrupted; the same command goes on. What is there is in %s\n", directory.c_str());
    return kExitInterrupted;
  }
  std::map<std::string, int> verdicts;
  for (const CaseResult& result : results.cases) ++verdicts[result.verdict];
  std::printf("%zu cases, %zu of them were there already: %d stable, %d drift, %d fail\n", run.cases.size(), there, verdicts["stable"],
              verdicts["drifts"], verdicts["fails"]);
  if (options.pictures) draw(directory);
  std::printf("results are in %s: study.html, study.csv, study.json\n", directory.c_str());
  return kExitOk;
}

}  // namespace driver
