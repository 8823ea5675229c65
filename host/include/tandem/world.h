/* world.h - a scene being simulated: the class that programs use.
 *
 *   World world(load_scene("box-grid:nx=8,ny=8,nz=8"), Settings{}, Placement{"cl"});
 *   for (int i = 0; i < 60; ++i) world.step();
 *   std::vector<BodyState> bodies = world.bodies();
 *
 * Several worlds may be used in several threads at once. Of one world, calls that read it may be made beside each
 * other: those that return bodies, properties, handles, events, answers of queries, statistics, hashes, contents of
 * buffers or a snapshot. A call that changes it may be made beside no other call to it. Tasks of TBB's may make calls,
 * too. Large snapshots and copies take threads of TBB's on every backend, no more than the arena of the caller and
 * tbb::global_control allow.
 *
 * A step is applied completely or not at all: overflow grows the buffers and runs the step again, and a body that stops
 * being finite is quarantined and reported.
 */
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tandem/backend.h>
#include <tandem/bodies.h>
#include <tandem/events.h>
#include <tandem/export.h>
#include <tandem/features.h>
#include <tandem/queries.h>
#include <tandem/recording.h>
#include <tandem/scene.h>
#include <tandem/settings.h>

namespace tandem {

/* Internal types, declared for those who compare or profile the pipeline and defined in host/runtime/. An extension of
 * the pipeline needs only <tandem/module.h>. */
class Backend;
class Memory;
struct Launch;
TANDEM_API const char *name_of(Kernel kernel);
TANDEM_API const char *name_of(Buffer buffer);

struct BodyState {
  Point position;
  Quat orientation;
  Vec3 linear_velocity;
  Vec3 angular_velocity;
};

/* The same in the precision that is available: in double if everything runs on the reference backend. */
struct PreciseBodyState {
  Point position;
  std::array<double, 4> orientation;
  std::array<double, 3> linear_velocity, angular_velocity;
};

/* The figures of a step. Penetration is measured over the contact points of the step's collision detection: metres,
 * positive if shapes overlap; a contact point that does not touch yet counts as 0. */
struct Statistics {
  uint64_t steps = 0;
  uint32_t pairs = 0;     /* overlapping bounds */
  uint32_t contacts = 0;  /* contact points */
  uint32_t manifolds = 0; /* touching pairs */
  uint32_t colors = 0;
  double max_penetration = 0;
  double mean_penetration = 0;
  double kinetic_energy = 0; /* J, linear and angular */
  uint32_t nonfinite = 0;    /* bodies quarantined so far */
  uint32_t overflow = 0;     /* steps that ran again with larger buffers */
  uint32_t substeps = 0;     /* of the next step; with automatic_substeps it changes */
  uint32_t bodies_with_more_substeps =
      0;               /* with automatic_substeps: that the last step gave so many, others the fewest */
  uint32_t asleep = 0; /* bodies that sleep; without Settings::sleeping none do */
  uint32_t sleeping_islands = 0;
  /* Of the last step, with the solver `direct` only: */
  uint32_t direct_islands = 0; /* islands that it solved */
  uint32_t direct_left = 0;    /* touching pairs, joints and couplings in islands too large for it, left to
                                  the iterative solver */
  uint32_t direct_stalled = 0; /* solves, over the passes of the step, that did not reach their tolerance */
};

/* What one step may need, for programs that must not wait for a step without bound: a thousand balls in one place are
 * half a million pairs, and each of them is coloured and solved after others. */
struct StepLimits {
  uint32_t pairs = UINT32_MAX;               /* of bodies whose bounds overlap, or of their parts */
  uint32_t rounds = UINT32_MAX;              /* of colouring: each colours contacts that no other one waits for */
  uint32_t sequential_contacts = UINT32_MAX; /* beyond the last colour, which are solved one after another */
};

/* The time of one kernel over the steps since the last call. */
struct KernelTime {
  Kernel kernel;
  std::string backend;
  double milliseconds; /* total */
  uint64_t launches;
};

/* Where the next step runs, and why. */
struct PlacementReport {
  std::string on;      /* "tbb", or "cl:0.0 with narrowphase on tbb" */
  std::string why;     /* in one line; "as asked" unless the placement is automatic */
  bool settled = true; /* false while candidates are being built and measured */
  struct Time {
    std::string on;
    double milliseconds; /* of a step */
  };
  std::vector<Time> times; /* of all candidates that the last measurement had */
  struct StageTimes {
    std::string stage;
    double on_cpu, on_device; /* ms of kernels a step */
  };
  std::vector<StageTimes> stages;
  /* What `tbb` ran because kernels of devices were being built (Placement::start, Placement::build_in_background). */
  struct Building {
    uint64_t steps_on_cpu = 0;     /* so far */
    uint64_t moved_after = 0;      /* the steps that had been made after the last of them */
    double milliseconds = 0;       /* while it was so, up to now */
    size_t built = 0, kernels = 0; /* of what was begun last */
  } building;
};

class TANDEM_API World {
public:
  World(const Scene &scene, const Settings &settings = {}, const Placement &placement = {});
  /* A world as save() found it, on any placement. extensions: those of the settings of the world that was saved, with
   * the same modules in the same order, because a snapshot holds no functions; `prepare` of them is not called, and
   * buffers of modules have the contents that they had. Throws InputError if the bytes are damaged, cut off, of another
   * format or no snapshot, and whatever the constructor above throws. */
  explicit World(std::span<const std::byte> snapshot, const Placement &placement = {},
                 std::vector<Extension> extensions = {});
  ~World();

