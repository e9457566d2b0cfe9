// Velocity gradient to strain increment (29), density (30), stress, and internal force (31) in one pass over a group:
// Huang et al. 2010, section 4, steps 4 and 5. Where the stress comes last (MUSL), the pass moves the particles
// instead, by the displacement that the particle update left, and the force is mapped by itself in the next step.
#pragma once

#include "materials/law.hpp"
#include "transfer/transfer.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

// Adds -V (sigma - q I) grad N, Eq. (31), for four particles; `stress` is -V (sigma - q I) / h.
template <class Shape>
OGIVE_INLINE void scatter_stress(const Weights& weights, const Symmetric<Lanes>& stress, Scatter<Shape>& force) {
  Lanes X[4] = {stress.xx, stress.xy, stress.xz, Lanes{}};
  Lanes Y[4] = {stress.xy, stress.yy, stress.yz, Lanes{}};
  Lanes Z[4] = {stress.xz, stress.yz, stress.zz, Lanes{}};
  transpose(X[0], X[1], X[2], X[3]);
  transpose(Y[0], Y[1], Y[2], Y[3]);
  transpose(Z[0], Z[1], Z[2], Z[3]);
#pragma GCC unroll 1
  for (int lane = 0; lane < lane_count; ++lane)
    scatter_slopes<Shape, Beside::Derivatives, true>(weights, lane, Record{}, X[lane], Y[lane], Z[lane], force);
}

// The same in a two-dimensional model; where axisymmetric, -V (sigma - q I)_zz N / r is the force of the hoop stress.
template <class Shape>
OGIVE_INLINE void scatter_planar_stress(const Weights& weights, const Symmetric<Lanes>& stress, Lanes cells_by_radius,
                                        Scatter<Shape>& force) {
  Lanes X[4] = {stress.xx, stress.xy, Lanes{}, Lanes{}};
  Lanes Y[4] = {stress.xy, stress.yy, Lanes{}, Lanes{}};
  Lanes hoop[4] = {stress.zz * cells_by_radius, Lanes{}, Lanes{}, Lanes{}};
  transpose(X[0], X[1], X[2], X[3]);
  transpose(Y[0], Y[1], Y[2], Y[3]);
  transpose(hoop[0], hoop[1], hoop[2], hoop[3]);
#pragma GCC unroll 1
  for (int lane = 0; lane < lane_count; ++lane)
    scatter_slopes<Shape, Beside::Derivatives, false>(weights, lane, hoop[lane], X[lane], Y[lane], Record{}, force);
}

// The x coordinates of four particles.
OGIVE_INLINE Lanes load_x(const KernelParticles& particles, std::int64_t p) {
  Lanes x, y, z, mass;
  load_records(particles.position + 4 * p, x, y, z, mass);
  return x;
}

// -V (sigma - q I) / h, `volume` being V / h.
template <class V>
OGIVE_INLINE Symmetric<V> stress_times_volume(const Symmetric<V>& stress, V volume, V q) {
  volume = -volume;
  return {volume * (stress.xx - q), volume * (stress.yy - q), volume * (stress.zz - q),
          volume * stress.yz,       volume * stress.xz,       volume * stress.xy};
}

OGIVE_INLINE void add_force(const KernelGroup& group, const Record* force) {
  add_tile(
      group, force, [](const KernelGroup& g, int block) { return g.nodes[block] ? g.nodes[block]->f : nullptr; },
      sizeof(NodeRecord) / sizeof(double));
}

template <class V>
OGIVE_INLINE Symmetric<V> load_stress(const KernelParticles& particles, std::int64_t p) {
  return {load_aligned<V>(particles.stress[0] + p), load_aligned<V>(particles.stress[1] + p),
          load_aligned<V>(particles.stress[2] + p), load_aligned<V>(particles.stress[3] + p),
          load_aligned<V>(particles.stress[4] + p), load_aligned<V>(particles.stress[5] + p)};
}

// The law is evaluated for as many particles at once as a register holds, at least four.
constexpr int law_width = native_width == 8 ? 8 : 4;
using LawLanes = Vec<law_width>;
static_assert(group_padding % law_width == 0, "groups are padded to the law's width");

