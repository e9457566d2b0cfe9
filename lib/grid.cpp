// Binning of particles into groups and linking of groups to the sparse grid.
#include "grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "audit.hpp"
#include "block_table.hpp"
#include "boundary/held_nodes.hpp"
#include "breakdown.hpp"
#include "contact/points.hpp"
#include "error.hpp"
#include "parallel.hpp"

namespace ogive {
namespace {

// Cells that a particle may drift out of its group's cells. Half a cell is what the tile holds; the rest keeps a particle
// that sits exactly there from being rounded to a node outside.
constexpr double drift_limit = 0.49;

std::int32_t floor_div4(std::int32_t i) { return i >> 2; }

// True if the particle is to be removed; throws where it cannot be where it is.
bool has_left(const Model& model, const State& state, int body, std::int64_t particle) {
  const Grid& grid = model.grid;
  const double* x = &state.bodies[static_cast<std::size_t>(body)].position[4 * static_cast<std::size_t>(particle)];
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(x[axis]))
      throw breakdown(model, state, body, particle, "its position is not finite",
                      "the time step is too large or the material data are wrong");
    if (axis == 0 && grid.axisymmetric() && !(x[0] > 0))
      throw breakdown(model, state, body, particle, "its radius is not positive",
                      "it moves by more than its radius in a step: a smaller time_step_factor may help");
    for (int side = 0; side < 2; ++side) {
      const double beyond = side == 0 ? grid.domain_min[axis] - x[axis] : x[axis] - grid.domain_max[axis];
      if (beyond <= 0) continue;
      if (grid.face[2 * axis + side] == Face::Free) return true;
      if (beyond > 0.5 * grid.cell_size)
        throw breakdown(model, state, body, particle,
                        "it is " + std::to_string(beyond) + " beyond the " + (side == 0 ? "min " : "max ") + "xyz"[axis] +
                            " face, which lets nothing through",
                        "it moves more than half a cell in a step against a face: a smaller time_step_factor may help");
    }
  }
  return false;
}

// What particles that are removed take along.
struct Removal {
  double kinetic = 0, internal = 0;
};

void book_departure(const Model& model, const BodyState& body, int index, std::int64_t p, Departed& departed, Removal& removal) {
  const double* v = &body.velocity[4 * p];
  const double mass = body.position[4 * p + 3];
  const double kinetic =
      0.5 * mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + affine_energy(body, p, model.grid.cell_size);
  const double internal = mass / model.material_of(index).density * body.energy[p];
  ++departed.particles;
  departed.mass += mass;
  for (int axis = 0; axis < 3; ++axis) departed.momentum[axis] += mass * v[axis];
  departed.energy += kinetic + internal;
  removal.kinetic += kinetic;
  removal.internal += internal;
}

// Takes all the memory that reorder needs and changes no value: should there be too little, the body is as it was. Capacity
// grows by a sixteenth, not to the double: these arrays are most of the memory.
void reserve_for(BodyState& body, std::size_t padded) {
  const auto reserve = [](auto& array, std::size_t n) {
    if (array.capacity() < n) array.reserve(n + n / 16);
  };
  reserve(body.position, 4 * padded);
  reserve(body.velocity, 4 * padded);
  if (!body.force.empty()) reserve(body.force, 4 * padded);
  if (!body.affine.empty()) reserve(body.affine, affine_size * padded);
  body.for_each_scalar([&](AlignedVector<double>& array) { reserve(array, padded); });
  reserve(body.number, padded);
  if (!body.loads.empty()) reserve(body.loads, padded);
}

// Particles that are moved at a time.
std::int64_t piece_of(std::int64_t padded) { return std::clamp<std::int64_t>(padded / 16, 512, 16384); }

// Length of the ring through which particles are moved, in particles. An old value is needed until the last new place that
// takes it has been read, which is at most `reach` places later: particles that have moved by a cell between binnings lie
// near their old places, so that the ring is a small part of the body. It holds a reach in whole pieces and the piece that
// is read.
std::int64_t ring_length(const AlignedVector<std::int32_t>& source) {
  const std::int64_t padded = static_cast<std::int64_t>(source.size()), piece = piece_of(padded);
  std::int64_t reach = 0;
  for (std::int64_t i = 0; i < padded; ++i) reach = std::max(reach, i - source[i]);
  return (reach / piece + 2) * piece;
}

