// Weights of a single particle, for the parts of a step that look at few of them; see shape/weights.hpp.
#pragma once

#include "grid.hpp"
#include "model.hpp"

namespace ogive {

struct ScalarWeights {
  int nodes = 0;   // along an axis
  int layers = 0;  // along z: one in a two-dimensional model
  int first[3];    // tile node of the first weight, by axis
  double w[3][3];  // by axis and node
  double d[3][3];  // derivatives per cell
  double from[3];  // cells from the particle to the first node

  // Of a particle at x in a group whose tile begins at `corner`.
  ScalarWeights(const Model& model, const Vector3& corner, const double* x);
};

// The grid's node at a node of the group's tile: tile node t is node (t + 3) % 4 of neighbour block (t + 3) / 4
// (transfer/tile.hpp).
inline std::int64_t node_of_tile(const GroupLinks& link, int x, int y, int z) {
  const std::int32_t slot = link.slot[(((z + 3) >> 2) * 3 + ((y + 3) >> 2)) * 3 + ((x + 3) >> 2)];
  return std::int64_t{slot} * block_nodes + (((z + 3) & 3) * 4 + ((y + 3) & 3)) * 4 + ((x + 3) & 3);
}

// Calls visit(node, i, j, k, weight) for the nodes that a particle of the group reaches, i, j, k counting them by axis.
template <class Visit>
void for_stencil(const ScalarWeights& s, const GroupLinks& link, Visit&& visit) {
  for (int k = 0; k < s.layers; ++k)
    for (int j = 0; j < s.nodes; ++j)
      for (int i = 0; i < s.nodes; ++i)
        visit(node_of_tile(link, s.first[0] + i, s.first[1] + j, s.first[2] + k), i, j, k, s.w[0][i] * s.w[1][j] * s.w[2][k]);
}

// Calls visit(node, weight, gradient per cell) for the nodes that a particle of the group reaches from x.
template <class Visit>
void for_nodes_of(const Model& model, const GroupLinks& link, const double* x, Visit&& visit) {
  const ScalarWeights s(model, link.corner, x);
  for_stencil(s, link, [&](std::int64_t node, int i, int j, int k, double weight) {
    visit(node, weight,
          Vector3{s.d[0][i] * s.w[1][j] * s.w[2][k], s.w[0][i] * s.d[1][j] * s.w[2][k], s.w[0][i] * s.w[1][j] * s.d[2][k]});
  });
}

}  // namespace ogive
