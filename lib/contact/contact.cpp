// Contact at shared nodes.
//
// A pair (a, b) with unit normal n out of a is looked at where both bodies reach the node and, with the gap rule, the gap
// between their surfaces is below the offset. Its method says what holds it. With the reduced mass
// m = m_a m_b / (m_a + m_b) and the relative velocity v = v_a - v_b the impulses are
//   normal      I = m (v . n - target), pushing only where the pair is in contact, Eqs. (16), (22)
//   tangential  m |v_t| against the slip v_t, at most mu I, Eqs. (21), (22).
//
// Several pairs: projected Jacobi iteration. In a sweep every pair asks for what is missing of its impulses, each body's
// mass being shared equally between its pairs; impulses may also be taken back, down to zero. Impulses are equal and
// opposite, so that momentum is kept to round-off; no order of bodies is preferred; and sharing the mass keeps kinetic
// energy from growing. One pair needs one sweep, which is the papers' formula.
//
// Rigid bodies move with their surface, not with the node: the velocity of a pair is taken, and its impulse acts, where
// the bodies' surfaces meet, beside the node along the normal. (Stick at nodes in several depths would forbid rotation.)
// Two bodies that do not deform may approach until the gap is closed, v . n <= gap / dt: what lies before a rolling body
// does not hold it up.
//
// Free rigid bodies couple the nodes that they touch. Their nodes are swept together, and after each sweep the body takes
// all impulses as one rigid body. Its mass is shared between its nodes and pairs in proportion to their nodal mass (a
// part theta each), so that a pair meets 1/theta times the inverse effective mass n . (1/M + [r] I^-1 [r]^T) . n.
//
// Total Lagrangian bodies couple nodes likewise: after each sweep they take all impulses through their own nodes, and show
// what became of them (lagrangian/contact.hpp). They have no strain from the grid: among themselves, with rigid bodies and walls
// all of their contact is in the second phase, and like those they may approach until the gap is closed.
//
// The gap. A body whose flat surface lies at distance s from a node fills a known part of that node's shape
// function; inverting that gives s from the nodal volume, and the gap of a pair is s_a + s_b. It vanishes exactly when the
// two bodies together fill the node (docs/theory.md). A wall's s is its distance itself.
#include "contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

#include "contact/memory.hpp"
#include "contact/method.hpp"
#include "contact/normal.hpp"
#include "shape/gimp.hpp"
#include "surface/meeting.hpp"

namespace ogive {
namespace {

// A body with less than this share of a pair's nodal mass is not felt: its normal and velocity are round-off.
constexpr double smallest_mass_share = 1e-6;
constexpr double least_steepness = 1e-9;  // of the mass gradient, times cell size over mass
constexpr int most_sweeps = 50;           // of a node
constexpr double sweep_tolerance = 1e-10;
constexpr int most_coupled_sweeps = 300;  // of the nodes of free rigid bodies
constexpr double coupled_tolerance = 1e-11;
// Of the nodes of total Lagrangian bodies, where what is missing falls ever more slowly: docs/decisions.md. They answer an
// impulse by less than their mass lets expect, so that more is asked for; below 2 that is stable.
constexpr int most_lagrangian_sweeps = 8;
constexpr double lagrangian_tolerance = 1e-3, lagrangian_relaxation = 1.5;

// ------------------------------------------------------------------------------------------------------------- finding

class Finder {
 public:
  Finder(const Model& model, const State& state, const Workspace& workspace)
      : model_(model), state_(state), workspace_(workspace) {}

  void find(const MixedBlock& block, BlockContacts& contacts) {
    contacts.clear();
    have_cloud_ = false;
    for (int node = 0; node < workspace_.nodes_in_use; ++node) {
      ContactNode at;
      at.node = node;
      at.first_field = static_cast<std::int32_t>(contacts.fields.size());
      at.first_pair = static_cast<std::int32_t>(contacts.pairs.size());
      for (int axis = 0; axis < 3; ++axis) {
        at.index[axis] = 4 * workspace_.slots[block.first_slot].block[axis] + ((node >> (2 * axis)) & 3);
        at.place[axis] = model_.grid.domain_min[axis] + model_.grid.cell_size * at.index[axis];
      }
      collect_fields(block, at, contacts);
      collect_walls(at, contacts);
      if (at.fields > 1) collect_pairs(block, at, contacts);
      if (at.pairs == 0) {
        contacts.fields.resize(at.first_field);
        continue;
      }
      contacts.nodes.push_back(at);
    }
  }

 private:
  void collect_fields(const MixedBlock& block, ContactNode& at, BlockContacts& contacts) {
    // The sums of a two-dimensional model are those of the section.
    const bool planar = model_.grid.planar();
    const double h = model_.grid.cell_size, cell_volume = planar ? h * h : h * h * h;
    for (std::int32_t s = block.first_slot; s < block.first_slot + block.count; ++s) {
      const Slot& slot = workspace_.slots[s];
      const NodeRecord& record = workspace_.nodes[static_cast<std::size_t>(s) * block_nodes + at.node];
      if (!(record.v[3] > 0)) continue;
      const std::size_t place = static_cast<std::size_t>(slot.contact) * block_nodes + at.node;
      const ContactRecord& sums = workspace_.contacts[place];
      ContactField field;
      field.slot = s;
      field.body = slot.field;
      field.rigid = slot.rigid;
      field.fixed = slot.rigid >= 0 && workspace_.rigid[slot.rigid].prescribed;
      field.lagrangian = slot.lagrangian;
      if (slot.guided() && !field.fixed) at.coupled = true;
      field.mass = record.v[3];
      field.fill = sums.volume / cell_volume;
      const double density = model_.material_of(slot.field).density, inverse_density = 1.0 / density;
      for (int c = 0; c < 3; ++c) {
        field.outward[c] = sums.gradient[c];
        field.gradient[c] = sums.gradient[c] * inverse_density;
      }
      // Deep inside a body the gradient is round-off.
      const double steepness = length(field.outward) * model_.grid.cell_size;
      const double mass = planar ? sums.volume * density : field.mass;
      if (!(steepness > least_steepness * mass && make_unit(field.outward))) field.outward = {};
      if (workspace_.contact_needs.occupied)
        for (int cell = 0; cell < 8; ++cell)
          if (workspace_.occupied[place] >> cell & 1)
            for (int c = 0; c < 3; ++c) field.occupied[c] += cell >> c & 1 ? -1 : 1;
      contacts.fields.push_back(field);
      ++at.fields;
    }
  }

