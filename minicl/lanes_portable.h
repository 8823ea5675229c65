/* lanes_portable.h - the operations of lanes_x86.h one lane at a time, for other processors. */
#pragma once

static inline real square_root(real x)
{
  for (int lane = 0; lane < width; ++lane) x.v[lane] = __builtin_sqrtf(x.v[lane]);
  return x;
}
static inline bool any_of(mask m)
{
  int32_t all = 0;
  for (int lane = 0; lane < width; ++lane) all |= m.v[lane];
  return all != 0;
}
static inline real load_real(const memory_real *from, natural i)
{
  real r;
  for (int lane = 0; lane < width; ++lane) r.v[lane] = from[i.v[lane]];
  return r;
}
static inline natural load_natural(const uint *from, natural i)
{
  natural r;
  for (int lane = 0; lane < width; ++lane) r.v[lane] = from[i.v[lane]];
  return r;
}
static inline bool all_of(mask m) { return !any_of(!m); }

/* The records of all lanes, in lane order. */
struct quarters {
  float of[width][4];
};
static inline quarters gather_quarters(const float *const *lanes)
{
  quarters q;
  for (int lane = 0; lane < width; ++lane) __builtin_memcpy(q.of[lane], lanes[lane], sizeof q.of[lane]);
  return q;
}
static inline void scatter_quarters(float *const *lanes, quarters q)
{
  for (int lane = 0; lane < width; ++lane) __builtin_memcpy(lanes[lane], q.of[lane], sizeof q.of[lane]);
}
static inline quarters load_in_order(const float *from)
{
  quarters q;
  __builtin_memcpy(&q, from, sizeof q);
  return q;
}
static inline void store_in_order(float *to, quarters q) { __builtin_memcpy(to, &q, sizeof q); }
static inline vec4 transpose(quarters q)
{
  vec4 r;
  for (int lane = 0; lane < width; ++lane) {
    r.x.v[lane] = q.of[lane][0];
    r.y.v[lane] = q.of[lane][1];
    r.z.v[lane] = q.of[lane][2];
    r.w.v[lane] = q.of[lane][3];
  }
  return r;
}
static inline quarters transpose(vec4 value)
{
  quarters q;
  for (int lane = 0; lane < width; ++lane) {
    q.of[lane][0] = value.x.v[lane];
    q.of[lane][1] = value.y.v[lane];
    q.of[lane][2] = value.z.v[lane];
    q.of[lane][3] = value.w.v[lane];
  }
  return q;
}
