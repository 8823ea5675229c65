/* worker_threads.h - limits the threads that TBB starts to those that the machine grants.
 *
 * TBB starts its workers from threads of its own, where a failure to start one ends the process. The number of threads
 * that can start is therefore determined when the first launch is split, and TBB is limited to it. Results do not
 * depend on the number.
 */
#pragma once

#include <cstddef>
#include <string>

namespace tandem::minicl {

/* More threads than processors if a backend asks for them, because results must not depend on the number, and tests
 * check that. */
void want_threads(size_t threads);

/* Must be called before work is handed to TBB. It returns the number of threads that there may be, including the
 * calling one. The first call after more threads were wanted takes some time. */
size_t settle_threads();

/* One line if fewer threads than wanted could be started; else empty. */
std::string thread_shortage();

/* The number of threads of `stack_bytes` that can be alive at once beside the present ones, each with memory for a heap
 * of its own; at most `wanted`. The threads are started, and have ended when this returns. */
size_t startable_threads(size_t wanted, size_t stack_bytes);

} // namespace tandem::minicl
