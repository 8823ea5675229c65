/* subtree_pairs.h - the midphase by work-groups: parts of a tree are read once into local memory, for all pairs of a
 * group.
 *
 *     pairs of a group     (7, 0) (8, 0) (9, 0) .. (70, 0)     body 0 is a mesh: one tree, searched 64 times
 *     its tree                  .                              leaf_pairs.h: each pair reads the nodes on its path from
 *                             .   .                            global memory by itself
 *     subtrees of at most   /\  /\  /\  /\  ..                 here: WINDOW subtrees at a time, which all pairs of the
 *     128 nodes, 2 KiB each                                    group then traverse in local memory
 *
 * The list is that of leaf_pairs.h, to the word. The subtrees hold every leaf once, in the order of the nodes, and the
 * boxes above them contain theirs, so leaving those out changes nothing. The method follows Bullet's btQuantizedBvh,
 * whose subtrees fit the local memory of a PlayStation 3's processors, and its traversal over their headers.
 *
 * A round of a group processes one window of one tree, in four phases. Phases without work are empty:
 *
 *     load    boxes of the window's subtrees         test    each pair against these boxes
 *     copy    nodes of those that some pair hits     walk    each pair through those it hits, by skips, without a stack
 *
 * A subtree outside the box around all regions that the group's pairs search in the tree is dropped when it is loaded.
 * The rounds run over all windows of the first tree that a pair of the group searches, then of the next. They are one
 * loop, because PoCL 3.1 cannot nest loops around phases. Pairs of two trees and pairs of none are found by
 * leaf_pairs.h in one phase before.
 */
#ifndef TANDEM_SHARED_MIDPHASE_SUBTREE_PAIRS_H
#define TANDEM_SHARED_MIDPHASE_SUBTREE_PAIRS_H

#include "shared/midphase/leaf_pairs.h"
#include "shared/midphase/pair_groups.h"

/* The number of subtrees in local memory at once. */
#define WINDOW 8u

/* The layout of local memory, in words. Reals come first, because they are wider in double precision: the region that
 * each pair searches, the box around all regions in one tree (at the first pair that searches it), and the boxes of the
 * window. */
#define BOX_REALS 6u
#define REACH_AT (BOX_REALS * GROUP_PAIRS)
#define BOXES_AT (2u * BOX_REALS * GROUP_PAIRS)
#define LOCAL_REALS (2u * BOX_REALS * GROUP_PAIRS + BOX_REALS * WINDOW)
/* For each pair: the tree that it searches, whether it searches below a plane, the leaves found so far, the subtrees of
 * the window that it hits, and the rounds for its tree if it is the first pair to search it, summed over the pairs. */
#define ASKED_AT (LOCAL_REALS * (uint)(sizeof(real) / sizeof(uint)))
#define PLANE_AT (ASKED_AT + GROUP_PAIRS)
#define FOUND_AT (PLANE_AT + GROUP_PAIRS)
#define HITS_AT (FOUND_AT + GROUP_PAIRS)
#define ROUNDS_AT (HITS_AT + GROUP_PAIRS)
#define LAST_ROUND_AT (ROUNDS_AT + GROUP_PAIRS)
/* For the window: its tree, the number of pairs that hit something, the number of subtrees within reach in even and in
 * odd rounds. For each subtree: its first node, its nodes (0: none, or out of reach), the number of pairs that hit it.
 * The nodes come last. */
#define TREE_AT (LAST_ROUND_AT + GROUP_PAIRS)
#define ANY_HIT_AT (TREE_AT + 1u)
#define IN_REACH_AT (TREE_AT + 2u)
#define ROOT_AT (TREE_AT + 4u)
#define SIZE_AT (ROOT_AT + WINDOW)
#define WANTED_AT (SIZE_AT + WINDOW)
#define NODES_AT (WANTED_AT + WINDOW)
#define SUBTREE_LOCAL_WORDS (NODES_AT + 4u * SUBTREE_NODES * WINDOW)

/* The input of a group: the pairs first .. first + count - 1 of bodies. */
typedef struct {
  midphase_scene scene;
  GLOBAL const uint *subtrees;
  read_pairs pairs;
  uint first, count;
  leaf_list list;                /* where the leaves of a pair are written; at and found are those of the pair */
  GLOBAL const uint *leaf_start; /* where the list of each pair starts */
} pair_group;

