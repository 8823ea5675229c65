/* overlap.h - the rule that decides which two bodies make a pair, shared by every broadphase.
 *
 * A pair (a, b) has a > b and is owned by a, and pairs are sorted by (a, b). Every broadphase therefore yields the list
 * of the brute-force one, and the same bits downstream. The functions are for ITEM kernels.
 */
#ifndef TANDEM_SHARED_BROADPHASE_OVERLAP_H
#define TANDEM_SHARED_BROADPHASE_OVERLAP_H

#include "shared/argument_groups.h"
#include "shared/broadphase/joined_pairs.h"
#include "shared/records.h"

typedef struct {
  vec3 lower, upper;
} box_bounds;

SHARED box_bounds load_bounds(GLOBAL const float4 *bounds, uint body)
{
  box_bounds b = {xyz(load_float4(bounds, 2u * body)), xyz(load_float4(bounds, 2u * body + 1u))};
  return b;
}

SHARED int bounds_overlap(box_bounds p, box_bounds q)
{
  return p.lower.x <= q.upper.x && q.lower.x <= p.upper.x && p.lower.y <= q.upper.y && q.lower.y <= p.upper.y &&
         p.lower.z <= q.upper.z && q.lower.z <= p.upper.z;
}

/* The same with the two rows of a box in memory; w of these counts for nothing. */
SHARED int overlaps_rows(box_bounds p, GLOBAL const float4 *bounds, uint box)
{
#ifdef OVERLAPS_AT_ONCE
  floats_of_row lower = {p.lower.x, p.lower.y, p.lower.z, 0.0f}, upper = {p.upper.x, p.upper.y, p.upper.z, 0.0f};
  return rows_overlap(lower, upper, bounds + 2u * box);
#else
  return bounds_overlap(p, load_bounds(bounds, box));
#endif
}

/* The same without branches, for boxes that overlap about as often as not. */
SHARED int overlaps_body_at_once(box_bounds p, GLOBAL const float4 *bounds, uint body)
{
#ifdef OVERLAPS_AT_ONCE
  return overlaps_rows(p, bounds, body);
#else
  box_bounds q = load_bounds(bounds, body);
  return (p.lower.x <= q.upper.x) & (q.lower.x <= p.upper.x) & (p.lower.y <= q.upper.y) & (q.lower.y <= p.upper.y) &
         (p.lower.z <= q.upper.z) & (q.lower.z <= p.upper.z);
#endif
}

/* A trigger meets every body that is not a trigger, if one of the two moves, even if only by its given velocity. Two
 * half-spaces have no test. */
SHARED int trigger_meets(uint flags_a, uint flags_b)
{
  if (is_trigger(flags_a) == is_trigger(flags_b)) return 0;
  if (shape_of(flags_a) == (uint)SHAPE_HALF_SPACE && shape_of(flags_b) == (uint)SHAPE_HALF_SPACE) return 0;
  return body_type_of(flags_a) != (uint)BODY_TYPE_FIXED || body_type_of(flags_b) != (uint)BODY_TYPE_FIXED;
}

/* Two solid bodies meet if one of them is dynamic. */
SHARED int bodies_meet(GLOBAL const Parameters *parameters, uint flags_a, uint flags_b)
{
  if (HAS_FEATURE(parameters, TRIGGER) && is_trigger(flags_a | flags_b)) return trigger_meets(flags_a, flags_b);
  return body_type_of(flags_a) == (uint)BODY_TYPE_DYNAMIC || body_type_of(flags_b) == (uint)BODY_TYPE_DYNAMIC;
}

/* Whether each shape accepts the other's groups. a, b: indices of shapes, those of bodies or of children behind
 * them. */
SHARED int filters_accept(GLOBAL const Parameters *parameters, GLOBAL const uint *body_filter, uint a, uint b)
{
  if (!HAS_FEATURE(parameters, FILTER)) return 1;
  return (body_filter[2u * a] & body_filter[2u * b + 1u]) != 0u &&
         (body_filter[2u * b] & body_filter[2u * a + 1u]) != 0u;
}

SHARED int joint_forbids(GLOBAL const Parameters *parameters, GLOBAL const uint *body_filter, uint flags_a,
                         uint flags_b, uint a, uint b)
{
  if (!HAS_FEATURE(parameters, JOINED_PAIRS) || (flags_a & flags_b & (uint)BODY_FLAG_JOINED) == 0u) return 0;
  return are_joined(parameters, body_filter, a > b ? a : b, a > b ? b : a);
}

/* A pair is allowed if the bodies can meet, neither is quarantined, no joint forbids it, and each accepts the other's
 * groups. */
SHARED int pair_allowed(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                        GLOBAL const uint *body_filter, uint a, uint b)
{
  uint flags_a = body_flags[a], flags_b = body_flags[b];
  if (!bodies_meet(parameters, flags_a, flags_b)) return 0;
  if (body_type_of(flags_a) == (uint)BODY_TYPE_QUARANTINED || body_type_of(flags_b) == (uint)BODY_TYPE_QUARANTINED)
    return 0;
  return filters_accept(parameters, body_filter, a, b) &&
         !joint_forbids(parameters, body_filter, flags_a, flags_b, a, b);
}

/* Appends a pair to the range of its owner, which starts at pair_start[a], in the order found; sort_range sorts it
 * later. */
SHARED uint append_pair(GLOBAL uint *pair_a, GLOBAL uint *pair_b, uint first, uint used, uint capacity, uint a, uint b)
{
  uint at = first + used;
  if (at >= capacity) return used; /* already counted; the step runs again with a larger capacity */
  pair_a[at] = a;
  pair_b[at] = b;
  return used + 1u;
}

SHARED void insertion_sort(GLOBAL uint *values, uint length)
{
  for (uint i = 1u; i < length; ++i) {
    uint value = values[i], at = i;
    for (; at > 0u && values[at - 1u] > value; --at) values[at] = values[at - 1u];
    values[at] = value;
  }
}

/* Sifts `value` down from `at` in the heap of `length` values. */
SHARED void sink(GLOBAL uint *values, uint at, uint length, uint value)
{
  for (uint child = 2u * at + 1u; child < length; child = 2u * at + 1u) {
    if (child + 1u < length && values[child + 1u] > values[child]) child = child + 1u;
    if (values[child] <= value) break;
    values[at] = values[child];
    at = child;
  }
  values[at] = value;
}
SHARED void heap_sort(GLOBAL uint *values, uint length)
{
  for (uint at = length / 2u; at > 0u; --at) sink(values, at - 1u, length, values[at - 1u]);
  for (uint last = length - 1u; last > 0u; --last) {
    uint value = values[last];
    values[last] = values[0];
    sink(values, 0u, last, value);
  }
}

/* A longer range is sorted as a heap, because the time for one body with thousands of neighbours must not be
 * quadratic. */
#define SHORT_RANGE 32u
SHARED void sort_range(GLOBAL uint *values, uint length)
{
  if (length <= SHORT_RANGE) insertion_sort(values, length);
  else heap_sort(values, length);
}

/* Clamps the number of pairs found, which is the total of the scan over `length` starts, to the capacity. */
SHARED void count_pairs_item(GLOBAL const uint *starts, GLOBAL uint *counts, uint length, uint i)
{
  (void)i;
  uint needed = starts[counts[length]];
  counts[COUNT_PAIRS_NEEDED] = needed;
  counts[COUNT_PAIRS] = needed < counts[CAPACITY_PAIRS] ? needed : counts[CAPACITY_PAIRS];
}

#endif
