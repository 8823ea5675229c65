/* Every broadphase finds the pairs that brute force finds, hence the same bits. */
#include "tests/catch.h"

#include "host/scene_catalog.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Radii from 1 cm to 10 m, and a few bodies in one place. */
Scene many_sizes()
{
  Scene scene = empty_scene();
  add_ground(scene);
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const float size = float(0.01 * std::pow(1000.0, random.uniform()));
    const float reach = 15;
    const Point place{random.uniform(-reach, reach), 0.5 + random.uniform(0, 2 * reach), random.uniform(-reach, reach)};
    Body &body = add_body(scene, Motion::dynamic, i % 2 ? sphere_shape(size) : box_shape(size, 0.3f * size, 0.6f * size), place);
    body.mass = 1000 * size * size * size;
    body.orientation = random.orientation();
    body.linear_velocity = {float(random.uniform(-5, 5)), 0, float(random.uniform(-5, 5))};
  }
  return scene;
}

/* All centres in one plane, or all in one point: two axes or all three have no extent. */
Scene flat(bool one_point)
{
  Scene scene = empty_scene({0, 0, 0});
  for (int i = 0; i < 40; ++i) {
    const Point place = one_point ? Point{1, 2, 3} : Point{0.9f * float(i % 8), 0, 0.9f * float(i / 8)};
    add_body(scene, Motion::dynamic, i % 3 ? box_shape(0.5f, 0.4f, 0.5f) : sphere_shape(0.5f), place);
  }
  return scene;
}

/* Bodies without neighbours, one on its own at a kilometre. */
Scene scattered()
{
  Scene scene = empty_scene();
  for (int i = 0; i < 50; ++i) add_body(scene, Motion::dynamic, sphere_shape(0.5f), {3.0f * float(i), 0, float(i % 7)});
  add_body(scene, Motion::dynamic, sphere_shape(0.5f), {1000, 1000, -1000});
  return scene;
}

Scene scene_of(const std::string &name)
{
  if (name == "many sizes") return many_sizes();
  if (name == "flat") return flat(false);
  if (name == "one point") return flat(true);
  if (name == "scattered") return scattered();
  return load_scene(name);
}

std::vector<uint64_t> hashes_with(const std::string &broadphase, const Scene &scene)
{
  Settings settings;
  settings.broadphase = broadphase;
  World world(scene, settings);
  std::vector<uint64_t> hashes;
  for (int i = 0; i < 30; ++i) {
    world.step();
    hashes.push_back(world.state_hash());
  }
  CHECK(all_finite(world.bodies()));
  return hashes;
}

} // namespace

TEST_CASE("brute force, sweep and grid give the same bits", "[physics]")
{
  const std::string name = GENERATE("box-grid:nx=5,ny=5,nz=5", "falling-boxes:n=150", "mixed:n=200", "spheres:n=200", "pyramid:rows=8", "many sizes",
                                    "flat", "one point", "scattered");
  CAPTURE(name);
  const Scene scene = scene_of(name);
  const std::vector<uint64_t> oracle = hashes_with("brute-force", scene);
  CHECK(hashes_with("sap", scene) == oracle);
  CHECK(hashes_with("grid", scene) == oracle);
}
