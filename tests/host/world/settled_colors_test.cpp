/* settled_colors_test.cpp - where contacts keep their colours, a step launches no rounds of colouring and no colour to
 * spare, and what hits such a pile moves it as it would have moved any. */
#include <memory>
#include <string>

#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/pipeline/solvers/solvers.h"
#include "host/pipeline/step.h"
#include "host/runtime/launcher.h"
#include "tests/catch.h"

namespace tandem {
namespace {

const std::string settling_pile = "pyramid:rows=5";

struct ColorLaunches {
  uint32_t rounds = 0, passes = 0;
};

ColorLaunches color_launches_of(World &world)
{
  ColorLaunches launches;
  world.set_observer([&](const Launch &launch) {
    if (launch.kernel == Kernel::color_bid) ++launches.rounds;
    if (launch.kernel == Kernel::solve_contacts) ++launches.passes;
  });
  world.step();
  world.set_observer({});
  return launches;
}

void step_world(World &world, int steps)
{
  for (int k = 0; k < steps; ++k) world.step();
}

Body box_onto_pile()
{
  Body box;
  box.position = {0.1, 6, 0.05};
  box.linear_velocity = {0, -8, 0};
  box.angular_velocity = {1, 0, 2};
  return box;
}

TEST_CASE("a settled pile launches the colours that it has, and colours nothing")
{
  World world(load_scene(settling_pile));
  step_world(world, 20);
  const ColorLaunches early = color_launches_of(world);
  const uint32_t colors = world.statistics().colors;
  REQUIRE(colors > 2);
  CHECK(early.rounds >= 4);
  CHECK(early.passes % (colors + 1) == 0);
  step_world(world, 300);
  const ColorLaunches late = color_launches_of(world);
  REQUIRE(world.statistics().colors == colors);
  CHECK(late.rounds == 0);
  CHECK(late.passes == early.passes / (colors + 1) * colors);
}

TEST_CASE("a settled pile that is hit has the bits of one that never took its colours for granted", "[sanitizer]")
{
  for (const char *backend : {"serial", "tbb:threads=2,lanes=4"}) {
    Settings settings;
    settings.check = true;
    World settled(load_scene(settling_pile), settings, {backend, {}});
    auto other = std::make_unique<World>(load_scene(settling_pile), settings, Placement{backend, {}});
    for (int k = 0; k < 400; ++k) {
      if (k == 300)
        for (World *world : {&settled, other.get()}) world->create_body(box_onto_pile());
      settled.step();
      other->step();
      if (k % 20 == 0) other = std::make_unique<World>(other->save(), Placement{backend, {}});
      REQUIRE(settled.state_hash() == other->state_hash());
    }
    CHECK(!settled.batch_fault());
    CHECK(settled.statistics().pairs > 0);
  }
}

/* Balls in two rows that pass through nothing for two seconds and then meet. */
Scene balls_that_meet()
{
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.shapes = {sphere_shape(0.5f), box_shape(0.4f, 0.3f, 0.5f)};
  for (int k = 0; k < 6; ++k) {
    Body body;
    body.shape = static_cast<uint32_t>(k % 2);
    body.position = {2.5 * (k / 2), k % 2 ? 5.0 : 0.0, 0.1 * k};
    body.linear_velocity = {0, k % 2 ? -1.0f : 1.0f, 0};
    scene.bodies.push_back(body);
  }
  return scene;
}

TEST_CASE("where no bounds have overlapped for long, a step finds pairs alone, and the bits of what meets are the same")
{
  for (const Solver solver : {Solver::soft_step, Solver::nncg, Solver::xpbd, Solver::avbd, Solver::jacobi}) {
    const Settings settings = settings_for(solver);
    World world(balls_that_meet(), settings);
    auto other = std::make_unique<World>(balls_that_meet(), settings);
    uint64_t early = 0, late = 0;
    bool met = false;
    for (int k = 0; k < 240; ++k) {
      const uint64_t before = world.launches();
      world.step();
      if (k == 30) early = world.launches() - before;
      if (k == 90) late = world.launches() - before;
      met = met || world.statistics().contacts > 0;
      REQUIRE((k > 90 || !met));
      other->step();
      if (k % 20 == 0) other = std::make_unique<World>(other->save());
      REQUIRE(world.state_hash() == other->state_hash());
    }
    CHECK(met);
    CHECK(late < early);
  }
}

TEST_CASE("a scene that was wrongly taken for settled waits twice as long before it is again")
{
  SettledColors settled;
  const uint32_t wait = settled.wait;
  for (uint32_t k = 0; k <= wait; ++k) {
    CHECK(!settled.are_kept());
    settled.note_step(0, 3);
  }
  CHECK(settled.are_kept());
  settled.note_repetition();
  settled.note_step(2, 4);
  CHECK(settled.wait == 2 * wait);
  for (uint32_t k = 0; k < 2 * wait; ++k) {
    CHECK(!settled.are_kept());
    settled.note_step(0, 4);
  }
  CHECK(settled.are_kept());
  settled.note_step(0, 5);
  CHECK(!settled.are_kept());
  settled.note_repetition();
  CHECK(settled.wait == 2 * wait);
}

} // namespace
} // namespace tandem
