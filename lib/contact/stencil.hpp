// The nodes of a field around a point with their weights, from the slots of the grid. Images beyond symmetry and fixed faces
// are in the weights of the nodes that they mirror. A total Lagrangian body is a field of its reference grid, and the points are
// where they lay at rest.
#pragma once

#include <algorithm>
#include <cmath>

#include "contact/points.hpp"
#include "grid.hpp"
#include "shape/gimp.hpp"

namespace ogive {

// Weights along one axis of a particle `xi` cells from domain_min; the first node.
inline int stencil_weights(ShapeFunction shape, double xi, double (&w)[3]) {
  if (shape == ShapeFunction::Linear) {
    const int first = static_cast<int>(std::floor(xi));
    const double f = xi - first;
    w[0] = 1 - f;
    w[1] = f;
    w[2] = 0;
    return first;
  }
  const int nearest = static_cast<int>(std::floor(xi + 0.5));
  const double f = xi - nearest;
  if (shape == ShapeFunction::Gimp) {
    constexpr double l = gimp_half_width;
    const double within = std::clamp(f, -l, l), beyond = f - within;
    w[0] = (l - within) * (l - within) * (0.25 / l) + std::max(-beyond, 0.0);
    w[2] = (l + within) * (l + within) * (0.25 / l) + std::max(beyond, 0.0);
    w[1] = 1 - (w[0] + w[2]);
    return nearest - 1;
  }
  w[0] = 0.5 * (0.5 - f) * (0.5 - f);
  w[1] = 0.75 - f * f;
  w[2] = 0.5 * (0.5 + f) * (0.5 + f);
  return nearest - 1;
}

// For one thread: it remembers the last blocks.
class Stenciler {
 public:
  Stenciler(const Model& model, const Workspace& workspace) : model_(model), workspace_(workspace) {}

  // Appends the stencil of a field at x. On a surface no particle says that the nodes have the mass to move it: weights are
  // N_j c_j / sum_k N_k c_k, c_j = m_j / (m_j + m / 10), m the largest mass of the stencil. Nothing where there is no mass.
  void make(std::int32_t field, const Vector3& x, bool on_surface, std::vector<PointNode>& stencil) const {
    Nodes nodes;
    collect(field, x, nodes);
    if (on_surface) lighten(nodes);
    for (int i = 0; i < nodes.count; ++i)
      stencil.push_back({nodes.weight[i], static_cast<std::int32_t>(nodes.record[i] - workspace_.nodes.data())});
  }

  // Appends the stencil of a total Lagrangian body's surface at the place of rest X. `inside`: as deep as the outermost particles,
  // where the nodes around carry the surface. Their weights w_j = N_j(inside) c_j (1 + (X_j - X_m) . C^-1 (X - X_m)) / sum N c, with
  // c as above and X_m, C the mean and covariance of the nodes with the weights N c, give linear fields exactly at X: the surface
  // turns and stretches with the body. Directions in which the nodes hardly spread are left out.
  void make_linear(std::int32_t field, const Vector3& X, const Vector3& inside, std::vector<PointNode>& stencil) const {
    Unfolded nodes;
    unfold(field, inside, nodes);
    if (nodes.count == 0) return;
    double largest = 0, sum = 0;
    for (int i = 0; i < nodes.count; ++i) largest = std::max(largest, nodes.mass[i]);
    Vector3 mean{};
    for (int i = 0; i < nodes.count; ++i) {
      nodes.share[i] *= nodes.mass[i] / (nodes.mass[i] + light * largest);
      sum += nodes.share[i];
      add(mean, times(nodes.share[i], nodes.place[i]));
    }
    mean = times(1 / sum, mean);
    Matrix3 spread{};
    for (int i = 0; i < nodes.count; ++i) {
      const Vector3 r = minus(nodes.place[i], mean);
      for (int c = 0; c < 3; ++c) add(spread[c], times(nodes.share[i] / sum * r[c], r));
    }
    const Vector3 slope = solve_where_spread(spread, minus(in_cells(X), mean));
    for (int i = 0; i < nodes.count; ++i) {
      const Vector3 r = minus(nodes.place[i], mean);
      const double weight = nodes.share[i] / sum * (1 + dot(r, slope));
      stencil.push_back({times(weight, nodes.sign[i]), static_cast<std::int32_t>(nodes.record[i] - workspace_.nodes.data())});
    }
  }

  // Velocity at the end of the step (node records: {-, mass | velocity}) of a field's surface at x; false: no mass there.
  bool end_velocity_on_surface(std::int32_t field, const Vector3& x, Vector3& velocity) const {
    Nodes nodes;
    collect(field, x, nodes);
    lighten(nodes);
    velocity = {};
    for (int i = 0; i < nodes.count; ++i)
      for (int c = 0; c < 3; ++c) velocity[c] += nodes.weight[i][c] * nodes.record[i]->f[c];
    return nodes.count > 0;
  }

