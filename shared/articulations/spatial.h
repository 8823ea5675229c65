/* spatial.h - motions and forces of rigid bodies as pairs of vectors, and the inertia that links the two.
 *
 * Both are in axes of the world and belong to a point. At another point, `arm` away, a motion has another linear part
 * and a force another moment:
 *
 *     motion   angular w, linear v     at the other point   w, v + w x arm
 *     force    moment n, force f       at the other point   n - arm x f, f
 *
 * The point of a link is its own centre of mass. Its inertia is then two blocks, and arms are as long as links, however
 * long the tree and however far it is from the origin; with one point for the whole tree, the moments of a chain's far
 * links would be differences of squared distances, of which floats keep little.
 *
 * After Featherstone, "Rigid Body Dynamics Algorithms", 2008.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_SPATIAL_H
#define TANDEM_SHARED_ARTICULATIONS_SPATIAL_H

#include "shared/math.h"

typedef struct {
  vec3 angular, linear;
} spatial_motion;

typedef struct {
  vec3 moment, force;
} spatial_force;

SHARED vec3 zero3(void) { return make_vec3(R(0.0), R(0.0), R(0.0)); }
SHARED spatial_motion no_motion(void)
{
  spatial_motion m = {zero3(), zero3()};
  return m;
}
SHARED spatial_force no_force(void)
{
  spatial_force f = {zero3(), zero3()};
  return f;
}
SHARED spatial_motion add_motions(spatial_motion a, spatial_motion b)
{
  spatial_motion m = {add(a.angular, b.angular), add(a.linear, b.linear)};
  return m;
}
SHARED spatial_force add_forces(spatial_force a, spatial_force b)
{
  spatial_force f = {add(a.moment, b.moment), add(a.force, b.force)};
  return f;
}
SHARED spatial_force subtract_forces(spatial_force a, spatial_force b)
{
  spatial_force f = {subtract(a.moment, b.moment), subtract(a.force, b.force)};
  return f;
}
SHARED spatial_force scaled_force(spatial_force a, real by)
{
  spatial_force f = {scale(a.moment, by), scale(a.force, by)};
  return f;
}
SHARED spatial_motion choose_motion(mask m, spatial_motion a, spatial_motion b)
{
  spatial_motion c = {choose3(m, a.angular, b.angular), choose3(m, a.linear, b.linear)};
  return c;
}
SHARED spatial_force choose_force(mask m, spatial_force a, spatial_force b)
{
  spatial_force c = {choose3(m, a.moment, b.moment), choose3(m, a.force, b.force)};
  return c;
}

/* The same motion, and the same force, at the point that is `arm` away. A parameter that changed here would change for
 * the caller, too, on rusticl (docs/exactness.md). */
SHARED spatial_motion motion_at(spatial_motion m, vec3 arm)
{
  spatial_motion there = {m.angular, add(m.linear, cross3(m.angular, arm))};
  return there;
}
SHARED spatial_force force_at(spatial_force f, vec3 arm)
{
  spatial_force there = {subtract(f.moment, cross3(arm, f.force)), f.force};
  return there;
}

SHARED real power_of(spatial_force f, spatial_motion m) { return dot3(f.moment, m.angular) + dot3(f.force, m.linear); }

/* A symmetric 6x6 matrix in blocks:   | first       coupling |
 *                                     | coupling^T  second   |
 * An inertia takes motions to forces: `first` is of angular motion and moment, `second` of linear motion and force. Its
 * inverse takes forces to motions and is kept the other way round, `first` linear and `second` angular, so that one
 * function moves both to another point. */
typedef struct {
  symmetric3 first, second;
  mat3 coupling;
} symmetric6;

SHARED vec3 transposed_times(mat3 m, vec3 v) { return rotate_back(m, v); }
SHARED vec3 matrix_times(mat3 m, vec3 v) { return rotate(m, v); }

SHARED spatial_force inertia_times(const symmetric6 *inertia, spatial_motion m)
{
  spatial_force f = {add(symmetric_times(inertia->first, m.angular), matrix_times(inertia->coupling, m.linear)),
                     add(transposed_times(inertia->coupling, m.angular), symmetric_times(inertia->second, m.linear))};
  return f;
}
SHARED spatial_motion inverse_times(const symmetric6 *inverse, spatial_force f)
{
  spatial_motion m = {add(transposed_times(inverse->coupling, f.force), symmetric_times(inverse->second, f.moment)),
                      add(symmetric_times(inverse->first, f.force), matrix_times(inverse->coupling, f.moment))};
  return m;
}