// New order of a body's particles: `source[i]` is the old place of the particle now at i; padding repeats the last one. The
// ring holds one record for each of ring_length particles. All memory was reserved before: nothing here fails.
void reorder(BodyState& body, const AlignedVector<std::int32_t>& source, AlignedVector<double>& ring,
             const Workspace& workspace) {
  const std::int64_t padded = static_cast<std::int64_t>(source.size());
  const std::size_t n = static_cast<std::size_t>(padded);
  const std::int64_t length = static_cast<std::int64_t>(ring.size()) / 4, most = piece_of(padded);
  // Sends `size` values of each particle, from the `first` of `stride` on, through the ring; a value is read before the
  // ring's place is needed again, `length` places later.
  const auto part = [&](auto& array, int stride, int first, int size) {
    using Value = std::remove_reference_t<decltype(array[0])>;
    if (array.size() < stride * n) array.resize(stride * n);
    Value* const values = array.data() + first;
    Value* const waiting = reinterpret_cast<Value*>(ring.data());
    std::int64_t written = 0;
    for (std::int64_t begin = 0; begin < padded; begin += most) {
      const std::int64_t end = std::min(begin + most, padded);
      Value* const piece = waiting + size * (begin % length);
      for_each_in_parts(workspace.threads, begin, end, [&](std::int64_t i) {
        for (int c = 0; c < size; ++c)
          piece[size * (i - begin) + c] = values[stride * static_cast<std::int64_t>(source[i]) + c];
      });
      // What lies a reach behind has been read by all that take it.
      const std::int64_t complete = end == padded ? padded : std::max<std::int64_t>(0, end + most - length);
      for (; written < complete; written = std::min(written + most, padded)) {
        const std::int64_t last = std::min(written + most, padded);
        const Value* const taken = waiting + size * (written % length);
        for_each_in_parts(workspace.threads, written, last, [&](std::int64_t i) {
          for (int c = 0; c < size; ++c) values[stride * i + c] = taken[size * (i - written) + c];
        });
      }
    }
  };
  const auto whole = [&](auto& array, int size) {
    if (array.empty()) return;
    part(array, size, 0, size);
    array.resize(size * n);
  };
  whole(body.position, 4);
  whole(body.velocity, 4);
  whole(body.force, 4);
  if (!body.affine.empty()) {
    for (int vector = 0; vector < 3; ++vector) part(body.affine, affine_size, 3 * vector, 3);
    body.affine.resize(affine_size * n);
  }
  body.for_each_scalar([&](AlignedVector<double>& array) { whole(array, 1); });
  whole(body.number, 1);
  whole(body.loads, 1);
}

// Gives a body its particles in the order of `source` and in `groups`. Where memory cannot be had it is as it was.
void take_order(BodyState& body, std::vector<Group>& groups, const AlignedVector<std::int32_t>& source, std::int64_t particles,
                const BodyTotals& totals, const Workspace& workspace) {
  AlignedVector<double> ring(static_cast<std::size_t>(4 * ring_length(source)));
  reserve_for(body, source.size());

  // From here on nothing fails.
  reorder(body, source, ring, workspace);
  body.groups.swap(groups);
  body.particles = particles;
  body.padded = static_cast<std::int64_t>(source.size());
  body.totals = totals;
  // The padding moves like the particle that it repeats but weighs nothing.
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin + group.count; p < group.padded_end(); ++p) {
      body.position[4 * p + 3] = 0;
      body.number[p] = -1;
    }
}

// Old places of a group's padding, which repeats its last particle.
void pad_source(const Group& group, AlignedVector<std::int32_t>& source) {
  for (std::int64_t p = group.begin + group.count; p < group.padded_end(); ++p)
    source[p] = source[group.begin + group.count - 1];
}

