// Signed distances.
//
// Surfaces of revolution are looked at in the half plane (rho, z), rho the distance from the axis: the nearest point lies
// in the same half plane, so that a profile of segments and arcs is enough.
#include "surface/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>

#include "error.hpp"
#include "solids.hpp"

namespace ogive {
namespace {

constexpr std::int32_t leaf_size = 4;
// Nearer than this part of the body's size the direction to the nearest point is round-off: its pseudonormal serves.
constexpr double on_surface = 1e-10;

// In the half plane of a surface of revolution.
struct Flat {
  double r, z;
};

// The nearest so far, with the outward normal there as for a point on the surface.
struct FlatNearest {
  double squared = std::numeric_limits<double>::infinity();
  Flat point{}, normal{};

  void offer(const Flat& x, const Flat& at, const Flat& n) {
    const double dr = x.r - at.r, dz = x.z - at.z, d = dr * dr + dz * dz;
    if (d < squared) *this = {d, at, n};
  }
  // Segment a b with its outward normal.
  void segment(const Flat& x, const Flat& a, const Flat& b, const Flat& n) {
    const double ur = b.r - a.r, uz = b.z - a.z, size = ur * ur + uz * uz;
    const double t = size > 0 ? std::clamp(((x.r - a.r) * ur + (x.z - a.z) * uz) / size, 0.0, 1.0) : 0.0;
    offer(x, {a.r + t * ur, a.z + t * uz}, n);
  }
};

SurfacePoint of_sphere(const Vector3& x, double radius) {
  const double r = length(x);
  if (!(r > 0)) return {-radius, {0, 0, 1}};
  return {r - radius, times(1 / r, x)};
}

SurfacePoint of_box(const Vector3& x, const Vector3& size) {
  Vector3 beyond, out{};
  int nearest = 0;
  bool outside = false;
  for (int c = 0; c < 3; ++c) {
    beyond[c] = std::abs(x[c]) - 0.5 * size[c];
    if (beyond[c] > beyond[nearest]) nearest = c;
    if (beyond[c] <= 0) continue;
    out[c] = std::copysign(beyond[c], x[c]);
    outside = true;
  }
  if (outside) {
    const double d = length(out);
    return {d, times(1 / d, out)};
  }
  SurfacePoint found;
  found.distance = beyond[nearest];
  found.normal[nearest] = x[nearest] < 0 ? -1 : 1;
  return found;
}

// Takes the result in the half plane back to space.
SurfacePoint of_revolution(const Vector3& x, double rho, const Flat& at, const FlatNearest& nearest, bool inside,
                           double scale) {
  const double d = std::sqrt(nearest.squared);
  Flat n = nearest.normal;
  if (d > on_surface * scale) {
    const double sign = inside ? -1 : 1;
    n = {sign * (at.r - nearest.point.r) / d, sign * (at.z - nearest.point.z) / d};
  }
  SurfacePoint found;
  found.distance = inside ? -d : d;
  // On the axis any direction across it is as good as another.
  if (rho > 0)
    found.normal = {n.r * x[0] / rho, n.r * x[1] / rho, n.z};
  else
    found.normal = {n.r, 0, n.z};
  return found;
}

SurfacePoint of_cylinder(const Vector3& x, const Vector3& size) {
  const double outer = size[0], half = 0.5 * size[1], inner = size[2];
  const Flat at{std::hypot(x[0], x[1]), x[2]};
  FlatNearest nearest;
  nearest.segment(at, {outer, -half}, {outer, half}, {1, 0});
  nearest.segment(at, {inner, half}, {outer, half}, {0, 1});
  nearest.segment(at, {inner, -half}, {outer, -half}, {0, -1});
  if (inner > 0) nearest.segment(at, {inner, -half}, {inner, half}, {-1, 0});
  const bool inside = at.r < outer && at.r > inner - (inner == 0) && std::abs(at.z) < half;
  return of_revolution(x, at.r, at, nearest, inside, std::max(outer, half));
}

// Tip at the origin, the body along -z: z here is the distance behind the tip, so that its sign turns at the end.
SurfacePoint of_ogive_rod(const Vector3& x, const Vector3& size) {
  const double radius = size[0], all = size[1], head = size[2];
  const double nose = ogive_nose_length(radius, head), arc = 2 * head * radius;
  const Flat centre{radius - arc, nose};
  const Flat at{std::hypot(x[0], x[1]), -x[2]};
  FlatNearest nearest;
  nearest.offer(at, {0, 0}, {0, -1});
  const Flat from{at.r - centre.r, at.z - centre.z};
  const double size_of = std::hypot(from.r, from.z);
  if (from.z <= 0 && from.r > 0) {
    const Flat n{from.r / size_of, from.z / size_of}, p{centre.r + arc * n.r, centre.z + arc * n.z};
    if (p.r >= 0) nearest.offer(at, p, n);
  }
  nearest.segment(at, {radius, nose}, {radius, all}, {1, 0});
  nearest.segment(at, {0, all}, {radius, all}, {0, 1});
  const bool inside = at.z > 0 && at.z < all && at.r < (at.z < nose ? centre.r + std::sqrt(std::max(
                                                            0.0, arc * arc - from.z * from.z)) : radius);
  SurfacePoint found = of_revolution(x, at.r, at, nearest, inside, all);
  found.normal[2] = -found.normal[2];
  return found;
}

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::Argument, "surface: " + message); }

