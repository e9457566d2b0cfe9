// Files that survive a crash.
#include "files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "failure.hpp"

namespace driver {
namespace {

// FNV-1a: enough to tell one history from another; the disk's own errors are not its business.
constexpr uint64_t kSumStart = 14695981039346656037ULL;

uint64_t sum_with(uint64_t sum, const char* data, size_t size) {
  for (size_t i = 0; i < size; ++i) sum = (sum ^ static_cast<unsigned char>(data[i])) * 1099511628211ULL;
  return sum;
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& action) {
  throw Failure(kExitFile, file.string() + ": cannot be " + action + ": " + std::strerror(errno));
}

/// 0, or -1 with errno set.
int write_all(int descriptor, const char* data, size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, data, size);
    if (written < 0) {
      if (errno == EINTR) continue;
      return -1;
    }
    data += written;
    size -= static_cast<size_t>(written);
  }
  return 0;
}

void flush_directory_of(const std::filesystem::path& file) {
  const std::filesystem::path directory = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const int descriptor = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // some file systems do not let directories be opened; the file itself is on the disk
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void write_whole_file(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path temporary = file.string() + ".tmp-" + std::to_string(::getpid());
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(file, "written");
  const bool written = write_all(descriptor, text.data(), text.size()) == 0 && ::fsync(descriptor) == 0;
  int problem = errno;
  if (::close(descriptor) != 0 && written) problem = errno;
  if (!written || ::rename(temporary.c_str(), file.c_str()) != 0) {
    if (written) problem = errno;
    ::unlink(temporary.c_str());
    errno = problem;
    fail(file, "written");
  }
  flush_directory_of(file);
}

AppendedFile::~AppendedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AppendedFile::create(const std::filesystem::path& file) {
  file_ = file;
  descriptor_ = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(file, "created");
  if (::ftruncate(descriptor_, 0) != 0) fail(file, "created");
  flush_directory_of(file);
  size_ = 0;
  sum_ = kSumStart;
}

void AppendedFile::resume(const std::filesystem::path& file, int64_t size, uint64_t sum) {
  file_ = file;
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor_ < 0) fail(file, "continued");
  std::vector<char> block(1 << 16);
  uint64_t found_sum = kSumStart;
  int64_t found = 0;
  while (found < size) {
    const auto wanted = static_cast<size_t>(std::min<int64_t>(size - found, static_cast<int64_t>(block.size())));
    const ssize_t got = ::read(descriptor_, block.data(), wanted);
    if (got < 0) {
      if (errno == EINTR) continue;
      fail(file, "read");
    }
    if (got == 0) break;
    found_sum = sum_with(found_sum, block.data(), static_cast<size_t>(got));
    found += got;
  }
  if (found != size || found_sum != sum) {
    throw Failure(kExitFile, file.string() + ": is not the history that the checkpoint continues (expected its first " +
                                 std::to_string(size) + " bytes unchanged); give another directory with --output");
  }
  size_ = size;
  sum_ = sum;
}

void AppendedFile::cut() {
  if (::ftruncate(descriptor_, size_) != 0 || ::lseek(descriptor_, 0, SEEK_END) < 0) fail(file_, "continued");
}

void AppendedFile::append(const std::string& record) {
  if (write_all(descriptor_, record.data(), record.size()) != 0) fail(file_, "written");
  size_ += static_cast<int64_t>(record.size());
  sum_ = sum_with(sum_, record.data(), record.size());
}

void AppendedFile::flush_to_disk() {
  if (::fsync(descriptor_) != 0) fail(file_, "flushed to disk");
}

}  // namespace driver
