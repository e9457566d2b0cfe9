// The section of a surface with z = 0, and its particles.
//
// Vertices in the plane count as above it: then each triangle with vertices on both sides gives one directed segment,
// and the segments close. A row of particles is inside between an odd and an even crossing; ends of segments count as
// above a row in the same way. Area A = 1/2 sum (x_a y_b - x_b y_a), and the volume that the part at x > 0 makes about
// x = 0 is V = pi sum of the integrals of x^2 dy. Particles get equal parts of thickness x A, or parts of V in
// proportion to x.
#include "mesh_section.hpp"

#include <algorithm>
#include <cmath>

#include "failure.hpp"
#include "text.hpp"

namespace driver {
namespace {

using Point = std::array<double, 2>;

struct Segment {
  Point a{}, b{};
};

std::vector<Segment> segments_of(const std::vector<double>& vertices, const std::vector<int32_t>& corners) {
  const auto coordinate = [&](int32_t vertex, size_t axis) { return vertices[3 * static_cast<size_t>(vertex) + axis]; };
  const auto above = [&](int32_t vertex) { return coordinate(vertex, 2) >= 0; };
  // From the lower vertex on, so that both triangles of an edge find the same point.
  const auto crossing = [&](int32_t below, int32_t over) -> Point {
    const double z = coordinate(below, 2), part = z / (z - coordinate(over, 2));
    return {coordinate(below, 0) + part * (coordinate(over, 0) - coordinate(below, 0)),
            coordinate(below, 1) + part * (coordinate(over, 1) - coordinate(below, 1))};
  };
  std::vector<Segment> segments;
  for (size_t t = 0; t < corners.size(); t += 3) {
    Segment segment;
    int crossings = 0;
    for (size_t k = 0; k < 3; ++k) {
      const int32_t from = corners[t + k], to = corners[t + (k + 1) % 3];
      if (above(from) == above(to)) continue;
      ++crossings;
      if (above(to))
        segment.a = crossing(from, to);
      else
        segment.b = crossing(to, from);
    }
    if (crossings == 2) segments.push_back(segment);
  }
  return segments;
}

/// Integral of x^2 dy over the part of a segment at x > 0.
double ring_part(Segment s) {
  if (s.a[0] <= 0 && s.b[0] <= 0) return 0;
  for (auto [end, other] : {std::pair{&s.a, &s.b}, std::pair{&s.b, &s.a}}) {
    if ((*end)[0] >= 0) continue;
    const double part = (*other)[0] / ((*other)[0] - (*end)[0]);
    *end = {0, (*other)[1] + part * ((*end)[1] - (*other)[1])};
  }
  return (s.b[1] - s.a[1]) * (s.a[0] * s.a[0] + s.a[0] * s.b[0] + s.b[0] * s.b[0]) / 3;
}

}  // namespace

ParticleList fill_mesh_section(const std::vector<double>& vertices, const std::vector<int32_t>& corners,
                               const std::array<double, 2>& origin, const std::array<double, 2>& spacing,
                               const SectionRule& rule, const std::string& place) {
  constexpr double most_particles = 2147483648.0, most_rows = 1e9;
  const std::vector<Segment> segments = segments_of(vertices, corners);
  double area = 0, rings = 0, low = 0, high = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    area += 0.5 * (s.a[0] * s.b[1] - s.b[0] * s.a[1]);
    rings += M_PI * ring_part(s);
    const auto [least, most] = std::minmax(s.a[1], s.b[1]);
    low = i == 0 ? least : std::min(low, least);
    high = i == 0 ? most : std::max(high, most);
  }
  const double volume = std::abs(rule.axisymmetric ? rings : area * rule.thickness);
  if (!(volume > 0))
    throw Failure(kExitInput, place + ": its section with the plane z = 0 has no area" +
                                  (rule.axisymmetric ? " at x > 0" : "") + "; the mesh must be cut by the plane");
  if (!(std::abs(area) / spacing[0] / spacing[1] < most_particles && (high - low) / spacing[1] < most_rows))
    throw Failure(kExitInput,
                  place + ": spacing must give fewer than 2147483648 particles, got " + shortest(spacing[0]));

  ParticleList particles;
  double sum = 0;
  std::vector<double> crossings;
  const auto first_from = [](double at, double start, double step) {
    return static_cast<int64_t>(std::ceil((at - start) / step - 0.5));
  };
  for (int64_t j = first_from(low, origin[1], spacing[1]);; ++j) {
    const double y = origin[1] + (static_cast<double>(j) + 0.5) * spacing[1];
    if (y > high) break;
    crossings.clear();
    for (const Segment& s : segments) {
      if ((s.a[1] >= y) == (s.b[1] >= y)) continue;
      const auto& [below, over] = s.a[1] < s.b[1] ? std::tie(s.a, s.b) : std::tie(s.b, s.a);
      crossings.push_back(below[0] + (y - below[1]) / (over[1] - below[1]) * (over[0] - below[0]));
    }
    std::sort(crossings.begin(), crossings.end());
    for (size_t k = 0; k + 1 < crossings.size(); k += 2)
      for (int64_t i = first_from(crossings[k], origin[0], spacing[0]);; ++i) {
        const double x = origin[0] + (static_cast<double>(i) + 0.5) * spacing[0];
        if (x >= crossings[k + 1]) break;
        if (rule.axisymmetric && x <= 0) continue;
        particles.positions.insert(particles.positions.end(), {x, y, 0.0});
        particles.volumes.push_back(rule.axisymmetric ? x : 1.0);
        sum += particles.volumes.back();
      }
  }
  if (particles.volumes.empty())
    throw Failure(kExitInput, place + ": no particle centre lies inside its section with z = 0; use a smaller spacing");
  for (double& part : particles.volumes) part *= volume / sum;
  return particles;
}

}  // namespace driver
