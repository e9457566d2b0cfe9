// What a step only reads: grid, boundaries, numerics, materials, bodies' rules, contact rules, stop condition.
//
// Built by the C interface field by field, checked once by Model::validate (which also fills the derived values), then
// never changed. All quantities are in one consistent set of units (see capi/ogive.h for the dimension and range of each
// field: the definitions here are the same ones under the same names).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "shape/gimp.hpp"
#include "surface/surface.hpp"
#include "vector3.hpp"

namespace ogive {

class Archive;

enum class WorldSpace : std::int32_t { ThreeDimensional = 0, PlaneStrain = 1, Axisymmetric = 2 };
enum class Face : std::int32_t { Free = 0, Symmetry = 1, Fixed = 2 };
enum class ShapeFunction : std::int32_t { Linear = 0, QuadraticBSpline = 1, Gimp = 2 };
enum class Transfer : std::int32_t { Flip = 0, AffineFlip = 1, Apic = 2, Xpic = 3 };
// USF; MUSL, from momentum mapped once more; USL, from the velocities at the end of the step as they are.
enum class UpdateOrder : std::int32_t { StressFirst = 0, StressLast = 1, StressLastAsIs = 2 };
enum class Strength : std::int32_t {
  Elastic = 0,
  NeoHookean = 1,
  J2Power = 2,
  JohnsonCook = 3,
  J2Mixed = 4,          // Lee et al. 2005 (2.1)-(2.13), in second Piola-Kirchhoff stress and Green-Lagrange strain
  J2Multiplicative = 5  // the same hardening with F = F_e F_p and logarithmic elastic strain
};
enum class EquationOfState : std::int32_t { Linear = 0, MieGruneisen = 1 };
enum class Failure : std::int32_t { None = 0, PlasticStrain = 1 };
// Index into the registry of contact/method.hpp.
enum class ContactMethod : std::int32_t {
  SingleField = 0,
  HuangFirst = 1,
  HuangSecond = 2,
  York = 3,
  HuChen = 4,
  Bardenhagen2000 = 5,
  Bardenhagen2001 = 6,
  Pan2008 = 7,
  Persistent = 8
};
enum class NormalRule : std::int32_t {
  Master = 0,
  Average = 1,
  VolumeGradient = 2,
  OccupiedCell = 3,
  LogisticRegression = 4
};
enum class Formulation : std::int32_t { Deformable = 0, RigidFree = 1, RigidPrescribed = 2, TotalLagrangian = 3 };
// What becomes of a total Lagrangian body that is too distorted.
enum class WhenDistorted : std::int32_t { Update = 0, Stop = 1 };
enum class Detection : std::int32_t { SharedNode = 0, Gap = 1, Surface = 2 };
enum class Region : std::int32_t { Box = 0, OutsideCylinder = 1, Everywhere = 2 };
enum class LoadKind : std::int32_t { Acceleration = 0, Traction = 1, Velocity = 2 };

struct Grid {
  double cell_size = 0;
  Vector3 domain_min{};
  Vector3 domain_max{};
  std::array<Face, 6> face{};  // x min, x max, y min, y max, z min, z max
  WorldSpace space = WorldSpace::ThreeDimensional;
  double thickness = 1;        // plane strain

  // Two-dimensional: particles and nodes in the plane z = 0; axisymmetric: x is the radius, y the axis.
  bool planar() const { return space != WorldSpace::ThreeDimensional; }
  bool axisymmetric() const { return space == WorldSpace::Axisymmetric; }
  // Area of a section by the volume that belongs to it: at radius 1, and anywhere. Planar models only.
  double section_share() const;
  double section_share_at(double x) const { return axisymmetric() ? section_share() / x : section_share(); }
  // Two-dimensional models: one layer of cells along z, and a mirror at the axis.
  void lay_in_plane();

