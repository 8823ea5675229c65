/* recording.cpp - reads recordings and makes their calls again; see <tandem/recording.h> and call_log.h. */
#include <algorithm>

#include <fmt/format.h>

#include <tandem/recording.h>

#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/memory.h"
#include "host/runtime/parts.h"
#include "host/world/call_log.h"
#include "host/world/snapshot.h"

namespace tandem {
namespace recorded {

struct PartRead {
  RecordedPart kind;
  std::span<const std::byte> bytes; /* after the kind */
  size_t offset;                    /* in the file */
};

struct Snapshot {
  uint64_t step;
  std::span<const std::byte> bytes;
};

} // namespace recorded

namespace {

using recorded::PartRead, recorded::Snapshot;

std::span<const std::byte> get_bytes(ByteReader &reader) { return reader.take(reader.get<uint64_t>()); }

PartRead next_part(ByteReader &reader, uint64_t number)
{
  const auto bytes = reader.get<uint64_t>(), hash = reader.get<uint64_t>();
  const size_t offset = reader.position();
  const auto contents = reader.take(bytes);
  if (hash_blocks(contents.data(), contents.size(), number, run_parts) != hash)
    throw InputError(fmt::format("{}: byte {}: part {} does not have the hash that it was written with; the file is "
                                 "damaged",
                                 reader.where(), offset, number));
  if (contents.empty()) reader.fail(fmt::format("part {} is empty", number));
  const auto kind = static_cast<RecordedPart>(contents.front());
  if (kind > RecordedPart::end) reader.fail(fmt::format("part {} is of no kind", number));
  return {kind, contents.subspan(1), offset + 1};
}

} // namespace

struct WorldRecording::Contents {
  std::vector<std::byte> bytes;
  std::string where, version;
  std::vector<recorded::Snapshot> snapshots;
  std::vector<recorded::PartRead> calls; /* before each step, with the step; then those after the last one, if any */
  std::vector<StepHashes> hashes;        /* of each step */
  bool finished = false;

  void read();
  void read_header(ByteReader &reader) const;
  void take(const PartRead &part);
  void take_calls(const PartRead &part);
  std::string place(uint64_t step) const { return fmt::format("{}: before step {}", where, step); }
};

namespace {

/* Calls a function with what each call of a part holds; `step` gets the hashes. Without a world the calls are only
 * read. */
class Caller {
public:
  Caller(ByteReader &reader, World *world) : reader_(reader), world_(world) {}

  /* The hashes of the step that ends the part, if one does. */
  std::optional<StepHashes> make_all()
  {
    while (reader_.left() > 0) {
      const auto call = reader_.get<RecordedCall>();
      if (call == RecordedCall::step) {
        auto hashes = reader_.get<StepHashes>();
        reader_.expect_end();
        return hashes;
      }
      make(call);
    }
    return std::nullopt;
  }

private:
  template <class T> std::vector<T> list() { return reader_.get<std::vector<T>>(); }
  template <class Entry, class Work> void with_ids(const Work &work)
  {
    const auto ids = list<BodyId>();
    const auto entries = list<Entry>();
    if (world_) work(ids, entries);
  }
  void make(RecordedCall call)
  {
    if (call <= RecordedCall::add_material) make_roster_call(call);
    else if (call <= RecordedCall::add_forces) make_body_call(call);
    else if (call <= RecordedCall::set_gravity) make_sleep_call(call);
    else if (call <= RecordedCall::go_back) make_state_call(call);
    else if (call <= RecordedCall::cast_shapes_on_device) make_module_call(call);
    else if (call <= RecordedCall::set_joint_axes) make_joint_call(call);
    else reader_.fail(fmt::format("call {} is unknown", static_cast<unsigned>(call)));
  }

  void make_joint_call(RecordedCall call)
  {
    if (call == RecordedCall::create_joints) {
      const auto joints = list<Joint>();
      const auto ids = list<JointId>();
      if (world_ && world_->create_joints(joints) != ids) other_result("create_joints");
      return;
    }
    const auto ids = list<JointId>();
    if (call == RecordedCall::destroy_joints) {
      if (world_) world_->destroy_joints(ids);
    } else if (call == RecordedCall::set_joints) {
      const auto joints = list<Joint>();
      if (world_) world_->set_joints(ids, joints);
    } else {
      const auto changes = list<JointAxisChange>();
      if (world_) world_->set_joint_axes(ids, changes);
    }
  }

