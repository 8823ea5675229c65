/* joined_pairs.h - bodies that do not collide because a joint connects them.
 *
 * A hash table of their pairs stands behind the filters of shapes, where every broadphase reads it. The host makes it
 * (host/scene/joint_buffers.cpp) with at least as many empty entries as pairs; a pair that finds its entry taken stands
 * in the next one that is not. A bit of the flags says which bodies are in it at all.
 *
 *   body_filter   | group mask | group mask | ... | a b | empty | a b | a b | empty | ...
 *                   shape 0      shape 1            joined_pairs_first
 */
#ifndef TANDEM_SHARED_BROADPHASE_JOINED_PAIRS_H
#define TANDEM_SHARED_BROADPHASE_JOINED_PAIRS_H

#include "shared/counts.h"
#include "shared/parameters.h"

/* The entry at which the search for a pair begins; a > b. */
SHARED uint joined_pair_hash(uint a, uint b)
{
  uint h = a * 0x9e3779b1u ^ (b * 0x85ebca77u + 0x27d4eb2fu);
  h ^= h >> 15;
  h *= 0xc2b2ae3du;
  return h ^ h >> 13;
}

SHARED int are_joined(GLOBAL const Parameters *parameters, GLOBAL const uint *body_filter, uint a, uint b)
{
  uint mask_of_table = parameters->joined_pairs_mask;
  for (uint k = joined_pair_hash(a, b) & mask_of_table;; k = (k + 1u) & mask_of_table) {
    GLOBAL const uint *entry = body_filter + parameters->joined_pairs_first + 2u * k;
    if (entry[0] == INDEX_NONE) return 0;
    if (entry[0] == a && entry[1] == b) return 1;
  }
}

#endif
