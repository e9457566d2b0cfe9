// The C interface: checks arguments, holds one mesh per handle, and turns every exception into a status and a message.
#include "ogive_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <vector>

#include "mesh.hpp"

using ogive::geometry::Refusal;
using ogive::geometry::text_of;

struct ogive_mesh {
  bool filled = false;  // something was read
  ogive::geometry::Surface surface;
  std::string source;
  std::string read_report;
  std::string check_report;
  ogive_mesh_info info{};
  std::string message;
  const char* shown_message = "";  // message, or a constant where memory for it could not be had
};

namespace {

[[noreturn]] void refuse(const std::string& message) { throw Refusal(OGIVE_ERROR_ARGUMENT, message); }

// Runs a call's body. Queries take a const mesh; its message is no part of what they promise not to change.
template <class Body>
ogive_status run(const ogive_mesh* constant_mesh, Body body) noexcept {
  auto* mesh = const_cast<ogive_mesh*>(constant_mesh);
  if (!mesh) return OGIVE_ERROR_ARGUMENT;
  ogive_status status = OGIVE_ERROR_INTERNAL;
  try {
    try {
      body();
      return OGIVE_OK;
    } catch (const Refusal& refusal) {
      status = refusal.status();
      mesh->message = refusal.what();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      mesh->message = std::string("a defect in the library: ") + error.what();
    }
    mesh->shown_message = mesh->message.c_str();
  } catch (const std::bad_alloc&) {
    status = OGIVE_ERROR_MEMORY;
    mesh->shown_message = "memory could not be had";
  } catch (...) {
    status = OGIVE_ERROR_INTERNAL;
    mesh->shown_message = "a defect in the library: an unknown exception";
  }
  return status;
}

template <class T>
void expect_pointer(const T* pointer, const char* name) {
  if (!pointer) refuse(std::string(name) + " is NULL: expected a valid pointer");
}

// A struct of the caller's size must be one that this library knows: its own or an older, shorter one.
template <class Def>
void expect_size(const Def* def, const char* name) {
  expect_pointer(def, name);
  if (def->struct_size < 2 * sizeof(uint32_t) || def->struct_size > sizeof(Def)) {
    refuse(std::string(name) + "->struct_size = " + std::to_string(def->struct_size) + ": expected at most " +
           std::to_string(sizeof(Def)) + ", the size of the struct");
  }
}

// The caller's definition in our size: what an older caller does not know stays at its default.
template <class Def, class Init>
Def complete(const Def* def, const char* name, Init set_defaults) {
  expect_size(def, name);
  Def full;
  set_defaults(&full, sizeof full);
  std::memcpy(static_cast<void*>(&full), def, def->struct_size);
  return full;
}

// Fills what the caller and this library both know of a definition with defaults, what the caller knows alone with zeros.
template <class Def>
void init(Def* def, size_t size, Def defaults) noexcept {
  if (!def || size < sizeof defaults.struct_size) return;
  const size_t known = std::min(size, sizeof defaults);
  defaults.struct_size = static_cast<uint32_t>(known);
  std::memset(static_cast<void*>(def), 0, size);
  std::memcpy(static_cast<void*>(def), &defaults, known);
}

// Takes a new surface in place of the old one; nothing here throws.
void take(ogive_mesh& mesh, ogive::geometry::ReadSurface&& read) {
  ogive_mesh_info info{};
  ogive::geometry::measure_surface(read.surface, info);
  mesh.info = info;
  mesh.filled = true;
  mesh.surface = std::move(read.surface);
  mesh.source = std::move(read.source);
  mesh.read_report = std::move(read.report);
  mesh.check_report.clear();
}

void expect_filled(const ogive_mesh& mesh) {
  if (!mesh.filled) throw Refusal(OGIVE_ERROR_STATE, "the mesh is empty: call ogive_mesh_read first");
}

}  // namespace

