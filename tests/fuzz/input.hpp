// What a fuzzed input is read as: bytes in turn, zeros once they are used up, so that every input is a complete program.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>

namespace fuzz {

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  bool ended() const { return at_ == end_; }
  std::uint8_t byte() { return ended() ? 0 : *at_++; }
  /// 0 .. count - 1.
  int below(int count) { return count > 256 ? (byte() * 256 + byte()) % count : byte() % count; }
  bool one_in(int count) { return below(count) == 1; }
  std::int32_t whole() {
    const std::int32_t edges[] = {0, 1, -1, 2, 3, 7, 64, 255, 1024, 65535, INT32_MAX, INT32_MIN};
    const int choice = below(16);
    return choice < 12 ? edges[choice] : static_cast<std::int8_t>(byte());
  }
  /// Ordinary numbers mostly; sometimes the edges of what a double is; sometimes any bits at all.
  double number() {
    using Limits = std::numeric_limits<double>;
    const double edges[] = {0.0, -0.0, 1.0, -1.0, 0.5, Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(),
                            Limits::max(), -Limits::max(), Limits::min(), Limits::denorm_min(), 1e150, 1e-150, 1e9};
    const int choice = byte();
    if (choice < 15) return edges[choice];
    if (choice < 20) {
      std::uint64_t bits = 0;
      for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
      double value;
      std::memcpy(&value, &bits, sizeof value);
      return value;
    }
    return (choice - 138) / 8.0;
  }
  /// A number where one of a given size is sensible, and now and then any other.
  double about(double usual) { return one_in(24) ? number() : usual * (1 + (byte() % 16) / 8.0) * (one_in(8) ? 0.25 : 1); }
  std::string rest() {
    std::string text(reinterpret_cast<const char*>(at_), static_cast<std::size_t>(end_ - at_));
    at_ = end_;
    return text;
  }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* end_;
};

/// Inputs that were taken to the end of what is tried. A target that refuses all of its corpus tries nothing: the replay fails.
inline std::uint64_t accepted = 0;

/// For what must not happen: the fuzzer takes the abort for a finding.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: %s\n", what);
  std::abort();
}

}  // namespace fuzz