SHARED leaf_list list_of_pair(const pair_group *group, uint k, uint found)
{
  leaf_list list = group->list;
  if (list.writes) list.at = group->leaf_start[group->first + k];
  list.found = found;
  return list;
}

SHARED uint windows_of_tree(const midphase_scene *scene, uint number)
{
  return units_of(scene->trees.headers[number * TREE_HEADER + 5u], WINDOW);
}

/* --- before the rounds --------------------------------------------------------------------------------------- */

/* The tree that pair k searches; INDEX_NONE if neither body or both have a tree. */
SHARED uint asked_tree(const pair_group *group, uint k)
{
  if (k >= group->count) return INDEX_NONE;
  uint a = group->pairs.a[group->first + k], b = group->pairs.b[group->first + k];
  return one_has_tree(&group->scene, a, b) ? load_tree_pair(&group->scene, a, b).tree_number : INDEX_NONE;
}

/* The number of rounds for the tree that pair k searches; 0 if an earlier pair searches it. */
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

/* Stores box i in a table of `stride` boxes that starts at number `at`. */
SHARED void store_box(LOCAL uint *memory, uint at, uint stride, uint i, box_bounds box)
{
  LOCAL real *to = (LOCAL real *)memory + at + i;
  to[0] = box.lower.x;
  to[stride] = box.lower.y;
  to[2u * stride] = box.lower.z;
  to[3u * stride] = box.upper.x;
  to[4u * stride] = box.upper.y;
  to[5u * stride] = box.upper.z;
}
SHARED box_bounds load_box(LOCAL const uint *memory, uint at, uint stride, uint i)
{
  LOCAL const real *from = (LOCAL const real *)memory + at + i;
  box_bounds box = {make_vec3(from[0], from[stride], from[2u * stride]),
                    make_vec3(from[3u * stride], from[4u * stride], from[5u * stride])};
  return box;
}

/* The normal of a plane is stored in place of the lower corner, and its height in place of the upper one. */
SHARED void store_probe(LOCAL uint *memory, uint k, const tree_probe *probe)
{
  box_bounds plane = {probe->normal, make_vec3(probe->height, R(0.0), R(0.0))};
  store_box(memory, 0u, GROUP_PAIRS, k, probe->below_plane ? plane : probe->box);
  memory[PLANE_AT + k] = probe->below_plane ? 1u : 0u;
}
SHARED tree_probe load_probe(LOCAL const uint *memory, uint k)
{
  box_bounds box = load_box(memory, 0u, GROUP_PAIRS, k);
  tree_probe probe = {memory[PLANE_AT + k] != 0u, box, box.lower, box.upper.x};
  return probe;
}

/* Stores the region that a pair searches. If it does not search exactly one tree, all its leaf pairs are found here. */
SHARED void prepare_pair(const pair_group *group, LOCAL uint *memory, uint k)
{
  uint a = group->pairs.a[group->first + k], b = group->pairs.b[group->first + k];
  leaf_list list = list_of_pair(group, k, 0u);
  if (memory[ASKED_AT + k] == INDEX_NONE) find_without_walk(&list, &group->scene, a, b);
  else {
    tree_pair pair = load_tree_pair(&group->scene, a, b);
    tree_probe probe = probe_of_pair(&group->scene, a, b, &pair);
    store_probe(memory, k, &probe);
  }
  memory[FOUND_AT + k] = list.found;
  if (k == 0u) memory[IN_REACH_AT] = 0u;
}

/* The box around all regions that the pairs from k on search in the tree of pair k; a region below a plane is
 * infinite. */
