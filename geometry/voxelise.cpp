// Fills a closed surface with the centres of a lattice that lie inside. One line of the lattice at a time: each facet
// says, by exact predicates, which lines pass it and from which centre on they are beyond it; running along a line and
// adding up the facets passed gives inside or outside. So the work follows the number of lines and facets, not that of
// cells.
#include <algorithm>
#include <cmath>
#include <string>

#include "exact.hpp"
#include "mesh.hpp"

namespace ogive::geometry {
namespace {

constexpr double kMostCells = 1e11;  // in the bounding box; keeps a spacing in the wrong unit from running for days
constexpr double kFarthestCell = 1e9;

[[noreturn]] void refuse_argument(const std::string& message) { throw Refusal(OGIVE_ERROR_ARGUMENT, message); }

double length_of(const Vec3& a) { return std::hypot(a[0], a[1], a[2]); }

Vec3 vector_field(const double (&values)[3], const char* name) {
  const Vec3 v = {values[0], values[1], values[2]};
  for (int d = 0; d < 3; ++d) {
    if (!(std::abs(v[d]) <= kLargestCoordinate)) {
      refuse_argument(std::string(name) + "[" + std::to_string(d) + "] = " + text_of(v[d]) +
                      ": expected a number of magnitude up to 1e100");
    }
  }
  return v;
}

// Columns are where x, y and z go.
struct Rotation {
  Vec3 x, y, z;

  Vec3 apply(const Vec3& p) const {
    Vec3 r;
    for (int d = 0; d < 3; ++d) r[d] = p[0] * x[d] + p[1] * y[d] + p[2] * z[d];
    return r;
  }
  Vec3 apply_inverse(const Vec3& p) const {
    return {p[0] * x[0] + p[1] * x[1] + p[2] * x[2], p[0] * y[0] + p[1] * y[1] + p[2] * y[2],
            p[0] * z[0] + p[1] * z[1] + p[2] * z[2]};
  }
};

Vec3 direction_field(const double (&values)[3], const char* name) {
  Vec3 v = vector_field(values, name);
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (largest == 0) refuse_argument(std::string(name) + " = (0, 0, 0): expected a direction");
  for (double& x : v) x /= largest;  // before squaring, so that no length is too large or too small
  const double length = length_of(v);
  for (double& x : v) x /= length;
  return v;
}

Rotation rotation_of(const double (&axis_values)[3], const char* axis_name, const double (&reference_values)[3],
                     const char* reference_name) {
  const Vec3 z = direction_field(axis_values, axis_name);
  const Vec3 given = vector_field(reference_values, reference_name);
  if (given[0] == 0 && given[1] == 0 && given[2] == 0) {
    // Smallest rotation, about (-z_y, z_x, 0); k = (1 - cos) / sin^2 in the form that does not cancel.
    const double sine2 = z[0] * z[0] + z[1] * z[1];
    if (sine2 == 0)
      return z[2] > 0 ? Rotation{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}} : Rotation{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
    const double k = z[2] >= 0 ? 1 / (1 + z[2]) : (1 - z[2]) / sine2;
    return {{1 - k * z[0] * z[0], -k * z[0] * z[1], -z[0]}, {-k * z[0] * z[1], 1 - k * z[1] * z[1], -z[1]}, z};
  }
  Vec3 x = direction_field(reference_values, reference_name);
  const double along = x[0] * z[0] + x[1] * z[1] + x[2] * z[2];
  for (int d = 0; d < 3; ++d) x[d] -= along * z[d];
  const double normal_part = length_of(x);
  if (normal_part < 1e-6) {
    refuse_argument(std::string(reference_name) + " = " + text_of(given) + ": expected a direction not parallel to " +
                    axis_name + " = " + text_of(Vec3{axis_values[0], axis_values[1], axis_values[2]}));
  }
  for (double& c : x) c /= normal_part;
  return {x, {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]}, z};
}

// The centres along one lattice axis.
struct Axis {
  double origin, spacing;

