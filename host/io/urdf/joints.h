/* joints.h - joints of URDF: what moves, between which limits, driven and braked by what. This is not a public
 * header. */
#pragma once

#include "host/io/articulated/parts.h"

namespace tandem {

/* The joints between a child link and its parent, in the child's frame: none if it is fixed or floating, three if it is
 * planar. Fails for an unknown type, for a <limit> that is missing, and for an axis of length 0. */
std::vector<LinkJoint> urdf_joints(const XmlElement &joint, XmlNotes &notes);

} // namespace tandem
