/* leaf_pairs.h - the midphase: turns pairs of bodies into pairs of their parts.
 *
 *     bodies            trees                      pairs of leaves
 *     (a, b)   a: mesh     /\     b: hull   --->   (a: triangle 7, b)
 *                         7  9                     (a: triangle 9, b)
 *
 * It runs between broadphase and narrowphase in scenes with compounds or meshes. Pairs are counted, the counts are
 * scanned, and the pairs are written. The list has no gaps and the order of the trees, and if it exceeds its capacity,
 * the step runs again. Counting keeps the first few pairs of leaves of two bodies, so that writing looks for them again
 * only where there are more. A body without a tree is one leaf. All pairs of leaves of one pair of bodies are adjacent,
 * so that merge.h can join their manifolds. A pair of bodies without any is dropped.
 *
 * One leaf against a tree needs no stack; subtree_pairs.h does the same by work-groups. Two trees are descended
 * together: the larger box of the two is opened unless it is a leaf, so the stack holds at most one entry for each
 * level of either tree (Ericson, 2005, section 6.3.2).
 */
#ifndef TANDEM_SHARED_MIDPHASE_LEAF_PAIRS_H
#define TANDEM_SHARED_MIDPHASE_LEAF_PAIRS_H

#include "shared/midphase/tree.h"
#include "shared/parallel/length.h"

/* One entry for each level of either tree, and the current one. */
#define TANDEM_STACK (2u * TREE_DEPTH_LIMIT + 1u)

/* The bodies and trees of the scene. A shape has the index of its body; the children of compounds follow behind. */
typedef struct {
  GLOBAL const Parameters *parameters;
  read_shapes shapes;
  GLOBAL const uint *filters, *body_trees;
  tree_tables trees;
  read_bodies bodies;
} midphase_scene;

/* The first pairs of leaves of two bodies: the numbers of both in their trees, of 8 bits each, two pairs a word. */
#define KEPT_LEAF_PAIRS 4u
#define MOST_KEPT_LEAVES 255u      /* a leaf with a larger number is not kept */
#define NO_KEPT_LEAVES 0xffffffffu /* in place of the first word, if there is such a leaf */
typedef struct {
  uint first, second;
} kept_leaves;

/* The list that pairs are written to; without `writes` it only counts, and keeps the first ones. */
typedef struct {
  mask writes;
  write_pairs_of_leaves pairs;
  uint at, end, found;
  kept_leaves kept;
} leaf_list;

SHARED leaf_list counting_list(void)
{
  leaf_list list = {0, {0, 0, 0}, 0u, 0u, 0u, {0u, 0u}};
  return list;
}
SHARED leaf_list writing_list(write_pairs_of_leaves pairs, uint at, uint end)
{
  leaf_list list = {1, pairs, at, end, 0u, {0u, 0u}};
  return list;
}

/* A part of a body: its shape, one triangle if the shape is a mesh, and its number in the tree of the body. */
typedef struct {
  uint shape, triangle, number;
} leaf;

/* One body of a pair, with the axes and the origin of its shape as seen from the centre of the first body. */
typedef struct {
  uint body, tree_number, first_child;
  mat3 rotation;
  vec3 center;
} tree_body;

SHARED tree_body load_tree_body(const midphase_scene *scene, uint body, vec3 offset)
{
  quat turned = quat_from(load_float4(scene->bodies.orientation, body)),
       own = quat_from(load_float4(scene->shapes.pose, body * 4u + 1u));
  tree_body result;
  result.body = body;
  result.tree_number = scene->body_trees[body * 2u];
  result.first_child = scene->body_trees[body * 2u + 1u];
  result.rotation = rotation_of(quat_multiply(turned, own));
  result.center = add(offset, rotate(rotation_of(turned), xyz(load_float4(scene->shapes.pose, body * 4u))));
  return result;
}

/* The distance that a body with continuous collision may move within the step in any direction, because a contact may
 * deflect it; see store_bounds_of_step of broadphase/bounds.h. */
