// Sums over particles and the stop conditions.
#include "audit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "parallel.hpp"

namespace ogive {

double affine_energy(const BodyState& body, std::int64_t p, double cell_size) {
  if (body.affine.empty()) return 0;
  double squared = 0;
  for (int c = 0; c < affine_size; ++c) squared += body.affine[affine_size * p + c] * body.affine[affine_size * p + c];
  return 0.125 * body.position[4 * p + 3] * cell_size * cell_size * squared;
}

Vector3 particle_angular_momentum(const BodyState& body, std::int64_t p, double cell_size) {
  const double* x = &body.position[4 * p];
  const double* v = &body.velocity[4 * p];
  Vector3 sum = times(x[3], cross({x[0], x[1], x[2]}, {v[0], v[1], v[2]}));
  if (body.affine.empty()) return sum;
  const double* C = &body.affine[affine_size * p];
  add(sum, times(0.25 * cell_size * cell_size * x[3], {C[3 + 2] - C[6 + 1], C[6 + 0] - C[0 + 2], C[0 + 1] - C[3 + 0]}));
  return sum;
}

namespace {

// The same of one group.
BodyAudit audit_group(const Model& model, const BodyState& body, int index, const Group& group) {
  const double density = model.material_of(index).density;
  const Body& rules = model.bodies[index];
  BodyAudit part;
  Vector3 lower, upper;
  lower.fill(std::numeric_limits<double>::infinity());
  upper.fill(-std::numeric_limits<double>::infinity());
  const std::int64_t end = group.begin + group.count;
  for (std::int64_t p = group.begin; p < end; ++p) {
    const double* x = &body.position[4 * p];
    const double* v = &body.velocity[4 * p];
    const double mass = x[3];
    part.mass += mass;
    part.kinetic += mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    part.internal += mass * body.energy[p];
    add(part.angular_momentum, times(mass, cross({x[0], x[1], x[2]}, {v[0], v[1], v[2]})));
    for (int c = 0; c < 3; ++c) {
      part.momentum[c] += mass * v[c];
      part.first_moment[c] += mass * x[c];
      lower[c] = x[c] < lower[c] ? x[c] : lower[c];
      upper[c] = x[c] > upper[c] ? x[c] : upper[c];
    }
  }
  part.lower = lower;
  part.upper = upper;
  part.kinetic *= 0.5;
  part.internal /= density;
  if (rules.rigid()) {
    part.kinetic += 0.5 * part.mass * rules.own_inertia * dot(body.rigid.spin, body.rigid.spin);
    add(part.angular_momentum, times(part.mass * rules.own_inertia, body.rigid.spin));
  }
  if (!body.affine.empty()) {
    const double affine_factor = 0.125 * model.grid.cell_size * model.grid.cell_size;
    double sum = 0;
    Vector3 curl{};
    for (std::int64_t p = group.begin; p < end; ++p) {
      const double* C = &body.affine[affine_size * p];
      double rows[3];
      for (int i = 0; i < 3; ++i) rows[i] = C[3 * i] * C[3 * i] + C[3 * i + 1] * C[3 * i + 1] + C[3 * i + 2] * C[3 * i + 2];
      sum += body.position[4 * p + 3] * (rows[0] + rows[1] + rows[2]);
      add(curl, times(body.position[4 * p + 3], {C[3 + 2] - C[6 + 1], C[6 + 0] - C[0 + 2], C[0 + 1] - C[3 + 0]}));
    }
    part.kinetic += affine_factor * sum;
    add(part.angular_momentum, times(2 * affine_factor, curl));
  }
  if (!body.plastic_strain.empty())
    for (std::int64_t p = group.begin; p < end; ++p)
      part.maximum_plastic_strain = std::max(part.maximum_plastic_strain, body.plastic_strain[p]);
  if (!body.temperature.empty())
    for (std::int64_t p = group.begin; p < end; ++p)
      part.maximum_temperature = std::max(part.maximum_temperature, body.temperature[p]);
  return part;
}

}  // namespace

BodyAudit audit_body(const Model& model, const State& state, int index, int threads) {
  const BodyState& body = state.bodies[index];
  // Sums by group first: fewer additions in a row, hence less round-off, and the same bits for any number of threads.
  std::vector<BodyAudit> parts(body.groups.size());
  for_each_in_parts(threads, 0, static_cast<std::int64_t>(parts.size()),
                    [&](std::int64_t g) { parts[g] = audit_group(model, body, index, body.groups[g]); });
  BodyAudit audit;
  if (!parts.empty()) {
    audit.lower = parts[0].lower;
    audit.upper = parts[0].upper;
  }
  for (const BodyAudit& part : parts) {
    audit.mass += part.mass;
    audit.kinetic += part.kinetic;
    audit.internal += part.internal;
    audit.maximum_plastic_strain = std::max(audit.maximum_plastic_strain, part.maximum_plastic_strain);
    audit.maximum_temperature = std::max(audit.maximum_temperature, part.maximum_temperature);
    for (int c = 0; c < 3; ++c) {
      audit.momentum[c] += part.momentum[c];
      audit.angular_momentum[c] += part.angular_momentum[c];
      audit.first_moment[c] += part.first_moment[c];
      audit.lower[c] = std::min(audit.lower[c], part.lower[c]);
      audit.upper[c] = std::max(audit.upper[c], part.upper[c]);
    }
  }
  if (body.lagrangian) {
    audit.kinetic = body.reference.kinetic;
    audit.angular_momentum = body.reference.angular_momentum;
  }
  if (model.grid.axisymmetric()) audit.angular_momentum = {};  // of the whole body
  return audit;
}

double booked_energy(const Ledger& ledger) {
  return ledger.friction_dissipation + ledger.transfer_dissipation + ledger.contact_dissipation - ledger.external_work -
         ledger.prescribed_work - ledger.boundary_work;
}

double total_energy(const Model& model, const State& state, int threads) {
  double total = booked_energy(state.ledger);
  for (int b = 0; b < static_cast<int>(state.bodies.size()); ++b) {
    const BodyAudit audit = audit_body(model, state, b, threads);
    const BodyTotals& totals = state.bodies[b].totals;
    total += audit.kinetic + audit.internal + totals.failure_loss + totals.left.energy + totals.dropped.energy;
  }
  return total;
}

double dissipated_energy(const State& state) {
  double sum = state.ledger.friction_dissipation + state.ledger.transfer_dissipation + state.ledger.contact_dissipation;
  for (const BodyState& body : state.bodies)
    sum += body.totals.plastic_dissipation + body.totals.viscous_dissipation + body.totals.failure_loss;
  return sum;
}

void forget_departed(State& state, int body, double kinetic, double internal) {
  ExchangeState& memory = state.stop.exchange;
  if (memory.kinetic.empty()) return;
  memory.kinetic[static_cast<std::size_t>(body)] -= kinetic;
  memory.internal -= internal;
}

Vector3 body_momentum(const BodyState& body) {
  Vector3 momentum{};
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p)
      for (int c = 0; c < 3; ++c) momentum[c] += body.position[4 * p + 3] * body.velocity[4 * p + c];
  return momentum;
}

