// Watches the ledger for energy that nothing gave, and that nothing took: an unstable run is named before it delivers nonsense.
//
//   growth = (total - initial total - energy that the host put in by setting fields)
//            / (initial total + largest external and prescribed work so far + |energy from the host|)
//
// A loss is a negative growth. Clamps only take: what they give (they cannot, but for rounding) counts as growth.
#pragma once

#include <string>

#include "model.hpp"
#include "state.hpp"

namespace ogive {

constexpr std::int64_t energy_watch_steps = 25;  // a pass over all particles: 0.2 % of the work of so many steps

// Growth now; negative where energy is lost.
double energy_growth(const Model& model, const State& state, int threads = 1);

// Throws Error(Numerical), with when, where and the probable cause, if growth is above energy_limit or loss above
// energy_loss_limit.
void check_energy(const Model& model, const State& state, double growth);

// To be called after each step; looks at every 25th. Remembers the largest growth and when the warning's limit was first passed.
// Returns true when it has been passed in this call. Checks as above.
bool watch_energy(const Model& model, State& state, int threads);

// What most likely makes this run gain energy, and what helps.
std::string probable_cause(const Model& model, const State& state);

}  // namespace ogive
