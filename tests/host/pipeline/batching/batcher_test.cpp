/* Every batcher against an oracle of its kind, on hard lists of contacts, and the check against planted faults. */
#include <algorithm>
#include <numeric>

#include "host/catalog/catalog.h"
#include "host/catalog/talks.h"
#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"
#include "shared/counts.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;
using Catch::Matchers::ContainsSubstring;

namespace {

Settings batched_by(Batching batching)
{
  Settings settings;
  settings.batching = batching;
  settings.check = true;
  return settings;
}

/* The contacts of the last step and their colours. */
struct Contacts {
  std::vector<uint32_t> a, b, points, color;
  std::vector<bool> moves;

  explicit Contacts(World &world)
  {
    Memory &memory = world.memory();
    const uint32_t pairs = memory.read<uint32_t>(Buffer::counts, COUNT_TOTAL)[COUNT_PAIRS];
    a = memory.read<uint32_t>(Buffer::pair_a, pairs);
    b = memory.read<uint32_t>(Buffer::pair_b, pairs);
    points = memory.read<uint32_t>(Buffer::manifold_count, pairs);
    color = memory.read<uint32_t>(Buffer::pair_color, pairs);
    for (uint32_t i = 0; i < world.scene().bodies.size(); ++i)
      moves.push_back(world.scene().bodies[world.scene_body(i)].type == BodyType::dynamic);
  }

  size_t touching() const { return points.size() - size_t(std::count(points.begin(), points.end(), 0u)); }

  std::vector<uint32_t> sizes() const
  {
    std::vector<uint32_t> sizes;
    for (uint32_t c : color)
      if (c < COLOR_LIMIT) {
        if (c >= sizes.size()) sizes.resize(c + 1);
        ++sizes[c];
      }
    return sizes;
  }
};

/* The talks' sequential batching: batch after batch, what is free goes in, the rest waits for the next. */
std::vector<uint32_t> batches_of_the_talk(const Contacts &contacts)
{
  std::vector<uint32_t> batch(contacts.a.size(), COLOR_INACTIVE), waiting;
  for (uint32_t i = 0; i < contacts.a.size(); ++i)
    if (contacts.points[i]) waiting.push_back(i);
  for (uint32_t number = 0; !waiting.empty(); ++number) {
    std::vector<bool> used(contacts.moves.size());
    std::vector<uint32_t> left;
    for (uint32_t i : waiting) {
      const uint32_t a = contacts.a[i], b = contacts.b[i];
      if (used[a] || used[b]) {
        left.push_back(i);
        continue;
      }
      used[a] = contacts.moves[a];
      used[b] = contacts.moves[b];
      batch[i] = std::min(number, COLOR_OVERFLOW);
    }
    waiting.swap(left);
  }
  return batch;
}

/* Spheres of radius 0.5 to 50 that rest on each other: the large reach over many cells of two-stage batching. */
Scene sizes_from_1_to_100()
{
  Scene scene = empty_scene();
  add_ground(scene);
  Random random(7);
  for (float x : {-50.0f, 50.0f}) add_body(scene, BodyType::dynamic, sphere_shape(50), {x, 50, 0}).mass = 1000;
  for (int i = 0; i < 300; ++i) {
    const float radius = i % 10 ? 0.5f : 2.0f;
    add_body(scene, BodyType::dynamic, sphere_shape(radius),
             {float(random.uniform(-60, 60)), float(100 + random.uniform(0, 3)), float(random.uniform(-8, 8))});
  }
  for (int i = 0; i < 200; ++i) /* a ring of small ones about the foot of the first: one body that touches hundreds */
    add_body(scene, BodyType::dynamic, sphere_shape(0.5f),
             {-50 + 10 * std::cos(0.0314159265f * float(i)), 0.5f, 10 * std::sin(0.0314159265f * float(i))});
  return scene;
}

/* A slab that rests on 400 cubes, four cells of two-stage batching wide and more. */
Scene slab_on_hundreds()
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(11, 0.25f, 11), {0, 1.25f, 0}).mass = 50;
  for (int i = 0; i < 400; ++i)
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f),
             {1.1f * float(i % 20) - 10.45f, 0.5f, 1.1f * float(i / 20) - 10.45f});
  return scene;
}

} // namespace

TEST_CASE("batching: no conflict whatever the sizes of bodies and the number of their contacts")
{
  const Batching batching = GENERATE(from_range(choices<Batching>()));
  CAPTURE(batching);
  World sizes(sizes_from_1_to_100(), batched_by(batching));
  run(sizes, 20);
  CHECK(Contacts(sizes).touching() > 200);
  CHECK_FALSE(sizes.batch_fault());

  World slab(slab_on_hundreds(), batched_by(batching));
  run(slab, 2);
  const Contacts contacts(slab);
  CHECK(contacts.touching() == 800);
  const auto overflow =
      std::count(contacts.color.begin(), contacts.color.end(), COLOR_OVERFLOW); /* a colour may be lost to the ground */
  CHECK(overflow >= 400 - COLOR_LIMIT);
  CHECK(overflow <= 402 - COLOR_LIMIT);
  CHECK_FALSE(slab.batch_fault());
}

