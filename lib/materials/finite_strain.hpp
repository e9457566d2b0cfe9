// Laws of the deformation gradient F: neo-Hookean elasticity, and J2 plasticity with combined isotropic and kinematic
// hardening in two forms. Lee et al. 2005; c = 1 isotropic, c = 0 kinematic.
//
// In stress T (second Piola-Kirchhoff) and strain E = (F^T F - 1) / 2 (Green-Lagrange), exactly as printed:
//   E = E_e + E_p (2.1),  T = lambda tr(E_e) 1 + 2 G E_e (2.2),  n = dev T - b (2.8), (2.9)
//   f = |n| - sqrt(2/3) (sigma_Y + c H e) (2.10),  E_p' = g n/|n| (2.11),  b' = g 2/3 (1 - c) H n/|n| (2.12),
//   e' = g sqrt(2/3) (2.13).
// The flow direction is the trial one, so that the return is exact for a step: g = f* / (2 G + 2/3 H). Cauchy stress
// F T F^T / J. e is the particle's plastic strain.
//
// Multiplicative: F = F_e F_p, logarithmic elastic strain h = ln(F_e^T F_e) / 2 and its stress M = K tr(h) 1 + 2 G dev
// h in the intermediate configuration, where back stress and flow live, F_p' = exp(g N) F_p, N = n/|n|, n = dev M - b,
// with the same f, b', e'. A rotation of the body does not reach the intermediate configuration, so that neither needs
// a rate.
//
// Energy per initial volume: elastic energy, and the plastic work of the mean of the stresses before and after a step;
// for the first form that sum is exactly the work of the mean of T on the increment of E.
#pragma once

#include "simd/lanes.hpp"
#include "simd/vector_math.hpp"
#include "transfer/kernels.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

enum {
  strength_elastic = 0,
  strength_neo_hookean = 1,
  strength_j2_power = 2,
  strength_johnson_cook = 3,
  strength_j2_mixed = 4,
  strength_j2_multiplicative = 5
};

constexpr bool is_plastic(int strength) { return strength >= strength_j2_power; }
constexpr bool has_mixed_hardening(int strength) { return strength >= strength_j2_mixed; }
// Laws of F, not of the rate of strain.
constexpr bool is_hyperelastic(int strength) {
  return strength == strength_neo_hookean || has_mixed_hardening(strength);
}
// Values that a law remembers: E_p and b; the inverse of F_p row by row and b.
constexpr int history_size(int strength) {
  return strength == strength_j2_mixed ? 12 : strength == strength_j2_multiplicative ? 15 : 0;
}
constexpr int largest_history = 15;

template <class V>
struct Symmetric {
  V xx, yy, zz, yz, xz, xy;
};

template <class V>
OGIVE_INLINE V trace(const Symmetric<V>& a) {
  return a.xx + a.yy + a.zz;
}

template <class V>
OGIVE_INLINE V contract(const Symmetric<V>& a, const Symmetric<V>& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2.0 * (a.yz * b.yz + a.xz * b.xz + a.xy * b.xy);
}

// a + s b
template <class V>
OGIVE_INLINE Symmetric<V> combined(const Symmetric<V>& a, V s, const Symmetric<V>& b) {
  return {a.xx + s * b.xx, a.yy + s * b.yy, a.zz + s * b.zz, a.yz + s * b.yz, a.xz + s * b.xz, a.xy + s * b.xy};
}

template <class V>
OGIVE_INLINE Symmetric<V> scaled(V s, const Symmetric<V>& a) {
  return {s * a.xx, s * a.yy, s * a.zz, s * a.yz, s * a.xz, s * a.xy};
}

template <class V>
OGIVE_INLINE Symmetric<V> plus_diagonal(const Symmetric<V>& a, V d) {
  return {a.xx + d, a.yy + d, a.zz + d, a.yz, a.xz, a.xy};
}

