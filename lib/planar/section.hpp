// Sections of built-in solids with the plane z = 0, filled with the particles of a two-dimensional model.
#pragma once

#include "model.hpp"
#include "solids.hpp"

namespace ogive {

// Throws Error(Argument) naming the field where the solid has no such section, or does not fit the axis of revolution.
ParticleCloud fill_section(const Grid& grid, const SolidDef& solid);

}  // namespace ogive
