/* memory.h - keeps track of where each buffer is valid, and makes the moves that follow from it.
 *
 * Every buffer can have copies on the host and on each device. kernels.def says which buffers a kernel reads and
 * writes, and Memory moves a buffer only if a kernel reads it in a storage where it is not valid. Any kernel can
 * therefore run anywhere in any step, and nothing is moved without need.
 */
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <tandem/export.h>

#include "host/runtime/interface/storage.h"

namespace tandem {

/* The first bytes of a buffer at another time, in memory of a storage in which the buffer was valid. */
class TANDEM_API KeptBytes {
public:
  KeptBytes() = default;
  KeptBytes(KeptBytes &&other) noexcept { swap(other); }
  KeptBytes &operator=(KeptBytes &&other) noexcept
  {
    swap(other);
    return *this;
  }
  ~KeptBytes()
  {
    if (storage_) storage_->release(handle_);
  }

private:
  friend class Memory;
  void swap(KeptBytes &other) noexcept
  {
    std::swap(storage_, other.storage_);
    std::swap(handle_, other.handle_);
    std::swap(capacity_, other.capacity_);
    std::swap(bytes_, other.bytes_);
  }

  Storage *storage_ = nullptr;
  void *handle_ = nullptr;
  size_t capacity_ = 0, bytes_ = 0;
};

/* The part of a buffer that means something: the first bytes of each of its planes, which are equally long. */
struct UsedPart {
  size_t bytes = 0, planes = 1;
};

/* Knows that part where a launch is about to read a buffer; it is asked only if the buffer has to move. */
class TANDEM_API UsedParts {
public:
  virtual ~UsedParts() = default;
  virtual UsedPart part_of(Buffer buffer) = 0;
};

/* What has moved between storages so far. A device that works in the host's memory is given buffers without a copy,
 * which counts for nothing here. */
struct Moves {
  uint64_t bytes = 0, buffers = 0;
  double milliseconds = 0; /* with what wrote them finished, so that none of its time is among it */
  uint64_t reads = 0; /* by the host from a storage that is not its own, of whole buffers or parts: each one waits */
};

/* A buffer that has no memory of its own and lies in that of another, which is at least as large. */
struct Tenancy {
  Buffer tenant, landlord;
};

/* Every storage given to acquire must outlive the memory. */
class TANDEM_API Memory {
public:
  Memory();
  ~Memory();
  Memory(const Memory &) = delete;
  Memory &operator=(const Memory &) = delete;

  /* Sets a new size; the contents become zero. Storage is allocated when a copy is first needed. */
  void resize(Buffer buffer, size_t bytes);
  /* Changes the size and keeps the contents, as far as they fit. If there is not enough memory (OutOfMemory), the
   * buffer is unchanged. grow: only if the size is larger. */
  void fit(Buffer buffer, size_t bytes);
  void grow(Buffer buffer, size_t bytes)
  {
    if (bytes > this->bytes(buffer)) fit(buffer, bytes);
  }
  /* Replaces contents and size. If there is not enough memory (OutOfMemory), the buffer is unchanged. */
  void assign(Buffer buffer, const void *from, size_t bytes);
  /* Allocates the copy in a storage before anything runs; OutOfMemory leaves all contents unchanged. */
  void reserve(Buffer buffer, Storage &storage);
  /* Ensures that later uploads to the buffer do not run out of memory. */
  void prepare_upload(Buffer buffer);
  /* Exchanges two buffers of the same type. What tenants of theirs held is lost. */
  void exchange(Buffer one, Buffer other) noexcept;
  /* Lets buffers lie in the memory of others, instead of those that did so far; no landlord is a tenant. A landlord and
   * its tenants hold contents in turn: who is written takes the memory, and what the others held is lost. Where reals
   * are doubles, each has memory of its own all the same, because a tenant may need more bytes there. */
  void share(std::vector<Tenancy> tenancies);
  const std::vector<Tenancy> &shared() const { return tenancies_; }
  /* Gives a buffer memory of its own, and each of its tenants. */
  void separate(Buffer buffer);
  /* Whether the buffer has what was last written to it. Another read of one that has not is a mistake of the program;
   * a launch may read it that runs over no items. */
  bool is_held(Buffer buffer) const { return holder_of(index_of(buffer)) == index_of(buffer); }
  /* For tests: who takes shared memory finds it full of numbers that show in the results of whoever reads them. */
  void poison_shared_memory() { poisons_ = true; }
  bool poisons() const { return poisons_; }
  /* 0 for a buffer of a module that was added later. */
  size_t bytes(Buffer buffer) const
  {
    return index_of(buffer) < entries_.size() ? entries_[index_of(buffer)].bytes : 0;
  }
  size_t total_bytes() const; /* shared memory counts once */
  /* What upload() and assign() were given so far, so that a test can hold a call to uploading no more than it must. */
  uint64_t uploaded_bytes() const { return uploaded_bytes_; }
  bool holds(Buffer buffer, const Storage &storage) const; /* whether the storage has a copy of it */

