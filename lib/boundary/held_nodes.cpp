// Impulse and work of clamps and prescribed velocities.
#include "boundary/held_nodes.hpp"

#include <algorithm>

#include "boundary/boundary.hpp"
#include "phases.hpp"
#include "shape/scalar_weights.hpp"

namespace ogive {
namespace {

// Calls visit(node, place) for the nodes of slots of this body (-1: of all bodies) that lie in a region.
template <class Visit>
void for_nodes_in(const Model& model, const Workspace& workspace, const Space& space, int body, Visit&& visit) {
  for (std::size_t s = 0; s < workspace.slots.size(); ++s) {
    const Slot& slot = workspace.slots[s];
    if (slot.guided()) continue;  // what moves it also holds it
    if (body >= 0 && slot.field != model.field_of(body)) continue;
    for (int n = 0; n < workspace.nodes_in_use; ++n) {
      Vector3 x;
      for (int axis = 0; axis < 3; ++axis)
        x[axis] = model.grid.domain_min[axis] + model.grid.cell_size * (4 * slot.block[axis] + ((n >> (2 * axis)) & 3));
      if (space.contains(x)) visit(static_cast<std::int64_t>(s) * block_nodes + n, x);
    }
  }
}

// Calls visit(node, weight, place from the particle in cells) for the nodes that a particle of the group reaches from x.
template <class Visit>
void for_places_of(const Model& model, const GroupLinks& link, const double* x, Visit&& visit) {
  const ScalarWeights s(model, link.corner, x);
  Vector3 from{};
  for (int axis = 0; axis < (s.layers > 1 ? 3 : 2); ++axis)
    from[axis] = s.first[axis] - (x[axis] - link.corner[axis]) / model.grid.cell_size;
  for (int k = 0; k < s.layers; ++k)
    for (int j = 0; j < s.nodes; ++j)
      for (int i = 0; i < s.nodes; ++i)
        visit(node_of_tile(link, s.first[0] + i, s.first[1] + j, s.first[2] + k), s.w[0][i] * s.w[1][j] * s.w[2][k],
              Vector3{from[0] + i, from[1] + j, from[2] + k});
}

// Adds a group's share of the momentum m_I q_I. Before the particles are changed: with FLIP, V_p - v_p = sum N_I (V_I - v_I);
// what takes the grid's own velocity, or XPIC's, takes it in place of the particle's.
void map_increments(const Model& model, const State& state, Workspace& workspace, const GroupLinks& link) {
  const BodyState& body = state.bodies[link.body];
  const Group& group = body.groups[link.group];
  const Numerics& numerics = model.numerics;
  const bool affine = numerics.affine(), xpic = numerics.transfer == Transfer::Xpic;
  const double renewed = xpic ? 1.0 : numerics.grid_velocity_fraction();
  for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
    const double* x = &body.position[4 * p];
    Vector3 change{};
    std::array<Vector3, 3> slope{};  // of the affine velocity, by axis, times h / 4
    for_places_of(model, link, x, [&](std::int64_t at, double weight, const Vector3& from) {
      const NodeRecord& node = workspace.nodes[at];
      for (int c = 0; c < 3; ++c) {
        const double grid = xpic ? workspace.filter[static_cast<std::size_t>(at)].v[c] : node.v[c];
        change[c] += weight * (node.f[c] - node.v[c] + renewed * grid);
        if (affine)
          for (int axis = 0; axis < 3; ++axis) slope[axis][c] += weight * from[axis] * node.f[c];
      }
    });
    for (int c = 0; c < 3; ++c) change[c] -= renewed * body.velocity[4 * p + c];
    if (affine)
      for (int axis = 0; axis < 3; ++axis)
        for (int c = 0; c < 3; ++c)
          slope[axis][c] -= 0.25 * model.grid.cell_size * body.affine[static_cast<std::size_t>(affine_size * p + 3 * axis + c)];
    if (change == Vector3{} && slope == std::array<Vector3, 3>{}) continue;
    for_places_of(model, link, x, [&](std::int64_t at, double weight, const Vector3& from) {
      Vector3& sum = workspace.held_response[static_cast<std::size_t>(at)];
      for (int c = 0; c < 3; ++c) {
        double seen = change[c];
        if (affine)
          for (int axis = 0; axis < 3; ++axis) seen += 4 * from[axis] * slope[axis][c];
        sum[c] += weight * x[3] * seen;
      }
    });
  }
}

// Position of a node as what is modelled has it: nodes beyond a mirror are those inside.
Vector3 image_of(const Grid& grid, Vector3 x) {
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.face[2 * axis] == Face::Symmetry && x[axis] < grid.domain_min[axis]) x[axis] = 2 * grid.domain_min[axis] - x[axis];
    if (grid.face[2 * axis + 1] == Face::Symmetry && x[axis] > grid.domain_max[axis])
      x[axis] = 2 * grid.domain_max[axis] - x[axis];
  }
  return x;
}

