/* worlds.h - thousands of small worlds, stepped together: for learning, for search among futures, for tolerances.
 *
 *   Worlds worlds(load_scene("box-stack:n=10"), 4096, Settings{}, Placement{"cl"});
 *   worlds.set_gravity(7, {0, -1.6f, 0});
 *   for (int i = 0; i < 60; ++i) worlds.step();
 *   std::vector<BodyState> bodies = worlds.bodies(); // that of body b in world w at [w * worlds.bodies_of_world() + b]
 *   worlds.reset(3);
 *
 * On a device all worlds go through one set of launches; threads of a CPU take groups of them through a step each. A
 * world has the bits that it would have alone, as a World of its scene, on every backend: it does not matter how many
 * others there are, what they do, and which index it has. Buffers are shared and grow; no contact is dropped.
 *
 * Worlds of a batch have equally many bodies, which none of them gains or loses, and one Settings. Pairs are looked for
 * among all bodies of a world, which suits worlds of up to some hundreds of bodies. InputError says of Settings what a
 * batch does not have: sleeping, substeps chosen by the world, modules, checks, solvers other than soft_step, batchers
 * other than coloring, a broadphase of one's own (docs/many-worlds.md).
 *
 * Of one batch, only one call may be made at a time; several batches may be used beside each other. Calls that change
 * bodies take effect completely or, if they throw, not at all, in the order in which they are made.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tandem/actuators.h>
#include <tandem/backend.h>
#include <tandem/bodies.h>
#include <tandem/events.h>
#include <tandem/export.h>
#include <tandem/scene.h>
#include <tandem/settings.h>
#include <tandem/world.h>

namespace tandem {

/* A body of a batch: `body` is its index in the scene of its world. */
struct WorldBody {
  uint32_t world, body;
};

/* A joint of a batch: `joint` is its index in the scene of its world. */
struct WorldJoint {
  uint32_t world, joint;
};

/* An axis that is controlled in all worlds of a batch: of the joint with this index in the scene of each. */
struct ControlledAxis {
  uint32_t joint = 0;
  uint32_t axis = 3; /* 0 to 2: directions x, y, z; 3 to 5: rotations */
  Control what = Control::force;
};

/* The events of all worlds; their bodies are numbered as in the scenes of the worlds. */
template <class Event> struct WorldEvents {
  std::vector<Event> all;    /* world after world */
  std::vector<size_t> first; /* the first event of each world, and the end */
  std::span<const Event> of(uint32_t world) const
  {
    const size_t begin = first.at(world), end = first.at(size_t{world} + 1);
    return std::span(all).subspan(begin, end - begin);
  }
};

class TANDEM_API Worlds {
public:
  /* So many copies of a scene. Throws InputError as World does; without worlds; if there are more bodies than kernels
   * can number; and for settings that a batch does not have. */
  Worlds(const Scene &scene, uint32_t worlds, const Settings &settings = {}, const Placement &placement = {});
  /* A world of each scene: other places, shapes, materials, masses and gravity, but as many bodies. */
  explicit Worlds(std::span<const Scene> scenes, const Settings &settings = {}, const Placement &placement = {});
  ~Worlds();

  uint32_t count() const;           /* of worlds */
  uint32_t bodies_of_world() const; /* of each */
  const Settings &settings() const;
  /* The scene of one world, with its gravity and the present properties of its bodies. */
  Scene scene(uint32_t world) const;

  /* Advances all worlds by settings.step, as World::step() does. If it throws, all worlds are as before the step. */
  void step() { step(StepLimits{}); }
  void step(const StepLimits &limits);
  /* The steps of a world since it was made or reset. */
  uint64_t steps(uint32_t world) const;

  /* Makes worlds what they were at first: bodies where they started, no contacts, no forces, none in quarantine. They
   * go on with the bits of a new World of scene(world): gravity and properties that were set stay. Calls to them that
   * no step has applied yet are dropped. Worlds may be given twice. */
  void reset(std::span<const uint32_t> worlds);
  void reset(uint32_t world) { reset(std::span(&world, 1)); }
  /* The same, and then puts their bodies elsewhere: states[k * bodies_of_world() + b] is that of body b of the k-th of
   * the worlds. The start stays where it was. */
  void reset(std::span<const uint32_t> worlds, std::span<const BodyState> states);

  /* m/s^2, from the next step on. InputError unless finite. */
  void set_gravity(std::span<const uint32_t> worlds, std::span<const Vec3> gravity);
  void set_gravity(uint32_t world, const Vec3 &gravity) { set_gravity(std::span(&world, 1), std::span(&gravity, 1)); }

