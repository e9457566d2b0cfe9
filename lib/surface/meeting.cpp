// The sum of the signed distances of two bodies, f(x) = d_a(x) + d_b(x), is convex for convex bodies, and its minimum is the
// gap between them, met at all points of the shortest connections. It is looked for from the node by the steps of Barzilai
// and Borwein (1988); a node between flat faces stays where it is.
#include "surface/meeting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "boundary/boundary.hpp"
#include "contact/method.hpp"
#include "contact/stencil.hpp"

namespace ogive {
namespace {

constexpr int most_descents = 60;
constexpr double still = 1e-9;  // of the sum of two unit normals

Vector3 product(const Matrix3& m, const Vector3& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

Vector3 transposed_product(const Matrix3& m, const Vector3& v) {
  return plus(plus(times(v[0], m[0]), times(v[1], m[1])), times(v[2], m[2]));
}

}  // namespace

// Whether contact asks for the body's surface.
static bool is_used(const Model& model, int body) {
  const Body& rules = model.bodies[body];
  if (!rules.has_surface()) return false;
  for (const Wall& wall : model.walls)
    if ((rules.rigid() || rules.total_lagrangian()) && by_surface(wall.rule)) return true;
  for (int other = 0; other < static_cast<int>(model.bodies.size()); ++other) {
    if (other == body || !by_surface(model.rule_of(body, other))) continue;
    const bool both_rigid = rules.rigid() && model.bodies[other].rigid() && model.bodies[other].has_surface();
    if (both_rigid || rules.total_lagrangian() || surface_owner(model, body, other) == body) return true;
  }
  return false;
}

bool by_surface(const ContactRule& rule) {
  return rule.detection == Detection::Surface && contact_method(rule.method).needs_normal;
}

int surface_owner(const Model& model, int a, int b) {
  const Body &first = model.bodies[a], &second = model.bodies[b];
  if (!first.has_surface() || !second.has_surface()) return first.has_surface() ? a : second.has_surface() ? b : -1;
  if (first.rigid() != second.rigid()) return first.rigid() ? a : b;
  if (first.total_lagrangian() != second.total_lagrangian()) return first.total_lagrangian() ? a : b;
  const ContactRule& rule = model.rule_of(a, b);
  if (rule.master == a || rule.master == b) return rule.master;
  return std::min(a, b);
}

void prepare_surfaces(const Model& model, Workspace& workspace) {
  workspace.surfaces.clear();
  if (!workspace.contact_needs.surface) return;
  workspace.surfaces.resize(model.bodies.size());
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (!is_used(model, static_cast<int>(b))) continue;
    Vector3 lower, upper;
    for (int axis = 0; axis < 3; ++axis) {
      const double endless = std::numeric_limits<double>::infinity(), h = model.grid.cell_size;
      lower[axis] = model.grid.face[2 * axis] == Face::Free ? -endless : model.grid.domain_min[axis] - h;
      upper[axis] = model.grid.face[2 * axis + 1] == Face::Free ? endless : model.grid.domain_max[axis] + h;
    }
    workspace.surfaces[b].surface = Surface(model.bodies[b].surface, lower, upper);
    workspace.surfaces[b].used = true;
  }
}

// Of a total Lagrangian body as it lay at rest.
class NearestParticle {
 public:
  NearestParticle(const Model& model, const BodyState& body) : model_(model), body_(body) {
    for (const Group& group : body.groups)
      for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) cells_.emplace_back(cell_of(place(p)), p);
    std::sort(cells_.begin(), cells_.end());
  }
  // Within a cell or so of x; -1: there is none.
  std::int64_t to(const Vector3& x) const {
    const Cell at = cell_of(x);
    std::int64_t found = -1;
    double least = std::numeric_limits<double>::infinity();
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j) {
        const Cell first = {at[0] + k, at[1] + j, at[2] - 1}, last = {at[0] + k, at[1] + j, at[2] + 1};
        for (auto i = std::lower_bound(cells_.begin(), cells_.end(), std::pair(first, std::int64_t{-1}));
             i != cells_.end() && i->first <= last; ++i) {
          const Vector3 r = minus(x, place(i->second));
          if (dot(r, r) < least) least = dot(r, r), found = i->second;
        }
      }
    return found;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;  // z, y, x
  Vector3 place(std::int64_t p) const {
    const double* X = &body_.reference.position[4 * p];
    return {X[0], X[1], X[2]};
  }
  Cell cell_of(const Vector3& x) const {
    Cell cell;
    for (int c = 0; c < 3; ++c)
      cell[2 - c] = static_cast<std::int64_t>(std::floor((x[c] - model_.grid.domain_min[c]) / model_.grid.cell_size));
    return cell;
  }

