// Debris beyond the reach of anything is dropped, its mass, momentum and energy booked (drop_debris; docs/theory.md, section 10.1).
//
// Every 50th step. All that is nearer to each other than four cells is one part; no node and no contact joins two parts. A part is
// debris if of no body it holds more than a hundredth of the mass that the body was given, nor the most of what is left of it, if no
// load or force acts on it, and if it can meet nothing until it has left the domain. It is a box that grows with any velocity that
// differs from that of its centre by at most the largest such difference now: a bound also where it tumbles. What it must stay four
// cells from: other parts, rigid and total Lagrangian bodies, walls, clamped regions and those of prescribed velocity, and mirrors
// (two cells: so far is it from its image then). Other parts have the velocities of their particles, rigid bodies all that their
// motion can have; those that may meet each other all that one of them has, and those that may meet a wall or mirror also the reverse.
//
// Never: where gravity acts, in axisymmetric models, rigid and total Lagrangian bodies, bodies whose surface makes contact.
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

constexpr std::int64_t debris_steps = 50;
constexpr double debris_share = 0.01;    // of the mass that a body was given, at most
constexpr double debris_distance = 4;    // cells

inline bool debris_is_due(const Model& model, const State& state) {
  return model.numerics.drop_debris && state.steps > 0 && state.steps % debris_steps == 0;
}

// After binning, before the grid is linked to the groups. By the number of the step alone, so that a restart does the same.
void drop_debris(const Model& model, State& state, Workspace& workspace);

}  // namespace ogive
