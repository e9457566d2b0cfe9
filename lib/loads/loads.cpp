// Loads on particles.
#include "loads/loads.hpp"

#include "shape/scalar_weights.hpp"

namespace ogive {
namespace {

// Places of a body's particles on the grid.
const AlignedVector<double>& places(const Workspace& workspace, const BodyState& body) {
  return workspace.is_reference ? body.reference.position : body.position;
}

// Force per mass of the body's loads on particles, in the order of their bits.
struct BodyLoads {
  int count = 0;
  std::array<int, most_particle_loads> load{};
  std::array<Vector3, most_particle_loads> per_mass{};
};

BodyLoads loads_of(const Model& model, const State& state, int body) {
  BodyLoads found;
  for (int i = 0; i < static_cast<int>(model.loads.size()); ++i) {
    const Load& load = model.loads[i];
    if (!load.on_particles() || !load.acts_on(body)) continue;
    Vector3& per_mass = found.per_mass[found.count];
    const double factor = load.kind == LoadKind::Traction ? load.area / state.loads[i].mass : 1.0;
    for (int c = 0; c < 3; ++c) per_mass[c] = factor * state.loads[i].value[c];
    found.load[found.count++] = i;
  }
  return found;
}

int count_loads(const Model& model, int body) {
  int count = 0;
  for (const Load& load : model.loads) count += load.on_particles() && load.acts_on(body);
  return count;
}

}  // namespace

bool particles_loaded(const Model& model, const State& state, int body) {
  return !model.bodies[body].rigid() && (!state.bodies[body].loads.empty() || !state.bodies[body].force.empty());
}

void select_loaded_particles(const Model& model, State& state) {
  for (LoadState& load : state.loads) load.mass = 0;
  for (int b = 0; b < static_cast<int>(state.bodies.size()); ++b) {
    BodyState& body = state.bodies[b];
    if (count_loads(model, b) == 0) continue;
    body.loads.assign(static_cast<std::size_t>(body.padded), 0);
    int bit = 0;
    for (std::size_t i = 0; i < model.loads.size(); ++i) {
      const Load& load = model.loads[i];
      if (!load.on_particles() || !load.acts_on(b)) continue;
      for (std::int64_t p = 0; p < body.padded; ++p) {
        const double* x = &body.position[4 * p];
        if (!load.contains({x[0], x[1], x[2]})) continue;
        body.loads[p] |= 1 << bit;
        state.loads[i].mass += x[3];
      }
      ++bit;
    }
  }
}

void allocate_load_sums(const Model& model, const State& state, Workspace& workspace) {
  std::vector<std::int32_t> size(state.bodies.size(), 0);
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    if (particles_loaded(model, state, static_cast<int>(b))) size[b] = count_loads(model, static_cast<int>(b)) + 1;
  std::int32_t next = 0;
  for (GroupLinks& link : workspace.links) {
    link.first_load_sum = next;
    next += size[link.body];
  }
  workspace.load_sums.assign(static_cast<std::size_t>(next), {});
}

void map_loads(const Model& model, const State& state, Workspace& workspace, std::int32_t index) {
  const GroupLinks& link = workspace.links[index];
  const BodyState& body = state.bodies[link.body];
  const BodyLoads loads = loads_of(model, state, link.body);
  const Group& group = body.groups[link.group];
  for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
    const double* x = &body.position[4 * p];
    Vector3 force{};
    if (!body.loads.empty())
      for (int k = 0; k < loads.count; ++k)
        if (body.loads[p] >> k & 1)
          for (int c = 0; c < 3; ++c) force[c] += x[3] * loads.per_mass[k][c];
    if (!body.force.empty())
      for (int c = 0; c < 3; ++c) force[c] += body.force[4 * p + c];
    if (force == Vector3{}) continue;
    for_nodes_of(model, link, &places(workspace, body)[4 * p], [&](std::int64_t at, double weight, const Vector3&) {
      NodeRecord& node = workspace.nodes[at];
      for (int c = 0; c < 3; ++c) node.f[c] += weight * force[c];
    });
  }
}

