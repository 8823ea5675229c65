/* phase_source.cpp - see phase_source.h. */
#include "host/runtime/opencl/phase_source.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "host/runtime/opencl/program.h"
#include "host/runtime/opencl/resident_groups.h"
#include "shared/parallel/phase_limits.h"

namespace tandem::opencl {
namespace {

/* Contacts of general convex shapes take a compiler far longer than they gain by having no launches of their own. */
constexpr Features long_to_compile =
    FEATURE_CONVEX_CONVEX | FEATURE_CONVEX_HALF_SPACE | FEATURE_SAT_SPLIT | FEATURE_CONTINUOUS;

/* The buffer of each argument; none for values. */
std::vector<std::optional<Buffer>> buffers_of(const PhaseKind &kind)
{
  std::vector<std::optional<Buffer>> buffers;
  size_t slot = 0;
  for (const Argument &argument : row_of(kind.kernel).arguments) switch (argument.kind) {
    case Argument::Kind::buffer: buffers.emplace_back(argument.buffer); break;
    case Argument::Kind::slot: buffers.emplace_back(kind.slots.at(slot++)); break;
    case Argument::Kind::value: buffers.emplace_back(std::nullopt); break;
    }
  return buffers;
}

const EmbeddedEntry &entry_of(Kernel kernel)
{
  const KernelRow &row = row_of(kernel);
  for (const EmbeddedEntry &entry : embedded_program(name_of(row.stage)).entries)
    if (std::strcmp(entry.kernel, row.name) == 0) return entry;
  throw std::logic_error(fmt::format("cl/{}.cl has no entry of {}", name_of(row.stage), row.name));
}

/* Replaces $0, $1 .. in the text of a call. */
std::string with_arguments(std::string_view call, const std::vector<std::string> &arguments)
{
  std::string text;
  for (size_t at = 0; at < call.size(); ++at) {
    if (call[at] != '$') {
      text += call[at];
      continue;
    }
    size_t number = 0;
    while (at + 1 < call.size() && call[at + 1] >= '0' && call[at + 1] <= '9')
      number = 10 * number + static_cast<size_t>(call[++at] - '0');
    text += arguments.at(number);
  }
  return text;
}

/* A buffer of a module may have any name. */
std::string name_in_source(Buffer buffer) { return std::string("buffer_") + row_of(buffer).name; }

/* Buffers are passed as they are, and values as the words of the phase's row. */
std::vector<std::string> arguments_of(const PhaseKind &kind)
{
  std::vector<std::string> arguments;
  uint32_t value = PHASE_VALUES_AT;
  for (const std::optional<Buffer> &buffer : buffers_of(kind))
    arguments.push_back(buffer ? name_in_source(*buffer) : fmt::format("row[{}]", value++));
  return arguments;
}

bool is_group(Kernel kernel) { return row_of(kernel).execution == Execution::group; }

/* An item kernel is a function that all cases of it call. Inlined into each, it took an H200's compiler a quarter to
 * two thirds longer, and the steps were no faster (docs/results/2026-11-26-worlds-memory-starts). */
std::string function_of(Kernel kernel)
{
  std::vector<std::string> names;
  std::string parameters;
  for (const Argument &argument : row_of(kernel).arguments) {
    names.push_back(fmt::format("argument_{}", names.size()));
    const char *type = argument.kind == Argument::Kind::value ? "uint" : "__global uint *";
    parameters += fmt::format("{} {}, ", type, names.back());
  }
  return fmt::format("static NOT_INLINE void phase_{}({}uint first, uint last, uint stride)\n"
                     "{{\n  for (uint i = first; i < last; i += stride) {};\n}}\n",
                     row_of(kernel).name, parameters, with_arguments(entry_of(kernel).call, names));
}

/* Of a group kernel, which needs the local memory of the launch, a case holds the whole. */
std::string case_of(const PhaseKind &kind)
{
  const std::vector<std::string> arguments = arguments_of(kind);
  if (is_group(kind.kernel))
    return fmt::format("FOR_EACH_GROUP(group) {}; break;\n", with_arguments(entry_of(kind.kernel).call, arguments));
  std::string call = fmt::format("phase_{}(", row_of(kind.kernel).name);
  for (const std::string &argument : arguments) call += argument + ", ";
  return call + "FIRST_OF_PHASE, last, STRIDE_OF_PHASE); break;\n";
}

std::string functions_of(const std::vector<PhaseKind> &kinds)
{
  std::set<Kernel> kernels;
  for (const PhaseKind &kind : kinds)
    if (!is_group(kind.kernel)) kernels.insert(kind.kernel);
  std::string functions;
  for (const Kernel kernel : kernels) functions += function_of(kernel);
  return functions;
}

/* The largest local memory of these kinds. */
std::string local_words_of(const std::vector<PhaseKind> &kinds)
{
  std::set<std::string> sizes;
  for (const PhaseKind &kind : kinds)
    if (const char *words = entry_of(kind.kernel).local_words; *words) sizes.insert(words);
  std::string largest = "1";
  for (const std::string &size : sizes) largest = fmt::format("LARGER({}, {})", size, largest);
  return largest;
}

/* All buffers that these kinds take, in their order. */
std::vector<Buffer> buffers_of(const std::vector<PhaseKind> &kinds)
{
  std::set<Buffer> buffers;
  for (const PhaseKind &kind : kinds)
    for (const std::optional<Buffer> &buffer : buffers_of(kind))
      if (buffer) buffers.insert(*buffer);
  return {buffers.begin(), buffers.end()};
}

size_t most_buffers_of(const DeviceContext &context)
{
  return context.device.getInfo<CL_DEVICE_MAX_PARAMETER_SIZE>() / sizeof(cl_mem) - arguments_before_buffers -
         arguments_after_buffers;
}

/* A device takes a limited number of arguments, so a program may have to go without some kinds. PoCL 3.1 cannot form
 * the loops of a work-group where a loop stands around the phases of a group kernel (cl/entry.h). */
std::vector<PhaseKind> those_that_fit(const std::set<PhaseKind> &kinds, const DeviceContext &context)
{
  const size_t most_buffers = most_buffers_of(context);
  std::vector<PhaseKind> fitting;
  for (const PhaseKind &kind : kinds) {
    const KernelRow &row = row_of(kind.kernel);
    if ((is_pocl(context) && is_group(kind.kernel)) || (row.feature & long_to_compile)) continue;
    fitting.push_back(kind);
    if (buffers_of(fitting).size() > most_buffers) fitting.pop_back();
  }
  return fitting;
}

const char *options_of_resident_groups(const DeviceContext &context)
{
  return has_fence_between_groups(context) ? " -D RESIDENT_GROUPS -cl-std=CL3.0" : " -D RESIDENT_GROUPS";
}

} // namespace

PhaseKind kind_of(const Launch &launch) { return {launch.kernel, {launch.slots.begin(), launch.slots.end()}}; }

std::string phases_source(const std::vector<PhaseKind> &kinds, const std::vector<Buffer> &buffers,
                          bool has_resident_groups)
{
  std::string source = functions_of(kinds);
  source += fmt::format("__kernel void run_phases(__global const uint *script, uint phases, __global {}uint *range",
                        has_resident_groups ? "" : "const ");
  for (const Buffer buffer : buffers) source += fmt::format(",\n    __global uint *{}", name_in_source(buffer));
  if (has_resident_groups) source += ",\n    __global uint *arrivals, uint arrived, uint patience";
  source += fmt::format(")\n{{\n  __local uint local_memory[{}];\n  BEGIN_PHASES\n", local_words_of(kinds));
  for (size_t k = 0; k < kinds.size(); ++k) source += fmt::format("  case {}: {}", k, case_of(kinds[k]));
  return source + "  END_PHASES\n}\n";
}

PhaseText::PhaseText(const DeviceContext &context, Features features, const std::set<PhaseKind> &wanted,
                     bool has_resident_groups)
    : kinds(those_that_fit(wanted, context)), buffers(buffers_of(kinds)),
      source(phases_source(kinds, buffers, has_resident_groups)), resident_groups(has_resident_groups),
      options(fmt::format("-D FEATURES={:#x}ul{}", features & features_read(embedded_program("phases")),
                          has_resident_groups ? options_of_resident_groups(context) : ""))
{}

EmbeddedProgram PhaseText::program() const
{
  EmbeddedProgram program = embedded_program("phases");
  program.entries = {{"run_phases", source.c_str(), "", ""}};
  return program;
}

} // namespace tandem::opencl