std::uint64_t edge_key(std::int32_t a, std::int32_t b) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32 | static_cast<std::uint32_t>(b);
}

}  // namespace

void check_triangles(const std::vector<double>& vertices, const std::vector<std::int32_t>& corners) {
  const std::int64_t count = static_cast<std::int64_t>(vertices.size() / 3);
  const std::int64_t triangles = static_cast<std::int64_t>(corners.size() / 3);
  if (count < 4 || triangles < 4) refuse("a closed one has at least 4 vertices and 4 triangles");
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (!std::isfinite(vertices[i])) refuse("coordinates of vertex " + std::to_string(i / 3) + " must be finite");
  std::unordered_map<std::uint64_t, std::int32_t> edges;
  edges.reserve(2 * corners.size());
  double volume = 0;
  const auto place = [&](std::int32_t v) { return Vector3{vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]}; };
  const Vector3 first = place(0);
  for (std::int64_t t = 0; t < triangles; ++t) {
    const std::int32_t* corner = &corners[3 * t];
    for (int k = 0; k < 3; ++k)
      if (corner[k] < 0 || corner[k] >= count)
        refuse("corners of triangle " + std::to_string(t) + " must be vertices 0.." + std::to_string(count - 1) +
               ", got " + std::to_string(corner[k]));
    const Vector3 a = minus(place(corner[0]), first), b = minus(place(corner[1]), first), c = minus(place(corner[2]), first);
    const Vector3 area = cross(minus(b, a), minus(c, a));
    if (!(dot(area, area) > 0)) refuse("triangle " + std::to_string(t) + " must have an area");
    volume += dot(a, cross(b, c));
    for (int k = 0; k < 3; ++k)
      if (!edges.emplace(edge_key(corner[k], corner[(k + 1) % 3]), static_cast<std::int32_t>(t)).second)
        refuse("triangle " + std::to_string(t) + ": an edge must belong to two triangles, each seen counter-clockwise from "
               "outside; another one runs through the same edge in the same direction");
  }
  for (std::int64_t t = 0; t < triangles; ++t)
    for (int k = 0; k < 3; ++k)
      if (!edges.count(edge_key(corners[3 * t + (k + 1) % 3], corners[3 * t + k])))
        refuse("triangle " + std::to_string(t) + ": the edge from its corner " + std::to_string(k) +
               " has no other triangle: the surface must be closed");
  if (!(volume > 0)) refuse("must enclose a volume, its triangles counter-clockwise from outside");
}