void measure_loads(const Model& model, const State& state, Workspace& workspace, std::int32_t index, double dt) {
  const GroupLinks& link = workspace.links[index];
  const BodyState& body = state.bodies[link.body];
  const BodyLoads loads = loads_of(model, state, link.body);
  const Group& group = body.groups[link.group];
  LoadSums* sums = &workspace.load_sums[static_cast<std::size_t>(link.first_load_sum)];
  for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
    if ((body.loads.empty() || body.loads[p] == 0) && body.force.empty()) continue;
    const double* x = &body.position[4 * p];
    Vector3 mean{};
    for_nodes_of(model, link, &places(workspace, body)[4 * p], [&](std::int64_t at, double weight, const Vector3&) {
      const NodeRecord& node = workspace.nodes[at];
      for (int c = 0; c < 3; ++c) mean[c] += weight * (node.v[c] - 0.5 * dt * node.f[c]);
    });
    const auto add = [&](LoadSums& sum, const Vector3& force) {
      for (int c = 0; c < 3; ++c) {
        sum.force[c] += force[c];
        sum.work += dt * force[c] * mean[c];
      }
    };
    if (!body.loads.empty())
      for (int k = 0; k < loads.count; ++k)
        if (body.loads[p] >> k & 1)
          add(sums[k], {x[3] * loads.per_mass[k][0], x[3] * loads.per_mass[k][1], x[3] * loads.per_mass[k][2]});
    if (!body.force.empty()) add(sums[loads.count], {body.force[4 * p], body.force[4 * p + 1], body.force[4 * p + 2]});
  }
}

void book_loads(const Model& model, State& state, const Workspace& workspace, double dt) {
  for (const GroupLinks& link : workspace.links) {
    if (link.guided || !particles_loaded(model, state, link.body)) continue;
    const BodyLoads loads = loads_of(model, state, link.body);
    for (int k = 0; k <= loads.count; ++k) {
      const LoadSums& sums = workspace.load_sums[static_cast<std::size_t>(link.first_load_sum + k)];
      for (int c = 0; c < 3; ++c) state.ledger.external_impulse[c] += sums.force[c] * dt;
      state.ledger.external_work += sums.work;
      if (k == loads.count) continue;
      LoadState& load = state.loads[loads.load[k]];
      add(load.force, sums.force);
      add(load.impulse, times(dt, sums.force));
      load.work += sums.work;
    }
  }
}

void load_rigid(const Model& model, State& state, RigidMotion& motion, double dt) {
  const BodyState& body = state.bodies[motion.body];
  if (body.loads.empty() && body.force.empty()) return;
  const BodyLoads loads = loads_of(model, state, motion.body);
  std::array<Vector3, most_particle_loads + 1> force{}, moment{};
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
      const double* x = &body.position[4 * p];
      const Vector3 arm = minus({x[0], x[1], x[2]}, motion.centre);
      const auto take = [&](int k, const Vector3& f) {
        add(force[k], f);
        add(moment[k], cross(arm, f));
      };
      if (!body.loads.empty())
        for (int k = 0; k < loads.count; ++k)
          if (body.loads[p] >> k & 1) take(k, times(x[3], loads.per_mass[k]));
      if (!body.force.empty()) take(loads.count, {body.force[4 * p], body.force[4 * p + 1], body.force[4 * p + 2]});
    }
  for (int k = 0; k <= loads.count; ++k) {
    Vector3 impulse = times(dt, force[k]), turn = times(dt, moment[k]);
    const Vector3 velocity = motion.velocity, spin = motion.spin;
    push(motion, impulse, turn);
    const double work = 0.5 * (dot(impulse, plus(velocity, motion.velocity)) + dot(turn, plus(spin, motion.spin)));
    add(state.ledger.external_impulse, impulse);
    state.ledger.external_work += work;
    if (k == loads.count) continue;
    LoadState& load = state.loads[loads.load[k]];
    add(load.force, times(1 / dt, impulse));
    add(load.impulse, impulse);
    load.work += work;
  }
}

}  // namespace ogive