 private:
  static constexpr double light = 0.1;
  static constexpr double least_spread = 0.02;  // square cells

  // Those around a point that have mass, with the weights of the components, and without signs.
  struct Nodes {
    int count = 0;
    const NodeRecord* record[27];
    Vector3 weight[27];
    double share[27], mass[27];  // mass: with that of its image, on a mirror face
  };

  // Along one axis: the nodes with the weights of the vector's component along the axis and of those across it, images in
  // them, and the weights without signs. The components of nodes held by a fixed face are zero.
  struct Axis {
    int count = 0;
    int index[3];
    double along[3], across[3], whole[3], images[3];
    bool held[3];
  };
  using Axes = std::array<Axis, 3>;

  Axes axes_at(const Vector3& x) const {
    const Grid& grid = model_.grid;
    const int width = model_.numerics.shape_function == ShapeFunction::Linear ? 2 : 3;
    Axes axes;
    for (int a = 0; a < 3; ++a) {
      Axis& axis = axes[a];
      double w[3];
      const int first = stencil_weights(model_.numerics.shape_function, (x[a] - grid.domain_min[a]) / grid.cell_size, w);
      const int last = static_cast<int>(std::lround((grid.domain_max[a] - grid.domain_min[a]) / grid.cell_size));
      for (int i = 0; i < width; ++i) {
        if (w[i] == 0) continue;
        int node = first + i;
        double sign_along = 1, sign_across = 1;
        bool held = false;
        double images = 1;
        for (int side = 0; side < 2; ++side) {
          const Face face = grid.face[2 * a + side];
          if (face == Face::Free) continue;
          const int plane = side == 0 ? 0 : last;
          if (node == plane) {
            sign_along = 0;
            held = face == Face::Fixed;
            images = 2;
          } else if (side == 0 ? node < plane : node > plane) {
            node = 2 * plane - node;
            sign_along = -1;
            if (face == Face::Fixed) sign_across = -1;
          }
        }
        int at = 0;
        while (at < axis.count && axis.index[at] != node) ++at;
        if (at == axis.count) {
          ++axis.count;
          axis.index[at] = node;
          axis.along[at] = axis.across[at] = axis.whole[at] = 0;
          axis.held[at] = held;
          axis.images[at] = images;
        }
        axis.along[at] += sign_along * w[i];
        axis.across[at] += sign_across * w[i];
        axis.whole[at] += w[i];
      }
    }
    return axes;
  }

  void collect(std::int32_t field, const Vector3& at, Nodes& nodes) const {
    const Axes axes = axes_at(at);
    const auto& [x, y, z] = axes;
    for (int k = 0; k < z.count; ++k)
      for (int j = 0; j < y.count; ++j)
        for (int i = 0; i < x.count; ++i) {
          const NodeRecord* record = node_of(field, {x.index[i], y.index[j], z.index[k]});
          if (!record || !(record->v[3] > 0)) continue;
          Vector3& weight = nodes.weight[nodes.count];
          weight = {x.along[i] * y.across[j] * z.across[k], x.across[i] * y.along[j] * z.across[k],
                    x.across[i] * y.across[j] * z.along[k]};
          if (x.held[i] || y.held[j] || z.held[k]) weight = {};
          nodes.share[nodes.count] = x.whole[i] * y.whole[j] * z.whole[k];
          nodes.mass[nodes.count] = record->v[3] * x.images[i] * y.images[j] * z.images[k];
          nodes.record[nodes.count++] = record;
        }
  }

  // C^-1 r by elimination, the widest direction first; zero along those that are left out.
  static Vector3 solve_where_spread(Matrix3 C, Vector3 r) {
    int order[3] = {0, 1, 2}, rank = 0;
    for (; rank < 3; ++rank) {
      for (int k = rank + 1; k < 3; ++k)
        if (C[order[k]][order[k]] > C[order[rank]][order[rank]]) std::swap(order[rank], order[k]);
      const int p = order[rank];
      if (!(C[p][p] > least_spread)) break;
      for (int k = rank + 1; k < 3; ++k) {
        const double factor = C[order[k]][p] / C[p][p];
        add(C[order[k]], times(-factor, C[p]));
        r[order[k]] -= factor * r[p];
      }
    }
    Vector3 solution{};
    for (int k = rank - 1; k >= 0; --k) {
      const int p = order[k];
      double rest = r[p];
      for (int j = k + 1; j < rank; ++j) rest -= C[p][order[j]] * solution[order[j]];
      solution[p] = rest / C[p][p];
    }
    return solution;
  }

  // The same with images beyond faces for themselves; sign: what of the image's components it has, 0 where a face holds them.
  struct Unfolded {
    int count = 0;
    const NodeRecord* record[27];
    Vector3 place[27], sign[27];  // place in cells from domain_min
    double share[27], mass[27];
  };

