// Surfaces of bodies in a step: whose is used for a pair, where it is, and where two of them are nearest to each other.
// docs/theory.md, section 6.5.
//
// Rigid bodies carry theirs with their motion. A deformable one carries vertices in BodyState::surface_vertices, which move with
// the common grid or, of a total Lagrangian body, with the nodes of its reference grid.
#pragma once

#include "grid.hpp"
#include "model.hpp"
#include "state.hpp"
#include "surface/surface.hpp"

namespace ogive {

// The owner of the pair's surface: a body, -1: none. Rigid before total Lagrangian before updated, the rule's master, the first.
int surface_owner(const Model& model, int a, int b);

// Whether a rule finds contact by surfaces.
bool by_surface(const ContactRule& rule);

// Once for a model: the surfaces that some rule asks for.
void prepare_surfaces(const Model& model, Workspace& workspace);
// At the beginning of a step: where they are.
void place_surfaces(const Model& model, const State& state, Workspace& workspace);

// Once the velocities at the end of the step stand in {velocity, mass | end velocity} of the common and the reference grid: moves
// the vertices of deformable bodies. One that finds no material of its body goes with the mean of the others.
void move_surfaces(const Model& model, State& state, const Workspace& workspace, double dt);

// The nearest point of an owner's surface (walls: -1 - wall) within reach.
bool nearest_of_owner(const Model& model, const Workspace& workspace, std::int32_t owner, const Vector3& x, double reach,
                      SurfacePoint& found, std::int32_t* hint = nullptr);

// Where the surfaces of a and b (or a wall) are nearest to each other, searched from x and not farther from it than reach
// along any axis. gap: the sum of the distances there; normal: out of a.
struct Meeting {
  Vector3 place{}, normal{};
  double gap = 0;
};
bool meeting_of(const Model& model, const Workspace& workspace, std::int32_t a, std::int32_t b, const Vector3& x,
                double reach, Meeting& found);

}  // namespace ogive
