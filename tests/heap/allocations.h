/* allocations.h - the heap of tandem_heap_tests: selects the call of operator new that fails, and counts the blocks
 * that are not released.
 *
 * All operators new and delete of that program are replaced, so this covers the C++ allocations of the library, of the
 * libraries that it uses and of TBB's threads. It covers neither buffers, which fail by
 * host/runtime/interface/faults.h, nor memory that C code takes from malloc.
 */
#pragma once

#include <cstdint>

namespace tests::heap {

/* While the object lives, the n-th call fails, counted from 0 over all threads. `once`: only that call fails; else all
 * later ones fail, too. */
class Failing {
public:
  explicit Failing(uint64_t nth, bool once = true);
  ~Failing();
  Failing(const Failing &) = delete;
  Failing &operator=(const Failing &) = delete;
};

/* The results of the last Failing: */
bool struck();
bool struck_another_thread(); /* other than the one that made the Failing */
uint64_t asked();             /* number of calls */

int64_t held(); /* blocks not released, of all threads */

} // namespace tests::heap
