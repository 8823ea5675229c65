/* properties.cpp - properties of bodies that change while a world runs.
 *
 * The scene has the new values at once, and the rows of the bodies that follow from them are written: mass, flags,
 * filters. The inverse mass and the gravity factor also stand in the rows of the velocity; a command sets them there.
 * A feature or a material that the world lacks lays the buffers out anew, as a new body that brings one does
 * (bodies.cpp).
 */
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/scene/articulation_buffers.h"
#include "host/scene/built.h"
#include "host/scene/joint_buffers.h"
#include "host/world/implementation.h"
#include "host/world/placed_bodies.h"
#include "shared/commands/command_codes.h"

namespace tandem {
namespace {

/* Rows between two that change are written with them if they are so few: a transfer takes longer. */
constexpr uint32_t most_between = 32;

template <class T> void take(const std::optional<T> &given, T &field)
{
  if (given) field = *given;
}

void change(Body &body, const BodyProperties &properties)
{
  take(properties.type, body.type);
  take(properties.trigger, body.trigger);
  take(properties.continuous, body.continuous);
  take(properties.material, body.material);
  take(properties.mass, body.mass);
  take(properties.inertia, body.inertia);
  take(properties.infinite_inertia, body.infinite_inertia);
  take(properties.gravity_factor, body.gravity_factor);
  take(properties.linear_damping, body.linear_damping);
  take(properties.angular_damping, body.angular_damping);
  take(properties.filter_group, body.filter_group);
  take(properties.filter_mask, body.filter_mask);
  take(properties.linear_locks, body.linear_locks);
  take(properties.angular_locks, body.angular_locks);
  take(properties.max_linear_speed, body.max_linear_speed);
  take(properties.max_angular_speed, body.max_angular_speed);
  take(properties.user_data, body.user_data);
}

/* The worlds of a batch, which messages name: their bodies, 0 if it is none, and the number of the first one. */
struct WorldsOfMessage {
  uint32_t bodies, first;
};

void check_changed(const Scene &scene, const Settings &settings, const Body &body, uint32_t slot,
                   const WorldsOfMessage &worlds)
{
  const auto check = [&](uint32_t number, const std::string &where) {
    validate(scene, body, number, where);
    check_solver(settings, body, number, where);
  };
  try {
    check(slot, "set_properties");
  } catch (const InputError &) {
    if (worlds.bodies > 0)
      check(slot % worlds.bodies, fmt::format("set_properties: world {}", worlds.first + slot / worlds.bodies));
    throw;
  }
}

/* Several entries for one body are taken in their order. */
ChangedBodies bodies_with(const Scene &scene, const Settings &settings, std::span<const uint32_t> slots,
                          std::span<const BodyProperties> properties, const WorldsOfMessage &worlds)
{
  std::map<uint32_t, Body> changed;
  for (size_t i = 0; i < slots.size(); ++i) {
    Body &body = changed.try_emplace(slots[i], scene.bodies[slots[i]]).first->second;
    change(body, properties[i]);
    check_changed(scene, settings, body, slots[i], worlds);
  }
  ChangedBodies result;
  for (auto &[slot, body] : changed) {
    result.slots.push_back(slot);
    result.bodies.push_back(std::move(body));
  }
  return result;
}

/* The bodies that become dynamic. */
std::vector<uint32_t> freed_by(const Scene &scene, const ChangedBodies &changed)
{
  std::vector<uint32_t> freed;
  for (size_t i = 0; i < changed.slots.size(); ++i)
    if (changed.bodies[i].type == BodyType::dynamic && scene.bodies[changed.slots[i]].type != BodyType::dynamic)
      freed.push_back(changed.slots[i]);
  return freed;
}

std::vector<uint32_t> retyped_by(const Scene &scene, const ChangedBodies &changed)
{
  std::vector<uint32_t> retyped;
  for (size_t i = 0; i < changed.slots.size(); ++i)
    if (changed.bodies[i].type != scene.bodies[changed.slots[i]].type) retyped.push_back(changed.slots[i]);
  return retyped;
}

/* Calls work(first, end) for each range of indices that is written at once. */
template <class Work> void for_each_range(std::span<const uint32_t> sorted, const Work &work)
{
  for (size_t at = 0; at < sorted.size();) {
    size_t last = at;
    while (last + 1 < sorted.size() && sorted[last + 1] - sorted[last] <= most_between) ++last;
    work(sorted[at], sorted[last] + 1);
    at = last + 1;
  }
}

bool changes_mass(const BodyProperties &properties)
{
  return properties.mass || properties.inertia || properties.infinite_inertia;
}

CommandList::Rows mass_command_of(const Body &body)
{
  const float keeps = body.type == BodyType::fixed ? 0 : 1;
  return {float4{inverse_mass_of(body), body.gravity_factor, keeps, 0}, float4{0, 0, 0, 0}, float4{0, 0, 0, 0}};
}

} // namespace

BodyProperties properties_of(const Body &body)
{
  return {body.type,           body.trigger,         body.continuous,       body.material,
          body.mass,           body.inertia,         body.infinite_inertia, body.gravity_factor,
          body.linear_damping, body.angular_damping, body.filter_group,     body.filter_mask,
          body.linear_locks,   body.angular_locks,   body.max_linear_speed, body.max_angular_speed,
          body.user_data};
}

/* Throws InputError if a world with these bodies cannot be. */
ChangedBodies World::Implementation::changed_by(std::span<const BodyId> ids, std::span<const BodyProperties> properties)
{
  if (ids.size() != properties.size())
    throw InputError(fmt::format("set_properties: {} handles and {} entries; one entry for each handle is needed",
                                 ids.size(), properties.size()));
  std::vector<uint32_t> given;
  for (const BodyId &id : ids) given.push_back(slots.slot_of("set_properties", id));
  settle_joints();
  ChangedBodies changed =
      bodies_with(scene, settings, given, properties, {is_batch() ? bodies_of_world() : 0, first_world});
  if (is_batch()) refuse_joined("set_properties", "its type cannot change in a batch", retyped_by(scene, changed));
  const std::vector<uint32_t> retyped = joints_of_bodies(retyped_by(scene, changed));
  refuse_coupled("set_properties", "the type of its bodies cannot change", retyped);
  refuse_articulated("set_properties", "the type of its bodies cannot change", retyped);
  refuse_idle_joints(retyped, changed.slots, changed.bodies);
  refuse_for_links(changed.slots, changed.bodies);
  if (!ids.empty()) refuse_unbuilt(changed.slots, changed.bodies);
  return changed;
}

void World::Implementation::check_properties(std::span<const BodyId> ids, std::span<const BodyProperties> properties)
{
  changed_by(ids, properties);
}

void World::Implementation::set_properties(std::span<const BodyId> ids, std::span<const BodyProperties> properties)
{
  const ChangedBodies changed = changed_by(ids, properties); /* before anything wakes */
  if (ids.empty()) return;
  const std::vector<uint32_t> retyped = joints_of_bodies(retyped_by(scene, changed));
  settle(); /* what was called before comes before */
  wake_bodies(changed.slots, true);
  buffers.make_ready(sizes());
  commands.prepare(changed.slots.size());
  const std::vector<uint32_t> freed = freed_by(scene, changed);
  PlacedBodies placed(scene, changed.slots, changed.bodies);
  try {
    const bool weighs_anew = std::any_of(properties.begin(), properties.end(), changes_mass);
    if (brings_features(changed.slots)) lay_out_anew();
    else write_properties(changed.slots, weighs_anew);
  } catch (...) {
    known_kinds.clear(); /* some may be of these bodies alone */
    throw;
  }
  placed.keep();
  std::for_each(changed.slots.begin(), changed.slots.end(), [&](uint32_t slot) { plan_for_body(slot); });
  ring.forget("properties of bodies were changed");
  color_anew(freed, retyped);
  for (const uint32_t slot : changed.slots)
    if (slots.status()[slot] != BodyStatus::quarantined)
      commands.add(slot, COMMAND_SET_MASS, mass_command_of(scene.bodies[slot]));
}

/* Tables of articulations have masses and moments, and a step has no damping of links, nor highest speeds. */
void World::Implementation::refuse_for_links(std::span<const uint32_t> changed, std::span<const Body> changed_bodies)
{
  if (std::none_of(changed.begin(), changed.end(), [&](uint32_t slot) { return links.has_body(slot); })) return;
  for (size_t k = 0; k < changed.size(); ++k) {
    const Body &now = changed_bodies[k], &before = scene.bodies[changed[k]];
    if (now.mass != before.mass || now.inertia != before.inertia || now.linear_locks != before.linear_locks ||
        now.angular_locks != before.angular_locks)
      refuse_linked("set_properties", "its mass, moments and locks cannot change", changed.subspan(k, 1));
  }
  const PlacedBodies tried(scene, changed, changed_bodies);
  check_articulations(scene, "set_properties");
}

/* Bodies have other types, so their contacts and joints get other colours. The types stand already: without the colours
 * two constraints of one colour would push one body. */
void World::Implementation::color_anew(std::span<const uint32_t> freed, std::span<const uint32_t> joints)
{
  try {
    forget_colors(freed);
    if (!joints.empty()) put_joints(scene.joints, joint_slots, joints);
    if (settings.sleeping) recount_motion();
  } catch (const std::exception &error) {
    lost = fmt::format("set_properties: what bodies of other types touch and hold could not be coloured anew ({}); the "
                       "world cannot go on, and restore() makes it what it was when it was saved",
                       error.what());
    throw;
  }
}

/* A joint needs a dynamic body. */
void World::Implementation::refuse_idle_joints(std::span<const uint32_t> joints, std::span<const uint32_t> changed,
                                               std::span<const Body> changed_bodies)
{
  if (joints.empty()) return;
  const PlacedBodies tried(scene, changed, changed_bodies);
  for (const uint32_t joint : joints)
    if (scene.joints[joint].enabled && !can_be_pushed(scene, scene.joints[joint].body_a) &&
        !can_be_pushed(scene, scene.joints[joint].body_b))
      throw InputError(fmt::format("set_properties: joint {} would have no dynamic body; destroy it first, or set it "
                                   "to be not enabled",
                                   joint));
}

/* Throws InputError if the world with these bodies needs what the library is built without. */
void World::Implementation::refuse_unbuilt(std::span<const uint32_t> changed, std::span<const Body> changed_bodies)
{
  const auto is_known = [&](const Body &body) { return known_kinds.contains(kind_of(scene, body)); };
  if (std::all_of(changed_bodies.begin(), changed_bodies.end(), is_known)) return;
  const PlacedBodies tried(scene, changed, changed_bodies);
  check_built(features_of(scene, settings), scene, settings, scene.name);
}

/* Contacts of a body that cannot be pushed may share a colour, which they must not keep when it can be. */
void World::Implementation::forget_colors(std::span<const uint32_t> freed) { put_colors(colors_without(freed)); }

/* The colours of all contacts, of which those of these bodies have none; empty: they stay. */
std::vector<uint32_t> World::Implementation::colors_without(std::span<const uint32_t> freed)
{
  if (freed.empty()) return {};
  std::vector<bool> is_freed(special.awake);
  for (const uint32_t slot : freed)
    if (index_of_body[slot] < special.awake) is_freed[index_of_body[slot]] = true;
  const auto starts = memory.read<uint32_t>(Buffer::cached_start, size_t{special.awake} + 1);
  const auto partners = memory.read<uint32_t>(Buffer::cached_b, starts.back());
  auto colors = memory.read<uint32_t>(Buffer::cached_color, starts.back());
  const auto touches = [&](uint32_t body, uint32_t pair) {
    return is_freed[body] || (partners[pair] < is_freed.size() && is_freed[partners[pair]]);
  };
  for (uint32_t body = 0; body < special.awake; ++body)
    for (uint32_t pair = starts[body]; pair < starts[body + 1]; ++pair)
      if (touches(body, pair) && colors[pair] < COLOR_NONE) colors[pair] = COLOR_NONE;
  return colors;
}

void World::Implementation::put_colors(const std::vector<uint32_t> &colors)
{
  if (!colors.empty()) memory.upload(Buffer::cached_color, colors.data(), colors.size() * sizeof(uint32_t));
}

/* weighs_anew: whether some have another mass or other moments, from which it follows how much of each error their
 * joints take. */
void World::Implementation::write_properties(std::span<const uint32_t> changed, bool weighs_anew)
{
  std::vector<uint32_t> indices;
  for (const uint32_t slot : changed) indices.push_back(index_of_body[slot]);
  std::sort(indices.begin(), indices.end());
  StagedUploads uploads;
  for_each_range(indices, [&](uint32_t first, uint32_t end) {
    stage_properties(uploads, scene, std::span(special.order).subspan(first, end - first), first, slots.status());
  });
  for (const uint32_t slot : changed)
    if (scene.shapes[scene.bodies[slot].shape].compound) {
      const size_t entry = 2 * size_t{index_of_body[slot]} + 1; /* of body_tree: the first child */
      stage_child_properties(uploads, scene, slot, memory.read<uint32_t>(Buffer::body_tree, 1, entry).front(),
                             slots.status());
    }
  const auto is_joined = [&](uint32_t slot) { return !joint_order.of_body(slot).empty(); };
  if (weighs_anew && std::any_of(changed.begin(), changed.end(), is_joined))
    stage_joints(uploads, scene, joint_graph, joint_order.joints(), index_of_body, plan.bodies);
  uploads.prepare(memory);
  ++state;
  uploads.write(memory);
  forget_kept(memory);
}

} // namespace tandem
