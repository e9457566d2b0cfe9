// Solids of revolution are turned profiles, rings of as many vertices each; boxes are six lattices with common edges.
#include "surface/tessellate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "error.hpp"
#include "solids.hpp"

namespace ogive {
namespace {

constexpr double most_vertices = 1 << 29;
constexpr int least_sides = 12;

std::int32_t pieces_of(double length, double size) {
  const double pieces = std::ceil(length / size - 1e-9);
  if (!(pieces < most_vertices))
    throw Error(ErrorKind::Argument, "surface: triangles of size " + std::to_string(size) + " are too many");
  return std::max(1, static_cast<std::int32_t>(pieces));
}

void require_room(double vertices) {
  if (!(vertices < most_vertices))
    throw Error(ErrorKind::Argument, "surface: " + std::to_string(vertices) + " vertices are too many");
}

// Distance from the axis and place along it.
struct Ring {
  double r, z;
};

// A profile that is walked with the solid on its left.
struct Profile {
  std::vector<Ring> rings;
  bool closed = false;  // the last ring is joined to the first, else both lie on the axis

  void line_to(Ring end, double size) {
    const Ring from = rings.back();
    const std::int32_t pieces = pieces_of(std::hypot(end.r - from.r, end.z - from.z), size);
    for (std::int32_t i = 1; i < pieces; ++i)
      rings.push_back({from.r + (end.r - from.r) * i / pieces, from.z + (end.z - from.z) * i / pieces});
    rings.push_back(end);
  }
  // About `centre` from the angle `from` to `to`, which ends at `end`.
  void arc_to(Ring centre, double radius, double from, double to, Ring end, double size) {
    const std::int32_t pieces = std::max(pieces_of(std::abs(to - from) * radius, size), least_sides / 4);
    for (std::int32_t i = 1; i < pieces; ++i) {
      const double angle = from + (to - from) * i / pieces;
      rings.push_back({centre.r + radius * std::cos(angle), centre.z + radius * std::sin(angle)});
    }
    rings.push_back(end);
  }
};

void turn(const Profile& profile, double size, SurfaceDef& out) {
  double widest = 0;
  for (const Ring& ring : profile.rings) widest = std::max(widest, ring.r);
  // A multiple of four: mirrored at the planes through the axis it is the same.
  const std::int32_t sides =
      4 * pieces_of(std::max(static_cast<double>(least_sides), 2 * std::numbers::pi * widest / size), 4);
  require_room(static_cast<double>(sides) * static_cast<double>(profile.rings.size()));
  const std::int32_t rings = static_cast<std::int32_t>(profile.rings.size());
  std::vector<std::int32_t> first(profile.rings.size());
  for (std::int32_t i = 0; i < rings; ++i) {
    const Ring& ring = profile.rings[i];
    first[i] = static_cast<std::int32_t>(out.vertices.size() / 3);
    const std::int32_t count = ring.r > 0 ? sides : 1;
    for (std::int32_t k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      out.vertices.insert(out.vertices.end(), {ring.r * std::cos(angle), ring.r * std::sin(angle), ring.z});
    }
  }
  const auto at = [&](std::int32_t ring, std::int32_t k) {
    return first[ring] + (profile.rings[ring].r > 0 ? k % sides : 0);
  };
  for (std::int32_t i = 0; i + (profile.closed ? 0 : 1) < rings; ++i) {
    const std::int32_t next = (i + 1) % rings;
    for (std::int32_t k = 0; k < sides; ++k) {
      const std::int32_t a = at(i, k), b = at(i, k + 1), c = at(next, k + 1), d = at(next, k);
      const bool turned = 4 * k / sides % 2 == 1;  // the diagonal, mirrored from quarter to quarter
      if (a != b) out.corners.insert(out.corners.end(), {a, b, turned ? c : d});
      if (c != d) out.corners.insert(out.corners.end(), {turned ? a : b, c, d});
    }
  }
}

void box(const Vector3& extent, double size, SurfaceDef& out) {
  std::array<std::int32_t, 3> n;
  for (int c = 0; c < 3; ++c) n[c] = 2 * pieces_of(0.5 * extent[c], size);
  require_room(2.0 * (1.0 * (n[0] + 1) * (n[1] + 1) + 1.0 * (n[1] + 1) * (n[2] + 1) + 1.0 * (n[2] + 1) * (n[0] + 1)));
  // Of a lattice point on the surface; layers below, above, and the rims between.
  const std::int32_t layer = (n[0] + 1) * (n[1] + 1), rim = 2 * (n[0] + n[1]);
  const auto vertex = [&](const std::array<std::int32_t, 3>& at) {
    const auto [i, j, k] = at;
    if (k == 0) return j * (n[0] + 1) + i;
    if (k == n[2]) return layer + (n[2] - 1) * rim + j * (n[0] + 1) + i;
    const std::int32_t around = j == 0 ? i : i == n[0] ? n[0] + j : j == n[1] ? 2 * n[0] + n[1] - i : rim - j;
    return layer + (k - 1) * rim + around;
  };
  out.vertices.resize(3 * (2 * static_cast<std::size_t>(layer) + static_cast<std::size_t>(n[2] - 1) * rim));
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const bool upper : {false, true})
      for (std::int32_t a = 0; a <= n[u]; ++a)
        for (std::int32_t b = 0; b <= n[v]; ++b) {
          const auto number = [&](std::int32_t p, std::int32_t q) {
            std::array<std::int32_t, 3> at;
            at[axis] = upper ? n[axis] : 0;
            at[u] = p;
            at[v] = q;
            const std::int32_t index = vertex(at);
            for (int c = 0; c < 3; ++c)
              out.vertices[3 * static_cast<std::size_t>(index) + c] = extent[c] * (static_cast<double>(at[c]) / n[c] - 0.5);
            return index;
          };
          const std::int32_t here = number(a, b);
          if (a == n[u] || b == n[v]) continue;
          const std::int32_t right = number(a + 1, b), across = number(a + 1, b + 1), up = number(a, b + 1);
          // The diagonals are mirrored with the rest.
          std::array<std::int32_t, 6> pair = {here, right, across, here, across, up};
          if ((2 * a < n[u]) != (2 * b < n[v])) pair = {here, right, up, right, across, up};
          if (!upper) std::swap(pair[0], pair[1]), std::swap(pair[3], pair[4]);
          out.corners.insert(out.corners.end(), pair.begin(), pair.end());
        }
  }
}

}  // namespace

