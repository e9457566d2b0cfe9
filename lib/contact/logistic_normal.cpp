// The most probable plane between two clouds of particles: Nairn, Hammerquist, Smith 2020.
//
// Particles of a get the label -1, of b +1, and the logistic function f(t) = 2 / (1 + exp(-t)) - 1 of t = X . phi,
// X = (x - x_node, 1), is fitted to the labels: minimise sum_p (c_p - f(X_p . phi))^2 + sum_j lambda_j phi_j^2 over the
// particles that the node's shape function reaches. The normal out of a is the direction of (phi_1, phi_2, phi_3).
// Started from the linear fit (f(t) = t), then Gauss-Newton until the normal stands still. Lengths are in cells.
#include <algorithm>
#include <cmath>

#include "contact/normal.hpp"

namespace ogive {
namespace {

// The penalty keeps the fit of clouds that a plane separates without error finite: its direction does not depend on it.
constexpr double penalty[4] = {1e-7, 1e-7, 1e-7, 0.0};
constexpr double linear_offset_penalty = 1e-7;  // of clouds all on one side of the node
constexpr int most_iterations = 15;
constexpr double tolerance = 1e-5;  // of 1 - cos of the angle between successive normals

using Vector4 = std::array<double, 4>;

// Solves the symmetric positive definite m x = r in place (Cholesky); false where m is singular.
bool solve(std::array<Vector4, 4> m, Vector4& r) {
  const double scale = std::max({m[0][0], m[1][1], m[2][2], m[3][3]});
  for (int j = 0; j < 4; ++j) {
    for (int k = 0; k < j; ++k) m[j][j] -= m[j][k] * m[j][k];
    if (!(m[j][j] > 1e-14 * scale)) return false;
    m[j][j] = std::sqrt(m[j][j]);
    for (int i = j + 1; i < 4; ++i) {
      for (int k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k];
      m[i][j] /= m[j][j];
    }
  }
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < i; ++k) r[i] -= m[i][k] * r[k];
    r[i] /= m[i][i];
  }
  for (int i = 3; i >= 0; --i) {
    for (int k = i + 1; k < 4; ++k) r[i] -= m[k][i] * r[k];
    r[i] /= m[i][i];
  }
  return true;
}

}  // namespace

Vector3 logistic_normal(const NormalView& view) {
  Vector4 phi{};
  Vector3 normal{};
  for (int iteration = 0; iteration <= most_iterations; ++iteration) {
    const bool linear = iteration == 0;
    std::array<Vector4, 4> m{};
    Vector4 r{};
    for (int j = 0; j < 4; ++j) {
      m[j][j] = j == 3 && linear ? linear_offset_penalty : penalty[j];
      r[j] = linear ? 0 : -penalty[j] * phi[j];
    }
    view.cloud->around(view.place, view.cloud->reach, [&](const NearbyParticles::Particle& p) {
      if (p.field != view.a.body && p.field != view.b.body) return;
      const double label = p.field == view.a.body ? -1 : 1;
      const Vector4 X = {p.place[0] - view.place[0], p.place[1] - view.place[1], p.place[2] - view.place[2], 1};
      double slope = 1, miss = label;
      if (!linear) {
        const double t = X[0] * phi[0] + X[1] * phi[1] + X[2] * phi[2] + phi[3];
        const double e = std::exp(-std::abs(t)), f = (1 - e) / (1 + e);  // |f|
        slope = 2 * e / ((1 + e) * (1 + e));
        miss = label - (t < 0 ? -f : f);
      }
      for (int i = 0; i < 4; ++i) {
        r[i] += slope * miss * X[i];
        for (int j = 0; j <= i; ++j) m[i][j] += slope * slope * X[i] * X[j];
      }
    });
    if (!solve(m, r)) break;
    // The logistic function rises half as fast as the linear one at 0: twice the linear fit is the better start.
    for (int j = 0; j < 4; ++j) phi[j] = linear ? 2 * r[j] : phi[j] + r[j];
    Vector3 next = {phi[0], phi[1], phi[2]};
    if (!make_unit(next)) break;
    const bool still = !linear && 1 - dot(next, normal) < tolerance;
    normal = next;
    if (still) break;
  }
  return normal;
}

}  // namespace ogive
