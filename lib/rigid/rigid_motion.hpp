// The motion of one rigid body during a step.
#pragma once

#include <array>
#include <cstdint>

#include "vector3.hpp"

namespace ogive {

using Matrix3 = std::array<Vector3, 3>;  // rows

struct RigidMotion {
  std::int32_t body = -1;
  bool prescribed = false;
  std::array<std::int32_t, 3> cut{};  // symmetry faces through it, by axis
  int images = 1;                     // 2^cuts: the body is so many times what is modelled
  double mass = 0;                    // of the whole body
  Vector3 centre{};                   // of mass of the whole body; prescribed: the reference point
  Matrix3 inertia{}, inverse_inertia{};  // of the whole body about its centre
  double largest_inverse_inertia = 0;    // a bound of its eigenvalues
  Vector3 velocity{}, spin{};         // of the centre, now in the step
  Vector3 start_velocity{}, start_spin{};  // at its beginning
  Vector3 impulse{};                  // from contact in this step, on what is modelled
  Vector3 kept_impulse{}, kept_moment{};   // part that only the grid sees; see ContactMethodDef::start_reaches_particles
  double contact_work = 0;            // of contact at the body's velocity; prescribed bodies

  Vector3 velocity_at(const Vector3& x) const {
    const Vector3 r = {x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]};
    return {velocity[0] + spin[1] * r[2] - spin[2] * r[1], velocity[1] + spin[2] * r[0] - spin[0] * r[2],
            velocity[2] + spin[0] * r[1] - spin[1] * r[0]};
  }
};

}  // namespace ogive
