// A run may end when the exchange of energy has ended, and never while what is to meet still flies.
#include <cstdint>

#include "scene.hpp"
#include "store.hpp"

using namespace verification;

namespace {

constexpr double window = 0.05;  // ms; shorter than the flight, about as long as the collision

/// Two soft elastic balls of radius 3, one gap apart, of which the first flies towards the other at 10 m/s.
struct Balls {
  double gap = 1, tolerance = 0.1;  // the balls go on ringing with some hundredths of the energy
  double aside = 0;  // of the second; beyond 6 they miss each other
  bool third = false;  // one far from them, which flies up
  double top = 10;     // of the domain
  Vec3 gravity{};
  bool rigid = false;
  std::int32_t threads = 1;

  Scene build() const {
    Scene scene;
    scene.grid(1, {-20, -10, -10}, {20, 20, top});
    scene.numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5, gravity, threads, {}, OGIVE_UPDATE_STRESS_FIRST, 1e-3);
    const ogive_material_id soft = scene.material("soft", elastic(2.7e-3, 690, 0.3));
    const auto add = [&](const char* name, Vec3 centre, Vec3 velocity) {
      const std::int32_t formulation = rigid ? OGIVE_FORMULATION_RIGID_FREE : OGIVE_FORMULATION_DEFORMABLE;
      scene.add(name, Scene::rigid(soft, formulation, velocity), Scene::solid(OGIVE_SOLID_SPHERE, centre, {3, 0, 0}, 0.5));
    };
    add("first", {-3 - gap, 0, 0}, {10, 0, 0});
    add("second", {3, aside, 0}, {0, 0, 0});
    if (third) add("third", {0, 12, 3}, {0, 0, 20});
    ogive_stop_def def;
    ogive_stop_def_init(&def, sizeof def);
    def.exchange_window = window;
    def.exchange_tolerance = tolerance;
    scene.check(ogive_world_set_stop(scene.get(), &def));
    scene.prepare();
    return scene;
  }
};

constexpr ogive_body_id first{0}, second{1};

bool pushing(const Scene& scene) {
  ogive_pair_result pair{};
  pair.struct_size = sizeof pair;
  scene.check(ogive_pair_result_get(scene.get(), first, second, &pair));
  return pair.force[0] != 0 || pair.force[1] != 0 || pair.force[2] != 0;
}

struct Course {
  double first_push = -1, last_push = -1, end = -1;
  std::int64_t steps = 0;
};

Course run(Scene& scene, int most) {
  Course course;
  for (int i = 0; i < most && scene.progress().stop == OGIVE_STOP_NONE; ++i) {
    scene.steps(1);
    if (!pushing(scene)) continue;
    course.last_push = scene.progress().time;
    if (course.first_push < 0) course.first_push = course.last_push;
  }
  course.steps = scene.progress().steps;
  if (scene.progress().stop != OGIVE_STOP_NONE) course.end = scene.progress().time;
  return course;
}

}  // namespace

TEST(ExchangeStop, TwoElasticBallsEndTheRunOnceTheyHavePartedNotBefore) {
  Scene scene = Balls{}.build();
  const Course course = run(scene, 2000);
  measured("first_push", course.first_push);
  measured("last_push", course.last_push);
  measured("end", course.end);
  EXPECT_EQ(scene.progress().stop, OGIVE_STOP_EXCHANGE_ENDED);
  EXPECT_GT(course.first_push, window);  // the flight took longer than the window
  EXPECT_FALSE(pushing(scene));
  EXPECT_GT(course.end, course.last_push);
  EXPECT_LT(course.end, course.last_push + 2 * window);
  EXPECT_GT(scene.result(second).velocity[0], scene.result(first).velocity[0] + 5);
  // What advances to an end time stops likewise and stays there.
  Scene advanced = Balls{}.build();
  advanced.advance(10);
  EXPECT_EQ(advanced.progress().steps, course.steps);
  advanced.advance(10);
  EXPECT_EQ(advanced.progress().steps, course.steps);
}

TEST(ExchangeStop, BallsThatFlyPastEachOtherNeverEndIt) {
  Scene scene = Balls{.tolerance = 0.001, .aside = 12}.build();
  EXPECT_EQ(run(scene, 600).end, -1);
  EXPECT_GT(scene.progress().time, 5 * window);
}

TEST(ExchangeStop, GravityThatMovesWhatFliesIsNoExchange) {
  // It adds 2 % to the energy of the balls, at first by less than the tolerance within a window and later by more.
  Scene scene = Balls{.tolerance = 0.001, .aside = 12, .gravity = {0, 0, -2}}.build();
  EXPECT_EQ(run(scene, 600).end, -1);
  EXPECT_GT(scene.ledger().kinetic, 1.01 * scene.ledger().initial_total);
}

