/* body.h - from the nodes of one rigid body to a body of the scene.
 *
 *   colliders                     the body's shape
 *   one                           that collider, at its node
 *   several                       a compound of them: each is a child with a material and a filter of its own
 *   none                          a ball that collides with nothing, so that the motion is kept
 *
 * Triggers are treated alike, but have no material.
 *
 * This is not a public header.
 */
#pragma once

#include "host/io/gltf/filters.h"
#include "host/io/gltf/shapes.h"
#include "host/io/gltf/transform.h"

namespace tandem {

struct PlacedNode {
  int node;
  Transform world;
};

struct BodyNodes {
  PlacedNode body; /* the one with the motion, or the only collider or trigger, or the one that lists triggers */
  bool moves;
  bool trigger = false; /* then `colliders` are triggers */
  /* What moves the node in the place of physics, "an animation" or "a skin"; the body then stands, kinematic. */
  const char *moved_by = nullptr;
  std::vector<PlacedNode> colliders = {};
  std::vector<PlacedNode> carried = {}; /* triggers below the motion */
};

class GltfBodies {
public:
  explicit GltfBodies(const GltfDocument &document);
  GltfBodies(const GltfBodies &) = delete;
  void add(const BodyNodes &nodes);
  Scene take() { return std::move(scene_); }
  /* The number of the body of each node that has one; that of a fixed trigger does not count. */
  const std::map<int, uint32_t> &by_node() const { return by_node_; }

private:
  /* The contents of a collider, and its pose in the world. */
  struct Collider {
    Shape shape;
    Point position{};
    std::array<double, 4> orientation{0, 0, 0, 1};
    uint32_t material = 0;
    GltfFilter filter;
  };
  Collider read_collider(const PlacedNode &at, bool trigger);
  uint32_t read_material(const JsonValue &collider) const;
  GltfFilter read_filter(const JsonValue &collider) const;
  void place_alone(const BodyNodes &nodes, Body &body);
  void place_together(const BodyNodes &nodes, Body &body);
  void place_ghost(const BodyNodes &nodes, Body &body);
  void note_that_it_stands(const BodyNodes &nodes);
  uint32_t add_shape(const Shape &shape);

  const GltfDocument &document_;
  Scene scene_;
  GltfShapes shapes_;
  std::vector<GltfFilter> filters_;
  std::map<int, uint32_t> by_node_;
  std::map<std::string, uint32_t> known_shapes_;
};

} // namespace tandem
