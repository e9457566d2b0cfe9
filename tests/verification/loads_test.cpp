// Loads of the host: accelerations, tractions, forces on particles, prescribed velocities; sums over pairs of bodies.
#include "scene.hpp"

namespace verification {
namespace {

ogive_load_def load_def(std::int32_t kind, ogive_body_id body, Vec3 value) {
  ogive_load_def def;
  ogive_load_def_init(&def, sizeof def);
  def.kind = kind;
  def.body = body;
  for (int c = 0; c < 3; ++c) def.value[c] = value[c];
  return def;
}

void in_box(ogive_load_def& def, Vec3 lower, Vec3 upper) {
  def.region = OGIVE_REGION_BOX;
  for (int c = 0; c < 3; ++c) {
    def.a[c] = lower[c];
    def.b[c] = upper[c];
  }
}

ogive_load_id add(const Scene& scene, const ogive_load_def& def) {
  ogive_load_id id{-1};
  scene.check(ogive_load_add(scene.get(), &def, &id));
  return id;
}

ogive_load_result result(const Scene& scene, ogive_load_id load) {
  ogive_load_result found{};
  found.struct_size = sizeof found;
  scene.check(ogive_load_result_get(scene.get(), load, &found));
  return found;
}

ogive_pair_result pair(const Scene& scene, ogive_body_id a, ogive_body_id b) {
  ogive_pair_result found{};
  found.struct_size = sizeof found;
  scene.check(ogive_pair_result_get(scene.get(), a, b, &found));
  return found;
}

class Loads : public testing::TestWithParam<std::int32_t> {};

// v = a t for a free body, whatever its shape functions; its work is m v^2 / 2.
TEST_P(Loads, AccelerationGivesAFreeBodyItsSpeedAndItsWorkIsTheKineticEnergy) {
  Scene scene;
  scene.grid(1.0, {-6, -6, -6}, {6, 6, 6}).numerics(GetParam(), 0.4);
  const ogive_body_id block = scene.box("block", scene.material("steel", steel()), {-2, -2, -2}, {2, 2, 2}, 0.5, {});
  const ogive_load_id load = add(scene, load_def(OGIVE_LOAD_ACCELERATION, block, {30, -10, 0}));
  scene.prepare();
  scene.advance(0.02);
  const ogive_body_result body = scene.result(block);
  const ogive_ledger ledger = scene.ledger();
  measured("speed error", std::abs(body.velocity[0] - 0.6));
  EXPECT_NEAR(body.velocity[0], 0.6, 1e-13);   // measured 1e-15
  EXPECT_NEAR(body.velocity[1], -0.2, 1e-13);
  EXPECT_NEAR(ledger.external_impulse[0], body.momentum[0], 1e-13 * body.mass);
  measured("residual", ledger.residual / body.kinetic);
  EXPECT_NEAR(ledger.residual, 0, 1e-10 * body.kinetic);  // measured 2e-14
  EXPECT_NEAR(result(scene, load).work, body.kinetic, 1e-10 * body.kinetic);
}

// A bar that is loaded at its end by p: behind the wave the material moves at p / (rho c) and is stressed by p.
TEST_P(Loads, TractionSendsAWaveOfItsStressAndOfTheSpeedPOverRhoC) {
  const double density = 7.85e-3, E = 200e3, p = 100, c = std::sqrt(E / density);
  Scene scene;
  scene.grid(0.5, {-2, -2, -2}, {42, 2, 2}).numerics(GetParam(), 0.4);
  const ogive_body_id bar =
      scene.box("bar", scene.material("steel", elastic(density, E, 0.0)), {0, -1, -1}, {40, 1, 1}, 0.25, {});
  ogive_load_def def = load_def(OGIVE_LOAD_TRACTION, bar, {p, 0, 0});
  def.area = 4;
  in_box(def, {0, -1, -1}, {0.25, 1, 1});  // the outermost layer of particles
  const ogive_load_id load = add(scene, def);
  scene.prepare();
  scene.advance(30 / c);  // the wave stands at x = 30
  const ogive_body_result body = scene.result(bar);
  measured("momentum by p A t", body.momentum[0] / (p * 4 * 30 / c));
  EXPECT_NEAR(body.momentum[0], p * 4 * 30 / c, 1e-12 * p * 4 * 30 / c);
  const std::vector<double> position = scene.field(bar, "position"), velocity = scene.field(bar, "velocity"),
                            stress = scene.field(bar, "stress");
  double speed = 0, xx = 0;
  int count = 0;
  for (std::size_t i = 0; i < position.size() / 3; ++i)
    if (position[3 * i] > 8 && position[3 * i] < 22) {
      speed += velocity[3 * i];
      xx += stress[6 * i];
      ++count;
    }
  measured("speed by p / (rho c)", speed / count / (p / (density * c)));
  measured("stress by -p", xx / count / -p);
  EXPECT_NEAR(speed / count, p / (density * c), 0.01 * p / (density * c));
  EXPECT_NEAR(xx / count, -p, 0.01 * p);
  const ogive_ledger ledger = scene.ledger();
  measured("residual by work", ledger.residual / result(scene, load).work);
  EXPECT_NEAR(ledger.residual, 0, 0.02 * result(scene, load).work);
}

// Forces that add up to nothing leave the momentum, and turn a block about its axis: torque = dL/dt.
TEST_P(Loads, ForcesOnParticlesGiveTheirImpulseAndTheirMoment) {
  Scene scene;
  scene.grid(1.0, {-6, -6, -6}, {6, 6, 6}).numerics(GetParam(), 0.4, {}, 1, OGIVE_TRANSFER_AFFINE_FLIP);
  const ogive_body_id block = scene.box("block", scene.material("steel", steel()), {-2, -2, -2}, {2, 2, 2}, 0.5, {});
  scene.prepare();
  const std::vector<double> position = scene.field(block, "position"), mass = scene.field(block, "mass");
  std::vector<double> force(position.size());
  double torque = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    force[3 * i] = -100 * mass[i] * position[3 * i + 1];
    force[3 * i + 1] = 100 * mass[i] * position[3 * i];
    torque += position[3 * i] * force[3 * i + 1] - position[3 * i + 1] * force[3 * i];
  }
  scene.check(ogive_field_set(scene.get(), block, "force", force.data(), static_cast<std::int64_t>(force.size())));
  EXPECT_EQ(scene.field(block, "force"), force);
  scene.advance(0.005);
  const std::vector<double> x = scene.field(block, "position"), v = scene.field(block, "velocity"),
                            affine = scene.field(block, "affine_velocity");
  const double momentum = std::abs(scene.result(block).momentum[0]);
  double spin = 0;  // of the centres and of the particles' own fields, whose moment of inertia is m h^2 / 4 an axis
  for (std::size_t i = 0; i < mass.size(); ++i)
    spin += mass[i] * (x[3 * i] * v[3 * i + 1] - x[3 * i + 1] * v[3 * i] + 0.25 * (affine[9 * i + 3] - affine[9 * i + 1]));
  measured("momentum by torque time", momentum / (torque * 0.005));
  measured("angular momentum by torque time", spin / (torque * 0.005));
  EXPECT_LT(momentum, 1e-13 * torque * 0.005);  // measured 2e-17
  EXPECT_NEAR(spin, torque * 0.005, 0.02 * torque * 0.005);

