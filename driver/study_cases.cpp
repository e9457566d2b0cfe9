// The cases of a study: made from its sweeps, run by processes of this program, kept by what they compute.
#include "study_cases.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <ogive.h>
#include <ogive_geometry.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "failure.hpp"
#include "files.hpp"
#include "scene.hpp"
#include "text.hpp"

namespace driver {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
using Labels = std::map<std::string, std::string>;

constexpr const char* kRecord = "case.json";

volatile sig_atomic_t interruption = 0;
void remember_interruption(int number) { interruption = number; }

/// FNV-1a with two starts: 128 bits. Identities are compared in full as well, so that it need not be proof against malice.
std::string checksum(const std::string& text) {
  uint64_t a = 14695981039346656037ULL, b = 0x9E3779B97F4A7C15ULL;
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    a = (a ^ byte) * 1099511628211ULL;
    b = (b ^ byte) * 0x100000001B3ULL + (b >> 29);
  }
  char digits[33];
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(a), static_cast<unsigned long long>(b));
  return digits;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string in_words(const Labels& labels) {
  std::string words;
  for (const auto& [axis, label] : labels) words += (words.empty() ? "" : ", ") + axis + " " + label;
  return words.empty() ? "the only case" : words;
}

/// What decides the result: the scene with all its settings, the files that it names, the engine. Not the title.
void identify(const Study& study, const std::string& engine, StudyCase& of) {
  std::vector<std::string> texts;
  for (const StudySetting& setting : of.settings) texts.push_back(setting.text);
  try {
    Document document = Document::from_file(study.scene, texts);
    const Scene scene = read_scene(document, study.scene);
    document.set("title", "-", "study");
    of.units = scene.units;
    of.parameters = scene.parameters;
    of.identity = "engine " + engine + '\n' + document.text();
    for (const BodyScene& body : scene.bodies) {
      std::filesystem::path file;
      if (const auto* mesh = std::get_if<MeshShape>(&body.shape)) file = mesh->file;
      if (const auto* particles = std::get_if<ParticleFileShape>(&body.shape)) file = particles->file;
      if (!file.empty()) of.identity += "file of " + body.name + ' ' + checksum(content_of(file)) + '\n';
    }
    of.key = checksum(of.identity);
  } catch (const Failure& failure) {
    // The study's own place of the setting that the message is about, or of its last one.
    std::string place = study.file.string();
    for (const StudySetting& setting : of.settings) place = setting.place;
    for (const StudySetting& setting : of.settings) {
      const std::string text = setting.text[0] == '@' ? setting.text.substr(1) : "--set " + setting.text + ':';
      if (std::string(failure.what()).find(text) != std::string::npos) place = setting.place;
    }
    throw Failure(kExitInput, place + ": the case \"" + in_words(of.labels) + "\": " + failure.what());
  }
}

/// An outcome in the cache that belongs to this case; false where there is none. One that ran out of time counts only if
/// there is no more time now.
bool recall(const std::filesystem::path& cache, double timeout, StudyCase& of) {
  const std::filesystem::path directory = cache / of.key;
  try {
    std::ifstream stream(directory / kRecord);
    if (!stream) return false;
    const Json record = Json::parse(stream);
    if (record.at("identity") != of.identity) return false;
    CaseOutcome outcome;
    outcome.ending = record.at("ending");
    if (outcome.ending == "timed out" && (timeout == 0 || timeout > record.at("timeout").get<double>())) return false;
    outcome.message = record.at("message");
    outcome.cpu_seconds = record.at("cpu_seconds");
    outcome.wall_seconds = record.at("wall_seconds");
    outcome.memory_bytes = record.at("memory_bytes");
    outcome.directory = directory;
    of.outcome = outcome;
    of.was_there = true;
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;  // of another version or damaged: run again
  }
}

/// A case at work, in a process of its own.
struct Running {
  size_t index = 0;
  pid_t process = -1;
  int lock = -1;
  Clock::time_point start;
};

