/* branches.cpp - see branches.h. A queue is flushed before another one waits for its events, as OpenCL asks for. */
#include "host/runtime/opencl/branches.h"

namespace tandem::opencl {
namespace {

cl_int mark(cl_command_queue queue, cl::Event &event)
{
  cl_event marker = nullptr;
  cl_int code = clEnqueueMarkerWithWaitList(queue, 0, nullptr, &marker);
  if (code != CL_SUCCESS) return code;
  event = cl::Event(marker);
  return clFlush(queue);
}

} // namespace

cl_int Branches::mark_start(const cl::CommandQueue &main)
{
  for (Branch &branch : branches_) {
    branch.is_open = false;
    if (branch.queue()) continue;
    cl_int code = CL_SUCCESS;
    branch.queue = cl::CommandQueue(main.getInfo<CL_QUEUE_CONTEXT>(), main.getInfo<CL_QUEUE_DEVICE>(), 0, &code);
    if (code != CL_SUCCESS) return code;
  }
  return mark(main(), start_);
}

cl_int Branches::open(const cl::CommandQueue &main, uint32_t number, cl_command_queue &queue)
{
  if (!are_open()) {
    const cl_int code = mark_start(main);
    if (code != CL_SUCCESS) return code;
  }
  Branch &branch = branches_[number % most];
  queue = branch.queue();
  if (branch.is_open) return CL_SUCCESS;
  branch.is_open = true;
  const cl_event start = start_();
  return clEnqueueBarrierWithWaitList(queue, 1, &start, nullptr);
}

cl_int Branches::join(const cl::CommandQueue &main)
{
  start_ = cl::Event();
  std::array<cl::Event, most> ends;
  std::array<cl_event, most> waited{};
  cl_uint count = 0;
  for (Branch &branch : branches_) {
    if (!branch.is_open) continue;
    branch.is_open = false;
    const cl_int code = mark(branch.queue(), ends[count]);
    if (code != CL_SUCCESS) return code;
    waited[count] = ends[count]();
    ++count;
  }
  return count == 0 ? CL_SUCCESS : clEnqueueBarrierWithWaitList(main(), count, waited.data(), nullptr);
}

} // namespace tandem::opencl
