/* lanes_portable.h - the operations of lanes_x86.h, one lane at a time, for other processors. */
#pragma once

SHARED real square_root(real x)
{
  for (int lane = 0; lane < width; ++lane) x.v[lane] = __builtin_sqrtf(x.v[lane]);
  return x;
}
SHARED uint32_t lane_bits(mask m)
{
  uint32_t bits = 0;
  for (int lane = 0; lane < width; ++lane) bits |= (m.v[lane] ? 1u : 0u) << lane;
  return bits;
}
SHARED bool any_of(mask m)
{
  int32_t all = 0;
  for (int lane = 0; lane < width; ++lane) all |= m.v[lane];
  return all != 0;
}
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
SHARED bool all_of(mask m) { return !any_of(!m); }

/* The records of all lanes, in lane order. */
struct quarters {
  float of[width][4];
};
SHARED quarters gather_quarters(const float4 *const *lanes)
{
  quarters q;
  for (int lane = 0; lane < width; ++lane) __builtin_memcpy(q.of[lane], lanes[lane], sizeof q.of[lane]);
  return q;
}
SHARED void scatter_quarters(float4 *const *lanes, quarters q)
{
  for (int lane = 0; lane < width; ++lane) __builtin_memcpy(lanes[lane], q.of[lane], sizeof q.of[lane]);
}
SHARED quarters load_in_order(const float4 *from)
{
  quarters q;
  __builtin_memcpy(&q, from, sizeof q);
  return q;
}
SHARED void store_in_order(float4 *to, quarters q) { __builtin_memcpy(to, &q, sizeof q); }
SHARED vec4 transpose(quarters q)
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
SHARED quarters transpose(vec4 value)
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