  void collect_walls(ContactNode& at, BlockContacts& contacts) {
    if (at.fields == 0) return;
    const double reach = model_.numerics.reach();
    for (std::size_t w = 0; w < model_.walls.size(); ++w) {
      if (distance_to(model_.walls[w], at) >= reach) continue;
      ContactField field;
      field.body = -1 - static_cast<std::int32_t>(w);
      field.fixed = true;
      contacts.fields.push_back(field);
      ++at.fields;
    }
  }

  // In cells, positive before the wall.
  double distance_to(const Wall& wall, const ContactNode& at) const {
    return dot(minus(at.place, wall.point), wall.normal) / model_.grid.cell_size;
  }

  void collect_pairs(const MixedBlock& block, ContactNode& at, BlockContacts& contacts) {
    ContactField* fields = contacts.fields.data() + at.first_field;
    double total_fill = 0;
    for (int f = 0; f < at.fields; ++f) total_fill += fields[f].fill;
    for (int a = 0; a < at.fields; ++a)
      for (int b = a + 1; b < at.fields; ++b) {
        const ContactField &first = fields[a], &second = fields[b];
        if (first.fixed && second.fixed) continue;
        const Wall* wall = second.body < 0 ? &model_.walls[-1 - second.body] : nullptr;
        const ContactRule& rule = wall ? wall->rule : model_.rule_of(first.body, second.body);
        ContactPair pair;
        pair.a = a;
        pair.b = b;
        pair.method = &contact_method(rule.method);
        if (pair.method->has_friction) pair.friction = rule.friction;
        pair.strains = first.by_grid() || second.by_grid();
        pair.by_surface = by_surface(rule);
        if (!wall && pair.method->needs_normal &&
            std::min(first.mass, second.mass) < smallest_mass_share * (first.mass + second.mass))
          continue;
        if (pair.by_surface) {
          if (met_at_points(model_, first.body, second.body) || !surfaces_meet(at, first, second, pair)) continue;
        } else if (wall) {
          pair.normal = times(-1, wall->normal);
        } else if (pair.method->needs_normal) {
          if (!normal_of(block, rule, at, first, second, pair.normal)) continue;
        }
        const ShapeFunction shape = model_.numerics.shape_function;
        const double h = model_.grid.cell_size;
        if (pair.method->needs_normal && rule.detection == Detection::Gap) {
          // Where more than two bodies meet, what the others fill closes the gap too.
          const double others = total_fill - first.fill - second.fill;
          const double gap =
              wall ? surface_distance(shape, first.fill + others) + distance_to(*wall, at)
                   : std::min(surface_distance(shape, first.fill + others) + surface_distance(shape, second.fill),
                              surface_distance(shape, first.fill) + surface_distance(shape, second.fill + others));
          if (gap > rule.gap_offset) continue;
          if (!pair.strains) pair.gap = std::max(gap, 0.0) * h;
        }
        if (pair.method->needs_normal && !pair.by_surface && (first.rigid >= 0 || second.rigid >= 0)) {
          const double along = wall ? distance_to(*wall, at)
                                    : 0.5 * (surface_distance(shape, second.fill) - surface_distance(shape, first.fill));
          pair.beside = times(along * h, pair.normal);
        }
        if (!pair.strains && (first.lagrangian || second.lagrangian)) {
          pair.booked = true;
          pair.mapped = minus(mapped_velocity(first, pair, at), mapped_velocity(second, pair, at));
        }
        if (pair.method->remembers) pair.pressed = remembers(state_.contact_memory, at.index, first.body, second.body);
        contacts.pairs.push_back(pair);
        ++at.pairs;
      }
  }

  // Before the step's forces.
  Vector3 mapped_velocity(const ContactField& field, const ContactPair& pair, const ContactNode& at) const {
    if (field.slot < 0) return {};
    const double* v = workspace_.nodes[static_cast<std::size_t>(field.slot) * block_nodes + at.node].v;
    const Vector3 velocity = {v[0], v[1], v[2]};
    return field.rigid < 0 ? velocity : plus(velocity, cross(workspace_.rigid[field.rigid].spin, pair.beside));
  }

  bool normal_of(const MixedBlock& block, const ContactRule& rule, const ContactNode& at, const ContactField& first,
                 const ContactField& second, Vector3& normal) {
    NormalView view{first, second, rule.master == second.body, nullptr, {}};
    if (normal_rule(rule.normal).needs_cloud) {
      if (!have_cloud_) cloud_.gather(model_, state_, workspace_, block);
      have_cloud_ = true;
      view.cloud = &cloud_;
      for (int axis = 0; axis < 3; ++axis) view.place[axis] = (at.node >> (2 * axis)) & 3;
    }
    return pair_normal(rule.normal, view, normal) && into_faces(at, normal);
  }

  // False: no direction is left.
  bool into_faces(const ContactNode& at, Vector3& normal) const {
    // In a symmetry plane the normal lies in the plane; the sums say so, other rules to round-off.
    bool changed = false;
    if (model_.grid.planar() && normal[2] != 0) {
      normal[2] = 0;
      changed = true;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double cells = (model_.grid.domain_max[axis] - model_.grid.domain_min[axis]) / model_.grid.cell_size;
      const bool on_face = (model_.grid.face[2 * axis] != Face::Free && at.index[axis] == 0) ||
                           (model_.grid.face[2 * axis + 1] != Face::Free && at.index[axis] == std::lround(cells));
      if (!on_face || normal[axis] == 0) continue;
      normal[axis] = 0;
      changed = true;
    }
    return !changed || make_unit(normal);
  }

