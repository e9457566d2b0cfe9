// Checkpoints: the world with what the program needs to go on as if it had never stopped.
#include "checkpointing.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace driver {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSceneAttachment = "ogive.scene";
constexpr const char* kStateAttachment = "ogive.driver";
constexpr int kStateVersion = 1;

std::string to_text(const DriverState& state) {
  Json json;
  json["version"] = kStateVersion;
  json["scene_file"] = state.scene_file;
  json["next_history"] = state.next_history;
  json["next_particles"] = state.next_particles;
  json["last_history_step"] = state.last_history_step;
  json["last_particle_step"] = state.last_particle_step;
  json["history_bytes"] = state.history_bytes;
  json["history_sum"] = state.history_sum;
  json["particle_files_written"] = state.particle_files_written;
  json["particle_files"] = state.particle_files;
  json["wall_seconds"] = state.wall_seconds;
  json["initial_velocity"] = state.initial_velocity;
  json["last_velocity"] = state.last_velocity;
  json["plan"] = plan_json(state.plan);
  json["engine_plan"] = state.engine_plan;
  json["changes"] = state.changes;
  return json.dump();
}

std::vector<Decision> plan_of(const Json& json) {
  std::vector<Decision> plan;
  for (const Json& entry : json)
    plan.push_back({entry.at("subject").get<std::string>(), entry.at("decision").get<std::string>(), entry.at("reason").get<std::string>(),
                    entry.at("overrule").get<std::string>(), entry.at("taken").get<bool>()});
  return plan;
}

DriverState from_text(const std::string& text) {
  const Json json = Json::parse(text);
  if (json.at("version").get<int>() != kStateVersion) throw std::runtime_error("unknown version");
  DriverState state;
  json.at("scene_file").get_to(state.scene_file);
  json.at("next_history").get_to(state.next_history);
  json.at("next_particles").get_to(state.next_particles);
  json.at("last_history_step").get_to(state.last_history_step);
  json.at("last_particle_step").get_to(state.last_particle_step);
  json.at("history_bytes").get_to(state.history_bytes);
  json.at("history_sum").get_to(state.history_sum);
  json.at("particle_files_written").get_to(state.particle_files_written);
  json.at("particle_files").get_to(state.particle_files);
  // They are looked for in the output directory, and not beyond it.
  for (const std::string& name : state.particle_files)
    if (name.empty() || name.find('/') != std::string::npos || name == "..")
      throw std::runtime_error("\"" + name + "\" is not the name of a particle file");
  if (state.history_bytes < 0 || state.next_history < 0 || state.next_particles < 0 || state.particle_files_written < 0)
    throw std::runtime_error("a count is negative");
  json.at("wall_seconds").get_to(state.wall_seconds);
  json.at("initial_velocity").get_to(state.initial_velocity);
  json.at("last_velocity").get_to(state.last_velocity);
  if (json.contains("plan")) state.plan = plan_of(json.at("plan"));  // neither is in older checkpoints
  if (json.contains("engine_plan")) json.at("engine_plan").get_to(state.engine_plan);
  if (json.contains("changes")) json.at("changes").get_to(state.changes);  // not in checkpoints of 0.2.0
  return state;
}

std::string attachment(const LoadedCheckpoint& checkpoint, const char* name) {
  const void* data = nullptr;
  int64_t size = 0;
  if (ogive_world_attachment(checkpoint.world.get(), name, &data, &size) != OGIVE_OK) {
    throw Failure(kExitDamaged, checkpoint.file.string() + ": holds no \"" + name +
                                    "\"; expected a checkpoint that the program ogive wrote");
  }
  return std::string(static_cast<const char*>(data), static_cast<size_t>(size));
}

LoadedCheckpoint load_file(const std::filesystem::path& file) {
  LoadedCheckpoint checkpoint{make_world(), file, "", {}};
  const ogive_status status = ogive_checkpoint_read(checkpoint.world.get(), file.c_str());
  if (status != OGIVE_OK) {
    std::string message = ogive_world_message(checkpoint.world.get());
    if (message.empty()) message = ogive_status_name(status);
    if (message.find(file.string()) == std::string::npos) message = file.string() + ": " + message;
    throw Failure(status == OGIVE_ERROR_ARGUMENT ? kExitDamaged : exit_code(status), message);
  }
  checkpoint.scene_text = attachment(checkpoint, kSceneAttachment);
  try {
    checkpoint.state = from_text(attachment(checkpoint, kStateAttachment));
  } catch (const Failure&) {
    throw;
  } catch (const std::exception& error) {
    throw Failure(kExitDamaged, file.string() + ": its \"" + kStateAttachment + "\" cannot be read: " + error.what());
  }
  return checkpoint;
}

