// Time step from Huang et al. 2010, Eq. (35): dt = alpha h / max(c + |v|), c the particle's fastest elastic or
// equation-of-state wave at its current state, |v| the speed at which the grid moves it. The maximum is taken particle by
// particle, so that it does not depend on how the grid is cut into blocks: a half model takes the full model's steps.
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

// 1 / sqrt(3), the factor of (35) up to which a lone fluid particle with affine velocity is stable (docs/theory.md, 8.1).
constexpr double lone_affine_particle_limit = 0.577;

// After a step, from what the kernels reported. Throws Error(Numerical) if the step has collapsed.
double stable_time_step(const Model& model, const State& state, const Workspace& workspace);
// Before the first step, from the material at rest and the initial velocities.
double initial_time_step(const Model& model, State& state, const Workspace& workspace);

}  // namespace ogive
