/* storage.cpp - buffers in host memory; see storage.h. */
#include "host/runtime/interface/storage.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

#include <sys/mman.h>

#include "host/runtime/interface/address_sanitizer.h"
#include "host/runtime/interface/faults.h"

namespace tandem {
namespace {

/* With a million bodies, searches read scattered locations in tens of megabytes; with small pages most of their time
 * goes to address translation. */
constexpr size_t small_page = 4096, huge_page = size_t{2} << 20;

class HostStorage : public Storage {
public:
  const char *what() const override { return "the host's memory"; }
  void *allocate(Element, size_t bytes, void *) override
  {
    if (faults::strikes(faults::Site::allocation) || bytes > SIZE_MAX - huge_page) throw std::bad_alloc();
    const size_t page = bytes < 2 * huge_page ? small_page : huge_page;
    const size_t rounded = (std::max<size_t>(bytes, 1) + page - 1) / page * page;
    void *memory = std::aligned_alloc(page, rounded);
    if (!memory) throw std::bad_alloc();
    if (page == huge_page) madvise(memory, rounded, MADV_HUGEPAGE); /* advice; ignoring it costs only time */
    std::memset(memory, 0, rounded);
    forbid_access(memory, bytes, rounded);
    return memory;
  }
  void release(void *handle) noexcept override { std::free(handle); }
  void write(void *handle, size_t offset, const void *from, size_t bytes) override
  {
    std::memcpy(static_cast<char *>(handle) + offset, from, bytes);
  }
  void read(void *handle, size_t offset, void *to, size_t bytes) override
  {
    std::memcpy(to, static_cast<const char *>(handle) + offset, bytes);
  }
  void copy(void *from, void *to, size_t bytes) override { std::memcpy(to, from, bytes); }
};

} // namespace

Storage &host_storage()
{
  static HostStorage storage;
  return storage;
}

/* The floats are read into the second half of the result and widened from there, so that nothing is allocated: the
 * i-th double ends where the i-th float does, or before. */
void Storage::read_reals(void *handle, size_t first, double *to, size_t count)
{
  const size_t bytes = count * sizeof(float);
  char *const floats = reinterpret_cast<char *>(to) + bytes;
  read(handle, first * sizeof(float), floats, bytes);
  for (size_t i = 0; i < count; ++i) {
    float value;
    std::memcpy(&value, floats + i * sizeof value, sizeof value);
    to[i] = value;
  }
}

} // namespace tandem
