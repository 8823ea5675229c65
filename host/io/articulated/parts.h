/* parts.h - what both readers of robots make in the same way: limits of angles, hulls of mesh files, turns by angles of
 * a file. This is not a public header. */
#pragma once

#include "host/io/articulated/links.h"
#include "host/io/input_file.h"

namespace tandem {

/* Angles of a scene count from -pi to pi: a range of a turn or more is none, and what goes beyond a half turn ends
 * there, each with a note. Fails if nothing is left, or if the lower limit is above the upper one. */
void set_angle_limits(const XmlElement &element, double lower, double upper, XmlNotes &notes, JointAxis &axis);
void set_way_limits(const XmlElement &element, double lower, double upper, JointAxis &axis);

/* The convex hull of the points of an OBJ or STL file, multiplied axis by axis. Fails for another kind of file. */
Shape hull_of_file(const XmlElement &element, const std::string &name, const Vec3 &scale, OutsideFiles outside);
bool is_mesh_file(const std::string &name); /* by the end of its name */

/* An angle in radians that rotation_about takes; fails beyond 10^6. */
double checked_angle(const XmlElement &element, const char *key, double angle);

/* A positive number of at most longest_length; fails otherwise. `what` names it in the message. */
float checked_length(const XmlElement &element, const char *what, double length);

/* A unit vector; fails for one of length 0. */
Vector checked_axis(const XmlElement &element, const char *key, const Double3 &axis);

/* The mass properties of a solid of density 1 in its shape's frame, moved to another frame. */
MassProperties placed_mass(const MassProperties &mass, const RigidFrame &frame);

} // namespace tandem
