/* branches.cpp - see branches.h. A queue is flushed before another one waits for its events, as OpenCL asks for. */
#include "host/runtime/opencl/branches.h"

namespace tandem::opencl {
namespace {

cl_int mark(cl_command_queue queue, cl_event &event)
{
  const cl_int code =
      code_of(faults::Site::launch, [&] { return clEnqueueMarkerWithWaitList(queue, 0, nullptr, &event); });
  return code == CL_SUCCESS ? clFlush(queue) : code;
}

cl_int wait_for(cl_command_queue queue, cl_uint count, const cl_event *events)
{
  return code_of(faults::Site::launch, [&] { return clEnqueueBarrierWithWaitList(queue, count, events, nullptr); });
}

/* A queue beside `main`. */
cl_int create(cl_command_queue main, cl_command_queue &queue)
{
  cl_context context = nullptr;
  cl_device_id device = nullptr;
  cl_int code = clGetCommandQueueInfo(main, CL_QUEUE_CONTEXT, sizeof context, &context, nullptr);
  if (code == CL_SUCCESS) code = clGetCommandQueueInfo(main, CL_QUEUE_DEVICE, sizeof device, &device, nullptr);
  if (code == CL_SUCCESS && faults::strikes(faults::Site::allocation)) code = CL_OUT_OF_HOST_MEMORY;
  if (code == CL_SUCCESS) queue = clCreateCommandQueue(context, device, 0, &code);
  return code;
}

} // namespace

Branches::~Branches()
{
  close();
  for (const Branch &branch : branches_)
    if (branch.queue) clReleaseCommandQueue(branch.queue);
}

void Branches::close()
{
  for (Branch &branch : branches_) branch.is_open = false;
  if (start_) clReleaseEvent(start_);
  start_ = nullptr;
}

cl_int Branches::mark_start(cl_command_queue main)
{
  cl_int code = CL_SUCCESS;
  for (Branch &branch : branches_)
    if (!branch.queue && code == CL_SUCCESS) code = create(main, branch.queue);
  if (code == CL_SUCCESS) code = mark(main, start_);
  if (code != CL_SUCCESS) close();
  return code;
}

cl_int Branches::open(cl_command_queue main, uint32_t number, cl_command_queue &queue)
{
  const cl_int code = are_open() ? CL_SUCCESS : mark_start(main);
  if (code != CL_SUCCESS) return code;
  Branch &branch = branches_[number % most];
  queue = branch.queue;
  if (branch.is_open) return CL_SUCCESS;
  branch.is_open = true; /* also if it has begun nothing yet */
  return wait_for(queue, 1, &start_);
}

cl_int Branches::wait_for_branches(cl_command_queue main)
{
  std::array<cl_event, most> ends{};
  cl_uint count = 0;
  cl_int code = CL_SUCCESS;
  for (const Branch &branch : branches_)
    if (branch.is_open && code == CL_SUCCESS) code = mark(branch.queue, ends[count++]);
  if (code == CL_SUCCESS) code = wait_for(main, count, ends.data());
  for (cl_event end : ends)
    if (end) clReleaseEvent(end);
  return code;
}

cl_int Branches::join(cl_command_queue main)
{
  const cl_int code = wait_for_branches(main);
  for (const Branch &branch : branches_)
    if (code != CL_SUCCESS && branch.is_open) clFinish(branch.queue);
  close();
  return code;
}

} // namespace tandem::opencl
