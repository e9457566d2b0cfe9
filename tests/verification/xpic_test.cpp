// XPIC(k): k = 1 is PIC, higher orders damp less, momentum and the ledger are kept, partial models and threads as ever.
#include <algorithm>

#include "store.hpp"

using namespace verification;

namespace {

// An elastic block that rings and flies; symmetric about y = 0.
Scene ringing(std::int32_t shape, std::int32_t order, int k, bool half = false, int threads = 1,
              std::int32_t transfer = OGIVE_TRANSFER_XPIC, double pic = 0) {
  Scene scene;
  std::array<std::int32_t, 6> faces{};
  if (half) faces[2] = OGIVE_FACE_SYMMETRY;
  scene.grid(1, {-8, half ? 0.0 : -6.0, -6}, {8, 6, 6}, faces);
  ogive_numerics_def def;
  ogive_numerics_def_init(&def, sizeof def);
  def.shape_function = shape;
  def.transfer = transfer;
  def.update_order = order;
  def.time_step_factor = 0.3;
  def.xpic_order = k;
  def.pic_fraction = pic;
  def.threads = threads;
  scene.check(ogive_world_set_numerics(scene.get(), &def));
  scene.add("block", Scene::body(scene.material("metal", elastic(2.7e-3, 69e3, 0.3)), {3, 0, 2}),
            Scene::solid(OGIVE_SOLID_BOX, {0, 0, 0}, {8, 4, 4}, 0.5));
  scene.prepare();
  std::vector<double> v = scene.field({0}, "velocity"), x = scene.field({0}, "position");
  for (std::size_t p = 0; p < v.size() / 3; ++p) v[3 * p] += 2 * std::sin(x[3 * p] * M_PI / 8);
  scene.check(ogive_field_set(scene.get(), {0}, "velocity", v.data(), static_cast<std::int64_t>(v.size())));
  return scene;
}

double largest_difference(const Scene& a, const Scene& b) {
  const std::vector<double> v = a.field({0}, "velocity"), w = b.field({0}, "velocity");
  double worst = 0;
  for (std::size_t i = 0; i < v.size(); ++i) worst = std::max(worst, std::abs(v[i] - w[i]));
  return worst;
}

class Xpic : public testing::TestWithParam<std::int32_t> {};

}  // namespace

TEST_P(Xpic, OfFirstOrderIsPic) {
  for (const std::int32_t order : {OGIVE_UPDATE_STRESS_FIRST, OGIVE_UPDATE_STRESS_LAST}) {
    Scene one = ringing(GetParam(), order, 1), pic = ringing(GetParam(), order, 1, false, 1, OGIVE_TRANSFER_FLIP, 1);
    one.steps(50);
    pic.steps(50);
    measured("difference", largest_difference(one, pic));
    EXPECT_LE(largest_difference(one, pic), 1e-11);
    EXPECT_NEAR(one.ledger().transfer_dissipation, pic.ledger().transfer_dissipation, 1e-10 * pic.ledger().kinetic);
  }
}

TEST_P(Xpic, OfHigherOrderDampsLessAndKeepsMomentum) {
  double before = 1.05;  // measured 1.017, 1.019 with k = 1: all of the motion within the block
  for (const int k : {1, 2, 3, 5, 10}) {
    Scene scene = ringing(GetParam(), OGIVE_UPDATE_STRESS_FIRST, k);
    const ogive_ledger start = scene.ledger();
    scene.steps(150);
    const ogive_ledger end = scene.ledger();
    const double fixed = 0.5 * start.mass * 13, lost = end.transfer_dissipation / (start.kinetic - fixed);
    measured("lost_" + std::to_string(k), lost);
    measured("residual_" + std::to_string(k), (end.total - start.total) / (start.kinetic - fixed));
    EXPECT_LT(lost, before);
    EXPECT_GT(lost, 0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(end.momentum[c], start.momentum[c], 1e-12 * start.mass * 5);
    // What stays unexplained is the second-order error of stress first. Measured at most 0.059, k = 2.
    EXPECT_LE(std::abs(end.total - start.total), 0.07 * (start.kinetic - fixed));
    before = lost;
  }
}

TEST_P(Xpic, LeavesFlightAlone) {
  Scene scene;
  scene.grid(1, {-8, -6, -6}, {8, 6, 6}).numerics(GetParam(), 0.4, {}, 1, OGIVE_TRANSFER_XPIC, OGIVE_UPDATE_STRESS_FIRST, {}, 4);
  scene.box("block", scene.material("metal", elastic(2.7e-3, 69e3, 0.3)), {-2, -2, -2}, {2, 2, 2}, 0.5, {30, -7, 1});
  scene.prepare();
  scene.steps(60);
  const std::vector<double> v = scene.field({0}, "velocity");
  double worst = 0;
  for (std::size_t p = 0; p < v.size() / 3; ++p)
    worst = std::max({worst, std::abs(v[3 * p] - 30), std::abs(v[3 * p + 1] + 7), std::abs(v[3 * p + 2] - 1)});
  EXPECT_LE(worst, 1e-11);
}

TEST_P(Xpic, OfAHalfModelIsThatOfTheFullOneAndThreadsDoNotMatter) {
  Scene whole = ringing(GetParam(), OGIVE_UPDATE_STRESS_FIRST, 4), half = ringing(GetParam(), OGIVE_UPDATE_STRESS_FIRST, 4, true),
        threads = ringing(GetParam(), OGIVE_UPDATE_STRESS_FIRST, 4, false, 2);
  whole.steps(60);
  half.steps(60);
  threads.steps(60);
  expect_same_bits(whole, threads);
  measured("kinetic", half.ledger().kinetic * 2 / whole.ledger().kinetic - 1);
  EXPECT_NEAR(half.ledger().kinetic * 2, whole.ledger().kinetic, 1e-11 * whole.ledger().kinetic);
  EXPECT_NEAR(half.ledger().internal * 2, whole.ledger().internal, 1e-10 * whole.ledger().internal);
}

INSTANTIATE_TEST_SUITE_P(Transfer, Xpic, testing::Values(OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_SHAPE_GIMP),
                         [](const auto& info) { return shape_name(info.param); });
