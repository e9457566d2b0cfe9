// Where bodies meet in one step: the nodes of mixed blocks at which some pair is close enough, with the bodies' velocity
// fields there and the pairs between them. Found once a step; every phase of contact works on it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model.hpp"

namespace ogive {

struct ContactMethodDef;

// The first phase of contact, at the beginning of the step.
enum class StartUse {
  MotionAndStrain,  // stress first
  Motion,           // stress last: only what the particles never see, which belongs to the acceleration
  Strain            // stress last, the velocities that give the strain: nothing is booked, rigid bodies stay as they are
};

// What holds a pair together at a node during one phase.
enum class Hold {
  Nothing,
  Stick,    // one velocity
  Slide,    // one normal velocity: pushes and pulls
  Contact   // pushes only
};

struct Constraint {
  Hold hold = Hold::Nothing;
  double target = 0;      // what the normal component of v1 - v2 is brought to
  bool friction = false;  // Coulomb, with the pair's coefficient and the pushing impulse
};

// The velocity field of a body at a node, or a wall.
struct ContactField {
  std::int32_t slot = -1;    // of the grid; -1: a wall
  std::int32_t body = -1;    // its velocity field; walls: -1 - index of the wall
  std::int32_t rigid = -1;   // index in Workspace::rigid; -1: deformable, or a wall
  bool lagrangian = false;   // of a total Lagrangian body
  std::int32_t acting = 0;   // pairs that hold it in this phase
  bool fixed = false;        // infinite mass: walls and prescribed motion
  double mass = 0;           // as mapped
  double fill = 0;           // part of the node that it fills
  Vector3 gradient{};        // of its volume at rest, out of the body
  Vector3 outward{};         // unit vector of it; zero where there is none
  Vector3 occupied{};        // Pan's sum over occupied cells, out of the body
  double normal_stress[6]{}; // volume-weighted sum of its stress; see ContactStress
  double stress_volume = 0;
  Vector3 before{}, velocity{}, change{};  // in this phase: as found, now, and the momentum from one sweep
  Vector3 returned{};  // velocity that the first phase took and that goes back before the increment of the particles
  Vector3 kept{}, kept_couple{};  // likewise, but it never reaches the particles
  Vector3 behind{};    // mean velocity of the step that the work of impulses is done at, less that of before and velocity
  Vector3 impulse{}, couple{};  // on it in this phase; the couple of impulses that act beside the node, on rigid bodies

  // It moves with the common grid, from which it has its strain and its change of motion.
  bool by_grid() const { return slot >= 0 && rigid < 0 && !lagrangian; }
};

struct ContactPair {
  std::int32_t a = -1, b = -1;  // fields, counted from the node's first
  const ContactMethodDef* method = nullptr;
  Vector3 normal{};             // unit, out of a; zero where the method asks for none
  Vector3 beside{};             // from the node to the surface where the bodies meet; only where one of them is rigid
  bool strains = true;          // one of the bodies has its strain from the common grid
  bool by_surface = false;      // its normal is that of a surface
  double gap = 0;               // length > 0 that a pair without such a body may still approach
  double friction = 0;
  bool booked = false;          // what it takes is exactly known: it joins a total Lagrangian body with no body of the grid
  bool pressed = false;         // its normal impulse pushed in the last step; after the second phase, in this one
  Vector3 mapped{}, adjusted{}; // v_a - v_b before and after the first phase of this step
  double start_push = 0;        // normal impulse of the first phase, where it reaches the particles: it bears friction too
  // In the present phase.
  Constraint constraint;
  Vector3 found{};              // v_a - v_b before it
  double reduced_normal = 0, reduced_tangential = 0;  // masses that the impulses meet
  double normal_impulse = 0;    // on a against the normal, on b along it
  Vector3 tangential_impulse{}; // on a; on b its opposite
  double friction_dissipation = 0, contact_work = 0;
};

struct ContactNode {
  std::int32_t node = 0;      // within the block
  std::array<std::int32_t, 3> index{};  // of the node in the grid, from domain_min
  Vector3 place{};
  std::int32_t first_field = 0, fields = 0, first_pair = 0, pairs = 0;
  bool coupled = false;       // a free rigid or total Lagrangian body is here, which couples it to other nodes
};

// All of one mixed block.
struct BlockContacts {
  std::vector<ContactField> fields;
  std::vector<ContactPair> pairs;
  std::vector<ContactNode> nodes;
  double friction_dissipation = 0, contact_work = 0, contact_dissipation = 0;

  void clear() {
    fields.clear();
    pairs.clear();
    nodes.clear();
  }
};

}  // namespace ogive
