/* lanes.h - real, uint_lanes and mask over TANDEM_LANES = 4, 8 or 16 items of one kernel.
 *
 * The file gives the names of shared/real.h for 4 to 16 items an instruction. On one thread of a Xeon with AVX-512,
 * boxes collide 6 times as fast with 16 lanes as with one (`tandem bench narrowphase --pairs box-box --on
 * tbb:threads=1,lanes=16`). Lanes never mix and each operation rounds as the scalar one does, so the bits are equal.
 * The file is included inside the namespace of its width, after platform.h.
 */
#pragma once

constexpr int width = TANDEM_LANES;

/* A function that takes wide vectors on the stack needs an aligned stack, and GCC 12 has been seen to call one from a
 * frame that is not aligned. All such functions are therefore inlined. */
#undef SHARED
#define SHARED static inline __attribute__((always_inline))
/* But for functions that go over links of a tree, or call those that do: inlined wherever they are called, they take
 * GCC three quarters of the compile time of a width. Vectors among their parameters and results are single ones, which
 * stand in registers; others they take by pointers. They begin with a copy of the tree, because GCC keeps in registers
 * what no other function knows, and would load it again after each store. */
#undef CALLED
#define CALLED static __attribute__((noinline, unused))

typedef float float_vector __attribute__((vector_size(4 * TANDEM_LANES)));
typedef int32_t int_vector __attribute__((vector_size(4 * TANDEM_LANES)));
typedef uint32_t uint_vector __attribute__((vector_size(4 * TANDEM_LANES)));

struct mask {
  int_vector v; /* all ones or all zeros a lane */
};

struct real {
  float_vector v;
  real() = default;
  real(float x) : v(float_vector{} + x) {}
  explicit real(float_vector x) : v(x) {}
};

struct uint_lanes {
  uint_vector v;
  uint_lanes() = default;
  uint_lanes(uint32_t x) : v(uint_vector{} + x) {}
  explicit uint_lanes(uint_vector x) : v(x) {}
};

struct vec4 {
  real x, y, z, w;
};

SHARED real operator+(real a, real b) { return real(a.v + b.v); }
SHARED real operator-(real a, real b) { return real(a.v - b.v); }
SHARED real operator*(real a, real b) { return real(a.v * b.v); }
SHARED real operator/(real a, real b) { return real(a.v / b.v); }
SHARED real operator-(real a) { return real(-a.v); }
SHARED real &operator+=(real &a, real b) { return a = a + b; }
SHARED real &operator-=(real &a, real b) { return a = a - b; }
SHARED real &operator*=(real &a, real b) { return a = a * b; }
SHARED mask operator<(real a, real b) { return {a.v < b.v}; }
SHARED mask operator>(real a, real b) { return {a.v > b.v}; }
SHARED mask operator<=(real a, real b) { return {a.v <= b.v}; }
SHARED mask operator>=(real a, real b) { return {a.v >= b.v}; }
SHARED mask operator==(real a, real b) { return {a.v == b.v}; }
SHARED mask operator!=(real a, real b) { return {a.v != b.v}; }

SHARED uint_lanes operator+(uint_lanes a, uint_lanes b) { return uint_lanes(a.v + b.v); }
SHARED uint_lanes operator-(uint_lanes a, uint_lanes b) { return uint_lanes(a.v - b.v); }
SHARED uint_lanes operator*(uint_lanes a, uint_lanes b) { return uint_lanes(a.v * b.v); }
SHARED uint_lanes operator&(uint_lanes a, uint_lanes b) { return uint_lanes(a.v & b.v); }
SHARED uint_lanes operator|(uint_lanes a, uint_lanes b) { return uint_lanes(a.v | b.v); }
SHARED uint_lanes operator^(uint_lanes a, uint_lanes b) { return uint_lanes(a.v ^ b.v); }
SHARED uint_lanes operator<<(uint_lanes a, uint_lanes b) { return uint_lanes(a.v << b.v); }
SHARED uint_lanes operator>>(uint_lanes a, uint_lanes b) { return uint_lanes(a.v >> b.v); }
SHARED mask operator<(uint_lanes a, uint_lanes b) { return {(int_vector)(a.v < b.v)}; }
SHARED mask operator>(uint_lanes a, uint_lanes b) { return {(int_vector)(a.v > b.v)}; }
SHARED mask operator<=(uint_lanes a, uint_lanes b) { return {(int_vector)(a.v <= b.v)}; }
SHARED mask operator>=(uint_lanes a, uint_lanes b) { return {(int_vector)(a.v >= b.v)}; }
SHARED mask operator==(uint_lanes a, uint_lanes b) { return {(int_vector)(a.v == b.v)}; }
SHARED mask operator!=(uint_lanes a, uint_lanes b) { return {(int_vector)(a.v != b.v)}; }

SHARED mask operator&(mask a, mask b) { return {a.v & b.v}; }
SHARED mask operator|(mask a, mask b) { return {a.v | b.v}; }
SHARED mask operator!(mask a) { return {~a.v}; }

