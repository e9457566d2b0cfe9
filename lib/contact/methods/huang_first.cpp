// Huang et al. 2010, section 3.1: impenetrability (15) and Coulomb friction (22) on the deformed grid.
#include "contact/method.hpp"

namespace ogive {
namespace {

Constraint at_end(const PairView&) { return {Hold::Contact, 0, true}; }

}  // namespace

extern const ContactMethodDef huang_first_method = {
    .name = "huang_first",
    .summary = "Huang et al. 2010, on the deformed grid",
    .at_start = nullptr,
    .at_end = at_end,
    .start_reaches_particles = false,
    .needs_normal = true,
    .has_friction = true,
    .needs_stress = false,
    .remembers = false,
};

}  // namespace ogive
