// Validation of the model: every message names the field, its value and what was expected.
#include "model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "archive.hpp"
#include "contact/method.hpp"
#include "contact/normal.hpp"
#include "error.hpp"
#include "surface/meeting.hpp"
#include "surface/tessellate.hpp"

namespace ogive {
namespace {

constexpr double pi = 3.141592653589793238;

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", x);
  return buffer;
}

[[noreturn]] void refuse(const std::string& field, const std::string& expected, const std::string& got) {
  throw Error(ErrorKind::Argument, field + ": must be " + expected + ", got " + got);
}

void require(bool holds, const std::string& field, const std::string& expected, double got) {
  if (!holds) refuse(field, expected, text(got));
}

// Comparisons are written so that a value that is not a number fails them.
void require_positive(const std::string& field, double x) { require(x > 0 && std::isfinite(x), field, "> 0 and finite", x); }
void require_not_negative(const std::string& field, double x) {
  require(x >= 0 && std::isfinite(x), field, ">= 0 and finite", x);
}
void require_finite(const std::string& field, double x) { require(std::isfinite(x), field, "finite", x); }
template <class E>
void require_choice(const std::string& field, E x, int count) {
  const int i = static_cast<int>(x);
  if (i < 0 || i >= count) refuse(field, "0.." + std::to_string(count - 1), std::to_string(i));
}

void validate_space(const Space& space, const std::string& prefix) {
  require_choice(prefix + "region", space.region, 3);
  if (space.region == Region::Everywhere) return;
  for (int axis = 0; axis < 3; ++axis) {
    require_finite(prefix + "a", space.a[axis]);
    require_finite(prefix + "b", space.b[axis]);
  }
  if (space.region == Region::Box) {
    for (int axis = 0; axis < 3; ++axis)
      require(space.a[axis] <= space.b[axis], prefix + "b", "at least a = " + text(space.a[axis]), space.b[axis]);
  } else {
    require_positive(prefix + "radius", space.radius);
    require(space.b[0] != 0 || space.b[1] != 0 || space.b[2] != 0, prefix + "b", "a direction that is not zero", 0);
  }
}

}  // namespace

void Material::validate() {
  require_choice("strength", strength, 6);
  require_choice("eos", eos, 2);
  require_choice("failure", failure, 2);
  require_positive("density", density);

  const bool young = youngs_modulus != 0 || poisson_ratio != 0, bulk = bulk_modulus != 0 || shear_modulus != 0;
  if (young && bulk)
    throw Error(ErrorKind::Argument,
                "elastic constants: give youngs_modulus and poisson_ratio, or bulk_modulus and shear_modulus, not both");
  if (bulk) {
    require_positive("bulk_modulus", bulk_modulus);
    require_not_negative("shear_modulus", shear_modulus);
    K = bulk_modulus;
    G = shear_modulus;
  } else {
    require_positive("youngs_modulus", youngs_modulus);
    require(poisson_ratio > -1 && poisson_ratio < 0.5, "poisson_ratio", "between -1 and 0.5", poisson_ratio);
    K = youngs_modulus / (3 * (1 - 2 * poisson_ratio));
    G = youngs_modulus / (2 * (1 + poisson_ratio));
  }
  if (eos == EquationOfState::MieGruneisen) {
    require_positive("eos_sound_speed", eos_sound_speed);
    require_not_negative("eos_slope", eos_slope);
    require_not_negative("gruneisen", gruneisen);
    if (hyperelastic())
      throw Error(ErrorKind::Argument, "eos: a law of the deformation gradient brings its own pressure; must be linear");
  }
  if (plastic()) {
    require_positive("yield_stress", yield_stress);
    require_positive("shear_modulus", G);
    require_not_negative("hardening_modulus", hardening_modulus);
    require_positive("hardening_exponent", hardening_exponent);
    if (mixed_hardening()) {
      require(hardening_exponent == 1, "hardening_exponent", "1: this law hardens linearly", hardening_exponent);
      require(isotropic_fraction >= 0 && isotropic_fraction <= 1, "isotropic_fraction", "0..1", isotropic_fraction);
    }
  }
  if (strength == Strength::JohnsonCook) {
    require_not_negative("rate_coefficient", rate_coefficient);
    require_positive("reference_strain_rate", reference_strain_rate);
    require_not_negative("thermal_exponent", thermal_exponent);
    if (thermal()) {
      require_not_negative("room_temperature", room_temperature);
      require(melt_temperature > room_temperature && std::isfinite(melt_temperature), "melt_temperature",
              "above room_temperature", melt_temperature);
      require_positive("specific_heat", specific_heat);
      require(taylor_quinney >= 0 && taylor_quinney <= 1, "taylor_quinney", "0..1", taylor_quinney);
    }
  }
  if (failure == Failure::PlasticStrain) {
    if (!plastic() || mixed_hardening())
      throw Error(ErrorKind::Argument, "failure: by plastic strain needs a plastic strength (j2_power or johnson_cook)");
    require_positive("failure_strain", failure_strain);
  }
  require_not_negative("viscosity_linear", viscosity_linear);
  require_not_negative("viscosity_quadratic", viscosity_quadratic);
}

