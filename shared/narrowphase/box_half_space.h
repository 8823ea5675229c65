/* box_half_space.h - the contact of a box with a half-space: the four corners of the face that is most opposed to it.
 *
 * The lowest corner of the box is always among them. A slot holds the signs of the two other axes of the face: bit 0 is
 * that of the next axis, bit 1 that of the one after.
 *
 *      +-------+
 *      |  box  |     o  corners of the face turned to the plane, kept where their separation
 *      o-------o        is less than the reach
 *    ------------- plane
 */
#ifndef TANDEM_SHARED_NARROWPHASE_BOX_HALF_SPACE_H
#define TANDEM_SHARED_NARROWPHASE_BOX_HALF_SPACE_H

#include "shared/narrowphase/box.h"
#include "shared/narrowphase/pair_lists.h"

/* A corner of the face turned to the plane. `origin` is the point that offsets count from, seen from the box. */
SHARED vec4 corner_contact(vec3 corner, vec3 center, vec3 outward, vec3 origin)
{
  real separation = dot3(center, outward) + dot3(corner, outward);
  return extend(add_scaled(subtract(corner, origin), outward, separation * R(-0.5)), separation);
}

SHARED manifold box_on_plane(oriented_box box, vec3 center, vec3 outward, vec3 origin, real reach)
{
  uint_lanes k = most_parallel_axis(box, outward);
  box_frame face = frame_of(box, k);
  real side = -sign_of(dot3(face.axis, outward));
  vec3 middle = scale(face.axis, face.extent * side);
  vec3 u = scale(face.u, face.extent_u), v = scale(face.v, face.extent_v);
  manifold m;
  m.normal = outward;
  m.impact_time = R(0.0);
  m.code = (k << 1u) | choose(side > R(0.0), (uint_lanes)1u, (uint_lanes)0u);
  m.point[0] = corner_contact(subtract(subtract(middle, u), v), center, outward, origin);
  m.point[1] = corner_contact(subtract(add(middle, u), v), center, outward, origin);
  m.point[2] = corner_contact(add(subtract(middle, u), v), center, outward, origin);
  m.point[3] = corner_contact(add(add(middle, u), v), center, outward, origin);
  for (int slot = 0; slot < 4; ++slot) m.kept[slot] = m.point[slot].w < reach;
  return m;
}

/* A box and the plane through the origin of its frame, with unit normal `outward`. Contact points are offsets from the
 * plane's body, or from the box if the box is the pair's first body (box_first). */
typedef struct {
  oriented_box box;
  vec3 center, outward;
  mask box_first;
} box_and_plane;

SHARED manifold box_plane_contact(box_and_plane pair, real reach)
{
  vec3 here = make_vec3(R(0.0), R(0.0), R(0.0));
  manifold m =
      box_on_plane(pair.box, pair.center, pair.outward, choose3(pair.box_first, here, negate(pair.center)), reach);
  m.normal = choose3(pair.box_first, negate(pair.outward), pair.outward);
  return m;
}

SHARED real gap_to_plane(box_and_plane pair)
{
  vec3 along =
      make_vec3(dot3(pair.box.x, pair.outward), dot3(pair.box.y, pair.outward), dot3(pair.box.z, pair.outward));
  return dot3(pair.center, pair.outward) - dot3(absolute(along), pair.box.extent);
}

SHARED box_and_plane box_and_plane_after(box_and_plane start, pair_motion moves, real time)
{
  box_and_plane pair = start;
  vec3 velocity = subtract(moves.b.linear, moves.a.linear);
  pair.center = add_scaled(pair.center, choose3(pair.box_first, negate(velocity), velocity), time);
  pair.box = turned_box(pair.box, choose3(pair.box_first, moves.a.angular, moves.b.angular), time);
  return pair;
}

SHARED advancement impact_of_box_on_plane(mask reached, box_and_plane pair, vec3 normal, pair_motion moves,
                                          toi_input input)
{
  real closing = closing_speed(moves, normal),
       turning = length_of(choose3(pair.box_first, moves.a.angular, moves.b.angular));
  real acceleration = acceleration_seen(R(0.0), R(0.0), R(0.0), turning, moves.radius_a + moves.radius_b);
  advancement at = start_advancement(reached);
  for (uint round = 0u; round < ADVANCEMENT_ROUNDS; ++round) {
    real gap = gap_to_plane(box_and_plane_after(pair, moves, at.time)), span = span_of(at, gap, acceleration, input);
    real gap_then = gap_to_plane(box_and_plane_after(pair, moves, at.time + span));
    at = advanced(at, round, gap, closing, free_by_chord(gap, gap_then, span, acceleration, input), input);
    if (!any_of(at.active)) break;
  }
  return at;
}

SHARED void collide_box_half_space_item(read_listed_pairs pairs, GLOBAL const uint *flags, GLOBAL const float4 *shapes,
                                        read_bodies bodies, GLOBAL const Parameters *parameters,
                                        GLOBAL const uint *counts, write_manifolds manifolds, item_index i)
{
  handled item = handled_pair(parameters, pairs, flags, PAIR_KIND_BOX_HALF_SPACE, i);
  if (!any_of(item.mine)) return;
  uint_lanes a = item.a, b = item.b;
  mask mine = item.mine;
  mask box_first = shape_of(load_uint(flags, a)) == (uint)SHAPE_BOX;

  uint_lanes body = choose(box_first, a, b), plane = choose(box_first, b, a);
  vec4 shape = load_float4(shapes, body);
  real zero = R(0.0), least = least_of(xyz(shape));
  box_and_plane pair = {oriented_box_of(load_float4(bodies.orientation, body), xyz(shape)),
                        offset_between(bodies.position, plane, body),
                        axis_y(rotation_of(quat_from(load_float4(bodies.orientation, plane)))), box_first};
  pair_motion moves =
      load_pair_motion(bodies, parameters, a, b, choose(box_first, shape.w, zero), choose(box_first, zero, shape.w));
  vec3 normal = choose3(box_first, negate(pair.outward), pair.outward);
  real reach = reach_of_pair(parameters, moves, normal);
  manifold m = box_plane_contact(pair, reach);

  /* A plane has no edge that a body could pass, so only a turning body can miss it. */
  toi_input input = toi_input_of_step(parameters, moves, least, shape.w);
  speculation s =
      speculation_of(parameters, m, choose3(box_first, negate(pair.center), pair.center), moves, input, least);
  s.asked = s.asked & (fastest_turning(moves) > zero);
  if (any_of(mine & s.asked)) {
    encounter met =
        encounter_of(parameters, s, impact_of_box_on_plane(mine & s.reached, pair, normal, moves, input), input);
    box_and_plane then = box_and_plane_after(pair, moves, choose(met.at_impact, met.time, zero));
    m = choose_manifold(met.at_impact, box_plane_contact(then, reach), m);
    m = as_seen_from_start(parameters, m, met, choose3(box_first, negate(then.center), then.center), moves);
  }
  store_manifold_if(mine, m, planes_of(counts), manifolds, item.pair);
}

#endif
