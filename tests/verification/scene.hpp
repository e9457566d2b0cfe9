// A thin wrapper around the C interface for tests: throws with the world's message where a call fails. Millimetres,
// milliseconds and grams: stress in MPa, speed in m/s, energy in mJ.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>
#include <optional>
#include <string>
#include <vector>

#include "ogive.h"

namespace verification {

using Vec3 = std::array<double, 3>;

// Prints and records the value, so that tolerances can be judged beside what is measured.
inline void measured(const std::string& name, double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6g", value);
  testing::Test::RecordProperty(name, text);
  std::printf("  measured %s = %s\n", name.c_str(), text);
}

// For the names of tests that take each shape function.
inline std::string shape_name(std::int32_t shape) {
  return shape == OGIVE_SHAPE_LINEAR ? "Linear" : shape == OGIVE_SHAPE_GIMP ? "Gimp" : "BSpline";
}

inline ogive_material_def material_def(double density) {
  ogive_material_def def;
  ogive_material_def_init(&def, sizeof def);
  def.density = density;
  return def;
}

inline ogive_material_def elastic(double density, double E, double nu) {
  ogive_material_def def = material_def(density);
  def.youngs_modulus = E;
  def.poisson_ratio = nu;
  return def;
}

inline ogive_material_def steel() { return elastic(7.85e-3, 200e3, 0.3); }

// Aluminium with Johnson-Cook strength and heating, Mie-Grueneisen pressure and failure, so weak that it fails in a
// hundred steps.
inline ogive_material_def failing_aluminium() {
  ogive_material_def def = elastic(2.7e-3, 69e3, 0.3);
  def.strength = OGIVE_STRENGTH_JOHNSON_COOK;
  def.eos = OGIVE_EOS_MIE_GRUNEISEN;
  def.failure = OGIVE_FAILURE_PLASTIC_STRAIN;
  def.yield_stress = 262;
  def.hardening_modulus = 162.1;
  def.hardening_exponent = 0.2783;
  def.rate_coefficient = 0.015;
  def.reference_strain_rate = 1e-3;
  def.thermal_exponent = 1.34;
  def.melt_temperature = 925;
  def.specific_heat = 875e0;
  def.eos_sound_speed = 5350;
  def.eos_slope = 1.34;
  def.gruneisen = 2.0;
  def.failure_strain = 0.15;
  return def;
}

struct Destroy {
  void operator()(ogive_world* world) const { ogive_world_destroy(world); }
};

class Scene {
 public:
  Scene() {
    ogive_world* world = nullptr;
    check(ogive_world_create(&world));
    world_.reset(world);
  }

  ogive_world* get() const { return world_.get(); }

  void check(ogive_status status) const {
    if (status != OGIVE_OK)
      throw std::runtime_error(std::string(ogive_status_name(status)) + ": " + ogive_world_message(world_.get()));
  }

  // Faces: x min, x max, y min, y max, z min, z max.
  Scene& grid(double cell, Vec3 lower, Vec3 upper, std::array<std::int32_t, 6> faces = {},
              std::int32_t space = OGIVE_SPACE_THREE_DIMENSIONAL, double thickness = 1) {
    ogive_grid_def def;
    ogive_grid_def_init(&def, sizeof def);
    def.cell_size = cell;
    for (int c = 0; c < 3; ++c) {
      def.domain_min[c] = lower[c];
      def.domain_max[c] = upper[c];
    }
    for (int f = 0; f < 6; ++f) def.face[f] = faces[f];
    def.space = space;
    def.thickness = thickness;
    check(ogive_world_set_grid(get(), &def));
    return *this;
  }

