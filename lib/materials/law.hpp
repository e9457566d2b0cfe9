// The constitutive update of a vector of particles: strain increment to stress, energy, plastic strain, temperature and
// failure. Strength (deviator) and equation of state (pressure) combine freely; what a law does not need is not compiled.
//
// Objective rate: the old deviator is turned by the Cayley rotation of the spin increment (Hughes & Winget 1980), which is
//   exactly orthogonal, so that a rigid rotation changes no invariant of stress.
// J2: radial return with yield stress A + B eps_p^n, Huang et al. 2010 Eq. (37), or Johnson-Cook, Eq. (39), solved by a
//   guarded Newton iteration, not by one explicit step.
// Pressure: linear p = -K ln J, or Mie-Grueneisen, Eq. (38), with E the internal energy per initial volume. The
//   Grueneisen coefficient is gamma = gamma0 / (1 + mu), so that on the Hugoniot (38) gives its pressure exactly. In
//   expansion the thermal part is gamma0 E / J, which meets (38) at J = 1 and lets debris cool as it expands instead of
//   keeping the pressure of the solid.
// Energy: dE = J_mid s_mid : deps - p_mid dJ, implicit in p_mid, solved in closed form.
// Failure: at eps_p >= failure_strain the deviator is zero and so is the pressure where the whole of it, cold and thermal
//   part together, would be tension; the elastic energy that goes with them is booked as failure loss. (Dropping the cold
//   part alone would let the heat of plastic work drive debris apart like a gas, to V / V0 of some hundred.)
// Laws of the deformation gradient: materials/finite_strain.hpp.
// Bulk viscosity: q = rho h |d| (c_q h |d| + c_l c) while the volume shrinks at rate d; it acts on the grid and heats, and
//   is no part of the stored stress.
#pragma once

#include "materials/finite_strain.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

enum { eos_linear = 0, eos_mie_gruneisen = 1 };

// R a R^T with the Cayley rotation of the half rotation vector (x, y, z) of this step; c = 2 / (1 + x^2 + y^2 + z^2).
template <class V>
OGIVE_INLINE Symmetric<V> rotated(const Symmetric<V>& a, V x, V y, V z, V c) {
  // R = I + c (W + W W), W the skew matrix of the half vector.
  const V r00 = 1.0 - c * (y * y + z * z), r01 = c * (x * y - z), r02 = c * (x * z + y);
  const V r10 = c * (x * y + z), r11 = 1.0 - c * (x * x + z * z), r12 = c * (y * z - x);
  const V r20 = c * (x * z - y), r21 = c * (y * z + x), r22 = 1.0 - c * (x * x + y * y);
  const V m00 = r00 * a.xx + r01 * a.xy + r02 * a.xz, m01 = r00 * a.xy + r01 * a.yy + r02 * a.yz,
          m02 = r00 * a.xz + r01 * a.yz + r02 * a.zz;
  const V m10 = r10 * a.xx + r11 * a.xy + r12 * a.xz, m11 = r10 * a.xy + r11 * a.yy + r12 * a.yz,
          m12 = r10 * a.xz + r11 * a.yz + r12 * a.zz;
  const V m20 = r20 * a.xx + r21 * a.xy + r22 * a.xz, m21 = r20 * a.xy + r21 * a.yy + r22 * a.yz,
          m22 = r20 * a.xz + r21 * a.yz + r22 * a.zz;
  return {m00 * r00 + m01 * r01 + m02 * r02, m10 * r10 + m11 * r11 + m12 * r12, m20 * r20 + m21 * r21 + m22 * r22,
          m10 * r20 + m11 * r21 + m12 * r22, m00 * r20 + m01 * r21 + m02 * r22, m00 * r10 + m01 * r11 + m02 * r12};
}

// A failed particle resists nothing while it opens: the ratio stays here at most. Beyond it what grows is the space between
// pieces, and debris in free flight would pass any bound in time (as (1 + c t)^3; a lone affine particle, whose rate of
// expansion c does not fall, exponentially).
constexpr double widest_opening = 1000;

