/* vehicle.cpp - the scene of vehicle.h: cars side by side that drive a constant curve over a mesh of gentle hills.
 *
 *            ____
 *      _____/    |__      y ^   joint x up: the suspension, from the chassis to the wheel
 *     |__ _________ _|      +--> x, ahead; z to the right
 *       (o)       (o)       the wheels at the back have motors, those in front are steered
 *
 * Ackermann's rule: the axles of all wheels meet in one point, on the line of the rear axle, so that no wheel slips
 * sideways. With d the steering angle of the middle and L the wheelbase, that point is L / tan d beside the middle of
 * the rear axle. There is no differential, so each motor has the speed of its own circle.
 */
#include "host/catalog/vehicle.h"

#include <algorithm>
#include <cmath>

#include <tandem/round_to_float.h>

#include "host/base/trigonometry.h"
#include "host/catalog/builders.h"

namespace tandem {

using namespace scene_builders;

namespace {

constexpr double wheelbase = 2.5, track = 1.6, wheel_radius = 0.35, wheel_half_width = 0.12;    /* m */
constexpr double chassis_mass = 1000, wheel_mass = 20;                                          /* kg */
constexpr double stiffness = 25000, damping = 2500, travel = 0.15;                              /* N/m, N s/m, m */
constexpr double chassis_above_axles = 0.25, chassis_half[3] = {1.8, 0.22, 0.62}, torque = 600; /* m, N m */
constexpr double pitch = 5;                                                                     /* m, between cars */
constexpr double root_half = 0.70710678118654752;

/* From the middle of the rear axle. The first two are in front. */
struct Mount {
  const char *name;
  double ahead, right;
};
constexpr Mount mounts[] = {{"front left wheel", wheelbase, -0.5 * track},
                            {"front right wheel", wheelbase, 0.5 * track},
                            {"rear left wheel", 0, -0.5 * track},
                            {"rear right wheel", 0, 0.5 * track}};

/* --- the hills ------------------------------------------------------------------------------------------------- */

constexpr double half_length = 40, shore = 6, depth = 0.1; /* m: the mesh ends below the plane around it */

struct Hills {
  double height, half_width; /* m */

  /* From 0 at the border of the mesh to 1 inside of the shore. */
  static double share(double to_border)
  {
    const double t = std::clamp(to_border / shore, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }
  double at(double x, double z) const
  {
    const double waves = 2 * M_PI / 12, inside = share(half_length - std::abs(x)) * share(half_width - std::abs(z));
    /* a crest under the middle of a car that starts at z = 0, so that it starts nearly level */
    const double wave = 0.5 + 0.5 * sine_cosine(waves * (x - 0.5 * wheelbase)).cosine * sine_cosine(waves * z).cosine;
    return inside * (height * wave + depth) - depth;
  }
  Shape mesh() const
  {
    const auto columns = static_cast<uint32_t>(2 * half_length) + 1, rows = static_cast<uint32_t>(2 * half_width) + 1;
    std::vector<float> heights;
    for (uint32_t i = 0; i < columns * rows; ++i)
      heights.push_back(round_to_float(at(i % columns - half_length, i / columns - half_width)));
    return height_field_shape(heights, columns, 1, 1, "hills");
  }
};

/* --- the cars -------------------------------------------------------------------------------------------------- */

/* Newton's method, which needs no inverse functions; the tangent is at most 2 in size. */
double angle_of_tangent(double tangent)
{
  double angle = tangent / (1 + std::abs(tangent));
  for (int round = 0; round < 8; ++round) {
    const SineCosine of = sine_cosine(angle);
    angle -= (of.sine - tangent * of.cosine) / (of.cosine + tangent * of.sine);
  }
  return angle;
}

/* How a car drives: speed of the middle of its rear axle, and 1 / the radius of its circle, to the left. */
struct Drive {
  double speed, curvature;

