/* extent.h - the extent of all bodies: the region of the uniform grid, the frame of the space-filling curve and the
 * axis of the sweep.
 *
 * Each tile reduces by a tree the bounds of the centres, the largest size, and the sums for the variance; then one
 * group reduces the tiles. The trees are fixed, so the sums have the same bits everywhere. Large bodies are left out,
 * because they are tested against all others instead.
 */
#ifndef TANDEM_SHARED_BROADPHASE_EXTENT_H
#define TANDEM_SHARED_BROADPHASE_EXTENT_H

#include "shared/broadphase/curve_limits.h"
#include "shared/broadphase/overlap.h"
#include "shared/conversion.h"

#define EXTENT_VALUES 16u /* lower xyz, upper xyz, sum xyz, sum of squares xyz, sum of products yz zx xy, size */
#define EXTENT_WIDTH 256u /* virtual items of a group; each keeps EXTENT_VALUES words of local memory */
#define EXTENT_ROWS 4u    /* rows of bounds_sums a tile */

/* The extent of the centres. products: y z, z x, x y. size: the longest side of any box. */
typedef struct {
  vec3 lower, upper, sum, squares, products;
  real size;
} extent;

SHARED extent empty_extent(void)
{
  extent e = {{UNBOUNDED, UNBOUNDED, UNBOUNDED}, {-UNBOUNDED, -UNBOUNDED, -UNBOUNDED},
              {R(0.0), R(0.0), R(0.0)},          {R(0.0), R(0.0), R(0.0)},
              {R(0.0), R(0.0), R(0.0)},          R(0.0)};
  return e;
}
SHARED vec3 lower_of(vec3 a, vec3 b) { return make_vec3(minimum(a.x, b.x), minimum(a.y, b.y), minimum(a.z, b.z)); }
SHARED vec3 upper_of(vec3 a, vec3 b) { return make_vec3(maximum(a.x, b.x), maximum(a.y, b.y), maximum(a.z, b.z)); }
SHARED extent join_extents(extent a, extent b)
{
  extent e = {lower_of(a.lower, b.lower), upper_of(a.upper, b.upper),  add(a.sum, b.sum),
              add(a.squares, b.squares),  add(a.products, b.products), maximum(a.size, b.size)};
  return e;
}
SHARED extent extent_of_body(box_bounds b)
{
  vec3 size = subtract(b.upper, b.lower);
  vec3 center = scale(add(b.lower, b.upper), R(0.5));
  vec3 products = make_vec3(center.y * center.z, center.z * center.x, center.x * center.y);
  extent e = {center, center, center, multiply(center, center), products, maximum(size.x, maximum(size.y, size.z))};
  return e;
}

SHARED void store_vec3_local(LOCAL real *to, uint plane, uint item, vec3 v)
{
  to[plane * EXTENT_WIDTH + item] = v.x;
  to[(plane + 1u) * EXTENT_WIDTH + item] = v.y;
  to[(plane + 2u) * EXTENT_WIDTH + item] = v.z;
}
SHARED vec3 load_vec3_local(LOCAL const real *from, uint plane, uint item)
{
  return make_vec3(from[plane * EXTENT_WIDTH + item], from[(plane + 1u) * EXTENT_WIDTH + item],
                   from[(plane + 2u) * EXTENT_WIDTH + item]);
}
SHARED void store_extent_local(LOCAL real *to, uint item, extent e)
{
  store_vec3_local(to, 0u, item, e.lower);
  store_vec3_local(to, 3u, item, e.upper);
  store_vec3_local(to, 6u, item, e.sum);
  store_vec3_local(to, 9u, item, e.squares);
  store_vec3_local(to, 12u, item, e.products);
  to[15u * EXTENT_WIDTH + item] = e.size;
}
SHARED extent load_extent_local(LOCAL const real *from, uint item)
{
  extent e = {load_vec3_local(from, 0u, item), load_vec3_local(from, 3u, item),  load_vec3_local(from, 6u, item),
              load_vec3_local(from, 9u, item), load_vec3_local(from, 12u, item), from[15u * EXTENT_WIDTH + item]};
  return e;
}

