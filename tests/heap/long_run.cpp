/* long_run.cpp - a world in which bodies come and go, sleep and wake for a hundred thousand steps takes no more memory
 * at the end than it took after the first tenth. */
#include <algorithm>
#include <deque>

#include <malloc.h>

#include <tandem/world.h>

#include "host/base/random.h"
#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tests/heap/allocations.h"

using namespace tandem;
using namespace tests::heap;

namespace {

Scene yard()
{
  Scene scene;
  scene.name = "yard";
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.25f)};
  scene.bodies.resize(1);
  scene.bodies[0].type = BodyType::fixed;
  return scene;
}

/* One call of a program's, on bodies of which at most six exist. */
void call(World &world, std::deque<BodyId> &bodies, Random &random)
{
  const auto any = [&] { return bodies[random.below(static_cast<uint32_t>(bodies.size()))]; };
  switch (bodies.empty() ? 0 : random.below(5)) {
  case 0: {
    Body body;
    body.shape = 1 + random.below(2);
    body.position = {1.5 * random.below(3), 2, 0};
    bodies.push_back(world.create_body(body));
    break;
  }
  case 1: world.add_impulse(any(), {.impulse = {0, 1, 0}}); break;
  case 2: world.wake_body(any()); break;
  case 3: world.shapes_of(any()); break;
  default: break;
  }
  if (bodies.size() <= 6) return;
  world.destroy_body(bodies.front());
  bodies.pop_front();
}

/* What the world and the heap hold at most over some steps. */
struct Most {
  int64_t blocks = 0;
  size_t heap_bytes = 0, buffer_bytes = 0, slots = 0;
  uint32_t fell_asleep = 0, woke = 0;

  void note(World &world)
  {
    blocks = std::max(blocks, held());
    heap_bytes = std::max(heap_bytes, ::mallinfo2().uordblks);
    buffer_bytes = std::max(buffer_bytes, world.memory().total_bytes());
    slots = std::max(slots, world.scene().bodies.size());
    for (const SleepEvent &event : world.sleep_events()) ++(event.asleep ? fell_asleep : woke);
  }
};

Most run(World &world, std::deque<BodyId> &bodies, Random &random, int steps)
{
  Most most;
  for (int k = 0; k < steps; ++k) {
    if (random.below(20) == 0) call(world, bodies, random);
    world.step();
    world.contact_events();
    most.note(world);
  }
  return most;
}

} // namespace

TEST_CASE("heap: a world of a hundred thousand steps does not grow")
{
  Settings settings;
  settings.sleeping = settings.events = true;
  settings.sleep_time = 0.1f;
  settings.substeps = 1;
  World world(yard(), settings, {"serial", {}});
  std::deque<BodyId> bodies;
  Random random(7);
  const Most first = run(world, bodies, random, 10'000);
  run(world, bodies, random, 80'000);
  const Most last = run(world, bodies, random, 10'000);
  CHECK(first.fell_asleep > 100);
  CHECK(last.woke > 100);
  CHECK(last.buffer_bytes == first.buffer_bytes);
  CHECK(last.slots == first.slots);
  CHECK(last.blocks <= first.blocks + first.blocks / 20);
  CHECK(last.heap_bytes <= first.heap_bytes + first.heap_bytes / 20);
}
