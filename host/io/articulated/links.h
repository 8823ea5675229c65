/* links.h - a tree of links with joints, which the readers of URDF and MJCF make, and the bodies and joints of a scene
 * that it becomes.
 *
 *   link, welded to its parent      part of the parent's body; to the world: a fixed body for each of its shapes
 *   link with joints, or floating   a body, with the mass properties of itself and of what is welded to it
 *   link without mass, one child    none: its joints become the child's, before the child's own
 *   joints of one link              one joint of the scene, if their axes are those of one frame (joint_groups.h)
 *
 * In reduced coordinates each joint of a link is one of the scene, between bodies of little mass, and all of them are
 * articulations. Angles and ways of joints are 0 where the links stand. This is not a public header.
 */
#pragma once

#include <optional>

#include <tandem/load_scene.h>

#include "host/geometry/mass_properties.h"
#include "host/io/articulated/frame.h"
#include "host/io/xml/notes.h"

namespace tandem {

struct LinkShape {
  std::string name;
  Shape shape;
  RigidFrame pose; /* in the link's frame */
  uint32_t material = 0, filter_group = 1, filter_mask = 0xffffffffu;
};

struct LinkJoint {
  enum class Kind { hinge, slide, ball };
  std::string name;
  Kind kind = Kind::hinge;
  Vector at{0, 0, 0}, axis{0, 0, 1}; /* in the link's frame; the axis is of unit length */
  JointAxis settings;                /* of a ball: of each of its three rotations */
  double armature = 0;               /* kg m^2, or kg */
};

struct Link {
  static constexpr size_t world = size_t(-1);
  std::string name;
  int line = 0;
  size_t parent = world; /* index of an earlier link */
  RigidFrame pose;       /* in the parent's frame */
  bool floats = false;
  std::vector<LinkJoint> joints; /* from the parent outwards; none: welded, unless it floats */
  std::vector<LinkShape> shapes;
  std::optional<MassProperties> mass; /* in the link's frame */
  float gravity_factor = 1;           /* that of a body is its first link's */
};

/* Holds two links together beside the tree: a ball or a fixed joint. Link::world stands for the world. */
struct LinkConnection {
  std::string name;
  int line = 0;
  JointType type = JointType::ball;
  size_t link_a = Link::world, link_b = Link::world;
  RigidFrame a, b; /* in the links' frames */
};

/* One joint follows another: URDF's mimic, MJCF's equality of joints. The coordinate of the joint is offset + factor
 * times the other's; with a factor of 0 it is held, and `followed` may be empty. */
struct JointCoupling {
  int line = 0;
  std::string joint, followed, what; /* what: how the file calls it */
  double factor = 1, offset = 0;
};

/* Drives the axis of a joint, which is a hinge or a slide: the joint and the axis of `actuator` follow from its name,
 * and so does the way that its numbers count. */
struct LinkActuator {
  int line = 0;
  std::string joint, what; /* what: how the file calls it */
  Actuator actuator;
};

struct Robot {
  std::string file; /* begins messages */
  std::vector<Link> links;
  std::vector<LinkConnection> connections;
  std::vector<JointCoupling> couplings;
  std::vector<LinkActuator> actuators;
  Coordinates coordinates = Coordinates::maximal;
};

/* Adds the robot's bodies and joints to a scene without any. Throws InputError, file and line first, for a link that
 * cannot be a body: one without mass and with several children, or with moments that no solid has. */
void add_robot(const Robot &robot, XmlNotes &notes, Scene &scene);

} // namespace tandem
