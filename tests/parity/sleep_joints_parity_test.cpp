/* Joints that fall asleep and wake with their bodies have the same bits on every backend, and so do worlds that go on
 * from what was kept or written down while some sleep. */
#include <optional>

#include "tests/parity/joints.h"

using namespace tandem;
using namespace tandem::parity;
using namespace tandem::physics_tests;

namespace {

constexpr uint32_t rows = 5, links = 5;

/* Rows of boxes on the ground that joints of several types connect, some of them driven, and a kinematic paddle that
 * passes over them. */
Scene rows_of_boxes()
{
  static constexpr JointType types[] = {JointType::ball, JointType::hinge, JointType::fixed, JointType::universal};
  Scene scene = empty_scene();
  scene.name = "rows of boxes";
  add_ground(scene);
  for (uint32_t row = 0; row < rows; ++row)
    for (uint32_t k = 0; k < links; ++k) {
      const Point at{0.62 * k, 0.2 + 0.01 * row, 1.5 * row};
      add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.2f, 0.3f), at);
      const auto body = uint32_t(scene.bodies.size() - 1);
      if (k == 0) continue;
      Joint &joint = connect(scene, types[(row + k) % 4], body - 1, body, Vector(at[0] - 0.31, at[1], at[2]));
      joint.collide = row == 2;
      if (joint.type == JointType::hinge) joint.rotations[0] = {.stiffness = 20, .damping = 2};
    }
  connect(scene, JointType::ball, no_body, 1, Vector(-0.31, 0.2, 0));
  add_body(scene, BodyType::kinematic, box_shape(0.1f, 0.1f, 4), {-4, 0.45, 3}).linear_velocity = {3, 0, 0};
  return scene;
}

/* A ball with more joints than there are colours, to balls around it on the ground. */
Scene star_on_ground()
{
  Scene scene = empty_scene();
  scene.name = "star on the ground";
  add_ground(scene);
  add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {0, 0.3, 0});
  for (int k = 0; k < 70; ++k) {
    const double angle = 2 * pi * (k % 35) / 35, radius = k < 35 ? 4 : 5;
    const Vector at(radius * std::cos(angle), 0.3, radius * std::sin(angle));
    Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(0.3f), point_of(at));
    ball.angular_damping = 5;
    connect(scene, JointType::distance, 1, uint32_t(scene.bodies.size() - 1), 0.5 * at).directions[0].upper = 1;
  }
  return scene;
}

void disturb(World &world, uint64_t step)
{
  const std::vector<BodyId> ids = world.body_ids();
  if (step % 45 == 44) world.add_impulse(ids[1 + step % (ids.size() - 2)], {{0.5f, 2, 0}});
  if (step % 80 == 70) {
    Body ball = world.scene().bodies[2];
    ball.position = {0.7, 3, 1.5 * double(step / 80 % rows)};
    world.create_body(ball);
  }
}

Settings sleeping_settings()
{
  Settings settings;
  settings.sleeping = settings.events = true;
  settings.sleep_time = 0.2f;
  settings.broadphase = Broadphase::grid;
  return settings;
}

void require_equal(const Scene &scene, std::vector<std::string> backends, uint64_t steps,
                   const Settings &settings = sleeping_settings())
{
  ComparisonRequest request;
  request.settings = settings;
  request.backends = std::move(backends);
  request.steps = steps;
  request.before_step = disturb;
  const Comparison comparison = compare_backends(scene, request);
  if (comparison.first_difference) FAIL(describe(*comparison.first_difference));
  CHECK(comparison.steps == steps);
}

} // namespace

TEST_CASE("parity on CPU: joints that sleep and wake")
{
  require_equal(rows_of_boxes(), cpu_backends(), 160);
  require_equal(star_on_ground(), {"serial", "tbb:threads=3,lanes=4"}, 80);
}

TEST_CASE("parity on OpenCL: joints that sleep and wake")
{
  require_pocl();
  require_equal(rows_of_boxes(), {"tbb", "cl:pocl"}, 100, build_of_all_features(sleeping_settings()));
}

/* The scenes must do what they are for. */
TEST_CASE("the scenes of the parity of joints that sleep fall asleep and wake, in part and whole")
{
  for (const Scene &scene : {rows_of_boxes(), star_on_ground()}) {
    CAPTURE(scene.name);
    World world(scene, sleeping_settings(), {"serial", {}, false});
    uint32_t fell = 0, woke = 0, partly = 0, whole = 0;
    for (uint64_t step = 0; step < 400; ++step) {
      disturb(world, step);
      world.step();
      for (const SleepEvent &event : world.sleep_events()) event.asleep ? ++fell : ++woke;
      const uint32_t asleep = world.statistics().asleep;
      if (asleep >= links && asleep + links < scene.bodies.size()) ++partly;
      if (asleep + 2 >= scene.bodies.size()) ++whole;
    }
    CHECK(fell > links);
    CHECK(woke > links);
    if (scene.name == "rows of boxes") CHECK(partly + whole > 100); /* balls of the star roll on */
    CHECK(summary_of(joint_errors(world.scene(), world.precise_bodies())).max_distance < 0.05);
  }
}