SHARED real distance_anywhere(const midphase_scene *scene, uint body, spatial_velocity m)
{
  real step = scene->parameters->step;
  vec3 gravity = gravity_at(scene->parameters, scene->bodies.gravity, body);
  return step * (length_of(m.linear) + step * length_of(gravity));
}

/* How far the parts of two bodies can approach each other in the step beyond their linear motion; see reach_of of
 * manifold.h. */
SHARED real midphase_margin(const midphase_scene *scene, uint a, uint b, vec3 offset)
{
  real radius_a = load_float4(scene->shapes.size, a).w, radius_b = load_float4(scene->shapes.size, b).w;
  spatial_velocity velocity_a = load_velocity(scene->bodies.velocity, a),
                   velocity_b = load_velocity(scene->bodies.velocity, b);
  real turn = length_of(velocity_a.angular) * radius_a + length_of(velocity_b.angular) * radius_b;
  real margin = scene->parameters->speculative_distance + scene->parameters->step * turn +
                R(1e-6) * (length_of(offset) + radius_a + radius_b);
  if (!HAS_FEATURE(scene->parameters, CONTINUOUS) || !is_continuous(scene->shapes.flags[a] | scene->shapes.flags[b]))
    return margin;
  return margin + distance_anywhere(scene, a, velocity_a) + distance_anywhere(scene, b, velocity_b);
}
SHARED vec3 relative_motion(const midphase_scene *scene, uint from, uint of)
{
  return scale(
      subtract(load_velocity(scene->bodies.velocity, of).linear, load_velocity(scene->bodies.velocity, from).linear),
      scene->parameters->step);
}

/* The region in which a tree is searched, in its axes: a box, or all below a plane. */
typedef struct {
  mask below_plane;
  box_bounds box;
  vec3 normal;
  real height;
} tree_probe;

SHARED mask probe_hits(const tree_probe *probe, box_bounds box)
{
  if (!probe->below_plane) return bounds_overlap(probe->box, box);
  vec3 n = probe->normal;
  vec3 lowest = make_vec3(n.x > R(0.0) ? box.lower.x : box.upper.x, n.y > R(0.0) ? box.lower.y : box.upper.y,
                          n.z > R(0.0) ? box.lower.z : box.upper.z);
  return dot3(n, lowest) <= probe->height;
}

/* The box of a swept, rotated box: half extents along the columns of `rotation`, swept by a motion, in the axes that
 * the rotation leads to. */
SHARED box_bounds swept_box(mat3 rotation, vec3 center, vec3 extent, vec3 motion, real margin)
{
  vec3 reach = make_vec3(dot3(absolute(rotation.x), extent) + margin, dot3(absolute(rotation.y), extent) + margin,
                         dot3(absolute(rotation.z), extent) + margin);
  vec3 low = make_vec3(minimum(motion.x, R(0.0)), minimum(motion.y, R(0.0)), minimum(motion.z, R(0.0)));
  vec3 high = make_vec3(maximum(motion.x, R(0.0)), maximum(motion.y, R(0.0)), maximum(motion.z, R(0.0)));
  box_bounds box = {add(subtract(center, reach), low), add(add(center, reach), high)};
  return box;
}

/* The region in which a tree is searched for a body without a tree. to_single: that body's centre seen from the centre
 * of the tree's body. */
SHARED tree_probe probe_for_single(const midphase_scene *scene, const tree_body *owner, uint single, vec3 to_single,
                                   real margin)
{
  mat3 turned = rotation_of(quat_from(load_float4(scene->bodies.orientation, single)));
  vec3 motion = relative_motion(scene, owner->body, single);
  tree_probe probe;
  probe.below_plane = shape_of(scene->shapes.flags[single]) == (uint)SHAPE_HALF_SPACE;
  probe.normal = rotate_back(owner->rotation, axis_y(turned));
  probe.height =
      dot3(axis_y(turned), subtract(to_single, owner->center)) + margin + maximum(dot3(axis_y(turned), motion), R(0.0));
  vec3 middle = add(to_single, rotate(turned, xyz(load_float4(scene->shapes.pose, single * 4u + 2u))));
  probe.box = swept_box(
      relative_rotation(owner->rotation, turned), rotate_back(owner->rotation, subtract(middle, owner->center)),
      xyz(load_float4(scene->shapes.pose, single * 4u + 3u)), rotate_back(owner->rotation, motion), margin);
  return probe;
}

