/* implementation.h - the contents of a world and the phases of a step, behind the interface of <tandem/world.h>.
 *
 * Members are declared in the order of their dependencies: backends outlive the memory that lies in their storage. The
 * functions are grouped by concern: making a world in implementation.cpp, steps in step_attempts.cpp, calls to bodies
 * in calls.cpp and properties.cpp, bodies that come and go in bodies.cpp, users' modules in extensions.cpp.
 */
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <tandem/world.h>

#include "host/pipeline/broadphases/choice.h"
#include "host/pipeline/scene_counts.h"
#include "host/pipeline/sleeping.h"
#include "host/pipeline/step.h"
#include "host/runtime/launcher.h"
#include "host/runtime/memory.h"
#include "host/runtime/recorder.h"
#include "host/scene/articulation_buffers.h"
#include "host/scene/body_buffers.h"
#include "host/scene/body_records.h"
#include "host/scene/buffer_measures.h"
#include "host/scene/coupling_graph.h"
#include "host/scene/hull_buffers.h"
#include "host/scene/joint_graph.h"
#include "host/scene/specialise.h"
#include "host/scene/tree_tables.h"
#include "host/world/automatic_placement.h"
#include "host/world/body_slots.h"
#include "host/world/call_log.h"
#include "host/world/commands.h"
#include "host/world/joint_impulses.h"
#include "host/world/joint_order.h"
#include "host/world/joint_slots.h"
#include "host/world/pending_joints.h"
#include "host/world/placed_backends.h"
#include "host/world/queries.h"
#include "host/world/shape_slots.h"
#include "host/world/sleepers.h"
#include "host/world/state_ring.h"
#include "host/world/step_buffers.h"
#include "host/world/step_parts.h"
#include "shared/parameters.h"

namespace tandem {

struct SnapshotContents;

/* Bodies as a call changes them. */
struct ChangedBodies {
  std::vector<uint32_t> slots; /* ascending */
  std::vector<Body> bodies;
};

/* A body's index shares a word with the stage in which the body failed (COUNT_NONFINITE). */
constexpr uint32_t body_numbers = 1u << 28;

/* The first capacity of pairs; a step that finds more runs again. */
uint32_t first_capacity(const Scene &scene, const Settings &settings);
/* The capacity for what was needed: an eighth more, so that a growing pile does not run every step twice. */
uint64_t room_for(uint64_t needed);

/* Throws InputError if the body has locked axes and the solver holds none. */
void check_solver(const Settings &settings, const Body &body, size_t index, const std::string &where);

/* Throws InputError if the scene has couplings and the solver has none. */
void check_couplings(const Settings &settings, const Scene &scene);

struct World::Implementation {
  /* What a world begins with: a scene, or what a snapshot holds. */
  struct Beginning {
    Scene scene;
    Settings settings;
    Specialisation special; /* features: those that the scene needs */
    BodySlots slots;
    uint32_t room;  /* bodies that the buffers hold */
    uint32_t pairs; /* the first capacity */
    bool forces;
    Features forced = 0; /* forced_features.h */
  };
  static Beginning beginning_of(const Scene &given, const Settings &chosen);

  Implementation(const Scene &given, const Settings &chosen, const Placement &placement);
  /* shared: those of the world that this one is to replace, with their placement; null: none. */
  Implementation(Beginning beginning, const Placement &placement, const PlacedBackends *shared = nullptr);
  ~Implementation(); /* waits, because running kernels still read buffers */

  /* --- making a world: implementation.cpp --------------------------------------------------------------------- */
  Sizes sizes() const;
  Features features_run() const
  {
    return settings.specialise ? scene_features | forced_features : all_features() | (scene_features & FEATURE_WORLDS);
  }
  void record_kernels();
  void set_observer(World::Observer observer);
  void place(const Placement &placement);
  void place_as_asked(const Placement &placement); /* by a user: it may be automatic */
  void place_as_chosen();
  void end_timed_step() noexcept;
  void place_again(); /* if other kernels are needed than before */
  bool is_built();
  bool wait_until_placed(double seconds);
  PlacementReport placement_report() const;
  void upload_scene();
  Parameters parameters_now() const;
  Parameters parameters_with(const SubstepChoice &choice, uint32_t substep_class) const;
  bool may_part_islands() const noexcept;
  uint32_t bodies_with_more_substeps() const;
  SubstepChoice choice_of_others() const; /* than islands that are apart */
  void stage_parameters(StagedUploads &uploads) const;
  void upload_parameters();
  void stage_tables(StagedUploads &uploads);
  void stage_counts(StagedUploads &uploads) const;
  void number_bodies();
  void plan_for_body(uint32_t slot) noexcept;
  bool module_applies_forces() const;
  void guess_counts() noexcept;
  QueryTarget query_target();
  QueryTarget target_for_kernels();

