/* phase_source.h - writes the kernel run_phases, which has a case for each kind of phase (cl/phases.cl). */
#pragma once

#include <compare>
#include <set>
#include <string>
#include <vector>

#include "host/runtime/interface/backend.h"
#include "host/runtime/opencl/context.h"

namespace tandem::opencl {

/* A kernel with the buffers of its slots. */
struct PhaseKind {
  Kernel kernel;
  std::vector<Buffer> slots;
  auto operator<=>(const PhaseKind &) const = default;
};

PhaseKind kind_of(const Launch &launch);

/* The kernel in OpenCL C, which follows cl/phases.cl. Its arguments are the script, the number of phases, the counts,
 * and these buffers, among which are all that the kinds take. */
std::string phases_source(const std::vector<PhaseKind> &kinds, const std::vector<Buffer> &buffers);

constexpr uint32_t arguments_before_buffers = 3;

/* What a program of phases is built from. A device may have to go without some of the kinds that are wanted. */
struct PhaseText {
  PhaseText(const DeviceContext &context, Features features, const std::set<PhaseKind> &wanted);
  EmbeddedProgram program() const; /* as long as this text lives */

  std::vector<PhaseKind> kinds;
  std::vector<Buffer> buffers;
  std::string source, options;
};

} // namespace tandem::opencl
