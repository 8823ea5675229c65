/* numbers.h - writes numbers so that reading them gives the same bits: floats in hexadecimal. The scene writer uses
 * it. */
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>

#include <fmt/format.h>

namespace tandem {

template <class Real> std::string hex_float(Real value)
{
  char digits[32];
  auto [end, error] = std::to_chars(digits, digits + sizeof digits, std::abs(value), std::chars_format::hex);
  (void)error; /* 32 characters hold every number */
  return fmt::format("\"{}0x{}\"", std::signbit(value) ? "-" : "", std::string_view(digits, size_t(end - digits)));
}

inline std::string written(float value) { return hex_float(value); }
inline std::string written(uint32_t value) { return fmt::format("{}", value); }
template <class Real, size_t n> std::string written(const std::array<Real, n> &values)
{
  std::string text = "[";
  for (size_t i = 0; i < n; ++i) text += (i ? ", " : "") + hex_float(values[i]);
  return text + "]";
}

/* Compares floats by their bits, because -0 differs from the default 0. */
inline bool same(const std::string &a, const std::string &b) { return a == b; }
template <typename T> bool same(const T &a, const T &b) { return std::memcmp(&a, &b, sizeof(T)) == 0; }

} // namespace tandem
