// Binning: particles in groups by block, ordered by cell, padded; slots, links and colours of the sparse grid.
#include "grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "error.hpp"

namespace {

using namespace ogive;

struct World {
  Model model;
  State state;
  Workspace workspace;

  // Two bodies of particles at given places, in cells of 2 counted from (-10, 0, 5).
  explicit World(const std::vector<std::vector<Vector3>>& bodies) {
    model.grid.cell_size = 2;
    model.grid.domain_min = {-10, 0, 5};
    model.grid.domain_max = {90, 100, 105};
    Material material;
    material.name = "metal";
    material.density = 1;
    material.youngs_modulus = 1;
    material.poisson_ratio = 0.2;
    material.validate();
    model.materials.push_back(material);
    for (const auto& places : bodies) {
      model.bodies.emplace_back();
      model.bodies.back().name = "body " + std::to_string(model.bodies.size() - 1);
      model.bodies.back().material = 0;
      BodyState body;
      body.particles = static_cast<std::int64_t>(places.size());
      allocate_particles(material, Body{}, body.particles, body);
      for (std::size_t p = 0; p < places.size(); ++p) {
        for (int c = 0; c < 3; ++c) body.position[4 * p + c] = places[p][c];
        body.position[4 * p + 3] = 1 + static_cast<double>(p);
        body.velocity[4 * p + 3] = 1;
        body.number[p] = static_cast<std::int32_t>(p);
      }
      state.bodies.push_back(std::move(body));
    }
    model.complete();
    workspace.kernels = &kernel_table();
    workspace.materials.resize(bodies.size());
    bin_particles(model, state, workspace, true);
    link_grid(model, state, workspace);
  }
};

std::vector<Vector3> scattered(int count, Vector3 lower, double edge) {
  std::vector<Vector3> places;
  std::uint64_t seed = 12345;
  const auto next = [&] {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(seed >> 11) / 9007199254740992.0;
  };
  for (int i = 0; i < count; ++i) places.push_back({lower[0] + edge * next(), lower[1] + edge * next(), lower[2] + edge * next()});
  return places;
}

TEST(Grid, GroupsHoldEveryParticleOnceInItsBlockOrderedByCellAndPadded) {
  const World world({scattered(3000, {0, 10, 20}, 40)});
  const BodyState& body = world.state.bodies[0];
  std::set<std::int32_t> seen;
  std::int64_t end = 0;
  std::array<std::int32_t, 3> last_block{INT32_MIN, INT32_MIN, INT32_MIN};
  for (const Group& group : body.groups) {
    EXPECT_EQ(group.begin, end);
    EXPECT_EQ(group.begin % group_padding, 0);
    end = group.padded_end();
    const std::array<std::int32_t, 3> order{group.block[2], group.block[1], group.block[0]};
    EXPECT_LT(last_block, order);
    last_block = order;
    int last_cell = -1;
    for (std::int64_t p = group.begin; p < end; ++p) {
      int cell = 0;
      for (int axis = 2; axis >= 0; --axis) {
        const int c = static_cast<int>(std::floor((body.position[4 * p + axis] - world.model.grid.domain_min[axis]) / 2));
        EXPECT_EQ(c >> 2, group.block[axis]);
        EXPECT_GE(c & 3, group.low[axis]);
        EXPECT_LE(c & 3, group.high[axis]);
        cell = 4 * cell + (c & 3);
      }
      if (p < group.begin + group.count) {
        EXPECT_TRUE(seen.insert(body.number[p]).second);
        EXPECT_EQ(body.position[4 * p + 3], 1 + body.number[p]);
        EXPECT_GE(cell, last_cell);
        last_cell = cell;
      } else {
        EXPECT_EQ(body.number[p], -1);
        EXPECT_EQ(body.position[4 * p + 3], 0);  // padding has no mass
      }
    }
  }
  EXPECT_EQ(end, body.padded);
  EXPECT_EQ(seen.size(), 3000u);
}

// More particles than are moved at a time, near their old places (the ring goes round) and anywhere (it holds all), while some
// leave: every value stays with its particle.
TEST(Grid, WhatAParticleCarriesGoesWithIt) {
  World world({scattered(70000, {0, 10, 20}, 40)});
  BodyState& body = world.state.bodies[0];
  body.affine.resize(affine_size * static_cast<std::size_t>(body.padded));
  const auto tag = [](std::int32_t number, int field) { return 100.0 * number + field; };
  for (std::int64_t p = 0; p < body.padded; ++p) {
    const std::int32_t n = body.number[p];
    for (int c = 0; c < 3; ++c) body.velocity[4 * p + c] = tag(n, c);
    for (int c = 0; c < affine_size; ++c) body.affine[affine_size * p + c] = tag(n, 10 + c);
    for (int c = 0; c < 6; ++c) body.stress[c][p] = tag(n, 20 + c);
    body.energy[p] = tag(n, 30);
  }
  std::int64_t particles = 70000;
  for (const double edge : {1.5, 1.5, 40.0}) {
    const std::vector<Vector3> moves = scattered(70000, {-edge / 2, -edge / 2, -edge / 2}, edge);
    std::vector<Vector3> place(70000, {-1000, 0, 0});
    for (std::int64_t p = 0; p < body.padded; ++p)
      if (body.number[p] >= 0) {
        for (int c = 0; c < 3; ++c) body.position[4 * p + c] += moves[body.number[p]][c];
        if (body.number[p] % 7 == 0 && edge > 2) body.position[4 * p] = -11;
        std::copy_n(&body.position[4 * p], 3, place[body.number[p]].begin());
      }
    bin_particles(world.model, world.state, world.workspace, true);
    if (edge > 2) {
      EXPECT_LE(body.particles, particles - 10000);
    } else {
      EXPECT_EQ(body.particles, particles);
    }
    std::set<std::int32_t> seen;
    for (const Group& group : body.groups)
      for (std::int64_t p = group.begin; p < group.begin + group.count; ++p) {
        const std::int32_t n = body.number[p];
        ASSERT_TRUE(n >= 0 && seen.insert(n).second);
        ASSERT_EQ(body.position[4 * p + 3], 1 + n);
        for (int c = 0; c < 3; ++c) {
          ASSERT_EQ(body.position[4 * p + c], place[n][c]);
          ASSERT_EQ(body.velocity[4 * p + c], tag(n, c));
        }
        for (int c = 0; c < affine_size; ++c) ASSERT_EQ(body.affine[affine_size * p + c], tag(n, 10 + c));
        for (int c = 0; c < 6; ++c) ASSERT_EQ(body.stress[c][p], tag(n, 20 + c));
        ASSERT_EQ(body.energy[p], tag(n, 30));
      }
    EXPECT_EQ(static_cast<std::int64_t>(seen.size()), body.particles);
    particles = body.particles;
  }
}

TEST(Grid, OfTwoPencilsThatTouchACommonNodeOneWaitsForTheOther) {
  const World world({scattered(4000, {0, 10, 20}, 60), scattered(500, {30, 40, 50}, 20)});
  const Workspace& w = world.workspace;
  std::map<std::int64_t, std::set<std::int32_t>> touching;  // pencils by node
  for (std::int32_t p = 0; p < static_cast<std::int32_t>(w.pencils.size()); ++p)
    for (std::int32_t l = w.pencils[p].begin; l < w.pencils[p].end; ++l) {
      const GroupLinks& link = w.links[l];
      for (int z = link.tile_low[2]; z <= link.tile_high[2]; ++z)
        for (int y = link.tile_low[1]; y <= link.tile_high[1]; ++y)
          for (int x = link.tile_low[0]; x <= link.tile_high[0]; ++x) {
            const int block = (((z + 3) >> 2) * 3 + ((y + 3) >> 2)) * 3 + ((x + 3) >> 2);
            ASSERT_GE(link.slot[block], 0);
            touching[static_cast<std::int64_t>(link.slot[block]) * block_nodes +
                     ((((z + 3) & 3) * 4 + ((y + 3) & 3)) * 4 + ((x + 3) & 3))]
                .insert(p);
          }
    }
  const auto waits = [&](std::int32_t a, std::int32_t b) {
    const std::vector<std::int32_t> awaited = w.schedule.awaited_by(a);
    return std::count(awaited.begin(), awaited.end(), b) == 1;
  };
  int shared = 0;
  for (const auto& [node, pencils] : touching)
    for (const std::int32_t a : pencils)
      for (const std::int32_t b : pencils)
        if (a < b) {
          ++shared;
          ASSERT_NE(waits(a, b), waits(b, a)) << "pencils " << a << " and " << b;
        }
  EXPECT_GT(shared, 1000);
}

TEST(Grid, BlocksAreMixedWhereTwoBodiesReachThemAndOnlyThere) {
  const World apart({scattered(300, {0, 10, 20}, 15), scattered(300, {60, 70, 80}, 15)});
  EXPECT_TRUE(apart.workspace.mixed.empty());
  EXPECT_TRUE(apart.workspace.contacts.empty());
  const World together({scattered(300, {0, 10, 20}, 15), scattered(300, {10, 20, 30}, 15)});
  EXPECT_FALSE(together.workspace.mixed.empty());
  for (const MixedBlock& block : together.workspace.mixed) {
    EXPECT_GE(block.count, 2);
    std::set<std::int32_t> fields;
    for (std::int32_t i = 0; i < block.count; ++i) {
      const Slot& slot = together.workspace.slots[block.first_slot + i];
      EXPECT_EQ(slot.block, together.workspace.slots[block.first_slot].block);
      EXPECT_GE(slot.contact, 0);
      EXPECT_TRUE(fields.insert(slot.field).second);
    }
  }
}

TEST(Grid, MemoryFollowsTheMaterialNotTheDomain) {
  World world({scattered(1000, {0, 10, 20}, 10)});
  const std::size_t slots = world.workspace.slots.size(), nodes = world.workspace.nodes.size();
  world.model.grid.domain_max = {9000, 9000, 9000};
  bin_particles(world.model, world.state, world.workspace, true);
  link_grid(world.model, world.state, world.workspace);
  EXPECT_EQ(world.workspace.slots.size(), slots);
  EXPECT_EQ(world.workspace.nodes.size(), nodes);
  EXPECT_LE(slots, 27u * 4 * 4 * 4);
}

TEST(Grid, AParticleThatLeavesByAFreeFaceIsBookedWithItsMomentum) {
  World world({scattered(100, {0, 10, 20}, 10)});
  BodyState& body = world.state.bodies[0];
  body.position[0] = -10.5;
  body.velocity[0] = 3;
  const double mass = body.position[3];
  bin_particles(world.model, world.state, world.workspace, true);
  EXPECT_EQ(body.particles, 99);
  EXPECT_EQ(body.totals.left.particles, 1);
  EXPECT_EQ(body.totals.left.mass, mass);
  EXPECT_EQ(body.totals.left.momentum[0], 3 * mass);
}

TEST(Grid, AParticleThatIsNotANumberIsRefusedByName) {
  World world({scattered(100, {0, 10, 20}, 10)});
  world.state.bodies[0].position[1] = std::numeric_limits<double>::quiet_NaN();
  try {
    bin_particles(world.model, world.state, world.workspace, true);
    FAIL() << "expected an error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("body \"body 0\""), std::string::npos) << error.what();
  }
}

}  // namespace
