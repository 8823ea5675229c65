/* body_walk.h - the bodies near a straight path, from the structure of the chosen broadphase.
 *
 *        half-spaces, which have no bounds    all of them, first
 *        QUERY_HIERARCHY                      ray_walk.h: near boxes first
 *        QUERY_GRID                           the large bodies one by one, then grid_walk.h: near layers first
 *        QUERY_EVERY_BODY                     one by one: the oracle
 *
 * Each structure yields the same bodies, those whose own box the path enters, and each of them once. Their order must
 * not change an answer. A launch uses one structure, so all its items take the same branch.
 */
#ifndef TANDEM_SHARED_QUERIES_BODY_WALK_H
#define TANDEM_SHARED_QUERIES_BODY_WALK_H

#include "shared/argument_groups.h"
#include "shared/queries/grid_walk.h"
#include "shared/queries/ray_walk.h"

/* The structures of a launch. Only the members of the chosen one are read. */
typedef struct {
  uint structure; /* QUERY_ */
  body_hierarchy hierarchy;
  body_cells cells;
} body_structure;

SHARED body_structure structure_of(read_search_structures s, uint structure)
{
  body_structure bodies = {
      structure, {s.node, s.link, s.leaf_body, s.counts}, {s.bounds, s.grid, s.sorted_body, s.cell_start, s.counts}};
  return bodies;
}

/* Bodies up to `listed` are visited one by one. The grid stores its position in the stack of the hierarchy's
 * traversal. */
typedef struct {
  uint next, listed;
  ray_walk rays;
} body_walk;

/* extent: half extents of a box that moves along the path; 0 for a ray. */
SHARED void start_body_walk(body_walk *walk, const body_structure *bodies, double_float3 start, vec3 displacement,
                            vec3 extent)
{
  GLOBAL const uint *counts = bodies->cells.counts;
  walk->next = 0u;
  walk->listed = counts[COUNT_UNBOUNDED];
  walk->rays.tree = bodies->hierarchy;
  walk->rays.path = straight_path_of(start, displacement, extent);
  if (bodies->structure == (uint)QUERY_HIERARCHY) start_ray_walk(&walk->rays);
  else if (bodies->structure == (uint)QUERY_EVERY_BODY) walk->listed = counts[COUNT_BODIES];
  else {
    walk->listed = counts[COUNT_LARGE];
    start_grid_walk(&bodies->cells, &walk->rays.path, walk->rays.waiting);
  }
}

/* The fraction of the path at which it enters a body's box: 0 for a half-space, ENDLESS if the path misses the box or
 * enters it after `reach`. */
SHARED real way_into_body(const body_walk *walk, const body_structure *bodies, uint body, real reach)
{
  if (body < bodies->cells.counts[COUNT_UNBOUNDED]) return R(0.0);
  return fraction_into_box(&walk->rays.path, load_bounds(bodies->cells.bounds, body), reach);
}

/* The next body that the path may meet before `reach`; INDEX_NONE after the last. */
SHARED uint next_body_on_path(body_walk *walk, const body_structure *bodies, real reach)
{
  while (walk->next < walk->listed) {
    uint body = walk->next;
    walk->next = body + 1u;
    if (way_into_body(walk, bodies, body, reach) < ENDLESS) return body;
  }
  if (bodies->structure == (uint)QUERY_GRID)
    return next_in_grid(&bodies->cells, &walk->rays.path, walk->rays.waiting, reach);
  if (bodies->structure != (uint)QUERY_HIERARCHY) return INDEX_NONE;
  uint leaf = next_on_ray(&walk->rays, reach);
  return leaf == INDEX_NONE ? INDEX_NONE : body_of_leaf(&walk->rays, leaf);
}

#endif
