/* allocations.h - the heap of tandem_heap_tests: which call of operator new fails, and what was taken and not given
 * back.
 *
 * All operators new and delete of that program are replaced, so this is what the library, the libraries that it uses
 * and the threads of TBB allocate by C++. Buffers do not come from here (host/runtime/interface/faults.h lets those
 * fail), nor what C code takes from malloc.
 */
#pragma once

#include <cstdint>

namespace tests::heap {

/* For the length of its life the n-th call fails, counted from 0 over all threads; `once`: that one alone, else all
 * from there on. */
class Failing {
public:
  explicit Failing(uint64_t nth, bool once = true);
  ~Failing();
  Failing(const Failing &) = delete;
  Failing &operator=(const Failing &) = delete;
};

/* Of the last Failing: */
bool struck();
bool struck_another_thread(); /* than the one that made it */
uint64_t asked();             /* calls */

int64_t held(); /* blocks taken and not given back, by all threads */

} // namespace tests::heap