// Whether no particle that touches the node at x touches one outside the region.
bool is_deep(const Model& model, const Space& space, const Vector3& x) {
  const int reach = model.numerics.shape_function == ShapeFunction::Linear ? 1 : 2, layers = model.grid.planar() ? 0 : reach;
  for (int k = -layers; k <= layers; ++k)
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        const double h = model.grid.cell_size;
        if (!space.contains(image_of(model.grid, {x[0] + i * h, x[1] + j * h, x[2] + k * h}))) return false;
      }
  return true;
}

}  // namespace

void find_held_nodes(const Model& model, Workspace& workspace) {
  workspace.held_nodes.clear();
  for (const Clamp& clamp : model.clamps)
    for_nodes_in(model, workspace, clamp, clamp.body, [&](std::int64_t node, const Vector3& x) {
      HeldNode held;
      held.node = node;
      held.axes = clamp.axes;
      held.felt = is_deep(model, clamp, x);
      workspace.held_nodes.push_back(held);
    });
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    const Load& load = model.loads[i];
    if (load.kind != LoadKind::Velocity) continue;
    for_nodes_in(model, workspace, load, load.body, [&](std::int64_t node, const Vector3&) {
      HeldNode held;
      held.node = node;
      held.axes = load.axes;
      held.load = static_cast<std::int32_t>(i);
      held.felt = true;
      workspace.held_nodes.push_back(held);
    });
  }
  const bool felt = std::any_of(workspace.held_nodes.begin(), workspace.held_nodes.end(), [](const HeldNode& h) { return h.felt; });
  workspace.held_response.assign(felt ? workspace.slots.size() * block_nodes : 0, {});
  workspace.held_slots.assign(felt ? workspace.slots.size() : 0, 0);
}

void hold_clamps(Workspace& workspace) {
  for (HeldNode& held : workspace.held_nodes) {
    if (held.felt) continue;
    NodeRecord& node = workspace.nodes[held.node];
    held.taken = {};
    for (int c = 0; c < 3; ++c) {
      if (!(held.axes >> c & 1)) continue;
      held.taken[c] = node.v[c];
      node.v[c] = 0;
    }
  }
}

void hold_filter(Workspace& workspace) {
  for (const HeldNode& held : workspace.held_nodes)
    if (!held.felt)
      for (int c = 0; c < 3; ++c)
        if (held.axes >> c & 1) workspace.filter[static_cast<std::size_t>(held.node)].v[c] = 0;
}

void hold_velocities(const State& state, Workspace& workspace) {
  for (HeldNode& held : workspace.held_nodes) {
    if (!held.felt) continue;
    NodeRecord& node = workspace.nodes[held.node];
    held.taken = {};
    if (!(node.v[3] > 0)) continue;
    for (int c = 0; c < 3; ++c) {
      if (!(held.axes >> c & 1)) continue;
      const double velocity = held.load < 0 ? 0 : state.loads[held.load].value[c];
      held.taken[c] = node.v[c] - velocity;
      node.v[c] = velocity;
    }
  }
}

