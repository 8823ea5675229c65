/* scene.cpp - from a glTF node tree to a flat list of bodies; see scene.h.
 *
 * The tree is walked once, depth first. A node with a motion becomes a body, and so does one with a collider that has
 * no motion above it; a collider below a motion belongs to that body:
 *
 *   node (motion)           -> body, frame at the node
 *     node                  ->   no effect
 *       node (collider)     ->   the body's shape, or one of several; its pose in the body is that of this node
 *       node (motion) ...   -> a body of its own
 *
 * A trigger becomes a body as a collider does; one that lists nodes consists of the triggers of these nodes.
 *
 * The other files of this folder read the parts, following the extension texts KHR_implicit_shapes and
 * KHR_physics_rigid_bodies (Khronos, drafts). */
#include "host/io/gltf/scene.h"

#include <map>
#include <set>

#include <fmt/format.h>

#include "host/io/gltf/animation.h"
#include "host/io/gltf/body.h"
#include "host/io/gltf/joints.h"

namespace tandem {
namespace {

class Walk {
public:
  explicit Walk(const GltfDocument &document) : document_(document), frames_(document.nodes.size()) {}
  std::vector<BodyNodes> bodies();
  const std::vector<GltfFrame> &frames() const { return frames_; } /* of each node, after the walk */
  const std::vector<std::string> &notes() const { return notes_; }
  const std::vector<int> &joint_nodes() const { return joint_nodes_; } /* in the order of the walk */

private:
  static constexpr size_t none = size_t(-1);
  struct Visit {
    int node;
    Transform parent;
    size_t body;                     /* index into bodies_ of the motion above, or none */
    size_t list;                     /* the same of the trigger above that lists nodes */
    bool animated;                   /* it, or a node above, up to the next motion */
    int body_node = GltfFrame::none; /* of GltfFrame */
  };
  void visit(const Visit &at);
  void add(const JsonValue &physics, Visit &below);
  static const char *mover_of(const Visit &at);
  void add_motion(const PlacedNode &here, Visit &below);
  void add_part(const PlacedNode &here, bool animated, std::vector<PlacedNode> &parts);
  void add_trigger(const JsonValue &trigger, Visit &at);
  void add_trigger_list(const JsonValue &trigger, Visit &at);
  void settle_triggers();

