/* Forces and torques of the joints of trees as read_joints tells them, against statics, closed forms and the momenta
 * of bodies in double precision, which share no code with them. */
#include <tandem/worlds.h>

#include "tests/catch.h"
#include "tests/parity/articulations.h"
#include "tests/physics/articulate.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

const Placement on_one_thread{"serial", {}, false};

Settings sensing(double step, uint32_t substeps = 4)
{
  Settings settings = settings_with(step, substeps);
  settings.tree_joint_forces = true;
  return settings;
}

double either_step() { return GENERATE(1.0 / 60, 1.0 / 1000); }

struct Wrench {
  Vector force, torque;
};

Wrench wrench_of(World &world, uint32_t joint)
{
  const JointReading reading = world.read_joint(world.id_of_joint(joint));
  return {vector_of(reading.force), vector_of(reading.torque)};
}

/* relative: to the lengths of what is expected, of which one may be 0. */
void check_wrench(const Wrench &found, const Vector &force, const Vector &torque, double relative)
{
  CAPTURE(found.force.transpose(), force.transpose(), found.torque.transpose(), torque.transpose());
  CHECK((found.force - force).norm() <= relative * (force.norm() + torque.norm()));
  CHECK((found.torque - torque).norm() <= relative * (force.norm() + torque.norm()));
}

Body &add_bar(Scene &scene, const Vector &at, float mass, const Vec3 &half = {0.5f, 0.05f, 0.05f})
{
  Body &body = add_body(scene, BodyType::dynamic, box_shape(half[0], half[1], half[2]), point_of(at));
  body.filter_mask = 0;
  body.mass = mass;
  return body;
}

/* Boxes whose joints are one below the other; each stands out to the side, so that it is held by a moment. */
struct Stairs {
  static constexpr int links = 5;
  Scene scene = empty_scene();
  Vector joint_at(int k) const { return {0.1 * k, -0.4 * k, 0.05 * k * k}; }
  Vector center_of(int k) const { return joint_at(k) + Vector(0.3, -0.1, 0.1 * k); }
  explicit Stairs(bool turned)
  {
    for (int k = 0; k < links; ++k) {
      add_bar(scene, center_of(k), float(1 + k));
      const uint32_t own = uint32_t(k), parent = k == 0 ? no_body : own - 1;
      connect(scene, JointType::fixed, turned ? own : parent, turned ? parent : own, joint_at(k), {1, 2, 3});
    }
    articulate(scene);
  }
};

} // namespace

TEST_CASE("each joint of a tree at rest bears the weight and the moment of what hangs beyond it",
          "[articulations][forces]")
{
  const bool turned = GENERATE(false, true);
  const Stairs stairs(turned);
  World world(stairs.scene, sensing(either_step()), on_one_thread);
  run(world, 30);
  for (int k = 0; k < Stairs::links; ++k) {
    CAPTURE(k, turned);
    Vector force = Vector::Zero(), torque = Vector::Zero();
    for (int beyond = k; beyond < Stairs::links; ++beyond) {
      const Vector weight(0, -gravity * (1 + beyond), 0);
      force -= weight;
      torque -= (stairs.center_of(beyond) - stairs.joint_at(k)).cross(weight);
    }
    const double sign = turned ? -1 : 1; /* body b is then what holds the link */
    check_wrench(wrench_of(world, uint32_t(k)), sign * force, sign * torque, 1e-4);
  }
}

TEST_CASE("forces of the joints of trees are NaN without the setting, and change no bit of the motion",
          "[articulations][forces]")
{
  Scene scene = parity::joined_trees(3, 6);
  for (Joint &joint : scene.joints) joint.break_force = JointAxis::unlimited;
  scene.materials[0].restitution = 0.5f;
  World plain(scene, {}, on_one_thread), read_from(scene, sensing(1.0 / 60), on_one_thread);
  for (int k = 0; k < 30; ++k) {
    for (World *world : {&plain, &read_from}) world->step();
    for (uint32_t body = 0; body < scene.bodies.size(); ++body) {
      REQUIRE(plain.bodies()[body].position == read_from.bodies()[body].position);
      REQUIRE(plain.bodies()[body].angular_velocity == read_from.bodies()[body].angular_velocity);
    }
  }
  const uint32_t joint = scene.articulations[0].joints[0];
  CHECK(std::isnan(wrench_of(plain, joint).force.x()));
  CHECK(wrench_of(read_from, joint).force.allFinite());
}

