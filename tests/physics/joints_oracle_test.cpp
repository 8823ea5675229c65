/* Systems of joints without a closed form move as an independent integrator in double says, ever closer as the substep
 * shrinks. */
#include "tests/catch.h"
#include "tests/physics/joint_oracle.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

struct Errors {
  double distance, angle;
};

/* Of the double reference backend, whose rounding does not hide the order. */
Errors errors_after(const Scene &scene, double time, int steps, const JointOracle &oracle)
{
  World world(scene, stiff_settings(time / steps), in_double);
  run(world, steps);
  return {oracle.distance_to(world), oracle.angle_to(world)};
}

/* The error falls with the first order, that of the integrator, or faster. */
void require_convergence(const Scene &scene, double time, int steps)
{
  JointOracle oracle(scene), coarser(scene);
  oracle.run(time, 4 * steps);
  coarser.run(time, 2 * steps);
  double own = 0;
  for (size_t i = 0; i < scene.bodies.size(); ++i)
    own = std::max(own, (oracle.states()[i].position - coarser.states()[i].position).norm());
  std::vector<double> distances, angles;
  for (const int count : {steps, 2 * steps, 4 * steps}) {
    const Errors errors = errors_after(scene, time, count, oracle);
    distances.push_back(errors.distance);
    angles.push_back(errors.angle);
  }
  CAPTURE(own, distances, angles);
  REQUIRE(own < 1e-3 * distances.back()); /* of the oracle */
  CHECK(falls_with_first_order(distances));
  /* Without a load joints turn with the second order, down to the rounding of frames and moments to floats. */
  CHECK((angles.front() < 1e-5 || falls_with_first_order(angles)));
  /* A system that moves at some 10 m/s^2 for a time: half a substep of its velocity, and as much again. */
  CHECK(distances.front() < 10 * time * time / steps / 4);
}

Scene double_pendulum()
{
  Scene scene = empty_scene();
  for (int i = 0; i < 2; ++i) {
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.15f), {0.5 + i, 0, 0}).mass = float(2 - i);
    connect(scene, JointType::hinge, i == 0 ? no_body : 0, uint32_t(i), {double(i), 0, 0}, Vector::UnitZ());
  }
  return scene;
}

/* Links of random size and direction, each hung on the end of an earlier one, on a ball joint or a hinge. Links do not
 * collide. */
Scene random_tree(uint64_t seed, uint32_t links)
{
  Random random(seed);
  Scene scene = empty_scene();
  std::vector<Vector> ends;
  for (uint32_t i = 0; i < links; ++i) {
    const uint32_t parent = i == 0 ? no_body : random.below(i);
    const Vector from = i == 0 ? Vector(Vector::Zero()) : ends[parent], way = direction(random);
    const double half = random.uniform(0.1, 0.4);
    Body &body = add_body(scene, BodyType::dynamic, box_shape(float(half), 0.1f, 0.15f), point_of(from + half * way));
    body.orientation = quat_of(turn_of_x_to(way));
    body.mass = float(random.uniform(0.5, 3));
    body.filter_mask = 0;
    connect(scene, random.below(2) == 0 ? JointType::ball : JointType::hinge, parent, i, from, direction(random));
    ends.push_back(from + 2 * half * way);
  }
  return scene;
}

/* A disc that spins at 50 rad/s on a hinge in a free box, which turns about another axis. */
Scene reaction_wheel()
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.4f, 0.3f), {0, 0, 0}).angular_velocity = {0, 1, 0.5f};
  scene.bodies[0].mass = 4;
  Body &disc = add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.3f, 0.3f), {0.8, 0, 0});
  disc.linear_velocity = vec3_of(Vector(0, 1, 0.5).cross(Vector(0.8, 0, 0)));
  disc.angular_velocity = {50, 1, 0.5f};
  connect(scene, JointType::hinge, 0, 1, {0.8, 0, 0});
  return scene;
}

/* Two free bodies that turn together about their centre of mass, with a velocity along what is free. */
Scene tumbling_pair(JointType type)
{
  Random random(8);
  Scene scene = empty_scene({0, -2, 0});
  const Vector spin(1, -0.7, 0.4), axis = Vector(1, 2, -1).normalized();
  for (int i = 0; i < 2; ++i) {
    const Vector at(0.9 * i, 0.2 * i, -0.1 * i);
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.4f, 0.3f, 0.2f), point_of(at));
    body.orientation = any_turn(random);
    body.mass = float(1 + i);
    body.filter_mask = 0;
    body.angular_velocity = vec3_of(spin);
    body.linear_velocity = vec3_of(spin.cross(at));
  }
  connect(scene, type, 0, 1, {0.4, 0.1, 0}, axis);
  Body &second = scene.bodies[1];
  /* Along and about the axis, where the type allows it; a parallel joint and a plane slide otherwise. */
  if (type == JointType::hinge || type == JointType::cylindrical || type == JointType::plane)
    second.angular_velocity = vec3_of(spin + 1.5 * axis);
  if (type == JointType::ball) second.angular_velocity = {-1, 0.5f, 2};
  const Vector arm = Vector(0.9, 0.2, -0.1) - Vector(0.4, 0.1, 0);
  const Vector difference = vector_of(second.angular_velocity) - spin;
  Vector slide = Vector::Zero();
  if (type == JointType::slider || type == JointType::cylindrical || type == JointType::parallel) slide = 0.5 * axis;
  if (type == JointType::plane || type == JointType::parallel) slide += 0.4 * axis.cross(Vector::UnitZ());
  second.linear_velocity = vec3_of(spin.cross(Vector(0.9, 0.2, -0.1)) + difference.cross(arm) + slide);
  return scene;
}

} // namespace

TEST_CASE("a double pendulum converges to an independent integrator", "[physics]")
{
  require_convergence(double_pendulum(), 1, 240);
}

TEST_CASE("a tree of twenty links converges to an independent integrator", "[physics]")
{
  require_convergence(random_tree(GENERATE(1, 2), 20), 0.25, 240);
}

TEST_CASE("a wheel on a hinge in a free box converges to an independent integrator", "[physics]")
{
  require_convergence(reaction_wheel(), 0.5, 240);
}

TEST_CASE("a pair with a joint of each type converges to an independent integrator", "[physics]")
{
  for (const JointType type : all_joint_types) {
    INFO(name_of_type(type));
    require_convergence(tumbling_pair(type), 0.5, 120);
  }
}
