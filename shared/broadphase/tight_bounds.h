/* tight_bounds.h - bounds from the support map: the smallest box along the world axes that contains a shape at its
 * current pose.
 *
 *     +-------+ affine       The fast bound of bounds.h rotates the box around the shape in its own axes, with six
 *     | +---+ |              products. It also encloses corners of that box where the shape has none. Here the support
 *     | | o | | tight        map gives the farthest point along each world axis, in both directions (2013 talk): fewer
 *     | +---+ |              pairs, for six support queries for each body.
 *     +-------+
 *
 * Spheres and boxes have tight bounds anyway; meshes and compounds keep the fast bound under `--bounds tight`, too.
 */
#ifndef TANDEM_SHARED_BROADPHASE_TIGHT_BOUNDS_H
#define TANDEM_SHARED_BROADPHASE_TIGHT_BOUNDS_H

#include "shared/broadphase/bounds.h"
#include "shared/queries/nearest.h"

/* The distance that the shape reaches along a unit direction from the centre of its body. */
SHARED real reach_along(const convex *shape, vec3 direction)
{
  return dot3(support_of(shape, direction), direction) + core_radius(shape);
}

SHARED void tighten_bounds_item(GLOBAL const Parameters *parameters, read_shapes shapes, GLOBAL const uint *hull_header,
                                GLOBAL const float4 *hull_vertex, GLOBAL const float4 *hull_chunk,
                                GLOBAL const float4 *body_mass, GLOBAL const float4 *body_gravity,
                                GLOBAL const float4 *body_position, GLOBAL const float4 *body_orientation,
                                GLOBAL const float4 *body_velocity, GLOBAL float4 *bounds, uint i)
{
  uint kind = is_general_shape(shape_of(shapes.flags[i])) ? shapes.convex[2u * i] : (uint)SHAPE_COMPOUND;
  if (kind == (uint)SHAPE_MESH || kind == (uint)SHAPE_COMPOUND) return;
  hull_tables tables = {hull_header, hull_vertex, 0, 0, 0, 0, hull_chunk, 0, 0, 0, SUPPORT_BRUTE_FORCE};
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0)), x = make_vec3(R(1.0), R(0.0), R(0.0)),
       y = make_vec3(R(0.0), R(1.0), R(0.0)), z = make_vec3(R(0.0), R(0.0), R(1.0));
  convex shape =
      shape_of_body(shapes.flags, shapes.size, shapes.convex, shapes.pose, body_orientation, tables, none, i);
  real radius = load_float4(shapes.size, i).w, rounding = R(1e-6) * radius;
  vec3 spare = make_vec3(rounding, rounding, rounding);
  vec3 above = add(make_vec3(reach_along(&shape, x), reach_along(&shape, y), reach_along(&shape, z)), spare);
  vec3 below = add(
      make_vec3(reach_along(&shape, negate(x)), reach_along(&shape, negate(y)), reach_along(&shape, negate(z))), spare);
  store_bounds_of_step(parameters, shapes.flags, body_mass, body_gravity, bounds, i,
                       load_position(body_position, i).high, load_velocity(body_velocity, i), below, above, radius);
}

#endif
