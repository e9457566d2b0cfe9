// What is read from the runs of a study.
#include "study_results.hpp"

#include <ogive.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "expression.hpp"
#include "failure.hpp"
#include "text.hpp"

namespace driver {
namespace {

using Json = nlohmann::ordered_json;
using Labels = std::map<std::string, std::string>;

std::optional<double> number_of(const std::string& text) {
  std::istringstream stream(text);
  double value = 0;
  if (!(stream >> value) || !stream.eof()) return std::nullopt;
  return value;
}

/// history.csv by columns; empty where there is none. A last line that was cut off is left out.
std::map<std::string, std::vector<double>> history_of(const std::filesystem::path& directory) {
  std::map<std::string, std::vector<double>> columns;
  std::ifstream stream(directory / "history.csv");
  std::string line;
  if (!std::getline(stream, line)) return columns;
  std::vector<std::string> names;
  std::istringstream heading(line);
  for (std::string name; std::getline(heading, name, ',');) names.push_back(name);
  while (std::getline(stream, line)) {
    std::vector<double> row;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) row.push_back(std::strtod(field.c_str(), nullptr));
    if (row.size() != names.size()) continue;
    for (size_t i = 0; i < names.size(); ++i) columns[names[i]].push_back(row[i]);
  }
  return columns;
}

Json summary_of(const std::filesystem::path& directory) {
  std::ifstream stream(directory / "summary.json");
  if (!stream) return Json();
  return Json::parse(stream, nullptr, false);
}

/// A number at a dotted path; a number in the path is an element of a list.
std::optional<double> number_at(const Json& json, const std::string& path) {
  const Json* at = &json;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '.');) {
    if (at->is_object() && at->contains(part)) {
      at = &(*at)[part];
    } else if (at->is_array() && part.find_first_not_of("0123456789") == std::string::npos && !part.empty() &&
               part.size() < 10 && std::stoul(part) < at->size()) {
      at = &(*at)[std::stoul(part)];
    } else {
      return std::nullopt;
    }
  }
  if (!at->is_number()) return std::nullopt;
  return at->get<double>();
}

double history_value(const StudyMeasure& measure, double when, const std::vector<double>& time, const std::vector<double>& column) {
  switch (measure.at) {
    case StudyMeasure::At::Largest:
      return *std::max_element(column.begin(), column.end());
    case StudyMeasure::At::Smallest:
      return *std::min_element(column.begin(), column.end());
    case StudyMeasure::At::Time: {
      const auto after = std::lower_bound(time.begin(), time.end(), when);
      if (after == time.end()) return column.back();
      const auto i = static_cast<size_t>(after - time.begin());
      if (i == 0) return column.front();
      const double part = (when - time[i - 1]) / (time[i] - time[i - 1]);
      return column[i - 1] + part * (column[i] - column[i - 1]);
    }
    case StudyMeasure::At::LastOccurrence: {
      const auto last = std::find_if(column.rbegin(), column.rend(), [](double value) { return value != 0; });
      return last == column.rend() ? 0.0 : time[static_cast<size_t>(column.rend() - last) - 1];
    }
    default:
      return column.back();
  }
}

[[noreturn]] void refuse(const StudyMeasure& measure, const std::string& problem) {
  throw Failure(kExitInput, measure.place + ": measures." + measure.name + ": " + problem);
}

/// Scene parameters, axes with numbers for labels, earlier measures.
Expressions symbols_of(const StudyCase& of) {
  Expressions symbols;
  for (const auto& [name, value] : of.parameters) symbols.define(name, value);
  for (const auto& [axis, label] : of.labels) {
    if (const auto number = number_of(label)) symbols.define(axis, *number);
  }
  return symbols;
}

double evaluated(const StudyMeasure& measure, const std::string& key, const Expressions& symbols, const std::string& text) {
  std::string problem;
  const double value = symbols.evaluate(text, problem);
  if (!problem.empty()) refuse(measure, key + " \"" + text + "\": " + problem);
  return value;
}

void set_error(const StudyMeasure& measure, MeasuredValue& of) {
  if (!of.value || !of.reference) return;
  if (!measure.relative) {
    of.error = *of.value - *of.reference;
  } else if (*of.reference != 0) {
    of.error = (*of.value - *of.reference) / *of.reference;
  }
}

void fail(CaseResult& result, const std::string& how, std::optional<double> when) {
  result.verdict = "fails";
  result.how = how;
  result.when = when;
}

std::string percent(double part) { return brief(100 * part) + " %"; }

