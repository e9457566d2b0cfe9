// The plan of a run. Order: cells first, because particles shrink with them; then bodies of revolution; then mirror planes.
#include "plan.hpp"

#include <ogive.h>

#include <algorithm>
#include <cmath>

#include "failure.hpp"
#include "mirror.hpp"
#include "resolution.hpp"
#include "revolution.hpp"
#include "text.hpp"

namespace driver {
namespace {

class Planner {
 public:
  Planner(Document document, std::filesystem::path file) : document_(std::move(document)), file_(std::move(file)) { read(); }

  PlannedScene plan() {
    measures_ = smallest_measures(scene_);
    choose_cells();
    choose_dimensions();
    decide("domain", true, "as the scene has it", "there are nodes only where material is: empty space costs neither time nor memory", "");
    choose_symmetry();
    built_ = build_world(scene_);
    say_formulations();
    say_coarse();
    return {std::move(scene_), std::move(built_), std::move(decisions_)};
  }

 private:
  void read() { scene_ = read_scene(document_, file_); }

  void apply(const std::vector<Setting>& settings, const std::string& origin) {
    for (const Setting& setting : settings) document_.set(setting.first, setting.second, origin);
  }

  void decide(const std::string& subject, bool taken, const std::string& decision, const std::string& reason,
              const std::string& overrule) {
    decisions_.push_back({subject, decision, reason, overrule, taken});
  }

  // ------------------------------------------------------------------------------------------------------------ cells

  /// The parameter that a value is, "" if it is not just one.
  std::string parameter_in(const toml::node* node) const {
    const auto* text = node ? node->as_string() : nullptr;
    return text && scene_.parameters.count(text->get()) ? text->get() : "";
  }

  void choose_cells() {
    if (!scene_.accuracy) {
      const Thinnest thinnest = thinnest_body(scene_, measures_);
      if (!std::isfinite(thinnest.measure)) return;
      const double cells = thinnest.measure / scene_.grid.cell_size;
      decide("cells", true, "the scene's, " + brief(scene_.grid.cell_size) + ' ' + scene_.units.length,
             brief(cells) + " across \"" + thinnest.body + "\" (" + brief(thinnest.measure) + ' ' + scene_.units.length +
                 "): with as many, the error of discretisation was " + error_in_words(cells) + " in the studies",
             "accuracy = \"3%\" or another");
      return;
    }
    const double error = *scene_.accuracy;
    const auto cells = cells_for(error);
    if (!cells) {
      throw Failure(kExitInput, scene_.place("accuracy") + ": no study reached an error of " + brief(100 * error) +
                                    " %; expected at least " + brief(100 * smallest_error()) +
                                    " %, or a cell size of your own and no accuracy");
    }
    const Thinnest thinnest = thinnest_body(scene_, measures_);
    const double before = scene_.grid.cell_size, cell = thinnest.measure / *cells;
    const std::string origin = "plan (accuracy = " + brief(100 * error) + " %)";
    // Where the size of cells is a parameter, what else hangs on it follows.
    const std::string parameter = parameter_in(document_.root()["grid"]["cell_size"].node());
    apply({{parameter.empty() ? "grid.cell_size" : "parameters." + parameter, shortest(cell)}}, origin);
    const Scene old = scene_;
    read();
    for (size_t i = 0; i < scene_.bodies.size(); ++i) refine_particles(old, i, cell / before, origin);
    read();
    decide("accuracy", true,
           "cells of " + brief(cell) + ' ' + scene_.units.length + " (the scene's: " + brief(before) + "), particles in proportion",
           brief(*cells) + " cells across \"" + thinnest.body + "\" (" + brief(thinnest.measure) + ' ' + scene_.units.length +
               "): with as many, the error of discretisation was at most " + brief(100 * error) +
               " % in the studies (docs/accuracy.md)",
           "leave accuracy out and give grid.cell_size");
    choose_time_step(error, *cells, origin);
  }

