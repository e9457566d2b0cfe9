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
    for (int i = 0; i < nodes.count; ++i) append(nodes, i, nodes.share[i], stencil);
  }

  // Appends the stencil of a total Lagrangian body's surface at the place of rest X. `inside`: as deep as the outermost particles,
  // where the nodes around carry the surface. With the weights W_j of `make` there, and X_m, C the mean and covariance of the nodes,
  // the weights W_j (1 + (X_j - X_m) . C^-1 (X - X_m)) give linear fields exactly at X: the surface turns and stretches with the
  // body. Directions in which the nodes hardly spread are left out.
  void make_linear(std::int32_t field, const Vector3& X, const Vector3& inside, std::vector<PointNode>& stencil) const {
    Nodes nodes;
    collect(field, inside, nodes);
    lighten(nodes);
    Vector3 mean{};
    for (int i = 0; i < nodes.count; ++i) add(mean, times(nodes.share[i], nodes.place[i]));
    Matrix3 spread{};
    for (int i = 0; i < nodes.count; ++i) {
      const Vector3 r = minus(nodes.place[i], mean);
      for (int c = 0; c < 3; ++c) add(spread[c], times(nodes.share[i] * r[c], r));
    }
    const Vector3 slope = solve_where_spread(spread, minus(in_cells(X), mean));
    for (int i = 0; i < nodes.count; ++i)
      append(nodes, i, nodes.share[i] * (1 + dot(minus(nodes.place[i], mean), slope)), stencil);
  }

 private:
  friend class SurfaceVelocities;
  static constexpr double light = 0.1;
  static constexpr double least_spread = 0.02;  // square cells

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

  // Those around a point that have mass, images beyond faces for themselves.
  struct Nodes {
    int count = 0;
    const NodeRecord* record[27];
    Vector3 place[27];  // in cells from domain_min; of an image its own
    Vector3 sign[27];   // of an image's components: -1 or 0 where the face turns or holds them
    double share[27];   // the shape function
    double mass[27];    // with that of its image, on a face
  };

  Vector3 in_cells(const Vector3& x) const {
    Vector3 xi;
    for (int a = 0; a < 3; ++a) xi[a] = (x[a] - model_.grid.domain_min[a]) / model_.grid.cell_size;
    return xi;
  }

  int width() const { return model_.numerics.shape_function == ShapeFunction::Linear ? 2 : 3; }

  // Where the nodes from `first` on along an axis are: those beyond a face at their images, with the signs of the components there.
  struct Line {
    double images[3];
    int real[3];
    Vector3 sign[3];
  };
  Line line_of(int a, int first) const {
    const Grid& grid = model_.grid;
    const int last = static_cast<int>(std::lround((grid.domain_max[a] - grid.domain_min[a]) / grid.cell_size));
    Line line;
    for (int i = 0; i < width(); ++i) {
      line.real[i] = first + i;
      line.images[i] = 1;
      line.sign[i] = {1, 1, 1};
      for (int side = 0; side < 2; ++side) {
        const Face face = grid.face[2 * a + side];
        const int plane = side == 0 ? 0 : last;
        const bool beyond = side == 0 ? line.real[i] < plane : line.real[i] > plane, on = line.real[i] == plane;
        if (face == Face::Free || !(beyond || on)) continue;
        if (on) line.images[i] = 2;
        line.real[i] = 2 * plane - line.real[i];
        for (int c = 0; c < 3; ++c)
          if (c == a || face == Face::Fixed) line.sign[i][c] = on ? 0 : -1;
      }
    }
    return line;
  }

  // visit(i, j, k, node, mass with that of its image on a face, signs of an image's components) for the nodes with mass.
  template <class Visit>
  void for_nodes(std::int32_t field, const std::array<int, 3>& first, Visit&& visit) const {
    const Line X = line_of(0, first[0]), Y = line_of(1, first[1]), Z = line_of(2, first[2]);
    for (int k = 0; k < width(); ++k)
      for (int j = 0; j < width(); ++j)
        for (int i = 0; i < width(); ++i) {
          const NodeRecord* record = node_of(field, {X.real[i], Y.real[j], Z.real[k]});
          if (!record || !(record->v[3] > 0)) continue;
          Vector3 sign;
          for (int c = 0; c < 3; ++c) sign[c] = X.sign[i][c] * Y.sign[j][c] * Z.sign[k][c];
          visit(i, j, k, *record, record->v[3] * X.images[i] * Y.images[j] * Z.images[k], sign);
        }
  }

  void collect(std::int32_t field, const Vector3& x, Nodes& nodes) const {
    const Vector3 xi = in_cells(x);
    double w[3][3];
    std::array<int, 3> first;
    for (int a = 0; a < 3; ++a) first[a] = stencil_weights(model_.numerics.shape_function, xi[a], w[a]);
    for_nodes(field, first, [&](int i, int j, int k, const NodeRecord& record, double mass, const Vector3& sign) {
      const double share = w[0][i] * w[1][j] * w[2][k];
      if (share == 0) return;
      const int n = nodes.count++;
      nodes.record[n] = &record;
      nodes.place[n] = {static_cast<double>(first[0] + i), static_cast<double>(first[1] + j), static_cast<double>(first[2] + k)};
      nodes.sign[n] = sign;
      nodes.share[n] = share;
      nodes.mass[n] = mass;
    });
  }

  // Shares become N_j c_j / sum_k N_k c_k.
  static void lighten(Nodes& nodes) {
    double largest = 0, sum = 0;
    for (int i = 0; i < nodes.count; ++i) largest = std::max(largest, nodes.mass[i]);
    for (int i = 0; i < nodes.count; ++i) {
      nodes.share[i] *= nodes.mass[i] / (nodes.mass[i] + light * largest);
      sum += nodes.share[i];
    }
    const double inverse = 1 / sum;
    for (int i = 0; i < nodes.count; ++i) nodes.share[i] *= inverse;
  }

  void append(const Nodes& nodes, int i, double weight, std::vector<PointNode>& stencil) const {
    stencil.push_back({times(weight, nodes.sign[i]), static_cast<std::int32_t>(nodes.record[i] - workspace_.nodes.data())});
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

// Velocities at the end of the step (node records: {-, mass | velocity}) on the surfaces of fields, with the weights of
// Stenciler::make. For one thread and one phase of a step: many vertices share a cell, and what its nodes have in common.
class SurfaceVelocities {
 public:
  SurfaceVelocities(const Model& model, const Workspace& workspace) : stenciler_(model, workspace), model_(model) {}

  // At x; false: no mass there.
  bool at(std::int32_t field, const Vector3& x, Vector3& velocity) const {
    const int width = stenciler_.width();
    const Vector3 xi = stenciler_.in_cells(x);
    double w[3][3];
    std::array<int, 4> key{0, 0, 0, field};
    bool all = true;
    for (int a = 0; a < 3; ++a) {
      key[a] = stencil_weights(model_.numerics.shape_function, xi[a], w[a]);
      for (int i = 0; i < width; ++i) all = all && w[a][i] != 0;
    }
    velocity = {};
    if (!all) {  // the largest mass is not that of all nodes of the cell
      Stenciler::Nodes nodes;
      stenciler_.collect(field, x, nodes);
      Stenciler::lighten(nodes);
      for (int i = 0; i < nodes.count; ++i)
        for (int c = 0; c < 3; ++c) velocity[c] += nodes.share[i] * nodes.sign[i][c] * nodes.record[i]->f[c];
      return nodes.count > 0;
    }
    Cell& cell = cells_[(key[0] & 3) | (key[1] & 3) << 2 | (key[2] & 3) << 4];
    if (!cell.known || cell.key != key) fill(key, cell);
    double sum[4] = {};
    for (int k = 0, n = 0; k < width; ++k)
      for (int j = 0; j < width; ++j) {
        const double along = w[1][j] * w[2][k];
        for (int i = 0; i < width; ++i, ++n)
          for (int c = 0; c < 4; ++c) sum[c] += along * w[0][i] * cell.of[n][c];
      }
    if (!(sum[3] > 0)) return false;
    velocity = times(1 / sum[3], {sum[0], sum[1], sum[2]});
    return true;
  }

 private:
  // {c_j v_j, c_j} of the nodes, x fastest.
  struct Cell {
    bool known = false;
    std::array<int, 4> key{};  // first node, field
    double of[27][4];
  };

  void fill(const std::array<int, 4>& key, Cell& cell) const {
    cell.known = true;
    cell.key = key;
    const int width = stenciler_.width(), count = width * width * width;
    for (int n = 0; n < count; ++n)
      for (double& value : cell.of[n]) value = 0;
    double largest = 0;
    stenciler_.for_nodes(key[3], {key[0], key[1], key[2]},
                         [&](int i, int j, int k, const NodeRecord& record, double mass, const Vector3& sign) {
                           double* const of = cell.of[(k * width + j) * width + i];
                           largest = std::max(largest, mass);
                           for (int c = 0; c < 3; ++c) of[c] = sign[c] * record.f[c];
                           of[3] = mass;
                         });
    for (int n = 0; n < count; ++n) {
      double* const of = cell.of[n];
      if (of[3] == 0) continue;
      of[3] /= of[3] + Stenciler::light * largest;
      for (int c = 0; c < 3; ++c) of[c] *= of[3];
    }
  }

  const Stenciler stenciler_;
  const Model& model_;
  mutable std::array<Cell, 64> cells_;
};

}  // namespace ogive
