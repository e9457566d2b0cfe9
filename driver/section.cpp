// One table of a scene: typed, checked access to its values.
#include "section.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "failure.hpp"
#include "text.hpp"

namespace driver {

const Range kAnyNumber = {[](double) { return true; }, "a number"};
const Range kPositive = {[](double value) { return value > 0; }, "> 0"};
const Range kNotNegative = {[](double value) { return value >= 0; }, ">= 0"};
const Range kZeroToOne = {[](double value) { return value >= 0 && value <= 1; }, "between 0 and 1"};
const Range kPoissonRatio = {[](double value) { return value > -1 && value < 0.5; }, "> -1 and < 0.5"};

Section::Section(const Document& document, const Expressions& expressions, const toml::table& table, std::string path,
                 std::optional<std::vector<std::string>> known)
    : document_(&document), expressions_(&expressions), table_(&table), path_(std::move(path)) {
  if (!known) return;
  for (const std::string& key : keys_in_file_order()) {
    if (std::find(known->begin(), known->end(), key) != known->end()) continue;
    // The key's own place, not its value's.
    const std::string place = document.place(table.find(key)->first);
    throw Failure(kExitInput, (place.empty() ? place_of(document.places(), child_path(path_, key)) : place) + ": " +
                                  child_path(path_, key) + ": unknown key" + suggestion(key, *known) +
                                  " (known here: " + joined(*known) + ")");
  }
}

std::vector<std::string> Section::keys_in_file_order() const {
  std::vector<std::tuple<bool, uint32_t, uint32_t, std::string>> order;
  for (const auto& [key, node] : *table_) {
    const toml::source_position at = key.source().begin;
    order.emplace_back(at.line == 0, at.line, at.column, std::string(key.str()));
  }
  std::sort(order.begin(), order.end());
  std::vector<std::string> keys;
  for (const auto& entry : order) keys.push_back(std::get<3>(entry));
  return keys;
}

void Section::refuse_path(const std::string& path, const std::string& problem) const {
  throw Failure(kExitInput, place_of(document_->places(), path) + ": " + path + ": " + problem);
}

void Section::refuse(const std::string& key, const std::string& problem) const {
  refuse_path(child_path(path_, key), problem);
}

void Section::refuse(const std::string& problem) const { refuse_path(path_, problem); }

void Section::refuse_name(const std::string& key, const std::string& kind, const std::string& got,
                          const std::vector<std::string>& known) const {
  refuse(key, "must be the name of a " + kind + " of the scene (" + joined(known) + "), got \"" + got + '"' +
                  suggestion(got, known));
}

const toml::node& Section::required(const std::string& key, const std::string& expected) const {
  const toml::node* node = table_->get(key);
  if (!node) refuse(key, "missing; expected " + expected);
  return *node;
}

double Section::number_of(const toml::node& node, const std::string& path, const Range& range) const {
  double value = 0;
  std::string shown;
  if (const auto* integer = node.as_integer()) {
    value = static_cast<double>(integer->get());
  } else if (const auto* floating = node.as_floating_point()) {
    value = floating->get();
  } else if (const auto* string = node.as_string()) {
    std::string problem;
    value = expressions_->evaluate(string->get(), problem);
    if (!problem.empty()) {
      refuse_path(path, "must be a number or an expression, got \"" + string->get() + "\": " + problem);
    }
    shown = " from \"" + string->get() + '"';
  } else {
    refuse_path(path, "must be a number, got " + kind_name(node));
  }
  if (!std::isfinite(value)) refuse_path(path, "must be finite, got " + shortest(value) + shown);
  if (!range.holds(value)) refuse_path(path, "must be " + range.expected + ", got " + shortest(value) + shown);
  return value;
}

double Section::number(const std::string& key, const Range& range) const {
  return number_of(required(key, range.expected == "a number" ? range.expected : "a number " + range.expected),
                   child_path(path_, key), range);
}

std::optional<double> Section::optional_number(const std::string& key, const Range& range) const {
  if (!has(key)) return std::nullopt;
  return number(key, range);
}

std::optional<int64_t> Section::optional_integer(const std::string& key, int64_t lowest, int64_t highest) const {
  if (!has(key)) return std::nullopt;
  const Range whole = {[&](double value) {
                         return value == std::floor(value) && value >= static_cast<double>(lowest) &&
                                value <= static_cast<double>(highest);
                       },
                       "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest)};
  return static_cast<int64_t>(number(key, whole));
}

std::optional<bool> Section::optional_flag(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  const toml::node& node = *table_->get(key);
  if (!node.is_boolean()) refuse(key, "must be true or false, got " + kind_name(node));
  return node.as_boolean()->get();
}

std::string Section::text(const std::string& key) const {
  const toml::node& node = required(key, "a text");
  if (!node.is_string()) refuse(key, "must be a text, got " + kind_name(node));
  return node.as_string()->get();
}

std::optional<std::string> Section::optional_text(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return text(key);
}

std::optional<int32_t> Section::optional_choice(const std::string& key, const Choices& choices) const {
  if (!has(key)) return std::nullopt;
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) names.push_back(name);
  const toml::node& node = *table_->get(key);
  if (!node.is_string()) refuse(key, "must be one of " + joined(names) + ", got " + kind_name(node));
  const std::string& got = node.as_string()->get();
  for (const auto& [name, value] : choices) {
    if (name == got) return value;
  }
  refuse(key, "must be one of " + joined(names) + ", got \"" + got + '"' + suggestion(got, names));
}

Section::Vector3 Section::vector_of(const toml::node& node, const std::string& path, const Range& range) const {
  const toml::array* array = node.as_array();
  if (!array) refuse_path(path, "must be a list of 3 numbers, got " + kind_name(node));
  if (array->size() != 3) {
    refuse_path(path, "must be a list of 3 numbers, got " + std::to_string(array->size()));
  }
  Vector3 values{};
  for (size_t i = 0; i < 3; ++i) values[i] = number_of((*array)[i], child_path(path, i), range);
  return values;
}

Section::Vector3 Section::vector(const std::string& key) const {
  return vector_of(required(key, "a list of 3 numbers"), child_path(path_, key), kAnyNumber);
}

std::optional<Section::Vector3> Section::optional_vector(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return vector(key);
}

std::optional<Section::Vector3> Section::optional_direction(const std::string& key) const {
  const std::optional<Vector3> direction = optional_vector(key);
  if (direction && std::hypot((*direction)[0], (*direction)[1], (*direction)[2]) == 0) {
    refuse(key, "must be a direction other than [0, 0, 0]");
  }
  return direction;
}

Section::Vector3 Section::number_or_vector(const std::string& key, const Range& range) const {
  const toml::node& node = required(key, "a number " + range.expected + " or a list of 3 of them");
  if (node.is_array()) return vector_of(node, child_path(path_, key), range);
  const double value = number_of(node, child_path(path_, key), range);
  return {value, value, value};
}

std::vector<std::string> Section::texts(const std::string& key, size_t count) const {
  const std::string expected = "a list of " + std::to_string(count) + " texts";
  const toml::node& node = required(key, expected);
  const toml::array* array = node.as_array();
  if (!array) refuse(key, "must be " + expected + ", got " + kind_name(node));
  if (array->size() != count) refuse(key, "must be " + expected + ", got " + std::to_string(array->size()));
  std::vector<std::string> values;
  for (const toml::node& element : *array) {
    if (!element.is_string()) refuse(key, "must be " + expected + ", got " + kind_name(element) + " in it");
    values.push_back(element.as_string()->get());
  }
  return values;
}

std::vector<std::string> Section::optional_texts(const std::string& key) const {
  if (!has(key)) return {};
  const toml::array* array = table_->get(key)->as_array();
  if (!array) refuse(key, "must be a list of texts, got " + kind_name(*table_->get(key)));
  return texts(key, array->size());
}

std::string Section::scalar_of(const toml::node& node, const std::string& key, const std::string& expected) const {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
  if (const auto* floating = node.as_floating_point()) return shortest(floating->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  refuse(key, "must be " + expected + ", got " + kind_name(node));
}

std::vector<std::string> Section::scalars(const std::string& key) const {
  const std::string expected = "a list of numbers, texts, true or false";
  const toml::node& node = required(key, expected);
  const toml::array* array = node.as_array();
  if (!array) refuse(key, "must be " + expected + ", got " + kind_name(node));
  if (array->empty()) refuse(key, "must be " + expected + ", got an empty one");
  std::vector<std::string> values;
  for (const toml::node& element : *array) values.push_back(scalar_of(element, key, expected));
  return values;
}

std::string Section::scalar(const std::string& key) const {
  const std::string expected = "a number, a text, true or false";
  return scalar_of(required(key, expected), key, expected);
}

std::vector<double> Section::numbers(const std::string& key, size_t count) const {
  const std::string expected = "a list of " + std::to_string(count) + " numbers";
  const toml::node& node = required(key, expected);
  const toml::array* array = node.as_array();
  if (!array || array->size() != count) refuse(key, "must be " + expected);
  std::vector<double> values;
  for (size_t i = 0; i < count; ++i) {
    values.push_back(number_of((*array)[i], child_path(child_path(path_, key), i), kAnyNumber));
  }
  return values;
}

std::string Section::place(const std::string& key) const {
  return place_of(document_->places(), child_path(path_, key));
}

Section Section::table(const std::string& key, std::optional<std::vector<std::string>> known) const {
  const toml::node& node = required(key, "a table");
  if (!node.is_table()) refuse(key, "must be a table, got " + kind_name(node));
  return Section(*document_, *expressions_, *node.as_table(), child_path(path_, key), std::move(known));
}

std::optional<Section> Section::optional_table(const std::string& key,
                                               std::optional<std::vector<std::string>> known) const {
  if (!has(key)) return std::nullopt;
  return table(key, std::move(known));
}

std::vector<Section> Section::tables(const std::string& key, const std::vector<std::string>& known) const {
  std::vector<Section> sections;
  if (!has(key)) return sections;
  const toml::node& node = *table_->get(key);
  const toml::array* array = node.as_array();
  if (!array) refuse(key, "must be a list of tables, [[" + child_path(path_, key) + "]], got " + kind_name(node));
  for (size_t i = 0; i < array->size(); ++i) {
    const toml::node& element = (*array)[i];
    const std::string path = child_path(child_path(path_, key), i);
    if (!element.is_table()) refuse_path(path, "must be a table, got " + kind_name(element));
    sections.emplace_back(*document_, *expressions_, *element.as_table(), path, known);
  }
  return sections;
}

}  // namespace driver
