// Parts of threads and the order of neighbouring pencils.
#include "schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <numeric>
#include <random>
#include <vector>

namespace ogive {
namespace {

// Pencils at random places of a square, some far away, in order; and their particles.
std::vector<Schedule::Place> places(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Schedule::Place> all;
  for (std::int32_t z = -7; z < 9; ++z)
    for (std::int32_t y = -11; y < 12; ++y)
      if (random() % 4 != 0) all.push_back({z, y});
  all.push_back({500, -300});
  return all;
}

std::vector<std::int64_t> particles(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::int64_t> counts;
  for (std::size_t i = 0; i < n; ++i) counts.push_back(random() % 1000);
  return counts;
}

bool neighbours(const Schedule::Place& a, const Schedule::Place& b) {
  return std::abs(a[0] - b[0]) <= 1 && std::abs(a[1] - b[1]) <= 1;
}

TEST(Schedule, EveryPencilHasItsTurnOnceWhateverTheThreads) {
  const auto at = places(1);
  for (const int threads : {1, 2, 3, 7, 64}) {
    Schedule schedule;
    schedule.set_pencils(at);
    schedule.divide(threads, particles(at.size(), 2));
    for (int pass = 0; pass < 20; ++pass) {
      std::vector<std::atomic<int>> turns(at.size()), ordered(at.size());
      schedule.for_each([&](std::int32_t pencil) { ++turns[pencil]; });
      schedule.for_each_in_order([&](std::int32_t pencil) { ++ordered[pencil]; });
      for (std::size_t i = 0; i < at.size(); ++i) {
        ASSERT_EQ(turns[i], 1) << threads << " threads";
        ASSERT_EQ(ordered[i], 1) << threads << " threads";
      }
    }
  }
}

TEST(Schedule, NeighboursComeInTheSameOrderWhateverTheThreads) {
  const auto at = places(3);
  std::vector<std::vector<std::int32_t>> expected;
  for (const int threads : {1, 2, 3, 8}) {
    Schedule schedule;
    schedule.set_pencils(at);
    schedule.divide(threads, particles(at.size(), 4));
    for (int pass = 0; pass < 20; ++pass) {
      // As a node sees it: the pencils around each place, in the order in which they ended; no two of them at once.
      std::vector<std::vector<std::int32_t>> seen(at.size());
      std::vector<std::atomic<bool>> running(at.size());
      std::mutex mutex;
      schedule.for_each_in_order([&](std::int32_t pencil) {
        running[pencil] = true;
        for (std::size_t i = 0; i < at.size(); ++i) {
          const bool may_run = !neighbours(at[pencil], at[i]) || static_cast<std::int32_t>(i) == pencil;
          EXPECT_TRUE(may_run || !running[i]);
        }
        running[pencil] = false;
        const std::lock_guard lock(mutex);
        for (std::size_t i = 0; i < at.size(); ++i)
          if (neighbours(at[pencil], at[i])) seen[i].push_back(pencil);
      });
      // Pencils two rows apart share no node: only neighbours of each other are ordered.
      const auto position = [&](std::size_t i, std::int32_t pencil) {
        return std::find(seen[i].begin(), seen[i].end(), pencil) - seen[i].begin();
      };
      std::vector<std::vector<std::int32_t>> before(at.size());
      for (std::size_t i = 0; i < at.size(); ++i)
        for (const std::int32_t other : seen[i])
          if (position(i, other) < position(i, static_cast<std::int32_t>(i))) before[i].push_back(other);
      for (auto& list : before) std::sort(list.begin(), list.end());
      if (expected.empty()) expected = before;
      ASSERT_EQ(before, expected) << threads << " threads";
    }
  }
}

TEST(Schedule, PartsAreEvenToWithinAPencil) {
  const auto at = places(5);
  const auto weights = particles(at.size(), 6);
  const std::int64_t total = std::accumulate(weights.begin(), weights.end(), std::int64_t{0});
  const std::int64_t largest = *std::max_element(weights.begin(), weights.end());
  for (const int threads : {1, 2, 5, 16}) {
    Schedule schedule;
    schedule.set_pencils(at);
    schedule.divide(threads, weights);
    std::vector<std::int64_t> sums(static_cast<std::size_t>(threads), 0);
    for (std::size_t i = 0; i < at.size(); ++i) sums[static_cast<std::size_t>(schedule.part_of(at[i]))] += weights[i];
    EXPECT_EQ(std::accumulate(sums.begin(), sums.end(), std::int64_t{0}), total);
    for (const std::int64_t sum : sums)
      EXPECT_NEAR(static_cast<double>(sum), static_cast<double>(total) / threads, static_cast<double>(largest));
  }
}

TEST(Schedule, EveryPencilHasItsTurnWhereNoTeamIsToBeHad) {
  const auto at = places(7);
  std::atomic<int> turns{0}, ordered{0};
#pragma omp parallel num_threads(2)  // inside of which there are no others
  {
    Schedule schedule;
    schedule.set_pencils(at);
    schedule.divide(4, particles(at.size(), 8));
    schedule.for_each([&](std::int32_t) { ++turns; });
    schedule.for_each_in_order([&](std::int32_t) { ++ordered; });
  }
  EXPECT_EQ(turns, 2 * static_cast<int>(at.size()));
  EXPECT_EQ(ordered, 2 * static_cast<int>(at.size()));
}

TEST(Schedule, MoreThreadsThanPencilsAreNoMatter) {
  Schedule schedule;
  schedule.set_pencils({{0, 0}, {0, 1}});
  schedule.divide(9, {5, 0});
  std::atomic<int> turns{0};
  schedule.for_each_in_order([&](std::int32_t) { ++turns; });
  EXPECT_EQ(turns, 2);
  schedule.set_pencils({});
  schedule.divide(9, {});
  schedule.for_each_in_order([&](std::int32_t) { ++turns; });
  schedule.for_each([&](std::int32_t) { ++turns; });
  EXPECT_EQ(turns, 2);
}

}  // namespace
}  // namespace ogive
