/* file.cpp - reads contact problems; see file.h. Every error message names the line. */
#include "host/io/contact_problem/file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <tandem/round_to_float.h>
#include <tandem/scene.h>

#include "host/base/printable.h"
#include "host/io/input_file.h"

namespace tandem {
namespace {

constexpr uint64_t most_contacts = 1'000'000, most_dense_contacts = 5'000;

/* The numbers of a file in order, with the line of each. */
class Numbers {
public:
  explicit Numbers(const std::string &path) : path_(path), text_(read_file(path)) {}

  [[noreturn]] void refuse(const std::string &why) const
  {
    throw InputError(fmt::format("{}: line {}: {}", path_, line_, why));
  }

  bool at_end()
  {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) line_ += text_[at_++] == '\n';
    return at_ == text_.size();
  }

  double real(const std::string &what)
  {
    const double value = number<double>(what, "a number");
    if (!std::isfinite(value)) refuse(fmt::format("{} is not finite", what));
    if (!std::isfinite(round_to_float(value)))
      refuse(fmt::format("{} is {}, which no 32-bit float holds", what, value));
    return value;
  }
  uint64_t whole(const std::string &what, uint64_t lowest, uint64_t highest)
  {
    const uint64_t value = number<uint64_t>(what, "a whole number");
    if (value >= lowest && value <= highest) return value;
    if (lowest == highest) refuse(fmt::format("{} is {}, it must be {}", what, value, lowest));
    refuse(fmt::format("{} is {}, it must be {} to {}", what, value, lowest, highest));
  }

private:
  template <class T> T number(const std::string &what, const char *kind)
  {
    if (at_end()) refuse(fmt::format("the file ends where {} should stand", what));
    const char *first = text_.data() + at_, *end = text_.data() + text_.size();
    const char *last = std::find_if(first, end, [](char c) { return std::isspace(static_cast<unsigned char>(c)); });
    T value{};
    const auto [stop, error] = std::from_chars(first, last, value);
    const std::string word = printable(std::string(first, std::min(last, first + 40)));
    if (error == std::errc::result_out_of_range && stop == last)
      refuse(fmt::format("{} is '{}', too large or too small for 64 bits", what, word));
    if (error != std::errc{} || stop != last) refuse(fmt::format("{} should be {}, not '{}'", what, kind, word));
    at_ += static_cast<size_t>(last - first);
    return value;
  }

