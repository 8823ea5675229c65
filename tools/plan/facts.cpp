/* facts.cpp - what is kept and what is left out, and what brings it in; see plan.h. */
#include <string_view>

#include <fmt/format.h>

#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"
#include "shared/counts.h"
#include "shared/platform.h"
#include "tools/plan/plan.h"

namespace tandem {
namespace {

std::vector<bool> kernels_of(const World &world)
{
  std::vector<bool> built(kernel_count, false);
  for (const Kernel kernel : world.kernels())
    if (index_of(kernel) < kernel_count) built[index_of(kernel)] = true;
  return built;
}

/* What asks for kernels of a stage that no feature of the scene brings in. */
const char *what_asks_for(Stage stage)
{
  switch (stage) {
  case Stage::parallel: return "long scans, sorts";
  case Stage::commands: return "calls to bodies";
  case Stage::broadphase: return "--broadphase";
  case Stage::midphase: return "--midphase";
  case Stage::narrowphase: return "--narrowphase";
  case Stage::batching: return "--batching, --check";
  case Stage::setup: return "--substeps auto";
  case Stage::forces: return "forces";
  case Stage::joints: return "joints";
  case Stage::articulations: return "articulations";
  case Stage::solve: return "--solver";
  case Stage::sleeping: return "--sleep, --substeps auto";
  case Stage::events: return "events";
  case Stage::integrate: return "--solver, reports";
  case Stage::queries:
  case Stage::sweeps: return "queries";
  case Stage::problem: return "contact-problem";
  }
  return "";
}

bool touches(Kernel kernel, Buffer buffer, bool writes)
{
  for (const Argument &argument : row_of(kernel).arguments)
    if (argument.kind == Argument::Kind::buffer && argument.buffer == buffer &&
        (argument.access != Access::in) == writes)
      return true;
  return false;
}

uint64_t own_bytes(World &world, Buffer buffer)
{
  return landlord_of(world, buffer) ? 0 : world.memory().bytes(buffer);
}

/* Sorts have room for the pairs where those are more than twice the bodies, as in any world that is full. */
bool grows_with_pairs(Buffer buffer)
{
  switch (row_of(buffer).capacity) {
  case Capacity::PAIRS:
  case Capacity::PAIRS_PLUS_ONE:
  case Capacity::EVENTS:
  case Capacity::SORTABLE:
  case Capacity::TREE_CONTACTS:
  case Capacity::TREE_CONTACT_FREEDOMS:
  case Capacity::CANDIDATE_PAIRS: return true;
  default: return false;
  }
}

} // namespace

Plan::Plan(World &chosen, World &everything)
    : chosen(chosen), everything(everything), built_(kernels_of(chosen)), built_with_all_(kernels_of(everything))
{}

std::string Plan::backend_of(Kernel kernel) const { return builds(kernel) ? chosen.backend_of(kernel).name() : ""; }

uint64_t Plan::bytes(Buffer buffer) const { return chosen.memory().bytes(buffer); }
uint64_t Plan::bytes_with_all(Buffer buffer) const { return everything.memory().bytes(buffer); }
std::string Plan::flags() const { return fmt::format("-D FEATURES={:#x}ul", chosen.features()); }

std::string Plan::library_option() const
{
  std::string names;
  for (int f = 0; f < FEATURE_COUNT; ++f)
    if (has(f)) names += fmt::format("{}{}", names.empty() ? "" : ";", feature_rows[f].name);
  return fmt::format("-DTANDEM_FEATURES=\"{}\"", names);
}

std::optional<Buffer> landlord_of(World &world, Buffer buffer)
{
  for (const Tenancy &tenancy : world.memory().shared())
    if (tenancy.tenant == buffer) return tenancy.landlord;
  return {};
}

BytesEach bytes_each(World &world)
{
  BytesEach each{world.memory().read<uint32_t>(Buffer::counts, 1, CAPACITY_PAIRS).front()};
  for (size_t b = 0; b < buffer_count; ++b)
    (grows_with_pairs(buffer_at(b)) ? each.pair : each.body) += static_cast<double>(own_bytes(world, buffer_at(b)));
  each.pair /= each.room;
  each.body /= static_cast<double>(world.scene().bodies.size());
  return each;
}

std::vector<StageSum> sums_by_stage(const Plan &plan)
{
  std::vector<StageSum> sums(stage_count);
  for (size_t s = 0; s < stage_count; ++s) sums[s].stage = static_cast<Stage>(s);
  for (size_t k = 0; k < kernel_count; ++k) {
    StageSum &sum = sums[static_cast<size_t>(row_of(kernel_at(k)).stage)];
    ++sum.kernels_of_all;
    sum.kernels += plan.builds(kernel_at(k));
    sum.kernels_with_all += plan.builds_with_all(kernel_at(k));
  }
  for (size_t b = 0; b < buffer_count; ++b) {
    StageSum &sum = sums[static_cast<size_t>(stage_of(buffer_at(b)))];
    sum.bytes += own_bytes(plan.chosen, buffer_at(b));
    sum.bytes_with_all += own_bytes(plan.everything, buffer_at(b));
  }
  return sums;
}

std::string feature_names(Features mask)
{
  std::string names;
  for (int f = 0; f < FEATURE_COUNT; ++f)
    if (mask & feature_of_index(f)) names += fmt::format("{}{}", names.empty() ? "" : " or ", feature_rows[f].name);
  return names;
}

std::string what_brings_in(Kernel kernel)
{
  const Features features = row_of(kernel).feature;
  return features ? feature_names(features) : what_asks_for(row_of(kernel).stage);
}

std::string what_brings_in(Buffer buffer)
{
  const Features features = row_of(buffer).feature;
  return features ? feature_names(features) : what_asks_for(stage_of(buffer));
}

/* Calls between steps write buffers of all stages, so theirs is the last stage that is asked. The sides of a carried
 * buffer have consecutive numbers, and kernels write the first. */
Stage stage_of(Buffer buffer)
{
  if (std::string_view(row_of(buffer).name).starts_with("previous_")) return stage_of(buffer_at(index_of(buffer) - 1));
  for (const bool by_calls : {false, true})
    for (const bool writes : {true, false})
      for (size_t k = 0; k < kernel_count; ++k) {
        const Kernel kernel = kernel_at(k);
        if ((row_of(kernel).stage == Stage::commands) == by_calls && touches(kernel, buffer, writes))
          return row_of(kernel).stage;
      }
  return Stage::parallel;
}

} // namespace tandem
