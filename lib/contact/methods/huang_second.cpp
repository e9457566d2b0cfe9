// Huang et al. 2010, section 3.2: impenetrability on the regular grid too, (23)-(25), so that the strains see velocities
// that do not interpenetrate; then as the first method.
#include "contact/method.hpp"

namespace ogive {
namespace {

Constraint at_start(const PairView&) { return {Hold::Contact, 0, false}; }
Constraint at_end(const PairView&) { return {Hold::Contact, 0, true}; }

}  // namespace

extern const ContactMethodDef huang_second_method = {
    .name = "huang_second",
    .summary = "Huang et al. 2010, on the regular and the deformed grid",
    .at_start = at_start,
    .at_end = at_end,
    .start_reaches_particles = true,
    .needs_normal = true,
    .has_friction = true,
    .needs_stress = false,
    .remembers = false,
};

}  // namespace ogive
