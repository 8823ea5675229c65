/* geometry.h - collision shapes, poses and inertias of URDF links. This is not a public header. */
#pragma once

#include "host/io/articulated/parts.h"

namespace tandem {

/* The <origin> of an element: xyz, and rpy, which turns about x, then y, then z of the outer frame. */
RigidFrame urdf_origin(const XmlElement &element);

/* The shapes of a link's <collision> elements. A mesh that does not exist beside the file, or of a kind that is not
 * read, is noted and left out. */
std::vector<LinkShape> urdf_shapes(const XmlElement &link, OutsideFiles outside, XmlNotes &notes);

/* The <inertial> of a link; nothing if there is none, or its mass is 0. */
std::optional<MassProperties> urdf_mass(const XmlElement &link, XmlNotes &notes);

} // namespace tandem
