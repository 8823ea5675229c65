/* grid_walk.h - the bodies along a path, layer by layer, from the uniform grid of broadphase/grid.h.
 *
 *       |   |   |###|###|  |       Layers are perpendicular to the axis along which the path is longest. A body of
 *       |   |   |#_-|###|  |       layer L has its centre there, and its box, no larger than a cell, may reach half a
 *       |   |###|###|   |  |       cell beyond. The path can therefore touch it only between layers L-1 and L+1. In
 *       |   |#_-|###|   |  |       that part, the path's extent along the other two axes, widened by the moving box and
 *       o -     L            - ->  by half a body, covers a rectangle of cells. Each of its rows along x is one range
 *                                  of the sorted list. Every cell is in one layer, so every body comes once.
 *
 * A point of the path is converted to a cell with the same rounding as a body's centre. The order of points is then the
 * order of their cells, also in border cells, which hold the bodies that rounding moved across the border. The half
 * cell that is left between a body's box and the next layer is a margin for rounding along the path.
 */
#ifndef TANDEM_SHARED_QUERIES_GRID_WALK_H
#define TANDEM_SHARED_QUERIES_GRID_WALK_H

#include "shared/broadphase/grid.h"
#include "shared/queries/straight_path.h"

typedef struct {
  GLOBAL const float4 *bounds, *grid; /* of compute_query_bounds, and cells of that size */
  GLOBAL const uint *sort_value, *cell_start, *counts;
} body_cells;

/* The position of the traversal, in words of an array of the caller. The array may be that of the hierarchy's
 * traversal, so that a kernel with both needs memory for one. Layers and rows are those that remain; AT to END are the
 * bodies of the current row. */
enum {
  GRID_LAYER,
  GRID_LAYERS_LEFT,
  GRID_X,
  GRID_X_LAST,
  GRID_Y_FIRST,
  GRID_Y,
  GRID_Y_LAST,
  GRID_Z,
  GRID_Z_LAST,
  GRID_AT,
  GRID_END,
  GRID_WORDS
};

SHARED real along_axis(vec3 v, uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }

/* The axis along which the path is longest. */
SHARED uint axis_of_layers(const straight_path *path)
{
  vec3 inverse = absolute(path->inverse);
  if (inverse.x <= inverse.y && inverse.x <= inverse.z) return 0u;
  return inverse.y <= inverse.z ? 1u : 2u;
}

typedef struct {
  uint first, last;
} cell_range;

/* The cells along an axis whose bodies the path may touch in a part of it. */
SHARED cell_range cells_touched(const body_cells *cells, const straight_path *path, uint axis, path_part part)
{
  vec4 layout = load_float4(cells->grid, 0u);
  real speed = R(1.0) / along_axis(path->inverse, axis), from = part.enter * speed, to = part.leave * speed;
  real low = along_axis(path->start_high, axis), high = along_axis(path->start_low, axis),
       origin = along_axis(xyz(layout), axis);
  real half_body = R(0.5001) / layout.w;
  real spare = half_body + R(4e-6) * (magnitude(low) + magnitude(high) + maximum(magnitude(from), magnitude(to)));
  real least = minimum(from, to) + (low - spare), most = maximum(from, to) + (high + spare);
  uint count = cells->counts[(uint)COUNT_GRID_X + axis];
  cell_range range = {(uint)cell_along(least - origin, layout.w, count), count - 1u};
  if (most - origin < UNBOUNDED)
    range.last = (uint)cell_along(most - origin, layout.w, count); /* NaN is never converted */
  return range;
}

/* The part of the path between two heights in cells along an axis, widened by the rounding of either. */
SHARED path_part part_in_layers(const body_cells *cells, const straight_path *path, uint axis, real bottom, real top,
                                real reach)
{
  vec4 layout = load_float4(cells->grid, 0u);
  real cell = R(1.0) / layout.w, origin = along_axis(xyz(layout), axis), inverse = along_axis(path->inverse, axis);
  real spare = R(1e-6) * (magnitude(origin) + top * cell);
  real one = (origin + bottom * cell - spare - along_axis(path->start_low, axis)) * inverse;
  real other = (origin + top * cell + spare - along_axis(path->start_high, axis)) * inverse;
  path_part part = {maximum(minimum(one, other), R(0.0)), minimum(maximum(one, other), reach)};
  part.leave = part.leave + R(2e-6) * magnitude(part.leave); /* as far as the test of a box may overlook */
  return part;
}

