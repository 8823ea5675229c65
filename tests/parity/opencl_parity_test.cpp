/* PoCL, the OpenCL implementation that runs everywhere, gives the serial backend's bits, kernel by kernel.
 *
 * It compiles every kernel again for each set of features and each group size, which takes far longer than the steps.
 * All scenes therefore share the build with all features here; specialised_test.cpp has the specialised builds.
 */
#include "tests/host/runtime/opencl/opencl_device.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

TEST_CASE("parity on OpenCL: every scene")
{
  require_pocl();
  for (const std::string &scene : small_scenes())
    require_parity(scene, {"serial", "cl:pocl"}, 12, build_of_all_features());
}

/* A device is given the number of groups to run before the number of pairs of the step is known. */
TEST_CASE("parity on OpenCL: pairs that grow in number")
{
  require_pocl();
  require_parity(imploding_boxes(), {"serial", "cl:pocl"}, 5, build_of_all_features());
}

TEST_CASE("parity on OpenCL: every broadphase")
{
  require_pocl();
  for (const Broadphase broadphase : choices<Broadphase>()) {
    Settings settings = build_of_all_features();
    settings.broadphase = broadphase;
    settings.bounds = Bounds::tight;
    settings.pair_events = true;
    require_parity("mixed:n=60", {"serial", "cl:pocl"}, 10, settings);
    require_parity("box-grid:nx=12,ny=10,nz=11", {"serial", "cl:pocl"}, 3, settings);
  }
}

TEST_CASE("parity on OpenCL: every batching")
{
  require_pocl();
  for (const Batching batching : choices<Batching>()) {
    Settings settings = build_of_all_features();
    settings.batching = batching;
    settings.check = true;
    require_parity("mixed:n=60", {"serial", "cl:pocl"}, 10, settings);
  }
}

TEST_CASE("parity on OpenCL: every narrowphase")
{
  require_pocl();
  for (const Narrowphase narrowphase : choices<Narrowphase>()) {
    Settings settings = build_of_all_features();
    settings.narrowphase = narrowphase;
    CAPTURE(narrowphase);
    require_parity(every_shape(), {"serial", "cl:pocl"}, 10, settings);
    require_parity("shapes:n=60", {"serial", "cl:pocl"}, 25, settings);
  }
}

TEST_CASE("parity on OpenCL: trees by subtrees")
{
  require_pocl();
  Settings settings = build_of_all_features();
  settings.midphase = Midphase::subtrees;
  require_parity(few_trees(), {"serial", "cl:pocl"}, 20, settings);
}

/* Groups smaller and larger than the pairs, subtrees and nodes of a phase. The other stages, which take long to build,
 * stay on the CPU. */
TEST_CASE("parity on OpenCL: trees by subtrees, other sizes of work-groups")
{
  require_pocl();
  ComparisonRequest request;
  request.settings.midphase = Midphase::subtrees;
  request.backends = {"serial", "cl:pocl"};
  request.steps = 3;
  for (const char *stage : {"parallel", "broadphase", "narrowphase", "batching", "setup", "solve", "integrate"})
    request.placement.exceptions.emplace_back(stage, "serial");
  for (const char *size : {"1", "7", "64"}) {
    const Environment local_size("TANDEM_LOCAL_SIZE", size);
    CAPTURE(size);
    const Comparison comparison = compare_backends(load_scene("hulls-on-mesh:n=200"), request);
    if (comparison.first_difference) FAIL(describe(*comparison.first_difference));
    CHECK(comparison.steps == 3);
  }
}

/* As GPUs run them: enough pairs of several kinds for branches (host/runtime/opencl/branches.h). An observer of
 * launches would join them after each, so whole worlds are compared. */
TEST_CASE("parity on OpenCL: tests of pairs side by side")
{
  require_pocl();
  const Environment always("TANDEM_BRANCHES", "always");
  const Scene scene = load_scene("ragdolls:n=700");
  World on_cpu(scene, {}, {"tbb:threads=2", {}, false}), on_device(scene, {}, {"cl:pocl", {}, false});
  for (int step = 0; step < 16; ++step) {
    on_cpu.step();
    on_device.step();
  }
  CHECK(on_cpu.statistics().pairs >= 16384);
  CHECK(on_cpu.statistics().contacts > 0);
  CHECK(on_device.state_hash() == on_cpu.state_hash());
}

/* More bodies than a tile has items, so that groups of every size stride over several tiles. */
TEST_CASE("parity on OpenCL: every size of work-groups")
{
  require_pocl();
  for (const char *size : {"1", "7", "32", "256"}) {
    const Environment local_size("TANDEM_LOCAL_SIZE", size);
    CAPTURE(size);
    require_parity("spheres:n=1100,height=0", {"serial", "cl:pocl"}, 3);
  }
}
