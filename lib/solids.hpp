// Built-in solids filled with particles: box, cylinder or ring, sphere, ogive-nosed rod.
//
// A solid is laid out in its own axes, z its axis of revolution, then turned and moved:
//   x_world = centre + x x' + y y' + z z',  z' = axis / |axis|
// Sizes, lattices and defaults are those of ogive_solid_def in capi/ogive.h.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace ogive {

// The same numbers as OGIVE_SOLID_* and OGIVE_LATTICE_*.
enum class SolidShape : std::int32_t { Box = 0, Cylinder = 1, Sphere = 2, OgiveRod = 3 };
enum class Lattice : std::int32_t { Cartesian = 0, Polar = 1 };

struct SolidDef {
  SolidShape shape = SolidShape::Box;
  Lattice lattice = Lattice::Cartesian;
  // Box: three edges. Cylinder: outer radius, length, inner radius (0: solid). Sphere: radius.
  // Ogive rod: radius, overall length, ogive radius / diameter.
  std::array<double, 3> size{};
  std::array<double, 3> centre{};  // of the solid's axes: the tip of an ogive rod, else the centre
  std::array<double, 3> axis{0.0, 0.0, 1.0};
  std::array<double, 3> reference{};  // zero: chosen (no turn where axis is +z, else the least turn)
  std::array<double, 3> spacing{};    // Cartesian: along x, y, z; polar: radial, along the circumference, axial
};

struct ParticleCloud {
  std::vector<double> xyz;     // three for each particle
  std::vector<double> volume;  // sums to exact_volume
};

// More particles than this are refused before memory is asked for.
constexpr std::int64_t max_solid_particles = std::int64_t{1} << 31;

// These throw Error (Argument; Memory where there is no room) naming the field, its value and what is expected.
ParticleCloud fill_solid(const SolidDef& solid);
double exact_volume(const SolidDef& solid);

// Checks the solid and gives its axes x', y', z'.
std::array<std::array<double, 3>, 3> solid_axes(const SolidDef& solid);

// Tangent ogive of shank radius R and caliber-radius-head c: arc of radius rho = 2 c R that meets the shank without a
// kink; nose length L = sqrt(rho^2 - (rho - R)^2) = R sqrt(4 c - 1).
double ogive_nose_length(double radius, double caliber_radius_head);
// Radius at a distance d from the tip: sqrt(rho^2 - (L - d)^2) - (rho - R) on the nose, R behind it, 0 for d <= 0.
double ogive_radius_at(double radius, double caliber_radius_head, double distance);

}  // namespace ogive
