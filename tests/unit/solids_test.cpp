// Built-in solids: counts, volumes, centres of mass, symmetry, inertia, directions and refusals.
#include "solids.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "error.hpp"

namespace {

using ogive::exact_volume;
using ogive::fill_solid;
using ogive::Lattice;
using ogive::ParticleCloud;
using ogive::SolidDef;
using ogive::SolidShape;
using Vector = std::array<double, 3>;

constexpr double pi = 3.14159265358979323846;
constexpr double infinity = std::numeric_limits<double>::infinity();

SolidDef make(SolidShape shape, Vector size, Vector spacing, Lattice lattice = Lattice::Cartesian) {
  SolidDef solid;
  solid.shape = shape;
  solid.size = size;
  solid.spacing = spacing;
  solid.lattice = lattice;
  return solid;
}

SolidDef box() { return make(SolidShape::Box, {3.0, 2.0, 1.5}, {0.1, 0.13, 0.2}); }
SolidDef cylinder() { return make(SolidShape::Cylinder, {5.0, 4.0, 0.0}, {0.25, 0.25, 0.3}); }
SolidDef ring() { return make(SolidShape::Cylinder, {5.0, 4.0, 3.0}, {0.1, 0.1, 0.3}); }
SolidDef sphere() { return make(SolidShape::Sphere, {5.0, 0.0, 0.0}, {0.25, 0.25, 0.25}); }
SolidDef rod() { return make(SolidShape::OgiveRod, {6.45, 88.9, 3.0}, {0.31, 0.31, 0.5}); }
SolidDef polar_ring() { return make(SolidShape::Cylinder, {40.0, 12.0, 30.0}, {1.0, 0.887, 1.0}, Lattice::Polar); }
SolidDef polar_cylinder() { return make(SolidShape::Cylinder, {5.0, 4.0, 0.0}, {0.25, 0.3, 0.4}, Lattice::Polar); }

std::vector<SolidDef> all_solids() {
  return {box(), cylinder(), ring(), sphere(), rod(), polar_ring(), polar_cylinder()};
}

std::size_t count(const SolidDef& solid) {
  const ParticleCloud cloud = fill_solid(solid);
  EXPECT_EQ(cloud.xyz.size(), 3 * cloud.volume.size());
  return cloud.volume.size();
}

double sum_of_volumes(const ParticleCloud& cloud) {
  long double sum = 0.0L;
  for (const double volume : cloud.volume) sum += volume;
  return static_cast<double>(sum);
}

Vector centre_of_mass(const ParticleCloud& cloud) {
  long double sum[3] = {0.0L, 0.0L, 0.0L}, total = 0.0L;
  for (std::size_t p = 0; p < cloud.volume.size(); ++p) {
    for (int i = 0; i < 3; ++i) sum[i] += static_cast<long double>(cloud.volume[p]) * cloud.xyz[3 * p + i];
    total += cloud.volume[p];
  }
  return {static_cast<double>(sum[0] / total), static_cast<double>(sum[1] / total),
          static_cast<double>(sum[2] / total)};
}

// Sum of volume times x_i^2.
double second_moment(const ParticleCloud& cloud, int i) {
  long double sum = 0.0L;
  for (std::size_t p = 0; p < cloud.volume.size(); ++p) {
    sum += static_cast<long double>(cloud.volume[p]) * cloud.xyz[3 * p + i] * cloud.xyz[3 * p + i];
  }
  return static_cast<double>(sum);
}

std::vector<Vector> sorted_positions(const ParticleCloud& cloud, Vector signs = {1.0, 1.0, 1.0}) {
  std::vector<Vector> positions(cloud.volume.size());
  for (std::size_t p = 0; p < positions.size(); ++p) {
    for (int i = 0; i < 3; ++i) positions[p][i] = signs[i] * cloud.xyz[3 * p + i] + 0.0;
  }
  std::sort(positions.begin(), positions.end());
  return positions;
}

void expect_refused(const SolidDef& solid, const std::string& message) {
  try {
    fill_solid(solid);
    ADD_FAILURE() << "accepted, expected: " << message;
  } catch (const ogive::Error& error) {
    EXPECT_EQ(error.what(), message);
    EXPECT_EQ(error.kind(), ogive::ErrorKind::Argument);
  }
}

// ----------------------------------------------------------------------------------------------------------------
// counts

TEST(Solids, ABoxHasTheNearestWholeNumberOfParticlesAlongEachEdge) {
  EXPECT_EQ(count(make(SolidShape::Box, {120.0, 60.0, 26.3}, {1.0, 1.0, 1.0})), 120u * 60u * 26u);
  EXPECT_EQ(count(box()), 30u * 15u * 8u);  // 2 / 0.13 = 15.4, 1.5 / 0.2 = 7.5
  EXPECT_EQ(count(make(SolidShape::Box, {0.1, 3.0, 1.0}, {1.0, 1.0, 1.0})), 3u) << "at least one along a thin edge";
}

TEST(Solids, ABoxesParticlesLieInTheMiddleOfEqualCells) {
  const ParticleCloud cloud = fill_solid(make(SolidShape::Box, {3.0, 1.0, 0.9}, {0.9, 1.0, 1.0}));
  ASSERT_EQ(cloud.volume.size(), 3u);
  EXPECT_EQ(cloud.xyz, (std::vector<double>{-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0}));
  for (const double volume : cloud.volume) EXPECT_DOUBLE_EQ(volume, 0.9);
}

TEST(Solids, TheThinPlateOfTheSteelBallCaseHasFourTimes398184Particles) {
  const ParticleCloud cloud = fill_solid(make(SolidShape::Cylinder, {89.0, 1.0, 0.0}, {0.25, 0.25, 0.25}));
  EXPECT_EQ(cloud.volume.size(), 4u * 398184u);
  std::size_t in_quarter = 0;
  for (std::size_t p = 0; p < cloud.volume.size(); ++p)
    in_quarter += cloud.xyz[3 * p] > 0.0 && cloud.xyz[3 * p + 1] > 0.0;
  EXPECT_EQ(in_quarter, 398184u);
}

TEST(Solids, ThePolarRingOfTheRingCollisionHas29760Particles) {
  const ParticleCloud cloud = fill_solid(polar_ring());
  EXPECT_EQ(cloud.volume.size(), 10u * 248u * 12u);
  EXPECT_EQ(cloud.volume.size(), 29760u);
  for (std::size_t p = 0; p < cloud.volume.size(); ++p) {
    const double r = std::hypot(cloud.xyz[3 * p], cloud.xyz[3 * p + 1]);
    const double layer = std::floor(r - 30.0);
    EXPECT_NEAR(r, 30.5 + layer, 1e-13);
    const double sector = ((31.0 + layer) * (31.0 + layer) - (30.0 + layer) * (30.0 + layer)) * pi / 248.0;
    EXPECT_NEAR(cloud.volume[p], sector, 1e-14);
  }
}

TEST(Solids, APolarCylinderHasSectorsInProportionToEachLayersRadius) {
  const ParticleCloud cloud = fill_solid(make(SolidShape::Cylinder, {4.0, 1.0, 0.0}, {1.0, 0.5, 1.0}, Lattice::Polar));
  std::array<int, 4> sectors{};
  for (std::size_t p = 0; p < cloud.volume.size(); ++p) {
    ++sectors[static_cast<std::size_t>(std::hypot(cloud.xyz[3 * p], cloud.xyz[3 * p + 1]))];
  }
  EXPECT_EQ(sectors, (std::array<int, 4>{8, 20, 32, 44}));  // 4 round(pi / 2 r / 0.5), r = 0.5, 1.5, 2.5, 3.5
}

TEST(Solids, ACentreExactlyOnTheSurfaceBelongsToTheSolid) {
  // (1.5, 0.5) and (0.5, 1.5) in units of a spacing that has no exact binary form.
  for (const double h : {1.0, 0.1, 0.3, 1.0 / 3.0, 0.7}) {
    EXPECT_EQ(count(make(SolidShape::Cylinder, {h * std::sqrt(2.5), h, 0.0}, {h, h, h})), 12u) << h;
    EXPECT_EQ(count(make(SolidShape::Cylinder, {h * std::sqrt(2.5), h, h * std::sqrt(0.5)}, {h, h, h})), 12u) << h;
    EXPECT_EQ(count(make(SolidShape::Sphere, {h * std::sqrt(0.75), 0.0, 0.0}, {h, h, h})), 8u) << h;
    EXPECT_EQ(count(make(SolidShape::Sphere, {h * std::sqrt(2.75), 0.0, 0.0}, {h, h, h})), 32u) << h;
  }
}

TEST(Solids, ExactlyTheLatticeCentresInsideAreTaken) {
  for (const SolidDef& solid : {sphere(), ring(), rod()}) {
    const Vector h = solid.spacing;
    const double length = solid.size[1], radius = solid.size[0];
    const double slices = std::round(length / h[2]);
    std::size_t expected = 0;
    for (int k = -200; k < 200; ++k) {
      const double z = solid.shape == SolidShape::Cylinder ? (k + 0.5 * std::fmod(slices + 1.0, 2.0)) * length / slices
                                                           : (k + 0.5) * h[2];
      for (int j = -60; j < 60; ++j) {
        for (int i = -60; i < 60; ++i) {
          const double r = std::hypot((i + 0.5) * h[0], (j + 0.5) * h[1]);
          if (solid.shape == SolidShape::Sphere) expected += std::hypot(r, z) <= radius;
          if (solid.shape == SolidShape::Cylinder) {
            expected += r <= radius && r >= solid.size[2] && std::fabs(z) < 0.5 * length;
          }
          if (solid.shape == SolidShape::OgiveRod) {
            expected += z < 0.0 && -z <= length && r <= ogive::ogive_radius_at(radius, solid.size[2], -z);
          }
        }
      }
    }
    EXPECT_EQ(count(solid), expected) << "shape " << static_cast<int>(solid.shape);
  }
}

// ---------------------------------------------------------------------------------------------------- volumes and
// moments

TEST(Solids, VolumesArePositiveAndSumToTheExactVolume) {
  for (const SolidDef& solid : all_solids()) {
    const ParticleCloud cloud = fill_solid(solid);
    EXPECT_GT(*std::min_element(cloud.volume.begin(), cloud.volume.end()), 0.0);
    EXPECT_NEAR(sum_of_volumes(cloud) / exact_volume(solid), 1.0, 1e-12) << static_cast<int>(solid.shape);
  }
}

TEST(Solids, ExactVolumesAreThoseOfTheClosedForms) {
  EXPECT_DOUBLE_EQ(exact_volume(box()), 9.0);
  EXPECT_DOUBLE_EQ(exact_volume(cylinder()), pi * 25.0 * 4.0);
  EXPECT_DOUBLE_EQ(exact_volume(ring()), pi * 16.0 * 4.0);
  EXPECT_DOUBLE_EQ(exact_volume(sphere()), pi * 4.0 / 3.0 * 125.0);
  // CRH 0.5 is a hemisphere on a shank.
  EXPECT_NEAR(exact_volume(make(SolidShape::OgiveRod, {2.0, 5.0, 0.5}, {})), pi * (16.0 / 3.0 + 4.0 * 3.0), 1e-13);
}

TEST(Solids, TheOgivesVolumeIsTheIntegralOfItsProfile) {
  for (const double head : {0.5, 1.0, 3.0, 8.0, 50.0}) {
    const double radius = 6.45, nose = ogive::ogive_nose_length(radius, head);
    double integral = 0.0;  // Simpson in t, d = nose t^2, because the profile has a square root's slope for CRH 0.5
    const int intervals = 2000;
    for (int i = 0; i <= intervals; ++i) {
      const double t = static_cast<double>(i) / intervals, r = ogive::ogive_radius_at(radius, head, nose * t * t);
      integral += (i == 0 || i == intervals ? 1.0 : i % 2 ? 4.0 : 2.0) * pi * r * r * 2.0 * nose * t;
    }
    integral /= 3.0 * intervals;
    const double volume = exact_volume(make(SolidShape::OgiveRod, {radius, nose * 1.0000001, head}, {}));
    EXPECT_NEAR(volume / (integral + pi * radius * radius * nose * 0.0000001), 1.0, 1e-9) << head;
  }
}

TEST(Solids, TheOgivesProfileRunsFromTheTipToTheShankWithoutAKink) {
  const double radius = 6.45, head = 3.0, nose = ogive::ogive_nose_length(radius, head);
  EXPECT_DOUBLE_EQ(nose, std::sqrt(38.7 * 38.7 - 32.25 * 32.25));
  EXPECT_EQ(ogive::ogive_radius_at(radius, head, -1.0), 0.0);
  EXPECT_NEAR(ogive::ogive_radius_at(radius, head, 1e-13), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(ogive::ogive_radius_at(radius, head, nose), radius);
  EXPECT_EQ(ogive::ogive_radius_at(radius, head, nose + 1.0), radius);
  EXPECT_NEAR(ogive::ogive_radius_at(radius, head, nose - 1e-3), radius, 1e-7) << "the slope is zero at the shank";
  EXPECT_NEAR(ogive::ogive_radius_at(radius, head, nose - 10.0), std::sqrt(38.7 * 38.7 - 100.0) - 32.25, 1e-12);
}

TEST(Solids, TheCentreOfMassIsWhereTheSolidsCentreIs) {
  for (SolidDef solid : all_solids()) {
    if (solid.shape == SolidShape::OgiveRod) continue;
    solid.centre = {1.5, -2.0, 7.0};
    const Vector centre = centre_of_mass(fill_solid(solid));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(centre[i], solid.centre[i], 1e-13) << static_cast<int>(solid.shape);
  }
}

TEST(Solids, TheOgiveRodPointsUpFromItsBodyWithTheTipAtTheOrigin) {
  const ParticleCloud cloud = fill_solid(rod());
  double highest = -infinity, lowest = infinity;
  for (std::size_t p = 0; p < cloud.volume.size(); ++p) {
    highest = std::max(highest, cloud.xyz[3 * p + 2]);
    lowest = std::min(lowest, cloud.xyz[3 * p + 2]);
  }
  EXPECT_LT(highest, 0.0);
  EXPECT_GT(highest, -1.5) << "as far up as a particle fits into the tip";
  EXPECT_DOUBLE_EQ(lowest, -88.75);
  const Vector centre = centre_of_mass(cloud);
  EXPECT_NEAR(centre[0], 0.0, 1e-14);
  EXPECT_NEAR(centre[1], 0.0, 1e-14);
  // Integral of z over the exact rod by Simpson's rule.
  const int intervals = 20000;
  double moment = 0.0;
  for (int i = 0; i <= intervals; ++i) {
    const double d = 88.9 * i / intervals, r = ogive::ogive_radius_at(6.45, 3.0, d);
    moment += (i == 0 || i == intervals ? 1.0 : i % 2 ? 4.0 : 2.0) * -d * pi * r * r;
  }
  moment *= 88.9 / 3.0 / intervals;
  EXPECT_NEAR(centre[2] / (moment / exact_volume(rod())), 1.0, 3e-3);  // 2.0e-3: the staircase surface
}

TEST(Solids, EveryParticleHasItsMirrorImageToTheLastBit) {
  for (const SolidDef& solid : all_solids()) {
    const ParticleCloud cloud = fill_solid(solid);
    const std::vector<Vector> positions = sorted_positions(cloud);
    EXPECT_EQ(positions, sorted_positions(cloud, {-1.0, 1.0, 1.0})) << static_cast<int>(solid.shape);
    EXPECT_EQ(positions, sorted_positions(cloud, {1.0, -1.0, 1.0})) << static_cast<int>(solid.shape);
    if (solid.shape == SolidShape::OgiveRod) continue;
    EXPECT_EQ(positions, sorted_positions(cloud, {1.0, 1.0, -1.0})) << static_cast<int>(solid.shape);
  }
}

TEST(Solids, NoParticleLiesOnASymmetryPlaneAcrossTheAxis) {
  for (const SolidDef& solid : all_solids()) {
    if (solid.shape == SolidShape::Box) continue;  // an odd number along an edge puts one there
    const ParticleCloud cloud = fill_solid(solid);
    for (std::size_t p = 0; p < cloud.volume.size(); ++p) {
      ASSERT_NE(cloud.xyz[3 * p], 0.0);
      ASSERT_NE(cloud.xyz[3 * p + 1], 0.0);
    }
  }
}

TEST(Solids, SecondMomentsAreNearThoseOfTheExactSolid) {
  const auto ratio = [](const SolidDef& solid, int i, double exact) {
    return second_moment(fill_solid(solid), i) / exact;
  };
  // n particles of a length have 1 - 1/n^2 of its second moment.
  EXPECT_NEAR(ratio(box(), 0, 9.0 * 9.0 / 12.0), 1.0 - 1.0 / 900.0, 1e-12);
  EXPECT_NEAR(ratio(polar_ring(), 2, exact_volume(polar_ring()) * 12.0), 1.0 - 1.0 / 144.0, 1e-12);
  // A sector at the mean radius: r^2 for the mean (r_out^2 + r_in^2) / 2 = r^2 + dr^2 / 4.
  const double ring_moment = pi / 4.0 * (std::pow(40.0, 4) - std::pow(30.0, 4)) * 12.0;
  EXPECT_NEAR(ratio(polar_ring(), 0, ring_moment), 1.0 - 0.25 / 1250.0, 1e-12);
  EXPECT_NEAR(ratio(polar_ring(), 1, ring_moment), 1.0 - 0.25 / 1250.0, 1e-12);
  EXPECT_NEAR(ratio(polar_cylinder(), 0, pi / 4.0 * 625.0 * 4.0), 1.0 - 0.25 * 0.0625 / 12.5, 1e-12);
  // Cartesian lattices: what the staircase surface leaves. Behind each tolerance: measured.
  EXPECT_NEAR(ratio(cylinder(), 0, pi / 4.0 * 625.0 * 4.0), 1.0, 7e-3);                              // 5.8e-3
  EXPECT_NEAR(ratio(cylinder(), 1, pi / 4.0 * 625.0 * 4.0), 1.0, 7e-3);                              // 5.8e-3
  EXPECT_NEAR(ratio(ring(), 0, pi / 4.0 * (625.0 - 81.0) * 4.0), 1.0, 1e-3);                         // 6.1e-4
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(ratio(sphere(), i, pi * 4.0 / 15.0 * 3125.0), 1.0, 1e-3);  // 8.5e-4
}

// --------------------------------------------------------------------------------------------------------------
// directions

// The direction of each of the solid's own axes, read off three thin boxes' farthest particles.
std::array<Vector, 3> directions(const Vector& axis, const Vector& reference) {
  std::array<Vector, 3> result;
  for (int i = 0; i < 3; ++i) {
    Vector size = {1.0, 1.0, 1.0};
    size[i] = 4.0;
    SolidDef solid = make(SolidShape::Box, size, {1.0, 1.0, 1.0});
    solid.axis = axis;
    solid.reference = reference;
    const ParticleCloud cloud = fill_solid(solid);
    EXPECT_EQ(cloud.volume.size(), 4u);
    for (int j = 0; j < 3; ++j) result[i][j] = cloud.xyz[3 * 3 + j] / 1.5;
  }
  return result;
}

void expect_vector(const Vector& actual, const Vector& expected) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], 1e-15) << "component " << i;
}

