#include "lagrangian/lagrangian.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "audit.hpp"
#include "boundary/boundary.hpp"
#include "breakdown.hpp"
#include "contact/contact.hpp"
#include "contact/points.hpp"
#include "error.hpp"
#include "lagrangian/reference_grid.hpp"
#include "loads/loads.hpp"
#include "phases.hpp"

namespace ogive {
namespace {

constexpr int most_point_iterations = 300;
constexpr double point_tolerance = 1e-9;  // of the largest velocity around

bool loaded(const Model& model, const State& state) {
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    if (state.bodies[b].lagrangian && particles_loaded(model, state, static_cast<int>(b))) return true;
  return false;
}

// The middle of this step and the last: see lagrangian.hpp.
double kick_time(const State& state, double dt) { return 0.5 * (state.last_time_step + dt); }

// Calls work(node record, position, velocity and force in the state) for all nodes, one thread a slot.
template <class Work>
void for_state_nodes(State& state, Workspace& reference, Work&& work) {
  reference.slot_parts.for_each([&](std::int64_t s) {
    const Slot& slot = reference.slots[s];
    ReferenceState& of = state.bodies[slot.field].reference;
    for (std::size_t n = 0; n < block_nodes; ++n) {
      const std::size_t at = first_of_slot(slot) + 4 * n;
      work(s, reference.nodes[s * block_nodes + n], &of.node_position[at], &of.node_velocity[at], &of.node_force[at]);
    }
  });
}

// The particle of a group with the largest |F| |F^-1|.
std::int64_t most_distorted(const BodyState& body, std::int32_t group) {
  const Group& of = body.groups[group];
  std::int64_t worst = of.begin;
  double largest = 0;
  for (std::int64_t p = of.begin; p < of.begin + of.count; ++p) {
    double F[3][3], size = 0, cofactors = 0;
    for (int i = 0; i < 9; ++i) size += (F[i / 3][i % 3] = body.deformation[i][p]) * body.deformation[i][p];
    double determinant = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        const double cofactor = F[a][c] * F[b][d] - F[a][d] * F[b][c];
        cofactors += cofactor * cofactor;
        if (i == 0) determinant += F[0][j] * cofactor;
      }
    const double distortion = size * cofactors / (determinant * determinant);
    if (distortion > largest) largest = distortion, worst = p;
  }
  return worst;
}

double mirror(const NodeWeight& at, int c) { return at.mirrored >> c & 1 ? -at.weight : at.weight; }

// (3.19). N_a(X_c) is not delta_ac: the velocities of nodes around a point are changed so that the point itself moves
// as it should, by the impulses lambda_c at the points that change them least in the norm of the masses,
//   sum_d (N M^-1 N^T)_cd lambda_d = w_c - N_a(X_c) V_a,   dV = M^-1 N^T lambda,
// by conjugate gradients, each component by itself. Points that say the same more than once do no harm.
// Node records hold {velocity at the beginning, mass | trial velocity}.
void prescribe_points(State& state, Workspace& reference, double dt) {
  const std::size_t count = reference.prescribed_points.size();
  const auto for_weights = [&](std::size_t c, auto&& visit) {
    const std::int64_t begin = c == 0 ? 0 : reference.prescribed_points[c - 1].weights_end;
    for (std::int64_t i = begin; i < reference.prescribed_points[c].weights_end; ++i) visit(reference.point_weights[i]);
  };
  std::vector<double> residual(count), direction(count), lambda(count), image(count), start(count);
  std::vector<double> change(reference.nodes.size());
  for (int axis = 0; axis < 3; ++axis) {
    const auto acts = [&](std::size_t c) { return reference.prescribed_points[c].axes >> axis & 1; };
    const auto wanted = [&](std::size_t c) {
      return reference.prescribed_points[c].load < 0 ? 0.0 : state.loads[reference.prescribed_points[c].load].value[axis];
    };
    const auto free = [&](std::int64_t node) {
      return !(reference.held[node] >> axis & 1) && reference.nodes[node].v[3] > 0;
    };
    // M^-1 N^T of a value at each point.
    const auto spread = [&](const std::vector<double>& values) {
      for (std::size_t c = 0; c < count; ++c) for_weights(c, [&](const NodeWeight& at) { change[at.node] = 0; });
      for (std::size_t c = 0; c < count; ++c) {
        if (!acts(c)) continue;
        for_weights(c, [&](const NodeWeight& at) {
          if (free(at.node)) change[at.node] += mirror(at, axis) * values[c] / reference.nodes[at.node].v[3];
        });
      }
    };
    double worst = 0, scale = 0, squared = 0;
    for (std::size_t c = 0; c < count; ++c) {
      double v = 0, v_0 = 0;
      for_weights(c, [&](const NodeWeight& at) {
        v += mirror(at, axis) * reference.nodes[at.node].f[axis];
        v_0 += mirror(at, axis) * reference.nodes[at.node].v[axis];
        if (acts(c)) scale = std::max(scale, std::abs(reference.nodes[at.node].f[axis]));
      });
      residual[c] = acts(c) ? wanted(c) - v : 0;
      scale = std::max(scale, std::abs(wanted(c)));
      worst = std::max(worst, std::abs(residual[c]));
      start[c] = v_0;
      direction[c] = residual[c];
      lambda[c] = 0;
      squared += residual[c] * residual[c];
    }
    for (int iteration = 0; iteration < most_point_iterations && worst > point_tolerance * scale; ++iteration) {
      spread(direction);
      double curvature = 0;
      for (std::size_t c = 0; c < count; ++c) {
        image[c] = 0;
        if (!acts(c)) continue;
        for_weights(c, [&](const NodeWeight& at) { image[c] += mirror(at, axis) * change[at.node]; });
        curvature += direction[c] * image[c];
      }
      if (!(curvature > 0)) break;
      const double step = squared / curvature, before = squared;
      worst = squared = 0;
      for (std::size_t c = 0; c < count; ++c) {
        lambda[c] += step * direction[c];
        residual[c] -= step * image[c];
        squared += residual[c] * residual[c];
        worst = std::max(worst, std::abs(residual[c]));
      }
      for (std::size_t c = 0; c < count; ++c) direction[c] = residual[c] + squared / before * direction[c];
    }
    spread(lambda);
    for (std::size_t c = 0; c < count; ++c)
      for_weights(c, [&](const NodeWeight& at) {
        reference.nodes[at.node].f[axis] += change[at.node];
        change[at.node] = 0;
      });
    for (std::size_t c = 0; c < count; ++c) {
      if (!acts(c)) continue;
      const double work = lambda[c] * 0.5 * (start[c] + wanted(c));
      // Near a mirror the point's image pushes back, and the plane itself takes what would cross it: the mirror's impulse.
      double received = 0;
      for_weights(c, [&](const NodeWeight& at) { received += free(at.node) ? mirror(at, axis) : 0.0; });
      state.ledger.boundary_impulse[axis] += lambda[c] * (received - 1);
      if (reference.prescribed_points[c].load < 0) {
        state.ledger.boundary_impulse[axis] += lambda[c];
        state.ledger.boundary_work += work;
        continue;
      }
      LoadState& load = state.loads[reference.prescribed_points[c].load];
      load.force[axis] += lambda[c] / dt;
      load.impulse[axis] += lambda[c];
      load.work += work;
      state.ledger.external_impulse[axis] += lambda[c];
      state.ledger.external_work += work;
    }
  }
}

void keep_forces(State& state, Workspace& reference) {
  for_state_nodes(state, reference, [&](std::int64_t, NodeRecord& node, double*, double*, double* f) {
    const NodeRecord& force = reference.filter[static_cast<std::size_t>(&node - reference.nodes.data())];
    for (int c = 0; c < 3; ++c) f[c] = force.f[c];
  });
}

// Kinetic energy at the end of the step, with V^(n+1) of (3.21), and angular momentum. `filter` holds the internal
// forces, folded at mirrors; where there are none they are kept here, to save a pass over the nodes.
void sum_nodes(State& state, Workspace& reference, double dt) {
  std::vector<double> kinetic(reference.slots.size(), 0.0);
  std::vector<Vector3> angular(reference.slots.size(), Vector3{});
  const bool keep = reference.faces.empty();
  for_state_nodes(state, reference, [&](std::int64_t s, NodeRecord& node, double* x, double* v, double* f) {
    const double mass = x[3];
    if (!(mass > 0)) return;
    const double* force = reference.filter[static_cast<std::size_t>(&node - reference.nodes.data())].f;
    for (int c = 0; c < 3; ++c) {
      if (keep) f[c] = force[c];
      const double now = v[c] + 0.5 * dt * force[c] / mass;
      kinetic[s] += 0.5 * mass * now * now;
    }
    add(angular[s], times(mass, cross({x[0], x[1], x[2]}, {v[0], v[1], v[2]})));
  });
  for (BodyState& body : state.bodies)
    if (body.lagrangian) {
      body.reference.kinetic = 0;
      body.reference.angular_momentum = {};
    }
  for (std::size_t s = 0; s < reference.slots.size(); ++s) {
    ReferenceState& of = state.bodies[reference.slots[s].field].reference;
    of.kinetic += kinetic[s];
    add(of.angular_momentum, angular[s]);
  }
}

// A body all of whose nodes are beyond free faces is gone, and what it was is booked.
void remove_departed(const Model& model, State& state, Workspace& workspace) {
  const Grid& grid = model.grid;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    BodyState& body = state.bodies[b];
    if (!body.lagrangian) continue;
    Vector3 lower, upper;
    lower.fill(std::numeric_limits<double>::infinity());
    upper.fill(-std::numeric_limits<double>::infinity());
    const AlignedVector<double>& nodes = body.reference.node_position;
    for (std::size_t i = 0; i < nodes.size(); i += 4)
      for (int axis = 0; axis < 3 && nodes[i + 3] > 0; ++axis) {
        lower[axis] = std::min(lower[axis], nodes[i + axis]);
        upper[axis] = std::max(upper[axis], nodes[i + axis]);
      }
    bool out = false;
    for (int axis = 0; axis < 3; ++axis)
      out = out || (grid.face[2 * axis] == Face::Free && upper[axis] < grid.domain_min[axis]) ||
            (grid.face[2 * axis + 1] == Face::Free && lower[axis] > grid.domain_max[axis]);
    if (!out) continue;
    const BodyAudit audit = audit_body(model, state, static_cast<int>(b));
    body.totals.left.particles += body.particles;
    body.totals.left.mass += audit.mass;
    body.totals.left.energy += audit.kinetic + audit.internal;
    add(body.totals.left.momentum, audit.momentum);
    forget_departed(state, static_cast<int>(b), audit.kinetic, audit.internal);
    BodyState gone;
    gone.totals = body.totals;
    gone.totals.maximum_speed = 0;
    allocate_particles(model.material_of(static_cast<int>(b)), model.bodies[b], 0, gone);
    body = std::move(gone);
    state.copies[b] = {};
    workspace.linked = false;
    link_reference_grid(model, state, workspace, false);
  }
}

