/* bounds.h - the box around all points that a body can reach within the coming step.
 *
 *      +-----------------------+
 *      | +---+           +---+ |  The box contains the shape now and after the step, under its velocity and gravity and
 *      | | A | --------> |   | |  turned as far as its spin allows, and the margin within which contacts are
 *      | +---+           +---+ |  speculative.
 *      +-----------------------+
 *
 * It is the first stage of the broadphase. The bounds are rebuilt every step, so they need not hold any longer.
 */
#ifndef TANDEM_SHARED_BROADPHASE_BOUNDS_H
#define TANDEM_SHARED_BROADPHASE_BOUNDS_H

#include "shared/records.h"

/* The half extents of the axis-aligned box around a rotated shape (Arvo, Graphics Gems, 1990). */
SHARED vec3 half_extents(uint_lanes shape, vec3 size, mat3 rotation)
{
  vec3 box =
      make_vec3(dot3(absolute(rotation.x), size), dot3(absolute(rotation.y), size), dot3(absolute(rotation.z), size));
  vec3 sphere = make_vec3(size.x, size.x, size.x);
  vec3 everything = make_vec3(UNBOUNDED, UNBOUNDED, UNBOUNDED);
  return choose3(shape == (uint_lanes)SHAPE_HALF_SPACE, everything,
                 choose3(shape == (uint_lanes)SHAPE_SPHERE, sphere, box));
}

/* The half extents of a shape that has a pose: on both sides of the body's centre, as far as the box around the shape
 * reaches on either. */
SHARED vec3 posed_half_extents(GLOBAL const float4 *body_shape_pose, uint_lanes body, mat3 rotation)
{
  vec3 center = rotate(rotation, xyz(load_float4(body_shape_pose, body * 4u + 2u))),
       size = xyz(load_float4(body_shape_pose, body * 4u + 3u));
  vec3 extent =
      make_vec3(dot3(absolute(rotation.x), size), dot3(absolute(rotation.y), size), dot3(absolute(rotation.z), size));
  return add(absolute(center), extent);
}

/* The half extents of a body at its current pose. */
SHARED vec3 half_extents_of_body(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                 GLOBAL const float4 *body_shape_pose, uint_lanes body, vec3 size, mat3 rotation)
{
  uint_lanes shape = shape_of(load_uint(body_flags, body));
  vec3 extent = half_extents(shape, size, rotation);
  if (!HAS_FEATURE(parameters, CONVEX)) return extent;
  return choose3(is_general_shape(shape), posed_half_extents(body_shape_pose, body, rotation), extent);
}
/* The rounding of the centre and of the sums below: two ulps. */
SHARED vec3 rounding_of_bounds(vec3 center) { return scale(absolute(center), R(2.4e-7)); }

/* The extent of a shape that turns; it stays within its bounding sphere. */
SHARED real turned_extent(real extent, real radius, real turn)
{
  return choose(extent > radius, extent, minimum(radius, extent + turn * radius));
}
SHARED vec3 turned_extents(vec3 extent, real radius, real turn)
{
  return make_vec3(turned_extent(extent.x, radius, turn), turned_extent(extent.y, radius, turn),
                   turned_extent(extent.z, radius, turn));
}

/* Stores the bounds over the step of a body that now reaches `below` and `above` its centre. radius: the bounding
 * radius. The parameters are never assigned to, because rusticl passes two as one if the caller gives one vector
 * twice. */
SHARED void store_bounds_of_step(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                 GLOBAL const float4 *body_mass, GLOBAL const float4 *body_gravity,
                                 GLOBAL float4 *bounds, uint_lanes i, vec3 center, spatial_velocity m, vec3 below,
                                 vec3 above, real radius)
{
  real step = parameters->step, turn = length_of(m.angular) * step, margin = parameters->bounds_margin;
  vec3 spare = make_vec3(margin, margin, margin), rounding = rounding_of_bounds(center);
  vec3 reach_below = add(add(turned_extents(below, radius, turn), spare), rounding);
  vec3 reach_above = add(add(turned_extents(above, radius, turn), spare), rounding);

  real fall = choose(m.inverse_mass > R(0.0), load_float4(body_mass, i).w * step * step, (real)R(0.0));
  vec3 gravity = gravity_at(parameters, body_gravity, i);
  vec3 displacement = scale(m.linear, step), fallen = add_scaled(displacement, gravity, fall);
  vec3 low =
      make_vec3(minimum(R(0.0), minimum(displacement.x, fallen.x)), minimum(R(0.0), minimum(displacement.y, fallen.y)),
                minimum(R(0.0), minimum(displacement.z, fallen.z)));
  vec3 high =
      make_vec3(maximum(R(0.0), maximum(displacement.x, fallen.x)), maximum(R(0.0), maximum(displacement.y, fallen.y)),
                maximum(R(0.0), maximum(displacement.z, fallen.z)));
  if (HAS_FEATURE(parameters, CONTINUOUS)) {
    /* A body that it hits may deflect it and turn its spin into speed, so every pair that it can then reach is
     * needed. */
    real distance = maximum(length_of(displacement), length_of(fallen)) + turn * radius;
    vec3 anywhere = make_vec3(distance, distance, distance);
    mask continuous = is_continuous(load_uint(body_flags, i));
    low = choose3(continuous, negate(anywhere), low);
    high = choose3(continuous, anywhere, high);
  }
  store_float4(bounds, i * 2u, extend(add(subtract(center, reach_below), low), R(0.0)));
  store_float4(bounds, i * 2u + 1u, extend(add(add(center, reach_above), high), R(0.0)));
}

SHARED void compute_bounds_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                GLOBAL const float4 *body_shape, GLOBAL const float4 *body_shape_pose,
                                GLOBAL const float4 *body_mass, GLOBAL const float4 *body_gravity,
                                GLOBAL const float4 *body_position, GLOBAL const float4 *body_orientation,
                                GLOBAL const float4 *body_velocity, GLOBAL float4 *bounds, item_index i)
{
  vec4 size = load_float4(body_shape, i);
  mat3 rotation = rotation_of(quat_from(load_float4(body_orientation, i)));
  vec3 extent = half_extents_of_body(parameters, body_flags, body_shape_pose, i, xyz(size), rotation);
  store_bounds_of_step(parameters, body_flags, body_mass, body_gravity, bounds, i, load_position(body_position, i).high,
                       load_velocity(body_velocity, i), extent, extent, size.w);
}

/* The bounds of a body without motion or margin, for queries. */
SHARED void compute_query_bounds_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                      GLOBAL const float4 *body_shape, GLOBAL const float4 *body_shape_pose,
                                      GLOBAL const float4 *body_position, GLOBAL const float4 *body_orientation,
                                      GLOBAL float4 *bounds, item_index i)
{
  vec3 center = load_position(body_position, i).high, size = xyz(load_float4(body_shape, i));
  mat3 rotation = rotation_of(quat_from(load_float4(body_orientation, i)));
  vec3 extent =
      add(half_extents_of_body(parameters, body_flags, body_shape_pose, i, size, rotation), rounding_of_bounds(center));
  store_float4(bounds, i * 2u, extend(subtract(center, extent), R(0.0)));
  store_float4(bounds, i * 2u + 1u, extend(add(center, extent), R(0.0)));
}

#endif