// Thermal softening 1 - T*^m of Eq. (39), T* = (T - T_room) / (T_melt - T_room) within 0..1.
template <class V>
OGIVE_INLINE V thermal_softening(const KernelMaterial& m, V temperature) {
  V t = (temperature - m.room_temperature) * m.inverse_melt_range;
  t = min(max(t, broadcast<V>(0.0)), broadcast<V>(1.0));
  if (!any(t > 0.0)) return broadcast<V>(1.0);
  return 1.0 - select(t > 0.0, pow(t, broadcast<V>(m.thermal_exponent)), broadcast<V>(0.0));
}

// Solves seq - 3 G x = (A + B (eps_p + x)^n) theta (1 + C ln rate*) for the plastic strain increment x of the lanes in
// `plastic`. The left side minus the right falls monotonically and is convex, so Newton from any point ends left of the
// root after one step and climbs to it from there. It begins with the slope of the present yield stress, which costs no
// power: n (Y - A theta) / eps_p; where that is steep, soon after first yield, it begins right of the root instead.
template <class V, int strength>
OGIVE_INLINE V plastic_increment(const KernelMaterial& m, const LawState<V>& s, V equivalent, V theta,
                                 IntVecOf<V> plastic) {
  const V three_G = broadcast<V>(3.0 * m.G);
  const V present = max(m.n * (s.yield_stress - m.A * theta), broadcast<V>(0.0));
  const V present_strain = max(s.plastic_strain, broadcast<V>(1e-300));
  const V resistance = three_G * present_strain;
  V x = max((equivalent - s.yield_stress) * present_strain /
                (resistance + select(present < resistance, present, broadcast<V>(0.0))),
            broadcast<V>(0.0));
  IntVecOf<V> active = plastic;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const V strain = max(s.plastic_strain + x, broadcast<V>(1e-300));
    const V hardening = m.B * pow(strain, broadcast<V>(m.n));
    V flow = (m.A + hardening) * theta;
    V slope = m.n * hardening * theta / strain;
    if constexpr (strength == strength_johnson_cook) {
      if (m.rate_dependent) {
        const V rate = x * m.inverse_reference_rate / s.dt;
        const V factor = 1.0 + m.rate_coefficient * log(max(rate, broadcast<V>(1.0)));
        slope = slope * factor +
                select(rate > 1.0, flow * m.rate_coefficient / max(x, broadcast<V>(1e-300)), broadcast<V>(0.0));
        flow *= factor;
      }
    }
    const V miss = equivalent - three_G * x - flow;
    x = select(active, max(x + miss / (three_G + slope), 0.1 * x), x);
    // Newton squares the relative miss: below 1e-6 the step just taken leaves it at round-off. A lane that is there stays,
    // so that its result does not depend on its neighbours.
    active &= abs(miss) > 1e-6 * equivalent;
    if (!any(active)) break;
  }
  return select(plastic, x, broadcast<V>(0.0));
}

// Bulk viscosity, for the relative change of volume in the step from the ratio J_0 on.
template <class V>
OGIVE_INLINE void add_viscosity(const KernelMaterial& m, V volumetric, V J_0, LawState<V>& s) {
  const V zero = broadcast<V>(0.0);
  const V c = sqrt(s.wave_speed_squared);
  const V rate = max(-volumetric / s.dt, zero);
  const V speed = m.viscosity_quadratic * m.cell_size * rate + m.viscosity_linear * c;
  s.viscous_pressure = m.density / s.volume_ratio * m.cell_size * rate * speed;
  s.viscous_work = s.viscous_pressure * max(J_0 - s.volume_ratio, zero);
  s.energy += s.viscous_work;
  // The viscous time step: c is replaced by Q + sqrt(Q^2 + c^2), Q the viscous speed.
  const V Q = select(rate > 0.0, speed, zero);
  const V fast = Q + sqrt(Q * Q + s.wave_speed_squared);
  s.reference_speed_squared *= fast * fast / s.wave_speed_squared;
  s.wave_speed_squared = fast * fast;
}

