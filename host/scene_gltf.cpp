/* scene_gltf.cpp - from a glTF node tree to a flat list of bodies.
 *
 * The tree is walked once, depth first. A node with a motion becomes a body, and so does one with a collider that has no motion
 * above it; a collider below a motion belongs to that body:
 *
 *   node (motion)           -> body, frame in the node's place
 *     node                  ->   decoration
 *       node (collider)     ->   the body's shape; its pose in the body is that of this node
 *       node (motion) ...   -> a body of its own
 *
 * A trigger becomes a body as a collider does; one that lists nodes has its parts in these.
 *
 * The parts are read by scene_gltf_document, _transform, _shapes, _mesh, _materials, _filters and _motion, after the extension
 * texts KHR_implicit_shapes and KHR_physics_rigid_bodies (Khronos, drafts).
 */
#include "host/scene_gltf.h"

#include <fmt/format.h>
#include <map>
#include <set>

#include "host/geometry/shape_mass.h"
#include "host/scene_gltf_filters.h"
#include "host/scene_gltf_materials.h"
#include "host/scene_gltf_motion.h"
#include "host/scene_gltf_shapes.h"
#include "host/scene_gltf_transform.h"

namespace tandem {
namespace {

struct PlacedNode {
  int node;
  Transform world;
};

struct BodyNodes {
  PlacedNode body; /* the one with the motion, or the only collider or trigger, or the one that lists triggers */
  bool moves;
  bool trigger = false; /* then `colliders` are triggers */
  std::vector<PlacedNode> colliders = {};
  std::vector<PlacedNode> carried = {}; /* triggers below the motion */
};

/* --- the walk over the nodes ------------------------------------------------------------------ */

class Walk {
public:
  explicit Walk(const GltfDocument &document);
  std::vector<BodyNodes> bodies();

private:
  static constexpr size_t none = size_t(-1);
  struct Visit {
    int node;
    Transform parent;
    size_t body;   /* index into bodies_ of the motion above, or none */
    size_t list;   /* the same of the trigger above that lists nodes */
    bool animated; /* it, or a node above */
  };
  std::vector<int> root_nodes() const;
  void visit(const Visit &at);
  void add(const JsonValue &physics, Visit &below);
  void add_trigger(const JsonValue &trigger, Visit &at);
  void add_trigger_list(const JsonValue &trigger, Visit &at);
  void settle_triggers();

