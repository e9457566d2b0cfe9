// One table of a scene: typed access to its values, each checked as it is read, with messages that name place, key,
// value and expectation.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "document.hpp"
#include "expression.hpp"

namespace driver {

/// What a number must be.
struct Range {
  std::function<bool(double)> holds;
  std::string expected;  // "> 0"
};
extern const Range kAnyNumber, kPositive, kNotNegative, kZeroToOne, kPoissonRatio;

/// Names of a choice in the scene and what they stand for.
using Choices = std::vector<std::pair<std::string, int32_t>>;

class Section {
 public:
  using Vector3 = std::array<double, 3>;

  /// Refuses keys that are not among `known`; without a list any key is welcome.
  Section(const Document& document, const Expressions& expressions, const toml::table& table, std::string path,
          std::optional<std::vector<std::string>> known);

  const std::string& path() const { return path_; }
  bool has(const std::string& key) const { return table_->contains(key); }
  /// Keys of the sub-tables' and values' names in the order of the file, those set from outside last.
  std::vector<std::string> keys_in_file_order() const;

  double number(const std::string& key, const Range& range) const;
  std::optional<double> optional_number(const std::string& key, const Range& range) const;
  std::optional<int64_t> optional_integer(const std::string& key, int64_t lowest, int64_t highest) const;
  std::optional<bool> optional_flag(const std::string& key) const;
  std::string text(const std::string& key) const;
  std::optional<std::string> optional_text(const std::string& key) const;
  std::optional<int32_t> optional_choice(const std::string& key, const Choices& choices) const;
  Vector3 vector(const std::string& key) const;
  std::optional<Vector3> optional_vector(const std::string& key) const;
  /// A direction: not the zero vector.
  std::optional<Vector3> optional_direction(const std::string& key) const;
  /// A number for all three directions, or three numbers.
  Vector3 number_or_vector(const std::string& key, const Range& range) const;
  std::vector<std::string> texts(const std::string& key, size_t count) const;
  /// A list of texts of any length; empty if there is none.
  std::vector<std::string> optional_texts(const std::string& key) const;
  /// A list, not empty, of numbers, texts and true or false, each as --set writes it.
  std::vector<std::string> scalars(const std::string& key) const;
  /// One such value.
  std::string scalar(const std::string& key) const;
  std::vector<double> numbers(const std::string& key, size_t count) const;
  /// Where the value of `key` was written, or else the table.
  std::string place(const std::string& key) const;

  Section table(const std::string& key, std::optional<std::vector<std::string>> known) const;
  std::optional<Section> optional_table(const std::string& key, std::optional<std::vector<std::string>> known) const;
  /// An array of tables, [[key]]; empty if there is none.
  std::vector<Section> tables(const std::string& key, const std::vector<std::string>& known) const;

  /// Ends the reading with a message about the value of `key`, which may be missing.
  [[noreturn]] void refuse(const std::string& key, const std::string& problem) const;
  /// The same about the table itself.
  [[noreturn]] void refuse(const std::string& problem) const;
  /// The same about a name that must be one of `known` ("body", "material").
  [[noreturn]] void refuse_name(const std::string& key, const std::string& kind, const std::string& got,
                                const std::vector<std::string>& known) const;

 private:
  std::string scalar_of(const toml::node& node, const std::string& key, const std::string& expected) const;
  const toml::node& required(const std::string& key, const std::string& expected) const;
  double number_of(const toml::node& node, const std::string& path, const Range& range) const;
  Vector3 vector_of(const toml::node& node, const std::string& path, const Range& range) const;
  [[noreturn]] void refuse_path(const std::string& path, const std::string& problem) const;

  const Document* document_;
  const Expressions* expressions_;
  const toml::table* table_;
  std::string path_;
};

}  // namespace driver
