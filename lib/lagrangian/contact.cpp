#include "lagrangian/contact.hpp"

#include "grid.hpp"
#include "lagrangian/reference_grid.hpp"

namespace ogive {
namespace {

Vector3 mirrored(const Vector3& v, std::int32_t signs) {
  return {signs & 1 ? -v[0] : v[0], signs & 2 ? -v[1] : v[1], signs & 4 ? -v[2] : v[2]};
}

}  // namespace

void LagrangianContact::find(const Model& model, const State& state, Workspace& workspace) {
  fields.clear();
  particles.clear();
  field_weights.clear();
  node_weights.clear();
  for (const std::int64_t node : touched) total[node] = kept[node] = push[node] = {};
  touched.clear();
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
  // A node beyond a mirror counts as its image, which may itself lie beyond another: faces in the reverse of their order.
  for (auto face = workspace.faces.rbegin(); face != workspace.faces.rend(); ++face)
    for (const MirrorPair& pair : face->pairs) {
      const std::int64_t ghost = record(pair.ghost), image = record(pair.image);
      if (ghost < 0 || image < 0 || at[image] < 0) continue;
      at[ghost] = at[image];
      mirrored[ghost] = mirrored[image] ^ signs(*face);
    }

  for (const GroupLinks& link : workspace.links) {
    if (!link.contact || !state.bodies[link.body].lagrangian) continue;
    bool near = false;
    for (const std::int32_t s : link.slot) near = near || (s >= 0 && workspace.slots[s].contact >= 0);
    if (!near) continue;
    const BodyState& copy = state.copies[link.body];
    const Group& group = copy.groups[link.group];
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
      const std::size_t before = field_weights.size();
      for_nodes_of(model, link, &copy.position[4 * p], [&](std::int64_t node, double weight, const Vector3&) {
        const std::int64_t r = record(node);
        if (r >= 0 && at[r] >= 0) field_weights.push_back({at[r], weight, mirrored[r]});
      });
      if (field_weights.size() == before) continue;
      for_reference_nodes(model, state, reference, link.body, copy.number[p], [&](const NodeWeight& at_node) {
        node_weights.push_back(at_node);
        Vector3& mark = push[at_node.node];
        if (mark[0] == 0) touched.push_back(at_node.node);
        mark[0] = 1;
      });
      particles.push_back({copy.position[4 * p + 3], static_cast<std::int32_t>(field_weights.size()),
                           static_cast<std::int32_t>(node_weights.size())});
    }
  }
  for (const std::int64_t node : touched) push[node] = {};
}

template <class VelocityOf>
void LagrangianContact::gather(VelocityOf&& velocity_of) {
  for (Field& field : fields) field.change = {};
  std::int32_t f = 0, n = 0;
  for (const Particle& particle : particles) {
    Vector3 v{};
    for (; n < particle.nodes_end; ++n)
      add(v, times(node_weights[n].weight, ogive::mirrored(velocity_of(node_weights[n].node), node_weights[n].mirrored)));
    for (; f < particle.fields_end; ++f) {
      Field& field = fields[field_weights[f].node];
      add(field.change,
          times(particle.mass * field_weights[f].weight / field.mass, ogive::mirrored(v, field_weights[f].mirrored)));
    }
  }
  for (Field& field : fields)
    for (int c = 0; c < 3; ++c)
      if (field.held >> c & 1) field.change[c] = 0;
}

void LagrangianContact::apply(const Workspace& workspace, std::vector<Vector3>* sum) {
  std::int32_t f = 0, n = 0;
  for (const Particle& particle : particles) {
    Vector3 impulse{};
    for (; f < particle.fields_end; ++f) {
      const Field& field = fields[field_weights[f].node];
      add(impulse, times(particle.mass * field_weights[f].weight / field.mass,
                         ogive::mirrored(field.impulse, field_weights[f].mirrored)));
    }
    for (; n < particle.nodes_end; ++n)
      add(push[node_weights[n].node],
          times(node_weights[n].weight, ogive::mirrored(impulse, node_weights[n].mirrored)));
  }
  const Workspace& reference = *workspace.reference_grid;
  for (const std::int64_t node : touched) {
    const double mass = reference.nodes[node].v[3];
    for (int c = 0; c < 3; ++c) {
      push[node][c] = reference.held[node] >> c & 1 || !(mass > 0) ? 0 : push[node][c] / mass;
      if (sum) (*sum)[node][c] += push[node][c];
    }
  }
  gather([&](std::int64_t node) { return push[node]; });
  for (const std::int64_t node : touched) push[node] = {};
}

void LagrangianContact::see_trial(const Workspace& workspace) {
  const Workspace& reference = *workspace.reference_grid;
  gather([&](std::int64_t node) -> Vector3 {
    const NodeRecord& record = reference.nodes[node];
    return {record.f[0] - record.v[0], record.f[1] - record.v[1], record.f[2] - record.v[2]};
  });
}

}  // namespace ogive
