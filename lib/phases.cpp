#include "phases.hpp"

#include <string>

#include "breakdown.hpp"
#include "error.hpp"

namespace ogive {

void trial_velocities(const Model& model, Workspace& workspace, double dt) {
  const Vector3 g = model.numerics.gravity;
  for_nodes(workspace, [&](std::int64_t i) {
    NodeRecord& node = workspace.nodes[i];
    if (!(node.v[3] > 0)) {
      for (double& c : node.f) c = 0;
      return;
    }
    const double factor = dt / node.v[3];
    for (int c = 0; c < 3; ++c) node.f[c] = node.v[c] + node.f[c] * factor + g[c] * dt;
  });
}

void book_gravity(const Model& model, State& state, const Workspace& workspace, double dt) {
  const Vector3 g = model.numerics.gravity;
  if (g == Vector3{}) return;
  for (std::size_t s = 0; s < workspace.slots.size(); ++s) {
    if (workspace.slots[s].guided()) continue;
    for (std::size_t i = s * block_nodes; i < s * block_nodes + static_cast<std::size_t>(workspace.nodes_in_use); ++i) {
      const NodeRecord& node = workspace.nodes[i];
      for (int c = 0; c < 3; ++c) {
        state.ledger.external_impulse[c] += node.v[3] * g[c] * dt;
        state.ledger.external_work += 0.5 * node.v[3] * g[c] * dt * (node.v[c] + node.f[c]);
      }
    }
  }
}

void book_stress(const Model& model, State& state, const Workspace& workspace, double dt) {
  for (std::size_t l = 0; l < workspace.links.size(); ++l) {
    if (workspace.links[l].guided) continue;
    const StressSums& sums = workspace.stress_sums[l];
    const int b = workspace.links[l].body;
    state.bodies[b].drifted = state.bodies[b].drifted || sums.outside;
    BodyTotals& totals = state.bodies[b].totals;
    totals.plastic_dissipation += sums.plastic_dissipation;
    totals.viscous_dissipation += sums.viscous_dissipation;
    totals.failure_loss += sums.failure_loss;
    totals.failed_mass += sums.failed_mass;
    if (sums.failed_particles > 0 && totals.first_failure_time < 0) totals.first_failure_time = state.time + dt;
    totals.failed_particles += sums.failed_particles;
    if (sums.bad_particle >= 0) {
      const double ratio = state.bodies[b].volume_ratio[sums.bad_particle];
      throw breakdown(model, state, b, sums.bad_particle,
                      "volume ratio must be positive and finite, got " + std::to_string(ratio),
                      ratio < 1 ? "it was crushed in one step: a smaller time_step_factor may help"
                                : "torn or not a number, from a time step that is too large or data of no real material");
    }
  }
}

}  // namespace ogive
