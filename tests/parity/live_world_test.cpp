/* Worlds whose bodies come and go: every kernel of every step has the same bits on every backend, whichever broadphase
 * finds the pairs. */
#include "tests/parity/parity.h"
#include "tests/parity/scripted_day.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

ComparisonRequest day_on(std::vector<std::string> backends, uint64_t steps, const Settings &settings)
{
  ComparisonRequest request;
  request.settings = settings;
  request.backends = std::move(backends);
  request.steps = steps;
  request.before_step = ScriptedDay(3);
  return request;
}

void require_equal_day(const ComparisonRequest &request, const Scene &scene = yard())
{
  const Comparison comparison = compare_backends(scene, request);
  if (comparison.first_difference) FAIL(describe(*comparison.first_difference));
  CHECK(comparison.steps == request.steps);
  CHECK(comparison.quarantined.empty());
}

Settings watched()
{
  Settings settings;
  settings.events = true;
  settings.pair_events = true;
  settings.check = true;
  return settings;
}

/* The hash of each step of a day. */
std::vector<uint64_t> hashes_of_day(const Settings &settings, uint64_t steps)
{
  World world(yard(), settings, {"serial", {}});
  const ScriptedDay day(5);
  std::vector<uint64_t> hashes;
  for (uint64_t step = 0; step < steps; ++step) {
    day(world, step);
    world.step();
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

} // namespace

TEST_CASE("parity on CPU: a scripted day in a world whose bodies come and go")
{
  require_equal_day(day_on(cpu_backends(), 80, watched()));
}

TEST_CASE("parity on CPU: short days of every solver", "[sanitizer]")
{
  for (const Solver solver : choices<Solver>()) {
    CAPTURE(solver);
    Settings settings = settings_for(solver);
    settings.events = true;
    require_equal_day(day_on({"serial", "tbb:threads=2,lanes=4"}, 50, settings));
  }
}

TEST_CASE("a scripted day is the same with every broadphase", "[sanitizer]")
{
  const std::vector<uint64_t> expected = hashes_of_day(watched(), 60);
  for (const Broadphase broadphase : choices<Broadphase>()) {
    CAPTURE(broadphase);
    Settings settings = watched();
    settings.broadphase = broadphase;
    CHECK(hashes_of_day(settings, 60) == expected);
  }
}

TEST_CASE("a scripted day is the same with all features from the start", "[sanitizer]")
{
  Settings general = watched();
  general.specialise = false;
  CHECK(hashes_of_day(general, 60) == hashes_of_day(watched(), 60));
}

TEST_CASE("parity on OpenCL: a scripted day in a world whose bodies come and go")
{
  require_pocl();
  require_equal_day(day_on({"tbb", "cl:pocl"}, 50, {}), plain_yard());
}
