/* box.h - a box described by its axes in the world, and the choice of one axis by its index.
 *
 * All box kernels of the narrowphase share it. Each choice is a select, never an indexed load or a branch, so that the
 * items of a vector may choose different axes.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_BOX_H
#define TANDEM_SHARED_NARROWPHASE_BOX_H

#include "shared/narrowphase/time_of_impact.h"

typedef struct {
  vec3 x, y, z; /* unit axes, in world axes */
  vec3 extent;  /* half extents along them */
} oriented_box;

/* The point of a box, in its own axes. */
SHARED vec3 nearest_in_box(vec3 point, vec3 extent)
{
  return make_vec3(clamped(point.x, -extent.x, extent.x), clamped(point.y, -extent.y, extent.y),
                   clamped(point.z, -extent.z, extent.z));
}

SHARED oriented_box oriented_box_of(vec4 orientation, vec3 extent)
{
  mat3 rotation = rotation_of(quat_from(orientation));
  oriented_box box;
  box.x = axis_x(rotation);
  box.y = axis_y(rotation);
  box.z = axis_z(rotation);
  box.extent = extent;
  return box;
}
/* The box after it has turned for a time with a constant angular velocity. */
SHARED oriented_box turned_box(oriented_box box, vec3 angular, real time)
{
  mat3 turn = turn_within(angular, time);
  oriented_box then = {rotate(turn, box.x), rotate(turn, box.y), rotate(turn, box.z), box.extent};
  return then;
}
SHARED oriented_box choose_box(mask m, oriented_box a, oriented_box b)
{
  oriented_box box;
  box.x = choose3(m, a.x, b.x);
  box.y = choose3(m, a.y, b.y);
  box.z = choose3(m, a.z, b.z);
  box.extent = choose3(m, a.extent, b.extent);
  return box;
}

/* The axis of index 0, 1 or 2, and the two axes that follow it in cyclic order. */
typedef struct {
  vec3 axis, u, v;
  real extent, extent_u, extent_v;
} box_frame;

SHARED real pick(uint_lanes k, real first, real second, real third)
{
  return choose(k == 0u, first, choose(k == 1u, second, third));
}
SHARED vec3 pick3(uint_lanes k, vec3 first, vec3 second, vec3 third)
{
  return choose3(k == 0u, first, choose3(k == 1u, second, third));
}
SHARED box_frame frame_of(oriented_box box, uint_lanes k)
{
  box_frame frame;
  frame.axis = pick3(k, box.x, box.y, box.z);
  frame.u = pick3(k, box.y, box.z, box.x);
  frame.v = pick3(k, box.z, box.x, box.y);
  frame.extent = pick(k, box.extent.x, box.extent.y, box.extent.z);
  frame.extent_u = pick(k, box.extent.y, box.extent.z, box.extent.x);
  frame.extent_v = pick(k, box.extent.z, box.extent.x, box.extent.y);
  return frame;
}

/* The face axis most parallel to a direction. Near ties go to the lower index, so that rounding noise cannot change the
 * choice for a box that stands on an edge. */
SHARED uint_lanes most_parallel_axis(oriented_box box, vec3 direction)
{
  real x = magnitude(dot3(box.x, direction)), y = magnitude(dot3(box.y, direction));
  real z = magnitude(dot3(box.z, direction)), lead = R(1e-3);
  mask y_leads = y > x + lead;
  uint_lanes k = choose(y_leads, (uint_lanes)1u, (uint_lanes)0u);
  return choose(z > choose(y_leads, y, x) + lead, (uint_lanes)2u, k);
}

#endif
