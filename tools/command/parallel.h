/* parallel.h - a bounded number of independent tasks at once, for commands that step many worlds.
 *
 * Threads of their own, not tasks of TBB: a thread that waits in World::step may take up any task of its arena, and
 * would nest one world's step in another's.
 */
#pragma once

#include <cstddef>
#include <functional>

namespace tandem {

/* Calls task(0) .. task(count - 1), begun in this order, at most `threads` (1 or more) at a time; with 1 on the calling
 * thread. Of what tasks throw, that of the smallest index is thrown on when all that began have ended; none begins
 * after a throw. */
void in_parallel(size_t count, size_t threads, const std::function<void(size_t)> &task);

/* As many as the machine runs at once. */
size_t processor_count();

} // namespace tandem
