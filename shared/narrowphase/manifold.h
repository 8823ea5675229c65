/* manifold.h - the result of every pair kernel of the narrowphase: one normal and up to four points.
 *
 * Each collide_ kernel processes the pairs of its own two shapes (pair_lists.h) and writes all outputs of a pair,
 * touching or not, so that buffers never hold the results of an earlier step. Geometry is computed relative to one of
 * the two bodies, so precision does not depend on the distance from the origin.
 *
 *              normal (from a to b)
 *                 ^
 *      -----------|-----------  surface of b     A point lies midway between the two surfaces and is
 *                 o   point     - - - - - - -    given as an offset from the centre of a; its
 *      -----------------------  surface of a     separation is negative where they overlap.
 *
 * The pair (code of the feature pair, slot) identifies a point from step to step: the code names the two faces or
 * edges, and the slot one of at most four points between them.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_MANIFOLD_H
#define TANDEM_SHARED_NARROWPHASE_MANIFOLD_H

#include "shared/argument_groups.h"
#include "shared/point_rows.h"
#include "shared/records.h"

typedef struct {
  vec3 normal;
  vec4 point[4]; /* by slot: xyz the offset from the centre of a, w the separation */
  mask kept[4];
  uint_lanes code;  /* of the feature pair, 24 bits */
  real impact_time; /* s from the start of the step; 0: these are the contacts of the start; see packed_moment */
} manifold;

SHARED real sign_of(real x) { return choose(x < R(0.0), (real)R(-1.0), (real)R(1.0)); }

/* A manifold of one point. */
SHARED manifold single_contact(vec3 normal, vec3 offset, real separation, mask kept)
{
  manifold m;
  m.normal = normal;
  m.code = 0u;
  m.impact_time = R(0.0);
  m.point[0] = extend(offset, separation);
  m.kept[0] = kept;
  for (int slot = 1; slot < 4; ++slot) {
    m.point[slot] = m.point[0];
    m.kept[slot] = kept & (!kept);
  }
  return m;
}

SHARED manifold choose_manifold(mask m, manifold a, manifold b)
{
  for (int slot = 0; slot < 4; ++slot) {
    b.point[slot] = choose4(m, a.point[slot], b.point[slot]);
    b.kept[slot] = choose(m, a.kept[slot], b.kept[slot]);
  }
  b.normal = choose3(m, a.normal, b.normal);
  b.code = choose(m, a.code, b.code);
  b.impact_time = choose(m, a.impact_time, b.impact_time);
  return b;
}

/* Bodies whose centres coincide have no direction between them. Each body therefore has a hashed place of its own in a
 * horizontal plane, and pairs part along the line between their places. If all pairs parted along one line, a thousand
 * bodies would form a thousand layers whose speeds add up. The plane is horizontal so that no body is lifted. number:
 * of the body within its world. */
SHARED vec3 place_of_its_own(uint_lanes number)
{
  uint_lanes hash = (number + 1u) * 0x9e3779b1u;
  hash = (hash ^ (hash >> 15u)) * 0x85ebca77u;
  hash = hash ^ (hash >> 13u);
  return make_vec3(to_real(hash & 0xffffu), R(0.0), to_real(hash >> 16u));
}
SHARED vec3 parting_direction(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_gravity, uint_lanes a,
                              uint_lanes b)
{
  vec3 between = subtract(place_of_its_own(number_in_world(parameters, body_gravity, b)),
                          place_of_its_own(number_in_world(parameters, body_gravity, a)));
  real length = length_of(between);
  mask differ = length > R(0.0);
  return choose3(differ, scale(between, R(1.0) / choose(differ, length, (real)R(1.0))),
                 make_vec3(R(1.0), R(0.0), R(0.0)));
}

/* The separation up to which a contact is made, so that no gap closes unseen within the step. radius: of the sphere
 * that the spin sweeps; 0 for a sphere. */
SHARED real reach_of(GLOBAL const Parameters *parameters, spatial_velocity a, real radius_a, spatial_velocity b,
                     real radius_b, vec3 normal)
{
  real closing =
      dot3(subtract(a.linear, b.linear), normal) + length_of(a.angular) * radius_a + length_of(b.angular) * radius_b;
  return parameters->speculative_distance + parameters->step * maximum(closing, R(0.0));
}

