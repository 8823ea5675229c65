/* out_of_memory.h - what was wanted where memory ran out: a bare std::bad_alloc says nothing that anyone could act on.
 *
 * Memory names the buffer and its bytes, the world its bodies and pairs. Who catches std::runtime_error catches this.
 */
#pragma once

#include <new>
#include <stdexcept>

namespace tandem {

struct OutOfMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

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
