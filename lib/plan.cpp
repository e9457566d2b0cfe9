// The plan of a run in words.
#include "plan.hpp"

#include <cstdarg>
#include <cstdio>

#include "contact/method.hpp"
#include "contact/normal.hpp"
#include "debris.hpp"
#include "resting.hpp"
#include "surface/meeting.hpp"
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
  const Body& rules = model.bodies[b];
  static const char* const strengths[] = {"linear elastic", "compressible neo-Hookean", "von Mises with A + B eps^n",
                                          "Johnson-Cook", "von Mises with mixed hardening in Green-Lagrange strain",
                                          "von Mises with mixed hardening, multiplicative"};
  double mass = 0;
  const BodyState& body = state.bodies[b];
  for (std::int64_t p = 0; p < body.padded; ++p) mass += body.position[4 * p + 3];
  if (rules.rigid()) {
    line(text, "body \"%s\": %lld particles, mass %.6g, rigid: %s", rules.name.c_str(),
         static_cast<long long>(body.particles), mass,
         !rules.prescribed() ? "moves freely, inertia from its particles"
                             : rules.motion.size() > 1 ? "moves as a table in time says" : "moves with constant velocity");
    const int cuts = rules.cut[0] + rules.cut[1] + rules.cut[2];
    if (cuts > 0) line(text, "  cut by %d symmetry face%s: moves as the whole body does", cuts, cuts > 1 ? "s" : "");
    line(text, "  left out: strain and stress (it is rigid), its nodes where no other body is near");
    return;
  }
  line(text, "body \"%s\": %lld particles, mass %.6g, material \"%s\": %s, %s pressure", model.bodies[b].name.c_str(),
       static_cast<long long>(body.particles), mass, m.name.c_str(), strengths[static_cast<int>(m.strength)],
       m.eos == EquationOfState::MieGruneisen ? "Mie-Grueneisen" : "linear");
  if (body.lagrangian) {
    line(text, "  total Lagrangian: %zu nodes of its own, central differences; critical time step that of %.3g cells",
         body.reference.node_position.size() / 4, body.reference.critical_length / model.grid.cell_size);
    line(text, "  distorted beyond |F| |F^-1| / 3 = %.3g it %s", rules.distortion_limit,
         rules.when_distorted == WhenDistorted::Stop ? "ends the run" : "goes on updated Lagrangian");
    if (body.reference.critical_length < 0.5 * model.grid.cell_size)
      line(text, "  caution: particles of \"%s\" lie so near to planes of nodes that its time step is short; shift or refine its "
                 "particles, or use B-splines", rules.name.c_str());
  }
  std::string omitted;
  const auto omit = [&](const char* what) {
    if (!omitted.empty()) omitted += ", ";
    omitted += what;
  };
  if (!m.plastic()) omit("plastic strain (the material does not yield)");
  if (m.plastic() && !m.thermal()) omit("temperature (no thermal softening is given)");
  if (m.plastic() && !m.rate_dependent()) omit("strain rate (its coefficient is 0)");
  if (m.plastic() && m.failure == Failure::None) omit("failure (none is given)");
  if (!m.hyperelastic() && !body.lagrangian) omit("deformation gradient (no law needs it)");
  if (body.lagrangian) omit("binning and the common grid where no other body is near");
  if (!m.viscous()) omit("bulk viscosity (coefficients are 0)");
  line(text, "  left out: %s", omitted.empty() ? "nothing" : omitted.c_str());
}

void describe_rule(std::string& text, const ContactRule& rule, const std::string& what, bool wall) {
  const ContactMethodDef& method = contact_method(rule.method);
  std::string details;
  if (method.needs_normal) {
    const bool surface = rule.detection == Detection::Surface;
    if (!wall) details += std::string("; normals: ") + (surface ? "of the true surface" : normal_rule(rule.normal).name);
    details += surface                                  ? "; where what is felt reaches the surface"
               : rule.detection == Detection::Gap ? "; where the gap is closed"
                                                        : "; at shared nodes";
    char offset[48];
    std::snprintf(offset, sizeof offset, " (offset %.3g cells)", rule.gap_offset);
    if (rule.detection == Detection::Gap) details += offset;
  }
  if (method.has_friction && rule.friction > 0) {
    char friction[48];
    std::snprintf(friction, sizeof friction, "; friction %.3g", rule.friction);
    details += friction;
  }
  if (method.has_friction && rule.friction == 0) details += "; friction left out (coefficient 0)";
  line(text, "%s: %s, %s%s", what.c_str(), method.name, method.summary, details.c_str());
  if (by_surface(rule) && method.at_end == method.at_start)
    line(text, "  caution: this method holds bodies that part, which adds energy where contact is by the surface");
  if (!method.has_friction && rule.friction > 0)
    line(text, "  caution: this method has no friction; the coefficient %.3g is not used", rule.friction);
}

void describe_contact(std::string& text, const Model& model, const Workspace& workspace) {
  if (model.bodies.size() == 1) {
    line(text, "contact: left out between bodies, there is one");
  } else {
    describe_rule(text, model.contact, "contact", false);
    for (const PairRule& pair : model.pairs)
      describe_rule(text, pair.rule,
                    "  of \"" + model.bodies[pair.a].name + "\" and \"" + model.bodies[pair.b].name + '"', false);
    if (!model.own_fields) line(text, "  one velocity field for all bodies");
  }
  for (std::size_t w = 0; w < model.walls.size(); ++w)
    describe_rule(text, model.walls[w].rule, "wall " + std::to_string(w), true);
  if (workspace.contact_needs.any)
    line(text, "  velocity fields of their own only in blocks that several bodies reach or a wall is near: %zu now",
         workspace.mixed.size());
}

