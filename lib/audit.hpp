// The ledger: mass, momentum and energy of particles now, together with the running sums of the state.
#pragma once

#include "model.hpp"
#include "state.hpp"

namespace ogive {

// Sums over a body's particles, always in the same order.
struct BodyAudit {
  double mass = 0, kinetic = 0, internal = 0;
  Vector3 momentum{}, first_moment{};
  Vector3 angular_momentum{};  // about the origin, with that of affine velocities and of rigid particles themselves
  Vector3 lower{}, upper{};
  double maximum_plastic_strain = 0, maximum_temperature = 0;
};
BodyAudit audit_body(const Model& model, const State& state, int body, int threads = 1);

// Kinetic energy of a particle's affine velocity field, m h^2/8 |C|^2.
double affine_energy(const BodyState& body, std::int64_t particle, double cell_size);

// What the ledger's own terms are in the sum of the energy.
double booked_energy(const Ledger& ledger);

// kinetic + internal + failure loss + energy that left or was dropped + friction heat + transfer dissipation - external work
// - work of prescribed motion, of all bodies.
double total_energy(const Model& model, const State& state, int threads = 1);

// Momentum of the centre of mass alone, for the stop condition.
Vector3 body_momentum(const BodyState& body);

// What was dissipated so far, in all bodies and between them: plastic, viscous and failure, friction, transfer and contact.
double dissipated_energy(const State& state);

// Angular momentum of a particle about the origin, with that of its affine velocity field.
Vector3 particle_angular_momentum(const BodyState& body, std::int64_t particle, double cell_size);

// Takes what removed particles of a body had out of the memory of the stop conditions: their departure is no exchange.
void forget_departed(State& state, int body, double kinetic, double internal);

// Renews the memory of the stop conditions and sets state.stop.reason.
void check_stop(const Model& model, State& state);

}  // namespace ogive
