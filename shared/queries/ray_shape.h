/* ray_shape.h - the points at which a line enters and leaves a shape, in closed form where there is one.
 *
 *            enter         leave      The line is o + s u in the shape's axes, with u of length 1. The caller starts it
 *     o-------->(#############)--->   at the point nearest to the shape's middle, so that the numbers that are squared
 *                                     are no larger than the shape, however far away the ray began.
 *
 *   sphere             a quadratic
 *   cylinder, cone     the slab between the caps, and a quadratic for the side
 *   capsule            its two spheres, and the cone that touches both
 *   box, hull          clipped by each face in turn (Cyrus and Beck, 1978)
 *   half-space         a plane
 *   triangle           its plane, between its edges (Moeller and Trumbore, 1997); from either side
 */
#ifndef TANDEM_SHARED_QUERIES_RAY_SHAPE_H
#define TANDEM_SHARED_QUERIES_RAY_SHAPE_H

#include "shared/narrowphase/polytope.h"

/* A distance larger than any in a scene; spans that are infinite on one side or both end there. */
#define ENDLESS R(1e30)

/* The span is empty if leave < enter. normal: unit, outward, at the entry. */
typedef struct {
  real enter, leave;
  vec3 normal;
} span;

SHARED span whole_line(void)
{
  span line = {-ENDLESS, ENDLESS, {R(0.0), R(0.0), R(0.0)}};
  return line;
}
SHARED span no_span(void)
{
  span nothing = {ENDLESS, -ENDLESS, {R(0.0), R(0.0), R(0.0)}};
  return nothing;
}
SHARED mask is_nothing(span s) { return !(s.enter <= s.leave); }

SHARED span common_span(span a, span b)
{
  span s = a;
  if (b.enter > a.enter) {
    s.enter = b.enter;
    s.normal = b.normal;
  }
  s.leave = minimum(a.leave, b.leave);
  return s;
}
/* The span of the union of two parts of one convex shape. */
SHARED span joined_span(span a, span b)
{
  if (is_nothing(a)) return b;
  if (is_nothing(b)) return a;
  span s = b.enter < a.enter ? b : a;
  s.leave = maximum(a.leave, b.leave);
  return s;
}

/* The span below the plane with a unit normal and a distance from the origin. */
SHARED span span_below_plane(vec3 o, vec3 u, vec3 normal, real distance)
{
  real height = dot3(normal, o) - distance, rise = dot3(normal, u);
  if (rise == R(0.0)) return height <= R(0.0) ? whole_line() : no_span();
  span s = whole_line();
  if (rise > R(0.0)) s.leave = -height / rise;
  else {
    s.enter = -height / rise;
    s.normal = normal;
  }
  return s;
}

SHARED span span_in_polytope(const convex *shape, vec3 o, vec3 u)
{
  span s = whole_line();
  uint faces = faces_of(shape);
  for (uint k = 0u; k < faces; ++k) {
    vec4 plane = plane_of_face(shape, k);
    s = common_span(s, span_below_plane(o, u, xyz(plane), plane.w));
  }
  return s;
}

/* The span in a sphere whose centre is on the axis. */
SHARED span span_in_sphere(vec3 o, vec3 u, real height, real radius)
{
  vec3 from = make_vec3(o.x, o.y - height, o.z);
  real along = dot3(from, u);
  vec3 nearest = add_scaled(from, u, -along);
  real square = radius * radius - length_squared(nearest);
  if (!(square >= R(0.0))) return no_span();
  real half_chord = square_root(square);
  span s = {-along - half_chord, -along + half_chord, {R(0.0), R(0.0), R(0.0)}};
  s.normal = scale(add_scaled(nearest, u, -half_chord), R(1.0) / radius);
  return s;
}

/* The roots of a s^2 + 2 b s + c, the lower one first. One root is computed from the product of both, because their
 * difference may cancel. False if there is none. If a is 0, the other root is infinite. */
SHARED mask roots_of(real a, real b, real c, real *low, real *high)
{
  real square = b * b - a * c;
  if (!(square >= R(0.0))) return 0;
  real q = b < R(0.0) ? square_root(square) - b : -(b + square_root(square));
  if (q == R(0.0)) {
    *low = *high = R(0.0);
    return a != R(0.0);
  }
  real first = magnitude(q) < magnitude(a) * ENDLESS ? q / a
               : (q < R(0.0)) == (a < R(0.0))        ? ENDLESS
                                                     : -ENDLESS,
       second = c / q;
  *low = minimum(first, second);
  *high = maximum(first, second);
  return 1;
}

