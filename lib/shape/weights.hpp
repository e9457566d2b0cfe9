// Shape functions N(x) of a particle on the tile around its block, one axis at a time; the 3D function is the product.
//
// xi is the particle's coordinate along the axis in cells, counted from the tile's first node. `at` gives the first node
// that the particle touches, the weights w = N and the derivatives d = dN/dxi there.
// Linear: N = 1 - |x| (Huang et al. 2010, the eight-node grid of section 4). Quadratic B-spline: Steffen, Kirby, Berzins
// 2008. Both are continuous, so it does not matter to which side a particle exactly on a boundary is rounded.
// A linear weight may vanish where its derivative does not: a particle in a plane of nodes would push a node that it gives
// no mass to. Weights are kept at or above `least_weight`, as if the particle were that part of a cell off the plane, so
// that every node with a force has the mass to take it and momentum is whole.
#pragma once

#include "simd/lanes.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

struct LinearShape {
  static constexpr int nodes = 2;
  static constexpr double least_weight = 1e-9;

  template <class V>
  OGIVE_INLINE void at(V xi, V& first, V (&w)[2], V (&d)[2]) {
    first = round(xi - 0.5);
    const V f = min(max(xi - first, broadcast<V>(least_weight)), broadcast<V>(1.0 - least_weight));
    w[0] = 1.0 - f;
    w[1] = f;
    d[0] = broadcast<V>(-1.0);
    d[1] = broadcast<V>(1.0);
  }
};

struct QuadraticBSplineShape {
  static constexpr int nodes = 3;

  template <class V>
  OGIVE_INLINE void at(V xi, V& first, V (&w)[3], V (&d)[3]) {
    const V nearest = round(xi);
    first = nearest - 1.0;
    const V f = xi - nearest;  // -1/2 .. 1/2
    const V below = 0.5 - f, above = 0.5 + f;
    w[0] = 0.5 * below * below;
    w[1] = 0.75 - f * f;
    w[2] = 0.5 * above * above;
    d[0] = -below;
    d[1] = -2.0 * f;
    d[2] = above;
  }
};

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
