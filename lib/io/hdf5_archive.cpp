// See hdf5_archive.hpp. The layout of header and manifest is described in docs/formats.md.
#include "hdf5_archive.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <limits>
#include <set>

#include "atomic_file.hpp"
#include "crc64.hpp"
#include "hdf5_driver.hpp"

namespace ogive::io {
namespace {

constexpr std::size_t kHeaderSize = 512;  // the smallest userblock that HDF5 allows
constexpr std::uint32_t kHeaderVersion = 1;
constexpr char kMagic[17] = "\x89OGIVE-HDF5\r\n\x1a\n\0";  // shows damage by text-mode copying, as PNG's does
constexpr unsigned char kHdf5Signature[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
constexpr char kManifestPath[] = "manifest";
constexpr char kManifestTitle[] = "ogive-manifest\t1";
constexpr std::size_t kPieceSize = std::size_t{1} << 20;  // a file is read for its checksum in pieces of this size

struct Header {
  char magic[16];
  std::uint32_t version;
  std::uint32_t size;
  std::uint64_t file_size;
  std::uint64_t checksum;  // of all bytes from kHeaderSize on
  std::uint64_t manifest_offset;
  std::uint64_t manifest_size;
  std::uint64_t manifest_checksum;
  char note[kHeaderSize - 72];
  std::uint64_t header_checksum;  // of the header up to here; the same place in every version
};
static_assert(sizeof(Header) == kHeaderSize);

constexpr char kNote[] =
    "\nAn HDF5 file written by Ogive. HDF5 starts at byte 512; the bytes before it hold checksums.\n";

[[noreturn]] void fail_format(const std::string& reason) { throw Failure(Fault::format, reason); }

// ---------------------------------------------------------------------------------------------------- text of manifest

bool must_escape(unsigned char c) { return c < 0x20 || c == 0x7F || c == '%'; }

void append_escaped(std::string& text, unsigned char c) {
  constexpr char digits[] = "0123456789ABCDEF";
  text += '%';
  text += digits[c >> 4];
  text += digits[c & 15];
}

std::string escape(std::string_view value) {
  std::string text;
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    must_escape(byte) ? append_escaped(text, byte) : text.push_back(c);
  }
  return text;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string unescape(std::string_view text) {
  std::string value;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool code =
        text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0;
    value += code ? static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2])) : text[i];
    if (code) i += 2;
  }
  return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

template <class Number>
bool parse(std::string_view text, Number& number, int base = 10) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return result.ec == std::errc{} && result.ptr == text.data() + text.size();
}

bool parse(std::string_view text, double& number) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
  return result.ec == std::errc{} && result.ptr == text.data() + text.size();
}

std::string format_number(const char* pattern, auto number) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, number);
  return text;
}

std::string shortest(double number) {  // reads back to the same value
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, number);
  return {text, end.ptr};
}

bool multiply(std::uint64_t a, std::uint64_t b, std::uint64_t& product) {
  return !__builtin_mul_overflow(a, b, &product);
}

bool valid_path(std::string_view path) {
  for (const auto component : split(path, '/')) {
    if (component.empty() || component == ".") return false;
    for (const char c : component)
      if (must_escape(static_cast<unsigned char>(c)) && c != '%') return false;
  }
  return true;
}

// ------------------------------------------------------------------------------------------------------ HDF5 handles

// Closes an HDF5 identifier.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

hid_t stored_type(ElementType type) {
  switch (type) {
    case ElementType::float64:
      return H5T_IEEE_F64LE;
    case ElementType::int32:
      return H5T_STD_I32LE;
    case ElementType::int64:
      return H5T_STD_I64LE;
    case ElementType::uint8:
      return H5T_STD_U8LE;
  }
  return -1;
}

// The innermost reason of HDF5's error stack.
std::string hdf5_reason() {
  std::string reason;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned number, const H5E_error2_t* error, void* text) -> herr_t {
        try {
          if (number == 0 && error->desc) *static_cast<std::string*>(text) = error->desc;
        } catch (...) {  // no memory for the reason: it stays unknown
        }
        return 0;
      },
      &reason);
  return reason.empty() ? "no reason given" : reason;
}

}  // namespace

// --------------------------------------------------------------------------------------------------------------- types

