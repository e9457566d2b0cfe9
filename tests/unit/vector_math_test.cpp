// lib/simd: vector log, exp and pow against long double libm, for every instruction set that this CPU has.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "vector_math_kernels.hpp"

namespace {

using ogive::VectorFunction;
using ogive::VectorKernels;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr int widths[3] = {2, 4, 8};

std::vector<VectorKernels> kernels_of_this_cpu() {
  std::vector<VectorKernels> kernels = {ogive::x86_64::vector_kernels()};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    kernels.push_back(ogive::x86_64_v3::vector_kernels());
  }
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    kernels.push_back(ogive::x86_64_v4::vector_kernels());
  }
  return kernels;
}

class VectorMath : public testing::Test {
 protected:
  std::vector<double> apply(const VectorKernels& kernels, int width_index, VectorFunction which, std::vector<double> x,
                            std::vector<double> y = {}) {
    const std::size_t count = x.size();
    x.resize((count + 7) / 8 * 8, 1.0);
    y.resize(x.size(), 1.0);
    std::vector<double> out(x.size());
    kernels.apply[width_index](which, x.data(), y.data(), out.data(), static_cast<long>(x.size()));
    out.resize(count);
    return out;
  }

  double apply_one(const VectorKernels& kernels, VectorFunction which, double x, double y = 1.0) {
    return apply(kernels, 1, which, {x}, {y})[0];
  }

  std::vector<double> uniform(double lower, double upper, int count = 1 << 20) {
    std::vector<double> values(count);
    for (double& value : values) value = std::uniform_real_distribution<double>(lower, upper)(random_);
    return values;
  }

  // exp of uniform numbers: every order of magnitude alike.
  std::vector<double> magnitudes(double lower, double upper, int count = 1 << 20) {
    std::vector<double> values = uniform(std::log(lower), std::log(upper), count);
    for (double& value : values) value = std::exp(value);
    return values;
  }

  // Largest relative error over all instruction sets; printed, so that the figures beside the tolerances can be kept.
  template <class Exact>
  double largest_error(const char* what, VectorFunction which, const std::vector<double>& x,
                       const std::vector<double>& y, Exact exact) {
    std::vector<long double> reference(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) reference[i] = exact(x[i], y.empty() ? 1.0L : y[i]);
    double largest = 0.0;
    for (const VectorKernels& kernels : kernels_) {
      double worst = 0.0;
      const std::vector<double> result = apply(kernels, 1, which, x, y);
      for (std::size_t i = 0; i < x.size(); ++i) {
        const long double error = std::fabs(result[i] - reference[i]);
        if (error == 0.0L) continue;
        worst = std::fmax(worst, static_cast<double>(error / std::fabs(reference[i])));
      }
      std::printf("  %s, %s: largest relative error %.2e\n", what, kernels.name, worst);
      largest = std::fmax(largest, worst);
    }
    return largest;
  }

  const std::vector<VectorKernels> kernels_ = kernels_of_this_cpu();
  std::mt19937_64 random_{20100601};
};

long double exact_log(long double x, long double) { return std::log(x); }
long double exact_exp(long double x, long double) { return std::exp(x); }
long double exact_pow(long double x, long double y) { return std::pow(x, y); }

TEST_F(VectorMath, LogarithmIsAccurateToAnUlpOverAllNormalNumbers) {
  // An ulp is 1.1e-16 to 2.2e-16 of the number. Behind each tolerance: the largest error measured.
  EXPECT_LT(largest_error("log, all magnitudes", VectorFunction::Log, magnitudes(2.3e-308, 1.7e308), {}, exact_log),
            2.2e-16);  // 1.44e-16
  EXPECT_LT(largest_error("log, 0.01..10", VectorFunction::Log, uniform(0.01, 10.0), {}, exact_log),
            2.2e-16);  // 1.56e-16
}

TEST_F(VectorMath, LogarithmKeepsItsRelativeAccuracyNextToOne) {
  EXPECT_LT(largest_error("log, 0.7..1.42", VectorFunction::Log, uniform(0.7, 1.42), {}, exact_log),
            2.2e-16);  // 1.60e-16
  std::vector<double> near_one = magnitudes(1e-16, 1e-3);
  for (std::size_t i = 0; i < near_one.size(); ++i) near_one[i] = 1.0 + (i % 2 ? near_one[i] : -near_one[i]);
  EXPECT_LT(largest_error("log, 1 +- 1e-16..1e-3", VectorFunction::Log, near_one, {}, exact_log), 2.2e-16);  // 1.11e-16
  for (const VectorKernels& kernels : kernels_) EXPECT_EQ(apply_one(kernels, VectorFunction::Log, 1.0), 0.0);
}

