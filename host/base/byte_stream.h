/* byte_stream.h - values as bytes and back, for the files that the library writes and reads: snapshots and recordings.
 *
 * Numbers are little-endian. A list or a text has its length before it, in 8 bytes. The fields of a record are those
 * with which visit_fields(record, visit) calls visit, so that one place names them for both directions
 * (host/world/snapshot_fields.h). A list of more records than a block holds is in blocks, whose lengths come first, so
 * that threads write and read them side by side:
 *
 *   records | bytes of block 0 | of block 1 | ... | block 0 | block 1 | ...
 *
 * A reader trusts nothing: it checks every length against the bytes that are left before it allocates, and throws
 * InputError with the place in the bytes.
 */
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/base/parts.h"

namespace tandem {

static_assert(std::endian::native == std::endian::little, "numbers in snapshots have the order of bytes in memory");

template <class T> constexpr bool is_number = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;

/* Numbers, and arrays of numbers: records whose bytes are copied as they are, because they have no gaps. */
template <class T> struct IsPlain : std::bool_constant<is_number<T>> {};
template <class T, size_t n> struct IsPlain<std::array<T, n>> : IsPlain<T> {};

template <class T> struct IsArray : std::false_type {};
template <class T, size_t n> struct IsArray<std::array<T, n>> : std::true_type {};
template <class T> struct IsVector : std::false_type {};
template <class T> struct IsVector<std::vector<T>> : std::true_type {};
template <class T> struct IsSpan : std::false_type {};
template <class T> struct IsSpan<std::span<T>> : std::true_type {};
template <class T> struct IsOptional : std::false_type {};
template <class T> struct IsOptional<std::optional<T>> : std::true_type {};

/* The bytes that a value takes at least. */
template <class T> constexpr size_t least_bytes()
{
  if constexpr (std::is_same_v<T, bool> || IsOptional<T>::value) return 1;
  else if constexpr (std::is_enum_v<T> || IsPlain<T>::value) return sizeof(T);
  else if constexpr (std::is_same_v<T, std::string> || IsVector<T>::value || IsSpan<T>::value) return sizeof(uint64_t);
  else if constexpr (IsArray<T>::value) return std::size(T{}) * least_bytes<typename T::value_type>();
  else {
    constexpr auto sum = []<class... Fields>(const Fields &...) {
      return std::integral_constant<size_t, (size_t{0} + ... + least_bytes<Fields>())>{};
    };
    return decltype(visit_fields(std::declval<T &>(), sum))::value;
  }
}

constexpr size_t block_records = 4096; /* of a list; a part of the format */
constexpr size_t blocks_of(size_t records)
{
  return records > block_records ? (records + block_records - 1) / block_records : 0;
}
template <class Element> std::span<Element> block_of(std::span<Element> records, size_t block)
{
  const size_t begin = block * block_records;
  return records.subspan(begin, std::min(block_records, records.size() - begin));
}

class ByteWriter {
public:
  ByteWriter() = default;
  /* Writes over these bytes: fresh memory costs several times what writing does. */
  explicit ByteWriter(std::vector<std::byte> bytes, RunParts run_parts = run_parts_in_order)
      : bytes_(std::move(bytes)), run_parts_(run_parts)
  {}

  void reserve(size_t bytes)
  {
    if (bytes > bytes_.size()) bytes_.resize(bytes);
  }
  size_t size() const { return size_; }
  std::vector<std::byte> take()
  {
    bytes_.resize(std::exchange(size_, 0));
    return std::exchange(bytes_, {});
  }

  /* Makes room for so many bytes, to be filled by the caller before the next call. */
  std::byte *extend(size_t bytes)
  {
    if (bytes > bytes_.size() - size_) bytes_.resize(std::max(size_ + bytes, size_ + size_ / 2));
    return bytes_.data() + std::exchange(size_, size_ + bytes);
  }
  void put_bytes(const void *from, size_t bytes) { copy(from, bytes, extend(bytes)); }