  /* All that decides the bits of the next steps and calls: the scene, the settings, bodies with their handles, free
   * indices, and what steps hand on to each other. Calls so far are part of it. It does not depend on the backends: a
   * world that is made of it anywhere goes on with the same bits. Only the reference backend loses what its doubles
   * have beyond floats. The events and contact figures of the last step are not part of it. Bytes are little-endian and
   * carry their format and a hash (docs/recordings.md). */
  std::vector<std::byte> save();
  /* The same into bytes whose memory is used again, which takes less time for large worlds that are saved often.
   * If it throws, the bytes are lost. */
  void save(std::vector<std::byte> &bytes);
  /* Makes this world what it was, or another world was, when save() was called; settings and scene become those of the
   * snapshot, placement, observer and profiling stay. Calls that no step has applied yet are dropped. Handles of bodies
   * that were created since are stale: they may name no body, or, if bodies are created again, another one. References
   * that scene(), settings(), memory() and others returned before become invalid. If it throws (as the constructor
   * does), the world is unchanged. */
  void restore(std::span<const std::byte> snapshot);

  /* Writes from now on what is done with this world to a file: a snapshot, each call with its arguments, and a hash a
   * step (<tandem/recording.h>). Placements, queries that return their hits, and other reading are not part of it.
   * States that were kept before are forgotten. The file is complete up to the last step at any time, in case the
   * program ends without stop_recording. Throws InputError if the file cannot be written. If writing fails later, the
   * world goes on, and stop_recording throws InputError. A world records to one file at a time; a second call ends the
   * first recording. */
  void start_recording(const std::string &path, const RecordingOptions &options = {});
  void stop_recording(); /* does nothing unless the world records */

  /* --- the last states ---
   * They stay in the memory of the devices that made them, so that keeping one costs a copy there and nothing goes
   * through the host. */

  /* Makes room for so many states, 0 to 10,000, and keeps the present one, calls included; those kept before are gone.
   * after_steps: each step keeps its state, in place of the oldest. 0 frees the room. OutOfMemory: nothing has
   * changed. */
  void keep_states(uint32_t states, bool after_steps = true);
  void keep_state(); /* keeps the present state, calls so far included; InputError without room */
  uint32_t states_kept() const;
  /* Returns to a state that was kept, 0 the newest, states_kept() - 1 the oldest; the next steps have the same bits as
   * the steps after it had. The states after it are forgotten, calls since then are dropped, and bodies that came or
   * went since are as they were; as restore() says, handles made since are stale. There are no events and contact
   * figures until a step. What World::write wrote to buffers of modules stays. Throws InputError if the state is not
   * kept: a call that lays the buffers out anew (the first body of a new kind, more room for bodies) and restore()
   * forget all states, and the message says so. The world is then unchanged. */
  void go_back(uint32_t states);

