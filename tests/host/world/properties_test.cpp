/* Properties of bodies that change while a world runs: what they do is what a closed form says, and the tables are
 * those of a world that was made with the new values. */
#include <cmath>
#include <limits>

#include <tandem/world.h>

#include "host/base/random.h"
#include "host/runtime/interface/features.h"
#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tests/host/runtime/opencl/pocl.h"
#include "tests/host/world/bodies.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr float step_time = 1.0f / 60;

Scene weightless()
{
  Scene scene;
  scene.name = "weightless";
  scene.gravity = {0, 0, 0};
  scene.shapes = {sphere_shape(0.5f), box_shape(0.5f, 0.5f, 0.5f)};
  return scene;
}

/* A large box, its top at height 0, and boxes upon it. */
Scene boxes_on_ground(int boxes)
{
  Scene scene = weightless();
  scene.gravity = {0, -10, 0};
  scene.shapes.push_back(box_shape(20, 1, 20));
  Body ground = body_at({0, -1, 0}, 2);
  ground.type = BodyType::fixed;
  scene.bodies = {ground};
  for (int k = 0; k < boxes; ++k) scene.bodies.push_back(body_at({0, 0.5 + k, 0}, 1));
  return scene;
}

void run(World &world, int steps)
{
  for (int k = 0; k < steps; ++k) world.step();
}

} // namespace

TEST_CASE("a body whose gravity factor becomes 0 moves straight on", "[sanitizer]")
{
  Scene scene = weightless();
  scene.gravity = {0, -10, 0};
  scene.bodies = {body_at({0, 100, 0}), body_at({9, 100, 0})};
  scene.bodies[0].linear_velocity = {3, 0, 0};
  World world(scene, {}, {"serial", {}});
  run(world, 30);
  world.set_gravity_factor(world.id_of(0), 0);
  const BodyState before = world.bodies()[0];
  CHECK(before.linear_velocity[1] == Approx(-5));
  run(world, 60);
  const BodyState after = world.bodies()[0];
  CHECK(after.linear_velocity == before.linear_velocity);
  for (size_t k = 0; k < 3; ++k)
    CHECK(after.position[k] == Approx(before.position[k] + double{before.linear_velocity[k]}).margin(1e-5));
  CHECK(world.bodies()[1].position[1] == Approx(100 - 5 * 1.5 * 1.5));
  CHECK(world.body_description(world.id_of(0)).gravity_factor == 0);
}

TEST_CASE("damping that begins at a step slows a body by the closed form of the integrator", "[sanitizer]")
{
  Scene scene = weightless();
  scene.bodies = {body_at({0, 0, 0}), body_at({9, 0, 0})};
  for (Body &body : scene.bodies) body.linear_velocity = {8, 0, 0}, body.angular_velocity = {0, 2, 0};
  World world(scene, {}, {"serial", {}});
  CHECK((world.features() & FEATURE_DAMPING) == 0);
  run(world, 10);
  world.set_damping(world.id_of(0), 1.5f, 3);
  CHECK((world.features() & FEATURE_DAMPING) != 0);
  run(world, 40);
  const double substeps = 40.0 * Settings{}.substeps, h = step_time / Settings{}.substeps;
  const BodyState damped = world.bodies()[0], other = world.bodies()[1];
  CHECK(damped.linear_velocity[0] == Approx(8 * std::pow(1 + 1.5 * h, -substeps)).epsilon(1e-5));
  CHECK(damped.angular_velocity[1] == Approx(2 * std::pow(1 + 3.0 * h, -substeps)).epsilon(1e-5));
  CHECK(other.linear_velocity[0] == 8);
  world.set_damping(world.id_of(0), 0, 0);
  run(world, 10);
  CHECK(world.bodies()[0].linear_velocity == damped.linear_velocity);
}

