/* lanes_x86.h - the operations that the compiler's vector types lack: square roots, gathers and the 4 x width
 * transposes between records in memory and lanes in registers, for SSE2, AVX2 and AVX-512.
 *
 *   memory, one record a lane            registers
 *   lane 0:  x0 y0 z0 w0                 x: x0 x1 x2 x3
 *   lane 1:  x1 y1 z1 w1        <-->     y: y0 y1 y2 y3
 *   lane 2:  x2 y2 z2 w2                 z: z0 z1 z2 z3
 *   lane 3:  x3 y3 z3 w3                 w: w0 w1 w2 w3
 */
#pragma once

#if TANDEM_LANES == 16
SHARED real square_root(real x) { return real((float_vector)_mm512_maskz_sqrt_ps(0xffff, (__m512)x.v)); }
SHARED uint32_t lane_bits(mask m) { return _mm512_movepi32_mask((__m512i)m.v); }
SHARED bool any_of(mask m) { return lane_bits(m) != 0; }
SHARED bool all_of(mask m) { return lane_bits(m) == 0xffff; }

typedef __m512 quarter_rows; /* four records: of lanes k, k + 4, k + 8, k + 12 */
SHARED quarter_rows load_quarter(const float4 *const *lanes, int k)
{
  __m512 rows = _mm512_castps128_ps512(_mm_load_ps(&lanes[k]->x));
  rows = _mm512_insertf32x4(rows, _mm_load_ps(&lanes[k + 4]->x), 1);
  rows = _mm512_insertf32x4(rows, _mm_load_ps(&lanes[k + 8]->x), 2);
  return _mm512_insertf32x4(rows, _mm_load_ps(&lanes[k + 12]->x), 3);
}
SHARED void store_quarter(float4 *const *lanes, int k, quarter_rows rows)
{
  _mm_store_ps(&lanes[k]->x, _mm512_castps512_ps128(rows));
  _mm_store_ps(&lanes[k + 4]->x, _mm512_extractf32x4_ps(rows, 1));
  _mm_store_ps(&lanes[k + 8]->x, _mm512_extractf32x4_ps(rows, 2));
  _mm_store_ps(&lanes[k + 12]->x, _mm512_extractf32x4_ps(rows, 3));
}
SHARED quarter_rows unpack_low(quarter_rows a, quarter_rows b) { return _mm512_unpacklo_ps(a, b); }
SHARED quarter_rows unpack_high(quarter_rows a, quarter_rows b) { return _mm512_unpackhi_ps(a, b); }
SHARED quarter_rows halves_low(quarter_rows a, quarter_rows b) { return _mm512_shuffle_ps(a, b, 0x44); }
SHARED quarter_rows halves_high(quarter_rows a, quarter_rows b) { return _mm512_shuffle_ps(a, b, 0xee); }

#elif TANDEM_LANES == 8
SHARED real square_root(real x) { return real((float_vector)_mm256_sqrt_ps((__m256)x.v)); }
SHARED uint32_t lane_bits(mask m) { return _mm256_movemask_ps((__m256)m.v); }
SHARED bool any_of(mask m) { return lane_bits(m) != 0; }
SHARED bool all_of(mask m) { return lane_bits(m) == 0xff; }

typedef __m256 quarter_rows; /* two records: of lanes k and k + 4 */
SHARED quarter_rows load_quarter(const float4 *const *lanes, int k)
{
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(&lanes[k]->x)), _mm_load_ps(&lanes[k + 4]->x), 1);
}
SHARED void store_quarter(float4 *const *lanes, int k, quarter_rows rows)
{
  _mm_store_ps(&lanes[k]->x, _mm256_castps256_ps128(rows));
  _mm_store_ps(&lanes[k + 4]->x, _mm256_extractf128_ps(rows, 1));
}
SHARED quarter_rows unpack_low(quarter_rows a, quarter_rows b) { return _mm256_unpacklo_ps(a, b); }
SHARED quarter_rows unpack_high(quarter_rows a, quarter_rows b) { return _mm256_unpackhi_ps(a, b); }
SHARED quarter_rows halves_low(quarter_rows a, quarter_rows b) { return _mm256_shuffle_ps(a, b, 0x44); }
SHARED quarter_rows halves_high(quarter_rows a, quarter_rows b) { return _mm256_shuffle_ps(a, b, 0xee); }

