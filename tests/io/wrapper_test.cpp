// The file functions of ogive.h over a world without an engine: what they write, say and refuse.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <numeric>

#include "fake_world.hpp"
#include "scratch.hpp"

namespace {

std::vector<double> counting(std::size_t size, double first = 0.5) {
  std::vector<double> values(size);
  std::iota(values.begin(), values.end(), first);
  return values;
}

ogive_world world_with_arrays() {
  ogive_world world;
  world.arrays = {{"model/grid", counting(9)},
                  {"state/rod/position", counting(3000)},
                  {"state/cells", std::vector<std::int32_t>{1, -2, 3}},
                  {"state/steps", std::vector<std::int64_t>{1'000'000'000'000}},
                  {"state/none", std::vector<double>{}},
                  {"attachment/scene.toml", std::vector<std::uint8_t>{'a', '=', '1'}},
                  {"attachment/a/b", std::vector<std::uint8_t>{1}},
                  {"attachment/a", std::vector<std::uint8_t>{2}},
                  {"attachment/.", std::vector<std::uint8_t>{3}},
                  {"attachment/ \t\xC3\xA9%", std::vector<std::uint8_t>{4}}};
  for (const auto& [name, values] : world.arrays) world.wanted.push_back(name);
  return world;
}

ogive_world world_with_bodies() {
  ogive_world world;
  world.time = 0.0625;
  const auto body = [](const std::string& name, std::size_t particles) {
    return fake::Body{name,
                      static_cast<std::int64_t>(particles),
                      {{"position", 3, counting(3 * particles)},
                       {"stress", 6, counting(6 * particles, 100.0)},
                       {"deformation_gradient", 9, counting(9 * particles)},
                       {"mass", 1, counting(particles, 1.0)}}};
  };
  world.bodies = {body("rod", 5), body("plate <A&B>/\"1\"", 7), body("gone", 0), body("manifest", 2)};
  return world;
}

using TextFunction = ogive_status (*)(const char*, char*, size_t, size_t*);

std::string text_of(TextFunction function, const std::string& path, ogive_status expected) {
  size_t needed = 0;
  EXPECT_EQ(function(path.c_str(), nullptr, 0, &needed), expected);
  std::string text(needed, '?');
  EXPECT_EQ(function(path.c_str(), text.data(), text.size(), &needed), expected);
  EXPECT_EQ(needed, text.size());
  EXPECT_EQ(text.back(), '\0');
  text.pop_back();
  return text;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

int occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

TEST(Checkpoint, GivesBackEveryArrayUnderItsName) {
  const scratch::Directory directory;
  ogive_world world = world_with_arrays();
  ASSERT_EQ(ogive_checkpoint_write(&world, (directory / "c.h5").c_str()), OGIVE_OK) << world.message;
  EXPECT_EQ(world.message, "");
  ogive_world fresh;
  fresh.wanted = world.wanted;
  ASSERT_EQ(ogive_checkpoint_read(&fresh, (directory / "c.h5").c_str()), OGIVE_OK) << fresh.message;
  ASSERT_EQ(fresh.loaded.size(), world.arrays.size());
  for (const auto& [name, values] : world.arrays) EXPECT_EQ(fresh.loaded[name], values) << name;
  EXPECT_EQ(directory.names(), std::vector<std::string>{"c.h5"});
}

TEST(Checkpoint, MissingAnArrayIsRefusedByItsName) {
  const scratch::Directory directory;
  ogive_world world = world_with_arrays();
  ASSERT_EQ(ogive_checkpoint_write(&world, (directory / "c.h5").c_str()), OGIVE_OK);
  ogive_world fresh;
  fresh.wanted = {"model/grid", "state/absent"};
  EXPECT_EQ(ogive_checkpoint_read(&fresh, (directory / "c.h5").c_str()), OGIVE_ERROR_FORMAT);
  EXPECT_EQ(fresh.message, "checkpoint '" + directory / "c.h5" + "': has no array 'state/absent'");
}

TEST(Checkpoint, PassesOnWhatTheWorldRefused) {
  const scratch::Directory directory;
  ogive_world world = world_with_arrays();
  ASSERT_EQ(ogive_checkpoint_write(&world, (directory / "c.h5").c_str()), OGIVE_OK);
  ogive_world fresh;
  fresh.wanted = world.wanted;
  fresh.fail_load = OGIVE_ERROR_FORMAT;
  EXPECT_EQ(ogive_checkpoint_read(&fresh, (directory / "c.h5").c_str()), OGIVE_ERROR_FORMAT);
  EXPECT_EQ(fresh.message, "checkpoint '" + directory / "c.h5" + "': the model is not what it says");

  const std::string before = scratch::content(directory / "c.h5");
  world.fail_save = OGIVE_ERROR_MEMORY;
  EXPECT_EQ(ogive_checkpoint_write(&world, (directory / "c.h5").c_str()), OGIVE_ERROR_MEMORY);
  world.fail_save = OGIVE_OK;
  world.fail_progress = OGIVE_ERROR_STATE;
  EXPECT_EQ(ogive_checkpoint_write(&world, (directory / "c.h5").c_str()), OGIVE_ERROR_STATE);
  EXPECT_EQ(scratch::content(directory / "c.h5"), before);
  EXPECT_EQ(directory.names(), std::vector<std::string>{"c.h5"});
}

TEST(Checkpoint, OfADamagedFileIsNotLoadedAtAll) {
  const scratch::Directory directory;
  ogive_world world = world_with_arrays();
  const std::string path = directory / "c.h5";
  ASSERT_EQ(ogive_checkpoint_write(&world, path.c_str()), OGIVE_OK);
  const std::string whole = scratch::content(path);
  std::mt19937_64 random(3);
  for (int round = 0; round < 500; ++round) {
    std::string bytes = whole;
    const auto at = random() % bytes.size();
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
    if (round % 5 == 0) bytes.resize(at);
    scratch::write(path, bytes);
    ogive_world fresh;
    fresh.wanted = world.wanted;
    EXPECT_EQ(ogive_checkpoint_read(&fresh, path.c_str()), OGIVE_ERROR_FORMAT) << "byte " << at;
    EXPECT_TRUE(fresh.loaded.empty());
    EXPECT_TRUE(contains(fresh.message, "checkpoint '" + path + "': "));
    EXPECT_TRUE(contains(text_of(ogive_file_verify, path, OGIVE_ERROR_FORMAT), path + ": "));
  }
}

TEST(Checkpoint, ThatIsNoneIsRefused) {
  const scratch::Directory directory;
  ogive_world world = world_with_bodies();
  ASSERT_EQ(ogive_particles_write(&world, (directory / "p.h5").c_str()), OGIVE_OK);
  EXPECT_EQ(ogive_checkpoint_read(&world, (directory / "p.h5").c_str()), OGIVE_ERROR_FORMAT);
  EXPECT_TRUE(contains(world.message, "is not a checkpoint (its format is ogive-particles)"));
  EXPECT_EQ(ogive_checkpoint_read(&world, (directory / "missing.h5").c_str()), OGIVE_ERROR_FILE);
  EXPECT_EQ(world.message, "checkpoint '" + directory / "missing.h5" + "': cannot open: No such file or directory");
  EXPECT_EQ(ogive_checkpoint_write(&world, (directory / "nowhere/c.h5").c_str()), OGIVE_ERROR_FILE);
  EXPECT_TRUE(contains(world.message, "No such file or directory"));
  scratch::write(directory / "text", "not HDF5 at all");
  EXPECT_EQ(ogive_checkpoint_read(&world, (directory / "text").c_str()), OGIVE_ERROR_FORMAT);
  EXPECT_TRUE(contains(world.message, "is not an Ogive file"));
}

TEST(Checkpoint, ThatFindsNoSpaceSaysSoAndLeavesTheOldOne) {
  const scratch::Directory directory;
  ogive_world world = world_with_arrays();
  const std::string path = directory / "c.h5";
  ASSERT_EQ(ogive_checkpoint_write(&world, path.c_str()), OGIVE_OK);
  const std::string before = scratch::content(path);
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    signal(SIGXFSZ, SIG_IGN);
    const rlimit bound{10'000, 10'000};
    setrlimit(RLIMIT_FSIZE, &bound);
    const ogive_status status = ogive_checkpoint_write(&world, path.c_str());
    const bool told = world.message == "checkpoint '" + path + "': cannot write: File too large";
    _exit(status == OGIVE_ERROR_FILE && told ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(scratch::content(path), before);
  EXPECT_EQ(directory.names(), std::vector<std::string>{"c.h5"});
}

TEST(FileText, VerifyAndInfoTellWhatAFileIs) {
  const scratch::Directory directory;
  ogive_world world = world_with_arrays();
  const std::string path = directory / "c.h5";
  ASSERT_EQ(ogive_checkpoint_write(&world, path.c_str()), OGIVE_OK);
  const std::string verified = text_of(ogive_file_verify, path, OGIVE_OK);
  EXPECT_TRUE(contains(verified, path + ": undamaged, 10 arrays, ")) << verified;
  EXPECT_EQ(verified.back(), '\n');
  const std::string info = text_of(ogive_file_info, path, OGIVE_OK);
  EXPECT_TRUE(contains(info, path + ": Ogive checkpoint, format version 1, written by Ogive 9.8.7, ")) << info;
  EXPECT_TRUE(contains(info, "time 0.5, step 12, 0 particles\n")) << info;
  EXPECT_TRUE(contains(info, "  state/rod/position  float64 3000\n")) << info;
  EXPECT_TRUE(contains(info, "  and 9 of fewer than 16 elements\n")) << info;

  ogive_world bodies = world_with_bodies();
  ASSERT_EQ(ogive_particles_write(&bodies, (directory / "p.h5").c_str()), OGIVE_OK);
  const std::string particles = text_of(ogive_file_info, directory / "p.h5", OGIVE_OK);
  EXPECT_TRUE(contains(particles, "Ogive particle file")) << particles;
  EXPECT_TRUE(contains(particles, "time 0.0625, step 12, 14 particles\n")) << particles;
  EXPECT_TRUE(contains(particles, "body rod: 5 particles\n")) << particles;
  EXPECT_TRUE(contains(particles, "body plate <A&B>/\"1\": 7 particles\n")) << particles;
  EXPECT_TRUE(contains(particles, "  rod/stress  float64 5 x 6\n")) << particles;
  EXPECT_TRUE(contains(text_of(ogive_file_verify, directory / "p.h5", OGIVE_OK), "undamaged, 20 arrays"));
}

TEST(FileText, NamesEachDamagedArrayOnALineOfItsOwn) {
  const scratch::Directory directory;
  ogive_world world;
  world.arrays = {{"state/a", std::vector<std::uint8_t>(64, 'A')}, {"state/b", std::vector<std::uint8_t>(64, 'B')}};
  const std::string path = directory / "c.h5";
  ASSERT_EQ(ogive_checkpoint_write(&world, path.c_str()), OGIVE_OK);
  std::string bytes = scratch::content(path);
  bytes[bytes.find(std::string(64, 'A')) + 5] = 'x';
  bytes[bytes.find(std::string(64, 'B')) + 5] = 'x';
  scratch::write(path, bytes);
  EXPECT_EQ(text_of(ogive_file_verify, path, OGIVE_ERROR_FORMAT),
            path + ": array 'state/a' is damaged (its checksum is wrong)\n" + path +
                ": array 'state/b' is damaged (its checksum is wrong)\n");
  EXPECT_TRUE(contains(text_of(ogive_file_verify, directory / "none", OGIVE_ERROR_FILE), "No such file"));
  EXPECT_TRUE(contains(text_of(ogive_file_info, directory / "none", OGIVE_ERROR_FILE), "No such file"));
}

TEST(FileText, IsCutToTheRoomThatThereIs) {
  const scratch::Directory directory;
  ogive_world world = world_with_arrays();
  const std::string path = directory / "c.h5";
  ASSERT_EQ(ogive_checkpoint_write(&world, path.c_str()), OGIVE_OK);
  const std::string whole = text_of(ogive_file_info, path, OGIVE_OK);
  std::string room(20, '#');
  size_t needed = 0;
  EXPECT_EQ(ogive_file_info(path.c_str(), room.data(), 11, &needed), OGIVE_OK);
  EXPECT_EQ(needed, whole.size() + 1);
  EXPECT_EQ(room, whole.substr(0, 10) + '\0' + std::string(9, '#'));
  EXPECT_EQ(ogive_file_info(path.c_str(), room.data(), room.size(), nullptr), OGIVE_OK);
}

TEST(Particles, AreGroupsOfBodiesThatHdf5Reads) {
  const scratch::Directory directory;
  ogive_world world = world_with_bodies();
  ASSERT_EQ(ogive_particles_write(&world, (directory / "p.h5").c_str()), OGIVE_OK) << world.message;
  const hid_t file = H5Fopen((directory / "p.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const auto read = [&](const char* path, std::vector<hsize_t> expected_shape) {
    const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    std::vector<hsize_t> shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, shape.data(), nullptr);
    EXPECT_EQ(shape, expected_shape) << path;
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Sclose(space);
    H5Dclose(dataset);
    return values;
  };
  EXPECT_EQ(read("rod/position", {5, 3}), counting(15));
  EXPECT_EQ(read("rod/mass", {5}), counting(5, 1.0));
  // A fake stress of xx yy zz yz xz xy = 100, 101, 102, 103, 104, 105 ...: ParaView labels xx yy zz xy yz xz.
  const auto stress = read("plate <A&B>%2F\"1\"/stress", {7, 6});
  EXPECT_EQ(std::vector<double>(stress.begin() + 6, stress.begin() + 12),
            (std::vector<double>{106, 107, 108, 111, 109, 110}));
  EXPECT_EQ(read("rod/connectivity", {5}), counting(5, 0.0));
  EXPECT_EQ(read("gone/position", {0, 3}), std::vector<double>{});
  H5Fclose(file);
}

TEST(Particles, AreNotWrittenWhereAFieldFails) {
  const scratch::Directory directory;
  ogive_world world = world_with_bodies();
  world.fail_field = "mass";
  EXPECT_EQ(ogive_particles_write(&world, (directory / "p.h5").c_str()), OGIVE_ERROR_STATE);
  EXPECT_EQ(world.message, "no such field today");
  EXPECT_TRUE(directory.names().empty());
}

// Enough of an XML reader to know that tags close in order, values are quoted and every '&' begins an entity.
bool entity_at(const std::string& xml, std::size_t at) {
  for (const std::string entity : {"&amp;", "&lt;", "&gt;", "&quot;", "&apos;"})
    if (xml.compare(at, entity.size(), entity) == 0) return true;
  return false;
}

bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  std::size_t at = 0;
  while ((at = xml.find_first_of("<>&", at)) != std::string::npos) {
    if (xml[at] == '>') return false;
    if (xml[at] == '&') {
      if (!entity_at(xml, at++)) return false;
      continue;
    }
    auto end = at;  // the '>' that is in no quotes
    for (bool quoted = false; end < xml.size() && (quoted || xml[end] != '>'); ++end)
      if (xml[end] == '"') quoted = !quoted;
    if (end == xml.size()) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \n"));
    if (tag.find('<') != std::string::npos) return false;
    if (tag.front() == '/') {
      if (open.empty() || "/" + open.back() != tag) return false;
      open.pop_back();
    } else if (tag.front() != '?' && tag.back() != '/') {
      open.push_back(name);
    }
    for (auto inside = tag.find('&'); inside != std::string::npos; inside = tag.find('&', inside + 1))
      if (!entity_at(tag, inside)) return false;
    at = end + 1;
  }
  return open.empty();
}

TEST(Series, IsWellFormedWithTheTimesCountsAndFieldsOfTheFiles) {
  const scratch::Directory directory;
  ogive_world world = world_with_bodies();
  ASSERT_EQ(ogive_particles_write(&world, (directory / "p 0&.h5").c_str()), OGIVE_OK);
  world.time = 0.1;
  ASSERT_EQ(ogive_particles_write(&world, (directory / "p1.h5").c_str()), OGIVE_OK);
  const std::string absolute = directory / "p1.h5";
  const char* files[] = {"p 0&.h5", absolute.c_str()};
  ASSERT_EQ(ogive_series_write(&world, (directory / "s.xdmf").c_str(), 2, files), OGIVE_OK) << world.message;
  const std::string text = scratch::content(directory / "s.xdmf");
  EXPECT_TRUE(well_formed(text)) << text;
  EXPECT_EQ(occurrences(text, "<Time Value=\"0.0625\"/>"), 1);
  EXPECT_EQ(occurrences(text, "<Time Value=\"0.1\"/>"), 1);
  EXPECT_EQ(occurrences(text, "GridType=\"Uniform\""), 6);  // three bodies with particles, two instants
  EXPECT_EQ(occurrences(text, "NumberOfElements=\"5\""), 2);
  EXPECT_EQ(occurrences(text, "NumberType=\"Int\" Precision=\"4\" Dimensions=\"5\""), 2);
  EXPECT_EQ(occurrences(text, "<Grid Name=\"plate &lt;A&amp;B&gt;/&quot;1&quot;\""), 2);
  EXPECT_EQ(occurrences(text, ">p 0&amp;.h5:/rod/position</DataItem>"), 1);
  EXPECT_EQ(occurrences(text, ">" + absolute + ":/rod/position</DataItem>"), 1);
  EXPECT_EQ(occurrences(text, "Name=\"stress\" AttributeType=\"Matrix\""), 6);
  EXPECT_EQ(occurrences(text, "Name=\"deformation_gradient\" AttributeType=\"Tensor\""), 6);
  EXPECT_EQ(occurrences(text, "Dimensions=\"7 6\""), 2);
}

TEST(Series, OfWhatAreNoParticleFilesIsRefusedAndLeavesTheOldOne) {
  const scratch::Directory directory;
  ogive_world world = world_with_arrays();
  ASSERT_EQ(ogive_checkpoint_write(&world, (directory / "c.h5").c_str()), OGIVE_OK);
  scratch::write(directory / "s.xdmf", "old");
  const char* files[] = {"c.h5", nullptr};
  EXPECT_EQ(ogive_series_write(&world, (directory / "s.xdmf").c_str(), 1, files), OGIVE_ERROR_FORMAT);
  EXPECT_TRUE(contains(world.message, "particle file 'c.h5' is not a particle file")) << world.message;
  EXPECT_EQ(ogive_series_write(&world, (directory / "s.xdmf").c_str(), 2, files), OGIVE_ERROR_ARGUMENT);
  EXPECT_TRUE(contains(world.message, "files[1] is NULL")) << world.message;
  files[0] = "missing.h5";
  EXPECT_EQ(ogive_series_write(&world, (directory / "s.xdmf").c_str(), 1, files), OGIVE_ERROR_FILE);
  EXPECT_TRUE(contains(world.message, "'missing.h5' cannot open: No such file")) << world.message;
  EXPECT_EQ(scratch::content(directory / "s.xdmf"), "old");
}

TEST(NullArguments, AreRefusedByEveryFileFunction) {
  const scratch::Directory directory;
  const std::string path = directory / "x.h5";
  ogive_world world = world_with_arrays();
  const char* files[] = {"x.h5"};
  using WorldFunction = ogive_status (*)(ogive_world*, const char*);
  for (const WorldFunction function : {WorldFunction{ogive_checkpoint_write}, WorldFunction{ogive_checkpoint_read},
                                       WorldFunction{ogive_particles_write}}) {
    EXPECT_EQ(function(nullptr, path.c_str()), OGIVE_ERROR_ARGUMENT);
    EXPECT_EQ(function(nullptr, nullptr), OGIVE_ERROR_ARGUMENT);
    world.message.clear();
    EXPECT_EQ(function(&world, nullptr), OGIVE_ERROR_ARGUMENT);
    EXPECT_EQ(world.message, "path is NULL, expected a file name");
    EXPECT_EQ(function(&world, ""), OGIVE_ERROR_ARGUMENT);
    EXPECT_TRUE(contains(world.message, "path is empty"));
  }
  EXPECT_EQ(ogive_series_write(nullptr, path.c_str(), 1, files), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(ogive_series_write(&world, nullptr, 1, files), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(ogive_series_write(&world, path.c_str(), 1, nullptr), OGIVE_ERROR_ARGUMENT);
  EXPECT_EQ(ogive_series_write(&world, path.c_str(), 0, files), OGIVE_ERROR_ARGUMENT);
  EXPECT_TRUE(contains(world.message, "count is 0, expected at least 1"));
  EXPECT_EQ(ogive_series_write(&world, path.c_str(), -1, files), OGIVE_ERROR_ARGUMENT);

  char text[8] = "1234567";
  size_t needed = 99;
  for (const TextFunction function : {TextFunction{ogive_file_verify}, TextFunction{ogive_file_info}}) {
    EXPECT_EQ(function(nullptr, text, sizeof text, &needed), OGIVE_ERROR_ARGUMENT);
    EXPECT_STREQ(text, "");
    EXPECT_EQ(needed, 1u);
    EXPECT_EQ(function(nullptr, nullptr, 0, nullptr), OGIVE_ERROR_ARGUMENT);
    EXPECT_EQ(function(path.c_str(), nullptr, 10, &needed), OGIVE_ERROR_ARGUMENT);
    EXPECT_EQ(function(path.c_str(), nullptr, 0, nullptr), OGIVE_ERROR_FILE);
  }
  EXPECT_TRUE(directory.names().empty());
}

}  // namespace
