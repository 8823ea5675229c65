/* scene.cpp - the sections of an MJCF file, in the order in which each needs the others; see scene.h. */
#include "host/io/mjcf/scene.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "host/io/mjcf/bodies.h"
#include "host/io/mjcf/joints.h"

namespace tandem {
namespace {

class MjcfReader {
public:
  MjcfReader(XmlElement root, OutsideFiles outside, Coordinates coordinates)
      : root_(std::move(root)), geoms_(compiler_, defaults_, outside, notes_, scene_),
        bodies_(compiler_, defaults_, geoms_, notes_)
  {
    robot_.coordinates = coordinates;
  }
  Scene read();

private:
  /* The children of all sections of that name. */
  std::vector<const XmlElement *> in_sections(const char *section) const;
  void refuse_includes(const XmlElement &element) const;
  void read_option(const XmlElement &option);
  void read_contacts();
  void read_equality(const XmlElement &equality);
  void connect(const XmlElement &connection);
  void couple(const XmlElement &equality);
  void read_actuator(const XmlElement &actuator);
  void add_actuator(MjcfActuator actuator);
  void map_actuators();
  std::string joint_name(const XmlElement &element, const char *key) const;
  void note_rest();

  const XmlElement root_;
  XmlNotes notes_;
  Scene scene_;
  MjcfCompiler compiler_;
  MjcfDefaults defaults_;
  MjcfGeoms geoms_;
  MjcfBodies bodies_;
  std::vector<MjcfActuator> actuators_;
  std::map<std::pair<std::string, Control>, std::string> driver_of_; /* what drives a joint, by what it sets */
  Robot robot_;
};

std::vector<const XmlElement *> MjcfReader::in_sections(const char *section) const
{
  std::vector<const XmlElement *> found;
  for (const XmlElement *one : root_.children_named(section))
    for (const XmlElement &child : one->children) found.push_back(&child);
  return found;
}

/* What another file would add may be anything, so that the rest would be another model. */
void MjcfReader::refuse_includes(const XmlElement &element) const
{
  if (element.name == "include") element.fail("other files are not included; put their contents here");
  for (const XmlElement &child : element.children) refuse_includes(child);
}

void MjcfReader::read_option(const XmlElement &option)
{
  constexpr const char *known[] = {"gravity"}, *children[] = {"flag"};
  notes_.add_other_attributes(option, known);
  notes_.add_other_children(option, children);
  if (const auto gravity = option.vector("gravity")) scene_.gravity = rounded(*gravity);
  const XmlElement *flag = option.child("flag");
  if (!flag) return;
  notes_.add_other_attributes(*flag, known);
  if (flag->text("gravity").value_or("enable") == "disable") scene_.gravity = {0, 0, 0};
}

void MjcfReader::read_contacts()
{
  MjcfExclusions excluded;
  for (const XmlElement *contact : in_sections("contact")) {
    if (contact->name != "exclude") {
      notes_.add(*contact, fmt::format("<{}> of <contact> is not held", contact->name));
      continue;
    }
    excluded.emplace(bodies_.mover_of(bodies_.link_of(*contact, "body1")),
                     bodies_.mover_of(bodies_.link_of(*contact, "body2")));
  }
  bodies_.set_filters(excluded, root_);
}

/* connect: a ball joint at a place of body1; weld: a fixed joint at the pose of body2 in body1. */
void MjcfReader::connect(const XmlElement &element)
{
  constexpr const char *known[] = {"name", "class", "body1", "body2", "anchor", "relpose", "active"};
  notes_.add_other_attributes(element, known);
  LinkConnection connection;
  const bool welds = element.name == "weld";
  connection.name = element.text("name").value_or("");
  connection.line = element.line;
  connection.type = welds ? JointType::fixed : JointType::ball;
  connection.link_a = bodies_.link_of(element, "body1");
  connection.link_b = element.has("body2") ? bodies_.link_of(element, "body2") : 0;
  const RigidFrame place_a = bodies_.place_of(connection.link_a), place_b = bodies_.place_of(connection.link_b);
  if (welds) connection.a = inverse(place_a) * place_b;
  else {
    element.needed_text("anchor");
    connection.a.position = vector_of(*element.vector("anchor"));
    connection.b = inverse(place_b) * (place_a * connection.a);
  }
  const std::vector<double> pose = element.numbers("relpose", 7, 7);
  if (welds && !pose.empty() && (pose[3] != 0 || pose[4] != 0 || pose[5] != 0 || pose[6] != 0))
    connection.a = {{pose[0], pose[1], pose[2]}, unit(Rotation{pose[4], pose[5], pose[6], pose[3]})};
  robot_.connections.push_back(connection);
}

std::string MjcfReader::joint_name(const XmlElement &element, const char *key) const
{
  const std::string name = element.needed_text(key);
  if (!bodies_.joints.count(name)) element.fail(fmt::format("joint \"{}\" does not exist in this file", name));
  return name;
}

void MjcfReader::couple(const XmlElement &equality)
{
  constexpr const char *known[] = {"name", "class", "joint1", "joint2", "polycoef", "active"};
  notes_.add_other_attributes(equality, known);
  const bool follows = equality.has("joint2");
  std::vector<double> coefficients = equality.numbers("polycoef", 1, 5);
  if (coefficients.empty()) coefficients = {0, 1};
  coefficients.resize(5);
  JointCoupling coupling{
      equality.line,           joint_name(equality, "joint1"), follows ? joint_name(equality, "joint2") : "",
      "<joint> of <equality>", follows ? coefficients[1] : 0,  coefficients[0]};
  if (std::any_of(coefficients.begin() + 2, coefficients.end(), [](double x) { return x != 0; }))
    notes_.add(equality, "polycoef beyond its second number is not held");
  robot_.couplings.push_back(std::move(coupling));
}

void MjcfReader::read_equality(const XmlElement &written)
{
  const XmlElement equality = defaults_.completed(written, "");
  const bool connects = (equality.name == "connect" || equality.name == "weld") && !equality.has("site1");
  if (!equality.boolean_or("active", true)) notes_.add(equality, fmt::format("<{}> is not active", equality.name));
  else if (connects) connect(equality);
  else if (equality.name == "joint") couple(equality);
  else
    notes_.add(equality, fmt::format("<{}> of <equality>{} is not held", equality.name,
                                     equality.has("site1") ? " between sites" : ""));
}

void MjcfReader::read_actuator(const XmlElement &written)
{
  const XmlElement actuator = defaults_.completed(written, "");
  const bool is_read = actuator.name == "position" || actuator.name == "velocity" || actuator.name == "motor";
  if (!is_read || !actuator.has("joint"))
    return notes_.add(actuator, fmt::format("<{}> of <actuator>{} is not held", actuator.name,
                                            is_read ? " that drives no joint" : ""));
  const MjcfJointPlace &place = bodies_.joints.at(joint_name(actuator, "joint"));
  LinkJoint &joint = bodies_.links[place.link].joints[place.joint];
  if (auto driven = drive_mjcf_joint(actuator, compiler_, place.reference, joint, notes_))
    add_actuator(std::move(*driven));
}

/* An axis has one force and one target of each kind, so that a second control of it stays where it is. */
void MjcfReader::add_actuator(MjcfActuator actuator)
{
  const LinkActuator &driven = actuator.driven;
  const Control sets = driven.actuator.sets;
  const auto [first, is_new] = driver_of_.emplace(std::pair(driven.joint, sets), driven.what);
  if (is_new) return actuators_.push_back(std::move(actuator));
  const std::string stays =
      sets == Control::force ? "exerts nothing" : fmt::format("stays at a control of {:g}", actuator.rest);
  notes_.add(driven.line, fmt::format("{} {}, because {} drives joint \"{}\" in the same way", driven.what, stays,
                                      first->second, driven.joint));
}

void MjcfReader::map_actuators()
{
  for (MjcfActuator &actuator : actuators_) {
    const MjcfJointPlace &place = bodies_.joints.at(actuator.driven.joint);
    map_mjcf_control(bodies_.links[place.link].joints[place.joint].settings, actuator);
    robot_.actuators.push_back(std::move(actuator.driven));
  }
}

/* What is not read is listed; of lists, each kind of entry. */
void MjcfReader::note_rest()
{
  constexpr const char *read[] = {"compiler", "option",   "default", "asset",  "worldbody", "contact",
                                  "equality", "actuator", "tendon",  "sensor", "keyframe"};
  notes_.add_other_children(root_, read);
  for (const char *list : {"tendon", "sensor", "keyframe"})
    for (const XmlElement *section : root_.children_named(list)) notes_.add_other_children(*section, {});
}

Scene MjcfReader::read()
{
  if (root_.name != "mujoco")
    root_.fail(root_.name == "robot" ? "is URDF; name the file .urdf" : "is no <mujoco>; an MJCF file begins with one");
  refuse_includes(root_);
  scene_.name = root_.text("model").value_or("");
  scene_.gravity = {0, 0, -9.81f};
  robot_.file = *root_.file;
  for (const XmlElement *compiler : root_.children_named("compiler")) compiler_.read(*compiler, notes_);
  for (const XmlElement *option : root_.children_named("option")) read_option(*option);
  for (const XmlElement *top : root_.children_named("default")) defaults_.read(*top);
  for (const XmlElement *asset : root_.children_named("asset")) geoms_.read_assets(*asset);
  for (const XmlElement *world : root_.children_named("worldbody")) bodies_.read(*world);
  read_contacts();
  for (const XmlElement *equality : in_sections("equality")) read_equality(*equality);
  for (const XmlElement *actuator : in_sections("actuator")) read_actuator(*actuator);
  map_actuators();
  note_rest();
  robot_.links = bodies_.links;
  add_robot(robot_, notes_, scene_);
  for (const std::string &line : notes_.lines(*root_.file)) scene_.notes.push_back(line);
  if (scene_.bodies.empty()) root_.fail("no body and no geom; there is nothing to simulate");
  validate(scene_, *root_.file);
  return std::move(scene_);
}

} // namespace

Scene parse_scene_mjcf(const std::string &text, const std::string &path, OutsideFiles outside, Coordinates coordinates)
{
  return MjcfReader(parse_xml(text, path), outside, coordinates).read();
}

Scene read_scene_mjcf(const std::string &path, OutsideFiles outside, Coordinates coordinates)
{
  return parse_scene_mjcf(read_file(path), path, outside, coordinates);
}

} // namespace tandem
