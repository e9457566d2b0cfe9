// Reading surfaces: the same solid from every kind of file, and files that lie, stop early or are something else.
#include <locale.h>

#include <limits>
#include <random>

#include "support.hpp"

namespace geometry_test {
namespace {

const Facets kBox = box({-1, -2, -0.5}, {1, 2, 0.25});  // volume 6
constexpr double kBoxVolume = 2 * 4 * 0.75;

void expect_box(const char* path, double scale = 1) {
  Mesh mesh;
  ASSERT_EQ(mesh.read(path, scale), OGIVE_OK) << mesh.message();
  ASSERT_EQ(mesh.check(), OGIVE_OK) << mesh.message();
  const ogive_mesh_info info = mesh.info();
  EXPECT_EQ(info.vertices, 8);
  EXPECT_EQ(info.facets, 12);
  EXPECT_EQ(info.shells, 1);
  EXPECT_NEAR(info.volume, kBoxVolume * std::pow(scale, 3), 1e-14 * kBoxVolume * std::pow(scale, 3));
  EXPECT_NEAR(info.area, 2 * (8 + 1.5 + 3) * scale * scale, 1e-13 * scale * scale);
  const double lower[] = {-1, -2, -0.5}, upper[] = {1, 2, 0.25};
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(info.lower[d], lower[d] * scale);
    EXPECT_EQ(info.upper[d], upper[d] * scale);
  }
}

void expect_refused(const std::string& bytes, ogive_status status, const std::vector<std::string>& words,
                    const std::string& name = "bad.stl") {
  const File file(name, bytes);
  Mesh mesh;
  EXPECT_EQ(mesh.read(file.path()), status) << mesh.message();
  EXPECT_EQ(lacks(mesh.message(), words), "");
  EXPECT_NE(mesh.message().find(file.path()), std::string::npos) << "names the file: " << mesh.message();
}

TEST(MeshRead, EveryKindOfFileGivesTheSameSolid) {
  expect_box(File("box.stl", binary_stl(kBox)).path());
  expect_box(File("box.stl", ascii_stl(kBox)).path());
  expect_box(File("box.off", off(kBox)).path());
}

TEST(MeshRead, ContentDecidesNotTheNameOfTheFile) {
  expect_box(File("box.dat", binary_stl(kBox)).path());
  expect_box(File("box.off", ascii_stl(kBox)).path());
  expect_box(File("box.stl", off(kBox)).path());
}

TEST(MeshRead, BinaryStlWhoseHeaderBeginsWithSolidIsBinary) {
  expect_box(File("box.stl", binary_stl(kBox, "solid box, exported in binary")).path());
}

TEST(MeshRead, ScaleMultipliesEveryLength) { expect_box(File("box.stl", binary_stl(kBox)).path(), 25.4); }

TEST(MeshRead, NumbersHaveAPointInAnyLocale) {
  const File file("box.stl", ascii_stl(kBox));
  const std::string before = setlocale(LC_ALL, nullptr);
  // Where none of these is installed the test shows nothing, and does no harm.
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE.utf8"}) {
    if (setlocale(LC_ALL, name)) break;
  }
  expect_box(file.path());
  setlocale(LC_ALL, before.c_str());
}

TEST(MeshRead, AsciiStlMayHaveCapitalsPlusSignsOddBlanksAndSeveralSolids) {
  std::string text = ascii_stl(kBox, "facet of a name with endsolid in it");
  for (char& c : text) {
    if (c != 'e' && c != 'n') c = static_cast<char>(std::toupper(c));
  }
  for (size_t at = 0; (at = text.find("VeRTeX 1", at)) != std::string::npos; ++at) text.replace(at, 8, "VeRTeX\t+1");
  for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\r\n");
  expect_box(File("box.stl", "\xEF\xBB\xBF \r\n" + text).path());

  Mesh mesh;
  const File two("two.stl", ascii_stl(kBox) + ascii_stl(kBox.moved({5, 0, 0})));
  ASSERT_EQ(mesh.read(two.path()), OGIVE_OK) << mesh.message();
  ASSERT_EQ(mesh.check(), OGIVE_OK) << mesh.message();
  EXPECT_EQ(mesh.info().shells, 2);
  EXPECT_NEAR(mesh.info().volume, 2 * kBoxVolume, 1e-13);
}

