/* storage.h - the interface through which a backend offers memory for buffers. Memory (host/runtime/memory.h) moves
 * buffers between storages. */
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
  /* The new memory is zero-filled. If host_memory is given (the buffer's bytes on the host, for devices that share
   * them), those bytes are used. Sizes and offsets refer to the host's copy, whose numbers are floats, even if a
   * storage keeps wider ones. Throws std::bad_alloc or std::runtime_error if there is not enough memory. */
  virtual void *allocate(Element element, size_t bytes, void *host_memory) = 0;
  virtual void release(void *handle) noexcept = 0;
  virtual void write(void *handle, size_t offset, const void *from, size_t bytes) = 0;
  virtual void read(void *handle, size_t offset, void *to, size_t bytes) = 0; /* waits */
  /* Reads so many bytes from the start of each plane, one behind the other; a device waits once. */
  virtual void read_planes(void *handle, size_t plane_bytes, void *to, size_t bytes, size_t planes);
  /* Copies the first bytes from one buffer to another of the same elements; in a device without waiting. */
  virtual void copy(void *from, void *to, size_t bytes) = 0;
  /* Reads reals of a buffer of float4s or reals in the precision in which this storage keeps them. */
  virtual void read_reals(void *handle, size_t first, double *to, size_t count);
  /* So many reals from the start of each plane, one behind the other. */
  virtual void read_real_planes(void *handle, size_t plane_reals, double *to, size_t count, size_t planes);
  /* True if reals are doubles; only then may write_reals be called. */
  virtual bool keeps_doubles() const { return false; }
  virtual void write_reals(void *, size_t, const double *, size_t) {}
  /* True for a device that works in the host's own memory, where a move copies nothing. */
  virtual bool shares_host_memory() const { return false; }
  virtual void wait() {} /* until no work given so far reads or writes any buffer */
};

/* Host memory, 64-byte aligned. */
TANDEM_API Storage &host_storage();

} // namespace tandem
