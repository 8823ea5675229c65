/* robot_text.h - small robots as text, and what a scene made of them, for the tests of the readers of URDF and MJCF. */
#pragma once

#include <numbers>
#include <string>

#include <Eigen/Geometry>

#include "host/geometry/mass_properties.h"
#include "host/io/mjcf/scene.h"
#include "host/io/urdf/scene.h"
#include "tests/catch.h"
#include "tests/host/geometry/shapes.h"

namespace tandem::robot_text {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using geometry_test::complaint;

inline constexpr double degree = std::numbers::pi / 180;

/* No file has these names; meshes are sought beside them. */
inline const std::string urdf_path = "/no-such-folder/robot.urdf", mjcf_path = "/no-such-folder/robot.xml";

inline Scene urdf(const std::string &inside)
{
  return parse_scene_urdf("<robot name=\"r\">" + inside + "</robot>", urdf_path);
}

inline Scene mjcf(const std::string &inside)
{
  return parse_scene_mjcf("<mujoco model=\"m\">" + inside + "</mujoco>", mjcf_path);
}

inline std::string urdf_link(const std::string &name, const std::string &inside)
{
  return "<link name=\"" + name + "\">" + inside + "</link>";
}

/* A ball of 2 kg and 0.1 m. */
inline const std::string inertial =
    R"(<inertial><mass value="2"/><inertia ixx="0.008" iyy="0.008" izz="0.008"/></inertial>)";
inline const std::string ball = inertial + R"(<collision><geometry><sphere radius="0.1"/></geometry></collision>)";

inline std::string urdf_joint(const std::string &name, const std::string &type, const std::string &parent,
                              const std::string &child, const std::string &inside = "")
{
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + inside + "</joint>";
}

inline Quaterniond turn_of(const Quat &q) { return Quaterniond(q[3], q[0], q[1], q[2]).normalized(); }
inline Vector3d vector_of_point(const Point &p) { return {p[0], p[1], p[2]}; }

/* The tensor of a body about its centre of mass, along the axes of the world. */
inline Matrix3d tensor_of(const Body &body)
{
  const Matrix3d axes = turn_of(body.orientation).toRotationMatrix();
  return axes * Vector3d(body.inertia[0], body.inertia[1], body.inertia[2]).asDiagonal() * axes.transpose();
}

/* A frame of a joint in the world, whose columns are its axes. */
struct FrameInWorld {
  Vector3d at;
  Matrix3d axes;
};
inline FrameInWorld frame_in_world(const Scene &scene, uint32_t body, const Point &position, const Quat &orientation)
{
  if (body == no_body) return {vector_of_point(position), turn_of(orientation).toRotationMatrix()};
  const Quaterniond turn = turn_of(scene.bodies[body].orientation);
  return {vector_of_point(scene.bodies[body].position) + turn * vector_of_point(position),
          (turn * turn_of(orientation)).toRotationMatrix()};
}
inline FrameInWorld frame_a(const Scene &scene, const Joint &joint)
{
  return frame_in_world(scene, joint.body_a, joint.position_a, joint.orientation_a);
}
inline FrameInWorld frame_b(const Scene &scene, const Joint &joint)
{
  return frame_in_world(scene, joint.body_b, joint.position_b, joint.orientation_b);
}

inline const Body &body_named(const Scene &scene, const std::string &name)
{
  for (const Body &body : scene.bodies)
    if (body.name == name) return body;
  FAIL("no body " + name);
  return scene.bodies.front();
}

inline bool has_note(const Scene &scene, const std::string &part)
{
  for (const std::string &note : scene.notes)
    if (note.find(part) != std::string::npos) return true;
  return false;
}

inline double mass_of_hull(const Shape &shape) { return hull_mass(*shape.hull).mass; }

/* One line that begins with the file. */
inline void check_one_line(const std::string &said, const std::string &path, const std::string &mentions)
{
  INFO(said);
  CHECK(said.find(path) == 0);
  CHECK(said.find('\n') == std::string::npos);
  CHECK_THAT(said, Catch::Matchers::ContainsSubstring(mentions));
}

} // namespace tandem::robot_text
