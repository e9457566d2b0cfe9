// Pan, Xu, Zhang, Zhu, Ma, Zhang 2008: where bodies approach, their normal velocities are made equal on the regular grid.
// While they are in contact their normal accelerations are equal, which gives the normal force: the trial velocities may not
// approach more than the adjusted ones do. Contact persists at a node while that force pushes, also where the mapped
// velocities no longer approach.
#include "contact/method.hpp"

namespace ogive {
namespace {

bool approaching(const PairView& pair) { return dot(pair.mapped, pair.normal) > 0; }

Constraint at_start(const PairView& pair) {
  if (!approaching(pair)) return {};
  return {Hold::Contact, 0, false};
}

Constraint at_end(const PairView& pair) {
  if (!approaching(pair) && !pair.pressed) return {};
  return {Hold::Contact, dot(pair.adjusted, pair.normal), true};
}

}  // namespace

extern const ContactMethodDef pan_2008_method = {
    .name = "pan_2008",
    .summary = "Pan et al. 2008: equal normal accelerations, while the force pushes",
    .at_start = at_start,
    .at_end = at_end,
    .start_reaches_particles = false,
    .needs_normal = true,
    .has_friction = true,
    .needs_stress = false,
    .remembers = true,
};

}  // namespace ogive