TEST_F(VectorMath, LogarithmOfZeroAndDenormalsIsThatOfTheSmallestNormalNumber) {
  const double expected = std::log(std::numeric_limits<double>::min());
  for (const VectorKernels& kernels : kernels_) {
    for (const double x : {0.0, -0.0, 5e-324, 1e-310, -1.0, std::numeric_limits<double>::min()}) {
      EXPECT_DOUBLE_EQ(apply_one(kernels, VectorFunction::Log, x), expected) << kernels.name << " log " << x;
    }
  }
}

TEST_F(VectorMath, ExponentialIsAccurateToAnUlpOverItsWholeRange) {
  EXPECT_LT(largest_error("exp, -708..709.7", VectorFunction::Exp, uniform(-708.0, 709.7), {}, exact_exp),
            2.2e-16);                                                                                       // 1.64e-16
  EXPECT_LT(largest_error("exp, -1..1", VectorFunction::Exp, uniform(-1.0, 1.0), {}, exact_exp), 2.2e-16);  // 1.63e-16
  EXPECT_LT(largest_error("exp, -1e-9..1e-9", VectorFunction::Exp, uniform(-1e-9, 1e-9), {}, exact_exp),
            1.2e-16);  // 1.11e-16
}

TEST_F(VectorMath, ExponentialIsClampedToTheFiniteRangeAndUnderflowsToZero) {
  for (const VectorKernels& kernels : kernels_) {
    for (const double x : {-708.4, -745.0, -1e300, -infinity}) {
      EXPECT_EQ(apply_one(kernels, VectorFunction::Exp, x), 0.0) << kernels.name << " exp " << x;
    }
    const double largest = apply_one(kernels, VectorFunction::Exp, 709.78);
    EXPECT_NEAR(largest / std::exp(709.78), 1.0, 1e-15);
    for (const double x : {710.0, 1e300, infinity}) {
      EXPECT_EQ(apply_one(kernels, VectorFunction::Exp, x), largest) << kernels.name << " exp " << x;
    }
    EXPECT_EQ(apply_one(kernels, VectorFunction::Exp, 0.0), 1.0);
    EXPECT_EQ(apply_one(kernels, VectorFunction::Exp, -0.0), 1.0);
  }
}

TEST_F(VectorMath, PowerIsAccurateWhereHardeningAndSofteningTermsLie) {
  std::vector<double> x = magnitudes(1e-12, 1e6), y = uniform(0.1, 5.0);
  std::vector<double> kept_x, kept_y;  // results in 1e-3..1e3
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::fabs(y[i] * std::log(x[i])) > std::log(1e3)) continue;
    kept_x.push_back(x[i]);
    kept_y.push_back(y[i]);
  }
  ASSERT_GT(kept_x.size(), 200000u);
  EXPECT_LT(largest_error("pow, results 1e-3..1e3", VectorFunction::Pow, kept_x, kept_y, exact_pow), 2e-15);  // 9.4e-16
  EXPECT_LT(largest_error("pow, plastic strain to 0.41", VectorFunction::Pow, magnitudes(1e-12, 10.0),
                          std::vector<double>(1 << 20, 0.41), exact_pow),
            2e-15);  // 1.05e-15
  EXPECT_LT(largest_error("pow, homologous temperature to 0.859", VectorFunction::Pow, uniform(1e-6, 1.0),
                          std::vector<double>(1 << 20, 0.859), exact_pow),
            2e-15);  // 1.53e-15
}

TEST_F(VectorMath, PowerHasTheLimitsOfTheRealPower) {
  for (const VectorKernels& kernels : kernels_) {
    for (const double y : {1e-6, 0.41, 1.0, 2.5}) {
      EXPECT_EQ(apply_one(kernels, VectorFunction::Pow, 0.0, y), 0.0) << kernels.name << " 0^" << y;
      EXPECT_EQ(apply_one(kernels, VectorFunction::Pow, 1.0, y), 1.0) << kernels.name << " 1^" << y;
    }
    EXPECT_EQ(apply_one(kernels, VectorFunction::Pow, 0.0, 0.0), 1.0);
    EXPECT_EQ(apply_one(kernels, VectorFunction::Pow, 7.0, 0.0), 1.0);
    EXPECT_GT(apply_one(kernels, VectorFunction::Pow, 0.0, -1.0), 1e308);
    EXPECT_EQ(apply_one(kernels, VectorFunction::Pow, 1e-300, 2.0), 0.0);
    EXPECT_TRUE(std::isfinite(apply_one(kernels, VectorFunction::Pow, 1e300, 2.0)));
  }
}

