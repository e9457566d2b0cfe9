// Bounds of what a step may leave behind, on two particles.
#include "breakdown.hpp"

#include <gtest/gtest.h>

using namespace ogive;

namespace {

// A body of two particles whose waves run at 2, one of them compressed to a half.
struct TwoParticles {
  Model model;
  State state;

  TwoParticles() {
    model.materials.resize(1);
    model.materials[0].density = 1;
    model.materials[0].K = 4;
    model.bodies.resize(1);
    model.bodies[0].name = "pair";
    model.bodies[0].material = 0;
    state.bodies.resize(1);
    BodyState& body = state.bodies[0];
    body.particles = 2;
    allocate_particles(model.materials[0], Body{}, group_padding, body);
    Group group;
    group.count = 2;
    body.groups = {group};
    body.number[0] = 0, body.number[1] = 1;
    body.volume_ratio[1] = 0.5;
    body.totals.initial_velocity = {3, 0, 0};
  }
  void set_speed(int particle, double speed) {
    state.bodies[0].velocity[4 * particle] = speed;
    state.bodies[0].totals.maximum_speed = std::max(state.bodies[0].totals.maximum_speed, speed);
  }
};

}  // namespace

TEST(SpeedBound, LetsAParticleBeTenTimesAsFastAsWaveAndBodyAndNoFaster) {
  TwoParticles two;
  two.set_speed(1, 10 * (2 + 3));
  EXPECT_NO_THROW(check_speeds(two.model, two.state));
  two.set_speed(1, 10 * (2 + 3) * 1.001);
  EXPECT_THROW(check_speeds(two.model, two.state), Error);
  // Where the slower one is fast too, the body is.
  two.set_speed(0, 20);
  EXPECT_NO_THROW(check_speeds(two.model, two.state));
}

TEST(SpeedBound, TakesASpeedThatNumbersDoNotHoldForARunaway) {
  TwoParticles two;
  two.set_speed(0, 1e200);
  two.set_speed(1, 1e200);
  two.state.bodies[0].totals.maximum_speed = std::numeric_limits<double>::infinity();
  EXPECT_THROW(check_speeds(two.model, two.state), Error);
}

TEST(TimeStepBound, IsAHundredthOfThatOfTheMaterialAtRestWithItsSpeeds) {
  TwoParticles two;
  EXPECT_FALSE(time_step_collapsed(two.model, two.state, 100 * (2 + 3)));
  EXPECT_TRUE(time_step_collapsed(two.model, two.state, 100 * (2 + 3) * 1.001));
  two.set_speed(0, 7);
  EXPECT_FALSE(time_step_collapsed(two.model, two.state, 100 * (2 + 3 + 7)));
  const std::string message = collapse(two.model, two.state, 1e-9, 1e9).what();
  EXPECT_NE(message.find("particle 1"), std::string::npos) << message;
  EXPECT_NE(message.find("compressed one, to 0.5 of its volume"), std::string::npos) << message;
}
