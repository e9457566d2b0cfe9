// Contact at points of a surface.
//
// A particle p with distance d_p from the surface (nearest point q_p, normal n_p out of the owner) and half size
// s_p = (V_0p min(J_p, 1))^(1/3) / 2 has the gap d_p - s_p. With the stencil w_j = N_j(x_p) the two bodies are compared by
//   v = sum_j w_j v_j - v_owner(q_p),  approach v . n_p < 0,
// and an impulse J on the felt body changes v_j by w_j J / m_j and the owner by -J at q_p. Since w_j m_p is part of m_j no
// node is pushed faster than the particle itself would be, however little mass it has.
//
// Points share nodes and bodies. Their impulses minimise the kinetic energy of what is left of the approach, within what
// their methods allow: a quadratic program, solved by projected gradients, all points at once, each with a mobility that
// makes a step safe, with Nesterov's acceleration, which begins anew where it would lead uphill (O'Donoghue, Candes 2015). No
// order of points is preferred, so that mirrored models have mirrored impulses.
//
// The stencil of an updated Lagrangian owner, at q_p, is stencil.hpp's for surfaces, which leaves out nodes with next to no mass.
#include "contact/points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>

#include "contact/contact.hpp"
#include "contact/method.hpp"
#include "contact/stencil.hpp"
#include "grid.hpp"
#define OGIVE_ISA_NAMESPACE scalar
#include "simd/lanes.hpp"
#include "simd/subnormals.hpp"
#include "surface/meeting.hpp"

namespace ogive {
namespace {

constexpr double look_ahead = 0.1;  // cells: gaps up to here are watched; a particle comes less far in a step
constexpr double deepest = 0.5;     // cells: deeper inside than this and half its size a particle is not found
constexpr std::size_t vertices_at_once = 512;
constexpr int most_passes = 100;
constexpr double pass_tolerance = 1e-3;  // of the relative velocity

// ------------------------------------------------------------------------------------------------------------- finding

// A group's box in eighths, for a first look.
class Eighths {
 public:
  explicit Eighths(const KernelGroup& group) {
    for (int c = 0; c < 3; ++c) {
      lower_[c] = group.bound_low[c];
      upper_[c] = group.bound_high[c];
      half_[c] = 0.5 * (upper_[c] - lower_[c]);
    }
  }
  // -1: outside.
  int of(const Vector3& x) const {
    int index = 0;
    for (int c = 0; c < 3; ++c) {
      if (!(x[c] >= lower_[c] && x[c] <= upper_[c])) return -1;
      index |= (x[c] >= lower_[c] + half_[c]) << c;
    }
    return index;
  }
  Vector3 middle(int index) const {
    Vector3 x;
    for (int c = 0; c < 3; ++c) x[c] = lower_[c] + half_[c] * (0.5 + (index >> c & 1));
    return x;
  }
  double radius() const { return 0.5 * length(half_); }  // from the middle to a corner

 private:
  Vector3 lower_, upper_, half_;
};

// Points of one group's particles, without stencils.
class Feeler {
 public:
  Feeler(const Model& model, const State& state, const Workspace& workspace)
      : model_(model), state_(state), workspace_(workspace), ahead_(look_ahead * model.grid.cell_size) {}

  void feel(const GroupLinks& link, const KernelGroup& group, std::vector<ContactPoint>& points) const {
    points.clear();
    if (state_.bodies[link.body].lagrangian && workspace_.surfaces[link.body].used) return;  // its vertices feel
    for (std::int32_t w = 0; w < static_cast<std::int32_t>(model_.walls.size()); ++w)
      if (by_surface(model_.walls[w].rule)) feel(link, group, -1 - w, points);
    for (std::int32_t b = 0; b < static_cast<std::int32_t>(workspace_.surfaces.size()); ++b)
      if (workspace_.surfaces[b].used && b != link.body) feel(link, group, b, points);
  }

  // Points of a total Lagrangian body's vertices.
  void feel(const ContactPoints::Piece& piece, std::vector<ContactPoint>& points) const {
    points.clear();
    for (std::int32_t w = 0; w < static_cast<std::int32_t>(model_.walls.size()); ++w)
      if (by_surface(model_.walls[w].rule)) feel(piece, -1 - w, points);
    for (std::int32_t b = 0; b < static_cast<std::int32_t>(workspace_.surfaces.size()); ++b)
      if (workspace_.surfaces[b].used && b != piece.body && met_at_points(model_, piece.body, b) &&
          surface_owner(model_, piece.body, b) == b)
        feel(piece, b, points);
  }

 private:
  void feel(const ContactPoints::Piece& piece, std::int32_t owner, std::vector<ContactPoint>& points) const {
    const PlacedSurface& own = workspace_.surfaces[piece.body];
    if (owner >= 0) {
      const PlacedSurface& other = workspace_.surfaces[owner];
      for (int c = 0; c < 3; ++c)
        if (own.upper[c] < other.lower[c] - ahead_ || own.lower[c] > other.upper[c] + ahead_) return;
    }
    const std::vector<double>& vertices = state_.bodies[piece.body].surface_vertices;
    std::int32_t hint = -1;
    for (std::size_t v = piece.first; v < piece.end; ++v) {
      if (!own.surface.has_vertex(static_cast<std::int64_t>(v))) continue;
      const Vector3 x = {vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]};
      Vector3 on_face{};
      SurfacePoint found;
      if (!inside_faces(x, on_face) || !nearest_of_owner(model_, workspace_, owner, x, deepest * model_.grid.cell_size, found, &hint))
        continue;
      const std::int64_t particle = own.vertex_particle.empty() ? -1 : own.vertex_particle[v];
      offer(piece.body, owner, x, found, found.distance, on_face, particle, static_cast<std::int32_t>(v), points);
    }
  }

