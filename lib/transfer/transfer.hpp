// Maps between the particles of a group and its tile: Huang et al. 2010, Eqs. (27), (28), (9), (29), (31), (33), (34).
//
// Affine velocity (Jiang, Schroeder, Selle, Teran, Stomakhin 2015): a particle carries the field v_p + C_p (x - x_p), and
//   (28)  p_I = sum m_p N (v_p + C_p (x_I - x_p)),     C_p = 4/h^2 sum_I N v_I (x_I - x_p)^T.
// h^2/4 is the second moment of the quadratic B-spline. For trilinear functions, whose moment xi (1 - xi) h^2 vanishes at
// the nodes, it is its largest value: C_p is then the velocity gradient times 4 xi (1 - xi), which keeps it bounded where
// a particle touches a node with next to no mass.
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

// What goes with the weights: derivatives per length (d/dx, not d/dxi), moments 4 N (x_I - x_p) / h^2, or distances.
enum class Beside { Nothing, Derivatives, Moments, Distances };

// Weights of four particles, by axis, node and particle.
template <class Shape>
struct Weights {
  static constexpr int N = Shape::nodes;
  alignas(32) double w[3][N][lane_count];
  alignas(32) double d[3][N][lane_count];  // derivatives, moments or distances x_I - x_p
  alignas(32) double first[lane_count];    // tile node of the first weight, as a whole number
};

template <Beside beside, class Shape>
OGIVE_INLINE void fill(Weights<Shape>& weights, const KernelGroup& group, Lanes x, Lanes y, Lanes z) {
  constexpr int N = Shape::nodes;
  const Lanes position[3] = {x, y, z};
  Lanes base[3];
  for (int axis = 0; axis < 3; ++axis) {
    Lanes w[N], d[N];
    const Lanes xi = (position[axis] - group.corner[axis]) * group.inverse_cell;
    Shape::at(xi, base[axis], w, d);
    for (int n = 0; n < N; ++n) {
      store_aligned(weights.w[axis][n], w[n]);
      const Lanes distance = base[axis] + static_cast<double>(n) - xi;  // in cells
      if (beside == Beside::Derivatives) store_aligned(weights.d[axis][n], d[n] * group.inverse_cell);
      if (beside == Beside::Moments) store_aligned(weights.d[axis][n], distance * w[n] * (4.0 * group.inverse_cell));
      if (beside == Beside::Distances) store_aligned(weights.d[axis][n], distance * (1.0 / group.inverse_cell));
    }
  }
  store_aligned(weights.first, (base[2] * tile_edge + base[1]) * tile_edge + base[0]);
}

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

