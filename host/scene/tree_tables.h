/* tree_tables.h - meshes and compounds of a scene as the tables that the midphase walks: shared/midphase/tree.h.
 *
 * A compound's tree has a leaf for each convex child and one for each triangle of a child that is a mesh, so a pair of
 * bodies has one tree on either side at most. Bodies that share a shape share its tree; the children of each body have
 * places of their own behind the bodies, since they stand in that body's frame.
 */
#pragma once

#include <cstdint>
#include <vector>

#include <tandem/scene.h>

#include "host/runtime/memory.h"
#include "shared/platform.h"

namespace tandem {

struct TreeSizes {
  uint32_t trees = 0, nodes = 0, leaves = 0, subtrees = 0, vertices = 0, triangles = 0;
  uint64_t children = 0; /* of all bodies */
};

struct TreeTables {
  TreeSizes sizes;
  std::vector<uint32_t> tree_of_shape; /* of Scene::shapes; INDEX_NONE for convex ones */
  std::vector<uint32_t> headers, nodes, leaves, subtrees,
      triangles; /* as buffers.def has them: tree_header, tree_node, tree_leaf, .. */
  std::vector<float4> frames, vertices;
};

/* InputError where a mesh or compound has too much for 32-bit numbers, or bounds that are not finite. */
TreeTables tree_tables(const Scene &scene);

/* How many children the shape of a body has: 0 unless it is a compound. */
uint32_t children_of(const Shape &shape);

/* order: of the bodies in the buffers. */
void upload_trees(Memory &memory, const Scene &scene, const TreeTables &tables, const std::vector<uint32_t> &order);

} // namespace tandem
