// A scene as plain values: what the file says, checked as far as can be done without the engine.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "document.hpp"
#include "units.hpp"

namespace driver {

using Vector3 = std::array<double, 3>;

// An empty optional leaves the engine's default (ogive.h) in force. Integers that choose hold OGIVE_* values.

struct GridScene {
  double cell_size = 0;
  Vector3 lower{}, upper{};
  std::array<int32_t, 6> faces{};
  int32_t space = 0;
  std::optional<double> thickness;

  bool operator==(const GridScene&) const = default;
};

struct NumericsScene {
  std::optional<int32_t> shape_function;
  std::optional<double> time_step_factor;
  std::optional<double> maximum_time_step;
  std::optional<int32_t> threads;
  Vector3 gravity{};
  std::optional<int32_t> transfer;
  std::optional<int32_t> update_order;
  std::optional<double> pic_fraction;
  std::optional<int32_t> xpic_order;
  std::optional<double> energy_warning, energy_limit, energy_loss_limit;
  std::optional<bool> drop_debris, skip_resting;

  bool operator==(const NumericsScene&) const = default;
};

struct ContactScene {
  std::optional<int32_t> method;
  std::optional<int32_t> normal;
  std::optional<std::string> master;
  std::optional<double> friction;
  std::optional<int32_t> detection;
  std::optional<double> gap_offset;

  bool operator==(const ContactScene&) const = default;
};

struct ContactPairScene {
  std::array<std::string, 2> bodies;
  ContactScene rule;  // the scene's contact with this pair's changes

  bool operator==(const ContactPairScene&) const = default;
};

/// A rigid plane. Its rule's normal and master mean nothing.
struct WallScene {
  Vector3 point{}, normal{};
  ContactScene rule;  // the scene's contact with this wall's changes

  bool operator==(const WallScene&) const = default;
};

struct MaterialScene {
  std::string name;
  double density = 0;
  int32_t strength = 0;
  int32_t equation_of_state = 0;
  std::optional<double> youngs_modulus, poisson_ratio, bulk_modulus, shear_modulus;
  std::optional<double> yield_stress, hardening_modulus, hardening_exponent;
  std::optional<double> rate_coefficient, reference_strain_rate;
  std::optional<double> thermal_exponent, melt_temperature, room_temperature, specific_heat, taylor_quinney;
  std::optional<double> eos_sound_speed, eos_slope, gruneisen;
  std::optional<double> failure_strain;
  std::optional<double> viscosity_linear, viscosity_quadratic;
  std::optional<double> isotropic_fraction;

  bool operator==(const MaterialScene&) const = default;
};

/// A closed surface from a file, filled with particles.
struct MeshShape {
  std::filesystem::path file;
  Vector3 spacing{};
  Vector3 axis{0, 0, 1};
  Vector3 reference{};
  Vector3 position{};
  double scale = 1;
  Vector3 lattice_axis{0, 0, 1}, lattice_reference{}, lattice_origin{};

  bool operator==(const MeshShape&) const = default;
};

/// A solid that the engine fills by itself.
struct SolidShape {
  std::string kind;  // the scene's key: box, cylinder, sphere, ogive_rod
  int32_t solid = 0;
  int32_t lattice = 0;
  Vector3 size{}, centre{}, axis{0, 0, 1}, reference{}, spacing{};

  bool operator==(const SolidShape&) const = default;
};

/// Particles as they are, from a CSV file.
struct ParticleFileShape {
  std::filesystem::path file;

  bool operator==(const ParticleFileShape&) const = default;
};

/// The motion of a rigid body at one time.
struct MotionScene {
  double time = 0;
  Vector3 velocity{}, angular_velocity{};

  bool operator==(const MotionScene&) const = default;
};

/// Where a body has one particle a cell: farther than `beyond` from the line between two points.
struct CoarseScene {
  double beyond = 0;
  Vector3 from{}, to{};

  bool operator==(const CoarseScene&) const = default;
};

struct BodyScene {
  std::string name;
  std::string material;
  std::optional<int32_t> formulation;
  std::vector<MotionScene> motion;  // empty: a constant one
  std::optional<double> distortion_limit;
  std::optional<int32_t> when_distorted;
  std::optional<CoarseScene> coarse;
  Vector3 velocity{}, angular_velocity{}, angular_centre{};
  std::variant<MeshShape, SolidShape, ParticleFileShape> shape;

  bool operator==(const BodyScene&) const = default;
};

struct ClampScene {
  int32_t region = 0;
  Vector3 a{}, b{};
  double radius = 0;
  std::optional<std::string> body;
  int32_t axes = 7;

  bool operator==(const ClampScene&) const = default;
};

struct StopScene {
  double time = 0;
  std::optional<std::string> body;
  std::optional<double> settle_window, settle_tolerance;
  std::optional<bool> stop_when_stopped, stop_when_out;
  std::optional<double> exchange_window, exchange_tolerance;
  int64_t max_steps = 0;  // 0: no limit

  bool operator==(const StopScene&) const = default;
};

/// One entry of [output] results.
struct ResultScene {
  std::string name;  // what is measured, so far residual_velocity
  std::string body;

  bool operator==(const ResultScene&) const = default;
};

struct OutputScene {
  double history_interval = 0;
  double particle_interval = 0;  // 0: none
  int64_t checkpoint_steps = 0;  // 0: none
  int64_t checkpoint_keep = 3;
  std::vector<ResultScene> results;

  bool operator==(const OutputScene&) const = default;
};

/// What may be left out because the rest tells it: nothing is looked for; it is only said; half, quarter or eighth of a scene
/// that mirrors itself is taken; the plane of a scene of revolution is taken.
enum class SymmetryScene { none, offered, automatic, axisymmetric };

struct Scene {
  std::filesystem::path file;
  std::string text;  // the file with every --set merged into it
  std::string title;
  SymmetryScene symmetry = SymmetryScene::offered;
  std::optional<double> accuracy;  // wanted error of discretisation, 0.03: 3 %
  std::map<std::string, double> parameters;
  Units units;
  GridScene grid;
  NumericsScene numerics;
  ContactScene contact;
  std::vector<ContactPairScene> contact_pairs;
  std::vector<WallScene> walls;
  std::vector<MaterialScene> materials;  // in the order of the file
  std::vector<BodyScene> bodies;         // in the order of the file
  std::vector<ClampScene> clamps;
  StopScene stop;
  OutputScene output;
  std::map<std::string, std::string> places;

  /// "scene.toml:14:3: bodies.rod": where `path`, or else the table around it, was written, and the path itself.
  std::string place(const std::string& path) const;
};

/// Checks every key and value; throws Failure(kExitInput) with place, key, value and expectation of the first wrong
/// one.
Scene read_scene(const Document& document, const std::filesystem::path& file);

}  // namespace driver