  /* --- the broadphase `auto`: broadphase_choice.cpp --------------------------------------------------------------- */
  void choose_broadphase_after(std::optional<Broadphase> before);
  void choose_again();
  void take_broadphase(Broadphase broadphase);
  bool is_still_right() const;
  uint32_t query_structure() const;

  /* --- a step happens whole or not at all (host/world/carried.h): step_attempts.cpp ---------------------------- */
  struct Attempt {
    StepPlan plan;
    Statistics statistics;
    std::optional<uint64_t> first_outgrown;
    size_t quarantined;
  };
  void step(const StepLimits &limits);
  /* The two halves of a step, so that the groups of a batch step together or not at all. What attempt_step() has done,
   * abandon_step() undoes; if it throws, it has. */
  void attempt_step(const StepLimits &limits);
  void abandon_step() noexcept;
  void complete_step();
  void sleep_on();
  void end_step();
  void check_lost() const;
  void run_until_whole(const StepLimits &limits);
  void check_limits(const StepLimits &limits) const;
  uint32_t sequential_contacts() const
  {
    return plan.known[COUNT_CONSTRAINTS] - plan.known[COLOR_START + COLOR_OVERFLOW];
  }
  void turn() noexcept;
  void turn_back() noexcept;
  void undo(const Attempt &before) noexcept;
  void restore_bodies();
  [[noreturn]] void tell_why_step_failed() const;
  void begin_launches();
  void launch_whole_step();
  void tell_substeps();
  std::span<const uint32_t> counts_expected() const;
  void plan_colors() noexcept;
  bool may_skip_contacts() const noexcept;
  void plan_more_colors(uint32_t status);
  void accept() noexcept;
  void prepare_repetition(uint32_t status, bool &may_forget);
  void settle_islands() noexcept;
  uint32_t classes_needed() const noexcept;
  bool divides_wrongly(uint32_t status) const noexcept;
  void rows_bring_wishes() noexcept;
  bool candidates_overflow() const;
  uint32_t pairs_needed() const;
  void grow_pairs(bool &may_forget);
  struct PairCapacity {
    uint32_t pairs, candidates;
  };
  PairCapacity capacity() const { return {plan.capacity_pairs, plan.capacity_candidates}; }
  void set_capacity(const PairCapacity &capacity);
  void enlarge(const PairCapacity &wanted);
  void reserve_pairs(uint32_t pairs);
  void shrink_to_fit();
  void forget_contacts();
  void quarantine_from(uint32_t code, uint32_t status);
  void quarantine(uint32_t index, uint32_t stage);
  void quarantine_tree(uint32_t body, uint32_t stage);

  /* --- a batch of worlds (host/world/worlds.h): batch.cpp --------------------------------------------------------- */
  bool is_batch() const { return special.worlds > 0; }
  uint32_t world_in_message(uint32_t body) const { return first_world + body / bodies_of_world(); }
  uint32_t bodies_of_world() const { return bodies() / special.worlds; }
  void note_batch(Recorder &recorder) const;
  void quarantine_in_worlds(uint32_t status);
  struct FailedBody {
    uint32_t body, stage;
  };
  std::optional<FailedBody> quarantine_worst(std::span<const uint32_t> failed, uint32_t first, bool lacks_contacts);
  void quarantine_others(const FailedBody &worst, uint32_t first, std::span<const uint32_t> not_finite);

  /* --- a world as bytes: snapshot.cpp ---------------------------------------------------------------------------- */
  std::vector<std::byte> save(std::vector<std::byte> memory = {}); /* memory: is used again */
  void put_history(ByteWriter &writer) const;
  void put_buffers(ByteWriter &writer);
  bool is_saved(Buffer buffer) const;
  /* old: the world that it replaces, whose backends it takes over; null: none. */
  static std::unique_ptr<Implementation> restored(std::span<const std::byte> snapshot,
                                                  std::vector<Extension> extensions, const Placement &placement,
                                                  const Implementation *old);
  static std::unique_ptr<Implementation> made_of(SnapshotContents contents, std::vector<Extension> extensions,
                                                 const Placement &placement, const Implementation *old);
  void take_buffers(const SnapshotContents &contents);
  void take_islands(const SnapshotContents &contents);

