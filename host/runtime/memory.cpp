/* memory.cpp - copies of buffers in storages, and which of them are valid; see memory.h. */
#include "host/runtime/memory.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/base/out_of_memory.h"
#include "host/runtime/parts.h"

namespace tandem {
Memory::Memory() : entries_(all_buffers())
{
  for (size_t i = 0; i < entries_.size(); ++i) entries_[i].element = row_of(buffer_at(i)).element;
}

/* Each memory counts in a range of its own. */
uint64_t Memory::first_version()
{
  static std::atomic<uint64_t> memories = 0;
  return ++memories << 40;
}

Memory::~Memory()
{
  for (Entry &entry : entries_) release(entry);
}

/* Copies are released in reverse order: a device that works in host memory must release it before it is freed, and the
 * host's copy is always first. */
void Memory::release(Entry &entry) noexcept
{
  for (auto copy = entry.copies.rbegin(); copy != entry.copies.rend(); ++copy)
    if (!copy->lent) copy->storage->release(copy->handle);
  entry.copies.clear();
  entry.forgotten = false;
}

void Memory::resize(Buffer buffer, size_t bytes)
{
  Entry &entry = entries_[index_of(buffer)];
  if (bytes == entry.bytes) return;
  separate(buffer);
  release(entry);
  entry.bytes = bytes;
  note_write(entry);
}

void Memory::assign(Buffer buffer, const void *from, size_t bytes)
{
  separate(buffer);
  Entry &entry = entries_[index_of(buffer)];
  Entry other{entry.element, bytes, {}};
  if (bytes > 0) {
    other.copies.reserve(1);
    other.copies.push_back({&host_storage(), allocate(entry, bytes, host_storage(), nullptr), true});
    std::memcpy(other.copies.front().handle, from, bytes);
  }
  release(entry);
  entry = std::move(other);
  note_write(entry);
  uploaded_bytes_ += bytes;
}

void Memory::reserve(Buffer buffer, Storage &storage)
{
  Entry &entry = entries_[index_of(buffer)];
  if (entry.bytes > 0) copy_in(entry, storage);
}

bool Memory::holds(Buffer buffer, const Storage &storage) const
{
  const std::vector<Copy> &copies = entries_[index_of(buffer)].copies;
  return std::any_of(copies.begin(), copies.end(), [&](const Copy &copy) { return copy.storage == &storage; });
}

size_t Memory::total_bytes() const
{
  size_t total = 0;
  for (const Entry &entry : entries_) total += entry.bytes;
  for (const Tenancy &tenancy : tenancies_) total -= bytes(tenancy.tenant);
  return total;
}

void *Memory::allocate(const Entry &entry, size_t bytes, Storage &storage, void *host_memory)
{
  const auto refusal = [&](const std::string &why) {
    return fmt::format("out of memory: buffer {} needs {} bytes of {}, all buffers together {}{}",
                       row_of(buffer_at(index_in(entry))).name, bytes, storage.what(), total_bytes(), why);
  };
  try {
    return storage.allocate(entry.element, bytes, host_memory);
  } catch (const std::bad_alloc &) {
    throw OutOfMemory(refusal(""));
  } catch (const std::runtime_error &error) {
    throw OutOfMemory(refusal(fmt::format(" ({})", error.what())));
  }
}

Memory::Copy &Memory::copy_in(Entry &entry, Storage &storage)
{
  for (Copy &copy : entry.copies)
    if (copy.storage == &storage) return copy;
  entry.copies.reserve(entry.copies.size() +
                       2); /* this copy and the host's; a push_back that failed later would leak a handle */
  if (Copy *const lent = lend(entry, storage)) return *lent;
  if (&storage != &host_storage() && storage.shares_host_memory()) {
    void *host = copy_in(entry, host_storage()).handle;
    entry.copies.push_back({&storage, allocate(entry, entry.bytes, storage, host), false});
    return entry.copies.back();
  }
  const Copy fresh{&storage, allocate(entry, entry.bytes, storage, nullptr), entry.copies.empty()};
  const auto place = &storage == &host_storage() ? entry.copies.begin() : entry.copies.end();
  return *entry.copies.insert(place, fresh);
}

namespace {

/* Calls move(offset, bytes) for the part in each plane of a buffer of so many bytes. */
template <class Move> void for_each_plane(size_t bytes, const UsedPart &part, Move move)
{
  for (size_t plane = 0; plane < part.planes; ++plane)
    if (part.bytes > 0) move(plane * (bytes / part.planes), part.bytes);
}

double milliseconds_since(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void count_move(Moves &moves, const UsedPart &part, std::chrono::steady_clock::time_point start)
{
  moves.bytes += part.planes * part.bytes;
  ++moves.buffers;
  moves.milliseconds += milliseconds_since(start);
}

} // namespace

/* A third device may still be reading the old bytes in the host's memory, so it is waited for. */
void Memory::move_to_host(Entry &entry, void *host, const UsedPart &part)
{
  const auto source =
      std::find_if(entry.copies.begin(), entry.copies.end(), [](const Copy &copy) { return copy.valid; });
  if (source == entry.copies.end()) return;
  for (Copy &copy : entry.copies)
    if (copy.storage != source->storage && copy.storage->shares_host_memory()) copy.storage->wait();
  note_read(*source->storage);
  if (source->storage->shares_host_memory()) return source->storage->read(source->handle, 0, host, entry.bytes);
  source->storage->wait();
  const auto start = std::chrono::steady_clock::now();
  for_each_plane(entry.bytes, part, [&](size_t at, size_t bytes) {
    source->storage->read(source->handle, at, static_cast<char *>(host) + at, bytes);
  });
  count_move(moves_, part, start);
}

void Memory::move_from_host(const Copy &copy, const void *host, size_t bytes, const UsedPart &part)
{
  if (copy.storage->shares_host_memory()) return copy.storage->write(copy.handle, 0, host, bytes);
  copy.storage->wait();
  const auto start = std::chrono::steady_clock::now();
  for_each_plane(bytes, part, [&](size_t at, size_t length) {
    copy.storage->write(copy.handle, at, static_cast<const char *>(host) + at, length);
  });
  count_move(moves_, part, start);
}

/* Bytes move between two devices through the host's copy. */
void Memory::make_valid(Buffer buffer, Storage &target, UsedParts *used)
{
  Entry &entry = entries_[index_of(buffer)];
  if (copy_in(entry, target).valid) return;
  const UsedPart part = used ? used->part_of(buffer) : whole(buffer);
  Copy &host = copy_in(entry, host_storage());
  if (!host.valid) {
    move_to_host(entry, host.handle, part);
    host.valid = true;
  }
  Copy &copy = copy_in(entry, target);
  if (copy.valid) return;
  move_from_host(copy, host.handle, entry.bytes, part);
  copy.valid = true;
}

/* A device may still be reading bytes that it shares with the storage that is about to write them. */
void Memory::wait_for_readers(Entry &entry, Storage &writer)
{
  if (&writer != &host_storage() && !writer.shares_host_memory()) return;
  for (Copy &copy : entry.copies)
    if (copy.valid && copy.storage != &writer && copy.storage->shares_host_memory()) copy.storage->wait();
}

/* The buffer in this storage, if it is valid there and a write makes no other copy stale; else null. */
void *Memory::valid_alone(const Entry &entry, const Storage &storage, Access access)
{
  void *handle = nullptr;
  for (const Copy &copy : entry.copies)
    if (copy.valid && copy.storage == &storage) handle = copy.handle;
    else if (copy.valid && access != Access::in) return nullptr;
  return handle;
}

void *Memory::acquire(Buffer buffer, Storage &storage, Access access, UsedParts *used)
{
  Entry &entry = entries_[index_of(buffer)];
  if (!is_held(buffer)) {
    if (access == Access::in) return copy_in(entry, storage).handle;
    take(buffer, storage);
  }
  const bool forgotten = std::exchange(entry.forgotten, entry.forgotten && access == Access::in);
  if (access != Access::in) note_write(entry);
  if (void *const handle = valid_alone(entry, storage, access)) return handle; /* nearly always */
  if (forgotten) copy_in(entry, storage).valid = true;
  make_valid(buffer, storage, used);
  Copy &copy = copy_in(entry, storage);
  if (access == Access::in) return copy.handle;
  wait_for_readers(entry, storage);
  for (Copy &other : entry.copies) other.valid = &other == &copy;
  return copy.handle;
}

/* --- memory that several buffers share ---------------------------------------------------------------------------- */

void Memory::share(std::vector<Tenancy> tenancies)
{
  for (const Tenancy &tenancy : tenancies_) release(entries_[index_of(tenancy.tenant)]);
  tenancies_ = std::move(tenancies);
  landlord_.resize(tenancies_.empty() ? 0 : entries_.size());
  std::iota(landlord_.begin(), landlord_.end(), size_t{0});
  holder_ = landlord_;
  for (const Tenancy &tenancy : tenancies_) {
    release(entries_[index_of(tenancy.tenant)]);
    landlord_[index_of(tenancy.tenant)] = index_of(tenancy.landlord);
  }
}

void Memory::separate(Buffer buffer)
{
  const size_t index = index_of(buffer);
  if (landlord_.empty()) return;
  evict(index);
  if (landlord_[index] != index) {
    release(entries_[index]);
    if (!is_held(buffer_at(landlord_[index]))) holder_[landlord_[index]] = landlord_[index];
  }
  const auto leaves = [&](const Tenancy &tenancy) {
    const bool does = tenancy.tenant == buffer || tenancy.landlord == buffer;
    if (does) landlord_[index_of(tenancy.tenant)] = index_of(tenancy.tenant);
    return does;
  };
  tenancies_.erase(std::remove_if(tenancies_.begin(), tenancies_.end(), leaves), tenancies_.end());
}

void Memory::exchange(Buffer one, Buffer other) noexcept
{
  std::swap(entries_[index_of(one)], entries_[index_of(other)]);
  if (landlord_.empty()) return;
  evict(index_of(one));
  evict(index_of(other));
}

/* Takes its memory back from all tenants. */
void Memory::evict(size_t landlord) noexcept
{
  if (landlord_[landlord] != landlord) return;
  holder_[landlord] = landlord;
  for (const Tenancy &tenancy : tenancies_)
    if (index_of(tenancy.landlord) == landlord) release(entries_[index_of(tenancy.tenant)]);
}

/* The copy of a tenant in this storage, or null for a buffer with memory of its own. */
Memory::Copy *Memory::lend(Entry &entry, Storage &storage)
{
  const size_t index = index_in(entry);
  if (landlord_.empty() || landlord_[index] == index || storage.keeps_doubles()) return nullptr;
  void *const handle = copy_in(entries_[landlord_[index]], storage).handle;
  entry.copies.push_back({&storage, handle, entry.copies.empty(), true});
  return &entry.copies.back();
}

/* A device that works in the host's memory may still read what that held before. */
void Memory::take(Buffer buffer, Storage &storage)
{
  Entry &entry = entries_[index_of(buffer)];
  copy_in(entry, storage); /* before anything changes, because there may be no memory */
  const size_t landlord = landlord_[index_of(buffer)];
  for (const Copy &copy : entries_[landlord].copies)
    if (copy.storage != &storage && copy.storage->shares_host_memory()) copy.storage->wait();
  holder_[landlord] = index_of(buffer);
  for (Copy &copy : entry.copies) copy.valid = copy.storage == &storage;
  entry.forgotten = false;
  if (poisons_) poison(entry, storage);
}

void Memory::poison(Entry &entry, Storage &storage)
{
  constexpr unsigned char byte = 0xab; /* as a float -1e-12, and an index beyond every buffer */
  const std::vector<unsigned char> bytes(entry.bytes, byte);
  storage.write(copy_in(entry, storage).handle, 0, bytes.data(), bytes.size());
}

void Memory::check_held(Buffer buffer) const
{
  if (!is_held(buffer))
    throw std::logic_error(std::string("buffer ") + row_of(buffer).name + " is read after " +
                           row_of(buffer_at(holder_of(index_of(buffer)))).name + " has taken its memory");
}

/* A valid copy in memory of a device's own, or null. */
Memory::Copy *Memory::valid_on_device(Entry &entry)
{
  for (Copy &copy : entry.copies)
    if (copy.valid && copy.storage != &host_storage() && !copy.storage->shares_host_memory()) return &copy;
  return nullptr;
}

void Memory::prepare_upload(Buffer buffer)
{
  if (!valid_on_device(entries_[index_of(buffer)])) acquire(buffer, host_storage(), Access::inout);
}

void Memory::upload(Buffer buffer, const void *from, size_t bytes, size_t offset)
{
  if (bytes == 0) return;
  uploaded_bytes_ += bytes;
  check_held(buffer);
  Entry &entry = entries_[index_of(buffer)];
  entry.forgotten = false;
  note_write(entry);
  Copy *device = valid_on_device(entry);
  if (!device) {
    char *host = static_cast<char *>(acquire(buffer, host_storage(), Access::inout));
    std::memcpy(host + offset, from, bytes);
    return;
  }
  device->storage->write(device->handle, offset, from, bytes);
  for (Copy &copy : entry.copies)
    if (copy.storage == &host_storage() && copy.valid)
      std::memcpy(static_cast<char *>(copy.handle) + offset, from, bytes);
    else copy.valid = &copy == device;
}

namespace {

/* One thread does not fill the memory bus of most machines. Where there is no memory for TBB's tasks, it copies all the
 * same, so that this cannot fail. */
void copy_in_parts(const void *from, void *to, size_t bytes) noexcept
{
  constexpr size_t part_bytes = size_t{1} << 20;
  try {
    run_parts((bytes + part_bytes - 1) / part_bytes, PartFunction([&](size_t part) {
                const size_t begin = part * part_bytes;
                std::memcpy(static_cast<char *>(to) + begin, static_cast<const char *>(from) + begin,
                            std::min(part_bytes, bytes - begin));
              }));
  } catch (const std::exception &) {
    std::memcpy(to, from, bytes);
  }
}

void copy_within(Storage &storage, void *from, void *to, size_t bytes)
{
  if (&storage == &host_storage()) copy_in_parts(from, to, bytes);
  else storage.copy(from, to, bytes);
}

} // namespace

/* Everything that can fail comes before the first change. Contents stay on the device that has them, because hundreds
 * of megabytes would take longer through the host than a step does. */
void Memory::fit(Buffer buffer, size_t bytes)
{
  Entry &entry = entries_[index_of(buffer)];
  const size_t kept = std::min(bytes, entry.bytes);
  if (bytes == entry.bytes) return;
  separate(buffer);
  Entry fitted{entry.element, bytes, {}};
  if (!entry.copies.empty() && kept > 0) {
    const Copy *device = valid_on_device(entry);
    Storage &storage = device ? *device->storage : host_storage();
    void *from = device ? device->handle : acquire(buffer, storage, Access::in);
    fitted.copies.reserve(1);
    fitted.copies.push_back({&storage, allocate(entry, bytes, storage, nullptr), true});
    try {
      copy_within(storage, from, fitted.copies.front().handle, kept);
    } catch (...) {
      release(fitted);
      throw;
    }
  }
  release(entry);
  entry = std::move(fitted);
  note_write(entry);
}

/* Reads directly from a device if the host's copy is stale, so that reading a count transfers only the count. */
void Memory::download(Buffer buffer, void *to, size_t bytes, size_t offset)
{
  if (bytes == 0) return;
  check_held(buffer);
  Entry &entry = entries_[index_of(buffer)];
  if (entry.copies.empty()) copy_in(entry, host_storage()); /* zeros */
  for (Copy &copy : entry.copies)
    if (copy.valid && copy.storage == &host_storage())
      return copy_in_parts(static_cast<const char *>(copy.handle) + offset, to, bytes);
    else if (copy.valid) {
      note_read(*copy.storage);
      return copy.storage->read(copy.handle, offset, to, bytes);
    }
}

void Memory::make_room(Buffer buffer, Storage &storage, KeptBytes &kept)
{
  Entry &entry = entries_[index_of(buffer)];
  if (kept.storage_ == &storage && kept.capacity_ >= entry.bytes) return;
  KeptBytes fresh;
  fresh.handle_ = allocate(entry, entry.bytes, storage, nullptr);
  fresh.storage_ = &storage;
  fresh.capacity_ = entry.bytes;
  kept = std::move(fresh);
}

/* Prefers the storage that has room already, then a device. */
void Memory::keep(Buffer buffer, size_t bytes, KeptBytes &kept)
{
  kept.bytes_ = 0;
  Entry &entry = entries_[index_of(buffer)];
  if (bytes == 0 || entry.bytes == 0) return;
  check_held(buffer);
  copy_in(entry, host_storage());
  const Copy *source = nullptr;
  for (const Copy &copy : entry.copies)
    if (copy.valid && (!source || source->storage != kept.storage_)) source = &copy;
  make_room(buffer, *source->storage, kept);
  copy_within(*source->storage, source->handle, kept.handle_, bytes);
  kept.bytes_ = bytes;
}

void Memory::put_back(Buffer buffer, const KeptBytes &kept)
{
  if (kept.bytes_ == 0) return;
  if (!is_held(buffer)) take(buffer, *kept.storage_);
  Entry &entry = entries_[index_of(buffer)];
  Copy &target = copy_in(entry, *kept.storage_);
  wait_for_readers(entry, *kept.storage_);
  entry.forgotten = false;
  note_write(entry);
  copy_within(*kept.storage_, kept.handle_, target.handle, kept.bytes_);
  for (Copy &copy : entry.copies) copy.valid = &copy == &target;
}

/* Prefers a copy in double: once the host has read a buffer, its floats are valid beside the doubles. */
Memory::Copy &Memory::most_precise(Entry &entry)
{
  copy_in(entry, host_storage());
  const auto wide = std::find_if(entry.copies.begin(), entry.copies.end(),
                                 [](const Copy &copy) { return copy.valid && copy.storage->keeps_doubles(); });
  if (wide != entry.copies.end()) return *wide;
  return *std::find_if(entry.copies.begin(), entry.copies.end(), [](const Copy &copy) { return copy.valid; });
}

std::vector<double> Memory::read_reals(Buffer buffer, size_t count, size_t first)
{
  std::vector<double> values(count);
  read_reals(buffer, values.data(), count, first);
  return values;
}

void Memory::read_reals(Buffer buffer, double *to, size_t count, size_t first)
{
  if (count == 0) return;
  check_held(buffer);
  Copy &copy = most_precise(entries_[index_of(buffer)]);
  note_read(*copy.storage);
  copy.storage->read_reals(copy.handle, first, to, count);
}

void Memory::read_real_planes(Buffer buffer, double *to, size_t count, size_t planes, size_t plane_reals)
{
  if (count == 0 || planes == 0) return;
  check_held(buffer);
  Copy &copy = most_precise(entries_[index_of(buffer)]);
  note_read(*copy.storage);
  copy.storage->read_real_planes(copy.handle, plane_reals, to, count, planes);
}

void Memory::write_reals(Buffer buffer, const double *from, size_t count, size_t first)
{
  if (count == 0) return;
  check_held(buffer);
  Entry &entry = entries_[index_of(buffer)];
  Copy &wide = most_precise(entry);
  if (!wide.storage->keeps_doubles()) {
    rounded_.reserve(entry.bytes / sizeof(float)); /* for any later write to the buffer, too */
    rounded_.resize(count);
    std::transform(from, from + count, rounded_.begin(), [](double x) { return round_to_float(x); });
    return upload(buffer, rounded_.data(), count * sizeof(float), first * sizeof(float));
  }
  entry.forgotten = false;
  note_write(entry);
  wide.storage->write_reals(wide.handle, first, from, count);
  for (Copy &other : entry.copies) other.valid = &other == &wide;
}

} // namespace tandem
