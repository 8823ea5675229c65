/* staged_uploads.h - lists that are to be copied into buffers, made completely before the first of them is copied.
 *
 * A change of a world needs memory for its lists. With all lists at hand and prepare() done, write() needs none, so a
 * change for which memory runs out is not made at all.
 */
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "host/runtime/memory.h"

namespace tandem {

class StagedUploads {
public:
  /* first: the item of the buffer that the list begins with. A buffer that no kernel of the scene reads is passed over
   * when the lists are written. */
  template <class T> void add(Buffer buffer, std::vector<T> values, size_t first = 0)
  {
    add_elements(buffer, std::move(values), first * row_of(buffer).per_item);
  }
  /* The same; first: the element of the buffer. */
  template <class T> void add_elements(Buffer buffer, std::vector<T> values, size_t first)
  {
    const auto kept = std::make_shared<const std::vector<T>>(std::move(values));
    lists_.push_back({buffer, first * sizeof(T), kept->size() * sizeof(T), kept->data(), kept});
  }
  void add_count(uint32_t entry, uint32_t value) { add_elements(Buffer::counts, std::vector<uint32_t>{value}, entry); }

  void prepare(Memory &memory) const
  {
    for (const List &list : lists_)
      if (memory.bytes(list.buffer) > 0) memory.prepare_upload(list.buffer);
  }
  void write(Memory &memory) const
  {
    for (const List &list : lists_)
      if (memory.bytes(list.buffer) > 0) memory.upload(list.buffer, list.data, list.bytes, list.offset);
  }

private:
  struct List {
    Buffer buffer;
    size_t offset, bytes;
    const void *data;
    std::shared_ptr<const void> owner;
  };

  std::vector<List> lists_; /* in the order in which they are written */
};

} // namespace tandem
