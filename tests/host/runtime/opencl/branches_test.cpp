/* Branches of a queue: those that can be had, and those whose every call fails in turn. */
#include <array>
#include <vector>

#include "host/runtime/interface/faults.h"
#include "host/runtime/opencl/branches.h"
#include "tests/host/runtime/opencl/opencl_device.h"

using namespace tandem;
using opencl::Branches;

namespace {

constexpr cl_uint stretch = 1u << 20, stretches = 2;

int calls_before_failure = -1; /* the call after them fails; below 0: none does */

bool strike(faults::Site) { return calls_before_failure-- == 0; }

/* Lets a call fail while the object lives. */
class Failing {
public:
  explicit Failing(int call)
  {
    calls_before_failure = call;
    faults::hook = strike;
  }
  ~Failing() { faults::hook = nullptr; }
};

class Filled {
public:
  explicit Filled(const opencl::DeviceContext &context)
      : context_(context), buffer_(context.context, CL_MEM_READ_WRITE, stretches * stretch * sizeof(cl_uint))
  {}
  /* A stretch gets its number many times, and then a last one. */
  void fill(cl_command_queue queue, cl_uint number) const
  {
    for (cl_uint value = 0; value <= 20; ++value) {
      const cl_uint pattern = value == 20 ? number : 1000 + value;
      REQUIRE(clEnqueueFillBuffer(queue, buffer_(), &pattern, sizeof pattern, number * stretch * sizeof pattern,
                                  stretch * sizeof pattern, 0, nullptr, nullptr) == CL_SUCCESS);
    }
  }
  bool is_right() const
  {
    std::vector<cl_uint> seen(stretches * stretch);
    context_.queue.enqueueReadBuffer(buffer_, CL_TRUE, 0, seen.size() * sizeof(cl_uint), seen.data());
    for (cl_uint i = 0; i < seen.size(); ++i)
      if (seen[i] != i / stretch) return false;
    return true;
  }

private:
  const opencl::DeviceContext &context_;
  cl::Buffer buffer_;
};

} // namespace

TEST_CASE("branches are queues of their own")
{
  const opencl::DeviceContext context(test_device());
  Branches branches;
  std::array<cl_command_queue, Branches::most + 1> queues{};
  for (cl_uint number = 0; number <= Branches::most; ++number)
    REQUIRE(branches.open(context.queue(), number, queues[number]) == CL_SUCCESS);
  CHECK(queues[Branches::most] == queues[0]);
  for (cl_uint number = 0; number < Branches::most; ++number) {
    CHECK(queues[number] != context.queue());
    for (cl_uint other = 0; other < number; ++other) CHECK(queues[number] != queues[other]);
  }
  CHECK(branches.are_open());
  CHECK(branches.join(context.queue()) == CL_SUCCESS);
  CHECK(!branches.are_open());
}

TEST_CASE("branches that fail to open or to join are closed, and their work is done")
{
  const opencl::DeviceContext context(test_device());
  Branches branches;
  int failed = 0;
  for (int call = 0, succeeded = 0; succeeded == 0; ++call) {
    cl_int code = CL_SUCCESS;
    const Filled filled(context);
    {
      const Failing failing(call);
      for (cl_uint number = 0; number < stretches; ++number) {
        cl_command_queue queue = context.queue();
        const cl_int opened = branches.open(context.queue(), number, queue);
        if (opened != CL_SUCCESS) code = opened;
        filled.fill(opened == CL_SUCCESS ? queue : context.queue(), number);
      }
      const cl_int joined = branches.are_open() ? branches.join(context.queue()) : CL_SUCCESS;
      if (joined != CL_SUCCESS) code = joined;
    }
    CAPTURE(call);
    CHECK(!branches.are_open());
    CHECK(filled.is_right());
    if (code == CL_SUCCESS) succeeded = 1;
    else ++failed;
  }
  CHECK(failed >= 5); /* of each branch the beginning and the end, and what waits for both */
}
