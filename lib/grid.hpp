// The background grid of one step, sparse: nodes exist in blocks of 4 x 4 x 4, and a block exists for a velocity field
// only where particles of that field reach it. Memory follows the material, never the domain.
//
// A slot is one block of one field. Where two or more fields have slots of the same block, the block is mixed: there, and
// only there, contact is looked for and contact records are kept. All of this is rebuilt whenever a body is binned anew
// (every 10 to 20 steps at impact speeds) and can be rebuilt from the particles' groups at any time, so that none of it
// belongs to a checkpoint.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "aligned.hpp"
#include "contact/nodes.hpp"
#include "contact/points.hpp"
#include "lagrangian/contact.hpp"
#include "model.hpp"
#include "rigid/rigid_motion.hpp"
#include "schedule.hpp"
#include "state.hpp"
#include "transfer/kernels.hpp"

namespace ogive {

constexpr int block_nodes = block_cells * block_cells * block_cells;
constexpr int layer_nodes = block_cells * block_cells;  // of the lowest layer along z, which come first

struct Slot {
  std::array<std::int32_t, 3> block{};
  std::int32_t field = 0;
  std::int32_t contact = -1;  // index of its contact records, in units of blocks; -1: none
  std::int32_t rigid = -1;    // index in Workspace::rigid; -1: deformable
  bool lagrangian = false;    // of a total Lagrangian body on the common grid
  std::int32_t ordinal = 0;   // among the slots of its field
  bool idle = false;          // only groups that the step leaves out reach it: its nodes are zero, without mass

  // Moved by other means than this grid, which has it for contact alone.
  bool guided() const { return rigid >= 0 || lagrangian; }
};

// A body's surface in a step.
struct PlacedSurface {
  Surface surface;
  bool used = false;
  bool moved = false;             // turn and shift are not the identity
  Matrix3 turn{};                 // rows
  Vector3 shift{}, lower{}, upper{};  // bounds: in the world
  // Of a total Lagrangian body, for each vertex: the way to half a particle below it, the particle next to it (where a
  // method asks for stress; -1: none), and
  // the nodes of the reference grid that move it. Found when asked for; empty after that grid was linked anew.
  std::vector<Vector3> vertex_inward;
  std::vector<std::int64_t> vertex_particle;
  std::vector<std::int64_t> vertex_ends;
  std::vector<PointNode> vertex_nodes;
};

// A group of particles with its place on the grid.
struct GroupLinks {
  std::int32_t body = 0, group = 0;
  std::array<std::int32_t, 27> slot{};  // of the neighbour blocks, x fastest; -1 where the tile does not reach
  std::array<std::int32_t, 3> tile_low{}, tile_high{};
  Vector3 corner{};
  bool contact = false;  // some of its slots have contact records
  std::int32_t first_load_sum = 0;  // in Workspace::load_sums
  bool guided = false;  // as Slot::guided
  bool driven = false;   // reaches blocks with driven nodes
  bool skipped = false;  // at rest and far from what moves: the step leaves it out
};

// Groups of all bodies in one row of blocks along x: worked on by one thread, in order. schedule.hpp says when.
struct Pencil {
  std::int32_t begin = 0, end = 0;  // in Workspace::links
};

// A block where contact is looked for: of two fields or more, or at a wall.
struct MixedBlock {
  std::int32_t first_slot = 0, count = 0;
};

// A particle of a total Lagrangian body whose velocity is prescribed.
struct PrescribedPoint {
  std::int32_t axes = 0;
  std::int32_t load = -1;        // -1: at rest
  std::int64_t weights_end = 0;  // in Workspace::point_weights
};

// Loads on the particles of one group in one step.
struct LoadSums {
  Vector3 force{};
  double work = 0;
};

// What the contact rules of a model ask for; see contact/method.hpp.
struct ContactNeeds {
  bool any = false;           // some pair of bodies has fields of its own, or there is a wall
  bool start = false;         // some method acts at the beginning of the step
  bool start_kept = false;    // and the particles never see it
  bool stress = false, memory = false, occupied = false, cloud = false, surface = false;
};

// A node beyond a mirror face and its image inside.
struct MirrorPair {
  std::int64_t ghost = 0, image = 0;
  double ghost_mass = 0;
  Vector3 ghost_momentum{};  // before it was turned round
};

// Nodes at one symmetry or fixed face.
struct FaceNodes {
  int axis = 0;
  bool fixed = false;
  // Those of guided bodies last: of these only mass, momentum and contact sums are mirrored, not the change of motion.
  std::vector<MirrorPair> pairs;
  std::vector<std::int64_t> plane;
  std::size_t moving_pairs = 0, moving_plane = 0;
  Vector3 plane_momentum{};  // of the moving nodes in the plane, before it was taken from them
};

// A node whose velocity is given along some axes (boundary/held_nodes.hpp).
struct HeldNode {
  std::int64_t node = 0;
  std::int32_t axes = 0;
  std::int32_t load = -1;      // the prescribed velocity; -1: at rest
  Vector3 taken{}, impulse{};  // in this step: what was taken of its velocity at the beginning, and what holds it
};

// What a body's law makes of particles at rest (resting.hpp): they stay as they are, bit for bit, and the speed of waves.
struct RestingLaw {
  bool keeps = false;
  double fastest = 0;
};

// Groups at rest.
struct Resting {
  std::vector<RestingLaw> laws;  // by body; empty: nothing can be at rest
  bool stale = true;             // groups have moved, or the grid is another: what to leave out must be found anew
  bool skipping = false;         // some links are left out
  std::int64_t groups = 0;       // links at rest
  std::int64_t skipped_particles = 0;  // of the links that are left out
};

// Everything that a step needs besides model and state; holds no information of its own between steps.
struct Workspace {
  const KernelTable* kernels = nullptr;
  int threads = 1;
  bool linked = false;  // the slots fit the groups
  int nodes_in_use = block_nodes;  // of a slot, the first ones: a layer where the model is two-dimensional

