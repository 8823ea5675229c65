/* The cars of the built-in scene `vehicle` against closed forms: springs at rest, Ackermann's circle, the braking
 * distance of locked wheels, and the course without slip of a slalom over hills. */
#include <set>

#include <tandem/load_scene.h>

#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* What the builder of the scene says of its cars. */
constexpr double car_wheelbase = 2.5, car_track = 1.6, car_wheel_radius = 0.35, car_chassis = 1000, car_wheel = 20,
                 car_stiffness = 25000;
constexpr uint32_t steering_axis = 3, rolling_axis = 4; /* of JointAxisChange */

/* The first car of a scene. */
class Car {
public:
  explicit Car(const std::string &scene, const Settings &settings = {}) : world(load_scene(scene), settings, {})
  {
    while (world.scene().bodies[chassis].name != "chassis") ++chassis;
  }
  Vector position() { return vector_of(world.precise_bodies()[chassis].position); }
  Matrix axes() { return axes_of(world.bodies()[chassis].orientation); }
  double upright() { return axes()(1, 1); }
  /* The middle of the rear axle, in the plane of x and z. */
  Eigen::Vector2d rear()
  {
    const Vector at = position() - 0.5 * car_wheelbase * axes().col(0);
    return {at.x(), at.z()};
  }
  /* To the left. */
  double heading()
  {
    const Vector ahead = axes().col(0);
    return std::atan2(-ahead.z(), ahead.x());
  }
  JointReading wheel(uint32_t k) { return world.read_joint(world.id_of_joint(k)); }
  void change(uint32_t k, uint32_t axis, const JointAxis &to) { world.set_joint_axis(world.id_of_joint(k), axis, to); }
  /* Turns the front wheels and gives the motors their speeds by Ackermann's rule. angle: of the middle. */
  void steer(double angle, double speed)
  {
    const double curvature = std::tan(angle) / car_wheelbase;
    for (const uint32_t side : {0u, 1u}) {
      const double along = 1 + (side ? 0.5 : -0.5) * car_track * curvature;
      JointAxis axis;
      axis.lower = axis.upper = float(std::atan(car_wheelbase * curvature / along));
      change(side, steering_axis, axis);
      axis = world.scene().joints[2 + side].rotations[1];
      axis.target_velocity = float(-speed * along / car_wheel_radius);
      change(2 + side, rolling_axis, axis);
    }
  }
  std::set<uint32_t> wheels_on_ground()
  {
    std::set<uint32_t> found;
    for (const ContactEvent &event : world.contact_events())
      if (event.kind != ContactEvent::Kind::end && event.impulse > 0)
        for (const uint32_t body : {event.a, event.b})
          if (body > chassis && body <= chassis + 4) found.insert(body);
    return found;
  }

  uint32_t chassis = 0;
  World world;
};

/* The radius of the circle through three points. */
double radius_through(const Eigen::Vector2d &a, const Eigen::Vector2d &b, const Eigen::Vector2d &c)
{
  const Eigen::Vector2d ab = b - a, ac = c - a;
  return ab.norm() * ac.norm() * (c - b).norm() / (2 * std::abs(ab.x() * ac.y() - ab.y() * ac.x()));
}

/* The course of the middle of a rear axle over the hills without slip: its direction stays in the ground, where it
 * turns by the steering alone, so that without steering the course is a geodesic of the ground. */
struct Course {
  double height;           /* m, from valley to crest */
  Vector at, ahead, above; /* on the ground; its direction, and the ground's normal */

  double ground_at(double x, double z) const
  {
    const double waves = 2 * pi / 12;
    return height * (0.5 + 0.5 * std::cos(waves * (x - 0.5 * car_wheelbase)) * std::cos(waves * z));
  }
  void lay_down()
  {
    const double e = 1e-5;
    at.y() = ground_at(at.x(), at.z());
    above = Vector((ground_at(at.x() - e, at.z()) - ground_at(at.x() + e, at.z())) / (2 * e), 1,
                   (ground_at(at.x(), at.z() - e) - ground_at(at.x(), at.z() + e)) / (2 * e))
                .normalized();
    ahead = (ahead - ahead.dot(above) * above).normalized();
  }
  void advance(double speed, double angle, double time)
  {
    const int parts = 20;
    const double turn = speed / car_wheelbase * std::tan(angle) * time / parts;
    for (int k = 0; k < parts; ++k) {
      ahead = std::cos(turn) * ahead + std::sin(turn) * above.cross(ahead);
      at += speed * time / parts * ahead;
      lay_down();
    }
  }
};

} // namespace

