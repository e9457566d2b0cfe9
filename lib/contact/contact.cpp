// Contact at shared nodes.
//
// Two bodies a, b with unit normal n out of a: they are in contact where both reach the node, the gap between their
// surfaces is below the offset, and they approach, (v_a - v_b) . n > 0, which is Eqs. (8), (12) and (23) written for the
// pair. The impulse m_a m_b / (m_a + m_b) (v_a - v_b) . n is Eq. (16), the friction Eq. (21) limited by Eq. (22).
//
// Three or more bodies: all pairs at once (Jacobi), each body's mass shared equally between its pairs, repeated until no
// pair approaches. Impulses are equal and opposite, so momentum is kept to round-off; no order of bodies is preferred; and
// sharing the mass keeps kinetic energy from growing. Two bodies need one pass, which is the papers' formula.
//
// The gap. A body whose flat surface lies at distance s from a node fills a known part of that node's shape
// function; inverting that gives s from the nodal volume, and the gap of a pair is s_a + s_b. It vanishes exactly when the
// two bodies together fill the node (docs/theory.md).
#include "contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

namespace ogive {
namespace {

// A body with less than this share of a pair's nodal mass is not felt: its normal and velocity are round-off.
constexpr double smallest_mass_share = 1e-6;
// Passes for three and more bodies; the approach that is left falls by about a factor 2 to 4 a pass.
constexpr int many_body_passes = 50;
constexpr double many_body_tolerance = 1e-10;

using Vec3 = Vector3;
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
bool make_unit(Vec3& a) {
  const double length = std::sqrt(dot(a, a));
  if (!(length > 0)) return false;
  for (double& c : a) c /= length;
  return true;
}

struct FieldAtNode {
  std::int32_t slot;  // within the mixed block
  int body;
  double mass, fill;
  Vec3 outward;  // unit gradient, zero if there is none
  Vec3 velocity, start;
  int pairs;
};

struct PairAtNode {
  int a, b;  // in the list of fields
  Vec3 normal;
  double friction;
};

// The fields present at one node of a mixed block, and its pairs in contact.
class ContactNode {
 public:
  explicit ContactNode(const Model& model) : model_(model) {}

  // False if there is no pair to look at.
  bool collect(const Workspace& workspace, const MixedBlock& block, int node, bool trial) {
    fields_.clear();
    const double cell_volume = std::pow(model_.grid.cell_size, 3);
    for (std::int32_t i = 0; i < block.count; ++i) {
      const Slot& slot = workspace.slots[block.first_slot + i];
      const NodeRecord& record = workspace.nodes[(static_cast<std::size_t>(block.first_slot) + i) * block_nodes + node];
      if (!(record.v[3] > 0)) continue;
      const ContactRecord& contact = workspace.contacts[static_cast<std::size_t>(slot.contact) * block_nodes + node];
      FieldAtNode field;
      field.slot = i;
      field.body = slot.field;
      field.mass = record.v[3];
      field.fill = contact.volume / cell_volume;
      field.outward = {contact.gradient[0], contact.gradient[1], contact.gradient[2]};
      if (!make_unit(field.outward)) field.outward = {0, 0, 0};
      field.start = {record.v[0], record.v[1], record.v[2]};
      field.velocity = trial ? Vec3{record.f[0], record.f[1], record.f[2]} : field.start;
      field.pairs = 0;
      fields_.push_back(field);
    }
    return fields_.size() > 1 && find_pairs();
  }

