// Contact at one node, computed by hand: what methods decide, what the solver does with it, and normals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/contact.hpp"
#include "contact/method.hpp"
#include "contact/normal.hpp"
#include "contact/occupied.hpp"

using namespace ogive;

namespace {

struct NodalBody {  // what one body brings to the node
  double mass;
  Vector3 velocity;
  bool fixed = false;
};

// One node; every pair of `pairs` (a, b, normal out of a) is held by the same constraint.
struct Node {
  BlockContacts contacts;
  ContactNode node;

  Node(const std::vector<NodalBody>& bodies, const std::vector<std::tuple<int, int, Vector3>>& pairs, Constraint constraint,
       double friction = 0) {
    for (const NodalBody& body : bodies) {
      ContactField field;
      field.slot = static_cast<std::int32_t>(contacts.fields.size());
      field.mass = body.mass;
      field.fixed = body.fixed;
      field.before = field.velocity = body.velocity;
      contacts.fields.push_back(field);
    }
    for (const auto& [a, b, normal] : pairs) {
      ContactPair pair;
      pair.a = a;
      pair.b = b;
      pair.normal = normal;
      pair.friction = friction;
      pair.constraint = constraint;
      ++contacts.fields[a].acting;
      ++contacts.fields[b].acting;
      contacts.pairs.push_back(pair);
    }
    node.fields = static_cast<std::int32_t>(bodies.size());
    node.pairs = static_cast<std::int32_t>(pairs.size());
    solve_node(contacts, node, {});
  }
  const Vector3& velocity(int body) const { return contacts.fields[body].velocity; }
  Vector3 momentum() const {
    Vector3 sum{};
    for (const ContactField& f : contacts.fields) add(sum, times(f.mass, f.velocity));
    return sum;
  }
};

void expect_near(const Vector3& a, const Vector3& b, double tolerance = 1e-14) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance);
}

const Vector3 x = {1, 0, 0};
const std::vector<NodalBody> approaching = {{1, {2, 1, 0}}, {3, {-2, 0, 0}}};
const std::vector<NodalBody> departing = {{1, {-2, 1, 0}}, {3, {2, 0, 0}}};
const Constraint contact = {Hold::Contact, 0, true}, slide = {Hold::Slide, 0, false}, stick = {Hold::Stick, 0, false};

PairView view(const Vector3& v) {
  return {x, {x, {-1, 0, 0}}, v, v, v, false, 0};
}

}  // namespace

TEST(ContactNode, ApproachingBodiesGetOneNormalVelocityAndKeepTheirSlip) {
  // Reduced mass 3/4, approach 4, impulse 3.
  const Node node(approaching, {{0, 1, x}}, contact);
  expect_near(node.velocity(0), {-1, 1, 0});
  expect_near(node.velocity(1), {-1, 0, 0});
  EXPECT_NEAR(node.contacts.pairs[0].normal_impulse, 3, 1e-14);
}

TEST(ContactNode, FrictionIsCoulombsPartOfThePushOrWhatStopsTheSlip) {
  const Node slips(approaching, {{0, 1, x}}, contact, 0.1);  // 0.1 x 3 against the slip
  expect_near(slips.velocity(0), {-1, 0.7, 0});
  expect_near(slips.velocity(1), {-1, 0.1, 0});
  const Node sticks(approaching, {{0, 1, x}}, contact, 0.5);  // 3/4 x 1 stops it
  expect_near(sticks.velocity(0), {-1, 0.25, 0});
  expect_near(sticks.velocity(1), {-1, 0.25, 0});
}

TEST(ContactNode, DepartingBodiesAreLeftAloneByAPushButNotByASlide) {
  const Node free(departing, {{0, 1, x}}, contact, 0.5);
  expect_near(free.velocity(0), {-2, 1, 0});
  expect_near(free.velocity(1), {2, 0, 0});
  const Node held(departing, {{0, 1, x}}, slide);
  expect_near(held.velocity(0), {1, 1, 0});
  expect_near(held.velocity(1), {1, 0, 0});
}

TEST(ContactNode, StickingBodiesMoveWithTheirCentreOfMass) {
  for (const auto& bodies : {approaching, departing}) {
    const Node node(bodies, {{0, 1, x}}, stick);
    const Vector3 centre = times(0.25, node.momentum());
    expect_near(node.velocity(0), centre);
    expect_near(node.velocity(1), centre);
  }
  const Node without_normal(approaching, {{0, 1, {}}}, stick);
  expect_near(without_normal.velocity(0), {-1, 0.25, 0});
}

TEST(ContactNode, ABodyOfInfiniteMassStaysAsItIs) {
  const Node node({{1, {2, 1, 0}}, {3, {-2, 0, 0}, true}}, {{0, 1, x}}, contact, 0.2);
  expect_near(node.velocity(0), {-2, 0.2, 0});  // impulse 4, friction 0.8
  expect_near(node.velocity(1), {-2, 0, 0});
}

