// Units of a scene: names for labels. The engine itself takes any consistent set.
#pragma once

#include <string>
#include <vector>

namespace driver {

struct Units {
  std::string length, time, mass;

  /// Labels of derived units; a combination that is a usual unit is called by its name ("mm/ms" is "m/s").
  std::string speed() const;
  std::string energy() const;

  bool operator==(const Units&) const = default;
};

const std::vector<std::string>& length_unit_names();
const std::vector<std::string>& time_unit_names();
const std::vector<std::string>& mass_unit_names();

}  // namespace driver
