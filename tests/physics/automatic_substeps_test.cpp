/* Worlds that choose their substeps: loads and stacks get as many as they need, others the bits of four. */
#include <algorithm>
#include <bit>
#include <cmath>

#include "host/catalog/catalog.h"
#include "host/pipeline/substep_choice.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Settings automatic(double step = 1.0 / 60) { return settings_with(step, automatic_substeps); }

/* Cubes of 1 m on one another on the ground, from the lowest. */
Scene column_of(const std::vector<float> &masses)
{
  Scene scene = load_scene("box-stack:n=" + std::to_string(masses.size()) + ",height=" + std::to_string(masses.size()));
  for (size_t i = 0; i < masses.size(); ++i) scene.bodies[i + 1].mass = masses[i];
  return scene;
}

/* m: how much lower the highest cube is than at the start. */
double sunk(World &world, const Scene &scene)
{
  return scene.bodies.back().position[1] - world.bodies().back().position[1];
}

uint32_t bits_of(float x) { return std::bit_cast<uint32_t>(x); }

} // namespace

TEST_CASE("automatic substeps: a load of a thousand to one stands, and gets what its sink under gravity needs",
          "[physics]")
{
  const Scene scene = column_of({1, 1000});
  World chosen(scene, automatic(), {}), four(scene, settings_with(1.0 / 60), {});
  run(chosen, 300);
  run(four, 300);
  CHECK(sunk(four, scene) > 0.5); /* the light cube has left */
  CHECK(sunk(chosen, scene) < 0.04);
  /* load / effective mass = 10,010 m/s^2 may sink by two slops: 796 substeps a second and more */
  CHECK(chosen.statistics().substeps == 16);
}

TEST_CASE("automatic substeps: a tall column stands from the first step on", "[physics]")
{
  const Scene scene = column_of(std::vector<float>(60, 1));
  World world(scene, automatic(), {});
  world.step();
  CHECK(world.statistics().substeps == 16); /* 60^3 layers buckle below 539 substeps a second */
  run(world, 200);
  CHECK(sunk(world, scene) < 60 * 0.005);
}

TEST_CASE("automatic substeps: what needs no more than four has their bits", "[physics]")
{
  const char *name = GENERATE("box-grid:nx=5,ny=5,nz=5", "falling-boxes:n=60,height=0", "box-stack:n=40,height=10");
  World chosen(load_scene(name), automatic(), {}), four(load_scene(name), settings_with(1.0 / 60), {});
  run(chosen, 60);
  run(four, 60);
  CAPTURE(name);
  CHECK(chosen.statistics().substeps == 4);
  CHECK(chosen.body_hash() == four.body_hash());
}

TEST_CASE("automatic substeps: they become fewer when the load has gone", "[physics]")
{
  World world(column_of({1, 1000}), automatic(), {});
  run(world, 5);
  REQUIRE(world.statistics().substeps == 16);
  const std::vector<BodyId> ids = world.body_ids();
  world.destroy_body(ids.back());
  run(world, 61);
  CHECK(world.statistics().substeps == 8);
  run(world, 61);
  CHECK(world.statistics().substeps == 4);
}

TEST_CASE("automatic substeps: a restored world and one that went back go on with the same bits", "[physics]")
{
  World world(column_of({1, 1000}), automatic(), {});
  world.keep_states(2);
  run(world, 10);
  World restored(world.save(), Placement{});
  run(world, 20);
  run(restored, 20);
  CHECK(restored.state_hash() == world.state_hash());
  world.go_back(1);
  world.step();
  CHECK(restored.state_hash() == world.state_hash());
}

TEST_CASE("automatic substeps: bodies made after going back know nothing of those that stood in their places",
          "[physics]")
{
  const Scene scene = column_of({1});
  const auto cube = [&](double height, float mass) {
    Body body;
    body.shape = scene.bodies.back().shape;
    body.position = {5, height, 0};
    body.mass = mass;
    return body;
  };
  World detour(scene, automatic(), {}), straight(scene, automatic(), {});
  for (World *world : {&detour, &straight}) {
    world->create_body(cube(20, 1)); /* makes room for those to come */
    world->keep_states(20);
    run(*world, 3);
  }
  detour.create_bodies(std::vector<Body>{cube(0.5, 1), cube(1.5, 1000)});
  run(detour, 6);
  CHECK(detour.statistics().substeps > 4);
  detour.go_back(6);
  for (World *world : {&detour, &straight}) {
    world->create_bodies(std::vector<Body>{cube(1.5, 1), cube(0.5, 1), cube(2.5, 1)});
    run(*world, 3);
  }
  CHECK(detour.statistics().substeps == 4);
  CHECK(detour.state_hash() == straight.state_hash());
}

