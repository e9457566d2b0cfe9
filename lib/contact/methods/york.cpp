// York, Sulsky, Schreyer 1999: where two bodies approach, the step is that of the standard method, without slip; where they
// depart, each moves in its own field. One decision a step, on the velocities as mapped.
#include "contact/method.hpp"

namespace ogive {
namespace {

Constraint while_approaching(const PairView& pair) {
  if (!(dot(pair.mapped, pair.normal) > 0)) return {};
  return {Hold::Stick, 0, false};
}

}  // namespace

extern const ContactMethodDef york_method = {
    .name = "york",
    .summary = "York et al. 1999: standard MPM while bodies approach, free departure",
    .at_start = while_approaching,
    .at_end = while_approaching,
    .start_reaches_particles = false,
    .needs_normal = true,
    .has_friction = false,
    .needs_stress = false,
    .remembers = false,
};

}  // namespace ogive
