// From a scene to a prepared world, through the C interface alone.
#include "build.hpp"

#include <algorithm>

#include "filled_mesh.hpp"

namespace driver {
namespace {

/// A value that the scene gives replaces the engine's default.
template <typename Field, typename Value>
void assign(Field& field, const std::optional<Value>& value) {
  if (value) field = static_cast<Field>(*value);
}

void assign(double (&field)[3], const Vector3& value) { std::copy(value.begin(), value.end(), field); }

class Builder {
 public:
  Builder(const Scene& scene, ogive_world* world) : scene_(scene), world_(world) {}

  std::vector<std::string> build() {
    set_grid();
    set_numerics();
    for (const MaterialScene& material : scene_.materials) add_material(material);
    for (const BodyScene& body : scene_.bodies) add_body(body);
    set_contact();
    for (size_t i = 0; i < scene_.walls.size(); ++i) add_wall(i);
    for (size_t i = 0; i < scene_.clamps.size(); ++i) add_clamp(i);
    set_stop();
    prepare();
    return std::move(notes_);
  }

  ParticleList particles_of(const BodyScene& body) {
    const std::string path = "bodies." + body.name;
    if (std::holds_alternative<MeshShape>(body.shape)) return mesh_of(body, path).particles;
    ParticleList particles;
    int64_t count = 0;
    const auto make_room = [&] {
      particles.positions.resize(static_cast<size_t>(3 * count));
      particles.volumes.resize(static_cast<size_t>(count));
    };
    set_grid();
    if (const auto* solid = std::get_if<SolidShape>(&body.shape)) {
      const ogive_solid_def shape = solid_def(*solid);
      require(ogive_solid_particles(world_, &shape, &count, nullptr, nullptr), path);
      make_room();
      require(ogive_solid_particles(world_, &shape, &count, particles.positions.data(), particles.volumes.data()), path);
      return particles;
    }
    // A file is read by adding it, to a world of its own.
    for (const MaterialScene& material : scene_.materials) add_material(material);
    BodyScene alone = body;
    alone.formulation = OGIVE_FORMULATION_DEFORMABLE;
    alone.motion.clear();
    alone.coarse.reset();
    add_body(alone);
    prepare();
    count = body_result_of(world_, 0).particles;
    make_room();
    require(ogive_field_get(world_, ogive_body_id{0}, "position", particles.positions.data(), 3 * count), path);
    require(ogive_field_get(world_, ogive_body_id{0}, "volume", particles.volumes.data(), count), path);
    return particles;
  }

  void change(const Scene& before) {
    for (size_t i = 0; i < scene_.materials.size(); ++i) material_ids_.push_back({static_cast<int32_t>(i)});
    for (size_t i = 0; i < scene_.bodies.size(); ++i) body_ids_.push_back({static_cast<int32_t>(i)});
    require(ogive_world_reopen(world_), "");
    set_numerics();
    for (size_t i = 0; i < scene_.materials.size(); ++i) {
      const ogive_material_def def = material_def(scene_.materials[i]);
      require(ogive_material_change(world_, material_ids_[i], &def), "materials." + scene_.materials[i].name);
    }
    // A pair that has no rule of its own any more gets the scene's.
    for (const ContactPairScene& pair : before.contact_pairs) {
      ContactScene rule = scene_.contact;
      if (rule.master && *rule.master != pair.bodies[0] && *rule.master != pair.bodies[1]) rule.master.reset();
      set_pair(pair.bodies, rule, "contact");
    }
    set_contact();
    set_stop();
    prepare();
  }

 private:
  /// Whatever the engine refuses now is the scene's fault, except want of memory and defects.
  void require(ogive_status status, const std::string& path) const {
    if (status == OGIVE_OK) return;
    std::string message = ogive_world_message(world_);
    if (message.empty()) message = ogive_status_name(status);
    const bool user_can_mend = status != OGIVE_ERROR_MEMORY && status != OGIVE_ERROR_INTERNAL;
    throw Failure(user_can_mend ? kExitInput : exit_code(status), scene_.place(path) + ": " + message);
  }

  ogive_body_id body_id(const std::optional<std::string>& name) const {
    for (size_t i = 0; name && i < scene_.bodies.size(); ++i) {
      if (scene_.bodies[i].name == *name) return body_ids_[i];
    }
    return {-1};
  }

