#include "lagrangian/reference_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "boundary/boundary.hpp"
#include "error.hpp"
#include "phases.hpp"

namespace ogive {
namespace {

// Nodes beyond mirrors as their images, and the components that a mirror in a node holds.
void find_images(Workspace& reference) {
  const std::size_t n = reference.nodes.size();
  reference.image.resize(n);
  reference.image_signs.assign(n, 0);
  reference.held.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) reference.image[i] = static_cast<std::int64_t>(i);
  const auto signs = [](const FaceNodes& face) { return face.fixed ? 7 : 1 << face.axis; };
  // An image may itself lie beyond a later face.
  for (auto face = reference.faces.rbegin(); face != reference.faces.rend(); ++face)
    for (const MirrorPair& pair : face->pairs) {
      reference.image[pair.ghost] = reference.image[pair.image];
      reference.image_signs[pair.ghost] = reference.image_signs[pair.image] ^ signs(*face);
    }
  for (const FaceNodes& face : reference.faces)
    for (const std::int64_t node : face.plane) reference.held[node] |= signs(face);
}

// Lumped masses.
void map_masses(const Model& model, State& state, Workspace& reference) {
  std::memset(static_cast<void*>(reference.nodes.data()), 0, reference.nodes.size() * sizeof(NodeRecord));
  const auto map = reference.kernels->map_momentum[static_cast<int>(model.numerics.shape_function)][0];
  for_groups_in_order(reference, [&](const GroupLinks& link, std::int32_t) {
    KernelParticles particles = kernel_particles(state.bodies[link.body]);
    particles.position = state.bodies[link.body].reference.position.data();
    map(kernel_group(model, state, reference, link, 0), particles);
  });
  fold_momentum(reference);
}

// The length L of the critical time step L / c, (3.22): 2 / sqrt(lambda), lambda the largest eigenvalue of
//   M_a y_a = sum_p m_p grad N_a(X_p) . sum_b grad N_b(X_p) y_b
// by power iteration, which comes from below: 5 % are taken off.
double critical_length(const Model& model, const State& state, const Workspace& reference, int body) {
  constexpr int iterations = 40;
  const BodyState& of = state.bodies[body];
  const double inverse_cell = 1.0 / model.grid.cell_size;
  std::vector<double> x(reference.nodes.size(), 0.0), y(reference.nodes.size(), 0.0);
  std::uint64_t seed = 1;
  double norm = 0;
  for (std::size_t s = 0; s < reference.slots.size(); ++s)
    for (std::size_t i = s * block_nodes; i < (s + 1) * block_nodes && reference.slots[s].field == body; ++i) {
      seed = seed * 6364136223846793005u + 1442695040888963407u;
      x[i] = reference.nodes[i].v[3] > 0 ? static_cast<double>(seed >> 33) * 0x1p-31 - 0.5 : 0;
      norm += reference.nodes[i].v[3] * x[i] * x[i];
    }
  double eigenvalue = 0;
  for (int iteration = 0; iteration < iterations && norm > 0; ++iteration) {
    for (double& value : x) value /= std::sqrt(norm);
    std::fill(y.begin(), y.end(), 0.0);
    for (const GroupLinks& link : reference.links) {
      if (link.body != body) continue;
      const Group& group = of.groups[link.group];
      for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
        const double* place = &of.reference.position[4 * p];
        Vector3 gradient{};
        for_nodes_of(model, link, place, [&](std::int64_t node, double, const Vector3& d) {
          add(gradient, times(x[reference.image[node]], d));
        });
        const double scale = place[3] * inverse_cell * inverse_cell;
        for_nodes_of(model, link, place, [&](std::int64_t node, double, const Vector3& d) {
          y[reference.image[node]] += scale * dot(gradient, d);
        });
      }
    }
    eigenvalue = norm = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double mass = reference.nodes[i].v[3];
      if (!(mass > 0)) continue;
      eigenvalue += x[i] * y[i];
      x[i] = y[i] / mass;
      norm += mass * x[i] * x[i];
    }
  }
  return eigenvalue > 0 ? 2 / std::sqrt(1.05 * eigenvalue) : model.grid.cell_size;
}