  void choose_time_step(double error, double cells, const std::string& origin) {
    const TimeStepChoice choice = time_step_for(error, cells);
    const auto given = scene_.numerics.time_step_factor;
    if (given && *given <= choice.factor) {
      decide("time step", true, "the scene's factor " + brief(*given),
             "the studies found " + brief(choice.factor) + " to be small enough (docs/accuracy.md); a smaller one stays",
             "numerics.time_step_factor");
      return;
    }
    apply({{"numerics.time_step_factor", shortest(choice.factor)}}, origin);
    read();
    decide("time step", true, "factor " + brief(choice.factor) + (given ? " (the scene's: " + brief(*given) + ')' : ""),
           "the largest that is sure to be stable (docs/stability.md) and changed no result by more than " + brief(100 * error) +
               " %, by " + brief(100 * choice.change) + " % at most, in the studies (docs/accuracy.md)",
           "leave accuracy out, or a smaller numerics.time_step_factor");
  }

  static std::string error_in_words(double cells) {
    const auto error = error_with(cells);
    return error ? "at most " + brief(100 * *error) + " %" : "not looked at, they are so few";
  }

  void refine_particles(const Scene& old, size_t index, double factor, const std::string& origin) {
    const auto spacing_of = [](const BodyScene& body) -> const Vector3* {
      if (const auto* mesh = std::get_if<MeshShape>(&body.shape)) return &mesh->spacing;
      if (const auto* solid = std::get_if<SolidShape>(&body.shape)) return &solid->spacing;
      return nullptr;
    };
    const BodyScene& body = scene_.bodies[index];
    const Vector3* const before = spacing_of(old.bodies[index]);
    if (!before) {
      throw Failure(kExitInput, scene_.place("bodies." + body.name + ".particles") +
                                    ": particles of a file cannot be made finer for accuracy; give grid.cell_size instead");
    }
    if (*spacing_of(body) != *before) return;  // it hangs on the cells already
    Vector3 wanted = *before;
    for (double& value : wanted) value *= factor;
    const std::string path = "bodies." + body.name + ".spacing";
    const std::string parameter = parameter_in(document_.root()["bodies"][body.name]["spacing"].node());
    if (!parameter.empty())
      apply({{"parameters." + parameter, shortest(wanted[0])}}, origin);
    else
      apply({{path, list_text(wanted)}}, origin);
    read();
    // A list of parameters, or one that others hang on as well.
    const Vector3 got = *spacing_of(scene_.bodies[index]);
    for (size_t c = 0; c < 3; ++c)
      if (std::abs(got[c] - wanted[c]) > 1e-9 * wanted[c]) {
        apply({{path, list_text(wanted)}}, origin);
        read();
        return;
      }
  }

  // ------------------------------------------------------------------------------------------------------- dimensions

  void choose_dimensions() {
    if (scene_.symmetry == SymmetryScene::none) return;
    if (scene_.grid.space != OGIVE_SPACE_THREE_DIMENSIONAL) {
      decide("dimensions", true, "two", "the scene says grid.space = " +
             std::string(scene_.grid.space == OGIVE_SPACE_AXISYMMETRIC ? "\"axisymmetric\"" : "\"plane_strain\""), "another grid.space");
      if (scene_.symmetry == SymmetryScene::axisymmetric && scene_.grid.space != OGIVE_SPACE_AXISYMMETRIC)
        throw Failure(kExitInput, scene_.place("symmetry") + ": \"axisymmetric\" needs a scene in three dimensions");
      return;
    }
    const Revolution revolution = find_revolution(scene_);
    const bool wanted = scene_.symmetry == SymmetryScene::axisymmetric;
    if (revolution.axis < 0) {
      if (wanted) {
        throw Failure(kExitInput, scene_.place("symmetry") +
                                      ": must be \"auto\" or \"none\" for this scene, which is not one of revolution (" +
                                      revolution.reason + "), got \"axisymmetric\"");
      }
      decide("dimensions", true, "three", "not of revolution: " + revolution.reason, "");
      return;
    }
    const std::string caution = "; what breaks into sectors, as a rim that tears, it cannot show";
    if (!wanted) {
      decide("dimensions", false, "an axisymmetric model would do", revolution.reason + caution, "symmetry = \"axisymmetric\"");
      return;
    }
    apply(revolution.settings, "plan (symmetry = \"axisymmetric\")");
    read();
    decide("dimensions", true, std::string("axisymmetric: x is the distance from the axis, y the ") + "xyz"[revolution.axis] + " of the scene",
           revolution.reason + caution, "symmetry = \"auto\" or \"none\"");
  }

