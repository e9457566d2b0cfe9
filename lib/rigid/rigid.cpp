// Rigid bodies. A step of a free one: with angular momentum L = I w about the centre of mass,
//   V' = V + (J + m g dt) / m,  L' = L + M,  c' = c + dt V',
// and the body turns by w_h dt, w_h = I_h^-1 L' with the inertia turned half way; w' = I'^-1 L'. Without contact momentum
// and angular momentum stay exactly, the energy to second order.
#include "rigid/rigid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "audit.hpp"

#include "loads/loads.hpp"

namespace ogive {
namespace {

Vector3 product(const Matrix3& m, const Vector3& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

Vector3 transposed_product(const Matrix3& m, const Vector3& v) {
  Vector3 r{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r[j] += m[i][j] * v[i];
  return r;
}

Vector3 column(const Matrix3& m, int j) { return {m[0][j], m[1][j], m[2][j]}; }

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r[i][j] = dot(a[i], column(b, j));
  return r;
}

// Rotation by the vector `turn` (Rodrigues).
Matrix3 rotation(const Vector3& turn) {
  const double angle = length(turn);
  const double s = angle > 0 ? std::sin(angle) / angle : 1;
  const double half = 0.5 * angle, sine = half > 0 ? std::sin(half) / half : 1, c = 0.5 * sine * sine;
  Matrix3 r{};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    r[i][i] = 1 - c * (turn[j] * turn[j] + turn[k] * turn[k]);
    r[i][j] = c * turn[i] * turn[j] - s * turn[k];
    r[i][k] = c * turn[i] * turn[k] + s * turn[j];
  }
  return r;
}

// Of a symmetric positive definite matrix.
Matrix3 inverse_of(const Matrix3& m) {
  Matrix3 cofactor{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      cofactor[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
  const double determinant = dot(m[0], cofactor[0]);
  for (Vector3& row : cofactor)
    for (double& x : row) x /= determinant;
  return cofactor;
}

struct GroupSums {
  double mass = 0, speed_squared = 0, energy = 0;
  Vector3 first{};
  double second[6] = {};  // xx yy zz yz xz xy
  bool outside = false;
};

// Sums of all groups of a body in order; work(particle, sums) for the real particles.
template <class Work>
GroupSums sum_groups(const BodyState& body, int threads, Work&& work) {
  std::vector<GroupSums> parts(body.groups.size());
  const std::int64_t count = static_cast<std::int64_t>(parts.size());
#pragma omp parallel for num_threads(threads) schedule(static) if (count > 8)
  for (std::int64_t g = 0; g < count; ++g) {
    const Group& group = body.groups[g];
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) work(p, parts[g]);
  }
  GroupSums total;
  for (const GroupSums& part : parts) {
    total.mass += part.mass;
    total.energy += part.energy;
    add(total.first, part.first);
    for (int i = 0; i < 6; ++i) total.second[i] += part.second[i];
  }
  return total;
}

// Mass, centre and inertia of the whole body from its particles; `guess` is any point near the centre.
void measure(const Model& model, const State& state, int index, int threads, RigidMotion& motion) {
  const Body& rules = model.bodies[index];
  const BodyState& body = state.bodies[index];
  motion.cut = rules.cut;
  motion.images = 1 << (rules.cut[0] + rules.cut[1] + rules.cut[2]);
  const Vector3 near = body.rigid.centre;
  const GroupSums sums = sum_groups(body, threads, [&](std::int64_t p, GroupSums& s) {
    const double* x = &body.position[4 * p];
    const double m = x[3], r[3] = {x[0] - near[0], x[1] - near[1], x[2] - near[2]};
    s.mass += m;
    for (int i = 0; i < 3; ++i) {
      s.first[i] += m * r[i];
      s.second[i] += m * r[i] * r[i];
      s.second[3 + i] += m * r[(i + 1) % 3] * r[(i + 2) % 3];
    }
  });
  motion.mass = sums.mass * motion.images;
  if (!(sums.mass > 0)) return;
  Vector3 offset = times(1 / sums.mass, sums.first);
  double second[6];
  for (int i = 0; i < 6; ++i) second[i] = sums.second[i] * motion.images;
  for (int axis = 0; axis < 3; ++axis) {
    if (!rules.cut[axis]) continue;
    const Grid& grid = model.grid;
    const bool low = std::abs(near[axis] - grid.domain_min[axis]) < std::abs(near[axis] - grid.domain_max[axis]);
    offset[axis] = (low ? grid.domain_min[axis] : grid.domain_max[axis]) - near[axis];
    // About the plane, where the products with the images' cancel.
    second[axis] += motion.mass * (offset[axis] * offset[axis]) - 2 * motion.images * offset[axis] * sums.first[axis];
  }
  const Vector3 mean = times(1 / sums.mass, sums.first);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (!rules.cut[i]) second[i] -= motion.mass * mean[i] * mean[i];
    second[3 + i] = rules.cut[j] || rules.cut[k] ? 0 : second[3 + i] - motion.mass * mean[j] * mean[k];
  }
  motion.centre = plus(near, offset);
  const double own = motion.mass * rules.own_inertia;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    motion.inertia[i][i] = second[j] + second[k] + own;
    motion.inertia[j][k] = motion.inertia[k][j] = -second[3 + i];
  }
  motion.inverse_inertia = inverse_of(motion.inertia);
  // Gershgorin's bound.
  motion.largest_inverse_inertia = 0;
  for (const Vector3& row : motion.inverse_inertia)
    motion.largest_inverse_inertia =
        std::max(motion.largest_inverse_inertia, std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
}

double kinetic_energy(const BodyState& body, double own_inertia, int threads) {
  return sum_groups(body, threads, [&](std::int64_t p, GroupSums& s) {
           const double* v = &body.velocity[4 * p];
           s.energy += 0.5 * body.position[4 * p + 3] *
                       (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + own_inertia * dot(body.rigid.spin, body.rigid.spin));
         }).energy;
}

// Linear interpolation in the table's column.
Vector3 between(const Vector3& a, const Vector3& b, double t) { return plus(times(1 - t, a), times(t, b)); }

}  // namespace

MotionKnot motion_at(const Body& body, double time) {
  const auto after = std::upper_bound(body.motion.begin(), body.motion.end(), time,
                                      [](double t, const MotionKnot& knot) { return t < knot.time; });
  if (after == body.motion.begin()) return {time, body.motion.front().velocity, body.motion.front().angular_velocity};
  if (after == body.motion.end()) return {time, body.motion.back().velocity, body.motion.back().angular_velocity};
  const MotionKnot &a = *(after - 1), &b = *after;
  const double t = (time - a.time) / (b.time - a.time);
  return {time, between(a.velocity, b.velocity, t), between(a.angular_velocity, b.angular_velocity, t)};
}

void prepare_rigid(const Model& model, State& state) {
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const Body& rules = model.bodies[b];
    BodyState& body = state.bodies[b];
    if (!rules.rigid()) continue;
    if (rules.prescribed()) {
      const MotionKnot start = motion_at(rules, state.time);
      body.rigid.centre = rules.reference;
      body.rigid.velocity = start.velocity;
      body.rigid.spin = start.angular_velocity;
      body.totals.initial_velocity = {};
    }
    Vector3 momentum{};
    double mass = 0;
    for (std::int64_t p = 0; p < body.padded; ++p) {
      const double* x = &body.position[4 * p];
      const Vector3 v = plus(body.rigid.velocity, cross(body.rigid.spin, minus({x[0], x[1], x[2]}, body.rigid.centre)));
      for (int c = 0; c < 3; ++c) body.velocity[4 * p + c] = v[c];
      add(momentum, times(x[3], v));
      mass += x[3];
    }
    body.totals.initial_velocity = times(1 / mass, momentum);
  }
}