/// The rules: how a run ended, its fastest particle, the growth and drift of its energy.
void judge(const Study& study, const StudyCase& of, const std::map<std::string, std::vector<double>>& history,
           const Expressions& symbols, CaseResult& result) {
  result.verdict = "stable";
  const auto time = history.find("time");
  const std::optional<double> last_time = time != history.end() && !time->second.empty() ? std::optional(time->second.back()) : std::nullopt;
  std::optional<double> limit;
  if (!study.verdict.speed.empty()) {
    std::string problem;
    limit = symbols.evaluate(study.verdict.speed, problem);
    if (!problem.empty()) {
      throw Failure(kExitInput, study.file.string() + ": verdict.speed \"" + study.verdict.speed + "\": " + problem);
    }
  }
  if (last_time) {
    const auto column = [&](const char* name) -> const std::vector<double>& { return history.at(name); };
    double scale = std::abs(column("total").front() - column("residual").front());
    double worst_drift = 0;
    std::optional<double> drift_time;
    double growth = 0;
    for (size_t i = 0; i < time->second.size(); ++i) {
      scale = std::max({scale, std::abs(column("external_work")[i]) + std::abs(column("prescribed_work")[i])});
      const double part = scale > 0 ? column("residual")[i] / scale : 0;
      result.energy_residual = part;
      growth = std::max(growth, part);
      worst_drift = std::abs(part) > std::abs(worst_drift) ? part : worst_drift;
      result.fastest = column("maximum_speed_ever")[i];
      if (result.verdict == "fails") continue;
      if (!std::isfinite(part) || part > study.verdict.failure) {
        fail(result, "energy grows by more than " + percent(study.verdict.failure), time->second[i]);
      } else if (limit && *result.fastest > *limit) {
        fail(result, "a particle is faster than " + brief(*limit) + ' ' + of.units.speed(), time->second[i]);
      } else if (std::abs(part) > study.verdict.drift && !drift_time) {
        drift_time = time->second[i];
      }
    }
    result.energy_growth = growth;
    if (result.verdict == "stable" && drift_time) {
      result.verdict = "drifts";
      result.how = "energy changes by " + percent(worst_drift);
      result.when = drift_time;
    }
  }
  // The engine's own word counts most, but the rules may have seen it coming.
  if (of.outcome.ending != "done") {
    const std::string earlier = result.verdict == "fails" ? result.how + "; " : "";
    fail(result, earlier + of.outcome.ending + ": " + of.outcome.message, result.verdict == "fails" ? result.when : last_time);
  }
}

bool agree(const Labels& labels, const Labels& with, const std::string& but_for) {
  if (labels.size() != with.size()) return false;
  for (const auto& [axis, label] : labels) {
    const auto other = with.find(axis);
    if (other == with.end() || (axis != but_for && other->second != label)) return false;
  }
  return true;
}

/// Cases of the same labels but for one axis, whose labels are numbers > 0: positions and values of a measure that they have.
std::pair<std::vector<double>, std::vector<double>> series_along(const StudyRun& run, const StudyResults& results, const Labels& labels,
                                                                 const std::string& axis, const std::string& measure,
                                                                 std::vector<size_t>* members = nullptr) {
  std::pair<std::vector<double>, std::vector<double>> series;
  std::set<double> seen;
  for (size_t i = 0; i < results.cases.size(); ++i) {
    if (!agree(run.cases[i].labels, labels, axis)) continue;
    const auto at = number_of(run.cases[i].labels.at(axis));
    const auto value = results.cases[i].values.find(measure);
    if (!at || !(*at > 0) || value == results.cases[i].values.end() || !value->second.value || !seen.insert(*at).second) continue;
    series.first.push_back(*at);
    series.second.push_back(*value->second.value);
    if (members) members->push_back(i);
  }
  return series;
}

void set_limits(const Study& study, const StudyRun& run, StudyResults& results) {
  for (const StudyMeasure& measure : study.measures) {
    if (measure.limit_axis.empty()) continue;
    std::map<Labels, std::optional<double>> known;
    for (size_t i = 0; i < results.cases.size(); ++i) {
      auto found = results.cases[i].values.find(measure.name);
      if (found == results.cases[i].values.end()) continue;
      Labels labels = run.cases[i].labels;
      for (const auto& [axis, label] : measure.limit_labels) labels[axis] = label;
      labels[measure.limit_axis] = "";
      auto limit = known.find(labels);
      if (limit == known.end()) {
        const auto [cells, values] = series_along(run, results, labels, measure.limit_axis, measure.name);
        const auto fit = convergence_of(cells, values);
        limit = known.emplace(labels, fit ? std::optional(fit->limit) : std::nullopt).first;
      }
      found->second.reference = limit->second;
      set_error(measure, found->second);
    }
  }
}

