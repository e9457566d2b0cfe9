// The scene as TOML: the file with every --set merged into it, each value knowing where it was written.
#include "document.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "failure.hpp"

namespace driver {
namespace {

toml::table parsed(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    std::ostringstream message;
    message << name << ':' << error.source().begin.line << ':' << error.source().begin.column
            << ": not valid TOML: " << error.description();
    throw Failure(kExitInput, message.str());
  }
}

/// Text of a --set as a value: TOML where it is TOML, else a string, since a shell eats the quotes.
toml::table parsed_value(const std::string& value_text, const std::string& origin) {
  if (value_text.find('\n') == std::string::npos) {
    try {
      toml::table table = toml::parse("value = " + value_text, origin);
      if (table.size() == 1) return table;
    } catch (const toml::parse_error&) {
      // Not TOML: a bare word or an expression.
    }
  }
  std::string quoted = "value = \"";
  for (const char letter : value_text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter == '\n' ? std::string("\\n") : std::string(1, letter);
  }
  return parsed(quoted + '"', origin);
}

std::vector<std::string> split_path(const std::string& path, const std::string& origin) {
  std::vector<std::string> parts;
  std::istringstream stream(path);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  bool good = !parts.empty() && path.back() != '.';
  for (const std::string& part : parts) {
    good = good && !part.empty() && part.find_first_of(" \t\"'[]") == std::string::npos;
  }
  if (!good) throw Failure(kExitInput, origin + ": expected path.to.key=value, got the path \"" + path + "\"");
  return parts;
}

/// Index of an array element, -1 if the part is none.
int64_t array_index(const std::string& part, size_t size) {
  if (part.empty() || part.size() > 9 || part.find_first_not_of("0123456789") != std::string::npos) return -1;
  const int64_t index = std::stoll(part);
  return index < static_cast<int64_t>(size) ? index : -1;
}

void collect(const Document& document, const toml::node& node, const std::string& path, const std::string& parent_place,
             std::map<std::string, std::string>& places) {
  std::string place = document.place(node);
  if (place.empty()) place = parent_place;
  places[path] = place;
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, child] : *table) {
      const std::string key_place = document.place(key);
      collect(document, child, child_path(path, key.str()), key_place.empty() ? place : key_place, places);
    }
  } else if (const toml::array* array = node.as_array()) {
    for (size_t i = 0; i < array->size(); ++i) collect(document, (*array)[i], child_path(path, i), place, places);
  }
}

std::string text_of(const std::filesystem::path& file, const char* expected) {
  std::ifstream stream(file, std::ios::binary);
  std::error_code ignored;
  if (!stream || std::filesystem::is_directory(file, ignored)) {
    throw Failure(kExitInput, file.string() + ": cannot be read; expected " + expected);
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Tables are merged, everything else of `from` replaces what `to` has. Moved, not copied: a copy forgets where it was
/// written.
void merge_tables(toml::table& to, toml::table&& from) {
  for (auto&& entry : from) {
    const toml::key& key = entry.first;  // by name: clang 14 lets no lambda take part of a structured binding
    toml::node& value = entry.second;
    toml::table* const inner = to.get(key) ? to.get(key)->as_table() : nullptr;
    if (inner && value.is_table()) {
      merge_tables(*inner, std::move(*value.as_table()));
    } else {
      to.erase(key);
      value.visit([&](auto& concrete) { to.insert(key, std::move(concrete)); });
    }
  }
}

}  // namespace

Document Document::from_file(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  Document document = from_text(text_of(file, "a scene file (TOML)"), file.string());
  document.merge(settings);
  return document;
}

void Document::merge(const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    if (!setting.empty() && setting.front() == '@') {
      const std::string name = setting.substr(1);
      merged_.push_back(name);
      merge_tables(root_, parsed(text_of(name, "a file of settings (TOML) after \"--set @\""), name));
      continue;
    }
    const size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw Failure(kExitInput, "--set " + setting + ": expected path.to.key=value, got no \"=\"");
    }
    set(setting.substr(0, equals), setting.substr(equals + 1), "--set " + setting);
  }
}

