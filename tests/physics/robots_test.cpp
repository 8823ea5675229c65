/* robots_test.cpp - robots of URDF and MJCF move as closed forms and double precision say; those that others wrote
 * load, stand when they are driven, fall when they are not, and have the same bits on every backend and after JSON.
 *
 * The files of others are not part of the source (tests/shared_data.h); without them the tests are skipped. */
#include <filesystem>
#include <fstream>
#include <sstream>

#include <tandem/worlds.h>

#include "host/io/mjcf/scene.h"
#include "host/io/urdf/scene.h"
#include "tests/parity/parity.h"
#include "tests/physics/joints.h"
#include "tests/shared_data.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr double earth_z = 9.81; /* m/s^2, that of robots */

std::vector<std::string> robots_of_others()
{
  std::vector<std::string> paths;
  for (const char *name : {"car", "humanoid", "newton_cradle", "slider_crank"})
    paths.push_back((shared_data("mjcf") / (std::string(name) + ".xml")).string());
  for (const char *name : {"cartpole", "humanoid", "jenga", "pantilt", "prismatic", "r2d2"})
    paths.push_back((shared_data("urdf") / (std::string(name) + ".urdf")).string());
  return paths;
}

const Body &part_of(const Scene &scene, const std::string &name)
{
  for (const Body &body : scene.bodies)
    if (body.name == name) return body;
  FAIL("no body " + name);
  return scene.bodies.front();
}

std::string text_of(const std::string &path)
{
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/* The humanoid, and more elements at the end of its file. */
Scene humanoid_with(const std::string &more)
{
  const std::string path = (shared_data("mjcf") / "humanoid.xml").string();
  std::string text = text_of(path);
  text.insert(text.rfind("</mujoco>"), more);
  return parse_scene_mjcf(text, path);
}

/* A drive for each joint that has a motor, towards the angles at which the humanoid stands. */
std::string drives_of_humanoid()
{
  std::string drives = "<actuator>";
  for (const char *joint : {"abdomen_z", "abdomen_y", "abdomen_x", "shoulder1_right", "shoulder2_right", "elbow_right",
                            "shoulder1_left", "shoulder2_left", "elbow_left"})
    drives += std::string("<position joint=\"") + joint + "\" kp=\"1000\" kv=\"50\"/>";
  for (const char *side : {"right", "left"})
    for (const char *joint : {"hip_x_", "hip_z_", "hip_y_", "knee_", "ankle_y_", "ankle_x_"})
      drives += std::string("<position joint=\"") + joint + side + "\" kp=\"1000\" kv=\"50\"/>";
  return drives + "</actuator>";
}

/* The height of the head, which is a ball of the torso's compound, 0.19 m above the torso's frame. */
double height_of_head(const Scene &scene, World &world)
{
  for (size_t k = 0; k < scene.bodies.size(); ++k) {
    const Body &torso = scene.bodies[k];
    if (torso.name != "torso") continue;
    const BodyState state = world.bodies()[k];
    const Vector head =
        axes_of(torso.orientation).transpose() * (Vector(0, 0, 1.282 + 0.19) - vector_of(torso.position));
    return (vector_of(state.position) + axes_of(state.orientation) * head).z();
  }
  FAIL("no torso");
  return 0;
}

/* Runge-Kutta, from rest: the angle from the vertical of a pendulum whose small swings have this rate, rad/s. */
double angle_after(double start, double rate, double seconds)
{
  const auto change = [&](const Eigen::Vector2d &x) { return Eigen::Vector2d(x[1], -rate * rate * std::sin(x[0])); };
  const int steps = int(std::ceil(2000 * seconds));
  const double h = seconds / steps;
  Eigen::Vector2d x(start, 0);
  for (int k = 0; k < steps; ++k) {
    const Eigen::Vector2d a = change(x), b = change(x + 0.5 * h * a), c = change(x + 0.5 * h * b),
                          d = change(x + h * c);
    x += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return x[0];
}

} // namespace

/* A motor whose joint has no damping, which a batch needs to set its force. */
TEST_CASE("an MJCF motor of gear g at a control u turns a free hinge at g u over its moment of inertia", "[physics]")
{
  const Coordinates coordinates = GENERATE(Coordinates::maximal, Coordinates::reduced);
  const Scene scene =
      parse_scene_mjcf(R"(<mujoco><option gravity="0 0 0"/><worldbody><body><joint name="j" axis="0 0 1"/>
      <geom type="box" size="0.1 0.2 0.3" mass="3"/></body></worldbody>
    <actuator><motor joint="j" gear="-4" ctrlrange="-1 1"/></actuator></mujoco>)",
                       "motor.xml", OutsideFiles::refused, coordinates);
  const double inertia = 3 * (0.1 * 0.1 + 0.2 * 0.2) / 3, seconds = 0.5;
  World alone(scene, {}, {"serial", {}});
  Worlds worlds(scene, 2, {}, {"serial", {}});
  worlds.choose_controls(scene.actuators);
  alone.set_controls(std::vector<float>{0.25f});
  worlds.set_controls(std::vector<float>{0.25f, -20});
  for (int step = 0; step < 30; ++step) {
    alone.step();
    worlds.step();
  }
  const auto speed_of = [&](uint32_t world) {
    return worlds.read_joints(std::vector<WorldJoint>{{world, 0}})[0].rotation_speeds[0];
  };
  CHECK(alone.read_joint(alone.id_of_joint(0)).rotation_speeds[0] ==
        Approx(-4 * 0.25 / inertia * seconds).epsilon(1e-4));
  CHECK(speed_of(0) == Approx(-4 * 0.25 / inertia * seconds).epsilon(1e-4));
  CHECK(speed_of(1) == Approx(4 / inertia * seconds).epsilon(1e-4)); /* its control ends at -1 */
  CHECK(worlds.state_hash(0) == alone.state_hash());
}

