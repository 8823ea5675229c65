/* Trees made from the joints of a scene: their order, what is refused, and that they are where the bodies are. Their
 * mechanics are tested in tests/shared/articulations/; here they meet the solver's joints, in maximal coordinates. */
#include <tandem/articulations.h>

#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

using Numbers = std::vector<double>;

/* Boxes along x, the first on the world at the origin, on hinges about z; joints are listed from the last. */
Scene chain(int count, bool grounded, bool reversed)
{
  Scene scene = empty_scene();
  for (int i = 0; i < count; ++i) {
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.15f), {0.5 + i, 0, 0});
    body.mass = float(2 + i);
    body.filter_mask = 0;
  }
  for (int i = grounded ? 0 : 1; i < count; ++i) {
    const uint32_t before = i == 0 ? no_body : uint32_t(i - 1);
    connect(scene, JointType::hinge, reversed ? uint32_t(i) : before, reversed ? before : uint32_t(i),
            {double(i), 0, 0}, Vector::UnitZ());
  }
  return scene;
}
Articulation all_joints(const Scene &scene)
{
  Articulation articulation;
  for (uint32_t n = uint32_t(scene.joints.size()); n-- > 0;) articulation.joints.push_back(n);
  return articulation;
}

std::string refusal(const Scene &scene, const Articulation &articulation)
{
  try {
    ArticulationTree tree(scene, articulation, "test");
  } catch (const InputError &e) {
    return e.what();
  }
  return "accepted";
}
void check_refusal(const Scene &scene, const Articulation &articulation, const std::string &part)
{
  const std::string message = refusal(scene, articulation);
  CHECK_THAT(message, Catch::Matchers::ContainsSubstring(part));
  CHECK(message.find('\n') == std::string::npos);
}

} // namespace

TEST_CASE("articulations of a scene: parents come first, whatever the order and the sides of the joints",
          "[articulations]")
{
  for (const bool grounded : {false, true})
    for (const bool reversed : {false, true}) {
      const Scene scene = chain(4, grounded, reversed);
      const ArticulationTree tree(scene, all_joints(scene), "test");
      REQUIRE(tree.links().size() == 4);
      for (uint32_t k = 0; k < 4; ++k) {
        const ArticulationLink &l = tree.links()[k];
        CHECK(l.body == k);
        CHECK(l.parent == (k == 0 ? ArticulationLink::none : k - 1));
        CHECK(l.velocities == (k == 0 && !grounded ? 6 : 1));
      }
      CHECK(tree.velocities() == (grounded ? 4 : 9));
    }
}

TEST_CASE("articulations of a scene: coordinates put the bodies where they are and move them as they do",
          "[articulations]")
{
  for (const bool grounded : {false, true})
    for (const bool reversed : {false, true}) {
      const Scene scene = chain(4, grounded, reversed);
      const ArticulationTree tree(scene, all_joints(scene), "test");
      ArticulationState state = tree.state();
      for (size_t i = 0; i < tree.velocities(); ++i) state.velocities[i] = 0.1 * double(i + 1);
      for (size_t k = grounded ? 0 : 1; k < 4; ++k) state.coordinates[k][0] = 0.3 * double(k) - 0.4;
      Scene posed = scene;
      const std::vector<LinkPose> poses = tree.forward_kinematics(state);
      for (size_t k = 0; k < 4; ++k) {
        Body &body = posed.bodies[k];
        const LinkPose &p = poses[k];
        for (size_t i = 0; i < 3; ++i) {
          body.position[i] = p.position[i];
          body.linear_velocity[i] = float(p.linear_velocity[i]);
          body.angular_velocity[i] = float(p.angular_velocity[i]);
        }
        for (size_t i = 0; i < 4; ++i) body.orientation[i] = float(p.orientation[i]);
      }
      const ArticulationState found = ArticulationTree(posed, all_joints(posed), "test").state();
      for (size_t i = 0; i < tree.velocities(); ++i)
        CHECK(found.velocities[i] == Approx(state.velocities[i]).margin(1e-6));
      for (size_t k = grounded ? 0 : 1; k < 4; ++k)
        CHECK(found.coordinates[k][0] == Approx(state.coordinates[k][0]).margin(1e-6));
    }
}

