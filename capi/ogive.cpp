// The C interface over the engine: turns definition structs into the Model, guards every call, keeps messages.
//
// A world is in one of three stages: building (the model may change), ready (prepared or loaded), broken (a numerical
// error ended the run; it may be looked at and saved, not stepped).
#include "ogive.h"

#include <sched.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "archive.hpp"
#include "audit.hpp"
#include "change.hpp"
#include "contact/contact.hpp"
#include "contact/method.hpp"
#include "contact/normal.hpp"
#include "energy_watch.hpp"
#include "error.hpp"
#include "grid.hpp"
#include "lagrangian/lagrangian.hpp"
#include "loads/loads.hpp"
#include "model.hpp"
#include "plan.hpp"
#include "planar/section.hpp"
#include "resting.hpp"
#include "solids.hpp"
#include "state.hpp"
#include "step.hpp"

using namespace ogive;

enum class Stage { Building, Ready, Reopened, Broken };

struct ogive_world {
  Stage stage = Stage::Building;
  Model model;
  State state;
  Workspace workspace;
  std::unique_ptr<Model> changed;  // while reopened: the model that is to come
  bool has_grid = false;
  bool advancing = false;  // inside ogive_world_advance: the callback may not step
  ogive_log_callback log = nullptr;
  void* log_user = nullptr;
  std::map<std::string, std::vector<std::uint8_t>> attachments;
  mutable std::string message;
  mutable const char* fixed_message = nullptr;  // in place of message where there was no memory for it
  // Sums over the particles of each body after `audited_steps` steps, made when first asked for: who asks for the ledger
  // mostly asks for each body too. Every call that may change the world empties it.
  mutable std::vector<std::optional<BodyAudit>> audits;
  mutable std::int64_t audited_steps = 0;
};

namespace {

constexpr std::size_t longest_name = 63;

// Messages must not need memory that there may not be.
void set_message(const ogive_world* world, const char* text) noexcept {
  world->fixed_message = nullptr;
  try {
    world->message = text;
  } catch (...) {
    world->fixed_message = "memory could not be had, not even for the message";
  }
}

const char* message_of(const ogive_world* world) {
  return world->fixed_message ? world->fixed_message : world->message.c_str();
}

void tell(const ogive_world* world, std::int32_t level, const char* text) {
  if (world->log) world->log(world->log_user, level, text);
}

ogive_status fail(const ogive_world* world, ogive_status status, const char* text) noexcept {
  set_message(world, text);
  tell(world, OGIVE_LOG_ERROR, message_of(world));
  return status;
}

// Runs work() and turns what it throws into a status.
template <class Work>
ogive_status guarded(const ogive_world* world, Work&& work) noexcept {
  if (!world) return OGIVE_ERROR_ARGUMENT;
  try {
    work();
    return OGIVE_OK;
  } catch (const Error& error) {
    return fail(world, static_cast<ogive_status>(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(world, OGIVE_ERROR_MEMORY, "memory could not be had");
  } catch (const std::length_error&) {
    return fail(world, OGIVE_ERROR_MEMORY, "memory could not be had: an array would be too long");
  } catch (const std::exception& error) {
    return fail(world, OGIVE_ERROR_INTERNAL, error.what());
  } catch (...) {
    return fail(world, OGIVE_ERROR_INTERNAL, "unknown failure");
  }
}

template <class Work>
ogive_status guarded(ogive_world* world, Work&& work) noexcept {
  if (world) world->audits.clear();
  return guarded(static_cast<const ogive_world*>(world), std::forward<Work>(work));
}

const BodyAudit& audit_of(const ogive_world* world, int body) {
  if (world->audits.empty() || world->audited_steps != world->state.steps) {
    world->audits.assign(world->state.bodies.size(), std::nullopt);
    world->audited_steps = world->state.steps;
  }
  std::optional<BodyAudit>& audit = world->audits[static_cast<std::size_t>(body)];
  if (!audit) audit = audit_body(world->model, world->state, body, world->workspace.threads);
  return *audit;
}

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::Argument, message); }

void require_stage(const ogive_world* world, Stage stage, const char* call) {
  if (world->stage == stage) return;
  const std::string name(call);
  if (world->stage == Stage::Building)
    throw Error(ErrorKind::State, name + ": the world must be prepared first (ogive_world_prepare)");
  if (world->stage == Stage::Broken)
    throw Error(ErrorKind::State, name + ": the run has broken down; its state can be looked at and saved, not advanced");
  if (world->stage == Stage::Reopened)
    throw Error(ErrorKind::State, name + ": the world is reopened for changes; ogive_world_prepare ends them");
  throw Error(ErrorKind::State, name + ": the world is prepared and its model frozen");
}

// The model that what may also be changed in a run is written to.
Model& changeable(ogive_world* world, const char* call) {
  if (world->stage == Stage::Reopened) return *world->changed;
  require_stage(world, Stage::Building, call);
  return world->model;
}

void require_prepared(const ogive_world* world, const char* call) {
  if (world->stage == Stage::Building) require_stage(world, Stage::Ready, call);
}

void require_memory(const void* pointer, const char* name) {
  if (!pointer) refuse(std::string(name) + ": must not be NULL");
}

template <class T>
const T& require_pointer(const T* pointer, const char* name) {
  require_memory(pointer, name);
  return *pointer;
}

// The caller's struct in our size: what an older caller does not know stays at its default.
template <class Def, class Init>
Def complete(const Def* def, const char* name, Init init) {
  require_pointer(def, name);
  if (def->struct_size < 2 * sizeof(std::uint32_t) || def->struct_size > sizeof(Def))
    refuse(std::string(name) + ".struct_size: must be at most " + std::to_string(sizeof(Def)) +
           " as set by the struct's init function, got " + std::to_string(def->struct_size));
  Def full;
  init(&full, sizeof full);
  std::memcpy(static_cast<void*>(&full), def, def->struct_size);
  return full;
}

// Fills a result struct of the caller's size.
template <class Result>
void deliver(const Result& full, Result* to, const char* name) {
  const std::uint32_t size = require_pointer(to, name).struct_size;
  if (size < 2 * sizeof(std::uint32_t) || size > sizeof(Result))
    refuse(std::string(name) + ".struct_size: must be set to the size of the struct, at most " +
           std::to_string(sizeof(Result)) + ", got " + std::to_string(size));
  std::memcpy(static_cast<void*>(to), &full, size);
  to->struct_size = size;
}

template <class Def>
void initialise(Def* def, size_t size, const Def& defaults) {
  if (!def) return;
  const std::size_t known = std::min(size, sizeof(Def));
  std::memset(static_cast<void*>(def), 0, size);  // what a newer caller knows alone is zero, and not looked at
  std::memcpy(static_cast<void*>(def), &defaults, known);
  const std::uint32_t stored = static_cast<std::uint32_t>(known);
  if (known >= sizeof stored) std::memcpy(static_cast<void*>(def), &stored, sizeof stored);
}

Vector3 vector_of(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

std::string checked_name(const char* name, const char* what) {
  require_pointer(name, "name");
  const std::size_t length = std::strlen(name);
  if (length < 1 || length > longest_name)
    refuse(std::string(what) + " name: must have 1..63 characters, got " + std::to_string(length));
  return name;
}

int processors() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return 1;
}

void set_threads(ogive_world* world, std::int32_t threads) {
  if (threads < 0 || threads > 1024) refuse("threads: must be 0..1024, got " + std::to_string(threads));
  world->workspace.threads = threads == 0 ? processors() : threads;
}

void copy_text(const std::string& text, char* to, size_t capacity, size_t* needed) {
  if (needed) *needed = text.size() + 1;
  if (!to || capacity == 0) return;
  const std::size_t n = std::min(capacity - 1, text.size());
  std::memcpy(to, text.data(), n);
  to[n] = 0;
}

const BodyState& body_of(const ogive_world* world, ogive_body_id id) {
  if (id.index < 0 || id.index >= static_cast<std::int32_t>(world->state.bodies.size()))
    refuse("body: must be 0.." + std::to_string(static_cast<int>(world->state.bodies.size()) - 1) + ", got " +
           std::to_string(id.index));
  return world->state.bodies[id.index];
}

void require_body_or_none(const ogive_world*, ogive_body_id id, const char* name) {
  if (id.index < -1) refuse(std::string(name) + ": must be a body's id or -1, got " + std::to_string(id.index));
}

std::string number_text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.9g", x);
  return buffer;
}

// A line on what there is, and the plan's cautions.
void tell_prepared(const ogive_world* world, const char* what, const std::string& plan) {
  if (!world->log) return;
  tell(world, OGIVE_LOG_INFO,
       (std::string(what) + ": " + std::to_string(world->model.bodies.size()) + " bodies, " +
        std::to_string(world->state.particle_count()) + " particles, stable time step " +
        number_text(world->state.stable_time_step)).c_str());
  for (std::size_t at = plan.find("caution: "); at != std::string::npos; at = plan.find("caution: ", at + 1))
    tell(world, OGIVE_LOG_WARNING, plan.substr(at, plan.find('\n', at) - at).c_str());
}

// ------------------------------------------------------------------------------------------------------------- bodies

std::string place_text(const double* x) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, "(%.6g, %.6g, %.6g)", x[0], x[1], x[2]);
  return buffer;
}

// What a body of a two-dimensional model cannot have.
void require_in_plane(const Grid& grid, const ogive_body_def& def, const std::string& prefix) {
  const auto zero = [&](const char* field, double value, const char* model) {
    if (value != 0) refuse(prefix + field + ": must be 0 in " + model + " model, got " + number_text(value));
  };
  if (!grid.planar()) return;
  zero("velocity[z]", def.velocity[2], "a two-dimensional");
  zero("angular_velocity[x]", def.angular_velocity[0], "a two-dimensional");
  zero("angular_velocity[y]", def.angular_velocity[1], "a two-dimensional");
  if (!grid.axisymmetric()) return;
  zero("velocity[x]", def.velocity[0], "an axisymmetric");
  zero("angular_velocity[z]", def.angular_velocity[2], "an axisymmetric");
}

// Edge of a cube, or of a square section, of a particle's size.
double particle_edge(const Grid& grid, const double* x, double volume) {
  return grid.planar() ? std::sqrt(volume * grid.section_share_at(x[0])) : std::cbrt(volume);
}