const char* type_name(ElementType type) {
  switch (type) {
    case ElementType::float64:
      return "float64";
    case ElementType::int32:
      return "int32";
    case ElementType::int64:
      return "int64";
    case ElementType::uint8:
      return "uint8";
  }
  return "unknown";
}

std::size_t type_size(ElementType type) {
  switch (type) {
    case ElementType::float64:
    case ElementType::int64:
      return 8;
    case ElementType::int32:
      return 4;
    case ElementType::uint8:
      return 1;
  }
  return 0;
}

bool type_known(std::int32_t type) { return type >= 1 && type <= 4; }

std::string path_component(std::string_view name) {
  if (name.empty()) return "%";
  std::string component;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto byte = static_cast<unsigned char>(name[i]);
    const bool reserved = i == 0 && (name == "." || name == kManifestPath);
    must_escape(byte) || byte == '/' || reserved ? append_escaped(component, byte) : component.push_back(name[i]);
  }
  return component;
}

std::string name_of_component(std::string_view component) { return component == "%" ? "" : unescape(component); }

std::string shape_text(const std::vector<std::uint64_t>& shape, const char* separator) {
  std::string text;
  for (const auto extent : shape) {
    if (!text.empty()) text += separator;
    text += std::to_string(extent);
  }
  return text;
}

// -------------------------------------------------------------------------------------------------------------- writer

struct ArchiveWriter::Implementation {
  AtomicFile file;
  Hdf5File hdf5;
  std::string manifest = std::string(kManifestTitle) + "\n";
  std::set<std::string> used;    // paths of arrays, and "<group>\n<name>" of attributes
  std::set<std::string> groups;  // "" is the root

  explicit Implementation(const std::string& path) : file(path), groups{""} {}
  ~Implementation() {
    if (hdf5.id < 0) return;
    const Hdf5Session session;
    close_hdf5(hdf5);
  }

  // HDF5's own complaint is of no use where the disk was full: the system's reason goes first.
  void require(bool succeeded, const std::string& what) const {
    if (succeeded) return;
    file.check();
    throw Failure(Fault::file, "HDF5 cannot " + what + ": " + hdf5_reason());
  }