double Material::yield_stress_at(double plastic_strain, double temperature) const {
  const double hardening = hardening_modulus * (mixed_hardening() ? isotropic_fraction : 1);
  const double cold = yield_stress + hardening * std::pow(plastic_strain, hardening_exponent);
  if (!thermal()) return cold;
  const double t = (temperature - room_temperature) / (melt_temperature - room_temperature);
  return cold * (1 - std::pow(std::clamp(t, 0.0, 1.0), thermal_exponent));
}

namespace {

bool before(const PairRule& first, const PairRule& second) {
  return first.a != second.a ? first.a < second.a : first.b < second.b;
}

}  // namespace

const ContactRule& Model::rule_of(int a, int b) const {
  if (pairs.empty()) return contact;
  PairRule wanted;
  wanted.a = std::min(a, b);
  wanted.b = std::max(a, b);
  const auto found = std::lower_bound(pairs.begin(), pairs.end(), wanted, before);
  return found != pairs.end() && found->a == wanted.a && found->b == wanted.b ? found->rule : contact;
}

void Model::set_pair(const PairRule& pair) {
  PairRule ordered = pair;
  if (ordered.a > ordered.b) std::swap(ordered.a, ordered.b);
  const auto place = std::lower_bound(pairs.begin(), pairs.end(), ordered, before);
  if (place != pairs.end() && place->a == ordered.a && place->b == ordered.b)
    *place = ordered;
  else
    pairs.insert(place, ordered);
}

double Grid::section_share() const { return 1 / (axisymmetric() ? 2 * pi : thickness); }

void Grid::lay_in_plane() {
  if (!planar()) return;
  domain_min[2] = 0;
  domain_max[2] = cell_size;
  face[4] = face[5] = Face::Free;
  if (axisymmetric()) face[0] = Face::Symmetry;
}