  /* --- recordings: call_log.cpp ---------------------------------------------------------------------------------- */
  void start_recording(const std::string &path, const RecordingOptions &options);
  void log_step();
  uint64_t state_hash();

  /* --- the last states: state_ring.cpp --------------------------------------------------------------------------- */
  void keep_states(uint32_t states, bool after_steps);
  void keep_state();
  void keep_state_of_step();
  void go_back(uint32_t states);
  void check_back(uint32_t states) const;
  SceneEntries entries_then(const KeptState &state) const;
  void stage_roster(StagedUploads &uploads, const KeptState &state, std::span<const RosterChange> changes,
                    const std::vector<uint32_t> &index) const;
  std::shared_ptr<const KeptSleepers> keep_sleepers();
  std::shared_ptr<const KeptJoints> keep_joints();
  void reorder_rows(const std::vector<uint32_t> &order);
  void take_sleepers(KeptSleepers &then);
  void put_back_sleepers(const KeptState &then);
  void take_roster(const KeptState &state, BodySlots &slots_then, ShapeSlots &shapes_then) noexcept;
  void drop_forces();
  Storage &storage_of(Buffer buffer);

  /* --- calls between two steps: calls.cpp ------------------------------------------------------------------------ */
  void settle();
  std::vector<uint32_t> slots_of(const char *call, std::span<const BodyId> ids) const;
  void wake_called();
  std::vector<BodyState> read(std::span<const BodyId> ids);
  /* What calls to bodies add to, so that those which no step has applied yet can be taken back in a batch. */
  struct CallMark {
    size_t commands, force_commands;
    std::set<uint32_t> moving_kinematics;
  };
  CallMark mark_calls() const;
  void take_calls_back(CallMark &mark) noexcept;
  void set_states(std::span<const BodyId> ids, std::span<const BodyState> states);
  void set_velocities(std::span<const BodyId> ids, std::span<const Velocity> velocities);
  void move_to(std::span<const BodyId> ids, std::span<const Pose> poses);
  void add_impulses(std::span<const BodyId> ids, std::span<const Impulse> impulses);
  void add_forces(std::span<const BodyId> ids, std::span<const Force> forces);
  void add_impulse_to_link(uint32_t slot, const Impulse &impulse) noexcept;
  void use_forces();

  /* --- properties that change: properties.cpp -------------------------------------------------------------------- */
  void set_properties(std::span<const BodyId> ids, std::span<const BodyProperties> properties);
  void check_properties(std::span<const BodyId> ids, std::span<const BodyProperties> properties);
  ChangedBodies changed_by(std::span<const BodyId> ids, std::span<const BodyProperties> properties);
  void refuse_unbuilt(std::span<const uint32_t> slots, std::span<const Body> changed_bodies);
  void refuse_for_links(std::span<const uint32_t> changed, std::span<const Body> changed_bodies);
  void refuse_idle_joints(std::span<const uint32_t> joints, std::span<const uint32_t> changed,
                          std::span<const Body> changed_bodies);
  void write_properties(std::span<const uint32_t> slots, bool weighs_anew);
  void color_anew(std::span<const uint32_t> freed, std::span<const uint32_t> joints);
  void forget_colors(std::span<const uint32_t> freed);
  std::vector<uint32_t> colors_without(std::span<const uint32_t> freed);
  void put_colors(const std::vector<uint32_t> &colors);

  /* --- joints that sleep with their bodies: sleeping_joints.cpp -------------------------------------------------- */
  std::vector<BodyRows> joint_rows(const std::vector<bool> &touched) const;
  void launch_moves_of_joints(Launcher &to, const BodyRows &rows, uint32_t most) const;
  void move_joint_rows(const JointOrder::Moves &moves, bool carried);
  void tell_articulations();
  void tell_joints();
  void plan_joints() noexcept;
  bool has_rows(uint32_t joint) const;
  bool is_joint_asleep(uint32_t joint) const;
  bool sleeps_as_one(uint32_t joint) const;
  void put_joints_to_sleep();
  void wake_joints(std::span<const uint32_t> of_slots);
  std::set<uint32_t> islands_joined_to(uint32_t slot) const;
  void take_joint_order(std::vector<uint32_t> joints);

