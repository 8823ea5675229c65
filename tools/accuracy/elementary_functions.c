/* elementary_functions.c - measures the error of the library's own sine, cosine and arc tangent against double
 * precision.
 *
 * The kernels may not call built-in ones (docs/exactness.md), so their error must be measured here. This program visits
 * every float of a range and prints the largest error found; docs/exactness.md lists its figures. It takes about a
 * minute:
 *
 *   gcc -std=gnu99 -O2 -ffp-contract=off -I. tools/accuracy/elementary_functions.c -lm -o build/elementary_functions
 *   build/elementary_functions
 */
#include <math.h>
#include <stdio.h>

#include "shared/trigonometry.h"

typedef struct {
  double absolute, ulps;
  float at;
} worst;

static float from_bits(uint bits)
{
  float x;
  __builtin_memcpy(&x, &bits, sizeof x);
  return x;
}

/* Distance in units in the last place of the true value's float. */
static double ulps_between(double found, double truth)
{
  int exponent;
  frexp(truth, &exponent);
  return fabs(found - truth) / ldexp(1.0, exponent - 24);
}

static void note(worst *w, double found, double truth, float at)
{
  double error = fabs(found - truth), ulps = truth == 0.0 ? 0.0 : ulps_between(found, truth);
  if (error > w->absolute) {
    w->absolute = error;
    w->at = at;
  }
  if (ulps > w->ulps) w->ulps = ulps;
}

static void print_row(const char *what, worst w, unsigned long visited)
{
  printf("%-46s %10lu  %.3g at %.9g, %.3g ulp\n", what, visited, w.absolute, (double)w.at, w.ulps);
}

static void measure_sine_cosine(const char *range, float low, float high)
{
  worst sine = {0, 0, 0}, cosine = {0, 0, 0};
  unsigned long visited = 0;
  for (uint bits = float_bits(low); bits <= float_bits(high); ++bits, ++visited) {
    float x = from_bits(bits);
    for (int sign = 0; sign < 2; ++sign, x = -x) {
      angle_functions f = sine_cosine(x);
      note(&sine, f.sine, sin((double)x), x);
      note(&cosine, f.cosine, cos((double)x), x);
    }
  }
  char text[64];
  snprintf(text, sizeof text, "sine,   |x| in %s", range);
  print_row(text, sine, 2 * visited);
  snprintf(text, sizeof text, "cosine, |x| in %s", range);
  print_row(text, cosine, 2 * visited);
}

/* The slope y / x and its inverse take the value of every float of the range, in all four quadrants. */
static void measure_arc_tangent(float low, float high)
{
  worst w = {0, 0, 0};
  unsigned long visited = 0;
  for (uint bits = float_bits(low); bits <= float_bits(high); bits += 3u, visited += 8)
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
      float x = quadrant & 1 ? -1.0f : 1.0f, y = quadrant & 2 ? -from_bits(bits) : from_bits(bits);
      note(&w, arc_tangent(y, x), atan2((double)y, (double)x), y);
      note(&w, arc_tangent(x, y), atan2((double)x, (double)y), y);
    }
  print_row("arc tangent, slopes and inverses 2^-20 to 1", w, visited);
}

int main(void)
{
  printf("%-46s %10s  largest error\n", "function", "arguments");
  measure_sine_cosine("[2^-20, pi/4]", 9.5367431640625e-7f, 0.785398163f);
  measure_sine_cosine("[pi/4, 2 pi]", 0.785398163f, 6.28318531f);
  measure_sine_cosine("[2 pi, 100]", 6.28318531f, 100.0f);
  measure_sine_cosine("[100, 8192]", 100.0f, 8192.0f);
  measure_arc_tangent(9.5367431640625e-7f, 1.0f);
  return 0;
}