TEST_CASE("a URDF pendulum of an arm and a welded tip swings as a rigid body about its hinge", "[physics]")
{
  const Scene scene = parse_scene_urdf(R"(<robot name="pendulum"><link name="world"/><link name="arm"><inertial>
      <origin xyz="0 0 -0.4"/><mass value="2"/><inertia ixx="0.1" iyy="0.12" izz="0.05"/></inertial></link>
    <link name="tip"><inertial><mass value="1"/><inertia ixx="0.02" iyy="0.03" izz="0.02"/></inertial></link>
    <joint name="pivot" type="continuous"><parent link="world"/><child link="arm"/><origin rpy="0 0.9 0"/>
      <axis xyz="0 1 0"/></joint>
    <joint name="weld" type="fixed"><parent link="arm"/><child link="tip"/><origin xyz="0 0 -0.8"/></joint></robot>)",
                                       "pendulum.urdf");
  const double moment = 0.12 + 2 * 0.4 * 0.4 + 0.03 + 0.8 * 0.8, first = 2 * 0.4 + 0.8;
  const double rate = std::sqrt(earth_z * first / moment);
  World world(scene);
  for (int step = 1; step <= 120; ++step) {
    world.step();
    const double angle = angle_after(0.9, rate, step / 60.0), arm = first / 3;
    const Vector expected(-arm * std::sin(angle), 0, -arm * std::cos(angle));
    CAPTURE(step, angle);
    CHECK((vector_of(world.bodies()[0].position) - expected).norm() < 0.015 * arm);
  }
}

/* The integrator damps too, by half a substep of the rate, as it does for springs of other files. */
TEST_CASE("an MJCF slide with stiffness and damping swings about where its spring carries the weight", "[physics]")
{
  const Scene scene =
      parse_scene_mjcf(R"(<mujoco><worldbody><body><joint type="slide" axis="0 0 1" stiffness="200" damping="3"/>
      <geom size="0.1" mass="2"/></body></worldbody></mujoco>)",
                       "spring.xml");
  const double mass = 2, stiffness = 200, sag = mass * earth_z / stiffness, natural = std::sqrt(stiffness / mass);
  const double decay = 3 / (2 * mass) + 0.5 * natural * natural / 240,
               swing = std::sqrt(natural * natural - decay * decay);
  World world(scene);
  for (int step = 1; step <= 120; ++step) {
    world.step();
    const double t = step / 60.0;
    const double expected =
        -sag * (1 - std::exp(-decay * t) * (std::cos(swing * t) + decay / swing * std::sin(swing * t)));
    CAPTURE(t, expected, world.bodies()[0].position[2]);
    CHECK(std::abs(world.bodies()[0].position[2] - expected) < 0.05 * sag);
  }
}

TEST_CASE("an MJCF velocity drive turns as fast as it says, with the force that it has", "[physics]")
{
  const Scene scene = parse_scene_mjcf(R"(<mujoco><option gravity="0 0 0"/><worldbody>
      <body><joint name="j"/><geom type="box" size="1 1 1" mass="6"/></body></worldbody>
    <actuator><velocity joint="j" kv="100" ctrlrange="2 3" forcerange="-4 4"/></actuator></mujoco>)",
                                       "drive.xml");
  World world(scene);
  const double moment = 6 * 4 / 6.0; /* of a cube of 2 m */
  for (int step = 1; step <= 90; ++step) world.step();
  CHECK(world.bodies()[0].angular_velocity[2] == Approx(4 / moment * 1.5).epsilon(0.01)); /* full torque */
  for (int step = 0; step < 120; ++step) world.step();
  CHECK(world.bodies()[0].angular_velocity[2] == Approx(2).epsilon(0.01));
}

