// See breakdown.hpp.
#include "breakdown.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ogive {
namespace {

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", x);
  return buffer;
}

std::string text(const double* v) {
  return "(" + text(v[0]) + ", " + text(v[1]) + ", " + text(v[2]) + ")";
}

// Fastest wave of the materials at rest and fastest body at the start.
double reference_speed(const Model& model, const State& state) {
  double wave = 0, speed = 0;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    speed = std::max(speed, length(state.bodies[b].totals.initial_velocity));
    if (model.bodies[b].rigid()) continue;
    const Material& m = model.material_of(static_cast<int>(b));
    const double bulk = m.eos == EquationOfState::MieGruneisen ? m.density * m.eos_sound_speed * m.eos_sound_speed : m.K;
    wave = std::max(wave, std::sqrt((bulk + 4.0 / 3.0 * m.G) / m.density) * (1 + 2 * m.viscosity_linear));
  }
  return wave + speed;
}

double speed_of(const BodyState& body, std::int64_t p) {
  const double* v = &body.velocity[4 * p];
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

template <class Work>
void for_particles(const BodyState& body, Work&& work) {
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) work(p);
}

// That which nine particles of ten exceed.
double slow_speed(const BodyState& body) {
  std::vector<double> speeds;
  speeds.reserve(static_cast<std::size_t>(body.particles));
  for_particles(body, [&](std::int64_t p) { speeds.push_back(speed_of(body, p)); });
  const auto tenth = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 10);
  std::nth_element(speeds.begin(), tenth, speeds.end());
  return *tenth;
}

// Visits values by name: each must be finite, and where it says so > 0 or >= 0.
enum class Sign { Any, NotNegative, Positive };

void require_values(const std::string& name, const AlignedVector<double>& values, Sign sign) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = values[i];
    const bool in_range = sign == Sign::Any || (sign == Sign::Positive ? x > 0 : x >= 0);
    if (!std::isfinite(x) || !in_range)
      throw Error(ErrorKind::Format, name + ": value " + std::to_string(i) + " must be finite" +
                                         (sign == Sign::Positive ? " and > 0" : sign == Sign::NotNegative ? " and >= 0" : "") +
                                         ", found " + text(x));
  }
}

void require_finite(const std::string& name, std::initializer_list<double> values) {
  for (const double x : values)
    if (!std::isfinite(x)) throw Error(ErrorKind::Format, name + ": must be finite, found " + text(x));
}

void require_finite(const std::string& name, const Vector3& v) { require_finite(name, {v[0], v[1], v[2]}); }

// Particles have mass and different numbers from 0 on; what fills a group up has no mass and the number -1.
void require_particles(const std::string& at, const BodyState& body) {
  std::vector<std::int32_t> numbers;
  numbers.reserve(static_cast<std::size_t>(body.particles));
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin; p < group.padded_end(); ++p) {
      const bool real = p < group.begin + group.count;
      const double mass = body.position[4 * p + 3];
      const std::int32_t number = body.number[p];
      if (real ? !(mass > 0) : mass != 0)
        throw Error(ErrorKind::Format, at + "position: place " + std::to_string(p) + " must have " +
                                           (real ? "a mass > 0" : "no mass") + ", found " + text(mass));
      if (real ? number < 0 || number == INT32_MAX : number != -1)
        throw Error(ErrorKind::Format, at + "number: place " + std::to_string(p) + " must have " +
                                           (real ? "a number from 0 on" : "-1") + ", found " + std::to_string(number));
      if (real) numbers.push_back(number);
    }
  std::sort(numbers.begin(), numbers.end());
  const auto twice = std::adjacent_find(numbers.begin(), numbers.end());
  if (twice != numbers.end())
    throw Error(ErrorKind::Format, at + "number: particle " + std::to_string(*twice) + " is there twice");
}

}  // namespace

Error breakdown(const Model& model, const State& state, int body, std::int64_t particle, const std::string& what,
                const std::string& cause) {
  const BodyState& b = state.bodies[static_cast<std::size_t>(body)];
  return Error(ErrorKind::Numerical, "body \"" + model.bodies[static_cast<std::size_t>(body)].name + "\": particle " +
                                         std::to_string(b.number[static_cast<std::size_t>(particle)]) + " at " +
                                         text(&b.position[4 * static_cast<std::size_t>(particle)]) + ", step " +
                                         std::to_string(state.steps) + ", time " + text(state.time) + ": " + what +
                                         "; probable cause: " + cause);
}

void check_speeds(const Model& model, const State& state) {
  const double reference = reference_speed(model, state);
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const BodyState& body = state.bodies[b];
    if (model.bodies[b].rigid()) {
      const RigidState& rigid = body.rigid;
      for (int c = 0; c < 3; ++c)
        if (!std::isfinite(rigid.centre[c]) || !std::isfinite(rigid.velocity[c]) || !std::isfinite(rigid.spin[c]))
          throw Error(ErrorKind::Numerical, "rigid body \"" + model.bodies[b].name + "\": its motion is not finite, step " +
                                                std::to_string(state.steps) + ", time " + text(state.time) +
                                                "; probable cause: loads, or what it meets, are beyond what numbers hold");
      continue;
    }
    if (body.totals.maximum_speed <= runaway_factor * reference || body.particles == 0) continue;
    // A speed whose square is beyond what numbers hold is none, whatever the others have.
    const double slow = slow_speed(body);
    const double limit = runaway_factor * (std::isfinite(slow) ? reference + slow : reference);
    std::int64_t fastest = -1;
    double speed = limit;
    for_particles(body, [&](std::int64_t p) {
      const double s = speed_of(body, p);
      if (s > speed) fastest = p, speed = s;
    });
    if (fastest >= 0)
      throw breakdown(model, state, static_cast<int>(b), fastest,
                      "it runs away: its velocity is " + text(&body.velocity[4 * static_cast<std::size_t>(fastest)]) +
                          ", faster than " + text(limit) + ", ten times the fastest wave and body",
                      "it is alone at nodes with next to no mass, or the time step is too large: a smaller time_step_factor, "
                      "affine velocities and B-splines help");
  }
}