  std::string path_, text_;
  size_t at_ = 0, line_ = 1;
};

void read_dense(Numbers &numbers, ContactProblem &problem)
{
  const uint64_t n = problem.contacts, size = 3 * n;
  if (n > most_dense_contacts)
    numbers.refuse(fmt::format("a dense W of {} contacts; more than {} need storage 1", n, most_dense_contacts));
  numbers.whole("the number of rows of W", size, size);
  numbers.whole("the number of columns of W", size, size);
  std::vector<double> values;
  for (uint64_t k = 0; k < size * size; ++k)
    values.push_back(numbers.real(fmt::format("W[{}][{}]", k % size, k / size)));
  for (uint64_t i = 0; i < n; ++i) {
    problem.start.push_back(static_cast<uint32_t>(i * n));
    for (uint64_t j = 0; j < n; ++j) {
      std::array<double, 9> block;
      for (uint64_t k = 0; k < 9; ++k) block[k] = values[(3 * j + k % 3) * size + 3 * i + k / 3];
      problem.column.push_back(static_cast<uint32_t>(j));
      problem.blocks.push_back(block);
    }
  }
  problem.start.push_back(static_cast<uint32_t>(n * n));
}

void read_block_rows(Numbers &numbers, ContactProblem &problem)
{
  const uint64_t n = problem.contacts;
  const uint64_t blocks = numbers.whole("the number of blocks", n, std::min<uint64_t>(n * n, 1u << 28));
  for (const char *side : {"block rows", "block columns"}) numbers.whole(fmt::format("the number of {}", side), n, n);
  for (const char *side : {"row", "column"})
    for (uint64_t i = 0; i < n; ++i)
      numbers.whole(fmt::format("the end of block {} {}", side, i), 3 * i + 3, 3 * i + 3);
  numbers.whole("the length of the first index array", n + 1, n + 1);
  numbers.whole("the length of the second index array", blocks, blocks);
  for (uint64_t i = 0; i <= n; ++i) {
    const uint64_t lowest = i == 0 ? 0 : problem.start.back(), highest = i == 0 ? 0 : blocks;
    problem.start.push_back(static_cast<uint32_t>(
        numbers.whole(fmt::format("the start of block row {}", i), i == n ? blocks : lowest, highest)));
  }
  for (uint64_t k = 0; k < blocks; ++k)
    problem.column.push_back(static_cast<uint32_t>(numbers.whole(fmt::format("the column of block {}", k), 0, n - 1)));
  for (uint64_t k = 0; k < blocks; ++k) {
    numbers.whole("the number of a block", k, k);
    std::array<double, 9> &block = problem.blocks.emplace_back();
    for (uint64_t c = 0; c < 9; ++c) block[c % 3 * 3 + c / 3] = numbers.real(fmt::format("block {}", k));
  }
}

/* Sorts each contact's own block first, then ascending columns, because the order in which a row is summed must not
 * depend on the file. */
void order_rows(const Numbers &numbers, ContactProblem &problem)
{
  std::vector<uint32_t> order(problem.column.size());
  for (uint32_t k = 0; k < order.size(); ++k) order[k] = k;
  ContactProblem sorted = problem;
  for (uint32_t i = 0; i < problem.contacts; ++i) {
    const auto key = [&](uint32_t k) { return problem.column[k] == i ? 0u : problem.column[k] + 1u; };
    const auto first = order.begin() + problem.start[i], last = order.begin() + problem.start[i + 1];
    std::sort(first, last, [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    if (first == last || problem.column[*first] != i)
      numbers.refuse(fmt::format("contact {} has no block of its own in W", i));
    const auto twice = std::adjacent_find(first, last, [&](uint32_t a, uint32_t b) { return key(a) == key(b); });
    if (twice != last) numbers.refuse(fmt::format("contact {} has two blocks in column {}", i, problem.column[*twice]));
    for (int axis = 0; axis < 3; ++axis)
      if (const double own = problem.blocks[*first][static_cast<size_t>(4 * axis)];
          !(own > 0) || !std::isfinite(1 / round_to_float(own)))
        numbers.refuse(fmt::format("W[{0}][{0}] must be positive, and its inverse a 32-bit float; it is {1}",
                                   3 * i + static_cast<uint32_t>(axis), own));
  }
  for (size_t k = 0; k < order.size(); ++k) {
    sorted.column[k] = problem.column[order[k]];
    sorted.blocks[k] = problem.blocks[order[k]];
  }
  problem = std::move(sorted);
}

} // namespace

ContactProblem read_contact_problem(const std::string &path)
{
  Numbers numbers(path);
  ContactProblem problem;
  numbers.whole("the dimension", 3, 3);
  problem.contacts = static_cast<uint32_t>(numbers.whole("the number of contacts", 1, most_contacts));
  const uint64_t storage = numbers.whole("the storage of W", 0, 1), size = 3 * uint64_t{problem.contacts};
  numbers.whole("the number of rows of W", size, size);
  numbers.whole("the number of columns of W", size, size);
  if (storage == 0) read_dense(numbers, problem);
  else read_block_rows(numbers, problem);
  order_rows(numbers, problem);
  for (uint64_t i = 0; i < problem.contacts; ++i) {
    std::array<double, 3> &q = problem.free_velocity.emplace_back();
    for (size_t axis = 0; axis < 3; ++axis) q[axis] = numbers.real(fmt::format("q[{}]", 3 * i + axis));
  }
  for (uint64_t i = 0; i < problem.contacts; ++i) {
    problem.friction.push_back(numbers.real(fmt::format("the friction coefficient of contact {}", i)));
    if (problem.friction.back() < 0)
      numbers.refuse(fmt::format("the friction coefficient of contact {} is negative", i));
  }
  /* Some writers append a flag. */
  if (!numbers.at_end()) numbers.whole("what follows the last friction coefficient", 0, 1);
  if (!numbers.at_end()) numbers.refuse("the problem has ended; nothing may follow the friction coefficients");
  return problem;
}

} // namespace tandem