  // --------------------------------------------------------------------------------------------------------- symmetry

  void choose_symmetry() {
    if (scene_.symmetry == SymmetryScene::none) {
      decide("symmetry", true, "not looked for", "the scene says symmetry = \"none\"", "symmetry = \"auto\"");
      return;
    }
    std::vector<Setting> settings;
    for (const MirrorPlane& plane : mirror_planes(scene_, scene_.symmetry != SymmetryScene::offered)) {
      const std::string axis(1, "xyz"[plane.axis]);
      const std::string name = axis + " = " + brief(plane.at);
      const std::string subject = "symmetry in " + axis;
      if (plane.already) {
        decide(subject, true, "as the scene has it", plane.reason, "");
      } else if (!plane.found) {
        decide(subject, true, "whole", plane.reason, "");
      } else if (scene_.symmetry == SymmetryScene::offered) {
        decide(subject, false, "the half beyond " + name + " would do", plane.reason, "symmetry = \"auto\"");
      } else {
        take_half(plane, settings);
        decide(subject, true, "the half beyond " + name, plane.reason + off_the_nodes(plane),
               scene_.symmetry == SymmetryScene::axisymmetric
                   ? "symmetry = \"none\" and the scene written with grid.space = \"axisymmetric\""
                   : "symmetry = \"none\"");
      }
    }
    apply(settings, "plan (symmetry = \"auto\")");
    if (!settings.empty()) read();
  }

  void take_half(const MirrorPlane& plane, std::vector<Setting>& settings) const {
    const auto axis = static_cast<size_t>(plane.axis);
    const GridScene& grid = scene_.grid;
    // The side that reaches farther, so that nothing leaves the domain that would have stayed.
    const double far = std::max(grid.upper[axis], 2 * plane.at - grid.lower[axis]);
    settings.push_back({"grid.lower." + std::to_string(axis), shortest(plane.at)});
    settings.push_back({"grid.upper." + std::to_string(axis), shortest(far)});
    settings.push_back({std::string("grid.faces.") + "xyz"[axis] + "_min", "symmetry"});
  }

  /// In the whole model the plane may have lain between nodes.
  std::string off_the_nodes(const MirrorPlane& plane) const {
    const double cells = (plane.at - scene_.grid.lower[static_cast<size_t>(plane.axis)]) / scene_.grid.cell_size;
    const double off = std::abs(cells - std::round(cells));
    return off < 1e-6 ? "" : "; nodes lie on the plane now, in the whole model they lay " + brief(off) + " of a cell off it";
  }

  // ----------------------------------------------------------------------------------------------------- formulations

  struct Elastic {
    double youngs_modulus, poisson_ratio, impedance;
  };

  static Elastic elastic_of(const MaterialScene& m) {
    double K, G, E, nu;
    if (m.youngs_modulus) {
      E = *m.youngs_modulus, nu = *m.poisson_ratio;
      K = E / (3 * (1 - 2 * nu)), G = E / (2 * (1 + nu));
    } else {
      K = *m.bulk_modulus, G = *m.shear_modulus;
      E = 9 * K * G / (3 * K + G), nu = (3 * K - 2 * G) / (2 * (3 * K + G));
    }
    return {E, nu, std::sqrt(m.density * (K + 4.0 / 3.0 * G))};
  }