TEST_CASE("automatic substeps: a world that allows no depth is judged by the usual one", "[physics]")
{
  for (const float slop_share : {0.05f, 0.0f}) {
    Settings settings = automatic();
    settings.slop = 0;
    settings.slop_share = slop_share;
    const Scene scene = column_of({1, 1000});
    World world(scene, settings, {});
    run(world, 10);
    CHECK(world.statistics().substeps == 16);
  }
}

TEST_CASE("automatic substeps: raised to what bears the rate, and halved after a second of calm", "[physics]")
{
  SubstepChoice choice = first_choice(automatic());
  Settings settings = automatic();
  settings.step = 1.0f / 64;
  raise_substeps(choice, bits_of(1000.0f * 1000.0f), settings);
  CHECK(choice.now == 16); /* 1024 a second */
  CHECK(choice.of_cache == 4);
  raise_substeps(choice, bits_of(1e20f), settings);
  CHECK(choice.now == most_automatic_substeps);
  for (int i = 0; i < 63; ++i) settle_substeps(choice, bits_of(1000.0f * 1000.0f), settings);
  CHECK(choice.now == 64);
  settle_substeps(choice, bits_of(1000.0f * 1000.0f), settings);
  CHECK(choice.now == 32);
  CHECK(choice.of_cache == 64);
}

TEST_CASE("automatic substeps: an attempt that had enough leaves the second of calm", "[physics]")
{
  SubstepChoice choice = first_choice(automatic());
  Settings settings = automatic();
  settings.step = 1.0f / 64;
  raise_substeps(choice, bits_of(1000.0f * 1000.0f), settings);
  for (int i = 0; i < 63; ++i) settle_substeps(choice, bits_of(500.0f * 500.0f), settings);
  raise_substeps(choice, bits_of(1000.0f * 1000.0f), settings);
  CHECK(choice.now == 16);
  settle_substeps(choice, bits_of(500.0f * 500.0f), settings);
  CHECK(choice.now == 8);
}

TEST_CASE("automatic substeps: the hash of a choice is of all that decides the next ones", "[physics]")
{
  const SubstepChoice first = first_choice(automatic());
  std::vector<SubstepChoice> others(5, first);
  others[0].starts = false;
  others[1].now = 8;
  others[2].of_cache = 8;
  others[3].calm_steps = 1;
  others[4].layers_at_start = 17;
  for (const SubstepChoice &other : others) CHECK(hash_choice(other, 5) != hash_choice(first, 5));
  CHECK(hash_choice(first_choice(settings_with(1.0 / 60)), 5) == 5); /* told, as it always was */
}

TEST_CASE("automatic substeps: four bear less in short steps, whose contacts are softer than they could be",
          "[physics]")
{
  Settings settings = automatic();
  settings.step = 1.0f / 240;
  SubstepChoice choice = first_choice(settings);
  raise_substeps(choice, bits_of(299.0f * 299.0f), settings);
  CHECK(choice.now == 4);
  raise_substeps(choice, bits_of(301.0f * 301.0f), settings);
  CHECK(choice.now == 8);
}

TEST_CASE("automatic substeps: a tower of planks that the world starts with comes to rest", "[physics]")
{
  const Scene scene = load_scene("tower");
  const auto farthest_sideways = [&](World &world) {
    double farthest = 0;
    const std::vector<BodyState> bodies = world.bodies();
    for (size_t i = 0; i < bodies.size(); ++i)
      for (const size_t axis : {0, 2})
        farthest = std::max(farthest, std::abs(double(bodies[i].position[axis]) - scene.bodies[i].position[axis]));
    return farthest;
  };
  World chosen(scene, automatic(), {}), four(scene, settings_with(1.0 / 60), {});
  run(chosen, 200);
  run(four, 200);
  CHECK(chosen.statistics().substeps == 16); /* 17 layers of planks that rest on three: 578 substeps a second */
  CHECK(farthest_sideways(chosen) < 0.001);
  CHECK(farthest_sideways(four) > 0.005);
}

