/* Joints in the solver jacobi, which solves them and contacts at the same time on parts of bodies: one iteration is
 * that of an independent reference in double, momentum is kept wherever iterations stop, the order of joints does not
 * count, and a body may have any number of them. */
#include <Eigen/Dense>

#include "host/catalog/catalog.h"
#include "host/runtime/interface/kernel_list.h"
#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

const Placement in_order{"serial", {}, false};

Settings jacobi(uint32_t iterations = 0)
{
  Settings settings = settings_for(Solver::jacobi);
  if (iterations > 0) settings.iterations = iterations;
  return settings;
}

/* Balls of several masses that fly about, which joints hold together in a net of random edges; without gravity. With
 * held, some are joined to the world as well. */
Scene net_of_balls(uint64_t seed, uint32_t balls, bool held)
{
  Random random(seed);
  Scene scene = empty_scene({0, 0, 0});
  for (uint32_t k = 0; k < balls; ++k) {
    Body &body = add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {double(k % 4), double(k / 4), 0});
    body.mass = float(random.uniform(0.5, 4));
    body.linear_velocity = vec3_of(direction(random));
    body.angular_velocity = vec3_of(2 * direction(random));
    const auto place = [&](uint32_t ball) { return vector_of(scene.bodies[ball].position); };
    if (k > 0) connect(scene, JointType::ball, random.below(k), k, 0.5 * (place(k) + place(k - 1)));
    if (k > 3) connect(scene, JointType::ball, k, k - 3, place(k) + 0.3 * direction(random));
    if (held && k % 3 == 0) connect(scene, JointType::ball, no_body, k, place(k) + 0.2 * direction(random));
  }
  for (Body &body : scene.bodies) body.filter_mask = 0;
  return scene;
}

/* The parts of a body, as the paper has them, where joints to the world together get half of it. */
double parts_of(const Scene &scene, uint32_t body, bool to_world)
{
  int of_world = 0, others = 0;
  for (const Joint &joint : scene.joints)
    if (joint.body_a == body || joint.body_b == body)
      ++(joint.body_a == no_body || joint.body_b == no_body ? of_world : others);
  if (of_world == 0 || others == 0) return of_world + others;
  return 2 * (to_world ? of_world : others);
}

using Column = Eigen::VectorXd;
using Block = Eigen::Matrix3d;

Block cross_of(const Vector &r)
{
  Block m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

/* Velocities of balls, and rounds over their ball joints, which begin without impulses. */
class SplitReference {
public:
  explicit SplitReference(const Scene &scene)
      : scene_(scene), v_(6 * int(scene.bodies.size())), impulses_(scene.joints.size(), Vector::Zero())
  {
    for (size_t k = 0; k < scene.bodies.size(); ++k)
      v_.segment<6>(6 * int(k)) << vector_of(scene.bodies[k].linear_velocity),
          vector_of(scene.bodies[k].angular_velocity);
  }
  /* share: of the impulse of a rigid joint; the rest of what the joint has leaks away. */
  void iterate(double share)
  {
    Column change = Column::Zero(v_.size());
    for (size_t j = 0; j < scene_.joints.size(); ++j) {
      const Joint &joint = scene_.joints[j];
      const bool to_world = joint.body_a == no_body || joint.body_b == no_body;
      Block response = Block::Zero();
      Vector closing = Vector::Zero();
      for (const auto &[body, arm, sign] : sides_of(joint)) {
        const double parts = parts_of(scene_, body, to_world);
        response += parts * (Block::Identity() / mass(body) - cross_of(arm) * cross_of(arm) / inertia(body));
        closing += sign * (linear(body) + angular(body).cross(arm));
      }
      const Vector impulse = -share * response.ldlt().solve(closing) - (1 - share) * impulses_[j];
      impulses_[j] += impulse;
      for (const auto &[body, arm, sign] : sides_of(joint)) {
        change.segment<3>(6 * int(body)) += sign * impulse / mass(body);
        change.segment<3>(6 * int(body) + 3) += sign * arm.cross(impulse) / inertia(body);
      }
    }
    v_ += change;
  }
  Vector linear(uint32_t body) const { return v_.segment<3>(6 * int(body)); }
  Vector angular(uint32_t body) const { return v_.segment<3>(6 * int(body) + 3); }

private:
  struct Side {
    uint32_t body;
    Vector arm;
    double sign;
  };
  std::vector<Side> sides_of(const Joint &joint) const
  {
    std::vector<Side> sides;
    if (joint.body_a != no_body) sides.push_back({joint.body_a, vector_of(joint.position_a), -1});
    if (joint.body_b != no_body) sides.push_back({joint.body_b, vector_of(joint.position_b), 1});
    return sides;
  }
  double mass(uint32_t body) const { return double(scene_.bodies[body].mass); }
  double inertia(uint32_t body) const { return 0.4 * mass(body) * 0.1 * 0.1; }

  const Scene &scene_;
  Column v_;
  std::vector<Vector> impulses_;
};

double momentum_drift(World &world, int steps)
{
  const Momentum start = momentum_of(world);
  double drift = 0;
  for (int step = 0; step < steps; ++step) {
    world.step();
    const Momentum now = momentum_of(world);
    drift = std::max({drift, (now.linear - start.linear).norm() / start.linear_scale,
                      (now.angular - start.angular).norm() / start.angular_scale});
  }
  return drift;
}

bool runs(World &world, Kernel kernel)
{
  const std::vector<Kernel> kernels = world.kernels();
  return std::find(kernels.begin(), kernels.end(), kernel) != kernels.end();
}

} // namespace