Surface::Surface(const SurfaceDef& def, const Vector3& box_lower, const Vector3& box_upper) {
  if (def.kind != SurfaceKind::Triangles) {
    shape_ = def;
    find_bounds();
    return;
  }
  check_triangles(def.vertices, def.corners);
  vertices_ = def.vertices;
  shape_.kind = def.kind;
  std::vector<std::int32_t> order;
  std::vector<Vector3> centre(def.corners.size() / 3);
  for (std::size_t t = 0; t < centre.size(); ++t) {
    bool outside = false;
    for (int c = 0; c < 3; ++c) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (int k = 0; k < 3; ++k) {
        const double x = vertices_[3 * static_cast<std::size_t>(def.corners[3 * t + k]) + c];
        low = std::min(low, x);
        high = std::max(high, x);
        centre[t][c] += x / 3;
      }
      outside = outside || high < box_lower[c] || low > box_upper[c];
    }
    if (!outside) order.push_back(static_cast<std::int32_t>(t));
  }
  const std::int32_t triangles = static_cast<std::int32_t>(order.size());
  if (triangles == 0) refuse("no part of it lies inside the domain");
  tree_.reserve(2 * (static_cast<std::size_t>(triangles) / 2 + 1));
  build(order, centre, 0, triangles);
  corners_.resize(3 * order.size());
  for (std::int32_t t = 0; t < triangles; ++t)
    std::copy_n(&def.corners[3 * static_cast<std::size_t>(order[t])], 3, &corners_[3 * static_cast<std::size_t>(t)]);
  std::unordered_map<std::uint64_t, std::int32_t> edges;
  edges.reserve(2 * corners_.size());
  for (std::int32_t t = 0; t < triangles; ++t)
    for (int k = 0; k < 3; ++k) edges.emplace(edge_key(corners_[3 * t + k], corners_[3 * t + (k + 1) % 3]), t);
  neighbour_.resize(corners_.size());
  for (std::int32_t t = 0; t < triangles; ++t)
    for (int k = 0; k < 3; ++k) {
      const auto across = edges.find(edge_key(corners_[3 * t + (k + 1) % 3], corners_[3 * t + k]));
      neighbour_[3 * t + k] = across == edges.end() ? -1 : across->second;
    }
  first_around_.assign(vertices_.size() / 3 + 1, 0);
  for (const std::int32_t v : corners_) ++first_around_[v + 1];
  for (std::size_t v = 1; v < first_around_.size(); ++v) first_around_[v] += first_around_[v - 1];
  around_.resize(corners_.size());
  std::vector<std::int32_t> next = first_around_;
  for (std::size_t i = 0; i < corners_.size(); ++i) around_[next[corners_[i]]++] = static_cast<std::int32_t>(i);
  fit_boxes();
}

void Surface::find_bounds() {
  Vector3 low, high;
  const Vector3& size = shape_.size;
  switch (shape_.kind) {
    case SurfaceKind::Box: high = times(0.5, size); break;
    case SurfaceKind::Cylinder: high = {size[0], size[0], 0.5 * size[1]}; break;
    case SurfaceKind::Sphere: high = {size[0], size[0], size[0]}; break;
    default: high = {size[0], size[0], 0}; break;
  }
  low = times(-1, high);
  if (shape_.kind == SurfaceKind::OgiveRod) low[2] = -size[1];
  for (int c = 0; c < 3; ++c) {
    lower_[c] = upper_[c] = shape_.origin[c];
    for (int k = 0; k < 3; ++k) {
      const double a = shape_.axes[k][c] * low[k], b = shape_.axes[k][c] * high[k];
      lower_[c] += std::min(a, b);
      upper_[c] += std::max(a, b);
    }
  }
}

void Surface::build(std::vector<std::int32_t>& order, const std::vector<Vector3>& centre, std::int32_t first,
                    std::int32_t end) {
  const std::size_t node = tree_.size();
  tree_.push_back({});
  tree_[node].first = first;
  tree_[node].count = end - first;
  if (end - first <= leaf_size) return;
  Vector3 low = centre[order[first]], high = low;
  for (std::int32_t i = first; i < end; ++i)
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], centre[order[i]][c]);
      high[c] = std::max(high[c], centre[order[i]][c]);
    }
  int axis = 0;
  for (int c = 1; c < 3; ++c)
    if (high[c] - low[c] > high[axis] - low[axis]) axis = c;
  const std::int32_t middle = first + (end - first) / 2;
  std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + end,
                   [&](std::int32_t a, std::int32_t b) {
                     return centre[a][axis] != centre[b][axis] ? centre[a][axis] < centre[b][axis] : a < b;
                   });
  build(order, centre, first, middle);
  tree_[node].count = 0;
  tree_[node].first = static_cast<std::int32_t>(tree_.size());
  build(order, centre, middle, end);
}