  // Removes the approach of all pairs. `impulse(field, vector)` books what each field gets, `friction_loss(energy)`.
  template <class Book>
  void resolve(bool with_friction, Book&& book) {
    const int passes = pairs_.size() == 1 ? 1 : many_body_passes;
    change_.assign(fields_.size(), Vec3{});
    for (int pass = 0; pass < passes; ++pass) {
      double worst = 0, scale = 0;
      for (Vec3& c : change_) c = {};
      for (const PairAtNode& pair : pairs_) {
        FieldAtNode &a = fields_[pair.a], &b = fields_[pair.b];
        const Vec3 relative = minus(a.velocity, b.velocity);
        const double approach = dot(relative, pair.normal);
        scale = std::max(scale, std::sqrt(dot(relative, relative)));
        if (!(approach > 0)) continue;
        worst = std::max(worst, approach);
        const double m_a = a.mass / a.pairs, m_b = b.mass / b.pairs;
        const double reduced = m_a * m_b / (m_a + m_b);
        const double normal_impulse = reduced * approach;
        Vec3 impulse;
        for (int c = 0; c < 3; ++c) impulse[c] = -normal_impulse * pair.normal[c];
        double friction_energy = 0;
        if (with_friction && pair.friction > 0) {
          Vec3 slip;
          for (int c = 0; c < 3; ++c) slip[c] = relative[c] - approach * pair.normal[c];
          const double slip_speed = std::sqrt(dot(slip, slip));
          if (slip_speed > 0) {
            // Eq. (22): the stick impulse, limited by Coulomb's law, against the slip.
            const double tangential = std::min(pair.friction * normal_impulse, reduced * slip_speed);
            for (int c = 0; c < 3; ++c) impulse[c] -= tangential * slip[c] / slip_speed;
            friction_energy = tangential * (slip_speed - 0.5 * tangential / reduced);
          }
        }
        for (int c = 0; c < 3; ++c) {
          change_[pair.a][c] += impulse[c] / a.mass;
          change_[pair.b][c] -= impulse[c] / b.mass;
        }
        book(a.slot, b.slot, impulse, friction_energy, 0.5 * normal_impulse * approach);
      }
      for (std::size_t f = 0; f < fields_.size(); ++f)
        for (int c = 0; c < 3; ++c) fields_[f].velocity[c] += change_[f][c];
      if (worst <= many_body_tolerance * scale) break;
    }
  }

  const std::vector<FieldAtNode>& fields() const { return fields_; }

 private:
  bool find_pairs() {
    pairs_.clear();
    double total_fill = 0;
    for (const FieldAtNode& field : fields_) total_fill += field.fill;
    for (int a = 0; a < static_cast<int>(fields_.size()); ++a)
      for (int b = a + 1; b < static_cast<int>(fields_.size()); ++b) {
        FieldAtNode &first = fields_[a], &second = fields_[b];
        if (std::min(first.mass, second.mass) < smallest_mass_share * (first.mass + second.mass)) continue;
        const ContactRule& rule = model_.rule_of(first.body, second.body);
        PairAtNode pair{a, b, {}, rule.friction};
        if (!pair_normal(first, second, rule, pair.normal)) continue;
        if (rule.detection == Detection::Gap) {
          // Where more than two bodies meet, what the others fill closes the gap too.
          const double others = total_fill - first.fill - second.fill;
          const ShapeFunction shape = model_.numerics.shape_function;
          const double gap =
              std::min(surface_distance(shape, first.fill + others) + surface_distance(shape, second.fill),
                       surface_distance(shape, first.fill) + surface_distance(shape, second.fill + others));
          if (gap > rule.gap_offset) continue;
        }
        ++first.pairs;
        ++second.pairs;
        pairs_.push_back(pair);
      }
    return !pairs_.empty();
  }

  // Unit normal out of the first body. Where the rule's own gradient vanishes (inside a body) the other body's serves.
  static bool pair_normal(const FieldAtNode& first, const FieldAtNode& second, const ContactRule& rule, Vec3& normal) {
    const Vec3 of_first = first.outward, of_second = {-second.outward[0], -second.outward[1], -second.outward[2]};
    const bool second_is_master = rule.normal == NormalRule::Master && rule.master == second.body;
    if (rule.normal == NormalRule::Average) {
      normal = {of_first[0] + of_second[0], of_first[1] + of_second[1], of_first[2] + of_second[2]};
    } else {
      normal = second_is_master ? of_second : of_first;
    }
    if (make_unit(normal)) return true;
    normal = second_is_master ? of_first : of_second;
    return make_unit(normal);
  }

