// ogive voxelise and ogive info: looks at single files.
#pragma once

#include <string>

#include "failure.hpp"
#include "scene.hpp"

namespace driver {

/// Fills a mesh and writes its particles as CSV, x,y,z,volume.
ExitCode voxelise(const MeshShape& mesh, const std::string& output_file);

/// Tells what a checkpoint or particle file holds; with `verify` reads all of it and checks every checksum.
ExitCode info(const std::string& file, bool verify);

}  // namespace driver