  void make_group(const std::string& path) {
    if (groups.contains(path)) return;
    const auto slash = path.rfind('/');
    make_group(slash == std::string::npos ? "" : path.substr(0, slash));
    if (used.contains(path)) throw Failure(Fault::argument, "'" + path + "' is an array and cannot be a group");
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_char_encoding(links, H5T_CSET_UTF8);
    const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);
    const Handle group(H5Gcreate2(hdf5.id, path.c_str(), links, creation, H5P_DEFAULT), H5Gclose);
    require(group >= 0, "make the group '" + path + "'");
    groups.insert(path);
  }

  void write_scalar(hid_t object, const std::string& name, hid_t stored, hid_t in_memory, const void* value) const {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(object, name.c_str(), stored, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(attribute >= 0 && H5Awrite(attribute, in_memory, value) >= 0, "write the attribute '" + name + "'");
  }

  hid_t create_array(const std::string& path, ElementType type, hid_t space) {
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_char_encoding(links, H5T_CSET_UTF8);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    // In one piece and placed at once, so that its offset can be told to the manifest.
    H5Pset_layout(creation, H5D_CONTIGUOUS);
    H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    H5Pset_obj_track_times(creation, false);
    const hid_t dataset = H5Dcreate2(hdf5.id, path.c_str(), stored_type(type), space, links, creation, H5P_DEFAULT);
    require(dataset >= 0, "make the array '" + path + "'");
    return dataset;
  }

  std::uint64_t place_of(hid_t dataset, const std::string& path) {
    const haddr_t offset = H5Dget_offset(dataset);
    require(offset != HADDR_UNDEF, "tell the place of the array '" + path + "'");
    return offset;
  }

  // Returns the array's place in the file.
  std::uint64_t write_array(const std::string& path, ElementType type, const std::vector<std::uint64_t>& shape,
                            std::uint64_t bytes, const void* data, std::uint64_t checksum) {
    std::vector<hsize_t> dimensions(shape.begin(), shape.end());
    const Handle space(H5Screate_simple(static_cast<int>(dimensions.size()), dimensions.data(), nullptr), H5Sclose);
    const Handle dataset(create_array(path, type, space), H5Dclose);
    write_scalar(dataset, "crc64", H5T_STD_U64LE, H5T_NATIVE_UINT64, &checksum);
    if (bytes == 0) return 0;
    require(H5Dwrite(dataset, stored_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0,
            "write the array '" + path + "'");
    return place_of(dataset, path);
  }

  // Bytes of an array; throws where its name, type or shape will not do.
  static std::uint64_t bytes_of(const std::string& path, ElementType type, const std::vector<std::uint64_t>& shape);
  void enter(const std::string& path);
  void list(const std::string& path, ElementType type, const std::vector<std::uint64_t>& shape, std::uint64_t offset,
            std::uint64_t checksum) {
    manifest += "array\t" + path + "\t" + type_name(type) + "\t" + shape_text(shape, "x") + "\t" + std::to_string(offset) +
                "\t" + format_number("%016llx", static_cast<unsigned long long>(checksum)) + "\n";
  }
};

ArchiveWriter::ArchiveWriter(const std::string& path, const Format& format, const std::string& library_version)
    : implementation_(std::make_unique<Implementation>(path)) {
  {
    const Hdf5Session session;
    implementation_->hdf5 = create_hdf5(implementation_->file, kHeaderSize);
    implementation_->require(implementation_->hdf5.id >= 0, "create a file");
  }
  set_attribute("", "format", std::string(format.name));
  set_attribute("", "format_version", format.version);
  set_attribute("", "library_version", library_version);
}

ArchiveWriter::~ArchiveWriter() = default;

void ArchiveWriter::set_attribute(const std::string& group, const std::string& name, const AttributeValue& value) {
  auto& self = *implementation_;
  if (name.empty() || std::any_of(name.begin(), name.end(), [](unsigned char c) { return must_escape(c); }))
    throw Failure(Fault::argument, "'" + escape(name) + "' cannot name an attribute");
  if (!group.empty() && !valid_path(group))
    throw Failure(Fault::argument, "'" + escape(group) + "' cannot name a group");
  if (!self.used.insert(group + "\n" + name).second)
    throw Failure(Fault::argument, "the attribute '" + name + "' is given twice");

  const Hdf5Session session;
  self.make_group(group);
  const Handle object(H5Gopen2(self.hdf5.id, group.empty() ? "/" : group.c_str(), H5P_DEFAULT), H5Gclose);
  self.require(object >= 0, "open the group '" + group + "'");
  std::string line = "attribute\t/" + group + "\t" + name + "\t";
  if (const auto* number = std::get_if<double>(&value)) {
    self.write_scalar(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, number);
    line += "float64\t" + shortest(*number);
  } else if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    self.write_scalar(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, integer);
    line += "int64\t" + std::to_string(*integer);
  } else {
    const auto& text = std::get<std::string>(value);
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, text.size() + 1);
    H5Tset_cset(type, H5T_CSET_UTF8);
    self.write_scalar(object, name, type, type, text.c_str());
    line += "string\t" + escape(text);
  }
  self.manifest += line + "\n";
}

std::uint64_t ArchiveWriter::Implementation::bytes_of(const std::string& path, ElementType type,
                                                      const std::vector<std::uint64_t>& shape) {
  if (!valid_path(path) || path == kManifestPath)
    throw Failure(Fault::argument, "'" + escape(path) + "' cannot name an array");
  if (!type_known(static_cast<std::int32_t>(type)))
    throw Failure(Fault::argument,
                  "array '" + path + "' has the unknown type " + std::to_string(static_cast<int>(type)));
  if (shape.empty() || shape.size() > 4)
    throw Failure(Fault::argument,
                  "array '" + path + "' has " + std::to_string(shape.size()) + " dimensions, expected 1..4");
  std::uint64_t bytes = type_size(type);
  bool fits = true;
  for (const auto extent : shape) fits = fits && multiply(bytes, extent, bytes);
  if (!fits || bytes > std::uint64_t{1} << 60) throw Failure(Fault::argument, "array '" + path + "' is too large");
  return bytes;
}

