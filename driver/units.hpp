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
  std::string stress() const;
  /// Size in these units of a unit that is written as "m/s", "mJ", "kg m/s2", "%" or "-": what a value in these units is
  /// divided by to be one in that unit. On failure `problem` says why, otherwise it is empty.
  double size_of_unit(const std::string& unit, std::string& problem) const;

  bool operator==(const Units&) const = default;
};

const std::vector<std::string>& length_unit_names();
const std::vector<std::string>& time_unit_names();
const std::vector<std::string>& mass_unit_names();

}  // namespace driver