  Scene& numerics(std::int32_t shape, double factor, Vec3 gravity = {}, std::int32_t threads = 1,
                  std::optional<std::int32_t> transfer = {}, std::int32_t update_order = OGIVE_UPDATE_STRESS_FIRST,
                  std::optional<double> maximum_time_step = {}, std::int32_t xpic_order = 2,
                  std::optional<double> energy_limit = {}, bool skip_resting = true) {
    ogive_numerics_def def;
    ogive_numerics_def_init(&def, sizeof def);
    if (energy_limit) def.energy_limit = *energy_limit;
    def.skip_resting = skip_resting;
    if (maximum_time_step) def.maximum_time_step = *maximum_time_step;
    def.xpic_order = xpic_order;
    // Trilinear functions are verified with the papers' transfer, B-splines with the engine's default.
    if (shape == OGIVE_SHAPE_LINEAR) def.transfer = OGIVE_TRANSFER_FLIP;
    if (transfer) def.transfer = *transfer;
    def.update_order = update_order;
    def.shape_function = shape;
    def.time_step_factor = factor;
    def.threads = threads;
    for (int c = 0; c < 3; ++c) def.gravity[c] = gravity[c];
    check(ogive_world_set_numerics(get(), &def));
    return *this;
  }

  static ogive_contact_def contact_def(std::int32_t method, std::int32_t detection = OGIVE_DETECTION_GAP,
                                       double friction = 0, std::int32_t normal = OGIVE_NORMAL_AVERAGE,
                                       std::optional<double> gap_offset = {}) {
    ogive_contact_def def;
    ogive_contact_def_init(&def, sizeof def);
    if (gap_offset) def.gap_offset = *gap_offset;
    def.method = method;
    def.detection = detection;
    def.friction = friction;
    def.normal = normal;
    return def;
  }

  Scene& contact(std::int32_t method, std::int32_t detection = OGIVE_DETECTION_GAP, double friction = 0,
                 std::int32_t normal = OGIVE_NORMAL_AVERAGE, std::optional<double> gap_offset = {}) {
    const ogive_contact_def def = contact_def(method, detection, friction, normal, gap_offset);
    check(ogive_world_set_contact(get(), &def));
    return *this;
  }

  // A plane through `point`; bodies lie where `normal` points to.
  Scene& wall(Vec3 point, Vec3 normal, double friction = 0, std::optional<double> gap_offset = {},
              std::int32_t method = OGIVE_CONTACT_HUANG_SECOND, std::int32_t detection = OGIVE_DETECTION_GAP) {
    ogive_wall_def def;
    ogive_wall_def_init(&def, sizeof def);
    def.detection = detection;
    for (int c = 0; c < 3; ++c) {
      def.point[c] = point[c];
      def.normal[c] = normal[c];
    }
    def.method = method;
    def.friction = friction;
    if (gap_offset) def.gap_offset = *gap_offset;
    check(ogive_wall_add(get(), &def));
    return *this;
  }

  ogive_material_id material(const char* name, const ogive_material_def& def) {
    ogive_material_id id{-1};
    check(ogive_material_add(get(), name, &def, &id));
    return id;
  }

  static ogive_body_def body(ogive_material_id material, Vec3 velocity, Vec3 angular = {}, Vec3 about = {}) {
    ogive_body_def def;
    ogive_body_def_init(&def, sizeof def);
    def.material = material;
    for (int c = 0; c < 3; ++c) {
      def.velocity[c] = velocity[c];
      def.angular_velocity[c] = angular[c];
      def.angular_centre[c] = about[c];
    }
    return def;
  }

  static ogive_body_def rigid(ogive_material_id material, std::int32_t formulation, Vec3 velocity, Vec3 angular = {},
                              Vec3 about = {}) {
    ogive_body_def def = body(material, velocity, angular, about);
    def.formulation = formulation;
    return def;
  }

  static ogive_solid_def solid(std::int32_t kind, Vec3 centre, Vec3 size, double spacing) {
    ogive_solid_def def;
    ogive_solid_def_init(&def, sizeof def);
    def.solid = kind;
    for (int c = 0; c < 3; ++c) {
      def.centre[c] = centre[c];
      def.size[c] = size[c];
      def.spacing[c] = spacing;
    }
    return def;
  }

