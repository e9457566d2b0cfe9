// STL and OFF files: whatever the bytes, a mesh is read or refused; what passes the check can be filled, and its particles lie
// in its box and fill its volume.
#include <cmath>
#include <vector>

#include "input.hpp"
#include "memory_file.hpp"
#include "ogive_geometry.h"

using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  ogive_mesh* mesh = nullptr;
  if (ogive_mesh_create(&mesh) != OGIVE_OK) return 0;
  ogive_mesh_read_def how;
  ogive_mesh_read_def_init(&how, sizeof how);
  const ogive_status read = ogive_mesh_read(mesh, file.path().c_str(), &how);
  require(read != OGIVE_ERROR_INTERNAL, "reading a mesh ended with an internal error");
  if (read == OGIVE_OK) {
    const ogive_status checked = ogive_mesh_check(mesh);
    require(checked != OGIVE_ERROR_INTERNAL, "checking a mesh ended with an internal error");
    std::size_t needed = 0;
    require(ogive_mesh_report(mesh, nullptr, 0, &needed) == OGIVE_OK && needed > 1, "there is no report");
    ogive_mesh_info info{};
    info.struct_size = sizeof info;
    require(ogive_mesh_info_get(mesh, &info) == OGIVE_OK, "there is no information");
    if (checked == OGIVE_OK) {
      require(info.volume > 0, "an accepted mesh has no volume");
      ogive_voxelise_def def;
      ogive_voxelise_def_init(&def, sizeof def);
      for (int axis = 0; axis < 3; ++axis) def.spacing[axis] = (info.upper[axis] - info.lower[axis]) / 6;
      std::int64_t count = 0;
      const ogive_status filled = ogive_mesh_voxelise(mesh, &def, &count, nullptr, nullptr);
      require(filled != OGIVE_ERROR_INTERNAL, "filling a mesh ended with an internal error");
      if (filled == OGIVE_OK) {
        std::vector<double> xyz(static_cast<std::size_t>(3 * count)), volume(static_cast<std::size_t>(count));
        require(ogive_mesh_voxelise(mesh, &def, &count, xyz.data(), volume.data()) == OGIVE_OK, "only counting worked");
        double sum = 0;
        for (const double v : volume) sum += v;
        require(std::abs(sum - info.volume) <= 1e-9 * info.volume, "the particles do not have the mesh's volume");
        for (std::size_t i = 0; i < xyz.size(); ++i)
          require(xyz[i] >= info.lower[i % 3] && xyz[i] <= info.upper[i % 3], "a particle lies outside the mesh's box");
        ++fuzz::accepted;
      }
    }
  }
  ogive_mesh_destroy(mesh);
  return 0;
}
