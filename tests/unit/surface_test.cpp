// Signed distances to surfaces: exact values at faces, edges, tips, inside and outside, of the built-in solids and of triangles.
#include "surface/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "error.hpp"
#include "solid_surfaces.hpp"

using namespace ogive;

namespace {

constexpr double far = 1e3;
SurfaceDef triangles_of_box(Vector3 size, Vector3 origin = {}) {
  SurfaceDef surface;
  surface.kind = SurfaceKind::Triangles;
  for (int v = 0; v < 8; ++v)
    for (int c = 0; c < 3; ++c) surface.vertices.push_back(origin[c] + (v >> c & 1 ? 0.5 : -0.5) * size[c]);
  // Two triangles a face, from outside counter-clockwise.
  surface.corners = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return surface;
}

Surface made(const SurfaceDef& def) { return Surface(def, nowhere, everywhere); }

SurfacePoint at(const Surface& surface, const Vector3& x) {
  SurfacePoint found;
  EXPECT_TRUE(surface.nearest(x, far, found));
  EXPECT_NEAR(length(found.normal), 1, 1e-12);
  return found;
}

void expect_point(const Surface& surface, const Vector3& x, double distance, const Vector3& normal) {
  const SurfacePoint found = at(surface, x);
  EXPECT_NEAR(found.distance, distance, 1e-12);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found.normal[c], normal[c], 1e-9) << c << " at " << x[0] << ' ' << x[1] << ' ' << x[2];
}

const double root2 = std::numbers::sqrt2, root3 = std::numbers::sqrt3;

}  // namespace

TEST(Surface, OfASphereIsAtTheDistanceFromItsCentreLessTheRadius) {
  const Surface sphere = made(solid(SurfaceKind::Sphere, {3, 0, 0}, {1, 2, 3}));
  expect_point(sphere, {1, 2, 8}, 2, {0, 0, 1});
  expect_point(sphere, {1, 1, 3}, -2, {0, -1, 0});
  expect_point(sphere, {5, 5, 3}, 2, {0.8, 0.6, 0});
  expect_point(sphere, {1, 2, 6}, 0, {0, 0, 1});
}

TEST(Surface, OfABoxIsExactAtFacesEdgesAndCornersInsideAndOutside) {
  for (const Surface& box : {made(solid(SurfaceKind::Box, {4, 6, 2})), made(triangles_of_box({4, 6, 2}))}) {
    expect_point(box, {0.3, 0.4, 3}, 2, {0, 0, 1});
    expect_point(box, {0.3, 0.4, 0.9}, -0.1, {0, 0, 1});
    expect_point(box, {-1.9, 0.4, 0.2}, -0.1, {-1, 0, 0});
    expect_point(box, {3, 0.4, 2}, root2, {1 / root2, 0, 1 / root2});            // beside an edge
    expect_point(box, {-3, -4, -2}, root3, {-1 / root3, -1 / root3, -1 / root3});  // before a corner
    expect_point(box, {-2.5, 2.9, 0.3}, 0.5, {-1, 0, 0});
  }
}

TEST(Surface, OfACylinderAndARingIsExactAtMantleEndsAndEdges) {
  const Surface rod = made(solid(SurfaceKind::Cylinder, {2, 6, 0}));
  expect_point(rod, {3, 0, 1}, 1, {1, 0, 0});
  expect_point(rod, {0, -1.5, 1}, -0.5, {0, -1, 0});
  expect_point(rod, {0, 0, 3.5}, 0.5, {0, 0, 1});
  expect_point(rod, {0.5, 0, -2.9}, -0.1, {0, 0, -1});
  expect_point(rod, {0, 3, 4}, root2, {0, 1 / root2, 1 / root2});
  const Surface ring = made(solid(SurfaceKind::Cylinder, {2, 6, 1}));
  expect_point(ring, {0.5, 0, 1}, 0.5, {-1, 0, 0});
  expect_point(ring, {0, 1.2, 1}, -0.2, {0, -1, 0});
}

TEST(Surface, OfAnOgiveRodHasASharpTipATangentShoulderAndAnEdgeAtItsEnd) {
  const double radius = 6.45, head = 3, all = 88.9, nose = ogive_nose_length(radius, head), arc = 2 * head * radius;
  const Surface rod = made(solid(SurfaceKind::OgiveRod, {radius, all, head}));
  expect_point(rod, {0, 0, 2}, 2, {0, 0, 1});  // before the tip
  expect_point(rod, {0.3, 0, 0.9}, std::hypot(0.3, 0.9), {0.3 / std::hypot(0.3, 0.9), 0, 0.9 / std::hypot(0.3, 0.9)});
  // On normals of the arc, whose centre lies beside the shoulder, from next to the tip to the shoulder.
  for (const double angle : {0.0, 0.2, 0.4, std::asin(nose / arc) - 1e-3})
    for (const double distance : {-0.4, -1e-3, 0.0, 0.7}) {
      const double r = radius - arc + (arc + distance) * std::cos(angle), z = -nose + (arc + distance) * std::sin(angle);
      if (r <= 0.4) continue;  // beyond the axis the other side is nearer
      expect_point(rod, {0.6 * r, 0.8 * r, z}, distance, {0.6 * std::cos(angle), 0.8 * std::cos(angle), std::sin(angle)});
    }
  expect_point(rod, {7.45, 0, -50}, 1, {1, 0, 0});
  expect_point(rod, {1, 0, -all + 0.5}, -0.5, {0, 0, -1});
  expect_point(rod, {7.45, 0, -all - 1}, root2, {1 / root2, 0, -1 / root2});
}