template <int strength, int eos, class V>
OGIVE_INLINE void update_law(const KernelMaterial& m, LawState<V>& s) {
  constexpr bool plastic_law = strength == strength_j2_power || strength == strength_johnson_cook;
  const V zero = broadcast<V>(0.0);
  const Symmetric<V> D = {s.L[0][0],
                          s.L[1][1],
                          s.L[2][2],
                          0.5 * (s.L[1][2] + s.L[2][1]),
                          0.5 * (s.L[0][2] + s.L[2][0]),
                          0.5 * (s.L[0][1] + s.L[1][0])};
  const V volumetric = trace(D);
  const V J0 = s.volume_ratio;
  s.plastic_work = s.failure_loss = s.viscous_work = s.viscous_pressure = s.reference_speed_squared = zero;
  s.newly_failed = zero > zero;
  s.plastic_changed = false;

  if constexpr (is_hyperelastic(strength)) {
    // F := (I + L + L L / 2) F, to second order so that a rotation does not stretch.
    V F_0[3][3], A[3][3], B[3][3];
    for (int i = 0; i < 9; ++i) F_0[i / 3][i % 3] = s.F[i / 3][i % 3];
    multiply(s.L, F_0, A);
    multiply(s.L, A, B);
    for (int i = 0; i < 9; ++i) s.F[i / 3][i % 3] += A[i / 3][i % 3] + 0.5 * B[i / 3][i % 3];
    update_from_gradient<strength>(m, F_0, s);
  } else {
    V J1 = J0 * (1.0 + volumetric);  // Eq. (30)
    IntVecOf<V> failed = zero > zero;
    if constexpr (plastic_law) {
      failed = s.plastic_strain >= m.failure_strain;
      J1 = select(failed, min(J1, broadcast<V>(widest_opening)), J1);
    }
    const V dJ = J1 - J0, half_gamma = broadcast<V>(0.5 * m.gruneisen);

    // One division for all, because a processor multiplies ten times meanwhile: by N of the rotation; of Mie-Grueneisen by J,
    // by H, the Hugoniot's denominator times J, and by F of the implicit pressure (below).
    const V turn_x = 0.25 * (s.L[2][1] - s.L[1][2]), turn_y = 0.25 * (s.L[0][2] - s.L[2][0]),
            turn_z = 0.25 * (s.L[1][0] - s.L[0][1]);
    const V N = 1.0 + turn_x * turn_x + turn_y * turn_y + turn_z * turn_z;
    V inverse_N, inverse_J, inverse_H, inverse_F, thermal_volume;
    if constexpr (eos == eos_mie_gruneisen) {
      // The Hugoniot's pole (mu = 1 / (s - 1)) is kept out of reach: beyond it Eq. (38) has no meaning.
      const V H = max(1.0 - m.slope * (1.0 - J1), 0.1 * J1);
      thermal_volume = max(J1, broadcast<V>(1.0));
      const V F = max(thermal_volume + half_gamma * dJ, 0.25 * thermal_volume);
      const V NJ = N * J1, HF = H * F, inverse = 1.0 / (NJ * HF);
      inverse_N = inverse * HF * J1;
      inverse_J = inverse * HF * N;
      inverse_H = inverse * NJ * F;
      inverse_F = inverse * NJ * H;
    } else {
      inverse_N = 1.0 / N;
    }

    const V p0 = -(1.0 / 3.0) * trace(s.stress);
    const Symmetric<V> old_deviator =
        rotated<V>({s.stress.xx + p0, s.stress.yy + p0, s.stress.zz + p0, s.stress.yz, s.stress.xz, s.stress.xy},
                   turn_x, turn_y, turn_z, 2.0 * inverse_N);
    const V two_G = broadcast<V>(2.0 * m.G), mean = (1.0 / 3.0) * volumetric;
    Symmetric<V> deviator = {old_deviator.xx + two_G * (D.xx - mean), old_deviator.yy + two_G * (D.yy - mean),
                             old_deviator.zz + two_G * (D.zz - mean), old_deviator.yz + two_G * D.yz,
                             old_deviator.xz + two_G * D.xz,          old_deviator.xy + two_G * D.xy};
    const V J_mid = 0.5 * (J0 + J1);

    if constexpr (plastic_law) {
      const V equivalent_squared = 1.5 * contract(deviator, deviator);
      const IntVecOf<V> plastic = (equivalent_squared > s.yield_stress * s.yield_stress) & ~failed;
      if (any(plastic)) {
        const V equivalent = sqrt(equivalent_squared);
        V theta = broadcast<V>(1.0);
        if constexpr (strength == strength_johnson_cook)
          if (m.thermal) theta = thermal_softening(m, s.temperature);
        const V x = plastic_increment<V, strength>(m, s, equivalent, theta, plastic);
        const V flow = equivalent - 3.0 * m.G * x;
        const V shrink = select(plastic, flow / max(equivalent, broadcast<V>(1e-300)), broadcast<V>(1.0));
        deviator = {deviator.xx * shrink, deviator.yy * shrink, deviator.zz * shrink,
                    deviator.yz * shrink, deviator.xz * shrink, deviator.xy * shrink};
        s.plastic_strain += x;
        s.plastic_work = J_mid * flow * x;
        // The flow stress that was solved for is A + B eps_p^n softened and, at a rate, raised: without a rate no power of
        // the new strain is needed.
        V hardened = flow;
        if constexpr (strength == strength_johnson_cook) {
          if (m.rate_dependent)
            hardened = m.A + m.B * pow(max(s.plastic_strain, broadcast<V>(1e-300)), broadcast<V>(m.n));
          else if (m.thermal)
            hardened = max(flow, zero) / max(theta, broadcast<V>(1e-300));
          if (m.thermal) {
            s.temperature += m.heating * s.plastic_work;
            hardened *= thermal_softening(m, s.temperature);
          }
        }
        s.yield_stress = select(plastic, hardened, s.yield_stress);
        s.newly_failed = plastic & (s.plastic_strain >= m.failure_strain);
        s.plastic_changed = true;
      }
      deviator = {select(failed, zero, deviator.xx), select(failed, zero, deviator.yy),
                  select(failed, zero, deviator.zz), select(failed, zero, deviator.yz),
                  select(failed, zero, deviator.xz), select(failed, zero, deviator.xy)};
    }

    const Symmetric<V> middle = {old_deviator.xx + deviator.xx, old_deviator.yy + deviator.yy,
                                 old_deviator.zz + deviator.zz, old_deviator.yz + deviator.yz,
                                 old_deviator.xz + deviator.xz, old_deviator.xy + deviator.xy};
    V energy = s.energy + 0.5 * J_mid * contract(middle, D);

    V p1, modulus;
    if constexpr (eos == eos_linear) {
      p1 = -m.K * log(J1);
      p1 = select(failed, max(p1, zero), p1);
      energy -= 0.5 * (p0 + p1) * dJ;
      modulus = broadcast<V>(m.K);
    } else {
      const V mu = (1.0 - J1) * inverse_J;
      const IntVecOf<V> compressed = mu > 0.0;
      const V inverse = J1 * inverse_H;  // 1 / (1 - (s - 1) mu)
      const V scale = m.rho_c0_squared * inverse * inverse;
      const V hugoniot = scale * mu * inverse_J;
      const V cold_compressed = hugoniot * (1.0 - half_gamma * mu * J1);
      const V cold_expanded = m.rho_c0_squared * mu;
      const V cold = select(compressed, cold_compressed, cold_expanded);
      const V thermal = m.gruneisen * select(compressed, broadcast<V>(1.0), inverse_J);
      // p1 = cold + thermal (energy - (p0 + p1) dJ / 2), solved for p1, with thermal = gamma0 / max(J, 1). The factor of p1,
      // F / max(J, 1), is 1 - O(strain increment): it comes near zero only if a volume halves within one step, and is then
      // held, which only makes p1 less implicit.
      p1 = (cold * thermal_volume + m.gruneisen * (energy - 0.5 * p0 * dJ)) * inverse_F;
      p1 = select(failed, max(p1, zero), p1);
      energy -= 0.5 * (p0 + p1) * dJ;
      const V slope_of_hugoniot = scale * (1.0 + 2.0 * mu + 2.0 * (m.slope - 1.0) * mu * inverse_J * inverse);
      const V stiffness_compressed = inverse_J * (slope_of_hugoniot * (1.0 - half_gamma * mu * J1) -
                                                  hugoniot * half_gamma * J1 * J1) +
                                     m.gruneisen * J1 * max(p1, zero);
      const V stiffness_expanded =
          m.rho_c0_squared * inverse_J + (1.0 + m.gruneisen) * thermal * max(energy, zero);
      modulus = select(compressed, max(stiffness_compressed, broadcast<V>(m.rho_c0_squared)), stiffness_expanded);
    }

    if constexpr (plastic_law) {
      if (any(s.newly_failed)) {
        // The deviator's elastic energy and, in tension, that of the pressure leave the particle.
        const V tension = max(-p1, zero);
        const V loss = J1 * (contract(deviator, deviator) * (0.25 / m.G) + 0.5 * tension * tension / modulus);
        s.failure_loss = select(s.newly_failed, loss, zero);
        energy -= s.failure_loss;
        deviator = {select(s.newly_failed, zero, deviator.xx), select(s.newly_failed, zero, deviator.yy),
                    select(s.newly_failed, zero, deviator.zz), select(s.newly_failed, zero, deviator.yz),
                    select(s.newly_failed, zero, deviator.xz), select(s.newly_failed, zero, deviator.xy)};
        p1 = select(s.newly_failed, max(p1, zero), p1);
      }
    }

    s.stress = {deviator.xx - p1, deviator.yy - p1, deviator.zz - p1, deviator.yz, deviator.xz, deviator.xy};
    // What has failed carries no shear wave; without this, debris that has opened up would shorten everybody's step.
    const V shear = select(failed, zero, broadcast<V>((4.0 / 3.0) * m.G));
    s.wave_speed_squared = (modulus + shear) * J1 * (1.0 / m.density);
    s.energy = energy;
    s.volume_ratio = J1;
  }

  if (m.viscous) add_viscosity(m, volumetric, J0, s);
}

