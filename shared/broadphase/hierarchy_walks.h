/* hierarchy_walks.h - three traversals of the tree of hierarchy.h, and the pairs that they find. All three are here to
 * be compared with one another, as in the talks.
 *
 *   skip     a box that is missed is skipped by the link behind its subtree; the state is one number
 *   stack    the nodes that remain are on a stack
 *   history  two bits for each level tell which children have been visited (2009 talk); the link to the parent leads up
 *
 * Each finds the leaves that a box overlaps in the order of the curve, and each body sorts its finds, so the pair list
 * does not depend on the traversal.
 */
#ifndef TANDEM_SHARED_BROADPHASE_HIERARCHY_WALKS_H
#define TANDEM_SHARED_BROADPHASE_HIERARCHY_WALKS_H

#include "shared/broadphase/hierarchy.h"
#include "shared/broadphase/neighbors.h"

/* The depth limit of the tree: the bits of a code make CURVE_BITS levels, fat_aabbs.h uses one bit more, and the places
 * of equal codes make up to 31 further levels. */
#define HIERARCHY_LEVELS 64u

/* The tree that a body searches. */
typedef struct {
  GLOBAL const float4 *nodes;
  GLOBAL const uint *links;
  real before; /* the search skips subtrees in which no body has a lower number */
} searched_tree;

SHARED uint link_of(const searched_tree *tree, uint slot, uint link) { return tree->links[LINKS * slot + link]; }

SHARED mask search_hits(const pair_search *search, const searched_tree *tree, uint slot)
{
  return load_float4(tree->nodes, 2u * slot).w < tree->before && overlaps_rows(search->box, tree->nodes, slot);
}

/* Each traversal returns the slot of the next leaf that is hit, or INDEX_NONE after the last. next: the slot to
 * visit. */
SHARED uint next_by_skipping(const pair_search *search, const searched_tree *tree, uint *next)
{
  while (*next != INDEX_NONE) {
    uint slot = *next;
    mask hit = search_hits(search, tree, slot), is_leaf = is_leaf_slot(slot);
    *next = link_of(tree, slot, hit && !is_leaf ? LINK_FIRST : LINK_AFTER);
    if (hit && is_leaf) return slot;
  }
  return INDEX_NONE;
}

typedef struct {
  uint slot[HIERARCHY_LEVELS];
  uint height;
} slot_stack;

SHARED uint next_from_stack(const pair_search *search, const searched_tree *tree, slot_stack *stack)
{
  while (stack->height > 0u) {
    stack->height = stack->height - 1u;
    uint slot = stack->slot[stack->height];
    if (!search_hits(search, tree, slot)) continue;
    if (is_leaf_slot(slot)) return slot;
    stack->slot[stack->height] = link_of(tree, slot, LINK_SECOND);
    stack->slot[stack->height + 1u] = link_of(tree, slot, LINK_FIRST);
    stack->height = stack->height + 2u;
  }
  return INDEX_NONE;
}

/* Two bits for each node on the way down say how many of its children have been visited. Those of the present node are
 * the lowest two of `near`; `far` continues `near` upward. */
typedef struct {
  uint slot;
  ulong near, far;
} history;

SHARED void go_up(const searched_tree *tree, history *h)
{
  h->slot = link_of(tree, h->slot, LINK_PARENT);
  h->near = h->near >> 2 | h->far << 62;
  h->far = h->far >> 2;
}
SHARED void go_down(const searched_tree *tree, history *h, uint link)
{
  h->near = h->near + (ulong)1;
  h->far = h->far << 2 | h->near >> 62;
  h->near = h->near << 2;
  h->slot = link_of(tree, h->slot, link);
}
SHARED uint next_by_history(const pair_search *search, const searched_tree *tree, history *h)
{
  while (h->slot != INDEX_NONE) {
    uint slot = h->slot, visited = (uint)h->near & 3u;
    mask hit = visited == 0u && search_hits(search, tree, slot), is_leaf = is_leaf_slot(slot);
    if (visited == 2u || is_leaf || (visited == 0u && !hit)) go_up(tree, h);
    else go_down(tree, h, visited == 0u ? LINK_FIRST : LINK_SECOND);
    if (hit && is_leaf) return slot;
  }
  return INDEX_NONE;
}

/* A search for bodies before this one skips subtrees in which no number is lower than this. Numbers from 2^24 on are
 * rounded in the tree, so the bound is wider there, and add_leaf compares the exact number. */