  // Normal, gap and place of a pair of rigid bodies, or of one and a wall, by their surfaces; false: it does not act here.
  bool surfaces_meet(const ContactNode& at, const ContactField& first, const ContactField& second, ContactPair& pair) const {
    const double reach = model_.numerics.reach() * model_.grid.cell_size;
    Meeting meeting;
    if (!meeting_of(model_, workspace_, first.body, second.body, at.place, reach, meeting)) return false;
    pair.normal = meeting.normal;
    pair.gap = std::max(meeting.gap, 0.0);
    pair.beside = minus(meeting.place, at.place);
    return into_faces(at, pair.normal);
  }

  const Model& model_;
  const State& state_;
  const Workspace& workspace_;
  NearbyParticles cloud_;
  bool have_cloud_ = false;
};

// ------------------------------------------------------------------------------------------------------------- solving

// Velocity of a field where the pair meets.
Vector3 velocity_of(const ContactField& field, const ContactPair& pair, const std::vector<RigidMotion>& rigid) {
  return field.rigid < 0 ? field.velocity : plus(field.velocity, cross(rigid[field.rigid].spin, pair.beside));
}

Vector3 relative_velocity(const ContactField& a, const ContactField& b, const ContactPair& pair,
                          const std::vector<RigidMotion>& rigid) {
  return minus(velocity_of(a, pair, rigid), velocity_of(b, pair, rigid));
}

struct Phase {
  bool at_end;
  StartUse use;
  double time_step;
};

// Which pairs act, and how many pairs share each field.
void decide(BlockContacts& contacts, ContactNode& node, const std::vector<RigidMotion>& rigid, const Phase& phase) {
  const bool at_end = phase.at_end;
  ContactField* fields = contacts.fields.data() + node.first_field;
  for (int f = 0; f < node.fields; ++f) {
    fields[f].velocity = fields[f].before;
    fields[f].acting = 0;
    fields[f].impulse = fields[f].couple = {};
  }
  for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p) {
    ContactPair& pair = contacts.pairs[p];
    const ContactField &a = fields[pair.a], &b = fields[pair.b];
    pair.found = relative_velocity(a, b, pair, rigid);
    pair.normal_impulse = 0;
    pair.tangential_impulse = {};
    pair.constraint = {};
    // The first phase is for the strain. Bodies without strain have all of their contact, friction included, in the second.
    const bool acts =
        at_end || (pair.strains && (phase.use != StartUse::Motion || !pair.method->start_reaches_particles));
    const auto rule = at_end ? pair.method->at_end : pair.method->at_start;
    if (!rule || !acts) continue;
    PairView view{pair.normal, {a.outward, b.outward}, pair.mapped, pair.adjusted, pair.found, pair.pressed, 0};
    if (pair.by_surface) view.own_normal[0] = pair.normal;
    if (b.body < 0 || pair.by_surface) view.own_normal[1] = times(-1, pair.normal);
    if (!at_end) view.mapped = view.adjusted = pair.found;
    if (pair.method->needs_stress && a.stress_volume + b.stress_volume > 0) {
      double sum = 0;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;  // shear component i is that of the other two axes
        sum += (a.normal_stress[i] + b.normal_stress[i]) * pair.normal[i] * pair.normal[i];
        sum += 2 * (a.normal_stress[3 + i] + b.normal_stress[3 + i]) * pair.normal[j] * pair.normal[k];
      }
      view.normal_stress = sum / (a.stress_volume + b.stress_volume);
    }
    pair.constraint = rule(view);
    if (pair.constraint.hold == Hold::Nothing) continue;
    if (pair.constraint.hold == Hold::Contact) pair.constraint.target += pair.gap / phase.time_step;
    ++fields[pair.a].acting;
    ++fields[pair.b].acting;
  }
}

// Inverse of a field's share in a pair; rigid ones that are free have theirs from the body.
double inverse_share(const ContactField& field) { return field.fixed ? 0 : field.acting / field.mass; }

void reduced_masses(BlockContacts& contacts, ContactNode& node) {
  const ContactField* fields = contacts.fields.data() + node.first_field;
  for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p) {
    ContactPair& pair = contacts.pairs[p];
    const ContactField &a = fields[pair.a], &b = fields[pair.b];
    const double m_a = a.mass / a.acting, m_b = b.mass / b.acting;
    pair.reduced_normal = pair.reduced_tangential = a.fixed ? m_b : b.fixed ? m_a : m_a * m_b / (m_a + m_b);
  }
}

