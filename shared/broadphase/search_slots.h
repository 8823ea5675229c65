/* search_slots.h - where the bodies that left their fat boxes keep the pairs they find, so that most search only once.
 *
 * A search has to count its pairs before a scan can tell where they go (neighbors.h). Few bodies search in a step, and
 * they find many: of people who fall in a pile one body in nine, and half of these more than eight pairs. So the finds
 * of a search go into the buffer that the sort of all new keys needs later, which is cut into blocks, one for 64 bodies
 * in a row, and a block into equal slots, one for each body of the block that left:
 *
 *     bodies               0 . . . . . . . . . . 63   64 . . .
 *     left                     x       x    x           x
 *     candidate_key_other  [   0   |   1   |   2   ]  [ 0 ...        (keys of pairs)
 *
 * A body that finds more than its slot holds searches again when its place is known.
 */
#ifndef TANDEM_SHARED_BROADPHASE_SEARCH_SLOTS_H
#define TANDEM_SHARED_BROADPHASE_SEARCH_SLOTS_H

#include "shared/counts.h"
#include "shared/platform.h"

#define SLOT_BLOCK 64u /* bodies */

typedef struct {
  uint first, size;
} search_slot;

/* The slot of body i among `capacity` keys; a body that did not leave has none. */
SHARED search_slot slot_of_search(GLOBAL const uint *body_left, GLOBAL const uint *counts, uint capacity, uint i)
{
  search_slot slot = {0u, 0u};
  if (body_left[i] == 0u) return slot;
  uint bodies = counts[COUNT_BODIES], from = i - i % SLOT_BLOCK, before = 0u, searching = 0u;
  uint end = bodies - from < SLOT_BLOCK ? bodies : from + SLOT_BLOCK;
  for (uint k = from; k < end; ++k) {
    uint left = body_left[k] != 0u ? 1u : 0u;
    before += k < i ? left : 0u;
    searching += left;
  }
  uint keys_of_body = capacity / bodies;
  slot.size = keys_of_body * (end - from) / searching;
  slot.first = keys_of_body * from + slot.size * before;
  return slot;
}

#endif
