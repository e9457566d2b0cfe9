// All that a step changes, and exactly what a checkpoint holds: particles by body, their grouping, the ledger's running
// sums and the clock. The grid is not here: every step makes it anew from the particles.
//
// Particles of a body lie in groups: a group is the particles of one block of 4 x 4 x 4 cells, ordered by cell when they
// were last binned. Each group begins at a multiple of `group_padding` and is filled up to one with massless particles,
// so that vector loads never reach into another group. Between binnings particles may drift up to half a cell out of the
// cells that the group held; the drift bounds of the group say how far.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "aligned.hpp"
#include "contact/memory.hpp"
#include "model.hpp"
#include "transfer/kernels.hpp"

namespace ogive {

class Archive;

constexpr int block_cells = 4;        // cells along an edge of a block
constexpr int affine_size = 9;        // doubles of a particle's affine velocity
constexpr int tile_nodes = 7;         // nodes along an edge of a group's tile: the block's 4, one below, two above

struct Group {
  std::array<std::int32_t, 3> block{};  // block coordinates: cell = 4 block .. 4 block + 3, counted from domain_min
  std::int64_t begin = 0;               // first particle
  std::int32_t count = 0;               // real particles; the padding follows
  // Lowest and highest cell (0..3) that held a particle at the last binning, per axis.
  std::array<std::int32_t, 3> low{}, high{};
  bool resting = false;                 // nothing has happened to its particles yet (resting.hpp)

  std::int64_t padded_end() const { return begin + (count + group_padding - 1) / group_padding * group_padding; }
};

// What removed particles were.
struct Departed {
  std::int64_t particles = 0;
  double mass = 0, energy = 0;  // kinetic and internal
  Vector3 momentum{};
};

// Running sums of one body.
struct BodyTotals {
  std::int64_t failed_particles = 0;
  double failed_mass = 0, first_failure_time = -1, failure_loss = 0;
  Departed left, dropped;  // by free faces; as debris
  Vector3 dropped_angular_momentum{};  // about the origin
  double plastic_dissipation = 0, viscous_dissipation = 0;
  Vector3 contact_force{};  // of the last step
  Vector3 initial_velocity{};
  double maximum_speed = 0, maximum_speed_ever = 0;
};

// Of a rigid body: its centre of mass (prescribed motion: its reference point), that point's velocity, angular velocity.
struct RigidState {
  Vector3 centre{}, velocity{}, spin{};
  // What lay at X when the body was given lies at shift + turn X (rows of turn).
  std::array<Vector3, 3> turn{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  Vector3 shift{};
};

// The reference grid of a total Lagrangian body. Its particles stay in the groups of their reference positions.
struct ReferenceState {
  AlignedVector<double> position;       // of the particles, records {X, Y, Z, mass}
  // Nodes: 64 for each block that the groups reach, in the order of the blocks.
  AlignedVector<double> node_position;  // records {x, y, z, lumped mass}
  AlignedVector<double> node_velocity;  // records {vx, vy, vz, 0}: in the middle between this step and the last
  AlignedVector<double> node_force;     // records {fx, fy, fz, 0}: internal force now
  double critical_length = 0;           // the critical time step is this by the wave speed, (3.22)
  double kinetic = 0;                   // of the nodes now
  Vector3 angular_momentum{};           // of the nodes, about the origin
  bool distorted = false;               // beyond the body's limit: updated Lagrangian from the next step on
};

// Particle arrays are `padded` long; those that the material does not need are empty.
struct BodyState {
  std::int64_t particles = 0;  // real ones
  std::int64_t padded = 0;
  AlignedVector<double> position;  // records {x, y, z, mass}
  AlignedVector<double> velocity;  // records {vx, vy, vz, 1}
  AlignedVector<double> affine;    // three vectors a particle, dv/dx, dv/dy, dv/dz of its affine velocity field
  std::array<AlignedVector<double>, 6> stress;  // Cauchy: xx yy zz yz xz xy, tension positive
  AlignedVector<double> volume_ratio;           // current / initial volume
  AlignedVector<double> energy;                 // internal energy per initial volume
  AlignedVector<double> plastic_strain;
  AlignedVector<double> yield_stress;           // (A + B eps_p^n)(1 - T*^m) at the current state
  AlignedVector<double> temperature;
  AlignedVector<double> viscous_pressure;       // waits for the next step's forces where the stress comes last
  std::array<AlignedVector<double>, 9> deformation;  // F row by row
  std::array<AlignedVector<double>, 15> history;     // what laws of finite strain remember, materials/finite_strain.hpp
  AlignedVector<std::int32_t> number;                // the particle's number in its body, -1 in the padding
  AlignedVector<std::int32_t> loads;                 // bit k: the body's k-th load on particles acts on it; empty: none
  AlignedVector<double> force;                       // records {fx, fy, fz, 0}: the host's force; empty: none was given
  std::vector<Group> groups;                         // ordered by block: z, then y, then x
  Vector3 initial_spin{};                            // angular velocity given with the body; the start of `affine`
  bool drifted = false;                              // some particle has left its group's bounds: bin before the next step
  BodyTotals totals;
  RigidState rigid;                                  // rigid bodies only
  std::vector<double> surface_vertices;              // deformable bodies with a surface: three coordinates each, now
  bool lagrangian = false;                           // computed total Lagrangian now
  ReferenceState reference;                          // then alone
  bool stressed = false;                             // copies: with the stress, where a contact method asks for it