SHARED real choose(mask m, real a, real b) { return real(m.v ? a.v : b.v); }
SHARED uint_lanes choose(mask m, uint_lanes a, uint_lanes b) { return uint_lanes(m.v ? a.v : b.v); }
SHARED mask choose(mask m, mask a, mask b) { return {(m.v & a.v) | (~m.v & b.v)}; }

/* The items first, first + 1, ...; memory indexed by it is consecutive. If there are fewer than lanes, the last one is
 * that of all lanes beyond it, too. */
struct item_index {
  uint32_t first;
  uint32_t items = TANDEM_LANES;
  bool fills_lanes() const { return __builtin_expect(items == TANDEM_LANES, 1); }
  operator uint_lanes() const
  {
    uint_lanes i;
    for (uint32_t lane = 0; lane < TANDEM_LANES; ++lane) i.v[lane] = first + std::min(lane, items - 1);
    return i;
  }
};
SHARED item_index operator+(item_index i, uint32_t offset) { return {i.first + offset, i.items}; }
SHARED item_index operator+(uint32_t offset, item_index i) { return i + offset; }
SHARED uint_lanes operator*(item_index i, uint32_t factor) { return uint_lanes(i) * uint_lanes(factor); }

#define FOR_EACH_LISTED(k, n) for (uint k = 0; k < (uint)(n); k += TANDEM_LANES)
/* Lanes past the end have the last item of all. */
SHARED uint_lanes listed_item(const uint *list, uint n, uint k)
{
  uint_lanes i;
  for (uint lane = 0; lane < (uint)width; ++lane) i.v[lane] = list[k + lane < n ? k + lane : n - 1];
  return i;
}
SHARED mask is_listed(uint n, uint k) { return uint_lanes(item_index{k}) < uint_lanes(n); }

/* A function with such a parameter is a template. */
#define any_index auto

SHARED real to_real(uint_lanes x) { return real(__builtin_convertvector((int_vector)x.v, float_vector)); }
SHARED uint_lanes real_bits(real x) { return uint_lanes((uint_vector)x.v); }
SHARED real real_of_bits(uint_lanes bits) { return real((float_vector)bits.v); }
SHARED real int_to_real(uint_lanes x) { return to_real(x); }
SHARED uint_lanes to_uint(real x) { return uint_lanes((uint_vector) __builtin_convertvector(x.v, int_vector)); }

#if defined(__x86_64__)
#include "minicl/lanes_x86.h"
#else
#include "minicl/lanes_portable.h"
#endif

#ifndef LOADS_FIRST_OF_RUN
/* The first words of a run, of which the last one is in all lanes beyond it, too; and back. */
SHARED uint_vector load_first(const void *from, uint32_t items)
{
  uint_vector run;
  for (uint32_t lane = 0; lane < TANDEM_LANES; ++lane) {
    uint word;
    __builtin_memcpy(&word, (const char *)from + sizeof word * std::min(lane, items - 1), sizeof word);
    run[lane] = word;
  }
  return run;
}
template <class Vector> SHARED void store_first(void *to, uint32_t items, Vector value)
{
  __builtin_memcpy(to, &value, sizeof(uint) * items);
}
#endif

SHARED void store_real(memory_real *to, uint_lanes i, real value)
{
  for (int lane = 0; lane < width; ++lane) to[i.v[lane]] = value.v[lane];
}
SHARED void store_uint(uint *to, uint_lanes i, uint_lanes value)
{
  for (int lane = 0; lane < width; ++lane) to[i.v[lane]] = value.v[lane];
}
SHARED void store_uint_if(mask m, uint *to, uint_lanes i, uint_lanes value)
{
  for (int lane = 0; lane < width; ++lane)
    if (m.v[lane]) to[i.v[lane]] = value.v[lane];
}
SHARED void atomic_min_if(mask m, uint *to, uint at, uint_lanes value)
{
  for (int lane = 0; lane < width; ++lane)
    if (m.v[lane]) atomic_min_uint(to + at, value.v[lane]);
}
SHARED void atomic_max_if(mask m, uint *to, uint_lanes at, uint_lanes value)
{
  for (int lane = 0; lane < width; ++lane)
    if (m.v[lane]) atomic_max_uint(to + at.v[lane], value.v[lane]);
}
/* The lanes that have the mask are mostly few, so the others are not looked at. */
SHARED void atomic_max_both_if(mask m, uint *to, uint_lanes at, uint_lanes first, uint_lanes second)
{
  for (uint32_t left = lane_bits(m); left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    atomic_max_uint(to + at.v[lane], first.v[lane]);
    atomic_max_uint(to + at.v[lane] + 1, second.v[lane]);
  }
}
SHARED void atomic_add_if(mask m, uint *to, uint_lanes at, uint value)
{
  for (int lane = 0; lane < width; ++lane)
    if (m.v[lane]) atomic_add_uint(to + at.v[lane], value);
}
SHARED void atomic_clear_if(mask m, uint *to, uint_lanes at)
{
  for (uint32_t left = lane_bits(m); left != 0; left &= left - 1)
    atomic_min_uint(to + at.v[__builtin_ctz(left)], 0u);
}

