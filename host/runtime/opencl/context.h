/* context.h - one device, opened: what programs, storage and launches share. */
#pragma once

#include <string>

#include "host/runtime/opencl/api.h"
#include "host/runtime/opencl/device.h"
#include "host/runtime/opencl/embedded_kernels.h"

namespace tandem::opencl {

/* A device as its driver describes it, not tested yet. */
struct Candidate {
  cl::Device device;
  DeviceInfo info;
  std::string unusable; /* why it can run nothing at all; else empty */
  std::string lacks;    /* what exactness needs and the driver does not promise; else empty */
  bool promises_exact_division = false;
};

/* DeviceError where a driver does not survive the question (host/runtime/opencl/probe.h). */
std::vector<Candidate> find_candidates();

struct DeviceContext {
  explicit DeviceContext(const Candidate &candidate);
  /* A new queue in the place of the one that is; DeviceError leaves that. */
  void open_queue(cl_command_queue_properties properties);

  DeviceInfo info;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue; /* in order */
  std::string options;    /* of every program: the language and the rules of floating point */
};

inline bool is_pocl(const DeviceContext &context)
{
  return context.info.platform_name == "Portable Computing Language";
}

/* Empty if the device gives the host's bits, else what differs. Runs once a device and process. */
std::string self_test(const Candidate &candidate);

/* The same of an open device, every time: over `count` inputs (a multiple of TILE). `program`: cl/self_test.cl, or what
 * a test made of it. */
std::string self_test(const DeviceContext &context, uint32_t count, const EmbeddedProgram &program);

} // namespace tandem::opencl