TEST(Solids, WithoutAReferenceTheAxesAreTurnedAsLittleAsPossible) {
  std::array<Vector, 3> axes = directions({0.0, 0.0, 2.0}, {});
  EXPECT_EQ(axes, (std::array<Vector, 3>{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}})) << "+z: no turn";
  axes = directions({0.0, 0.0, -3.0}, {});
  expect_vector(axes[0], {-1.0, 0.0, 0.0});
  expect_vector(axes[1], {0.0, 1.0, 0.0});
  expect_vector(axes[2], {0.0, 0.0, -1.0});
  axes = directions({1.0, 0.0, 0.0}, {});
  expect_vector(axes[0], {0.0, 0.0, -1.0});
  expect_vector(axes[1], {0.0, 1.0, 0.0});
  expect_vector(axes[2], {1.0, 0.0, 0.0});
  axes = directions({std::sin(pi / 6.0), 0.0, std::cos(pi / 6.0)}, {});
  expect_vector(axes[0], {std::cos(pi / 6.0), 0.0, -std::sin(pi / 6.0)});
  expect_vector(axes[1], {0.0, 1.0, 0.0});
  expect_vector(axes[2], {std::sin(pi / 6.0), 0.0, std::cos(pi / 6.0)});
}

TEST(Solids, TheReferencesPartNormalToTheAxisIsTheSolidsXAxis) {
  std::array<Vector, 3> axes = directions({0.0, 0.0, 1.0}, {0.0, 5.0, 3.0});
  expect_vector(axes[0], {0.0, 1.0, 0.0});
  expect_vector(axes[1], {-1.0, 0.0, 0.0});
  expect_vector(axes[2], {0.0, 0.0, 1.0});
  axes = directions({0.0, 1.0, 0.0}, {1.0, 0.0, 0.0});
  expect_vector(axes[0], {1.0, 0.0, 0.0});
  expect_vector(axes[1], {0.0, 0.0, -1.0});
  expect_vector(axes[2], {0.0, 1.0, 0.0});
}

