/* out_of_memory.h - turns a bare std::bad_alloc into an OutOfMemory that names what was requested. */
#pragma once

#include <new>

#include <tandem/error.h>

namespace tandem {

/* Returns work(). If memory runs out, the OutOfMemory carries the text that describe() returns. */
template <class Describe, class Work> auto naming_what_failed(Describe describe, Work work) -> decltype(work())
{
  try {
    return work();
  } catch (const std::bad_alloc &) {
    throw OutOfMemory(describe());
  }
}

} // namespace tandem
