// Tells how a run goes: one line that is rewritten on a terminal, plain lines otherwise.
#pragma once

#include <chrono>
#include <cstdint>

#include "units.hpp"
#include "world.hpp"

namespace driver {

class Progress {
 public:
  Progress(const Units& units, double start_time, double end_time, int64_t start_particle_steps);

  /// Cheap unless a line is due.
  void update(const ogive_world* world, const ogive_progress& progress);
  /// Ends the line that is being rewritten, so that other text can follow.
  void end_line();
  double seconds() const;  // since the start

 private:
  using Clock = std::chrono::steady_clock;
  void show(const ogive_world* world, const ogive_progress& progress, double seconds_now);

  Units units_;
  double start_time_, end_time_;
  int64_t start_particle_steps_;
  bool terminal_;
  bool line_open_ = false;
  Clock::time_point start_;
  double shown_seconds_ = 0;
  int shown_tenth_ = 0;
};

}  // namespace driver
