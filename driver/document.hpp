// The scene as TOML: the file with every --set merged into it, each value knowing where it was written.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace driver {

class Document {
 public:
  /// Reads `file` and merges settings into it.
  static Document from_file(const std::filesystem::path& file, const std::vector<std::string>& settings);
  /// Reads TOML text; `name` stands for it in messages.
  static Document from_text(const std::string& text, const std::string& name);

  /// Merges settings into it, in order: "path.to.key=value", or "@file" for all values of a TOML file.
  void merge(const std::vector<std::string>& settings);
  /// Gives the value at a dotted path; missing tables on the way are made. `origin` stands for it in messages.
  void set(const std::string& path, const std::string& value_text, const std::string& origin);

  const toml::table& root() const { return root_; }
  /// Where a node, or the key of a pair in a table, was written: "scene.toml:14:3" or "--set contact.method=x".
  std::string place(const toml::node& node) const { return place(node.source()); }
  std::string place(const toml::key& key) const { return place(key.source()); }
  /// Place of every node by its path as messages write it ("bodies.rod.axis[0]"), made once the merging is done.
  std::map<std::string, std::string> places() const;

  /// The whole merged document as TOML.
  std::string text() const;

 private:
  std::string place(const toml::source_region& region) const;

  std::string name_;  // of the file, as the user wrote it
  std::vector<std::string> merged_;  // other files whose values were merged into it
  toml::table root_;
};

/// Path of a key in a table: "bodies.rod", and of an element of an array: "axis[0]".
std::string child_path(const std::string& parent, std::string_view key);
std::string child_path(const std::string& parent, size_t index);

/// Place of a path in what Document::places gave, or else that of the nearest table around it.
std::string place_of(const std::map<std::string, std::string>& places, const std::string& path);

/// "a table", "a string", ... for messages.
std::string kind_name(const toml::node& node);

}  // namespace driver