#else
SHARED real square_root(real x) { return real((float_vector)_mm_sqrt_ps((__m128)x.v)); }
SHARED uint32_t lane_bits(mask m) { return _mm_movemask_ps((__m128)m.v); }
SHARED bool any_of(mask m) { return lane_bits(m) != 0; }
SHARED bool all_of(mask m) { return lane_bits(m) == 0xf; }

typedef __m128 quarter_rows; /* one record */
SHARED quarter_rows load_quarter(const float4 *const *lanes, int k) { return _mm_load_ps(&lanes[k]->x); }
SHARED void store_quarter(float4 *const *lanes, int k, quarter_rows rows) { _mm_store_ps(&lanes[k]->x, rows); }
SHARED quarter_rows unpack_low(quarter_rows a, quarter_rows b) { return _mm_unpacklo_ps(a, b); }
SHARED quarter_rows unpack_high(quarter_rows a, quarter_rows b) { return _mm_unpackhi_ps(a, b); }
SHARED quarter_rows halves_low(quarter_rows a, quarter_rows b) { return _mm_movelh_ps(a, b); }
SHARED quarter_rows halves_high(quarter_rows a, quarter_rows b) { return _mm_movehl_ps(b, a); }
#endif

/* The address sanitizer does not check gathers, so in its builds each lane loads by itself. */
#if TANDEM_LANES == 4 || defined(__SANITIZE_ADDRESS__)
SHARED real load_real(const memory_real *from, uint_lanes i)
{
  real r;
  for (int lane = 0; lane < width; ++lane) r.v[lane] = from[i.v[lane]];
  return r;
}
SHARED uint_lanes load_uint(const uint *from, uint_lanes i)
{
  uint_lanes r;
  for (int lane = 0; lane < width; ++lane) r.v[lane] = from[i.v[lane]];
  return r;
}
#elif TANDEM_LANES == 8
SHARED real load_real(const memory_real *from, uint_lanes i)
{
  return real((float_vector)_mm256_i32gather_ps(from, (__m256i)i.v, 4));
}
SHARED uint_lanes load_uint(const uint *from, uint_lanes i)
{
  return uint_lanes((uint_vector)_mm256_i32gather_epi32((const int *)from, (__m256i)i.v, 4));
}
#else
SHARED real load_real(const memory_real *from, uint_lanes i)
{
  return real((float_vector)_mm512_i32gather_ps((__m512i)i.v, from, 4));
}
SHARED uint_lanes load_uint(const uint *from, uint_lanes i)
{
  return uint_lanes((uint_vector)_mm512_i32gather_epi32((__m512i)i.v, from, 4));
}
#endif

struct quarters {
  quarter_rows a, b, c, d; /* of lanes 0, 1, 2, 3 and every fourth after each */
};
SHARED quarters gather_quarters(const float4 *const *lanes)
{
  return {load_quarter(lanes, 0), load_quarter(lanes, 1), load_quarter(lanes, 2), load_quarter(lanes, 3)};
}
SHARED void scatter_quarters(float4 *const *lanes, quarters q)
{
  store_quarter(lanes, 0, q.a);
  store_quarter(lanes, 1, q.b);
  store_quarter(lanes, 2, q.c);
  store_quarter(lanes, 3, q.d);
}

SHARED vec4 transpose(quarters q)
{
  const quarter_rows xy01 = unpack_low(q.a, q.b), zw01 = unpack_high(q.a, q.b);
  const quarter_rows xy23 = unpack_low(q.c, q.d), zw23 = unpack_high(q.c, q.d);
  return {real((float_vector)halves_low(xy01, xy23)), real((float_vector)halves_high(xy01, xy23)),
          real((float_vector)halves_low(zw01, zw23)), real((float_vector)halves_high(zw01, zw23))};
}
SHARED quarters transpose(vec4 value)
{
  const quarter_rows x = (quarter_rows)value.x.v, y = (quarter_rows)value.y.v;
  const quarter_rows z = (quarter_rows)value.z.v, w = (quarter_rows)value.w.v;
  const quarter_rows xy_low = unpack_low(x, y), xy_high = unpack_high(x, y);
  const quarter_rows zw_low = unpack_low(z, w), zw_high = unpack_high(z, w);
  return {halves_low(xy_low, zw_low), halves_high(xy_low, zw_low), halves_low(xy_high, zw_high),
          halves_high(xy_high, zw_high)};
}

