// Pairs that pressed on each other in the last step, by node: the memory of contact that persists. Part of the state.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace ogive {

// In order; fields may be walls (< 0).
struct PressedPair {
  std::array<std::int32_t, 3> node{};
  std::int32_t a = 0, b = 0;

  friend auto operator<=>(const PressedPair&, const PressedPair&) = default;
};

using ContactMemory = std::vector<PressedPair>;

void remember(ContactMemory& memory, const std::array<std::int32_t, 3>& node, std::int32_t a, std::int32_t b);
void order_memory(ContactMemory& memory);
bool remembers(const ContactMemory& memory, const std::array<std::int32_t, 3>& node, std::int32_t a, std::int32_t b);

}  // namespace ogive
