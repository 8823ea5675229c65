/* machines.cpp - the scenes of machines.h, with the geometry of each at its builder. */
#include "host/catalog/machines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tandem/round_to_float.h>

#include "host/catalog/builders.h"

namespace tandem {

using namespace scene_builders;

namespace {

constexpr Quat cylinder_to_z{0.70710678f, 0, 0, 0.70710678f}; /* of a cylinder */
constexpr Quat axis_to_z{0, -0.70710678f, 0, 0.70710678f};    /* of the axis of a joint */
constexpr Quat axis_down{0, 0, -0.70710678f, 0.70710678f};

Body &add_machine_part(Scene &scene, uint32_t shape, const Point &at, double mass, const char *name)
{
  Body &part = add_body(scene, shape, at, round_to_float(mass));
  part.name = name;
  return part;
}

/* Parts of a machine pass through each other. */
void let_pass(Body &body)
{
  body.filter_group = 2;
  body.filter_mask = ~2u;
}

Joint &hold_to_world(Scene &scene, JointType type, const Point &in_world, uint32_t body, const Quat &axes,
                     const Quat &axes_of_body)
{
  Joint joint;
  joint.type = type;
  joint.body_b = body;
  joint.position_a = in_world;
  joint.orientation_a = axes;
  joint.orientation_b = axes_of_body;
  return scene.joints.emplace_back(joint);
}

/* --- motor-mill: a motor drives a train of gears, and every other one of them turns paddles on its shaft, which throw
 * the stones that fall on them
 *
 *       . : .       . : .        stones
 *    o O-+-o O-+-o O             small and large wheels in turn, side by side; the first has the motor
 *    ===================
 */

constexpr double module_of_teeth = 0.05; /* m, the radius of a wheel for each two of its teeth */
constexpr int32_t small_teeth = 12, large_teeth = 20;

int32_t teeth_of(int64_t wheel) { return wheel % 2 == 0 ? small_teeth : large_teeth; }
double radius_of(int64_t wheel) { return 0.5 * module_of_teeth * teeth_of(wheel); }

uint64_t motor_mill_bodies(const SceneValues &v)
{
  const int64_t wheels = whole(v, "wheels");
  return 1 + uint64_t(wheels + wheels / 2 + whole(v, "stones"));
}

/* Two crossed blades, on the shaft of a wheel. */
void add_paddles(Scene &scene, uint32_t shape, uint32_t wheel, const Point &at)
{
  const auto paddles = static_cast<uint32_t>(scene.bodies.size());
  add_machine_part(scene, shape, {at[0], at[1], 0.55}, 60, "paddles");
  Joint joint;
  joint.type = JointType::fixed;
  joint.body_a = wheel;
  joint.body_b = paddles;
  joint.position_a = {0, 0.55, 0}; /* the axis y of the wheel is the shaft */
  joint.orientation_a = {-0.70710678f, 0, 0, 0.70710678f};
  scene.joints.push_back(joint);
}

Child blade(float half_width, float half_height)
{
  Child child;
  child.shape = box_shape(half_width, half_height, 0.4f);
  return child;
}

void add_train(Scene &scene, int64_t wheels, double height, float speed)
{
  const uint32_t small = add_shape(scene, cylinder_shape(round_to_float(radius_of(0)), 0.05f)),
                 large = add_shape(scene, cylinder_shape(round_to_float(radius_of(1)), 0.05f)),
                 cross = add_shape(scene, compound_shape({blade(0.45f, 0.04f), blade(0.04f, 0.45f)}));
  double x = -(radius_of(0) + radius_of(1)) * 0.5 * double(wheels - 1);
  std::vector<uint32_t> axles;
  for (int64_t i = 0; i < wheels; ++i, x += radius_of(0) + radius_of(1)) {
    const auto wheel = static_cast<uint32_t>(scene.bodies.size());
    Body &body = add_machine_part(scene, i % 2 == 0 ? small : large, {x, height, 0}, i % 2 == 0 ? 10 : 28, "wheel");
    body.orientation = cylinder_to_z;
    let_pass(body);
    axles.push_back(static_cast<uint32_t>(scene.joints.size()));
    /* both axes x are along the shaft: y of the wheel */
    hold_to_world(scene, JointType::hinge, {x, height, 0}, wheel, axis_to_z, {-0.5f, -0.5f, 0.5f, 0.5f});
    if (i > 0) {
      Coupling mesh;
      mesh.joint_a = axles[size_t(i - 1)];
      mesh.joint_b = axles[size_t(i)];
      mesh.teeth_a = teeth_of(i - 1);
      mesh.teeth_b = teeth_of(i);
      scene.couplings.push_back(mesh);
    }
    if (i % 2 == 1) add_paddles(scene, cross, wheel, {x, height, 0});
  }
  JointAxis &motor = scene.joints[axles[0]].rotations[0];
  motor.target_velocity = speed;
  motor.motor = true;
  motor.max_force = 2000;
}

Scene motor_mill(const SceneValues &v)
{
  const int64_t wheels = whole(v, "wheels"), stones = whole(v, "stones");
  const double height = 1.2, span = (radius_of(0) + radius_of(1)) * 0.5 * double(wheels - 1);
  Scene scene;
  add_ground(scene);
  add_train(scene, wheels, height, round_to_float(number(v, "speed")));
  Random random(uint64_t(whole(v, "seed")));
  const uint32_t ball = add_shape(scene, sphere_shape(0.09f));
  for (int64_t i = 0; i < stones; ++i) {
    const double x = random.uniform(-span, span), z = random.uniform(0.3, 0.8);
    add_machine_part(scene, ball, {x, height + 1 + 0.06 * double(i), z}, 6, "stone");
  }
  return scene;
}

/* --- crane: a trolley on a beam, and a rope over it that lifts a load while a winch on the mast pulls; two parts of
 * the rope carry the load
 *
 *   winch |  trolley
 *     |====|==[]==========|     the slider of the trolley and that of the winch have motors
 *     w    |  ||          |     2 (trolley to load) + (way of the winch) is the length of the rope
 *     |    |  ##     ....
 */

uint64_t crane_bodies(const SceneValues &v) { return 6 + uint64_t(whole(v, "rows") * whole(v, "length")); }

void drive_axis(JointAxis &axis, double speed, double way, double force)
{
  axis.motor = true;
  axis.target_velocity = round_to_float(speed);
  axis.max_force = round_to_float(force);
  axis.lower = round_to_float(std::min(0.0, way));
  axis.upper = round_to_float(std::max(0.0, way));
}

Scene crane(const SceneValues &v)
{
  const double height = 6, start = -4, load_height = 0.6, drop = height - 2 * load_height, lift = number(v, "lift");
  Scene scene;
  add_ground(scene);
  const uint32_t trolley = add_shape(scene, box_shape(0.5f, 0.15f, 0.4f)),
                 load = add_shape(scene, box_shape(0.6f, round_to_float(load_height), 0.6f)),
                 winch = add_shape(scene, box_shape(0.2f, 0.3f, 0.2f)),
                 brick = add_shape(scene, box_shape(0.25f, 0.25f, 0.5f));
  add_machine_part(scene, trolley, {start, height, 0}, 300, "trolley");
  add_machine_part(scene, load, {start, load_height, 0}, number(v, "mass"), "load").angular_damping = 0.5f;
  add_machine_part(scene, winch, {start - 2, height, 0}, 100, "winch");
  const uint32_t beam = add_shape(scene, box_shape(7, 0.15f, 0.15f)),
                 mast = add_shape(scene, box_shape(0.15f, 3.1f, 0.15f));
  for (const auto &[shape, at] : {std::pair(beam, Point{0, height + 0.35, 0}), std::pair(mast, Point{-6.8, 3.1, 0})})
    add_machine_part(scene, shape, at, 1, "frame").type = BodyType::fixed;
  hold_to_world(scene, JointType::slider, {start, height, 0}, 1, {0, 0, 0, 1}, {0, 0, 0, 1});
  drive_axis(scene.joints.back().directions[0], number(v, "speed"), -2 * start, 2e4);
  hold_to_world(scene, JointType::slider, {start - 2, height, 0}, 3, axis_down, axis_down);
  drive_axis(scene.joints.back().directions[0], 1.5 * number(v, "speed"), 2 * lift, 1e6);
  Joint rope;
  rope.type = JointType::distance;
  rope.body_a = 1;
  rope.body_b = 2;
  rope.position_b = {0, load_height, 0};
  scene.joints.push_back(rope);
  Coupling pulley;
  pulley.type = CouplingType::pulley;
  pulley.joint_a = 1;
  pulley.joint_b = 2;
  pulley.ratio = 2;
  pulley.offset = round_to_float(2 * drop);
  pulley.name = "rope";
  scene.couplings.push_back(pulley);
  for (int64_t row = 0; row < whole(v, "rows"); ++row)
    for (int64_t k = 0; k < whole(v, "length"); ++k)
      add_machine_part(scene, brick,
                       {2, 0.25 + 0.5 * double(row), 1.02 * (double(k) - 0.5 * double(whole(v, "length") - 1))}, 40,
                       "brick");
  return scene;
}

} // namespace

std::vector<BuiltInScene> machine_scenes()
{
  return {
      {"motor-mill",
       "a motor drives a train of gears whose paddles throw stones",
       {{"wheels", integer, 7, 2, 10000, "of the train, small and large in turn"},
        {"stones", integer, 120, 0, 1000000, "that fall on the paddles"},
        {"speed", real, 6, -100, 100, "of the motor, rad/s"},
        seed_parameter()},
       motor_mill_bodies,
       motor_mill},
      {"crane",
       "a trolley with a load on a rope over a pulley, and a wall in its way",
       {{"mass", real, 1000, 1, 100000, "of the load, kg"},
        {"speed", real, 1, 0.01, 10, "of the trolley, m/s"},
        {"lift", real, 1, 0, 2.5, "how high the load is lifted, m"},
        {"rows", integer, 6, 0, 1000, "rows of bricks"},
        {"length", integer, 4, 1, 1000, "bricks in a row"}},
       crane_bodies,
       crane},
  };
}

} // namespace tandem