extern "C" {

ogive_status ogive_mesh_create(ogive_mesh** mesh) {
  if (!mesh) return OGIVE_ERROR_ARGUMENT;
  *mesh = new (std::nothrow) ogive_mesh;
  return *mesh ? OGIVE_OK : OGIVE_ERROR_MEMORY;
}

void ogive_mesh_destroy(ogive_mesh* mesh) { delete mesh; }

const char* ogive_mesh_message(const ogive_mesh* mesh) { return mesh ? mesh->shown_message : ""; }

void ogive_mesh_read_def_init(ogive_mesh_read_def* def, size_t size) {
  ogive_mesh_read_def defaults{};
  defaults.scale = 1;
  init(def, size, defaults);
}

ogive_status ogive_mesh_read(ogive_mesh* mesh, const char* path, const ogive_mesh_read_def* def) {
  return run(mesh, [&] {
    expect_pointer(path, "path");
    const ogive_mesh_read_def full = complete(def, "def", ogive_mesh_read_def_init);
    if (!(full.scale > 0 && std::isfinite(full.scale))) {
      refuse("scale = " + text_of(full.scale) + ": expected a finite number > 0");
    }
    take(*mesh, ogive::geometry::read_surface(path, full.scale));
  });
}

ogive_status ogive_mesh_set_facets(ogive_mesh* mesh, int64_t vertex_count, const double* xyz, int64_t facet_count,
                                   const int32_t* corners) {
  return run(mesh, [&] {
    if (vertex_count < 3 || vertex_count > std::numeric_limits<int32_t>::max()) {
      refuse("vertex_count = " + std::to_string(vertex_count) + ": expected 3..2147483647");
    }
    if (facet_count < 1 || facet_count > ogive::geometry::kMostFacets) {
      refuse("facet_count = " + std::to_string(facet_count) + ": expected 1.." +
             std::to_string(ogive::geometry::kMostFacets));
    }
    expect_pointer(xyz, "xyz");
    expect_pointer(corners, "corners");
    take(*mesh, ogive::geometry::surface_from_arrays(vertex_count, xyz, facet_count, corners));
  });
}

ogive_status ogive_mesh_check(ogive_mesh* mesh) {
  return run(mesh, [&] {
    expect_filled(*mesh);
    if (mesh->info.checked) return;
    // The findings stay when the surface is refused; the surface itself stays as it was read.
    ogive::geometry::Surface surface = mesh->surface;
    ogive_mesh_info info{};
    mesh->check_report.clear();
    try {
      ogive::geometry::check_surface(surface, mesh->source, info, mesh->check_report);
    } catch (...) {
      ogive::geometry::measure_surface(mesh->surface, info);
      info.volume = 0;
      info.shells = info.cavities = 0;
      mesh->info = info;
      throw;
    }
    info.checked = 1;
    mesh->info = info;
    mesh->surface = std::move(surface);
  });
}

ogive_status ogive_mesh_report(const ogive_mesh* mesh, char* text, size_t capacity, size_t* needed) {
  return run(mesh, [&] {
    expect_pointer(needed, "needed");
    if (capacity > 0) expect_pointer(text, "text");
    const std::string report = mesh->read_report + mesh->check_report;
    *needed = report.size() + 1;
    if (capacity == 0) return;
    const size_t length = std::min(capacity - 1, report.size());
    std::memcpy(text, report.data(), length);
    text[length] = '\0';
  });
}

ogive_status ogive_mesh_info_get(const ogive_mesh* mesh, ogive_mesh_info* info) {
  return run(mesh, [&] {
    expect_size(info, "info");
    expect_filled(*mesh);
    const uint32_t size = info->struct_size;
    std::memcpy(static_cast<void*>(info), &mesh->info, size);
    info->struct_size = size;
  });
}

void ogive_voxelise_def_init(ogive_voxelise_def* def, size_t size) {
  ogive_voxelise_def defaults{};
  defaults.lattice_axis[2] = defaults.axis[2] = 1;
  init(def, size, defaults);
}

ogive_status ogive_mesh_voxelise(const ogive_mesh* mesh, const ogive_voxelise_def* def, int64_t* count, double* xyz,
                                 double* volume) {
  return run(mesh, [&] {
    const ogive_voxelise_def full = complete(def, "def", ogive_voxelise_def_init);
    expect_pointer(count, "count");
    if (!xyz != !volume) refuse("xyz and volume: expected both NULL or neither");
    expect_filled(*mesh);
    if (!mesh->info.checked) {
      throw Refusal(OGIVE_ERROR_STATE, "the mesh was not accepted: call ogive_mesh_check before ogive_mesh_voxelise");
    }
    const std::vector<double> positions = ogive::geometry::voxelise(mesh->surface, full);
    const auto particles = static_cast<int64_t>(positions.size() / 3);
    if (!xyz) {
      *count = particles;
      return;
    }
    if (*count != particles) {
      refuse("*count = " + std::to_string(*count) + ": expected " + std::to_string(particles) +
             ", as the first call gives it");
    }
    std::copy(positions.begin(), positions.end(), xyz);
    std::fill(volume, volume + particles, mesh->info.volume / static_cast<double>(particles));
  });
}

ogive_status ogive_mesh_surface(const ogive_mesh* mesh, const ogive_voxelise_def* def, int64_t* vertex_count,
                                int64_t* triangle_count, double* xyz, int32_t* corners) {
  return run(mesh, [&] {
    const ogive_voxelise_def full = complete(def, "def", ogive_voxelise_def_init);
    expect_pointer(vertex_count, "vertex_count");
    expect_pointer(triangle_count, "triangle_count");
    if (!xyz != !corners) refuse("xyz and corners: expected both NULL or neither");
    expect_filled(*mesh);
    if (!mesh->info.checked) {
      throw Refusal(OGIVE_ERROR_STATE, "the mesh was not accepted: call ogive_mesh_check before ogive_mesh_surface");
    }
    const std::vector<double> placed = ogive::geometry::placed_vertices(mesh->surface, full);
    const auto vertices = static_cast<int64_t>(placed.size() / 3);
    const auto facets = static_cast<int64_t>(mesh->surface.facets.size());
    if (!xyz) {
      *vertex_count = vertices;
      *triangle_count = facets;
      return;
    }
    const auto expect_count = [](const char* name, int64_t got, int64_t expected) {
      if (got == expected) return;
      refuse(std::string("*") + name + " = " + std::to_string(got) + ": expected " + std::to_string(expected) +
             ", as the first call gives it");
    };
    expect_count("vertex_count", *vertex_count, vertices);
    expect_count("triangle_count", *triangle_count, facets);
    std::copy(placed.begin(), placed.end(), xyz);
    for (const ogive::geometry::Corners& facet : mesh->surface.facets) corners = std::copy(facet.begin(), facet.end(), corners);
  });
}

}  // extern "C"
