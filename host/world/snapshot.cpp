/* snapshot.cpp - writes worlds as bytes, and checks such bytes; see snapshot.h. */
#include "host/world/snapshot.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "host/runtime/interface/module.h"
#include "host/runtime/parts.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"
#include "host/world/implementation.h"
#include "host/world/snapshot_fields.h"
#include "host/world/snapshot_scene.h"
#include "shared/batching/limits.h"

namespace tandem {

template <Is<BodySlots::Slot> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[generation] = record;
  return visit(generation);
}

template <Is<JointSlots::Slot> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[generation, exists] = record;
  return visit(generation, exists);
}

template <Is<ShapeSlots::Slot> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[generation, exists, body] = record;
  return visit(generation, exists, body);
}

template <Is<SleepingPair> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[a, b, words] = record;
  return visit(a, b, words);
}

template <Is<SleepingIsland> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[bodies, pairs] = record;
  return visit(bodies, pairs);
}

template <Is<SubstepChoice> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[automatic, starts, now, of_cache, calm_steps, layers_at_start] = record;
  return visit(automatic, starts, now, of_cache, calm_steps, layers_at_start);
}

template <Is<SleepEvent> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[body, asleep] = record;
  return visit(body, asleep);
}

template <Is<BodySlots::Free> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[slot, since] = record;
  return visit(slot, since);
}

