// See resting.hpp.
#include "resting.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "parallel.hpp"
#include "phases.hpp"
#include "simd/subnormals.hpp"

namespace ogive {
namespace {

// Of the fastest speed that there has been: what is slower is no motion. Far below what rounding leaves of any speed that matters.
constexpr double least_motion = 0x1p-100;

// ------------------------------------------------------------------------------------------------------ the state of rest

// The laws of a body on particles at rest among nodes at rest: whether they stay so, bit for bit, and how fast waves are.
RestingLaw try_law(const Model& model, const Workspace& workspace, int index) {
  const Grid& grid = model.grid;
  const double h = grid.cell_size;
  BodyState body;
  allocate_particles(model.material_of(index), model.bodies[index], group_padding, body);
  allocate_transfer(model, index, body);
  for (int p = 0; p < group_padding; ++p) {
    for (int c = 0; c < 3; ++c) body.position[4 * p + c] = 1.625 * h;
    body.position[4 * p + 3] = model.material_of(index).density * h * h * h;
    body.velocity[4 * p + 3] = 1;
  }
  BodyState before = body;
  AlignedVector<NodeRecord> nodes(block_nodes, NodeRecord{});
  AlignedVector<double> displacement(4 * group_padding, 0.0);
  KernelGroup group{};
  group.end = group_padding;
  group.inverse_cell = 1 / h;
  group.inverse_density = 1 / model.material_of(index).density;
  group.axisymmetric = grid.axisymmetric();
  group.section_share = grid.planar() ? grid.section_share() : 0;
  const double wave = std::sqrt((model.material_of(index).K + 2 * model.material_of(index).G) / model.material_of(index).density);
  group.time_step = 0.5 * h / wave;
  for (int axis = 0; axis < 3; ++axis) {
    group.tile_high[axis] = tile_nodes - 1;
    if (axis == 2 && grid.planar()) group.tile_low[axis] = group.tile_high[axis] = 1;
  }
  std::fill_n(group.nodes, 27, nodes.data());  // they are all the same: at rest
  std::fill_n(group.bound_low, 4, -std::numeric_limits<double>::infinity());
  std::fill_n(group.bound_high, 4, std::numeric_limits<double>::infinity());
  KernelParticles particles = kernel_particles(body);
  if (!model.numerics.stress_first()) particles.displacement = displacement.data();
  StressSums sums{};
  const Material& material = model.material_of(index);
  {
    const FlushSubnormals flush;
    workspace.kernels->update_stress[static_cast<int>(model.numerics.shape_function)][static_cast<int>(material.strength)]
                                    [static_cast<int>(material.eos)](group, particles, workspace.materials[index], sums);
  }
  RestingLaw law;
  law.fastest = sums.fastest;
  law.keeps = sums.bad_particle < 0 && sums.failed_particles == 0 && sums.plastic_dissipation == 0 &&
              sums.viscous_dissipation == 0 && sums.failure_loss == 0 && sums.failed_mass == 0 && !sums.outside;
  const auto arrays_of = [](BodyState& of) {
    std::vector<AlignedVector<double>*> arrays = {&of.position, &of.velocity, &of.affine};
    of.for_each_scalar([&](AlignedVector<double>& array) { arrays.push_back(&array); });
    return arrays;
  };
  const auto was = arrays_of(before), is = arrays_of(body);
  for (std::size_t i = 0; i < was.size(); ++i)
    law.keeps = law.keeps && (was[i]->empty() || std::memcmp(was[i]->data(), is[i]->data(), was[i]->size() * sizeof(double)) == 0);
  return law;
}

// Of a group's particles, padding included, in what motion leaves: nothing above the limits, and nothing lasting. Written so that
// what is not a number moves.
bool is_still(const BodyState& body, const Group& group, double speed, double stress, double inverse_cell) {
  const auto within = [&](const AlignedVector<double>& array, std::int64_t first, std::int64_t end, double limit) {
    std::int64_t beyond = 0;
    for (std::int64_t i = first; i < end; ++i) beyond |= !(std::abs(array[i]) <= limit);
    return beyond == 0;
  };
  const std::int64_t begin = group.begin, end = group.padded_end();
  for (std::int64_t p = begin; p < end; ++p)
    for (int c = 0; c < 3; ++c)
      if (!(std::abs(body.velocity[4 * p + c]) <= speed)) return false;
  for (const auto& component : body.stress)
    if (!within(component, begin, end, stress)) return false;
  if (!body.affine.empty() && !within(body.affine, affine_size * begin, affine_size * end, speed * inverse_cell)) return false;
  if (!body.viscous_pressure.empty() && !within(body.viscous_pressure, begin, end, stress)) return false;
  for (std::int64_t p = begin; p < end; ++p)
    if (!(body.volume_ratio[p] == 1)) return false;
  return body.plastic_strain.empty() || within(body.plastic_strain, begin, end, 0);
}

// As particles are before anything happens to them; temperature and yield stress may be any.
bool is_pristine(const Material& material, const BodyState& body, const Group& group) {
  if (!is_still(body, group, 0, 0, 0)) return false;
  for (std::int64_t p = group.begin; p < group.padded_end(); ++p) {
    if (body.energy[p] != 0) return false;
    if (!body.loads.empty() && body.loads[p] != 0) return false;
    for (int c = 0; c < 3; ++c)
      if (!body.force.empty() && body.force[4 * p + c] != 0) return false;
    for (int c = 0; c < 9 && !body.deformation[0].empty(); ++c)
      if (body.deformation[c][p] != (c % 4 == 0 ? 1 : 0)) return false;
    for (int c = 0; c < material.history_size(); ++c)
      if (body.history[c][p] != initial_history(material, c)) return false;
  }
  return true;
}

// Zeros of either sign become +0, which is what stays.
void put_to_rest(BodyState& body, const Group& group) {
  const std::int64_t begin = group.begin, end = group.padded_end();
  const auto clear = [](AlignedVector<double>& array, std::int64_t first, std::int64_t last) {
    if (!array.empty()) std::memset(&array[first], 0, static_cast<std::size_t>(last - first) * sizeof(double));
  };
  for (std::int64_t p = begin; p < end; ++p) {
    std::memset(&body.velocity[4 * p], 0, 3 * sizeof(double));
    for (int c = 0; c < 3; ++c)
      if (std::bit_cast<std::uint64_t>(body.position[4 * p + c]) == std::uint64_t{1} << 63)
        std::memset(&body.position[4 * p + c], 0, sizeof(double));
  }
  clear(body.affine, affine_size * begin, affine_size * end);
  for (auto& component : body.stress) clear(component, begin, end);
  clear(body.viscous_pressure, begin, end);
  clear(body.energy, begin, end);
  clear(body.plastic_strain, begin, end);
  for (int c = 0; c < 9 && !body.deformation[0].empty(); ++c) {
    clear(body.deformation[c], begin, end);
    if (c % 4 == 0) std::fill(&body.deformation[c][begin], &body.deformation[c][begin] + (end - begin), 1.0);
  }
}

bool may_rest(const Model& model, const State& state, const Workspace& workspace, int body) {
  return !workspace.resting.laws.empty() && workspace.resting.laws[body].keeps && !model.bodies[body].rigid() &&
         !state.bodies[body].lagrangian;
}

void look_at_groups(const Model& model, State& state, Workspace& workspace, int index, bool all) {
  BodyState& body = state.bodies[index];
  const bool may = may_rest(model, state, workspace, index);
  const Material& material = model.material_of(index);
  for_each_in_parts(workspace.threads, 0, static_cast<std::int64_t>(body.groups.size()), [&](std::int64_t g) {
    Group& group = body.groups[g];
    group.resting = may && (all || group.resting) && is_pristine(material, body, group);
    if (group.resting) put_to_rest(body, group);
  });
  workspace.resting.stale = true;
}

bool rests(const State& state, const Workspace& workspace, const GroupLinks& link) {
  return !link.guided && workspace.particles_of(state, link.body).groups[link.group].resting;
}

// ---------------------------------------------------------------------------------------------------------------- rings

// Sets of nodes: a bit each, 64 a block, whatever the field.
class Nodes {
 public:
  explicit Nodes(const Workspace& workspace) : block_of_(workspace.slots.size()) {
    std::int32_t blocks = 0;
    for (std::size_t s = 0; s < block_of_.size(); ++s) {
      if (s > 0 && workspace.slots[s].block != workspace.slots[s - 1].block) ++blocks;
      block_of_[s] = blocks;
    }
    bits_.assign(block_of_.empty() ? 0 : static_cast<std::size_t>(blocks) + 1, 0);
  }
  void add(std::int64_t node) { bits_[block_of_[node / block_nodes]] |= std::uint64_t{1} << (node % block_nodes); }
  void add(const GroupLinks& link) {
    for_blocks(link, [&](std::int32_t block, std::uint64_t nodes) {
      bits_[block] |= nodes;
      return false;
    });
  }
  bool meet(const GroupLinks& link) const {
    return for_blocks(link, [&](std::int32_t block, std::uint64_t nodes) { return (bits_[block] & nodes) != 0; });
  }

