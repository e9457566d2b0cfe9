#include "contact/occupied.hpp"

#include <cmath>

namespace ogive {

void mark_occupied(const Model& model, const State& state, Workspace& workspace, const GroupLinks& link) {
  const BodyState& body = workspace.particles_of(state, link.body);
  const Group& group = body.groups[link.group];
  const double inverse = 1.0 / model.grid.cell_size;
  // Cells that hold a particle, in the coordinates of the group's tile: node t of the tile is node t - 1 of the block.
  bool held[tile_nodes - 1][tile_nodes - 1][tile_nodes - 1] = {};
  for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
    int cell[3];
    for (int axis = 0; axis < 3; ++axis)
      cell[axis] = static_cast<int>(std::floor((body.position[4 * p + axis] - link.corner[axis]) * inverse));
    held[cell[2]][cell[1]][cell[0]] = true;
  }
  for (int z = 0; z < tile_nodes - 1; ++z)
    for (int y = 0; y < tile_nodes - 1; ++y)
      for (int x = 0; x < tile_nodes - 1; ++x) {
        if (!held[z][y][x]) continue;
        for (int corner = 0; corner < 8; ++corner) {
          const int t[3] = {x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2 & 1)};
          int block = 0, node = 0;
          for (int axis = 2; axis >= 0; --axis) {
            block = 3 * block + ((t[axis] + 3) >> 2);
            node = 4 * node + ((t[axis] + 3) & 3);
          }
          const std::int32_t slot = link.slot[block];
          const std::int32_t contact = slot < 0 ? -1 : workspace.slots[slot].contact;
          if (contact < 0) continue;
          // The cell lies on the upper side of its lower corners.
          std::uint8_t& mask = workspace.occupied[static_cast<std::size_t>(contact) * block_nodes + node];
          mask = static_cast<std::uint8_t>(mask | 1 << (7 - corner));
        }
      }
}

}  // namespace ogive