// What a rigid body is given besides its particles.
void make_rigid(const Grid& grid, const ogive_body_def& def, const double* volume, const std::vector<std::int64_t>& kept,
                const std::string& prefix, Body& rules, BodyState& body) {
  double mass = 0;
  Vector3 first{};
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const double* x = &body.position[4 * i];
    const double side = particle_edge(grid, x, volume[kept[i]]);
    mass += x[3];
    rules.own_inertia += x[3] * side * side / 6;
    for (int c = 0; c < 3; ++c) first[c] += x[3] * x[c];
  }
  rules.own_inertia /= mass;
  rules.reference = vector_of(def.angular_centre);
  const Vector3 v = vector_of(def.velocity), w = vector_of(def.angular_velocity);
  body.rigid.centre = times(1 / mass, first);
  for (int axis = 0; axis < 3; ++axis) {
    if (!rules.cut[axis]) continue;
    const double x = body.rigid.centre[axis];
    body.rigid.centre[axis] =
        x - grid.domain_min[axis] < grid.domain_max[axis] - x ? grid.domain_min[axis] : grid.domain_max[axis];
  }
  body.rigid.spin = w;
  body.rigid.velocity = plus(v, cross(w, minus(body.rigid.centre, rules.reference)));
  for (int axis = 0; axis < 3; ++axis)
    if (rules.cut[axis] && (body.rigid.velocity[axis] != 0 || w[(axis + 1) % 3] != 0 || w[(axis + 2) % 3] != 0))
      refuse(prefix + "velocity and angular_velocity: must fit the " + "xyz"[axis] +
             " symmetry face that cuts the rigid body (no velocity across it, rotation about its normal alone)");
  if (rules.prescribed()) rules.motion = {{0, v, w}};
}

// A particle that a body is to have.
struct Seed {
  Vector3 position{};
  double volume = 0;
  std::int32_t number = 0;
};

// The particles of each cell that is far from the line of the definition become one, in the place of the first of them. Mass and
// centre of mass stay; mirror symmetry stays as well, because nodes lie on symmetry planes.
void merge_far_seeds(const Grid& grid, const ogive_body_def& def, std::vector<Seed>& seeds) {
  const Vector3 from = vector_of(def.coarse_from), to = vector_of(def.coarse_to);
  Vector3 along{};
  double length_squared = 0;
  for (int c = 0; c < 3; ++c) {
    along[c] = to[c] - from[c];
    length_squared += along[c] * along[c];
  }
  const auto far = [&](const std::array<std::int64_t, 3>& cell) {
    Vector3 centre{};
    double part = 0, distance_squared = 0;
    for (int c = 0; c < 3; ++c) {
      centre[c] = grid.planar() && c == 2 ? 0 : grid.domain_min[c] + (static_cast<double>(cell[c]) + 0.5) * grid.cell_size;
      part += (centre[c] - from[c]) * along[c];
    }
    part = length_squared > 0 ? std::clamp(part / length_squared, 0.0, 1.0) : 0.0;
    for (int c = 0; c < 3; ++c) {
      const double off = centre[c] - from[c] - part * along[c];
      distance_squared += off * off;
    }
    return distance_squared > def.coarse_beyond * def.coarse_beyond;
  };
  std::map<std::array<std::int64_t, 3>, std::size_t> first;  // the place of each far cell's first particle
  std::vector<Seed> kept;
  for (const Seed& seed : seeds) {
    std::array<std::int64_t, 3> cell{};
    for (int c = 0; c < 3; ++c)
      cell[c] = static_cast<std::int64_t>(std::floor((seed.position[c] - grid.domain_min[c]) / grid.cell_size));
    if (!far(cell)) {
      kept.push_back(seed);
      continue;
    }
    const auto [at, fresh] = first.emplace(cell, kept.size());
    if (fresh) kept.push_back({{}, 0, seed.number});
    Seed& merged = kept[at->second];
    for (int c = 0; c < 3; ++c) merged.position[c] += seed.volume * seed.position[c];
    merged.volume += seed.volume;
  }
  for (const auto& [cell, place] : first)
    for (double& coordinate : kept[place].position) coordinate /= kept[place].volume;
  seeds = std::move(kept);
}

ogive_body_id add_particles(ogive_world* world, const char* name, const ogive_body_def* def, std::int64_t count,
                            const double* xyz, const double* volume) {
  require_stage(world, Stage::Building, "ogive_body_add");
  if (!world->has_grid) throw Error(ErrorKind::State, "ogive_body_add: the grid must be set first (ogive_world_set_grid)");
  const std::string body_name = checked_name(name, "body");
  const ogive_body_def full = complete(def, "def", ogive_body_def_init);
  const std::string prefix = "body \"" + body_name + "\": ";
  for (const Body& other : world->model.bodies)
    if (other.name == body_name) refuse(prefix + "name is already taken");
  if (full.material.index < 0 || full.material.index >= static_cast<std::int32_t>(world->model.materials.size()))
    refuse(prefix + "material: must be the id of a material, got " + std::to_string(full.material.index));
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(full.velocity[c]) || !std::isfinite(full.angular_velocity[c]) || !std::isfinite(full.angular_centre[c]))
      refuse(prefix + "velocity, angular_velocity and angular_centre must be finite");
  if (full.formulation < 0 || full.formulation > 3)
    refuse(prefix + "formulation: must be 0..3, got " + std::to_string(full.formulation));
  if (world->model.bodies.size() >= 60000) refuse(prefix + "at most 60000 bodies");
  if (count < 1) refuse(prefix + "must have at least one particle, got " + std::to_string(count));
  if (count >= (std::int64_t{1} << 31) - 64) refuse(prefix + "must have fewer than 2^31 particles");
  require_pointer(xyz, "xyz");
  require_pointer(volume, "volume");

  const Grid& grid = world->model.grid;
  require_in_plane(grid, full, prefix);
  const Material& material = world->model.materials[full.material.index];
  Body rules;
  rules.name = body_name;
  rules.material = full.material.index;
  rules.formulation = static_cast<Formulation>(full.formulation);
  rules.distortion_limit = full.distortion_limit;
  rules.when_distorted = static_cast<WhenDistorted>(full.when_distorted);
  try {
    if (rules.total_lagrangian()) world->model.validate_distortion(rules);
  } catch (const Error& error) {
    throw Error(error.kind(), prefix + error.what());
  }
  if (full.coarse_beyond != 0 && (rules.rigid() || rules.total_lagrangian()))
    refuse(prefix + "coarse_beyond: must be 0 for a rigid or total Lagrangian body, got " + number_text(full.coarse_beyond));
  if (!(full.coarse_beyond >= 0 && std::isfinite(full.coarse_beyond)))
    refuse(prefix + "coarse_beyond: must be >= 0 and finite, got " + number_text(full.coarse_beyond));
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(full.coarse_from[axis]) || !std::isfinite(full.coarse_to[axis]))
      refuse(prefix + "coarse_from and coarse_to: must be finite");
  std::vector<std::int64_t> kept;
  std::vector<Seed> seeds;
  kept.reserve(static_cast<std::size_t>(count));
  seeds.reserve(static_cast<std::size_t>(count));
  for (std::int64_t p = 0; p < count; ++p) {
    const double* x = xyz + 3 * p;
    if (!(volume[p] > 0 && std::isfinite(volume[p])))
      refuse(prefix + "volume of particle " + std::to_string(p) + ": must be > 0 and finite, got " +
             std::to_string(volume[p]));
    double part = 1;
    if (grid.planar() && x[2] != 0)
      refuse(prefix + "position[z] of particle " + std::to_string(p) + ": must be 0 in a two-dimensional model, got " +
             number_text(x[2]));
    if (grid.axisymmetric() && x[0] == 0)
      refuse(prefix + "position[x] of particle " + std::to_string(p) +
             ": must not be 0 in an axisymmetric model, where a ring of no radius has no volume");
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(x[axis])) refuse(prefix + "position of particle " + std::to_string(p) + ": must be finite");
      for (int side = 0; side < 2; ++side) {
        const double inside = side == 0 ? x[axis] - grid.domain_min[axis] : grid.domain_max[axis] - x[axis];
        if (grid.face[2 * axis + side] == Face::Symmetry) {
          // Cut at the mirror; a particle whose centre lies on it keeps the half that is inside.
          if (std::abs(inside) <= 1e-9 * grid.cell_size) part *= 0.5;
          else if (inside < 0) part = 0;
          // A rigid body that touches its image is one with it.
          if (rules.rigid() && inside <= 0.5 * particle_edge(grid, x, volume[p]) * (1 + 1e-6)) rules.cut[axis] = 1;
        } else if (inside < 0) {
          refuse(prefix + "must lie inside the domain; particle " + std::to_string(p) + " at " + place_text(x) +
                 " is outside the " + "xyz"[axis] + (side == 0 ? " min" : " max") + " face");
        }
      }
    }
    if (part > 0) {
      kept.push_back(p);
      seeds.push_back({{x[0], x[1], x[2]}, volume[p] * part, static_cast<std::int32_t>(p)});
    }
  }
  if (kept.empty()) refuse(prefix + "nothing is left of it inside the symmetry faces");

  if (full.coarse_beyond > 0) merge_far_seeds(grid, full, seeds);

  BodyState body;
  body.particles = static_cast<std::int64_t>(seeds.size());
  allocate_particles(material, rules, body.particles, body);
  Vector3 momentum{};
  double mass_sum = 0;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Vector3& x = seeds[i].position;
    const double mass = material.density * seeds[i].volume;
    for (int c = 0; c < 3; ++c) {
      const int d = (c + 1) % 3, e = (c + 2) % 3;
      body.position[4 * i + c] = x[c];
      const double v = full.velocity[c] + full.angular_velocity[d] * (x[e] - full.angular_centre[e]) -
                       full.angular_velocity[e] * (x[d] - full.angular_centre[d]);
      body.velocity[4 * i + c] = v;
      momentum[c] += mass * v;
    }
    body.position[4 * i + 3] = mass;
    body.velocity[4 * i + 3] = 1;
    body.number[i] = seeds[i].number;
    mass_sum += mass;
  }
  for (int c = 0; c < 3; ++c) body.totals.initial_velocity[c] = momentum[c] / mass_sum;
  body.initial_spin = vector_of(full.angular_velocity);

  if (rules.rigid() && grid.axisymmetric()) rules.cut[0] = 1;  // whole rings, which move along the axis alone
  if (rules.rigid()) make_rigid(grid, full, volume, kept, prefix, rules, body);
  // Both or neither, should memory fail.
  world->model.bodies.reserve(world->model.bodies.size() + 1);
  world->state.bodies.reserve(world->state.bodies.size() + 1);
  world->model.bodies.push_back(std::move(rules));
  world->state.bodies.push_back(std::move(body));
  return {static_cast<std::int32_t>(world->model.bodies.size()) - 1};
}