  double angle_of(const Mount &mount) const
  {
    return angle_of_tangent(mount.ahead * curvature / (1 + mount.right * curvature));
  }
  Vec3 velocity_at(double ahead, double right) const
  {
    return {round_to_float(speed * (1 + right * curvature)), 0, round_to_float(-speed * curvature * ahead)};
  }
  double rate_of(const Mount &mount) const /* rad/s about an axle that points to the right */
  {
    const double along = 1 + mount.right * curvature, across = mount.ahead * curvature;
    return -speed * std::sqrt(along * along + across * across) / wheel_radius;
  }
  double yaw() const { return speed * curvature; }
};

Child box_of_chassis(double x, double y, double z, const Vec3 &at)
{
  Child child;
  child.shape = box_shape(round_to_float(x), round_to_float(y), round_to_float(z));
  child.position = at;
  return child;
}

Shape chassis_shape()
{
  return compound_shape({box_of_chassis(chassis_half[0], chassis_half[1], chassis_half[2], {0, 0, 0}),
                         box_of_chassis(0.8, 0.2, 0.55, {-0.3f, 0.42f, 0})});
}

/* The moments are those of the lower box, where engine and axles are, so that the centre of mass is in its middle. */
Vec3 moments_of_chassis()
{
  const double x = chassis_half[0] * chassis_half[0], y = chassis_half[1] * chassis_half[1],
               z = chassis_half[2] * chassis_half[2], third = chassis_mass / 3;
  return {round_to_float(third * (y + z)), round_to_float(third * (x + z)), round_to_float(third * (x + y))};
}

void add_wheel(Scene &scene, uint32_t shape, const Mount &mount, const Point &axle, const Drive &drive)
{
  const double angle = drive.angle_of(mount), rate = drive.rate_of(mount);
  const SineCosine half = sine_cosine(0.5 * angle), whole = sine_cosine(angle);
  Body &wheel =
      add_body(scene, shape, {axle[0] + mount.ahead, axle[1], axle[2] + mount.right}, round_to_float(wheel_mass));
  wheel.name = mount.name;
  /* the cylinder's axis y to the right, and after that about the vertical */
  wheel.orientation = {round_to_float(root_half * half.cosine), round_to_float(root_half * half.sine),
                       round_to_float(-root_half * half.sine), round_to_float(root_half * half.cosine)};
  wheel.linear_velocity = drive.velocity_at(mount.ahead, mount.right);
  wheel.angular_velocity = {round_to_float(rate * whole.sine), round_to_float(drive.yaw()),
                            round_to_float(rate * whole.cosine)};
}

Joint suspension_of(const Mount &mount, uint32_t chassis, uint32_t wheel, const Drive &drive)
{
  Joint joint;
  joint.type = JointType::wheel;
  joint.body_a = chassis;
  joint.body_b = wheel;
  joint.position_a = {mount.ahead - 0.5 * wheelbase, -chassis_above_axles, mount.right};
  joint.orientation_a = {0.5f, 0.5f, 0.5f, 0.5f}; /* x up, y to the right */
  joint.directions[0] = {.lower = round_to_float(-travel),
                         .upper = round_to_float(travel),
                         .target_position = round_to_float(-0.25 * chassis_mass * 10 / stiffness),
                         .stiffness = round_to_float(stiffness),
                         .damping = round_to_float(damping)};
  joint.rotations[0].lower = joint.rotations[0].upper = round_to_float(drive.angle_of(mount));
  if (mount.ahead == 0)
    joint.rotations[1] = {
        .target_velocity = round_to_float(drive.rate_of(mount)), .motor = true, .max_force = round_to_float(torque)};
  return joint;
}

/* axle: the middle of the rear one. */
void add_car(Scene &scene, uint32_t chassis_shape, uint32_t wheel_shape, const Point &axle, const Drive &drive)
{
  const auto chassis = static_cast<uint32_t>(scene.bodies.size());
  Body &body = add_body(scene, chassis_shape, {axle[0] + 0.5 * wheelbase, axle[1] + chassis_above_axles, axle[2]},
                        round_to_float(chassis_mass));
  body.name = "chassis";
  body.inertia = moments_of_chassis();
  body.linear_velocity = drive.velocity_at(0.5 * wheelbase, 0);
  body.angular_velocity = {0, round_to_float(drive.yaw()), 0};
  for (uint32_t k = 0; k < std::size(mounts); ++k) {
    add_wheel(scene, wheel_shape, mounts[k], axle, drive);
    scene.joints.push_back(suspension_of(mounts[k], chassis, chassis + 1 + k, drive));
  }
}

/* Where no wheel is in the ground. */
double height_of_axles(const Hills &hills, double x, double z)
{
  double highest = 0;
  for (double ahead = -wheel_radius; ahead <= wheelbase + wheel_radius; ahead += 0.1)
    for (double right = -0.5 * track - wheel_half_width; right <= 0.5 * track + 2 * wheel_half_width; right += 0.1)
      highest = std::max(highest, hills.at(x + ahead, z + right));
  return highest + wheel_radius;
}

Scene vehicle(const SceneValues &v)
{
  const int64_t n = whole(v, "n");
  const SineCosine steering = sine_cosine(number(v, "steering"));
  const Drive drive{number(v, "speed"), steering.sine / (steering.cosine * wheelbase)};
  const Hills hills{number(v, "hills"), half_length + std::ceil(0.5 * pitch * double(n - 1))};
  Scene scene;
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = round_to_float(number(v, "friction"));
  add_ground(scene);
  if (hills.height > 0) {
    Body &mesh = add_body(scene, add_shape(scene, hills.mesh()));
    mesh.name = "hills";
    mesh.type = BodyType::fixed;
  }
  const uint32_t chassis = add_shape(scene, chassis_shape()),
                 wheel =
                     add_shape(scene, cylinder_shape(round_to_float(wheel_radius), round_to_float(wheel_half_width)));
  for (int64_t i = 0; i < n; ++i) {
    const double z = (double(i) - 0.5 * double(n - 1)) * pitch;
    add_car(scene, chassis, wheel, {0, hills.height > 0 ? height_of_axles(hills, 0, z) : wheel_radius, z}, drive);
  }
  return scene;
}

uint64_t vehicle_bodies(const SceneValues &v)
{
  return (number(v, "hills") > 0 ? 2 : 1) + (1 + std::size(mounts)) * uint64_t(whole(v, "n"));
}

} // namespace

BuiltInScene vehicle_scene()
{
  return {"vehicle",
          "cars on springs that drive a curve over gentle hills, a triangle mesh",
          {{"n", integer, 1, 1, 1000, "cars side by side"},
           {"speed", real, 6, 0, 30, "of the middle of the rear axle, m/s"},
           {"steering", real, 0.15, -0.5, 0.5, "angle of the middle of the front axle, to the left, rad"},
           {"hills", real, 0.3, 0, 1, "from valley to crest, m; 0: a plane, without a mesh"},
           {"friction", real, 0.9, 0, 10, "of tyres and ground"}},
          vehicle_bodies,
          vehicle};
}

} // namespace tandem