/* Joins EXTENT_WIDTH extents in local memory into the first. */
SHARED void join_tree(LOCAL real *extents)
{
  for (uint reach = EXTENT_WIDTH / 2u; reach > 0u; reach /= 2u) FOR_EACH_ITEM(item, reach)
  store_extent_local(extents, item,
                     join_extents(load_extent_local(extents, item), load_extent_local(extents, item + reach)));
}

SHARED void store_extent_tile(GLOBAL float4 *bounds_sums, uint tile, extent e)
{
  store_float4(bounds_sums, tile * EXTENT_ROWS, extend(e.lower, e.size));
  store_float4(bounds_sums, tile * EXTENT_ROWS + 1u, extend(e.upper, e.products.x));
  store_float4(bounds_sums, tile * EXTENT_ROWS + 2u, extend(e.sum, e.products.y));
  store_float4(bounds_sums, tile * EXTENT_ROWS + 3u, extend(e.squares, e.products.z));
}
SHARED extent load_extent_tile(GLOBAL const float4 *bounds_sums, uint tile)
{
  vec4 lower = load_float4(bounds_sums, tile * EXTENT_ROWS), upper = load_float4(bounds_sums, tile * EXTENT_ROWS + 1u);
  vec4 sum = load_float4(bounds_sums, tile * EXTENT_ROWS + 2u),
       squares = load_float4(bounds_sums, tile * EXTENT_ROWS + 3u);
  extent e = {xyz(lower), xyz(upper), xyz(sum), xyz(squares), make_vec3(upper.w, sum.w, squares.w), lower.w};
  return e;
}

/* One group reduces TILE small bodies to EXTENT_ROWS rows of bounds_sums. */
SHARED void extent_tiles_group(GLOBAL const float4 *bounds, GLOBAL const uint *counts, GLOBAL float4 *bounds_sums,
                               LOCAL uint *local_memory, uint group)
{
  LOCAL real *extents = (LOCAL real *)local_memory;
  uint small = counts[COUNT_SMALL], large = counts[COUNT_LARGE];
  FOR_EACH_ITEM(item, EXTENT_WIDTH)
  {
    extent e = empty_extent();
    for (uint k = 0; k < TILE / EXTENT_WIDTH; ++k) {
      uint body = group * TILE + k * EXTENT_WIDTH + item;
      if (body < small) e = join_extents(e, extent_of_body(load_bounds(bounds, large + body)));
    }
    store_extent_local(extents, item, e);
  }
  join_tree(extents);
  /* The condition is needed because a device launches a group even if there is no tile. */
  FOR_EACH_ITEM(first, group * TILE < small ? 1u : 0u)
  store_extent_tile(bounds_sums, group, load_extent_local(extents, first));
}

/* The number of cells along one axis, at least 1; floor_to_int saturates at 2^30. */
SHARED uint cells_along(real length, real cell)
{
  int cells = floor_to_int(length / cell) + 1;
  return cells < 1 ? 1u : (uint)cells;
}

/* The grid with the smallest cells, none below `size`, that fits the table: cells grow by a quarter until it does. If
 * none fits, because a body is not finite, one cell holds all. */
SHARED void write_grid_layout(extent whole, real size, GLOBAL float4 *grid, GLOBAL uint *counts)
{
  vec3 length = subtract(whole.upper, whole.lower);
  real cell = maximum(size, R(1e-6));
  uint nx = 1u, ny = 1u, nz = 1u, fits = 0u;
  for (int tries = 0; tries < 400 && !fits; ++tries) {
    nx = cells_along(length.x, cell);
    ny = cells_along(length.y, cell);
    nz = cells_along(length.z, cell);
    fits = (real)nx * (real)ny * (real)nz <= (real)counts[CAPACITY_CELLS] ? 1u : 0u;
    if (!fits) cell = cell * R(1.25);
  }
  if (!fits) nx = ny = nz = 1u;
  store_float4(grid, 0u, extend(whole.lower, R(1.0) / cell));
  counts[COUNT_GRID_X] = nx;
  counts[COUNT_GRID_Y] = ny;
  counts[COUNT_GRID_Z] = nz;
  counts[COUNT_CELLS] = nx * ny * nz;
  counts[COUNT_CELLS_PLUS_ONE] = nx * ny * nz + 1u;
}

