// The limit that a value tends to as cells shrink: f(h) = f0 + C h^p, Richardson's extrapolation with an observed order.
#pragma once

#include <optional>
#include <vector>

namespace driver {

struct Convergence {
  double limit = 0;        // f0
  double order = 0;        // p
  double uncertainty = 0;  // of the limit
};

/// Three points or more of different h > 0, in any order; nullopt where they do not approach a limit with 0.3 <= p <= 4.
///
/// p minimises the sum of squares; for a given p, f0 and C follow linearly. Three points are met exactly. The uncertainty is 1.25
/// times the distance from the finest value to the limit (Roache's grid convergence index for an observed order), or, if
/// that is larger, the most that the limit moves when one of four or more points is left out.
std::optional<Convergence> convergence_of(const std::vector<double>& cell, const std::vector<double>& value);

/// Slope of log|error| over log h by least squares; nullopt for fewer than two points or an error of zero.
std::optional<double> slope_of(const std::vector<double>& cell, const std::vector<double>& error);

}  // namespace driver
