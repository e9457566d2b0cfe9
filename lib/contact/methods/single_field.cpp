// The standard material point method as the rule of a pair: one velocity at every node that both bodies reach, so no slip
// and no separation. Where all pairs are of this method the engine keeps a single velocity field instead, with the same
// result to round-off.
#include "contact/method.hpp"

namespace ogive {
namespace {

Constraint stick(const PairView&) { return {Hold::Stick, 0, false}; }

}  // namespace

extern const ContactMethodDef single_field_method = {
    .name = "single_field",
    .summary = "standard MPM: no slip, no separation at shared nodes",
    .at_start = stick,
    .at_end = stick,
    .start_reaches_particles = false,
    .needs_normal = false,
    .has_friction = false,
    .needs_stress = false,
    .remembers = false,
};

}  // namespace ogive
