// A scene as plain values, read from TOML and checked key by key.
#include "scene.hpp"

#include <ogive.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "expression.hpp"
#include "failure.hpp"
#include "section.hpp"
#include "text.hpp"

namespace driver {
namespace {

using Names = std::vector<std::string>;

Names operator+(Names first, const Names& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

template <typename Element>
Names names_of(const std::vector<Element>& elements) {
  Names names;
  for (const Element& element : elements) names.push_back(element.name);
  return names;
}

void require_known_name(const Section& section, const std::string& key, const std::string& kind, const std::string& got,
                        const Names& known) {
  if (std::find(known.begin(), known.end(), got) == known.end()) section.refuse_name(key, kind, got, known);
}

/// Names of bodies and materials are keys of files that the run writes, so they stay plain.
void require_plain_name(const Section& section, const std::string& name) {
  const bool plain =
      !name.empty() && name.size() <= 63 &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
  if (!plain) section.refuse(name, "must be a name of 1 to 63 letters, digits, _ or -");
}

/// [parameters] may use each other in any order; they are worked out once those that they use are known.
Expressions read_parameters(const Document& document, const Section& root) {
  Expressions expressions;
  const Expressions none;
  if (!root.has("parameters")) return expressions;
  const Section names = root.table("parameters", std::nullopt);
  Names waiting = names.keys_in_file_order();
  const Names all = waiting;
  const toml::table& table = *document.root().get("parameters")->as_table();
  while (!waiting.empty()) {
    Names still_waiting;
    for (const std::string& name : waiting) {
      bool ready = true;
      if (const auto* text = table.get(name)->as_string()) {
        for (const std::string& used : Expressions::names_used(text->get())) {
          const bool is_parameter = std::find(all.begin(), all.end(), used) != all.end();
          ready = ready && (!is_parameter || expressions.parameters().count(used));
        }
      }
      if (!ready) {
        still_waiting.push_back(name);
        continue;
      }
      const Section parameters(document, expressions, table, "parameters", std::nullopt);
      const std::string problem = expressions.define(name, parameters.number(name, kAnyNumber));
      if (!problem.empty()) names.refuse(name, problem);
    }
    if (still_waiting.size() == waiting.size()) {
      names.refuse(waiting.front(), "needs itself: the parameters " + joined(waiting) + " go round in a circle");
    }
    waiting = std::move(still_waiting);
  }
  return expressions;
}

std::string read_unit(const Section& units, const std::string& key, const Names& known) {
  const std::string name = units.text(key);
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    units.refuse(key, "must be one of " + joined(known) + ", got \"" + name + '"' + suggestion(name, known));
  }
  return name;
}

Units read_units(const Section& root) {
  const Section units = root.table("units", Names{"length", "time", "mass"});
  return {read_unit(units, "length", length_unit_names()), read_unit(units, "time", time_unit_names()),
          read_unit(units, "mass", mass_unit_names())};
}

SymmetryScene read_symmetry(const Section& root) {
  const auto choice = root.optional_choice("symmetry", {{"none", static_cast<int32_t>(SymmetryScene::none)},
                                                        {"offer", static_cast<int32_t>(SymmetryScene::offered)},
                                                        {"auto", static_cast<int32_t>(SymmetryScene::automatic)},
                                                        {"axisymmetric", static_cast<int32_t>(SymmetryScene::axisymmetric)}});
  return choice ? static_cast<SymmetryScene>(*choice) : SymmetryScene::offered;
}

/// "3%", or a number: 0.03.
std::optional<double> read_accuracy(const Section& root) {
  if (!root.has("accuracy")) return std::nullopt;
  const std::string expected = "must be a part of the result > 0 and < 1, as \"3%\" or 0.03, got ";
  std::string text = root.scalar("accuracy");
  const bool percent = !text.empty() && text.back() == '%';
  if (percent) text.pop_back();
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size()) root.refuse("accuracy", expected + '"' + root.scalar("accuracy") + '"');
  if (percent) value /= 100;
  if (!(value > 0 && value < 1)) root.refuse("accuracy", expected + root.scalar("accuracy"));
  return value;
}

GridScene read_grid(const Section& root) {
  const Section section = root.table("grid", Names{"cell_size", "lower", "upper", "faces", "space", "thickness"});
  GridScene grid;
  grid.space = section
                   .optional_choice("space", {{"three_dimensional", OGIVE_SPACE_THREE_DIMENSIONAL},
                                              {"plane_strain", OGIVE_SPACE_PLANE_STRAIN},
                                              {"axisymmetric", OGIVE_SPACE_AXISYMMETRIC}})
                   .value_or(OGIVE_SPACE_THREE_DIMENSIONAL);
  grid.thickness = section.optional_number("thickness", kPositive);
  if (grid.thickness && grid.space != OGIVE_SPACE_PLANE_STRAIN) {
    section.refuse("thickness", "needs space = \"plane_strain\"");
  }
  grid.cell_size = section.number("cell_size", kPositive);
  grid.lower = section.vector("lower");
  grid.upper = section.vector("upper");
  const size_t axes = grid.space == OGIVE_SPACE_THREE_DIMENSIONAL ? 3 : 2;
  for (size_t axis = 0; axis < axes; ++axis) {
    if (grid.upper[axis] > grid.lower[axis]) continue;
    section.refuse(child_path("upper", axis), "must be > grid." + child_path("lower", axis) + " (" +
                                                  shortest(grid.lower[axis]) + "), got " + shortest(grid.upper[axis]));
  }
  grid.faces.fill(OGIVE_FACE_FREE);
  const Names keys = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  if (const auto faces = section.optional_table("faces", keys)) {
    for (size_t face = 0; face < keys.size(); ++face) {
      const Choices choices = {
          {"free", OGIVE_FACE_FREE}, {"symmetry", OGIVE_FACE_SYMMETRY}, {"fixed", OGIVE_FACE_FIXED}};
      grid.faces[face] = faces->optional_choice(keys[face], choices).value_or(OGIVE_FACE_FREE);
    }
  }
  return grid;
}

NumericsScene read_numerics(const Section& root) {
  NumericsScene numerics;
  const auto section = root.optional_table(
      "numerics", Names{"shape_function", "time_step_factor", "maximum_time_step", "threads", "gravity", "transfer",
                        "update_order", "pic_fraction", "xpic_order", "energy_warning", "energy_limit",
                        "energy_loss_limit", "drop_debris", "skip_resting"});
  if (!section) return numerics;
  numerics.shape_function = section->optional_choice(
      "shape_function", {{"linear", OGIVE_SHAPE_LINEAR},
                         {"quadratic_bspline", OGIVE_SHAPE_QUADRATIC_BSPLINE},
                         {"gimp", OGIVE_SHAPE_GIMP}});
  const Range factor = {[](double value) { return value > 0 && value <= 1.5; }, "> 0 and <= 1.5"};
  numerics.time_step_factor = section->optional_number("time_step_factor", factor);
  numerics.maximum_time_step = section->optional_number("maximum_time_step", kPositive);
  numerics.energy_warning = section->optional_number("energy_warning", kPositive);
  numerics.energy_limit = section->optional_number("energy_limit", kPositive);
  numerics.energy_loss_limit = section->optional_number("energy_loss_limit", kPositive);
  numerics.drop_debris = section->optional_flag("drop_debris");
  numerics.skip_resting = section->optional_flag("skip_resting");
  if (const auto threads = section->optional_integer("threads", 0, 1024)) {
    numerics.threads = static_cast<int32_t>(*threads);
  }
  numerics.gravity = section->optional_vector("gravity").value_or(Vector3{});
  numerics.transfer = section->optional_choice("transfer", {{"flip", OGIVE_TRANSFER_FLIP},
                                                            {"affine_flip", OGIVE_TRANSFER_AFFINE_FLIP},
                                                            {"apic", OGIVE_TRANSFER_APIC},
                                                            {"xpic", OGIVE_TRANSFER_XPIC}});
  numerics.update_order =
      section->optional_choice("update_order", {{"stress_first", OGIVE_UPDATE_STRESS_FIRST},
                                                {"stress_last", OGIVE_UPDATE_STRESS_LAST},
                                                {"stress_last_as_is", OGIVE_UPDATE_STRESS_LAST_AS_IS}});
  if (const auto order = section->optional_integer("xpic_order", 1, 20)) {
    if (numerics.transfer != OGIVE_TRANSFER_XPIC) section->refuse("xpic_order", "needs transfer = \"xpic\"");
    numerics.xpic_order = static_cast<int32_t>(*order);
  }
  const Range part = {[](double value) { return value >= 0 && value <= 1; }, "between 0 and 1"};
  numerics.pic_fraction = section->optional_number("pic_fraction", part);
  return numerics;
}

const Names kContactRuleKeys = {"method", "normal", "master", "friction", "detection", "gap_offset"};

/// The engine's own list: its values are their places in it.
Choices named(int32_t count, const char* (*name)(int32_t)) {
  Choices choices;
  for (int32_t i = 0; i < count; ++i) choices.emplace_back(name(i), i);
  return choices;
}

/// What walls have as well as pairs.
void read_contact_law(const Section& section, ContactScene& rule) {
  const auto method =
      section.optional_choice("method", named(ogive_contact_method_count(), ogive_contact_method_name));
  const auto detection = section.optional_choice(
      "detection", {{"shared_node", OGIVE_DETECTION_SHARED_NODE},
                    {"gap", OGIVE_DETECTION_GAP},
                    {"surface", OGIVE_DETECTION_SURFACE}});
  const Range offset = {[](double value) { return value >= -2 && value <= 2; }, "between -2 and 2 (cells)"};
  const auto friction = section.optional_number("friction", kNotNegative);
  const auto gap_offset = section.optional_number("gap_offset", offset);
  if (method) rule.method = method;
  if (detection) rule.detection = detection;
  if (friction) rule.friction = friction;
  if (gap_offset) rule.gap_offset = gap_offset;
}

void read_contact_rule(const Section& section, const Names& bodies, ContactScene& rule) {
  read_contact_law(section, rule);
  const auto normal =
      section.optional_choice("normal", named(ogive_contact_normal_count(), ogive_contact_normal_name));
  const auto master = section.optional_text("master");
  if (master) require_known_name(section, "master", "body", *master, bodies);
  if (normal) rule.normal = normal;
  if (master) rule.master = master;
}

void read_contact(const Section& root, const Names& bodies, Scene& scene) {
  const auto section = root.optional_table("contact", kContactRuleKeys + Names{"pairs"});
  if (!section) return;
  read_contact_rule(*section, bodies, scene.contact);
  for (const Section& pair_section : section->tables("pairs", Names{"bodies"} + kContactRuleKeys)) {
    ContactPairScene pair;
    const Names pair_bodies = pair_section.texts("bodies", 2);
    for (size_t i = 0; i < 2; ++i) {
      require_known_name(pair_section, child_path("bodies", i), "body", pair_bodies[i], bodies);
      pair.bodies[i] = pair_bodies[i];
    }
    if (pair_bodies[0] == pair_bodies[1]) {
      pair_section.refuse("bodies", "must be two different bodies, got \"" + pair_bodies[0] + "\" twice");
    }
    pair.rule = scene.contact;
    // A master named for the whole scene may not be of this pair.
    if (pair.rule.master && *pair.rule.master != pair_bodies[0] && *pair.rule.master != pair_bodies[1]) {
      pair.rule.master.reset();
    }
    read_contact_rule(pair_section, pair_bodies, pair.rule);
    scene.contact_pairs.push_back(pair);
  }
}

void read_walls(const Section& root, Scene& scene) {
  for (const Section& section :
       root.tables("walls", Names{"point", "normal", "method", "friction", "detection", "gap_offset"})) {
    WallScene wall;
    wall.point = section.vector("point");
    section.vector("normal");  // needed
    wall.normal = *section.optional_direction("normal");
    wall.rule = scene.contact;
    // Bodies that share one velocity field slide on a wall all the same, unless the wall itself asks for more.
    if (wall.rule.method == OGIVE_CONTACT_SINGLE_FIELD) wall.rule.method.reset();
    read_contact_law(section, wall.rule);
    scene.walls.push_back(wall);
  }
}

const Names kElasticKeys = {"youngs_modulus", "poisson_ratio", "bulk_modulus", "shear_modulus"};
const Names kHardeningKeys = {"A", "B", "n"};
const Names kRateAndHeatKeys = {
    "C", "reference_strain_rate", "m", "melt_temperature", "room_temperature", "specific_heat", "taylor_quinney"};

void read_elastic_constants(const Section& law, MaterialScene& material) {
  const bool by_young = law.has("youngs_modulus") || law.has("poisson_ratio");
  const bool by_bulk = law.has("bulk_modulus") || law.has("shear_modulus");
  if (by_young == by_bulk) {
    law.refuse(std::string("needs either youngs_modulus and poisson_ratio, or bulk_modulus and shear_modulus; got ") +
               (by_young ? "some of both" : "neither"));
  }
  if (by_young) {
    material.youngs_modulus = law.number("youngs_modulus", kPositive);
    material.poisson_ratio = law.number("poisson_ratio", kPoissonRatio);
  } else {
    material.bulk_modulus = law.number("bulk_modulus", kPositive);
    material.shear_modulus = law.number("shear_modulus", kNotNegative);
  }
}

void read_hardening(const Section& law, MaterialScene& material) {
  material.yield_stress = law.number("A", kPositive);
  material.hardening_modulus = law.optional_number("B", kNotNegative);
  material.hardening_exponent = law.optional_number("n", kPositive);
}

void read_rate_and_heat(const Section& law, MaterialScene& material) {
  material.rate_coefficient = law.optional_number("C", kNotNegative);
  material.reference_strain_rate = law.optional_number("reference_strain_rate", kPositive);
  if (material.rate_coefficient.value_or(0) > 0 && !material.reference_strain_rate) {
    law.refuse("reference_strain_rate", "missing; expected a number > 0, in the scene's units of time, where C > 0");
  }
  material.thermal_exponent = law.optional_number("m", kNotNegative);
  material.room_temperature = law.optional_number("room_temperature", kNotNegative);
  const double room = material.room_temperature.value_or(293.0);
  const Range above_room = {[=](double value) { return value > room; }, "> room_temperature (" + shortest(room) + ")"};
  material.melt_temperature = law.optional_number("melt_temperature", above_room);
  material.specific_heat = law.optional_number("specific_heat", kPositive);
  material.taylor_quinney = law.optional_number("taylor_quinney", kZeroToOne);
  if (material.thermal_exponent.value_or(0) > 0) {
    if (!material.melt_temperature)
      law.refuse("melt_temperature", "missing; expected a number > room_temperature where m > 0");
    if (!material.specific_heat) law.refuse("specific_heat", "missing; expected a number > 0 where m > 0");
  }
}

MaterialScene read_material(const Section& materials, const std::string& name) {
  const Names strengths = {"elastic", "neo_hookean", "j2_power", "johnson_cook", "j2_mixed", "j2_multiplicative"};
  const Section section =
      materials.table(name, Names{"density"} + strengths + Names{"mie_gruneisen", "failure", "viscosity"});
  MaterialScene material;
  material.name = name;
  material.density = section.number("density", kPositive);

  Names given;
  for (const std::string& strength : strengths) {
    if (section.has(strength)) given.push_back(strength);
  }
  if (given.size() != 1) {
    section.refuse("needs exactly one of the tables " + joined(strengths) + ", got " +
                   (given.empty() ? "none" : joined(given)));
  }
  if (section.has("elastic") || section.has("neo_hookean")) {
    material.strength = section.has("elastic") ? OGIVE_STRENGTH_ELASTIC : OGIVE_STRENGTH_NEO_HOOKEAN;
    read_elastic_constants(section.table(given[0], kElasticKeys), material);
  } else if (section.has("j2_mixed") || section.has("j2_multiplicative")) {
    material.strength = section.has("j2_mixed") ? OGIVE_STRENGTH_J2_MIXED : OGIVE_STRENGTH_J2_MULTIPLICATIVE;
    const Section law = section.table(given[0], kElasticKeys + Names{"yield_stress", "H", "c"});
    read_elastic_constants(law, material);
    material.yield_stress = law.number("yield_stress", kPositive);
    material.hardening_modulus = law.optional_number("H", kNotNegative);
    material.isotropic_fraction = law.optional_number("c", kZeroToOne);
  } else {
    const bool johnson_cook = section.has("johnson_cook");
    material.strength = johnson_cook ? OGIVE_STRENGTH_JOHNSON_COOK : OGIVE_STRENGTH_J2_POWER;
    const Section law =
        section.table(given[0], kElasticKeys + kHardeningKeys + (johnson_cook ? kRateAndHeatKeys : Names{}));
    read_elastic_constants(law, material);
    read_hardening(law, material);
    if (johnson_cook) read_rate_and_heat(law, material);
  }

  if (const auto eos = section.optional_table("mie_gruneisen", Names{"c0", "s", "gamma0"})) {
    if (section.has("neo_hookean") || section.has("j2_mixed") || section.has("j2_multiplicative")) {
      section.refuse("mie_gruneisen", "cannot be with " + given[0] + ", which brings its own pressure");
    }
    material.equation_of_state = OGIVE_EOS_MIE_GRUNEISEN;
    material.eos_sound_speed = eos->number("c0", kPositive);
    material.eos_slope = eos->number("s", kNotNegative);
    material.gruneisen = eos->number("gamma0", kNotNegative);
  }
  if (const auto failure = section.optional_table("failure", Names{"plastic_strain"})) {
    if (!section.has("j2_power") && !section.has("johnson_cook")) {
      section.refuse("failure", "needs a law with plastic strain (j2_power, johnson_cook), got " + given[0]);
    }
    material.failure_strain = failure->number("plastic_strain", kPositive);
  }
  if (const auto viscosity = section.optional_table("viscosity", Names{"linear", "quadratic"})) {
    material.viscosity_linear = viscosity->optional_number("linear", kNotNegative);
    material.viscosity_quadratic = viscosity->optional_number("quadratic", kNotNegative);
  }
  return material;
}

std::vector<MaterialScene> read_materials(const Section& root) {
  std::vector<MaterialScene> materials;
  const Section section = root.table("materials", std::nullopt);
  for (const std::string& name : section.keys_in_file_order()) {
    require_plain_name(section, name);
    materials.push_back(read_material(section, name));
  }
  if (materials.empty()) section.refuse("must hold at least one material, [materials.<name>], got none");
  return materials;
}

/// Files are named relative to the scene's own.
std::filesystem::path beside_scene(const std::filesystem::path& scene_file, const std::string& name) {
  return scene_file.parent_path() / name;
}

SolidShape read_solid(const Section& body, const std::string& kind) {
  SolidShape shape;
  shape.kind = kind;
  const Names placement = {"centre", "axis", "reference"};
  if (kind == "box") {
    const Section solid = body.table(kind, Names{"size"} + placement);
    shape.solid = OGIVE_SOLID_BOX;
    shape.size = solid.vector("size");
    for (size_t axis = 0; axis < 3; ++axis) {
      if (!(shape.size[axis] > 0)) {
        solid.refuse(child_path("size", axis), "must be > 0, got " + shortest(shape.size[axis]));
      }
    }
  } else if (kind == "cylinder") {
    const Section solid = body.table(kind, Names{"radius", "length", "inner_radius"} + placement);
    shape.solid = OGIVE_SOLID_CYLINDER;
    const double radius = solid.number("radius", kPositive);
    const Range within = {[=](double value) { return value >= 0 && value < radius; },
                          ">= 0 and < radius (" + shortest(radius) + ")"};
    shape.size = {radius, solid.number("length", kPositive), solid.optional_number("inner_radius", within).value_or(0)};
    shape.lattice =
        body.optional_choice("lattice", {{"cartesian", OGIVE_LATTICE_CARTESIAN}, {"polar", OGIVE_LATTICE_POLAR}})
            .value_or(OGIVE_LATTICE_CARTESIAN);
  } else if (kind == "sphere") {
    const Section solid = body.table(kind, Names{"radius"} + placement);
    shape.solid = OGIVE_SOLID_SPHERE;
    shape.size = {solid.number("radius", kPositive), 0, 0};
  } else {
    const Section solid = body.table(kind, Names{"radius", "length", "caliber_radius_head"} + placement);
    shape.solid = OGIVE_SOLID_OGIVE_ROD;
    const Range head = {[](double value) { return value >= 0.5; }, ">= 0.5"};
    shape.size = {solid.number("radius", kPositive), solid.number("length", kPositive),
                  solid.number("caliber_radius_head", head)};
  }
  const Section solid = body.table(kind, std::nullopt);
  shape.centre = solid.optional_vector("centre").value_or(Vector3{});
  shape.axis = solid.optional_direction("axis").value_or(Vector3{0, 0, 1});
  shape.reference = solid.optional_vector("reference").value_or(Vector3{});
  shape.spacing = body.number_or_vector("spacing", kPositive);
  return shape;
}

MeshShape read_mesh(const Section& body, const std::filesystem::path& scene_file) {
  MeshShape shape;
  shape.file = beside_scene(scene_file, body.text("mesh"));
  shape.spacing = body.number_or_vector("spacing", kPositive);
  shape.axis = body.optional_direction("axis").value_or(shape.axis);
  shape.reference = body.optional_vector("reference").value_or(shape.reference);
  shape.position = body.optional_vector("position").value_or(shape.position);
  shape.scale = body.optional_number("scale", kPositive).value_or(shape.scale);
  shape.lattice_axis = body.optional_direction("lattice_axis").value_or(shape.lattice_axis);
  shape.lattice_reference = body.optional_vector("lattice_reference").value_or(shape.lattice_reference);
  shape.lattice_origin = body.optional_vector("lattice_origin").value_or(shape.lattice_origin);
  return shape;
}

BodyScene read_body(const Section& bodies, const std::string& name, const Names& materials,
                    const std::filesystem::path& scene_file) {
  const Names shapes = {"mesh", "box", "cylinder", "sphere", "ogive_rod", "particles"};
  const Names motion = {"material", "velocity", "angular_velocity", "angular_centre", "formulation", "motion",
                        "distortion_limit", "when_distorted", "coarse"};
  const Names mesh_keys = {"axis",         "reference",         "position",      "scale",
                           "lattice_axis", "lattice_reference", "lattice_origin"};
  // The full list first, so that a slip in the shape's own key is not taken for a missing shape.
  const Section any_shape = bodies.table(name, motion + shapes + Names{"spacing", "lattice"} + mesh_keys);
  Names given;
  for (const std::string& shape : shapes) {
    if (any_shape.has(shape)) given.push_back(shape);
  }
  if (given.size() != 1) {
    any_shape.refuse("needs exactly one of " + joined(shapes) + ", got " + (given.empty() ? "none" : joined(given)));
  }
  const std::string& shape = given[0];

  BodyScene body;
  body.name = name;
  if (shape == "mesh") {
    body.shape = read_mesh(bodies.table(name, motion + Names{"mesh", "spacing"} + mesh_keys), scene_file);
  } else if (shape == "particles") {
    const Section section = bodies.table(name, motion + Names{"particles"});
    body.shape = ParticleFileShape{beside_scene(scene_file, section.text("particles"))};
  } else {
    Names keys = motion + Names{shape, "spacing"};
    if (shape == "cylinder") keys.push_back("lattice");
    body.shape = read_solid(bodies.table(name, keys), shape);
  }
  body.material = any_shape.text("material");
  require_known_name(any_shape, "material", "material", body.material, materials);
  body.velocity = any_shape.optional_vector("velocity").value_or(Vector3{});
  body.angular_velocity = any_shape.optional_vector("angular_velocity").value_or(Vector3{});
  body.angular_centre = any_shape.optional_vector("angular_centre").value_or(Vector3{});
  body.formulation =
      any_shape.optional_choice("formulation", {{"deformable", OGIVE_FORMULATION_DEFORMABLE},
                                                {"rigid", OGIVE_FORMULATION_RIGID_FREE},
                                                {"rigid_prescribed", OGIVE_FORMULATION_RIGID_PRESCRIBED},
                                                {"total_lagrangian", OGIVE_FORMULATION_TOTAL_LAGRANGIAN}});
  for (const std::string key : {"distortion_limit", "when_distorted"}) {
    if (any_shape.has(key) && body.formulation != OGIVE_FORMULATION_TOTAL_LAGRANGIAN) {
      any_shape.refuse(key, "needs formulation = \"total_lagrangian\"");
    }
  }
  const Range above_one = {[](double value) { return value > 1; }, "> 1"};
  body.distortion_limit = any_shape.optional_number("distortion_limit", above_one);
  body.when_distorted = any_shape.optional_choice(
      "when_distorted", {{"update", OGIVE_DISTORTED_UPDATE}, {"stop", OGIVE_DISTORTED_STOP}});
  if (const auto coarse = any_shape.optional_table("coarse", Names{"beyond", "from", "to"})) {
    if (body.formulation.value_or(OGIVE_FORMULATION_DEFORMABLE) != OGIVE_FORMULATION_DEFORMABLE) {
      any_shape.refuse("coarse", "needs formulation = \"deformable\"");
    }
    body.coarse = CoarseScene{coarse->number("beyond", kPositive), coarse->vector("from"), {}};
    body.coarse->to = coarse->optional_vector("to").value_or(body.coarse->from);
  }
  for (const Section& knot : any_shape.tables("motion", Names{"time", "velocity", "angular_velocity"})) {
    if (body.formulation != OGIVE_FORMULATION_RIGID_PRESCRIBED) {
      any_shape.refuse("motion", "needs formulation = \"rigid_prescribed\"");
    }
    MotionScene at;
    at.time = knot.number("time", kAnyNumber);
    if (!body.motion.empty() && !(at.time > body.motion.back().time)) {
      knot.refuse("time", "must be > the time before it (" + shortest(body.motion.back().time) + "), got " +
                              shortest(at.time));
    }
    at.velocity = knot.optional_vector("velocity").value_or(Vector3{});
    at.angular_velocity = knot.optional_vector("angular_velocity").value_or(Vector3{});
    body.motion.push_back(at);
  }
  if (!body.motion.empty()) {
    for (const std::string key : {"velocity", "angular_velocity"}) {
      if (any_shape.has(key)) any_shape.refuse(key, "cannot be with motion, which gives it for every time");
    }
  }
  return body;
}

std::vector<BodyScene> read_bodies(const Section& root, const Names& materials,
                                   const std::filesystem::path& scene_file) {
  std::vector<BodyScene> bodies;
  const Section section = root.table("bodies", std::nullopt);
  for (const std::string& name : section.keys_in_file_order()) {
    require_plain_name(section, name);
    bodies.push_back(read_body(section, name, materials, scene_file));
  }
  if (bodies.empty()) section.refuse("must hold at least one body, [bodies.<name>], got none");
  return bodies;
}

std::vector<ClampScene> read_clamps(const Section& root, const Names& bodies) {
  std::vector<ClampScene> clamps;
  const Names box_keys = {"lower", "upper"};
  const Names cylinder_keys = {"centre", "axis", "radius"};
  for (const Section& section : root.tables("clamps", Names{"region", "body", "axes"} + box_keys + cylinder_keys)) {
    ClampScene clamp;
    section.text("region");  // needed
    clamp.region = *section.optional_choice(
        "region", {{"box", OGIVE_REGION_BOX}, {"outside_cylinder", OGIVE_REGION_OUTSIDE_CYLINDER}});
    const bool box = clamp.region == OGIVE_REGION_BOX;
    for (const std::string& key : box ? cylinder_keys : box_keys) {
      if (section.has(key))
        section.refuse(key, std::string("is not a key of region ") + (box ? "box" : "outside_cylinder"));
    }
    if (box) {
      clamp.a = section.vector("lower");
      clamp.b = section.vector("upper");
      for (size_t axis = 0; axis < 3; ++axis) {
        if (clamp.a[axis] <= clamp.b[axis]) continue;
        section.refuse(child_path("upper", axis),
                       "must be >= lower (" + shortest(clamp.a[axis]) + "), got " + shortest(clamp.b[axis]));
      }
    } else {
      clamp.a = section.vector("centre");
      section.vector("axis");  // needed
      clamp.b = *section.optional_direction("axis");
      clamp.radius = section.number("radius", kPositive);
    }
    clamp.body = section.optional_text("body");
    if (clamp.body) require_known_name(section, "body", "body", *clamp.body, bodies);
    if (const auto axes = section.optional_text("axes")) {
      clamp.axes = 0;
      for (const char letter : *axes) {
        const auto at = std::string("xyz").find(letter);
        if (at == std::string::npos) section.refuse("axes", "must be letters of \"xyz\", got \"" + *axes + '"');
        clamp.axes |= 1 << at;
      }
      if (clamp.axes == 0) section.refuse("axes", "must be letters of \"xyz\", got none");
    }
    clamps.push_back(clamp);
  }
  return clamps;
}

StopScene read_stop(const Section& root, const Names& bodies) {
  const Names conditions = {"settle_window", "settle_tolerance", "stop_when_stopped", "stop_when_out"};
  const Section section =
      root.table("stop", Names{"time", "body"} + conditions + Names{"exchange_window", "exchange_tolerance", "max_steps"});
  StopScene stop;
  stop.time = section.number("time", kPositive);
  stop.body = section.optional_text("body");
  if (stop.body) require_known_name(section, "body", "body", *stop.body, bodies);
  for (const std::string& key : conditions) {
    if (section.has(key) && !stop.body) section.refuse(key, "needs stop.body, the body whose motion is watched");
  }
  stop.settle_window = section.optional_number("settle_window", kNotNegative);
  stop.settle_tolerance = section.optional_number("settle_tolerance", kPositive);
  if (stop.settle_window.value_or(0) > 0 && !stop.settle_tolerance) {
    section.refuse("settle_tolerance", "missing; expected a speed > 0 where settle_window > 0");
  }
  stop.stop_when_stopped = section.optional_flag("stop_when_stopped");
  stop.stop_when_out = section.optional_flag("stop_when_out");
  stop.exchange_window = section.optional_number("exchange_window", kNotNegative);
  const Range part = {[](double value) { return value > 0 && value < 1; }, "> 0 and < 1"};
  stop.exchange_tolerance = section.optional_number("exchange_tolerance", part);
  if (stop.exchange_tolerance && !stop.exchange_window) {
    section.refuse("exchange_tolerance", "needs stop.exchange_window, the time during which it must be kept");
  }
  stop.max_steps = section.optional_integer("max_steps", 0, int64_t{1} << 52).value_or(0);
  return stop;
}

OutputScene read_output(const Section& root, const Names& bodies, double stop_time) {
  OutputScene output;
  output.history_interval = stop_time / 100;
  output.checkpoint_steps = 1000;
  const auto section = root.optional_table(
      "output", Names{"history_interval", "particle_interval", "checkpoint_steps", "checkpoint_keep", "results"});
  if (!section) return output;
  output.history_interval = section->optional_number("history_interval", kPositive).value_or(output.history_interval);
  output.particle_interval = section->optional_number("particle_interval", kNotNegative).value_or(0);
  // Output is numbered by whole multiples of its interval.
  const double shortest_interval = 1e-12 * stop_time;
  for (const auto& [key, value] : {std::pair{"history_interval", output.history_interval},
                                   std::pair{"particle_interval", output.particle_interval}}) {
    if (value > 0 && value < shortest_interval)
      section->refuse(key, "must be at least " + shortest(shortest_interval) + " (stop.time/1e12), got " + shortest(value));
  }
  output.checkpoint_steps =
      section->optional_integer("checkpoint_steps", 0, int64_t{1} << 52).value_or(output.checkpoint_steps);
  output.checkpoint_keep = section->optional_integer("checkpoint_keep", 1, 1000000).value_or(output.checkpoint_keep);
  const Names kinds = {"residual_velocity"};
  if (const auto results = section->optional_table("results", kinds)) {
    for (const std::string& kind : results->keys_in_file_order()) {
      const std::string body = results->text(kind);
      require_known_name(*results, kind, "body", body, bodies);
      output.results.push_back({kind, body});
    }
  }
  return output;
}

}  // namespace

