// Impulse and work of clamps and prescribed velocities.
#include "boundary/held_nodes.hpp"

#include <algorithm>
#include <array>

#include "boundary/boundary.hpp"
#include "phases.hpp"
#include "shape/scalar_weights.hpp"

namespace ogive {
namespace {

// Which nodes of a block, and of the two layers around it, lie in a region. Beyond a mirror or fixed face is its image.
class Neighbourhood {
 public:
  Neighbourhood(const Model& model, const Space& space, const std::array<std::int32_t, 3>& block)
      : reach_(model.numerics.shape_function == ShapeFunction::Linear ? 1 : 2), layers_(model.grid.planar() ? 0 : reach_) {
    const Grid& grid = model.grid;
    const auto lies_inside = [&](int i, int j, int k) {
      const std::array<int, 3> at = {i, j, k};
      Vector3 x;
      for (int axis = 0; axis < 3; ++axis) x[axis] = grid.domain_min[axis] + grid.cell_size * (4 * block[axis] + at[axis]);
      into_model(grid, x);
      return space.contains(x);
    };
    const int deepest = model.grid.planar() ? 1 : 4;
    for (int k = 0; k < deepest; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) any_ = (inside_[place(i, j, k)] = lies_inside(i, j, k)) || any_;
    if (!any_) return;
    for (int k = -layers_; k < deepest + layers_; ++k)
      for (int j = -reach_; j < 4 + reach_; ++j)
        for (int i = -reach_; i < 4 + reach_; ++i) inside_[place(i, j, k)] = lies_inside(i, j, k);
  }

  bool any() const { return any_; }
  bool contains(int n) const { return inside_[place(n & 3, n >> 2 & 3, n >> 4)]; }
  // Whether no particle that touches node n touches one outside the region.
  bool deep(int n) const {
    for (int k = -layers_; k <= layers_; ++k)
      for (int j = -reach_; j <= reach_; ++j)
        for (int i = -reach_; i <= reach_; ++i)
          if (!inside_[place((n & 3) + i, (n >> 2 & 3) + j, (n >> 4) + k)]) return false;
    return true;
  }

 private:
  static int place(int i, int j, int k) { return ((k + 2) * 8 + j + 2) * 8 + i + 2; }

