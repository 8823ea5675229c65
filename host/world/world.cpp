/* world.cpp - the functions of <tandem/world.h>, which call host/world/implementation.h and turn a lack of memory into
 * OutOfMemory. */
#include <new>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/base/hash.h"
#include "host/base/out_of_memory.h"
#include "host/runtime/interface/floating_point.h"
#include "host/world/closest_points.h"
#include "host/world/contact_events.h"
#include "host/world/implementation.h"

namespace tandem {
namespace {

void check_numbers(const Scene &scene)
{
  if (scene.bodies.size() >= body_numbers)
    throw InputError(
        fmt::format("scene '{}': {} bodies; kernels can number {}", scene.name, scene.bodies.size(), body_numbers - 1));
}

} // namespace

World::World(const Scene &scene, const Settings &settings, const Placement &placement)
{
  const minicl::ExactFloatingPoint environment; /* values derived from the scene must be rounded alike too */
  const auto told = [&](const char *why) {
    return fmt::format("scene '{}' of {} bodies, with room for {} pairs: {}", scene.name, scene.bodies.size(),
                       first_capacity(scene, settings), why);
  };
  try {
    validate(scene, scene.name);
    validate(settings);
    check_numbers(scene);
    for (size_t i = 0; i < scene.bodies.size(); ++i) check_solver(settings, scene.bodies[i], i, scene.name);
    implementation_ = std::make_unique<Implementation>(scene, settings, placement);
    for (const Extension &extension : settings.extensions)
      if (extension.prepare) extension.prepare(*this);
  } catch (const OutOfMemory &error) {
    throw OutOfMemory(told(error.what()));
  } catch (const std::bad_alloc &) {
    throw OutOfMemory(told("out of memory for its tables and buffers"));
  }
}

World::World(std::span<const std::byte> snapshot, const Placement &placement, std::vector<Extension> extensions)
{
  implementation_ = naming_what_failed(
      [&] { return fmt::format("out of memory: a world of a snapshot of {} bytes", snapshot.size()); },
      [&] { return Implementation::restored(snapshot, std::move(extensions), placement, nullptr); });
}

World::World(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

namespace {

/* Runs a query of a world; if memory runs out, the message says what was requested and for how many bodies. */
template <class Work> auto answer(const char *what, size_t bodies, Work work)
{
  return naming_what_failed(
      [&] {
        return fmt::format("out of memory: {} of a world of {} bodies: its lists need more than there is", what,
                           bodies);
      },
      work);
}

/* The same for what only reads. Reads change what the host knows (they move buffers, and apply calls that wait), so one
 * waits for the other. */
template <class Implementation, class Work> auto answer_in_turn(Implementation &world, const char *what, Work work)
{
  const std::lock_guard guard(world.reading);
  return answer(what, world.slots.existing(), work);
}

} // namespace

namespace {

/* Writes a call that has succeeded, if a recording is made. */
template <class... T> void note(const std::unique_ptr<CallLog> &log, RecordedCall call, const T &...fields)
{
  if (log) log->put(call, fields...);
}

} // namespace

World::~World() = default;

void World::step(const StepLimits &limits)
{
  implementation_->step(limits);
  implementation_->log_step();
}
void World::place(const Placement &placement)
{
  answer("the placement", implementation_->slots.existing(), [&] { implementation_->place_as_asked(placement); });
}
PlacementReport World::placement_report() const { return implementation_->placement_report(); }
bool World::is_placed() const { return !implementation_->backends.is_waiting(); }
bool World::wait_until_placed(double seconds)
{
  return answer("the placement", implementation_->slots.existing(),
                [&] { return implementation_->wait_until_placed(seconds); });
}
const Scene &World::scene() const { return implementation_->scene; }
const Settings &World::settings() const { return implementation_->settings; }
const std::string &World::broadphase_why() const { return implementation_->broadphase_why; }
const std::vector<Quarantine> &World::quarantined() const { return implementation_->quarantined; }
const std::optional<BatchFault> &World::batch_fault() const { return implementation_->fault; }
Features World::features() const { return implementation_->special.features; }
std::vector<Kernel> World::kernels() const { return implementation_->buffers.needs().kernels; }
Memory &World::memory() { return implementation_->memory; }
Backend &World::backend_of(Kernel kernel) { return implementation_->backends.of(kernel); }
uint32_t World::scene_body(uint32_t buffer_index) const
{
  const std::lock_guard guard(implementation_->reading);
  return implementation_->special.order.at(buffer_index);
}
void World::set_observer(Observer observer) { implementation_->set_observer(std::move(observer)); }

std::vector<std::byte> World::save()
{
  std::vector<std::byte> bytes;
  save(bytes);
  return bytes;
}

void World::save(std::vector<std::byte> &bytes)
{
  bytes = answer_in_turn(*implementation_, "a snapshot", [&] { return implementation_->save(std::move(bytes)); });
}

void World::restore(std::span<const std::byte> snapshot)
{
  try {
    auto restored = naming_what_failed(
        [&] { return fmt::format("out of memory: a world of a snapshot of {} bytes", snapshot.size()); },
        [&] {
          return Implementation::restored(snapshot, implementation_->settings.extensions, {}, implementation_.get());
        });
    restored->log = std::move(implementation_->log);
    restored->automatic = std::move(implementation_->automatic);
    implementation_ = std::move(restored);
  } catch (...) {
    implementation_->backends.take_back();
    throw;
  }
  note(implementation_->log, RecordedCall::restore, snapshot);
}

void World::start_recording(const std::string &path, const RecordingOptions &options)
{
  answer("a recording", implementation_->slots.existing(), [&] { implementation_->start_recording(path, options); });
}

void World::stop_recording()
{
  if (const std::unique_ptr<CallLog> log = std::move(implementation_->log)) log->finish();
}

void World::keep_states(uint32_t states, bool after_steps)
{
  answer("states to go back to", implementation_->slots.existing(),
         [&] { implementation_->keep_states(states, after_steps); });
  note(implementation_->log, RecordedCall::keep_states, states, after_steps);
}

void World::keep_state()
{
  answer("a state to go back to", implementation_->slots.existing(), [&] { implementation_->keep_state(); });
  note(implementation_->log, RecordedCall::keep_state);
}

uint32_t World::states_kept() const { return static_cast<uint32_t>(implementation_->ring.kept()); }

void World::go_back(uint32_t states)
{
  answer("a state to go back to", implementation_->slots.existing(), [&] { implementation_->go_back(states); });
  note(implementation_->log, RecordedCall::go_back, states);
}

std::vector<BodyState> World::bodies()
{
  return answer_in_turn(*implementation_, "the bodies", [&] {
    implementation_->settle();
    return download_bodies(implementation_->memory, implementation_->special.order);
  });
}

std::vector<PreciseBodyState> World::precise_bodies()
{
  return answer_in_turn(*implementation_, "the bodies", [&] {
    implementation_->settle();
    return download_precise_bodies(implementation_->memory, implementation_->special.order);
  });
}

void World::set_body(uint32_t body, const BodyState &state)
{
  if (!implementation_->slots.exists(body))
    throw InputError(
        fmt::format("set_body: body {} does not exist; the scene has {}", body, implementation_->slots.existing()));
  if (!is_finite(state)) throw InputError(fmt::format("set_body: body {} would not be finite", body));
  set_body_unchecked(body, state);
}

void World::set_body_unchecked(uint32_t body, const BodyState &state)
{
  const minicl::ExactFloatingPoint environment;
  ++implementation_->state;
  answer("a body", implementation_->slots.existing(), [&] {
    implementation_->settle(); /* what was called before comes before */
    implementation_->wake_bodies(std::span(&body, 1), true);
    implementation_->note_motion(body, {state.linear_velocity, state.angular_velocity});
    upload_body(implementation_->memory, implementation_->index_of_body.at(body), state);
  });
  note(implementation_->log, RecordedCall::set_body, body, state);
}

BodyId World::id_of(uint32_t body) const
{
  if (!implementation_->slots.exists(body))
    throw InputError(
        fmt::format("id_of: body {} does not exist; the world has {}", body, implementation_->slots.existing()));
  return implementation_->slots.id_of(body);
}

bool World::exists(const BodyId &id) const
{
  return implementation_->slots.exists(id.index) && implementation_->slots.id_of(id.index) == id;
}

std::vector<BodyId> World::body_ids() const
{
  const BodySlots &slots = implementation_->slots;
  std::vector<BodyId> ids;
  ids.reserve(slots.existing());
  for (uint32_t slot = 0; slot < slots.count(); ++slot)
    if (slots.exists(slot)) ids.push_back(slots.id_of(slot));
  return ids;
}

uint32_t World::body_count() const { return implementation_->slots.existing(); }

std::vector<BodyId> World::create_bodies(std::span<const Body> bodies)
{
  return answer("new bodies", implementation_->slots.existing(), [&] {
    const std::vector<Body> given(bodies.begin(), bodies.end()); /* they may be those of scene(), which move */
    std::vector<BodyId> ids = implementation_->create(given);
    note(implementation_->log, RecordedCall::create_bodies, std::span<const Body>(given), ids);
    return ids;
  });
}

void World::destroy_bodies(std::span<const BodyId> ids)
{
  answer("the destruction of bodies", implementation_->slots.existing(), [&] { implementation_->destroy(ids); });
  note(implementation_->log, RecordedCall::destroy_bodies, ids);
}

uint32_t World::add_shape(const Shape &shape)
{
  const uint32_t index =
      answer("a shape", implementation_->slots.existing(), [&] { return implementation_->add_shape(shape); });
  note(implementation_->log, RecordedCall::add_shape, scene().shapes[index], index); /* `shape` may have moved */
  return index;
}

uint32_t World::add_material(const Material &material)
{
  const uint32_t index =
      answer("a material", implementation_->slots.existing(), [&] { return implementation_->add_material(material); });
  note(implementation_->log, RecordedCall::add_material, scene().materials[index], index);
  return index;
}

void World::set_properties(std::span<const BodyId> ids, std::span<const BodyProperties> properties)
{
  const minicl::ExactFloatingPoint environment;
  answer("properties of bodies", implementation_->slots.existing(),
         [&] { implementation_->set_properties(ids, properties); });
  note(implementation_->log, RecordedCall::set_properties, ids, properties);
}

Body World::body_description(const BodyId &id) const
{
  return implementation_->scene.bodies[implementation_->slots.slot_of("body_description", id)];
}

std::vector<ShapeId> World::add_shapes(std::span<const BodyId> ids, std::span<const Child> shapes)
{
  const minicl::ExactFloatingPoint environment;
  return answer("shapes of bodies", implementation_->slots.existing(), [&] {
    const std::vector<Child> given(shapes.begin(), shapes.end()); /* they may be those of a compound that goes */
    std::vector<ShapeId> added = implementation_->add_shapes(ids, given);
    note(implementation_->log, RecordedCall::add_shapes, ids, std::span<const Child>(given), added);
    return added;
  });
}

void World::remove_shapes(std::span<const ShapeId> ids)
{
  const minicl::ExactFloatingPoint environment;
  answer("shapes of bodies", implementation_->slots.existing(), [&] { implementation_->remove_shapes(ids); });
  note(implementation_->log, RecordedCall::remove_shapes, ids);
}

std::vector<ShapeId> World::shapes_of(const BodyId &id)
{
  return answer_in_turn(*implementation_, "shapes of bodies", [&] {
    std::vector<ShapeId> shapes = implementation_->shapes_of(id);
    note(implementation_->log, RecordedCall::shapes_of, id); /* it makes handles */
    return shapes;
  });
}

BodyId World::body_of(const ShapeId &id) const
{
  const std::lock_guard guard(implementation_->reading);
  return implementation_->shapes.place_of("body_of", id).body;
}

std::vector<BodyState> World::read_bodies(std::span<const BodyId> ids)
{
  return answer_in_turn(*implementation_, "the bodies", [&] { return implementation_->read(ids); });
}

void World::set_states(std::span<const BodyId> ids, std::span<const BodyState> states)
{
  const minicl::ExactFloatingPoint environment;
  answer("calls to bodies", implementation_->slots.existing(), [&] { implementation_->set_states(ids, states); });
  note(implementation_->log, RecordedCall::set_states, ids, states);
}

void World::set_velocities(std::span<const BodyId> ids, std::span<const Velocity> velocities)
{
  answer("calls to bodies", implementation_->slots.existing(),
         [&] { implementation_->set_velocities(ids, velocities); });
  note(implementation_->log, RecordedCall::set_velocities, ids, velocities);
}

void World::move_to(std::span<const BodyId> ids, std::span<const Pose> poses)
{
  const minicl::ExactFloatingPoint environment;
  answer("calls to bodies", implementation_->slots.existing(), [&] { implementation_->move_to(ids, poses); });
  note(implementation_->log, RecordedCall::move_to, ids, poses);
}

void World::add_impulses(std::span<const BodyId> ids, std::span<const Impulse> impulses)
{
  const minicl::ExactFloatingPoint environment;
  answer("calls to bodies", implementation_->slots.existing(), [&] { implementation_->add_impulses(ids, impulses); });
  note(implementation_->log, RecordedCall::add_impulses, ids, impulses);
}

void World::add_forces(std::span<const BodyId> ids, std::span<const Force> forces)
{
  const minicl::ExactFloatingPoint environment;
  answer("calls to bodies", implementation_->slots.existing(), [&] { implementation_->add_forces(ids, forces); });
  note(implementation_->log, RecordedCall::add_forces, ids, forces);
}

void World::run(Kernel kernel, std::span<const uint32_t> values, std::span<const Buffer> slots)
{
  const minicl::ExactFloatingPoint environment;
  answer("a kernel", implementation_->slots.existing(), [&] { implementation_->run(kernel, values, slots); });
  if (!implementation_->log) return;
  std::vector<std::string> names;
  for (const Buffer slot : slots) names.emplace_back(name_of(slot));
  implementation_->log->put(RecordedCall::run, std::string(name_of(kernel)), values, names);
}

void World::write_bytes(Buffer buffer, const void *from, size_t bytes, size_t offset)
{
  answer("a buffer", implementation_->slots.existing(), [&] { implementation_->write(buffer, from, bytes, offset); });
  if (implementation_->log)
    implementation_->log->put(RecordedCall::write, std::string(name_of(buffer)), uint64_t{offset},
                              std::span(static_cast<const std::byte *>(from), bytes));
}

size_t World::buffer_bytes(Buffer buffer) const
{
  const std::lock_guard guard(implementation_->reading);
  row_of(buffer); /* InputError if there is no buffer of this number */
  return index_of(buffer) < implementation_->buffers.needs().touched.size() ? implementation_->memory.bytes(buffer) : 0;
}

void World::read_bytes(Buffer buffer, void *to, size_t bytes)
{
  if (bytes > buffer_bytes(buffer))
    throw InputError(
        fmt::format("read: buffer '{}' has {} bytes here, not {}", row_of(buffer).name, buffer_bytes(buffer), bytes));
  answer_in_turn(*implementation_, "a buffer", [&] {
    if (!implementation_->memory.is_held(buffer))
      throw InputError(fmt::format("read: buffer '{}' has lost its contents to another buffer of the step, which "
                                   "shares its memory; an observer (World::set_observer) keeps them apart",
                                   row_of(buffer).name));
    implementation_->memory.download(buffer, to, bytes);
  });
}

void World::set_gravity(const Vec3 &gravity)
{
  const minicl::ExactFloatingPoint environment;
  answer("gravity", implementation_->slots.existing(), [&] { implementation_->set_gravity(gravity); });
  note(implementation_->log, RecordedCall::set_gravity, gravity);
}

bool World::is_asleep(const BodyId &id) const
{
  const std::lock_guard guard(implementation_->reading);
  return implementation_->sleepers.sleeps(implementation_->slots.slot_of("is_asleep", id));
}

void World::wake_bodies(std::span<const BodyId> ids)
{
  answer("waking", implementation_->slots.existing(), [&] {
    const std::vector<uint32_t> slots = implementation_->slots_of("wake_bodies", ids);
    implementation_->settle();
    implementation_->wake_bodies(slots, false);
  });
  note(implementation_->log, RecordedCall::wake_bodies, ids);
}

const std::vector<SleepEvent> &World::sleep_events() const { return implementation_->sleep_events; }

std::vector<ContactEvent> World::contact_events()
{
  if (!implementation_->settings.events) throw InputError("contact_events: there are none without Settings::events");
  if (!implementation_->whole || implementation_->idle) return {};
  return answer_in_turn(*implementation_, "the contact events", [&] {
    return download_events(implementation_->memory, implementation_->scene, implementation_->events_order());
  });
}

std::vector<HitEvent> World::hit_events()
{
  if (!implementation_->settings.events) throw InputError("hit_events: there are none without Settings::events");
  if (!implementation_->whole || implementation_->idle) return {};
  return answer_in_turn(*implementation_, "the hit events", [&] {
    return hits_among(download_events(implementation_->memory, implementation_->scene, implementation_->events_order()),
                      implementation_->settings.hit_speed);
  });
}

std::vector<uint32_t> World::moved_bodies()
{
  if (!implementation_->settings.moved_bodies)
    throw InputError("moved_bodies: there are none without Settings::moved_bodies");
  if (!implementation_->whole) return {};
  return answer_in_turn(*implementation_, "the moved bodies", [&] { return implementation_->moved_bodies(); });
}

std::vector<PairEvent> World::pair_events()
{
  if (!implementation_->settings.pair_events)
    throw InputError("pair_events: there are none without Settings::pair_events");
  if (!implementation_->whole || implementation_->idle) return {};
  return answer_in_turn(*implementation_, "the pair events",
                        [&] { return download_pair_events(implementation_->memory, implementation_->events_order()); });
}

std::vector<RayHit> World::cast_rays(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries",
                        [&] { return tandem::cast_rays(implementation_->query_target(), rays); });
}

std::vector<bool> World::cast_rays_any(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries",
                        [&] { return tandem::cast_rays_any(implementation_->query_target(), rays); });
}

