// What is read from the runs of a study: measures and their errors, energy, the verdict, cost; fronts and limits over cases.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study_cases.hpp"
#include "study_file.hpp"
#include "study_fit.hpp"

namespace driver {

struct MeasuredValue {
  std::optional<double> value, reference, error;  // in the measure's unit; a relative error is a fraction
};

struct CaseResult {
  std::map<std::string, MeasuredValue> values;
  std::string verdict;  // "stable", "drifts", "fails"
  std::string how;      // why it is not stable
  std::optional<double> when;  // in the scene's unit of time
  // Of the energy that the run began with and the work done on it: residual at the end, largest growth at any time.
  std::optional<double> energy_residual, energy_growth;
  std::optional<double> fastest;  // particle, ever
  // Processor seconds of the whole process and its parts, where the run reached its end.
  std::optional<double> start_seconds, stepping_seconds, output_seconds;
  std::optional<int64_t> steps, particles, particle_steps;
  bool on_front = false;  // no other case of its kind has a smaller error for less time
};

/// A series of cases that differ in the cell size alone.
struct ConvergenceSeries {
  std::map<std::string, std::string> labels;
  std::string measure;
  std::vector<double> cells, values;
  std::optional<Convergence> fit;
  std::optional<double> error_order;  // slope of the error against the reference
};

struct StudyResults {
  std::vector<CaseResult> cases;  // as the run's
  std::vector<ConvergenceSeries> series;
};

/// Of one case: everything but errors against limits, which need the others. Throws Failure(kExitInput) where a measure does not
/// fit the run's files.
CaseResult result_of(const Study& study, const StudyCase& of);

/// Of all: errors against limits, series, fronts.
StudyResults results_of(const Study& study, const StudyRun& run);

nlohmann::ordered_json study_json(const Study& study, const StudyRun& run, const StudyResults& results);
std::string study_csv(const Study& study, const StudyRun& run, const StudyResults& results);

}  // namespace driver
