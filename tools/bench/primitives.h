/* primitives.h - benchmarks of the parallel primitives: the time of one call, with a check of its result. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tandem {

/* The milliseconds of several calls over `count` items, with data already on the backend and devices finished. Throws
 * std::runtime_error if a result is wrong, and InputError as make_backend does. */
std::vector<double> bench_sort(const std::string &backend, uint32_t count, bool allow_inexact);
std::vector<double> bench_scan(const std::string &backend, uint32_t count, bool allow_inexact);
std::vector<double> bench_copy(const std::string &backend, uint32_t count, bool allow_inexact);

} // namespace tandem