  void make_roster_call(RecordedCall call)
  {
    if (call == RecordedCall::create_bodies) {
      const auto bodies = list<Body>();
      const auto ids = list<BodyId>();
      if (world_ && world_->create_bodies(bodies) != ids) other_result("create_bodies");
    } else if (call == RecordedCall::destroy_bodies) {
      const auto ids = list<BodyId>();
      if (world_) world_->destroy_bodies(ids);
    } else if (call <= RecordedCall::shapes_of) {
      make_property_call(call);
    } else if (call == RecordedCall::add_shape) {
      const Shape shape = get_shape(reader_);
      const auto index = reader_.get<uint32_t>();
      if (world_ && world_->add_shape(shape) != index) other_result("add_shape");
    } else {
      const auto material = reader_.get<Material>();
      const auto index = reader_.get<uint32_t>();
      if (world_ && world_->add_material(material) != index) other_result("add_material");
    }
  }

  void make_property_call(RecordedCall call)
  {
    if (call == RecordedCall::set_properties)
      with_ids<BodyProperties>([&](const auto &ids, const auto &entries) { world_->set_properties(ids, entries); });
    else if (call == RecordedCall::add_shapes) {
      const auto ids = list<BodyId>();
      const std::vector<Child> shapes = get_children(reader_);
      const auto added = list<ShapeId>();
      if (world_ && world_->add_shapes(ids, shapes) != added) other_result("add_shapes");
    } else if (call == RecordedCall::remove_shapes) {
      const auto ids = list<ShapeId>();
      if (world_) world_->remove_shapes(ids);
    } else {
      const auto id = reader_.get<BodyId>();
      if (world_) world_->shapes_of(id);
    }
  }

  void make_sleep_call(RecordedCall call)
  {
    if (call == RecordedCall::wake_bodies) {
      const auto ids = list<BodyId>();
      if (world_) world_->wake_bodies(ids);
    } else {
      const auto gravity = reader_.get<Vec3>();
      if (world_) world_->set_gravity(gravity);
    }
  }

  void make_body_call(RecordedCall call)
  {
    if (call == RecordedCall::set_body) {
      const auto body = reader_.get<uint32_t>();
      const auto state = reader_.get<BodyState>();
      if (world_) world_->id_of(body), world_->set_body_unchecked(body, state);
    } else if (call == RecordedCall::set_states)
      with_ids<BodyState>([&](const auto &ids, const auto &states) { world_->set_states(ids, states); });
    else if (call == RecordedCall::set_velocities)
      with_ids<Velocity>([&](const auto &ids, const auto &velocities) { world_->set_velocities(ids, velocities); });
    else if (call == RecordedCall::move_to)
      with_ids<Pose>([&](const auto &ids, const auto &poses) { world_->move_to(ids, poses); });
    else if (call == RecordedCall::add_impulses)
      with_ids<Impulse>([&](const auto &ids, const auto &impulses) { world_->add_impulses(ids, impulses); });
    else with_ids<Force>([&](const auto &ids, const auto &forces) { world_->add_forces(ids, forces); });
  }

  void make_state_call(RecordedCall call)
  {
    if (call == RecordedCall::restore) {
      const auto snapshot = get_bytes(reader_);
      if (world_) world_->restore(snapshot);
      else read_snapshot(snapshot, reader_.where());
    } else if (call == RecordedCall::keep_states) {
      const auto states = reader_.get<uint32_t>();
      const bool after_steps = reader_.get<bool>();
      if (world_) world_->keep_states(states, after_steps);
    } else if (call == RecordedCall::keep_state) {
      if (world_) world_->keep_state();
    } else {
      const auto states = reader_.get<uint32_t>();
      if (world_) world_->go_back(states);
    }
  }

