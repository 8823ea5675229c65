/* bvh.h - a bounding volume hierarchy with 16 bytes a node, over the triangles of a mesh or the children of a
 * compound.
 *
 * It follows Bullet's btQuantizedBvh and Ericson (Real-Time Collision Detection, 2005, ch. 6): coordinates have 16 bits
 * within the bounds of the whole, nodes are in depth-first order, and an inner node stores how many nodes to skip if
 * its box is missed. A traversal therefore needs no stack and reads memory forwards:
 *
 *         0             node:   0   1   2   3   4   5   6        for (i = 0; i < count;)
 *       /   \           skip:   7   3   .   .   3   .   .            if box i overlaps: leaf ? report : nothing; ++i
 *      1     4          leaf:           a   b       c   d            else: i += leaf ? 1 : skip
 *     / \   / \
 *    2   3 5   6        Subtrees of at most 128 nodes fill 2 KiB of local memory each: shared/midphase/subtree_pairs.h.
 *
 * It is built top down by the surface area heuristic over bins (Wald: On fast construction of SAH-based bounding volume
 * hierarchies, 2007), and by halving where the heuristic does not pay or the tree would grow too deep.
 */
#pragma once

#include "host/geometry/geometry.h"

namespace tandem {

/* A quantised coordinate: x = origin + q * step in float, product and sum each rounded, which is what kernels compute,
 * to the bit. It does not decrease with q, and the bounds lie within q = 0 .. 65535. */
struct Quantisation {
  Vec3 origin{}, step{1, 1, 1}; /* step > 0 */

  float coordinate(size_t axis, uint16_t q) const
  {
    const float whole = q, offset = whole * step[axis];
    return origin[axis] + offset;
  }
};

struct QuantisedBounds {
  std::array<uint16_t, 3> lower, upper;
  bool operator==(const QuantisedBounds &) const = default;
};

struct BvhNode {
  QuantisedBounds bounds;
  int32_t value; /* leaf: number of the primitive, >= 0. Inner node: minus the number of nodes of its subtree, the node
                    itself included */
  bool operator==(const BvhNode &) const = default;
};
static_assert(sizeof(BvhNode) == 16);

inline bool is_leaf(const BvhNode &node) { return node.value >= 0; }
/* The node itself included. */
inline uint32_t nodes_below(const BvhNode &node) { return is_leaf(node) ? 1 : uint32_t(-node.value); }

constexpr uint32_t most_subtree_nodes = 128; /* 2 KiB */

/* A largest subtree that fits. Together the subtrees hold each leaf once, in the order of the nodes. */
struct BvhSubtree {
  QuantisedBounds bounds;
  uint32_t root, size;
};

struct Bvh {
  Quantisation quantisation;
  std::vector<BvhNode> nodes; /* 2 n - 1 for n primitives; the root is the first */
  std::vector<BvhSubtree> subtrees;
  uint32_t depth = 0; /* inner nodes from the root to the deepest leaf; at most depth_bound(n) */
};

/* 2 ceil(log2 n) + 8. The surface area heuristic may use the first half of this depth; below it, ranges are halved. */
uint32_t depth_bound(size_t primitives);

/* Throws InputError for no boxes, for boxes whose lower bound is not at most the upper (NaN), for infinite ones, and
 * for 2^30 boxes or more. */
Bvh build_bvh(std::span<const AxisAlignedBox> boxes, const std::string &where);

/* The smallest quantised box that contains `box` after dequantisation; `box` must lie within the quantised bounds. */
QuantisedBounds quantised(const Quantisation &quantisation, const AxisAlignedBox &box);
AxisAlignedBox dequantised(const Quantisation &quantisation, const QuantisedBounds &bounds);

inline bool overlap(const AxisAlignedBox &a, const AxisAlignedBox &b)
{
  bool result = true;
  for (size_t axis = 0; axis < 3; ++axis)
    result = result && a.lower[axis] <= b.upper[axis] && a.upper[axis] >= b.lower[axis];
  return result;
}

/* Calls visit(primitive) for each primitive whose quantised box overlaps `box` (touching counts). It traverses as the
 * kernels do, without a stack. */
template <class Visit> void for_each_overlap(const Bvh &bvh, const AxisAlignedBox &box, const Visit &visit)
{
  for (size_t i = 0; i < bvh.nodes.size();) {
    const BvhNode &node = bvh.nodes[i];
    const bool hit = overlap(dequantised(bvh.quantisation, node.bounds), box);
    if (hit && is_leaf(node)) visit(uint32_t(node.value));
    i += hit ? 1 : nodes_below(node);
  }
}

} // namespace tandem