SolidDef solid_of(const ogive_solid_def* def) {
  const ogive_solid_def full = complete(def, "solid", ogive_solid_def_init);
  SolidDef solid;
  solid.shape = static_cast<SolidShape>(full.solid);
  solid.lattice = static_cast<Lattice>(full.lattice);
  solid.size = vector_of(full.size);
  solid.centre = vector_of(full.centre);
  solid.axis = vector_of(full.axis);
  solid.reference = vector_of(full.reference);
  solid.spacing = vector_of(full.spacing);
  return solid;
}

// Its particles in the world: in a two-dimensional model those of its section.
ParticleCloud fill_in(const Grid& grid, const SolidDef& solid) {
  return grid.planar() ? fill_section(grid, solid) : fill_solid(solid);
}

SurfaceDef surface_of(const SolidDef& solid) {
  SurfaceDef surface;
  surface.kind = static_cast<SurfaceKind>(solid.shape);
  surface.size = solid.size;
  surface.origin = solid.centre;
  surface.axes = solid_axes(solid);
  return surface;
}

// Two bodies overlap where they together fill a node's shape function clearly more than a solid can. Lattices fill a node
// to within some percent, so that bodies that only touch stay well below the limit.
void refuse_overlap(const Model& model, const State& state) {
  constexpr double limit = 1.35, least_share = 0.15;
  const double h = model.grid.cell_size;
  struct Bounds {
    Vector3 lower, upper;
  };
  std::vector<Bounds> bounds;
  for (const BodyState& body : state.bodies) {
    Bounds box;
    box.lower.fill(std::numeric_limits<double>::infinity());
    box.upper.fill(-std::numeric_limits<double>::infinity());
    for (std::int64_t p = 0; p < body.padded; ++p)
      for (int c = 0; c < 3; ++c) {
        box.lower[c] = std::min(box.lower[c], body.position[4 * p + c]);
        box.upper[c] = std::max(box.upper[c], body.position[4 * p + c]);
      }
    bounds.push_back(box);
  }
  // In the order of their lower ends along x, so that the work follows the bodies that are near each other.
  std::vector<int> order(bounds.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return bounds[a].lower[0] < bounds[b].lower[0]; });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t k = i + 1; k < order.size() && bounds[order[k]].lower[0] <= bounds[order[i]].upper[0] + 2 * h; ++k) {
      const int a = std::min(order[i], order[k]), b = std::max(order[i], order[k]);
      Vector3 lower, upper;
      bool apart = false;
      for (int c = 0; c < 3; ++c) {
        lower[c] = std::max(bounds[a].lower[c], bounds[b].lower[c]) - h;
        upper[c] = std::min(bounds[a].upper[c], bounds[b].upper[c]) + h;
        apart = apart || lower[c] > upper[c];
      }
      if (apart) continue;
      std::unordered_map<std::uint64_t, std::array<double, 2>> fill;
      for (int side = 0; side < 2; ++side) {
        const int index = side == 0 ? a : b;
        const BodyState& body = state.bodies[index];
        const Grid& grid = model.grid;
        const double density = model.material_of(index).density;
        for (std::int64_t p = 0; p < body.padded; ++p) {
          const double* x = &body.position[4 * p];
          if (x[3] == 0) continue;
          std::int64_t first[3];
          double f[3];
          bool outside = false;
          for (int c = 0; c < 3; ++c) {
            outside = outside || x[c] < lower[c] || x[c] > upper[c];
            const double xi = (x[c] - model.grid.domain_min[c]) / h;
            first[c] = static_cast<std::int64_t>(std::floor(xi));
            f[c] = xi - static_cast<double>(first[c]);
          }
          if (outside) continue;
          for (int n = 0; n < 8; ++n) {
            double weight = x[3] / density * (grid.planar() ? grid.section_share_at(x[0]) / (h * h) : 1 / (h * h * h));
            std::uint64_t key = 0;
            for (int c = 0; c < 3; ++c) {
              const int up = n >> c & 1;
              weight *= up ? f[c] : 1 - f[c];
              key = key << 21 | static_cast<std::uint64_t>(first[c] + up + 1000);
            }
            fill[key][side] += weight;
          }
        }
      }
      const std::pair<const std::uint64_t, std::array<double, 2>>* worst = nullptr;
      for (const auto& entry : fill) {
        const auto& share = entry.second;
        if (std::min(share[0], share[1]) < least_share || share[0] + share[1] < limit) continue;
        if (!worst || share[0] + share[1] > worst->second[0] + worst->second[1] ||
            (share[0] + share[1] == worst->second[0] + worst->second[1] && entry.first < worst->first))
          worst = &entry;
      }
      if (worst) {
        double x[3];
        for (int c = 0; c < 3; ++c)
          x[c] = model.grid.domain_min[c] +
                 h * (static_cast<double>(worst->first >> (21 * (2 - c)) & 0x1fffff) - 1000);
        refuse("bodies \"" + model.bodies[a].name + "\" and \"" + model.bodies[b].name +
               "\": must not overlap; both fill the space near " + place_text(x));
      }
    }
}

// ------------------------------------------------------------------------------------------------------------- fields

struct Field {
  const char* name;
  int components;
  bool settable;
};
const Field all_fields[] = {
    {"position", 3, true},       {"velocity", 3, true},     {"mass", 1, false},        {"volume", 1, false},
    {"stress", 6, true},         {"pressure", 1, false},    {"von_mises", 1, false},   {"energy", 1, true},
    {"plastic_strain", 1, true}, {"temperature", 1, true},  {"failed", 1, false},      {"number", 1, false},
    {"deformation_gradient", 9, true}, {"affine_velocity", 9, true}, {"volume_ratio", 1, true}, {"force", 3, true},
};

bool has_field(const ogive_world* world, int body, const Field& field) {
  const Model& model = world->model;
  const Material& material = model.material_of(body);
  const std::string name(field.name);
  if (model.bodies[body].rigid())
    return name == "position" || name == "velocity" || name == "mass" || name == "volume" || name == "number";
  if (name == "plastic_strain") return material.plastic();
  if (name == "temperature") return material.thermal();
  if (name == "failed") return material.failure != Failure::None;
  if (name == "deformation_gradient") return !world->state.bodies[body].deformation[0].empty();
  if (name == "affine_velocity") return !world->state.bodies[body].affine.empty();
  if (name == "force") return !world->state.bodies[body].force.empty();
  return true;
}

// Which components of a settable field must vanish in a two-dimensional model: a bit each.
int out_of_plane(const std::string& name) {
  if (name == "position" || name == "velocity" || name == "force") return 1 << 2;
  if (name == "stress") return 1 << 3 | 1 << 4;  // yz xz
  if (name == "affine_velocity") return 1 << 2 | 1 << 5 | 1 << 6 | 1 << 7 | 1 << 8;
  if (name == "deformation_gradient") return 1 << 2 | 1 << 5 | 1 << 6 | 1 << 7;
  return 0;
}

const Field& field_named(const ogive_world* world, ogive_body_id body, const char* name, bool to_set = false) {
  body_of(world, body);
  require_pointer(name, "name");
  const Material& material = world->model.material_of(body.index);
  for (const Field& field : all_fields)
    if (std::strcmp(field.name, name) == 0) {
      const bool can_come = to_set && std::strcmp(name, "force") == 0;
      if (!can_come && !has_field(world, body.index, field))
        refuse("field \"" + std::string(name) + "\": this world does not keep it for a body of material \"" + material.name + "\"");
      return field;
    }
  refuse("field: must be a name that ogive_field_name gives, got \"" + std::string(name) + "\"");
}

bool settable_in_reference(const char* name) {
  for (const char* const settable : {"velocity", "energy", "temperature", "force"})
    if (std::strcmp(name, settable) == 0) return true;
  return false;
}

void check_count(const BodyState& body, const Field& field, std::int64_t count) {
  if (count != body.particles * field.components)
    refuse("count: must be particles x components = " + std::to_string(body.particles * field.components) + ", got " +
           std::to_string(count));
}

// Calls put(rank of the particle, place) for each particle; the rank counts numbers in ascending order.
template <class Put>
void in_order_of_number(const BodyState& body, Put&& put) {
  const std::int32_t last = body.number.empty() ? -1 : *std::max_element(body.number.begin(), body.number.end());
  // Where some numbers are gone a particle's rank is how many smaller ones there are: whole words of 64, then bits in its own.
  std::vector<std::uint64_t> present;
  std::vector<std::int64_t> before;
  if (last >= body.particles) {
    present.resize(static_cast<std::size_t>(last) / 64 + 1);
    for (const std::int32_t n : body.number)
      if (n >= 0) present[static_cast<std::size_t>(n) / 64] |= std::uint64_t{1} << (n % 64);
    std::int64_t sum = 0;
    for (const std::uint64_t word : present) {
      before.push_back(sum);
      sum += std::popcount(word);
    }
  }
  for (std::int64_t p = 0; p < body.padded; ++p) {
    const std::int32_t n = body.number[p];
    if (n < 0) continue;
    const std::size_t word = static_cast<std::size_t>(n) / 64;
    put(present.empty() ? n : before[word] + std::popcount(present[word] & ((std::uint64_t{1} << (n % 64)) - 1)), p);
  }
}

// Values that a field may be set to.
void check_values(const Model& model, const Field& field, const double* values, std::int64_t count) {
  const std::string name(field.name);
  const bool not_negative = name == "plastic_strain" || name == "temperature", positive = name == "volume_ratio";
  for (std::int64_t i = 0; i < count; ++i) {
    const bool outside = (not_negative && values[i] < 0) || (positive && values[i] <= 0);
    if (!std::isfinite(values[i]) || outside)
      refuse("values[" + std::to_string(i) + "]: must be finite" + (positive ? " and > 0" : not_negative ? " and >= 0" : "") +
             ", got " + number_text(values[i]));
    const int axis = static_cast<int>(i % 3);
    if (model.grid.planar() && out_of_plane(name) >> i % field.components & 1 && values[i] != 0)
      refuse("values[" + std::to_string(i) + "]: must be 0 in a two-dimensional model, got " + number_text(values[i]));
    if (name == "position" && axis == 0 && model.grid.axisymmetric() && !(values[i] > 0))
      refuse("values[" + std::to_string(i) + "]: must be a radius > 0, got " + number_text(values[i]));
    if (name == "position" && (values[i] < model.grid.domain_min[axis] || values[i] > model.grid.domain_max[axis]))
      refuse("values[" + std::to_string(i) + "]: must lie inside the domain, " + number_text(model.grid.domain_min[axis]) +
             ".." + number_text(model.grid.domain_max[axis]) + ", got " + number_text(values[i]));
  }
  if (name == "deformation_gradient")
    for (std::int64_t i = 0; i < count; i += 9) {
      const double* f = values + i;
      const double determinant = f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
                                 f[2] * (f[3] * f[7] - f[4] * f[6]);
      if (!(determinant > 0))
        refuse("values[" + std::to_string(i) + "..]: the determinant must be > 0, got " + number_text(determinant));
    }
}