TEST(Solids, TheAxesAreOrthonormalAndRightHandedForAnyDirection) {
  const std::vector<Vector> some = {{1.0, 2.0, 3.0},    {-1.0, 0.5, -2.0},   {1e-9, 0.0, -1.0},   {1e-9, -1e-9, 1.0},
                                    {1e-200, 0.0, 1.0}, {1e200, 1e200, 0.0}, {1e-8, 1e-8, -1e-8}, {0.0, -1.0, -1e-12}};
  for (const Vector& axis : some) {
    for (const Vector& reference : {Vector{}, Vector{0.3, -0.7, 0.1}}) {
      const std::array<Vector, 3> axes = directions(axis, reference);
      const auto dot = [&](int i, int j) {
        return axes[i][0] * axes[j][0] + axes[i][1] * axes[j][1] + axes[i][2] * axes[j][2];
      };
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(dot(i, j), i == j ? 1.0 : 0.0, 2e-15);
      }
      const double determinant = axes[0][0] * (axes[1][1] * axes[2][2] - axes[1][2] * axes[2][1]) -
                                 axes[0][1] * (axes[1][0] * axes[2][2] - axes[1][2] * axes[2][0]) +
                                 axes[0][2] * (axes[1][0] * axes[2][1] - axes[1][1] * axes[2][0]);
      EXPECT_NEAR(determinant, 1.0, 2e-15);
    }
  }
}

