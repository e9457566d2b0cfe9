// Bardenhagen, Brackbill, Sulsky 2000: a body is in contact where it moves towards the others by its own normal,
// (v_b - v_cm) . n_b > 0; then the normal velocity becomes the common one, with Coulomb friction.
// For a pair v_a - v_cm and v_b - v_cm are along v_a - v_b and against it. The own normals need not be collinear, and an
// impulse on one body alone would make momentum: a pair acts where both bodies find that they approach, along the pair's
// shared normal.
#include "contact/method.hpp"

namespace ogive {
namespace {

Constraint at_end(const PairView& pair) {
  if (!(dot(pair.now, pair.own_normal[0]) > 0 && dot(pair.now, pair.own_normal[1]) < 0)) return {};
  return {Hold::Contact, 0, true};
}

}  // namespace

extern const ContactMethodDef bardenhagen_2000_method = {
    .name = "bardenhagen_2000",
    .summary = "Bardenhagen et al. 2000: both bodies approach by their own normals",
    .at_start = nullptr,
    .at_end = at_end,
    .start_reaches_particles = false,
    .needs_normal = true,
    .has_friction = true,
    .needs_stress = false,
    .remembers = false,
};

}  // namespace ogive
