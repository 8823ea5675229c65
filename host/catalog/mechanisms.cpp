/* mechanisms.cpp - the scenes of mechanisms.h, with the geometry of each at its builder. */
#include "host/catalog/mechanisms.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/base/trigonometry.h"
#include "host/catalog/builders.h"

namespace tandem {

using namespace scene_builders;

namespace {

/* --- newton-cradle: balls in a row, each on two rods from the rails of a frame -----------------------------------
 *
 *      =====o=o=o=o=o=====      seen from the side; the two rods of a ball form a V,      =     =
 *          /  | | | |           so that it swings in the plane of the others               \   /
 *         O   O O O O                                                                        O
 *
 * A contact bounces with the speed that its bodies have before the step. So the impact is passed on from ball to ball
 * if each pair meets in a step of its own. Two balls that have met go on with half the speed each to the end of that
 * step; the gap must be wider than that way.
 */

constexpr double steel = 7800; /* kg/m^3 */

Child beam(const Vec3 &half, const Vec3 &at)
{
  Child child;
  child.shape = box_shape(half[0], half[1], half[2]);
  child.position = at;
  return child;
}

/* Two rails along x, which end on posts. The frame's origin is in the middle between the rails. */
Shape cradle_frame(double half_length, double half_width, double height, double thick)
{
  const auto x = round_to_float(half_length), y = round_to_float(0.5 * height), z = round_to_float(half_width),
             t = round_to_float(thick);
  std::vector<Child> beams;
  for (const float side : {-z, z}) {
    beams.push_back(beam({x, t, t}, {0, 0, side}));
    for (const float end : {-x, x}) beams.push_back(beam({t, y, t}, {end, -y, side}));
  }
  return compound_shape(std::move(beams));
}

struct Cradle {
  double length, radius, spacing, half_width; /* m; length: of the pendulum, from the rails down */
  uint32_t frame, shape;

