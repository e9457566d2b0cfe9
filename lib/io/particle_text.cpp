// Particles as text: lines of x,y,z,volume.
#include "particle_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "failure.hpp"

namespace ogive::io {
namespace {

// True where the line is four numbers and nothing else.
bool read_numbers(const std::string& line, std::array<double, 4>& numbers) {
  const char* at = line.data();
  const char* const end = at + line.size();
  const auto skip_blanks = [&] {
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
  };
  for (std::size_t i = 0; i < 4; ++i) {
    skip_blanks();
    if (i > 0) {
      if (at == end || *at != ',') return false;
      ++at;
      skip_blanks();
    }
    const auto result = std::from_chars(at, end, numbers[i]);
    if (result.ec != std::errc()) return false;
    at = result.ptr;
  }
  skip_blanks();
  return at == end;
}

std::string shortest(double number) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, number).ptr);
}

}  // namespace

ParticleList read_particle_text(const std::string& path) {
  std::error_code ignored;
  // A device or pipe could give lines without end.
  const bool regular = std::filesystem::is_regular_file(path, ignored);
  std::ifstream stream(path);
  if (!stream || !regular) throw Failure(Fault::file, "cannot be read; expected a CSV file of x,y,z,volume");
  ParticleList particles;
  std::string line;
  bool heading_possible = true;
  for (std::int64_t number = 1; std::getline(stream, line); ++number) {
    if (line.empty() || line[0] == '#' || line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto refuse = [&](const std::string& problem) {
      throw Failure(Fault::format, ':' + std::to_string(number) + ": " + problem);
    };
    std::array<double, 4> values{};
    if (!read_numbers(line, values)) {
      const bool heading = heading_possible && line.find_first_of("0123456789") == std::string::npos;
      if (!heading) refuse("expected four numbers x,y,z,volume, got \"" + line.substr(0, 60) + '"');
      heading_possible = false;
      continue;
    }
    heading_possible = false;
    for (const double value : values)
      if (!std::isfinite(value)) refuse("must be finite, got " + shortest(value));
    if (!(values[3] > 0)) refuse("volume must be > 0, got " + shortest(values[3]));
    particles.positions.insert(particles.positions.end(), values.begin(), values.begin() + 3);
    particles.volumes.push_back(values[3]);
  }
  if (particles.volumes.empty()) throw Failure(Fault::format, ": holds no particles");
  return particles;
}

}  // namespace ogive::io