void ArchiveWriter::Implementation::enter(const std::string& path) {
  if (groups.contains(path)) throw Failure(Fault::argument, "'" + path + "' is a group and cannot be an array");
  const auto slash = path.rfind('/');
  if (slash != std::string::npos) make_group(path.substr(0, slash));
  if (!used.insert(path).second) throw Failure(Fault::argument, "array '" + path + "' is given twice");
}

void ArchiveWriter::put(const std::string& path, ElementType type, const std::vector<std::uint64_t>& shape,
                        const void* data) {
  auto& self = *implementation_;
  const std::uint64_t bytes = self.bytes_of(path, type, shape);
  if (bytes > 0 && !data) throw Failure(Fault::argument, "array '" + path + "' has no data");
  const std::uint64_t checksum = crc64(data, bytes);
  const Hdf5Session session;
  self.enter(path);
  const std::uint64_t offset = self.write_array(path, type, shape, bytes, data, checksum);
  self.file.check();  // stop at once on a full disk
  self.list(path, type, shape, offset, checksum);
}

void ArchiveWriter::put_rows(const std::string& path, const std::vector<std::uint64_t>& shape, std::uint64_t most,
                             const std::function<void(std::uint64_t, std::uint64_t, double*)>& fill) {
  auto& self = *implementation_;
  const std::uint64_t bytes = self.bytes_of(path, ElementType::float64, shape);
  if (bytes == 0) return put(path, ElementType::float64, shape, nullptr);
  if (most == 0) throw Failure(Fault::argument, "array '" + path + "' cannot be written in pieces of no rows");
  const std::uint64_t row = bytes / sizeof(double) / shape[0];
  std::vector<double> values(static_cast<std::size_t>(std::min(most, shape[0]) * row));
  const Hdf5Session session;
  self.enter(path);
  std::vector<hsize_t> extent(shape.begin(), shape.end()), first(shape.size(), 0);
  const Handle space(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
  const Handle dataset(self.create_array(path, ElementType::float64, space), H5Dclose);
  std::uint64_t checksum = 0;
  for (first[0] = 0; first[0] < shape[0]; first[0] += most) {
    extent[0] = std::min<std::uint64_t>(most, shape[0] - first[0]);
    fill(first[0], extent[0], values.data());
    checksum = crc64(values.data(), static_cast<std::size_t>(extent[0] * row * sizeof(double)), checksum);
    const Handle piece(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
    self.require(H5Sselect_hyperslab(space, H5S_SELECT_SET, first.data(), nullptr, extent.data(), nullptr) >= 0 &&
                     H5Dwrite(dataset, stored_type(ElementType::float64), piece, space, H5P_DEFAULT, values.data()) >= 0,
                 "write the array '" + path + "'");
    self.file.check();
  }
  self.write_scalar(dataset, "crc64", H5T_STD_U64LE, H5T_NATIVE_UINT64, &checksum);
  self.list(path, ElementType::float64, shape, self.place_of(dataset, path), checksum);
}

void ArchiveWriter::commit() {
  auto& self = *implementation_;
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof header.magic);
  header.version = kHeaderVersion;
  header.size = kHeaderSize;
  header.manifest_size = self.manifest.size();
  header.manifest_checksum = crc64(self.manifest.data(), self.manifest.size());
  std::memcpy(header.note, kNote, sizeof kNote);
  {
    const Hdf5Session session;
    header.manifest_offset = self.write_array(kManifestPath, ElementType::uint8, {self.manifest.size()},
                                              self.manifest.size(), self.manifest.data(), header.manifest_checksum);
    self.require(H5Fflush(self.hdf5.id, H5F_SCOPE_GLOBAL) >= 0, "flush the file");
    self.require(close_hdf5(self.hdf5) >= 0, "close the file");
  }
  // HDF5 may leave gaps at the end unwritten: they must exist before they are summed.
  header.file_size = self.file.size();
  self.file.resize(header.file_size);
  std::vector<char> piece(kPieceSize);
  for (std::uint64_t at = kHeaderSize; at < header.file_size; at += kPieceSize) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(kPieceSize, header.file_size - at));
    self.file.read_at(at, piece.data(), size);
    header.checksum = crc64(piece.data(), size, header.checksum);
  }
  header.header_checksum = crc64(&header, offsetof(Header, header_checksum));
  self.file.write_at(0, &header, sizeof header);
  self.file.commit();
}

