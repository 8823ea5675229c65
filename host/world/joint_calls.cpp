/* joint_calls.cpp - joints that are created, changed and destroyed while a world runs, and joints that break.
 *
 * The host colours all joints anew, so that the colours follow from the scene alone, as they do for a world that a
 * snapshot makes. The impulses of joints that stay follow them to their new places. Where the buffers have room and the
 * kernels are the same, tables of joints alone are written:
 *
 *   Scene::joints -> colours, order -> tables of joints          (write_joints)
 *                                   -> all tables, new kernels   (lay_out_anew, host/world/bodies.cpp)
 *
 * Joints that are created and destroyed wait for that until a step or a read needs it (pending_joints.h).
 */
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/layout.h"
#include "host/pipeline/scene_counts.h"
#include "host/scene/articulation_buffers.h"
#include "host/scene/articulation_order.h"
#include "host/scene/built.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"
#include "host/world/call_checks.h"
#include "host/world/implementation.h"
#include "host/world/placed_joints.h"
#include "shared/counts.h"

namespace tandem {

namespace {

std::vector<uint32_t> kinds_used_by(const Joint &joint)
{
  std::vector<uint32_t> kinds;
  for (const UsedAxis &used : axes_used_by(joint)) kinds.push_back(used.kind);
  return kinds;
}

/* Whether the impulses of one joint say something of the other, which stands in its place. */
bool keeps_impulses(const Joint &one, const Joint &other)
{
  return one.enabled && other.enabled && one.type == other.type && one.body_a == other.body_a &&
         one.body_b == other.body_b && held_by(one) == held_by(other) && kinds_used_by(one) == kinds_used_by(other);
}

/* The bodies at which joints have a colour that they had not before: contacts may have it there. */
std::vector<uint32_t> bodies_with_new_colors(const JointGraph &before, const JointGraph &now)
{
  std::vector<uint32_t> bodies;
  for (size_t word = 0; word < now.body_colors.size(); ++word) {
    const uint32_t old = word < before.body_colors.size() ? before.body_colors[word] : 0;
    const auto body = static_cast<uint32_t>(word / 2);
    if ((now.body_colors[word] & ~old) != 0 && (bodies.empty() || bodies.back() != body)) bodies.push_back(body);
  }
  return bodies;
}

/* Whether the kernels of a step with the first graph do for the second. */
bool has_kernels_for(const JointGraph &one, const JointGraph &other)
{
  const auto has = [](uint32_t colors, uint32_t others) {
    return (others == 0 || colors > 0) && (others <= COLOR_LIMIT || colors > COLOR_LIMIT);
  };
  return has(one.colors, other.colors) && has(one.link_colors, other.link_colors);
}

bool are_all_among(const std::vector<bool> &flags, const std::vector<bool> &others)
{
  for (size_t k = 0; k < flags.size(); ++k)
    if (flags[k] && (k >= others.size() || !others[k])) return false;
  return true;
}

} // namespace

/* Couplings have colours by the bodies of their joints. */
void World::Implementation::refuse_coupled(const char *call, const char *why, std::span<const uint32_t> joints) const
{
  for (size_t k = 0; k < scene.couplings.size(); ++k)
    for (const uint32_t joint : {scene.couplings[k].joint_a, scene.couplings[k].joint_b})
      if (std::find(joints.begin(), joints.end(), joint) != joints.end())
        throw InputError(fmt::format("{}: joint {}: {}, because coupling {} needs it", call, joint, why, k));
}

/* Another joint may come to stand in the place of one that is destroyed, and would be driven in its stead. */
void World::Implementation::refuse_driven(const char *call, const char *why, std::span<const uint32_t> joints) const
{
  for (size_t k = 0; k < scene.actuators.size(); ++k) {
    const uint32_t joint = scene.actuators[k].joint;
    if (std::find(joints.begin(), joints.end(), joint) != joints.end())
      throw InputError(fmt::format("{}: joint {}: {}, because actuator {} drives it; leave the actuator out of the "
                                   "scene for that",
                                   call, joint, why, k));
  }
}

/* An articulation stays as it is. */
void World::Implementation::refuse_articulated(const char *call, const char *why,
                                               std::span<const uint32_t> joints) const
{
  for (const uint32_t joint : joints)
    if (is_in_tree(joint))
      throw InputError(fmt::format("{}: joint {}: {}, because an articulation has it",
                                   call_in_message(call, some_body_of(scene.joints[joint])), joint_in_message(joint),
                                   why));
}

void World::Implementation::refuse_linked(const char *call, const char *why, std::span<const uint32_t> given) const
{
  for (const uint32_t body : given)
    if (links.has_body(body))
      throw InputError(fmt::format("{}: body {}: {}, because it is a link of an articulation",
                                   call_in_message(call, body), body_in_message(body), why));
}

/* A tree that a body holds stands where the body was when the tables were made. */
void World::Implementation::refuse_bases(const char *call, std::span<const uint32_t> given) const
{
  for (const uint32_t body : given)
    if (links.has_base(body))
      throw InputError(fmt::format("{}: body {}: it cannot be moved, because an articulation stands on it",
                                   call_in_message(call, body), body_in_message(body)));
}

/* The awake bodies of joints begin their rest anew; those asleep wake. */
void World::Implementation::disturb_joined(std::span<const Joint> joints)
{
  if (!settings.sleeping) return;
  std::vector<uint32_t> bodies_of_joints;
  for (const Joint &joint : joints)
    for (const uint32_t body : {joint.body_a, joint.body_b})
      if (body != no_body && slots.exists(body)) bodies_of_joints.push_back(body);
  wake_bodies(bodies_of_joints, false);
  const uint32_t none = 0;
  for (const uint32_t body : bodies_of_joints)
    memory.upload(Buffer::resting_steps, &none, sizeof none, index_of_body[body] * sizeof none);
}

/* Makes the joints of the scene these, some of which differ from what they were. */
void World::Implementation::put_joints(std::vector<Joint> joints, const JointSlots &slots_then,
                                       std::span<const uint32_t> changed)
{
  settle();
  std::vector<Joint> disturbed;
  for (const uint32_t joint : changed) {
    if (joint < scene.joints.size()) disturbed.push_back(scene.joints[joint]);
    if (joint < joints.size()) disturbed.push_back(joints[joint]);
  }
  disturb_joined(disturbed);
  std::vector<uint32_t> forgotten;
  for (const uint32_t joint : changed)
    if (joint >= scene.joints.size() || !keeps_impulses(scene.joints[joint], joints[joint])) forgotten.push_back(joint);
  exchange_joints(std::move(joints), slots_then, forgotten, {});
}

/* forgotten: joints that lose their impulses; recolored: bodies that had a new colour in between. What may lack memory
 * comes before the first change: contacts that kept a colour which a joint has now would be solved beside it. */
void World::Implementation::exchange_joints(std::vector<Joint> joints, const JointSlots &slots_then,
                                            std::span<const uint32_t> forgotten, std::vector<uint32_t> recolored)
{
  buffers.make_ready(sizes());
  JointImpulses impulses(memory, joint_order.joints(), joint_graph.axes);
  for (const uint32_t joint : forgotten) impulses.forget(joint);
  JointSlots new_slots = slots_then;
  JointGraph graph = graph_with(joints);
  if (is_batch()) graph.joined_pairs = std::max(graph.joined_pairs, joint_graph.joined_pairs); /* they may be mended */
  const std::vector<uint32_t> recolored_now = bodies_with_new_colors(joint_graph, graph);
  recolored.insert(recolored.end(), recolored_now.begin(), recolored_now.end());
  wake_bodies(recolored, false);
  const std::vector<uint32_t> contact_colors = colors_without(recolored);
  std::string reason = "joints came that the buffers had no room or no tables for";
  PlacedJoints placed(*this, std::move(joints), std::move(graph));
  check_built(features_of(scene, settings), scene, settings, scene.name);
  check_couplings(settings, scene);
  const bool fits = fits_tables(placed.joints_before(), placed.graph_before());
  if (fits) write_joints(impulses);
  else lay_out_anew(std::span<const uint32_t>{}, &impulses);
  placed.keep();
  joint_slots = std::move(new_slots);
  joints_number = ++joints_numbers;
  ++graph_number;
  if (!sleepers.empty()) set_of_sleepers = ++sets_of_sleepers; /* their joints may have other places */
  if (!fits) ring.forget(std::move(reason));
  put_colors(contact_colors);
}

/* Of the scene, if it had these joints. */
JointGraph World::Implementation::graph_with(std::vector<Joint> &joints)
{
  scene.joints.swap(joints);
  try {
    JointGraph graph = joint_graph_of(scene, std::max(special.worlds, 1u));
    scene.joints.swap(joints);
    return graph;
  } catch (...) {
    scene.joints.swap(joints);
    throw;
  }
}

/* Whether tables of joints alone tell kernels of the present joints, after those given. */
bool World::Implementation::fits_tables(const std::vector<Joint> &before, const JointGraph &graph) const
{
  if (before.size() != scene.joints.size() || graph.axes != joint_graph.axes ||
      graph.joined_pairs != joint_graph.joined_pairs || !has_kernels_for(graph, joint_graph) ||
      (joint_features(scene) & ~scene_features) != 0)
    return false;
  Scene then;
  then.bodies.resize(scene.bodies.size());
  then.joints = before;
  return are_all_among(joined_bodies(scene), joined_bodies(then));
}

/* All that tells kernels of joints, while the buffers stay as they are. */
void World::Implementation::stage_joints_again(StagedUploads &uploads, std::span<const uint32_t> order) const
{
  stage_joint_tables(uploads, order);
  for (const auto &[entry, value] : joint_entries_of(joint_order.starts()))
    uploads.add_count(static_cast<uint32_t>(entry), value);
  stage_parameters(uploads);
}

void World::Implementation::write_joints(const JointImpulses &impulses)
{
  StagedUploads uploads;
  stage_joints_again(uploads, special.order);
  impulses.stage(uploads, joint_order.joints(), joint_graph.axes);
  uploads.prepare(memory);
  ++state;
  uploads.write(memory);
  plan_joints();
  forget_kept(memory); /* other pairs collide */
}

std::vector<JointId> World::Implementation::create_joints(std::span<const Joint> given)
{
  for (size_t i = 0; i < given.size(); ++i) {
    validate(scene, given[i], i, "create_joints");
    check_joined_bodies("create_joints", i, given[i]);
    check_joint_beside_links(links, given[i], i, "create_joints");
  }
  if (given.empty()) return {};
  if (may_wait(given)) return create_joints_later(given);
  settle_joints();
  JointSlots new_slots = joint_slots;
  std::vector<Joint> joints = scene.joints;
  std::vector<uint32_t> created;
  for (const Joint &joint : given) {
    const uint32_t slot = created.emplace_back(new_slots.take());
    if (slot == joints.size()) joints.emplace_back();
    joints[slot] = joint;
  }
  std::vector<JointId> ids;
  ids.reserve(created.size());
  put_joints(std::move(joints), new_slots, created);
  for (const uint32_t slot : created) ids.push_back(joint_slots.id_of(slot));
  return ids;
}

void World::Implementation::destroy_joints(std::span<const JointId> ids)
{
  std::vector<uint32_t> destroyed = slots_of_joints("destroy_joints", ids);
  std::sort(destroyed.begin(), destroyed.end());
  const auto twice = std::adjacent_find(destroyed.begin(), destroyed.end());
  if (twice != destroyed.end()) throw InputError(fmt::format("destroy_joints: joint {} is given twice", *twice));
  refuse_coupled("destroy_joints", "it cannot be destroyed", destroyed);
  refuse_driven("destroy_joints", "it cannot be destroyed", destroyed);
  refuse_articulated("destroy_joints", "it cannot be destroyed", destroyed);
  if (may_wait({})) destroy_joints_later(destroyed);
  else destroy_joints_in(destroyed);
}

void World::Implementation::destroy_joints_in(std::span<const uint32_t> destroyed)
{
  if (destroyed.empty()) return;
  JointSlots new_slots = joint_slots;
  std::vector<Joint> joints = scene.joints;
  for (const uint32_t slot : destroyed) {
    new_slots.free(slot);
    joints[slot] = vacant_joint();
  }
  put_joints(std::move(joints), new_slots, destroyed);
}

/* The joints that have one of these bodies, enabled or not. */
std::vector<uint32_t> World::Implementation::joints_of_bodies(std::span<const uint32_t> given) const
{
  std::vector<uint32_t> joints;
  if (scene.joints.empty() || given.empty()) return joints;
  std::vector<bool> is_given(scene.bodies.size());
  for (const uint32_t slot : given) is_given[slot] = true;
  const auto has = [&](uint32_t body) { return body != no_body && is_given[body]; };
  for (uint32_t k = 0; k < scene.joints.size(); ++k)
    if (has(scene.joints[k].body_a) || has(scene.joints[k].body_b)) joints.push_back(k);
  return joints;
}

void World::Implementation::set_joints(std::span<const JointId> ids, std::span<const Joint> given)
{
  if (ids.size() != given.size())
    throw InputError(fmt::format("set_joints: {} handles and {} joints; one joint for each handle is needed",
                                 ids.size(), given.size()));
  settle_joints();
  const std::vector<uint32_t> changed = slots_of_joints("set_joints", ids);
  refuse_articulated("set_joints", "set_joint_axes alone can change it", changed);
  std::vector<Joint> joints = scene.joints;
  for (size_t i = 0; i < given.size(); ++i) {
    validate(scene, given[i], i, "set_joints");
    check_joined_bodies("set_joints", i, given[i]);
    check_joint_beside_links(links, given[i], i, "set_joints");
    const Joint &before = std::exchange(joints[changed[i]], given[i]);
    if (before.type != given[i].type || before.body_a != given[i].body_a || before.body_b != given[i].body_b ||
        !(held_by(before) == held_by(given[i])))
      refuse_coupled("set_joints", "its type, its bodies and what it holds cannot change", std::span(&changed[i], 1));
    if (before.type != given[i].type || !(held_by(before) == held_by(given[i])))
      refuse_driven("set_joints", "its type and what it holds cannot change", std::span(&changed[i], 1));
  }
  if (!ids.empty()) put_joints(std::move(joints), joint_slots, changed);
}

/* Scene::bodies keeps bodies that were destroyed. */
void World::Implementation::check_joined_bodies(const char *call, size_t entry, const Joint &joint) const
{
  for (const uint32_t body : {joint.body_a, joint.body_b})
    if (body != no_body && !slots.exists(body))
      throw InputError(
          fmt::format("{}: entry {}: body {} does not exist any more; it was destroyed", call, entry, body));
  if (joint.body_a == no_body && joint.body_b == no_body)
    throw InputError(fmt::format("{}: entry {}: it has no body; name body_a or body_b", call, entry));
}

std::vector<uint32_t> World::Implementation::slots_of_joints(const char *call, std::span<const JointId> ids) const
{
  std::vector<uint32_t> found;
  for (const JointId &id : ids) found.push_back(present_joint_slots().slot_of(call, id));
  return found;
}

/* Messages of a batch name the world, which is found only where one is needed. */
template <class Check>
void World::Implementation::check_in_world(const Joint &joint, uint32_t slot, const Check &check) const
{
  try {
    check(slot, "set_joint_axes");
  } catch (const InputError &) {
    if (is_batch()) check(joint_in_message(slot), call_in_message("set_joint_axes", some_body_of(joint)));
    throw;
  }
}

void World::Implementation::check_axes(const Joint &joint, uint32_t slot) const
{
  check_in_world(joint, slot,
                 [&](uint32_t number, const std::string &where) { validate(scene, joint, number, where); });
}

namespace {

bool has_same_axes(const Joint &one, const Joint &other)
{
  return one.directions == other.directions && one.rotations == other.rotations;
}

} // namespace

void World::Implementation::set_joint_axes(std::span<const JointId> ids, std::span<const JointAxisChange> changes)
{
  if (ids.size() != changes.size())
    throw InputError(fmt::format("set_joint_axes: {} handles and {} changes; one change for each handle is needed",
                                 ids.size(), changes.size()));
  settle_joints();
  const std::vector<uint32_t> changed = slots_of_joints("set_joint_axes", ids);
  std::vector<Joint> joints;
  std::map<uint32_t, size_t> of_slot;
  for (size_t i = 0; i < changes.size(); ++i) {
    if (changes[i].axis >= 6) refuse_axis("set_joint_axes", i, changes[i].axis);
    const auto [at, is_new] = of_slot.try_emplace(changed[i], joints.size());
    if (is_new) joints.push_back(scene.joints[changed[i]]);
    axis_of(joints[at->second], changes[i].axis) = changes[i].to;
    check_axes(joints[at->second], changed[i]);
  }
  if (ids.empty()) return;
  for (const auto &[slot, k] : of_slot)
    check_in_world(joints[k], slot, [&, &joint = joints[k], &slot = slot](uint32_t number, const std::string &where) {
      if (is_in_tree(slot)) check_joint_of_tree(joint, number, where);
      else check_joint_beside_links(links, joint, number, where);
    });
  std::vector<uint32_t> distinct;
  std::vector<Joint> in_order;
  for (const auto &[slot, k] : of_slot)
    if (!has_same_axes(joints[k], scene.joints[slot])) distinct.push_back(slot), in_order.push_back(joints[k]);
  if (distinct.empty()) return; /* so nobody wakes */
  write_joint_axes(distinct, std::move(in_order));
}

/* slots: ascending, each with its joint. */
void World::Implementation::write_joint_axes(std::span<const uint32_t> changed, std::vector<Joint> joints)
{
  bool fits = true;
  for (size_t k = 0; k < changed.size(); ++k)
    fits = fits && kinds_used_by(scene.joints[changed[k]]) == kinds_used_by(joints[k]) &&
           has_rows_besides_tree(scene.joints[changed[k]]) == has_rows_besides_tree(joints[k]) &&
           (features_of(joints[k]) & ~scene_features) == 0;
  if (!fits && is_batch())
    throw InputError(fmt::format("{}: joint {}: an axis would come or go, or begin to bounce, which a batch of worlds "
                                 "has no room for; in a batch, axes that are limited, driven or braked stay so, and "
                                 "others do not become so",
                                 call_in_message("set_joint_axes", some_body_of(scene.joints[changed.front()])),
                                 joint_in_message(changed.front())));
  if (!fits) {
    std::vector<Joint> all = scene.joints;
    for (size_t k = 0; k < changed.size(); ++k) all[changed[k]] = std::move(joints[k]);
    return put_joints(std::move(all), joint_slots, changed);
  }
  settle();
  disturb_joined(joints);
  buffers.make_ready(sizes());
  const auto exchange = [&]() noexcept {
    for (size_t k = 0; k < changed.size(); ++k) std::swap(scene.joints[changed[k]], joints[k]);
  };
  StagedUploads uploads;
  exchange();
  try {
    stage_changed_axes(uploads, changed);
    uploads.prepare(memory);
  } catch (...) {
    exchange();
    throw;
  }
  ++state;
  uploads.write(memory);
  joints_number = ++joints_numbers;
}

/* A transfer takes as long as some thousands of rows, so many joints are written with all others. */
void World::Implementation::stage_changed_axes(StagedUploads &uploads, std::span<const uint32_t> changed) const
{
  constexpr size_t few = 16;
  const bool in_trees = std::any_of(changed.begin(), changed.end(), [&](uint32_t joint) { return is_in_tree(joint); });
  if (in_trees) stage_link_axes(uploads, scene, changed.size() > few ? std::span<const uint32_t>{} : changed, links);
  if (changed.size() > few) return stage_axes(uploads, scene, joint_order.joints(), joint_graph.axes);
  for (const uint32_t joint : changed)
    stage_axes_at(uploads, scene.joints[joint], joint_order.place_of(joint), scene.joints.size());
}

/* The last step has counted them; their loads are still in the buffers. */
std::vector<uint32_t> World::Implementation::list_broken_joints()
{
  joint_breaks.clear();
  if (!(scene_features & FEATURE_JOINT_BREAKS) || plan.known[COUNT_BROKEN_JOINTS] == 0) return {};
  const std::span<const uint32_t> awake = joint_order.awake();
  const auto loads = memory.read<float4>(Buffer::joint_load, awake.size());
  std::vector<uint32_t> broken;
  for (size_t place = 0; place < awake.size(); ++place) {
    const Joint &joint = scene.joints[awake[place]];
    if (!(loads[place].x > joint.break_force || loads[place].y > joint.break_torque)) continue;
    broken.push_back(awake[place]);
    joint_breaks.push_back({joint_slots.id_of(awake[place]), loads[place].x, loads[place].y});
  }
  std::sort(joint_breaks.begin(), joint_breaks.end(),
            [](const JointBreak &one, const JointBreak &other) { return one.joint.index < other.joint.index; });
  return broken;
}

/* Contacts keep their colours, or lose them, before the next step. */
void World::Implementation::break_joints(std::span<const uint32_t> broken)
{
  std::vector<Joint> joints = scene.joints;
  for (const uint32_t joint : broken) joints[joint].enabled = false;
  put_joints(std::move(joints), joint_slots, broken);
}

} // namespace tandem
