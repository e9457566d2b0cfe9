// Maps between the particles of a group and its tile: Huang et al. 2010, Eqs. (27), (28), (9), (29), (31), (33), (34).
//
// Affine velocity (Jiang, Schroeder, Selle, Teran, Stomakhin 2015): a particle carries the field v_p + C_p (x - x_p),
// and
//   (28)  p_I = sum m_p N (v_p + C_p (x_I - x_p)),     C_p = 4/h^2 sum_I N v_I (x_I - x_p)^T.
// h^2/4 is the second moment of the quadratic B-spline. For trilinear functions, whose moment xi (1 - xi) h^2 vanishes
// at the nodes, it is its largest value: C_p is then the velocity gradient times 4 xi (1 - xi), which keeps it bounded
// where a particle touches a node with next to no mass.
//
// Four particles at a time: their weights are computed lane by lane and kept in small arrays, then each particle meets
// its nodes as records of four doubles. Sums over nodes are nested (z, y, x), so that the products of weights are never
// formed. Along one axis the middle node of a B-spline is never weighed: with the weights w and slopes e of the outer
// nodes, sum w = 1 and sum e = 0 (e: derivatives, or first moments, which vanish as well) give
//   to nodes     o_0 = q w_0 + A e_0,  o_2 = q w_2 + A e_2,  o_1 = q - (o_0 + o_2)
//   from nodes   sum w v = v_1 + w_0 (v_0 - v_1) + w_2 (v_2 - v_1),  sum e v = e_0 (v_0 - v_1) + e_2 (v_2 - v_1)
// two thirds of the multiplications; sums and differences run beside them. The middle weight is at least a half, so
// that nothing cancels. Of a trilinear function both nodes are weighed: there the smaller weight may be 1e-9, and what
// a node with so little mass receives must be accurate in proportion.
#pragma once

#include "shape/planar.hpp"
#include "shape/weights.hpp"
#include "simd/lanes.hpp"
#include "transfer/kernels.hpp"
#include "transfer/tile.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

using Lanes = Vec<4>;
constexpr int lane_count = 4;

// Asks for what four particles will need a few dozen particles later.
constexpr int prefetch_distance = 48;
template <int size>
OGIVE_INLINE void prefetch_records(const double* array, std::int64_t p) {
#pragma GCC unroll 5
  for (int line = 0; line < (size * lane_count + 7) / 8; ++line)
    prefetch(array, size * (p + prefetch_distance) + 8 * line);
}

// What goes with the weights: derivatives per cell (d/dxi, not d/dx), moments 4 N (x_I - x_p) / h^2, or moments
// N (x_I - x_p).
enum class Beside { Nothing, Derivatives, MomentsFromGrid, MomentsToGrid };

// Particles whose weights are computed ahead of their use.
constexpr int stretch = 32;

// Weights and slopes of the outer nodes of four particles, by axis, node and particle. The moments of a linear function
// are -e[1] and e[1]; its derivatives, -1 and 1, are not kept.
struct Weights {
  alignas(32) double w[3][2][lane_count];
  alignas(32) double e[3][2][lane_count];
  alignas(32) std::int64_t first[lane_count];  // tile node of the first weight
};

