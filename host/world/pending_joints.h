/* pending_joints.h - joints that were created and destroyed since all joints were coloured last.
 *
 * Colours, order and tables are of all joints, so making them anew in each call would take the square of the number of
 * calls. Calls that fit what is built leave their joints here, and the next step or read puts them all into the world:
 *
 *   create_joint  create_joint  destroy_joint ...      step, or what reads
 *        |             |             |                      |
 *        +-------------+-------------+--> PendingJoints --> Implementation::exchange_joints
 *
 * The world is then what it would be if each call had done so, wherever it is read in between: contacts forget their
 * colours as after each single call (host/scene/joint_recoloring.h). States that were kept stay, though one of these
 * joints alone would have needed other tables, if it is gone again.
 */
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <tandem/scene.h>

#include "host/scene/joint_recoloring.h"
#include "host/world/joint_slots.h"

namespace tandem {

struct PendingJoints {
  std::vector<Joint> joints; /* all that the scene will have */
  JointSlots slots;
  std::vector<std::pair<uint32_t, JointEdge>> changes; /* in the order of the calls */
};

} // namespace tandem
