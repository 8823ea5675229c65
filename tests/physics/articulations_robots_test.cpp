/* Robots and ragdolls in reduced coordinates: each joint of a link is a coordinate of a tree. Closed forms, and files
 * of others where they are present (tests/shared_data.h). */
#include <tandem/articulations.h>

#include "host/io/mjcf/scene.h"
#include "host/io/urdf/scene.h"
#include "tests/catch.h"
#include "tests/parity/parity.h"
#include "tests/physics/joints.h"
#include "tests/shared_data.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Scene mjcf_tree(const std::string &inside)
{
  return parse_scene_mjcf("<mujoco>" + inside + "</mujoco>", "tree.xml", OutsideFiles::refused, Coordinates::reduced);
}

Eigen::Quaterniond turn_by(const Vector &axis, double angle)
{
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

std::vector<std::string> trees_of_others()
{
  std::vector<std::string> paths;
  for (const char *name : {"car", "humanoid", "slider_crank"})
    paths.push_back((shared_data("mjcf") / (std::string(name) + ".xml")).string());
  for (const char *name : {"cartpole", "humanoid", "pantilt", "prismatic", "r2d2"})
    paths.push_back((shared_data("urdf") / (std::string(name) + ".urdf")).string());
  return paths;
}

/* A rod of 1 m that hangs from a cone-twist joint whose axis is along it, under a pull to the side. */
Scene leaning_rod(const JointAxis &twist, float cone)
{
  Scene scene = empty_scene({30, -10, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.5f, 0.1f), {0, -0.5, 0}).mass = 2;
  Joint &joint = connect(scene, JointType::cone_twist, no_body, 0, Vector::Zero(), Vector::UnitY());
  joint.rotations[0] = twist;
  joint.rotations[1] = {.upper = cone};
  make_articulations(scene, "test");
  return scene;
}

double lean_of(World &world)
{
  const Vector along = eigen_of(world.bodies()[0].orientation) * Vector::UnitY();
  return std::atan2(std::hypot(along.x(), along.z()), along.y());
}

/* By how much the worst joint is beyond its limits, rad. */
double beyond_limits(World &world)
{
  double most = 0;
  for (uint32_t k = 0; k < world.scene().joints.size(); ++k) {
    const Joint &joint = world.scene().joints[k];
    const JointId id = world.id_of_joint(k);
    const JointReading reading = world.read_joints({&id, 1})[0];
    for (size_t axis = 0; axis < (joint.type == JointType::cone_twist ? 2u : 1u); ++axis)
      most = std::max({most, reading.rotations[axis] - double(joint.rotations[axis].upper),
                       double(joint.rotations[axis].lower) - reading.rotations[axis]});
  }
  return most;
}

} // namespace

TEST_CASE("the cone of a ball in a tree stops what leans, and its twist has limits and motors", "[articulations]")
{
  World leaning(leaning_rod({}, 0.5f));
  run(leaning, 600);
  CHECK(std::abs(lean_of(leaning) - 0.5) < 0.005);
  CHECK(open_joints(leaning).max_distance < 1e-6);
  World turning(leaning_rod({.target_velocity = 2, .motor = true, .max_force = 50}, 0.1f));
  run(turning, 60);
  const Vector spin = vector_of(turning.bodies()[0].angular_velocity),
               axis = eigen_of(turning.bodies()[0].orientation) * Vector::UnitY();
  CHECK(std::abs(std::abs(spin.dot(axis)) - 2) < 0.02);
}

TEST_CASE("a ball of a tree gets and loses its limits while the world runs", "[articulations]")
{
  Scene scene = leaning_rod({}, 0.5f);
  scene.joints[0].rotations[1] = {};
  World world(scene);
  run(world, 30);
  CHECK(lean_of(world) > 0.6);
  const JointId joint = world.id_of_joint(0);
  const JointAxisChange limited{4, {.upper = 0.3f}}, free{4, {}};
  world.set_joint_axes({&joint, 1}, {&limited, 1});
  run(world, 600);
  CHECK(std::abs(lean_of(world) - 0.3) < 0.005);
  world.set_joint_axes({&joint, 1}, {&free, 1});
  double farthest = 0;
  for (int step = 0; step < 120; ++step) {
    world.step();
    farthest = std::max(farthest, lean_of(world));
  }
  CHECK(farthest > 1);
}

