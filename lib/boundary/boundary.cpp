// Mirror faces and clamps.
#include "boundary/boundary.hpp"

namespace ogive {
namespace {

// Sign with which component c of a vector appears in the mirror.
double mirror_sign(const FaceNodes& face, int c) { return face.fixed || c == face.axis ? -1.0 : 1.0; }

}  // namespace

void fold_momentum(Workspace& workspace) {
  for (FaceNodes& face : workspace.faces) {
    for (MirrorPair& pair : face.pairs) {
      NodeRecord &ghost = workspace.nodes[pair.ghost], &image = workspace.nodes[pair.image];
      pair.ghost_mass = ghost.v[3];
      for (int c = 0; c < 3; ++c) image.v[c] += mirror_sign(face, c) * ghost.v[c];
      image.v[3] += ghost.v[3];
      for (double& c : ghost.v) c = 0;
    }
    for (const std::int64_t node : face.plane) {
      NodeRecord& record = workspace.nodes[node];
      for (int c = 0; c < 3; ++c)
        if (mirror_sign(face, c) < 0) record.v[c] = 0;
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

void unfold_velocity(Workspace& workspace) {
  for (auto face = workspace.faces.rbegin(); face != workspace.faces.rend(); ++face)
    for (const MirrorPair& pair : face->pairs)
      for (int c = 0; c < 3; ++c)
        workspace.nodes[pair.ghost].v[c] = mirror_sign(*face, c) * workspace.nodes[pair.image].v[c];
}

void fold_force(State& state, Workspace& workspace, double dt) {
  for (const FaceNodes& face : workspace.faces) {
    Vector3& impulse = state.ledger.boundary_impulse;
    for (const MirrorPair& pair : face.pairs) {
      NodeRecord &ghost = workspace.nodes[pair.ghost], &image = workspace.nodes[pair.image];
      for (int c = 0; c < 3; ++c) {
        const double sign = mirror_sign(face, c);
        // The ghost's share will be turned round: twice it comes from the face.
        if (sign < 0) impulse[c] -= 2.0 * ghost.f[c] * dt;
        image.f[c] += sign * ghost.f[c];
        ghost.f[c] = 0;
      }
    }
    for (const std::int64_t node : face.plane)
      for (int c = 0; c < 3; ++c)
        if (mirror_sign(face, c) < 0) {
          impulse[c] -= workspace.nodes[node].f[c] * dt;
          workspace.nodes[node].f[c] = 0;
        }
  }
}

void hold_faces(State& state, Workspace& workspace) {
  for (const FaceNodes& face : workspace.faces)
    for (const std::int64_t node : face.plane) {
      NodeRecord& record = workspace.nodes[node];
      for (int c = 0; c < 3; ++c)
        if (mirror_sign(face, c) < 0) {
          state.ledger.boundary_impulse[c] -= record.v[3] * record.f[c];
          record.f[c] = 0;
        }
    }
}

void unfold_motion(State& state, Workspace& workspace) {
  for (auto face = workspace.faces.rbegin(); face != workspace.faces.rend(); ++face)
    for (const MirrorPair& pair : face->pairs) {
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

void apply_clamps(State& state, Workspace& workspace) {
  for (const ClampNode& clamp : workspace.clamps) {
    NodeRecord& record = workspace.nodes[clamp.node];
    for (int c = 0; c < 3; ++c)
      if (clamp.axes >> c & 1) {
        state.ledger.boundary_impulse[c] -= record.v[3] * record.f[c];
        state.ledger.boundary_work -= 0.5 * record.v[3] * record.f[c] * record.f[c];
        record.f[c] = 0;
      }
  }
}

}  // namespace ogive
