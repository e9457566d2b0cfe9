// The C interface: random calls in random order with random arguments, mostly sensible, now and then anything at all. No call
// crashes, ends with an internal error or fails without a message; what is not finite is found within two steps.
#include <algorithm>

#include "worlds.hpp"

namespace {

using namespace fuzz;

constexpr int kMostParticles = 800;  // of all bodies: larger worlds find nothing that small ones do not

void fill3(Input& input, double (&v)[3], double usual) {
  for (double& c : v) c = input.about(usual) * (input.one_in(2) ? -1 : 1);
}

const char* name_of(Input& input) {
  static const char* const names[] = {"a", "b", "c", "", nullptr, "a name with blanks",
                                      "0123456789012345678901234567890123456789012345678901234567890123456789", "\xff\n"};
  return names[input.below(8) < 6 ? input.below(3) : input.below(8)];
}

class Caller {
 public:
  /// Half of the inputs begin with a world that runs already.
  explicit Caller(Input& input) : input_(input) {
    const int first = input_.byte();
    world_ = first % 2 == 1 ? small_world(first / 2 % world_kinds) : make_world();
  }

  void run() {
    for (int i = 0; i < 60 && !input_.ended(); ++i) call();
    ogive_progress progress{};
    progress.struct_size = sizeof progress;
    if (ogive_world_progress(world(), &progress) == OGIVE_OK && progress.steps > 0) ++accepted;
  }

 private:
  ogive_world* world() { return world_.get(); }

  ogive_status see(ogive_status status) {
    require(status != OGIVE_ERROR_INTERNAL, "a call ended with an internal error");
    require(status >= OGIVE_OK && status <= OGIVE_ERROR_FORMAT, "a call returned an unknown status");
    if (status != OGIVE_OK) require(*ogive_world_message(world()) != '\0', "a failed call has no message");
    return status;
  }

  ogive_body_id body() { return {input_.one_in(16) ? input_.whole() : input_.below(3)}; }

  void set_grid() {
    ogive_grid_def def;
    ogive_grid_def_init(&def, sizeof def);
    def.cell_size = input_.about(1);
    for (int axis = 0; axis < 3; ++axis) {
      def.domain_min[axis] = input_.one_in(16) ? input_.number() : -4;
      def.domain_max[axis] = input_.one_in(16) ? input_.number() : 4;
    }
    for (std::int32_t& face : def.face) face = input_.one_in(4) ? input_.below(4) : OGIVE_FACE_FREE;
    if (input_.one_in(3)) {
      def.space = input_.below(input_.one_in(8) ? 5 : 3);
      def.thickness = input_.about(1);
      if (def.space == OGIVE_SPACE_AXISYMMETRIC && !input_.one_in(8)) def.domain_min[0] = 0;
    }
    see(ogive_world_set_grid(world(), &def));
  }

  void set_numerics() {
    ogive_numerics_def def;
    ogive_numerics_def_init(&def, sizeof def);
    def.shape_function = input_.below(2);
    if (input_.one_in(3)) def.time_step_factor = input_.about(0.1);
    if (input_.one_in(4)) def.maximum_time_step = input_.about(1e-3);
    if (input_.one_in(4)) fill3(input_, def.gravity, 10);
    def.transfer = input_.below(input_.one_in(8) ? 6 : 4);
    def.update_order = input_.below(3);
    if (input_.one_in(3)) def.pic_fraction = input_.about(0.1);
    if (input_.one_in(3)) def.skip_resting = input_.below(input_.one_in(8) ? 3 : 2);
    if (input_.one_in(3)) def.xpic_order = input_.one_in(8) ? input_.whole() : 1 + input_.below(4);
    if (input_.one_in(3)) def.drop_debris = input_.one_in(8) ? input_.whole() : 1;
    see(ogive_world_set_numerics(world(), &def));
  }