 private:
  // Visits the blocks that the group's tile reaches, with its nodes there, until `visit` says true.
  template <class Visit>
  bool for_blocks(const GroupLinks& link, Visit&& visit) const {
    // Of tile node t the neighbour block is (t + 3) / 4, the node there (t + 3) % 4.
    std::uint64_t along[3][3] = {};
    for (int axis = 0; axis < 3; ++axis)
      for (int t = link.tile_low[axis]; t <= link.tile_high[axis]; ++t)
        along[axis][(t + 3) >> 2] |= std::uint64_t{1} << (((t + 3) & 3) << (2 * axis));
    for (int z = 0; z < 3; ++z)
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) {
          const std::int32_t slot = link.slot[(z * 3 + y) * 3 + x];
          // Bits at multiples of 1, 4 and 16: their products do not overlap.
          if (slot >= 0 && visit(block_of_[slot], along[0][x] * along[1][y] * along[2][z])) return true;
        }
    return false;
  }

  std::vector<std::int32_t> block_of_;
  std::vector<std::uint64_t> bits_;
};

void leave_nothing_out(Workspace& workspace) {
  for (GroupLinks& link : workspace.links) link.skipped = false;
  for (Slot& slot : workspace.slots) slot.idle = false;
  workspace.resting.skipping = false;
}

// Slots that only groups left out reach: they hold zeros.
void find_idle_slots(Workspace& workspace) {
  std::vector<char> used(workspace.slots.size(), 0);
  for (const GroupLinks& link : workspace.links)
    for (const std::int32_t s : link.slot)
      if (s >= 0 && !link.skipped) used[s] = 1;
  // Ghosts move as their images do, in the order of unfold_velocity.
  for (auto face = workspace.faces.rbegin(); face != workspace.faces.rend(); ++face)
    for (const MirrorPair& pair : face->pairs)
      if (used[pair.image / block_nodes]) used[pair.ghost / block_nodes] = 1;
  for (std::size_t s = 0; s < used.size(); ++s) {
    Slot& slot = workspace.slots[s];
    if (!used[s] && !slot.idle) {
      std::memset(static_cast<void*>(&workspace.nodes[s * block_nodes]), 0, block_nodes * sizeof(NodeRecord));
      if (!workspace.filter.empty())
        std::memset(static_cast<void*>(&workspace.filter[s * block_nodes]), 0, block_nodes * sizeof(NodeRecord));
    }
    slot.idle = !used[s];
  }
}

}  // namespace

