// See debris.hpp.
#include "debris.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "block_table.hpp"
#include "parallel.hpp"

namespace ogive {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Where something is, and the velocities that any of it may have from now on.
struct Box {
  Vector3 lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity};
  Vector3 slowest = lower, fastest = upper;

  bool operator==(const Box&) const = default;
  void take_place(const double* x) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], x[axis]);
      upper[axis] = std::max(upper[axis], x[axis]);
    }
  }
  void take_velocity(const double* v) {
    for (int axis = 0; axis < 3; ++axis) {
      slowest[axis] = std::min(slowest[axis], v[axis]);
      fastest[axis] = std::max(fastest[axis], v[axis]);
    }
  }
  void take(const Box& other) {
    take_place(other.lower.data());
    take_place(other.upper.data());
    take_velocities(other);
  }
  void take_velocities(const Box& other) {
    take_velocity(other.slowest.data());
    take_velocity(other.fastest.data());
  }
};

// Whether the boxes may be nearer to each other than `distance` along every axis at one time before `until`. Along an axis each
// of the two gaps, of which one must be wide, changes at least at a certain rate: it is too narrow before or after some time.
bool may_meet(const Box& a, const Box& b, double distance, double until) {
  double begin = 0, end = until;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const Box &low = side == 0 ? a : b, &high = side == 0 ? b : a;
      const double wanting = distance - (high.lower[axis] - low.upper[axis]);
      const double rate = high.slowest[axis] - low.fastest[axis];
      if (rate > 0) end = std::min(end, wanting / rate);
      else if (rate < 0) begin = std::max(begin, wanting / rate);
      else if (wanting <= 0) return false;
    }
  return begin < end;
}

// Nearest that the box may come to the plane normal . x = level, which it is in front of, before `until`.
double nearest_to_plane(const Box& box, const Vector3& normal, double level, double until) {
  double distance = -level, rate = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const bool up = normal[axis] > 0;
    if (normal[axis] == 0) continue;
    distance += normal[axis] * (up ? box.lower : box.upper)[axis];
    rate += normal[axis] * (up ? box.slowest : box.fastest)[axis];
  }
  return rate < 0 ? distance + rate * until : distance;
}

// Mirrors and walls as planes in front of which all lies, with the distance that is to be kept.
struct Plane {
  Vector3 normal{};
  double level = 0, distance = 0;
};

std::vector<Plane> planes_of(const Model& model) {
  const Grid& grid = model.grid;
  const double distance = debris_distance * grid.cell_size;
  std::vector<Plane> planes;
  for (const Wall& wall : model.walls) planes.push_back({wall.normal, dot(wall.normal, wall.point), distance});
  for (int axis = 0; axis < (grid.planar() ? 2 : 3); ++axis)
    for (int side = 0; side < 2; ++side) {
      if (grid.face[2 * axis + side] == Face::Free) continue;
      Plane plane;
      plane.normal[axis] = side == 0 ? 1 : -1;
      plane.level = side == 0 ? grid.domain_min[axis] : -grid.domain_max[axis];
      plane.distance = 0.5 * distance;
      planes.push_back(plane);
    }
  return planes;
}

// When the last of it has left the domain by a free face, at the latest.
double time_of_leaving(const Grid& grid, const Box& box) {
  double time = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.face[2 * axis] == Face::Free && box.fastest[axis] < 0)
      time = std::min(time, (grid.domain_min[axis] - box.upper[axis]) / box.fastest[axis]);
    if (grid.face[2 * axis + 1] == Face::Free && box.slowest[axis] > 0)
      time = std::min(time, (grid.domain_max[axis] - box.lower[axis]) / box.slowest[axis]);
  }
  return std::max(time, 0.0);
}

// Whether it may come nearer than `distance` to the space, which does not move, before `until`.
bool may_reach(const Box& box, const Space& space, double distance, double until) {
  if (space.region == Region::Everywhere) return true;
  if (space.region == Region::Box) {
    Box held;
    held.take_place(space.a.data());
    held.take_place(space.b.data());
    held.slowest = held.fastest = {};
    return may_meet(box, held, distance, until);
  }
  // The distance of a corner from the axis is convex in time: it is largest at the beginning or at the end.
  for (const double time : {0.0, until})
    for (int corner = 0; corner < 8; ++corner) {
      Vector3 x;
      for (int axis = 0; axis < 3; ++axis)
        x[axis] = corner >> axis & 1 ? box.upper[axis] + box.fastest[axis] * time : box.lower[axis] + box.slowest[axis] * time;
      const Vector3 from = minus(x, space.a);
      const Vector3 across = minus(from, times(dot(from, space.b) / dot(space.b, space.b), space.b));
      if (!(length(across) + distance <= space.radius)) return true;
    }
  return false;
}