  // Calls f(array) for each per-particle array of doubles with one value a particle that is in use.
  template <class F>
  void for_each_scalar(F&& f) {
    if (!stress[0].empty())
      for (auto& component : stress) f(component);
    f(volume_ratio);
    f(energy);
    if (!plastic_strain.empty()) f(plastic_strain);
    if (!yield_stress.empty()) f(yield_stress);
    if (!temperature.empty()) f(temperature);
    if (!viscous_pressure.empty()) f(viscous_pressure);
    if (!deformation[0].empty())
      for (auto& component : deformation) f(component);
    for (auto& component : history)
      if (!component.empty()) f(component);
  }
};

// Momentum and energy that no particle carries; see ogive_ledger.
struct Ledger {
  double friction_dissipation = 0, transfer_dissipation = 0, contact_work = 0, boundary_work = 0, external_work = 0,
         prescribed_work = 0, contact_dissipation = 0;
  Vector3 boundary_impulse{}, external_impulse{}, contact_couple{};
  double initial_total = 0;
};

// Memory of the energy watch (energy_watch.hpp).
struct EnergyWatch {
  double from_host = 0;      // energy that came with fields that the host set
  double largest_work = 0;   // external and prescribed work, where it was largest
  double largest_growth = 0, largest_growth_time = 0;
  double warning_time = -1;  // when energy_warning was first passed; -1: never
};

// Present value of a load of the model, and what it has done.
struct LoadState {
  Vector3 value{};           // acceleration, traction or velocity
  double mass = 0;           // of the particles that it acted on at first
  Vector3 force{};           // in the last step
  Vector3 impulse{};         // so far
  double work = 0;           // so far
};

// Contact between two bodies that have met, a < b.
struct PairTotals {
  std::int32_t a = -1, b = -1;
  Vector3 force{};           // on a, in the last step
  Vector3 impulse{};         // on a, so far
  double friction_dissipation = 0, contact_work = 0;
};

// Memory of the condition that the energy exchange has ended: energies since when none has changed by more than the tolerance,
// before anything has happened those of the beginning.
struct ExchangeState {
  double time = 0, internal = 0, dissipated = 0;
  std::vector<double> kinetic;  // by body; empty: not yet looked at
  bool begun = false;
};

// Memory of the stop conditions.
struct StopState {
  double reference_time = 0, reference_speed = 0;
  bool slowed = false;
  std::int32_t reason = 0;
  ExchangeState exchange;
};

struct State {
  double time = 0, last_time_step = 0, stable_time_step = 0;
  std::int64_t steps = 0, particle_steps = 0;
  std::int64_t resting_particle_steps = 0;  // of these, left out because the particles were at rest
  std::vector<BodyState> bodies;
  // Of total Lagrangian bodies: their particles' mass, place, velocity and volume in groups of where they are now, for
  // contact; `number` is the place in the body's own arrays. Empty for others.
  std::vector<BodyState> copies;
  std::vector<LoadState> loads;    // one for each of the model's
  std::vector<PairTotals> pairs;   // ordered by a, then b
  Ledger ledger;
  EnergyWatch energy_watch;
  StopState stop;
  ContactMemory contact_memory;  // where a contact method has one

  std::int64_t particle_count() const;
  std::int64_t memory_bytes() const;
  void exchange(const Model& model, Archive& archive);
};

// Gives a body the arrays that its material and formulation need, `padded` long; a rigid one has no stress.
void allocate_particles(const Material& material, const Body& rules, std::int64_t padded, BodyState& body);
// What a law remembers of a particle to which nothing has happened, value by value.
double initial_history(const Material& material, int component);
// Gives it those that the numerics need, where it has none yet.
void allocate_transfer(const Model& model, int index, BodyState& body);

}  // namespace ogive