void bin_body(const Model& model, State& state, Workspace& workspace, int index) {
  BodyState& body = workspace.particles_of(state, index);
  const Grid& grid = model.grid;
  const double inverse_cell = 1.0 / grid.cell_size;

  // Old places in their present order, without padding and without those that leave.
  std::vector<std::int32_t> place, bin;
  place.reserve(body.particles);
  bin.reserve(body.particles);
  std::vector<Group> groups;
  BodyTotals totals = body.totals;
  Removal removal;
  BlockTable table(body.groups.size() + 64);
  std::uint64_t last_key = ~std::uint64_t{0};
  std::int32_t last_group = -1;
  auto take = [&](std::int64_t p, bool resting) {
    const double* x = &body.position[4 * p];
    if (has_left(model, state, index, p)) {
      // A total Lagrangian body stays whole: what lies outside is only out of reach of contact.
      if (!state.bodies[index].lagrangian) book_departure(model, body, index, p, totals.left, removal);
      return;
    }
    std::array<std::int32_t, 3> cell, block;
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<std::int32_t>(std::floor((x[axis] - grid.domain_min[axis]) * inverse_cell));
      block[axis] = floor_div4(cell[axis]);
    }
    const std::uint64_t key = block_key(block, 0);
    if (key != last_key) {
      last_key = key;
      last_group = table.insert(key, static_cast<std::int32_t>(groups.size()));
      if (last_group == static_cast<std::int32_t>(groups.size())) {
        Group group;
        group.block = block;
        group.resting = true;
        group.low = {3, 3, 3};
        group.high = {0, 0, 0};
        groups.push_back(group);
      }
    }
    Group& group = groups[last_group];
    ++group.count;
    group.resting = group.resting && resting;
    std::int32_t in_block = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const std::int32_t c = cell[axis] & 3;
      group.low[axis] = std::min(group.low[axis], c);
      group.high[axis] = std::max(group.high[axis], c);
      in_block = 4 * in_block + c;
    }
    place.push_back(static_cast<std::int32_t>(p));
    bin.push_back(last_group * block_nodes + in_block);
  };
  if (body.groups.empty()) {
    for (std::int64_t p = 0; p < body.particles; ++p) take(p, false);
  } else {
    for (const Group& group : body.groups)
      for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) take(p, group.resting);
  }

  // Groups by block: z, then y, then x. The particles keep their order within a cell.
  std::vector<std::int32_t> order(groups.size());
  for (std::size_t g = 0; g < order.size(); ++g) order[g] = static_cast<std::int32_t>(g);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return block_key(groups[a].block, 0) < block_key(groups[b].block, 0);
  });
  std::vector<std::int32_t> cursor(groups.size() * block_nodes, 0);
  for (const std::int32_t b : bin) ++cursor[b];
  std::vector<Group> sorted;
  sorted.reserve(groups.size());
  std::int64_t next = 0;
  for (const std::int32_t g : order) {
    Group group = groups[g];
    group.begin = next;
    std::int64_t at = next;
    for (int c = 0; c < block_nodes; ++c) {
      const std::int32_t count = cursor[g * block_nodes + c];
      cursor[g * block_nodes + c] = static_cast<std::int32_t>(at);
      at += count;
    }
    next = group.padded_end();
    sorted.push_back(group);
  }
  AlignedVector<std::int32_t> source(static_cast<std::size_t>(next), -1);
  for (std::size_t i = 0; i < place.size(); ++i) source[cursor[bin[i]]++] = place[i];
  for (const Group& group : sorted) pad_source(group, source);
  const std::int64_t particles = static_cast<std::int64_t>(place.size());
  place = {};
  bin = {};
  take_order(body, sorted, source, particles, totals, workspace);
  body.drifted = false;
  forget_departed(state, index, removal.kinetic, removal.internal);
}

// Nodes at the symmetry and fixed faces. A slot's nodes lie at block * 4 + (0..3) from domain_min.
void find_face_nodes(const Model& model, Workspace& workspace, const BlockTable& table) {
  const Grid& grid = model.grid;
  workspace.faces.clear();
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const Face kind = grid.face[2 * axis + side];
      if (kind == Face::Free) continue;
      FaceNodes face;
      face.axis = axis;
      face.fixed = kind == Face::Fixed;
      const std::int32_t plane =
          side == 0 ? 0
                    : static_cast<std::int32_t>(std::lround((grid.domain_max[axis] - grid.domain_min[axis]) / grid.cell_size));
      const std::int32_t ghost = side == 0 ? plane - 1 : plane + 1;
      const std::int32_t image = 2 * plane - ghost;
      const auto visit_layer = [&](std::int32_t coordinate, bool guided, auto&& visit) {
        for (std::size_t s = 0; s < workspace.slots.size(); ++s) {
          if (workspace.slots[s].guided() != guided) continue;
          if (workspace.slots[s].block[axis] != floor_div4(coordinate)) continue;
          for (int n = 0; n < workspace.nodes_in_use; ++n)
            if (((n >> (2 * axis)) & 3) == (coordinate & 3)) visit(s, n);
        }
      };
      for (const bool guided : {false, true}) {
        visit_layer(plane, guided,
                    [&](std::size_t s, int n) { face.plane.push_back(static_cast<std::int64_t>(s) * block_nodes + n); });
        if (!guided) face.moving_plane = face.plane.size();
      }
      const auto mirror = [&](std::size_t s, int n) {
        std::array<std::int32_t, 3> block = workspace.slots[s].block;
        block[axis] = floor_div4(image);
        const std::int32_t other = table.find(block_key(block, workspace.slots[s].field));
        if (other < 0) return;  // no particle near the face there: the node carries nothing
        const int node = (n & ~(3 << (2 * axis))) | (image & 3) << (2 * axis);
        MirrorPair pair;
        pair.ghost = static_cast<std::int64_t>(s) * block_nodes + n;
        pair.image = static_cast<std::int64_t>(other) * block_nodes + node;
        face.pairs.push_back(pair);
      };
      for (const bool guided : {false, true}) {
        visit_layer(ghost, guided, mirror);
        if (!guided) face.moving_pairs = face.pairs.size();
      }
      workspace.faces.push_back(std::move(face));
    }
}