void Model::validate_grid() const {
  require_positive("cell_size", grid.cell_size);
  require_choice("space", grid.space, 3);
  require_positive("thickness", grid.thickness);
  if (grid.axisymmetric())
    require(grid.domain_min[0] == 0, "domain_min[x]", "0 in an axisymmetric model, whose axis is x = 0", grid.domain_min[0]);
  const char axis_name[] = {'x', 'y', 'z'};
  for (int axis = 0; axis < 3; ++axis) {
    const std::string index = std::string("[") + axis_name[axis] + "]";
    require_finite("domain_min" + index, grid.domain_min[axis]);
    require(std::isfinite(grid.domain_max[axis]) && grid.domain_max[axis] > grid.domain_min[axis], "domain_max" + index,
            "above domain_min = " + text(grid.domain_min[axis]), grid.domain_max[axis]);
    require_choice("face " + std::string(1, axis_name[axis]) + " min", grid.face[2 * axis], 3);
    require_choice("face " + std::string(1, axis_name[axis]) + " max", grid.face[2 * axis + 1], 3);
    const double cells = (grid.domain_max[axis] - grid.domain_min[axis]) / grid.cell_size;
    require(cells <= 120000, "domain" + index, "at most 120000 cells", cells);
    if (grid.face[2 * axis + 1] != Face::Free && std::abs(cells - std::round(cells)) > 1e-6)
      throw Error(ErrorKind::Argument, "domain_max" + index + ": must lie a whole number of cells from domain_min, " +
                                           "because that face is symmetry or fixed; got " + text(cells) + " cells");
    require(grid.face[2 * axis + 1] == Face::Free || cells >= 3, "domain" + index,
            "at least 3 cells where its max face is symmetry or fixed", cells);
  }
}

// What acts out of the plane of a two-dimensional model, or across its axis.
void Model::validate_planar() const {
  if (!grid.planar()) return;
  const auto in_plane = [](const std::string& field, double out_of_plane) {
    require(out_of_plane == 0, field, "0 in a two-dimensional model", out_of_plane);
  };
  in_plane("gravity[z]", numerics.gravity[2]);
  if (grid.axisymmetric()) require(numerics.gravity[0] == 0, "gravity[x]", "0 in an axisymmetric model", numerics.gravity[0]);
  for (const Wall& wall : walls) {
    in_plane("wall normal[z]", wall.normal[2]);
    validate_planar(wall.rule, "wall detection");
  }
  validate_planar(contact, "contact detection");
  for (const PairRule& pair : pairs) validate_planar(pair.rule, "contact pair detection");
  for (const Body& body : bodies)
    for (const MotionKnot& knot : body.motion) {
      const std::string prefix = "body \"" + body.name + "\": ";
      in_plane(prefix + "motion velocity[z]", knot.velocity[2]);
      for (int axis = 0; axis < 2; ++axis)
        in_plane(prefix + "motion angular_velocity[" + "xy"[axis] + "]", knot.angular_velocity[axis]);
    }
}

void Model::validate_planar(const ContactRule& rule, const char* field) const {
  if (by_surface(rule))
    throw Error(ErrorKind::Argument,
                std::string(field) + ": must be \"gap\" or \"shared_node\" in a two-dimensional model, got \"surface\"");
}

// Total Lagrangian bodies wherever contact by surfaces meets them, and one of each pair that has no surface otherwise.
void Model::cover_solids() {
  const auto cover = [&](std::size_t b) {
    SurfaceDef& surface = bodies[b].surface;
    if (bodies[b].rigid() || !surface.given() || surface.kind == SurfaceKind::Triangles) return;
    surface = tessellate(surface, 0.5 * grid.cell_size);
  };
  for (const Wall& wall : walls)
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (by_surface(wall.rule) && bodies[b].total_lagrangian()) cover(b);
  for (std::size_t a = 0; a < bodies.size() && own_fields; ++a)
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      const ContactRule& rule = rule_of(static_cast<int>(a), static_cast<int>(b));
      if (!by_surface(rule)) continue;
      for (const std::size_t body : {a, b})
        if (bodies[body].total_lagrangian()) cover(body);
      if (surface_owner(*this, static_cast<int>(a), static_cast<int>(b)) >= 0) continue;
      const std::size_t first = rule.master == static_cast<int>(b) ? b : a;
      cover(first);
      if (!bodies[first].has_surface()) cover(first == a ? b : a);
    }
}

void Model::validate_lagrangian() const {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].total_lagrangian()) continue;
    const std::string prefix = "body \"" + bodies[b].name + "\": a total Lagrangian body needs ";
    if (grid.planar())
      throw Error(ErrorKind::Argument, prefix + "a three-dimensional model: space must be \"three_dimensional\"");
    if (numerics.shape_function == ShapeFunction::Gimp)
      throw Error(ErrorKind::Argument, prefix + "shape_function \"linear\" or \"quadratic_bspline\", got \"gimp\"");
  }
}