  /* --- joints: joints.cpp ---------------------------------------------------------------------------------------- */
  void stage_joint_tables(StagedUploads &uploads, std::span<const uint32_t> order) const;
  void refuse_articulated(const char *call, const char *why, std::span<const uint32_t> joints) const;
  void refuse_bases(const char *call, std::span<const uint32_t> given) const;
  void refuse_linked(const char *call, const char *why, std::span<const uint32_t> given) const;
  bool is_in_tree(uint32_t joint) const { return joint < links.of_joint.size() && links.of_joint[joint] != no_link; }
  void refuse_joined(const char *call, const char *why, std::span<const uint32_t> given) const;
  std::string call_in_message(const char *call, uint32_t body) const;
  uint32_t joint_in_message(uint32_t joint) const;
  uint32_t body_in_message(uint32_t body) const { return is_batch() ? body % bodies_of_world() : body; }

  /* --- joints that come, change and go: joint_calls.cpp ----------------------------------------------------------- */
  class PlacedJoints;
  void refuse_coupled(const char *call, const char *why, std::span<const uint32_t> joints) const;
  void refuse_driven(const char *call, const char *why, std::span<const uint32_t> joints) const;
  void disturb_joined(std::span<const Joint> joints);
  void put_joints(std::vector<Joint> joints, const JointSlots &slots_then, std::span<const uint32_t> changed);
  void exchange_joints(std::vector<Joint> joints, const JointSlots &slots_then, std::span<const uint32_t> forgotten,
                       std::vector<uint32_t> recolored);
  JointGraph graph_with(std::vector<Joint> &joints);
  bool fits_tables(const std::vector<Joint> &before, const JointGraph &graph) const;
  void stage_joints_again(StagedUploads &uploads, std::span<const uint32_t> order) const;
  void write_joints(const JointImpulses &impulses);
  std::vector<JointId> create_joints(std::span<const Joint> given);
  void destroy_joints(std::span<const JointId> ids);
  void destroy_joints_in(std::span<const uint32_t> destroyed);
  std::vector<uint32_t> joints_of_bodies(std::span<const uint32_t> given) const;
  void set_joints(std::span<const JointId> ids, std::span<const Joint> given);
  void set_joint_axes(std::span<const JointId> ids, std::span<const JointAxisChange> changes);
  void write_joint_axes(std::span<const uint32_t> changed, std::vector<Joint> joints);
  void stage_changed_axes(StagedUploads &uploads, std::span<const uint32_t> changed) const;
  void check_joined_bodies(const char *call, size_t entry, const Joint &joint) const;
  template <class Check> void check_in_world(const Joint &joint, uint32_t slot, const Check &check) const;
  void check_axes(const Joint &joint, uint32_t slot) const;
  std::vector<uint32_t> slots_of_joints(const char *call, std::span<const JointId> ids) const;
  std::vector<uint32_t> list_broken_joints();
  void break_joints(std::span<const uint32_t> broken);

  /* --- joints that wait: pending_joints.cpp ----------------------------------------------------------------------- */
  const JointSlots &present_joint_slots() const;
  bool may_wait(std::span<const Joint> joints) const;
  PendingJoints &joints_to_change(size_t changes);
  std::vector<JointId> create_joints_later(std::span<const Joint> given);
  void destroy_joints_later(std::span<const uint32_t> destroyed);
  std::vector<uint32_t> recolored_by(const PendingJoints &pending) const;
  void settle_joints();
  void settle_joints_in_turn();

  /* --- what joints do: joint_readings.cpp ------------------------------------------------------------------------- */
  std::vector<JointReading> read_joints(std::span<const JointId> ids);

  /* --- shapes of bodies that come and go: shapes.cpp -------------------------------------------------------------- */
  std::vector<ShapeId> shapes_of(const BodyId &id);
  std::vector<ShapeId> add_shapes(std::span<const BodyId> ids, std::span<const Child> given);
  void remove_shapes(std::span<const ShapeId> ids);
  uint32_t own_shape(uint32_t slot, const std::set<uint32_t> &taken);
  void give_parts(const char *call, const std::map<uint32_t, std::vector<Child>> &parts);

