/* worlds_reset.cpp - what a batch uploads of its worlds, their gravity, and worlds that begin anew. */
#include <algorithm>

#include <fmt/format.h>

#include "host/base/finite_vector.h"
#include "host/pipeline/scene_counts.h"
#include "host/runtime/interface/floating_point.h"
#include "host/world/worlds_group.h"

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

void Worlds::Group::upload_batch()
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
void Worlds::Group::upload_starts(std::span<const BodyId> changed)
{
  StagedUploads uploads;
  for (const BodyId &id : changed)
    stage_starts(uploads, engine().scene, std::span(&id.index, 1), engine().index_of_body[id.index]);
  uploads.write(engine().memory);
}

void Worlds::Group::upload_gravity(uint32_t first, uint32_t count)
{
  std::vector<float4> rows;
  rows.reserve(size_t{count} * bodies);
  for (uint32_t world = first; world < first + count; ++world)
    for (uint32_t number = 0; number < bodies; ++number) rows.push_back(row_of_gravity(gravity[world], number));
  if (!rows.empty())
    engine().memory.upload(Buffer::body_gravity, rows.data(), rows.size() * sizeof(float4),
                           size_t{first} * bodies * sizeof(float4));
}

void Worlds::Group::set_gravity(std::span<const uint32_t> numbers, std::span<const Vec3> values)
{
  for (size_t i = 0; i < numbers.size(); ++i) gravity[numbers[i]] = values[i];
  if (numbers.size() > few_worlds) return upload_gravity(0, count());
  for (const uint32_t number : numbers) upload_gravity(number, 1);
}

namespace {

/* For a list of the host, over which launches of a reset run. */
void make_room(Memory &memory, Buffer buffer, size_t entries)
{
  if (entries == 0) return;
  memory.grow(buffer, entries * sizeof(uint32_t));
  memory.prepare_upload(buffer);
}

} // namespace

/* Joints that are mended may lay out buffers anew, after which there is room again. */
void Worlds::Group::prepare_reset(std::span<const uint32_t> numbers)
{
  World::Implementation &all = engine();
  all.settle();
  all.buffers.make_ready(all.sizes());
  size_t joints_of_all = 0;
  for (const uint32_t number : numbers) joints_of_all += tables.joints(number);
  const auto make_room_for_lists = [&] {
    make_room(all.memory, Buffer::reset_world, numbers.size());
    make_room(all.memory, Buffer::reset_joint, joints_of_all);
    make_room(all.memory, Buffer::reset_coupling, all.scene.couplings.size());
  };
  make_room_for_lists();
  mend(numbers);
  make_room_for_lists();
  resetting = {};
  for (const uint32_t number : numbers) {
    const JointPlaces own = present_joints().of(number);
    resetting.firsts.push_back(number * bodies);
    resetting.joints.insert(resetting.joints.end(), own.places.begin(), own.places.end());
    resetting.couplings.insert(resetting.couplings.end(), own.couplings.begin(), own.couplings.end());
  }
}

void Worlds::Group::reset(std::span<const uint32_t> numbers)
{
  ++engine().state;
  take_out_of_quarantine(numbers);
  if (!numbers.empty() && bodies > 0) launch_reset();
  for (const uint32_t number : numbers) {
    started[number] = entered[number] = engine().statistics.steps;
    if (changed[number]) features[number] = features_of(scene(number), settings);
    changed[number] = false;
    forced[number] = false;
  }
}

/* Bodies in quarantine are fixed and have lost their mass; they get all their rows again. */
void Worlds::Group::take_out_of_quarantine(std::span<const uint32_t> numbers)
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

void Worlds::Group::launch_reset()
{
  World::Implementation &all = engine();
  const auto items = static_cast<uint32_t>(resetting.firsts.size()) * bodies;
  upload_for_reset(Buffer::reset_world, resetting.firsts, items);
  const auto launch = [&](Kernel kernel, const Slots &slots = {}) {
    all.launcher.launch({kernel, slots, {bodies}, COUNT_ZERO, COUNT_LENGTH, items});
  };
  launch(Kernel::reset_worlds);
  if (settings.events) launch(Kernel::reset_touching);
  if (all.plan.forces) launch(Kernel::reset_forces, {Buffer::body_force});
  if (all.memory.bytes(Buffer::body_joint_force) > 0) launch(Kernel::reset_forces, {Buffer::body_joint_force});
  launch_reset_of(resetting.joints, Buffer::reset_joint, Kernel::reset_joints);
  launch_reset_of(resetting.couplings, Buffer::reset_coupling, Kernel::reset_couplings);
}

void Worlds::Group::launch_reset_of(const std::vector<uint32_t> &rows, Buffer list, Kernel kernel)
{
  if (rows.empty()) return;
  const auto items = static_cast<uint32_t>(rows.size());
  upload_for_reset(list, rows, items);
  engine().launcher.launch({kernel, {}, {}, COUNT_ZERO, COUNT_LENGTH, items});
}

/* The next launches run over so many items. */
void Worlds::Group::upload_for_reset(Buffer buffer, const std::vector<uint32_t> &list, uint32_t items)
{
  engine().memory.upload(buffer, list.data(), list.size() * sizeof(uint32_t));
  set_length(engine().memory, items);
}

} // namespace tandem
