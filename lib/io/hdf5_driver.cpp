// An HDF5 "virtual file driver" over AtomicFile. HDF5's own POSIX driver takes file locks that depend on the
// environment and on the file system, and leaves a broken open file behind when the disk is full at closing. Here
// writing always succeeds as far as HDF5 can see; AtomicFile keeps the error, and its temporary is thrown away.
#include "hdf5_driver.hpp"

#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>  // since HDF5 1.13 the driver interface is in a header of its own
#endif

#include <algorithm>
#include <functional>
#include <new>

namespace ogive::io {
namespace {

std::mutex hdf5_mutex;
bool out_of_memory = false;  // HDF5 does not pass this on; under the mutex

struct DriverSettings {  // travels in the file access property list
  AtomicFile* file;
};

struct Driver {
  H5FD_t base;  // first: HDF5 casts to it
  AtomicFile* file;
  haddr_t end_of_allocation;
};

Driver* driver_of(H5FD_t* base) { return reinterpret_cast<Driver*>(base); }
const Driver* driver_of(const H5FD_t* base) { return reinterpret_cast<const Driver*>(base); }

H5FD_t* driver_open(const char*, unsigned, hid_t access, haddr_t) {
  const auto* settings = static_cast<const DriverSettings*>(H5Pget_driver_info(access));
  if (!settings) return nullptr;
  Driver* const driver = new (std::nothrow) Driver{H5FD_t{}, settings->file, 0};
  if (!driver) out_of_memory = true;
  return reinterpret_cast<H5FD_t*>(driver);
}

herr_t driver_close(H5FD_t* base) {
  delete driver_of(base);
  return 0;
}

int driver_compare(const H5FD_t* a, const H5FD_t* b) {
  const auto* file_a = driver_of(a)->file;
  const auto* file_b = driver_of(b)->file;
  return file_a == file_b ? 0 : std::less<const AtomicFile*>{}(file_a, file_b) ? -1 : 1;
}

herr_t driver_query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t driver_get_end_of_allocation(const H5FD_t* base, H5FD_mem_t) { return driver_of(base)->end_of_allocation; }

herr_t driver_set_end_of_allocation(H5FD_t* base, H5FD_mem_t, haddr_t address) {
  driver_of(base)->end_of_allocation = address;
  return 0;
}

haddr_t driver_get_end_of_file(const H5FD_t* base, H5FD_mem_t) { return driver_of(base)->file->size(); }

herr_t driver_read(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, size_t size, void* data) {
  driver_of(base)->file->read_at(address, data, size);
  return 0;
}

herr_t driver_write(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, size_t size, const void* data) {
  driver_of(base)->file->write_at(address, data, size);
  return 0;
}

herr_t driver_truncate(H5FD_t* base, hid_t, hbool_t) {
  Driver* driver = driver_of(base);
  if (driver->end_of_allocation != driver->file->size()) driver->file->resize(driver->end_of_allocation);
  return 0;
}

hid_t register_driver() {
  H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(600);  // any number above 511 that HDF5 does not keep for itself
#endif
  driver.name = "ogive";
  driver.maxaddr = static_cast<haddr_t>(1) << 62;
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(DriverSettings);
  driver.open = driver_open;
  driver.close = driver_close;
  driver.cmp = driver_compare;
  driver.query = driver_query;
  driver.get_eoa = driver_get_end_of_allocation;
  driver.set_eoa = driver_set_end_of_allocation;
  driver.get_eof = driver_get_end_of_file;
  driver.read = driver_read;
  driver.write = driver_write;
  driver.truncate = driver_truncate;
  const H5FD_mem_t free_lists[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(free_lists), std::end(free_lists), std::begin(driver.fl_map));
  return H5FDregister(&driver);
}

}  // namespace

Hdf5Session::Hdf5Session() : lock_(hdf5_mutex) {
  // The host's own choice may be of the old or of the new kind; each is kept and put back by functions of its kind.
  H5Eauto_is_v2(H5E_DEFAULT, &version2_);
  if (version2_) {
    H5Eget_auto2(H5E_DEFAULT, &print2_, &print_data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  } else {
#ifndef H5_NO_DEPRECATED_SYMBOLS
    H5Eget_auto1(&print1_, &print_data_);
    H5Eset_auto1(nullptr, nullptr);
#endif
  }
}

Hdf5Session::~Hdf5Session() {
  if (version2_) {
    H5Eset_auto2(H5E_DEFAULT, print2_, print_data_);
  } else {
#ifndef H5_NO_DEPRECATED_SYMBOLS
    H5Eset_auto1(print1_, print_data_);
#endif
  }
}

Hdf5File create_hdf5(AtomicFile& file, hsize_t userblock) {
  out_of_memory = false;
  const hid_t driver = register_driver();
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
  const DriverSettings settings{&file};
  hid_t result = -1;
  // The oldest layout that holds the content, without times of creation: equal content makes equal files.
  if (driver >= 0 && H5Pset_driver(access, driver, &settings) >= 0 &&
      H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_LATEST) >= 0 &&
      H5Pset_userblock(creation, userblock) >= 0 && H5Pset_obj_track_times(creation, false) >= 0)
    result = H5Fcreate("ogive", H5F_ACC_TRUNC, creation, access);
  if (creation >= 0) H5Pclose(creation);
  if (access >= 0) H5Pclose(access);
  if (result < 0 && driver >= 0) H5FDunregister(driver);
  if (result < 0 && out_of_memory) throw std::bad_alloc();
  return {result, driver};
}

herr_t close_hdf5(Hdf5File& file) {
  const herr_t closed = H5Fclose(file.id);
  H5FDunregister(file.driver);
  file = {};
  return closed;
}

}  // namespace ogive::io
