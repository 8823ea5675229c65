/* program_cache.h - built OpenCL programs on disk, so that the second start does not compile.
 *
 * One file a program under $TANDEM_CACHE_DIR, else $XDG_CACHE_HOME/tandem, else ~/.cache/tandem. The key is
 * everything the binary depends on, source included, and stands in the file: a file that is truncated, corrupt
 * or of another key is reported on standard error and ignored. Nothing here ever fails a run.
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

/* Where the binary of this key is or would be; empty if there is no cache directory to use. */
std::filesystem::path cache_file(const std::string &key);

std::optional<Binary> load_binary(const std::string &key);
void store_binary(const std::string &key, const Binary &binary);

} // namespace tandem::opencl
