/* program.h - from an embedded source to a built program. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/opencl/context.h"
#include "host/runtime/opencl/embedded_kernels.h"

namespace tandem::opencl {

/* The program of cl/NAME.cl, or of the module of this name; std::logic_error if none is embedded. */
const EmbeddedProgram &embedded_program(const std::string &name);

/* The same program without the entries of other kernels. */
EmbeddedProgram with_entries_of(const EmbeddedProgram &program, const std::vector<Kernel> &kernels);

/* Its whole text: headers and entries. */
std::string source_of(const EmbeddedProgram &program);

/* Built with the context's options and these, from the cache where that pays. BuildError carries the compiler's log. */
cl::Program build_program(const DeviceContext &context, const EmbeddedProgram &program,
                          const std::string &options = "");

/* The same, whatever the platform does with binaries. */
cl::Program build_through_cache(const DeviceContext &context, const EmbeddedProgram &program,
                                const std::string &options = "");

/* FEATURE_ bits that a program asks for: builds that differ in others alone are one. */
Features features_read(const EmbeddedProgram &program);

/* What names a built program in the cache. */
std::string cache_key(const DeviceContext &context, const EmbeddedProgram &program, const std::string &options);

} // namespace tandem::opencl
