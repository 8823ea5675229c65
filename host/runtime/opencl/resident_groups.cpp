/* resident_groups.cpp - see resident_groups.h. */
#include "host/runtime/opencl/resident_groups.h"

#include <algorithm>

#include "host/runtime/opencl/phase_source.h"
#include "shared/counts.h"
#include "shared/parallel/phase_limits.h"

namespace tandem::opencl {
namespace {

constexpr cl_uint patience_of_test = 1u << 16;     /* some hundredths of a second on a GPU */
constexpr uint32_t arrived_before_test = ~0u - 99; /* the count of arrivals passes 2^32 in the test */

/* Every phase of the test passes the numbers of a ring on by one group. */
std::vector<uint32_t> script_of_test()
{
  std::vector<uint32_t> script(PHASE_WORDS * MOST_PHASES, 0);
  for (uint32_t phase = 0; phase < MOST_PHASES; ++phase) {
    script[PHASE_WORDS * phase] = PHASE_OF_TEST;
    script[PHASE_WORDS * phase + PHASE_GROUPS_AT] = script[PHASE_WORDS * phase + PHASE_MEETING_AT] = 1;
  }
  return script;
}

cl::Buffer buffer_with(const DeviceContext &context, std::vector<uint32_t> words)
{
  return cl::Buffer(context.context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, words.size() * sizeof words[0],
                    words.data());
}

uint32_t number_of(uint32_t place) { return 1000 * (place + 1); }

/* The ring has a place for each item of each group. The test passes this buffer for all others as well, among them the
 * counts. */
std::vector<uint32_t> words_before_test(uint32_t places)
{
  std::vector<uint32_t> words(std::max<size_t>(ARRIVALS_RING + 2 * places, COUNT_TOTAL), 0);
  words[ARRIVALS_COUNT] = arrived_before_test;
  for (uint32_t place = 0; place < places; ++place) words[ARRIVALS_RING + place] = number_of(place);
  return words;
}

/* Each phase takes all numbers to the group before. */
bool passed(const std::vector<uint32_t> &words, uint32_t groups, uint32_t group_size)
{
  const uint32_t places = groups * group_size;
  bool right = words[ARRIVALS_DEADLOCK] == 0 && words[ARRIVALS_COUNT] == arrived_before_test + MOST_PHASES * groups;
  for (uint32_t place = 0; place < places; ++place)
    right &= words[ARRIVALS_RING + place] == number_of((place + MOST_PHASES * group_size) % places) + MOST_PHASES;
  return right;
}

} // namespace

bool has_fence_between_groups(const DeviceContext &context)
{
  return context.device.getInfo<CL_DEVICE_VERSION>().starts_with("OpenCL 3");
}

ResidentGroups::ResidentGroups(const DeviceContext &context, const cl::Kernel &kernel, size_t buffers,
                               size_t group_size)
{
  const uint32_t units = context.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  for (int attempt = 0; attempt < 2 && count_ == 1 && units > 1; ++attempt) /* the device may be busy with other work */
    if (run_together(context, kernel, buffers, group_size, units)) count_ = units;
  arrivals_ = buffer_with(context, std::vector<uint32_t>(ARRIVALS_RING, 0));
}

/* It has a queue of its own, because a world may be running while a program is built for it. */
bool ResidentGroups::run_together(const DeviceContext &context, const cl::Kernel &kernel, size_t buffers,
                                  size_t group_size, uint32_t groups)
try {
  const auto places = static_cast<uint32_t>(groups * group_size);
  std::vector<uint32_t> words = words_before_test(places);
  const cl::Buffer rows = buffer_with(context, script_of_test()), all_others = buffer_with(context, words);
  cl::Kernel test = kernel;
  const auto after_buffers = static_cast<cl_uint>(arguments_before_buffers + buffers);
  for (cl_uint argument = counts_argument; argument <= after_buffers + arrivals_argument; ++argument)
    test.setArg(argument, all_others);
  test.setArg(script_argument, rows);
  test.setArg(phases_argument, static_cast<cl_uint>(MOST_PHASES));
  test.setArg(after_buffers + arrived_argument, static_cast<cl_uint>(arrived_before_test));
  test.setArg(after_buffers + patience_argument, patience_of_test);
  const cl::CommandQueue queue(context.context, context.device);
  queue.enqueueNDRangeKernel(test, cl::NullRange, cl::NDRange(groups * group_size), cl::NDRange(group_size));
  queue.enqueueReadBuffer(all_others, CL_TRUE, 0, words.size() * sizeof words[0], words.data());
  return passed(words, groups, static_cast<uint32_t>(group_size));
} catch (const cl::Error &) { /* a device that cannot even be tested has one group */
  return false;
}

} // namespace tandem::opencl
