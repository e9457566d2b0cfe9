// The tile of a group: 7 x 7 x 7 node records around its block of 4 x 4 x 4 cells, in cache while the group is worked on.
// Tile node t (0..6) along an axis is node t - 1 of the block; it lies in neighbour block (t + 3) / 4 (0, 1, 2) at node
// (t + 3) % 4.
#pragma once

#include "simd/lanes.hpp"
#include "transfer/kernels.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

constexpr int tile_edge = 7;
constexpr int tile_size = tile_edge * tile_edge * tile_edge;
using Record = Vec<4>;

// Two records that are gathered together: one register where it is wide enough, two otherwise.
#if defined(__AVX512F__)
using RecordPair = Vec<8>;
OGIVE_INLINE RecordPair pair_of(Record first, Record second) { return join(first, second); }
OGIVE_INLINE Record first_of(RecordPair pair) { return lower_half(pair); }
OGIVE_INLINE Record second_of(RecordPair pair) { return upper_half(pair); }
#else
struct RecordPair {
  Record first, second;
  RecordPair operator*(double factor) const { return {first * factor, second * factor}; }
  RecordPair& operator+=(RecordPair other) {
    first += other.first;
    second += other.second;
    return *this;
  }
};
OGIVE_INLINE RecordPair pair_of(Record first, Record second) { return {first, second}; }
OGIVE_INLINE Record first_of(RecordPair pair) { return pair.first; }
OGIVE_INLINE Record second_of(RecordPair pair) { return pair.second; }
#endif

OGIVE_INLINE int tile_index(int x, int y, int z) { return (z * tile_edge + y) * tile_edge + x; }

// Calls visit(tile node, neighbour block 0..26, node of that block 0..63) for each node of the group's tile in use.
template <class Visit>
OGIVE_INLINE void for_tile_nodes(const KernelGroup& group, Visit visit) {
  for (int z = group.tile_low[2]; z <= group.tile_high[2]; ++z) {
    const int block_z = (z + 3) >> 2, node_z = (z + 3) & 3;
    for (int y = group.tile_low[1]; y <= group.tile_high[1]; ++y) {
      const int block_y = (y + 3) >> 2, node_y = (y + 3) & 3;
      const int tile_row = tile_index(0, y, z);
      const int block_row = (block_z * 3 + block_y) * 3;
      const int node_row = (node_z * 4 + node_y) * 4;
      for (int x = group.tile_low[0]; x <= group.tile_high[0]; ++x)
        visit(tile_row + x, block_row + ((x + 3) >> 2), node_row + ((x + 3) & 3));
    }
  }
}

OGIVE_INLINE void clear_tile(const KernelGroup& group, Record* tile) {
  for (int z = group.tile_low[2]; z <= group.tile_high[2]; ++z)
    for (int y = group.tile_low[1]; y <= group.tile_high[1]; ++y)
      for (int x = group.tile_low[0]; x <= group.tile_high[0]; ++x) tile[tile_index(x, y, z)] = Record{};
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