  // Without forces the motion goes on as it is.
  const double before = scene.ledger().external_work;
  std::fill(force.begin(), force.end(), 0.0);
  scene.check(ogive_field_set(scene.get(), block, "force", force.data(), static_cast<std::int64_t>(force.size())));
  scene.steps(5);
  EXPECT_EQ(scene.ledger().external_work, before);
}

// One end is drawn at a steady speed, the other held: the mean strain is that of the ends, the stress E times it, the force on
// both ends the same, the work the stored energy.
TEST_P(Loads, PrescribedVelocityStretchesABarAndReportsTheForceThatItTakes) {
  const double E = 1000, density = 1e-3, speed = 1.0, time = 0.24;  // slow beside the wave (20 mm in 0.02 ms); no particle changes cells
  Scene scene;
  scene.grid(1.0, {-4, -4, -4}, {26, 4, 4}).numerics(GetParam(), 0.4, {}, 1, OGIVE_TRANSFER_AFFINE_FLIP);
  const ogive_body_id bar =
      scene.box("bar", scene.material("soft", elastic(density, E, 0.0)), {0, -2, -2}, {20, 2, 2}, 0.5, {});
  ogive_load_def held = load_def(OGIVE_LOAD_VELOCITY, bar, {0, 0, 0}), drawn = load_def(OGIVE_LOAD_VELOCITY, bar, {0, 0, 0});
  in_box(held, {-3, -4, -4}, {1, 4, 4});
  in_box(drawn, {19, -4, -4}, {26, 4, 4});
  const ogive_load_id hold = add(scene, held), draw = add(scene, drawn);
  scene.prepare();
  // The speed rises over a fifth of the time, so that no wave of note runs.
  const double rise = 0.2 * time;
  while (scene.progress().time < time) {
    const double now = scene.progress().time, part = std::min(1.0, now / rise);
    const double value[3] = {speed * part * part * (3 - 2 * part), 0, 0};
    scene.check(ogive_load_set(scene.get(), draw, value));
    scene.steps(1);
  }
  const double moved = speed * (scene.progress().time - 0.5 * rise), strain = moved / 18;  // between the held nodes
  const double force = E * strain * 16;
  measured("force by E strain A", result(scene, draw).force[0] / force);
  EXPECT_NEAR(result(scene, draw).force[0], force, 0.05 * force);
  EXPECT_NEAR(result(scene, hold).force[0], -force, 0.05 * force);
  const ogive_ledger ledger = scene.ledger();
  measured("held force by E strain A", -result(scene, hold).force[0] / force);
  measured("work of the held end", result(scene, hold).work / ledger.external_work);
  measured("internal by work", ledger.internal / ledger.external_work);
  measured("residual by work", ledger.residual / ledger.external_work);
  EXPECT_NEAR(ledger.residual, 0, 0.02 * ledger.external_work);
  EXPECT_NEAR(result(scene, hold).work, 0, 1e-3 * ledger.external_work);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Loads, testing::Values(OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_SHAPE_GIMP),
                         [](const auto& info) { return shape_name(info.param); });

// A loaded scene with everything that a save must carry.
struct LoadedScene : Scene {
  ogive_body_id left, right;
  ogive_load_id pull;
  explicit LoadedScene(std::int32_t threads = 1) {
    grid(1.0, {-8, -4, -4}, {8, 4, 4}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.4, {}, threads);
    contact(OGIVE_CONTACT_HUANG_SECOND, OGIVE_DETECTION_GAP, 0.2);
    const ogive_material_id material_id = material("steel", steel());
    left = box("left", material_id, {-4, -2, -2}, {0, 2, 2}, 0.5, {40, 3, 0});
    right = box("right", material_id, {0, -2, -2}, {4, 2, 2}, 0.5, {-40, 0, 0});
    ogive_load_def def = load_def(OGIVE_LOAD_TRACTION, right, {-200, 0, 0});
    in_box(def, {3, -2, -2}, {4, 2, 2});
    def.area = 16;
    pull = verification::add(*this, def);
    verification::add(*this, load_def(OGIVE_LOAD_ACCELERATION, {-1}, {0, 0, 50}));
    prepare();
    std::vector<double> force(field(left, "position").size(), 0.01);
    check(ogive_field_set(get(), left, "force", force.data(), static_cast<std::int64_t>(force.size())));
  }
};

TEST(Loads, ThreadsDoNotChangeTheBits) {
  LoadedScene one(1), three(3);
  one.steps(40);
  three.steps(40);
  EXPECT_EQ(one.all_fields(), three.all_fields());
  const ogive_ledger a = one.ledger(), b = three.ledger();
  EXPECT_TRUE(same_bits(&a, &b, sizeof a));
}

TEST(Loads, PairResultsAreTheContactForcesOfTheBodies) {
  LoadedScene scene;
  for (int i = 0; i < 10; ++i) {
    scene.steps(4);
    const ogive_pair_result there = pair(scene, scene.left, scene.right), back = pair(scene, scene.right, scene.left);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(there.force[c], scene.result(scene.left).contact_force[c], 1e-9 * (1 + std::abs(there.force[c])));
      EXPECT_EQ(there.force[c], -back.force[c]);
    }
  }
  const ogive_pair_result total = pair(scene, scene.left, scene.right);
  const ogive_ledger ledger = scene.ledger();
  EXPECT_LT(total.impulse[0], 0);
  EXPECT_GT(total.friction_dissipation, 0);
  EXPECT_NEAR(total.friction_dissipation, ledger.friction_dissipation, 1e-12 * ledger.friction_dissipation);
}

}  // namespace
}  // namespace verification