// Particles of one body in one block.
struct Piece {
  std::int32_t body = 0, group = 0;
  bool held = false;  // a load or force acts on some of them, or their body is not to lose any
  Box box;
  double mass = 0;
  Vector3 momentum{};
};

// A part: pieces that are near each other.
struct Part {
  Box box;
  double mass = 0;
  Vector3 momentum{};
  bool debris = true;
};

bool loses_none(const Model& model, const Workspace& workspace, int body) {
  return workspace.contact_needs.surface && model.bodies[body].has_surface();
}

std::vector<Piece> pieces_of(const Model& model, const State& state, const Workspace& workspace) {
  std::vector<Piece> pieces;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    if (model.bodies[b].rigid() || state.bodies[b].lagrangian) continue;
    for (std::size_t g = 0; g < state.bodies[b].groups.size(); ++g) {
      Piece piece;
      piece.body = static_cast<std::int32_t>(b);
      piece.group = static_cast<std::int32_t>(g);
      piece.held = loses_none(model, workspace, piece.body);
      pieces.push_back(piece);
    }
  }
  for_each_in_parts(workspace.threads, 0, static_cast<std::int64_t>(pieces.size()), [&](std::int64_t i) {
    Piece& piece = pieces[static_cast<std::size_t>(i)];
    const BodyState& body = state.bodies[piece.body];
    const Group& group = body.groups[piece.group];
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
      const double *x = &body.position[4 * p], *v = &body.velocity[4 * p];
      piece.box.take_place(x);
      piece.box.take_velocity(v);
      piece.mass += x[3];
      for (int c = 0; c < 3; ++c) piece.momentum[c] += x[3] * v[c];
      piece.held = piece.held || (!body.loads.empty() && body.loads[p] != 0);
      for (int c = 0; c < 3 && !body.force.empty(); ++c) piece.held = piece.held || body.force[4 * p + c] != 0;
    }
  });
  return pieces;
}

bool near(const Box& a, const Box& b, double distance) {
  for (int axis = 0; axis < 3; ++axis)
    if (a.lower[axis] - b.upper[axis] >= distance || b.lower[axis] - a.upper[axis] >= distance) return false;
  return true;
}

// The part that each piece belongs to, parts being numbered in the order of their first pieces.
std::vector<std::int32_t> join(const State& state, const std::vector<Piece>& pieces, double distance, std::int32_t& parts) {
  const std::int32_t count = static_cast<std::int32_t>(pieces.size());
  const auto block_of = [&](std::int32_t i) -> const std::array<std::int32_t, 3>& {
    return state.bodies[pieces[i].body].groups[pieces[i].group].block;
  };
  // Pieces of one block, of different bodies, in a chain.
  BlockTable table(pieces.size());
  std::vector<std::int32_t> next(pieces.size(), -1);
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t first = table.insert(block_key(block_of(i), 0), i);
    if (first == i) continue;
    next[i] = next[first];
    next[first] = i;
  }
  std::vector<std::int32_t> root(pieces.size());
  for (std::int32_t i = 0; i < count; ++i) root[i] = i;
  const auto root_of = [&](std::int32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  // Between blocks that are three apart lie eight cells, less what particles drift out of theirs.
  constexpr std::int32_t reach = 2;
  for (std::int32_t i = 0; i < count; ++i) {
    const auto& block = block_of(i);
    for (std::int32_t z = block[2] - reach; z <= block[2] + reach; ++z)
      for (std::int32_t y = block[1] - reach; y <= block[1] + reach; ++y)
        for (std::int32_t x = block[0] - reach; x <= block[0] + reach; ++x)
          for (std::int32_t j = table.find(block_key({x, y, z}, 0)); j >= 0; j = next[j]) {
            if (j <= i) continue;  // each pair once
            const std::int32_t a = root_of(i), b = root_of(j);
            if (a != b && near(pieces[i].box, pieces[j].box, distance)) root[std::max(a, b)] = std::min(a, b);
          }
  }
  std::vector<std::int32_t> part(pieces.size());
  parts = 0;
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t first = root_of(i);
    part[i] = first == i ? parts++ : part[first];
  }
  return part;
}