// The product of two symmetric matrices that commute.
template <class V>
OGIVE_INLINE Symmetric<V> commuting_product(const Symmetric<V>& a, const Symmetric<V>& b) {
  return {a.xx * b.xx + a.xy * b.xy + a.xz * b.xz, a.xy * b.xy + a.yy * b.yy + a.yz * b.yz,
          a.xz * b.xz + a.yz * b.yz + a.zz * b.zz, a.xy * b.xz + a.yy * b.yz + a.yz * b.zz,
          a.xx * b.xz + a.xy * b.yz + a.xz * b.zz, a.xx * b.xy + a.xy * b.yy + a.xz * b.yz};
}

template <class V>
OGIVE_INLINE Symmetric<V> inverse_of(const Symmetric<V>& a) {
  const V c_xx = a.yy * a.zz - a.yz * a.yz, c_xy = a.yz * a.xz - a.xy * a.zz, c_xz = a.xy * a.yz - a.yy * a.xz;
  const V inverse = 1.0 / (a.xx * c_xx + a.xy * c_xy + a.xz * c_xz);
  return {c_xx * inverse,
          (a.xx * a.zz - a.xz * a.xz) * inverse,
          (a.xx * a.yy - a.xy * a.xy) * inverse,
          (a.xz * a.xy - a.xx * a.yz) * inverse,
          c_xz * inverse,
          c_xy * inverse};
}

// A bound of the largest eigenvalue (Gershgorin).
template <class V>
OGIVE_INLINE V largest_eigenvalue_bound(const Symmetric<V>& a) {
  return max(max(a.xx + abs(a.xy) + abs(a.xz), a.yy + abs(a.xy) + abs(a.yz)), a.zz + abs(a.xz) + abs(a.yz));
}

template <class V>
OGIVE_INLINE V determinant(const V (&F)[3][3]) {
  return F[0][0] * (F[1][1] * F[2][2] - F[1][2] * F[2][1]) - F[0][1] * (F[1][0] * F[2][2] - F[1][2] * F[2][0]) +
         F[0][2] * (F[1][0] * F[2][1] - F[1][1] * F[2][0]);
}

template <class V>
OGIVE_INLINE void invert(const V (&F)[3][3], V inverse_determinant, V (&out)[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      out[i][j] = (F[a][c] * F[b][d] - F[a][d] * F[b][c]) * inverse_determinant;
    }
}

template <class V>
OGIVE_INLINE void multiply(const V (&A)[3][3], const V (&B)[3][3], V (&out)[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[i][j] = A[i][0] * B[0][j] + A[i][1] * B[1][j] + A[i][2] * B[2][j];
}

// F^T F
template <class V>
OGIVE_INLINE Symmetric<V> right_cauchy_green(const V (&F)[3][3]) {
  const auto product = [&](int i, int j) { return F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j]; };
  return {product(0, 0), product(1, 1), product(2, 2), product(1, 2), product(0, 2), product(0, 1)};
}

// F F^T
template <class V>
OGIVE_INLINE Symmetric<V> left_cauchy_green(const V (&F)[3][3]) {
  const auto product = [&](int i, int j) { return F[i][0] * F[j][0] + F[i][1] * F[j][1] + F[i][2] * F[j][2]; };
  return {product(0, 0), product(1, 1), product(2, 2), product(1, 2), product(0, 2), product(0, 1)};
}

// F T F^T
template <class V>
OGIVE_INLINE Symmetric<V> pushed_forward(const V (&F)[3][3], const Symmetric<V>& T) {
  const V full[3][3] = {{T.xx, T.xy, T.xz}, {T.xy, T.yy, T.yz}, {T.xz, T.yz, T.zz}};
  V FT[3][3];
  multiply(F, full, FT);
  const auto product = [&](int i, int j) { return FT[i][0] * F[j][0] + FT[i][1] * F[j][1] + FT[i][2] * F[j][2]; };
  return {product(0, 0), product(1, 1), product(2, 2), product(1, 2), product(0, 2), product(0, 1)};
}

