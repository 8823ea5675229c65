/* pair_lists.h - pairs sorted by kind: between the lists of pairs and the narrowphase, so that each of its kernels runs
 * over pairs of its own two shapes alone.
 *
 *   pairs          B S B X S S B            kinds of pairs.def
 *   pair_of_kind   1 4 5 | 0 2 6 | 3        KIND_START: 0, 3, 6, 7
 *
 *   count_pair_kinds   how many of each kind a tile has
 *   (scan)             kind by kind, tile by tile: where each tile's pairs of a kind go
 *   start_pair_lists   where each kind starts
 *   list_pairs         each tile writes its pairs, in their order
 *
 * What is found of a pair stays at the pair's own place; the lists say who looks for it. Kernels of many items an
 * instruction find all of these at work, and neighbours of a list are mostly neighbours of the pairs as well.
 *
 * A scene whose pairs hardly mix has no lists (host/scene/specialise.cpp says when): an item is then a pair, and a
 * kernel passes over those of other kinds. handled_pair() hides which of both it is.
 *
 * The kernels that make the lists read a pair's bodies twice and write one word; the radix sort would move twice the
 * bytes, for its keys and values.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_PAIR_LISTS_H
#define TANDEM_SHARED_NARROWPHASE_PAIR_LISTS_H

#include "shared/argument_groups.h"
#include "shared/pair_kinds.h"

/* Of the items of a kernel of this kind: kernels of groups must know. */
SHARED uint start_of_list(GLOBAL const Parameters *parameters, GLOBAL const uint *counts, uint kind)
{
  return HAS_FEATURE(parameters, PAIR_KINDS) ? counts[KIND_START + kind] : 0u;
}
SHARED uint end_of_list(GLOBAL const Parameters *parameters, GLOBAL const uint *counts, uint kind)
{
  return HAS_FEATURE(parameters, PAIR_KINDS) ? counts[KIND_START + kind + 1u] : counts[COUNT_PAIRS];
}

/* What an item of a pair kernel works on. mine: false where the pair is another kernel's. */
typedef struct {
  uint_lanes pair, a, b;
  mask mine;
} handled;

SHARED uint_lanes pair_of_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_of_kind, item_index i)
{
  return HAS_FEATURE(parameters, PAIR_KINDS) ? load_uint(pair_of_kind, i) : (uint_lanes)i;
}

SHARED mask is_of_kind(GLOBAL const Parameters *parameters, GLOBAL const uint *flags, uint_lanes a, uint_lanes b,
                       uint kind)
{
  mask one = a == b;
  if (HAS_FEATURE(parameters, PAIR_KINDS)) return one | (!one);
  return pair_kind(load_uint(flags, a), load_uint(flags, b)) == kind;
}

SHARED handled handled_pair(GLOBAL const Parameters *parameters, read_listed_pairs pairs, GLOBAL const uint *flags,
                            uint kind, item_index i)
{
  handled h;
  h.pair = pair_of_item(parameters, pairs.of_kind, i);
  if (HAS_FEATURE(parameters, PAIR_KINDS)) {
    h.a = load_uint(pairs.a, h.pair);
    h.b = load_uint(pairs.b, h.pair);
  } else { /* in the order of memory, which lanes load at once */
    h.a = load_uint(pairs.a, i);
    h.b = load_uint(pairs.b, i);
  }
  h.mine = is_of_kind(parameters, flags, h.a, h.b, kind);
  return h;
}

#endif
