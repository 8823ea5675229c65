/* Articulations within the step of a world, against closed forms, dense matrices in double precision, and bodies that
 * are none. */
#include <set>

#include <tandem/articulations.h>
#include <tandem/worlds.h>

#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tests/parity/articulations.h"
#include "tests/physics/articulate.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

const Placement serial{"serial", {}, false};

/* Makes all joints one tree. */
Scene without_gravity()
{
  Scene scene = empty_scene();
  scene.gravity = {0, 0, 0};
  return scene;
}

/* Boxes along x that do not collide; the first hangs from the world. */
Scene hanging_chain(int links, const Vector &axis = Vector::UnitZ())
{
  Scene scene = empty_scene();
  for (int k = 0; k < links; ++k) {
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.15f), {0.5 + k, 0, 0}).mass = float(1 + k);
    connect(scene, JointType::hinge, k == 0 ? no_body : uint32_t(k - 1), uint32_t(k), {double(k), 0, 0}, axis);
  }
  articulate(scene);
  return scene;
}

} // namespace

TEST_CASE("an articulated pendulum has the period of its closed form, and its joint does not open", "[articulations]")
{
  Scene scene = hanging_chain(1);
  Settings settings;
  settings.substeps = 8;
  World world(scene, settings, serial);
  /* I about the pivot = m (l^2 + (1 + 0.04) / 12), l = 0.5; released at a right angle to the vertical */
  const double inertia = 0.25 + (1 + 0.04) / 12,
               period = 2 * pi * std::sqrt(inertia / (gravity * 0.5)) * lengthening_of_period(pi / 2);
  int crossings = 0;
  double last = 0, first_time = 0, last_time = 0;
  for (int k = 1; k <= 1200; ++k) {
    world.step();
    const double x = world.precise_bodies()[0].position[0], now = k / 60.0;
    if (last > 0 && x <= 0) {
      last_time = now - 1.0 / 60 * x / (x - last);
      if (crossings++ == 0) first_time = last_time;
    }
    last = x;
    REQUIRE(open_joints(world).max_distance < 2e-6);
  }
  REQUIRE(crossings > 8);
  CHECK(std::abs((last_time - first_time) / (crossings - 1) / period - 1) < 2e-3);
}

TEST_CASE("a ball bounces off a chain as off the mass that a dense matrix gives its link", "[articulations]")
{
  Random random(3);
  for (const uint32_t link : {0u, 1u, 3u}) {
    Scene scene = hanging_chain(4, direction(random));
    for (Body &body : scene.bodies) body.filter_mask = 2;
    scene.gravity = {0, 0, 0};
    scene.materials[0].restitution = 1;
    scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
    Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {0.8 + link, 0.2001, 0});
    ball.linear_velocity = {0, -2, 0};
    ball.mass = 0.7f;
    ball.filter_group = 2;
    Settings settings;
    settings.step = 1.0f / 1000;
    World world(scene, settings, serial);
    run(world, 3);
    const ArticulationTree tree(scene, scene.articulations[0], "test");
    const ArticulationState at = tree.state();
    const size_t n = tree.velocities();
    const auto masses = tree.mass_matrix(at), jacobian = tree.jacobian(at, link, {0.3, 0.1, 0});
    const Eigen::MatrixXd m = Eigen::Map<const Eigen::MatrixXd>(masses.data(), ptrdiff_t(n), ptrdiff_t(n));
    const Eigen::VectorXd row = Eigen::Map<const Eigen::VectorXd>(&jacobian[4 * n], ptrdiff_t(n)); /* its y */
    const Eigen::VectorXd moved = m.ldlt().solve(row);
    const double impulse = 2 * 2 / (1 / 0.7 + row.dot(moved));
    CAPTURE(link);
    CHECK(world.precise_bodies()[4].linear_velocity[1] == Approx(-2 + impulse / 0.7).margin(2e-3));
    const double angular = world.precise_bodies()[0].angular_velocity[0];
    const Vector axis = eigen_of(scene.joints[0].orientation_a) * Vector::UnitX();
    CHECK(angular == Approx(-impulse * moved[0] * axis.x()).margin(5e-3));
  }
}

TEST_CASE("an articulation of one link moves as the body alone", "[articulations]")
{
  for (const double friction : {0.0, 0.5}) {
    Scene scene = empty_scene();
    add_ground(scene);
    scene.materials[0].restitution = 0.3f;
    scene.materials[0].static_friction = scene.materials[0].dynamic_friction = float(friction);
    Body &box = add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.2f, 0.4f), {0, 0.5, 0});
    box.linear_velocity = {2, 0, 1};
    World alone(scene, {}, serial);
    scene.articulations.push_back({"", {}, 1, {}});
    World linked(scene, {}, serial);
    for (int k = 0; k < 90; ++k) {
      alone.step();
      linked.step();
      const Vector apart =
          vector_of(alone.precise_bodies()[1].position) - vector_of(linked.precise_bodies()[1].position);
      CAPTURE(friction, k);
      REQUIRE(apart.norm() < 2e-3);
    }
  }
}

