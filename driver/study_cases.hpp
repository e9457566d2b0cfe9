// The cases of a study: made from its sweeps, run by processes of this program, and kept by what they compute, so that a
// case that was run before, by this study or another, is never run again.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "study_file.hpp"
#include "units.hpp"

namespace driver {

/// How a case ended. What an interruption leaves behind is none of these: it is run again.
struct CaseOutcome {
  std::string ending;   // "done", "broke down", "refused", "crashed", "timed out"
  std::string message;  // last line of what the program said, where it is not done
  double cpu_seconds = 0, wall_seconds = 0;
  int64_t memory_bytes = 0;  // most that the process held
  std::filesystem::path directory;
};

/// One point of a sweep, with all that decides its result.
struct StudyCase {
  size_t sweep = 0;
  std::map<std::string, std::string> labels;  // axis: label
  std::vector<StudySetting> settings;
  std::string identity;  // scene with all settings, contents of its files, engine: equal identities give equal results
  std::string key;       // checksum of the identity
  Units units;
  std::map<std::string, double> parameters;  // of the scene
  CaseOutcome outcome;
  bool was_there = false;  // the outcome came from the cache
};

/// What halving found for one combination of the other axes.
struct Bisection {
  size_t sweep = 0;
  std::map<std::string, std::string> labels;
  std::string axis;
  double largest = 0;         // stable at this value ...
  double unstable = 0;        // ... and not at this one
  bool all_stable = false;    // `largest` is the upper bound
  bool none_stable = false;   // `unstable` is the lower bound
  std::string how;            // what happened at `unstable`
};

struct CaseOptions {
  std::filesystem::path cache;
  int jobs = 1;
  double timeout = 0;
  std::vector<std::pair<std::string, std::string>> only;  // axis, label: cases with another label there are left out
  bool only_list = false;  // check and name the cases, run none
};

struct StudyRun {
  std::vector<StudyCase> cases;
  std::vector<Bisection> bisections;
  bool interrupted = false;
};

/// Checks every case's scene first, then runs what is not in the cache. `failure_of` is asked after each case that is part of a
/// bisection: why it is not stable, "" if it is. `tell` hears of each case that has ended. Throws Failure where a scene is
/// wrong (named by its place in the study), or where the cache cannot be written.
StudyRun run_cases(const Study& study, const CaseOptions& options, const std::function<std::string(const StudyCase&)>& failure_of,
                   const std::function<void(const StudyCase&, size_t ended, size_t known)>& tell);

/// Checksum of the engine's libraries with its version.
std::string engine_identity();

}  // namespace driver
