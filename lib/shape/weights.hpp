// Shape functions N(x) of a particle on the tile around its block, one axis at a time; the 3D function is the product.
//
// xi is the particle's coordinate along the axis in cells, counted from the tile's first node. `at` gives the first node
// that the particle touches, the weights w = N and the derivatives d = dN/dxi there.
// Linear: N = 1 - |x| (Huang et al. 2010, the eight-node grid of section 4). Quadratic B-spline: Steffen, Kirby, Berzins
// 2008. GIMP (Bardenhagen, Kober 2004) with particles of constant size: the linear function averaged over a particle of
// half-width l along each axis. All are continuous, so it does not matter to which side a particle exactly on a boundary is
// rounded.
// A linear weight may vanish where its derivative does not: a particle in a plane of nodes would push a node that it gives
// no mass to. Weights are kept at or above `least_weight`, as if the particle were that part of a cell off the plane, so
// that every node with a force has the mass to take it and momentum is whole.
#pragma once

#include "shape/gimp.hpp"
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

// With f from the nearest node, |f| <= 1/2, the outer weights are
//   f <= -l: w_0 = -f,    |f| <= l: w_0 = (l - f)^2 / (4 l),    f >= l: w_0 = 0,
// w_2 the same of -f. l = 1/2 gives the quadratic B-spline, l = 0 the linear function.
// A weight and its derivative vanish together, so that these weights need no least value.
struct GimpShape {
  static constexpr int nodes = 3;
  static constexpr double half_width = gimp_half_width;  // cells

  template <class V>
  OGIVE_INLINE void at(V xi, V& first, V (&w)[3], V (&d)[3]) {
    const V nearest = round(xi);
    first = nearest - 1.0;
    const V f = xi - nearest;
    const V within = min(max(f, broadcast<V>(-half_width)), broadcast<V>(half_width));
    const V beyond = f - within;
    const V below = half_width - within, above = half_width + within;
    w[0] = below * below * (0.25 / half_width) + max(-beyond, broadcast<V>(0.0));
    w[2] = above * above * (0.25 / half_width) + max(beyond, broadcast<V>(0.0));
    w[1] = 1.0 - (w[0] + w[2]);
    d[0] = below * (-0.5 / half_width);
    d[1] = within * (-1.0 / half_width);
    d[2] = above * (0.5 / half_width);
  }
};

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
