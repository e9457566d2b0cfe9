// Particles as text: lines of x,y,z,volume.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace driver {

struct ParticleList {
  std::vector<double> positions;  // x, y, z of each in turn
  std::vector<double> volumes;
};

/// Heading and one line per particle, every digit kept; written whole or not at all.
void write_particle_csv(const std::filesystem::path& file, const ParticleList& particles);

}  // namespace driver
