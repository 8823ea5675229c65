/* Mass-split rows give equal bits on every backend: for all contacts, and for overflow constraints beside colours. */
#include "tests/parity/parity.h"
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