  const GltfDocument &document_;
  std::set<int> animated_, visited_;
  std::vector<Visit> pending_;
  std::vector<BodyNodes> bodies_;
  std::map<int, size_t> parts_; /* listed by a trigger and not met yet: which body they belong to */
};

Walk::Walk(const GltfDocument &document) : document_(document)
{
  for (const tinygltf::Animation &animation : document.model.animations)
    for (const tinygltf::AnimationChannel &channel : animation.channels)
      if (channel.target_path != "weights") animated_.insert(channel.target_node);
}

std::vector<int> Walk::root_nodes() const
{
  const tinygltf::Model &model = document_.model;
  if (!model.scenes.empty()) {
    int chosen = model.defaultScene < 0 ? 0 : model.defaultScene;
    if (size_t(chosen) >= model.scenes.size())
      throw InputError(fmt::format("{}: scene {} does not exist; the file has {}", document_.where, chosen, model.scenes.size()));
    return model.scenes[size_t(chosen)].nodes;
  }
  std::vector<bool> is_child(model.nodes.size());
  for (const tinygltf::Node &node : model.nodes)
    for (int child : node.children)
      if (child >= 0 && size_t(child) < is_child.size()) is_child[size_t(child)] = true;
  std::vector<int> roots;
  for (size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) roots.push_back(int(i));
  return roots;
}

/* `below` has the world transform of the node itself. */
void Walk::add(const JsonValue &physics, Visit &below)
{
  static constexpr const char *keys[] = {"motion", "collider", "trigger", "joint", "extras", "extensions"};
  physics.only_keys(keys);
  const bool has_motion = physics.find("motion").has_value(), has_collider = physics.find("collider").has_value();
  if (physics.find("joint")) physics.fail("a joint is not supported yet");
  const bool has_trigger = physics.find("trigger").has_value();
  if (!has_motion && !has_collider && !has_trigger) return;
  if (below.animated) physics.fail("an animated rigid body is not supported yet");
  const PlacedNode here{below.node, below.parent};
  if (has_motion) {
    below.body = bodies_.size();
    bodies_.push_back({here, true});
  }
  if (has_trigger) add_trigger(physics.member("trigger"), below);
  if (!has_collider || (!has_motion && is_scaled_to_nothing(here.world))) return; /* so scaled, the extension calls it disabled */
  if (below.body == none) bodies_.push_back({here, false, false, {here}});
  else bodies_[below.body].colliders.push_back(here);
}

void Walk::add_trigger(const JsonValue &trigger, Visit &at)
{
  static constexpr const char *keys[] = {"geometry", "nodes", "collisionFilter", "extras", "extensions"};
  trigger.only_keys(keys);
  if (trigger.find("nodes")) return add_trigger_list(trigger, at);
  trigger.member("geometry");
  const PlacedNode here{at.node, at.parent};
  const auto listed = parts_.find(at.node);
  const bool is_part = listed != parts_.end() && listed->second == at.list;
  if (is_part) parts_.erase(listed);
  if (is_scaled_to_nothing(here.world)) return;
  if (is_part) bodies_[at.list].colliders.push_back(here);
  else if (at.body != none) bodies_[at.body].carried.push_back(here);
  else bodies_.push_back({here, false, true, {here}});
}

/* Its parts come later in the walk, for they are below it. */
void Walk::add_trigger_list(const JsonValue &trigger, Visit &at)
{
  for (const char *key : {"geometry", "collisionFilter"})
    if (trigger.find(key)) trigger.fail(fmt::format("nodes and {} exclude each other", key));
  if (at.body != none) trigger.fail("a compound trigger that moves with a body is not supported yet");
  if (at.list != none) trigger.fail("a compound trigger below another is not supported yet");
  const JsonValue nodes = trigger.member("nodes");
  if (nodes.array_size() == 0) nodes.fail("is empty; at least one node is needed");
  for (size_t i = 0; i < nodes.array_size(); ++i)
    if (!parts_.emplace(int(nodes.element(i).unsigned_integer()), bodies_.size()).second) nodes.element(i).fail("is listed twice");
  at.list = bodies_.size();
  bodies_.push_back({{at.node, at.parent}, false, true});
}

/* A motion without a collider is the trigger's own; with one, the trigger would have to follow another body. */
void Walk::settle_triggers()
{
  if (!parts_.empty()) {
    const auto [part, whole] = *parts_.begin();
    document_.require_node(part);
    document_.refuse(bodies_[whole].body.node, fmt::format("trigger.nodes lists {}, which is no node below it with a trigger geometry", document_.label(part)));
  }
  for (BodyNodes &nodes : bodies_) {
    if (nodes.carried.empty()) continue;
    if (!nodes.colliders.empty())
      document_.refuse(nodes.carried.front().node, fmt::format("a trigger that moves with the colliders of {} is not supported yet", document_.label(nodes.body.node)));
    nodes.trigger = true;
    nodes.colliders = nodes.carried;
  }
  std::erase_if(bodies_, [](const BodyNodes &nodes) { return nodes.trigger && nodes.colliders.empty(); }); /* all parts disabled */
}

void Walk::visit(const Visit &at)
{
  document_.require_node(at.node);
  if (!visited_.insert(at.node).second) document_.refuse(at.node, "has two parents; a node tree is needed");
  Visit below = at;
  below.parent = at.parent * local_transform(document_, at.node);
  below.animated |= animated_.count(at.node) > 0;
  const nlohmann::json extensions = document_.extensions_of(at.node);
  const std::string where = document_.place(at.node);
  if (extensions.contains(bodies_extension)) add(JsonValue(extensions[bodies_extension], where), below);
  const std::vector<int> &children = document_.node(at.node).children;
  for (auto child = children.rbegin(); child != children.rend(); ++child) {
    below.node = *child;
    pending_.push_back(below);
  }
}

std::vector<BodyNodes> Walk::bodies()
{
  std::vector<int> roots = root_nodes();
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) pending_.push_back({*root, {}, none, none, false});
  while (!pending_.empty()) {
    Visit next = pending_.back();
    pending_.pop_back();
    visit(next);
  }
  settle_triggers();
  return std::move(bodies_);
}

/* --- one body --------------------------------------------------------------------------------- */

class Assembly {
public:
  explicit Assembly(const GltfDocument &document);
  Assembly(const Assembly &) = delete;
  void add_body(const BodyNodes &nodes);
  Scene take() { return std::move(scene_); }

private:
  void require_one_collider(const BodyNodes &nodes) const;
  void place(const BodyNodes &nodes, const JsonValue &geometry, Body &body);
  void read_material(const JsonValue &collider, Body &body) const;
  void read_filter(const JsonValue &collider, Body &body) const;