std::vector<std::vector<RayHit>> World::cast_rays_all(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries",
                        [&] { return tandem::cast_rays_all(implementation_->query_target(), rays); });
}

std::vector<std::vector<BoxHit>> World::cast_boxes(std::span<const QueryBox> boxes)
{
  check_boxes(boxes);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries",
                        [&] { return tandem::cast_boxes(implementation_->query_target(), boxes); });
}

std::vector<ShapeCastHit> World::cast_shapes(const Shape &shape, std::span<const Pose> poses,
                                             std::span<const Vec3> displacements, const QueryFilter &filter)
{
  check_shape_casts(shape, poses, displacements);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries", [&] {
    return tandem::cast_shapes(implementation_->query_target(), shape, poses, displacements, filter);
  });
}

std::vector<std::vector<uint32_t>> World::overlap_shapes(const Shape &shape, std::span<const Pose> poses,
                                                         const QueryFilter &filter)
{
  check_overlaps(shape, poses);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries",
                        [&] { return tandem::overlap_shapes(implementation_->query_target(), shape, poses, filter); });
}

std::vector<ClosestPoints> World::closest_points(std::span<const std::pair<BodyId, BodyId>> pairs)
{
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "closest points", [&] {
    check_closest_points(implementation_->scene, implementation_->slots, pairs);
    implementation_->settle();
    return tandem::closest_points(implementation_->memory, implementation_->launcher, pairs,
                                  implementation_->index_of_body);
  });
}