TEST_CASE("a hinge that holds an arm out bears its weight and its moment, by a spring, a motor, friction or a stop",
          "[articulations][forces]")
{
  const double mass = 3, arm = 0.5, moment = mass * gravity * arm;
  const JointAxis spring{.stiffness = 1e6f, .damping = 1e4f}, motor{.motor = true, .max_force = 100},
      friction{.friction = 100}, stop{.lower = 0, .upper = 1},
      bounded{.stiffness = 1e6f, .damping = 1e4f, .max_force = 80};
  for (const JointAxis &axis : {spring, motor, friction, stop, bounded}) {
    Scene scene = empty_scene();
    add_bar(scene, {arm, 0, 0}, float(mass));
    connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ()).rotations[0] = axis;
    articulate(scene);
    World world(scene, sensing(either_step()), on_one_thread);
    run(world, 240);
    check_wrench(wrench_of(world, 0), {0, mass * gravity, 0}, {0, 0, moment}, 1e-4);
  }
}

/* The limit of a ball is a row of its own between the two links, beside the tree. */
TEST_CASE("a ball of a tree whose cone stops a rod that leans holds its moment, too", "[articulations][forces]")
{
  Scene scene = empty_scene({30, -10, 0});
  const bool turned = GENERATE(false, true);
  add_bar(scene, {0, -0.5, 0}, 2, {0.1f, 0.5f, 0.1f});
  connect(scene, JointType::cone_twist, turned ? 0 : no_body, turned ? no_body : 0, Vector::Zero(), Vector::UnitY())
      .rotations[1] = {.upper = 0.5f, .damping = 1};
  articulate(scene);
  World world(scene, sensing(either_step()), on_one_thread);
  run(world, int(6 / double(world.settings().step)));
  REQUIRE(fastest(world) < 1e-3);
  const Vector center = vector_of(world.precise_bodies()[0].position), weight = 2 * vector_of(scene.gravity);
  REQUIRE(center.cross(weight).norm() > 10);
  const double sign = turned ? -1 : 1;
  check_wrench(wrench_of(world, 0), -sign * weight, -sign * center.cross(weight), 1e-3);
}

/* The tension is that at the end of the substep, and what is read is the mean of the substep: the force turns with the
 * pendulum, and changes by three times the weight as it swings. */
TEST_CASE("a pendulum pulls at its hinge with its weight and the centripetal force", "[articulations][forces]")
{
  const double step = either_step(), mass = 2, arm = 0.5;
  Scene scene = empty_scene();
  const double start = 1.2;
  add_bar(scene, arm * Vector(std::sin(start), -std::cos(start), 0), float(mass), {0.01f, 0.5f, 0.01f}).orientation =
      turn_about(Vector::UnitZ(), start);
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  articulate(scene);
  World world(scene, sensing(step), on_one_thread);
  const double substep = substep_of(world.settings()), inertia = moments_of(scene, scene.bodies[0]).z();
  double lowest = 1, at_lowest = 2;
  for (int k = 0; k < int(1.5 / step); ++k) {
    world.step();
    const auto state = world.precise_bodies()[0];
    const Vector at = vector_of(state.position);
    const double speed = state.angular_velocity[2], turned = std::atan2(at.x(), -at.y()),
                 change = -mass * gravity * arm * std::sin(turned) / (inertia + mass * arm * arm);
    const Vector along(std::sin(turned), -std::cos(turned), 0), across(std::cos(turned), std::sin(turned), 0);
    const Vector expected = mass * (arm * change * across - arm * speed * speed * along) + Vector(0, mass * gravity, 0);
    const Wrench found = wrench_of(world, 0);
    const double bound =
        0.5 * substep * std::abs(speed) * (expected.norm() + 3 * mass * gravity) + 1e-4 * mass * gravity;
    REQUIRE((found.force - expected).norm() < bound);
    REQUIRE(std::abs(found.torque.z()) < bound * arm);
    if (std::abs(turned) > lowest) continue;
    lowest = std::abs(turned);
    at_lowest = std::abs(found.force.norm() - (mass * gravity + mass * arm * speed * speed)) / bound;
  }
  CHECK(at_lowest < 1);
  CHECK(lowest < 0.05);
}