// The particles whose velocity clamps and loads prescribe: those that lay in the region at the beginning, (3.15).
void find_prescribed_points(const Model& model, const State& state, Workspace& reference) {
  reference.prescribed_points.clear();
  reference.point_weights.clear();
  const auto add_points = [&](const Space& space, int body, std::int32_t axes, std::int32_t load) {
    for (std::size_t b = 0; b < state.bodies.size(); ++b) {
      if (!state.bodies[b].lagrangian || (body >= 0 && body != static_cast<int>(b))) continue;
      const BodyState& of = state.bodies[b];
      for (const Group& group : of.groups)
        for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
          const double* X = &of.reference.position[4 * p];
          if (!space.contains({X[0], X[1], X[2]})) continue;
          for_reference_nodes(model, state, reference, static_cast<int>(b), p,
                              [&](const NodeWeight& node) { reference.point_weights.push_back(node); });
          reference.prescribed_points.push_back({axes, load, static_cast<std::int64_t>(reference.point_weights.size())});
        }
    }
  };
  for (const Clamp& clamp : model.clamps) add_points(clamp, clamp.body, clamp.axes, -1);
  for (std::size_t i = 0; i < model.loads.size(); ++i)
    if (model.loads[i].kind == LoadKind::Velocity)
      add_points(model.loads[i], model.loads[i].body, model.loads[i].axes, static_cast<std::int32_t>(i));
}

}  // namespace

void link_reference_grid(const Model& model, State& state, Workspace& workspace, bool fresh) {
  const auto lagrangian = [](const BodyState& body) { return body.lagrangian; };
  workspace.lagrangian_contact = {};
  for (PlacedSurface& placed : workspace.surfaces) {
    placed.vertex_ends.clear();
    placed.vertex_nodes.clear();
  }
  if (std::none_of(state.bodies.begin(), state.bodies.end(), lagrangian)) {
    workspace.reference_grid.reset();
    return;
  }
  if (!workspace.reference_grid) workspace.reference_grid = std::make_unique<Workspace>();
  Workspace& reference = *workspace.reference_grid;
  reference.is_reference = true;
  reference.kernels = workspace.kernels;
  reference.materials = workspace.materials;
  reference.threads = workspace.threads;
  if (fresh) {
    bin_particles(model, state, reference, true);
    for (BodyState& body : state.bodies)
      if (body.lagrangian) body.reference.position = body.position;
  }
  link_grid(model, state, reference);
  reference.link_of.assign(state.bodies.size(), {});
  for (std::size_t l = 0; l < reference.links.size(); ++l) {
    const GroupLinks& link = reference.links[l];
    const Group& group = state.bodies[link.body].groups[link.group];
    std::vector<std::int32_t>& of = reference.link_of[link.body];
    of.resize(static_cast<std::size_t>(state.bodies[link.body].padded), -1);
    std::fill(of.begin() + group.begin, of.begin() + group.padded_end(), static_cast<std::int32_t>(l));
  }
  find_images(reference);
  map_masses(model, state, reference);

  std::vector<std::size_t> size(state.bodies.size(), 0);
  for (const Slot& slot : reference.slots) size[slot.field] += std::size_t{4} * block_nodes;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    if (!state.bodies[b].lagrangian) continue;
    ReferenceState& of = state.bodies[b].reference;
    if (fresh)
      for (AlignedVector<double>* array : {&of.node_position, &of.node_velocity, &of.node_force})
        array->assign(size[b], 0.0);
    if (of.node_position.size() != size[b])
      throw Error(ErrorKind::Format, "state/bodies/" + std::to_string(b) + "/reference/node_position: expected " +
                                         std::to_string(size[b]) + " numbers, found " +
                                         std::to_string(of.node_position.size()));
  }
  for (std::size_t s = 0; s < reference.slots.size(); ++s) {
    const Slot& slot = reference.slots[s];
    ReferenceState& of = state.bodies[slot.field].reference;
    for (std::size_t n = 0; n < block_nodes; ++n) {
      NodeRecord& record = reference.nodes[s * block_nodes + n];
      double* x = &of.node_position[first_of_slot(slot) + 4 * n];
      if (fresh) {
        for (int axis = 0; axis < 3; ++axis) {
          const int index = 4 * slot.block[axis] + static_cast<int>((n >> (2 * axis)) & 3);
          x[axis] = model.grid.domain_min[axis] + model.grid.cell_size * index;
        }
      }
      x[3] = record.v[3];
    }
  }
  for (std::size_t b = 0; b < state.bodies.size() && fresh; ++b) {
    if (!state.bodies[b].lagrangian) continue;
    project_velocities(model, state, reference, static_cast<int>(b));
    state.bodies[b].reference.critical_length = critical_length(model, state, reference, static_cast<int>(b));
  }
  find_prescribed_points(model, state, reference);
}

