/* list.h - the events of a step: which pairs began to touch, still touch, or ceased to touch.
 *
 * The pair lists of this step and of the last committed one are both sorted by (a, b) and owned by a. Each body merges
 * its two ranges, so every pair of bodies occurs once, even if it is in one list only:
 *
 *   body a   now      2 .  5 5 7      touching   1 .  0 1 1
 *            before   2 3  . . 7                 0 1  . . 1        2 begins, 3 ends, 5 begins, 7 persists
 *
 * Entries with equal (a, b) are adjacent and are one contact. The list is made by count, scan and write, so it is
 * compact and sorted by (a, b). It is complete, because it is no longer than both pair lists together, for which there
 * is capacity. The kernels run over the range of the commit, before the cache is overwritten, so a step that runs again
 * reports nothing twice.
 */
#ifndef TANDEM_SHARED_EVENTS_LIST_H
#define TANDEM_SHARED_EVENTS_LIST_H

#include "shared/argument_groups.h"
#include "shared/events/event_codes.h"
#include "shared/events/impulses.h"

/* The rest of the two ranges of a body. */
typedef struct {
  uint now, now_end, before, before_end;
} pair_walk;

/* One pair of bodies: its entries in this step's list, of which there may be none, and the kind of its event. */
typedef struct {
  uint b, first, end, kind;
} pair_change;

SHARED pair_walk walk_of(GLOBAL const uint *pair_start, GLOBAL const uint *cached_start, uint a)
{
  pair_walk walk = {pair_start[a], pair_start[a + 1u], cached_start[a], cached_start[a + 1u]};
  return walk;
}

SHARED int walk_goes_on(const pair_walk *walk) { return walk->now < walk->now_end || walk->before < walk->before_end; }

SHARED pair_change next_change(pair_walk *walk, read_touching_pairs touching_pairs,
                               read_cached_touching_pairs cached_touching_pairs)
{
  uint b_now = walk->now < walk->now_end ? touching_pairs.b[walk->now] : INDEX_NONE;
  uint b_before = walk->before < walk->before_end ? cached_touching_pairs.b[walk->before] : INDEX_NONE;
  pair_change change = {b_now < b_before ? b_now : b_before, walk->now, walk->now, EVENT_NONE};
  uint touches = 0u, touched = 0u;
  for (; walk->now < walk->now_end && touching_pairs.b[walk->now] == change.b; ++walk->now)
    touches |= touching_pairs.touching[walk->now];
  for (; walk->before < walk->before_end && cached_touching_pairs.b[walk->before] == change.b; ++walk->before)
    touched |= cached_touching_pairs.touching[walk->before];
  change.end = walk->now;
  if (touches != 0u) change.kind = touched != 0u ? EVENT_PERSIST : EVENT_BEGIN;
  else if (touched != 0u) change.kind = EVENT_END;
  return change;
}

SHARED void count_events_item(read_touching_pairs touching_pairs, read_cached_touching_pairs cached_touching_pairs,
                              GLOBAL uint *event_start, uint a)
{
  pair_walk walk = walk_of(touching_pairs.start, cached_touching_pairs.start, a);
  uint found = 0u;
  while (walk_goes_on(&walk))
    if (next_change(&walk, touching_pairs, cached_touching_pairs).kind != (uint)EVENT_NONE) ++found;
  event_start[a] = found;
}

/* The sum over the touching points of a contact. */
typedef struct {
  vec3 pressed, overlapped; /* sums of the points, weighted by their impulses, and unweighted */
  vec3 normal;              /* of the manifold with the largest impulse, or of the deepest one if none carried any */
  real impulse, hardest, deepest;
  uint points;
} contact_sum;

/* velocity: of body a, which moves with it until the moment of an impact. */
SHARED void add_manifold(contact_sum *sum, vec3 velocity, read_manifolds manifolds, point_planes planes, uint pair,
                         vec4 impulses)
{
  real impulse = R(0.0), depth = UNBOUNDED;
  vec4 normal = load_float4(manifolds.normal, pair);
  for (uint k = 0; k < manifolds.count[pair]; ++k) {
    vec4 point = load_manifold_point(manifolds.points, planes, k, pair);
    real carried = component(impulses, k);
    if (!point_touches(point, carried)) continue;
    vec3 where = add_scaled(xyz(point), velocity, moment_of(normal.w));
    sum->pressed = add_scaled(sum->pressed, where, carried);
    sum->overlapped = add(sum->overlapped, where);
    ++sum->points;
    impulse = impulse + carried;
    depth = minimum(depth, point.w);
  }
  if (impulse > sum->hardest || (impulse == sum->hardest && depth < sum->deepest)) {
    sum->normal = xyz(normal);
    sum->hardest = impulse;
  }
  sum->deepest = minimum(sum->deepest, depth);
  sum->impulse = sum->impulse + impulse;
}