SHARED real before_body(uint body) { return lowest_as_real(body) + (body < 16777216u ? R(0.0) : R(256.0)); }

/* Reports the body of a leaf whose box is hit. */
FORCE_INLINE uint add_leaf(const pair_search *search, uint b, uint before, const find_list *list, uint at)
{
  return b < before && may_meet(search, b) ? add_find(list, at, search->body, b) : at;
}

/* Each of the three reports the bodies with an index below `before`, leaf by leaf along the curve. */
FORCE_INLINE uint find_by_skipping(const pair_search *search, const searched_tree *tree, GLOBAL const uint *leaf_body,
                                   uint root, uint before, const find_list *list, uint at)
{
  uint next = root;
  for (uint leaf = next_by_skipping(search, tree, &next); leaf != INDEX_NONE;
       leaf = next_by_skipping(search, tree, &next))
    at = add_leaf(search, leaf_body[leaf / 2u], before, list, at);
  return at;
}
FORCE_INLINE uint find_from_stack(const pair_search *search, const searched_tree *tree, GLOBAL const uint *leaf_body,
                                  uint root, uint before, const find_list *list, uint at)
{
  slot_stack stack;
  stack.slot[0] = root;
  stack.height = 1u;
  for (uint leaf = next_from_stack(search, tree, &stack); leaf != INDEX_NONE;
       leaf = next_from_stack(search, tree, &stack))
    at = add_leaf(search, leaf_body[leaf / 2u], before, list, at);
  return at;
}
FORCE_INLINE uint find_by_history(const pair_search *search, const searched_tree *tree, GLOBAL const uint *leaf_body,
                                  uint root, uint before, const find_list *list, uint at)
{
  history past = {root, 0u, 0u};
  for (uint leaf = next_by_history(search, tree, &past); leaf != INDEX_NONE;
       leaf = next_by_history(search, tree, &past))
    at = add_leaf(search, leaf_body[leaf / 2u], before, list, at);
  return at;
}

/* Finds every body before the searching one; those without bounds come first. */
FORCE_INLINE uint search_hierarchy(const pair_search *search, read_hierarchy_nodes hierarchy_nodes,
                                   GLOBAL const uint *counts, uint walk, const find_list *list, uint at)
{
  uint unbounded = counts[COUNT_UNBOUNDED], root = root_slot(counts), a = search->body;
  searched_tree tree = {hierarchy_nodes.box, hierarchy_nodes.link, before_body(a)};
  at = find_among_first(search, unbounded, list, at);
  if (a < unbounded) return at;
  if (walk == (uint)WALK_BY_SKIPPING)
    return find_by_skipping(search, &tree, hierarchy_nodes.leaf_body, root, a, list, at);
  if (walk == (uint)WALK_BY_STACK) return find_from_stack(search, &tree, hierarchy_nodes.leaf_body, root, a, list, at);
  return find_by_history(search, &tree, hierarchy_nodes.leaf_body, root, a, list, at);
}

SHARED void hierarchy_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                 GLOBAL const uint *body_filter, GLOBAL const float4 *bounds,
                                 read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts,
                                 GLOBAL uint *pair_start, GLOBAL uint *neighbors, uint walk, uint i)
{
  uint a = searching_body(hierarchy_nodes.leaf_body, counts[COUNT_UNBOUNDED], i);
  pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, a);
  find_list list = first_neighbors(neighbors, i);
  pair_start[a] = search_hierarchy(&search, hierarchy_nodes, counts, walk, &list, 0u);
}

SHARED void hierarchy_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                 GLOBAL const uint *body_filter, GLOBAL const float4 *bounds,
                                 read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *neighbors,
                                 GLOBAL const uint *counts, GLOBAL const uint *pair_start, write_pairs pairs, uint walk,
                                 uint i)
{
  uint a = searching_body(hierarchy_nodes.leaf_body, counts[COUNT_UNBOUNDED], i), first = pair_start[a],
       end = pair_start[a + 1u], capacity = counts[CAPACITY_PAIRS];
  if (end - first <= NEIGHBORS_KEPT) {
    write_kept_pairs(neighbors, i, a, pairs, first, end, capacity);
  } else {
    pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, a);
    find_list list = finds_as_pairs(pairs, capacity);
    search_hierarchy(&search, hierarchy_nodes, counts, walk, &list, first);
  }
  sort_own_pairs(pairs, first, end, capacity);
}

#endif
