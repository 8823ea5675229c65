/* state_ring.h - the last states of a world, in memory of the devices that made them, for programs that go back a few
 * steps: rollback in games over networks, search, optimisation.
 *
 *   keep   buffers --copy--> slot 2        slots   0   1   2   3     the slot after the newest is written next
 *   go_back(1)     <--copy-- slot 1                    ^   newest
 *
 * A slot holds the carried buffers as far as they are in use, and of the host's part what a few steps change. Bodies
 * that came and went in the span are undone with the list of what they replaced, as long as no call has laid the
 * buffers out anew; then the older states are forgotten.
 */
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tandem/world.h>

#include "host/pipeline/substep_choice.h"
#include "host/runtime/memory.h"
#include "host/world/body_slots.h"
#include "host/world/joint_slots.h"
#include "host/world/shape_slots.h"
#include "host/world/sleepers.h"

namespace tandem {

/* A slot of the bodies whose body, or whose status, was changed. */
struct RosterChange {
  uint32_t slot;
  std::optional<Body> before;                  /* the body that was replaced in Scene::bodies */
  std::optional<std::array<uint32_t, 2>> tree; /* its row of body_tree */
};

/* Who sleeps, and where the bodies lie while these do. */
struct KeptSleepers {
  uint64_t number; /* of this set of sleepers; each set has its own */
  std::vector<uint32_t> order, index_of_body;
  std::vector<uint32_t> joints; /* by place: host/world/joint_order.h */
  size_t awake_joints;
  uint32_t large;
  Sleepers sleepers;
};

/* The joints, and the handles that are valid. */
struct KeptJoints {
  uint64_t number; /* of this list of joints; each list has its own */
  std::vector<Joint> joints;
  JointSlots slots;
};

struct KeptState {
  std::vector<KeptBytes> buffers; /* in the order of the carried ones */
  Statistics statistics;
  std::optional<BatchFault> fault;
  size_t quarantined = 0, shapes = 0, materials = 0;
  uint32_t bodies = 0, pairs = 0;
  bool forces = false, drowsy = false; /* of StepPlan */
  SubstepChoice substeps;
  std::vector<SleepEvent> sleep_events_to_come;
  size_t changes = 0; /* of the roster, so far */
  std::shared_ptr<const BodySlots> slots;
  std::shared_ptr<const ShapeSlots> shape_slots;
  std::shared_ptr<const KeptJoints> joints;     /* null in worlds without joints */
  std::shared_ptr<const KeptSleepers> sleepers; /* null in worlds without Settings::sleeping */
};

class StateRing {
public:
  /* Throws away all states and makes so many slots. */
  void resize(size_t slots, bool after_steps);
  size_t size() const { return slots_.size(); }
  bool keeps_after_steps() const { return after_steps_ && !slots_.empty(); }
  size_t kept() const { return kept_; }

  /* Gives up the oldest state, if there is no room beside it. Returns the slot to be written next, which commit() makes
   * the newest state. */
  KeptState &begin() noexcept;
  std::vector<KeptState> &slots() { return slots_; }
  void commit() noexcept;
  KeptState &back(size_t states) { return slots_[(newest_ + slots_.size() - states) % slots_.size()]; }
  /* Makes back(states) the newest, and forgets the changes after it. */
  void rewind(size_t states) noexcept;
  void forget(std::string why) noexcept;
  const std::string &why_forgotten() const { return why_; }

  /* The slots as they are, shared by all states that have them. */
  std::shared_ptr<const BodySlots> shared(const BodySlots &slots);
  std::shared_ptr<const ShapeSlots> shared(const ShapeSlots &slots);
  /* The sleepers of the newest state that was kept or gone back to, to be shared by states that have the same; may be
   * null. */
  std::shared_ptr<const KeptSleepers> &shared_sleepers() { return shared_sleepers_; }
  void prepare_changes(size_t more); /* so that note() cannot fail */
  void note(RosterChange change) noexcept;
  void note(std::vector<RosterChange> &changes) noexcept
  {
    for (RosterChange &change : changes) note(std::move(change));
  }
  size_t changes() const { return first_change_ + changes_.size(); }
  /* Those after the first `changes`. */
  std::span<RosterChange> changes_after(size_t changes);

private:
  std::vector<KeptState> slots_;
  size_t newest_ = 0, kept_ = 0;
  bool after_steps_ = true;
  std::vector<RosterChange> changes_;
  size_t first_change_ = 0; /* the number of the first of them */
  std::shared_ptr<const BodySlots> shared_;
  std::shared_ptr<const ShapeSlots> shared_shapes_;
  std::shared_ptr<const KeptSleepers> shared_sleepers_;
  std::string why_;
};

} // namespace tandem