TEST(ExchangeStop, ItEndsAfterTheCollisionUnderGravityToo) {
  Scene scene = Balls{.gravity = {0, 0, -1}}.build();
  const Course course = run(scene, 2000);
  EXPECT_EQ(scene.progress().stop, OGIVE_STOP_EXCHANGE_ENDED);
  EXPECT_GT(course.end, course.last_push);
}

TEST(ExchangeStop, RigidBallsEndItThoughNothingIsStoredOrDissipatedInThem) {
  Scene scene = Balls{.rigid = true}.build();
  const Course course = run(scene, 2000);
  measured("last_push", course.last_push);
  measured("end", course.end);
  EXPECT_EQ(scene.progress().stop, OGIVE_STOP_EXCHANGE_ENDED);
  EXPECT_GT(course.first_push, window);
  EXPECT_GT(course.end, course.first_push + window);
}

TEST(ExchangeStop, WhatLeavesTheDomainIsNoExchange) {
  // A third ball, which meets nothing, leaves by the near face all the time that the window runs, with more than the tolerance of
  // the energy.
  Scene far = Balls{.tolerance = 0.02, .third = true, .top = 20}.build(), near = Balls{.tolerance = 0.02, .third = true}.build();
  const Course course = run(far, 2000), same = run(near, 2000);
  measured("end", course.end);
  EXPECT_EQ(far.result({2}).left_domain, 0);
  EXPECT_GT(near.ledger().left_domain_energy, 0.02 * near.ledger().initial_total);
  EXPECT_GT(course.end, 0);
  EXPECT_EQ(same.steps, course.steps);
}

TEST(ExchangeStop, VelocitiesThatTheHostSetsAreNoExchange) {
  Scene scene = Balls{.tolerance = 0.001, .aside = 12}.build();
  scene.steps(10);
  std::vector<double> velocity = scene.field(first, "velocity");
  for (std::size_t i = 0; i < velocity.size(); i += 3) velocity[i] = 20;
  scene.set_field(first, "velocity", velocity);
  EXPECT_EQ(run(scene, 400).end, -1);
}

TEST(ExchangeStop, ItIsTheSameForEachNumberOfThreadsAndAcrossARestart) {
  Scene one = Balls{}.build(), two = Balls{.threads = 2}.build();
  const Course course = run(one, 2000);
  EXPECT_EQ(run(two, 2000).steps, course.steps);
  expect_same_bits(one, two);
  // In flight, in the collision, while the window runs.
  for (const std::int64_t interruption : {std::int64_t{35}, course.steps / 2, course.steps - 15}) {
    Scene part = Balls{}.build(), rest;
    part.steps(static_cast<int>(interruption));
    Store store;
    store.save(part);
    store.load(rest);
    EXPECT_EQ(run(rest, 2000).steps, course.steps);
    EXPECT_EQ(rest.progress().stop, OGIVE_STOP_EXCHANGE_ENDED);
    expect_same_bits(one, rest);
  }
}

TEST(ExchangeStop, ASaveOfVersion3GoesOnToTheSameBits) {
  // Version 4 brought the conditions of this file and debris; without them a save of version 3 holds the same.
  Scene whole, part, rest;
  for (Scene* scene : {&whole, &part}) {
    *scene = Balls{}.build();
    scene->check(ogive_world_reopen(scene->get()));
    ogive_stop_def none;
    ogive_stop_def_init(&none, sizeof none);
    scene->check(ogive_world_set_stop(scene->get(), &none));
    scene->prepare();
  }
  whole.steps(150);
  part.steps(120);
  Store store;
  store.save(part);
  const std::int32_t version = 3;
  std::memcpy(store.arrays.at("version").bytes.data(), &version, sizeof version);
  const std::size_t removed = std::erase_if(store.arrays, [](const auto& array) {
    return array.first.find("exchange") != std::string::npos || array.first.find("dropped") != std::string::npos ||
           array.first.find("drop_debris") != std::string::npos;
  });
  EXPECT_EQ(removed, 5u + 2u + 2 * 5u + 1u);
  store.load(rest);
  rest.steps(30);
  expect_same_bits(whole, rest);
}

TEST(ExchangeStop, ThePlanTellsOfIt) {
  Scene scene = Balls{}.build();
  std::string text(8192, '\0');
  scene.check(ogive_world_plan(scene.get(), text.data(), text.size(), nullptr));
  EXPECT_NE(text.find("stop: when no energy has changed by more than 10 % of the initial total for 0.05"), std::string::npos) << text.c_str();
}
