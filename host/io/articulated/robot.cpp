/* robot.cpp - from a tree of links to bodies and joints; see links.h. */
#include <algorithm>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/articulations.h>

#include "host/base/printable.h"
#include "host/geometry/shape_mass.h"
#include "host/io/articulated/joint_groups.h"

namespace tandem {
namespace {

/* Of a body that stands between two joints of a link, in the link's mass. Trees hold any mass; this one keeps them
 * finite where the axes of three hinges lie in one plane. */
constexpr double share_of_mass = 0.1, share_in_tree = 0.001;
constexpr size_t most_of_frame = 6;   /* the axes of one frame */
constexpr double least_factor = 1e-6; /* of couplings, as validate() has it; 1 over it is the largest */
constexpr size_t most_parts = 6;      /* joints of a link, each with the axes of a frame */

/* Links that move as one. The first of them has the joints. */
struct LinkGroup {
  size_t base = Link::world;
  std::vector<size_t> members;
  size_t parent = Link::world;        /* index of another group */
  std::vector<size_t> children;       /* the groups whose parent it is */
  std::vector<LinkJoint> joints;      /* places and axes in the world */
  std::vector<MassProperties> masses; /* in the frame of the base */
  bool gone = false;                  /* it had no mass */
  uint32_t body = no_body;
};

/* Where a joint of a link is in the scene. */
struct PlacedAxis {
  uint32_t joint;
  GroupedAxis axis;
};

/* Joints of a link that are one of the scene. */
struct JointsOfFrame {
  GroupedJoint grouped;
  std::span<const LinkJoint> joints;
};

void scale_mass(Body &body, double share)
{
  body.mass = round_to_float(share * double{body.mass});
  for (float &moment : body.inertia) moment = round_to_float(share * double{moment});
}

class RobotBuilder {
public:
  RobotBuilder(const Robot &robot, XmlNotes &notes, Scene &scene) : robot_(robot), notes_(notes), scene_(scene) {}
  void build();

private:
  [[noreturn]] void refuse(const Link &link, const std::string &why) const
  {
    throw InputError(printable(fmt::format("{}: line {}: link \"{}\": {}", robot_.file, link.line, link.name, why)));
  }
  [[noreturn]] void refuse(const JointCoupling &coupling, const std::string &why) const
  {
    throw InputError(printable(fmt::format("{}: line {}: {}: joint \"{}\" {}", robot_.file, coupling.line,
                                           coupling.what, coupling.joint, why)));
  }
  const Link &base_of(const LinkGroup &group) const { return robot_.links[group.base]; }
  uint32_t body_of(size_t group) const { return group == Link::world ? no_body : groups_[group].body; }
  void place_links();
  void group_links();
  void begin_group(size_t link);
  void pass_joints_on(size_t massless);
  void add_fixed_bodies();
  void add_body(LinkGroup &group);
  void set_mass(const LinkGroup &group, Body &body, RigidFrame &frame) const;
  void set_shape(const LinkGroup &group, const RigidFrame &frame, Body &body);
  void take_ghost_shape(Body &body);
  void add_joints(const LinkGroup &group);
  std::vector<JointsOfFrame> parts_of(const LinkGroup &group);
  uint32_t add_body_between(const LinkGroup &group, double share, const std::string &joint);
  void add_joint(const GroupedJoint &grouped, std::span<const LinkJoint> joints, uint32_t body_a, uint32_t body_b);
  void keep_apart(const LinkGroup &group, uint32_t parent);
  void note_grouping(const LinkGroup &group, const GroupedJoint &grouped, std::span<const LinkJoint> joints);
  void set_frame(uint32_t body, const RigidFrame &at, Point &position, Quat &orientation) const;
  void add_connections();
  void check_coupling(const JointCoupling &coupling) const;
  void hold(const PlacedAxis &place, const JointCoupling &coupling);
  void leave_out_rolling();
  void couple(const JointCoupling &coupling);
  void add_actuator(const LinkActuator &driven);
  void note_armatures(const LinkGroup &group);
  bool is_tree() const { return robot_.coordinates == Coordinates::reduced; }

