// ogive check: what a scene would do, without doing it.
#pragma once

#include <string>
#include <vector>

#include "failure.hpp"

namespace driver {

ExitCode check(const std::string& scene_file, const std::vector<std::string>& settings);

}  // namespace driver