  void set_grid() {
    ogive_grid_def def;
    ogive_grid_def_init(&def, sizeof def);
    def.cell_size = scene_.grid.cell_size;
    assign(def.domain_min, scene_.grid.lower);
    assign(def.domain_max, scene_.grid.upper);
    std::copy(scene_.grid.faces.begin(), scene_.grid.faces.end(), def.face);
    def.space = scene_.grid.space;
    assign(def.thickness, scene_.grid.thickness);
    require(ogive_world_set_grid(world_, &def), "grid");
  }

  void set_numerics() {
    ogive_numerics_def def;
    ogive_numerics_def_init(&def, sizeof def);
    assign(def.shape_function, scene_.numerics.shape_function);
    assign(def.time_step_factor, scene_.numerics.time_step_factor);
    assign(def.maximum_time_step, scene_.numerics.maximum_time_step);
    assign(def.threads, scene_.numerics.threads);
    assign(def.gravity, scene_.numerics.gravity);
    assign(def.transfer, scene_.numerics.transfer);
    assign(def.update_order, scene_.numerics.update_order);
    assign(def.pic_fraction, scene_.numerics.pic_fraction);
    assign(def.xpic_order, scene_.numerics.xpic_order);
    assign(def.energy_warning, scene_.numerics.energy_warning);
    assign(def.energy_limit, scene_.numerics.energy_limit);
    assign(def.energy_loss_limit, scene_.numerics.energy_loss_limit);
    assign(def.drop_debris, scene_.numerics.drop_debris);
    assign(def.skip_resting, scene_.numerics.skip_resting);
    require(ogive_world_set_numerics(world_, &def), "numerics");
  }

  static ogive_material_def material_def(const MaterialScene& material) {
    ogive_material_def def;
    ogive_material_def_init(&def, sizeof def);
    def.density = material.density;
    def.strength = material.strength;
    def.eos = material.equation_of_state;
    def.failure = material.failure_strain ? OGIVE_FAILURE_PLASTIC_STRAIN : OGIVE_FAILURE_NONE;
    assign(def.youngs_modulus, material.youngs_modulus);
    assign(def.poisson_ratio, material.poisson_ratio);
    assign(def.bulk_modulus, material.bulk_modulus);
    assign(def.shear_modulus, material.shear_modulus);
    assign(def.yield_stress, material.yield_stress);
    assign(def.hardening_modulus, material.hardening_modulus);
    assign(def.hardening_exponent, material.hardening_exponent);
    assign(def.rate_coefficient, material.rate_coefficient);
    assign(def.reference_strain_rate, material.reference_strain_rate);
    assign(def.thermal_exponent, material.thermal_exponent);
    assign(def.melt_temperature, material.melt_temperature);
    assign(def.room_temperature, material.room_temperature);
    assign(def.specific_heat, material.specific_heat);
    assign(def.taylor_quinney, material.taylor_quinney);
    assign(def.eos_sound_speed, material.eos_sound_speed);
    assign(def.eos_slope, material.eos_slope);
    assign(def.gruneisen, material.gruneisen);
    assign(def.failure_strain, material.failure_strain);
    assign(def.viscosity_linear, material.viscosity_linear);
    assign(def.viscosity_quadratic, material.viscosity_quadratic);
    assign(def.isotropic_fraction, material.isotropic_fraction);
    return def;
  }

  void add_material(const MaterialScene& material) {
    const ogive_material_def def = material_def(material);
    ogive_material_id id{-1};
    require(ogive_material_add(world_, material.name.c_str(), &def, &id), "materials." + material.name);
    material_ids_.push_back(id);
  }

  static ogive_solid_def solid_def(const SolidShape& solid) {
    ogive_solid_def def;
    ogive_solid_def_init(&def, sizeof def);
    def.solid = solid.solid;
    def.lattice = solid.lattice;
    assign(def.size, solid.size);
    assign(def.centre, solid.centre);
    assign(def.axis, solid.axis);
    assign(def.reference, solid.reference);
    assign(def.spacing, solid.spacing);
    return def;
  }

