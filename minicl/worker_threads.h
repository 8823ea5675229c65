/* worker_threads.h - how many threads TBB may start: no more than the machine grants.
 *
 * TBB starts its workers from threads of its own, where the failure of one to start ends the process. So it is found
 * out beforehand, when the first launch is split, how many can be started, and TBB is held to that. Results do not
 * depend on it.
 */
#pragma once

#include <cstddef>
#include <string>

namespace tandem::minicl {

/* More than one for each processor, when a backend asks for them: results must not depend on it, and tests look. */
void want_threads(size_t threads);

/* To be called before work is handed to TBB: costs something the first time after more threads were wanted. How many
 * there may be, with the one that calls. */
size_t settle_threads();

/* One line if fewer threads than wanted could be started, else empty. */
std::string thread_shortage();

/* How many threads of `stack_bytes` can be alive at once, beside those there are, each with room for a heap of its own;
 * at most `wanted`. They are started, and have ended when this returns. */
size_t startable_threads(size_t wanted, size_t stack_bytes);

} // namespace tandem::minicl
