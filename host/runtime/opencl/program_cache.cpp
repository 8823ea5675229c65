/* program_cache.cpp - reads and writes the files of the cache; program_cache.h describes their layout. */
#include "host/runtime/opencl/program_cache.h"

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <unistd.h>

namespace tandem::opencl {
namespace {

namespace files = std::filesystem;
const std::string magic = "TANDEM-CL-1\n";

struct Header {
  uint64_t key_bytes, binary_bytes, binary_hash;
};

/* FNV-1a, which names files and detects damage. The whole key is compared, so it need not resist attack. */
uint64_t hash_of(const unsigned char *bytes, size_t count, uint64_t hash = 0xcbf29ce484222325u)
{
  for (size_t i = 0; i < count; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3u;
  return hash;
}

files::path cache_directory()
{
  const auto variable = [](const char *name) -> files::path {
    const char *value = std::getenv(name);
    return value ? value : "";
  };
  if (const files::path own = variable("TANDEM_CACHE_DIR"); !own.empty()) return own;
  if (const files::path user = variable("XDG_CACHE_HOME"); !user.empty()) return user / "tandem";
  if (const files::path home = variable("HOME"); !home.empty()) return home / ".cache" / "tandem";
  return {};
}

/* Standard output is reserved for results (--json -), so warnings go to standard error. One that cannot be written is
 * no reason to fail. */
void warn(const std::string &message) { std::fprintf(stderr, "tandem: warning: %s\n", message.c_str()); }

void warn_unwritable(const files::path &directory)
{
  static std::atomic<bool> said = false;
  if (!said.exchange(true))
    warn(fmt::format("kernel cache {} cannot be written: every start compiles again", directory.string()));
}

/* What is wrong with the file, or empty; `binary` then holds its payload. */
std::string parse(const std::string &content, const std::string &key, Binary &binary)
{
  Header header;
  if (content.compare(0, magic.size(), magic) != 0) return "is not a kernel cache file";
  if (content.size() < magic.size() + sizeof header) return "is truncated";
  std::memcpy(&header, content.data() + magic.size(), sizeof header);
  const size_t key_at = magic.size() + sizeof header;
  if (header.key_bytes > content.size() || header.binary_bytes > content.size() ||
      content.size() - key_at != header.key_bytes + header.binary_bytes)
    return "is truncated";
  if (content.compare(key_at, header.key_bytes, key) != 0) return "belongs to another program or device";
  const unsigned char *payload = reinterpret_cast<const unsigned char *>(content.data()) + key_at + header.key_bytes;
  if (hash_of(payload, header.binary_bytes) != header.binary_hash) return "is corrupt";
  binary.assign(payload, payload + header.binary_bytes);
  return {};
}

bool write_file(const files::path &file, const std::string &key, const Binary &binary)
{
  const Header header{key.size(), binary.size(), hash_of(binary.data(), binary.size())};
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(magic.data(), static_cast<std::streamsize>(magic.size()));
  out.write(reinterpret_cast<const char *>(&header), sizeof header);
  out.write(key.data(), static_cast<std::streamsize>(key.size()));
  out.write(reinterpret_cast<const char *>(binary.data()), static_cast<std::streamsize>(binary.size()));
  out.close();
  return !out.fail();
}

} // namespace

files::path cache_file(const std::string &key)
{
  const files::path directory = cache_directory();
  if (directory.empty()) return {};
  const auto *bytes = reinterpret_cast<const unsigned char *>(key.data());
  const uint64_t forward = hash_of(bytes, key.size());
  const uint64_t again = hash_of(bytes, key.size(), forward ^ 0x9e3779b97f4a7c15u);
  return directory / fmt::format("{:016x}{:016x}.clbin", forward, again);
}

std::optional<Binary> load_binary(const std::string &key)
{
  const files::path file = cache_file(key);
  std::ifstream in(file, std::ios::binary);
  if (file.empty() || !in) return std::nullopt;
  const std::string content{std::istreambuf_iterator<char>(in), {}};
  Binary binary;
  const std::string wrong = parse(content, key, binary);
  if (wrong.empty()) return binary;
  warn(fmt::format("kernel cache file {} {}: compiling again", file.string(), wrong));
  return std::nullopt;
}

/* The file is written beside its target and renamed, so that no other process ever reads half a file. */
void store_binary(const std::string &key, const Binary &binary)
{
  const files::path file = cache_file(key);
  if (file.empty() || binary.empty()) return;
  static std::atomic<unsigned> number = 0;
  const files::path unfinished = fmt::format("{}.{}.{}", file.string(), getpid(), number++);
  std::error_code error;
  files::create_directories(file.parent_path(), error);
  const bool written = !error && write_file(unfinished, key, binary);
  if (written) files::rename(unfinished, file, error);
  if (written && !error) return;
  warn_unwritable(file.parent_path());
  files::remove(unfinished, error);
}

} // namespace tandem::opencl
