/* memory.h - where each buffer is valid, and the moves that follow from it.
 *
 * Every buffer can live on the host and on each device. A kernel says which buffers it reads and
 * writes (kernels.def); Memory moves a buffer only when a kernel reads it somewhere it is not valid.
 * So any kernel can run anywhere in any frame, and nothing moves that need not (inventory A3, A8).
 */
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <tandem/export.h>

#include "host/runtime/interface/storage.h"

namespace tandem {

/* Every storage given to acquire must outlive the memory. */
class TANDEM_API Memory {
public:
  Memory();
  ~Memory();
  Memory(const Memory &) = delete;
  Memory &operator=(const Memory &) = delete;

  /* New contents are zero. Room is made when a copy is first needed. */
  void resize(Buffer buffer, size_t bytes);
  /* Keeps the contents. Where there is no room (OutOfMemory) the buffer is as it was. */
  void grow(Buffer buffer, size_t bytes);
  /* Other contents of another size. Where there is no room (OutOfMemory) the buffer is as it was. */
  void assign(Buffer buffer, const void *from, size_t bytes);
  /* Makes room in a storage before anything runs: OutOfMemory here leaves every content as it was. */
  void reserve(Buffer buffer, Storage &storage);
  /* After this uploads to the buffer cannot fail. */
  void prepare_upload(Buffer buffer) { acquire(buffer, host_storage(), Access::inout); }
  /* Two buffers of one kind change places. */
  void exchange(Buffer one, Buffer other) noexcept { std::swap(entries_[index_of(one)], entries_[index_of(other)]); }
  size_t bytes(Buffer buffer) const { return entries_[index_of(buffer)].bytes; }
  size_t total_bytes() const;
  bool holds(Buffer buffer, const Storage &storage) const; /* whether there is a copy of it */

  /* The buffer in this storage, valid if `access` reads; a write makes all other copies stale. What cannot be had
   * leaves every content as it was: OutOfMemory, naming the buffer and its bytes, or the device's
   * std::runtime_error. */
  void *acquire(Buffer buffer, Storage &storage, Access access);

  void upload(Buffer buffer, const void *from, size_t bytes, size_t offset = 0);
  void download(Buffer buffer, void *to, size_t bytes, size_t offset = 0);
  template <class T> std::vector<T> read(Buffer buffer, size_t elements, size_t first = 0)
  {
    std::vector<T> values(elements);
    download(buffer, values.data(), elements * sizeof(T), first * sizeof(T));
    return values;
  }
  /* Scalars of a buffer of rows or reals, in double where a backend has left them in double. */
  std::vector<double> read_reals(Buffer buffer, size_t count, size_t first = 0);
  /* Written as doubles where the buffer is in double now, rounded to floats elsewhere. */
  void write_reals(Buffer buffer, const double *from, size_t count, size_t first = 0);

private:
  struct Copy {
    Storage *storage;
    void *handle;
    bool valid;
  };
  struct Entry {
    Element element;
    size_t bytes = 0;
    std::vector<Copy> copies;
  };
  Copy &copy_in(Entry &entry, Storage &storage);
  void *allocate(const Entry &entry, size_t bytes, Storage &storage, void *host_memory);
  Copy &most_precise(Entry &entry);
  void make_valid(Entry &entry, Copy &copy);
  void wait_for_readers(Entry &entry, Storage &writer);
  void release(Entry &entry) noexcept;

  std::vector<Entry> entries_; /* of all buffers there were when it was made */
};

} // namespace tandem