namespace {

/* By name, because the bits of features have other places in other versions. */
std::vector<std::string> names_of(Features features)
{
  std::vector<std::string> names;
  for (int index = 0; index < FEATURE_COUNT; ++index)
    if (features & feature_of_index(index)) names.emplace_back(feature_rows[index].name);
  return names;
}

Features get_features(ByteReader &reader)
{
  Features features = 0;
  for (const std::string &name : reader.get<std::vector<std::string>>()) {
    const auto known = std::find_if(std::begin(feature_rows), std::end(feature_rows),
                                    [&](const FeatureRow &row) { return row.name == name; });
    if (known == std::end(feature_rows)) reader.fail("it needs a feature that this library does not have");
    features |= known->feature;
  }
  return features;
}

/* Half-spaces first, then at most so many large bodies as the kernels can test; each body once. */
void check_order(const ByteReader &reader, const Scene &scene, const Specialisation &special)
{
  const size_t bodies = scene.bodies.size();
  std::vector<bool> seen(bodies);
  if (special.order.size() != bodies)
    reader.fail(
        fmt::format("the order of the bodies has {} entries; there are {} bodies", special.order.size(), bodies));
  for (const uint32_t body : special.order) {
    if (body >= bodies || seen[body]) reader.fail("the order of the bodies does not hold each of them once");
    seen[body] = true;
  }
  if (special.unbounded > special.large || special.large > special.awake || special.awake > bodies ||
      special.large - special.unbounded > most_large_bodies)
    reader.fail(fmt::format("{} half-spaces, {} bodies with the large ones and {} with those awake, of {}",
                            special.unbounded, special.large, special.awake, bodies));
  for (uint32_t index = 0; index < bodies; ++index)
    if ((scene.shapes[scene.bodies[special.order[index]].shape].type == ShapeType::half_space) !=
        (index < special.unbounded))
      reader.fail("half-spaces are not the first bodies in the buffers");
  if (!(special.median >= 0) || !std::isfinite(special.median)) reader.fail("the median size of the bodies is no size");
}

/* A damaged number must not become as many launches. */
void check_substeps(const ByteReader &reader, const SnapshotContents &contents)
{
  const SubstepChoice &choice = contents.substeps;
  const SubstepChoice first = first_choice(contents.settings);
  const uint32_t most = choice.automatic ? most_substeps(contents.settings) : first.now;
  const auto is_allowed = [&](uint32_t substeps) { /* they are doubled and halved */
                                                   return substeps >= first.now && substeps <= most &&
                                                          substeps % first.now == 0 &&
                                                          std::has_single_bit(substeps / first.now);
  };
  if (choice.automatic != first.automatic || !is_allowed(choice.now) || !is_allowed(choice.of_cache))
    reader.fail(fmt::format("{} substeps after {}, of a world that takes {} to {}", choice.now, choice.of_cache,
                            first.now, most));
}

Specialisation get_special(ByteReader &reader, const Scene &scene)
{
  Specialisation special;
  special.features = get_features(reader);
  reader.get(special.order);
  reader.get(special.unbounded);
  reader.get(special.large);
  reader.get(special.awake);
  reader.get(special.median);
  check_order(reader, scene, special);
  return special;
}

void put_special(ByteWriter &writer, const Specialisation &special, Features needed)
{
  const auto &[features, order, unbounded, large, awake, median, worlds] = special;
  writer.put(names_of(needed));
  writer.put(order);
  writer.put(unbounded);
  writer.put(large);
  writer.put(awake);
  writer.put(median);
  static_cast<void>(features); /* follow from those needed and Settings::specialise */
  static_cast<void>(worlds);   /* a batch has snapshots of its worlds alone */
}

BodyRegion region_at(const Specialisation &special, uint32_t index)
{
  return index < special.unbounded ? BodyRegion::half_spaces
         : index < special.large   ? BodyRegion::large
                                   : BodyRegion::small;
}

/* A free slot waits in the queue of its region, once, unless its generations are used up. */
void check_slots(const ByteReader &reader, const Specialisation &special, const std::vector<BodySlots::Slot> &slots,
                 const std::vector<BodyStatus> &status, const BodySlots::Queues &queues)
{
  const size_t bodies = special.order.size();
  if (slots.size() != bodies || status.size() != bodies)
    reader.fail(fmt::format("{} generations and {} states of {} bodies", slots.size(), status.size(), bodies));
  for (const BodyStatus one : status)
    if (one > BodyStatus::free) reader.fail("the state of a body is none that bodies have");
  for (const BodySlots::Slot &slot : slots)
    if (slot.generation == 0) reader.fail("a body has generation 0; generations begin with 1");
  std::vector<uint32_t> index_of(bodies);
  for (uint32_t index = 0; index < bodies; ++index) index_of[special.order[index]] = index;
  std::vector<bool> queued(bodies);
  for (size_t region = 0; region < queues.size(); ++region)
    for (const auto &[slot, since] : queues[region]) {
      const bool fits = slot < bodies && status[slot] == BodyStatus::free && !queued[slot] &&
                        region_at(special, index_of[slot]) == static_cast<BodyRegion>(region);
      if (!fits) reader.fail("a queue of free slots holds a slot that is not free, or of another queue");
      queued[slot] = true;
    }
}

BodySlots get_slots(ByteReader &reader, const Specialisation &special)
{
  auto slots = reader.get<std::vector<BodySlots::Slot>>();
  auto status = reader.get<std::vector<BodyStatus>>();
  auto queues = reader.get<BodySlots::Queues>();
  check_slots(reader, special, slots, status, queues);
  return {std::move(slots), std::move(status), std::move(queues)};
}

/* A free slot holds no joint, and waits in the queue once, unless its generations are used up. */
JointSlots get_joint_slots(ByteReader &reader, const Scene &scene)
{
  auto slots = reader.get<std::vector<JointSlots::Slot>>();
  auto queue = reader.get<std::vector<uint32_t>>();
  if (slots.size() != scene.joints.size())
    reader.fail(fmt::format("{} generations of {} joints", slots.size(), scene.joints.size()));
  std::vector<bool> queued(slots.size());
  for (size_t k = 0; k < slots.size(); ++k) {
    if (slots[k].generation == 0) reader.fail("a joint has generation 0; generations begin with 1");
    if (!slots[k].exists && !is_vacant(scene.joints[k])) reader.fail("a joint that was destroyed has a body");
  }
  for (const uint32_t slot : queue) {
    if (slot >= slots.size() || slots[slot].exists || queued[slot])
      reader.fail("the queue of free joints holds one that is not free");
    queued[slot] = true;
  }
  return {std::move(slots), std::move(queue)};
}

/* Each handle names its body's slot, whose queue holds the slots of no body. */
void check_shapes(const ByteReader &reader, const SnapshotContents &contents)
{
  const ShapeSlots &shapes = contents.shapes;
  std::vector<bool> named(shapes.slots().size());
  for (const auto &[body, handles] : shapes.handles())
    for (const ShapeId &id : handles) {
      const bool fits = body < contents.scene.bodies.size() && id.index < named.size() && !named[id.index] &&
                        shapes.slots()[id.index].exists && shapes.slots()[id.index].body.index == body;
      if (!fits) reader.fail("the handle of a shape belongs to no body, or to several");
      named[id.index] = true;
    }
  for (const uint32_t slot : shapes.queue()) {
    if (slot >= named.size() || named[slot] || shapes.slots()[slot].exists)
      reader.fail("the queue of free handles of shapes holds one that is not free");
    named[slot] = true;
  }
  for (const uint32_t shape : contents.made_shapes)
    if (shape >= contents.scene.shapes.size()) reader.fail("a shape of one body alone does not exist");
}

/* Each body behind those awake belongs to one island, and is dynamic. */
void check_islands(const ByteReader &reader, const SnapshotContents &contents)
{
  const std::vector<uint32_t> &order = contents.special.order;
  std::vector<bool> asleep(order.size());
  size_t found = 0;
  for (const SleepingIsland &island : contents.islands) {
    for (const uint32_t slot : island.bodies) {
      const bool fits = slot < order.size() && !asleep[slot] && contents.scene.bodies[slot].type == BodyType::dynamic &&
                        contents.slots.status()[slot] == BodyStatus::present;
      if (!fits) reader.fail("an island that sleeps has a body that cannot, or has it twice");
      asleep[slot] = true;
      ++found;
    }
    for (const SleepingPair &pair : island.pairs)
      if (pair.a >= order.size() || pair.b >= order.size() || pair.a == pair.b)
        reader.fail("an island that sleeps touches a body that does not exist");
  }
  if (found != order.size() - contents.special.awake) reader.fail("the islands that sleep do not have all sleepers");
  for (size_t index = contents.special.awake; index < order.size(); ++index)
    if (!asleep[order[index]]) reader.fail("a body lies among the sleepers and is in no island");
}

/* A list of handles for each body that has some. */
struct HandlesOfBody {
  uint32_t body = 0;
  std::vector<ShapeId> handles;
};

template <Is<HandlesOfBody> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[body, handles] = record;
  return visit(body, handles);
}

