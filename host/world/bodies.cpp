/* bodies.cpp - bodies that are created and destroyed while a world runs.
 *
 * The body buffers have room for plan.bodies bodies, of which bodies() are in use:
 *
 *   | half-spaces | large | small bodies, with free slots among them | room |
 *
 * A small body takes a free slot or the next place behind the last one: its rows alone are written. A half-space or a
 * large body is inserted among its own kind, which moves those behind it; their order stays, so the sorted lists of the
 * contact cache stay sorted. Room grows by doubling. Inserting, growing, new shapes, materials and features lay the
 * buffers out anew; a call that does none of this writes a few rows.
 *
 * Whatever can fail for lack of memory comes before the first change of the world.
 */
#include <algorithm>
#include <optional>
#include <set>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/scene_counts.h"
#include "host/pipeline/setting_rows.h"
#include "host/runtime/interface/floating_point.h"
#include "host/runtime/interface/module.h"
#include "host/scene/built.h"
#include "host/world/contact_events.h"
#include "host/world/implementation.h"
#include "host/world/placed_bodies.h"
#include "host/world/reordered_rows.h"

namespace tandem {

constexpr size_t regions = 3;

/* What a call of create() will do. */
struct World::Implementation::Arrival {
  std::vector<uint32_t> slots;                         /* of the new bodies, in their order */
  std::array<size_t, regions> again{};                 /* how many free slots of each region are used */
  std::array<std::vector<uint32_t>, regions> appended; /* new slots, by region */
  std::vector<uint32_t> restated;                      /* slots of old bodies whose state is that of the scene */
  float median = 0;

  size_t new_slots() const { return appended[0].size() + appended[1].size() + appended[2].size(); }
  bool inserts() const { return !appended[0].empty() || !appended[1].empty(); }
};

namespace {

constexpr uint32_t least_room = 64;

/* Calls work(first, count) for each run of consecutive numbers. */
template <class Work> void for_each_run(std::span<const uint32_t> sorted, const Work &work)
{
  for (size_t at = 0; at < sorted.size();) {
    size_t end = at + 1;
    while (end < sorted.size() && sorted[end] == sorted[end - 1] + 1) ++end;
    work(at, end - at);
    at = end;
  }
}

bool has_tree(const Shape &shape) { return shape.mesh || shape.compound; }

/* The bodies in the order of the buffers; those that sleep are the last. */
struct BodyOrder {
  std::vector<uint32_t> all;
  uint32_t awake_count;

