/* A build that holds only what the scene needs gives the bits of the build that holds everything. */
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

void require_same_state(const std::string &scene, const std::string &backend, uint64_t steps,
                        const Settings &settings = {})
{
  Settings everything = settings;
  everything.specialise = false;
  CAPTURE(scene, backend);
  CHECK(state_after(scene, backend, steps, settings) == state_after(scene, backend, steps, everything));
}

void require_same_state_on_pocl(const std::string &scene, Narrowphase narrowphase = Narrowphase::sat,
                                Support support = Support::brute_force)
{
  Settings settings;
  settings.narrowphase = narrowphase;
  settings.support = support;
  require_pocl();
  require_same_state(scene, "cl:pocl", 20, settings);
}

} // namespace

TEST_CASE("parity on CPU: specialised and all features")
{
  for (const std::string &scene : small_scenes()) {
    World specialised(load_scene(scene));
    Settings everything;
    everything.specialise = false;
    World whole(load_scene(scene), everything);
    CAPTURE(scene);
    CHECK(specialised.features() != whole.features());
    CHECK(specialised.kernels().size() <= whole.kernels().size());
    require_same_state(scene, "tbb", 40);
  }
}

/* The rows of further points come as zeros, also for pairs that sleep. */
TEST_CASE("balls that a box joins, awake or asleep, have the bits of the build that holds everything")
{
  Scene scene = load_scene("spheres:n=64");
  scene.shapes.push_back(box_shape(0.5f, 0.5f, 0.5f));
  for (Body &body : scene.bodies)
    body.linear_damping = body.angular_damping = 2; /* so that they do not roll for ever */
  Settings settings;
  settings.sleeping = GENERATE(false, true);
  Settings everything = settings;
  everything.specialise = false;
  World balls(scene, settings, {"serial", {}}), whole(scene, everything, {"serial", {}});
  const auto run = [&](int steps) {
    for (int k = 0; k < steps; ++k) {
      balls.step();
      whole.step();
    }
    CHECK(balls.body_hash() == whole.body_hash());
    CHECK(balls.state_hash() == whole.state_hash());
  };
  run(settings.sleeping ? 400 : 60);
  CHECK((balls.statistics().asleep > 0) == settings.sleeping);
  for (const Buffer further : {Buffer::cached_feature, Buffer::cached_normal_impulse}) {
    CHECK(balls.memory().bytes(further) == 0);
    CHECK(whole.memory().bytes(further) > 0);
  }
  Body box;
  box.shape = static_cast<uint32_t>(scene.shapes.size() - 1);
  box.position = {0, 8, 0};
  balls.create_body(box);
  whole.create_body(box);
  run(1);
  run(120);
  CHECK(balls.memory().bytes(Buffer::cached_normal_impulse) > 0);
}

/* So a library that leaves out the kernels of other features (cmake/Features.cmake) has all that the world launches. */
TEST_CASE("every kernel of a world is of a feature that the world has, or of none")
{
  Settings settings;
  settings.sleeping = settings.events = settings.check = true;
  settings.bounds = Bounds::tight;
  for (const Solver solver :
       {Solver::soft_step, Solver::pgs, Solver::nncg, Solver::xpbd, Solver::avbd, Solver::jacobi, Solver::direct})
    for (const Narrowphase narrowphase : {Narrowphase::gjk_epa, Narrowphase::sat_split, Narrowphase::cube_map})
      for (const std::string &scene : small_scenes()) {
        settings.solver = solver;
        settings.substeps = solver == Solver::soft_step ? automatic_substeps : 2;
        settings.narrowphase = narrowphase;
        const World world(load_scene(scene), settings, {"serial", {}});
        for (const Kernel kernel : world.kernels()) {
          const Features feature = row_of(kernel).feature;
          CAPTURE(scene, name_of(kernel), name_of(solver), name_of(narrowphase));
          REQUIRE((feature == 0 || (feature & world.features()) != 0));
        }
      }
}

/* One test each, for each may have to compile a build of its own. */
TEST_CASE("parity on OpenCL: specialised box-grid") { require_same_state_on_pocl(small_scenes()[0]); }
TEST_CASE("parity on OpenCL: specialised falling-boxes") { require_same_state_on_pocl(small_scenes()[1]); }
TEST_CASE("parity on OpenCL: specialised box-stack") { require_same_state_on_pocl(small_scenes()[2]); }
TEST_CASE("parity on OpenCL: specialised pyramid") { require_same_state_on_pocl(small_scenes()[3]); }
TEST_CASE("parity on OpenCL: specialised spheres") { require_same_state_on_pocl(small_scenes()[4]); }
TEST_CASE("parity on OpenCL: specialised mixed") { require_same_state_on_pocl(small_scenes()[5]); }
TEST_CASE("parity on OpenCL: specialised trees") { require_same_state_on_pocl(few_trees()); }
TEST_CASE("parity on OpenCL: specialised balls on compounds") { require_same_state_on_pocl(balls_on_compounds()); }
TEST_CASE("parity on OpenCL: specialised shapes") { require_same_state_on_pocl(every_shape()); }
TEST_CASE("parity on OpenCL: specialised convex-hulls") { require_same_state_on_pocl(small_scenes()[7]); }
TEST_CASE("parity on OpenCL: specialised gjk-sampled")
{
  require_same_state_on_pocl(small_scenes()[7], Narrowphase::gjk_sampled);
}
TEST_CASE("parity on OpenCL: specialised cube-map and hill-climbing")
{
  require_same_state_on_pocl(small_scenes()[7], Narrowphase::cube_map, Support::hill_climbing);
}
TEST_CASE("parity on OpenCL: specialised rolling") { require_same_state_on_pocl(small_scenes()[8]); }
