/* worlds.cpp - the functions of <tandem/worlds.h>: what they are given goes to groups, and answers come from them. */
#include "host/world/worlds.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include <fmt/format.h>

#include "host/base/finite_vector.h"
#include "host/base/out_of_memory.h"
#include "host/runtime/interface/floating_point.h"
#include "host/world/call_checks.h"

namespace tandem {

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

uint32_t Worlds::count() const { return implementation_->worlds; }
uint32_t Worlds::bodies_of_world() const { return implementation_->bodies; }
const Settings &Worlds::settings() const { return implementation_->settings; }

Scene Worlds::scene(uint32_t world) const
{
  Implementation &own = *implementation_;
  own.check_world("scene", world);
  return own.group_of(world).scene(own.number_in_group(world));
}

void Worlds::step(const StepLimits &limits) { implementation_->step(limits); }

uint64_t Worlds::steps(uint32_t world) const
{
  Implementation &own = *implementation_;
  own.check_world("steps", world);
  return own.group_of(world).steps(own.number_in_group(world));
}

void Worlds::reset(std::span<const uint32_t> worlds)
{
  implementation_->check("reset", worlds);
  implementation_->reset(worlds);
}

void Worlds::reset(std::span<const uint32_t> worlds, std::span<const BodyState> states)
{
  const uint32_t bodies = bodies_of_world();
  if (states.size() != worlds.size() * bodies)
    throw InputError(fmt::format("reset: {} states of {} worlds of {} bodies; one of each body is needed",
                                 states.size(), worlds.size(), bodies));
  implementation_->check("reset", worlds);
  check_entries("reset", states.size(), states);
  std::vector<WorldBody> put;
  for (const uint32_t world : worlds)
    for (uint32_t body = 0; body < bodies; ++body) put.push_back({world, body});
  for (const Implementation::Share<WorldBody> &share : implementation_->shares_of(std::span<const WorldBody>(put)))
    share.group->refuse_bases("reset", share.items);
  reset(worlds);
  set_states(put, states);
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
  implementation_->call(worlds, gravity, [](Group &group, std::span<const uint32_t> of, std::span<const Vec3> values) {
    group.set_gravity(of, values);
  });
}

/* --- bodies ------------------------------------------------------------------------------------------------------ */
std::vector<BodyState> Worlds::bodies()
{
  return implementation_->gathered<BodyState>([](Group &group) { return group.world->bodies(); });
}

std::vector<BodyState> Worlds::bodies(uint32_t world)
{
  Implementation &own = *implementation_;
  own.check_world("bodies", world);
  std::vector<WorldBody> all;
  for (uint32_t body = 0; body < own.bodies; ++body) all.push_back({own.number_in_group(world), body});
  Group &group = own.group_of(world);
  return group.world->read_bodies(group.ids_of(all));
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
  implementation_->check("set_states", bodies);
  check_entries("set_states", bodies.size(), states);
  implementation_->call(bodies, states, [](Group &group, std::span<const WorldBody> of, std::span<const BodyState> to) {
    group.world->set_states(group.ids_of(of), to);
  });
}

void Worlds::set_velocities(std::span<const WorldBody> bodies, std::span<const Velocity> velocities)
{
  implementation_->check("set_velocities", bodies);
  check_entries("set_velocities", bodies.size(), velocities);
  implementation_->call(bodies, velocities,
                        [](Group &group, std::span<const WorldBody> of, std::span<const Velocity> to) {
                          group.world->set_velocities(group.ids_of(of), to);
                        });
}

void Worlds::move_to(std::span<const WorldBody> bodies, std::span<const Pose> poses)
{
  implementation_->check("move_to", bodies);
  check_entries("move_to", bodies.size(), poses);
  for (size_t i = 0; i < bodies.size(); ++i)
    if (!implementation_->is_kinematic(bodies[i]))
      refuse_entry("move_to", i,
                   fmt::format("body {} of world {} is not kinematic; set_states puts other bodies elsewhere",
                               bodies[i].body, bodies[i].world));
  implementation_->call(bodies, poses, [](Group &group, std::span<const WorldBody> of, std::span<const Pose> to) {
    group.world->move_to(group.ids_of(of), to);
  });
}

void Worlds::add_impulses(std::span<const WorldBody> bodies, std::span<const Impulse> impulses)
{
  implementation_->check("add_impulses", bodies);
  check_entries("add_impulses", bodies.size(), impulses);
  implementation_->call(bodies, impulses,
                        [](Group &group, std::span<const WorldBody> of, std::span<const Impulse> given) {
                          group.add_impulses(of, given);
                        });
}

void Worlds::add_forces(std::span<const WorldBody> bodies, std::span<const Force> forces)
{
  implementation_->check("add_forces", bodies);
  check_entries("add_forces", bodies.size(), forces);
  implementation_->call(bodies, forces, [](Group &group, std::span<const WorldBody> of, std::span<const Force> given) {
    group.add_forces(of, given);
  });
}

void Worlds::set_properties(std::span<const WorldBody> bodies, std::span<const BodyProperties> properties)
{
  Implementation &own = *implementation_;
  own.check("set_properties", bodies);
  if (bodies.size() != properties.size())
    throw InputError(fmt::format("set_properties: {} handles and {} entries; one entry for each handle is needed",
                                 bodies.size(), properties.size()));
  for (size_t i = 0; i < bodies.size(); ++i) own.check_properties(i, bodies[i], properties[i]);
  if (own.groups.size() > 1) /* a group alone checks them as it takes them */
    own.call(bodies, properties, [](Group &group, std::span<const WorldBody> of, std::span<const BodyProperties> to) {
      group.check_properties(of, to);
    });
  own.call(bodies, properties, [](Group &group, std::span<const WorldBody> of, std::span<const BodyProperties> to) {
    group.set_properties(of, to);
  });
}

void Worlds::set_state_unchecked(const WorldBody &body, const BodyState &state)
{
  Implementation &own = *implementation_;
  own.check("set_state_unchecked", std::span(&body, 1));
  own.group_of(body.world).world->set_body_unchecked(own.number_in_group(body.world) * own.bodies + body.body, state);
}

/* --- joints ------------------------------------------------------------------------------------------------------ */
void Worlds::set_joint_axes(std::span<const WorldJoint> joints, std::span<const JointAxisChange> changes)
{
  implementation_->check("set_joint_axes", joints);
  if (joints.size() != changes.size())
    throw InputError(fmt::format("set_joint_axes: {} handles and {} changes; one change for each handle is needed",
                                 joints.size(), changes.size()));
  for (size_t i = 0; i < changes.size(); ++i)
    if (changes[i].axis >= 6) refuse_axis("set_joint_axes", i, changes[i].axis);
  implementation_->replace(
      joints, changes,
      [](Group &group, std::span<const WorldJoint> of, std::span<const JointAxisChange> to) {
        return group.axes_of(of, to);
      },
      [](Group &group, std::span<const WorldJoint> of, std::span<const JointAxisChange> to) {
        group.set_joint_axes(of, to);
      });
}

void Worlds::choose_controls(std::span<const ControlledAxis> axes) { implementation_->choose_controls(axes); }
void Worlds::choose_controls(std::span<const Actuator> actuators) { implementation_->choose_controls(actuators); }

void Worlds::set_controls(std::span<const float> values)
{
  std::vector<uint32_t> all(count());
  std::iota(all.begin(), all.end(), 0u);
  set_controls(all, values);
}

void Worlds::set_controls(std::span<const uint32_t> worlds, std::span<const float> values)
{
  implementation_->check("set_controls", worlds);
  const size_t controls = implementation_->groups.front()->controls.count();
  if (values.size() != worlds.size() * controls)
    throw InputError(fmt::format("set_controls: {} values for {} worlds of {} controls; one for each is needed",
                                 values.size(), worlds.size(), controls));
  implementation_->set_controls(worlds, values);
}

std::vector<JointReading> Worlds::read_joints(std::span<const WorldJoint> joints)
{
  implementation_->check("read_joints", joints);
  std::vector<JointReading> readings(joints.size());
  for (const Implementation::Share<WorldJoint> &share : implementation_->shares_of(joints)) {
    const std::vector<JointReading> own = share.group->world->read_joints(share.group->ids_of(share.items));
    for (size_t k = 0; k < own.size(); ++k) readings[share.places[k]] = own[k];
  }
  return readings;
}

/* --- events and figures ------------------------------------------------------------------------------------------ */
namespace {

/* What `events_of` answers for each group, one behind the other. */
template <class Groups, class Function> auto events_of_all(const Groups &groups, const Function &events_of)
{
  auto all = events_of(*groups.front());
  for (size_t k = 1; k < groups.size(); ++k) {
    auto next = events_of(*groups[k]);
    for (size_t world = 1; world < next.first.size(); ++world) all.first.push_back(all.all.size() + next.first[world]);
    std::ranges::move(next.all, std::back_inserter(all.all));
  }
  return all;
}

} // namespace

WorldEvents<ContactEvent> Worlds::contact_events()
{
  return events_of_all(implementation_->groups, [](Group &group) { return group.contact_events(); });
}
WorldEvents<HitEvent> Worlds::hit_events()
{
  return events_of_all(implementation_->groups, [](Group &group) { return group.hit_events(); });
}
WorldEvents<PairEvent> Worlds::pair_events()
{
  return events_of_all(implementation_->groups, [](Group &group) { return group.pair_events(); });
}
WorldEvents<uint32_t> Worlds::moved_bodies()
{
  return events_of_all(implementation_->groups, [](Group &group) { return group.moved_bodies(); });
}
WorldEvents<JointBreak> Worlds::joint_breaks() const
{
  return events_of_all(implementation_->groups, [](Group &group) { return group.joint_breaks(); });
}

std::vector<Quarantine> Worlds::quarantined(uint32_t world) const
{
  Implementation &own = *implementation_;
  own.check_world("quarantined", world);
  return own.group_of(world).quarantined(own.number_in_group(world));
}

uint64_t Worlds::body_hash(uint32_t world)
{
  Implementation &own = *implementation_;
  own.check_world("body_hash", world);
  return own.group_of(world).body_hash(own.number_in_group(world));
}

std::vector<uint64_t> Worlds::body_hashes()
{
  return implementation_->gathered<uint64_t>([](Group &group) { return group.body_hashes(); });
}

uint64_t Worlds::state_hash(uint32_t world)
{
  Implementation &own = *implementation_;
  own.check_world("state_hash", world);
  return own.group_of(world).state_hash(own.number_in_group(world));
}

std::vector<uint64_t> Worlds::state_hashes()
{
  return implementation_->gathered<uint64_t>([](Group &group) { return group.state_hashes(); });
}

namespace {

void add(const Statistics &next, Statistics &all)
{
  const double depth = all.mean_penetration * all.contacts + next.mean_penetration * next.contacts;
  all.pairs += next.pairs;
  all.contacts += next.contacts;
  all.manifolds += next.manifolds;
  all.colors = std::max(all.colors, next.colors);
  all.max_penetration = std::max(all.max_penetration, next.max_penetration);
  all.mean_penetration = all.contacts > 0 ? depth / all.contacts : 0;
  all.kinetic_energy += next.kinetic_energy;
  all.nonfinite += next.nonfinite;
  all.overflow = std::max(all.overflow, next.overflow);
}

} // namespace

Statistics Worlds::statistics()
{
  const std::vector<Statistics> each = implementation_->gathered<Statistics>(
      [](Group &group) { return std::vector<Statistics>{group.world->statistics()}; });
  Statistics all = each.front();
  for (size_t k = 1; k < each.size(); ++k) add(each[k], all);
  return all;
}

/* --- one world --------------------------------------------------------------------------------------------------- */
std::unique_ptr<World> Worlds::alone(uint32_t world, const Placement &placement)
{
  Implementation &own = *implementation_;
  own.check_world("alone", world);
  return std::unique_ptr<World>(new World(own.group_of(world).alone(own.number_in_group(world), placement)));
}

std::vector<std::byte> Worlds::save(uint32_t world)
{
  implementation_->check_world("save", world);
  return alone(world, {"serial", {}})->save();
}

void Worlds::load(uint32_t world, std::span<const std::byte> snapshot)
{
  Implementation &own = *implementation_;
  own.check_world("load", world);
  own.group_of(world).load(own.number_in_group(world), snapshot);
}

/* --- where it runs ----------------------------------------------------------------------------------------------- */
PlacementReport Worlds::placement_report() const
{
  PlacementReport report = implementation_->groups.front()->world->placement_report();
  if (implementation_->groups.size() > 1) report.on = implementation_->placement.on;
  return report;
}

bool Worlds::is_placed() const
{
  return std::ranges::all_of(implementation_->groups, [](const auto &group) { return group->world->is_placed(); });
}

bool Worlds::wait_until_placed(double seconds)
{
  return std::ranges::all_of(implementation_->groups,
                             [&](const auto &group) { return group->world->wait_until_placed(seconds); });
}

void Worlds::finish()
{
  for (const auto &group : implementation_->groups) group->world->finish();
}

void Worlds::prepare_kernels()
{
  for (const auto &group : implementation_->groups) group->world->prepare_kernels();
}

void Worlds::set_profiling(bool on)
{
  for (const auto &group : implementation_->groups) group->world->set_profiling(on);
}

std::vector<KernelTime> Worlds::take_kernel_times()
{
  std::vector<KernelTime> all = implementation_->groups.front()->world->take_kernel_times();
  if (implementation_->groups.size() > 1)
    for (KernelTime &time : all) time.backend = implementation_->placement.on;
  for (size_t k = 1; k < implementation_->groups.size(); ++k)
    for (const KernelTime &next : implementation_->groups[k]->world->take_kernel_times()) {
      const auto same = std::ranges::find(all, next.kernel, &KernelTime::kernel);
      if (same == all.end()) {
        all.push_back({next.kernel, implementation_->placement.on, next.milliseconds, next.launches});
        continue;
      }
      same->milliseconds += next.milliseconds;
      same->launches += next.launches;
    }
  return all;
}

uint64_t Worlds::launches() const
{
  return implementation_->total<uint64_t>([](const Group &group) { return group.world->launches(); });
}
uint64_t Worlds::bytes_moved() const
{
  return implementation_->total<uint64_t>([](const Group &group) { return group.world->bytes_moved(); });
}
uint64_t Worlds::device_reads() const
{
  return implementation_->total<uint64_t>([](const Group &group) { return group.world->device_reads(); });
}
double Worlds::build_milliseconds() const
{
  return implementation_->total<double>([](const Group &group) { return group.world->build_milliseconds(); });
}

} // namespace tandem
