/* joints.cpp - the table of the types of joints, and the validation of joints. */
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "host/scene/axis_bits.h"
#include "host/scene/checker.h"
#include "host/scene/joint_rows.h"
#include "shared/joints/joint_codes.h"

namespace tandem {

std::span<const JointRow> joint_rows()
{
  static constexpr JointRow rows[] = {
#define JOINT(name, directions, rotations, what) {JointType::name, #name, what, directions, rotations},
#include "shared/joints.def"
#undef JOINT
  };
  static_assert([] {
    for (size_t k = 0; k < std::size(rows); ++k)
      if (static_cast<size_t>(rows[k].choice) != k) return false;
    return true;
  }());
  return rows;
}

std::span<const char *const> joint_type_names()
{
  static constexpr const char *names[] = {
#define JOINT(name, directions, rotations, what) #name,
#include "shared/joints.def"
#undef JOINT
  };
  return names;
}

const JointRow &row_of(JointType type) { return joint_rows()[static_cast<size_t>(type)]; }

namespace {

bool is_used(const JointAxis &axis) { return axis != JointAxis{}; }

std::array<const JointAxis *, 6> axes_of(const Joint &joint)
{
  return {&joint.directions[0], &joint.directions[1], &joint.directions[2],
          &joint.rotations[0],  &joint.rotations[1],  &joint.rotations[2]};
}

} // namespace

HeldAxes held_by(const Joint &joint)
{
  if (joint.type == JointType::six_dof) return {bits_of(joint.held_directions), bits_of(joint.held_rotations)};
  const JointRow &row = row_of(joint.type);
  return {row.directions, row.rotations};
}

std::array<uint32_t, 6> axis_kinds_of(const Joint &joint)
{
  std::array<uint32_t, 6> kinds{JOINT_AXIS_X,     JOINT_AXIS_Y,       JOINT_AXIS_Z,
                                JOINT_AXIS_TWIST, JOINT_AXIS_SWING_Y, JOINT_AXIS_SWING_Z};
  const HeldAxes held = held_by(joint);
  for (uint32_t k = 0; k < 3; ++k) {
    if ((held.directions >> k & 1u) != 0) kinds[k] = JOINT_AXIS_NONE;
    if ((held.rotations >> k & 1u) != 0) kinds[k + 3] = JOINT_AXIS_NONE;
  }
  if (joint.type == JointType::distance)
    kinds = {JOINT_AXIS_DISTANCE, JOINT_AXIS_NONE, JOINT_AXIS_NONE, JOINT_AXIS_NONE, JOINT_AXIS_NONE, JOINT_AXIS_NONE};
  if (joint.type == JointType::cone_twist) kinds[4] = JOINT_AXIS_CONE, kinds[5] = JOINT_AXIS_NONE;
  if (crosses(joint.type)) kinds[3] = JOINT_AXIS_TURN, kinds[4] = JOINT_AXIS_SPIN, kinds[5] = JOINT_AXIS_NONE;
  return kinds;
}

uint32_t kind_of_axis(const Joint &joint, size_t axis) { return axis_kinds_of(joint)[axis]; }

namespace {

/* The friction and the damper of a cone brake the way around it, too. A cone that is only limited has the row as well,
 * so that a call which gives it friction changes no tables. */
JointAxis around_cone(const JointAxis &cone)
{
  JointAxis around;
  around.friction = cone.friction;
  around.damping = cone.damping;
  if (around.damping > 0) around.max_force = cone.max_force;
  return around;
}

} // namespace

std::vector<UsedAxis> axes_used_by(const Joint &joint)
{
  const std::array<uint32_t, 6> kinds = axis_kinds_of(joint);
  const auto axes = axes_of(joint);
  std::vector<UsedAxis> used;
  for (size_t k = 0; k < kinds.size(); ++k)
    if (kinds[k] != JOINT_AXIS_NONE && is_used(*axes[k])) used.push_back({kinds[k], *axes[k]});
  if (joint.type == JointType::cone_twist && is_used(joint.rotations[1]))
    used.push_back({JOINT_AXIS_AROUND, around_cone(joint.rotations[1])});
  if (crosses(joint.type)) {
    JointAxis held;
    held.lower = held.upper = 0;
    used.push_back({JOINT_AXIS_CROSS, held});
  }
  return used;
}

bool holds_nothing(const Joint &joint) { return held_by(joint) == HeldAxes{0, 0} && axes_used_by(joint).empty(); }

namespace {

std::string names_of_types()
{
  std::string names;
  for (const JointRow &row : joint_rows()) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

void check_body(const char *field, uint32_t body, const Scene &scene, const Checker &check)
{
  if (body == no_body || body < scene.bodies.size()) return;
  check.fail(fmt::format("{} {} does not exist; the scene has {} bodies", field, body, scene.bodies.size()));
}

bool moves(uint32_t body, const Scene &scene)
{
  return body != no_body && scene.bodies[body].type == BodyType::dynamic;
}

/* A frame in a body is near it; one in the world may be as far as a body. */
void check_position(const char *field, const Point &position, uint32_t body, const Checker &check)
{
  check.within(field, position, body == no_body ? farthest : double{longest_length});
}

void check_break(const char *field, float limit, const Checker &check)
{
  if (!(limit > 0)) check.fail(fmt::format("{} is {}; more than 0 is needed, or infinity", field, limit));
}

void check_axis(const std::string &field, const JointAxis &axis, const Checker &check)
{
  const auto name = [&](const char *of) { return field + "." + of; };
  if (std::isnan(axis.lower) || std::isnan(axis.upper) || axis.lower > axis.upper)
    check.fail(fmt::format("{} is from {} to {}; a lower limit that is at most the upper one is needed", field,
                           axis.lower, axis.upper));
  check.finite(name("target_position").c_str(), axis.target_position);
  check.finite(name("target_velocity").c_str(), axis.target_velocity);
  check.at_least_zero(name("stiffness").c_str(), axis.stiffness);
  check.at_least_zero(name("friction").c_str(), axis.friction);
  check.at_least_zero(name("limit_stiffness").c_str(), axis.limit_stiffness);
  check.at_least_zero(name("limit_damping").c_str(), axis.limit_damping);
  check.at_least_zero(name("damping").c_str(), axis.damping);
  if (!(axis.restitution >= 0 && axis.restitution <= 1))
    check.fail(fmt::format("{} is {}; 0 to 1 is needed", name("restitution"), axis.restitution));
  if (axis.restitution > 0 && (axis.limit_stiffness > 0 || axis.lower == axis.upper))
    check.fail(fmt::format("{} is {}, which hard limits of a range alone have", name("restitution"), axis.restitution));
  if (axis.motor && (axis.stiffness > 0 || axis.damping > 0))
    check.fail(
        fmt::format("{} is a motor and has stiffness {} and damping {}; a motor has neither, because it holds its "
                    "velocity",
                    field, axis.stiffness, axis.damping));
  check.finite(name("force").c_str(), axis.force);
  if (axis.motor && axis.force != 0)
    check.fail(fmt::format("{} is a motor and has a force of {}; a motor has max_force alone", field, axis.force));
  if (!(axis.max_force >= 0))
    check.fail(fmt::format("{} is {}; at least 0 is needed, or infinity", name("max_force"), axis.max_force));
  check.speed(name("max_speed").c_str(), axis.max_speed);
}

/* Angles count from -pi to pi, so a limit on one side, or a range of a turn, would say nothing there. */
void check_range(const std::string &field, uint32_t kind, const JointAxis &axis, const Checker &check)
{
  constexpr float half_turn = 3.1415927f;
  const bool is_angle = kind >= JOINT_AXIS_TWIST && kind < JOINT_AXIS_CONE,
             has_none = std::isinf(axis.lower) && std::isinf(axis.upper) && axis.lower < axis.upper;
  if (!has_none && axis.lower == axis.upper && !(std::abs(axis.lower) <= longest_length))
    check.fail(fmt::format("{} is held at {}, where nothing can be", field, axis.lower));
  if (is_angle && !has_none && !(axis.lower >= -half_turn && axis.upper <= half_turn))
    check.fail(fmt::format("{} is from {} to {} rad; an angle has both limits, between -pi and pi, or none", field,
                           axis.lower, axis.upper));
  if ((kind == JOINT_AXIS_CONE || kind == JOINT_AXIS_DISTANCE) && axis.upper < 0)
    check.fail(fmt::format("{} is at most {}, and it is never below 0", field, axis.upper));
  if (axis.limit_damping > 0 && axis.limit_stiffness == 0)
    check.fail(fmt::format("{}.limit_damping is {} without a limit_stiffness; hard limits have none", field,
                           axis.limit_damping));
}

void check_axes(const Joint &joint, const Checker &check)
{
  static constexpr const char *fields[] = {"directions[0]", "directions[1]", "directions[2]",
                                           "rotations[0]",  "rotations[1]",  "rotations[2]"};
  const std::array<uint32_t, 6> kinds = axis_kinds_of(joint);
  const auto axes = axes_of(joint);
  for (size_t k = 0; k < kinds.size(); ++k) {
    if (kinds[k] == JOINT_AXIS_NONE && is_used(*axes[k]))
      check.fail(
          fmt::format("{} is not free in a joint of type {}; leave it away", fields[k], row_of(joint.type).name));
    check_axis(fields[k], *axes[k], check);
    check_range(fields[k], kinds[k], *axes[k], check);
  }
}

} // namespace

void validate(const Scene &scene, const Joint &joint, size_t index, const std::string &where)
{
  const Checker check{where, "joint", index, joint.name};
  if (static_cast<size_t>(joint.type) >= joint_rows().size())
    check.fail(fmt::format("unknown type; {} exist", names_of_types()));
  check_body("body_a", joint.body_a, scene, check);
  check_body("body_b", joint.body_b, scene, check);
  if (is_vacant(joint)) return;
  if (joint.body_a == joint.body_b)
    check.fail(joint.body_a == no_body ? "it connects the world with itself; name body_a or body_b"
                                       : fmt::format("it connects body {} with itself", joint.body_a));
  if (joint.enabled && !moves(joint.body_a, scene) && !moves(joint.body_b, scene))
    check.fail("neither of its bodies is dynamic, so it holds nothing; make one of them dynamic");
  check_position("position_a", joint.position_a, joint.body_a, check);
  check_position("position_b", joint.position_b, joint.body_b, check);
  check.unit("orientation_a", joint.orientation_a);
  check.unit("orientation_b", joint.orientation_b);
  check_break("break_force", joint.break_force, check);
  check_break("break_torque", joint.break_torque, check);
  const Axes none;
  if (joint.type != JointType::six_dof && (joint.held_directions != none || joint.held_rotations != none))
    check.fail(
        fmt::format("held_directions and held_rotations are of a six_dof joint; a joint of type {} holds what its "
                    "type says",
                    row_of(joint.type).name));
  const Axes &held = joint.held_rotations;
  if (held.x && !(held.y && held.z)) /* the lean of x says nothing of the turn about it: shared/joints/solve.h */
    check.fail("held_rotations have x without y and z; x is held together with both, or limited to one angle by "
               "rotations[0]");
  check_axes(joint, check);
}

} // namespace tandem
