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

/* The kernel in OpenCL C, which follows cl/phases.cl. Its arguments are the first three below, these buffers, among
 * which are all that the kinds take, and with resident groups what groups need to meet. */
std::string phases_source(const std::vector<PhaseKind> &kinds, const std::vector<Buffer> &buffers,
                          bool has_resident_groups);

constexpr uint32_t script_argument = 0, phases_argument = 1, counts_argument = 2, arguments_before_buffers = 3;
enum ArgumentAfterBuffers : uint32_t {
  arrivals_argument,
  arrived_argument,
  patience_argument,
  arguments_after_buffers
};

/* What a program of phases is built from. A device may have to go without some of the kinds that are wanted. */
struct PhaseText {
  PhaseText(const DeviceContext &context, Features features, const std::set<PhaseKind> &wanted,
            bool has_resident_groups);
  EmbeddedProgram program() const; /* as long as this text lives */

  std::vector<PhaseKind> kinds;
  std::vector<Buffer> buffers;
  std::string source;
  bool resident_groups; /* phases of many items take all groups of a launch */
  std::string options;
};

} // namespace tandem::opencl