namespace {

void check_body(const Model& model, State& state) {
  const Stop& stop = model.stop;
  if (stop.body < 0) return;
  const BodyState& body = state.bodies[stop.body];
  if (body.particles == 0) {
    if (stop.when_out) state.stop.reason = 3;
    return;
  }
  double mass = 0;
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) mass += body.position[4 * p + 3];
  Vector3 momentum = body_momentum(body);
  if (model.grid.axisymmetric()) momentum[0] = 0;  // of the whole body
  const Vector3& initial = body.totals.initial_velocity;
  double speed = 0, along = 0, initial_speed = 0;
  for (int c = 0; c < 3; ++c) {
    const double v = momentum[c] / mass;
    speed += v * v;
    along += v * initial[c];
    initial_speed += initial[c] * initial[c];
  }
  speed = std::sqrt(speed);
  initial_speed = std::sqrt(initial_speed);
  if (stop.when_stopped && initial_speed > 0 && along <= 0) {
    state.stop.reason = 2;
    return;
  }
  if (stop.settle_window <= 0) return;
  if (!state.stop.slowed) {
    state.stop.slowed = std::abs(initial_speed - speed) > stop.settle_tolerance;
    state.stop.reference_time = state.time;
    state.stop.reference_speed = speed;
  } else if (std::abs(speed - state.stop.reference_speed) > stop.settle_tolerance) {
    state.stop.reference_time = state.time;
    state.stop.reference_speed = speed;
  } else if (state.time - state.stop.reference_time >= stop.settle_window) {
    state.stop.reason = 1;
  }
}

// Before anything has happened the memory is of the beginning, so that a slow exchange adds up; afterwards it moves to the present
// whenever an energy has left the band around it.
void check_exchange(const Model& model, State& state) {
  const Stop& stop = model.stop;
  const double band = stop.exchange_tolerance * std::abs(state.ledger.initial_total + state.energy_watch.from_host);
  if (!(stop.exchange_window > 0) || !(band > 0)) return;
  ExchangeState& memory = state.stop.exchange;
  ExchangeState now;
  now.time = state.time;
  now.dissipated = dissipated_energy(state);
  for (int b = 0; b < static_cast<int>(state.bodies.size()); ++b) {
    const BodyAudit audit = audit_body(model, state, b);
    now.internal += audit.internal;
    now.kinetic.push_back(audit.kinetic);
  }
  if (memory.kinetic.empty()) {
    memory = now;
    memory.dissipated = 0;
  }
  const auto left_band = [&](double before, double after) { return std::abs(after - before) > band; };
  const bool stored = left_band(memory.internal, now.internal) || left_band(memory.dissipated, now.dissipated);
  bool moved = false;
  for (std::size_t b = 0; b < now.kinetic.size(); ++b) moved = moved || left_band(memory.kinetic[b], now.kinetic[b]);

  if (memory.begun && !stored && !moved) {
    if (state.time - memory.time >= stop.exchange_window) state.stop.reason = 4;
    return;
  }
  // Motion and contact tell of an exchange only where nothing outside works: gravity moves what still flies, and presses
  // together what lies.
  const bool driven = state.ledger.external_work != 0 || state.ledger.prescribed_work != 0;
  bool pushed = false;
  for (const PairTotals& pair : state.pairs) pushed = pushed || pair.impulse != Vector3{};
  now.begun = memory.begun || stored || (!driven && (pushed || moved));
  if (now.begun) memory = std::move(now);
}

}  // namespace

void check_stop(const Model& model, State& state) {
  if (state.stop.reason != 0) return;
  check_body(model, state);
  if (state.stop.reason == 0) check_exchange(model, state);
}

}  // namespace ogive
