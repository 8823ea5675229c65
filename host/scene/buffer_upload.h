/* buffer_upload.h - copies a list to the front of a buffer, unless no kernel of the scene reads that buffer. */
#pragma once

#include <vector>

#include "host/runtime/memory.h"

namespace tandem {

template <class T> void upload_all(Memory &memory, Buffer buffer, const std::vector<T> &values)
{
  if (memory.bytes(buffer) > 0) memory.upload(buffer, values.data(), values.size() * sizeof(T));
}

} // namespace tandem
