// Triangles of the built-in solids: closed, on the solid's surface, no coarser than asked, mirrored with their diagonals.
#include "surface/tessellate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "error.hpp"
#include "solid_surfaces.hpp"

using namespace ogive;

namespace {

Vector3 vertex(const SurfaceDef& surface, std::int32_t v) {
  return {surface.vertices[3 * v], surface.vertices[3 * v + 1], surface.vertices[3 * v + 2]};
}

double volume(const SurfaceDef& surface) {
  double sum = 0;
  for (std::size_t t = 0; t < surface.corners.size(); t += 3)
    sum += dot(vertex(surface, surface.corners[t]),
               cross(vertex(surface, surface.corners[t + 1]), vertex(surface, surface.corners[t + 2]))) /
           6;
  return sum;
}

struct Case {
  const char* name;
  SurfaceKind kind;
  Vector3 size;
  double volume;
};
constexpr double pi = std::numbers::pi;
const Case cases[] = {{"box", SurfaceKind::Box, {3, 2, 5}, 30},
                      {"sphere", SurfaceKind::Sphere, {2, 0, 0}, 4 * pi / 3 * 8},
                      {"cylinder", SurfaceKind::Cylinder, {2, 5, 0}, pi * 4 * 5},
                      {"tube", SurfaceKind::Cylinder, {2, 5, 1}, pi * 3 * 5},
                      {"ogive rod", SurfaceKind::OgiveRod, {1.5, 8, 3}, 0}};

}  // namespace

TEST(Tessellate, GivesClosedSurfacesWhoseVerticesLieOnTheSolid) {
  for (const Case& at : cases)
    for (const double size : {0.1, 0.5, 30.0}) {
      const SurfaceDef exact = solid(at.kind, at.size, {0.3, -2, 1}, {0.3, 0.4, -1});
      const SurfaceDef surface = tessellate(exact, size);
      check_triangles(surface.vertices, surface.corners);
      const Surface distances(exact, nowhere, everywhere);
      double worst = 0, longest = 0;
      for (std::size_t v = 0; v < surface.vertices.size() / 3; ++v) {
        SurfacePoint found;
        ASSERT_TRUE(distances.nearest(vertex(surface, static_cast<std::int32_t>(v)), 1, found));
        worst = std::max(worst, std::abs(found.distance));
      }
      for (std::size_t i = 0; i < surface.corners.size(); ++i)
        longest = std::max(longest, length(minus(vertex(surface, surface.corners[i]),
                                                 vertex(surface, surface.corners[i % 3 == 2 ? i - 2 : i + 1]))));
      EXPECT_LE(worst, 1e-14) << at.name << ", " << size;  // measured 3e-15
      // Diagonals are longer than sides.
      if (size < 1) {
        EXPECT_LE(longest, 1.5 * size) << at.name;
      }
      if (at.volume > 0 && size < 0.2) {
        EXPECT_NEAR(volume(surface) / at.volume, 1, 2e-3) << at.name;
      }
    }
}

TEST(Tessellate, KeepsTheSharpTipOfAnOgive) {
  const SurfaceDef surface = tessellate(solid(SurfaceKind::OgiveRod, {1.5, 8, 3}), 0.4);
  double highest = -1;
  for (std::size_t v = 2; v < surface.vertices.size(); v += 3) highest = std::max(highest, surface.vertices[v]);
  EXPECT_EQ(highest, 0);
}

TEST(Tessellate, IsMirroredWithItsDiagonals) {
  for (const Case& at : cases)
    for (const int axis : {0, 1}) {
      const SurfaceDef surface = tessellate(solid(at.kind, at.size), 0.4);
      // Places to round-off.
      const auto key = [](Vector3 x) {
        return std::array<long, 3>{std::lround(x[0] * 1e9), std::lround(x[1] * 1e9), std::lround(x[2] * 1e9)};
      };
      using Triangle = std::array<std::array<long, 3>, 3>;
      std::set<Triangle> own, mirrored;
      for (std::size_t t = 0; t < surface.corners.size(); t += 3) {
        Triangle here, there;
        for (int k = 0; k < 3; ++k) {
          Vector3 x = vertex(surface, surface.corners[t + k]);
          here[k] = key(x);
          x[axis] = -x[axis];
          there[k] = key(x);
        }
        std::sort(here.begin(), here.end());
        std::sort(there.begin(), there.end());
        own.insert(here);
        mirrored.insert(there);
      }
      EXPECT_EQ(own, mirrored) << at.name << ", axis " << axis;
    }
}

TEST(Tessellate, RefusesTrianglesWithoutNumber) {
  EXPECT_THROW(tessellate(solid(SurfaceKind::Sphere, {1e9, 0, 0}), 1e-9), Error);
  EXPECT_THROW(tessellate(solid(SurfaceKind::Box, {1e6, 1e6, 1}), 1), Error);
}
