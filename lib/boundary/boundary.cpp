// Mirror faces.
#include "boundary/boundary.hpp"

#include "contact/occupied.hpp"

namespace ogive {

Vector3 into_model(const Grid& grid, Vector3& x) {
  Vector3 sign = {1, 1, 1};
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const double plane = side == 0 ? grid.domain_min[axis] : grid.domain_max[axis];
      const bool beyond = side == 0 ? x[axis] < plane : x[axis] > plane;
      const Face face = grid.face[2 * axis + side];
      if (!beyond || face == Face::Free) continue;
      x[axis] = 2 * plane - x[axis];
      for (int c = 0; c < 3; ++c)
        if (face == Face::Fixed || c == axis) sign[c] *= -1;
    }
  return sign;
}

void fold_momentum(Workspace& workspace) {
  for (FaceNodes& face : workspace.faces) {
    for (MirrorPair& pair : face.pairs) {
      NodeRecord &ghost = workspace.nodes[pair.ghost], &image = workspace.nodes[pair.image];
      pair.ghost_mass = ghost.v[3];
      pair.ghost_momentum = {ghost.v[0], ghost.v[1], ghost.v[2]};
      for (int c = 0; c < 3; ++c) image.v[c] += mirror_sign(face, c) * ghost.v[c];
      image.v[3] += ghost.v[3];
      for (double& c : ghost.v) c = 0;
    }
    face.plane_momentum = {};
    for (std::size_t i = 0; i < face.plane.size(); ++i) {
      NodeRecord& record = workspace.nodes[face.plane[i]];
      for (int c = 0; c < 3; ++c)
        if (mirror_sign(face, c) < 0) {
          if (i < face.moving_plane) face.plane_momentum[c] += record.v[c];
          record.v[c] = 0;
        }
    }
  }
}

void fold_contact_sums(Workspace& workspace) {
  if (workspace.contacts.empty()) return;
  for (const FaceNodes& face : workspace.faces) {
    for (const MirrorPair& pair : face.pairs) {
      const std::int32_t from = workspace.slots[pair.ghost / block_nodes].contact;
      const std::int32_t to = workspace.slots[pair.image / block_nodes].contact;
      if (from < 0 || to < 0) continue;
      ContactRecord& source = workspace.contacts[from * block_nodes + pair.ghost % block_nodes];
      ContactRecord& target = workspace.contacts[to * block_nodes + pair.image % block_nodes];
      for (int c = 0; c < 3; ++c) target.gradient[c] += (c == face.axis ? -1.0 : 1.0) * source.gradient[c];
      target.volume += source.volume;
      source = {};
    }
    for (const std::int64_t node : face.plane) {
      const std::int32_t contact = workspace.slots[node / block_nodes].contact;
      if (contact < 0) continue;
      // The mirrored half doubles what lies along the face and cancels what is normal to it.
      ContactRecord& sums = workspace.contacts[contact * block_nodes + node % block_nodes];
      for (int c = 0; c < 3; ++c) sums.gradient[c] *= c == face.axis ? 0.0 : 2.0;
      sums.volume *= 2;
    }
  }
}

void fold_contact_stress(Workspace& workspace) {
  const auto record = [&](std::int64_t node) -> ContactStress* {
    const std::int32_t contact = workspace.slots[node / block_nodes].contact;
    return contact < 0 ? nullptr : &workspace.contact_stress[contact * block_nodes + node % block_nodes];
  };
  for (const FaceNodes& face : workspace.faces) {
    // Shear component c is that of the two axes other than c: it changes its sign unless c is the face's own axis.
    for (std::size_t i = 0; i < face.moving_pairs; ++i) {
      ContactStress *source = record(face.pairs[i].ghost), *target = record(face.pairs[i].image);
      if (!source || !target) continue;
      for (int c = 0; c < 3; ++c) {
        target->direct[c] += source->direct[c];
        target->shear[c] += (c == face.axis ? 1.0 : -1.0) * source->shear[c];
      }
      target->volume += source->volume;
      *source = {};
    }
    for (std::size_t i = 0; i < face.moving_plane; ++i) {
      ContactStress* sums = record(face.plane[i]);
      if (!sums) continue;
      for (int c = 0; c < 3; ++c) {
        sums->direct[c] *= 2;
        sums->shear[c] *= c == face.axis ? 2.0 : 0.0;
      }
      sums->volume *= 2;
    }
  }
}

void fold_occupied(Workspace& workspace) {
  const auto mask = [&](std::int64_t node) -> std::uint8_t* {
    const std::int32_t contact = workspace.slots[node / block_nodes].contact;
    return contact < 0 ? nullptr : &workspace.occupied[contact * block_nodes + node % block_nodes];
  };
  for (const FaceNodes& face : workspace.faces) {
    for (const MirrorPair& pair : face.pairs) {
      std::uint8_t *source = mask(pair.ghost), *target = mask(pair.image);
      if (!source || !target) continue;
      *target = static_cast<std::uint8_t>(*target | mirrored_cells(*source, face.axis));
      *source = 0;
    }
    for (const std::int64_t node : face.plane)
      if (std::uint8_t* cells = mask(node))
        *cells = static_cast<std::uint8_t>(*cells | mirrored_cells(*cells, face.axis));
  }
}

