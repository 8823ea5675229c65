/* followed_pairs.h - gathers the pairs of a kind that are followed to their impact (time_of_impact.h), for the kernels
 * that follow them.
 *
 *   pairs | . . x . . . . x . . . . . . . x | . . .      x: marked TO_FOLLOW
 *             |         |               |
 *            [0]       [1]             [2]               the items of a group, or lanes, take them
 *
 * Few pairs are marked, so a group first gathers the marked ones of FOLLOW_PAIRS pairs. If each item looked at a pair
 * of its own instead, a device would run the long loops of following with most items of each warp idle.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_FOLLOWED_PAIRS_H
#define TANDEM_SHARED_NARROWPHASE_FOLLOWED_PAIRS_H

#include "shared/midphase/pair_groups.h"
#include "shared/narrowphase/manifold.h"
#include "shared/narrowphase/pair_lists.h"

/* list: of 1 + FOLLOW_PAIRS words: the number of marked pairs, then their indices in any order. marks: the numbers of
 * points, in which the marks are. */
SHARED void gather_followed_pairs(GLOBAL const uint *of_kind, GLOBAL const uint *pair_a, GLOBAL const uint *pair_b,
                                  GLOBAL const uint *flags, GLOBAL const Parameters *parameters,
                                  GLOBAL const uint *counts, GLOBAL const uint *marks, uint kind, LOCAL uint *list,
                                  uint group)
{
  const uint first = start_of_list(parameters, counts, kind) + group * FOLLOW_PAIRS;
  const uint end = end_of_list(parameters, counts, kind);
  const uint count = first < end ? (end - first < FOLLOW_PAIRS ? end - first : FOLLOW_PAIRS) : 0u;
  FOR_EACH_ITEM(only, 1u) list[only] = 0u;
  FOR_EACH_ITEM(k, count)
  {
    const uint pair = HAS_FEATURE(parameters, PAIR_KINDS) ? of_kind[first + k] : first + k;
    if (marks[pair] >= TO_FOLLOW && any_of(is_of_kind(parameters, flags, pair_a[pair], pair_b[pair], kind)))
      list[1u + LOCAL_ADD(list, 1u)] = pair;
  }
}

#endif
