/* scene_test.cpp - links and joints of URDF: masses, frames, limits and drives against figures worked out by hand or in
 * double with Eigen, and what is listed since it cannot be held. */
#include <tandem/load_scene.h>

#include "host/io/json/scene.h"
#include "tests/host/io/robot_text.h"
#include "tests/tools/command/command_line.h"

using namespace tandem;
using namespace tandem::robot_text;

namespace {

const std::string limit = R"(<limit lower="-1" upper="2" effort="7" velocity="3"/>)";

} // namespace

TEST_CASE("urdf: a root floats with its inertia, and stands if it is the world or has no mass")
{
  const Scene floating = urdf(urdf_link("base", ball));
  REQUIRE(floating.bodies.size() == 1);
  CHECK(floating.gravity == Vec3{0, 0, -9.81f});
  CHECK(floating.bodies[0].type == BodyType::dynamic);
  CHECK(floating.bodies[0].mass == 2.0f);
  CHECK(floating.bodies[0].inertia == Vec3{0.008f, 0.008f, 0.008f});
  const std::string shape = R"(<collision><geometry><box size="1 2 3"/></geometry></collision>)";
  for (const Scene &standing : {urdf(urdf_link("world", ball)), urdf(urdf_link("base", shape))})
    CHECK(standing.bodies.at(0).type == BodyType::fixed);
}