// Groups to which nothing has happened yet.
void describe_resting(std::string& text, const Model& model, const State& state, const Workspace& workspace) {
  const char* const why_not = why_nothing_rests(model, workspace);
  if (why_not || !model.numerics.skip_resting) {
    line(text, "particles at rest: computed as all others (%s)", why_not ? why_not : "skip_resting is off");
    return;
  }
  std::int64_t resting = 0;
  for (const BodyState& body : state.bodies)
    for (const Group& group : body.groups) resting += group.resting ? group.count : 0;
  const int rings = rings_around_motion(model.numerics);
  line(text,
       "particles at rest: left out of a step, which changes no bit of the results, where %d ring%s of blocks lie%s between them and "
       "what moves; at rest now: %lld of %lld",
       rings, rings == 1 ? "" : "s", rings == 1 ? "s" : "", static_cast<long long>(resting),
       static_cast<long long>(state.particle_count()));
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (!model.bodies[b].rigid() && !state.bodies[b].lagrangian && !workspace.resting.laws[b].keeps)
      line(text, "  not of \"%s\": its law does not keep the state of rest to the bit", model.bodies[b].name.c_str());
}

}  // namespace

std::string describe_plan(const Model& model, const State& state, const Workspace& workspace) {
  std::string text;
  static const char* const faces[] = {"free", "symmetry", "fixed"};
  static const char* const shapes[] = {"trilinear", "quadratic B-spline", "GIMP"};
  line(text, "grid: cells of %.6g, %s shape functions, %zu blocks of %d nodes where material is",
       model.grid.cell_size,
       shapes[static_cast<int>(model.numerics.shape_function)],
       workspace.slots.size(), workspace.nodes_in_use);
  if (model.grid.axisymmetric())
    line(text, "two dimensions: axisymmetric about y, without twist; x is the radius, masses are those of whole rings");
  else if (model.grid.planar())
    line(text, "two dimensions: plane strain, masses are those of a thickness of %.6g", model.grid.thickness);
  static const char* const transfers[] = {"FLIP", "FLIP with affine velocity", "APIC", "XPIC"};
  static const char* const orders[] = {"first (USF)", "last (MUSL)", "last, from the velocities as they are (USL)"};
  const Numerics& numerics = model.numerics;
  std::string blend;
  if (numerics.transfer == Transfer::Xpic)
    blend = " of order " + std::to_string(numerics.xpic_order) +
            (numerics.xpic_order == 1 ? " (PIC)" : ", " + std::to_string(numerics.xpic_order - 1) + " more passes a step");
  else if (numerics.transfer != Transfer::Apic && numerics.pic_fraction > 0)
    blend = " with " + std::to_string(100 * numerics.pic_fraction) + " % of the grid's velocity a step";
  line(text, "velocity transfer: %s%s; stress %s", transfers[static_cast<int>(numerics.transfer)], blend.c_str(),
       orders[static_cast<int>(numerics.update_order)]);
  line(text, "faces: x %s..%s, y %s..%s, z %s..%s", faces[static_cast<int>(model.grid.face[0])],
       faces[static_cast<int>(model.grid.face[1])], faces[static_cast<int>(model.grid.face[2])],
       faces[static_cast<int>(model.grid.face[3])], faces[static_cast<int>(model.grid.face[4])],
       faces[static_cast<int>(model.grid.face[5])]);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) describe_body(text, model, state, b);
  describe_contact(text, model, workspace);
  const Vector3& g = model.numerics.gravity;
  line(text, "gravity: %s", g[0] == 0 && g[1] == 0 && g[2] == 0 ? "left out (it is 0)" : "on all bodies");
  describe_resting(text, model, state, workspace);
  line(text, "time step: %.6g at first (factor %.3g)", state.stable_time_step, model.numerics.time_step_factor);
  if (numerics.affine() && numerics.time_step_factor > lone_affine_particle_limit)
    line(text, "  caution: with affine velocities a lone particle is stable for factors below %.2f (no shear stiffness) to 0.73",
         lone_affine_particle_limit);
  if (model.stop.exchange_window > 0)
    line(text, "stop: when no energy has changed by more than %.3g %% of the initial total for %.6g, once some has",
         100 * model.stop.exchange_tolerance, model.stop.exchange_window);
  if (numerics.drop_debris)
    line(text, "debris: parts of at most %.3g %% of their body that can meet nothing any more are dropped, looked for every %d steps",
         100 * debris_share, static_cast<int>(debris_steps));
  if (numerics.drop_debris && numerics.gravity != Vector3{})
    line(text, "  caution: gravity acts, which brings all debris back; none is dropped");
  const std::int64_t bytes = state.memory_bytes() + workspace.memory_bytes();
  line(text, "memory: %.1f MB, %.0f bytes a particle with the grid", 1e-6 * static_cast<double>(bytes),
       static_cast<double>(bytes) / static_cast<double>(state.particle_count() > 0 ? state.particle_count() : 1));
  line(text, "kernels: %s, %d thread%s", workspace.kernels->name, workspace.threads, workspace.threads == 1 ? "" : "s");
  return text;
}

}  // namespace ogive
