/* finite_vector.h - checks of vectors that users give, and how messages print them. */
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

namespace tandem {

/* Every component, as the float that the kernels see. */
template <class Vector> bool is_finite_vector(const Vector &v)
{
  return std::all_of(v.begin(), v.end(), [](auto x) { return std::isfinite(round_to_float(double{x})); });
}

template <class Vector> std::string vector_text(const Vector &v)
{
  return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}

} // namespace tandem
