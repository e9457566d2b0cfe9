// What a run leaves in its directory: history.csv, particle files with their time series, summary.json.
#include "output.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "text.hpp"

namespace driver {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kHistory = "history.csv";
constexpr const char* kSummary = "summary.json";
constexpr const char* kSeries = "particles.xdmf";
const std::set<std::string> kFailedFiles = {"failed-state.h5", "failed-particles.h5"};

std::string particle_file_name(int64_t number) {
  char name[48];
  std::snprintf(name, sizeof name, "particles-%05lld.h5", static_cast<long long>(number));
  return name;
}

bool has_form(const std::string& name, const std::string& beginning, const std::string& ending) {
  return name.size() >= beginning.size() + ending.size() && name.compare(0, beginning.size(), beginning) == 0 &&
         name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

bool is_particle_file(const std::string& name) { return has_form(name, "particles-", ".h5"); }

bool is_run_file(const std::string& name) {
  static const std::set<std::string> names = {kHistory, kSummary, kSeries};
  return names.count(name) || kFailedFiles.count(name) || is_particle_file(name) || has_form(name, "checkpoint-", ".h5");
}

/// What a kill in the middle of writing leaves: a run file's name with .tmp-<process>.
bool is_unfinished_file(const std::string& name) {
  const size_t at = name.rfind(".tmp-");
  return at != std::string::npos && is_run_file(name.substr(0, at));
}

/// Names of a directory's files that a run wrote; none if there is no directory.
std::vector<std::string> run_files_in(const std::filesystem::path& directory) {
  std::vector<std::string> names;
  std::error_code problem;
  for (const auto& entry : std::filesystem::directory_iterator(directory, problem)) {
    const std::string name = entry.path().filename().string();
    if (is_run_file(name) || is_unfinished_file(name)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

void remove_file(const std::filesystem::path& file) {
  std::error_code problem;
  std::filesystem::remove(file, problem);
  if (problem) throw Failure(kExitFile, file.string() + ": cannot be removed: " + problem.message());
}

/// One row of the history: names for the heading, values as text.
class Row {
 public:
  void add(const std::string& name, double value) { add_text(name, exact(value)); }
  void add(const std::string& name, int64_t value) { add_text(name, std::to_string(value)); }
  void add(const std::string& name, const double (&vector)[3]) {
    add(name + "_x", vector[0]);
    add(name + "_y", vector[1]);
    add(name + "_z", vector[2]);
  }
  std::string heading() const { return heading_ + '\n'; }
  std::string values() const { return values_ + '\n'; }

 private:
  void add_text(const std::string& name, const std::string& value) {
    heading_ += (heading_.empty() ? "" : ",") + name;
    values_ += (values_.empty() ? "" : ",") + value;
  }
  std::string heading_, values_;
};

void add_ledger(Row& row, const ogive_ledger& ledger) {
  row.add("mass", ledger.mass);
  row.add("left_domain_mass", ledger.left_domain_mass);
  row.add("momentum", ledger.momentum);
  row.add("left_domain_momentum", ledger.left_domain_momentum);
  row.add("boundary_impulse", ledger.boundary_impulse);
  row.add("external_impulse", ledger.external_impulse);
  row.add("kinetic", ledger.kinetic);
  row.add("internal", ledger.internal);
  row.add("plastic_dissipation", ledger.plastic_dissipation);
  row.add("viscous_dissipation", ledger.viscous_dissipation);
  row.add("failure_loss", ledger.failure_loss);
  row.add("left_domain_energy", ledger.left_domain_energy);
  row.add("friction_dissipation", ledger.friction_dissipation);
  row.add("transfer_dissipation", ledger.transfer_dissipation);
  row.add("contact_work", ledger.contact_work);
  row.add("boundary_work", ledger.boundary_work);
  row.add("external_work", ledger.external_work);
  row.add("prescribed_work", ledger.prescribed_work);
  row.add("contact_dissipation", ledger.contact_dissipation);
  row.add("total", ledger.total);
  row.add("residual", ledger.residual);
  row.add("residual_relative", ledger.residual_relative);
  row.add("maximum_speed", ledger.maximum_speed);
  row.add("maximum_speed_ever", ledger.maximum_speed_ever);
  row.add("angular_momentum", ledger.angular_momentum);
  row.add("contact_couple", ledger.contact_couple);
  row.add("dropped_mass", ledger.dropped_mass);
  row.add("dropped_momentum", ledger.dropped_momentum);
  row.add("dropped_angular_momentum", ledger.dropped_angular_momentum);
  row.add("dropped_energy", ledger.dropped_energy);
}

void add_body(Row& row, const std::string& name, const ogive_body_result& body) {
  row.add(name + ".particles", body.particles);
  row.add(name + ".failed_particles", body.failed_particles);
  row.add(name + ".left_domain", body.left_domain);
  row.add(name + ".dropped_particles", body.dropped_particles);
  row.add(name + ".mass", body.mass);
  row.add(name + ".momentum", body.momentum);
  row.add(name + ".velocity", body.velocity);
  row.add(name + ".speed", body.speed);
  row.add(name + ".centre", body.centre);
  row.add(name + ".contact_force", body.contact_force);
  row.add(name + ".kinetic", body.kinetic);
  row.add(name + ".internal", body.internal);
  row.add(name + ".failure_loss", body.failure_loss);
  row.add(name + ".maximum_plastic_strain", body.maximum_plastic_strain);
  row.add(name + ".maximum_temperature", body.maximum_temperature);
  row.add(name + ".angular_momentum", body.angular_momentum);
  row.add(name + ".angular_velocity", body.angular_velocity);
}

/// Number of the first output that is due after `time`.
int64_t next_due(int64_t next, double interval, double time) {
  const auto skipped = static_cast<int64_t>(std::floor(time / interval));
  next = std::max(next, skipped);
  while (static_cast<double>(next) * interval <= time) ++next;
  return next;
}

Json json_of(const double (&vector)[3]) { return Json{vector[0], vector[1], vector[2]}; }

Json body_json(const ogive_body_result& body) {
  Json json;
  json["particles"] = body.particles;
  json["mass"] = body.mass;
  json["velocity"] = json_of(body.velocity);
  json["speed"] = body.speed;
  json["initial_speed"] = body.initial_speed;
  json["momentum"] = json_of(body.momentum);
  json["centre"] = json_of(body.centre);
  json["lower"] = json_of(body.lower);
  json["upper"] = json_of(body.upper);
  json["kinetic"] = body.kinetic;
  json["internal"] = body.internal;
  json["failed_particles"] = body.failed_particles;
  json["failed_mass"] = body.failed_mass;
  json["first_failure_time"] = body.first_failure_time < 0 ? Json() : Json(body.first_failure_time);
  json["failure_loss"] = body.failure_loss;
  json["left_domain"] = body.left_domain;
  json["left_domain_mass"] = body.left_domain_mass;
  json["dropped_particles"] = body.dropped_particles;
  json["dropped_mass"] = body.dropped_mass;
  json["maximum_plastic_strain"] = body.maximum_plastic_strain;
  json["maximum_temperature"] = body.maximum_temperature;
  json["angular_momentum"] = json_of(body.angular_momentum);
  json["angular_velocity"] = json_of(body.angular_velocity);
  return json;
}

Json energy_json(const ogive_ledger& ledger) {
  Json json;
  json["kinetic"] = ledger.kinetic;
  json["internal"] = ledger.internal;
  json["plastic_dissipation"] = ledger.plastic_dissipation;
  json["viscous_dissipation"] = ledger.viscous_dissipation;
  json["failure_loss"] = ledger.failure_loss;
  json["left_domain_energy"] = ledger.left_domain_energy;
  json["dropped_energy"] = ledger.dropped_energy;
  json["friction_dissipation"] = ledger.friction_dissipation;
  json["transfer_dissipation"] = ledger.transfer_dissipation;
  json["contact_work"] = ledger.contact_work;
  json["boundary_work"] = ledger.boundary_work;
  json["external_work"] = ledger.external_work;
  json["prescribed_work"] = ledger.prescribed_work;
  json["contact_dissipation"] = ledger.contact_dissipation;
  json["total"] = ledger.total;
  json["initial_total"] = ledger.initial_total;
  json["residual"] = ledger.residual;
  json["residual_relative"] = ledger.residual_relative;
  json["unaccounted"] = ledger.energy_unaccounted;
  json["growth"] = ledger.energy_growth;
  json["growth_time"] = ledger.energy_growth_time;
  json["warning_time"] = ledger.energy_warning_time < 0 ? Json() : Json(ledger.energy_warning_time);
  return json;
}

int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<int64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

void require_usable_directory(const std::filesystem::path& directory, bool overwrite) {
  if (directory.empty()) throw Failure(kExitInput, "--output: must be the name of a directory, got an empty text");
  std::error_code ignored;
  if (!std::filesystem::exists(directory, ignored)) return;
  if (!std::filesystem::is_directory(directory, ignored)) {
    throw Failure(kExitFile, directory.string() + ": is not a directory; expected one, or a name that is free");
  }
  const std::vector<std::string> found = run_files_in(directory);
  if (!found.empty() && !overwrite) {
    throw Failure(kExitFile, directory.string() + ": holds an earlier run (" + found.front() +
                                 "); give another directory with --output, or --overwrite to replace it");
  }
}

void make_directory(const std::filesystem::path& directory) {
  std::error_code problem;
  std::filesystem::create_directories(directory, problem);
  if (problem) throw Failure(kExitFile, directory.string() + ": cannot be made: " + problem.message());
}

void clear_directory(const std::filesystem::path& directory) {
  for (const std::string& name : run_files_in(directory)) remove_file(directory / name);
}

void remove_failed_files(const std::filesystem::path& directory) {
  std::error_code ignored;
  for (const std::string& name : kFailedFiles) std::filesystem::remove(directory / name, ignored);
}

void rewind_directory(const std::filesystem::path& directory, const DriverState& state, int64_t steps) {
  remove_later_checkpoints(directory, steps);
  const std::set<std::string> kept(state.particle_files.begin(), state.particle_files.end());
  for (const std::string& name : run_files_in(directory)) {
    const bool later_particles = is_particle_file(name) && !kept.count(name);
    // The state before a breakdown stays until there is a better one: it may be what goes on.
    const bool stale = later_particles || name == kSummary || is_unfinished_file(name);
    if (stale) remove_file(directory / name);
  }
}

void reschedule(const OutputScene& before, const OutputScene& after, double time, DriverState& state) {
  if (after.history_interval != before.history_interval) state.next_history = next_due(0, after.history_interval, time);
  if (after.particle_interval != before.particle_interval && after.particle_interval > 0)
    state.next_particles = next_due(0, after.particle_interval, time);
}

Output::Output(const Scene& scene, const std::filesystem::path& directory, DriverState& state)
    : scene_(scene), directory_(directory), state_(state) {}

void Output::start(ogive_world* world, const ogive_progress& progress) {
  history_.create(directory_ / kHistory);
  state_.particle_files.clear();
  state_.last_history_step = state_.last_particle_step = -1;
  write_due(world, progress);
  // After a restart into a directory of its own nothing need be due, yet the files begin with the state that it started
  // from.
  write_last(world, progress);
}

void Output::resume() {
  history_.resume(directory_ / kHistory, state_.history_bytes, state_.history_sum);
  for (const std::string& name : state_.particle_files) {
    if (!std::filesystem::exists(directory_ / name)) {
      throw Failure(kExitFile, (directory_ / name).string() +
                                   ": is missing, and the time series goes on from it; give another directory with "
                                   "--output");
    }
  }
}

void Output::write_due(ogive_world* world, const ogive_progress& progress) {
  const OutputScene& output = scene_.output;
  if (static_cast<double>(state_.next_history) * output.history_interval <= progress.time) {
    state_.next_history = next_due(state_.next_history, output.history_interval, progress.time);
    write_history_row(world, progress);
  }
  if (output.particle_interval > 0 &&
      static_cast<double>(state_.next_particles) * output.particle_interval <= progress.time) {
    state_.next_particles = next_due(state_.next_particles, output.particle_interval, progress.time);
    write_particles(world, progress);
  }
}

void Output::write_last(ogive_world* world, const ogive_progress& progress) {
  if (state_.last_history_step != progress.steps) write_history_row(world, progress);
  if (scene_.output.particle_interval > 0 && state_.last_particle_step != progress.steps) {
    write_particles(world, progress);
  }
}

void Output::write_history_row(const ogive_world* world, const ogive_progress& progress) {
  Row row;
  row.add("step", progress.steps);
  row.add("time", progress.time);
  row.add("time_step", progress.last_time_step);
  row.add("particles", progress.particles);
  add_ledger(row, ledger_of(world));
  for (int32_t i = 0; i < ogive_body_count(world); ++i) {
    const std::string name = ogive_body_name(world, ogive_body_id{i});
    const ogive_body_result body = body_result_of(world, i);
    add_body(row, name, body);
    if (body.particles > 0) std::copy_n(body.velocity, 3, state_.last_velocity[name].begin());
  }
  if (history_.size() == 0) history_.append(row.heading());
  history_.append(row.values());
  state_.last_history_step = progress.steps;
  state_.history_bytes = history_.size();
  state_.history_sum = history_.sum();
}

void Output::write_particles(ogive_world* world, const ogive_progress& progress) {
  const std::string name = particle_file_name(state_.particle_files_written);
  require_ok(ogive_particles_write(world, (directory_ / name).c_str()), world);
  state_.particle_files.push_back(name);
  ++state_.particle_files_written;
  state_.last_particle_step = progress.steps;
  std::vector<const char*> names;
  for (const std::string& file : state_.particle_files) names.push_back(file.c_str());
  require_ok(
      ogive_series_write(world, (directory_ / kSeries).c_str(), static_cast<int32_t>(names.size()), names.data()),
      world);
}

double Output::result(const ogive_world* world, const ResultScene& wanted) const {
  // residual_velocity, the only kind so far: 0 once the body does not go forward any more.
  const ogive_body_result body = body_result_of(world, find_body(world, wanted.body));
  std::array<double, 3> velocity{body.velocity[0], body.velocity[1], body.velocity[2]};
  double speed = body.speed;
  const auto last = state_.last_velocity.find(wanted.body);
  if (body.particles == 0 && last != state_.last_velocity.end()) {
    velocity = last->second;
    speed = std::hypot(velocity[0], velocity[1], velocity[2]);
  }
  const auto initial = state_.initial_velocity.find(wanted.body);
  if (initial == state_.initial_velocity.end() || body.initial_speed == 0) return speed;
  double forward = 0;
  for (size_t axis = 0; axis < 3; ++axis) forward += velocity[axis] * initial->second[axis];
  return forward > 0 ? speed : 0.0;
}

void Output::write_summary(ogive_world* world, const RunFacts& facts) const {
  const ogive_progress progress = progress_of(world);
  const ogive_ledger ledger = ledger_of(world);
  Json json;
  json["scene"] = scene_.file.string();
  json["title"] = scene_.title;
  json["version"] = ogive_version();
  json["units"] = {{"length", scene_.units.length}, {"time", scene_.units.time}, {"mass", scene_.units.mass}};
  json["parameters"] = scene_.parameters;
  json["threads"] = facts.threads;
  json["steps"] = progress.steps;
  json["time"] = progress.time;
  json["stop_reason"] = facts.stop_reason;
  json["particles"] = progress.particles;
  json["particle_steps"] = progress.particle_steps;
  json["resting_particle_steps"] = progress.resting_particle_steps;
  json["wall_seconds"] = facts.wall_seconds;
  json["particle_steps_per_second"] =
      facts.wall_seconds > 0 ? static_cast<double>(progress.particle_steps) / facts.wall_seconds : 0.0;
  json["cpu_seconds"] = {{"start", facts.start_cpu_seconds},
                         {"stepping", facts.stepping_cpu_seconds},
                         {"output", facts.output_cpu_seconds}};
  json["peak_memory_bytes"] = peak_memory_bytes();
  for (int32_t i = 0; i < ogive_body_count(world); ++i) {
    json["bodies"][ogive_body_name(world, ogive_body_id{i})] = body_json(body_result_of(world, i));
  }
  json["mass"] = ledger.mass;
  json["left_domain_mass"] = ledger.left_domain_mass;
  json["dropped_mass"] = ledger.dropped_mass;
  json["momentum"] = json_of(ledger.momentum);
  json["left_domain_momentum"] = json_of(ledger.left_domain_momentum);
  json["dropped_momentum"] = json_of(ledger.dropped_momentum);
  json["boundary_impulse"] = json_of(ledger.boundary_impulse);
  json["external_impulse"] = json_of(ledger.external_impulse);
  json["energy"] = energy_json(ledger);
  json["maximum_speed_ever"] = ledger.maximum_speed_ever;
  json["plan"] = {{"decisions", plan_json(state_.plan)}, {"engine", state_.engine_plan}};
  json["changes"] = state_.changes;
  json["warnings"] = facts.warnings;
  json["results"] = Json::object();
  for (const ResultScene& wanted : scene_.output.results) json["results"][wanted.name] = result(world, wanted);
  write_whole_file(directory_ / kSummary, json.dump(2) + '\n');
}

std::string Output::results_text(const ogive_world* world) const {
  std::string text;
  for (const ResultScene& wanted : scene_.output.results) {
    std::string name = wanted.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    text += name + " of " + wanted.body + ": " + brief(result(world, wanted)) + ' ' + scene_.units.speed() + '\n';
  }
  return text;
}

}  // namespace driver
