/* calls.cpp - the calls of a program to bodies that exist: what they ask is checked at once and applied later, by the
 * kernels of shared/commands/apply_commands.h.
 *
 * A call is taken whole or not at all: every handle and every number is checked before the first command is added. */
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/base/finite_vector.h"
#include "host/runtime/interface/floating_point.h"
#include "host/scene/parameters.h"
#include "host/world/call_checks.h"
#include "host/world/implementation.h"
#include "shared/commands/command_codes.h"

namespace tandem {
namespace {

float4 row_of_vector(const Vec3 &v) { return {v[0], v[1], v[2], 0}; }

CommandList::Rows rows_of_vectors(const Vec3 &first, const Vec3 &second)
{
  return {row_of_vector(first), row_of_vector(second), float4{0, 0, 0, 0}};
}
CommandList::Rows rows_of_pose(const Pose &pose)
{
  const auto [high, low] = double_float3_of(pose.position);
  const Quat q = unit(pose.orientation);
  return {high, low, float4{q[0], q[1], q[2], q[3]}};
}
CommandList::Rows rows_at_point(const Vec3 &vector, const Point &point)
{
  const auto [high, low] = double_float3_of(point);
  return {row_of_vector(vector), high, low};
}

/* A vector at a point, or at the centre, and another one that turns. */
struct Push {
  const Vec3 &vector, &turning;
  const std::optional<Point> &point;
};

void add_push(CommandList &list, uint32_t body, const Push &push, uint32_t at_center, uint32_t at_point)
{
  if (push.point) list.add(body, at_point, rows_at_point(push.vector, *push.point));
  if (!push.point) list.add(body, at_center, rows_of_vectors(push.vector, push.turning));
  else if (push.turning != Vec3{0, 0, 0}) list.add(body, at_center, rows_of_vectors({0, 0, 0}, push.turning));
}

} // namespace

std::vector<uint32_t> World::Implementation::slots_of(const char *call, std::span<const BodyId> ids) const
{
  std::vector<uint32_t> found;
  found.reserve(ids.size());
  for (const BodyId &id : ids) found.push_back(slots.slot_of(call, id));
  return found;
}

/* Brings the buffers to what the calls so far have made of the world. */
void World::Implementation::settle()
{
  check_lost();
  restore_bodies(); /* where the last attempt of a step could not */
  settle_joints();
  if (commands.empty() && force_commands.empty()) return;
  const minicl::ExactFloatingPoint environment;
  buffers.make_ready(sizes());
  ++state;
  wake_called();
  std::vector<Kernel> kernels{Kernel::apply_commands}, force_kernels{Kernel::add_forces};
  if (settings.sleeping) kernels.push_back(Kernel::disturb_rest), force_kernels.push_back(Kernel::disturb_rest);
  commands.apply(kernels, index_of_body, memory, launcher);
  force_commands.apply(force_kernels, index_of_body, memory, launcher);
}

/* Wakes the islands of the bodies that calls change, and of those beside bodies that are put elsewhere. */
void World::Implementation::wake_called()
{
  if (sleepers.empty()) return set_elsewhere.clear();
  std::vector<uint32_t> called;
  commands.add_slots_to(called);
  force_commands.add_slots_to(called);
  wake_bodies(called, false);
  wake_bodies(set_elsewhere, true);
  set_elsewhere.clear();
}

/* Follows which kinematic bodies may move. */
void World::Implementation::note_motion(uint32_t slot, const Velocity &velocity)
{
  if (scene.bodies[slot].type != BodyType::kinematic) return;
  if (velocity.linear == Vec3{0, 0, 0} && velocity.angular == Vec3{0, 0, 0}) moving_kinematics.erase(slot);
  else moving_kinematics.insert(slot);
}

/* Many bodies are read with their whole buffers, because each transfer from a device takes as long as some thousands of
 * rows. */
std::vector<BodyState> World::Implementation::read(std::span<const BodyId> ids)
{
  constexpr size_t rows_per_transfer = 1024;
  const std::vector<uint32_t> read = slots_of("read_bodies", ids);
  settle();
  std::vector<BodyState> states;
  states.reserve(ids.size());
  if (ids.size() * rows_per_transfer < bodies()) {
    for (const uint32_t slot : read) states.push_back(download_body(memory, index_of_body[slot]));
    return states;
  }
  const std::vector<BodyState> all = download_bodies(memory, special.order);
  for (const BodyId &id : ids) states.push_back(all[id.index]);
  return states;
}

World::Implementation::CallMark World::Implementation::mark_calls() const
{
  return {commands.size(), force_commands.size(), moving_kinematics};
}

void World::Implementation::take_calls_back(CallMark &mark) noexcept
{
  commands.drop_after(mark.commands);
  force_commands.drop_after(mark.force_commands);
  moving_kinematics.swap(mark.moving_kinematics);
}

void World::Implementation::set_states(std::span<const BodyId> ids, std::span<const BodyState> states)
{
  const std::vector<uint32_t> called = slots_of("set_states", ids);
  check_entries("set_states", ids.size(), states);
  refuse_bases("set_states", called);
  commands.prepare(2 * ids.size());
  if (settings.sleeping) set_elsewhere.insert(set_elsewhere.end(), called.begin(), called.end());
  for (size_t i = 0; i < ids.size(); ++i) {
    note_motion(called[i], {states[i].linear_velocity, states[i].angular_velocity});
    commands.add(called[i], COMMAND_SET_POSE, rows_of_pose({states[i].position, states[i].orientation}));
    commands.add(called[i], COMMAND_SET_VELOCITY,
                 rows_of_vectors(states[i].linear_velocity, states[i].angular_velocity));
  }
}

void World::Implementation::set_velocities(std::span<const BodyId> ids, std::span<const Velocity> velocities)
{
  const std::vector<uint32_t> called = slots_of("set_velocities", ids);
  check_entries("set_velocities", ids.size(), velocities);
  commands.prepare(ids.size());
  for (size_t i = 0; i < ids.size(); ++i) {
    note_motion(called[i], velocities[i]);
    commands.add(called[i], COMMAND_SET_VELOCITY, rows_of_vectors(velocities[i].linear, velocities[i].angular));
  }
}

void World::Implementation::move_to(std::span<const BodyId> ids, std::span<const Pose> poses)
{
  const std::vector<uint32_t> called = slots_of("move_to", ids);
  check_entries("move_to", ids.size(), poses);
  for (size_t i = 0; i < ids.size(); ++i)
    if (scene.bodies[ids[i].index].type != BodyType::kinematic)
      refuse_entry("move_to", i,
                   fmt::format("body {} is not kinematic; set_states puts other bodies elsewhere", ids[i].index));
  commands.prepare(ids.size());
  for (size_t i = 0; i < ids.size(); ++i) {
    moving_kinematics.insert(called[i]);
    commands.add(called[i], COMMAND_MOVE_TO, rows_of_pose(poses[i]));
  }
}

void World::Implementation::add_impulses(std::span<const BodyId> ids, std::span<const Impulse> impulses)
{
  const std::vector<uint32_t> called = slots_of("add_impulses", ids);
  check_entries("add_impulses", ids.size(), impulses);
  const auto is_link = [&](uint32_t slot) { return links.has_body(slot); };
  if (std::any_of(called.begin(), called.end(), is_link)) use_forces();
  commands.prepare(2 * ids.size());
  force_commands.prepare(2 * ids.size());
  for (size_t i = 0; i < ids.size(); ++i)
    if (is_link(called[i])) add_impulse_to_link(called[i], impulses[i]);
    else
      add_push(commands, called[i], {impulses[i].impulse, impulses[i].angular_impulse, impulses[i].point},
               COMMAND_ADD_IMPULSE, COMMAND_ADD_IMPULSE_AT);
}

/* What pushes a link goes through its tree in the step, so the impulse acts as a force throughout the step. */
void World::Implementation::add_impulse_to_link(uint32_t slot, const Impulse &impulse) noexcept
{
  const float rate = 1 / settings.step;
  const auto scaled = [rate](const Vec3 &v) { return Vec3{v[0] * rate, v[1] * rate, v[2] * rate}; };
  add_push(force_commands, slot, {scaled(impulse.impulse), scaled(impulse.angular_impulse), impulse.point},
           COMMAND_ADD_FORCE, COMMAND_ADD_FORCE_AT);
}

void World::Implementation::add_forces(std::span<const BodyId> ids, std::span<const Force> forces)
{
  const std::vector<uint32_t> called = slots_of("add_forces", ids);
  check_entries("add_forces", ids.size(), forces);
  if (ids.empty()) return;
  use_forces();
  force_commands.prepare(2 * ids.size());
  for (size_t i = 0; i < ids.size(); ++i)
    add_push(force_commands, called[i], {forces[i].force, forces[i].torque, forces[i].point}, COMMAND_ADD_FORCE,
             COMMAND_ADD_FORCE_AT);
}

void World::Implementation::set_gravity(const Vec3 &gravity)
{
  if (!is_finite_vector(gravity))
    throw InputError(fmt::format("set_gravity: gravity is {}; three finite numbers are needed", vector_text(gravity)));
  settle();
  wake_all();
  const Vec3 before = std::exchange(scene.gravity, gravity);
  try {
    upload_parameters();
  } catch (...) {
    scene.gravity = before;
    throw;
  }
  if (settings.sleeping) { /* a slow start is no rest */
    const std::vector<uint32_t> none(special.awake);
    memory.upload(Buffer::resting_steps, none.data(), none.size() * sizeof(uint32_t));
  }
  ring.forget("gravity was changed");
  ++state;
}

/* From the first force on, steps launch the stage of forces. */
void World::Implementation::use_forces()
{
  if (plan.forces) return;
  StepBuffers::Needs before = buffers.needs();
  plan.forces = true;
  try {
    record_kernels();
    place_again();
    buffers.make_ready(sizes());
  } catch (...) {
    plan.forces = false;
    buffers.give_back_needs(std::move(before));
    throw;
  }
}

} // namespace tandem
