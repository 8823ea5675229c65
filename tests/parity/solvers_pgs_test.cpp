/* The solvers pgs and nncg, and rolling friction with every solver that has it, give the serial backend's bits. */
#include "host/pipeline/solvers/solvers.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

const std::vector<std::string> processors{
    "serial",         "serial:order=backward", "serial:order=shuffled", "tbb:threads=7,lanes=8",
    "tbb:threads=16", "tbb:threads=2,lanes=4", "tbb:threads=1,lanes=1"}; /* one as wide as the processor */
const std::vector<std::string> devices{"serial", "cl:pocl"};

Scene rolling(const std::string &name)
{
  Scene scene = load_scene(name);
  for (Material &material : scene.materials) {
    material.rolling_friction = 0.02f;
    material.spinning_friction = 0.01f;
  }
  return scene;
}

/* Boxes on a slab: more contacts at one body than there are colours, so there are overflow constraints. */
Scene laden_slab()
{
  Scene scene = load_scene("box-stack:n=1");
  scene.shapes.push_back(box_shape(3, 0.25f, 3));
  scene.shapes.push_back(box_shape(0.2f, 0.2f, 0.2f));
  scene.materials[0].rolling_friction = 0.01f;
  Body slab;
  slab.shape = uint32_t(scene.shapes.size() - 2);
  slab.position = {20, 0.25f, 0};
  slab.mass = 20;
  scene.bodies.push_back(slab);
  for (int i = 0; i < 81; ++i) {
    Body box;
    box.shape = uint32_t(scene.shapes.size() - 1);
    box.mass = 0.5f;
    box.position = {18 + 0.5f * float(i % 9), 0.7f, 0.5f * float(i / 9) - 2};
    scene.bodies.push_back(box);
  }
  return scene;
}

void require_same(const Scene &scene, const Settings &settings, const std::vector<std::string> &backends,
                  uint64_t steps)
{
  ComparisonRequest request;
  request.settings = settings;
  request.backends = backends;
  request.steps = steps;
  const Comparison comparison = compare_backends(scene, request);
  CAPTURE(scene.name, settings.solver);
  if (comparison.first_difference) FAIL(describe(*comparison.first_difference));
  CHECK(comparison.steps == steps);
  CHECK(comparison.kernels_compared > 10 * steps * (backends.size() - 1));
}

Settings settings_of(Solver solver, uint32_t substeps, uint32_t iterations)
{
  Settings settings = settings_for(solver);
  settings.substeps = substeps;
  settings.iterations = iterations;
  return settings;
}

} // namespace

TEST_CASE("parity on CPU: pgs and nncg")
{
  for (const Solver solver : {Solver::pgs, Solver::nncg}) {
    require_same(load_scene("mixed:n=40"), settings_of(solver, 1, 4), processors, 25);
    require_same(load_scene("spheres:n=60,height=0,restitution=0.5"), settings_of(solver, 2, 3), processors, 20);
    require_same(load_scene("box-grid:nx=4,ny=4,nz=4"), settings_of(solver, 1, 4), processors, 10);
  }
}

/* More constraints than a tile of the reduction. */
TEST_CASE("parity on CPU: nncg over several tiles of its sums")
{
  require_same(load_scene("spheres:n=2500,height=0"), settings_of(Solver::nncg, 1, 3),
               {"serial", "tbb:threads=7,lanes=8"}, 2);
}

TEST_CASE("parity on CPU: pgs, nncg and rolling friction with overflow constraints")
{
  for (const Solver solver : {Solver::soft_step, Solver::pgs, Solver::nncg})
    require_same(laden_slab(), settings_of(solver, 1, 3), {"serial", "serial:order=backward", "tbb:threads=7,lanes=8"},
                 4);
}

TEST_CASE("parity on CPU: rolling friction")
{
  for (const Solver solver : {Solver::soft_step, Solver::pgs, Solver::nncg}) {
    require_same(rolling("spheres:n=60,height=0,restitution=0.5"), settings_of(solver, 2, 2), processors, 20);
    require_same(rolling("mixed:n=30"), settings_of(solver, 1, 3), processors, 20);
  }
}

TEST_CASE("parity on CPU: pgs and nncg with all features built in")
{
  for (const Solver solver : {Solver::soft_step, Solver::pgs, Solver::nncg}) {
    Settings everything = settings_for(solver);
    everything.specialise = false;
    for (const char *scene : {"mixed:n=40", "box-grid:nx=3,ny=3,nz=3"})
      CHECK(state_after(scene, "tbb", 30, settings_for(solver)) == state_after(scene, "tbb", 30, everything));
  }
}

TEST_CASE("parity on OpenCL: pgs, nncg and rolling friction")
{
  require_pocl();
  for (const Solver solver : {Solver::pgs, Solver::nncg, Solver::soft_step}) {
    Settings settings = settings_of(solver, 1, 4);
    settings.specialise = false;
    require_same(load_scene("mixed:n=40"), settings, devices, 12);
    require_same(rolling("spheres:n=60,height=0,restitution=0.5"), settings, devices, 12);
    require_same(laden_slab(), settings, devices, 2);
  }
}
