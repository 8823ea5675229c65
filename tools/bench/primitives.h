/* primitives.h - the parallel primitives by themselves: how long one call takes, and that it is right. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tandem {

/* Milliseconds of each of some calls over `count` items, data already on the backend, devices finished.
 * std::runtime_error if a result is wrong; InputError as make_backend. */
std::vector<double> bench_sort(const std::string &backend, uint32_t count, bool allow_inexact);
std::vector<double> bench_scan(const std::string &backend, uint32_t count, bool allow_inexact);

} // namespace tandem
