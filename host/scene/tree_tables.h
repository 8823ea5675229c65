/* tree_tables.h - the meshes and compounds of a scene as the tables that the midphase traverses:
 * shared/midphase/tree.h.
 *
 * A compound's tree has a leaf for each convex child and one for each triangle of a child that is a mesh, so a pair of
 * bodies has at most one tree on either side. Bodies that share a shape share its tree. The children of each body have
 * entries of their own after the bodies, because they are placed in that body's frame.
 */
#pragma once

#include <cstdint>
#include <vector>

#include <tandem/scene.h>

#include "host/scene/body_status.h"
#include "host/scene/staged_uploads.h"
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
      triangles; /* the tables of buffers.def: tree_header, tree_node, tree_leaf, ... */
  std::vector<float4> frames, vertices;
};

/* Throws InputError if a mesh or compound has too many parts for 32-bit numbers, or bounds that are not finite. */
TreeTables tree_tables(const Scene &scene);

/* The number of children of a shape: 0 unless it is a compound. */
uint32_t children_of(const Shape &shape);

/* order: that of the bodies in the buffers. first_child: the index of the first child among the shapes. */
void stage_trees(StagedUploads &uploads, const Scene &scene, const TreeTables &tables,
                 const std::vector<uint32_t> &order, uint32_t first_child, const std::vector<BodyStatus> &status = {});

} // namespace tandem
