// Limits of fine cells and units of measures, on values that are known.
#include <gtest/gtest.h>

#include <cmath>

#include "study_fit.hpp"
#include "units.hpp"

namespace {

using namespace driver;

TEST(Convergence, a_power_of_the_cell_gives_back_its_limit_and_order) {
  for (const double order : {0.7, 1.0, 1.5, 2.0, 3.0}) {
    for (const std::vector<double>& cells : {std::vector<double>{4, 2, 3}, std::vector<double>{4, 3, 2, 1.5, 1}}) {
      std::vector<double> values;
      for (const double h : cells) values.push_back(510 - 7 * std::pow(h, order));
      const auto found = convergence_of(cells, values);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->limit, 510, 1e-3) << order;
      EXPECT_NEAR(found->order, order, 1e-3);
      EXPECT_NEAR(found->uncertainty, 1.25 * 7 * std::pow(*std::min_element(cells.begin(), cells.end()), order), 2e-3);
    }
  }
}

TEST(Convergence, scatter_widens_the_uncertainty_beyond_the_true_limit) {
  const std::vector<double> cells = {4, 3, 2, 1.5, 1};
  std::vector<double> values;
  const std::vector<double> scatter = {1, -1, 1, -1, 1};
  for (size_t i = 0; i < cells.size(); ++i) values.push_back(510 - 7 * cells[i] * cells[i] + scatter[i]);
  const auto found = convergence_of(cells, values);
  ASSERT_TRUE(found);
  EXPECT_LT(std::abs(found->limit - 510), found->uncertainty);
}

TEST(Convergence, none_is_claimed_where_there_is_none) {
  EXPECT_FALSE(convergence_of({4, 2}, {1, 2}));               // two points fit any order
  EXPECT_FALSE(convergence_of({4, 2, 1}, {1, 2, 4}));         // differences grow
  EXPECT_FALSE(convergence_of({4, 2, 2}, {1, 2, 2}));
  EXPECT_FALSE(slope_of({4, 2}, {0.1, 0.0}));
  EXPECT_NEAR(*slope_of({4, 2, 1}, {-16, 4, -1}), 2.0, 1e-12);
}

TEST(Units, a_measures_unit_is_a_size_in_the_scenes_units) {
  const Units units{"mm", "ms", "g"};
  std::string problem;
  const auto size = [&](const char* unit) { return units.size_of_unit(unit, problem); };
  EXPECT_NEAR(size("m/s"), 1, 1e-12);
  EXPECT_NEAR(size("km/s"), 1000, 1e-9);
  EXPECT_NEAR(size("us"), 1e-3, 1e-15);
  EXPECT_NEAR(size("MPa"), 1, 1e-12);
  EXPECT_NEAR(size("J"), 1000, 1e-9);
  EXPECT_NEAR(size("N"), 1, 1e-12);
  EXPECT_NEAR(size("kg m2/s2"), 1000, 1e-9);
  EXPECT_NEAR(size("%"), 0.01, 0);
  EXPECT_EQ(problem, "");
  for (const char* wrong : {"", "furlong", "m/", "/s", "m//s"}) {
    size(wrong);
    EXPECT_NE(problem, "") << wrong;
  }
}

}  // namespace
