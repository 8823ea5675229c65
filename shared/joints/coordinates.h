/* coordinates.h - the coordinates of a joint that its axes limit, drive and brake, and how they change with the motion
 * of the bodies.
 *
 * Rotation of frame b in frame a is a twist about x, and then a swing, which takes the axis x along the shortest arc:
 *
 *        x of a ^   ^ x of b          twist    about x, -pi .. pi
 *                \  |  /              swing y  about y, of the swing alone; swing z about z
 *                 \ | / cone          cone     the angle between the axes x, 0 .. pi
 *                  \|/               around   no coordinate but a speed: of the way around the cone
 *
 * After Dobrowolski, "Swing-twist decomposition in Clifford algebra", 2015. Universal joints and wheels keep the axis y
 * of frame b at right angles to x of frame a; that coordinate, `cross`, is 0. They turn about both without end:
 *
 *        x of a ^    ,y of b           turn     of y of b about x of a: a wheel is steered
 *               |  ,/                  spin     about y of b: it rolls
 *               |,/
 */
#ifndef TANDEM_SHARED_JOINTS_COORDINATES_H
#define TANDEM_SHARED_JOINTS_COORDINATES_H

#include "shared/joints/frames.h"
#include "shared/trigonometry.h"

/* A coordinate, and its derivative by the velocities: direction . (velocity of b - of a, at frame b) + turn . (angular
 * velocity of b - of a). In axes of the world; m or rad. */
typedef struct {
  real value;
  vec3 direction, turn;
} joint_coordinate;

/* The axis x of frame b, and with it the swing, in axes of frame a. */
typedef struct {
  vec3 x_of_b;
  real swing_y, swing_z, swing_w; /* of the quaternion of the swing, w >= 0 */
} joint_swing;

#define LEAST_SWING R(1e-6)

SHARED joint_swing swing_of(quat q)
{
  real squared = q.x * q.x + q.w * q.w;
  mask turns = squared > LEAST_SWING * LEAST_SWING; /* at half a turn the twist is not defined */
  real w = square_root(choose(turns, squared, (real)R(1.0)));
  joint_swing s;
  s.x_of_b = make_vec3(R(1.0) - R(2.0) * (q.y * q.y + q.z * q.z), R(2.0) * (q.x * q.y + q.w * q.z),
                       R(2.0) * (q.x * q.z - q.w * q.y));
  s.swing_y = choose(turns, (q.y * q.w - q.x * q.z) / w, q.y);
  s.swing_z = choose(turns, (q.x * q.y + q.z * q.w) / w, q.z);
  s.swing_w = choose(turns, w, (real)R(0.0));
  return s;
}

SHARED real twist_of(quat q)
{
  mask flips = q.w < R(0.0);
  return R(2.0) * arc_tangent(choose(flips, -q.x, q.x), choose(flips, -q.w, q.w));
}

/* The twist turns about the axis half-way between both axes x, and faster than the bodies as these part. */
SHARED vec3 twist_axis(vec3 x_of_b)
{
  real along = maximum(R(1.0) + x_of_b.x, R(0.01));
  return make_vec3(R(1.0), x_of_b.y / along, x_of_b.z / along);
}

/* How the two angles of the swing change, by p = (0, y, z), which is tan(angle / 4) of the swing along its axis: the
 * angles are 4 arc_tangent(y) and 4 arc_tangent(z). Where both are there, each changes as the body turns about all
 * three axes. twist: the axis of the twist, which takes its part away from the swing. */
SHARED vec3 swing_y_axis(real y, real z, vec3 twist)
{
  vec3 axis = make_vec3(R(-4.0) * z, R(1.0) + y * y - z * z - R(2.0) * z * twist.y, R(2.0) * z * (y - twist.z));
  return scale(axis, R(1.0) / (R(1.0) + y * y));
}

SHARED vec3 swing_z_axis(real y, real z, vec3 twist)
{
  vec3 axis = make_vec3(R(4.0) * y, R(2.0) * y * (z + twist.y), R(1.0) + z * z - y * y + R(2.0) * y * twist.z);
  return scale(axis, R(1.0) / (R(1.0) + z * z));
}

SHARED joint_coordinate direction_coordinate(joint j, joint_frames f, uint_lanes kind)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  mask is_x = kind == (uint_lanes)(uint)JOINT_AXIS_X, is_y = kind == (uint_lanes)(uint)JOINT_AXIS_Y;
  vec3 axis = choose3(is_x, axis_x(f.axes), choose3(is_y, axis_y(f.axes), axis_z(f.axes)));
  joint_coordinate c = {dot3(axis, j.gap), axis, none};
  return c;
}

/* Frames in one place are apart along x of frame a. */
SHARED joint_coordinate distance_coordinate(joint j, joint_frames f)
{
  real distance = length_of(j.gap);
  mask apart = distance > R(0.0);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  joint_coordinate c = {
      distance, choose3(apart, scale(j.gap, R(1.0) / choose(apart, distance, (real)R(1.0))), axis_x(f.axes)), none};
  return c;
}

/* About which the angle of the cone grows. across: the sine of half of that angle. */
SHARED vec3 cone_axis(joint_swing s, real across)
{
  mask leans = across > LEAST_SWING;
  real inverse = R(1.0) / choose(leans, across, (real)R(1.0));
  return choose3(leans, make_vec3(R(0.0), s.swing_y * inverse, s.swing_z * inverse), make_vec3(R(0.0), R(1.0), R(0.0)));
}