SHARED box_bounds reach_of_tree(LOCAL const uint *memory, uint k)
{
  box_bounds reach = load_box(memory, 0u, GROUP_PAIRS, k);
  mask endless = 0;
  for (uint j = k; j < GROUP_PAIRS; ++j) {
    if (memory[ASKED_AT + j] != memory[ASKED_AT + k]) continue;
    box_bounds box = load_box(memory, 0u, GROUP_PAIRS, j);
    endless = endless || memory[PLANE_AT + j] != 0u;
    reach.lower = make_vec3(minimum(reach.lower.x, box.lower.x), minimum(reach.lower.y, box.lower.y),
                            minimum(reach.lower.z, box.lower.z));
    reach.upper = make_vec3(maximum(reach.upper.x, box.upper.x), maximum(reach.upper.y, box.upper.y),
                            maximum(reach.upper.z, box.upper.z));
  }
  box_bounds all = {make_vec3(-UNBOUNDED, -UNBOUNDED, -UNBOUNDED), make_vec3(UNBOUNDED, UNBOUNDED, UNBOUNDED)};
  return endless ? all : reach;
}

/* --- the phases of a round ----------------------------------------------------------------------------------- */

SHARED void begin_window(LOCAL uint *memory, uint round, uint number)
{
  memory[TREE_AT] = number;
  memory[ANY_HIT_AT] = 0u;
  memory[IN_REACH_AT + ((round + 1u) & 1u)] = 0u; /* of the next round, because this round's is in use in this phase */
}

/* Loads one subtree of the window of this round, for the first pair that searches its tree. */
SHARED void load_subtree(const pair_group *group, LOCAL uint *memory, uint round, uint slot)
{
  uint k = 0u;
  while (memory[LAST_ROUND_AT + k] <= round) ++k;
  uint number = memory[ASKED_AT + k], window = round + memory[ROUNDS_AT + k] - memory[LAST_ROUND_AT + k],
       place = window * WINDOW + slot;
  GLOBAL const uint *header = group->scene.trees.headers + number * TREE_HEADER;
  memory[WANTED_AT + slot] = 0u;
  memory[SIZE_AT + slot] = 0u;
  if (slot == 0u) begin_window(memory, round, number);
  if (place >= header[5]) return;
  tree t = load_tree(group->scene.trees, number);
  GLOBAL const uint *subtree = group->subtrees + (header[4] + place) * 4u;
  box_bounds box = bounds_of_words(&t, subtree[0], subtree[1], subtree[2]);
  if (!bounds_overlap(load_box(memory, REACH_AT, GROUP_PAIRS, k), box)) return;
  store_box(memory, BOXES_AT, WINDOW, slot, box);
  memory[ROOT_AT + slot] = t.first_node + subtree[3];
  memory[SIZE_AT + slot] = subtree_size(word_of_node(group->scene.trees, &t, subtree[3]));
  LOCAL_ADD(memory + IN_REACH_AT + (round & 1u), 1u);
}

