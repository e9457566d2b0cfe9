// Units of a scene: names for labels.
#include "units.hpp"

#include <cmath>
#include <utility>

namespace driver {
namespace {

using Table = std::vector<std::pair<std::string, double>>;

// Name and size in SI units.
const Table kLengths = {{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"in", 0.0254}, {"ft", 0.3048}};
const Table kTimes = {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}};
const Table kMasses = {{"kg", 1.0}, {"g", 1e-3}, {"mg", 1e-6}, {"t", 1e3}, {"lb", 0.45359237}};

double size_of(const Table& table, const std::string& name) {
  for (const auto& [known, size] : table) {
    if (known == name) return size;
  }
  return 1.0;
}

std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& [name, size] : table) names.push_back(name);
  return names;
}

/// Name of the unit that is `size` SI units large, `otherwise` if it has no name.
std::string name_of(const Table& table, double size, const std::string& otherwise) {
  for (const auto& [name, known_size] : table) {
    if (std::abs(size / known_size - 1.0) < 1e-9) return name;
  }
  return otherwise;
}

}  // namespace

std::string Units::speed() const {
  const double size = size_of(kLengths, length) / size_of(kTimes, time);
  return name_of({{"m/s", 1.0}, {"km/s", 1e3}, {"mm/s", 1e-3}, {"ft/s", 0.3048}}, size, length + '/' + time);
}

std::string Units::energy() const {
  const double speed_size = size_of(kLengths, length) / size_of(kTimes, time);
  const double size = size_of(kMasses, mass) * speed_size * speed_size;
  const Table named = {{"J", 1.0}, {"mJ", 1e-3}, {"uJ", 1e-6}, {"kJ", 1e3}, {"MJ", 1e6}, {"GJ", 1e9}};
  return name_of(named, size, mass + ' ' + length + "2/" + time + '2');
}

const std::vector<std::string>& length_unit_names() {
  static const std::vector<std::string> names = names_of(kLengths);
  return names;
}

const std::vector<std::string>& time_unit_names() {
  static const std::vector<std::string> names = names_of(kTimes);
  return names;
}

const std::vector<std::string>& mass_unit_names() {
  static const std::vector<std::string> names = names_of(kMasses);
  return names;
}

}  // namespace driver