  std::vector<uint32_t> awake() const { return {all.begin(), all.begin() + awake_count}; }
  size_t sleepers() const { return all.size() - awake_count; }
};

/* Stages a buffer that follows the bodies in their new order. */
void stage_reordered(StagedUploads &uploads, Memory &memory, const ReorderedRows &rows, Buffer buffer)
{
  if (memory.bytes(buffer) == 0) return;
  if (row_of(buffer).capacity == Capacity::BODIES) uploads.add(buffer, rows.rows_of(memory, buffer));
  if (row_of(buffer).capacity == Capacity::BODIES_PLUS_ONE) uploads.add(buffer, rows.starts_of(memory, buffer));
}

/* All contents that follow the bodies: what steps carry over, and what modules keep by body. The contact cache has rows
 * of the bodies that are awake alone, which are the first ones; steps leave the rows of sleepers on both sides. */
void stage_carried_rows(StagedUploads &uploads, Memory &memory, const StepBuffers &buffers, const BodyOrder &old_order,
                        const BodyOrder &new_order)
{
  const ReorderedRows rows(old_order.all, new_order.all), awake_rows(old_order.awake(), new_order.awake());
  for (const CarriedBuffer &carried : buffers.carried()) {
    const bool by_body = row_of(carried.now).capacity == Capacity::BODIES;
    stage_reordered(uploads, memory, by_body ? rows : awake_rows, carried.now);
    if (by_body && old_order.sleepers() > 0 && memory.bytes(carried.now) > 0)
      uploads.add(carried.previous, rows.rows_of(memory, carried.now));
  }
  for (size_t i = buffer_count; i < buffers.needs().touched.size(); ++i) {
    const Lifetime lifetime = row_of(buffer_at(i)).lifetime;
    if (lifetime == Lifetime::SCENE || lifetime == Lifetime::KEPT) stage_reordered(uploads, memory, rows, buffer_at(i));
  }
  const auto pairs = memory.read<uint32_t>(Buffer::cached_start, 1, old_order.awake_count).front();
  uploads.add(Buffer::cached_b, awake_rows.indices_of(memory, Buffer::cached_b, pairs));
}

/* Manifolds of two bodies with several are known again by their normals, which a scene without trees does not keep.
 * Those of a body that gets another shape are forgotten, so that a world in which this brings the first tree goes on as
 * one that had trees before. */
void stage_forgotten_normals(StagedUploads &uploads, Memory &memory, const BodyOrder &order,
                             const std::vector<uint32_t> &reshaped)
{
  if (reshaped.empty() || memory.bytes(Buffer::cached_normal) == 0) return;
  const std::set<uint32_t> slots(reshaped.begin(), reshaped.end());
  std::vector<bool> is_reshaped; /* by index */
  for (const uint32_t slot : order.all) is_reshaped.push_back(slots.contains(slot));
  const auto starts = memory.read<uint32_t>(Buffer::cached_start, order.awake_count + size_t{1});
  const auto others = memory.read<uint32_t>(Buffer::cached_b, starts.back());
  for (uint32_t a = 0; a < order.awake_count; ++a)
    for (uint32_t pair = starts[a]; pair < starts[a + 1]; ++pair)
      if (is_reshaped[a] || is_reshaped[others[pair]]) uploads.add(Buffer::cached_normal, std::vector<float4>(1), pair);
}

/* What modules keep by body is 0 for a new one, also where another body lay before. */
void stage_module_rows(StagedUploads &uploads, const std::vector<bool> &touched, size_t first, size_t count)
{
  for (size_t i = buffer_count; i < touched.size(); ++i) {
    const BufferRow &row = row_of(buffer_at(i));
    if (!touched[i] || row.capacity != Capacity::BODIES || row.lifetime == Lifetime::SCRATCH) continue;
    const size_t item = row.per_item * size_of(row.element);
    uploads.add_elements(buffer_at(i), std::vector<std::byte>(count * item), first * item);
  }
}

} // namespace

/* What laying out anew changes of a world before it writes; unless dropped, it is restored. */
class World::Implementation::LayoutBackup {
public:
  explicit LayoutBackup(Implementation &world)
      : world_(&world), special_(world.special), features_(world.scene_features), hulls_(world.hulls),
        trees_(world.trees), plan_(world.plan), broadphase_(world.settings.broadphase), chosen_for_(world.chosen_for),
        broadphase_why_(world.broadphase_why), chosen_moving_(world.chosen_moving), entries_(world.scene_entries),
        needs_(world.buffers.needs()), slots_(world.slots), shapes_(world.uploaded_shapes),
        materials_(world.uploaded_materials)
  {}
  ~LayoutBackup()
  {
    if (!world_) return;
    world_->special = std::move(special_);
    world_->scene_features = features_;
    world_->hulls = hulls_;
    world_->trees = std::move(trees_);
    world_->plan = plan_;
    world_->take_broadphase(broadphase_);
    world_->chosen_for = std::move(chosen_for_);
    world_->broadphase_why = std::move(broadphase_why_);
    world_->chosen_moving = chosen_moving_;
    world_->scene_entries = entries_;
    world_->buffers.give_back_needs(std::move(needs_));
    world_->slots = std::move(slots_);
    world_->uploaded_shapes = shapes_;
    world_->uploaded_materials = materials_;
  }
  LayoutBackup(const LayoutBackup &) = delete;
  LayoutBackup &operator=(const LayoutBackup &) = delete;
  void drop() noexcept { world_ = nullptr; }

private:
  Implementation *world_;
  Specialisation special_;
  Features features_;
  HullSizes hulls_;
  TreeTables trees_;
  StepPlan plan_;
  Broadphase broadphase_;
  std::string chosen_for_, broadphase_why_;
  bool chosen_moving_;
  SceneEntries entries_;
  StepBuffers::Needs needs_;
  BodySlots slots_;
  size_t shapes_, materials_;
};

BodyRegion World::Implementation::region_of(uint32_t index) const
{
  return index < special.unbounded ? BodyRegion::half_spaces
         : index < special.large   ? BodyRegion::large
                                   : BodyRegion::small;
}

void World::Implementation::check_new(std::span<const Body> given) const
{
  if (given.size() + slots.count() >= body_numbers)
    throw InputError(fmt::format("create_bodies: {} bodies and {} more; kernels can number {}", slots.count(),
                                 given.size(), body_numbers - 1));
  for (size_t i = 0; i < given.size(); ++i) {
    validate(scene, given[i], i, "create_bodies");
    check_solver(settings, given[i], i, "create_bodies");
  }
}

/* The median size is found anew only where there is no room, so that few calls look at all bodies. */
World::Implementation::Arrival World::Implementation::arrival_of(std::span<const Body> given) const
{
  const Arrival arrival = arrival_of(given, special.median);
  if (bodies() + arrival.new_slots() <= plan.bodies) return arrival;
  Scene all = scene;
  all.bodies.insert(all.bodies.end(), given.begin(), given.end());
  return arrival_of(given, median_radius(all));
}

/* New slots are numbered in the order of the call. */
World::Implementation::Arrival World::Implementation::arrival_of(std::span<const Body> given, float median) const
{
  Arrival arrival;
  arrival.median = median;
  size_t large = special.large - special.unbounded;
  std::array<std::vector<uint32_t>, regions> usable;
  for (size_t region = 0; region < regions; ++region)
    usable[region] = slots.usable(static_cast<BodyRegion>(region), statistics.steps, given.size());
  uint32_t next = slots.count();
  for (const Body &body : given) {
    const bool unbounded = scene.shapes[body.shape].type == ShapeType::half_space;
    auto region = static_cast<size_t>(BodyRegion::small);
    if (unbounded) region = static_cast<size_t>(BodyRegion::half_spaces);
    else if (is_large(scene, body, arrival.median) &&
             (arrival.again[1] < usable[1].size() || large < most_large_bodies))
      region = static_cast<size_t>(BodyRegion::large);
    if (arrival.again[region] < usable[region].size()) {
      arrival.slots.push_back(usable[region][arrival.again[region]++]);
      continue;
    }
    if (region == static_cast<size_t>(BodyRegion::large)) ++large;
    arrival.slots.push_back(next);
    arrival.appended[region].push_back(next++);
  }
  return arrival;
}

/* The kinds of all bodies that exist, and of those in these slots. */
void World::Implementation::note_kinds(std::span<const uint32_t> slots_of_bodies)
{
  known_kinds.clear();
  for (uint32_t slot = 0; slot < slots.count(); ++slot)
    if (slots.exists(slot)) known_kinds.insert(kind_of(scene, scene.bodies[slot]));
  for (const uint32_t slot : slots_of_bodies) known_kinds.insert(kind_of(scene, scene.bodies[slot]));
}

/* True if bodies, which stand in the scene already, bring a feature or a material that the tables lack. Features follow
 * from kinds that are in the scene together, so a new kind makes the list of known ones anew. */
bool World::Implementation::brings_features(std::span<const uint32_t> slots_of_bodies)
{
  const auto is_known = [&](uint32_t slot) { return known_kinds.contains(kind_of(scene, scene.bodies[slot])); };
  const auto has_new_material = [&](uint32_t slot) { return scene.bodies[slot].material >= uploaded_materials; };
  bool brings = std::any_of(slots_of_bodies.begin(), slots_of_bodies.end(), has_new_material);
  if (!std::all_of(slots_of_bodies.begin(), slots_of_bodies.end(), is_known)) {
    note_kinds(slots_of_bodies);
    brings = brings || (features_of(scene, settings) & ~scene_features) != 0;
  }
  return brings;
}

/* True if more than the rows of the bodies themselves must change. The bodies stand in the scene already. */
bool World::Implementation::brings_tables(const Arrival &arrival)
{
  bool brings = brings_features(arrival.slots);
  brings = brings || arrival.inserts() || bodies() + arrival.new_slots() > plan.bodies;
  for (const uint32_t slot : arrival.slots) {
    const Body &body = scene.bodies[slot];
    brings = brings || body.shape >= uploaded_shapes || has_tree(scene.shapes[body.shape]);
  }
  return brings;
}

std::vector<BodyId> World::Implementation::create(std::span<const Body> given)
{
  const minicl::ExactFloatingPoint environment;
  check_new(given);
  if (given.empty()) return {};
  settle();
  const Arrival arrival = arrival_of(given);
  std::vector<BodyId> ids(given.size());
  slots.prepare_growth(arrival.new_slots());
  reserve_more(index_of_body, arrival.new_slots());
  reserve_more(special.order, arrival.new_slots());
  std::vector<RosterChange> changes = changes_of(arrival);
  std::string reason = "bodies were created that the buffers had no room or no tables for";
  PlacedBodies added(scene, arrival.slots, given);
  try {
    if (brings_tables(arrival)) {
      lay_out_anew(arrival);
      ring.forget(std::move(reason));
    } else {
      place_among_others(arrival);
      ring.note(changes);
    }
  } catch (...) {
    known_kinds.clear(); /* some may be of these bodies alone */
    throw;
  }
  added.keep();
  std::for_each(arrival.slots.begin(), arrival.slots.end(), [&](uint32_t slot) { plan_for_body(slot); });
  for (size_t i = 0; i < ids.size(); ++i) {
    ids[i] = slots.id_of(arrival.slots[i]);
    if (given[i].type == BodyType::dynamic) ++awake_dynamics;
    note_motion(arrival.slots[i], {given[i].linear_velocity, given[i].angular_velocity});
  }
  return ids;
}

/* For the states that the ring keeps: what the new bodies replace. */
std::vector<RosterChange> World::Implementation::changes_of(const Arrival &arrival)
{
  std::vector<RosterChange> changes;
  if (ring.size() == 0) return changes;
  ring.prepare_changes(arrival.slots.size());
  for (const uint32_t slot : arrival.slots) {
    RosterChange &change = changes.emplace_back();
    change.slot = slot;
    if (slot >= scene.bodies.size()) continue;
    change.before = scene.bodies[slot];
    if (!has_tree(scene.shapes[change.before->shape]) || memory.bytes(Buffer::body_tree) == 0) continue;
    const auto row = memory.read<uint32_t>(Buffer::body_tree, 2, 2 * size_t{index_of_body[slot]});
    change.tree = {row[0], row[1]};
  }
  return changes;
}

/* Writes the rows of bodies that all fit between and behind the others. New ones are out of every kernel's range until
 * the counts change, which comes last. */
void World::Implementation::place_among_others(const Arrival &arrival)
{
  const std::vector<uint32_t> &appended = arrival.appended[static_cast<size_t>(BodyRegion::small)];
  std::vector<std::pair<uint32_t, uint32_t>> placed; /* index, slot */
  for (const uint32_t slot : arrival.slots)
    placed.emplace_back(slot < slots.count() ? index_of_body[slot] : bodies() + (slot - slots.count()), slot);
  std::sort(placed.begin(), placed.end());
  std::vector<uint32_t> indices, sorted_slots;
  for (const auto &[index, slot] : placed) indices.push_back(index), sorted_slots.push_back(slot);

  buffers.make_ready(sizes());
  StagedUploads uploads;
  const HullNumbers numbers = hull_numbers(scene);
  for_each_run(indices, [&](size_t first, size_t count) {
    stage_new_bodies(uploads, scene, numbers, std::span(sorted_slots).subspan(first, count), indices[first]);
    stage_module_rows(uploads, buffers.needs().touched, indices[first], count);
  });
  const uint32_t pairs = memory.read<uint32_t>(Buffer::cached_start, 1, special.awake).front();
  uploads.add(Buffer::cached_start, std::vector<uint32_t>(appended.size(), pairs), special.awake + size_t{1});
  const auto entries = entries_of(
      {special.awake + static_cast<uint32_t>(appended.size()), special.unbounded, special.large, sleepers.count()});
  for (const auto &[entry, value] : entries) uploads.add_count(static_cast<uint32_t>(entry), value);
  uploads.prepare(memory);
  scene_entries = entries;

  slots.append(appended.size());
  for (size_t region = 0; region < regions; ++region)
    slots.use_again(static_cast<BodyRegion>(region), arrival.again[region]);
  if (!sleepers.empty()) keep_order_of_events(); /* they make room */
  special.order.insert(special.order.end(), appended.begin(), appended.end());
  for (const uint32_t slot : appended) index_of_body.push_back(bodies() - static_cast<uint32_t>(slots.count() - slot));
  for (const auto &[entry, value] : scene_entries) plan.known[static_cast<size_t>(entry)] = value;
  ++state;
  uploads.write(memory);
  bring_forward(appended); /* between those awake and those asleep */
  rows_bring_wishes();
  counted_bodies = special.awake;
  forget_kept(memory);
  if (sleepers.empty()) return;
  if (!scene.articulations.empty()) tell_joints(); /* links that sleep have made room, and joined pairs are by index */
  sleepers_changed();
}

namespace {

/* The order of the bodies with new ones at the end of their regions, and those asleep behind them. */
std::vector<uint32_t> order_with(const Specialisation &special, const std::array<std::vector<uint32_t>, regions> &added)
{
  const std::array<size_t, regions + 1> ends{0, special.unbounded, special.large, special.awake};
  std::vector<uint32_t> order;
  for (size_t region = 0; region < regions; ++region) {
    const auto first = special.order.begin();
    order.insert(order.end(), first + static_cast<ptrdiff_t>(ends[region]),
                 first + static_cast<ptrdiff_t>(ends[region + 1]));
    order.insert(order.end(), added[region].begin(), added[region].end());
  }
  order.insert(order.end(), special.order.begin() + special.awake, special.order.end());
  return order;
}

} // namespace

/* The layout for the scene with its new bodies. */
void World::Implementation::plan_layout(const Arrival &arrival, std::vector<uint32_t> order)
{
  const Features needed = scene_features | features_of(scene, settings);
  check_built(needed, scene, settings, scene.name);
  special.unbounded += static_cast<uint32_t>(arrival.appended[0].size());
  special.large += static_cast<uint32_t>(arrival.appended[0].size() + arrival.appended[1].size());
  special.median = arrival.median;
  special.awake = static_cast<uint32_t>(order.size()) - sleepers.count();
  scene_features = needed;
  special.features = features_run();
  special.order = std::move(order);
  hulls = hull_sizes(scene, hull_maps(settings));
  trees = tree_tables(scene);
  if (bodies() > plan.bodies) plan.bodies = std::max({bodies(), 2 * plan.bodies, least_room});
  plan.features = special.features;
  plan.capacity_cells = cells_for(plan.bodies);
  scene_entries = entries_of({special.awake, special.unbounded, special.large, sleepers.count()});
  counted_bodies = special.awake;
  choose_broadphase_after(settings.broadphase);
  record_kernels();
  backends.take_features(special.features, buffers.needs().kernels);
  buffers.changed();
  buffers.make_ready(sizes());
}

/* The states of the new bodies, in their places, and of those that a call has changed. */
void World::Implementation::stage_arrival(StagedUploads &uploads, const Arrival &arrival) const
{
  const std::set<uint32_t> is_new(arrival.slots.begin(), arrival.slots.end()),
      is_restated(arrival.restated.begin(), arrival.restated.end());
  for (uint32_t index = 0; index < bodies(); ++index) {
    const uint32_t slot = special.order[index];
    if (is_new.contains(slot)) stage_module_rows(uploads, buffers.needs().touched, index, 1);
    if (is_new.contains(slot)) stage_no_past(uploads, index, 1);
    if (is_new.contains(slot) || is_restated.contains(slot)) stage_states(uploads, scene, std::span(&slot, 1), index);
  }
}

std::vector<uint32_t> World::Implementation::moved_bodies()
{
  if (idle || !whole) return {};
  return moved_before ? *moved_before : download_moved_bodies(memory, events_order());
}

/* Makes room, tables and kernels for the new bodies, and moves the others to their new places. Nothing needs memory
 * after the backup is dropped. */
void World::Implementation::lay_out_anew(const Arrival &arrival, const JointImpulses *impulses)
{
  buffers.make_ready(sizes());
  if (settings.moved_bodies && statistics.steps > 0) moved_before = moved_bodies(); /* the list may lose its place */
  const std::vector<uint32_t> old_order = special.order;
  std::vector<uint32_t> order = order_with(special, arrival.appended);
  const std::vector<CarriedBuffer> old_pair_rows = pair_rows(buffers.needs().touched);
  StagedUploads uploads;
  stage_carried_rows(uploads, memory, buffers, {old_order, special.awake},
                     {order, static_cast<uint32_t>(order.size()) - sleepers.count()});
  stage_forgotten_normals(uploads, memory, {old_order, special.awake}, arrival.restated);
  std::vector<uint32_t> order_before = arrival.inserts() && order_of_events.empty() ? old_order : order_of_events;
  LayoutBackup backup(*this);
  forget_kept(memory); /* their buffers get new sizes, and lose their contents, also where this fails later */
  plan_layout(arrival, std::move(order));
  slots.append(arrival.new_slots());
  for (size_t region = 0; region < regions; ++region)
    slots.use_again(static_cast<BodyRegion>(region), arrival.again[region]);
  stage_tables(uploads);
  stage_masses(uploads, scene, special.order);
  stage_arrival(uploads, arrival);
  if (impulses) impulses->stage(uploads, joint_order.joints(), joint_graph.axes);
  stage_counts(uploads);
  std::optional<Sleepers> sleepers_now;
  if (!sleepers.empty()) sleepers_now = sleepers_with(old_pair_rows);
  index_of_body.reserve(scene.bodies.size());
  uploads.prepare(memory);
  backup.drop();

  number_bodies();
  rows_bring_wishes();
  order_of_events.swap(order_before);
  ++state;
  uploads.write(memory);
  guess_counts();
  forget_kept(memory);
  if (!sleepers_now) return;
  sleepers = std::move(*sleepers_now);
  sleepers_changed();
}

/* The same bodies with other features or shapes. */
void World::Implementation::lay_out_anew(std::span<const uint32_t> restated, const JointImpulses *impulses)
{
  Arrival nobody;
  nobody.restated.assign(restated.begin(), restated.end());
  nobody.median = special.median;
  lay_out_anew(nobody, impulses);
}

std::vector<uint32_t> World::Implementation::distinct_indices(const char *call, std::span<const BodyId> ids) const
{
  std::vector<uint32_t> indices;
  for (const uint32_t slot : slots_of(call, ids)) indices.push_back(index_of_body[slot]);
  std::sort(indices.begin(), indices.end());
  const auto twice = std::adjacent_find(indices.begin(), indices.end());
  if (twice != indices.end()) throw InputError(fmt::format("{}: body {} is given twice", call, special.order[*twice]));
  return indices;
}

void World::Implementation::destroy(std::span<const BodyId> ids)
{
  distinct_indices("destroy_bodies", ids);
  settle_joints();
  const std::vector<uint32_t> joints_of_destroyed = joints_of_bodies(slots_of("destroy_bodies", ids));
  refuse_coupled("destroy_bodies", "it cannot be destroyed", joints_of_destroyed);
  refuse_driven("destroy_bodies", "it cannot be destroyed", joints_of_destroyed);
  refuse_linked("destroy_bodies", "it cannot be destroyed", slots_of("destroy_bodies", ids));
  refuse_articulated("destroy_bodies", "its bodies cannot be destroyed", joints_of_destroyed);
  if (ids.empty()) return;
  settle();
  destroy_joints_in(joints_of_destroyed);
  wake_bodies(slots_of("destroy_bodies", ids), true);
  const std::vector<uint32_t> indices = distinct_indices("destroy_bodies", ids);
  buffers.make_ready(sizes());
  for (size_t region = 0; region < regions; ++region)
    slots.prepare_freeing(static_cast<BodyRegion>(region), indices.size());
  ring.prepare_changes(indices.size());
  StagedUploads uploads;
  for_each_run(indices, [&](size_t first, size_t count) {
    stage_free_rows(uploads, indices[first], static_cast<uint32_t>(count));
  });
  uploads.prepare(memory);
  ++state;
  uploads.write(memory);
  forget_kept(memory);
  for (const uint32_t index : indices) {
    const uint32_t slot = special.order[index];
    if (scene.bodies[slot].type == BodyType::dynamic && slots.status()[slot] == BodyStatus::present) --awake_dynamics;
    moving_kinematics.erase(slot);
    shapes.forget(slot);
    slots.free(slot, region_of(index), statistics.steps);
    ring.note({slot, std::nullopt, std::nullopt});
  }
}

uint32_t World::Implementation::add_shape(const Shape &shape)
{
  const minicl::ExactFloatingPoint environment;
  validate(shape, scene.shapes.size(), "add_shape");
  scene.shapes.push_back(shape);
  return static_cast<uint32_t>(scene.shapes.size() - 1);
}

uint32_t World::Implementation::add_material(const Material &material)
{
  validate(material, scene.materials.size(), "add_material");
  if (scene.materials.size() >= MOST_MATERIALS)
    throw InputError(fmt::format("add_material: there are {} materials; no more are possible", MOST_MATERIALS));
  if (!scene.articulations.empty()) check_material_beside_links(material, scene.materials.size(), "add_material");
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

} // namespace tandem