// ln C = 2 (Z + Z^3/3 + Z^5/5 + ...), Z = (C - 1)(C + 1)^-1, to Z^21: below 1e-13 for principal stretches of 1/1.5
// to 1.5.
template <class V>
OGIVE_INLINE Symmetric<V> logarithm(const Symmetric<V>& C) {
  const V one = broadcast<V>(1.0);
  const Symmetric<V> Z = commuting_product(plus_diagonal(C, -one), inverse_of(plus_diagonal(C, one)));
  const Symmetric<V> squared = commuting_product(Z, Z);
  Symmetric<V> series = {broadcast<V>(2.0 / 21), broadcast<V>(2.0 / 21), broadcast<V>(2.0 / 21), V{}, V{}, V{}};
  for (int k = 19; k >= 1; k -= 2) series = plus_diagonal(commuting_product(series, squared), broadcast<V>(2.0 / k));
  return commuting_product(series, Z);
}

// exp a, by its series to the sixth power from the eighth part of a: below 1e-15 for |a| < 0.2.
template <class V>
OGIVE_INLINE Symmetric<V> exponential(const Symmetric<V>& a) {
  const V one = broadcast<V>(1.0), zero = broadcast<V>(0.0);
  const Symmetric<V> part = scaled(broadcast<V>(0.125), a);
  Symmetric<V> sum = {one, one, one, zero, zero, zero};
  for (int k = 6; k >= 1; --k) sum = plus_diagonal(scaled(broadcast<V>(1.0 / k), commuting_product(sum, part)), one);
  for (int doubling = 0; doubling < 3; ++doubling) sum = commuting_product(sum, sum);
  return sum;
}

// What a vector of particles brings in and takes away.
template <class V>
struct LawState {
  V L[3][3];  // velocity gradient times the time step, L[i][j] = dv_i/dx_j dt
  V dt;
  Symmetric<V> stress;
  V volume_ratio, energy;
  V plastic_strain, yield_stress, temperature;
  V F[3][3];  // laws of F: at the end of the step
  V history[largest_history];
  // Results for the sums, per initial volume.
  V viscous_pressure, plastic_work, viscous_work, failure_loss, wave_speed_squared;
  V reference_speed_squared;  // of the fastest wave as it crosses the body before it deformed; laws of F
  IntVecOf<V> newly_failed;
  bool plastic_changed;
};

// sigma = ((lambda ln J) 1 + G (F F^T - 1)) / J, energy lambda/2 ln^2 J - G ln J + G/2 (tr F F^T - 3).
template <class V>
OGIVE_INLINE void neo_hookean(const KernelMaterial& m, LawState<V>& s) {
  const V zero = broadcast<V>(0.0);
  const V J = determinant(s.F), log_J = log(J);
  const Symmetric<V> b = left_cauchy_green(s.F);
  const V inverse_J = 1.0 / J;
  const V pressure_part = (m.lambda * log_J - m.G) * inverse_J, shear_part = m.G * inverse_J;
  s.stress = {pressure_part + shear_part * b.xx,
              pressure_part + shear_part * b.yy,
              pressure_part + shear_part * b.zz,
              shear_part * b.yz,
              shear_part * b.xz,
              shear_part * b.xy};
  s.energy = 0.5 * m.lambda * log_J * log_J - m.G * log_J + 0.5 * m.G * (trace(b) - 3.0);
  // Longitudinal wave along n: rho0 c^2 = lambda (1 - ln J) + G (1 + n b n), n b n by its bound.
  const V bulk = m.lambda * max(1.0 - log_J, zero) + m.G;
  s.wave_speed_squared = (bulk + m.G * largest_eigenvalue_bound(b)) * (1.0 / m.density);
  const V inverse_stretch = largest_eigenvalue_bound(inverse_of(right_cauchy_green(s.F)));
  s.reference_speed_squared = (bulk * inverse_stretch + m.G) * (1.0 / m.density);
  s.volume_ratio = J;
}

template <class V>
OGIVE_INLINE Symmetric<V> history_tensor(const LawState<V>& s, int first) {
  return {s.history[first],     s.history[first + 1], s.history[first + 2],
          s.history[first + 3], s.history[first + 4], s.history[first + 5]};
}