  ogive_contact_def contact() {
    ogive_contact_def def;
    ogive_contact_def_init(&def, sizeof def);
    def.method = input_.below(8 + input_.one_in(8));
    def.normal = input_.below(5 + input_.one_in(8));
    def.master = input_.one_in(3) ? body() : ogive_body_id{-1};
    def.friction = input_.about(0.1);
    def.detection = input_.below(2);
    if (input_.one_in(3)) def.gap_offset = input_.number();
    return def;
  }

  ogive_material_def material() {
    ogive_material_def def;
    ogive_material_def_init(&def, sizeof def);
    def.strength = input_.below(6);
    const bool mixed = def.strength == OGIVE_STRENGTH_J2_MIXED || def.strength == OGIVE_STRENGTH_J2_MULTIPLICATIVE;
    def.eos = mixed || def.strength == OGIVE_STRENGTH_NEO_HOOKEAN ? OGIVE_EOS_LINEAR : input_.below(2);
    def.failure = mixed ? OGIVE_FAILURE_NONE : input_.below(2);
    if (mixed) def.isotropic_fraction = input_.about(0.5);
    def.density = input_.about(8e-3);
    if (input_.one_in(2)) {
      def.bulk_modulus = input_.about(1e5), def.shear_modulus = input_.about(4e4);
    } else {
      def.youngs_modulus = input_.about(1e5), def.poisson_ratio = input_.about(0.1);
    }
    def.yield_stress = input_.about(100), def.hardening_modulus = input_.about(100);
    def.hardening_exponent = mixed ? 1 : input_.about(0.3);
    if (input_.one_in(2)) def.rate_coefficient = input_.about(0.01), def.reference_strain_rate = input_.about(1e-3);
    if (input_.one_in(2))
      def.thermal_exponent = input_.about(1), def.melt_temperature = input_.about(1000), def.specific_heat = input_.about(400);
    def.eos_sound_speed = input_.about(3000), def.eos_slope = input_.about(1), def.gruneisen = input_.about(1);
    def.failure_strain = input_.about(0.3);
    if (input_.one_in(2)) def.viscosity_linear = input_.about(0.05), def.viscosity_quadratic = input_.about(0.5);
    return def;
  }

  void add_material() {
    const ogive_material_def def = material();
    ogive_material_id id;
    see(ogive_material_add(world(), name_of(input_), &def, &id));
  }

  void change_material() {
    if (input_.one_in(2)) see(ogive_world_reopen(world()));
    const ogive_material_def def = material();
    see(ogive_material_change(world(), {input_.one_in(8) ? input_.whole() : 0}, &def));
    see(ogive_world_prepare(world()));
  }

  ogive_body_def body_def() {
    ogive_body_def def;
    ogive_body_def_init(&def, sizeof def);
    def.material.index = input_.one_in(16) ? input_.whole() : 0;
    fill3(input_, def.velocity, 50);
    if (input_.one_in(4)) fill3(input_, def.angular_velocity, 1);
    def.formulation = input_.one_in(3) ? input_.below(4) : OGIVE_FORMULATION_DEFORMABLE;
    return def;
  }

  void add_solid() {
    const ogive_body_def def = body_def();
    ogive_solid_def solid;
    ogive_solid_def_init(&solid, sizeof solid);
    solid.solid = input_.below(4);
    solid.lattice = input_.one_in(4);
    for (int axis = 0; axis < 3; ++axis) {
      solid.size[axis] = input_.about(1);
      solid.centre[axis] = input_.one_in(2) ? input_.about(1) - 2 : 0;
      solid.spacing[axis] = input_.about(0.5);
    }
    if (input_.one_in(4)) fill3(input_, solid.axis, 1);
    std::int64_t count = 0;
    double cells = 1;
    for (int axis = 0; axis < 3; ++axis) cells *= std::max(2 * solid.size[axis] / solid.spacing[axis], 1.0);
    if (cells > 1e7) return;  // counting alone would take seconds
    if (see(ogive_solid_particles(world(), &solid, &count, nullptr, nullptr)) == OGIVE_OK && count + particles_ > kMostParticles)
      return;
    ogive_body_id id;
    if (see(ogive_body_add_solid(world(), name_of(input_), &def, &solid, &id)) == OGIVE_OK) particles_ += count;
  }

