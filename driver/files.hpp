// Files that survive a crash: written whole or not at all, and data known to be on the disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace driver {

/// Under a temporary name in the same directory, flushed to disk, then renamed. Throws Failure(kExitFile).
void write_whole_file(const std::filesystem::path& file, const std::string& text);

/// A file that grows by whole records, with a running sum of its content by which a restart knows it again.
class AppendedFile {
 public:
  AppendedFile() = default;
  AppendedFile(const AppendedFile&) = delete;
  AppendedFile& operator=(const AppendedFile&) = delete;
  ~AppendedFile();

  /// Starts an empty file.
  void create(const std::filesystem::path& file);
  /// Takes up an existing file to go on after its first `size` bytes, which must have the sum that was recorded.
  void resume(const std::filesystem::path& file, int64_t size, uint64_t sum);
  /// Cuts off what is beyond them. Before the first append.
  void cut();
  void append(const std::string& record);
  /// Until the disk has it.
  void flush_to_disk();

  int64_t size() const { return size_; }
  uint64_t sum() const { return sum_; }

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  int64_t size_ = 0;
  uint64_t sum_ = 0;
};

}  // namespace driver
