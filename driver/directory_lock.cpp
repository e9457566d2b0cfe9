// See directory_lock.hpp.
#include "directory_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "failure.hpp"

namespace driver {

DirectoryLock::DirectoryLock(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / ".ogive-lock";
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw Failure(kExitFile, file.string() + ": cannot be made: " + std::strerror(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    char holder[128] = {};
    const ssize_t size = ::read(descriptor_, holder, sizeof holder - 1);
    ::close(descriptor_);
    descriptor_ = -1;
    if (reason != EWOULDBLOCK) throw Failure(kExitFile, file.string() + ": cannot be locked: " + std::strerror(reason));
    throw Failure(kExitFile, directory.string() + ": is being written by another run" +
                                 (size > 0 ? " (" + std::string(holder) + ")" : "") +
                                 "; give another directory with --output");
  }
  // Who holds it, for the message above alone: a disk that is full for it is no reason to fail.
  char host[64] = "unknown host";
  ::gethostname(host, sizeof host - 1);
  const std::string holder = "process " + std::to_string(::getpid()) + " on " + host;
  if (::ftruncate(descriptor_, 0) == 0 && ::pwrite(descriptor_, holder.data(), holder.size(), 0) < 0) return;
}

DirectoryLock::DirectoryLock(DirectoryLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

DirectoryLock::~DirectoryLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace driver