// Whether a block's nodes are where a wall is felt: nearer than a shape function reaches, or behind it.
bool at_wall(const Model& model, const std::array<std::int32_t, 3>& block) {
  const double h = model.grid.cell_size, reach = 1.5 * h;
  for (const Wall& wall : model.walls) {
    double distance = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int nearest = wall.normal[axis] > 0 ? 0 : 3;
      distance += wall.normal[axis] * (model.grid.domain_min[axis] + h * (4 * block[axis] + nearest) - wall.point[axis]);
    }
    if (distance < reach) return true;
  }
  return false;
}

// Whether contact is looked for at the nodes of a block with these slots: not where all that may meet there meets at points.
bool asks_for_nodes(const Model& model, const Workspace& workspace, std::int32_t first, std::int32_t end) {
  const bool wall = at_wall(model, workspace.slots[first].block);
  if (end - first < 2 && !wall) return false;
  if (!model.own_fields && model.bodies.size() > 1) return true;
  for (std::int32_t a = first; a < end; ++a) {
    const std::int32_t body = workspace.slots[a].field;
    for (std::int32_t b = a + 1; b < end; ++b)
      if (!met_at_points(model, body, workspace.slots[b].field)) return true;
    if (!wall) continue;
    for (std::int32_t w = 0; w < static_cast<std::int32_t>(model.walls.size()); ++w)
      if (!met_at_points(model, body, -1 - w)) return true;
  }
  return false;
}

KernelGroup describe_group(const Model& model, const State& state, Workspace& workspace, const GroupLinks& link) {
  const Group& group = workspace.particles_of(state, link.body).groups[link.group];
  const Grid& grid = model.grid;
  KernelGroup k;
  k.begin = group.begin;
  k.end = group.padded_end();
  k.inverse_cell = 1.0 / grid.cell_size;
  k.time_step = 0;
  k.grid_velocity_fraction = model.numerics.grid_velocity_fraction();
  k.inverse_density = 1.0 / model.material_of(link.body).density;
  k.axisymmetric = grid.axisymmetric();
  k.section_share = grid.planar() ? grid.section_share() : 0;
  for (int axis = 0; axis < 3; ++axis) {
    k.corner[axis] = link.corner[axis];
    k.tile_low[axis] = link.tile_low[axis];
    k.tile_high[axis] = link.tile_high[axis];
    // Within the drift limit, and at free faces within the domain.
    k.bound_low[axis] = link.corner[axis] + grid.cell_size * (1 + group.low[axis] - drift_limit);
    k.bound_high[axis] = link.corner[axis] + grid.cell_size * (2 + group.high[axis] + drift_limit);
    if (grid.face[2 * axis] == Face::Free) k.bound_low[axis] = std::max(k.bound_low[axis], grid.domain_min[axis]);
    if (grid.face[2 * axis + 1] == Face::Free) k.bound_high[axis] = std::min(k.bound_high[axis], grid.domain_max[axis]);
  }
  if (grid.axisymmetric()) k.bound_low[0] = std::max(k.bound_low[0], std::numeric_limits<double>::min());
  k.bound_low[3] = -std::numeric_limits<double>::infinity();
  k.bound_high[3] = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 27; ++i) {
    const std::int32_t s = link.slot[i];
    k.nodes[i] = s < 0 ? nullptr : &workspace.nodes[static_cast<std::size_t>(s) * block_nodes];
    const std::int32_t c = s < 0 ? -1 : workspace.slots[s].contact;
    k.contact[i] = c < 0 ? nullptr : &workspace.contacts[static_cast<std::size_t>(c) * block_nodes];
  }
  return k;
}

