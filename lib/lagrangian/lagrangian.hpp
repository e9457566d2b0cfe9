// Total Lagrangian bodies, Lee et al. 2005: nodes and shape functions of their own reference configuration, whose nodes
// carry position and velocity from step to step. A step is the central differences (3.14)-(3.21), with the two halves
// of the velocity's change around a time taken together:
//   V^(n+1/2) = V^(n-1/2) + (dt_n-1 + dt_n)/2 M^-1 (f_ext - f_int)^n      (3.14), (3.21)
//   impulses of contact; velocities prescribed at points, (3.19)
//   x^(n+1) = x^n + dt_n V^(n+1/2)                                        (3.20)
//   F, stress and f_int^(n+1)                                              (3.7)
// They have no share in the common grid but through contact (lagrangian/contact.hpp).
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

// Once after building or loading a state.
void prepare_lagrangian(const Model& model, State& state, Workspace& workspace, bool fresh);

// Bodies that were found too distorted go on updated Lagrangian: their particles carry all there is of them, but for
// the kinetic energy of the nodes that they do not see, which is booked.
void retire_distorted(const Model& model, State& state, Workspace& workspace);

// After a host has set particle velocities: gives them to the nodes.
void take_velocities(const Model& model, State& state, Workspace& workspace, int body);

// Trial velocities on the reference grid, (3.14).
void kick_lagrangian(const Model& model, State& state, Workspace& workspace, double dt);

// Velocities at the nodes where bodies meet: the trial ones after the first phase of contact, or those after the
// second.
void set_lagrangian_trial(Workspace& workspace);
void set_lagrangian_velocities(Workspace& workspace);

// After contact: its impulses, faces, and the velocities prescribed at points, (3.19).
void hold_lagrangian(const Model& model, State& state, Workspace& workspace, double dt);

// Moves the bodies, (3.20), and makes their stress and internal forces, (3.7).
void finish_lagrangian_step(const Model& model, State& state, Workspace& workspace, double dt);

}  // namespace ogive