void Model::validate_numerics() const {
  require_choice("shape_function", numerics.shape_function, 3);
  require(numerics.time_step_factor > 0 && numerics.time_step_factor <= 1.5, "time_step_factor", "> 0 and <= 1.5",
          numerics.time_step_factor);
  require(numerics.maximum_time_step > 0, "maximum_time_step", "> 0", numerics.maximum_time_step);
  for (int axis = 0; axis < 3; ++axis) require_finite("gravity", numerics.gravity[axis]);
  require_choice("transfer", numerics.transfer, 4);
  require(numerics.xpic_order >= 1 && numerics.xpic_order <= 20, "xpic_order", "1..20", numerics.xpic_order);
  require(numerics.pic_fraction >= 0 && numerics.pic_fraction <= 1, "pic_fraction", "between 0 and 1", numerics.pic_fraction);
  require_choice("update_order", numerics.update_order, 3);
  require(numerics.energy_warning > 0, "energy_warning", "> 0", numerics.energy_warning);
  require(numerics.energy_limit > 0, "energy_limit", "> 0", numerics.energy_limit);
  require(numerics.energy_loss_limit > 0, "energy_loss_limit", "> 0", numerics.energy_loss_limit);
}

bool Space::contains(const Vector3& x) const {
  if (region == Region::Everywhere) return true;
  if (region == Region::Box) {
    for (int axis = 0; axis < 3; ++axis)
      if (x[axis] < a[axis] || x[axis] > b[axis]) return false;
    return true;
  }
  double length = 0, along = 0, squared = 0;
  for (int axis = 0; axis < 3; ++axis) length += b[axis] * b[axis];
  for (int axis = 0; axis < 3; ++axis) along += (x[axis] - a[axis]) * b[axis];
  for (int axis = 0; axis < 3; ++axis) {
    const double across = x[axis] - a[axis] - along / length * b[axis];
    squared += across * across;
  }
  return squared >= radius * radius;
}

void Model::validate_clamp(const Clamp& clamp) const {
  validate_space(clamp, "clamp ");
  require(clamp.axes >= 1 && clamp.axes <= 7, "clamp axes", "1..7", clamp.axes);
}

void Model::validate_load(const Load& load) const {
  require_choice("load kind", load.kind, 3);
  validate_space(load, "load ");
  if (load.kind == LoadKind::Velocity) require(load.axes >= 1 && load.axes <= 7, "load axes", "1..7", load.axes);
  if (load.kind == LoadKind::Traction) require_positive("load area", load.area);
}

void Model::validate_contact(const ContactRule& rule, const char* where) const {
  const std::string prefix(where);
  require_choice(prefix + "method", rule.method, contact_method_count());
  require_choice(prefix + "normal", rule.normal, normal_rule_count());
  require_choice(prefix + "detection", rule.detection, 3);
  require_not_negative(prefix + "friction", rule.friction);
  require(rule.gap_offset >= -2 && rule.gap_offset <= 2, prefix + "gap_offset", "-2..2", rule.gap_offset);
}

void Model::validate_wall(const Wall& wall) const {
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    require_finite("wall point", wall.point[axis]);
    squared += wall.normal[axis] * wall.normal[axis];
  }
  require(std::abs(squared - 1) < 1e-6, "wall normal", "a direction that is not zero", squared);
  validate_contact(wall.rule, "wall ");
}

void Model::validate_stop(const Stop& conditions) const {
  require_not_negative("settle_window", conditions.settle_window);
  if (conditions.settle_window > 0) require_positive("settle_tolerance", conditions.settle_tolerance);
  require_not_negative("exchange_window", conditions.exchange_window);
  const double tolerance = conditions.exchange_tolerance;
  require(tolerance > 0 && tolerance < 1, "exchange_tolerance", "> 0 and < 1", tolerance);
}

