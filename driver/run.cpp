// ogive run and ogive restart: a world is stepped to its end, with output, checkpoints and signals on the way.
#include "run.hpp"

#include <signal.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <thread>

#include "build.hpp"
#include "checkpointing.hpp"
#include "directory_lock.hpp"
#include "output.hpp"
#include "plan.hpp"
#include "progress.hpp"
#include "scene.hpp"
#include "text.hpp"
#include "world.hpp"

namespace driver {
namespace {

// Part of the energy from which on the end of a run says that its ledger does not close.
constexpr double kOpenLedger = 0.02;

volatile sig_atomic_t signal_received = 0;

void remember_signal(int number) { signal_received = number; }

/// From now on these signals only ask for an end after the step. Those that the caller ignores (nohup) stay ignored.
void catch_signals() {
  signal(SIGPIPE, SIG_IGN);  // a run outlives whoever read its progress
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction current {};
    sigaction(number, nullptr, &current);
    if (current.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = remember_signal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(number, &action, nullptr);
  }
}

double process_cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void set_option(Document& document, const std::string& key, const std::string& value, const std::string& option) {
  document.set(key, value, option + ' ' + value);
}

/// Threads that the engine uses for the scene's number, of which 0 stands for all processors of this process.
int32_t threads_in_use(const NumericsScene& numerics) {
  const int32_t wanted = numerics.threads.value_or(1);
  return wanted > 0 ? wanted : static_cast<int32_t>(std::max(1U, std::thread::hardware_concurrency()));
}

const char* stop_name(int32_t stop) {
  switch (stop) {
    case OGIVE_STOP_SETTLED:
      return "settled";
    case OGIVE_STOP_STOPPED:
      return "stopped";
    case OGIVE_STOP_OUT:
      return "out";
    case OGIVE_STOP_EXCHANGE_ENDED:
      return "exchange_ended";
    default:
      return "";
  }
}

/// One run from a prepared world to its end.
class Simulation {
 public:
  /// `again` makes the world that the run begins with once more.
  Simulation(const Scene& scene, World world, const std::filesystem::path& directory, DriverState state,
             std::function<World()> again)
      : scene_(scene),
        again_(std::move(again)),
        world_(std::move(world)),
        directory_(directory),
        state_(std::move(state)),
        output_(scene_, directory_, state_),
        wall_seconds_before_(state_.wall_seconds),
        start_(progress_of(world_.get())),
        whole_steps_(start_.steps),
        display_(scene_.units, start_.time, scene_.stop.time, start_.particle_steps) {}

  ExitCode run_from_start() {
    for (int32_t i = 0; i < ogive_body_count(world_.get()); ++i) {
      const ogive_body_result body = body_result_of(world_.get(), i);
      state_.initial_velocity[ogive_body_name(world_.get(), ogive_body_id{i})] = {body.velocity[0], body.velocity[1],
                                                                                  body.velocity[2]};
    }
    return run_into_new_directory();
  }
  ExitCode run_into_new_directory() {
    output_.start(world_.get(), start_);
    return run();
  }
  ExitCode run_on_in_directory() {
    output_.resume();
    rewind_directory(directory_, state_, start_.steps);
    output_.cut_history();
    return run();
  }

 private:
  ExitCode run() {
    require_ok(ogive_world_set_log(world_.get(), &Simulation::hear, this), world_.get());
    const int64_t steps_left = scene_.stop.max_steps == 0 ? 0 : scene_.stop.max_steps - start_.steps;
    ogive_status status = OGIVE_OK;
    if (start_.time < scene_.stop.time && steps_left >= 0 && !(scene_.stop.max_steps > 0 && steps_left == 0)) {
      status = ogive_world_advance(world_.get(), scene_.stop.time, steps_left, &Simulation::after_step, this);
    }
    display_.end_line();
    if (problem_) std::rethrow_exception(problem_);
    if (status == OGIVE_ERROR_NUMERICAL) save_failed_state();
    require_ok(status, world_.get());

    const std::string reason = stop_reason(progress_of(world_.get()));
    return reason.empty() ? interrupt() : finish(reason);
  }

  static int32_t after_step(ogive_world* world, void* self) {
    return static_cast<Simulation*>(self)->after_step(world);
  }