TEST_CASE("a free pair that spins is held together by the centripetal force", "[articulations][forces]")
{
  const JointType type = GENERATE(JointType::fixed, JointType::hinge, JointType::ball);
  const double speed = 8, arm = 0.6;
  Scene scene = empty_scene({0, 0, 0});
  for (int k = 0; k < 2; ++k) {
    Body &body = add_bar(scene, {k == 0 ? -arm : arm, 0, 0}, 2);
    body.angular_velocity = {0, 0, float(speed)};
    body.linear_velocity = {0, float(k == 0 ? -arm * speed : arm * speed), 0};
  }
  connect(scene, type, 0, 1, Vector::Zero(), Vector::UnitZ());
  articulate(scene, 0);
  World world(scene, sensing(either_step()), on_one_thread);
  run(world, 20);
  const double substep = substep_of(world.settings()), turn = speed * substep, force = 2 * arm * speed * speed;
  const Wrench found = wrench_of(world, 0);
  const Vector out = vector_of(world.precise_bodies()[1].position).normalized();
  CHECK(std::abs(found.force.norm() / force - 1) < turn * turn / 24 + 1e-4); /* the mean of a force that turns */
  CHECK((found.force + force * out).norm() < force * (turn / 2 + 1e-4));
  CHECK(found.torque.norm() < force * arm * (turn * turn + 1e-4));
}

TEST_CASE("a slider pushes what it carries with its mass times its acceleration", "[articulations][forces]")
{
  const bool turned = GENERATE(false, true);
  const double step = either_step();
  Scene scene = empty_scene({0, 0, 0});
  add_bar(scene, {0, 0, 0}, 3);
  add_bar(scene, {0, 0.4, 0.2}, 2);
  const auto join = [&](JointType type, uint32_t a, uint32_t b, const Vector &at) -> Joint & {
    return turned ? connect(scene, type, b, a, at, Vector::UnitY()) : connect(scene, type, a, b, at, Vector::UnitY());
  };
  join(JointType::slider, no_body, 0, {0.1, 0, 0}).directions[0].force = turned ? -10 : 10;
  join(JointType::fixed, 0, 1, {0, 0.2, 0});
  articulate(scene);
  scene.articulations[0].armatures = {5, 0};
  World world(scene, sensing(step), on_one_thread);
  run(world, 20);
  const double acceleration = 10.0 / (3 + 2 + 5), sign = turned ? -1 : 1;
  CHECK(vector_of(world.precise_bodies()[0].linear_velocity).y() == Approx(acceleration * 20 * step).epsilon(1e-4));
  const Vector of_both(0, 5 * acceleration, 0), of_one(0, 2 * acceleration, 0);
  /* Frame b of the slider stays behind where it is the world's. */
  const Vector joint(0.1, turned ? 0 : vector_of(world.precise_bodies()[0].position).y(), 0);
  Vector moment = Vector::Zero();
  for (uint32_t k = 0; k < 2; ++k) {
    const Vector at = vector_of(world.precise_bodies()[k].position);
    moment += (at - joint).cross(Vector(0, (k == 0 ? 3 : 2) * acceleration, 0));
  }
  check_wrench(wrench_of(world, 0), sign * of_both, sign * moment, 1e-4);
  check_wrench(wrench_of(world, 1), sign * of_one, sign * Vector(0, 0.2, 0.2).cross(of_one), 1e-4);
}

