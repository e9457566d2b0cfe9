// ogive check: what a scene would do, without doing it.
#include "check.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>

#include "plan.hpp"
#include "scene.hpp"
#include "text.hpp"

namespace driver {
namespace {

std::string in_words(const double (&vector)[3]) {
  return '[' + brief(vector[0]) + ", " + brief(vector[1]) + ", " + brief(vector[2]) + ']';
}

/// Seconds of one step, from a few steps that nobody keeps. The first sorts and allocates, so it does not count.
double measured_step_seconds(ogive_world* world) {
  using Clock = std::chrono::steady_clock;
  require_ok(ogive_world_step(world, 0), world);
  const Clock::time_point start = Clock::now();
  int steps = 0;
  double seconds = 0;
  do {
    require_ok(ogive_world_step(world, 0), world);
    ++steps;
    seconds = std::chrono::duration<double>(Clock::now() - start).count();
  } while (seconds < 0.3 && steps < 100);
  return seconds / steps;
}

}  // namespace

ExitCode check(const std::string& scene_file, const std::vector<std::string>& settings) {
  const PlannedScene planned = plan_scene(Document::from_file(scene_file, settings), scene_file);
  const Scene& scene = planned.scene;
  ogive_world* const world = planned.built.world.get();
  for (const std::string& note : planned.built.notes) std::printf("%s\n", note.c_str());

  std::printf("%s\n\nplan:\n%s", scene.title.c_str(), text_of(planned.decisions).c_str());
  for (const std::string& line : engine_plan_of(world)) std::printf("%s\n", line.c_str());
  std::printf("\nbodies:\n");
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    const ogive_body_result body = body_result_of(world, static_cast<int32_t>(i));
    std::printf("  %s: %s, %s particles, mass %s %s, %s to %s %s, speed %s %s\n", scene.bodies[i].name.c_str(),
                scene.bodies[i].material.c_str(), grouped(body.particles).c_str(), brief(body.mass).c_str(),
                scene.units.mass.c_str(), in_words(body.lower).c_str(), in_words(body.upper).c_str(),
                scene.units.length.c_str(), brief(body.speed).c_str(), scene.units.speed().c_str());
  }

  double time_step = 0;
  require_ok(ogive_world_stable_time_step(world, &time_step), world);
  // As if waves had reached everything: what is still at rest costs nothing in the first steps.
  Scene moving = scene;
  moving.numerics.skip_resting = false;
  change_world(scene, moving, world);
  const double step_seconds = measured_step_seconds(world);
  double steps = std::ceil(scene.stop.time / time_step);
  if (scene.stop.max_steps > 0) steps = std::fmin(steps, static_cast<double>(scene.stop.max_steps));
  const ogive_progress progress = progress_of(world);
  std::printf("\nparticles: %s\n", grouped(progress.particles).c_str());
  std::printf("memory: %s\n", bytes(progress.memory_bytes).c_str());
  std::printf(
      "steps: about %s of %s %s to time %s %s; stress may make them shorter, stop conditions may end them sooner\n",
      (steps < 1e15 ? grouped(static_cast<int64_t>(steps)) : brief(steps)).c_str(), brief(time_step).c_str(),
      scene.units.time.c_str(), brief(scene.stop.time).c_str(), scene.units.time.c_str());
  std::printf("time: about %s at %s particle-steps/s here and now\n", duration(steps * step_seconds).c_str(),
              grouped(static_cast<int64_t>(static_cast<double>(progress.particles) / step_seconds)).c_str());
  return kExitOk;
}

}  // namespace driver
