/* debug.h - the number of the step being simulated, for debuggers.
 *
 * `tandem diff` prints a gdb line that stops in one item of one kernel of one step; its condition reads this variable.
 * The launcher sets it in the thread that launches, and MiniCL in every thread that takes part, so that worlds which
 * step at the same time do not overwrite each other's. It is volatile so that the compiler keeps every write.
 */
#pragma once

#include <cstdint>

namespace tandem {

/* The number of steps that the world of this thread's launch has committed: 0 in its first step. */
extern constinit thread_local volatile uint64_t step_of_launch;

} // namespace tandem
