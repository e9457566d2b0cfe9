// Results do not depend on the number of threads, nor on an interruption.
#include <random>

#include "impact.hpp"
#include "store.hpp"

using namespace verification;

namespace {

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

INSTANTIATE_TEST_SUITE_P(Impact, Reproducibility, testing::Values(OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_SHAPE_GIMP),
                         [](const auto& info) { return shape_name(info.param); });