Scene read_scene(const Document& document, const std::filesystem::path& file) {
  const Expressions no_expressions;
  const Section bare_root(document, no_expressions, document.root(), "",
                          Names{"title", "symmetry", "accuracy", "parameters", "units", "grid", "numerics", "contact", "walls", "materials",
                                "bodies", "clamps", "stop", "output"});
  const Expressions expressions = read_parameters(document, bare_root);
  const Section root(document, expressions, document.root(), "", std::nullopt);

  Scene scene;
  scene.file = file;
  scene.text = document.text();
  scene.places = document.places();
  scene.title = root.optional_text("title").value_or(file.stem().string());
  scene.symmetry = read_symmetry(root);
  scene.accuracy = read_accuracy(root);
  scene.parameters = expressions.parameters();
  scene.units = read_units(root);
  scene.grid = read_grid(root);
  scene.numerics = read_numerics(root);
  scene.materials = read_materials(root);
  scene.bodies = read_bodies(root, names_of(scene.materials), file);
  const Names bodies = names_of(scene.bodies);
  read_contact(root, bodies, scene);
  read_walls(root, scene);
  scene.clamps = read_clamps(root, bodies);
  scene.stop = read_stop(root, bodies);
  scene.output = read_output(root, bodies, scene.stop.time);
  return scene;
}

std::string Scene::place(const std::string& path) const { return place_of(places, path) + ": " + path; }

}  // namespace driver
