// The algorithm: one explicit step of the material point method, update stress first, Huang et al. 2010, section 4.
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

// Advances the state by dt (0 < dt <= state.stable_time_step). Throws Error(Numerical) where the run has broken down; the
// state is then the broken one, for inspection, and must not be stepped again.
void advance_one_step(const Model& model, State& state, Workspace& workspace, double dt);

// After building or loading a state: bins where needed, links the grid, computes the stable time step if there is none yet.
void prepare_state(const Model& model, State& state, Workspace& workspace);

}  // namespace ogive