SHARED symmetric3 zero_symmetric(void)
{
  symmetric3 s = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
  return s;
}
SHARED symmetric6 zero_symmetric6(void)
{
  symmetric6 s = {zero_symmetric(), zero_symmetric(), {zero3(), zero3(), zero3()}};
  return s;
}

SHARED vec3 row_x(symmetric3 s) { return make_vec3(s.xx, s.xy, s.xz); }
SHARED vec3 row_y(symmetric3 s) { return make_vec3(s.xy, s.yy, s.yz); }
SHARED vec3 row_z(symmetric3 s) { return make_vec3(s.xz, s.yz, s.zz); }

/* s + factor (a b^T + b a^T) / 2 */
SHARED symmetric3 add_products(symmetric3 s, vec3 a, vec3 b, real factor)
{
  real halved = R(0.5) * factor;
  symmetric3 r = {s.xx + factor * (a.x * b.x),
                  s.yy + factor * (a.y * b.y),
                  s.zz + factor * (a.z * b.z),
                  s.xy + halved * (a.x * b.y + a.y * b.x),
                  s.xz + halved * (a.x * b.z + a.z * b.x),
                  s.yz + halved * (a.y * b.z + a.z * b.y)};
  return r;
}
/* m + factor a b^T */
SHARED mat3 add_product(mat3 m, vec3 a, vec3 b, real factor)
{
  mat3 r = {add_scaled(m.x, b, factor * a.x), add_scaled(m.y, b, factor * a.y), add_scaled(m.z, b, factor * a.z)};
  return r;
}

/* An inertia, or an inverse inertia, that belongs to a point, at the point that is `arm` away. */
SHARED symmetric6 symmetric6_at(symmetric6 s, vec3 arm)
{
  vec3 r = negate(arm), x = row_x(s.second), y = row_y(s.second), z = row_z(s.second);
  mat3 c = {add(s.coupling.x, subtract(scale(z, r.y), scale(y, r.z))),
            add(s.coupling.y, subtract(scale(x, r.z), scale(z, r.x))),
            add(s.coupling.z, subtract(scale(y, r.x), scale(x, r.y)))};
  vec3 old_x = cross3(s.coupling.x, r), old_y = cross3(s.coupling.y, r), old_z = cross3(s.coupling.z, r);
  vec3 new_x = cross3(c.x, r), new_y = cross3(c.y, r), new_z = cross3(c.z, r);
  symmetric3 first = {s.first.xx - old_x.x - new_x.x, s.first.yy - old_y.y - new_y.y, s.first.zz - old_z.z - new_z.z,
                      s.first.xy - old_x.y - new_y.x, s.first.xz - old_x.z - new_z.x, s.first.yz - old_y.z - new_z.y};
  symmetric6 moved = {first, s.second, c};
  return moved;
}