  /* --- bodies that come and go: bodies.cpp ----------------------------------------------------------------------- */
  struct Arrival;
  class LayoutBackup;
  uint32_t bodies() const { return static_cast<uint32_t>(special.order.size()); } /* with free slots */
  const std::vector<uint32_t> &events_order() const
  {
    return order_of_events.empty() ? special.order : order_of_events;
  }
  std::vector<uint32_t> moved_bodies();
  BodyRegion region_of(uint32_t index) const;
  std::vector<BodyId> create(std::span<const Body> bodies);
  void destroy(std::span<const BodyId> ids);
  std::vector<uint32_t> distinct_indices(const char *call, std::span<const BodyId> ids) const;
  uint32_t add_shape(const Shape &shape);
  uint32_t add_material(const Material &material);
  void check_new(std::span<const Body> bodies) const;
  Arrival arrival_of(std::span<const Body> bodies) const;
  Arrival arrival_of(std::span<const Body> bodies, float median) const;
  bool brings_tables(const Arrival &arrival);
  bool brings_features(std::span<const uint32_t> slots);
  void note_kinds(std::span<const uint32_t> slots);
  std::vector<RosterChange> changes_of(const Arrival &arrival);
  void place_among_others(const Arrival &arrival);
  void lay_out_anew(const Arrival &arrival, const JointImpulses *impulses = nullptr);
  /* restated: bodies whose state the scene has; impulses: of the joints, if these are others than before. */
  void lay_out_anew(std::span<const uint32_t> restated = {}, const JointImpulses *impulses = nullptr);
  void plan_layout(const Arrival &arrival, std::vector<uint32_t> order);
  void stage_arrival(StagedUploads &uploads, const Arrival &arrival) const;

  /* --- islands that sleep: sleep.cpp ------------------------------------------------------------------------------ */
  bool is_filled(const std::vector<bool> &touched, Buffer buffer) const;
  std::vector<BodyRows> body_rows(const std::vector<bool> &touched) const;
  std::vector<CarriedBuffer> pair_rows(const std::vector<bool> &touched) const;
  void note_sleep(Recorder &recorder) const;
  void count_bodies(uint32_t awake);
  void count_awake_bodies();
  void sleepers_changed(bool sort_anew = true);
  void tell_sleepers(bool sort_anew = true);
  bool is_table_right() const { return plan.sleepers && !plan.other_sleepers; }
  void note_sorted();
  bool fits_table(uint32_t more) const;
  void append_fallen(uint32_t before);
  Sleepers sleepers_with(const std::vector<CarriedBuffer> &old_rows) const;
  uint64_t hash_sleepers(uint64_t seed) const;
  void recount_motion();
  void keep_order_of_events();
  void put_to_sleep();
  void take_fallen(const std::vector<uint32_t> &falls, const std::vector<uint32_t> &labels);
  void move_rows(const std::vector<uint32_t> &from, const std::vector<uint32_t> &to, bool carried);
  uint32_t bring_forward(const std::vector<uint32_t> &woken);
  void return_pairs(const std::vector<SleepingIsland> &islands, uint32_t first);
  void wake(const std::set<uint32_t> &islands);
  void wake_all();
  void wake_bodies(std::span<const uint32_t> of_slots, bool beside);
  void wake_touched();
  bool nothing_moves() const;
  void set_gravity(const Vec3 &gravity);
  void note_motion(uint32_t slot, const Velocity &velocity);

  /* --- modules of users (host/runtime/interface/module.h): extensions.cpp -------------------------------------- */
  void note_rows(Recorder &recorder, const Module &module) const;
  void check_write(Buffer buffer, size_t bytes, size_t offset) const;
  void write(Buffer buffer, const void *from, size_t bytes, size_t offset);
  void keep_unwritten() noexcept;
  void run(Kernel kernel, const Values &values, const Slots &slots);