template <class V>
OGIVE_INLINE void remember(LawState<V>& s, int first, const Symmetric<V>& a) {
  s.history[first] = a.xx;
  s.history[first + 1] = a.yy;
  s.history[first + 2] = a.zz;
  s.history[first + 3] = a.yz;
  s.history[first + 4] = a.xz;
  s.history[first + 5] = a.xy;
}

// (2.10)-(2.13) for a trial stress: gives g and the direction, and changes back stress and plastic strain.
template <class V>
OGIVE_INLINE V mixed_return(const KernelMaterial& m, LawState<V>& s, const Symmetric<V>& trial, Symmetric<V>& back,
                            Symmetric<V>& direction) {
  constexpr double root = 0.816496580927726;  // sqrt(2/3)
  const Symmetric<V> n = combined(plus_diagonal(trial, (-1.0 / 3.0) * trace(trial)), broadcast<V>(-1.0), back);
  const V size = sqrt(contract(n, n));
  const V f = size - root * (m.A + m.isotropic * m.B * s.plastic_strain);
  const V g = max(f, broadcast<V>(0.0)) * (1.0 / (2.0 * m.G + 2.0 / 3.0 * m.B));
  direction = scaled(1.0 / max(size, broadcast<V>(1e-300)), n);
  back = combined(back, g * (2.0 / 3.0 * (1.0 - m.isotropic) * m.B), direction);
  s.plastic_strain += root * g;
  s.yield_stress = m.A + m.isotropic * m.B * s.plastic_strain;
  s.plastic_changed = any(g > 0.0);
  return g;
}

// s.F is the new gradient, F_0 the one before the step.
template <class V>
OGIVE_INLINE void j2_mixed(const KernelMaterial& m, const V (&F_0)[3][3], LawState<V>& s) {
  const V minus_one = broadcast<V>(-1.0), half = broadcast<V>(0.5);
  const auto strain = [&](const V(&F)[3][3]) { return scaled(half, plus_diagonal(right_cauchy_green(F), minus_one)); };
  const auto stress_of = [&](const Symmetric<V>& elastic) {
    return plus_diagonal(scaled(broadcast<V>(2.0 * m.G), elastic), m.lambda * trace(elastic));
  };
  const Symmetric<V> plastic = history_tensor(s, 0), E = strain(s.F);
  Symmetric<V> back = history_tensor(s, 6), direction;
  const Symmetric<V> before = stress_of(combined(strain(F_0), minus_one, plastic));
  const Symmetric<V> trial = stress_of(combined(E, minus_one, plastic));
  const V g = mixed_return(m, s, trial, back, direction);
  const Symmetric<V> now = combined(plastic, g, direction), T = combined(trial, -2.0 * m.G * g, direction);
  remember(s, 0, now);
  remember(s, 6, back);
  const auto elastic_energy = [&](const Symmetric<V>& stress, const Symmetric<V>& elastic) {
    return 0.5 * contract(stress, elastic);
  };
  s.plastic_work = 0.5 * g * (contract(before, direction) + contract(T, direction));
  s.energy += s.plastic_work + elastic_energy(T, combined(E, minus_one, now)) -
              elastic_energy(before, combined(strain(F_0), minus_one, plastic));
  const V J = determinant(s.F);
  s.stress = scaled(1.0 / J, pushed_forward(s.F, T));
  s.volume_ratio = J;
  // Along N at rest: rho0 c^2 <= (lambda + 2 G) N C N + N T N; along n of the present: (lambda + 2 G) (n b n)^2 + n tau
  // n.
  const V modulus = broadcast<V>(m.K + 4.0 / 3.0 * m.G), zero = broadcast<V>(0.0);
  const V b = largest_eigenvalue_bound(left_cauchy_green(s.F));
  s.wave_speed_squared = (modulus * b * b + J * max(largest_eigenvalue_bound(s.stress), zero)) * (1.0 / m.density);
  s.reference_speed_squared =
      (modulus * largest_eigenvalue_bound(right_cauchy_green(s.F)) + max(largest_eigenvalue_bound(T), zero)) *
      (1.0 / m.density);
}