TEST(MeshRead, OffMayHaveCommentsColoursFlatPolygonsAndUnusedVertices) {
  const File file("box.off",
                  "# a box\n\nCOFF 9 6 12 # counts\n"
                  "-1 -2 -0.5 0 0 0 1\n1 -2 -0.5 1 0 0 1\n1 2 -0.5\n# half way\n-1 2 -0.5\n"
                  "-1 -2 0.25\n1 -2 0.25\n1 2 0.25\n-1 2 0.25\n7 7 7\n"
                  "4 3 2 1 0\n4 4 5 6 7 255 0 0\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  expect_box(file.path());
}

TEST(MeshRead, OffFacetThatCanBeCutInTwoWaysIsRefused) {
  const std::string head = "OFF\n4 1 0\n0 0 0\n1 0 0\n";
  expect_refused(head + "1 1 0.1\n0 1 0\n4 0 1 2 3\n", OGIVE_ERROR_FORMAT, {":7:", "not flat and convex"},
                 "twisted.off");
  expect_refused(head + "0.2 0.2 0\n0 1 0\n4 0 1 2 3\n", OGIVE_ERROR_FORMAT, {":7:", "not flat and convex"},
                 "dart.off");
}

TEST(MeshRead, MissingFileDirectoryAndUnreadableFileAreFileErrors) {
  Mesh mesh;
  EXPECT_EQ(mesh.read("/nonexistent/rod.stl"), OGIVE_ERROR_FILE);
  EXPECT_EQ(lacks(mesh.message(), {"/nonexistent/rod.stl", "there is no such file"}), "");
  EXPECT_EQ(mesh.read(testing::TempDir().c_str()), OGIVE_ERROR_FILE);
  EXPECT_EQ(lacks(mesh.message(), {"is not a file"}), "");
  EXPECT_EQ(mesh.read("/dev/zero"), OGIVE_ERROR_FILE);
  EXPECT_EQ(mesh.read(""), OGIVE_ERROR_FILE);
}

TEST(MeshRead, EmptyAndForeignFilesAreRefused) {
  expect_refused("", OGIVE_ERROR_FORMAT, {"the file is empty"});
  expect_refused("\x89PNG\r\n\x1a\n" + std::string(500, '\7'), OGIVE_ERROR_FORMAT, {"neither STL nor OFF"},
                 "picture.dat");
  expect_refused("title = \"a scene\"\n", OGIVE_ERROR_FORMAT, {"neither STL nor OFF"}, "scene.toml");
  expect_refused("title = \"a scene\"\n", OGIVE_ERROR_FORMAT, {"neither STL nor OFF"});
  expect_refused("OFF BINARY\n" + std::string(50, '\1'), OGIVE_ERROR_FORMAT, {"binary OFF"}, "b.off");
}

TEST(MeshRead, BinaryStlWithAFalseFacetCountIsRefused) {
  std::string bytes = binary_stl(kBox);
  expect_refused(bytes.substr(0, bytes.size() - 50), OGIVE_ERROR_FORMAT,
                 {"promises 12 facets", "684 bytes", "has 634"});
  expect_refused(bytes.substr(0, 60), OGIVE_ERROR_FORMAT, {"cut short: 60 bytes"});
  expect_refused(bytes + "x", OGIVE_ERROR_FORMAT, {"has 685"});
  const uint32_t most = std::numeric_limits<uint32_t>::max();
  std::memcpy(bytes.data() + 80, &most, sizeof most);
  expect_refused(bytes, OGIVE_ERROR_FORMAT, {"promises 4294967295 facets"});
  expect_refused(binary_stl({}), OGIVE_ERROR_FORMAT, {"holds no facets"});
}

TEST(MeshRead, OffWithFalseCountsIsRefusedBeforeMemoryIsTaken) {
  expect_refused("OFF\n999999999999 1 0\n", OGIVE_ERROR_FORMAT, {":2:", "promises 999999999999 vertices"}, "v.off");
  expect_refused("OFF\n3 999999999999 0\n0 0 0\n", OGIVE_ERROR_FORMAT, {":2:", "999999999999 facets"}, "f.off");
  expect_refused("OFF\n99999999999999999999 1 0\n", OGIVE_ERROR_FORMAT, {"whole number"}, "o.off");
  expect_refused("OFF\n-3 1 0\n", OGIVE_ERROR_FORMAT, {"\"-3\"", "whole number >= 0"}, "n.off");
  const std::string head = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  expect_refused(head + "900000000 0 1 2\n", OGIVE_ERROR_FORMAT, {":6:", "the vertex number is missing"}, "c.off");
  expect_refused(head + "3 0 1 3\n", OGIVE_ERROR_FORMAT, {":6:", "the vertex number is 3", "expected 0..2"}, "i.off");
  expect_refused(head + "2 0 1     \n", OGIVE_ERROR_FORMAT, {":6:", "2 corners"}, "two.off");
  expect_refused(head, OGIVE_ERROR_FORMAT, {"the file ends", "facet 0 of 1"}, "short.off");
  expect_refused(head + "3 0 1 2\n3 0 2 1\n", OGIVE_ERROR_FORMAT, {":7:", "after the last facet"}, "long.off");
  expect_refused("OFF\n0 0 0\n", OGIVE_ERROR_FORMAT, {"holds no facets"}, "none.off");
}

TEST(MeshRead, AsciiStlErrorsNameTheLine) {
  const std::string text = ascii_stl(kBox);
  expect_refused(text.substr(0, text.find("endsolid")), OGIVE_ERROR_FORMAT,
                 {"the file ends after 12 facets inside a solid"});
  expect_refused(text.substr(0, text.find("vertex")), OGIVE_ERROR_FORMAT,
                 {":4:", "the file ends: expected \"vertex\""});
  std::string bad = text;
  bad.replace(bad.find("vertex -1"), 9, "vertex zz");
  expect_refused(bad, OGIVE_ERROR_FORMAT, {":4:", "\"zz\"", "expected a number"});
  bad = text;
  bad.replace(bad.find("vertex -1"), 9, "vertex 1,5");
  expect_refused(bad, OGIVE_ERROR_FORMAT, {":4:", "\"1,5\"", "expected a number"});
  bad = text;
  bad.replace(bad.find("vertex -1"), 9, "vertex 1e999");
  expect_refused(bad, OGIVE_ERROR_FORMAT, {":4:", "\"1e999\"", "beyond double precision"});
  bad = text;
  bad.replace(bad.find("endloop"), 7, "vertex 1 2 3 endloop");
  expect_refused(bad, OGIVE_ERROR_FORMAT, {":7:", "\"vertex\"", "expected \"endloop\""});
  expect_refused("solid nothing\nendsolid\n", OGIVE_ERROR_FORMAT, {"holds no facets"});
}

TEST(MeshRead, CoordinatesThatAreNoNumbersAreRefusedWithTheirPlace) {
  Facets bad = kBox;
  bad.vertices[3][1] = std::numeric_limits<double>::quiet_NaN();
  expect_refused(binary_stl(bad), OGIVE_ERROR_FORMAT, {"facet 0, corner 2", "coordinate y = nan"});
  bad.vertices[3][1] = std::numeric_limits<double>::infinity();
  expect_refused(binary_stl(bad), OGIVE_ERROR_FORMAT, {"facet 0, corner 2", "coordinate y = inf"});
  std::string text = ascii_stl(kBox);
  text.replace(text.find("vertex -1"), 9, "vertex nan");
  expect_refused(text, OGIVE_ERROR_FORMAT, {":4:", "coordinate x = nan"});
  expect_refused("OFF\n3 1 0\n0 0 0\n1 0 1e101\n0 1 0\n3 0 1 2\n", OGIVE_ERROR_FORMAT, {":4:", "z = 1e+101"},
                 "far.off");
}

TEST(MeshRead, AFailedReadLeavesTheMeshAsItWas) {
  Mesh mesh(kBox);
  ASSERT_EQ(mesh.check(), OGIVE_OK);
  const std::string report = mesh.report();
  EXPECT_EQ(mesh.read("/nonexistent/rod.stl"), OGIVE_ERROR_FILE);
  EXPECT_EQ(mesh.info().checked, 1);
  EXPECT_NEAR(mesh.info().volume, kBoxVolume, 1e-14);
  EXPECT_EQ(mesh.report(), report);
}

// Whatever is done to a file, the answer is a status: nothing crashes, hangs or takes memory without bound. (With the
// sanitizers this says more.)
TEST(MeshRead, DamagedFilesNeverDoMoreThanFail) {
  std::mt19937 random(20100501);
  const std::string originals[] = {binary_stl(kBox), ascii_stl(kBox), off(kBox)};
  const File file("damaged.stl", "");
  int read = 0, accepted = 0;
  for (const std::string& original : originals) {
    for (int round = 0; round < 400; ++round) {
      std::string bytes = original;
      if (round % 4 == 0) bytes.resize(random() % (bytes.size() + 1));
      for (int changes = static_cast<int>(random() % 4); changes > 0 && !bytes.empty(); --changes) {
        bytes[random() % bytes.size()] = static_cast<char>(random());
      }
      file.write(bytes);
      Mesh mesh;
      if (mesh.read(file.path()) != OGIVE_OK) continue;
      ++read;
      if (mesh.check() != OGIVE_OK) continue;
      ++accepted;
      mesh.fill(lattice(0.5));
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(accepted, 50);
  EXPECT_LT(accepted, read);
}

}  // namespace
}  // namespace geometry_test
