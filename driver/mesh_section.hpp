// The section of a closed surface with the plane z = 0, filled with the particles of a two-dimensional model.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "particle_csv.hpp"

namespace driver {

/// What a section stands for: rings about x = 0, or `thickness` along z.
struct SectionRule {
  bool axisymmetric = false;
  double thickness = 1;
};

/// Particles at origin + ((i + 1/2) spacing[0], (j + 1/2) spacing[1]) inside the section of a surface that is closed
/// and oriented, three vertices a triangle. `place` begins every message; throws Failure(kExitInput) where nothing is
/// inside.
ParticleList fill_mesh_section(const std::vector<double>& vertices, const std::vector<int32_t>& corners,
                               const std::array<double, 2>& origin, const std::array<double, 2>& spacing,
                               const SectionRule& rule, const std::string& place);

}  // namespace driver