SHARED manifold kept_within(manifold m, real reach)
{
  for (int slot = 0; slot < 4; ++slot) m.kept[slot] = m.kept[slot] & (m.point[slot].w < reach);
  return m;
}

SHARED uint_lanes points_of(manifold m)
{
  uint_lanes count = 0u;
  for (int slot = 0; slot < 4; ++slot) count = choose(m.kept[slot], count + 1u, count);
  return count;
}
SHARED void mark_to_follow_if(mask marked, manifold m, GLOBAL uint *counts_of_points, uint_lanes pair)
{
  store_uint_if(marked, counts_of_points, pair, points_of(m) | TO_FOLLOW);
}

/* Kept points move to the front, each with its slot. The rows after the last point hold zeros. */
SHARED void store_manifold_if(mask mine, manifold m, point_planes planes, write_manifolds manifolds, uint_lanes pair)
{
  vec4 packed[4];
  uint_lanes count = 0u, slots = 0u;
  for (int k = 0; k < 4; ++k) packed[k] = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  for (int slot = 0; slot < 4; ++slot) {
    for (int k = 0; k <= slot; ++k)
      packed[k] = choose4(m.kept[slot] & (count == (uint_lanes)(uint)k), m.point[slot], packed[k]);
    slots = choose(m.kept[slot], slots | ((uint_lanes)(uint)slot << (count * 2u)), slots);
    count = choose(m.kept[slot], count + 1u, count);
  }
  mask touching = count > 0u;
  vec3 nothing = make_vec3(R(0.0), R(0.0), R(0.0));
  store_listed_row_if(mine, manifolds.normal, pair,
                      extend(choose3(touching, m.normal, nothing), choose(touching, m.impact_time, (real)R(0.0))));
  for (uint k = 0; k < planes.points; ++k)
    store_listed_row_if(mine, manifolds.points, planes.stride * k + pair, packed[k]);
  GLOBAL uint *features = planes.points > 1u ? manifolds.feature : manifolds.count; /* that of a single point is lost */
  store_uint_if(mine, features, pair, choose(touching, (m.code << 8u) | slots, (uint_lanes)0u));
  store_uint_if(mine, manifolds.count, pair, count);
}

/* The manifold that was stored. Points that are not kept hold zeros. */
SHARED manifold load_manifold(point_planes planes, write_manifolds manifolds, any_index i)
{
  vec4 normal = load_float4(manifolds.normal, i);
  uint_lanes count = load_uint(manifolds.count, i) & (TO_FOLLOW - 1u), feature = 0u;
  if (planes.points > 1u) feature = load_uint(manifolds.feature, i);
  mask touching = count > 0u;
  manifold m = single_contact(xyz(normal), make_vec3(R(0.0), R(0.0), R(0.0)), R(0.0), touching & (!touching));
  m.impact_time = normal.w;
  m.code = feature >> 8u;
  for (int k = 0; k < 4; ++k) {
    vec4 point = load_manifold_point(manifolds.points, planes, (uint)k, i);
    uint_lanes slot_of_point = (feature >> ((uint_lanes)(uint)k * 2u)) & 3u;
    for (int slot = 0; slot < 4; ++slot) {
      mask here = (count > (uint_lanes)(uint)k) & (slot_of_point == (uint_lanes)(uint)slot);
      m.point[slot] = choose4(here, point, m.point[slot]);
      m.kept[slot] = m.kept[slot] | here;
    }
  }
  return m;
}

/* Stores a manifold without points, with the same result as store_manifold_if. */
SHARED void store_no_manifold(point_planes planes, write_manifolds manifolds, item_index i)
{
  vec4 nothing = no_point();
  store_float4(manifolds.normal, i, nothing);
  for (uint k = 0u; k < planes.points; ++k) store_float4(manifolds.points, planes.stride * k + i, nothing);
  store_uint(manifolds.count, i, (uint_lanes)0u);
  if (planes.points > 1u) store_uint(manifolds.feature, i, (uint_lanes)0u);
}

#endif