  const GltfDocument &document_;
  std::set<int> visited_;
  std::vector<Visit> pending_;
  std::vector<BodyNodes> bodies_;
  std::vector<std::string> notes_;
  std::vector<GltfFrame> frames_;
  std::vector<int> joint_nodes_;
  std::map<int, size_t> parts_; /* listed by a trigger and not visited yet: the body they belong to */
};

/* `below` has the world transform of the node itself. */
void Walk::add(const JsonValue &physics, Visit &below)
{
  static constexpr const char *keys[] = {"motion", "collider", "trigger", "joint", "extras", "extensions"};
  physics.only_keys(keys);
  const bool has_motion = physics.find("motion").has_value(), has_collider = physics.find("collider").has_value();
  if (physics.find("joint")) joint_nodes_.push_back(below.node);
  const bool has_trigger = physics.find("trigger").has_value();
  if (!has_motion && !has_collider && !has_trigger) return;
  const PlacedNode here{below.node, below.parent};
  if (has_motion) add_motion(here, below);
  if (has_trigger) add_trigger(physics.member("trigger"), below);
  if (!has_collider || (!has_motion && is_scaled_to_nothing(here.world)))
    return; /* the extension calls a collider of this scale disabled */
  if (below.body != none) return add_part(here, below.animated, bodies_[below.body].colliders);
  below.body_node = below.node;
  bodies_.push_back({here, false, false, mover_of(below), {here}});
}

const char *Walk::mover_of(const Visit &at) { return at.animated ? "an animation" : nullptr; }

/* A skinned mesh follows the skin, and not its node. What is below a motion is animated if it moves in the body. */
void Walk::add_motion(const PlacedNode &here, Visit &below)
{
  const char *mover = mover_of(below);
  if (!mover && document_.node(here.node).has_skin) mover = "a skin";
  below.body_node = below.node;
  below.body = bodies_.size();
  below.animated = false;
  bodies_.push_back({here, true, false, mover});
}

void Walk::add_part(const PlacedNode &here, bool animated, std::vector<PlacedNode> &parts)
{
  parts.push_back(here);
  if (animated)
    notes_.push_back(fmt::format("{}: moved by an animation within its body, which is not played; it stands at its "
                                 "first key",
                                 document_.place(here.node)));
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
  if (is_part) add_part(here, at.animated, bodies_[at.list].colliders);
  else if (at.body != none) add_part(here, at.animated, bodies_[at.body].carried);
  else bodies_.push_back({here, false, true, mover_of(at), {here}});
}

/* The parts of the trigger come later in the walk, because they are below it. */
void Walk::add_trigger_list(const JsonValue &trigger, Visit &at)
{
  for (const char *key : {"geometry", "collisionFilter"})
    if (trigger.find(key)) trigger.fail(fmt::format("nodes and {} exclude each other", key));
  if (at.body != none) trigger.fail("a compound trigger that moves with a body is not supported yet");
  if (at.list != none) trigger.fail("a compound trigger below another is not supported yet");
  const JsonValue nodes = trigger.member("nodes");
  if (nodes.array_size() == 0) nodes.fail("is empty; at least one node is needed");
  for (size_t i = 0; i < nodes.array_size(); ++i)
    if (!parts_.emplace(gltf_index(nodes.element(i), "node", document_.nodes.size()), bodies_.size()).second)
      nodes.element(i).fail("is listed twice");
  at.list = bodies_.size();
  bodies_.push_back({{at.node, at.parent}, false, true, mover_of(at)});
  at.animated = false;
}

/* A motion without a collider is the trigger's own; with a collider, the trigger would have to follow another body. */
void Walk::settle_triggers()
{
  if (!parts_.empty()) {
    const auto [part, whole] = *parts_.begin();
    document_.refuse(bodies_[whole].body.node,
                     fmt::format("trigger.nodes lists {}, which is no node below it with a trigger geometry",
                                 document_.label(part)));
  }
  for (BodyNodes &nodes : bodies_) {
    if (nodes.carried.empty()) continue;
    if (!nodes.colliders.empty())
      document_.refuse(nodes.carried.front().node,
                       fmt::format("a trigger that moves with the colliders of {} is not supported yet",
                                   document_.label(nodes.body.node)));
    nodes.trigger = true;
    nodes.colliders = nodes.carried;
  }
  std::erase_if(bodies_, [](const BodyNodes &nodes) {
    return nodes.trigger && nodes.colliders.empty();
  }); /* all parts disabled */
}

void Walk::visit(const Visit &at)
{
  if (!visited_.insert(at.node).second) document_.refuse(at.node, "has two parents; a node tree is needed");
  Visit below = at;
  below.parent = at.parent * local_transform(document_, at.node);
  below.animated |= document_.animated.count(at.node) > 0;
  if (const auto physics = document_.physics_of(at.node)) add(*physics, below);
  frames_[size_t(at.node)] = {below.parent, below.body_node, true};
  const std::vector<int> &children = document_.node(at.node).children;
  for (auto child = children.rbegin(); child != children.rend(); ++child) {
    below.node = *child;
    pending_.push_back(below);
  }
}

std::vector<BodyNodes> Walk::bodies()
{
  const std::vector<int> &roots = document_.roots;
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) pending_.push_back({*root, {}, none, none, false});
  while (!pending_.empty()) {
    Visit next = pending_.back();
    pending_.pop_back();
    visit(next);
  }
  settle_triggers();
  return std::move(bodies_);
}

} // namespace

Scene read_scene_gltf(const std::string &path, OutsideFiles outside)
{
  GltfDocument document = read_gltf_document(path, outside);
  stand_at_first_keys(document);
  GltfBodies bodies(document);
  Walk walk(document);
  for (const BodyNodes &nodes : walk.bodies()) bodies.add(nodes);
  Scene scene = bodies.take();
  scene.notes.insert(scene.notes.end(), walk.notes().begin(), walk.notes().end());
  const GltfJoints joints(document, walk.frames(), bodies.by_node());
  for (const int node : walk.joint_nodes()) joints.add(node, scene);
  if (scene.bodies.empty())
    throw InputError(fmt::format("{}: no node has a collider or a trigger ({}); there is nothing to simulate", path,
                                 bodies_extension));
  validate(scene, path);
  return scene;
}

} // namespace tandem
