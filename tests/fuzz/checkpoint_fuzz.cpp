// Checkpoints, by the first byte: a good save with some of its arrays changed; a good file with some bytes changed or cut off; or
// a file as it is given. The checksums of files are made right where that can be done, so that what lies behind them is reached.
// In every case a world is loaded or refused; a loaded one can be looked at, stepped and saved.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "crc64.hpp"
#include "memory_file.hpp"
#include "worlds.hpp"

namespace {

using namespace fuzz;

// The layout of docs/formats.md: places of numbers in the header.
constexpr std::size_t kHeader = 512;
enum : std::size_t { kFileSize = 24, kSum = 32, kManifest = 40, kManifestSize = 48, kManifestSum = 56, kHeaderSum = 504 };

std::uint64_t number_at(const std::string& file, std::size_t at) {
  std::uint64_t value;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}
void put_number(std::string& file, std::size_t at, std::uint64_t value) { std::memcpy(file.data() + at, &value, sizeof value); }

void mend_checksums(std::string& file) {
  if (file.size() < kHeader || file.compare(0, 10, "\x89OGIVE-HDF") != 0) return;
  put_number(file, kFileSize, file.size());
  const std::uint64_t at = number_at(file, kManifest), size = number_at(file, kManifestSize);
  if (at >= kHeader && at <= file.size() && size <= file.size() - at) {
    // Each line of an array ends with its checksum: its place and size are the two words before.
    std::size_t line = at;
    while (line < at + size) {
      const std::size_t end = std::min<std::size_t>(file.find('\n', line), at + size);
      char path[200], type[20], shape[60];
      unsigned long long offset = 0;
      const std::string text = file.substr(line, end - line);
      if (std::sscanf(text.c_str(), "array\t%199[^\t]\t%19[^\t]\t%59[^\t]\t%llu\t", path, type, shape, &offset) == 4 &&
          text.size() > 16) {
        unsigned long long bytes = std::strcmp(type, "uint8") == 0 ? 1 : std::strcmp(type, "int32") == 0 ? 4 : 8, extent = 0;
        if (std::sscanf(shape, "%llu", &extent) == 1 && extent <= file.size()) bytes *= extent;
        if (offset <= file.size() && bytes <= file.size() - offset) {
          char sum[17];
          std::snprintf(sum, sizeof sum, "%016llx",
                        static_cast<unsigned long long>(ogive::io::crc64(file.data() + offset, bytes)));
          file.replace(end - 16, 16, sum);
        }
      }
      line = end + 1;
    }
    put_number(file, kManifestSum, ogive::io::crc64(file.data() + at, size));
  }
  put_number(file, kSum, ogive::io::crc64(file.data() + kHeader, file.size() - kHeader));
  put_number(file, kHeaderSum, ogive::io::crc64(file.data(), kHeaderSum));
}

void use(ogive_world* world) {
  ogive_ledger ledger{};
  ledger.struct_size = sizeof ledger;
  require(ogive_world_ledger(world, &ledger) == OGIVE_OK, "a loaded world has no ledger");
  std::size_t needed = 0;
  require(ogive_world_plan(world, nullptr, 0, &needed) == OGIVE_OK, "a loaded world has no plan");
  for (std::int32_t b = 0; b < ogive_body_count(world); ++b)
    for (std::int32_t f = 0; f < ogive_field_count(world, {b}); ++f) {
      std::int32_t components = 0;
      const char* name = ogive_field_name(world, {b}, f, &components);
      ogive_body_result body{};
      body.struct_size = sizeof body;
      require(ogive_body_result_get(world, {b}, &body) == OGIVE_OK, "a loaded body has no results");
      std::vector<double> values(static_cast<std::size_t>(body.particles * components) + 1);
      require(ogive_field_get(world, {b}, name, values.data(), body.particles * components) == OGIVE_OK,
              "a loaded field cannot be read");
    }
  step_and_look(world, 3);
  Store store;
  const ogive_writer writer = store.writer();
  require(ogive_world_save(world, &writer) == OGIVE_OK, "a loaded world cannot be saved");
  ++fuzz::accepted;
}

void load_file(std::string bytes) {
  mend_checksums(bytes);
  const MemoryFile file(bytes.data(), bytes.size());
  char text[4096];
  std::size_t needed = 0;
  ogive_file_verify(file.path().c_str(), text, sizeof text, &needed);
  ogive_file_info(file.path().c_str(), text, sizeof text, &needed);
  const World world = make_world();
  const ogive_status status = ogive_checkpoint_read(world.get(), file.path().c_str());
  require(status != OGIVE_ERROR_INTERNAL, "reading a checkpoint ended with an internal error");
  if (status == OGIVE_OK) use(world.get());
}

std::string good_file(int kind) {
  static const std::vector<std::string> files = [] {
    std::vector<std::string> all;
    std::string name = (std::filesystem::temp_directory_path() / "ogive-fuzz-XXXXXX").string();
    const int descriptor = mkstemp(name.data());
    require(descriptor >= 0, "no temporary file");
    ::close(descriptor);
    for (int k = 0; k < world_kinds; ++k) {
      require(ogive_checkpoint_write(small_world(k).get(), name.c_str()) == OGIVE_OK, "a good world cannot be written");
      std::ifstream stream(name, std::ios::binary);
      all.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    }
    std::filesystem::remove(name);
    return all;
  }();
  return files[kind];
}

// Changes where the text of the manifest is as often as anywhere else.
void change_bytes(Input& input, std::string& file) {
  const std::size_t manifest = static_cast<std::size_t>(number_at(file, kManifest));
  for (int i = 0; i < 6 && !input.ended(); ++i) {
    std::size_t at = static_cast<std::size_t>(input.byte()) << 16 | static_cast<std::size_t>(input.byte()) << 8 | input.byte();
    at = input.one_in(2) ? manifest + at % (file.size() - manifest) : at % file.size();
    file[at] = static_cast<char>(input.byte());
  }
  if (input.one_in(8)) file.resize(file.size() * input.byte() / 256);
}

const Store& good_save(int kind) {
  static const std::vector<Store> saves = [] {
    std::vector<Store> all(world_kinds);
    for (int k = 0; k < world_kinds; ++k) {
      const World world = small_world(k);
      const ogive_writer writer = all[k].writer();
      require(ogive_world_save(world.get(), &writer) == OGIVE_OK, "a good world cannot be saved");
    }
    return all;
  }();
  return saves[kind];
}

void change(Input& input, Store& store) {
  auto found = store.arrays.begin();
  std::advance(found, input.below(static_cast<int>(store.arrays.size())));
  Store::Array& array = found->second;
  const std::size_t size = Store::size_of(array.type);
  switch (input.below(12)) {
    case 0:
      store.arrays.erase(found);
      return;
    case 1:
      array.type = 1 + input.below(6);
      return;
    case 2:
      array.count = input.whole();
      if (array.count >= 0 && array.count <= 100000) array.bytes.resize(static_cast<std::size_t>(array.count) * size);
      return;
    default:
      break;
  }
  if (array.bytes.size() < size) return;
  const std::size_t at = static_cast<std::size_t>(input.below(static_cast<int>(array.bytes.size() / size))) * size;
  if (array.type == OGIVE_TYPE_FLOAT64) {
    const double value = input.number();
    std::memcpy(&array.bytes[at], &value, 8);
  } else if (array.type == OGIVE_TYPE_INT32) {
    const std::int32_t value = input.whole();
    std::memcpy(&array.bytes[at], &value, 4);
  } else {
    const std::int64_t value = input.whole();
    std::memcpy(&array.bytes[at], &value, size);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const int first = input.byte();
  if (first % 4 == 1) {
    load_file(input.rest());
    return 0;
  }
  if (first % 4 == 3) {
    std::string file = good_file(first / 4 % world_kinds);
    change_bytes(input, file);
    load_file(file);
    return 0;
  }
  Store store = good_save(first / 4 % world_kinds);
  for (int i = 0; i < 8 && !input.ended(); ++i) change(input, store);
  const World world = make_world();
  const ogive_reader reader = store.reader();
  const ogive_status status = ogive_world_load(world.get(), &reader);
  require(status != OGIVE_ERROR_INTERNAL, "loading ended with an internal error");
  if (status == OGIVE_OK) use(world.get());
  return 0;
}