// Where the engine keeps a field; false if it is computed on demand.
bool view_field(const BodyState& body, const std::string& name, ogive_field_view& view) {
  const auto records = [&](const AlignedVector<double>& array, int components, int stride) {
    view.stride = stride;
    for (int c = 0; c < components; ++c) view.component[c] = array.data() + c;
  };
  const auto arrays = [&](const auto& list) {
    view.stride = 1;
    for (std::size_t c = 0; c < list.size(); ++c) view.component[c] = list[c].data();
  };
  if (name == "position") records(body.position, 3, 4);
  else if (name == "velocity") records(body.velocity, 3, 4);
  else if (name == "force") records(body.force, 3, 4);
  else if (name == "plastic_strain") records(body.plastic_strain, 1, 1);
  else if (name == "temperature") records(body.temperature, 1, 1);
  else if (name == "volume_ratio") records(body.volume_ratio, 1, 1);
  else if (name == "stress") arrays(body.stress);
  else if (name == "deformation_gradient") arrays(body.deformation);
  else if (name == "mass") {
    view.stride = 4;
    view.component[0] = body.position.data() + 3;
  } else if (name == "affine_velocity") {
    view.stride = affine_size;
    for (int c = 0; c < 9; ++c) view.component[c] = body.affine.data() + 3 * (c % 3) + c / 3;
  } else {
    return false;
  }
  return true;
}

// The field of all particles, ordered by number.
void copy_field(const Model& model, int body_index, const BodyState& body, const std::string& name, double* values) {
  const Material& material = model.material_of(body_index);
  const auto fill = [&](int components, auto&& value) {
    in_order_of_number(body, [&](std::int64_t rank, std::int64_t p) {
      for (int c = 0; c < components; ++c) values[components * rank + c] = value(p, c);
    });
  };
  const auto mass = [&](std::int64_t p) { return body.position[4 * p + 3]; };
  const auto pressure = [&](std::int64_t p) { return -(body.stress[0][p] + body.stress[1][p] + body.stress[2][p]) / 3; };
  if (name == "position") fill(3, [&](std::int64_t p, int c) { return body.position[4 * p + c]; });
  else if (name == "velocity") fill(3, [&](std::int64_t p, int c) { return body.velocity[4 * p + c]; });
  else if (name == "mass") fill(1, [&](std::int64_t p, int) { return mass(p); });
  else if (name == "volume")
    fill(1, [&](std::int64_t p, int) { return mass(p) / material.density * body.volume_ratio[p]; });
  else if (name == "stress") fill(6, [&](std::int64_t p, int c) { return body.stress[c][p]; });
  else if (name == "pressure") fill(1, [&](std::int64_t p, int) { return pressure(p); });
  else if (name == "von_mises")
    fill(1, [&](std::int64_t p, int) {
      double squared = 0;
      for (int i = 0; i < 3; ++i) squared += (body.stress[i][p] + pressure(p)) * (body.stress[i][p] + pressure(p));
      for (int i = 3; i < 6; ++i) squared += 2 * body.stress[i][p] * body.stress[i][p];
      return std::sqrt(1.5 * squared);
    });
  else if (name == "energy") fill(1, [&](std::int64_t p, int) { return mass(p) / material.density * body.energy[p]; });
  else if (name == "plastic_strain") fill(1, [&](std::int64_t p, int) { return body.plastic_strain[p]; });
  else if (name == "temperature") fill(1, [&](std::int64_t p, int) { return body.temperature[p]; });
  else if (name == "failed")
    fill(1, [&](std::int64_t p, int) { return body.plastic_strain[p] >= material.failure_strain ? 1.0 : 0.0; });
  else if (name == "number") fill(1, [&](std::int64_t p, int) { return static_cast<double>(body.number[p]); });
  else if (name == "volume_ratio") fill(1, [&](std::int64_t p, int) { return body.volume_ratio[p]; });
  else if (name == "force") fill(3, [&](std::int64_t p, int c) { return body.force[4 * p + c]; });
  else if (name == "deformation_gradient") fill(9, [&](std::int64_t p, int c) { return body.deformation[c][p]; });
  else
    fill(9, [&](std::int64_t p, int c) { return body.affine[affine_size * p + 3 * (c % 3) + c / 3]; });
}

// ------------------------------------------------------------------------------------------------------ save and load

class CallbackWriter : public Archive {
 public:
  explicit CallbackWriter(const ogive_writer& writer) : writer_(writer) {}
  bool loading() const override { return false; }
  void put(const std::string& name, ElementType type, std::int64_t count, const void* data) override {
    static const std::uint64_t nothing = 0;
    const ogive_status status =
        writer_.put(writer_.user, name.c_str(), static_cast<std::int32_t>(type), count, count > 0 ? data : &nothing);
    if (status != OGIVE_OK)
      throw Error(static_cast<ErrorKind>(status), "the writer refused \"" + name + "\": " + ogive_status_name(status));
  }

 protected:
  std::int64_t find(const std::string&, ElementType) override { return -1; }
  void get(const std::string&, std::int64_t, void*) override {}

 private:
  const ogive_writer& writer_;
};

class CallbackReader : public Archive {
 public:
  explicit CallbackReader(const ogive_reader& reader) : reader_(reader) {}
  bool loading() const override { return true; }
  std::int64_t find(const std::string& name, ElementType type) override {
    std::int32_t found_type = 0;
    std::int64_t count = -1;
    check(reader_.find(reader_.user, name.c_str(), &found_type, &count), name);
    if (found_type != static_cast<std::int32_t>(type))
      throw Error(ErrorKind::Format, name + ": expected element type " + std::to_string(static_cast<int>(type)) +
                                         ", found " + std::to_string(found_type));
    if (count < 0) throw Error(ErrorKind::Format, name + ": found a negative count");
    return count;
  }
  void get(const std::string& name, std::int64_t count, void* data) override {
    if (count > 0) check(reader_.get(reader_.user, name.c_str(), count, data), name);
  }

 protected:
  void put(const std::string&, ElementType, std::int64_t, const void*) override {}

 private:
  static void check(ogive_status status, const std::string& name) {
    if (status != OGIVE_OK)
      throw Error(static_cast<ErrorKind>(status), "\"" + name + "\" cannot be read: " + ogive_status_name(status));
  }
  const ogive_reader& reader_;
};

constexpr std::int64_t largest_attachment = std::int64_t{1} << 31;

void exchange_attachments(ogive_world* world, Archive& archive) {
  std::string names;
  for (const auto& entry : world->attachments) names += entry.first + "\n";
  archive.value("attachment_names", names);
  if (archive.loading()) {
    std::size_t begin = 0;
    for (std::size_t end; (end = names.find('\n', begin)) != std::string::npos; begin = end + 1)
      world->attachments[names.substr(begin, end - begin)];
  }
  for (auto& [name, data] : world->attachments) archive.resizable("attachment/" + name, data, largest_attachment);
}

}  // namespace

// ------------------------------------------------------------------------------------------------------------ interface

#define OGIVE_TEXT_OF(x) #x
#define OGIVE_TEXT(x) OGIVE_TEXT_OF(x)

const char* ogive_version(void) {
  return OGIVE_TEXT(OGIVE_VERSION_MAJOR) "." OGIVE_TEXT(OGIVE_VERSION_MINOR) "." OGIVE_TEXT(OGIVE_VERSION_PATCH);
}

const char* ogive_status_name(ogive_status status) {
  switch (status) {
    case OGIVE_OK: return "ok";
    case OGIVE_ERROR_ARGUMENT: return "bad argument";
    case OGIVE_ERROR_STATE: return "call in the wrong order";
    case OGIVE_ERROR_MEMORY: return "out of memory";
    case OGIVE_ERROR_NUMERICAL: return "numerical breakdown";
    case OGIVE_ERROR_FILE: return "file error";
    case OGIVE_ERROR_FORMAT: return "damaged or foreign file";
    case OGIVE_ERROR_INTERNAL: return "internal error";
    default: return "unknown status";
  }
}

int32_t ogive_abi_version(void) { return OGIVE_ABI; }

ogive_status ogive_world_create(ogive_world** world) {
  if (!world) return OGIVE_ERROR_ARGUMENT;
  *world = nullptr;
  try {
    *world = new ogive_world;
    return OGIVE_OK;
  } catch (const std::bad_alloc&) {
    return OGIVE_ERROR_MEMORY;
  }
}

void ogive_world_destroy(ogive_world* world) { delete world; }

const char* ogive_world_message(const ogive_world* world) { return world ? message_of(world) : ""; }

ogive_status ogive_world_report(ogive_world* world, ogive_status status, const char* message) {
  if (!world) return OGIVE_ERROR_ARGUMENT;
  if (status != OGIVE_OK) return fail(world, status, message ? message : "");
  set_message(world, message ? message : "");
  return status;
}

ogive_status ogive_world_set_log(ogive_world* world, ogive_log_callback callback, void* user) {
  return guarded(world, [&] {
    world->log = callback;
    world->log_user = callback ? user : nullptr;
  });
}

void ogive_grid_def_init(ogive_grid_def* def, size_t size) {
  ogive_grid_def defaults{};
  defaults.thickness = Grid{}.thickness;
  initialise(def, size, defaults);
}

ogive_status ogive_world_set_grid(ogive_world* world, const ogive_grid_def* def) {
  return guarded(world, [&] {
    require_stage(world, Stage::Building, "ogive_world_set_grid");
    if (!world->model.bodies.empty())
      throw Error(ErrorKind::State, "ogive_world_set_grid: must come before the bodies, which it cuts");
    const ogive_grid_def full = complete(def, "def", ogive_grid_def_init);
    Model trial;
    trial.grid.cell_size = full.cell_size;
    trial.grid.domain_min = vector_of(full.domain_min);
    trial.grid.domain_max = vector_of(full.domain_max);
    for (int i = 0; i < 6; ++i) trial.grid.face[i] = static_cast<Face>(full.face[i]);
    trial.grid.space = static_cast<WorldSpace>(full.space);
    trial.grid.thickness = full.thickness;
    trial.grid.lay_in_plane();
    trial.validate_grid();
    world->model.grid = trial.grid;
    world->has_grid = true;
  });
}

