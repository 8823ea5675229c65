/* tree_tables.cpp - builds and packs the trees of a scene's meshes and compounds; see tree_tables.h. */
#include "host/scene/tree_tables.h"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "host/geometry/bvh.h"
#include "host/geometry/shape_mass.h"
#include "host/scene/shape_bounds.h"
#include "shared/counts.h"
#include "shared/midphase/tree.h"

namespace tandem {
namespace {

static_assert(SUBTREE_NODES == most_subtree_nodes);

uint32_t count_of(size_t n)
{
  if (n > UINT32_MAX)
    throw InputError(
        fmt::format("meshes and compounds: {} entries in one table; at most {} can be numbered", n, UINT32_MAX));
  return static_cast<uint32_t>(n);
}

/* A part of a shape, with its bounding box in the shape's frame. */
struct Leaf {
  uint32_t child, triangle; /* INDEX_NONE: no child (the shape itself); no triangle */
  AxisAlignedBox box;
};

AxisAlignedBox bounds_of_box(const ShapeBox &box)
{
  AxisAlignedBox bounds;
  for (size_t k = 0; k < 3; ++k) {
    bounds.lower[k] = std::nextafter(box.center[k] - box.half_extents[k], -HUGE_VALF);
    bounds.upper[k] = std::nextafter(box.center[k] + box.half_extents[k], HUGE_VALF);
  }
  return bounds;
}

class TableBuilder {
public:
  explicit TableBuilder(const Scene &scene) : scene_(scene) {}

  TreeTables build()
  {
    for (size_t i = 0; i < scene_.shapes.size(); ++i)
      tables_.tree_of_shape.push_back(tree_of(scene_.shapes[i], fmt::format("{}: shape {}", scene_.name, i)));
    for (const Body &body : scene_.bodies) tables_.sizes.children += children_of(scene_.shapes[body.shape]);
    tables_.sizes.vertices = count_of(tables_.vertices.size());
    tables_.sizes.triangles = count_of(tables_.triangles.size() / 6);
    tables_.sizes.nodes = count_of(tables_.nodes.size() / 4);
    tables_.sizes.leaves = count_of(tables_.leaves.size() / 2);
    tables_.sizes.subtrees = count_of(tables_.subtrees.size() / 4);
    tables_.sizes.trees = count_of(tables_.headers.size() / TREE_HEADER);
    return std::move(tables_);
  }

private:
  uint32_t tree_of(const Shape &shape, const std::string &where)
  {
    if (shape.type != ShapeType::mesh && shape.type != ShapeType::compound) return INDEX_NONE;
    const void *what = shape.mesh ? static_cast<const void *>(shape.mesh.get()) : shape.compound.get();
    const auto [known, is_new] = trees_.try_emplace(what, count_of(trees_.size()));
    if (is_new) add_tree(leaves_of(shape), where);
    return known->second;
  }

  std::vector<Leaf> leaves_of(const Shape &shape)
  {
    std::vector<Leaf> leaves;
    if (shape.mesh) add_triangles(leaves, INDEX_NONE, shape, {}, {0, 0, 0, 1});
    for (uint32_t k = 0; k < children_of(shape); ++k) {
      const Child &child = shape.compound->children[k];
      if (child.shape.mesh) add_triangles(leaves, k, child.shape, child.position, child.orientation);
      else leaves.push_back({k, INDEX_NONE, bounds_of_box(box_around(child.shape, child.position, child.orientation))});
    }
    return leaves;
  }

  void add_triangles(std::vector<Leaf> &leaves, uint32_t child, const Shape &shape, const Vec3 &position,
                     const Quat &orientation)
  {
    const TriangleMesh &mesh = *shape.mesh;
    const uint32_t first = first_triangle_of(mesh);
    const std::vector<Vec3> placed = placed_points(mesh.vertices, position, orientation);
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle &corners = mesh.triangles[t];
      leaves.push_back(
          {child, first + t, bounds_of(std::vector<Vec3>{placed[corners[0]], placed[corners[1]], placed[corners[2]]})});
    }
  }