  void add_body(const BodyScene& body) {
    const std::string path = "bodies." + body.name;
    ogive_body_def def;
    ogive_body_def_init(&def, sizeof def);
    for (size_t i = 0; i < scene_.materials.size(); ++i) {
      if (scene_.materials[i].name == body.material) def.material = material_ids_[i];
    }
    assign(def.velocity, body.velocity);
    assign(def.angular_velocity, body.angular_velocity);
    assign(def.angular_centre, body.angular_centre);
    assign(def.formulation, body.formulation);
    assign(def.distortion_limit, body.distortion_limit);
    assign(def.when_distorted, body.when_distorted);
    if (body.coarse) {
      def.coarse_beyond = body.coarse->beyond;
      assign(def.coarse_from, body.coarse->from);
      assign(def.coarse_to, body.coarse->to);
    }
    ogive_body_id id{-1};
    if (const auto* solid = std::get_if<SolidShape>(&body.shape)) {
      const ogive_solid_def shape = solid_def(*solid);
      require(ogive_body_add_solid(world_, body.name.c_str(), &def, &shape, &id), path);
    } else if (const auto* file = std::get_if<ParticleFileShape>(&body.shape)) {
      require(ogive_body_add_particle_file(world_, body.name.c_str(), &def, file->file.c_str(), &id),
              path + ".particles");
    } else {
      const FilledMesh filled = mesh_of(body, path);
      const ParticleList& particles = filled.particles;
      require(ogive_body_add_particles(world_, body.name.c_str(), &def,
                                       static_cast<int64_t>(particles.volumes.size()), particles.positions.data(),
                                       particles.volumes.data(), &id),
              path);
      require(ogive_body_set_surface(world_, id, static_cast<int64_t>(filled.vertices.size() / 3),
                                     filled.vertices.data(), static_cast<int64_t>(filled.corners.size() / 3),
                                     filled.corners.data()),
              path + ".mesh");
    }
    body_ids_.push_back(id);
    if (!body.motion.empty()) set_motion(body, id, path);
  }

  void set_motion(const BodyScene& body, ogive_body_id id, const std::string& path) {
    std::vector<double> time, velocity, angular_velocity;
    for (const MotionScene& at : body.motion) {
      time.push_back(at.time);
      velocity.insert(velocity.end(), at.velocity.begin(), at.velocity.end());
      angular_velocity.insert(angular_velocity.end(), at.angular_velocity.begin(), at.angular_velocity.end());
    }
    require(ogive_body_set_motion(world_, id, static_cast<int32_t>(time.size()), time.data(), velocity.data(),
                                  angular_velocity.data()),
            path + ".motion");
  }

  FilledMesh mesh_of(const BodyScene& body, const std::string& path) {
    FilledMesh filled = fill_mesh(std::get<MeshShape>(body.shape), scene_.grid, scene_.place(path + ".mesh"));
    if (filled.repaired) notes_.push_back("mesh of body " + body.name + ":\n" + filled.report);
    return filled;
  }

  ogive_contact_def contact_def(const ContactScene& contact) const {
    ogive_contact_def def;
    ogive_contact_def_init(&def, sizeof def);
    assign(def.method, contact.method);
    assign(def.normal, contact.normal);
    def.master = body_id(contact.master);
    assign(def.friction, contact.friction);
    assign(def.detection, contact.detection);
    assign(def.gap_offset, contact.gap_offset);
    return def;
  }

  void set_contact() {
    const ogive_contact_def def = contact_def(scene_.contact);
    require(ogive_world_set_contact(world_, &def), "contact");
    for (size_t i = 0; i < scene_.contact_pairs.size(); ++i)
      set_pair(scene_.contact_pairs[i].bodies, scene_.contact_pairs[i].rule, child_path("contact.pairs", i));
  }

  void set_pair(const std::array<std::string, 2>& bodies, const ContactScene& rule, const std::string& path) {
    ogive_contact_def def = contact_def(rule);
    // Without a name, the first of the two in the scene, as for all pairs.
    if (def.master.index < 0) def.master.index = std::min(body_id(bodies[0]).index, body_id(bodies[1]).index);
    require(ogive_contact_set_pair(world_, body_id(bodies[0]), body_id(bodies[1]), &def), path);
  }