TEST_CASE("a falling body that becomes fixed stops, holds a stack, and falls when it is dynamic again", "[sanitizer]")
{
  Scene scene = boxes_on_ground(0);
  scene.bodies.push_back(body_at({0, 20, 0}, 2));
  scene.bodies.push_back(body_at({0, 21.5, 0}, 1));
  scene.bodies.push_back(body_at({0, 22.5, 0}, 1));
  World world(scene, {}, {"serial", {}});
  run(world, 15);
  const BodyId slab = world.id_of(1);
  world.set_type(slab, BodyType::fixed);
  const BodyState held = world.read_body(slab);
  CHECK(held.linear_velocity == Vec3{0, 0, 0});
  run(world, 120);
  CHECK(world.read_body(slab).position == held.position);
  CHECK(world.bodies()[2].position[1] == Approx(held.position[1] + 1.5).margin(0.01));
  CHECK(world.bodies()[3].position[1] == Approx(held.position[1] + 2.5).margin(0.02));
  CHECK(world.bodies()[3].linear_velocity[1] == Approx(0).margin(0.01));
  world.set_type(slab, BodyType::dynamic);
  run(world, 60);
  CHECK(world.read_body(slab).position[1] == Approx(held.position[1] - 5).margin(0.03)); /* 10 / 2 for a second */
}

TEST_CASE("a filter that comes to exclude a pair ends its contact, and the body falls through", "[sanitizer]")
{
  Settings settings;
  settings.events = true;
  World world(boxes_on_ground(1), settings, {"serial", {}});
  run(world, 30);
  REQUIRE(world.contact_events().size() == 1);
  const double height = world.bodies()[1].position[1];
  world.set_filter(world.id_of(1), 2, 2);
  world.step();
  REQUIRE(world.contact_events().size() == 1);
  CHECK(world.contact_events().front().kind == ContactEvent::Kind::end);
  run(world, 59);
  CHECK(world.bodies()[1].position[1] == Approx(height - 5).margin(0.01));
  CHECK_FALSE(world.cast_rays(std::vector<Ray>{{{0, 9, 0}, {0, -30, 0}, 1, {4, 4}}}).front().body == 1);
  CHECK(world.cast_rays(std::vector<Ray>{{{0, 9, 0}, {0, -30, 0}, 1, {2, 2}}}).front().body == 1);
}

TEST_CASE("a collision exchanges momentum by the new masses", "[sanitizer]")
{
  Scene scene = weightless();
  scene.materials[0].restitution = 1;
  scene.bodies = {body_at({0, 0, 0}), body_at({3, 0, 0})};
  scene.bodies[0].linear_velocity = {4, 0, 0};
  for (const float mass : {1.0f, 3.0f, 0.25f}) {
    World world(scene, {}, {"serial", {}});
    world.step();
    world.set_mass(world.id_of(1), mass);
    run(world, 90);
    CHECK(world.bodies()[0].linear_velocity[0] == Approx(4 * (1 - mass) / (1 + mass)).margin(1e-4));
    CHECK(world.bodies()[1].linear_velocity[0] == Approx(8 / (1 + mass)).margin(1e-4));
    CHECK(world.statistics().kinetic_energy == Approx(8).epsilon(1e-4));
  }
}

TEST_CASE("mass and inertia are those of the next impulse, and the impulse before has the old ones", "[sanitizer]")
{
  Scene scene = weightless();
  scene.bodies = {body_at({0, 0, 0})};
  World world(scene, {}, {"serial", {}});
  const BodyId ball = world.id_of(0);
  world.add_impulse(ball, {{2, 0, 0}, {0, 0, 0.5f}});
  const float inertia = inertia_of(scene.shapes[0], 1)[2];
  world.set_mass(ball, 4, {1, 1, 2});
  world.add_impulse(ball, {{2, 0, 0}, {0, 0, 0.5f}});
  const BodyState state = world.read_body(ball);
  CHECK(state.linear_velocity[0] == 2.5f);
  CHECK(state.angular_velocity[2] == Approx(0.5f / inertia + 0.25f).epsilon(1e-6));
  world.set_properties(ball, {.inertia = Vec3{0, 0, 0}});
  world.add_impulse(ball, {{}, {0, 0, 1}});
  CHECK(world.read_body(ball).angular_velocity[2] ==
        Approx(state.angular_velocity[2] + 1 / (4 * inertia)).epsilon(1e-6));
}

