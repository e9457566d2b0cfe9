// Bardenhagen, Guilkey, Roessig, Brackbill, Witzel, Foster 2001: as in 2000 where the bodies approach. Where they depart
// they are released only once the normal traction is no more compressive; until then they keep one normal velocity.
#include "contact/method.hpp"

namespace ogive {
namespace {

Constraint at_end(const PairView& pair) {
  if (dot(pair.now, pair.own_normal[0]) > 0 && dot(pair.now, pair.own_normal[1]) < 0) return {Hold::Contact, 0, true};
  if (pair.normal_stress < 0) return {Hold::Slide, 0, true};
  return {};
}

}  // namespace

extern const ContactMethodDef bardenhagen_2001_method = {
    .name = "bardenhagen_2001",
    .summary = "Bardenhagen et al. 2001: released where the normal traction is no more compressive",
    .at_start = nullptr,
    .at_end = at_end,
    .start_reaches_particles = false,
    .needs_normal = true,
    .has_friction = true,
    .needs_stress = true,
    .remembers = false,
};

}  // namespace ogive
