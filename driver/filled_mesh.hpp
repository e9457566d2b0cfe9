// Particles from a surface mesh, through the C interface of the geometry library.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "particle_csv.hpp"
#include "scene.hpp"

namespace driver {

struct FilledMesh {
  ParticleList particles;
  std::vector<double> vertices;   // of the surface, three coordinates each
  std::vector<int32_t> corners;   // three vertices a triangle
  std::string report;  // what was read and found, in lines
  bool repaired = false;
};

/// In a two-dimensional scene the section with z = 0. `place` begins every message. Throws Failure(kExitInput) for whatever is
/// wrong with the mesh.
FilledMesh fill_mesh(const MeshShape& shape, const GridScene& grid, const std::string& place);

/// Its vertices where they lie in the scene, three coordinates each, without filling it.
std::vector<double> mesh_vertices(const MeshShape& shape, const std::string& place);

}  // namespace driver
