/* buffer_location.cpp - decodes, compares and hashes the numbers of buffers; see buffer_location.h. */
#include "host/verify/buffer_location.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "host/base/hash.h"

namespace tandem {

bool holds_reals(Buffer buffer)
{
  const Element element = row_of(buffer).element;
  return element == Element::float4 || element == Element::real;
}

namespace {

uint32_t scalars_per_element(Buffer buffer) { return row_of(buffer).element == Element::float4 ? 4 : 1; }

std::vector<std::string> field_names(Buffer buffer)
{
  std::istringstream text(row_of(buffer).fields);
  std::vector<std::string> names;
  for (std::string name; text >> name;) names.push_back(name);
  return names;
}

/* In buffers.def, an item with one name per scalar is a record; elements of pairs that share names are planes. */
bool lies_in_planes(Buffer buffer, size_t names)
{
  const BufferRow &row = row_of(buffer);
  return row.capacity == Capacity::PAIRS && row.per_item > 1 && names < row.per_item * scalars_per_element(buffer);
}

uint64_t bits_of(Buffer buffer, const void *scalar)
{
  uint64_t bits = 0;
  std::memcpy(&bits, scalar, scalar_bytes(buffer)); /* all supported targets are little-endian */
  return bits;
}

/* Maps sign and magnitude to ascending integers. */
int64_t position_on_line(uint64_t bits, size_t bytes)
{
  const uint64_t sign = uint64_t{1} << (bytes * 8 - 1);
  return bits & sign ? -static_cast<int64_t>(bits ^ sign) : static_cast<int64_t>(bits);
}

double real_at(Buffer buffer, const void *scalar)
{
  if (scalar_bytes(buffer) == sizeof(double)) {
    double value;
    std::memcpy(&value, scalar, sizeof value);
    return value;
  }
  float value;
  std::memcpy(&value, scalar, sizeof value);
  return value;
}

/* The signs of two floats in a word: set for NaN, since what is past the bits of infinity carries into them. */
uint64_t carries_of_nan(uint64_t two_floats) { return (two_floats & 0x7fffffff7fffffffu) + 0x007fffff007fffffu; }

/* Eight at once, a sixth of the time of one by one: every buffer that is compared is read here. */
bool any_nan(const float *numbers, size_t count)
{
  uint64_t carries = 0;
  size_t k = 0;
  for (; k + 8 <= count; k += 8) {
    uint64_t words[4];
    std::memcpy(words, numbers + k, sizeof words);
    carries |=
        carries_of_nan(words[0]) | carries_of_nan(words[1]) | carries_of_nan(words[2]) | carries_of_nan(words[3]);
  }
  const bool found = (carries & 0x8000000080000000u) != 0;
  return found || std::any_of(numbers + k, numbers + count, [](float number) { return std::isnan(number); });
}

bool any_nan(const double *numbers, size_t count)
{
  return std::any_of(numbers, numbers + count, [](double number) { return std::isnan(number); });
}

/* Replaces every NaN by the same one before hashing. */
template <class Real> uint64_t hash_reals(const void *contents, size_t bytes)
{
  const size_t count = bytes / sizeof(Real);
  if (!any_nan(static_cast<const Real *>(contents), count)) return hash_bytes(contents, bytes);
  std::vector<Real> numbers(count);
  std::memcpy(numbers.data(), contents, bytes);
  for (Real &number : numbers)
    if (std::isnan(number)) number = std::numeric_limits<Real>::quiet_NaN();
  return hash_bytes(numbers.data(), bytes);
}

} // namespace

size_t scalar_bytes(Buffer buffer)
{
  const Element element = row_of(buffer).element;
  if (element == Element::Parameters) return sizeof(uint32_t);
  return size_of(element) / scalars_per_element(buffer);
}

BufferLocation location_in(Buffer buffer, size_t scalar, size_t capacity)
{
  const BufferRow &row = row_of(buffer);
  const uint32_t width = scalars_per_element(buffer);
  const std::vector<std::string> names = field_names(buffer);
  const bool planes = lies_in_planes(buffer, names.size()) && capacity > 0;
  BufferLocation location{};
  location.element = scalar / width;
  location.item = planes ? location.element % capacity : location.element / row.per_item;
  location.part = static_cast<uint32_t>(planes ? location.element / capacity : location.element % row.per_item);
  const size_t within = location.part * width + scalar % width;
  if (within < names.size() && names.size() == row.per_item * width) location.field = names[within];
  else if (!names.empty()) location.field = fmt::format("{}[{}]", names[within % names.size()], within / names.size());
  return location;
}

BufferValue value_at(Buffer buffer, const void *scalar)
{
  const uint64_t bits = bits_of(buffer, scalar);
  const int digits = static_cast<int>(scalar_bytes(buffer) * 2);
  const int precision = scalar_bytes(buffer) == sizeof(double) ? 17 : 9;
  return {holds_reals(buffer) ? fmt::format("{:.{}g}", real_at(buffer, scalar), precision) : fmt::format("{}", bits),
          fmt::format("0x{:0{}x}", bits, digits)};
}

std::optional<uint64_t> ulps_between(Buffer buffer, const void *one, const void *other)
{
  if (!holds_reals(buffer) || std::isnan(real_at(buffer, one)) || std::isnan(real_at(buffer, other))) return {};
  const uint64_t bits = bits_of(buffer, one), other_bits = bits_of(buffer, other);
  const int64_t a = position_on_line(bits, scalar_bytes(buffer)),
                b = position_on_line(other_bits, scalar_bytes(buffer));
  if (a == b) return bits == other_bits ? 0 : 1; /* 0 and -0 */
  return static_cast<uint64_t>(a > b ? a - b : b - a);
}

bool same_number(Buffer buffer, const void *one, const void *other)
{
  if (bits_of(buffer, one) == bits_of(buffer, other)) return true;
  return holds_reals(buffer) && std::isnan(real_at(buffer, one)) && std::isnan(real_at(buffer, other));
}

uint64_t hash_numbers(Buffer buffer, const void *contents, size_t bytes)
{
  if (!holds_reals(buffer)) return hash_bytes(contents, bytes);
  return scalar_bytes(buffer) == sizeof(double) ? hash_reals<double>(contents, bytes)
                                                : hash_reals<float>(contents, bytes);
}

void change_least(Buffer buffer, void *scalar)
{
  uint64_t bits = bits_of(buffer, scalar);
  bits = holds_reals(buffer) ? bits + 1 : bits ^ 1;
  std::memcpy(scalar, &bits, scalar_bytes(buffer));
}

} // namespace tandem
