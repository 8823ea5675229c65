/* brute_force.h - tests every body against every body of its world before it; the oracle of all other broadphases
 * (GS-4150 slide 18, made deterministic by count, scan, write).
 *
 * Counting notes the pairs with the first MOST_MARKED bodies of the world as bits, of which writing takes them: worlds
 * of robots have no more bodies, and the tests are most of what brute force does.
 */
#ifndef TANDEM_SHARED_BROADPHASE_BRUTE_FORCE_H
#define TANDEM_SHARED_BROADPHASE_BRUTE_FORCE_H

#include "shared/broadphase/overlap.h"

#define MOST_MARKED 32u

/* The bodies of a small world before `a` whose boxes overlap its own, as bits. Nothing branches on a test, because
 * links of a robot overlap about as often as not. */
SHARED uint marks_of_overlaps(GLOBAL const float4 *bounds, box_bounds own, uint first, uint a)
{
  uint bits = 0u;
  for (uint b = first; b < a; ++b) bits |= (overlaps_body_at_once(own, bounds, b) ? 1u : 0u) << (b - first);
  return bits;
}

SHARED int is_pair_by_brute_force(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                  GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, box_bounds own, uint a,
                                  uint b)
{
  return overlaps_rows(own, bounds, b) && pair_allowed(parameters, body_flags, body_filter, a, b);
}

SHARED void brute_force_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                   GLOBAL const uint *body_filter, GLOBAL const uint *body_world,
                                   GLOBAL const float4 *bounds, GLOBAL uint *pair_start, GLOBAL uint *pairs_before,
                                   uint a)
{
  box_bounds own = load_bounds(bounds, a);
  uint first = first_of_world(parameters, body_world, a), found = 0u, bits = 0u;
  if (a - first <= MOST_MARKED) {
    for (uint left = marks_of_overlaps(bounds, own, first, a); left != 0u; left &= left - 1u)
      if (pair_allowed(parameters, body_flags, body_filter, a, first + lowest_bit(left))) {
        bits |= left & (0u - left);
        ++found;
      }
  } else {
    for (uint b = first; b < a; ++b)
      if (is_pair_by_brute_force(parameters, body_flags, body_filter, bounds, own, a, b)) {
        if (b - first < MOST_MARKED) bits |= 1u << (b - first);
        ++found;
      }
  }
  pair_start[a] = found;
  pairs_before[a] = bits;
}

SHARED void brute_force_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                   GLOBAL const uint *body_filter, GLOBAL const uint *body_world,
                                   GLOBAL const float4 *bounds, GLOBAL const uint *pair_start,
                                   GLOBAL const uint *pairs_before, GLOBAL const uint *counts, write_pairs pairs,
                                   uint a)
{
  uint first = first_of_world(parameters, body_world, a), start = pair_start[a], used = 0u;
  for (uint b = first, left = pairs_before[a]; left != 0u; ++b, left >>= 1u)
    if (left & 1u) used = append_pair(pairs.a, pairs.b, start, used, counts[CAPACITY_PAIRS], a, b);
  if (a - first <= MOST_MARKED) return;
  box_bounds own = load_bounds(bounds, a);
  for (uint b = first + MOST_MARKED; b < a; ++b)
    if (is_pair_by_brute_force(parameters, body_flags, body_filter, bounds, own, a, b))
      used = append_pair(pairs.a, pairs.b, start, used, counts[CAPACITY_PAIRS], a, b);
}

#endif