TEST(Surface, OfTrianglesAgreesWithTheBuiltInOneWhateverItsPlaceAndTurn) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-5, 5);
  const Surface box = made(solid(SurfaceKind::Box, {4, 6, 2})), mesh = made(triangles_of_box({4, 6, 2}));
  SurfaceDef def = solid(SurfaceKind::Box, {4, 6, 2}, {1, -2, 3}, {0.3, -0.5, 0.8});
  const Surface turned = made(def);
  double worst = 0, worst_turned = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 x = {part(random), part(random), part(random)};
    const SurfacePoint a = at(box, x), b = at(mesh, x);
    // Where two features are equally near, inside, either normal is right: the distance is the same.
    worst = std::max(worst, std::abs(a.distance - b.distance));
    const Vector3 y = plus(def.origin, plus(plus(times(x[0], def.axes[0]), times(x[1], def.axes[1])), times(x[2], def.axes[2])));
    const SurfacePoint c = at(turned, y);
    worst_turned = std::max(worst_turned, std::abs(a.distance - c.distance));
    SurfacePoint found;
    EXPECT_EQ(mesh.nearest(x, 0.5, found), std::abs(b.distance) <= 0.5);
    std::int32_t hint = i % 12;
    ASSERT_TRUE(mesh.nearest(x, far, found, &hint));
    EXPECT_EQ(found.distance, b.distance);
  }
  EXPECT_LE(worst, 1e-12);
  EXPECT_LE(worst_turned, 1e-12);
}

TEST(Surface, OfADentedMeshHasTheRightSignBesideItsReentrantEdge) {
  // An L of two boxes: the quadrant x > 0, z > 0 is outside.
  SurfaceDef def;
  def.kind = SurfaceKind::Triangles;
  const double profile[6][2] = {{-2, -2}, {2, -2}, {2, 0}, {0, 0}, {0, 2}, {-2, 2}};  // x, z
  for (const double y : {-3.0, 3.0})
    for (const auto& p : profile) def.vertices.insert(def.vertices.end(), {p[0], y, p[1]});
  const int cap[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  for (const auto& t : cap) {
    def.corners.insert(def.corners.end(), {t[0], t[1], t[2]});
    def.corners.insert(def.corners.end(), {6 + t[0], 6 + t[2], 6 + t[1]});
  }
  for (int k = 0; k < 6; ++k) {
    const int n = (k + 1) % 6;
    def.corners.insert(def.corners.end(), {k, 6 + k, n, n, 6 + k, 6 + n});
  }
  const Surface dented = made(def);
  expect_point(dented, {0.3, 0.2, 0.5}, 0.3, {1, 0, 0});
  expect_point(dented, {0.5, 0.2, 0.3}, 0.3, {0, 0, 1});
  expect_point(dented, {-0.3, 0, -0.4}, -0.5, {0.6, 0, 0.8});  // inside, nearest to the reentrant edge
  expect_point(dented, {3, 0.1, 1}, root2, {1 / root2, 0, 1 / root2});
}

TEST(Surface, MovesWithItsVertices) {
  SurfaceDef def = triangles_of_box({2, 2, 2});
  Surface surface = made(def);
  for (std::size_t i = 2; i < def.vertices.size(); i += 3) def.vertices[i] = 2 * def.vertices[i] + 1;
  surface.move(def.vertices);
  expect_point(surface, {0.1, 0.2, 4}, 1, {0, 0, 1});
  expect_point(surface, {0.1, 0.2, -0.9}, -0.1, {0, 0, -1});
}

TEST(Surface, RefusesTrianglesThatDoNotEncloseAVolume) {
  const auto refused = [](const SurfaceDef& def, const char* what) {
    try {
      made(def);
      ADD_FAILURE() << "accepted: " << what;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  SurfaceDef open = triangles_of_box({1, 1, 1});
  open.corners.resize(open.corners.size() - 3);
  refused(open, "must be closed");
  SurfaceDef inside_out = triangles_of_box({1, 1, 1});
  for (std::size_t t = 0; t < inside_out.corners.size(); t += 3) std::swap(inside_out.corners[t], inside_out.corners[t + 1]);
  refused(inside_out, "enclose a volume");
  SurfaceDef turned = triangles_of_box({1, 1, 1});
  std::swap(turned.corners[0], turned.corners[1]);
  refused(turned, "same direction");
  SurfaceDef flat = triangles_of_box({1, 1, 1});
  flat.corners[0] = flat.corners[1];
  refused(flat, "must have an area");
  SurfaceDef unknown = triangles_of_box({1, 1, 1});
  unknown.corners[5] = 8;
  refused(unknown, "0..7");
  SurfaceDef infinite = triangles_of_box({1, 1, 1});
  infinite.vertices[4] = std::nan("");
  refused(infinite, "finite");
}