  double rod() const { return std::sqrt(length * length + half_width * half_width); }
  void add_ball(Scene &scene, double x, double height, const SineCosine &angle) const
  {
    const auto ball = static_cast<uint32_t>(scene.bodies.size());
    add_body(scene, shape, {x - length * angle.sine, height - length * angle.cosine, 0},
             round_to_float(steel * 4 / 3 * M_PI * radius * radius * radius));
    for (const double side : {-half_width, half_width}) {
      Joint joint;
      joint.type = JointType::distance;
      joint.body_a = frame;
      joint.body_b = ball;
      joint.position_a = {x, 0, side};
      joint.directions[0].lower = joint.directions[0].upper = round_to_float(rod());
      scene.joints.push_back(joint);
    }
  }
};

void check_cradle(int64_t n, int64_t raised)
{
  if (raised >= n)
    throw InputError(fmt::format("scene newton-cradle: raised={} of n={} balls; fewer than n are possible", raised, n));
}

Scene newton_cradle(const SceneValues &v)
{
  const int64_t n = whole(v, "n"), raised = whole(v, "raised");
  check_cradle(n, raised);
  const double length = number(v, "length"), radius = number(v, "radius") * length,
               spacing = 2 * radius + number(v, "gap"), height = length + 2 * radius,
               half_row = 0.5 * spacing * double(n - 1);
  Scene scene;
  scene.materials[0].restitution = 1;
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
  add_ground(scene);
  const double thick = 0.02 * length, half_width = 0.4 * length;
  Body &frame =
      add_body(scene, add_shape(scene, cradle_frame(half_row + length, half_width, height, thick)), {0, height, 0});
  frame.name = "frame";
  frame.type = BodyType::fixed;
  const Cradle cradle{length, radius, spacing, half_width, 1, add_shape(scene, sphere_shape(round_to_float(radius)))};
  const SineCosine angle = sine_cosine(number(v, "angle"));
  for (int64_t i = 0; i < n; ++i)
    cradle.add_ball(scene, spacing * double(i) - half_row, height, i < raised ? angle : SineCosine{0, 1});
  return scene;
}

/* --- four-bar: a motor turns the crank, and the rocker swings to and fro ------------------------------------------
 *
 *            C            B  end of the crank, C  end of the rocker
 *           / \ rocker    A and D are hinges to the world, the one in A has the motor
 *     B----/   \
 *      \  coupler
 *       A       D
 */

struct Linkage {
  double crank, coupler, rocker, ground; /* m */
};

/* Grashof's rule: the crank turns if it is the shortest bar, and with the longest no longer than the other two. */
void check_linkage(const Linkage &l)
{
  const double longest = std::max({l.coupler, l.rocker, l.ground}), sum = l.crank + l.coupler + l.rocker + l.ground;
  if (l.crank < std::min({l.coupler, l.rocker, l.ground}) && 2 * (l.crank + longest) < sum) return;
  throw InputError(fmt::format("scene four-bar: crank={}, coupler={}, rocker={}, ground={}: the crank cannot turn; it "
                               "must be the shortest, and with the longest shorter than the other two",
                               l.crank, l.coupler, l.rocker, l.ground));
}

/* Of points in the plane. */
struct Pin {
  double x, y;
};

/* Adds a bar between two pins, whose axis x points from the first to the second. Its shape is drawn in a layer of its
 * own, but it moves in the plane z = 0, so that pins turn no bar out of the plane. */
uint32_t add_bar(Scene &scene, const char *name, const Pin &from, const Pin &to, double z, double thick)
{
  const double x = to.x - from.x, y = to.y - from.y, length = std::sqrt(x * x + y * y), cosine = x / length;
  Body &bar =
      add_body(scene,
               add_shape(scene, box_shape(round_to_float(0.5 * length + thick), round_to_float(thick),
                                          round_to_float(0.5 * thick))),
               {0.5 * (from.x + to.x), 0.5 * (from.y + to.y), 0}, round_to_float(steel * 2 * thick * thick * length));
  bar.name = name;
  bar.shape_position = {0, 0, round_to_float(z)};
  bar.filter_group = 2; /* bars pass through each other */
  bar.filter_mask = ~2u;
  bar.orientation = {0, 0, round_to_float(std::copysign(std::sqrt(0.5 * (1 - cosine)), y)),
                     round_to_float(std::sqrt(0.5 * (1 + cosine)))};
  return static_cast<uint32_t>(scene.bodies.size() - 1);
}

/* The axis of a hinge is x of its frames; this turns it to z. */
constexpr Quat hinge_to_z{0, -0.70710678f, 0, 0.70710678f};

Joint &pin(Scene &scene, uint32_t a, const Point &at_a, uint32_t b, const Point &at_b)
{
  Joint joint;
  joint.type = JointType::hinge;
  joint.body_a = a;
  joint.body_b = b;
  joint.position_a = at_a;
  joint.position_b = at_b;
  joint.orientation_a = joint.orientation_b = hinge_to_z;
  return scene.joints.emplace_back(joint);
}

/* rate: rad/s, about a point that moves with the velocity (0, rise). */
void set_in_motion(Body &bar, double rate, const Pin &about, double rise)
{
  bar.angular_velocity = {0, 0, round_to_float(rate)};
  bar.linear_velocity = {round_to_float(-rate * (bar.position[1] - about.y)),
                         round_to_float(rise + rate * (bar.position[0] - about.x)), 0};
}

Scene four_bar(const SceneValues &v)
{
  const Linkage l{number(v, "crank"), number(v, "coupler"), number(v, "rocker"), number(v, "ground")};
  const double speed = number(v, "speed");
  check_linkage(l);
  const double thick = 0.1 * l.crank, base = 2 * l.crank, left = -0.5 * l.ground;
  /* the crank points along x at first; C is above the line from its end to D */
  const double from_end = l.ground - l.crank,
               x = (l.coupler * l.coupler - l.rocker * l.rocker + from_end * from_end) / (2 * from_end);
  const Pin a{left, base}, b{left + l.crank, base}, d{left + l.ground, base},
      c{b.x + x, base + std::sqrt(l.coupler * l.coupler - x * x)};
  Scene scene;
  add_ground(scene);
  const uint32_t crank = add_bar(scene, "crank", a, b, 0, thick),
                 coupler = add_bar(scene, "coupler", b, c, thick, thick),
                 rocker = add_bar(scene, "rocker", d, c, 0, thick);
  /* with the crank along the ground, coupler and rocker turn alike */
  const double rise = speed * l.crank, rate = -rise / from_end;
  set_in_motion(scene.bodies[crank], speed, a, 0);
  set_in_motion(scene.bodies[coupler], rate, b, rise);
  set_in_motion(scene.bodies[rocker], rate, d, 0);
  Joint &driven = pin(scene, no_body, {a.x, a.y, 0}, crank, {-0.5 * l.crank, 0, 0});
  driven.rotations[0].motor = true;
  driven.rotations[0].target_velocity = round_to_float(speed);
  pin(scene, crank, {0.5 * l.crank, 0, 0}, coupler, {-0.5 * l.coupler, 0, 0});
  pin(scene, coupler, {0.5 * l.coupler, 0, 0}, rocker, {0.5 * l.rocker, 0, 0});
  pin(scene, no_body, {d.x, d.y, 0}, rocker, {-0.5 * l.rocker, 0, 0});
  return scene;
}

} // namespace

std::vector<BuiltInScene> mechanism_scenes()
{
  return {
      {"newton-cradle",
       "balls in a row on pairs of rods; as many leave at one end as arrive at the other",
       {{"n", integer, 5, 2, 100000, "balls"},
        {"raised", integer, 1, 1, 100000, "balls that are let go together; fewer than n"},
        {"length", real, 4, 0.2, 100, "from the rails down to the balls, m"},
        {"radius", real, 0.1, 0.01, 0.3, "of a ball, in lengths"},
        {"gap", real, 0.04, 0, 10, "between neighbours at rest, m"},
        {"angle", real, 0.7, 0, 1.5, "from which balls are let go, rad"}},
       [](const SceneValues &v) { return 2 + uint64_t(whole(v, "n")); },
       newton_cradle},
      {"four-bar",
       "a linkage whose crank a motor turns and whose rocker swings",
       {{"crank", real, 0.2, 0.05, 1, "m; the shortest bar"},
        {"coupler", real, 0.7, 0.05, 5, "m, from crank to rocker"},
        {"rocker", real, 0.5, 0.05, 5, "m"},
        {"ground", real, 0.6, 0.05, 5, "m, between the hinges to the world"},
        {"speed", real, 3, -30, 30, "of the motor, rad/s"}},
       [](const SceneValues &) { return uint64_t{4}; },
       four_bar},
  };
}

} // namespace tandem
