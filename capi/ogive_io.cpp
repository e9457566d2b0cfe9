// The file functions of ogive.h, built into the library ogive_io: they carry arrays between a world, which they see
// through the public interface alone, and the HDF5 files of lib/io. No exception passes this file.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <limits>
#include <new>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "hdf5_archive.hpp"
#include "ogive.h"
#include "particle_text.hpp"
#include "series.hpp"

namespace {

using ogive::io::ArchiveReader;
using ogive::io::ArchiveWriter;
using ogive::io::ElementType;
using ogive::io::Failure;
using ogive::io::Fault;

constexpr std::string_view kAttachment = "attachment/";

// An error that a call on the world returned: its status and message go to the caller as they are.
struct WorldFailure {
  ogive_status status;
};

void require(ogive_status status) {
  if (status != OGIVE_OK) throw WorldFailure{status};
}

ogive_status status_of(Fault fault) {
  switch (fault) {
    case Fault::argument:
      return OGIVE_ERROR_ARGUMENT;
    case Fault::file:
      return OGIVE_ERROR_FILE;
    case Fault::format:
      return OGIVE_ERROR_FORMAT;
  }
  return OGIVE_ERROR_INTERNAL;
}

// Runs `work` and turns whatever it throws into a status; `report` takes the status and the reason.
template <class Work, class Report>
ogive_status guarded(const Work& work, const Report& report) noexcept {
  try {
    try {
      work();
      return OGIVE_OK;
    } catch (const WorldFailure& failure) {
      return failure.status;
    } catch (const Failure& failure) {
      return report(status_of(failure.fault()), failure.what());
    } catch (const std::bad_alloc&) {
      return report(OGIVE_ERROR_MEMORY, "memory could not be had");
    } catch (const std::exception& error) {
      return report(OGIVE_ERROR_INTERNAL, error.what());
    }
  } catch (...) {  // even the message found no memory
    return OGIVE_ERROR_MEMORY;
  }
}

// The same with the message left in the world, led by what the file is and its path.
template <class Work>
ogive_status for_world(ogive_world* world, const char* kind, const char* path, const Work& work) noexcept {
  if (!world) return OGIVE_ERROR_ARGUMENT;
  if (!path || !*path)
    return ogive_world_report(
        world, OGIVE_ERROR_ARGUMENT,
        path ? "path is empty, expected the name of a file" : "path is NULL, expected a file name");
  return guarded(work, [&](ogive_status status, const char* reason) {
    return ogive_world_report(world, status, (std::string(kind) + " '" + path + "': " + reason).c_str());
  });
}

// ---------------------------------------------------------------------------------------------------------- checkpoint

// Where an array of a save is in the file. Attachments have names of the host's choice, which may hold anything.
std::string path_of(std::string_view name) {
  if (!name.starts_with(kAttachment)) return std::string(name);
  return std::string(kAttachment) + ogive::io::path_component(name.substr(kAttachment.size()));
}

// The engine calls back through C, so an exception waits here until it has returned.
struct Transfer {
  ArchiveWriter* writer = nullptr;
  const ArchiveReader* reader = nullptr;
  ogive_status status = OGIVE_OK;
  std::string reason;

