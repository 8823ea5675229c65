/* straight_path.h - the test of a path against a box, which every structure of bodies uses. The path is that of a ray
 * or of a moving box.
 *
 *       +--+                    A moving box hits a box if its middle, as a ray, hits that box grown by its own half
 *       |  |- - - ->  [   ]     extents (Minkowski). A box at rest has a path of length 0.
 *       +--+
 *
 * Boxes are in world coordinates. The start of the path is known as a float and what that float lost, so boxes are
 * widened by as much. All structures share one test, because the bodies that are tested, and with them every bit of an
 * answer, must not depend on the structure.
 */
#ifndef TANDEM_SHARED_QUERIES_STRAIGHT_PATH_H
#define TANDEM_SHARED_QUERIES_STRAIGHT_PATH_H

#include "shared/broadphase/overlap.h"
#include "shared/queries/ray_shape.h"

/* The path is start + s displacement, with s from 0 to `reach`. Boxes are widened by start_low - start and
 * start - start_high. */
typedef struct {
  vec3 start_low, start_high, inverse;
} straight_path;

/* A finite stand-in for infinity if the path is parallel to a face; 0 times it is still 0. */
SHARED real inverse_of_component(real component)
{
  return magnitude(component) > R(1e-30) ? R(1.0) / component : component < R(0.0) ? -ENDLESS : ENDLESS;
}

/* extent: half extents of a box that moves along the path; 0 for a ray. */
SHARED straight_path straight_path_of(double_float3 start, vec3 displacement, vec3 extent)
{
  vec3 widening = add(extent, scale(absolute(start.high), R(2.4e-7)));
  straight_path w = {add(start.high, widening), subtract(start.high, widening),
                     make_vec3(inverse_of_component(displacement.x), inverse_of_component(displacement.y),
                               inverse_of_component(displacement.z))};
  return w;
}

/* The part of the path inside a box, between 0 and `reach`. */
typedef struct {
  real enter, leave;
} path_part;

SHARED path_part part_in_box(const straight_path *path, box_bounds box, real reach)
{
  vec3 low = multiply(subtract(box.lower, path->start_low), path->inverse),
       high = multiply(subtract(box.upper, path->start_high), path->inverse);
  path_part part;
  part.enter =
      maximum(maximum(minimum(low.x, high.x), minimum(low.y, high.y)), maximum(minimum(low.z, high.z), R(0.0)));
  part.leave = minimum(minimum(maximum(low.x, high.x), maximum(low.y, high.y)), minimum(maximum(low.z, high.z), reach));
  return part;
}
SHARED mask is_part(path_part part) { return part.enter <= part.leave + R(1e-6) * magnitude(part.leave); }

/* The fraction at which the path enters the box; ENDLESS if it misses the box or enters it after `reach`. */
SHARED real fraction_into_box(const straight_path *path, box_bounds box, real reach)
{
  /* An inverted box, as that of an empty node, or one with NaN would otherwise seem infinite. */
  mask is_box = box.lower.x <= box.upper.x && box.lower.y <= box.upper.y && box.lower.z <= box.upper.z;
  path_part part = part_in_box(path, box, reach);
  return is_box && is_part(part) ? part.enter : ENDLESS;
}

#endif
