// The reference grids of total Lagrangian bodies: each the regular grid, laid over the body as it was at the beginning.
#pragma once

#include "grid.hpp"
#include "lagrangian/contact.hpp"
#include "model.hpp"
#include "shape/scalar_weights.hpp"
#include "state.hpp"

namespace ogive {

// Links the reference grid of the bodies that are total Lagrangian now: masses of nodes, mirrors, points whose velocity
// is prescribed. Drops it where there are none. `fresh`: the bodies begin, with the velocities of their particles.
void link_reference_grid(const Model& model, State& state, Workspace& workspace, bool fresh);

// Gives the nodes the velocities that fit those of the particles best, with the same momentum, and the particles what
// the nodes then say. Node records hold the masses.
void project_velocities(const Model& model, State& state, const Workspace& reference, int body);

// Records of nodes of a body in the state, for a slot of the reference grid.
inline std::size_t first_of_slot(const Slot& slot) { return std::size_t{4} * block_nodes * slot.ordinal; }

// Calls visit(NodeWeight) for the nodes that particle p reaches from its place at rest; nodes beyond a mirror as their
// images.
template <class Visit>
void for_reference_nodes(const Model& model, const State& state, const Workspace& reference, int body, std::int64_t p,
                         Visit&& visit) {
  const GroupLinks& link = reference.links[reference.link_of[body][p]];
  for_nodes_of(model, link, &state.bodies[body].reference.position[4 * p],
               [&](std::int64_t node, double weight, const Vector3&) {
                 visit(NodeWeight{reference.image[node], weight, reference.image_signs[node]});
               });
}

}  // namespace ogive
