// The kernels over a group of particles, compiled once per instruction set and chosen at run time.
//
// These plain structs are all that crosses between the engine and the kernels. A kernel works on the tile of a group: the
// nodes of its block, one layer below and two above, copied from and added to the slots of the 27 blocks around.
#pragma once

#include <cstdint>

namespace ogive {

constexpr int shape_count = 3;    // shape functions, in the order of ShapeFunction
constexpr int group_padding = 8;  // particles; groups are padded to a multiple of it

// A grid node of one velocity field. Between mapping and update: v = {momentum or velocity, mass}, f = {force, -};
// for the particle update: v = {velocity, 0}, f = {acceleration, 0}.
struct alignas(64) NodeRecord {
  double v[4];
  double f[4];
};

// Kept only in blocks that two fields reach: {sum of m_p grad N, sum of V_p N}.
struct alignas(32) ContactRecord {
  double gradient[3];
  double volume;
};

// Where a contact method asks for it: {sum of V_p sigma_p N: xx yy zz, sum of V_p N | yz xz xy, -}.
struct alignas(64) ContactStress {
  double direct[3];
  double volume;
  double shear[4];
};

// Particles of one group and the nodes they touch.
struct KernelGroup {
  std::int64_t begin, end;        // end with padding
  double corner[3];               // position of the tile's first node
  double inverse_cell;            // 1 / h
  double time_step;
  double grid_velocity_fraction;  // part of a particle's new velocity that is the grid's: 0 FLIP, 1 PIC and APIC
  double inverse_density;         // 1 / initial density
  std::int32_t tile_low[3], tile_high[3];  // nodes of the tile in use, inclusive
  NodeRecord* nodes[27];          // node records of the neighbour blocks, x fastest, null where none is touched
  ContactRecord* contact[27];     // likewise; null where no second field is
  double bound_low[4], bound_high[4];      // where particles may be until the next binning
  // Two-dimensional models: area of a section by its volume, where axisymmetric at radius 1.
  double section_share;
  bool axisymmetric;
};

struct KernelParticles {
  double* position;
  double* velocity;
  double* affine;        // nine a particle: three vectors, without a fourth component
  double* stress[6];
  double* volume_ratio;
  double* energy;
  double* plastic_strain;
  double* yield_stress;
  double* temperature;
  double* viscous_pressure;  // null: the viscous pressure of a step acts in the same step or there is none
  double* displacement;      // records; null: stress first. Otherwise the stress comes last and moves the particles
  double* deformation[9];
  double* history[15];       // what laws of finite strain remember
  const double* reference;   // records {X, Y, Z, mass}; total Lagrangian bodies only
};

struct KernelMaterial {
  double density, K, G, lambda;
  double A, B, n;
  double isotropic;  // part of the hardening; the rest is kinematic
  double rate_coefficient, inverse_reference_rate;
  double thermal_exponent, room_temperature, inverse_melt_range, heating;  // heating = taylor_quinney / (density cp)
  double rho_c0_squared, slope, gruneisen;
  double failure_strain;  // infinity: none
  double viscosity_linear, viscosity_quadratic;
  double cell_size;
  bool thermal, rate_dependent, viscous;
};

// What a group's stress update reports.
struct StressSums {
  double fastest;               // largest c + |v|: wave speed and the speed at which the grid moves the particle
  double plastic_dissipation, viscous_dissipation;
  double failure_loss, failed_mass;
  std::int64_t failed_particles;
  std::int64_t bad_particle;    // first particle with a volume that is not positive and finite, -1: none
  bool outside;                 // as in MoveSums, where the stress update moves the particles
  double worst_distortion;      // largest |F| |F^-1| / 3; total Lagrangian bodies only
  double speed_squared;         // likewise, largest |v|^2
};

struct MoveSums {
  double speed_squared;         // largest |v|^2
  double taken_up;              // sum of m v . (increment), less what the particles lose: see transfer dissipation in step.cpp
  bool outside;                 // a particle is outside its bounds (or not a number)
};

// Kernels that few runs need, in a file of their own. By shape function; the arrays hold the records of the neighbour blocks.
struct OptionalKernels {
  // Sums of the stress at nodes where bodies meet.
  void (*map_contact_stress[shape_count])(const KernelGroup&, const KernelParticles&, ContactStress* const (&)[27]);
  // XPIC: one pass of the filter from `filter[].v` to momentum in `filter[].f`, and the particle update.
  void (*filter_velocity[shape_count])(const KernelGroup&, const KernelParticles&, NodeRecord* const (&)[27]);
  void (*update_particles_xpic[shape_count])(const KernelGroup&, const KernelParticles&, NodeRecord* const (&)[27],
                                             MoveSums&);
  // Total Lagrangian bodies, by shape function (no GIMP), strength and equation of state: see transfer/total_lagrangian.hpp.
  void (*update_lagrangian[2][6][2])(const KernelGroup&, const KernelParticles&, const KernelMaterial&,
                                     NodeRecord* const (&)[27], StressSums&);
};

struct KernelTable {
  const char* name;
  // Nodal mass and momentum, Eqs. (27) and (28), by shape function, without and with affine velocity.
  void (*map_momentum[shape_count][2])(const KernelGroup&, const KernelParticles&);
  // Sums for the normals, Eq. (9), and the fill of nodes.
  void (*map_contact[shape_count])(const KernelGroup&, const KernelParticles&);
  // Eqs. (29)-(31) by shape function, strength and equation of state.
  void (*update_stress[shape_count][6][2])(const KernelGroup&, const KernelParticles&, const KernelMaterial&,
                                           StressSums&);
  // Eq. (31) by itself, for the stress that an earlier step left.
  void (*map_internal_force[shape_count])(const KernelGroup&, const KernelParticles&);
  // Eqs. (33), (34) by shape function, without and with affine velocity.
  void (*update_particles[shape_count][2])(const KernelGroup&, const KernelParticles&, MoveSums&);
  const OptionalKernels* optional;
  const KernelTable* planar;  // the same of two-dimensional models; null in that table itself
};

// The best table for this processor, or the one that the environment variable OGIVE_ISA names (x86-64-v2, x86-64-v3,
// x86-64-v4, generic). Throws Error(Argument) for one that the processor or the build lacks.
const KernelTable& kernel_table();

}  // namespace ogive
