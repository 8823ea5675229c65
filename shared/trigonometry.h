/* trigonometry.h - sine, cosine, arc tangent, and the rotation by an angle.
 *
 * The built-in functions differ between CPU and GPU by ulps (docs/exactness.md), so these use only operations that
 * round alike everywhere. The reduction follows Cody and Waite, and the polynomials have the degree of the Cephes
 * library. Their errors were measured against double over dense sweeps (tests/shared/trigonometry_test.cpp, figures in
 * docs/exactness.md). The functions are free of branches, so they run at any width.
 */
#ifndef TANDEM_SHARED_TRIGONOMETRY_H
#define TANDEM_SHARED_TRIGONOMETRY_H

#include "shared/math.h"

/* Larger angles are clamped to this: no substep turns a body by thousands of turns. */
#define ANGLE_LIMIT R(8192.0)

typedef struct {
  real sine, cosine;
} angle_functions;

/* Polynomials up to an eighth of a turn in the square rr: sin r = r + r rr (...), cos r = 1 - rr / 2 + rr rr (...). The
 * reference build has more terms, as double precision needs. */
#ifdef TANDEM_REFERENCE
#define SINE_TERMS(rr)                       \
  (-1.0 / 6 +                                \
   rr * (1.0 / 120 +                         \
         rr * (-1.0 / 5040 +                 \
               rr * (1.0 / 362880 +          \
                     rr * (-1.0 / 39916800 + \
                           rr * (1.0 / 6227020800 + rr * (-1.0 / 1307674368000 + rr * (1.0 / 355687428096000))))))))
#define COSINE_TERMS(rr)                                                \
  (1.0 / 24 +                                                           \
   rr * (-1.0 / 720 +                                                   \
         rr * (1.0 / 40320 +                                            \
               rr * (-1.0 / 3628800 +                                   \
                     rr * (1.0 / 479001600 + rr * (-1.0 / 87178291200 + \
                                                   rr * (1.0 / 20922789888000 + rr * (-1.0 / 6402373705728000))))))))
#else
#define SINE_TERMS(rr) (R(-1.6666654611e-1) + rr * (R(8.3321608736e-3) + rr * R(-1.9515295891e-4)))
#define COSINE_TERMS(rr) (R(4.166664568298827e-2) + rr * (R(-1.388731625493765e-3) + rr * R(2.443315711809948e-5)))
#endif

/* Adding and subtracting 1.5 x 2^23 rounds to the nearest integer, in the rounding mode that all backends share. */
#ifdef TANDEM_REFERENCE
#define ROUNDING_CONSTANT 6755399441055744.0
#else
#define ROUNDING_CONSTANT 12582912.0f
#endif
SHARED real nearest_integer(real x) { return (x + ROUNDING_CONSTANT) - ROUNDING_CONSTANT; }

SHARED angle_functions sine_cosine(real angle)
{
  real x = clamped(angle, -ANGLE_LIMIT, ANGLE_LIMIT);
  real quarter_turns = nearest_integer(x * R(0.63661977236758134));
  /* pi/2 in three parts, the first two short, so that the products are exact. */
  real r = ((x - quarter_turns * R(1.5703125)) - quarter_turns * R(4.837512969970703125e-4)) -
           quarter_turns * R(7.54978995489188216e-8);
  real rr = r * r;
  real s = r + r * rr * SINE_TERMS(rr);
  real c = (R(1.0) - R(0.5) * rr) + rr * rr * COSINE_TERMS(rr);
  uint_lanes quadrant = to_uint(quarter_turns) & 3u;
  mask swapped = (quadrant & 1u) == 1u;
  real sine = choose(swapped, c, s), cosine = choose(swapped, s, c);
  angle_functions f = {choose(quadrant >= 2u, -sine, sine),
                       choose((quadrant == 1u) | (quadrant == 2u), -cosine, cosine)};
  return f;
}

/* Angle of the vector (x, y), -pi .. pi; 0 for the zero vector. */
SHARED real arc_tangent(real y, real x)
{
  real across = magnitude(x), up = magnitude(y);
  real large = maximum(across, up), small = minimum(across, up);
  real ratio = choose(large > R(0.0), small / choose(large > R(0.0), large, (real)R(1.0)), (real)R(0.0));
  mask upper = ratio > R(0.41421356237);
  real t = choose(upper, (ratio - R(1.0)) / (ratio + R(1.0)), ratio);
  real tt = t * t;
  real angle = t + t * tt *
                       (R(-3.33329491539e-1) +
                        tt * (R(1.99777106478e-1) + tt * (R(-1.38776856032e-1) + tt * R(8.05374449538e-2))));
  angle = angle + choose(upper, (real)R(0.78539816339744831), (real)R(0.0));
  angle = choose(up > across, R(1.57079632679489662) - angle, angle);
  angle = choose(x < R(0.0), R(3.14159265358979324) - angle, angle);
  return choose(y < R(0.0), -angle, angle);
}

/* q rotated by the rotation vector v (rad, world axes). */
SHARED quat turned(quat q, vec3 v)
{
  real angle = length_of(v);
  mask turns = angle > R(1e-9);
  angle_functions halved = sine_cosine(R(0.5) * angle);
  real s = choose(turns, halved.sine / choose(turns, angle, (real)R(1.0)), (real)R(0.5));
  return quat_normalized(
      quat_multiply(make_quat(v.x * s, v.y * s, v.z * s, choose(turns, halved.cosine, (real)R(1.0))), q));
}

#endif