void ogive_numerics_def_init(ogive_numerics_def* def, size_t size) {
  ogive_numerics_def defaults{};
  const Numerics numerics;
  defaults.shape_function = static_cast<std::int32_t>(numerics.shape_function);
  defaults.time_step_factor = numerics.time_step_factor;
  defaults.maximum_time_step = numerics.maximum_time_step;
  defaults.threads = 1;
  defaults.transfer = static_cast<std::int32_t>(numerics.transfer);
  defaults.update_order = static_cast<std::int32_t>(numerics.update_order);
  defaults.pic_fraction = numerics.pic_fraction;
  defaults.xpic_order = numerics.xpic_order;
  defaults.energy_warning = numerics.energy_warning;
  defaults.energy_limit = numerics.energy_limit;
  defaults.energy_loss_limit = numerics.energy_loss_limit;
  defaults.drop_debris = numerics.drop_debris;
  defaults.skip_resting = numerics.skip_resting;
  initialise(def, size, defaults);
}

ogive_status ogive_world_set_numerics(ogive_world* world, const ogive_numerics_def* def) {
  return guarded(world, [&] {
    Model& model = changeable(world, "ogive_world_set_numerics");
    const ogive_numerics_def full = complete(def, "def", ogive_numerics_def_init);
    Model trial;
    trial.numerics.shape_function = static_cast<ShapeFunction>(full.shape_function);
    trial.numerics.time_step_factor = full.time_step_factor;
    trial.numerics.maximum_time_step = full.maximum_time_step;
    trial.numerics.gravity = vector_of(full.gravity);
    trial.numerics.transfer = static_cast<Transfer>(full.transfer);
    trial.numerics.update_order = static_cast<UpdateOrder>(full.update_order);
    trial.numerics.pic_fraction = full.pic_fraction;
    trial.numerics.xpic_order = full.xpic_order;
    trial.numerics.energy_warning = full.energy_warning;
    trial.numerics.energy_limit = full.energy_limit;
    trial.numerics.energy_loss_limit = full.energy_loss_limit;
    if (full.drop_debris != 0 && full.drop_debris != 1)
      refuse("drop_debris: must be 0 or 1, got " + std::to_string(full.drop_debris));
    trial.numerics.drop_debris = full.drop_debris != 0;
    if (full.skip_resting != 0 && full.skip_resting != 1)
      refuse("skip_resting: must be 0 or 1, got " + std::to_string(full.skip_resting));
    trial.numerics.skip_resting = full.skip_resting == 1;
    trial.validate_numerics();
    set_threads(world, full.threads);
    model.numerics = trial.numerics;
  });
}

ogive_status ogive_world_set_threads(ogive_world* world, int32_t threads) {
  return guarded(world, [&] { set_threads(world, threads); });
}

void ogive_clamp_def_init(ogive_clamp_def* def, size_t size) {
  ogive_clamp_def defaults{};
  defaults.body.index = -1;
  defaults.axes = 7;
  initialise(def, size, defaults);
}

ogive_status ogive_clamp_add(ogive_world* world, const ogive_clamp_def* def) {
  return guarded(world, [&] {
    require_stage(world, Stage::Building, "ogive_clamp_add");
    const ogive_clamp_def full = complete(def, "def", ogive_clamp_def_init);
    Clamp clamp;
    clamp.region = static_cast<Region>(full.region);
    clamp.a = vector_of(full.a);
    clamp.b = vector_of(full.b);
    clamp.radius = full.radius;
    clamp.body = full.body.index;
    clamp.axes = full.axes;
    world->model.validate_clamp(clamp);
    world->model.clamps.push_back(clamp);
  });
}

void ogive_load_def_init(ogive_load_def* def, size_t size) {
  ogive_load_def defaults{};
  defaults.region = OGIVE_REGION_EVERYWHERE;
  defaults.body.index = -1;
  defaults.axes = 7;
  initialise(def, size, defaults);
}

static Vector3 load_value(const ogive_world* world, const double* value) {
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(value[c])) refuse("load value[" + std::to_string(c) + "]: must be finite, got " + std::to_string(value[c]));
  if (world->model.grid.planar() && value[2] != 0)
    refuse("load value[z]: must be 0 in a two-dimensional model, got " + number_text(value[2]));
  return {value[0], value[1], value[2]};
}

ogive_status ogive_load_add(ogive_world* world, const ogive_load_def* def, ogive_load_id* id) {
  return guarded(world, [&] {
    require_stage(world, Stage::Building, "ogive_load_add");
    const ogive_load_def full = complete(def, "def", ogive_load_def_init);
    Load load;
    load.kind = static_cast<LoadKind>(full.kind);
    load.region = static_cast<Region>(full.region);
    load.a = vector_of(full.a);
    load.b = vector_of(full.b);
    load.radius = full.radius;
    load.body = full.body.index;
    load.axes = full.axes;
    load.area = full.area;
    require_body_or_none(world, full.body, "load body");
    world->model.validate_load(load);
    LoadState present;
    present.value = load_value(world, full.value);
    // Both or neither, should memory fail.
    world->model.loads.reserve(world->model.loads.size() + 1);
    world->state.loads.reserve(world->state.loads.size() + 1);
    world->model.loads.push_back(load);
    world->state.loads.push_back(present);
    if (id) id->index = static_cast<std::int32_t>(world->model.loads.size()) - 1;
  });
}

static LoadState& load_of(const ogive_world* world, ogive_load_id id) {
  auto& loads = const_cast<ogive_world*>(world)->state.loads;
  if (id.index < 0 || id.index >= static_cast<std::int32_t>(loads.size()))
    refuse("load: must be 0.." + std::to_string(static_cast<int>(loads.size()) - 1) + ", got " + std::to_string(id.index));
  return loads[static_cast<std::size_t>(id.index)];
}

ogive_status ogive_load_set(ogive_world* world, ogive_load_id load, const double* value) {
  return guarded(world, [&] {
    LoadState& present = load_of(world, load);
    require_pointer(value, "value");
    present.value = load_value(world, value);
  });
}

ogive_status ogive_load_result_get(const ogive_world* world, ogive_load_id load, ogive_load_result* result) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_load_result_get");
    const LoadState& present = load_of(world, load);
    ogive_load_result full{};
    for (int c = 0; c < 3; ++c) {
      full.value[c] = present.value[c];
      full.force[c] = present.force[c];
      full.impulse[c] = present.impulse[c];
    }
    full.work = present.work;
    deliver(full, result, "result");
  });
}

ogive_status ogive_pair_result_get(const ogive_world* world, ogive_body_id a, ogive_body_id b, ogive_pair_result* result) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_pair_result_get");
    body_of(world, a);
    body_of(world, b);
    if (a.index == b.index) refuse("pair: must be two bodies, got body " + std::to_string(a.index) + " twice");
    ogive_pair_result full{};
    for (const PairTotals& pair : world->state.pairs) {
      if (pair.a != std::min(a.index, b.index) || pair.b != std::max(a.index, b.index)) continue;
      const double sign = pair.a == a.index ? 1 : -1;
      for (int c = 0; c < 3; ++c) {
        full.force[c] = sign * pair.force[c];
        full.impulse[c] = sign * pair.impulse[c];
      }
      full.friction_dissipation = pair.friction_dissipation;
      full.contact_work = pair.contact_work;
    }
    deliver(full, result, "result");
  });
}

void ogive_material_def_init(ogive_material_def* def, size_t size) {
  const Material defaults;
  ogive_material_def full{};
  full.hardening_exponent = defaults.hardening_exponent;
  full.reference_strain_rate = defaults.reference_strain_rate;
  full.room_temperature = defaults.room_temperature;
  full.taylor_quinney = defaults.taylor_quinney;
  full.isotropic_fraction = defaults.isotropic_fraction;
  initialise(def, size, full);
}

static Material material_from(const std::string& name, const ogive_material_def* def) {
  const ogive_material_def d = complete(def, "def", ogive_material_def_init);
  Material m;
  m.name = name;
  m.strength = static_cast<Strength>(d.strength);
  m.eos = static_cast<EquationOfState>(d.eos);
  m.failure = static_cast<Failure>(d.failure);
  m.density = d.density;
  m.youngs_modulus = d.youngs_modulus;
  m.poisson_ratio = d.poisson_ratio;
  m.bulk_modulus = d.bulk_modulus;
  m.shear_modulus = d.shear_modulus;
  m.yield_stress = d.yield_stress;
  m.hardening_modulus = d.hardening_modulus;
  m.hardening_exponent = d.hardening_exponent;
  m.rate_coefficient = d.rate_coefficient;
  m.reference_strain_rate = d.reference_strain_rate;
  m.thermal_exponent = d.thermal_exponent;
  m.melt_temperature = d.melt_temperature;
  m.room_temperature = d.room_temperature;
  m.specific_heat = d.specific_heat;
  m.taylor_quinney = d.taylor_quinney;
  m.eos_sound_speed = d.eos_sound_speed;
  m.eos_slope = d.eos_slope;
  m.gruneisen = d.gruneisen;
  m.failure_strain = d.failure_strain;
  m.viscosity_linear = d.viscosity_linear;
  m.viscosity_quadratic = d.viscosity_quadratic;
  m.isotropic_fraction = d.isotropic_fraction;
  try {
    m.validate();
  } catch (const Error& error) {
    throw Error(error.kind(), "material \"" + m.name + "\": " + error.what());
  }
  return m;
}

ogive_status ogive_material_add(ogive_world* world, const char* name, const ogive_material_def* def,
                                ogive_material_id* id) {
  return guarded(world, [&] {
    require_stage(world, Stage::Building, "ogive_material_add");
    const std::string material_name = checked_name(name, "material");
    for (const Material& other : world->model.materials)
      if (other.name == material_name) refuse("material \"" + material_name + "\": name is already taken");
    world->model.materials.push_back(material_from(material_name, def));
    if (id) id->index = static_cast<std::int32_t>(world->model.materials.size()) - 1;
  });
}

ogive_status ogive_material_change(ogive_world* world, ogive_material_id id, const ogive_material_def* def) {
  return guarded(world, [&] {
    require_stage(world, Stage::Reopened, "ogive_material_change");
    if (id.index < 0 || id.index >= static_cast<std::int32_t>(world->model.materials.size()))
      refuse("material: must be 0.." + std::to_string(static_cast<int>(world->model.materials.size()) - 1) + ", got " +
             std::to_string(id.index));
    Material& material = world->changed->materials[static_cast<std::size_t>(id.index)];
    material = material_from(material.name, def);
  });
}

void ogive_body_def_init(ogive_body_def* def, size_t size) {
  ogive_body_def defaults{};
  defaults.material.index = -1;
  defaults.distortion_limit = Body{}.distortion_limit;
  initialise(def, size, defaults);
}