TEST_CASE("a snapshot with joints that sleep goes on with the same bits on another backend")
{
  World world(rows_of_boxes(), sleeping_settings(), {"tbb:threads=2,lanes=4", {}, false});
  for (uint64_t step = 0; step < 260; ++step) {
    disturb(world, step);
    world.step();
    if (step % 20 != 7) continue;
    const std::vector<std::byte> bytes = world.save();
    World other(bytes, {"serial", {}, false});
    CHECK(other.save() == bytes);
    World same(bytes, {"serial:order=backward", {}, false});
    for (uint64_t more = step + 1; more < step + 25; ++more) {
      for (World *one : {&other, &same}) {
        disturb(*one, more);
        one->step();
      }
      CAPTURE(step, more);
      REQUIRE(other.state_hash() == same.state_hash());
    }
  }
  World last(world.save(), {"serial", {}, false});
  for (uint64_t step = 260; step < 330; ++step) {
    for (World *one : {&world, &last}) {
      disturb(*one, step);
      one->step();
    }
    REQUIRE(last.state_hash() == world.state_hash());
  }
}

/* Whatever number of steps its joints sleep. */
TEST_CASE("a world whose joints sleep and one that is made of its snapshot have the same bits")
{
  World world(rows_of_boxes(), sleeping_settings(), {"serial", {}, false});
  std::optional<World> other;
  uint32_t asleep = 0;
  for (uint64_t step = 0; step < 200; ++step) {
    if (step % 25 == 18) other.emplace(world.save(), Placement{"tbb:threads=2,lanes=4", {}, false});
    for (World *one : {&world, other ? &*other : nullptr}) {
      if (!one) continue;
      disturb(*one, step);
      one->step();
    }
    CAPTURE(step);
    if (other) REQUIRE(world.state_hash() == other->state_hash());
    if (world.statistics().asleep > 0) ++asleep;
  }
  CHECK(asleep > 50);
}

TEST_CASE("a world goes back to states in which other joints slept, and on with the same bits")
{
  World world(rows_of_boxes(), sleeping_settings(), {"tbb:threads=2,lanes=4", {}, false});
  world.keep_states(30);
  std::vector<uint64_t> hashes;
  int others_slept = 0;
  for (uint64_t step = 0; step < 300; ++step) {
    hashes.resize(step);
    hashes.push_back(world.state_hash());
    const uint32_t states = 3 + uint32_t(step % 17);
    if (step % 13 == 5 && states < world.states_kept()) { /* the first body that comes makes it forget them */
      const uint32_t asleep = world.statistics().asleep;
      world.go_back(states);
      if (world.statistics().asleep != asleep) ++others_slept;
      for (uint64_t again = step - states; again < step; ++again) {
        CAPTURE(step, again);
        REQUIRE(world.state_hash() == hashes[again]);
        disturb(world, again);
        world.step();
      }
      REQUIRE(world.state_hash() == hashes[step]);
    }
    disturb(world, step);
    world.step();
  }
  CHECK(others_slept > 3);
}

/* Bodies that come lay the buffers out anew, and shapes bring features, while joints sleep. */
TEST_CASE("joints that sleep stay with their bodies when buffers are laid out anew")
{
  World world(rows_of_boxes(), sleeping_settings(), {"serial", {}, false});
  for (int k = 0; k < 240; ++k) world.step(); /* the bar has passed by */
  for (int k = 0; k < 600 && world.statistics().asleep < links; ++k) world.step();
  const uint32_t asleep = world.statistics().asleep;
  REQUIRE(asleep >= links);
  Body body = world.scene().bodies[2];
  body.position = {300, 5, 0}; /* far from the others */
  world.create_bodies(std::vector<Body>(300, body));
  world.set_damping(world.id_of(3), 0.1f, 0);
  world.step();
  CHECK(world.statistics().asleep >= asleep - links);
  for (uint32_t slot = 1; slot <= rows * links; ++slot) world.add_impulse(world.id_of(slot), {{0, 0.5f, 0}});
  for (int k = 0; k < 60; ++k) world.step();
  CHECK(summary_of(joint_errors(world.scene(), world.precise_bodies())).max_distance < 0.05);
}