/* Legs that hold a trunk by springs at the hips and the ankles, on feet. */
TEST_CASE("the joints of a robot that stands bear the weight above them", "[articulations][forces]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0.8f;
  const auto add_part = [&](const Shape &shape, const Vector &at, float mass) {
    Body &body = add_body(scene, BodyType::dynamic, shape, point_of(at));
    body.mass = mass;
    return uint32_t(scene.bodies.size() - 1);
  };
  const uint32_t trunk = add_part(box_shape(0.2f, 0.3f, 0.3f), {0, 1.2, 0}, 30);
  const JointAxis hold{.stiffness = 2e4f, .damping = 400};
  for (const double side : {-0.2, 0.2}) {
    const uint32_t leg = add_part(box_shape(0.06f, 0.4f, 0.06f), {0, 0.5, side}, 6),
                   foot = add_part(box_shape(0.25f, 0.05f, 0.1f), {0, 0.05, side}, 1);
    connect(scene, JointType::hinge, trunk, leg, {0, 0.9, side}, Vector::UnitZ()).rotations[0] = hold;
    connect(scene, JointType::hinge, leg, foot, {0, 0.1, side}, Vector::UnitZ()).rotations[0] = hold;
  }
  articulate(scene, trunk);
  World world(scene, sensing(either_step()), on_one_thread);
  run(world, int(3 / double(world.settings().step)));
  REQUIRE(fastest(world) < 1e-3);
  const auto sum = [&](uint32_t left, uint32_t right) -> Vector {
    return wrench_of(world, left).force + wrench_of(world, right).force;
  };
  const double hips = 30 * gravity, ankles = (30 + 2 * 6) * gravity;
  CHECK((sum(0, 2) + Vector(0, hips, 0)).norm() < 1e-3 * hips);
  CHECK((sum(1, 3) + Vector(0, ankles, 0)).norm() < 1e-3 * ankles);
}

TEST_CASE("a contact takes its share of the weight of a link from the joint", "[articulations][forces]")
{
  Scene scene = empty_scene();
  const bool bounces = GENERATE(false, true); /* then the pass of restitution is one of the step */
  scene.materials[0].restitution = bounces ? 0.5f : 0.0f;
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
  add_body(scene, BodyType::dynamic, box_shape(1, 0.05f, 0.05f), {1, 0, 0}).mass = 6;
  add_body(scene, BodyType::fixed, sphere_shape(0.5f), {1.5, -0.55, 0});
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  articulate(scene);
  World world(scene, sensing(either_step()), on_one_thread);
  run(world, int(3 / double(world.settings().step)));
  REQUIRE(fastest(world) < 1e-3);
  const double weight = 6 * gravity, support = weight / 1.5;
  check_wrench(wrench_of(world, 0), {0, weight - support, 0}, Vector::Zero(), 2e-3);
}

/* A beam on two upright rods, its centre above a quarter of the way between them. One hinge at the ground closes the
 * loop. */
TEST_CASE("the joints of a four-bar at rest share a load as statics say", "[articulations][forces]")
{
  Scene scene = empty_scene();
  const Vector down(0, -1, 0), span(2, 0, 0);
  add_bar(scene, 0.5 * down, 1, {0.02f, 0.5f, 0.02f});
  add_bar(scene, 0.25 * span + down, 8, {0.5f, 0.02f, 0.02f});
  add_bar(scene, span + 0.5 * down, 1, {0.02f, 0.5f, 0.02f});
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  connect(scene, JointType::hinge, 0, 1, down, Vector::UnitZ());
  connect(scene, JointType::hinge, 1, 2, span + down, Vector::UnitZ());
  articulate(scene);
  connect(scene, JointType::hinge, no_body, 2, span, Vector::UnitZ());
  World world(scene, sensing(either_step()), on_one_thread);
  run(world, int(2 / double(world.settings().step)));
  const double load = 8 * gravity, rod = 1 * gravity;
  const auto up = [&](uint32_t joint) { return wrench_of(world, joint).force; };
  CHECK((up(0) - Vector(0, 0.75 * load + rod, 0)).norm() < 5e-3 * load);
  CHECK((up(1) - Vector(0, 0.75 * load, 0)).norm() < 5e-3 * load);
  CHECK((up(2) + Vector(0, 0.25 * load, 0)).norm() < 5e-3 * load); /* the beam hangs on the second rod */
  CHECK((up(3) - Vector(0, 0.25 * load + rod, 0)).norm() < 5e-3 * load);
}

