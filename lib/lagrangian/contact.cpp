#include "lagrangian/contact.hpp"

#include "grid.hpp"
#include "lagrangian/reference_grid.hpp"

namespace ogive {

void LagrangianContact::find(const Model& model, const State& state, Workspace& workspace) {
  fields.clear();
  particles.clear();
  field_weights.clear();
  node_weights.clear();
  for (const std::int64_t node : touched) {
    total[node] = kept[node] = {};
    push[node] = {};
  }
  touched.clear();
  for (const std::int64_t node : touched_by_points) kept[node] = {};
  touched_by_points.clear();
  mirror_impulse = {};
  if (!workspace.reference_grid) return;
  const Workspace& reference = *workspace.reference_grid;
  if (push.size() != reference.nodes.size()) {
    push.assign(reference.nodes.size(), {});
    total.assign(reference.nodes.size(), {});
    kept.assign(reference.nodes.size(), {});
  }
  at.assign(workspace.contacts.size(), -1);
  mirrored.assign(workspace.contacts.size(), 0);
  held.assign(workspace.contacts.size(), 0);

  const auto record = [&](std::int64_t node) -> std::int64_t {
    const std::int32_t contact = workspace.slots[node / block_nodes].contact;
    return contact < 0 ? -1 : std::int64_t{contact} * block_nodes + node % block_nodes;
  };
  const auto signs = [](const FaceNodes& face) { return face.fixed ? 7 : 1 << face.axis; };
  for (const FaceNodes& face : workspace.faces)
    for (const std::int64_t node : face.plane)
      if (const std::int64_t r = record(node); r >= 0) held[r] |= signs(face);
  for (std::size_t b = 0; b < workspace.mixed.size(); ++b)
    for (ContactNode& node : workspace.block_contacts[b].nodes)
      for (int f = node.first_field; f < node.first_field + node.fields; ++f) {
        ContactField& field = workspace.block_contacts[b].fields[f];
        if (field.slot < 0 || !workspace.slots[field.slot].lagrangian) continue;
        const std::int64_t r = record(std::int64_t{field.slot} * block_nodes + node.node);
        Field mine;
        mine.block = static_cast<std::int32_t>(b);
        mine.node = node.node;
        mine.field = f;
        mine.mass = field.mass;
        mine.held = held[r];
        at[r] = static_cast<std::int32_t>(fields.size());
        fields.push_back(mine);
      }
  if (fields.empty()) return;
  // A node beyond a mirror counts as its image, which may itself lie beyond another: faces in the reverse of their
  // order.
  for (auto face = workspace.faces.rbegin(); face != workspace.faces.rend(); ++face)
    for (const MirrorPair& pair : face->pairs) {
      const std::int64_t ghost = record(pair.ghost), image = record(pair.image);
      if (ghost < 0 || image < 0 || at[image] < 0) continue;
      at[ghost] = at[image];
      mirrored[ghost] = mirrored[image] ^ signs(*face);
    }

  for (const GroupLinks& link : workspace.links) {
    if (!link.contact || !state.bodies[link.body].lagrangian) continue;
    const BodyState& copy = state.copies[link.body];
    const Group& group = copy.groups[link.group];
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
      const std::size_t before = field_weights.size();
      for_nodes_of(model, link, &copy.position[4 * p], [&](std::int64_t node, double weight, const Vector3&) {
        const std::int64_t r = record(node);
        if (r >= 0 && at[r] >= 0)
          field_weights.push_back({at[r], weight * copy.position[4 * p + 3] / fields[at[r]].mass, mirrored[r]});
      });
      if (field_weights.size() == before) continue;
      for_reference_nodes(model, state, reference, link.body, copy.number[p], [&](const NodeWeight& at_node) {
        node_weights.push_back(at_node);
        double& mark = push[at_node.node].c[3];
        if (mark == 0) touched.push_back(at_node.node);
        mark = 1;
      });
      particles.push_back(
          {static_cast<std::int32_t>(field_weights.size()), static_cast<std::int32_t>(node_weights.size())});
    }
  }
  for (const std::int64_t node : touched) push[node] = {};
}

