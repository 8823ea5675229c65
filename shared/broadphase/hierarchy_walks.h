/* hierarchy_walks.h - three ways through the tree of hierarchy.h, and the pairs that they find: for the comparison that
 * the talks make.
 *
 *   skip      a box that is missed is passed over by the link behind its subtree: one number of state
 *   stack     the nodes still to come
 *   history   two bits a level: which children have been visited (2009 talk); up by the link to the parent
 *
 * Each finds the leaves that a box overlaps in the order of the curve; bodies sort what they find, so the list is the
 * same.
 */
#ifndef TANDEM_SHARED_BROADPHASE_HIERARCHY_WALKS_H
#define TANDEM_SHARED_BROADPHASE_HIERARCHY_WALKS_H

#include "shared/broadphase/finds.h"
#include "shared/broadphase/hierarchy.h"

/* The bits of a code tell CURVE_BITS levels apart, and one more in trees.cpp; those of the places of equal codes up to
 * 31 more. */
#define HIERARCHY_LEVELS 64u

typedef struct {
  GLOBAL const row *nodes;
  GLOBAL const uint *links;
  box_bounds box;
  real before; /* bodies below this number are looked for */
} hierarchy_search;

SHARED uint link_of(const hierarchy_search *search, uint slot, uint link) { return search->links[LINKS * slot + link]; }

SHARED mask search_hits(const hierarchy_search *search, uint slot)
{
  numbered_box n = load_numbered_box(search->nodes, slot);
  return n.lowest < search->before && bounds_overlap(search->box, n.box);
}

/* Each yields the slot of the next leaf that is hit, INDEX_NONE behind the last. next: the slot to look at. */
SHARED uint next_by_skipping(const hierarchy_search *search, uint *next)
{
  while (*next != INDEX_NONE) {
    uint slot = *next;
    mask hit = search_hits(search, slot), is_leaf = is_leaf_slot(slot);
    *next = link_of(search, slot, hit && !is_leaf ? LINK_FIRST : LINK_AFTER);
    if (hit && is_leaf) return slot;
  }
  return INDEX_NONE;
}

typedef struct {
  uint slot[HIERARCHY_LEVELS];
  uint height;
} slot_stack;

SHARED uint next_from_stack(const hierarchy_search *search, slot_stack *stack)
{
  while (stack->height > 0u) {
    stack->height = stack->height - 1u;
    uint slot = stack->slot[stack->height];
    if (!search_hits(search, slot)) continue;
    if (is_leaf_slot(slot)) return slot;
    stack->slot[stack->height] = link_of(search, slot, LINK_SECOND);
    stack->slot[stack->height + 1u] = link_of(search, slot, LINK_FIRST);
    stack->height = stack->height + 2u;
  }
  return INDEX_NONE;
}

/* How many children of each node on the way down have been visited: that of the present one in the two lowest bits of
 * `near`. */
typedef struct {
  uint slot;
  ulong near, far;
} history;

SHARED void go_up(const hierarchy_search *search, history *h)
{
  h->slot = link_of(search, h->slot, LINK_PARENT);
  h->near = h->near >> 2 | h->far << 62;
  h->far = h->far >> 2;
}
SHARED void go_down(const hierarchy_search *search, history *h, uint link)
{
  h->near = h->near + (ulong)1;
  h->far = h->far << 2 | h->near >> 62;
  h->near = h->near << 2;
  h->slot = link_of(search, h->slot, link);
}
SHARED uint next_by_history(const hierarchy_search *search, history *h)
{
  while (h->slot != INDEX_NONE) {
    uint slot = h->slot, visited = (uint)h->near & 3u;
    mask hit = visited == 0u && search_hits(search, slot), is_leaf = is_leaf_slot(slot);
    if (visited == 2u || is_leaf || (visited == 0u && !hit)) go_up(search, h);
    else go_down(search, h, visited == 0u ? LINK_FIRST : LINK_SECOND);
    if (hit && is_leaf) return slot;
  }
  return INDEX_NONE;
}

/* Where numbers are rounded down the leaf itself decides. */
SHARED real before_body(uint body) { return lowest_as_real(body) + (body < 16777216u ? R(0.0) : R(256.0)); }

