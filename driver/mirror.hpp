// Mirror planes of a scene: where half of it tells everything.
#pragma once

#include <string>
#include <vector>

#include "scene.hpp"

namespace driver {

struct MirrorPlane {
  int axis = 0;            // its normal
  bool found = false;
  bool already = false;    // the scene has it: a face of the domain is a symmetry face
  double at = 0;           // coordinate along the axis
  std::string reason;      // why it is one, or what is not the same on both sides
};

/// Looks for a plane across each axis of the model. A plane counts when every body is its own mirror image, particle by
/// particle, and nothing moves, pulls or holds across it; two bodies that are each other's image do not count, because each
/// would be bonded to its own image in the half model. One body's particles at a time are in memory. Where planes
/// are only to be offered (`thorough` is false) some 50,000 particles of each body are compared, else all.
std::vector<MirrorPlane> mirror_planes(const Scene& scene, bool thorough);

}  // namespace driver
