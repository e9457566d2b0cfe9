#include "shape/scalar_weights.hpp"

#define OGIVE_ISA_NAMESPACE scalar
#include "shape/weights.hpp"

namespace ogive {
namespace {

template <class Shape>
void fill(ScalarWeights& s, double inverse_cell, const Vector3& corner, const double* x) {
  using Lanes = scalar::Vec<4>;  // one an axis; the fourth is idle
  s.nodes = Shape::nodes;
  Lanes xi{}, base, weight[Shape::nodes], slope[Shape::nodes];
  for (int axis = 0; axis < 3; ++axis) xi[axis] = (x[axis] - corner[axis]) * inverse_cell;
  Shape::at(xi, base, weight, slope);
  for (int axis = 0; axis < 3; ++axis) {
    s.first[axis] = static_cast<int>(base[axis]);
    for (int n = 0; n < Shape::nodes; ++n) {
      s.w[axis][n] = weight[n][axis];
      s.d[axis][n] = slope[n][axis];
    }
  }
}

}  // namespace

ScalarWeights::ScalarWeights(const Model& model, const Vector3& corner, const double* x) {
  const double inverse_cell = 1.0 / model.grid.cell_size;
  if (model.numerics.shape_function == ShapeFunction::Linear)
    fill<scalar::LinearShape>(*this, inverse_cell, corner, x);
  else
    fill<scalar::QuadraticBSplineShape>(*this, inverse_cell, corner, x);
}

}  // namespace ogive
