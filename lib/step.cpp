// One step of the material point method. Equation numbers are those of Huang et al. 2010. Stress first is USF
// (Bardenhagen 2002), the papers' order; stress last is MUSL (Sulsky, Zhou, Schreyer 1995): the particles' new momentum
// is mapped once more, from their old places, and gives the strain increment. Stress last as is, USL (Sulsky, Chen, Schreyer
// 1994), takes the nodal velocities at the end of the step as they are.
#include "step.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "boundary/boundary.hpp"
#include "boundary/held_nodes.hpp"
#include "breakdown.hpp"
#include "contact/contact.hpp"
#include "contact/occupied.hpp"
#include "debris.hpp"
#include "error.hpp"
#include "lagrangian/lagrangian.hpp"
#include "loads/loads.hpp"
#include "parallel.hpp"
#include "phases.hpp"
#include "resting.hpp"
#include "rigid/rigid.hpp"
#include "surface/meeting.hpp"
#include "time_step.hpp"

namespace ogive {
namespace {

void clear_grid(Workspace& workspace);
void clear_contacts(Workspace& workspace);
void map_mass_and_momentum(const Model& model, State& state, Workspace& workspace);
void map_contact_sums(const Model& model, State& state, Workspace& workspace);
void map_contact_stress(const Model& model, State& state, Workspace& workspace);
void filter_velocities(const Model& model, State& state, Workspace& workspace);
void filtered_velocities(Workspace& workspace);
void nodal_velocities(Workspace& workspace);
void update_stress(const Model& model, State& state, Workspace& workspace, double dt);
void map_internal_force(const Model& model, State& state, Workspace& workspace, double dt);
void book_hoop_force(const Model& model, State& state, const Workspace& workspace, double dt);
void map_external_force(const Model& model, State& state, Workspace& workspace);
void measure_external_force(const Model& model, State& state, Workspace& workspace, double dt);
void accelerations(State& state, Workspace& workspace, double dt);
void update_velocity_and_position(const Model& model, State& state, Workspace& workspace, double dt);

}  // namespace

void advance_one_step(const Model& model, State& state, Workspace& workspace, double dt) {
  const bool contact = workspace.contact_needs.any;
  const bool stress_first = model.numerics.stress_first();
  const bool xpic = model.numerics.transfer == Transfer::Xpic;
  workspace.changing = false;
  retire_distorted(model, state, workspace);
  bin_particles(model, state, workspace, false);                 // particles that left their cells; the domain
  if (debris_is_due(model, state)) drop_debris(model, state, workspace);
  if (!workspace.linked) link_grid(model, state, workspace);     // the grid follows the material
  choose_groups(model, state, workspace);                        // nothing has happened to the others
  if (workspace.schedule.threads() != workspace.threads) share_out(state, workspace);
  allocate_load_sums(model, state, workspace);

  clear_grid(workspace);
  clear_contacts(workspace);
  map_mass_and_momentum(model, state, workspace);                // (27), (28)
  map_contact_sums(model, state, workspace);                     // (9)
  fold_momentum(workspace);                                      // symmetry and fixed faces
  fold_contact_sums(workspace);
  nodal_velocities(workspace);                                   // (6)
  hold_clamps(state, workspace);
  kick_lagrangian(model, state, workspace, dt);                  // total Lagrangian bodies
  begin_rigid_step(model, state, workspace, dt);
  set_rigid_velocities(model, workspace, false);
  if (xpic) filter_velocities(model, state, workspace);          // v* of XPIC
  if (contact) find_contacts(model, state, workspace);           // (10), the gap
  workspace.changing = true;
  if (contact) start_contact(model, state, workspace, dt,               // (23)-(25)
                             stress_first ? StartUse::MotionAndStrain : StartUse::Motion);
  if (stress_first) {
    drive_nodes(state, workspace);                               // prescribed velocities
    unfold_velocity(workspace);
    update_stress(model, state, workspace, dt);                  // (29), (30), stress, (31)
  } else {
    map_internal_force(model, state, workspace, dt);             // (31)
  }
  book_hoop_force(model, state, workspace, dt);
  map_external_force(model, state, workspace);                   // loads of the host
  fold_force(state, workspace, dt);
  trial_velocities(model, workspace, dt);                        // (32), (11) or (26)
  accelerate_rigid(model, state, workspace, dt);
  set_rigid_velocities(model, workspace, true);
  set_lagrangian_trial(workspace);
  if (stress_first) return_driven(workspace);
  if (contact) return_start(workspace);                          // the jump of (25) belongs to the increment (34)
  hold_faces(state, workspace);
  map_contact_stress(model, state, workspace);
  if (contact) end_contact(model, state, workspace, dt);         // (12)-(22), (14)
  hold_nodes(model, state, workspace, dt);                       // clamps, prescribed velocities
  hold_lagrangian(model, state, workspace, dt);                  // their impulses, faces, (3.19) of Lee et al.
  book_gravity(model, state, workspace, dt);
  unfold_motion(state, workspace);
  if (contact) book_kept_start(state, workspace);
  if (workspace.contact_needs.surface) move_surfaces(model, state, workspace, dt);
  if (xpic) filtered_velocities(workspace);
  book_grid_velocity(model, state, workspace);
  book_held_work(model, state, workspace);
  accelerations(state, workspace, dt);
  measure_external_force(model, state, workspace, dt);
  update_velocity_and_position(model, state, workspace, dt);     // (34), (33)

  if (model.numerics.update_order == UpdateOrder::StressLast) {
    clear_grid(workspace);
    map_mass_and_momentum(model, state, workspace);              // (28) of the new velocities from the old places
    fold_momentum(workspace);
    nodal_velocities(workspace);
    set_rigid_velocities(model, workspace, false);
    set_lagrangian_velocities(workspace);
    if (contact) start_contact(model, state, workspace, dt, StartUse::Strain);  // (23)-(25), for the strain alone
    hold_clamps(state, workspace);
    drive_nodes(state, workspace);
    unfold_velocity(workspace);
  }
  if (!stress_first) update_stress(model, state, workspace, dt); // (29), (30), stress; moves the particles (33)
  finish_rigid_step(model, state, workspace, dt);
  finish_lagrangian_step(model, state, workspace, dt);
  keep_resting(model, state, workspace);

  state.time += dt;
  state.last_time_step = dt;
  ++state.steps;
  state.particle_steps += state.particle_count();
  state.resting_particle_steps += workspace.resting.skipped_particles;
  check_speeds(model, state);
  state.stable_time_step = stable_time_step(model, state, workspace);  // (35)
}

namespace {

KernelParticles particles_of(State& state, Workspace& workspace, const GroupLinks& link) {
  KernelParticles particles = kernel_particles(workspace.particles_of(state, link.body));
  if (!workspace.displacement.empty()) particles.displacement = workspace.displacement[link.body].data();
  return particles;
}

void clear_grid(Workspace& workspace) {
  workspace.slot_parts.for_each([&](std::int64_t s) {
    if (workspace.slots[s].idle) return;
    // Sizes that the compiler knows take no call.
    void* const first = &workspace.nodes[s * block_nodes];
    if (workspace.nodes_in_use == block_nodes)
      std::memset(first, 0, block_nodes * sizeof(NodeRecord));
    else
      std::memset(first, 0, layer_nodes * sizeof(NodeRecord));
  });
}

void clear_contacts(Workspace& workspace) {
  if (!workspace.contacts.empty())
    std::memset(static_cast<void*>(workspace.contacts.data()), 0, workspace.contacts.size() * sizeof(ContactRecord));
  std::fill(workspace.occupied.begin(), workspace.occupied.end(), std::uint8_t{0});
}

void map_mass_and_momentum(const Model& model, State& state, Workspace& workspace) {
  const auto& maps = workspace.kernels->map_momentum[static_cast<int>(model.numerics.shape_function)];
  for_groups_in_order(workspace, [&](const GroupLinks& link, std::int32_t) {
    if (link.guided && !link.contact) return;  // only contact asks for a rigid body's nodes
    const auto map = maps[model.numerics.affine() && !link.guided];
    map(kernel_group(model, state, workspace, link, 0), particles_of(state, workspace, link));
  });
}

void map_contact_sums(const Model& model, State& state, Workspace& workspace) {
  if (workspace.contacts.empty()) return;
  const auto map = workspace.kernels->map_contact[static_cast<int>(model.numerics.shape_function)];
  for_groups_in_order(workspace, [&](const GroupLinks& link, std::int32_t) {
    if (link.contact) map(kernel_group(model, state, workspace, link, 0), particles_of(state, workspace, link));
    if (link.contact && workspace.contact_needs.occupied) mark_occupied(model, state, workspace, link);
  });
  if (workspace.contact_needs.occupied) fold_occupied(workspace);
}

// For methods that look at the normal traction.
void map_contact_stress(const Model& model, State& state, Workspace& workspace) {
  if (workspace.contact_stress.empty()) return;
  std::memset(static_cast<void*>(workspace.contact_stress.data()), 0,
              workspace.contact_stress.size() * sizeof(ContactStress));
  const auto map = workspace.kernels->optional->map_contact_stress[static_cast<int>(model.numerics.shape_function)];
  for_groups_in_order(workspace, [&](const GroupLinks& link, std::int32_t) {
    if (!link.contact || workspace.particles_of(state, link.body).stress[0].empty()) return;
    ContactStress* nodes[27];
    for (int i = 0; i < 27; ++i) {
      const std::int32_t contact = link.slot[i] < 0 ? -1 : workspace.slots[link.slot[i]].contact;
      nodes[i] = contact < 0 ? nullptr : &workspace.contact_stress[static_cast<std::size_t>(contact) * block_nodes];
    }
    map(kernel_group(model, state, workspace, link, 0), particles_of(state, workspace, link), nodes);
  });
  fold_contact_stress(workspace);
}

std::array<NodeRecord*, 27> filter_of(Workspace& workspace, const GroupLinks& link) {
  std::array<NodeRecord*, 27> nodes;
  for (int i = 0; i < 27; ++i)
    nodes[i] = link.slot[i] < 0 ? nullptr : &workspace.filter[static_cast<std::size_t>(link.slot[i]) * block_nodes];
  return nodes;
}

// XPIC(k), see transfer/xpic.hpp. With Q the pass to the particles and back to the grid, v_r = Q^(r-1) v_1 and
// v* = sum_r (-1)^(r+1) C(k, r) Q^(r-1) v_1 = sum_{j=0..k-1} (1 - Q)^j v_1, so that k - 1 times v* <- v_1 + (1 - Q) v*.
void filter_velocities(const Model& model, State& state, Workspace& workspace) {
  for_nodes(workspace, [&](std::int64_t i) {
    for (int c = 0; c < 4; ++c) workspace.filter[i].f[c] = 0;
    for (int c = 0; c < 3; ++c) workspace.filter[i].v[c] = workspace.nodes[i].v[3] > 0 ? workspace.nodes[i].v[c] : 0;
    workspace.filter[i].v[3] = 0;
  });
  hold_filter(workspace);
  unfold_filter(workspace);
  const auto pass = workspace.kernels->optional->filter_velocity[static_cast<int>(model.numerics.shape_function)];
  for (int r = 1; r < model.numerics.xpic_order; ++r) {
    for_groups_in_order(workspace, [&](const GroupLinks& link, std::int32_t) {
      if (link.guided) return;
      const auto filter = filter_of(workspace, link);
      NodeRecord* nodes[27];
      std::copy(filter.begin(), filter.end(), nodes);
      pass(kernel_group(model, state, workspace, link, 0), particles_of(state, workspace, link), nodes);
    });
    fold_filter(workspace);
    for_nodes(workspace, [&](std::int64_t i) {
      NodeRecord& filter = workspace.filter[i];
      const NodeRecord& node = workspace.nodes[i];
      for (int c = 0; c < 3; ++c) {
        if (node.v[3] > 0) filter.v[c] += node.v[c] - filter.f[c] / node.v[3];
        filter.f[c] = 0;
      }
    });
    hold_filter(workspace);
    unfold_filter(workspace);
  }
  workspace.filter_momentum = {};
  if (workspace.faces.empty() && workspace.clamped_nodes.empty()) return;
  for (std::size_t s = 0; s < workspace.slots.size(); ++s) {
    if (workspace.slots[s].guided()) continue;
    for (std::size_t i = s * block_nodes; i < s * block_nodes + static_cast<std::size_t>(workspace.nodes_in_use); ++i)
      for (int c = 0; c < 3; ++c)
        workspace.filter_momentum[c] += workspace.nodes[i].v[3] * (workspace.filter[i].v[c] - workspace.nodes[i].v[c]);
  }
}

// The particles of XPIC are to have S (v* + end - mapped), whatever the first phase of contact kept from others.
void filtered_velocities(Workspace& workspace) {
  if (!workspace.contact_needs.start_kept) return;
  for (std::size_t i = 0; i < workspace.mixed.size(); ++i)
    for (const ContactNode& node : workspace.block_contacts[i].nodes)
      for (int f = node.first_field; f < node.first_field + node.fields; ++f) {
        const ContactField& field = workspace.block_contacts[i].fields[f];
        if (field.slot < 0) continue;
        double* star = workspace.filter[static_cast<std::size_t>(field.slot) * block_nodes + node.node].v;
        for (int c = 0; c < 3; ++c) star[c] -= field.kept[c];
      }
  for (const ContactPoints::Start& start : workspace.points.start)
    for (int c = 0; c < 3; ++c) workspace.filter[start.node].v[c] -= start.kept[c];
  unfold_filter(workspace);
}

// Momentum to velocity. There is no mass cut-off: a node with ever so little mass has a force in proportion, and dropping
// it would lose momentum.
void nodal_velocities(Workspace& workspace) {
  for_nodes(workspace, [&](std::int64_t i) {
    NodeRecord& node = workspace.nodes[i];
    if (!(node.v[3] > 0)) return;
    const double inverse = 1.0 / node.v[3];
    for (int c = 0; c < 3; ++c) node.v[c] *= inverse;
  });
}

void map_internal_force(const Model& model, State& state, Workspace& workspace, double dt) {
  const auto map = workspace.kernels->map_internal_force[static_cast<int>(model.numerics.shape_function)];
  for_groups_in_order(workspace, [&](const GroupLinks& link, std::int32_t) {
    if (link.guided) return;
    map(kernel_group(model, state, workspace, link, dt), particles_of(state, workspace, link));
  });
}

void update_stress(const Model& model, State& state, Workspace& workspace, double dt) {
  const int shape = static_cast<int>(model.numerics.shape_function);
  for_groups_in_order(workspace, [&](const GroupLinks& link, std::int32_t index) {
    if (link.guided) return;
    const Material& material = model.material_of(link.body);
    workspace.kernels->update_stress[shape][static_cast<int>(material.strength)][static_cast<int>(material.eos)](
        kernel_group(model, state, workspace, link, dt), particles_of(state, workspace, link),
        workspace.materials[link.body], workspace.stress_sums[index]);
  });
  book_stress(model, state, workspace, dt);
}

// In an axisymmetric model the sum of the radial momenta, which is no momentum of the whole body, is changed by the hoop
// stress. It is the sum of the internal forces along x, as all others of theirs vanish; the axis is held to give it.
void book_hoop_force(const Model& model, State& state, const Workspace& workspace, double dt) {
  if (!model.grid.axisymmetric()) return;
  double force = 0;
  for (std::size_t s = 0; s < workspace.slots.size(); ++s) {
    if (workspace.slots[s].guided()) continue;
    double part = 0;
    for (int n = 0; n < workspace.nodes_in_use; ++n) part += workspace.nodes[s * block_nodes + n].f[0];
    force += part;
  }
  state.ledger.boundary_impulse[0] += force * dt;
}

bool any_loads(const Model& model, const State& state) {
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    if (particles_loaded(model, state, static_cast<int>(b))) return true;
  return false;
}

void map_external_force(const Model& model, State& state, Workspace& workspace) {
  for (LoadState& load : state.loads) load.force = {};
  if (!any_loads(model, state)) return;
  for_groups_in_order(workspace, [&](const GroupLinks& link, std::int32_t index) {
    if (!link.guided && particles_loaded(model, state, link.body)) map_loads(model, state, workspace, index);
  });
}

void measure_external_force(const Model& model, State& state, Workspace& workspace, double dt) {
  if (!any_loads(model, state)) return;
  for_groups_in_order(workspace, [&](const GroupLinks& link, std::int32_t index) {
    if (!link.guided && particles_loaded(model, state, link.body)) measure_loads(model, state, workspace, index, dt);
  });
  book_loads(model, state, workspace, dt);
}

// From {velocity at the beginning, mass | velocity at the end} to {velocity at the end, 0 | acceleration, 0}, which is what
// (33) and (34) interpolate. The fourth components must vanish: particle records carry mass and 1 there.
//
// Transfer dissipation. The grid gains sum m_I v_I . dv_I. With FLIP that is what the particles gain, sum m_p v_p . dv_p. With
// affine velocities the rest goes into theirs, m h^2/4 C_p : dC_p, dC_p being the affine part of the increments; but C_p is
// made anew from the grid, so that of m h^2/8 (|C_p|^2 + 2 C_p : dC_p + |dC_p|^2) only the energy of the new C_p remains. The
// loss is taken at the time of the stress, half a step before that of the velocities (docs/theory.md, section 10).
// The first sum is booked here, those over particles in the next phase.
void accelerations(State& state, Workspace& workspace, double dt) {
  const double inverse = 1.0 / dt;
  workspace.slot_parts.for_each([&](std::int64_t s) {
    double given = 0;
    workspace.slot_given[s] = 0;
    if (workspace.slots[s].guided() || workspace.slots[s].idle) return;
    for (std::int64_t i = s * block_nodes; i < s * block_nodes + workspace.nodes_in_use; ++i) {
      NodeRecord& node = workspace.nodes[i];
      for (int c = 0; c < 3; ++c) {
        const double start = node.v[c], end = node.f[c];
        given += node.v[3] * start * (end - start);
        node.f[c] = (end - start) * inverse;
        node.v[c] = end;
      }
      node.v[3] = node.f[3] = 0;
    }
    workspace.slot_given[s] = given;
  });
  for (const double given : workspace.slot_given) state.ledger.transfer_dissipation += given;
}

void update_velocity_and_position(const Model& model, State& state, Workspace& workspace, double dt) {
  const int shape = static_cast<int>(model.numerics.shape_function);
  const bool xpic = model.numerics.transfer == Transfer::Xpic;
  const auto update = workspace.kernels->update_particles[shape][model.numerics.affine()];
  const auto update_xpic = workspace.kernels->optional->update_particles_xpic[shape];
  std::fill(workspace.move_sums.begin(), workspace.move_sums.end(), MoveSums{});
  for_groups(workspace, [&](const GroupLinks& link, std::int32_t l) {
    if (link.guided) return;
    if (xpic) {
      const auto filter = filter_of(workspace, link);
      NodeRecord* nodes[27];
      std::copy(filter.begin(), filter.end(), nodes);
      update_xpic(kernel_group(model, state, workspace, link, dt), particles_of(state, workspace, link), nodes,
                  workspace.move_sums[l]);
      return;
    }
    update(kernel_group(model, state, workspace, link, dt), particles_of(state, workspace, link), workspace.move_sums[l]);
  });
  for (BodyState& body : state.bodies) body.totals.maximum_speed = 0;
  for (std::size_t l = 0; l < workspace.links.size(); ++l) {
    BodyState& body = state.bodies[workspace.links[l].body];
    const MoveSums& sums = workspace.move_sums[l];
    body.drifted = body.drifted || sums.outside;
    body.totals.maximum_speed = std::max(body.totals.maximum_speed, std::sqrt(sums.speed_squared));
    state.ledger.transfer_dissipation -= sums.taken_up;
  }
  for (BodyState& body : state.bodies)
    body.totals.maximum_speed_ever = std::max(body.totals.maximum_speed_ever, body.totals.maximum_speed);
}

}  // namespace

void prepare_state(const Model& model, State& state, Workspace& workspace) {
  workspace.kernels = model.grid.planar() ? kernel_table().planar : &kernel_table();
  workspace.nodes_in_use = model.grid.planar() ? layer_nodes : block_nodes;
  workspace.materials.clear();
  for (const Body& body : model.bodies)
    workspace.materials.push_back(kernel_material(model.materials[body.material], model.grid.cell_size));
  workspace.contact_needs = contact_needs(model);
  prepare_surfaces(model, workspace);
  bool fresh = false;
  for (const BodyState& body : state.bodies) fresh = fresh || (body.groups.empty() && body.particles > 0);
  prepare_lagrangian(model, state, workspace, fresh);
  for (std::size_t b = 0; b < state.bodies.size(); ++b) allocate_transfer(model, static_cast<int>(b), state.bodies[b]);
  if (fresh) {
    prepare_rigid(model, state);
    for (std::size_t b = 0; b < state.bodies.size(); ++b)
      if (!model.bodies[b].rigid() && model.bodies[b].has_surface())
        state.bodies[b].surface_vertices = model.bodies[b].surface.vertices;
    bin_particles(model, state, workspace, true);
  }
  link_grid(model, state, workspace);
  prepare_resting(model, state, workspace, fresh);
  if (state.stable_time_step == 0) state.stable_time_step = initial_time_step(model, state, workspace);
}

}  // namespace ogive