namespace {

/* The links on that side of a joint of the tree, which `from` is on. */
std::vector<uint32_t> links_beyond(const Scene &scene, const Articulation &tree, uint32_t joint, uint32_t from)
{
  std::vector<uint32_t> reached{from};
  for (size_t k = 0; k < reached.size(); ++k)
    for (const uint32_t other : tree.joints) {
      const std::array ends{scene.joints[other].body_a, scene.joints[other].body_b};
      if (other == joint || (ends[0] != reached[k] && ends[1] != reached[k])) continue;
      for (const uint32_t end : ends)
        if (end != no_body && std::find(reached.begin(), reached.end(), end) == reached.end()) reached.push_back(end);
    }
  return reached;
}

/* Of tree_crowd(), where links come after their parents. */
uint32_t link_of(const Joint &joint)
{
  if (joint.body_a == no_body || joint.body_b == no_body) return std::min(joint.body_a, joint.body_b);
  return std::max(joint.body_a, joint.body_b);
}

Vector spin_momentum_of(const Scene &scene, uint32_t body, const PreciseBodyState &state)
{
  const Eigen::Quaterniond turn(state.orientation[3], state.orientation[0], state.orientation[1], state.orientation[2]);
  const Matrix axes = turn.normalized().toRotationMatrix();
  return axes * moments_of(scene, scene.bodies[body]).asDiagonal() *
         (axes.transpose() * vector_of(state.angular_velocity));
}

Vector frame_of(uint32_t body, const Point &position, const std::vector<PreciseBodyState> &states)
{
  if (body == no_body) return vector_of(position);
  const PreciseBodyState &state = states[body];
  const auto &[x, y, z, w] = state.orientation;
  return vector_of(state.position) + Eigen::Quaterniond(w, x, y, z).normalized() * vector_of(position);
}
Vector frame_of_a(const Joint &joint, const std::vector<PreciseBodyState> &states)
{
  return frame_of(joint.body_a, joint.position_a, states);
}
Vector frame_of_b(const Joint &joint, const std::vector<PreciseBodyState> &states)
{
  return frame_of(joint.body_b, joint.position_b, states);
}

} // namespace

namespace {

/* What a step of one substep has pushed bodies with besides gravity and these forces, about a point that moves; and how
 * far floats leave it open. */
struct Gain {
  Vector force = Vector::Zero(), torque = Vector::Zero();
  double noise = 0, noise_of_torque = 0;

  void add(const Scene &scene, uint32_t body, double step, const std::vector<PreciseBodyState> &before,
           const std::vector<PreciseBodyState> &after, const Force &given, const Vector &middle_of_arm)
  {
    const double mass = double(scene.bodies[body].mass);
    const Vector now = vector_of(after[body].linear_velocity), then = vector_of(before[body].linear_velocity);
    const Vector weight = mass * double(scene.bodies[body].gravity_factor) * vector_of(scene.gravity);
    const Vector own = mass / step * (now - then) - weight - vector_of(given.force);
    force += own;
    torque += middle_of_arm.cross(own) - vector_of(given.torque);
    torque += (spin_momentum_of(scene, body, after[body]) - spin_momentum_of(scene, body, before[body])) / step;
    const double rounding = 1e-6 * mass * (now.norm() + 1) / step;
    noise += rounding;
    noise_of_torque += rounding * (middle_of_arm.norm() + 0.1);
  }
};

} // namespace

