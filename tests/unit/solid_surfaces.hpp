// Surfaces of built-in solids for tests.
#pragma once

#include <limits>

#include "solids.hpp"
#include "surface/surface.hpp"

namespace ogive {

inline const Vector3 everywhere = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::infinity()};
inline const Vector3 nowhere = times(-1, everywhere);

inline SurfaceDef solid(SurfaceKind kind, Vector3 size, Vector3 origin = {}, Vector3 axis = {0, 0, 1}) {
  SolidDef def;
  def.shape = static_cast<SolidShape>(kind);
  def.size = size;
  def.axis = axis;
  def.spacing = {1, 1, 1};
  SurfaceDef surface;
  surface.kind = kind;
  surface.size = size;
  surface.origin = origin;
  surface.axes = solid_axes(def);
  return surface;
}

}  // namespace ogive
