/* hierarchy.h - a tree of boxes over the bodies with finite bounds along a space-filling curve: the linear BVH, built
 * in parallel on the device.
 *
 * It follows the GPU tree of the 2009 talk, and Karras, "Maximizing parallelism in the construction of BVHs, octrees,
 * and k-d trees", 2012. Bodies are sorted by the Morton code of their centres (curve.h). Every node holds a range of
 * the list and splits it where the codes first differ, which also splits space. Each node finds its range by itself:
 *
 *     code   00001 00010 00100 00101 10011 11000
 *     place    0     1     2     3     4     5
 *     inner  [0------------------------------5]
 *            [------- 3 -------]      [--4---]
 *            [--1--]     [--2--]
 *
 * The range of inner node i starts or ends at place i, and extends as far as codes share more bits with code i than the
 * neighbour on the other side does. If a node splits between s and s + 1, its children are the leaf or inner node s,
 * whose range ends at s, and the leaf or inner node s + 1, whose range starts there.
 *
 * Leaf i is in slot 2 i and inner node i in slot 2 i + 1, so neighbours on the curve are neighbours in memory. The
 * links of a slot are its two children, the slot after its subtree (the second child of the node whose first child it
 * is), and its parent.
 *
 * The order and the links are kept from step to step and only the boxes are rebuilt, until one body in sixteen no
 * longer overlaps the box that it was inserted with. A node also stores the lowest index of a body below it: a body
 * searches only for those before it, and skips the other subtrees. Half-spaces have no bounds; they come first of all
 * bodies and are tested against every body.
 */
#ifndef TANDEM_SHARED_BROADPHASE_HIERARCHY_H
#define TANDEM_SHARED_BROADPHASE_HIERARCHY_H

#include "shared/broadphase/box_pyramid.h"
#include "shared/broadphase/curve.h"

enum { LINK_FIRST, LINK_SECOND, LINK_AFTER, LINK_PARENT };

#define LINKS 4u

SHARED uint leaf_slot(uint place) { return 2u * place; }
SHARED uint inner_slot(uint node) { return 2u * node + 1u; }
SHARED mask is_leaf_slot(uint slot) { return (slot & 1u) == 0u; }
SHARED uint root_slot(GLOBAL const uint *counts)
{
  uint leaves = counts[COUNT_HIERARCHY];
  return leaves == 0u ? INDEX_NONE : leaves == 1u ? leaf_slot(0u) : inner_slot(0u);
}

/* --- whether to insert the bodies anew ------------------------------------------------------------------ */

#define LEAVES_PER_ESCAPED 16u

/* Leaf i, inserted in some step before this. */
SHARED void count_escaped_item(GLOBAL const float4 *bounds, GLOBAL const uint *leaf_body,
                               GLOBAL const float4 *inserted_bounds, GLOBAL uint *counts, uint i)
{
  if (counts[COUNT_HIERARCHY_KEPT] == 0u) return;
  if (!bounds_overlap(load_bounds(bounds, leaf_body[i]), load_bounds(inserted_bounds, i)))
    ATOMIC_ADD(&counts[COUNT_ESCAPED], 1u);
}

/* Sets the size of the pyramid for a tree over the first `leaves` of the sorted list. */
SHARED void set_leaves(GLOBAL uint *counts, uint leaves)
{
  uint capacity = 1u;
  while (capacity < leaves) capacity = capacity * 2u;
  counts[COUNT_HIERARCHY] = leaves;
  counts[COUNT_LEAVES] = capacity;
  counts[COUNT_LEAF_TILES] = capacity > TILE ? capacity / TILE : 1u;
}

/* keep: whether the order of the last step may be kept, if there is one. */
SHARED void plan_hierarchy_item(GLOBAL uint *counts, uint keep, uint i)
{
  (void)i;
  uint leaves = counts[COUNT_BOUNDED];
  uint stands = keep != 0u && counts[COUNT_HIERARCHY_KEPT] != 0u && counts[COUNT_ESCAPED] * LEAVES_PER_ESCAPED <= leaves
                    ? 1u
                    : 0u;
  counts[COUNT_ESCAPED] = 0u;
  counts[COUNT_INSERTED] = stands != 0u ? 0u : leaves;
  counts[COUNT_HIERARCHY_KEPT] = keep;
  set_leaves(counts, leaves);
  counts[COUNT_INSERTED_LEAVES] = stands != 0u ? 0u : counts[COUNT_LEAVES];
}

/* boxes: the boxes that the tree is built over. */
SHARED void insert_leaves_item(GLOBAL const float4 *boxes, GLOBAL const uint *sort_value, GLOBAL uint *leaf_body,
                               GLOBAL float4 *inserted_bounds, uint i)
{
  uint body = sort_value[i];
  leaf_body[i] = body;
  store_float4(inserted_bounds, 2u * i, load_float4(boxes, 2u * body));
  store_float4(inserted_bounds, 2u * i + 1u, load_float4(boxes, 2u * body + 1u));
}