  // False for what lies beyond a mirror.
  bool inside_faces(const Vector3& x, Vector3& on_face) const {
    const double on = 1e-9 * model_.grid.cell_size;
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        if (model_.grid.face[2 * axis + side] == Face::Free) continue;
        const double depth = side == 0 ? x[axis] - model_.grid.domain_min[axis] : model_.grid.domain_max[axis] - x[axis];
        if (std::abs(depth) <= on) on_face[axis] = 1;
        inside = inside && depth >= -on;
      }
    return inside;
  }

  void feel(const GroupLinks& link, const KernelGroup& group, std::int32_t owner, std::vector<ContactPoint>& points) const {
    // The largest half size is that of a whole cell.
    const double h = model_.grid.cell_size, reach = 0.5 * h + ahead_;
    if (owner >= 0) {
      const PlacedSurface& placed = workspace_.surfaces[owner];
      for (int c = 0; c < 3; ++c)
        if (group.bound_high[c] < placed.lower[c] - reach || group.bound_low[c] > placed.upper[c] + reach) return;
    } else {
      const Wall& wall = model_.walls[-1 - owner];
      double lowest = 0;
      for (int c = 0; c < 3; ++c)
        lowest += wall.normal[c] * ((wall.normal[c] > 0 ? group.bound_low[c] : group.bound_high[c]) - wall.point[c]);
      if (lowest > reach) return;
    }
    if (!met_at_points(model_, link.body, owner) ||
        (owner >= 0 && surface_owner(model_, link.body, owner) != owner))
      return;
    std::int32_t hint = -1;
    if (owner >= 0) {
      // A skew body's box holds many groups that are nowhere near it.
      Vector3 middle, across;
      for (int c = 0; c < 3; ++c) {
        middle[c] = 0.5 * (group.bound_low[c] + group.bound_high[c]);
        across[c] = group.bound_high[c] - group.bound_low[c];
      }
      SurfacePoint found;
      if (!nearest_of_owner(model_, workspace_, owner, middle, 0.5 * length(across) + reach, found, &hint)) return;
    }
    const Eighths eighths(group);
    std::array<SurfacePoint, 8> from_middle;
    std::array<signed char, 8> looked{};  // 1: from_middle is known, -1: nothing is near
    Vector3 last{};
    double last_distance = -std::numeric_limits<double>::infinity();  // what is known of the particle before, at `last`
    double mass = -1, largest_half = 0;
    const BodyState& body = workspace_.particles_of(state_, link.body);
    const double inverse_density = 1.0 / model_.material_of(link.body).density;
    for (std::int64_t p = group.begin; p < group.begin + body.groups[link.group].count; ++p) {
      const double* r = &body.position[4 * p];
      const Vector3 x = {r[0], r[1], r[2]};
      if (r[3] != mass) {
        mass = r[3];
        largest_half = 0.5 * std::cbrt(mass * inverse_density);
      }
      Vector3 on_face{};
      inside_faces(x, on_face);
      double sharing = 1;  // half of a particle that the face cuts
      for (const double on : on_face)
        if (on != 0) sharing *= 2;
      // The distance changes by no more than the way: most particles are told by another's, or by that of the middle of their eighth,
      // to be too far outside.
      const double too_far = sharing * largest_half + ahead_;
      double at_least = last_distance - length(minus(x, last));
      if (at_least > too_far) continue;
      if (const int e = owner < 0 ? -1 : eighths.of(x); e >= 0) {
        if (looked[e] == 0)
          looked[e] = nearest_of_owner(model_, workspace_, owner, eighths.middle(e), eighths.radius() + (0.5 + deepest) * h,
                                       from_middle[e], &hint) ? 1 : -1;
        if (looked[e] < 0) continue;
        at_least = std::max(at_least, from_middle[e].distance - length(minus(x, eighths.middle(e))));
        if (at_least > too_far) continue;
      }
      const double half = 0.5 * std::cbrt(sharing * mass * inverse_density * std::min(body.volume_ratio[p], 1.0));
      // Farther away than what is watched, it is outside, unless it may be deep inside.
      SurfacePoint found;
      const double watched = half + ahead_;
      if (!nearest_of_owner(model_, workspace_, owner, x, watched, found, &hint)) {
        if (at_least >= -watched || !nearest_of_owner(model_, workspace_, owner, x, half + deepest * h, found, &hint)) continue;
      }
      last = x;
      last_distance = found.distance;
      const std::int64_t particle = state_.bodies[link.body].lagrangian ? body.number[p] : p;
      offer(link.body, owner, x, found, found.distance - half, on_face, particle, -1, points);
    }
  }

