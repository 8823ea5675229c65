/* state_ring.cpp - see state_ring.h; and how a world keeps its state and goes back. */
#include "host/world/state_ring.h"

#include <algorithm>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/base/reserve_more.h"
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/scene_counts.h"
#include "host/runtime/interface/floating_point.h"
#include "host/scene/articulation_buffers.h"
#include "host/world/implementation.h"
#include "host/world/placed_joints.h"

namespace tandem {

void StateRing::resize(size_t slots, bool after_steps)
{
  std::vector<KeptState> fresh(slots);
  slots_.swap(fresh);
  newest_ = kept_ = 0;
  after_steps_ = after_steps;
  first_change_ = changes();
  changes_.clear();
  shared_ = nullptr;
  shared_shapes_ = nullptr;
  shared_sleepers_ = nullptr;
  why_.clear();
}

KeptState &StateRing::begin() noexcept
{
  if (kept_ == slots_.size()) --kept_;
  return slots_[(newest_ + 1) % slots_.size()];
}

/* What happened before the oldest state is never undone. */
void StateRing::commit() noexcept
{
  newest_ = (newest_ + 1) % slots_.size();
  kept_ = std::min(kept_ + 1, slots_.size());
  const size_t oldest = back(kept_ - 1).changes;
  changes_.erase(changes_.begin(), changes_.begin() + static_cast<ptrdiff_t>(oldest - first_change_));
  first_change_ = oldest;
}

void StateRing::rewind(size_t states) noexcept
{
  newest_ = (newest_ + slots_.size() - states) % slots_.size();
  kept_ -= states;
  changes_.resize(back(0).changes - first_change_);
  shared_ = back(0).slots;
  shared_shapes_ = back(0).shape_slots;
  shared_sleepers_ = back(0).sleepers;
}

void StateRing::forget(std::string why) noexcept
{
  if (slots_.empty()) return;
  why_ = std::move(why);
  shared_ = nullptr;
  shared_shapes_ = nullptr;
  shared_sleepers_ = nullptr;
  kept_ = 0;
  first_change_ = changes();
  changes_.clear();
}

std::shared_ptr<const BodySlots> StateRing::shared(const BodySlots &slots)
{
  if (!shared_) shared_ = std::make_shared<const BodySlots>(slots);
  return shared_;
}

std::shared_ptr<const ShapeSlots> StateRing::shared(const ShapeSlots &slots)
{
  if (!shared_shapes_ || shared_shapes_->changes() != slots.changes())
    shared_shapes_ = std::make_shared<const ShapeSlots>(slots);
  return shared_shapes_;
}

void StateRing::prepare_changes(size_t more)
{
  if (slots_.empty()) return;
  reserve_more(changes_, more);
}

void StateRing::note(RosterChange change) noexcept
{
  if (slots_.empty()) return;
  shared_ = nullptr;
  changes_.push_back(std::move(change));
}

std::span<RosterChange> StateRing::changes_after(size_t changes)
{
  return std::span(changes_).subspan(changes - first_change_);
}

/* The storage of the backend whose kernel writes the buffer in each step. */
Storage &World::Implementation::storage_of(Buffer buffer)
{
  for (const auto &[kernel, used] : buffers.needs().uses) {
    if (used != buffer) continue;
    for (const Argument &argument : row_of(kernel).arguments)
      if (argument.kind == Argument::Kind::buffer && argument.buffer == buffer && argument.access != Access::in)
        return backends.of(kernel).storage();
  }
  return host_storage();
}

void World::Implementation::keep_states(uint32_t states, bool after_steps)
{
  constexpr uint32_t most_states = 10000;
  if (states > most_states)
    throw InputError(fmt::format("keep_states: {} states; {} are the most", states, most_states));
  settle_joints();
  StateRing fresh;
  fresh.resize(states, after_steps);
  if (states > 0) buffers.make_ready(sizes());
  for (KeptState &state : fresh.slots()) {
    state.buffers.resize(buffers.carried().size());
    for (size_t i = 0; i < state.buffers.size(); ++i)
      if (const Buffer buffer = buffers.carried()[i].now; memory.bytes(buffer) > 0)
        memory.make_room(buffer, storage_of(buffer), state.buffers[i]);
  }
  ring = std::move(fresh);
  if (states > 0) keep_state();
}

std::shared_ptr<const KeptSleepers> World::Implementation::keep_sleepers()
{
  std::shared_ptr<const KeptSleepers> &kept = ring.shared_sleepers();
  if (!kept || kept->number != set_of_sleepers || kept->order.size() != bodies())
    kept = std::make_shared<const KeptSleepers>(KeptSleepers{set_of_sleepers,
                                                             special.order,
                                                             index_of_body,
                                                             {joint_order.joints().begin(), joint_order.joints().end()},
                                                             joint_order.awake().size(),
                                                             special.large,
                                                             sleepers});
  return kept;
}

std::shared_ptr<const KeptJoints> World::Implementation::keep_joints()
{
  if (scene.joints.empty()) return nullptr;
  if (!kept_joints || kept_joints->number != joints_number)
    kept_joints = std::make_shared<const KeptJoints>(KeptJoints{joints_number, scene.joints, joint_slots});
  return kept_joints;
}

void World::Implementation::keep_state()
{
  if (ring.size() == 0) throw InputError("keep_state: there is no room for states; keep_states makes it");
  settle();
  KeptState &state = ring.begin(); /* a state that is written in part only is not kept */
  for (size_t i = 0; i < buffers.carried().size(); ++i) {
    const Buffer buffer = buffers.carried()[i].now;
    const size_t item = row_of(buffer).per_item * size_of(row_of(buffer).element);
    memory.keep(buffer, items_in_use(memory, buffer, {bodies(), special.awake}, cached_pairs) * item, state.buffers[i]);
  }
  state.slots = ring.shared(slots);
  state.shape_slots = ring.shared(shapes);
  state.joints = keep_joints();
  if (settings.sleeping) state.sleepers = keep_sleepers();
  state.statistics = statistics;
  state.fault = fault;
  state.quarantined = quarantined.size();
  state.shapes = scene.shapes.size();
  state.materials = scene.materials.size();
  state.bodies = bodies();
  state.pairs = cached_pairs;
  state.forces = plan.forces;
  state.drowsy = plan.drowsy;
  state.substeps = plan.substeps;
  state.sleep_events_to_come = sleep_events_to_come;
  state.changes = ring.changes();
  ring.commit();
}

/* The step is made; only its state cannot be gone back to. */
void World::Implementation::keep_state_of_step()
{
  if (!ring.keeps_after_steps()) return;
  try {
    keep_state();
  } catch (const OutOfMemory &error) {
    ring.forget(error.what());
  } catch (const std::bad_alloc &) {
    ring.forget("there was no memory for a state");
  }
}

namespace {

/* Gives the bodies of the scene back, the last replaced first. Doing it twice, the second time in the other order,
 * changes nothing. */
void swap_bodies(Scene &scene, std::span<RosterChange> changes, bool newest_first) noexcept
{
  for (size_t k = 0; k < changes.size(); ++k) {
    RosterChange &change = changes[newest_first ? changes.size() - 1 - k : k];
    if (change.before) std::swap(scene.bodies[change.slot], *change.before);
  }
}

/* The slots that changed and existed before, in the order of their indices. */
std::vector<uint32_t> changed_slots(std::span<const RosterChange> changes, uint32_t bodies)
{
  std::vector<uint32_t> slots;
  for (const RosterChange &change : changes)
    if (change.slot < bodies) slots.push_back(change.slot);
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  return slots;
}

} // namespace

SceneEntries World::Implementation::entries_then(const KeptState &state) const
{
  const uint32_t asleep = state.sleepers ? state.sleepers->sleepers.count() : 0,
                 large = state.sleepers ? state.sleepers->large : special.large;
  return entries_of({state.bodies - asleep, special.unbounded, large, asleep});
}

/* The rows of bodies that only calls change. Those of states come with the carried buffers. index: of the bodies. */
void World::Implementation::stage_roster(StagedUploads &uploads, const KeptState &state,
                                         std::span<const RosterChange> changes,
                                         const std::vector<uint32_t> &index) const
{
  const HullNumbers numbers = hull_numbers(scene);
  for (const uint32_t slot : changed_slots(changes, state.bodies)) {
    const BodyStatus status = state.slots->status()[slot];
    if (status == BodyStatus::free) stage_free_rows(uploads, index[slot], 1);
    else stage_fixed_rows(uploads, scene, numbers, slot, index[slot], status);
  }
  for (size_t k = changes.size(); k-- > 0;)
    if (changes[k].tree && changes[k].slot < state.bodies)
      uploads.add(Buffer::body_tree, std::vector<uint32_t>(changes[k].tree->begin(), changes[k].tree->end()),
                  index[changes[k].slot]);
  for (const auto &[entry, value] : entries_then(state)) uploads.add_count(static_cast<uint32_t>(entry), value);
}

/* The rows that states do not hold follow their bodies to the places that they had when others slept. */
void World::Implementation::reorder_rows(const std::vector<uint32_t> &order)
{
  std::vector<uint32_t> from, to;
  for (uint32_t place = 0; place < order.size(); ++place)
    if (index_of_body[order[place]] != place) {
      from.push_back(index_of_body[order[place]]);
      to.push_back(place);
    }
  move_rows(from, to, false);
}

/* Nothing here can fail. */
void World::Implementation::take_roster(const KeptState &state, BodySlots &slots_then, ShapeSlots &shapes_then) noexcept
{
  std::swap(slots, slots_then);
  std::swap(shapes, shapes_then);
  special.order.resize(state.bodies);
  special.awake = counted_bodies = state.bodies - sleepers.count();
  scene.bodies.erase(scene.bodies.begin() + state.bodies, scene.bodies.end());
  index_of_body.resize(state.bodies);
  scene.shapes.erase(scene.shapes.begin() + static_cast<ptrdiff_t>(state.shapes), scene.shapes.end());
  scene.materials.erase(scene.materials.begin() + static_cast<ptrdiff_t>(state.materials), scene.materials.end());
  quarantined.erase(quarantined.begin() + static_cast<ptrdiff_t>(state.quarantined), quarantined.end());
  statistics = state.statistics;
  fault = state.fault;
  cached_pairs = state.pairs;
  commands.clear();
  force_commands.clear();
  order_of_events.clear();
  whole = false;
  ++this->state;
}

void World::Implementation::take_sleepers(KeptSleepers &then)
{
  reorder_rows(then.order);
  move_joint_rows(joint_order.take(std::move(then.joints), then.awake_joints), false);
  special.order.swap(then.order);
  index_of_body.swap(then.index_of_body);
  special.large = then.large;
  std::swap(sleepers, then.sleepers);
  set_of_sleepers = then.number;
}

/* Steps leave the rows of sleepers on both sides. */
void World::Implementation::put_back_sleepers(const KeptState &then)
{
  for (size_t i = 0; i < buffers.carried().size(); ++i)
    if (has_rows_of_sleepers(buffers.carried()[i].now)) memory.put_back(buffers.carried()[i].previous, then.buffers[i]);
  tell_sleepers();
  tell_joints();
}

/* Steps without the stage of forces, as before the first force. */
void World::Implementation::drop_forces()
{
  StepBuffers::Needs before = buffers.needs();
  plan.forces = false;
  try {
    record_kernels();
    place_again();
  } catch (...) {
    plan.forces = true;
    buffers.give_back_needs(std::move(before));
    throw;
  }
  memory.resize(Buffer::body_force, 0);
  memory.resize(Buffer::previous_body_force, 0);
}

void World::Implementation::check_back(uint32_t states) const
{
  if (states < ring.kept()) return;
  throw InputError(fmt::format("go_back: {} states back, and {} are kept{}{}", states, ring.kept(),
                               ring.why_forgotten().empty() ? "" : "; those before are gone: ", ring.why_forgotten()));
}

void World::Implementation::go_back(uint32_t states)
{
  const minicl::ExactFloatingPoint environment;
  settle_joints();
  check_back(states);
  restore_bodies();
  const KeptState &then = ring.back(states);
  if (plan.forces && !then.forces && !module_applies_forces()) drop_forces();
  buffers.make_ready(sizes());
  BodySlots slots_then = *then.slots;
  ShapeSlots shapes_then = *then.shape_slots;
  std::vector<SleepEvent> sleep_events_then = then.sleep_events_to_come;
  const bool others_sleep = then.sleepers && then.sleepers->number != set_of_sleepers;
  std::optional<KeptSleepers> sleepers_then;
  if (others_sleep) sleepers_then = *then.sleepers;
  auto entries = entries_then(then);
  const std::span<RosterChange> changes = ring.changes_after(then.changes);
  StagedUploads uploads;
  std::optional<JointSlots> joint_slots_then;
  std::optional<PlacedJoints> joints_then;
  swap_bodies(scene, changes, true);
  try {
    if (then.joints && then.joints->number != joints_number) {
      joint_slots_then = then.joints->slots;
      std::vector<Joint> joints = then.joints->joints;
      JointGraph graph = graph_with(joints);
      joints_then.emplace(*this, std::move(joints), std::move(graph));
      if (others_sleep) joint_order.take(sleepers_then->joints, sleepers_then->awake_joints);
      stage_joints_again(uploads, others_sleep ? sleepers_then->order : special.order);
    }
    stage_roster(uploads, then, changes, others_sleep ? sleepers_then->index_of_body : index_of_body);
    if (!then.sleepers && !scene.articulations.empty()) /* links that went into quarantine since then are back */
      stage_bodies_of_links(uploads, links, index_of_body, plan.bodies, then.slots->status(), special.awake);
    uploads.prepare(memory);
  } catch (...) {
    swap_bodies(scene, changes, false);
    throw;
  }
  if (joints_then) {
    joints_then->keep();
    std::swap(joint_slots, *joint_slots_then);
    joints_number = then.joints->number;
    plan_joints();
  }
  if (others_sleep) take_sleepers(*sleepers_then);
  take_roster(then, slots_then, shapes_then);
  scene_entries.swap(entries);
  for (const auto &[entry, value] : scene_entries) plan.known[static_cast<size_t>(entry)] = value;
  uploads.write(memory);
  for (size_t i = 0; i < buffers.carried().size(); ++i) {
    const auto &[now, previous] = buffers.carried()[i];
    memory.put_back(now, then.buffers[i]);
    if (has_rows_of_joints(row_of(now))) memory.put_back(previous, then.buffers[i]); /* of those not enabled, too */
  }
  if (then.sleepers) put_back_sleepers(then);
  forget_kept(memory);
  ring.rewind(states);
  set_elsewhere.clear();
  sleep_events.clear();
  joint_breaks.clear();
  sleep_events_to_come.swap(sleep_events_then);
  plan.drowsy = then.drowsy;
  plan.substeps = then.substeps;
  told_substeps = {};  /* with joints, kernels were told those of the state that is left */
  rows_bring_wishes(); /* steps since then may have written them */
  if (settings.sleeping) recount_motion();
}

} // namespace tandem
