// One run at a time in a directory.
#pragma once

#include <filesystem>

namespace driver {

/// Holds `.ogive-lock` in a directory locked as long as it lives; the system lets go of it when the process ends, however it
/// ends. The file stays: to remove it would let two runs hold two files of one name.
class DirectoryLock {
 public:
  /// Throws Failure(kExitFile) with the process that holds it, or where the directory cannot be written to.
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(DirectoryLock&& other) noexcept;
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace driver
