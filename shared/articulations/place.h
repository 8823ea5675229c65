/* place.h - where the rows of a tree stand in memory, and numbers that trees of one shape share.
 *
 * Trees of one shape that follow each other lie beside each other (host/scene/tree_places.h), so a row of eight of them
 * is one piece of memory, and the number of a link, or of its parent, is the same for all. On a CPU, lanes of such
 * trees compute an address once, not for each lane (minicl/lanes_of_trees.h). Here, for one item, a number is a number.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_PLACE_H
#define TANDEM_SHARED_ARTICULATIONS_PLACE_H

#include "shared/articulations/joint_types.h"
#include "shared/math.h"

#ifndef TANDEM_LANES
typedef uint shape_uint; /* depends on the shape of a tree alone, as the number of a link does */
typedef uint row_number; /* of a row in a table, of each lane */

/* The item-th of the trees that lie beside each other. */
typedef struct {
  uint_lanes item, stride; /* stride: TREES_BESIDE, or 1 of a tree that lies alone */
} tree_place;

SHARED tree_place place_beside(uint_lanes block, uint_lanes item, uint_lanes stride)
{
  (void)block;
  tree_place p = {item, stride};
  return p;
}
/* each: depends on the shape alone. */
SHARED shape_uint of_shape(const tree_place *p, uint_lanes each)
{
  (void)p;
  return each;
}
/* The last of so many links; of a tree without links, 0. most: of any lane. */
SHARED shape_uint last_link_of(const tree_place *p, uint_lanes links, uint most)
{
  (void)p;
  (void)most;
  return links > 0u ? links - 1u : 0u;
}
/* k, or 0 of a tree that has no such link. */
SHARED shape_uint link_or_root(const tree_place *p, mask exists, shape_uint k)
{
  (void)p;
  return exists ? k : 0u;
}
SHARED shape_uint zero_if_equal(shape_uint x, uint none) { return x == none ? 0u : x; }
/* The bits that any lane has. */
SHARED uint bits_of_any(uint_lanes bits) { return bits; }

/* Row `row` of link k, of the trees whose rows begin at `block`; each has rows_of_block of what `block` counts, and
 * rows_of_link a link. */
SHARED row_number row_in(const tree_place *p, shape_uint block, uint rows_of_block, shape_uint k,
                         shape_uint rows_of_link, shape_uint row)
{
  return block * rows_of_block + p->item + (k * rows_of_link + row) * p->stride;
}
SHARED row_number row_beyond(const tree_place *p, row_number at) { return at + p->stride; }
/* What is not wanted is read where there is something. */
SHARED row_number wanted_row(mask wanted, row_number at) { return wanted ? at : 0u; }

SHARED vec4 load_row(GLOBAL const float4 *from, row_number at) { return load_float4(from, at); }
SHARED void store_row_if(mask m, GLOBAL float4 *to, row_number at, vec4 value) { store_float4_if(m, to, at, value); }
SHARED real load_real_of_row(GLOBAL const memory_real *from, row_number at) { return from[at]; }
SHARED void store_real_of_row_if(mask m, GLOBAL memory_real *to, row_number at, real value)
{
  if (m) to[at] = value;
}
SHARED uint_lanes load_uint_of_row(GLOBAL const uint *from, row_number at) { return from[at]; }
SHARED void store_uint_of_row_if(mask m, GLOBAL uint *to, row_number at, uint_lanes value)
{
  if (m) to[at] = value;
}
/* Of a table of what depends on the shape alone. */
SHARED shape_uint load_of_shape(GLOBAL const uint *from, row_number at) { return from[at]; }
#endif

#endif
