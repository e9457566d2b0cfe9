// A study as plain values, read from TOML and checked key by key.
#include "study_file.hpp"

#include <algorithm>
#include <set>

#include "failure.hpp"
#include "section.hpp"
#include "text.hpp"

namespace driver {
namespace {

using Names = std::vector<std::string>;
using Labels = std::map<std::string, std::string>;

std::vector<StudySetting> read_settings(const Section& section, const std::filesystem::path& study) {
  std::vector<StudySetting> settings;
  for (std::string text : section.optional_texts("settings")) {
    if (text.empty() || (text[0] != '@' && text.find('=') == std::string::npos)) {
      section.refuse("settings", "must be of the form \"path.to.key=value\" or \"@file\", got \"" + text + '"');
    }
    if (text[0] == '@') text = '@' + (study.parent_path() / text.substr(1)).lexically_normal().string();
    settings.push_back({text, section.place("settings")});
  }
  return settings;
}

/// A table of texts and numbers by names.
Labels read_labels(const Section& section, const std::string& key) {
  Labels labels;
  const auto table = section.optional_table(key, std::nullopt);
  if (!table) return labels;
  for (const std::string& name : table->keys_in_file_order()) labels[name] = table->scalar(name);
  return labels;
}

std::vector<StudyPoint> read_points(const Section& section, const std::filesystem::path& file) {
  std::vector<StudyPoint> points;
  for (const Section& point : section.tables("points", Names{"label", "settings"})) {
    points.push_back({point.scalar("label"), read_settings(point, file)});
  }
  if (points.empty()) section.refuse("points", "must hold at least one point, got none");
  return points;
}

StudyAxis read_axis(const Section& section, const std::filesystem::path& study) {
  StudyAxis axis;
  axis.name = section.text("name");
  const int given = section.has("values") + section.has("points") + section.has("points_from") + section.has("bisect");
  if (given != 1) section.refuse("needs exactly one of values, points, points_from, bisect");
  if (section.has("points") || section.has("points_from")) {
    if (section.has("key")) section.refuse("key", "cannot be with points, which have settings of their own");
    if (section.has("points")) {
      axis.points = read_points(section, study);
    } else {
      const std::filesystem::path file = (study.parent_path() / section.text("points_from")).lexically_normal();
      const Document document = Document::from_file(file, {});
      const Expressions none;
      axis.points = read_points(Section(document, none, document.root(), "", Names{"points"}), file);
    }
  } else {
    axis.key = section.text("key");
    if (section.has("values")) {
      for (const std::string& value : section.scalars("values")) {
        axis.points.push_back({value, {{axis.key + '=' + value, section.place("values")}}});
      }
    } else {
      const std::vector<double> bounds = section.numbers("bisect", 2);
      axis.lowest = bounds[0];
      axis.highest = bounds[1];
      if (!(axis.highest > axis.lowest)) {
        section.refuse("bisect", "must be [lowest, highest], got [" + shortest(bounds[0]) + ", " + shortest(bounds[1]) + ']');
      }
      axis.tolerance = section.number("tolerance", kPositive);
    }
  }
  std::set<std::string> labels;
  for (const StudyPoint& point : axis.points) {
    if (!labels.insert(point.label).second) section.refuse("has two points of the label \"" + point.label + '"');
  }
  return axis;
}

StudySweep read_sweep(const Section& section, const std::filesystem::path& study) {
  StudySweep sweep;
  sweep.name = section.optional_text("name").value_or("");
  sweep.settings = read_settings(section, study);
  sweep.labels = read_labels(section, "labels");
  std::set<std::string> names;
  for (const Section& axis : section.tables("axes", Names{"name", "key", "values", "points", "points_from", "bisect", "tolerance"})) {
    sweep.axes.push_back(read_axis(axis, study));
    if (!names.insert(sweep.axes.back().name).second || sweep.labels.count(sweep.axes.back().name)) {
      axis.refuse("name", "is taken by another axis or label of this sweep: \"" + sweep.axes.back().name + '"');
    }
  }
  const auto bisecting = std::count_if(sweep.axes.begin(), sweep.axes.end(), [](const StudyAxis& a) { return a.bisects(); });
  if (bisecting > 1) section.refuse("axes", "may have one bisected axis, got " + std::to_string(bisecting));
  return sweep;
}

StudyMeasure read_measure(const Section& measures, const std::string& name, const Names& axes, const Names& earlier) {
  const Section section = measures.table(
      name, Names{"summary", "history", "expression", "at", "unit", "reference", "by", "references", "limit", "error", "fails_above"});
  StudyMeasure measure;
  measure.name = name;
  measure.place = measures.place(name);
  const int given = section.has("summary") + section.has("history") + section.has("expression");
  if (given != 1) section.refuse("needs exactly one of summary, history, expression");
  if (section.has("summary")) {
    measure.what = section.text("summary");
  } else if (section.has("history")) {
    measure.source = StudyMeasure::Source::History;
    measure.what = section.text("history");
    if (section.has("at")) {
      const std::string at = section.scalar("at");
      const std::map<std::string, StudyMeasure::At> known = {
          {"end", StudyMeasure::At::End}, {"max", StudyMeasure::At::Largest}, {"min", StudyMeasure::At::Smallest},
          {"last nonzero", StudyMeasure::At::LastOccurrence}};
      const auto found = known.find(at);
      measure.at = found != known.end() ? found->second : StudyMeasure::At::Time;
      if (found == known.end()) measure.time = at;
    }
  } else {
    measure.source = StudyMeasure::Source::Expression;
    measure.what = section.text("expression");
  }
  if (section.has("at") && measure.source != StudyMeasure::Source::History) section.refuse("at", "is a key of history alone");
  measure.unit = section.optional_text("unit").value_or("-");
  if (section.has("reference")) measure.reference = section.scalar("reference");
  measure.references = read_labels(section, "references");
  if (section.has("by") != section.has("references")) section.refuse("by", "and references need each other");
  measure.reference_by = section.optional_text("by").value_or("");
  const auto require_axis = [&](const Section& at, const std::string& key, const std::string& axis) {
    if (std::find(axes.begin(), axes.end(), axis) == axes.end()) {
      at.refuse(key, "must be the name of an axis (" + joined(axes) + "), got \"" + axis + '"' + suggestion(axis, axes));
    }
  };
  if (!measure.reference_by.empty()) require_axis(section, "by", measure.reference_by);
  if (const auto limit = section.optional_table("limit", Names{"axis", "where"})) {
    measure.limit_axis = limit->text("axis");
    require_axis(*limit, "axis", measure.limit_axis);
    measure.limit_labels = read_labels(*limit, "where");
    for (const auto& [axis, label] : measure.limit_labels) require_axis(*limit, "where", axis);
  }
  if (section.has("reference") + section.has("references") + section.has("limit") > 1) {
    section.refuse("may have one of reference, references, limit");
  }
  measure.relative = section.optional_choice("error", {{"relative", 1}, {"absolute", 0}}).value_or(1) != 0;
  measure.fails_above = section.optional_number("fails_above", kNotNegative);
  if (std::find(earlier.begin(), earlier.end(), name) != earlier.end()) section.refuse("is there already");
  return measure;
}

}  // namespace

Study read_study(const std::filesystem::path& file) {
  const Document document = Document::from_file(file, {});
  const Expressions none;
  const Section root(document, none, document.root(), "",
                     Names{"title", "scene", "timeout", "settings", "sweeps", "measures", "verdict", "charts"});
  Study study;
  study.file = file;
  study.title = root.optional_text("title").value_or(file.stem().string());
  study.scene = (file.parent_path() / root.text("scene")).lexically_normal();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(study.scene, ignored)) {
    root.refuse("scene", "must be a scene file, named relative to the study; there is no " + study.scene.string());
  }
  study.timeout = root.optional_number("timeout", kNotNegative).value_or(0);
  study.settings = read_settings(root, file);
  for (const Section& sweep : root.tables("sweeps", Names{"name", "settings", "labels", "axes"})) {
    study.sweeps.push_back(read_sweep(sweep, file));
  }
  if (study.sweeps.empty()) root.refuse("sweeps", "missing; expected at least one table [[sweeps]]");

