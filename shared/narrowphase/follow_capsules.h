/* follow_capsules.h - follows two capsules, or a sphere and a capsule, that may pass each other within the step to
 * their impact.
 *
 *   collide_capsule_capsule, collide_sphere_capsule -> follow_capsules, follow_sphere_capsules:
 *   the contacts of the impact, those of the start, or none
 *
 * These are kernels of their own because few pairs are followed, which a group first gathers (followed_pairs.h).
 */
#ifndef TANDEM_SHARED_NARROWPHASE_FOLLOW_CAPSULES_H
#define TANDEM_SHARED_NARROWPHASE_FOLLOW_CAPSULES_H

#include "shared/narrowphase/capsules.h"
#include "shared/narrowphase/followed_pairs.h"

/* The gap between two capsules and its normal, from a to b; of axes that meet there is none. */
typedef struct {
  vec3 normal;
  real gap;
} capsule_gap;

SHARED capsule_gap gap_between_capsules(capsule_pair pair)
{
  vec3 between = between_closest(pair, closest_of_capsules(pair));
  real distance = length_of(between);
  mask apart = distance > R(0.0);
  capsule_gap g = {scale(between, R(1.0) / choose(apart, distance, (real)R(1.0))),
                   distance - pair.a.radius - pair.b.radius};
  return g;
}

SHARED capsule choose_capsule(mask m, capsule a, capsule b)
{
  capsule c = {choose3(m, a.pivot, b.pivot), choose3(m, a.middle, b.middle), choose3(m, a.to_end, b.to_end),
               choose(m, a.radius, b.radius)};
  return c;
}
SHARED capsule_pair choose_capsules(mask m, capsule_pair a, capsule_pair b)
{
  capsule_pair pair = {choose_capsule(m, a.a, b.a), choose_capsule(m, a.b, b.b)};
  return pair;
}

/* A pair at the start and at the end of its motion. Most pairs look at no other time, and turning a pair costs a CPU
 * more than all else of a round. A device waits for the few pairs that look at many others, so it turns all alike: with
 * these branches in its loop, an H200 took a tenth longer. */
typedef struct {
  capsule_pair start, end;
} followed_capsules;

/* wanted: pairs of others may be at any time. */
SHARED capsule_pair capsules_at(mask wanted, const followed_capsules *pair, pair_motion moves, real time,
                                toi_input input)
{
#ifdef READS_AHEAD
  (void)wanted;
  (void)input;
#else
  mask begins = time <= R(0.0);
  if (!any_of(wanted & (!begins) & (time != input.horizon))) return choose_capsules(begins, pair->start, pair->end);
#endif
  return capsules_after(pair->start, moves, time);
}

/* The time free of touching by the chord along a normal that turns with the viewer, which is body a or b of the pair.
 * other_radius: of the sphere that the spin of the other one sweeps. */
SHARED real free_beside_capsule(const followed_capsules *pair, pair_motion moves, vec3 turning, vec3 turning_other,
                                real other_radius, capsule_gap now, advancement at, toi_input input)
{
  vec3 offset = subtract(pair->start.b.pivot, pair->start.a.pivot);
  real acceleration = acceleration_beside(moves, offset, input.horizon, turning, turning_other, other_radius);
  real gap = now.gap, span = span_of(at, gap, acceleration, input);
  real gap_then = gap_of_capsules_along(capsules_at(at.active, pair, moves, at.time + span, input),
                                        rotate(turn_within(turning, span), now.normal));
  return free_by_chord(gap, gap_then, span, acceleration, input);
}

/* A pair that does not move far, and touches at the end of its motion, has met and keeps the contacts of the start
 * (encounter_of), as nearly all pairs that come to rest do. */
