// Parts of a step that the common grid and the reference grids of total Lagrangian bodies share.
#pragma once

#include <cstdint>

#include "grid.hpp"
#include "model.hpp"
#include "simd/subnormals.hpp"
#include "state.hpp"

namespace ogive {

// Runs work(link, index) over all groups, colour by colour: the groups of one colour write to disjoint nodes.
template <class Work>
void for_coloured_groups(Workspace& workspace, Work&& work) {
  for (int colour = 0; colour < 4; ++colour) {
    const std::int32_t begin = workspace.colour[colour], end = workspace.colour[colour + 1];
#pragma omp parallel num_threads(workspace.threads) if (end - begin > 1)
    {
      const FlushSubnormals flush;
#pragma omp for schedule(dynamic, 1)
      for (std::int32_t p = begin; p < end; ++p)
        for (std::int32_t l = workspace.pencils[p].begin; l < workspace.pencils[p].end; ++l)
          work(workspace.links[l], l);
    }
  }
}

// Runs work(node record) over all nodes.
template <class Work>
void for_nodes(Workspace& workspace, Work&& work) {
  const std::int64_t count = static_cast<std::int64_t>(workspace.nodes.size());
#pragma omp parallel num_threads(workspace.threads)
  {
    const FlushSubnormals flush;
#pragma omp for schedule(static)
    for (std::int64_t i = 0; i < count; ++i) work(workspace.nodes[i]);
  }
}

// Node records {velocity, mass | force} become {velocity, mass | trial velocity}, (11) or (26), and gravity is booked.
void trial_velocities(const Model& model, State& state, Workspace& workspace, double dt);

// Adds up what the laws of this grid's bodies report; throws Error(Numerical) for a particle that has broken down.
void book_stress(const Model& model, State& state, const Workspace& workspace, double dt);

}  // namespace ogive
