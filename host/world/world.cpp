/* world.cpp - the functions of <tandem/world.h>, which call host/world/implementation.h and turn a lack of memory into
 * OutOfMemory. Those about bodies are in world_bodies.cpp, and queries in world_queries.cpp. */
#include <new>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/base/hash.h"
#include "host/base/out_of_memory.h"
#include "host/runtime/interface/floating_point.h"
#include "host/world/answers.h"
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
const Scene &World::scene() const
{
  answer("new joints", implementation_->slots.existing(), [&] { implementation_->settle_joints_in_turn(); });
  return implementation_->scene;
}
const Settings &World::settings() const { return implementation_->settings; }
const std::string &World::broadphase_why() const { return implementation_->broadphase_why; }
const std::vector<Quarantine> &World::quarantined() const { return implementation_->quarantined; }
const std::optional<BatchFault> &World::batch_fault() const { return implementation_->fault; }
Features World::features() const { return implementation_->special.features; }
std::vector<Kernel> World::kernels() const { return implementation_->buffers.needs().kernels; }
Memory &World::memory()
{
  scene();
  return implementation_->memory;
}
Backend &World::backend_of(Kernel kernel) { return implementation_->backends.of(kernel); }
uint32_t World::scene_body(uint32_t buffer_index) const
{
  const std::lock_guard guard(implementation_->reading);
  return implementation_->special.order.at(buffer_index);
}
void World::keep_after_steps(Buffer buffer)
{
  row_of(buffer); /* InputError if there is no buffer of this number */
  implementation_->buffers.keep_after_steps(buffer);
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

uint32_t World::states_kept() const
{
  scene(); /* joints that come may need other tables, which states kept before do not have */
  return static_cast<uint32_t>(implementation_->ring.kept());
}

void World::go_back(uint32_t states)
{
  answer("a state to go back to", implementation_->slots.existing(), [&] { implementation_->go_back(states); });
  note(implementation_->log, RecordedCall::go_back, states);
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
  scene();
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
                                   "shares its memory; World::keep_after_steps, called before the step, keeps them",
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

Statistics World::statistics()
{
  return answer_in_turn(*implementation_, "the statistics", [&] {
    implementation_->settle();
    Statistics s = implementation_->statistics;
    if (implementation_->whole && !implementation_->idle) measure_contacts(implementation_->memory, s);
    s.substeps = implementation_->plan.substeps.now;
    s.bodies_with_more_substeps = implementation_->bodies_with_more_substeps();
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
  uint64_t hash = hash_sleepers(hash_carried(memory, buffers.carried(), {bodies(), special.awake}, scene_features));
  for (const Quarantine &taken : quarantined) hash = hash_bytes(&taken.body, sizeof taken.body, hash);
  return hash_choice(plan.substeps, hash);
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
uint64_t World::device_reads() const { return implementation_->memory.moves().reads; }
uint32_t World::resident_groups() const { return implementation_->backends.resident_groups(); }

void World::prepare_kernels()
{
  const double built = build_milliseconds();
  for (const auto &[text, backend] : implementation_->backends.all()) backend->build_series();
  if (implementation_->automatic && build_milliseconds() > built) implementation_->automatic->measure_again();
}

} // namespace tandem
