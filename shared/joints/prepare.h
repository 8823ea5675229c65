/* prepare.h - joints at the two ends of a step: how far their bodies are apart, and the impulses of the last step. */
#ifndef TANDEM_SHARED_JOINTS_PREPARE_H
#define TANDEM_SHARED_JOINTS_PREPARE_H

#include "shared/joints/axes.h"

/* Where the arm of a side begins: the centre of its body, or the frame in the world. */
SHARED double_float3 load_origin(read_joint_places places, uint_lanes body, item_index i)
{
  mask is_world = body == (uint_lanes)INDEX_NONE;
  double_float3 origin = load_position(places.position, body_of_side(body));
  if (!MAY_OCCUR(JOINTS_TO_WORLD) || !any_of(is_world)) return origin;
  double_float3 frame = load_position(places.world_frame, i + (uint_lanes)0u);
  origin.high = choose3(is_world, frame.high, origin.high);
  origin.low = choose3(is_world, frame.low, origin.low);
  return origin;
}

SHARED void prepare_axes(GLOBAL const Parameters *parameters, GLOBAL const float4 *cached, GLOBAL float4 *impulse,
                         item_index i)
{
  real kept = (real)parameters->warm_start_scale;
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    vec4 old = load_float4(cached, joint_plane(parameters, k) + i);
    store_float4(impulse, joint_plane(parameters, k) + i, extend(scale(xyz(old), kept), old.w));
  }
}

/* A body with a joint does not fall freely. */
SHARED void prepare_joints_item(GLOBAL const Parameters *parameters, GLOBAL const uint *joint_a,
                                GLOBAL const uint *joint_b, read_joint_places places, read_cached_joint_impulses cached,
                                GLOBAL float4 *joint_offset, write_joint_impulses impulses, GLOBAL uint *body_falls,
                                item_index i)
{
  uint_lanes a = load_uint(joint_a, i), b = load_uint(joint_b, i);
  double_float3 from = load_origin(places, a, i), to = load_origin(places, b, i);
  store_float4(joint_offset, i, extend(add(subtract(to.high, from.high), subtract(to.low, from.low)), R(0.0)));
  real kept = (real)parameters->warm_start_scale;
  store_float4(impulses.linear, i, extend(scale(xyz(load_float4(cached.linear, i)), kept), R(0.0)));
  if (HAS_FEATURE(parameters, JOINT_FRAMES))
    store_float4(impulses.angular, i, extend(scale(xyz(load_float4(cached.angular, i)), kept), R(0.0)));
  if (HAS_FEATURE(parameters, JOINT_AXES)) prepare_axes(parameters, cached.axis, impulses.axis, i);
  atomic_clear_if(a != (uint_lanes)INDEX_NONE, body_falls, a);
  atomic_clear_if(b != (uint_lanes)INDEX_NONE, body_falls, b);
}

/* For a solver that begins each substep without impulses. */
SHARED void clear_joints_item(GLOBAL const Parameters *parameters, write_joint_impulses impulses, item_index i)
{
  vec4 none = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_float4(impulses.linear, i, none);
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) store_float4(impulses.angular, i, none);
  if (!HAS_FEATURE(parameters, JOINT_AXES)) return;
  for (uint k = 0; k < parameters->joint_axes; ++k) store_float4(impulses.axis, joint_plane(parameters, k) + i, none);
}

SHARED void cache_joints_item(GLOBAL const Parameters *parameters, read_joint_impulses impulses,
                              write_cached_joint_impulses cached, item_index i)
{
  store_float4(cached.linear, i, load_float4(impulses.linear, i));
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) store_float4(cached.angular, i, load_float4(impulses.angular, i));
  if (!HAS_FEATURE(parameters, JOINT_AXES)) return;
  for (uint k = 0; k < parameters->joint_axes; ++k)
    store_float4(cached.axis, joint_plane(parameters, k) + i,
                 load_float4(impulses.axis, joint_plane(parameters, k) + i));
}

#endif