  /// No exception may pass through the engine: it waits here until the engine has returned.
  int32_t after_step(ogive_world* world) try {
    const double cpu_before = process_cpu_seconds();
    const ogive_progress progress = progress_of(world);
    whole_steps_ = progress.steps;
    output_.write_due(world, progress);
    const int64_t every = scene_.output.checkpoint_steps;
    if (every > 0 && progress.steps % every == 0) save_checkpoint(progress);
    display_.update(world, progress);
    output_cpu_seconds_ += process_cpu_seconds() - cpu_before;
    return signal_received != 0;
  } catch (...) {
    problem_ = std::current_exception();
    return 1;
  }

  double wall_seconds() const { return wall_seconds_before_ + display_.seconds(); }

  std::filesystem::path save_checkpoint(const ogive_progress& progress) {
    const std::filesystem::path file = directory_ / checkpoint_name(progress.steps);
    output_.flush_to_disk();
    state_.wall_seconds = wall_seconds();
    write_checkpoint(world_.get(), file, scene_.text, state_);
    remove_old_checkpoints(directory_, progress.steps, scene_.output.checkpoint_keep);
    return file;
  }

  /// Why the run is over, "" if it was interrupted.
  std::string stop_reason(const ogive_progress& progress) const {
    if (progress.stop != OGIVE_STOP_NONE) return stop_name(progress.stop);
    if (progress.time >= scene_.stop.time) return "time";
    if (scene_.stop.max_steps > 0 && progress.steps >= scene_.stop.max_steps) return "max_steps";
    if (progress.particles == 0) return "empty";
    return "";
  }

  ExitCode finish(const std::string& reason) {
    const ogive_progress progress = progress_of(world_.get());
    const double cpu_before = process_cpu_seconds();
    output_.write_last(world_.get(), progress);
    if (scene_.output.checkpoint_steps > 0) save_checkpoint(progress);
    const double cpu_after = process_cpu_seconds();
    output_cpu_seconds_ += cpu_after - cpu_before;
    const double wall = wall_seconds();
    remove_failed_files(directory_);

    const ogive_ledger ledger = ledger_of(world_.get());
    std::vector<std::string> warnings;
    if (ledger.energy_warning_time >= 0) warnings.push_back(energy_warning(ledger));
    if (const double part = ledger.energy_unaccounted; ledger.energy_warning_time < 0 && std::abs(part) > kOpenLedger)
      warnings.push_back("the energy ledger does not close: " + brief(100 * part) + " % of the energy is not accounted for; finer "
                         "cells, the method persistent, detection of contact by surface, the stress first or a smaller "
                         "time_step_factor may keep it");
    output_.write_summary(world_.get(), {reason, threads_in_use(scene_.numerics), wall, warnings, start_cpu_seconds_,
                                         output_cpu_seconds_, cpu_after - start_cpu_seconds_ - output_cpu_seconds_});

    std::printf("ended (%s) at step %lld, time %s %s, after %s: %s particle-steps/s\n", reason.c_str(),
                static_cast<long long>(progress.steps), brief(progress.time).c_str(), scene_.units.time.c_str(),
                duration(wall).c_str(),
                grouped(static_cast<int64_t>(static_cast<double>(progress.particle_steps) / wall)).c_str());
    std::printf("energy: total %s %s of initially %s, unaccounted %+.3g %%\n", brief(ledger.total).c_str(),
                scene_.units.energy().c_str(), brief(ledger.initial_total).c_str(), 100 * ledger.residual_relative);
    std::printf("%s", output_.results_text(world_.get()).c_str());
    std::printf("results are in %s\n", directory_.c_str());
    std::fflush(stdout);
    // All is written: the limits then decide whether it is a result.
    if (ogive_world_check_energy(world_.get()) == OGIVE_ERROR_NUMERICAL)
      throw Failure(kExitNumerical, std::string("the computation broke down: ") + ogive_world_message(world_.get()) +
                                        "; it had come to its end, the results are in " + directory_.string());
    for (const std::string& warning : warnings) std::fprintf(stderr, "WARNING: %s\n", warning.c_str());
    return kExitOk;
  }

  std::string energy_warning(const ogive_ledger& ledger) const {
    return "the energy grew by " + brief(100 * ledger.energy_growth) + " % (at " + brief(ledger.energy_growth_time) + ' ' +
           scene_.units.time + "; more than numerics.energy_warning since " + brief(ledger.energy_warning_time) + ' ' +
           scene_.units.time + "), which nothing gave it: do not trust the results without a run with better numerics" + cause_;
  }