SHARED symmetric3 sum_of_symmetric(symmetric3 a, symmetric3 b)
{
  symmetric3 s = {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  return s;
}
SHARED symmetric6 add_symmetric6(symmetric6 a, symmetric6 b)
{
  mat3 coupling = {add(a.coupling.x, b.coupling.x), add(a.coupling.y, b.coupling.y), add(a.coupling.z, b.coupling.z)};
  symmetric6 s = {sum_of_symmetric(a.first, b.first), sum_of_symmetric(a.second, b.second), coupling};
  return s;
}
SHARED symmetric3 choose_symmetric3(mask m, symmetric3 a, symmetric3 b)
{
  symmetric3 r = {choose(m, a.xx, b.xx), choose(m, a.yy, b.yy), choose(m, a.zz, b.zz),
                  choose(m, a.xy, b.xy), choose(m, a.xz, b.xz), choose(m, a.yz, b.yz)};
  return r;
}
SHARED symmetric6 choose_symmetric6(mask m, symmetric6 a, symmetric6 b)
{
  mat3 coupling = {choose3(m, a.coupling.x, b.coupling.x), choose3(m, a.coupling.y, b.coupling.y),
                   choose3(m, a.coupling.z, b.coupling.z)};
  symmetric6 s = {choose_symmetric3(m, a.first, b.first), choose_symmetric3(m, a.second, b.second), coupling};
  return s;
}

/* 1 / x; 0 where x is not positive: nothing moves along a row without inertia. */
SHARED real inverse_if_positive(real x)
{
  mask positive = x > R(0.0);
  return choose(positive, R(1.0) / choose(positive, x, (real)R(1.0)), (real)R(0.0));
}

/* The inverse of a symmetric positive matrix, by L D L^T: m = 1 + lower triangle, whose inverse is
 * | 1 . . |
 * | a 1 . |  with the pivots' inverses between its transpose and itself. */
SHARED symmetric3 inverse_of_symmetric(symmetric3 s)
{
  real x = inverse_if_positive(s.xx), y_of_x = s.xy * x, z_of_x = s.xz * x;
  real rest = s.yz - z_of_x * s.xy;
  real y = inverse_if_positive(s.yy - y_of_x * s.xy), z_of_y = rest * y;
  real z = inverse_if_positive(s.zz - z_of_x * s.xz - z_of_y * rest);
  real a = -y_of_x, b = -z_of_y, c = y_of_x * z_of_y - z_of_x;
  symmetric3 r = {x + a * a * y + c * c * z, y + b * b * z, z, a * y + b * c * z, c * z, b * z};
  return r;
}

/* Rows of `m` times s. */
SHARED mat3 times_symmetric(mat3 m, symmetric3 s)
{
  mat3 r = {symmetric_times(s, m.x), symmetric_times(s, m.y), symmetric_times(s, m.z)};
  return r;
}
SHARED mat3 negated_matrix(mat3 m)
{
  mat3 r = {negate(m.x), negate(m.y), negate(m.z)};
  return r;
}
/* s + factor a b^T, where a b^T is known to be symmetric. */
SHARED symmetric3 add_symmetric_product(symmetric3 s, mat3 a, mat3 b, real factor)
{
  symmetric3 r = {s.xx + factor * dot3(a.x, b.x), s.yy + factor * dot3(a.y, b.y), s.zz + factor * dot3(a.z, b.z),
                  s.xy + factor * dot3(a.x, b.y), s.xz + factor * dot3(a.x, b.z), s.yz + factor * dot3(a.y, b.z)};
  return r;
}

/* The inverse of an inertia, kept as an inverse is. The block of linear motion, nearly a mass, is eliminated first. */
SHARED symmetric6 inverse_of_inertia(symmetric6 inertia)
{
  symmetric3 mass = inverse_of_symmetric(inertia.second);
  mat3 k = times_symmetric(inertia.coupling, mass); /* coupling / second */
  symmetric3 angular = inverse_of_symmetric(add_symmetric_product(inertia.first, k, inertia.coupling, R(-1.0)));
  /* linear by moment: -(k^T angular); linear by force: mass + k^T angular k */
  mat3 transposed = {axis_x(k), axis_y(k), axis_z(k)};
  mat3 product = times_symmetric(transposed, angular);
  symmetric6 inverse = {add_symmetric_product(mass, product, transposed, R(1.0)), angular, negated_matrix(product)};
  return inverse;
}

/* --- in memory: six rows ------------------------------------------------------------------------------------- */
typedef struct {
  vec4 row[6];
} packed_symmetric6;

SHARED packed_symmetric6 packed6(symmetric6 s)
{
  packed_symmetric6 p;
  p.row[0] = make_vec4(s.first.xx, s.first.yy, s.first.zz, s.first.xy);
  p.row[1] = make_vec4(s.first.xz, s.first.yz, s.second.xx, s.second.yy);
  p.row[2] = make_vec4(s.second.zz, s.second.xy, s.second.xz, s.second.yz);
  p.row[3] = extend(s.coupling.x, R(0.0));
  p.row[4] = extend(s.coupling.y, R(0.0));
  p.row[5] = extend(s.coupling.z, R(0.0));
  return p;
}
SHARED symmetric6 unpacked6(packed_symmetric6 p)
{
  symmetric3 first = {p.row[0].x, p.row[0].y, p.row[0].z, p.row[0].w, p.row[1].x, p.row[1].y},
             second = {p.row[1].z, p.row[1].w, p.row[2].x, p.row[2].y, p.row[2].z, p.row[2].w};
  mat3 coupling = {xyz(p.row[3]), xyz(p.row[4]), xyz(p.row[5])};
  symmetric6 s = {first, second, coupling};
  return s;
}

#endif
