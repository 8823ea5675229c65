/* out_of_memory.h - a bare std::bad_alloc becomes an OutOfMemory that says what was wanted. */
#pragma once

#include <new>

#include <tandem/error.h>

namespace tandem {

/* work(), where running out of memory is told in the words that describe() finds. */
template <class Describe, class Work> auto naming_what_failed(Describe describe, Work work) -> decltype(work())
{
  try {
    return work();
  } catch (const std::bad_alloc &) {
    throw OutOfMemory(describe());
  }
}

} // namespace tandem
