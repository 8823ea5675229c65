/* malloc_calls.h - counts what C code, and libraries like Eigen that go past operator new, take from malloc.
 *
 * Only the GNU C library can be asked so. Sanitizers have a malloc of their own, and their trees have no test of this.
 */
#pragma once

#include <cstdint>
#include <functional>

namespace tests::heap {

/* The calls of malloc and its kin in `work`, by this thread alone. */
uint64_t malloc_calls(const std::function<void()> &work);

} // namespace tests::heap
