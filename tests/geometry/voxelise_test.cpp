// Filling surfaces with particles: which centres, where they go, and what volume they carry.
#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "support.hpp"

namespace geometry_test {
namespace {

// In long double: the rounding of a plain sum over 80,000 particles is 3e-12, more than what is tested.
double sum(const std::vector<double>& values) {
  return static_cast<double>(std::accumulate(values.begin(), values.end(), 0.0L));
}

std::set<Vec3> as_set(const Particles& particles) { return {particles.position.begin(), particles.position.end()}; }

// |x| + |y| + |z| <= size; its corners, edges and facets pass through points with whole coordinates.
Facets octahedron(double size) {
  Facets result;
  result.vertices = {{size, 0, 0}, {-size, 0, 0}, {0, size, 0}, {0, -size, 0}, {0, 0, size}, {0, 0, -size}};
  result.corners = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return result;
}

// Centres at whole coordinates times the spacing.
ogive_voxelise_def whole_lattice(double spacing) {
  ogive_voxelise_def def = lattice(spacing);
  set(def.lattice_origin, {spacing / 2, spacing / 2, spacing / 2});
  return def;
}

// How often the surface winds round a point: the sum of the solid angles of its facets (van Oosterom & Strackee 1983).
// This is independent of the library's way of deciding, and slow.
double winding(const Facets& facets, const Vec3& p) {
  double angle = 0;
  for (const auto& f : facets.corners) {
    Vec3 r[3];
    double length[3];
    for (int c = 0; c < 3; ++c) {
      for (int d = 0; d < 3; ++d) r[c][d] = facets.vertices[f[c]][d] - p[d];
      length[c] = std::hypot(r[c][0], r[c][1], r[c][2]);
    }
    const auto dot = [&](int a, int b) { return r[a][0] * r[b][0] + r[a][1] * r[b][1] + r[a][2] * r[b][2]; };
    const double triple = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) +
                          r[0][1] * (r[1][2] * r[2][0] - r[1][0] * r[2][2]) +
                          r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    angle += 2 * std::atan2(triple, length[0] * length[1] * length[2] + dot(0, 1) * length[2] + dot(1, 2) * length[0] +
                                        dot(2, 0) * length[1]);
  }
  return angle / (4 * kPi);
}

void expect_volumes_sum_to(double volume, const Particles& particles) {
  EXPECT_NEAR(sum(particles.volume) / volume, 1, 1e-12);
  EXPECT_EQ(*std::min_element(particles.volume.begin(), particles.volume.end()), particles.volume[0]);
}

TEST(Voxelise, ABoxIsFilledByWholeCells) {
  Mesh mesh(box({-1, -2, -3}, {1, 2, 3}));
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  const Particles particles = mesh.fill(lattice(0.5, 1, 2));
  ASSERT_EQ(particles.position.size(), 4u * 4 * 4) << "in z -3 and 3, on the surface, count";
  expect_volumes_sum_to(48, particles);
  const std::set<Vec3> got = as_set(particles);
  for (double x : {-0.75, -0.25, 0.25, 0.75}) {
    for (double y : {-1.5, -0.5, 0.5, 1.5}) {
      for (double z : {-3.0, -1.0, 1.0, 3.0}) EXPECT_TRUE(got.count({x, y, z}));
    }
  }
}

TEST(Voxelise, ParticlesOfAnLShapeStayOutOfItsCorner) {
  Mesh mesh(l_shape());
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  const Particles particles = mesh.fill(lattice(0.125));
  EXPECT_EQ(particles.position.size(), 3u * 8 * 8 * 8);
  EXPECT_EQ(as_set(particles).size(), particles.position.size()) << "each once";
  for (const Vec3& p : particles.position) {
    EXPECT_TRUE(p[0] > 0 && p[0] < 2 && p[1] > 0 && p[1] < 2 && p[2] > 0 && p[2] < 1 && (p[0] < 1 || p[1] < 1));
  }
  expect_volumes_sum_to(3, particles);
  EXPECT_NEAR(particles.volume[0], std::pow(0.125, 3), 1e-17) << "whole cells need no correction";
}

// The count of centres times the cell volume, before it is corrected, against the exact solid. Measured: sphere of a
// radius of 20 spacings +0.12 %, torus with a tube of 12 spacings +0.23 %, rod at 0.5 mm +0.37 %.
TEST(Voxelise, CellsInsideFillSphereTorusAndRod) {
  Mesh ball(sphere(2, 128, 128));
  ASSERT_EQ(ball.check(), OGIVE_OK);
  const Particles in_ball = ball.fill(lattice(0.1));
  EXPECT_NEAR(static_cast<double>(in_ball.position.size()) * 1e-3 / (4.0 / 3 * kPi * 8), 1, 3e-3);
  expect_volumes_sum_to(ball.info().volume, in_ball);
  EXPECT_NEAR(sum(in_ball.volume) / (4.0 / 3 * kPi * 8), 1, 1e-3);

  Mesh ring(torus(3, 1, 180, 128));
  ASSERT_EQ(ring.check(), OGIVE_OK);
  const Particles in_ring = ring.fill(lattice(0.083));
  EXPECT_NEAR(static_cast<double>(in_ring.position.size()) * std::pow(0.083, 3) / (2 * kPi * kPi * 3), 1, 3e-3);
  expect_volumes_sum_to(ring.info().volume, in_ring);
  for (const Vec3& p : in_ring.position) {
    ASSERT_LT(std::hypot(std::hypot(p[0], p[1]) - 3, p[2]), 1.001)
        << "in the tube (whose facets bulge a little at the hole); the hole is empty";
  }

  Mesh rod;
  ASSERT_EQ(rod.read(OGIVE_SCENES "/thick_plate/rod.stl"), OGIVE_OK) << rod.message();
  ASSERT_EQ(rod.check(), OGIVE_OK) << rod.message();
  const Particles in_rod = rod.fill(lattice(0.5));
  EXPECT_NEAR(static_cast<double>(in_rod.position.size()) * 0.125 / 10352.460477, 1, 5e-3);
  expect_volumes_sum_to(rod.info().volume, in_rod);
  EXPECT_NEAR(sum(in_rod.volume) / 10352.460477, 1, 5e-4);
  const double r = 6.45, big = 38.7, h = std::sqrt(big * big - (big - r) * (big - r));
  for (const Vec3& p : in_rod.position) {
    const double s = -p[2], rho = s >= h ? r : std::sqrt(big * big - (h - s) * (h - s)) - (big - r);
    ASSERT_LE(std::hypot(p[0], p[1]), rho + 1e-6) << "inside the solid";
    ASSERT_LE(s, 88.9);
  }
}

TEST(Voxelise, CentresOnCornersEdgesAndFacetsBelongToTheSolid) {
  for (int size = 1; size <= 6; ++size) {
    Mesh mesh(octahedron(size));
    ASSERT_EQ(mesh.check(), OGIVE_OK);
    const std::set<Vec3> got = as_set(mesh.fill(whole_lattice(1)));
    size_t expected = 0;
    for (int x = -size; x <= size; ++x) {
      for (int y = -size; y <= size; ++y) {
        for (int z = -size; z <= size; ++z) {
          if (std::abs(x) + std::abs(y) + std::abs(z) > size) continue;
          ++expected;
          EXPECT_TRUE(got.count({double(x), double(y), double(z)})) << size << ": " << x << " " << y << " " << z;
        }
      }
    }
    EXPECT_EQ(got.size(), expected) << size;
  }
  Mesh cube(box({0, 0, 0}, {3, 3, 3}));
  ASSERT_EQ(cube.check(), OGIVE_OK);
  EXPECT_EQ(cube.fill(whole_lattice(1)).position.size(), 64u);
  Mesh bent(l_shape());
  ASSERT_EQ(bent.check(), OGIVE_OK);
  EXPECT_EQ(bent.fill(whole_lattice(1)).position.size(), 16u) << "all but (2, 2, z)";
}

// A silhouette edge and its ends, in directions that no moved line goes: a wedge about the z axis, and thin.
TEST(Voxelise, CentresOnThinEdgesAlongAnyAxisBelongToTheSolid) {
  for (int turn = 0; turn < 3; ++turn) {
    Facets wedge = prism({{0, 0}, {4, 1.9}, {4, 2.1}}, {{0, 1, 2}}, 9);
    for (Vec3& p : wedge.vertices) p = {p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]};
    Mesh mesh(wedge);
    ASSERT_EQ(mesh.check(), OGIVE_OK) << mesh.message();
    const std::set<Vec3> got = as_set(mesh.fill(whole_lattice(1)));
    EXPECT_EQ(got.size(), 30u) << "the edge x = y = 0, and (2, 1, z), (4, 2, z)";
    for (int z = 0; z <= 9; ++z) {
      for (const Vec3& p : {Vec3{0, 0, double(z)}, {2, 1, double(z)}, {4, 2, double(z)}}) {
        EXPECT_TRUE(got.count({p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]})) << turn << " " << z;
      }
    }
  }
}