SHARED leaf single_leaf(uint body)
{
  leaf part = {body, INDEX_NONE, 0u};
  return part;
}
SHARED leaf leaf_of_tree(const midphase_scene *scene, uint body, uint first_child, const tree *t, uint number)
{
  GLOBAL const uint *entry = scene->trees.leaves + (t->first_leaf + number) * 2u;
  leaf part = {entry[0] == INDEX_NONE ? body : first_child + entry[0], entry[1], number};
  return part;
}

SHARED void keep_leaf_pair(kept_leaves *kept, uint place, leaf a, leaf b)
{
  if (place >= KEPT_LEAF_PAIRS) return;
  uint numbers = (a.number | b.number << 8u) << 16u * (place % 2u);
  if (a.number >= MOST_KEPT_LEAVES || b.number >= MOST_KEPT_LEAVES) kept->first = NO_KEPT_LEAVES;
  else if (place < 2u) kept->first |= numbers;
  else kept->second |= numbers;
}

SHARED void add_leaf_pair(leaf_list *list, const midphase_scene *scene, uint body_a, leaf a, uint body_b, leaf b)
{
  if (!filters_accept(scene->parameters, scene->filters, a.shape, b.shape)) return;
  keep_leaf_pair(&list->kept, list->found, a, b);
  uint place = saturated_sum(list->at, list->found);
  list->found = saturated_sum(list->found, 1u); /* two meshes may have more than 2^32 pairs of triangles */
  if (!list->writes || place >= list->end) return;
  list->pairs.a[place] = body_a;
  list->pairs.b[place] = body_b;
  list->pairs.leaf[place * 4u] = a.shape;
  list->pairs.leaf[place * 4u + 1u] = a.triangle;
  list->pairs.leaf[place * 4u + 2u] = b.shape;
  list->pairs.leaf[place * 4u + 3u] = b.triangle;
}

/* A pair of a body with a tree and one without. tree_first: whether the tree is that of the pair's first body. */
typedef struct {
  uint owner, first_child, tree_number, single;
  mask tree_first;
} tree_pair;

SHARED mask has_tree(const midphase_scene *scene, uint body) { return scene->body_trees[body * 2u] != INDEX_NONE; }
SHARED mask one_has_tree(const midphase_scene *scene, uint a, uint b)
{
  return has_tree(scene, a) != has_tree(scene, b);
}

SHARED tree_pair load_tree_pair(const midphase_scene *scene, uint a, uint b)
{
  mask first = has_tree(scene, a);
  uint owner = first ? a : b;
  tree_pair pair = {owner, scene->body_trees[owner * 2u + 1u], scene->body_trees[owner * 2u], first ? b : a, first};
  return pair;
}

SHARED tree_probe probe_of_pair(const midphase_scene *scene, uint a, uint b, const tree_pair *pair)
{
  vec3 offset = offset_between(scene->bodies.position, a, b), none = make_vec3(R(0.0), R(0.0), R(0.0));
  tree_body owner = load_tree_body(scene, pair->owner, none);
  return probe_for_single(scene, &owner, pair->single, pair->tree_first ? offset : negate(offset),
                          midphase_margin(scene, a, b, offset));
}

SHARED void add_leaf_of_tree(leaf_list *list, const midphase_scene *scene, const tree_pair *pair, const tree *t,
                             uint number)
{
  leaf part = leaf_of_tree(scene, pair->owner, pair->first_child, t, number), other = single_leaf(pair->single);
  if (pair->tree_first) add_leaf_pair(list, scene, pair->owner, part, pair->single, other);
  else add_leaf_pair(list, scene, pair->single, other, pair->owner, part);
}