void Model::validate_distortion(const Body& body) const {
  require(body.distortion_limit > 1, "distortion_limit", "> 1 (infinity: none)", body.distortion_limit);
  require_choice("when_distorted", body.when_distorted, 2);
}

void Model::validate_motion(const std::vector<MotionKnot>& motion) const {
  for (std::size_t i = 0; i < motion.size(); ++i) {
    require_finite("motion time", motion[i].time);
    require(i == 0 || motion[i].time > motion[i - 1].time, "motion time",
            "above the one before it" + (i > 0 ? ", " + text(motion[i - 1].time) : ""), motion[i].time);
    for (int axis = 0; axis < 3; ++axis) {
      require_finite("motion velocity", motion[i].velocity[axis]);
      require_finite("motion angular_velocity", motion[i].angular_velocity[axis]);
    }
  }
}

void Model::complete() {
  if (bodies.empty()) throw Error(ErrorKind::Argument, "bodies: at least one is needed, got none");
  validate_grid();
  validate_numerics();
  const auto known = [&](std::int32_t body, const std::string& field, bool none_allowed) {
    if (body >= (none_allowed ? -1 : 0) && body < static_cast<std::int32_t>(bodies.size())) return;
    refuse(field, "the id of a body (0.." + std::to_string(bodies.size() - 1) + ")", std::to_string(body));
  };
  known(contact.master, "contact master", true);
  for (const PairRule& pair : pairs) {
    known(pair.a, "contact pair", false);
    known(pair.b, "contact pair", false);
    known(pair.rule.master, "contact pair master", true);
    if (pair.rule.normal == NormalRule::Master && pair.rule.master >= 0 && pair.rule.master != pair.a &&
        pair.rule.master != pair.b)
      refuse("contact pair master", "one of the pair", "body " + std::to_string(pair.rule.master));
  }
  for (const Clamp& clamp : clamps) {
    known(clamp.body, "clamp body", true);
    if (clamp.body >= 0 && bodies[clamp.body].rigid())
      refuse("clamp body", "deformable (give a rigid body a prescribed motion instead)",
             '"' + bodies[clamp.body].name + '"');
  }
  for (const Load& load : loads) {
    known(load.body, "load body", load.kind != LoadKind::Traction);
    if (load.body >= 0 && load.kind == LoadKind::Velocity && bodies[load.body].rigid())
      refuse("load body", "deformable (give a rigid body a prescribed motion instead)", '"' + bodies[load.body].name + '"');
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    int count = 0;
    for (const Load& load : loads) count += load.on_particles() && load.acts_on(static_cast<int>(b));
    require(count <= most_particle_loads, "loads of body \"" + bodies[b].name + "\" by acceleration and traction",
            "at most " + std::to_string(most_particle_loads), count);
  }
  known(stop.body, "stop body", true);
  if (numerics.drop_debris && grid.axisymmetric())
    throw Error(ErrorKind::Argument,
                "drop_debris: must be 0 in an axisymmetric model, where a ring that flies outwards is held by its hoop stress; got 1");
  validate_planar();
  validate_lagrangian();

  own_fields = contact.method != ContactMethod::SingleField && bodies.size() > 1;
  for (const PairRule& pair : pairs) own_fields = own_fields || pair.rule.method != ContactMethod::SingleField;
  bool deformable = false;
  for (const Body& body : bodies) {
    own_fields = own_fields || body.rigid() || (body.total_lagrangian() && bodies.size() > 1);
    deformable = deformable || !body.rigid();
    if (body.rigid() && body.material < 0) refuse("material", "the id of a material", "-1");
    if (body.prescribed())
      for (const MotionKnot& knot : body.motion)
        for (int axis = 0; axis < 3; ++axis) {
          if (!body.cut[axis]) continue;
          const Vector3 &v = knot.velocity, &w = knot.angular_velocity;
          if (v[axis] != 0 || w[(axis + 1) % 3] != 0 || w[(axis + 2) % 3] != 0)
            throw Error(ErrorKind::Argument, "body \"" + body.name + "\": its motion must fit the " + "xyz"[axis] +
                                                 " symmetry face that cuts it (no velocity across, rotation about its normal "
                                                 "alone)");
        }
  }
  cover_solids();
  for (std::size_t a = 0; a < bodies.size() && own_fields; ++a)
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      const ContactRule& rule = rule_of(static_cast<int>(a), static_cast<int>(b));
      if (!by_surface(rule) || (bodies[a].prescribed() && bodies[b].prescribed())) continue;
      if (surface_owner(*this, static_cast<int>(a), static_cast<int>(b)) < 0)
        throw Error(ErrorKind::Argument, "contact detection: \"surface\" needs the surface of \"" + bodies[a].name +
                                             "\" or \"" + bodies[b].name +
                                             "\": a built-in solid, or triangles (ogive_body_set_surface)");
    }
  if (!deformable && !std::isfinite(numerics.maximum_time_step))
    throw Error(ErrorKind::Argument, "maximum_time_step: must be given where every body is rigid (no wave limits the step)");
}