TEST(Voxelise, ACavityStaysEmptyAndItsSurfaceBelongsToTheSolid) {
  Facets hollow = octahedron(6);
  hollow.add(octahedron(3).inverted());
  Mesh mesh(hollow);
  ASSERT_EQ(mesh.check(), OGIVE_OK) << mesh.message();
  const Particles particles = mesh.fill(whole_lattice(1));
  size_t expected = 0;
  for (int x = -6; x <= 6; ++x) {
    for (int y = -6; y <= 6; ++y) {
      for (int z = -6; z <= 6; ++z) {
        const int norm = std::abs(x) + std::abs(y) + std::abs(z);
        expected += norm <= 6 && norm >= 3;
      }
    }
  }
  EXPECT_EQ(particles.position.size(), expected);
  for (const Vec3& p : particles.position) EXPECT_GE(std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]), 3);
  expect_volumes_sum_to(4.0 / 3 * (216 - 27), particles);
}

TEST(Voxelise, OnAnyLatticeTheParticlesAreTheCentresThatTheSurfaceWindsRound) {
  Facets solid = torus(3, 1, 24, 12);  // coarse: the polyhedron itself counts
  solid.add(l_shape().moved({-0.9, -0.9, 1.5}));
  Mesh mesh(solid);
  ASSERT_EQ(mesh.check(), OGIVE_OK) << mesh.message();
  ogive_voxelise_def def = lattice(0.31, 0.27, 0.43);
  set(def.lattice_axis, {0.3, -0.5, 0.7});
  set(def.lattice_reference, {1, 0.2, 0.1});
  set(def.lattice_origin, {0.05, 0.02, -0.01});
  const Particles particles = mesh.fill(def);
  ASSERT_GT(particles.position.size(), 1000u);
  for (const Vec3& p : particles.position) ASSERT_NEAR(winding(solid, p), 1, 1e-9);

  // The lattice axes from the definition, worked out apart; all its centres in the bounding box.
  const double n = std::hypot(0.3, -0.5, 0.7);
  const Vec3 z = {0.3 / n, -0.5 / n, 0.7 / n};
  Vec3 x = {1, 0.2, 0.1};
  const double along = x[0] * z[0] + x[1] * z[1] + x[2] * z[2];
  for (int d = 0; d < 3; ++d) x[d] -= along * z[d];
  const double m = std::hypot(x[0], x[1], x[2]);
  for (double& c : x) c /= m;
  const Vec3 y = {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]};
  size_t inside = 0;
  for (int i = -20; i < 20; ++i) {
    for (int j = -20; j < 20; ++j) {
      for (int k = -14; k < 14; ++k) {
        Vec3 p;
        for (int d = 0; d < 3; ++d) {
          p[d] = def.lattice_origin[d] + (i + 0.5) * 0.31 * x[d] + (j + 0.5) * 0.27 * y[d] + (k + 0.5) * 0.43 * z[d];
        }
        inside += winding(solid, p) > 0.5;
      }
    }
  }
  EXPECT_EQ(particles.position.size(), inside);
  expect_volumes_sum_to(mesh.info().volume, particles);
}