bool out_of_bounds(const State& state, const Workspace& workspace, std::size_t link) {
  const GroupLinks& of = workspace.links[link];
  const KernelGroup& bounds = workspace.kernel_groups[link];
  const BodyState& copy = state.copies[of.body];
  const Group& group = copy.groups[of.group];
  for (std::int64_t p = group.begin; p < group.begin + group.count; ++p)
    for (int axis = 0; axis < 3; ++axis) {
      const double x = copy.position[4 * p + axis];
      if (!(x >= bounds.bound_low[axis] && x <= bounds.bound_high[axis])) return true;
    }
  return false;
}

// For a body that goes on updated Lagrangian: dv_i/dx_j at its particles, as their affine velocity fields.
void set_affine_velocity(const Model& model, State& state, const Workspace& reference, int index) {
  BodyState& body = state.bodies[index];
  for (const GroupLinks& link : reference.links) {
    if (link.body != index) continue;
    const Group& group = body.groups[link.group];
    for (std::int64_t p = group.begin; p < group.padded_end(); ++p) {
      double rate[3][3] = {}, F[3][3], inverse[3][3];
      for_nodes_of(model, link, &body.reference.position[4 * p], [&](std::int64_t node, double, const Vector3& d) {
        const Slot& slot = reference.slots[node / block_nodes];
        const double* v = &body.reference.node_velocity[first_of_slot(slot) + 4 * (node % block_nodes)];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) rate[i][j] += v[i] * d[j] / model.grid.cell_size;
      });
      for (int c = 0; c < 9; ++c) F[c / 3][c % 3] = body.deformation[c][p];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
          inverse[i][j] = (F[a][c] * F[b][d] - F[a][d] * F[b][c]) / body.volume_ratio[p];
        }
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          body.affine[affine_size * p + 3 * j + i] =
              rate[i][0] * inverse[0][j] + rate[i][1] * inverse[1][j] + rate[i][2] * inverse[2][j];
    }
  }
}