template <class Shape, Beside beside>
OGIVE_INLINE void fill(Weights& weights, const KernelGroup& group, Lanes x, Lanes y, Lanes z) {
  constexpr int N = Shape::nodes;
  const Lanes position[3] = {x, y, z};
  Lanes base[3];
  for (int axis = 0; axis < (is_planar<Shape> ? 2 : 3); ++axis) {
    Lanes w[N], d[N];
    const Lanes xi = (position[axis] - group.corner[axis]) * group.inverse_cell;
    Shape::at(xi, base[axis], w, d);
    for (int side = 0; side < 2; ++side) {
      const int n = side * (N - 1);
      store_aligned(weights.w[axis][side], w[n]);
      if (N == 2 && side == 0) continue;
      // In cells; of a linear function both moments are -+ w_0 w_1.
      const Lanes moment = N == 2 ? w[0] * w[1] : (base[axis] + static_cast<double>(n) - xi) * w[n];
      if (beside == Beside::Derivatives && N == 3) store_aligned(weights.e[axis][side], d[n]);
      if (beside == Beside::MomentsFromGrid) store_aligned(weights.e[axis][side], moment * (4.0 * group.inverse_cell));
      if (beside == Beside::MomentsToGrid) store_aligned(weights.e[axis][side], moment * (1.0 / group.inverse_cell));
    }
  }
  if constexpr (is_planar<Shape>) base[2] = broadcast<Lanes>(1.0);  // the block's own first layer
  // A whole number in the low bits of 2^52 + it.
  const Lanes first = (base[2] * tile_edge + base[1]) * tile_edge + base[0] + 0x1p52;
  const IntVec<lane_count> number = as_int(first) & std::int64_t{0xffff};
  __builtin_memcpy(weights.first, &number, sizeof number);
}

// Weights of the particles from `start` on, `stretch` at most, four in each of `weights`. They are computed ahead of
// their use so that the chain of operations of each does not hold up the particle before it. Returns how many there
// are.
template <class Shape, Beside beside>
OGIVE_INLINE int fill_stretch(Weights (&weights)[stretch / lane_count], const KernelGroup& group,
                              const double* position, std::int64_t start) {
  const int count = static_cast<int>(group.end - start < stretch ? group.end - start : stretch);
  for (int i = 0; i < count; i += lane_count) {
    prefetch_records<4>(position, start + i);
    Lanes x, y, z, mass;
    load_records(position + 4 * (start + i), x, y, z, mass);
    fill<Shape, beside>(weights[i / lane_count], group, x, y, z);
  }
  return count;
}

// The weights and slopes of one particle along one axis.
template <class Shape, Beside beside = Beside::Nothing>
struct AxisWeights {
  static constexpr bool unit_slopes = Shape::nodes == 2 && beside == Beside::Derivatives;
  double w_0, w_2, e_0, e_2;
  OGIVE_INLINE AxisWeights of(const Weights& weights, int axis, int lane) {
    return {weights.w[axis][0][lane], weights.w[axis][1][lane], weights.e[axis][0][lane], weights.e[axis][1][lane]};
  }
};

// A times the slope at the upper node of a linear function.
template <class Shape, Beside beside, class R>
OGIVE_INLINE R scaled_by_slope(const AxisWeights<Shape, beside>& a, R A) {
  if constexpr (AxisWeights<Shape, beside>::unit_slopes)
    return A;
  else
    return A * a.e_2;
}

// q w at the nodes along an axis.
template <class Shape, Beside beside, class R>
OGIVE_INLINE void spread(const AxisWeights<Shape, beside>& a, R q, R (&out)[Shape::nodes]) {
  out[0] = q * a.w_0;
  out[Shape::nodes - 1] = q * a.w_2;
  if constexpr (Shape::nodes == 3) out[1] = q - (out[0] + out[2]);
}

// q w + A e.
template <class Shape, Beside beside, class R>
OGIVE_INLINE void spread(const AxisWeights<Shape, beside>& a, R q, R A, R (&out)[Shape::nodes]) {
  if constexpr (Shape::nodes == 2) {
    const R moved = scaled_by_slope(a, A);
    out[0] = q * a.w_0 - moved;
    out[1] = q * a.w_2 + moved;
  } else {
    out[0] = q * a.w_0 + A * a.e_0;
    out[2] = q * a.w_2 + A * a.e_2;
    out[1] = q - (out[0] + out[2]);
  }
}

// A e.
template <class Shape, Beside beside, class R>
OGIVE_INLINE void spread_slope(const AxisWeights<Shape, beside>& a, R A, R (&out)[Shape::nodes]) {
  if constexpr (Shape::nodes == 2) {
    out[1] = scaled_by_slope(a, A);
    out[0] = -out[1];
  } else {
    out[0] = A * a.e_0;
    out[2] = A * a.e_2;
    out[1] = -(out[0] + out[2]);
  }
}