TEST(Voxelise, ARotatedLatticeAlignedWithARotatedBoxFillsItByWholeCells) {
  const double c = std::cos(0.4), s = std::sin(0.4);
  Facets turned = box({-1, -1, -2}, {1, 1, 2});
  for (Vec3& p : turned.vertices) p = {c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2]};
  Mesh mesh(turned);
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  ogive_voxelise_def def = lattice(0.2);
  set(def.lattice_axis, {s, 0, c});
  const Particles particles = mesh.fill(def);
  EXPECT_EQ(particles.position.size(), 10u * 10 * 20);
  EXPECT_NEAR(particles.volume[0], 0.008, 1e-15);
}

TEST(Voxelise, TheObliqueRodIsMirrorSymmetricAboutYToTheLastBit) {
  Mesh rod;
  ASSERT_EQ(rod.read(OGIVE_SCENES "/thick_plate/rod.stl"), OGIVE_OK) << rod.message();
  ASSERT_EQ(rod.check(), OGIVE_OK) << rod.message();
  ogive_voxelise_def def = lattice(0.62, 0.62, 1.0);
  set(def.axis, {std::sin(kPi / 6), 0, std::cos(kPi / 6)});
  set(def.position, {0, 0, -4});
  const Particles particles = rod.fill(def);
  const std::set<Vec3> got = as_set(particles);
  ASSERT_GT(got.size(), 20000u);
  ASSERT_EQ(got.size(), particles.position.size());
  for (const Vec3& p : got) ASSERT_TRUE(got.count({p[0], -p[1], p[2]})) << p[0] << " " << p[1] << " " << p[2];
  expect_volumes_sum_to(rod.info().volume, particles);
}