  double centre(int64_t i) const { return origin + (static_cast<double>(i) + 0.5) * spacing; }
  // The first centre >= x.
  int64_t first_from(double x) const {
    auto i = static_cast<int64_t>(std::ceil((x - origin) / spacing - 0.5));
    while (centre(i - 1) >= x) --i;  // the rounding of the estimate
    while (centre(i) < x) ++i;
    return i;
  }
  // The first centre > x.
  int64_t first_beyond(double x) const {
    int64_t i = first_from(x);
    while (centre(i) <= x) ++i;
    return i;
  }
};

// What changes along a line: from centre k on, `step` is added for each of the `lines`. For the moved lines that is the
// facets passed, 1 entering and -1 leaving; for kOnBoundary the edges and corners on which the centre lies.
struct Crossing {
  int64_t line, k;
  int8_t step;
  uint8_t lines;
};

// Positions in lattice coordinates; `order` names the lattice axes that play x, y and z here. Lines run along the last.
class Filler {
 public:
  Filler(const std::vector<Vec3>& vertices, const std::vector<Corners>& facets, const std::array<Axis, 3>& axes,
         const std::array<int, 3>& order)
      : facets_(facets), order_(order), axis_{axes[order[0]], axes[order[1]], axes[order[2]]} {
    vertices_.reserve(vertices.size());
    Vec3 lower{}, upper{};
    for (const Vec3& p : vertices) {
      vertices_.push_back({p[order[0]], p[order[1]], p[order[2]]});
      if (vertices_.size() == 1) lower = upper = vertices_[0];
      for (int d = 0; d < 3; ++d) {
        lower[d] = std::min(lower[d], vertices_.back()[d]);
        upper[d] = std::max(upper[d], vertices_.back()[d]);
      }
    }
    first_i_ = axis_[0].first_from(lower[0]);
    first_j_ = axis_[1].first_from(lower[1]);
    lines_in_row_ = axis_[0].first_beyond(upper[0]) - first_i_;
  }

  // Calls take(centre in lattice coordinates) for each centre inside.
  template <class Take>
  void fill(Take take) {
    for (const Corners& f : facets_) cross(vertices_[f[0]], vertices_[f[1]], vertices_[f[2]]);
    // Crossings at one centre act together: their order does not matter.
    std::sort(crossings_.begin(), crossings_.end(),
              [](const Crossing& a, const Crossing& b) { return a.line != b.line ? a.line < b.line : a.k < b.k; });
    std::array<int, 3> sum{};
    for (size_t n = 0; n < crossings_.size(); ++n) {
      const Crossing& now = crossings_[n];
      bool inside = false;
      for (int q = 0; q < 3; ++q) {
        if (now.lines & (1u << q)) sum[q] += now.step;
        inside = inside || sum[q] > 0;
      }
      if (!inside || n + 1 == crossings_.size()) continue;  // after a line's last crossing every sum is 0
      Vec3 p;
      p[order_[0]] = axis_[0].centre(first_i_ + now.line % lines_in_row_);
      p[order_[1]] = axis_[1].centre(first_j_ + now.line / lines_in_row_);
      for (int64_t k = now.k; k < crossings_[n + 1].k; ++k) {
        p[order_[2]] = axis_[2].centre(k);
        take(p);
      }
    }
  }

 private:
  void cross(const Vec3& a, const Vec3& b, const Vec3& c) {
    const int turn = turn_seen_from_z(a, b, c);
    if (turn == 0) {
      // Parallel to the lines: the moved lines miss it, on both sides. That leaves its edges along the lines.
      mark_edge_along_lines(a, b);
      mark_edge_along_lines(b, c);
      mark_edge_along_lines(c, a);
      return;
    }
    const auto [left, right] = std::minmax({a[0], b[0], c[0]});
    const auto [near, far] = std::minmax({a[1], b[1], c[1]});
    const auto [low, high] = std::minmax({a[2], b[2], c[2]});
    const int64_t i_begin = axis_[0].first_from(left), i_end = axis_[0].first_beyond(right);
    const int64_t j_begin = axis_[1].first_from(near), j_end = axis_[1].first_beyond(far);
    const int64_t k_begin = axis_[2].first_from(low), k_end = axis_[2].first_beyond(high);
    for (int64_t j = j_begin; j < j_end; ++j) {
      for (int64_t i = i_begin; i < i_end; ++i) {
        Vec3 p = {axis_[0].centre(i), axis_[1].centre(j), 0};
        const unsigned passed = passes(a, b, c, turn, p[0], p[1]);
        if (passed == 0) continue;
        const auto height = [&](int64_t k) {
          p[2] = axis_[2].centre(k);
          return height_over(a, b, c, turn, p);
        };
        int64_t on = k_begin, end = k_end;  // on: the first centre on the facet or above
        while (on < end) {
          const int64_t middle = on + (end - on) / 2;
          if (height(middle) >= 0) {
            end = middle;
          } else {
            on = middle + 1;
          }
        }
        const int64_t above = on < k_end && height(on) == 0 ? on + 1 : on;
        // A centre on the facet belongs to the solid: the line has entered there, and has not left.
        if (passed & (kMoved | kMovedBack)) {
          add(line_at(i, j), turn < 0 ? on : above, -turn, passed & (kMoved | kMovedBack));
        }
        if (passed & kOnBoundary) mark(line_at(i, j), on, above);
      }
    }
  }

