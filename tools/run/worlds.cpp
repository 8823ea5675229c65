/* worlds.cpp - runs a batch of copies of a scene; see worlds.h. */
#include "tools/run/worlds.h"

#include <algorithm>

#include <fmt/format.h>

#include "tools/command/placement_text.h"
#include "tools/command/progress.h"
#include "tools/command/start.h"
#include "tools/run/stage_table.h"

namespace tandem {
namespace {

double world_steps_a_second(const WorldsOutcome &outcome)
{
  return 1e3 * static_cast<double>(outcome.hashes.size()) /
         std::max(outcome.measurement.step_milliseconds.median, 1e-9);
}

} // namespace

WorldsOutcome simulate_worlds(Worlds &worlds, const std::string &scene, uint64_t steps)
{
  Progress progress("simulating", steps);
  WorldsOutcome outcome{scene, steps, {}, {}, {}};
  outcome.measurement = measure(worlds, steps, [&](uint64_t done) { progress.update(done); });
  outcome.statistics = worlds.statistics();
  outcome.hashes = worlds.state_hashes();
  return outcome;
}

size_t equal_worlds(const WorldsOutcome &outcome)
{
  return static_cast<size_t>(std::count(outcome.hashes.begin(), outcome.hashes.end(), outcome.hashes.front()));
}

std::string worlds_text(const WorldsOutcome &outcome, const Worlds &worlds, const Placement &placement)
{
  const Statistics &statistics = outcome.statistics;
  Table table({"world-steps", fmt::format("{:.0f} a second", world_steps_a_second(outcome))}, false);
  table.add({"pairs", fmt::format("{}", statistics.pairs)});
  table.add({"contacts", fmt::format("{} points in {} pairs", statistics.contacts, statistics.manifolds)});
  table.add({"launches", fmt::format("{:.0f} a step", outcome.measurement.launches)});
  if (placement.start == Start::on_cpu) table.add({"start", start_text(worlds.placement_report(), worlds.is_placed())});
  table.add({"hash", fmt::format("{}, of {} of {} worlds", hash_text(outcome.hashes.front()), equal_worlds(outcome),
                                 outcome.hashes.size())});
  return fmt::format("{}: {} worlds of {} bodies, {} steps of {:.6g} s on {}\n\n{}\n{}", outcome.scene, worlds.count(),
                     worlds.bodies_of_world(), outcome.steps, worlds.settings().step, placement.on,
                     stage_table(outcome.measurement), table.text("  "));
}

Json worlds_json(const WorldsOutcome &outcome, const Worlds &worlds, const Placement &placement)
{
  return {{"scene", outcome.scene},
          {"backend", placement.on},
          {"worlds", worlds.count()},
          {"bodies_of_world", worlds.bodies_of_world()},
          {"steps", outcome.steps},
          {"step_ms", spread_json(outcome.measurement.step_milliseconds)},
          {"stages", stages_json(outcome.measurement)},
          {"world_steps_per_second", world_steps_a_second(outcome)},
          {"pairs", outcome.statistics.pairs},
          {"contacts", outcome.statistics.contacts},
          {"nonfinite", outcome.statistics.nonfinite},
          {"overflow", outcome.statistics.overflow},
          {"placement", placement_json(worlds.placement_report())},
          {"launches", outcome.measurement.launches},
          {"hash", hash_text(outcome.hashes.front())},
          {"equal_worlds", equal_worlds(outcome)}};
}

} // namespace tandem