void Surface::fit_boxes() {
  // Children come after their parent.
  for (std::size_t n = tree_.size(); n-- > 0;) {
    TreeNode& node = tree_[n];
    for (int c = 0; c < 3; ++c) {
      node.lower[c] = std::numeric_limits<double>::infinity();
      node.upper[c] = -node.lower[c];
    }
    const auto take = [&](const double* low, const double* high) {
      for (int c = 0; c < 3; ++c) {
        node.lower[c] = std::min(node.lower[c], low[c]);
        node.upper[c] = std::max(node.upper[c], high[c]);
      }
    };
    for (std::int32_t i = 3 * node.first; i < 3 * (node.first + node.count); ++i)
      take(&vertices_[3 * corners_[i]], &vertices_[3 * corners_[i]]);
    if (node.count > 0) continue;
    take(tree_[n + 1].lower, tree_[n + 1].upper);
    take(tree_[node.first].lower, tree_[node.first].upper);
  }
  scale_ = 0;
  for (int c = 0; c < 3; ++c) {
    lower_[c] = tree_[0].lower[c];
    upper_[c] = tree_[0].upper[c];
    scale_ = std::max(scale_, upper_[c] - lower_[c]);
  }
}

Vector3 Surface::face_normal(std::int32_t t) const {
  const Vector3 a = vertex(corners_[3 * t]), b = vertex(corners_[3 * t + 1]), c = vertex(corners_[3 * t + 2]);
  Vector3 normal = cross(minus(b, a), minus(c, a));
  make_unit(normal);
  return normal;
}

// Only where a query ends: a deforming surface would have to renew all of them in every step.
Vector3 Surface::pseudonormal(std::int32_t t, std::int32_t feature) const {
  if (feature == 0) return face_normal(t);
  Vector3 sum{};
  if (feature < 4) {
    const std::int32_t across = neighbour_[3 * t + feature - 1];
    sum = across < 0 ? face_normal(t) : plus(face_normal(t), face_normal(across));
  } else {
    const std::int32_t v = corners_[3 * t + feature - 4];
    for (std::int32_t i = first_around_[v]; i < first_around_[v + 1]; ++i) {
      const std::int32_t other = around_[i] / 3, k = around_[i] % 3;
      const Vector3 at = vertex(v), a = minus(vertex(corners_[3 * other + (k + 1) % 3]), at),
                    b = minus(vertex(corners_[3 * other + (k + 2) % 3]), at);
      add(sum, times(std::atan2(length(cross(a, b)), dot(a, b)), face_normal(other)));
    }
  }
  make_unit(sum);
  return sum;
}

// The nearest point of a triangle by the regions of its plane (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
void Surface::nearest_of_triangle(std::int32_t t, const Vector3& x, Nearest& best) const {
  const Vector3 a = vertex(corners_[3 * t]), b = vertex(corners_[3 * t + 1]), c = vertex(corners_[3 * t + 2]);
  const Vector3 ab = minus(b, a), ac = minus(c, a), ax = minus(x, a);
  Vector3 point;
  std::int32_t feature = 0;
  const auto offer = [&] {
    const Vector3 r = minus(x, point);
    const double squared = dot(r, r);
    if (squared < best.squared) best = {squared, t, feature, point};
  };
  const double d1 = dot(ab, ax), d2 = dot(ac, ax);
  if (d1 <= 0 && d2 <= 0) {
    point = a, feature = 4;
    return offer();
  }
  const Vector3 bx = minus(x, b);
  const double d3 = dot(ab, bx), d4 = dot(ac, bx);
  if (d3 >= 0 && d4 <= d3) {
    point = b, feature = 5;
    return offer();
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    point = plus(a, times(d1 / (d1 - d3), ab)), feature = 1;
    return offer();
  }
  const Vector3 cx = minus(x, c);
  const double d5 = dot(ab, cx), d6 = dot(ac, cx);
  if (d6 >= 0 && d5 <= d6) {
    point = c, feature = 6;
    return offer();
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    point = plus(a, times(d2 / (d2 - d6), ac)), feature = 3;
    return offer();
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    point = plus(b, times(w, minus(c, b))), feature = 2;
    return offer();
  }
  const double inverse = 1 / (va + vb + vc);
  point = plus(a, plus(times(vb * inverse, ab), times(vc * inverse, ac)));
  offer();
}

