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

/// Reads lines of four numbers; blank lines, lines that begin with # and one heading line before the first numbers are
/// skipped. `place` begins every message. Throws Failure(kExitInput).
ParticleList read_particle_csv(const std::filesystem::path& file, const std::string& place);

/// Heading and one line per particle, every digit kept; written whole or not at all.
void write_particle_csv(const std::filesystem::path& file, const ParticleList& particles);

}  // namespace driver