std::string last_line(const std::filesystem::path& file) {
  std::istringstream text(content_of(file));
  std::string last;
  for (std::string line; std::getline(text, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

/// False where another study runs this very case now.
bool start_case(const Study& study, const CaseOptions& options, const StudyCase& of, Running& running) {
  const std::filesystem::path directory = options.cache / of.key;
  std::error_code problem;
  std::filesystem::create_directories(directory, problem);
  if (problem) throw Failure(kExitFile, directory.string() + ": cannot be made: " + problem.message());
  running.lock = ::open((directory / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (running.lock < 0) throw Failure(kExitFile, (directory / "lock").string() + ": cannot be made");
  if (::flock(running.lock, LOCK_EX | LOCK_NB) != 0) {
    ::close(running.lock);
    return false;
  }
  std::filesystem::remove(directory / kRecord, problem);
  std::vector<std::string> words = {"ogive", "run", study.scene.string(), "--output", directory.string(), "--overwrite"};
  for (const StudySetting& setting : of.settings) {
    words.push_back("--set");
    words.push_back(setting.text);
  }
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const std::string log = (directory / "log.txt").string(), error_log = (directory / "errors.txt").string();
  running.start = Clock::now();
  const pid_t parent = ::getpid();
  running.process = ::fork();
  if (running.process < 0) throw Failure(kExitInternal, "no process could be had for a case");
  if (running.process == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a study that is killed leaves nothing running
    if (::getppid() != parent) ::_exit(127);
    if (options.timeout > 0) {  // processor time: a case does not fail because others kept the machine busy
      const auto seconds = static_cast<rlim_t>(std::ceil(options.timeout));
      const rlimit limit{seconds, seconds + 1};
      ::setrlimit(RLIMIT_CPU, &limit);
    }
    ::setpgid(0, 0);  // the terminal's interrupt is the study's business
    const int target = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    const int errors = ::open(error_log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (target < 0 || errors < 0 || ::dup2(target, STDOUT_FILENO) < 0 || ::dup2(errors, STDERR_FILENO) < 0) ::_exit(127);
    ::execv("/proc/self/exe", pointers.data());
    ::_exit(127);
  }
  return true;
}

/// What a process that has ended means. "" as ending: nothing that could be kept.
CaseOutcome outcome_of(const Running& running, int status, const rusage& usage, const std::filesystem::path& directory) {
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  CaseOutcome outcome;
  outcome.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  outcome.wall_seconds = std::chrono::duration<double>(Clock::now() - running.start).count();
  outcome.memory_bytes = static_cast<int64_t>(usage.ru_maxrss) * 1024;
  outcome.directory = directory;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    outcome.ending = "timed out";
    outcome.message = "not done after " + duration(outcome.cpu_seconds) + " of processor time";
  } else if (code == kExitOk) {
    outcome.ending = "done";
  } else if (code == kExitNumerical) {
    outcome.ending = "broke down";
  } else if (code == kExitInput) {
    outcome.ending = "refused";
  } else if (code == kExitInternal || (WIFSIGNALED(status) && WTERMSIG(status) != SIGKILL && WTERMSIG(status) != SIGTERM)) {
    outcome.ending = "crashed";
  } else {
    outcome.ending = "";
  }
  if (outcome.ending != "done" && outcome.message.empty()) {
    outcome.message = WIFSIGNALED(status) ? std::string("ended by signal ") + std::to_string(WTERMSIG(status))
                                          : last_line(directory / "errors.txt");
    const std::string prefix = directory.string() + '/';
    for (size_t at = outcome.message.find(prefix); at != std::string::npos; at = outcome.message.find(prefix)) {
      outcome.message.erase(at, prefix.size());
    }
  }
  return outcome;
}

void remember(const StudyCase& of, double timeout) {
  Json record;
  record["identity"] = of.identity;
  record["ending"] = of.outcome.ending;
  record["message"] = of.outcome.message;
  record["cpu_seconds"] = of.outcome.cpu_seconds;
  record["wall_seconds"] = of.outcome.wall_seconds;
  record["memory_bytes"] = of.outcome.memory_bytes;
  record["timeout"] = timeout;
  write_whole_file(of.outcome.directory / kRecord, record.dump(1) + '\n');
}

/// All combinations of the axes that do not bisect, each with the labels and settings of one.
std::vector<StudyCase> combinations(const Study& study, size_t index) {
  const StudySweep& sweep = study.sweeps[index];
  StudyCase first;
  first.sweep = index;
  first.labels = sweep.labels;
  first.settings = study.settings;
  first.settings.insert(first.settings.end(), sweep.settings.begin(), sweep.settings.end());
  std::vector<StudyCase> cases = {first};
  for (const StudyAxis& axis : sweep.axes) {
    if (axis.bisects()) continue;
    std::vector<StudyCase> longer;
    for (const StudyCase& of : cases) {
      for (const StudyPoint& point : axis.points) {
        StudyCase next = of;
        next.labels[axis.name] = point.label;
        next.settings.insert(next.settings.end(), point.settings.begin(), point.settings.end());
        longer.push_back(next);
      }
    }
    cases = std::move(longer);
  }
  return cases;
}

/// One search for the largest stable value: which value is to be tried next follows from what is known.
struct Search {
  StudyCase base;
  const StudyAxis* axis = nullptr;
  Bisection found;
  bool lowest_known = false, highest_known = false, over = false;
  double tried = 0;

  /// False when nothing is left to be tried.
  bool next(StudyCase& of) {
    if (over) return false;
    if (!lowest_known) {
      tried = axis->lowest;
    } else if (!highest_known) {
      tried = axis->highest;
    } else if (found.unstable - found.largest <= axis->tolerance) {
      over = true;
      return false;
    } else {
      const double middle = 0.5 * (found.largest + found.unstable);
      const double rounded = std::round(1e4 * middle) / 1e4;
      tried = rounded > found.largest && rounded < found.unstable ? rounded : middle;
    }
    of = base;
    of.labels[axis->name] = shortest(tried);
    of.settings.push_back({axis->key + '=' + shortest(tried), base.settings.empty() ? "" : base.settings.back().place});
    return true;
  }

  void learn(const std::string& failure) {
    const bool stable = failure.empty();
    if (stable) {
      found.largest = tried;
    } else {
      found.unstable = tried;
      found.how = failure;
    }
    if (!lowest_known) {
      lowest_known = true;
      found.none_stable = over = !stable;
    } else if (!highest_known) {
      highest_known = true;
      found.all_stable = over = stable;
    }
  }
};

}  // namespace

std::string engine_identity() {
  std::string text = ogive_version();
  std::set<std::string> files;
  const std::array<void*, 2> functions = {reinterpret_cast<void*>(&ogive_version), reinterpret_cast<void*>(&ogive_mesh_create)};
  for (void* function : functions) {
    Dl_info info{};
    if (::dladdr(function, &info) != 0 && info.dli_fname) files.insert(info.dli_fname);
  }
  for (const std::string& file : files) text += ' ' + checksum(content_of(file));
  return text;
}

StudyRun run_cases(const Study& study, const CaseOptions& options, const std::function<std::string(const StudyCase&)>& failure_of,
                   const std::function<void(const StudyCase&, size_t, size_t)>& tell) {
  const std::string engine = engine_identity();
  StudyRun result;
  std::deque<size_t> waiting;
  std::vector<Search> searches;
  std::map<size_t, size_t> search_of;  // of a case

  const auto add = [&](StudyCase&& of) {
    identify(study, engine, of);
    result.cases.push_back(std::move(of));
    waiting.push_back(result.cases.size() - 1);
  };
  const auto search_on = [&](size_t search) {
    StudyCase next;
    if (!searches[search].next(next)) return;
    add(std::move(next));
    search_of[result.cases.size() - 1] = search;
  };
  for (size_t sweep = 0; sweep < study.sweeps.size(); ++sweep) {
    const auto& axes = study.sweeps[sweep].axes;
    const auto bisecting = std::find_if(axes.begin(), axes.end(), [](const StudyAxis& axis) { return axis.bisects(); });
    for (StudyCase& of : combinations(study, sweep)) {
      if (!std::all_of(options.only.begin(), options.only.end(), [&](const auto& wanted) {
            const auto label = of.labels.find(wanted.first);
            return label != of.labels.end() && label->second == wanted.second;
          })) {
        continue;
      }
      if (bisecting == axes.end()) {
        add(std::move(of));
        continue;
      }
      Search search;
      search.base = of;
      search.axis = &*bisecting;
      search.found.sweep = sweep;
      search.found.labels = of.labels;
      search.found.axis = bisecting->name;
      searches.push_back(std::move(search));
      search_on(searches.size() - 1);
    }
  }

  if (options.only_list) return result;

  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    action.sa_handler = remember_interruption;
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, nullptr);
  }
  size_t ended = 0;
  std::vector<Running> running;
  const auto finished = [&](size_t index) {
    tell(result.cases[index], ++ended, result.cases.size());
    const auto search = search_of.find(index);
    if (search == search_of.end()) return;
    const size_t number = search->second;
    searches[number].learn(failure_of(result.cases[index]));
    search_on(number);
  };
  // What is there comes first, so that an interrupted study shows all of it.
  for (size_t left = waiting.size(); left > 0; --left) {
    const size_t index = waiting.front();
    waiting.pop_front();
    if (recall(options.cache, options.timeout, result.cases[index])) {
      finished(index);
    } else {
      waiting.push_back(index);
    }
  }
  while ((!waiting.empty() || !running.empty()) && !interruption) {
    bool moved = false;
    for (size_t tries = waiting.size(); tries > 0 && !waiting.empty() && running.size() < static_cast<size_t>(options.jobs); --tries) {
      const size_t index = waiting.front();
      waiting.pop_front();
      const std::string& key = result.cases[index].key;
      const bool here = std::any_of(running.begin(), running.end(), [&](const Running& r) { return result.cases[r.index].key == key; });
      if (!here && recall(options.cache, options.timeout, result.cases[index])) {
        finished(index);
        moved = true;
        continue;
      }
      Running next;
      next.index = index;
      if (here || !start_case(study, options, result.cases[index], next)) {
        waiting.push_back(index);  // being computed: its outcome will be there
        continue;
      }
      running.push_back(next);
      moved = true;
    }
    for (size_t i = 0; i < running.size();) {
      Running& at = running[i];
      int status = 0;
      rusage usage{};
      if (::wait4(at.process, &status, WNOHANG, &usage) != at.process) {
        ++i;
        continue;
      }
      StudyCase& of = result.cases[at.index];
      of.outcome = outcome_of(at, status, usage, options.cache / of.key);
      const size_t index = at.index;
      if (!of.outcome.ending.empty()) remember(of, options.timeout);
      ::close(at.lock);
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
      if (of.outcome.ending.empty()) {
        for (const Running& other : running) ::kill(other.process, SIGKILL);
        for (const Running& other : running) ::waitpid(other.process, nullptr, 0);
        throw Failure(kExitFile, "the case \"" + in_words(of.labels) + "\" could not be run: " + of.outcome.message + " (see " +
                                     (of.outcome.directory / "errors.txt").string() + ')');
      }
      finished(index);
      moved = true;
    }
    if (!moved) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  for (const Running& at : running) ::kill(at.process, SIGKILL);
  for (const Running& at : running) ::waitpid(at.process, nullptr, 0);
  result.interrupted = interruption != 0;
  for (const Search& search : searches) {
    if (search.over) result.bisections.push_back(search.found);
  }
  return result;
}

}  // namespace driver
