/* debug.h - where the simulation is, for debuggers.
 *
 * `tandem diff` prints a gdb line that stops in one item of one kernel of one step; its condition reads
 * this variable, which World::step sets. Volatile, so that the compiler keeps every write.
 */
#pragma once

#include <cstdint>

namespace tandem {

extern volatile uint64_t current_step; /* steps committed before the one that runs: 0 in the first */

} // namespace tandem
