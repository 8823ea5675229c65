/* joints_test.cpp - joints of glTF files: which joint a list of limits becomes, where its frames stand, what its drives
 * move, and one line for every mistake in them. */
#include "tests/catch.h"
#include "tests/host/io/gltf/gltf_text.h"

using namespace tandem;
using namespace tandem::gltf_text;
using Catch::Matchers::ContainsSubstring;

namespace {

using Vector3 = Eigen::Vector3d;
using Turn = Eigen::Quaterniond;

/* A node with a joint, called Hinge, in the world; one called Pin, to which it is joined, on a body called Cup. */
struct Jointed {
  std::string limits = "", drives = "";
  std::string hinge = "", pin = "", cup = ""; /* members of the nodes */
  std::string motion = R"("mass":2)", joint = R"("connectedNode":1,"joint":0)";
  std::string more_nodes = "";

  Parts parts() const
  {
    return {.nodes = R"({"name":"Hinge",)" + hinge + R"("extensions":{"KHR_physics_rigid_bodies":{"joint":{)" + joint +
                     R"(}}}},{)" + pin + R"("name":"Pin"},{)" + cup +
                     R"("name":"Cup","children":[1],"extensions":{"KHR_physics_rigid_bodies":{"motion":{)" + motion +
                     R"(},"collider":{"geometry":{"shape":0}}}}})" + more_nodes,
            .document = R"("physicsJoints":[{"limits":[)" + limits + R"(],"drives":[)" + drives + "]}]"};
  }
  Scene scene() const { return loaded(parts()); }
  std::string complaint() const { return gltf_text::complaint(parts()); }
};

std::string limit(const std::string &kind, const std::string &axes, const std::string &more)
{
  return R"({")" + kind + R"(Axes":[)" + axes + "]," + more + "}";
}

const std::string at_zero = R"("min":0,"max":0)", ball = limit("linear", "0,1,2", at_zero);

std::string held(const std::string &directions, const std::string &rotations)
{
  std::string limits;
  if (!directions.empty()) limits = limit("linear", directions, at_zero);
  if (!rotations.empty()) limits += (limits.empty() ? "" : ",") + limit("angular", rotations, at_zero);
  return limits;
}

Joint only_joint(const Scene &scene)
{
  REQUIRE(scene.joints.size() == 1);
  return scene.joints[0];
}

Turn turn_of(const Quat &q) { return Turn(q[3], q[0], q[1], q[2]).normalized(); }
Vector3 vector_of_point(const Point &p) { return {p[0], p[1], p[2]}; }

/* A frame of a joint in the world. */
struct JointFrame {
  Vector3 at;
  Turn axes;
};
JointFrame frame_in_world(const Scene &scene, uint32_t body, const Point &position, const Quat &orientation)
{
  if (body == no_body) return {vector_of_point(position), turn_of(orientation)};
  const Turn turn = turn_of(scene.bodies[body].orientation);
  return {vector_of_point(scene.bodies[body].position) + turn * vector_of_point(position), turn * turn_of(orientation)};
}
JointFrame frame_a(const Scene &scene, const Joint &j)
{
  return frame_in_world(scene, j.body_a, j.position_a, j.orientation_a);
}
JointFrame frame_b(const Scene &scene, const Joint &j)
{
  return frame_in_world(scene, j.body_b, j.position_b, j.orientation_b);
}

const std::string drive_x = R"({"type":"linear","axis":0,"mode":"force","stiffness":3,"damping":5,)"
                            R"("positionTarget":0.5,"velocityTarget":0.25,"maxForce":7})";

} // namespace