/* The body of a leaf whose box is hit. Where the tree knows only a rounded lowest number, its own number decides. */
SHARED void add_leaf(const pair_search *search, uint b, uint before, find_list *list)
{
  if (b < before && may_meet(search, b)) add_find(list, search->body, b);
}

/* Each of the three adds the bodies below number `before`, leaf by leaf along the curve. */
SHARED void find_by_skipping(const pair_search *search, const hierarchy_search *tree, GLOBAL const uint *leaf_body,
                             uint root, uint before, find_list *list)
{
  uint next = root;
  for (uint leaf = next_by_skipping(tree, &next); leaf != INDEX_NONE; leaf = next_by_skipping(tree, &next))
    add_leaf(search, leaf_body[leaf / 2u], before, list);
}
SHARED void find_from_stack(const pair_search *search, const hierarchy_search *tree, GLOBAL const uint *leaf_body,
                            uint root, uint before, find_list *list)
{
  slot_stack stack;
  stack.slot[0] = root;
  stack.height = 1u;
  for (uint leaf = next_from_stack(tree, &stack); leaf != INDEX_NONE; leaf = next_from_stack(tree, &stack))
    add_leaf(search, leaf_body[leaf / 2u], before, list);
}
SHARED void find_by_history(const pair_search *search, const hierarchy_search *tree, GLOBAL const uint *leaf_body,
                            uint root, uint before, find_list *list)
{
  history past = {root, 0u, 0u};
  for (uint leaf = next_by_history(tree, &past); leaf != INDEX_NONE; leaf = next_by_history(tree, &past))
    add_leaf(search, leaf_body[leaf / 2u], before, list);
}

/* Every body before the searching one; those without bounds first. */
SHARED void search_hierarchy(const pair_search *search, read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts,
                             uint walk, find_list *list)
{
  uint boundless = counts[COUNT_BOUNDLESS], root = root_slot(counts), a = search->body;
  hierarchy_search tree = {hierarchy_nodes.box, hierarchy_nodes.link, search->box, before_body(a)};
  find_among_first(search, boundless, list);
  if (a < boundless) return;
  if (walk == (uint)WALK_BY_SKIPPING) find_by_skipping(search, &tree, hierarchy_nodes.leaf_body, root, a, list);
  else if (walk == (uint)WALK_BY_STACK) find_from_stack(search, &tree, hierarchy_nodes.leaf_body, root, a, list);
  else find_by_history(search, &tree, hierarchy_nodes.leaf_body, root, a, list);
}

SHARED void hierarchy_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                                 GLOBAL const uint *body_filter, GLOBAL const row *bounds,
                                 read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts,
                                 GLOBAL uint *pair_start, GLOBAL uint *finds, uint walk, uint i)
{
  uint a = searching_body(hierarchy_nodes.leaf_body, counts[COUNT_BOUNDLESS], i);
  pair_search search = search_of_body(parameters, body_traits, body_filter, bounds, a);
  find_list list = first_finds(finds, i);
  search_hierarchy(&search, hierarchy_nodes, counts, walk, &list);
  pair_start[a] = list.at;
}

SHARED void hierarchy_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                                 GLOBAL const uint *body_filter, GLOBAL const row *bounds,
                                 read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *finds,
                                 GLOBAL const uint *counts, GLOBAL const uint *pair_start, write_pairs pairs, uint walk,
                                 uint i)
{
  uint a = searching_body(hierarchy_nodes.leaf_body, counts[COUNT_BOUNDLESS], i), first = pair_start[a],
       end = pair_start[a + 1u], capacity = counts[CAPACITY_PAIRS];
  find_list list = finds_as_bodies(pairs.b, first, capacity);
  if (end - first <= FINDS_KEPT) {
    add_kept_finds(&list, a, finds, i, end - first);
  } else {
    pair_search search = search_of_body(parameters, body_traits, body_filter, bounds, a);
    search_hierarchy(&search, hierarchy_nodes, counts, walk, &list);
  }
  finish_own_pairs(pairs, a, first, end, capacity);
}

#endif
