// Hu, Chen 2003: at the nodes where bodies meet, the normal velocity is that of the common field and the tangential one
// that of each body's own. There is no friction, and bodies part only where they no longer share nodes (or, with the gap
// rule, where the gap opens).
#include "contact/method.hpp"

namespace ogive {
namespace {

Constraint slide(const PairView&) { return {Hold::Slide, 0, false}; }

}  // namespace

extern const ContactMethodDef hu_chen_method = {
    .name = "hu_chen",
    .summary = "Hu and Chen 2003: common normal velocity, own tangential velocities",
    .at_start = slide,
    .at_end = slide,
    .start_reaches_particles = false,
    .needs_normal = true,
    .has_friction = false,
    .needs_stress = false,
    .remembers = false,
};

}  // namespace ogive