// The body's particles, ungrouped, in the order in which it has them itself.
void renew_copy(State& state, int index) {
  const BodyState& body = state.bodies[index];
  BodyState& copy = state.copies[index];
  copy.groups.clear();
  copy.particles = copy.padded = body.particles;
  const std::size_t n = static_cast<std::size_t>(body.particles);
  copy.number.resize(n);
  std::size_t next = 0;
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) copy.number[next++] = static_cast<std::int32_t>(p);
  fill_copy(state, index);
}

}  // namespace

void fill_copy(State& state, int index) {
  const BodyState& body = state.bodies[index];
  BodyState& copy = state.copies[index];
  const std::size_t n = copy.number.size();
  copy.position.resize(4 * n);
  copy.velocity.resize(4 * n);
  copy.volume_ratio.resize(n);
  copy.energy.resize(n);
  for (auto& component : copy.stress) component.resize(copy.stressed ? n : 0);
  std::size_t last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    // Padding moves like the particle before it and weighs nothing.
    const bool padding = copy.number[i] < 0;
    if (!padding) last = static_cast<std::size_t>(copy.number[i]);
    std::copy_n(&body.position[4 * last], 4, &copy.position[4 * i]);
    std::copy_n(&body.velocity[4 * last], 4, &copy.velocity[4 * i]);
    if (padding) copy.position[4 * i + 3] = 0;
    copy.volume_ratio[i] = body.volume_ratio[last];
    for (int c = 0; c < 6 && copy.stressed; ++c) copy.stress[c][i] = body.stress[c][last];
  }
}

void bin_particles(const Model& model, State& state, Workspace& workspace, bool all) {
  for (int b = 0; b < static_cast<int>(state.bodies.size()); ++b) {
    const bool lagrangian = state.bodies[b].lagrangian, copied = lagrangian && !workspace.is_reference;
    if (workspace.is_reference ? !lagrangian : copied && !workspace.contact_needs.any) continue;
    if (!all && !workspace.particles_of(state, b).drifted) continue;
    if (copied) renew_copy(state, b);
    bin_body(model, state, workspace, b);
    workspace.linked = false;
  }
}

void drop_groups(const Model& model, State& state, Workspace& workspace, int index, const std::vector<std::uint8_t>& dropped) {
  BodyState& body = state.bodies[index];
  BodyTotals totals = body.totals;
  Removal removal;
  std::vector<Group> kept;
  std::int64_t particles = 0, padded = 0;
  for (std::size_t g = 0; g < body.groups.size(); ++g) {
    Group group = body.groups[g];
    if (dropped[g]) {
      for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
        book_departure(model, body, index, p, totals.dropped, removal);
        add(totals.dropped_angular_momentum, particle_angular_momentum(body, p, model.grid.cell_size));
      }
      continue;
    }
    group.begin = padded;
    particles += group.count;
    padded = group.padded_end();
    kept.push_back(group);
  }
  AlignedVector<std::int32_t> source(static_cast<std::size_t>(padded));
  std::size_t next = 0;
  for (std::size_t g = 0; g < body.groups.size(); ++g) {
    if (dropped[g]) continue;
    const Group& group = kept[next++];
    for (std::int32_t i = 0; i < group.count; ++i)
      source[static_cast<std::size_t>(group.begin + i)] = static_cast<std::int32_t>(body.groups[g].begin + i);
    pad_source(group, source);
  }
  take_order(body, kept, source, particles, totals, workspace);
  workspace.linked = false;
  forget_departed(state, index, removal.kinetic, removal.internal);
}

