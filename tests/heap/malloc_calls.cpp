/* malloc_calls.cpp - malloc and its kin of tandem_heap_tests, which count and hand over to those of the C library; see
 * malloc_calls.h. */
#include "tests/heap/malloc_calls.h"

#include <cerrno>
#include <cstddef>

extern "C" {
void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t count, size_t bytes);
void *__libc_realloc(void *memory, size_t bytes);
void *__libc_memalign(size_t alignment, size_t bytes);
}

namespace tests::heap {
namespace {

constinit thread_local bool counting = false;
constinit thread_local uint64_t calls = 0;

} // namespace

uint64_t malloc_calls(const std::function<void()> &work)
{
  calls = 0;
  counting = true;
  try {
    work();
  } catch (...) {
    counting = false;
    throw;
  }
  counting = false;
  return calls;
}

} // namespace tests::heap

using namespace tests::heap;

extern "C" {

void *malloc(size_t bytes)
{
  calls += counting;
  return __libc_malloc(bytes);
}

void *calloc(size_t count, size_t bytes)
{
  calls += counting;
  return __libc_calloc(count, bytes);
}

void *realloc(void *memory, size_t bytes)
{
  calls += counting;
  return __libc_realloc(memory, bytes);
}

void *memalign(size_t alignment, size_t bytes)
{
  calls += counting;
  return __libc_memalign(alignment, bytes);
}

void *aligned_alloc(size_t alignment, size_t bytes) { return memalign(alignment, bytes); }

int posix_memalign(void **memory, size_t alignment, size_t bytes)
{
  *memory = memalign(alignment, bytes);
  return *memory ? 0 : ENOMEM;
}
}
