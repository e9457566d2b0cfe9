// Changes of a model that already runs, where what the particles carry stays true of the new one.
//
// Allowed: numerics that leave no trace in the state, contact rules, the stop condition, and of a material what only the coming
// steps ask for: yield stress, hardening, rate and thermal softening, heating, failure strain, viscosity. The present yield
// stress is made anew from plastic strain and temperature.
// Refused, because stress, energy, mass or arrays of the particles belong to the old value: density, elastic constants, equation
// of state, kind of strength or failure, thermal softening begun or ended, affine velocities begun or ended, order of update, and
// a failure strain that would make failed particles whole or whole ones failed without a step.
#pragma once

#include "model.hpp"
#include "state.hpp"

namespace ogive {

// Throws Error(Argument) naming the field where `after`, which is complete, cannot take the place of `before`.
void require_consistent_change(const Model& before, const Model& after, const State& state);

// What the state needs for it: yield stresses, and a first time step that is safe for both models. Call it once checked.
void adapt_state(const Model& before, const Model& after, State& state);

}  // namespace ogive
