/* installed_drivers.cpp - reads the folder of installed drivers as the OpenCL loaders do, and tries to load each; see
 * installed_drivers.h. */
#include "host/runtime/opencl/installed_drivers.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>

namespace tandem::opencl {
namespace {

namespace files = std::filesystem;

/* The folder of drivers, or one file in it, found as the OpenCL loaders find it. */
files::path where_drivers_are_named()
{
  for (const char *variable : {"OCL_ICD_VENDORS", "OPENCL_VENDOR_PATH"})
    if (const char *given = std::getenv(variable)) return given;
  return "/etc/OpenCL/vendors";
}

/* The names are sorted, so that the same driver is reported each time. */
std::vector<files::path> names_of_drivers(const files::path &place, std::error_code &error)
{
  std::vector<files::path> names;
  if (place.extension() == ".icd") names.push_back(place);
  else
    for (files::directory_iterator each(place, error), end; !error && each != end; each.increment(error))
      if (each->path().extension() == ".icd") names.push_back(each->path());
  std::sort(names.begin(), names.end());
  return names;
}

/* Empty if the driver loads. It stays loaded, because some drivers crash when they are unloaded. */
std::string why_it_does_not_load(const files::path &name)
{
  std::ifstream file(name);
  std::string library;
  errno = 0;
  if (!std::getline(file, library))
    return fmt::format("{}: cannot read: {}", name.string(), std::strerror(errno ? errno : EIO));
  if (::dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL)) return {};
  const char *why = ::dlerror();
  return fmt::format("{}: {}", name.string(), why ? why : library);
}

} // namespace

std::string why_drivers_do_not_load()
{
  std::error_code error;
  const files::path place = where_drivers_are_named();
  const std::vector<files::path> names = names_of_drivers(place, error);
  if (error && error != std::errc::no_such_file_or_directory)
    return fmt::format("{}: cannot read: {}", place.string(), error.message());
  for (const files::path &name : names)
    if (const std::string why = why_it_does_not_load(name); !why.empty()) return why;
  return {};
}

} // namespace tandem::opencl
