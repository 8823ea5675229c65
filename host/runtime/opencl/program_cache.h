/* program_cache.h - keeps built OpenCL programs on disk, so that a second start does not compile them.
 *
 * There is one file a program under $TANDEM_CACHE_DIR, else $XDG_CACHE_HOME/tandem, else ~/.cache/tandem. The key is
 * everything that the binary depends on, source included, and is stored in the file: a file that is truncated, corrupt
 * or of another key is reported on standard error and ignored. An error of the cache never fails a run.
 *
 *   "TANDEM-CL-1\n"  key bytes  binary bytes  hash of the binary | key | binary
 *                    u64        u64           u64
 */
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tandem::opencl {

using Binary = std::vector<unsigned char>;

/* The file for the binary of this key, whether or not it exists; empty if no cache directory is usable. */
std::filesystem::path cache_file(const std::string &key);

std::optional<Binary> load_binary(const std::string &key);
void store_binary(const std::string &key, const Binary &binary);

} // namespace tandem::opencl
