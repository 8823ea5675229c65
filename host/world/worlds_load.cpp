/* worlds_load.cpp - puts a world that was saved into a batch. Its cached pairs take the place of those of the world
 * that it replaces, so those of the worlds behind move. */
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "host/runtime/interface/floating_point.h"
#include "host/scene/built.h"
#include "host/world/snapshot_scene.h"
#include "host/world/worlds_group.h"

namespace tandem {
namespace {

/* Scenes are equal if they would be saved alike; worlds of a batch have gravity of their own. */
std::vector<std::byte> bytes_of(Scene scene)
{
  scene.gravity = {0, 0, 0};
  scene.name.clear();
  ByteWriter writer;
  put_scene(writer, scene);
  return writer.take();
}

/* The rows of a buffer with those of one world replaced; `rows` may be fewer or more than were there. */
std::vector<std::byte> spliced(std::vector<std::byte> all, size_t begin, size_t end, std::span<const std::byte> rows)
{
  const auto first = all.begin() + static_cast<ptrdiff_t>(begin);
  all.insert(all.erase(first, all.begin() + static_cast<ptrdiff_t>(end)), rows.begin(), rows.end());
  return all;
}

void add_to_words(std::vector<std::byte> &bytes, uint32_t more)
{
  for (size_t at = 0; at < bytes.size(); at += sizeof(uint32_t)) {
    uint32_t word = 0;
    std::memcpy(&word, &bytes[at], sizeof word);
    word += more;
    std::memcpy(&bytes[at], &word, sizeof word);
  }
}

std::span<const std::byte> bytes_in(const SnapshotContents &contents, Buffer buffer)
{
  const auto found = std::find_if(contents.buffers.begin(), contents.buffers.end(),
                                  [&](const SavedBuffer &saved) { return saved.buffer == buffer; });
  return found == contents.buffers.end() ? std::span<const std::byte>{} : found->bytes;
}

/* The settings that decide how a world moves, and its events, as they would be saved. */
std::vector<std::byte> bytes_of(Settings settings)
{
  settings.broadphase = Broadphase::automatic;
  settings.max_pairs = most_pairs;
  settings.specialise = true;
  settings.check = settings.pair_events = settings.moved_bodies = false;
  ByteWriter writer;
  writer.put(settings);
  return writer.take();
}

} // namespace

void Worlds::Group::check_loaded(uint32_t number, const SnapshotContents &contents)
{
  if (!contents.modules.empty() || !contents.islands.empty() || contents.substeps.automatic)
    throw InputError("load: the snapshot is of a world with modules, sleep or substeps auto, which a batch has not");
  if (bytes_of(contents.settings) != bytes_of(settings))
    throw InputError("load: the snapshot is of a world with other settings; the step, its substeps and iterations, the "
                     "solver, the contacts, the narrowphase and events must be those of the batch");
  check_built(contents.special.features, contents.scene, settings, "load");
  const std::vector<BodyStatus> &status = contents.slots.status();
  const bool has_free = std::find(status.begin(), status.end(), BodyStatus::free) != status.end();
  const Scene own = mended(number, scene(number));
  if (has_free || bytes_of(mended(number, contents.scene)) != bytes_of(own) ||
      contents.special.order != specialise(own, settings).order)
    throw InputError(fmt::format("load: the snapshot is of another scene than that of world {}; shapes, materials, "
                                 "starts and properties of bodies must be equal",
                                 engine().first_world + number));
}

/* The starts of the cached pairs, for the world and those behind it. */
void Worlds::Group::load_starts(const CachedRange &old, uint32_t first, std::span<const std::byte> rows)
{
  const uint32_t all = engine().bodies();
  std::vector<uint32_t> starts = engine().memory.read<uint32_t>(Buffer::cached_start, size_t{all} + 1);
  std::vector<uint32_t> own(size_t{bodies} + 1);
  std::memcpy(own.data(), rows.data(), std::min(rows.size(), own.size() * sizeof(uint32_t)));
  for (uint32_t body = first + bodies; body <= all; ++body) starts[body] += own.back() - (old.end - old.begin);
  for (uint32_t body = 0; body < bodies; ++body) starts[first + body] = old.begin + own[body];
  engine().memory.upload(Buffer::cached_start, starts.data(), starts.size() * sizeof(uint32_t));
}

Worlds::Group::CachedRange Worlds::Group::cached_range(uint32_t number)
{
  const auto starts = engine().memory.read<uint32_t>(Buffer::cached_start, size_t{bodies} + 1, size_t{number} * bodies);
  return {starts.front(), starts.back()};
}

/* The cached pairs of all worlds, once those of the snapshot have replaced this range. */
uint64_t Worlds::Group::pairs_with(const CachedRange &old, const SnapshotContents &contents)
{
  const uint32_t all = engine().memory.read<uint32_t>(Buffer::cached_start, 1, engine().bodies()).front();
  return uint64_t{all} - (old.end - old.begin) + contents.pairs;
}

void Worlds::Group::make_room_for(uint64_t pairs)
{
  World::Implementation &all = engine();
  if (pairs > settings.max_pairs)
    throw InputError(fmt::format("load: room for {} pairs is needed, and {} are the most (Settings::max_pairs)", pairs,
                                 settings.max_pairs));
  if (pairs <= all.plan.capacity_pairs) return;
  all.forget_contacts();
  all.enlarge(
      {static_cast<uint32_t>(std::min<uint64_t>(room_for(pairs), settings.max_pairs)), all.plan.capacity_candidates});
}

/* all_pairs: as pairs_with() says. */
void Worlds::Group::load_pairs(uint32_t number, const CachedRange &old, uint64_t all_pairs,
                               const SnapshotContents &contents)
{
  World::Implementation &all = engine();
  const uint32_t first = number * bodies;
  const size_t pairs_before = all_pairs + (old.end - old.begin) - contents.pairs;
  for (const CarriedBuffer &carried : all.buffers.carried()) {
    if (row_of(carried.now).capacity != Capacity::PAIRS || all.memory.bytes(carried.now) == 0) continue;
    const size_t item = item_bytes(carried.now);
    const std::span<const std::byte> given = bytes_in(contents, carried.now);
    std::vector<std::byte> rows(contents.pairs * item); /* zeros where the world alone has no such buffer */
    std::copy(given.begin(), given.end(), rows.begin());
    if (carried.now == Buffer::cached_b) add_to_words(rows, first);
    const std::vector<std::byte> joined =
        spliced(all.memory.read<std::byte>(carried.now, pairs_before * item), old.begin * item, old.end * item, rows);
    all.memory.upload(carried.now, joined.data(), joined.size());
  }
  load_starts(old, first, bytes_in(contents, Buffer::cached_start));
  all.cached_pairs = static_cast<uint32_t>(all_pairs);
}

void Worlds::Group::load_bodies(uint32_t number, const SnapshotContents &contents)
{
  World::Implementation &all = engine();
  const uint32_t first = number * bodies;
  if (contents.forces) all.use_forces();
  for (const auto &[buffer, rows] : contents.buffers) {
    if (all.memory.bytes(buffer) == 0) continue;
    if (row_of(buffer).capacity == Capacity::BODIES)
      all.memory.upload(buffer, rows.data(), rows.size(), first * item_bytes(buffer));
    if (has_rows_in_joints(buffer)) load_joints(buffer, number, rows);
  }
  StagedUploads uploads;
  for (Quarantine taken : contents.quarantined) {
    taken.body += first;
    taken.step += started[number];
    all.slots.quarantine(taken.body);
    if (all.scene.bodies[taken.body].type == BodyType::dynamic) --all.awake_dynamics;
    ++all.statistics.nonfinite;
    stage_properties(uploads, all.scene, std::span(&taken.body, 1), all.index_of_body[taken.body], all.slots.status());
    all.quarantined.push_back(std::move(taken));
  }
  uploads.write(all.memory);
  all.tell_articulations();
}

void Worlds::Group::load_joints(Buffer buffer, uint32_t number, std::span<const std::byte> rows)
{
  const size_t item = item_bytes(buffer);
  for_each_run(items_of_joints(buffer, present_joints().of(number)), [&](size_t at, size_t first, size_t count) {
    engine().memory.upload(buffer, &rows[at * item], count * item, first * item);
  });
}

/* The world is reset first, which leaves nothing of what it was. */
void Worlds::Group::load(uint32_t number, std::span<const std::byte> snapshot)
{
  const minicl::ExactFloatingPoint environment;
  const SnapshotContents contents = read_snapshot(snapshot, "load");
  check_loaded(number, contents);
  engine().settle();
  engine().buffers.make_ready(engine().sizes());
  const CachedRange old = cached_range(number);
  const uint64_t pairs = pairs_with(old, contents);
  make_room_for(pairs);
  prepare_reset(std::span(&number, 1));
  reset(std::span(&number, 1));
  break_as_in(number, contents.scene);
  load_pairs(number, old, pairs, contents);
  started[number] = engine().statistics.steps - contents.steps; /* modulo 2^64, as steps() */
  load_bodies(number, contents);
  gravity[number] = contents.scene.gravity;
  upload_gravity(number, 1);
  forced[number] = contents.forces;
  features[number] = contents.special.features;
  changed[number] = true; /* before or after it was saved */
}

} // namespace tandem