/* An impulse below this counts as 0, N s: its inverse, or its product with an offset, may leave the range of floats. */
#define FADED_IMPULSE R(1e-25)

/* The point, from the centre of a, at which the impulse acts; without an impulse, the middle of the points. */
SHARED vec3 middle_of_contact(const contact_sum *sum)
{
  if (sum->impulse > FADED_IMPULSE) return scale(sum->pressed, R(1.0) / sum->impulse);
  return sum->points > 0u ? scale(sum->overlapped, R(1.0) / to_real(sum->points)) : make_vec3(R(0.0), R(0.0), R(0.0));
}

/* The speed at which the two bodies approach each other at the contact as the step starts, 0 if they part. arm: from
 * the centre of a to the contact. */
SHARED real approach_speed(GLOBAL const float4 *body_position, GLOBAL const float4 *body_velocity, uint a, uint b,
                           vec3 arm, vec3 normal)
{
  vec3 arm_b = subtract(arm, offset_between(body_position, a, b));
  vec3 velocity_a = velocity_at(load_velocity(body_velocity, a), arm),
       velocity_b = velocity_at(load_velocity(body_velocity, b), arm_b);
  return maximum(dot3(normal, subtract(velocity_a, velocity_b)), R(0.0));
}

SHARED void store_event(GLOBAL uint *event_bodies, GLOBAL float4 *event_contact, uint at, uint a, pair_change change,
                        const contact_sum *sum, double_float3 where, real approach)
{
  real separation = sum->points > 0u ? sum->deepest : R(0.0);
  event_bodies[4u * at] = change.kind;
  event_bodies[4u * at + 1u] = a;
  event_bodies[4u * at + 2u] = change.b;
  event_bodies[4u * at + 3u] = sum->points;
  store_float4(event_contact, 3u * at, extend(where.high, sum->impulse));
  store_float4(event_contact, 3u * at + 1u, extend(where.low, separation));
  store_float4(event_contact, 3u * at + 2u, extend(sum->normal, approach));
}

/* Points are at the poses at which they were found, at the start of the step or at the impact within it, because
 * nothing is committed yet when this kernel runs. */
SHARED void write_events_item(read_touching_pairs touching_pairs, GLOBAL const uint *pair_color,
                              GLOBAL const float4 *pair_impulse, read_manifolds manifolds,
                              read_cached_touching_pairs cached_touching_pairs, GLOBAL const float4 *body_position,
                              GLOBAL const float4 *body_velocity, GLOBAL const uint *event_start,
                              GLOBAL const uint *counts, GLOBAL uint *event_bodies, GLOBAL float4 *event_contact,
                              uint a)
{
  pair_walk walk = walk_of(touching_pairs.start, cached_touching_pairs.start, a);
  uint at = event_start[a];
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  while (walk_goes_on(&walk)) {
    pair_change change = next_change(&walk, touching_pairs, cached_touching_pairs);
    if (change.kind == (uint)EVENT_NONE) continue;
    contact_sum sum = {none, none, none, R(0.0), R(0.0), UNBOUNDED, 0u};
    double_float3 where = {none, none};
    real approach = R(0.0);
    if (change.kind != (uint)EVENT_END) {
      for (uint pair = change.first; pair < change.end; ++pair)
        add_manifold(&sum, load_velocity(body_velocity, a).linear, manifolds, planes_of(counts), pair,
                     impulse_of_pair(pair_color, pair_impulse, pair));
      vec3 arm = middle_of_contact(&sum);
      where = moved_position(load_position(body_position, a), arm);
      approach = approach_speed(body_position, body_velocity, a, change.b, arm, sum.normal);
    }
    store_event(event_bodies, event_contact, at++, a, change, &sum, where, approach);
  }
}

#endif
