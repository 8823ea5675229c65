/* step_buffers.cpp - allocates the buffers that steps and queries need; see step_buffers.h. */
#include "host/world/step_buffers.h"

#include <stdexcept>

#include <fmt/format.h>

#include <tandem/error.h>

namespace tandem {

bool is_sized_by_writes(Buffer buffer)
{
  return index_of(buffer) >= buffer_count && row_of(buffer).capacity == Capacity::NOTHING;
}

namespace {

/* What is carried for joints that no kernel takes belongs to joints that are gone; others would begin with it. */
bool is_of_joints(Buffer buffer)
{
  const Capacity capacity = row_of(buffer).capacity;
  return is_carried(row_of(buffer).lifetime) && (capacity == Capacity::JOINTS || capacity == Capacity::JOINT_AXES);
}

} // namespace

/* If one side of a carried buffer is touched, both are needed. */
void StepBuffers::take_needs(Recorder recorder)
{
  std::vector<bool> &touched = recorder.touched;
  touched.resize(queried_.size()); /* modules that were added after this world are not part of it */
  for (const CarriedBuffer &buffer : carried_) {
    const bool needed = touched[index_of(buffer.now)] || touched[index_of(buffer.previous)];
    touched[index_of(buffer.now)] = touched[index_of(buffer.previous)] = needed;
  }
  needs_ = {std::move(recorder.kernels), std::move(recorder.touched), std::move(recorder.uses),
            StepSpans{std::move(recorder.spans), std::move(recorder.between_steps), recorder.first_of_commit}};
}

void StepBuffers::give_back_needs(Needs before)
{
  needs_ = std::move(before);
  ready_ = false;
}

size_t StepBuffers::wanted_bytes(Buffer buffer, const Sizes &sizes) const
{
  return needs_.touched[index_of(buffer)] || is_queried(buffer) ? bytes_of(buffer, sizes) : 0;
}

/* What is there though no kernel takes it now is written with all others of its kind, so it has room for them. */
size_t StepBuffers::written_bytes(Buffer buffer, const Sizes &sizes) const
{
  return memory_.bytes(buffer) > 0 && !is_of_joints(buffer) ? bytes_of(buffer, sizes) : wanted_bytes(buffer, sizes);
}

void StepBuffers::keep_after_steps(Buffer buffer)
{
  if (kept_[index_of(buffer)]) return;
  kept_[index_of(buffer)] = true;
  changed();
}

void StepBuffers::keep_after_steps_as(const StepBuffers &other)
{
  kept_ = other.kept_;
  changed();
}

std::vector<bool> StepBuffers::apart() const
{
  std::vector<bool> apart = queried_;
  for (size_t i = 0; i < kept_.size(); ++i) apart[i] = apart[i] || kept_[i];
  return apart;
}

/* Of the buffers that grow or shrink, only the present sides of carried buffers must keep their contents, also those
 * that no kernel takes now. They come last, when the others have released their memory. */
void StepBuffers::allocate(const Sizes &sizes)
{
  for (size_t i = 0; i < needs_.touched.size(); ++i)
    if (needs_.touched[i] || queried_[i]) check_size(buffer_at(i), sizes);
  ++allocations_;
  memory_.share({});
  for (size_t i = 0; i < needs_.touched.size(); ++i) {
    const Buffer buffer = buffer_at(i);
    const Lifetime lifetime = row_of(buffer).lifetime;
    if (is_sized_by_writes(buffer)) continue;
    if (lifetime == Lifetime::SCENE) memory_.grow(buffer, written_bytes(buffer, sizes));
    else if (!is_carried(lifetime)) memory_.resize(buffer, wanted_bytes(buffer, sizes));
  }
  for (const CarriedBuffer &buffer : carried_) memory_.resize(buffer.previous, wanted_bytes(buffer.previous, sizes));
  for (const CarriedBuffer &buffer : carried_) {
    const size_t bytes = written_bytes(buffer.now, sizes);
    if (bytes > 0 || is_of_joints(buffer.now)) memory_.fit(buffer.now, bytes);
  }
  if (shares_) memory_.share(tenancies_of(needs_.spans, memory_, apart()));
}

void StepBuffers::make_ready(const Sizes &sizes)
{
  if (ready_) return;
  allocate(sizes);
  for (const auto &[kernel, buffer] : needs_.uses) memory_.reserve(buffer, backends_.of(kernel).storage());
  for (const CarriedBuffer &buffer : carried_)
    for (const auto &[text, backend] : backends_.all()) reserve_both_sides(buffer, backend->storage());
  for (const auto &[text, backend] : backends_.all()) settle(*backend);
  ready_ = true;
}

/* The sides change places in a step, and tenants may have brought one of them here. */
void StepBuffers::reserve_both_sides(const CarriedBuffer &buffer, Storage &storage)
{
  if (memory_.holds(buffer.now, storage)) memory_.reserve(buffer.previous, storage);
  if (memory_.holds(buffer.previous, storage)) memory_.reserve(buffer.now, storage);
}

/* The scratch of modules may hold what the user wrote between steps, and that of queries what is told once. */
void StepBuffers::forget_scratch()
{
  if (backends_.all().size() < 2) return;
  for (size_t i = 0; i < buffer_count; ++i)
    if (needs_.touched[i] && row_of(buffer_at(i)).lifetime == Lifetime::SCRATCH &&
        row_of(buffer_at(i)).capacity != Capacity::NOTHING)
      memory_.forget_contents(buffer_at(i));
}

/* Drivers may postpone allocation until the work that fills the buffers runs, so that work is waited for. */
void StepBuffers::settle(Backend &backend)
{
  try {
    backend.finish();
  } catch (const std::runtime_error &error) {
    throw OutOfMemory(
        fmt::format("out of memory: {} bytes of buffers do not fit: {}", memory_.total_bytes(), error.what()));
  }
}

void StepBuffers::ensure_capacity(Buffer buffer, const Sizes &sizes)
{
  queried_[index_of(buffer)] = true;
  memory_.separate(buffer);
  if (!needs_.touched[index_of(buffer)]) memory_.resize(buffer, bytes_of(buffer, sizes));
}

} // namespace tandem
