// Symmetry and fixed faces as mirrors.
//
// At a symmetry face the material beyond is the mirror image of what is modelled, moving as the image moves. What the
// particles give to a node beyond the face (a ghost) is therefore what the image would give to the mirrored node inside:
// it is folded there, normal components reversed, and the ghost moves as that node's mirror image. Nodes on the face have
// no normal velocity, normal force or normal gradient. A half model is then the full model to round-off, for every shape
// function. A fixed face is the same with all components reversed: velocity zero on the face.
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"

namespace ogive {

// Sign with which component c of a vector appears in the mirror.
inline double mirror_sign(const FaceNodes& face, int c) { return face.fixed || c == face.axis ? -1.0 : 1.0; }

// Takes what lies beyond a mirror or fixed face to its image; the signs of a vector's components there.
Vector3 into_model(const Grid& grid, Vector3& x);

// After mapping, node records hold {momentum, mass | -} and contact records their sums: folds ghosts into images.
void fold_momentum(Workspace& workspace);
void fold_contact_sums(Workspace& workspace);
void fold_contact_stress(Workspace& workspace);
void fold_occupied(Workspace& workspace);
// Gives ghosts the velocity of their images (records hold velocities).
void unfold_velocity(Workspace& workspace);
// The same for the momentum (f) and velocity (v) of the XPIC filter.
void fold_filter(Workspace& workspace);
void unfold_filter(Workspace& workspace);
// After the stress update: folds forces, and books the normal impulse of the faces before contact.
void fold_force(State& state, Workspace& workspace, double dt);
// Trial velocities on the faces have no held components (gravity would give them some).
void hold_faces(State& state, Workspace& workspace);
// After the final velocities (records {velocity at the beginning, mass | final velocity}): ghosts move as mirror images.
void unfold_motion(State& state, Workspace& workspace);
// Where particles take the grid's own velocity, or a part of it (APIC, PIC, XPIC), they take the mirrors' share in it too: what
// nodes in the plane lost and ghosts turned round when momentum was folded. Books it. After unfold_motion.
void book_grid_velocity(const Model& model, State& state, const Workspace& workspace);
// Folds sums of vectors that turn as velocities do: sum_of(node) points to that of a node, nullptr where there is none.
template <class Find>
void fold_vectors(const Workspace& workspace, Find&& sum_of) {
  for (const FaceNodes& face : workspace.faces)
    for (std::size_t i = 0; i < face.moving_pairs; ++i) {
      Vector3 *ghost = sum_of(face.pairs[i].ghost), *image = sum_of(face.pairs[i].image);
      if (!ghost || !image) continue;
      for (int c = 0; c < 3; ++c) (*image)[c] += mirror_sign(face, c) * (*ghost)[c];
      *ghost = {};
    }
}

}  // namespace ogive
