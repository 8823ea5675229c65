/* pair_groups.h - how many pairs a work-group of subtree_pairs.h and of follow_boxes.h takes: known to kernels and to
 * the host that launches them.
 *
 * GROUP kernels run a group for each TILE items of their range, hence a range of its own: TILE times the groups. */
#ifndef TANDEM_SHARED_MIDPHASE_PAIR_GROUPS_H
#define TANDEM_SHARED_MIDPHASE_PAIR_GROUPS_H

#include "shared/counts.h"
#include "shared/parallel/length.h"

/* Consecutive pairs: as they are sorted, neighbours mostly ask one tree. */
#define GROUP_PAIRS 64u
/* More than a group has items, for to start a group takes a device longer than to look at a tile. */
#define FOLLOW_PAIRS 1024u

/* Exact up to 2^28 pairs, as the scan behind it. */
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
