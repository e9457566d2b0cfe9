// The limit that a value tends to as cells shrink.
#include "study_fit.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace driver {
namespace {

constexpr double kLowestOrder = 0.3, kHighestOrder = 4.0;

struct Fit {
  double limit = 0, squares = 0;
};

/// f0 and C of f0 + C h^p by least squares.
Fit fit_with_order(const std::vector<double>& cell, const std::vector<double>& value, double order) {
  const auto n = static_cast<double>(cell.size());
  double mean_x = 0, mean_y = 0;
  for (size_t i = 0; i < cell.size(); ++i) {
    mean_x += std::pow(cell[i], order) / n;
    mean_y += value[i] / n;
  }
  double xx = 0, xy = 0, yy = 0;
  for (size_t i = 0; i < cell.size(); ++i) {
    const double x = std::pow(cell[i], order) - mean_x, y = value[i] - mean_y;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  return {mean_y - xy / xx * mean_x, yy - xy * xy / xx};
}

std::optional<Convergence> best_fit(const std::vector<double>& cell, const std::vector<double>& value) {
  // The sum of squares has one valley in p at most for data of this form; a fine scan finds it, thirds refine it.
  constexpr int kSteps = 200;
  const double step = (kHighestOrder - kLowestOrder) / kSteps;
  int best = 0;
  double least = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double squares = fit_with_order(cell, value, kLowestOrder + i * step).squares;
    if (i == 0 || squares < least) {
      least = squares;
      best = i;
    }
  }
  if (best == 0 || best == kSteps) return std::nullopt;  // the valley lies outside: no convergence that could be trusted
  double low = kLowestOrder + (best - 1) * step, high = kLowestOrder + (best + 1) * step;
  while (high - low > 1e-9) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (fit_with_order(cell, value, a).squares < fit_with_order(cell, value, b).squares) {
      high = b;
    } else {
      low = a;
    }
  }
  const double order = 0.5 * (low + high);
  return Convergence{fit_with_order(cell, value, order).limit, order, 0};
}

}  // namespace

std::optional<Convergence> convergence_of(const std::vector<double>& cell, const std::vector<double>& value) {
  if (cell.size() < 3 || std::set<double>(cell.begin(), cell.end()).size() != cell.size()) return std::nullopt;
  for (const double h : cell) {
    if (!(h > 0)) return std::nullopt;
  }
  const auto [smallest, largest] = std::minmax_element(value.begin(), value.end());
  if (*smallest == *largest) return Convergence{*smallest, 0, 0};
  std::optional<Convergence> whole = best_fit(cell, value);
  if (!whole) return std::nullopt;
  const size_t finest = static_cast<size_t>(std::min_element(cell.begin(), cell.end()) - cell.begin());
  whole->uncertainty = 1.25 * std::abs(value[finest] - whole->limit);
  for (size_t left_out = 0; cell.size() > 3 && left_out < cell.size(); ++left_out) {
    std::vector<double> fewer_cells = cell, fewer_values = value;
    fewer_cells.erase(fewer_cells.begin() + static_cast<std::ptrdiff_t>(left_out));
    fewer_values.erase(fewer_values.begin() + static_cast<std::ptrdiff_t>(left_out));
    if (const auto part = best_fit(fewer_cells, fewer_values)) {
      whole->uncertainty = std::max(whole->uncertainty, std::abs(part->limit - whole->limit));
    }
  }
  return whole;
}

std::optional<double> slope_of(const std::vector<double>& cell, const std::vector<double>& error) {
  if (cell.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(cell.size());
  double mean_x = 0, mean_y = 0;
  for (size_t i = 0; i < cell.size(); ++i) {
    if (!(cell[i] > 0) || error[i] == 0 || !std::isfinite(error[i])) return std::nullopt;
    mean_x += std::log(cell[i]) / n;
    mean_y += std::log(std::abs(error[i])) / n;
  }
  double xx = 0, xy = 0;
  for (size_t i = 0; i < cell.size(); ++i) {
    const double x = std::log(cell[i]) - mean_x;
    xx += x * x;
    xy += x * (std::log(std::abs(error[i])) - mean_y);
  }
  if (xx == 0) return std::nullopt;
  return xy / xx;
}

}  // namespace driver
