// Contact between velocity fields at shared nodes and with rigid walls, for any number of bodies: finding where bodies
// meet, and the impulses there. What holds a pair is said by its method (contact/method.hpp).
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

ContactNeeds contact_needs(const Model& model);

// Nodes, pairs and normals of this step, from the mapped masses and contact sums. Once a step.
void find_contacts(const Model& model, const State& state, Workspace& workspace);

// The first phase, on the regular grid: node records hold {mapped velocity, mass | -}, and the velocity is changed.
void start_contact(const Model& model, State& state, Workspace& workspace, double dt, StartUse use);

// Puts back, once the trial velocities stand, what the particles' increments (34) are to contain.
void return_start(Workspace& workspace);

// The second phase, on the deformed grid: impulses that correct the trial velocities, Eqs. (12)-(22) and (14).
// Node records hold {velocity at the beginning of the step, mass | trial velocity}; the trial velocity is replaced.
void end_contact(const Model& model, State& state, Workspace& workspace, double dt);

// The sums of a pair a < b, which are begun where there are none.
PairTotals& pair_totals(State& state, std::int32_t a, std::int32_t b);

// For the ledger, before node records become {velocity, 0 | acceleration, 0}: the grid's increments act on the particles'
// own velocities, which are the mapped ones, not those that the first phase left.
void book_kept_start(State& state, const Workspace& workspace);

// What prescribed points then changed of the velocities of total Lagrangian bodies (LagrangianContact::end_change) changes the
// work of the second phase's impulses, which is booked exactly there.
void book_held_contact(State& state, Workspace& workspace);

// Distance of a flat surface from a node, in cells and positive outside the body, at which the body fills `fraction` of
// the node's shape function (docs/theory.md, section on the gap).
double surface_distance(ShapeFunction shape, double fraction);

// The solver, for one node that is not coupled to others: changes `velocity` of the fields by the constraints of the pairs.
void solve_node(BlockContacts& contacts, ContactNode& node, const std::vector<RigidMotion>& rigid);

}  // namespace ogive
