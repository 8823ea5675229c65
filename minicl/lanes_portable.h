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
static inline vec4 load_transposed(const float *const *lanes)
{
  vec4 r;
  for (int lane = 0; lane < width; ++lane) {
    r.x.v[lane] = lanes[lane][0];
    r.y.v[lane] = lanes[lane][1];
    r.z.v[lane] = lanes[lane][2];
    r.w.v[lane] = lanes[lane][3];
  }
  return r;
}
static inline void store_transposed(float *const *lanes, vec4 value)
{
  for (int lane = 0; lane < width; ++lane) {
    lanes[lane][0] = value.x.v[lane];
    lanes[lane][1] = value.y.v[lane];
    lanes[lane][2] = value.z.v[lane];
    lanes[lane][3] = value.w.v[lane];
  }
}
