/* body.cpp - reads colliders, finds shared shapes and places them in bodies; see body.h. */
#include "host/io/gltf/body.h"

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/geometry/shape_mass.h"
#include "host/io/gltf/materials.h"
#include "host/io/gltf/motion.h"

namespace tandem {
namespace {

template <class Value> void append_bytes(std::string &key, const Value &value)
{
  key.append(reinterpret_cast<const char *>(&value), sizeof(Value));
}

/* A key that is equal for equal shapes, so that equal bodies share one shape and its tables. */
std::string identity_of(const Shape &shape)
{
  std::string key;
  append_bytes(key, shape.type);
  append_bytes(key, shape.size);
  append_bytes(key, shape.hull.get());
  append_bytes(key, shape.mesh.get());
  for (size_t i = 0; shape.compound && i < shape.compound->children.size(); ++i) {
    const Child &child = shape.compound->children[i];
    key += identity_of(child.shape);
    append_bytes(key, child.position);
    append_bytes(key, child.orientation);
    for (uint32_t number : {child.material.value_or(0), child.filter_group.value_or(0), child.filter_mask.value_or(0)})
      append_bytes(key, number);
  }
  return key;
}

void set_frame(const RigidPlace &frame, Body &body)
{
  body.position = frame.position;
  for (size_t i = 0; i < 4; ++i) body.orientation[i] = round_to_float(frame.orientation[i]);
}

} // namespace

GltfBodies::GltfBodies(const GltfDocument &document) : document_(document), shapes_(document)
{
  const JsonValue bodies = document.extension(bodies_extension, document.where);
  static constexpr const char *keys[] = {"physicsMaterials", "collisionFilters", "physicsJoints", "extras",
                                         "extensions"};
  bodies.only_keys(keys);
  scene_.name = document.where;
  scene_.gravity = {0, -9.81f, 0};
  scene_.materials = read_gltf_materials(bodies);
  filters_ = read_gltf_filters(bodies);
}

uint32_t GltfBodies::add_shape(const Shape &shape)
{
  const auto [at, added] = known_shapes_.emplace(identity_of(shape), uint32_t(scene_.shapes.size()));
  if (added) scene_.shapes.push_back(shape);
  return at->second;
}

uint32_t GltfBodies::read_material(const JsonValue &collider) const
{
  std::optional<JsonValue> material = collider.find("physicsMaterial");
  if (!material) return 0;
  const uint32_t chosen = material->unsigned_integer();
  if (chosen >= scene_.materials.size() - 1)
    material->fail(fmt::format("material {} does not exist; the file has {}", chosen, scene_.materials.size() - 1));
  return chosen + 1;
}

GltfFilter GltfBodies::read_filter(const JsonValue &collider) const
{
  std::optional<JsonValue> filter = collider.find("collisionFilter");
  if (!filter) return {};
  const uint32_t chosen = filter->unsigned_integer();
  if (chosen >= filters_.size())
    filter->fail(fmt::format("filter {} does not exist; the file has {}", chosen, filters_.size()));
  return filters_[chosen];
}

GltfBodies::Collider GltfBodies::read_collider(const PlacedNode &at, bool trigger)
{
  static constexpr const char *collider_keys[] = {"geometry", "physicsMaterial", "collisionFilter", "extras",
                                                  "extensions"};
  static constexpr const char *trigger_keys[] = {"geometry", "collisionFilter", "extras", "extensions"};
  const JsonValue json = document_.physics_of(at.node)->member(trigger ? "trigger" : "collider");
  if (trigger) json.only_keys(trigger_keys);
  else json.only_keys(collider_keys);
  const RigidPlace place = rigid_place(document_, at.node, at.world);
  const GltfShape read = shapes_.read(json.member("geometry"), place.scale);
  Collider collider{read.shape, place.position, place.orientation, read_material(json), read_filter(json)};
  const Double3 lifted = turned(place.orientation, {0, read.offset, 0});
  for (size_t axis = 0; axis < 3; ++axis) collider.position[axis] += lifted[axis];
  return collider;
}

/* The shape is at its own node, the body's frame at the node with the motion. */
void GltfBodies::place_alone(const BodyNodes &nodes, Body &body)
{
  const PlacedNode &at = nodes.colliders.front();
  const RigidPlace frame = rigid_place(document_, nodes.body.node, nodes.body.world);
  const Collider collider = read_collider(at, nodes.trigger);
  body.shape = add_shape(collider.shape);
  body.material = collider.material;
  body.filter_group = collider.filter.group;
  body.filter_mask = collider.filter.mask;
  set_frame({collider.position, collider.orientation, {}}, body);
  const bool apart = nodes.moves && at.node != nodes.body.node, plane = collider.shape.type == ShapeType::half_space;
  if (apart && plane)
    document_.refuse(
        at.node, fmt::format("a plane below the motion of {} is not supported yet", document_.label(nodes.body.node)));
  if (!plane && (apart || (at.node == nodes.body.node && collider.position != frame.position)))
    move_frame(body, frame.position, frame.orientation);
}

/* Children are placed in the frame of the node with the motion; its scale is applied to their positions and sizes. */
void GltfBodies::place_together(const BodyNodes &nodes, Body &body)
{
  const RigidPlace frame = rigid_place(document_, nodes.body.node, nodes.body.world);
  const auto &[x, y, z, w] = frame.orientation;
  const Rotation back{-x, -y, -z, w};
  std::vector<Child> children;
  for (const PlacedNode &at : nodes.colliders) {
    const Collider collider = read_collider(at, nodes.trigger);
    if (collider.shape.type == ShapeType::half_space)
      document_.refuse(
          at.node,
          fmt::format("an infinite plane in the compound of {} is not supported yet; a plane with sizeX and sizeZ is",
                      document_.label(nodes.body.node)));
    const Double3 from{collider.position[0] - frame.position[0], collider.position[1] - frame.position[1],
                       collider.position[2] - frame.position[2]};
    const Double3 position = turned(back, from);
    const Rotation orientation = product(back, collider.orientation);
    Child child;
    child.shape = collider.shape;
    for (size_t axis = 0; axis < 3; ++axis) child.position[axis] = round_to_float(position[axis]);
    for (size_t i = 0; i < 4; ++i) child.orientation[i] = round_to_float(orientation[i]);
    child.material = collider.material;
    child.filter_group = collider.filter.group;
    child.filter_mask = collider.filter.mask;
    children.push_back(child);
  }
  body.shape = add_shape(compound_shape(std::move(children)));
  set_frame(frame, body);
}

void GltfBodies::place_ghost(const BodyNodes &nodes, Body &body)
{
  body.shape = add_shape(sphere_shape(0.5f));
  body.filter_group = body.filter_mask = 0;
  set_frame(rigid_place(document_, nodes.body.node, nodes.body.world), body);
}

void GltfBodies::note_that_it_stands(const BodyNodes &nodes)
{
  scene_.notes.push_back(fmt::format("{}: moved by {} of the file, which is not played; it is a kinematic body that "
                                     "stands still",
                                     document_.place(nodes.body.node), nodes.moved_by));
}

void GltfBodies::add(const BodyNodes &nodes)
{
  const int node = nodes.body.node;
  Body body;
  body.name = document_.node(node).name;
  if (body.name.empty()) body.name = fmt::format("node {}", node);
  body.type = BodyType::fixed;
  body.trigger = nodes.trigger;
  if (nodes.colliders.empty()) place_ghost(nodes, body);
  else if (nodes.colliders.size() == 1) place_alone(nodes, body);
  else place_together(nodes, body);
  const GltfMover mover = nodes.moved_by ? GltfMover::file : GltfMover::physics;
  if (nodes.moves)
    read_gltf_motion(document_.physics_of(node)->member("motion"), nodes.body.world, mover, scene_, body);
  else if (nodes.moved_by) body.type = BodyType::kinematic;
  if (nodes.moved_by) note_that_it_stands(nodes);
  if (nodes.moves || !nodes.trigger) by_node_.emplace(node, uint32_t(scene_.bodies.size()));
  scene_.bodies.push_back(body);
}

} // namespace tandem