SHARED void test_window(LOCAL uint *memory, uint k)
{
  memory[HITS_AT + k] = 0u;
  if (memory[ASKED_AT + k] != memory[TREE_AT]) return;
  tree_probe probe = load_probe(memory, k);
  uint hits = 0u;
  for (uint slot = 0u; slot < WINDOW; ++slot)
    if (memory[SIZE_AT + slot] > 0u && probe_hits(&probe, load_box(memory, BOXES_AT, WINDOW, slot))) {
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
  GLOBAL const uint *from = group->scene.trees.nodes + (memory[ROOT_AT + slot] + node) * 4u;
  for (uint word = 0u; word < 4u; ++word) memory[NODES_AT + i * 4u + word] = from[word];
}

SHARED void walk_subtree(leaf_list *list, const midphase_scene *scene, const tree_pair *pair, const tree_probe *probe,
                         const tree *t, LOCAL const uint *nodes, uint size)
{
  for (uint node = 0u; node < size;) {
    LOCAL const uint *words = nodes + node * 4u;
    mask hit = probe_hits(probe, bounds_of_words(t, words[0], words[1], words[2]));
    if (hit && is_leaf(words[3])) add_leaf_of_tree(list, scene, pair, t, words[3]);
    node = node + (hit ? 1u : subtree_size(words[3]));
  }
}

SHARED void walk_window(const pair_group *group, LOCAL uint *memory, uint k)
{
  uint hits = memory[HITS_AT + k];
  if (hits == 0u) return;
  leaf_list list = list_of_pair(group, k, memory[FOUND_AT + k]);
  tree_pair pair = load_tree_pair(&group->scene, group->pairs.a[group->first + k], group->pairs.b[group->first + k]);
  tree_probe probe = load_probe(memory, k);
  tree t = load_tree(group->scene.trees, pair.tree_number);
  for (uint slot = 0u; slot < WINDOW; ++slot)
    if ((hits >> slot & 1u) != 0u)
      walk_subtree(&list, &group->scene, &pair, &probe, &t, memory + NODES_AT + slot * 4u * SUBTREE_NODES,
                   memory[SIZE_AT + slot]);
  memory[FOUND_AT + k] = list.found;
}

/* Finds every leaf pair of every pair, and leaves the numbers of them in local memory. */
SHARED void find_leaf_pairs_of_group(const pair_group *group, LOCAL uint *memory)
{
  FOR_EACH_ITEM(k, GROUP_PAIRS) memory[ASKED_AT + k] = asked_tree(group, k);
  FOR_EACH_ITEM(k, GROUP_PAIRS) memory[ROUNDS_AT + k] = rounds_of_pair(&group->scene, memory, k);
  FOR_EACH_ITEM(k, GROUP_PAIRS) memory[LAST_ROUND_AT + k] = rounds_up_to_pair(memory, k);
  FOR_EACH_ITEM(k, group->count) prepare_pair(group, memory, k);
  FOR_EACH_ITEM(k, GROUP_PAIRS)
  if (memory[ROUNDS_AT + k] > 0u) store_box(memory, REACH_AT, GROUP_PAIRS, k, reach_of_tree(memory, k));
  const uint rounds = memory[LAST_ROUND_AT + GROUP_PAIRS - 1u];
  for (uint round = 0u; round < rounds; ++round) {
    FOR_EACH_ITEM(slot, WINDOW) load_subtree(group, memory, round, slot);
    FOR_EACH_ITEM(k, memory[IN_REACH_AT + (round & 1u)] > 0u ? GROUP_PAIRS : 0u) test_window(memory, k);
    FOR_EACH_ITEM(i, memory[ANY_HIT_AT] > 0u ? WINDOW * SUBTREE_NODES : 0u) copy_node(group, memory, i);
    FOR_EACH_ITEM(k, memory[ANY_HIT_AT] > 0u ? GROUP_PAIRS : 0u) walk_window(group, memory, k);
  }
}

/* --- kernels ------------------------------------------------------------------------------------------------- */

SHARED void count_leaf_pairs_by_subtree_group(GLOBAL const Parameters *parameters, read_pairs pairs, read_shapes shapes,
                                              GLOBAL const uint *filters, read_trees trees, GLOBAL const uint *subtrees,
                                              read_bodies bodies, GLOBAL const uint *counts, GLOBAL uint *leaf_start,
                                              LOCAL uint *local_memory, uint group)
{
  midphase_scene scene = {parameters, shapes, filters, trees.of_body, tables_of_trees(trees), bodies};
  leaf_list list = counting_list();
  const uint first = group * GROUP_PAIRS, count = items_in_tile(counts[COUNT_BODY_PAIRS], GROUP_PAIRS, group);
  pair_group work = {scene, subtrees, pairs, first, count, list, 0};
  if (count == 0u) return;
  find_leaf_pairs_of_group(&work, local_memory);
  FOR_EACH_ITEM(k, count) leaf_start[first + k] = local_memory[FOUND_AT + k];
}

SHARED void write_leaf_pairs_by_subtree_group(GLOBAL const Parameters *parameters, read_pairs pairs, read_shapes shapes,
                                              GLOBAL const uint *filters, read_trees trees, GLOBAL const uint *subtrees,
                                              read_bodies bodies, GLOBAL const uint *leaf_start,
                                              GLOBAL const uint *counts, write_pairs_of_leaves found,
                                              LOCAL uint *local_memory, uint group)
{
  midphase_scene scene = {parameters, shapes, filters, trees.of_body, tables_of_trees(trees), bodies};
  leaf_list list = writing_list(found, 0u, counts[CAPACITY_PAIRS]);
  const uint count = items_in_tile(counts[COUNT_BODY_PAIRS], GROUP_PAIRS, group);
  pair_group work = {scene, subtrees, pairs, group * GROUP_PAIRS, count, list, leaf_start};
  if (count == 0u) return;
  find_leaf_pairs_of_group(&work, local_memory);
}

#endif