TEST_CASE("ragdolls in reduced coordinates fall with closed joints and the same bits in lanes", "[articulations]")
{
  const Scene scene = load_scene("ragdolls:n=4,height=2", OutsideFiles::refused, Coordinates::reduced);
  CHECK(scene.articulations.size() == 4);
  CHECK(scene.notes.empty());
  World world(scene, {}, {"serial", {}}), lanes(scene, {}, {"tbb:threads=2,lanes=8", {}});
  double open = 0;
  for (int step = 0; step < 300; ++step) {
    world.step();
    lanes.step();
    REQUIRE(world.state_hash() == lanes.state_hash());
    open = std::max(open, open_joints(world).max_distance);
  }
  CHECK(open < 2e-6);
}

/* How far the worst limit of a person gives way depends on how the person lies, so several falls are asked. */
TEST_CASE("ragdolls in reduced coordinates lie within their limits", "[articulations]")
{
  std::vector<double> beyond;
  for (const char *height : {"1.4", "1.6", "1.8", "2", "2.2", "2.4", "2.6"}) {
    World world(load_scene("ragdolls:n=4,height=" + std::string(height), OutsideFiles::refused, Coordinates::reduced));
    run(world, 300);
    beyond.push_back(beyond_limits(world));
  }
  std::sort(beyond.begin(), beyond.end());
  CHECK(beyond[beyond.size() / 2] < 0.015);
  CHECK(beyond.back() < 0.03);
}

/* Work memory is compared, too. Of nine trees eight share instructions, and in most passes some of them push. */
TEST_CASE("trees in lanes keep what each of them is alone, while rows of some push and those of others do not",
          "[articulations]")
{
  Random random(3);
  Scene scene = empty_scene();
  for (uint32_t tree = 0; tree < 9; ++tree)
    for (uint32_t k = 0; k < 2; ++k) {
      add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.1f), {0.5 + k, 0, 3.0 * tree}).mass = 1;
      Joint &joint = connect(scene,
                             k == 0     ? JointType::hinge
                             : tree % 2 ? JointType::slider
                                        : JointType::hinge,
                             k == 0 ? no_body : 2 * tree, 2 * tree + k, {double(k), 0, 3.0 * tree}, Vector::UnitZ());
      JointAxis &axis = (joint.type == JointType::slider ? joint.directions : joint.rotations)[0];
      axis.lower = float(-random.uniform(0, 1));
      axis.upper = 1;
      if (tree % 3 == 0) axis.friction = float(random.uniform(0, 3));
    }
  make_articulations(scene, "test");
  parity::require_parity(scene, {"serial", "tbb:threads=1,lanes=8", "tbb:threads=2,lanes=16"}, 40);
}

TEST_CASE("materials of a robot that roll do so in maximal coordinates alone, and loops of a robot are noted",
          "[articulations]")
{
  const Scene scene = mjcf_tree(R"(<worldbody><body name="a"><freejoint/><geom size="0.1" condim="6"/>
      <body name="b" pos="0.5 0 0"><joint/><geom size="0.1"/></body></body></worldbody>
      <equality><connect body1="a" body2="b" anchor="0.2 0 0"/></equality>)");
  for (const Material &material : scene.materials) CHECK(material.rolling_friction + material.spinning_friction == 0);
  std::string notes;
  for (const std::string &note : scene.notes) notes += note + "\n";
  CHECK(notes.find("rolling and spinning friction are of maximal coordinates alone") != std::string::npos);
  CHECK(notes.find("closes a loop") != std::string::npos);
  World world(scene);
  run(world, 10);
  CHECK(world.quarantined().empty());
}

