// Nodes whose velocity is given, w: at rest by clamps, another by prescribed velocities.
//
// *Clamped* nodes have no velocity and take no force: as at a fixed face, the particles do not see their velocity change
// (FLIP leaves them what the grid cannot see), and the strain, which sees them at rest, turns them round. So clamps do no work and
// what runs into one comes back. (If particles were given the change, each step would take from those next to a clamp what the
// mapping has smeared onto its nodes: a block that flies into one lost 94 % of its energy.)
// *Deep* in a clamp, where no particle that touches a node touches a free one too, no stress can stop a particle: there they take
// the node's change of velocity, and so they do at prescribed velocities, which have to drive them. Such nodes are *driven*; the
// strain sees w there as well.
//
// Driven nodes take the impulse J that leaves them w. Its work is what the particles get of it. With v_I and V_I = w the velocities
// of such a node at the beginning and the end, particle p goes from v_p to V_p and has of node I the increment N_I(x_p) (w - v_I):
//   sum_p N_I m_p (w - v_I) . (v_p + V_p) / 2.
// Of the impulse m_I (w - v_I) the internal forces and contact give J' = m_I (w - v_I) - J, which does the work J' . w in the
// strain that w makes. What is left is of what holds the node:
//   W_I = m_I (w - v_I) . (v_I + q_I / 2) - J' . w,   q_I = sum_p N_I(x_p) m_p (V_p - v_p) / m_I;
// affine velocities are mapped to q_I as (28) maps them. (The first v_I is the part of order one that transfer dissipation
// shares; q_I = w - v_I would be the work in the lumped grid, of which particles, which do not follow each node, lose more.)
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

// Lists the held nodes of the grid and the groups that reach them; when the grid has been linked.
void find_held_nodes(const Model& model, Workspace& workspace);

// After the mapping, records {velocity, mass | ...}: clamped nodes are at rest, for good.
void hold_clamps(const State& state, Workspace& workspace);
// The same for the velocities of the XPIC filter.
void hold_filter(Workspace& workspace);

// For the strain: driven nodes get w; the second returns what they had.
void drive_nodes(const State& state, Workspace& workspace);
void return_driven(Workspace& workspace);

// Records {velocity at the beginning, mass | velocity at the end}: gives held nodes w at the end. Books the impulse.
void hold_nodes(const Model& model, State& state, Workspace& workspace, double dt);

// Books the work, from the same records of the whole step.
void book_held_work(const Model& model, State& state, Workspace& workspace);

}  // namespace ogive
