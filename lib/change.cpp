// See change.hpp.
#include "change.hpp"

#include <algorithm>
#include <cmath>

#include "error.hpp"

namespace ogive {
namespace {

bool same_yielding(const Material& a, const Material& b) {
  return a.yield_stress == b.yield_stress && a.hardening_modulus == b.hardening_modulus &&
         a.hardening_exponent == b.hardening_exponent && a.isotropic_fraction == b.isotropic_fraction &&
         a.thermal_exponent == b.thermal_exponent && a.melt_temperature == b.melt_temperature && a.room_temperature == b.room_temperature;
}

[[noreturn]] void refuse(const std::string& field, const std::string& why) {
  throw Error(ErrorKind::Argument, field + ": cannot be changed in a run, because " + why);
}

void require_same(const std::string& prefix, const char* field, double before, double after, const char* why) {
  if (before != after)
    refuse(prefix + field, std::string(why) + "; it must stay " + std::to_string(before) + ", got " + std::to_string(after));
}

void check_material(const Material& before, const Material& after) {
  const std::string prefix = "material \"" + before.name + "\": ";
  if (before.strength != after.strength || before.failure != after.failure || before.thermal() != after.thermal())
    refuse(prefix + "strength, failure or thermal softening", "the particles keep what the old law needs, not the new one");
  require_same(prefix, "density", before.density, after.density, "the particles have their mass from it");
  const char* elastic = "the stress and energy of the particles belong to it";
  require_same(prefix, "bulk modulus", before.K, after.K, elastic);
  require_same(prefix, "shear modulus", before.G, after.G, elastic);
  if (before.eos != after.eos) refuse(prefix + "eos", elastic);
  if (before.eos == EquationOfState::MieGruneisen) {
    require_same(prefix, "eos_sound_speed", before.eos_sound_speed, after.eos_sound_speed, elastic);
    require_same(prefix, "eos_slope", before.eos_slope, after.eos_slope, elastic);
    require_same(prefix, "gruneisen", before.gruneisen, after.gruneisen, elastic);
  }
}

void check_failure(const Body& rules, const Material& before, const Material& after, const BodyState& body) {
  if (before.failure == Failure::None || rules.rigid()) return;
  for (const Group& group : body.groups)
    for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
      const double strain = body.plastic_strain[p];
      if ((strain >= before.failure_strain) != (strain >= after.failure_strain))
        refuse("material \"" + before.name + "\": failure_strain",
               "particle " + std::to_string(body.number[p]) + " of body \"" + rules.name + "\", of plastic strain " +
                   std::to_string(strain) + ", would " + (strain >= after.failure_strain ? "fail" : "be whole again") +
                   " without a step");
    }
}

}  // namespace

void require_consistent_change(const Model& before, const Model& after, const State& state) {
  if (before.numerics.affine() != after.numerics.affine())
    refuse("transfer", "particles carry affine velocities with the one and not with the other");
  if (before.numerics.update_order != after.numerics.update_order)
    refuse("update_order", "stress and places of the particles belong to other moments");
  for (std::size_t m = 0; m < before.materials.size(); ++m) check_material(before.materials[m], after.materials[m]);
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const Material &old = before.material_of(static_cast<int>(b)), &next = after.material_of(static_cast<int>(b));
    if (!before.bodies[b].rigid() && !before.numerics.stress_first() && old.viscous() != next.viscous())
      refuse("material \"" + old.name + "\": viscosity", "particles keep its pressure where the stress comes last");
    const Body& body = after.bodies[b];
    if (!body.rigid() && body.has_surface() && state.bodies[b].surface_vertices.size() != body.surface.vertices.size())
      refuse("contact detection", "the surface of body \"" + body.name + "\" moves with it from the start, and has not");
    check_failure(before.bodies[b], old, next, state.bodies[b]);
  }
}

void adapt_state(const Model& before, const Model& after, State& state) {
  if (before.stop != after.stop) state.stop = {};  // its memory is of another condition
  double slower = 1;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    BodyState& body = state.bodies[b];
    const Material &old = before.material_of(static_cast<int>(b)), &material = after.material_of(static_cast<int>(b));
    slower = std::max(slower, 1 + 2 * (material.viscosity_linear - old.viscosity_linear));
    if (same_yielding(old, material)) continue;  // what is kept was rounded otherwise in its last bit
    for (std::size_t p = 0; p < body.yield_stress.size(); ++p)
      body.yield_stress[p] = material.yield_stress_at(body.plastic_strain[p], material.thermal() ? body.temperature[p] : 0);
  }
  // What the old step was bounded by is not known: the new one may be longer only by as much as the factor grew, and not
  // where the maximum bounded it.
  double factor = after.numerics.time_step_factor / before.numerics.time_step_factor;
  if (state.stable_time_step >= before.numerics.maximum_time_step) factor = std::min(factor, 1.0);
  state.stable_time_step =
      std::min(after.numerics.maximum_time_step, state.stable_time_step * factor / slower);
}

}  // namespace ogive
