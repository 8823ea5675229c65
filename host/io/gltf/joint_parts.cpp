/* joint_parts.cpp - sorts limits into what joints hold and what they limit; see joint_parts.h. */
#include "host/io/gltf/joint_parts.h"

#include <algorithm>

#include <fmt/format.h>

namespace tandem {
namespace {

constexpr const char *axis_names[] = {"X", "Y", "Z"};

/* What hard limits without any range hold. A direction is held where the limit says, a rotation at 0. */
struct Held {
  std::array<std::optional<float>, 3> directions;
  std::array<bool, 3> rotations{};

  bool one_rotation() const { return std::count(rotations.begin(), rotations.end(), true) == 1; }
  bool all_directions() const
  {
    return std::all_of(directions.begin(), directions.end(), [](const auto &at) { return at.has_value(); });
  }
};

void hold_direction(const GltfLimit &limit, size_t axis, float at, Held &held)
{
  std::optional<float> &known = held.directions[axis];
  if (known && *known != at)
    limit.json.fail(
        fmt::format("holds {} at {}, which another limit of the joint holds at {}", axis_names[axis], at, *known));
  known = at;
}

/* A distance or a cone of at most 0 holds each of its axes at 0. */
bool is_hold(const GltfLimit &limit)
{
  const bool single = limit.axes.size() == 1;
  if (!limit.is_hard() || (limit.angular && limit.upper != 0)) return false;
  return single ? limit.lower == limit.upper : limit.upper == 0;
}

Held held_by(const GltfJointDescription &description)
{
  Held held;
  for (const GltfLimit &limit : description.limits)
    for (const size_t axis : limit.axes) {
      if (!is_hold(limit)) continue;
      if (limit.angular) held.rotations[axis] = true;
      else hold_direction(limit, axis, limit.upper, held);
    }
  return held;
}

/* The axis that two others of three leave. */
size_t remaining(const std::vector<size_t> &axes) { return 3 - axes[0] - axes[1]; }

/* The only axis of three for which the condition holds; none if several do. */
template <class Condition> std::optional<size_t> the_one(const Condition &condition)
{
  std::optional<size_t> found;
  for (size_t axis = 0; axis < 3; ++axis)
    if (condition(axis)) {
      if (found) return {};
      found = axis;
    }
  return found;
}

size_t first_turning_axis(const GltfJointDescription &description)
{
  for (const GltfLimit &limit : description.limits)
    if (limit.angular && limit.axes.size() == 2) return remaining(limit.axes);
  for (const GltfLimit &limit : description.limits)
    if (limit.angular && limit.axes.size() == 1) return limit.axes[0];
  for (const GltfDrive &drive : description.drives)
    if (drive.angular) return drive.axis;
  return 0;
}

/* The axis that types with an axis have along x: of a hinge the free rotation, of a slider the free direction. */
size_t main_axis(const GltfJointDescription &description, const Held &held)
{
  const auto turns = [&](size_t axis) { return !held.rotations[axis]; };
  const auto slides = [&](size_t axis) { return !held.directions[axis].has_value(); };
  switch (std::count(held.rotations.begin(), held.rotations.end(), true)) {
  case 3: return the_one(slides).value_or(0);
  case 2: return *the_one(turns);
  case 1: return *the_one([&](size_t axis) { return held.rotations[axis]; });
  default: return first_turning_axis(description);
  }
}

/* The named type that holds this, which is solved faster than six_dof is, and six_dof where there is none. */
void choose_type(GltfJointPart &part)
{
  constexpr Axes none, x{true, false, false}, yz{false, true, true}, xyz{true, true, true};
  struct Named {
    JointType type;
    Axes directions, rotations;
  };
  constexpr Named all[] = {{JointType::ball, xyz, none},    {JointType::fixed, xyz, xyz},
                           {JointType::hinge, xyz, yz},     {JointType::slider, yz, xyz},
                           {JointType::plane, x, yz},       {JointType::parallel, none, yz},
                           {JointType::cylindrical, yz, yz}};
  for (const Named &named : all)
    if (named.directions == part.held_directions && named.rotations == part.held_rotations) {
      part.joint.type = named.type;
      return;
    }
  part.joint.held_directions = part.held_directions;
  part.joint.held_rotations = part.held_rotations;
}

/* A part, and which of its directions and rotations are taken. */
struct Part : GltfJointPart {
  std::array<bool, 6> limited{}, driven{};

