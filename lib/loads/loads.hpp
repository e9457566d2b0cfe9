// What the host applies: accelerations, tractions and forces on particles, and velocities of nodes.
//
// A particle p of mass m_p feels
//   f_p = m_p (sum of the accelerations of its loads + sum of traction area / M of its tractions) + host force
// M being the mass that the traction acted on when the world was prepared: the whole force traction x area is shared by mass.
// Nodes get f_I = sum_p N_I(x_p) f_p, as they get the internal force, so that momentum is exact. The work in a step is
//   dt sum_p f_p . V(x_p),  V_I = (v_I + v_I') / 2,
// v_I and v_I' being the nodal velocities at its beginning and end: the part of the external forces in the change of the
// grid's kinetic energy. Prescribed velocities hold nodes: boundary/held_nodes.hpp.
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "rigid/rigid_motion.hpp"
#include "state.hpp"

namespace ogive {

// Marks the particles that each load acts on and sums their mass; once, when the model is complete.
void select_loaded_particles(const Model& model, State& state);

// Place in Workspace::load_sums of each link; after the grid was linked.
void allocate_load_sums(const Model& model, const State& state, Workspace& workspace);

// Adds f_I to the forces of the nodes of a group. Runs beside others that touch no common node.
void map_loads(const Model& model, const State& state, Workspace& workspace, std::int32_t link);

// The same for a rigid body that is free: the loads' sum and their moment about the centre push it as a whole, with the
// work of the mean of its motion before and after. A body of prescribed motion does not feel them, and nothing is booked.
void load_rigid(const Model& model, State& state, RigidMotion& motion, double dt);

// Work and impulse of the loads on the particles of a group; node records hold {velocity at the end, 0 | acceleration, 0}.
void measure_loads(const Model& model, const State& state, Workspace& workspace, std::int32_t link, double dt);

// Books what measure_loads found.
void book_loads(const Model& model, State& state, const Workspace& workspace, double dt);

// True if some load or force acts on particles of the body by way of the grid.
bool particles_loaded(const Model& model, const State& state, int body);

}  // namespace ogive