  /* Advances by settings.step. Throws std::runtime_error if a device fails, memory runs out (OutOfMemory: what was
   * requested, and for how many bodies and pairs) or more pairs are found than Settings::max_pairs. The state is then
   * that before the step, but that islands which it had woken stay awake, and the world can be stepped again. Until a
   * step succeeds there are no events and no contact figures. Only if a device fails or memory runs out when the step
   * has been made and bodies fall asleep, the world cannot go on: this and later calls say so, until restore(). */
  void step() { step(StepLimits{}); }
  /* The same with a budget. Throws LimitExceeded, as soon as the step knows that it needs more, and says what. The
   * state is then that before the step. What the limits do not exceed has the same bits as without them. */
  void step(const StepLimits &limits);

  /* Moves kernels to other backends from the next step on; the results keep their bits. Buffers are moved when they are
   * first needed there. If it throws (InputError, or a device's std::runtime_error), the placement is unchanged. */
  void place(const Placement &placement);

  PlacementReport placement_report() const;
  /* False while `tbb` runs kernels that are being built for a device (Placement::start). A step takes them over when
   * they are ready. If the driver could not build them, the step, or an earlier call that asks for a kernel of the
   * device, throws what it said; what comes after that tries again. */
  bool is_placed() const;
  /* Waits for these kernels, at most so long, and takes them over; returns is_placed(). Throws as the step would. */
  bool wait_until_placed(double seconds = std::numeric_limits<double>::infinity());

  const Scene &scene() const;
  const Settings &settings() const;          /* with the broadphase that `auto` has chosen for the next step */
  const std::string &broadphase_why() const; /* what decided it, in one line; "as asked" without `auto` */

  /* In the order of Scene::bodies; for a body that was destroyed, where it was last, at rest. */
  std::vector<BodyState> bodies();
  std::vector<PreciseBodyState> precise_bodies();
  void set_body(uint32_t body, const BodyState &state); /* InputError unless finite and in range */
  /* Does the same without the check, so that tests can set a NaN. */
  void set_body_unchecked(uint32_t body, const BodyState &state);

  /* --- bodies at run time (<tandem/bodies.h>) ---
   * Each call takes effect completely or, if it throws, not at all. InputError: a handle is stale or unknown, a number
   * is not finite, or a body cannot be simulated; the message names the first entry at fault. */

  /* Handle of the body with this index, which Scene::bodies, events and hits of queries use. */
  BodyId id_of(uint32_t body) const;
  bool exists(const BodyId &id) const;
  std::vector<BodyId> body_ids() const; /* of all bodies that exist, in the order of their indices */
  uint32_t body_count() const;          /* of the bodies that exist */

  /* Adds bodies of the shapes and materials of scene(), as they are in it now. What they need is checked as validate()
   * does. Returns their handles in the same order. */
  std::vector<BodyId> create_bodies(std::span<const Body> bodies);
  BodyId create_body(const Body &body) { return create_bodies(std::span(&body, 1)).front(); }
  /* Removes bodies. In the next step the events of their contacts end. */
  void destroy_bodies(std::span<const BodyId> ids);
  void destroy_body(const BodyId &id) { destroy_bodies(std::span(&id, 1)); }
  /* Adds a shape or a material that bodies created later may use; returns its index in scene(). */
  uint32_t add_shape(const Shape &shape);
  uint32_t add_material(const Material &material);

