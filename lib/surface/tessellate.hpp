// Triangles of the built-in solids, for bodies that deform: their surface starts as the solid's and moves with the material.
#pragma once

#include "surface/surface.hpp"

namespace ogive {

// Vertices lie on the solid's surface, tip and edges among them, edges are not longer than about `size` (> 0); round parts have
// at least twelve sides. Symmetric, with
// its diagonals, about the planes through its centre and axis that its axes span. Closed and oriented as check_triangles asks.
// Throws Error(Argument) where that needs more than 2^29 vertices.
SurfaceDef tessellate(const SurfaceDef& solid, double size);

}  // namespace ogive
