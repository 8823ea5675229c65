/* worlds_group.h - worlds that go through one set of launches: all of a batch, or a group (host/world/worlds.h).
 *
 * A group is one World whose scene has the bodies of all its worlds, world after world. Its pipeline is that of any
 * world: every stage works by body or by pair, and what would depend on other worlds takes an index within the world
 * instead, under the feature WORLDS (docs/many-worlds.md lists the places). This class translates between both
 * numberings and keeps what a World has once and a group has by world. Its worlds are numbered from 0; what it is
 * given has been checked to exist.
 */
#pragma once

#include <tandem/worlds.h>

#include "host/world/implementation.h"
#include "host/world/scene_tables.h"
#include "host/world/snapshot.h"
#include "host/world/world_controls.h"
#include "host/world/world_joints.h"
#include "host/world/world_rows.h"

namespace tandem {

class Worlds::Group {
public:
  /* first_world: its number in the batch, for messages. */
  Group(std::span<const Scene> scenes, uint32_t copies, const Settings &given, const Placement &placement,
        uint32_t first_world);

  World::Implementation &engine() { return *world->implementation_; }
  const World::Implementation &engine() const { return *world->implementation_; }

  /* --- numbers of worlds and bodies --- */
  std::vector<BodyId> ids_of(std::span<const WorldBody> given) const;
  std::vector<JointId> ids_of(std::span<const WorldJoint> given) const;
  WorldPlace place_of(uint32_t number);
  uint32_t count() const { return tables.worlds(); }
  uint64_t steps(uint32_t number) const { return engine().statistics.steps - started[number]; }
  Scene scene(uint32_t number);
  void write_controls() { controls.write_scene(engine().scene); }

  /* --- calls, and what takes them back if another group cannot take its part of them --- */
  struct Mark {
    World::Implementation::CallMark calls;
    std::vector<bool> forced;
  };
  Mark mark() const { return {engine().mark_calls(), forced}; }
  void take_back(Mark &mark) noexcept;
  void attempt_step(const StepLimits &limits);
  void add_impulses(std::span<const WorldBody> given, std::span<const Impulse> impulses);
  void add_forces(std::span<const WorldBody> given, std::span<const Force> forces);
  void refuse_bases(const char *call, std::span<const WorldBody> given) const;
  void set_joint_axes(std::span<const WorldJoint> given, std::span<const JointAxisChange> changes);
  std::vector<JointAxisChange> axes_of(std::span<const WorldJoint> given, std::span<const JointAxisChange> changes);
  void set_properties(std::span<const WorldBody> given, std::span<const BodyProperties> properties);
  void check_properties(std::span<const WorldBody> given, std::span<const BodyProperties> properties);
  std::vector<BodyProperties> in_all(std::span<const WorldBody> given,
                                     std::span<const BodyProperties> properties) const;
  void note_properties(std::span<const WorldBody> given);

  /* --- own gravity and starts: worlds_reset.cpp --- */
  void upload_batch();
  void set_gravity(std::span<const uint32_t> numbers, std::span<const Vec3> values);
  void upload_gravity(uint32_t first, uint32_t count);
  void upload_starts(std::span<const BodyId> changed);
  /* numbers: ascending, each once. prepare_reset() asks for the memory that reset() needs. */
  void prepare_reset(std::span<const uint32_t> numbers);
  void reset(std::span<const uint32_t> numbers);
  void take_out_of_quarantine(std::span<const uint32_t> numbers);
  void launch_reset();
  void launch_reset_of(const std::vector<uint32_t> &rows, Buffer list, Kernel kernel);
  void upload_for_reset(Buffer buffer, const std::vector<uint32_t> &list, uint32_t items);

  /* --- joints that break: worlds_breaks.cpp --- */
  const WorldJoints &present_joints();
  bool is_broken(uint32_t joint) const;
  void enable_joints(std::span<const uint32_t> changed, bool enabled); /* by their numbers in the scene of all */
  void mend(std::span<const uint32_t> numbers);
  Scene mended(uint32_t number, Scene scene) const;
  void break_as_in(uint32_t number, const Scene &scene);
  WorldEvents<JointBreak> joint_breaks() const;

  /* --- worlds as they would be alone: worlds_alone.cpp --- */
  bool has_alone(uint32_t number, Buffer buffer) const;
  std::vector<Quarantine> quarantined(uint32_t number) const;
  uint64_t body_hash(uint32_t number);
  std::vector<uint64_t> body_hashes();
  uint64_t state_hash(uint32_t number);
  std::vector<uint64_t> state_hashes();
  uint64_t state_hash(WorldReader &reader, uint32_t number, std::span<const Quarantine> own);
  std::unique_ptr<World::Implementation> alone(uint32_t number, const Placement &placement);

  /* --- a world that was saved: worlds_load.cpp --- */
  struct CachedRange {
    uint32_t begin, end; /* of the cached pairs */
  };
  void check_loaded(uint32_t number, const SnapshotContents &contents);
  CachedRange cached_range(uint32_t number);
  uint64_t pairs_with(const CachedRange &old, const SnapshotContents &contents);
  void make_room_for(uint64_t pairs);
  void load(uint32_t number, std::span<const std::byte> snapshot);
  void load_pairs(uint32_t number, const CachedRange &old, uint64_t all_pairs, const SnapshotContents &contents);
  void load_starts(const CachedRange &old, uint32_t first, std::span<const std::byte> rows);
  void load_bodies(uint32_t number, const SnapshotContents &contents);
  void load_joints(Buffer buffer, uint32_t number, std::span<const std::byte> rows);

  WorldEvents<ContactEvent> contact_events();
  WorldEvents<HitEvent> hit_events();
  WorldEvents<PairEvent> pair_events();
  WorldEvents<uint32_t> moved_bodies();
  template <class Event> WorldEvents<Event> by_world(std::vector<Event> events) const;

  struct Resetting {
    std::vector<uint32_t> firsts, joints, couplings; /* bodies of worlds, and places in buffers */
  };

  Settings settings; /* as they were given */
  SceneTables tables;
  WorldJoints joints;                 /* of the joints as they were coloured then, as present_joints() asks */
  uint64_t graph_of_joints = 0;       /* World::Implementation::graph_number then */
  std::vector<bool> enabled_at_start; /* by joint of all worlds */
  Controls controls;
  Resetting resetting;           /* the reset that has been prepared */
  uint32_t bodies = 0;           /* of each world */
  std::vector<Vec3> gravity;     /* by world, as all that follows */
  std::vector<uint64_t> started; /* steps of the batch when the world began */
  std::vector<uint64_t> entered; /* when it was reset or loaded last: steps from then on have its events */
  std::vector<bool> forced;      /* it was given forces */
  std::vector<Features> features;
  std::vector<bool> changed; /* its properties were set, so that it may have features which a new one has not */
  std::unique_ptr<World> world;
};

} // namespace tandem
