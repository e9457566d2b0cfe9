// A contact method says what holds a pair of bodies at a node, in two phases of the step; the solver of contact.cpp finds
// the impulses. To add one: a file in methods/ that defines its ContactMethodDef, and a line in OGIVE_CONTACT_METHODS (and,
// for hosts in C, an OGIVE_CONTACT_* constant in ogive.h).
#pragma once

#include "contact/nodes.hpp"

namespace ogive {

// What a method is shown of the pair (a, b).
struct PairView {
  Vector3 normal;             // unit, out of a
  Vector3 own_normal[2];      // out of a and out of b, each from its own gradient; zero where there is none
  Vector3 mapped, adjusted;   // v_a - v_b before and after the first phase (where the method has one)
  Vector3 now;                // v_a - v_b as this phase finds it
  bool pressed;               // the pair's impulse at this node pushed when it was last found; only where `remembers`
  double normal_stress;       // n . sigma . n of both bodies together, tension positive; only where `needs_stress`
};

struct ContactMethodDef {
  const char* name;     // in scenes and plans
  const char* summary;  // in plans
  // On the regular grid, at the beginning of the step, and on the deformed grid, for the trial velocities. Null: nothing.
  Constraint (*at_start)(const PairView&);
  Constraint (*at_end)(const PairView&);
  // Whether the velocity that at_start takes is part of the particles' increment (34); otherwise they keep it, as in the
  // standard method, and only strain and acceleration see it taken.
  bool start_reaches_particles;
  bool needs_normal;   // false: the pair is held at every shared node
  bool has_friction;   // the pair's coefficient is used
  bool needs_stress;
  bool remembers;
};

// One line a method, in the order of ContactMethod.
#define OGIVE_CONTACT_METHODS(METHOD) \
  METHOD(single_field)                \
  METHOD(huang_first)                 \
  METHOD(huang_second)                \
  METHOD(york)                        \
  METHOD(hu_chen)                     \
  METHOD(bardenhagen_2000)            \
  METHOD(bardenhagen_2001)            \
  METHOD(pan_2008)                    \
  METHOD(persistent)

int contact_method_count();
const ContactMethodDef& contact_method(ContactMethod method);

}  // namespace ogive
