/* arena.h - a block of memory that is taken piece by piece and given back as a whole, for work that is done again and
 * again and must not allocate each time.
 *
 * Whoever uses an arena knows how much it takes and reserves that first. Only reserve() allocates, so it is the only
 * call that fails for want of memory.
 */
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <type_traits>

namespace tandem {

class Arena {
public:
  /* Makes room for pieces of `bytes` together and ends all pieces taken before. If there is not enough memory
   * (std::bad_alloc), the arena is unchanged. */
  void reserve(size_t bytes)
  {
    if (bytes > capacity_) {
      block_ = std::make_unique_for_overwrite<std::byte[]>(bytes);
      capacity_ = bytes;
    }
    clear();
  }

  /* Ends all pieces, and keeps the memory. */
  void clear() { taken_ = 0; }

  /* Returns `count` elements of undefined value. Throws std::logic_error if less is left than they need. */
  template <class T> T *take(size_t count)
  {
    static_assert(std::is_trivially_destructible_v<T>, "nothing destroys what lies in an arena");
    static_assert(alignof(T) <= unit);
    const size_t bytes = bytes_of<T>(count);
    if (bytes > capacity_ - taken_) throw std::logic_error("an arena was reserved for less than is taken from it");
    T *const piece = reinterpret_cast<T *>(block_.get() + taken_);
    std::uninitialized_default_construct_n(piece, count);
    taken_ += bytes;
    return piece;
  }

  /* The bytes that take<T>(count) needs. */
  template <class T> static constexpr size_t bytes_of(size_t count)
  {
    return (count * sizeof(T) + unit - 1) / unit * unit;
  }

private:
  static constexpr size_t unit = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

  std::unique_ptr<std::byte[]> block_;
  size_t capacity_ = 0, taken_ = 0;
};

} // namespace tandem