ogive_status ogive_body_add_particles(ogive_world* world, const char* name, const ogive_body_def* def, int64_t count,
                                      const double* xyz, const double* volume, ogive_body_id* id) {
  return guarded(world, [&] {
    const ogive_body_id added = add_particles(world, name, def, count, xyz, volume);
    if (id) *id = added;
  });
}

void ogive_solid_def_init(ogive_solid_def* def, size_t size) {
  ogive_solid_def defaults{};
  defaults.axis[2] = 1;
  initialise(def, size, defaults);
}

ogive_status ogive_body_add_solid(ogive_world* world, const char* name, const ogive_body_def* def,
                                  const ogive_solid_def* solid, ogive_body_id* id) {
  return guarded(world, [&] {
    const ParticleCloud cloud = fill_in(world->model.grid, solid_of(solid));
    const ogive_body_id added = add_particles(world, name, def, static_cast<std::int64_t>(cloud.volume.size()),
                                              cloud.xyz.data(), cloud.volume.data());
    world->model.bodies[added.index].surface = surface_of(solid_of(solid));
    if (id) *id = added;
  });
}

ogive_status ogive_body_set_surface(ogive_world* world, ogive_body_id body, int64_t vertex_count, const double* xyz,
                                    int64_t triangle_count, const int32_t* corners) {
  return guarded(world, [&] {
    require_stage(world, Stage::Building, "ogive_body_set_surface");
    body_of(world, body);
    constexpr std::int64_t most = std::int64_t{1} << 29;
    if (vertex_count < 4 || vertex_count > most)
      refuse("vertex_count: must be 4.." + std::to_string(most) + ", got " + std::to_string(vertex_count));
    if (triangle_count < 4 || triangle_count > most)
      refuse("triangle_count: must be 4.." + std::to_string(most) + ", got " + std::to_string(triangle_count));
    require_pointer(xyz, "xyz");
    require_pointer(corners, "corners");
    SurfaceDef surface;
    surface.kind = SurfaceKind::Triangles;
    surface.vertices.assign(xyz, xyz + 3 * vertex_count);
    surface.corners.assign(corners, corners + 3 * triangle_count);
    check_triangles(surface.vertices, surface.corners);
    world->model.bodies[body.index].surface = std::move(surface);
  });
}

ogive_status ogive_body_set_surface_solid(ogive_world* world, ogive_body_id body, const ogive_solid_def* solid) {
  return guarded(world, [&] {
    require_stage(world, Stage::Building, "ogive_body_set_surface_solid");
    body_of(world, body);
    SolidDef def = solid_of(solid);
    def.lattice = Lattice::Cartesian;
    def.spacing = {1, 1, 1};
    exact_volume(def);
    world->model.bodies[body.index].surface = surface_of(def);
  });
}

ogive_status ogive_solid_particles(ogive_world* world, const ogive_solid_def* solid, int64_t* count, double* xyz,
                                   double* volume) {
  return guarded(world, [&] {
    require_pointer(count, "count");
    const ParticleCloud cloud = fill_in(world->model.grid, solid_of(solid));
    const std::int64_t found = static_cast<std::int64_t>(cloud.volume.size());
    if (xyz || volume) {
      if (*count < found)
        refuse("count: must give room for " + std::to_string(found) + " particles, got " + std::to_string(*count));
      if (xyz) std::copy(cloud.xyz.begin(), cloud.xyz.end(), xyz);
      if (volume) std::copy(cloud.volume.begin(), cloud.volume.end(), volume);
    }
    *count = found;
  });
}

void ogive_contact_def_init(ogive_contact_def* def, size_t size) {
  const ContactRule rule;
  ogive_contact_def defaults{};
  defaults.method = static_cast<std::int32_t>(rule.method);
  defaults.normal = static_cast<std::int32_t>(rule.normal);
  defaults.master.index = -1;
  defaults.detection = static_cast<std::int32_t>(rule.detection);
  defaults.gap_offset = rule.gap_offset;
  initialise(def, size, defaults);
}

static ContactRule rule_from(const ogive_world* world, const ogive_contact_def& full) {
  ContactRule rule;
  rule.method = static_cast<ContactMethod>(full.method);
  rule.normal = static_cast<NormalRule>(full.normal);
  require_body_or_none(world, full.master, "master");
  rule.master = full.master.index;
  rule.friction = full.friction;
  rule.detection = static_cast<Detection>(full.detection);
  rule.gap_offset = full.gap_offset;
  world->model.validate_contact(rule, "contact ");
  return rule;
}

ogive_status ogive_world_set_contact(ogive_world* world, const ogive_contact_def* def) {
  return guarded(world, [&] {
    Model& model = changeable(world, "ogive_world_set_contact");
    const ogive_contact_def full = complete(def, "def", ogive_contact_def_init);
    model.contact = rule_from(world, full);
  });
}

ogive_status ogive_contact_set_pair(ogive_world* world, ogive_body_id a, ogive_body_id b, const ogive_contact_def* def) {
  return guarded(world, [&] {
    Model& model = changeable(world, "ogive_contact_set_pair");
    body_of(world, a);
    body_of(world, b);
    if (a.index == b.index) refuse("contact pair: must be two bodies, got body " + std::to_string(a.index) + " twice");
    PairRule pair;
    pair.a = a.index;
    pair.b = b.index;
    pair.rule = rule_from(world, complete(def, "def", ogive_contact_def_init));
    model.set_pair(pair);
  });
}

int32_t ogive_contact_method_count(void) { return contact_method_count(); }

const char* ogive_contact_method_name(int32_t method) {
  if (method < 0 || method >= contact_method_count()) return nullptr;
  return contact_method(static_cast<ContactMethod>(method)).name;
}

int32_t ogive_contact_normal_count(void) { return normal_rule_count(); }

const char* ogive_contact_normal_name(int32_t normal) {
  if (normal < 0 || normal >= normal_rule_count()) return nullptr;
  return normal_rule(static_cast<NormalRule>(normal)).name;
}

void ogive_wall_def_init(ogive_wall_def* def, size_t size) {
  const ContactRule rule;
  ogive_wall_def defaults{};
  defaults.method = static_cast<std::int32_t>(rule.method);
  defaults.normal[2] = 1;
  defaults.detection = static_cast<std::int32_t>(rule.detection);
  defaults.gap_offset = rule.gap_offset;
  initialise(def, size, defaults);
}

ogive_status ogive_wall_add(ogive_world* world, const ogive_wall_def* def) {
  return guarded(world, [&] {
    require_stage(world, Stage::Building, "ogive_wall_add");
    const ogive_wall_def full = complete(def, "def", ogive_wall_def_init);
    Wall wall;
    wall.point = vector_of(full.point);
    wall.normal = vector_of(full.normal);
    for (const double c : wall.normal)
      if (!std::isfinite(c)) refuse("wall normal: must be finite, got " + std::to_string(c));
    if (!make_unit(wall.normal)) refuse("wall normal: must be a direction that is not zero");
    wall.rule.method = static_cast<ContactMethod>(full.method);
    wall.rule.friction = full.friction;
    wall.rule.detection = static_cast<Detection>(full.detection);
    wall.rule.gap_offset = full.gap_offset;
    world->model.validate_wall(wall);
    world->model.walls.push_back(wall);
  });
}

ogive_status ogive_body_set_motion(ogive_world* world, ogive_body_id body, int32_t count, const double* time,
                                   const double* velocity, const double* angular_velocity) {
  return guarded(world, [&] {
    if (world->stage != Stage::Ready) require_stage(world, Stage::Building, "ogive_body_set_motion");
    body_of(world, body);
    Body& rules = world->model.bodies[body.index];
    const std::string prefix = "body \"" + rules.name + "\": ";
    if (!rules.prescribed()) refuse(prefix + "motion: needs the formulation OGIVE_FORMULATION_RIGID_PRESCRIBED");
    if (count < 1 || count > 1000000) refuse(prefix + "motion count: must be 1..1000000, got " + std::to_string(count));
    require_pointer(time, "time");
    std::vector<MotionKnot> motion(static_cast<std::size_t>(count));
    for (std::int32_t i = 0; i < count; ++i) {
      motion[i].time = time[i];
      for (int c = 0; c < 3; ++c) {
        motion[i].velocity[c] = velocity ? velocity[3 * i + c] : 0;
        motion[i].angular_velocity[c] = angular_velocity ? angular_velocity[3 * i + c] : 0;
      }
    }
    try {
      world->model.validate_motion(motion);
    } catch (const Error& error) {
      throw Error(error.kind(), prefix + error.what());
    }
    rules.motion.swap(motion);
  });
}

void ogive_stop_def_init(ogive_stop_def* def, size_t size) {
  ogive_stop_def defaults{};
  defaults.body.index = -1;
  defaults.stop_when_stopped = defaults.stop_when_out = 1;
  defaults.exchange_tolerance = Stop{}.exchange_tolerance;
  initialise(def, size, defaults);
}

ogive_status ogive_world_set_stop(ogive_world* world, const ogive_stop_def* def) {
  return guarded(world, [&] {
    Model& model = changeable(world, "ogive_world_set_stop");
    const ogive_stop_def full = complete(def, "def", ogive_stop_def_init);
    require_body_or_none(world, full.body, "stop body");
    Stop stop;
    stop.body = full.body.index;
    stop.settle_window = full.settle_window;
    stop.settle_tolerance = full.settle_tolerance;
    stop.when_stopped = full.stop_when_stopped != 0;
    stop.when_out = full.stop_when_out != 0;
    stop.exchange_window = full.exchange_window;
    stop.exchange_tolerance = full.exchange_tolerance;
    model.validate_stop(stop);
    model.stop = stop;
  });
}

static void require_not_advancing(const ogive_world* world, const char* call) {
  if (world->advancing)
    throw Error(ErrorKind::State, std::string(call) + ": not allowed in a callback of ogive_world_advance");
}

// Ends the changes of a reopened world.
static void prepare_changed(ogive_world* world) {
  Model next = *world->changed;
  next.complete();
  require_consistent_change(world->model, next, world->state);
  adapt_state(world->model, next, world->state);
  // Should the next lines want memory, the same call can be made again: nothing is adapted twice.
  std::swap(world->model, next);
  prepare_state(world->model, world->state, world->workspace);
  world->changed.reset();
}

ogive_status ogive_world_reopen(ogive_world* world) {
  return guarded(world, [&] {
    require_stage(world, Stage::Ready, "ogive_world_reopen");
    require_not_advancing(world, "ogive_world_reopen");
    world->changed = std::make_unique<Model>(world->model);
    world->stage = Stage::Reopened;
  });
}

