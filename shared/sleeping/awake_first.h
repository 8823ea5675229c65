/* awake_first.h - where bodies and cached pairs go when some bodies fall asleep.
 *
 *   bodies    A b C d e F | g h      lower case: falls asleep or sleeps already
 *   becomes   A C F | b d e g h      the awake ones keep their order, and so do those that fall asleep
 *
 * Kernels of a step run over the awake bodies alone, which are the first ones. The rows of a body that falls asleep
 * move behind them, and its cached pairs move behind those of awake bodies, from where the host takes them
 * (host/world/sleepers.h). Awake bodies keep their order, so their cached pairs stay sorted.
 */
#ifndef TANDEM_SHARED_SLEEPING_AWAKE_FIRST_H
#define TANDEM_SHARED_SLEEPING_AWAKE_FIRST_H

#include "shared/records.h"

/* A body that sleeps has no velocity left. The fourth numbers stay: the inverse mass and the gravity factor. */
SHARED void stop_sleepers_item(GLOBAL const uint *falls_asleep, GLOBAL float4 *body_velocity, uint i)
{
  vec3 still = make_vec3(R(0.0), R(0.0), R(0.0));
  if (!falls_asleep[i]) return;
  store_float4(body_velocity, 2u * i, extend(still, load_float4(body_velocity, 2u * i).w));
  store_float4(body_velocity, 2u * i + 1u, extend(still, load_float4(body_velocity, 2u * i + 1u).w));
}

/* sleepers_before: of falls_asleep, an exclusive scan. */
SHARED void place_awake_first_item(GLOBAL const uint *counts, GLOBAL const uint *falls_asleep,
                                   GLOBAL const uint *sleepers_before, GLOBAL uint *move_from, GLOBAL uint *move_to,
                                   uint i)
{
  uint bodies = counts[COUNT_BODIES], awake = bodies - sleepers_before[bodies];
  move_from[i] = i;
  move_to[i] = falls_asleep[i] ? awake + sleepers_before[i] : i - sleepers_before[i];
}

SHARED uint pair_stays(GLOBAL const uint *falls_asleep, GLOBAL const uint *cached_b, uint a, uint pair)
{
  return !falls_asleep[a] && !falls_asleep[cached_b[pair]] ? 1u : 0u;
}

/* Counts the pairs of body i that stay, at its new place. A body that falls asleep keeps none. */
SHARED void count_awake_pairs_item(GLOBAL const uint *falls_asleep, GLOBAL const uint *move_to,
                                   GLOBAL const uint *cached_start, GLOBAL const uint *cached_b,
                                   GLOBAL uint *awake_pair_start, uint i)
{
  uint stay = 0u;
  for (uint pair = cached_start[i]; pair < cached_start[i + 1u]; ++pair)
    stay += pair_stays(falls_asleep, cached_b, i, pair);
  awake_pair_start[move_to[i]] = stay;
}

/* awake_pair_start is scanned by now. Pairs that leave keep their order behind all that stay. */
SHARED void place_cached_pairs_item(GLOBAL const uint *counts, GLOBAL const uint *falls_asleep,
                                    GLOBAL const uint *sleepers_before, GLOBAL const uint *move_to,
                                    GLOBAL const uint *cached_start, GLOBAL const uint *cached_b,
                                    GLOBAL const uint *awake_pair_start, GLOBAL uint *pair_target, GLOBAL uint *pair_a,
                                    uint i)
{
  uint stay = awake_pair_start[i - sleepers_before[i]], all = awake_pair_start[counts[COUNT_BODIES]];
  for (uint pair = cached_start[i]; pair < cached_start[i + 1u]; ++pair) {
    uint stays = pair_stays(falls_asleep, cached_b, i, pair), target = stays ? stay : all + (pair - stay);
    pair_target[pair] = target;
    pair_a[target] = move_to[i];
    stay += stays;
  }
}

/* The bodies of cached pairs by their new places. */
SHARED void renumber_cached_item(GLOBAL const uint *move_to, GLOBAL uint *cached_b, uint i)
{
  cached_b[i] = move_to[cached_b[i]];
}

#endif