TEST(Solids, ATurnedSolidKeepsItsParticlesDistancesAndVolumes) {
  for (SolidDef solid : all_solids()) {
    const ParticleCloud straight = fill_solid(solid);
    solid.axis = {1.0, -2.0, -0.5};
    solid.centre = {3.0, 4.0, 5.0};
    const ParticleCloud turned = fill_solid(solid);
    ASSERT_EQ(turned.volume, straight.volume);
    const double length = std::sqrt(5.25);
    for (std::size_t p = 0; p < turned.volume.size(); ++p) {
      double along = 0.0, square = 0.0, straight_square = 0.0;
      for (int i = 0; i < 3; ++i) {
        const double difference = turned.xyz[3 * p + i] - solid.centre[i];
        along += difference * solid.axis[i] / length;
        square += difference * difference;
        straight_square += straight.xyz[3 * p + i] * straight.xyz[3 * p + i];
      }
      ASSERT_NEAR(along, straight.xyz[3 * p + 2], 2e-13);
      ASSERT_NEAR(std::sqrt(square), std::sqrt(straight_square), 2e-13);
    }
  }
}

// ----------------------------------------------------------------------------------------------------------------
// refusals

TEST(Solids, AWrongSizeIsRefusedWithFieldExpectationAndValue) {
  SolidDef solid = box();
  solid.size[0] = -3.0;
  expect_refused(solid, "solid.size[0]: must be > 0, got -3");
  solid.size = {1.0, 0.0, 1.0};
  expect_refused(solid, "solid.size[1]: must be > 0, got 0");
  solid.size = {1.0, 1.0, infinity};
  expect_refused(solid, "solid.size[2]: must be > 0 and finite, got inf");
  solid = cylinder();
  solid.size[0] = std::nan("");
  expect_refused(solid, "solid.size[0]: must be > 0, got nan");
  solid = cylinder();
  solid.size[1] = 0.0;
  expect_refused(solid, "solid.size[1]: must be > 0, got 0");
  solid = ring();
  solid.size[2] = 5.0;
  expect_refused(solid, "solid.size[2]: must be >= 0 and < size[0] = 5, got 5");
  solid.size[2] = -1.0;
  expect_refused(solid, "solid.size[2]: must be >= 0 and < size[0] = 5, got -1");
  solid = box();
  solid.size = solid.spacing = {1e200, 1e200, 1.0};
  expect_refused(solid, "solid.size: must give a volume that a double holds, got (1e+200, 1e+200, 1)");
  solid = sphere();
  solid.size[0] = 0.0;
  expect_refused(solid, "solid.size[0]: must be > 0, got 0");
  solid = rod();
  solid.size[2] = 0.4;
  expect_refused(solid, "solid.size[2]: must be >= 0.5, got 0.4");
  solid = rod();
  solid.size[1] = 10.0;
  expect_refused(solid, "solid.size[1]: must be >= the nose length 21.3922298978, got 10");
}