  const Model& model_;
  const BodyState& body_;
  std::vector<std::pair<Cell, std::int64_t>> cells_;
};

// The stencils that move the vertices of a total Lagrangian body, from where they lay at rest.
static void link_vertices(const Model& model, const BodyState& body, int index, const Workspace& reference, PlacedSurface& placed) {
  double mass = 0;
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) mass += body.reference.position[4 * p + 3];
  const double depth = 0.5 * std::cbrt(mass / (model.material_of(index).density * static_cast<double>(body.particles)));
  const std::vector<double>& vertices = model.bodies[index].surface.vertices;
  Surface at_rest = placed.surface;
  at_rest.move(vertices);
  const Stenciler stenciler(model, reference);
  placed.vertex_inward.assign(vertices.size() / 3, Vector3{});
  placed.vertex_nodes.clear();
  placed.vertex_ends.clear();
  for (std::int64_t v = 0; v < static_cast<std::int64_t>(vertices.size() / 3); ++v) {
    if (at_rest.has_vertex(v)) {
      Vector3 X = {vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]};
      placed.vertex_inward[v] = times(-depth, at_rest.normal_at_vertex(v));
      Vector3 inside = plus(X, placed.vertex_inward[v]);
      const Vector3 sign = into_model(model.grid, X);
      into_model(model.grid, inside);
      const std::size_t first = placed.vertex_nodes.size();
      stenciler.make_linear(index, X, inside, placed.vertex_nodes);
      for (std::size_t e = first; e < placed.vertex_nodes.size(); ++e)
        for (int c = 0; c < 3; ++c) placed.vertex_nodes[e].weight[c] *= sign[c];
    }
    placed.vertex_ends.push_back(static_cast<std::int64_t>(placed.vertex_nodes.size()));
  }
}

// Methods that look at the stress take that of the particle next to a vertex.
static void find_particles(const Model& model, const BodyState& body, int index, PlacedSurface& placed) {
  const std::vector<double>& vertices = model.bodies[index].surface.vertices;
  const NearestParticle nearest(model, body);
  placed.vertex_particle.clear();
  for (std::size_t v = 0; v < vertices.size(); v += 3)
    placed.vertex_particle.push_back(nearest.to({vertices[v], vertices[v + 1], vertices[v + 2]}));
}

void place_surfaces(const Model& model, const State& state, Workspace& workspace) {
  for (std::size_t b = 0; b < workspace.surfaces.size(); ++b) {
    PlacedSurface& placed = workspace.surfaces[b];
    if (!placed.used) continue;
    if (!model.bodies[b].rigid()) placed.surface.move(state.bodies[b].surface_vertices);
    if (state.bodies[b].lagrangian && placed.vertex_ends.empty()) {
      link_vertices(model, state.bodies[b], static_cast<int>(b), *workspace.reference_grid, placed);
      if (workspace.contact_needs.stress) find_particles(model, state.bodies[b], static_cast<int>(b), placed);
    }
    const RigidState& rigid = state.bodies[b].rigid;
    placed.moved = model.bodies[b].rigid();
    placed.turn = rigid.turn;
    placed.shift = rigid.shift;
    placed.lower = placed.surface.lower();
    placed.upper = placed.surface.upper();
    if (!placed.moved) continue;
    for (int c = 0; c < 3; ++c) {
      double low = placed.shift[c], high = low;
      for (int k = 0; k < 3; ++k) {
        const double p = placed.turn[c][k] * placed.surface.lower()[k], q = placed.turn[c][k] * placed.surface.upper()[k];
        low += std::min(p, q);
        high += std::max(p, q);
      }
      placed.lower[c] = low;
      placed.upper[c] = high;
    }
  }
}

