/* storage.h - a place that holds buffers, as a backend offers it: host memory, or that of a device. */
#pragma once

#include <cstddef>

#include <tandem/export.h>

#include "host/runtime/interface/kernel_list.h"

namespace tandem {

/* One place that holds buffers: host memory, or an OpenCL device. Handles are opaque to others. */
class Storage {
public:
  virtual ~Storage() = default;
  virtual const char *what() const = 0; /* for messages: "the host's memory" */
  /* Zero-filled; with host_memory (the buffer's bytes on the host, for devices that share them) those bytes. Sizes and
   * offsets are those of the host's copy, whose numbers are floats, also where a storage keeps wider ones.
   * std::bad_alloc or std::runtime_error where there is no room. */
  virtual void *allocate(Element element, size_t bytes, void *host_memory) = 0;
  virtual void release(void *handle) noexcept = 0;
  virtual void write(void *handle, size_t offset, const void *from, size_t bytes) = 0;
  virtual void read(void *handle, size_t offset, void *to, size_t bytes) = 0; /* waits */
  /* Reals of a buffer of rows or reals, as precise as this storage keeps them. */
  virtual void read_reals(void *handle, size_t first, double *to, size_t count);
  /* True where reals are doubles; write_reals is for these alone. */
  virtual bool keeps_doubles() const { return false; }
  virtual void write_reals(void *, size_t, const double *, size_t) {}
  /* True for a device that works in the host's own memory: moves cost no copy. */
  virtual bool shares_host_memory() const { return false; }
  virtual void wait() {} /* until no work given so far reads or writes any buffer */
};

/* Host memory, 64-byte aligned. */
TANDEM_API Storage &host_storage();

} // namespace tandem