SHARED void walk_tree(leaf_list *list, const midphase_scene *scene, uint a, uint b)
{
  tree_pair pair = load_tree_pair(scene, a, b);
  tree_probe probe = probe_of_pair(scene, a, b, &pair);
  tree t = load_tree(scene->trees, pair.tree_number);
  for (uint node = 0u; node < t.nodes;) {
    uint word = word_of_node(scene->trees, &t, node);
    mask hit = probe_hits(&probe, bounds_of_node(scene->trees, &t, node));
    if (hit && is_leaf(word)) add_leaf_of_tree(list, scene, &pair, &t, word);
    node = node + (hit ? 1u : subtree_size(word));
  }
}

SHARED real size_of_box(box_bounds box)
{
  vec3 size = subtract(box.upper, box.lower);
  return maximum(size.x, maximum(size.y, size.z));
}

typedef struct {
  uint a, b;
} node_pair;

/* Pushes the children of a pair of nodes: those of the larger node, unless that is a leaf. */
SHARED void push_children(node_pair *stack, uint *height, const midphase_scene *scene, const tree *tree_a,
                          const tree *tree_b, node_pair nodes, mask descend_a)
{
  node_pair first = nodes, second = nodes;
  if (descend_a) {
    first.a = nodes.a + 1u;
    second.a = first.a + subtree_size(word_of_node(scene->trees, tree_a, first.a));
  } else {
    first.b = nodes.b + 1u;
    second.b = first.b + subtree_size(word_of_node(scene->trees, tree_b, first.b));
  }
  stack[*height] = second; /* the first is popped next, so the order is that of the trees */
  stack[*height + 1u] = first;
  *height = *height + 2u;
}

SHARED void walk_two_trees(leaf_list *list, const midphase_scene *scene, const tree_body *a, const tree_body *b,
                           real margin)
{
  tree tree_a = load_tree(scene->trees, a->tree_number), tree_b = load_tree(scene->trees, b->tree_number);
  mat3 rotation = relative_rotation(b->rotation, a->rotation);
  vec3 shift = rotate_back(b->rotation, subtract(a->center, b->center)),
       motion = rotate_back(b->rotation, relative_motion(scene, b->body, a->body));
  node_pair stack[TANDEM_STACK];
  uint height = 1u;
  stack[0].a = stack[0].b = 0u;
  while (height > 0u) {
    node_pair nodes = stack[--height];
    box_bounds box_a = bounds_of_node(scene->trees, &tree_a, nodes.a),
               box_b = bounds_of_node(scene->trees, &tree_b, nodes.b);
    vec3 middle = scale(add(box_a.lower, box_a.upper), R(0.5)),
         extent = scale(subtract(box_a.upper, box_a.lower), R(0.5));
    if (!bounds_overlap(swept_box(rotation, add(shift, rotate(rotation, middle)), extent, motion, margin), box_b))
      continue;
    uint word_a = word_of_node(scene->trees, &tree_a, nodes.a), word_b = word_of_node(scene->trees, &tree_b, nodes.b);
    mask descend_a = is_leaf(word_b) || (!is_leaf(word_a) && size_of_box(box_a) > size_of_box(box_b));
    if (is_leaf(word_a) && is_leaf(word_b))
      add_leaf_pair(list, scene, a->body, leaf_of_tree(scene, a->body, a->first_child, &tree_a, word_a), b->body,
                    leaf_of_tree(scene, b->body, b->first_child, &tree_b, word_b));
    else push_children(stack, &height, scene, &tree_a, &tree_b, nodes, descend_a);
  }
}

/* Finds the leaf pairs of two bodies with trees, or of two without. */
SHARED void find_without_walk(leaf_list *list, const midphase_scene *scene, uint a, uint b)
{
  if (!has_tree(scene, a)) {
    add_leaf_pair(list, scene, a, single_leaf(a), b, single_leaf(b));
    return;
  }
  vec3 offset = offset_between(scene->bodies.position, a, b), none = make_vec3(R(0.0), R(0.0), R(0.0));
  tree_body first = load_tree_body(scene, a, none), second = load_tree_body(scene, b, offset);
  walk_two_trees(list, scene, &first, &second, midphase_margin(scene, a, b, offset));
}

