// Saves kept in memory, and comparison of worlds bit by bit.
#pragma once

#include "scene.hpp"

namespace verification {

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

inline void expect_same_bits(const Scene& a, const Scene& b) {
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

// make(threads) is a scene: the same bits after `steps` with one thread, with two, and over a save after `saved` steps.
template <class Make>
void expect_same_bits_with_threads_and_over_a_restart(Make&& make, int steps, int saved) {
  Scene one = make(1), two = make(2), first = make(1), second;
  one.steps(steps);
  two.steps(steps);
  expect_same_bits(one, two);
  first.steps(saved);
  Store store;
  store.save(first);
  store.load(second);
  expect_same_bits(first, second);
  second.steps(steps - saved);
  expect_same_bits(one, second);
}

}  // namespace verification
