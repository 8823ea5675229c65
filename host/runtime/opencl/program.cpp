/* program.cpp - builds programs, from source or from the cache of binaries.
 *
 * The embedded text keeps #line directives, so that a compiler's log names the file and line that people edit. */
#include "host/runtime/opencl/program.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host/runtime/interface/module.h"
#include "host/runtime/opencl/program_cache.h"

namespace tandem::opencl {
namespace {

/* Programs that name no language are in OpenCL C 1.2, which every device knows. */
std::string all_options(const DeviceContext &context, const std::string &options)
{
  const bool names_language = options.find("-cl-std=") != options.npos;
  return fmt::format("{}{} {}", names_language ? "" : "-cl-std=CL1.2", context.options, options);
}

/* A binary that its driver no longer accepts is not an error, because the program can be built from source. */
std::optional<cl::Program> build_cached(const DeviceContext &context, const std::string &key,
                                        const std::string &options)
{
  const std::optional<Binary> binary = load_binary(key);
  if (!binary) return std::nullopt;
  try {
    fail_where_a_test_wants(faults::Site::build, "clCreateProgramWithBinary");
    cl::Program program(context.context, {context.device}, cl::Program::Binaries{*binary});
    program.build({context.device}, options.c_str());
    return program;
  } catch (const cl::Error &) {
    return std::nullopt;
  }
}

cl::Program build_from_source(const DeviceContext &context, const EmbeddedProgram &embedded, const std::string &options)
{
  fail_where_a_test_wants(faults::Site::build, "clCreateProgramWithSource");
  cl::Program program(context.context, source_of(embedded));
  const cl_device_id device = context.device();
  const cl_int result = code_of(
      faults::Site::build, [&] { return clBuildProgram(program(), 1, &device, options.c_str(), nullptr, nullptr); });
  if (result == CL_SUCCESS) return program;
  std::string log;
  try {
    log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(context.device);
  } catch (const cl::Error &) { /* the driver keeps no log */
  }
  throw BuildError(fmt::format("cl/{}.cl does not build on the OpenCL device {} with '{}': {}{}{}", embedded.name,
                               context.info.device_name, options, error_name(result), log.empty() ? "" : "\n", log));
}

/* The NAME of each HAS_FEATURE(parameters, NAME) and MAY_OCCUR(NAME) in the source. */
std::set<std::string_view> names_tested(std::string_view source)
{
  std::set<std::string_view> names;
  for (const std::string_view test : {"HAS_FEATURE(", "MAY_OCCUR("})
    for (size_t at = source.find(test); at != source.npos; at = source.find(test, at + 1)) {
      const size_t open = at + test.size(), end = source.find(')', open);
      const std::string_view arguments = source.substr(open, end - open);
      names.insert(arguments.substr(arguments.find_last_of(" ,") + 1)); /* npos + 1 is 0: the first argument */
    }
  return names;
}

Binary binary_of(const cl::Program &program)
{
  size_t bytes = 0;
  if (clGetProgramInfo(program(), CL_PROGRAM_BINARY_SIZES, sizeof bytes, &bytes, nullptr) != CL_SUCCESS) return {};
  Binary binary(bytes);
  unsigned char *place = binary.data();
  if (bytes == 0 || clGetProgramInfo(program(), CL_PROGRAM_BINARIES, sizeof place, &place, nullptr) != CL_SUCCESS)
    return {};
  return binary;
}

} // namespace

const EmbeddedProgram &embedded_program(const std::string &name)
{
  for (const EmbeddedProgram &program : embedded_programs())
    if (name == program.name) return program;
  for (size_t i = 0; i < module_count(); ++i)
    for (const EmbeddedProgram &program : module_at(i).programs())
      if (name == program.name) return program;
  throw std::logic_error(fmt::format("cl/{}.cl is not embedded", name));
}

EmbeddedProgram with_entries_of(const EmbeddedProgram &program, const std::vector<Kernel> &kernels)
{
  EmbeddedProgram part = program;
  std::erase_if(part.entries, [&](const EmbeddedEntry &entry) {
    return std::none_of(kernels.begin(), kernels.end(),
                        [&](Kernel kernel) { return std::strcmp(row_of(kernel).name, entry.kernel) == 0; });
  });
  return part;
}

std::string headers_of(const EmbeddedProgram &program)
{
  std::string headers;
  for (const char *piece : program.headers) headers += piece;
  return headers;
}

std::string source_of(const EmbeddedProgram &program)
{
  std::string source = headers_of(program);
  for (const EmbeddedEntry &entry : program.entries) source += entry.source;
  return source;
}

Features features_read(const EmbeddedProgram &program)
{
  static const std::pair<std::string_view, Features> rows[] = {
#define FEATURE(name, what) {#name, FEATURE_##name},
#include "shared/features.def"
#undef FEATURE
  };
  const std::string headers = headers_of(program);
  const std::set<std::string_view> names = names_tested(headers);
  Features features = 0;
  for (const auto &[name, bit] : rows)
    if (names.contains(name)) features |= bit;
  return features;
}

std::string cache_key(const DeviceContext &context, const EmbeddedProgram &program, const std::string &options)
{
  const DeviceInfo &info = context.info;
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{}", info.platform_name, info.platform_version, info.device_name,
                     info.driver_version, all_options(context, options), source_of(program));
}

/* PoCL caches what it compiles by itself, kernel by kernel as they are launched. If it is asked for a program's binary,
 * it first compiles all kernels for every group size: 47 s instead of 5 for a scene of balls and boxes. */
cl::Program build_program(const DeviceContext &context, const EmbeddedProgram &embedded, const std::string &options)
{
  if (is_pocl(context)) return build_from_source(context, embedded, all_options(context, options));
  return build_through_cache(context, embedded, options);
}

bool is_cached(const DeviceContext &context, const EmbeddedProgram &program, const std::string &options)
{
  return !is_pocl(context) && load_binary(cache_key(context, program, options)).has_value();
}

cl::Program build_through_cache(const DeviceContext &context, const EmbeddedProgram &embedded,
                                const std::string &options)
{
  const std::string all = all_options(context, options);
  const std::string key = cache_key(context, embedded, options);
  if (std::optional<cl::Program> cached = build_cached(context, key, all)) return *cached;
  const cl::Program program = build_from_source(context, embedded, all);
  store_binary(key, binary_of(program));
  return program;
}

} // namespace tandem::opencl