  void make_module_call(RecordedCall call)
  {
    if (call == RecordedCall::run) {
      const auto kernel = reader_.get<std::string>();
      const auto values = list<uint32_t>();
      std::vector<Buffer> slots;
      for (const std::string &name : list<std::string>())
        if (world_) slots.push_back(buffer_named(name));
      if (world_) world_->run(kernel_named(kernel), values, slots);
    } else if (call == RecordedCall::write) {
      const auto buffer = reader_.get<std::string>();
      const auto offset = reader_.get<uint64_t>();
      const auto bytes = get_bytes(reader_);
      if (world_) world_->write_bytes(buffer_named(buffer), bytes.data(), bytes.size(), static_cast<size_t>(offset));
    } else make_cast(call);
  }

  void make_cast(RecordedCall call)
  {
    if (call == RecordedCall::cast_rays_on_device) {
      const auto rays = list<Ray>();
      if (world_) world_->cast_rays_on_device(rays);
    } else {
      const Shape shape = get_shape(reader_);
      const auto poses = list<Pose>();
      const auto displacements = list<Vec3>();
      const auto filter = reader_.get<QueryFilter>();
      if (world_) world_->cast_shapes_on_device(shape, poses, displacements, filter);
    }
  }

  [[noreturn]] void other_result(const char *call) const
  {
    throw InputError(fmt::format("{} returned another handle than it did when it was recorded", call));
  }