  void add_particles() {
    const ogive_body_def def = body_def();
    const int count = input_.below(40);
    std::vector<double> xyz, volume;
    for (int i = 0; i < count; ++i) {
      for (int c = 0; c < 3; ++c) xyz.push_back(input_.one_in(32) ? input_.number() : (input_.byte() - 128) / 40.0);
      volume.push_back(input_.about(0.1));
    }
    ogive_body_id id;
    see(ogive_body_add_particles(world(), name_of(input_), &def, input_.one_in(16) ? -count : count, xyz.data(), volume.data(),
                                 &id));
  }

  void set_motion() {
    const int count = input_.below(4);
    std::vector<double> time, velocity, spin;
    for (int i = 0; i < count; ++i) {
      time.push_back(input_.one_in(8) ? input_.number() : i);
      for (int c = 0; c < 3; ++c) velocity.push_back(input_.about(20)), spin.push_back(input_.about(1));
    }
    see(ogive_body_set_motion(world(), body(), count, time.data(), velocity.data(), spin.data()));
  }

  void add_wall() {
    ogive_wall_def def;
    ogive_wall_def_init(&def, sizeof def);
    def.method = input_.below(9);
    fill3(input_, def.point, 2);
    fill3(input_, def.normal, 1);
    def.friction = input_.about(0.1);
    def.detection = input_.below(2);
    see(ogive_wall_add(world(), &def));
  }

  template <class Def>
  void place(Def& def) {
    def.region = input_.below(3 + input_.one_in(8));
    def.body = input_.one_in(2) ? body() : ogive_body_id{-1};
    for (int c = 0; c < 3; ++c) def.a[c] = -input_.about(2), def.b[c] = input_.about(2);
    def.radius = input_.about(1);
    def.axes = input_.one_in(4) ? input_.whole() : 7;
  }

  void add_clamp() {
    ogive_clamp_def def;
    ogive_clamp_def_init(&def, sizeof def);
    place(def);
    see(ogive_clamp_add(world(), &def));
  }

  void add_load() {
    ogive_load_def def;
    ogive_load_def_init(&def, sizeof def);
    place(def);
    def.kind = input_.below(3 + input_.one_in(8));
    fill3(input_, def.value, 10);
    def.area = input_.about(1);
    see(ogive_load_add(world(), &def, nullptr));
  }

  void set_load() {
    double value[3];
    fill3(input_, value, 10);
    see(ogive_load_set(world(), {input_.below(3)}, value));
    ogive_load_result result{};
    result.struct_size = input_.one_in(8) ? static_cast<std::uint32_t>(input_.whole()) : sizeof result;
    if (result.struct_size <= sizeof result) see(ogive_load_result_get(world(), {input_.below(3)}, &result));
  }

  void set_stop() {
    ogive_stop_def def;
    ogive_stop_def_init(&def, sizeof def);
    def.body = body();
    def.settle_window = input_.about(1), def.settle_tolerance = input_.about(1);
    def.exchange_window = input_.about(1), def.exchange_tolerance = input_.about(0.1);
    see(ogive_world_set_stop(world(), &def));
  }