  bool operator==(const Grid&) const = default;
};

struct Numerics {
  ShapeFunction shape_function = ShapeFunction::QuadraticBSpline;
  double time_step_factor = 0.5;
  double maximum_time_step = std::numeric_limits<double>::infinity();
  Vector3 gravity{};
  Transfer transfer = Transfer::AffineFlip;
  double pic_fraction = 0;
  UpdateOrder update_order = UpdateOrder::StressFirst;
  std::int32_t xpic_order = 2;
  double energy_warning = 0.01, energy_limit = 1.0, energy_loss_limit = 1.0;  // see energy_watch.hpp
  bool drop_debris = false;   // see debris.hpp
  bool skip_resting = true;   // see resting.hpp

  bool affine() const { return transfer == Transfer::AffineFlip || transfer == Transfer::Apic; }
  bool stress_first() const { return update_order == UpdateOrder::StressFirst; }
  // How far from a node its shape function reaches along an axis, in cells.
  double reach() const {
    constexpr double reaches[] = {1.0, 1.5, 1.0 + gimp_half_width};
    return reaches[static_cast<int>(shape_function)];
  }
  // The part of a particle's new velocity that is the grid's own.
  double grid_velocity_fraction() const { return transfer == Transfer::Apic ? 1.0 : pic_fraction; }
  // Part of a particle's velocity that is made anew from the grid in a step, by XPIC too.
  double renewed_fraction() const { return transfer == Transfer::Xpic ? 1.0 : grid_velocity_fraction(); }
};

// A part of space.
struct Space {
  Region region = Region::Box;
  Vector3 a{}, b{};
  double radius = 0;

  bool contains(const Vector3& x) const;
};

struct Clamp : Space {
  std::int32_t body = -1;
  std::int32_t axes = 7;
};

// What the host applies; its present value belongs to the state. Accelerations and tractions act on the particles that lay in
// the space when the world was prepared, velocities on the nodes that lie in it.
struct Load : Space {
  LoadKind kind = LoadKind::Acceleration;
  std::int32_t body = -1;
  std::int32_t axes = 7;  // velocity
  double area = 0;        // traction

  bool on_particles() const { return kind != LoadKind::Velocity; }
  bool acts_on(int index) const { return body < 0 || body == index; }
};
constexpr int most_particle_loads = 31;  // on a body: one bit of a particle's `loads` each

struct Material {
  std::string name;
  Strength strength = Strength::Elastic;
  EquationOfState eos = EquationOfState::Linear;
  Failure failure = Failure::None;
  double density = 0;
  double youngs_modulus = 0, poisson_ratio = 0, bulk_modulus = 0, shear_modulus = 0;
  double yield_stress = 0, hardening_modulus = 0, hardening_exponent = 1;
  double isotropic_fraction = 1;  // c of (2.10), (2.12): 1 isotropic, 0 kinematic hardening
  double rate_coefficient = 0, reference_strain_rate = 1;
  double thermal_exponent = 0, melt_temperature = 0, room_temperature = 293, specific_heat = 0, taylor_quinney = 1;
  double eos_sound_speed = 0, eos_slope = 0, gruneisen = 0;
  double failure_strain = 0;
  double viscosity_linear = 0, viscosity_quadratic = 0;

  // Derived by validate(): always both, whichever pair was given.
  double K = 0, G = 0;

  bool plastic() const { return strength != Strength::Elastic && strength != Strength::NeoHookean; }
  bool mixed_hardening() const { return strength == Strength::J2Mixed || strength == Strength::J2Multiplicative; }
  bool thermal() const { return strength == Strength::JohnsonCook && thermal_exponent > 0; }
  bool rate_dependent() const { return strength == Strength::JohnsonCook && rate_coefficient > 0; }
  bool hyperelastic() const { return strength == Strength::NeoHookean || mixed_hardening(); }  // keeps F
  // Values a particle that the law remembers beside: E_p and back stress, or the inverse of F_p and back stress.
  int history_size() const { return strength == Strength::J2Mixed ? 12 : strength == Strength::J2Multiplicative ? 15 : 0; }
  bool viscous() const { return viscosity_linear > 0 || viscosity_quadratic > 0; }
  // (A + B eps_p^n)(1 - T*^m), of a plastic material.
  double yield_stress_at(double plastic_strain, double temperature) const;
  // Throws Error naming the field; fills the derived values.
  void validate();
};

// Prescribed motion of a rigid body at one time; linear between, constant beyond.
struct MotionKnot {
  double time = 0;
  Vector3 velocity{}, angular_velocity{};
};

struct Body {
  std::string name;
  std::int32_t material = -1;
  Formulation formulation = Formulation::Deformable;

