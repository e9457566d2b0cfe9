// Text for people: numbers, durations, sizes, and the nearest known word to a misspelt one.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace driver {

/// Shortest text that reads back as the same double.
std::string shortest(double value);
/// 17 significant digits, so that every double reads back as itself; for files.
std::string exact(double value);
/// Four significant digits, for progress lines.
std::string brief(double value);
/// "1 234 567".
std::string grouped(int64_t value);
/// "12.3 s", "4 min 05 s", "2 h 03 min".
std::string duration(double seconds);
/// "1.23 GB".
std::string bytes(int64_t count);
/// "[1, 0.5, 0]", as --set reads it.
std::string list_text(const std::array<double, 3>& values);
/// "a, b, c".
std::string joined(const std::vector<std::string>& words);

/// The word that takes the fewest edits to reach, "" if none is near enough to be what was meant.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);
/// `; did you mean "x"?` or "".
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

}  // namespace driver
