/* scene_test.cpp - bodies, geoms, classes and contacts of MJCF against figures worked out by hand, by brute force, or
 * in double with Eigen, and what is listed since it cannot be held. */
#include <numbers>

#include <fmt/format.h>

#include <tandem/load_scene.h>

#include "host/base/random.h"
#include "tests/host/io/robot_text.h"

using namespace tandem;
using namespace tandem::robot_text;

namespace {

std::string in_world(const std::string &inside) { return "<worldbody>" + inside + "</worldbody>"; }
std::string floating(const std::string &inside) { return "<body><freejoint/>" + inside + "</body>"; }

const Shape &only_shape(const Scene &scene) { return scene.shapes.at(scene.bodies.at(0).shape); }

/* The orientation of a body of the world whose geom is a box. */
Quaterniond turn_of_body(const std::string &compiler, const std::string &attributes)
{
  const Scene scene = mjcf(compiler + in_world("<body " + attributes + "><geom type=\"box\" size=\"1 2 3\"/></body>"));
  return turn_of(scene.bodies.at(0).orientation);
}

} // namespace

TEST_CASE("mjcf: each type of geom is its shape, along Z, with the mass of 1000 kg/m^3")
{
  const auto of = [](const std::string &attributes) { return mjcf(in_world(floating("<geom " + attributes + "/>"))); };
  const double pi = std::numbers::pi;
  CHECK(of(R"(size="0.1")").bodies.at(0).mass == Approx(4000 * pi / 3 * 0.001));
  CHECK(of(R"(type="box" size="0.1 0.2 0.3")").bodies.at(0).mass == Approx(8000 * 0.006));
  CHECK(of(R"(type="cylinder" size="0.1 0.2")").bodies.at(0).mass == Approx(1000 * pi * 0.01 * 0.4));
  CHECK(of(R"(type="ellipsoid" size="0.1 0.2 0.3")").bodies.at(0).mass == Approx(4000 * pi / 3 * 0.006));
  CHECK(of(R"(size="0.1" density="5")").bodies.at(0).mass == Approx(20 * pi / 3 * 0.001));
  CHECK(of(R"(size="0.1" mass="7")").bodies.at(0).inertia[1] == Approx(0.4 * 7 * 0.01));
  const Scene capsule = of(R"(type="capsule" size="0.1 0.2")");
  CHECK(capsule.bodies[0].mass == Approx(1000 * (4 * pi / 3 * 0.001 + pi * 0.01 * 0.4)));
  CHECK(only_shape(capsule).size == Vec3{0.1f, 0.2f, 0.1f});
  const Quaterniond turn = turn_of(capsule.bodies[0].orientation) * turn_of(capsule.bodies[0].shape_orientation);
  CHECK((turn * Vector3d::UnitY() - Vector3d::UnitZ()).norm() < 1e-6);
}

TEST_CASE("mjcf: fromto places a capsule between two points")
{
  const Scene scene = mjcf(in_world(floating(R"(<geom type="capsule" fromto="1 2 3 1 4 3" size="0.1"/>)")));
  const Body &body = scene.bodies.at(0);
  CHECK((vector_of_point(body.position) - Vector3d(1, 3, 3)).norm() < 1e-9);
  CHECK(only_shape(scene).size == Vec3{0.1f, 1, 0.1f});
  const Vector3d along = turn_of(body.orientation) * turn_of(body.shape_orientation) * Vector3d::UnitY();
  CHECK(std::abs(along.y()) == Approx(1).epsilon(1e-6));
}

TEST_CASE("mjcf: the ways to write a turn are those of Eigen")
{
  const auto x = [](double angle) { return AngleAxisd(angle, Vector3d::UnitX()); };
  const auto y = [](double angle) { return AngleAxisd(angle, Vector3d::UnitY()); };
  const auto z = [](double angle) { return AngleAxisd(angle, Vector3d::UnitZ()); };
  const auto check = [](const Quaterniond &actual, const Quaterniond &expected) {
    CHECK(actual.angularDistance(expected) < 1e-6);
  };
  check(turn_of_body("", R"(euler="10 20 30")"), x(10 * degree) * y(20 * degree) * z(30 * degree));
  check(turn_of_body(R"(<compiler eulerseq="XYZ"/>)", R"(euler="10 20 30")"),
        z(30 * degree) * y(20 * degree) * x(10 * degree));
  check(turn_of_body(R"(<compiler eulerseq="zxz" angle="radian"/>)", R"(euler="0.1 0.2 0.3")"),
        z(0.1) * x(0.2) * z(0.3));
  check(turn_of_body("", R"(quat="1 2 3 4")"), Quaterniond(1, 2, 3, 4).normalized());
  check(turn_of_body("", R"(axisangle="0 3 4 50")"), Quaterniond(AngleAxisd(50 * degree, Vector3d(0, 0.6, 0.8))));
  check(turn_of_body("", R"(zaxis="0 2 2")"), Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d(0, 2, 2)));
  Matrix3d axes;
  axes.col(0) = Vector3d(0, 1, 0);
  axes.col(1) = Vector3d(-1, 0, 0); /* 1 1 0 without its part along the first */
  axes.col(2) = Vector3d(0, 0, 1);
  check(turn_of_body("", R"(xyaxes="0 2 0 -1 1 0")"), Quaterniond(axes));
}