// One sweep over the pairs of a node: changes the velocities of deformable fields, gives `push(field, impulse, beside)` what
// free rigid ones are to get, and returns the largest relative velocity that was asked away.
template <class Push>
double sweep(BlockContacts& contacts, const ContactNode& node, const std::vector<RigidMotion>& rigid, double& scale,
             Push&& push) {
  ContactField* fields = contacts.fields.data() + node.first_field;
  for (int f = 0; f < node.fields; ++f) fields[f].change = {};
  double worst = 0;
  for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p) {
    ContactPair& pair = contacts.pairs[p];
    const Constraint& constraint = pair.constraint;
    if (constraint.hold == Hold::Nothing) continue;
    ContactField &a = fields[pair.a], &b = fields[pair.b];
    const Vector3 relative = relative_velocity(a, b, pair, rigid);
    const double along = dot(relative, pair.normal);
    scale = std::max(scale, length(relative));

    double normal = pair.normal_impulse + pair.reduced_normal * (along - constraint.target);
    if (constraint.hold == Hold::Contact) normal = std::max(normal, 0.0);
    const double normal_change = normal - pair.normal_impulse;
    pair.normal_impulse = normal;
    worst = std::max(worst, std::abs(normal_change) / pair.reduced_normal);

    Vector3 tangential_change{};
    if (constraint.hold == Hold::Stick || (constraint.friction && pair.friction > 0)) {
      Vector3 tangential;
      for (int c = 0; c < 3; ++c)
        tangential[c] =
            pair.tangential_impulse[c] - pair.reduced_tangential * (relative[c] - along * pair.normal[c]);
      if (constraint.hold != Hold::Stick) {
        const double most = pair.friction * (std::max(normal, 0.0) + pair.start_push), size = length(tangential);
        if (size > most)
          for (double& c : tangential) c *= most / size;
      }
      tangential_change = minus(tangential, pair.tangential_impulse);
      pair.tangential_impulse = tangential;
      worst = std::max(worst, length(tangential_change) / pair.reduced_tangential);
    }
    const Vector3 impulse = minus(tangential_change, times(normal_change, pair.normal));
    add(a.change, impulse);
    add(b.change, times(-1, impulse));
    if (a.rigid >= 0) push(a, impulse, pair.beside);
    if (b.rigid >= 0) push(b, times(-1, impulse), pair.beside);
  }
  for (int f = 0; f < node.fields; ++f) {
    ContactField& field = fields[f];
    if (!field.fixed && field.rigid < 0 && !field.lagrangian) add(field.velocity, times(1 / field.mass, field.change));
  }
  return worst;
}

Vector3 impulse_on_a(const ContactPair& pair) {
  return minus(pair.tangential_impulse, times(pair.normal_impulse, pair.normal));
}

void sum_up(BlockContacts& contacts, ContactNode& node) {
  ContactField* fields = contacts.fields.data() + node.first_field;
  for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p) {
    const ContactPair& pair = contacts.pairs[p];
    if (pair.constraint.hold == Hold::Nothing) continue;
    ContactField &a = fields[pair.a], &b = fields[pair.b];
    const Vector3 impulse = impulse_on_a(pair);
    add(a.impulse, impulse);
    add(b.impulse, times(-1, impulse));
    const Vector3 couple = cross(pair.beside, impulse);
    add(a.couple, couple);
    add(b.couple, times(-1, couple));
  }
}

// The work of a pair's impulses, which is their part in the change of kinetic energy. A deformable field goes from v to v' in the
// step by all forces together, m (v' - v) . (v + v') / 2, of which an impulse has the part of its size: its work is done at the
// mean of v and v'. (With the trial velocity in place of v, the force of every step would first make the slip that friction
// takes back: a contact that sticks would heat.) v is what the particles have, without what the first phase kept from them.
// Forces on a rigid body act one after the other, contact last: its mean is that of the velocities before and after contact.
void measure_work(BlockContacts& contacts, const ContactNode& node, const std::vector<RigidMotion>& rigid) {
  const ContactField* fields = contacts.fields.data() + node.first_field;
  for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p) {
    ContactPair& pair = contacts.pairs[p];
    if (pair.constraint.hold == Hold::Nothing) continue;
    const ContactField &a = fields[pair.a], &b = fields[pair.b];
    Vector3 mean = times(0.5, plus(pair.found, relative_velocity(a, b, pair, rigid)));
    add(mean, minus(a.behind, b.behind));
    const double tangential_work = dot(pair.tangential_impulse, mean);
    const bool heat = pair.constraint.hold != Hold::Stick;
    pair.friction_dissipation = heat ? -tangential_work : 0;
    pair.contact_work = (heat ? 0 : tangential_work) - (pair.normal_impulse + pair.start_push) * dot(pair.normal, mean);
    contacts.friction_dissipation += pair.friction_dissipation;
    contacts.contact_work += pair.contact_work;
    // Central differences: an impulse at a time does the work of the mean of the velocities half a step before and after it.
    if (pair.booked) {
      const Vector3 about = times(0.5, plus(pair.mapped, relative_velocity(a, b, pair, rigid)));
      contacts.contact_dissipation -= dot(impulse_on_a(pair), about) + pair.friction_dissipation;
    }
  }
}

// The nodes of free rigid and total Lagrangian bodies.
class CoupledNodes {
 public:
  // Impulses on total Lagrangian bodies are kept where `moves`.
  CoupledNodes(Workspace& workspace, std::vector<RigidMotion>& rigid, bool moves)
      : workspace_(workspace), rigid_(rigid), moves_(moves) {}

  void solve() {
    for (std::size_t i = 0; i < workspace_.mixed.size(); ++i)
      for (ContactNode& node : workspace_.block_contacts[i].nodes)
        if (node.coupled) nodes_.push_back({&workspace_.block_contacts[i], &node});
    if (nodes_.empty()) return;
    share_masses();
    std::vector<Vector3> impulse(rigid_.size()), moment(rigid_.size());
    const bool lagrangian = !workspace_.lagrangian_contact.empty();
    bool free_rigid = false;
    for (const RigidMotion& body : rigid_) free_rigid = free_rigid || !body.prescribed;
    if (lagrangian && !free_rigid) relax();
    const int most = free_rigid ? most_coupled_sweeps : most_lagrangian_sweeps;
    const double tolerance = lagrangian ? lagrangian_tolerance : coupled_tolerance;
    for (int pass = 0; pass < most; ++pass) {
      double worst = 0, scale = 0;
      std::fill(impulse.begin(), impulse.end(), Vector3{});
      std::fill(moment.begin(), moment.end(), Vector3{});
      for (const auto& [contacts, node] : nodes_) {
        const Vector3& place = node->place;
        worst = std::max(worst, sweep(*contacts, *node, rigid_, scale,
                                      [&](const ContactField& field, const Vector3& push, const Vector3& beside) {
                                        if (field.fixed) return;
                                        const Vector3 r = minus(plus(place, beside), rigid_[field.rigid].centre);
                                        add(impulse[field.rigid], push);
                                        add(moment[field.rigid], cross(r, push));
                                      }));
      }
      for (std::size_t r = 0; r < rigid_.size(); ++r)
        if (!rigid_[r].prescribed) push(rigid_[r], impulse[r], moment[r]);
      for (const auto& [contacts, node] : nodes_) {
        const Vector3& place = node->place;
        for_free_rigid(*contacts, *node,
                       [&](ContactField& field) { field.velocity = rigid_[field.rigid].velocity_at(place); });
      }
      push_lagrangian();
      if (worst <= tolerance * scale) break;
    }
    for (const auto& [contacts, node] : nodes_) sum_up(*contacts, *node);
  }

