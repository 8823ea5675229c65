/* answers.h - how the functions of <tandem/world.h> call the implementation: a lack of memory becomes OutOfMemory with
 * what was asked for, reads wait for each other, and a recording gets what has succeeded. */
#pragma once

#include <memory>
#include <mutex>

#include <fmt/format.h>

#include "host/base/out_of_memory.h"
#include "host/world/call_log.h"

namespace tandem {

/* Runs a query of a world; if memory runs out, the message says what was requested and for how many bodies. */
template <class Work> auto answer(const char *what, size_t bodies, Work work)
{
  return naming_what_failed(
      [&] {
        return fmt::format("out of memory: {} of a world of {} bodies: its lists need more than there is", what,
                           bodies);
      },
      work);
}

/* The same for what only reads. Reads change what the host knows (they move buffers, and apply calls that wait), so one
 * waits for the other. */
template <class Implementation, class Work> auto answer_in_turn(Implementation &world, const char *what, Work work)
{
  const std::lock_guard guard(world.reading);
  return answer(what, world.slots.existing(), work);
}

/* Writes a call that has succeeded, if a recording is made. */
template <class... T> void note(const std::unique_ptr<CallLog> &log, RecordedCall call, const T &...fields)
{
  if (log) log->put(call, fields...);
}

} // namespace tandem