  /// The engine's word as soon as the energy has grown too much. Its other cautions are in the plan.
  static void hear(void* self, int32_t level, const char* text) {
    const std::string line = text;
    if (level != OGIVE_LOG_WARNING || line.find("the energy has grown by ") != 0) return;
    auto* const simulation = static_cast<Simulation*>(self);
    const size_t cause = line.find("; probable cause: ");
    if (cause != std::string::npos) simulation->cause_ = line.substr(cause);
    simulation->display_.end_line();
    std::fprintf(stderr, "warning: %s\n", text);
  }

  ExitCode interrupt() {
    const ogive_progress progress = progress_of(world_.get());
    const std::filesystem::path file = save_checkpoint(progress);
    std::printf("interrupted at step %lld, time %s %s; to go on: ogive restart %s\n",
                static_cast<long long>(progress.steps), brief(progress.time).c_str(), scene_.units.time.c_str(),
                file.c_str());
    return kExitInterrupted;
  }

  /// After a breakdown, which leaves the world half-way through a step: its particles as they are, for pictures, and the state
  /// before that step, for a restart. Steps give the same bits again, so the latter is made from the last checkpoint. What made
  /// it break is the message that counts.
  [[noreturn]] void save_failed_state() {
    std::string message = ogive_world_message(world_.get());
    try {
      output_.flush_to_disk();
      const std::filesystem::path particles = directory_ / "failed-particles.h5", state = directory_ / "failed-state.h5";
      require_ok(ogive_particles_write(world_.get(), particles.c_str()), world_.get());
      message += "; the particles are in " + particles.string();
      world_.reset();  // its memory may be needed
      const World before = state_before();
      write_checkpoint(before.get(), state, scene_.text, state_);
      message += ", the state of step " + std::to_string(whole_steps_) + " before it in " + state.string();
    } catch (const std::exception& failure) {
      message += "; the state before could not be saved: " + std::string(failure.what());
    }
    throw Failure(kExitNumerical, "the computation broke down: " + message);
  }

  World state_before() {
    World world;
    try {
      std::vector<std::string> ignored;
      if (scene_.output.checkpoint_steps > 0) world = load_checkpoint(directory_, ignored).world;
    } catch (const Failure&) {  // none yet
    }
    if (!world || progress_of(world.get()).steps > whole_steps_) world = again_();
    const int64_t steps = whole_steps_ - progress_of(world.get()).steps;
    if (steps > 0) {
      std::printf("broken down; making the state before it by %lld steps from the last checkpoint or the start\n",
                   static_cast<long long>(steps));
      std::fflush(stdout);  // before what standard error will say
      const auto asked_to_end = [](ogive_world*, void*) -> int32_t { return signal_received != 0; };
      require_ok(ogive_world_advance(world.get(), scene_.stop.time, steps, asked_to_end, nullptr), world.get());
    }
    if (progress_of(world.get()).steps != whole_steps_) throw Failure(kExitInterrupted, "interrupted by a signal");
    return world;
  }