  int reach_, layers_;
  bool any_ = false;
  std::array<bool, 512> inside_{};
};

// Calls visit(node, deep) for the nodes of this body (-1: of all bodies) in a region.
template <class Visit>
void for_nodes_in(const Model& model, const Workspace& workspace, const Space& space, int body, Visit&& visit) {
  for (std::size_t s = 0; s < workspace.slots.size(); ++s) {
    const Slot& slot = workspace.slots[s];
    if (slot.guided()) continue;  // what moves it also holds it
    if (body >= 0 && slot.field != model.field_of(body)) continue;
    const Neighbourhood around(model, space, slot.block);
    for (int n = 0; n < workspace.nodes_in_use && around.any(); ++n)
      if (around.contains(n)) visit(static_cast<std::int64_t>(s) * block_nodes + n, around.deep(n));
  }
}

Vector3 velocity_of(const HeldNode& held, const State& state) {
  return held.load < 0 ? Vector3{} : state.loads[held.load].value;
}

// Gives the nodes (records {velocity, mass | ...}) theirs.
void give_velocities(const State& state, Workspace& workspace, std::vector<HeldNode>& list) {
  for (HeldNode& held : list) {
    NodeRecord& node = workspace.nodes[held.node];
    held.taken = {};
    if (!(node.v[3] > 0)) continue;
    const Vector3 velocity = velocity_of(held, state);
    for (int c = 0; c < 3; ++c) {
      if (!(held.axes >> c & 1)) continue;
      held.taken[c] = node.v[c] - velocity[c];
      node.v[c] = velocity[c];
    }
  }
}

// The same at the end of the step. seen: part of what was taken at the beginning that the velocity at the end, or what particles
// take of it, has not got back.
void hold_at_end(State& state, Workspace& workspace, std::vector<HeldNode>& list, double seen, double dt) {
  for (HeldNode& held : list) {
    NodeRecord& node = workspace.nodes[held.node];
    held.impulse = {};
    if (!(node.v[3] > 0)) continue;
    const Vector3 velocity = velocity_of(held, state);
    for (int c = 0; c < 3; ++c) {
      if (!(held.axes >> c & 1)) continue;
      held.impulse[c] = node.v[3] * (velocity[c] - node.f[c] - seen * held.taken[c]);
      node.f[c] = velocity[c];
    }
    if (held.load < 0) {
      add(state.ledger.boundary_impulse, held.impulse);
      continue;
    }
    LoadState& load = state.loads[held.load];
    add(load.force, times(1 / dt, held.impulse));
    add(load.impulse, held.impulse);
    add(state.ledger.external_impulse, held.impulse);
  }
}

Vector3* response_of(Workspace& workspace, std::int64_t node) {
  const std::int32_t block = workspace.driven_block[static_cast<std::size_t>(node / block_nodes)];
  return block < 0 ? nullptr : &workspace.driven_response[static_cast<std::size_t>(block * block_nodes + node % block_nodes)];
}

// Adds a group's share of the momentum m_I q_I. Before the particles are changed: with FLIP, V_p - v_p = sum N_I (V_I - v_I);
// what takes the grid's own velocity, or XPIC's, takes it in place of the particle's.
void map_changes(const Model& model, const State& state, Workspace& workspace, const GroupLinks& link) {
  const BodyState& body = state.bodies[link.body];
  const Group& group = body.groups[link.group];
  const bool affine = model.numerics.affine(), xpic = model.numerics.transfer == Transfer::Xpic;
  const double renewed = model.numerics.renewed_fraction();
  for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
    const double* x = &body.position[4 * p];
    const ScalarWeights weights(model, link.corner, x);
    Vector3 change{};
    std::array<Vector3, 3> slope{};  // of the affine velocity, by axis, times h / 4
    for_stencil(weights, link, [&](std::int64_t at, int i, int j, int k, double weight) {
      const NodeRecord& node = workspace.nodes[at];
      const Vector3 from = {weights.from[0] + i, weights.from[1] + j, weights.from[2] + k};
      for (int c = 0; c < 3; ++c) {
        const double grid = xpic ? workspace.filter[static_cast<std::size_t>(at)].v[c] : node.v[c];
        change[c] += weight * (node.f[c] - node.v[c] + renewed * grid);
        for (int axis = 0; axis < 3 && affine; ++axis) slope[axis][c] += weight * from[axis] * node.f[c];
      }
    });
    for (int c = 0; c < 3; ++c) {
      change[c] -= renewed * body.velocity[4 * p + c];
      for (int axis = 0; axis < 3 && affine; ++axis)
        slope[axis][c] -= 0.25 * model.grid.cell_size * body.affine[static_cast<std::size_t>(affine_size * p + 3 * axis + c)];
    }
    for_stencil(weights, link, [&](std::int64_t at, int i, int j, int k, double weight) {
      Vector3* const sum = response_of(workspace, at);
      if (!sum) return;
      const Vector3 from = {weights.from[0] + i, weights.from[1] + j, weights.from[2] + k};
      for (int c = 0; c < 3; ++c)
        (*sum)[c] += weight * x[3] * (change[c] + 4 * (from[0] * slope[0][c] + from[1] * slope[1][c] + from[2] * slope[2][c]));
    });
  }
}

}  // namespace