void put_shapes(ByteWriter &writer, const ShapeSlots &shapes, const std::set<uint32_t> &made)
{
  std::vector<HandlesOfBody> handles;
  for (const auto &[body, list] : shapes.handles()) handles.push_back({body, list});
  writer.put(shapes.slots());
  writer.put(shapes.queue());
  writer.put(handles);
  writer.put(std::vector<uint32_t>(made.begin(), made.end()));
}

void get_shapes(ByteReader &reader, SnapshotContents &contents)
{
  auto slots = reader.get<std::vector<ShapeSlots::Slot>>();
  auto queue = reader.get<std::vector<uint32_t>>();
  ShapeSlots::Handles handles;
  for (HandlesOfBody &one : reader.get<std::vector<HandlesOfBody>>()) handles[one.body] = std::move(one.handles);
  contents.shapes = {std::move(slots), std::move(queue), std::move(handles)};
  reader.get(contents.made_shapes);
  check_shapes(reader, contents);
}

std::vector<uint32_t> words_in(std::span<const std::byte> bytes)
{
  std::vector<uint32_t> words(bytes.size() / sizeof(uint32_t));
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), words.size() * sizeof(uint32_t));
  return words;
}

/* The starts of the cached pairs of each body: kernels index the cache with them. Returns the number of pairs. */
uint32_t check_starts(const ByteReader &reader, std::span<const std::byte> bytes)
{
  const std::vector<uint32_t> starts = words_in(bytes);
  if (starts.empty() || starts.front() != 0 || !std::is_sorted(starts.begin(), starts.end()) ||
      starts.back() > most_pairs)
    reader.fail("the starts of the cached pairs do not increase from 0");
  return starts.back();
}

/* The second bodies of the cached pairs. */
void check_partners(const ByteReader &reader, std::span<const std::byte> bytes, size_t bodies)
{
  for (const uint32_t body : words_in(bytes))
    if (body >= bodies) reader.fail(fmt::format("a cached pair has body {}, of {} bodies", body, bodies));
}