template <int strength>
OGIVE_INLINE void prefetch_scalars(const KernelParticles& particles, std::int64_t p) {
  for (double* const component : particles.stress) prefetch(component, p);
  prefetch(particles.volume_ratio, p);
  prefetch(particles.energy, p);
  if constexpr (is_plastic(strength)) {
    prefetch(particles.plastic_strain, p);
    prefetch(particles.yield_stress, p);
    prefetch(particles.temperature, p);
  }
  if constexpr (is_hyperelastic(strength))
    for (double* const component : particles.deformation) prefetch(component, p);
}

// What a law needs of the particles from p on. The deformation gradient comes along for laws of it.
template <int strength>
OGIVE_INLINE void load_state(const KernelParticles& particles, const KernelMaterial& material, std::int64_t p,
                             LawState<LawLanes>& s) {
  s.temperature = LawLanes{};
  if constexpr (!is_hyperelastic(strength)) s.stress = load_stress<LawLanes>(particles, p);
  s.volume_ratio = load_aligned<LawLanes>(particles.volume_ratio + p);
  s.energy = load_aligned<LawLanes>(particles.energy + p);
  if constexpr (is_plastic(strength)) {
    s.plastic_strain = load_aligned<LawLanes>(particles.plastic_strain + p);
    s.yield_stress = load_aligned<LawLanes>(particles.yield_stress + p);
    if (strength == strength_johnson_cook && material.thermal)
      s.temperature = load_aligned<LawLanes>(particles.temperature + p);
  }
  if constexpr (is_hyperelastic(strength))
    for (int c = 0; c < 9; ++c) s.F[c / 3][c % 3] = load_aligned<LawLanes>(particles.deformation[c] + p);
  for (int c = 0; c < history_size(strength); ++c) s.history[c] = load_aligned<LawLanes>(particles.history[c] + p);
}

// What the law made of it, and what it says for the sums over particles.
template <int strength>
OGIVE_INLINE void store_state(const KernelParticles& particles, const KernelMaterial& material, std::int64_t p,
                              const LawState<LawLanes>& s) {
  store_aligned(particles.stress[0] + p, s.stress.xx);
  store_aligned(particles.stress[1] + p, s.stress.yy);
  store_aligned(particles.stress[2] + p, s.stress.zz);
  store_aligned(particles.stress[3] + p, s.stress.yz);
  store_aligned(particles.stress[4] + p, s.stress.xz);
  store_aligned(particles.stress[5] + p, s.stress.xy);
  store_aligned(particles.volume_ratio + p, s.volume_ratio);
  store_aligned(particles.energy + p, s.energy);
  if constexpr (is_hyperelastic(strength))
    for (int c = 0; c < 9; ++c) store_aligned(particles.deformation[c] + p, s.F[c / 3][c % 3]);
  if constexpr (is_plastic(strength)) {
    if (!s.plastic_changed) return;
    store_aligned(particles.plastic_strain + p, s.plastic_strain);
    store_aligned(particles.yield_stress + p, s.yield_stress);
    if (strength == strength_johnson_cook && material.thermal)
      store_aligned(particles.temperature + p, s.temperature);
    for (int c = 0; c < history_size(strength); ++c) store_aligned(particles.history[c] + p, s.history[c]);
  }
}

// Sums over the particles of a group.
struct LawSums {
  LawLanes plastic_work{}, viscous_work{};
};

OGIVE_INLINE void begin_sums(StressSums& sums) {
  sums.failure_loss = sums.failed_mass = sums.worst_distortion = sums.speed_squared = 0;
  sums.failed_particles = 0;
  sums.bad_particle = -1;
}

