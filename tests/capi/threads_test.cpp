// Several worlds on several threads at once: each comes to the bits that it comes to alone. Built with the thread sanitizer
// as well (tools/test.sh), which sees every access of the engine and its kernels.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

extern "C" {
#include "small_world.h"
}

namespace {

std::vector<double> run_world(double speed) {
  small_world small = build_small_world();
  EXPECT_EQ(ogive_world_prepare(small.world), OGIVE_OK);
  std::vector<double> velocity(3 * 64);
  EXPECT_EQ(ogive_field_get(small.world, small.left, "velocity", velocity.data(), 3 * 64), OGIVE_OK);
  for (std::size_t i = 0; i < velocity.size(); i += 3) velocity[i] = speed;
  EXPECT_EQ(ogive_field_set(small.world, small.left, "velocity", velocity.data(), 3 * 64), OGIVE_OK);
  EXPECT_EQ(ogive_world_advance(small.world, 0.003, 0, nullptr, nullptr), OGIVE_OK);
  EXPECT_EQ(ogive_world_step(small.world, 1), OGIVE_ERROR_ARGUMENT);  // messages are a world's own
  EXPECT_NE(std::string(ogive_world_message(small.world)).find("dt"), std::string::npos);
  EXPECT_EQ(ogive_field_get(small.world, small.left, "velocity", velocity.data(), 3 * 64), OGIVE_OK);
  ogive_world_destroy(small.world);
  return velocity;
}

TEST(Worlds, OnThreadsOfTheirOwnComeToTheSameBitsAsAlone) {
  constexpr int worlds = 6;
  std::vector<std::vector<double>> together(worlds);
  std::vector<std::thread> threads;
  for (int i = 0; i < worlds; ++i) threads.emplace_back([&, i] { together[i] = run_world(40 + 5 * i); });
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < worlds; ++i) EXPECT_EQ(together[i], run_world(40 + 5 * i)) << i;
}

// A world may be handed from one thread to the next between calls.
TEST(Worlds, MoveBetweenThreads) {
  small_world small = build_small_world();
  for (int i = 0; i < 4; ++i)
    std::thread([&] {
      if (i == 0) {
        EXPECT_EQ(ogive_world_prepare(small.world), OGIVE_OK);
      }
      EXPECT_EQ(ogive_world_advance(small.world, 0.001 * (i + 1), 0, nullptr, nullptr), OGIVE_OK);
    }).join();
  ogive_world_destroy(small.world);
}

}  // namespace