 private:
  template <class Work>
  static void for_free_rigid(BlockContacts& contacts, const ContactNode& node, Work&& work) {
    for (int f = node.first_field; f < node.first_field + node.fields; ++f)
      if (contacts.fields[f].rigid >= 0 && !contacts.fields[f].fixed) work(contacts.fields[f]);
  }

  void push_lagrangian() {
    LagrangianContact& contact = workspace_.lagrangian_contact;
    if (contact.empty()) return;
    for (LagrangianContact::Field& field : contact.fields)
      field.impulse = workspace_.block_contacts[field.block].fields[field.field].change;
    contact.apply(workspace_, moves_ ? &contact.total : nullptr);
    for (const LagrangianContact::Field& field : contact.fields)
      add(workspace_.block_contacts[field.block].fields[field.field].velocity, field.change);
  }

  void relax() {
    for (const auto& [contacts, node] : nodes_)
      for (int p = node->first_pair; p < node->first_pair + node->pairs; ++p) {
        contacts->pairs[p].reduced_normal *= lagrangian_relaxation;
        contacts->pairs[p].reduced_tangential *= lagrangian_relaxation;
      }
  }

  void share_masses() {
    std::vector<double> nodal_mass(rigid_.size(), 0.0);
    for (const auto& [contacts, node] : nodes_)
      for_free_rigid(*contacts, *node, [&](ContactField& field) {
        if (field.acting > 0) nodal_mass[field.rigid] += field.mass * rigid_[field.rigid].images;
      });
    for (const auto& [contacts, node] : nodes_) {
      reduced_masses(*contacts, *node);
      const ContactField* fields = contacts->fields.data() + node->first_field;
      for (int p = node->first_pair; p < node->first_pair + node->pairs; ++p) {
        ContactPair& pair = contacts->pairs[p];
        if (pair.constraint.hold == Hold::Nothing) continue;
        double normal = 0, tangential = 0;
        for (const int f : {pair.a, pair.b}) {
          const ContactField& field = fields[f];
          if (field.rigid < 0 || field.fixed) {
            normal += inverse_share(field);
            tangential += inverse_share(field);
            continue;
          }
          const RigidMotion& body = rigid_[field.rigid];
          const double part = field.mass / (field.acting * nodal_mass[field.rigid]);
          const Vector3 r = minus(plus(node->place, pair.beside), body.centre);
          // Velocity at the node from a unit impulse along the normal, by rotation.
          const Vector3 turned = cross(times_matrix(body.inverse_inertia, cross(r, pair.normal)), r);
          const double along = dot(turned, pair.normal);
          const double across = length(minus(turned, times(along, pair.normal)));
          normal += (1 / body.mass + along + across) / part;
          tangential += (1 / body.mass + dot(r, r) * body.largest_inverse_inertia + across) / part;
        }
        pair.reduced_normal = 1 / normal;
        pair.reduced_tangential = 1 / tangential;
      }
    }
  }