  /* Changes properties of bodies, in the order of the entries, after all calls so far. scene() then has the new values.
   * The message of an InputError names the body. The first filter, trigger, damping, continuous body and so on of a
   * world brings in new kernels and buffers, which takes longer than later changes. A body that becomes continuous
   * stays among the small ones in the grid, whose cells must then hold its way through a step. */
  void set_properties(std::span<const BodyId> ids, std::span<const BodyProperties> properties);
  void set_properties(const BodyId &id, const BodyProperties &properties)
  {
    set_properties(std::span(&id, 1), std::span(&properties, 1));
  }
  void set_type(const BodyId &id, BodyType type) { set_properties(id, {.type = type}); }
  void set_trigger(const BodyId &id, bool trigger) { set_properties(id, {.trigger = trigger}); }
  void set_continuous(const BodyId &id, bool continuous) { set_properties(id, {.continuous = continuous}); }
  void set_material(const BodyId &id, uint32_t material) { set_properties(id, {.material = material}); }
  void set_mass(const BodyId &id, float mass) { set_properties(id, {.mass = mass}); }
  void set_mass(const BodyId &id, float mass, const Vec3 &inertia)
  {
    set_properties(id, {.mass = mass, .inertia = inertia});
  }
  void set_gravity_factor(const BodyId &id, float factor) { set_properties(id, {.gravity_factor = factor}); }
  void set_damping(const BodyId &id, float linear, float angular)
  {
    set_properties(id, {.linear_damping = linear, .angular_damping = angular});
  }
  void set_filter(const BodyId &id, uint32_t group, uint32_t mask)
  {
    set_properties(id, {.filter_group = group, .filter_mask = mask});
  }
  void set_locks(const BodyId &id, const Axes &linear, const Axes &angular)
  {
    set_properties(id, {.linear_locks = linear, .angular_locks = angular});
  }
  void set_max_speeds(const BodyId &id, float linear, float angular)
  {
    set_properties(id, {.max_linear_speed = linear, .max_angular_speed = angular});
  }
  void set_user_data(const BodyId &id, uint64_t data) { set_properties(id, {.user_data = data}); }
  /* The body as it is in scene(): with its present properties, and the pose and velocity that it was created with. */
  Body body_description(const BodyId &id) const;

  /* Shapes of bodies. The shapes of a body are the children of its compound, in their order, or its only shape. An
   * added one lies in the same frame as the others, that of Body::shape_position and shape_orientation; if the body is
   * not a compound yet, it becomes one. The frame stays where it is in the world. If a dynamic body has no inertia of
   * the user's (Body::inertia is 0), its mass follows at the density that it has, its position becomes the new centre
   * of mass, and its velocity that of this point; other bodies keep all that. InputError: as compound_shape and
   * validate() say; a half-space; the last shape of a body. Each call lays out the tables of shapes anew, so many
   * changes should be one call. */
  std::vector<ShapeId> add_shapes(std::span<const BodyId> ids, std::span<const Child> shapes);
  ShapeId add_shape_to(const BodyId &id, const Child &shape)
  {
    return add_shapes(std::span(&id, 1), std::span(&shape, 1)).front();
  }
  void remove_shapes(std::span<const ShapeId> ids);
  void remove_shape(const ShapeId &id) { remove_shapes(std::span(&id, 1)); }
  std::vector<ShapeId> shapes_of(const BodyId &id);
  BodyId body_of(const ShapeId &id) const;

  /* --- joints at run time (<tandem/joints.h>) ---
   * As with bodies, each call takes effect completely or not at all, and InputError names the first entry at fault.
   * Bodies of joints that a call makes, changes or destroys wake. All but the changes of axes colour the joints of the
   * world anew, which takes time for each of them. After the first one, joints that are created and destroyed wait for
   * that until the next step or read, so a call takes microseconds, and memory may run out there; scene(), memory() and
   * all that tells of bodies or joints but their handles is such a read. Where bodies sleep, or a joint needs kernels
   * that the world has not built, a call does all at once. Many changes of set_joints() should be one call. */

  JointId id_of_joint(uint32_t joint) const; /* of the joint with this index in Scene::joints */
  bool exists(const JointId &id) const;
  std::vector<JointId> joint_ids() const; /* of all that exist, in the order of their indices */