// Sum of w v along an axis.
template <class Shape, Beside beside, class R>
OGIVE_INLINE R collect(const AxisWeights<Shape, beside>& a, const R (&v)[Shape::nodes]) {
  if constexpr (Shape::nodes == 2)
    return v[0] * a.w_0 + v[1] * a.w_2;
  else
    return v[1] + (v[0] - v[1]) * a.w_0 + (v[2] - v[1]) * a.w_2;
}

// Sums of w v and of e v.
template <class Shape, Beside beside, class R>
OGIVE_INLINE R collect(const AxisWeights<Shape, beside>& a, const R (&v)[Shape::nodes], R& slope) {
  if constexpr (Shape::nodes == 2) {
    slope = scaled_by_slope(a, v[1] - v[0]);
    return v[0] * a.w_0 + v[1] * a.w_2;
  } else {
    const R below = v[0] - v[1], above = v[2] - v[1];
    slope = below * a.e_0 + above * a.e_2;
    return v[1] + below * a.w_0 + above * a.w_2;
  }
}

// Sums over a tile. Neighbours in a group mostly share their nodes: the eight sums of a trilinear function stay in
// registers until the first node changes, the 27 of a B-spline are added to the tile at once.
template <class Shape>
class Scatter {
 public:
  static constexpr int N = Shape::nodes;
  static constexpr bool gathers = N == 2;

  OGIVE_INLINE void begin(Scatter& s, Record* tile) {
    s.tile_ = s.first_ = tile;
    if constexpr (gathers)
      for (Record& sum : s.sum_) sum = Record{};
  }
  OGIVE_INLINE void move_to(Scatter& s, std::int64_t first) {
    Record* const to = s.tile_ + first;
    if constexpr (gathers) {
      if (to == s.first_) return;
      end(s);
      for (Record& sum : s.sum_) sum = Record{};
    }
    s.first_ = to;
  }
  OGIVE_INLINE void add(Scatter& s, int k, int j, int i, Record value) {
    if constexpr (gathers)
      s.sum_[(k * N + j) * N + i] += value;
    else
      s.first_[(k * tile_edge + j) * tile_edge + i] += value;
  }
  OGIVE_INLINE void end(Scatter& s) {
    if constexpr (gathers)
#pragma GCC unroll 2
      for (int k = 0; k < layers_of<Shape>; ++k)
#pragma GCC unroll 2
        for (int j = 0; j < N; ++j)
#pragma GCC unroll 2
          for (int i = 0; i < N; ++i) s.first_[(k * tile_edge + j) * tile_edge + i] += s.sum_[(k * N + j) * N + i];
  }

 private:
  Record *tile_, *first_;
  Record sum_[gathers ? 8 : 1];
};

// Adds q w at each node of one particle.
template <class Shape>
OGIVE_INLINE void scatter_value(const Weights& weights, int lane, Record q, Scatter<Shape>& to) {
  constexpr int N = Shape::nodes;
  using A = AxisWeights<Shape>;
  const A a_x = A::of(weights, 0, lane), a_y = A::of(weights, 1, lane), a_z = A::of(weights, 2, lane);
  Scatter<Shape>::move_to(to, weights.first[lane]);
  Record q_z[layers_of<Shape>];
  if constexpr (is_planar<Shape>)
    q_z[0] = q;
  else
    spread(a_z, q, q_z);
#pragma GCC unroll 3
  for (int k = 0; k < layers_of<Shape>; ++k) {
    Record q_zy[N];
    spread(a_y, q_z[k], q_zy);
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      Record out[N];
      spread(a_x, q_zy[j], out);
#pragma GCC unroll 3
      for (int i = 0; i < N; ++i) Scatter<Shape>::add(to, k, j, i, out[i]);
    }
  }
}

