// The tile of a group: 7 x 7 x 7 node records around its block of 4 x 4 x 4 cells, in cache while the group is worked
// on. Tile node t (0..6) along an axis is node t - 1 of the block; it lies in neighbour block (t + 3) / 4 (0, 1, 2) at
// node (t + 3) % 4.
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
  RecordPair operator+(RecordPair other) const { return {first + other.first, second + other.second}; }
  RecordPair operator-(RecordPair other) const { return {first - other.first, second - other.second}; }
};
OGIVE_INLINE RecordPair pair_of(Record first, Record second) { return {first, second}; }
OGIVE_INLINE Record first_of(RecordPair pair) { return pair.first; }
OGIVE_INLINE Record second_of(RecordPair pair) { return pair.second; }
#endif

OGIVE_INLINE int tile_index(int x, int y, int z) { return (z * tile_edge + y) * tile_edge + x; }

// Along x the tile takes node 3 of the block below, all four of its own and two of the block above.
constexpr int first_in_part[3] = {3, 0, 0}, nodes_in_part[3] = {1, 4, 2}, tile_part[3] = {0, 1, 5};

// Calls visit(tile row, first of three neighbour blocks, row of nodes in them) for the rows along x in use.
template <class Visit>
OGIVE_INLINE void for_tile_rows(const KernelGroup& group, Visit visit) {
  for (int z = group.tile_low[2]; z <= group.tile_high[2]; ++z)
    for (int y = group.tile_low[1]; y <= group.tile_high[1]; ++y)
      visit(tile_index(0, y, z), (((z + 3) >> 2) * 3 + ((y + 3) >> 2)) * 3, (((z + 3) & 3) * 4 + ((y + 3) & 3)) * 4);
}

// Calls read(tile node, node record) for the nodes in use. Whole rows are taken where their blocks exist: a node that
// no particle reaches does no harm.
template <class Read>
OGIVE_INLINE void read_tile(const KernelGroup& group, Read read) {
  for_tile_rows(group, [&](int row, int block, int node) {
#pragma GCC unroll 3
    for (int part = 0; part < 3; ++part) {
      const NodeRecord* const nodes = group.nodes[block + part];
      if (!nodes) continue;
#pragma GCC unroll 4
      for (int i = 0; i < nodes_in_part[part]; ++i)
        read(row + tile_part[part] + i, nodes[node + first_in_part[part] + i]);
    }
  });
}

OGIVE_INLINE void clear_tile(const KernelGroup& group, Record* tile) {
  for_tile_rows(group, [&](int row, int, int) {
#pragma GCC unroll 7
    for (int x = 0; x < tile_edge; ++x) tile[row + x] = Record{};
  });
}

// Adds the tile to the records that start at start_of(group, block) in each neighbour block, `stride` doubles apart;
// null: none.
template <class StartOf>
OGIVE_INLINE void add_tile(const KernelGroup& group, const Record* tile, StartOf start_of, int stride) {
  for_tile_rows(group, [&](int row, int block, int node) {
#pragma GCC unroll 3
    for (int part = 0; part < 3; ++part) {
      double* const start = start_of(group, block + part);
      if (!start) continue;
#pragma GCC unroll 4
      for (int i = 0; i < nodes_in_part[part]; ++i) {
        double* const to = start + stride * (node + first_in_part[part] + i);
        store_aligned(to, load_aligned<Record>(to) + tile[row + tile_part[part] + i]);
      }
    }
  });
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
