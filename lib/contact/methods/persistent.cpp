// Contact that persists: impenetrability on the regular and the deformed grid, as Huang et al. 2010, section 3.2, with the
// persistence of Pan et al. 2008 in the strain too, and the literal (34). Where bodies approach, or pressed on each other in the
// last step, the strain sees one normal velocity; the forces on the deformed grid then push them apart or let them go.
//
// It keeps energy (docs/theory.md 6.4). Particles keep a relative velocity s at the node that the grid takes. Its power with the
// internal force, which the strain does not see, is just what the contact force takes, if the strain sees neither sign of s. A
// method that takes approach alone gains |s| F where noise departs: the contact force pushes it on its way.
#include "contact/method.hpp"

namespace ogive {
namespace {

Constraint at_start(const PairView& pair) {
  if (pair.pressed) return {Hold::Slide, 0, false};
  return {Hold::Contact, 0, false};
}

Constraint at_end(const PairView&) { return {Hold::Contact, 0, true}; }

}  // namespace

extern const ContactMethodDef persistent_method = {
    .name = "persistent",
    .summary = "contact on the regular and the deformed grid that persists while it pushes; keeps energy",
    .at_start = at_start,
    .at_end = at_end,
    .start_reaches_particles = false,
    .needs_normal = true,
    .has_friction = true,
    .needs_stress = false,
    .remembers = true,
};

}  // namespace ogive
