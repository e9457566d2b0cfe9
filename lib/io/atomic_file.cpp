// See atomic_file.hpp. Every system call that can lose data is checked, close() and the directory's fsync() included.
#include "atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>

#include "failure.hpp"

namespace ogive::io {
namespace {

// Where the new file goes: the path itself, or what it leads to if it is a symbolic link.
std::string resolve(const std::string& path) {
  struct stat status {};
  std::string target = path;
  if (lstat(path.c_str(), &status) == 0 && S_ISLNK(status.st_mode)) {
    const std::unique_ptr<char, void (*)(void*)> real(realpath(path.c_str(), nullptr), std::free);
    if (!real) throw Failure(Fault::file, "the symbolic link cannot be followed: " + system_reason(errno));
    target = real.get();
  }
  // A rename would replace a device such as /dev/null by a plain file.
  if (stat(target.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw Failure(Fault::file, S_ISDIR(status.st_mode) ? "is a directory" : "is not a regular file");
  return target;
}

std::string directory_of(const std::string& path) {
  const auto slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace

std::string system_reason(int error) { return std::generic_category().message(error); }

AtomicFile::AtomicFile(const std::string& path) : target_(resolve(path)) {
  // A killed process may have left a temporary of the same process id: try a few names rather than fail or overwrite.
  const std::string stem = target_ + ".tmp-" + std::to_string(getpid());
  for (int attempt = 0; attempt < 100; ++attempt) {
    temporary_ = attempt == 0 ? stem : stem + "-" + std::to_string(attempt);
    descriptor_ = open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return;
    if (errno != EEXIST) break;
  }
  throw Failure(Fault::file, "cannot create '" + temporary_ + "': " + system_reason(errno));
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) unlink(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::write_at(std::uint64_t offset, const void* data, std::size_t size) noexcept {
  const auto* bytes = static_cast<const char*>(data);
  size_ = std::max<std::uint64_t>(size_, offset + size);
  while (size > 0 && error_ == 0) {
    const ssize_t done = pwrite(descriptor_, bytes, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) {
      error_ = done < 0 ? errno : ENOSPC;
      return;
    }
    bytes += done;
    offset += static_cast<std::uint64_t>(done);
    size -= static_cast<std::size_t>(done);
  }
}

void AtomicFile::read_at(std::uint64_t offset, void* data, std::size_t size) noexcept {
  auto* bytes = static_cast<char*>(data);
  while (size > 0 && error_ == 0) {
    const ssize_t done = pread(descriptor_, bytes, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) error_ = errno;
    if (done <= 0) break;
    bytes += done;
    offset += static_cast<std::uint64_t>(done);
    size -= static_cast<std::size_t>(done);
  }
  std::memset(bytes, 0, size);
}

void AtomicFile::resize(std::uint64_t size) noexcept {
  if (error_ == 0 && ftruncate(descriptor_, static_cast<off_t>(size)) != 0) error_ = errno;
  size_ = size;
}

void AtomicFile::check() const {
  if (error_ != 0) throw Failure(Fault::file, "cannot write: " + system_reason(error_));
}

void AtomicFile::commit() {
  check();
  if (fsync(descriptor_) != 0) error_ = errno;
  check();
  const int closed = close(descriptor_);
  if (closed != 0) error_ = errno;
  descriptor_ = -1;
  check();
  if (rename(temporary_.c_str(), target_.c_str()) != 0) {
    error_ = errno;
    throw Failure(Fault::file, "cannot rename '" + temporary_ + "': " + system_reason(error_));
  }
  temporary_.clear();
  const int directory = open(directory_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // A directory that may be written but not read, and a file system that cannot flush one, are no reason to fail.
  if (directory < 0) return;
  const int flushed = fsync(directory);
  const int reason = errno;
  close(directory);
  if (flushed != 0 && reason != EINVAL && reason != ENOTSUP && reason != EROFS)
    throw Failure(Fault::file, "was replaced, but its directory cannot be flushed to disk: " + system_reason(reason));
}

}  // namespace ogive::io
