/* reserve_more.h - room for a few more elements of a list that grows again and again. */
#pragma once

#include <algorithm>
#include <cstddef>

namespace tandem {

/* Ensures that so many more elements can be added without failing. Capacity at least doubles where it grows, because
 * reserving just what is needed would copy the list at each call. */
template <class List> void reserve_more(List &list, size_t more)
{
  const size_t needed = list.size() + more;
  if (list.capacity() < needed) list.reserve(std::max(needed, 2 * list.capacity()));
}

} // namespace tandem