// -------------------------------------------------------------------------------------------------------------- reader

namespace {

// Says what a file without our header is.
[[noreturn]] void refuse_foreign(const char* bytes, std::uint64_t file_size, const unsigned char* after_header) {
  if (file_size == 0) fail_format("is empty");
  if (file_size >= 8 && std::memcmp(bytes, kHdf5Signature, 8) == 0)
    fail_format("is an HDF5 file, but not one that Ogive wrote");
  if (file_size >= kHeaderSize + 8 && std::memcmp(after_header, kHdf5Signature, 8) == 0)
    fail_format("has a damaged header, or is an HDF5 file that Ogive did not write");
  fail_format("is not an Ogive file");
}

}  // namespace

ArchiveReader::ArchiveReader(const std::string& path) {
  // Not blocking: opening a pipe would wait for its other end.
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) throw Failure(Fault::file, "cannot open: " + system_reason(errno));
  try {
    struct stat status {};
    if (fstat(descriptor_, &status) != 0) throw Failure(Fault::file, "cannot read: " + system_reason(errno));
    if (!S_ISREG(status.st_mode))
      throw Failure(Fault::file, S_ISDIR(status.st_mode) ? "is a directory" : "is not a regular file");
    file_size_ = static_cast<std::uint64_t>(status.st_size);

    std::array<char, kHeaderSize + 8> start{};
    read_bytes(0, start.data(), static_cast<std::size_t>(std::min<std::uint64_t>(start.size(), file_size_)));
    Header header;
    std::memcpy(&header, start.data(), sizeof header);
    if (std::memcmp(header.magic, kMagic, sizeof header.magic) != 0)
      refuse_foreign(start.data(), file_size_, reinterpret_cast<unsigned char*>(start.data()) + kHeaderSize);
    if (file_size_ < kHeaderSize) fail_format("is cut off within its header");
    if (header.header_checksum != crc64(&header, offsetof(Header, header_checksum)))
      fail_format("has a damaged header (its checksum is wrong)");
    if (header.version != kHeaderVersion || header.size != kHeaderSize)
      fail_format("has header version " + std::to_string(header.version) + ", this library reads " +
                  std::to_string(kHeaderVersion));
    if (header.file_size != file_size_)
      fail_format("has " + std::to_string(file_size_) + " bytes, expected " + std::to_string(header.file_size) +
                  (file_size_ < header.file_size ? ": it was cut off" : ": something was appended"));
    checksum_ = header.checksum;

    if (header.manifest_offset < kHeaderSize || header.manifest_offset > file_size_ ||
        header.manifest_size > file_size_ - header.manifest_offset)
      fail_format("has a manifest outside the file");
    std::string manifest(header.manifest_size, '\0');
    read_bytes(header.manifest_offset, manifest.data(), manifest.size());
    if (crc64(manifest.data(), manifest.size()) != header.manifest_checksum)
      fail_format("has a damaged manifest (its checksum is wrong)");
    parse_manifest(manifest);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

ArchiveReader::~ArchiveReader() { close(descriptor_); }

void ArchiveReader::read_bytes(std::uint64_t offset, void* data, std::size_t size) const {
  auto* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t done = pread(descriptor_, bytes, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) throw Failure(Fault::file, "cannot read: " + system_reason(errno));
    if (done == 0) fail_format("was cut off while it was read");
    bytes += done;
    offset += static_cast<std::uint64_t>(done);
    size -= static_cast<std::size_t>(done);
  }
}

std::uint64_t ArchiveReader::checksum_of(std::uint64_t offset, std::uint64_t size) const {
  std::vector<char> piece(static_cast<std::size_t>(std::min<std::uint64_t>(kPieceSize, size)));
  std::uint64_t checksum = 0;
  while (size > 0) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), size));
    read_bytes(offset, piece.data(), part);
    checksum = crc64(piece.data(), part, checksum);
    offset += part;
    size -= part;
  }
  return checksum;
}

