/* dispatcher.h - MiniCL: runs the shared kernels on the CPU, in one thread or over TBB's.
 *
 * It follows the MiniCL of the 2009 talk, which compiled OpenCL kernels as regular C. Here work-groups, local memory
 * and barriers work too (phase loops, shared/platform.h), and lanes make it fast.
 */
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "host/runtime/interface/backend.h"

namespace tandem::minicl {

struct Options {
  uint32_t threads = 0; /* 0: all of the machine; 1: no TBB */
  uint32_t lanes = 0;   /* 0: the widest this processor runs; 1, 4, 8, 16; narrower ones help with what is left */
  Backend::Order order = Backend::Order::forward;
  bool reference = false; /* in double, one item at a time */
};

std::unique_ptr<Backend> make_backend(const std::string &name, const Options &options);

/* What Options::threads of 0 stands for. */
uint32_t threads_of_machine();

/* The number of threads that have run items of split launches so far, for tests that must know whether there were
 * several. It applies to backends of make_backend only. */
uint32_t threads_used(const Backend &backend);

} // namespace tandem::minicl