TEST_CASE("a dynamic body that becomes kinematic keeps its velocity, pushes, and is not pushed", "[sanitizer]")
{
  Scene scene = weightless();
  scene.bodies = {body_at({0, 0, 0}), body_at({2, 0, 0})};
  scene.bodies[0].linear_velocity = {1, 0, 0};
  World world(scene, {}, {"serial", {}});
  run(world, 10);
  world.set_type(world.id_of(0), BodyType::kinematic);
  run(world, 170);
  CHECK(world.bodies()[0].linear_velocity == Vec3{1, 0, 0});
  CHECK(world.bodies()[0].position[0] == Approx(3).margin(1e-5));
  CHECK(world.bodies()[1].linear_velocity[0] == Approx(1).margin(0.02));
  CHECK(world.bodies()[1].position[0] == Approx(4).margin(0.02));
}

TEST_CASE("a body at rest that becomes a trigger is reported as one and rests on nothing", "[sanitizer]")
{
  Settings settings;
  settings.events = true;
  World world(boxes_on_ground(1), settings, {"serial", {}});
  run(world, 30);
  world.set_trigger(world.id_of(1), true);
  run(world, 10);
  REQUIRE(world.contact_events().size() == 1);
  CHECK(world.contact_events().front().trigger);
  const double depth = 0.5 - world.bodies()[1].position[1], time = 10 * step_time;
  CHECK(depth == Approx(5 * time * time).margin(0.01));
  world.set_trigger(world.id_of(1), false);
  run(world, 120);
  CHECK(world.bodies()[1].position[1] == Approx(0.5).margin(0.01));
}

namespace {

/* How many spinning rods fly through a thin wall, if they become continuous after their first step or not. */
int passed(bool continuous)
{
  constexpr int shots = 200;
  Random random(5);
  int through = 0;
  for (int shot = 0; shot < shots; ++shot) {
    Scene scene = weightless();
    scene.shapes = {box_shape(0.002f, 50, 50), capsule_shape(0.01f, 0.05f)};
    scene.bodies = {body_at({0, 0, 0}), body_at({-20 - random.uniform(0, 5), 0, 0}, 1)};
    scene.bodies[0].type = BodyType::fixed;
    scene.bodies[1].linear_velocity = {300, static_cast<float>(random.uniform(-300, 300)), 0};
    for (float &spin : scene.bodies[1].angular_velocity) spin = static_cast<float>(random.uniform(-150, 150));
    World world(scene, {}, {"serial", {}});
    world.step();
    world.set_continuous(world.id_of(1), continuous);
    run(world, 8);
    through += world.bodies()[1].position[0] > 0;
  }
  return through;
}

} // namespace

TEST_CASE("bodies that become continuous stop at a thin wall that others pass", "[address]")
{
  CHECK(passed(false) > 0);
  CHECK(passed(true) == 0);
}

TEST_CASE("a new material decelerates a sliding box by its friction", "[sanitizer]")
{
  Scene scene = boxes_on_ground(1);
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
  World world(scene, {}, {"serial", {}});
  run(world, 30);
  const BodyId box = world.id_of(1), ground = world.id_of(0);
  world.set_velocity(box, {{4, 0, 0}, {0, 0, 0}});
  run(world, 30);
  CHECK(world.read_body(box).linear_velocity[0] == Approx(4).margin(1e-4));
  Material rough;
  rough.static_friction = rough.dynamic_friction = 0.25f;
  const uint32_t material = world.add_material(rough);
  for (const BodyId &id : {box, ground}) world.set_material(id, material);
  run(world, 60);
  CHECK(world.read_body(box).linear_velocity[0] == Approx(4 - 2.5).margin(0.05));
}