int rings_around_motion(const Numerics& numerics) {
  const int passes = numerics.transfer == Transfer::Xpic ? numerics.xpic_order : 1;
  switch (numerics.update_order) {
    case UpdateOrder::StressFirst: return std::max(2, passes);
    case UpdateOrder::StressLast: return passes + 1;
    case UpdateOrder::StressLastAsIs: return passes;
  }
  return std::numeric_limits<int>::max();
}

const char* why_nothing_rests(const Model& model, const Workspace& workspace) {
  if (model.numerics.gravity != Vector3{}) return "gravity moves everything";
  if (workspace.contact_needs.surface) return "contact by surfaces looks at everything";
  return nullptr;
}

void prepare_resting(const Model& model, State& state, Workspace& workspace, bool all) {
  Resting& resting = workspace.resting;
  resting.laws.clear();
  if (!why_nothing_rests(model, workspace))
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
      resting.laws.push_back(model.bodies[b].rigid() || state.bodies[b].lagrangian ? RestingLaw{}
                                                                                   : try_law(model, workspace, static_cast<int>(b)));
  for (std::size_t b = 0; b < model.bodies.size(); ++b) look_at_groups(model, state, workspace, static_cast<int>(b), all);
}

void find_resting(const Model& model, State& state, Workspace& workspace, int body) {
  look_at_groups(model, state, workspace, body, true);
}