bool time_step_collapsed(const Model& model, const State& state, double fastest) {
  const double reference = reference_speed(model, state);
  if (!(reference > 0) || fastest <= collapse_factor * reference) return false;
  double particles = 0;
  for (const BodyState& body : state.bodies) particles = std::max(particles, body.totals.maximum_speed);
  return fastest > collapse_factor * (reference + particles);
}

Error collapse(const Model& model, const State& state, double dt, double fastest) {
  int body = -1;
  std::int64_t particle = -1;
  double smallest = 0;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    if (model.bodies[b].rigid()) continue;
    for_particles(state.bodies[b], [&](std::int64_t p) {
      const double ratio = state.bodies[b].volume_ratio[p];
      if (particle >= 0 && ratio >= smallest) return;
      body = static_cast<int>(b), particle = p, smallest = ratio;
    });
  }
  const std::string what = "the time step has collapsed to " + text(dt) + ", the fastest wave with the motion of the grid being " +
                           text(fastest);
  if (particle < 0)
    return Error(ErrorKind::Numerical, what + ", step " + std::to_string(state.steps) + ", time " + text(state.time));
  return breakdown(model, state, body, particle,
                   what + "; this particle is the most compressed one, to " + text(smallest) + " of its volume",
                   "material is crushed or torn at nodes with next to no mass: a smaller time_step_factor, affine velocities, "
                   "failure or bulk viscosity help");
}

void require_sound(const Model& model, const State& state) {
  require_finite("state/time", {state.time, state.last_time_step, state.stable_time_step});
  if (state.time < 0 || state.last_time_step < 0 || state.steps < 0 || state.particle_steps < 0 ||
      state.resting_particle_steps < 0)
    throw Error(ErrorKind::Format, "state/time: times and counts must be >= 0");
  const ExchangeState& exchange = state.stop.exchange;
  require_finite("state/stop/exchange", {exchange.time, exchange.internal, exchange.dissipated});
  for (const double kinetic : exchange.kinetic) require_finite("state/stop/exchange/kinetic", {kinetic});
  const Ledger& ledger = state.ledger;
  require_finite("state/ledger", {ledger.friction_dissipation, ledger.transfer_dissipation, ledger.contact_work,
                                  ledger.boundary_work, ledger.external_work, ledger.prescribed_work, ledger.initial_total});
  require_finite("state/ledger/boundary_impulse", ledger.boundary_impulse);
  require_finite("state/ledger/external_impulse", ledger.external_impulse);
  require_finite("state/ledger/contact_couple", ledger.contact_couple);
  for (const LoadState& load : state.loads) {
    require_finite("state/loads", load.value);
    require_finite("state/loads", load.force);
    require_finite("state/loads", load.impulse);
    require_finite("state/loads", {load.mass, load.work});
  }
  for (const PairTotals& pair : state.pairs) {
    require_finite("state/pairs/sums", pair.force);
    require_finite("state/pairs/sums", pair.impulse);
    require_finite("state/pairs/sums", {pair.friction_dissipation, pair.contact_work});
  }
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const BodyState& body = state.bodies[b];
    const std::string at = "state/bodies/" + std::to_string(b) + "/";
    const BodyTotals& t = body.totals;
    require_finite(at + "totals", {t.failed_mass, t.first_failure_time, t.failure_loss, t.left.mass, t.left.energy, t.dropped.mass,
                                   t.dropped.energy, t.plastic_dissipation, t.viscous_dissipation, t.maximum_speed,
                                   t.maximum_speed_ever});
    require_finite(at + "left_momentum", t.left.momentum);
    require_finite(at + "dropped_momentum", t.dropped.momentum);
    require_finite(at + "dropped_angular_momentum", t.dropped_angular_momentum);
    require_finite(at + "contact_force", t.contact_force);
    require_finite(at + "initial_velocity", t.initial_velocity);
    if (model.bodies[b].rigid()) {
      require_finite(at + "rigid/centre", body.rigid.centre);
      require_finite(at + "rigid/velocity", body.rigid.velocity);
      require_finite(at + "rigid/spin", body.rigid.spin);
    }
    require_values(at + "position", body.position, Sign::Any);
    require_values(at + "velocity", body.velocity, Sign::Any);
    require_values(at + "volume_ratio", body.volume_ratio, Sign::Positive);
    require_values(at + "energy", body.energy, Sign::Any);
    for (const auto& component : body.stress) require_values(at + "stress", component, Sign::Any);
    require_values(at + "plastic_strain", body.plastic_strain, Sign::NotNegative);
    require_values(at + "yield_stress", body.yield_stress, Sign::NotNegative);
    require_values(at + "temperature", body.temperature, Sign::NotNegative);
    require_values(at + "viscous_pressure", body.viscous_pressure, Sign::Any);
    for (const auto& component : body.deformation) require_values(at + "deformation", component, Sign::Any);
    require_values(at + "affine", body.affine, Sign::Any);
    require_values(at + "force", body.force, Sign::Any);
    require_particles(at, body);
  }
}

}  // namespace ogive