  const Names axes = axis_names(study);
  Names measures;
  if (const auto section = root.optional_table("measures", std::nullopt)) {
    for (const std::string& name : section->keys_in_file_order()) {
      study.measures.push_back(read_measure(*section, name, axes, measures));
      measures.push_back(name);
    }
  }
  if (const auto verdict = root.optional_table("verdict", Names{"drift", "failure", "speed"})) {
    study.verdict.drift = verdict->optional_number("drift", kPositive).value_or(study.verdict.drift);
    study.verdict.failure = verdict->optional_number("failure", kPositive).value_or(study.verdict.failure);
    if (verdict->has("speed")) study.verdict.speed = verdict->scalar("speed");
  }
  const auto has_error = [](const StudyMeasure& m) {
    return !m.reference.empty() || !m.references.empty() || !m.limit_axis.empty();
  };
  const auto first = std::find_if(study.measures.begin(), study.measures.end(), has_error);
  if (first != study.measures.end()) study.chart_error = first->name;
  if (std::find(axes.begin(), axes.end(), "cell") != axes.end()) study.chart_cell = "cell";
  if (const auto charts = root.optional_table("charts", Names{"error", "cell", "per"})) {
    study.chart_per = charts->optional_texts("per");
    for (const std::string& axis : study.chart_per) {
      if (std::find(axes.begin(), axes.end(), axis) == axes.end()) {
        charts->refuse("per", "must be names of axes (" + joined(axes) + "), got \"" + axis + '"' + suggestion(axis, axes));
      }
    }
    if (const auto error = charts->optional_text("error")) {
      const auto named = std::find_if(study.measures.begin(), study.measures.end(), [&](const StudyMeasure& m) { return m.name == *error; });
      if (named == study.measures.end() || !has_error(*named)) {
        charts->refuse("error", "must be the name of a measure with a reference (" + joined(measures) + "), got \"" + *error + '"' +
                                    suggestion(*error, measures));
      }
      study.chart_error = *error;
    }
    if (const auto cell = charts->optional_text("cell")) {
      if (std::find(axes.begin(), axes.end(), *cell) == axes.end()) {
        charts->refuse("cell", "must be the name of an axis (" + joined(axes) + "), got \"" + *cell + '"' + suggestion(*cell, axes));
      }
      study.chart_cell = *cell;
    }
  }
  return study;
}

std::vector<std::string> axis_names(const Study& study) {
  Names names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const StudySweep& sweep : study.sweeps) {
    for (const StudyAxis& axis : sweep.axes) add(axis.name);
    for (const auto& [name, label] : sweep.labels) add(name);
  }
  return names;
}

}  // namespace driver
