/* pair_lists.h - the pairs sorted by kind, so that each kernel of the narrowphase runs over the pairs of its own two
 * shapes alone.
 *
 *   pairs          B S B X S S B            kinds of pairs.def
 *   pair_of_kind   1 4 5 | 0 2 6 | 3        KIND_START: 0, 3, 6, 7
 *
 *   find_pair_kinds    tells the kind of each pair (far_pairs.h)
 *   count_pair_kinds   counts the pairs of each kind in a tile
 *   (scan)             gives each tile the place of its pairs of a kind, kind by kind, tile by tile
 *   start_pair_lists   stores where each kind starts
 *   list_pairs         writes the pairs of each tile in their order
 *
 * The results for a pair stay at the pair's own index; the lists only assign pairs to kernels. All items of a vector
 * or a warp therefore have work, and neighbours in a list are mostly neighbours among the pairs as well.
 *
 * A scene whose pairs hardly mix has no lists (host/scene/specialise.cpp decides). An item is then a pair, and a kernel
 * skips those of other kinds. handled_pair() hides the difference.
 *
 * The kernels that make the lists read a pair's kind twice and write one word. A radix sort would move twice the bytes,
 * for its keys and values.
 *
 * In a scene with trees the kind of a pair is that of the parts that take part, so a capsule or ball of a compound has
 * the tests of capsules. Such a scene has lists.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_PAIR_LISTS_H
#define TANDEM_SHARED_NARROWPHASE_PAIR_LISTS_H

#include "shared/argument_groups.h"
#include "shared/pair_kinds.h"

/* The range of items of a kind. Kernels that run by groups must read it themselves. */
SHARED uint start_of_list(GLOBAL const Parameters *parameters, GLOBAL const uint *counts, uint kind)
{
  return HAS_FEATURE(parameters, PAIR_KINDS) ? counts[KIND_START + kind] : 0u;
}
SHARED uint end_of_list(GLOBAL const Parameters *parameters, GLOBAL const uint *counts, uint kind)
{
  return HAS_FEATURE(parameters, PAIR_KINDS) ? counts[KIND_START + kind + 1u] : counts[COUNT_PAIRS];
}

/* The pair that an item of a pair kernel processes. mine: false if the pair belongs to another kernel. */
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

/* A body of a pair, and the shape of it that takes part: its own, or a child of its compound. */
typedef struct {
  uint_lanes body, shape;
} collider;

/* leaf: of the pairs; side: 0 for the first body, 1 for the second. */
SHARED collider collider_of_pair(GLOBAL const Parameters *parameters, GLOBAL const uint *leaf, uint_lanes body,
                                 uint_lanes pair, uint side)
{
  collider c = {body, shape_in_pair(parameters, leaf, pair, side, body)};
  return c;
}

SHARED collider choose_collider(mask m, collider a, collider b)
{
  collider c = {choose(m, a.body, b.body), choose(m, a.shape, b.shape)};
  return c;
}

SHARED handled handled_pair(GLOBAL const Parameters *parameters, read_listed_pairs pairs, GLOBAL const uint *flags,
                            uint kind, item_index i)
{
  handled h;
  h.pair = pair_of_item(parameters, pairs.of_kind, i);
  if (HAS_FEATURE(parameters, PAIR_KINDS)) {
    h.a = load_uint(pairs.a, h.pair);
    h.b = load_uint(pairs.b, h.pair);
  } else { /* the index i is consecutive, so lanes load with one instruction */
    h.a = load_uint(pairs.a, i);
    h.b = load_uint(pairs.b, i);
  }
  h.mine = is_of_kind(parameters, flags, h.a, h.b, kind);
  return h;
}

/* The same with the shapes that take part. */
typedef struct {
  uint_lanes pair;
  collider a, b;
  mask mine;
} handled_parts;

SHARED handled_parts handled_part_pair(GLOBAL const Parameters *parameters, read_listed_part_pairs pairs,
                                       GLOBAL const uint *flags, uint kind, item_index i)
{
  read_listed_pairs of_bodies = {pairs.a, pairs.b, pairs.of_kind};
  handled h = handled_pair(parameters, of_bodies, flags, kind, i);
  handled_parts parts = {h.pair, collider_of_pair(parameters, pairs.leaf, h.a, h.pair, 0u),
                         collider_of_pair(parameters, pairs.leaf, h.b, h.pair, 1u), h.mine};
  return parts;
}

#endif
