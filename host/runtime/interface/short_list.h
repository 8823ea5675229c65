/* short_list.h - a list with a fixed capacity that is stored in place, so that a launch allocates nothing. */
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <vector>

#include <tandem/error.h>

namespace tandem {

/* Holds at most `most` elements; throws InputError if more are given. */
template <class T, size_t most> class ShortList {
public:
  ShortList() = default;
  ShortList(std::initializer_list<T> given) : ShortList(std::span<const T>(given.begin(), given.size())) {}
  ShortList(std::span<const T> given) : size_(given.size())
  {
    if (size_ > most) throw InputError("a launch gives more buffers or values than any kernel takes");
    std::copy(given.begin(), given.end(), values_.begin());
  }

  ShortList(const std::vector<T> &given) : ShortList(std::span<const T>(given)) {}

  size_t size() const { return size_; }
  const T *begin() const { return values_.data(); }
  const T *end() const { return values_.data() + size_; }
  const T &at(size_t i) const
  {
    if (i >= size_) throw std::out_of_range("a launch gives fewer buffers or values than its kernel's row asks for");
    return values_[i];
  }

private:
  std::array<T, most> values_{};
  size_t size_ = 0;
};

} // namespace tandem
