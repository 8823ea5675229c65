/* pending_joints.cpp - joints that wait until the next step or read puts them into the world; see pending_joints.h. */
#include "host/world/pending_joints.h"

#include <algorithm>

#include "host/base/reserve_more.h"
#include "host/runtime/interface/floating_point.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"
#include "host/world/implementation.h"

namespace tandem {

const JointSlots &World::Implementation::present_joint_slots() const
{
  return pending_joints ? pending_joints->slots : joint_slots;
}

/* What might be refused later, or wakes bodies in an order of its own, is done at once. */
bool World::Implementation::may_wait(std::span<const Joint> joints) const
{
  return !is_batch() && sleepers.empty() && !scene.joints.empty() &&
         std::all_of(joints.begin(), joints.end(),
                     [&](const Joint &joint) { return (features_of(joint) & ~scene_features) == 0; });
}

/* With room for so many changes more, so that they cannot fail. */
PendingJoints &World::Implementation::joints_to_change(size_t changes)
{
  check_lost();
  if (!pending_joints) pending_joints = std::make_unique<PendingJoints>(PendingJoints{scene.joints, joint_slots, {}});
  reserve_more(pending_joints->joints, changes);
  reserve_more(pending_joints->changes, changes);
  pending_joints->slots.prepare(changes);
  joints_wait = true;
  return *pending_joints;
}

std::vector<JointId> World::Implementation::create_joints_later(std::span<const Joint> given)
{
  std::vector<Joint> joints(given.begin(), given.end());
  std::vector<JointId> ids(given.size());
  PendingJoints &pending = joints_to_change(given.size());
  disturb_joined(given);
  for (size_t k = 0; k < joints.size(); ++k) {
    const uint32_t slot = pending.slots.take();
    if (slot == pending.joints.size()) pending.joints.emplace_back();
    pending.changes.emplace_back(slot, edge_of(joints[k], links));
    pending.joints[slot] = std::move(joints[k]);
    ids[k] = pending.slots.id_of(slot);
  }
  return ids;
}

void World::Implementation::destroy_joints_later(std::span<const uint32_t> destroyed)
{
  PendingJoints &pending = joints_to_change(destroyed.size());
  std::vector<Joint> disturbed;
  for (const uint32_t slot : destroyed) disturbed.push_back(pending.joints[slot]);
  disturb_joined(disturbed);
  for (const uint32_t slot : destroyed) {
    pending.slots.free(slot);
    pending.joints[slot] = vacant_joint();
    pending.changes.emplace_back(slot, JointEdge{});
  }
}

/* Bodies of which contacts must forget their colours. Without contacts nobody needs to know. */
std::vector<uint32_t> World::Implementation::recolored_by(const PendingJoints &pending) const
{
  if (cached_pairs == 0) return {};
  JointRecoloring recoloring(scene, links, joint_graph);
  for (const auto &[slot, edge] : pending.changes) recoloring.change(slot, edge);
  return recoloring.bodies_with_new_colors();
}

void World::Implementation::settle_joints()
{
  if (!pending_joints) return;
  const minicl::ExactFloatingPoint environment;
  std::unique_ptr<PendingJoints> pending = std::move(pending_joints);
  try {
    std::vector<uint32_t> changed;
    for (const auto &change : pending->changes) changed.push_back(change.first);
    exchange_joints(pending->joints, pending->slots, changed, recolored_by(*pending));
  } catch (...) {
    pending_joints = std::move(pending);
    throw;
  }
  joints_wait = false; /* not before: whoever reads this goes on without the lock */
}

/* For what may be asked while others read: one thread puts the joints into the world, and the others wait for it. */
void World::Implementation::settle_joints_in_turn()
{
  if (!joints_wait) return;
  const std::lock_guard guard(reading);
  settle_joints();
}

} // namespace tandem