  const Robot &robot_;
  XmlNotes &notes_;
  Scene &scene_;
  std::vector<RigidFrame> places_; /* of the links in the world */
  std::vector<size_t> group_of_;   /* of each link; Link::world: it stands still */
  std::vector<LinkGroup> groups_;
  std::vector<float> armatures_;              /* of the joints of the scene */
  std::map<std::string, PlacedAxis> axis_of_; /* of hinges and slides, by their names */
};

void RobotBuilder::place_links()
{
  for (const Link &link : robot_.links)
    places_.push_back(link.parent == Link::world ? link.pose : places_[link.parent] * link.pose);
}

void RobotBuilder::begin_group(size_t index)
{
  const Link &link = robot_.links[index];
  LinkGroup &group = groups_.emplace_back();
  group.base = index;
  group.parent = link.parent == Link::world ? Link::world : group_of_[link.parent];
  if (group.parent != Link::world) groups_[group.parent].children.push_back(groups_.size() - 1);
  for (LinkJoint joint : link.joints) {
    joint.at = places_[index] * joint.at;
    joint.axis = turn(places_[index].rotation, joint.axis);
    group.joints.push_back(joint);
  }
}

void RobotBuilder::group_links()
{
  for (size_t index = 0; index < robot_.links.size(); ++index) {
    const Link &link = robot_.links[index];
    const bool welded = link.joints.empty() && !link.floats;
    if (!welded) {
      begin_group(index);
      group_of_.push_back(groups_.size() - 1);
    } else group_of_.push_back(link.parent == Link::world ? Link::world : group_of_[link.parent]);
    if (group_of_[index] == Link::world) continue;
    for (const LinkShape &shape : link.shapes)
      if (shape.shape.type == ShapeType::half_space) refuse(link, "moves and has a plane as its shape");
    if (welded) notes_.add(link.line, "a link without a joint that moves is part of its parent's body");
    LinkGroup &group = groups_[group_of_[index]];
    group.members.push_back(index);
    const RigidFrame in_base = inverse(places_[group.base]) * places_[index];
    if (link.mass && link.mass->mass > 0)
      group.masses.push_back(placed(*link.mass, in_base.rotation, array_of(in_base.position)));
  }
}

/* A group without mass is no body: with one child its joints are the child's, and without any it moves nothing. */
void RobotBuilder::pass_joints_on(size_t massless)
{
  LinkGroup &group = groups_[massless];
  const std::vector<size_t> &children = group.children;
  const Link &link = base_of(group);
  if (group.joints.size() > most_parts * most_of_frame)
    refuse(link, fmt::format("has no mass, and so have those before it, which have {} joints; give them a mass",
                             group.joints.size()));
  if (children.size() > 1)
    refuse(link, fmt::format("has no mass and {} links that move on it; give it a mass", children.size()));
  if (link.floats && !children.empty()) refuse(link, "floats and has no mass; give it one");
  group.gone = true;
  for (size_t member : group.members)
    if (!robot_.links[member].shapes.empty())
      notes_.add(link.line, fmt::format("the shapes of link \"{}\", which has no mass, are left out", link.name));
  if (children.empty()) return notes_.add(link.line, "a link without mass at the end of the tree is left out");
  LinkGroup &child = groups_[children.front()];
  child.joints.insert(child.joints.begin(), group.joints.begin(), group.joints.end());
  child.parent = group.parent; /* whose list of children knows the one that is gone alone */
}

void RobotBuilder::add_fixed_bodies()
{
  for (size_t index = 0; index < robot_.links.size(); ++index) {
    if (group_of_[index] != Link::world) continue;
    const Link &link = robot_.links[index];
    for (const LinkShape &shape : link.shapes) {
      const RigidFrame place = places_[index] * shape.pose;
      Body body;
      body.name = shape.name.empty() ? link.name : shape.name;
      body.type = BodyType::fixed;
      body.shape = uint32_t(scene_.shapes.size());
      body.material = shape.material;
      body.filter_group = shape.filter_group;
      body.filter_mask = shape.filter_mask;
      body.position = array_of(place.position);
      body.orientation = quat_of(place.rotation);
      scene_.shapes.push_back(shape.shape);
      scene_.bodies.push_back(body);
    }
  }
}

/* Moments of a solid: each is at most the sum of the others. A thousandth is rounding, as of numbers with 4 digits. */
void RobotBuilder::set_mass(const LinkGroup &group, Body &body, RigidFrame &frame) const
{
  const MassProperties whole = compound_mass(group.masses);
  const PrincipalAxes axes = principal_axes(whole.inertia);
  const auto &[x, y, z] = axes.moments;
  const double sum = x + y + z;
  for (double moment : axes.moments)
    if (!(moment > 0) || moment > (sum - moment) * 1.001)
      refuse(base_of(group),
             fmt::format("moments of inertia of {:g}, {:g} and {:g} kg m^2 about the principal axes; each "
                         "must be above 0 and at most the sum of the others",
                         x, y, z));
  frame = places_[group.base] * RigidFrame{vector_of(whole.center), axes.rotation};
  body.mass = round_to_float(whole.mass);
  for (size_t k = 0; k < 3; ++k) body.inertia[k] = round_to_float(axes.moments[k]);
  body.position = array_of(frame.position);
  body.orientation = quat_of(frame.rotation);
}

/* A ball of about the body's size that collides with nothing: a body without a shape keeps its motion. */
void RobotBuilder::take_ghost_shape(Body &body)
{
  const float largest = *std::max_element(body.inertia.begin(), body.inertia.end());
  body.shape = uint32_t(scene_.shapes.size());
  body.filter_group = body.filter_mask = 0;
  scene_.shapes.push_back(sphere_shape(round_to_float(std::sqrt(double{largest} / double{body.mass}))));
}

void RobotBuilder::set_shape(const LinkGroup &group, const RigidFrame &frame, Body &body)
{
  std::vector<Child> children;
  for (size_t member : group.members)
    for (const LinkShape &shape : robot_.links[member].shapes) {
      const RigidFrame in_body = inverse(frame) * (places_[member] * shape.pose);
      Child &child = children.emplace_back();
      child.shape = shape.shape;
      child.position = rounded(array_of(in_body.position));
      child.orientation = quat_of(in_body.rotation);
      child.material = shape.material;
      child.filter_group = shape.filter_group;
      child.filter_mask = shape.filter_mask;
    }
  if (children.empty()) return take_ghost_shape(body);
  const Child &first = children.front();
  body.shape = uint32_t(scene_.shapes.size());
  body.material = *first.material;
  body.filter_group = *first.filter_group;
  body.filter_mask = *first.filter_mask;
  if (children.size() == 1) {
    body.shape_position = first.position;
    body.shape_orientation = first.orientation;
    scene_.shapes.push_back(first.shape);
  } else scene_.shapes.push_back(compound_shape(std::move(children)));
}

void RobotBuilder::add_body(LinkGroup &group)
{
  Body body;
  RigidFrame frame;
  body.name = base_of(group).name;
  body.gravity_factor = base_of(group).gravity_factor;
  set_mass(group, body, frame);
  set_shape(group, frame, body);
  group.body = uint32_t(scene_.bodies.size());
  scene_.bodies.push_back(body);
}

/* A frame of the world in the axes of a body, from its centre of mass. */
void RobotBuilder::set_frame(uint32_t number, const RigidFrame &at, Point &position, Quat &orientation) const
{
  RigidFrame in_body = at;
  if (number != no_body) {
    const Body &body = scene_.bodies[number];
    const Quat &q = body.orientation;
    const RigidFrame place{vector_of(body.position), unit(Rotation{q[0], q[1], q[2], q[3]})};
    in_body = inverse(place) * at;
  }
  position = array_of(in_body.position);
  orientation = quat_of(in_body.rotation);
}

std::string names_of_joints(std::span<const LinkJoint> joints)
{
  std::vector<std::string> names;
  for (const LinkJoint &joint : joints) names.push_back(joint.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

void RobotBuilder::add_joint(const GroupedJoint &grouped, std::span<const LinkJoint> joints, uint32_t body_a,
                             uint32_t body_b)
{
  Joint joint = grouped.joint;
  joint.name = names_of_joints(joints);
  joint.body_a = body_a;
  joint.body_b = body_b;
  set_frame(body_a, grouped.frame, joint.position_a, joint.orientation_a);
  set_frame(body_b, grouped.frame, joint.position_b, joint.orientation_b);
  for (size_t k = 0; k < grouped.axes.size(); ++k)
    axis_of_.insert_or_assign(joints[k].name, PlacedAxis{uint32_t(scene_.joints.size()), grouped.axes[k]});
  scene_.joints.push_back(joint);
  armatures_.push_back(joints.size() == 1 ? round_to_float(joints.front().armature) : 0);
}

void RobotBuilder::note_armatures(const LinkGroup &group)
{
  for (const LinkJoint &joint : group.joints)
    if (joint.armature > 0) notes_.add(base_of(group).line, "armature is of reduced coordinates alone");
}

void RobotBuilder::note_grouping(const LinkGroup &group, const GroupedJoint &grouped, std::span<const LinkJoint> joints)
{
  const int line = base_of(group).line;
  const std::string names = names_of_joints(joints);
  if (grouped.gap > 1e-6)
    notes_.add(line,
               fmt::format("the axes of {} pass each other {:.3g} m apart; they meet halfway", names, grouped.gap));
  const Axes &held = grouped.joint.held_rotations;
  if (joints.size() > 2 && !held.x && !held.y && !held.z)
    notes_.add(line, fmt::format("{} are one joint, whose first two angles are those of a swing, not one after the "
                                 "other",
                                 names));
}

/* A copy of the link's body with a part of its mass, which collides with nothing. */
uint32_t RobotBuilder::add_body_between(const LinkGroup &group, double share, const std::string &joint)
{
  Body between = scene_.bodies[group.body];
  between.name += fmt::format(" after {}", joint);
  scale_mass(between, share);
  between.shape_position = {0, 0, 0};
  between.shape_orientation = {0, 0, 0, 1};
  take_ghost_shape(between);
  scene_.bodies.push_back(between);
  return uint32_t(scene_.bodies.size() - 1);
}

/* Bodies that a joint connects do not collide; one that holds nothing says that of a link and its parent where another
 * body stands between them. */
void RobotBuilder::keep_apart(const LinkGroup &group, uint32_t parent)
{
  if (parent == no_body) return;
  GroupedJoint nothing;
  nothing.joint.type = JointType::six_dof;
  add_joint(nothing, {}, parent, group.body);
  scene_.joints.back().name = fmt::format("{} beside {}", base_of(group).name, scene_.bodies[parent].name);
}

/* From the parent outwards, as many joints as have the axes of one frame are one joint; each is one in a tree. */
std::vector<JointsOfFrame> RobotBuilder::parts_of(const LinkGroup &group)
{
  const Body &link = scene_.bodies[group.body];
  const float largest = *std::max_element(link.inertia.begin(), link.inertia.end());
  const double reach = std::sqrt(double{largest} / double{link.mass}); /* the radius of gyration */
  std::vector<JointsOfFrame> parts;
  for (std::span<const LinkJoint> rest = group.joints; !rest.empty(); rest = rest.subspan(parts.back().joints.size()))
    for (size_t count = is_tree() ? 1 : std::min(rest.size(), most_of_frame); count > 0; --count)
      if (const auto grouped = group_joints(rest.first(count), reach)) {
        parts.push_back({*grouped, rest.first(count)});
        note_grouping(group, *grouped, rest.first(count));
        break;
      }
  if (!is_tree() && parts.size() > most_parts)
    refuse(base_of(group), "has more than six joints whose axes are not at right angles");
  if (parts.size() > most_parts * most_of_frame)
    refuse(base_of(group),
           fmt::format("has {} joints; at most {} are possible", parts.size(), most_parts * most_of_frame));
  return parts;
}

/* A body stands between each two of the parts. */
void RobotBuilder::add_joints(const LinkGroup &group)
{
  if (group.joints.empty()) return;
  const std::vector<JointsOfFrame> parts = parts_of(group);
  const uint32_t parent = body_of(group.parent);
  const double share = is_tree() ? share_in_tree : share_of_mass;
  uint32_t before = parent;
  for (size_t k = 0; k < parts.size(); ++k) {
    const uint32_t next =
        k + 1 < parts.size() ? add_body_between(group, share, names_of_joints(parts[k].joints)) : group.body;
    add_joint(parts[k].grouped, parts[k].joints, before, next);
    before = next;
  }
  scale_mass(scene_.bodies[group.body], 1 - share * double(parts.size() - 1));
  if (!is_tree()) note_armatures(group);
  if (parts.size() == 1) return;
  if (!is_tree())
    notes_.add(base_of(group).line, fmt::format("{} have not the axes of one frame: bodies with {:g} of the mass stand "
                                                "between them",
                                                names_of_joints(group.joints), share));
  keep_apart(group, parent);
}

void RobotBuilder::add_connections()
{
  for (const LinkConnection &connection : robot_.connections) {
    const auto group = [&](size_t link) { return link == Link::world ? link : group_of_[link]; };
    const auto place = [&](size_t link, const RigidFrame &frame) {
      return link == Link::world ? frame : places_[link] * frame;
    };
    const uint32_t body_a = body_of(group(connection.link_a)), body_b = body_of(group(connection.link_b));
    if (body_a == body_b) {
      notes_.add(connection.line, "a connection of a body with itself, or with one that is left out, holds nothing");
      continue;
    }
    Joint joint;
    joint.name = connection.name;
    joint.type = connection.type;
    joint.body_a = body_a;
    joint.body_b = body_b;
    set_frame(body_a, place(connection.link_a, connection.a), joint.position_a, joint.orientation_a);
    set_frame(body_b, place(connection.link_b, connection.b), joint.position_b, joint.orientation_b);
    scene_.joints.push_back(joint);
  }
}

void RobotBuilder::check_coupling(const JointCoupling &coupling) const
{
  const double size = std::abs(coupling.factor);
  if (coupling.joint == coupling.followed) refuse(coupling, "follows itself; name another joint");
  if (size != 0 && !(size >= least_factor && size <= 1 / least_factor))
    refuse(coupling, fmt::format("follows by a factor of {:g}; 0, or a size from {:g} to {:g} is needed",
                                 coupling.factor, least_factor, 1 / least_factor));
  const auto joint = axis_of_.find(coupling.joint);
  const bool turns = joint != axis_of_.end() && joint->second.axis.axis >= 3;
  const double farthest_angle = std::numbers::pi * (1 + size), most = turns ? farthest_angle : double{longest_length};
  if (!(std::abs(coupling.offset) <= most))
    refuse(coupling, fmt::format("has an offset of {:g}; at most {:g} is possible", coupling.offset, most));
}

/* Contacts of links have neither. */
void RobotBuilder::leave_out_rolling()
{
  for (Material &material : scene_.materials) {
    if (material.rolling_friction == 0 && material.spinning_friction == 0) continue;
    material.rolling_friction = material.spinning_friction = 0;
    notes_.add(robot_.links.front().line, "rolling and spinning friction are of maximal coordinates alone");
  }
}

/* Limits at one value hold an axis there. */
void RobotBuilder::hold(const PlacedAxis &place, const JointCoupling &coupling)
{
  const double value = coupling.offset;
  Joint &joint = scene_.joints[place.joint];
  JointAxis &axis = place.axis.axis < 3 ? joint.directions[place.axis.axis] : joint.rotations[place.axis.axis - 3];
  const float held = round_to_float(place.axis.reversed ? -value : value);
  if (held < axis.lower || held > axis.upper)
    notes_.add(coupling.line,
               fmt::format("{}: joint \"{}\" is held outside of its limits", coupling.what, coupling.joint));
  axis.lower = axis.upper = held;
}

/* q = offset + factor q_followed; each coordinate is that of the scene's joint, or its opposite. */
void RobotBuilder::couple(const JointCoupling &coupling)
{
  check_coupling(coupling);
  const auto joint = axis_of_.find(coupling.joint), followed = axis_of_.find(coupling.followed);
  if (coupling.factor == 0 && joint != axis_of_.end()) return hold(joint->second, coupling);
  if (joint == axis_of_.end() || followed == axis_of_.end())
    return notes_.add(coupling.line, fmt::format("{}: joint \"{}\" does not follow joint \"{}\"", coupling.what,
                                                 coupling.joint, coupling.followed));
  const auto coordinate_of = [](const PlacedAxis &place) { return JointCoordinate(place.axis.axis + 1); };
  const double sign = joint->second.axis.reversed ? -1 : 1, other = followed->second.axis.reversed ? -1 : 1;
  Coupling mimic;
  mimic.name = fmt::format("{} follows {}", coupling.joint, coupling.followed);
  mimic.type = CouplingType::mimic;
  mimic.joint_a = joint->second.joint;
  mimic.joint_b = followed->second.joint;
  mimic.coordinate_a = coordinate_of(joint->second);
  mimic.coordinate_b = coordinate_of(followed->second);
  mimic.ratio = round_to_float(-coupling.factor * sign * other);
  mimic.offset = round_to_float(coupling.offset * sign);
  scene_.couplings.push_back(mimic);
}

/* An axis that points the other way has the opposite of each number. */
void RobotBuilder::add_actuator(const LinkActuator &driven)
{
  const auto place = axis_of_.find(driven.joint);
  if (place == axis_of_.end())
    return notes_.add(driven.line, fmt::format("{} drives joint \"{}\", which is left out", driven.what, driven.joint));
  Actuator &actuator = scene_.actuators.emplace_back(driven.actuator);
  actuator.joint = place->second.joint;
  actuator.axis = uint32_t(place->second.axis.axis);
  if (!place->second.axis.reversed) return;
  actuator.offset = 0 - actuator.offset;
  actuator.factor = 0 - actuator.factor;
}

void RobotBuilder::build()
{
  place_links();
  group_links();
  for (size_t k = 0; k < groups_.size(); ++k)
    if (groups_[k].masses.empty()) pass_joints_on(k);
  add_fixed_bodies();
  for (LinkGroup &group : groups_)
    if (!group.gone) add_body(group);
  for (const LinkGroup &group : groups_)
    if (!group.gone) add_joints(group);
  add_connections();
  for (const JointCoupling &coupling : robot_.couplings) couple(coupling);
  for (const LinkActuator &driven : robot_.actuators) add_actuator(driven);
  if (!is_tree()) return;
  leave_out_rolling();
  armatures_.resize(scene_.joints.size());
  make_articulations(scene_, robot_.file, armatures_);
}

} // namespace

void add_robot(const Robot &robot, XmlNotes &notes, Scene &scene) { RobotBuilder(robot, notes, scene).build(); }

} // namespace tandem
