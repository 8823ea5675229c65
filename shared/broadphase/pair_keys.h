/* pair_keys.h - makes the pair list from keys (a, b) in any order, for broadphases in which a body finds pairs that
 * another body owns.
 *
 * The sorted keys are the list. Each body finds the start of its range by itself.
 */
#ifndef TANDEM_SHARED_BROADPHASE_PAIR_KEYS_H
#define TANDEM_SHARED_BROADPHASE_PAIR_KEYS_H

#include "shared/counts.h"
#include "shared/broadphase/neighbors.h"
#include "shared/parallel/search.h"

/* The first place among `length` sorted keys whose pair belongs to `body` or to a body after it. */
SHARED uint first_key_of(GLOBAL const ulong *keys, uint length, uint body)
{
  uint first = 0u, count = length;
  while (count > 0u) {
    uint skipped = count / 2u;
    mask is_before = (uint)(keys[first + skipped] >> 32) < body;
    first = is_before ? first + skipped + 1u : first;
    count = is_before ? count - skipped - 1u : skipped;
  }
  return first;
}

SHARED void unpack_pairs_item(GLOBAL const ulong *pair_key, GLOBAL uint *pair_a, GLOBAL uint *pair_b, uint i)
{
  pair_a[i] = (uint)(pair_key[i] >> 32);
  pair_b[i] = (uint)pair_key[i];
}
SHARED void start_pairs_item(GLOBAL const uint *pair_a, GLOBAL const uint *counts, GLOBAL uint *pair_start, uint body)
{
  pair_start[body] = lower_bound_of(pair_a, counts[COUNT_PAIRS], body);
}

#endif
