/* drives.h - springs, dampers and drives of the joints of a tree without a largest force, as a part of the mass matrix.
 *
 * With h the substep, k stiffness and c damping, the force at the end of the substep is  -k (x + h v' - target) -
 * c (v' - target speed). What of it goes with the new velocity v' stands on the diagonal of the mass matrix:
 *
 *     (M + armature + h (c + h k)) (v' - v) = h (force - k (x + h v - target) - c (v - target speed))
 *
 * so gains may be as large as floats are, and the whole tree answers at once. Drives with a largest force, motors,
 * limits and friction are rows (rows.h). The drive of a ball pulls frame b towards frame a, alike about all axes.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_DRIVES_H
#define TANDEM_SHARED_ARTICULATIONS_DRIVES_H

#include "shared/articulations/tree.h"
#include "shared/joints/axes.h"

/* The axis of a joint; kind JOINT_AXIS_X for angles, too: they count on beyond half a turn. */
SHARED joint_axis load_tree_axis(const articulation *t, tree_link l)
{
  vec4 range = load_row(t->range, tree_row(t, 1u, l.k, 0u)), drive = load_link(t, l.k, (uint)LINK_AXIS),
       limit = load_link(t, l.k, (uint)LINK_AXIS + 1u);
  joint_axis a = {(uint_lanes)(uint)JOINT_AXIS_X,
                  range.x,
                  range.y,
                  range.z,
                  range.w,
                  drive.x,
                  drive.y,
                  drive.z,
                  drive.w,
                  limit.x,
                  limit.y,
                  limit.z,
                  limit.w};
  return a;
}

/* What places a link. inertia: the implicit part of that of its joint. */
typedef struct {
  vec4 frame_a, orientation_a, frame_b, orientation_b, moments, drive;
  real inertia;
} link_constants;

SHARED link_constants load_link_constants(const articulation *t, tree_link l)
{
  link_constants c = {load_link(t, l.k, (uint)LINK_FRAME_A),
                      load_link(t, l.k, (uint)LINK_FRAME_A_ORIENTATION),
                      load_link(t, l.k, (uint)LINK_FRAME_B),
                      load_link(t, l.k, (uint)LINK_FRAME_B_ORIENTATION),
                      load_link(t, l.k, (uint)LINK_MOMENTS),
                      load_link(t, l.k, (uint)LINK_AXIS),
                      R(0.0)};
  return c;
}

/* kg m^2, or kg; h: of the substep. */
SHARED real implicit_inertia_of(const link_constants *c, real h)
{
  return c->frame_a.w + choose(c->moments.w > R(0.0), h * (c->drive.y + h * c->drive.x), (real)R(0.0));
}

/* The rotation vector of q: half a turn at most. */
SHARED vec3 rotation_vector(quat q)
{
  vec3 v = make_vec3(q.x, q.y, q.z);
  real size = length_of(v);
  mask turns = size > R(1e-9);
  real angle = R(2.0) * arc_tangent(size, magnitude(q.w));
  real factor = choose(turns, angle / choose(turns, size, (real)R(1.0)), (real)R(2.0));
  return scale(v, choose(q.w < R(0.0), -factor, factor));
}

/* The force of an implicit drive over the substep as its joint's velocity is now; numbers as of the velocity. */
SHARED vec3 implicit_drive_force(const articulation *t, tree_link l, vec4 position, vec3 velocity, real h)
{
  joint_axis a = load_tree_axis(t, l);
  mask implicit = load_link(t, l.k, (uint)LINK_MOMENTS).w > R(0.0);
  vec3 open = make_vec3(position.x - a.target, R(0.0), R(0.0)), target = make_vec3(a.target_speed, R(0.0), R(0.0));
  if (any_of(l.is_ball)) {
    open = choose3(l.is_ball, rotation_vector(quat_from(position)), open);
    target = choose3(l.is_ball, zero3(), target);
  }
  vec3 pull = scale(add_scaled(open, velocity, h), a.stiffness), brake = scale(subtract(velocity, target), a.damping);
  return choose3(implicit, negate(add(pull, brake)), zero3());
}

#endif
