// What the parts of the geometry library share: the triangle surface, the findings of its check, and refusals.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "ogive_geometry.h"

namespace ogive::geometry {

using Vec3 = std::array<double, 3>;
using Corners = std::array<int32_t, 3>;

// Coordinates up to here keep every product of three of them finite.
inline constexpr double kLargestCoordinate = 1e100;
// Corners are numbered by int32.
inline constexpr int64_t kMostFacets = 700'000'000;

// Thrown inside the library wherever a call must fail; the C interface turns it into a status and the mesh's message.
class Refusal : public std::exception {
 public:
  Refusal(ogive_status status, std::string message) : status_(status), message_(std::move(message)) {}
  ogive_status status() const { return status_; }
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  ogive_status status_;
  std::string message_;
};

// A triangle surface. Vertices have distinct coordinates and each is a corner of some facet.
struct Surface {
  std::vector<Vec3> vertices;
  std::vector<Corners> facets;
  std::vector<int32_t> number;  // of each facet in the file, for messages; repairs keep it
  std::vector<int32_t> shell;   // of each facet; filled by check_surface
};

// A surface as it was read, with the lines that open the report.
struct ReadSurface {
  Surface surface;
  std::string source;  // the path, or what else to call it in messages
  std::string report;
};

ReadSurface read_surface(const std::string& path, double scale);
ReadSurface surface_from_arrays(int64_t vertex_count, const double* xyz, int64_t facet_count, const int32_t* corners);

// Repairs, judges and orients a surface in place; fills the findings of info and appends lines to the report, also when
// it throws. Afterwards shells face outwards, cavities inwards.
void check_surface(Surface& surface, const std::string& source, ogive_mesh_info& info, std::string& report);

// Area and bounding box.
void measure_surface(const Surface& surface, ogive_mesh_info& info);

// Positions (three each) of the particles in the world.
std::vector<double> voxelise(const Surface& surface, const ogive_voxelise_def& def);

// Its vertices where the voxelisation puts the mesh.
std::vector<double> placed_vertices(const Surface& surface, const ogive_voxelise_def& def);

// Numbers in messages: std::to_chars, so that the locale has no say.
inline std::string text_of(double value, int digits = 6) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits).ptr;
  return std::string(buffer, end);
}
inline std::string text_of(const Vec3& p) {
  return std::string("(") + text_of(p[0]) + ", " + text_of(p[1]) + ", " + text_of(p[2]) + ")";
}
inline std::string text_of_count(int64_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

}  // namespace ogive::geometry