TEST_CASE("automatic substeps: layers that did not stand at the start do not count as a structure", "[physics]")
{
  SubstepChoice choice = first_choice(automatic());
  CHECK(choice.starts);
  note_start(choice, 17);
  settle_substeps(choice, 0, automatic());
  note_start(choice, 30);
  CHECK(choice.layers_at_start == 17);
}

TEST_CASE("automatic substeps: layers of large boxes, which sway by little of their size, keep the bits of four",
          "[physics]")
{
  const Scene scene = load_scene("box-grid:nx=4,ny=20,nz=4");
  World chosen(scene, automatic(), {}), four(scene, settings_with(1.0 / 60), {});
  run(chosen, 20);
  run(four, 20);
  CHECK(chosen.statistics().substeps == 4);
  CHECK(chosen.body_hash() == four.body_hash());
}

TEST_CASE("automatic substeps: contacts asked for stiffer than the default get as many as these act with", "[physics]")
{
  const auto fewest = [](float hertz) {
    Settings settings = automatic();
    settings.contact_hertz = hertz;
    return first_choice(settings).now;
  };
  CHECK(fewest(6) == 4);
  CHECK(fewest(60) == 4);
  CHECK(fewest(600) == 64); /* 50 and more */
  CHECK(fewest(6000) == 512);
  CHECK(fewest(600000) == 512); /* no world takes more */
  Settings stiff = automatic();
  stiff.contact_hertz = 6000;
  SubstepChoice choice = first_choice(stiff);
  raise_substeps(choice, bits_of(1e20f), stiff);
  CHECK(choice.now == 512);
  for (int i = 0; i < 600; ++i) settle_substeps(choice, 0, stiff);
  CHECK(choice.now == 512);
}

TEST_CASE("automatic substeps: a world that asks for stiff contacts goes on from a snapshot with the same bits",
          "[physics]")
{
  Settings stiff = automatic();
  stiff.contact_hertz = 1000;
  World world(column_of({1, 1}), stiff, {});
  run(world, 5);
  World restored(world.save(), Placement{});
  run(world, 5);
  run(restored, 5);
  CHECK(world.statistics().substeps == 128);
  CHECK(restored.state_hash() == world.state_hash());
}

TEST_CASE("automatic substeps: bodies inside one another part no faster beside a load that wants many", "[physics]")
{
  const Scene load = column_of({1, 1000});
  const auto parted_in_a_step = [&](const Settings &settings) {
    Scene scene = load;
    Body cube = scene.bodies[1];
    for (const double x : {5.0, 5.98}) { /* 2 cm inside one another */
      cube.position = {x, 0.5, 0};
      scene.bodies.push_back(cube);
    }
    World world(scene, settings, {});
    world.step();
    return world.bodies()[4].position[0] - world.bodies()[3].position[0] - 0.98;
  };
  const double with_four = parted_in_a_step(settings_with(1.0 / 60));
  Settings as_stiff = settings_with(1.0 / 60, 16);
  as_stiff.contact_hertz = 192;
  CHECK(with_four > 0.001);
  CHECK(parted_in_a_step(as_stiff) > 2 * with_four);
  CHECK(parted_in_a_step(automatic()) < 1.1 * with_four);
}

TEST_CASE("automatic substeps: a top sinks no deeper than it falls while it turns by a radian", "[physics]")
{
  const Scene scene = load_scene("tops"); /* 100 rad/s */
  const auto deepest = [&](uint32_t substeps) {
    World world(scene, settings_with(1e-3, substeps), {});
    double depth = 0;
    for (int step = 0; step < 1000; ++step) {
      world.step();
      depth = std::max(depth, double{world.statistics().max_penetration});
    }
    return depth;
  };
  CHECK(deepest(4) > 2e-3);
  CHECK(deepest(automatic_substeps) < 1.5 * 10 / (2 * 100.0 * 100.0)); /* under its weight a little deeper */
}

TEST_CASE("automatic substeps are refused to solvers that do not choose", "[physics]")
{
  Settings settings = automatic();
  settings.solver = Solver::pgs;
  CHECK_THROWS_AS(validate(settings), InputError);
}
