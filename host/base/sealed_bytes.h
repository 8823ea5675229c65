/* sealed_bytes.h - the header of files that the library writes: what they are, their format, their length and a hash
 * of their contents. What a transfer has cut off or changed is refused before its contents are looked at.
 *
 *   0   8 bytes  magic
 *   8   uint64   format
 *   16  uint64   bytes of the contents, which follow the header
 *   24  uint64   hash of the contents (hash_blocks)
 */
#pragma once

#include <cstring>

#include <tandem/version.h>

#include "host/base/byte_stream.h"
#include "host/base/hash.h"

namespace tandem {

struct SealedKind {
  std::array<char, 8> magic;
  uint64_t format;
  const char *what; /* "snapshot" */
};

constexpr size_t seal_bytes = 32;

/* Leaves room for the header; seal() fills it when all contents have been written after it. */
inline void begin_sealed(ByteWriter &writer) { writer.extend(seal_bytes); }
inline std::vector<std::byte> seal(ByteWriter &writer, const SealedKind &kind, RunParts run_parts)
{
  std::vector<std::byte> bytes = writer.take();
  const uint64_t length = bytes.size() - seal_bytes,
                 hash = hash_blocks(bytes.data() + seal_bytes, length, 0, run_parts);
  std::memcpy(bytes.data(), kind.magic.data(), kind.magic.size());
  std::memcpy(bytes.data() + 8, &kind.format, sizeof kind.format);
  std::memcpy(bytes.data() + 16, &length, sizeof length);
  std::memcpy(bytes.data() + 24, &hash, sizeof hash);
  return bytes;
}

/* The contents. Throws InputError unless the bytes are what seal() returned for this kind. */
inline std::span<const std::byte> unseal(std::span<const std::byte> bytes, const SealedKind &kind,
                                         const std::string &where, RunParts run_parts)
{
  const auto refuse = [&](const std::string &why) { throw InputError(fmt::format("{}: {}", where, why)); };
  const auto word = [&](size_t offset) {
    uint64_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
  };
  if (bytes.size() < seal_bytes)
    refuse(fmt::format("{} bytes are no {}, which has {} at least", bytes.size(), kind.what, seal_bytes));
  if (std::memcmp(bytes.data(), kind.magic.data(), kind.magic.size()) != 0)
    refuse(fmt::format("it is no {} of Tandem, which begins with '{}'", kind.what,
                       std::string(kind.magic.data(), kind.magic.size() - 1)));
  if (word(8) != kind.format)
    refuse(fmt::format("the {} has format {}; Tandem {} reads format {}", kind.what, word(8), version(), kind.format));
  if (word(16) != bytes.size() - seal_bytes)
    refuse(fmt::format("the {} should have {} bytes of contents and has {}; it is cut off or damaged", kind.what,
                       word(16), bytes.size() - seal_bytes));
  const auto contents = bytes.subspan(seal_bytes);
  if (word(24) != hash_blocks(contents.data(), contents.size(), 0, run_parts))
    refuse(fmt::format("the contents of the {} do not have the hash of its header; it is damaged", kind.what));
  return contents;
}

} // namespace tandem