void begin_rigid_step(const Model& model, const State& state, Workspace& workspace, double dt) {
  for (RigidMotion& motion : workspace.rigid) {
    const int b = motion.body;
    const Body& rules = model.bodies[b];
    const RigidState& now = state.bodies[b].rigid;
    if (rules.prescribed()) {
      motion.mass = state.bodies[b].particles > 0 ? std::numeric_limits<double>::infinity() : 0;
      const MotionKnot middle = motion_at(rules, state.time + 0.5 * dt);
      motion.velocity = middle.velocity;
      motion.spin = middle.angular_velocity;
      motion.centre = now.centre;
    } else {
      measure(model, state, b, workspace.threads, motion);
      motion.spin = now.spin;
      // The centre is another one where particles have left.
      motion.velocity = plus(now.velocity, cross(now.spin, minus(motion.centre, now.centre)));
    }
    motion.start_velocity = motion.velocity;
    motion.start_spin = motion.spin;
    motion.impulse = motion.kept_impulse = motion.kept_moment = {};
    motion.contact_work = 0;
  }
}

void set_rigid_velocities(const Model& model, Workspace& workspace, bool trial) {
  if (workspace.rigid.empty()) return;
  const std::int64_t slots = static_cast<std::int64_t>(workspace.slots.size());
#pragma omp parallel for num_threads(workspace.threads) schedule(static)
  for (std::int64_t s = 0; s < slots; ++s) {
    const Slot& slot = workspace.slots[s];
    if (slot.rigid < 0 || slot.contact < 0) continue;
    const RigidMotion& motion = workspace.rigid[slot.rigid];
    for (int n = 0; n < workspace.nodes_in_use; ++n) {
      NodeRecord& record = workspace.nodes[s * block_nodes + n];
      if (!(record.v[3] > 0)) continue;
      Vector3 x;
      for (int axis = 0; axis < 3; ++axis)
        x[axis] = model.grid.domain_min[axis] + model.grid.cell_size * (4 * slot.block[axis] + ((n >> (2 * axis)) & 3));
      const Vector3 v = motion.velocity_at(x);
      double* to = trial ? record.f : record.v;
      for (int c = 0; c < 3; ++c) to[c] = v[c];
    }
  }
}