/* One by name, as it was written: the record of its row, and its bytes. */
SavedBuffer get_buffer(ByteReader &reader)
{
  const auto name = reader.get<std::string>();
  const auto item = reader.get<uint64_t>();
  const std::optional<Buffer> buffer = find_buffer(name);
  if (!buffer) reader.fail("it holds a buffer that this library does not have");
  if (item != item_bytes(*buffer))
    reader.fail(fmt::format("buffer {} has items of {} bytes; here they have {}", name, item, item_bytes(*buffer)));
  return {*buffer, reader.take(reader.get<uint64_t>())};
}

/* Carried buffers that follow the bodies and the cached pairs have just as many items. */
void check_sizes(const ByteReader &reader, const SnapshotContents &contents)
{
  const auto bodies = static_cast<uint32_t>(contents.scene.bodies.size());
  const size_t joints = contents.scene.joints.size();
  const uint32_t axes = most_axes_of_joint(contents.scene);
  for (const auto &[buffer, bytes] : contents.buffers) {
    const BufferRow &row = row_of(buffer);
    uint64_t items = bytes.size() / item_bytes(buffer);
    if (!is_carried(row.lifetime) && bytes.size() == items * item_bytes(buffer)) continue;
    if (row.capacity == Capacity::BODIES) items = bodies;
    if (row.capacity == Capacity::BODIES_PLUS_ONE) items = uint64_t{contents.special.awake} + 1;
    if (row.capacity == Capacity::PAIRS) items = contents.pairs;
    if (row.capacity == Capacity::JOINTS) items = joints;
    if (row.capacity == Capacity::JOINT_AXES) items = uint64_t{joints} * axes;
    if (row.capacity == Capacity::COUPLINGS) items = contents.scene.couplings.size();
    if (bytes.size() != items * item_bytes(buffer))
      reader.fail(fmt::format("buffer {} has {} bytes; {} items need {}", row.name, bytes.size(), items,
                              items * item_bytes(buffer)));
  }
}

void get_buffers(ByteReader &reader, SnapshotContents &contents)
{
  const auto count = reader.get<uint64_t>();
  std::vector<bool> seen(all_buffers());
  for (uint64_t k = 0; k < count; ++k) {
    contents.buffers.push_back(get_buffer(reader));
    const SavedBuffer &saved = contents.buffers.back();
    if (seen[index_of(saved.buffer)]) reader.fail(fmt::format("buffer {} occurs twice", row_of(saved.buffer).name));
    seen[index_of(saved.buffer)] = true;
    if (saved.buffer == Buffer::cached_start && !saved.bytes.empty())
      contents.pairs = check_starts(reader, saved.bytes);
    if (saved.buffer == Buffer::cached_b) check_partners(reader, saved.bytes, contents.scene.bodies.size());
  }
  check_sizes(reader, contents);
}

void check_history(const ByteReader &reader, const SnapshotContents &contents)
{
  for (const Quarantine &taken : contents.quarantined)
    if (taken.body >= contents.scene.bodies.size()) reader.fail("a body that was quarantined does not exist");
  if (contents.room < contents.scene.bodies.size() || contents.room > 2 * contents.scene.bodies.size() + 64)
    reader.fail(fmt::format("room for {} bodies, of which there are {}", contents.room, contents.scene.bodies.size()));
}

void get_settings(ByteReader &reader, Settings &settings)
{
  reader.get(settings);
  try {
    validate(settings);
  } catch (const InputError &error) {
    reader.fail(error.what());
  }
}

} // namespace

