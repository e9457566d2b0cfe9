// Particles as text: lines of x,y,z,volume.
#include "particle_csv.hpp"

#include "files.hpp"
#include "text.hpp"

namespace driver {
void write_particle_csv(const std::filesystem::path& file, const ParticleList& particles) {
  std::string text = "x,y,z,volume\n";
  for (size_t i = 0; i < particles.volumes.size(); ++i) {
    for (size_t axis = 0; axis < 3; ++axis) text += exact(particles.positions[3 * i + axis]) + ',';
    text += exact(particles.volumes[i]) + '\n';
  }
  write_whole_file(file, text);
}

}  // namespace driver