/* The part of the path through the cells and one cell around them. */
SHARED path_part part_in_grid(const body_cells *cells, const straight_path *path)
{
  path_part whole = {R(0.0), ENDLESS};
  for (uint axis = 0u; axis < 3u; ++axis) {
    path_part part =
        part_in_layers(cells, path, axis, R(-1.0), (real)cells->counts[(uint)COUNT_GRID_X + axis] + R(1.0), ENDLESS);
    whole.enter = maximum(whole.enter, part.enter);
    whole.leave = minimum(whole.leave, part.leave);
  }
  return whole;
}

SHARED void start_grid_walk(const body_cells *cells, const straight_path *path, uint *place)
{
  for (uint k = 0u; k < (uint)GRID_WORDS; ++k) place[k] = 0u;
  place[GRID_Z] = 1u; /* behind the last row */
  path_part part = part_in_grid(cells, path);
  if (!(part.enter <= part.leave)) return;
  uint axis = axis_of_layers(path);
  cell_range layers = cells_touched(cells, path, axis, part);
  place[GRID_LAYER] = along_axis(path->inverse, axis) > R(0.0) ? layers.first : layers.last;
  place[GRID_LAYERS_LEFT] = layers.last - layers.first + 1u;
}

/* Opens the rows of a layer that the path touches in a part of it. */
SHARED void open_layer(const body_cells *cells, const straight_path *path, uint *place, uint axis, uint layer,
                       path_part part)
{
  for (uint k = 0u; k < 3u; ++k) {
    cell_range range = {layer, layer};
    if (k != axis) range = cells_touched(cells, path, k, part);
    uint first = k == 0u ? (uint)GRID_X : k == 1u ? (uint)GRID_Y : (uint)GRID_Z;
    uint last = k == 0u ? (uint)GRID_X_LAST : k == 1u ? (uint)GRID_Y_LAST : (uint)GRID_Z_LAST;
    place[first] = range.first;
    place[last] = range.last;
  }
  place[GRID_Y_FIRST] = place[GRID_Y];
}

/* False if no layer is left before `reach`; later layers are farther away still. */
SHARED mask next_layer(const body_cells *cells, const straight_path *path, uint *place, real reach)
{
  uint axis = axis_of_layers(path);
  mask upward = along_axis(path->inverse, axis) > R(0.0);
  while (place[GRID_LAYERS_LEFT] > 0u) {
    uint layer = place[GRID_LAYER];
    path_part part = part_in_layers(cells, path, axis, (real)layer - R(1.0), (real)layer + R(2.0), reach);
    place[GRID_LAYER] = upward ? layer + 1u : layer - 1u;
    place[GRID_LAYERS_LEFT] = place[GRID_LAYERS_LEFT] - 1u;
    if (part.enter > reach + R(2e-6) * reach) place[GRID_LAYERS_LEFT] = 0u;
    if (!(part.enter <= part.leave)) continue;
    open_layer(cells, path, place, axis, layer, part);
    return 1;
  }
  return 0;
}

SHARED mask next_row(const body_cells *cells, uint *place)
{
  if (place[GRID_Z] > place[GRID_Z_LAST]) return 0;
  int y = (int)place[GRID_Y], z = (int)place[GRID_Z];
  place[GRID_AT] = cells->cell_start[cell_number(cells->counts, (int)place[GRID_X], y, z)];
  place[GRID_END] = cells->cell_start[cell_number(cells->counts, (int)place[GRID_X_LAST], y, z) + 1u];
  place[GRID_Y] = place[GRID_Y] + 1u;
  if (place[GRID_Y] <= place[GRID_Y_LAST]) return 1;
  place[GRID_Y] = place[GRID_Y_FIRST];
  place[GRID_Z] = place[GRID_Z] + 1u;
  return 1;
}

/* The next body whose box the path enters before `reach`; INDEX_NONE after the last. */
SHARED uint next_in_grid(const body_cells *cells, const straight_path *path, uint *place, real reach)
{
  do {
    while (place[GRID_AT] < place[GRID_END]) {
      uint body = cells->sort_value[place[GRID_AT]];
      place[GRID_AT] = place[GRID_AT] + 1u;
      if (fraction_into_box(path, load_bounds(cells->bounds, body), reach) < ENDLESS) return body;
    }
  } while (next_row(cells, place) || next_layer(cells, path, place, reach));
  return INDEX_NONE;
}

#endif
