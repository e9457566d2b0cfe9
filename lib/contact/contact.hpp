// Contact between velocity fields at shared nodes: Huang et al. 2010, sections 2 and 3, for any number of bodies.
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

// Eqs. (23)-(25): takes the approach of bodies in contact out of the nodal velocities (second method only).
// Node records hold {velocity, mass | -}.
void remove_approach(const Model& model, State& state, Workspace& workspace);

// Puts it back once the trial velocities stand, so that the particles' increments (34) contain the jump of (25).
void restore_approach(Workspace& workspace);

// Eqs. (12)-(22) and (14): normal and friction impulses that correct the trial velocities.
// Node records hold {velocity at the beginning of the step, mass | trial velocity}; the trial velocity is replaced.
void apply_contact_force(const Model& model, State& state, Workspace& workspace, double dt);

// Distance of a flat surface from a node, in cells and positive outside the body, at which the body fills `fraction` of
// the node's shape function (docs/theory.md, section on the gap).
double surface_distance(ShapeFunction shape, double fraction);

}  // namespace ogive
