// Growing energy is told and stopped: a run never ends with energy that nothing gave it without saying so.
#include <algorithm>
#include <limits>

#include "scene.hpp"
#include "store.hpp"

using namespace verification;

namespace {

void hear(void* user, std::int32_t level, const char* text) {
  if (level == OGIVE_LOG_WARNING) static_cast<std::vector<std::string>*>(user)->push_back(text);
}

/// A soft block that turns by 0.02 rad a step, of which the stress first makes 13 % of energy in a turn (docs/stability.md).
void add_turning_block(Scene& scene, double warning, double limit) {
  scene.grid(1, {-8, -8, -8}, {8, 8, 8});
  ogive_numerics_def numerics;
  ogive_numerics_def_init(&numerics, sizeof numerics);
  numerics.energy_warning = warning;
  numerics.energy_limit = limit;
  scene.check(ogive_world_set_numerics(scene.get(), &numerics));
  const ogive_material_id material = scene.material("soft", elastic(2.7e-3, 690, 0.3));
  scene.add("block", Scene::body(material, {}, {0, 0, 25}, {0.1, 0.2, 0.3}), Scene::solid(OGIVE_SOLID_BOX, {0.1, 0.2, 0.3}, {4, 4, 4}, 0.5));
}

}  // namespace

TEST(EnergyWatch, AnUnstableRunIsWarnedOfOnceAndStoppedWithTimeParticleAndCause) {
  Scene scene;
  std::vector<std::string> told;
  add_turning_block(scene, 0.01, 0.1);
  scene.check(ogive_world_set_log(scene.get(), &hear, &told));
  scene.prepare();
  told.clear();
  EXPECT_EQ(ogive_world_advance(scene.get(), 1.0, 0, nullptr, nullptr), OGIVE_ERROR_NUMERICAL);
  const std::string message = ogive_world_message(scene.get());
  for (const char* part : {"at time ", "the energy has grown by ", "energy_limit: 10", "body \"", "particle ", "speed ",
                           "probable cause: a body turns by 0.0"})
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
  EXPECT_EQ(std::count_if(told.begin(), told.end(), [](const std::string& t) { return t.find("the energy has grown by ") == 0; }), 1);
  // The broken state can be looked at: its ledger tells the same.
  const ogive_ledger ledger = scene.ledger();
  EXPECT_GT(ledger.energy_growth, 0.1);
  EXPECT_GT(ledger.energy_warning_time, 0.0);
  EXPECT_LE(ledger.energy_warning_time, ledger.energy_growth_time);
  measured("steps until it is stopped", static_cast<double>(scene.progress().steps));  // 250
}