/* Torques are compared where trees move freely, since what pushes a tree that stands has the arms from before. */
TEST_CASE("joints of random trees give the momentum that gravity and forces do not give", "[articulations][forces]")
{
  const double step = either_step();
  const bool is_free = GENERATE(false, true);
  Random random(5);
  Scene scene = parity::tree_crowd(11, 16, 0);
  for (Body &body : scene.bodies) {
    body.filter_mask = 0;
    if (is_free && body.type == BodyType::dynamic) body.angular_velocity = vec3_of(3 * direction(random));
  }
  if (is_free) scene.gravity = {0, 0, 0};
  for (Joint &joint : scene.joints)
    if (is_free) joint.directions = joint.rotations = {};
  World world(scene, sensing(step, 1), on_one_thread);
  run(world, 3);
  for (int k = 0; k < 10; ++k) {
    std::vector<Force> forces(scene.bodies.size());
    for (uint32_t body = 1; body < scene.bodies.size() && !is_free; ++body) /* 0 is the ground */
      forces[body] = {vec3_of(5 * direction(random)), vec3_of(direction(random))};
    world.add_forces(world.body_ids(), forces);
    const std::vector<PreciseBodyState> before = world.precise_bodies();
    world.step();
    const std::vector<PreciseBodyState> after = world.precise_bodies();
    for (const Articulation &tree : scene.articulations)
      for (const uint32_t number : tree.joints) {
        const Joint &joint = scene.joints[number];
        const bool is_b = link_of(joint) == joint.body_b;
        const auto frame = is_b ? frame_of_b : frame_of_a; /* on the link */
        Gain gain;
        for (const uint32_t body : links_beyond(scene, tree, number, link_of(joint)))
          gain.add(scene, body, step, before, after, forces[body],
                   0.5 * (vector_of(before[body].position) - frame(joint, before) + vector_of(after[body].position) -
                          frame(joint, after)));
        const Wrench found = wrench_of(world, number);
        const Vector force = is_b ? gain.force : -gain.force;
        Vector torque = is_b ? gain.torque : -gain.torque;
        torque += (frame(joint, after) - frame_of_b(joint, after)).cross(force);
        CAPTURE(number, k, found.force.transpose(), force.transpose(), found.torque.transpose(), torque.transpose());
        REQUIRE((found.force - force).norm() < 1e-5 * force.norm() + gain.noise);
        if (!is_free) continue;
        REQUIRE((found.torque - torque).norm() < 1e-5 * (force.norm() + torque.norm()) + gain.noise_of_torque);
      }
  }
}

namespace {

/* Three rods on hinges about z, the first on the world, that swing in a plane; each hinge has an axis. */
Scene swinging_rods(const JointAxis &axis)
{
  Scene scene = empty_scene();
  for (uint32_t k = 0; k < 3; ++k) {
    add_bar(scene, {0.5 + k, 0, 0}, float(3 - k));
    connect(scene, JointType::hinge, k == 0 ? no_body : k - 1, k, {double(k), 0, 0}, Vector::UnitZ()).rotations[0] =
        axis;
  }
  return scene;
}

} // namespace

/* Up to a term of second order in the turn of a substep, and the noise of velocities. */
TEST_CASE("about its own axis a hinge of a tree has the torque of its drive alone, however the tree swings",
          "[articulations][forces]")
{
  const double step = either_step(), given = 1.5, length = 1, mass = 6;
  Scene scene = swinging_rods({.force = float(given)});
  articulate(scene);
  World world(scene, sensing(step), on_one_thread);
  const double substep = substep_of(world.settings());
  for (int k = 0; k < int(1 / step); ++k) {
    world.step();
    double fastest_turn = 0, largest_force = 0;
    for (uint32_t joint = 0; joint < 3; ++joint) {
      fastest_turn = std::max(fastest_turn, vector_of(world.precise_bodies()[joint].angular_velocity).norm());
      largest_force = std::max(largest_force, wrench_of(world, joint).force.norm());
    }
    const double turn = fastest_turn * substep, noise = 1e-6 * (fastest_turn + 1) * length * mass / substep;
    for (uint32_t joint = 0; joint < 3; ++joint)
      REQUIRE(std::abs(wrench_of(world, joint).torque.z() - given) < turn * turn * largest_force * length + noise);
  }
}

