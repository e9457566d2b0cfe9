// Tells how a run goes: one line that is rewritten on a terminal, plain lines otherwise.
#include "progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "text.hpp"

namespace driver {
namespace {

constexpr double kTerminalSeconds = 0.2;
constexpr double kPlainSeconds = 10.0;

size_t terminal_columns() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20) return size.ws_col;
  return 80;
}

std::string percent(double part) {
  char text[32];
  std::snprintf(text, sizeof text, "%3.0f %%", 100 * part);
  return text;
}

}  // namespace

Progress::Progress(const Units& units, double start_time, double end_time, int64_t start_particle_steps)
    : units_(units),
      start_time_(start_time),
      end_time_(end_time),
      start_particle_steps_(start_particle_steps),
      terminal_(isatty(STDOUT_FILENO) == 1),
      start_(Clock::now()) {}

double Progress::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::update(const ogive_world* world, const ogive_progress& progress) {
  const double seconds_now = seconds();
  const double part = (progress.time - start_time_) / (end_time_ - start_time_);
  const int tenth = static_cast<int>(std::floor(10 * part + 1e-9));
  const double interval = terminal_ ? kTerminalSeconds : kPlainSeconds;
  if (seconds_now - shown_seconds_ < interval && (terminal_ || tenth <= shown_tenth_)) return;
  shown_seconds_ = seconds_now;
  shown_tenth_ = tenth;
  show(world, progress, seconds_now);
}

void Progress::show(const ogive_world* world, const ogive_progress& progress, double seconds_now) {
  const double part = std::clamp((progress.time - start_time_) / (end_time_ - start_time_), 0.0, 1.0);
  const double rate = static_cast<double>(progress.particle_steps - start_particle_steps_) / seconds_now;
  const double remaining = part > 0 ? seconds_now * (1 - part) / part : -1;
  char energy[32];
  std::snprintf(energy, sizeof energy, "%+.2f %%", 100 * ledger_of(world).residual_relative);
  if (!terminal_) {
    std::printf("%s  step %lld  time %s %s  dt %s  %s M particle-steps/s  ETA %s  energy %s\n", percent(part).c_str(),
                static_cast<long long>(progress.steps), brief(progress.time).c_str(), units_.time.c_str(),
                brief(progress.last_time_step).c_str(), brief(rate / 1e6).c_str(), duration(remaining).c_str(), energy);
    std::fflush(stdout);
    return;
  }
  std::string line = percent(part) + " step " + std::to_string(progress.steps) + " t " + brief(progress.time) + ' ' +
                     units_.time + " dt " + brief(progress.last_time_step) + ' ' + brief(rate / 1e6) + " M/s ETA " +
                     duration(remaining) + " energy " + energy;
  // The bar takes what room the figures leave.
  const size_t columns = terminal_columns() - 1;
  if (columns > line.size() + 7) {
    const size_t width = std::min<size_t>(columns - line.size() - 3, 30);
    const auto filled = static_cast<size_t>(part * static_cast<double>(width));
    line = '[' + std::string(filled, '#') + std::string(width - filled, '.') + "] " + line;
  }
  line.resize(std::min(line.size(), columns));
  std::printf("\r%s\033[K", line.c_str());
  std::fflush(stdout);
  line_open_ = true;
}

void Progress::end_line() {
  if (line_open_) std::printf("\n");
  line_open_ = false;
  std::fflush(stdout);
}

}  // namespace driver