  void offer(std::int32_t body, std::int32_t owner, const Vector3& x, const SurfacePoint& found, double gap, const Vector3& on_face,
             std::int64_t particle, std::int32_t vertex, std::vector<ContactPoint>& points) const {
    if (gap > ahead_) return;
    const ContactRule& rule = owner < 0 ? model_.walls[-1 - owner].rule : model_.rule_of(body, owner);
    ContactPoint point;
    point.method = &contact_method(rule.method);
    if (point.method->has_friction) point.friction = rule.friction;
    point.gap = std::max(gap, 0.0);
    point.normal = times(-1, found.normal);
    for (int axis = 0; axis < 3; ++axis)
      if (on_face[axis] != 0) {
        point.normal[axis] = 0;
        point.part *= 0.5;
      }
    if (!make_unit(point.normal)) return;
    point.particle = particle;
    point.vertex = vertex;
    point.triangle = found.triangle;
    point.a.body = body;
    point.a.at = x;
    point.b.body = owner;
    point.b.at = minus(x, times(found.distance, found.normal));
    points.push_back(point);
  }

  const Model& model_;
  const State& state_;
  const Workspace& workspace_;
  const double ahead_;
};

// ------------------------------------------------------------------------------------------------------------- solving

bool on_reference_grid(const Workspace& workspace, std::int32_t node) {
  return static_cast<std::size_t>(node) >= workspace.nodes.size();
}

NodeRecord& node_record(Workspace& workspace, std::int32_t node) {
  return on_reference_grid(workspace, node) ? workspace.reference_grid->nodes[node - workspace.nodes.size()]
                                            : workspace.nodes[node];
}

// {-1, 0, 1} for x, y and z, and 1 for the mass beside: 9 x + 3 y + z, each from 0.
struct Signs {
  alignas(32) double of[27][4];
  constexpr Signs() : of() {
    for (int i = 0; i < 27; ++i)
      for (int c = 0; c < 4; ++c) of[i][c] = c == 0 ? i / 9 - 1 : c == 1 ? i / 3 % 3 - 1 : c == 2 ? i % 3 - 1 : 1;
  }
};
constexpr Signs signs{};

// One phase: on the mapped velocities, or on the trial velocities.
class Phase {
 public:
  Phase(const State& state, Workspace& workspace, std::vector<RigidMotion>& rigid, bool at_end, StartUse use, double dt)
      : state_(state), workspace_(workspace), rigid_(rigid), at_end_(at_end), use_(use), dt_(dt) {}

