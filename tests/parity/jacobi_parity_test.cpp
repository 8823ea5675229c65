/* Mass-split rows give equal bits on every backend: for all contacts and joints, and for overflow constraints beside
 * colours. */
#include "tests/parity/couplings.h"
#include "tests/physics/laden.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

const std::vector<std::string> orders_and_widths = {"serial", "serial:order=backward", "serial:order=shuffled",
                                                    "tbb:threads=7,lanes=8", "tbb"};

} // namespace

TEST_CASE("parity on CPU: jacobi", "[sanitizer]")
{
  require_parity("box-grid:nx=4,ny=4,nz=4", orders_and_widths, 12, settings_for(Solver::jacobi));
  require_parity("mixed:n=60", orders_and_widths, 25, settings_for(Solver::jacobi));
  require_parity("spheres:n=60,height=0,restitution=0.5", orders_and_widths, 25, settings_for(Solver::jacobi));
}

/* The hub has a list so long that its tree has a second level. */
TEST_CASE("parity on CPU: jacobi with joints", "[sanitizer]")
{
  const std::vector<std::string> widths = {orders_and_widths[0],    orders_and_widths[1],    orders_and_widths[2],
                                           "tbb:threads=2,lanes=4", "tbb:threads=3,lanes=8", "tbb:threads=2,lanes=16"};
  require_parity(physics_tests::hub_with_balls(1100, {0, -10, 0}), widths, 3, settings_for(Solver::jacobi));
  require_parity(joint_crowd(3, 70), widths, 6, settings_for(Solver::jacobi));
  require_parity(joint_axes(), widths, 12, settings_for(Solver::jacobi));
}

TEST_CASE("parity on CPU: the overflow constraints")
{
  require_parity(physics_tests::laden_slab(13, 0.5f), orders_and_widths, 12, {});
  require_parity(physics_tests::laden_slab(13, 0.5f), orders_and_widths, 6, settings_for(Solver::jacobi));
}

/* Long enough for a second level of the tree. */
TEST_CASE("parity on CPU: a list of more than a thousand")
{
  require_parity(physics_tests::laden_slab(35), {"serial", orders_and_widths[2], orders_and_widths[3]}, 3, {});
}

TEST_CASE("parity on OpenCL: jacobi and the overflow constraints")
{
  require_pocl();
  const std::vector<std::string> backends = {"serial", "cl:pocl"};
  require_parity("mixed:n=60", backends, 15, build_of_all_features(settings_for(Solver::jacobi)));
  require_parity(physics_tests::laden_slab(35), backends, 3, build_of_all_features(settings_for(Solver::jacobi)));
  require_parity(physics_tests::laden_slab(13, 0.5f), backends, 8, build_of_all_features());
}

TEST_CASE("parity on OpenCL: jacobi with joints")
{
  require_pocl();
  const std::vector<std::string> backends = {"serial", "cl:pocl"};
  const Settings settings = build_of_all_features(settings_for(Solver::jacobi));
  require_parity(physics_tests::hub_with_balls(1100, {0, -10, 0}), backends, 2, settings);
  require_parity(joint_crowd(3, 70), backends, 4, settings);
  require_parity(joint_axes(), backends, 8, settings);
}

TEST_CASE("jacobi and the overflow constraints are the same in a specialised build")
{
  for (const Solver solver : {Solver::jacobi, Solver::soft_step}) {
    Settings settings = settings_for(solver);
    World special(physics_tests::laden_slab(12), settings, {"serial", {}, false});
    World general(physics_tests::laden_slab(12), build_of_all_features(settings), {"serial", {}, false});
    for (int step = 0; step < 10; ++step) {
      special.step();
      general.step();
      CAPTURE(solver, step);
      REQUIRE(special.state_hash() == general.state_hash());
    }
  }
}

/* Of the joints of a scene, and of their absence, the features that it needs tell no more than all of them. */
TEST_CASE("jacobi with and without joints is the same in a specialised build")
{
  const Settings settings = settings_for(Solver::jacobi);
  for (const Scene &scene : {joint_crowd(4, 30), bridge(4, 3), load_scene("mixed:n=20"), load_scene("ragdolls:n=1")}) {
    World special(scene, settings, {"serial", {}, false}),
        general(scene, build_of_all_features(settings), {"serial", {}, false});
    for (int step = 0; step < 8; ++step) {
      special.step();
      general.step();
      CAPTURE(scene.name, step);
      REQUIRE(special.state_hash() == general.state_hash());
    }
  }
}
