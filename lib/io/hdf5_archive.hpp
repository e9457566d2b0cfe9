// Ogive's HDF5 files: named arrays and attributes behind a checksummed header (docs/formats.md).
//
// The first 512 bytes, which HDF5 skips (its "userblock"), hold the file's length, the checksum of everything behind
// them, and the place of the manifest: a list of all arrays with their type, shape, place in the file and checksum.
// Writing goes through HDF5. Reading does not: the manifest says where each array is, so a damaged file never reaches
// HDF5's parser, and the damage can be named.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "failure.hpp"

namespace ogive::io {

enum class ElementType : std::int32_t { float64 = 1, int32 = 2, int64 = 3, uint8 = 4 };  // numbered as OGIVE_TYPE_*
const char* type_name(ElementType type);
std::size_t type_size(ElementType type);
bool type_known(std::int32_t type);

// A kind of file and its version.
struct Format {
  const char* name;
  std::int64_t version;
};
inline constexpr Format kCheckpointFormat{"ogive-checkpoint", 1};
inline constexpr Format kParticlesFormat{"ogive-particles", 1};

using AttributeValue = std::variant<double, std::int64_t, std::string>;

// Makes one component of an HDF5 path from any name: '/', '%', control characters, "", "." and the name of the manifest
// become %XX.
std::string path_component(std::string_view name);
// The name behind such a component.
std::string name_of_component(std::string_view component);

// "12 x 3".
std::string shape_text(const std::vector<std::uint64_t>& shape, const char* separator = " x ");

class ArchiveWriter {
 public:
  // Throws Failure, as all of these do. The file appears at `path` when commit() returns, not before.
  ArchiveWriter(const std::string& path, const Format& format, const std::string& library_version);
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  // An attribute of a group, which is made if it is not there; "" is the root.
  void set_attribute(const std::string& group, const std::string& name, const AttributeValue& value);
  // An array at `path` ("state/position"): components joined by '/', each as path_component makes them.
  void put(const std::string& path, ElementType type, const std::vector<std::uint64_t>& shape, const void* data);
  // The same of doubles, row by row: fill(first, rows, values) gives `rows` of them (shape[0] in all) from `first` on, at most
  // `most` at a time, so that the whole need not be in memory.
  void put_rows(const std::string& path, const std::vector<std::uint64_t>& shape, std::uint64_t most,
                const std::function<void(std::uint64_t first, std::uint64_t rows, double* values)>& fill);
  void commit();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

class ArchiveReader {
 public:
  struct Array {
    std::string path;
    ElementType type;
    std::vector<std::uint64_t> shape;
    std::uint64_t count;  // elements
    std::uint64_t bytes;
    std::uint64_t offset;  // in the file
    std::uint64_t checksum;
  };

  // Opens the file and checks its header, length and manifest, which is quick. Throws Failure.
  explicit ArchiveReader(const std::string& path);
  ~ArchiveReader();
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  const std::string& format() const { return format_; }
  std::int64_t format_version() const { return format_version_; }
  std::uint64_t file_size() const { return file_size_; }

  const std::vector<Array>& arrays() const { return arrays_; }
  // nullptr if there is none.
  const Array* find(std::string_view path) const;
  // The attributes of every group, keyed by "<group>" ("" is the root), then by name.
  const std::map<std::string, std::map<std::string, AttributeValue>>& attributes() const { return attributes_; }
  // nullptr if there is none or it is of another type.
  template <class Value>
  const Value* attribute(const std::string& group, const std::string& name) const {
    const auto in_group = attributes_.find(group);
    if (in_group == attributes_.end()) return nullptr;
    const auto found = in_group->second.find(name);
    return found == in_group->second.end() ? nullptr : std::get_if<Value>(&found->second);
  }

  // Reads the whole file and compares every checksum. Empty: undamaged. Throws Failure only where reading fails.
  std::vector<std::string> damage() const;
  // Throws Failure naming the damage if there is any.
  void require_undamaged() const;
  // Copies an array of `array.bytes` bytes; its checksum is compared once more on the way.
  void read(const Array& array, void* data) const;

 private:
  void read_bytes(std::uint64_t offset, void* data, std::size_t size) const;
  std::uint64_t checksum_of(std::uint64_t offset, std::uint64_t size) const;
  void parse_manifest(std::string_view text);

  int descriptor_ = -1;
  std::uint64_t file_size_ = 0;
  std::uint64_t checksum_ = 0;  // of everything behind the header
  std::string format_;
  std::int64_t format_version_ = 0;
  std::vector<Array> arrays_;
  std::map<std::string, std::size_t, std::less<>> index_;
  std::map<std::string, std::map<std::string, AttributeValue>> attributes_;
};

}  // namespace ogive::io
