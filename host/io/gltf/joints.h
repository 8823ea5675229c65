/* joints.h - the joints of nodes, between the bodies of a scene.
 *
 * A joint connects its own node with another one. Each is an attachment frame on the nearest body at or above it: the
 * one with the motion, a fixed one with a collider where there is no motion, and the world where there is neither.
 *
 *   node (motion)                    body a
 *     node (joint) - - - - - -.      frame a: of this node, in the body's axes
 *   node (collider)           :      body b, fixed
 *     node < - connectedNode -'      frame b
 *
 * This is not a public header.
 */
#pragma once

#include "host/io/gltf/joint_parts.h"
#include "host/io/gltf/transform.h"

namespace tandem {

/* Where a node stands, and the node of the nearest body at or above it; none: the world. */
struct GltfFrame {
  static constexpr int none = -1;
  Transform world;
  int body_node = none;
  bool visited = false; /* a node outside the scene has no place */
};

class GltfJoints {
public:
  /* frames: of each node of the document; bodies: by node, the number of the body in the scene. */
  GltfJoints(const GltfDocument &document, const std::vector<GltfFrame> &frames, const std::map<int, uint32_t> &bodies)
      : document_(document), frames_(frames), bodies_(bodies)
  {}
  /* Throws InputError that names the node with the joint. */
  void add(int node, Scene &scene) const;

private:
  struct Ends;
  Ends ends_of(int node, const JsonValue &joint) const;
  uint32_t body_at(int node) const;
  void check_bodies(const Ends &ends, const JsonValue &joint) const;
  bool can_hold(const Ends &ends, Scene &scene) const;
  std::vector<GltfJointPart> parts_of(const Ends &ends, const JsonValue &joint) const;
  Joint placed(const GltfJointPart &part, const Ends &ends, const Scene &scene) const;

  const GltfDocument &document_;
  const std::vector<GltfFrame> &frames_;
  const std::map<int, uint32_t> &bodies_;
};

} // namespace tandem
