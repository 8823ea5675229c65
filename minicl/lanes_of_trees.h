/* lanes_of_trees.h - the names of shared/articulations/place.h for several items an instruction.
 *
 *                       lane   0   1   2   ..
 *   trees of one shape,  row   r  r+1 r+2  ..    one address, one load; codes and numbers of links are single ones
 *   beside each other
 *   any other trees      row   r   s   t   ..    an address a lane, one load each
 *
 * Where the trees of all lanes are of the first kind, `is_shared` and `in_order` say so. Vectors of numbers and of
 * addresses, and the transposes of rows that are not neighbours, took a third of the time of trees.
 */
#pragma once

#include "shared/articulations/joint_types.h"

struct shape_uint {
  uint32_t of_all; /* if it is shared */
  uint_lanes of_each;
  bool is_shared;
  shape_uint() = default;
  shape_uint(uint32_t x) : of_all(x), of_each(x), is_shared(true) {}
  shape_uint(uint_lanes x) : of_all(0), of_each(x), is_shared(false) {}
  shape_uint(uint32_t all, uint_lanes each, bool shared) : of_all(all), of_each(each), is_shared(shared) {}
  operator uint_lanes() const { return of_each; }

  /* Friends, which no other number finds. */
  friend inline __attribute__((always_inline)) shape_uint operator>>(shape_uint x, uint32_t y)
  {
    return {x.of_all >> y, x.of_each >> uint_lanes(y), x.is_shared};
  }
  friend inline __attribute__((always_inline)) shape_uint operator&(shape_uint x, uint32_t y)
  {
    return {x.of_all & y, x.of_each & uint_lanes(y), x.is_shared};
  }
  friend inline __attribute__((always_inline)) shape_uint operator+(shape_uint x, uint32_t y)
  {
    return {x.of_all + y, x.of_each + uint_lanes(y), x.is_shared};
  }
  friend inline __attribute__((always_inline)) shape_uint operator*(shape_uint x, uint32_t y)
  {
    return {x.of_all * y, x.of_each * uint_lanes(y), x.is_shared};
  }
};
SHARED shape_uint zero_if_equal(shape_uint x, uint32_t none)
{
  x.of_all = x.of_all == none ? 0 : x.of_all;
  x.of_each = choose(x.of_each == uint_lanes(none), uint_lanes(0u), x.of_each);
  return x;
}

SHARED uint bits_of_any(uint_lanes bits)
{
  uint any = 0;
  for (int lane = 0; lane < width; ++lane) any |= bits.v[lane];
  return any;
}

struct tree_place {
  uint_lanes item, stride;
  uint32_t first;    /* the item of lane 0 */
  bool are_together; /* trees of one shape, each beside the one of the lane before */
};
SHARED tree_place place_beside(uint_lanes block, uint_lanes item, uint_lanes stride)
{
  const item_index beside{item.v[0]};
  const mask same = (block == uint_lanes(block.v[0])) & (stride == uint_lanes(stride.v[0]));
  return {item, stride, item.v[0], stride.v[0] == TREES_BESIDE && all_of(same & (item == uint_lanes(beside)))};
}
SHARED shape_uint of_shape(const tree_place *p, uint_lanes each)
{
  return p->are_together ? shape_uint(each.v[0]) : shape_uint(each);
}
SHARED shape_uint last_link_of(const tree_place *p, uint_lanes links, uint32_t most)
{
  if (p->are_together) return shape_uint(most > 0 ? most - 1 : 0u);
  return shape_uint(choose(links > uint_lanes(0u), links - uint_lanes(1u), uint_lanes(0u)));
}
SHARED shape_uint link_or_root(const tree_place *p, mask exists, shape_uint k)
{
  if (p->are_together && k.is_shared) return k;
  return shape_uint(choose(exists, k.of_each, uint_lanes(0u)));
}

struct row_number {
  uint32_t first; /* of lane 0, if those of all lanes are in order */
  uint_lanes each;
  bool in_order;
};
SHARED row_number row_in(const tree_place *p, shape_uint block, uint32_t rows_of_block, shape_uint k,
                         shape_uint rows_of_link, shape_uint row)
{
  row_number at;
  at.in_order = p->are_together && block.is_shared && k.is_shared && rows_of_link.is_shared && row.is_shared;
  if (__builtin_expect(at.in_order, 1)) {
    const uint32_t within = (k.of_all * rows_of_link.of_all + row.of_all) * TREES_BESIDE;
    at.first = block.of_all * rows_of_block + p->first + within;
  } else {
    at.each = block.of_each * uint_lanes(rows_of_block) + p->item +
              (k.of_each * rows_of_link.of_each + row.of_each) * p->stride;
  }
  return at;
}
SHARED row_number row_beyond(const tree_place *p, row_number at)
{
  if (__builtin_expect(at.in_order, 1)) at.first += TREES_BESIDE;
  else at.each = at.each + p->stride;
  return at;
}
SHARED row_number wanted_row(mask wanted, row_number at)
{
  if (__builtin_expect(at.in_order, 1)) at.first = any_of(wanted) ? at.first : 0;
  else at.each = choose(wanted, at.each, uint_lanes(0u));
  return at;
}
/* The number of each lane, of rows in order. */
SHARED uint_lanes each_of(row_number at) { return uint_lanes(item_index{at.first}); }

SHARED vec4 load_row(const float4 *from, row_number at)
{
  return __builtin_expect(at.in_order, 1) ? load_float4(from, item_index{at.first}) : load_float4(from, at.each);
}
SHARED void store_row_if(mask m, float4 *to, row_number at, vec4 value)
{
  if (__builtin_expect(at.in_order, 1) && all_of(m)) store_float4(to, item_index{at.first}, value);
  else store_float4_if(m, to, at.in_order ? each_of(at) : at.each, value);
}
SHARED real load_real_of_row(const memory_real *from, row_number at)
{
  return at.in_order ? load_real(from, item_index{at.first}) : load_real(from, at.each);
}
SHARED void store_real_of_row_if(mask m, memory_real *to, row_number at, real value)
{
  if (at.in_order && all_of(m)) store_real(to, item_index{at.first}, value);
  else store_listed_real_if(m, to, at.in_order ? each_of(at) : at.each, value);
}
SHARED uint_lanes load_uint_of_row(const uint *from, row_number at)
{
  return at.in_order ? load_uint(from, item_index{at.first}) : load_uint(from, at.each);
}
SHARED void store_uint_of_row_if(mask m, uint *to, row_number at, uint_lanes value)
{
  store_uint_if(m, to, at.in_order ? each_of(at) : at.each, value);
}
SHARED shape_uint load_of_shape(const uint *from, row_number at)
{
  return __builtin_expect(at.in_order, 1) ? shape_uint(from[at.first]) : shape_uint(load_uint(from, at.each));
}
