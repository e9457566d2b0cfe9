// Scenes of bodies of revolution, which a plane through their axis tells whole.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scene.hpp"

namespace driver {

/// A value by its path, as --set writes them.
using Setting = std::pair<std::string, std::string>;

struct Revolution {
  int axis = -1;                  // of the model in three dimensions; -1: there is none
  std::string reason;             // why there is one, or what stands against it
  std::vector<Setting> settings;  // make the scene axisymmetric: its axis becomes y, the distance from it x
};

/// Whether all of the scene, as far as it can be seen from its solids and rules, turns into itself about one of the axes x, y
/// or z through the bodies' centres. Meshes, boxes and lists of particles do not.
Revolution find_revolution(const Scene& scene);

}  // namespace driver
