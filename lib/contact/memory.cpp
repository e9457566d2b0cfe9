#include "contact/memory.hpp"

#include <algorithm>
#include <compare>

namespace ogive {

void remember(ContactMemory& memory, const std::array<std::int32_t, 3>& node, std::int32_t a, std::int32_t b) {
  memory.push_back({node, a, b});
}

void order_memory(ContactMemory& memory) { std::sort(memory.begin(), memory.end()); }

bool remembers(const ContactMemory& memory, const std::array<std::int32_t, 3>& node, std::int32_t a, std::int32_t b) {
  return std::binary_search(memory.begin(), memory.end(), PressedPair{node, a, b});
}

}  // namespace ogive