std::vector<Part> parts_of(const State& state, const std::vector<Piece>& pieces, const std::vector<std::int32_t>& part_of,
                           std::int32_t count) {
  std::vector<Part> parts(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Part& part = parts[part_of[i]];
    part.box.take(pieces[i].box);
    part.mass += pieces[i].mass;
    add(part.momentum, pieces[i].momentum);
    part.debris = part.debris && !pieces[i].held;
  }
  // Small against its bodies; the first of the largest parts of a body is what is left of it.
  std::vector<double> mass(parts.size(), 0.0);
  for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
    double all = 0;
    std::int32_t largest = part_of[begin];
    for (end = begin; end < pieces.size() && pieces[end].body == pieces[begin].body; ++end) {
      all += pieces[end].mass;
      mass[part_of[end]] += pieces[end].mass;
    }
    const BodyTotals& totals = state.bodies[pieces[begin].body].totals;
    all += totals.left.mass + totals.dropped.mass;
    for (std::size_t i = begin; i < end; ++i)
      if (mass[part_of[i]] > mass[largest]) largest = part_of[i];
    for (std::size_t i = begin; i < end; ++i)
      if (part_of[i] == largest || mass[part_of[i]] > debris_share * all) parts[part_of[i]].debris = false;
    for (std::size_t i = begin; i < end; ++i) mass[part_of[i]] = 0;
  }
  for (Part& part : parts) {
    if (!part.debris) continue;
    const Vector3 centre = times(1 / part.mass, part.momentum);
    Vector3 largest;
    for (int c = 0; c < 3; ++c) largest[c] = std::max(part.box.fastest[c] - centre[c], centre[c] - part.box.slowest[c]);
    const double spread = std::max(length(largest), 0.0);
    for (int c = 0; c < 3; ++c) {
      part.box.slowest[c] = centre[c] - spread;
      part.box.fastest[c] = centre[c] + spread;
    }
  }
  return parts;
}

// A rigid body: any velocity that its motion can have from now on.
Box rigid_box(const Model& model, const State& state, int index) {
  const Body& rules = model.bodies[index];
  const BodyState& body = state.bodies[index];
  const double half = 0.5 * std::sqrt(6 * rules.own_inertia);  // particles are cubes
  Box box;
  double radius = 0;
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
      const double* x = &body.position[4 * p];
      box.take_place(x);
      radius = std::max(radius, length(minus({x[0], x[1], x[2]}, body.rigid.centre)));
    }
  for (int c = 0; c < 3; ++c) {
    box.lower[c] -= half;
    box.upper[c] += half;
  }
  const auto moves = [&](const Vector3& v, const Vector3& spin) {
    const double turning = length(spin) * (radius + 2 * half);
    for (int c = 0; c < 3; ++c) {
      box.slowest[c] = std::min(box.slowest[c], v[c] - turning);
      box.fastest[c] = std::max(box.fastest[c], v[c] + turning);
    }
  };
  if (!rules.prescribed()) moves(body.rigid.velocity, body.rigid.spin);
  for (std::size_t k = 0; k < rules.motion.size(); ++k)
    if (k + 1 == rules.motion.size() || rules.motion[k + 1].time > state.time)
      moves(rules.motion[k].velocity, rules.motion[k].angular_velocity);
  return box;
}

Box lagrangian_box(const BodyState& body) {
  Box box;
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
      box.take_place(&body.position[4 * p]);
      box.take_velocity(&body.velocity[4 * p]);
    }
  return box;
}

// Largest size of each component of the velocities.
Vector3 most_of(const Box& box) {
  Vector3 most;
  for (int c = 0; c < 3; ++c) most[c] = std::max(std::abs(box.slowest[c]), std::abs(box.fastest[c]));
  return most;
}

