// Results do not depend on the number of threads, nor on an interruption.
#include <random>

#include "impact.hpp"

using namespace verification;

namespace {

// Saves kept in memory.
struct Store {
  struct Array {
    std::int32_t type;
    std::int64_t count;
    std::vector<unsigned char> bytes;
  };
  std::map<std::string, Array> arrays;

  static std::size_t size_of(std::int32_t type) {
    return type == OGIVE_TYPE_UINT8 ? 1 : type == OGIVE_TYPE_INT32 ? 4 : 8;
  }
  static ogive_status put(void* user, const char* name, std::int32_t type, std::int64_t count, const void* data) {
    Array& array = static_cast<Store*>(user)->arrays[name];
    array = {type, count, {}};
    array.bytes.resize(static_cast<std::size_t>(count) * size_of(type));
    if (!array.bytes.empty()) std::memcpy(array.bytes.data(), data, array.bytes.size());
    return OGIVE_OK;
  }
  static ogive_status find(void* user, const char* name, std::int32_t* type, std::int64_t* count) {
    const auto& arrays = static_cast<Store*>(user)->arrays;
    const auto found = arrays.find(name);
    if (found == arrays.end()) return OGIVE_ERROR_FORMAT;
    *type = found->second.type;
    *count = found->second.count;
    return OGIVE_OK;
  }
  static ogive_status get(void* user, const char* name, std::int64_t count, void* data) {
    const Array& array = static_cast<Store*>(user)->arrays.at(name);
    if (array.count != count) return OGIVE_ERROR_FORMAT;
    if (!array.bytes.empty()) std::memcpy(data, array.bytes.data(), array.bytes.size());
    return OGIVE_OK;
  }

  void save(const Scene& scene) {
    ogive_writer writer{};
    writer.struct_size = sizeof writer;
    writer.user = this;
    writer.put = put;
    scene.check(ogive_world_save(scene.get(), &writer));
  }
  void load(Scene& scene) {
    ogive_reader reader{};
    reader.struct_size = sizeof reader;
    reader.user = this;
    reader.find = find;
    reader.get = get;
    scene.check(ogive_world_load(scene.get(), &reader));
  }
};

void expect_same_bits(const Scene& a, const Scene& b) {
  const auto fields_a = a.all_fields(), fields_b = b.all_fields();
  ASSERT_EQ(fields_a.size(), fields_b.size());
  for (const auto& [name, values] : fields_a) {
    const std::vector<double>& other = fields_b.at(name);
    ASSERT_EQ(values.size(), other.size()) << name;
    EXPECT_TRUE(same_bits(values.data(), other.data(), values.size() * sizeof(double))) << name;
  }
  const ogive_ledger ledger_a = a.ledger(), ledger_b = b.ledger();
  EXPECT_TRUE(same_bits(&ledger_a, &ledger_b, sizeof ledger_a)) << "ledger";
  for (std::int32_t body = 0; body < ogive_body_count(a.get()); ++body) {
    const ogive_body_result result_a = a.result({body}), result_b = b.result({body});
    EXPECT_TRUE(same_bits(&result_a, &result_b, sizeof result_a)) << "result of body " << body;
  }
  EXPECT_EQ(a.progress().steps, b.progress().steps);
  EXPECT_EQ(a.progress().time, b.progress().time);
  EXPECT_EQ(a.progress().particle_steps, b.progress().particle_steps);
}

class Reproducibility : public testing::TestWithParam<std::int32_t> {};

}  // namespace

TEST_P(Reproducibility, OneAndTwoThreadsGiveTheSameBits) {
  Impact impact{.shape = GetParam(), .half_y = true, .off_centre = 1.5};
  Scene one = impact.build();
  one.steps(150);
  EXPECT_GT(one.result({1}).failed_particles, 50);
  EXPECT_GT(one.result({1}).maximum_temperature, 310);
  impact.threads = 2;
  Scene two = impact.build();
  two.steps(150);
  expect_same_bits(one, two);
}

TEST_P(Reproducibility, AWorldSavedAtARandomStepAndLoadedGoesOnToTheSameBits) {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  const int total = 150, interruption = std::uniform_int_distribution<int>(1, total - 1)(random);
  SCOPED_TRACE("interrupted at step " + std::to_string(interruption));
  measured("interruption", interruption);
  const Impact impact{.shape = GetParam(), .half_y = true, .off_centre = 1.5};
  Scene straight = impact.build(), first = impact.build(), second;
  straight.steps(total);
  first.steps(interruption);
  Store store;
  store.save(first);
  store.load(second);
  expect_same_bits(first, second);
  second.steps(total - interruption);
  EXPECT_GT(second.result({1}).failed_particles, 50);
  expect_same_bits(straight, second);
  // And the save itself did not disturb the world that was saved.
  first.steps(total - interruption);
  expect_same_bits(straight, first);
}

INSTANTIATE_TEST_SUITE_P(Impact, Reproducibility, testing::Values(OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE),
                         [](const auto& info) { return info.param == OGIVE_SHAPE_LINEAR ? "Linear" : "BSpline"; });
