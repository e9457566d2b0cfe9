// The pass over the particles of a total Lagrangian body, Lee et al. 2005, (3.5)-(3.7): from nodal velocities V_a to
//   v = N_a(X) V_a,  x' = x + dt v,  F' = F + dt V_a (x) grad N_a(X),
// which with weights that never change are x' = N_a x_a' and F' = x_a' (x) grad N_a; then the law, and the internal
// nodal force f_a = -V_0 P grad N_a(X), with the first Piola-Kirchhoff stress P = F T = J sigma F^-T. Weights are those
// of the particle's place in the reference configuration. They never change; to compute them anew costs less than to
// load them (docs/performance.md).
#pragma once

#include "transfer/stress.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

// The nodes of `group` hold {V_a, 0 | -}; `force_nodes` is where the sums of f_a go.
template <class Shape, int strength, int eos>
void update_lagrangian(const KernelGroup& group, const KernelParticles& particles, const KernelMaterial& material,
                       NodeRecord* const (&force_nodes)[27], StressSums& sums) {
  alignas(64) Record motion[tile_size];
  alignas(64) Record force[tile_size];
  read_tile(group, [&](int t, const NodeRecord& record) { motion[t] = load_aligned<Record>(record.v); });
  clear_tile(group, force);
  Scatter<Shape> forces;
  Scatter<Shape>::begin(forces, force);

  LawLanes fastest{}, worst{};
  Lanes speed_squared{};
  LawSums law_sums;
  begin_sums(sums);
  const double steps_per_cell = group.time_step * group.inverse_cell;
  Weights weights[stretch / lane_count];
  alignas(64) double gradients[3][3][stretch], products[3][3][stretch];
  for (std::int64_t start = group.begin; start < group.end; start += stretch) {
    const int count = fill_stretch<Shape, Beside::Derivatives>(weights, group, particles.reference, start);
    for (int i = 0; i < count; i += lane_count) {
      Record gradient[3][lane_count], velocity[lane_count];
      for (int lane = 0; lane < lane_count; ++lane) {
        gather_slopes<Shape, Beside::Derivatives>(weights[i / lane_count], lane, motion, velocity[lane],
                                                  gradient[0][lane], gradient[1][lane], gradient[2][lane]);
        const std::int64_t p = start + i + lane;
        double* const x = particles.position + 4 * p;
        store_aligned(x, load_aligned<Record>(x) + velocity[lane] * group.time_step);
        set_lane(velocity[lane], 3, 1.0);
        store_aligned(particles.velocity + 4 * p, velocity[lane]);
      }
      transpose(velocity[0], velocity[1], velocity[2], velocity[3]);
      speed_squared =
          max(velocity[0] * velocity[0] + velocity[1] * velocity[1] + velocity[2] * velocity[2], speed_squared);
      for (int b = 0; b < 3; ++b) {
        transpose(gradient[b][0], gradient[b][1], gradient[b][2], gradient[b][3]);
        for (int a = 0; a < 3; ++a) store_aligned(gradients[a][b] + i, gradient[b][a]);
      }
    }
    for (int part = 0; part < count; part += law_width) {
      const std::int64_t p = start + part;
      LawLanes X, Y, Z, mass;
      load_records(particles.reference + 4 * p, X, Y, Z, mass);
      LawState<LawLanes> s;
      s.dt = broadcast<LawLanes>(group.time_step);
      load_state<strength>(particles, material, p, s);
      LawLanes F_0[3][3], F_1[3][3], inverse[3][3];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          F_0[i][j] = load_aligned<LawLanes>(particles.deformation[3 * i + j] + p);
          F_1[i][j] = F_0[i][j] + load_aligned<LawLanes>(gradients[i][j] + part) * steps_per_cell;
          store_aligned(particles.deformation[3 * i + j] + p, F_1[i][j]);
        }
      const LawLanes J = determinant(F_1);
      update_law_between<strength, eos>(material, F_0, F_1, s);
      store_state<strength>(particles, material, p, s);
      const LawLanes initial_volume = mass * group.inverse_density;
      // An inverted or crushed particle is bad whatever its law says of it.
      if (!all(J > 1e-6)) s.volume_ratio = select(J > 1e-6, s.volume_ratio, J);
      take_sums<strength>(s, mass, initial_volume, p, law_sums, sums);

      invert(F_1, 1.0 / J, inverse);
      LawLanes size{}, inverse_size{};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          size += F_1[i][j] * F_1[i][j];
          inverse_size += inverse[i][j] * inverse[i][j];
        }
      worst = max(size * inverse_size, worst);
      fastest = max(s.reference_speed_squared, fastest);

      const LawLanes factor = J * initial_volume * (-group.inverse_cell);
      const LawLanes stress[3][3] = {{s.stress.xx - s.viscous_pressure, s.stress.xy, s.stress.xz},
                                     {s.stress.xy, s.stress.yy - s.viscous_pressure, s.stress.yz},
                                     {s.stress.xz, s.stress.yz, s.stress.zz - s.viscous_pressure}};
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          store_aligned(products[i][k] + part, factor * (stress[i][0] * inverse[k][0] + stress[i][1] * inverse[k][1] +
                                                         stress[i][2] * inverse[k][2]));
    }
    for (int i = 0; i < count; i += lane_count) {
      Lanes column[3][4];
      for (int k = 0; k < 3; ++k) {
        for (int c = 0; c < 3; ++c) column[k][c] = load_aligned<Lanes>(products[c][k] + i);
        column[k][3] = Lanes{};
        transpose(column[k][0], column[k][1], column[k][2], column[k][3]);
      }
#pragma GCC unroll 1
      for (int lane = 0; lane < lane_count; ++lane)
        scatter_slopes<Shape, Beside::Derivatives, true>(weights[i / lane_count], lane, Record{}, column[0][lane],
                                                         column[1][lane], column[2][lane], forces);
    }
  }
  Scatter<Shape>::end(forces);
  add_tile(
      group, force, [&](const KernelGroup&, int block) { return force_nodes[block] ? force_nodes[block]->f : nullptr; },
      sizeof(NodeRecord) / sizeof(double));
  sums.outside = false;
  end_sums(sqrt(fastest), law_sums, sums);
  for (int lane = 0; lane < law_width; ++lane)
    if (worst[lane] > sums.worst_distortion) sums.worst_distortion = worst[lane];
  for (int lane = 0; lane < lane_count; ++lane)
    if (speed_squared[lane] > sums.speed_squared) sums.speed_squared = speed_squared[lane];
  sums.worst_distortion = __builtin_sqrt(sums.worst_distortion) / 3.0;
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