void return_held_velocities(Workspace& workspace) {
  // The last first: a node in two regions gets back what it had before either.
  for (auto held = workspace.held_nodes.rbegin(); held != workspace.held_nodes.rend(); ++held)
    if (held->felt)
      for (int c = 0; c < 3; ++c) workspace.nodes[held->node].v[c] += held->taken[c];
}

void hold_nodes(const Model& model, State& state, Workspace& workspace, double dt) {
  const Numerics& numerics = model.numerics;
  const double renewed = numerics.transfer == Transfer::Xpic ? 1.0 : numerics.grid_velocity_fraction();
  for (HeldNode& held : workspace.held_nodes) {
    NodeRecord& node = workspace.nodes[held.node];
    held.impulse = {};
    if (!(node.v[3] > 0)) continue;
    for (int c = 0; c < 3; ++c) {
      if (!(held.axes >> c & 1)) continue;
      const double velocity = held.load < 0 ? 0 : state.loads[held.load].value[c];
      // Where the strain has seen w, the velocity at the end was made from it. Particles that take the grid's own velocity take
      // that of a clamp as well.
      double change = velocity - node.f[c];
      if (!held.felt)
        change -= renewed * held.taken[c];
      else if (numerics.stress_first())
        change -= held.taken[c];
      const double impulse = node.v[3] * change;
      held.impulse[c] = impulse;
      node.f[c] = velocity;
      if (held.load < 0) {
        state.ledger.boundary_impulse[c] += impulse;
        continue;
      }
      LoadState& load = state.loads[held.load];
      load.force[c] += impulse / dt;
      load.impulse[c] += impulse;
      state.ledger.external_impulse[c] += impulse;
    }
  }
}

void book_held_work(const Model& model, State& state, Workspace& workspace) {
  if (workspace.held_response.empty()) return;
  std::fill(workspace.held_slots.begin(), workspace.held_slots.end(), char{0});
  for (const HeldNode& held : workspace.held_nodes) {
    const NodeRecord& node = workspace.nodes[held.node];
    for (int c = 0; c < 3; ++c)
      if (held.felt && (held.axes >> c & 1) && node.f[c] != node.v[c])
        workspace.held_slots[static_cast<std::size_t>(held.node / block_nodes)] = 1;
  }
  // What a mirror's ghost sees belongs to its image; at corners to the image of an image.
  for (auto face = workspace.faces.rbegin(); face != workspace.faces.rend(); ++face)
    for (std::size_t i = 0; i < face->moving_pairs; ++i)
      if (workspace.held_slots[static_cast<std::size_t>(face->pairs[i].image / block_nodes)])
        workspace.held_slots[static_cast<std::size_t>(face->pairs[i].ghost / block_nodes)] = 1;
  std::fill(workspace.held_response.begin(), workspace.held_response.end(), Vector3{});
  for_groups_in_order(workspace, [&](const GroupLinks& link, std::int32_t) {
    if (link.guided) return;
    for (const std::int32_t slot : link.slot)
      if (slot >= 0 && workspace.held_slots[static_cast<std::size_t>(slot)]) {
        map_increments(model, state, workspace, link);
        return;
      }
  });
  fold_vectors(workspace, workspace.held_response);
  for (const HeldNode& held : workspace.held_nodes) {
    const NodeRecord& node = workspace.nodes[held.node];
    if (!held.felt || !(node.v[3] > 0)) continue;
    double work = 0;
    for (int c = 0; c < 3; ++c) {
      if (!(held.axes >> c & 1)) continue;
      const double velocity = node.f[c], all = node.v[3] * (velocity - node.v[c]);
      const double q = workspace.held_response[static_cast<std::size_t>(held.node)][c] / node.v[3];
      work += all * (node.v[c] + 0.5 * q) - (all - held.impulse[c]) * velocity;
    }
    if (held.load < 0) {
      state.ledger.boundary_work += work;
    } else {
      state.loads[held.load].work += work;
      state.ledger.external_work += work;
    }
  }
}

}  // namespace ogive
