// Contact of total Lagrangian bodies on the common grid.
//
// Their particles give the nodes of the common grid mass, momentum, normals and fill, as those of any body. An impulse
// J_I that contact finds at a node goes back the same way,
//   J_p = sum_I m_p N_I(x_p) / m_I J_I,  J_a = sum_p N_a(X_p) J_p,  dV_a = J_a / M_a,
// so that momentum is kept to round-off. What the node then sees of it,
//   dv_I = sum_p m_p N_I(x_p) / m_I sum_a N_a(X_p) dV_a,
// is less than J_I / m_I: the two passes smooth. Were it left at that, bodies would go on approaching, sink into one
// another and lose energy. The impulses of a node are therefore found again from what the node sees, until next to
// nothing is missing. The map from J_I / m_I to dv_I is symmetric with eigenvalues of 0..1 in the inner product of the
// nodal masses: the sweeps of contact.cpp are descents of the bodies' true kinetic energy and cannot overshoot.
#pragma once

#include <cstdint>
#include <vector>

#include "model.hpp"
#include "vector3.hpp"

namespace ogive {

struct State;
struct Workspace;
struct BlockContacts;
struct ContactField;
struct NodeRecord;

// Weight of a node, and the components (bits) that change their sign where the node lies beyond a mirror.
struct NodeWeight {
  std::int64_t node = 0;
  double weight = 0;
  std::int32_t mirrored = 0;
};

class LagrangianContact {
 public:
  // A field of a total Lagrangian body at a node of contact.
  struct Field {
    std::int32_t block = 0, field = 0;  // in Workspace::block_contacts
    std::int32_t node = 0;              // within the block
    double mass = 0;
    std::int32_t held = 0;  // components that a mirror in the node holds
    Vector3 impulse{};      // asked for in a sweep
    Vector3 change{};       // of its velocity
  };
  struct Particle {
    std::int32_t fields_end = 0, nodes_end = 0;
  };
  // A vector with a fourth component for the sake of the processor.
  struct Record {
    double c[4] = {};
    void add(double weight, const Record& other) {
      for (int i = 0; i < 4; ++i) c[i] += weight * other.c[i];
    }
    Record mirrored(std::int32_t signs) const {
      return {{signs & 1 ? -c[0] : c[0], signs & 2 ? -c[1] : c[1], signs & 4 ? -c[2] : c[2], 0}};
    }
  };

  std::vector<Field> fields;
  std::vector<Particle> particles;        // those that reach such a node
  std::vector<NodeWeight> field_weights;  // node: index in `fields`; weight: m_p N_I / m_I
  std::vector<NodeWeight> node_weights;   // node: of the reference grid
  std::vector<std::int64_t> touched;      // nodes of the reference grid that they reach
  std::vector<Record> push;               // momentum, then velocity, by node of the reference grid
  std::vector<Record> at_field;           // by index in `fields`
  std::vector<Vector3> total;             // velocity given to it in this step
  std::vector<Vector3> kept;              // part of it that moves the nodes and is then taken back
  std::vector<std::int64_t> touched_by_points;  // nodes with `kept` of contact at points
  Vector3 mirror_impulse{};               // what mirrors gave to the impulses of `total` without `kept`
  // Of each node with contact records: index in `fields`, -1 none; components that change their sign.
  std::vector<std::int32_t> at, mirrored, held;

  bool empty() const { return fields.empty(); }
  bool keeps() const { return !fields.empty() || !touched_by_points.empty(); }
  void find(const Model& model, const State& state, Workspace& workspace);
  // The change of the fields' velocities by `impulse` of all of them. The velocity that the reference grid gets is
  // added to `sum`, by node; null: it gets none.
  void apply(const Workspace& workspace, std::vector<Vector3>* sum);
  // Adds `total` to the reference grid's trial velocities; it is zero then.
  void give_total(Workspace& workspace);
  // Adds to `kept` of a node of the reference grid.
  void keep(std::int64_t node, const Vector3& velocity);
  // The change of the fields' velocities by the reference grid's own trial velocities.
  void see_trial(const Workspace& workspace);
  // The same by what happens to those velocities between the two.
  void begin_change(const Workspace& workspace);
  void end_change(const Workspace& workspace);

  // Calls visit(field, the contact's field, node record) for all fields.
  template <class Space, class Visit>
  void for_records(Space& workspace, Visit&& visit) const {
    for (const Field& field : fields) {
      const auto& contacts = workspace.block_contacts[field.block];
      const auto& of = contacts.fields[field.field];
      visit(field, of, workspace.nodes[static_cast<std::size_t>(of.slot) * 64 + field.node]);
    }
  }

 private:
  // The change of the fields' velocities by the velocities in `push`, which is emptied.
  void gather();
};

}  // namespace ogive
