// A file that replaces another one whole or not at all: written under a temporary name in the same directory, flushed
// to disk, renamed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace ogive::io {

class AtomicFile {
 public:
  // Creates "<path>.tmp-<process id>". A symbolic link is followed, so that the file it names is replaced, not the
  // link. Throws Failure.
  explicit AtomicFile(const std::string& path);
  // Removes the temporary unless commit() succeeded.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // These never throw: the first error is kept, later calls do nothing, and commit() reports it. HDF5 is thereby never
  // told of a full disk, which it handles badly when it closes a file.
  void write_at(std::uint64_t offset, const void* data, std::size_t size) noexcept;
  // Bytes beyond the end, or after an error, read as zero.
  void read_at(std::uint64_t offset, void* data, std::size_t size) noexcept;
  void resize(std::uint64_t size) noexcept;
  std::uint64_t size() const noexcept { return size_; }
  // errno of the first error, 0 if none.
  int error() const noexcept { return error_; }

  // Throws Failure with the system's reason if anything failed so far.
  void check() const;
  // Flushes to disk and takes the place of the old file. Throws Failure; then the old file is untouched unless only the
  // last flush, that of the directory, failed.
  void commit();

 private:
  void discard() noexcept;

  std::string target_;
  std::string temporary_;
  int descriptor_ = -1;
  int error_ = 0;
  std::uint64_t size_ = 0;
};

// The system's words for an errno.
std::string system_reason(int error);

}  // namespace ogive::io
