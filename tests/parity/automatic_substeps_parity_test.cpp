/* Worlds that choose their substeps choose alike on all backends. */
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

void require_same_choice(const std::string &name, const std::vector<std::string> &backends, uint64_t steps,
                         const Settings &settings = {})
{
  ComparisonRequest request;
  request.settings = settings;
  request.settings.substeps = automatic_substeps;
  request.backends = backends;
  request.steps = steps;
  const Comparison comparison = compare_backends(load_scene(name), request);
  CAPTURE(name);
  if (comparison.first_difference) FAIL(describe(*comparison.first_difference));
  CHECK(comparison.steps == steps);
}

} // namespace

TEST_CASE("parity on CPU: automatic substeps")
{
  for (const char *name : {"mass-ratio", "mixed:n=100", "pyramid:rows=8", "compounds:n=40", "tower", "tops",
                           "wrecking-ball", "ragdolls:n=2", "vehicle", "crane"})
    require_same_choice(name, cpu_backends(), 10);
}

TEST_CASE("parity on OpenCL: automatic substeps", "[opencl]")
{
  require_pocl();
  for (const char *name : {"mass-ratio", "mixed:n=60", "tower:levels=12", "tops", "wrecking-ball", "crane"})
    require_same_choice(name, {"serial", "cl:pocl"}, 6, build_of_all_features());
}
