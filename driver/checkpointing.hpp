// Checkpoints: the world with what the program needs to go on as if it had never stopped.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "decision.hpp"
#include "world.hpp"

namespace driver {

/// All that the program itself remembers between steps. It travels in every checkpoint beside the world.
struct DriverState {
  std::string scene_file;  // as it was given to the first run
  // Output number n is due at n intervals; these are the numbers of the next ones.
  int64_t next_history = 0;
  int64_t next_particles = 0;
  // Steps of the last ones, so that the end of the run writes no row twice.
  int64_t last_history_step = -1;
  int64_t last_particle_step = -1;
  // What of history.csv belongs to the run up to here.
  int64_t history_bytes = 0;
  uint64_t history_sum = 0;
  int64_t particle_files_written = 0;
  std::vector<std::string> particle_files;  // names in the output directory
  double wall_seconds = 0;
  // Of each body by name: the velocity at the start, and the last one while any of it was in the domain.
  std::map<std::string, std::array<double, 3>> initial_velocity;
  std::map<std::string, std::array<double, 3>> last_velocity;
  std::vector<Decision> plan;        // of the run, and the engine's when it began, in lines
  std::vector<std::string> engine_plan;
  std::vector<std::string> changes;  // what restarts changed, with the step: "step 1200: --set contact.friction=0.1"
};

/// The decisions as summaries and checkpoints keep them.
nlohmann::ordered_json plan_json(const std::vector<Decision>& plan);

std::string checkpoint_name(int64_t steps);

/// Writes the world with the scene and the state attached.
void write_checkpoint(ogive_world* world, const std::filesystem::path& file, const std::string& scene_text,
                      const DriverState& state);
/// Removes checkpoints of later steps, newest first.
void remove_later_checkpoints(const std::filesystem::path& directory, int64_t steps);
/// Removes all but the last `keep` checkpoints in the directory that are not later than `steps`.
void remove_old_checkpoints(const std::filesystem::path& directory, int64_t steps, int64_t keep);

struct LoadedCheckpoint {
  World world;
  std::filesystem::path file;
  std::string scene_text;
  DriverState state;
};
/// Reads a checkpoint file, or the newest undamaged one in a directory. `notes` tells of those that were refused.
LoadedCheckpoint load_checkpoint(const std::filesystem::path& file_or_directory, std::vector<std::string>& notes);

}  // namespace driver