  const MaterialScene& material_of(const BodyScene& body) const {
    return *std::find_if(scene_.materials.begin(), scene_.materials.end(),
                         [&](const MaterialScene& material) { return material.name == body.material; });
  }

  static double approach_speed(const BodyScene& a, const BodyScene& b) {
    const auto velocities = [](const BodyScene& body) {
      std::vector<Vector3> all{body.velocity};
      for (const MotionScene& knot : body.motion) all.push_back(knot.velocity);
      return all;
    };
    double speed = 0;
    for (const Vector3& v : velocities(a))
      for (const Vector3& w : velocities(b)) speed = std::max(speed, std::hypot(v[0] - w[0], v[1] - w[1], v[2] - w[2]));
    return speed;
  }

  /// Pressure on a body while this material, if it yields, gives way: inertia and the resistance to a cavity that opens
  /// in an elastic-plastic solid, 2/3 Y (1 + ln E / (3 (1 - nu) Y)) (Hill 1950; Forrestal, Luk 1988).
  static double lasting_pressure(const MaterialScene& other, double first, double speed) {
    if (!other.yield_stress) return first;
    const Elastic elastic = elastic_of(other);
    const double Y = *other.yield_stress;
    const double resistance = 2.0 / 3.0 * Y * (1 + std::log(std::max(1.0, elastic.youngs_modulus / (3 * (1 - elastic.poisson_ratio) * Y))));
    return std::min(first, 0.5 * other.density * speed * speed + resistance);
  }

  void say_formulations() {
    for (const BodyScene& body : scene_.bodies) {
      if (body.formulation && *body.formulation != OGIVE_FORMULATION_DEFORMABLE) continue;
      const MaterialScene& material = material_of(body);
      const Elastic own = elastic_of(material);
      double first = 0, lasting = 0;
      bool gives_way = true;  // every body that it meets
      for (const BodyScene& other : scene_.bodies) {
        const double speed = &other == &body ? 0 : approach_speed(body, other);
        if (speed == 0) continue;
        const MaterialScene& met = material_of(other);
        const bool rigid = other.formulation == OGIVE_FORMULATION_RIGID_FREE || other.formulation == OGIVE_FORMULATION_RIGID_PRESCRIBED;
        const Elastic elastic = elastic_of(met);
        // What acts on the body is limited by how the softer of the two gives way.
        const double shock = rigid ? own.impedance * speed : own.impedance * elastic.impedance / (own.impedance + elastic.impedance) * speed;
        double pressure = lasting_pressure(material, shock, speed);
        if (!rigid) pressure = std::min(pressure, lasting_pressure(met, shock, speed));
        first = std::max(first, shock);
        lasting = std::max(lasting, pressure);
        gives_way = gives_way && !rigid && ((met.yield_stress && shock > *met.yield_stress) || 10 * elastic.youngs_modulus < own.youngs_modulus);
      }
      for (const WallScene& wall : scene_.walls) {
        const double speed = std::abs(body.velocity[0] * wall.normal[0] + body.velocity[1] * wall.normal[1] + body.velocity[2] * wall.normal[2]) /
                             std::hypot(wall.normal[0], wall.normal[1], wall.normal[2]);
        if (speed == 0) continue;
        first = std::max(first, own.impedance * speed);
        lasting = std::max(lasting, lasting_pressure(material, own.impedance * speed, speed));
        gives_way = false;
      }
      if (first == 0) continue;  // nothing meets it as far as can be seen from the start
      say_formulation(body, material, own, first, lasting, gives_way);
    }
  }

