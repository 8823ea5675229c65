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

/* Body of item i: neighbours in the launch are neighbours on the curve. */
SHARED uint hierarchy_body(GLOBAL const uint *leaf_body, GLOBAL const uint *counts, uint i)
{
  return i < counts[COUNT_BOUNDLESS] ? i : leaf_body[i - counts[COUNT_BOUNDLESS]];
}

/* Where numbers are rounded down the leaf itself decides. */
SHARED real before_body(uint body) { return lowest_as_real(body) + (body < 16777216u ? R(0.0) : R(256.0)); }

/* Calls VISIT(b) for every body before `a` whose bounds overlap its own and that it may meet; NEXT yields leaves of
 * `search`. */
#define VISIT_LEAVES(a, VISIT, NEXT)                                                \
  for (uint leaf = NEXT; leaf != INDEX_NONE; leaf = NEXT) {                         \
    uint b = hierarchy_nodes.leaf_body[leaf / 2u];                                  \
    if (b < a && pair_allowed(parameters, body_traits, body_filter, a, b)) VISIT(b) \
  }
#define HIERARCHY_SEARCH(a, walk, VISIT)                                                                           \
  {                                                                                                                \
    uint boundless = counts[COUNT_BOUNDLESS], root = root_slot(counts);                                            \
    hierarchy_search search = {hierarchy_nodes.box, hierarchy_nodes.link, load_bounds(bounds, a), before_body(a)}; \
    for (uint b = 0u; b < boundless && b < a; ++b)                                                                 \
      if (bounds_overlap(search.box, load_bounds(bounds, b)) &&                                                    \
          pair_allowed(parameters, body_traits, body_filter, a, b))                                                \
        VISIT(b)                                                                                                   \
    if (a >= boundless && walk == (uint)WALK_BY_SKIPPING) {                                                        \
      uint next = root;                                                                                            \
      VISIT_LEAVES(a, VISIT, next_by_skipping(&search, &next))                                                     \
    } else if (a >= boundless && walk == (uint)WALK_BY_STACK) {                                                    \
      slot_stack stack;                                                                                            \
      stack.slot[0] = root;                                                                                        \
      stack.height = 1u;                                                                                           \
      VISIT_LEAVES(a, VISIT, next_from_stack(&search, &stack))                                                     \
    } else if (a >= boundless) {                                                                                   \
      history past = {root, 0u, 0u};                                                                               \
      VISIT_LEAVES(a, VISIT, next_by_history(&search, &past))                                                      \
    }                                                                                                              \
  }

SHARED void hierarchy_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                                 GLOBAL const uint *body_filter, GLOBAL const row *bounds,
                                 read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts,
                                 GLOBAL uint *pair_start, GLOBAL uint *finds, uint walk, uint i)
{
  uint a = hierarchy_body(hierarchy_nodes.leaf_body, counts, i), found = 0u;
#define VISIT(b) keep_find(finds, i, found++, b);
  HIERARCHY_SEARCH(a, walk, VISIT)
#undef VISIT
  pair_start[a] = found;
}

SHARED void hierarchy_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                                 GLOBAL const uint *body_filter, GLOBAL const row *bounds,
                                 read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *finds,
                                 GLOBAL const uint *counts, GLOBAL const uint *pair_start, write_pairs pairs, uint walk,
                                 uint i)
{
  uint a = hierarchy_body(hierarchy_nodes.leaf_body, counts, i), used = 0u, first = pair_start[a],
       found = pair_start[a + 1u] - first, capacity = counts[CAPACITY_PAIRS];
#define VISIT(other) used = append_pair(pairs.a, pairs.b, first, used, capacity, a, other);
  if (found <= FINDS_KEPT) {
    for (uint k = 0u; k < found; ++k) VISIT(finds[FINDS_KEPT * i + k])
  } else {
    HIERARCHY_SEARCH(a, walk, VISIT)
  }
#undef VISIT
  sort_stretch(pairs.b + first, used);
}

#endif
