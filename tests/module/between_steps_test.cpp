/* Kernels of a module between steps: they read the hits of casts where these were left, and recordings hold what was
 * run, written and cast. */
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include <fmt/format.h>
#include <unistd.h>

#include <tandem/recording.h>
#include <tandem/world.h>

#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tests/module/pushing.h"

using namespace tandem;
using namespace module_tests;
using Catch::Matchers::Contains;

/* A ray for each body, in the order of the buffers; every other one looks away. */
TEST_CASE("module: a kernel between steps reads the hits of rays and shape casts where they were left")
{
  const Scene scene = balls(9);
  for (const std::string &backend : all_backends()) {
    CAPTURE(backend);
    World world(scene, with(pushing(0)), {backend, {}});
    std::vector<Ray> rays(9);
    std::vector<Pose> poses(9);
    std::vector<Vec3> paths(9);
    for (uint32_t i = 0; i < 9; ++i) {
      const double sign = i % 2 ? 1 : -1;
      rays[i].origin = poses[i].position = {2.0 * world.scene_body(i), 1 + 0.125 * i, 0};
      rays[i].direction = paths[i] = {0, float(-4 * sign), 0};
    }
    for (const bool shapes : {false, true}) {
      if (shapes) world.cast_shapes_on_device(sphere_shape(0.05f), poses, paths);
      else world.cast_rays_on_device(rays);
      world.run(probe::kernel::probe_see());
      const std::vector<BodyState> bodies = world.bodies();
      const std::vector<RayHit> hits = shapes ? world.cast_shapes(sphere_shape(0.05f), poses, paths)
                                              : world.cast_rays(rays);
      for (uint32_t i = 0; i < 9; ++i) {
        CAPTURE(shapes, i);
        REQUIRE((hits[i].body == no_body) == (i % 2 == 0));
        const float radii = shapes ? 0.15f : 0.1f, expected = i % 2 ? (1 + 0.125f * float(i) - radii) / 4 : 0;
        CHECK(bodies[world.scene_body(i)].linear_velocity[1] == hits[i].normal[1] * hits[i].fraction);
        CHECK(bodies[world.scene_body(i)].linear_velocity[1] == Approx(expected).margin(1e-5));
      }
    }
    world.step();
  }
}

TEST_CASE("module: a kernel over more items than there are hits is refused, also when the last cast had none")
{
  World world(balls(9), with(pushing(0)), {"serial", {}});
  const auto refusal = [&] { return message_of([&] { world.run(probe::kernel::probe_see()); }); };
  const std::string fills = "is empty; World::cast_rays_on_device or cast_shapes_on_device fills it, until another";
  CHECK_THAT(refusal(), Contains(fills));
  std::vector<Ray> rays(9);
  for (Ray &ray : rays) ray.direction = {0, -9, 0};
  world.cast_rays_on_device(std::span(rays).first(8));
  CHECK_THAT(refusal(), Contains("has the hits of 8 queries, and the kernel may read those of 9"));
  world.cast_rays_on_device(rays);
  world.run(probe::kernel::probe_see());
  world.cast_rays_on_device({});
  CHECK_THAT(refusal(), Contains(fills));
  world.cast_rays_on_device(rays);
  world.cast_shapes_on_device(sphere_shape(0.1f), {}, {});
  CHECK_THAT(refusal(), Contains(fills));
}

TEST_CASE("module: hits end with another query, a step and the start of a recording")
{
  World world(balls(3), with(pushing(0)), {"serial", {}});
  std::vector<Ray> rays(3);
  for (Ray &ray : rays) ray.direction = {0, -9, 0};
  const std::string path = std::filesystem::temp_directory_path() / fmt::format("tandem-hits-{}.tandem", getpid());
  const std::vector<std::function<void()>> ends = {
      [&] { world.cast_rays(rays); },
      [&] { world.overlap_shapes(sphere_shape(1), std::vector<Pose>(1)); },
      [&] { world.step(); },
      [&] {
        world.start_recording(path);
        world.stop_recording();
        std::filesystem::remove(path);
      }};
  for (const auto &end : ends) {
    world.cast_rays_on_device(rays);
    world.run(probe::kernel::probe_see());
    end();
    CHECK_THAT(message_of([&] { world.run(probe::kernel::probe_see()); }), Contains("is empty"));
  }
}

/* Three balls in a row touch, and a fourth lies apart; the ray of the first one hits nothing. A world has room for more
 * pairs than it has, and no program knows for how many. */
