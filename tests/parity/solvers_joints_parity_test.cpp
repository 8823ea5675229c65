/* Joints in every solver that has them give the serial backend's bits on every backend. */
#include "tests/parity/couplings.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

std::vector<Solver> other_solvers_with_joints()
{
  std::vector<Solver> others;
  for (const Solver solver : choices<Solver>())
    if (solver != Solver::soft_step && solves_joints(solver)) others.push_back(solver);
  return others;
}

const std::vector<std::string> several_backends = {"serial", "serial:order=backward", "tbb:threads=2",
                                                   "tbb:threads=3,lanes=1", "tbb:threads=3,lanes=4"};

} // namespace

TEST_CASE("parity on CPU: joints and couplings in every solver that has them")
{
  REQUIRE(other_solvers_with_joints().size() >= 5);
  for (const Solver solver : other_solvers_with_joints()) {
    CAPTURE(solver);
    Settings settings = settings_for(solver);
    settings.events = settings.check = true;
    require_parity(joint_crowd(1, 90), several_backends, 10, settings);
    require_parity(joint_axes(), several_backends, 20, settings);
    require_parity(coupling_crowd(), several_backends, 8, settings);
    require_parity("ragdolls:n=2,height=0", several_backends, 20, settings);
  }
}

TEST_CASE("parity on OpenCL: joints and couplings in every solver that has them")
{
  require_pocl();
  for (const Solver solver : other_solvers_with_joints()) {
    CAPTURE(solver);
    require_parity(joint_axes(), {"serial", "cl:pocl"}, 10, settings_for(solver));
    require_parity(coupling_crowd(1, 40), {"serial", "cl:pocl"}, 6, settings_for(solver));
  }
}

TEST_CASE("joints in every solver go on from snapshots and kept states with the same bits")
{
  for (const Solver solver : other_solvers_with_joints()) {
    CAPTURE(solver);
    for (const Scene &scene : {bridge(), coupling_crowd(2, 30)})
      require_goes_on(scene, settings_for(solver), [](World &, World &) {});
  }
}