Document Document::from_text(const std::string& text, const std::string& name) {
  Document document;
  document.name_ = name;
  document.root_ = parsed(text, name);
  return document;
}

void Document::set(const std::string& path, const std::string& value_text, const std::string& origin) {
  const std::vector<std::string> parts = split_path(path, origin);
  toml::table value_holder = parsed_value(value_text, origin);
  const auto source_path = std::make_shared<const std::string>(origin);
  const auto key_of = [&](const std::string& part) {
    return toml::key(part, toml::source_region{{0, 0}, {0, 0}, source_path});
  };
  const auto blocked = [&](const std::string& part, const toml::node& at) -> Failure {
    return Failure(kExitInput, origin + ": \"" + part + "\" cannot be set inside " + kind_name(at) +
                                   "; expected a table, or the number of an element of an array");
  };

  toml::node* at = &root_;
  for (size_t i = 0; i < parts.size(); ++i) {
    const std::string& part = parts[i];
    const bool last = i + 1 == parts.size();
    if (toml::table* table = at->as_table()) {
      if (last) {
        // Moved, not copied: a copy forgets where it was written.
        table->erase(part);
        value_holder.get("value")->visit([&](auto& value) { table->insert(key_of(part), std::move(value)); });
        return;
      }
      if (!table->contains(part)) table->insert(key_of(part), toml::table{});
      at = table->get(part);
    } else if (toml::array* array = at->as_array()) {
      const int64_t index = array_index(part, array->size());
      if (index < 0) throw blocked(part, *at);
      if (last) {
        const auto position = array->begin() + index;
        value_holder.get("value")->visit([&](auto& value) { array->replace(position, std::move(value)); });
        return;
      }
      at = array->get(static_cast<size_t>(index));
    } else {
      throw blocked(part, *at);
    }
  }
}

std::string Document::place(const toml::source_region& region) const {
  if (!region.path) return "";
  const bool of_a_file =
      *region.path == name_ || std::find(merged_.begin(), merged_.end(), *region.path) != merged_.end();
  if (!of_a_file) return *region.path;
  if (region.begin.line == 0) return "";
  return *region.path + ':' + std::to_string(region.begin.line) + ':' + std::to_string(region.begin.column);
}

std::map<std::string, std::string> Document::places() const {
  std::map<std::string, std::string> result;
  collect(*this, root_, "", name_, result);
  result[""] = name_;
  return result;
}

std::string Document::text() const {
  std::ostringstream stream;
  stream << toml::toml_formatter(root_,
                                 toml::toml_formatter::default_flags & ~toml::format_flags::allow_unicode_strings)
         << '\n';
  return stream.str();
}

std::string child_path(const std::string& parent, std::string_view key) {
  return parent.empty() ? std::string(key) : parent + '.' + std::string(key);
}

std::string child_path(const std::string& parent, size_t index) { return parent + '[' + std::to_string(index) + ']'; }

std::string place_of(const std::map<std::string, std::string>& places, const std::string& path) {
  for (std::string at = path;;) {
    const auto found = places.find(at);
    if (found != places.end()) return found->second;
    const size_t cut = at.find_last_of(".[");
    if (cut == std::string::npos) return places.at("");
    at.resize(cut);
  }
}

std::string kind_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return "the text \"" + std::string(node.as_string()->get()) + "\"";
    case toml::node_type::integer:
      return "the number " + std::to_string(node.as_integer()->get());
    case toml::node_type::floating_point: {
      std::ostringstream text;
      text << "the number " << node.as_floating_point()->get();
      return text.str();
    }
    case toml::node_type::boolean:
      return node.as_boolean()->get() ? "true" : "false";
    default:
      return "a date or time";
  }
}

}  // namespace driver
