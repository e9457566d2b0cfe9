// The plan of a run in words.
#include "plan.hpp"

#include <cstdarg>
#include <cstdio>

#include "time_step.hpp"

namespace ogive {
namespace {

void line(std::string& text, const char* format, ...) __attribute__((format(printf, 2, 3)));
void line(std::string& text, const char* format, ...) {
  char buffer[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  text += buffer;
  text += '\n';
}

void describe_body(std::string& text, const Model& model, const State& state, int b) {
  const Material& m = model.material_of(b);
  static const char* const strengths[] = {"linear elastic", "compressible neo-Hookean", "von Mises with A + B eps^n",
                                          "Johnson-Cook"};
  double mass = 0;
  const BodyState& body = state.bodies[b];
  for (std::int64_t p = 0; p < body.padded; ++p) mass += body.position[4 * p + 3];
  line(text, "body \"%s\": %lld particles, mass %.6g, material \"%s\": %s, %s pressure", model.bodies[b].name.c_str(),
       static_cast<long long>(body.particles), mass, m.name.c_str(), strengths[static_cast<int>(m.strength)],
       m.eos == EquationOfState::MieGruneisen ? "Mie-Grueneisen" : "linear");
  std::string omitted;
  const auto omit = [&](const char* what) {
    if (!omitted.empty()) omitted += ", ";
    omitted += what;
  };
  if (!m.plastic()) omit("plastic strain (the material does not yield)");
  if (m.plastic() && !m.thermal()) omit("temperature (no thermal softening is given)");
  if (m.plastic() && !m.rate_dependent()) omit("strain rate (its coefficient is 0)");
  if (m.plastic() && m.failure == Failure::None) omit("failure (none is given)");
  if (!m.hyperelastic()) omit("deformation gradient (no law needs it)");
  if (!m.viscous()) omit("bulk viscosity (coefficients are 0)");
  line(text, "  left out: %s", omitted.empty() ? "nothing" : omitted.c_str());
}

}  // namespace

std::string describe_plan(const Model& model, const State& state, const Workspace& workspace) {
  std::string text;
  static const char* const faces[] = {"free", "symmetry", "fixed"};
  static const char* const methods[] = {"single field (standard MPM)", "Huang first method", "Huang second method"};
  line(text, "grid: cells of %.6g, %s shape functions, %zu blocks of 64 nodes where material is",
       model.grid.cell_size,
       model.numerics.shape_function == ShapeFunction::Linear ? "trilinear" : "quadratic B-spline",
       workspace.slots.size());
  static const char* const transfers[] = {"FLIP", "FLIP with affine velocity", "APIC"};
  const Numerics& numerics = model.numerics;
  std::string blend;
  if (numerics.transfer != Transfer::Apic && numerics.pic_fraction > 0)
    blend = " with " + std::to_string(100 * numerics.pic_fraction) + " % of the grid's velocity a step";
  line(text, "velocity transfer: %s%s; stress %s", transfers[static_cast<int>(numerics.transfer)], blend.c_str(),
       numerics.update_order == UpdateOrder::StressFirst ? "first (USF)" : "last (MUSL)");
  line(text, "faces: x %s..%s, y %s..%s, z %s..%s", faces[static_cast<int>(model.grid.face[0])],
       faces[static_cast<int>(model.grid.face[1])], faces[static_cast<int>(model.grid.face[2])],
       faces[static_cast<int>(model.grid.face[3])], faces[static_cast<int>(model.grid.face[4])],
       faces[static_cast<int>(model.grid.face[5])]);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) describe_body(text, model, state, b);
  if (model.bodies.size() == 1) {
    line(text, "contact: left out, there is one body");
  } else {
    const bool second_fields = model.contact_method != ContactMethod::SingleField;
    line(text, "contact: %s%s", methods[static_cast<int>(model.contact_method)],
         second_fields ? "; velocity fields of their own only in blocks that several bodies reach" : "");
    if (second_fields) {
      bool friction = model.contact.friction > 0;
      for (const PairRule& pair : model.pairs) friction = friction || pair.rule.friction > 0;
      line(text, "  %zu such blocks now; detection by %s; friction %s", workspace.mixed.size(),
           model.contact.detection == Detection::Gap ? "shared node and closed gap" : "shared node",
           friction ? "Coulomb" : "left out (coefficients are 0)");
    }
  }
  const Vector3& g = model.numerics.gravity;
  line(text, "gravity: %s", g[0] == 0 && g[1] == 0 && g[2] == 0 ? "left out (it is 0)" : "on all bodies");
  line(text, "time step: %.6g at first (factor %.3g)", state.stable_time_step, model.numerics.time_step_factor);
  if (numerics.affine() && numerics.time_step_factor > lone_affine_particle_limit)
    line(text, "  caution: with affine velocities a lone particle is stable for factors below %.2f (no shear stiffness) to 0.73",
         lone_affine_particle_limit);
  const std::int64_t bytes = state.memory_bytes() + workspace.memory_bytes();
  line(text, "memory: %.1f MB, %.0f bytes a particle with the grid", 1e-6 * static_cast<double>(bytes),
       static_cast<double>(bytes) / static_cast<double>(state.particle_count() > 0 ? state.particle_count() : 1));
  line(text, "kernels: %s, %d thread%s", workspace.kernels->name, workspace.threads, workspace.threads == 1 ? "" : "s");
  return text;
}

}  // namespace ogive
