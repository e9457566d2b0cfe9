// Want of memory, injected: each allocation of a whole session fails once, then again all that follow. No call may end the
// process or let an exception out; each reports OGIVE_ERROR_MEMORY, and where the header says that the world is as it was before
// the call, the same call made again succeeds and the session ends in the same bits as one without failures.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <new>
#include <string>
#include <vector>

extern "C" {
#include "small_world.h"
}
#include <ogive_geometry.h>

// CGAL 5.5 loses a property array when the list that it goes into cannot grow; nothing here can free it.
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions() { return "leak:CGAL::Properties::Property_container"; }

namespace {

// The test's own allocations do not count: only those between arm() and disarm().
bool armed = false;
long until_failure = -1;  // allocations that still succeed; -1: all
long seen = 0;

bool must_fail() {
  if (!armed) return false;
  ++seen;
  if (until_failure < 0) return false;
  if (until_failure > 0) {
    --until_failure;
    return false;
  }
  until_failure = -1;  // one failure at a time
  return true;
}

void* allocate(std::size_t size, std::size_t alignment) {
  if (must_fail()) return nullptr;
  if (size == 0) size = 1;
  return alignment <= alignof(std::max_align_t) ? std::malloc(size)
                                                : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void* allocate_or_throw(std::size_t size, std::size_t alignment) {
  void* const memory = allocate(size, alignment);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

// In place of the C++ library's, for the libraries under test as well.
void* operator new(std::size_t size) { return allocate_or_throw(size, 1); }
void* operator new[](std::size_t size) { return allocate_or_throw(size, 1); }
void* operator new(std::size_t size, std::align_val_t a) { return allocate_or_throw(size, static_cast<std::size_t>(a)); }
void* operator new[](std::size_t size, std::align_val_t a) { return allocate_or_throw(size, static_cast<std::size_t>(a)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size, 1); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return allocate(size, 1); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace {

// One call of a session with, perhaps, one failing allocation in it.
struct Session {
  ogive_world* world = nullptr;
  ogive_mesh* mesh = nullptr;
  ogive_material_id copper{-1};
  ogive_body_id left{-1}, right{-1};
  double values[9 * 64];
  std::string checkpoint, particles;

  std::vector<std::pair<const char*, std::function<ogive_status()>>> calls() {
    static const ogive_grid_def grid = small_grid();
    static const ogive_material_def material = small_material();
    static const ogive_solid_def left_box = small_box(-1), right_box = small_box(1);
    const auto body = [this](double velocity) {
      ogive_body_def def;
      ogive_body_def_init(&def, sizeof def);
      def.material = copper;
      def.velocity[0] = velocity;
      return def;
    };
    return {
        {"create", [this] { return ogive_world_create(&world); }},
        {"set_grid", [this] { return ogive_world_set_grid(world, &grid); }},
        {"material_add", [this] { return ogive_material_add(world, "copper", &material, &copper); }},
        {"add left", [=, this] { const auto d = body(50); return ogive_body_add_solid(world, "left", &d, &left_box, &left); }},
        {"add right", [=, this] { const auto d = body(-50); return ogive_body_add_solid(world, "right", &d, &right_box, &right); }},
        {"load_add",
         [this] {
           ogive_load_def def;
           ogive_load_def_init(&def, sizeof def);
           def.value[2] = 1;
           return ogive_load_add(world, &def, nullptr);
         }},
        {"clamp_add",
         [this] {
           ogive_clamp_def def;
           ogive_clamp_def_init(&def, sizeof def);
           def.a[0] = 5;
           def.b[0] = 6;
           return ogive_clamp_add(world, &def);
         }},
        {"attach", [this] { return ogive_world_attach(world, "note", "a note that is longer than a short string is", 44); }},
        {"prepare", [this] { return ogive_world_prepare(world); }},
        {"plan", [this] { std::size_t n; return ogive_world_plan(world, nullptr, 0, &n); }},
        {"ledger", [this] { ogive_ledger l; l.struct_size = sizeof l; return ogive_world_ledger(world, &l); }},
        {"field_get", [this] { return ogive_field_get(world, left, "stress", values, 6 * 64); }},
        {"set force",
         [this] {
           for (int i = 0; i < 3 * 64; ++i) values[i] = 0.001 * i;
           return ogive_field_set(world, left, "force", values, 3 * 64);
         }},
        {"advance to contact", [this] { return ogive_world_advance(world, 0.0015, 0, nullptr, nullptr); }},
        {"checkpoint_write", [this] { return ogive_checkpoint_write(world, checkpoint.c_str()); }},
        {"particles_write", [this] { return ogive_particles_write(world, particles.c_str()); }},
        {"destroy and create", [this] { ogive_world_destroy(world); world = nullptr; return ogive_world_create(&world); }},
        {"checkpoint_read", [this] { return ogive_checkpoint_read(world, checkpoint.c_str()); }},
        {"advance", [this] { return ogive_world_advance(world, 0.0025, 0, nullptr, nullptr); }},
        {"mesh_create", [this] { return ogive_mesh_create(&mesh); }},
        {"mesh_set_facets",
         [this] {
           const double corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
           const std::int32_t facets[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
           return ogive_mesh_set_facets(mesh, 4, corners, 4, facets);
         }},
        {"mesh_check", [this] { return ogive_mesh_check(mesh); }},
        {"mesh_voxelise",
         [this] {
           ogive_voxelise_def def;
           ogive_voxelise_def_init(&def, sizeof def);
           for (double& s : def.spacing) s = 0.2;
           std::int64_t count = 0;
           return ogive_mesh_voxelise(mesh, &def, &count, nullptr, nullptr);
         }},
    };
  }
  ~Session() {
    armed = false;
    ogive_world_destroy(world);
    ogive_mesh_destroy(mesh);
  }
};

std::vector<double> final_velocities(Session& session) {
  std::vector<double> values(3 * 64);
  EXPECT_EQ(ogive_field_get(session.world, session.left, "velocity", values.data(), 3 * 64), OGIVE_OK)
      << ogive_world_message(session.world);
  return values;
}

TEST(WantOfMemory, EveryFailingAllocationBecomesAStatusAndTheCallCanBeMadeAgain) {
  const std::string checkpoint = testing::TempDir() + "ogive_allocation_test.h5";
  // Without failures: the result, and the allocations of each call.
  std::vector<long> allocations;
  std::vector<double> expected[2];  // before the files, and in the end
  std::size_t files = 0, meshes = 0;  // where the session's parts begin
  for (int warm = 0; warm < 2; ++warm) {  // the first time HDF5 and the C++ library allocate what they keep
    allocations.clear();
    Session session;
    session.checkpoint = checkpoint;
    session.particles = checkpoint + ".particles";
    for (auto& [name, call] : session.calls()) {
      seen = 0;
      armed = true;
      const ogive_status status = call();
      armed = false;
      ASSERT_EQ(status, OGIVE_OK) << name << ": " << ogive_world_message(session.world);
      if (std::strcmp(name, "checkpoint_write") == 0) {
        files = allocations.size();
        expected[0] = final_velocities(session);
      }
      if (std::strcmp(name, "mesh_create") == 0) meshes = allocations.size();
      allocations.push_back(seen);
    }
    expected[1] = final_velocities(session);
  }

  long injected = 0, retried = 0, broken = 0;
  for (std::size_t at = 0; at < allocations.size(); ++at) {
    // Long calls repeat themselves: of more than 40 allocations, the first 25 and 15 spread over the rest.
    const long count = allocations[at];
    for (long n = 0; n < count; n += n < 25 ? 1 : std::max(1L, (count - 25) / 15)) {
      Session session;
      session.checkpoint = checkpoint;
    session.particles = checkpoint + ".particles";
      auto calls = session.calls();
      bool ended = false;
      // Only the part in which it happens, and what that needs.
      const std::size_t begin = at < meshes ? 0 : meshes, end = at < files ? files : at < meshes ? meshes : calls.size();
      for (std::size_t i = begin; i < end && !ended; ++i) {
        if (i == at) {
          until_failure = n;
          armed = true;
        }
        ogive_status status = calls[i].second();
        armed = false;
        until_failure = -1;
        if (i != at) {
          ASSERT_EQ(status, OGIVE_OK) << "after a failure in " << calls[at].first << ", " << calls[i].first << ": "
                                      << ogive_world_message(session.world);
          continue;
        }
        ++injected;
        if (status == OGIVE_OK) continue;  // it could do without
        ASSERT_EQ(status, OGIVE_ERROR_MEMORY) << calls[i].first << ", allocation " << n << ": "
                                              << ogive_status_name(status) << ", " << ogive_world_message(session.world);
        status = calls[i].second();
        if (status == OGIVE_ERROR_STATE) {
          // Half-way through a step: the world can be looked at and saved, and that is all.
          ASSERT_EQ(std::strncmp(calls[i].first, "advance", 7), 0) << calls[i].first;
          EXPECT_EQ(calls[9].second(), OGIVE_OK);
          ogive_ledger ledger;
          ledger.struct_size = sizeof ledger;
          EXPECT_EQ(ogive_world_ledger(session.world, &ledger), OGIVE_OK);
          EXPECT_EQ(ogive_checkpoint_write(session.world, (checkpoint + ".broken").c_str()), OGIVE_OK);
          ++broken;
          ended = true;
        } else {
          ASSERT_EQ(status, OGIVE_OK) << calls[i].first << " again after allocation " << n << " failed: "
                                      << ogive_world_message(session.world);
          ++retried;
        }
      }
      if (!ended && begin == 0) {
        ASSERT_EQ(final_velocities(session), expected[at < files ? 0 : 1]) << calls[at].first << ", allocation " << n;
      }
    }
  }
  std::printf("  %ld failures injected; %ld calls succeeded when made again, %ld broke off within a step\n", injected, retried,
              broken);
  EXPECT_GT(injected, 300);  // 375: where the contact arrays keep their memory from step to step there is less to refuse
  EXPECT_GT(retried, 300);
  for (const char* suffix : {"", ".particles", ".broken"}) std::remove((checkpoint + suffix).c_str());
}

}  // namespace