SnapshotContents read_snapshot(std::span<const std::byte> bytes, const std::string &where)
{
  ByteReader reader(unseal(bytes, snapshot_kind, where, run_parts), where, seal_bytes, run_parts);
  SnapshotContents contents;
  reader.get(contents.modules);
  get_settings(reader, contents.settings);
  contents.scene = get_scene(reader);
  contents.special = get_special(reader, contents.scene);
  contents.slots = get_slots(reader, contents.special);
  contents.joint_slots = get_joint_slots(reader, contents.scene);
  get_shapes(reader, contents);
  const auto islands = reader.get<uint64_t>(); /* one after the other: they are no list where they are written from */
  for (uint64_t k = 0; k < islands; ++k) reader.get(contents.islands.emplace_back());
  check_islands(reader, contents);
  reader.get(contents.joint_order);
  reader.get(contents.room);
  reader.get(contents.forces);
  reader.get(contents.drowsy);
  reader.get(contents.substeps);
  check_substeps(reader, contents);
  reader.get(contents.sleep_events);
  reader.get(contents.steps);
  reader.get(contents.overflow);
  reader.get(contents.quarantined);
  reader.get(contents.fault);
  check_history(reader, contents);
  get_buffers(reader, contents);
  reader.expect_end();
  return contents;
}

/* Scenes' buffers of the pipeline are made of the scene again. What a module keeps may be lost, but for buffers that
 * exist only once they have been written. */
bool World::Implementation::is_saved(Buffer buffer) const
{
  const Lifetime lifetime = row_of(buffer).lifetime;
  if (memory.bytes(buffer) == 0) return false;
  if (index_of(buffer) < buffer_count) return false; /* among the carried ones, where it is */
  return lifetime == Lifetime::SCENE || (lifetime == Lifetime::KEPT && is_sized_by_writes(buffer));
}

void World::Implementation::put_history(ByteWriter &writer) const
{
  writer.put(plan.bodies);
  writer.put(plan.forces);
  writer.put(plan.drowsy);
  writer.put(plan.substeps);
  writer.put(sleep_events_to_come);
  writer.put(statistics.steps);
  writer.put(statistics.overflow);
  writer.put(quarantined);
  writer.put(fault);
}

void World::Implementation::put_buffers(ByteWriter &writer)
{
  const uint32_t pairs = memory.read<uint32_t>(Buffer::cached_start, 1, special.awake).front();
  std::vector<std::pair<Buffer, size_t>> saved;
  for (const CarriedBuffer &carried : buffers.carried())
    if (memory.bytes(carried.now) > 0)
      saved.emplace_back(carried.now,
                         items_in_use(memory, carried.now, {bodies(), special.awake}, pairs) * item_bytes(carried.now));
  for (size_t i = buffer_count; i < buffers.needs().touched.size(); ++i)
    if (is_saved(buffer_at(i))) saved.emplace_back(buffer_at(i), memory.bytes(buffer_at(i)));
  size_t total = 0;
  for (const auto &[buffer, bytes] : saved) total += bytes + 128;
  writer.reserve(writer.size() + total);
  writer.put(uint64_t{saved.size()});
  for (const auto &[buffer, bytes] : saved) {
    writer.put(std::string(row_of(buffer).name));
    writer.put(uint64_t{item_bytes(buffer)});
    writer.put(uint64_t{bytes});
    memory.download(buffer, writer.extend(bytes), bytes);
  }
}

std::vector<std::byte> World::Implementation::save(std::vector<std::byte> memory)
{
  settle();
  ByteWriter writer(std::move(memory), run_parts);
  begin_sealed(writer);
  std::vector<std::string> modules;
  for (const Extension &extension : settings.extensions) modules.emplace_back(extension.module->name());
  writer.put(modules);
  Settings asked = settings;
  if (chooses)
    asked.broadphase = Broadphase::automatic; /* another backend, or another number of bodies, chooses anew */
  writer.put(asked);
  put_scene(writer, scene);
  put_special(writer, special, scene_features);
  writer.put(slots.slots());
  writer.put(slots.status());
  writer.put(slots.queues());
  writer.put(joint_slots.slots());
  writer.put(joint_slots.queue());
  put_shapes(writer, shapes, made_shapes);
  writer.put(uint64_t{sleepers.islands()});
  for (const auto &[number, island] : sleepers.all()) writer.put(island);
  const std::span<const uint32_t> joints = sleepers.empty() ? std::span<const uint32_t>{} : joint_order.joints();
  writer.put(std::vector<uint32_t>(joints.begin(), joints.end()));
  put_history(writer);
  put_buffers(writer);
  return seal(writer, snapshot_kind, run_parts);
}

} // namespace tandem
