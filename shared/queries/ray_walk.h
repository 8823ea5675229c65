/* ray_walk.h - the bodies along a ray, near ones first, from the hierarchy of broadphase/hierarchy.h.
 *
 *        ray  - - ->  [ near ]   [ far ]       Both children of a node are tested; the nearer one comes next, and where the other is
 *                                              hit too, it waits on a stack.
 *
 * A waiting node is not asked again whether something nearer has been hit since: to remember where the ray enters it costs more than the
 * two boxes that such a node is good for (docs/departures.md).
 *
 * Boxes are in the world's coordinates, of which the ray has a float and what that float lost: boxes are widened by as much.
 */
#ifndef TANDEM_SHARED_QUERIES_RAY_WALK_H
#define TANDEM_SHARED_QUERIES_RAY_WALK_H

#include "shared/broadphase/hierarchy_walks.h"
#include "shared/queries/ray_shape.h"

/* The tree as kernels are given it. */
typedef struct {
  GLOBAL const row *nodes;
  GLOBAL const uint *links, *leaf_body, *counts;
} body_hierarchy;

/* The ray is start + s way, s from 0 to `reach`. Boxes are wider than they are by start_low - start, and start - start_high. */
typedef struct {
  body_hierarchy tree;
  vec3 start_low, start_high, inverse;
  uint slot, height;
  uint waiting[HIERARCHY_LEVELS];
} ray_walk;

/* As good as infinite where the ray runs along a face; 0 times it is still 0. */
SHARED real inverse_of_way(real way) { return magnitude(way) > R(1e-30) ? R(1.0) / way : way < R(0.0) ? -ENDLESS : ENDLESS; }

/* extent: half of a box that goes along the ray, 0 for the ray itself. */
SHARED void start_ray_walk(ray_walk *walk, body_hierarchy tree, place start, vec3 way, vec3 extent)
{
  walk->tree = tree;
  vec3 widening = add(extent, scale(absolute(start.high), R(2.4e-7)));
  walk->start_low = add(start.high, widening);
  walk->start_high = subtract(start.high, widening);
  walk->inverse = make_vec3(inverse_of_way(way.x), inverse_of_way(way.y), inverse_of_way(way.z));
  walk->slot = root_slot(tree.counts);
  walk->height = 0u;
}

/* Where along the way the ray enters the box; ENDLESS where it misses it, or enters behind `reach`. */
SHARED real way_into_box(const ray_walk *walk, box_bounds box, real reach)
{
  vec3 low = multiply(subtract(box.lower, walk->start_low), walk->inverse), high = multiply(subtract(box.upper, walk->start_high), walk->inverse);
  real enter = maximum(maximum(minimum(low.x, high.x), minimum(low.y, high.y)), maximum(minimum(low.z, high.z), R(0.0)));
  real leave = minimum(minimum(maximum(low.x, high.x), maximum(low.y, high.y)), minimum(maximum(low.z, high.z), reach));
  return enter <= leave + R(1e-6) * magnitude(leave) ? enter : ENDLESS;
}

/* Empty boxes, turned inside out, would seem endless. */
SHARED real way_into_slot(const ray_walk *walk, uint slot, real reach)
{
  numbered_box n = load_numbered_box(walk->tree.nodes, slot);
  return n.lowest < BOUNDLESS ? way_into_box(walk, n.box, reach) : ENDLESS;
}

/* To the last that waits. */
SHARED void go_on_along_ray(ray_walk *walk)
{
  walk->slot = INDEX_NONE;
  if (walk->height == 0u) return;
  walk->height = walk->height - 1u;
  walk->slot = walk->waiting[walk->height];
}

/* Below an inner node, to the nearer of its children. */
SHARED void go_down_along_ray(ray_walk *walk, real reach)
{
  GLOBAL const uint *links = walk->tree.links + LINKS * walk->slot;
  uint first = links[LINK_FIRST], second = links[LINK_SECOND];
  real one = way_into_slot(walk, first, reach), other = way_into_slot(walk, second, reach);
  mask turned = other < one;
  if (!(one < ENDLESS) && !(other < ENDLESS)) {
    go_on_along_ray(walk);
    return;
  }
  walk->slot = turned ? second : first;
  if (one < ENDLESS && other < ENDLESS) {
    walk->waiting[walk->height] = turned ? first : second;
    walk->height = walk->height + 1u;
  }
}

/* The slot of the next leaf whose box the ray enters before `reach`; INDEX_NONE behind the last. */
SHARED uint next_on_ray(ray_walk *walk, real reach)
{
  while (walk->slot != INDEX_NONE) {
    uint slot = walk->slot;
    if (is_leaf_slot(slot)) {
      go_on_along_ray(walk);
      return slot;
    }
    go_down_along_ray(walk, reach);
  }
  return INDEX_NONE;
}

SHARED uint body_of_leaf(const ray_walk *walk, uint slot) { return walk->tree.leaf_body[slot / 2u]; }

#endif
