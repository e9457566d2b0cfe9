// Particles as text: lines of x,y,z,volume.
#pragma once

#include <string>
#include <vector>

namespace ogive::io {

struct ParticleList {
  std::vector<double> positions;  // x, y, z of each in turn
  std::vector<double> volumes;
};

// Reads lines of four numbers; blank lines, lines that begin with # and one heading line before the first numbers are
// skipped. Throws Failure; where it is a line's fault, the message begins with ":NUMBER: ".
ParticleList read_particle_text(const std::string& path);

}  // namespace ogive::io