TEST_CASE("properties that cannot be are refused, and none of their call is changed", "[sanitizer]")
{
  World world(boxes_on_ground(2), {}, {"serial", {}});
  const BodyId one = world.id_of(1), two = world.id_of(2);
  const uint64_t hash = world.state_hash();
  const auto set = [&](const BodyProperties &properties) {
    world.set_properties(std::vector<BodyId>{one, two},
                         std::vector<BodyProperties>{{.gravity_factor = 0.5f}, properties});
  };
  CHECK_THROWS_WITH(set({.mass = -1.0f}), ContainsSubstring("set_properties: body 2: mass is -1"));
  CHECK_THROWS_WITH(set({.material = 7}), ContainsSubstring("body 2: material 7 does not exist; the scene has 1"));
  CHECK_THROWS_WITH(set({.linear_damping = -2.0f}), ContainsSubstring("body 2: linear_damping is -2"));
  CHECK_THROWS_WITH(set({.gravity_factor = std::numeric_limits<float>::quiet_NaN()}),
                    ContainsSubstring("body 2: gravity_factor is nan"));
  CHECK_THROWS_WITH(world.set_properties(std::vector<BodyId>{one}, {}),
                    "set_properties: 1 handles and 0 entries; one entry for each handle is needed");
  world.destroy_body(two);
  CHECK_THROWS_WITH(set({}), ContainsSubstring("set_properties: body 2 of generation 1 does not exist any more"));
  CHECK_THROWS_WITH(world.body_description(two), ContainsSubstring("body_description: body 2 of generation 1"));
  CHECK(world.scene().bodies[1].gravity_factor == 1);
  World untouched(boxes_on_ground(2), {}, {"serial", {}});
  CHECK(hash == untouched.state_hash());
  Scene half_space = boxes_on_ground(0);
  half_space.shapes[2] = half_space_shape();
  World on_half_space(half_space, {}, {"serial", {}});
  CHECK_THROWS_WITH(on_half_space.set_type(on_half_space.id_of(0), BodyType::dynamic),
                    ContainsSubstring("a half_space cannot be dynamic"));
}

TEST_CASE("several entries for one body are taken in order, and all properties can be restored", "[sanitizer]")
{
  World world(boxes_on_ground(1), {}, {"serial", {}});
  const BodyId box = world.id_of(1);
  const BodyProperties before = properties_of(world.body_description(box));
  const std::vector<BodyId> ids{box, box};
  world.set_properties(ids, std::vector<BodyProperties>{{.mass = 2.0f, .linear_damping = 1.0f}, {.mass = 3.0f}});
  CHECK(world.body_description(box).mass == 3);
  CHECK(world.body_description(box).linear_damping == 1);
  world.set_properties(box, before);
  World untouched(boxes_on_ground(1), {}, {"serial", {}});
  for (int k = 0; k < 60; ++k) {
    world.step();
    untouched.step();
    REQUIRE(world.body_hash() == untouched.body_hash());
  }
}

