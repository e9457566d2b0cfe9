#include "shape/scalar_weights.hpp"

#define OGIVE_ISA_NAMESPACE scalar
#include "shape/planar.hpp"
#include "shape/weights.hpp"

namespace ogive {
namespace {

template <class Shape>
void fill(ScalarWeights& s, double inverse_cell, const Vector3& corner, const double* x) {
  using Lanes = scalar::Vec<4>;  // one an axis; the fourth is idle
  s.nodes = Shape::nodes;
  s.layers = scalar::layers_of<Shape>;
  Lanes xi{}, base, weight[Shape::nodes], slope[Shape::nodes];
  for (int axis = 0; axis < 3; ++axis) scalar::set_lane(xi, axis, (x[axis] - corner[axis]) * inverse_cell);
  Shape::at(xi, base, weight, slope);
  if constexpr (scalar::is_planar<Shape>) {
    scalar::set_lane(base, 2, 1.0);
    scalar::set_lane(weight[0], 2, 1.0);
    scalar::set_lane(slope[0], 2, 0.0);
  }
  for (int axis = 0; axis < 3; ++axis) {
    s.first[axis] = static_cast<int>(base[axis]);
    s.from[axis] = scalar::is_planar<Shape> && axis == 2 ? 0 : base[axis] - xi[axis];
    for (int n = 0; n < Shape::nodes; ++n) {
      s.w[axis][n] = weight[n][axis];
      s.d[axis][n] = slope[n][axis];
    }
  }
}

}  // namespace

ScalarWeights::ScalarWeights(const Model& model, const Vector3& corner, const double* x) {
  const double inverse_cell = 1.0 / model.grid.cell_size;
  const auto fill_by = [&](auto shape) {
    using Shape = decltype(shape);
    if (model.grid.planar())
      fill<scalar::Planar<Shape>>(*this, inverse_cell, corner, x);
    else
      fill<Shape>(*this, inverse_cell, corner, x);
  };
  switch (model.numerics.shape_function) {
    case ShapeFunction::Linear: fill_by(scalar::LinearShape{}); break;
    case ShapeFunction::QuadraticBSpline: fill_by(scalar::QuadraticBSplineShape{}); break;
    case ShapeFunction::Gimp: fill_by(scalar::GimpShape{}); break;
  }
}

}  // namespace ogive
