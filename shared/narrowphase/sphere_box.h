/* sphere_box.h - the contact of a sphere with a box, at the point of the box nearest to the sphere's centre.
 *
 *      +---------+          Centre outside: the centre clamped to the box is the nearest point.
 *      |         |--> o     Centre inside: the face of least depth pushes the sphere out.
 *      |     o-->|
 *      +---------+
 */
#ifndef TANDEM_SHARED_NARROWPHASE_SPHERE_BOX_H
#define TANDEM_SHARED_NARROWPHASE_SPHERE_BOX_H

#include "shared/narrowphase/box.h"
#include "shared/narrowphase/pair_lists.h"

/* The outward direction from the surface of a box to a point, and the distance, both in the axes of the box. */
typedef struct {
  vec3 normal;
  real distance; /* negative inside */
} box_distance;

SHARED box_distance distance_to_box(vec3 point, vec3 extent)
{
  vec3 away = subtract(point, nearest_in_box(point, extent));
  real distance = length_of(away);
  mask outside = distance > R(1e-12);

  vec3 depth = subtract(extent, absolute(point));
  mask x_least = (depth.x <= depth.y) & (depth.x <= depth.z);
  mask y_least = (!x_least) & (depth.y <= depth.z);
  mask z_least = (!x_least) & (!y_least);
  real zero = R(0.0);
  vec3 face = make_vec3(choose(x_least, sign_of(point.x), zero), choose(y_least, sign_of(point.y), zero),
                        choose(z_least, sign_of(point.z), zero));
  real least = choose(x_least, depth.x, choose(y_least, depth.y, depth.z));

  box_distance result;
  result.normal = choose3(outside, scale(away, R(1.0) / choose(outside, distance, (real)R(1.0))), face);
  result.distance = choose(outside, distance, -least);
  return result;
}

/* A sphere and a box, seen from the centre of the box in world axes. */
typedef struct {
  vec3 center, extent;
  real radius;
  mat3 rotation;
  mask sphere_first; /* the sphere is body a */
} sphere_and_box;

SHARED manifold sphere_box_contact(sphere_and_box pair)
{
  box_distance nearest = distance_to_box(rotate_back(pair.rotation, pair.center), pair.extent);
  vec3 outward = rotate(pair.rotation, nearest.normal);
  real separation = nearest.distance - pair.radius;
  vec3 from_sphere = scale(outward, -(pair.radius + separation * R(0.5)));
  vec3 offset = choose3(pair.sphere_first, from_sphere, add(pair.center, from_sphere));
  return single_contact(choose3(pair.sphere_first, negate(outward), outward), offset, separation,
                        separation == separation);
}

SHARED sphere_and_box sphere_and_box_after(sphere_and_box start, pair_motion moves, real time)
{
  sphere_and_box pair = start;
  vec3 velocity = subtract(moves.b.linear, moves.a.linear);
  pair.center = add_scaled(pair.center, choose3(pair.sphere_first, negate(velocity), velocity), time);
  pair.rotation =
      turned_axes(turn_within(choose3(pair.sphere_first, moves.b.angular, moves.a.angular), time), pair.rotation);
  return pair;
}

/* outward: unit, from the box to the sphere. */
SHARED real gap_of_sphere_along(sphere_and_box pair, vec3 outward)
{
  return dot3(outward, pair.center) - dot3(absolute(rotate_back(pair.rotation, outward)), pair.extent) - pair.radius;
}

/* The normal turns with the box, so the gap a span later is measured along the turned normal. */
SHARED advancement impact_of_sphere_on_box(mask reached, sphere_and_box pair, pair_motion moves, toi_input input)
{
  vec3 angular = choose3(pair.sphere_first, moves.b.angular, moves.a.angular);
  real speed = length_of(subtract(moves.a.linear, moves.b.linear)),
       distance = length_of(pair.center) + speed * input.horizon;
  real acceleration = acceleration_seen(length_of(angular), distance, speed, R(0.0), R(0.0));
  advancement at = start_advancement(reached);
  for (uint round = 0u; round < ADVANCEMENT_ROUNDS; ++round) {
    manifold now = sphere_box_contact(sphere_and_box_after(pair, moves, at.time));
    vec3 outward = choose3(pair.sphere_first, negate(now.normal), now.normal);
    real gap = now.point[0].w, span = span_of(at, gap, acceleration, input);
    real gap_then = gap_of_sphere_along(sphere_and_box_after(pair, moves, at.time + span),
                                        rotate(turn_within(angular, span), outward));
    at = advanced(at, round, gap, closing_speed(moves, now.normal),
                  free_by_chord(gap, gap_then, span, acceleration, input), input);
    if (!any_of(at.active)) break;
  }
  return at;
}

SHARED void collide_sphere_box_item(read_listed_pairs pairs, GLOBAL const uint *flags, GLOBAL const float4 *shapes,
                                    read_bodies bodies, GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                    write_manifolds manifolds, item_index i)
{
  handled item = handled_pair(parameters, pairs, flags, PAIR_KIND_SPHERE_BOX, i);
  if (!any_of(item.mine)) return;
  uint_lanes a = item.a, b = item.b;
  mask mine = item.mine;
  mask sphere_first = shape_of(load_uint(flags, a)) == (uint)SHAPE_SPHERE;

  uint_lanes sphere = choose(sphere_first, a, b), box = choose(sphere_first, b, a);
  vec4 shape = load_float4(shapes, box);
  real zero = R(0.0), radius = load_float4(shapes, sphere).x, least = minimum(radius, least_of(xyz(shape)));
  sphere_and_box pair = {offset_between(bodies.position, box, sphere), xyz(shape), radius,
                         rotation_of(quat_from(load_float4(bodies.orientation, box))), sphere_first};
  pair_motion moves = load_pair_motion(bodies, parameters, a, b, choose(sphere_first, zero, shape.w),
                                       choose(sphere_first, shape.w, zero));
  manifold m = sphere_box_contact(pair);
  m = kept_within(m, reach_of_pair(parameters, moves, m.normal));

  toi_input input = toi_input_of_step(parameters, moves, least, radius + shape.w);
  speculation s =
      speculation_of(parameters, m, choose3(sphere_first, negate(pair.center), pair.center), moves, input, least);
  if (any_of(mine & s.asked)) {
    encounter met = encounter_of(parameters, s, impact_of_sphere_on_box(mine & s.reached, pair, moves, input), input);
    sphere_and_box then = sphere_and_box_after(pair, moves, choose(met.at_impact, met.time, zero));
    manifold later = sphere_box_contact(then);
    later = kept_within(later, reach_of_pair(parameters, moves, later.normal));
    m = choose_manifold(met.at_impact, later, m);
    m = as_seen_from_start(parameters, m, met, choose3(sphere_first, negate(then.center), then.center), moves);
  }
  store_manifold_if(mine, m, planes_of(counts), manifolds, item.pair);
}

#endif
