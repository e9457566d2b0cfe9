// Maps between the particles of a group and its tile: Huang et al. 2010, Eqs. (27), (28), (9), (29), (31), (33), (34).
//
// Four particles at a time: their weights are computed lane by lane and kept in small arrays, then each particle meets
// its nodes as records of four doubles, one fused multiply-add a node and sum. Sums over nodes are nested (z, y, x), so
// that the products of weights are never formed.
#pragma once

#include "shape/weights.hpp"
#include "simd/lanes.hpp"
#include "transfer/kernels.hpp"
#include "transfer/tile.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

using Lanes = Vec<4>;
constexpr int lane_count = 4;

// Weights of four particles, by axis, node and particle; derivatives are per length (d/dx, not d/dxi).
template <class Shape>
struct Weights {
  static constexpr int N = Shape::nodes;
  alignas(32) double w[3][N][lane_count];
  alignas(32) double d[3][N][lane_count];
  alignas(32) double first[lane_count];  // tile node of the first weight, as a whole number

  OGIVE_INLINE void fill(Weights& weights, const KernelGroup& group, Lanes x, Lanes y, Lanes z, bool derivatives) {
    const Lanes position[3] = {x, y, z};
    Lanes base[3];
    for (int axis = 0; axis < 3; ++axis) {
      Lanes w[N], d[N];
      Shape::at((position[axis] - group.corner[axis]) * group.inverse_cell, base[axis], w, d);
      for (int n = 0; n < N; ++n) {
        store_aligned(weights.w[axis][n], w[n]);
        if (derivatives) store_aligned(weights.d[axis][n], d[n] * group.inverse_cell);
      }
    }
    store_aligned(weights.first, (base[2] * tile_edge + base[1]) * tile_edge + base[0]);
  }
};

// Adds q N at each node of one particle to the tile.
template <class Shape>
OGIVE_INLINE void scatter_value(const Weights<Shape>& weights, int lane, Record q, Record* tile) {
  constexpr int N = Shape::nodes;
  Record* first = tile + static_cast<std::int64_t>(weights.first[lane]);
#pragma GCC unroll 3
  for (int k = 0; k < N; ++k) {
    const Record q_z = q * weights.w[2][k][lane];
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      const Record q_zy = q_z * weights.w[1][j][lane];
      Record* row = first + (k * tile_edge + j) * tile_edge;
#pragma GCC unroll 3
      for (int i = 0; i < N; ++i) row[i] += q_zy * weights.w[0][i][lane];
    }
  }
}

// Adds X dN/dx + Y dN/dy + Z dN/dz at each node of one particle to the tile.
template <class Shape>
OGIVE_INLINE void scatter_gradient(const Weights<Shape>& weights, int lane, Record X, Record Y, Record Z, Record* tile) {
  constexpr int N = Shape::nodes;
  Record* first = tile + static_cast<std::int64_t>(weights.first[lane]);
#pragma GCC unroll 3
  for (int k = 0; k < N; ++k) {
    const Record X_z = X * weights.w[2][k][lane], Y_z = Y * weights.w[2][k][lane], Z_z = Z * weights.d[2][k][lane];
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      const Record along = X_z * weights.w[1][j][lane];
      const Record across = Y_z * weights.d[1][j][lane] + Z_z * weights.w[1][j][lane];
      Record* row = first + (k * tile_edge + j) * tile_edge;
#pragma GCC unroll 3
      for (int i = 0; i < N; ++i) row[i] += along * weights.d[0][i][lane] + across * weights.w[0][i][lane];
    }
  }
}

// Sum of N times the node's record.
template <class Shape>
OGIVE_INLINE Record gather_value(const Weights<Shape>& weights, int lane, const Record* first, int stride) {
  constexpr int N = Shape::nodes;
  Record sum{};
#pragma GCC unroll 3
  for (int k = 0; k < N; ++k) {
    Record sum_y{};
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      const Record* row = first + (k * tile_edge + j) * tile_edge * stride;
      Record sum_x{};
#pragma GCC unroll 3
      for (int i = 0; i < N; ++i) sum_x += row[i * stride] * weights.w[0][i][lane];
      sum_y += sum_x * weights.w[1][j][lane];
    }
    sum += sum_y * weights.w[2][k][lane];
  }
  return sum;
}

// Sums of N, dN/dx, dN/dy, dN/dz times the node's record.
template <class Shape>
OGIVE_INLINE void gather_gradient(const Weights<Shape>& weights, int lane, const Record* first, Record& value, Record& dx,
                                  Record& dy, Record& dz) {
  constexpr int N = Shape::nodes;
  value = dx = dy = dz = Record{};
#pragma GCC unroll 3
  for (int k = 0; k < N; ++k) {
    Record value_y{}, dx_y{}, dy_y{};
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      const Record* row = first + (k * tile_edge + j) * tile_edge;
      Record value_x{}, dx_x{};
#pragma GCC unroll 3
      for (int i = 0; i < N; ++i) {
        value_x += row[i] * weights.w[0][i][lane];
        dx_x += row[i] * weights.d[0][i][lane];
      }
      value_y += value_x * weights.w[1][j][lane];
      dx_y += dx_x * weights.w[1][j][lane];
      dy_y += value_x * weights.d[1][j][lane];
    }
    dx += dx_y * weights.w[2][k][lane];
    dy += dy_y * weights.w[2][k][lane];
    dz += value_y * weights.d[2][k][lane];
    value += value_y * weights.w[2][k][lane];
  }
}

