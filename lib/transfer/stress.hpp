// Velocity gradient to strain increment (29), density (30), stress, and internal force (31) in one pass over a group:
// Huang et al. 2010, section 4, steps 4 and 5. Where the stress comes last (MUSL), the pass moves the particles instead, by
// the displacement that the particle update left, and the force is mapped by itself in the next step.
#pragma once

#include "materials/law.hpp"
#include "transfer/transfer.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

// Adds -V (sigma - q I) grad N, Eq. (31), for four particles; `volume` is the present one.
template <class Shape>
OGIVE_INLINE void scatter_stress(const Weights<Shape>& weights, Lanes volume, const Symmetric<Lanes>& stress, Lanes q,
                                 Record* force) {
  volume = -volume;
  Lanes X[4] = {volume * (stress.xx - q), volume * stress.xy, volume * stress.xz, Lanes{}};
  Lanes Y[4] = {X[1], volume * (stress.yy - q), volume * stress.yz, Lanes{}};
  Lanes Z[4] = {X[2], Y[2], volume * (stress.zz - q), Lanes{}};
  transpose(X[0], X[1], X[2], X[3]);
  transpose(Y[0], Y[1], Y[2], Y[3]);
  transpose(Z[0], Z[1], Z[2], Z[3]);
  for (int lane = 0; lane < lane_count; ++lane)
    scatter_gradient<Shape>(weights, lane, X[lane], Y[lane], Z[lane], force);
}

OGIVE_INLINE void add_force(const KernelGroup& group, const Record* force) {
  for_tile_nodes(group, [&](int t, int block, int node) {
    double* f = group.nodes[block][node].f;
    store_aligned(f, load_aligned<Record>(f) + force[t]);
  });
}

template <class V>
OGIVE_INLINE Symmetric<V> load_stress(const KernelParticles& particles, std::int64_t p) {
  return {load_aligned<V>(particles.stress[0] + p), load_aligned<V>(particles.stress[1] + p),
          load_aligned<V>(particles.stress[2] + p), load_aligned<V>(particles.stress[3] + p),
          load_aligned<V>(particles.stress[4] + p), load_aligned<V>(particles.stress[5] + p)};
}

// The law is evaluated for as many particles at once as a register holds, at least four.
constexpr int law_width = native_width == 8 ? 8 : 4;
constexpr int law_parts = law_width / lane_count;
using LawLanes = Vec<law_width>;
static_assert(group_padding % law_width == 0, "groups are padded to the law's width");

// Four lanes of each part to the law's lanes, and back.
OGIVE_INLINE Vec<4> join_parts(const Lanes (&parts)[1]) { return parts[0]; }
OGIVE_INLINE Vec<8> join_parts(const Lanes (&parts)[2]) { return join(parts[0], parts[1]); }
OGIVE_INLINE Lanes part_of(Vec<4> v, int) { return v; }
OGIVE_INLINE Lanes part_of(Vec<8> v, int part) { return part == 0 ? lower_half(v) : upper_half(v); }


// Eq. (31) by itself.
template <class Shape>
void map_internal_force(const KernelGroup& group, const KernelParticles& particles) {
  alignas(64) Record force[tile_size];
  clear_tile(group, force);
  Weights<Shape> weights;
  for (std::int64_t p = group.begin; p < group.end; p += lane_count) {
    Lanes x, y, z, mass;
    load_records(particles.position + 4 * p, x, y, z, mass);
    fill<Beside::Derivatives>(weights, group, x, y, z);
    const Lanes volume = mass * group.inverse_density * load_aligned<Lanes>(particles.volume_ratio + p);
    const Lanes q = particles.viscous_pressure ? load_aligned<Lanes>(particles.viscous_pressure + p) : Lanes{};
    scatter_stress<Shape>(weights, volume, load_stress<Lanes>(particles, p), q, force);
  }
  add_force(group, force);
}