void ArchiveReader::parse_manifest(std::string_view text) {
  // The checksum was right, so a malformed line is a foreign writer's or a newer version's.
  const auto malformed = [](std::string_view line) { fail_format("has a malformed manifest line: " + escape(line)); };
  if (text.empty() || text.back() != '\n') malformed("no end of line");
  text.remove_suffix(1);
  const auto lines = split(text, '\n');
  if (lines.front() != kManifestTitle) malformed(lines.front());

  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto words = split(lines[i], '\t');
    if (words[0] == "attribute" && words.size() == 5 && words[1].starts_with('/')) {
      AttributeValue value;
      double number;
      std::int64_t integer;
      if (words[3] == "string") {
        value = unescape(words[4]);
      } else if (words[3] == "float64" && parse(words[4], number)) {
        value = number;
      } else if (words[3] == "int64" && parse(words[4], integer)) {
        value = integer;
      } else {
        malformed(lines[i]);
      }
      attributes_[std::string(words[1].substr(1))][std::string(words[2])] = value;
    } else if (words[0] == "array" && words.size() == 6) {
      Array array{};
      array.path = words[1];
      if (!valid_path(array.path)) malformed(lines[i]);
      for (std::int32_t type = 1; type_known(type); ++type)
        if (words[2] == type_name(static_cast<ElementType>(type))) array.type = static_cast<ElementType>(type);
      if (!type_known(static_cast<std::int32_t>(array.type))) malformed(lines[i]);
      array.count = 1;
      for (const auto extent : split(words[3], 'x')) {
        std::uint64_t number;
        if (!parse(extent, number) || !multiply(array.count, number, array.count)) malformed(lines[i]);
        array.shape.push_back(number);
      }
      if (array.shape.size() > 4 || !multiply(array.count, type_size(array.type), array.bytes) ||
          !parse(words[4], array.offset) || words[5].size() != 16 || !parse(words[5], array.checksum, 16))
        malformed(lines[i]);
      // Before anyone takes memory for it: no array is larger than the file that holds it.
      if (array.bytes > file_size_ || array.offset > file_size_ - array.bytes)
        fail_format("array '" + array.path + "' reaches beyond the end of the file");
      if (!index_.emplace(array.path, arrays_.size()).second) fail_format("array '" + array.path + "' is there twice");
      arrays_.push_back(std::move(array));
    } else {
      malformed(lines[i]);
    }
  }

  const auto* name = attribute<std::string>("", "format");
  const auto* version = attribute<std::int64_t>("", "format_version");
  if (!name || !version) fail_format("does not say its format");
  format_ = *name;
  format_version_ = *version;
  for (const Format& known : {kCheckpointFormat, kParticlesFormat}) {
    if (format_ != known.name) continue;
    if (format_version_ < 1 || format_version_ > known.version)
      fail_format("is of format " + format_ + " version " + std::to_string(format_version_) +
                  ", this library reads 1 to " + std::to_string(known.version) + "; a newer Ogive wrote it");
    return;
  }
  fail_format("is of the unknown format '" + format_ + "'");
}

const ArchiveReader::Array* ArchiveReader::find(std::string_view path) const {
  const auto found = index_.find(path);
  return found == index_.end() ? nullptr : &arrays_[found->second];
}

std::vector<std::string> ArchiveReader::damage() const {
  std::vector<std::string> findings;
  for (const auto& array : arrays_)
    if (checksum_of(array.offset, array.bytes) != array.checksum)
      findings.push_back("array '" + array.path + "' is damaged (its checksum is wrong)");
  // Arrays may all be whole and yet HDF5's own structure between them not.
  if (checksum_of(kHeaderSize, file_size_ - kHeaderSize) != checksum_ && findings.empty())
    findings.push_back("the HDF5 structure around the arrays is damaged (the file's checksum is wrong)");
  return findings;
}

void ArchiveReader::require_undamaged() const {
  const auto findings = damage();
  if (findings.empty()) return;
  fail_format(findings.front() +
              (findings.size() > 1 ? ", and " + std::to_string(findings.size() - 1) + " more findings" : ""));
}

void ArchiveReader::read(const Array& array, void* data) const {
  read_bytes(array.offset, data, array.bytes);
  if (crc64(data, array.bytes) != array.checksum)
    fail_format("array '" + array.path + "' is damaged (its checksum is wrong)");
}

}  // namespace ogive::io
