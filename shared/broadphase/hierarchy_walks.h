/* hierarchy_walks.h - three ways through the tree of hierarchy.h, and the pairs that they find: for the comparison that the talks make.
 *
 *   skip      a box that is missed is passed over by arithmetic: one number of state
 *   stack     the nodes still to come
 *   history   two bits a level: which children have been visited (2009 talk); up by halving the node
 *
 * Each finds the leaves that a box overlaps in the order of the curve; bodies sort what they find, so the list is the same.
 */
#ifndef TANDEM_SHARED_BROADPHASE_HIERARCHY_WALKS_H
#define TANDEM_SHARED_BROADPHASE_HIERARCHY_WALKS_H

#include "shared/broadphase/hierarchy.h"

/* Of fewer than 2^31 bodies; a stack holds the second child of each level, and the root. */
#define HIERARCHY_LEVELS 32u

typedef struct {
  GLOBAL const row *nodes;
  uint leaves; /* node of the first leaf */
  box_bounds box;
  real before; /* bodies below this number are looked for */
} hierarchy_search;

SHARED mask search_hits(const hierarchy_search *search, uint node)
{
  hierarchy_node n = load_node(search->nodes, node);
  return n.lowest < search->before && bounds_overlap(search->box, n.box);
}

/* The first node, in the order of the curve, behind the subtree of `node`; 0 behind the last. */
SHARED uint node_after(uint node)
{
  while ((node & 1u) != 0u) node = node >> 1;
  return node == 0u ? 0u : node + 1u;
}

/* Each yields the next leaf that is hit, 0 behind the last. next: the node to look at. */
SHARED uint next_by_skipping(const hierarchy_search *search, uint *next)
{
  while (*next != 0u) {
    uint node = *next;
    mask hit = search_hits(search, node), is_leaf = node >= search->leaves;
    *next = hit && !is_leaf ? 2u * node : node_after(node);
    if (hit && is_leaf) return node;
  }
  return 0u;
}

typedef struct {
  uint node[HIERARCHY_LEVELS];
  uint height;
} node_stack;

SHARED uint next_from_stack(const hierarchy_search *search, node_stack *stack)
{
  while (stack->height > 0u) {
    stack->height = stack->height - 1u;
    uint node = stack->node[stack->height];
    if (!search_hits(search, node)) continue;
    if (node >= search->leaves) return node;
    stack->node[stack->height] = 2u * node + 1u;
    stack->node[stack->height + 1u] = 2u * node;
    stack->height = stack->height + 2u;
  }
  return 0u;
}

/* visited: how many children of the node of each level, the root's in the lowest bits. */
typedef struct {
  uint node, level;
  ulong visited;
} history;

/* Up to the parent; behind the root the node is 0. */
SHARED void go_up(history *h)
{
  h->node = h->node >> 1;
  h->level = h->level - 1u;
}
SHARED void go_down(history *h, uint child)
{
  h->visited += (ulong)1 << 2u * h->level;
  h->level = h->level + 1u;
  h->visited &= ~((ulong)3 << 2u * h->level);
  h->node = 2u * h->node + child;
}
SHARED uint next_by_history(const hierarchy_search *search, history *h)
{
  while (h->node != 0u) {
    uint node = h->node, visited = (uint)(h->visited >> 2u * h->level) & 3u;
    mask hit = visited == 0u && search_hits(search, node), is_leaf = node >= search->leaves;
    if (visited == 2u || is_leaf || (visited == 0u && !hit)) go_up(h);
    else go_down(h, visited);
    if (hit && is_leaf) return node;
  }
  return 0u;
}

/* Body of item i: neighbours in the launch are neighbours on the curve. */
SHARED uint hierarchy_body(GLOBAL const uint *leaf_body, GLOBAL const uint *counts, uint i)
{
  return i < counts[COUNT_BOUNDLESS] ? i : leaf_body[i - counts[COUNT_BOUNDLESS]];
}

/* Where numbers are rounded down the leaf itself decides. */
SHARED real before_body(uint body) { return lowest_as_real(body) + (body < 16777216u ? R(0.0) : R(256.0)); }

/* Calls VISIT(b) for every body before `a` whose bounds overlap its own and that it may meet; NEXT yields leaves of `search`. */
#define VISIT_LEAVES(a, VISIT, NEXT)                                                         \
  for (uint leaf = NEXT; leaf != 0u; leaf = NEXT) {                                          \
    uint b = leaf_body[leaf - search.leaves];                                               \
    if (b < a && pair_allowed(parameters, body_traits, body_filter, a, b)) VISIT(b)          \
  }
#define HIERARCHY_SEARCH(a, walk, VISIT)                                                     \
  {                                                                                          \
    uint boundless = counts[COUNT_BOUNDLESS];                                                \
    hierarchy_search search = {hierarchy, counts[COUNT_LEAVES], load_bounds(bounds, a), before_body(a)}; \
    for (uint b = 0u; b < boundless && b < a; ++b)                                           \
      if (bounds_overlap(search.box, load_bounds(bounds, b)) && pair_allowed(parameters, body_traits, body_filter, a, b)) VISIT(b) \
    if (a >= boundless && walk == (uint)WALK_BY_SKIPPING) {                                  \
      uint next = 1u;                                                                        \
      VISIT_LEAVES(a, VISIT, next_by_skipping(&search, &next))                               \
    } else if (a >= boundless && walk == (uint)WALK_BY_STACK) {                              \
      node_stack stack;                                                                      \
      stack.node[0] = 1u;                                                                    \
      stack.height = 1u;                                                                     \
      VISIT_LEAVES(a, VISIT, next_from_stack(&search, &stack))                               \
    } else if (a >= boundless) {                                                             \
      history past = {1u, 0u, 0u};                                                           \
      VISIT_LEAVES(a, VISIT, next_by_history(&search, &past))                                \
    }                                                                                        \
  }

SHARED void hierarchy_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits, GLOBAL const uint *body_filter,
                                 GLOBAL const row *bounds, GLOBAL const row *hierarchy, GLOBAL const uint *leaf_body, GLOBAL const uint *counts,
                                 GLOBAL uint *pair_start, uint walk, uint i)
{
  uint a = hierarchy_body(leaf_body, counts, i), found = 0u;
#define VISIT(b) ++found;
  HIERARCHY_SEARCH(a, walk, VISIT)
#undef VISIT
  pair_start[a] = found;
}

SHARED void hierarchy_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits, GLOBAL const uint *body_filter,
                                 GLOBAL const row *bounds, GLOBAL const row *hierarchy, GLOBAL const uint *leaf_body, GLOBAL const uint *counts,
                                 GLOBAL const uint *pair_start, GLOBAL uint *pair_a, GLOBAL uint *pair_b, uint walk, uint i)
{
  uint a = hierarchy_body(leaf_body, counts, i), used = 0u, first = pair_start[a], capacity = counts[CAPACITY_PAIRS];
#define VISIT(b) used = append_pair(pair_a, pair_b, first, used, capacity, a, b);
  HIERARCHY_SEARCH(a, walk, VISIT)
#undef VISIT
  sort_stretch(pair_b + first, used);
}

#endif