ogive_status ogive_world_prepare(ogive_world* world) {
  return guarded(world, [&] {
    if (world->stage == Stage::Reopened) {
      prepare_changed(world);
    } else {
      require_stage(world, Stage::Building, "ogive_world_prepare");
      if (!world->has_grid)
        throw Error(ErrorKind::State, "ogive_world_prepare: the grid must be set (ogive_world_set_grid)");
      world->model.complete();
      if (!contact_needs(world->model).surface)
        for (Body& body : world->model.bodies) body.surface = {};  // no rule asks for it
      refuse_overlap(world->model, world->state);
      select_loaded_particles(world->model, world->state);
      for (const LoadState& load : world->state.loads) load_value(world, load.value.data());  // the grid may be newer
      for (std::size_t i = 0; i < world->model.loads.size(); ++i)
        if (world->model.loads[i].kind == LoadKind::Traction && !(world->state.loads[i].mass > 0))
          refuse("load " + std::to_string(i) +
                 ": a traction must meet particles of its body, and none lies in the region");
      prepare_state(world->model, world->state, world->workspace);
      world->state.ledger.initial_total = total_energy(world->model, world->state);
      check_stop(world->model, world->state);
    }
    const std::string plan = world->log ? describe_plan(world->model, world->state, world->workspace) : "";
    world->stage = Stage::Ready;
    tell_prepared(world, "prepared", plan);
  });
}

ogive_status ogive_world_plan(const ogive_world* world, char* text, size_t capacity, size_t* needed) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_world_plan");
    copy_text(describe_plan(world->model, world->state, world->workspace), text, capacity, needed);
  });
}

ogive_status ogive_world_stable_time_step(const ogive_world* world, double* dt) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_world_stable_time_step");
    require_pointer(dt, "dt");
    *dt = world->state.stable_time_step;
  });
}

static void tell_events(ogive_world* world, const std::vector<BodyTotals>& before, std::int32_t stop_before) {
  for (std::size_t b = 0; b < before.size(); ++b) {
    const BodyTotals& now = world->state.bodies[b].totals;
    const auto first = [&](std::int32_t level, const char* what) {
      tell(world, level, ("body \"" + world->model.bodies[b].name + "\": " + what + " at time " +
                          std::to_string(world->state.time) + ", step " + std::to_string(world->state.steps)).c_str());
    };
    if (before[b].failed_particles == 0 && now.failed_particles > 0) first(OGIVE_LOG_INFO, "first failed particle");
    if (before[b].left.particles == 0 && now.left.particles > 0)
      first(OGIVE_LOG_WARNING, "first particle that leaves the domain");
    if (before[b].dropped.particles == 0 && now.dropped.particles > 0) first(OGIVE_LOG_INFO, "first debris dropped");
  }
  static const char* const reasons[] = {"", "settled", "stopped", "out", "exchange ended"};
  if (stop_before == 0 && world->state.stop.reason != 0)
    tell(world, OGIVE_LOG_INFO, (std::string("stop condition met: ") + reasons[world->state.stop.reason]).c_str());
}

static void step_or_break(ogive_world* world, double dt) {
  std::vector<BodyTotals> before;
  if (world->log)
    for (const BodyState& body : world->state.bodies) before.push_back(body.totals);
  const std::int32_t stop_before = world->state.stop.reason;
  world->audits.clear();
  bool warned = false;
  try {
    world->workspace.changing = false;
    advance_one_step(world->model, world->state, world->workspace, dt);
    // The stop condition looks at every tenth step: one pass over its body costs next to nothing then.
    if (world->state.steps % 10 == 0) check_stop(world->model, world->state);
    warned = watch_energy(world->model, world->state, world->workspace.threads);
  } catch (const std::bad_alloc&) {
    if (world->workspace.changing) world->stage = Stage::Broken;
    throw;
  } catch (...) {
    world->stage = Stage::Broken;
    throw;
  }
  if (world->log) tell_events(world, before, stop_before);
  if (warned)
    tell(world, OGIVE_LOG_WARNING,
         ("the energy has grown by " + std::to_string(100 * world->state.energy_watch.largest_growth) + " % at time " +
          std::to_string(world->state.time) + "; probable cause: " + probable_cause(world->model, world->state)).c_str());
}

ogive_status ogive_world_step(ogive_world* world, double dt) {
  return guarded(world, [&] {
    require_stage(world, Stage::Ready, "ogive_world_step");
    require_not_advancing(world, "ogive_world_step");
    const double stable = world->state.stable_time_step;
    if (!(dt >= 0 && dt <= stable * (1 + 1e-12)))
      refuse("dt: must be 0..stable time step = " + number_text(stable) + ", got " + number_text(dt));
    if (world->state.particle_count() == 0) throw Error(ErrorKind::State, "ogive_world_step: no particle is left");
    step_or_break(world, dt > 0 ? dt : stable);
  });
}

ogive_status ogive_world_advance(ogive_world* world, double time, int64_t max_steps, ogive_step_callback callback,
                                 void* user) {
  return guarded(world, [&] {
    require_stage(world, Stage::Ready, "ogive_world_advance");
    require_not_advancing(world, "ogive_world_advance");
    if (!(time >= world->state.time && std::isfinite(time)))
      refuse("time: must be finite and at least the present time " + number_text(world->state.time) + ", got " +
             number_text(time));
    if (max_steps < 0) refuse("max_steps: must be >= 0, got " + std::to_string(max_steps));
    for (std::int64_t n = 0; (max_steps == 0 || n < max_steps) && world->state.time < time; ++n) {
      if (world->state.stop.reason != 0 || world->state.particle_count() == 0) break;
      const double left = time - world->state.time;
      const bool last = world->state.stable_time_step >= left;
      step_or_break(world, last ? left : world->state.stable_time_step);
      if (last) world->state.time = time;
      if (!callback) continue;
      world->advancing = true;
      const bool enough = callback(world, user) != 0;
      world->advancing = false;
      if (enough) break;
    }
  });
}

ogive_status ogive_world_progress(const ogive_world* world, ogive_progress* progress) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_world_progress");
    ogive_progress full{};
    full.stop = world->state.stop.reason;
    full.time = world->state.time;
    full.last_time_step = world->state.last_time_step;
    full.steps = world->state.steps;
    full.particles = world->state.particle_count();
    full.particle_steps = world->state.particle_steps;
    full.resting_particle_steps = world->state.resting_particle_steps;
    full.memory_bytes = world->state.memory_bytes() + world->workspace.memory_bytes();
    deliver(full, progress, "progress");
  });
}

ogive_status ogive_world_ledger(const ogive_world* world, ogive_ledger* ledger) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_world_ledger");
    const State& state = world->state;
    ogive_ledger full{};
    full.time = state.time;
    for (int b = 0; b < static_cast<int>(state.bodies.size()); ++b) {
      const BodyAudit& audit = audit_of(world, b);
      const BodyTotals& totals = state.bodies[b].totals;
      full.mass += audit.mass;
      full.kinetic += audit.kinetic;
      full.internal += audit.internal;
      full.left_domain_mass += totals.left.mass;
      full.left_domain_energy += totals.left.energy;
      full.dropped_mass += totals.dropped.mass;
      full.dropped_energy += totals.dropped.energy;
      full.failure_loss += totals.failure_loss;
      full.plastic_dissipation += totals.plastic_dissipation;
      full.viscous_dissipation += totals.viscous_dissipation;
      for (int c = 0; c < 3; ++c) {
        full.momentum[c] += audit.momentum[c];
        full.angular_momentum[c] += audit.angular_momentum[c];
        full.left_domain_momentum[c] += totals.left.momentum[c];
        full.dropped_momentum[c] += totals.dropped.momentum[c];
        full.dropped_angular_momentum[c] += totals.dropped_angular_momentum[c];
      }
      full.maximum_speed = std::max(full.maximum_speed, totals.maximum_speed);
      full.maximum_speed_ever = std::max(full.maximum_speed_ever, totals.maximum_speed_ever);
    }
    for (int c = 0; c < 3; ++c) {
      full.boundary_impulse[c] = state.ledger.boundary_impulse[c];
      full.external_impulse[c] = state.ledger.external_impulse[c];
      full.contact_couple[c] = world->model.grid.axisymmetric() ? 0 : state.ledger.contact_couple[c];
    }
    full.friction_dissipation = state.ledger.friction_dissipation;
    full.transfer_dissipation = state.ledger.transfer_dissipation;
    full.contact_work = state.ledger.contact_work;
    full.boundary_work = state.ledger.boundary_work;
    full.external_work = state.ledger.external_work;
    full.contact_dissipation = state.ledger.contact_dissipation;
    full.prescribed_work = state.ledger.prescribed_work;
    full.initial_total = state.ledger.initial_total;
    full.total = full.kinetic + full.internal + full.failure_loss + full.left_domain_energy + full.dropped_energy +
                 booked_energy(state.ledger);
    full.residual = full.total - full.initial_total;
    full.residual_relative = full.initial_total != 0 ? full.residual / full.initial_total : 0;
    const double growth = energy_growth(world->model, state, world->workspace.threads);
    full.energy_unaccounted = growth;
    const bool larger = growth > state.energy_watch.largest_growth;
    full.energy_growth = larger ? growth : state.energy_watch.largest_growth;
    full.energy_growth_time = larger ? state.time : state.energy_watch.largest_growth_time;
    full.energy_warning_time = state.energy_watch.warning_time;
    if (full.energy_warning_time < 0 && growth > world->model.numerics.energy_warning) full.energy_warning_time = state.time;
    deliver(full, ledger, "ledger");
  });
}

ogive_status ogive_world_check_energy(const ogive_world* world) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_world_check_energy");
    check_energy(world->model, world->state, energy_growth(world->model, world->state, world->workspace.threads));
  });
}

int32_t ogive_body_count(const ogive_world* world) {
  return world ? static_cast<std::int32_t>(world->model.bodies.size()) : 0;
}

const char* ogive_body_name(const ogive_world* world, ogive_body_id body) {
  if (!world || body.index < 0 || body.index >= ogive_body_count(world)) return nullptr;
  return world->model.bodies[body.index].name.c_str();
}

ogive_status ogive_body_find(const ogive_world* world, const char* name, ogive_body_id* body) {
  return guarded(world, [&] {
    require_pointer(name, "name");
    require_pointer(body, "body");
    for (std::int32_t b = 0; b < ogive_body_count(world); ++b)
      if (world->model.bodies[b].name == name) {
        body->index = b;
        return;
      }
    refuse("body: none is named \"" + std::string(name) + "\"");
  });
}

