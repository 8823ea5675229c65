/* Joints in every solver that has them give the serial backend's bits on every backend. */
#include "tests/parity/couplings.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

std::vector<Solver> other_solvers()
{
  std::vector<Solver> others;
  for (const Solver solver : choices<Solver>())
    if (solver != Solver::soft_step) others.push_back(solver);
  return others;
}

/* avbd has neither locks nor couplings. */
Scene joints_for(Solver solver, uint64_t seed, uint32_t bodies)
{
  Scene scene = joint_crowd(seed, bodies);
  if (solver != Solver::avbd) return scene;
  for (Body &body : scene.bodies) body.linear_locks = body.angular_locks = {};
  return scene;
}

const std::vector<std::string> several_backends = {"serial", "serial:order=backward", "tbb:threads=2",
                                                   "tbb:threads=3,lanes=1", "tbb:threads=3,lanes=4"};

} // namespace

TEST_CASE("parity on CPU: joints and couplings in every solver that has them")
{
  for (const Solver solver : other_solvers()) {
    CAPTURE(solver);
    Settings settings = settings_for(solver);
    settings.events = settings.check = true;
    require_parity(joints_for(solver, 1, 90), several_backends, 10, settings);
    require_parity(joint_axes(), several_backends, 20, settings);
    if (solves_couplings(solver)) require_parity(coupling_crowd(), several_backends, 8, settings);
    require_parity("ragdolls:n=2,height=0", several_backends, 20, settings);
  }
}

TEST_CASE("parity on OpenCL: joints and couplings in every solver that has them")
{
  require_pocl();
  for (const Solver solver : other_solvers()) {
    CAPTURE(solver);
    const Settings settings = build_of_all_features(settings_for(solver));
    require_parity(joint_axes(), {"serial", "cl:pocl"}, 10, settings);
    if (solves_couplings(solver)) require_parity(coupling_crowd(1, 40), {"serial", "cl:pocl"}, 6, settings);
    else require_parity(joints_for(solver, 1, 40), {"serial", "cl:pocl"}, 6, settings);
  }
}

TEST_CASE("joints in every solver go on from snapshots and kept states with the same bits")
{
  for (const Solver solver : other_solvers()) {
    CAPTURE(solver);
    for (const Scene &scene : {bridge(), solves_couplings(solver) ? coupling_crowd(2, 30) : joints_for(solver, 2, 30)})
      require_goes_on(scene, settings_for(solver), [](World &, World &) {});
  }
}

/* Its 33 hinges with friction are too large an island for direct, and without friction they are small. */
TEST_CASE("direct: axes that go leave nothing behind that a snapshot has not")
{
  using namespace physics_tests;
  Scene scene = empty_scene();
  for (uint32_t k = 0; k < 33; ++k) {
    add_body(scene, BodyType::dynamic, box_shape(0.4f, 0.1f, 0.1f), {double(k), 0, 0});
    connect(scene, JointType::hinge, k == 0 ? no_body : k - 1, k, {k - 0.5, 0, 0}, Vector::UnitZ());
    scene.joints.back().rotations[0].friction = 1;
  }
  World world(scene, settings_for(Solver::direct), {"serial", {}, false});
  run(world, 3);
  CHECK(world.statistics().direct_left == 33);
  std::vector<Joint> joints = world.scene().joints;
  for (Joint &joint : joints) joint.rotations[0] = {};
  world.set_joints(world.joint_ids(), joints);
  World restored(world.save(), {"tbb:threads=2", {}, false});
  for (int k = 0; k < 5; ++k) {
    world.step();
    restored.step();
    REQUIRE(world.state_hash() == restored.state_hash());
  }
  CHECK(world.statistics().direct_islands == 1);
}

TEST_CASE("direct: a scene with every feature built has the same bits")
{
  for (const char *scene : {"four-bar", "crane", "falling-boxes:n=30,height=0"}) {
    Settings settings = settings_for(Solver::direct);
    const uint64_t specialised = state_after(scene, "serial", 30, settings);
    settings.specialise = false;
    CAPTURE(scene);
    CHECK(state_after(scene, "serial", 30, settings) == specialised);
  }
}
