/* storage.h - buffers of one device.
 *
 * A device that works in host memory is given the host's own bytes (CL_MEM_USE_HOST_PTR); then a move is a map
 * and an unmap, which cost nothing but order. Whether a driver really shares is tried out, not believed.
 */
#pragma once

#include "host/runtime/interface/storage.h"
#include "host/runtime/opencl/context.h"

namespace tandem::opencl {

/* What a handle of this storage points to. */
struct DeviceBuffer {
  cl_mem memory = nullptr;
  size_t bytes = 0;
  char *shared_with = nullptr; /* the host's bytes, if shared */
  uint64_t serial = 0;         /* never used twice, unlike addresses */
};

class DeviceStorage : public Storage {
public:
  explicit DeviceStorage(const DeviceContext &context);

  const char *what() const override { return context_.info.device_name.c_str(); }
  void *allocate(Element element, size_t bytes, void *host_memory) override;
  void release(void *handle) noexcept override;
  void write(void *handle, size_t offset, const void *from, size_t bytes) override;
  void read(void *handle, size_t offset, void *to, size_t bytes) override;
  void wait() override;
  bool shares_host_memory() const override { return shares_; }

private:
  void pass_ownership(const DeviceBuffer &buffer, size_t offset, size_t bytes, cl_map_flags flags);

  const DeviceContext &context_;
  bool shares_;
  uint64_t next_serial_ = 1;
};

} // namespace tandem::opencl