TEST_CASE("mjcf: bodies, frames and replicas stand in one another")
{
  const Scene scene =
      mjcf(in_world(R"(<body pos="1 0 0" euler="0 0 90"><body pos="2 0 0"><geom name="deep" size="1"/></body></body>
    <frame pos="0 0 5"><geom name="framed" pos="1 0 0" size="1"/></frame>
    <replicate count="11" offset="0 1 0"><body name="b" pos="3 0 0"><geom name="g" size="1"/></body></replicate>)"));
  const auto at = [&](const std::string &name) { return vector_of_point(body_named(scene, name).position); };
  CHECK((at("deep") - Vector3d(1, 2, 0)).norm() < 1e-9);
  CHECK((at("framed") - Vector3d(1, 0, 5)).norm() < 1e-9);
  CHECK((at("g00") - Vector3d(3, 0, 0)).norm() < 1e-9);
  CHECK((at("g10") - Vector3d(3, 10, 0)).norm() < 1e-9);
  CHECK(scene.bodies.size() == 13);
}

TEST_CASE("mjcf: classes within classes, by element, by body and by default")
{
  const Scene scene = mjcf(R"(<default><geom size="0.1" mass="1"/>
    <default class="outer"><geom mass="2"/><default class="inner"><geom size="0.3"/></default></default></default>)" +
                           in_world(R"(<body name="a"><freejoint/><geom/></body>
    <body name="b" childclass="outer"><freejoint/><geom/></body>
    <body name="c" childclass="outer"><freejoint/><geom class="inner"/></body>
    <body name="d" childclass="inner"><freejoint/><geom class="main" mass="9"/></body>)"));
  const std::map<std::string, std::pair<float, float>> expected{
      {"a", {0.1f, 1}}, {"b", {0.1f, 2}}, {"c", {0.3f, 2}}, {"d", {0.1f, 9}}};
  for (const auto &[name, size_and_mass] : expected) {
    const Body &body = body_named(scene, name);
    CAPTURE(name);
    CHECK(scene.shapes[body.shape].size[0] == size_and_mass.first);
    CHECK(body.mass == size_and_mass.second);
  }
}

TEST_CASE("mjcf: inertial counts instead of geoms, or not, as the compiler says")
{
  const std::string body = in_world(floating(R"(<inertial pos="0 0 1" mass="3" fullinertia="1 2 2.5 0.1 0.2 0.3"/>
                                             <geom size="0.1" mass="5"/>)"));
  const Body given = mjcf(body).bodies.at(0);
  CHECK(given.mass == 3.0f);
  Matrix3d tensor;
  tensor << 1, 0.1, 0.2, 0.1, 2, 0.3, 0.2, 0.3, 2.5;
  CHECK((tensor_of(given) - tensor).norm() < 1e-6);
  CHECK(given.position[2] == 1);
  CHECK(mjcf(R"(<compiler inertiafromgeom="true"/>)" + body).bodies.at(0).mass == 5.0f);
}

TEST_CASE("mjcf: a body without joints is part of the body that it is in")
{
  const Scene scene =
      mjcf(in_world(floating(R"(<geom size="0.1" mass="1"/><body pos="0 0 1"><geom size="0.1" mass="3"/></body>)")));
  REQUIRE(scene.bodies.size() == 1);
  CHECK(scene.bodies[0].mass == 4.0f);
  CHECK(scene.bodies[0].position[2] == Approx(0.75));
  CHECK(scene.bodies[0].inertia[2] == Approx(4 * 0.4 * 0.01));
  CHECK(tensor_of(scene.bodies[0])(0, 0) == Approx(4 * 0.4 * 0.01 + 0.75 * 0.75 + 3 * 0.25 * 0.25));
}

/* Two of the geoms of a body that floats, or of the world, collide as MuJoCo's rule says. */
TEST_CASE("mjcf: filters of geoms are MuJoCo's rule of contype and conaffinity, for random sets")
{
  Random random(3);
  for (int round = 0; round < 40; ++round) {
    std::vector<std::array<uint32_t, 2>> bits;
    std::string bodies;
    for (int k = 0; k < 6; ++k) {
      bits.push_back({uint32_t(random.uniform(0, 7.99)), uint32_t(random.uniform(0, 7.99))});
      bodies += fmt::format(R"(<body name="b{}"><freejoint/><geom size="1" contype="{}" conaffinity="{}"/></body>)", k,
                            bits[size_t(k)][0], bits[size_t(k)][1]);
    }
    const Scene scene = mjcf(in_world(bodies) + R"(<contact><exclude body1="b1" body2="b4"/></contact>)");
    for (size_t i = 0; i < 6; ++i)
      for (size_t k = 0; k < 6; ++k) {
        if (i == k) continue;

        const bool expected = ((bits[i][0] & bits[k][1]) != 0 || (bits[k][0] & bits[i][1]) != 0) &&
                              std::min(i, k) * 10 + std::max(i, k) != 14;
        const Body &a = scene.bodies[i], &b = scene.bodies[k];
        CAPTURE(round, i, k);
        CHECK(((a.filter_group & b.filter_mask) != 0 && (b.filter_group & a.filter_mask) != 0) == expected);
      }
  }
}

TEST_CASE(
    "mjcf: friction is that of the larger geom, without friction that of the other, and springs of contacts return")
{
  const Scene scene = mjcf(in_world(R"(<geom name="floor" type="plane" size="1 1 1" friction="0.8"/>)") +
                           in_world(floating(R"(<geom size="1" condim="1"/>)")) +
                           in_world(floating(R"(<geom size="1" condim="6" friction="0.5 0.02 0.01"/>)")) +
                           in_world(floating(R"(<geom size="1" solref="-1000 0"/>)")) +
                           in_world(floating(R"(<geom size="1" solref="0.02 0.5"/>)")));
  const auto material = [&](size_t body) { return scene.materials.at(scene.bodies.at(body).material); };
  CHECK(material(0).static_friction == 0.8f);
  CHECK(material(0).friction_combine == Combine::maximum);
  CHECK(material(0).restitution == 0.0f);
  CHECK(material(1).static_friction == 0.0f);
  CHECK(material(2).spinning_friction == 0.02f);
  CHECK(material(2).rolling_friction == 0.01f);
  CHECK(material(3).restitution == 1.0f);
  CHECK(material(4).restitution == Approx(std::exp(-std::numbers::pi * 0.5 / std::sqrt(0.75))).epsilon(1e-6));
}

TEST_CASE("mjcf: a plane is solid below its Z axis")
{
  const Scene scene = mjcf(in_world(R"(<geom type="plane" size="1 1 1" pos="0 0 2" zaxis="1 0 0"/>)"));
  const Body &plane = scene.bodies.at(0);
  CHECK(plane.type == BodyType::fixed);
  CHECK(only_shape(scene).type == ShapeType::half_space);
  CHECK((turn_of(plane.orientation) * Vector3d::UnitY() - Vector3d::UnitX()).norm() < 1e-6);
}

TEST_CASE("mjcf: gravity is that of the option, and none if a flag says so")
{
  const std::string body = in_world(floating(R"(<geom size="1"/>)"));
  CHECK(mjcf(body).gravity == Vec3{0, 0, -9.81f});
  CHECK(mjcf(R"(<option gravity="0 -1.62 0"/>)" + body).gravity == Vec3{0, -1.62f, 0});
  CHECK(mjcf(R"(<option><flag gravity="disable"/></option>)" + body).gravity == Vec3{0, 0, 0});
  CHECK(mjcf(in_world(R"(<body gravcomp="1"><freejoint/><geom size="1"/></body>)")).bodies.at(0).gravity_factor ==
        0.0f);
}

TEST_CASE("mjcf: what a scene does not have is listed by name, with its line and its count")
{
  const Scene scene = mjcf("\n" +
                           in_world(floating(R"(<geom size="1" rgba="1 0 0 1"/><site/><site/>)") +
                                    R"(<geom type="hfield" hfield="hills"/>)") +
                           R"(<tendon><spatial/></tendon><sensor><gyro/></sensor><keyframe><key/></keyframe>
                              <option timestep="0.01"/><contact><pair/></contact><equality><distance/></equality>
                              <actuator><muscle/><motor tendon="t"/></actuator><size/>)");
  for (const char *note :
       {"<site> of <body> is not held (2 times, the first in line 2)", "rgba of <geom> is not held (line 2)",
        "a geom of type hfield is left out", "<spatial> of <tendon>", "<gyro> of <sensor>", "<key> of <keyframe>",
        "timestep of <option>", "<pair> of <contact>", "<distance> of <equality>", "<muscle> of <actuator> is not held",
        "<motor> of <actuator> that drives no joint is not held", "<size> of <mujoco>"}) {
    CAPTURE(note);
    CHECK(has_note(scene, note));
  }
}