  void mark_edge_along_lines(const Vec3& a, const Vec3& b) {
    if (a[0] != b[0] || a[1] != b[1]) return;
    const int64_t i = axis_[0].first_from(a[0]), j = axis_[1].first_from(a[1]);
    if (axis_[0].centre(i) != a[0] || axis_[1].centre(j) != a[1]) return;
    mark(line_at(i, j), axis_[2].first_from(std::min(a[2], b[2])), axis_[2].first_beyond(std::max(a[2], b[2])));
  }
  // Centres begin <= k < end lie on an edge or a corner.
  void mark(int64_t line, int64_t begin, int64_t end) {
    if (begin >= end) return;
    add(line, begin, 1, kOnBoundary);
    add(line, end, -1, kOnBoundary);
  }
  void add(int64_t line, int64_t k, int step, unsigned lines) {
    crossings_.push_back({line, k, static_cast<int8_t>(step), static_cast<uint8_t>(lines)});
  }
  int64_t line_at(int64_t i, int64_t j) const { return (j - first_j_) * lines_in_row_ + (i - first_i_); }

  const std::vector<Corners>& facets_;
  std::array<int, 3> order_;
  std::array<Axis, 3> axis_;
  std::vector<Vec3> vertices_;
  int64_t first_i_, first_j_, lines_in_row_;
  std::vector<Crossing> crossings_;
};

}  // namespace

std::vector<double> voxelise(const Surface& surface, const ogive_voxelise_def& def) {
  for (int d = 0; d < 3; ++d) {
    if (!(def.spacing[d] > 0 && def.spacing[d] <= kLargestCoordinate)) {
      refuse_argument("spacing[" + std::to_string(d) + "] = " + text_of(def.spacing[d]) +
                      ": expected a finite number > 0");
    }
  }
  const Rotation lattice = rotation_of(def.lattice_axis, "lattice_axis", def.lattice_reference, "lattice_reference");
  const Rotation body = rotation_of(def.axis, "axis", def.reference, "reference");
  const Vec3 origin = lattice.apply_inverse(vector_field(def.lattice_origin, "lattice_origin"));
  const Vec3 position = vector_field(def.position, "position");

  std::vector<Vec3> vertices;
  vertices.reserve(surface.vertices.size());
  for (const Vec3& p : surface.vertices) vertices.push_back(lattice.apply_inverse(p));

  std::array<Axis, 3> axes;
  Vec3 cells;
  double all_cells = 1;
  std::string box;
  for (int d = 0; d < 3; ++d) {
    axes[d] = {origin[d], def.spacing[d]};
    const auto [low, high] = std::minmax_element(vertices.begin(), vertices.end(),
                                                 [d](const Vec3& a, const Vec3& b) { return a[d] < b[d]; });
    // Also of the lattice origin itself: cells must stay wider than the rounding of their centres.
    const double farthest =
        std::max({std::abs((*low)[d] - origin[d]), std::abs((*high)[d] - origin[d]), std::abs(origin[d])}) /
        def.spacing[d];
    if (!(farthest <= kFarthestCell)) {
      refuse_argument("spacing[" + std::to_string(d) + "] = " + text_of(def.spacing[d]) + ": the mesh is " +
                      text_of(farthest) +
                      " cells from the lattice origin, or that from the mesh's; expected at most 1e9");
    }
    cells[d] = ((*high)[d] - (*low)[d]) / def.spacing[d] + 1;
    all_cells *= cells[d];
    box += (d ? " x " : "") + text_of((*high)[d] - (*low)[d]);
  }
  const std::string spacing = text_of(Vec3{def.spacing[0], def.spacing[1], def.spacing[2]});
  if (all_cells > kMostCells) {
    refuse_argument("spacing = " + spacing + ": the bounding box of " + box + " holds " + text_of(all_cells) +
                    " lattice cells; expected at most 1e11");
  }

  // Lines along the axis with the most cells are the fewest. A cyclic order keeps the axes right-handed.
  const int along = static_cast<int>(std::max_element(cells.begin(), cells.end()) - cells.begin());
  const std::array<int, 3> order = {(along + 1) % 3, (along + 2) % 3, along};

  std::vector<double> xyz;
  Filler(vertices, surface.facets, axes, order).fill([&](const Vec3& centre) {
    const Vec3 placed = body.apply(lattice.apply(centre));
    for (int d = 0; d < 3; ++d) xyz.push_back(placed[d] + position[d]);
  });
  if (xyz.empty()) {
    refuse_argument("spacing = " + spacing +
                    ": no lattice centre lies inside the mesh, whose bounding box in lattice axes is " + box +
                    "; expected a smaller spacing");
  }
  return xyz;
}

std::vector<double> placed_vertices(const Surface& surface, const ogive_voxelise_def& def) {
  const Rotation body = rotation_of(def.axis, "axis", def.reference, "reference");
  const Vec3 position = vector_field(def.position, "position");
  std::vector<double> xyz;
  xyz.reserve(3 * surface.vertices.size());
  for (const Vec3& p : surface.vertices) {
    const Vec3 placed = body.apply(p);
    for (int d = 0; d < 3; ++d) xyz.push_back(placed[d] + position[d]);
  }
  return xyz;
}

}  // namespace ogive::geometry
