/* tree.h - the hierarchy of boxes over the parts of one body: the triangles of a mesh, or the children of a compound.
 *
 *         0           node:   0   1   2   3   4   5   6       A node has 16 bytes: six bounds of 16 bits within the
 *       /   \         word:  -7  -3   a   b  -3   c   d       tree's frame, and the index of a leaf or minus the number
 *      1     4                                                of nodes in the subtree.
 *     / \   / \       A traversal needs no stack: a box that is hit is entered (next node), and a box that is missed is
 *    a   b c   d      skipped (by the size of its subtree). host/geometry/bvh.h builds the tree. It follows Bullet's
 *                     btQuantizedBvh and Ericson, "Real-Time Collision Detection", 2005, chapter 6.
 *
 * Coordinates are in the tree's axes, which are those of the body's shape, not of the body.
 */
#ifndef TANDEM_SHARED_MIDPHASE_TREE_H
#define TANDEM_SHARED_MIDPHASE_TREE_H

#include "shared/argument_groups.h"
#include "shared/broadphase/overlap.h"

/* The levels of a tree of fewer than 2^30 leaves: depth_bound of host/geometry/bvh.h. */
#define TREE_DEPTH_LIMIT 68u

/* The words of a tree's header: first node, nodes, first leaf, leaves, first subtree, subtrees. */
#define TREE_HEADER 6u
/* The most nodes of a subtree that subtree_pairs.h takes into local memory at once: 2 KiB. */
#define SUBTREE_NODES 128u

/* The buffers of all trees of the scene, one tree behind the other. */
typedef struct {
  GLOBAL const uint *headers;  /* TREE_HEADER a tree */
  GLOBAL const float4 *frames; /* 2 a tree: origin and step of its 16-bit coordinates */
  GLOBAL const uint *nodes;    /* 4 a node */
  GLOBAL const uint
      *leaves; /* 2 a leaf: the child it belongs to (INDEX_NONE: the body's own shape), its triangle or INDEX_NONE */
} tree_tables;

SHARED tree_tables tables_of_trees(read_trees trees)
{
  tree_tables tables = {trees.header, trees.frame, trees.node, trees.leaf};
  return tables;
}

typedef struct {
  uint first_node, nodes, first_leaf;
  vec3 origin, step;
} tree;

SHARED tree load_tree(tree_tables tables, uint number)
{
  GLOBAL const uint *header = tables.headers + number * TREE_HEADER;
  tree t = {header[0], header[1], header[2], xyz(load_float4(tables.frames, number * 2u)),
            xyz(load_float4(tables.frames, number * 2u + 1u))};
  return t;
}

SHARED vec3 dequantised(const tree *t, uint x, uint y, uint z)
{
  return add(t->origin, multiply(make_vec3(to_real(x), to_real(y), to_real(z)), t->step));
}
/* Decodes the box in the first three words of a node. */
SHARED box_bounds bounds_of_words(const tree *t, uint first, uint second, uint third)
{
  box_bounds box = {dequantised(t, first & 0xffffu, first >> 16u, second & 0xffffu),
                    dequantised(t, second >> 16u, third & 0xffffu, third >> 16u)};
  return box;
}
SHARED box_bounds bounds_of_node(tree_tables tables, const tree *t, uint node)
{
  GLOBAL const uint *words = tables.nodes + (t->first_node + node) * 4u;
  return bounds_of_words(t, words[0], words[1], words[2]);
}

SHARED uint word_of_node(tree_tables tables, const tree *t, uint node)
{
  return tables.nodes[(t->first_node + node) * 4u + 3u];
}
SHARED mask is_leaf(uint word) { return (word & 0x80000000u) == 0u; }
SHARED uint subtree_size(uint word) { return is_leaf(word) ? 1u : ~word + 1u; }

#endif
