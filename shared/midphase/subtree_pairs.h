/* subtree_pairs.h - the middle phase by work-groups: parts of a tree are read once into local memory, for all pairs of a group.
 *
 *     pairs of a group     (7, 0) (8, 0) (9, 0) .. (70, 0)      body 0 is a mesh: one tree, asked 64 times
 *     its tree                  .                               leaf_pairs.h: each pair reads the nodes on its way from
 *                             .   .                             global memory, each its own way
 *     subtrees of at most   /\  /\  /\  /\  ..                  here: WINDOW subtrees at a time, which all pairs of the
 *     128 nodes, 2 KiB each                                     group then walk in local memory
 *
 * The list is that of leaf_pairs.h, to the word: subtrees hold every leaf once, in the order of the nodes, and the boxes above
 * them contain theirs, so that nothing is lost or won by leaving them out. After Bullet's btQuantizedBvh, whose subtrees fit the
 * local memory of a PlayStation 3's processors, and its walk over their headers.
 *
 * A round of a group is one window of one tree, in four phases:
 *
 *     load    headers of the window's subtrees       test    each pair: which of their boxes does it hit?
 *     copy    nodes of those that some pair hits     walk    each pair: those it hits, by skips, without a stack
 *
 * Rounds run over all windows of the first tree that a pair of the group asks, then of the next: one loop, since PoCL 3.1 cannot
 * nest them around phases. Pairs of two trees, and of none, are found by leaf_pairs.h within one phase before.
 */
#ifndef TANDEM_SHARED_MIDPHASE_SUBTREE_PAIRS_H
#define TANDEM_SHARED_MIDPHASE_SUBTREE_PAIRS_H

#include "shared/midphase/leaf_pairs.h"
#include "shared/midphase/pair_groups.h"

/* Subtrees in local memory at once. */
#define WINDOW 8u

/* Local memory, in words. Of each pair: what it asks (numbers first, as they are wider in double precision), the tree, the leaves
 * found so far, the subtrees of the window that it hits, and the rounds up to the last one of its tree. */
#define PROBE_REALS 6u
#define ASKED_AT (PROBE_REALS * GROUP_PAIRS * (uint)(sizeof(real) / sizeof(uint)))
#define FOUND_AT (ASKED_AT + GROUP_PAIRS)
#define HITS_AT (FOUND_AT + GROUP_PAIRS)
#define ROUNDS_AT (HITS_AT + GROUP_PAIRS)
#define LAST_ROUND_AT (ROUNDS_AT + GROUP_PAIRS)
/* Of the window: its tree, whether any pair hits any box; of each subtree its header, nodes, and whether any pair hits it. */
#define TREE_AT (LAST_ROUND_AT + GROUP_PAIRS)
#define ANY_HIT_AT (TREE_AT + 1u)
#define HEADER_AT (TREE_AT + 2u)
#define SIZE_AT (HEADER_AT + 4u * WINDOW)
#define WANTED_AT (SIZE_AT + WINDOW)
#define NODES_AT (WANTED_AT + WINDOW)
#define SUBTREE_LOCAL_WORDS (NODES_AT + 4u * SUBTREE_NODES * WINDOW)

/* What a group works on: pairs first .. first + pairs - 1 of bodies. */
typedef struct {
  midphase_scene scene;
  GLOBAL const uint *subtrees, *pair_a, *pair_b;
  uint first, pairs;
  leaf_list list;               /* where the leaves of a pair go; at and found are those of the pair */
  GLOBAL const uint *leaf_start; /* where a list that is written starts */
} pair_group;

SHARED leaf_list list_of_pair(const pair_group *group, uint k, uint found)
{
  leaf_list list = group->list;
  if (list.writes) list.at = group->leaf_start[group->first + k];
  list.found = found;
  return list;
}

SHARED uint windows_of_tree(const midphase_scene *scene, uint number) { return units_of(scene->trees.headers[number * TREE_HEADER + 5u], WINDOW); }

/* --- before the rounds --------------------------------------------------------------------------------------- */

