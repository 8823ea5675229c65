/* world_joint_calls.cpp - the functions of <tandem/world.h> about joints: they come, change, are read and go. */
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/runtime/interface/floating_point.h"
#include "host/scene/joint_rows.h"
#include "host/world/answers.h"
#include "host/world/implementation.h"

namespace tandem {

JointId World::id_of_joint(uint32_t joint) const
{
  const std::lock_guard guard(implementation_->reading);
  const JointSlots &slots = implementation_->present_joint_slots();
  if (!slots.exists(joint))
    throw InputError(fmt::format("id_of_joint: joint {} does not exist; the world has {} places for joints", joint,
                                 slots.slots().size()));
  return slots.id_of(joint);
}

bool World::exists(const JointId &id) const
{
  const std::lock_guard guard(implementation_->reading);
  const JointSlots &slots = implementation_->present_joint_slots();
  return slots.exists(id.index) && slots.id_of(id.index) == id;
}

std::vector<JointId> World::joint_ids() const
{
  const std::lock_guard guard(implementation_->reading);
  const JointSlots &slots = implementation_->present_joint_slots();
  std::vector<JointId> ids;
  for (uint32_t slot = 0; slot < slots.slots().size(); ++slot)
    if (slots.exists(slot)) ids.push_back(slots.id_of(slot));
  return ids;
}

std::vector<JointId> World::create_joints(std::span<const Joint> joints)
{
  const minicl::ExactFloatingPoint environment;
  return answer("new joints", implementation_->slots.existing(), [&] {
    const std::vector<Joint> given(joints.begin(), joints.end()); /* they may be those of scene(), which move */
    std::vector<JointId> ids = implementation_->create_joints(given);
    note(implementation_->log, RecordedCall::create_joints, std::span<const Joint>(given), ids);
    return ids;
  });
}

void World::destroy_joints(std::span<const JointId> ids)
{
  const minicl::ExactFloatingPoint environment;
  answer("the destruction of joints", implementation_->slots.existing(), [&] { implementation_->destroy_joints(ids); });
  note(implementation_->log, RecordedCall::destroy_joints, ids);
}

void World::set_joints(std::span<const JointId> ids, std::span<const Joint> joints)
{
  const minicl::ExactFloatingPoint environment;
  answer("other joints", implementation_->slots.existing(), [&] {
    const std::vector<Joint> given(joints.begin(), joints.end());
    implementation_->set_joints(ids, given);
    note(implementation_->log, RecordedCall::set_joints, ids, std::span<const Joint>(given));
  });
}

void World::set_joint_axes(std::span<const JointId> ids, std::span<const JointAxisChange> changes)
{
  const minicl::ExactFloatingPoint environment;
  answer("axes of joints", implementation_->slots.existing(), [&] { implementation_->set_joint_axes(ids, changes); });
  note(implementation_->log, RecordedCall::set_joint_axes, ids, changes);
}

void World::set_controls(std::span<const float> controls)
{
  const minicl::ExactFloatingPoint environment;
  const Scene &scene = this->scene();
  if (controls.size() != scene.actuators.size())
    throw InputError(fmt::format("set_controls: {} controls for {} actuators; one for each is needed", controls.size(),
                                 scene.actuators.size()));
  std::vector<JointId> joints;
  std::vector<JointAxisChange> changes;
  std::map<std::pair<uint32_t, uint32_t>, size_t> change_of; /* by joint and axis */
  for (size_t k = 0; k < controls.size(); ++k) {
    const Actuator &actuator = scene.actuators[k];
    const float number = number_at(actuator, controls[k]);
    if (!std::isfinite(number))
      throw InputError(
          fmt::format("set_controls: control {} is {:g}; a finite number is needed, which gives its axis a "
                      "finite one",
                      k, controls[k]));
    const auto [at, is_new] = change_of.emplace(std::pair(actuator.joint, actuator.axis), changes.size());
    if (is_new) {
      joints.push_back(id_of_joint(actuator.joint));
      changes.push_back({actuator.axis, axis_of(scene.joints[actuator.joint], actuator.axis)});
    }
    controlled_number(changes[at->second].to, actuator.sets) = number;
  }
  set_joint_axes(joints, changes);
}

std::vector<JointReading> World::read_joints(std::span<const JointId> ids)
{
  return answer_in_turn(*implementation_, "what joints do", [&] { return implementation_->read_joints(ids); });
}

const std::vector<JointBreak> &World::joint_breaks() const { return implementation_->joint_breaks; }

} // namespace tandem