/* A step so short that nothing moves: a pass with bias, of which softness takes a share, and one without. A pass of one
 * iteration has two rounds. */
TEST_CASE("jacobi: an iteration over joints is that of a reference in double", "[physics]")
{
  const bool held = GENERATE(false, true);
  const Scene scene = net_of_balls(3, 24, held);
  Settings settings = jacobi(1);
  settings.step = 1e-5f;
  settings.substeps = 1;
  World world(scene, settings, in_order);
  world.step();
  const Softness soft(settings);
  const double h = substep_of(settings), w = 2 * pi * joint_hertz_of(settings),
               stiff = h * w * (2 * settings.joint_damping_ratio + h * w);
  SplitReference reference(scene);
  for (const double share : {stiff / (1 + stiff), 1.0})
    for (int round = 0; round < 2; ++round) reference.iterate(share);
  const auto states = world.precise_bodies();
  for (uint32_t k = 0; k < scene.bodies.size(); ++k) {
    CAPTURE(held, k);
    CHECK((vector_of(states[k].linear_velocity) - reference.linear(k)).norm() < 2e-4);
    CHECK((vector_of(states[k].angular_velocity) - reference.angular(k)).norm() < 4e-3);
  }
}

/* Colours would see the effect of one joint in the next. */
TEST_CASE("jacobi: the order of joints in the scene does not count", "[physics]")
{
  const auto largest_difference = [](Settings settings) {
    Scene scene = net_of_balls(5, 24, true), reversed = scene;
    std::reverse(reversed.joints.begin(), reversed.joints.end());
    World world(scene, settings, in_order), other(reversed, settings, in_order);
    world.step();
    other.step();
    double largest = 0;
    for (size_t k = 0; k < scene.bodies.size(); ++k)
      largest = std::max(largest, (vector_of(world.precise_bodies()[k].linear_velocity) -
                                   vector_of(other.precise_bodies()[k].linear_velocity))
                                      .norm());
    return largest;
  };
  CHECK(largest_difference(jacobi()) < 1e-4);
  CHECK(largest_difference(settings_for(Solver::soft_step)) > 1e-2);
}

TEST_CASE("jacobi: joints keep momentum wherever iterations stop", "[physics]")
{
  const uint32_t iterations = GENERATE(1u, 2u, 5u);
  CAPTURE(iterations);
  World net(net_of_balls(1, 40, false), jacobi(iterations), in_order);
  CHECK(momentum_drift(net, 60) < 1e-5);
  Scene people = load_scene("ragdolls:n=2,height=0");
  people.gravity = {0, 0, 0};
  std::erase_if(people.joints, [](const Joint &joint) { return joint.body_a == no_body || joint.body_b == no_body; });
  Random random(2);
  for (Body &body : people.bodies)
    if (body.type == BodyType::dynamic) body.linear_velocity = vec3_of(direction(random));
    else body.position[1] -= 100; /* the ground */
  World flying(people, jacobi(iterations), {"tbb:threads=2", {}, false});
  CHECK(momentum_drift(flying, 60) < 1e-5);
}