/* Consecutive records: whole registers hold consecutive records, which are dealt out to quarters. */
#if TANDEM_LANES == 16
SHARED __m512 fourths_in_memory(const float4 *from)
{
  __m512 rows = _mm512_castps128_ps512(_mm_loadu_ps(&from->x));
  rows = _mm512_insertf32x4(rows, _mm_loadu_ps(&from[4].x), 1);
  rows = _mm512_insertf32x4(rows, _mm_loadu_ps(&from[8].x), 2);
  return _mm512_insertf32x4(rows, _mm_loadu_ps(&from[12].x), 3);
}
SHARED quarters load_in_order(const float4 *from)
{
  return {fourths_in_memory(from), fourths_in_memory(from + 1), fourths_in_memory(from + 2),
          fourths_in_memory(from + 3)};
}
SHARED void store_fourths(float4 *to, __m512 rows)
{
  _mm_storeu_ps(&to->x, _mm512_castps512_ps128(rows));
  _mm_storeu_ps(&to[4].x, _mm512_extractf32x4_ps(rows, 1));
  _mm_storeu_ps(&to[8].x, _mm512_extractf32x4_ps(rows, 2));
  _mm_storeu_ps(&to[12].x, _mm512_extractf32x4_ps(rows, 3));
}
SHARED void store_in_order(float4 *to, quarters q)
{
  store_fourths(to, q.a);
  store_fourths(to + 1, q.b);
  store_fourths(to + 2, q.c);
  store_fourths(to + 3, q.d);
}
#elif TANDEM_LANES == 8
/* From memory, a half is inserted by the ports of loads and arithmetic; between registers, by the one that shuffles. */
SHARED __m256 halves_in_memory(const float4 *low, const float4 *high)
{
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(&low->x)), _mm_loadu_ps(&high->x), 1);
}
SHARED quarters load_in_order(const float4 *from)
{
  return {halves_in_memory(from, from + 4), halves_in_memory(from + 1, from + 5), halves_in_memory(from + 2, from + 6),
          halves_in_memory(from + 3, from + 7)};
}
SHARED void store_halves(float4 *low, float4 *high, __m256 rows)
{
  _mm_storeu_ps(&low->x, _mm256_castps256_ps128(rows));
  _mm_storeu_ps(&high->x, _mm256_extractf128_ps(rows, 1));
}
SHARED void store_in_order(float4 *to, quarters q)
{
  store_halves(to, to + 4, q.a);
  store_halves(to + 1, to + 5, q.b);
  store_halves(to + 2, to + 6, q.c);
  store_halves(to + 3, to + 7, q.d);
}
#else
SHARED quarters load_in_order(const float4 *from)
{
  return {_mm_loadu_ps(&from->x), _mm_loadu_ps(&from[1].x), _mm_loadu_ps(&from[2].x), _mm_loadu_ps(&from[3].x)};
}
SHARED void store_in_order(float4 *to, quarters q)
{
  _mm_storeu_ps(&to->x, q.a);
  _mm_storeu_ps(&to[1].x, q.b);
  _mm_storeu_ps(&to[2].x, q.c);
  _mm_storeu_ps(&to[3].x, q.d);
}
#endif

/* The first words of a run, as in lanes.h. A gather takes several times as long as these. */
#if TANDEM_LANES > 4 && !defined(__SANITIZE_ADDRESS__)
#define LOADS_FIRST_OF_RUN
#endif
#if defined(LOADS_FIRST_OF_RUN) && TANDEM_LANES == 16
SHARED __m512i load_first(const void *from, uint32_t items)
{
  const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m512i run = _mm512_maskz_loadu_epi32((__mmask16)((1u << items) - 1), from);
  return _mm512_maskz_permutexvar_epi32(0xffff,
                                        _mm512_maskz_min_epu32(0xffff, lanes, _mm512_set1_epi32((int)items - 1)), run);
}
template <class Vector> SHARED void store_first(void *to, uint32_t items, Vector value)
{
  _mm512_mask_storeu_epi32(to, (__mmask16)((1u << items) - 1), (__m512i)value);
}
#elif defined(LOADS_FIRST_OF_RUN)
SHARED __m256i first_of_run(uint32_t items)
{
  return _mm256_cmpgt_epi32(_mm256_set1_epi32((int)items), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
}
SHARED __m256i load_first(const void *from, uint32_t items)
{
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7),
                run = _mm256_maskload_epi32((const int *)from, first_of_run(items));
  return _mm256_permutevar8x32_epi32(run, _mm256_min_epu32(lanes, _mm256_set1_epi32((int)items - 1)));
}
template <class Vector> SHARED void store_first(void *to, uint32_t items, Vector value)
{
  _mm256_maskstore_epi32((int *)to, first_of_run(items), (__m256i)value);
}
#endif
