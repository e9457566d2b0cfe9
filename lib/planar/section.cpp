// Sections of built-in solids.
//
// In the plane a section has the axes u, v of the solid that lie there, from its centre; s and t are the coordinates
// along them. Cylinder: v its axis; rod: v from the tip on. With the spacings a, b along u and v, particles lie at
//   rectangles   the centres of n x m equal cells, n and m the nearest whole numbers that fill the edges (of a ring:
//   the
//                wall on either side)
//   discs, rods  s = (i + 1/2) a, t = (k + 1/2) b, where they are inside.
// Volumes: plane strain, area x thickness / count. Axisymmetric: in proportion to the radius; their sum is that of the
// body of revolution, by Pappus 2 pi x_c A for a section beside the axis; for one that is symmetric about it, its
// half's:
//   rectangle of half edges a, b about the axis: 2 pi a^2 b, less the hole; disc 4/3 pi R^3; rod the solid's own.
#include "planar/section.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "error.hpp"

namespace ogive {
namespace {

constexpr double pi = 3.141592653589793238;
constexpr double direction_tolerance = 1e-9, surface_tolerance = 1e-12;

enum class Outline { Rectangle, Disc, Rod };

struct Section {
  Outline outline;
  Vector3 u{}, v{};
  double a = 0, b = 0;  // rectangle: half edges along u and v; disc: a the radius
  double hole = 0;      // |s| (rectangle) or the radius (disc) is at least this
  double spacing_u = 0, spacing_v = 0;
};

[[noreturn]] void refuse(const std::string& field, const std::string& expectation, double got) {
  char text[40];
  std::snprintf(text, sizeof text, "%.12g", got);
  throw Error(ErrorKind::Argument,
              "solid." + field + ": must " + expectation + " in a two-dimensional model, got " + text);
}

bool along_z(const Vector3& direction) { return std::abs(std::abs(direction[2]) - 1) < direction_tolerance; }
bool in_plane(const Vector3& direction) { return std::abs(direction[2]) < direction_tolerance; }

Vector3 flattened(const Vector3& v) { return {v[0], v[1], 0}; }

Section section_of(const SolidDef& solid) {
  const auto axes = solid_axes(solid);
  if (solid.centre[2] != 0) refuse("centre[2]", "be 0", solid.centre[2]);
  Section section;
  if (solid.shape == SolidShape::Box) {
    int across = 0;
    while (across < 3 && !along_z(axes[across])) ++across;
    if (across == 3)
      refuse("axis", "turn the box so that one of its axes lies along z, which the nearest misses by",
             1 - std::max({std::abs(axes[0][2]), std::abs(axes[1][2]), std::abs(axes[2][2])}));
    const int first = across == 0 ? 1 : 0, second = across == 2 ? 1 : 2;
    section.outline = Outline::Rectangle;
    section.u = flattened(axes[first]);
    section.v = flattened(axes[second]);
    section.a = 0.5 * solid.size[first];
    section.b = 0.5 * solid.size[second];
    section.spacing_u = solid.spacing[first];
    section.spacing_v = solid.spacing[second];
    return section;
  }
  const Vector3& axis = axes[2];
  if (!in_plane(axis) && !along_z(axis)) refuse("axis", "lie in the plane z = 0 or along z", axis[2]);
  section.spacing_u = solid.spacing[0];
  if (along_z(axis)) {
    if (solid.shape == SolidShape::OgiveRod) refuse("axis", "lie in the plane z = 0 for an ogive rod", axis[2]);
    section.outline = Outline::Disc;
    section.u = flattened(axes[0]);
    section.v = flattened(axes[1]);
    section.spacing_v = solid.spacing[1];
  } else {
    section.outline = solid.shape == SolidShape::Sphere     ? Outline::Disc
                      : solid.shape == SolidShape::Cylinder ? Outline::Rectangle
                                                            : Outline::Rod;
    section.u = {axis[1], -axis[0], 0};
    section.v = flattened(axis);
    section.spacing_v = solid.spacing[2];
  }
  section.a = solid.size[0];
  section.b = section.outline == Outline::Rod ? solid.size[1] : 0.5 * solid.size[1];
  if (solid.shape == SolidShape::Cylinder) section.hole = solid.size[2];
  return section;
}

double area_of(const Section& section, const SolidDef& solid) {
  if (section.outline == Outline::Rectangle) return 4 * (section.a - section.hole) * section.b;
  if (section.outline == Outline::Disc) return pi * (section.a * section.a - section.hole * section.hole);
  // Twice the integral of r(d) over the nose, r = sqrt(rho^2 - (L - d)^2) - (rho - R), and the shank.
  const double radius = solid.size[0], rho = 2 * solid.size[2] * radius;
  const double nose = ogive_nose_length(radius, solid.size[2]), offset = rho - radius;
  return nose * offset + rho * rho * std::asin(nose / rho) - 2 * offset * nose + 2 * radius * (solid.size[1] - nose);
}

// Of the body that the section makes by turning about x = 0.
double revolved_volume(const Section& section, const SolidDef& solid) {
  const double x = solid.centre[0];
  const bool v_along = std::abs(section.v[0]) < direction_tolerance,
             u_along = std::abs(section.u[0]) < direction_tolerance;
  if (x == 0 && section.outline == Outline::Disc)
    return 4.0 / 3.0 * pi * (std::pow(section.a, 3) - std::pow(section.hole, 3));
  if (x == 0 && section.outline == Outline::Rod && v_along) return exact_volume(solid);
  if (x == 0 && section.outline == Outline::Rectangle && v_along)
    return 2 * pi * (section.a * section.a - section.hole * section.hole) * section.b;
  if (x == 0 && section.outline == Outline::Rectangle && u_along)
    return 2 * pi * section.b * section.b * (section.a - section.hole);
  const double reach = section.outline == Outline::Rectangle
                           ? section.a * std::abs(section.u[0]) + section.b * std::abs(section.v[0])
                           : section.a;
  if (section.outline == Outline::Rod)
    refuse("centre[0]", "be 0, and axis be along y, for an ogive rod of an axisymmetric model:", x);
  if (x < reach * (1 - surface_tolerance))
    refuse("centre[0]",
           "be 0 with an axis along x or y, or hold the solid at x >= 0 (at least " + std::to_string(reach) + "),", x);
  return 2 * pi * x * area_of(section, solid);
}

std::int64_t divisions(double length, double spacing) {
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::llround(length / spacing)));
}

