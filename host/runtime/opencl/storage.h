/* storage.h - buffers of one device.
 *
 * A device that works in host memory gets the host's own bytes (CL_MEM_USE_HOST_PTR); a move is then a map and an
 * unmap, which only order accesses. Whether a driver really shares memory is tested, whatever it reports.
 */
#pragma once

#include "host/runtime/interface/storage.h"
#include "host/runtime/opencl/context.h"

namespace tandem::opencl {

/* The object that a handle of this storage points to. */
struct DeviceBuffer {
  cl_mem memory = nullptr;
  size_t bytes = 0;
  char *shared_with = nullptr; /* the host's bytes, if shared */
  uint64_t serial = 0;         /* unique, unlike an address */
};

class DeviceStorage : public Storage {
public:
  explicit DeviceStorage(const DeviceContext &context);

  const char *what() const override { return context_.info.device_name.c_str(); }
  void *allocate(Element element, size_t bytes, void *host_memory) override;
  void release(void *handle) noexcept override;
  void write(void *handle, size_t offset, const void *from, size_t bytes) override;
  void read(void *handle, size_t offset, void *to, size_t bytes) override;
  void read_planes(void *handle, size_t plane_bytes, void *to, size_t bytes, size_t planes) override;
  void copy(void *from, void *to, size_t bytes) override;
  void wait() override;
  /* Whether copies or fills were begun since the last wait. */
  bool is_busy() const { return is_busy_; }
  bool shares_host_memory() const override { return shares_; }

private:
  void pass_ownership(const DeviceBuffer &buffer, size_t offset, size_t bytes, cl_map_flags flags);

  const DeviceContext &context_;
  bool shares_, is_busy_ = false;
  uint64_t next_serial_ = 1;
};

} // namespace tandem::opencl
