// Exact geometric decisions. CGAL's filtered predicates answer for the coordinates as they are, without rounding, so
// that two facets at a common edge can never disagree about which of them a line passes.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "mesh.hpp"

namespace ogive::geometry {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

inline Kernel::Point_3 exact_point(const Vec3& p) { return {p[0], p[1], p[2]}; }

// 1 if a, b, c run counter-clockwise seen from +z, -1 if clockwise, 0 if they are seen on one line.
inline int turn_seen_from_z(const Vec3& a, const Vec3& b, const Vec3& c) {
  return CGAL::orientation(Kernel::Point_2(a[0], a[1]), Kernel::Point_2(b[0], b[1]), Kernel::Point_2(c[0], c[1]));
}

// A line parallel to z that meets an edge or a corner is not decided by itself: it is moved by (e, e^2) for a vanishing
// e > 0, and once more by (-e, -e^2). A moved line passes every edge on one definite side, and the two lie on either
// side of every plane parallel to z. What lies on an edge or a corner is told apart from them.
enum : unsigned { kMoved = 1, kMovedBack = 2, kOnBoundary = 4 };

// How the line at (x, y) passes the triangle, whose turn_seen_from_z is not 0: which moved lines go through it, and
// whether the line itself meets an edge or a corner.
inline unsigned passes(const Vec3& a, const Vec3& b, const Vec3& c, int turn, double x, double y) {
  const Vec3* corner[4] = {&a, &b, &c, &a};
  const Vec3 p = {x, y, 0};
  unsigned result = kMoved | kMovedBack;
  for (int e = 0; e < 3; ++e) {
    const Vec3& from = *corner[e];
    const Vec3& to = *corner[e + 1];
    const int side = turn * turn_seen_from_z(from, to, p);
    if (side < 0) return 0;
    if (side > 0) continue;
    // On the edge's line: the side that the move along x leads to, or along y where the edge runs along x.
    const bool to_the_left = from[1] == to[1] ? to[0] > from[0] : to[1] < from[1];
    result &= ~((turn > 0) == to_the_left ? kMovedBack : kMoved);
    result |= kOnBoundary;
  }
  return result;
}

// 1 if p lies above (larger z) the plane of the triangle, whose turn_seen_from_z is not 0; -1 below, 0 on it.
inline int height_over(const Vec3& a, const Vec3& b, const Vec3& c, int turn, const Vec3& p) {
  return turn * CGAL::orientation(exact_point(a), exact_point(b), exact_point(c), exact_point(p));
}

}  // namespace ogive::geometry