// The same for a body that keeps its reference configuration: from F_0 to F_1. Laws of the rate get the velocity gradient of
// the middle of the step, whose trace is then made to fit the exact change of volume.
template <int strength, int eos, class V>
OGIVE_INLINE void update_law_between(const KernelMaterial& m, const V (&F_0)[3][3], const V (&F_1)[3][3], LawState<V>& s) {
  const V J0 = s.volume_ratio;
  if constexpr (is_hyperelastic(strength)) {
    s.plastic_work = s.failure_loss = s.viscous_work = s.viscous_pressure = broadcast<V>(0.0);
    s.newly_failed = J0 > J0;
    s.plastic_changed = false;
    for (int i = 0; i < 9; ++i) s.F[i / 3][i % 3] = F_1[i / 3][i % 3];
    update_from_gradient<strength>(m, F_0, s);
    if (m.viscous) add_viscosity(m, s.volume_ratio / J0 - 1.0, J0, s);
  } else {
    V middle[3][3], change[3][3], inverse[3][3];
    for (int i = 0; i < 9; ++i) {
      middle[i / 3][i % 3] = 0.5 * (F_0[i / 3][i % 3] + F_1[i / 3][i % 3]);
      change[i / 3][i % 3] = F_1[i / 3][i % 3] - F_0[i / 3][i % 3];
    }
    invert(middle, 1.0 / determinant(middle), inverse);
    multiply(change, inverse, s.L);
    const V miss = (determinant(F_1) / J0 - 1.0 - (s.L[0][0] + s.L[1][1] + s.L[2][2])) * (1.0 / 3.0);
    for (int i = 0; i < 3; ++i) s.L[i][i] += miss;
    update_law<strength, eos>(m, s);
    s.reference_speed_squared = s.wave_speed_squared * largest_eigenvalue_bound(inverse_of(right_cauchy_green(F_1)));
  }
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