  static Vector3 times_matrix(const Matrix3& m, const Vector3& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

  Workspace& workspace_;
  std::vector<RigidMotion>& rigid_;
  const bool moves_;
  std::vector<std::pair<BlockContacts*, ContactNode*>> nodes_;
};

// Runs work(block's contacts) over the mixed blocks in parallel.
template <class Work>
void for_blocks(Workspace& workspace, Work&& work) {
  const std::int64_t blocks = static_cast<std::int64_t>(workspace.mixed.size());
#pragma omp parallel for num_threads(workspace.threads) schedule(dynamic, 4) if (blocks > 1)
  for (std::int64_t i = 0; i < blocks; ++i) work(workspace.block_contacts[i]);
}

double* velocity_record(Workspace& workspace, const ContactField& field, const ContactNode& node, bool trial) {
  NodeRecord& record = workspace.nodes[static_cast<std::size_t>(field.slot) * block_nodes + node.node];
  return trial ? record.f : record.v;
}

// Loads velocities, decides, and solves all nodes.
void solve_phase(Workspace& workspace, std::vector<RigidMotion>& rigid, const Phase& phase) {
  bool any_free = !workspace.lagrangian_contact.empty();
  for (const RigidMotion& body : rigid) any_free = any_free || !body.prescribed;
  for_blocks(workspace, [&](BlockContacts& contacts) {
    for (ContactNode& node : contacts.nodes) {
      for (int f = node.first_field; f < node.first_field + node.fields; ++f) {
        ContactField& field = contacts.fields[f];
        field.before = {};
        if (field.slot < 0) continue;
        const double* v = velocity_record(workspace, field, node, phase.at_end);
        field.before = {v[0], v[1], v[2]};
        if (phase.at_end && workspace.contact_needs.stress && field.rigid < 0) {
          const std::int32_t contact = workspace.slots[field.slot].contact;
          const ContactStress& sums =
              workspace.contact_stress[static_cast<std::size_t>(contact) * block_nodes + node.node];
          std::copy_n(sums.direct, 3, field.normal_stress);
          std::copy_n(sums.shear, 3, field.normal_stress + 3);
          field.stress_volume = sums.volume;
        }
      }
      decide(contacts, node, rigid, phase);
      if (node.coupled) continue;
      solve_node(contacts, node, rigid);
      sum_up(contacts, node);
    }
  });
  if (any_free) CoupledNodes(workspace, rigid, phase.use != StartUse::Strain).solve();
}

// Momentum that walls and rigid bodies take, and the forces on bodies.
void book_impulses(State& state, Workspace& workspace, double dt) {
  for (std::size_t i = 0; i < workspace.mixed.size(); ++i)
    for (ContactNode& node : workspace.block_contacts[i].nodes)
      for (int f = node.first_field; f < node.first_field + node.fields; ++f) {
        ContactField& field = workspace.block_contacts[i].fields[f];
        // In the first phase only what reaches the particles is an impulse; see start_contact.
        if (field.slot < 0) {
          for (int c = 0; c < 3; ++c) state.ledger.boundary_impulse[c] -= field.impulse[c];
          continue;
        }
        for (int c = 0; c < 3; ++c) workspace.slot_contact_force[field.slot][c] += field.impulse[c] / dt;
        if (field.rigid < 0) continue;
        RigidMotion& body = workspace.rigid[field.rigid];
        add(body.impulse, field.impulse);
        if (body.prescribed)
          body.contact_work += dot(field.impulse, field.before) + dot(field.couple, body.spin);
        else
          add(state.ledger.contact_couple, field.couple);
      }
}

// Where bodies share one velocity field there are only walls, and nothing says which body pushes on them.
void book_contact_forces(const Model& model, State& state, const Workspace& workspace) {
  for (BodyState& body : state.bodies) body.totals.contact_force = {};
  if (!model.own_fields && model.bodies.size() > 1) return;
  for (const MixedBlock& block : workspace.mixed)
    for (std::int32_t s = block.first_slot; s < block.first_slot + block.count; ++s)
      add(state.bodies[workspace.slots[s].field].totals.contact_force, workspace.slot_contact_force[s]);
}

// What passed between the pairs of bodies in a phase, node by node: as the forces on bodies and the ledger's energies.
void book_pairs(State& state, const Workspace& workspace, double dt, bool at_end) {
  for (std::size_t i = 0; i < workspace.mixed.size(); ++i) {
    const BlockContacts& contacts = workspace.block_contacts[i];
    for (const ContactNode& node : contacts.nodes)
      for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p) {
        const ContactPair& at_node = contacts.pairs[p];
        if (at_node.constraint.hold == Hold::Nothing) continue;
        const std::int32_t a = contacts.fields[node.first_field + at_node.a].body;
        const std::int32_t b = contacts.fields[node.first_field + at_node.b].body;
        Vector3 impulse = impulse_on_a(at_node);
        if (b < 0 || impulse == Vector3{}) continue;  // a wall, or nothing passed
        if (!at_end && !at_node.method->start_reaches_particles) impulse = {};
        PairTotals& pair = pair_totals(state, a, b);
        add(pair.force, times(1 / dt, impulse));
        add(pair.impulse, impulse);
        pair.friction_dissipation += at_node.friction_dissipation;
        pair.contact_work += at_node.contact_work;
      }
  }
}

void book_energies(State& state, const Workspace& workspace) {
  for (std::size_t i = 0; i < workspace.mixed.size(); ++i) {
    state.ledger.friction_dissipation += workspace.block_contacts[i].friction_dissipation;
    state.ledger.contact_work += workspace.block_contacts[i].contact_work;
    state.ledger.contact_dissipation += workspace.block_contacts[i].contact_dissipation;
  }
}

}  // namespace

void book_held_contact(State& state, Workspace& workspace) {
  LagrangianContact& contact = workspace.lagrangian_contact;
  if (contact.empty()) return;
  for (std::size_t i = 0; i < workspace.mixed.size(); ++i)
    for (ContactField& field : workspace.block_contacts[i].fields) field.change = {};
  for (const LagrangianContact::Field& field : contact.fields)
    workspace.block_contacts[field.block].fields[field.field].change = field.change;
  for (std::size_t i = 0; i < workspace.mixed.size(); ++i) {
    const BlockContacts& contacts = workspace.block_contacts[i];
    for (const ContactNode& node : contacts.nodes)
      for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p) {
        const ContactPair& pair = contacts.pairs[p];
        if (!pair.booked || pair.constraint.hold == Hold::Nothing) continue;
        const ContactField* fields = contacts.fields.data() + node.first_field;
        state.ledger.contact_dissipation -=
            0.5 * dot(impulse_on_a(pair), minus(fields[pair.a].change, fields[pair.b].change));
      }
  }
}

double surface_distance(ShapeFunction shape, double fraction) {
  // The filled part as a function of distance is the integral of the shape function beyond it, symmetric about 1/2.
  if (fraction > 0.5) return -surface_distance(shape, std::max(0.0, 1.0 - fraction));
  if (shape == ShapeFunction::Linear) return 1.0 - std::sqrt(2.0 * fraction);
  if (shape == ShapeFunction::Gimp) {
    constexpr double l = gimp_half_width;
    if (fraction <= l * l * (2.0 / 3.0)) return 1.0 + l - std::cbrt(12.0 * l * fraction);
    if (fraction <= 0.5 * (1 - l) * (1 - l) + l * l / 6) return 1.0 - std::sqrt(2.0 * fraction - l * l / 3);
    // 1/2 - (1 - l/2) s + s^3 / (6 l) = fraction for 0 <= s <= l.
    double s = (0.5 - fraction) / (1 - 0.5 * l);
    for (int i = 0; i < 4; ++i)
      s -= (0.5 - (1 - 0.5 * l) * s + s * s * s / (6 * l) - fraction) / (s * s / (2 * l) - (1 - 0.5 * l));
    return s;
  }
  if (fraction <= 1.0 / 6.0) return 1.5 - std::cbrt(6.0 * fraction);
  // 1/2 - 3/4 s + s^3/3 = fraction for 0 <= s <= 1/2, by Newton; s = (1/2 - fraction) 4/3 is close already.
  double s = (0.5 - fraction) * (4.0 / 3.0);
  for (int i = 0; i < 4; ++i) s -= (0.5 - 0.75 * s + s * s * s / 3.0 - fraction) / (s * s - 0.75);
  return s;
}

