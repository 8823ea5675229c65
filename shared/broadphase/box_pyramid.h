/* box_pyramid.h - the union of the boxes in any range of a list, in at most twice as many loads as the
 * range's length has bits.
 *
 *                1                 The pyramid is a heap over the list: node n joins nodes 2 n and 2 n + 1, and place i
 *           2         3            of the list is node leaves + i. Empty boxes, which overlap nothing, fill the rest of
 *         4   5     6   7          the last level.
 *        8 9 10 11 12 . . .        Example: places 1 to 4 are the nodes 9, 5 and 12.
 *
 * A tree over the list (hierarchy.h) takes the boxes of all its nodes from here at once. No node waits for those below
 * it; joining boxes from the leaves up needs flags and fences, which OpenCL 1.2 does not promise to work across
 * work-groups. Each box also stores the lowest index of a body in it.
 */
#ifndef TANDEM_SHARED_BROADPHASE_BOX_PYRAMID_H
#define TANDEM_SHARED_BROADPHASE_BOX_PYRAMID_H

#include "shared/broadphase/extent.h"

/* The lowest body in a box as a real: exact up to 2^24, rounded down above. */
SHARED real lowest_as_real(uint body) { return to_real(body < 16777216u ? body : body & 0xffffff00u); }

typedef struct {
  box_bounds box;
  real lowest;
} numbered_box;

SHARED numbered_box empty_box(void)
{
  numbered_box empty = {{make_vec3(UNBOUNDED, UNBOUNDED, UNBOUNDED), make_vec3(-UNBOUNDED, -UNBOUNDED, -UNBOUNDED)},
                        UNBOUNDED};
  return empty;
}
SHARED numbered_box load_numbered_box(GLOBAL const float4 *boxes, uint i)
{
  vec4 lower = load_float4(boxes, 2u * i);
  numbered_box b = {{xyz(lower), xyz(load_float4(boxes, 2u * i + 1u))}, lower.w};
  return b;
}
SHARED void store_numbered_box(GLOBAL float4 *boxes, uint i, numbered_box b)
{
  store_float4(boxes, 2u * i, extend(b.box.lower, b.lowest));
  store_float4(boxes, 2u * i + 1u, extend(b.box.upper, R(0.0)));
}
SHARED numbered_box join_boxes(numbered_box a, numbered_box b)
{
  numbered_box joined = {{lower_of(a.box.lower, b.box.lower), upper_of(a.box.upper, b.box.upper)},
                         minimum(a.lowest, b.lowest)};
  return joined;
}

SHARED void store_leaf(GLOBAL float4 *pyramid, uint node, box_bounds box, uint body)
{
  numbered_box leaf = empty_box();
  if (bounds_overlap(box, box)) leaf.box = box; /* NaN overlaps nothing, and would spoil the boxes above it */
  leaf.lowest = lowest_as_real(body);
  store_numbered_box(pyramid, node, leaf);
}

/* Writes all leaves, and marks the tiles of leaves that have changed for the kernels above. */
SHARED void pyramid_leaves_item(GLOBAL const float4 *boxes, GLOBAL const uint *leaf_body, GLOBAL const uint *counts,
                                GLOBAL float4 *pyramid, GLOBAL uint *tile_changed, uint i)
{
  uint node = counts[COUNT_LEAVES] + i;
  if (i % TILE == 0u) tile_changed[i / TILE] = 1u;
  if (i < counts[COUNT_HIERARCHY]) store_leaf(pyramid, node, load_bounds(boxes, leaf_body[i]), leaf_body[i]);
  else store_numbered_box(pyramid, node, empty_box());
}

/* Writes the ten levels above one whose nodes are 2^height leaves each. A group joins TILE nodes of that level; at the
 * leaves it does so only if they changed. */
SHARED void pyramid_levels_group(GLOBAL const uint *counts, GLOBAL const uint *tile_changed, GLOBAL float4 *pyramid,
                                 uint height, LOCAL uint *local_memory, uint group)
{
  (void)local_memory;
  uint level = counts[COUNT_LEAVES] >> height, first = group * TILE;
  uint width = first >= level ? 0u : level < TILE ? level / 2u : TILE / 2u;
  if (width > 0u && height == 0u && tile_changed[group] == 0u) width = 0u;
  for (; width > 0u; width /= 2u) {
    level = level / 2u;
    first = first / 2u;
    FOR_EACH_ITEM(item, width)
    {
      uint node = level + first + item;
      store_numbered_box(pyramid, node,
                         join_boxes(load_numbered_box(pyramid, 2u * node), load_numbered_box(pyramid, 2u * node + 1u)));
    }
  }
}

/* The union of the boxes at places first .. last. */
SHARED numbered_box box_of_range(GLOBAL const float4 *pyramid, uint leaves, uint first, uint last)
{
  numbered_box all = empty_box();
  uint left = leaves + first, right = leaves + last + 1u;
  for (; left < right; left = left >> 1, right = right >> 1) {
    if ((left & 1u) != 0u) all = join_boxes(all, load_numbered_box(pyramid, left++));
    if ((right & 1u) != 0u) all = join_boxes(all, load_numbered_box(pyramid, --right));
  }
  return all;
}

#endif
