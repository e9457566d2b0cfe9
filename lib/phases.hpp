// Parts of a step that the common grid and the reference grids of total Lagrangian bodies share.
#pragma once

#include <cstdint>

#include "grid.hpp"
#include "model.hpp"
#include "parallel.hpp"
#include "state.hpp"

namespace ogive {

// Runs work(link, index) over all groups but those at rest that the step leaves out; those that write to common nodes one after
// the other, always in the same order.
template <class Work>
void for_groups_in_order(Workspace& workspace, Work&& work) {
  workspace.schedule.for_each_in_order([&](std::int32_t p) {
    for (std::int32_t l = workspace.pencils[p].begin; l < workspace.pencils[p].end; ++l)
      if (!workspace.links[l].skipped) work(workspace.links[l], l);
  });
}

// The same in any order.
template <class Work>
void for_groups(Workspace& workspace, Work&& work) {
  workspace.schedule.for_each([&](std::int32_t p) {
    for (std::int32_t l = workspace.pencils[p].begin; l < workspace.pencils[p].end; ++l)
      if (!workspace.links[l].skipped) work(workspace.links[l], l);
  });
}

// Runs work(node) over all nodes in use, but those of idle slots.
template <class Work>
void for_nodes(Workspace& workspace, Work&& work) {
  workspace.slot_parts.for_each([&](std::int64_t s) {
    if (workspace.slots[s].idle) return;
    for (std::int64_t i = s * block_nodes; i < s * block_nodes + workspace.nodes_in_use; ++i) work(i);
  });
}

// Node records {velocity, mass | force} become {velocity, mass | trial velocity}, (11) or (26).
void trial_velocities(const Model& model, Workspace& workspace, double dt);

// Work at the mean of the velocities at the beginning and the end, as that of the loads (loads/loads.hpp).
void book_gravity(const Model& model, State& state, const Workspace& workspace, double dt);

// Adds up what the laws of this grid's bodies report; throws Error(Numerical) for a particle that has broken down.
void book_stress(const Model& model, State& state, const Workspace& workspace, double dt);

}  // namespace ogive