SHARED advancement impact_of_capsules(mask reached, capsule_pair start, pair_motion moves, toi_input input)
{
  vec3 turning_a = moves.a.angular, turning_b = moves.b.angular;
  followed_capsules pair = {start, start};
  advancement at = start_advancement(reached);
  if (any_of(reached)) pair.end = capsules_after(start, moves, input.horizon);
  mask slow = reached & (!input.far);
  if (any_of(slow)) at.hits = slow & (gap_between_capsules(pair.end).gap <= input.touching);
  at.active = at.active & (!at.hits);
  for (uint round = 0u; round < ADVANCEMENT_ROUNDS && any_of(at.active); ++round) {
    capsule_gap now = gap_between_capsules(capsules_at(at.active, &pair, moves, at.time, input));
    real by_a = free_beside_capsule(&pair, moves, turning_a, turning_b, moves.radius_b, now, at, input),
         by_b = free_beside_capsule(&pair, moves, turning_b, turning_a, moves.radius_a, now, at, input);
    at = advanced(at, round, now.gap, closing_speed(moves, now.normal), maximum(by_a, by_b), input);
  }
  return at;
}

SHARED void follow_pair_of_capsules(mask wanted, read_listed_part_pairs pairs, GLOBAL const uint *flags,
                                    GLOBAL const float4 *shapes, GLOBAL const float4 *poses, read_bodies bodies,
                                    GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                    write_manifolds manifolds, uint_lanes i)
{
  point_planes planes = planes_of(counts);
  collider a = collider_of_pair(parameters, pairs.leaf, load_uint(pairs.a, i), i, 0u),
           b = collider_of_pair(parameters, pairs.leaf, load_uint(pairs.b, i), i, 1u);
  moving_capsules p = load_moving_capsules(flags, shapes, poses, bodies, parameters, a, b);
  manifold m = load_manifold(planes, manifolds, i);
  speculation s = speculation_of_capsules(parameters, m, &p);
  encounter met =
      encounter_of(parameters, s, impact_of_capsules(wanted & s.reached, p.pair, p.moves, p.input), p.input);
  capsule_pair then = capsules_after(p.pair, p.moves, choose(met.at_impact, met.time, (real)R(0.0)));
  if (any_of(met.at_impact))
    m = choose_manifold(met.at_impact, capsules_within_reach(parameters, then, p.aside, p.moves), m);
  m = as_seen_from_start(parameters, m, met, then.b.pivot, p.moves);
  store_manifold_if(wanted, m, planes, manifolds, i);
}

/* local_memory: the list of followed_pairs.h. */
SHARED void follow_capsules_of_kind(uint kind, read_listed_part_pairs pairs, GLOBAL const uint *flags,
                                    GLOBAL const float4 *shapes, GLOBAL const float4 *poses, read_bodies bodies,
                                    GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                    write_manifolds manifolds, LOCAL uint *local_memory, uint group)
{
  gather_followed_pairs(pairs.of_kind, pairs.a, pairs.b, flags, parameters, counts, manifolds.count, kind, local_memory,
                        group);
  FOR_EACH_LISTED(k, local_memory[0])
  {
    follow_pair_of_capsules(is_listed(local_memory[0], k), pairs, flags, shapes, poses, bodies, parameters, counts,
                            manifolds, listed_item(local_memory + 1u, local_memory[0], k));
  }
}

SHARED void follow_capsules_group(read_listed_part_pairs pairs, GLOBAL const uint *flags, GLOBAL const float4 *shapes,
                                  GLOBAL const float4 *poses, read_bodies bodies, GLOBAL const Parameters *parameters,
                                  GLOBAL const uint *counts, write_manifolds manifolds, LOCAL uint *local_memory,
                                  uint group)
{
  follow_capsules_of_kind(PAIR_KIND_CAPSULE_CAPSULE, pairs, flags, shapes, poses, bodies, parameters, counts, manifolds,
                          local_memory, group);
}

SHARED void follow_sphere_capsules_group(read_listed_part_pairs pairs, GLOBAL const uint *flags,
                                         GLOBAL const float4 *shapes, GLOBAL const float4 *poses, read_bodies bodies,
                                         GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                         write_manifolds manifolds, LOCAL uint *local_memory, uint group)
{
  follow_capsules_of_kind(PAIR_KIND_SPHERE_CAPSULE, pairs, flags, shapes, poses, bodies, parameters, counts, manifolds,
                          local_memory, group);
}

#endif
