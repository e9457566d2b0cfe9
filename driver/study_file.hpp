// A study as plain values, read from TOML and checked key by key: which scene, which settings are swept, what is measured.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace driver {

/// "path.to.key=value" or "@file" (its path made whole), with the place in the study where it was written.
struct StudySetting {
  std::string text;
  std::string place;
};

/// One point of an axis: what tables call it, and what it sets.
struct StudyPoint {
  std::string label;
  std::vector<StudySetting> settings;
};

struct StudyAxis {
  std::string name;
  std::string key;                 // of the scene; "" where the points have settings of their own
  std::vector<StudyPoint> points;  // empty: bisection
  // The largest value of the key, within bounds, at which a case is stable, is looked for by halving.
  double lowest = 0, highest = 0, tolerance = 0;

  bool bisects() const { return points.empty(); }
};

/// All combinations of the axes' points.
struct StudySweep {
  std::string name;
  std::vector<StudySetting> settings;
  std::map<std::string, std::string> labels;  // places on axes that other sweeps vary and this one does not
  std::vector<StudyAxis> axes;
};

/// A number that is read from a run.
struct StudyMeasure {
  enum class Source { Summary, History, Expression };
  enum class At { End, Largest, Smallest, Time, LastOccurrence };  // the last: the time at which it was last not zero

  std::string name;
  Source source = Source::Summary;
  std::string what;  // path in summary.json, column of history.csv, expression
  At at = At::End;
  std::string time;  // a number or an expression, in the scene's unit of time
  std::string unit = "-";
  std::string reference;                        // a number or an expression; "" for none
  std::string reference_by;                     // an axis: the reference is looked up under the case's label
  std::map<std::string, std::string> references;
  // The reference is the value that the measure itself tends to along an axis, for the cases with these labels.
  std::string limit_axis;
  std::map<std::string, std::string> limit_labels;
  bool relative = true;
  std::optional<double> fails_above;  // an error beyond it makes the case fail
  std::string place;
};

/// Rules by which a run is called stable, drifting or failed.
struct StudyVerdict {
  double drift = 0.01;   // of the energy that a run began with and of the work done on it
  double failure = 0.1;  // growth alone
  std::string speed;     // the fastest particle allowed, an expression; "" for no bound
};

struct Study {
  std::filesystem::path file, scene;
  std::string title;
  double timeout = 0;  // seconds of processor time; 0: none
  std::vector<StudySetting> settings;
  std::vector<StudySweep> sweeps;
  std::vector<StudyMeasure> measures;
  StudyVerdict verdict;
  std::string chart_error;  // the measure whose error is charted
  std::string chart_cell;   // the axis of cell sizes, "" for none
  std::vector<std::string> chart_per;  // axes that say what is computed, not how: a Pareto front each
};

/// Throws Failure(kExitInput) with place, key, value and expectation of the first wrong one.
Study read_study(const std::filesystem::path& file);

/// Sequence of axis names over all sweeps, in the order in which they are first named.
std::vector<std::string> axis_names(const Study& study);

}  // namespace driver