  void solve() {
    std::vector<ContactPoint*> acting;
    double scale = 0;
    for (ContactPoint& point : workspace_.points.points) {
      if (!decide(point)) continue;
      acting.push_back(&point);
      scale = std::max(scale, length(point.found));
    }
    if (acting.empty()) return;
    find_mobilities(acting);
    if (!at_end_)
      for (ContactPoint* point : acting) remember(point->a), remember(point->b);
    gather(acting);
    double pace = 1;  // of the acceleration
    for (int pass = 0; pass < most_passes; ++pass) {
      double worst = 0, uphill = 0;
      for (Row& row : rows_) {
        const Vector3 approach = minus(velocity(row.a), velocity(row.b));
        const Vector3 slope = minus(approach, times(row.target, row.normal));
        const Vector3 next = allowed(row, minus(row.ahead, times(row.inverse_mobility, slope)));
        const Vector3 step = minus(next, row.ahead);
        row.change = minus(next, row.impulse);
        uphill -= row.mobility * dot(step, row.change);
        // What the velocities still ask for. (`change` has the pace too, which goes on where impulses move and no velocity does.)
        worst = std::max(worst, row.mobility * row.mobility * dot(step, step));
        row.impulse = next;
      }
      const bool done = worst <= pass_tolerance * pass_tolerance * scale * scale || pass + 1 == most_passes;
      const double next_pace = uphill > 0 ? 1 : 0.5 * (1 + std::sqrt(1 + 4 * pace * pace));
      const double part = done || uphill > 0 ? 0 : (pace - 1) / next_pace;
      pace = next_pace;
      for (Row& row : rows_) {
        const Vector3 ahead = plus(row.impulse, times(part, row.change));
        const Vector3 more = minus(ahead, row.ahead);
        row.ahead = ahead;
        if (more == Vector3{}) continue;
        give(row.a, more);
        give(row.b, times(-1, more));
      }
      if (done) break;
    }
    for (std::size_t i = 0; i < acting.size(); ++i) acting[i]->impulse = rows_[i].impulse;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      double* const v = velocity_record(node_of_[i]);
      for (int c = 0; c < 3; ++c) v[c] = nodes_[i].v[c];
      workspace_.points.place[node_of_[i]] = 0;
    }
  }

  NodeRecord& record(std::int32_t node) const { return node_record(workspace_, node); }

  // Total Lagrangian bodies have no later mapping: theirs is the velocity at the end.
  double* velocity_record(std::int32_t node) const {
    const bool end = at_end_ || (use_ == StartUse::Strain && on_reference_grid(workspace_, node));
    return end ? record(node).f : record(node).v;
  }

  Vector3 velocity(const PointSide& side) const {
    if (side.rigid >= 0) return rigid_[side.rigid].velocity_at(side.at);
    Vector3 v{};
    for (std::int32_t e = side.first; e < side.first + side.count; ++e) {
      const PointNode& entry = workspace_.points.stencils[e];
      const double* node = velocity_record(entry.node);
      for (int c = 0; c < 3; ++c) v[c] += entry.weight[c] * node[c];
    }
    return v;
  }

  Vector3 relative(const ContactPoint& point) const { return minus(velocity(point.a), velocity(point.b)); }

  // The mean in the step of what the second phase's impulses work on, as contact.cpp's measure_work: of the velocities at the
  // beginning and the end, of rigid bodies before and after contact.
  Vector3 mean(const ContactPoint& point) const {
    const auto of = [&](const PointSide& side) {
      Vector3 v{};
      for (std::int32_t e = side.first; e < side.first + side.count; ++e) {
        const PointNode& entry = workspace_.points.stencils[e];
        const NodeRecord& node = record(entry.node);
        for (int c = 0; c < 3; ++c) v[c] += 0.5 * entry.weight[c] * (node.v[c] + node.f[c]);
      }
      if (side.rigid < 0) return v;
      return times(0.5, plus(side.before, velocity(side)));
    };
    return plus(minus(of(point.a), of(point.b)), point.kept);
  }

 private:
  // What the passes read and write, over and over: close together. Weights differ by component in sign alone.
  struct alignas(32) Node {
    double v[3], inverse_mass;
  };
  struct Entry {
    double share;
    std::int32_t node, signs;  // of nodes_; of `signs`
  };
  struct Side {
    std::int32_t first = 0, count = 0;  // in entries_
    std::int32_t rigid = -1;
    bool fixed = false;
    Vector3 at{};
  };
  struct Row {
    Side a, b;
    Vector3 normal{};
    double target = 0, mobility = 0, inverse_mobility = 0, friction = 0, start_push = 0;
    Hold hold = Hold::Nothing;
    Vector3 impulse{}, ahead{}, change{};  // on a; the impulse that the velocities have now, and the last change of `impulse`
  };

  void gather(const std::vector<ContactPoint*>& acting) {
    rows_.clear();
    entries_.clear();
    nodes_.clear();
    node_of_.clear();
    const auto side_of = [&](const PointSide& side) {
      Side own;
      own.rigid = side.rigid;
      own.fixed = side.fixed;
      own.at = side.at;
      own.first = static_cast<std::int32_t>(entries_.size());
      for (std::int32_t e = side.first; e < side.first + side.count; ++e) {
        const PointNode& from = workspace_.points.stencils[e];
        const double share = share_of(from);
        if (share == 0) continue;
        std::int32_t& place = workspace_.points.place[from.node];
        if (place == 0) {
          const double* const v = velocity_record(from.node);
          nodes_.push_back({{v[0], v[1], v[2]}, 1 / record(from.node).v[3]});
          node_of_.push_back(from.node);
          place = static_cast<std::int32_t>(nodes_.size());
        }
        std::int32_t sign = 0;
        for (const double w : from.weight) sign = 3 * sign + (w > 0) - (w < 0) + 1;
        entries_.push_back({share, place - 1, sign});
      }
      own.count = static_cast<std::int32_t>(entries_.size()) - own.first;
      return own;
    };
    for (const ContactPoint* point : acting) {
      Row row;
      row.a = side_of(point->a);
      row.b = side_of(point->b);
      row.normal = point->normal;
      row.target = point->constraint.target;
      row.mobility = point->mobility;
      row.inverse_mobility = 1 / point->mobility;
      row.friction = point->constraint.friction ? point->friction : 0;
      row.start_push = point->start_push;
      row.hold = point->constraint.hold;
      rows_.push_back(row);
    }
  }

  using Two = scalar::Vec<2>;

  Vector3 velocity(const Side& side) const {
    if (side.rigid >= 0) return rigid_[side.rigid].velocity_at(side.at);
    Two xy{}, z{};  // the second of z is nothing
    for (std::int32_t e = side.first; e < side.first + side.count; ++e) {
      const Entry& entry = entries_[e];
      const double *const v = nodes_[entry.node].v, *const sign = signs.of[entry.signs];
      xy += scalar::load_aligned<Two>(sign) * entry.share * scalar::load_aligned<Two>(v);
      z += scalar::load_aligned<Two>(sign + 2) * entry.share * scalar::load_aligned<Two>(v + 2);
    }
    return {xy[0], xy[1], z[0]};
  }

  void give(const Side& side, Vector3 impulse) {
    if (side.fixed) return;
    if (side.rigid >= 0) {
      RigidMotion& body = rigid_[side.rigid];
      Vector3 moment = cross(minus(side.at, body.centre), impulse);
      push(body, impulse, moment);
      return;
    }
    const Two push_xy = {impulse[0], impulse[1]}, push_z = {impulse[2], 0};
    for (std::int32_t e = side.first; e < side.first + side.count; ++e) {
      const Entry& entry = entries_[e];
      Node& node = nodes_[entry.node];
      double* const v = node.v;
      const double *const sign = signs.of[entry.signs], by = node.inverse_mass;
      scalar::store_aligned(v, scalar::load_aligned<Two>(v) + scalar::load_aligned<Two>(sign) * entry.share * push_xy * by);
      // Adds 0 to the inverse mass.
      scalar::store_aligned(v + 2, scalar::load_aligned<Two>(v + 2) + scalar::load_aligned<Two>(sign + 2) * entry.share * push_z * by);
    }
  }

  static double share_of(const PointNode& entry) {
    return std::max({std::abs(entry.weight[0]), std::abs(entry.weight[1]), std::abs(entry.weight[2])});
  }

  // mobility of a point: the velocity that a unit impulse gives there, were the mass of each node and rigid body shared
  // between the points in proportion to their part in it. With these no set of impulses, taken at once, gains energy.
  void find_mobilities(const std::vector<ContactPoint*>& acting) {
    ContactPoints& points = workspace_.points;
    std::vector<double> rigid_share(rigid_.size(), 0.0);
    for (const ContactPoint* point : acting)
      for (const PointSide* side : {&point->a, &point->b}) {
        if (side->rigid >= 0) rigid_share[side->rigid] += point->part;
        for (std::int32_t e = side->first; e < side->first + side->count; ++e)
          points.share[points.stencils[e].node] += point->part * share_of(points.stencils[e]);
      }
    for (ContactPoint* point : acting) {
      point->mobility = 0;
      for (const PointSide* side : {&point->a, &point->b}) {
        if (side->fixed) continue;
        if (side->rigid >= 0) {
          const RigidMotion& body = rigid_[side->rigid];
          const Vector3 r = minus(side->at, body.centre);
          point->mobility += body.images * (1 / body.mass + dot(r, r) * body.largest_inverse_inertia) *
                             rigid_share[side->rigid] / point->part;
          continue;
        }
        for (std::int32_t e = side->first; e < side->first + side->count; ++e) {
          const std::int32_t node = points.stencils[e].node;
          point->mobility += share_of(points.stencils[e]) * points.share[node] / (point->part * record(node).v[3]);
        }
      }
    }
    for (const ContactPoint* point : acting)
      for (const PointSide* side : {&point->a, &point->b})
        for (std::int32_t e = side->first; e < side->first + side->count; ++e) points.share[points.stencils[e].node] = 0;
  }

  // The nearest impulse on a that the point's constraint allows: pushes only, within the friction cone.
  static Vector3 allowed(const Row& row, const Vector3& impulse) {
    double push = -dot(impulse, row.normal);
    Vector3 along = plus(impulse, times(push, row.normal));
    if (row.hold == Hold::Contact) push = std::max(push, 0.0);
    if (row.hold != Hold::Stick) {
      const double most = row.friction * (std::max(push, 0.0) + row.start_push);
      const double size = length(along);
      along = size > most ? times(size > 0 ? most / size : 0, along) : along;
    }
    return minus(along, times(push, row.normal));
  }

  bool decide(ContactPoint& point) {
    point.found = relative(point);
    for (PointSide* side : {&point.a, &point.b})
      if (side->rigid >= 0) side->before = velocity(*side);
    point.impulse = {};
    point.constraint = {};
    const auto by_grid = [](const PointSide& side) { return side.rigid < 0 && !side.lagrangian && side.count > 0; };
    const bool strains = by_grid(point.a) || by_grid(point.b);
    const bool acts = at_end_ || (strains && (use_ != StartUse::Motion || !point.method->start_reaches_particles));
    const auto rule = at_end_ ? point.method->at_end : point.method->at_start;
    if (!rule || !acts) return false;
    PairView view{point.normal,   {point.normal, times(-1, point.normal)}, point.mapped, point.adjusted, point.found,
                  point.pressed, 0};
    if (!at_end_) view.mapped = view.adjusted = point.found;
    if (point.method->needs_stress && point.a.rigid < 0 && point.particle >= 0) {
      const BodyState& body = state_.bodies[point.a.body];
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        view.normal_stress += body.stress[i][point.particle] * point.normal[i] * point.normal[i] +
                              2 * body.stress[3 + i][point.particle] * point.normal[j] * point.normal[k];
      }
    }
    point.constraint = rule(view);
    if (point.constraint.hold == Hold::Nothing) return false;
    // What is still apart may meet within the step; what holds a pair both ways waits for that.
    if (point.constraint.hold == Hold::Contact)
      point.constraint.target += point.gap / dt_;
    else if (point.gap > 0 && dot(point.found, point.normal) * dt_ < point.gap)
      point.constraint.hold = Hold::Nothing;
    return point.constraint.hold != Hold::Nothing;
  }

  // The velocities of a side's nodes before the phase.
  void remember(const PointSide& side) {
    ContactPoints& points = workspace_.points;
    for (std::int32_t e = side.first; e < side.first + side.count; ++e) {
      const std::int32_t node = points.stencils[e].node;
      if (points.seen[node]) continue;
      const double* v = velocity_record(node);
      points.changes.push_back({node, {v[0], v[1], v[2]}});
      points.seen[node] = static_cast<std::int32_t>(points.changes.size());
    }
  }

  const State& state_;
  Workspace& workspace_;
  std::vector<RigidMotion>& rigid_;
  const bool at_end_;
  const StartUse use_;
  const double dt_;
  std::vector<Row> rows_;  // in the order of the acting points
  std::vector<Entry> entries_;
  std::vector<Node> nodes_;
  std::vector<std::int32_t> node_of_;  // in the workspace
};