// Adds (q + X x + Y y + Z z) N at each node of one particle to the tile, (x, y, z) the distance from particle to node.
template <class Shape>
OGIVE_INLINE void scatter_affine(const Weights<Shape>& weights, int lane, Record q, Record X, Record Y, Record Z,
                                 Record* tile) {
  constexpr int N = Shape::nodes;
  Record* first = tile + static_cast<std::int64_t>(weights.first[lane]);
#pragma GCC unroll 3
  for (int k = 0; k < N; ++k) {
    const Record q_z = (q + Z * weights.d[2][k][lane]) * weights.w[2][k][lane];
    const Record X_z = X * weights.w[2][k][lane], Y_z = Y * weights.w[2][k][lane];
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      const Record q_zy = (q_z + Y_z * weights.d[1][j][lane]) * weights.w[1][j][lane];
      const Record X_zy = X_z * weights.w[1][j][lane];
      Record* row = first + (k * tile_edge + j) * tile_edge;
#pragma GCC unroll 3
      for (int i = 0; i < N; ++i) row[i] += (q_zy + X_zy * weights.d[0][i][lane]) * weights.w[0][i][lane];
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

// Sum of N times what `first` holds at the nodes: records, or pairs of them.
template <class Shape, class R>
OGIVE_INLINE R gather_value(const Weights<Shape>& weights, int lane, const R* first) {
  constexpr int N = Shape::nodes;
  R sum{};
#pragma GCC unroll 3
  for (int k = 0; k < N; ++k) {
    R sum_y{};
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      const R* row = first + (k * tile_edge + j) * tile_edge;
      R sum_x{};
#pragma GCC unroll 3
      for (int i = 0; i < N; ++i) sum_x += row[i] * weights.w[0][i][lane];
      sum_y += sum_x * weights.w[1][j][lane];
    }
    sum += sum_y * weights.w[2][k][lane];
  }
  return sum;
}

// Sums of N, dN/dx, dN/dy, dN/dz times the node's record; with moments in place of derivatives, the affine velocity.
template <class Shape, class R>
OGIVE_INLINE void gather_gradient(const Weights<Shape>& weights, int lane, const R* first, R& value, R& dx, R& dy, R& dz) {
  constexpr int N = Shape::nodes;
  value = dx = dy = dz = R{};
#pragma GCC unroll 3
  for (int k = 0; k < N; ++k) {
    R value_y{}, dx_y{}, dy_y{};
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      const R* row = first + (k * tile_edge + j) * tile_edge;
      R value_x{}, dx_x{};
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
template <class Shape, bool affine>
void map_momentum(const KernelGroup& group, const KernelParticles& particles) {
  alignas(64) Record tile[tile_size];
  clear_tile(group, tile);
  Weights<Shape> weights;
  for (std::int64_t p = group.begin; p < group.end; p += lane_count) {
    Lanes x, y, z, mass;
    load_records(particles.position + 4 * p, x, y, z, mass);
    fill<affine ? Beside::Distances : Beside::Nothing>(weights, group, x, y, z);
    for (int lane = 0; lane < lane_count; ++lane) {
      // The fourth component of a velocity record is 1: the mass comes along.
      const double m = particles.position[4 * (p + lane) + 3];
      const Record momentum = load_aligned<Record>(particles.velocity + 4 * (p + lane)) * m;
      if (affine) {
        const double* C = particles.affine + 12 * (p + lane);
        scatter_affine<Shape>(weights, lane, momentum, load_aligned<Record>(C) * m, load_aligned<Record>(C + 4) * m,
                              load_aligned<Record>(C + 8) * m, tile);
      } else {
        scatter_value<Shape>(weights, lane, momentum, tile);
      }
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
    fill<Beside::Derivatives>(weights, group, x, y, z);
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

// Eqs. (33), (34). What PIC and APIC put in place of the increment, or a part of it, is the grid's own velocity.
template <class Shape, bool affine>
void update_particles(const KernelGroup& group, const KernelParticles& particles, MoveSums& sums) {
  alignas(64) RecordPair tile[tile_size];  // velocity, acceleration
  for_tile_nodes(group, [&](int t, int block, int node) {
    const NodeRecord& record = group.nodes[block][node];
    tile[t] = pair_of(load_aligned<Record>(record.v), load_aligned<Record>(record.f));
  });
  const Record low = load<Record>(group.bound_low), high = load<Record>(group.bound_high);
  const double from_grid = group.grid_velocity_fraction, kept = 1.0 - from_grid;
  IntVec<4> all_inside = low <= high;
  Lanes speed_squared{};
  const double time_step_squared = group.time_step * group.time_step;
  Record power{}, lost{}, lost_affine{};
  Weights<Shape> weights;
  for (std::int64_t p = group.begin; p < group.end; p += lane_count) {
    Lanes x, y, z, mass;
    load_records(particles.position + 4 * p, x, y, z, mass);
    fill<affine ? Beside::Moments : Beside::Nothing>(weights, group, x, y, z);
    Record v[lane_count];
    for (int lane = 0; lane < lane_count; ++lane) {
      const RecordPair* first = tile + static_cast<std::int64_t>(weights.first[lane]);
      double* position = particles.position + 4 * (p + lane);
      RecordPair both;  // velocity and acceleration
      if (affine) {
        RecordPair dx, dy, dz;
        gather_gradient<Shape>(weights, lane, first, both, dx, dy, dz);
        const Record X = first_of(dx), Y = first_of(dy), Z = first_of(dz);
        const Record dX = second_of(dx), dY = second_of(dy), dZ = second_of(dz);
        double* C = particles.affine + 12 * (p + lane);
        const Record X_0 = load_aligned<Record>(C), Y_0 = load_aligned<Record>(C + 4), Z_0 = load_aligned<Record>(C + 8);
        lost_affine += (X_0 * X_0 + Y_0 * Y_0 + Z_0 * Z_0 - X * X - Y * Y - Z * Z +
                        (dX * dX + dY * dY + dZ * dZ) * time_step_squared) * position[3];
        store_aligned(C, X);
        store_aligned(C + 4, Y);
        store_aligned(C + 8, Z);
      } else {
        both = gather_value<Shape>(weights, lane, first);
      }
      const Record velocity = first_of(both), acceleration = second_of(both);
      const Record displacement = velocity * group.time_step;
      if (particles.displacement) {
        store_aligned(particles.displacement + 4 * (p + lane), displacement);
      } else {
        const Record moved = load_aligned<Record>(position) + displacement;
        all_inside &= (moved >= low) & (moved <= high);
        store_aligned(position, moved);
      }
      double* to = particles.velocity + 4 * (p + lane);
      const Record old = load_aligned<Record>(to);
      const Record increment = acceleration * group.time_step;
      v[lane] = old + increment;
      power += old * increment * position[3];
      if (from_grid != 0) {
        const Record flip = v[lane];
        v[lane] = flip * kept + velocity * from_grid;
        v[lane][3] = 1.0;
        lost += (flip - v[lane]) * (flip + v[lane]) * position[3];
      }
      store_aligned(to, v[lane]);
    }
    transpose(v[0], v[1], v[2], v[3]);
    speed_squared = max(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], speed_squared);
  }
  sums.outside = !all(all_inside);
  lost += lost_affine * (0.25 / (group.inverse_cell * group.inverse_cell));
  sums.taken_up = power[0] + power[1] + power[2] - 0.5 * (lost[0] + lost[1] + lost[2]);
  sums.speed_squared = 0;
  for (int lane = 0; lane < lane_count; ++lane)
    if (speed_squared[lane] > sums.speed_squared) sums.speed_squared = speed_squared[lane];
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
