// Contact exchanges momentum and makes none.
#include <algorithm>
#include <tuple>

#include "scene.hpp"

using namespace verification;

namespace {

struct Total {
  Vec3 sum{};
  double scale = 0;  // sum of m |v|
};

Total momentum_of(const Scene& scene) {
  Total total;
  for (std::int32_t b = 0; b < ogive_body_count(scene.get()); ++b) {
    const std::vector<double> mass = scene.field({b}, "mass"), v = scene.field({b}, "velocity");
    for (std::size_t p = 0; p < mass.size(); ++p) {
      for (int c = 0; c < 3; ++c) total.sum[c] += mass[p] * v[3 * p + c];
      total.scale += mass[p] * std::sqrt(v[3 * p] * v[3 * p] + v[3 * p + 1] * v[3 * p + 1] + v[3 * p + 2] * v[3 * p + 2]);
    }
  }
  return total;
}

double drift(const Total& before, const Total& after) {
  double worst = 0;
  for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(after.sum[c] - before.sum[c]));
  return worst / before.scale;
}

// method, detection, shape function, friction, normal
using Choice = std::tuple<std::int32_t, std::int32_t, std::int32_t, double, std::int32_t>;

class Momentum : public testing::TestWithParam<Choice> {};

std::string name_of(const testing::TestParamInfo<Choice>& info) {
  const auto [method, detection, shape, friction, normal] = info.param;
  return std::string(method == OGIVE_CONTACT_HUANG_FIRST ? "First" : "Second") +
         (detection == OGIVE_DETECTION_GAP ? "Gap" : "SharedNode") + shape_name(shape) +
         (friction > 0 ? "Friction" : "Smooth") + (normal == OGIVE_NORMAL_AVERAGE ? "Average" : "Master");
}

}  // namespace

TEST_P(Momentum, OfTwoCubesOfUnequalDensityThatCollideObliquelyIsKept) {
  const auto [method, detection, shape, friction, normal] = GetParam();
  Scene scene;
  scene.grid(1, {-12, -8, -8}, {12, 8, 8}).numerics(shape, 0.5).contact(method, detection, friction, normal);
  const ogive_material_id light = scene.material("light", elastic(2.7e-3, 69e3, 0.3));
  const ogive_material_id heavy = scene.material("heavy", steel());
  const ogive_body_id a = scene.box("a", light, {-4.2, -2, -2}, {-0.2, 2, 2}, 0.5, {30, 8, -3});
  scene.box("b", heavy, {0.1, -1.7, -2.3}, {4.1, 2.3, 1.7}, 0.5, {-20, 1, 4});
  scene.prepare();
  const Total before = momentum_of(scene);
  const Vec3 first = {scene.result(a).momentum[0], scene.result(a).momentum[1], scene.result(a).momentum[2]};
  scene.steps(250);
  const double relative = drift(before, momentum_of(scene));
  const double exchanged = std::abs(scene.result(a).momentum[0] - first[0]) / std::abs(first[0]);
  measured("relative_drift", relative);
  measured("exchanged", exchanged);
  EXPECT_GT(exchanged, 0.5);  // they did collide
  EXPECT_LE(relative, 1e-13);  // measured at most 5.5e-15
}

INSTANTIATE_TEST_SUITE_P(Contact, Momentum,
                         testing::Combine(testing::Values(OGIVE_CONTACT_HUANG_FIRST, OGIVE_CONTACT_HUANG_SECOND),
                                          testing::Values(OGIVE_DETECTION_SHARED_NODE, OGIVE_DETECTION_GAP),
                                          testing::Values(OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_SHAPE_GIMP),
                                          testing::Values(0.0, 0.3),
                                          testing::Values(OGIVE_NORMAL_AVERAGE, OGIVE_NORMAL_MASTER)),
                         name_of);

namespace {

// Three blocks that close on the node at the origin, added in the given order. Results by name.
std::map<std::string, std::vector<double>> three_bodies(std::int32_t shape, std::array<int, 3> order, double* relative) {
  Scene scene;
  scene.grid(1, {-9, -9, -6}, {9, 9, 6}).numerics(shape, 0.5).contact(OGIVE_CONTACT_HUANG_SECOND, OGIVE_DETECTION_GAP, 0.2);
  const ogive_material_id light = scene.material("light", elastic(2.7e-3, 69e3, 0.3));
  const ogive_material_id heavy = scene.material("heavy", steel());
  for (int body : order) {
    if (body == 0) scene.box("left", light, {-4, 0.25, -2}, {0, 4.25, 2}, 0.5, {5, -30, 0});
    if (body == 1) scene.box("right", heavy, {0.25, 0.25, -2}, {4.25, 4.25, 2}, 0.5, {-20, -30, 3});
    if (body == 2) scene.box("below", light, {-2, -4.25, -2}, {2, -0.25, 2}, 0.5, {0, 40, 0});
  }
  scene.prepare();
  const Total before = momentum_of(scene);
  scene.steps(150);
  if (relative) *relative = drift(before, momentum_of(scene));
  return scene.all_fields();
}

}  // namespace

class ThreeBodies : public testing::TestWithParam<std::int32_t> {};

TEST_P(ThreeBodies, ThatMeetAtANodeKeepTheirMomentumWhateverTheirOrder) {
  double relative = 0, of_order = 0;
  const auto reference = three_bodies(GetParam(), {0, 1, 2}, &relative);
  measured("relative_drift", relative);
  EXPECT_LE(relative, 1e-13);  // measured at most 5.5e-15
  std::array<int, 3> order = {0, 1, 2};
  double moved = 0;
  for (double v : reference.at("below/velocity")) moved = std::max(moved, std::abs(v - 40));
  EXPECT_GT(moved, 5);  // it was struck
  while (std::next_permutation(order.begin(), order.end())) {
    const auto other = three_bodies(GetParam(), order, nullptr);
    for (const char* body : {"left", "right", "below"}) {
      const std::vector<double>&a = reference.at(std::string(body) + "/velocity"),
          &b = other.at(std::string(body) + "/velocity");
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i) of_order = std::max(of_order, std::abs(a[i] - b[i]) / 40.0);
    }
  }
  measured("difference_between_orders", of_order);
  EXPECT_LE(of_order, 1e-14);  // measured 0
}

INSTANTIATE_TEST_SUITE_P(Contact, ThreeBodies,
                         testing::Values(OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_SHAPE_GIMP),
                         [](const auto& info) { return shape_name(info.param); });