TEST_F(VectorMath, NotANumberStaysVisible) {
  for (const VectorKernels& kernels : kernels_) {
    EXPECT_TRUE(std::isnan(apply_one(kernels, VectorFunction::Log, not_a_number))) << kernels.name;
    EXPECT_TRUE(std::isnan(apply_one(kernels, VectorFunction::Log, infinity))) << kernels.name;
    EXPECT_TRUE(std::isnan(apply_one(kernels, VectorFunction::Exp, not_a_number))) << kernels.name;
    EXPECT_TRUE(std::isnan(apply_one(kernels, VectorFunction::Pow, not_a_number, 0.5))) << kernels.name;
    EXPECT_TRUE(std::isnan(apply_one(kernels, VectorFunction::Pow, 0.5, not_a_number))) << kernels.name;
  }
}

TEST_F(VectorMath, ALanesResultDependsNeitherOnItsPlaceNorOnTheVectorsWidth) {
  const std::vector<double> x = magnitudes(1e-9, 1e3, 4099), y = uniform(-2.0, 3.0, 4099);
  for (const VectorKernels& kernels : kernels_) {
    for (const VectorFunction which : {VectorFunction::Log, VectorFunction::Exp, VectorFunction::Pow}) {
      const std::vector<double> expected = apply(kernels, 0, which, x, y);
      for (int width_index = 0; width_index < 3; ++width_index) {
        for (std::size_t shift = 0; shift < 8; ++shift) {
          const std::vector<double> result =
              apply(kernels, width_index, which, std::vector<double>(x.begin() + shift, x.end()),
                    std::vector<double>(y.begin() + shift, y.end()));
          EXPECT_EQ(std::memcmp(result.data(), expected.data() + shift, result.size() * sizeof(double)), 0)
              << kernels.name << ", " << widths[width_index] << " lanes, shifted by " << shift;
        }
      }
    }
  }
}

TEST_F(VectorMath, SquareRootRoundingAndChoicesAreThoseOfTheScalars) {
  const std::vector<double> x = uniform(-100.0, 100.0, 4096), y = uniform(-100.0, 100.0, 4096);
  for (const VectorKernels& kernels : kernels_) {
    for (int width_index = 0; width_index < 3; ++width_index) {
      const auto of = [&](VectorFunction which) { return apply(kernels, width_index, which, x, y); };
      const std::vector<double> absolute = of(VectorFunction::Abs), rounded = of(VectorFunction::Round);
      const std::vector<double> least = of(VectorFunction::Min), greatest = of(VectorFunction::Max);
      const std::vector<double> less = of(VectorFunction::SelectLess), any_all = of(VectorFunction::AnyAllLess);
      const std::vector<double> root = apply(kernels, width_index, VectorFunction::Sqrt, absolute);
      const int width = widths[width_index];
      for (int i = 0; i < 4096; ++i) {
        ASSERT_EQ(absolute[i], std::fabs(x[i]));
        ASSERT_EQ(root[i], std::sqrt(std::fabs(x[i])));
        ASSERT_EQ(rounded[i], std::nearbyint(x[i]));
        ASSERT_EQ(least[i], std::fmin(x[i], y[i]));
        ASSERT_EQ(greatest[i], std::fmax(x[i], y[i]));
        ASSERT_EQ(less[i], x[i] < y[i] ? 1.0 : 0.0);
        ASSERT_EQ(std::signbit(less[i]), !(x[i] < y[i])) << "broadcast keeps the sign of zero";
        int count = 0;
        for (int lane = i / width * width; lane < (i / width + 1) * width; ++lane) count += x[lane] < y[lane];
        ASSERT_EQ(any_all[i], (count > 0 ? 1.0 : 0.0) + (count == width ? 2.0 : 0.0));
      }
    }
    for (const double half : {0.5, 1.5, 2.5, -0.5, -1.5}) {
      EXPECT_EQ(apply_one(kernels, VectorFunction::Round, half), std::nearbyint(half)) << "halves go to even";
    }
  }
}

TEST_F(VectorMath, RecordsAreTransposedToComponentsAndBack) {
  double records[32], components[32], back[32];
  for (int i = 0; i < 32; ++i) records[i] = 100.0 * (i / 4) + i % 4;
  for (const VectorKernels& kernels : kernels_) {
    for (int width_index = 0; width_index < 3; ++width_index) {
      const int width = widths[width_index];
      kernels.transpose_records[width_index](records, components, back);
      for (int record = 0; record < width; ++record) {
        for (int component = 0; component < 4; ++component) {
          EXPECT_EQ(components[component * width + record], 100.0 * record + component) << kernels.name;
          EXPECT_EQ(back[record * 4 + component], 100.0 * record + component) << kernels.name;
        }
      }
    }
  }
}

}  // namespace
