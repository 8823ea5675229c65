/* ray_walk.h - the bodies along a ray, near ones first, from the hierarchy of broadphase/hierarchy.h.
 *
 *        ray  - - ->  [ near ]   [ far ]       Both children of a node are tested. The nearer one is visited next; if
 *                                              the other one is hit too, it waits on a stack.
 *
 * A waiting node is not tested again when a nearer hit has been found. Storing the distance at which the ray enters it
 * would cost more than the two box tests that it would save (docs/departures.md).
 */
#ifndef TANDEM_SHARED_QUERIES_RAY_WALK_H
#define TANDEM_SHARED_QUERIES_RAY_WALK_H

#include "shared/broadphase/hierarchy_walks.h"
#include "shared/queries/straight_path.h"

/* The buffers of the tree. */
typedef struct {
  GLOBAL const float4 *nodes;
  GLOBAL const uint *links, *leaf_body, *counts;
} body_hierarchy;

typedef struct {
  body_hierarchy tree;
  straight_path path;
  uint slot, height;
  uint waiting[HIERARCHY_LEVELS];
} ray_walk;

SHARED real way_into_slot(const ray_walk *walk, uint slot, real reach)
{
  return fraction_into_box(&walk->path, load_bounds(walk->tree.nodes, slot), reach);
}

/* A tree of a single leaf has no node above the leaf that tests its box, so the test is made here. */
SHARED void start_ray_walk(ray_walk *walk)
{
  walk->slot = root_slot(walk->tree.counts);
  walk->height = 0u;
  if (is_leaf_slot(walk->slot) && !(way_into_slot(walk, walk->slot, ENDLESS) < ENDLESS)) walk->slot = INDEX_NONE;
}

/* Continues at the node that was pushed last. */
SHARED void go_on_along_ray(ray_walk *walk)
{
  walk->slot = INDEX_NONE;
  if (walk->height == 0u) return;
  walk->height = walk->height - 1u;
  walk->slot = walk->waiting[walk->height];
}

/* Continues below an inner node, at the nearer of its children. */
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

/* The slot of the next leaf whose box the ray enters before `reach`; INDEX_NONE after the last. */
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
