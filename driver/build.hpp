// From a scene to a prepared world, through the C interface alone.
#pragma once

#include <string>
#include <vector>

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

}  // namespace driver