void World::cast_rays_on_device(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  answer_in_turn(*implementation_, "queries", [&] {
    tandem::cast_rays_on_device(implementation_->target_for_kernels(), rays);
    implementation_->plan.hits = static_cast<uint32_t>(rays.size());
    note(implementation_->log, RecordedCall::cast_rays_on_device, rays);
  });
}

void World::cast_shapes_on_device(const Shape &shape, std::span<const Pose> poses, std::span<const Vec3> displacements,
                                  const QueryFilter &filter)
{
  check_shape_casts(shape, poses, displacements);
  const minicl::ExactFloatingPoint environment;
  answer_in_turn(*implementation_, "queries", [&] {
    tandem::cast_shapes_on_device(implementation_->target_for_kernels(), shape, poses, displacements, filter);
    implementation_->plan.hits = static_cast<uint32_t>(poses.size());
    note(implementation_->log, RecordedCall::cast_shapes_on_device, shape, poses, displacements, filter);
  });
}

Statistics World::statistics()
{
  return answer_in_turn(*implementation_, "the statistics", [&] {
    implementation_->settle();
    Statistics s = implementation_->statistics;
    if (implementation_->whole && !implementation_->idle) measure_contacts(implementation_->memory, s);
    s.substeps = implementation_->plan.substeps.now;
    s.asleep = implementation_->sleepers.count();
    s.sleeping_islands = static_cast<uint32_t>(implementation_->sleepers.islands());
    s.kinetic_energy = kinetic_energy(implementation_->memory, implementation_->scene, implementation_->special.order);
    return s;
  });
}

