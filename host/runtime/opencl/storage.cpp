/* storage.cpp - allocates and moves buffers of a device; see storage.h. */
#include "host/runtime/opencl/storage.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include <fmt/format.h>

namespace tandem::opencl {
namespace {

/* Fills work in whole words, and some drivers are faster with multiples of 16 bytes. */
size_t rounded(size_t bytes) { return std::max<size_t>((bytes + 15) / 16 * 16, 16); }

[[noreturn]] void fail(const DeviceContext &context, const char *what, size_t bytes, cl_int code)
{
  throw DeviceError(fmt::format("OpenCL device {} ({}): {} of {} bytes failed: {}", context.info.device_name,
                                context.info.platform_name, what, bytes, error_name(code)));
}

[[noreturn]] void fail_to_wait(const DeviceContext &context, cl_int code)
{
  throw DeviceError(fmt::format("OpenCL device {} ({}): waiting for its work failed: {}", context.info.device_name,
                                context.info.platform_name, error_name(code)));
}

void *map(const DeviceContext &context, cl_mem memory, size_t offset, size_t bytes, cl_map_flags flags)
{
  cl_int code = CL_SUCCESS;
  void *place = nullptr;
  if (faults::strikes(faults::Site::transfer)) code = CL_MAP_FAILURE;
  else
    place = clEnqueueMapBuffer(context.in_order(), memory, CL_TRUE, flags, offset, bytes, 0, nullptr, nullptr, &code);
  if (code != CL_SUCCESS) fail(context, "mapping", bytes, code);
  return place;
}

void unmap(const DeviceContext &context, cl_mem memory, void *place, size_t bytes)
{
  const cl_int code = code_of(faults::Site::transfer, [&] {
    return clEnqueueUnmapMemObject(context.in_order(), memory, place, 0, nullptr, nullptr);
  });
  if (code != CL_SUCCESS) fail(context, "unmapping", bytes, code);
}

/* Tests both directions through the same calls as the moves below: the device must see what the host writes after the
 * buffer was made, and the host what the device writes, in the same memory. */
bool sharing_works(const DeviceContext &context)
{
  constexpr size_t words = 2048, bytes = words * sizeof(cl_uint);
  alignas(4096) static thread_local cl_uint host[words];
  std::fill_n(host, words, 1u);
  const cl::Buffer shared(context.context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, host);
  const cl::Buffer other(context.context, CL_MEM_READ_WRITE, bytes);
  for (cl_uint round = 2; round < 5; ++round) {
    std::fill_n(host, words, round);
    void *place = map(context, shared(), 0, bytes, CL_MAP_WRITE_INVALIDATE_REGION);
    unmap(context, shared(), place, bytes);
    if (place != host) return false;
    context.queue.enqueueCopyBuffer(shared, other, 0, 0, bytes);
    std::vector<cl_uint> seen(words);
    context.queue.enqueueReadBuffer(other, CL_TRUE, 0, bytes, seen.data());
    if (seen != std::vector<cl_uint>(words, round)) return false;
    context.queue.enqueueFillBuffer(shared, cl_uint{100 + round}, 0, bytes);
    unmap(context, shared(), map(context, shared(), 0, bytes, CL_MAP_READ), bytes);
    context.queue.finish();
    if (!std::all_of(host, host + words, [&](cl_uint word) { return word == 100 + round; })) return false;
  }
  return true;
}

bool shares_memory(const DeviceContext &context)
{
  if (!context.device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() && context.info.type != "CPU") return false;
  try {
    return sharing_works(context);
  } catch (const std::exception &) {
    return false;
  }
}

/* Fills are split and use the longest pattern, because NVIDIA's driver 580 counts patterns in 31 bits, and 2^31 words
 * end the queue. */
constexpr size_t most_filled_at_once = size_t{1} << 30;
constexpr size_t pattern_bytes = 16; /* sizes of buffers are rounded up to it */

cl_int fill_with_zeros(const DeviceContext &context, cl_mem memory, size_t bytes)
{
  const std::array<char, pattern_bytes> zeros{};
  cl_int code = CL_SUCCESS;
  for (size_t at = 0; at < bytes && code == CL_SUCCESS; at += most_filled_at_once) {
    const size_t part = std::min(bytes - at, most_filled_at_once);
    code = clEnqueueFillBuffer(context.in_order(), memory, zeros.data(), pattern_bytes, at, part, 0, nullptr, nullptr);
  }
  return code;
}

/* The marker is for rusticl 22.3, whose clFinish does not wait for commands that a clFlush has already sent. */
cl_int finish_queue(const DeviceContext &context)
{
  const cl_int code = clEnqueueMarkerWithWaitList(context.in_order(), 0, nullptr, nullptr);
  return code == CL_SUCCESS ? clFinish(context.in_order()) : code;
}

} // namespace

DeviceStorage::DeviceStorage(const DeviceContext &context) : context_(context), shares_(shares_memory(context)) {}

/* The fill also forces drivers that postpone allocation to allocate, so that a lack of memory shows here. */
void *DeviceStorage::allocate(Element, size_t bytes, void *host_memory)
{
  context_.in_order(); /* may throw, while there is no buffer yet */
  auto buffer = std::make_unique<DeviceBuffer>();
  buffer->bytes = rounded(bytes);
  buffer->serial = next_serial_++;
  buffer->shared_with = shares_ ? static_cast<char *>(host_memory) : nullptr;
  const cl_mem_flags sharing = buffer->shared_with ? CL_MEM_USE_HOST_PTR : 0;
  cl_int code = CL_SUCCESS;
  if (faults::strikes(faults::Site::allocation)) code = CL_MEM_OBJECT_ALLOCATION_FAILURE;
  else
    buffer->memory =
        clCreateBuffer(context_.context(), CL_MEM_READ_WRITE | sharing, buffer->bytes, buffer->shared_with, &code);
  if (code == CL_SUCCESS && !buffer->shared_with) {
    is_busy_ = true;
    code = code_of(faults::Site::allocation, [&] { return fill_with_zeros(context_, buffer->memory, buffer->bytes); });
    if (code != CL_SUCCESS) clReleaseMemObject(buffer->memory);
  }
  if (code != CL_SUCCESS) fail(context_, "allocating a buffer", bytes, code);
  return buffer.release();
}

/* The host frees shared bytes next, so no kernel may still be using them. */
void DeviceStorage::release(void *handle) noexcept
{
  const std::unique_ptr<DeviceBuffer> buffer(static_cast<DeviceBuffer *>(handle));
  try {
    if (buffer->shared_with) finish_queue(context_);
  } catch (const DeviceError &) { /* a lost device uses nothing */
  }
  clReleaseMemObject(buffer->memory);
}

/* Waits for the unmap too, because a driver that keeps a copy reads the host's bytes only when it executes the
 * unmap. */
void DeviceStorage::pass_ownership(const DeviceBuffer &buffer, size_t offset, size_t bytes, cl_map_flags flags)
{
  unmap(context_, buffer.memory, map(context_, buffer.memory, offset, bytes, flags), bytes);
  wait();
}

void DeviceStorage::write(void *handle, size_t offset, const void *from, size_t bytes)
{
  const DeviceBuffer &buffer = *static_cast<DeviceBuffer *>(handle);
  if (bytes == 0) return;
  if (buffer.shared_with && from == buffer.shared_with + offset)
    return pass_ownership(buffer, offset, bytes, CL_MAP_WRITE_INVALIDATE_REGION);
  const cl_int code = code_of(faults::Site::transfer, [&] {
    return clEnqueueWriteBuffer(context_.in_order(), buffer.memory, CL_TRUE, offset, bytes, from, 0, nullptr, nullptr);
  });
  if (code != CL_SUCCESS) fail(context_, "writing", bytes, code);
}

void DeviceStorage::read(void *handle, size_t offset, void *to, size_t bytes)
{
  const DeviceBuffer &buffer = *static_cast<DeviceBuffer *>(handle);
  if (bytes == 0) return;
  if (buffer.shared_with && to == buffer.shared_with + offset)
    return pass_ownership(buffer, offset, bytes, CL_MAP_READ);
  const cl_int code = code_of(faults::Site::transfer, [&] {
    return clEnqueueReadBuffer(context_.in_order(), buffer.memory, CL_TRUE, offset, bytes, to, 0, nullptr, nullptr);
  });
  if (code != CL_SUCCESS) fail(context_, "reading", bytes, code);
}

void DeviceStorage::read_planes(void *handle, size_t plane_bytes, void *to, size_t bytes, size_t planes)
{
  if (bytes == 0 || planes == 0) return;
  const DeviceBuffer &buffer = *static_cast<DeviceBuffer *>(handle);
  const size_t origin[3] = {0, 0, 0}, region[3] = {bytes, planes, 1};
  const cl_int code = code_of(faults::Site::transfer, [&] {
    return clEnqueueReadBufferRect(context_.in_order(), buffer.memory, CL_TRUE, origin, origin, region, plane_bytes, 0,
                                   bytes, 0, to, 0, nullptr, nullptr);
  });
  if (code != CL_SUCCESS) fail(context_, "reading", bytes * planes, code);
}

void DeviceStorage::copy(void *from, void *to, size_t bytes)
{
  if (bytes == 0) return;
  is_busy_ = true;
  const cl_int code = code_of(faults::Site::transfer, [&] {
    return clEnqueueCopyBuffer(context_.in_order(), static_cast<DeviceBuffer *>(from)->memory,
                               static_cast<DeviceBuffer *>(to)->memory, 0, 0, bytes, 0, nullptr, nullptr);
  });
  if (code != CL_SUCCESS) fail(context_, "copying", bytes, code);
}

void DeviceStorage::wait()
{
  const cl_int code = code_of(faults::Site::transfer, [&] { return finish_queue(context_); });
  if (code != CL_SUCCESS) fail_to_wait(context_, code);
  is_busy_ = false;
}

} // namespace tandem::opencl
