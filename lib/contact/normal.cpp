// Normals from sums at the node.
#include "contact/normal.hpp"

namespace ogive {
namespace {

Vector3 master(const NormalView& view) {
  return view.b_is_master ? times(-1, view.b.outward) : view.a.outward;
}

// Eq. (10). Where the unit normals cancel, their round-off would say the direction: there is none then.
Vector3 average(const NormalView& view) {
  const Vector3 difference = minus(view.a.outward, view.b.outward);
  return dot(difference, difference) > 1e-16 ? difference : Vector3{};
}

// The difference of the volume gradients themselves: the body that fills more of the node weighs more. Volumes at rest, so
// that the bodies' densities do not matter and material that has opened up does not count for more.
Vector3 volume_gradient(const NormalView& view) { return minus(view.a.gradient, view.b.gradient); }

// Pan et al. 2008: from the centres of the cells around the node that hold particles of the bodies.
Vector3 occupied_cell(const NormalView& view) { return minus(view.a.occupied, view.b.occupied); }

const NormalRuleDef rules[] = {
    {"master", master, false, false},
    {"average", average, false, false},
    {"volume_gradient", volume_gradient, false, false},
    {"occupied_cell", occupied_cell, true, false},
    {"logistic_regression", logistic_normal, false, true},
};

}  // namespace

int normal_rule_count() { return static_cast<int>(sizeof rules / sizeof rules[0]); }

const NormalRuleDef& normal_rule(NormalRule rule) { return rules[static_cast<int>(rule)]; }

bool pair_normal(NormalRule rule, const NormalView& view, Vector3& normal) {
  normal = normal_rule(rule).direction(view);
  if (make_unit(normal)) return true;
  normal = volume_gradient(view);
  return make_unit(normal);
}

}  // namespace ogive