  std::mutex reading; /* calls that read may be made beside each other */
  Scene scene;
  Settings settings;
  Settings settings_in_use; /* with the substeps of the present step */
  const bool chooses;       /* the settings asked for `auto`; settings.broadphase is what was chosen */
  TreesTrial trees_trial;
  bool chosen_moving = false;              /* whether it paused then */
  std::string chosen_for;                  /* the backend for which it was */
  std::string broadphase_why = "as asked"; /* what decided it */
  Specialisation special;
  HullSizes hulls;
  TreeTables trees;
  Features forced_features;                      /* run though the scene lacks them: forced_features.h */
  Features scene_features;                       /* what the scene needs, even if all features are run */
  std::unique_ptr<AutomaticPlacement> automatic; /* null: the placement is as asked */
  PlacedBackends backends;
  Memory memory;
  StepBuffers buffers;
  JointGraph joint_graph;
  CouplingGraph coupling_graph;
  JointOrder joint_order;
  JointSlots joint_slots;
  std::unique_ptr<PendingJoints> pending_joints;  /* null: none wait */
  std::atomic<bool> joints_wait = false;          /* the same, for what reads beside others */
  JointedLinks links;                             /* of articulations, which stay as they are */
  std::vector<JointBreak> joint_breaks;           /* of the last step */
  uint64_t joints_number = 0, joints_numbers = 0; /* the number of the present joints, and of those so far */
  uint64_t graph_number = 0;                      /* of graphs of joints since the world began */
  std::shared_ptr<const KeptJoints> kept_joints;  /* the present ones, as states that are kept share them; or null */
  BodySlots slots;
  ShapeSlots shapes;
  std::set<uint32_t> made_shapes; /* of the scene, for a body alone */
  PlacedLauncher launcher;
  StepParts parts;
  StepPlan plan;
  SceneEntries scene_entries{};            /* of counts */
  uint64_t state = 1, structure_state = 0; /* the number of the present state, and of the one that the queries'
                                              structure belongs to */
  std::vector<uint32_t> queried_bodies;    /* as tell_queried_bodies keeps them */
  bool launches_ended = true;
  std::optional<Attempt> attempt; /* what was before the step that has been attempted, and neither completed nor
                                     abandoned; none if nothing moves */
  bool turned = false;            /* the commit of an unfinished step has begun */
  bool idle = false;              /* the last step had nothing to do, so it has no events and no contacts */
  std::string lost;               /* why the world cannot go on; else empty */
  bool whole = true;              /* the last step succeeded; after one that failed there are no events or figures */
  /* Bodies that an unfinished step has quarantined, by their index in the buffers, with their earlier records. */
  std::vector<std::pair<uint32_t, BodyRecord>> taken_out;
  std::vector<uint32_t> index_of_body;   /* by slot; for a free one, that of its last body */
  std::vector<uint32_t> order_of_events; /* the order that the last step had, if it has changed since; else empty */
  /* What the last step has moved, if the buffers were laid out anew since. */
  std::optional<std::vector<uint32_t>> moved_before;
  size_t uploaded_shapes = 0, uploaded_materials = 0; /* of the scene, that the tables hold */
  /* Kinds of bodies that were in the scene together when its features were last derived; filled by the first call that
   * creates or changes some. */
  std::set<BodyKind> known_kinds;
  CommandList commands, force_commands; /* not applied yet */
  Sleepers sleepers;
  uint64_t set_of_sleepers = 0, sets_of_sleepers = 0;         /* the number of the present set, and of those so far */
  std::vector<SleepEvent> sleep_events, sleep_events_to_come; /* of the last step, and since it ended */
  std::vector<uint32_t> set_elsewhere;  /* slots of the bodies that commands not applied yet put elsewhere */
  std::set<uint32_t> moving_kinematics; /* slots */
  uint32_t awake_dynamics = 0;
  uint32_t sorted_sleepers = 0, listed_sleepers = 0; /* entries of their table, while it is right */
  uint32_t counted_bodies = 0;                       /* that kernels see: those awake, or for queries all */
  uint64_t quiet_state = 0;                          /* the state that the last step left */
  std::vector<Quarantine> quarantined;
  std::optional<BatchFault> fault;
  Statistics statistics;
  /* The substeps that the parameters on the device have, and those of the cache that they know. */
  struct ToldSubsteps {
    uint32_t now = 0, of_cache = 0;
    bool islands_apart = false;
    bool operator==(const ToldSubsteps &) const = default;
  };
  ToldSubsteps told_substeps;
  std::optional<uint64_t> first_outgrown; /* the first step that found more pairs than there was room for */
  uint32_t first_world = 0;               /* of a group: its number in the batch */
  uint32_t cached_pairs = 0;              /* in the contact cache, as cached_start says */
  uint32_t awake_at_last = 0;             /* bodies, in the last step */
  StateRing ring;
  std::unique_ptr<CallLog> log; /* of the recording, if one is made */
};

} // namespace tandem
