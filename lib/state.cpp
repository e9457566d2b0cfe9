// Storage and saving of the state.
#include "state.hpp"

#include <algorithm>

#include "archive.hpp"
#include "breakdown.hpp"
#include "error.hpp"

namespace ogive {

std::int64_t State::particle_count() const {
  std::int64_t n = 0;
  for (const BodyState& body : bodies) n += body.particles;
  return n;
}

std::int64_t State::memory_bytes() const {
  std::int64_t total = 0;
  const auto bytes = [](const auto& v) { return static_cast<std::int64_t>(v.capacity() * sizeof(v[0])); };
  for (const BodyState& body : bodies) {
    total += bytes(body.position) + bytes(body.velocity) + bytes(body.affine) + bytes(body.volume_ratio) +
             bytes(body.energy) + bytes(body.viscous_pressure) +
             bytes(body.plastic_strain) + bytes(body.yield_stress) + bytes(body.temperature) + bytes(body.number) +
             bytes(body.loads) + bytes(body.force) + bytes(body.groups) + bytes(body.surface_vertices);
    for (const auto& c : body.stress) total += bytes(c);
    for (const auto& c : body.deformation) total += bytes(c);
    for (const auto& c : body.history) total += bytes(c);
    const ReferenceState& reference = body.reference;
    total += bytes(reference.position) + bytes(reference.node_position) + bytes(reference.node_velocity) +
             bytes(reference.node_force);
  }
  for (const BodyState& copy : copies)
    total += bytes(copy.position) + bytes(copy.velocity) + bytes(copy.volume_ratio) + bytes(copy.number) + bytes(copy.groups);
  return total;
}

void allocate_particles(const Material& material, const Body& rules, std::int64_t padded, BodyState& body) {
  const std::size_t n = static_cast<std::size_t>(padded);
  body.padded = padded;
  body.position.assign(4 * n, 0.0);
  body.velocity.assign(4 * n, 0.0);
  body.volume_ratio.assign(n, 1.0);
  body.energy.assign(n, 0.0);
  body.number.assign(n, -1);
  if (rules.rigid()) return;
  for (auto& c : body.stress) c.assign(n, 0.0);
  if (material.plastic()) {
    body.plastic_strain.assign(n, 0.0);
    body.yield_stress.assign(n, material.yield_stress);
  }
  if (material.thermal()) body.temperature.assign(n, material.room_temperature);
  if (material.hyperelastic() || rules.total_lagrangian())
    for (int c = 0; c < 9; ++c) body.deformation[c].assign(n, c % 4 == 0 ? 1.0 : 0.0);
  for (int c = 0; c < material.history_size(); ++c) body.history[c].assign(n, initial_history(material, c));
}

double initial_history(const Material& material, int component) {
  return material.strength == Strength::J2Multiplicative && component < 9 && component % 4 == 0 ? 1.0 : 0.0;
}

void allocate_transfer(const Model& model, int index, BodyState& body) {
  if (model.bodies[index].rigid() || body.lagrangian) return;
  const Material& material = model.material_of(index);
  const std::size_t n = static_cast<std::size_t>(body.padded);
  if (model.numerics.affine() && body.affine.empty()) {
    body.affine.assign(affine_size * n, 0.0);
    const Vector3& w = body.initial_spin;
    const double field[affine_size] = {0, w[2], -w[1], -w[2], 0, w[0], w[1], -w[0], 0};
    for (std::size_t i = 0; i < body.affine.size(); ++i) body.affine[i] = field[i % affine_size];
  }
  if (!model.numerics.stress_first() && material.viscous() && body.viscous_pressure.empty())
    body.viscous_pressure.assign(n, 0.0);
}

// Version 1 kept a particle's affine velocity in three records of four doubles.
static void exchange_old_affine(Archive& a, const std::string& name, AlignedVector<double>& affine, std::int64_t particles) {
  AlignedVector<double> records;
  a.sized(name, records, 12 * particles);
  affine.resize(static_cast<std::size_t>(affine_size * particles));
  for (std::size_t i = 0; i < affine.size(); ++i) affine[i] = records[i / 3 * 4 + i % 3];
}

// Nodes at which a pair pushed in the last step: five whole numbers each.
static void exchange_contact_memory(State& state, Archive& a) {
  std::vector<std::int64_t> memory;
  for (const PressedPair& pair : state.contact_memory)
    memory.insert(memory.end(), {pair.node[0], pair.node[1], pair.node[2], pair.a, pair.b});
  a.resizable("state/contact_memory", memory, std::int64_t{5} << 30);
  if (!a.loading()) return;
  if (memory.size() % 5 != 0)
    throw Error(ErrorKind::Format,
                "state/contact_memory: expected a multiple of 5 numbers, found " + std::to_string(memory.size()));
  for (std::size_t i = 0; i < memory.size(); i += 5) {
    const auto part = [&](std::size_t k) { return static_cast<std::int32_t>(memory[i + k]); };
    state.contact_memory.push_back({{part(0), part(1), part(2)}, part(3), part(4)});
  }
  order_memory(state.contact_memory);
}

// Pairs that have met: two whole numbers and eight others each.
static void exchange_pairs(State& state, Archive& a) {
  std::vector<std::int32_t> bodies;
  std::vector<double> sums;
  if (!a.loading())
    for (const PairTotals& pair : state.pairs) {
      bodies.insert(bodies.end(), {pair.a, pair.b});
      sums.insert(sums.end(), {pair.force[0], pair.force[1], pair.force[2], pair.impulse[0], pair.impulse[1],
                               pair.impulse[2], pair.friction_dissipation, pair.contact_work});
    }
  a.resizable("state/pairs/bodies", bodies, std::int64_t{1} << 28);
  a.sized("state/pairs/sums", sums, 4 * static_cast<std::int64_t>(bodies.size()));
  if (!a.loading()) return;
  const std::int32_t count = static_cast<std::int32_t>(state.bodies.size());
  for (std::size_t i = 0; i + 2 <= bodies.size(); i += 2) {
    PairTotals pair;
    pair.a = bodies[i];
    pair.b = bodies[i + 1];
    const double* s = &sums[4 * i];
    pair.force = {s[0], s[1], s[2]};
    pair.impulse = {s[3], s[4], s[5]};
    pair.friction_dissipation = s[6];
    pair.contact_work = s[7];
    const bool ordered = state.pairs.empty() || state.pairs.back().a < pair.a ||
                         (state.pairs.back().a == pair.a && state.pairs.back().b < pair.b);
    if (!ordered || pair.a < 0 || pair.a >= pair.b || pair.b >= count)
      throw Error(ErrorKind::Format, "state/pairs/bodies: pair " + std::to_string(i / 2) + " is not consistent");
    state.pairs.push_back(pair);
  }
  if (bodies.size() % 2 != 0) throw Error(ErrorKind::Format, "state/pairs/bodies: expected an even count");
}

// Groups: eleven whole numbers each.
static void exchange_groups(Archive& a, const std::string& at, BodyState& body) {
  std::vector<std::int64_t> groups;
  if (!a.loading())
    for (const Group& g : body.groups) {
      groups.insert(groups.end(), {g.block[0], g.block[1], g.block[2], g.begin, g.count});
      groups.insert(groups.end(), {g.low[0], g.low[1], g.low[2], g.high[0], g.high[1], g.high[2]});
    }
  a.resizable(at + "groups", groups, std::int64_t{11} << 28);
  if (a.loading()) {
    if (groups.size() % 11 != 0)
      throw Error(ErrorKind::Format, at + "groups: expected a multiple of 11 numbers, found " +
                                         std::to_string(groups.size()));
    body.particles = body.padded = 0;
    for (std::size_t i = 0; i < groups.size(); i += 11) {
      Group g;
      bool good = groups[i + 3] == body.padded && groups[i + 4] > 0 && groups[i + 4] < (std::int64_t{1} << 31);
      g.begin = groups[i + 3];
      g.count = static_cast<std::int32_t>(groups[i + 4]);
      for (int axis = 0; axis < 3; ++axis) {
        g.block[axis] = static_cast<std::int32_t>(groups[i + axis]);
        g.low[axis] = static_cast<std::int32_t>(groups[i + 5 + axis]);
        g.high[axis] = static_cast<std::int32_t>(groups[i + 8 + axis]);
        good = good && std::abs(groups[i + axis]) <= 32000 && g.low[axis] >= 0 && g.low[axis] <= g.high[axis] &&
               g.high[axis] < block_cells;
      }
      if (!good) throw Error(ErrorKind::Format, at + "groups: group " + std::to_string(i / 11) + " is not consistent");
      body.particles += g.count;
      body.padded = g.padded_end();
      body.groups.push_back(g);
    }
  }
}

// Which groups are at rest. Older saves do not tell: all may be, as their particles are looked at in any case.
static void exchange_resting(Archive& a, const std::string& at, BodyState& body) {
  std::vector<std::uint8_t> resting(body.groups.size(), 1);
  if (!a.loading())
    for (std::size_t g = 0; g < resting.size(); ++g) resting[g] = body.groups[g].resting;
  if (a.version() >= 4) a.sized(at + "resting", resting, static_cast<std::int64_t>(resting.size()));
  for (std::size_t g = 0; g < resting.size() && a.loading(); ++g) body.groups[g].resting = resting[g] != 0;
}

static void exchange_reference(State& state, std::size_t b, Archive& a) {
  BodyState& body = state.bodies[b];
  ReferenceState& reference = body.reference;
  const std::string at = "state/bodies/" + std::to_string(b) + "/reference/";
  a.sized(at + "position", reference.position, 4 * body.padded);
  a.value(at + "critical_length", reference.critical_length);
  a.value(at + "kinetic", reference.kinetic);
  a.value(at + "angular_momentum", reference.angular_momentum);
  a.value(at + "distorted", reference.distorted);
  a.resizable(at + "node_position", reference.node_position, std::int64_t{1} << 33);
  const std::int64_t size = static_cast<std::int64_t>(reference.node_position.size());
  a.sized(at + "node_velocity", reference.node_velocity, size);
  a.sized(at + "node_force", reference.node_force, size);
  BodyState& copy = state.copies[b];
  exchange_groups(a, at + "copy_", copy);
  a.sized(at + "copy_number", copy.number, copy.padded);
  a.value(at + "copy_drifted", copy.drifted);
  for (const std::int32_t n : copy.number)
    if (n < -1 || n >= body.padded)
      throw Error(ErrorKind::Format, at + "copy_number: expected -1.." + std::to_string(body.padded - 1) + ", found " +
                                         std::to_string(n));
}

// Memory of the condition that the energy exchange has ended.
static void exchange_energies(State& state, Archive& a) {
  ExchangeState& memory = state.stop.exchange;
  const std::string at = "state/stop/exchange/";
  a.value(at + "time", memory.time);
  a.value(at + "internal", memory.internal);
  a.value(at + "dissipated", memory.dissipated);
  a.value(at + "begun", memory.begun);
  const std::int64_t bodies = static_cast<std::int64_t>(state.bodies.size());
  a.resizable(at + "kinetic", memory.kinetic, bodies);
  if (!memory.kinetic.empty() && static_cast<std::int64_t>(memory.kinetic.size()) != bodies)
    throw Error(ErrorKind::Format, at + "kinetic: expected none or " + std::to_string(bodies) + " values, found " +
                                       std::to_string(memory.kinetic.size()));
}

void State::exchange(const Model& model, Archive& a) {
  if (a.loading()) bodies.assign(model.bodies.size(), BodyState{});
  copies.resize(bodies.size());
  a.value("state/time", time);
  a.value("state/last_time_step", last_time_step);
  a.value("state/stable_time_step", stable_time_step);
  a.value("state/steps", steps);
  a.value("state/particle_steps", particle_steps);
  if (a.version() >= 4) a.value("state/resting_particle_steps", resting_particle_steps);
  a.value("state/stop/reference_time", stop.reference_time);
  a.value("state/stop/reference_speed", stop.reference_speed);
  a.value("state/stop/slowed", stop.slowed);
  a.value("state/stop/reason", stop.reason);
  if (a.version() >= 4) exchange_energies(*this, a);
  a.value("state/ledger/friction_dissipation", ledger.friction_dissipation);
  a.value("state/ledger/transfer_dissipation", ledger.transfer_dissipation);
  a.value("state/ledger/contact_work", ledger.contact_work);
  a.value("state/ledger/boundary_work", ledger.boundary_work);
  if (a.version() < 6) ledger.boundary_work = 0;  // was no term of the sum: what is lost by then stays in the residual
  a.value("state/ledger/external_work", ledger.external_work);
  a.value("state/ledger/boundary_impulse", ledger.boundary_impulse);
  a.value("state/ledger/external_impulse", ledger.external_impulse);
  a.value("state/ledger/initial_total", ledger.initial_total);

  if (a.version() >= 3) {
    a.value("state/energy_watch/from_host", energy_watch.from_host);
    a.value("state/energy_watch/largest_work", energy_watch.largest_work);
    a.value("state/energy_watch/largest_growth", energy_watch.largest_growth);
    a.value("state/energy_watch/largest_growth_time", energy_watch.largest_growth_time);
    a.value("state/energy_watch/warning_time", energy_watch.warning_time);
  }
  if (a.version() >= 2) {
    a.value("state/ledger/prescribed_work", ledger.prescribed_work);
    a.value("state/ledger/contact_couple", ledger.contact_couple);
    if (a.loading()) loads.assign(model.loads.size(), LoadState{});
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const std::string at = "state/loads/" + std::to_string(i) + "/";
      a.value(at + "value", loads[i].value);
      a.value(at + "mass", loads[i].mass);
      a.value(at + "force", loads[i].force);
      a.value(at + "impulse", loads[i].impulse);
      a.value(at + "work", loads[i].work);
    }
    exchange_pairs(*this, a);
    exchange_contact_memory(*this, a);
  }
  if (a.version() >= 3) a.value("state/ledger/contact_dissipation", ledger.contact_dissipation);

