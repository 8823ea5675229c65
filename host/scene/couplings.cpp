/* couplings.cpp - the rows of couplings, and their validation. */
#include <cmath>
#include <iterator>

#include "host/scene/checker.h"
#include "host/scene/coupling_rows.h"
#include "host/scene/joint_rows.h"
#include "shared/joints/joint_codes.h"

namespace tandem {

std::span<const char *const> coupling_type_names()
{
  static constexpr const char *names[] = {"gear", "rack_and_pinion", "pulley", "mimic"};
  return names;
}

std::span<const char *const> joint_coordinate_names()
{
  static constexpr const char *names[] = {"usual",      "direction_x", "direction_y", "direction_z",
                                          "rotation_x", "rotation_y",  "rotation_z"};
  return names;
}

namespace {

/* The coordinate that is meant; usual is none of them. */
JointCoordinate coordinate_meant(JointCoordinate given, const Coupling &coupling, bool is_a, const Joint &joint)
{
  if (given != JointCoordinate::usual) return given;
  switch (coupling.type) {
  case CouplingType::gear: return JointCoordinate::rotation_x;
  case CouplingType::rack_and_pinion: return is_a ? JointCoordinate::rotation_x : JointCoordinate::direction_x;
  case CouplingType::pulley: return JointCoordinate::direction_x;
  case CouplingType::mimic: break;
  }
  const bool turns = kind_of_axis(joint, 3) != JOINT_AXIS_NONE;
  return turns ? JointCoordinate::rotation_x : JointCoordinate::direction_x;
}

uint32_t kind_of(JointCoordinate given, const Coupling &coupling, bool is_a, const Joint &joint)
{
  const auto number = static_cast<uint32_t>(coordinate_meant(given, coupling, is_a, joint));
  return kind_of_axis(joint, number - static_cast<uint32_t>(JointCoordinate::direction_x));
}

bool is_direction(uint32_t kind) { return kind <= JOINT_AXIS_Z || kind == JOINT_AXIS_DISTANCE; }

} // namespace

CouplingRow row_of(const Coupling &coupling, const Scene &scene)
{
  CouplingRow row{kind_of(coupling.coordinate_a, coupling, true, scene.joints[coupling.joint_a]),
                  kind_of(coupling.coordinate_b, coupling, false, scene.joints[coupling.joint_b]),
                  1,
                  double{coupling.ratio},
                  double{coupling.offset},
                  0,
                  false};
  const double tooth = 2 * M_PI / std::abs(double(coupling.teeth_a));
  switch (coupling.type) {
  case CouplingType::gear:
    row.of_b = double(coupling.teeth_b) / coupling.teeth_a;
    row.period = tooth;
    break;
  case CouplingType::rack_and_pinion:
    row.of_b = -2 * M_PI / double{coupling.travel};
    row.period = tooth;
    break;
  case CouplingType::pulley:
    if (!coupling.only_pulls) break;
    row.of_a = -1;
    row.of_b = -row.of_b;
    row.offset = -row.offset;
    row.one_sided = true;
    break;
  case CouplingType::mimic: break;
  }
  return row;
}

namespace {

std::string names_of_coupling_types()
{
  std::string names;
  for (const char *name : coupling_type_names()) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

void check_joint(const char *field, uint32_t joint, const Scene &scene, const Checker &check)
{
  if (joint >= scene.joints.size())
    check.fail(fmt::format("{} {} does not exist; the scene has {} joints", field, joint, scene.joints.size()));
  if (is_vacant(scene.joints[joint])) check.fail(fmt::format("{} {} was destroyed; it has no bodies", field, joint));
}

/* What only some types have is left as it is by the others. */
void check_unused(const Coupling &coupling, const Checker &check)
{
  const Coupling defaults;
  const char *type = coupling_type_names()[static_cast<size_t>(coupling.type)];
  const auto refuse_set = [&](const char *field, bool is_set, const char *instead) {
    if (is_set) check.fail(fmt::format("a {} has no {}; {}", type, field, instead));
  };
  const bool is_gear = coupling.type == CouplingType::gear, is_rack = coupling.type == CouplingType::rack_and_pinion;
  refuse_set("ratio", (is_gear || is_rack) && coupling.ratio != defaults.ratio,
             is_gear ? "it is that of teeth_b to teeth_a" : "it is that of a turn to travel");
  refuse_set("travel", !is_rack && coupling.travel != 0, "a rack_and_pinion has it");
  refuse_set("teeth_a", !is_gear && !is_rack && coupling.teeth_a != 0, "a gear and a rack_and_pinion have them");
  refuse_set("teeth_b", !is_gear && coupling.teeth_b != 0, "a gear has them");
  refuse_set("only_pulls", coupling.type != CouplingType::pulley && !coupling.only_pulls, "it always pulls and pushes");
}

constexpr int32_t most_teeth = 1'000'000; /* the angle of a tooth is far above what a float tells apart */

void check_teeth(const char *field, int32_t teeth, const Checker &check)
{
  if (teeth == 0 || teeth > most_teeth || teeth < -most_teeth)
    check.fail(fmt::format("{} is {}; a whole number other than 0 is needed, of at most {}", field, teeth, most_teeth));
}

void check_numbers(const Coupling &coupling, const Checker &check)
{
  const auto check_factor = [&](const char *field, float x) {
    if (x == 0 || !std::isfinite(x) || !(std::abs(x) <= 1e6f && std::abs(x) >= 1e-6f))
      check.fail(fmt::format("{} is {}; a number other than 0 is needed, with a size from 1e-6 to 1e6", field, x));
  };
  check.at_most("offset", coupling.offset, longest_length);
  if (coupling.type == CouplingType::gear) check_teeth("teeth_b", coupling.teeth_b, check);
  if (coupling.type == CouplingType::gear || coupling.type == CouplingType::rack_and_pinion)
    check_teeth("teeth_a", coupling.teeth_a, check);
  if (coupling.type == CouplingType::rack_and_pinion) check_factor("travel", coupling.travel);
  check_factor("ratio", coupling.ratio);
  if (coupling.type != CouplingType::pulley) return;
  if (coupling.ratio < 0) check.fail(fmt::format("ratio is {}; a rope has one above 0", coupling.ratio));
  if (!(coupling.offset > 0))
    check.fail(fmt::format("offset is {}; it is the length of the rope, above 0", coupling.offset));
}

/* side: what the coupling needs there. */
void check_coordinate(const char *field, uint32_t kind, bool turns, bool any, const Joint &joint, const Checker &check)
{
  const char *type = row_of(joint.type).name;
  if (kind == JOINT_AXIS_NONE) check.fail(fmt::format("{} is not free in a joint of type {}", field, type));
  if (any) return;
  if (turns && kind != JOINT_AXIS_TWIST && kind != JOINT_AXIS_TURN && kind != JOINT_AXIS_SPIN)
    check.fail(fmt::format("{} is no rotation about x, which gears and pinions have", field));
  if (!turns && !is_direction(kind))
    check.fail(fmt::format("{} is no direction or distance, which racks and pulleys have", field));
}

} // namespace

void validate(const Scene &scene, const Coupling &coupling, size_t index, const std::string &where)
{
  const Checker check{where, "coupling", index, coupling.name};
  if (static_cast<size_t>(coupling.type) >= coupling_type_names().size())
    check.fail(fmt::format("unknown type; {} exist", names_of_coupling_types()));
  check_joint("joint_a", coupling.joint_a, scene, check);
  check_joint("joint_b", coupling.joint_b, scene, check);
  for (const JointCoordinate coordinate : {coupling.coordinate_a, coupling.coordinate_b})
    if (static_cast<size_t>(coordinate) >= joint_coordinate_names().size()) check.fail("unknown coordinate");
  check_unused(coupling, check);
  check_numbers(coupling, check);
  const CouplingRow row = row_of(coupling, scene);
  const bool any = coupling.type == CouplingType::mimic, a_turns = coupling.type != CouplingType::pulley,
             b_turns = coupling.type == CouplingType::gear;
  check_coordinate("coordinate_a", row.kind_a, a_turns, any, scene.joints[coupling.joint_a], check);
  check_coordinate("coordinate_b", row.kind_b, b_turns, any, scene.joints[coupling.joint_b], check);
  if (coupling.joint_a == coupling.joint_b && row.kind_a == row.kind_b)
    check.fail(fmt::format("it couples a coordinate of joint {} with itself", coupling.joint_a));
}

} // namespace tandem
