/* The table in which bodies that are awake look for sleepers: where few fall asleep or wake it is changed in place, and
 * finds what one that was sorted anew finds. */
#include <map>

#include <tandem/world.h>

#include "host/base/random.h"
#include "host/runtime/interface/backend.h"
#include "tests/catch.h"
#include "tests/host/world/bodies.h"

using namespace tandem;

namespace {

constexpr uint32_t balls = 3;

/* Columns of two boxes of a metre on a floor, 3 m apart, and balls that lie beside them; the last box is a long one, so
 * that it stands among the large sleepers. */
Scene columns_and_balls(uint32_t columns)
{
  Scene scene;
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.25f), box_shape(9, 0.5f, 0.5f)};
  scene.bodies.resize(1 + 2 * columns + balls + 1);
  scene.bodies[0].type = BodyType::fixed;
  for (uint32_t k = 0; k < 2 * columns; ++k) {
    scene.bodies[1 + k].shape = 1;
    scene.bodies[1 + k].position = {3.0 * (k / 2), 0.5 + k % 2, 0};
  }
  for (uint32_t k = 0; k < balls; ++k) {
    scene.bodies[1 + 2 * columns + k].shape = 2;
    scene.bodies[1 + 2 * columns + k].position = {3.0 * k, 0.25, 20};
  }
  scene.bodies.back().shape = 3;
  scene.bodies.back().position = {9, 0.5, -20};
  return scene;
}

struct Seen {
  std::map<Kernel, uint32_t> launches;
  uint32_t fell = 0, woke = 0;

  void watch(World &world)
  {
    world.set_observer([this](const Launch &launch) { ++launches[launch.kernel]; });
  }
  void step(World &world)
  {
    world.step();
    for (const SleepEvent &event : world.sleep_events()) ++(event.asleep ? fell : woke);
  }
};

void step_until_asleep(World &world, Seen &seen)
{
  const uint32_t all = static_cast<uint32_t>(world.scene().bodies.size()) - 1;
  for (int k = 0; k < 300 && world.statistics().asleep < all; ++k) seen.step(world);
  REQUIRE(world.statistics().asleep == all);
}

/* Balls fall on columns drawn at random, or on the long box: what lies there wakes. */
void throw_ball(World &world, Random &random, uint32_t columns, int turn)
{
  const double column = random.below(columns);
  const Point place = turn % 4 == 3 ? Point{9 + column / 8, 1.5, -20} : Point{3 * column, 2.5, 0};
  world.set_state(world.id_of(1 + 2 * columns + static_cast<uint32_t>(turn) % balls),
                  {place, {0, 0, 0, 1}, {0, -3, 0}, {0, 0, 0}});
}

} // namespace

TEST_CASE("a table of sleepers that was changed finds what one finds that was sorted anew", "[sanitizer]")
{
  constexpr uint32_t columns = 24;
  for (const std::string backend : {"serial", "tbb:threads=2,lanes=4"}) {
    CAPTURE(backend);
    Seen seen;
    World world(columns_and_balls(columns), sleepy(), {backend, {}});
    seen.watch(world);
    step_until_asleep(world, seen);
    Random random(7);
    int turn = 0;
    for (int part = 0; part < 20; ++part) {
      World sorted(world.save(), {backend, {}});
      for (int step = 0; step < 45; ++step) {
        CAPTURE(part, step);
        if (step % 15 == 0) {
          Random same = random;
          throw_ball(world, random, columns, turn);
          throw_ball(sorted, same, columns, turn++);
        }
        seen.step(world);
        sorted.step();
        REQUIRE(world.state_hash() == sorted.state_hash());
      }
    }
    CHECK(seen.woke > 60);
    CHECK(seen.fell > 100);
    CHECK(seen.launches[Kernel::renumber_sleepers] > 10);
    CHECK(seen.launches[Kernel::append_sleepers] > 10);
    CHECK(seen.launches[Kernel::sleeper_keys] < 5);
  }
}

TEST_CASE("few that fall asleep or wake among many do not sort them all", "[sanitizer]")
{
  Seen seen;
  World world(columns_and_balls(30), sleepy(), {"serial", {}});
  seen.watch(world);
  step_until_asleep(world, seen);
  const auto sorts = [&] { return seen.launches[Kernel::sleeper_keys]; };
  const uint32_t at_first = sorts();
  for (uint32_t turn = 0; turn < 100; ++turn) {
    for (uint32_t k = 0; k < 3; ++k) world.wake_body(world.id_of(1 + 2 * ((turn + 10 * k) % 30)));
    seen.step(world);
    step_until_asleep(world, seen);
    if (turn < 30) CHECK(sorts() == at_first + 1);
  }
  CHECK(sorts() > at_first + 1); /* six bodies a turn are more than stay unsorted */
  CHECK(sorts() < at_first + 5);
}
