/* capsule_half_space.h - a capsule touches a half-space below the ends of its segment.
 *
 *       (o-----------o)      Slot 0 lies below the end at the bottom of the capsule's own axis, slot 1 below the other.
 *   ======x==========x=====  A capsule whose axis is less than 60 degrees from the normal has the lower one alone: the
 *                            other end would come down on a curve, not on the line that a contact assumes.
 *
 * The half-space is all points with y <= 0 in its body's frame; its outward normal is the body's +Y.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CAPSULE_HALF_SPACE_H
#define TANDEM_SHARED_NARROWPHASE_CAPSULE_HALF_SPACE_H

#include "shared/narrowphase/capsules.h"

/* A capsule and a plane, seen from the centre of the plane's body. Contact points are offsets from that centre, or from
 * the capsule's body if that is the pair's first body (capsule_first). */
typedef struct {
  capsule shape;
  vec3 outward;
  mask capsule_first;
} capsule_and_plane;

/* end: the centre of one ball of the capsule. */
SHARED vec4 point_below(capsule_and_plane pair, vec3 end)
{
  real zero = R(0.0), separation = dot3(end, pair.outward) - pair.shape.radius;
  vec3 origin = choose3(pair.capsule_first, pair.shape.pivot, make_vec3(zero, zero, zero));
  return point_beside(subtract(end, origin), negate(pair.outward), pair.shape.radius, separation);
}

SHARED manifold capsule_on_plane(capsule_and_plane pair, real reach)
{
  vec3 middle = middle_of_capsule(pair.shape), normal = choose3(pair.capsule_first, negate(pair.outward), pair.outward);
  vec4 low = point_below(pair, subtract(middle, pair.shape.to_end)),
       high = point_below(pair, add(middle, pair.shape.to_end));
  mask lies = faces_side(pair.shape.to_end, pair.outward);
  manifold m = single_contact(normal, middle, low.w, lies | (low.w <= high.w));
  m.point[0] = low;
  m.point[1] = high;
  m.kept[1] = lies | (high.w < low.w);
  return kept_within(m, reach);
}

SHARED capsule_and_plane capsule_and_plane_after(capsule_and_plane start, pair_motion moves, real time)
{
  capsule_and_plane pair = start;
  spatial_velocity velocity = {choose3(pair.capsule_first, moves.a.linear, moves.b.linear),
                               choose3(pair.capsule_first, moves.a.angular, moves.b.angular), R(0.0), R(0.0)};
  pair.shape = capsule_after(pair.shape, velocity, choose3(pair.capsule_first, moves.b.linear, moves.a.linear), time);
  return pair;
}

SHARED real gap_of_capsule_to_plane(capsule_and_plane pair)
{
  return dot3(middle_of_capsule(pair.shape), pair.outward) - magnitude(dot3(pair.shape.to_end, pair.outward)) -
         pair.shape.radius;
}

SHARED advancement impact_of_capsule_on_plane(mask reached, capsule_and_plane pair, vec3 normal, pair_motion moves,
                                              toi_input input)
{
  real closing = closing_speed(moves, normal),
       turning = length_of(choose3(pair.capsule_first, moves.a.angular, moves.b.angular));
  real acceleration = acceleration_seen(R(0.0), R(0.0), R(0.0), turning, moves.radius_a + moves.radius_b);
  advancement at = start_advancement(reached);
  for (uint round = 0u; round < ADVANCEMENT_ROUNDS; ++round) {
    real gap = gap_of_capsule_to_plane(capsule_and_plane_after(pair, moves, at.time)),
         span = span_of(at, gap, acceleration, input);
    real gap_then = gap_of_capsule_to_plane(capsule_and_plane_after(pair, moves, at.time + span));
    at = advanced(at, round, gap, closing, free_by_chord(gap, gap_then, span, acceleration, input), input);
    if (!any_of(at.active)) break;
  }
  return at;
}

/* A plane has no edge that a body could pass, so only a turning body can miss it. */
SHARED manifold capsule_on_plane_over_step(GLOBAL const Parameters *parameters, mask mine, capsule_and_plane pair,
                                           pair_motion moves)
{
  real zero = R(0.0), least = pair.shape.radius, size = length_of(pair.shape.to_end) + least;
  vec3 normal = choose3(pair.capsule_first, negate(pair.outward), pair.outward);
  vec3 offset = choose3(pair.capsule_first, negate(pair.shape.pivot), pair.shape.pivot);
  real reach = reach_of_pair(parameters, moves, normal);
  manifold m = capsule_on_plane(pair, reach);
  toi_input input = toi_input_of_step(parameters, moves, least, size);
  speculation s = speculation_of(parameters, m, offset, moves, input, least);
  s.asked = s.asked & (fastest_turning(moves) > zero);
  if (any_of(mine & s.asked)) {
    encounter met =
        encounter_of(parameters, s, impact_of_capsule_on_plane(mine & s.reached, pair, normal, moves, input), input);
    real time = choose(met.at_impact, met.time, zero);
    m = choose_manifold(met.at_impact, capsule_on_plane(capsule_and_plane_after(pair, moves, time), reach), m);
    m = as_seen_from_start(parameters, m, met, offset_after(offset, moves, time), moves);
  }
  return m;
}

SHARED void collide_capsule_half_space_item(read_listed_part_pairs pairs, GLOBAL const uint *flags,
                                            GLOBAL const float4 *shapes, GLOBAL const float4 *poses, read_bodies bodies,
                                            GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                            write_manifolds manifolds, item_index i)
{
  handled_parts item = handled_part_pair(parameters, pairs, flags, PAIR_KIND_CAPSULE_HALF_SPACE, i);
  if (!any_of(item.mine)) return;
  mask capsule_first = shape_of(load_uint(flags, item.a.shape)) == (uint)SHAPE_CAPSULE;
  collider rod = choose_collider(capsule_first, item.a, item.b);
  uint_lanes plane = choose(capsule_first, item.b.body, item.a.body);
  real zero = R(0.0), radius = load_float4(shapes, rod.body).w;
  capsule_and_plane pair = {capsule_of_collider(shapes, poses, bodies.orientation,
                                                offset_between(bodies.position, plane, rod.body),
                                                capsule_first & (!capsule_first), rod),
                            axis_y(rotation_of(quat_from(load_float4(bodies.orientation, plane)))), capsule_first};
  pair_motion moves = load_pair_motion(bodies, parameters, item.a.body, item.b.body,
                                       choose(capsule_first, radius, zero), choose(capsule_first, zero, radius));
  manifold m = capsule_on_plane_over_step(parameters, item.mine, pair, moves);
  store_manifold_if(item.mine, m, planes_of(counts), manifolds, item.pair);
}

#endif
