/* far_pairs.h - the kind of each pair, and the pairs with a capsule that are too far apart for their test to find
 * anything, which get no kind and no contacts.
 *
 *      (---------------)  reach of a        A core is a segment with a radius around all that its body can touch in the
 *     (  o-----------o  )                   step: a capsule's own segment, the centre of a ball, the longest axis of a
 *      (---------------)     (---)          box. Two bodies whose cores are farther apart than both reaches have no
 *                           (  o  ) b       contact.
 *
 * The bounds of slanted limbs overlap long before the limbs are near: of the pairs of a pile of people, four in five do
 * not touch. The test of two cores is a fraction of the test of two shapes. It drops only pairs whose contacts would
 * all lie beyond the reach of reach_of_pair() (time_of_impact.h), with a margin for rounding, so that the contacts are
 * the same.
 *
 * Parts of compounds have no cores, and neither have bodies that sleep. Two boxes are not compared by cores, because
 * the separating axis test makes contacts up to a gap along its axis, which is less than the distance.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_FAR_PAIRS_H
#define TANDEM_SHARED_NARROWPHASE_FAR_PAIRS_H

#include "shared/narrowphase/capsules.h"

/* A share of the size of a body, for the rounding of either test. */
#define CORE_MARGIN R(0.01)

/* to_end: from the middle to an end. radius: around the segment. */
typedef struct {
  vec3 to_end;
  real radius;
} core_segment;

/* The segment along the longest axis of a box, with a radius around its edges. */
SHARED core_segment core_of_box(mat3 rotation, vec3 extent)
{
  mask x_leads = (extent.x >= extent.y) & (extent.x >= extent.z), y_leads = extent.y >= extent.z;
  vec3 axis = choose3(x_leads, axis_x(rotation), choose3(y_leads, axis_y(rotation), axis_z(rotation)));
  real length = choose(x_leads, extent.x, choose(y_leads, extent.y, extent.z));
  real squared = length_squared(extent) - length * length;
  core_segment core = {scale(axis, length), square_root(maximum(squared, R(0.0)))};
  return core;
}

SHARED core_segment core_of_shape(uint_lanes shape, vec4 size, mat3 rotation, vec3 axis)
{
  mask is_box = shape == (uint_lanes)(uint)SHAPE_BOX, is_capsule = shape == (uint_lanes)(uint)SHAPE_CAPSULE;
  core_segment box = core_of_box(rotation, xyz(size));
  vec3 to_end = scale(rotate(rotation, axis), choose(is_capsule, size.y, (real)R(0.0)));
  core_segment core = {choose3(is_box, box.to_end, to_end), choose(is_box, box.radius, size.x)};
  return core;
}

/* Stores the middle and the reach of each core, and the way from the middle to an end. The reach grows by what velocity
 * and spin may close, and by the rounding of the middle, far from the origin. */
SHARED void find_cores_item(GLOBAL const Parameters *parameters, GLOBAL const uint *flags, GLOBAL const float4 *shapes,
                            GLOBAL const float4 *poses, read_bodies bodies, GLOBAL float4 *cores, item_index i)
{
  uint_lanes shape = shape_of(load_uint(flags, i));
  vec4 size = load_float4(shapes, i);
  mat3 rotation = rotation_of(quat_from(load_float4(bodies.orientation, i)));
  vec3 axis = axis_y(rotation_of(quat_from(load_float4(poses, i * 4u + 1u)))), none = make_vec3(R(0.0), R(0.0), R(0.0));
  core_segment core = core_of_shape(shape, size, rotation, axis);
  vec3 middle = choose3(shape == (uint_lanes)(uint)SHAPE_CAPSULE, xyz(load_float4(poses, i * 4u)), none);
  vec3 center = add(load_position(bodies.position, i).high, rotate(rotation, middle));
  spatial_velocity moves = load_velocity(bodies.velocity, i);
  real closed = parameters->step * (length_of(moves.linear) + length_of(moves.angular) * size.w);
  real rounding = R(8.0) * ROUNDING * (magnitude(center.x) + magnitude(center.y) + magnitude(center.z));
  real margin = CORE_MARGIN * (core.radius + length_of(core.to_end) + closed) + rounding;
  store_float4(cores, i * 2u, extend(center, core.radius + closed + margin));
  store_float4(cores, i * 2u + 1u, extend(core.to_end, R(0.0)));
}

SHARED mask cores_are_far(GLOBAL const Parameters *parameters, GLOBAL const float4 *cores, uint_lanes a, uint_lanes b)
{
  vec4 middle_a = load_float4(cores, a * 2u), middle_b = load_float4(cores, b * 2u);
  vec3 half_a = xyz(load_float4(cores, a * 2u + 1u)), half_b = xyz(load_float4(cores, b * 2u + 1u));
  segment_points p =
      closest_of_segments(make_vec3(R(0.0), R(0.0), R(0.0)), half_a, subtract(xyz(middle_b), xyz(middle_a)), half_b);
  real reach = middle_a.w + middle_b.w + parameters->speculative_distance;
  return length_squared(subtract(p.on_b, p.on_a)) > reach * reach;
}

/* The kinds whose contacts lie no farther apart than their cores. */
SHARED mask keeps_within_cores(uint_lanes kind)
{
  return (kind == (uint_lanes)(uint)PAIR_KIND_CAPSULE_CAPSULE) | (kind == (uint_lanes)(uint)PAIR_KIND_BOX_CAPSULE) |
         (kind == (uint_lanes)(uint)PAIR_KIND_SPHERE_CAPSULE);
}

/* by_core: whether pairs that are far are dropped. Every pair is cleared then, because rows that are written in order
 * cost less than some of them; the kernels of the pairs that are near write theirs later. */
SHARED void find_pair_kinds_item(GLOBAL const Parameters *parameters, read_part_pairs pairs, GLOBAL const uint *flags,
                                 GLOBAL const float4 *cores, GLOBAL const uint *counts, GLOBAL uint *kinds,
                                 write_manifolds manifolds, uint by_core, item_index i)
{
  uint_lanes a = load_uint(pairs.a, i), b = load_uint(pairs.b, i);
  uint_lanes kind = pair_kind(load_uint(flags, shape_in_pair(parameters, pairs.leaf, i, 0u, a)),
                              load_uint(flags, shape_in_pair(parameters, pairs.leaf, i, 1u, b)));
  if (HAS_FEATURE(parameters, CAPSULE_CAPSULE) && by_core != 0u) {
    store_no_manifold(planes_of(counts), manifolds, i);
    mask tested = keeps_within_cores(kind);
    if (any_of(tested))
      kind = choose(tested & cores_are_far(parameters, cores, a, b), (uint_lanes)(uint)PAIR_KIND_NONE, kind);
  }
  store_uint(kinds, i, kind);
}

#endif