TEST_CASE("articulations of a scene: forces, accelerations and the mass matrix agree", "[articulations]")
{
  const Scene scene = chain(4, false, false);
  Articulation articulation = all_joints(scene);
  articulation.armatures = {0.1f, 0.2f, 0.3f};
  const ArticulationTree tree(scene, articulation, "test");
  const size_t n = tree.velocities();
  ArticulationState state = tree.state();
  for (size_t i = 0; i < n; ++i) state.velocities[i] = 0.3 * double(i) - 1;
  Numbers forces(n), nothing(n);
  for (size_t i = 0; i < n; ++i) forces[i] = double(i % 3) - 1;
  const Numbers accelerations = tree.forward_dynamics(state, forces),
                back = tree.inverse_dynamics(state, accelerations), bias = tree.inverse_dynamics(state, nothing),
                matrix = tree.mass_matrix(state);
  for (size_t i = 0; i < n; ++i) {
    CHECK(back[i] == Approx(forces[i]).margin(1e-10));
    double sum = bias[i];
    for (size_t k = 0; k < n; ++k) sum += matrix[i * n + k] * accelerations[k];
    CHECK(sum == Approx(forces[i]).margin(1e-10));
  }
  /* The velocity of a point of the last link is that of its pose. */
  const LinkPose pose = tree.forward_kinematics(state)[3];
  const Numbers jacobian = tree.jacobian(state, 3, {0, 0, 0});
  for (size_t row = 0; row < 6; ++row) {
    double sum = 0;
    for (size_t k = 0; k < n; ++k) sum += jacobian[row * n + k] * state.velocities[k];
    CHECK(sum == Approx(row < 3 ? pose.angular_velocity[row] : pose.linear_velocity[row - 3]).margin(1e-12));
  }
}

TEST_CASE("articulations of a scene: links fall as the solver's joints let them, to the order of the step",
          "[articulations]")
{
  const Scene scene = chain(2, true, false);
  const ArticulationTree tree(scene, all_joints(scene), "test");
  /* Symplectic Euler with the tree's accelerations, at a thousandth of the solver's substep. */
  ArticulationState state = tree.state();
  constexpr int fine = 40000;
  const Numbers nothing(tree.velocities());
  for (int i = 0; i < fine; ++i) {
    const Numbers a = tree.forward_dynamics(state, nothing);
    for (size_t k = 0; k < 2; ++k) {
      state.velocities[k] += a[k] * 0.4 / fine;
      state.coordinates[k][0] += state.velocities[k] * 0.4 / fine;
    }
  }
  const std::vector<LinkPose> poses = tree.forward_kinematics(state);
  std::vector<double> errors;
  for (const int steps : {48, 96, 192}) {
    World world(scene, stiff_settings(0.4 / steps), in_double);
    run(world, steps);
    const PreciseBodies bodies = world.precise_bodies();
    double most = 0;
    for (size_t k = 0; k < 2; ++k)
      most = std::max(most, (Vector(bodies[k].position.data()) - Vector(poses[k].position.data())).norm());
    errors.push_back(most);
  }
  CAPTURE(errors);
  CHECK(errors.front() < 10 * 0.4 * 0.4 / 48);
  CHECK(falls_with_first_order(errors));
}

TEST_CASE("articulations of a scene: what is no tree is refused in one line", "[articulations]")
{
  const Scene scene = chain(3, true, false);
  const Articulation good = all_joints(scene);
  CHECK(refusal(scene, good) == "accepted");
  Articulation a = good;
  a.joints.push_back(7);
  check_refusal(scene, a, "joint 7 does not exist; the scene has 3 joints");
  a = good;
  a.joints.push_back(1);
  check_refusal(scene, a, "joint 1 is named twice");
  a = good;
  a.armatures = {1};
  check_refusal(scene, a, "1 armatures for 3 joints");
  a.armatures = {1, -1, 0};
  check_refusal(scene, a, "an armature is -1");
  a = good;
  a.root = 1;
  check_refusal(scene, a, "name no root");
  check_refusal(scene, {}, "it has no joints");
  a = {};
  a.root = 9;
  check_refusal(scene, a, "body 9, does not exist");
  a = good;
  a.joints.erase(a.joints.begin() + 1); /* joint 1 connects the others */
  check_refusal(scene, a, "joint 2 is not connected with body 0");
}

TEST_CASE("articulations of a scene: loops, other joints and other bodies are refused", "[articulations]")
{
  Scene scene = chain(3, true, false);
  connect(scene, JointType::ball, 0, 2, {1, 1, 0});
  check_refusal(scene, all_joints(scene), "closes a loop");
  scene.joints.back().body_a = no_body;
  check_refusal(scene, all_joints(scene), "holds the tree to the ground");
  scene.joints.back().type = JointType::universal;
  check_refusal(scene, all_joints(scene), "has another type than fixed, hinge, slider, ball or cone_twist");
  scene = chain(3, false, false);
  scene.bodies[2].angular_locks.x = true;
  check_refusal(scene, all_joints(scene), "has locked axes");
  scene = chain(3, false, false);
  scene.bodies[1].infinite_inertia = true;
  check_refusal(scene, all_joints(scene), "infinite moment of inertia");
  scene = chain(3, false, false);
  scene.bodies[1].type = BodyType::kinematic;
  check_refusal(scene, all_joints(scene), "is not dynamic");
  const ArticulationTree tree(chain(3, false, false), all_joints(chain(3, false, false)), "test");
  ArticulationState state = tree.state();
  state.velocities.pop_back();
  CHECK_THROWS_AS(tree.mass_matrix(state), InputError);
  CHECK_THROWS_AS(tree.jacobian(tree.state(), 3, {0, 0, 0}), InputError);
}