TEST(ContactNode, ATargetLeavesTheDepartureThatItNames) {
  // Pan: they departed at 1 when the step began, their forces would make it an approach of 4.
  const Node node(approaching, {{0, 1, x}}, {Hold::Contact, -1, false});
  EXPECT_NEAR(node.velocity(0)[0] - node.velocity(1)[0], -1, 1e-14);
  EXPECT_NEAR(node.contacts.pairs[0].normal_impulse, 3.75, 1e-14);
}

TEST(ContactNode, AChainOfThreeKeepsMomentumDoesNotInterpenetrateAndGainsNoEnergyInAnyOrder) {
  const NodalBody bodies[] = {{1, {3, 0, 0}}, {2, {1, 0.5, 0}}, {0.5, {-4, 0, 1}}};
  std::array<int, 3> order = {0, 1, 2};
  std::vector<Vector3> reference;
  do {
    std::vector<NodalBody> given(3);
    for (int i = 0; i < 3; ++i) given[order[i]] = bodies[i];
    const auto pair = [&](int a, int b) {
      return order[a] < order[b] ? std::tuple{order[a], order[b], x} : std::tuple{order[b], order[a], Vector3{-1, 0, 0}};
    };
    const Node node(given, {pair(0, 1), pair(1, 2)}, contact, 0.3);
    std::vector<Vector3> v;
    for (int i = 0; i < 3; ++i) v.push_back(node.velocity(order[i]));
    expect_near(node.momentum(), {3, 1, 0.5});
    EXPECT_LE(v[0][0] - v[1][0], 1e-9);
    EXPECT_LE(v[1][0] - v[2][0], 1e-9);
    double before = 0, after = 0;
    for (int i = 0; i < 3; ++i) {
      before += bodies[i].mass * dot(bodies[i].velocity, bodies[i].velocity);
      after += bodies[i].mass * dot(v[i], v[i]);
    }
    EXPECT_LT(after, before);
    if (reference.empty()) reference = v;
    for (int i = 0; i < 3; ++i) expect_near(v[i], reference[i], 1e-13);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(ContactMethod, EachIsFoundByItsNameAndPlace) {
  const char* const names[] = {"single_field", "huang_first",      "huang_second",     "york",
                               "hu_chen",      "bardenhagen_2000", "bardenhagen_2001", "pan_2008", "persistent"};
  ASSERT_EQ(contact_method_count(), 9);
  for (int i = 0; i < 9; ++i) EXPECT_STREQ(contact_method(static_cast<ContactMethod>(i)).name, names[i]);
}

TEST(ContactMethod, YorkSticksWhileApproachingAndLetsGoWhileDeparting) {
  const ContactMethodDef& york = contact_method(ContactMethod::York);
  EXPECT_EQ(york.at_start(view({1, 5, 0})).hold, Hold::Stick);
  EXPECT_EQ(york.at_start(view({-1, 5, 0})).hold, Hold::Nothing);
  // One decision a step: forces within the step do not change it.
  PairView turned = view({1, 0, 0});
  turned.now = {-1, 0, 0};
  EXPECT_EQ(york.at_end(turned).hold, Hold::Stick);
}

TEST(ContactMethod, HuAndChenHoldTheNormalVelocityAlways) {
  const ContactMethodDef& method = contact_method(ContactMethod::HuChen);
  EXPECT_EQ(method.at_start(view({-1, 0, 0})).hold, Hold::Slide);
  EXPECT_EQ(method.at_end(view({1, 0, 0})).hold, Hold::Slide);
  EXPECT_FALSE(method.has_friction);
}

TEST(ContactMethod, Bardenhagen2000AsksBothBodiesByTheirOwnNormals) {
  const ContactMethodDef& method = contact_method(ContactMethod::Bardenhagen2000);
  EXPECT_EQ(method.at_end(view({1, 0, 0})).hold, Hold::Contact);
  EXPECT_EQ(method.at_end(view({-1, 0, 0})).hold, Hold::Nothing);
  PairView oblique = view({0.1, 1, 0});
  oblique.own_normal[1] = {-0.6, 0.8, 0};  // by this normal the second body finds that they part
  EXPECT_EQ(method.at_end(oblique).hold, Hold::Nothing);
}

TEST(ContactMethod, Bardenhagen2001ReleasesOnlyWhereTheTractionPulls) {
  const ContactMethodDef& method = contact_method(ContactMethod::Bardenhagen2001);
  PairView parting = view({-1, 0, 0});
  parting.normal_stress = -5;
  EXPECT_EQ(method.at_end(parting).hold, Hold::Slide);
  parting.normal_stress = 5;
  EXPECT_EQ(method.at_end(parting).hold, Hold::Nothing);
  EXPECT_EQ(method.at_end(view({1, 0, 0})).hold, Hold::Contact);
}

TEST(ContactMethod, PanPersistsWhileTheForcePushes) {
  const ContactMethodDef& method = contact_method(ContactMethod::Pan2008);
  PairView parting = view({-1, 0, 0});
  EXPECT_EQ(method.at_end(parting).hold, Hold::Nothing);
  parting.pressed = true;
  const Constraint held = method.at_end(parting);
  EXPECT_EQ(held.hold, Hold::Contact);
  EXPECT_EQ(held.target, -1);  // equal normal accelerations: the departure goes on as it was
  EXPECT_EQ(method.at_start(parting).hold, Hold::Nothing);
}

TEST(ContactMethod, PersistentShowsTheStrainOneNormalVelocityWhilePressedAndOnlyPushes) {
  const ContactMethodDef& method = contact_method(ContactMethod::Persistent);
  PairView parting = view({-1, 0, 0});
  EXPECT_EQ(method.at_start(parting).hold, Hold::Contact);
  parting.pressed = true;
  EXPECT_EQ(method.at_start(parting).hold, Hold::Slide);
  EXPECT_EQ(method.at_end(parting).hold, Hold::Contact);
  EXPECT_EQ(method.at_end(parting).target, 0);
  EXPECT_FALSE(method.start_reaches_particles);
}

TEST(ContactNormal, AverageWeighsUnitNormalsAndTheVolumeGradientWeighsVolumes) {
  ContactField a, b;
  a.gradient = {3, 0, 0};
  a.outward = x;
  b.gradient = {0, -4, 0};
  b.outward = {0, -1, 0};
  const NormalView view{a, b, false, nullptr, {}};
  Vector3 n;
  ASSERT_TRUE(pair_normal(NormalRule::Average, view, n));
  expect_near(n, {std::sqrt(0.5), std::sqrt(0.5), 0});
  ASSERT_TRUE(pair_normal(NormalRule::VolumeGradient, view, n));
  expect_near(n, {0.6, 0.8, 0});
  ASSERT_TRUE(pair_normal(NormalRule::Master, view, n));
  expect_near(n, x);
  const NormalView of_second{a, b, true, nullptr, {}};
  ASSERT_TRUE(pair_normal(NormalRule::Master, of_second, n));
  expect_near(n, {0, 1, 0});
}

TEST(ContactNormal, WhereUnitNormalsCancelTheLargerBodySaysAndWhereNothingPointsThereIsNone) {
  ContactField a, b;
  a.gradient = {3, 0, 0};
  b.gradient = {1, 0, 0};
  a.outward = b.outward = x;
  Vector3 n;
  ASSERT_TRUE(pair_normal(NormalRule::Average, {a, b, false, nullptr, {}}, n));
  expect_near(n, x);
  EXPECT_FALSE(pair_normal(NormalRule::OccupiedCell, {ContactField{}, ContactField{}, false, nullptr, {}}, n));
}

TEST(ContactNormal, OccupiedCellsBelowAndAboveGiveTheGridAxis) {
  ContactField a, b;
  a.occupied = {0, 0, 4};   // the four cells below the node
  b.occupied = {0, 0, -4};  // those above
  Vector3 n;
  ASSERT_TRUE(pair_normal(NormalRule::OccupiedCell, {a, b, false, nullptr, {}}, n));
  expect_near(n, {0, 0, 1});
  EXPECT_EQ(mirrored_cells(0b00000001, 0), 0b00000010);
  EXPECT_EQ(mirrored_cells(0b00000011, 2), 0b00110000);
}

TEST(ContactNormal, LogisticRegressionFindsThePlaneBetweenTwoClouds) {
  Vector3 plane = {0.3, -0.5, 0.8};
  make_unit(plane);
  NearbyParticles cloud;
  cloud.reach = 1.5;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) {
        const Vector3 p = {1.25 + 0.5 * i - 0.75, 1.25 + 0.5 * j - 0.75, 1.25 + 0.5 * k - 0.75};
        const double side = dot(minus(p, {1.6, 1.7, 1.75}), plane);
        if (std::abs(side) > 0.1) cloud.add({p, side < 0 ? 4 : 7});
      }
  cloud.sort();
  ContactField a, b;
  a.body = 4;
  b.body = 7;
  const auto normal_at = [&](const Vector3& node, const ContactField& first, const ContactField& second) {
    Vector3 n;
    EXPECT_TRUE(pair_normal(NormalRule::LogisticRegression, {first, second, false, &cloud, node}, n));
    return n;
  };
  const Vector3 n = normal_at({2, 2, 2}, a, b);
  const double degrees = std::acos(std::min(1.0, dot(n, plane))) * 180 / M_PI;
  RecordProperty("degrees", std::to_string(degrees));
  EXPECT_LE(degrees, 4) << degrees;
  // The other way round it is the opposite normal.
  expect_near(normal_at({2, 2, 2}, b, a), times(-1, n), 1e-10);
}