TEST_CASE("batching: sequential and single-group are the batches of the talk")
{
  const Batching batching = GENERATE(Batching::sequential, Batching::single_group);
  for (const char *scene : {"mixed:n=150", "box-grid:nx=5,ny=5,nz=5", "pyramid-2d:n=500"}) {
    World world(load_scene(scene), batched_by(batching));
    run(world, 50);
    const Contacts contacts(world);
    CAPTURE(scene, batching);
    CHECK(contacts.touching() > 50);
    CHECK(contacts.color == batches_of_the_talk(contacts));
  }
}

TEST_CASE("batching: pyramid-2d has the talk's 31,602 contacts, and the oracle's batches")
{
  CHECK(pyramid_2d_contacts(1) == 1);
  CHECK(pyramid_2d_contacts(10631) == 31602);
  for (int n : {1, 2, 3, 5, 6, 28, 40}) {
    World world(load_scene("pyramid-2d:n=" + std::to_string(n)));
    world.keep_after_steps(Buffer::pair_a);
    world.step();
    CHECK(Contacts(world).touching() == pyramid_2d_contacts(uint64_t(n)));
  }
  World world(load_scene("pyramid-2d"), batched_by(Batching::sequential));
  world.step();
  const Contacts contacts(world);
  const std::vector<uint32_t> sizes = contacts.sizes();
  CHECK(contacts.touching() == 31602);
  CHECK(contacts.color == batches_of_the_talk(contacts));
  CHECK(std::accumulate(sizes.begin(), sizes.end(), 0u) == 31602);
}

TEST_CASE("batching: talk-3d has the talk's 3,008 boxes, and the oracle's batches")
{
  CHECK(load_scene("talk-3d").bodies.size() == 3008 + 1);
  World world(load_scene("talk-3d:ny=6"), batched_by(Batching::sequential));
  run(world, 70);
  const Contacts contacts(world);
  CHECK(contacts.touching() > 100);
  CHECK(contacts.color == batches_of_the_talk(contacts));
}

/* The same contacts, reached in ten steps and in none. */
TEST_CASE("batching: batches but for kept colours follow from the contacts alone")
{
  const Batching batching =
      GENERATE(Batching::sequential, Batching::single_group, Batching::iterative, Batching::two_stage);
  const Scene scene = load_scene("pyramid-2d:n=300");
  World world(scene, batched_by(batching)), fresh(scene, batched_by(batching));
  run(world, 10);
  const std::vector<BodyState> states = world.bodies();
  for (uint32_t i = 0; i < states.size(); ++i) fresh.set_body(i, states[i]);
  world.step();
  fresh.step();
  const Contacts reached(world), anew(fresh);
  CAPTURE(batching);
  CHECK(reached.touching() > 400);
  REQUIRE(reached.points == anew.points);
  CHECK(reached.color == anew.color);
  CHECK(reached.sizes().size() <= 11); /* six contacts at a body: twice as many less one, at most */
}

/* A column of cubes: two pairs a cube, with the ground's bounds and with the cube below; contact (k + 1, k) has colour
 * k % 2. */
TEST_CASE("batching: the check finds and names a planted conflict")
{
  const std::string backend = GENERATE("serial", "serial:order=backward", "tbb:threads=7,lanes=8");
  World world(load_scene("box-stack:n=10,height=10"), batched_by(Batching::sequential), {backend, {}});
  world.step();
  REQUIRE_FALSE(world.batch_fault());
  world.set_observer([&](const Launch &launch) {
    if (launch.kernel != Kernel::color_in_order) return;
    const Contacts contacts(world);
    REQUIRE(contacts.a[8] == 5);
    REQUIRE(contacts.color[8] == 0);
    const uint32_t planted = 1;
    world.memory().upload(Buffer::pair_color, &planted, sizeof planted, 8 * sizeof planted);
  });
  world.step();
  REQUIRE(world.batch_fault());
  const BatchFault fault = *world.batch_fault();
  CHECK(fault.conflict);
  CHECK(fault.step == 1);
  CHECK(fault.color == 1);
  CHECK(fault.body == 4);
  CHECK(fault.pair == std::array<uint32_t, 2>{4, 3});
  CHECK(fault.other == std::array<uint32_t, 2>{5, 4});
  CHECK(fault.constraints == 3);
  CHECK_THAT(describe(fault), ContainsSubstring("step 1: colour 1 touches body 4 twice, in pairs (4, 3) and (5, 4)"));
}

TEST_CASE("batching: the check finds a contact that no batch holds")
{
  World world(load_scene("pyramid:rows=5,gap=0.01"), batched_by(Batching::iterative));
  world.step();
  REQUIRE_FALSE(world.batch_fault());
  size_t at = 0;
  world.set_observer([&](const Launch &launch) {
    if (launch.kernel != Kernel::color_keys) return;
    const Contacts contacts(world);
    at = size_t(
        std::find_if(contacts.points.begin(), contacts.points.end(), [](uint32_t points) { return points > 0; }) -
        contacts.points.begin());
    const uint32_t planted = COLOR_INACTIVE;
    world.memory().upload(Buffer::sort_key, &planted, sizeof planted, at * sizeof planted);
  });
  world.step();
  REQUIRE(world.batch_fault());
  CHECK_FALSE(world.batch_fault()->conflict);
  CHECK(world.batch_fault()->constraints == 1);
  const Contacts contacts(world);
  REQUIRE(at < contacts.a.size());
  CHECK(world.batch_fault()->pair == std::array<uint32_t, 2>{contacts.a[at], contacts.b[at]});
  CHECK_THAT(describe(*world.batch_fault()), ContainsSubstring("does not stand"));
}