  void add_wall(size_t index) {
    const WallScene& wall = scene_.walls[index];
    ogive_wall_def def;
    ogive_wall_def_init(&def, sizeof def);
    assign(def.point, wall.point);
    assign(def.normal, wall.normal);
    assign(def.method, wall.rule.method);
    assign(def.friction, wall.rule.friction);
    assign(def.detection, wall.rule.detection);
    assign(def.gap_offset, wall.rule.gap_offset);
    require(ogive_wall_add(world_, &def), child_path("walls", index));
  }

  void add_clamp(size_t index) {
    const ClampScene& clamp = scene_.clamps[index];
    ogive_clamp_def def;
    ogive_clamp_def_init(&def, sizeof def);
    def.region = clamp.region;
    assign(def.a, clamp.a);
    assign(def.b, clamp.b);
    def.radius = clamp.radius;
    def.body = body_id(clamp.body);
    def.axes = clamp.axes;
    require(ogive_clamp_add(world_, &def), child_path("clamps", index));
  }

  void set_stop() {
    const StopScene& stop = scene_.stop;
    ogive_stop_def def;
    ogive_stop_def_init(&def, sizeof def);
    def.body = body_id(stop.body);
    assign(def.settle_window, stop.settle_window);
    assign(def.settle_tolerance, stop.settle_tolerance);
    assign(def.stop_when_stopped, stop.stop_when_stopped);
    assign(def.stop_when_out, stop.stop_when_out);
    assign(def.exchange_window, stop.exchange_window);
    assign(def.exchange_tolerance, stop.exchange_tolerance);
    require(ogive_world_set_stop(world_, &def), "stop");
  }

  void prepare() {
    const ogive_status status = ogive_world_prepare(world_);
    if (status == OGIVE_OK) return;
    // The message names the bodies that it is about, the last one being the one that was added against the others.
    const std::string message = ogive_world_message(world_);
    std::string path;
    size_t latest = 0;
    for (const BodyScene& body : scene_.bodies) {
      for (const char quote : {'"', '\''}) {
        const size_t at = message.rfind(quote + body.name + quote);
        if (at == std::string::npos || (!path.empty() && at < latest)) continue;
        path = "bodies." + body.name;
        latest = at;
      }
    }
    require(status, path.empty() ? "bodies" : path);
  }

  const Scene& scene_;
  ogive_world* world_;
  std::vector<ogive_material_id> material_ids_;
  std::vector<ogive_body_id> body_ids_;
  std::vector<std::string> notes_;
};

}  // namespace

BuiltWorld build_world(const Scene& scene) {
  BuiltWorld built{make_world(), {}};
  built.notes = Builder(scene, built.world.get()).build();
  return built;
}

ParticleList body_particles(const Scene& scene, size_t body) {
  const World world = make_world();
  return Builder(scene, world.get()).particles_of(scene.bodies[body]);
}

std::vector<std::string> model_changes(const Scene& before, const Scene& after) {
  const auto must_stay = [&](bool same, const char* what) {
    if (same) return;
    throw Failure(kExitInput, after.place(what) + ": cannot be changed by a restart, because the particles of the checkpoint "
                                                  "stand on it");
  };
  must_stay(before.symmetry == after.symmetry, "symmetry");
  must_stay(before.accuracy == after.accuracy, "accuracy");
  must_stay(before.units == after.units, "units");
  must_stay(before.grid == after.grid, "grid");
  must_stay(before.bodies == after.bodies, "bodies");
  must_stay(before.walls == after.walls, "walls");
  must_stay(before.clamps == after.clamps, "clamps");
  bool same_list = before.materials.size() == after.materials.size();
  for (size_t i = 0; same_list && i < before.materials.size(); ++i)
    same_list = before.materials[i].name == after.materials[i].name;
  must_stay(same_list, "materials");
  std::vector<std::string> changes;
  NumericsScene numerics = after.numerics;
  numerics.threads = before.numerics.threads;
  if (numerics != before.numerics) changes.push_back("numerics");
  if (before.contact != after.contact || before.contact_pairs != after.contact_pairs) changes.push_back("contact");
  if (before.materials != after.materials) changes.push_back("materials");
  return changes;
}

void change_world(const Scene& before, const Scene& after, ogive_world* world) { Builder(after, world).change(before); }

}  // namespace driver