// Eqs. (27), (28): nodal mass and momentum.
template <class Shape>
void map_momentum(const KernelGroup& group, const KernelParticles& particles) {
  alignas(64) Record tile[tile_size];
  clear_tile(group, tile);
  Weights<Shape> weights;
  for (std::int64_t p = group.begin; p < group.end; p += lane_count) {
    Lanes x, y, z, mass;
    load_records(particles.position + 4 * p, x, y, z, mass);
    Weights<Shape>::fill(weights, group, x, y, z, false);
    for (int lane = 0; lane < lane_count; ++lane) {
      // The fourth component of a velocity record is 1: the mass comes along.
      const Record momentum =
          load_aligned<Record>(particles.velocity + 4 * (p + lane)) * particles.position[4 * (p + lane) + 3];
      scatter_value<Shape>(weights, lane, momentum, tile);
    }
  }
  for_tile_nodes(group, [&](int t, int block, int node) {
    double* v = group.nodes[block][node].v;
    store_aligned(v, load_aligned<Record>(v) + tile[t]);
  });
}

// Eq. (9) before it is made a unit vector, and the volume that the field fills at the node. A particle fills its current
// volume, but what has opened up by tension or failure does not count: volume_ratio above 1 is taken as 1.
template <class Shape>
void map_contact(const KernelGroup& group, const KernelParticles& particles) {
  alignas(64) Record tile[tile_size];
  clear_tile(group, tile);
  Weights<Shape> weights;
  for (std::int64_t p = group.begin; p < group.end; p += lane_count) {
    Lanes x, y, z, mass;
    load_records(particles.position + 4 * p, x, y, z, mass);
    Weights<Shape>::fill(weights, group, x, y, z, true);
    const Lanes ratio = load_aligned<Lanes>(particles.volume_ratio + p);
    alignas(32) double volume[lane_count];
    store_aligned(volume, mass * group.inverse_density * min(ratio, broadcast<Lanes>(1.0)));
    for (int lane = 0; lane < lane_count; ++lane) {
      const double m = particles.position[4 * (p + lane) + 3];
      scatter_gradient<Shape>(weights, lane, Record{m, 0, 0, 0}, Record{0, m, 0, 0}, Record{0, 0, m, 0}, tile);
      scatter_value<Shape>(weights, lane, Record{0, 0, 0, volume[lane]}, tile);
    }
  }
  for_tile_nodes(group, [&](int t, int block, int node) {
    if (!group.contact[block]) return;
    double* to = group.contact[block][node].gradient;
    store_aligned(to, load_aligned<Record>(to) + tile[t]);
  });
}

// Eqs. (33), (34).
template <class Shape>
void update_particles(const KernelGroup& group, const KernelParticles& particles, MoveSums& sums) {
  alignas(64) Record tile[2 * tile_size];  // velocity, acceleration
  for_tile_nodes(group, [&](int t, int block, int node) {
    const NodeRecord& record = group.nodes[block][node];
    tile[2 * t] = load_aligned<Record>(record.v);
    tile[2 * t + 1] = load_aligned<Record>(record.f);
  });
  const Record low = load<Record>(group.bound_low), high = load<Record>(group.bound_high);
  IntVec<4> all_inside = low <= high;
  Lanes speed_squared{};
  Weights<Shape> weights;
  for (std::int64_t p = group.begin; p < group.end; p += lane_count) {
    Lanes x, y, z, mass;
    load_records(particles.position + 4 * p, x, y, z, mass);
    Weights<Shape>::fill(weights, group, x, y, z, false);
    Record v[lane_count];
    for (int lane = 0; lane < lane_count; ++lane) {
      const Record* first = tile + 2 * static_cast<std::int64_t>(weights.first[lane]);
      const Record velocity = gather_value<Shape>(weights, lane, first, 2);
      const Record acceleration = gather_value<Shape>(weights, lane, first + 1, 2);
      double* position = particles.position + 4 * (p + lane);
      const Record moved = load_aligned<Record>(position) + velocity * group.time_step;
      all_inside &= (moved >= low) & (moved <= high);
      store_aligned(position, moved);
      double* to = particles.velocity + 4 * (p + lane);
      v[lane] = load_aligned<Record>(to) + acceleration * group.time_step;
      store_aligned(to, v[lane]);
    }
    transpose(v[0], v[1], v[2], v[3]);
    speed_squared = max(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], speed_squared);
  }
  sums.outside = !all(all_inside);
  sums.speed_squared = 0;
  for (int lane = 0; lane < lane_count; ++lane)
    if (speed_squared[lane] > sums.speed_squared) sums.speed_squared = speed_squared[lane];
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
