/* events.cl - entries: which pairs touch, and what the user is told of it. */
#include "cl/entry.h"
#include "shared/events/impulses.h"
#include "shared/events/pair_events.h"

__kernel void sum_impulses(__global const row *constraint_normal_impulse, __global row *constraint_impulse,
                           uint substep, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sum_impulses_item(constraint_normal_impulse, constraint_impulse, substep, i);
}

__kernel void pair_impulses(__global const uint *constraint_pair, __global const row *constraint_impulse,
                            __global const row *constraint_normal_impulse, __global row *pair_impulse, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  pair_impulses_item(constraint_pair, constraint_impulse, constraint_normal_impulse, pair_impulse, i);
}

__kernel void find_touching(__global const uint *pair_color, __global const row *pair_impulse,
                            __global const row *manifold_points, __global const uint *manifold_count,
                            __global const uint *counts, __global uint *pair_touching, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  find_touching_item(pair_color, pair_impulse, manifold_points, manifold_count, counts, pair_touching, i);
}

__kernel void count_events(__global const uint *pair_start, __global const uint *pair_b,
                           __global const uint *pair_touching, __global const uint *cached_start,
                           __global const uint *cached_b, __global const uint *cached_touching,
                           __global uint *event_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_events_item(pair_start, pair_b, pair_touching, cached_start, cached_b, cached_touching, event_start, i);
}

__kernel void write_events(__global const uint *pair_start, __global const uint *pair_b,
                           __global const uint *pair_color, __global const uint *pair_touching,
                           __global const row *pair_impulse, __global const row *manifold_normal,
                           __global const row *manifold_points, __global const uint *manifold_count,
                           __global const uint *cached_start, __global const uint *cached_b,
                           __global const uint *cached_touching, __global const row *body_position,
                           __global const row *body_velocity, __global const uint *event_start,
                           __global const uint *counts, __global uint *event_bodies, __global row *event_contact, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  write_events_item(pair_start, pair_b, pair_color, pair_touching, pair_impulse, manifold_normal, manifold_points,
                    manifold_count, cached_start, cached_b, cached_touching, body_position, body_velocity, event_start,
                    counts, event_bodies, event_contact, i);
}

__kernel void count_pair_events(__global const uint *pair_start, __global const uint *pair_b,
                                __global const uint *cached_start, __global const uint *cached_b,
                                __global uint *pair_event_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_pair_events_item(pair_start, pair_b, cached_start, cached_b, pair_event_start, i);
}

__kernel void write_pair_events(__global const uint *pair_start, __global const uint *pair_b,
                                __global const uint *cached_start, __global const uint *cached_b,
                                __global const uint *pair_event_start, __global uint *pair_event, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  write_pair_events_item(pair_start, pair_b, cached_start, cached_b, pair_event_start, pair_event, i);
}
