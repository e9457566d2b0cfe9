// For tests: runs the program ogive in a directory of its own and looks at what it says and leaves.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace cli_test {

struct Outcome {
  int exit_code = -1;  // -1: ended by a signal
  int signal = 0;
  std::string output, errors;
};

/// A directory that lives as long as the object.
class ScratchDirectory {
 public:
  ScratchDirectory();
  ~ScratchDirectory();
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// The program at work, in `directory`; its output goes to files beside it.
class RunningProgram {
 public:
  RunningProgram(const std::filesystem::path& directory, const std::vector<std::string>& arguments);
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;
  void send(int signal) const;
  bool ended();
  Outcome wait();

 private:
  pid_t process_ = -1;
  int status_ = 0;
  std::filesystem::path output_file_, error_file_;
};

Outcome run_program(const std::filesystem::path& directory, const std::vector<std::string>& arguments);
/// A command line as a shell takes it; "ogive" stands for the program.
Outcome run_in_shell(const std::filesystem::path& directory, const std::string& command);

std::string read_file(const std::filesystem::path& file);
void write_file(const std::filesystem::path& file, const std::string& text);
nlohmann::json read_json(const std::filesystem::path& file);
size_t count_of(const std::string& text, const std::string& part);
/// A scene of the test data, with texts replaced. Each must be there.
std::string scene_text(const std::string& name, const std::vector<std::pair<std::string, std::string>>& replacements);
/// Names in a directory, sorted, but for the lock that every run leaves.
std::vector<std::string> names_in(const std::filesystem::path& directory);

}  // namespace cli_test