  void say_formulation(const BodyScene& body, const MaterialScene& material, const Elastic& own, double first, double lasting,
                       bool gives_way) {
    const std::string stress = ' ' + scene_.units.stress();
    const double elastic_limit = material.yield_stress ? *material.yield_stress * (1 - own.poisson_ratio) / (1 - 2 * own.poisson_ratio) : 0;
    const bool yields = material.yield_stress && (first > elastic_limit || lasting > *material.yield_stress);
    const double strain = lasting / own.youngs_modulus;
    const std::string expected = "expected " + brief(lasting) + stress + " (first shock " + brief(first) + stress + "), " +
                                 (material.yield_stress ? "its yield stress is " + brief(*material.yield_stress) + stress : "it does not yield") +
                                 ", Young's modulus " + brief(own.youngs_modulus) + stress + ": strains about " + brief(100 * strain) + " %";
    const std::string subject = "body \"" + body.name + '"', key = "bodies." + body.name + ".formulation = ";
    if (material.yield_stress && !yields)
      decide(subject, false, "an elastic law would do", expected, "give material \"" + material.name + "\" an elastic law");
    if (!yields && strain < kRigidStrain && gives_way) {
      decide(subject, false, "it may be rigid, where its own vibration is not asked for", expected, key + "\"rigid\"");
      return;
    }
    const bool possible = scene_.grid.space == OGIVE_SPACE_THREE_DIMENSIONAL && scene_.numerics.shape_function != OGIVE_SHAPE_GIMP &&
                          !material.failure_strain;
    if (possible && !yields && strain < kModerateStrain)
      decide(subject, false, "it may be total Lagrangian, which knows no noise and no numerical fracture", expected,
             key + "\"total_lagrangian\"");
    else
      decide(subject, true, "deformable, updated Lagrangian",
             yields ? "it yields: " + expected : possible ? "it deforms much: " + expected : expected, "");
  }

  // ----------------------------------------------------------------------------------------- particles far from the impact

  /// Distance of a place from the line of a coarse body.
  static double distance(const double* place, const CoarseScene& coarse) {
    double length_squared = 0, part = 0, squared = 0;
    for (size_t c = 0; c < 3; ++c) {
      length_squared += (coarse.to[c] - coarse.from[c]) * (coarse.to[c] - coarse.from[c]);
      part += (place[c] - coarse.from[c]) * (coarse.to[c] - coarse.from[c]);
    }
    part = length_squared > 0 ? std::clamp(part / length_squared, 0.0, 1.0) : 0.0;
    for (size_t c = 0; c < 3; ++c) {
      const double off = place[c] - coarse.from[c] - part * (coarse.to[c] - coarse.from[c]);
      squared += off * off;
    }
    return std::sqrt(squared);
  }

  /// A body at rest that another one flies into: who flies, and how fast.
  const BodyScene* striker_of(const BodyScene& target) const {
    const BodyScene* striker = nullptr;
    double fastest = 0;
    for (const BodyScene& other : scene_.bodies) {
      const double speed = std::hypot(other.velocity[0], other.velocity[1], other.velocity[2]);
      if (&other != &target && other.motion.empty() && speed > fastest) striker = &other, fastest = speed;
    }
    return striker;
  }