void find_held_nodes(const Model& model, Workspace& workspace) {
  workspace.clamped_nodes.clear();
  workspace.driven_nodes.clear();
  for (const Clamp& clamp : model.clamps)
    for_nodes_in(model, workspace, clamp, clamp.body, [&](std::int64_t node, bool deep) {
      (deep ? workspace.driven_nodes : workspace.clamped_nodes).push_back({node, clamp.axes, -1, {}, {}});
    });
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    const Load& load = model.loads[i];
    if (load.kind != LoadKind::Velocity) continue;
    for_nodes_in(model, workspace, load, load.body, [&](std::int64_t node, bool) {
      workspace.driven_nodes.push_back({node, load.axes, static_cast<std::int32_t>(i), {}, {}});
    });
  }

  workspace.driven_block.clear();
  workspace.driven_response.clear();
  if (workspace.driven_nodes.empty()) return;
  workspace.driven_block.assign(workspace.slots.size(), -1);
  std::int32_t blocks = 0;
  const auto mark = [&](std::int64_t node) {
    std::int32_t& block = workspace.driven_block[static_cast<std::size_t>(node / block_nodes)];
    if (block < 0) block = blocks++;
  };
  for (const HeldNode& driven : workspace.driven_nodes) mark(driven.node);
  // What a mirror's ghost sees belongs to its image; at corners to the image of an image.
  for (auto face = workspace.faces.rbegin(); face != workspace.faces.rend(); ++face)
    for (std::size_t i = 0; i < face->moving_pairs; ++i)
      if (workspace.driven_block[static_cast<std::size_t>(face->pairs[i].image / block_nodes)] >= 0)
        mark(face->pairs[i].ghost);
  workspace.driven_response.resize(static_cast<std::size_t>(blocks) * block_nodes);
  for (GroupLinks& link : workspace.links)
    for (const std::int32_t slot : link.slot)
      link.driven = link.driven || (!link.guided && slot >= 0 && workspace.driven_block[static_cast<std::size_t>(slot)] >= 0);
}

void hold_clamps(const State& state, Workspace& workspace) { give_velocities(state, workspace, workspace.clamped_nodes); }

void hold_filter(Workspace& workspace) {
  for (const HeldNode& clamped : workspace.clamped_nodes)
    for (int c = 0; c < 3; ++c)
      if (clamped.axes >> c & 1) workspace.filter[static_cast<std::size_t>(clamped.node)].v[c] = 0;
}

void drive_nodes(const State& state, Workspace& workspace) { give_velocities(state, workspace, workspace.driven_nodes); }

void return_driven(Workspace& workspace) {
  // The last first: a node in two regions gets back what it had before either.
  for (auto driven = workspace.driven_nodes.rbegin(); driven != workspace.driven_nodes.rend(); ++driven)
    for (int c = 0; c < 3; ++c) workspace.nodes[driven->node].v[c] += driven->taken[c];
}

void hold_nodes(const Model& model, State& state, Workspace& workspace, double dt) {
  // Particles that take the grid's own velocity take that of a clamp as well. Where the stress comes first, driven nodes have their
  // velocity at the end from the one that they were given.
  hold_at_end(state, workspace, workspace.clamped_nodes, model.numerics.renewed_fraction(), dt);
  hold_at_end(state, workspace, workspace.driven_nodes, model.numerics.stress_first() ? 1 : 0, dt);
}

void book_held_work(const Model& model, State& state, Workspace& workspace) {
  bool changing = false;  // at rest in a clamp nothing does
  for (const HeldNode& driven : workspace.driven_nodes) {
    const NodeRecord& node = workspace.nodes[driven.node];
    for (int c = 0; c < 3; ++c) changing = changing || ((driven.axes >> c & 1) && node.f[c] != node.v[c]);
  }
  if (changing) {
    std::fill(workspace.driven_response.begin(), workspace.driven_response.end(), Vector3{});
    for_groups_in_order(workspace, [&](const GroupLinks& link, std::int32_t) {
      if (link.driven) map_changes(model, state, workspace, link);
    });
    fold_vectors(workspace, [&](std::int64_t node) { return response_of(workspace, node); });
  }
  for (const HeldNode& driven : workspace.driven_nodes) {
    const NodeRecord& node = workspace.nodes[driven.node];
    if (!(node.v[3] > 0)) continue;
    double work = 0;
    for (int c = 0; c < 3; ++c) {
      if (!(driven.axes >> c & 1)) continue;
      const double velocity = node.f[c], all = node.v[3] * (velocity - node.v[c]);
      const double q = all == 0 ? 0 : (*response_of(workspace, driven.node))[c] / node.v[3];
      work += all * (node.v[c] + 0.5 * q) - (all - driven.impulse[c]) * velocity;
    }
    if (driven.load < 0) {
      state.ledger.boundary_work += work;
    } else {
      state.loads[driven.load].work += work;
      state.ledger.external_work += work;
    }
  }
}

}  // namespace ogive