double push_of(const ContactPoint& point) { return -dot(point.impulse, point.normal); }

// What mirror faces take of an impulse on the side: the images' part and what is across the face.
void book_faces(State& state, const Workspace& workspace, const PointSide& side, const Vector3& impulse) {
  if (side.count == 0) return;
  Vector3 sum{};
  for (std::int32_t e = side.first; e < side.first + side.count; ++e) add(sum, workspace.points.stencils[e].weight);
  for (int c = 0; c < 3; ++c) state.ledger.boundary_impulse[c] += (sum[c] - 1) * impulse[c];
}

// What a phase passed from one to another, as forces on bodies and pairs, in the ledger, and on rigid bodies.
// grid_part: of a particle's velocity that is the grid's, which has seen what the first phase kept from the rest.
void book(State& state, Workspace& workspace, const Phase& phase, bool at_end, double grid_part, double dt) {
  for (ContactPoint& point : workspace.points.points) {
    if (point.constraint.hold == Hold::Nothing) continue;
    const Vector3& impulse = point.impulse;
    const bool reaches = at_end || point.method->start_reaches_particles;
    const Vector3 mean = at_end ? phase.mean(point) : Vector3{};  // the work of both phases is booked at the end
    const double tangential_work = dot(plus(impulse, times(push_of(point), point.normal)), mean);
    const bool heat = point.constraint.hold != Hold::Stick;
    const double friction = heat ? -tangential_work : 0;
    const double work = (heat ? 0 : tangential_work) - (push_of(point) + point.start_push) * dot(point.normal, mean);
    state.ledger.friction_dissipation += friction;
    state.ledger.contact_work += work;
    if (at_end && point.booked) {
      // As at nodes, contact.cpp: an impulse does the work of the mean of the velocities half a step before and after it.
      const Vector3 about = times(0.5, plus(point.mapped, phase.relative(point)));
      state.ledger.contact_dissipation -= dot(impulse, about) + friction;
    }
    for (const PointSide* side : {&point.a, &point.b}) {
      const Vector3 own = times(side == &point.a ? 1 : -1, impulse);
      if (!reaches) {
        const Vector3 seen = times(grid_part, own), unseen = times(1 - grid_part, own);
        if (side->body < 0) add(state.ledger.boundary_impulse, times(-1, seen));
        book_faces(state, workspace, *side, seen);
        if (side->rigid < 0) continue;
        RigidMotion& body = workspace.rigid[side->rigid];
        add(body.impulse, seen);
        if (body.prescribed)
          body.contact_work += dot(seen, side->before);
        else if (side == &point.b)
          add(state.ledger.contact_couple, cross(minus(point.b.at, point.a.at), seen));
        add(body.kept_impulse, unseen);
        add(body.kept_moment, cross(minus(side->at, body.centre), unseen));
        continue;
      }
      if (side->body < 0) {
        for (int c = 0; c < 3; ++c) state.ledger.boundary_impulse[c] -= own[c];
        continue;
      }
      book_faces(state, workspace, *side, own);
      if (at_end) {  // with the push of the first phase, which book_contact_forces has not kept
        const double started = side == &point.a ? -point.start_push : point.start_push;
        add(state.bodies[side->body].totals.contact_force, times(1 / dt, plus(own, times(started, point.normal))));
      }
      if (side->rigid < 0) continue;
      RigidMotion& body = workspace.rigid[side->rigid];
      add(body.impulse, own);
      if (body.prescribed)
        body.contact_work += dot(own, body.velocity_at(side->at));
      else if (side == &point.b)
        add(state.ledger.contact_couple, cross(minus(point.b.at, point.a.at), own));
    }
    if (point.b.body < 0 || impulse == Vector3{}) continue;
    const bool ordered = point.a.body < point.b.body;
    PairTotals& pair = pair_totals(state, std::min(point.a.body, point.b.body), std::max(point.a.body, point.b.body));
    if (reaches) {
      add(pair.force, times((ordered ? 1 : -1) / dt, impulse));
      add(pair.impulse, times(ordered ? 1 : -1, impulse));
    }
    pair.friction_dissipation += friction;
    pair.contact_work += work;
  }
}

