/* settled_colors_test.cpp - where contacts keep their colours, a step launches no rounds of colouring and no colour to
 * spare, and what hits such a pile moves it as it would have moved any. */
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/pipeline/solvers/solvers.h"
#include "host/pipeline/step.h"
#include "host/runtime/launcher.h"
#include "host/runtime/memory.h"
#include "shared/batching/limits.h"
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

/* Each lays out buffers anew, or finds out anew which kernels and buffers are needed. */
const std::vector<std::pair<const char *, std::function<void(World &)>>> new_layouts = {
    {"a body more than there is room for", [](World &world) { world.create_body(box_onto_pile()); }},
    {"room for pairs", [](World &world) { world.reserve_pairs(5000); }},
    {"less room",
     [](World &world) {
       world.reserve_pairs(5000);
       world.shrink_to_fit();
     }},
    {"the first force", [](World &world) { world.add_force(world.id_of(0), {}); }},
    {"damping", [](World &world) { world.set_damping(world.id_of(0), 0.1f, 0); }},
    {"a material that bounces",
     [](World &world) {
       Material bouncing;
       bouncing.restitution = 0.5f;
       world.set_material(world.id_of(0), world.add_material(bouncing));
     }},
};

TEST_CASE("a layout anew while nothing meets keeps the room for contacts to come", "[address]")
{
  for (const auto &[what, lay_out] : new_layouts)
    for (const char *backend : {"serial", "tbb:threads=2,lanes=8"}) {
      CAPTURE(what, backend);
      World world(balls_that_meet(), {}, {backend, {}}), other(balls_that_meet(), {}, {"serial", {}});
      step_world(world, 80);
      step_world(other, 80);
      World fresh(other.save(), {"serial", {}}); /* which takes nothing for granted */
      lay_out(world);
      lay_out(fresh);
      CHECK(world.memory().bytes(Buffer::manifold_points) > 0);
      for (int k = 0; k < 160; ++k) {
        world.step();
        fresh.step();
        REQUIRE(world.state_hash() == fresh.state_hash());
      }
      CHECK(world.statistics().steps == 240);
    }
}

TEST_CASE("limits of a step that took colours for granted count what is needed, and nothing else")
{
  Scene near = balls_that_meet();
  near.bodies.resize(2);
  near.shapes = {sphere_shape(0.5f)};
  for (int k : {0, 1}) {
    near.bodies[static_cast<size_t>(k)].shape = 0;
    near.bodies[static_cast<size_t>(k)].linear_velocity = {};
    near.bodies[static_cast<size_t>(k)].position = {5.0 * k, 0, 0};
  }
  World world(near);
  step_world(world, 80);
  BodyState beside = world.bodies()[1];
  beside.position = {0.9, 0.9, 0.9}; /* the boxes overlap, the balls do not touch */
  world.set_body(1, beside);
  StepLimits limits;
  limits.rounds = 0;
  world.step(limits);
  CHECK(world.statistics().pairs == 1);
  CHECK(world.statistics().contacts == 0);
}

/* A plate on the ground, which moves, and balls that lie on it apart from each other; the plate comes first. */
Scene balls_on_plate()
{
  Scene scene;
  scene.shapes = {box_shape(4, 0.2f, 4), sphere_shape(0.3f), half_space_shape()};
  Body ground;
  ground.type = BodyType::fixed;
  ground.shape = 2;
  scene.bodies.push_back(ground);
  Body plate;
  plate.position = {0, 0.2, 0};
  plate.mass = 1000;
  scene.bodies.push_back(plate);
  for (int k = 0; k < 25; ++k) {
    Body ball;
    ball.shape = 1;
    ball.position = {1.4 * (k % 5 - 2), 0.7, 1.4 * (k / 5 - 2)};
    scene.bodies.push_back(ball);
  }
  return scene;
}

TEST_CASE("contacts take the lower colours that others have left", "[sanitizer]")
{
  for (const char *backend : {"serial", "tbb:threads=2"}) {
    Settings settings;
    settings.check = true;
    World world(balls_on_plate(), settings, {backend, {}});
    const std::vector<BodyId> ids = world.body_ids();
    step_world(world, 10);
    REQUIRE(world.statistics().colors == 26);
    world.destroy_bodies(std::span(ids).subspan(2, 21));
    step_world(world, 12); /* of each body one contact a step */
    CHECK(world.statistics().contacts == 4 + 4);
    CHECK(world.statistics().colors <= KEPT_COLORS);
    CHECK(!world.batch_fault());
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