// Adds q w_x w_y w_z + X e_x w_y w_z + Y w_x e_y w_z + Z w_x w_y e_z at each node of one particle; without q where
// `slopes_only`.
template <class Shape, Beside beside, bool slopes_only>
OGIVE_INLINE void scatter_slopes(const Weights& weights, int lane, Record q, Record X, Record Y, Record Z,
                                 Scatter<Shape>& to) {
  constexpr int N = Shape::nodes;
  using A = AxisWeights<Shape, beside>;
  const A a_x = A::of(weights, 0, lane), a_y = A::of(weights, 1, lane), a_z = A::of(weights, 2, lane);
  Scatter<Shape>::move_to(to, weights.first[lane]);
  constexpr int layers = layers_of<Shape>;
  Record q_z[layers], X_z[layers], Y_z[layers];
  if constexpr (is_planar<Shape>) {
    q_z[0] = slopes_only ? Record{} : q;
    X_z[0] = X;
    Y_z[0] = Y;
  } else {
    if constexpr (slopes_only)
      spread_slope(a_z, Z, q_z);
    else
      spread(a_z, q, Z, q_z);
    spread(a_z, X, X_z);
    spread(a_z, Y, Y_z);
  }
#pragma GCC unroll 3
  for (int k = 0; k < layers; ++k) {
    Record q_zy[N], X_zy[N];
    spread(a_y, q_z[k], Y_z[k], q_zy);
    spread(a_y, X_z[k], X_zy);
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      Record out[N];
      spread(a_x, q_zy[j], X_zy[j], out);
#pragma GCC unroll 3
      for (int i = 0; i < N; ++i) Scatter<Shape>::add(to, k, j, i, out[i]);
    }
  }
}

// Sum of N times what the nodes hold: records, or pairs of them.
template <class Shape, class R>
OGIVE_INLINE R gather_value(const Weights& weights, int lane, const R* tile) {
  constexpr int N = Shape::nodes;
  using A = AxisWeights<Shape>;
  const A a_x = A::of(weights, 0, lane), a_y = A::of(weights, 1, lane), a_z = A::of(weights, 2, lane);
  const R* const first = tile + weights.first[lane];
  R along_z[layers_of<Shape>];
#pragma GCC unroll 3
  for (int k = 0; k < layers_of<Shape>; ++k) {
    R along_y[N];
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      const R* const row = first + (k * tile_edge + j) * tile_edge;
      R along_x[N];
#pragma GCC unroll 3
      for (int i = 0; i < N; ++i) along_x[i] = row[i];
      along_y[j] = collect(a_x, along_x);
    }
    along_z[k] = collect(a_y, along_y);
  }
  if constexpr (is_planar<Shape>)
    return along_z[0];
  else
    return collect(a_z, along_z);
}

// Sums of N and its derivatives per cell times the node's record; with moments in place of derivatives, the affine
// velocity.
template <class Shape, Beside beside, class R>
OGIVE_INLINE void gather_slopes(const Weights& weights, int lane, const R* tile, R& value, R& dx, R& dy, R& dz) {
  constexpr int N = Shape::nodes;
  using A = AxisWeights<Shape, beside>;
  const A a_x = A::of(weights, 0, lane), a_y = A::of(weights, 1, lane), a_z = A::of(weights, 2, lane);
  const R* const first = tile + weights.first[lane];
  constexpr int layers = layers_of<Shape>;
  R value_z[layers], dx_z[layers], dy_z[layers];
#pragma GCC unroll 3
  for (int k = 0; k < layers; ++k) {
    R value_y[N], dx_y[N];
#pragma GCC unroll 3
    for (int j = 0; j < N; ++j) {
      const R* const row = first + (k * tile_edge + j) * tile_edge;
      R along_x[N];
#pragma GCC unroll 3
      for (int i = 0; i < N; ++i) along_x[i] = row[i];
      value_y[j] = collect(a_x, along_x, dx_y[j]);
    }
    value_z[k] = collect(a_y, value_y, dy_z[k]);
    dx_z[k] = collect(a_y, dx_y);
  }
  if constexpr (is_planar<Shape>) {
    value = value_z[0];
    dx = dx_z[0];
    dy = dy_z[0];
    dz = R{};
  } else {
    value = collect(a_z, value_z, dz);
    dx = collect(a_z, dx_z);
    dy = collect(a_z, dy_z);
  }
}