/// Step number in a checkpoint's name, -1 if it is not one.
int64_t steps_in_name(const std::string& name) {
  long long steps = -1;
  int length = 0;
  if (std::sscanf(name.c_str(), "checkpoint-%lld.h5%n", &steps, &length) != 1) return -1;
  return steps >= 0 && name == checkpoint_name(steps) ? steps : -1;
}

/// Step numbers of the checkpoints in a directory, rising.
std::vector<int64_t> checkpoints_in(const std::filesystem::path& directory) {
  std::vector<int64_t> found;
  std::error_code problem;
  for (const auto& entry : std::filesystem::directory_iterator(directory, problem)) {
    const int64_t steps = steps_in_name(entry.path().filename().string());
    if (steps >= 0) found.push_back(steps);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

nlohmann::ordered_json plan_json(const std::vector<Decision>& plan) {
  Json list = Json::array();
  for (const Decision& decision : plan)
    list.push_back({{"subject", decision.subject}, {"decision", decision.decision}, {"reason", decision.reason},
                    {"overrule", decision.overrule}, {"taken", decision.taken}});
  return list;
}

std::string checkpoint_name(int64_t steps) {
  char name[48];
  std::snprintf(name, sizeof name, "checkpoint-%09lld.h5", static_cast<long long>(steps));
  return name;
}

void write_checkpoint(ogive_world* world, const std::filesystem::path& file, const std::string& scene_text,
                      const DriverState& state) {
  const std::string state_text = to_text(state);
  require_ok(ogive_world_attach(world, kSceneAttachment, scene_text.data(), static_cast<int64_t>(scene_text.size())),
             world);
  require_ok(ogive_world_attach(world, kStateAttachment, state_text.data(), static_cast<int64_t>(state_text.size())),
             world);
  require_ok(ogive_checkpoint_write(world, file.c_str()), world);
}

void remove_later_checkpoints(const std::filesystem::path& directory, int64_t steps) {
  const std::vector<int64_t> found = checkpoints_in(directory);
  for (auto at = found.rbegin(); at != found.rend() && *at > steps; ++at) {
    std::error_code problem;
    const std::filesystem::path file = directory / checkpoint_name(*at);
    std::filesystem::remove(file, problem);
    if (problem) throw Failure(kExitFile, file.string() + ": cannot be removed: " + problem.message());
  }
}

void remove_old_checkpoints(const std::filesystem::path& directory, int64_t steps, int64_t keep) {
  std::vector<int64_t> found = checkpoints_in(directory);
  found.erase(std::upper_bound(found.begin(), found.end(), steps), found.end());
  std::error_code ignored;
  for (size_t i = 0; i + static_cast<size_t>(keep) < found.size(); ++i) {
    std::filesystem::remove(directory / checkpoint_name(found[i]), ignored);
  }
}

LoadedCheckpoint load_checkpoint(const std::filesystem::path& file_or_directory, std::vector<std::string>& notes) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(file_or_directory, ignored)) {
    try {
      return load_file(file_or_directory);
    } catch (const Failure& failure) {
      if (failure.code() != kExitDamaged) throw;
      // An older one may still be good: say which to try.
      const std::filesystem::path directory = file_or_directory.parent_path();
      const std::vector<int64_t> others = checkpoints_in(directory.empty() ? "." : directory);
      const int64_t steps = steps_in_name(file_or_directory.filename().string());
      const auto later = std::lower_bound(others.begin(), others.end(), steps);
      if (steps < 0 || later == others.begin()) throw;
      const std::filesystem::path earlier = directory / checkpoint_name(*(later - 1));
      throw Failure(kExitDamaged, std::string(failure.what()) + "; the one before it is " + earlier.string());
    }
  }
  const std::vector<int64_t> found = checkpoints_in(file_or_directory);
  for (auto at = found.rbegin(); at != found.rend(); ++at) {
    try {
      return load_file(file_or_directory / checkpoint_name(*at));
    } catch (const Failure& failure) {
      if (failure.code() != kExitDamaged) throw;
      notes.push_back(std::string("refused: ") + failure.what());
    }
  }
  throw Failure(found.empty() ? kExitFile : kExitDamaged,
                file_or_directory.string() + ": holds no " + (found.empty() ? "" : "undamaged ") + "checkpoint-*.h5");
}

}  // namespace driver