  void say_coarse() {
    for (size_t b = 0; b < scene_.bodies.size(); ++b) {
      const BodyScene& target = scene_.bodies[b];
      const std::string subject = "particles of \"" + target.name + '"', key = "bodies." + target.name + ".coarse";
      if (target.coarse) {
        decide(subject, true, "one a cell farther than " + brief(target.coarse->beyond) + ' ' + scene_.units.length + " from the line given",
               "the scene says so", "leave " + key + " out");
        continue;
      }
      const bool deformable = target.formulation.value_or(OGIVE_FORMULATION_DEFORMABLE) == OGIVE_FORMULATION_DEFORMABLE;
      const BodyScene* const striker = striker_of(target);
      if (!deformable || !striker || target.velocity != Vector3{} || target.angular_velocity != Vector3{}) continue;
      const auto striker_index = static_cast<int32_t>(striker - scene_.bodies.data());
      const double calibre = measures_[static_cast<size_t>(striker_index)];
      if (!std::isfinite(calibre)) continue;
      const CoarseScene coarse = far_from_path(*striker, striker_index, static_cast<int32_t>(b), kCalibres * calibre);
      const int64_t count = body_result_of(built_.world.get(), static_cast<int32_t>(b)).particles;
      std::vector<double> positions(static_cast<size_t>(3 * count));
      require_ok(ogive_field_get(built_.world.get(), ogive_body_id{static_cast<int32_t>(b)}, "position", positions.data(), 3 * count),
                 built_.world.get());
      int64_t far = 0;
      for (size_t i = 0; i < positions.size(); i += 3) far += distance(&positions[i], coarse) > coarse.beyond;
      if (far < count / 4) continue;
      decide(subject, false, grouped(far) + " of " + grouped(count) + " lie where one a cell would do",
             "they are more than " + brief(kCalibres) + " calibres (" + brief(coarse.beyond) + ' ' + scene_.units.length + ") from the path of \"" +
                 striker->name + "\": as far off, results changed by less than 0.1 % (docs/performance.md); not where that body shall tear or be "
                 "hit by debris",
             key + " = { beyond = " + shortest(coarse.beyond) + ", from = " + list_text(coarse.from) + ", to = " + list_text(coarse.to) + " }");
    }
  }

  /// From the striker on along its flight, until it is beyond the target. In a half or quarter model its centre is that of the half:
  /// the path is laid onto the mirror.
  CoarseScene far_from_path(const BodyScene& striker, int32_t striker_index, int32_t target_index, double beyond) const {
    const ogive_body_result from = body_result_of(built_.world.get(), striker_index), to = body_result_of(built_.world.get(), target_index);
    CoarseScene coarse{beyond, {}, {}};
    const double speed = std::hypot(striker.velocity[0], striker.velocity[1], striker.velocity[2]);
    double reach = 0;
    for (size_t c = 0; c < 3; ++c) {
      coarse.from[c] = from.centre[c];
      if (scene_.grid.faces[2 * c] == OGIVE_FACE_SYMMETRY || (c == 0 && scene_.grid.space == OGIVE_SPACE_AXISYMMETRIC)) {
        if (std::abs(striker.velocity[c]) < 1e-12 * speed) coarse.from[c] = scene_.grid.lower[c];
      }
      reach = std::max(reach, std::max(std::abs(to.upper[c] - from.centre[c]), std::abs(to.lower[c] - from.centre[c])));
    }
    for (size_t c = 0; c < 3; ++c) {
      const double end = coarse.from[c] + 2 * reach * striker.velocity[c] / speed;
      // Round numbers, for the eye.
      coarse.to[c] = std::round(100 * end) / 100;
      coarse.from[c] = std::round(100 * coarse.from[c]) / 100;
    }
    coarse.beyond = std::round(100 * beyond) / 100;
    return coarse;
  }

  static constexpr double kCalibres = 2;
  static constexpr double kRigidStrain = 0.01, kModerateStrain = 0.5;

  Document document_;
  std::filesystem::path file_;
  Scene scene_;
  std::vector<double> measures_;  // of the bodies, as the scene gives them
  BuiltWorld built_;
  std::vector<Decision> decisions_;
};

}  // namespace

PlannedScene plan_scene(Document document, const std::filesystem::path& file) {
  return Planner(std::move(document), file).plan();
}

std::string text_of(const std::vector<Decision>& decisions) {
  std::string text;
  for (const Decision& decision : decisions) {
    text += decision.subject + ": " + decision.decision + (decision.taken ? "" : " (not taken)") + "\n  because " + decision.reason + '\n';
    if (!decision.overrule.empty()) text += std::string("  ") + (decision.taken ? "overrule" : "take it") + " by " + decision.overrule + '\n';
  }
  return text;
}

}  // namespace driver
