/* joint_description.cpp - reads limits and drives and refuses those that no joint could keep; see
 * joint_description.h. */
#include "host/io/gltf/joint_description.h"

#include <algorithm>

#include <fmt/format.h>

namespace tandem {
namespace {

constexpr float half_turn = 3.1415927f;

float at_least_zero_or(const JsonValue &owner, const char *key, float otherwise)
{
  const std::optional<JsonValue> json = owner.find(key);
  if (!json) return otherwise;
  const float number = json->number();
  if (number < 0) json->fail(fmt::format("is {}; at least 0 is needed", number));
  return number;
}

float coordinate_or(const JsonValue &owner, const char *key, float otherwise)
{
  const std::optional<JsonValue> json = owner.find(key);
  return json ? json->coordinate() : otherwise;
}

size_t read_axis(const JsonValue &json)
{
  const uint32_t axis = json.unsigned_integer();
  if (axis > 2) json.fail(fmt::format("axis {} does not exist; 0 (X), 1 (Y) and 2 (Z) do", axis));
  return axis;
}

std::vector<size_t> read_axes(const JsonValue &list)
{
  std::vector<size_t> axes;
  for (size_t i = 0; i < list.array_size(); ++i) {
    axes.push_back(read_axis(list.element(i)));
    if (std::count(axes.begin(), axes.end(), axes.back()) > 1) list.element(i).fail("is listed twice");
  }
  if (axes.empty()) list.fail("is empty; at least one of 0 (X), 1 (Y) and 2 (Z) is needed");
  return axes;
}

/* Angles count from -π to π, so a bound beyond is none. */
void take_angles(GltfLimit &limit)
{
  if (limit.lower > half_turn || limit.upper < -half_turn)
    limit.json.fail(fmt::format("is from {} to {} rad, where no angle is; angles are between -3.14159 and 3.14159",
                                limit.lower, limit.upper));
  const bool from_below = limit.lower <= -half_turn, to_above = limit.upper >= half_turn;
  if (limit.axes.size() > 1) {
    if (to_above) limit.upper = GltfLimit::none;
    return;
  }
  limit.lower = std::max(limit.lower, -half_turn);
  limit.upper = std::min(limit.upper, half_turn);
  if (from_below && to_above) limit.lower = -GltfLimit::none, limit.upper = GltfLimit::none;
}

/* What several axes make together, a distance or the angle of a cone, is never below 0. */
void take_distances(GltfLimit &limit)
{
  if (limit.upper < 0)
    limit.json.fail(fmt::format("is at most {} over {} axes, which make a distance or an angle of at least 0; a max of "
                                "at least 0 is needed",
                                limit.upper, limit.axes.size()));
  if (limit.lower <= 0) limit.lower = -GltfLimit::none;
}

void read_softness(const JsonValue &json, GltfLimit &limit)
{
  limit.stiffness = at_least_zero_or(json, "stiffness", 0);
  limit.damping = at_least_zero_or(json, "damping", 0);
  if (const auto given = json.find("stiffness"); given && limit.stiffness == 0)
    given->fail("is 0, which limits nothing; a number above 0 is needed, or none for a hard limit");
  if (limit.is_hard()) limit.damping = 0; /* a hard limit does not spring back, so there is nothing to damp */
}

GltfLimit read_limit(const JsonValue &json)
{
  static constexpr const char *keys[] = {"min",        "max",         "stiffness", "damping",
                                         "linearAxes", "angularAxes", "extras",    "extensions"};
  json.only_keys(keys);
  const std::optional<JsonValue> linear = json.find("linearAxes"), angular = json.find("angularAxes");
  if (linear.has_value() == angular.has_value())
    json.fail(fmt::format("has {} linearAxes and angularAxes; exactly one of the two is needed",
                          linear ? "both" : "neither"));
  GltfLimit limit{json, angular.has_value(), read_axes(linear ? *linear : *angular)};
  limit.lower = coordinate_or(json, "min", -GltfLimit::none);
  limit.upper = coordinate_or(json, "max", GltfLimit::none);
  if (limit.lower > limit.upper)
    json.fail(fmt::format("min is {} and max {}; a min that is at most max is needed", limit.lower, limit.upper));
  if (limit.angular) take_angles(limit);
  if (limit.axes.size() > 1) take_distances(limit);
  read_softness(json, limit);
  return limit;
}

GltfDrive read_drive(const JsonValue &json)
{
  static constexpr const char *keys[] = {"type",           "mode",      "axis",    "maxForce", "positionTarget",
                                         "velocityTarget", "stiffness", "damping", "extras",   "extensions"},
                              *types[] = {"linear", "angular"}, *modes[] = {"force", "acceleration"};
  json.only_keys(keys);
  GltfDrive drive;
  drive.angular = json.member("type").choice(types) == 1;
  drive.acceleration = json.member("mode").choice(modes) == 1;
  drive.axis = read_axis(json.member("axis"));
  drive.max_force = at_least_zero_or(json, "maxForce", GltfLimit::none);
  drive.position_target = coordinate_or(json, "positionTarget", 0);
  drive.velocity_target = coordinate_or(json, "velocityTarget", 0);
  drive.stiffness = at_least_zero_or(json, "stiffness", 0);
  drive.damping = at_least_zero_or(json, "damping", 0);
  if (drive.angular && drive.stiffness > 0 && std::abs(drive.position_target) > half_turn)
    json.member("positionTarget")
        .fail(fmt::format("is {} rad, where no angle is; angles are between -3.14159 and 3.14159",
                          drive.position_target));
  return drive;
}

/* Mirroring along X turns positions along X round, and turns about Y and Z. */
bool turns_round(bool angular, size_t axis) { return angular == (axis > 0); }

} // namespace

GltfJointDescription read_gltf_joint_description(const JsonValue &json)
{
  static constexpr const char *keys[] = {"limits", "drives", "name", "extras", "extensions"};
  json.only_keys(keys);
  GltfJointDescription description;
  const std::optional<JsonValue> limits = json.find("limits"), drives = json.find("drives");
  for (size_t i = 0; limits && i < limits->array_size(); ++i)
    description.limits.push_back(read_limit(limits->element(i)));
  for (size_t i = 0; drives && i < drives->array_size(); ++i)
    description.drives.push_back(read_drive(drives->element(i)));
  return description;
}

GltfJointDescription mirrored(GltfJointDescription description)
{
  for (GltfLimit &limit : description.limits)
    if (limit.axes.size() == 1 && turns_round(limit.angular, limit.axes[0])) {
      std::swap(limit.lower, limit.upper);
      limit.lower = -limit.lower;
      limit.upper = -limit.upper;
    }
  for (GltfDrive &drive : description.drives)
    if (turns_round(drive.angular, drive.axis)) {
      drive.position_target = -drive.position_target;
      drive.velocity_target = -drive.velocity_target;
    }
  return description;
}

} // namespace tandem
