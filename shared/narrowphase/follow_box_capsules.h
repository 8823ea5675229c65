/* follow_box_capsules.h - follows pairs of a box and a capsule that may pass each other within the step to their
 * impact.
 *
 *   collide_box_capsule -> follow_box_capsules: the contacts of the impact, those of the start, or none
 *
 * It is a kernel of its own because few pairs are followed, which a group first gathers (followed_pairs.h).
 */
#ifndef TANDEM_SHARED_NARROWPHASE_FOLLOW_BOX_CAPSULES_H
#define TANDEM_SHARED_NARROWPHASE_FOLLOW_BOX_CAPSULES_H

#include "shared/narrowphase/box_capsule.h"
#include "shared/narrowphase/followed_pairs.h"
#include "shared/narrowphase/middle_ball.h"

SHARED box_and_capsule box_and_capsule_after(const box_and_capsule *start, pair_motion moves, real time)
{
  spatial_velocity rod = moves.b;
  rod.linear = choose3(start->capsule_first, moves.a.linear, rod.linear);
  rod.angular = choose3(start->capsule_first, moves.a.angular, rod.angular);
  vec3 linear = choose3(start->capsule_first, moves.b.linear, moves.a.linear),
       angular = choose3(start->capsule_first, moves.b.angular, moves.a.angular);
  box_and_capsule pair = *start;
  pair.rod = capsule_after(start->rod, rod, linear, time);
  pair.rotation = turned_axes(turn_within(angular, time), start->rotation);
  return pair;
}

typedef struct {
  vec3 outward; /* unit, from the box to the capsule */
  real gap;
} gap_of_capsule;

SHARED gap_of_capsule gap_after(const moving_box_and_capsule *p, real time)
{
  box_and_capsule then = box_and_capsule_after(&p->pair, p->moves, time);
  boxed_segment s = segment_in_box(&then);
  box_touch t = touch_of_segment(&s);
  gap_of_capsule g = {rotate(then.rotation, t.normal), t.height - then.rod.radius};
  return g;
}

SHARED real gap_of_capsule_along(const box_and_capsule *pair, vec3 outward)
{
  return dot3(outward, middle_of_capsule(pair->rod)) - magnitude(dot3(outward, pair->rod.to_end)) -
         dot3(absolute(rotate_back(pair->rotation, outward)), pair->extent) - pair->rod.radius;
}

/* The time free of touching by the chord along a normal that turns with the viewer, which is one of the bodies.
 * other_radius: of the sphere that the spin of the other one sweeps. */
SHARED real free_beside_box_or_capsule(const moving_box_and_capsule *p, vec3 turning, vec3 turning_other,
                                       real other_radius, gap_of_capsule now, advancement at)
{
  real acceleration =
      acceleration_beside(p->moves, p->pair.rod.pivot, p->input.horizon, turning, turning_other, other_radius);
  real span = span_of(at, now.gap, acceleration, p->input);
  box_and_capsule then = box_and_capsule_after(&p->pair, p->moves, at.time + span);
  real gap_then = gap_of_capsule_along(&then, rotate(turn_within(turning, span), now.outward));
  return free_by_chord(now.gap, gap_then, span, acceleration, p->input);
}

/* A pair that does not move far, and touches at the end of its motion, has met and keeps the contacts of the start
 * (encounter_of), as nearly all pairs that come to rest do. */
SHARED advancement impact_of_box_and_capsule(const moving_box_and_capsule *p, mask reached)
{
  vec3 turning_a = p->moves.a.angular, turning_b = p->moves.b.angular;
  advancement at = start_advancement(reached);
  mask slow = reached & (!p->input.far);
  if (any_of(slow)) at.hits = slow & (gap_after(p, p->input.horizon).gap <= p->input.touching);
  at.active = at.active & (!at.hits);
  for (uint round = 0u; round < ADVANCEMENT_ROUNDS && any_of(at.active); ++round) {
    gap_of_capsule now = gap_after(p, at.time);
    real by_a = free_beside_box_or_capsule(p, turning_a, turning_b, p->moves.radius_b, now, at),
         by_b = free_beside_box_or_capsule(p, turning_b, turning_a, p->moves.radius_a, now, at);
    vec3 normal = choose3(p->pair.capsule_first, negate(now.outward), now.outward);
    at = advanced(at, round, now.gap, closing_speed(p->moves, normal), maximum(by_a, by_b), p->input);
  }
  return at;
}