  const Model& model_;
  std::vector<FieldAtNode> fields_;
  std::vector<PairAtNode> pairs_;
  std::vector<Vec3> change_;
};

struct BlockSums {
  double friction_dissipation = 0, contact_work = 0;
};

// Runs work(contact node, block, node, sums of the block) over all nodes of mixed blocks and books the sums in order.
template <class Work>
void for_contact_nodes(const Model& model, State& state, Workspace& workspace, bool trial, Work&& work) {
  const std::int64_t blocks = static_cast<std::int64_t>(workspace.mixed.size());
  std::vector<BlockSums> sums(workspace.mixed.size());
  std::exception_ptr failure;  // want of memory must not leave the parallel region
#pragma omp parallel num_threads(workspace.threads) if (blocks > 1)
  {
    ContactNode contact(model);
#pragma omp for schedule(dynamic, 4)
    for (std::int64_t i = 0; i < blocks; ++i) try {
        for (int node = 0; node < block_nodes; ++node)
          if (contact.collect(workspace, workspace.mixed[i], node, trial)) work(contact, workspace.mixed[i], node, sums[i]);
      } catch (...) {
#pragma omp critical(ogive_contact_failure)
        failure = std::current_exception();
      }
  }
  if (failure) std::rethrow_exception(failure);
  for (const BlockSums& s : sums) {
    state.ledger.friction_dissipation += s.friction_dissipation;
    state.ledger.contact_work += s.contact_work;
  }
}

// Adds this step's sums over pairs of fields to those of the pairs of bodies, block by block.
void book_pairs(State& state, const Workspace& workspace, double dt) {
  for (PairTotals& pair : state.pairs) pair.force = {};
  for (const MixedBlock& block : workspace.mixed)
    for (int i = 0; i < block.count; ++i)
      for (int j = i + 1; j < block.count; ++j) {
        const PairSums& sums = workspace.pair_sums[block.pair(i, j)];
        if (sums.contact_work == 0 && sums.force == Vector3{}) continue;
        const std::int32_t a = workspace.slots[block.first_slot + i].field, b = workspace.slots[block.first_slot + j].field;
        auto pair = std::lower_bound(state.pairs.begin(), state.pairs.end(), std::pair(a, b),
                                     [](const PairTotals& left, const std::pair<std::int32_t, std::int32_t>& right) {
                                       return std::pair(left.a, left.b) < right;
                                     });
        if (pair == state.pairs.end() || pair->a != a || pair->b != b) {
          pair = state.pairs.insert(pair, PairTotals{});
          pair->a = a;
          pair->b = b;
        }
        for (int c = 0; c < 3; ++c) pair->force[c] += sums.force[c];
        pair->friction_dissipation += sums.friction_dissipation;
        pair->contact_work += sums.contact_work;
      }
  for (PairTotals& pair : state.pairs)
    for (int c = 0; c < 3; ++c) pair.impulse[c] += pair.force[c] * dt;
}

}  // namespace

double surface_distance(ShapeFunction shape, double fraction) {
  // The filled part as a function of distance is the integral of the shape function beyond it, symmetric about 1/2.
  if (fraction > 0.5) return -surface_distance(shape, std::max(0.0, 1.0 - fraction));
  if (shape == ShapeFunction::Linear) return 1.0 - std::sqrt(2.0 * fraction);
  if (fraction <= 1.0 / 6.0) return 1.5 - std::cbrt(6.0 * fraction);
  // 1/2 - 3/4 s + s^3/3 = fraction for 0 <= s <= 1/2, by Newton; s = (1/2 - fraction) 4/3 is close already.
  double s = (0.5 - fraction) * (4.0 / 3.0);
  for (int i = 0; i < 4; ++i) s -= (0.5 - 0.75 * s + s * s * s / 3.0 - fraction) / (s * s - 0.75);
  return s;
}

void remove_approach(const Model& model, State& state, Workspace& workspace) {
  // Where the stress comes last only the strain sees it, and the grid loses nothing.
  const double booked = model.numerics.update_order == UpdateOrder::StressFirst ? 1.0 : 0.0;
  std::fill(workspace.approach.begin(), workspace.approach.end(), Vec3{});
  for_contact_nodes(
      model, state, workspace, false, [&](ContactNode& contact, const MixedBlock& block, int node, BlockSums& sums) {
        contact.resolve(false, [&](int, int, const Vec3&, double, double loss) { sums.contact_work -= booked * loss; });
        for (const FieldAtNode& field : contact.fields()) {
          const std::size_t slot = static_cast<std::size_t>(block.first_slot) + field.slot;
          double* v = workspace.nodes[slot * block_nodes + node].v;
          Vec3& taken = workspace.approach[static_cast<std::size_t>(workspace.slots[slot].contact) * block_nodes + node];
          for (int c = 0; c < 3; ++c) {
            taken[c] = v[c] - field.velocity[c];
            v[c] = field.velocity[c];
          }
        }
      });
}

void restore_approach(Workspace& workspace) {
  for (const MixedBlock& block : workspace.mixed)
    for (std::int32_t i = 0; i < block.count; ++i) {
      const std::size_t slot = static_cast<std::size_t>(block.first_slot) + i;
      const Vec3* taken = &workspace.approach[static_cast<std::size_t>(workspace.slots[slot].contact) * block_nodes];
      for (int node = 0; node < block_nodes; ++node)
        for (int c = 0; c < 3; ++c) workspace.nodes[slot * block_nodes + node].v[c] += taken[node][c];
    }
}

void apply_contact_force(const Model& model, State& state, Workspace& workspace, double dt) {
  for (const MixedBlock& block : workspace.mixed)
    for (std::int32_t i = 0; i < block.count; ++i) workspace.slot_contact_force[block.first_slot + i] = {};
  std::fill(workspace.pair_sums.begin(), workspace.pair_sums.end(), PairSums{});
  for_contact_nodes(
      model, state, workspace, true, [&](ContactNode& contact, const MixedBlock& block, int node, BlockSums& sums) {
        contact.resolve(true, [&](int a, int b, const Vec3& impulse, double friction, double loss) {
          sums.friction_dissipation += friction;
          sums.contact_work -= loss;
          PairSums& pair = workspace.pair_sums[block.pair(a, b)];
          pair.friction_dissipation += friction;
          pair.contact_work -= loss;
          for (int c = 0; c < 3; ++c) {
            pair.force[c] += impulse[c] / dt;
            workspace.slot_contact_force[block.first_slot + a][c] += impulse[c] / dt;
            workspace.slot_contact_force[block.first_slot + b][c] -= impulse[c] / dt;
          }
        });
        for (const FieldAtNode& field : contact.fields()) {
          double* trial =
              workspace.nodes[(static_cast<std::size_t>(block.first_slot) + field.slot) * block_nodes + node].f;
          for (int c = 0; c < 3; ++c) trial[c] = field.velocity[c];
        }
      });
  for (BodyState& body : state.bodies) body.totals.contact_force = {};
  for (const MixedBlock& block : workspace.mixed)
    for (std::int32_t i = 0; i < block.count; ++i) {
      // Fields are bodies wherever there are mixed blocks.
      Vector3& force = state.bodies[workspace.slots[block.first_slot + i].field].totals.contact_force;
      for (int c = 0; c < 3; ++c) force[c] += workspace.slot_contact_force[block.first_slot + i][c];
    }
  book_pairs(state, workspace, dt);
}

}  // namespace ogive
