/* worlds.h - the contents of a batch of worlds, behind the interface of <tandem/worlds.h>.
 *
 * A batch is one World whose scene has the bodies of all worlds, world after world. Its pipeline is that of any world:
 * every stage works by body or by pair, and what would depend on other worlds takes an index within the world instead,
 * under the feature WORLDS (docs/many-worlds.md lists the places). This class translates between both numberings and
 * keeps what a World has once and a batch has by world.
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

/* Throws InputError for settings that a batch does not have. */
void check_batch_settings(const Settings &settings);

struct Worlds::Implementation {
  Implementation(std::span<const Scene> scenes, uint32_t copies, const Settings &given, const Placement &placement);

  World::Implementation &engine() { return *world->implementation_; }
  const World::Implementation &engine() const { return *world->implementation_; }

  /* --- numbers of worlds and bodies --- */
  void check_world(const char *call, uint32_t number) const;
  std::vector<BodyId> ids_of(const char *call, std::span<const WorldBody> given) const;
  std::vector<JointId> ids_of(const char *call, std::span<const WorldJoint> given) const;
  WorldPlace place_of(uint32_t number);
  uint64_t steps(uint32_t number) const { return engine().statistics.steps - started[number]; }
  Scene scene(uint32_t number);
  void write_controls() { controls.write_scene(engine().scene); }

  /* --- own gravity and starts: worlds_reset.cpp --- */
  void upload_batch();
  void upload_gravity(uint32_t first, uint32_t count);
  void upload_starts(std::span<const BodyId> changed);
  void reset(std::span<const uint32_t> given);
  void take_out_of_quarantine(std::span<const uint32_t> numbers); /* numbers: ascending, as below */
  void launch_reset(std::span<const uint32_t> numbers);
  void launch_reset_of_joints(std::span<const uint32_t> numbers);
  void launch_reset_of(std::span<const uint32_t> rows, Buffer list, Kernel kernel);

  /* --- joints that break: worlds_breaks.cpp --- */
  const WorldJoints &present_joints();
  bool is_broken(uint32_t joint) const;
  void enable_joints(std::span<const uint32_t> changed, bool enabled); /* by their numbers in the scene of all */
  void mend(std::span<const uint32_t> numbers);
  Scene mended(uint32_t number, Scene scene) const;
  void break_as_in(uint32_t number, const Scene &scene);

  /* --- worlds as they would be alone: worlds_alone.cpp --- */
  bool has_alone(uint32_t number, Buffer buffer) const;
  std::vector<Quarantine> quarantined(uint32_t number) const;
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

  template <class Event> WorldEvents<Event> by_world(std::vector<Event> events) const;

  Settings settings; /* as they were given */
  SceneTables tables;
  WorldJoints joints;                 /* of the joints as they were coloured then, as present_joints() asks */
  uint64_t graph_of_joints = 0;       /* World::Implementation::graph_number then */
  std::vector<bool> enabled_at_start; /* by joint of all worlds */
  Controls controls;
  uint32_t bodies = 0;           /* of each world */
  std::vector<Vec3> gravity;     /* by world, as all that follows */
  std::vector<uint64_t> started; /* steps of the batch when the world began */
  std::vector<uint64_t> entered; /* when it was reset or loaded last: steps from then on have its events */
  std::vector<bool> forced;      /* it was given forces */
  std::vector<Features> features;
  std::vector<bool> changed; /* its properties were set, so that it may have features which a new one has not */
  std::vector<WorldBody> every_body;
  std::unique_ptr<World> world;
};

} // namespace tandem
