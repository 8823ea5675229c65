/* A batch of queries uploads no more than its queries: what follows from the bodies stays until they change. The
 * answers after each kind of change are those of a world that was asked nothing before. */
#include <functional>

#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Rows of boxes on the ground, which soon rest, and one that falls for long; some are in a group of their own. */
Scene resting_rows(uint32_t count)
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (uint32_t k = 0; k < count; ++k) {
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f),
                          {2.0 * (k % 20), k + 1 == count ? 50 : 0.5, 2.0 * (k / 20)});
    body.filter_group = 1u << (k % 2);
  }
  return scene;
}

std::vector<Ray> rays_from_above(size_t count)
{
  std::vector<Ray> rays(count);
  for (size_t k = 0; k < count; ++k) {
    rays[k].origin = {0.7 * double(k % 60), 5, 0.9 * double(k / 60)};
    rays[k].direction = {0, -10, 0};
    rays[k].filter.mask = k % 3 ? 3 : 2;
  }
  return rays;
}

std::vector<QueryBox> boxes_in_rows(size_t count)
{
  std::vector<QueryBox> boxes(count);
  for (size_t k = 0; k < count; ++k) boxes[k] = {{0.7 * double(k % 60), 0.5, 0.9 * double(k / 60)}, {1, 1, 1}, {}, {}};
  return boxes;
}

std::vector<Pose> poses_above(size_t count)
{
  std::vector<Pose> poses(count);
  for (size_t k = 0; k < count; ++k) poses[k].position = {0.7 * double(k % 60), 5, 0.9 * double(k / 60)};
  return poses;
}

/* Bytes that the host gives to buffers in a call. */
uint64_t uploaded_by(World &world, const std::function<void()> &call)
{
  const uint64_t before = world.memory().uploaded_bytes();
  call();
  return world.memory().uploaded_bytes() - before;
}

uint64_t launches_of(World &world, const std::string &name)
{
  uint64_t launches = 0;
  for (const KernelTime &time : world.take_kernel_times())
    if (row_of(time.kernel).name == name) launches += time.launches;
  return launches;
}

/* The records of buffers.def, and the number of queries, which is one entry of counts. */
constexpr uint64_t count_bytes = 4, start_bytes = 32, path_bytes = 16, extent_bytes = 16, turn_bytes = 16,
                   filter_bytes = 8;

bool same_answers(const std::vector<std::vector<RayHit>> &a, const std::vector<std::vector<RayHit>> &b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto &one, const auto &other) {
    return std::equal(one.begin(), one.end(), other.begin(), other.end(), [](const RayHit &p, const RayHit &q) {
      return p.body == q.body && p.fraction == q.fraction && p.point == q.point && p.normal == q.normal;
    });
  });
}

Settings settings_that_sleep(bool sleeping)
{
  Settings settings;
  settings.sleeping = sleeping;
  settings.broadphase = Broadphase::bvh;
  return settings;
}

} // namespace

TEST_CASE("the second of two batches uploads its queries alone and rebuilds no hierarchy")
{
  const bool sleeping = GENERATE(false, true);
  CAPTURE(sleeping);
  const uint32_t bodies = 200;
  World world(resting_rows(bodies), settings_that_sleep(sleeping), {"serial", {}});
  run(world, 60);
  REQUIRE((world.statistics().asleep > 100) == sleeping);
  const std::vector<Ray> rays = rays_from_above(300);
  const std::vector<QueryBox> boxes = boxes_in_rows(300);
  const std::vector<Pose> poses = poses_above(300);
  const std::vector<Vec3> displacements(300, Vec3{0, -9, 0});
  const uint64_t n = rays.size(), of_rays = count_bytes + n * (start_bytes + path_bytes + filter_bytes);
  const uint64_t of_bodies = 16 * (bodies + 1);

  const uint64_t first = uploaded_by(world, [&] { world.cast_rays(rays); });
  CHECK(first >= of_rays + of_bodies); /* the bodies are told once */
  world.set_profiling(true);
  CHECK(uploaded_by(world, [&] { world.cast_rays(rays); }) == of_rays);
  CHECK(uploaded_by(world, [&] { world.cast_rays_any(rays); }) == of_rays);
  CHECK(uploaded_by(world, [&] { world.cast_rays_all(rays); }) == of_rays);
  CHECK(uploaded_by(world, [&] { world.cast_boxes(boxes); }) == of_rays + n * extent_bytes);
  const uint64_t of_casts = uploaded_by(world, [&] { world.cast_shapes(sphere_shape(0.3f), poses, displacements); });
  CHECK(of_casts - (of_rays + n * turn_bytes) < 256); /* the shape besides */
  const auto times = world.take_kernel_times();
  CHECK_FALSE(times.empty());
  for (const KernelTime &time : times) {
    CAPTURE(row_of(time.kernel).name);
    CHECK(time.kernel != Kernel::compute_query_bounds);
  }

  /* A step moves bodies, so their bounds are made anew; who they are has not changed. */
  run(world, 1);
  world.take_kernel_times();
  CHECK(uploaded_by(world, [&] { world.cast_rays(rays); }) < of_rays + of_bodies / 4);
  CHECK(launches_of(world, "compute_query_bounds") == 1);
  CHECK(uploaded_by(world, [&] { world.cast_rays(rays); }) == of_rays);
  CHECK(launches_of(world, "compute_query_bounds") == 0);
}