// What the first phase of contact gave for the motion alone goes from the velocities of nodes and particles.
void take_back_kept(const Model& model, State& state, Workspace& workspace) {
  Workspace& reference = *workspace.reference_grid;
  const LagrangianContact& contact = workspace.lagrangian_contact;
  if (!contact.keeps()) return;
  const auto kept_at = [&](std::int64_t image, std::int32_t signs, int c) {
    const double kept = contact.kept[image][c];
    return signs >> c & 1 ? -kept : kept;
  };
  for_state_nodes(state, reference, [&](std::int64_t, NodeRecord& node, double*, double* v, double*) {
    const std::size_t at = static_cast<std::size_t>(&node - reference.nodes.data());
    for (int c = 0; c < 3; ++c) v[c] -= kept_at(reference.image[at], reference.image_signs[at], c);
  });
  for_groups_in_order(reference, [&](const GroupLinks& link, std::int32_t) {
    BodyState& body = state.bodies[link.body];
    const Group& group = body.groups[link.group];
    for (std::int64_t p = group.begin; p < group.padded_end(); ++p)
      for_reference_nodes(model, state, reference, link.body, p, [&](const NodeWeight& at) {
        for (int c = 0; c < 3; ++c) body.velocity[4 * p + c] -= at.weight * kept_at(at.node, at.mirrored, c);
      });
  });
  // It was booked at mirrors with the rest.
  for (const FaceNodes& face : reference.faces)
    for (const MirrorPair& pair : face.pairs)
      for (int c = 0; c < 3; ++c) {
        if (!face.fixed && c != face.axis) continue;
        state.ledger.boundary_impulse[c] +=
            2.0 * pair.ghost_mass * kept_at(reference.image[pair.image], reference.image_signs[pair.image], c);
      }
}

}  // namespace

