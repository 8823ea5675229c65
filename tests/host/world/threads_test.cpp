/* Several threads: each with a world of its own, or all reading one. */
#include <functional>
#include <future>
#include <thread>

#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "tests/catch.h"
#include "tests/host/world/bodies.h"

using namespace tandem;

namespace {

constexpr size_t thread_count = 4;

/* The results of thread 0, 1 and so on. */
template <class Work> auto in_threads(Work work)
{
  std::vector<std::future<decltype(work(size_t{}))>> running;
  for (size_t k = 0; k < thread_count; ++k) running.push_back(std::async(std::launch::async, work, k));
  std::vector<decltype(work(size_t{}))> results;
  for (auto &one : running) results.push_back(one.get());
  return results;
}

/* Bodies come and go, fall asleep and wake, and the world is saved and restored. Odd threads use TBB. */
uint64_t hash_of_short_day(size_t thread)
{
  const char *const scenes[thread_count] = {"box-grid:nx=2,ny=2,nz=2", "mixed:n=12", "spheres:n=9,height=0",
                                            "compounds:n=4"};
  Settings settings;
  settings.sleeping = true;
  settings.sleep_time = 0.1f;
  settings.events = true;
  const Placement placement{thread % 2 ? "tbb:threads=2,lanes=4" : "serial", {}};
  World world(load_scene(scenes[thread]), settings, placement);
  std::vector<std::byte> snapshot;
  uint64_t hash = 0;
  for (int k = 0; k < 40; ++k) {
    if (k % 10 == 3) world.destroy_body(world.body_ids().back());
    if (k % 10 == 5) world.create_body(world.scene().bodies[1]);
    if (k == 12) snapshot = world.save();
    if (k == 20) world.restore(snapshot);
    world.step();
    hash = hash * 31 + world.state_hash() + world.contact_events().size();
  }
  return hash;
}

struct Reading {
  std::vector<Point> positions;
  uint64_t hash;
  size_t bytes, events;
  std::vector<uint32_t> hits;
  uint32_t asleep, contacts;

  bool operator==(const Reading &) const = default;
};

Reading reading_of(World &world)
{
  Reading reading{};
  for (const BodyState &state : world.read_bodies(world.body_ids())) reading.positions.push_back(state.position);
  for (const Ray &ray : {Ray{{0, 9, 0}, {0, -1, 0}, 20, {}}, Ray{{3, 9, 0}, {0, -1, 0}, 20, {}}})
    reading.hits.push_back(world.cast_rays(std::span(&ray, 1)).front().body);
  for (const BodyId &id : world.body_ids()) reading.asleep += world.is_asleep(id);
  reading.contacts = world.statistics().contacts;
  reading.events = world.contact_events().size();
  reading.bytes = world.save().size();
  reading.hash = world.state_hash();
  return reading;
}

} // namespace

TEST_CASE("threads: worlds of several threads have the bits that each has alone", "[sanitizer]")
{
  std::vector<uint64_t> alone;
  for (size_t k = 0; k < thread_count; ++k) alone.push_back(hash_of_short_day(k));
  CHECK(in_threads(hash_of_short_day) == alone);
}

/* A call that no step has applied yet is applied by whichever read comes first. It wakes a body that sleeps, so reads
 * change what the host knows. */
TEST_CASE("threads: reads beside reads of one world agree with reads of one thread", "[sanitizer]")
{
  Scene scene;
  scene.name = "sleepers";
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f)};
  scene.bodies = {body_at({0, 0, 0}), body_at({0, 0.5, 0}, 1), body_at({3, 0.5, 0}, 1), body_at({3, 1.5, 0}, 1)};
  scene.bodies[0].type = BodyType::fixed;
  Settings settings;
  settings.sleeping = settings.events = true;
  for (const char *on : {"serial", "tbb:threads=2,lanes=4"}) {
    World world(scene, settings, {on, {}}), other(scene, settings, {on, {}});
    for (World *one : {&world, &other}) {
      for (int k = 0; k < 60; ++k) one->step();
      REQUIRE(one->statistics().asleep == 3);
      one->add_impulse(one->id_of(2), {.impulse = {0, 1, 0}});
    }
    reading_of(other); /* is_asleep stands in no read before the calls are applied */
    const Reading alone = reading_of(other);
    CHECK(alone.asleep == 1);
    world.bodies();
    for (const Reading &reading : in_threads([&](size_t) { return reading_of(world); })) CHECK(reading == alone);
    world.add_impulse(world.id_of(1), {.impulse = {0, 1, 0}});
    for (const Reading &reading : in_threads([&](size_t) { return reading_of(world); })) CHECK(reading.asleep == 0);
  }
}