  /* Adds joints, which validate() checks. */
  std::vector<JointId> create_joints(std::span<const Joint> joints);
  JointId create_joint(const Joint &joint) { return create_joints(std::span(&joint, 1)).front(); }
  /* What is left in scene() is a joint without bodies that is not enabled. A body that is destroyed takes its joints
   * with it. */
  void destroy_joints(std::span<const JointId> ids);
  void destroy_joint(const JointId &id) { destroy_joints(std::span(&id, 1)); }
  /* Makes joints what is given: frames, limits, drives, whether they are enabled, and all else. A joint keeps its
   * impulses if it has the bodies, the type and the kinds of axes that it had. */
  void set_joints(std::span<const JointId> ids, std::span<const Joint> joints);
  void set_joint(const JointId &id, const Joint &joint) { set_joints(std::span(&id, 1), std::span(&joint, 1)); }
  /* Changes axes: targets of motors and springs, limits, friction. Cheap where an axis was limited, driven or braked
   * before and is so afterwards; else as set_joints. */
  void set_joint_axes(std::span<const JointId> ids, std::span<const JointAxisChange> changes);
  void set_joint_axis(const JointId &id, uint32_t axis, const JointAxis &to)
  {
    const JointAxisChange change{axis, to};
    set_joint_axes(std::span(&id, 1), std::span(&change, 1));
  }
  /* Sets what the actuators of the scene set, by set_joint_axes: controls[k] is that of Scene::actuators[k], as
   * number_at takes it. InputError unless there is a finite one for each. */
  void set_controls(std::span<const float> controls);
  std::vector<JointReading> read_joints(std::span<const JointId> ids);
  JointReading read_joint(const JointId &id) { return read_joints(std::span(&id, 1)).front(); }
  /* Those that broke in the last step, in the order of their indices. */
  const std::vector<JointBreak> &joint_breaks() const;

  std::vector<BodyState> read_bodies(std::span<const BodyId> ids);
  BodyState read_body(const BodyId &id) { return read_bodies(std::span(&id, 1)).front(); }
  void set_states(std::span<const BodyId> ids, std::span<const BodyState> states);
  void set_state(const BodyId &id, const BodyState &state) { set_states(std::span(&id, 1), std::span(&state, 1)); }
  /* Fixed bodies ignore velocities, impulses and forces; kinematic ones ignore impulses and forces. */
  void set_velocities(std::span<const BodyId> ids, std::span<const Velocity> velocities);
  void set_velocity(const BodyId &id, const Velocity &v) { set_velocities(std::span(&id, 1), std::span(&v, 1)); }
  /* Gives kinematic bodies the velocities with which they reach these poses at the end of the next step, and which they
   * keep afterwards. */
  void move_to(std::span<const BodyId> ids, std::span<const Pose> poses);
  void move_to(const BodyId &id, const Pose &pose) { move_to(std::span(&id, 1), std::span(&pose, 1)); }
  void add_impulses(std::span<const BodyId> ids, std::span<const Impulse> impulses);
  void add_impulse(const BodyId &id, const Impulse &impulse)
  {
    add_impulses(std::span(&id, 1), std::span(&impulse, 1));
  }
  /* Forces act throughout the next step, and several add up. From the first call on, steps of this world have a stage
   * of forces. */
  void add_forces(std::span<const BodyId> ids, std::span<const Force> forces);
  void add_force(const BodyId &id, const Force &force) { add_forces(std::span(&id, 1), std::span(&force, 1)); }

  /* Bodies that touch each other fall asleep together when all of them have rested for Settings::sleep_time. They wake
   * when a body that is awake touches one of them, when one of them is changed by a call, and when a body beside them
   * is destroyed or set elsewhere. */
  bool is_asleep(const BodyId &id) const;
  void wake_bodies(std::span<const BodyId> ids);
  void wake_body(const BodyId &id) { wake_bodies(std::span(&id, 1)); }
  /* Who fell asleep in the last step, and who woke in it or between it and the step before. */
  const std::vector<SleepEvent> &sleep_events() const;

  /* m/s^2, from the next step on; wakes all bodies. InputError unless finite. */
  void set_gravity(const Vec3 &gravity);

