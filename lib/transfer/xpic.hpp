// XPIC(k): Hammerquist, Nairn 2017. FLIP keeps on a particle what the grid cannot see of its velocity, (1 - P) V with
// P = S S+ (to the grid with lumped masses and back); XPIC(k) keeps none of it but (1 - P)^k V:
//   V' = V - (1 - P)^k V + S a dt = S v* + S a dt,    v* = sum_{r=1..k} (-1)^(r+1) C(k, r) v_r,
// v_1 the mapped nodal velocity and v_r = S+ S v_(r-1). k = 1 is PIC.
#pragma once

#include "transfer/transfer.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

// The velocities of the filter's nodes, in the tile.
OGIVE_INLINE void read_filter(const KernelGroup& group, NodeRecord* const (&nodes)[27], Record* tile) {
  for_tile_rows(group, [&](int row, int block, int node) {
    for (int part = 0; part < 3; ++part) {
      if (!nodes[block + part]) continue;
      for (int i = 0; i < nodes_in_part[part]; ++i)
        tile[row + tile_part[part] + i] =
            load_aligned<Record>(nodes[block + part][node + first_in_part[part] + i].v);
    }
  });
}

// One pass: velocity v_(r-1) in the nodes' v to momentum m S v_(r-1), added to their f.
template <class Shape>
void filter_velocity(const KernelGroup& group, const KernelParticles& particles, NodeRecord* const (&nodes)[27]) {
  alignas(64) Record from[tile_size], to[tile_size];
  read_filter(group, nodes, from);
  clear_tile(group, to);
  Scatter<Shape> sums;
  Scatter<Shape>::begin(sums, to);
  Weights weights[stretch / lane_count];
  for (std::int64_t start = group.begin; start < group.end; start += stretch) {
    const int count = fill_stretch<Shape, Beside::Nothing>(weights, group, particles.position, start);
    for (int i = 0; i < count; ++i) {
      const int lane = i % lane_count;
      const Record velocity = gather_value<Shape>(weights[i / lane_count], lane, from);
      scatter_value<Shape>(weights[i / lane_count], lane, velocity * particles.position[4 * (start + i) + 3], sums);
    }
  }
  Scatter<Shape>::end(sums);
  add_tile(group, to, [&](const KernelGroup&, int block) { return nodes[block] ? nodes[block]->f : nullptr; },
           sizeof(NodeRecord) / sizeof(double));
}

// Eq. (33), and V' in place of (34). `filtered` holds v* in v. The energy that FLIP would have left on the particle and
// this does not is lost.
template <class Shape>
void update_particles_xpic(const KernelGroup& group, const KernelParticles& particles, NodeRecord* const (&filtered)[27],
                           MoveSums& sums) {
  alignas(64) RecordPair tile[tile_size];  // velocity, acceleration
  alignas(64) Record star[tile_size];
  read_tile(group, [&](int t, const NodeRecord& record) {
    tile[t] = pair_of(load_aligned<Record>(record.v), load_aligned<Record>(record.f));
  });
  read_filter(group, filtered, star);
  const Record low = load<Record>(group.bound_low), high = load<Record>(group.bound_high);
  IntVec<4> all_inside = low <= high;
  Lanes speed_squared{};
  Record power{}, lost{};
  Weights weights[stretch / lane_count];
  for (std::int64_t start = group.begin; start < group.end; start += stretch) {
    const int count = fill_stretch<Shape, Beside::Nothing>(weights, group, particles.position, start);
    for (int i = 0; i < count; i += lane_count) {
      const std::int64_t p = start + i;
      Record v[lane_count];
      for (int lane = 0; lane < lane_count; ++lane) {
        double* position = particles.position + 4 * (p + lane);
        const RecordPair both = gather_value<Shape>(weights[i / lane_count], lane, tile);
        const Record displacement = first_of(both) * group.time_step;
        if (particles.displacement) {
          store_aligned(particles.displacement + 4 * (p + lane), displacement);
        } else {
          const Record moved = load_aligned<Record>(position) + displacement;
          all_inside &= (moved >= low) & (moved <= high);
          store_aligned(position, moved);
        }
        double* to = particles.velocity + 4 * (p + lane);
        const Record old = load_aligned<Record>(to);
        const Record increment = second_of(both) * group.time_step;
        const Record flip = old + increment;
        v[lane] = gather_value<Shape>(weights[i / lane_count], lane, star) + increment;
        power += old * increment * position[3];
        set_lane(v[lane], 3, 1.0);
        lost += (flip - v[lane]) * (flip + v[lane] - increment) * position[3];
        store_aligned(to, v[lane]);
      }
      transpose(v[0], v[1], v[2], v[3]);
      speed_squared = max(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], speed_squared);
    }
  }
  sums.outside = !all(all_inside);
  sums.taken_up = power[0] + power[1] + power[2] - 0.5 * (lost[0] + lost[1] + lost[2]);
  sums.speed_squared = 0;
  for (int lane = 0; lane < lane_count; ++lane)
    if (speed_squared[lane] > sums.speed_squared) sums.speed_squared = speed_squared[lane];
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