  ogive_body_id add(const char* name, const ogive_body_def& body_def, const ogive_solid_def& solid_def) {
    ogive_body_id id{-1};
    check(ogive_body_add_solid(get(), name, &body_def, &solid_def, &id));
    return id;
  }

  // A box between two corners.
  ogive_body_id box(const char* name, ogive_material_id material, Vec3 lower, Vec3 upper, double spacing, Vec3 velocity) {
    Vec3 centre, size;
    for (int c = 0; c < 3; ++c) {
      centre[c] = 0.5 * (lower[c] + upper[c]);
      size[c] = upper[c] - lower[c];
    }
    return add(name, body(material, velocity), solid(OGIVE_SOLID_BOX, centre, size, spacing));
  }

  Scene& prepare() {
    check(ogive_world_prepare(get()));
    return *this;
  }

  void steps(int count) {
    for (int i = 0; i < count; ++i) check(ogive_world_step(get(), 0));
  }
  void step(double dt) { check(ogive_world_step(get(), dt)); }
  double stable_time_step() const {
    double dt = 0;
    check(ogive_world_stable_time_step(get(), &dt));
    return dt;
  }
  void advance(double time) { check(ogive_world_advance(get(), time, 0, nullptr, nullptr)); }

  ogive_progress progress() const {
    ogive_progress result{};
    result.struct_size = sizeof result;
    check(ogive_world_progress(get(), &result));
    return result;
  }

  ogive_ledger ledger() const {
    ogive_ledger result{};
    result.struct_size = sizeof result;
    check(ogive_world_ledger(get(), &result));
    return result;
  }

  ogive_body_result result(ogive_body_id body) const {
    ogive_body_result result{};
    result.struct_size = sizeof result;
    check(ogive_body_result_get(get(), body, &result));
    return result;
  }

  std::vector<double> field(ogive_body_id body, const char* name) const {
    for (std::int32_t i = 0; i < ogive_field_count(get(), body); ++i) {
      std::int32_t components = 0;
      if (std::strcmp(ogive_field_name(get(), body, i, &components), name) != 0) continue;
      std::vector<double> values(static_cast<std::size_t>(result(body).particles) * components);
      check(ogive_field_get(get(), body, name, values.data(), static_cast<std::int64_t>(values.size())));
      return values;
    }
    throw std::runtime_error(std::string("no field ") + name);
  }

  void set_field(ogive_body_id body, const char* name, const std::vector<double>& values) {
    check(ogive_field_set(get(), body, name, values.data(), static_cast<std::int64_t>(values.size())));
  }

  // All fields of all bodies by "body/field".
  std::map<std::string, std::vector<double>> all_fields() const {
    std::map<std::string, std::vector<double>> all;
    for (std::int32_t b = 0; b < ogive_body_count(get()); ++b)
      for (std::int32_t i = 0; i < ogive_field_count(get(), {b}); ++i) {
        std::int32_t components = 0;
        const std::string name = ogive_field_name(get(), {b}, i, &components);
        all[std::string(ogive_body_name(get(), {b})) + "/" + name] = field({b}, name.c_str());
      }
    return all;
  }

 private:
  std::unique_ptr<ogive_world, Destroy> world_;
};

// Largest component of: momentum in the domain + what left - what faces, gravity and loads gave - what there was.
inline double momentum_miss(const ogive_ledger& before, const ogive_ledger& after) {
  double worst = 0;
  for (int c = 0; c < 3; ++c)
    worst = std::max(worst, std::abs(after.momentum[c] + after.left_domain_momentum[c] - after.boundary_impulse[c] -
                                     after.external_impulse[c] - before.momentum[c]));
  return worst;
}

inline bool same_bits(const void* a, const void* b, std::size_t bytes) { return std::memcmp(a, b, bytes) == 0; }

inline double maximum(const std::vector<double>& values) {
  double result = 0;
  for (double v : values) result = std::isfinite(v) ? std::max(result, std::abs(v)) : INFINITY;
  return result;
}

}  // namespace verification