  void set_field() {
    static const char* const names[] = {"position", "velocity", "affine_velocity", "stress", "energy", "plastic_strain",
                                        "temperature", "volume_ratio", "deformation_gradient", "force", "mass", "nonsense"};
    const char* name = names[input_.below(12)];
    const ogive_body_id id = body();
    std::int32_t components = 0;
    for (std::int32_t f = 0; f < ogive_field_count(world(), id); ++f) {
      std::int32_t these = 0;
      if (std::strcmp(ogive_field_name(world(), id, f, &these), name) == 0) components = these;
    }
    if (components == 0) components = 3;
    ogive_body_result result{};
    result.struct_size = sizeof result;
    if (ogive_body_result_get(world(), id, &result) != OGIVE_OK) return;
    std::vector<double> values(static_cast<std::size_t>(result.particles * components) + 1);
    const std::int64_t count = input_.one_in(16) ? input_.below(4) : result.particles * components;
    if (count > static_cast<std::int64_t>(values.size())) return;
    if (ogive_field_get(world(), id, name, values.data(), count) != OGIVE_OK && std::strcmp(name, "force") != 0) return;
    for (int i = 0; i < 3 && !values.empty(); ++i)
      values[static_cast<std::size_t>(input_.below(60000)) % values.size()] = input_.number();
    see(ogive_field_set(world(), id, name, values.data(), count));
  }

  void look() {
    std::size_t needed = 0;
    char text[300];
    see(ogive_world_plan(world(), text, input_.below(300), &needed));
    ogive_ledger ledger{};
    ogive_progress progress{};
    ogive_pair_result pair{};
    ledger.struct_size = sizeof ledger, progress.struct_size = sizeof progress, pair.struct_size = sizeof pair;
    see(ogive_world_ledger(world(), &ledger));
    see(ogive_world_progress(world(), &progress));
    see(ogive_pair_result_get(world(), body(), body(), &pair));
    ogive_body_id id;
    see(ogive_body_find(world(), "a", &id));
  }

  void attach() {
    const std::string data(static_cast<std::size_t>(input_.below(20)) + 1, 'x');
    see(ogive_world_attach(world(), name_of(input_), data.data(), input_.one_in(8) ? 0 : static_cast<std::int64_t>(data.size())));
  }

  void save_and_load() {
    const ogive_writer writer = store_.writer();
    if (see(ogive_world_save(world(), &writer)) != OGIVE_OK) return;
    if (input_.one_in(2)) world_ = make_world();
    const ogive_reader reader = store_.reader();
    see(ogive_world_load(world(), &reader));
  }

  static std::int32_t in_callback(ogive_world* world, void* self) {
    auto* caller = static_cast<Caller*>(self);
    caller->see(ogive_world_step(world, 0));  // refused
    if (caller->input_.one_in(4)) caller->set_field();
    if (caller->input_.one_in(4)) caller->set_load();
    return caller->input_.one_in(4);
  }

  void call() {
    switch (input_.below(28)) {
      case 0:
        return set_grid();
      case 1:
        return set_numerics();
      case 2: {
        const ogive_contact_def def = contact();
        see(ogive_world_set_contact(world(), &def));
        return;
      }
      case 3: {
        const ogive_contact_def def = contact();
        see(ogive_contact_set_pair(world(), body(), body(), &def));
        return;
      }
      case 4:
        return add_material();
      case 5:
      case 6:
        return add_solid();
      case 7:
        return add_particles();
      case 8:
        return set_motion();
      case 9:
        return add_wall();
      case 10:
        return add_clamp();
      case 11:
        return add_load();
      case 12:
        return set_load();
      case 13:
        return set_stop();
      case 14:
      case 15:
        see(ogive_world_prepare(world()));
        return;
      case 16:
      case 17:
        return step_and_look(world(), 1 + input_.below(4));
      case 18:
        see(ogive_world_advance(world(), input_.about(1), 1 + input_.below(3), in_callback, this));
        return;
      case 19:
      case 20:
        return set_field();
      case 21:
        return look();
      case 22:
        return attach();
      case 23:
        return save_and_load();
      case 24:
        see(ogive_world_step(world(), input_.number()));
        return;
      case 25:
        see(ogive_world_reopen(world()));
        return;
      case 26:
        return change_material();
      default:
        see(ogive_world_set_threads(world(), input_.one_in(4) ? input_.whole() : 1));
        see(ogive_world_set_threads(world(), 1));
    }
  }

  Input& input_;
  World world_;
  Store store_;
  std::int64_t particles_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  Caller(input).run();
  return 0;
}