namespace {

/* Balls, boxes, and compounds whose children have filters and materials of their own. */
Scene crowd()
{
  Scene scene = boxes_on_ground(0);
  Material rough, bouncing;
  rough.static_friction = rough.dynamic_friction = 0.9f;
  bouncing.restitution = 0.5f;
  scene.materials.insert(scene.materials.end(), {rough, bouncing});
  Child left, right;
  left.shape = sphere_shape(0.4f);
  right.shape = box_shape(0.3f, 0.3f, 0.3f);
  left.position = {-0.5f, 0, 0};
  right.position = {0.5f, 0, 0};
  right.material = 1;
  right.filter_group = 4;
  scene.shapes.push_back(compound_shape({left, right}));
  for (int k = 0; k < 60; ++k) {
    Body body = body_at({3.0 * (k % 5) - 6, 0.8 + 1.2 * (k / 25), 2.5 * (k / 5 % 5) - 5},
                        k % 3 == 2 ? 3u : static_cast<uint32_t>(k % 3));
    if (body.shape == 3) body.inertia = {0.2f, 0.3f, 0.3f};
    scene.bodies.push_back(body);
  }
  return scene;
}

BodyProperties any_properties(Random &random, bool with_types)
{
  BodyProperties some;
  const auto rolls = [&](double share) { return random.uniform(0, 1) < share; };
  if (rolls(0.3)) some.gravity_factor = static_cast<float>(random.uniform(0, 2));
  if (rolls(0.3)) some.linear_damping = static_cast<float>(random.uniform(0, 1));
  if (rolls(0.3)) some.angular_damping = static_cast<float>(random.uniform(0, 1));
  if (rolls(0.3)) some.mass = static_cast<float>(random.uniform(0.5, 3));
  if (rolls(0.3)) some.material = static_cast<uint32_t>(random.uniform(0, 3));
  if (rolls(0.3)) some.filter_group = 1u << static_cast<uint32_t>(random.uniform(0, 3));
  if (rolls(0.2)) some.filter_mask = rolls(0.3) ? 6u : 0xffffffffu;
  if (rolls(0.2)) some.infinite_inertia = rolls(0.5);
  if (with_types && rolls(0.3)) some.type = static_cast<BodyType>(static_cast<uint32_t>(random.uniform(0, 3)));
  if (with_types && rolls(0.1)) some.trigger = rolls(0.5);
  return some;
}

/* Changes some bodies and steps. */
void live(World &world, Random &random, bool with_bullets)
{
  std::vector<BodyId> ids;
  std::vector<BodyProperties> properties;
  const auto changes = static_cast<size_t>(random.uniform(0, 9));
  for (size_t k = 0; k < changes; ++k) {
    const auto body = 1 + static_cast<uint32_t>(random.uniform(0, 60));
    ids.push_back(world.id_of(body));
    properties.push_back(any_properties(random, true));
    if (with_bullets && random.uniform(0, 1) < 0.05) properties.back().continuous = random.uniform(0, 1) < 0.5;
  }
  world.set_properties(ids, properties);
  world.step();
}

/* The rows of bodies and their children. */
template <class T> void require_same_rows(World &one, World &other, Buffer buffer)
{
  const size_t bytes = std::min(one.memory().bytes(buffer), other.memory().bytes(buffer));
  if (bytes == 0) return;
  CAPTURE(name_of(buffer));
  REQUIRE(one.memory().bytes(buffer) == other.memory().bytes(buffer));
  REQUIRE(one.memory().read<T>(buffer, bytes / sizeof(T)) == other.memory().read<T>(buffer, bytes / sizeof(T)));
}

std::vector<std::array<float, 2>> masses_and_factors(World &world)
{
  std::vector<std::array<float, 2>> values;
  const size_t bodies = world.scene().bodies.size();
  const auto rows = world.memory().read<float>(Buffer::body_velocity, 8 * bodies);
  for (size_t k = 0; k < bodies; ++k) values.push_back({rows[8 * k + 3], rows[8 * k + 7]});
  return values;
}

} // namespace

TEST_CASE("after any changes the tables are those of a world that is made with the present values", "[sanitizer]")
{
  Random random(3);
  World world(crowd(), {}, {"serial", {}});
  for (int round = 0; round < 40; ++round) {
    live(world, random, false);
    World fresh(world.scene(), {}, {"serial", {}});
    CAPTURE(round);
    REQUIRE((fresh.features() & ~world.features()) == 0);
    require_same_rows<uint32_t>(world, fresh, Buffer::body_flags);
    require_same_rows<uint32_t>(world, fresh, Buffer::body_filter);
    require_same_rows<float>(world, fresh, Buffer::body_mass);
    require_same_rows<float>(world, fresh, Buffer::body_damping);
    require_same_rows<float>(world, fresh, Buffer::body_shape);
    require_same_rows<float>(world, fresh, Buffer::body_shape_pose);
    require_same_rows<uint32_t>(world, fresh, Buffer::body_convex);
    REQUIRE(masses_and_factors(world) == masses_and_factors(fresh));
  }
}

