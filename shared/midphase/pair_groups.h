/* pair_groups.h - the number of pairs that a work-group of subtree_pairs.h and of followed_pairs.h processes, for
 * kernels and for the host that launches them.
 *
 * A GROUP kernel runs one group for each TILE items of its range, so the range is TILE times the number of groups. */
#ifndef TANDEM_SHARED_MIDPHASE_PAIR_GROUPS_H
#define TANDEM_SHARED_MIDPHASE_PAIR_GROUPS_H

#include "shared/counts.h"
#include "shared/parallel/length.h"

/* Pairs of a group of subtree_pairs.h. They are consecutive; because pairs are sorted, most of them search one tree. */
#define GROUP_PAIRS 64u
/* Pairs of a group of followed_pairs.h. They are more than a group has items, because a device takes longer to start a
 * group than to read a tile. */
#define FOLLOW_PAIRS 1024u

/* The result is exact up to 2^28 pairs, as is the scan that follows. */
SHARED uint pair_group_items(uint pairs, uint pairs_of_group)
{
  uint groups = units_of(pairs, pairs_of_group);
  return groups > 0xffffffffu / TILE ? 0xffffffffu : groups * TILE;
}

SHARED void group_body_pairs_item(GLOBAL uint *counts, uint i)
{
  (void)i;
  counts[COUNT_BODY_PAIRS] = counts[COUNT_PAIRS];
  counts[COUNT_PAIR_GROUP_ITEMS] = pair_group_items(counts[COUNT_PAIRS], GROUP_PAIRS);
}

#endif