/* The outward normal of the side of a cone whose radius grows by `growth` a metre of height. */
SHARED vec3 normal_of_side(vec3 at, real growth)
{
  vec3 out = around_axis(at);
  real length = square_root(R(1.0) + growth * growth);
  return make_vec3(out.x / length, -growth / length, out.z / length);
}

/* The span in a cone between two heights on the axis, with the radii there. */
SHARED span span_in_cone(vec3 o, vec3 u, real bottom, real top, real radius_bottom, real radius_top)
{
  span s = span_below_plane(o, u, make_vec3(R(0.0), R(1.0), R(0.0)), top);
  s = common_span(s, span_below_plane(o, u, make_vec3(R(0.0), R(-1.0), R(0.0)), -bottom));
  if (is_nothing(s)) return s;
  real growth = (radius_top - radius_bottom) / (top - bottom), radius = radius_bottom + (o.y - bottom) * growth,
       widening = growth * u.y;
  real a = u.x * u.x + u.z * u.z - widening * widening, b = o.x * u.x + o.z * u.z - radius * widening;
  real across = square_root(o.x * o.x + o.z * o.z), c = (across - radius) * (across + radius), low, high;
  if (a == R(0.0) && b == R(0.0)) return c <= R(0.0) ? s : no_span();
  span side = whole_line();
  if (!roots_of(a, b, c, &low, &high)) {
    if (a > R(0.0)) return no_span();
    return s; /* so steep in the cone that it never leaves it */
  }
  if (a >= R(0.0)) {
    side.enter = low;
    side.leave = high;
  } else if (widening > R(0.0)) side.enter = high; /* of the two cones the one above the tip */
  else side.leave = low;
  if (side.enter > -ENDLESS) side.normal = normal_of_side(add_scaled(o, u, side.enter), growth);
  return common_span(s, side);
}

/* size: as that of a capsule. */
SHARED span span_in_capsule(vec3 o, vec3 u, vec3 size)
{
  real sine = (size.x - size.z) / (R(2.0) * size.y), cosine = square_root(maximum(R(1.0) - sine * sine, R(0.0)));
  span side = span_in_cone(o, u, size.x * sine - size.y, size.z * sine + size.y, size.x * cosine, size.z * cosine);
  return joined_span(joined_span(span_in_sphere(o, u, -size.y, size.x), side), span_in_sphere(o, u, size.y, size.z));
}

/* A triangle is hit at one point or not at all; the normal is on the side that the ray comes from. */
SHARED span span_in_triangle(const convex *shape, vec3 o, vec3 u)
{
  vec3 normal = cross3(shape->second, shape->third);
  real rise = dot3(normal, u), height = dot3(normal, o);
  if (rise == R(0.0)) return no_span();
  real s = -height / rise;
  vec3 at = add_scaled(o, u, s);
  real second = dot3(normal, cross3(at, shape->third)), third = dot3(normal, cross3(shape->second, at)),
       whole = length_squared(normal);
  real slack = R(1e-6) * whole; /* so that no ray passes between two triangles */
  if (!(second >= -slack) || !(third >= -slack) || !(second + third <= whole + slack)) return no_span();
  vec3 unit = scale(normal, R(1.0) / square_root(whole));
  span hit = {s, s, rise > R(0.0) ? negate(unit) : unit};
  return hit;
}

SHARED span span_in_shape(const convex *shape, vec3 o, vec3 u)
{
  if (shape->kind == (uint)SHAPE_SPHERE) return span_in_sphere(o, u, R(0.0), shape->size.x);
  if (is_cylinder(shape)) return span_in_cone(o, u, -shape->size.y, shape->size.y, shape->size.x, shape->size.z);
  if (is_capsule(shape)) return span_in_capsule(o, u, shape->size);
  if (is_triangle(shape)) return span_in_triangle(shape, o, u);
  if (shape->kind == (uint)SHAPE_HALF_SPACE) return span_below_plane(o, u, make_vec3(R(0.0), R(1.0), R(0.0)), R(0.0));
  return span_in_polytope(shape, o, u);
}

/* The span of the line from a point along a unit direction, both in world axes and seen from the same point as the
 * shape. */
SHARED span ray_span(const convex *shape, vec3 from, vec3 direction)
{
  vec3 offset = subtract(from, shape->center);
  real start = -dot3(offset, direction);
  span s = span_in_shape(shape, rotate_back(shape->rotation, add_scaled(offset, direction, start)),
                         rotate_back(shape->rotation, direction));
  s.enter = s.enter + start;
  s.leave = s.leave + start;
  s.normal = rotate(shape->rotation, s.normal);
  return s;
}

#endif
