// What the tests of the geometry library share: meshes of known solids, files of them, and an owner of an ogive_mesh.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "ogive_geometry.h"

namespace geometry_test {

using Vec3 = std::array<double, 3>;
inline constexpr double kPi = std::numbers::pi;

struct Facets {
  std::vector<Vec3> vertices;
  std::vector<std::array<int32_t, 3>> corners;

  Facets& add(const Facets& other) {
    const auto first = static_cast<int32_t>(vertices.size());
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    for (auto [a, b, c] : other.corners) corners.push_back({a + first, b + first, c + first});
    return *this;
  }
  Facets inverted() const {
    Facets result = *this;
    for (auto& f : result.corners) std::swap(f[1], f[2]);
    return result;
  }
  Facets moved(const Vec3& by) const {
    Facets result = *this;
    for (Vec3& p : result.vertices) {
      for (int d = 0; d < 3; ++d) p[d] += by[d];
    }
    return result;
  }
};

inline Facets box(const Vec3& lower, const Vec3& upper) {
  Facets result;
  for (int v = 0; v < 8; ++v) {
    result.vertices.push_back({v & 1 ? upper[0] : lower[0], v & 2 ? upper[1] : lower[1], v & 4 ? upper[2] : lower[2]});
  }
  result.corners = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return result;
}

// A prism over a polygon in x-y (counter-clockwise) cut into triangles, z from 0 to height.
inline Facets prism(const std::vector<std::array<double, 2>>& polygon,
                    const std::vector<std::array<int32_t, 3>>& triangles, double height) {
  Facets result;
  const auto n = static_cast<int32_t>(polygon.size());
  for (double z : {0.0, height}) {
    for (const auto& p : polygon) result.vertices.push_back({p[0], p[1], z});
  }
  for (auto [a, b, c] : triangles) {
    result.corners.push_back({a, c, b});
    result.corners.push_back({a + n, b + n, c + n});
  }
  for (int32_t k = 0; k < n; ++k) {
    const int32_t next = (k + 1) % n;
    result.corners.push_back({k, next, next + n});
    result.corners.push_back({k, next + n, k + n});
  }
  return result;
}

// The square 0..2 x 0..2 without 1..2 x 1..2, one thick: volume 3.
inline Facets l_shape() {
  return prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}, 1);
}

inline Facets sphere(double radius, int around, int along) {
  Facets result;
  result.vertices.push_back({0, 0, radius});
  for (int i = 1; i < along; ++i) {
    for (int k = 0; k < around; ++k) {
      const double polar = kPi * i / along, angle = 2 * kPi * k / around;
      result.vertices.push_back({radius * std::sin(polar) * std::cos(angle), radius * std::sin(polar) * std::sin(angle),
                                 radius * std::cos(polar)});
    }
  }
  result.vertices.push_back({0, 0, -radius});
  const auto last = static_cast<int32_t>(result.vertices.size() - 1);
  const auto at = [&](int i, int k) { return 1 + (i - 1) * around + k % around; };
  for (int k = 0; k < around; ++k) {
    result.corners.push_back({0, at(1, k), at(1, k + 1)});
    for (int i = 1; i + 1 < along; ++i) {
      result.corners.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      result.corners.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
    result.corners.push_back({last, at(along - 1, k + 1), at(along - 1, k)});
  }
  return result;
}

// Round the z axis.
inline Facets torus(double ring, double tube, int around, int across) {
  Facets result;
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < across; ++k) {
      const double a = 2 * kPi * i / around, b = 2 * kPi * k / across, rho = ring + tube * std::cos(b);
      result.vertices.push_back({rho * std::cos(a), rho * std::sin(a), tube * std::sin(b)});
    }
  }
  const auto at = [&](int i, int k) { return (i % around) * across + k % across; };
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < across; ++k) {
      result.corners.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      result.corners.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return result;
}

inline std::string binary_stl(const Facets& facets, const std::string& header = "test") {
  std::string bytes = header;
  bytes.resize(80, '\0');
  const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<uint32_t>(facets.corners.size()));
  for (const auto& f : facets.corners) {
    for (int d = 0; d < 3; ++d) put(0.0f);
    for (int32_t v : f) {
      for (double x : facets.vertices[v]) put(static_cast<float>(x));
    }
    put(uint16_t{0});
  }
  return bytes;
}

