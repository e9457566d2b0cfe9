// Shape functions against their definition: partition of unity, position, second moment, derivatives, and what a flat
// surface fills of a node.
#include "shape/weights.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/contact.hpp"

namespace {

using namespace ogive;
using namespace ogive::OGIVE_ISA_NAMESPACE;
using V = Vec<4>;

// Sums over the nodes of a particle at xi, in cells.
struct Sums {
  double weight = 0, position = 0, second_moment = 0, derivative = 0, derivative_position = 0, least = 1;
};

template <class Shape>
Sums sums_at(double xi) {
  V first, w[Shape::nodes], d[Shape::nodes];
  Shape::at(broadcast<V>(xi), first, w, d);
  Sums s;
  for (int n = 0; n < Shape::nodes; ++n) {
    const double node = first[0] + n;
    s.weight += w[n][0];
    s.position += w[n][0] * node;
    s.second_moment += w[n][0] * (node - xi) * (node - xi);
    s.derivative += d[n][0];
    s.derivative_position += d[n][0] * node;
    s.least = std::fmin(s.least, w[n][0]);
  }
  return s;
}

template <class Shape>
class Weights : public testing::Test {};
using Shapes = testing::Types<LinearShape, QuadraticBSplineShape, GimpShape>;
TYPED_TEST_SUITE(Weights, Shapes);

constexpr double places[] = {1.0, 1.0 + 1e-12, 1.2, 1.5 - 1e-12, 1.5, 1.7, 2.0 - 1e-12, 2.0, 3.999, 4.5};

TYPED_TEST(Weights, ReproduceConstantAndLinearFields) {
  for (const double xi : places) {
    const Sums s = sums_at<TypeParam>(xi);
    EXPECT_NEAR(s.weight, 1, 1e-15) << xi;
    // Linear weights are kept off the nodes by 1e-9.
    EXPECT_NEAR(s.position, xi, 1.1e-9) << xi;
    EXPECT_NEAR(s.derivative, 0, 1e-15) << xi;
    EXPECT_NEAR(s.derivative_position, 1, 1e-14) << xi;
    EXPECT_GE(s.least, 0) << xi;
  }
}

TYPED_TEST(Weights, AreContinuousAcrossNodesAndCells) {
  for (const double xi : {1.0, 1.5, 2.0}) {
    V first_below, first_above, below[TypeParam::nodes], above[TypeParam::nodes], d[TypeParam::nodes];
    TypeParam::at(broadcast<V>(xi - 1e-13), first_below, below, d);
    TypeParam::at(broadcast<V>(xi + 1e-13), first_above, above, d);
    for (int node = 0; node < 5; ++node) {
      const int a = node - static_cast<int>(first_below[0]), b = node - static_cast<int>(first_above[0]);
      const double w_below = a >= 0 && a < TypeParam::nodes ? below[a][0] : 0;
      const double w_above = b >= 0 && b < TypeParam::nodes ? above[b][0] : 0;
      EXPECT_NEAR(w_below, w_above, 3e-9) << xi << " node " << node;
    }
  }
}

TYPED_TEST(Weights, DerivativesAreThoseOfTheWeights) {
  constexpr int N = TypeParam::nodes;
  const double step = 1e-6;
  for (const double xi : {1.1, 1.3, 1.45, 1.8}) {
    V first, w0[N], w1[N], d0[N], d1[N], d[N], w[N];
    TypeParam::at(broadcast<V>(xi - step), first, w0, d0);
    TypeParam::at(broadcast<V>(xi + step), first, w1, d1);
    TypeParam::at(broadcast<V>(xi), first, w, d);
    for (int n = 0; n < N; ++n) EXPECT_NEAR(d[n][0], (w1[n][0] - w0[n][0]) / (2 * step), 1e-9) << xi;
  }
}

// The linear function of distance x averaged over the particle, by the midpoint rule: exact but where a kink is inside.
TEST(Weights, OfGimpAreTheLinearFunctionAveragedOverTheParticle) {
  const int parts = 20000;
  for (const double xi : places) {
    V first, w[3], d[3];
    GimpShape::at(broadcast<V>(xi), first, w, d);
    for (int n = 0; n < 3; ++n) {
      double mean = 0;
      for (int i = 0; i < parts; ++i) {
        const double x = first[0] + n - xi + gimp_half_width * (2 * (i + 0.5) / parts - 1);
        mean += std::fmax(0, 1 - std::abs(x)) / parts;
      }
      EXPECT_NEAR(w[n][0], mean, 1e-9) << xi << " node " << n;
    }
  }
}

// No node is pushed that gets no mass: weight and derivative vanish together.
TEST(Weights, OfGimpVanishWithTheirDerivatives) {
  for (double xi = 1; xi < 2; xi += 1.0 / 64) {
    V first, w[3], d[3];
    GimpShape::at(broadcast<V>(xi), first, w, d);
    for (const int n : {0, 2}) {
      EXPECT_EQ(w[n][0] == 0, d[n][0] == 0) << xi << " node " << n;
    }
  }
}

// What affine velocities are scaled with: h^2/4 everywhere for the B-spline, xi (1 - xi) for the hat.
TEST(Weights, SecondMomentsAreThoseThatAffineVelocitiesAssume) {
  for (const double xi : places) EXPECT_NEAR(sums_at<QuadraticBSplineShape>(xi).second_moment, 0.25, 1e-14) << xi;
  for (const double xi : {1.2, 1.5, 1.7})
    EXPECT_NEAR(sums_at<LinearShape>(xi).second_moment, (xi - 1) * (2 - xi), 1e-14) << xi;
  // GIMP: the hat's, but l / 2 and not 0 at a node; never above 1/4.
  EXPECT_NEAR(sums_at<GimpShape>(2.0).second_moment, 0.5 * gimp_half_width, 1e-14);
  for (const double xi : {1.25, 1.3, 1.5, 1.7})
    EXPECT_NEAR(sums_at<GimpShape>(xi).second_moment, (xi - 1) * (2 - xi), 1e-14) << xi;
  for (const double xi : places) EXPECT_LE(sums_at<GimpShape>(xi).second_moment, 0.25 + 1e-14) << xi;
}

// Integral of the node's shape function beyond a flat surface at distance s, by the midpoint rule.
double filled(ShapeFunction shape, double s) {
  double sum = 0;
  const int parts = 200000;
  const double reach = 1.5, width = (reach - s) / parts;
  for (int i = 0; i < parts; ++i) {
    const double x = std::abs(s + (i + 0.5) * width);
    double value = 0;
    constexpr double l = gimp_half_width;
    if (shape == ShapeFunction::Linear) value = x < 1 ? 1 - x : 0;
    else if (shape == ShapeFunction::Gimp)
      value = x < l ? 1 - (x * x + l * l) / (2 * l)
                    : (x < 1 - l ? 1 - x : (x < 1 + l ? (1 + l - x) * (1 + l - x) / (4 * l) : 0));
    else value = x < 0.5 ? 0.75 - x * x : (x < 1.5 ? 0.5 * (1.5 - x) * (1.5 - x) : 0);
    sum += value * width;
  }
  return sum;
}

TEST(SurfaceDistance, InvertsTheFillOfANodeByAFlatSurface) {
  for (const ShapeFunction shape : {ShapeFunction::Linear, ShapeFunction::QuadraticBSpline, ShapeFunction::Gimp})
    for (const double s : {-0.9, -0.5, -0.3, 0.0, 0.2, 0.5, 0.8, 0.95})
      EXPECT_NEAR(surface_distance(shape, filled(shape, s)), s, 1e-6) << static_cast<int>(shape);
}

TEST(SurfaceDistance, OfTwoSurfacesThatTouchSumsToZero) {
  for (const ShapeFunction shape : {ShapeFunction::Linear, ShapeFunction::QuadraticBSpline, ShapeFunction::Gimp})
    for (const double fill : {0.01, 0.1, 0.3, 0.5, 0.77, 0.95})
      EXPECT_NEAR(surface_distance(shape, fill) + surface_distance(shape, 1 - fill), 0, 1e-14);
}

}  // namespace
