/* setting_rows.h - the tables behind the choices of settings: names, help, parsing and messages all follow from them.
 *
 * Each table has one row for each choice, in the order of its enum; those of solvers, broadphases and batchers are
 * beside their files. If kernels read a setting, its rows contain the code for it (shared/body_codes.h). */
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

#include <tandem/settings.h>

#include "host/scene/hull_buffers.h"

namespace tandem {

/* Checks for a table that each row is at the index of its choice. */
template <class Row, size_t count> consteval bool are_in_order(const Row (&rows)[count])
{
  for (size_t k = 0; k < count; ++k)
    if (static_cast<size_t>(rows[k].choice) != k) return false;
  return true;
}

/* Throws std::logic_error if there is none, because settings are validated before. */
template <class Row, class T> const Row &row_in(std::span<const Row> rows, T choice)
{
  if (static_cast<size_t>(choice) >= rows.size()) throw std::logic_error("a setting is none of the values of its enum");
  return rows[static_cast<size_t>(choice)];
}

struct BoundsRow {
  Bounds choice;
  const char *name;
};

struct MidphaseRow {
  Midphase choice;
  const char *name;
};

struct NarrowphaseRow {
  Narrowphase choice;
  const char *name;
  uint32_t code; /* CONVEX_ */
};

struct SupportRow {
  Support choice;
  const char *name;
  uint32_t code; /* SUPPORT_ */
};

/* The method code of the kernels of convex shapes: CONVEX_ in the low byte, SUPPORT_ in the next. */
TANDEM_API uint32_t narrowphase_method(const Settings &settings);
HullMaps hull_maps(const Settings &settings);

} // namespace tandem