  std::vector<Slot> slots;                // ordered by block (z, y, x), then field
  AlignedVector<NodeRecord> nodes;        // 64 a slot
  AlignedVector<ContactRecord> contacts;  // 64 a slot that has them
  AlignedVector<ContactStress> contact_stress;  // likewise, where a contact method asks for it
  std::vector<std::uint8_t> occupied;     // likewise: which of a node's eight cells hold particles
  std::vector<GroupLinks> links;          // ordered by pencil (z, y), body, block x
  std::vector<KernelGroup> kernel_groups; // what kernels are told of each link; all but the time step
  std::vector<Pencil> pencils;
  Schedule schedule;                      // of the pencils
  Parts slot_parts;                       // of the slots, near the pencils of the same thread
  std::vector<MixedBlock> mixed;
  std::vector<FaceNodes> faces;
  std::vector<HeldNode> clamped_nodes;    // particles do not see their velocity change
  std::vector<HeldNode> driven_nodes;     // they do: deep in clamps, and at prescribed velocities
  // Of blocks with driven nodes and their ghosts: where a slot's block is (-1: it is none), and by node the momentum of the
  // particles' changes of velocity.
  std::vector<std::int32_t> driven_block;
  std::vector<Vector3> driven_response;
  std::vector<KernelMaterial> materials;  // by body
  ContactNeeds contact_needs;
  Resting resting;
  std::vector<BlockContacts> block_contacts;  // of this step, one a mixed block (at least)
  std::vector<std::int32_t> slot_links_begin, slot_links;  // links by slot that they reach; where a rule asks for particles
  std::vector<PlacedSurface> surfaces;        // by body; empty where no rule asks for one
  ContactPoints points;                       // of this step, where a rule asks for surfaces
  std::vector<RigidMotion> rigid;             // of this step, in the order of the rigid bodies
  double rigid_speed = 0;                     // the fastest particle of them
  AlignedVector<NodeRecord> filter;           // XPIC: one entry a node
  Vector3 filter_momentum{};                  // what the filter gave: nothing but for mirror faces and clamps

  // One entry a link, filled by the kernels and summed in order.
  std::vector<StressSums> stress_sums;
  std::vector<MoveSums> move_sums;
  // One entry a slot of a mixed block.
  std::vector<Vector3> slot_contact_force;
  std::vector<double> slot_given;  // sum of m v . dv over the nodes; one entry a slot
  // Of each body's particles in this step, records; empty where the stress comes first.
  std::vector<AlignedVector<double>> displacement;
  std::vector<LoadSums> load_sums;        // of each link in turn: the loads on its body's particles, then the host's forces
  // The grid of the reference configurations of total Lagrangian bodies, a field each; null where there are none. There
  // `filter` takes the internal forces, and groups and particles are those of the bodies themselves.
  std::unique_ptr<Workspace> reference_grid;
  bool is_reference = false;
  // Of it, by node: the node itself or its image inside, the components that change their sign there, and those that a mirror
  // holds; by body and particle, the link; and the points whose velocity is prescribed.
  std::vector<std::int64_t> image;
  std::vector<std::int32_t> image_signs, held;
  std::vector<std::vector<std::int32_t>> link_of;
  std::vector<PrescribedPoint> prescribed_points;
  std::vector<NodeWeight> point_weights;
  // Of the common grid.
  LagrangianContact lagrangian_contact;
  double lagrangian_speed = 0;  // the fastest wave or particle of total Lagrangian bodies

  // The step has begun to change the state: until then a step that fails leaves it as it was.
  bool changing = false;

  // The particles of a body as this grid has them.
  const BodyState& particles_of(const State& state, int body) const {
    return !is_reference && state.bodies[body].lagrangian ? state.copies[body] : state.bodies[body];
  }
  BodyState& particles_of(State& state, int body) const {
    return const_cast<BodyState&>(particles_of(static_cast<const State&>(state), body));
  }

  std::int64_t memory_bytes() const;
};

// Orders the particles of the bodies that have drifted (or of all, if `all`) by block and cell, removes those that have
// left the domain and books them. Throws Error(Numerical) for a particle that is not a number or has crossed a mirror face.
void bin_particles(const Model& model, State& state, Workspace& workspace, bool all);

// Removes those of a body's groups that `dropped` marks and books what they were (drop_debris). The others keep the order of
// their particles, so that their sums keep their bits.
void drop_groups(const Model& model, State& state, Workspace& workspace, int body, const std::vector<std::uint8_t>& dropped);

// Brings the copy of a total Lagrangian body to what its particles are now.
void fill_copy(State& state, int body);

// Divides pencils and slots among the threads by the particles that are computed.
void share_out(const State& state, Workspace& workspace);

// Slots, links, pencils, mixed blocks, face and clamp nodes for the groups as they are.
void link_grid(const Model& model, const State& state, Workspace& workspace);

// Arguments of a kernel call.
KernelGroup kernel_group(const Model& model, const State& state, Workspace& workspace, const GroupLinks& link, double dt);
KernelParticles kernel_particles(BodyState& body);
KernelMaterial kernel_material(const Material& material, double cell_size);

}  // namespace ogive
