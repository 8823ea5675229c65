/* hierarchy.h - a tree of boxes over all bodies of finite size, along a space-filling curve: the linear BVH.
 *
 * After the GPU tree of the 2009 talk, and Lauterbach and others, "Fast BVH construction on GPUs", 2009. Bodies are sorted by the
 * Morton code of their centres; a tree stands over the sorted list as a heap does over an array, so that no links are stored:
 *
 *                1                  node n: children 2 n and 2 n + 1, parent n / 2
 *           2         3             leaf i of the sorted list: node leaves + i
 *         4   5     6   7           behind the last body: empty boxes, which overlap nothing
 *        8 9 10 11 12 . . .
 *                                   The node after the subtree of n: n + 1, once n has been halved while it was odd: the
 *      bodies 9 2 0 4 7             skip index is arithmetic, and depth never exceeds the bits of the number of bodies.
 *
 * A node also knows the lowest number of a body below it: a body looks for those before it alone, and passes over the rest. Half-spaces,
 * which have no bounds to speak of, come first of all bodies and are tested against everything.
 */
#ifndef TANDEM_SHARED_BROADPHASE_HIERARCHY_H
#define TANDEM_SHARED_BROADPHASE_HIERARCHY_H

#include "shared/broadphase/extent.h"

/* The lowest body below a node, as a number that a real holds: exact to 2^24, rounded down from there on. */
SHARED real lowest_as_real(uint body) { return to_real(body < 16777216u ? body : body & 0xffffff00u); }

typedef struct {
  box_bounds box;
  real lowest;
} hierarchy_node;

SHARED hierarchy_node load_node(GLOBAL const row *nodes, uint node)
{
  vec4 lower = load_row(nodes, 2u * node);
  hierarchy_node n = {{xyz(lower), xyz(load_row(nodes, 2u * node + 1u))}, lower.w};
  return n;
}
SHARED void store_node(GLOBAL row *nodes, uint node, hierarchy_node n)
{
  store_row(nodes, 2u * node, extend(n.box.lower, n.lowest));
  store_row(nodes, 2u * node + 1u, extend(n.box.upper, R(0.0)));
}

SHARED hierarchy_node join_nodes(hierarchy_node a, hierarchy_node b)
{
  hierarchy_node n = {{lower_of(a.box.lower, b.box.lower), upper_of(a.box.upper, b.box.upper)}, minimum(a.lowest, b.lowest)};
  return n;
}

/* --- building ----------------------------------------------------------------------------------------- */

/* Spreads ten bits to every third. */
SHARED uint spread_bits(uint x)
{
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}
SHARED uint curve_cell(real offset, real scale)
{
  int cell = floor_to_int(offset * scale);
  return cell < 0 ? 0u : cell < CURVE_CELLS ? (uint)cell : (uint)CURVE_CELLS - 1u;
}

/* The frame is that of the small bodies; large ones beside it stand on its border. */
SHARED uint curve_key(GLOBAL const row *grid, box_bounds box)
{
  vec4 frame = load_row(grid, 1u);
  vec3 offset = subtract(scale(add(box.lower, box.upper), R(0.5)), xyz(frame));
  return spread_bits(curve_cell(offset.x, frame.w)) << 2 | spread_bits(curve_cell(offset.y, frame.w)) << 1 | spread_bits(curve_cell(offset.z, frame.w));
}

/* Body i of finite size. */
SHARED void curve_keys_item(GLOBAL const row *bounds, GLOBAL const row *grid, GLOBAL const uint *counts, GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint i)
{
  uint body = counts[COUNT_BOUNDLESS] + i;
  sort_key[i] = curve_key(grid, load_bounds(bounds, body));
  sort_value[i] = body;
}

/* body: INDEX_NONE for an empty leaf. */
SHARED void store_leaf(GLOBAL const row *bounds, GLOBAL const uint *counts, GLOBAL row *hierarchy, uint i, uint body)
{
  hierarchy_node leaf = {{make_vec3(BOUNDLESS, BOUNDLESS, BOUNDLESS), make_vec3(-BOUNDLESS, -BOUNDLESS, -BOUNDLESS)}, BOUNDLESS};
  if (body != INDEX_NONE) {
    box_bounds box = load_bounds(bounds, body);
    if (bounds_overlap(box, box)) leaf.box = box; /* NaN overlaps nothing, and would spoil the boxes above it */
    leaf.lowest = lowest_as_real(body);
  }
  store_node(hierarchy, counts[COUNT_LEAVES] + i, leaf);
}

SHARED void hierarchy_leaves_item(GLOBAL const row *bounds, GLOBAL const uint *sort_value, GLOBAL const uint *counts, GLOBAL row *hierarchy,
                                  GLOBAL uint *leaf_body, uint i)
{
  mask is_body = i < counts[COUNT_BOUNDED];
  store_leaf(bounds, counts, hierarchy, i, is_body ? sort_value[i] : INDEX_NONE);
  if (is_body) leaf_body[i] = sort_value[i];
}

/* The ten levels above one whose nodes are 2^height leaves each; a group joins TILE nodes of that level. */
SHARED void hierarchy_levels_group(GLOBAL const uint *counts, GLOBAL row *hierarchy, uint height, LOCAL uint *local_memory, uint group)
{
  (void)local_memory;
  uint level = counts[COUNT_LEAVES] >> height, first = group * TILE;
  uint width = first >= level ? 0u : level < TILE ? level / 2u : TILE / 2u;
  for (; width > 0u; width /= 2u) {
    level = level / 2u;
    first = first / 2u;
    FOR_EACH_ITEM(item, width)
    {
      uint node = level + first + item;
      store_node(hierarchy, node, join_nodes(load_node(hierarchy, 2u * node), load_node(hierarchy, 2u * node + 1u)));
    }
  }
}

#endif
