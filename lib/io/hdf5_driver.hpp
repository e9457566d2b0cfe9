// Makes HDF5 write into an AtomicFile instead of opening a file of its own.
#pragma once

#include <hdf5.h>

#include <mutex>

#include "atomic_file.hpp"

namespace ogive::io {

// HDF5 need not be built thread-safe: every call of ours is made while this is held. Silences HDF5's printing of errors
// on stderr as long as it lives.
class Hdf5Session {
 public:
  Hdf5Session();
  ~Hdf5Session();
  Hdf5Session(const Hdf5Session&) = delete;
  Hdf5Session& operator=(const Hdf5Session&) = delete;

 private:
  std::lock_guard<std::mutex> lock_;
  unsigned version2_ = 1;
  H5E_auto2_t print2_ = nullptr;
#ifndef H5_NO_DEPRECATED_SYMBOLS
  H5E_auto1_t print1_ = nullptr;
#endif
  void* print_data_ = nullptr;
};

// An open file and the driver that it goes through. The driver must stay registered until the file is closed: HDF5 1.10 gives
// up the file's own hold on it first, and calls it after that.
struct Hdf5File {
  hid_t id = -1, driver = -1;
};

// Creates an HDF5 file inside `file`, its first `userblock` bytes left to us. Its id is negative on failure. `file` must outlive
// it.
Hdf5File create_hdf5(AtomicFile& file, hsize_t userblock);
// Negative on failure; the file is closed all the same.
herr_t close_hdf5(Hdf5File& file);

}  // namespace ogive::io