  const GltfDocument &document_;
  Scene scene_;
  GltfShapes shapes_; /* adds to the scene's */
  std::vector<GltfFilter> filters_;
};

Assembly::Assembly(const GltfDocument &document) : document_(document), shapes_(document, scene_.shapes)
{
  JsonValue bodies(document.bodies, document.where, std::string("extensions.") + bodies_extension);
  static constexpr const char *keys[] = {"physicsMaterials", "collisionFilters", "physicsJoints", "extras", "extensions"};
  bodies.only_keys(keys);
  scene_.name = document.where;
  scene_.gravity = {0, -9.81f, 0};
  scene_.materials = read_gltf_materials(bodies);
  filters_ = read_gltf_filters(bodies);
}

void Assembly::require_one_collider(const BodyNodes &nodes) const
{
  if (nodes.colliders.size() == 1) return;
  if (nodes.colliders.empty()) document_.refuse(nodes.body.node, "a motion without a collider (a body without shape) is not supported yet");
  const std::string first = document_.label(nodes.colliders[0].node), second = document_.label(nodes.colliders[1].node);
  document_.refuse(nodes.body.node, fmt::format("a compound of {} {}s ({}, {}{}) is not supported yet; one is", nodes.colliders.size(),
                                                nodes.trigger ? "trigger" : "collider", first, second, nodes.colliders.size() > 2 ? ", ..." : ""));
}

/* The shape where its node is, the body's frame where the node with the motion is. */
void Assembly::place(const BodyNodes &nodes, const JsonValue &geometry, Body &body)
{
  const PlacedNode &collider = nodes.colliders.front();
  const RigidPlace frame = rigid_place(document_, nodes.body.node, nodes.body.world), at = rigid_place(document_, collider.node, collider.world);
  const GltfShape shape = shapes_.read(geometry, at.scale);
  body.shape = shape.index;
  const Double3 lifted = turned(at.orientation, {0, shape.offset, 0});
  for (size_t axis = 0; axis < 3; ++axis) body.position[axis] = at.position[axis] + lifted[axis];
  for (size_t i = 0; i < 4; ++i) body.orientation[i] = float(at.orientation[i]);
  const bool apart = nodes.moves && collider.node != nodes.body.node;
  if (apart && scene_.shapes[body.shape].type == ShapeType::half_space)
    document_.refuse(collider.node, fmt::format("a plane below the motion of {} is not supported yet", document_.label(nodes.body.node)));
  if (apart || shape.offset != 0) move_frame(body, frame.position, frame.orientation);
}

void Assembly::read_material(const JsonValue &collider, Body &body) const
{
  std::optional<JsonValue> material = collider.find("physicsMaterial");
  if (!material) return;
  body.material = material->unsigned_integer() + 1;
  if (body.material == 0 || body.material >= scene_.materials.size())
    material->fail(fmt::format("material {} does not exist; the file has {}", material->unsigned_integer(), scene_.materials.size() - 1));
}

void Assembly::read_filter(const JsonValue &collider, Body &body) const
{
  std::optional<JsonValue> filter = collider.find("collisionFilter");
  if (!filter) return;
  uint32_t chosen = filter->unsigned_integer();
  if (chosen >= filters_.size()) filter->fail(fmt::format("filter {} does not exist; the file has {}", chosen, filters_.size()));
  body.filter_group = filters_[chosen].group;
  body.filter_mask = filters_[chosen].mask;
}

void Assembly::add_body(const BodyNodes &nodes)
{
  static constexpr const char *collider_keys[] = {"geometry", "physicsMaterial", "collisionFilter", "extras", "extensions"};
  static constexpr const char *trigger_keys[] = {"geometry", "collisionFilter", "extras", "extensions"};
  require_one_collider(nodes);
  const int node = nodes.body.node, collider_node = nodes.colliders.front().node;
  const nlohmann::json own = document_.extensions_of(node), of_collider = document_.extensions_of(collider_node);
  const std::string where = document_.place(node), collider_where = document_.place(collider_node);
  const JsonValue collider = JsonValue(of_collider[bodies_extension], collider_where).member(nodes.trigger ? "trigger" : "collider");
  if (nodes.trigger) collider.only_keys(trigger_keys);
  else collider.only_keys(collider_keys);
  Body body;
  body.name = document_.node(node).name;
  if (body.name.empty()) body.name = fmt::format("node {}", node);
  body.motion = Motion::fixed;
  body.trigger = nodes.trigger;
  place(nodes, collider.member("geometry"), body);
  read_material(collider, body);
  read_filter(collider, body);
  if (nodes.moves) read_gltf_motion(JsonValue(own[bodies_extension], where).member("motion"), nodes.body.world, scene_, body);
  scene_.bodies.push_back(body);
}

} // namespace

Scene read_scene_gltf(const std::string &path)
{
  const GltfDocument document = read_gltf_document(path);
  Assembly assembly(document);
  for (const BodyNodes &nodes : Walk(document).bodies()) assembly.add_body(nodes);
  Scene scene = assembly.take();
  if (scene.bodies.empty())
    throw InputError(fmt::format("{}: no node has a collider or a trigger ({}); there is nothing to simulate", path, bodies_extension));
  validate(scene, path);
  return scene;
}

} // namespace tandem