void set_series(const Study& study, const StudyRun& run, StudyResults& results) {
  if (study.chart_cell.empty()) return;
  for (const StudyMeasure& measure : study.measures) {
    std::set<Labels> done;
    for (size_t i = 0; i < run.cases.size(); ++i) {
      Labels labels = run.cases[i].labels;
      if (!labels.count(study.chart_cell)) continue;
      labels[study.chart_cell] = "";
      if (!done.insert(labels).second) continue;
      ConvergenceSeries series;
      std::vector<size_t> members;
      std::tie(series.cells, series.values) = series_along(run, results, labels, study.chart_cell, measure.name, &members);
      if (series.cells.size() < 2) continue;
      series.measure = measure.name;
      labels.erase(study.chart_cell);
      series.labels = labels;
      series.fit = convergence_of(series.cells, series.values);
      std::vector<double> cells, errors;
      for (size_t m = 0; m < members.size(); ++m) {
        const auto& error = results.cases[members[m]].values.at(measure.name).error;
        if (!error) continue;
        cells.push_back(series.cells[m]);
        errors.push_back(*error);
      }
      series.error_order = slope_of(cells, errors);
      results.series.push_back(series);
    }
  }
}

void set_fronts(const Study& study, const StudyRun& run, StudyResults& results) {
  if (study.chart_error.empty()) return;
  const auto error_of = [&](size_t i) -> std::optional<double> {
    const auto found = results.cases[i].values.find(study.chart_error);
    if (found == results.cases[i].values.end() || results.cases[i].verdict == "fails" || !found->second.error) return std::nullopt;
    return std::abs(*found->second.error);
  };
  for (size_t i = 0; i < run.cases.size(); ++i) {
    const auto own = error_of(i);
    if (!own) continue;
    bool beaten = false;
    for (size_t j = 0; j < run.cases.size() && !beaten; ++j) {
      const auto other = error_of(j);
      if (j == i || !other) continue;
      bool same_kind = true;
      for (const std::string& axis : study.chart_per) {
        const auto a = run.cases[i].labels.find(axis), b = run.cases[j].labels.find(axis);
        const bool has_a = a != run.cases[i].labels.end(), has_b = b != run.cases[j].labels.end();
        same_kind = same_kind && has_a == has_b && (!has_a || a->second == b->second);
      }
      if (!same_kind) continue;
      const double own_time = run.cases[i].outcome.cpu_seconds, other_time = run.cases[j].outcome.cpu_seconds;
      beaten = *other <= *own && other_time <= own_time && (*other < *own || other_time < own_time);
    }
    results.cases[i].on_front = !beaten;
  }
}

template <typename Value>
Json json_or_null(const std::optional<Value>& value) {
  if (!value) return Json();
  if constexpr (std::is_floating_point_v<Value>) {
    if (!std::isfinite(*value)) return Json();
  }
  return Json(*value);
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + '"';
}

template <typename Value>
std::string csv_number(const std::optional<Value>& value) {
  if (!value) return "";
  if constexpr (std::is_floating_point_v<Value>) {
    return shortest(*value);
  } else {
    return std::to_string(*value);
  }
}

/// Whole paths belong to a machine, not to a study.
std::string without_directory(const Study& study, const std::string& text) {
  std::string result = text;
  for (const std::filesystem::path& directory : {study.file.parent_path(), study.scene.parent_path()}) {
    const std::string prefix = directory.string() + '/';
    if (prefix.size() < 2) continue;
    for (size_t at = result.find(prefix); at != std::string::npos; at = result.find(prefix, at)) result.erase(at, prefix.size());
  }
  return result;
}

}  // namespace

