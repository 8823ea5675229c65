/* brute_force.h - tests every body against every body of its world before it; the oracle of all other broadphases
 * (GS-4150 slide 18, made deterministic by count, scan, write). */
#ifndef TANDEM_SHARED_BROADPHASE_BRUTE_FORCE_H
#define TANDEM_SHARED_BROADPHASE_BRUTE_FORCE_H

#include "shared/broadphase/overlap.h"

SHARED void brute_force_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                   GLOBAL const uint *body_filter, GLOBAL const uint *body_world,
                                   GLOBAL const float4 *bounds, GLOBAL uint *pair_start, uint a)
{
  box_bounds own = load_bounds(bounds, a);
  uint found = 0;
  for (uint b = first_of_world(parameters, body_world, a); b < a; ++b)
    if (bounds_overlap(own, load_bounds(bounds, b)) && pair_allowed(parameters, body_flags, body_filter, a, b)) ++found;
  pair_start[a] = found;
}

SHARED void brute_force_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                   GLOBAL const uint *body_filter, GLOBAL const uint *body_world,
                                   GLOBAL const float4 *bounds, GLOBAL const uint *pair_start,
                                   GLOBAL const uint *counts, write_pairs pairs, uint a)
{
  box_bounds own = load_bounds(bounds, a);
  uint used = 0;
  for (uint b = first_of_world(parameters, body_world, a); b < a; ++b)
    if (bounds_overlap(own, load_bounds(bounds, b)) && pair_allowed(parameters, body_flags, body_filter, a, b))
      used = append_pair(pairs.a, pairs.b, pair_start[a], used, counts[CAPACITY_PAIRS], a, b);
}

#endif