/* About which x of b goes around x of a: at right angles to the axes of the twist and of the cone. */
SHARED vec3 axis_around_cone(joint_swing s, real across, vec3 cone)
{
  return make_vec3(-across, s.swing_w * cone.z, -(s.swing_w * cone.y));
}

/* The rotations; in axes of frame a. */
SHARED joint_coordinate rotation_coordinate(joint_frames f, uint_lanes kind)
{
  joint_swing s = swing_of(f.relative);
  real across = square_root(s.swing_y * s.swing_y + s.swing_z * s.swing_z);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  vec3 twist = twist_axis(s.x_of_b), cone = cone_axis(s, across);
  real share = R(1.0) / (R(1.0) + s.swing_w), y = s.swing_y * share, z = s.swing_z * share;
  joint_coordinate c = {R(0.0), none, twist};
  mask is_y = kind == (uint_lanes)(uint)JOINT_AXIS_SWING_Y, is_z = kind == (uint_lanes)(uint)JOINT_AXIS_SWING_Z,
       is_cone = kind == (uint_lanes)(uint)JOINT_AXIS_CONE, is_around = kind == (uint_lanes)(uint)JOINT_AXIS_AROUND,
       is_twist = kind == (uint_lanes)(uint)JOINT_AXIS_TWIST;
  if (any_of(is_twist)) c.value = choose(is_twist, twist_of(f.relative), c.value);
  if (any_of(is_y)) c.value = choose(is_y, R(4.0) * arc_tangent(s.swing_y, R(1.0) + s.swing_w), c.value);
  if (any_of(is_z)) c.value = choose(is_z, R(4.0) * arc_tangent(s.swing_z, R(1.0) + s.swing_w), c.value);
  if (any_of(is_cone)) c.value = choose(is_cone, R(2.0) * arc_tangent(across, s.swing_w), c.value);
  c.turn = choose3(is_y, swing_y_axis(y, z, twist), c.turn);
  c.turn = choose3(is_z, swing_z_axis(y, z, twist), c.turn);
  c.turn = choose3(is_cone, cone, c.turn);
  c.turn = choose3(is_around, axis_around_cone(s, across, cone), c.turn);
  return c;
}

/* The sine of how far y of frame b leans towards x of frame a. */
SHARED joint_coordinate cross_coordinate(joint_frames f)
{
  mat3 b = rotation_of(f.relative);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0)), y = axis_y(b);
  joint_coordinate c = {-y.x, none, cross3(make_vec3(R(1.0), R(0.0), R(0.0)), y)};
  return c;
}

/* The angle of a vector about an axis, of its two parts across the axis: value, and the turn that changes it, along the
 * axis and these. */
SHARED joint_coordinate angle_about_axis(real along, real first, real second)
{
  real squared = first * first + second * second;
  mask defined = squared > LEAST_SWING;
  real share = zero_if(!defined, along / choose(defined, squared, (real)R(1.0)));
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  joint_coordinate c = {arc_tangent(second, first), none, make_vec3(R(1.0), -share * first, -share * second)};
  return c;
}

/* y of frame b about x of frame a. */
SHARED joint_coordinate turn_coordinate(joint_frames f)
{
  vec3 y = axis_y(rotation_of(f.relative));
  return angle_about_axis(y.x, y.y, y.z);
}

/* x of frame a as seen from b, about y of frame b, the other way round. */
SHARED joint_coordinate spin_coordinate(joint_frames f)
{
  mat3 b = rotation_of(f.relative);
  joint_coordinate c = angle_about_axis(axis_y(b).x, axis_x(b).x, axis_z(b).x);
  c.turn = rotate(b, make_vec3(c.turn.y, c.turn.x, c.turn.z));
  return c;
}

SHARED mask is_rotation(uint_lanes kind)
{
  return (kind >= (uint_lanes)(uint)JOINT_AXIS_TWIST) & (kind <= (uint_lanes)(uint)JOINT_AXIS_AROUND);
}

SHARED joint_coordinate choose_coordinate(mask m, joint_coordinate a, joint_coordinate b)
{
  joint_coordinate c = {choose(m, a.value, b.value), choose3(m, a.direction, b.direction), choose3(m, a.turn, b.turn)};
  return c;
}

SHARED joint_coordinate coordinate_of(joint j, joint_frames f, uint_lanes kind)
{
  joint_coordinate c = direction_coordinate(j, f, kind);
  mask turns = is_rotation(kind), crosses = kind == (uint_lanes)(uint)JOINT_AXIS_CROSS,
       is_distance = kind == (uint_lanes)(uint)JOINT_AXIS_DISTANCE;
  if (any_of(is_distance)) c = choose_coordinate(is_distance, distance_coordinate(j, f), c);
  if (any_of(turns | crosses)) {
    joint_coordinate r = rotation_coordinate(f, kind);
    mask steers = kind == (uint_lanes)(uint)JOINT_AXIS_TURN, spins = kind == (uint_lanes)(uint)JOINT_AXIS_SPIN;
    if (any_of(steers)) r = choose_coordinate(steers, turn_coordinate(f), r);
    if (any_of(spins)) r = choose_coordinate(spins, spin_coordinate(f), r);
    if (any_of(crosses)) r = choose_coordinate(crosses, cross_coordinate(f), r);
    r.turn = rotate(f.axes, r.turn);
    c = choose_coordinate(turns | crosses, r, c);
  }
  return c;
}

#endif