CaseResult result_of(const Study& study, const StudyCase& of) {
  CaseResult result;
  const Json summary = summary_of(of.outcome.directory);
  const auto history = history_of(of.outcome.directory);
  Expressions symbols = symbols_of(of);
  judge(study, of, history, symbols, result);

  if (of.outcome.ending == "done") {
    const auto number = [&](const char* path) { return number_at(summary, path); };
    const auto whole = [&](const char* path) -> std::optional<int64_t> {
      const auto value = number(path);
      return value ? std::optional(static_cast<int64_t>(*value)) : std::nullopt;
    };
    result.steps = whole("steps");
    result.particles = whole("particles");
    result.particle_steps = whole("particle_steps");
    result.start_seconds = number("cpu_seconds.start");
    result.stepping_seconds = number("cpu_seconds.stepping");
    result.output_seconds = number("cpu_seconds.output");
    for (const StudyMeasure& measure : study.measures) {
      MeasuredValue measured;
      std::string problem;
      const double unit = of.units.size_of_unit(measure.unit, problem);
      if (!problem.empty()) refuse(measure, "unit: " + problem);
      if (measure.source == StudyMeasure::Source::Summary) {
        measured.value = number_at(summary, measure.what);
        if (!measured.value) refuse(measure, "summary: there is no number \"" + measure.what + "\" in summary.json");
        *measured.value /= unit;
      } else if (measure.source == StudyMeasure::Source::History) {
        const auto column = history.find(measure.what);
        if (column == history.end() || column->second.empty()) {
          refuse(measure, "history: there is no column \"" + measure.what + "\" in history.csv");
        }
        const double when = measure.time.empty() ? 0.0 : evaluated(measure, "at", symbols, measure.time);
        measured.value = history_value(measure, when, history.at("time"), column->second) / unit;
      } else {
        measured.value = evaluated(measure, "expression", symbols, measure.what);
      }
      if (!std::isfinite(*measured.value)) measured.value.reset();
      if (!measure.reference.empty()) measured.reference = evaluated(measure, "reference", symbols, measure.reference);
      if (!measure.reference_by.empty()) {
        const auto label = of.labels.find(measure.reference_by);
        const auto found = label == of.labels.end() ? measure.references.end() : measure.references.find(label->second);
        if (found != measure.references.end()) measured.reference = evaluated(measure, "references", symbols, found->second);
      }
      set_error(measure, measured);
      if (measured.value) symbols.define(measure.name, *measured.value);
      if (measured.reference) symbols.define(measure.name + "_reference", *measured.reference);
      result.values[measure.name] = measured;
      if (!measure.fails_above || result.verdict == "fails") continue;
      if (!measured.value) {
        fail(result, measure.name + " is not finite", std::nullopt);
      } else if (measured.error && std::abs(*measured.error) > *measure.fails_above) {
        fail(result, measure.name + " is off by " +
                         (measure.relative ? percent(*measured.error) : brief(*measured.error) + ' ' + measure.unit),
             std::nullopt);
      }
    }
  }
  return result;
}

StudyResults results_of(const Study& study, const StudyRun& run) {
  StudyResults results;
  for (const StudyCase& of : run.cases) {
    // A case that an interruption left out has no outcome.
    results.cases.push_back(of.outcome.ending.empty() ? CaseResult{} : result_of(study, of));
  }
  set_limits(study, run, results);
  set_series(study, run, results);
  set_fronts(study, run, results);
  return results;
}

