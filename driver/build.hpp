// From a scene to a prepared world, through the C interface alone.
#pragma once

#include <string>
#include <vector>

#include "particle_csv.hpp"
#include "scene.hpp"
#include "world.hpp"

namespace driver {

struct BuiltWorld {
  World world;
  std::vector<std::string> notes;  // what was repaired in meshes
};

/// Adds everything in the scene and prepares the world. Whatever the engine refuses is said with its place in the
/// scene.
BuiltWorld build_world(const Scene& scene);

/// The particles that a body of the scene is given, whole: before symmetry faces cut them, and all where it is `coarse`. Only what
/// these need is made, no world of the whole scene.
ParticleList body_particles(const Scene& scene, size_t body);

/// What of the model differs between the scene of a run and another one that is to go on in its place: "numerics", "contact",
/// "materials". Throws Failure(kExitInput) where it is something that the particles of the run stand on: units, grid, bodies,
/// walls, clamps, the list of materials.
std::vector<std::string> model_changes(const Scene& before, const Scene& after);

/// Gives a running world of `before` the numerics, contact, materials and stop condition of `after`. Whatever the engine refuses
/// as inconsistent is said with its place in the scene.
void change_world(const Scene& before, const Scene& after, ogive_world* world);

}  // namespace driver
