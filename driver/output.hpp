// What a run leaves in its directory: history.csv, particle files with their time series, summary.json.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "checkpointing.hpp"
#include "files.hpp"
#include "scene.hpp"
#include "world.hpp"

namespace driver {

/// Throws Failure(kExitFile) if the directory cannot serve: it is a file, or holds an earlier run's files and
/// `overwrite` is not asked for. Changes nothing.
void require_usable_directory(const std::filesystem::path& directory, bool overwrite);
/// Makes the directory where there is none.
void make_directory(const std::filesystem::path& directory);
/// Removes what an earlier run left there.
void clear_directory(const std::filesystem::path& directory);
/// Makes ready to go on in the directory of the run itself: removes what was written after `state` was saved at step `steps`.
void rewind_directory(const std::filesystem::path& directory, const DriverState& state, int64_t steps);

/// What a breakdown left, once the run has got past it.
void remove_failed_files(const std::filesystem::path& directory);

/// Other intervals of output from a time on: their next multiples become due.
void reschedule(const OutputScene& before, const OutputScene& after, double time, DriverState& state);

/// What only the program knows about a run that has ended.
struct RunFacts {
  std::string stop_reason;
  int32_t threads = 1;
  double wall_seconds = 0;
  std::vector<std::string> warnings;
  // Processor time of this process: until the first step, of output and checkpoints, of the steps themselves.
  double start_cpu_seconds = 0, output_cpu_seconds = 0, stepping_cpu_seconds = 0;
};

class Output {
 public:
  Output(const Scene& scene, const std::filesystem::path& directory, DriverState& state);

  /// Starts a new history with the world as it is.
  void start(ogive_world* world, const ogive_progress& progress);
  /// Looks whether history and particle files are those that the state goes on from; changes nothing.
  void resume();
  /// Cuts the history to where the state was saved. Last of all: until then a checkpoint that is later, and not yet removed,
  /// still fits it.
  void cut_history() { history_.cut(); }

  /// Writes what is due at the world's time. The time step never bends to it: output comes with the first step at or
  /// after its due time, so that results do not depend on what is written.
  void write_due(ogive_world* world, const ogive_progress& progress);
  /// Writes the last row and the last particle file where the end of the run is not already in them.
  void write_last(ogive_world* world, const ogive_progress& progress);
  /// So that the history on the disk is never behind a checkpoint.
  void flush_to_disk() { history_.flush_to_disk(); }

  void write_summary(ogive_world* world, const RunFacts& facts) const;
  /// One line per result that the scene asks for, with units.
  std::string results_text(const ogive_world* world) const;

 private:
  void write_history_row(const ogive_world* world, const ogive_progress& progress);
  void write_particles(ogive_world* world, const ogive_progress& progress);
  double result(const ogive_world* world, const ResultScene& wanted) const;

  const Scene& scene_;
  std::filesystem::path directory_;
  DriverState& state_;
  AppendedFile history_;
};

}  // namespace driver
