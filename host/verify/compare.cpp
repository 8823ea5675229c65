/* compare.cpp - runs backends in lockstep and compares the hashes of their buffers; see compare.h. */
#include <algorithm>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include <tandem/compare.h>

#include "host/pipeline/broadphases/choice.h"
#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"
#include "host/verify/breakpoint.h"
#include "host/verify/buffer_location.h"

namespace tandem {
std::vector<Buffer> buffers_written(const Launch &launch)
{
  std::vector<Buffer> written;
  for_each_buffer(launch, [&](Buffer buffer, Access access) {
    if (access != Access::in) written.push_back(buffer);
  });
  return written;
}

namespace {

const char *contents_of(World &world, Buffer buffer)
{
  return static_cast<const char *>(world.memory().acquire(buffer, host_storage(), Access::in));
}

uint64_t hash_of(World &world, Buffer buffer)
{
  const size_t bytes = world.memory().bytes(buffer);
  return bytes ? hash_numbers(buffer, contents_of(world, buffer), bytes) : 0;
}

/* The contents of one buffer after one launch. */
struct Output {
  uint32_t launch;
  Kernel kernel;
  Buffer buffer;
  uint64_t hash;
};

/* Where a world's outputs first differed from the reference's, and the contents of its buffer. */
struct Departure {
  size_t world;
  uint64_t step;
  Output output;
  bool kernels_differ; /* another kernel ran than on the reference, so there is no buffer to compare */
  std::vector<char> contents;
};

class Lockstep {
public:
  Lockstep(const Scene &scene, const ComparisonRequest &request) : scene_(scene), request_(request) {}

  Comparison run();

private:
  std::unique_ptr<World> make_world(size_t index) const;
  template <class Visit> void step(size_t index, World &world, uint64_t step, Visit visit) const;
  void step_reference(World &world);
  void step_and_compare(size_t index, World &world);
  void compare_states(std::vector<std::unique_ptr<World>> &worlds);
  Difference explain() const;
  void lay_side_by_side(World &reference, const Launch &launch, Difference &difference) const;
  Difference describe_departure() const;

