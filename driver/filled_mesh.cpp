// Particles from a surface mesh, through the C interface of the geometry library.
#include "filled_mesh.hpp"

#include <ogive_geometry.h>

#include <algorithm>
#include <memory>

#include "failure.hpp"
#include "mesh_section.hpp"
#include "world.hpp"

namespace driver {
namespace {

struct MeshRelease {
  void operator()(ogive_mesh* mesh) const { ogive_mesh_destroy(mesh); }
};
using Mesh = std::unique_ptr<ogive_mesh, MeshRelease>;

void require_mesh_ok(ogive_status status, const Mesh& mesh, const std::string& place) {
  if (status == OGIVE_OK) return;
  std::string message = mesh ? ogive_mesh_message(mesh.get()) : "";
  if (message.empty()) message = ogive_status_name(status);
  const bool user_can_mend = status != OGIVE_ERROR_MEMORY && status != OGIVE_ERROR_INTERNAL;
  throw Failure(user_can_mend ? kExitInput : exit_code(status), place + ": " + message);
}

/// A mesh that has been read and checked.
Mesh open_mesh(const MeshShape& shape, const std::string& place) {
  ogive_mesh* created = nullptr;
  const ogive_status made = ogive_mesh_create(&created);
  Mesh mesh(created);
  require_mesh_ok(made, mesh, place);
  ogive_mesh_read_def read;
  ogive_mesh_read_def_init(&read, sizeof read);
  read.scale = shape.scale;
  require_mesh_ok(ogive_mesh_read(mesh.get(), shape.file.c_str(), &read), mesh, place);
  require_mesh_ok(ogive_mesh_check(mesh.get()), mesh, place);
  return mesh;
}

ogive_voxelise_def placement_of(const MeshShape& shape) {
  ogive_voxelise_def fill;
  ogive_voxelise_def_init(&fill, sizeof fill);
  std::copy_n(shape.spacing.data(), 3, fill.spacing);
  std::copy_n(shape.lattice_axis.data(), 3, fill.lattice_axis);
  std::copy_n(shape.lattice_reference.data(), 3, fill.lattice_reference);
  std::copy_n(shape.lattice_origin.data(), 3, fill.lattice_origin);
  std::copy_n(shape.axis.data(), 3, fill.axis);
  std::copy_n(shape.reference.data(), 3, fill.reference);
  std::copy_n(shape.position.data(), 3, fill.position);
  return fill;
}

void take_surface(const Mesh& mesh, const ogive_voxelise_def& fill, const std::string& place, FilledMesh& filled) {
  int64_t vertices = 0, triangles = 0;
  require_mesh_ok(ogive_mesh_surface(mesh.get(), &fill, &vertices, &triangles, nullptr, nullptr), mesh, place);
  filled.vertices.resize(static_cast<size_t>(3 * vertices));
  filled.corners.resize(static_cast<size_t>(3 * triangles));
  require_mesh_ok(ogive_mesh_surface(mesh.get(), &fill, &vertices, &triangles, filled.vertices.data(),
                                     filled.corners.data()),
                  mesh, place);
}

}  // namespace

FilledMesh fill_mesh(const MeshShape& shape, const GridScene& grid, const std::string& place) {
  const bool planar = grid.space != OGIVE_SPACE_THREE_DIMENSIONAL;
  const MeshShape usual;
  if (planar && (shape.lattice_axis != usual.lattice_axis || shape.lattice_reference != usual.lattice_reference ||
                 shape.lattice_origin != usual.lattice_origin))
    throw Failure(kExitInput, place + ": lattice_axis, lattice_reference and lattice_origin are not for two-dimensional " +
                                  "scenes, whose lattice lies along x and y from the mesh's position on");
  const Mesh mesh = open_mesh(shape, place);
  FilledMesh filled;
  ogive_status status = OGIVE_OK;
  filled.report = text_of([&](char* text, size_t capacity,
                              size_t* needed) { return ogive_mesh_report(mesh.get(), text, capacity, needed); },
                          status);
  require_mesh_ok(status, mesh, place);
  ogive_mesh_info info{};
  info.struct_size = sizeof info;
  require_mesh_ok(ogive_mesh_info_get(mesh.get(), &info), mesh, place);
  filled.repaired = info.dropped_degenerate + info.dropped_duplicate + info.removed_flat + info.turned > 0;

  const ogive_voxelise_def fill = placement_of(shape);
  if (!planar) {
    int64_t count = 0;
    require_mesh_ok(ogive_mesh_voxelise(mesh.get(), &fill, &count, nullptr, nullptr), mesh, place);
    filled.particles.positions.resize(static_cast<size_t>(3 * count));
    filled.particles.volumes.resize(static_cast<size_t>(count));
    require_mesh_ok(ogive_mesh_voxelise(mesh.get(), &fill, &count, filled.particles.positions.data(),
                                        filled.particles.volumes.data()),
                    mesh, place);
  }
  take_surface(mesh, fill, place, filled);
  if (planar) {
    ogive_grid_def defaults;
    ogive_grid_def_init(&defaults, sizeof defaults);
    filled.particles = fill_mesh_section(
        filled.vertices, filled.corners, {shape.position[0], shape.position[1]}, {shape.spacing[0], shape.spacing[1]},
        {grid.space == OGIVE_SPACE_AXISYMMETRIC, grid.thickness.value_or(defaults.thickness)}, place);
  }
  return filled;
}

std::vector<double> mesh_vertices(const MeshShape& shape, const std::string& place) {
  FilledMesh filled;
  take_surface(open_mesh(shape, place), placement_of(shape), place, filled);
  return std::move(filled.vertices);
}

}  // namespace driver