/* INDEX_NONE: none, or two. */
SHARED uint asked_tree(const pair_group *group, uint k)
{
  if (k >= group->pairs) return INDEX_NONE;
  uint a = group->pair_a[group->first + k], b = group->pair_b[group->first + k];
  return one_has_tree(&group->scene, a, b) ? load_tree_pair(&group->scene, a, b).tree_number : INDEX_NONE;
}

/* Rounds for the tree that pair k asks, where no pair before asks it. */
SHARED uint rounds_of_pair(const midphase_scene *scene, LOCAL const uint *memory, uint k)
{
  uint number = memory[ASKED_AT + k];
  if (number == INDEX_NONE) return 0u;
  for (uint before = 0u; before < k; ++before)
    if (memory[ASKED_AT + before] == number) return 0u;
  return windows_of_tree(scene, number);
}

SHARED uint rounds_up_to_pair(LOCAL const uint *memory, uint k)
{
  uint sum = 0u;
  for (uint j = 0u; j <= k; ++j) sum += memory[ROUNDS_AT + j];
  return sum;
}

/* Below a plane: its normal and height, else a box. */
SHARED void store_probe(LOCAL uint *memory, uint k, const tree_probe *probe)
{
  LOCAL real *to = (LOCAL real *)memory + k;
  to[0] = probe->below_plane ? probe->normal.x : probe->box.lower.x;
  to[GROUP_PAIRS] = probe->below_plane ? probe->normal.y : probe->box.lower.y;
  to[2u * GROUP_PAIRS] = probe->below_plane ? probe->normal.z : probe->box.lower.z;
  to[3u * GROUP_PAIRS] = probe->below_plane ? probe->height : probe->box.upper.x;
  to[4u * GROUP_PAIRS] = probe->box.upper.y;
  to[5u * GROUP_PAIRS] = probe->box.upper.z;
}
SHARED tree_probe load_probe(const midphase_scene *scene, LOCAL const uint *memory, uint k, uint single)
{
  LOCAL const real *from = (LOCAL const real *)memory + k;
  tree_probe probe;
  probe.below_plane = shape_of(scene->traits[single]) == (uint)SHAPE_HALF_SPACE;
  probe.normal = make_vec3(from[0], from[GROUP_PAIRS], from[2u * GROUP_PAIRS]);
  probe.height = from[3u * GROUP_PAIRS];
  probe.box.lower = probe.normal;
  probe.box.upper = make_vec3(probe.height, from[4u * GROUP_PAIRS], from[5u * GROUP_PAIRS]);
  return probe;
}

/* What a pair asks its tree; where there is not just one, all its leaves. */
SHARED void prepare_pair(const pair_group *group, LOCAL uint *memory, uint k)
{
  uint a = group->pair_a[group->first + k], b = group->pair_b[group->first + k];
  leaf_list list = list_of_pair(group, k, 0u);
  if (memory[ASKED_AT + k] == INDEX_NONE) find_without_walk(&list, &group->scene, a, b);
  else {
    tree_pair pair = load_tree_pair(&group->scene, a, b);
    tree_probe probe = probe_of_pair(&group->scene, a, b, &pair);
    store_probe(memory, k, &probe);
  }
  memory[FOUND_AT + k] = list.found;
}

/* --- the phases of a round ----------------------------------------------------------------------------------- */

SHARED void load_subtree(const pair_group *group, LOCAL uint *memory, uint round, uint slot)
{
  uint k = 0u;
  while (memory[LAST_ROUND_AT + k] <= round) ++k; /* the pair that asked first for the tree of this round */
  uint number = memory[ASKED_AT + k], window = round + memory[ROUNDS_AT + k] - memory[LAST_ROUND_AT + k], place = window * WINDOW + slot;
  GLOBAL const uint *header = group->scene.trees.headers + number * TREE_HEADER;
  if (slot == 0u) memory[TREE_AT] = number;
  if (slot == 0u) memory[ANY_HIT_AT] = 0u;
  memory[WANTED_AT + slot] = 0u;
  memory[SIZE_AT + slot] = 0u;
  if (place >= header[5]) return;
  GLOBAL const uint *subtree = group->subtrees + (header[4] + place) * 4u;
  for (uint word = 0u; word < 4u; ++word) memory[HEADER_AT + slot * 4u + word] = subtree[word];
  memory[SIZE_AT + slot] = subtree_size(group->scene.trees.nodes[(header[0] + subtree[3]) * 4u + 3u]);
}