// A particle's or vertex's memory of contact stands beside those of nodes.
std::array<std::int32_t, 3> memory_of(const State& state, const ContactPoint& point) {
  constexpr std::int32_t beside = std::numeric_limits<std::int32_t>::min();
  if (point.vertex >= 0) return {point.vertex, beside, 1};
  return {state.bodies[point.a.body].number[point.particle], beside, 0};
}

}  // namespace

std::int64_t ContactPoints::memory_bytes() const {
  const auto bytes = [](const auto& v) { return static_cast<std::int64_t>(v.capacity() * sizeof(v[0])); };
  std::int64_t total = bytes(points) + bytes(stencils) + bytes(found) + bytes(pieces) + bytes(changes) + bytes(seen) + bytes(place) +
                       bytes(share) + bytes(start);
  for (const auto& list : found) total += bytes(list);
  return total;
}

bool met_at_points(const Model& model, std::int32_t a, std::int32_t b) {
  const ContactRule& rule = b < 0 ? model.walls[-1 - b].rule : model.rule_of(a, b);
  if (!by_surface(rule)) return false;
  const auto rigid = [&](std::int32_t body) { return body < 0 || (model.bodies[body].rigid() && model.bodies[body].has_surface()); };
  return !(rigid(a) && rigid(b));
}