TEST(Voxelise, SymmetricMeshesGetSymmetricParticlesEvenWhereLinesMeetEdges) {
  // Lines through every edge and corner of the rings: spacing and radii agree.
  Mesh mesh(octahedron(4));
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  for (double spacing : {0.25, 0.3, 0.5, 0.7, 1.0, 1.6}) {
    const std::set<Vec3> got = as_set(mesh.fill(lattice(spacing)));
    for (const Vec3& p : got) {
      EXPECT_TRUE(got.count({-p[0], p[1], p[2]}) && got.count({p[0], -p[1], p[2]}) && got.count({p[0], p[1], -p[2]}));
      EXPECT_TRUE(got.count({p[1], p[0], p[2]}) && got.count({p[2], p[1], p[0]}))
          << "whichever axis the lines run along";
    }
  }
}

TEST(Voxelise, PositionAxisAndReferencePlaceTheBodyWithItsLattice) {
  Mesh mesh(box({0, 0, 0}, {3, 2, 1}));
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  ogive_voxelise_def def = lattice(1);
  const Particles before = mesh.fill(def);
  set(def.axis, {2, 0, 0});         // mesh z -> world x
  set(def.reference, {7, 0, 3});    // mesh x -> world z
  set(def.position, {10, 20, 30});  // so mesh y -> world y, right-handed: z x x = (1,0,0) x (0,0,1) = (0,-1,0)
  const Particles after = mesh.fill(def);
  ASSERT_EQ(after.position.size(), 6u);
  for (size_t n = 0; n < 6; ++n) {
    const Vec3& p = before.position[n];
    EXPECT_NEAR(after.position[n][0], 10 + p[2], 1e-14);
    EXPECT_NEAR(after.position[n][1], 20 - p[1], 1e-14);
    EXPECT_NEAR(after.position[n][2], 30 + p[0], 1e-14);
    EXPECT_EQ(after.volume[n], before.volume[n]);
  }
}