ogive_status ogive_body_result_get(const ogive_world* world, ogive_body_id id, ogive_body_result* result) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_body_result_get");
    const BodyState& body = body_of(world, id);
    const BodyAudit& audit = audit_of(world, id.index);
    const BodyTotals& totals = body.totals;
    ogive_body_result full{};
    full.particles = body.particles;
    full.failed_particles = totals.failed_particles;
    full.left_domain = totals.left.particles;
    full.dropped_particles = totals.dropped.particles;
    full.dropped_mass = totals.dropped.mass;
    full.mass = audit.mass;
    full.failed_mass = totals.failed_mass;
    full.left_domain_mass = totals.left.mass;
    full.first_failure_time = totals.first_failure_time;
    full.failure_loss = totals.failure_loss;
    full.kinetic = audit.kinetic;
    full.internal = audit.internal;
    for (int c = 0; c < 3; ++c) {
      full.momentum[c] = audit.momentum[c];
      full.centre[c] = audit.mass > 0 ? audit.first_moment[c] / audit.mass : 0;
      full.velocity[c] = audit.mass > 0 ? audit.momentum[c] / audit.mass : 0;
      if (c == 0 && world->model.grid.axisymmetric()) full.centre[c] = full.velocity[c] = 0;  // of the whole body
      full.speed += full.velocity[c] * full.velocity[c];
      full.initial_speed += totals.initial_velocity[c] * totals.initial_velocity[c];
      full.contact_force[c] = totals.contact_force[c];
      full.lower[c] = audit.lower[c];
      full.upper[c] = audit.upper[c];
    }
    const Vector3 about_centre = world->model.grid.axisymmetric()
                                     ? Vector3{}
                                     : minus(audit.angular_momentum, cross(vector_of(full.centre), audit.momentum));
    for (int c = 0; c < 3; ++c) {
      full.angular_momentum[c] = about_centre[c];
      full.angular_velocity[c] = body.rigid.spin[c];
    }
    full.speed = std::sqrt(full.speed);
    full.initial_speed = std::sqrt(full.initial_speed);
    full.maximum_plastic_strain = audit.maximum_plastic_strain;
    full.maximum_temperature = audit.maximum_temperature;
    const Formulation given = world->model.bodies[id.index].formulation;
    const bool updated = given == Formulation::TotalLagrangian && !body.lagrangian;
    full.formulation = static_cast<std::int32_t>(updated ? Formulation::Deformable : given);
    deliver(full, result, "result");
  });
}

int32_t ogive_field_count(const ogive_world* world, ogive_body_id body) {
  if (!ogive_body_name(world, body)) return 0;
  std::int32_t count = 0;
  for (const Field& field : all_fields)
    if (has_field(world, body.index, field)) ++count;
  return count;
}

const char* ogive_field_name(const ogive_world* world, ogive_body_id body, int32_t index, int32_t* components) {
  if (!ogive_body_name(world, body) || index < 0) return nullptr;
  for (const Field& field : all_fields)
    if (has_field(world, body.index, field) && index-- == 0) {
      if (components) *components = field.components;
      return field.name;
    }
  return nullptr;
}

ogive_status ogive_field_get(const ogive_world* world, ogive_body_id id, const char* name, double* values,
                             int64_t count) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_field_get");
    const Field& field = field_named(world, id, name);
    const BodyState& body = body_of(world, id);
    check_count(body, field, count);
    if (count > 0) require_pointer(values, "values");
    copy_field(world->model, id.index, body, field.name, values);
  });
}

ogive_status ogive_field_view_get(const ogive_world* world, ogive_body_id id, const char* name, ogive_field_view* view) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_field_view_get");
    const Field& field = field_named(world, id, name);
    const BodyState& body = body_of(world, id);
    ogive_field_view full{};
    if (!view_field(body, field.name, full))
      refuse("field \"" + std::string(name) + "\": is computed on demand and cannot be viewed; use ogive_field_get");
    full.components = field.components;
    full.places = body.padded;
    full.number = body.number.data();
    deliver(full, view, "view");
  });
}

ogive_status ogive_field_set(ogive_world* world, ogive_body_id id, const char* name, const double* values,
                             int64_t count) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_field_set");
    const Field& field = field_named(world, id, name, true);
    if (world->model.bodies[id.index].rigid() && std::strcmp(name, "force") != 0)
      refuse("field \"" + std::string(name) + "\": cannot be set, the body is rigid; only \"force\" can");
    if (!field.settable) refuse("field \"" + std::string(name) + "\": cannot be set");
    const bool lagrangian = world->state.bodies[id.index].lagrangian;
    if (lagrangian && !settable_in_reference(field.name))
      refuse("field \"" + std::string(name) + "\": cannot be set, the body is total Lagrangian and has it from its nodes; "
             "velocity, energy, temperature and force can");
    BodyState& body = const_cast<BodyState&>(body_of(world, id));
    check_count(body, field, count);
    if (count > 0) require_pointer(values, "values");
    const Material& material = world->model.material_of(id.index);
    const std::string field_name(field.name);
    check_values(world->model, field, values, count);
    const bool moves_energy = field_name == "velocity" || field_name == "affine_velocity" || field_name == "energy";
    const double energy_before = moves_energy ? total_energy(world->model, world->state) : 0;
    if (field_name == "force" && body.force.empty()) body.force.assign(4 * static_cast<std::size_t>(body.padded), 0.0);
    double fastest = 0;
    in_order_of_number(body, [&](std::int64_t rank, std::int64_t p) {
      const double* v = values + rank * field.components;
      if (field_name == "velocity") {
        for (int c = 0; c < 3; ++c) body.velocity[4 * p + c] = v[c];
        fastest = std::max(fastest, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      } else if (field_name == "affine_velocity") {
        for (int c = 0; c < 9; ++c) body.affine[affine_size * p + 3 * (c % 3) + c / 3] = v[c];
      } else if (field_name == "stress") {
        for (int c = 0; c < 6; ++c) body.stress[c][p] = v[c];
      } else if (field_name == "position") {
        for (int c = 0; c < 3; ++c) body.position[4 * p + c] = v[c];
      } else if (field_name == "force") {
        for (int c = 0; c < 3; ++c) body.force[4 * p + c] = v[c];
      } else if (field_name == "deformation_gradient") {
        for (int c = 0; c < 9; ++c) body.deformation[c][p] = v[c];
      } else if (field_name == "volume_ratio") {
        body.volume_ratio[p] = *v;
      } else if (field_name == "energy") {
        body.energy[p] = *v * material.density / body.position[4 * p + 3];
      } else {
        (field_name == "plastic_strain" ? body.plastic_strain : body.temperature)[p] = *v;
      }
      if (field_name == "plastic_strain" || field_name == "temperature") {
        body.yield_stress[p] =
            material.yield_stress_at(body.plastic_strain[p], material.thermal() ? body.temperature[p] : 0);
      }
    });
    if (field_name == "velocity" && lagrangian) take_velocities(world->model, world->state, world->workspace, id.index);
    if (moves_energy) {
      world->state.energy_watch.from_host += total_energy(world->model, world->state) - energy_before;
      // What the host gives is no exchange; the memory of the beginning begins anew.
      if (!world->state.stop.exchange.begun) world->state.stop.exchange = {};
    }
    find_resting(world->model, world->state, world->workspace, id.index);
    if (field_name == "position") body.drifted = true;  // to be binned anew before the next step
    if (field_name == "velocity") {
      // The next step must be safe for the new speed as well.
      const double dt = world->state.stable_time_step;
      const double wave = world->model.numerics.time_step_factor * world->model.grid.cell_size / dt;
      world->state.stable_time_step =
          world->model.numerics.time_step_factor * world->model.grid.cell_size / (wave + std::sqrt(fastest));
    }
  });
}

ogive_status ogive_world_attach(ogive_world* world, const char* name, const void* data, int64_t size) {
  return guarded(world, [&] {
    const std::string key = checked_name(name, "attachment");
    if (key.find('\n') != std::string::npos) refuse("attachment name: must be one line");
    if (size < 0 || size > largest_attachment)
      refuse("attachment size: must be 0..2^31, got " + std::to_string(size));
    if (size == 0) {
      world->attachments.erase(key);
      return;
    }
    require_memory(data, "data");
    const std::uint8_t* bytes = static_cast<const std::uint8_t*>(data);
    world->attachments[key].assign(bytes, bytes + size);
  });
}

ogive_status ogive_world_attachment(const ogive_world* world, const char* name, const void** data, int64_t* size) {
  return guarded(world, [&] {
    require_pointer(name, "name");
    require_memory(data, "data");
    require_pointer(size, "size");
    const auto found = world->attachments.find(name);
    if (found == world->attachments.end()) refuse("attachment: none is named \"" + std::string(name) + "\"");
    *data = found->second.data();
    *size = static_cast<std::int64_t>(found->second.size());
  });
}

ogive_status ogive_world_save(const ogive_world* world, const ogive_writer* writer) {
  return guarded(world, [&] {
    require_prepared(world, "ogive_world_save");
    if (world->stage == Stage::Reopened) require_stage(world, Stage::Ready, "ogive_world_save");
    if (!require_pointer(writer, "writer").put) refuse("writer.put: must not be NULL");
    // exchange() both reads and writes; a writing archive changes nothing.
    ogive_world* self = const_cast<ogive_world*>(world);
    CallbackWriter archive(*writer);
    archive.exchange_version();
    self->model.exchange(archive);
    self->state.exchange(self->model, archive);
    exchange_attachments(self, archive);
  });
}

ogive_status ogive_world_load(ogive_world* world, const ogive_reader* reader) {
  return guarded(world, [&] {
    require_not_advancing(world, "ogive_world_load");
    if (world->stage != Stage::Building || world->has_grid || !world->model.materials.empty() || !world->model.loads.empty() ||
        !world->model.clamps.empty() || !world->model.walls.empty())
      throw Error(ErrorKind::State, "ogive_world_load: the world must be fresh from ogive_world_create");
    require_pointer(reader, "reader");
    if (!reader->find || !reader->get) refuse("reader.find and reader.get: must not be NULL");
    ogive_world fresh;
    fresh.workspace.threads = world->workspace.threads;
    CallbackReader archive(*reader);
    archive.exchange_version();
    fresh.model.exchange(archive);
    fresh.state.exchange(fresh.model, archive);
    exchange_attachments(&fresh, archive);
    prepare_state(fresh.model, fresh.state, fresh.workspace);
    // Older saves do not tell what the host had put in: what is there counts as given, and growth begins anew.
    if (archive.version() < 3)
      fresh.state.energy_watch.from_host = total_energy(fresh.model, fresh.state) - fresh.state.ledger.initial_total;
    fresh.has_grid = true;
    fresh.stage = Stage::Ready;
    fresh.log = world->log;
    fresh.log_user = world->log_user;
    std::swap(*world, fresh);
    tell_prepared(world, "loaded", "");
  });
}
