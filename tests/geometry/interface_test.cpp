// Every function with bad arguments: an answer, a message, and nothing changed.
#include <limits>
#include <thread>

#include "support.hpp"

extern "C" int geometry_header_compiles_as_c(void);

namespace geometry_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(MeshInterface, HeaderAndDefaultsWorkFromC) { EXPECT_TRUE(geometry_header_compiles_as_c()); }

TEST(MeshInterface, NullMeshIsAnArgumentErrorEverywhere) {
  ogive_mesh_read_def read;
  ogive_mesh_read_def_init(&read, sizeof read);
  const ogive_voxelise_def def = lattice(1);
  ogive_mesh_info info{};
  info.struct_size = sizeof info;
  size_t needed = 0;
  int64_t count = 0;
  const double xyz[9] = {};
  const int32_t corners[3] = {0, 1, 2};
  EXPECT_EQ(ogive_mesh_create(nullptr), OGIVE_ERROR_ARGUMENT);
  ogive_mesh_destroy(nullptr);
  EXPECT_STREQ(ogive_mesh_message(nullptr), "");
  EXPECT_EQ(ogive_mesh_read(nullptr, "x", &read), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(ogive_mesh_set_facets(nullptr, 3, xyz, 1, corners), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(ogive_mesh_check(nullptr), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(ogive_mesh_report(nullptr, nullptr, 0, &needed), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(ogive_mesh_info_get(nullptr, &info), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(ogive_mesh_voxelise(nullptr, &def, &count, nullptr, nullptr), OGIVE_ERROR_ARGUMENT);
}

TEST(MeshInterface, InitFunctionsSetDefaultsForTheCallersSize) {
  ogive_mesh_read_def_init(nullptr, 16);
  ogive_voxelise_def_init(nullptr, 16);
  struct {
    ogive_voxelise_def def;
    double newer[4];
  } larger;
  std::memset(&larger, 0x55, sizeof larger);
  ogive_voxelise_def_init(&larger.def, sizeof larger);
  EXPECT_EQ(larger.def.struct_size, sizeof larger.def) << "what this library knows of it";
  EXPECT_EQ(larger.def.axis[2], 1);
  EXPECT_EQ(larger.newer[3], 0) << "fields this library does not know are zero";
  struct {
    uint32_t struct_size, reserved;
    double spacing[3], untouched;
  } smaller = {0, 0, {5, 5, 5}, 7};
  ogive_voxelise_def_init(reinterpret_cast<ogive_voxelise_def*>(&smaller), sizeof smaller - sizeof smaller.untouched);
  EXPECT_EQ(smaller.spacing[2], 0);
  EXPECT_EQ(smaller.untouched, 7);
}

TEST(MeshInterface, WrongStructSizesAreRefused) {
  Mesh mesh(box({0, 0, 0}, {1, 1, 1}));
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  ogive_mesh_read_def read;
  ogive_mesh_read_def_init(&read, sizeof read);
  ogive_voxelise_def def = lattice(0.5);
  int64_t count = -7;
  for (uint32_t wrong : {0u, 4u, 4096u}) {
    read.struct_size = def.struct_size = wrong;
    EXPECT_EQ(ogive_mesh_read(mesh.get(), "x", &read), OGIVE_ERROR_ARGUMENT);
    EXPECT_EQ(lacks(mesh.message(), {"def->struct_size = " + std::to_string(wrong), "expected at most "}), "");
    EXPECT_EQ(ogive_mesh_voxelise(mesh.get(), &def, &count, nullptr, nullptr), OGIVE_ERROR_ARGUMENT);
    ogive_mesh_info info{};
    info.struct_size = wrong;
    EXPECT_EQ(ogive_mesh_info_get(mesh.get(), &info), OGIVE_ERROR_ARGUMENT);
    EXPECT_EQ(lacks(mesh.message(), {"info->struct_size = " + std::to_string(wrong)}), "");
    EXPECT_EQ(info.facets, 0);
  }
  EXPECT_EQ(count, -7);
}

TEST(MeshInterface, NullPointersAreNamed) {
  Mesh mesh(box({0, 0, 0}, {1, 1, 1}));
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  ogive_mesh_read_def read;
  ogive_mesh_read_def_init(&read, sizeof read);
  const ogive_voxelise_def def = lattice(0.5);
  const double xyz[9] = {};
  const int32_t corners[3] = {0, 1, 2};
  int64_t count = 8;
  double values[24];
  char text[4];
  const auto expect = [&](ogive_status status, const char* word) {
    EXPECT_EQ(status, OGIVE_ERROR_ARGUMENT);
    EXPECT_EQ(lacks(mesh.message(), {word}), "");
  };
  expect(ogive_mesh_read(mesh.get(), nullptr, &read), "path is NULL");
  expect(ogive_mesh_read(mesh.get(), "x", nullptr), "def is NULL");
  expect(ogive_mesh_set_facets(mesh.get(), 3, nullptr, 1, corners), "xyz is NULL");
  expect(ogive_mesh_set_facets(mesh.get(), 3, xyz, 1, nullptr), "corners is NULL");
  expect(ogive_mesh_report(mesh.get(), text, 4, nullptr), "needed is NULL");
  size_t needed = 0;
  expect(ogive_mesh_report(mesh.get(), nullptr, 4, &needed), "text is NULL");
  expect(ogive_mesh_info_get(mesh.get(), nullptr), "info is NULL");
  expect(ogive_mesh_voxelise(mesh.get(), nullptr, &count, nullptr, nullptr), "def is NULL");
  expect(ogive_mesh_voxelise(mesh.get(), &def, nullptr, nullptr, nullptr), "count is NULL");
  expect(ogive_mesh_voxelise(mesh.get(), &def, &count, values, nullptr), "xyz and volume");
  expect(ogive_mesh_voxelise(mesh.get(), &def, &count, nullptr, values), "xyz and volume");
}

TEST(MeshInterface, BadValuesAreNamedWithWhatWasExpected) {
  Mesh mesh(box({0, 0, 0}, {1, 1, 1}));
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  for (double scale : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_EQ(mesh.read("x", scale), OGIVE_ERROR_ARGUMENT);
    EXPECT_EQ(lacks(mesh.message(), {"scale = ", "expected a finite number > 0"}), "");
  }
  const auto expect = [&](const std::function<void(ogive_voxelise_def&)>& change,
                          const std::vector<std::string>& words) {
    ogive_voxelise_def def = lattice(0.5);
    change(def);
    int64_t count = -7;
    EXPECT_EQ(ogive_mesh_voxelise(mesh.get(), &def, &count, nullptr, nullptr), OGIVE_ERROR_ARGUMENT);
    EXPECT_EQ(lacks(mesh.message(), words), "");
    EXPECT_EQ(count, -7);
  };
  expect([](auto& d) { d.spacing[0] = 0; }, {"spacing[0] = 0", "expected a finite number > 0"});
  expect([](auto& d) { d.spacing[1] = -0.5; }, {"spacing[1] = -0.5"});
  expect([](auto& d) { d.spacing[2] = kNan; }, {"spacing[2] = nan"});
  expect([](auto& d) { d.spacing[2] = kInfinity; }, {"spacing[2] = inf"});
  expect([](auto& d) { set(d.axis, {0, 0, 0}); }, {"axis = (0, 0, 0)", "expected a direction"});
  expect([](auto& d) { set(d.axis, {0, kNan, 0}); }, {"axis[1] = nan"});
  expect([](auto& d) { set(d.reference, {0, 0, -3}); }, {"reference = (0, 0, -3)", "not parallel to axis = (0, 0, 1)"});
  expect([](auto& d) { set(d.reference, {kInfinity, 0, 0}); }, {"reference[0] = inf"});
  expect([](auto& d) { set(d.lattice_axis, {0, 0, 0}); }, {"lattice_axis = (0, 0, 0)"});
  expect([](auto& d) { set(d.lattice_reference, {0, 0, 1}); }, {"lattice_reference = ", "lattice_axis"});
  expect([](auto& d) { set(d.lattice_origin, {0, 0, kNan}); }, {"lattice_origin[2] = nan"});
  expect([](auto& d) { set(d.position, {kInfinity, 0, 0}); }, {"position[0] = inf"});
  expect([](auto& d) { set(d.spacing, {1e-4, 1e-4, 1e-4}); }, {"spacing = (0.0001,", "lattice cells", "at most 1e11"});
  expect([](auto& d) { d.spacing[1] = 1e-10; }, {"spacing[1] = 1e-10", "cells from the lattice origin"});
  expect([](auto& d) { set(d.lattice_origin, {1e12, 0, 0}); }, {"cells from the lattice origin"});
  expect([](auto& d) { set(d.lattice_origin, {0, 1e300, 0}); }, {"lattice_origin[1] = 1e+300"});
  expect(
      [](auto& d) {
        set(d.spacing, {3, 3, 3});
      },
      {"spacing = (3, 3, 3)", "no lattice centre lies inside the mesh", "1 x 1 x 1", "expected a smaller spacing"});
}

TEST(MeshInterface, ArraysAreCheckedForCountsAndVertexNumbers) {
  Mesh mesh;
  const double xyz[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const double bad[9] = {0, 0, 0, 1, 0, 0, 0, kNan, 0};
  const int32_t corners[3] = {0, 1, 2}, beyond[3] = {0, 1, 3}, negative[3] = {0, -1, 2};
  const auto expect = [&](ogive_status status, const std::vector<std::string>& words) {
    EXPECT_EQ(status, OGIVE_ERROR_ARGUMENT);
    EXPECT_EQ(lacks(mesh.message(), words), "");
  };
  expect(ogive_mesh_set_facets(mesh.get(), 2, xyz, 1, corners), {"vertex_count = 2"});
  expect(ogive_mesh_set_facets(mesh.get(), int64_t{1} << 40, xyz, 1, corners), {"vertex_count = 1099511627776"});
  expect(ogive_mesh_set_facets(mesh.get(), 3, xyz, 0, corners), {"facet_count = 0"});
  expect(ogive_mesh_set_facets(mesh.get(), 3, xyz, -1, corners), {"facet_count = -1"});
  expect(ogive_mesh_set_facets(mesh.get(), 3, xyz, 1, beyond), {"facet 0", "vertex 3", "expected 0..2"});
  expect(ogive_mesh_set_facets(mesh.get(), 3, xyz, 1, negative), {"vertex -1"});
  expect(ogive_mesh_set_facets(mesh.get(), 3, bad, 1, corners), {"vertex 2", "coordinate y = nan"});
}

TEST(MeshInterface, CallsInTheWrongOrderAreStateErrors) {
  Mesh mesh;
  EXPECT_EQ(mesh.message(), "");
  EXPECT_EQ(mesh.report(), "");
  EXPECT_EQ(mesh.check(), OGIVE_ERROR_STATE);
  EXPECT_EQ(lacks(mesh.message(), {"the mesh is empty", "ogive_mesh_read"}), "");
  ogive_mesh_info info{};
  info.struct_size = sizeof info;
  EXPECT_EQ(ogive_mesh_info_get(mesh.get(), &info), OGIVE_ERROR_STATE);
  const ogive_voxelise_def def = lattice(0.5);
  int64_t count = 0;
  EXPECT_EQ(ogive_mesh_voxelise(mesh.get(), &def, &count, nullptr, nullptr), OGIVE_ERROR_STATE);
  ASSERT_EQ(mesh.set(box({0, 0, 0}, {1, 1, 1})), OGIVE_OK);
  EXPECT_EQ(ogive_mesh_voxelise(mesh.get(), &def, &count, nullptr, nullptr), OGIVE_ERROR_STATE);
  EXPECT_EQ(lacks(mesh.message(), {"call ogive_mesh_check before"}), "");
}

TEST(MeshInterface, ReportIsCutToTheCapacityAndEndsWithZero) {
  Mesh mesh(box({0, 0, 0}, {1, 1, 1}));
  const std::string report = mesh.report();
  char text[8];
  std::memset(text, 'x', sizeof text);
  size_t needed = 0;
  EXPECT_EQ(ogive_mesh_report(mesh.get(), text, 5, &needed), OGIVE_OK);
  EXPECT_EQ(needed, report.size() + 1);
  EXPECT_EQ(std::string(text), report.substr(0, 4));
  EXPECT_EQ(text[5], 'x');
}

TEST(MeshInterface, AnotherCountThanAskedForIsRefusedAndNothingIsWritten) {
  Mesh mesh(box({0, 0, 0}, {1, 1, 1}));
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  const ogive_voxelise_def def = lattice(0.5);
  int64_t count = 7;
  std::vector<double> xyz(24, -1), volume(8, -1);
  EXPECT_EQ(ogive_mesh_voxelise(mesh.get(), &def, &count, xyz.data(), volume.data()), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(lacks(mesh.message(), {"*count = 7: expected 8"}), "");
  EXPECT_EQ(xyz[0], -1);
  EXPECT_EQ(volume[0], -1);
  count = 8;
  EXPECT_EQ(ogive_mesh_voxelise(mesh.get(), &def, &count, xyz.data(), volume.data()), OGIVE_OK);
}

TEST(MeshInterface, ANewSurfaceReplacesTheOldOneAndItsFindings) {
  Mesh mesh(l_shape().inverted());
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  ASSERT_EQ(mesh.set(box({0, 0, 0}, {1, 1, 1})), OGIVE_OK);
  EXPECT_EQ(mesh.info().checked, 0);
  EXPECT_EQ(mesh.info().turned, 0);
  EXPECT_EQ(mesh.report().find("turned"), std::string::npos);
}

TEST(MeshInterface, DifferentMeshesMayBeUsedFromDifferentThreads) {
  std::vector<std::thread> threads;
  std::vector<size_t> counts(4, 0);
  for (size_t t = 0; t < counts.size(); ++t) {
    threads.emplace_back([&counts, t] {
      Mesh mesh(torus(3, 1, 40, 24));
      if (mesh.check() == OGIVE_OK) counts[t] = mesh.fill(lattice(0.2)).position.size();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (size_t count : counts) EXPECT_EQ(count, counts[0]);
  EXPECT_GT(counts[0], 1000u);
}

}  // namespace
}  // namespace geometry_test
