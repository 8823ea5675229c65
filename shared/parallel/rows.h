/* rows.h - moves whole rows of buffers: gathers listed rows to the start of another buffer, and scatters rows from
 * there to listed places. Rows that change places within a buffer are gathered first and scattered then, so that none
 * is overwritten before it is read. */
#ifndef TANDEM_SHARED_PARALLEL_ROWS_H
#define TANDEM_SHARED_PARALLEL_ROWS_H

#include "shared/real.h"

/* per_item: the elements of a row. part, elements: the first of them that is moved, and how many are; `result` of a
 * gather and `values` of a scatter have rows of these alone. */
SHARED void gather_float4s_item(GLOBAL const float4 *values, GLOBAL const uint *from, GLOBAL float4 *result,
                                uint per_item, uint part, uint elements, uint i)
{
  for (uint k = 0u; k < elements; ++k)
    store_float4(result, i * elements + k, load_float4(values, from[i] * per_item + part + k));
}
SHARED void scatter_float4s_item(GLOBAL const float4 *values, GLOBAL const uint *to, GLOBAL float4 *result,
                                 uint per_item, uint part, uint elements, uint i)
{
  for (uint k = 0u; k < elements; ++k)
    store_float4(result, to[i] * per_item + part + k, load_float4(values, i * elements + k));
}

SHARED void gather_uints_item(GLOBAL const uint *values, GLOBAL const uint *from, GLOBAL uint *result, uint per_item,
                              uint part, uint elements, uint i)
{
  for (uint k = 0u; k < elements; ++k) result[i * elements + k] = values[from[i] * per_item + part + k];
}
SHARED void scatter_uints_item(GLOBAL const uint *values, GLOBAL const uint *to, GLOBAL uint *result, uint per_item,
                               uint part, uint elements, uint i)
{
  for (uint k = 0u; k < elements; ++k) result[to[i] * per_item + part + k] = values[i * elements + k];
}

SHARED void gather_reals_item(GLOBAL const memory_real *values, GLOBAL const uint *from, GLOBAL memory_real *result,
                              uint per_item, uint part, uint elements, uint i)
{
  for (uint k = 0u; k < elements; ++k)
    store_real(result, i * elements + k, load_real(values, from[i] * per_item + part + k));
}
SHARED void scatter_reals_item(GLOBAL const memory_real *values, GLOBAL const uint *to, GLOBAL memory_real *result,
                               uint per_item, uint part, uint elements, uint i)
{
  for (uint k = 0u; k < elements; ++k)
    store_real(result, to[i] * per_item + part + k, load_real(values, i * elements + k));
}

#endif
