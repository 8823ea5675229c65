/* joints.h - joints of MJCF bodies, and the actuators that drive them. This is not a public header. */
#pragma once

#include <optional>

#include "host/io/mjcf/compiler.h"

namespace tandem {

/* joint: completed by its class; outer: the frame in the link in which its place and axis are. `name` stands for it in
 * the scene. The type free is none of these: it says that the link floats. */
LinkJoint mjcf_joint(const XmlElement &joint, const MjcfCompiler &compiler, const RigidFrame &outer,
                     const std::string &name, XmlNotes &notes);

/* Where the joint's coordinate is as the file places the bodies: `ref`, in m or rad. */
double mjcf_reference(const XmlElement &joint, const MjcfCompiler &compiler);

/* An actuator whose control sets a number of the axis of its joint. */
struct MjcfActuator {
  LinkActuator driven; /* all but the map of position and velocity, which map_mjcf_control makes */
  double gear = 1;
  double rest = 0;    /* the control that is 0, or nearest to it in its range */
  float strength = 0; /* of position and velocity: the stiffness or damping that it adds to the axis */
};

/* Drives the joint as the actuator does at a control of 0, or the nearest to it in its range:
 *
 *   position   a spring of kp gear^2 and a damper of kv gear^2
 *   velocity   a damper of kv gear^2
 *   motor      exerts nothing; an axis without damping gets as much as a force needs to be set in a batch
 *
 * reference: that of the joint. What is not held of it is noted; nothing is returned if a control would do nothing. */
std::optional<MjcfActuator> drive_mjcf_joint(const XmlElement &actuator, const MjcfCompiler &compiler, double reference,
                                             LinkJoint &joint, XmlNotes &notes);

/* From the control of a position or velocity to the target of the axis, once all actuators have driven it: its spring
 * and its damper are the sums of all, and pull to the mean, of which a control moves its actuator's share. */
void map_mjcf_control(const JointAxis &axis, MjcfActuator &actuator);

} // namespace tandem
