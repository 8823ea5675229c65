/* joints.cpp - reads <joint> and the children of <actuator>; see joints.h. */
#include "host/io/mjcf/joints.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/* A batch sets forces of axes with damping alone (Worlds::choose_controls). What an axis gets for that brakes next to
 * nothing: at 1 m/s or rad/s this share of the largest force, s/m or s/rad. Ten times that force can be set. */
constexpr double damping_of_motor = 1e-11;
constexpr double control_of_unlimited_motor = 1000;
constexpr double least_bound_of_motor = 1, largest_bound_of_motor = 1e5; /* N, or N m */

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

/* Of a control, or of a force. */
std::pair<double, double> range_or_unlimited(const XmlElement &actuator, const MjcfCompiler &compiler,
                                             const char *limited, const char *range)
{
  const double infinity = std::numeric_limits<double>::infinity();
  return compiler.is_limited(actuator, limited, range) ? range_of(actuator, range) : std::pair(-infinity, infinity);
}

MjcfActuator named_actuator(const XmlElement &actuator, const MjcfCompiler &compiler, XmlNotes &notes)
{
  const std::string name = actuator.text("name").value_or("");
  MjcfActuator result;
  result.driven.line = actuator.line;
  result.driven.joint = actuator.text("joint").value_or("");
  result.driven.what =
      name.empty() ? fmt::format("a <{}>", actuator.name) : fmt::format("<{}> \"{}\"", actuator.name, name);
  result.driven.actuator.name = name;
  const auto [lower, upper] = range_or_unlimited(actuator, compiler, "ctrllimited", "ctrlrange");
  result.driven.actuator.lower = round_to_float(lower);
  result.driven.actuator.upper = round_to_float(upper);
  result.gear = gear_of(actuator, notes);
  result.rest = std::clamp(0.0, lower, upper);
  return result;
}

/* Its force is the control times the gear. That of a motor is bounded before the gear, as the control is. */
void drive_by_motor(const XmlElement &element, const MjcfCompiler &compiler, MjcfActuator &motor, JointAxis &axis)
{
  Actuator &actuator = motor.driven.actuator;
  const auto [lower, upper] = range_or_unlimited(element, compiler, "forcelimited", "forcerange");
  actuator.sets = Control::force;
  actuator.factor = round_to_float(motor.gear);
  actuator.lower = std::clamp(actuator.lower, round_to_float(lower), round_to_float(upper));
  actuator.upper = std::clamp(actuator.upper, round_to_float(lower), round_to_float(upper));
  const double most = largest_in({double{actuator.lower}, double{actuator.upper}});
  const double bound = std::clamp(std::abs(motor.gear) * (std::isfinite(most) ? most : control_of_unlimited_motor),
                                  least_bound_of_motor, largest_bound_of_motor);
  axis.damping = std::max(axis.damping, round_to_float(damping_of_motor * bound));
}

void drive_by_servo(const XmlElement &element, const MjcfCompiler &compiler, double reference, MjcfActuator &servo,
                    JointAxis &axis)
{
  const bool places = element.name == "position";
  const double squared = servo.gear * servo.gear, target = servo.rest / servo.gear;
  const double stiffness = places ? element.at_least_zero_or("kp", 1) * squared : 0;
  const double damping = element.at_least_zero_or("kv", places ? 0 : 1) * squared;
  add_pull(axis.stiffness, axis.target_position, stiffness, target - reference);
  add_pull(axis.damping, axis.target_velocity, damping, places ? 0 : target);
  if (compiler.is_limited(element, "forcelimited", "forcerange"))
    bound_force(std::abs(servo.gear) * largest_in(range_of(element, "forcerange")), axis);
  servo.driven.actuator.sets = places ? Control::target_position : Control::target_velocity;
  servo.strength = round_to_float(places ? stiffness : damping);
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

std::optional<MjcfActuator> drive_mjcf_joint(const XmlElement &actuator, const MjcfCompiler &compiler, double reference,
                                             LinkJoint &joint, XmlNotes &notes)
{
  notes.add_other_attributes(actuator, actuator_attributes);
  const auto leave_out = [&](const std::string &why) -> std::optional<MjcfActuator> {
    notes.add(actuator, why);
    return {};
  };
  if (joint.kind == LinkJoint::Kind::ball)
    return leave_out(fmt::format("<{}> of a ball joint is not held", actuator.name));
  const bool is_motor = actuator.name == "motor";
  MjcfActuator result = named_actuator(actuator, compiler, notes);
  if (result.gear == 0) return leave_out(fmt::format("{} has a gear of 0, so it does nothing", result.driven.what));
  if (is_motor) drive_by_motor(actuator, compiler, result, joint.settings);
  else drive_by_servo(actuator, compiler, reference, result, joint.settings);
  if (!is_motor && result.strength == 0)
    return leave_out(fmt::format("the control of {} does nothing, because its {} is 0", result.driven.what,
                                 actuator.name == "position" ? "stiffness, kp gear^2," : "damping, kv gear^2,"));
  if (is_motor) notes.add(actuator, "a <motor> exerts nothing until a program sets its control");
  return result;
}

void map_mjcf_control(const JointAxis &axis, MjcfActuator &actuator)
{
  Actuator &driven = actuator.driven.actuator;
  if (driven.sets == Control::force) return;
  const bool places = driven.sets == Control::target_position;
  const double whole = double{places ? axis.stiffness : axis.damping};
  const double target = double{places ? axis.target_position : axis.target_velocity};
  const double factor = double{actuator.strength} / whole / actuator.gear;
  driven.factor = round_to_float(factor);
  driven.offset = round_to_float(target - factor * actuator.rest);
}

} // namespace tandem