  /* Of all worlds, [world, body]; or of one. */
  std::vector<BodyState> bodies();
  std::vector<BodyState> bodies(uint32_t world);
  /* All bodies in the order of bodies(), for the calls below. */
  const std::vector<WorldBody> &every_body() const;

  /* As the functions of World with these names, with an entry for each body. */
  void set_states(std::span<const WorldBody> bodies, std::span<const BodyState> states);
  void set_velocities(std::span<const WorldBody> bodies, std::span<const Velocity> velocities);
  void move_to(std::span<const WorldBody> bodies, std::span<const Pose> poses);
  void add_impulses(std::span<const WorldBody> bodies, std::span<const Impulse> impulses);
  void add_forces(std::span<const WorldBody> bodies, std::span<const Force> forces);
  /* Materials are those of the scene of the body's world. */
  void set_properties(std::span<const WorldBody> bodies, std::span<const BodyProperties> properties);
  void set_state(const WorldBody &body, const BodyState &state)
  {
    set_states(std::span(&body, 1), std::span(&state, 1));
  }
  /* Does the same without a check, so that tests can set a NaN. */
  void set_state_unchecked(const WorldBody &body, const BodyState &state);

  /* The same with an entry for each joint. Axes keep their kind: one that was neither limited, driven nor braked is not
   * from then on, because the tables of a batch have no room for it. */
  void set_joint_axes(std::span<const WorldJoint> joints, std::span<const JointAxisChange> changes);

  /* Chooses what set_controls sets, instead of what was chosen before. Throws InputError if a world has no such joint
   * or axis, if an axis is given twice with the same control, and if its drive cannot follow: a force needs damping (a
   * little is enough), a target position stiffness, a target velocity damping or a motor. */
  void choose_controls(std::span<const ControlledAxis> axes);
  /* The same for actuators, such as those of scene(0). set_controls then takes their controls, as number_at does, with
   * the bits that these numbers have with the axes chosen. */
  void choose_controls(std::span<const Actuator> actuators);
  /* From the next step on, as set_joint_axes does it for few joints, with the same bits, but quickly for many:
   * values[world * controls + k], or values[i * controls + k] for the i-th of the worlds given, is that of the k-th
   * axis or actuator chosen; N or N m, m or rad, m/s or rad/s, or in the units of the actuator. They stay until they
   * are set again, also when a world is reset. InputError unless there is a finite one for each. */
  void set_controls(std::span<const float> values);
  void set_controls(std::span<const uint32_t> worlds, std::span<const float> values);

  std::vector<JointReading> read_joints(std::span<const WorldJoint> joints);

  /* Of the last step, as those of World; a world that was reset since has none. */
  WorldEvents<ContactEvent> contact_events();
  WorldEvents<HitEvent> hit_events();
  WorldEvents<PairEvent> pair_events();
  WorldEvents<uint32_t> moved_bodies();
  /* The joints that broke; JointBreak::joint has the index in the scene of the world. A reset makes them whole. */
  WorldEvents<JointBreak> joint_breaks() const;
  /* The bodies of a world that were taken out of it since it was made or reset; `step` counts as steps() does. */
  std::vector<Quarantine> quarantined(uint32_t world) const;
  Statistics statistics(); /* over all worlds; steps: of the batch; overflow: the most of any group of worlds */

  /* What body_hash and state_hash of the world would be alone; or of all worlds. */
  uint64_t body_hash(uint32_t world);
  std::vector<uint64_t> body_hashes();
  uint64_t state_hash(uint32_t world);
  std::vector<uint64_t> state_hashes();

  /* A World that goes on with the bits of this one of the batch, and that world as World::save() writes it. */
  std::unique_ptr<World> alone(uint32_t world, const Placement &placement = {});
  std::vector<std::byte> save(uint32_t world);
  /* Puts a world that save() or World::save() wrote in the place of this one, whose scene must be that of the snapshot
   * but for gravity, which comes with it: one world may be tried out in many places. It takes as long as reading all
   * contacts of the batch. InputError if the scenes differ, or as World's constructor says of the bytes. */
  void load(uint32_t world, std::span<const std::byte> snapshot);

  /* As those of World; launches, and times of kernels, are sums over groups that threads step at the same time. */
  PlacementReport placement_report() const;
  bool is_placed() const;
  bool wait_until_placed(double seconds = std::numeric_limits<double>::infinity());
  void finish();
  void prepare_kernels();
  void set_profiling(bool on);
  std::vector<KernelTime> take_kernel_times();
  uint64_t launches() const;
  uint64_t bytes_moved() const;
  uint64_t device_reads() const;
  double build_milliseconds() const;

private:
  struct Implementation;
  class Group;
  class Controls;
  std::unique_ptr<Implementation> implementation_;
};

} // namespace tandem
