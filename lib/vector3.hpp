// Vectors of three doubles.
#pragma once

#include <array>
#include <cmath>

namespace ogive {

using Vector3 = std::array<double, 3>;

inline double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector3 plus(const Vector3& a, const Vector3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector3 minus(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector3 times(double s, const Vector3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vector3& a) { return std::sqrt(dot(a, a)); }
inline void add(Vector3& to, const Vector3& a) {
  for (int c = 0; c < 3; ++c) to[c] += a[c];
}
// False for a vector without direction, which stays as it is.
inline bool make_unit(Vector3& a) {
  const double size = length(a);
  if (!(size > 0)) return false;
  for (double& c : a) c /= size;
  return true;
}

}  // namespace ogive