// Of two-dimensional models. Area of a particle's section by its volume; cells by its radius, 0 in plane strain.
OGIVE_INLINE Lanes section_share(const KernelGroup& group, Lanes x) {
  const Lanes share = broadcast<Lanes>(group.section_share);
  return group.axisymmetric ? share / x : share;
}
OGIVE_INLINE Lanes cells_by_radius(const KernelGroup& group, Lanes x) {
  return group.axisymmetric ? 1.0 / (x * group.inverse_cell) : Lanes{};
}

// Eqs. (27), (28): nodal mass and momentum.
template <class Shape, bool affine>
void map_momentum(const KernelGroup& group, const KernelParticles& particles) {
  alignas(64) Record tile[tile_size];
  clear_tile(group, tile);
  Scatter<Shape> sums;
  Scatter<Shape>::begin(sums, tile);
  Weights weights[stretch / lane_count];
  for (std::int64_t start = group.begin; start < group.end; start += stretch) {
    const int count = fill_stretch < Shape,
              affine ? Beside::MomentsToGrid : Beside::Nothing > (weights, group, particles.position, start);
    for (int i = 0; i < count; ++i) {
      const std::int64_t p = start + i;
      const int lane = i % lane_count;
      if (lane == 0) {
        prefetch_records<4>(particles.velocity, p);
        if constexpr (affine) prefetch_records<9>(particles.affine, p);
      }
      // The fourth component of a velocity record is 1: the mass comes along.
      const double m = particles.position[4 * p + 3];
      const Record momentum = load_aligned<Record>(particles.velocity + 4 * p) * m;
      if constexpr (affine) {
        const double* C = particles.affine + 9 * p;
        scatter_slopes<Shape, Beside::MomentsToGrid, false>(weights[i / lane_count], lane, momentum, load_three(C) * m,
                                                            load_three(C + 3) * m, load_three(C + 6) * m, sums);
      } else {
        scatter_value<Shape>(weights[i / lane_count], lane, momentum, sums);
      }
    }
  }
  Scatter<Shape>::end(sums);
  add_tile(
      group, tile, [](const KernelGroup& g, int block) { return g.nodes[block] ? g.nodes[block]->v : nullptr; },
      sizeof(NodeRecord) / sizeof(double));
}