  for (std::size_t b = 0; b < bodies.size(); ++b) {
    BodyState& body = bodies[b];
    const bool rigid = model.bodies[b].rigid(), total_lagrangian = model.bodies[b].total_lagrangian();
    if (total_lagrangian) a.value("state/bodies/" + std::to_string(b) + "/lagrangian", body.lagrangian);
    const Material& material = model.material_of(static_cast<int>(b));
    const std::string at = "state/bodies/" + std::to_string(b) + "/";
    BodyTotals& t = body.totals;
    a.value(at + "failed_particles", t.failed_particles);
    a.value(at + "failed_mass", t.failed_mass);
    a.value(at + "first_failure_time", t.first_failure_time);
    a.value(at + "failure_loss", t.failure_loss);
    const auto departed = [&](const std::string& how, Departed& d) {
      a.value(at + how + "_particles", d.particles);
      a.value(at + how + "_mass", d.mass);
      a.value(at + how + "_energy", d.energy);
      a.value(at + how + "_momentum", d.momentum);
    };
    departed("left", t.left);
    if (a.version() >= 4) {
      departed("dropped", t.dropped);
      a.value(at + "dropped_angular_momentum", t.dropped_angular_momentum);
    }
    a.value(at + "plastic_dissipation", t.plastic_dissipation);
    a.value(at + "viscous_dissipation", t.viscous_dissipation);
    a.value(at + "contact_force", t.contact_force);
    a.value(at + "initial_velocity", t.initial_velocity);
    a.value(at + "maximum_speed", t.maximum_speed);
    a.value(at + "maximum_speed_ever", t.maximum_speed_ever);
    a.value(at + "drifted", body.drifted);
    if (rigid) {
      a.value(at + "rigid/centre", body.rigid.centre);
      a.value(at + "rigid/velocity", body.rigid.velocity);
      a.value(at + "rigid/spin", body.rigid.spin);
      if (model.bodies[b].surface.given()) {
        const char* const names[] = {"rigid/turn_x", "rigid/turn_y", "rigid/turn_z"};
        for (int k = 0; k < 3; ++k) a.value(at + names[k], body.rigid.turn[k]);
        a.value(at + "rigid/shift", body.rigid.shift);
      }
    }

    exchange_groups(a, at, body);
    exchange_resting(a, at, body);
    if (!rigid && model.bodies[b].has_surface())
      a.sized(at + "surface_vertices", body.surface_vertices,
              static_cast<std::int64_t>(model.bodies[b].surface.vertices.size()));
    const std::int64_t n = body.padded;
    a.sized(at + "position", body.position, 4 * n);
    a.sized(at + "velocity", body.velocity, 4 * n);
    static const char* const component[] = {"xx", "yy", "zz", "yz", "xz", "xy"};
    a.sized(at + "volume_ratio", body.volume_ratio, n);
    a.sized(at + "energy", body.energy, n);
    for (int c = 0; c < 6 && !rigid; ++c) a.sized(at + "stress_" + component[c], body.stress[c], n);
    if (!rigid && material.plastic()) {
      a.sized(at + "plastic_strain", body.plastic_strain, n);
      a.sized(at + "yield_stress", body.yield_stress, n);
    }
    if (!rigid && material.thermal()) a.sized(at + "temperature", body.temperature, n);
    if (!rigid && (material.hyperelastic() || body.lagrangian))
      for (int c = 0; c < 9; ++c) a.sized(at + "deformation_" + std::to_string(c), body.deformation[c], n);
    for (int c = 0; c < material.history_size() && !rigid; ++c)
      a.sized(at + "history_" + std::to_string(c), body.history[c], n);
    if (body.lagrangian) exchange_reference(*this, b, a);
    const bool by_grid = !rigid && !body.lagrangian;
    if (by_grid && model.numerics.affine() && a.version() == 1) {
      exchange_old_affine(a, at + "affine", body.affine, n);
    } else if (by_grid && model.numerics.affine()) {
      a.sized(at + "affine", body.affine, affine_size * n);
    }
    if (by_grid && !model.numerics.stress_first() && material.viscous())
      a.sized(at + "viscous_pressure", body.viscous_pressure, n);
    a.sized(at + "number", body.number, n);
    if (a.version() >= 2) {
      bool loaded = false;
      for (const Load& load : model.loads)
        loaded = loaded || (load.on_particles() && load.acts_on(static_cast<int>(b)));
      if (loaded) a.sized(at + "loads", body.loads, n);
      bool forced = !body.force.empty();
      a.value(at + "forced", forced);
      if (forced) a.sized(at + "force", body.force, 4 * n);
    }
    if (a.loading()) {
      // Positions must lie where the groups say, or the tiles would be left: the bounds are those of the drift limit.
      const double h = model.grid.cell_size;
      const AlignedVector<double>& place = body.lagrangian ? body.reference.position : body.position;
      for (const Group& g : body.groups)
        for (std::int64_t p = g.begin; p < g.padded_end() && !body.drifted; ++p)
          for (int axis = 0; axis < 3; ++axis) {
            const double cell = (place[4 * p + axis] - model.grid.domain_min[axis]) / h - 4.0 * g.block[axis];
            if (!(cell > g.low[axis] - 0.5 && cell < g.high[axis] + 1.5))
              throw Error(ErrorKind::Format, at + "position: particle " + std::to_string(p) + " is outside its group");
          }
      if (model.grid.axisymmetric())
        for (std::int64_t p = 0; p < n; ++p)
          if (!(body.position[4 * p] > 0))
            throw Error(ErrorKind::Format, at + "position: particle " + std::to_string(p) + " must have a radius > 0, found " +
                                               std::to_string(body.position[4 * p]));
    }
  }
  if (a.loading() && !(stable_time_step > 0))
    throw Error(ErrorKind::Format, "state/stable_time_step: must be > 0, found " + std::to_string(stable_time_step));
  if (a.loading()) require_sound(model, *this);
}

}  // namespace ogive
