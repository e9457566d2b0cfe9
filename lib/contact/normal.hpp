// Rules for the one normal that a pair of bodies shares at a node (n1 = -n2, or momentum would be lost). To add one: a
// function, a line in the table of normal.cpp, and a constant in ogive.h.
#pragma once

#include "contact/nodes.hpp"
#include "contact/nearby_particles.hpp"

namespace ogive {

struct NormalView {
  const ContactField& a;
  const ContactField& b;
  bool b_is_master;            // of the two, where a rule has a master
  const NearbyParticles* cloud;  // around the node; only where the rule needs it
  Vector3 place;               // of the node in the cloud's coordinates
};

struct NormalRuleDef {
  const char* name;
  // Direction of the normal out of a, of any length; zero where the rule finds none.
  Vector3 (*direction)(const NormalView&);
  bool needs_occupied, needs_cloud;
};

int normal_rule_count();
const NormalRuleDef& normal_rule(NormalRule rule);

// Unit normal out of a. Where the rule finds none (inside its body, or where two normals cancel) the difference of the
// volume gradients serves. False: there is no normal at all.
bool pair_normal(NormalRule rule, const NormalView& view, Vector3& normal);

// Nairn, Hammerquist, Smith 2020: see logistic_normal.cpp.
Vector3 logistic_normal(const NormalView& view);

}  // namespace ogive