void choose_groups(const Model& model, const State& state, Workspace& workspace) {
  Resting& resting = workspace.resting;
  if (!resting.stale) return;
  resting.stale = false;
  resting.groups = resting.skipped_particles = 0;
  for (const GroupLinks& link : workspace.links) resting.groups += rests(state, workspace, link);
  if (resting.groups == 0 || !model.numerics.skip_resting) {
    if (resting.skipping) {
      leave_nothing_out(workspace);
      share_out(state, workspace);
    }
    return;
  }

  // Guided bodies give their nodes motion by other ways, where contact asks for them; so do prescribed velocities.
  Nodes moving(workspace);
  std::vector<std::int32_t> last, next, rest;
  for (const HeldNode& driven : workspace.driven_nodes)
    if (driven.load >= 0) moving.add(driven.node);
  for (std::size_t l = 0; l < workspace.links.size(); ++l) {
    GroupLinks& link = workspace.links[l];
    link.skipped = rests(state, workspace, link) && !moving.meet(link);
    if (link.skipped) rest.push_back(static_cast<std::int32_t>(l));
    else if (!link.guided || link.contact) last.push_back(static_cast<std::int32_t>(l));
  }
  for (int ring = rings_around_motion(model.numerics); ring > 0 && !last.empty() && !rest.empty(); --ring) {
    for (const std::int32_t l : last) moving.add(workspace.links[l]);
    next.clear();
    for (const std::int32_t l : rest)
      if (moving.meet(workspace.links[l])) next.push_back(l);
    for (const std::int32_t l : next) workspace.links[l].skipped = false;
    std::erase_if(rest, [&](std::int32_t l) { return !workspace.links[l].skipped; });
    last.swap(next);
  }
  resting.skipping = true;
  find_idle_slots(workspace);
  for (const std::int32_t l : rest) {
    const GroupLinks& link = workspace.links[l];
    resting.skipped_particles += state.bodies[link.body].groups[link.group].count;
    workspace.stress_sums[l] = {};
    workspace.stress_sums[l].bad_particle = -1;
    workspace.stress_sums[l].fastest = resting.laws[link.body].fastest;
  }
  share_out(state, workspace);
}

void keep_resting(const Model& model, State& state, Workspace& workspace) {
  Resting& resting = workspace.resting;
  if (resting.groups == 0) return;
  double fastest = 0;
  for (const BodyState& body : state.bodies)
    fastest = std::max({fastest, body.totals.maximum_speed, body.totals.maximum_speed_ever});
  const double speed = least_motion * fastest;
  for_groups(workspace, [&](const GroupLinks& link, std::int32_t l) {
    if (!rests(state, workspace, link)) return;
    BodyState& body = state.bodies[link.body];
    Group& group = body.groups[link.group];
    const double impedance = model.material_of(link.body).density * resting.laws[link.body].fastest;
    group.resting = workspace.move_sums[l].speed_squared <= speed * speed &&
                    is_still(body, group, speed, speed * impedance, 1 / model.grid.cell_size);
    if (group.resting) put_to_rest(body, group);
  });
  std::int64_t groups = 0;
  for (const GroupLinks& link : workspace.links) groups += rests(state, workspace, link);
  if (groups != resting.groups) resting.stale = true;
}

}  // namespace ogive
