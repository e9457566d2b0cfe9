// How fine the cells must be, and how long the steps may be, for a wanted error.
//
// The evidence is docs/data/resolution.csv, which tools/resolution_table.py writes from runs: of some scenes the error of a
// result, against the limit of fine cells or else the finest run, by the number of cells across the thinnest body. The envelope
// of a series is the largest error with as many cells or more; between two points it goes with a power of their number where the
// series has an order, else as at the coarser one. All series must be within the wanted error. docs/data/time_step_factor.csv
// has the same scenes with smaller and larger time steps.
#include "resolution.hpp"

#include <ogive.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include "filled_mesh.hpp"
#include "embedded.hpp"

namespace driver {
namespace {

struct Point {
  double cells, error;
};

/// The envelope of a series, from few cells to many.
struct Series {
  std::vector<Point> points;
  bool has_order = false;  // its error goes with a power of the cells, so that it is known between them
};

/// The rows of a table after its first line, each in its fields.
std::vector<std::vector<std::string>> rows_of(std::string_view table) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines{std::string(table)};
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream row(line);
    rows.emplace_back();
    for (std::string field; std::getline(row, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

const std::vector<Series>& envelopes() {
  static const std::vector<Series> all = [] {
    std::map<std::string, Series> series;
    for (const auto& fields : rows_of(resolution_data)) {  // scene,result,cells_across,cell,value,error,limit,...
      if (fields.size() < 7 || fields[5].empty()) continue;
      Series& of = series[fields[0] + ',' + fields[1]];
      of.points.push_back({std::stod(fields[2]), std::abs(std::stod(fields[5]))});
      of.has_order = !fields[6].empty();
    }
    std::vector<Series> result;
    for (auto& [name, of] : series) {
      std::vector<Point>& points = of.points;
      std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.cells < b.cells; });
      for (size_t i = points.size() - 1; i-- > 0;) points[i].error = std::max(points[i].error, points[i + 1].error);
      result.push_back(of);
    }
    return result;
  }();
  return all;
}

double smallest(const Vector3& v) { return std::min({v[0], v[1], v[2]}); }

/// Smallest of the extents along three directions at right angles, the first as given.
double smallest_extent(const std::vector<double>& points, const Vector3& axis) {
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  const Vector3 w{axis[0] / length, axis[1] / length, axis[2] / length};
  size_t least = 0;
  for (size_t c = 1; c < 3; ++c)
    if (std::abs(w[c]) < std::abs(w[least])) least = c;
  Vector3 u{};
  for (size_t c = 0; c < 3; ++c) u[c] = (c == least ? 1.0 : 0.0) - w[least] * w[c];
  const double norm = std::hypot(u[0], u[1], u[2]);
  for (double& c : u) c /= norm;
  const Vector3 v{w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]};
  double extent = std::numeric_limits<double>::infinity();
  for (const Vector3& direction : {u, v, w}) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (size_t i = 0; i + 2 < points.size(); i += 3) {
      const double at = points[i] * direction[0] + points[i + 1] * direction[1] + points[i + 2] * direction[2];
      low = std::min(low, at);
      high = std::max(high, at);
    }
    extent = std::min(extent, high - low);
  }
  return extent;
}

double smallest_measure(const BodyScene& body, const Scene& scene) {
  if (const auto* mesh = std::get_if<MeshShape>(&body.shape))
    return smallest_extent(mesh_vertices(*mesh, scene.place("bodies." + body.name + ".mesh")), mesh->axis);
  const auto* solid = std::get_if<SolidShape>(&body.shape);
  if (!solid) return std::numeric_limits<double>::infinity();  // particles of a file, which cannot be made finer anyway
  const Vector3& size = solid->size;
  switch (solid->solid) {
    case OGIVE_SOLID_BOX:
      return smallest(size);
    case OGIVE_SOLID_CYLINDER:  // radius, length, inner radius
      return std::min(size[2] > 0 ? size[0] - size[2] : 2 * size[0], size[1]);
    case OGIVE_SOLID_SPHERE:
      return 2 * size[0];
    default:  // ogive rod: radius, length
      return std::min(2 * size[0], size[1]);
  }
}

}  // namespace

std::vector<double> smallest_measures(const Scene& scene) {
  std::vector<double> measures;
  for (const BodyScene& body : scene.bodies) measures.push_back(smallest_measure(body, scene));
  return measures;
}

Thinnest thinnest_body(const Scene& scene, const std::vector<double>& measures) {
  const auto rigid = [](const BodyScene& body) {
    return body.formulation == OGIVE_FORMULATION_RIGID_FREE || body.formulation == OGIVE_FORMULATION_RIGID_PRESCRIBED;
  };
  const bool all_rigid = std::all_of(scene.bodies.begin(), scene.bodies.end(), rigid);
  Thinnest thinnest{"", std::numeric_limits<double>::infinity()};
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    if (rigid(scene.bodies[i]) && !all_rigid) continue;
    if (measures[i] < thinnest.measure || thinnest.body.empty()) thinnest = {scene.bodies[i].name, measures[i]};
  }
  return thinnest;
}

std::optional<double> cells_for(double error) {
  if (error < smallest_error()) return std::nullopt;
  double cells = 0;
  for (const auto& [points, has_order] : envelopes()) {
    double needed = points.front().cells;
    for (size_t i = 0; i + 1 < points.size(); ++i) {
      if (points[i].error <= error) break;
      const Point &a = points[i], &b = points[i + 1];
      needed = b.error > error || !has_order ? b.cells
                               : a.cells * std::pow(b.cells / a.cells, std::log(a.error / error) / std::log(a.error / b.error));
    }
    cells = std::max(cells, needed);
  }
  return cells;
}

std::optional<double> error_with(double cells) {
  double error = 0;
  for (const auto& [points, has_order] : envelopes()) {
    if (cells < points.front().cells) return std::nullopt;
    size_t i = 0;
    while (i + 1 < points.size() && points[i + 1].cells <= cells) ++i;
    const Point& a = points[i];
    double here = a.error;
    if (has_order && i + 1 < points.size() && a.error > points[i + 1].error)
      here *= std::pow(cells / a.cells, std::log(points[i + 1].error / a.error) / std::log(points[i + 1].cells / a.cells));
    error = std::max(error, here);
  }
  return error;
}

TimeStepChoice time_step_for(double error, double cells) {
  // By scene and result, the changes that factors make, with the finest of the cells looked at that are not finer than these.
  struct Changes {
    double cells = 0;
    std::map<double, double> by_factor;
  };
  std::map<std::string, Changes> all;
  for (const auto& fields : rows_of(factor_data)) {  // scene,result,cells_across,cell,factor,value,change,seconds
    const double across = std::stod(fields[2]);
    Changes& of = all[fields[0] + ',' + fields[1]];
    const bool finer = across > of.cells && across <= cells;
    if (!of.by_factor.empty() && across != of.cells && !finer) continue;
    if (across != of.cells) of.by_factor.clear();
    of.cells = across;
    of.by_factor[std::stod(fields[4])] = std::abs(std::stod(fields[6]));
  }
  std::map<double, double> largest;
  for (const auto& [name, of] : all)
    for (const auto& [factor, change] : of.by_factor) largest[factor] = std::max(largest[factor], change);
  TimeStepChoice choice{largest.begin()->first, largest.begin()->second};
  for (const auto& [factor, change] : largest)
    if (factor <= largest_stable_factor && change <= error) choice = {factor, change};
  return choice;
}

double smallest_error() {
  double error = 0;
  for (const Series& series : envelopes()) error = std::max(error, series.points.back().error);
  return error;
}

}  // namespace driver
