/* joints.cpp - places attachment frames in bodies, and scales drives by what they move; see joints.h. */
#include "host/io/gltf/joints.h"

#include <fmt/format.h>

#include "host/geometry/rotation.h"
#include "host/io/gltf/moved_mass.h"

namespace tandem {

struct GltfJoints::Ends {
  int node_a, node_b;
  uint32_t body_a, body_b;
  RigidPlace a, b; /* of the attachment frames in the world */
  bool is_mirrored() const { return a.scale[0] < 0; }
};

namespace {

Rotation rotation_of(const Quat &q) { return unit(Rotation{q[0], q[1], q[2], q[3]}); }

/* A frame of the world in the axes of a body, from its centre of mass. */
void set_frame(const Scene &scene, uint32_t number, const Vector &at, const Rotation &axes, Point &position,
               Quat &orientation)
{
  Vector center;
  Rotation back{0, 0, 0, 1};
  if (number != no_body) {
    center = vector_of(scene.bodies[number].position);
    back = inverse(rotation_of(scene.bodies[number].orientation));
  }
  position = array_of(turn(back, at - center));
  const Rotation turned = unit(product_of(back, axes));
  for (size_t i = 0; i < 4; ++i) orientation[i] = round_to_float(turned[i]);
}

/* A drive in the mode "acceleration" is for each kg, or kg m², that it moves beside what the first part holds. */
void scale_drives(const Scene &scene, const GltfJointPart &part, const HoldingJoint &holds, Joint &joint)
{
  for (size_t k = 0; k < 6; ++k) {
    if (!part.acceleration[k]) continue;
    JointAxis &axis = k < 3 ? joint.directions[k] : joint.rotations[k - 3];
    const double mass = moved_mass(scene, joint, holds, k).value_or(0);
    axis.stiffness = round_to_float(mass * double{axis.stiffness});
    axis.damping = round_to_float(mass * double{axis.damping});
  }
}

} // namespace

uint32_t GltfJoints::body_at(int node) const
{
  const auto found = bodies_.find(frames_[size_t(node)].body_node);
  return found == bodies_.end() ? no_body : found->second;
}

GltfJoints::Ends GltfJoints::ends_of(int node, const JsonValue &joint) const
{
  const JsonValue connected = joint.member("connectedNode");
  const int other = gltf_index(connected, "node", document_.nodes.size());
  if (other == node) connected.fail("is the joint's own node; another one is needed");
  if (!frames_[size_t(other)].visited)
    connected.fail(fmt::format("{} is not in the scene that is simulated", document_.label(other)));
  const auto place = [&](int at) { return rigid_place(document_, at, frames_[size_t(at)].world, "joint"); };
  const Ends ends{node, other, body_at(node), body_at(other), place(node), place(other)};
  if (ends.is_mirrored() != (ends.b.scale[0] < 0))
    joint.fail(fmt::format("one of {} and {} is mirrored by a negative scale and the other is not, so they cannot be "
                           "in line; both or neither are needed",
                           document_.label(node), document_.label(other)));
  return ends;
}

void GltfJoints::check_bodies(const Ends &ends, const JsonValue &joint) const
{
  const auto has_motion = [&](int node) {
    const int body = frames_[size_t(node)].body_node;
    return body != GltfFrame::none && document_.physics_of(body)->find("motion").has_value();
  };
  if (!has_motion(ends.node_a) && !has_motion(ends.node_b))
    joint.fail(fmt::format("neither {} nor {} has a motion at or above it; a joint needs one",
                           document_.label(ends.node_a), document_.label(ends.node_b)));
  if (ends.body_a == ends.body_b)
    joint.fail(fmt::format("{} and {} are parts of one body, that of {}; a joint connects two",
                           document_.label(ends.node_a), document_.label(ends.node_b),
                           document_.label(frames_[size_t(ends.node_a)].body_node)));
}

/* A joint of bodies that nothing pushes would hold nothing. */
bool GltfJoints::can_hold(const Ends &ends, Scene &scene) const
{
  for (const uint32_t body : {ends.body_a, ends.body_b})
    if (body != no_body && scene.bodies[body].type == BodyType::dynamic) return true;
  scene.notes.push_back(fmt::format("{}: neither of the bodies of its joint moves freely; the joint is left out",
                                    document_.place(ends.node_a)));
  return false;
}

std::vector<GltfJointPart> GltfJoints::parts_of(const Ends &ends, const JsonValue &joint) const
{
  const JsonValue list = document_.extension(bodies_extension, document_.place(ends.node_a)).member("physicsJoints"),
                  chosen = joint.member("joint");
  const uint32_t index = chosen.unsigned_integer();
  if (index >= list.array_size())
    chosen.fail(fmt::format("joint {} does not exist; the file has {}", index, list.array_size()));
  const GltfJointDescription description = read_gltf_joint_description(list.element(index));
  return joint_parts_of(ends.is_mirrored() ? mirrored(description) : description);
}

Joint GltfJoints::placed(const GltfJointPart &part, const Ends &ends, const Scene &scene) const
{
  Joint joint = part.joint;
  joint.name = document_.node(ends.node_a).name;
  if (joint.name.empty()) joint.name = fmt::format("node {}", ends.node_a);
  joint.body_a = ends.body_a;
  joint.body_b = ends.body_b;
  const Vector shift = turn(ends.a.orientation, vector_of(part.shift));
  set_frame(scene, joint.body_a, vector_of(ends.a.position) + shift, product_of(ends.a.orientation, part.turn()),
            joint.position_a, joint.orientation_a);
  set_frame(scene, joint.body_b, vector_of(ends.b.position), product_of(ends.b.orientation, part.turn()),
            joint.position_b, joint.orientation_b);
  return joint;
}

void GltfJoints::add(int node, Scene &scene) const
{
  static constexpr const char *keys[] = {"connectedNode", "joint", "enableCollision", "extras", "extensions"};
  const JsonValue json = document_.physics_of(node)->member("joint");
  json.only_keys(keys);
  const Ends ends = ends_of(node, json);
  check_bodies(ends, json);
  const std::vector<GltfJointPart> parts = parts_of(ends, json);
  const std::optional<JsonValue> collide = json.find("enableCollision");
  const bool collides = collide && collide->boolean();
  if (!can_hold(ends, scene)) return;
  const HoldingJoint first{placed(parts.front(), ends, scene), parts.front().held_directions,
                           parts.front().held_rotations};
  for (const GltfJointPart &part : parts) {
    Joint joint = placed(part, ends, scene);
    joint.collide = collides;
    scale_drives(scene, part, first, joint);
    scene.joints.push_back(joint);
  }
}

} // namespace tandem
