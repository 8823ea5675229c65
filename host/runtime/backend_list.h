/* backend_list.h - lists of backends as a user writes them.
 *
 * The options of a backend contain commas themselves ("tbb:threads=2,lanes=4"), so a plain split at commas would tear
 * them apart. The options --between and --place both use this parser.
 */
#pragma once

#include <string>
#include <vector>

namespace tandem {

/* "serial,tbb:threads=2,lanes=4,cl:pocl" -> {"serial", "tbb:threads=2,lanes=4", "cl:pocl"}. A part
 * "threads=...", "lanes=..." or "order=..." continues the part before it. InputError on an empty part. */
std::vector<std::string> split_backends(const std::string &text);

} // namespace tandem