/* Adds the middle ball of a capsule that hits a face of the box while its middle is in front of that face. The ball is
 * smaller if the capsule is not centred on its body. */
SHARED manifold with_middle_of_capsule_if(mask wanted, manifold m, const box_and_capsule *then, pair_motion moves)
{
  ball_owner owner = owner_of_ball(moves);
  wanted = wanted & choose(then->capsule_first, owner.in_a, owner.in_b);
  if (!any_of(wanted)) return m;
  vec3 outward = choose3(then->capsule_first, negate(m.normal), m.normal), own = rotate_back(then->rotation, outward),
       at = rotate_back(then->rotation, then->rod.pivot), size = absolute(own);
  mask x = size.x >= WITH_FACE, y = size.y >= WITH_FACE, z = size.z >= WITH_FACE;
  vec3 beside = subtract(absolute(at), then->extent);
  mask past = ((!x) & (beside.x >= R(0.0))) | ((!y) & (beside.y >= R(0.0))) | ((!z) & (beside.z >= R(0.0)));
  vec3 face = multiply(axis_where(x, y, z), make_vec3(sign_of(own.x), sign_of(own.y), sign_of(own.z)));
  real height = dot3(face, at) - dot3(absolute(face), then->extent);
  real radius = CORE_SHARE * then->rod.radius - length_of(then->rod.middle);
  vec3 middle = choose3(then->capsule_first, make_vec3(R(0.0), R(0.0), R(0.0)), then->rod.pivot);
  wanted = wanted & (x | y | z) & (!past) & (radius > R(0.0));
  return with_middle_ball_if(wanted, m, middle, outward, height, radius);
}

SHARED void follow_pair_of_box_and_capsule(mask wanted, read_listed_part_pairs pairs, GLOBAL const uint *flags,
                                           GLOBAL const float4 *shapes, GLOBAL const float4 *poses, read_bodies bodies,
                                           GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                           write_manifolds manifolds, uint_lanes i)
{
  point_planes planes = planes_of(counts);
  collider a = collider_of_pair(parameters, pairs.leaf, load_uint(pairs.a, i), i, 0u),
           b = collider_of_pair(parameters, pairs.leaf, load_uint(pairs.b, i), i, 1u);
  moving_box_and_capsule p = load_box_and_capsule(flags, shapes, poses, bodies, parameters, a, b);
  manifold m = load_manifold(planes, manifolds, i);
  speculation s = speculation_of_box_and_capsule(parameters, m, &p);
  encounter met = encounter_of(parameters, s, impact_of_box_and_capsule(&p, wanted & s.reached), p.input);
  box_and_capsule then = box_and_capsule_after(&p.pair, p.moves, choose(met.at_impact, met.time, (real)R(0.0)));
  if (any_of(met.at_impact)) {
    m = choose_manifold(met.at_impact, box_capsule_within_reach(parameters, &then, p.moves), m);
    m = with_middle_of_capsule_if(met.at_impact & (!met.missed), m, &then, p.moves);
  }
  m = as_seen_from_start(parameters, m, met, offset_of_box_and_capsule(&then), p.moves);
  store_manifold_if(wanted, m, planes, manifolds, i);
}

/* local_memory: the list of followed_pairs.h. */
SHARED void follow_box_capsules_group(read_listed_part_pairs pairs, GLOBAL const uint *flags,
                                      GLOBAL const float4 *shapes, GLOBAL const float4 *poses, read_bodies bodies,
                                      GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                      write_manifolds manifolds, LOCAL uint *local_memory, uint group)
{
  gather_followed_pairs(pairs.of_kind, pairs.a, pairs.b, flags, parameters, counts, manifolds.count,
                        PAIR_KIND_BOX_CAPSULE, local_memory, group);
  FOR_EACH_LISTED(k, local_memory[0])
  {
    follow_pair_of_box_and_capsule(is_listed(local_memory[0], k), pairs, flags, shapes, poses, bodies, parameters,
                                   counts, manifolds, listed_item(local_memory + 1u, local_memory[0], k));
  }
}

#endif