bool Surface::nearest_triangle(const Vector3& x, double reach, SurfacePoint& found, std::int32_t* hint) const {
  const auto to_box = [&](const TreeNode& node) {
    double squared = 0;
    for (int c = 0; c < 3; ++c) {
      const double beyond = std::max({node.lower[c] - x[c], x[c] - node.upper[c], 0.0});
      squared += beyond * beyond;
    }
    return squared;
  };
  Nearest best{reach * reach, -1, 0, {}};
  if (hint && *hint >= 0) {
    // From the last query's triangle downhill over edges and corners: the tree then has little left to say.
    nearest_of_triangle(*hint, x, best);
    for (std::int32_t from = -1; best.triangle >= 0 && best.triangle != from && best.feature > 0;) {
      from = best.triangle;
      const std::int32_t *const across = &neighbour_[3 * from], feature = best.feature;
      const auto look = [&](int edge) {
        if (across[edge] >= 0) nearest_of_triangle(across[edge], x, best);
      };
      look(feature < 4 ? feature - 1 : feature - 4);
      if (feature >= 4) look((feature - 2) % 3);
    }
  }
  struct Waiting {
    std::int32_t node;
    double squared;
  } stack[64];
  int waiting = 0;
  const double root = to_box(tree_[0]);
  if (root < best.squared) stack[waiting++] = {0, root};
  while (waiting > 0) {
    const Waiting at = stack[--waiting];
    if (at.squared >= best.squared) continue;
    const TreeNode& node = tree_[at.node];
    if (node.count > 0) {
      for (std::int32_t t = node.first; t < node.first + node.count; ++t) nearest_of_triangle(t, x, best);
      continue;
    }
    Waiting left{at.node + 1, to_box(tree_[at.node + 1])}, right{node.first, to_box(tree_[node.first])};
    if (left.squared < right.squared) std::swap(left, right);  // the nearer one is looked at first
    if (left.squared < best.squared) stack[waiting++] = left;
    if (right.squared < best.squared) stack[waiting++] = right;
  }
  if (best.triangle < 0) return false;
  if (hint) *hint = best.triangle;
  found.triangle = best.triangle;
  const Vector3 outward = pseudonormal(best.triangle, best.feature), from = minus(x, best.point);
  const double sign = dot(from, outward) < 0 ? -1 : 1, size = std::sqrt(best.squared);
  found.distance = sign * size;
  found.normal = size > on_surface * scale_ ? times(sign / size, from) : outward;
  return true;
}

bool Surface::nearest(const Vector3& x, double reach, SurfacePoint& found, std::int32_t* hint) const {
  if (shape_.kind == SurfaceKind::Triangles) return nearest_triangle(x, reach, found, hint);
  for (int c = 0; c < 3; ++c)
    if (x[c] < lower_[c] - reach || x[c] > upper_[c] + reach) return false;
  const Vector3 r = minus(x, shape_.origin);
  const Vector3 own = {dot(shape_.axes[0], r), dot(shape_.axes[1], r), dot(shape_.axes[2], r)};
  SurfacePoint p;
  switch (shape_.kind) {
    case SurfaceKind::Box: p = of_box(own, shape_.size); break;
    case SurfaceKind::Cylinder: p = of_cylinder(own, shape_.size); break;
    case SurfaceKind::Sphere: p = of_sphere(own, shape_.size[0]); break;
    case SurfaceKind::OgiveRod: p = of_ogive_rod(own, shape_.size); break;
    default: return false;
  }
  if (std::abs(p.distance) > reach) return false;
  found.distance = p.distance;
  found.normal = plus(plus(times(p.normal[0], shape_.axes[0]), times(p.normal[1], shape_.axes[1])),
                      times(p.normal[2], shape_.axes[2]));
  return true;
}

Surface::Corners Surface::corners_at(std::int32_t triangle, const Vector3& x) const {
  const std::int32_t* corner = &corners_[3 * triangle];
  const Vector3 a = vertex(corner[0]), ab = minus(vertex(corner[1]), a), ac = minus(vertex(corner[2]), a), ax = minus(x, a);
  const Vector3 area = cross(ab, ac);
  const double inverse = 1 / std::max(dot(area, area), std::numeric_limits<double>::min());
  const double s = dot(cross(ax, ac), area) * inverse, t = dot(cross(ab, ax), area) * inverse;
  return {{corner[0], corner[1], corner[2]}, {1 - s - t, s, t}};
}

Vector3 Surface::normal_at_vertex(std::int64_t v) const {
  const std::int32_t at = around_[first_around_[v]];
  return pseudonormal(at / 3, 4 + at % 3);
}

void Surface::move(const std::vector<double>& vertices) {
  vertices_ = vertices;
  fit_boxes();
}

std::int64_t Surface::memory_bytes() const {
  const auto bytes = [](const auto& v) { return static_cast<std::int64_t>(v.capacity() * sizeof(v[0])); };
  return bytes(vertices_) + bytes(corners_) + bytes(neighbour_) + bytes(tree_) + bytes(first_around_) +
         bytes(around_);
}

}  // namespace ogive
