/* phase_program.cpp - see phase_program.h. */
#include "host/runtime/opencl/phase_program.h"

#include <algorithm>

#include <fmt/format.h>

#include "host/runtime/opencl/program.h"
#include "host/runtime/opencl/storage.h"
#include "shared/parallel/phase_limits.h"

namespace tandem::opencl {
namespace {

constexpr size_t items_of_group = 256;
constexpr size_t most_scripts = 8;
constexpr uint32_t items_of_resident_group = 128; /* few groups have to wait for few others */

} // namespace

PhaseProgram::PhaseProgram(const DeviceContext &context, const PhaseText &text, size_t group_size,
                           uint32_t items_of_first_group)
    : context_(context), kinds_(text.kinds), buffers_(text.buffers), place_of_(all_buffers()), cases_(all_kernels()),
      program_(build_program(context, text.program(), text.options)), items_of_first_group_(items_of_first_group)
{
  for (size_t k = 0; k < kinds_.size(); ++k) cases_[index_of(kinds_[k].kernel)].push_back(static_cast<uint32_t>(k));
  for (size_t place = 0; place < buffers_.size(); ++place) place_of_[index_of(buffers_[place])] = place;
  const Script script = new_script();
  const size_t most = script.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(context.device);
  group_size_ = std::min(group_size ? group_size : items_of_group, most);
  if (text.resident_groups) resident_.emplace(context, script.kernel, buffers_.size(), group_size_);
}

/* Words that the device has not read yet must stay. */
PhaseProgram::~PhaseProgram()
{
  for (const Script &script : scripts_) wait_for_words(script);
}

void PhaseProgram::run(std::span<const BoundLaunch> series, void *counts)
{
  bind(series, counts);
  write_words(series);
  Script &script = script_with(words_);
  const uint32_t groups = groups_for(series);
  set_arguments(script, static_cast<uint32_t>(series.size()), counts);
  if (resident_) set_meetings(script);
  const size_t items = groups * group_size_;
  const cl_int code = code_of(faults::Site::launch, [&] {
    return clEnqueueNDRangeKernel(context_.in_order(), script.kernel(), 1, nullptr, &items, &group_size_, 0, nullptr,
                                  nullptr);
  });
  if (code != CL_SUCCESS) fail("launch", code);
  if (resident_) resident_->note_launch(groups, meetings_of(series.size()));
  clFlush(context_.in_order());
}

void PhaseProgram::fail(const char *what, cl_int code) const
{
  throw DeviceError(fmt::format("OpenCL device {} ({}): {} of kernel run_phases failed: {}", context_.info.device_name,
                                context_.info.platform_name, what, error_name(code)));
}

std::optional<uint32_t> PhaseProgram::case_of(const Launch &launch) const
{
  for (const uint32_t number : cases_[index_of(launch.kernel)]) {
    const std::vector<Buffer> &slots = kinds_[number].slots;
    if (std::equal(slots.begin(), slots.end(), launch.slots.begin(), launch.slots.end())) return number;
  }
  return std::nullopt;
}

/* Arguments of buffers that no phase of the series takes are set to the counts, because a kernel without some of its
 * arguments cannot be launched. */
void PhaseProgram::bind(std::span<const BoundLaunch> series, void *counts)
{
  handles_.assign(buffers_.size(), counts);
  for (const BoundLaunch &bound : series) bind(bound);
}

void PhaseProgram::bind(const BoundLaunch &bound)
{
  const KernelRow &row = row_of(bound.launch.kernel);
  size_t slot = 0;
  for (size_t k = 0; k < row.arguments.size(); ++k) {
    const Argument &argument = row.arguments[k];
    if (argument.kind == Argument::Kind::value) continue;
    const Buffer buffer = argument.kind == Argument::Kind::slot ? bound.launch.slots.at(slot++) : argument.buffer;
    handles_[place_of_[index_of(buffer)]] = bound.arguments[k].handle;
  }
}

void PhaseProgram::write_words(std::span<const BoundLaunch> series)
{
  words_.assign(PHASE_WORDS * series.size(), 0);
  for (size_t phase = 0; phase < series.size(); ++phase) {
    const Launch &launch = series[phase].launch;
    uint32_t *const row = words_.data() + PHASE_WORDS * phase;
    row[0] = case_of(launch).value();
    row[PHASE_RANGE_AT] = launch.first;
    row[PHASE_RANGE_AT + 1] = launch.last;
    row[PHASE_GROUPS_AT] = takes_all_groups(series[phase]);
    row[PHASE_MEETING_AT] = meet_after(series, phase);
    std::copy(launch.values.begin(), launch.values.end(), row + PHASE_VALUES_AT);
  }
}

bool PhaseProgram::takes_all_groups(const BoundLaunch &bound) const
{
  const bool is_group = row_of(bound.launch.kernel).execution == Execution::group;
  return has_resident_groups() && bound.items > (is_group ? TILE : items_of_first_group_);
}

/* As many as the largest phase keeps busy. */
uint32_t PhaseProgram::groups_for(std::span<const BoundLaunch> series) const
{
  if (!has_resident_groups()) return 1;
  uint32_t most_items = 0;
  for (const BoundLaunch &bound : series)
    if (takes_all_groups(bound)) most_items = std::max(most_items, bound.items);
  return std::clamp(most_items / items_of_resident_group, most_items > 0 ? 2u : 1u, resident_->count());
}

/* Groups wait for each other before and after phases of all groups. */
bool PhaseProgram::meet_after(std::span<const BoundLaunch> series, size_t phase) const
{
  return phase + 1 < series.size() && (takes_all_groups(series[phase]) || takes_all_groups(series[phase + 1]));
}

uint32_t PhaseProgram::meetings_of(size_t phases) const
{
  uint32_t meetings = 0;
  for (size_t phase = 0; phase < phases; ++phase) meetings += words_[PHASE_WORDS * phase + PHASE_MEETING_AT];
  return meetings;
}

PhaseProgram::Script &PhaseProgram::script_with(const std::vector<uint32_t> &words)
{
  const auto found =
      std::find_if(scripts_.begin(), scripts_.end(), [&](const Script &script) { return script.words == words; });
  Script &script = found != scripts_.end() ? *found : unused_script();
  if (script.words != words) upload(script, words);
  script.used = ++uses_;
  return script;
}

/* A new one, or the one that was used least recently. */
PhaseProgram::Script &PhaseProgram::unused_script()
{
  if (scripts_.size() < most_scripts) return scripts_.emplace_back(new_script());
  return *std::min_element(scripts_.begin(), scripts_.end(), [](auto &a, auto &b) { return a.used < b.used; });
}

PhaseProgram::Script PhaseProgram::new_script() const
{
  Script script;
  try {
    fail_where_a_test_wants(faults::Site::build, "clCreateKernel");
    script.kernel = cl::Kernel(program_, "run_phases");
    script.buffer = cl::Buffer(context_.context, CL_MEM_READ_ONLY, PHASE_WORDS * MOST_PHASES * sizeof(uint32_t));
    script.kernel.setArg(script_argument, script.buffer);
  } catch (const cl::Error &error) {
    fail("creation", error.err());
  }
  script.arguments.assign(arguments_before_buffers + buffers_.size(), UINT64_MAX);
  return script;
}

void PhaseProgram::wait_for_words(const Script &script)
{
  if (const cl_event written = script.written()) clWaitForEvents(1, &written);
}

void PhaseProgram::upload(Script &script, const std::vector<uint32_t> &words)
{
  wait_for_words(script);
  script.words = words;
  cl_event written = nullptr;
  const cl_int code = code_of(faults::Site::transfer, [&] {
    return clEnqueueWriteBuffer(context_.in_order(), script.buffer(), CL_FALSE, 0, words.size() * sizeof words[0],
                                script.words.data(), 0, nullptr, &written);
  });
  if (code != CL_SUCCESS) {
    script.words.clear();
    fail("script", code);
  }
  script.written = cl::Event(written);
}

void PhaseProgram::set_arguments(Script &script, uint32_t phases, void *counts)
{
  set(script, phases_argument, sizeof phases, &phases);
  set_handle(script, counts_argument, counts);
  for (size_t place = 0; place < buffers_.size(); ++place)
    set_handle(script, static_cast<cl_uint>(arguments_before_buffers + place), handles_[place]);
}

void PhaseProgram::set_meetings(Script &script)
{
  const auto after_buffers = static_cast<cl_uint>(arguments_before_buffers + buffers_.size());
  const uint32_t arrived = resident_->arrived();
  const cl_mem arrivals = resident_->arrivals()();
  set(script, after_buffers + arrivals_argument, sizeof arrivals, &arrivals);
  set(script, after_buffers + arrived_argument, sizeof arrived, &arrived);
  set(script, after_buffers + patience_argument, sizeof patience_of_launches, &patience_of_launches);
}

void PhaseProgram::set_handle(Script &script, cl_uint index, void *handle)
{
  const DeviceBuffer &buffer = *static_cast<const DeviceBuffer *>(handle);
  if (script.arguments[index] == buffer.serial) return;
  set(script, index, sizeof buffer.memory, &buffer.memory);
  script.arguments[index] = buffer.serial;
}

void PhaseProgram::set(Script &script, cl_uint index, size_t bytes, const void *value)
{
  const cl_int code =
      code_of(faults::Site::launch, [&] { return clSetKernelArg(script.kernel(), index, bytes, value); });
  if (code != CL_SUCCESS) fail(fmt::format("argument {}", index).c_str(), code);
}

} // namespace tandem::opencl