TEST_CASE("vehicle: at rest each spring carries a quarter of the chassis", "[physics]")
{
  Car car("vehicle:speed=0,hills=0");
  run(car.world, 180);
  double upward = 0;
  for (uint32_t k = 0; k < 4; ++k) {
    const JointReading reading = car.wheel(k);
    const double target = double{car.world.scene().joints[k].directions[0].target_position};
    CHECK(reading.directions[0] - target == Approx(car_chassis * gravity / (4 * car_stiffness)).epsilon(0.01));
    CHECK(-reading.force[1] == Approx(car_chassis * gravity / 4).epsilon(0.01));
    upward -= reading.force[1];
  }
  CHECK(upward == Approx(car_chassis * gravity).epsilon(1e-3));
  CHECK(car.position().y() == Approx(car_wheel_radius + 0.25).margin(0.01));
  CHECK(fastest(car.world) < 0.01);
}

TEST_CASE("vehicle: the circle that it drives has the radius of Ackermann's rule", "[physics]")
{
  const double steering = GENERATE(-0.4, 0.1, 0.15, 0.3), radius = car_wheelbase / std::tan(std::abs(steering));
  Car car("vehicle:speed=2,hills=0,steering=" + std::to_string(steering));
  run(car.world, 60);
  std::vector<Eigen::Vector2d> points;
  const double start = car.heading();
  for (int third = 0; third < 3; ++third) {
    points.push_back(car.rear());
    run(car.world, int(radius / 2 * 60)); /* a radian */
  }
  const double driven = radius_through(points[0], points[1], points[2]);
  CAPTURE(steering, radius, driven);
  CHECK(driven == Approx(radius).epsilon(0.01));
  CHECK((std::remainder(car.heading() - start - (steering < 0 ? -3 : 3), 2 * pi)) == Approx(0).margin(0.05));
}

TEST_CASE("vehicle: locked wheels brake within the distance that friction allows", "[physics]")
{
  const double speed = GENERATE(5.0, 12.0), friction = GENERATE(0.5, 0.9);
  Car car("vehicle:hills=0,steering=0,speed=" + std::to_string(speed) + ",friction=" + std::to_string(friction));
  run(car.world, 60);
  const double start = car.position().x(), at = double{car.world.bodies()[car.chassis].linear_velocity[0]};
  CHECK(at == Approx(speed).epsilon(0.005));
  for (uint32_t k = 0; k < 4; ++k) car.change(k, rolling_axis, {.friction = 1e5f});
  run(car.world, int(60 * speed / (friction * gravity)) + 60);
  const double distance = car.position().x() - start, least = at * at / (2 * friction * gravity);
  CAPTURE(speed, friction, distance, least);
  CHECK(distance < 1.02 * least);
  CHECK(distance > 0.95 * least); /* friction allows no shorter one */
  CHECK(fastest(car.world) < 0.05);
}

TEST_CASE("vehicle: a slalom over hills keeps to the course that does not slip, upright and on its wheels", "[physics]")
{
  const double speed = 6, period = 4, sway = 0.12, hills = 0.3;
  Settings settings;
  settings.events = true;
  Car car("vehicle:steering=0,speed=6,hills=0.3", settings);
  run(car.world, 45); /* it starts a little above the ground */
  Course course{hills, {car.rear().x(), 0, car.rear().y()}, car.axes().col(0), {}};
  course.lay_down();
  std::vector<int> off_ground(4);
  int longest = 0, on_mesh = 0;
  double worst = 0, worst_height = 0, widest = 0, least_upright = 1;
  for (int k = 0; k < 280; ++k) {
    const double angle = sway * std::cos(2 * pi * k / 60 / period);
    car.steer(angle, speed);
    car.world.step();
    course.advance(speed, angle, 1.0 / 60);
    const Eigen::Vector2d at = car.rear();
    worst = std::max(worst, std::hypot(at.x() - course.at.x(), at.y() - course.at.z()));
    widest = std::max(widest, std::abs(at.y()));
    const Vector chassis = car.position();
    worst_height = std::max(
        worst_height, std::abs(chassis.y() - car_wheel_radius - 0.25 - course.ground_at(chassis.x(), chassis.z())));
    least_upright = std::min(least_upright, car.upright());
    const std::set<uint32_t> touching = car.wheels_on_ground();
    for (uint32_t wheel = 0; wheel < 4; ++wheel) {
      off_ground[wheel] = touching.count(car.chassis + 1 + wheel) ? 0 : off_ground[wheel] + 1;
      longest = std::max(longest, off_ground[wheel]);
    }
    on_mesh += car.position().y() > car_wheel_radius + 0.25 + 0.1;
  }
  CAPTURE(worst, worst_height, widest, least_upright, longest, on_mesh);
  CHECK(worst < 0.25);
  CHECK(worst_height < 0.1); /* the wheels span a fifth of a wave */
  CHECK(widest > 0.5);
  CHECK(least_upright > 0.98);
  CHECK(longest < 20);
  CHECK(on_mesh > 60);
  CHECK(car.wheels_on_ground().size() == 4);
}