// exp and the flow direction of the trial state leave the return exact where strain and back stress have common axes,
// else to the second order of the elastic strain.
template <class V>
OGIVE_INLINE void j2_multiplicative(const KernelMaterial& m, const V (&F_0)[3][3], LawState<V>& s) {
  const V half = broadcast<V>(0.5), third = broadcast<V>(1.0 / 3.0), two_G = broadcast<V>(2.0 * m.G);
  V inverse_plastic[3][3];
  for (int i = 0; i < 9; ++i) inverse_plastic[i / 3][i % 3] = s.history[i];
  const auto elastic_strain = [&](const V(&F)[3][3], const V(&inverse)[3][3]) {
    V elastic[3][3];
    multiply(F, inverse, elastic);
    return scaled(half, logarithm(right_cauchy_green(elastic)));
  };
  const auto deviator = [&](const Symmetric<V>& a) { return plus_diagonal(a, -third * trace(a)); };
  const auto energy_of = [&](const Symmetric<V>& h) {
    const Symmetric<V> d = deviator(h);
    return 0.5 * m.K * trace(h) * trace(h) + m.G * contract(d, d);
  };
  const Symmetric<V> before = elastic_strain(F_0, inverse_plastic), trial = elastic_strain(s.F, inverse_plastic);
  Symmetric<V> back = history_tensor(s, 9), direction, elastic = trial;
  const V g = mixed_return(m, s, scaled(two_G, deviator(trial)), back, direction);
  if (s.plastic_changed) {
    // F_p^-1 := F_p^-1 exp(-g N)
    const Symmetric<V> flow = exponential(scaled(-g, direction));
    const V full[3][3] = {{flow.xx, flow.xy, flow.xz}, {flow.xy, flow.yy, flow.yz}, {flow.xz, flow.yz, flow.zz}};
    V next[3][3];
    multiply(inverse_plastic, full, next);
    for (int i = 0; i < 9; ++i) inverse_plastic[i / 3][i % 3] = s.history[i] = next[i / 3][i % 3];
    elastic = elastic_strain(s.F, inverse_plastic);
  }
  remember(s, 9, back);
  const V J = determinant(s.F), pressure_part = m.K * trace(elastic);
  s.plastic_work = 0.5 * two_G * g * (contract(deviator(before), direction) + contract(deviator(elastic), direction));
  s.energy += s.plastic_work + energy_of(elastic) - energy_of(before);
  // tau = F_e^-T M F_e^T; M and C_e have common axes, so that tau = R M R^T with F_e = R U.
  V F_e[3][3];
  multiply(s.F, inverse_plastic, F_e);
  const Symmetric<V> M = plus_diagonal(scaled(two_G, deviator(elastic)), pressure_part);
  const Symmetric<V> S = commuting_product(M, inverse_of(right_cauchy_green(F_e)));
  s.stress = scaled(1.0 / J, pushed_forward(F_e, S));
  s.volume_ratio = J;
  s.wave_speed_squared =
      (broadcast<V>(m.K + 4.0 / 3.0 * m.G) + 2.0 * max(-pressure_part, broadcast<V>(0.0))) * (1.0 / m.density);
  s.reference_speed_squared = s.wave_speed_squared * largest_eigenvalue_bound(inverse_of(right_cauchy_green(s.F)));
}

template <int strength, class V>
OGIVE_INLINE void update_from_gradient(const KernelMaterial& m, const V (&F_0)[3][3], LawState<V>& s) {
  if constexpr (strength == strength_neo_hookean) neo_hookean(m, s);
  if constexpr (strength == strength_j2_mixed) j2_mixed(m, F_0, s);
  if constexpr (strength == strength_j2_multiplicative) j2_multiplicative(m, F_0, s);
}

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