template <int strength>
OGIVE_INLINE void take_sums(const LawState<LawLanes>& s, LawLanes mass, LawLanes initial_volume, std::int64_t p,
                            LawSums& law, StressSums& sums) {
  if constexpr (is_plastic(strength)) {
    if (s.plastic_changed) {
      law.plastic_work += initial_volume * s.plastic_work;
      if (any(s.newly_failed))
        for (int lane = 0; lane < law_width; ++lane)
          if (s.newly_failed[lane] && mass[lane] > 0) {
            ++sums.failed_particles;
            sums.failed_mass += mass[lane];
            sums.failure_loss += initial_volume[lane] * s.failure_loss[lane];
          }
    }
  }
  law.viscous_work += initial_volume * s.viscous_work;
  // Also catches what is not a number.
  if (!all((s.volume_ratio > 1e-6) & (s.volume_ratio < 1e6) & (s.wave_speed_squared < 1e300)) && sums.bad_particle < 0)
    for (int lane = law_width - 1; lane >= 0; --lane)
      if (!(s.volume_ratio[lane] > 1e-6 && s.volume_ratio[lane] < 1e6 && s.wave_speed_squared[lane] < 1e300))
        sums.bad_particle = p + lane;
}

OGIVE_INLINE void end_sums(LawLanes fastest, const LawSums& law, StressSums& sums) {
  sums.fastest = sums.plastic_dissipation = sums.viscous_dissipation = 0;
  for (int lane = 0; lane < law_width; ++lane) {
    if (fastest[lane] > sums.fastest) sums.fastest = fastest[lane];
    sums.plastic_dissipation += law.plastic_work[lane];
    sums.viscous_dissipation += law.viscous_work[lane];
  }
}

// Eq. (31) by itself.
template <class Shape>
void map_internal_force(const KernelGroup& group, const KernelParticles& particles) {
  alignas(64) Record force[tile_size];
  clear_tile(group, force);
  Scatter<Shape> sums;
  Scatter<Shape>::begin(sums, force);
  Weights weights;
  for (std::int64_t p = group.begin; p < group.end; p += lane_count) {
    Lanes x, y, z, mass;
    load_records(particles.position + 4 * p, x, y, z, mass);
    fill<Shape, Beside::Derivatives>(weights, group, x, y, z);
    const Lanes volume =
        mass * (group.inverse_density * group.inverse_cell) * load_aligned<Lanes>(particles.volume_ratio + p);
    const Lanes q = particles.viscous_pressure ? load_aligned<Lanes>(particles.viscous_pressure + p) : Lanes{};
    const Symmetric<Lanes> product = stress_times_volume(load_stress<Lanes>(particles, p), volume, q);
    if constexpr (is_planar<Shape>)
      scatter_planar_stress<Shape>(weights, product, cells_by_radius(group, x), sums);
    else
      scatter_stress<Shape>(weights, product, sums);
  }
  Scatter<Shape>::end(sums);
  add_force(group, force);
}

