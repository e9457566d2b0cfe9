// For tests: runs the program ogive in a directory of its own and looks at what it says and leaves.
#include "program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace cli_test {
namespace {

void redirect(int descriptor, const std::filesystem::path& file) {
  const int target = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (target < 0 || ::dup2(target, descriptor) < 0) ::_exit(126);
}

std::string scratch_name() {
  static int number = 0;
  return "outcome-" + std::to_string(::getpid()) + "-" + std::to_string(++number);
}

}  // namespace

ScratchDirectory::ScratchDirectory() {
  std::string name = (std::filesystem::temp_directory_path() / "ogive-test-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch directory");
  path_ = name;
}

ScratchDirectory::~ScratchDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

RunningProgram::RunningProgram(const std::filesystem::path& directory, const std::vector<std::string>& arguments) {
  const std::string name = scratch_name();
  output_file_ = std::filesystem::temp_directory_path() / (name + ".out");
  error_file_ = std::filesystem::temp_directory_path() / (name + ".err");
  std::vector<std::string> words = {OGIVE_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error("fork failed");
  if (process_ == 0) {
    if (::chdir(directory.c_str()) != 0) ::_exit(126);
    redirect(STDOUT_FILENO, output_file_);
    redirect(STDERR_FILENO, error_file_);
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
  }
}

RunningProgram::~RunningProgram() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    wait();
  }
  std::error_code ignored;
  std::filesystem::remove(output_file_, ignored);
  std::filesystem::remove(error_file_, ignored);
}

void RunningProgram::send(int signal) const {
  if (process_ > 0) ::kill(process_, signal);
}

bool RunningProgram::ended() {
  if (process_ > 0 && ::waitpid(process_, &status_, WNOHANG) == process_) process_ = -1;
  return process_ < 0;
}

Outcome RunningProgram::wait() {
  if (process_ > 0) ::waitpid(process_, &status_, 0);
  process_ = -1;
  Outcome outcome;
  if (WIFEXITED(status_)) outcome.exit_code = WEXITSTATUS(status_);
  if (WIFSIGNALED(status_)) outcome.signal = WTERMSIG(status_);
  outcome.output = read_file(output_file_);
  outcome.errors = read_file(error_file_);
  return outcome;
}

Outcome run_program(const std::filesystem::path& directory, const std::vector<std::string>& arguments) {
  return RunningProgram(directory, arguments).wait();
}

Outcome run_in_shell(const std::filesystem::path& directory, const std::string& command) {
  const std::filesystem::path base = std::filesystem::temp_directory_path() / scratch_name();
  const std::string output = base.string() + ".out", errors = base.string() + ".err";
  const std::string line = "cd '" + directory.string() + "' && PATH=\"$(dirname '" OGIVE_PROGRAM "')\":$PATH && { " +
                           command + "; } >'" + output + "' 2>'" + errors + "'";
  const int status = std::system(line.c_str());
  Outcome outcome;
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  outcome.output = read_file(output);
  outcome.errors = read_file(errors);
  std::filesystem::remove(output);
  std::filesystem::remove(errors);
  return outcome;
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write_file(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream);
}

size_t count_of(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

std::string scene_text(const std::string& name, const std::vector<std::pair<std::string, std::string>>& replacements) {
  std::string text = read_file(std::filesystem::path(OGIVE_CLI_DATA) / name);
  for (const auto& [old_text, new_text] : replacements) {
    const size_t at = text.find(old_text);
    if (at == std::string::npos) throw std::runtime_error("no \"" + old_text + "\" in " + name);
    text.replace(at, old_text.size(), new_text);
  }
  return text;
}

std::vector<std::string> names_in(const std::filesystem::path& directory) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(directory, ignored)) {
    if (entry.path().filename() != ".ogive-lock") names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace cli_test
