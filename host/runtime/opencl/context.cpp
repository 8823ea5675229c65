/* context.cpp - queries drivers for their devices and opens one; see context.h. */
#include "host/runtime/opencl/context.h"

#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/runtime/interface/floating_point.h"
#include "host/runtime/opencl/installed_drivers.h"
#include "host/runtime/opencl/probe.h"
#include "shared/platform.h"

namespace tandem::opencl {
namespace {

/* Drivers pad names with blanks, and some count the terminating zero. */
std::string trimmed(std::string text)
{
  const auto is_blank = [](char c) { return c == '\0' || c == ' ' || c == '\n' || c == '\t'; };
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  size_t first = 0;
  while (first < text.size() && is_blank(text[first])) ++first;
  return text.substr(first);
}

std::string type_name(cl_device_type type)
{
  if (type & CL_DEVICE_TYPE_GPU) return "GPU";
  if (type & CL_DEVICE_TYPE_ACCELERATOR) return "accelerator";
  return "CPU";
}

std::string why_unusable(const cl::Device &device)
{
  int major = 0, minor = 0;
  const std::string version = device.getInfo<CL_DEVICE_VERSION>();
  if (std::sscanf(version.c_str(), "OpenCL %d.%d", &major, &minor) != 2 || major * 10 + minor < 12)
    return fmt::format("it speaks '{}', and OpenCL 1.2 is needed", trimmed(version));
  if (!device.getInfo<CL_DEVICE_AVAILABLE>()) return "it is not available";
  if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) return "it has no compiler";
  if (!device.getInfo<CL_DEVICE_ENDIAN_LITTLE>()) return "it is big-endian";
  const cl_ulong local_bytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
  if (local_bytes < LOCAL_WORDS * sizeof(cl_uint))
    return fmt::format("it has {} bytes of local memory, and {} are needed", local_bytes,
                       LOCAL_WORDS * sizeof(cl_uint));
  return {};
}

std::string what_it_lacks(cl_device_fp_config config)
{
  std::vector<std::string> missing;
  if (!(config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT)) missing.push_back("correctly rounded division and square root");
  if (!(config & CL_FP_DENORM)) missing.push_back("denormals");
  if (!(config & CL_FP_ROUND_TO_NEAREST)) missing.push_back("rounding to nearest");
  return fmt::format("{}", fmt::join(missing, ", "));
}

Candidate describe(const cl::Platform &platform, const cl::Device &device, uint32_t platform_index,
                   uint32_t device_index)
{
  Candidate candidate;
  candidate.device = device;
  DeviceInfo &info = candidate.info;
  info.platform = platform_index;
  info.device = device_index;
  info.platform_name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
  info.platform_version = trimmed(platform.getInfo<CL_PLATFORM_VERSION>());
  info.device_name = trimmed(device.getInfo<CL_DEVICE_NAME>());
  info.driver_version = trimmed(device.getInfo<CL_DRIVER_VERSION>());
  info.type = type_name(device.getInfo<CL_DEVICE_TYPE>());
  const cl_device_fp_config config = device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
  candidate.promises_exact_division = config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
  candidate.lacks = what_it_lacks(config);
  candidate.unusable = why_unusable(device);
  return candidate;
}

[[noreturn]] void fail_to_open(const DeviceInfo &info, const cl::Error &error)
{
  throw DeviceError(fmt::format("OpenCL device {} ({}) does not open: {} failed with {}", info.device_name,
                                info.platform_name, error.what(), error_name(error.err())));
}

/* Threads that a driver starts here inherit the floating-point environment, so it is set first. */
std::vector<Candidate> ask_drivers()
{
  const minicl::ExactFloatingPoint environment;
  cl_uint platform_count = 0;
  if (clGetPlatformIDs(0, nullptr, &platform_count) != CL_SUCCESS || platform_count == 0) return {};
  std::vector<cl_platform_id> platforms(platform_count);
  clGetPlatformIDs(platform_count, platforms.data(), nullptr);
  std::vector<Candidate> candidates;
  for (uint32_t p = 0; p < platform_count; ++p) {
    cl_uint device_count = 0;
    if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, 0, nullptr, &device_count) != CL_SUCCESS) continue;
    std::vector<cl_device_id> devices(device_count);
    if (device_count) clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, device_count, devices.data(), nullptr);
    for (uint32_t d = 0; d < device_count; ++d)
      candidates.push_back(describe(cl::Platform(platforms[p]), cl::Device(devices[d], true), p, d));
  }
  return candidates;
}

/* Runs in a child process (probe.h). */
void ask_and_tell()
{
  cl_uint platforms = 0;
  if (!ask_drivers().empty() || (clGetPlatformIDs(0, nullptr, &platforms) == CL_SUCCESS && platforms > 0)) return;
  const std::string why = why_drivers_do_not_load();
  if (!why.empty()) throw DriverFault(fmt::format("no installed OpenCL driver can be used; {}", why));
}

} // namespace

std::vector<Candidate> find_candidates()
{
  static const std::string fault = driver_fault(ask_and_tell);
  if (!fault.empty()) throw DeviceError(fault);
  return ask_drivers();
}

void DeviceContext::open_queue(cl_command_queue_properties properties)
{
  try {
    fail_where_a_test_wants(faults::Site::allocation, "clCreateCommandQueue");
    queue = cl::CommandQueue(context, device, properties);
  } catch (const cl::Error &error) {
    fail_to_open(info, error);
  }
}

namespace {

void require_branches(const DeviceInfo &info, cl_int code)
{
  if (code != CL_SUCCESS)
    throw DeviceError(fmt::format("OpenCL device {} ({}): launching side by side failed: {}", info.device_name,
                                  info.platform_name, error_name(code)));
}

} // namespace

cl_command_queue DeviceContext::in_order() const
{
  if (branches_.are_open()) require_branches(info, branches_.join(queue()));
  return queue();
}

cl_command_queue DeviceContext::branch(uint32_t number) const
{
  cl_command_queue opened = nullptr;
  require_branches(info, branches_.open(queue(), number, opened));
  return opened;
}

DeviceContext::DeviceContext(const Candidate &candidate) : info(candidate.info), device(candidate.device)
{
  const minicl::ExactFloatingPoint environment;
  try {
    fail_where_a_test_wants(faults::Site::allocation, "clCreateContext");
    context = candidate.context() ? candidate.context : cl::Context(device);
  } catch (const cl::Error &error) {
    fail_to_open(info, error);
  }
  open_queue(0);
  if (candidate.promises_exact_division) options += " -cl-fp32-correctly-rounded-divide-sqrt";
  /* Oclgrind 21.10 fails on an optimiser hint that Clang leaves in inlined code. */
  if (info.platform_name == "Oclgrind") options += " -cl-opt-disable";
}

} // namespace tandem::opencl