/* Queries are written where they are read, so that they do not move either. */
TEST_CASE("the second of two batches launches its own kernel alone, and no buffer moves for it")
{
  Settings settings;
  settings.broadphase = GENERATE(Broadphase::grid, Broadphase::bvh, Broadphase::brute_force);
  World world(resting_rows(200), settings, {"serial", {{"queries", "reference"}}});
  run(world, 3);
  const std::vector<Ray> rays = rays_from_above(300);
  const uint64_t moved_by_steps = world.bytes_moved();
  world.cast_rays(rays);
  const uint64_t launches = world.launches(), moved = world.bytes_moved();
  CHECK(moved > moved_by_steps); /* the bodies, once */
  world.cast_rays(rays);
  CHECK(world.launches() - launches == 1);
  CHECK(world.bytes_moved() == moved);
}

TEST_CASE("batches after every kind of change answer as a world that was asked nothing before")
{
  const bool sleeping = GENERATE(false, true);
  const char *backend = GENERATE("serial", "tbb");
  CAPTURE(sleeping, backend);
  World asked(resting_rows(100), settings_that_sleep(sleeping), {backend, {}});
  World silent(resting_rows(100), settings_that_sleep(sleeping), {backend, {}});
  asked.keep_states(4);
  silent.keep_states(4);
  std::vector<std::byte> saved_asked, saved_silent;
  struct Change {
    const char *name;
    std::function<void(World &, std::vector<std::byte> &)> make;
  };
  Body fresh;
  fresh.shape = 1;
  fresh.position = {1, 3, 1};
  fresh.filter_group = 2;
  const Change changes[] = {
      {"nothing", [](World &, auto &) {}},
      {"steps", [](World &world, auto &) { run(world, 60); }},
      {"save", [](World &world, auto &saved) { saved = world.save(); }},
      {"filters", [](World &world, auto &) { world.set_filter(world.id_of(6), 2, 0xffffffffu); }},
      {"filters that hide", [](World &world, auto &) { world.set_filter(world.id_of(8), 0, 0); }},
      {"destroy", [](World &world, auto &) { world.destroy_body(world.id_of(5)); }},
      {"create", [&](World &world, auto &) { world.create_bodies(std::span(&fresh, 1)); }},
      {"wake",
       [](World &world, auto &) {
         world.add_impulse(world.id_of(20), {.impulse = {0, 4000, 0}});
       }},
      {"steps of woken", [](World &world, auto &) { run(world, 3); }},
      {"back", [](World &world, auto &) { world.go_back(2); }},
      {"restore", [](World &world, auto &saved) { world.restore(saved); }},
      {"placement",
       [](World &world, auto &) {
         world.place({"serial", {}});
       }},
      {"steps again", [](World &world, auto &) { run(world, 40); }},
  };
  const std::vector<Ray> rays = rays_from_above(600);
  std::vector<std::vector<RayHit>> before = asked.cast_rays_all(rays);
  size_t changed = 0;
  for (const Change &change : changes) {
    CAPTURE(change.name);
    change.make(asked, saved_asked);
    change.make(silent, saved_silent);
    const std::vector<std::byte> now = silent.save();
    World newcomer(now, Placement{"serial", {}});
    const auto expected = newcomer.cast_rays_all(rays), found = asked.cast_rays_all(rays);
    CHECK(same_answers(found, expected));
    CHECK(same_answers(asked.cast_rays_all(rays), expected));
    changed += !same_answers(found, before);
    before = found;
  }
  CHECK(changed >= 6);
}