/* Drives, limits, friction and largest speeds are given to both bodies, too. */
TEST_CASE("jacobi: axes of joints keep momentum", "[physics]")
{
  Random random(4);
  Scene scene = empty_scene({0, 0, 0});
  for (uint32_t k = 0; k < 30; ++k) {
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.2f, 0.25f), {double(k), 0.3 * (k % 3), 0});
    body.linear_velocity = vec3_of(direction(random));
    body.angular_velocity = vec3_of(2 * direction(random));
    if (k == 0) continue;
    const JointType types[] = {JointType::hinge, JointType::slider, JointType::cone_twist, JointType::distance};
    Joint &joint = connect(scene, types[k % 4], k - 1, k, {k - 0.5, 0, 0}, direction(random));
    JointAxis &axis = k % 4 == 1 || k % 4 == 3 ? joint.directions[0] : joint.rotations[0];
    axis = {.lower = -0.2f, .upper = 0.1f, .target_velocity = 3, .motor = k % 2 == 0, .max_force = 5};
    axis.friction = 0.5f;
    axis.max_speed = 2;
    if (k % 4 == 3) axis = {.target_position = 0.5f, .stiffness = 200, .damping = 1};
  }
  World world(scene, jacobi(3), in_order);
  CHECK(momentum_drift(world, 120) < 1e-5);
}

TEST_CASE("jacobi: a body with a thousand joints holds them, and keeps momentum", "[physics]")
{
  Scene scene = hub_with_balls(1000, {0, 0, 0});
  for (size_t k = 1; k < scene.bodies.size(); ++k) { /* all turn with the hub, but each is slower or faster */
    const Vector place = vector_of(scene.bodies[k].position);
    scene.bodies[k].linear_velocity = vec3_of((1 + 0.1 * double(k % 5)) * Vector::UnitY().cross(place));
  }
  scene.bodies[0].angular_velocity = {0, 1, 0};
  World world(scene, jacobi(), {"tbb", {}, false});
  CHECK(momentum_drift(world, 60) < 1e-5);
  CHECK(runs(world, Kernel::split_join_joints));
  CHECK(open_joints(world).max_distance < 0.005);
}

/* What a thousand balls and the hub weigh hangs on one joint, which is half of the hub. With eight iterations the joint
 * leaks a quarter of what a row of whole bodies would; with all of that it would open by 29.5 mm. */
TEST_CASE("jacobi: a body with a thousand joints hangs on one", "[physics]")
{
  Scene scene = hub_with_balls(1000, {0, -10, 0});
  connect(scene, JointType::fixed, no_body, 0, {0, 0, 0});
  World world(scene, jacobi(), {"tbb", {}, false});
  run(world, 120);
  const JointReading reading = world.read_joint(world.id_of_joint(1000));
  CHECK(reading.force[1] == Approx(10 * (10 + 1000 * 0.05)).epsilon(0.01));
  CHECK(world.statistics().kinetic_energy < 1e-3);
  CHECK(open_joints(world).max_distance < 0.25 * 0.0295);
}

/* What iterations leave of the impulses of earlier steps must go, or it grows: without a least leak a hub with 24 arms
 * had 800 J after 100 steps, and a net of 12 by 12 balls with two iterations 5 MJ after 600. */
TEST_CASE("jacobi: a hub with many arms, and nets with few iterations, come to rest", "[physics]")
{
  Scene star = hub_with_balls(24, {0, -10, 0});
  connect(star, JointType::fixed, no_body, 0, {0, 0, 0});
  World hub(star, jacobi(), {"tbb:threads=2", {}, false});
  run(hub, 300);
  CHECK(hub.statistics().kinetic_energy < 1e-6);
  for (const uint32_t iterations : {1u, 2u, 3u, 8u}) {
    CAPTURE(iterations);
    World net(load_scene("joint-grid:columns=12,rows=12"), jacobi(iterations), {"tbb:threads=2", {}, false});
    run(net, 600);
    CHECK(net.statistics().kinetic_energy < 1e-3);
    CHECK(open_joints(net).max_distance < 0.01);
  }
}

TEST_CASE("jacobi: kernels that split joints come with them, and no others solve them")
{
  World plain(load_scene("box-stack:n=3"), jacobi()), joined(hanging_boxes(3, 1), jacobi()),
      soft(hanging_boxes(3, 1), {});
  for (World *world : {&plain, &joined, &soft}) run(*world, 2);
  for (const Kernel kernel : {Kernel::split_solve_joints, Kernel::split_warm_start_joints,
                              Kernel::split_parts_of_joints, Kernel::split_apply_with_joints}) {
    CHECK_FALSE(runs(plain, kernel));
    CHECK(runs(joined, kernel));
    CHECK_FALSE(runs(soft, kernel));
  }
  CHECK_FALSE(runs(joined, Kernel::solve_joints));
  CHECK_FALSE(runs(joined, Kernel::split_sum_joints));
}
