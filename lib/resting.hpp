// Groups of particles at rest: what nothing has reached yet is left out of a step, with the results of a step of everything.
//
// A group is at rest while its particles are undeformed, unloaded and unmoved: velocity, affine velocity, stress, viscous
// pressure and energy are +0, the volume ratio is 1, the deformation gradient 1, nothing has flowed. Such a particle adds
// nothing but mass to the grid, and where the grid does not move either, its law leaves it as it is, which is tried once for each
// body on the kernel itself. What it adds to the sums of a step is nothing, but for its wave speed, which is that of the trial.
//
// How far from what moves everything must be computed: let A be the groups that are not at rest, N(G) the nodes of the tiles of
// the groups G, and R(G) the groups, of all bodies, whose tiles share a node with N(G), a ring around G. Contact joins the bodies'
// fields at one node, mirror faces join nodes of one tile: neither reaches beyond N.
//   Stress first: the nodes N(A) move, so that R(A) are strained; they push the nodes N(R(A)), which move R(R(A)).    2 rings
//   Stress last: A pushes N(A), which moves R(A); mapped once more, they move N(R(A)), which strains R(R(A)).          2 rings
//   Stress last as is: A pushes N(A), which moves and strains R(A).                                                    1 ring
//   XPIC(k): each of k - 1 passes takes velocities one ring farther, and the last of them move the next ring: k rings come to
//   move, where the others have 2 (stress first) or 1; with the stress last one more is strained.
// All groups that reach a node which moves in the step are then among those computed, so that its mass is whole.
//
// Motion that is at every particle of a group at rest less than 2^-100 of the fastest that there has been is no motion: such a
// group is put back to rest after the step, as numbers below 1e-308 are taken as 0. Without this every step would carry ever
// smaller numbers several cells ahead of the waves (docs/theory.md, section 9a). Once a group moves it is computed for good.
//
// Whether groups at rest are left out (numerics.skip_resting) changes no bit of any result.
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

// Rings of groups around those that move that a step computes.
int rings_around_motion(const Numerics& numerics);

// Why no group of the model can be at rest, null where some can.
const char* why_nothing_rests(const Model& model, const Workspace& workspace);

// Tries the laws, and looks at the particles of the groups that may be at rest: all of them, or those that the state says.
// After link_grid.
void prepare_resting(const Model& model, State& state, Workspace& workspace, bool all);

// Looks at one body anew after a host has set some of its values.
void find_resting(const Model& model, State& state, Workspace& workspace, int body);

// At the beginning of a step, on a linked grid: which groups and slots it leaves out.
void choose_groups(const Model& model, const State& state, Workspace& workspace);

// At its end: which groups are at rest no more.
void keep_resting(const Model& model, State& state, Workspace& workspace);

}  // namespace ogive
