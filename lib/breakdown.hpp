// Silent nonsense made loud. What a step may leave behind is bounded, and what a file brings in is checked, so that no result is
// built on numbers that cannot be.
//
// After each step, with c the fastest wave of the materials at rest and v the fastest body at the start:
//   runaway    a particle is faster than 10 (c + v), and than 10 (c + v + w), w being what nine tenths of its body
//              exceed, so that a body that loads have made fast as a whole is none
//   collapse   the fastest wave, with the speed at which the grid moves, is above 100 (c + v + fastest particle)
// Both compare speeds, hence hold in any units and on any grid. A shock makes waves a few times faster, a jet is a few times
// faster than the impact: what lies beyond these bounds no material does. That a particle is not a number, is turned inside out
// (stress update) or is outside the domain (binning) is found where it happens; here are the words for it.
#pragma once

#include <cstdint>
#include <string>

#include "error.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

constexpr double runaway_factor = 10, collapse_factor = 100;

// "body "rod": particle 17 at (1, 2, 3), step 120, time 0.5: WHAT; CAUSE". `particle`: its place in the body's arrays.
Error breakdown(const Model& model, const State& state, int body, std::int64_t particle, const std::string& what,
                const std::string& cause);

// Throws Error(Numerical) where a particle runs away or a rigid body's motion is not finite. After each step.
void check_speeds(const Model& model, const State& state);

// True where `fastest`, a wave with what moves it, is beyond the bound.
bool time_step_collapsed(const Model& model, const State& state, double fastest);

// The particle that is compressed the most, to say where a time step collapsed.
Error collapse(const Model& model, const State& state, double dt, double fastest);

// Throws Error(Format) naming the array, the place and the value where a loaded state holds what no step leaves behind: values
// that are not finite or outside their range, numbers of particles twice.
void require_sound(const Model& model, const State& state);

}  // namespace ogive
