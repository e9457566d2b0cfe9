// A half model behind a symmetry face and a quarter behind two are the full model.
#include <algorithm>
#include <tuple>

#include "impact.hpp"

using namespace verification;

namespace {

// Largest difference between the particles of the part and the same ones of the whole, over the field's largest value.
double difference(const Scene& whole, const Scene& part, ogive_body_id body, const char* field, int components) {
  const std::vector<double> a = whole.field(body, field), b = part.field(body, field);
  const std::vector<double> number_a = whole.field(body, "number"), number_b = part.field(body, "number");
  std::map<double, std::size_t> place;
  for (std::size_t i = 0; i < number_a.size(); ++i) place[number_a[i]] = i;
  double worst = 0;
  for (std::size_t i = 0; i < number_b.size(); ++i) {
    const auto match = place.find(number_b[i]);
    if (match == place.end()) return INFINITY;
    for (int c = 0; c < components; ++c) {
      const double d = std::abs(a[match->second * components + c] - b[i * components + c]);
      worst = std::isfinite(d) ? std::max(worst, d) : INFINITY;
    }
  }
  return worst / maximum(a);
}

void expect_same(const Scene& whole, const Scene& part, int share, double tolerance) {
  const ogive_body_id ball{0}, plate{1};
  // The case is a violent one: the plate has yielded and failed, and is hot.
  EXPECT_GT(whole.result(plate).failed_particles, 50);
  EXPECT_GT(whole.result(plate).maximum_temperature, 310);
  EXPECT_LT(whole.result(ball).speed, 399);
  measured("failed_particles", static_cast<double>(whole.result(plate).failed_particles));
  EXPECT_EQ(whole.result(plate).failed_particles, share * part.result(plate).failed_particles);
  for (const ogive_body_id body : {ball, plate}) {
    const std::string prefix = body.index == 0 ? "ball_" : "plate_";
    EXPECT_EQ(whole.result(body).particles, share * part.result(body).particles);
    for (const auto& [field, components] :
         {std::pair{"position", 3}, std::pair{"velocity", 3}, std::pair{"stress", 6}, std::pair{"energy", 1}}) {
      const double d = difference(whole, part, body, field, components);
      measured(prefix + field, d);
      EXPECT_LE(d, tolerance) << prefix + field;
    }
  }
  const double plastic = difference(whole, part, plate, "plastic_strain", 1);
  measured("plate_plastic_strain", plastic);
  EXPECT_LE(plastic, tolerance);
  EXPECT_NEAR(whole.ledger().total / (share * part.ledger().total), 1, tolerance);
  EXPECT_NEAR(whole.ledger().residual / (share * part.ledger().total), part.ledger().residual / part.ledger().total,
              tolerance);
}

using Choice = std::tuple<std::int32_t, std::int32_t>;
std::string name_of(const testing::TestParamInfo<Choice>& info) {
  const char* methods[] = {"SingleField", "First", "Second"};
  return shape_name(std::get<0>(info.param)) +
         methods[std::get<1>(info.param)];
}

// Hardening is linear: with an exponent below 1 its slope is infinite at first yield, which turns round-off of 1e-16 into a
// yield stress that differs by 1e-6.
constexpr double linear = 1;

class PartialModel : public testing::TestWithParam<Choice> {};

// Each model takes its own stable time step: they are the same.
void run(Scene& whole, Scene& part) {
  for (int i = 0; i < 80; ++i) {
    EXPECT_NEAR(whole.stable_time_step() / part.stable_time_step(), 1, 1e-9);
    whole.steps(1);
    part.steps(1);
  }
}

}  // namespace

TEST_P(PartialModel, HalfOfAnOffCentreImpactIsTheFullModel) {
  Impact impact{.shape = std::get<0>(GetParam()), .method = std::get<1>(GetParam()), .off_centre = 1.5, .hardening_exponent = linear};
  Scene whole = impact.build();
  impact.half_y = true;
  Scene half = impact.build();
  run(whole, half);
  expect_same(whole, half, 2, 1e-12);  // measured at most 5.2e-14 (stress; all shape functions and methods)
}

TEST_P(PartialModel, QuarterOfACentralImpactIsTheFullModel) {
  Impact impact{.shape = std::get<0>(GetParam()), .method = std::get<1>(GetParam()), .hardening_exponent = linear};
  Scene whole = impact.build();
  impact.half_x = impact.half_y = true;
  Scene quarter = impact.build();
  run(whole, quarter);
  expect_same(whole, quarter, 4, 1e-12);  // measured at most 5.2e-14 (stress; all shape functions and methods)
}

INSTANTIATE_TEST_SUITE_P(Symmetry, PartialModel,
                         testing::Combine(testing::Values(OGIVE_SHAPE_LINEAR, OGIVE_SHAPE_QUADRATIC_BSPLINE, OGIVE_SHAPE_GIMP),
                                          testing::Values(OGIVE_CONTACT_SINGLE_FIELD, OGIVE_CONTACT_HUANG_FIRST,
                                                          OGIVE_CONTACT_HUANG_SECOND)),
                         name_of);
