/* restored.cpp - makes worlds of snapshots that have been read and checked; see snapshot.h. */
#include <algorithm>

#include <fmt/ranges.h>

#include "host/runtime/interface/floating_point.h"
#include "host/runtime/interface/module.h"
#include "host/world/implementation.h"
#include "host/world/snapshot.h"

namespace tandem {
namespace {

void check_modules(const std::vector<std::string> &wanted, const std::vector<Extension> &given,
                   const std::string &where)
{
  std::vector<std::string> names;
  for (const Extension &extension : given) names.emplace_back(extension.module->name());
  if (names != wanted)
    throw InputError(fmt::format("{}: its world had the modules [{}], and [{}] are given; give extensions of the same "
                                 "modules in the same order",
                                 where, fmt::join(wanted, ", "), fmt::join(names, ", ")));
}

/* Ample, so that the next step hardly ever runs again, and enough for what modules keep by pairs. */
uint32_t capacity_for(const SnapshotContents &contents)
{
  uint64_t pairs = std::max<uint64_t>(first_capacity(contents.scene, contents.settings), room_for(contents.pairs));
  pairs = std::max<uint64_t>(std::min<uint64_t>(pairs, contents.settings.max_pairs), contents.pairs);
  for (const auto &[buffer, bytes] : contents.buffers)
    if (!is_carried(row_of(buffer).lifetime) &&
        (row_of(buffer).capacity == Capacity::PAIRS || row_of(buffer).capacity == Capacity::PAIRS_PLUS_ONE ||
         row_of(buffer).capacity == Capacity::EVENTS))
      pairs = std::max<uint64_t>(pairs, std::min<uint64_t>(bytes.size() / item_bytes(buffer), most_pairs));
  return static_cast<uint32_t>(pairs);
}

} // namespace

void World::Implementation::take_buffers(const SnapshotContents &contents)
{
  std::vector<bool> given(all_buffers());
  for (const auto &[buffer, bytes] : contents.buffers) {
    given[index_of(buffer)] = true;
    const bool fits = is_carried(row_of(buffer).lifetime) || is_saved(buffer) || is_sized_by_writes(buffer);
    if (is_sized_by_writes(buffer) && buffers.needs().touched[index_of(buffer)])
      memory.assign(buffer, bytes.data(), bytes.size());
    else if (!fits || bytes.size() > memory.bytes(buffer))
      throw InputError(fmt::format("snapshot: buffer {} has {} bytes in it and {} here; the file is damaged",
                                   row_of(buffer).name, bytes.size(), memory.bytes(buffer)));
    else memory.upload(buffer, bytes.data(), bytes.size());
  }
  /* Steps leave the rows of sleepers on both sides, and those of joints that are not enabled. */
  const auto has_idle_rows = [&](Buffer buffer) {
    return contents.islands.empty() ? has_rows_of_joints(row_of(buffer)) : has_rows_of_sleepers(buffer);
  };
  for (const CarriedBuffer &carried : buffers.carried())
    if (has_idle_rows(carried.now) && memory.bytes(carried.now) > 0) {
      const size_t items = items_in_use(memory, carried.now, {bodies(), special.awake}, contents.pairs);
      const auto rows = memory.read<std::byte>(carried.now, items * item_bytes(carried.now));
      memory.upload(carried.previous, rows.data(), rows.size());
    }
  for (const CarriedBuffer &carried : buffers.carried())
    if (memory.bytes(carried.now) > 0 && !given[index_of(carried.now)])
      throw InputError(fmt::format("snapshot: buffer {} is missing; the file is damaged", row_of(carried.now).name));
}

/* The islands that sleep, whose pairs must have the words that this world's buffers of pairs have. */
void World::Implementation::take_islands(const SnapshotContents &contents)
{
  size_t words = 0;
  for (const CarriedBuffer &rows : pair_rows(buffers.needs().touched)) words += item_bytes(rows.now) / sizeof(uint32_t);
  for (const SleepingIsland &island : contents.islands)
    for (const SleepingPair &pair : island.pairs)
      if (pair.words.size() != words)
        throw InputError(fmt::format("snapshot: a sleeping pair has {} words and {} are needed; the file is damaged",
                                     pair.words.size(), words));
  for (const SleepingIsland &island : contents.islands) sleepers.add(island);
  take_joint_order(contents.joint_order);
  if (!sleepers.empty()) sleepers_changed();
  if (settings.sleeping) recount_motion();
  plan.drowsy = contents.drowsy;
  plan.substeps = contents.substeps;
}

std::unique_ptr<World::Implementation> World::Implementation::restored(std::span<const std::byte> snapshot,
                                                                       std::vector<Extension> extensions,
                                                                       const Placement &placement,
                                                                       const Implementation *old)
{
  const minicl::ExactFloatingPoint environment;
  SnapshotContents contents = read_snapshot(snapshot, "snapshot");
  check_modules(contents.modules, extensions, "snapshot");
  return made_of(std::move(contents), std::move(extensions), placement, old);
}

std::unique_ptr<World::Implementation> World::Implementation::made_of(SnapshotContents contents,
                                                                      std::vector<Extension> extensions,
                                                                      const Placement &placement,
                                                                      const Implementation *old)
{
  const uint32_t capacity = capacity_for(contents);
  contents.settings.extensions = std::move(extensions);
  auto world = std::make_unique<Implementation>(Beginning{std::move(contents.scene), std::move(contents.settings),
                                                          std::move(contents.special), std::move(contents.slots),
                                                          contents.room, capacity, contents.forces},
                                                placement, old ? &old->backends : nullptr);
  world->joint_slots = std::move(contents.joint_slots);
  world->take_buffers(contents);
  world->take_islands(contents);
  world->shapes = std::move(contents.shapes);
  world->made_shapes = {contents.made_shapes.begin(), contents.made_shapes.end()};
  world->statistics.steps = contents.steps;
  world->statistics.overflow = contents.overflow;
  world->statistics.nonfinite = static_cast<uint32_t>(contents.quarantined.size());
  world->quarantined = std::move(contents.quarantined);
  world->fault = contents.fault;
  world->sleep_events_to_come = std::move(contents.sleep_events); /* and none of those islands' coming here */
  world->cached_pairs = contents.pairs;
  if (old && old->ring.size() > 0)
    world->keep_states(static_cast<uint32_t>(old->ring.size()), old->ring.keeps_after_steps());
  if (old) world->buffers.keep_after_steps_as(old->buffers);
  if (old) world->set_observer(old->launcher.observer());
  return world;
}

} // namespace tandem