SHARED real load_real(const memory_real *from, item_index i)
{
  if (!i.fills_lanes()) return real((float_vector)load_first(from + i.first, i.items));
  real r;
  __builtin_memcpy(&r.v, from + i.first, sizeof r.v);
  return r;
}
SHARED void store_real(memory_real *to, item_index i, real value)
{
  if (!i.fills_lanes()) return store_first(to + i.first, i.items, value.v);
  __builtin_memcpy(to + i.first, &value.v, sizeof value.v);
}
SHARED void store_listed_real_if(mask m, memory_real *to, uint_lanes i, real value)
{
  const item_index run{i.v[0]};
  if (all_of(m & (i == uint_lanes(run)))) return store_real(to, run, value);
  for (int lane = 0; lane < width; ++lane)
    if (m.v[lane]) to[i.v[lane]] = value.v[lane];
}
SHARED uint_lanes load_uint(const uint *from, item_index i)
{
  if (!i.fills_lanes()) return uint_lanes((uint_vector)load_first(from + i.first, i.items));
  uint_lanes r;
  __builtin_memcpy(&r.v, from + i.first, sizeof r.v);
  return r;
}
SHARED void store_uint(uint *to, item_index i, uint_lanes value)
{
  if (!i.fills_lanes()) return store_first(to + i.first, i.items, value.v);
  __builtin_memcpy(to + i.first, &value.v, sizeof value.v);
}
SHARED void store_uint_if(mask m, uint *to, item_index i, uint_lanes value)
{
  store_uint_if(m, to, uint_lanes(i), value);
}
SHARED void store_listed_uint_if(mask m, uint *to, uint_lanes i, uint_lanes value)
{
  const item_index run{i.v[0]};
  if (all_of(m & (i == uint_lanes(run)))) store_uint(to, run, value);
  else store_uint_if(m, to, i, value);
}

struct lane_numbers {
  uint32_t of[width];
};
SHARED lane_numbers numbers_of(uint_lanes i)
{
  lane_numbers n;
  __builtin_memcpy(n.of, &i.v, sizeof n.of);
  return n;
}
/* A record is loaded or stored whole, 16 bytes a lane, and transposed in registers. */
SHARED vec4 load_float4(const float4 *from, uint_lanes i)
{
  const lane_numbers at = numbers_of(i);
  const float4 *lanes[width];
  for (int lane = 0; lane < width; ++lane) lanes[lane] = from + at.of[lane];
  return transpose(gather_quarters(lanes));
}
SHARED void store_float4(float4 *to, uint_lanes i, vec4 value)
{
  const lane_numbers at = numbers_of(i);
  float4 *lanes[width];
  for (int lane = 0; lane < width; ++lane) lanes[lane] = to + at.of[lane];
  scatter_quarters(lanes, transpose(value));
}
SHARED vec4 load_float4(const float4 *from, item_index i)
{
  if (i.fills_lanes()) return transpose(load_in_order(from + i.first));
  const float4 *lanes[width];
  for (uint32_t lane = 0; lane < TANDEM_LANES; ++lane) lanes[lane] = from + i.first + std::min(lane, i.items - 1);
  return transpose(gather_quarters(lanes));
}
SHARED void store_float4(float4 *to, item_index i, vec4 value)
{
  if (i.fills_lanes()) return store_in_order(to + i.first, transpose(value));
  float4 *lanes[width];
  for (uint32_t lane = 0; lane < TANDEM_LANES; ++lane) lanes[lane] = to + i.first + std::min(lane, i.items - 1);
  scatter_quarters(lanes, transpose(value));
}
/* Lanes that must not write store to a spare float4, because many lanes and threads share a body that cannot move. */
SHARED void store_float4_if(mask m, float4 *to, uint_lanes i, vec4 value)
{
  const lane_numbers at = numbers_of(i);
  float4 spare;
  float4 *lanes[width];
  for (int lane = 0; lane < width; ++lane) lanes[lane] = m.v[lane] ? to + at.of[lane] : &spare;
  scatter_quarters(lanes, transpose(value));
}
SHARED void store_float4_if(mask m, float4 *to, item_index i, vec4 value)
{
  if (all_of(m)) store_float4(to, i, value);
  else store_float4_if(m, to, uint_lanes(i), value);
}
SHARED void store_listed_row_if(mask m, float4 *to, uint_lanes i, vec4 value)
{
  const item_index run{i.v[0]};
  if (all_of(m & (i == uint_lanes(run)))) store_float4(to, run, value);
  else store_float4_if(m, to, i, value);
}

#include "minicl/lanes_of_trees.h"
