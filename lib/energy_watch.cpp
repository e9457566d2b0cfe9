// Watches the ledger for energy that nothing gave or took.
#include "energy_watch.hpp"

#include <algorithm>
#include <cmath>

#include "audit.hpp"
#include "error.hpp"

namespace ogive {
namespace {

double work_done(const State& state) {
  return std::max({state.energy_watch.largest_work, state.ledger.external_work + state.ledger.prescribed_work, 0.0});
}

double growth_of(const Model& model, const State& state, double total) {
  const Ledger& ledger = state.ledger;
  const double gained = total - ledger.initial_total - state.energy_watch.from_host + std::max(ledger.boundary_work, 0.0);
  if (!std::isfinite(gained)) return std::numeric_limits<double>::infinity();
  double mass = 0;
  for (const BodyState& body : state.bodies)
    for (const Group& group : body.groups)
      for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) mass += body.position[4 * p + 3];
  // Bodies at rest have round-off alone: not to be measured by itself. h/dt is about the speed of sound.
  const double speed = state.stable_time_step > 0 ? model.grid.cell_size / state.stable_time_step : 0;
  const double floor = 1e-12 * mass * speed * speed;
  const double given = std::abs(ledger.initial_total) + work_done(state) + std::abs(state.energy_watch.from_host);
  const double scale = std::max(given, floor);
  return scale > 0 ? gained / scale : 0;
}

// The body and particle that hold the most energy for their mass: where a run comes apart.
std::string hottest_particle(const Model& model, const State& state) {
  double most = -1;
  std::string text;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const BodyState& body = state.bodies[b];
    const double density = model.material_of(static_cast<int>(b)).density;
    std::int64_t found = -1;
    for (const Group& group : body.groups)
      for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
        const double* v = &body.velocity[4 * p];
        const double energy = 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + body.energy[p] / density;
        if (energy > most) {
          most = energy;
          found = p;
        }
      }
    if (found < 0) continue;
    const double *x = &body.position[4 * found], *v = &body.velocity[4 * found];
    text = "body \"" + model.bodies[b].name + "\": particle " + std::to_string(body.number[found]) + " at (" + std::to_string(x[0]) +
           ", " + std::to_string(x[1]) + ", " + std::to_string(x[2]) + ") has the speed " +
           std::to_string(std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])) + " and V/V0 = " + std::to_string(body.volume_ratio[found]);
  }
  return text;
}

// What most likely loses energy that no term of the ledger has.
std::string probable_loss(const Model& model, const State& state, double loss) {
  const Numerics& numerics = model.numerics;
  const double given = std::abs(state.ledger.initial_total) + work_done(state) + std::abs(state.energy_watch.from_host);
  if (-state.ledger.contact_work > 0.3 * loss * given) {
    const PairTotals* most = nullptr;
    for (const PairTotals& pair : state.pairs)
      if (!most || pair.contact_work < most->contact_work) most = &pair;
    std::string where;
    if (most && most->a >= 0 && most->b >= 0 && static_cast<std::size_t>(most->b) < model.bodies.size())
      where = " between \"" + model.bodies[most->a].name + "\" and \"" + model.bodies[most->b].name + '"';
    return "contact" + where + " takes the energy of whole cells at nodes: use finer cells (bodies should be four or more thick), the "
           "method persistent, or detection by surface";
  }
  if (numerics.update_order == UpdateOrder::StressLastAsIs)
    return "the update order stress_last_as_is keeps no energy at nodes with little mass: use stress_first or stress_last";
  if (numerics.update_order == UpdateOrder::StressLast)
    return "with the stress last waves that the cells hardly resolve lose energy: use a smaller time_step_factor (now " +
           std::to_string(numerics.time_step_factor) + "), stress_first or finer cells";
  return "motion that the cells do not resolve: use finer cells, or a smaller time_step_factor (now " +
         std::to_string(numerics.time_step_factor) + ')';
}

// Largest angle by which a body as a whole turns in a step, from the mean of its affine velocities; 0 without them.
double largest_turn(const State& state) {
  double largest = 0;
  for (const BodyState& body : state.bodies) {
    if (body.affine.empty()) continue;
    double mass = 0;
    Vector3 curl{};
    for (const Group& group : body.groups)
      for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
        const double* C = &body.affine[affine_size * p];
        const double m = body.position[4 * p + 3];
        mass += m;
        add(curl, times(m, {C[3 + 2] - C[6 + 1], C[6 + 0] - C[0 + 2], C[0 + 1] - C[3 + 0]}));
      }
    if (mass > 0) largest = std::max(largest, 0.5 * std::sqrt(dot(curl, curl)) / mass * state.last_time_step);
  }
  return largest;
}

}  // namespace

