/* Shapes that are added to bodies and removed from them while a world runs. */
#include <cmath>

#include <tandem/world.h>

#include "host/base/random.h"
#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tests/host/runtime/opencl/pocl.h"
#include "tests/host/world/bodies.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

Child child_at(const Shape &shape, const Vec3 &position)
{
  Child child;
  child.shape = shape;
  child.position = position;
  return child;
}

Scene yard(const Vec3 &gravity)
{
  Scene scene;
  scene.name = "yard";
  scene.gravity = gravity;
  scene.shapes = {sphere_shape(0.5f), box_shape(0.5f, 0.5f, 0.5f), box_shape(20, 1, 20)};
  scene.bodies = {body_at({0, -1, 0}, 2)};
  scene.bodies[0].type = BodyType::fixed;
  return scene;
}

void run(World &world, int steps)
{
  for (int k = 0; k < steps; ++k) world.step();
}

} // namespace

TEST_CASE("a shape that is added moves the centre of mass, and momentum goes on at the density", "[sanitizer]")
{
  Scene scene = yard({0, 0, 0});
  scene.bodies.push_back(body_at({0, 5, 0}, 1));
  scene.bodies[1].mass = 2;
  scene.bodies[1].linear_velocity = {1, 0, 0};
  scene.bodies[1].angular_velocity = {0, 0, 3};
  World world(scene, {}, {"serial", {}});
  world.step();
  const BodyId box = world.id_of(1);
  const BodyState before = world.read_body(box);
  /* a cube of the same size beside it, at its +x face: the centre goes half a metre along the body's x */
  const ShapeId added = world.add_shape_to(box, child_at(scene.shapes[1], {1, 0, 0}));
  const BodyState after = world.read_body(box);
  const double angle = 2 * std::atan2(before.orientation[2], before.orientation[3]);
  CHECK(world.body_description(box).mass == 4);
  CHECK(after.position[0] == Approx(before.position[0] + 0.5 * std::cos(angle)));
  CHECK(after.position[1] == Approx(before.position[1] + 0.5 * std::sin(angle)));
  CHECK(after.linear_velocity[0] == Approx(1 - 3 * 0.5 * std::sin(angle)));
  CHECK(after.linear_velocity[1] == Approx(3 * 0.5 * std::cos(angle)));
  const double moment = 4 * (1 + 4) / 12.0; /* of a box of 2 by 1 about z */
  world.add_impulse(box, {{}, {0, 0, 1}});
  CHECK(world.read_body(box).angular_velocity[2] == Approx(3 + 1 / moment).epsilon(1e-5));
  CHECK(world.shapes_of(box).size() == 2);
  CHECK(world.shapes_of(box)[1] == added);
  CHECK(world.body_of(added) == box);
  /* taken away again, everything is as it would have been */
  world.add_impulse(box, {{}, {0, 0, -1}});
  world.remove_shape(added);
  const BodyState again = world.read_body(box);
  CHECK(world.body_description(box).mass == 2);
  for (size_t k = 0; k < 3; ++k) {
    CHECK(again.position[k] == Approx(before.position[k]).margin(1e-6));
    CHECK(again.linear_velocity[k] == Approx(before.linear_velocity[k]).margin(1e-5));
  }
}

TEST_CASE("mass properties that the user has given stay when a shape is added", "[sanitizer]")
{
  Scene scene = yard({0, 0, 0});
  scene.bodies.push_back(body_at({0, 5, 0}, 1));
  scene.bodies[1].inertia = {1, 2, 3};
  World world(scene, {}, {"serial", {}});
  const BodyId box = world.id_of(1);
  world.add_shape_to(box, child_at(sphere_shape(0.5f), {2, 0, 0}));
  CHECK(world.read_body(box).position == Point{0, 5, 0});
  CHECK(world.body_description(box).mass == 1);
  CHECK(world.body_description(box).inertia == Vec3{1, 2, 3});
}

TEST_CASE("a body stands on a foot that is added, and comes down when it is removed", "[sanitizer]")
{
  Scene scene = yard({0, -10, 0});
  scene.bodies.push_back(body_at({0, 2.5, 0}, 1));
  scene.bodies.push_back(body_at({5, 0.5, 0}, 1)); /* of the same shape; nothing happens to it */
  World world(scene, {}, {"serial", {}});
  const BodyId box = world.id_of(1);
  const ShapeId foot = world.add_shape_to(box, child_at(box_shape(0.5f, 0.5f, 0.5f), {0, -1, 0}));
  run(world, 120);
  CHECK(world.read_body(box).position[1] == Approx(1).margin(0.01)); /* the middle of the two */
  CHECK(world.bodies()[2].position[1] == Approx(0.5).margin(0.01));
  world.remove_shape(foot);
  CHECK(world.read_body(box).position[1] == Approx(1.5).margin(0.01));
  run(world, 120);
  CHECK(world.read_body(box).position[1] == Approx(0.5).margin(0.01));
  CHECK(world.cast_rays(std::vector<Ray>{{{0, 1.2, 9}, {0, 0, -20}, 1, {}}}).front().body == no_body);
}