template <class Shape, int strength, int eos>
void update_stress(const KernelGroup& group, const KernelParticles& particles, const KernelMaterial& material,
                   StressSums& sums) {
  constexpr bool plastic = strength == strength_j2_power || strength == strength_johnson_cook;
  constexpr bool hyperelastic = strength == strength_neo_hookean;
  alignas(64) Record velocity[tile_size];
  alignas(64) Record force[tile_size];
  for_tile_nodes(group, [&](int t, int block, int node) {
    velocity[t] = load_aligned<Record>(group.nodes[block][node].v);
    force[t] = Record{};
  });

  const Record low = load<Record>(group.bound_low), high = load<Record>(group.bound_high);
  IntVec<4> all_inside = low <= high;
  LawLanes fastest{}, plastic_work{}, viscous_work{};
  sums.failure_loss = sums.failed_mass = 0;
  sums.failed_particles = 0;
  sums.bad_particle = -1;
  Weights<Shape> weights[law_parts];
  for (std::int64_t p = group.begin; p < group.end; p += law_width) {
    Lanes mass_of[law_parts], speed_squared[law_parts], dv[3][3][law_parts];  // dv[i][j]: dv_i/dx_j
    for (int part = 0; part < law_parts; ++part) {
      Lanes x, y, z;
      load_records(particles.position + 4 * (p + part * lane_count), x, y, z, mass_of[part]);
      fill<Beside::Derivatives>(weights[part], group, x, y, z);
      // Rows of records to lanes: after the transposes gradient[j][i] holds dv_i/dx_j of four particles.
      Record gradient[3][lane_count], motion[lane_count];
      for (int lane = 0; lane < lane_count; ++lane)
        gather_gradient<Shape>(weights[part], lane, velocity + static_cast<std::int64_t>(weights[part].first[lane]),
                               motion[lane], gradient[0][lane], gradient[1][lane], gradient[2][lane]);
      transpose(motion[0], motion[1], motion[2], motion[3]);
      speed_squared[part] = motion[0] * motion[0] + motion[1] * motion[1] + motion[2] * motion[2];
      for (int j = 0; j < 3; ++j) {
        transpose(gradient[j][0], gradient[j][1], gradient[j][2], gradient[j][3]);
        for (int i = 0; i < 3; ++i) dv[i][j][part] = gradient[j][i];
      }
    }
    const LawLanes mass = join_parts(mass_of);
    LawState<LawLanes> s;
    s.temperature = LawLanes{};
    s.dt = broadcast<LawLanes>(group.time_step);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) s.L[i][j] = join_parts(dv[i][j]) * group.time_step;

    if constexpr (!hyperelastic) s.stress = load_stress<LawLanes>(particles, p);
    s.volume_ratio = load_aligned<LawLanes>(particles.volume_ratio + p);
    s.energy = load_aligned<LawLanes>(particles.energy + p);
    if constexpr (plastic) {
      s.plastic_strain = load_aligned<LawLanes>(particles.plastic_strain + p);
      s.yield_stress = load_aligned<LawLanes>(particles.yield_stress + p);
      if (strength == strength_johnson_cook && material.thermal)
        s.temperature = load_aligned<LawLanes>(particles.temperature + p);
    }
    if constexpr (hyperelastic)
      for (int c = 0; c < 9; ++c) s.F[c / 3][c % 3] = load_aligned<LawLanes>(particles.deformation[c] + p);

    update_law<strength, eos>(material, s);

    store_aligned(particles.stress[0] + p, s.stress.xx);
    store_aligned(particles.stress[1] + p, s.stress.yy);
    store_aligned(particles.stress[2] + p, s.stress.zz);
    store_aligned(particles.stress[3] + p, s.stress.yz);
    store_aligned(particles.stress[4] + p, s.stress.xz);
    store_aligned(particles.stress[5] + p, s.stress.xy);
    store_aligned(particles.volume_ratio + p, s.volume_ratio);
    store_aligned(particles.energy + p, s.energy);
    if constexpr (hyperelastic)
      for (int c = 0; c < 9; ++c) store_aligned(particles.deformation[c] + p, s.F[c / 3][c % 3]);

    const LawLanes initial_volume = mass * group.inverse_density;
    if constexpr (plastic) {
      if (s.plastic_changed) {
        store_aligned(particles.plastic_strain + p, s.plastic_strain);
        store_aligned(particles.yield_stress + p, s.yield_stress);
        if (strength == strength_johnson_cook && material.thermal)
          store_aligned(particles.temperature + p, s.temperature);
        plastic_work += initial_volume * s.plastic_work;
        if (any(s.newly_failed))
          for (int lane = 0; lane < law_width; ++lane)
            if (s.newly_failed[lane] && mass[lane] > 0) {
              ++sums.failed_particles;
              sums.failed_mass += mass[lane];
              sums.failure_loss += initial_volume[lane] * s.failure_loss[lane];
            }
      }
    }
    viscous_work += initial_volume * s.viscous_work;
    fastest = max(sqrt(s.wave_speed_squared) + sqrt(join_parts(speed_squared)), fastest);
    // Also catches what is not a number.
    if (!all((s.volume_ratio > 1e-6) & (s.volume_ratio < 1e6) & (s.wave_speed_squared < 1e300)) && sums.bad_particle < 0)
      for (int lane = law_width - 1; lane >= 0; --lane)
        if (!(s.volume_ratio[lane] > 1e-6 && s.volume_ratio[lane] < 1e6 && s.wave_speed_squared[lane] < 1e300))
          sums.bad_particle = p + lane;

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
      const LawLanes volume = initial_volume * s.volume_ratio;
      for (int part = 0; part < law_parts; ++part) {
        const Symmetric<Lanes> stress = {part_of(s.stress.xx, part), part_of(s.stress.yy, part), part_of(s.stress.zz, part),
                                         part_of(s.stress.yz, part), part_of(s.stress.xz, part), part_of(s.stress.xy, part)};
        scatter_stress<Shape>(weights[part], part_of(volume, part), stress, part_of(s.viscous_pressure, part), force);
      }
    }
  }
  if (!particles.displacement) add_force(group, force);
  sums.outside = !all(all_inside);
  sums.fastest = 0;
  sums.plastic_dissipation = sums.viscous_dissipation = 0;
  for (int lane = 0; lane < law_width; ++lane) {
    if (fastest[lane] > sums.fastest) sums.fastest = fastest[lane];
    sums.plastic_dissipation += plastic_work[lane];
    sums.viscous_dissipation += viscous_work[lane];
  }
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
