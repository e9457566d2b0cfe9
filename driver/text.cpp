// Text for people: numbers, durations, sizes, and the nearest known word to a misspelt one.
#include "text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace driver {
namespace {

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[64];
  const int length = std::snprintf(buffer, sizeof buffer, format, values...);
  return std::string(buffer, std::clamp<int>(length, 0, sizeof buffer - 1));
}

/// Edits (insert, remove, replace, swap neighbours) that turn one word into the other.
size_t edit_distance(std::string_view first, std::string_view second) {
  std::vector<size_t> before_previous(second.size() + 1), previous(second.size() + 1), current(second.size() + 1);
  std::iota(previous.begin(), previous.end(), size_t{0});
  for (size_t i = 1; i <= first.size(); ++i) {
    current[0] = i;
    for (size_t j = 1; j <= second.size(); ++j) {
      const size_t replaced = previous[j - 1] + (first[i - 1] == second[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && first[i - 1] == second[j - 2] && first[i - 2] == second[j - 1]) {
        current[j] = std::min(current[j], before_previous[j - 2] + 1);
      }
    }
    before_previous.swap(previous);
    previous.swap(current);
  }
  return previous[second.size()];
}

}  // namespace

std::string shortest(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

std::string exact(double value) { return formatted("%.17g", value); }

std::string brief(double value) { return formatted("%.4g", value); }

std::string grouped(int64_t value) {
  const std::string digits = std::to_string(value);
  std::string text;
  for (size_t i = 0; i < digits.size(); ++i) {
    const bool between_digits = i > 0 && digits[i - 1] != '-';
    if (between_digits && (digits.size() - i) % 3 == 0) text += ' ';
    text += digits[i];
  }
  return text;
}

std::string duration(double seconds) {
  if (!(seconds >= 0) || seconds > 1e9) return "unknown";
  if (seconds < 1) return formatted("%.2f s", seconds);
  if (seconds < 99.95) return formatted("%.1f s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 3600) return formatted("%lld min %02lld s", whole / 60, whole % 60);
  return formatted("%lld h %02lld min", whole / 3600, whole % 3600 / 60);
}

std::string bytes(int64_t count) {
  const auto value = static_cast<double>(count);
  if (value < 1e3) return formatted("%.0f B", value);
  if (value < 1e6) return formatted("%.1f kB", value / 1e3);
  if (value < 1e9) return formatted("%.1f MB", value / 1e6);
  return formatted("%.2f GB", value / 1e9);
}

std::string list_text(const std::array<double, 3>& values) {
  return '[' + shortest(values[0]) + ", " + shortest(values[1]) + ", " + shortest(values[2]) + ']';
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  // A third of the letters wrong is still a slip of the pen; more is another word.
  size_t best = std::max<size_t>(word.size() / 3, 1) + 1;
  std::string nearest;
  for (const std::string& candidate : known) {
    const size_t distance = edit_distance(word, candidate);
    if (distance < best && distance < std::max(word.size(), candidate.size())) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(word, known);
  return nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?";
}

}  // namespace driver
