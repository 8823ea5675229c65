/* reference_storage.cpp - widens floats when buffers are written and rounds doubles when they are read; see
 * reference_storage.h. */
#include "minicl/reference_storage.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <unordered_map>

#include "host/runtime/interface/address_sanitizer.h"
#include "host/runtime/interface/faults.h"
#include <tandem/round_to_float.h>

namespace tandem::minicl {
namespace {

/* The layout of one buffer in both precisions, in bytes of the host's copy: reals up to `reals_end`, then whole
 * numbers. */
struct Layout {
  size_t reals_end, bytes;
};

Layout layout_of(Element element, size_t bytes)
{
  switch (element) {
  case Element::float4:
  case Element::real: return {bytes, bytes};
  case Element::Parameters: return {reference_parameters.reals * sizeof(float), bytes};
  case Element::uint:
  case Element::ulong: return {0, bytes};
  }
  return {0, bytes};
}

size_t wide_bytes(const Layout &layout) { return layout.bytes + layout.reals_end; }

class ReferenceStorage : public Storage {
public:
  const char *what() const override { return "the host's memory, in double"; }
  void *allocate(Element element, size_t bytes, void *) override
  {
    if (faults::strikes(faults::Site::allocation)) throw std::bad_alloc();
    const Layout layout = layout_of(element, bytes);
    const size_t needed =
        element == Element::Parameters ? std::max(wide_bytes(layout), reference_parameters.bytes) : wide_bytes(layout);
    const size_t rounded = (std::max<size_t>(needed, 1) + 63) / 64 * 64;
    void *memory = std::aligned_alloc(64, rounded);
    if (!memory) throw std::bad_alloc();
    std::memset(memory, 0, rounded);
    forbid_access(memory, needed, rounded);
    const std::lock_guard<std::mutex> lock(mutex_);
    try {
      layouts_[memory] = layout;
    } catch (...) {
      std::free(memory);
      throw;
    }
    return memory;
  }

  void release(void *handle) noexcept override
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    layouts_.erase(handle);
    std::free(handle);
  }

  void write(void *handle, size_t offset, const void *from, size_t bytes) override
  {
    const Layout layout = layout_at(handle);
    const size_t reals = reals_in(layout, offset, bytes);
    for (size_t i = 0; i < reals; ++i) {
      float value;
      std::memcpy(&value, static_cast<const char *>(from) + i * sizeof value, sizeof value);
      static_cast<double *>(handle)[offset / sizeof value + i] = value;
    }
    const size_t done = reals * sizeof(float);
    std::memcpy(static_cast<char *>(handle) + layout.reals_end + offset + done, static_cast<const char *>(from) + done,
                bytes - done);
  }

  void read(void *handle, size_t offset, void *to, size_t bytes) override
  {
    const Layout layout = layout_at(handle);
    const size_t reals = reals_in(layout, offset, bytes);
    for (size_t i = 0; i < reals; ++i) {
      const float value = round_to_float(static_cast<const double *>(handle)[offset / sizeof(float) + i]);
      std::memcpy(static_cast<char *>(to) + i * sizeof value, &value, sizeof value);
    }
    const size_t done = reals * sizeof(float);
    std::memcpy(static_cast<char *>(to) + done, static_cast<const char *>(handle) + layout.reals_end + offset + done,
                bytes - done);
  }

  /* The buffers may differ in size: whole numbers follow the reals of each. */
  void copy(void *from, void *to, size_t bytes) override
  {
    const Layout source = layout_at(from), target = layout_at(to);
    const size_t reals = std::min(bytes, source.reals_end);
    std::memcpy(to, from, 2 * reals);
    std::memcpy(static_cast<char *>(to) + target.reals_end + reals,
                static_cast<const char *>(from) + source.reals_end + reals, bytes - reals);
  }

  void read_reals(void *handle, size_t first, double *to, size_t count) override
  {
    std::copy_n(static_cast<const double *>(handle) + first, count, to);
  }

  void read_real_planes(void *handle, size_t plane_reals, double *to, size_t count, size_t planes) override
  {
    for (size_t plane = 0; plane < planes; ++plane) read_reals(handle, plane * plane_reals, to + plane * count, count);
  }

  bool keeps_doubles() const override { return true; }
  void write_reals(void *handle, size_t first, const double *from, size_t count) override
  {
    std::copy_n(from, count, static_cast<double *>(handle) + first);
  }

private:
  Layout layout_at(void *handle)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return layouts_.at(handle);
  }

  static size_t reals_in(const Layout &layout, size_t offset, size_t bytes)
  {
    return offset >= layout.reals_end ? 0 : std::min(bytes, layout.reals_end - offset) / sizeof(float);
  }

  std::mutex mutex_;
  std::unordered_map<void *, Layout> layouts_;
};

} // namespace

Storage &reference_storage()
{
  static ReferenceStorage storage;
  return storage;
}

} // namespace tandem::minicl
