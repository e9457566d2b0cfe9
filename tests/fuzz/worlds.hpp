// Small worlds of every kind of material, transfer, contact and motion, as the fuzzers' ground to stand on. mm, ms, g.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "input.hpp"
#include "ogive.h"

namespace fuzz {

struct Release {
  void operator()(ogive_world* world) const { ogive_world_destroy(world); }
};
using World = std::unique_ptr<ogive_world, Release>;

inline World make_world() {
  ogive_world* world = nullptr;
  require(ogive_world_create(&world) == OGIVE_OK, "no world could be made");
  return World(world);
}

/// A save in memory.
struct Store {
  struct Array {
    std::int32_t type = 0;
    std::int64_t count = 0;
    std::vector<std::uint8_t> bytes;
  };
  std::map<std::string, Array> arrays;

  static std::size_t size_of(std::int32_t type) { return type == OGIVE_TYPE_UINT8 ? 1 : type == OGIVE_TYPE_INT32 ? 4 : 8; }
  static ogive_status put(void* self, const char* name, std::int32_t type, std::int64_t count, const void* data) {
    Array& array = static_cast<Store*>(self)->arrays[name];
    array.type = type;
    array.count = count;
    array.bytes.resize(static_cast<std::size_t>(count) * size_of(type));
    if (!array.bytes.empty()) std::memcpy(array.bytes.data(), data, array.bytes.size());
    return OGIVE_OK;
  }
  static ogive_status find(void* self, const char* name, std::int32_t* type, std::int64_t* count) {
    const auto found = static_cast<Store*>(self)->arrays.find(name);
    if (found == static_cast<Store*>(self)->arrays.end()) return OGIVE_ERROR_FORMAT;
    *type = found->second.type;
    *count = found->second.count;
    return OGIVE_OK;
  }
  static ogive_status get(void* self, const char* name, std::int64_t count, void* data) {
    const Array& array = static_cast<Store*>(self)->arrays[name];
    if (count != array.count) return OGIVE_ERROR_FORMAT;
    if (!array.bytes.empty()) std::memcpy(data, array.bytes.data(), array.bytes.size());
    return OGIVE_OK;
  }
  ogive_writer writer() { return {sizeof(ogive_writer), 0, this, put}; }
  ogive_reader reader() { return {sizeof(ogive_reader), 0, this, find, get}; }
};

constexpr int world_kinds = 5;

/// A prepared world after a few steps.
inline World small_world(int kind) {
  World world = make_world();
  ogive_grid_def grid;
  ogive_numerics_def numerics;
  ogive_contact_def contact;
  ogive_grid_def_init(&grid, sizeof grid);
  ogive_numerics_def_init(&numerics, sizeof numerics);
  ogive_contact_def_init(&contact, sizeof contact);
  grid.cell_size = 1;
  for (int axis = 0; axis < 3; ++axis) grid.domain_min[axis] = -4, grid.domain_max[axis] = 4;
  if (kind == 1) grid.face[0] = OGIVE_FACE_SYMMETRY, grid.face[5] = OGIVE_FACE_FIXED, grid.domain_min[0] = 0;
  if (kind == 4) grid.space = OGIVE_SPACE_AXISYMMETRIC, grid.domain_min[0] = 0;
  const int along = kind == 4 ? 1 : 2;
  if (kind == 1) numerics.transfer = OGIVE_TRANSFER_FLIP, numerics.shape_function = OGIVE_SHAPE_LINEAR;
  if (kind == 2) numerics.transfer = OGIVE_TRANSFER_XPIC, numerics.update_order = OGIVE_UPDATE_STRESS_LAST;
  if (kind == 3) numerics.transfer = OGIVE_TRANSFER_APIC;
  contact.method = kind == 1 ? OGIVE_CONTACT_BARDENHAGEN_2001 : kind == 2 ? OGIVE_CONTACT_HUANG_FIRST : OGIVE_CONTACT_HUANG_SECOND;
  if (kind == 2) contact.normal = OGIVE_NORMAL_LOGISTIC_REGRESSION;
  contact.friction = 0.2;
  require(ogive_world_set_grid(world.get(), &grid) == OGIVE_OK && ogive_world_set_numerics(world.get(), &numerics) == OGIVE_OK &&
              ogive_world_set_contact(world.get(), &contact) == OGIVE_OK,
          "the small world's model was refused");
  ogive_material_def material;
  ogive_material_def_init(&material, sizeof material);
  material.density = 8e-3, material.youngs_modulus = 1e5, material.poisson_ratio = 0.3;
  material.strength = kind == 1 ? OGIVE_STRENGTH_NEO_HOOKEAN : OGIVE_STRENGTH_JOHNSON_COOK;
  material.yield_stress = 100, material.hardening_modulus = 200, material.hardening_exponent = 0.4;
  material.thermal_exponent = 1, material.melt_temperature = 1300, material.specific_heat = 400;
  if (kind != 1) material.failure = OGIVE_FAILURE_PLASTIC_STRAIN, material.failure_strain = 0.5;
  if (kind == 2) material.viscosity_linear = 0.1, material.viscosity_quadratic = 1;
  ogive_material_id id;
  require(ogive_material_add(world.get(), "metal", &material, &id) == OGIVE_OK, "the small world's material was refused");
  for (int i = 0; i < 2; ++i) {
    ogive_body_def body;
    ogive_solid_def solid;
    ogive_body_def_init(&body, sizeof body);
    ogive_solid_def_init(&solid, sizeof solid);
    body.material = id;
    body.velocity[along] = i == 0 ? 60 : -60;
    if (kind == 3 && i == 1) body.formulation = OGIVE_FORMULATION_RIGID_FREE;
    solid.solid = i == 0 ? OGIVE_SOLID_BOX : OGIVE_SOLID_SPHERE;
    if (kind == 4) solid.axis[1] = 1, solid.axis[2] = 0;
    for (int axis = 0; axis < 3; ++axis) solid.spacing[axis] = 0.6, solid.size[axis] = i == 0 ? 2 : 1;
    solid.centre[along] = i == 0 ? -1.2 : 1.2;
    ogive_body_id ignored;
    require(ogive_body_add_solid(world.get(), i == 0 ? "a" : "b", &body, &solid, &ignored) == OGIVE_OK,
            "the small world's body was refused");
  }
  if (kind == 3) {
    ogive_wall_def wall;
    ogive_wall_def_init(&wall, sizeof wall);
    wall.point[2] = -3, wall.normal[2] = 1;
    require(ogive_wall_add(world.get(), &wall) == OGIVE_OK, "the small world's wall was refused");
  }
  if (kind == 2) {
    ogive_load_def load;
    ogive_load_def_init(&load, sizeof load);
    load.value[0] = 1;
    require(ogive_load_add(world.get(), &load, nullptr) == OGIVE_OK, "the small world's load was refused");
  }
  require(ogive_world_prepare(world.get()) == OGIVE_OK && ogive_world_advance(world.get(), 1, 4, nullptr, nullptr) == OGIVE_OK,
          "the small world could not be stepped");
  return world;
}

/// Steps a world that may have been given nonsense: it goes on or says that it broke down. What is not finite is found within
/// two steps: after two that were well, every place and velocity is.
inline void step_and_look(ogive_world* world, int steps) {
  for (int i = 0; i < steps; ++i) {
    const ogive_status status = ogive_world_step(world, 0);
    require(status != OGIVE_ERROR_INTERNAL, "a step ended with an internal error");
    if (status != OGIVE_OK) {
      require(*ogive_world_message(world) != '\0', "a failed step has no message");
      return;
    }
    if (i == 0) continue;
    for (std::int32_t b = 0; b < ogive_body_count(world); ++b)
      for (const char* field : {"position", "velocity"}) {
        ogive_field_view view{};
        view.struct_size = sizeof view;
        require(ogive_field_view_get(world, {b}, field, &view) == OGIVE_OK, "a field cannot be viewed");
        for (std::int64_t p = 0; p < view.places; ++p)
          for (int c = 0; c < 3; ++c)
            require(view.number[p] < 0 || std::isfinite(view.component[c][p * view.stride]),
                    "a place or velocity that is not finite went unnoticed");
      }
  }
}

}  // namespace fuzz
