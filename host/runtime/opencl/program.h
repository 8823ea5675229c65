/* program.h - builds a program from an embedded source; device_backend.cpp and the self-test use it. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/opencl/context.h"
#include "host/runtime/opencl/embedded_kernels.h"

namespace tandem::opencl {

/* The program of cl/NAME.cl, or of the module of this name; throws std::logic_error if none is embedded. */
const EmbeddedProgram &embedded_program(const std::string &name);

/* The same program with only the entries of these kernels. */
EmbeddedProgram with_entries_of(const EmbeddedProgram &program, const std::vector<Kernel> &kernels);

/* The text before the entries, and the whole text of a program. */
std::string headers_of(const EmbeddedProgram &program);
std::string source_of(const EmbeddedProgram &program);

/* Builds with the context's options and these, from the cache where that pays. BuildError contains the compiler's
 * log. */
cl::Program build_program(const DeviceContext &context, const EmbeddedProgram &program,
                          const std::string &options = "");

/* Whether build_program() would find the program in the cache. */
bool is_cached(const DeviceContext &context, const EmbeddedProgram &program, const std::string &options);

/* Builds through the cache on every platform. */
cl::Program build_through_cache(const DeviceContext &context, const EmbeddedProgram &program,
                                const std::string &options = "");

/* The FEATURE_ bits that a program tests. Builds whose features differ only in others are identical. */
Features features_read(const EmbeddedProgram &program);

/* The key of a built program in the cache. */
std::string cache_key(const DeviceContext &context, const EmbeddedProgram &program, const std::string &options);

} // namespace tandem::opencl
