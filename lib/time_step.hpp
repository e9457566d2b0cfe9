// Time step from Huang et al. 2010, Eq. (35): dt = alpha h / max(c + |v|), c the fastest elastic or equation-of-state wave
// at the current state, |v| the particle's speed. The maximum is taken of each group's fastest wave plus its fastest
// particle, which is never less than the fastest sum.
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

// After a step, from what the kernels reported. Throws Error(Numerical) if the step has collapsed.
double stable_time_step(const Model& model, const State& state, const Workspace& workspace);
// Before the first step, from the material at rest and the initial velocities.
double initial_time_step(const Model& model, State& state, const Workspace& workspace);

}  // namespace ogive
