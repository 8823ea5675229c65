/* records.h - the packed fields of body records, and the loads that every stage shares. */
#ifndef TANDEM_SHARED_RECORDS_H
#define TANDEM_SHARED_RECORDS_H

#include "shared/counts.h"
#include "shared/features.h"
#include "shared/math.h"
#include "shared/parameters.h"

/* body_traits: bits 0-2 shape, 3-4 motion, 8-31 material */
enum { SHAPE_SPHERE = 0, SHAPE_BOX = 1, SHAPE_HALF_SPACE = 2 };
/* Half extent of what has no end, in metres. */
#define BOUNDLESS R(1e30)

enum { MOTION_FIXED = 0, MOTION_KINEMATIC = 1, MOTION_DYNAMIC = 2, MOTION_QUARANTINED = 3 };

SHARED natural shape_of(natural traits) { return traits & 7u; }
SHARED natural motion_of(natural traits) { return (traits >> 3u) & 3u; }
SHARED natural material_of(natural traits) { return traits >> 8u; }

/* Linear velocity and inverse mass, angular velocity: two rows, one 32-byte record. */
typedef struct {
  vec3 linear, angular;
  real inverse_mass;
} motion;

SHARED motion load_motion(GLOBAL const row *velocity, natural body)
{
  vec4 first = load_row(velocity, body * 2u), second = load_row(velocity, body * 2u + 1u);
  motion m = {xyz(first), xyz(second), first.w};
  return m;
}
SHARED void store_motion(GLOBAL row *velocity, natural body, motion m)
{
  store_row(velocity, body * 2u, extend(m.linear, m.inverse_mass));
  store_row(velocity, body * 2u + 1u, extend(m.angular, R(0.0)));
}
SHARED void store_motion_if(mask wanted, GLOBAL row *velocity, natural body, motion m)
{
  store_row_if(wanted, velocity, body * 2u, extend(m.linear, m.inverse_mass));
  store_row_if(wanted, velocity, body * 2u + 1u, extend(m.angular, R(0.0)));
}

SHARED symmetric3 load_inertia(GLOBAL const row *inertia, natural body)
{
  vec4 first = load_row(inertia, body * 2u), second = load_row(inertia, body * 2u + 1u);
  symmetric3 s = {first.x, first.y, first.z, first.w, second.x, second.y};
  return s;
}
SHARED void store_inertia(GLOBAL row *inertia, natural body, symmetric3 s)
{
  store_row(inertia, body * 2u, make_vec4(s.xx, s.yy, s.zz, s.xy));
  store_row(inertia, body * 2u + 1u, make_vec4(s.xz, s.yz, R(0.0), R(0.0)));
}
SHARED void store_inertia_if(mask wanted, GLOBAL row *inertia, natural body, symmetric3 s)
{
  store_row_if(wanted, inertia, body * 2u, make_vec4(s.xx, s.yy, s.zz, s.xy));
  store_row_if(wanted, inertia, body * 2u + 1u, make_vec4(s.xz, s.yz, R(0.0), R(0.0)));
}

/* True where every component is a finite number. */
SHARED mask is_finite(vec3 v)
{
  real sum = (v.x - v.x) + (v.y - v.y) + (v.z - v.z);
  return sum == R(0.0);
}

#endif
