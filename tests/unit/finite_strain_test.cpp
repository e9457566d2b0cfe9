// Laws of finite strain at a point, lib/materials/finite_strain.hpp, against closed forms.
#define OGIVE_ISA_NAMESPACE finite_strain_test
#include <gtest/gtest.h>

#include <cmath>

#include "materials/law.hpp"

namespace {

using namespace ogive;
using namespace ogive::finite_strain_test;
using V = Vec<4>;
using Gradient = V[3][3];

// The steel of Lee et al. 2005, in MPa, with more hardening, so that it shows.
KernelMaterial steel(double isotropic) {
  KernelMaterial m{};
  m.density = 7.85e-3;
  m.K = 210e3 / (3 * (1 - 2 * 0.28));
  m.G = 210e3 / (2 * (1 + 0.28));
  m.lambda = m.K - 2.0 / 3.0 * m.G;
  m.A = 200;
  m.B = 2100;
  m.n = 1;
  m.isotropic = isotropic;
  m.failure_strain = 1e300;
  m.cell_size = 1;
  return m;
}

constexpr double youngs_modulus = 210e3;

template <int strength>
struct Point {
  KernelMaterial m;
  LawState<V> s{};
  Gradient F{};

  explicit Point(double isotropic) : m(steel(isotropic)) {
    s.dt = broadcast<V>(1e-4);
    s.volume_ratio = broadcast<V>(1.0);
    s.yield_stress = broadcast<V>(m.A);
    for (int i = 0; i < 3; ++i) F[i][i] = s.F[i][i] = broadcast<V>(1.0);
    if (strength == strength_j2_multiplicative)
      for (int i = 0; i < 3; ++i) s.history[4 * i] = broadcast<V>(1.0);
  }
  void move(const double (&to)[3][3]) {
    Gradient next;
    for (int i = 0; i < 9; ++i) next[i / 3][i % 3] = broadcast<V>(to[i / 3][i % 3]);
    update_law_between<strength, eos_linear>(m, F, next, s);
    for (int i = 0; i < 9; ++i) F[i / 3][i % 3] = next[i / 3][i % 3];
  }
  // The measure that the law is linear in: Green-Lagrange or logarithmic strain.
  static double stretch(double strain) {
    return strength == strength_j2_mixed ? std::sqrt(1 + 2 * strain) : std::exp(strain);
  }
  // Its conjugate stress along x where F is diagonal: second Piola-Kirchhoff or Kirchhoff.
  double stress() const {
    const double J = s.volume_ratio[0], tau = J * s.stress.xx[0], f = F[0][0][0];
    return strength == strength_j2_mixed ? tau / (f * f) : tau;
  }
  double lateral_stress() const { return s.stress.yy[0]; }
  void stretch_to(double along, double across) {
    const double x = stretch(along), y = stretch(across);
    move({{x, 0, 0}, {0, y, 0}, {0, 0, y}});
  }
};

// A step of uniaxial stress: the lateral strain is found from that of the last step by secants.
template <int strength>
void pull(Point<strength>& point, double along, double& across) {
  const Point<strength> start = point;
  const auto lateral = [&](double trial) {
    point = start;
    point.stretch_to(along, trial);
    return point.lateral_stress();
  };
  double a = across, b = across - 1e-6, f_a = lateral(a), f_b = lateral(b);
  for (int i = 0; i < 30 && std::abs(f_b) > 1e-9 && f_a != f_b; ++i) {
    const double next = b - f_b * (b - a) / (f_b - f_a);
    a = b;
    f_a = f_b;
    b = next;
    f_b = lateral(b);
  }
  across = b;
}

// Uniaxial stress, to and fro: sigma = E (eps - eps_p), |sigma - b| = sigma_Y + c H e, b' = (1 - c) H eps_p'.
template <int strength>
void expect_uniaxial_cycles(double isotropic, double amplitude) {
  Point<strength> point(isotropic);
  const KernelMaterial& m = point.m;
  double across = 0, strain = 0, plastic = 0, back = 0, sum = 0;
  const int steps = 400;
  for (const double target : {amplitude, -0.5 * amplitude, amplitude}) {
    const double from = strain;
    for (int i = 1; i <= steps; ++i) {
      strain = from + (target - from) * i / steps;
      pull(point, strain, across);
      const double trial = youngs_modulus * (strain - plastic) - back,
                   excess = std::abs(trial) - m.A - isotropic * m.B * sum;
      if (excess > 0) {
        const double increment = excess / (youngs_modulus + m.B), sign = trial > 0 ? 1 : -1;
        plastic += sign * increment;
        sum += increment;
        back += sign * (1 - isotropic) * m.B * increment;
      }
    }
    const double exact = youngs_modulus * (strain - plastic);
    // The flow is found for three axes at once and the lateral strain to round-off: 1e-9 measured.
    EXPECT_NEAR(point.stress() / exact, 1, 1e-6) << "isotropic " << isotropic << ", strain " << target;
    EXPECT_NEAR(point.s.plastic_strain[0] / sum, 1, 1e-6);
  }
}

void rotate(double angle, const double (&F)[3][3], double (&out)[3][3]) {
  const double c = std::cos(angle), s = std::sin(angle), R[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[i][j] = R[i][0] * F[0][j] + R[i][1] * F[1][j] + R[i][2] * F[2][j];
}

template <int strength>
void expect_rotation_without_stress_or_flow() {
  Point<strength> point(0.4);
  const double F[3][3] = {{1.05, 0.08, 0}, {0, 0.97, 0.03}, {0, 0, 0.99}};
  for (int i = 1; i <= 100; ++i) {
    double now[3][3];
    for (int k = 0; k < 9; ++k)
      now[k / 3][k % 3] = (k % 4 == 0 ? 1.0 : 0.0) * (1 - 0.01 * i) + 0.01 * i * F[k / 3][k % 3];
    point.move(now);
  }
  const LawState<V> before = point.s;
  ASSERT_GT(before.plastic_strain[0], 0.01);
  const double angle = 2.5;
  for (int i = 1; i <= 7; ++i) {  // large steps: no rate is integrated
    double turned[3][3];
    rotate(angle * i / 7, F, turned);
    point.move(turned);
  }
  EXPECT_NEAR(point.s.plastic_strain[0], before.plastic_strain[0], 1e-12);
  EXPECT_NEAR(point.s.energy[0] / before.energy[0], 1, 1e-12);
  const Symmetric<V>&a = before.stress, &b = point.s.stress;
  const double c = std::cos(angle), s = std::sin(angle);
  const double scale = 1e-9 * point.m.A;
  EXPECT_NEAR(b.xx[0], c * c * a.xx[0] - 2 * c * s * a.xy[0] + s * s * a.yy[0], scale);
  EXPECT_NEAR(b.yy[0], s * s * a.xx[0] + 2 * c * s * a.xy[0] + c * c * a.yy[0], scale);
  EXPECT_NEAR(b.xy[0], c * s * (a.xx[0] - a.yy[0]) + (c * c - s * s) * a.xy[0], scale);
  EXPECT_NEAR(b.xz[0], c * a.xz[0] - s * a.yz[0], scale);
  EXPECT_NEAR(b.zz[0], a.zz[0], scale);
}

}  // namespace

TEST(FiniteStrain, MixedHardeningInGreenLagrangeStrainFollowsTheClosedFormToAndFro) {
  for (const double isotropic : {1.0, 0.4, 0.0}) expect_uniaxial_cycles<strength_j2_mixed>(isotropic, 0.05);
}

TEST(FiniteStrain, MultiplicativePlasticityFollowsTheClosedFormInLogarithmicStrainToAndFro) {
  for (const double isotropic : {1.0, 0.4, 0.0}) expect_uniaxial_cycles<strength_j2_multiplicative>(isotropic, 0.5);
}

TEST(FiniteStrain, MixedHardeningInSimpleShearFollowsTheClosedFormToAndFro) {
  // E_xy = e alone: tau - b = (sigma_Y + c H e_p) / sqrt(3), b' = 2/3 (1 - c) H e_p', slope 2/3 H after yield.
  for (const double isotropic : {1.0, 0.4, 0.0}) {
    Point<strength_j2_mixed> point(isotropic);
    const KernelMaterial& m = point.m;
    double e = 0, plastic = 0, back = 0, sum = 0;
    for (const double target : {0.04, -0.02, 0.04}) {
      const double from = e;
      const int steps = 100;
      for (int i = 1; i <= steps; ++i) {
        e = from + (target - from) * i / steps;
        // An upper triangular F with F^T F = 1 + 2 E.
        const double xy = 2 * e, yy = std::sqrt(1 - xy * xy);
        point.move({{1, xy, 0}, {0, yy, 0}, {0, 0, 1}});
        const double trial = 2 * m.G * (e - plastic) - back;
        const double excess = std::abs(trial) - (m.A + isotropic * m.B * sum) / std::sqrt(3.0);
        if (excess <= 0) continue;
        const double increment = excess / (2 * m.G + 2.0 / 3.0 * m.B), sign = trial > 0 ? 1 : -1;
        plastic += sign * increment;
        sum += 2 / std::sqrt(3.0) * increment;
        back += sign * 2.0 / 3.0 * (1 - isotropic) * m.B * increment;
      }
      // T = J F^-1 sigma F^-T.
      const double xy = 2 * e, yy = std::sqrt(1 - xy * xy), J = yy;
      const auto& s = point.s.stress;
      const double T_xy = J * (s.xy[0] / yy - s.yy[0] * xy / (yy * yy));
      EXPECT_NEAR(T_xy / (2 * m.G * (e - plastic)), 1, 1e-10) << isotropic << ", " << target;
      EXPECT_NEAR(point.s.plastic_strain[0] / sum, 1, 1e-10);
    }
  }
}

TEST(FiniteStrain, ALargeRotationChangesNeitherPlasticStrainNorEnergyAndTurnsTheStress) {
  expect_rotation_without_stress_or_flow<strength_j2_mixed>();
  expect_rotation_without_stress_or_flow<strength_j2_multiplicative>();
}

TEST(FiniteStrain, BothFormsAgreeWhereStrainIsSmall) {
  Point<strength_j2_mixed> first(0.5);
  Point<strength_j2_multiplicative> second(0.5);
  for (int i = 1; i <= 200; ++i) {
    const double e = 2e-5 * i;
    const double F[3][3] = {{1 + e, 1.5 * e, 0}, {0.5 * e, 1 - 0.4 * e, 0}, {0, 0, 1 - 0.3 * e}};
    first.move(F);
    second.move(F);
  }
  ASSERT_GT(first.s.plastic_strain[0], 2e-3);
  EXPECT_NEAR(second.s.plastic_strain[0] / first.s.plastic_strain[0], 1, 5e-3);  // strains up to 0.8 %
  const auto von_mises = [](const Symmetric<V>& t) {
    const double p = (t.xx[0] + t.yy[0] + t.zz[0]) / 3, x = t.xx[0] - p, y = t.yy[0] - p, z = t.zz[0] - p;
    return std::sqrt(1.5 * (x * x + y * y + z * z + 2 * (t.yz[0] * t.yz[0] + t.xz[0] * t.xz[0] + t.xy[0] * t.xy[0])));
  };
  // The two stresses that yield differ by twice the strain, 1.6 %: measured 2.1 %.
  EXPECT_NEAR(von_mises(second.s.stress) / von_mises(first.s.stress), 1, 0.03);
}

TEST(FiniteStrain, TheEnergyIsTheWorkOfTheStress) {
  Point<strength_j2_mixed> first(0.5);
  Point<strength_j2_multiplicative> second(0.5);
  double work[2] = {};
  const auto kirchhoff_work = [](const auto& before, const auto& after, const double(&L)[3][3]) {
    const auto of = [&](const auto& s) {
      const auto& t = s.stress;
      return s.volume_ratio[0] *
             (t.xx[0] * L[0][0] + t.yy[0] * L[1][1] + t.zz[0] * L[2][2] + t.xy[0] * (L[0][1] + L[1][0]));
    };
    return 0.5 * (of(before) + of(after));
  };
  const int steps = 4000;
  for (int i = 1; i <= steps; ++i) {
    const double e = 0.1 * i / steps, d = 0.1 / steps;
    const double F[3][3] = {{1 + e, e, 0}, {0, 1 - 0.5 * e, 0}, {0, 0, 1 - 0.4 * e}};
    // L = F' F^-1 at the middle of the step.
    const double m = e - 0.5 * d, x = 1 + m, y = 1 - 0.5 * m, z = 1 - 0.4 * m;
    const double L[3][3] = {{d / x, d / y - d * m / (x * y), 0}, {0, -0.5 * d / y, 0}, {0, 0, -0.4 * d / z}};
    const LawState<V> a = first.s, b = second.s;
    first.move(F);
    second.move(F);
    work[0] += kirchhoff_work(a, first.s, L);
    work[1] += kirchhoff_work(b, second.s, L);
  }
  EXPECT_NEAR(first.s.energy[0] / work[0], 1, 1e-5);
  EXPECT_NEAR(second.s.energy[0] / work[1], 1, 1e-3);  // the flow direction does not turn with the elastic strain
}
