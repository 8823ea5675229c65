/* worlds_group.cpp - a group of worlds in the numbers of its one World; see worlds_group.h. */
#include "host/world/worlds_group.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "host/base/out_of_memory.h"
#include "host/runtime/interface/floating_point.h"
#include "host/scene/built.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"

namespace tandem {
namespace {

Settings settings_of_batch(Settings settings)
{
  settings.broadphase = Broadphase::brute_force; /* within each world */
  return settings;
}

} // namespace

Worlds::Group::Group(std::span<const Scene> scenes, uint32_t copies, const Settings &given, const Placement &placement,
                     uint32_t first_world)
    : settings(given)
{
  const minicl::ExactFloatingPoint environment;
  bodies = static_cast<uint32_t>(scenes.front().bodies.size());
  Scene all;
  all.name = scenes.front().name;
  all.materials.clear();
  for (const Scene &scene : scenes) {
    const Features own = features_of(scene, settings);
    check_built(own, scene, settings, scene.name);
    for (uint32_t copy = 0; copy < copies; ++copy) {
      tables.add(scene, all);
      gravity.push_back(scene.gravity);
      features.push_back(own);
    }
  }
  started.resize(tables.worlds());
  entered.resize(tables.worlds());
  changed.resize(tables.worlds());
  forced.resize(tables.worlds());
  const Settings used = settings_of_batch(settings);
  Specialisation special = specialise_worlds(all, tables.worlds(), used);
  const auto count = static_cast<uint32_t>(all.bodies.size());
  const uint32_t pairs = first_capacity(all, used);
  world.reset(new World(std::make_unique<World::Implementation>(
      World::Implementation::Beginning{std::move(all), used, std::move(special), BodySlots(count), count, pairs, false},
      placement)));
  engine().first_world = first_world;
  joints = WorldJoints(engine().scene, engine().joint_graph, engine().coupling_graph, tables.worlds());
  for (const Joint &joint : engine().scene.joints) enabled_at_start.push_back(joint.enabled);
  upload_batch();
}

/* Bodies of a batch are never destroyed, so all have their first handles. */
std::vector<BodyId> Worlds::Group::ids_of(std::span<const WorldBody> given) const
{
  std::vector<BodyId> ids;
  ids.reserve(given.size());
  for (const auto &[number, body] : given) ids.push_back({number * bodies + body, 1});
  return ids;
}

/* The same of joints. */
std::vector<JointId> Worlds::Group::ids_of(std::span<const WorldJoint> given) const
{
  std::vector<JointId> ids;
  ids.reserve(given.size());
  for (const auto &[number, joint] : given) ids.push_back({tables.first_joint(number) + joint, 1});
  return ids;
}

WorldPlace Worlds::Group::place_of(uint32_t number)
{
  return {number * bodies, bodies, steps(number) == 0, present_joints().of(number)};
}

Scene Worlds::Group::scene(uint32_t number)
{
  write_controls();
  return tables.scene_of(number, engine().scene, bodies, gravity[number]);
}

void Worlds::Group::take_back(Mark &mark) noexcept
{
  engine().take_calls_back(mark.calls);
  for (size_t number = 0; number < forced.size(); ++number) forced[number] = mark.forced[number];
}

/* A step in which joints break writes all joints as the scene has them. */
void Worlds::Group::attempt_step(const StepLimits &limits)
{
  if (engine().scene_features & FEATURE_JOINT_BREAKS) write_controls();
  engine().attempt_step(limits);
}

void Worlds::Group::add_impulses(std::span<const WorldBody> given, std::span<const Impulse> impulses)
{
  const std::vector<BodyId> ids = ids_of(given);
  world->add_impulses(ids, impulses);
  for (size_t k = 0; k < ids.size(); ++k) /* on a link it acts as a force */
    if (engine().links.has_body(ids[k].index)) forced[given[k].world] = true;
}

void Worlds::Group::add_forces(std::span<const WorldBody> given, std::span<const Force> forces)
{
  world->add_forces(ids_of(given), forces);
  for (const WorldBody &body : given) forced[body.world] = true;
}

void Worlds::Group::refuse_bases(const char *call, std::span<const WorldBody> given) const
{
  std::vector<uint32_t> slots;
  for (const BodyId &id : ids_of(given)) slots.push_back(id.index);
  engine().refuse_bases(call, slots);
}

void Worlds::Group::set_joint_axes(std::span<const WorldJoint> given, std::span<const JointAxisChange> changes)
{
  write_controls();
  world->set_joint_axes(ids_of(given), changes);
}

/* What these axes are now. */
std::vector<JointAxisChange> Worlds::Group::axes_of(std::span<const WorldJoint> given,
                                                    std::span<const JointAxisChange> changes)
{
  write_controls();
  const std::vector<JointId> ids = ids_of(given);
  std::vector<JointAxisChange> axes;
  for (size_t k = 0; k < ids.size(); ++k)
    axes.push_back({changes[k].axis, axis_of(engine().scene.joints[ids[k].index], changes[k].axis)});
  return axes;
}

/* Materials are those of the scene of the body's world. */
std::vector<BodyProperties> Worlds::Group::in_all(std::span<const WorldBody> given,
                                                  std::span<const BodyProperties> properties) const
{
  std::vector<BodyProperties> of_all(properties.begin(), properties.end());
  for (size_t k = 0; k < of_all.size(); ++k)
    if (of_all[k].material) *of_all[k].material += tables.first_material(given[k].world);
  return of_all;
}

void Worlds::Group::check_properties(std::span<const WorldBody> given, std::span<const BodyProperties> properties)
{
  engine().check_properties(ids_of(given), in_all(given, properties));
}

/* A feature that properties bring has all joints written anew, as the scene has them. */
void Worlds::Group::set_properties(std::span<const WorldBody> given, std::span<const BodyProperties> properties)
{
  const std::vector<BodyId> ids = ids_of(given);
  write_controls();
  world->set_properties(ids, in_all(given, properties));
  upload_starts(ids);
  note_properties(given);
}

void Worlds::Group::note_properties(std::span<const WorldBody> given)
{
  std::set<uint32_t> worlds;
  for (const WorldBody &body : given) worlds.insert(body.world);
  for (const uint32_t number : worlds) {
    features[number] |= features_of(scene(number), settings);
    changed[number] = true;
  }
}

namespace {

/* The bodies that decide the world of an event, and are numbered within it. */
template <class Event> uint32_t &first_body_of(Event &event) { return event.a; }
uint32_t &first_body_of(uint32_t &body) { return body; }
template <class Event> void number_from(uint32_t first, Event &event)
{
  event.a -= first;
  event.b -= first;
}
void number_from(uint32_t first, uint32_t &body) { body -= first; }

} // namespace

/* Events are sorted by body, so those of a world follow one another. */
template <class Event> WorldEvents<Event> Worlds::Group::by_world(std::vector<Event> events) const
{
  WorldEvents<Event> result;
  result.first.push_back(0);
  size_t at = 0;
  for (uint32_t number = 0; number < tables.worlds(); ++number) {
    const uint32_t end = (number + 1) * bodies;
    for (; at < events.size() && first_body_of(events[at]) < end; ++at) {
      if (engine().statistics.steps == entered[number]) continue;
      result.all.push_back(std::move(events[at]));
      number_from(number * bodies, result.all.back());
    }
    result.first.push_back(result.all.size());
  }
  return result;
}

WorldEvents<ContactEvent> Worlds::Group::contact_events() { return by_world(world->contact_events()); }
WorldEvents<HitEvent> Worlds::Group::hit_events() { return by_world(world->hit_events()); }
WorldEvents<PairEvent> Worlds::Group::pair_events() { return by_world(world->pair_events()); }
WorldEvents<uint32_t> Worlds::Group::moved_bodies() { return by_world(world->moved_bodies()); }

} // namespace tandem