uint64_t World::body_hash()
{
  const std::vector<Buffer> state{Buffer::body_position, Buffer::body_orientation, Buffer::body_velocity};
  return answer_in_turn(*implementation_, "the hash", [&] {
    implementation_->settle();
    return hash_buffers(implementation_->memory, state, implementation_->bodies());
  });
}

uint64_t World::state_hash()
{
  return answer_in_turn(*implementation_, "the hash", [&] { return implementation_->state_hash(); });
}

uint64_t World::Implementation::state_hash()
{
  settle();
  uint64_t hash = sleepers.hash(hash_carried(memory, buffers.carried(), {bodies(), special.awake}, scene_features));
  for (const Quarantine &taken : quarantined) hash = hash_bytes(&taken.body, sizeof taken.body, hash);
  return hash;
}

void World::finish()
{
  if (implementation_->backends.wanted().start == Start::on_device) wait_until_placed();
  /* A device that was measured and not chosen would cost a small scene more than its step. */
  if (implementation_->automatic && implementation_->ring.size() == 0) implementation_->backends.finish_launches();
  else implementation_->backends.finish();
}

void World::set_profiling(bool on) { implementation_->backends.set_profiling(on); }
std::vector<KernelTime> World::take_kernel_times() { return implementation_->backends.take_kernel_times(); }
double World::build_milliseconds() const { return implementation_->backends.build_milliseconds(); }
uint64_t World::launches() const { return implementation_->backends.launches(); }
uint64_t World::bytes_moved() const { return implementation_->memory.moves().bytes; }
uint32_t World::resident_groups() const { return implementation_->backends.resident_groups(); }

void World::prepare_kernels()
{
  const double built = build_milliseconds();
  for (const auto &[text, backend] : implementation_->backends.all()) backend->build_series();
  if (implementation_->automatic && build_milliseconds() > built) implementation_->automatic->measure_again();
}

} // namespace tandem