PairTotals& pair_totals(State& state, std::int32_t a, std::int32_t b) {
  auto pair = std::lower_bound(state.pairs.begin(), state.pairs.end(), std::pair(a, b),
                               [](const PairTotals& left, const std::pair<std::int32_t, std::int32_t>& right) {
                                 return std::pair(left.a, left.b) < right;
                               });
  if (pair == state.pairs.end() || pair->a != a || pair->b != b) {
    pair = state.pairs.insert(pair, PairTotals{});
    pair->a = a;
    pair->b = b;
  }
  return *pair;
}

ContactNeeds contact_needs(const Model& model) {
  ContactNeeds needs;
  const auto rule = [&](const ContactRule& r, bool wall) {
    const ContactMethodDef& method = contact_method(r.method);
    needs.any = true;
    needs.start = needs.start || method.at_start;
    needs.start_kept = needs.start_kept || (method.at_start && !method.start_reaches_particles);
    needs.stress = needs.stress || method.needs_stress;
    needs.memory = needs.memory || method.remembers;
    needs.surface = needs.surface || by_surface(r);
    if (wall || !method.needs_normal) return;
    needs.occupied = needs.occupied || normal_rule(r.normal).needs_occupied;
    needs.cloud = needs.cloud || normal_rule(r.normal).needs_cloud;
  };
  if (model.own_fields && model.bodies.size() > 1) {
    rule(model.contact, false);
    for (const PairRule& pair : model.pairs) rule(pair.rule, false);
  }
  for (const Wall& wall : model.walls) rule(wall.rule, true);
  return needs;
}

void find_contacts(const Model& model, const State& state, Workspace& workspace) {
  const std::int64_t blocks = static_cast<std::int64_t>(workspace.mixed.size());
  if (workspace.block_contacts.size() < workspace.mixed.size()) workspace.block_contacts.resize(workspace.mixed.size());
  if (workspace.contact_needs.surface) place_surfaces(model, state, workspace);
  std::exception_ptr failure;  // want of memory must not leave the parallel region
#pragma omp parallel num_threads(workspace.threads) if (blocks > 1)
  {
    Finder finder(model, state, workspace);
#pragma omp for schedule(dynamic, 4)
    for (std::int64_t i = 0; i < blocks; ++i) try {
        finder.find(workspace.mixed[i], workspace.block_contacts[i]);
      } catch (...) {
#pragma omp critical(ogive_contact_failure)
        failure = std::current_exception();
      }
  }
  if (failure) std::rethrow_exception(failure);
  if (workspace.contact_needs.surface) find_points(model, state, workspace);
  for (const MixedBlock& block : workspace.mixed)
    for (std::int32_t s = block.first_slot; s < block.first_slot + block.count; ++s) workspace.slot_contact_force[s] = {};
  workspace.lagrangian_contact.find(model, state, workspace);
}

void solve_node(BlockContacts& contacts, ContactNode& node, const std::vector<RigidMotion>& rigid) {
  int acting = 0;
  for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p)
    if (contacts.pairs[p].constraint.hold != Hold::Nothing) ++acting;
  if (acting == 0) return;
  reduced_masses(contacts, node);
  for (int pass = 0; pass < (acting == 1 ? 1 : most_sweeps); ++pass) {
    double scale = 0;
    const double worst =
        sweep(contacts, node, rigid, scale, [](const ContactField&, const Vector3&, const Vector3&) {});
    if (worst <= sweep_tolerance * scale) break;
  }
}