double energy_growth(const Model& model, const State& state, int threads) {
  return growth_of(model, state, total_energy(model, state, threads));
}

std::string probable_cause(const Model& model, const State& state) {
  const Numerics& numerics = model.numerics;
  const std::string factor = std::to_string(numerics.time_step_factor);
  if (numerics.update_order == UpdateOrder::StressLastAsIs)
    return "the update order stress_last_as_is has no bound at nodes with little mass: use stress_first or stress_last";
  if (const double turn = largest_turn(state); turn > 0.005)
    return "a body turns by " + std::to_string(turn) + " rad a step, of which the stress first makes energy and the stress last takes "
           "some: use a smaller time_step_factor (now " + factor + ")";
  if (numerics.shape_function == ShapeFunction::Linear && numerics.update_order == UpdateOrder::StressFirst)
    return "trilinear functions with the stress first let pressures grow in particles that lie at nodes: use quadratic B-splines, "
           "or stress_last";
  if (numerics.affine() && numerics.time_step_factor > 0.58)
    return "with affine velocities a lone particle is stable below a time-step factor of 0.58 to 0.73, here it is " + factor;
  bool shared_node = false, first_phase = false;
  const auto look = [&](const ContactRule& rule) {
    shared_node = shared_node || rule.detection == Detection::SharedNode;
    first_phase = first_phase || rule.method == ContactMethod::York || rule.method == ContactMethod::HuChen ||
                  rule.method == ContactMethod::Pan2008;
  };
  if (model.bodies.size() > 1) look(model.contact);
  for (const PairRule& pair : model.pairs) look(pair.rule);
  for (const Wall& wall : model.walls) look(wall.rule);
  if (shared_node && (model.bodies.size() > 1 || !model.walls.empty()) && model.own_fields)
    return "contact wherever two bodies share a node begins up to a cell too early and pushes on what does not touch: use the "
           "detection by gap";
  if (first_phase && numerics.affine())
    return "the first phase of York's, Hu and Chen's and Pan's methods makes energy with affine velocities: use the transfer flip";
  if (numerics.shape_function == ShapeFunction::Linear)
    return "trilinear functions disturb the stress where particles cross cells: use quadratic B-splines, or a smaller "
           "time_step_factor (now " + factor + ")";
  return "the time step may be too long for what moves here: use a smaller time_step_factor (now " + factor + "), or finer cells";
}

void check_energy(const Model& model, const State& state, double growth) {
  const Numerics& numerics = model.numerics;
  const std::string when = "at time " + std::to_string(state.time) + ", step " + std::to_string(state.steps) + ", ";
  const auto limit = [](const char* name, double value) {
    return std::string(" (") + name + ": " + std::to_string(100 * value) + " %); ";
  };
  if (growth > numerics.energy_limit)
    throw Error(ErrorKind::Numerical, when + "the energy has grown by " + std::to_string(100 * growth) +
                                          " % of what there was and of the work done" +
                                          limit("energy_limit", numerics.energy_limit) + hottest_particle(model, state) +
                                          "; probable cause: " + probable_cause(model, state));
  if (-growth > numerics.energy_loss_limit)
    throw Error(ErrorKind::Numerical, when + std::to_string(-100 * growth) +
                                          " % of the energy that there was and of the work done are lost, unaccounted for" +
                                          limit("energy_loss_limit", numerics.energy_loss_limit) +
                                          "probable cause: " + probable_loss(model, state, -growth));
}

bool watch_energy(const Model& model, State& state, int threads) {
  if (state.steps % energy_watch_steps != 0) return false;
  EnergyWatch& watch = state.energy_watch;
  watch.largest_work = work_done(state);
  const double growth = energy_growth(model, state, threads);
  if (growth > watch.largest_growth) {
    watch.largest_growth = growth;
    watch.largest_growth_time = state.time;
  }
  check_energy(model, state, growth);
  if (growth <= model.numerics.energy_warning || watch.warning_time >= 0) return false;
  watch.warning_time = state.time;
  return true;
}

}  // namespace ogive
