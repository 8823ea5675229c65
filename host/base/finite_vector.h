/* finite_vector.h - checks that the vectors a user gives are finite, and prints them in messages. Loaders, World and
 * the queries share it, so that all of them refuse the same vectors in the same words. */
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

namespace tandem {

/* True if every component is finite as a float, which is what the kernels read. */
template <class Vector> bool is_finite_vector(const Vector &v)
{
  return std::all_of(v.begin(), v.end(), [](auto x) { return std::isfinite(round_to_float(double{x})); });
}

template <class Vector> std::string vector_text(const Vector &v)
{
  return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}

} // namespace tandem