template <class Shape, int strength, int eos>
void update_stress(const KernelGroup& group, const KernelParticles& particles, const KernelMaterial& material,
                   StressSums& sums) {
  alignas(64) Record velocity[tile_size];
  alignas(64) Record force[tile_size];
  read_tile(group, [&](int t, const NodeRecord& record) { velocity[t] = load_aligned<Record>(record.v); });
  clear_tile(group, force);
  Scatter<Shape> forces;
  Scatter<Shape>::begin(forces, force);

  const Record low = load<Record>(group.bound_low), high = load<Record>(group.bound_high);
  IntVec<4> all_inside = low <= high;
  LawLanes fastest{};
  LawSums law_sums;
  begin_sums(sums);
  // A stretch of particles goes through gather, law and scatter in turn: within each of these the particles do not wait
  // for one another.
  Weights weights[stretch / lane_count];
  alignas(64) double speeds_squared[stretch], gradients[3][3][stretch], products[6][stretch];
  for (std::int64_t start = group.begin; start < group.end; start += stretch) {
    const int count = fill_stretch<Shape, Beside::Derivatives>(weights, group, particles.position, start);
    for (int i = 0; i < count; i += lane_count) {
      // Rows of records to lanes: after the transposes gradient[j][i] holds dv_i/dx_j of four particles.
      Record gradient[3][lane_count], motion[lane_count];
      for (int lane = 0; lane < lane_count; ++lane)
        gather_slopes<Shape, Beside::Derivatives>(weights[i / lane_count], lane, velocity, motion[lane],
                                                  gradient[0][lane], gradient[1][lane], gradient[2][lane]);
      transpose(motion[0], motion[1], motion[2], motion[3]);
      store_aligned(speeds_squared + i, motion[0] * motion[0] + motion[1] * motion[1] + motion[2] * motion[2]);
      for (int b = 0; b < 3; ++b) {
        transpose(gradient[b][0], gradient[b][1], gradient[b][2], gradient[b][3]);
        for (int a = 0; a < 3; ++a) store_aligned(gradients[a][b] + i, gradient[b][a]);
      }
      // The hoop rate v_r / r, which vanishes in plane strain.
      if constexpr (is_planar<Shape>)
        store_aligned(gradients[2][2] + i, motion[0] * cells_by_radius(group, load_x(particles, start + i)));
    }
    for (int part = 0; part < count; part += law_width) {
      const std::int64_t p = start + part;
      prefetch_scalars<strength>(particles, p + prefetch_distance);
      Vec<law_width> x, y, z, mass;
      load_records(particles.position + 4 * p, x, y, z, mass);
      LawState<LawLanes> s;
      s.dt = broadcast<LawLanes>(group.time_step);
      const double steps_per_cell = group.time_step * group.inverse_cell;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) s.L[i][j] = load_aligned<LawLanes>(gradients[i][j] + part) * steps_per_cell;

      load_state<strength>(particles, material, p, s);
      update_law<strength, eos>(material, s);
      store_state<strength>(particles, material, p, s);
      const LawLanes initial_volume = mass * group.inverse_density;
      take_sums<strength>(s, mass, initial_volume, p, law_sums, sums);
      // c + |v|; the second root is needed only where |v| is above what `fastest` leaves to it.
      const LawLanes wave = sqrt(s.wave_speed_squared), moving = load_aligned<LawLanes>(speeds_squared + part);
      const LawLanes left = max(fastest - wave, LawLanes{});
      if (any(moving >= left * left)) fastest = max(wave + sqrt(moving), fastest);

      if (particles.displacement) {
        if (particles.viscous_pressure) store_aligned(particles.viscous_pressure + p, s.viscous_pressure);
        for (int lane = 0; lane < law_width; ++lane) {
          double* position = particles.position + 4 * (p + lane);
          const Record moved =
              load_aligned<Record>(position) + load_aligned<Record>(particles.displacement + 4 * (p + lane));
          all_inside &= (moved >= low) & (moved <= high);
          store_aligned(position, moved);
        }
      } else {
        const Symmetric<LawLanes> product =
            stress_times_volume(s.stress, initial_volume * s.volume_ratio * group.inverse_cell, s.viscous_pressure);
        store_aligned(products[0] + part, product.xx);
        store_aligned(products[1] + part, product.yy);
        store_aligned(products[2] + part, product.zz);
        store_aligned(products[3] + part, product.yz);
        store_aligned(products[4] + part, product.xz);
        store_aligned(products[5] + part, product.xy);
      }
    }
    if (!particles.displacement)
      for (int i = 0; i < count; i += lane_count) {
        const Symmetric<Lanes> product = {load_aligned<Lanes>(products[0] + i), load_aligned<Lanes>(products[1] + i),
                                          load_aligned<Lanes>(products[2] + i), load_aligned<Lanes>(products[3] + i),
                                          load_aligned<Lanes>(products[4] + i), load_aligned<Lanes>(products[5] + i)};
        if constexpr (is_planar<Shape>)
          scatter_planar_stress<Shape>(weights[i / lane_count], product,
                                       cells_by_radius(group, load_x(particles, start + i)), forces);
        else
          scatter_stress<Shape>(weights[i / lane_count], product, forces);
      }
  }
  if (!particles.displacement) {
    Scatter<Shape>::end(forces);
    add_force(group, force);
  }
  sums.outside = !all(all_inside);
  end_sums(fastest, law_sums, sums);
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