void link_grid(const Model& model, const State& state, Workspace& workspace) {
  // Groups in the order of work.
  workspace.links.clear();
  for (int b = 0; b < static_cast<int>(state.bodies.size()); ++b) {
    if (workspace.is_reference && !state.bodies[b].lagrangian) continue;
    const std::vector<Group>& groups = workspace.particles_of(state, b).groups;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const Group& group = groups[g];
      GroupLinks link;
      link.body = b;
      link.guided = model.bodies[b].rigid() || (state.bodies[b].lagrangian && !workspace.is_reference);
      link.group = static_cast<std::int32_t>(g);
      for (int axis = 0; axis < 3; ++axis) {
        link.tile_low[axis] = group.low[axis];
        link.tile_high[axis] = group.high[axis] + 3;
        link.corner[axis] = model.grid.domain_min[axis] + model.grid.cell_size * (4 * group.block[axis] - 1);
      }
      if (model.grid.planar()) link.tile_low[2] = link.tile_high[2] = 1;  // the block's first layer
      workspace.links.push_back(link);
    }
  }
  const auto field_of = [&](int body) { return workspace.is_reference ? body : model.field_of(body); };
  const auto group_of = [&](const GroupLinks& link) -> const Group& {
    return workspace.particles_of(state, link.body).groups[link.group];
  };
  const auto pencil_of = [&](const GroupLinks& link) {
    const auto& block = group_of(link).block;
    return Schedule::Place{block[2], block[1]};
  };
  const auto order_of = [&](const GroupLinks& link) {
    return std::pair(pencil_of(link), std::pair(link.body, group_of(link).block[0]));
  };
  std::sort(workspace.links.begin(), workspace.links.end(),
            [&](const GroupLinks& a, const GroupLinks& b) { return order_of(a) < order_of(b); });
  workspace.pencils.clear();
  std::vector<Schedule::Place> places;
  for (std::int32_t i = 0, n = static_cast<std::int32_t>(workspace.links.size()); i < n;) {
    const Schedule::Place place = pencil_of(workspace.links[i]);
    std::int32_t end = i + 1;
    while (end < n && pencil_of(workspace.links[end]) == place) ++end;
    workspace.pencils.push_back({i, end});
    places.push_back(place);
    i = end;
  }
  workspace.schedule.set_pencils(places);

  // Slots: the neighbour blocks that each group's tile reaches.
  const auto for_reached = [&](const GroupLinks& link, auto&& visit) {
    const Group& group = group_of(link);
    for (int z = (link.tile_low[2] + 3) >> 2; z <= (link.tile_high[2] + 3) >> 2; ++z)
      for (int y = (link.tile_low[1] + 3) >> 2; y <= (link.tile_high[1] + 3) >> 2; ++y)
        for (int x = (link.tile_low[0] + 3) >> 2; x <= (link.tile_high[0] + 3) >> 2; ++x)
          visit((z * 3 + y) * 3 + x,
                std::array<std::int32_t, 3>{group.block[0] + x - 1, group.block[1] + y - 1, group.block[2] + z - 1});
  };
  std::vector<Slot> found;
  {
    BlockTable table(workspace.slots.size() + 64);
    for (const GroupLinks& link : workspace.links) {
      const int field = field_of(link.body);
      for_reached(link, [&](int, const std::array<std::int32_t, 3>& block) {
        const std::int32_t next = static_cast<std::int32_t>(found.size());
        if (table.insert(block_key(block, field), next) == next) {
          Slot slot;
          slot.block = block;
          slot.field = field;
          slot.lagrangian = !workspace.is_reference && state.bodies[link.body].lagrangian;
          found.push_back(slot);
        }
      });
    }
  }
  workspace.rigid.clear();
  std::vector<std::int32_t> rigid_of(model.bodies.size(), -1);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (!model.bodies[b].rigid()) continue;
    rigid_of[b] = static_cast<std::int32_t>(workspace.rigid.size());
    workspace.rigid.emplace_back();
    workspace.rigid.back().body = static_cast<std::int32_t>(b);
    workspace.rigid.back().prescribed = model.bodies[b].prescribed();
  }
  for (Slot& slot : found)
    if (model.rigid_field(slot.field)) slot.rigid = rigid_of[slot.field];
  std::sort(found.begin(), found.end(), [](const Slot& a, const Slot& b) {
    return block_key(a.block, a.field) < block_key(b.block, b.field);
  });
  workspace.slots.swap(found);
  std::vector<std::int32_t> ordinals(model.bodies.size() + 1, 0);
  for (Slot& slot : workspace.slots) slot.ordinal = ordinals[slot.field]++;
  BlockTable table(workspace.slots.size());
  for (std::size_t s = 0; s < workspace.slots.size(); ++s)
    table.insert(block_key(workspace.slots[s].block, workspace.slots[s].field), static_cast<std::int32_t>(s));
  for (GroupLinks& link : workspace.links) {
    link.slot.fill(-1);
    const int field = field_of(link.body);
    for_reached(link, [&](int neighbour, const std::array<std::int32_t, 3>& block) {
      link.slot[neighbour] = table.find(block_key(block, field));
    });
  }

  // Mixed blocks and their contact records.
  workspace.mixed.clear();
  std::int32_t contacts = 0;
  for (std::int32_t s = 0, n = static_cast<std::int32_t>(workspace.slots.size()); s < n;) {
    std::int32_t end = s + 1;
    while (end < n && workspace.slots[end].block == workspace.slots[s].block) ++end;
    if (!workspace.is_reference && asks_for_nodes(model, workspace, s, end)) {
      workspace.mixed.push_back({s, end - s});
      for (std::int32_t i = s; i < end; ++i) workspace.slots[i].contact = contacts++;
    }
    s = end;
  }
  find_face_nodes(model, workspace, table);
  // A mirror image in a mixed block needs the sums of its ghost.
  for (const FaceNodes& face : workspace.faces)
    for (const MirrorPair& pair : face.pairs) {
      Slot& ghost = workspace.slots[pair.ghost / block_nodes];
      if (workspace.slots[pair.image / block_nodes].contact >= 0 && ghost.contact < 0) ghost.contact = contacts++;
    }
  for (GroupLinks& link : workspace.links)
    for (const std::int32_t s : link.slot)
      if (s >= 0 && workspace.slots[s].contact >= 0) link.contact = true;
  if (!workspace.is_reference) find_held_nodes(model, workspace);
  if (workspace.contact_needs.cloud) {
    workspace.slot_links_begin.assign(workspace.slots.size() + 1, 0);
    for (const GroupLinks& link : workspace.links)
      for (const std::int32_t s : link.slot)
        if (s >= 0) ++workspace.slot_links_begin[s + 1];
    for (std::size_t s = 0; s < workspace.slots.size(); ++s)
      workspace.slot_links_begin[s + 1] += workspace.slot_links_begin[s];
    workspace.slot_links.resize(workspace.slot_links_begin.back());
    std::vector<std::int32_t> next = workspace.slot_links_begin;
    for (std::size_t l = 0; l < workspace.links.size(); ++l)
      for (const std::int32_t s : workspace.links[l].slot)
        if (s >= 0) workspace.slot_links[next[s]++] = static_cast<std::int32_t>(l);
  }

  workspace.nodes.resize(workspace.slots.size() * block_nodes);
  workspace.contacts.resize(static_cast<std::size_t>(contacts) * block_nodes);
  workspace.contact_stress.resize(workspace.contact_needs.stress ? workspace.contacts.size() : 0);
  workspace.occupied.resize(workspace.contact_needs.occupied ? workspace.contacts.size() : 0);
  const bool filter = workspace.is_reference || model.numerics.transfer == Transfer::Xpic;
  workspace.filter.resize(filter ? workspace.nodes.size() : 0);
  workspace.kernel_groups.clear();
  for (const GroupLinks& link : workspace.links)
    workspace.kernel_groups.push_back(describe_group(model, state, workspace, link));
  workspace.stress_sums.resize(workspace.links.size());
  workspace.move_sums.resize(workspace.links.size());
  workspace.slot_contact_force.resize(workspace.slots.size());
  workspace.slot_given.resize(workspace.slots.size());
  const bool moves_last = !workspace.is_reference && !model.numerics.stress_first();
  workspace.displacement.resize(moves_last ? state.bodies.size() : 0);
  for (std::size_t b = 0; b < workspace.displacement.size(); ++b)
    if (!model.bodies[b].rigid() && !state.bodies[b].lagrangian)
      workspace.displacement[b].resize(4 * static_cast<std::size_t>(state.bodies[b].padded));
  workspace.resting.stale = true;
  workspace.resting.skipping = false;
  share_out(state, workspace);
  workspace.linked = true;
}

