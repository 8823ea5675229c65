/* sap3.h - incremental sweep and prune along three axes: the list of pairs is kept, and only what changed is looked
 * for.
 *
 * After the parallel one of Erwin Coumans in Bullet's OpenCL pipeline (GS-4150), of six sorted axes: three now, three
 * as they were. Where bodies move little from step to step, ends hardly change places, and next to nothing is searched:
 *
 *     sort the ends along each axis                      endpoints.h
 *     the pairs of which two ends changed their order    endpoint_changes.h
 *     kept pairs   (5,1) (5,3)       (7,2)
 *     changes            (5,3) (6,4)                     in one of the two: a pair; in both: it is over
 *     pairs        (5,1)       (6,4) (7,2)               kept in turn
 *
 * There the changes are appended by atomics and the list is patched in place; here both lists are sorted, so each body
 * merges its two ranges, and the result is the brute-force list. What is kept describes the bounds of the last
 * launch, whatever became of that step: the next launch finds the difference to it, hence needs no commit.
 */
#ifndef TANDEM_SHARED_BROADPHASE_SAP3_H
#define TANDEM_SHARED_BROADPHASE_SAP3_H

#include "shared/broadphase/endpoint_changes.h"

/* A body's ranges of the kept pairs and of the changes, from where they are merged on. */
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

/* The next partner of `body` in the merged list, ascending; INDEX_NONE behind the last. */
SHARED uint next_partner(merging *m, uint body)
{
  for (;;) {
    uint kept = m->kept < m->kept_end ? m->kept_b[m->kept] : INDEX_NONE, changed = INDEX_NONE;
    ulong key = m->change < m->change_end ? m->changes[m->change] : 0u;
    if (m->change < m->change_end && (uint)(key >> 32) == body) changed = (uint)key;
    uint partner = kept < changed ? kept : changed;
    if (partner == INDEX_NONE) return partner;
    if (kept == partner) m->kept = m->kept + 1u;
    if (changed == partner) /* told twice if a box ceases to be one: both its ends pass the other's */
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

/* Changes that found no room make the list wrong: the step must run again with room for them, and from nothing. In
 * double, too, nothing is kept: places come from floats, so bodies may part within one of them without any end changing
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
