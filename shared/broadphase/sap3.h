/* sap3.h - incremental sweep and prune along three axes: the list of pairs is kept, and only its changes are searched
 * for.
 *
 * It follows the parallel incremental method of Erwin Coumans in Bullet's OpenCL pipeline (GS-4150), with six sorted
 * axes: three of this launch and three of the last one. If bodies move little from step to step, ends hardly change
 * their order, and the search is short:
 *
 *     sort the ends along each axis                      endpoints.h
 *     find the pairs with two ends that changed order    endpoint_changes.h
 *     kept pairs   (5,1) (5,3)       (7,2)
 *     changes            (5,3) (6,4)                     a pair in one of the two lists stays, in both it is removed
 *     pairs        (5,1)       (6,4) (7,2)               kept for the next launch
 *
 * Bullet appends the changes by atomics and patches the list in place. Here both lists are sorted, so each body merges
 * its two ranges, and the result is the brute-force list. The kept data describe the bounds of the last launch, even if
 * that step failed: the next launch finds the difference from it, so no commit is needed.
 */
#ifndef TANDEM_SHARED_BROADPHASE_SAP3_H
#define TANDEM_SHARED_BROADPHASE_SAP3_H

#include "shared/broadphase/endpoint_changes.h"

/* The ranges of a body in the kept pairs and in the changes, from the current place of the merge on. */
typedef struct {
  GLOBAL const uint *kept_b;
  GLOBAL const ulong *changes;
  uint kept, kept_end, change, change_end;
} merging;

SHARED merging begin_merge(GLOBAL const ulong *pair_key, GLOBAL const uint *kept_start, GLOBAL const uint *kept_b,
                           GLOBAL const uint *counts, uint body)
{
  uint changes = counts[COUNT_CHANGES];
  merging m = {kept_b, pair_key, 0u, 0u, first_key_of(pair_key, changes, body), changes};
  if (counts[COUNT_KEPT] != 0u) {
    m.kept = kept_start[body];
    m.kept_end = kept_start[body + 1u];
  }
  return m;
}

/* The next partner of `body` in the merged list, ascending; INDEX_NONE after the last. */
SHARED uint next_partner(merging *m, uint body)
{
  for (;;) {
    uint kept = m->kept < m->kept_end ? m->kept_b[m->kept] : INDEX_NONE, changed = INDEX_NONE;
    ulong key = m->change < m->change_end ? m->changes[m->change] : 0u;
    if (m->change < m->change_end && (uint)(key >> 32) == body) changed = (uint)key;
    uint partner = kept < changed ? kept : changed;
    if (partner == INDEX_NONE) return partner;
    if (kept == partner) m->kept = m->kept + 1u;
    if (changed == partner) /* found twice if a box becomes invalid, because both its ends pass the other's */
      while (m->change < m->change_end && m->changes[m->change] == key) m->change = m->change + 1u;
    if (kept != changed) return partner;
  }
}

SHARED void merge_count_item(GLOBAL const ulong *pair_key, GLOBAL const uint *kept_start, GLOBAL const uint *kept_b,
                             GLOBAL const uint *counts, GLOBAL uint *pair_start, uint body)
{
  merging m = begin_merge(pair_key, kept_start, kept_b, counts, body);
  uint pairs = 0;
  while (next_partner(&m, body) != INDEX_NONE) ++pairs;
  pair_start[body] = pairs;
}

SHARED void merge_write_item(GLOBAL const ulong *pair_key, GLOBAL const uint *kept_start, GLOBAL const uint *kept_b,
                             GLOBAL const uint *counts, GLOBAL const uint *pair_start, GLOBAL uint *pair_a,
                             GLOBAL uint *pair_b, uint body)
{
  merging m = begin_merge(pair_key, kept_start, kept_b, counts, body);
  uint first = pair_start[body], used = 0, capacity = counts[CAPACITY_PAIRS];
  for (uint b = next_partner(&m, body); b != INDEX_NONE; b = next_partner(&m, body))
    used = append_pair(pair_a, pair_b, first, used, capacity, body, b);
}

/* Changes beyond the capacity make the list wrong, so the step runs again with a larger one, and from nothing. In
 * double nothing is kept either: the order comes from floats, so bodies may part within one float while no end changes
 * its place. */
SHARED void keep_or_forget_item(GLOBAL uint *counts, uint i)
{
  (void)i;
  uint capacity = counts[CAPACITY_PAIRS], found = counts[COUNT_CHANGES_FOUND], needed = counts[COUNT_PAIRS_NEEDED];
  if (found > capacity && found > needed) counts[COUNT_PAIRS_NEEDED] = found;
  uint is_whole = found <= capacity && needed <= capacity ? 1u : 0u;
  counts[COUNT_KEPT] = sizeof(real) == sizeof(float) ? is_whole : 0u;
}

#endif