  /* The events of the last step, sorted by (a, b); there are none before the first step. A step that ran again with
   * larger buffers reports them once. Throws InputError without Settings::events. */
  std::vector<ContactEvent> contact_events();
  /* The contacts of the last step that began with an approach above Settings::hit_speed, sorted by (a, b). Throws
   * InputError without Settings::events. */
  std::vector<HitEvent> hit_events();
  /* The bodies whose pose the last step has changed, as indices into Scene::bodies, ascending; calls between steps
   * count in none. There are none before the first step. Throws InputError without Settings::moved_bodies. */
  std::vector<uint32_t> moved_bodies();
  /* The events of the last step, sorted by (a, b); there are none before the first step. Throws InputError without
   * Settings::pair_events. */
  std::vector<PairEvent> pair_events();
  /* Queries of the present state, in batches. They run where the stage `queries` is placed (shape casts: `sweeps`) and
   * change nothing. Answers have the order of the queries and the same bits on every backend. Throws InputError as
   * check_rays, check_boxes and check_shape_casts of host/world/queries.h do. */
  std::vector<RayHit> cast_rays(std::span<const Ray> rays);
  /* Whether each ray hits anything; cheaper, because the search stops at the first body that it finds. */
  std::vector<bool> cast_rays_any(std::span<const Ray> rays);
  /* Every body that each ray hits, sorted by (fraction, body). */
  std::vector<std::vector<RayHit>> cast_rays_all(std::span<const Ray> rays);
  /* Every body whose AABB a box touches, at its start or along its displacement; sorted by (fraction, body). */
  std::vector<std::vector<BoxHit>> cast_boxes(std::span<const QueryBox> boxes);
  /* Casts a convex shape from each pose along a displacement, without rotation; finds where it first touches a body. */
  std::vector<ShapeCastHit> cast_shapes(const Shape &shape, std::span<const Pose> poses,
                                        std::span<const Vec3> displacements, const QueryFilter &filter = {});
  /* Every body whose shape overlaps a convex shape, for each pose, sorted by body. The test is that of the shapes
   * themselves, which a shape cast starts with. Bodies that overlap are found, and none that lies apart by more than
   * rounding, 2e-6 of the sizes of both. Throws InputError as check_overlaps of host/world/queries.h does. */
  std::vector<std::vector<uint32_t>> overlap_shapes(const Shape &shape, std::span<const Pose> poses,
                                                    const QueryFilter &filter = {});

  /* The closest points of the two bodies of each pair; of a compound or a mesh those of its nearest part. They run
   * where the stage `queries` is placed. Exchanging the bodies of a pair exchanges the points, to the bit. The
   * distance is too large by no more than rounding, 2e-6 of the sizes of both bodies and the distance between them;
   * where round shapes make the search slow, it may be too small by 1e-5 of these. The points are as far apart as it
   * says, to 1e-3 of the sizes. For a half-space the distance of the other body from its origin counts among the sizes.
   * Bodies farther apart than 1e18 m have no meaningful answer. Throws InputError that names the entry with a stale
   * handle, the same body twice, two half-spaces, or a body in quarantine. */
  std::vector<ClosestPoints> closest_points(std::span<const std::pair<BodyId, BodyId>> pairs);

  /* Cast as by the functions above, and leave the hits where the kernel runs, for kernels of modules: nothing is read
   * back. Row i of the buffers query_hit, query_point and query_hit_body (shared/buffers.def) is the hit of query i:
   * normal and fraction; the point, from the start of the query; the index of the body in the scene, or no_body. They
   * hold until the next query or step, or a call that wakes bodies, lays buffers out anew or starts a recording; a
   * kernel that reads them afterwards is refused (docs/your-own-kernel.md). */
  void cast_rays_on_device(std::span<const Ray> rays);
  void cast_shapes_on_device(const Shape &shape, std::span<const Pose> poses, std::span<const Vec3> displacements,
                             const QueryFilter &filter = {});

  /* For modules of Settings::extensions, between steps: runs a kernel over the items of its row, and writes the
   * module's buffers. Throws InputError if the kernel or buffer belongs to no such module, or the bytes do not fit; a
   * buffer of capacity NOTHING takes any number of items. What is written is visible from the next launch on. Before
   * the first step there are no COMMIT_ items and no pairs. */
  void run(Kernel kernel, std::span<const uint32_t> values = {}, std::span<const Buffer> slots = {});
  template <class T> void write(Buffer buffer, std::span<const T> values, size_t first = 0)
  {
    write_bytes(buffer, values.data(), values.size_bytes(),
                first > SIZE_MAX / sizeof(T) ? SIZE_MAX : first * sizeof(T));
  }
  /* Reads all of any buffer that this world has, the pipeline's included, as the last launch left it. Where stages run
   * in several memories, what lies behind the rows in use is undefined. Scratch whose memory another buffer has taken
   * in the same step is refused (InputError); a world that has modules or an observer leaves each its own. */
  template <class T> std::vector<T> read(Buffer buffer)
  {
    std::vector<T> values(buffer_bytes(buffer) / sizeof(T));
    read_bytes(buffer, values.data(), values.size() * sizeof(T));
    return values;
  }
  void write_bytes(Buffer buffer, const void *from, size_t bytes, size_t offset = 0);
  size_t buffer_bytes(Buffer buffer) const;
  void read_bytes(Buffer buffer, void *to, size_t bytes);