TEST_CASE("pairs that MJCF excludes pass through each other, and others do not", "[physics]")
{
  const auto top_after = [](const std::string &contact) {
    const Scene scene = parse_scene_mjcf(R"(<mujoco><worldbody><geom type="plane" size="1 1 1"/>
      <body name="a" pos="0 0 0.5"><freejoint/><geom type="box" size="0.5 0.5 0.5"/></body>
      <body name="b" pos="0 0 1.51"><freejoint/><geom type="box" size="0.5 0.5 0.5"/></body></worldbody>)" +
                                             contact + "</mujoco>",
                                         "boxes.xml");
    World world(scene);
    for (int step = 0; step < 180; ++step) world.step();
    return world.bodies()[2].position[2];
  };
  CHECK(top_after("") == Approx(1.5).margin(0.005));
  CHECK(top_after(R"(<contact><exclude body1="a" body2="b"/></contact>)") == Approx(0.5).margin(0.005));
}

TEST_CASE("robots of others load and keep all their bodies and joints for 300 steps", "[physics]")
{
  for (const std::string &path : robots_of_others()) {
    CAPTURE(path);
    const Scene scene = load_scene(path);
    World world(scene);
    for (int step = 0; step < 300; ++step) world.step();
    CHECK(world.quarantined().empty());
    CHECK(open_joints(world).max_distance < 0.005);
  }
}

/* The URDF file has masses that others computed from the same geometry; its moments are those of boxes. */
TEST_CASE("the humanoid's masses from its MJCF geoms are those of its URDF file, and moments those of capsules",
          "[physics]")
{
  const Scene mjcf = load_scene((shared_data("mjcf") / "humanoid.xml").string()),
              urdf = load_scene((shared_data("urdf") / "humanoid.urdf").string());
  for (const auto &[one, other] :
       {std::pair("torso", "torso"), std::pair("waist_lower", "link1_3"), std::pair("pelvis", "link1_5"),
        std::pair("thigh_right", "link1_9"), std::pair("shin_right", "link1_11"), std::pair("foot_left", "link1_23"),
        std::pair("upper_arm_left", "link1_31"), std::pair("lower_arm_right", "link1_28")}) {
    CAPTURE(one, other);
    CHECK(part_of(mjcf, one).mass == Approx(part_of(urdf, other).mass).epsilon(2e-5));
  }
  const double r = 0.09, length = 0.14, cylinder = 1000 * pi * r * r * length, ball = 4000 * pi / 3 * r * r * r;
  const double along = cylinder * r * r / 2 + ball * 0.4 * r * r;
  const double across =
      cylinder * (3 * r * r + length * length) / 12 + ball * (0.4 * r * r + length * length / 4 + 0.375 * r * length);
  Vec3 moments = part_of(mjcf, "pelvis").inertia;
  std::sort(moments.begin(), moments.end());
  CHECK(moments[0] == Approx(along).epsilon(1e-5));
  CHECK(moments[1] == Approx(across).epsilon(1e-5));
  CHECK(moments[2] == Approx(across).epsilon(1e-5));
}

TEST_CASE("the humanoid falls when nothing drives it, and stands when drives hold its angles", "[physics]")
{
  const Scene limp = humanoid_with(""), driven = humanoid_with(drives_of_humanoid());
  World falling(limp), standing(driven);
  for (int step = 0; step < 300; ++step) {
    standing.step();
    CHECK(height_of_head(driven, standing) > 1.4);
  }
  for (int step = 0; step < 300; ++step) falling.step();
  CHECK(height_of_head(limp, falling) < 0.3);
}

TEST_CASE("robots of others are written as JSON and read again without loss, and move the same")
{
  for (const std::string &path : robots_of_others()) {
    CAPTURE(path);
    const Scene scene = load_scene(path);
    const std::string json = to_scene_json(scene);
    const Scene again = parse_scene_json(json, "robot.json");
    CHECK(to_scene_json(again) == json);
    World first(scene), second(again);
    for (int step = 0; step < 60; ++step) {
      first.step();
      second.step();
    }
    CHECK(first.state_hash() == second.state_hash());
  }
}

TEST_CASE("robots of others have the same bits on one thread and on several with lanes")
{
  for (const std::string &path : robots_of_others())
    parity::require_parity(path, {"serial", "tbb:threads=2,lanes=8", "tbb:threads=3,lanes=4"}, 90);
}

/* One build of all features serves them all. */
TEST_CASE("parity on OpenCL: robots of others")
{
  const std::vector<std::string> paths = robots_of_others();
  parity::require_pocl();
  Settings settings;
  settings.specialise = false;
  for (const std::string &path : paths) parity::require_parity(path, {"serial", "cl:pocl"}, 40, settings);
}
