/* geometry.cpp - reads <origin>, <collision> and <inertial>; see geometry.h. */
#include "host/io/urdf/geometry.h"

#include <fmt/format.h>

#include "host/geometry/shape_mass.h"

namespace tandem {
namespace {

/* The links of one robot do not collide with each other, as in Bullet and Gazebo: their shapes often overlap. */
constexpr uint32_t robot_group = 2;

std::vector<std::string> places_of_mesh(const std::string &name)
{
  const std::string package = "package://", file = "file://";
  if (name.starts_with(file)) return {name.substr(file.size())};
  if (!name.starts_with(package)) return {name};
  const std::string path = name.substr(package.size());
  const size_t slash = path.find('/');
  if (slash == std::string::npos) return {path};
  return {path, path.substr(slash + 1)};
}

std::optional<Shape> urdf_mesh(const XmlElement &mesh, OutsideFiles outside, XmlNotes &notes)
{
  constexpr const char *known[] = {"filename", "scale"};
  notes.add_other_attributes(mesh, known);
  const std::string name = mesh.needed_text("filename");
  const Double3 scale = mesh.vector_or("scale", {1, 1, 1});
  if (!is_mesh_file(name)) {
    notes.add(mesh, fmt::format("the mesh \"{}\" is left out; .obj and .stl are read", name));
    return {};
  }
  for (const std::string &place : places_of_mesh(name))
    if (!lacks_file_beside(*mesh.file, place))
      return hull_of_file(mesh, place, {round_to_float(scale[0]), round_to_float(scale[1]), round_to_float(scale[2])},
                          outside);
  notes.add(mesh, fmt::format("the mesh \"{}\" does not exist beside the file; it is left out", name));
  return {};
}

/* Stand along Z in the file and along Y in a scene. */
Shape upright(const XmlElement &element, LinkShape &placed, XmlNotes &notes)
{
  constexpr const char *known[] = {"radius", "length"};
  notes.add_other_attributes(element, known);
  const float radius = checked_length(element, "radius", element.needed_number("radius")),
              half = checked_length(element, "half of length", element.needed_number("length") / 2);
  placed.pose = placed.pose * y_along_z();
  return element.name == "capsule" ? capsule_shape(radius, half) : cylinder_shape(radius, half);
}

Shape urdf_box(const XmlElement &box)
{
  box.needed_text("size");
  const Double3 size = *box.vector("size");
  const auto half = [&](size_t axis) { return checked_length(box, "half of a size", size[axis] / 2); };
  return box_shape(half(0), half(1), half(2));
}

Shape urdf_plane(const XmlElement &plane, LinkShape &placed)
{
  const Vector normal = checked_axis(plane, "normal", plane.vector_or("normal", {0, 0, 1}));
  placed.pose.rotation = product_of(placed.pose.rotation, rotation_of_axes(normal.cross(any_across(normal)), normal));
  return half_space_shape();
}

/* False if the shape is left out, with a note. */
bool read_geometry(const XmlElement &geometry, OutsideFiles outside, LinkShape &placed, XmlNotes &notes)
{
  if (geometry.children.size() != 1) geometry.fail("one shape is needed: box, cylinder, sphere, capsule or mesh");
  const XmlElement &kind = geometry.children.front();
  if (kind.name == "box") placed.shape = urdf_box(kind);
  else if (kind.name == "sphere")
    placed.shape = sphere_shape(checked_length(kind, "radius", kind.needed_number("radius")));
  else if (kind.name == "cylinder" || kind.name == "capsule") placed.shape = upright(kind, placed, notes);
  else if (kind.name == "plane") placed.shape = urdf_plane(kind, placed);
  else if (kind.name == "mesh") {
    const std::optional<Shape> hull = urdf_mesh(kind, outside, notes);
    if (!hull) return false;
    placed.shape = *hull;
  } else {
    notes.add(kind, fmt::format("<{}> of <geometry> is left out", kind.name));
    return false;
  }
  return true;
}

} // namespace

RigidFrame urdf_origin(const XmlElement &element)
{
  const XmlElement *origin = element.child("origin");
  if (!origin) return {};
  const Double3 xyz = origin->vector_or("xyz", {0, 0, 0}), rpy = origin->vector_or("rpy", {0, 0, 0});
  for (double angle : rpy) checked_angle(*origin, "rpy", angle);
  const Rotation roll = rotation_about({1, 0, 0}, rpy[0]), pitch = rotation_about({0, 1, 0}, rpy[1]),
                 yaw = rotation_about({0, 0, 1}, rpy[2]);
  return {vector_of(xyz), unit(product_of(yaw, product_of(pitch, roll)))};
}

std::vector<LinkShape> urdf_shapes(const XmlElement &link, OutsideFiles outside, XmlNotes &notes)
{
  constexpr const char *known[] = {"origin", "geometry"};
  std::vector<LinkShape> shapes;
  for (const XmlElement *collision : link.children_named("collision")) {
    notes.add_other_children(*collision, known);
    const XmlElement *geometry = collision->child("geometry");
    if (!geometry) collision->fail("<geometry> is missing; one is needed");
    LinkShape placed;
    placed.name = collision->text("name").value_or("");
    placed.pose = urdf_origin(*collision);
    placed.filter_group = robot_group;
    placed.filter_mask = ~robot_group;
    if (read_geometry(*geometry, outside, placed, notes)) shapes.push_back(placed);
  }
  return shapes;
}

std::optional<MassProperties> urdf_mass(const XmlElement &link, XmlNotes &notes)
{
  const XmlElement *inertial = link.child("inertial");
  if (!inertial) return {};
  constexpr const char *known[] = {"origin", "mass", "inertia"};
  notes.add_other_children(*inertial, known);
  const XmlElement *mass = inertial->child("mass"), *inertia = inertial->child("inertia");
  if (!mass) inertial->fail("<mass> is missing; one is needed");
  const double kilograms = mass->needed_number("value");
  if (!(kilograms >= 0)) mass->fail(fmt::format("value is {:g} kg; at least 0 is needed", kilograms));
  if (kilograms == 0) return {};
  if (!inertia) inertial->fail("<inertia> is missing; one is needed");
  const auto moment = [&](const char *key) { return inertia->number_or(key, 0); };
  const MassProperties own{kilograms,
                           {},
                           {inertia->needed_number("ixx"), inertia->needed_number("iyy"), inertia->needed_number("izz"),
                            moment("ixy"), moment("ixz"), moment("iyz")}};
  return placed_mass(own, urdf_origin(*inertial));
}

} // namespace tandem
