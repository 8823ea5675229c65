/* worlds.cpp - the functions of <tandem/worlds.h>: calls and answers in the numbers of worlds and their bodies. */
#include "host/world/worlds.h"

#include <algorithm>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "host/base/out_of_memory.h"
#include "host/runtime/interface/floating_point.h"
#include "host/scene/built.h"
#include "host/scene/joint_buffers.h"

namespace tandem {
namespace {

Settings settings_of_batch(Settings settings)
{
  settings.broadphase = Broadphase::brute_force; /* within each world */
  return settings;
}

void check_scenes(std::span<const Scene> scenes, uint32_t copies)
{
  if (scenes.empty() || copies == 0) throw InputError("worlds: 0 worlds; at least 1 is needed");
  for (size_t k = 0; k < scenes.size(); ++k) {
    validate(scenes[k], scenes[k].name);
    if (scenes[k].bodies.size() != scenes.front().bodies.size())
      throw InputError(
          fmt::format("worlds: scene {} ('{}') has {} bodies and scene 0 has {}; the worlds of a batch have "
                      "equally many",
                      k, scenes[k].name, scenes[k].bodies.size(), scenes.front().bodies.size()));
  }
  const uint64_t worlds = uint64_t{copies} * scenes.size(), bodies = worlds * scenes.front().bodies.size();
  if (bodies >= body_numbers)
    throw InputError(fmt::format("worlds: {} worlds of {} bodies are {} bodies; kernels can number {}", worlds,
                                 scenes.front().bodies.size(), bodies, body_numbers - 1));
}

} // namespace

void check_batch_settings(const Settings &settings)
{
  const auto refuse = [](const char *what, const char *instead) {
    throw InputError(fmt::format("worlds: {}: a batch of worlds has {}", what, instead));
  };
  if (settings.substeps == automatic_substeps) refuse("substeps auto", "a number of substeps, the same for all");
  if (settings.sleeping) refuse("sleeping", "no bodies that sleep");
  if (settings.solver != Solver::soft_step) refuse(name_of(settings.solver), "the solver soft-step alone");
  if (settings.batching != Batching::coloring) refuse(name_of(settings.batching), "the batching coloring alone");
  if (settings.broadphase != Broadphase::automatic)
    refuse(name_of(settings.broadphase), "the broadphase auto alone, which looks within each world");
  if (settings.check) refuse("check", "no check of batches; a world alone has it");
  if (!settings.extensions.empty()) refuse("extensions", "no modules");
}

Worlds::Implementation::Implementation(std::span<const Scene> scenes, uint32_t copies, const Settings &given,
                                       const Placement &placement)
    : settings(given)
{
  const minicl::ExactFloatingPoint environment;
  validate(settings);
  check_batch_settings(settings);
  check_scenes(scenes, copies);
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
  if (all.materials.size() > MOST_MATERIALS)
    throw InputError(fmt::format("worlds: the scenes have {} materials; at most {} in all, and scenes that follow one "
                                 "another and have the same count once",
                                 all.materials.size(), MOST_MATERIALS));
  const Settings used = settings_of_batch(settings);
  Specialisation special = specialise_worlds(all, tables.worlds(), used);
  const auto count = static_cast<uint32_t>(all.bodies.size());
  const uint32_t pairs = first_capacity(all, used);
  world.reset(new World(std::make_unique<World::Implementation>(
      World::Implementation::Beginning{std::move(all), used, std::move(special), BodySlots(count), count, pairs, false},
      placement)));
  joints = WorldJoints(engine().scene, engine().joint_graph, engine().coupling_graph, tables.worlds());
  for (const Joint &joint : engine().scene.joints) enabled_at_start.push_back(joint.enabled);
  upload_batch();
}

void Worlds::Implementation::check_world(const char *call, uint32_t number) const
{
  if (number >= tables.worlds())
    throw InputError(fmt::format("{}: world {} does not exist; there are {}", call, number, tables.worlds()));
}

/* Bodies of a batch are never destroyed, so all have their first handles. */
std::vector<BodyId> Worlds::Implementation::ids_of(const char *call, std::span<const WorldBody> given) const
{
  std::vector<BodyId> ids;
  ids.reserve(given.size());
  for (const auto &[number, body] : given) {
    check_world(call, number);
    if (body >= bodies)
      throw InputError(
          fmt::format("{}: entry {}: body {} does not exist; worlds have {} bodies", call, ids.size(), body, bodies));
    ids.push_back({number * bodies + body, 1});
  }
  return ids;
}

/* The same of joints. */
std::vector<JointId> Worlds::Implementation::ids_of(const char *call, std::span<const WorldJoint> given) const
{
  std::vector<JointId> ids;
  ids.reserve(given.size());
  for (const auto &[number, joint] : given) {
    check_world(call, number);
    if (joint >= tables.joints(number))
      throw InputError(fmt::format("{}: entry {}: joint {} does not exist; world {} has {} joints", call, ids.size(),
                                   joint, number, tables.joints(number)));
    ids.push_back({tables.first_joint(number) + joint, 1});
  }
  return ids;
}

WorldPlace Worlds::Implementation::place_of(uint32_t number)
{
  return {number * bodies, bodies, steps(number) == 0, present_joints().of(number)};
}

Scene Worlds::Implementation::scene(uint32_t number)
{
  write_controls();
  return tables.scene_of(number, engine().scene, bodies, gravity[number]);
}

Worlds::Worlds(const Scene &scene, uint32_t worlds, const Settings &settings, const Placement &placement)
    : implementation_(naming_what_failed(
          [&] { return fmt::format("out of memory: {} worlds of {} bodies", worlds, scene.bodies.size()); },
          [&] { return std::make_unique<Implementation>(std::span(&scene, 1), worlds, settings, placement); }))
{}

Worlds::Worlds(std::span<const Scene> scenes, const Settings &settings, const Placement &placement)
    : implementation_(
          naming_what_failed([&] { return fmt::format("out of memory: worlds of {} scenes", scenes.size()); },
                             [&] { return std::make_unique<Implementation>(scenes, 1, settings, placement); }))
{}

Worlds::~Worlds() = default;

uint32_t Worlds::count() const { return implementation_->tables.worlds(); }
uint32_t Worlds::bodies_of_world() const { return implementation_->bodies; }
const Settings &Worlds::settings() const { return implementation_->settings; }

Scene Worlds::scene(uint32_t world) const
{
  implementation_->check_world("scene", world);
  return implementation_->scene(world);
}

/* A step in which joints break writes all joints as the scene has them. */
void Worlds::step(const StepLimits &limits)
{
  if (implementation_->engine().scene_features & FEATURE_JOINT_BREAKS) implementation_->write_controls();
  implementation_->world->step(limits);
}

uint64_t Worlds::steps(uint32_t world) const
{
  implementation_->check_world("steps", world);
  return implementation_->steps(world);
}

void Worlds::reset(std::span<const uint32_t> worlds)
{
  for (const uint32_t world : worlds) implementation_->check_world("reset", world);
  implementation_->reset(worlds);
}

void Worlds::reset(std::span<const uint32_t> worlds, std::span<const BodyState> states)
{
  const uint32_t bodies = bodies_of_world();
  if (states.size() != worlds.size() * bodies)
    throw InputError(fmt::format("reset: {} states of {} worlds of {} bodies; one of each body is needed",
                                 states.size(), worlds.size(), bodies));
  std::vector<WorldBody> put;
  for (const uint32_t world : worlds)
    for (uint32_t body = 0; body < bodies; ++body) put.push_back({world, body});
  implementation_->engine().check_states("reset", implementation_->ids_of("reset", put), states);
  reset(worlds);
  set_states(put, states);
}

std::vector<BodyState> Worlds::bodies() { return implementation_->world->bodies(); }

std::vector<BodyState> Worlds::bodies(uint32_t world)
{
  std::vector<WorldBody> all;
  for (uint32_t body = 0; body < bodies_of_world(); ++body) all.push_back({world, body});
  return implementation_->world->read_bodies(implementation_->ids_of("bodies", all));
}

const std::vector<WorldBody> &Worlds::every_body() const
{
  std::vector<WorldBody> &all = implementation_->every_body;
  if (all.empty())
    for (uint32_t world = 0; world < count(); ++world)
      for (uint32_t body = 0; body < bodies_of_world(); ++body) all.push_back({world, body});
  return all;
}

void Worlds::set_states(std::span<const WorldBody> bodies, std::span<const BodyState> states)
{
  implementation_->world->set_states(implementation_->ids_of("set_states", bodies), states);
}

void Worlds::set_velocities(std::span<const WorldBody> bodies, std::span<const Velocity> velocities)
{
  implementation_->world->set_velocities(implementation_->ids_of("set_velocities", bodies), velocities);
}

void Worlds::move_to(std::span<const WorldBody> bodies, std::span<const Pose> poses)
{
  implementation_->world->move_to(implementation_->ids_of("move_to", bodies), poses);
}

void Worlds::add_impulses(std::span<const WorldBody> bodies, std::span<const Impulse> impulses)
{
  const std::vector<BodyId> ids = implementation_->ids_of("add_impulses", bodies);
  implementation_->world->add_impulses(ids, impulses);
  for (size_t k = 0; k < ids.size(); ++k) /* on a link it acts as a force */
    if (implementation_->engine().links.has_body(ids[k].index)) implementation_->forced[bodies[k].world] = true;
}

void Worlds::add_forces(std::span<const WorldBody> bodies, std::span<const Force> forces)
{
  implementation_->world->add_forces(implementation_->ids_of("add_forces", bodies), forces);
  for (const WorldBody &body : bodies) implementation_->forced[body.world] = true;
}

void Worlds::set_joint_axes(std::span<const WorldJoint> joints, std::span<const JointAxisChange> changes)
{
  implementation_->write_controls();
  implementation_->world->set_joint_axes(implementation_->ids_of("set_joint_axes", joints), changes);
}

void Worlds::choose_controls(std::span<const ControlledAxis> axes)
{
  const minicl::ExactFloatingPoint environment;
  implementation_->write_controls();
  implementation_->controls = Controls(implementation_->engine(), implementation_->tables, axes);
}

void Worlds::choose_controls(std::span<const Actuator> actuators)
{
  const minicl::ExactFloatingPoint environment;
  implementation_->write_controls();
  implementation_->controls = Controls(implementation_->engine(), implementation_->tables, actuators);
}

void Worlds::set_controls(std::span<const float> values)
{
  std::vector<uint32_t> all(count());
  std::iota(all.begin(), all.end(), 0u);
  set_controls(all, values);
}

void Worlds::set_controls(std::span<const uint32_t> worlds, std::span<const float> values)
{
  const minicl::ExactFloatingPoint environment;
  for (const uint32_t world : worlds) implementation_->check_world("set_controls", world);
  const size_t controls = implementation_->controls.count();
  if (values.size() != worlds.size() * controls)
    throw InputError(fmt::format("set_controls: {} values for {} worlds of {} controls; one for each is needed",
                                 values.size(), worlds.size(), controls));
  implementation_->controls.set(implementation_->engine(), worlds, values);
}

std::vector<JointReading> Worlds::read_joints(std::span<const WorldJoint> joints)
{
  return implementation_->world->read_joints(implementation_->ids_of("read_joints", joints));
}

void Worlds::set_properties(std::span<const WorldBody> bodies, std::span<const BodyProperties> properties)
{
  Implementation &own = *implementation_;
  const std::vector<BodyId> ids = own.ids_of("set_properties", bodies);
  std::vector<BodyProperties> in_all(properties.begin(), properties.end());
  for (size_t i = 0; i < std::min(ids.size(), in_all.size()); ++i) {
    if (in_all[i].continuous)
      throw InputError(
          fmt::format("set_properties: entry {}: continuous: bodies of a batch keep what their scene says, "
                      "because their order follows from it",
                      i));
    if (!in_all[i].material) continue;
    const uint32_t world = bodies[i].world;
    if (*in_all[i].material >= own.tables.materials(world))
      throw InputError(fmt::format("set_properties: entry {}: material {} does not exist; the scene of world {} has {}",
                                   i, *in_all[i].material, world, own.tables.materials(world)));
    *in_all[i].material += own.tables.first_material(world);
  }
  own.world->set_properties(ids, in_all);
  own.upload_starts(ids);
  std::set<uint32_t> worlds;
  for (const WorldBody &body : bodies) worlds.insert(body.world);
  for (const uint32_t world : worlds) {
    own.features[world] |= features_of(own.scene(world), own.settings);
    own.changed[world] = true;
  }
}

void Worlds::set_state_unchecked(const WorldBody &body, const BodyState &state)
{
  implementation_->world->set_body_unchecked(
      implementation_->ids_of("set_state_unchecked", std::span(&body, 1)).front().index, state);
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
template <class Event> WorldEvents<Event> Worlds::Implementation::by_world(std::vector<Event> events) const
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

WorldEvents<ContactEvent> Worlds::contact_events()
{
  return implementation_->by_world(implementation_->world->contact_events());
}
WorldEvents<HitEvent> Worlds::hit_events() { return implementation_->by_world(implementation_->world->hit_events()); }
WorldEvents<PairEvent> Worlds::pair_events()
{
  return implementation_->by_world(implementation_->world->pair_events());
}
WorldEvents<uint32_t> Worlds::moved_bodies()
{
  return implementation_->by_world(implementation_->world->moved_bodies());
}

std::vector<Quarantine> Worlds::quarantined(uint32_t world) const
{
  implementation_->check_world("quarantined", world);
  return implementation_->quarantined(world);
}

Statistics Worlds::statistics() { return implementation_->world->statistics(); }
PlacementReport Worlds::placement_report() const { return implementation_->world->placement_report(); }
bool Worlds::is_placed() const { return implementation_->world->is_placed(); }
bool Worlds::wait_until_placed(double seconds) { return implementation_->world->wait_until_placed(seconds); }
void Worlds::finish() { implementation_->world->finish(); }
void Worlds::prepare_kernels() { implementation_->world->prepare_kernels(); }
void Worlds::set_profiling(bool on) { implementation_->world->set_profiling(on); }
std::vector<KernelTime> Worlds::take_kernel_times() { return implementation_->world->take_kernel_times(); }
uint64_t Worlds::launches() const { return implementation_->world->launches(); }
uint64_t Worlds::bytes_moved() const { return implementation_->world->bytes_moved(); }
uint64_t Worlds::device_reads() const { return implementation_->world->device_reads(); }
double Worlds::build_milliseconds() const { return implementation_->world->build_milliseconds(); }

} // namespace tandem
