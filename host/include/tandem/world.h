/* world.h - a scene being simulated: the library's front door.
 *
 *   World world(load_scene("box-grid:nx=8,ny=8,nz=8"), Settings{}, Placement{"cl"});
 *   for (int i = 0; i < 60; ++i) world.step();
 *   std::vector<BodyState> bodies = world.bodies();
 *
 * A step either happens whole or not at all: overflow grows the buffers and runs the step again, a
 * non-finite body is quarantined and named.
 */
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tandem/backend.h>
#include <tandem/events.h>
#include <tandem/export.h>
#include <tandem/features.h>
#include <tandem/queries.h>
#include <tandem/scene.h>
#include <tandem/settings.h>

namespace tandem {

/* What runs inside: host/runtime/interface/ says what they are, for those who compare or profile the pipeline; who
 * extends it needs <tandem/module.h> alone. */
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

/* The same as precise as it is known: in double where everything runs on the reference backend. */
struct PreciseBodyState {
  Point position;
  std::array<double, 4> orientation;
  std::array<double, 3> linear_velocity, angular_velocity;
};

/* What is known after a step. Penetration is over the contact points of the step's collision
 * detection: metres, positive when shapes overlap; touching ahead of contact counts as 0. */
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
  /* Of the last step, with the solver `direct` only: */
  uint32_t direct_islands = 0; /* islands it solved */
  uint32_t direct_left = 0;    /* touching pairs in islands too large for it, left to the iterative rows */
  uint32_t direct_stalled = 0; /* solves, over the passes of the step, that did not reach their tolerance */
};

/* Time of one kernel or stage over the steps since the last call. */
struct KernelTime {
  Kernel kernel;
  std::string backend;
  double milliseconds; /* total */
  uint64_t launches;
};

class TANDEM_API World {
public:
  World(const Scene &scene, const Settings &settings = {}, const Placement &placement = {});
  ~World();

  /* Advances by settings.step. std::runtime_error when a device fails, memory runs out (OutOfMemory: what was wanted,
   * and for how many bodies and pairs) or more pairs are found than Settings::max_pairs: the state is then that before
   * the step, and the world goes on from there as if there had been no attempt. Until a step succeeds there are no
   * events and no figures of contacts. */
  void step();

  /* Moves kernels to other backends from the next step on; what follows keeps its bits. Buffers travel when they are
   * first needed there. InputError or a device's std::runtime_error leave the placement as it was. */
  void place(const Placement &placement);

  const Scene &scene() const;
  const Settings &settings() const; /* with the broadphase that `auto` chose */

  std::vector<BodyState> bodies(); /* in the order of Scene::bodies */
  std::vector<PreciseBodyState> precise_bodies();
  void set_body(uint32_t body, const BodyState &state); /* InputError unless finite and in range */
  /* As set_body, but unchecked: for tests of what happens to a NaN. */
  void set_body_unchecked(uint32_t body, const BodyState &state);

  /* Of the last step, sorted by (a, b); none before the first. Whole steps alone have events: one that ran again with
   * larger buffers tells them once. InputError without Settings::events. */
  std::vector<ContactEvent> contact_events();
  /* Of the last step, sorted by (a, b); none before the first. InputError without Settings::pair_events. */
  std::vector<PairEvent> pair_events();
  /* Queries of the present state, by the batch, where the stage `queries` is placed (sweeps of shapes: `sweeps`); they
   * change nothing. Answers in the order of the questions, with the same bits on every backend. InputError as
   * check_rays, check_boxes, check_shape_casts. */
  std::vector<RayHit> cast_rays(std::span<const Ray> rays);
  /* Whether each hits anything at all: cheaper, as it stops at the first body that it finds. */
  std::vector<bool> cast_rays_any(std::span<const Ray> rays);
  /* Every body that each hits, sorted by (fraction, body). */
  std::vector<std::vector<RayHit>> cast_rays_all(std::span<const Ray> rays);
  /* Every body whose box a box touches, where it stands or on its way; sorted by (fraction, body). */
  std::vector<std::vector<BoxHit>> cast_boxes(std::span<const QueryBox> boxes);
  /* A convex shape along straight ways from its poses, without turning: where it first touches a body. */
  std::vector<ShapeCastHit> cast_shapes(const Shape &shape, std::span<const Pose> poses,
                                        std::span<const Vec3> displacements, const QueryFilter &filter = {});

  /* Modules of Settings::extensions, between steps: a kernel over the items of its row, and the module's buffers.
   * InputError names the kernel or buffer where it is of no such module, or where the bytes do not fit; a buffer of
   * capacity NOTHING takes any number of items. What is written counts from the next launch on. Before the first step
   * there are no COMMIT_ items, and no pairs. */
  void run(Kernel kernel, std::span<const uint32_t> values = {}, std::span<const Buffer> slots = {});
  template <class T> void write(Buffer buffer, std::span<const T> values, size_t first = 0)
  {
    write_bytes(buffer, values.data(), values.size_bytes(),
                first > SIZE_MAX / sizeof(T) ? SIZE_MAX : first * sizeof(T));
  }
  /* Any buffer that this world has, the pipeline's too, whole: as the last launch left it. */
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
  /* Bodies, the cache of contacts, and what is STATE or CACHE of modules. In worlds of equal scenes, settings and
   * written buffers it is equal iff the next step will be equal. */
  uint64_t state_hash();
  uint64_t body_hash(); /* poses and velocities alone */
  const std::vector<Quarantine> &quarantined() const;
  const std::optional<BatchFault> &batch_fault() const; /* the first so far; only with Settings::check */

  /* Waits for the devices, so that a clock read after it is honest. */
  void finish();
  void set_profiling(bool on);
  std::vector<KernelTime> take_kernel_times();

  /* The mask of FEATURE_ bits in use, and the kernels, buffers and backends that follow from it. */
  Features features() const;
  std::vector<Kernel> kernels() const;
  Memory &memory();
  Backend &backend_of(Kernel kernel);
  double build_milliseconds() const;

  /* Called after every launch of a step, in order, when set: the comparison of backends hangs here. */
  using Observer = std::function<void(const Launch &)>;
  void set_observer(Observer observer);
  /* Body index of the scene for an index of the body buffers (large bodies come first there). */
  uint32_t scene_body(uint32_t buffer_index) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

} // namespace tandem