  Vector3 in_cells(const Vector3& x) const {
    Vector3 xi;
    for (int a = 0; a < 3; ++a) xi[a] = (x[a] - model_.grid.domain_min[a]) / model_.grid.cell_size;
    return xi;
  }

  void unfold(std::int32_t field, const Vector3& x, Unfolded& nodes) const {
    const Grid& grid = model_.grid;
    const ShapeFunction shape = model_.numerics.shape_function;
    const int width = shape == ShapeFunction::Linear ? 2 : 3;
    const Vector3 xi = in_cells(x);
    double w[3][3];
    int first[3], real[3][3];
    bool on_face[3][3] = {}, beyond[3][3] = {}, fixed[3][3] = {};
    for (int a = 0; a < 3; ++a) {
      first[a] = stencil_weights(shape, xi[a], w[a]);
      const int last = static_cast<int>(std::lround((grid.domain_max[a] - grid.domain_min[a]) / grid.cell_size));
      for (int i = 0; i < width; ++i) {
        real[a][i] = first[a] + i;
        for (int side = 0; side < 2; ++side) {
          const int plane = side == 0 ? 0 : last;
          if (grid.face[2 * a + side] == Face::Free) continue;
          on_face[a][i] = on_face[a][i] || real[a][i] == plane;
          if (side == 0 ? real[a][i] < plane : real[a][i] > plane) {
            real[a][i] = 2 * plane - real[a][i];
            beyond[a][i] = true;
          }
          if (on_face[a][i] || beyond[a][i]) fixed[a][i] = grid.face[2 * a + side] == Face::Fixed;
        }
      }
    }
    for (int k = 0; k < width; ++k)
      for (int j = 0; j < width; ++j)
        for (int i = 0; i < width; ++i) {
          const int at[3] = {i, j, k};
          const double share = w[0][i] * w[1][j] * w[2][k];
          if (share == 0) continue;
          const NodeRecord* record = node_of(field, {real[0][i], real[1][j], real[2][k]});
          if (!record || !(record->v[3] > 0)) continue;
          Vector3 sign = {1, 1, 1};
          double mass = record->v[3];
          for (int a = 0; a < 3; ++a) {
            const bool plane = on_face[a][at[a]];
            if (plane) mass *= 2;
            for (int c = 0; c < 3; ++c)
              if (c == a || fixed[a][at[a]]) sign[c] *= plane ? 0 : beyond[a][at[a]] ? -1 : 1;
          }
          nodes.share[nodes.count] = share;
          nodes.mass[nodes.count] = mass;
          nodes.sign[nodes.count] = sign;
          for (int a = 0; a < 3; ++a) nodes.place[nodes.count][a] = first[a] + at[a];
          nodes.record[nodes.count++] = record;
        }
  }

  static void lighten(Nodes& nodes) {
    double largest = 0, sum = 0, part[27];
    for (int i = 0; i < nodes.count; ++i) largest = std::max(largest, nodes.mass[i]);
    for (int i = 0; i < nodes.count; ++i) {
      part[i] = nodes.mass[i] / (nodes.mass[i] + light * largest);
      sum += nodes.share[i] * part[i];
    }
    const double inverse = 1 / sum;
    for (int i = 0; i < nodes.count; ++i) nodes.weight[i] = times(part[i] * inverse, nodes.weight[i]);
  }

  // A stencil lies in at most eight blocks, of which no two have the same parities.
  struct Known {
    std::array<std::int32_t, 4> key{-1, -1, -1, -1};  // z, y, x, field
    std::int64_t slot = -1;
  };

  const NodeRecord* node_of(std::int32_t field, const std::array<int, 3>& at) const {
    const int x = at[0] >> 2, y = at[1] >> 2, z = at[2] >> 2;
    Known& known = known_[(x & 1) | (y & 1) << 1 | (z & 1) << 2];
    if (known.key[2] != x || known.key[1] != y || known.key[0] != z || known.key[3] != field) {
      known.key = {z, y, x, field};
      const auto found = std::lower_bound(workspace_.slots.begin(), workspace_.slots.end(), known.key,
                                          [](const Slot& slot, const std::array<std::int32_t, 4>& key) {
                                            return std::array<std::int32_t, 4>{slot.block[2], slot.block[1], slot.block[0],
                                                                               slot.field} < key;
                                          });
      const bool there = found != workspace_.slots.end() && found->block == std::array<std::int32_t, 3>{x, y, z} &&
                         found->field == field;
      known.slot = there ? found - workspace_.slots.begin() : -1;
    }
    if (known.slot < 0) return nullptr;
    return &workspace_.nodes[known.slot * block_nodes + ((at[2] & 3) * 4 + (at[1] & 3)) * 4 + (at[0] & 3)];
  }

  const Model& model_;
  const Workspace& workspace_;
  mutable Known known_[8];
};

}  // namespace ogive
