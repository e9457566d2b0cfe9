// The HDF5 archive by itself: what goes in comes out, damage is found, and a failing write leaves the old file.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <thread>

#include "crc64.hpp"
#include "hdf5_archive.hpp"
#include "scratch.hpp"

namespace {

using namespace ogive::io;

// One of every type, one of no elements, two of two dimensions.
struct Content {
  std::vector<double> x = {0.0,
                           -0.0,
                           1.5,
                           std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::denorm_min()};
  std::vector<std::int32_t> cells = {-1, 0, std::numeric_limits<std::int32_t>::max()};
  std::vector<std::int64_t> steps = {std::numeric_limits<std::int64_t>::min(), 7};
  std::vector<std::uint8_t> flags = {0, 1, 255, 128, 3};
  std::vector<double> many;

  explicit Content(std::size_t size = 100) : many(size) { std::iota(many.begin(), many.end(), 0.25); }
};

void put_all(ArchiveWriter& writer, const Content& content) {
  writer.set_attribute("", "time", 0.125);
  writer.set_attribute("", "steps", std::int64_t{42});
  writer.set_attribute("state", "note", std::string("tab\there, 100 %, \xC3\xA9\n"));
  writer.put("state/x", ElementType::float64, {2, 3}, content.x.data());
  writer.put("state/cells", ElementType::int32, {3}, content.cells.data());
  writer.put("state/deep/er/steps", ElementType::int64, {2}, content.steps.data());
  writer.put("attachment/a%2Fb", ElementType::uint8, {5}, content.flags.data());
  writer.put("state/none", ElementType::float64, {0}, nullptr);
  writer.put("state/no_rows", ElementType::float64, {0, 3}, nullptr);
  writer.put("model/many", ElementType::float64, {content.many.size()}, content.many.data());
}

void write_archive(const std::string& path, const Content& content = Content(), Format format = kCheckpointFormat) {
  ArchiveWriter writer(path, format, "1.2.3");
  put_all(writer, content);
  writer.commit();
}

template <class T>
std::vector<T> read_array(const ArchiveReader& reader, const std::string& path) {
  const auto* array = reader.find(path);
  if (!array) throw std::runtime_error("no " + path);
  std::vector<T> values(array->count);
  EXPECT_EQ(array->bytes, values.size() * sizeof(T));
  reader.read(*array, values.data());
  return values;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expect_same(const ArchiveReader& reader, const Content& content) {
  EXPECT_TRUE(same_bits(read_array<double>(reader, "state/x"), content.x));
  EXPECT_EQ(read_array<std::int32_t>(reader, "state/cells"), content.cells);
  EXPECT_EQ(read_array<std::int64_t>(reader, "state/deep/er/steps"), content.steps);
  EXPECT_EQ(read_array<std::uint8_t>(reader, "attachment/a%2Fb"), content.flags);
  EXPECT_EQ(read_array<double>(reader, "state/none").size(), 0u);
  EXPECT_EQ(read_array<double>(reader, "model/many"), content.many);
}

// The reason why a file is refused, "" if it is not.
std::string refusal(const std::string& path, Fault* fault = nullptr) {
  try {
    ArchiveReader(path).require_undamaged();
    return "";
  } catch (const Failure& failure) {
    if (fault) *fault = failure.fault();
    return failure.what();
  }
}

// Makes every checksum of the header right again, as a foreign writer would.
void seal(std::string& bytes) {
  const auto put = [&](std::size_t at, std::uint64_t value) { std::memcpy(&bytes[at], &value, 8); };
  std::uint64_t offset, size;
  std::memcpy(&offset, &bytes[40], 8);
  std::memcpy(&size, &bytes[48], 8);
  put(24, bytes.size());
  put(32, crc64(&bytes[512], bytes.size() - 512));
  if (offset <= bytes.size() && size <= bytes.size() - offset) put(56, crc64(&bytes[offset], size));
  put(504, crc64(bytes.data(), 504));
}

std::string manifest_of(const std::string& bytes) {
  std::uint64_t offset, size;
  std::memcpy(&offset, &bytes[40], 8);
  std::memcpy(&size, &bytes[48], 8);
  return bytes.substr(offset, size);
}

TEST(Archive, GivesBackArraysOfEveryTypeBitForBit) {
  const scratch::Directory directory;
  const Content content;
  write_archive(directory / "a.h5", content);
  const ArchiveReader reader(directory / "a.h5");
  EXPECT_TRUE(reader.damage().empty());
  expect_same(reader, content);
  EXPECT_EQ(reader.format(), "ogive-checkpoint");
  EXPECT_EQ(reader.find("state/x")->shape, (std::vector<std::uint64_t>{2, 3}));
  EXPECT_EQ(reader.find("state/no_rows")->shape, (std::vector<std::uint64_t>{0, 3}));
  EXPECT_EQ(*reader.attribute<double>("", "time"), 0.125);
  EXPECT_EQ(*reader.attribute<std::int64_t>("", "steps"), 42);
  EXPECT_EQ(*reader.attribute<std::string>("", "library_version"), "1.2.3");
  EXPECT_EQ(*reader.attribute<std::string>("state", "note"), "tab\there, 100 %, \xC3\xA9\n");
  EXPECT_EQ(reader.find("state"), nullptr);
  EXPECT_EQ(reader.find("manifest"), nullptr);
  EXPECT_EQ(reader.attribute<double>("", "steps"), nullptr);
  EXPECT_EQ(directory.names(), std::vector<std::string>{"a.h5"});
}

TEST(Archive, HoldsAttributesThatAreNotFinite) {
  const scratch::Directory directory;
  ArchiveWriter writer(directory / "a.h5", kCheckpointFormat, "0");
  writer.set_attribute("", "nan", std::nan(""));
  writer.set_attribute("", "infinite", -std::numeric_limits<double>::infinity());
  writer.commit();
  const ArchiveReader reader(directory / "a.h5");
  EXPECT_TRUE(std::isnan(*reader.attribute<double>("", "nan")));
  EXPECT_EQ(*reader.attribute<double>("", "infinite"), -std::numeric_limits<double>::infinity());
}

TEST(Archive, IsReadByHdf5ItselfWithTheSameContentAndChecksums) {
  const scratch::Directory directory;
  const Content content;
  write_archive(directory / "a.h5", content);
  const hid_t file = H5Fopen((directory / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t dataset = H5Dopen2(file, "model/many", H5P_DEFAULT);
  std::vector<double> many(content.many.size());
  ASSERT_GE(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, many.data()), 0);
  EXPECT_EQ(many, content.many);
  std::uint64_t checksum = 0;
  const hid_t attribute = H5Aopen(dataset, "crc64", H5P_DEFAULT);
  ASSERT_GE(H5Aread(attribute, H5T_NATIVE_UINT64, &checksum), 0);
  EXPECT_EQ(checksum, crc64(many.data(), many.size() * sizeof(double)));
  H5Aclose(attribute);
  H5Dclose(dataset);

  const hid_t note_holder = H5Gopen2(file, "state", H5P_DEFAULT);
  const hid_t note = H5Aopen(note_holder, "note", H5P_DEFAULT);
  const hid_t type = H5Aget_type(note);
  std::vector<char> text(H5Tget_size(type));
  ASSERT_GE(H5Aread(note, type, text.data()), 0);
  EXPECT_STREQ(text.data(), "tab\there, 100 %, \xC3\xA9\n");
  H5Tclose(type);
  H5Aclose(note);
  H5Gclose(note_holder);

  hsize_t userblock = 0;
  const hid_t creation = H5Fget_create_plist(file);
  H5Pget_userblock(creation, &userblock);
  EXPECT_EQ(userblock, 512u);
  H5Pclose(creation);
  H5Fclose(file);
}

TEST(Archive, OfEqualContentIsEqualByteForByte) {
  const scratch::Directory directory;
  write_archive(directory / "a.h5");
  write_archive(directory / "b.h5");
  EXPECT_EQ(scratch::content(directory / "a.h5"), scratch::content(directory / "b.h5"));
}

TEST(Archive, TakesHundredsOfArraysAndLargeOnes) {
  const scratch::Directory directory;
  const Content content(300'000);
  {
    ArchiveWriter writer(directory / "a.h5", kCheckpointFormat, "0");
    put_all(writer, content);
    for (int i = 0; i < 400; ++i) {
      const std::vector<std::int32_t> values(static_cast<std::size_t>(i % 50), i);
      writer.put("state/body" + std::to_string(i % 7) + "/array" + std::to_string(i), ElementType::int32,
                 {values.size()}, values.data());
    }
    writer.commit();
  }
  const ArchiveReader reader(directory / "a.h5");
  EXPECT_TRUE(reader.damage().empty());
  expect_same(reader, content);
  for (int i = 0; i < 400; ++i)
    EXPECT_EQ(read_array<std::int32_t>(reader, "state/body" + std::to_string(i % 7) + "/array" + std::to_string(i)),
              std::vector<std::int32_t>(static_cast<std::size_t>(i % 50), i));
}

TEST(Archive, RefusesNamesThatHdf5WouldTwist) {
  const scratch::Directory directory;
  ArchiveWriter writer(directory / "a.h5", kCheckpointFormat, "0");
  const double value = 1.0;
  const auto refused = [&](const std::string& name) {
    try {
      writer.put(name, ElementType::float64, {1}, &value);
    } catch (const Failure& failure) {
      return failure.fault() == Fault::argument;
    }
    return false;
  };
  writer.put("state/x", ElementType::float64, {1}, &value);
  for (const std::string name :
       {"", "/x", "x/", "a//b", "a/./b", ".", "a\nb", "a\tb", "manifest", "state/x", "state/x/y", "state"})
    EXPECT_TRUE(refused(name)) << name;
  EXPECT_FALSE(refused("state/\xC3\xA9 with space"));
  writer.commit();
  EXPECT_TRUE(ArchiveReader(directory / "a.h5").damage().empty());
}

TEST(Archive, RefusesShapesAndTypesThatCannotBe) {
  const scratch::Directory directory;
  ArchiveWriter writer(directory / "a.h5", kCheckpointFormat, "0");
  const double value = 1.0;
  EXPECT_THROW(writer.put("a", ElementType::float64, {}, &value), Failure);
  EXPECT_THROW(writer.put("b", ElementType::float64, {1, 1, 1, 1, 1}, &value), Failure);
  EXPECT_THROW(writer.put("c", ElementType::float64, {std::uint64_t{1} << 62}, &value), Failure);
  EXPECT_THROW(writer.put("d", static_cast<ElementType>(9), {1}, &value), Failure);
  EXPECT_THROW(writer.put("e", ElementType::float64, {1}, nullptr), Failure);
  EXPECT_THROW(writer.set_attribute("", "format", std::string("twice")), Failure);
  EXPECT_THROW(writer.set_attribute("", "", 1.0), Failure);
}

TEST(Archive, MakesAPathComponentOfAnyNameAndBack) {
  for (const std::string name : {"rod", "a/b", ".", "..", "", "%", "%2F", "100 %", "manifest", "tab\t", "\xC3\xA9"}) {
    const std::string component = path_component(name);
    EXPECT_EQ(component.find('/'), std::string::npos);
    EXPECT_FALSE(component.empty() || component == "." || component == "manifest") << name;
    EXPECT_EQ(name_of_component(component), name);
  }
}

TEST(Damage, IsFoundWhereverOneByteChanges) {
  const scratch::Directory directory;
  write_archive(directory / "a.h5");
  const std::string whole = scratch::content(directory / "a.h5");
  std::mt19937_64 random(1);
  const int descriptor = open((directory / "a.h5").c_str(), O_WRONLY);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    const char changed = static_cast<char>(whole[at] ^ (1 << (random() % 8)));
    ASSERT_EQ(pwrite(descriptor, &changed, 1, static_cast<off_t>(at)), 1);
    Fault fault{};
    EXPECT_NE(refusal(directory / "a.h5", &fault), "") << "byte " << at;
    EXPECT_EQ(fault, Fault::format) << "byte " << at;
    ASSERT_EQ(pwrite(descriptor, &whole[at], 1, static_cast<off_t>(at)), 1);
  }
  close(descriptor);
  EXPECT_EQ(refusal(directory / "a.h5"), "");
}

TEST(Damage, IsFoundInFilesCutOffAnywhereOrGrown) {
  const scratch::Directory directory;
  write_archive(directory / "a.h5");
  std::string whole = scratch::content(directory / "a.h5");
  for (std::size_t size = 0; size < whole.size(); size += size < 600 ? 1 : 97) {
    scratch::write(directory / "cut.h5", whole.substr(0, size));
    Fault fault{};
    EXPECT_NE(refusal(directory / "cut.h5", &fault), "") << size;
    EXPECT_EQ(fault, Fault::format) << size;
  }
  scratch::write(directory / "cut.h5", whole.substr(0, whole.size() / 2));
  EXPECT_NE(refusal(directory / "cut.h5").find("cut off"), std::string::npos);
  scratch::write(directory / "grown.h5", whole + "x");
  EXPECT_NE(refusal(directory / "grown.h5").find("appended"), std::string::npos);
}

TEST(Damage, NamesTheArraysItStruck) {
  const scratch::Directory directory;
  write_archive(directory / "a.h5");
  std::string bytes = scratch::content(directory / "a.h5");
  const ArchiveReader reader(directory / "a.h5");
  bytes[reader.find("model/many")->offset + 13] ^= 4;
  bytes[reader.find("state/cells")->offset] ^= 1;
  scratch::write(directory / "b.h5", bytes);
  const auto damage = ArchiveReader(directory / "b.h5").damage();
  ASSERT_EQ(damage.size(), 2u);
  EXPECT_NE(damage[0].find("'state/cells'"), std::string::npos) << damage[0];
  EXPECT_NE(damage[1].find("'model/many'"), std::string::npos) << damage[1];
  EXPECT_NE(refusal(directory / "b.h5").find("'state/cells'"), std::string::npos);
  std::vector<double> many(100);
  const ArchiveReader damaged(directory / "b.h5");
  EXPECT_THROW(damaged.read(*damaged.find("model/many"), many.data()), Failure);
}

TEST(Damage, BetweenTheArraysIsFoundToo) {
  const scratch::Directory directory;
  write_archive(directory / "a.h5");
  std::string bytes = scratch::content(directory / "a.h5");
  bytes[512 + 3] ^= 1;  // HDF5's superblock
  scratch::write(directory / "a.h5", bytes);
  EXPECT_NE(refusal(directory / "a.h5").find("HDF5 structure"), std::string::npos);
}

// Someone writes a hostile file with right checksums: it may be refused or not, but nothing may break.
TEST(Damage, UnderRightChecksumsIsSurvived) {
  const scratch::Directory directory;
  write_archive(directory / "a.h5");
  const std::string whole = scratch::content(directory / "a.h5");
  std::uint64_t offset, size;
  std::memcpy(&offset, &whole[40], 8);
  std::memcpy(&size, &whole[48], 8);
  std::mt19937_64 random(7);
  const std::string alphabet = "0123456789x\t\n/%-abcdef";
  int refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string bytes = whole;
    for (std::uint64_t changes = 1 + random() % 3; changes > 0; --changes) {
      const auto at = offset + random() % size;
      bytes[at] = random() % 2 ? alphabet[random() % alphabet.size()] : static_cast<char>(random());
    }
    if (round % 10 == 0) bytes[40 + random() % 16] = static_cast<char>(random());  // place or size of the manifest
    seal(bytes);
    scratch::write(directory / "b.h5", bytes);
    try {
      const ArchiveReader reader(directory / "b.h5");
      if (!reader.damage().empty()) ++refused;
      for (const auto& array : reader.arrays()) {
        ASSERT_LE(array.bytes, bytes.size());
        std::vector<char> values(array.bytes);
        try {
          reader.read(array, values.data());
        } catch (const Failure&) {
        }
      }
    } catch (const Failure&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(Damage, OfAManifestThatClaimsTooMuchIsRefusedBeforeMemoryIsTaken) {
  const scratch::Directory directory;
  write_archive(directory / "a.h5");
  std::string bytes = scratch::content(directory / "a.h5");
  const auto at = bytes.find("model/many\tfloat64\t100\t", 512);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at + 19, 3, "9e9");
  seal(bytes);
  scratch::write(directory / "b.h5", bytes);
  EXPECT_NE(refusal(directory / "b.h5").find("malformed"), std::string::npos);
  bytes.replace(at + 19, 3, "999");
  seal(bytes);
  scratch::write(directory / "b.h5", bytes);
  EXPECT_NE(refusal(directory / "b.h5"), "");
  EXPECT_NE(manifest_of(bytes).find("999"), std::string::npos);
}

TEST(Foreign, FilesAreRefusedWithWhatTheyAre) {
  const scratch::Directory directory;
  const auto reason = [&](const std::string& bytes) {
    scratch::write(directory / "f", bytes);
    return refusal(directory / "f");
  };
  EXPECT_EQ(reason(""), "is empty");
  EXPECT_EQ(reason("hello"), "is not an Ogive file");
  EXPECT_EQ(reason(std::string(5000, '\0')), "is not an Ogive file");

  const hid_t plain = H5Fcreate((directory / "plain.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(plain);
  EXPECT_NE(refusal(directory / "plain.h5").find("is an HDF5 file, but not"), std::string::npos);
  const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_userblock(creation, 512);
  H5Fclose(H5Fcreate((directory / "block.h5").c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT));
  H5Pclose(creation);
  EXPECT_NE(refusal(directory / "block.h5").find("HDF5 file that Ogive did not write"), std::string::npos);
}

TEST(Foreign, NewerVersionsAreRefusedByNumber) {
  const scratch::Directory directory;
  write_archive(directory / "a.h5", Content(), Format{"ogive-checkpoint", 2});
  EXPECT_NE(refusal(directory / "a.h5").find("ogive-checkpoint version 2, this library reads 1 to 1"),
            std::string::npos)
      << refusal(directory / "a.h5");
  write_archive(directory / "a.h5", Content(), Format{"ogive-other", 1});
  EXPECT_NE(refusal(directory / "a.h5").find("unknown format 'ogive-other'"), std::string::npos);
  write_archive(directory / "a.h5");
  std::string bytes = scratch::content(directory / "a.h5");
  bytes[16] = 9;
  seal(bytes);
  scratch::write(directory / "a.h5", bytes);
  EXPECT_NE(refusal(directory / "a.h5").find("header version 9"), std::string::npos);
}

TEST(Reading, OfWhatIsNoFileSaysSo) {
  const scratch::Directory directory;
  Fault fault{};
  EXPECT_NE(refusal(directory / "missing.h5", &fault).find("No such file"), std::string::npos);
  EXPECT_EQ(fault, Fault::file);
  EXPECT_EQ(refusal(directory.path(), &fault), "is a directory");
  EXPECT_EQ(fault, Fault::file);
  ASSERT_EQ(mkfifo((directory / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(refusal(directory / "pipe"), "is not a regular file");  // and does not wait for a writer
}

TEST(Writing, ReplacesTheOldFileOnlyAtTheCommit) {
  const scratch::Directory directory;
  const Content old_content(10), new_content(20);
  write_archive(directory / "a.h5", old_content);
  const std::string before = scratch::content(directory / "a.h5");
  {
    ArchiveWriter writer(directory / "a.h5", kCheckpointFormat, "0");
    put_all(writer, new_content);
    EXPECT_EQ(scratch::content(directory / "a.h5"), before);
    EXPECT_EQ(directory.names().size(), 2u);
    EXPECT_EQ(directory.names()[1], "a.h5.tmp-" + std::to_string(getpid()));
  }  // given up without a commit
  EXPECT_EQ(scratch::content(directory / "a.h5"), before);
  EXPECT_EQ(directory.names(), std::vector<std::string>{"a.h5"});
  write_archive(directory / "a.h5", new_content);
  expect_same(ArchiveReader(directory / "a.h5"), new_content);
}

TEST(Writing, GetsPastATemporaryThatAKilledProcessLeft) {
  const scratch::Directory directory;
  const std::string left = directory / ("a.h5.tmp-" + std::to_string(getpid()));
  scratch::write(left, "left over");
  write_archive(directory / "a.h5");
  EXPECT_EQ(refusal(directory / "a.h5"), "");
  EXPECT_EQ(scratch::content(left), "left over");
}

TEST(Writing, FollowsASymbolicLinkAndSparesDevicesAndDirectories) {
  const scratch::Directory directory;
  std::filesystem::create_directory(directory / "store");
  write_archive(directory / "store/real.h5", Content(3));
  std::filesystem::create_symlink("store/real.h5", directory / "link.h5");
  write_archive(directory / "link.h5", Content(5));
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link.h5"));
  expect_same(ArchiveReader(directory / "store/real.h5"), Content(5));
  EXPECT_THROW(write_archive("/dev/null"), Failure);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_THROW(write_archive(directory / "store"), Failure);
  try {
    write_archive(directory / "nowhere/a.h5");
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.fault(), Fault::file);
    EXPECT_NE(std::string(failure.what()).find("No such file or directory"), std::string::npos);
  }
}

// Runs `work` in a child process that may write files of at most `limit` bytes; returns its exit code.
template <class Work>
int in_child_with_file_limit(std::uint64_t limit, const Work& work) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);  // a hang is a failure
    signal(SIGXFSZ, SIG_IGN);
    const rlimit bound{limit, limit};
    setrlimit(RLIMIT_FSIZE, &bound);
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Writing, ThatRunsOutOfSpaceAnywhereLeavesTheOldFileWholeAndNoTemporary) {
  const scratch::Directory directory;
  write_archive(directory / "a.h5", Content(10));
  const std::string before = scratch::content(directory / "a.h5");
  write_archive(directory / "larger.h5", Content(40'000));
  const std::uint64_t size = std::filesystem::file_size(directory / "larger.h5");
  std::filesystem::remove(directory / "larger.h5");
  for (std::uint64_t limit : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{600}, std::uint64_t{3000},
                              std::uint64_t{50'000}, size / 2, size - 5000, size - 100, size - 1}) {
    const int code = in_child_with_file_limit(limit, [&] {
      const int error_output = open((directory / "stderr").c_str(), O_WRONLY | O_CREAT, 0600);
      dup2(error_output, 2);
      try {
        write_archive(directory / "a.h5", Content(40'000));
        return 1;
      } catch (const Failure& failure) {
        return failure.fault() == Fault::file && std::string(failure.what()) == "cannot write: File too large" ? 7 : 2;
      } catch (...) {
        return 3;
      }
    });
    EXPECT_EQ(code, 7) << limit;
    EXPECT_EQ(scratch::content(directory / "stderr"), "") << limit;
    EXPECT_EQ(directory.names(), (std::vector<std::string>{"a.h5", "stderr"})) << limit;
    EXPECT_EQ(scratch::content(directory / "a.h5"), before) << limit;
  }
  EXPECT_EQ(in_child_with_file_limit(size,
                                     [&] {
                                       write_archive(directory / "a.h5", Content(40'000));
                                       return 0;
                                     }),
            0);
  EXPECT_EQ(std::filesystem::file_size(directory / "a.h5"), size);
}

TEST(Writing, FromSeveralThreadsAtOnceKeepsFilesApart) {
  const scratch::Directory directory;
  const std::vector<std::string> files = {directory / "a.h5", directory / "b.h5", directory / "c.h5",
                                          directory / "d.h5"};
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < files.size(); ++i)
    threads.emplace_back([&, i] {
      for (int round = 0; round < 5; ++round) write_archive(files[i], Content(100 + i));
    });
  for (auto& thread : threads) thread.join();
  for (std::size_t i = 0; i < files.size(); ++i) expect_same(ArchiveReader(files[i]), Content(100 + i));
  EXPECT_EQ(directory.names().size(), 4u);
}

TEST(Writing, LeavesTheHostsOwnHdf5ErrorHandlingAsItWas) {
  const scratch::Directory directory;
  const auto handler = [](hid_t, void*) -> herr_t { return 0; };
  H5E_auto2_t before = nullptr;
  void* before_data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &before, &before_data);
  int marker = 0;
  H5Eset_auto2(H5E_DEFAULT, handler, &marker);
  write_archive(directory / "a.h5");
  H5E_auto2_t after = nullptr;
  void* after_data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &after, &after_data);
  EXPECT_EQ(after, static_cast<H5E_auto2_t>(handler));
  EXPECT_EQ(after_data, &marker);
  H5Eset_auto2(H5E_DEFAULT, before, before_data);
}

}  // namespace
