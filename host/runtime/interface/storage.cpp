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
#include "host/runtime/interface/huge_page_pool.h"

namespace tandem {
namespace {

/* AddressSanitizer knows the ends of a buffer, and whether it is there still, by its allocation. */
#if defined(__SANITIZE_ADDRESS__)
constexpr bool pools_buffers = false;
#else
constexpr bool pools_buffers = true;
#endif

class HostStorage : public Storage {
public:
  const char *what() const override { return "the host's memory"; }
  void *allocate(Element, size_t bytes, void *) override
  {
    if (faults::strikes(faults::Site::allocation) || bytes > SIZE_MAX - huge_page) throw std::bad_alloc();
    if (pools_buffers && bytes >= HugePagePool::least && bytes < HugePagePool::most)
      return std::memset(pool_.allocate(bytes), 0, bytes);
    /* With a million bodies, searches read scattered locations in tens of megabytes; with small pages most of their
     * time goes to address translation. */
    const size_t page = bytes < HugePagePool::most ? small_page : huge_page;
    const size_t rounded = (std::max<size_t>(bytes, 1) + page - 1) / page * page;
    void *memory = std::aligned_alloc(page, rounded);
    if (!memory) throw std::bad_alloc();
    if (page == huge_page) madvise(memory, rounded, MADV_HUGEPAGE); /* advice; ignoring it costs only time */
    std::memset(memory, 0, rounded);
    forbid_access(memory, bytes, rounded);
    return memory;
  }
  void release(void *handle) noexcept override
  {
    if (!pools_buffers || !pool_.release(handle)) std::free(handle);
  }
  void write(void *handle, size_t offset, const void *from, size_t bytes) override
  {
    std::memcpy(static_cast<char *>(handle) + offset, from, bytes);
  }
  void read(void *handle, size_t offset, void *to, size_t bytes) override
  {
    std::memcpy(to, static_cast<const char *>(handle) + offset, bytes);
  }
  void copy(void *from, void *to, size_t bytes) override { std::memcpy(to, from, bytes); }

private:
  HugePagePool pool_;
};

} // namespace

Storage &host_storage()
{
  static HostStorage storage;
  return storage;
}

namespace {

/* Floats that were read to where the result begins are widened in place, so that nothing is allocated: from the last
 * on, because no double begins before the floats in front of its own end. (GCC 12 with -O1 leaves the same loop out if
 * it goes forward, over floats in the second half.) */
void widen(double *to, size_t count)
{
  const char *const floats = reinterpret_cast<const char *>(to);
  for (size_t i = count; i > 0; --i) {
    float value;
    std::memcpy(&value, floats + (i - 1) * sizeof value, sizeof value);
    to[i - 1] = value;
  }
}

} // namespace

void Storage::read_planes(void *handle, size_t plane_bytes, void *to, size_t bytes, size_t planes)
{
  for (size_t plane = 0; plane < planes; ++plane)
    read(handle, plane * plane_bytes, static_cast<char *>(to) + plane * bytes, bytes);
}

void Storage::read_reals(void *handle, size_t first, double *to, size_t count)
{
  read(handle, first * sizeof(float), to, count * sizeof(float));
  widen(to, count);
}

void Storage::read_real_planes(void *handle, size_t plane_reals, double *to, size_t count, size_t planes)
{
  read_planes(handle, plane_reals * sizeof(float), to, count * sizeof(float), planes);
  widen(to, planes * count);
}

} // namespace tandem