void prepare_lagrangian(const Model& model, State& state, Workspace& workspace, bool fresh) {
  state.copies.resize(state.bodies.size());
  bool any = false;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    if (fresh) state.bodies[b].lagrangian = model.bodies[b].total_lagrangian();
    any = any || state.bodies[b].lagrangian;
  }
  link_reference_grid(model, state, workspace, fresh);
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    if (!state.bodies[b].lagrangian) continue;
    state.copies[b].stressed = workspace.contact_needs.stress;
    if (!fresh) fill_copy(state, static_cast<int>(b));
  }
  if (any && fresh) sum_nodes(state, *workspace.reference_grid, 0);
}

void retire_distorted(const Model& model, State& state, Workspace& workspace) {
  bool changed = false;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    BodyState& body = state.bodies[b];
    if (!body.lagrangian || !body.reference.distorted) continue;
    const double before = body.reference.kinetic;
    body.lagrangian = false;
    allocate_transfer(model, static_cast<int>(b), body);
    if (!body.affine.empty()) set_affine_velocity(model, state, *workspace.reference_grid, static_cast<int>(b));
    body.reference = {};
    if (!model.material_of(static_cast<int>(b)).hyperelastic())
      for (auto& component : body.deformation) component = {};
    state.copies[b] = {};
    body.drifted = true;
    state.ledger.transfer_dissipation += before - audit_body(model, state, static_cast<int>(b)).kinetic;
    changed = true;
  }
  if (!changed) return;
  workspace.linked = false;
  link_reference_grid(model, state, workspace, false);
}

