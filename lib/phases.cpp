#include "phases.hpp"

#include <string>

#include "error.hpp"

namespace ogive {

void trial_velocities(const Model& model, State& state, Workspace& workspace, double dt) {
  const Vector3 g = model.numerics.gravity;
  const bool heavy = g[0] != 0 || g[1] != 0 || g[2] != 0;
  for_nodes(workspace, [&](NodeRecord& node) {
    if (!(node.v[3] > 0)) {
      for (double& c : node.f) c = 0;
      return;
    }
    const double factor = dt / node.v[3];
    for (int c = 0; c < 3; ++c) node.f[c] = node.v[c] + node.f[c] * factor + g[c] * dt;
  });
  if (!heavy) return;
  for (std::size_t s = 0; s < workspace.slots.size(); ++s) {
    if (workspace.slots[s].guided()) continue;
    for (std::size_t i = s * block_nodes; i < (s + 1) * block_nodes; ++i) {
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
      const BodyState& body = state.bodies[b];
      const double* x = &body.position[4 * sums.bad_particle];
      throw Error(ErrorKind::Numerical,
                  "body \"" + model.bodies[b].name + "\": particle " + std::to_string(body.number[sums.bad_particle]) +
                      " at (" + std::to_string(x[0]) + ", " + std::to_string(x[1]) + ", " + std::to_string(x[2]) +
                      "), time " + std::to_string(state.time) + ": volume ratio must be positive and finite, got " +
                      std::to_string(body.volume_ratio[sums.bad_particle]) + "; a smaller time_step_factor may help");
    }
  }
}

}  // namespace ogive