// C++ streams of the classic locale: a point, whatever the C locale says.
inline std::string ascii_stl(const Facets& facets, const std::string& name = "test") {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  out << "solid " << name << "\n";
  for (const auto& f : facets.corners) {
    out << "  facet normal 0 0 0\n    outer loop\n";
    for (int32_t v : f) {
      const Vec3& p = facets.vertices[v];
      out << "      vertex " << p[0] << " " << p[1] << " " << p[2] << "\n";
    }
    out << "    endloop\n  endfacet\n";
  }
  out << "endsolid " << name << "\n";
  return out.str();
}

inline std::string off(const Facets& facets) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  out << "OFF\n" << facets.vertices.size() << " " << facets.corners.size() << " 0\n";
  for (const Vec3& p : facets.vertices) out << p[0] << " " << p[1] << " " << p[2] << "\n";
  for (const auto& f : facets.corners) out << "3 " << f[0] << " " << f[1] << " " << f[2] << "\n";
  return out.str();
}

// A file that is gone when the test ends. CTest runs cases side by side, so the name is this process's own.
class File {
 public:
  File(const std::string& name, const std::string& bytes)
      : path_(testing::TempDir() + "ogive_geometry_" + std::to_string(getpid()) + "_" + name) {
    write(bytes);
  }
  ~File() { std::remove(path_.c_str()); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }
  const char* path() const { return path_.c_str(); }

 private:
  std::string path_;
};

struct Particles {
  std::vector<Vec3> position;
  std::vector<double> volume;
};

class Mesh {
 public:
  Mesh() { EXPECT_EQ(ogive_mesh_create(&mesh_), OGIVE_OK); }
  explicit Mesh(const Facets& facets) : Mesh() { EXPECT_EQ(set(facets), OGIVE_OK) << message(); }
  ~Mesh() { ogive_mesh_destroy(mesh_); }
  Mesh(const Mesh&) = delete;
  Mesh& operator=(const Mesh&) = delete;

  ogive_mesh* get() const { return mesh_; }
  std::string message() const { return ogive_mesh_message(mesh_); }

  ogive_status set(const Facets& facets) {
    return ogive_mesh_set_facets(mesh_, static_cast<int64_t>(facets.vertices.size()), facets.vertices[0].data(),
                                 static_cast<int64_t>(facets.corners.size()), facets.corners[0].data());
  }
  ogive_status read(const char* path, double scale = 1) {
    ogive_mesh_read_def def;
    ogive_mesh_read_def_init(&def, sizeof def);
    def.scale = scale;
    return ogive_mesh_read(mesh_, path, &def);
  }
  ogive_status check() { return ogive_mesh_check(mesh_); }

  ogive_mesh_info info() const {
    ogive_mesh_info result{};
    result.struct_size = sizeof result;
    EXPECT_EQ(ogive_mesh_info_get(mesh_, &result), OGIVE_OK) << message();
    return result;
  }
  std::string report() const {
    size_t needed = 0;
    EXPECT_EQ(ogive_mesh_report(mesh_, nullptr, 0, &needed), OGIVE_OK);
    std::string text(needed, 'x');
    EXPECT_EQ(ogive_mesh_report(mesh_, text.data(), text.size(), &needed), OGIVE_OK);
    EXPECT_EQ(text.back(), '\0');
    text.pop_back();
    return text;
  }

  // Fills it; on failure there are no particles and message() tells why.
  Particles fill(const ogive_voxelise_def& def) {
    Particles result;
    int64_t count = 0;
    if (ogive_mesh_voxelise(mesh_, &def, &count, nullptr, nullptr) != OGIVE_OK) return result;
    result.position.resize(count);
    result.volume.resize(count);
    EXPECT_EQ(ogive_mesh_voxelise(mesh_, &def, &count, result.position[0].data(), result.volume.data()), OGIVE_OK)
        << message();
    return result;
  }

 private:
  ogive_mesh* mesh_ = nullptr;
};

inline ogive_voxelise_def lattice(double x, double y, double z) {
  ogive_voxelise_def def;
  ogive_voxelise_def_init(&def, sizeof def);
  def.spacing[0] = x, def.spacing[1] = y, def.spacing[2] = z;
  return def;
}
inline ogive_voxelise_def lattice(double spacing) { return lattice(spacing, spacing, spacing); }

inline void set(double (&field)[3], const Vec3& value) { std::copy(value.begin(), value.end(), field); }

// Says which of `words` a message lacks; "" if none.
inline std::string lacks(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (message.find(word) == std::string::npos) return "\"" + word + "\" is not in: " + message;
  }
  return "";
}

}  // namespace geometry_test