/* The curve fills a cube around the centres, with CURVE_CELLS along a side. */
SHARED void write_curve_layout(extent whole, GLOBAL float4 *grid)
{
  vec3 length = subtract(whole.upper, whole.lower);
  real side = maximum(maximum(length.x, length.y), maximum(length.z, R(1e-6)));
  store_float4(grid, 1u, extend(whole.lower, (real)CURVE_CELLS / side));
}

typedef struct {
  vec3 squares, products;
} covariance; /* products: y z, z x, x y */

SHARED covariance covariance_of(extent whole, real bodies)
{
  vec3 mean = scale(whole.sum, R(1.0) / bodies);
  vec3 products = make_vec3(mean.y * mean.z, mean.z * mean.x, mean.x * mean.y);
  covariance c = {subtract(scale(whole.squares, R(1.0) / bodies), multiply(mean, mean)),
                  subtract(scale(whole.products, R(1.0) / bodies), products)};
  return c;
}

/* The axis along which the centres spread most (GS-4150 slide 21). */
SHARED uint widest_axis(covariance c)
{
  if (c.squares.x >= c.squares.y && c.squares.x >= c.squares.z) return 0u;
  return c.squares.y >= c.squares.z ? 1u : 2u;
}

/* The direction along which the centres spread most: the first principal component, by power iteration. A wrong
 * direction only costs time. */
SHARED vec3 principal_direction(covariance c)
{
  vec3 d = make_vec3(R(1.0), R(0.75), R(0.5)); /* perpendicular to none of the axes */
  for (int k = 0; k < 32; ++k) {
    vec3 next = make_vec3(c.squares.x * d.x + c.products.z * d.y + c.products.y * d.z,
                          c.products.z * d.x + c.squares.y * d.y + c.products.x * d.z,
                          c.products.y * d.x + c.products.x * d.y + c.squares.z * d.z);
    real most = maximum(magnitude(next.x), maximum(magnitude(next.y), magnitude(next.z)));
    if (!(most > R(0.0) && most < UNBOUNDED)) break;
    d = scale(next, R(1.0) / most);
  }
  return scale(d, R(1.0) / length_of(d));
}

/* One group reduces all tiles; the whole extent replaces that of the first tile. */
SHARED void extent_whole_group(GLOBAL const uint *counts, GLOBAL float4 *bounds_sums, LOCAL uint *local_memory,
                               uint group)
{
  (void)group;
  LOCAL real *extents = (LOCAL real *)local_memory;
  uint tiles = (counts[COUNT_SMALL] + TILE - 1u) / TILE;
  FOR_EACH_ITEM(item, EXTENT_WIDTH)
  {
    extent e = empty_extent();
    for (uint tile = item; tile < tiles; tile += EXTENT_WIDTH) e = join_extents(e, load_extent_tile(bounds_sums, tile));
    store_extent_local(extents, item, e);
  }
  join_tree(extents);
  FOR_EACH_ITEM(first, 1u) store_extent_tile(bounds_sums, first, load_extent_local(extents, first));
}

SHARED covariance spread_of(extent whole, GLOBAL const uint *counts)
{
  uint bodies = counts[COUNT_SMALL];
  return covariance_of(whole, (real)(bodies > 0u ? bodies : 1u));
}

/* One item computes the principal direction, for the sweep along it. */
SHARED void find_principal_direction_item(GLOBAL const float4 *bounds_sums, GLOBAL const uint *counts,
                                          GLOBAL float4 *grid, uint i)
{
  store_float4(grid, 2u, extend(principal_direction(spread_of(load_extent_tile(bounds_sums, i), counts)), R(0.0)));
}

/* One item computes the layout of the grid, the frame of the curve and the axis of the sweep. */
SHARED void compute_grid_layout_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *bounds_sums,
                                     GLOBAL float4 *grid, GLOBAL uint *counts, uint hybrid, uint i)
{
  extent whole = load_extent_tile(bounds_sums, i);
  if (counts[COUNT_SMALL] == 0u)
    whole.lower = whole.upper = make_vec3(R(0.0), R(0.0), R(0.0)); /* all bodies are large, so there is no extent */
  write_grid_layout(whole, hybrid != 0u ? parameters->hybrid_cell : whole.size, grid, counts);
  write_curve_layout(whole, grid);
  counts[COUNT_SWEEP_AXIS] = widest_axis(spread_of(whole, counts));
}

#endif