void find_points(const Model& model, const State& state, Workspace& workspace) {
  ContactPoints& points = workspace.points;
  points.points.clear();
  points.stencils.clear();
  points.start.clear();
  const std::size_t nodes = workspace.nodes.size() + (workspace.reference_grid ? workspace.reference_grid->nodes.size() : 0);
  points.seen.resize(nodes);
  points.place.resize(nodes);
  points.share.resize(nodes);
  points.pieces.clear();
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (!state.bodies[b].lagrangian || !workspace.surfaces[b].used) continue;
    const std::size_t vertices = state.bodies[b].surface_vertices.size() / 3;
    for (std::size_t v = 0; v < vertices; v += vertices_at_once)
      points.pieces.push_back({static_cast<std::int32_t>(b), v, std::min(v + vertices_at_once, vertices)});
  }
  points.found.resize(workspace.links.size() + points.pieces.size());
  const Feeler feeler(model, state, workspace);
  std::exception_ptr failure;
  const std::int64_t links = static_cast<std::int64_t>(workspace.links.size());
  const std::int64_t parts = static_cast<std::int64_t>(points.found.size());
#pragma omp parallel for num_threads(workspace.threads) schedule(dynamic, 8) if (parts > 8)
  for (std::int64_t i = 0; i < parts; ++i) try {
      if (i < links)
        feeler.feel(workspace.links[i], workspace.kernel_groups[i], points.found[i]);
      else
        feeler.feel(points.pieces[i - links], points.found[i]);
    } catch (...) {
#pragma omp critical(ogive_points_failure)
      failure = std::current_exception();
    }
  if (failure) std::rethrow_exception(failure);
  std::vector<std::int32_t> rigid_of(model.bodies.size(), -1);
  for (std::size_t r = 0; r < workspace.rigid.size(); ++r)
    rigid_of[workspace.rigid[r].body] = static_cast<std::int32_t>(r);
  const Stenciler stenciler(model, workspace);
  const Stenciler at_rest(model, workspace.reference_grid ? *workspace.reference_grid : workspace);
  const auto on_reference = [&](PointSide& side) {
    side.count = static_cast<std::int32_t>(points.stencils.size()) - side.first;
    for (std::int32_t e = side.first; e < side.first + side.count; ++e)
      points.stencils[e].node += static_cast<std::int32_t>(workspace.nodes.size());
  };
  const auto make = [&](ContactPoint& point, PointSide& side) {
    side.first = static_cast<std::int32_t>(points.stencils.size());
    if (!side.lagrangian) {
      stenciler.make(model.field_of(side.body), side.at, &side == &point.b, points.stencils);
      side.count = static_cast<std::int32_t>(points.stencils.size()) - side.first;
      return;
    }
    const PlacedSurface& placed = workspace.surfaces[side.body];
    if (&side == &point.a && point.vertex >= 0) {
      const auto first = point.vertex == 0 ? 0 : placed.vertex_ends[point.vertex - 1];
      points.stencils.insert(points.stencils.end(), placed.vertex_nodes.begin() + first,
                             placed.vertex_nodes.begin() + placed.vertex_ends[point.vertex]);
    } else if (&side == &point.a) {
      const double* X = &state.bodies[side.body].reference.position[4 * point.particle];
      at_rest.make(side.body, {X[0], X[1], X[2]}, false, points.stencils);
    } else {
      const std::vector<double>& rest = model.bodies[side.body].surface.vertices;
      const Surface::Corners corners = placed.surface.corners_at(point.triangle, side.at);
      Vector3 X{}, inward{};
      for (int k = 0; k < 3; ++k) {
        const std::int32_t v = corners.vertex[k];
        add(X, times(corners.share[k], {rest[3 * v], rest[3 * v + 1], rest[3 * v + 2]}));
        add(inward, times(corners.share[k], placed.vertex_inward[v]));
      }
      at_rest.make_linear(side.body, X, plus(X, inward), points.stencils);
    }
    on_reference(side);
  };
  const Phase phase(state, workspace, workspace.rigid, false, StartUse::Motion, 1);
  for (const auto& list : points.found)
    for (ContactPoint point : list) {
      for (PointSide* side : {&point.a, &point.b}) {
        side->rigid = side->body < 0 ? -1 : rigid_of[side->body];
        side->lagrangian = side->body >= 0 && state.bodies[side->body].lagrangian;
        side->fixed = side->body < 0 || (side->rigid >= 0 && workspace.rigid[side->rigid].prescribed);
      }
      if (point.a.fixed && point.b.fixed) continue;
      if (point.a.rigid < 0) make(point, point.a);
      if (point.b.body >= 0 && point.b.rigid < 0) make(point, point.b);
      const auto strains = [](const PointSide& side) { return side.body >= 0 && side.rigid < 0 && !side.lagrangian; };
      point.booked = (point.a.lagrangian || point.b.lagrangian) && !strains(point.a) && !strains(point.b);
      if (point.booked) point.mapped = phase.relative(point);
      if (point.method->remembers)
        point.pressed = remembers(state.contact_memory, memory_of(state, point), point.a.body, point.b.body);
      points.points.push_back(point);
    }
}