// V <- V + mean over particles of (v_p - N_a(X_p) V_a), from zero: the first pass is the mean, which pulls the edges of
// a body towards its inside; the next ones take that back.
void project_velocities(const Model& model, State& state, const Workspace& reference, int index) {
  constexpr int passes = 50;
  constexpr double tolerance = 1e-13;
  BodyState& body = state.bodies[index];
  std::vector<Vector3> velocity(reference.nodes.size(), Vector3{}), change(reference.nodes.size());
  const auto mirrored = [](const NodeWeight& at, const Vector3& v) -> Vector3 {
    return {at.mirrored & 1 ? -v[0] : v[0], at.mirrored & 2 ? -v[1] : v[1], at.mirrored & 4 ? -v[2] : v[2]};
  };
  const auto at_particle = [&](std::int64_t p) {
    Vector3 v{};
    for_reference_nodes(model, state, reference, index, p,
                        [&](const NodeWeight& at) { add(v, times(at.weight, mirrored(at, velocity[at.node]))); });
    return v;
  };
  const auto for_particles = [&](auto&& visit) {
    for (const Group& group : body.groups)
      for (std::int64_t p = group.begin; p < group.padded_end(); ++p) visit(p);
  };
  for (int pass = 0; pass < passes; ++pass) {
    double worst = 0, scale = 0;
    std::fill(change.begin(), change.end(), Vector3{});
    for_particles([&](std::int64_t p) {
      const double* v = &body.velocity[4 * p];
      const Vector3 miss = minus({v[0], v[1], v[2]}, at_particle(p));
      const double mass = body.reference.position[4 * p + 3];
      worst = std::max(worst, length(miss));
      scale = std::max(scale, length({v[0], v[1], v[2]}));
      for_reference_nodes(model, state, reference, index, p, [&](const NodeWeight& at) {
        add(change[at.node], times(mass * at.weight, mirrored(at, miss)));
      });
    });
    if (!(worst > tolerance * scale)) break;
    for (std::size_t i = 0; i < velocity.size(); ++i) {
      const double mass = reference.nodes[i].v[3];
      for (int c = 0; c < 3; ++c)
        if (mass > 0 && !(reference.held[i] >> c & 1)) velocity[i][c] += change[i][c] / mass;
    }
  }
  for_particles([&](std::int64_t p) {
    const Vector3 v = at_particle(p);
    std::copy(v.begin(), v.end(), &body.velocity[4 * p]);
  });
  for (std::size_t s = 0; s < reference.slots.size(); ++s) {
    if (reference.slots[s].field != index) continue;
    double* v = &body.reference.node_velocity[first_of_slot(reference.slots[s])];
    for (std::size_t n = 0; n < block_nodes; ++n)
      for (int c = 0; c < 3; ++c) v[4 * n + c] = velocity[s * block_nodes + n][c];
  }
}

}  // namespace ogive
