// Shape functions of two-dimensional models: the product of two in the plane z = 0. Along z there is one layer of
// nodes, of weight 1 and without slope (docs/theory.md, section 12).
#pragma once

#include "shape/weights.hpp"

namespace ogive {
namespace OGIVE_ISA_NAMESPACE {

template <class Shape>
struct Planar : Shape {};

// Layers of nodes along z that a particle meets.
template <class Shape>
constexpr int layers_of = Shape::nodes;
template <class Shape>
constexpr int layers_of<Planar<Shape>> = 1;

template <class Shape>
constexpr bool is_planar = layers_of<Shape> == 1;

}  // namespace OGIVE_ISA_NAMESPACE
}  // namespace ogive