void take_velocities(const Model& model, State& state, Workspace& workspace, int body) {
  Workspace& reference = *workspace.reference_grid;
  for_state_nodes(state, reference, [&](std::int64_t, NodeRecord& node, double* x, double*, double* f) {
    node.v[3] = x[3];
    std::copy_n(f, 3, reference.filter[static_cast<std::size_t>(&node - reference.nodes.data())].f);
  });
  project_velocities(model, state, reference, body);
  sum_nodes(state, reference, 0);
  if (!state.copies[body].number.empty()) fill_copy(state, body);
}

void kick_lagrangian(const Model& model, State& state, Workspace& workspace, double dt) {
  if (!workspace.reference_grid) return;
  Workspace& reference = *workspace.reference_grid;
  if (reference.threads != workspace.threads) {
    reference.threads = workspace.threads;
    share_out(state, reference);
  }
  const double kick = kick_time(state, dt);
  if (reference.faces.empty() && !loaded(model, state) && model.numerics.gravity == Vector3{}) {
    // The same as below in one pass.
    for_state_nodes(state, reference,
                    [&](std::int64_t, NodeRecord& node, const double* x, const double* v, const double* f) {
                      const double factor = x[3] > 0 ? kick / x[3] : 0;
                      for (int c = 0; c < 3; ++c) {
                        node.v[c] = v[c];
                        node.f[c] = v[c] + factor * f[c];
                      }
                      node.v[3] = x[3];
                      node.f[3] = 0;
                    });
    return;
  }
  for_state_nodes(state, reference,
                  [](std::int64_t, NodeRecord& node, const double* x, const double* v, const double* f) {
                    for (int c = 0; c < 3; ++c) {
                      node.v[c] = v[c];
                      node.f[c] = f[c];
                    }
                    node.v[3] = x[3];
                    node.f[3] = 0;
                  });
  if (loaded(model, state)) {
    allocate_load_sums(model, state, reference);
    for_groups_in_order(reference, [&](const GroupLinks& link, std::int32_t index) {
      if (particles_loaded(model, state, link.body)) map_loads(model, state, reference, index);
    });
  }
  fold_force(state, reference, kick);
  trial_velocities(model, reference, kick);
}

void set_lagrangian_trial(Workspace& workspace) {
  LagrangianContact& contact = workspace.lagrangian_contact;
  if (contact.empty()) return;
  contact.see_trial(workspace);
  contact.for_records(workspace, [](const LagrangianContact::Field& field, const ContactField&, NodeRecord& record) {
    for (int c = 0; c < 3; ++c) record.f[c] = record.v[c] + field.change[c];
  });
}

void set_lagrangian_velocities(Workspace& workspace) {
  if (workspace.lagrangian_contact.empty()) return;
  workspace.lagrangian_contact.for_records(
      workspace, [](const LagrangianContact::Field&, const ContactField& field, NodeRecord& record) {
        for (int c = 0; c < 3; ++c) record.v[c] = field.velocity[c];
      });
}

void hold_lagrangian(const Model& model, State& state, Workspace& workspace, double dt) {
  if (!workspace.reference_grid) return;
  Workspace& reference = *workspace.reference_grid;
  LagrangianContact& contact = workspace.lagrangian_contact;
  contact.give_total(workspace);
  add(state.ledger.boundary_impulse, contact.mirror_impulse);
  hold_faces(state, reference);
  if (!reference.prescribed_points.empty()) {
    contact.begin_change(workspace);
    begin_held_points(state, workspace);
    prescribe_points(state, reference, dt);
    contact.end_change(workspace);
    book_held_contact(state, workspace);
    book_held_points(state, workspace);
  }
  book_gravity(model, state, reference, kick_time(state, dt));
}