void share_out(const State& state, Workspace& workspace) {
  std::vector<std::int64_t> particles;
  for (const Pencil& pencil : workspace.pencils) {
    std::int64_t count = 0;
    for (std::int32_t l = pencil.begin; l < pencil.end; ++l) {
      const GroupLinks& link = workspace.links[l];
      if (!link.skipped) count += workspace.particles_of(state, link.body).groups[link.group].count;
    }
    particles.push_back(count);
  }
  workspace.schedule.divide(workspace.threads, particles);
  std::vector<std::int32_t> part, rank;
  for (const Slot& slot : workspace.slots) {
    part.push_back(workspace.schedule.part_of({slot.block[2], slot.block[1]}));
    rank.push_back(static_cast<std::int32_t>(rank.size()));
  }
  workspace.slot_parts.assign(workspace.threads, part, rank, 8);
}

KernelGroup kernel_group(const Model&, const State&, Workspace& workspace, const GroupLinks& link, double dt) {
  KernelGroup group = workspace.kernel_groups[static_cast<std::size_t>(&link - workspace.links.data())];
  group.time_step = dt;
  return group;
}

KernelParticles kernel_particles(BodyState& body) {
  KernelParticles k;
  k.position = body.position.data();
  k.velocity = body.velocity.data();
  k.affine = body.affine.data();
  for (int c = 0; c < 6; ++c) k.stress[c] = body.stress[c].data();
  k.volume_ratio = body.volume_ratio.data();
  k.energy = body.energy.data();
  k.plastic_strain = body.plastic_strain.data();
  k.yield_stress = body.yield_stress.data();
  k.temperature = body.temperature.data();
  k.viscous_pressure = body.viscous_pressure.empty() ? nullptr : body.viscous_pressure.data();
  k.displacement = nullptr;
  for (int c = 0; c < 9; ++c) k.deformation[c] = body.deformation[c].data();
  for (std::size_t c = 0; c < body.history.size(); ++c) k.history[c] = body.history[c].data();
  k.reference = body.reference.position.data();
  return k;
}

