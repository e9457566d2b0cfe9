// The surface of a body and its signed distance: positive outside, its gradient the unit normal out of the body.
//
// Exact everywhere that is asked for, tips and edges included: of the analytic shapes in closed form, of triangles from the
// nearest of them (a tree of boxes), with the sign of the angle-weighted pseudonormal of the nearest face, edge or vertex
// (Baerentzen, Aanaes 2005). docs/theory.md, section 6.5.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vector3.hpp"

namespace ogive {

// The built-in solids by the numbers of OGIVE_SOLID_*.
enum class SurfaceKind : std::int32_t { None = -1, Box = 0, Cylinder = 1, Sphere = 2, OgiveRod = 3, Triangles = 4 };

// Where it lay when the body was given.
struct SurfaceDef {
  SurfaceKind kind = SurfaceKind::None;
  // Built-in solids: sizes, origin and axes (rows x', y', z') of SolidDef.
  Vector3 size{}, origin{};
  std::array<Vector3, 3> axes{};
  // Triangles: three coordinates a vertex; three vertices a triangle, counter-clockwise from outside.
  std::vector<double> vertices;
  std::vector<std::int32_t> corners;

  bool given() const { return kind != SurfaceKind::None; }
};

struct SurfacePoint {
  double distance = 0;  // signed
  Vector3 normal{};     // unit; the nearest point is x - distance * normal
  std::int32_t triangle = -1;  // it lies in; of Surface's own numbering
};

class Surface {
 public:
  Surface() = default;
  // Throws Error(Argument) for triangles that are not the closed, oriented boundary of something: see check_triangles.
  // Triangles wholly outside the box are left out: what lies beyond a mirror is never the nearest.
  Surface(const SurfaceDef& def, const Vector3& box_lower, const Vector3& box_upper);

  // The nearest point to x; false where it is farther than `reach`. Any number of threads may ask at once. *hint remembers
  // where the caller's last query ended (-1 at first): the next one, if it is near, is quicker.
  bool nearest(const Vector3& x, double reach, SurfacePoint& found, std::int32_t* hint = nullptr) const;
  const Vector3& lower() const { return lower_; }
  const Vector3& upper() const { return upper_; }

  // Triangles alone: the vertices have moved. Three coordinates each, as many as there were.
  void move(const std::vector<double>& vertices);
  // The vertices of a triangle with their shares in a point of it.
  struct Corners {
    std::array<std::int32_t, 3> vertex;
    std::array<double, 3> share;
  };
  Corners corners_at(std::int32_t triangle, const Vector3& x) const;
  // Unit, outward; from the angle-weighted mean of the triangles around.
  Vector3 normal_at_vertex(std::int64_t v) const;
  // Whether a triangle that is not left out has the vertex.
  bool has_vertex(std::int64_t v) const { return first_around_[v] < first_around_[v + 1]; }

  std::int64_t memory_bytes() const;

 private:
  struct TreeNode {
    double lower[3], upper[3];
    std::int32_t first, count;  // triangles of a leaf; count 0: two children, the next node and `first`
  };
  // A triangle where the tree wants it; number: in `corners_`.
  struct Nearest {
    double squared;
    std::int32_t triangle, feature;  // feature: 0 face, 1..3 edge from corner 0..2, 4..6 corner
    Vector3 point;
  };

  void find_bounds();
  void build(std::vector<std::int32_t>& order, const std::vector<Vector3>& centre, std::int32_t first, std::int32_t end);
  void fit_boxes();
  Vector3 face_normal(std::int32_t t) const;    // unit
  Vector3 pseudonormal(std::int32_t t, std::int32_t feature) const;
  void nearest_of_triangle(std::int32_t t, const Vector3& x, Nearest& best) const;
  Vector3 vertex(std::int32_t v) const { return {vertices_[3 * v], vertices_[3 * v + 1], vertices_[3 * v + 2]}; }
  bool nearest_triangle(const Vector3& x, double reach, SurfacePoint& found, std::int32_t* hint) const;

  SurfaceDef shape_;  // of built-in solids
  Vector3 lower_{}, upper_{};
  double scale_ = 1;  // largest extent
  std::vector<double> vertices_;
  std::vector<std::int32_t> corners_;     // in the order of the tree's leaves
  std::vector<std::int32_t> neighbour_;   // triangle across each edge, from corner 0..2; -1: left out
  std::vector<TreeNode> tree_;
  std::vector<std::int32_t> first_around_, around_;  // 3 t + k of the triangles around each vertex, k its place there
};

// Throws Error(Argument) unless each edge is shared by two triangles that run through it in opposite directions, no
// triangle is without area, corners are vertices, coordinates finite, and the enclosed volume positive. What
// ogive_mesh_check accepts passes.
void check_triangles(const std::vector<double>& vertices, const std::vector<std::int32_t>& corners);

}  // namespace ogive
