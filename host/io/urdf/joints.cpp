/* joints.cpp - reads <axis>, <limit> and <dynamics>; see joints.h. */
#include "host/io/urdf/joints.h"

#include <fmt/format.h>

namespace tandem {
namespace {

Vector urdf_axis(const XmlElement &joint)
{
  const XmlElement *axis = joint.child("axis");
  if (!axis) return {1, 0, 0};
  return checked_axis(*axis, "xyz", axis->vector_or("xyz", {1, 0, 0}));
}

/* Effort bounds what a drive exerts, and velocity how fast it moves. Many files write 0 for no bound. */
void read_strength(const XmlElement &limit, JointAxis &axis, XmlNotes &notes)
{
  constexpr const char *known[] = {"lower", "upper", "effort", "velocity"};
  notes.add_other_attributes(limit, known);
  const double effort = limit.at_least_zero_or("effort", 0), velocity = limit.at_least_zero_or("velocity", 0);
  if (effort > 0) axis.max_force = round_to_float(effort);
  if (velocity > 0) axis.max_speed = round_to_float(velocity);
  for (const char *key : {"effort", "velocity"})
    if (limit.has(key) && *limit.number(key) == 0) notes.add(limit, fmt::format("{} of 0 is no limit", key));
}

void read_limit(const XmlElement &joint, const std::string &type, JointAxis &axis, XmlNotes &notes)
{
  const XmlElement *limit = joint.child("limit");
  const bool is_limited = type == "revolute" || type == "prismatic";
  if (!limit && is_limited) joint.fail(fmt::format("<limit> is missing; a joint of type {} needs one", type));
  if (!limit) return;
  read_strength(*limit, axis, notes);
  if (!is_limited) return;
  const double lower = limit->number_or("lower", 0), upper = limit->number_or("upper", 0);
  if (type == "revolute") set_angle_limits(*limit, lower, upper, notes, axis);
  else set_way_limits(*limit, lower, upper, axis);
}

void read_dynamics(const XmlElement &joint, JointAxis &axis, XmlNotes &notes)
{
  const XmlElement *dynamics = joint.child("dynamics");
  if (!dynamics) return;
  constexpr const char *known[] = {"damping", "friction"};
  notes.add_other_attributes(*dynamics, known);
  axis.damping = round_to_float(dynamics->at_least_zero_or("damping", 0));
  axis.friction = round_to_float(dynamics->at_least_zero_or("friction", 0));
}

/* A plane: its axis is the normal. */
std::vector<LinkJoint> planar_joints(const LinkJoint &normal)
{
  LinkJoint first = normal, second = normal, about = normal;
  first.kind = second.kind = LinkJoint::Kind::slide;
  first.axis = any_across(normal.axis);
  second.axis = normal.axis.cross(first.axis);
  about.kind = LinkJoint::Kind::hinge;
  about.settings = {};
  first.name += " x";
  second.name += " y";
  about.name += " angle";
  return {first, second, about};
}

} // namespace

std::vector<LinkJoint> urdf_joints(const XmlElement &joint, XmlNotes &notes)
{
  const std::string type = joint.needed_text("type");
  if (type == "fixed" || type == "floating") return {};
  if (type != "revolute" && type != "continuous" && type != "prismatic" && type != "planar")
    joint.fail(fmt::format("type is \"{}\"; revolute, continuous, prismatic, planar, floating and fixed exist", type));
  LinkJoint result;
  result.name = joint.needed_text("name");
  result.kind = type == "prismatic" || type == "planar" ? LinkJoint::Kind::slide : LinkJoint::Kind::hinge;
  result.axis = urdf_axis(joint);
  read_limit(joint, type, result.settings, notes);
  read_dynamics(joint, result.settings, notes);
  if (type == "planar") return planar_joints(result);
  return {result};
}

} // namespace tandem
