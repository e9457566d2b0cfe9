// Particle files: whatever the text, it is read or refused with the line; what is read has finite places and volumes > 0.
#include <cmath>

#include "failure.hpp"
#include "input.hpp"
#include "memory_file.hpp"
#include "particle_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  try {
    const ogive::io::ParticleList particles = ogive::io::read_particle_text(file.path());
    fuzz::require(!particles.volumes.empty() && particles.positions.size() == 3 * particles.volumes.size(),
                  "places and volumes are not of one number");
    for (const double x : particles.positions) fuzz::require(std::isfinite(x), "a place is not finite");
    for (const double v : particles.volumes) fuzz::require(v > 0 && std::isfinite(v), "a volume is not > 0");
    ++fuzz::accepted;
  } catch (const ogive::io::Failure&) {
  }
  return 0;
}
