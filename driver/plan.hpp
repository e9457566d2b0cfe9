// The plan of a run: how much of a scene is computed, and why.
//
// Before a run the scene is looked through for what it does not need: the other half of a symmetric one, the third dimension of
// bodies of revolution, cells finer than the wanted error asks for, stress in a body that hardly deforms. What the scene asks
// for (symmetry, accuracy) is written into it as if the user had; everything else is only said. Each decision tells its reason
// and how it is overruled. The reduced scene stands in full in the checkpoints, so that a restart decides nothing anew.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "build.hpp"
#include "decision.hpp"
#include "document.hpp"
#include "scene.hpp"

namespace driver {

struct PlannedScene {
  Scene scene;  // reduced, its text as well
  BuiltWorld built;
  std::vector<Decision> decisions;
};

/// Reads the scene, decides and builds. Throws as read_scene and build_world do, and Failure(kExitInput) where the scene
/// demands what cannot be: symmetry = "axisymmetric" of bodies that are not of revolution, an accuracy that no study reached.
PlannedScene plan_scene(Document document, const std::filesystem::path& file);

/// In lines, for people.
std::string text_of(const std::vector<Decision>& decisions);

}  // namespace driver