TEST_CASE("two links on a fixed joint slide as far as theory says of one body", "[articulations]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (const double x : {-0.5, 0.5})
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.2f, 0.3f), {x, 0.2, 0}).linear_velocity = {3, 0, 0};
  connect(scene, JointType::fixed, 1, 2, {0, 0.2, 0});
  articulate(scene);
  World world(scene, {}, serial);
  run(world, 120);
  const auto bodies = world.precise_bodies();
  const double way = 3 * 3 / (2 * 0.6 * gravity);
  CHECK(0.5 * (bodies[1].position[0] + bodies[2].position[0]) == Approx(way).margin(3 * substep_of({})));
  CHECK(vector_of(bodies[1].linear_velocity).norm() < 1e-3);
  CHECK(bodies[1].position[1] == Approx(0.2).margin(1e-3));
}

TEST_CASE("articulated humanoids stand while they are driven, and fall when they are not", "[articulations]")
{
  const auto head_of = [](World &world) { return world.precise_bodies()[4].position[1]; };
  World driven(load_scene("humanoid"), {}, serial);
  for (int k = 0; k < 300; ++k) {
    driven.step();
    REQUIRE(open_joints(driven).max_distance < 2e-6);
  }
  CHECK(head_of(driven) > 1.6);
  World limp(load_scene("humanoid:stiffness=0,damping=1"), {}, serial);
  for (int k = 0; k < 300; ++k) {
    limp.step();
    REQUIRE(open_joints(limp).max_distance < 2e-6);
    for (const auto &body : limp.precise_bodies()) REQUIRE(body.position[1] > -0.02);
  }
  CHECK(head_of(limp) < 0.4);
}

TEST_CASE("forces and impulses on a link push the whole tree", "[articulations]")
{
  Scene scene = hanging_chain(3);
  scene.gravity = {0, 0, 0};
  scene.joints.erase(scene.joints.begin()); /* free now */
  articulate(scene, 0);
  World world(scene, {}, serial);
  world.add_force(world.body_ids()[2], {.force = {0, 6, 3}});
  world.step();
  Momentum m = momentum_of(world);
  CHECK((m.linear - Vector(0, 6, 3) / 60).norm() < 1e-5);
  world.add_impulse(world.body_ids()[1], {.impulse = {1, 0, 2}});
  world.step();
  m = momentum_of(world);
  CHECK((m.linear - Vector(1, 0.1, 2.05)).norm() < 1e-4);
}

TEST_CASE("joints of a falling tree stay closed while a program pushes its links", "[articulations]")
{
  Scene scene = hanging_chain(3);
  scene.joints.erase(scene.joints.begin()); /* free now */
  articulate(scene, 0);
  World world(scene, {}, serial);
  for (int step = 0; step < 30; ++step) {
    for (const BodyId &id : world.body_ids()) world.add_force(id, {.force = {5, 0, step % 2 ? 20.0f : -20.0f}});
    world.step();
    REQUIRE(open_joints(world).max_distance < 2e-6);
  }
  CHECK(momentum_of(world).linear.x() == Approx(3 * 5 * 0.5).epsilon(1e-4));
}

TEST_CASE("links of one tree do not pass through each other", "[articulations]")
{
  Scene scene = without_gravity();
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.2f), {0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {0.6, 0.3, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.2f), {0, 0.6, 0});
  connect(scene, JointType::fixed, 0, 1, {0.6, 0.1, 0});
  connect(scene, JointType::hinge, 1, 2, {0.6, 0.6, 0}, Vector::UnitZ()).rotations[0] = {
      .target_velocity = 2, .motor = true, .max_force = 20};
  articulate(scene);
  World world(scene, {}, serial);
  double deepest = 0;
  for (int k = 0; k < 240; ++k) {
    world.step();
    deepest = std::max(deepest, double(world.statistics().max_penetration));
  }
  const auto bodies = world.precise_bodies();
  CHECK((vector_of(bodies[0].position) - vector_of(bodies[2].position)).norm() > 0.2);
  CHECK(deepest < 0.01);
}