  template <class Work>
  ogive_status run(const Work& work) noexcept {
    status = OGIVE_OK;  // the engine carried on after an earlier failure, so that one is not the reason of a later one
    return guarded(work, [this](ogive_status failed, const char* why) {
      status = failed;
      reason = why;
      return failed;
    });
  }
  // After the engine has returned `result`: a reason of ours is more telling than the engine's "the writer failed".
  void finish(ogive_status result) const {
    if (result == OGIVE_OK) return;
    if (status == OGIVE_OK) throw WorldFailure{result};
    if (status == OGIVE_ERROR_MEMORY) throw std::bad_alloc();
    const Fault fault = status == OGIVE_ERROR_FORMAT ? Fault::format
                        : status == OGIVE_ERROR_FILE ? Fault::file
                                                     : Fault::argument;
    throw Failure(fault, reason);
  }
};

ogive_status put_array(void* user, const char* name, int32_t type, int64_t count, const void* data) {
  auto* transfer = static_cast<Transfer*>(user);
  return transfer->run([&] {
    if (!name || count < 0) throw Failure(Fault::argument, "an array without a name or of negative length was saved");
    transfer->writer->put(path_of(name), static_cast<ElementType>(type), {static_cast<std::uint64_t>(count)}, data);
  });
}

const ArchiveReader::Array& find_array(const Transfer& transfer, const char* name) {
  const auto* array = name ? transfer.reader->find(path_of(name)) : nullptr;
  if (!array) throw Failure(Fault::format, "has no array '" + std::string(name ? name : "") + "'");
  return *array;
}

ogive_status measure_array(void* user, const char* name, int32_t* type, int64_t* count) {
  auto* transfer = static_cast<Transfer*>(user);
  return transfer->run([&] {
    const auto& array = find_array(*transfer, name);
    *type = static_cast<std::int32_t>(array.type);
    *count = static_cast<std::int64_t>(array.count);
  });
}

ogive_status get_array(void* user, const char* name, int64_t count, void* data) {
  auto* transfer = static_cast<Transfer*>(user);
  return transfer->run([&] {
    const auto& array = find_array(*transfer, name);
    if (count < 0 || static_cast<std::uint64_t>(count) != array.count)
      throw Failure(Fault::format, "array '" + array.path + "' has " + std::to_string(array.count) +
                                       " elements, expected " + std::to_string(count));
    transfer->reader->read(array, data);
  });
}

// What the world says of the engine's own failure, with the file's name before it.
void add_file_to_message(ogive_world* world, ogive_status status, const char* path) {
  const char* message = ogive_world_message(world);
  const std::string reason = message && *message ? message : ogive_status_name(status);
  ogive_world_report(world, status, ("checkpoint '" + std::string(path) + "': " + reason).c_str());
}

// ---------------------------------------------------------------------------------------------------------- particles

// A symmetric tensor goes into the file in the order in which ParaView labels six components.
constexpr char kTensorComponents[] = "xx yy zz xy yz xz";
constexpr int kTensorOrder[] = {0, 1, 2, 5, 3, 4};  // of the engine's xx yy zz yz xz xy

// Place of each particle in the order of numbers; empty where the number is the place.
std::vector<std::int32_t> ranks_of(const ogive_field_view& view, std::uint64_t particles) {
  std::int32_t highest = -1;
  for (std::int64_t p = 0; p < view.places; ++p) highest = std::max(highest, view.number[p]);
  std::vector<std::int32_t> rank;
  if (static_cast<std::uint64_t>(highest + 1) == particles) return rank;
  rank.assign(static_cast<std::size_t>(highest) + 2, 0);
  for (std::int64_t p = 0; p < view.places; ++p)
    if (view.number[p] >= 0) rank[static_cast<std::size_t>(view.number[p]) + 1] = 1;
  std::partial_sum(rank.begin(), rank.end(), rank.begin());
  return rank;
}

// A field of several components, in pieces as long as a field of one: particles are in the engine's order, which each piece
// goes through anew.
void put_components(ArchiveWriter& archive, const std::string& path, const ogive_field_view& view, std::uint64_t particles) {
  const std::vector<std::int32_t> rank = ranks_of(view, particles);
  const std::uint64_t components = static_cast<std::uint64_t>(view.components);
  const auto fill = [&](std::uint64_t first, std::uint64_t rows, double* values) {
    for (std::int64_t p = 0; p < view.places; ++p) {
      const std::int32_t number = view.number[p];
      if (number < 0) continue;
      const std::uint64_t row =
          static_cast<std::uint64_t>(rank.empty() ? number : rank[static_cast<std::size_t>(number)]) - first;
      if (row >= rows) continue;  // also what lies before, by wrapping
      for (std::uint64_t c = 0; c < components; ++c)
        values[components * row + c] = view.component[components == 6 ? kTensorOrder[c] : static_cast<int>(c)][p * view.stride];
    }
  };
  archive.put_rows(path, {particles, components}, std::max<std::uint64_t>(1, particles / components + 1), fill);
}

// 0, 1, 2 ...: what ParaView needs to see each particle as a point to draw. XDMF has no shorter way to say so.
void put_connectivity(ArchiveWriter& archive, const std::string& path, std::uint64_t particles) {
  const auto put = [&]<class Index>(Index, ElementType type) {
    std::vector<Index> indices(static_cast<std::size_t>(particles));
    std::iota(indices.begin(), indices.end(), Index{0});
    archive.put(path, type, {particles}, indices.data());
  };
  if (particles <= static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
    put(std::int32_t{}, ElementType::int32);
  else
    put(std::int64_t{}, ElementType::int64);
}

// --------------------------------------------------------------------------------------------------- text for callers

void return_text(const std::string& text, char* out, size_t capacity, size_t* needed) {
  if (needed) *needed = text.size() + 1;
  if (capacity == 0) return;
  const std::size_t length = std::min(text.size(), capacity - 1);
  std::memcpy(out, text.data(), length);
  out[length] = '\0';
}

// Runs `work`, which appends lines to the text, and appends the reason if it fails.
template <class Work>
ogive_status with_text(const char* path, char* out, size_t capacity, size_t* needed, const Work& work) noexcept {
  if (out && capacity > 0) *out = '\0';
  if (needed) *needed = 1;
  if (!path || (!out && capacity > 0)) return OGIVE_ERROR_ARGUMENT;
  std::string text;
  const ogive_status status = guarded([&] { work(text); },
                                      [&](ogive_status failed, const char* reason) {
                                        text += std::string(path) + ": " + reason + "\n";
                                        return failed;
                                      });
  return_text(text, out, capacity, needed);
  return status;
}

std::string bytes_text(std::uint64_t bytes) {
  char text[64];
  if (bytes < 10'000'000)
    std::snprintf(text, sizeof text, "%.1f kB", 1e-3 * static_cast<double>(bytes));
  else
    std::snprintf(text, sizeof text, "%.1f MB", 1e-6 * static_cast<double>(bytes));
  return text;
}

std::string number_text(double number) {
  char text[64];
  std::snprintf(text, sizeof text, "%.10g", number);
  return text;
}

std::string kind_of(const ArchiveReader& reader) {
  return reader.format() == ogive::io::kCheckpointFormat.name ? "Ogive checkpoint" : "Ogive particle file";
}

}  // namespace

extern "C" {

ogive_status ogive_checkpoint_write(ogive_world* world, const char* path) {
  return for_world(world, "checkpoint", path, [&] {
    ogive_progress progress{};
    progress.struct_size = sizeof progress;
    require(ogive_world_progress(world, &progress));
    ArchiveWriter archive(path, ogive::io::kCheckpointFormat, ogive_version());
    archive.set_attribute("", "time", progress.time);
    archive.set_attribute("", "steps", progress.steps);
    archive.set_attribute("", "particles", progress.particles);
    Transfer transfer;
    transfer.writer = &archive;
    const ogive_writer writer{sizeof writer, 0, &transfer, put_array};
    transfer.finish(ogive_world_save(world, &writer));
    archive.commit();
  });
}

ogive_status ogive_checkpoint_read(ogive_world* world, const char* path) {
  return for_world(world, "checkpoint", path, [&] {
    const ArchiveReader archive(path);
    if (archive.format() != ogive::io::kCheckpointFormat.name)
      throw Failure(Fault::format, "is not a checkpoint (its format is " + archive.format() + ")");
    archive.require_undamaged();
    Transfer transfer;
    transfer.reader = &archive;
    const ogive_reader reader{sizeof reader, 0, &transfer, measure_array, get_array};
    const ogive_status loaded = ogive_world_load(world, &reader);
    if (loaded != OGIVE_OK && transfer.status == OGIVE_OK) add_file_to_message(world, loaded, path);
    transfer.finish(loaded);
  });
}

ogive_status ogive_file_verify(const char* path, char* text, size_t capacity, size_t* needed) {
  return with_text(path, text, capacity, needed, [&](std::string& lines) {
    const ArchiveReader archive(path);
    const auto findings = archive.damage();
    for (const auto& finding : findings) lines += std::string(path) + ": " + finding + "\n";
    if (!findings.empty()) throw WorldFailure{OGIVE_ERROR_FORMAT};
    lines += std::string(path) + ": undamaged, " + std::to_string(archive.arrays().size()) + " arrays, " +
             std::to_string(archive.file_size()) + " bytes, all checksums right\n";
  });
}

ogive_status ogive_file_info(const char* path, char* text, size_t capacity, size_t* needed) {
  return with_text(path, text, capacity, needed, [&](std::string& lines) {
    const ArchiveReader archive(path);
    const auto* library = archive.attribute<std::string>("", "library_version");
    const auto* time = archive.attribute<double>("", "time");
    const auto* steps = archive.attribute<std::int64_t>("", "steps");
    const auto* particles = archive.attribute<std::int64_t>("", "particles");
    lines += std::string(path) + ": " + kind_of(archive) + ", format version " +
             std::to_string(archive.format_version()) + ", written by Ogive " + (library ? *library : "(unknown)") +
             ", " + bytes_text(archive.file_size()) + "\n";
    if (time && steps && particles)
      lines += "time " + number_text(*time) + ", step " + std::to_string(*steps) + ", " + std::to_string(*particles) +
               " particles\n";
    for (const auto& [group, attributes] : archive.attributes()) {
      const auto* name = archive.attribute<std::string>(group, "name");
      const auto* count = archive.attribute<std::int64_t>(group, "particles");
      if (!group.empty() && name && count) lines += "body " + *name + ": " + std::to_string(*count) + " particles\n";
    }
    // A checkpoint has hundreds of single numbers: only what is an array worth the name gets a line.
    constexpr std::uint64_t kListed = 16;
    std::size_t small = 0;
    for (const auto& array : archive.arrays()) {
      if (array.count < kListed && array.shape.size() == 1)
        ++small;
      else
        lines += "  " + array.path + "  " + type_name(array.type) + " " + ogive::io::shape_text(array.shape) + "\n";
    }
    if (small > 0)
      lines += "  and " + std::to_string(small) + " of fewer than " + std::to_string(kListed) + " elements\n";
  });
}

ogive_status ogive_body_add_particle_file(ogive_world* world, const char* name, const ogive_body_def* def, const char* path,
                                          ogive_body_id* id) {
  if (!world) return OGIVE_ERROR_ARGUMENT;
  if (!path || !*path)
    return ogive_world_report(
        world, OGIVE_ERROR_ARGUMENT,
        path ? "path is empty, expected the name of a file" : "path is NULL, expected a file name");
  return guarded(
      [&] {
        const ogive::io::ParticleList particles = ogive::io::read_particle_text(path);
        require(ogive_body_add_particles(world, name, def, static_cast<std::int64_t>(particles.volumes.size()),
                                         particles.positions.data(), particles.volumes.data(), id));
      },
      [&](ogive_status status, const char* reason) {
        const bool in_line = *reason == ':';
        return ogive_world_report(world, status, (in_line ? path + std::string(reason)
                                                          : '"' + std::string(path) + "\" " + reason).c_str());
      });
}

ogive_status ogive_particles_write(ogive_world* world, const char* path) {
  return for_world(world, "particle file", path, [&] {
    ogive_progress progress{};
    progress.struct_size = sizeof progress;
    require(ogive_world_progress(world, &progress));
    ArchiveWriter archive(path, ogive::io::kParticlesFormat, ogive_version());
    archive.set_attribute("", "time", progress.time);
    archive.set_attribute("", "steps", progress.steps);
    archive.set_attribute("", "particles", progress.particles);
    archive.set_attribute("", "tensor_components", std::string(kTensorComponents));
    std::vector<double> values;
    for (std::int32_t i = 0; i < ogive_body_count(world); ++i) {
      const ogive_body_id body{i};
      ogive_body_result result{};
      result.struct_size = sizeof result;
      require(ogive_body_result_get(world, body, &result));
      const std::string name = ogive_body_name(world, body);
      const std::string group = ogive::io::path_component(name);
      archive.set_attribute(group, "name", name);
      archive.set_attribute(group, "particles", result.particles);
      const auto particles = static_cast<std::uint64_t>(result.particles);
      for (std::int32_t field = 0; field < ogive_field_count(world, body); ++field) {
        std::int32_t components = 0;
        const char* field_name = ogive_field_name(world, body, field, &components);
        if (std::strcmp(field_name, "affine_velocity") == 0) continue;  // of use to a restart, not to a picture
        const std::string field_path = group + "/" + ogive::io::path_component(field_name);
        if (components > 1) {  // the engine keeps all of these, and shows them without a copy
          ogive_field_view view{};
          view.struct_size = sizeof view;
          require(ogive_field_view_get(world, body, field_name, &view));
          put_components(archive, field_path, view, particles);
          continue;
        }
        values.resize(std::max<std::size_t>(particles, 1));  // never a null pointer, also for a body that has left
        require(ogive_field_get(world, body, field_name, values.data(), static_cast<std::int64_t>(particles)));
        archive.put(field_path, ElementType::float64, {particles}, values.data());
      }
      put_connectivity(archive, group + "/connectivity", particles);
    }
    archive.commit();
  });
}

ogive_status ogive_series_write(ogive_world* world, const char* path, int32_t count, const char* const* files) {
  return for_world(world, "series", path, [&] {
    if (count < 1) throw Failure(Fault::argument, "count is " + std::to_string(count) + ", expected at least 1 file");
    if (!files) throw Failure(Fault::argument, "files is NULL, expected " + std::to_string(count) + " file names");
    std::vector<std::string> names;
    for (std::int32_t i = 0; i < count; ++i) {
      if (!files[i]) throw Failure(Fault::argument, "files[" + std::to_string(i) + "] is NULL, expected a file name");
      names.emplace_back(files[i]);
    }
    ogive::io::write_series(path, names);
  });
}

}  // extern "C"