  JointAxis &axis(size_t k) { return k < 3 ? joint.directions[k] : joint.rotations[k - 3]; }
  bool is_empty() const
  {
    return joint.type == JointType::six_dof && joint.held_directions == Axes{} && joint.held_rotations == Axes{} &&
           std::count(limited.begin(), limited.end(), true) + std::count(driven.begin(), driven.end(), true) == 0;
  }
};

constexpr size_t twist = 3, swing_y = 4, swing_z = 5, cone = 4, distance = 0; /* numbers of the axes of a part */

class Parts {
public:
  explicit Parts(const GltfJointDescription &description);
  void add(const GltfLimit &limit);
  void add(const GltfDrive &drive);
  std::vector<GltfJointPart> take();

private:
  struct Place {
    Part *part;
    size_t axis;
  };
  using Uses = std::array<bool, 6> Part::*;

  Part &new_part(JointType type, size_t x);
  Place free_axis(bool angular, size_t axis, Uses uses);
  bool is_kept_by_holds(const GltfLimit &limit) const;
  void limit_softly_to_none(const GltfLimit &limit);
  void limit_cone(const GltfLimit &limit);
  static void limit_axis(const Place &place, const GltfLimit &limit, float lower, float upper);

  Held held_;
  std::vector<Part> parts_;
};

/* A rotation that alone is held is a twist of 0: x is not held without y and z. */
bool is_hold_of_type(const GltfLimit &limit, const Held &held)
{
  return is_hold(limit) && (!limit.angular || !held.one_rotation());
}

Parts::Parts(const GltfJointDescription &description) : held_(held_by(description))
{
  const size_t x = main_axis(description, held_);
  const auto slides = [&](size_t k) { return !held_.directions[(x + k) % 3].has_value(); };
  const auto turns = [&](size_t k) { return !held_.rotations[(x + k) % 3] || held_.one_rotation(); };
  Part &first = new_part(JointType::six_dof, x);
  first.held_directions = {!slides(0), !slides(1), !slides(2)};
  first.held_rotations = {!turns(0), !turns(1), !turns(2)};
  choose_type(first);
  for (const GltfLimit &limit : description.limits)
    if (limit.restricts() && !is_hold_of_type(limit, held_)) add(limit);
  for (const GltfDrive &drive : description.drives)
    if (drive.stiffness > 0 || drive.damping > 0) add(drive);
}

Part &Parts::new_part(JointType type, size_t x)
{
  Part part;
  part.joint.type = type;
  part.x = x;
  for (size_t axis = 0; axis < 3 && type != JointType::distance; ++axis)
    part.shift[axis] = double{held_.directions[axis].value_or(0)};
  return parts_.emplace_back(part);
}

/* The direction, or the twist, of the first part in which it is not taken. */
Parts::Place Parts::free_axis(bool angular, size_t axis, Uses uses)
{
  for (Part &part : parts_) {
    const size_t k = angular ? twist : (axis + 3 - part.x) % 3;
    if (part.joint.type != JointType::distance && (!angular || part.x == axis) && !(part.*uses)[k]) {
      (part.*uses)[k] = true;
      return {&part, k};
    }
  }
  Part &part = new_part(JointType::six_dof, angular ? axis : 0);
  const size_t k = angular ? twist : axis;
  (part.*uses)[k] = true;
  return {&part, k};
}

void Parts::limit_axis(const Place &place, const GltfLimit &limit, float lower, float upper)
{
  JointAxis &axis = place.part->axis(place.axis);
  place.part->limited[place.axis] = true;
  axis.lower = lower;
  axis.upper = upper;
  axis.limit_stiffness = limit.stiffness;
  axis.limit_damping = limit.damping;
}

/* Whether what the joint holds leaves nothing to this limit. */
bool Parts::is_kept_by_holds(const GltfLimit &limit) const
{
  double squared = 0;
  for (const size_t axis : limit.axes) {
    if (limit.angular ? !held_.rotations[axis] || held_.one_rotation() : !held_.directions[axis]) return false;
    if (!limit.angular) squared += double{*held_.directions[axis]} * double{*held_.directions[axis]};
  }
  const double at =
      limit.angular || limit.axes.size() > 1 ? std::sqrt(squared) : double{*held_.directions[limit.axes[0]]};
  if (at < double{limit.lower} || at > double{limit.upper})
    limit.json.fail(
        fmt::format("is from {} to {}, and other limits of the joint hold it at {}", limit.lower, limit.upper, at));
  return true;
}

/* A spring towards a point or a line is one along each axis. */
void Parts::limit_softly_to_none(const GltfLimit &limit)
{
  if (!limit.angular) {
    for (const size_t axis : limit.axes)
      if (!held_.directions[axis]) limit_axis(free_axis(false, axis, &Part::limited), limit, 0, 0);
    return;
  }
  Part &part = new_part(JointType::six_dof, limit.axes.size() == 2 ? remaining(limit.axes) : 0);
  for (const size_t k : {swing_y, swing_z}) limit_axis({&part, k}, limit, 0, 0);
  if (limit.axes.size() == 3) limit_axis({&part, twist}, limit, 0, 0);
}

void Parts::limit_cone(const GltfLimit &limit)
{
  if (!held_.all_directions())
    limit.json.fail("a cone of a joint that does not hold its two frames together is not supported yet; a limit of "
                    "linearAxes [0, 1, 2] with min and max 0 does");
  const size_t x = remaining(limit.axes);
  Part &first = parts_.front();
  const bool fits = first.joint.type == JointType::ball && first.x == x;
  if (fits) first.joint.type = JointType::cone_twist;
  Part &part = fits ? first : new_part(JointType::cone_twist, x);
  limit_axis({&part, cone}, limit, limit.lower, limit.upper);
}

void Parts::add(const GltfLimit &limit)
{
  if (is_kept_by_holds(limit)) return;
  const size_t count = limit.axes.size();
  if (count == 1)
    return limit_axis(free_axis(limit.angular, limit.axes[0], &Part::limited), limit, limit.lower, limit.upper);
  if (limit.upper == 0) return limit_softly_to_none(limit);
  if (limit.angular && count == 2) return limit_cone(limit);
  if (limit.angular)
    limit.json.fail("a limit of the whole turn other than 0 is not supported yet; two of angularAxes "
                    "and one are");
  if (count == 2)
    limit.json.fail("a limit of the distance from a line other than 0 is not supported yet; one along "
                    "each axis is, and the distance over all three");
  limit_axis({&new_part(JointType::distance, 0), distance}, limit, limit.lower, limit.upper);
}

/* A drive of what is held moves nothing. */
void Parts::add(const GltfDrive &drive)
{
  if (drive.angular ? held_.rotations[drive.axis] && !held_.one_rotation() : held_.directions[drive.axis].has_value())
    return;
  const Place place = free_axis(drive.angular, drive.axis, &Part::driven);
  JointAxis &axis = place.part->axis(place.axis);
  axis.target_position = drive.position_target;
  axis.target_velocity = drive.velocity_target;
  axis.stiffness = drive.stiffness;
  axis.damping = drive.damping;
  axis.max_force = drive.max_force;
  place.part->acceleration[place.axis] = drive.acceleration;
}

/* A joint that does nothing at all still keeps its bodies from colliding. */
std::vector<GltfJointPart> Parts::take()
{
  if (parts_.size() > 1 && parts_.front().is_empty()) parts_.erase(parts_.begin());
  return {parts_.begin(), parts_.end()};
}

} // namespace

/* A turn in a circle, X to Y to Z, is by a third about the diagonal. */
Rotation GltfJointPart::turn() const
{
  if (x == 0) return {0, 0, 0, 1};
  const double half = x == 1 ? 0.5 : -0.5;
  return {half, half, half, 0.5};
}

std::vector<GltfJointPart> joint_parts_of(const GltfJointDescription &description) { return Parts(description).take(); }

} // namespace tandem