  /* Returns the buffer in this storage, valid if `access` reads; a write makes all other copies stale. If it throws
   * (OutOfMemory that names the buffer and its bytes, or the device's std::runtime_error), all contents are
   * unchanged. What moves is what `used` says, or all of it: the bytes behind a part that moved are undefined. */
  void *acquire(Buffer buffer, Storage &storage, Access access, UsedParts *used = nullptr);
  /* Nothing reads what the buffer holds until it is written again, so that it need not move. */
  void forget_contents(Buffer buffer) { entries_[index_of(buffer)].forgotten = true; }
  const Moves &moves() const { return moves_; }
  /* Another number after each call that may have written the buffer, and never that of another buffer of any memory,
   * but 0 for all that nobody has written. So the host need not read again what it has read. */
  uint64_t version(Buffer buffer) const { return entries_[index_of(buffer)].version; }
  UsedPart whole(Buffer buffer) const { return {bytes(buffer), 1}; }

  /* Writes in place where the buffer is valid, so that a few bytes do not move all of it. */
  void upload(Buffer buffer, const void *from, size_t bytes, size_t offset = 0);
  void download(Buffer buffer, void *to, size_t bytes, size_t offset = 0);
  template <class T> std::vector<T> read(Buffer buffer, size_t elements, size_t first = 0)
  {
    std::vector<T> values(elements);
    download(buffer, values.data(), elements * sizeof(T), first * sizeof(T));
    return values;
  }
  /* Copies the first bytes of a buffer within a storage where it is valid, and back; nothing goes through the host.
   * Of a buffer that the world lacks nothing is kept. make_room: allocates for the whole buffer, so that a later
   * keep() need not. put_back: what lies behind these bytes is undefined then. */
  void make_room(Buffer buffer, Storage &storage, KeptBytes &kept);
  void keep(Buffer buffer, size_t bytes, KeptBytes &kept);
  void put_back(Buffer buffer, const KeptBytes &kept);

  /* Scalars of a buffer of float4s or reals, in double if a backend has left them in double. */
  std::vector<double> read_reals(Buffer buffer, size_t count, size_t first = 0);
  void read_reals(Buffer buffer, double *to, size_t count, size_t first = 0);
  /* The first reals of each plane, of plane_reals reals each, one behind the other. */
  void read_real_planes(Buffer buffer, double *to, size_t count, size_t planes, size_t plane_reals);
  /* Writes doubles if the buffer is now in double; otherwise they are rounded to floats. */
  void write_reals(Buffer buffer, const double *from, size_t count, size_t first = 0);

private:
  struct Copy {
    Storage *storage;
    void *handle;
    bool valid;
    bool lent = false; /* the handle is a landlord's */
  };
  struct Entry {
    Element element;
    size_t bytes = 0;
    std::vector<Copy> copies;
    bool forgotten = false; /* nothing reads the contents before they are written */
    uint64_t version = 0;
  };
  Copy &copy_in(Entry &entry, Storage &storage);
  void *allocate(const Entry &entry, size_t bytes, Storage &storage, void *host_memory);
  Copy &most_precise(Entry &entry);
  static uint64_t first_version();
  void note_write(Entry &entry) { entry.version = ++last_version_; }
  void note_read(const Storage &storage) { moves_.reads += &storage != &host_storage(); }
  static Copy *valid_on_device(Entry &entry);
  static void *valid_alone(const Entry &entry, const Storage &storage, Access access);
  void make_valid(Buffer buffer, Storage &target, UsedParts *used);
  void move_to_host(Entry &entry, void *host, const UsedPart &part);
  void move_from_host(const Copy &copy, const void *host, size_t bytes, const UsedPart &part);
  void wait_for_readers(Entry &entry, Storage &writer);
  void release(Entry &entry) noexcept;
  void evict(size_t landlord) noexcept;
  Copy *lend(Entry &entry, Storage &storage);
  void take(Buffer buffer, Storage &storage);
  void poison(Entry &entry, Storage &storage);
  void check_held(Buffer buffer) const;
  size_t index_in(const Entry &entry) const { return static_cast<size_t>(&entry - entries_.data()); }
  size_t holder_of(size_t index) const { return holder_.empty() ? index : holder_[landlord_[index]]; }

  std::vector<Entry> entries_; /* one for each buffer that existed when the memory was made */
  std::vector<Tenancy> tenancies_;
  /* By the buffer's number, empty where nothing is shared: its landlord, or itself; and who holds its memory. */
  std::vector<size_t> landlord_, holder_;
  bool poisons_ = false;
  std::vector<float> rounded_; /* by write_reals; kept, so that kernels of the host write without allocating */
  uint64_t uploaded_bytes_ = 0;
  uint64_t last_version_ = first_version();
  Moves moves_;
};

} // namespace tandem