TEST_CASE("what shapes cannot do is refused and changes nothing", "[sanitizer]")
{
  World world(yard({0, 0, 0}), {}, {"serial", {}});
  const BodyId ball = world.create_body(body_at({0, 5, 0}));
  const ShapeId only = world.shapes_of(ball).front();
  const uint64_t hash = world.state_hash();
  CHECK_THROWS_WITH(world.remove_shape(only), ContainsSubstring("remove_shapes: body 1 would have no shape"));
  CHECK_THROWS_WITH(world.add_shape_to(ball, child_at(sphere_shape(-1), {})), ContainsSubstring("radius is -1"));
  CHECK_THROWS_WITH(world.add_shape_to(ball, child_at(half_space_shape(), {})), ContainsSubstring("half_space"));
  Child child = child_at(sphere_shape(1), {});
  child.material = 9;
  CHECK_THROWS_WITH(world.add_shape_to(ball, child), ContainsSubstring("material 9 of child 1 does not exist"));
  CHECK_THROWS_WITH(world.add_shapes(std::vector<BodyId>{ball}, {}), ContainsSubstring("1 handles and 0 shapes"));
  CHECK_THROWS_WITH(world.remove_shape(ShapeId{40, 1}), ContainsSubstring("there is no shape 40"));
  CHECK(world.state_hash() == hash);
  CHECK(world.scene().shapes.size() == 3);
  const ShapeId added = world.add_shape_to(ball, child_at(sphere_shape(0.3f), {1, 0, 0}));
  CHECK_THROWS_WITH(world.remove_shapes(std::vector<ShapeId>{added, added}), ContainsSubstring("is given twice"));
  CHECK_THROWS_WITH(world.remove_shapes(std::vector<ShapeId>{added, only}), ContainsSubstring("would have no shape"));
  world.remove_shape(added);
  CHECK_THROWS_WITH(world.remove_shape(added), ContainsSubstring("does not exist any more"));
  world.destroy_body(ball);
  CHECK_THROWS_WITH(world.body_of(only), ContainsSubstring("does not exist any more"));
  CHECK_THROWS_WITH(world.shapes_of(ball), ContainsSubstring("body 1 of generation 1 does not exist"));
  CHECK_THROWS_WITH(world.add_shape_to(ball, child_at(sphere_shape(1), {})), ContainsSubstring("add_shapes: body 1"));
}

namespace {

/* Shapes come and go at random; returns the hash after each step. */
std::vector<uint64_t> lives_of(const std::string &backend, bool specialise, int steps)
{
  Settings settings;
  settings.specialise = specialise;
  settings.events = true;
  Scene scene = yard({0, -10, 0});
  for (int k = 0; k < 20; ++k)
    scene.bodies.push_back(body_at({1.4 * (k % 4) - 2, 1 + 1.6 * (k / 8), 1.4 * (k / 4 % 2)}, k % 2u));
  World world(scene, settings, Placement{backend, {}, false});
  Random random(31);
  std::vector<uint64_t> hashes;
  for (int k = 0; k < steps; ++k) {
    const BodyId id = world.id_of(1 + random.below(20));
    if (const std::vector<ShapeId> shapes = world.shapes_of(id); shapes.size() > 1 && random.below(2) == 0)
      world.remove_shape(shapes[random.below(static_cast<uint32_t>(shapes.size()))]);
    else if (random.below(2) == 0)
      world.add_shapes(std::vector<BodyId>{id, id},
                       std::vector<Child>{child_at(sphere_shape(0.3f), {0.5f, 0.1f, 0}),
                                          child_at(box_shape(0.2f, 0.3f, 0.2f), {-0.4f, 0, 0.2f})});
    world.step();
    hashes.push_back(world.state_hash());
  }
  CHECK(world.scene().shapes.size() <= 23); /* places in the list were used again */
  return hashes;
}

} // namespace

TEST_CASE("parity on CPU: shapes that come and go", "[sanitizer]")
{
  const std::vector<uint64_t> expected = lives_of("serial", true, 40);
  for (const char *backend :
       {"serial:order=backward", "tbb:threads=1,lanes=1", "tbb:threads=2,lanes=4", "tbb:threads=7"}) {
    CAPTURE(backend);
    REQUIRE(lives_of(backend, true, 40) == expected);
  }
}

TEST_CASE("parity on OpenCL: shapes that come and go")
{
  parity::require_pocl();
  CHECK(lives_of("cl:pocl", false, 20) == lives_of("serial", true, 20));
}