/* --- building ----------------------------------------------------------------------------------------- */

typedef struct {
  GLOBAL const uint *keys; /* sorted */
  uint length;
} sorted_codes;

/* The number of leading bits that the codes of two places share; equal codes are told apart by their places. -1 outside
 * the list. */
SHARED int shared_bits(const sorted_codes *codes, uint place, int other)
{
  if (other < 0 || other >= (int)codes->length) return -1;
  uint difference = codes->keys[place] ^ codes->keys[other];
  return difference != 0u ? LEADING_ZEROS(difference) : 32 + LEADING_ZEROS(place ^ (uint)other);
}

/* The distance from `place`, in the direction 1 or -1, up to which at least `least` bits are shared. too_far: a power
 * of two beyond that distance. */
SHARED int reach_of_bits(const sorted_codes *codes, uint place, int direction, int least, int too_far)
{
  int reach = 0;
  for (int step = too_far / 2; step > 0; step = step / 2)
    if (shared_bits(codes, place, (int)place + (reach + step) * direction) >= least) reach = reach + step;
  return reach;
}

typedef struct {
  uint first, last, split;
} leaf_range;

/* The range of leaves below inner node i. */
SHARED leaf_range range_of_node(const sorted_codes *codes, uint i)
{
  int direction = shared_bits(codes, i, (int)i + 1) > shared_bits(codes, i, (int)i - 1) ? 1 : -1;
  int least = shared_bits(codes, i, (int)i - direction) + 1, too_far = 2;
  while (shared_bits(codes, i, (int)i + too_far * direction) >= least) too_far = too_far * 2;
  int length = reach_of_bits(codes, i, direction, least, too_far);
  int end = (int)i + length * direction;
  int common = shared_bits(codes, i, end);
  int reach = reach_of_bits(codes, i, direction, common + 1, too_far);
  leaf_range s;
  s.first = direction > 0 ? i : (uint)end;
  s.last = direction > 0 ? (uint)end : i;
  s.split = direction > 0 ? i + (uint)reach : i - (uint)reach - 1u;
  return s;
}

/* The slot after a subtree that ends at place `last`: that of the largest subtree that starts behind it. */
SHARED uint slot_after(const sorted_codes *codes, uint last)
{
  uint next = last + 1u;
  if (next >= codes->length) return INDEX_NONE;
  return shared_bits(codes, next, (int)next + 1) > shared_bits(codes, next, (int)last) ? inner_slot(next)
                                                                                       : leaf_slot(next);
}

/* Writes the links of leaf i, and of inner node i unless i is the last place. Each node writes the parent links of its
 * children. */
SHARED void link_nodes_item(GLOBAL const uint *sort_key, GLOBAL const uint *counts, GLOBAL uint *hierarchy_link,
                            GLOBAL uint *hierarchy_range, uint i)
{
  sorted_codes codes = {sort_key, counts[COUNT_HIERARCHY]};
  GLOBAL uint *leaf = hierarchy_link + LINKS * leaf_slot(i), *inner = leaf + LINKS;
  leaf[LINK_FIRST] = leaf[LINK_SECOND] = INDEX_NONE;
  leaf[LINK_AFTER] = slot_after(&codes, i);
  if (i == 0u) hierarchy_link[LINKS * root_slot(counts) + LINK_PARENT] = INDEX_NONE;
  if (i + 1u == codes.length) return;
  leaf_range s = range_of_node(&codes, i);
  uint first = s.split == s.first ? leaf_slot(s.split) : inner_slot(s.split);
  uint second = s.split + 1u == s.last ? leaf_slot(s.split + 1u) : inner_slot(s.split + 1u);
  inner[LINK_FIRST] = first;
  inner[LINK_SECOND] = second;
  inner[LINK_AFTER] = slot_after(&codes, s.last);
  hierarchy_link[LINKS * first + LINK_PARENT] = hierarchy_link[LINKS * second + LINK_PARENT] = inner_slot(i);
  hierarchy_range[2u * i] = s.first;
  hierarchy_range[2u * i + 1u] = s.last;
}

/* Writes the boxes of leaf i and of inner node i, unless the node lies in one tile and that is unchanged. */
SHARED void node_boxes_item(GLOBAL const float4 *box_pyramid, GLOBAL const uint *hierarchy_range,
                            GLOBAL const uint *tile_changed, GLOBAL const uint *counts, GLOBAL float4 *hierarchy,
                            uint i)
{
  uint leaves = counts[COUNT_LEAVES];
  if (tile_changed[i / TILE] != 0u)
    store_numbered_box(hierarchy, leaf_slot(i), load_numbered_box(box_pyramid, leaves + i));
  if (i + 1u >= counts[COUNT_HIERARCHY]) return;
  uint first = hierarchy_range[2u * i], last = hierarchy_range[2u * i + 1u];
  if (first / TILE == last / TILE && tile_changed[first / TILE] == 0u) return;
  store_numbered_box(hierarchy, inner_slot(i), box_of_range(box_pyramid, leaves, first, last));
}

#endif
