// Which of the eight cells around a node hold particles of a body: Pan et al. 2008's normals. Bit c of a node's mask is the
// cell on the upper side of the node in x, y, z where bits 0, 1, 2 of c are set.
#pragma once

#include "grid.hpp"

namespace ogive {

// Marks the cells of one group; groups of one colour may run at once.
void mark_occupied(const Model& model, const State& state, Workspace& workspace, const GroupLinks& link);

// The mask seen in a mirror normal to `axis`.
inline std::uint8_t mirrored_cells(std::uint8_t mask, int axis) {
  std::uint8_t result = 0;
  for (int cell = 0; cell < 8; ++cell)
    if (mask >> cell & 1) result = static_cast<std::uint8_t>(result | 1 << (cell ^ 1 << axis));
  return result;
}

}  // namespace ogive