TEST_CASE("a chain that swings has the forces at its joints that it has in maximal coordinates",
          "[articulations][forces]")
{
  Scene scene = swinging_rods({.damping = 3}), tree = scene;
  articulate(tree);
  World maximal(scene, settings_with(1.0 / 1000), on_one_thread), reduced(tree, sensing(1.0 / 1000), on_one_thread);
  double worst = 0;
  for (int k = 0; k < 300; ++k) {
    for (World *world : {&maximal, &reduced}) world->step();
    if (k < 50) continue;
    for (uint32_t joint = 0; joint < 3; ++joint) {
      const Wrench one = wrench_of(maximal, joint), other = wrench_of(reduced, joint);
      worst = std::max({worst, (one.force - other.force).norm(), (one.torque - other.torque).norm()});
    }
  }
  CAPTURE(worst);
  CHECK(worst < 2e-3 * 6 * gravity);
}

TEST_CASE("forces of the joints of a tree outlast sleep, snapshots and going back", "[articulations][forces]")
{
  Scene scene = Stairs(false).scene;
  add_ground(scene);
  scene.bodies.back().position[1] = -10;
  Settings settings = sensing(1.0 / 60);
  settings.sleeping = true;
  settings.sleep_time = 0.2f;
  const Placement placement{"tbb:threads=2,lanes=4", {}, false};
  World world(scene, settings, placement);
  CHECK(wrench_of(world, 0).force == Vector::Zero());
  world.keep_states(8);
  run(world, 5);
  const Wrench awake = wrench_of(world, 0);
  CHECK(awake.force.y() == Approx(15 * gravity).epsilon(1e-4));
  const std::vector<std::byte> saved = world.save();
  world.add_force(world.id_of(0), {{0, 1000, 0}, {}});
  world.step();
  CHECK(wrench_of(world, 0).force.y() == Approx(15 * gravity - 1000).epsilon(1e-3));
  world.go_back(1);
  CHECK(wrench_of(world, 0).force == awake.force);
  run(world, 60);
  REQUIRE(world.is_asleep(world.id_of(0)));
  const Wrench asleep = wrench_of(world, 0);
  CHECK((asleep.force - awake.force).norm() < 1e-3 * awake.force.norm());
  CHECK((asleep.torque - awake.torque).norm() < 1e-3 * awake.torque.norm());
  run(world, 5);
  CHECK(wrench_of(world, 0).force == asleep.force);
  world.restore(saved);
  CHECK(wrench_of(world, 0).force == awake.force);
  CHECK(wrench_of(world, 0).torque == awake.torque);
}

TEST_CASE("the joints of a tree in quarantine have no forces", "[articulations][forces]")
{
  Scene scene = swinging_rods({});
  articulate(scene);
  World world(scene, sensing(1.0 / 60), on_one_thread);
  run(world, 5);
  CHECK(wrench_of(world, 0).force.norm() > 1);
  world.set_velocity(world.id_of(1), {{3e38f, 0, 0}, {0, 0, 3e38f}});
  run(world, 2);
  REQUIRE(world.quarantined().size() == 3);
  for (uint32_t joint = 0; joint < 3; ++joint) CHECK(wrench_of(world, joint).force == Vector::Zero());
}

TEST_CASE("worlds of a batch tell the forces of the joints of their trees as worlds alone do",
          "[articulations][forces]")
{
  std::vector<Scene> scenes;
  for (int k = 0; k < 3; ++k) {
    scenes.push_back(swinging_rods({.damping = 1}));
    articulate(scenes.back());
    scenes.back().gravity[1] = float(-3 * (k + 1));
  }
  Worlds worlds(scenes, sensing(1.0 / 60), {"tbb:threads=2,lanes=4", {}, false});
  for (int k = 0; k < 20; ++k) worlds.step();
  const auto of_batch = [&](uint32_t world, uint32_t joint) {
    return vector_of(worlds.read_joints(std::vector<WorldJoint>{{world, joint}})[0].force);
  };
  for (uint32_t k = 0; k < 3; ++k) {
    World alone(scenes[k], sensing(1.0 / 60), on_one_thread);
    run(alone, 20);
    for (uint32_t joint = 0; joint < 3; ++joint) CHECK(of_batch(k, joint) == wrench_of(alone, joint).force);
  }
  worlds.reset(1);
  CHECK(of_batch(1, 0) == Vector::Zero());
  CHECK(of_batch(2, 0).norm() > 1);
}
