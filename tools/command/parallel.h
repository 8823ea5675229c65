/* parallel.h - runs a bounded number of independent tasks at once, for commands that step many worlds.
 *
 * It uses threads of its own and not tasks of TBB, because a thread that waits in World::step may execute any task of
 * its arena, which would nest one world's step in another's.
 */
#pragma once

#include <cstddef>
#include <functional>

namespace tandem {

/* Calls task(0) .. task(count - 1), begun in this order, at most `threads` (1 or more) at a time; with 1 on the calling
 * thread. If tasks throw, no further task begins, and the exception of the smallest index is rethrown when all that
 * began have ended. */
void in_parallel(size_t count, size_t threads, const std::function<void(size_t)> &task);

/* The number of threads that the machine runs at once. */
size_t processor_count();

} // namespace tandem
