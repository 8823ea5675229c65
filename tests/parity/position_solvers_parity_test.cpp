/* The solvers xpbd and avbd: one result from every order of items, number of threads, width, and from OpenCL. */
#include "host/pipeline/solvers/solvers.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

const std::vector<std::string> cpu = {
    "serial",       "serial:order=backward", "serial:order=shuffled", "tbb:threads=2,lanes=4", "tbb:threads=7,lanes=8",
    "tbb:threads=7"}; /* as wide as the processor */

} // namespace

TEST_CASE("parity of position solvers on CPU", "[sanitizer]")
{
  const Solver solver = GENERATE(Solver::xpbd, Solver::avbd);
  CAPTURE(solver);
  require_parity("box-grid:nx=4,ny=4,nz=4", cpu, 8, settings_for(solver));
  require_parity("mixed:n=60", cpu, 25, settings_for(solver));
  require_parity("spheres:n=100,height=0,restitution=0.5", cpu, 20, settings_for(solver));
}

TEST_CASE("parity on OpenCL: position solvers")
{
  require_pocl();
  const Solver solver = GENERATE(Solver::xpbd, Solver::avbd);
  Settings settings = settings_for(solver);
  settings.specialise = false;
  CAPTURE(solver);
  require_parity("mixed:n=60", {"serial", "cl:pocl"}, 15, settings);
}

TEST_CASE("parity of position solvers: specialised or not")
{
  const Solver solver = GENERATE(Solver::xpbd, Solver::avbd);
  Settings settings = settings_for(solver);
  const uint64_t specialised = state_after("falling-boxes:n=60,height=0", "tbb", 25, settings);
  settings.specialise = false;
  CHECK(state_after("falling-boxes:n=60,height=0", "serial", 25, settings) == specialised);
}