TEST(EnergyWatch, WithoutALimitTheRunGoesOnAndTheLedgerStillTells) {
  Scene scene;
  add_turning_block(scene, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
  scene.prepare();
  scene.steps(330);
  EXPECT_GT(scene.ledger().energy_growth, 0.1);  // measured 0.13
  EXPECT_EQ(scene.ledger().energy_warning_time, -1);
}

namespace {

/// Two blocks of two cells strike each other; contact at nodes takes a part of their energy that no term has.
void add_lossy_impact(Scene& scene, double loss_limit) {
  scene.grid(1, {-8, -8, -8}, {8, 8, 8});
  ogive_numerics_def numerics;
  ogive_numerics_def_init(&numerics, sizeof numerics);
  numerics.energy_loss_limit = loss_limit;
  scene.check(ogive_world_set_numerics(scene.get(), &numerics));
  scene.contact(OGIVE_CONTACT_BARDENHAGEN_2000, OGIVE_DETECTION_SHARED_NODE);
  const ogive_material_id material = scene.material("soft", elastic(2.7e-3, 690, 0.3));
  scene.box("left", material, {-3, -1, -1}, {-1, 1, 1}, 0.5, {20, 0, 0});
  scene.box("right", material, {1, -1, -1}, {3, 1, 1}, 0.5, {-20, 0, 0});
  scene.prepare();
}

}  // namespace

TEST(EnergyWatch, LostEnergyStopsARunThatIsToKeepIt) {
  Scene scene;
  add_lossy_impact(scene, 0.02);
  EXPECT_EQ(ogive_world_check_energy(scene.get()), OGIVE_OK);
  EXPECT_EQ(ogive_world_advance(scene.get(), 0.3, 0, nullptr, nullptr), OGIVE_ERROR_NUMERICAL);
  const std::string message = ogive_world_message(scene.get());
  for (const char* part : {"at time ", " % of the energy that there was", "lost, unaccounted for (energy_loss_limit: 2", "probable cause: contact between",
                           "\"left\"", "\"right\""})
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
}

TEST(EnergyWatch, TheLedgerTellsALossAndTheCheckLooksBetweenSteps) {
  Scene scene;
  add_lossy_impact(scene, 1);
  scene.advance(0.3);
  const double lost = scene.ledger().energy_unaccounted;
  measured("lost", lost);
  EXPECT_LT(lost, -0.03);
  EXPECT_NEAR(lost, scene.ledger().residual_relative, 1e-12);
  EXPECT_EQ(ogive_world_check_energy(scene.get()), OGIVE_OK);

  // Steps look at every 25th alone; the check looks when it is asked.
  Scene strict;
  add_lossy_impact(strict, 1e-9);
  strict.steps(20);
  EXPECT_EQ(ogive_world_check_energy(strict.get()), OGIVE_ERROR_NUMERICAL);
  EXPECT_EQ(ogive_world_step(strict.get(), 0), OGIVE_OK) << "the check changed the world";
}

TEST(EnergyWatch, LimitsOutOfRangeAreNamed) {
  for (const double wrong : {0.0, -1.0, std::nan("")}) {
    Scene scene;
    ogive_numerics_def numerics;
    ogive_numerics_def_init(&numerics, sizeof numerics);
    numerics.energy_limit = wrong;
    EXPECT_EQ(ogive_world_set_numerics(scene.get(), &numerics), OGIVE_ERROR_ARGUMENT);
    EXPECT_NE(std::string(ogive_world_message(scene.get())).find("energy_limit"), std::string::npos);
    numerics.energy_limit = 1;
    numerics.energy_loss_limit = wrong;
    EXPECT_EQ(ogive_world_set_numerics(scene.get(), &numerics), OGIVE_ERROR_ARGUMENT);
    EXPECT_NE(std::string(ogive_world_message(scene.get())).find("energy_loss_limit"), std::string::npos);
    numerics.energy_loss_limit = 1;
    numerics.energy_warning = wrong;
    EXPECT_EQ(ogive_world_set_numerics(scene.get(), &numerics), OGIVE_ERROR_ARGUMENT);
    EXPECT_NE(std::string(ogive_world_message(scene.get())).find("energy_warning"), std::string::npos);
  }
}

TEST(EnergyWatch, WhatTheHostGivesAndTheWorkOfGravityAreNoGrowth) {
  Scene scene;
  scene.grid(1, {-10, -10, -10}, {10, 10, 10}).numerics(OGIVE_SHAPE_QUADRATIC_BSPLINE, 0.5, {0, 0, -1e4});
  const ogive_material_id material = scene.material("aluminium", elastic(2.7e-3, 69e3, 0.3));
  const ogive_body_id body = scene.box("block", material, {-2, -2, -2}, {2, 2, 2}, 0.5, {});
  scene.prepare();
  EXPECT_EQ(scene.ledger().initial_total, 0.0);
  scene.steps(100);  // falls
  EXPECT_GT(scene.ledger().external_work, 0.0);
  std::vector<double> velocity = scene.field(body, "velocity");
  for (std::size_t p = 0; p < velocity.size() / 3; ++p) velocity[3 * p] = 50;
  scene.check(ogive_field_set(scene.get(), body, "velocity", velocity.data(), static_cast<std::int64_t>(velocity.size())));
  EXPECT_GT(scene.ledger().residual, 0.9 * 0.5 * 64 * 2.7e-3 * 50 * 50);  // no term of the ledger has it ...
  scene.steps(100);
  measured("growth", scene.ledger().energy_growth);  // 2e-14
  EXPECT_LT(scene.ledger().energy_growth, 1e-12);    // ... but the watch knows
  EXPECT_EQ(scene.ledger().energy_warning_time, -1);
}

TEST(EnergyWatch, ItsMemoryIsSaved) {
  Scene scene;
  add_turning_block(scene, 0.01, std::numeric_limits<double>::infinity());
  scene.prepare();
  scene.steps(330);
  Store store;
  store.save(scene);
  Scene loaded;
  store.load(loaded);
  EXPECT_EQ(loaded.ledger().energy_growth, scene.ledger().energy_growth);
  EXPECT_EQ(loaded.ledger().energy_growth_time, scene.ledger().energy_growth_time);
  EXPECT_EQ(loaded.ledger().energy_warning_time, scene.ledger().energy_warning_time);
  EXPECT_GT(loaded.ledger().energy_warning_time, 0);
}