SHARED void find_leaf_pairs(leaf_list *list, const midphase_scene *scene, uint a, uint b)
{
  if (one_has_tree(scene, a, b)) walk_tree(list, scene, a, b);
  else find_without_walk(list, scene, a, b);
}

SHARED leaf leaf_of_number(const midphase_scene *scene, uint body, uint number)
{
  if (!has_tree(scene, body)) return single_leaf(body);
  tree t = load_tree(scene->trees, scene->body_trees[body * 2u]);
  return leaf_of_tree(scene, body, scene->body_trees[body * 2u + 1u], &t, number);
}

SHARED void write_kept_leaf_pairs(leaf_list *list, const midphase_scene *scene, uint a, uint b, kept_leaves kept,
                                  uint length)
{
  for (uint n = 0u; n < length; ++n) {
    uint numbers = (n < 2u ? kept.first : kept.second) >> 16u * (n % 2u);
    add_leaf_pair(list, scene, a, leaf_of_number(scene, a, numbers & 0xffu), b,
                  leaf_of_number(scene, b, numbers >> 8u & 0xffu));
  }
}

/* --- kernels ------------------------------------------------------------------------------------------------ */

SHARED void count_leaf_pairs_item(GLOBAL const Parameters *parameters, read_pairs pairs, read_shapes shapes,
                                  GLOBAL const uint *filters, read_trees trees, read_bodies bodies,
                                  GLOBAL uint *leaf_start, GLOBAL uint *leaf_kept, uint i)
{
  midphase_scene scene = {parameters, shapes, filters, trees.of_body, tables_of_trees(trees), bodies};
  leaf_list list = counting_list();
  find_leaf_pairs(&list, &scene, pairs.a[i], pairs.b[i]);
  leaf_start[i] = list.found;
  leaf_kept[2u * i] = list.kept.first;
  leaf_kept[2u * i + 1u] = list.kept.second;
}

/* From here on a pair is a pair of leaves. If the pairs of bodies already exceeded their capacity, `needed` keeps their
 * number. */
SHARED void count_all_leaf_pairs_item(GLOBAL const uint *leaf_start, GLOBAL uint *counts, uint i)
{
  (void)i;
  uint bodies = counts[COUNT_PAIRS], needed = leaf_start[bodies], capacity = counts[CAPACITY_PAIRS];
  counts[COUNT_BODY_PAIRS] = bodies;
  counts[COUNT_PAIRS] = needed < capacity ? needed : capacity;
  if (needed > counts[COUNT_PAIRS_NEEDED]) counts[COUNT_PAIRS_NEEDED] = needed;
}

SHARED void write_leaf_pairs_item(GLOBAL const Parameters *parameters, read_pairs pairs, read_shapes shapes,
                                  GLOBAL const uint *filters, read_trees trees, read_bodies bodies,
                                  GLOBAL const uint *leaf_start, GLOBAL const uint *leaf_kept,
                                  GLOBAL const uint *counts, write_pairs_of_leaves found, uint i)
{
  uint length = leaf_start[i + 1u] - leaf_start[i];
  if (length == 0u) return;
  midphase_scene scene = {parameters, shapes, filters, trees.of_body, tables_of_trees(trees), bodies};
  leaf_list list = writing_list(found, leaf_start[i], counts[CAPACITY_PAIRS]);
  kept_leaves kept = {leaf_kept[2u * i], leaf_kept[2u * i + 1u]};
  if (length <= KEPT_LEAF_PAIRS && kept.first != NO_KEPT_LEAVES)
    write_kept_leaf_pairs(&list, &scene, pairs.a[i], pairs.b[i], kept, length);
  else find_leaf_pairs(&list, &scene, pairs.a[i], pairs.b[i]);
}

/* Stores where the pairs of each body start, now that they are pairs of leaves. */
SHARED void start_leaf_pairs_item(GLOBAL const uint *leaf_start, GLOBAL const uint *counts, GLOBAL uint *pair_start,
                                  uint i)
{
  uint first = pair_start[i], last = counts[COUNT_BODY_PAIRS];
  pair_start[i] = leaf_start[first < last ? first : last];
}

#endif
