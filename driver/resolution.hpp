// How fine the cells must be and how long the steps may be for a wanted error, from what the studies measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene.hpp"

namespace driver {

/// The smallest measure of a body: of a plate its thickness, of a rod its diameter, of a tube its wall.
struct Thinnest {
  std::string body;
  double measure = 0;  // in the scene's unit of length
};

/// Of each body, in the scene's order; infinite where it is not known (particles of a file). Meshes are read.
std::vector<double> smallest_measures(const Scene& scene);

/// Among bodies that deform, or among all if none does.
Thinnest thinnest_body(const Scene& scene, const std::vector<double>& measures);

/// Cells across the thinnest body at which every study's error is at most `error` (0.03: 3 %); none if no study is so good.
std::optional<double> cells_for(double error);
/// The largest error of a study with so many cells; none if they are fewer than any study had.
std::optional<double> error_with(double cells);
/// Default settings are sure to be stable up to here (docs/stability.md): a lone particle fails from 0.58 on.
constexpr double largest_stable_factor = 0.5;

/// A time step factor, and the largest change of a study's result by it, against the smallest factor.
struct TimeStepChoice {
  double factor = 0, change = 0;
};
/// The largest factor that is stable and changes no result by more than `error` where there are so many cells.
TimeStepChoice time_step_for(double error, double cells);

/// The smallest error that cells_for knows an answer to.
double smallest_error();

}  // namespace driver
