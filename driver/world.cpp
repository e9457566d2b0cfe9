// Ownership and errors of the C interface.
#include "world.hpp"

#include <sstream>

namespace driver {

World make_world() {
  ogive_world* world = nullptr;
  const ogive_status status = ogive_world_create(&world);
  if (status != OGIVE_OK) throw Failure(exit_code(status), std::string("a world: ") + ogive_status_name(status));
  return World(world);
}

ExitCode exit_code(ogive_status status) {
  switch (status) {
    case OGIVE_OK:
      return kExitOk;
    case OGIVE_ERROR_ARGUMENT:
      return kExitInput;
    case OGIVE_ERROR_MEMORY:
      return kExitMemory;
    case OGIVE_ERROR_NUMERICAL:
      return kExitNumerical;
    case OGIVE_ERROR_FILE:
      return kExitFile;
    case OGIVE_ERROR_FORMAT:
      return kExitDamaged;
    default:
      return kExitInternal;
  }
}

void require_ok(ogive_status status, const ogive_world* world, const std::string& place) {
  if (status == OGIVE_OK) return;
  std::string message = ogive_world_message(world);
  if (message.empty()) message = ogive_status_name(status);
  throw Failure(exit_code(status), place.empty() ? message : place + ": " + message);
}

std::string text_of(const std::function<ogive_status(char*, size_t, size_t*)>& call, ogive_status& status) {
  std::string text(4096, '\0');
  size_t needed = 0;
  status = call(text.data(), text.size(), &needed);
  if (needed > text.size()) {
    text.assign(needed, '\0');
    status = call(text.data(), text.size(), &needed);
  }
  text.resize(text.find('\0') == std::string::npos ? text.size() : text.find('\0'));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

std::vector<std::string> engine_plan_of(const ogive_world* world) {
  ogive_status status = OGIVE_OK;
  std::istringstream text(text_of(
      [&](char* to, size_t capacity, size_t* needed) { return ogive_world_plan(world, to, capacity, needed); }, status));
  require_ok(status, world);
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

ogive_progress progress_of(const ogive_world* world) {
  ogive_progress progress{};
  progress.struct_size = sizeof progress;
  require_ok(ogive_world_progress(world, &progress), world);
  return progress;
}

ogive_ledger ledger_of(const ogive_world* world) {
  ogive_ledger ledger{};
  ledger.struct_size = sizeof ledger;
  require_ok(ogive_world_ledger(world, &ledger), world);
  return ledger;
}

ogive_body_result body_result_of(const ogive_world* world, int32_t body) {
  ogive_body_result result{};
  result.struct_size = sizeof result;
  require_ok(ogive_body_result_get(world, ogive_body_id{body}, &result), world);
  return result;
}

int32_t find_body(const ogive_world* world, const std::string& name) {
  ogive_body_id id{-1};
  require_ok(ogive_body_find(world, name.c_str(), &id), world);
  return id.index;
}

}  // namespace driver