// World positions of the mesh points (1,0,0), (0,1,0), (0,0,1) under `axis` alone: a box round each gives one particle.
std::array<Vec3, 3> columns(const Vec3& axis) {
  std::array<Vec3, 3> result;
  for (int column = 0; column < 3; ++column) {
    Vec3 at = {0, 0, 0}, lower, upper;
    at[column] = 1;
    for (int d = 0; d < 3; ++d) lower[d] = at[d] - 0.1, upper[d] = at[d] + 0.1;
    Mesh mesh(box(lower, upper));
    EXPECT_EQ(mesh.check(), OGIVE_OK);
    ogive_voxelise_def def = whole_lattice(1);
    set(def.axis, axis);
    const Particles particles = mesh.fill(def);
    EXPECT_EQ(particles.position.size(), 1u);
    if (!particles.position.empty()) result[column] = particles.position[0];
  }
  return result;
}

TEST(Voxelise, WithoutAReferenceTheRotationIsTheSmallestThatTakesZToTheAxis) {
  const auto identity = columns({0, 0, 5});
  EXPECT_EQ(identity[0], (Vec3{1, 0, 0}));
  EXPECT_EQ(identity[1], (Vec3{0, 1, 0}));
  EXPECT_EQ(identity[2], (Vec3{0, 0, 1}));
  const auto half_turn = columns({0, 0, -1e-300});
  EXPECT_EQ(half_turn[0], (Vec3{-1, 0, 0}));
  EXPECT_EQ(half_turn[1], (Vec3{0, 1, 0}));
  EXPECT_EQ(half_turn[2], (Vec3{0, 0, -1}));

  for (const Vec3& axis :
       {Vec3{0.5, 0, 0.8}, {-0.5, 0, -0.8}, {1, 2, 3}, {1e-9, 2e-9, -1}, {1, -1, -1e-3}, {1e99, 1e99, 0}}) {
    const auto r = columns(axis);
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    double trace = 0;
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(r[2][a], axis[a] / length, 1e-15);
      trace += r[a][a];
      for (int b = 0; b < 3; ++b) {
        EXPECT_NEAR(r[a][0] * r[b][0] + r[a][1] * r[b][1] + r[a][2] * r[b][2], a == b, 4e-15);
      }
    }
    // The angle of the rotation is that between z and the axis: no twist.
    EXPECT_NEAR((trace - 1) / 2, axis[2] / length, 4e-15);
    if (axis[1] == 0) {
      EXPECT_EQ(r[1], (Vec3{0, 1, 0})) << "y stays as it is, exactly";
    }
  }
}

TEST(Voxelise, OneParticleIsEnoughAndNoneIsAnError) {
  Mesh mesh(box({0, 0, 0}, {1, 1, 1}));
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  const Particles one = mesh.fill(lattice(1.9));
  ASSERT_EQ(one.position.size(), 1u);
  EXPECT_EQ(one.volume[0], 1);
  EXPECT_TRUE(mesh.fill(lattice(2.1)).position.empty());
  EXPECT_EQ(lacks(mesh.message(), {"spacing = (2.1, 2.1, 2.1)", "no lattice centre lies inside", "1 x 1 x 1"}), "");
}

TEST(Voxelise, ALatticeThatRoundingWouldBlurIsRefused) {
  Mesh mesh(box({1e12, 0, 0}, {1e12 + 1, 1, 1}));
  ASSERT_EQ(mesh.check(), OGIVE_OK) << mesh.message();
  ogive_voxelise_def def = lattice(1e-3);
  set(def.lattice_origin, {1e12, 0, 0});
  EXPECT_TRUE(mesh.fill(def).position.empty());
  EXPECT_EQ(lacks(mesh.message(), {"spacing[0] = 0.001", "cells from the lattice origin, or that from the mesh's"}),
            "");
}

TEST(Voxelise, TheSameQuestionGetsTheSameAnswerToTheLastBit) {
  Mesh a(sphere(1, 32, 32)), b(sphere(1, 32, 32));
  ASSERT_EQ(a.check(), OGIVE_OK);
  ASSERT_EQ(b.check(), OGIVE_OK);
  const Particles first = a.fill(lattice(0.07)), second = b.fill(lattice(0.07));
  EXPECT_EQ(first.position, second.position);
  EXPECT_EQ(first.volume, second.volume);
}

}  // namespace
}  // namespace geometry_test