SHARED box_bounds local_bounds(const tree *t, LOCAL const uint *words) { return bounds_of_words(t, words[0], words[1], words[2]); }

SHARED void test_window(const pair_group *group, LOCAL uint *memory, uint k)
{
  memory[HITS_AT + k] = 0u;
  if (memory[ASKED_AT + k] != memory[TREE_AT]) return;
  tree_pair pair = load_tree_pair(&group->scene, group->pair_a[group->first + k], group->pair_b[group->first + k]);
  tree_probe probe = load_probe(&group->scene, memory, k, pair.single);
  tree t = load_tree(group->scene.trees, pair.tree_number);
  uint hits = 0u;
  for (uint slot = 0u; slot < WINDOW; ++slot)
    if (memory[SIZE_AT + slot] > 0u && probe_hits(&probe, local_bounds(&t, memory + HEADER_AT + slot * 4u))) {
      hits |= 1u << slot;
      LOCAL_ADD(memory + WANTED_AT + slot, 1u);
    }
  memory[HITS_AT + k] = hits;
  if (hits != 0u) LOCAL_ADD(memory + ANY_HIT_AT, 1u);
}

SHARED void copy_node(const pair_group *group, LOCAL uint *memory, uint i)
{
  uint slot = i / SUBTREE_NODES, node = i % SUBTREE_NODES;
  if (memory[WANTED_AT + slot] == 0u || node >= memory[SIZE_AT + slot]) return;
  uint first_node = group->scene.trees.headers[memory[TREE_AT] * TREE_HEADER];
  GLOBAL const uint *from = group->scene.trees.nodes + (first_node + memory[HEADER_AT + slot * 4u + 3u] + node) * 4u;
  for (uint word = 0u; word < 4u; ++word) memory[NODES_AT + i * 4u + word] = from[word];
}

SHARED void walk_subtree(leaf_list *list, const midphase_scene *scene, const tree_pair *pair, const tree_probe *probe, const tree *t,
                         LOCAL const uint *nodes, uint size)
{
  for (uint node = 0u; node < size;) {
    LOCAL const uint *words = nodes + node * 4u;
    mask hit = probe_hits(probe, local_bounds(t, words));
    if (hit && is_leaf(words[3])) add_leaf_of_tree(list, scene, pair, t, words[3]);
    node = node + (hit ? 1u : subtree_size(words[3]));
  }
}

SHARED void walk_window(const pair_group *group, LOCAL uint *memory, uint k)
{
  uint hits = memory[HITS_AT + k];
  if (hits == 0u) return;
  leaf_list list = list_of_pair(group, k, memory[FOUND_AT + k]);
  tree_pair pair = load_tree_pair(&group->scene, group->pair_a[group->first + k], group->pair_b[group->first + k]);
  tree_probe probe = load_probe(&group->scene, memory, k, pair.single);
  tree t = load_tree(group->scene.trees, pair.tree_number);
  for (uint slot = 0u; slot < WINDOW; ++slot)
    if ((hits >> slot & 1u) != 0u)
      walk_subtree(&list, &group->scene, &pair, &probe, &t, memory + NODES_AT + slot * 4u * SUBTREE_NODES, memory[SIZE_AT + slot]);
  memory[FOUND_AT + k] = list.found;
}

