// Contact at points of a surface (detection "surface"): docs/theory.md, section 6.5.
//
// Of a pair one body owns the surface (or it is a wall); the other is felt by its particles, or, if it is total Lagrangian, by the
// vertices of its own surface. A particle whose own surface, or a vertex that is about to meet the owner's is a contact point:
// there, and not at the nodes around, the velocities of the two are compared and an impulse acts. The felt body's velocity at the
// point is sum_j N_j(x_p) v_j and its nodes take N_j(x_p) of the impulse, so that momentum is kept to round-off; a rigid owner takes
// it where its surface is. A total Lagrangian body has its velocity from the nodes of its reference grid, N_a(X_p), and gives them
// its impulses, without the common grid between.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "contact/nodes.hpp"
#include "rigid/rigid_motion.hpp"
#include "vector3.hpp"

namespace ogive {

struct Model;
struct State;
struct Workspace;

// One node of a point's stencil. The weights of the components differ only at mirror faces, where a node stands for its
// image too.
struct PointNode {
  Vector3 weight{};
  std::int32_t node = 0;  // of the common grid; from Workspace::nodes.size() on, of the reference grid
};

// One of the two bodies at a point.
struct PointSide {
  std::int32_t body = -1;   // walls: -1 - wall
  std::int32_t rigid = -1;  // index in Workspace::rigid
  bool lagrangian = false;
  bool fixed = false;       // a wall or a prescribed motion
  Vector3 at{};             // where it is held
  Vector3 before{};         // rigid: its velocity there before the phase
  std::int32_t first = 0, count = 0;  // of its stencil; none: rigid or a wall
};

struct ContactPoint {
  PointSide a, b;           // a: felt; b: owns the surface
  const ContactMethodDef* method = nullptr;
  double friction = 0;
  double gap = 0;           // what they may still approach, >= 0
  Vector3 normal{};         // unit, out of a
  std::int64_t particle = -1;  // of a, its place; of a vertex the particle next to it
  std::int32_t vertex = -1;    // of a's surface; -1: the point is a particle
  std::int32_t triangle = -1;  // of b's surface, where it has triangles
  bool pressed = false;
  Vector3 mapped{}, adjusted{}, kept{};  // kept: of the relative velocity, what the first phase took and particles never see
  double start_push = 0;
  double part = 1;          // 1/2 for a particle that a face cuts
  bool booked = false;      // of total Lagrangian bodies: what contact takes from them is no strain's
  Vector3 unheld{};         // booked: the relative velocity after contact, before what else is done to reference grids
  // In the present phase.
  Constraint constraint;
  Vector3 found{};
  double mobility = 0;
  Vector3 impulse{};        // on a; on b its opposite
};

struct ContactPoints {
  std::vector<ContactPoint> points;
  std::vector<PointNode> stencils;
  std::vector<std::vector<ContactPoint>> found;  // by link, then by `pieces`; without stencils
  // Of a total Lagrangian body's vertices, [first, end).
  struct Piece {
    std::int32_t body;
    std::size_t first, end;
  };
  std::vector<Piece> pieces;
  // Nodes that a phase changes, with the velocity before it; `seen[node]`: 1 + its place here, 0: none.
  struct Change {
    std::int32_t node;
    Vector3 before;
  };
  std::vector<Change> changes;
  std::vector<std::int32_t> seen;  // as `share`, with the nodes of the reference grid behind those of the common one
  std::vector<std::int32_t> place;  // by node: 1 + where the solver has it; zero between phases
  std::vector<double> share;  // by node: sum of the weights of acting points; zero between phases
  // Of the first phase: what goes back before the particles' increment, and what they never see. Of common nodes; reference
  // nodes have theirs in LagrangianContact.
  struct Start {
    std::int32_t node;
    Vector3 returned, kept;
  };
  std::vector<Start> start;

  std::int64_t memory_bytes() const;
};

// Whether contact of the two (b may be a wall, < 0) is at points; of two rigid bodies with surfaces it is at nodes.
bool met_at_points(const Model& model, std::int32_t a, std::int32_t b);

// The phases of contact.hpp.
void find_points(const Model& model, const State& state, Workspace& workspace);
void start_points(const Model& model, State& state, Workspace& workspace, std::vector<RigidMotion>& rigid, double dt, StartUse use);
void return_start_points(Workspace& workspace);
void end_points(State& state, Workspace& workspace, double dt);
// What is done to reference grids after contact changes what it has taken from them: before and after.
void begin_held_points(const State& state, Workspace& workspace);
void book_held_points(State& state, Workspace& workspace);

}  // namespace ogive