void accelerate_rigid(const Model& model, State& state, Workspace& workspace, double dt) {
  for (RigidMotion& motion : workspace.rigid) {
    if (motion.prescribed) continue;
    const double modelled = motion.mass / motion.images;
    for (int c = 0; c < 3; ++c) {
      const double gain = motion.cut[c] ? 0 : model.numerics.gravity[c] * dt;  // across a mirror nothing can fall
      state.ledger.external_impulse[c] += modelled * gain;
      state.ledger.external_work += modelled * gain * (motion.velocity[c] + 0.5 * gain);
      motion.velocity[c] += gain;
    }
    load_rigid(model, state, motion, dt);
  }
}

void finish_rigid_step(const Model& model, State& state, Workspace& workspace, double dt) {
  workspace.rigid_speed = 0;
  for (RigidMotion& motion : workspace.rigid) {
    BodyState& body = state.bodies[motion.body];
    const Body& rules = model.bodies[motion.body];
    BodyTotals& totals = body.totals;
    totals.maximum_speed = 0;
    if (!(motion.mass > 0)) continue;
    // A guided body's momentum and energy change only where its motion is more than one constant velocity.
    const bool varies = motion.prescribed && (rules.motion.size() > 1 || dot(motion.spin, motion.spin) > 0 ||
                                              body.rigid.velocity != motion.velocity || body.rigid.spin != motion.spin);
    double energy_before = 0;
    Vector3 momentum_before{};
    if (varies) {
      energy_before = kinetic_energy(body, rules.own_inertia, workspace.threads);
      momentum_before = body_momentum(body);
    }

    // What the grid saw turns and moves the body; what it keeps of it is without `kept`.
    RigidState next = body.rigid;
    Matrix3 turn;
    if (motion.prescribed) {
      turn = rotation(times(dt, motion.spin));
      const MotionKnot end = motion_at(rules, state.time + dt);
      next.centre = plus(motion.centre, times(dt, motion.velocity));
      next.velocity = end.velocity;
      next.spin = end.angular_velocity;
    } else {
      Vector3 kept_impulse = motion.kept_impulse, kept_moment = motion.kept_moment;
      for (int axis = 0; axis < 3; ++axis)
        for (int c = 0; c < 3; ++c) {
          if (!motion.cut[axis]) continue;
          if (c == axis) kept_impulse[c] = 0;
          if (c != axis) kept_moment[c] = 0;
        }
      const Matrix3 half = rotation(times(0.5 * dt, motion.spin));
      const auto turned_spin = [&](const Matrix3& by, const Vector3& angular_momentum) {
        return product(by, product(motion.inverse_inertia, transposed_product(by, angular_momentum)));
      };
      const Vector3 angular_momentum = product(motion.inertia, motion.spin);
      turn = rotation(times(dt, turned_spin(half, angular_momentum)));
      next.centre = plus(motion.centre, times(dt, motion.velocity));
      next.velocity = minus(motion.velocity, times(motion.images / motion.mass, kept_impulse));
      next.spin = turned_spin(turn, minus(angular_momentum, times(motion.images, kept_moment)));
    }

    if (!workspace.surfaces.empty()) {
      // Orthogonal for ever: turn (3 - turn^T turn) / 2 takes the round-off out.
      const Matrix3 turned = product(turn, body.rigid.turn);
      Matrix3 excess{};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          excess[i][j] = (i == j ? 1.5 : 0) - 0.5 * dot(column(turned, i), column(turned, j));
      next.turn = product(turned, excess);
      next.shift = plus(next.centre, product(turn, minus(body.rigid.shift, motion.centre)));
    }

    // Groups of the body, by their places on the grid for the bounds.
    std::vector<std::int32_t> links;
    const bool rests = motion.prescribed && !varies && dot(motion.velocity, motion.velocity) == 0;
    for (std::size_t l = 0; l < workspace.links.size() && !rests; ++l)
      if (workspace.links[l].body == motion.body) links.push_back(static_cast<std::int32_t>(l));
    std::vector<GroupSums> sums(links.size());
    const std::int64_t count = static_cast<std::int64_t>(links.size());
#pragma omp parallel for num_threads(workspace.threads) schedule(static) if (count > 8)
    for (std::int64_t i = 0; i < count; ++i) {
      const KernelGroup group = kernel_group(model, state, workspace, workspace.links[links[i]], dt);
      for (std::int64_t p = group.begin; p < group.end; ++p) {
        double* x = &body.position[4 * p];
        double* v = &body.velocity[4 * p];
        const Vector3 r = product(turn, minus({x[0], x[1], x[2]}, motion.centre));
        const Vector3 velocity = plus(next.velocity, cross(next.spin, r));
        for (int c = 0; c < 3; ++c) {
          x[c] = next.centre[c] + r[c];
          v[c] = velocity[c];
          if (!(x[c] >= group.bound_low[c] && x[c] <= group.bound_high[c])) sums[i].outside = true;
        }
        sums[i].speed_squared = std::max(sums[i].speed_squared, dot(velocity, velocity));
      }
    }
    body.rigid = next;
    double speed_squared = 0;
    for (const GroupSums& s : sums) {
      speed_squared = std::max(speed_squared, s.speed_squared);
      body.drifted = body.drifted || s.outside;
    }
    totals.maximum_speed = std::sqrt(speed_squared);
    workspace.rigid_speed = std::max(workspace.rigid_speed, totals.maximum_speed);

    if (motion.prescribed) {
      add(state.ledger.boundary_impulse, times(-1, motion.impulse));
      state.ledger.prescribed_work -= motion.contact_work;
      if (varies) {
        add(state.ledger.boundary_impulse, minus(body_momentum(body), momentum_before));
        state.ledger.prescribed_work += kinetic_energy(body, rules.own_inertia, workspace.threads) - energy_before;
      }
    } else {
      const double modelled = motion.mass / motion.images;
      // The mirror holds a body that it cuts against what pushes across it.
      for (int axis = 0; axis < 3; ++axis)
        if (motion.cut[axis])
          state.ledger.boundary_impulse[axis] +=
              modelled * (next.velocity[axis] - motion.start_velocity[axis]) - motion.impulse[axis];
    }
  }
}

}  // namespace ogive