TEST_CASE("urdf: moments are turned onto their principal axes, and the body's tensor is the file's")
{
  const Scene scene = urdf(urdf_link("base", R"(<inertial><origin xyz="1 2 3" rpy="0.3 -0.4 0.5"/><mass value="4"/>
    <inertia ixx="1" ixy="0.1" ixz="-0.2" iyy="1.5" iyz="0.05" izz="2"/></inertial>)"));
  const Body &body = scene.bodies.at(0);
  const Matrix3d turn =
      (AngleAxisd(0.5, Vector3d::UnitZ()) * AngleAxisd(-0.4, Vector3d::UnitY()) * AngleAxisd(0.3, Vector3d::UnitX()))
          .toRotationMatrix();
  Matrix3d written;
  written << 1, 0.1, -0.2, 0.1, 1.5, 0.05, -0.2, 0.05, 2;
  CHECK((tensor_of(body) - turn * written * turn.transpose()).norm() < 1e-6);
  CHECK((vector_of_point(body.position) - Vector3d(1, 2, 3)).norm() < 1e-12);
  CHECK(body.filter_mask == 0); /* nothing to collide with */
}

TEST_CASE("urdf: links joined by a fixed joint are one body with the mass, centre and moments of both")
{
  const Scene scene = urdf(urdf_link("base", ball) + urdf_link("tip", ball) +
                           urdf_joint("weld", "fixed", "base", "tip", R"(<origin xyz="0 0 0.6"/>)"));
  REQUIRE(scene.bodies.size() == 1);
  CHECK(scene.joints.empty());
  const Body &body = scene.bodies[0];
  CHECK(body.name == "base");
  CHECK(body.mass == 4.0f);
  CHECK((vector_of_point(body.position) - Vector3d(0, 0, 0.3)).norm() < 1e-12);
  const double across = 2 * (0.008 + 2 * 0.3 * 0.3); /* Steiner */
  CHECK((tensor_of(body) - Vector3d(across, across, 0.016).asDiagonal().toDenseMatrix()).norm() < 1e-6);
  CHECK(scene.shapes[body.shape].compound->children.size() == 2);
  CHECK(has_note(scene, "is part of its parent's body"));
}

TEST_CASE("urdf: a revolute joint has its place, axis, limits, strength and losses")
{
  const Scene scene = urdf(urdf_link("base", ball) + urdf_link("arm", ball) +
                           urdf_joint("elbow", "revolute", "base", "arm",
                                      R"(<origin xyz="0 0.5 0" rpy="0 0 1.5707963267948966"/><axis xyz="0 2 0"/>)" +
                                          limit + R"(<dynamics damping="0.4" friction="0.2"/>)"));
  REQUIRE(scene.joints.size() == 1);
  const Joint &elbow = scene.joints[0];
  CHECK(elbow.name == "elbow");
  CHECK(elbow.type == JointType::hinge);
  for (const FrameInWorld &frame : {frame_a(scene, elbow), frame_b(scene, elbow)}) {
    CHECK((frame.at - Vector3d(0, 0.5, 0)).norm() < 1e-6);
    CHECK((frame.axes.col(0) - Vector3d(-1, 0, 0)).norm() < 1e-6); /* y of the child, turned by a right angle */
  }
  const JointAxis &axis = elbow.rotations[0];
  CHECK(axis.lower == -1.0f);
  CHECK(axis.upper == 2.0f);
  CHECK(axis.max_force == 7.0f);
  CHECK(axis.max_speed == 3.0f);
  CHECK(axis.damping == 0.4f);
  CHECK(axis.friction == 0.2f);
}

TEST_CASE("urdf: each type of joint is the one that leaves the same free")
{
  const auto of = [](const std::string &type, const std::string &inside) {
    const Scene scene =
        urdf(urdf_link("base", ball) + urdf_link("arm", ball) + urdf_joint("j", type, "base", "arm", inside));
    return scene.joints.empty() ? Joint{} : scene.joints[0];
  };
  CHECK(of("continuous", limit).type == JointType::hinge);
  CHECK(of("continuous", limit).rotations[0].upper == JointAxis::unlimited);
  const Joint slider = of("prismatic", limit);
  CHECK(slider.type == JointType::slider);
  CHECK(slider.directions[0].lower == -1.0f);
  CHECK(slider.directions[0].upper == 2.0f);
  const Joint plane = of("planar", R"(<axis xyz="0 0 1"/>)");
  CHECK(plane.type == JointType::six_dof);
  CHECK(plane.held_directions == Axes{true, false, false});
  CHECK(plane.held_rotations == Axes{false, true, true});
  CHECK(urdf(urdf_link("base", ball) + urdf_link("arm", ball) + urdf_joint("j", "floating", "base", "arm"))
            .bodies.size() == 2);
}

TEST_CASE("urdf: joints of links without mass become one joint of the next link, with their limits about its axes")
{
  const Scene scene =
      urdf(urdf_link("base", ball) + urdf_link("a", "") + urdf_link("b", "") + urdf_link("arm", ball) +
           urdf_joint("z", "revolute", "base", "a",
                      R"(<origin xyz="0 0 1"/><axis xyz="0 0 -1"/><limit lower="-0.1" upper="0.2"/>)") +
           urdf_joint("x", "revolute", "a", "b", R"(<axis xyz="1 0 0"/><limit lower="-0.3" upper="0.4"/>)") +
           urdf_joint("y", "revolute", "b", "arm", R"(<axis xyz="0 1 0"/><limit lower="-0.5" upper="0.6"/>)"));
  REQUIRE(scene.joints.size() == 1);
  REQUIRE(scene.bodies.size() == 2);
  const Joint &joint = scene.joints[0];
  CHECK(joint.name == "z, x, y");
  const std::map<std::string, Vector3d> axes{{"z", {0, 0, -1}}, {"x", {1, 0, 0}}, {"y", {0, 1, 0}}};
  const std::map<std::string, std::pair<float, float>> limits{
      {"z", {-0.1f, 0.2f}}, {"x", {-0.3f, 0.4f}}, {"y", {-0.5f, 0.6f}}};
  const Matrix3d frame = frame_a(scene, joint).axes;
  for (const auto &[name, axis] : axes)
    for (int k = 0; k < 3; ++k) {
      const double along = frame.col(k).dot(axis);
      if (std::abs(along) < 0.5) continue;
      CAPTURE(name, k, along);
      const auto [lower, upper] = limits.at(name);
      CHECK(joint.rotations[size_t(k)].lower == (along > 0 ? lower : -upper));
      CHECK(joint.rotations[size_t(k)].upper == (along > 0 ? upper : -lower));
    }
  CHECK((frame.col(0) - axes.at("y")).norm() < 1e-6); /* the last is the twist */
  CHECK(std::abs(frame.determinant() - 1) < 1e-6);
  CHECK(has_note(scene, "z, x, y are one joint"));
}

TEST_CASE("urdf: hinges that are not at right angles stay two joints, with a tenth of the mass between them")
{
  const Scene scene = urdf(urdf_link("base", ball) + urdf_link("a", "") + urdf_link("arm", ball) +
                           urdf_joint("one", "continuous", "base", "a", R"(<axis xyz="0 0 1"/>)") +
                           urdf_joint("two", "continuous", "a", "arm", R"(<axis xyz="0 1 1"/>)"));
  REQUIRE(scene.bodies.size() == 3);
  REQUIRE(scene.joints.size() == 3);
  CHECK(scene.joints[0].type == JointType::hinge);
  CHECK(scene.joints[1].type == JointType::hinge);
  CHECK((frame_a(scene, scene.joints[0]).axes.col(0) - Vector3d(0, 0, 1)).norm() < 1e-6);
  CHECK((frame_b(scene, scene.joints[1]).axes.col(0) - Vector3d(0, 1, 1).normalized()).norm() < 1e-6);
  const Body &arm = body_named(scene, "arm"), &between = body_named(scene, "arm after one");
  CHECK(arm.mass == Approx(1.8));
  CHECK(arm.mass + between.mass == Approx(2));
  CHECK((tensor_of(arm) + tensor_of(between) - 0.008 * Matrix3d::Identity()).norm() < 1e-6);
  const Joint &apart = scene.joints[2]; /* holds nothing, but keeps arm and base from colliding */
  CHECK(apart.type == JointType::six_dof);
  CHECK(apart.held_directions == Axes{});
  CHECK(apart.held_rotations == Axes{});
  CHECK(has_note(scene, "bodies with 0.1 of the mass stand between them"));
}

TEST_CASE("urdf: meshes of OBJ and STL beside the file are hulls, scaled, and one that is missing is listed")
{
  const command_line::Scratch folder;
  std::filesystem::create_directories(folder.path / "arm" / "meshes");
  std::ofstream(folder.file("tip.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  std::ofstream(folder.path / "arm" / "meshes" / "tip.STL")
      << "solid s\nfacet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n"
         "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 0 1 endloop endfacet\nendsolid\n";
  const auto mesh = [](const std::string &name) {
    return "<collision><geometry><mesh filename=\"" + name + "\" scale=\"2 1 -1\"/></geometry></collision>";
  };
  const std::string text = "<robot name=\"r\">" +
                           urdf_link("base", inertial + mesh("tip.obj") + mesh("package://arm/meshes/tip.STL") +
                                                 mesh("package://other/tip.obj") + mesh("none.stl") + mesh("tip.dae")) +
                           "</robot>";
  std::ofstream(folder.file("robot.urdf")) << text;
  const Scene scene = load_scene(folder.file("robot.urdf"));
  const auto &children = scene.shapes.at(scene.bodies.at(0).shape).compound->children;
  REQUIRE(children.size() == 3);
  for (const Child &child : children) {
    CHECK(child.shape.type == ShapeType::hull);
    CHECK(mass_of_hull(child.shape) == Approx(2.0 / 6));
  }
  CHECK(has_note(scene, "the mesh \"none.stl\" does not exist beside the file"));
  CHECK(has_note(scene, "the mesh \"tip.dae\" is left out"));
}

TEST_CASE("urdf: what a scene does not have is listed by name, with its line and its count")
{
  const Scene scene = urdf(
      "\n" + urdf_link("base", ball + "<visual/><visual/>") + urdf_link("arm", ball) +
      urdf_joint("a", "continuous", "base", "arm", "<safety_controller/>") + urdf_link("leg", ball) +
      urdf_joint("b", "continuous", "base", "leg", R"(<mimic joint="a"/>)") + "<transmission name=\"t\"/><gazebo/>");
  CHECK(has_note(scene, "<visual> of <link> is not held (2 times, the first in line 2)"));
  CHECK(has_note(scene, "<safety_controller> of <joint> is not held (line 2)"));
  CHECK(has_note(scene, "<transmission> of <robot> is not held"));
  CHECK(has_note(scene, "<gazebo> of <robot> is not held"));
  CHECK(scene.notes.size() == 4);
  REQUIRE(scene.couplings.size() == 1);
  CHECK(scene.couplings[0].joint_a == 1);
  CHECK(scene.couplings[0].joint_b == 0);
  CHECK((scene.couplings[0].ratio == -1.0f && scene.couplings[0].offset == 0.0f));
}

TEST_CASE("urdf: what was read is written as JSON and read again without loss")
{
  const Scene scene =
      urdf(urdf_link("base", ball) + urdf_link("arm", ball) +
           urdf_joint("elbow", "revolute", "base", "arm", R"(<origin xyz="0 0.1 0.3" rpy="1 2 3"/>)" + limit));
  const std::string text = to_scene_json(scene);
  CHECK(to_scene_json(parse_scene_json(text, "a.json")) == text);
}