static void exchange_surface(Archive& a, const std::string& at, SurfaceDef& surface) {
  a.value(at + "kind", surface.kind);
  if (surface.kind == SurfaceKind::None) return;
  if (surface.kind == SurfaceKind::Triangles) {
    a.resizable(at + "vertices", surface.vertices, std::int64_t{1} << 31);
    a.resizable(at + "corners", surface.corners, std::int64_t{1} << 31);
    if (a.loading() && (surface.vertices.size() % 3 != 0 || surface.corners.size() % 3 != 0))
      throw Error(ErrorKind::Format, at + "vertices and corners: expected three numbers each");
    if (a.loading()) check_triangles(surface.vertices, surface.corners);
    return;
  }
  if (static_cast<int>(surface.kind) < 0 || surface.kind > SurfaceKind::Triangles)
    throw Error(ErrorKind::Format, at + "kind: expected -1..4, found " + std::to_string(static_cast<int>(surface.kind)));
  a.value(at + "size", surface.size);
  a.value(at + "origin", surface.origin);
  const char* const names[] = {"axis_x", "axis_y", "axis_z"};
  for (int k = 0; k < 3; ++k) a.value(at + names[k], surface.axes[k]);
}

void Model::exchange(Archive& a) {
  a.value("model/grid/cell_size", grid.cell_size);
  a.value("model/grid/domain_min", grid.domain_min);
  a.value("model/grid/domain_max", grid.domain_max);
  a.value("model/grid/face", grid.face);
  if (a.version() >= 3) {
    a.value("model/grid/space", grid.space);
    a.value("model/grid/thickness", grid.thickness);
  }
  a.value("model/numerics/shape_function", numerics.shape_function);
  a.value("model/numerics/time_step_factor", numerics.time_step_factor);
  a.value("model/numerics/maximum_time_step", numerics.maximum_time_step);
  a.value("model/numerics/gravity", numerics.gravity);
  a.value("model/numerics/transfer", numerics.transfer);
  a.value("model/numerics/pic_fraction", numerics.pic_fraction);
  a.value("model/numerics/update_order", numerics.update_order);
  if (a.version() >= 2) a.value("model/numerics/xpic_order", numerics.xpic_order);
  if (a.version() >= 3) {
    a.value("model/numerics/energy_warning", numerics.energy_warning);
    a.value("model/numerics/energy_limit", numerics.energy_limit);
  }
  if (a.version() >= 4) a.value("model/numerics/drop_debris", numerics.drop_debris);
  if (a.version() >= 4) a.value("model/numerics/skip_resting", numerics.skip_resting);
  if (a.version() >= 6) a.value("model/numerics/energy_loss_limit", numerics.energy_loss_limit);

  const auto count = [&](const char* name, auto& list, std::int32_t limit) {
    std::int32_t n = static_cast<std::int32_t>(list.size());
    a.value(name, n);
    if (a.loading()) {
      if (n < 0 || n > limit)
        throw Error(ErrorKind::Format, std::string(name) + ": expected 0.." + std::to_string(limit) + ", found " +
                                           std::to_string(n));
      list.resize(n);
    }
  };
  count("model/clamps/count", clamps, 1000000);
  const auto space = [&](const std::string& at, Space& where) {
    a.value(at + "region", where.region);
    a.value(at + "a", where.a);
    a.value(at + "b", where.b);
    a.value(at + "radius", where.radius);
  };
  for (std::size_t i = 0; i < clamps.size(); ++i) {
    const std::string at = "model/clamps/" + std::to_string(i) + "/";
    space(at, clamps[i]);
    a.value(at + "body", clamps[i].body);
    a.value(at + "axes", clamps[i].axes);
  }
  if (a.version() >= 2) {
    count("model/loads/count", loads, 1000000);
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const std::string at = "model/loads/" + std::to_string(i) + "/";
      space(at, loads[i]);
      a.value(at + "kind", loads[i].kind);
      a.value(at + "body", loads[i].body);
      a.value(at + "axes", loads[i].axes);
      a.value(at + "area", loads[i].area);
    }
  }
  count("model/materials/count", materials, 65535);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::string at = "model/materials/" + std::to_string(i) + "/";
    Material& m = materials[i];
    a.value(at + "name", m.name);
    a.value(at + "strength", m.strength);
    a.value(at + "eos", m.eos);
    a.value(at + "failure", m.failure);
    const std::pair<const char*, double*> numbers[] = {
        {"density", &m.density},
        {"youngs_modulus", &m.youngs_modulus},
        {"poisson_ratio", &m.poisson_ratio},
        {"bulk_modulus", &m.bulk_modulus},
        {"shear_modulus", &m.shear_modulus},
        {"yield_stress", &m.yield_stress},
        {"hardening_modulus", &m.hardening_modulus},
        {"hardening_exponent", &m.hardening_exponent},
        {"rate_coefficient", &m.rate_coefficient},
        {"reference_strain_rate", &m.reference_strain_rate},
        {"thermal_exponent", &m.thermal_exponent},
        {"melt_temperature", &m.melt_temperature},
        {"room_temperature", &m.room_temperature},
        {"specific_heat", &m.specific_heat},
        {"taylor_quinney", &m.taylor_quinney},
        {"eos_sound_speed", &m.eos_sound_speed},
        {"eos_slope", &m.eos_slope},
        {"gruneisen", &m.gruneisen},
        {"failure_strain", &m.failure_strain},
        {"viscosity_linear", &m.viscosity_linear},
        {"viscosity_quadratic", &m.viscosity_quadratic},
    };
    for (const auto& [name, number] : numbers) a.value(at + name, *number);
    if (a.version() >= 3) a.value(at + "isotropic_fraction", m.isotropic_fraction);
  }
  count("model/bodies/count", bodies, 65535);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string at = "model/bodies/" + std::to_string(i) + "/";
    a.value(at + "name", bodies[i].name);
    a.value(at + "material", bodies[i].material);
    if (a.version() == 1) continue;
    a.value(at + "formulation", bodies[i].formulation);
    if (a.version() >= 3) exchange_surface(a, at + "surface/", bodies[i].surface);
    if (bodies[i].total_lagrangian()) {
      // Before version 5 such bodies had no surface that contact could use, and none moved with them.
      if (a.loading() && a.version() < 5) bodies[i].surface = {};
      a.value(at + "distortion_limit", bodies[i].distortion_limit);
      a.value(at + "when_distorted", bodies[i].when_distorted);
    }
    if (!bodies[i].rigid()) continue;
    a.value(at + "cut", bodies[i].cut);
    a.value(at + "own_inertia", bodies[i].own_inertia);
    a.value(at + "reference", bodies[i].reference);
    count((at + "motion/count").c_str(), bodies[i].motion, 1000000);
    for (std::size_t k = 0; k < bodies[i].motion.size(); ++k) {
      const std::string knot = at + "motion/" + std::to_string(k) + "/";
      a.value(knot + "time", bodies[i].motion[k].time);
      a.value(knot + "velocity", bodies[i].motion[k].velocity);
      a.value(knot + "angular_velocity", bodies[i].motion[k].angular_velocity);
    }
  }
  const auto rule = [&](const std::string& at, ContactRule& r) {
    // In version 1 all pairs had the scene's method.
    if (a.version() >= 2 || &r == &contact)
      a.value(at + "method", r.method);
    else
      r.method = contact.method;
    a.value(at + "normal", r.normal);
    a.value(at + "master", r.master);
    a.value(at + "friction", r.friction);
    a.value(at + "detection", r.detection);
    a.value(at + "gap_offset", r.gap_offset);
  };
  rule("model/contact/", contact);
  count("model/contact/pairs/count", pairs, 1000000);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string at = "model/contact/pairs/" + std::to_string(i) + "/";
    a.value(at + "a", pairs[i].a);
    a.value(at + "b", pairs[i].b);
    rule(at, pairs[i].rule);
  }
  if (a.version() == 1) {
    for (PairRule& pair : pairs)
      if (pair.a > pair.b) std::swap(pair.a, pair.b);
    std::sort(pairs.begin(), pairs.end(), before);
  } else {
    count("model/walls/count", walls, 1000000);
  }
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const std::string at = "model/walls/" + std::to_string(i) + "/";
    a.value(at + "point", walls[i].point);
    a.value(at + "normal", walls[i].normal);
    rule(at + "rule/", walls[i].rule);
  }
  a.value("model/stop/body", stop.body);
  a.value("model/stop/settle_window", stop.settle_window);
  a.value("model/stop/settle_tolerance", stop.settle_tolerance);
  a.value("model/stop/when_stopped", stop.when_stopped);
  a.value("model/stop/when_out", stop.when_out);
  if (a.version() >= 4) {
    a.value("model/stop/exchange_window", stop.exchange_window);
    a.value("model/stop/exchange_tolerance", stop.exchange_tolerance);
  }

  if (a.loading()) {
    for (const Body& body : bodies) {
      if (body.material < 0 || body.material >= static_cast<std::int32_t>(materials.size()))
        throw Error(ErrorKind::Format, "model/bodies: material " + std::to_string(body.material) + " is unknown");
      require_choice("formulation", body.formulation, 4);
      for (int axis = 0; axis < 3; ++axis)
        if (body.cut[axis] != 0 && body.cut[axis] != 1)
          throw Error(ErrorKind::Format, "model/bodies: cut must be 0 or 1, found " + std::to_string(body.cut[axis]));
      if (body.total_lagrangian()) validate_distortion(body);
      validate_motion(body.motion);
      if (body.prescribed() && body.motion.empty())
        throw Error(ErrorKind::Format, "model/bodies: a prescribed motion is missing");
    }
    for (const Wall& wall : walls) validate_wall(wall);
    if (!std::is_sorted(pairs.begin(), pairs.end(), before))
      throw Error(ErrorKind::Format, "model/contact/pairs: must be in order");
    for (Material& m : materials) m.validate();
    for (const Clamp& clamp : clamps) validate_clamp(clamp);
    for (const Load& load : loads) validate_load(load);
    validate_contact(contact, "contact ");
    for (const PairRule& pair : pairs) validate_contact(pair.rule, "contact pair ");
    validate_stop(stop);
    const Grid as_saved = grid;
    grid.lay_in_plane();
    if (grid != as_saved) throw Error(ErrorKind::Format, "model/grid: a two-dimensional model must lie in its plane");
    complete();
  }
}

}  // namespace ogive
