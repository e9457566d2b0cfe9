// The size of a particle in the GIMP shape function.
#pragma once

namespace ogive {

// Half its width in cells: that of two particles a cell along each axis (docs/decisions.md says why it is not each body's).
constexpr double gimp_half_width = 0.25;

}  // namespace ogive
