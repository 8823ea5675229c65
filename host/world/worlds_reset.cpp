/* worlds_reset.cpp - what a batch uploads of its worlds, their gravity, and worlds that begin anew. */
#include <algorithm>

#include <fmt/format.h>

#include "host/base/finite_vector.h"
#include "host/pipeline/scene_counts.h"
#include "host/runtime/interface/floating_point.h"
#include "host/world/worlds.h"

namespace tandem {
namespace {

/* With the number of the body within its world: shared/records.h. */
float4 row_of_gravity(const Vec3 &v, uint32_t number)
{
  return {v[0], v[1], v[2], round_to_float(static_cast<double>(number))};
}

/* Above so many worlds their gravity is uploaded at once: each transfer takes as long as some thousands of rows. */
constexpr size_t few_worlds = 16;

} // namespace

void Worlds::Implementation::upload_batch()
{
  const std::vector<uint32_t> &order = engine().special.order;
  std::vector<uint32_t> ranges;
  for (uint32_t index = 0; index < order.size(); ++index)
    ranges.insert(ranges.end(), {index / bodies * bodies, index / bodies * bodies + bodies});
  StagedUploads uploads;
  uploads.add(Buffer::body_world, std::move(ranges));
  stage_starts(uploads, engine().scene, order);
  uploads.write(engine().memory);
  upload_gravity(0, tables.worlds());
}

/* A body that cannot move starts without a velocity. */
void Worlds::Implementation::upload_starts(std::span<const BodyId> changed)
{
  StagedUploads uploads;
  for (const BodyId &id : changed)
    stage_starts(uploads, engine().scene, std::span(&id.index, 1), engine().index_of_body[id.index]);
  uploads.write(engine().memory);
}

void Worlds::Implementation::upload_gravity(uint32_t first, uint32_t count)
{
  std::vector<float4> rows;
  rows.reserve(size_t{count} * bodies);
  for (uint32_t world = first; world < first + count; ++world)
    for (uint32_t number = 0; number < bodies; ++number) rows.push_back(row_of_gravity(gravity[world], number));
  if (!rows.empty())
    engine().memory.upload(Buffer::body_gravity, rows.data(), rows.size() * sizeof(float4),
                           size_t{first} * bodies * sizeof(float4));
}

void Worlds::set_gravity(std::span<const uint32_t> worlds, std::span<const Vec3> gravity)
{
  if (worlds.size() != gravity.size())
    throw InputError(fmt::format("set_gravity: {} worlds and {} entries; one entry for each world is needed",
                                 worlds.size(), gravity.size()));
  for (size_t i = 0; i < worlds.size(); ++i) {
    implementation_->check_world("set_gravity", worlds[i]);
    if (!is_finite_vector(gravity[i]))
      throw InputError(fmt::format("set_gravity: entry {}: gravity is {}; three finite numbers are needed", i,
                                   vector_text(gravity[i])));
  }
  for (size_t i = 0; i < worlds.size(); ++i) implementation_->gravity[worlds[i]] = gravity[i];
  if (worlds.size() > few_worlds) return implementation_->upload_gravity(0, count());
  for (const uint32_t world : worlds) implementation_->upload_gravity(world, 1);
}

void Worlds::Implementation::reset(std::span<const uint32_t> given)
{
  std::vector<uint32_t> numbers(given.begin(), given.end());
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  World::Implementation &all = engine();
  all.settle();
  all.buffers.make_ready(all.sizes());
  ++all.state;
  mend(numbers);
  take_out_of_quarantine(numbers);
  if (!numbers.empty() && bodies > 0) launch_reset(numbers);
  for (const uint32_t number : numbers) {
    started[number] = entered[number] = all.statistics.steps;
    if (changed[number]) features[number] = features_of(scene(number), settings);
    changed[number] = false;
    forced[number] = false;
  }
}

/* Bodies in quarantine are fixed and have lost their mass; they get all their rows again. */
void Worlds::Implementation::take_out_of_quarantine(std::span<const uint32_t> numbers)
{
  World::Implementation &all = engine();
  const auto begins_anew = [&](const Quarantine &taken) {
    return std::binary_search(numbers.begin(), numbers.end(), taken.body / bodies);
  };
  StagedUploads uploads;
  for (const Quarantine &taken : all.quarantined) {
    if (!begins_anew(taken)) continue;
    const uint32_t index = all.index_of_body[taken.body];
    all.slots.release(taken.body);
    if (all.scene.bodies[taken.body].type == BodyType::dynamic) ++all.awake_dynamics;
    --all.statistics.nonfinite;
    stage_states(uploads, all.scene, std::span(&taken.body, 1), index);
    stage_properties(uploads, all.scene, std::span(&taken.body, 1), index, all.slots.status());
  }
  uploads.write(all.memory);
  if (std::erase_if(all.quarantined, begins_anew) > 0) all.tell_articulations();
}

namespace {

/* Uploads a list of the host, over which the next launches run. */
void upload_list(Memory &memory, Buffer buffer, const std::vector<uint32_t> &list, uint32_t items)
{
  const size_t bytes = list.size() * sizeof(uint32_t);
  if (memory.bytes(buffer) < bytes) memory.resize(buffer, bytes + bytes / 2);
  memory.upload(buffer, list.data(), bytes);
  set_length(memory, items);
}

} // namespace

void Worlds::Implementation::launch_reset(std::span<const uint32_t> numbers)
{
  World::Implementation &all = engine();
  std::vector<uint32_t> firsts;
  for (const uint32_t number : numbers) firsts.push_back(number * bodies);
  const auto items = static_cast<uint32_t>(firsts.size()) * bodies;
  upload_list(all.memory, Buffer::reset_world, firsts, items);
  const auto launch = [&](Kernel kernel, const Slots &slots = {}) {
    all.launcher.launch({kernel, slots, {bodies}, COUNT_ZERO, COUNT_LENGTH, items});
  };
  launch(Kernel::reset_worlds);
  if (settings.events) launch(Kernel::reset_touching);
  if (all.plan.forces) launch(Kernel::reset_forces, {Buffer::body_force});
  if (all.memory.bytes(Buffer::body_joint_force) > 0) launch(Kernel::reset_forces, {Buffer::body_joint_force});
  launch_reset_of_joints(numbers);
}

void Worlds::Implementation::launch_reset_of_joints(std::span<const uint32_t> numbers)
{
  std::vector<uint32_t> places, coupled;
  for (const uint32_t number : numbers) {
    const JointPlaces own = present_joints().of(number);
    places.insert(places.end(), own.places.begin(), own.places.end());
    coupled.insert(coupled.end(), own.couplings.begin(), own.couplings.end());
  }
  launch_reset_of(places, Buffer::reset_joint, Kernel::reset_joints);
  launch_reset_of(coupled, Buffer::reset_coupling, Kernel::reset_couplings);
}

void Worlds::Implementation::launch_reset_of(std::span<const uint32_t> rows, Buffer list, Kernel kernel)
{
  if (rows.empty()) return;
  const auto items = static_cast<uint32_t>(rows.size());
  upload_list(engine().memory, list, {rows.begin(), rows.end()}, items);
  engine().launcher.launch({kernel, {}, {}, COUNT_ZERO, COUNT_LENGTH, items});
}

} // namespace tandem
