/* worlds_alone.cpp - worlds of a batch as they would be alone: their hashes, and a World that goes on from one. */
#include <algorithm>

#include "host/base/hash.h"
#include "host/runtime/interface/floating_point.h"
#include "host/world/worlds_group.h"

namespace tandem {
namespace {

constexpr Buffer body_state[] = {Buffer::body_position, Buffer::body_orientation, Buffer::body_velocity};

/* As hash_buffers computes it. */
uint64_t hash_of_bodies(WorldReader &reader, const WorldPlace &place)
{
  uint64_t hash = 0;
  for (const Buffer buffer : body_state) {
    const std::vector<std::byte> rows = reader.items(buffer, place.first, place.bodies);
    hash = hash_bytes(rows.data(), rows.size(), hash);
  }
  return hash;
}

const std::vector<std::byte> &bytes_in(const std::vector<WorldRow> &rows, Buffer buffer)
{
  static const std::vector<std::byte> none;
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const WorldRow &row) { return row.buffer == buffer; });
  return found == rows.end() ? none : found->bytes;
}

template <class T> std::vector<T> items_in(const std::vector<WorldRow> &rows, Buffer buffer)
{
  const std::vector<std::byte> &bytes = bytes_in(rows, buffer);
  std::vector<T> items(bytes.size() / sizeof(T));
  std::copy_n(bytes.data(), items.size() * sizeof(T), reinterpret_cast<std::byte *>(items.data()));
  return items;
}

std::vector<float4> impulses_in(const std::vector<WorldRow> &rows)
{
  return impulse_rows(items_in<float>(rows, Buffer::cached_single_impulse),
                      items_in<float4>(rows, Buffer::cached_normal_impulse));
}

uint64_t hash_rows(const std::vector<float4> &rows, uint64_t hash)
{
  return hash_bytes(rows.data(), rows.size() * sizeof(float4), hash);
}

/* In place of the features that pairs of single points do not have, as hash_carried has it. */
uint64_t hash_zeros(size_t bytes, uint64_t hash)
{
  const std::vector<std::byte> zeros(bytes);
  return hash_bytes(zeros.data(), zeros.size(), hash);
}

/* A world whose pairs have single points keeps their impulses as such, whatever others have brought into the batch. */
void keep_single_impulses(std::vector<WorldRow> &rows)
{
  const std::vector<float4> impulses = impulses_in(rows);
  for (WorldRow &row : rows)
    if (row.buffer == Buffer::cached_single_impulse)
      for (size_t i = 0; i < impulses.size(); ++i)
        std::copy_n(reinterpret_cast<const std::byte *>(&impulses[i].x), sizeof(float), &row.bytes[i * sizeof(float)]);
}

} // namespace

/* Whether the world alone would have the buffer: others may have brought it in. */
bool Worlds::Group::has_alone(uint32_t number, Buffer buffer) const
{
  const Features feature = row_of(buffer).feature;
  if (buffer == Buffer::body_force) return forced[number];
  return feature == 0 || (feature & features[number]) != 0;
}

std::vector<Quarantine> Worlds::Group::quarantined(uint32_t number) const
{
  std::vector<Quarantine> own;
  for (Quarantine taken : engine().quarantined) {
    if (taken.body / bodies != number) continue;
    taken.body -= number * bodies;
    taken.step -= started[number];
    own.push_back(std::move(taken));
  }
  return own;
}

uint64_t Worlds::Group::state_hash(WorldReader &reader, uint32_t number, std::span<const Quarantine> own)
{
  uint64_t hash = 0;
  const std::vector<WorldRow> rows = reader.rows_of(place_of(number));
  for (const WorldRow &row : rows) {
    if (row.buffer == Buffer::cached_color && !has_alone(number, Buffer::cached_feature))
      hash = hash_zeros(row.bytes.size(), hash);
    if (row.buffer == Buffer::cached_single_impulse) hash = hash_rows(impulses_in(rows), hash);
    else if (row.buffer != Buffer::cached_normal_impulse && has_alone(number, row.buffer))
      hash = hash_bytes(row.bytes.data(), row.bytes.size(), hash);
  }
  for (const Quarantine &taken : own) hash = hash_bytes(&taken.body, sizeof taken.body, hash);
  return hash;
}

std::unique_ptr<World::Implementation> Worlds::Group::alone(uint32_t number, const Placement &placement)
{
  const minicl::ExactFloatingPoint environment;
  engine().settle();
  WorldReader reader(engine().memory, engine().buffers.carried(), false);
  std::vector<WorldRow> rows = reader.rows_of(place_of(number));
  if (settings.specialise && !has_alone(number, Buffer::cached_normal_impulse)) keep_single_impulses(rows);
  SnapshotContents contents;
  contents.settings = settings;
  contents.scene = scene(number);
  contents.special = specialise(contents.scene, settings);
  contents.special.features = features[number];
  contents.slots = BodySlots(bodies);
  contents.joint_slots = JointSlots(contents.scene.joints.size());
  contents.quarantined = quarantined(number);
  for (const Quarantine &taken : contents.quarantined) contents.slots.quarantine(taken.body);
  contents.room = bodies;
  contents.forces = forced[number];
  contents.substeps = engine().plan.substeps;
  contents.steps = steps(number);
  for (const auto &[buffer, bytes] : rows) {
    const bool runs_all = !settings.specialise && buffer != Buffer::body_force;
    if (runs_all || has_alone(number, buffer)) contents.buffers.push_back({buffer, bytes});
    if (buffer == Buffer::cached_b) contents.pairs = static_cast<uint32_t>(bytes.size() / sizeof(uint32_t));
  }
  return World::Implementation::made_of(std::move(contents), {}, placement, nullptr);
}

uint64_t Worlds::Group::body_hash(uint32_t number)
{
  engine().settle();
  WorldReader reader(engine().memory, engine().buffers.carried(), false);
  return hash_of_bodies(reader, place_of(number));
}

std::vector<uint64_t> Worlds::Group::body_hashes()
{
  engine().settle();
  WorldReader reader(engine().memory, engine().buffers.carried(), true);
  std::vector<uint64_t> hashes;
  for (uint32_t number = 0; number < count(); ++number) hashes.push_back(hash_of_bodies(reader, place_of(number)));
  return hashes;
}

uint64_t Worlds::Group::state_hash(uint32_t number)
{
  engine().settle();
  WorldReader reader(engine().memory, engine().buffers.carried(), false);
  return state_hash(reader, number, quarantined(number));
}

std::vector<uint64_t> Worlds::Group::state_hashes()
{
  engine().settle();
  WorldReader reader(engine().memory, engine().buffers.carried(), true);
  std::vector<std::vector<Quarantine>> taken(count());
  for (Quarantine one : engine().quarantined) {
    const uint32_t number = one.body / bodies;
    one.body -= number * bodies;
    taken[number].push_back(std::move(one));
  }
  std::vector<uint64_t> hashes;
  for (uint32_t number = 0; number < count(); ++number) hashes.push_back(state_hash(reader, number, taken[number]));
  return hashes;
}

} // namespace tandem
