/* scene.cpp - from the links and joints of a URDF file, in any order, to a tree; see scene.h. */
#include "host/io/urdf/scene.h"

#include <fmt/format.h>

#include "host/base/printable.h"
#include "host/geometry/shape_mass.h"
#include "host/io/urdf/geometry.h"
#include "host/io/urdf/joints.h"

namespace tandem {
namespace {

constexpr double density_of_shapes = 1000; /* kg/m^3, of links that move and have no <inertial>: that of water */

class UrdfReader {
public:
  UrdfReader(XmlElement root, OutsideFiles outside, Coordinates coordinates) : root_(std::move(root)), outside_(outside)
  {
    robot_.coordinates = coordinates;
  }
  Scene read();

private:
  struct Node {
    const XmlElement *link;
    const XmlElement *joint = nullptr; /* to its parent */
    std::string parent;
  };
  void find_links();
  void find_joint(const XmlElement &joint);
  std::string linked(const XmlElement &joint, const char *side) const;
  std::string root_name() const;
  void add_links();
  void add_link(const std::string &name, size_t parent);
  uint32_t material_of(const XmlElement &link);
  void give_mass(const XmlElement &element, Link &link);
  void add_mimics();

  const XmlElement root_;
  OutsideFiles outside_;
  XmlNotes notes_;
  Scene scene_;
  Robot robot_;
  std::map<std::string, Node> nodes_;
  std::map<std::string, std::vector<std::string>> children_; /* of each link, in the order of the joints */
  std::map<std::string, const XmlElement *> joints_;
};

void UrdfReader::find_links()
{
  for (const XmlElement *link : root_.children_named("link")) {
    const auto [at, is_new] = nodes_.emplace(link->needed_text("name"), Node{link, nullptr, {}});
    if (!is_new)
      link->fail(fmt::format("line {} has a link of that name; names are needed once", at->second.link->line));
  }
  if (nodes_.empty()) root_.fail("<link> is missing; at least one is needed");
  for (const XmlElement *joint : root_.children_named("joint")) find_joint(*joint);
}

std::string UrdfReader::linked(const XmlElement &joint, const char *side) const
{
  const XmlElement *end = joint.child(side);
  if (!end) joint.fail(fmt::format("<{}> is missing; one is needed", side));
  const std::string name = end->needed_text("link");
  if (!nodes_.count(name)) end->fail(fmt::format("link \"{}\" does not exist in this file", name));
  return name;
}

void UrdfReader::find_joint(const XmlElement &joint)
{
  const auto [at, is_new] = joints_.emplace(joint.needed_text("name"), &joint);
  if (!is_new) joint.fail(fmt::format("line {} has a joint of that name; names are needed once", at->second->line));
  const std::string parent = linked(joint, "parent"), child = linked(joint, "child");
  Node &node = nodes_.at(child);
  if (parent == child) joint.fail(fmt::format("connects link \"{}\" with itself; two links are needed", child));
  if (node.joint)
    joint.fail(fmt::format("link \"{}\" has a parent by the joint in line {}; one is needed", child, node.joint->line));
  node.joint = &joint;
  node.parent = parent;
  children_[parent].push_back(child);
}

std::string UrdfReader::root_name() const
{
  const Node *root = nullptr;
  std::string name;
  for (const XmlElement *link : root_.children_named("link")) {
    const Node &node = nodes_.at(*link->text("name"));
    if (node.joint) continue;
    if (root) link->fail(fmt::format("has no parent, as link \"{}\" has none; one root is needed", name));
    root = &node;
    name = *link->text("name");
  }
  if (!root) root_.fail("each link has a parent, in a loop; a tree with one root is needed");
  return name;
}

/* Bullet's extension: <contact> with friction and restitution. */
uint32_t UrdfReader::material_of(const XmlElement &link)
{
  const XmlElement *contact = link.child("contact");
  if (!contact) return 0;
  constexpr const char *known[] = {"lateral_friction", "rolling_friction", "spinning_friction", "restitution"};
  notes_.add_other_children(*contact, known);
  Material material;
  material.name = *link.text("name");
  const auto value = [&](const char *name, float otherwise) {
    const XmlElement *found = contact->child(name);
    return found ? round_to_float(found->at_least_zero_or("value", double{otherwise})) : otherwise;
  };
  material.static_friction = material.dynamic_friction = value("lateral_friction", material.static_friction);
  material.rolling_friction = value("rolling_friction", 0);
  material.spinning_friction = value("spinning_friction", 0);
  material.restitution = value("restitution", 0);
  scene_.materials.push_back(material);
  return uint32_t(scene_.materials.size() - 1);
}

void UrdfReader::give_mass(const XmlElement &element, Link &link)
{
  std::vector<MassProperties> parts;
  for (const LinkShape &shape : link.shapes) {
    if (shape.shape.type == ShapeType::half_space) continue;
    const MassProperties solid = mass_properties_of(shape.shape);
    parts.push_back(placed_mass(with_mass(solid, density_of_shapes * solid.mass), shape.pose));
  }
  if (parts.empty()) return;
  link.mass = compound_mass(parts);
  notes_.add(element,
             fmt::format("a link without <inertial> has the mass of its shapes, of {:g} kg/m^3", density_of_shapes));
}

/* The root stands if it is called "world" or has no mass, and floats otherwise. */
void UrdfReader::add_link(const std::string &name, size_t parent)
{
  constexpr const char *of_link[] = {"inertial", "collision", "contact"};
  constexpr const char *of_joint[] = {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"};
  const Node &node = nodes_.at(name);
  notes_.add_other_children(*node.link, of_link);
  Link link;
  link.name = name;
  link.line = node.link->line;
  link.parent = parent;
  link.shapes = urdf_shapes(*node.link, outside_, notes_);
  const uint32_t material = material_of(*node.link);
  for (LinkShape &shape : link.shapes) shape.material = material;
  link.mass = urdf_mass(*node.link, notes_);
  if (node.joint) {
    notes_.add_other_children(*node.joint, of_joint);
    link.pose = urdf_origin(*node.joint);
    link.joints = urdf_joints(*node.joint, notes_);
    link.floats = *node.joint->text("type") == "floating";
    const bool moves = !link.joints.empty() || link.floats;
    if (moves && !node.link->child("inertial")) give_mass(*node.link, link);
  } else link.floats = name != "world" && link.mass.has_value();
  robot_.links.push_back(link);
}

void UrdfReader::add_links()
{
  std::vector<std::pair<std::string, size_t>> pending{{root_name(), Link::world}};
  while (!pending.empty()) {
    const auto [name, parent] = pending.back();
    pending.pop_back();
    add_link(name, parent);
    const std::vector<std::string> &below = children_[name];
    const size_t index = robot_.links.size() - 1;
    for (auto child = below.rbegin(); child != below.rend(); ++child) pending.emplace_back(*child, index);
    nodes_.erase(name);
  }
  if (!nodes_.empty()) nodes_.begin()->second.link->fail("is in a loop of joints; a tree is needed");
}

void UrdfReader::add_mimics()
{
  for (const auto &[name, joint] : joints_) {
    const XmlElement *mimic = joint->child("mimic");
    if (!mimic) continue;
    const std::string followed = mimic->needed_text("joint");
    if (!joints_.count(followed)) mimic->fail(fmt::format("joint \"{}\" does not exist in this file", followed));
    robot_.couplings.push_back(
        {mimic->line, name, followed, "<mimic>", mimic->number_or("multiplier", 1), mimic->number_or("offset", 0)});
  }
}

Scene UrdfReader::read()
{
  constexpr const char *known[] = {"link", "joint"};
  if (root_.name != "robot") root_.fail("is no <robot>; a URDF file begins with one");
  notes_.add_other_children(root_, known);
  scene_.name = root_.text("name").value_or("");
  scene_.gravity = {0, 0, -9.81f};
  robot_.file = *root_.file;
  find_links();
  add_links();
  add_mimics();
  add_robot(robot_, notes_, scene_);
  for (const std::string &line : notes_.lines(*root_.file)) scene_.notes.push_back(line);
  if (scene_.bodies.empty()) root_.fail("no link has a mass or a collision shape; there is nothing to simulate");
  validate(scene_, *root_.file);
  return std::move(scene_);
}

} // namespace

Scene parse_scene_urdf(const std::string &text, const std::string &path, OutsideFiles outside, Coordinates coordinates)
{
  return UrdfReader(parse_xml(text, path), outside, coordinates).read();
}

Scene read_scene_urdf(const std::string &path, OutsideFiles outside, Coordinates coordinates)
{
  return parse_scene_urdf(read_file(path), path, outside, coordinates);
}

} // namespace tandem