  // Rigid bodies only. Symmetry faces that cut the body, by their axis: the body is the whole of it and its images.
  std::array<std::int32_t, 3> cut{};
  double own_inertia = 0;      // moment of inertia per mass of a particle about its own centre: s^2 / 6 of a cube
  Vector3 reference{};         // prescribed: the point that moves with `velocity`, at time 0
  std::vector<MotionKnot> motion;

  SurfaceDef surface;          // none: it has none
  // Total Lagrangian bodies only: the largest |F| |F^-1| / 3 of their particles that they bear.
  double distortion_limit = 10;
  WhenDistorted when_distorted = WhenDistorted::Update;

  // Whether contact can use it: a deformable body carries vertices.
  bool has_surface() const { return surface.given() && (rigid() || surface.kind == SurfaceKind::Triangles); }
  bool rigid() const { return formulation == Formulation::RigidFree || formulation == Formulation::RigidPrescribed; }
  bool total_lagrangian() const { return formulation == Formulation::TotalLagrangian; }
  bool prescribed() const { return formulation == Formulation::RigidPrescribed; }
};

struct ContactRule {
  ContactMethod method = ContactMethod::Persistent;
  NormalRule normal = NormalRule::Average;
  std::int32_t master = -1;
  double friction = 0;
  Detection detection = Detection::Gap;
  double gap_offset = 0.3;
};

struct PairRule {
  std::int32_t a = -1, b = -1;
  ContactRule rule;
};

// A rigid half space that does not move: what lies on the other side of the plane than `normal` points to.
struct Wall {
  Vector3 point{}, normal{};  // normal: unit
  ContactRule rule;           // its choice of normals is not used
};

struct Stop {
  std::int32_t body = -1;
  double settle_window = 0, settle_tolerance = 0;
  bool when_stopped = true, when_out = true;
  double exchange_window = 0, exchange_tolerance = 0.001;  // of the whole world

  bool operator==(const Stop&) const = default;
};

struct Model {
  Grid grid;
  Numerics numerics;
  std::vector<Clamp> clamps;
  std::vector<Load> loads;
  std::vector<Material> materials;
  std::vector<Body> bodies;
  ContactRule contact;
  std::vector<PairRule> pairs;  // ordered, a < b
  std::vector<Wall> walls;
  Stop stop;

  // Derived by complete(): bodies have velocity fields of their own. Not so where every pair is of the single-field method
  // and every body moves with the grid.
  bool own_fields = false;

  int field_of(int body) const { return own_fields ? body : 0; }
  bool rigid_field(int field) const { return own_fields && bodies[field].rigid(); }
  const Material& material_of(int body) const { return materials[bodies[body].material]; }
  const ContactRule& rule_of(int a, int b) const;
  void set_pair(const PairRule& pair);  // in place of an older one of the same bodies

  // Each throws Error naming field, value and expectation.
  void validate_grid() const;
  void validate_numerics() const;
  void validate_planar() const;
  void validate_lagrangian() const;  // what total Lagrangian bodies cannot be joined with
  void validate_planar(const ContactRule& rule, const char* field) const;
  void validate_clamp(const Clamp& clamp) const;
  void validate_load(const Load& load) const;
  void validate_contact(const ContactRule& rule, const char* where) const;
  void validate_wall(const Wall& wall) const;
  void validate_motion(const std::vector<MotionKnot>& motion) const;
  void validate_distortion(const Body& body) const;
  void validate_stop(const Stop& conditions) const;
  void cover_solids();  // triangles for bodies that deform and whose surface contact asks for
  void complete();  // checks what needs the whole model and fills the derived values

  void exchange(Archive& archive);  // saves or loads every field
};

}  // namespace ogive