nlohmann::ordered_json study_json(const Study& study, const StudyRun& run, const StudyResults& results) {
  Json json;
  json["format"] = "ogive-study";
  json["format_version"] = 1;
  json["title"] = study.title;
  json["study"] = study.file.filename().string();
  const std::filesystem::path home = study.file.parent_path().empty() ? "." : study.file.parent_path();
  json["scene"] = study.scene.lexically_proximate(home).generic_string();
  json["version"] = ogive_version();
  json["complete"] = !run.interrupted;
  json["axes"] = axis_names(study);
  json["charts"] = {{"error", study.chart_error}, {"cell", study.chart_cell}, {"per", study.chart_per}};
  json["verdict"] = {{"drift", study.verdict.drift}, {"failure", study.verdict.failure}, {"speed", study.verdict.speed}};
  json["measures"] = Json::array();
  for (const StudyMeasure& measure : study.measures) {
    json["measures"].push_back({{"name", measure.name}, {"unit", measure.unit}, {"error", measure.relative ? "relative" : "absolute"}});
  }
  json["cases"] = Json::array();
  for (size_t i = 0; i < run.cases.size(); ++i) {
    const StudyCase& of = run.cases[i];
    const CaseResult& result = results.cases[i];
    if (of.outcome.ending.empty()) continue;
    Json entry;
    entry["sweep"] = study.sweeps[of.sweep].name;
    entry["labels"] = of.labels;
    entry["settings"] = Json::array();
    for (const StudySetting& setting : of.settings) entry["settings"].push_back(without_directory(study, setting.text));
    entry["key"] = of.key;
    entry["time_unit"] = of.units.time;
    entry["ending"] = of.outcome.ending;
    entry["message"] = without_directory(study, of.outcome.message);
    entry["verdict"] = result.verdict;
    entry["how"] = without_directory(study, result.how);
    entry["when"] = json_or_null(result.when);
    entry["values"] = Json::object();
    for (const StudyMeasure& measure : study.measures) {
      const auto found = result.values.find(measure.name);
      if (found == result.values.end()) continue;
      entry["values"][measure.name] = {{"value", json_or_null(found->second.value)},
                                       {"reference", json_or_null(found->second.reference)},
                                       {"error", json_or_null(found->second.error)}};
    }
    entry["energy_residual"] = json_or_null(result.energy_residual);
    entry["energy_growth"] = json_or_null(result.energy_growth);
    entry["fastest_particle"] = json_or_null(result.fastest);
    entry["cost"] = {{"cpu_seconds", of.outcome.cpu_seconds},
                     {"start_seconds", json_or_null(result.start_seconds)},
                     {"stepping_seconds", json_or_null(result.stepping_seconds)},
                     {"output_seconds", json_or_null(result.output_seconds)},
                     {"steps", json_or_null(result.steps)},
                     {"particles", json_or_null(result.particles)},
                     {"particle_steps", json_or_null(result.particle_steps)},
                     {"memory_bytes", of.outcome.memory_bytes}};
    entry["on_front"] = result.on_front;
    json["cases"].push_back(entry);
  }
  json["bisections"] = Json::array();
  for (const Bisection& found : run.bisections) {
    json["bisections"].push_back({{"sweep", study.sweeps[found.sweep].name},
                                  {"labels", found.labels},
                                  {"axis", found.axis},
                                  {"largest_stable", found.none_stable ? Json() : Json(found.largest)},
                                  {"smallest_unstable", found.all_stable ? Json() : Json(found.unstable)},
                                  {"how", without_directory(study, found.how)}});
  }
  json["convergence"] = Json::array();
  for (const ConvergenceSeries& series : results.series) {
    Json entry = {{"labels", series.labels}, {"measure", series.measure}, {"cells", series.cells}, {"values", series.values}};
    entry["limit"] = series.fit ? Json(series.fit->limit) : Json();
    entry["order"] = series.fit ? Json(series.fit->order) : Json();
    entry["uncertainty"] = series.fit ? Json(series.fit->uncertainty) : Json();
    entry["error_order"] = json_or_null(series.error_order);
    json["convergence"].push_back(entry);
  }
  return json;
}

std::string study_csv(const Study& study, const StudyRun& run, const StudyResults& results) {
  const std::vector<std::string> axes = axis_names(study);
  std::string text = "sweep";
  for (const std::string& axis : axes) text += ',' + csv_field(axis);
  text += ",ending,verdict,how,when";
  for (const StudyMeasure& measure : study.measures) {
    text += ',' + measure.name + ',' + measure.name + "_reference," + measure.name + "_error";
  }
  text += ",energy_residual,energy_growth,fastest_particle,cpu_seconds,start_seconds,stepping_seconds,output_seconds,steps,"
          "particles,particle_steps,memory_bytes,on_front\n";
  for (size_t i = 0; i < run.cases.size(); ++i) {
    const StudyCase& of = run.cases[i];
    const CaseResult& result = results.cases[i];
    if (of.outcome.ending.empty()) continue;
    text += csv_field(study.sweeps[of.sweep].name);
    for (const std::string& axis : axes) {
      const auto label = of.labels.find(axis);
      text += ',' + (label == of.labels.end() ? "" : csv_field(label->second));
    }
    text += ',' + of.outcome.ending + ',' + result.verdict + ',' + csv_field(without_directory(study, result.how)) + ',' + csv_number(result.when);
    for (const StudyMeasure& measure : study.measures) {
      const auto found = result.values.find(measure.name);
      const MeasuredValue value = found == result.values.end() ? MeasuredValue{} : found->second;
      text += ',' + csv_number(value.value) + ',' + csv_number(value.reference) + ',' + csv_number(value.error);
    }
    text += ',' + csv_number(result.energy_residual) + ',' + csv_number(result.energy_growth) + ',' + csv_number(result.fastest) + ',' +
            shortest(of.outcome.cpu_seconds) + ',' + csv_number(result.start_seconds) + ',' + csv_number(result.stepping_seconds) +
            ',' + csv_number(result.output_seconds) + ',' + csv_number(result.steps) + ',' + csv_number(result.particles) + ',' +
            csv_number(result.particle_steps) + ',' + std::to_string(of.outcome.memory_bytes) + ',' + (result.on_front ? "1" : "0") + '\n';
  }
  return text;
}

}  // namespace driver
