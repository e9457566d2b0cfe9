// Units of a scene: names for labels.
#include "units.hpp"

#include <algorithm>
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

std::string Units::stress() const {
  const double length_size = size_of(kLengths, length), time_size = size_of(kTimes, time);
  const double size = size_of(kMasses, mass) / (length_size * time_size * time_size);
  return name_of({{"Pa", 1.0}, {"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}}, size, mass + '/' + length + ' ' + time + '2');
}

double Units::size_of_unit(const std::string& unit, std::string& problem) const {
  problem.clear();
  if (unit == "-") return 1.0;
  if (unit == "%") return 0.01;
  // Base units of these units, in SI, and named units as products of powers of length, time and mass.
  const double own_length = size_of(kLengths, length), own_time = size_of(kTimes, time),
               own_mass = size_of(kMasses, mass);
  const double own_energy = own_mass * own_length * own_length / (own_time * own_time);
  Table sizes;
  for (const auto& [name, size] : kLengths) sizes.emplace_back(name, size / own_length);
  for (const auto& [name, size] : kTimes) sizes.emplace_back(name, size / own_time);
  for (const auto& [name, size] : kMasses) sizes.emplace_back(name, size / own_mass);
  for (const auto& [prefix, factor] : Table{{"u", 1e-6}, {"m", 1e-3}, {"", 1.0}, {"k", 1e3}, {"M", 1e6}, {"G", 1e9}}) {
    sizes.emplace_back(prefix + "J", factor / own_energy);
    sizes.emplace_back(prefix + "N", factor / (own_energy / own_length));
    sizes.emplace_back(prefix + "Pa", factor / (own_energy / (own_length * own_length * own_length)));
  }
  sizes.emplace_back("km", 1e3 / own_length);
  sizes.emplace_back("K", 1.0);

  // Names with an optional whole power, multiplied by a blank, divided by "/".
  double size = 1.0;
  bool divide = false, wanted = true;
  for (size_t at = 0; at < unit.size();) {
    if (unit[at] == ' ') {
      ++at;
      continue;
    }
    if (unit[at] == '/' && !wanted) {
      divide = wanted = true;
      ++at;
      continue;
    }
    const size_t end = std::min(unit.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ", at), unit.size());
    const std::string name = unit.substr(at, end - at);
    const auto found = std::find_if(sizes.begin(), sizes.end(), [&](const auto& known) { return known.first == name; });
    if (found == sizes.end()) {
      problem = "must be a unit such as m/s, mm, mJ, MPa, % or -, got \"" + unit + '"';
      return 1.0;
    }
    int power = 1;
    at = end;
    if (at < unit.size() && unit[at] >= '1' && unit[at] <= '9') power = unit[at++] - '0';
    size *= std::pow(found->second, divide ? -power : power);
    divide = wanted = false;
  }
  if (wanted) problem = "must be a unit such as m/s, mm, mJ, MPa, % or -, got \"" + unit + '"';
  return size;
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