/* Every leaf of every pair; how many of each is left in local memory. */
SHARED void find_leaf_pairs_of_group(const pair_group *group, LOCAL uint *memory)
{
  FOR_EACH_ITEM(k, GROUP_PAIRS) memory[ASKED_AT + k] = asked_tree(group, k);
  FOR_EACH_ITEM(k, GROUP_PAIRS) memory[ROUNDS_AT + k] = rounds_of_pair(&group->scene, memory, k);
  FOR_EACH_ITEM(k, GROUP_PAIRS) memory[LAST_ROUND_AT + k] = rounds_up_to_pair(memory, k);
  FOR_EACH_ITEM(k, group->pairs) prepare_pair(group, memory, k);
  const uint rounds = memory[LAST_ROUND_AT + GROUP_PAIRS - 1u];
  for (uint round = 0u; round < rounds; ++round) {
    FOR_EACH_ITEM(slot, WINDOW) load_subtree(group, memory, round, slot);
    FOR_EACH_ITEM(k, GROUP_PAIRS) test_window(group, memory, k);
    FOR_EACH_ITEM(i, memory[ANY_HIT_AT] > 0u ? WINDOW * SUBTREE_NODES : 0u) copy_node(group, memory, i);
    FOR_EACH_ITEM(k, GROUP_PAIRS) walk_window(group, memory, k);
  }
}

/* --- kernels ------------------------------------------------------------------------------------------------- */

SHARED void count_leaf_pairs_by_subtree_group(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a, GLOBAL const uint *pair_b,
                                              GLOBAL const uint *traits, GLOBAL const uint *filters, GLOBAL const row *shapes,
                                              GLOBAL const row *poses, GLOBAL const uint *body_trees, GLOBAL const uint *headers,
                                              GLOBAL const row *frames, GLOBAL const uint *nodes, GLOBAL const uint *leaves,
                                              GLOBAL const uint *subtrees, GLOBAL const row *positions, GLOBAL const row *orientations,
                                              GLOBAL const row *velocities, GLOBAL const uint *counts, GLOBAL uint *leaf_start,
                                              LOCAL uint *local_memory, uint group)
{
  midphase_scene scene = {parameters, traits, filters, body_trees, shapes, poses, positions, orientations, velocities, {headers, frames, nodes, leaves}};
  leaf_list list = {0, 0, 0, 0, 0u, 0u, 0u};
  const uint first = group * GROUP_PAIRS, pairs = items_in_tile(counts[COUNT_BODY_PAIRS], GROUP_PAIRS, group);
  pair_group work = {scene, subtrees, pair_a, pair_b, first, pairs, list, 0};
  if (pairs == 0u) return;
  find_leaf_pairs_of_group(&work, local_memory);
  FOR_EACH_ITEM(k, pairs) leaf_start[first + k] = local_memory[FOUND_AT + k];
}

SHARED void write_leaf_pairs_by_subtree_group(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a, GLOBAL const uint *pair_b,
                                              GLOBAL const uint *traits, GLOBAL const uint *filters, GLOBAL const row *shapes,
                                              GLOBAL const row *poses, GLOBAL const uint *body_trees, GLOBAL const uint *headers,
                                              GLOBAL const row *frames, GLOBAL const uint *nodes, GLOBAL const uint *leaves,
                                              GLOBAL const uint *subtrees, GLOBAL const row *positions, GLOBAL const row *orientations,
                                              GLOBAL const row *velocities, GLOBAL const uint *leaf_start, GLOBAL const uint *counts,
                                              GLOBAL uint *leaf_pair_a, GLOBAL uint *leaf_pair_b, GLOBAL uint *pair_leaf,
                                              LOCAL uint *local_memory, uint group)
{
  midphase_scene scene = {parameters, traits, filters, body_trees, shapes, poses, positions, orientations, velocities, {headers, frames, nodes, leaves}};
  leaf_list list = {1, leaf_pair_a, leaf_pair_b, pair_leaf, 0u, counts[CAPACITY_PAIRS], 0u};
  const uint pairs = items_in_tile(counts[COUNT_BODY_PAIRS], GROUP_PAIRS, group);
  pair_group work = {scene, subtrees, pair_a, pair_b, group * GROUP_PAIRS, pairs, list, leaf_start};
  if (pairs == 0u) return;
  find_leaf_pairs_of_group(&work, local_memory);
}

#endif