// Centres along u at one t, where `inside(s)` holds for s > 0: mirror images alike, from below.
struct Row {
  double t;
  std::vector<double> s;  // > 0, ascending
};

// `cut`: at x = 0 through its middle, where a cell must end.
std::vector<Row> rows_of(const Section& section, const SolidDef& solid, bool cut) {
  std::vector<Row> rows;
  const double du = section.spacing_u, dv = section.spacing_v;
  if (section.outline == Outline::Rectangle) {
    const bool along_x = std::abs(section.v[0]) > 0.5;
    const std::int64_t m = cut && along_x ? 2 * divisions(section.b, dv) : divisions(2 * section.b, dv);
    const bool walls = (cut && !along_x) || solid.shape != SolidShape::Box;
    const double width = walls ? section.a - section.hole : 2 * section.a;
    const std::int64_t n = divisions(width, du);
    for (std::int64_t k = 0; k < m; ++k) {
      Row row{static_cast<double>(2 * k + 1 - m) * (section.b / static_cast<double>(m)), {}};
      for (std::int64_t i = 0; i < n; ++i) {
        const double s = walls ? section.hole + (static_cast<double>(i) + 0.5) * (width / static_cast<double>(n))
                               : static_cast<double>(2 * i + 1 - n) * (section.a / static_cast<double>(n));
        if (s >= 0) row.s.push_back(s);
      }
      rows.push_back(std::move(row));
    }
    return rows;
  }
  const auto row_at = [&](double t, double outer, double inner) {
    Row row{t, {}};
    for (std::int64_t i = 0;; ++i) {
      const double s = (static_cast<double>(i) + 0.5) * du;
      if (s > outer * (1 + surface_tolerance)) break;
      if (s >= inner * (1 - surface_tolerance)) row.s.push_back(s);
    }
    if (!row.s.empty()) rows.push_back(std::move(row));
  };
  if (section.outline == Outline::Rod) {
    for (std::int64_t k = static_cast<std::int64_t>(section.b / dv + 1); k >= 0; --k) {
      const double distance = (static_cast<double>(k) + 0.5) * dv;
      if (distance <= section.b * (1 + surface_tolerance))
        row_at(-distance, ogive_radius_at(solid.size[0], solid.size[2], distance), 0);
    }
    return rows;
  }
  const auto chord = [](double radius, double t) { return std::sqrt(std::max(0.0, radius * radius - t * t)); };
  const std::int64_t most = static_cast<std::int64_t>(section.a / dv + 1);
  for (std::int64_t k = -most; k < most; ++k) {
    const double t = (static_cast<double>(k) + 0.5) * dv;
    if (std::abs(t) <= section.a * (1 + surface_tolerance)) row_at(t, chord(section.a, t), chord(section.hole, t));
  }
  return rows;
}

}  // namespace

ParticleCloud fill_section(const Grid& grid, const SolidDef& solid) {
  const Section section = section_of(solid);
  const double area = area_of(section, solid);
  if (!(area / section.spacing_u / section.spacing_v < static_cast<double>(max_solid_particles)))
    refuse("spacing", "give at most 2147483648 particles", section.spacing_u);
  const double volume = grid.axisymmetric() ? revolved_volume(section, solid) : area * grid.thickness;
  ParticleCloud cloud;
  double sum = 0;
  const auto put = [&](double s, double t) {
    const Vector3 place = plus(solid.centre, plus(times(s, section.u), times(t, section.v)));
    if (grid.axisymmetric() && place[0] <= 0) return;
    cloud.xyz.insert(cloud.xyz.end(), {place[0], place[1], 0.0});
    cloud.volume.push_back(grid.axisymmetric() ? place[0] : 1.0);
    sum += cloud.volume.back();
  };
  for (const Row& row : rows_of(section, solid, grid.axisymmetric() && solid.centre[0] == 0)) {
    for (auto s = row.s.rbegin(); s != row.s.rend(); ++s)
      if (*s > 0) put(-*s, row.t);
    for (const double s : row.s) put(s, row.t);
  }
  if (cloud.volume.empty())
    refuse("spacing", "leave at least one particle centre inside the section", section.spacing_u);
  for (double& part : cloud.volume) part *= volume / sum;
  return cloud;
}

}  // namespace ogive