TEST_CASE("glTF joints: what limits hold decides the type, and its axis is along x")
{
  struct Case {
    const char *directions, *rotations;
    JointType type;
    int axis; /* of the nodes that is the joint's x; -1: any */
  };
  const Case cases[] = {{"0,1,2", "0,1,2", JointType::fixed, -1},  {"0,1,2", "", JointType::ball, -1},
                        {"0,1,2", "1,2", JointType::hinge, 0},     {"0,1,2", "0,2", JointType::hinge, 1},
                        {"2,0,1", "1,0", JointType::hinge, 2},     {"1,2", "0,1,2", JointType::slider, 0},
                        {"0,2", "0,1,2", JointType::slider, 1},    {"0,1", "0,1,2", JointType::slider, 2},
                        {"0,2", "0,2", JointType::cylindrical, 1}, {"2", "0,1", JointType::plane, 2},
                        {"", "1,2", JointType::parallel, 0},       {"0,1", "1,2", JointType::six_dof, 0},
                        {"0", "0,1,2", JointType::six_dof, -1},    {"", "", JointType::six_dof, -1}};
  for (const Case &given : cases) {
    CAPTURE(given.directions, given.rotations);
    const Scene scene = Jointed{.limits = held(given.directions, given.rotations)}.scene();
    const Joint joint = only_joint(scene);
    CHECK(joint.type == given.type);
    CHECK(joint.name == "Hinge");
    CHECK_FALSE(joint.collide);
    CHECK((joint.body_a == no_body && joint.body_b == 0));
    for (const JointFrame &frame : {frame_a(scene, joint), frame_b(scene, joint)})
      if (given.axis >= 0) CHECK((frame.axes * Vector3::UnitX() - Vector3::Unit(given.axis)).norm() < 1e-6);
    for (size_t k = 0; k < 3; ++k) CHECK((joint.directions[k] == JointAxis{} && joint.rotations[k] == JointAxis{}));
  }
}

TEST_CASE("glTF joints: a six_dof joint holds what no other type does")
{
  const Joint sliding = only_joint(Jointed{.limits = held("0,1", "1,2")}.scene());
  CHECK(sliding.held_directions == Axes{true, true, false});
  CHECK(sliding.held_rotations == Axes{false, true, true});
  const Joint flat = only_joint(Jointed{.limits = held("1", "0,1,2")}.scene());
  CHECK(flat.held_directions == Axes{false, true, false});
  CHECK(flat.held_rotations == Axes{true, true, true});
  /* x cannot be held without y and z, so one rotation alone is a twist of 0 */
  const Scene scene = Jointed{.limits = held("0,1,2", "2")}.scene();
  const Joint twist = only_joint(scene);
  CHECK(twist.type == JointType::ball);
  CHECK((twist.rotations[0].lower == 0 && twist.rotations[0].upper == 0));
  CHECK((frame_a(scene, twist).axes * Vector3::UnitX() - Vector3::UnitZ()).norm() < 1e-6);
  /* limits on one axis each add up */
  const std::string each = ball + "," + limit("angular", "0", at_zero) + "," + limit("angular", "2", at_zero);
  CHECK(only_joint(Jointed{.limits = each}.scene()).type == JointType::hinge);
}

TEST_CASE("glTF joints: ranges become limits of the axis, soft ones with their spring")
{
  const std::string range = R"("min":-0.5,"max":0.25,"stiffness":40,"damping":3)";
  const Joint hinge = only_joint(Jointed{.limits = held("0,1,2", "0,2") + "," + limit("angular", "1", range)}.scene());
  CHECK(hinge.type == JointType::hinge);
  CHECK((hinge.rotations[0].lower == -0.5f && hinge.rotations[0].upper == 0.25f));
  CHECK((hinge.rotations[0].limit_stiffness == 40 && hinge.rotations[0].limit_damping == 3));
  const Joint slider = only_joint(Jointed{.limits = held("0,1", "0,1,2") + "," + limit("linear", "2", range)}.scene());
  CHECK(slider.type == JointType::slider);
  CHECK((slider.directions[0].lower == -0.5f && slider.directions[0].upper == 0.25f));
  const Joint loose = only_joint(Jointed{.limits = limit("linear", "1", R"("min":-1)")}.scene());
  CHECK(loose.type == JointType::six_dof);
  CHECK((loose.directions[1].lower == -1 && loose.directions[1].upper == JointAxis::unlimited));
  /* without stiffness a limit is hard, and has nothing to damp */
  const Joint hard = only_joint(Jointed{.limits = limit("linear", "1", R"("max":1,"damping":3)")}.scene());
  CHECK((hard.directions[1].limit_stiffness == 0 && hard.directions[1].limit_damping == 0));
}

TEST_CASE("glTF joints: a limit on one side of an angle reaches to half a turn on the other")
{
  const Joint joint = only_joint(Jointed{.limits = ball + "," + limit("angular", "1", R"("max":1)")}.scene());
  CHECK(joint.rotations[0].lower == Approx(-std::acos(-1.0)));
  CHECK(joint.rotations[0].upper == 1);
  const Joint free = only_joint(Jointed{.limits = ball + "," + limit("angular", "1", R"("min":-4,"max":4)")}.scene());
  CHECK(free.rotations[0] == JointAxis{});
}