  Scene scene_;
  std::function<World()> again_;
  World world_;
  std::filesystem::path directory_;
  DriverState state_;
  Output output_;
  double wall_seconds_before_;
  ogive_progress start_;
  int64_t whole_steps_;  // done by the last step that was well
  double start_cpu_seconds_ = process_cpu_seconds();
  double output_cpu_seconds_ = 0;
  Progress display_;
  std::exception_ptr problem_;
  std::string cause_;  // of growing energy, as the engine tells it
};

void print_beginning(const Scene& scene, const ogive_world* world, const std::filesystem::path& directory) {
  const ogive_progress progress = progress_of(world);
  std::printf("%s: %s particles in %d bodies, threads %d, to time %s %s, into %s\n", scene.title.c_str(),
              grouped(progress.particles).c_str(), ogive_body_count(world), threads_in_use(scene.numerics),
              brief(scene.stop.time).c_str(), scene.units.time.c_str(), directory.c_str());
  std::fflush(stdout);
}

}  // namespace

ExitCode run(const RunOptions& options) {
  Document document = Document::from_file(options.scene_file, options.settings);
  if (options.until) set_option(document, "stop.time", shortest(*options.until), "--until");
  if (options.threads) set_option(document, "numerics.threads", std::to_string(*options.threads), "--threads");
  const std::filesystem::path directory =
      options.output ? std::filesystem::path(*options.output)
                     : std::filesystem::path(std::filesystem::path(options.scene_file).stem().string() + "-out");
  require_usable_directory(directory, options.overwrite);

  PlannedScene planned = plan_scene(std::move(document), options.scene_file);
  const Scene& scene = planned.scene;
  BuiltWorld& built = planned.built;
  for (const std::string& note : built.notes) std::printf("%s\n", note.c_str());
  std::printf("%s", text_of(planned.decisions).c_str());
  print_beginning(scene, built.world.get(), directory);

  // Only now that the whole model has been accepted is anything written.
  catch_signals();
  make_directory(directory);
  const DirectoryLock lock(directory);
  require_usable_directory(directory, options.overwrite);  // another run may have come and gone
  clear_directory(directory);
  DriverState state;
  state.scene_file = options.scene_file;
  state.plan = planned.decisions;
  state.engine_plan = engine_plan_of(built.world.get());
  return Simulation(scene, std::move(built.world), directory, std::move(state), [&] { return build_world(scene).world; })
      .run_from_start();
}

namespace {

/// The scene that goes on from a checkpoint, the world and the state being changed to it.
Scene changed_scene(const RestartOptions& options, LoadedCheckpoint& loaded) {
  const Scene before = read_scene(Document::from_text(loaded.scene_text, "scene in " + loaded.file.string()),
                                  loaded.state.scene_file);
  Document document = Document::from_text(loaded.scene_text, "scene in " + loaded.file.string());
  document.merge(options.settings);
  if (options.until) set_option(document, "stop.time", shortest(*options.until), "--until");
  if (options.threads) set_option(document, "numerics.threads", std::to_string(*options.threads), "--threads");
  Scene scene = read_scene(document, loaded.state.scene_file);
  const ogive_progress progress = progress_of(loaded.world.get());
  if (scene.stop.time != before.stop.time && scene.stop.time < progress.time) {
    throw Failure(kExitInput, (options.until ? "--until " + shortest(*options.until) : scene.place("stop.time")) +
                                  ": must be >= the checkpoint's time (" + shortest(progress.time) + ' ' + scene.units.time +
                                  ')');
  }
  const std::vector<std::string> changes = model_changes(before, scene);
  if (!changes.empty() && !options.change_model) {
    throw Failure(kExitInput, "--set: changes " + joined(changes) +
                                  " of a run that has begun; expected output, stop or numerics.threads alone, or "
                                  "--change-model where that is meant");
  }
  StopScene same_end = scene.stop;
  same_end.time = before.stop.time;
  same_end.max_steps = before.stop.max_steps;
  if (!changes.empty() || same_end != before.stop) change_world(before, scene, loaded.world.get());
  for (const std::string& setting : options.settings)
    loaded.state.changes.push_back("step " + std::to_string(progress.steps) + ": --set " + setting);
  reschedule(before.output, scene.output, progress.time, loaded.state);
  require_ok(ogive_world_set_threads(loaded.world.get(), scene.numerics.threads.value_or(1)), loaded.world.get());
  return scene;
}

}  // namespace

ExitCode restart(const RestartOptions& options) {
  std::vector<std::string> notes;
  LoadedCheckpoint loaded = load_checkpoint(options.checkpoint, notes);
  std::filesystem::path home = loaded.file.parent_path();
  if (home.empty()) home = ".";
  const std::filesystem::path directory = options.output ? std::filesystem::path(*options.output) : home;
  std::error_code ignored;
  const bool at_home = std::filesystem::equivalent(directory, home, ignored);
  if (!at_home) {
    require_usable_directory(directory, options.overwrite);
    make_directory(directory);
  }
  const DirectoryLock lock(directory);
  if (at_home) {  // another run may have gone on here between the loading and the lock
    notes.clear();
    loaded = load_checkpoint(options.checkpoint, notes);
  }
  for (const std::string& note : notes) std::printf("%s\n", note.c_str());

  const Scene scene = changed_scene(options, loaded);
  const ogive_progress progress = progress_of(loaded.world.get());
  std::printf("from %s: step %lld, time %s %s\n", loaded.file.c_str(), static_cast<long long>(progress.steps),
              brief(progress.time).c_str(), scene.units.time.c_str());
  print_beginning(scene, loaded.world.get(), directory);

  catch_signals();
  if (!at_home) clear_directory(directory);
  const auto again = [&, file = loaded.file] {
    LoadedCheckpoint once_more = load_checkpoint(file, notes);
    changed_scene(options, once_more);
    return std::move(once_more.world);
  };
  Simulation simulation(scene, std::move(loaded.world), directory, std::move(loaded.state), again);
  // A checkpoint that was brought here alone has no history to go on with.
  const bool has_history = at_home && std::filesystem::exists(directory / "history.csv", ignored);
  return has_history ? simulation.run_on_in_directory() : simulation.run_into_new_directory();
}

}  // namespace driver