TEST_CASE("three hinges of one link turn one after the other in reduced coordinates, whatever their axes",
          "[articulations]")
{
  const Scene scene = mjcf_tree(R"(<compiler angle="radian"/><option gravity="0 0 0"/><worldbody><body>
      <joint axis="1 0 0" stiffness="20" damping="5" springref="0.9"/>
      <joint axis="0 2 1" stiffness="20" damping="5" springref="-1.2"/>
      <joint axis="0 0 1" stiffness="20" damping="5" springref="0.7"/>
      <geom type="box" size="0.3 0.2 0.1" mass="2"/></body></worldbody>)");
  REQUIRE(scene.articulations.size() == 1);
  CHECK(scene.articulations[0].joints.size() == 3);
  CHECK(scene.bodies.size() == 3);
  float mass = 0;
  for (const Body &body : scene.bodies) mass += body.mass;
  CHECK(std::abs(mass - 2) < 1e-6f);
  World world(scene);
  run(world, 600);
  const Eigen::Quaterniond expected = turn_by({1, 0, 0}, 0.9) * turn_by({0, 2, 1}, -1.2) * turn_by({0, 0, 1}, 0.7),
                           from = eigen_of(scene.bodies[0].orientation), to = eigen_of(world.bodies()[0].orientation);
  CHECK((to * from.conjugate()).angularDistance(expected) < 1e-4);
}

TEST_CASE("a link of two hinges and its parent pass through each other", "[articulations]")
{
  const Scene scene = mjcf_tree(R"(<option gravity="0 0 0"/><worldbody><body><freejoint/>
      <geom type="box" size="0.3 0.2 0.1"/><body><joint axis="1 0 0"/><joint axis="0 1 0"/>
      <geom type="box" size="0.3 0.2 0.1"/></body></body></worldbody>)");
  World world(scene);
  run(world, 60);
  for (const BodyState &state : world.bodies()) CHECK(vector_of(state.angular_velocity).norm() < 1e-5);
}

TEST_CASE("a pendulum of MJCF with an armature swings as slowly as the sum of both inertias says", "[articulations]")
{
  const Scene scene = mjcf_tree(R"(<option gravity="0 0 -10"/><worldbody><body pos="0 0 3">
      <joint axis="0 1 0" armature="0.8"/><geom type="sphere" size="0.1" pos="0.1 0 -1" mass="2"/></body>
      </worldbody>)");
  const double arm = std::hypot(0.1, 1.0), inertia = 2 * arm * arm + 0.4 * 2 * 0.01 + 0.8, start = std::atan2(0.1, 1.0);
  const double period = 2 * pi * std::sqrt(inertia / (2 * 10 * arm)) * lengthening_of_period(start);
  World world(scene);
  ZeroCrossings crossings;
  for (int step = 1; step <= 600; ++step) {
    world.step();
    crossings.note(step / 60.0, -world.precise_bodies()[0].position[0]);
  }
  CHECK(std::abs(crossings.interval(0, 3) - period) < 0.002 * period);
}

TEST_CASE("robots of others in reduced coordinates keep their bodies, and their joints do not open", "[articulations]")
{
  for (const std::string &path : trees_of_others()) {
    CAPTURE(path);
    const Scene scene = load_scene(path, OutsideFiles::refused, Coordinates::reduced);
    CHECK(!scene.articulations.empty());
    World world(scene);
    double open = 0;
    for (int step = 0; step < 300; ++step) {
      world.step();
      open = std::max(open, open_joints(world).max_distance);
    }
    CHECK(world.quarantined().empty());
    CHECK(open < (path.find("slider_crank") != std::string::npos ? 1e-4 : 2e-6)); /* its loop is a maximal joint */
  }
}

TEST_CASE("robots of others in reduced coordinates have the same bits on one thread and in lanes, and after JSON",
          "[articulations]")
{
  for (const std::string &path : trees_of_others()) {
    CAPTURE(path);
    const Scene scene = load_scene(path, OutsideFiles::refused, Coordinates::reduced);
    const std::string json = to_scene_json(scene);
    const Scene again = parse_scene_json(json, "robot.json");
    CHECK(to_scene_json(again) == json);
    World serial(scene, {}, {"serial", {}}), lanes(again, {}, {"tbb:threads=2,lanes=8", {}});
    for (int step = 0; step < 90; ++step) {
      serial.step();
      lanes.step();
      REQUIRE(serial.state_hash() == lanes.state_hash());
    }
  }
}