void LagrangianContact::gather() {
  at_field.assign(fields.size(), {});
  std::int32_t f = 0, n = 0;
  for (const Particle& particle : particles) {
    Record v;
    for (; n < particle.nodes_end; ++n) {
      const NodeWeight& at_node = node_weights[n];
      const Record& node = push[at_node.node];
      v.add(at_node.weight, at_node.mirrored ? node.mirrored(at_node.mirrored) : node);
    }
    for (; f < particle.fields_end; ++f) {
      const NodeWeight& to = field_weights[f];
      at_field[to.node].add(to.weight, to.mirrored ? v.mirrored(to.mirrored) : v);
    }
  }
  for (std::size_t i = 0; i < fields.size(); ++i)
    for (int c = 0; c < 3; ++c) fields[i].change[c] = fields[i].held >> c & 1 ? 0 : at_field[i].c[c];
  for (const std::int64_t node : touched) push[node] = {};
}

void LagrangianContact::apply(const Workspace& workspace, std::vector<Vector3>* sum) {
  at_field.resize(fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i)
    at_field[i] = {{fields[i].impulse[0], fields[i].impulse[1], fields[i].impulse[2], 0}};
  std::int32_t f = 0, n = 0;
  Record from_mirrors;
  const auto turned = [&](const Record& impulse, const NodeWeight& at_node) {
    const Record image = impulse.mirrored(at_node.mirrored);
    from_mirrors.add(at_node.weight, image);
    from_mirrors.add(-at_node.weight, impulse);
    return image;
  };
  for (const Particle& particle : particles) {
    Record impulse;
    for (; f < particle.fields_end; ++f) {
      const NodeWeight& from = field_weights[f];
      impulse.add(from.weight, from.mirrored ? turned(at_field[from.node], from) : at_field[from.node]);
    }
    for (; n < particle.nodes_end; ++n) {
      const NodeWeight& at_node = node_weights[n];
      push[at_node.node].add(at_node.weight, at_node.mirrored ? turned(impulse, at_node) : impulse);
    }
  }
  const Workspace& reference = *workspace.reference_grid;
  for (const std::int64_t node : touched) {
    const double mass = reference.nodes[node].v[3];
    for (int c = 0; c < 3; ++c) {
      if (reference.held[node] >> c & 1) {
        from_mirrors.c[c] -= push[node].c[c];
        push[node].c[c] = 0;
      }
      push[node].c[c] /= mass;
      if (sum) (*sum)[node][c] += push[node].c[c];
    }
  }
  const double share = sum == &total ? 1 : sum == &kept ? -1 : 0;
  for (int c = 0; c < 3; ++c) mirror_impulse[c] += share * from_mirrors.c[c];
  gather();
}

void LagrangianContact::give_total(Workspace& workspace) {
  for (const std::int64_t node : touched) {
    NodeRecord& record = workspace.reference_grid->nodes[node];
    for (int c = 0; c < 3; ++c) record.f[c] += total[node][c];
    total[node] = {};
  }
}

void LagrangianContact::keep(std::int64_t node, const Vector3& velocity) {
  touched_by_points.push_back(node);
  add(kept[node], velocity);
}

void LagrangianContact::see_trial(const Workspace& workspace) {
  for (const std::int64_t node : touched) {
    const NodeRecord& record = workspace.reference_grid->nodes[node];
    for (int c = 0; c < 3; ++c) push[node].c[c] = record.f[c] - record.v[c];
  }
  gather();
}

void LagrangianContact::begin_change(const Workspace& workspace) {
  for (const std::int64_t node : touched)
    for (int c = 0; c < 3; ++c) push[node].c[c] = -workspace.reference_grid->nodes[node].f[c];
}

void LagrangianContact::end_change(const Workspace& workspace) {
  for (const std::int64_t node : touched)
    for (int c = 0; c < 3; ++c) push[node].c[c] += workspace.reference_grid->nodes[node].f[c];
  gather();
}

}  // namespace ogive