  const Scene &scene_;
  const ComparisonRequest &request_;
  uint64_t current_ = 0;
  std::vector<Output> reference_;
  std::optional<Departure> departure_;
  Comparison result_;
};

std::unique_ptr<World> Lockstep::make_world(size_t index) const
{
  Placement placement = request_.placement;
  placement.build_in_background = false; /* what is compared must run where it was asked to */
  placement.start = Start::on_device;
  placement.on = request_.backends.front();
  placement.broadphase_for = broadphase_backend(placement); /* individual choices could differ, and other kernels run */
  placement.on = request_.backends[index];
  if (!request_.snapshot.empty()) return std::make_unique<World>(request_.snapshot, placement);
  return std::make_unique<World>(scene_, request_.settings, placement);
}

/* Calls visit(launch, number) after each launch; an injected fault is in place by then. */
template <class Visit> void Lockstep::step(size_t index, World &world, uint64_t step, Visit visit) const
{
  uint32_t number = 0;
  world.set_observer([&](const Launch &launch) {
    world.backend_of(launch.kernel).finish();
    if (request_.inject_fault) request_.inject_fault(index, step, world, launch);
    visit(launch, number++);
  });
  if (request_.before_step) request_.before_step(world, step);
  world.step();
  world.set_observer(nullptr);
}

void Lockstep::step_reference(World &world)
{
  reference_.clear();
  step(0, world, current_, [&](const Launch &launch, uint32_t number) {
    for (const Buffer buffer : buffers_written(launch))
      reference_.push_back({number, launch.kernel, buffer, hash_of(world, buffer)});
  });
}

void Lockstep::step_and_compare(size_t index, World &world)
{
  size_t next = 0;
  step(index, world, current_, [&](const Launch &launch, uint32_t number) {
    if (departure_) return;
    ++result_.kernels_compared;
    for (const Buffer buffer : buffers_written(launch)) {
      const size_t bytes = world.memory().bytes(buffer);
      const Output output{number, launch.kernel, buffer, hash_of(world, buffer)};
      const bool kernels_differ = next >= reference_.size() || reference_[next].kernel != output.kernel ||
                                  reference_[next].launch != output.launch || reference_[next].buffer != buffer;
      result_.bytes_compared += bytes;
      if (!kernels_differ && reference_[next++].hash == output.hash) continue;
      departure_ = Departure{index, current_, output, kernels_differ, {}};
      if (!kernels_differ) departure_->contents.assign(contents_of(world, buffer), contents_of(world, buffer) + bytes);
      return;
    }
  });
  if (!departure_ && next < reference_.size()) departure_ = Departure{index, current_, reference_[next], true, {}};
}

/* Finds what no kernel's row declares: equal outputs, but different states. */
void Lockstep::compare_states(std::vector<std::unique_ptr<World>> &worlds)
{
  const uint64_t expected = worlds[0]->state_hash();
  for (size_t index = 1; index < worlds.size() && !result_.first_difference; ++index) {
    if (worlds[index]->state_hash() == expected) continue;
    Difference difference;
    difference.step = current_;
    difference.backends[0] = request_.backends[0];
    difference.backends[1] = request_.backends[index];
    difference.note = "the states after the step differ though every kernel's outputs are equal: some kernel writes a "
                      "buffer that its row in kernels.def does not name";
    result_.first_difference = difference;
  }
}

Difference Lockstep::describe_departure() const
{
  Difference difference;
  difference.step = departure_->step;
  difference.launch = departure_->output.launch;
  difference.kernel = departure_->output.kernel;
  difference.backends[0] = request_.backends[0];
  difference.backends[1] = request_.backends[departure_->world];
  return difference;
}

/* Runs a fresh reference up to the launch at which the other world differed. */
Difference Lockstep::explain() const
{
  Difference difference = describe_departure();
  if (departure_->kernels_differ) {
    difference.note = "the two backends ran different sequences of kernels from here on";
    return difference;
  }
  difference.buffer = departure_->output.buffer;
  difference.note =
      fmt::format("'{}' did not get as far when it ran again: it does not repeat itself", request_.backends[0]);
  const std::unique_ptr<World> reference = make_world(0);
  for (uint64_t k = 0; k <= departure_->step; ++k)
    step(0, *reference, k, [&](const Launch &launch, uint32_t number) {
      if (k == departure_->step && number == departure_->output.launch)
        lay_side_by_side(*reference, launch, difference);
    });
  return difference;
}

void Lockstep::lay_side_by_side(World &reference, const Launch &launch, Difference &difference) const
{
  const Buffer buffer = *difference.buffer;
  const std::vector<char> &other = departure_->contents;
  const char *contents = contents_of(reference, buffer);
  const size_t width = scalar_bytes(buffer), count = std::min(other.size(), reference.memory().bytes(buffer)) / width;
  const auto differs = [&](size_t k) { return !same_number(buffer, contents + k * width, other.data() + k * width); };
  size_t first = count;
  for (size_t k = count; k-- > 0;)
    if (differs(k)) first = k, ++difference.differing;
  difference.note.clear();
  if (reference.memory().bytes(buffer) != other.size())
    difference.note = fmt::format("the buffer has {} bytes on one and {} on the other",
                                  reference.memory().bytes(buffer), other.size());
  if (first == count) {
    if (difference.note.empty())
      difference.note =
          fmt::format("'{}' gave other bits when it ran again: it does not repeat itself", request_.backends[0]);
    return;
  }
  difference.scalar = first;
  difference.location = location_in(buffer, first, pair_capacity(reference));
  difference.values[0] = value_at(buffer, contents + first * width);
  difference.values[1] = value_at(buffer, other.data() + first * width);
  difference.ulps = ulps_between(buffer, contents + first * width, other.data() + first * width);
  difference.bodies = bodies_of_item(reference, buffer, difference.location.item);
  difference.breakpoint = breakpoint_for(reference, launch, buffer, difference.location.item, difference.step);
}

Comparison Lockstep::run()
{
  std::vector<std::unique_ptr<World>> worlds;
  for (size_t index = 0; index < request_.backends.size(); ++index) worlds.push_back(make_world(index));
  for (current_ = 0; current_ < request_.steps && !result_.first_difference; ++current_) {
    step_reference(*worlds[0]);
    for (size_t index = 1; index < worlds.size() && !departure_; ++index) step_and_compare(index, *worlds[index]);
    result_.steps = current_ + 1;
    for (const auto &world : worlds)
      if (!result_.batch_fault) result_.batch_fault = world->batch_fault();
    if (departure_) result_.first_difference = explain();
    else compare_states(worlds);
    if (request_.after_step) request_.after_step(result_.steps);
  }
  result_.equal = !result_.first_difference;
  result_.quarantined = worlds[0]->quarantined();
  result_.broadphase = worlds[0]->settings().broadphase;
  result_.broadphase_why = worlds[0]->broadphase_why();
  return result_;
}

bool holds(const Memory &memory, Buffer buffer, size_t scalar)
{
  return (scalar + 1) * scalar_bytes(buffer) <= memory.bytes(buffer);
}

void change_in_memory(Memory &memory, Buffer buffer, size_t scalar)
{
  const size_t width = scalar_bytes(buffer);
  uint64_t value = 0;
  memory.download(buffer, &value, width, scalar * width);
  change_least(buffer, &value);
  memory.upload(buffer, &value, width, scalar * width);
}

/* Empty if the fault can be injected after this launch. */
std::string what_is_missing(const InjectedFault &error, const Memory &memory, const Launch &launch)
{
  const std::vector<Buffer> written = buffers_written(launch);
  if (std::find(written.begin(), written.end(), error.buffer) == written.end())
    return fmt::format("{} does not write {}", row_of(error.kernel).name, row_of(error.buffer).name);
  if (holds(memory, error.buffer, error.scalar)) return {};
  return fmt::format("{} holds {} numbers then, counted from 0", row_of(error.buffer).name,
                     memory.bytes(error.buffer) / scalar_bytes(error.buffer));
}

} // namespace

FaultInjector inject_fault(const InjectedFault &error, std::string *missing)
{
  if (missing) *missing = fmt::format("{} does not run in step {}", row_of(error.kernel).name, error.step);
  /* The world into which the fault was injected: a fresh world of the same index (the second run) gets it again. */
  return [error, missing, done = static_cast<World *>(nullptr)](size_t index, uint64_t step, World &world,
                                                                const Launch &launch) mutable {
    if (index != error.world || step != error.step || launch.kernel != error.kernel || done == &world) return;
    const std::string why = what_is_missing(error, world.memory(), launch);
    if (missing) *missing = why;
    if (!why.empty()) return;
    done = &world;
    change_in_memory(world.memory(), error.buffer, error.scalar);
  };
}

Comparison compare_backends(const Scene &scene, const ComparisonRequest &request)
{
  if (request.backends.size() < 2) throw InputError("comparing takes at least two backends: serial,tbb");
  return Lockstep(scene, request).run();
}

} // namespace tandem
