/* snapshot.h - a world as bytes: everything that decides the bits of its next steps and of the calls after it.
 *
 *   header        host/base/sealed_bytes.h
 *   modules       names of Settings::extensions, whose functions the program gives again
 *   settings, scene, features in use
 *   bodies        their order in the buffers, their slots with generations and the queues of free ones
 *   joints        their slots with generations and the queue of free ones
 *   shapes        the handles of shapes of bodies, and the shapes that belong to one body alone
 *   history       steps made, quarantined bodies, the first batch fault
 *   buffers       STATE and CACHE ones by name, as many items as are in use, and what modules keep for the scene
 *
 * What follows from these is made anew: tables of shapes, plans, capacities of pairs. KEPT buffers are left out. The
 * numbers in buffers are the floats of all backends, so a snapshot does not depend on where it was made.
 */
#pragma once

#include <tandem/world.h>

#include "host/base/sealed_bytes.h"
#include "host/pipeline/substep_choice.h"
#include "host/scene/specialise.h"
#include "host/world/body_slots.h"
#include "host/world/joint_slots.h"
#include "host/world/shape_slots.h"
#include "host/world/sleepers.h"

namespace tandem {

constexpr SealedKind snapshot_kind{{'T', 'A', 'N', 'D', 'E', 'M', 'S', '\n'}, 13, "snapshot"};

/* A buffer's items in use. */
struct SavedBuffer {
  Buffer buffer;
  std::span<const std::byte> bytes; /* of the snapshot */
};

struct SnapshotContents {
  std::vector<std::string> modules;
  Settings settings; /* without extensions */
  Scene scene;
  Specialisation special; /* features: those that the scene has needed so far */
  BodySlots slots{0};
  JointSlots joint_slots{0};
  std::vector<SleepingIsland> islands; /* in the order in which they fell asleep */
  std::vector<uint32_t> joint_order;   /* by place (host/world/joint_order.h); empty if nobody sleeps */
  ShapeSlots shapes;
  std::vector<uint32_t> made_shapes; /* of the scene, that belong to one body alone */
  uint32_t room = 0; /* bodies that the buffers hold; it decides when the median size is computed again */
  bool forces = false;
  SubstepChoice substeps;               /* StepPlan::substeps */
  bool drowsy = false;                  /* StepPlan::drowsy, which decides in which step islands are looked for */
  std::vector<SleepEvent> sleep_events; /* those that the next step will report */
  uint64_t steps = 0;
  uint32_t overflow = 0; /* as Statistics::overflow */
  std::vector<Quarantine> quarantined;
  std::optional<BatchFault> fault;
  std::vector<SavedBuffer> buffers;
  uint32_t pairs = 0; /* in the contact cache */
};

/* Throws InputError unless a world can be made of the bytes; where: what they are, for messages. The result refers to
 * the bytes. */
SnapshotContents read_snapshot(std::span<const std::byte> bytes, const std::string &where);

} // namespace tandem