// Those that may meet each other pass on their velocities, a plane turns them round.
void pass_on_velocities(std::vector<Box>& boxes, const std::vector<Plane>& planes, double distance) {
  std::vector<double> speed;  // an oblique plane may give any component the whole of it
  for (const Box& box : boxes) speed.push_back(length(most_of(box)));
  for (bool changed = true; changed;) {
    const std::vector<Box> before = boxes;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes.size(); ++j) {
        if (boxes[i].slowest == boxes[j].slowest && boxes[i].fastest == boxes[j].fastest) continue;
        if (!may_meet(boxes[i], boxes[j], distance, infinity)) continue;
        boxes[i].take_velocities(boxes[j]);
        boxes[j].take_velocities(boxes[i]);
        speed[i] = speed[j] = std::max(speed[i], speed[j]);
      }
      for (const Plane& plane : planes) {
        if (nearest_to_plane(boxes[i], plane.normal, plane.level, infinity) >= plane.distance) continue;
        const Vector3 most = most_of(boxes[i]);
        for (int c = 0; c < 3; ++c) {
          if (plane.normal[c] == 0) continue;
          const double turned = std::abs(plane.normal[c]) == 1 ? most[c] : speed[i];
          boxes[i].slowest[c] = std::min(boxes[i].slowest[c], -turned);
          boxes[i].fastest[c] = std::max(boxes[i].fastest[c], turned);
        }
      }
    }
    changed = boxes != before;
  }
}

}  // namespace

void drop_debris(const Model& model, State& state, Workspace& workspace) {
  if (model.numerics.gravity != Vector3{}) return;
  const double distance = debris_distance * model.grid.cell_size;
  const std::vector<Piece> pieces = pieces_of(model, state, workspace);
  std::int32_t count = 0;
  const std::vector<std::int32_t> part_of = join(state, pieces, distance, count);
  std::vector<Part> parts = parts_of(state, pieces, part_of, count);
  if (std::none_of(parts.begin(), parts.end(), [](const Part& part) { return part.debris; })) return;

  const std::vector<Plane> planes = planes_of(model);
  std::vector<Box> others;
  for (const Part& part : parts)
    if (!part.debris) others.push_back(part.box);
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    if (state.bodies[b].particles == 0) continue;
    if (model.bodies[b].rigid()) others.push_back(rigid_box(model, state, static_cast<int>(b)));
    if (state.bodies[b].lagrangian) others.push_back(lagrangian_box(state.bodies[b]));
  }
  pass_on_velocities(others, planes, distance);

  // Which bodies are in which part, for regions that hold one body alone.
  std::vector<std::vector<std::int32_t>> bodies(parts.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    auto& list = bodies[part_of[i]];
    if (list.empty() || list.back() != pieces[i].body) list.push_back(pieces[i].body);
  }
  const auto may_be_held = [&](std::int64_t i, const Space& space, std::int32_t body, double until) {
    const auto& list = bodies[i];
    const bool its = body < 0 || !model.own_fields || std::find(list.begin(), list.end(), body) != list.end();
    return its && may_reach(parts[i].box, space, distance, until);
  };
  std::vector<std::uint8_t> gone(parts.size(), 0);
  for_each_in_turn(workspace.threads, 0, count, [&](std::int64_t i) {
    const Part& part = parts[i];
    if (!part.debris) return;
    const double until = time_of_leaving(model.grid, part.box);
    for (const Plane& plane : planes)
      if (!(nearest_to_plane(part.box, plane.normal, plane.level, until) >= plane.distance)) return;
    for (const Clamp& clamp : model.clamps)
      if (may_be_held(i, clamp, clamp.body, until)) return;
    for (const Load& load : model.loads)
      if (!load.on_particles() && may_be_held(i, load, load.body, until)) return;
    for (const Box& other : others)
      if (may_meet(part.box, other, distance, until)) return;
    for (std::int64_t j = 0; j < count; ++j)
      if (j != i && parts[j].debris && may_meet(part.box, parts[j].box, distance, until)) return;
    gone[i] = 1;
  });

  for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
    std::vector<std::uint8_t> dropped;
    for (end = begin; end < pieces.size() && pieces[end].body == pieces[begin].body; ++end)
      dropped.push_back(gone[part_of[end]]);
    if (std::find(dropped.begin(), dropped.end(), 1) != dropped.end())
      drop_groups(model, state, workspace, pieces[begin].body, dropped);
  }
}

}  // namespace ogive
