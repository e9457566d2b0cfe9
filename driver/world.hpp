// Ownership and errors of the C interface: a world that is released by itself, statuses that become Failures.
#pragma once

#include <ogive.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "failure.hpp"

namespace driver {

struct WorldRelease {
  void operator()(ogive_world* world) const { ogive_world_destroy(world); }
};
using World = std::unique_ptr<ogive_world, WorldRelease>;

World make_world();

/// Exit code for a status of the engine once the scene has been accepted.
ExitCode exit_code(ogive_status status);

/// Throws with the world's message, after `place` where there is one.
void require_ok(ogive_status status, const ogive_world* world, const std::string& place = "");

/// Text of a call that writes at most `capacity` bytes and says how many are needed.
std::string text_of(const std::function<ogive_status(char* text, size_t capacity, size_t* needed)>& call,
                    ogive_status& status);

/// The engine's plan of a prepared world, in lines.
std::vector<std::string> engine_plan_of(const ogive_world* world);

ogive_progress progress_of(const ogive_world* world);
ogive_ledger ledger_of(const ogive_world* world);
ogive_body_result body_result_of(const ogive_world* world, int32_t body);
int32_t find_body(const ogive_world* world, const std::string& name);

}  // namespace driver