TEST_CASE("module: a kernel over pairs reads the hits of their bodies, where each body has one")
{
  for (const std::string &backend : all_backends()) {
    CAPTURE(backend);
    Scene scene = balls(3);
    for (uint32_t k = 0; k < 3; ++k) scene.bodies[k].position = {0.199 * k, 0, 0};
    World world(scene, with(pushing(0)), {backend, {}});
    Body apart = scene.bodies[0];
    apart.position = {9, 0, 0};
    world.create_body(apart);
    world.step();
    std::vector<Ray> rays(4);
    for (uint32_t row = 0; row < 4; ++row) {
      const uint32_t body = world.scene_body(row);
      rays[row].origin = {world.bodies()[body].position[0], 1, 0};
      rays[row].direction = {0, body == 0 ? 4.0f : -4.0f, 0};
    }
    const auto contacts = [&] {
      const auto read = [&](Buffer buffer) { return world.memory().read<uint32_t>(buffer, 2); };
      const auto a = read(Buffer::pair_a), b = read(Buffer::pair_b), points = read(Buffer::manifold_count);
      std::map<std::set<uint32_t>, uint32_t> found;
      for (size_t k = 0; k < 2; ++k) found[{world.scene_body(a[k]), world.scene_body(b[k])}] = points[k];
      return found;
    };
    REQUIRE(contacts() == std::map<std::set<uint32_t>, uint32_t>{{{0, 1}, 1}, {{1, 2}, 1}});
    world.cast_rays_on_device(std::span(rays).first(3));
    CHECK_THAT(message_of([&] { world.run(probe::kernel::probe_see_pairs()); }),
               Contains("has the hits of 3 queries, and the kernel may read those of 4"));
    world.cast_rays_on_device(rays);
    world.run(probe::kernel::probe_see_pairs());
    CHECK(contacts() == std::map<std::set<uint32_t>, uint32_t>{{{0, 1}, 0}, {{1, 2}, 1}});
  }
}

namespace {

WorldRecording recording_of(World &world, const std::function<void()> &work)
{
  const std::string path = std::filesystem::temp_directory_path() / fmt::format("tandem-module-{}.tandem", getpid());
  world.start_recording(path);
  work();
  world.stop_recording();
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::filesystem::remove(path);
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return {std::move(bytes), "F.tandem"};
}

} // namespace

TEST_CASE("module: what is written to its buffers and run between steps is in a recording")
{
  World world(balls(5), with(pushing(1)), {"tbb", {}});
  const WorldRecording recording = recording_of(world, [&] {
    for (int i = 0; i < 4; ++i) {
      world.write<float>(probe::buffer::probe_force(), std::vector<float>{0.1f * static_cast<float>(i), 0, 0, 0});
      if (i == 2) world.run(probe::kernel::probe_turn_back());
      world.step();
    }
  });
  World again(recording.snapshot(), {"serial", {}}, {pushing(1)});
  CHECK_FALSE(replay(recording, again, {}));
  CHECK(again.state_hash() == world.state_hash());
}

/* Balls move by what their rays hit, so a replay without the casts would be another one. */
TEST_CASE("module: casts whose hits stay on the device are in a recording")
{
  World world(balls(5), with(pushing(0)), {"tbb", {}});
  std::vector<Ray> rays(5);
  std::vector<Pose> poses(5);
  const std::vector<Vec3> paths(5, Vec3{0, -4, 0});
  for (uint32_t i = 0; i < 5; ++i) {
    rays[i].origin = poses[i].position = {2.0 * world.scene_body(i), 1 + 0.125 * i, 0};
    rays[i].direction = paths[i];
    rays[i].reach = i == 4 ? 0.1f : 1; /* which is too short */
    rays[i].filter.mask = i == 3 ? 0 : ~0u;
  }
  const uint64_t before = world.state_hash();
  const WorldRecording recording = recording_of(world, [&] {
    world.cast_rays_on_device(rays);
    world.run(probe::kernel::probe_see());
    CHECK(world.state_hash() != before);
    world.step();
    world.cast_shapes_on_device(sphere_shape(0.05f), poses, paths);
    world.run(probe::kernel::probe_see());
    world.step();
  });
  for (const std::string &backend : all_backends()) {
    CAPTURE(backend);
    World again(recording.snapshot(), {backend, {}}, {pushing(0)});
    CHECK_FALSE(replay(recording, again, {}));
    CHECK(again.state_hash() == world.state_hash());
  }
}