  uint32_t first_triangle_of(const TriangleMesh &mesh)
  {
    const auto [known, is_new] = meshes_.try_emplace(&mesh, count_of(tables_.triangles.size() / 6));
    if (!is_new) return known->second;
    const uint32_t vertex = count_of(tables_.vertices.size()), triangle = known->second;
    for (const Vec3 &v : mesh.vertices) tables_.vertices.push_back({v[0], v[1], v[2], 0});
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (uint32_t corner : mesh.triangles[t]) tables_.triangles.push_back(vertex + corner);
      for (uint32_t beyond : mesh.neighbours[t])
        tables_.triangles.push_back(beyond == no_triangle ? INDEX_NONE : triangle + beyond);
    }
    return triangle;
  }

  void add_tree(const std::vector<Leaf> &leaves, const std::string &where)
  {
    std::vector<AxisAlignedBox> boxes;
    for (const Leaf &leaf : leaves) boxes.push_back(leaf.box);
    const Bvh bvh = build_bvh(boxes, where);
    const auto &[origin, step] = bvh.quantisation;
    for (size_t word : {tables_.nodes.size() / 4, bvh.nodes.size(), tables_.leaves.size() / 2, leaves.size(),
                        tables_.subtrees.size() / 4, bvh.subtrees.size()})
      tables_.headers.push_back(count_of(word));
    tables_.frames.insert(tables_.frames.end(),
                          {float4{origin[0], origin[1], origin[2], 0}, float4{step[0], step[1], step[2], 0}});
    for (const BvhNode &node : bvh.nodes) add_box(tables_.nodes, node.bounds, static_cast<uint32_t>(node.value));
    for (const BvhSubtree &subtree : bvh.subtrees) add_box(tables_.subtrees, subtree.bounds, subtree.root);
    for (const Leaf &leaf : leaves) tables_.leaves.insert(tables_.leaves.end(), {leaf.child, leaf.triangle});
  }

  static void add_box(std::vector<uint32_t> &words, const QuantisedBounds &bounds, uint32_t last)
  {
    const auto pair = [](uint16_t low, uint16_t high) { return uint32_t{low} | uint32_t{high} << 16; };
    const auto &[lower, upper] = bounds;
    words.insert(words.end(), {pair(lower[0], lower[1]), pair(lower[2], upper[0]), pair(upper[1], upper[2]), last});
  }

  const Scene &scene_;
  TreeTables tables_;
  std::map<const void *, uint32_t> trees_;
  std::map<const TriangleMesh *, uint32_t> meshes_;
};

} // namespace

uint32_t children_of(const Shape &shape) { return shape.compound ? count_of(shape.compound->children.size()) : 0; }

TreeTables tree_tables(const Scene &scene) { return TableBuilder(scene).build(); }

void stage_trees(StagedUploads &uploads, const Scene &scene, const TreeTables &tables,
                 const std::vector<uint32_t> &order, uint32_t first_child, const std::vector<BodyStatus> &status)
{
  std::vector<uint32_t> body_trees;
  uint32_t next_child = first_child;
  for (uint32_t index : order) {
    const uint32_t shape = scene.bodies[index].shape;
    body_trees.insert(body_trees.end(), {tables.tree_of_shape[shape], next_child});
    if (status_of(status, index) != BodyStatus::free) next_child += children_of(scene.shapes[shape]);
  }
  uploads.add(Buffer::body_tree, std::move(body_trees));
  uploads.add(Buffer::tree_header, tables.headers);
  uploads.add(Buffer::tree_frame, tables.frames);
  uploads.add(Buffer::tree_node, tables.nodes);
  uploads.add(Buffer::tree_leaf, tables.leaves);
  uploads.add(Buffer::tree_subtree, tables.subtrees);
  uploads.add(Buffer::mesh_vertex, tables.vertices);
  uploads.add(Buffer::mesh_triangle, tables.triangles);
}

} // namespace tandem
