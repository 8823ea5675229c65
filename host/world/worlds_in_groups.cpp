/* worlds_in_groups.cpp - how a batch is cut into groups, and what groups do together: steps, resets, controls. */
#include <algorithm>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>

#include "host/runtime/make_backend.h"
#include "host/scene/parameters.h"
#include "host/world/worlds.h"

namespace tandem {
namespace {

void check_scenes(std::span<const Scene> scenes, uint32_t copies)
{
  if (scenes.empty() || copies == 0) throw InputError("worlds: 0 worlds; at least 1 is needed");
  for (size_t k = 0; k < scenes.size(); ++k) {
    validate(scenes[k], scenes[k].name);
    if (scenes[k].bodies.size() != scenes.front().bodies.size())
      throw InputError(
          fmt::format("worlds: scene {} ('{}') has {} bodies and scene 0 has {}; the worlds of a batch have "
                      "equally many",
                      k, scenes[k].name, scenes[k].bodies.size(), scenes.front().bodies.size()));
  }
  const uint64_t worlds = uint64_t{copies} * scenes.size(), bodies = worlds * scenes.front().bodies.size();
  if (bodies >= body_numbers)
    throw InputError(fmt::format("worlds: {} worlds of {} bodies are {} bodies; kernels can number {}", worlds,
                                 scenes.front().bodies.size(), bodies, body_numbers - 1));
}

void check_batch_settings(const Settings &settings)
{
  const auto refuse = [](const char *what, const char *instead) {
    throw InputError(fmt::format("worlds: {}: a batch of worlds has {}", what, instead));
  };
  if (settings.substeps == automatic_substeps) refuse("substeps auto", "a number of substeps, the same for all");
  if (settings.sleeping) refuse("sleeping", "no bodies that sleep");
  if (settings.solver != Solver::soft_step) refuse(name_of(settings.solver), "the solver soft-step alone");
  if (settings.batching != Batching::coloring) refuse(name_of(settings.batching), "the batching coloring alone");
  if (settings.broadphase != Broadphase::automatic)
    refuse(name_of(settings.broadphase), "the broadphase auto alone, which looks within each world");
  if (settings.check) refuse("check", "no check of batches; a world alone has it");
  if (!settings.extensions.empty()) refuse("extensions", "no modules");
}

/* In all groups, so that a batch which runs on a CPU runs on a device, too. */
void check_materials(std::span<const Scene> scenes)
{
  SceneTables tables;
  Scene all;
  all.materials.clear();
  for (const Scene &scene : scenes) {
    Scene bare;
    bare.name = scene.name;
    bare.shapes = scene.shapes;
    bare.materials = scene.materials;
    tables.add(bare, all);
  }
  if (all.materials.size() > MOST_MATERIALS)
    throw InputError(fmt::format("worlds: the scenes have {} materials; at most {} in all, and scenes that follow one "
                                 "another and have the same count once",
                                 all.materials.size(), MOST_MATERIALS));
}

/* --- the size of a group ----------------------------------------------------------------------------------------- */
/* With 64 humanoids of 23 bodies each, a thread finds what it wrote in its own cache again. */
constexpr uint32_t bodies_of_group = 1536;
/* Trees of equal worlds go through their kernels in lanes of so many; what is left over takes as long as all of
 * them. */
constexpr uint32_t worlds_beside = 16;
/* So many groups for each thread, because one may have more contacts than another. */
constexpr uint32_t groups_of_thread = 4;
/* Every group has the triangles of its scenes for itself. */
constexpr size_t most_triangles = 4096;

/* TANDEM_WORLDS_OF_GROUP: how many worlds tests want in each group of a CPU's; 0: as it is best. */
uint32_t worlds_of_group_of_tests()
{
  const char *text = std::getenv("TANDEM_WORLDS_OF_GROUP");
  if (!text || !*text) return 0;
  char *end = nullptr;
  const unsigned long worlds = std::strtoul(text, &end, 10);
  if (*end || worlds < 1 || worlds > body_numbers)
    throw InputError(fmt::format("TANDEM_WORLDS_OF_GROUP '{}' is not a whole number from 1 to {}", text, body_numbers));
  return static_cast<uint32_t>(worlds);
}

uint32_t rounded_up(uint32_t number, uint32_t to) { return (number + to - 1) / to * to; }
uint32_t rounded(uint32_t number, uint32_t to) { return (number + to / 2) / to * to; }

bool has_many_triangles(std::span<const Scene> scenes)
{
  size_t triangles = 0;
  for (const Scene &scene : scenes)
    for (const Shape &shape : scene.shapes)
      if (shape.mesh) triangles += shape.mesh->triangles.size();
  return triangles > most_triangles;
}

/* Threads of the CPU that could step a group each; nothing if the worlds stay together. */
std::optional<NamedThreads> threads_for(std::span<const Scene> scenes, const Settings &settings,
                                        const Placement &placement)
{
  const bool is_whole = placement.exceptions.empty() && !placement.automatic && placement.broadphase_for.empty();
  if (!is_whole || settings.max_pairs < most_pairs || has_many_triangles(scenes)) return std::nullopt;
  return threads_named(placement.on);
}

/* Few large worlds are done sooner by threads that share each kernel. */
uint32_t worlds_of_group(uint32_t worlds, uint32_t bodies, uint32_t threads)
{
  if (const uint32_t wanted = worlds_of_group_of_tests()) return std::min(wanted, worlds);
  const uint32_t few = std::max(1u, bodies_of_group / std::max(bodies, 1u));
  const uint32_t for_cache =
      few < worlds_beside && threads > 1 ? few : std::max(rounded(few, worlds_beside), worlds_beside);
  const uint32_t for_threads = (worlds + groups_of_thread * threads - 1) / (groups_of_thread * threads);
  const uint32_t whole = rounded_up(for_threads, worlds_beside),
                 shared = worlds / whole >= threads ? whole : rounded_up(for_threads, worlds_beside / 2);
  const uint32_t each = threads == 1 ? for_cache : std::min(for_cache, shared);
  return worlds / each >= threads && worlds > each ? each : worlds;
}

} // namespace

Worlds::Implementation::Implementation(std::span<const Scene> scenes, uint32_t copies, const Settings &given,
                                       const Placement &chosen)
    : settings(given), placement(chosen), threads(1)
{
  const minicl::ExactFloatingPoint environment;
  validate(settings);
  check_batch_settings(settings);
  check_scenes(scenes, copies);
  check_materials(scenes);
  worlds = static_cast<uint32_t>(scenes.size()) * copies;
  bodies = static_cast<uint32_t>(scenes.front().bodies.size());
  of_group = worlds;
  Placement of_one = placement;
  if (const auto named = threads_for(scenes, settings, placement)) {
    of_group = worlds_of_group(worlds, bodies, named->count);
    if (of_group < worlds) {
      of_one.on = named->one;
      threads = PartThreads(named->count);
    }
  }
  groups.resize((worlds + of_group - 1) / of_group);
  for_each_group([&](size_t k) {
    const uint32_t first = static_cast<uint32_t>(k) * of_group, count = std::min(of_group, worlds - first);
    const bool are_copies = scenes.size() == 1;
    groups[k] = std::make_unique<Group>(are_copies ? scenes : scenes.subspan(first, count), are_copies ? count : 1,
                                        settings, of_one, first);
  });
}

/* --- checks ------------------------------------------------------------------------------------------------------ */
void Worlds::Implementation::check_world(const char *call, uint32_t world) const
{
  if (world >= worlds) throw InputError(fmt::format("{}: world {} does not exist; there are {}", call, world, worlds));
}

void Worlds::Implementation::check(const char *call, std::span<const uint32_t> given) const
{
  for (const uint32_t world : given) check_world(call, world);
}

void Worlds::Implementation::check(const char *call, std::span<const WorldBody> given) const
{
  for (size_t i = 0; i < given.size(); ++i) {
    check_world(call, given[i].world);
    if (given[i].body >= bodies)
      throw InputError(
          fmt::format("{}: entry {}: body {} does not exist; worlds have {} bodies", call, i, given[i].body, bodies));
  }
}

void Worlds::Implementation::check(const char *call, std::span<const WorldJoint> given)
{
  for (size_t i = 0; i < given.size(); ++i) {
    check_world(call, given[i].world);
    const uint32_t joints = group_of(given[i].world).tables.joints(number_in_group(given[i].world));
    if (given[i].joint >= joints)
      throw InputError(fmt::format("{}: entry {}: joint {} does not exist; world {} has {} joints", call, i,
                                   given[i].joint, given[i].world, joints));
  }
}

bool Worlds::Implementation::is_kinematic(const WorldBody &body)
{
  const std::vector<Body> &all = group_of(body.world).engine().scene.bodies;
  return all[number_in_group(body.world) * bodies + body.body].type == BodyType::kinematic;
}

void Worlds::Implementation::check_properties(size_t entry, const WorldBody &body, const BodyProperties &properties)
{
  if (properties.continuous)
    throw InputError(fmt::format("set_properties: entry {}: continuous: bodies of a batch keep what their scene says, "
                                 "because their order follows from it",
                                 entry));
  const uint32_t materials = group_of(body.world).tables.materials(number_in_group(body.world));
  if (properties.material && *properties.material >= materials)
    throw InputError(fmt::format("set_properties: entry {}: material {} does not exist; the scene of world {} has {}",
                                 entry, *properties.material, body.world, materials));
}

/* --- steps ------------------------------------------------------------------------------------------------------- */
namespace {

/* What all of so many parts must be ready for before one of them does it. */
template <class Prepare, class Agree, class Do> class TwoPhases : public PhasesOfParts {
public:
  TwoPhases(size_t parts, const Prepare &prepare, const Agree &agree, const Do &execute)
      : parts_(parts), prepare_(prepare), agree_(agree), do_(execute)
  {}
  size_t phases() const override { return 2; }
  size_t parts_of(size_t phase) override
  {
    if (phase == 1) agree_();
    return parts_;
  }
  void run(size_t phase, size_t part) override { phase == 0 ? prepare_(part) : do_(part); }

private:
  size_t parts_;
  const Prepare &prepare_;
  const Agree &agree_;
  const Do &do_;
};

void agree() {}

} // namespace

void Worlds::Implementation::step(const StepLimits &limits)
{
  const auto attempt = [&](size_t k) {
    try {
      groups[k]->attempt_step(limits);
    } catch (const LimitExceeded &error) {
      if (groups.size() == 1) throw;
      throw LimitExceeded(fmt::format("{}; so many has one group of the worlds alone", error.what()));
    }
  };
  const auto agree_on_limits = [&] { check_limits(limits); };
  const auto complete = [&](size_t k) { groups[k]->engine().complete_step(); };
  TwoPhases phases(groups.size(), attempt, agree_on_limits, complete);
  try {
    threads.run(phases);
  } catch (...) {
    for (const std::unique_ptr<Group> &group : groups) group->engine().abandon_step();
    throw;
  }
}

/* Each group has been checked; the limits are of them all. */
void Worlds::Implementation::check_limits(const StepLimits &limits) const
{
  uint64_t pairs = 0, sequential = 0;
  for (const std::unique_ptr<Group> &group : groups) {
    if (!group->engine().attempt) continue;
    pairs += group->engine().plan.known[COUNT_PAIRS];
    sequential += group->engine().sequential_contacts();
  }
  const auto check = [&](uint64_t needed, uint32_t limit, const char *what) {
    if (needed > limit)
      throw LimitExceeded(fmt::format("step {}: {} {} are needed, and {} are the most that the limits of this step "
                                      "allow; the state is that before the step",
                                      groups.front()->engine().statistics.steps, needed, what, limit));
  };
  check(pairs, limits.pairs, "pairs");
  check(sequential, limits.sequential_contacts, "contacts beyond the last colour");
}

/* --- resets and controls ----------------------------------------------------------------------------------------- */
void Worlds::Implementation::reset(std::span<const uint32_t> given)
{
  std::vector<uint32_t> numbers(given.begin(), given.end());
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  const std::vector<Share<uint32_t>> shares = shares_of(std::span<const uint32_t>(numbers));
  const auto prepare = [&](size_t k) { shares[k].group->prepare_reset(shares[k].items); };
  const auto reset = [&](size_t k) { shares[k].group->reset(shares[k].items); };
  TwoPhases phases(shares.size(), prepare, agree, reset);
  threads.run(phases);
}

void Worlds::Implementation::set_controls(std::span<const uint32_t> given, std::span<const float> values)
{
  const minicl::ExactFloatingPoint environment;
  if (groups.size() == 1) {
    Group &all = *groups.front();
    all.controls.prepare(all.engine(), given, values);
    return all.controls.set(all.engine());
  }
  const size_t controls = groups.front()->controls.count();
  const std::vector<Share<uint32_t>> shares = shares_of(given);
  const auto prepare = [&](size_t k) {
    const Share<uint32_t> &share = shares[k];
    std::vector<float> own(share.items.size() * controls);
    for (size_t i = 0; i < share.items.size(); ++i)
      std::copy_n(values.begin() + static_cast<ptrdiff_t>(share.places[i] * controls), controls,
                  own.begin() + static_cast<ptrdiff_t>(i * controls));
    share.group->controls.prepare(share.group->engine(), share.items, own);
  };
  const auto set = [&](size_t k) { shares[k].group->controls.set(shares[k].group->engine()); };
  TwoPhases phases(shares.size(), prepare, agree, set);
  threads.run(phases);
}

} // namespace tandem