void move_surfaces(const Model& model, State& state, const Workspace& workspace, double dt) {
  for (std::size_t b = 0; b < workspace.surfaces.size(); ++b) {
    if (!workspace.surfaces[b].used || model.bodies[b].rigid()) continue;
    const PlacedSurface& placed = workspace.surfaces[b];
    const bool lagrangian = state.bodies[b].lagrangian;
    std::vector<double>& vertices = state.bodies[b].surface_vertices;
    const std::int64_t count = static_cast<std::int64_t>(vertices.size() / 3);
    std::vector<Vector3> velocity(count);
    std::vector<char> found(count);
#pragma omp parallel num_threads(workspace.threads)
    {
      const SurfaceVelocities velocities(model, workspace);
#pragma omp for schedule(static)
      for (std::int64_t v = 0; v < count; ++v) {
        if (!placed.surface.has_vertex(v)) continue;
        if (lagrangian) {
          const Workspace& reference = *workspace.reference_grid;
          const std::int64_t begin = v == 0 ? 0 : placed.vertex_ends[v - 1];
          found[v] = placed.vertex_ends[v] > begin;
          for (std::int64_t e = begin; e < placed.vertex_ends[v]; ++e)
            for (int c = 0; c < 3; ++c)
              velocity[v][c] += placed.vertex_nodes[e].weight[c] * reference.nodes[placed.vertex_nodes[e].node].f[c];
          continue;
        }
        Vector3 x = {vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]};
        const Vector3 sign = into_model(model.grid, x);
        found[v] = velocities.at(model.field_of(static_cast<int>(b)), x, velocity[v]);
        for (int c = 0; c < 3; ++c) velocity[v][c] *= sign[c];
      }
    }
    Vector3 mean{};
    double moving = 0;
    for (std::int64_t v = 0; v < count; ++v)
      if (found[v]) {
        add(mean, velocity[v]);
        moving += 1;
      }
    if (moving > 0) mean = times(1 / moving, mean);
    for (std::int64_t v = 0; v < count; ++v)
      for (int c = 0; c < 3 && placed.surface.has_vertex(v); ++c)
        vertices[3 * v + c] += dt * (found[v] ? velocity[v][c] : mean[c]);
  }
}

bool nearest_of_owner(const Model& model, const Workspace& workspace, std::int32_t owner, const Vector3& x, double reach,
                      SurfacePoint& found, std::int32_t* hint) {
  if (owner < 0) {
    const Wall& wall = model.walls[-1 - owner];
    found.distance = dot(minus(x, wall.point), wall.normal);
    found.normal = wall.normal;
    return std::abs(found.distance) <= reach;
  }
  const PlacedSurface& placed = workspace.surfaces[owner];
  for (int c = 0; c < 3; ++c)
    if (x[c] < placed.lower[c] - reach || x[c] > placed.upper[c] + reach) return false;
  if (!placed.moved) return placed.surface.nearest(x, reach, found, hint);
  if (!placed.surface.nearest(transposed_product(placed.turn, minus(x, placed.shift)), reach, found, hint)) return false;
  found.normal = product(placed.turn, found.normal);
  return true;
}

bool meeting_of(const Model& model, const Workspace& workspace, std::int32_t a, std::int32_t b, const Vector3& node,
                double reach, Meeting& found) {
  // Beyond this no body lies whose node this is.
  const double far = 4 * reach;
  Vector3 x = node, last_x{}, last_slope{};
  SurfacePoint first, second;
  found.gap = std::numeric_limits<double>::infinity();
  for (int descent = 0; descent < most_descents; ++descent) {
    if (!nearest_of_owner(model, workspace, a, x, far, first) || !nearest_of_owner(model, workspace, b, x, far, second))
      break;
    if (first.distance + second.distance < found.gap) {
      found.gap = first.distance + second.distance;
      found.place =
          minus(x, times(0.5, plus(times(first.distance, first.normal), times(second.distance, second.normal))));
      found.normal = minus(first.normal, second.normal);
    }
    const Vector3 slope = plus(first.normal, second.normal);
    if (dot(slope, slope) < still * still) break;
    double step = 0.25 * reach;
    if (descent > 0) {
      const Vector3 way = minus(x, last_x), change = minus(slope, last_slope);
      const double along = dot(way, change);
      if (along > 0) step = std::min(dot(way, way) / along, reach / length(slope));
    }
    last_x = x;
    last_slope = slope;
    x = minus(x, times(step, slope));
  }
  if (!std::isfinite(found.gap) || !make_unit(found.normal)) return false;
  for (int c = 0; c < 3; ++c)
    if (std::abs(found.place[c] - node[c]) > reach) return false;
  return true;
}

}  // namespace ogive
