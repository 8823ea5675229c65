/* joint_groups.h - one joint of a scene for all joints of a link.
 *
 * The joints of a link act one after the other, the first next to the parent. Hinges turn by R1 R2 R3, and a joint of a
 * scene by a swing after a twist about x:
 *
 *   one hinge, slide, ball    that joint
 *   two hinges                x is the second axis and y the first: swing about y, twist about x, the same rotation
 *   three hinges              x is the third axis, the swing is about the first two. It is R1 R2 but for a twist of
 *                             half the product of their angles
 *   slides, then hinges       directions of the same frame
 *
 * That needs axes at right angles which meet. This is not a public header.
 */
#pragma once

#include <optional>
#include <span>

#include "host/io/articulated/links.h"

namespace tandem {

/* The axis of a joint of the scene that one of the link's is, and whether it points the other way. */
struct GroupedAxis {
  size_t axis; /* 0 to 2: directions, 3 to 5: rotations */
  bool reversed;
};

struct GroupedJoint {
  Joint joint; /* type, what it holds, axes and name; its bodies and their frames are to be set */
  RigidFrame frame;
  std::vector<GroupedAxis> axes; /* of each of the joints; none of a ball */
  double gap = 0;                /* m: how far the axes of hinges pass each other; they meet halfway */
};

/* The places and axes of the links' joints are in the frame in which `frame` is. reach: the gap that is bridged, m.
 * Nothing if the axes are not those of one frame. One joint alone always gives one. */
std::optional<GroupedJoint> group_joints(std::span<const LinkJoint> joints, double reach);

} // namespace tandem