void finish_lagrangian_step(const Model& model, State& state, Workspace& workspace, double dt) {
  workspace.lagrangian_speed = 0;
  if (!workspace.reference_grid) return;
  Workspace& reference = *workspace.reference_grid;
  const double kick = kick_time(state, dt);
  unfold_motion(state, reference);

  // {velocity at the end, - | mean acceleration}, for the work of loads.
  if (loaded(model, state)) {
    for_nodes(reference, [&](std::int64_t at) {
      NodeRecord& node = reference.nodes[at];
      for (int c = 0; c < 3; ++c) {
        const double end = node.f[c];
        node.f[c] = (end - node.v[c]) / kick;
        node.v[c] = end;
      }
    });
    for_groups_in_order(reference, [&](const GroupLinks& link, std::int32_t index) {
      if (particles_loaded(model, state, link.body)) measure_loads(model, state, reference, index, kick);
    });
    book_loads(model, state, reference, kick);
    for_nodes(reference, [&](std::int64_t at) {
      NodeRecord& node = reference.nodes[at];
      for (int c = 0; c < 3; ++c) node.f[c] = node.v[c];
    });
  }

  // (3.20), and nodes become {velocity | -}.
  for_state_nodes(state, reference, [&](std::int64_t, NodeRecord& node, double* x, double* v, double*) {
    NodeRecord& force = reference.filter[static_cast<std::size_t>(&node - reference.nodes.data())];
    for (int c = 0; c < 3; ++c) {
      v[c] = node.v[c] = node.f[c];
      x[c] += dt * node.f[c];
    }
    node.v[3] = 0;
    for (double& c : force.f) c = 0;
  });
  const int shape = static_cast<int>(model.numerics.shape_function);
  for_groups_in_order(reference, [&](const GroupLinks& link, std::int32_t index) {
    const Material& material = model.material_of(link.body);
    NodeRecord* forces[27];
    for (int i = 0; i < 27; ++i)
      forces[i] = link.slot[i] < 0 ? nullptr : &reference.filter[static_cast<std::size_t>(link.slot[i]) * block_nodes];
    reference.kernels->optional
        ->update_lagrangian[shape][static_cast<int>(material.strength)][static_cast<int>(material.eos)](
            kernel_group(model, state, reference, link, dt), kernel_particles(state.bodies[link.body]),
            reference.materials[link.body], forces, reference.stress_sums[index]);
  });
  book_stress(model, state, reference, dt);
  if (workspace.contact_needs.start_kept) take_back_kept(model, state, workspace);
  if (!reference.faces.empty()) {
    keep_forces(state, reference);
    fold_filter(reference);
  }
  sum_nodes(state, reference, dt);

  std::vector<double> speed_squared(state.bodies.size(), 0.0);
  for (std::size_t l = 0; l < reference.links.size(); ++l) {
    const GroupLinks& link = reference.links[l];
    const StressSums& sums = reference.stress_sums[l];
    ReferenceState& of = state.bodies[link.body].reference;
    speed_squared[link.body] = std::max(speed_squared[link.body], sums.speed_squared);
    // The critical step belongs to the critical length; more than a cell's would not be sought by others.
    const double wave = sums.fastest * std::max(1.0, model.grid.cell_size / of.critical_length);
    workspace.lagrangian_speed = std::max({workspace.lagrangian_speed, wave, std::sqrt(sums.speed_squared)});
    const Body& rules = model.bodies[link.body];
    if (!(sums.worst_distortion > rules.distortion_limit)) continue;
    if (rules.when_distorted == WhenDistorted::Stop) {
      char text[64];
      std::snprintf(text, sizeof text, "%.6g, got %.6g", rules.distortion_limit, sums.worst_distortion);
      throw breakdown(model, state, link.body, most_distorted(state.bodies[link.body], link.group),
                      std::string("distortion |F| |F^-1| / 3 must be at most ") + text,
                      "the body is deformed more than distortion_limit allows, and when_distorted forbids to go on updated "
                      "Lagrangian");
    }
    of.distorted = true;
    // The next step is an updated Lagrangian one, with the limit (35).
    workspace.lagrangian_speed = std::max(workspace.lagrangian_speed, sums.fastest + std::sqrt(sums.speed_squared));
  }
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    if (!state.bodies[b].lagrangian) continue;
    BodyTotals& totals = state.bodies[b].totals;
    totals.maximum_speed = std::sqrt(speed_squared[b]);
    totals.maximum_speed_ever = std::max(totals.maximum_speed_ever, totals.maximum_speed);
    if (!workspace.contact_needs.any) continue;
    fill_copy(state, static_cast<int>(b));
    for (std::size_t l = 0; l < workspace.links.size() && !state.copies[b].drifted; ++l)
      if (workspace.links[l].body == static_cast<int>(b)) state.copies[b].drifted = out_of_bounds(state, workspace, l);
  }
  remove_departed(model, state, workspace);
}

}  // namespace ogive