KernelMaterial kernel_material(const Material& material, double cell_size) {
  KernelMaterial k{};
  k.density = material.density;
  k.K = material.K;
  k.G = material.G;
  k.lambda = material.K - 2.0 / 3.0 * material.G;
  k.A = material.yield_stress;
  k.B = material.hardening_modulus;
  k.n = material.hardening_exponent;
  k.isotropic = material.isotropic_fraction;
  k.rate_coefficient = material.rate_coefficient;
  k.inverse_reference_rate = 1.0 / material.reference_strain_rate;
  k.thermal = material.thermal();
  if (k.thermal) {
    k.thermal_exponent = material.thermal_exponent;
    k.room_temperature = material.room_temperature;
    k.inverse_melt_range = 1.0 / (material.melt_temperature - material.room_temperature);
    k.heating = material.taylor_quinney / (material.density * material.specific_heat);
  }
  k.rho_c0_squared = material.density * material.eos_sound_speed * material.eos_sound_speed;
  k.slope = material.eos_slope;
  k.gruneisen = material.gruneisen;
  k.failure_strain =
      material.failure == Failure::None ? std::numeric_limits<double>::infinity() : material.failure_strain;
  k.viscosity_linear = material.viscosity_linear;
  k.viscosity_quadratic = material.viscosity_quadratic;
  k.cell_size = cell_size;
  k.rate_dependent = material.rate_dependent();
  k.viscous = material.viscous();
  return k;
}

std::int64_t Workspace::memory_bytes() const {
  const auto bytes = [](const auto& v) { return static_cast<std::int64_t>(v.capacity() * sizeof(v[0])); };
  std::int64_t total = bytes(slots) + bytes(nodes) + bytes(contacts) + bytes(contact_stress) + bytes(occupied) +
                       bytes(filter) + bytes(links) + bytes(kernel_groups) + bytes(pencils) + bytes(mixed) +
                       bytes(clamped_nodes) + bytes(driven_nodes) + bytes(driven_block) +
                       bytes(driven_response) + bytes(stress_sums) + bytes(move_sums) + bytes(slot_contact_force) + bytes(slot_given) +
                       bytes(load_sums) + schedule.memory_bytes() + slot_parts.memory_bytes();
  for (const BlockContacts& block : block_contacts) total += bytes(block.fields) + bytes(block.pairs) + bytes(block.nodes);
  for (const PlacedSurface& placed : surfaces)
    total += placed.surface.memory_bytes() + bytes(placed.vertex_ends) + bytes(placed.vertex_nodes) +
             bytes(placed.vertex_particle) + bytes(placed.vertex_inward);
  total += points.memory_bytes();
  for (const FaceNodes& face : faces) total += bytes(face.pairs) + bytes(face.plane);
  if (reference_grid) total += reference_grid->memory_bytes();
  return total;
}

}  // namespace ogive