void unfold_velocity(Workspace& workspace) {
  for (auto face = workspace.faces.rbegin(); face != workspace.faces.rend(); ++face)
    for (std::size_t i = 0; i < face->moving_pairs; ++i) {
      const MirrorPair& pair = face->pairs[i];
      for (int c = 0; c < 3; ++c)
        workspace.nodes[pair.ghost].v[c] = mirror_sign(*face, c) * workspace.nodes[pair.image].v[c];
    }
}

void fold_filter(Workspace& workspace) {
  for (const FaceNodes& face : workspace.faces) {
    for (std::size_t i = 0; i < face.moving_pairs; ++i) {
      NodeRecord &ghost = workspace.filter[face.pairs[i].ghost], &image = workspace.filter[face.pairs[i].image];
      for (int c = 0; c < 3; ++c) {
        image.f[c] += mirror_sign(face, c) * ghost.f[c];
        ghost.f[c] = 0;
      }
    }
    for (std::size_t i = 0; i < face.moving_plane; ++i)
      for (int c = 0; c < 3; ++c)
        if (mirror_sign(face, c) < 0) workspace.filter[face.plane[i]].f[c] = 0;
  }
}

void unfold_filter(Workspace& workspace) {
  for (auto face = workspace.faces.rbegin(); face != workspace.faces.rend(); ++face)
    for (std::size_t i = 0; i < face->moving_pairs; ++i) {
      const MirrorPair& pair = face->pairs[i];
      for (int c = 0; c < 3; ++c)
        workspace.filter[pair.ghost].v[c] = mirror_sign(*face, c) * workspace.filter[pair.image].v[c];
    }
}

void fold_force(State& state, Workspace& workspace, double dt) {
  for (const FaceNodes& face : workspace.faces) {
    Vector3& impulse = state.ledger.boundary_impulse;
    for (std::size_t i = 0; i < face.moving_pairs; ++i) {
      const MirrorPair& pair = face.pairs[i];
      NodeRecord &ghost = workspace.nodes[pair.ghost], &image = workspace.nodes[pair.image];
      for (int c = 0; c < 3; ++c) {
        const double sign = mirror_sign(face, c);
        // The ghost's share will be turned round: twice it comes from the face.
        if (sign < 0) impulse[c] -= 2.0 * ghost.f[c] * dt;
        image.f[c] += sign * ghost.f[c];
        ghost.f[c] = 0;
      }
    }
    for (std::size_t i = 0; i < face.moving_plane; ++i) {
      NodeRecord& record = workspace.nodes[face.plane[i]];
      for (int c = 0; c < 3; ++c)
        if (mirror_sign(face, c) < 0) {
          impulse[c] -= record.f[c] * dt;
          record.f[c] = 0;
        }
    }
  }
}

void hold_faces(State& state, Workspace& workspace) {
  for (const FaceNodes& face : workspace.faces)
    for (std::size_t i = 0; i < face.moving_plane; ++i) {
      NodeRecord& record = workspace.nodes[face.plane[i]];
      for (int c = 0; c < 3; ++c)
        if (mirror_sign(face, c) < 0) {
          state.ledger.boundary_impulse[c] -= record.v[3] * record.f[c];
          record.f[c] = 0;
        }
    }
}

void unfold_motion(State& state, Workspace& workspace) {
  for (auto face = workspace.faces.rbegin(); face != workspace.faces.rend(); ++face)
    for (std::size_t i = 0; i < face->moving_pairs; ++i) {
      const MirrorPair& pair = face->pairs[i];
      NodeRecord &ghost = workspace.nodes[pair.ghost], &image = workspace.nodes[pair.image];
      for (int c = 0; c < 3; ++c) {
        const double sign = mirror_sign(*face, c);
        // Particles take the ghost's share of the image's momentum change with the sign reversed.
        if (sign < 0) state.ledger.boundary_impulse[c] -= 2.0 * pair.ghost_mass * (image.f[c] - image.v[c]);
        ghost.v[c] = sign * image.v[c];
        ghost.f[c] = sign * image.f[c];
      }
    }
}

void book_grid_velocity(const Model& model, State& state, const Workspace& workspace) {
  const bool xpic = model.numerics.transfer == Transfer::Xpic;
  const double part = model.numerics.renewed_fraction();
  if (part == 0) return;
  Vector3& impulse = state.ledger.boundary_impulse;
  const AlignedVector<NodeRecord>& velocity = xpic ? workspace.filter : workspace.nodes;
  for (const FaceNodes& face : workspace.faces)
    for (int c = 0; c < 3; ++c) {
      if (mirror_sign(face, c) > 0) continue;
      impulse[c] -= part * face.plane_momentum[c];
      for (std::size_t i = 0; i < face.moving_pairs; ++i) {
        const MirrorPair& pair = face.pairs[i];
        impulse[c] -= part * 2.0 * (pair.ghost_momentum[c] + pair.ghost_mass * velocity[pair.image].v[c]);
      }
    }
  if (xpic) add(impulse, workspace.filter_momentum);
}

}  // namespace ogive