namespace {

/* The hash after each step. */
std::vector<uint64_t> lives_of(const std::string &backend, bool specialise, int steps)
{
  Settings settings;
  settings.events = true;
  settings.specialise = specialise;
  World world(crowd(), settings, Placement{backend, {}, false});
  Random random(17);
  std::vector<uint64_t> hashes;
  for (int k = 0; k < steps; ++k) {
    live(world, random, true);
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

} // namespace

TEST_CASE("parity on CPU: properties that change at run time", "[sanitizer]")
{
  const std::vector<uint64_t> expected = lives_of("serial", true, 60);
  for (const char *backend : {"serial:order=backward", "serial:order=shuffled", "tbb:threads=1,lanes=1",
                              "tbb:threads=2,lanes=4", "tbb:threads=7"}) {
    CAPTURE(backend);
    REQUIRE(lives_of(backend, true, 60) == expected);
  }
  CHECK(lives_of("serial", false, 60) == expected); /* the kernels of all features have the same bits */
}

TEST_CASE("parity on OpenCL: properties that change at run time")
{
  parity::require_pocl();
  CHECK(lives_of("cl:pocl", false, 40) == lives_of("serial", true, 40));
}

/* The first ball is gone, so its kind is not in the scene when boxes bring their features, and it comes back. */
TEST_CASE("a kind of body that comes back meets those that came in the meantime", "[sanitizer]")
{
  Scene scene = boxes_on_ground(0);
  scene.shapes[2] = half_space_shape();
  scene.bodies[0].position = {0, 0, 0};
  World world(scene, {}, {"serial", {}});
  const BodyId ball = world.create_body(body_at({0, 0.5, 0}, 0));
  world.step();
  world.destroy_body(ball);
  world.step();
  Body box = body_at({0, 0.5, 0}, 1);
  CHECK(world.create_body(box).index == ball.index);
  world.step();
  const BodyId again = world.create_body(body_at({0, 1.5, 0}, 0));
  run(world, 60);
  CHECK(world.read_body(again).position[1] == Approx(1.5).margin(0.02));
}

/* Contacts of a body that cannot be pushed may share a colour, and must not any more once it can be. */
TEST_CASE("contacts of a body that becomes dynamic get colours of their own", "[sanitizer]")
{
  const BodyType before = GENERATE(BodyType::fixed, BodyType::kinematic);
  Scene scene = boxes_on_ground(0);
  Body slab = body_at({0, 0.25, 0}, 3);
  scene.shapes.push_back(box_shape(3, 0.25f, 2));
  slab.type = before;
  scene.bodies.push_back(slab);
  for (int k = 0; k < 8; ++k) scene.bodies.push_back(body_at({0.6 * k - 2.1, 0.745, 0}, 4));
  scene.shapes.push_back(box_shape(0.25f, 0.25f, 0.25f));
  Settings settings;
  settings.check = true;
  World scalar(scene, settings, {"serial", {}}), lanes(scene, settings, {"tbb:threads=1,lanes=4", {}});
  for (World *world : {&scalar, &lanes}) {
    run(*world, 5);
    REQUIRE(world->statistics().colors < 8);
    world->set_type(world->id_of(1), BodyType::dynamic);
    run(*world, 1);
    CHECK(world->statistics().colors >= 8); /* one for each box on the slab */
    run(*world, 5);
    CHECK(!world->batch_fault());
  }
  CHECK(scalar.state_hash() == lanes.state_hash());
}
