/* joints.cpp - reads <joint> and the children of <actuator>; see joints.h. */
#include "host/io/mjcf/joints.h"

#include <algorithm>

#include <fmt/format.h>

namespace tandem {
namespace {

constexpr const char *joint_attributes[] = {"name",
                                            "class",
                                            "type",
                                            "pos",
                                            "axis",
                                            "range",
                                            "limited",
                                            "ref",
                                            "springref",
                                            "stiffness",
                                            "damping",
                                            "frictionloss",
                                            "armature",
                                            "actuatorfrcrange",
                                            "actuatorfrclimited"};
constexpr const char *actuator_attributes[] = {"name", "class",       "joint",     "gear",         "kp",
                                               "kv",   "ctrllimited", "ctrlrange", "forcelimited", "forcerange"};

/* A spring or damper is a strength and where it pulls to. Two of them are one with the sum of the strengths, which
 * pulls to the mean. */
void add_pull(float &strength, float &target, double more, double towards)
{
  const double sum = double{strength} + more;
  if (!(sum > 0)) return;
  target = round_to_float((double{strength} * double{target} + more * towards) / sum);
  strength = round_to_float(sum);
}

std::pair<double, double> range_of(const XmlElement &element, const char *key)
{
  const std::vector<double> range = element.numbers(key, 2, 2);
  if (range[0] > range[1])
    element.fail(
        fmt::format("{} is from {:g} to {:g}; the lower one must be at most the upper one", key, range[0], range[1]));
  return {range[0], range[1]};
}

/* The largest size in a range. */
double largest_in(const std::pair<double, double> &range)
{
  return std::max(std::abs(range.first), std::abs(range.second));
}

void bound_force(double force, JointAxis &axis) { axis.max_force = std::min(axis.max_force, round_to_float(force)); }

void read_range(const XmlElement &joint, const MjcfCompiler &compiler, LinkJoint &result, XmlNotes &notes)
{
  if (!compiler.is_limited(joint, "limited", "range")) return;
  if (result.kind == LinkJoint::Kind::ball) return notes.add(joint, "range of a ball <joint> is not held");
  const auto [lower, upper] = range_of(joint, "range");
  const double reference = mjcf_reference(joint, compiler);
  if (result.kind == LinkJoint::Kind::slide)
    return set_way_limits(joint, lower - reference, upper - reference, result.settings);
  set_angle_limits(joint, compiler.angle(lower) - reference, compiler.angle(upper) - reference, notes, result.settings);
}

void read_passive(const XmlElement &joint, const MjcfCompiler &compiler, LinkJoint &result)
{
  JointAxis &axis = result.settings;
  const bool slides = result.kind == LinkJoint::Kind::slide;
  const double written = joint.number_or("springref", 0), rest = slides ? written : compiler.angle(written);
  const double stiffness = joint.at_least_zero_or("stiffness", 0);
  add_pull(axis.stiffness, axis.target_position, stiffness, rest - mjcf_reference(joint, compiler));
  if (result.kind == LinkJoint::Kind::ball) axis.target_position = 0;
  axis.damping = round_to_float(joint.at_least_zero_or("damping", 0));
  result.armature = joint.at_least_zero_or("armature", 0);
  axis.friction = round_to_float(joint.at_least_zero_or("frictionloss", 0));
  if (compiler.is_limited(joint, "actuatorfrclimited", "actuatorfrcrange"))
    bound_force(largest_in(range_of(joint, "actuatorfrcrange")), axis);
}

/* The first of up to six numbers: the others are of sites and of balls. */
double gear_of(const XmlElement &actuator, XmlNotes &notes)
{
  const std::vector<double> gear = actuator.numbers("gear", 1, 6);
  if (std::any_of(gear.begin() + (gear.empty() ? 0 : 1), gear.end(), [](double x) { return x != 0; }))
    notes.add(actuator, fmt::format("gear of <{}> beyond its first number is not held", actuator.name));
  return gear.empty() ? 1 : gear.front();
}

/* The control that is 0, or nearest to it. */
double control_of(const XmlElement &actuator, const MjcfCompiler &compiler)
{
  if (!compiler.is_limited(actuator, "ctrllimited", "ctrlrange")) return 0;
  const auto [lower, upper] = range_of(actuator, "ctrlrange");
  return std::clamp(0.0, lower, upper);
}

} // namespace

double mjcf_reference(const XmlElement &joint, const MjcfCompiler &compiler)
{
  const double written = joint.number_or("ref", 0);
  return joint.text("type").value_or("hinge") == "hinge" ? compiler.angle(written) : written;
}

LinkJoint mjcf_joint(const XmlElement &joint, const MjcfCompiler &compiler, const RigidFrame &outer,
                     const std::string &name, XmlNotes &notes)
{
  notes.add_other_attributes(joint, joint_attributes);
  const std::string type = joint.text("type").value_or("hinge");
  LinkJoint result;
  result.name = name;
  if (type == "slide") result.kind = LinkJoint::Kind::slide;
  else if (type == "ball") result.kind = LinkJoint::Kind::ball;
  else if (type != "hinge") joint.fail(fmt::format("type is \"{}\"; free, ball, slide and hinge exist", type));
  result.at = outer * vector_of(joint.vector_or("pos", {0, 0, 0}));
  result.axis = turn(outer.rotation, checked_axis(joint, "axis", joint.vector_or("axis", {0, 0, 1})));
  read_range(joint, compiler, result, notes);
  read_passive(joint, compiler, result);
  return result;
}

void drive_mjcf_joint(const XmlElement &actuator, const MjcfCompiler &compiler, double reference, LinkJoint &joint,
                      XmlNotes &notes)
{
  notes.add_other_attributes(actuator, actuator_attributes);
  if (joint.kind == LinkJoint::Kind::ball)
    return notes.add(actuator, fmt::format("<{}> of a ball joint is not held", actuator.name));
  const double gear = gear_of(actuator, notes), squared = gear * gear, control = control_of(actuator, compiler);
  JointAxis &axis = joint.settings;
  const bool places = actuator.name == "position";
  const double stiffness = places ? actuator.at_least_zero_or("kp", 1) * squared : 0;
  const double damping = actuator.name == "motor" ? 0 : actuator.at_least_zero_or("kv", places ? 0 : 1) * squared;
  if (gear != 0) {
    add_pull(axis.stiffness, axis.target_position, stiffness, control / gear - reference);
    add_pull(axis.damping, axis.target_velocity, damping, places ? 0 : control / gear);
  }
  if (actuator.name == "motor")
    return notes.add(actuator, "a <motor> exerts nothing by itself; a program sets JointAxis::force");
  if (compiler.is_limited(actuator, "forcelimited", "forcerange"))
    bound_force(std::abs(gear) * largest_in(range_of(actuator, "forcerange")), axis);
}

} // namespace tandem