// Eq. (9) before it is made a unit vector, and the volume that the field fills at the node. A particle fills its
// current volume, but what has opened up by tension or failure does not count: volume_ratio above 1 is taken as 1. In a
// two-dimensional model both are of the section: a ring's mass, which grows with its radius, would tilt the normals.
template <class Shape>
void map_contact(const KernelGroup& group, const KernelParticles& particles) {
  alignas(64) Record tile[tile_size];
  clear_tile(group, tile);
  Scatter<Shape> sums;
  Scatter<Shape>::begin(sums, tile);
  // Multiplied, not built: valgrind, which the guard of the speed runs under, lacks the instruction for a lone first
  // element.
  alignas(32) constexpr double units[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  const Record of_x = load_aligned<Record>(units[0]), of_y = load_aligned<Record>(units[1]),
               of_z = load_aligned<Record>(units[2]), of_w = load_aligned<Record>(units[3]);
  Weights weights;
  for (std::int64_t p = group.begin; p < group.end; p += lane_count) {
    Lanes x, y, z, mass;
    load_records(particles.position + 4 * p, x, y, z, mass);
    fill<Shape, Beside::Derivatives>(weights, group, x, y, z);
    const Lanes ratio = load_aligned<Lanes>(particles.volume_ratio + p);
    alignas(32) double volume[lane_count];
    alignas(32) double masses[lane_count];
    if constexpr (is_planar<Shape>) {
      mass *= section_share(group, x);
      store_aligned(masses, mass);
    }
    store_aligned(volume, mass * group.inverse_density * min(ratio, broadcast<Lanes>(1.0)));
#pragma GCC unroll 1
    for (int lane = 0; lane < lane_count; ++lane) {
      const double m = (is_planar<Shape> ? masses[lane] : particles.position[4 * (p + lane) + 3]) * group.inverse_cell;
      scatter_slopes<Shape, Beside::Derivatives, false>(weights, lane, of_w * volume[lane], of_x * m, of_y * m,
                                                        of_z * m, sums);
    }
  }
  Scatter<Shape>::end(sums);
  add_tile(
      group, tile,
      [](const KernelGroup& g, int block) { return g.contact[block] ? g.contact[block]->gradient : nullptr; },
      sizeof(ContactRecord) / sizeof(double));
}

// Eqs. (33), (34). What PIC and APIC put in place of the increment, or a part of it, is the grid's own velocity.
template <class Shape, bool affine>
void update_particles(const KernelGroup& group, const KernelParticles& particles, MoveSums& sums) {
  alignas(64) RecordPair tile[tile_size];  // velocity, acceleration
  read_tile(group, [&](int t, const NodeRecord& record) {
    tile[t] = pair_of(load_aligned<Record>(record.v), load_aligned<Record>(record.f));
  });
  const Record low = load<Record>(group.bound_low), high = load<Record>(group.bound_high);
  const double from_grid = group.grid_velocity_fraction, kept = 1.0 - from_grid;
  IntVec<4> all_inside = low <= high;
  Lanes speed_squared{};
  Record power{}, lost{}, lost_affine{};
  Weights weights[stretch / lane_count];
  for (std::int64_t start = group.begin; start < group.end; start += stretch) {
    const int count = fill_stretch < Shape,
              affine ? Beside::MomentsFromGrid : Beside::Nothing > (weights, group, particles.position, start);
    for (int i = 0; i < count; i += lane_count) {
      const std::int64_t p = start + i;
      prefetch_records<4>(particles.velocity, p);
      if constexpr (affine) prefetch_records<9>(particles.affine, p);
      Record v[lane_count];
      for (int lane = 0; lane < lane_count; ++lane) {
        double* position = particles.position + 4 * (p + lane);
        RecordPair both;  // velocity and acceleration
        if (affine) {
          RecordPair dx, dy, dz;
          gather_slopes<Shape, Beside::MomentsFromGrid>(weights[i / lane_count], lane, tile, both, dx, dy, dz);
          const Record X = first_of(dx), Y = first_of(dy), Z = first_of(dz);
          const Record dX = second_of(dx), dY = second_of(dy), dZ = second_of(dz);
          double* C = particles.affine + 9 * (p + lane);
          const Record X_0 = load_three(C), Y_0 = load_three(C + 3), Z_0 = load_three(C + 6);
          if constexpr (is_planar<Shape>)
            lost_affine +=
                ((X_0 - X) * (X_0 + X - dX * group.time_step) + (Y_0 - Y) * (Y_0 + Y - dY * group.time_step)) * position[3];
          else
            lost_affine += ((X_0 - X) * (X_0 + X - dX * group.time_step) + (Y_0 - Y) * (Y_0 + Y - dY * group.time_step) +
                            (Z_0 - Z) * (Z_0 + Z - dZ * group.time_step)) *
                           position[3];
          store_three(C, X);
          store_three(C + 3, Y);
          if constexpr (!is_planar<Shape>) store_three(C + 6, Z);
        } else {
          both = gather_value<Shape>(weights[i / lane_count], lane, tile);
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
          set_lane(v[lane], 3, 1.0);
          lost += (flip - v[lane]) * (flip + v[lane] - increment) * position[3];
        }
        store_aligned(to, v[lane]);
      }
      transpose(v[0], v[1], v[2], v[3]);
      speed_squared = max(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], speed_squared);
    }
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
