// Rigid bodies: no strain, no stress; six degrees of freedom or a prescribed motion.
//
// Their particles give nodes mass, normal and fill as those of any body, only where another body is near. The nodal
// velocity is that of the rigid motion at the node itself. Contact impulses J_i at nodes x_i then change the body's
// momentum by sum J_i and its angular momentum about the centre by sum (x_i - c) x J_i (contact/contact.cpp).
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

// The motion that is prescribed at a time.
MotionKnot motion_at(const Body& body, double time);

// Once, for a fresh state: particle velocities of prescribed bodies.
void prepare_rigid(const Model& model, State& state);

// Mass, centre and inertia of the bodies and their motion in the coming step.
void begin_rigid_step(const Model& model, const State& state, Workspace& workspace, double dt);

// Nodal velocities where contact is looked for: v, or the trial velocity f.
void set_rigid_velocities(const Model& model, Workspace& workspace, bool trial);

// The trial motion: gravity, which is booked.
void accelerate_rigid(const Model& model, State& state, Workspace& workspace, double dt);

// Moves the particles and books what guides and mirror faces gave.
void finish_rigid_step(const Model& model, State& state, Workspace& workspace, double dt);

}  // namespace ogive