  ByteReader &reader_;
  World *world_;
};

} // namespace

void WorldRecording::Contents::read_header(ByteReader &reader) const
{
  const auto refuse = [&](const std::string &why) { throw InputError(fmt::format("{}: {}", where, why)); };
  if (bytes.size() < 16) refuse(fmt::format("{} bytes are no recording, which has 16 at least", bytes.size()));
  if (reader.get<std::array<char, 8>>() != recording_magic)
    refuse("it is no recording of Tandem, which begins with 'TANDEMR'");
  if (const auto format = reader.get<uint64_t>(); format != recording_format)
    refuse(fmt::format("the recording has format {}; Tandem {} reads format {}", format, tandem::version(),
                       recording_format));
}

/* Everything is looked at once, so that a damaged part is refused before the first step. */
void WorldRecording::Contents::read()
{
  ByteReader reader(bytes, where);
  read_header(reader);
  for (uint64_t number = 0; reader.left() > 0; ++number) {
    if (finished) reader.fail("there is more after its end");
    const PartRead part = next_part(reader, number);
    if ((number == 0) != (part.kind == RecordedPart::header))
      reader.fail(fmt::format("part {} is in the wrong place", number));
    take(part);
  }
  if (snapshots.empty() || snapshots.front().step != 0) throw InputError(fmt::format("{}: it has no snapshot", where));
}

void WorldRecording::Contents::take(const PartRead &part)
{
  ByteReader reader(part.bytes, where, part.offset);
  switch (part.kind) {
  case RecordedPart::header: reader.get(version); break;
  case RecordedPart::snapshot: {
    const auto step = reader.get<uint64_t>();
    snapshots.push_back({step, get_bytes(reader)});
    if (step != hashes.size())
      reader.fail(fmt::format("a snapshot after step {} stands after {}", step, hashes.size()));
    break;
  }
  case RecordedPart::calls: return take_calls(part);
  case RecordedPart::end:
    if (const auto steps = reader.get<uint64_t>(); steps != hashes.size())
      reader.fail(fmt::format("it had {} steps, and {} are here", steps, hashes.size()));
    finished = true;
    break;
  }
  reader.expect_end();
}

void WorldRecording::Contents::take_calls(const PartRead &part)
{
  ByteReader reader(part.bytes, place(hashes.size()), part.offset);
  if (calls.size() > hashes.size()) reader.fail("calls without a step are followed by others");
  std::optional<StepHashes> of_step = Caller(reader, nullptr).make_all();
  calls.push_back(part);
  if (of_step) hashes.push_back(std::move(*of_step));
}

WorldRecording::WorldRecording(std::vector<std::byte> bytes, std::string where)
    : contents_(std::make_unique<Contents>())
{
  contents_->bytes = std::move(bytes);
  contents_->where = std::move(where);
  contents_->read();
}

WorldRecording::~WorldRecording() = default;
WorldRecording::WorldRecording(WorldRecording &&) noexcept = default;
WorldRecording &WorldRecording::operator=(WorldRecording &&) noexcept = default;

uint64_t WorldRecording::steps() const { return contents_->hashes.size(); }
bool WorldRecording::finished() const { return contents_->finished; }
const std::string &WorldRecording::made_by() const { return contents_->version; }

namespace {

const Snapshot &last_before(const std::vector<Snapshot> &snapshots, uint64_t step)
{
  const auto after = std::upper_bound(snapshots.begin(), snapshots.end(), step,
                                      [](uint64_t at, const Snapshot &one) { return at < one.step; });
  return *std::prev(after);
}

} // namespace

std::span<const std::byte> WorldRecording::snapshot(uint64_t step) const
{
  return last_before(contents_->snapshots, step).bytes;
}

uint64_t WorldRecording::snapshot_step(uint64_t step) const { return last_before(contents_->snapshots, step).step; }

void WorldRecording::make_calls(World &world, uint64_t step) const
{
  if (step >= contents_->calls.size()) return;
  const PartRead &part = contents_->calls[step];
  const std::string place = contents_->place(step);
  ByteReader reader(part.bytes, place, part.offset);
  try {
    Caller(reader, &world).make_all();
  } catch (const InputError &error) {
    if (std::string_view(error.what()).starts_with(place)) throw;
    throw InputError(fmt::format("{}: {}", place, error.what()));
  }
}

bool WorldRecording::has_hash(uint64_t step) const
{
  return step < steps() && contents_->hashes[step].state.has_value();
}
bool WorldRecording::has_body_hashes(uint64_t step) const
{
  return step < steps() && !contents_->hashes[step].bodies.empty();
}

namespace {

void name_body(World &world, const StepHashes &hashes, uint64_t step, RecordedDifference &difference)
{
  std::vector<uint32_t> order(world.scene().bodies.size());
  for (uint32_t index = 0; index < order.size(); ++index) order[index] = world.scene_body(index);
  const std::vector<uint32_t> found = body_hashes(world.memory(), order);
  difference.body_step = step;
  for (uint32_t body = 0; body < std::max(found.size(), hashes.bodies.size()); ++body) {
    if (body < found.size() && body < hashes.bodies.size() && found[body] == hashes.bodies[body]) continue;
    difference.body = body;
    if (body < found.size()) difference.name = world.scene().bodies[body].name;
    return;
  }
}

} // namespace

std::optional<RecordedDifference> WorldRecording::difference(World &world, uint64_t step) const
{
  if (!has_hash(step)) return std::nullopt;
  const StepHashes &hashes = contents_->hashes[step];
  RecordedDifference difference;
  difference.step = step;
  difference.recorded = *hashes.state;
  difference.found = world.state_hash();
  if (difference.found == difference.recorded) return std::nullopt;
  if (!hashes.bodies.empty()) name_body(world, hashes, step, difference);
  return difference;
}

namespace {

/* Makes the steps until one whose bodies can be compared. */
void find_body(const WorldRecording &recording, World &world, RecordedDifference &difference)
{
  for (uint64_t step = difference.step; !recording.has_body_hashes(step);) {
    if (++step >= recording.steps()) return;
    recording.make_calls(world, step);
    world.step();
    if (!recording.has_body_hashes(step)) continue;
    if (const auto later = recording.difference(world, step)) {
      difference.body = later->body;
      difference.name = later->name;
      difference.body_step = step;
    }
  }
}

} // namespace

std::optional<RecordedDifference> replay(const WorldRecording &recording, World &world, const ReplayRequest &request)
{
  for (uint64_t step = request.first; step < recording.steps(); ++step) {
    recording.make_calls(world, step);
    world.step();
    const bool compares = step + 1 == recording.steps() || (request.verify && step >= request.verify_from);
    std::optional<RecordedDifference> difference;
    if (compares) difference = recording.difference(world, step);
    if (difference) find_body(recording, world, *difference);
    if (difference) return difference;
    if (request.after_step) request.after_step(step + 1);
  }
  recording.make_calls(world, recording.steps());
  return std::nullopt;
}

} // namespace tandem