void start_points(const Model& model, State& state, Workspace& workspace, std::vector<RigidMotion>& rigid, double dt, StartUse use) {
  ContactPoints& points = workspace.points;
  Phase phase(state, workspace, rigid, false, use, dt);
  points.changes.clear();
  phase.solve();
  const auto reaches = [](const ContactPoint& point) { return point.method->start_reaches_particles; };
  for (ContactPoint& point : points.points) {
    if (!point.booked) point.mapped = point.found;
    point.adjusted = phase.relative(point);
    // As at nodes: without a first phase of its own it is shown what that would have left.
    if (point.booked && point.method->at_start && !reaches(point))
      add(point.adjusted, times(-std::max(dot(point.adjusted, point.normal), 0.0), point.normal));
    if (use != StartUse::Strain && point.constraint.hold != Hold::Nothing && reaches(point))
      point.start_push = std::max(push_of(point), 0.0);
  }
  if (use == StartUse::Strain) {
    for (const ContactPoints::Change& change : points.changes) {
      points.seen[change.node] = 0;
      if (on_reference_grid(workspace, change.node))
        std::copy(change.before.begin(), change.before.end(), node_record(workspace, change.node).f);
    }
    return;
  }
  // The part of each node's change that never reaches the particles, from the impulses of the methods that want it so.
  points.start.clear();
  for (const ContactPoints::Change& change : points.changes) points.start.push_back({change.node, {}, {}});
  for (const ContactPoint& point : points.points) {
    if (point.constraint.hold == Hold::Nothing || reaches(point)) continue;
    const Vector3& impulse = point.impulse;
    for (const PointSide* side : {&point.a, &point.b})
      for (std::int32_t e = side->first; e < side->first + side->count; ++e) {
        const PointNode& entry = points.stencils[e];
        if (!points.seen[entry.node]) continue;
        ContactPoints::Start& start = points.start[points.seen[entry.node] - 1];
        const double factor = (side == &point.a ? -1 : 1) / node_record(workspace, entry.node).v[3];
        for (int c = 0; c < 3; ++c) start.kept[c] += factor * entry.weight[c] * impulse[c];
      }
  }
  for (ContactPoint& point : points.points)
    for (const PointSide* side : {&point.a, &point.b})
      for (std::int32_t e = side->first; e < side->first + side->count; ++e) {
        const PointNode& entry = points.stencils[e];
        if (!points.seen[entry.node]) continue;
        const Vector3& kept = points.start[points.seen[entry.node] - 1].kept;
        for (int c = 0; c < 3; ++c) point.kept[c] += (side == &point.a ? 1 : -1) * entry.weight[c] * kept[c];
      }
  const double grid_part = model.numerics.renewed_fraction();
  std::size_t common = 0;
  for (std::size_t i = 0; i < points.changes.size(); ++i) {
    const ContactPoints::Change& change = points.changes[i];
    ContactPoints::Start& start = points.start[i];
    NodeRecord& node = node_record(workspace, change.node);
    points.seen[change.node] = 0;
    if (on_reference_grid(workspace, change.node)) {
      // Its velocity at the beginning stays; the motion sees the change, and what particles never see is then taken back.
      for (int c = 0; c < 3; ++c) {
        node.f[c] += node.v[c] - change.before[c];
        node.v[c] = change.before[c];
      }
      workspace.lagrangian_contact.keep(change.node - static_cast<std::int64_t>(workspace.nodes.size()),
                                        times(-(1 - grid_part), start.kept));
      continue;
    }
    for (int c = 0; c < 3; ++c) start.returned[c] = change.before[c] - node.v[c] - start.kept[c];
    points.start[common++] = start;
  }
  points.start.resize(common);
  book(state, workspace, phase, false, grid_part, dt);
}

void return_start_points(Workspace& workspace) {
  for (const ContactPoints::Start& start : workspace.points.start)
    for (int c = 0; c < 3; ++c) workspace.nodes[start.node].v[c] += start.returned[c];
}

void end_points(State& state, Workspace& workspace, double dt) {
  workspace.lagrangian_contact.give_total(workspace);
  Phase phase(state, workspace, workspace.rigid, true, StartUse::MotionAndStrain, dt);
  phase.solve();
  book(state, workspace, phase, true, 0, dt);
  for (const ContactPoint& point : workspace.points.points)
    if (point.method->remembers && push_of(point) > 0)
      remember(state.contact_memory, memory_of(state, point), point.a.body, point.b.body);
}

void begin_held_points(const State& state, Workspace& workspace) {
  const Phase phase(state, workspace, workspace.rigid, true, StartUse::MotionAndStrain, 1);
  for (ContactPoint& point : workspace.points.points)
    if (point.booked) point.unheld = phase.relative(point);
}

void book_held_points(State& state, Workspace& workspace) {
  const Phase phase(state, workspace, workspace.rigid, true, StartUse::MotionAndStrain, 1);
  for (const ContactPoint& point : workspace.points.points)
    if (point.booked && point.constraint.hold != Hold::Nothing)
      state.ledger.contact_dissipation -= 0.5 * dot(point.impulse, minus(phase.relative(point), point.unheld));
}

}  // namespace ogive