TEST_CASE("glTF joints: limits of several axes are a distance and a cone")
{
  const Joint rope = only_joint(Jointed{.limits = limit("linear", "0,1,2", R"("min":-1,"max":2)")}.scene());
  CHECK(rope.type == JointType::distance);
  CHECK((rope.directions[0].lower == -JointAxis::unlimited && rope.directions[0].upper == 2));
  const Joint rod = only_joint(Jointed{.limits = limit("linear", "2,1,0", R"("min":2,"max":2)")}.scene());
  CHECK((rod.directions[0].lower == 2 && rod.directions[0].upper == 2));
  const Scene scene = Jointed{.limits = ball + "," + limit("angular", "2,0", R"("max":0.75)") + "," +
                                        limit("angular", "1", R"("min":-0.1,"max":0.2)")}
                          .scene();
  const Joint cone = only_joint(scene);
  CHECK(cone.type == JointType::cone_twist);
  CHECK((frame_b(scene, cone).axes * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-6);
  CHECK((cone.rotations[1].upper == 0.75f && cone.rotations[0].lower == -0.1f && cone.rotations[0].upper == 0.2f));
  /* a soft point is a spring along each axis, a soft weld about each, too */
  const std::string soft = R"("min":0,"max":0,"stiffness":9)";
  const Joint weld = only_joint(Jointed{.limits = limit("angular", "0,1,2", soft)}.scene());
  for (const JointAxis &axis : weld.rotations) CHECK((axis.lower == 0 && axis.upper == 0 && axis.limit_stiffness == 9));
  const Joint point = only_joint(Jointed{.limits = limit("linear", "0,1,2", soft)}.scene());
  for (const JointAxis &axis : point.directions)
    CHECK((axis.lower == 0 && axis.upper == 0 && axis.limit_stiffness == 9));
}

TEST_CASE("glTF joints: what one joint cannot limit goes to further ones of the same bodies")
{
  const Scene scene =
      Jointed{.limits = ball + "," + limit("angular", "0", R"("min":-1,"max":1)") + "," +
                        limit("angular", "2", R"("min":-2,"max":0.5)") + "," + limit("linear", "0,1,2", R"("max":3)"),
              .hinge = R"("rotation":[0,0.6,0,0.8],)"}
          .scene();
  REQUIRE(scene.joints.size() == 2); /* the distance is 0, which is within 3 */
  const Joint &first = scene.joints[0], &second = scene.joints[1];
  CHECK((first.type == JointType::ball && first.rotations[0].upper == 1));
  CHECK((second.type == JointType::six_dof && second.held_directions == Axes{} && second.held_rotations == Axes{}));
  CHECK((second.rotations[0].lower == -2 && second.rotations[0].upper == 0.5f));
  CHECK((second.body_a == first.body_a && second.body_b == first.body_b));
  const Turn node(0.8, 0, 0.6, 0);
  CHECK((frame_a(scene, second).axes * Vector3::UnitX() - node * Vector3::UnitZ()).norm() < 1e-6);
  CHECK((frame_b(scene, second).axes * Vector3::UnitX() - Vector3::UnitZ()).norm() < 1e-6);
}

TEST_CASE("glTF joints: a direction held elsewhere than at 0 moves the frame of the joint's node")
{
  const std::string away = limit("linear", "1", R"("min":2,"max":2)") + "," + held("0,2", "0,1,2");
  const Scene scene = Jointed{.limits = away, .hinge = R"("rotation":[0,0,0.6,0.8],"translation":[1,0,0],)"}.scene();
  const Joint joint = only_joint(scene);
  CHECK(joint.type == JointType::fixed);
  CHECK((frame_a(scene, joint).at - (Vector3(1, 0, 0) + Turn(0.8, 0, 0, 0.6) * Vector3(0, 2, 0))).norm() < 1e-6);
}

TEST_CASE("glTF joints: frames stand at their nodes, whatever the axes and the centre of the body")
{
  const std::string motion = R"("mass":2,"centerOfMass":[0.1,0.2,-0.3],"inertiaDiagonal":[1,2,2.5],)"
                             R"("inertiaOrientation":[0.6,0,0,0.8])";
  const Jointed given{.limits = ball,
                      .hinge = R"("rotation":[0,0.28,0,0.96],"translation":[1,2,3],)",
                      .pin = R"("rotation":[0,0,0.6,0.8],"translation":[0,1,0.5],)",
                      .cup = R"("rotation":[0.6,0,0,0.8],"translation":[-1,0,1],"scale":[2,2,2],)",
                      .motion = motion};
  const Scene scene = given.scene();
  const Joint joint = only_joint(scene);
  const JointFrame a = frame_a(scene, joint), b = frame_b(scene, joint);
  CHECK((a.at - Vector3(1, 2, 3)).norm() < 1e-6);
  CHECK(a.axes.angularDistance(Turn(0.96, 0, 0.28, 0)) < 1e-6);
  const Turn cup_turn(0.8, 0.6, 0, 0);
  CHECK((b.at - (Vector3(-1, 0, 1) + cup_turn * Vector3(0, 2, 1))).norm() < 1e-6);
  CHECK(b.axes.angularDistance(cup_turn * Turn(0.8, 0, 0, 0.6)) < 1e-6);
  /* a limit is in metres, and an uneven scale alone turns nothing */
  const Scene uneven = Jointed{.limits = limit("linear", "0", R"("max":1)"),
                               .hinge = R"("rotation":[0,0,0.6,0.8],"scale":[1,5,2],)",
                               .cup = R"("scale":[3,1,1],)"}
                           .scene();
  CHECK(only_joint(uneven).directions[0].upper == 1);
  CHECK(frame_a(uneven, only_joint(uneven)).axes.angularDistance(Turn(0.8, 0, 0, 0.6)) < 1e-6);
}

TEST_CASE("glTF joints: the side without a motion is the fixed body at or above its node, or the world")
{
  const std::string above = R"(,{"name":"Post","children":[0],"translation":[0,3,0],"extensions":)"
                            R"({"KHR_physics_rigid_bodies":{"collider":{"geometry":{"shape":1}}}}})";
  const Scene scene = Jointed{.limits = ball, .more_nodes = above}.scene();
  const Joint joint = only_joint(scene);
  REQUIRE(joint.body_a != no_body);
  CHECK(scene.bodies[joint.body_a].name == "Post");
  CHECK(scene.bodies[joint.body_a].type == BodyType::fixed);
  CHECK((frame_a(scene, joint).at - Vector3(0, 3, 0)).norm() < 1e-6);
  const Scene colliding =
      Jointed{.limits = ball, .joint = R"("connectedNode":1,"joint":0,"enableCollision":true)"}.scene();
  CHECK(only_joint(colliding).collide);
}

TEST_CASE("glTF joints: a drive is the spring and the damper of its axis")
{
  const Scene scene = Jointed{.limits = held("1,2", "0,1,2"), .drives = drive_x}.scene();
  const JointAxis axis = only_joint(scene).directions[0];
  CHECK((axis.stiffness == 3 && axis.damping == 5 && axis.max_force == 7));
  CHECK((axis.target_position == 0.5f && axis.target_velocity == 0.25f && !axis.motor));
  /* what is held is not driven, and two drives of one axis add up */
  CHECK(only_joint(Jointed{.limits = held("0,1,2", "1,2"), .drives = drive_x}.scene()).directions[0] == JointAxis{});
  const Scene twice = Jointed{.limits = held("1,2", "0,1,2"), .drives = drive_x + "," + drive_x}.scene();
  REQUIRE(twice.joints.size() == 2);
  CHECK(twice.joints[1].directions[0] == axis);
}

TEST_CASE("glTF joints: a drive by acceleration is scaled by what it moves")
{
  const auto drive = [](const std::string &type, const std::string &axis) {
    return R"({"type":")" + type + R"(","axis":)" + axis +
           R"(,"mode":"acceleration","stiffness":10,"damping":4,"positionTarget":0,"velocityTarget":0})";
  };
  const std::string box = R"("mass":3,"inertiaDiagonal":[0.5,1,1.25],"centerOfMass":[0,0,0])";
  /* along a slider the mass, even where the slider goes past the centre of mass */
  const Jointed slider{.limits = held("0,2", "0,1,2"),
                       .drives = drive("linear", "1"),
                       .pin = R"("translation":[2,0,1],)",
                       .motion = box};
  CHECK(only_joint(slider.scene()).directions[0].stiffness == Approx(30));
  CHECK(only_joint(slider.scene()).directions[0].damping == Approx(12));
  /* about a hinge the moment about the hinge: 1.25 + 3 (0.6^2 + 0.8^2) */
  const Jointed hinge{.limits = held("0,1,2", "0,1"),
                      .drives = drive("angular", "2"),
                      .pin = R"("translation":[0.6,0.8,5],)",
                      .motion = box};
  CHECK(only_joint(hinge.scene()).rotations[0].stiffness == Approx(42.5));
  CHECK(only_joint(hinge.scene()).rotations[0].damping == Approx(17));
  /* in the air, without anything held: the moment about the centre; and the second joint of two */
  const Jointed free{.drives = drive("angular", "0") + "," + drive("angular", "1"), .motion = box};
  const Scene both = free.scene();
  REQUIRE(both.joints.size() == 2);
  CHECK(both.joints[0].rotations[0].stiffness == Approx(5));
  CHECK(both.joints[1].rotations[0].stiffness == Approx(10));
  /* between two bodies the masses together: 1 / (1/3 + 1/6) */
  const Jointed pair{.limits = held("1,2", "0,1,2"),
                     .drives = drive("linear", "0"),
                     .motion = box,
                     .more_nodes = R"(,{"name":"Cart","children":[0],"extensions":{"KHR_physics_rigid_bodies":)"
                                   R"({"motion":{"mass":6},"collider":{"geometry":{"shape":0}}}}})"};
  CHECK(only_joint(pair.scene()).directions[0].stiffness == Approx(20));
  /* what no torque turns is moved by no drive about an axis */
  const Jointed stiff{.drives = drive("angular", "0"), .motion = R"("mass":3,"inertiaDiagonal":[0,0,0])"};
  CHECK(only_joint(stiff.scene()).rotations[0].stiffness == 0);
}

TEST_CASE("glTF joints: below a mirroring node ranges and targets are mirrored with it")
{
  const std::string mirror = R"("scale":[-1,1,1],)", range = R"("min":-0.25,"max":0.5)",
                    limits = limit("linear", "0", range) + "," + limit("linear", "1", range) + "," +
                             limit("angular", "1", range);
  const Scene scene = Jointed{.limits = limits, .drives = drive_x, .hinge = mirror, .cup = mirror}.scene();
  const Joint joint = only_joint(scene);
  /* x of the joint is Y: what stands at -X in the file is at +X in the world, and turns about Y the other way */
  CHECK((joint.directions[0].lower == -0.25f && joint.directions[0].upper == 0.5f));
  CHECK((joint.directions[2].lower == -0.5f && joint.directions[2].upper == 0.25f));
  CHECK((joint.directions[2].target_position == -0.5f && joint.directions[2].target_velocity == -0.25f));
  CHECK((joint.rotations[0].lower == -0.5f && joint.rotations[0].upper == 0.25f));
  CHECK((frame_a(scene, joint).axes * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-6);
  CHECK((frame_a(scene, joint).axes * Vector3::UnitZ() - Vector3::UnitX()).norm() < 1e-6);
}

TEST_CASE("glTF joints: between kinematic bodies a joint holds nothing, and is left out with a note")
{
  const Scene scene = Jointed{.limits = ball, .motion = R"("isKinematic":true)"}.scene();
  CHECK(scene.joints.empty());
  REQUIRE(scene.notes.size() == 1);
  CHECK_THAT(scene.notes[0], ContainsSubstring("node 'Hinge': neither of the bodies of its joint moves freely"));
  CHECK(warnings_of(scene, "f") == scene.notes);
}

namespace {

/* One line that names the file, the node and what would be right. */
void check_joint_refused(const Jointed &given, const std::string &said, const std::string &node = "node 'Hinge': ")
{
  const std::string line = given.complaint();
  INFO(line);
  CHECK(line.starts_with(temporary_path + ": " + node));
  CHECK_THAT(line, ContainsSubstring(said));
  CHECK(line.find('\n') == std::string::npos);
}

} // namespace

TEST_CASE("glTF joints: a joint that connects nothing with nothing is refused")
{
  const auto joined = [](const std::string &joint) { return Jointed{.limits = ball, .joint = joint}; };
  check_joint_refused(joined(R"("joint":0)"), R"("connectedNode" is missing)");
  check_joint_refused(joined(R"("connectedNode":1)"), R"(joint: "joint" is missing)");
  check_joint_refused(joined(R"("connectedNode":1,"joint":1)"), "joint.joint: joint 1 does not exist; the file has 1");
  check_joint_refused(joined(R"("connectedNode":9,"joint":0)"), "connectedNode: node 9 does not exist; the file has 3");
  check_joint_refused(joined(R"("connectedNode":4294967295,"joint":0)"), "does not exist");
  for (const char *wrong : {"-1", "0.5", "\"1\"", "null", "[1]", "true"})
    for (const char *key : {"connectedNode", "joint"})
      check_joint_refused(joined(std::string("\"") + key + "\":" + wrong +
                                 (key == std::string("joint") ? R"(,"connectedNode":1)" : R"(,"joint":0)")),
                          std::string("joint.") + key);
  check_joint_refused(joined(R"("connectedNode":1,"joint":0,"enableCollision":1)"), "joint.enableCollision");
  check_joint_refused(joined(R"("connectedNode":1,"joint":0,"breakForce":1)"), "unknown key");
  check_joint_refused(joined(R"("connectedNode":0,"joint":0)"), "connectedNode: is the joint's own node; another one");
  check_joint_refused({.limits = ball, .joint = R"("connectedNode":3,"joint":0)", .more_nodes = R"(,{"name":"Sun"})"},
                      "neither node 'Hinge' nor node 'Sun' has a motion at or above it; a joint needs one");
  Parts none = Jointed{.limits = ball}.parts();
  none.document = "";
  CHECK_THAT(complaint(none), ContainsSubstring(R"("physicsJoints" is missing)"));
}

TEST_CASE("glTF joints: nodes of one body, of no scene, and of a ring cannot be joined")
{
  const std::string of_cup = R"(,{"name":"Lid","extensions":{"KHR_physics_rigid_bodies":{"joint":{"connectedNode":1,)"
                             R"("joint":0}}}})";
  Jointed inside{.limits = ball, .more_nodes = of_cup};
  Parts parts = inside.parts();
  parts.nodes.replace(parts.nodes.find(R"("children":[1])"), 14, R"("children":[1,3])");
  CHECK_THAT(complaint(parts), ContainsSubstring("node 'Lid': joint: node 'Lid' and node 'Pin' are parts of one body, "
                                                 "that of node 'Cup'; a joint connects two"));
  const std::string ring = R"(,{"name":"Sun","children":[4]},{"children":[3]})";
  check_joint_refused({.limits = ball, .joint = R"("connectedNode":3,"joint":0)", .more_nodes = ring},
                      "connectedNode: node 'Sun' is not in the scene that is simulated");
  Parts own_ring =
      Jointed{.limits = ball, .hinge = R"("children":[3],)", .more_nodes = R"(,{"name":"Sun","children":[0]})"}.parts();
  own_ring.more = R"(,"scenes":[{"nodes":[0,2]}])";
  CHECK_THAT(complaint(own_ring), ContainsSubstring("node 'Hinge': has two parents; a node tree is needed"));
}

TEST_CASE("glTF joints: damaged limits and drives are refused")
{
  const auto limited = [](const std::string &limit) { check_joint_refused({.limits = "{" + limit + "}"}, ""); };
  const auto says = [](const std::string &limit, const std::string &said) {
    check_joint_refused({.limits = "{" + limit + "}"}, "physicsJoints[0].limits[0]" + said);
  };
  says(R"("min":1,"max":0,"linearAxes":[0])", ": min is 1 and max 0; a min that is at most max is needed");
  says(R"("max":0)", ": has neither linearAxes and angularAxes");
  says(R"("max":0,"linearAxes":[0],"angularAxes":[0])", ": has both linearAxes and angularAxes; exactly one");
  says(R"("linearAxes":[])", ".linearAxes: is empty");
  says(R"("linearAxes":[3])", ".linearAxes[0]: axis 3 does not exist; 0 (X), 1 (Y) and 2 (Z) do");
  says(R"("angularAxes":[0,0])", ".angularAxes[1]: is listed twice");
  says(R"("linearAxes":[0],"stiffness":-1)", ".stiffness: is -1; at least 0 is needed");
  says(R"("linearAxes":[0],"stiffness":0)", ".stiffness: is 0, which limits nothing");
  says(R"("linearAxes":[0],"damping":-2)", ".damping: is -2; at least 0 is needed");
  says(R"("linearAxes":[0],"lower":1)", ".lower: unknown key");
  says(R"("linearAxes":[0,1,2],"max":-1)", ": is at most -1 over 3 axes");
  says(R"("angularAxes":[0],"min":4)",
       ": is from 4 to inf rad, where no angle is; angles are between -3.14159 and 3.14159");
  for (const char *wrong : {"\"1\"", "null", "true", "[]", "1e39", "-1e300"})
    for (const char *key : {"min", "max", "stiffness", "damping"})
      limited(std::string(R"("linearAxes":[0],")") + key + "\":" + wrong);
  for (const char *wrong : {"0", "[-1]", "[0.5]", "[\"0\"]", "null", "[0,1,2,0]"})
    for (const char *key : {"linearAxes", "angularAxes"}) limited(std::string("\"") + key + "\":" + wrong);
  TemporaryFile not_a_number(gltf(Jointed{.limits = R"({"linearAxes":[0],"min":NaN})"}.parts()));
  CHECK_THROWS_WITH(read_scene_gltf(not_a_number.path), ContainsSubstring("malformed JSON"));

  const auto driven = [](const std::string &drive, const std::string &said) {
    check_joint_refused({.drives = "{" + drive + "}"}, "physicsJoints[0].drives[0]" + said);
  };
  const std::string good = R"("type":"angular","mode":"force","axis":0)";
  driven(R"("mode":"force","axis":0)", R"(: "type" is missing)");
  driven(R"("type":"angular","axis":0)", R"(: "mode" is missing)");
  driven(R"("type":"angular","mode":"force")", R"(: "axis" is missing)");
  driven(R"("type":"spiral","mode":"force","axis":0)", ".type");
  driven(R"("type":"linear","mode":"speed","axis":0)", ".mode");
  driven(R"("type":"linear","mode":"force","axis":3)", ".axis: axis 3 does not exist");
  driven(good + R"(,"maxForce":-1)", ".maxForce: is -1; at least 0 is needed");
  driven(good + R"(,"stiffness":-1)", ".stiffness: is -1; at least 0 is needed");
  driven(good + R"(,"damping":-1)", ".damping: is -1; at least 0 is needed");
  driven(good + R"(,"stiffness":1,"positionTarget":45)", ".positionTarget: is 45 rad, where no angle is");
  driven(good + R"(,"speed":1)", ".speed: unknown key");
  for (const char *wrong : {"\"1\"", "null", "true", "[]", "1e39"})
    for (const char *key : {"maxForce", "positionTarget", "velocityTarget", "stiffness", "damping", "axis"})
      driven((key == std::string("axis") ? R"("type":"angular","mode":"force",")" : good + ",\"") + key + "\":" + wrong,
             std::string(".") + key);
}

TEST_CASE("glTF joints: limits that no joint keeps, or that exclude each other, are refused")
{
  const std::string range = R"("min":0.5,"max":1)";
  const auto says = [](const std::string &limits, const std::string &said) {
    check_joint_refused({.limits = limits}, said);
  };
  says(limit("linear", "0,1", range), "limits[0]: a limit of the distance from a line other than 0 is not supported");
  says(limit("angular", "0,1,2", range), "limits[0]: a limit of the whole turn other than 0 is not supported yet");
  says(limit("angular", "1,2", range), "limits[0]: a cone of a joint that does not hold its two frames together");
  says(ball + "," + limit("linear", "0", range),
       "limits[1]: is from 0.5 to 1, and other limits of the joint hold it at 0");
  says(ball + "," + limit("linear", "0", R"("min":2,"max":2)"), "limits[1]: holds X at 2, which another limit");
  says(held("0,1,2", "0,1,2") + "," + limit("angular", "1", range), "limits[2]: is from 0.5 to 1, and other limits");
  says(held("0,1,2", "1,2") + "," + limit("angular", "1,2", range), "limits[2]: is from 0.5 to 1");
  says(ball + "," + limit("linear", "0,1,2", range), "limits[1]: is from 0.5 to 1");
}

TEST_CASE("glTF joints: frames that are sheared, flat or mirrored on one side alone are refused")
{
  check_joint_refused({.limits = ball, .pin = R"("rotation":[0,0,0.6,0.8],)", .cup = R"("scale":[1,3,1],)"},
                      "a sheared joint (a rotation below an uneven scale) is not supported yet", "node 'Pin': ");
  check_joint_refused({.limits = ball, .hinge = R"("scale":[1,0,1],)"}, "its scale is 0 along Y");
  check_joint_refused({.limits = ball, .hinge = R"("scale":[-1,1,1],)"},
                      "joint: one of node 'Hinge' and node 'Pin' is mirrored by a negative scale and the other is not");
}
