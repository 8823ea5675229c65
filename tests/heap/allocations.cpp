/* allocations.cpp - the operators new and delete of tandem_heap_tests; see allocations.h.
 *
 * Only a program of its own has these operators, because all other tests should use those of the library or of a
 * sanitizer. They call malloc and free, which the sanitizers still watch. The sanitizers only lose the check that each
 * new has its own kind of delete. */
#include "tests/heap/allocations.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace tests::heap {
namespace {

std::atomic<bool> armed{false}, only_once{true}, has_struck{false}, has_struck_another{false};
thread_local bool is_caller = false;
std::atomic<uint64_t> which{0}, calls{0};
std::atomic<int64_t> blocks{0};

bool strikes()
{
  if (!armed.load(std::memory_order_relaxed)) return false;
  const uint64_t number = calls++;
  if (only_once ? number != which : number < which) return false;
  has_struck = true;
  if (!is_caller) has_struck_another = true;
  return true;
}

void *counted(void *memory)
{
  if (memory) blocks.fetch_add(1, std::memory_order_relaxed);
  return memory;
}

void *take(size_t bytes) noexcept { return strikes() ? nullptr : counted(std::malloc(std::max<size_t>(bytes, 1))); }

void *take(size_t bytes, std::align_val_t alignment) noexcept
{
  const size_t unit = static_cast<size_t>(alignment);
  return strikes() ? nullptr : counted(std::aligned_alloc(unit, (std::max<size_t>(bytes, 1) + unit - 1) / unit * unit));
}

void *or_throw(void *memory)
{
  if (!memory) throw std::bad_alloc();
  return memory;
}

void give_back(void *memory) noexcept
{
  if (memory) blocks.fetch_sub(1, std::memory_order_relaxed);
  std::free(memory);
}

} // namespace

Failing::Failing(uint64_t nth, bool once)
{
  which = nth;
  only_once = once;
  calls = 0;
  has_struck = has_struck_another = false;
  is_caller = true;
  armed = true;
}
Failing::~Failing() { armed = is_caller = false; }

bool struck() { return has_struck; }
bool struck_another_thread() { return has_struck_another; }
uint64_t asked() { return calls; }
int64_t held() { return blocks; }

} // namespace tests::heap

using namespace tests::heap;

/* Each form, as a sanitizer's would not come here by way of the plain one. */
void *operator new(size_t bytes) { return or_throw(take(bytes)); }
void *operator new[](size_t bytes) { return or_throw(take(bytes)); }
void *operator new(size_t bytes, std::align_val_t alignment) { return or_throw(take(bytes, alignment)); }
void *operator new[](size_t bytes, std::align_val_t alignment) { return or_throw(take(bytes, alignment)); }
void *operator new(size_t bytes, const std::nothrow_t &) noexcept { return take(bytes); }
void *operator new[](size_t bytes, const std::nothrow_t &) noexcept { return take(bytes); }
void *operator new(size_t bytes, std::align_val_t alignment, const std::nothrow_t &) noexcept
{
  return take(bytes, alignment);
}
void *operator new[](size_t bytes, std::align_val_t alignment, const std::nothrow_t &) noexcept
{
  return take(bytes, alignment);
}
void operator delete(void *memory) noexcept { give_back(memory); }
void operator delete[](void *memory) noexcept { give_back(memory); }
void operator delete(void *memory, size_t) noexcept { give_back(memory); }
void operator delete[](void *memory, size_t) noexcept { give_back(memory); }
void operator delete(void *memory, std::align_val_t) noexcept { give_back(memory); }
void operator delete[](void *memory, std::align_val_t) noexcept { give_back(memory); }
void operator delete(void *memory, size_t, std::align_val_t) noexcept { give_back(memory); }
void operator delete[](void *memory, size_t, std::align_val_t) noexcept { give_back(memory); }
void operator delete(void *memory, const std::nothrow_t &) noexcept { give_back(memory); }
void operator delete[](void *memory, const std::nothrow_t &) noexcept { give_back(memory); }
void operator delete(void *memory, std::align_val_t, const std::nothrow_t &) noexcept { give_back(memory); }
void operator delete[](void *memory, std::align_val_t, const std::nothrow_t &) noexcept { give_back(memory); }