TEST(Solids, AnUnknownShapeOrLatticeIsRefused) {
  SolidDef solid = box();
  solid.shape = static_cast<SolidShape>(7);
  expect_refused(solid, "solid.solid: must be 0 (box), 1 (cylinder), 2 (sphere) or 3 (ogive rod), got 7");
  EXPECT_THROW(exact_volume(solid), ogive::Error);
  solid = box();
  solid.lattice = static_cast<Lattice>(2);
  expect_refused(solid, "solid.lattice: must be 0 (Cartesian) or 1 (polar), got 2");
  for (SolidDef other : {box(), sphere(), rod()}) {
    other.lattice = Lattice::Polar;
    expect_refused(other, "solid.lattice: must be 0 (Cartesian) for a solid that is not a cylinder, got 1 (polar)");
  }
}

TEST(Solids, WrongDirectionsAndPlacesAreRefused) {
  SolidDef solid = box();
  solid.axis = {0.0, 0.0, 0.0};
  expect_refused(solid, "solid.axis: must not be zero, got (0, 0, 0)");
  solid.axis = {0.0, infinity, 0.0};
  expect_refused(solid, "solid.axis[1]: must be finite, got inf");
  solid = box();
  solid.axis = {1.0, 2.0, 2.0};
  solid.reference = {-0.5, -1.0, -1.0};
  expect_refused(solid, "solid.reference: must not be parallel to axis, got (-0.5, -1, -1)");
  solid.reference = {0.0, 0.0, -infinity};
  expect_refused(solid, "solid.reference[2]: must be finite, got -inf");
  solid = box();
  solid.centre[0] = infinity;
  expect_refused(solid, "solid.centre[0]: must be finite, got inf");
}

TEST(Solids, AWrongSpacingIsRefused) {
  SolidDef solid = box();
  solid.spacing[1] = 0.0;
  expect_refused(solid, "solid.spacing[1]: must be > 0, got 0");
  solid = sphere();
  solid.spacing = {20.0, 20.0, 20.0};
  expect_refused(solid, "solid.spacing: must leave at least one particle centre inside the solid, got (20, 20, 20)");
}

TEST(Solids, MoreParticlesThanAnIndexHoldsAreRefusedAtOnce) {
  const std::string message = "solid.spacing: must give at most 2147483648 particles, got more: use a larger spacing";
  for (const double factor : {1e-3, 1e-6, 1e-100, 1e-307}) {
    for (SolidDef solid : all_solids()) {
      for (double& spacing : solid.spacing) spacing *= factor;
      expect_refused(solid, message);
    }
  }
  SolidDef solid = make(SolidShape::Box, {2.0, 1.0, 1.0}, {1e-300, 1.0, 1.0});
  expect_refused(solid, message);
  solid = make(SolidShape::Cylinder, {1.0, 1.0, 0.0}, {0.25, 0.25, 1e-9});
  expect_refused(solid, message);
}

}  // namespace