void start_contact(const Model& model, State& state, Workspace& workspace, double dt, StartUse use) {
  if (use != StartUse::Strain)
    for (PairTotals& pair : state.pairs) pair.force = {};
  if (!workspace.contact_needs.start) return;
  // The strain of a later mapping must not move the rigid bodies.
  std::vector<RigidMotion> copy;
  if (use == StartUse::Strain) copy = workspace.rigid;
  std::vector<RigidMotion>& rigid = use == StartUse::Strain ? copy : workspace.rigid;
  solve_phase(workspace, rigid, {false, use, dt});

  for_blocks(workspace, [&](BlockContacts& contacts) {
    for (ContactNode& node : contacts.nodes) {
      ContactField* fields = contacts.fields.data() + node.first_field;
      for (int f = 0; f < node.fields; ++f) fields[f].kept = fields[f].impulse = fields[f].couple = {};
      for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p) {
        ContactPair& pair = contacts.pairs[p];
        if (!pair.booked) pair.mapped = pair.found;
        ContactField &a = fields[pair.a], &b = fields[pair.b];
        pair.adjusted = relative_velocity(a, b, pair, rigid);
        // Without a first phase of its own the pair is shown what that would have left.
        if (pair.booked && pair.method->at_start && !pair.method->start_reaches_particles)
          add(pair.adjusted, times(-std::max(dot(pair.adjusted, pair.normal), 0.0), pair.normal));
        if (pair.constraint.hold == Hold::Nothing) continue;
        // `impulse` is what reaches the particles, `kept` the momentum that does not.
        const Vector3 impulse = impulse_on_a(pair), couple = cross(pair.beside, impulse);
        const bool reaches = pair.method->start_reaches_particles;
        if (reaches) pair.start_push = std::max(pair.normal_impulse, 0.0);
        add(reaches ? a.impulse : a.kept, impulse);
        add(reaches ? b.impulse : b.kept, times(-1, impulse));
        add(reaches ? a.couple : a.kept_couple, couple);
        add(reaches ? b.couple : b.kept_couple, times(-1, couple));
      }
      for (int f = 0; f < node.fields; ++f) {
        ContactField& field = fields[f];
        if (field.slot < 0) continue;
        double* v = velocity_record(workspace, field, node, false);
        for (int c = 0; c < 3; ++c) v[c] = field.velocity[c];
        if (!field.by_grid()) continue;
        field.kept = times(-1 / field.mass, field.kept);
        field.returned = times(-1 / field.mass, field.impulse);
      }
    }
  });
  if (workspace.contact_needs.surface) start_points(model, state, workspace, rigid, dt, use);
  if (use == StartUse::Strain) return;
  const double grid_part = model.numerics.renewed_fraction();
  if (workspace.contact_needs.start_kept && !workspace.lagrangian_contact.empty()) {
    LagrangianContact& contact = workspace.lagrangian_contact;
    for (LagrangianContact::Field& field : contact.fields)
      field.impulse = times(1 - grid_part, workspace.block_contacts[field.block].fields[field.field].kept);
    contact.apply(workspace, &contact.kept);
  }
  for (std::size_t i = 0; i < workspace.mixed.size(); ++i)
    for (ContactNode& node : workspace.block_contacts[i].nodes)
      for (int f = node.first_field; f < node.first_field + node.fields; ++f) {
        const ContactField& field = workspace.block_contacts[i].fields[f];
        // Particles that take the grid's own velocity see the start as well: that part of it stays with what they met.
        const Vector3 seen = times(grid_part, field.kept), unseen = times(1 - grid_part, field.kept);
        if (field.slot < 0) add(state.ledger.boundary_impulse, times(-1, seen));
        if (field.rigid < 0) continue;
        RigidMotion& body = workspace.rigid[field.rigid];
        const Vector3 couple = times(grid_part, field.kept_couple), unseen_couple = times(1 - grid_part, field.kept_couple);
        add(body.impulse, seen);
        if (body.prescribed)
          body.contact_work += dot(seen, field.before) + dot(couple, body.spin);
        else
          add(state.ledger.contact_couple, couple);
        add(body.kept_impulse, unseen);
        add(body.kept_moment, plus(cross(minus(node.place, body.centre), unseen), unseen_couple));
      }
  book_impulses(state, workspace, dt);
  book_pairs(state, workspace, dt, false);
}

void return_start(Workspace& workspace) {
  if (!workspace.contact_needs.start) return;
  for_blocks(workspace, [&](BlockContacts& contacts) {
    for (const ContactNode& node : contacts.nodes)
      for (int f = node.first_field; f < node.first_field + node.fields; ++f) {
        const ContactField& field = contacts.fields[f];
        if (!field.by_grid()) continue;
        double* v = velocity_record(workspace, field, node, false);
        for (int c = 0; c < 3; ++c) v[c] += field.returned[c];
      }
  });
  return_start_points(workspace);
}

void end_contact(const Model& model, State& state, Workspace& workspace, double dt) {
  solve_phase(workspace, workspace.rigid, {true, StartUse::MotionAndStrain, dt});
  for_blocks(workspace, [&](BlockContacts& contacts) {
    contacts.friction_dissipation = contacts.contact_work = contacts.contact_dissipation = 0;
    for (const ContactNode& node : contacts.nodes) {
      for (int f = node.first_field; f < node.first_field + node.fields; ++f) {
        ContactField& field = contacts.fields[f];
        field.behind = {};
        if (field.slot < 0) continue;
        const double* start = velocity_record(workspace, field, node, false);
        double* trial = velocity_record(workspace, field, node, true);
        for (int c = 0; c < 3; ++c) {
          if (field.by_grid()) field.behind[c] = 0.5 * (start[c] - field.before[c]) + field.kept[c];
          trial[c] = field.velocity[c];
        }
      }
      measure_work(contacts, node, workspace.rigid);
      for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p)
        contacts.pairs[p].pressed = contacts.pairs[p].method->remembers && contacts.pairs[p].normal_impulse > 0;
    }
  });
  book_impulses(state, workspace, dt);
  book_contact_forces(model, state, workspace);
  book_pairs(state, workspace, dt, true);
  book_energies(state, workspace);
  if (workspace.contact_needs.memory) state.contact_memory.clear();
  if (workspace.contact_needs.surface) end_points(state, workspace, dt);
  if (workspace.contact_needs.memory) {
    for (std::size_t i = 0; i < workspace.mixed.size(); ++i)
      for (const ContactNode& node : workspace.block_contacts[i].nodes)
        for (int p = node.first_pair; p < node.first_pair + node.pairs; ++p) {
          const BlockContacts& contacts = workspace.block_contacts[i];
          const ContactPair& pair = contacts.pairs[p];
          if (pair.pressed)
            remember(state.contact_memory, node.index, contacts.fields[node.first_field + pair.a].body,
                     contacts.fields[node.first_field + pair.b].body);
        }
    order_memory(state.contact_memory);
  }
}

void book_kept_start(State& state, const Workspace& workspace) {
  if (!workspace.contact_needs.start_kept) return;
  double given = 0;
  for (std::size_t i = 0; i < workspace.mixed.size(); ++i)
    for (const ContactNode& node : workspace.block_contacts[i].nodes)
      for (int f = node.first_field; f < node.first_field + node.fields; ++f) {
        const ContactField& field = workspace.block_contacts[i].fields[f];
        if (!field.by_grid()) continue;
        const NodeRecord& record = workspace.nodes[static_cast<std::size_t>(field.slot) * block_nodes + node.node];
        for (int c = 0; c < 3; ++c) given += record.v[3] * field.kept[c] * (record.f[c] - record.v[c]);
      }
  for (const ContactPoints::Start& start : workspace.points.start) {
    const NodeRecord& record = workspace.nodes[start.node];
    for (int c = 0; c < 3; ++c) given += record.v[3] * start.kept[c] * (record.f[c] - record.v[c]);
  }
  state.ledger.transfer_dissipation += given;
}

}  // namespace ogive