  template <class T> void put(const T &value)
  {
    if constexpr (IsVector<T>::value || IsSpan<T>::value) put_list(std::span(value));
    else write(value, extend(bytes_of(value)));
  }
  template <class Element> void put_list(std::span<Element> values)
  {
    using T = std::remove_const_t<Element>;
    put(uint64_t{values.size()});
    if constexpr (IsPlain<T>::value) put_bytes(values.data(), values.size_bytes());
    else if (values.size() > block_records) put_blocks(values);
    else write_all(values, extend(bytes_of_all(values)));
  }

private:
  template <class Element> void put_blocks(std::span<Element> records)
  {
    std::vector<uint64_t> bytes(blocks_of(records.size())), begins(bytes.size());
    run_parts_(bytes.size(),
               PartFunction([&](size_t block) { bytes[block] = bytes_of_all(block_of(records, block)); }));
    std::exclusive_scan(bytes.begin(), bytes.end(), begins.begin(), uint64_t{0});
    put_bytes(bytes.data(), bytes.size() * sizeof(uint64_t));
    std::byte *to = extend(begins.back() + bytes.back());
    run_parts_(bytes.size(),
               PartFunction([&](size_t block) { write_all(block_of(records, block), to + begins[block]); }));
  }

  /* A record is measured and then written through a pointer of its own, which the compiler keeps in a register. */
  template <class T> static size_t bytes_of(const T &value)
  {
    if constexpr (std::is_same_v<T, bool>) return 1;
    else if constexpr (std::is_enum_v<T> || IsPlain<T>::value) return sizeof value;
    else if constexpr (std::is_same_v<T, std::string>) return sizeof(uint64_t) + value.size();
    else if constexpr (IsArray<T>::value) return bytes_of_all(value);
    else if constexpr (IsVector<T>::value || IsSpan<T>::value)
      return sizeof(uint64_t) * (1 + lengths_before<typename T::value_type>(value.size())) + bytes_of_all(value);
    else if constexpr (IsOptional<T>::value) return 1 + (value ? bytes_of(*value) : 0);
    else return visit_fields(value, [](const auto &...fields) { return (size_t{0} + ... + bytes_of(fields)); });
  }
  template <class T> static size_t lengths_before(size_t records) { return IsPlain<T>::value ? 0 : blocks_of(records); }
  template <class List> static size_t bytes_of_all(const List &list)
  {
    if constexpr (IsPlain<std::remove_cvref_t<decltype(*list.data())>>::value)
      return list.size() * sizeof(*list.data());
    size_t bytes = 0;
    for (const auto &element : list) bytes += bytes_of(element);
    return bytes;
  }

  static std::byte *copy(const void *from, size_t bytes, std::byte *to)
  {
    if (bytes > 0) std::memcpy(to, from, bytes);
    return to + bytes;
  }
  /* Returns where the next value goes. */
  template <class T> static std::byte *write(const T &value, std::byte *to)
  {
    if constexpr (std::is_same_v<T, bool>) return write(static_cast<uint8_t>(value ? 1 : 0), to);
    else if constexpr (std::is_enum_v<T> || IsPlain<T>::value) return copy(&value, sizeof value, to);
    else if constexpr (std::is_same_v<T, std::string>)
      return copy(value.data(), value.size(), write(uint64_t{value.size()}, to));
    else if constexpr (IsArray<T>::value) return write_all(value, to);
    else if constexpr (IsVector<T>::value || IsSpan<T>::value) {
      to = write(uint64_t{value.size()}, to);
      for (size_t block = 0; block < lengths_before<typename T::value_type>(value.size()); ++block)
        to = write(uint64_t{bytes_of_all(block_of(std::span(value), block))}, to);
      return write_all(value, to);
    } else if constexpr (IsOptional<T>::value) {
      to = write(value.has_value(), to);
      return value ? write(*value, to) : to;
    } else {
      visit_fields(value, [&to](const auto &...fields) { ((to = write(fields, to)), ...); });
      return to;
    }
  }
  template <class List> static std::byte *write_all(const List &list, std::byte *to)
  {
    if constexpr (IsPlain<std::remove_cvref_t<decltype(*list.data())>>::value)
      return copy(list.data(), list.size() * sizeof(*list.data()), to);
    for (const auto &element : list) to = write(element, to);
    return to;
  }

