/* context.h - one device, opened: what programs, storage and launches share. */
#pragma once

#include <string>

#include "host/runtime/opencl/api.h"
#include "host/runtime/opencl/branches.h"
#include "host/runtime/opencl/device.h"
#include "host/runtime/opencl/embedded_kernels.h"

namespace tandem::opencl {

/* A device as its driver describes it, before the self-test. */
struct Candidate {
  cl::Device device;
  DeviceInfo info;
  std::string unusable; /* why it cannot run anything; else empty */
  std::string lacks;    /* what exactness requires and the driver does not promise; else empty */
  bool promises_exact_division = false;
  cl::Context context; /* of its self-test, if it had one: a driver takes a tenth of a second or more to make one */
};

/* Throws DeviceError if a driver crashes or hangs when it is queried (host/runtime/opencl/probe.h). */
std::vector<Candidate> find_candidates();

struct DeviceContext {
  /* Takes the context of the candidate, or makes one. */
  explicit DeviceContext(const Candidate &candidate);
  /* Replaces the queue by a new one; if it throws DeviceError, the old queue remains. */
  void open_queue(cl_command_queue_properties properties);
  /* The queue, which waits for the branches that were open. Throws DeviceError. */
  cl_command_queue in_order() const;
  /* The queue of a branch (branches.h). Throws DeviceError. */
  cl_command_queue branch(uint32_t number) const;

  DeviceInfo info;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue; /* in order; while branches may be open, in_order() */
  std::string options;    /* for every program: the floating-point rules */

private:
  mutable Branches branches_;
};

inline bool is_pocl(const DeviceContext &context)
{
  return context.info.platform_name == "Portable Computing Language";
}

/* Empty if the device computes the host's bits, else what differs. It runs once per device and process, and leaves the
 * candidate the context that it made. */
std::string self_test(Candidate &candidate);

/* The same for an open device, without caching, over `count` inputs (a multiple of TILE). `program` is cl/self_test.cl
 * or a test's modification of it. */
std::string self_test(const DeviceContext &context, uint32_t count, const EmbeddedProgram &program);

} // namespace tandem::opencl