TEST_CASE("what articulations cannot have is refused by name", "[articulations]")
{
  const auto refusal = [](const Scene &scene, const Settings &settings = {}) -> std::string {
    try {
      World world(scene, settings, serial);
    } catch (const InputError &error) {
      return error.what();
    }
    return "accepted";
  };
  const auto refuses = [&](const Scene &scene, const std::string &part) {
    CHECK_THAT(refusal(scene), Catch::Matchers::ContainsSubstring(part));
  };
  Scene scene = hanging_chain(3);
  CHECK(refusal(scene) == "accepted");
  Scene other = scene;
  other.bodies[1].linear_damping = 1;
  refuses(other, "body 1 has damping");
  other = scene;
  other.joints.emplace_back().enabled = false; /* as one that was destroyed */
  other.articulations.push_back({"none", {3}, no_body, {}});
  refuses(other, "joint 3 was destroyed; it has no bodies");
  other = scene;
  other.bodies[1].continuous = true;
  refuses(other, "body 1 is continuous");
  other = scene;
  other.bodies[2].max_angular_speed = 3;
  refuses(other, "body 2 has a highest speed");
  other = scene;
  other.joints[1].break_force = 3;
  refuses(other, "joint 1: can break");
  other = scene;
  connect(other, JointType::hinge, 0, 2, {0, 0, 0}).rotations[0] = {.lower = 0, .upper = 1, .restitution = 0.5f};
  refuses(other, "joint 3: has a limit that bounces; joints that hold links have none");
  other.joints.back().rotations[0] = {};
  CHECK(refusal(other) == "accepted");
  connect(other, JointType::hinge, 1, 2, {0, 0, 0});
  Coupling &gear = other.couplings.emplace_back();
  gear.joint_a = 3, gear.joint_b = 4;
  gear.teeth_a = gear.teeth_b = 1;
  refuses(other, "coupling 0: couples joint 3, which holds a link");
  other.couplings[0].joint_a = 0, other.couplings[0].joint_b = 3;
  refuses(other, "coupling 0: couples joint 3, which holds a link");
  other.couplings[0].joint_b = 2;
  CHECK(refusal(other) == "accepted");
  add_body(other, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {9, 9, 9});
  connect(other, JointType::hinge, no_body, 3, {9, 9, 9});
  other.couplings[0].joint_b = 5;
  refuses(other, "coupling 0: couples joint 0, a coordinate of an articulation, with a joint that is none of it");
  Articulation ball;
  ball.joints = {5};
  other.articulations.push_back(ball);
  refuses(other, "with a joint that is none of it; a coupling is of two joints of one articulation");
  other = scene;
  other.articulations.push_back({"second", {}, 1, {}});
  refuses(other, "articulation 'second': body 1 is a link of another articulation");
  other = scene;
  other.materials[0].rolling_friction = 0.1f;
  refuses(other, "material 0: has rolling");
  Settings settings;
  settings.solver = Solver::xpbd;
  CHECK(refusal(scene, settings) != "accepted");
  settings = {};
  settings.batching = Batching::iterative;
  CHECK_THAT(refusal(scene, settings), Catch::Matchers::ContainsSubstring("the batching iterative"));

  World world(scene, {}, serial);
  const auto call_refuses = [&](const auto &call, const std::string &part) {
    std::string why = "accepted";
    try {
      call();
    } catch (const InputError &error) {
      why = error.what();
    }
    CHECK_THAT(why, Catch::Matchers::ContainsSubstring(part));
  };
  const std::array body{world.body_ids()[1]};
  const std::array joint{world.joint_ids()[1]};
  call_refuses([&] { world.destroy_bodies(body); }, "link of an articulation");
  call_refuses([&] { world.destroy_joints(joint); }, "an articulation has it");
  call_refuses([&] { world.set_joints(joint, std::span(&scene.joints[1], 1)); }, "set_joint_axes alone");
  Joint further = scene.joints[1];
  further.body_a = no_body;
  further.type = JointType::hinge;
  further.rotations[0] = {.lower = 0, .upper = 1, .restitution = 0.5f};
  call_refuses([&] { world.create_joints(std::span(&further, 1)); }, "joints that hold links have none");
}

TEST_CASE("set_joint_axes moves the targets of an articulation", "[articulations]")
{
  Scene scene = hanging_chain(2);
  scene.gravity = {0, 0, 0};
  for (Joint &joint : scene.joints) joint.rotations[0] = {.stiffness = 400, .damping = 60};
  World world(scene, {}, serial);
  const auto ids = world.joint_ids();
  JointAxis to = scene.joints[1].rotations[0];
  to.target_position = 0.7f;
  const std::array changes{JointAxisChange{3, to}};
  world.set_joint_axes(std::span(&ids[1], 1), changes);
  run(world, 300);
  CHECK(world.read_joints(std::span(&ids[1], 1))[0].rotations[0] == Approx(0.7).margin(1e-3));
  CHECK(world.read_joints(std::span(&ids[0], 1))[0].rotations[0] == Approx(0).margin(1e-3));
}