  Statistics statistics();
  /* A hash of the bodies, the contact cache, the substeps that the world has chosen, and the STATE and CACHE buffers of
   * modules. If two worlds have equal scenes, settings and written buffers, it is equal iff their next steps will be
   * equal. */
  uint64_t state_hash();
  uint64_t body_hash(); /* poses and velocities alone */
  const std::vector<Quarantine> &quarantined() const;
  const std::optional<BatchFault> &batch_fault() const; /* the first so far; only with Settings::check */

  /* Waits for the devices, so that a clock read afterwards includes their work, and, unless the world may start on the
   * CPU (Placement::start), for kernels that are being built for them. */
  void finish();
  /* Builds at once what a GPU would build in the background after some hundred steps: a program that runs many launches
   * of few items as one (docs/pipeline.md, "Launches"). The steps so far tell which, so call it after some of them,
   * while nobody waits for the next, and again where others follow, as when bodies first fall asleep. Results are the
   * same without it. If the driver fails to build it, throws std::runtime_error and changes nothing. The end of a world
   * waits for what is being built, up to some ten seconds. */
  void prepare_kernels();
  /* Makes room for so many pairs of bodies whose bounds overlap. A world begins with room for two a body and makes more
   * when a step needs it, which then takes several times as long, so reserve what a scene will need if no frame may be
   * late: a settled pile has four to five pairs a body, some 300 bytes each. InputError: more than Settings::max_pairs.
   * OutOfMemory: bodies and the room are as they were. Neither this nor the next call changes any motion; after both,
   * contacts and events of the last step are no longer listed. */
  void reserve_pairs(uint32_t pairs);
  /* Gives back the room for pairs beyond those of the last step and of states that were kept, and an eighth more. */
  void shrink_to_fit();
  /* Measures each kernel, which therefore has launches of its own. */
  void set_profiling(bool on);
  std::vector<KernelTime> take_kernel_times();

  /* The mask of FEATURE_ bits in use, and the kernels, buffers and backends that follow from it. */
  Features features() const;
  std::vector<Kernel> kernels() const;
  Memory &memory();
  /* Buffers of a step share memory, so that most of them have lost their contents when it ends. From the next step on
   * this one keeps them. */
  void keep_after_steps(Buffer buffer);
  Backend &backend_of(Kernel kernel);
  double build_milliseconds() const;
  /* Launches that backends have made so far, without kernels of the host alone; joined ones count as one. */
  uint64_t launches() const;
  /* What steps and calls have copied so far between memories, where stages are placed on backends that share none. */
  uint64_t bytes_moved() const;
  /* How often the host has read so far from memory that is not its own: whole buffers that move, and parts such as the
   * counts at the end of a step. Each time it waits for the device. */
  uint64_t device_reads() const;
  /* The work-groups of the largest launch that joins others: 1 where only launches of few items are joined, or none. */
  uint32_t resident_groups() const;

  /* Called after every launch of a step, in order; the comparison of backends uses it. */
  using Observer = std::function<void(const Launch &)>;
  void set_observer(Observer observer);
  /* The index into Scene::bodies for an index of the body buffers (large bodies come first there). */
  uint32_t scene_body(uint32_t buffer_index) const;

private:
  friend class Worlds; /* <tandem/worlds.h>: a batch of worlds is one of these, whose bodies are those of all */
  friend std::unique_ptr<World> world_with_features(const Scene &, const Settings &, const Placement &, Features);
  struct Implementation;
  explicit World(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

} // namespace tandem
