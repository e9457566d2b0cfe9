// ogive run and ogive restart: a world is stepped to its end, with output, checkpoints and signals on the way.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "failure.hpp"

namespace driver {

struct RunOptions {
  std::string scene_file;
  std::vector<std::string> settings;
  std::optional<std::string> output;
  std::optional<int64_t> threads;
  std::optional<double> until;
  bool overwrite = false;
};
ExitCode run(const RunOptions& options);

struct RestartOptions {
  std::string checkpoint;
  std::vector<std::string> settings;
  bool change_model = false;
  std::optional<std::string> output;
  std::optional<int64_t> threads;
  std::optional<double> until;
  bool overwrite = false;
};
ExitCode restart(const RestartOptions& options);

}  // namespace driver