TEST_CASE("a link that is not finite takes its tree into quarantine, and nobody else", "[articulations]")
{
  World world(load_scene("humanoid:n=2"), {}, serial);
  run(world, 10);
  world.set_velocity(world.body_ids()[3], {{3e38f, 0, 0}, {0, 3e38f, 0}});
  run(world, 60);
  std::set<uint32_t> out;
  for (const Quarantine &taken : world.quarantined()) out.insert(taken.body);
  CHECK(out.size() == 14);
  CHECK(*out.begin() == 1);
  CHECK(*out.rbegin() == 14);
  CHECK(world.precise_bodies()[18].position[1] > 1.6); /* the head of the other one */
  World restored(world.save(), {"tbb:threads=2", {}, false});
  run(restored, 5);
  run(world, 5);
  CHECK(restored.state_hash() == world.state_hash());
}

TEST_CASE("a link that is put elsewhere comes back to its tree", "[articulations]")
{
  World world(load_scene("humanoid"), {}, serial);
  BodyState forearm = world.bodies()[6];
  forearm.position[1] += 1;
  world.set_state(world.body_ids()[6], forearm);
  world.step();
  CHECK(open_joints(world).max_distance < 2e-6);
}

namespace {

/* A fixed box that holds a box on a hinge, which holds another. */
Scene chain_on_a_base()
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed, box_shape(0.2f, 0.2f, 0.2f), {0, 0, 0});
  for (int k = 0; k < 2; ++k) {
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.15f), {0.5 + k, 0, 0});
    connect(scene, JointType::hinge, uint32_t(k), uint32_t(k + 1), {double(k), 0, 0}, Vector::UnitZ());
  }
  articulate(scene);
  return scene;
}

template <class Call> std::string refusal_of(const Call &call)
{
  try {
    call();
  } catch (const InputError &error) {
    return error.what();
  }
  return "accepted";
}

} // namespace

TEST_CASE("what a tree stands on, and what contacts of links cannot have, is kept from calls", "[articulations]")
{
  World world(chain_on_a_base(), {}, serial);
  run(world, 5);
  const uint64_t before = world.state_hash();
  const BodyId base = world.body_ids()[0];
  for (const BodyType type : {BodyType::dynamic, BodyType::kinematic})
    CHECK(refusal_of([&] { world.set_type(base, type); }) ==
          "set_properties: joint 0: the type of its bodies cannot change, because an articulation has it");
  CHECK(refusal_of([&] { world.destroy_body(base); }) ==
        "destroy_bodies: joint 0: its bodies cannot be destroyed, because an articulation has it");
  CHECK(refusal_of([&] { world.set_state(base, world.bodies()[0]); }) ==
        "set_states: body 0: it cannot be moved, because an articulation stands on it");
  Material rolling;
  rolling.rolling_friction = 0.1f;
  CHECK_THAT(refusal_of([&] { world.add_material(rolling); }),
             Catch::Matchers::StartsWith("add_material: material 1: has rolling or spinning friction"));
  CHECK(world.state_hash() == before);
  CHECK(World(world.save(), serial).state_hash() == before);
}

TEST_CASE("tables of joints that no kernel takes have room for all that is written to them", "[articulations]")
{
  Scene scene = hanging_chain(45);
  scene.joints[1].type = JointType::ball;
  add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {0, 9, 9});
  World world(scene, {}, serial);
  const auto ids = world.joint_ids();
  Joint other;
  other.body_b = 45;
  other.position_a = {0, 9, 9};
  const JointId gone = world.create_joint(other);
  const JointAxis spring{.stiffness = 200, .damping = 20};
  world.set_joint_axis(ids[0], 3, spring);
  world.destroy_joint(gone);
  const std::vector<JointId> thrice(3, ids[1]);
  const std::vector<JointAxisChange> changes{{3, spring}, {4, spring}, {5, spring}};
  world.set_joint_axes(thrice, changes);
  const size_t joints = world.scene().joints.size(), most_axes = 3;
  for (const Buffer buffer : {Buffer::joint_axis_kind, Buffer::joint_axis_row, Buffer::cached_joint_axis_impulse}) {
    const size_t bytes = world.memory().bytes(buffer);
    CAPTURE(row_of(buffer).name, bytes);
    CHECK((bytes == 0 || bytes >= joints * most_axes * row_of(buffer).per_item * size_of(row_of(buffer).element)));
  }
  run(world, 5);
  CHECK(std::isfinite(world.precise_bodies()[44].position[1]));
}

TEST_CASE("a world of a batch takes a tree that is in quarantine from a snapshot", "[articulations]")
{
  const Scene scene = load_scene("humanoid");
  World one(scene, {}, serial);
  one.set_velocity(one.body_ids()[3], {{3e38f, 0, 0}, {0, 3e38f, 0}});
  run(one, 5);
  Worlds worlds(std::vector<Scene>{scene, scene}, {}, serial);
  worlds.load(0, one.save());
  worlds.step();
  one.step();
  CHECK(worlds.state_hashes()[0] == one.state_hash());
}
