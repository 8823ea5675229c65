/* device.cpp - lists devices, and selects the one that a text names; see device.h. */
#include "host/runtime/opencl/device.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/error.h>

#include "host/runtime/opencl/context.h"
#include "host/runtime/opencl/device_backend.h"

namespace tandem::opencl {
namespace {

std::string lower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string address(const DeviceInfo &info) { return fmt::format("{}.{}", info.platform, info.device); }

std::string title(const DeviceInfo &info)
{
  return fmt::format("{} {} ({})", address(info), info.device_name, info.platform_name);
}

/* The reason why the device may not be used, or empty. */
std::string refusal(Candidate &candidate)
{
  if (!candidate.unusable.empty()) return candidate.unusable;
  const std::string difference = self_test(candidate);
  if (difference.empty() || candidate.lacks.empty()) return difference;
  return fmt::format("{}; its driver does not promise {}", difference, candidate.lacks);
}

bool matches(const DeviceInfo &info, const std::string &choice)
{
  if (choice.empty() || choice == address(info)) return true;
  if (choice.find_first_not_of("0123456789.") == std::string::npos) return false;
  const std::string wanted = lower(choice);
  const std::string alias = wanted == "pocl" ? "portable computing language" : wanted;
  return lower(info.platform_name).find(alias) != std::string::npos ||
         lower(info.device_name).find(wanted) != std::string::npos || lower(info.type) == wanted;
}

/* Without a choice by the user, a GPU comes first, and among equals a device whose driver promises all that is
 * needed. */
void put_best_first(std::vector<Candidate> &candidates)
{
  const auto rank = [](const Candidate &candidate) {
    const int type = candidate.info.type == "GPU" ? 0 : candidate.info.type == "accelerator" ? 1 : 2;
    return 2 * type + (candidate.lacks.empty() ? 0 : 1);
  };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const Candidate &a, const Candidate &b) { return rank(a) < rank(b); });
}

[[noreturn]] void refuse_unknown(const std::string &text, const std::string &choice,
                                 const std::vector<Candidate> &candidates)
{
  cl_uint platforms = 0;
  if (clGetPlatformIDs(0, nullptr, &platforms) != CL_SUCCESS || platforms == 0)
    throw InputError(fmt::format("backend '{}': no OpenCL platform is installed: install a driver, such as the package "
                                 "pocl-opencl-icd, or use tbb",
                                 text));
  if (candidates.empty())
    throw InputError(
        fmt::format("backend '{}': the {} installed OpenCL platform(s) have no device; use tbb", text, platforms));
  std::vector<std::string> titles;
  for (const Candidate &candidate : candidates) titles.push_back(title(candidate.info));
  throw InputError(
      fmt::format("backend '{}': no OpenCL device is '{}'; there is {}", text, choice, fmt::join(titles, ", ")));
}

std::vector<Candidate> candidates_for(const std::string &text)
{
  try {
    return find_candidates();
  } catch (const DeviceError &error) {
    throw InputError(fmt::format("backend '{}': {}", text, error.what()));
  }
}

Candidate choose_device(const std::string &text, const std::string &choice, bool allow_inexact)
{
  const std::vector<Candidate> all = candidates_for(text);
  std::vector<Candidate> matching;
  std::copy_if(all.begin(), all.end(), std::back_inserter(matching),
               [&](const Candidate &candidate) { return matches(candidate.info, choice); });
  if (matching.empty()) refuse_unknown(text, choice, all);
  if (choice.empty()) put_best_first(matching);
  for (Candidate &candidate : matching)
    if (refusal(candidate).empty()) return candidate;
  if (allow_inexact)
    for (const Candidate &candidate : matching)
      if (candidate.unusable.empty()) return candidate;
  throw InputError(fmt::format("backend '{}': device {} cannot give the same bits as the others: {}{}", text,
                               title(matching.front().info), refusal(matching.front()),
                               matching.front().unusable.empty() ? " (--inexact uses it all the same)" : ""));
}

} // namespace

std::vector<DeviceInfo> list_devices()
{
  std::vector<DeviceInfo> devices;
  for (Candidate candidate : find_candidates()) {
    DeviceInfo info = candidate.info;
    info.reason = refusal(candidate);
    info.supported = info.reason.empty();
    if (info.supported && !candidate.lacks.empty())
      info.reason = fmt::format("its driver does not promise {}, its self-test shows them", candidate.lacks);
    devices.push_back(info);
  }
  return devices;
}

std::unique_ptr<Backend> make_backend(const std::string &text, const std::string &choice, bool allow_inexact)
{
  return make_device_backend(text, choose_device(text, choice, allow_inexact));
}

} // namespace tandem::opencl
