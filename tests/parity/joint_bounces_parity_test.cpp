/* Limits of joints that give speed back do so with the serial backend's bits on every backend: coloured joints and
 * those past the last colour, alone and in batches, from snapshots and from states gone back to. */
#include "host/runtime/memory.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"
#include "shared/counts.h"
#include "shared/joints/joint_codes.h"
#include "shared/platform.h"
#include "tests/host/world/worlds.h"
#include "tests/parity/joints.h"

namespace tandem::parity {
namespace {

using namespace physics_tests;

JointAxis bouncing_range(Random &random, double reach, double low = -1)
{
  return {.lower = float(low * reach),
          .upper = float(reach),
          .restitution = random.below(4) == 0 ? 0 : float(random.uniform(0.2, 1))};
}

/* Each axis that a type leaves free, where it begins within its range. */
void let_bounce(Joint &joint, Random &random)
{
  const std::array<uint32_t, 6> kinds = axis_kinds_of(joint);
  for (size_t k = 0; k < kinds.size(); ++k) {
    const bool from_zero = kinds[k] == JOINT_AXIS_CONE || kinds[k] == JOINT_AXIS_DISTANCE;
    if (kinds[k] == JOINT_AXIS_NONE || random.below(5) == 0) continue;
    (k < 3 ? joint.directions[k] : joint.rotations[k - 3]) =
        bouncing_range(random, random.uniform(0.05, 0.4), from_zero ? 0 : -1);
  }
}

/* Pairs of spinning bodies with a joint of each type, to the world and between them; and a hub that has more sliders
 * than there are colours. A floor is below. */
Scene bouncing_limits(uint64_t seed = 1, uint32_t sliders = 110)
{
  constexpr JointType types[] = {JointType::ball,        JointType::hinge,  JointType::slider,
                                 JointType::cylindrical, JointType::plane,  JointType::parallel,
                                 JointType::universal,   JointType::wheel,  JointType::cone_twist,
                                 JointType::distance,    JointType::six_dof};
  Random random(seed);
  Scene scene = empty_scene({0, -2, 0});
  scene.name = "bouncing limits";
  add_ground(scene);
  const auto add = [&](const Point &at) {
    Body &body = add_body(scene, BodyType::dynamic, sphere_shape(0.2f), at);
    body.linear_velocity = vec3_of(2 * direction(random));
    body.angular_velocity = vec3_of(6 * direction(random));
    return uint32_t(scene.bodies.size() - 1);
  };
  for (const JointType type : types) {
    const Vector at(1.5 * double(static_cast<uint32_t>(type)), 1.5, 0);
    const uint32_t one = add(point_of(at)), other = add(point_of(at + Vector(0, 0, 0.5)));
    for (const auto &[a, b] : {std::pair(no_body, one), std::pair(one, other)}) {
      const Vector middle = at + Vector(0, 0, a == no_body ? 0 : 0.25);
      let_bounce(connect(scene, type, a, b, middle, direction(random)), random);
    }
  }
  add_body(scene, BodyType::dynamic, sphere_shape(1), {0, 4, 8}).mass = 300;
  const auto hub = uint32_t(scene.bodies.size() - 1);
  for (uint32_t k = 0; k < sliders; ++k) {
    const Vector way = direction(random);
    const uint32_t body = add(point_of(Vector(0, 4, 8) + 3 * way));
    connect(scene, JointType::slider, hub, body, Vector(0, 4, 8) + 2 * way, way).directions[0] =
        bouncing_range(random, 0.05);
  }
  return scene;
}

/* How many axes the last step turned round, of coloured joints and of those past the last colour. */
struct Bounces {
  size_t colored = 0, overflow = 0;
  void count(World &world)
  {
    const auto joints = world.memory().read<uint32_t>(Buffer::counts, 1, COUNT_JOINTS).front(),
               first = world.memory().read<uint32_t>(Buffer::counts, 1, JOINT_COLOR_START + COLOR_OVERFLOW).front();
    const auto rows = world.memory().read<float4>(Buffer::joint_bounce, joints * most_axes_of_joint(world.scene()));
    const float least = 1; /* m/s or rad/s, that of Settings::restitution_speed */
    for (size_t k = 0; k < rows.size(); ++k)
      if (rows[k].x * rows[k].y < 0 && std::abs(rows[k].x) > least) ++(k % joints < first ? colored : overflow);
  }
};

Settings with_checks()
{
  Settings settings;
  settings.events = settings.check = true;
  return settings;
}

} // namespace

TEST_CASE("limits that bounce do so at coloured joints and at those past the last colour")
{
  World world(bouncing_limits(), {}, {"serial", {}, false});
  Bounces bounces;
  for (int k = 0; k < 40; ++k) {
    world.step();
    bounces.count(world);
  }
  CHECK(bounces.colored > 50);
  CHECK(bounces.overflow > 5);
}

TEST_CASE("parity on CPU: limits of joints that bounce")
{
  require_parity(bouncing_limits(), cpu_backends(), 40, with_checks());
  require_parity(bouncing_limits(2, 5), cpu_backends(), 40, with_checks());
}

TEST_CASE("parity on OpenCL: limits of joints that bounce")
{
  require_pocl();
  require_parity(bouncing_limits(), {"serial", "cl:pocl"}, 15, build_of_all_features());
}

TEST_CASE(
    "limits that bounce have the same bits in their own place, with every feature built, and in worlds of a batch")
{
  const auto hash = [](const Settings &settings, const Placement &placement) {
    World world(bouncing_limits(), settings, placement);
    run(world, 30);
    return world.state_hash();
  };
  const uint64_t expected = hash({}, {"serial", {}, false});
  Settings whole;
  whole.specialise = false;
  CHECK(hash(whole, {"tbb:threads=2", {}, false}) == expected);
  CHECK(hash({}, {"tbb", parse_placement("joints=serial:order=backward"), false}) == expected);
  const std::vector<Scene> scenes = {bouncing_limits(3), bouncing_limits(4), bouncing_limits(5)};
  for (const char *backend : {"serial", "tbb:threads=3,lanes=4"}) tests::BatchBesideWorlds(scenes, backend).step(20);
}

TEST_CASE("limits that bounce go on with the same bits from a snapshot and from a state gone back to")
{
  World world(bouncing_limits(6), {}, {"serial", {}, false});
  world.keep_states(8);
  run(world, 10);
  const std::vector<std::byte> snapshot = world.save();
  run(world, 5);
  const uint64_t expected = world.state_hash();
  World other(snapshot, {"tbb:threads=2,lanes=8", {}, false});
  run(other, 5);
  CHECK(other.state_hash() == expected);
  world.go_back(5);
  run(world, 5);
  CHECK(world.state_hash() == expected);
}

} // namespace tandem::parity
