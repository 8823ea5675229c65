/* joints.h - joints of MJCF bodies, and the actuators that drive them. This is not a public header. */
#pragma once

#include "host/io/mjcf/compiler.h"

namespace tandem {

/* joint: completed by its class; outer: the frame in the link in which its place and axis are. `name` stands for it in
 * the scene. The type free is none of these: it says that the link floats. */
LinkJoint mjcf_joint(const XmlElement &joint, const MjcfCompiler &compiler, const RigidFrame &outer,
                     const std::string &name, XmlNotes &notes);

/* Where the joint's coordinate is as the file places the bodies: `ref`, in m or rad. */
double mjcf_reference(const XmlElement &joint, const MjcfCompiler &compiler);

/* An actuator of a joint, at a control of 0 or the nearest to it in its range:
 *
 *   position   a spring of kp gear^2 and a damper of kv gear^2
 *   velocity   a damper of kv gear^2
 *   motor      exerts nothing; the largest force of its range bounds the axis
 *
 * reference: that of the joint. What is not held of it is noted. */
void drive_mjcf_joint(const XmlElement &actuator, const MjcfCompiler &compiler, double reference, LinkJoint &joint,
                      XmlNotes &notes);

} // namespace tandem