SurfaceDef tessellate(const SurfaceDef& solid, double size) {
  SurfaceDef out;
  out.kind = SurfaceKind::Triangles;
  const Vector3& extent = solid.size;
  constexpr double right = 0.5 * std::numbers::pi;
  Profile profile;
  switch (solid.kind) {
    case SurfaceKind::Box: box(extent, size, out); break;
    case SurfaceKind::Sphere:
      profile.rings = {{0, -extent[0]}};
      profile.arc_to({0, 0}, extent[0], -right, 0, {extent[0], 0}, size);
      profile.arc_to({0, 0}, extent[0], 0, right, {0, extent[0]}, size);
      break;
    case SurfaceKind::Cylinder: {
      const double outer = extent[0], half = 0.5 * extent[1], inner = extent[2];
      profile.closed = inner > 0;
      profile.rings = {{inner, -half}};
      profile.line_to({outer, -half}, size);
      profile.line_to({outer, half}, size);
      profile.line_to({inner, half}, size);
      if (!profile.closed) break;
      profile.line_to({inner, -half}, size);
      profile.rings.pop_back();
      break;
    }
    case SurfaceKind::OgiveRod: {
      const double radius = extent[0], nose = ogive_nose_length(radius, extent[2]), arc = 2 * extent[2] * radius;
      profile.rings = {{0, -extent[1]}};
      profile.line_to({radius, -extent[1]}, size);
      if (extent[1] > nose) profile.line_to({radius, -nose}, size);
      profile.arc_to({radius - arc, -nose}, arc, 0, std::asin(nose / arc), {0, 0}, size);
      break;
    }
    default: throw Error(ErrorKind::Argument, "surface: there is no solid to be covered with triangles");
  }
  if (!profile.rings.empty()) turn(profile, size, out);
  for (std::size_t v = 0; v < out.vertices.size(); v += 3) {
    Vector3 x = solid.origin;
    for (int k = 0; k < 3; ++k) add(x, times(out.vertices[v + k], solid.axes[k]));
    std::copy(x.begin(), x.end(), out.vertices.begin() + static_cast<std::ptrdiff_t>(v));
  }
  return out;
}

}  // namespace ogive