  std::vector<std::byte> bytes_; /* what is past size_ is room */
  size_t size_ = 0;
  RunParts run_parts_ = run_parts_in_order;
};

class ByteReader {
public:
  /* where: what the bytes are, for messages; offset: the place of the first one in the whole. */
  ByteReader(std::span<const std::byte> bytes, std::string where, size_t offset = 0,
             RunParts run_parts = run_parts_in_order)
      : bytes_(bytes), where_(std::move(where)), offset_(offset), run_parts_(run_parts)
  {}

  [[noreturn]] void fail(const std::string &why) const
  {
    throw InputError(fmt::format("{}: byte {}: {}; the file is damaged", where_, offset_ + at_, why));
  }
  const std::string &where() const { return where_; }
  size_t left() const { return bytes_.size() - at_; }
  size_t position() const { return offset_ + at_; }

  std::span<const std::byte> take(uint64_t bytes)
  {
    if (bytes > left()) fail(fmt::format("{} bytes are needed, and {} are left", bytes, left()));
    const auto part = bytes_.subspan(at_, static_cast<size_t>(bytes));
    at_ += part.size();
    return part;
  }

  template <class T> T get()
  {
    T value{};
    get(value);
    return value;
  }
  template <class T> void get(T &value)
  {
    if constexpr (std::is_same_v<T, bool>) value = get_flag();
    else if constexpr (std::is_enum_v<T>) value = static_cast<T>(get<std::underlying_type_t<T>>());
    else if constexpr (IsPlain<T>::value) std::memcpy(&value, take(sizeof value).data(), sizeof value);
    else if constexpr (std::is_same_v<T, std::string>) {
      const auto text = take(get<uint64_t>());
      value.assign(reinterpret_cast<const char *>(text.data()), text.size());
    } else if constexpr (IsArray<T>::value) {
      for (auto &element : value) get(element);
    } else if constexpr (IsVector<T>::value) get_list(value);
    else if constexpr (IsOptional<T>::value) {
      if (get_flag()) get(value.emplace());
      else value.reset();
    } else visit_fields(value, [this](auto &...fields) { (this->get(fields), ...); });
  }
  /* Nothing may follow what was read. */
  void expect_end() const
  {
    if (left() > 0) fail(fmt::format("{} bytes follow the end of the contents", left()));
  }

private:
  bool get_flag()
  {
    const auto flag = get<uint8_t>();
    if (flag > 1) fail(fmt::format("a flag is {}; 0 or 1 is needed", flag));
    return flag == 1;
  }
  template <class T> void get_list(std::vector<T> &values)
  {
    const auto count = get<uint64_t>();
    if (count > left() / least_bytes<T>())
      fail(fmt::format("a list of {} entries does not fit into the {} bytes left", count, left()));
    values.clear();
    values.resize(static_cast<size_t>(count));
    if constexpr (IsPlain<T>::value) {
      const auto part = take(count * sizeof(T));
      if (count > 0) std::memcpy(values.data(), part.data(), part.size());
    } else if (count > block_records) get_blocks(std::span(values));
    else
      for (T &value : values) get(value);
  }
  template <class T> void get_blocks(std::span<T> records)
  {
    std::vector<ByteReader> blocks(blocks_of(records.size()), *this);
    const auto lengths = take(blocks.size() * sizeof(uint64_t));
    for (size_t block = 0; block < blocks.size(); ++block) {
      uint64_t bytes = 0;
      std::memcpy(&bytes, lengths.data() + block * sizeof bytes, sizeof bytes);
      blocks[block].offset_ = position();
      blocks[block].at_ = 0;
      blocks[block].bytes_ = take(bytes);
    }
    run_parts_(blocks.size(), PartFunction([&](size_t block) {
                 for (T &record : block_of(records, block)) blocks[block].get(record);
                 blocks[block].expect_end();
               }));
  }

  std::span<const std::byte> bytes_;
  std::string where_;
  size_t offset_;
  size_t at_ = 0;
  RunParts run_parts_;
};

} // namespace tandem
