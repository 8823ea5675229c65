/* ray_walk.h - the bodies along a ray, near ones first, from the hierarchy of broadphase/hierarchy.h.
 *
 *          1                   Both children of a node are tested; the nearer one comes next, and where the other is hit too, a bit
 *        /   \                 of `trail` says so: one bit a level, the level at hand lowest. Where a leaf is done, trailing zeros
 *      2       3               say how far up the next one waits: halve the node so often, and take its neighbour. So near comes
 *     / \     / \              before far, without a stack.
 *    4   5   6   7
 *
 * Boxes are in the world's coordinates, of which the ray has a float and what that float lost: boxes are widened by as much.
 */
#ifndef TANDEM_SHARED_QUERIES_RAY_WALK_H
#define TANDEM_SHARED_QUERIES_RAY_WALK_H

#include "shared/broadphase/hierarchy.h"
#include "shared/queries/ray_shape.h"

/* The ray is start + s way, s from 0 to `reach`; a box that is `radius` larger is hit as well. */
typedef struct {
  GLOBAL const row *nodes;
  uint leaves, node, trail;
  vec3 start, inverse, widening;
} ray_walk;

/* As good as infinite where the ray runs along a face; 0 times it is still 0. */
SHARED real inverse_of_way(real way) { return magnitude(way) > R(1e-30) ? R(1.0) / way : way < R(0.0) ? -ENDLESS : ENDLESS; }

/* extent: half of a box that goes along the ray, 0 for the ray itself. */
SHARED ray_walk start_ray_walk(GLOBAL const row *nodes, GLOBAL const uint *counts, place start, vec3 way, vec3 extent)
{
  ray_walk walk;
  walk.nodes = nodes;
  walk.leaves = counts[COUNT_LEAVES];
  walk.node = 1u;
  walk.trail = 0u;
  walk.start = start.high;
  walk.inverse = make_vec3(inverse_of_way(way.x), inverse_of_way(way.y), inverse_of_way(way.z));
  walk.widening = add(extent, scale(absolute(start.high), R(1.2e-7)));
  return walk;
}

/* Where along the way the ray enters the box; ENDLESS where it misses it, or enters behind `reach`. */
SHARED real way_into_box(const ray_walk *walk, box_bounds box, real reach)
{
  vec3 low = multiply(subtract(subtract(box.lower, walk->widening), walk->start), walk->inverse);
  vec3 high = multiply(subtract(add(box.upper, walk->widening), walk->start), walk->inverse);
  real enter = maximum(maximum(minimum(low.x, high.x), minimum(low.y, high.y)), maximum(minimum(low.z, high.z), R(0.0)));
  real leave = minimum(minimum(maximum(low.x, high.x), maximum(low.y, high.y)), minimum(maximum(low.z, high.z), reach));
  return enter <= leave + R(1e-6) * magnitude(leave) ? enter : ENDLESS;
}

/* Empty boxes, turned inside out, would seem endless. */
SHARED real way_into_node(const ray_walk *walk, uint node, real reach)
{
  hierarchy_node n = load_node(walk->nodes, node);
  return n.lowest < BOUNDLESS ? way_into_box(walk, n.box, reach) : ENDLESS;
}

/* To the nearest node that was hit and not yet looked at; 0 where there is none. */
SHARED void go_on_along_ray(ray_walk *walk)
{
  if (walk->trail == 0u) walk->node = 0u;
  else {
    for (; (walk->trail & 1u) == 0u; walk->trail = walk->trail >> 1) walk->node = walk->node >> 1;
    walk->trail = walk->trail ^ 1u;
    walk->node = walk->node ^ 1u;
  }
}

/* The next leaf whose box the ray enters before `reach`; 0 behind the last. */
SHARED uint next_on_ray(ray_walk *walk, real reach)
{
  while (walk->node != 0u) {
    uint node = walk->node, first = 2u * node;
    if (node >= walk->leaves) {
      go_on_along_ray(walk);
      return node;
    }
    real one = way_into_node(walk, first, reach), other = way_into_node(walk, first + 1u, reach);
    if (!(one < ENDLESS) && !(other < ENDLESS)) go_on_along_ray(walk);
    else {
      walk->node = other < one ? first + 1u : first;
      walk->trail = walk->trail << 1 | (one < ENDLESS && other < ENDLESS ? 1u : 0u);
    }
  }
  return 0u;
}

#endif
