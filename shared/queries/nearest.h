/* nearest.h - the tests that every query makes with a body: whether the filters allow a hit, whether the body is near
 * enough, and whether the hit is nearer than the nearest so far.
 *
 * The broadphase chooses which bodies are tested (body_walk.h). Their order makes no difference to the nearest hit. */
#ifndef TANDEM_SHARED_QUERIES_NEAREST_H
#define TANDEM_SHARED_QUERIES_NEAREST_H

#include "shared/narrowphase/convex.h"

typedef struct {
  uint body;     /* its number in the scene, INDEX_NONE for nothing */
  real fraction; /* of the path */
  vec3 normal;   /* of the body's surface, unit, outward; against the path if that starts inside */
  vec3 point;    /* on it, from the start */
} first_hit;

SHARED first_hit nothing_hit(void)
{
  first_hit hit = {INDEX_NONE, R(0.0), {R(0.0), R(0.0), R(0.0)}, {R(0.0), R(0.0), R(0.0)}};
  return hit;
}

/* The nearer of two hits; of equally near ones, that on the body with the lower index. */
SHARED first_hit nearer_hit(first_hit a, first_hit b)
{
  if (a.body == INDEX_NONE) return b;
  if (b.body == INDEX_NONE) return a;
  if (b.fraction != a.fraction) return b.fraction < a.fraction ? b : a;
  return b.body < a.body ? b : a;
}

/* query_body: number in the scene, group, mask; query_filter: group, mask. */
SHARED mask may_hit(GLOBAL const uint *flags, GLOBAL const uint *query_body, GLOBAL const uint *query_filter, uint body,
                    uint query)
{
  if (body_type_of(flags[body]) == (uint)BODY_TYPE_QUARANTINED) return 0;
  return (query_body[4u * body + 1u] & query_filter[2u * query + 1u]) != 0u &&
         (query_body[4u * body + 2u] & query_filter[2u * query]) != 0u;
}

/* Whether a moving ball comes near a ball at rest. radius: the sum of both, with a margin for rounding. displacement:
 * from the start. */
SHARED mask passes_near(vec3 center, vec3 displacement, real radius)
{
  real square = length_squared(displacement), along = dot3(center, displacement);
  real t = square > R(0.0) ? clamped(along / square, R(0.0), R(1.0)) : R(0.0);
  real rounding = R(8.0) * ROUNDING * (length_of(center) + square_root(square));
  real most = radius + rounding;
  return length_squared(add_scaled(center, displacement, -t)) <= most * most * R(1.000001);
}

/* The centre of a body seen from a point of the world, as the difference of two double-float positions. */
SHARED vec3 seen_from(GLOBAL const float4 *positions, uint body, double_float3 from)
{
  double_float3 p = load_position(positions, body);
  return add(subtract(p.high, from.high), subtract(p.low, from.low));
}

/* The shape of a body as a convex, even if the narrowphase has a test of its own for it. */
SHARED convex shape_of_body(GLOBAL const uint *flags, GLOBAL const float4 *shapes, GLOBAL const uint *convexes,
                            GLOBAL const float4 *poses, GLOBAL const float4 *orientations, hull_tables tables,
                            vec3 center, uint body)
{
  uint kind = shape_of(flags[body]), hull = 0u;
  quat turned = quat_from(load_float4(orientations, body));
  if (is_general_shape(kind)) {
    kind = convexes[body * 2u];
    hull = convexes[body * 2u + 1u];
    center = add(center, rotate(rotation_of(turned), xyz(load_float4(poses, body * 4u))));
    turned = quat_multiply(turned, quat_from(load_float4(poses, body * 4u + 1u)));
  }
  return convex_of(kind, xyz(load_float4(shapes, body)), rotation_of(turned), center, make_vec3(R(0.0), R(0.0), R(0.0)),
                   hull, tables);
}

SHARED void store_hit(first_hit hit, write_hits hits, uint i)
{
  store_float4(hits.hit, i, extend(hit.normal, hit.fraction));
  store_float4(hits.point, i, extend(hit.point, R(0.0)));
  hits.body[i] = hit.body;
}

#endif
