// The stable time step.
#include "time_step.hpp"

#include <algorithm>
#include <cmath>

#include "breakdown.hpp"

namespace ogive {
namespace {

double limit(const Model& model, const State& state, double fastest) {
  double dt = model.numerics.maximum_time_step;
  if (fastest > 0) dt = std::min(dt, model.numerics.time_step_factor * model.grid.cell_size / fastest);
  // A run whose clock no longer moves would never end.
  if (!(dt > 0) || !std::isfinite(dt) || !(state.time + dt > state.time) || time_step_collapsed(model, state, fastest))
    throw collapse(model, state, dt, fastest);
  return dt;
}

}  // namespace

double stable_time_step(const Model& model, const State& state, const Workspace& workspace) {
  double fastest = std::max(workspace.rigid_speed, workspace.lagrangian_speed);
  for (std::size_t l = 0; l < workspace.links.size(); ++l)
    if (!workspace.links[l].guided) fastest = std::max(fastest, workspace.stress_sums[l].fastest);
  if (workspace.links.empty() && !workspace.reference_grid) return state.stable_time_step;  // nothing is left to be fast
  return limit(model, state, fastest);
}

double initial_time_step(const Model& model, State& state, const Workspace& workspace) {
  double fastest = 0;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    BodyState& body = state.bodies[b];
    const KernelMaterial& material = workspace.materials[b];
    const Material& rules = model.material_of(static_cast<int>(b));
    const double bulk = rules.eos == EquationOfState::MieGruneisen ? material.rho_c0_squared : material.K;
    double wave = model.bodies[b].rigid() ? 0 : std::sqrt((bulk + 4.0 / 3.0 * material.G) / material.density);
    if (body.lagrangian) wave *= std::max(1.0, model.grid.cell_size / body.reference.critical_length);
    wave += 2.0 * material.viscosity_linear * wave;  // bulk viscosity slows the step once something is compressed
    double speed_squared = 0;
    for (const Group& group : body.groups)
      for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
        const double* v = &body.velocity[4 * p];
        speed_squared = std::max(speed_squared, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      }
    body.totals.maximum_speed = std::sqrt(speed_squared);
    body.totals.maximum_speed_ever = std::max(body.totals.maximum_speed_ever, body.totals.maximum_speed);
    fastest = std::max(fastest, wave + body.totals.maximum_speed);
  }
  return limit(model, state, fastest);
}

}  // namespace ogive
