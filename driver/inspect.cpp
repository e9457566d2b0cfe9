// ogive voxelise and ogive info: looks at single files.
#include "inspect.hpp"

#include <ogive.h>

#include <cstdio>
#include <numeric>

#include "filled_mesh.hpp"
#include "particle_csv.hpp"
#include "text.hpp"
#include "world.hpp"

namespace driver {
namespace {

void require_file_ok(ogive_status status, const std::string& file, const std::string& text) {
  if (status == OGIVE_OK) return;
  const bool damaged = status == OGIVE_ERROR_FORMAT || status == OGIVE_ERROR_ARGUMENT;
  std::string message = text.empty() ? ogive_status_name(status) : text;
  if (message.find(file) == std::string::npos) message = file + ": " + message;
  throw Failure(damaged ? kExitDamaged : exit_code(status), message);
}

}  // namespace

ExitCode voxelise(const MeshShape& mesh, const std::string& output_file) {
  const FilledMesh filled = fill_mesh(mesh, GridScene{}, "voxelise");
  write_particle_csv(output_file, filled.particles);
  const std::vector<double>& volumes = filled.particles.volumes;
  std::printf("%s\n%s particles of total volume %s in %s\n", filled.report.c_str(),
              grouped(static_cast<int64_t>(volumes.size())).c_str(),
              shortest(std::accumulate(volumes.begin(), volumes.end(), 0.0)).c_str(), output_file.c_str());
  return kExitOk;
}

ExitCode info(const std::string& file, bool verify) {
  ogive_status status = OGIVE_OK;
  const std::string description =
      text_of([&](char* text, size_t capacity,
                  size_t* needed) { return ogive_file_info(file.c_str(), text, capacity, needed); },
              status);
  require_file_ok(status, file, description);
  std::printf("%s\n", description.c_str());
  if (!verify) return kExitOk;
  const std::string findings =
      text_of([&](char* text, size_t capacity,
                  size_t* needed) { return ogive_file_verify(file.c_str(), text, capacity, needed); },
              status);
  require_file_ok(status, file, findings);
  std::printf("%s%sundamaged\n", findings.c_str(), findings.empty() ? "" : "\n");
  return kExitOk;
}

}  // namespace driver
