/* clamp_to_time_of_impact.h - cuts the solved motion of a body with continuous collision before the body passes a wall.
 *
 *     start  o - - - .          The contacts of a step are those of the unconstrained, straight motion. A body that
 *                 /   \         such a contact deflects or sets spinning may reach a place where no contact was made:
 *      deflected o  |  x end    a second wall in a corner, or a wall that its own other end hits. The solved motion of
 *                   |wall       the body is therefore followed once more, against bodies that no impulse moves, and
 *                               cut where it would pass one. The velocity stays, for the contact of the next step.
 *
 * The test depends on the start, as in Box2D 3 (Catto, 2024). The whole shape is tested if it starts free. A shape that
 * starts touching has its contacts already, and every grazing contact would stop it, so only a ball in its middle is
 * tested.
 *
 * Each pair limits the fraction of the motion that is kept, and the lowest fraction holds. Fractions are stored as
 * whole numbers, so their minimum does not depend on order.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CLAMP_TO_TIME_OF_IMPACT_H
#define TANDEM_SHARED_NARROWPHASE_CLAMP_TO_TIME_OF_IMPACT_H

#include "shared/narrowphase/collide_convex.h"
#include "shared/narrowphase/middle_ball.h"

/* A wall: a convex shape or a half-space. It is seen from the body's centre, and times go from 0 to 1. */
typedef struct {
  mask is_plane;
  moving_convex shape;
  vec3 up, linear; /* of a plane */
  real height;
} wall;

SHARED toi_input way_past(const moving_convex *body, const wall *w)
{
  vec3 linear = w->is_plane ? w->linear : w->shape.linear;
  real swing = fastest_swing(body);
  real size = bounding_radius_of(&body->shape), least = least_size(&body->shape);
  if (!w->is_plane) {
    size = size + bounding_radius_of(&w->shape.shape);
    least = minimum(least, least_size(&w->shape.shape));
    swing = swing + fastest_swing(&w->shape);
  }
  return toi_input_of(length_of(subtract(body->linear, linear)) + swing, R(1.0), least, size);
}
SHARED impact impact_on(const moving_convex *body, const wall *w)
{
  if (w->is_plane) return first_impact_on_plane(body, w->up, w->height, w->linear, way_past(body, w));
  return first_impact(body, &w->shape, way_past(body, w));
}

/* The gap between the body and the wall along a normal at the end of the motion. */
SHARED real gap_at_end(const moving_convex *body, const wall *w, vec3 normal)
{
  convex shape = shape_at(body, body->linear, R(1.0));
  if (w->is_plane) {
    real height = w->height + dot3(w->up, subtract(w->linear, body->linear));
    return dot3(w->up, support_of(&shape, normal)) - core_radius(&shape) - height;
  }
  convex other = shape_at(&w->shape, body->linear, R(1.0));
  return gap_along(&shape, &other, normal) - core_radius(&shape) - core_radius(&other);
}

SHARED moving_convex middle_ball(const moving_convex *body)
{
  moving_convex ball = *body;
  ball.shape.kind = (uint)SHAPE_SPHERE;
  ball.shape.center = body->pivot;
  ball.shape.size.x = CORE_SHARE * least_size(&body->shape);
  ball.radius = R(0.0);
  return ball;
}

/* The fraction of its motion that a body makes before it passes a wall. slop: harmless penetration, m. */
SHARED real free_share(const moving_convex *body, const wall *w, real slop)
{
  impact met = impact_on(body, w);
  if (!met.at.hits) return R(1.0);
  if (met.at.time > R(0.0)) return gap_at_end(body, w, met.normal) < -slop ? met.at.time : R(1.0);
  moving_convex ball = middle_ball(body);
  met = impact_on(&ball, w);
  if (!met.at.hits || met.gap <= R(-0.5) * ball.shape.size.x) return R(1.0);
  return gap_at_end(&ball, w, met.normal) < R(0.0) ? met.at.time : R(1.0);
}

/* A triangle of a mesh is a wall from one side only. */
SHARED mask comes_from_behind(const moving_convex *body, const wall *w)
{
  if (w->is_plane || w->shape.shape.kind != (uint)SHAPE_TRIANGLE) return 0;
  return dot3(from_shape_axes(&w->shape.shape, normal_of_triangle(&w->shape.shape)),
              subtract(body->linear, w->shape.linear)) > R(0.0);
}

SHARED moving_convex solved_motion(GLOBAL const float4 *deltas, const convex *shape, vec3 pivot, real radius, uint body)
{
  return moving_convex_of(shape, pivot, xyz(load_float4(deltas, body * 2u)), xyz(load_float4(deltas, body * 2u + 1u)),
                          radius);
}

SHARED void clamp_to_time_of_impact_item(GLOBAL const Parameters *parameters, read_listed_part_pairs pairs,
                                         read_shapes shapes, read_surfaces surfaces, GLOBAL const float4 *positions,
                                         GLOBAL const float4 *orientations, GLOBAL const float4 *deltas,
                                         GLOBAL uint *shares, uint i)
{
  if (!HAS_FEATURE(parameters, CONTINUOUS)) return;
  uint pair = pair_of_item(parameters, pairs.of_kind, i), a = pairs.a[pair], b = pairs.b[pair];
  mask moves_a = body_type_of(shapes.flags[a]) == (uint)BODY_TYPE_DYNAMIC,
       moves_b = body_type_of(shapes.flags[b]) == (uint)BODY_TYPE_DYNAMIC;
  uint body = moves_a ? a : b, other = moves_a ? b : a;
  if ((moves_a && moves_b) || !is_continuous(shapes.flags[body])) return;
  hull_tables tables = tables_of(surfaces, SUPPORT_BRUTE_FORCE);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0)), offset = offset_between(positions, body, other);
  convex shape = load_convex(shapes.size, shapes.convex, shapes.pose, orientations, tables, none,
                             part_of_pair(parameters, pairs.leaf, body, pair, moves_a ? 0u : 1u));
  moving_convex moving = solved_motion(deltas, &shape, none, load_float4(shapes.size, body).w, body);
  if (length_of(moving.linear) + fastest_swing(&moving) <= FAR_SHARE * least_size(&shape)) return;
  wall w;
  w.is_plane = shape_of(shapes.flags[other]) == (uint)SHAPE_HALF_SPACE;
  w.up = axis_y(rotation_of(quat_from(load_float4(orientations, other))));
  w.linear = xyz(load_float4(deltas, other * 2u));
  w.height = dot3(w.up, offset);
  convex of_wall = load_convex(shapes.size, shapes.convex, shapes.pose, orientations, tables, offset,
                               part_of_pair(parameters, pairs.leaf, other, pair, moves_a ? 1u : 0u));
  w.shape = solved_motion(deltas, &of_wall, offset, load_float4(shapes.size, other).w, other);
  if (comes_from_behind(&moving, &w)) return;
  real least = w.is_plane ? least_size(&shape) : minimum(least_size(&shape), least_size(&of_wall));
  real share = free_share(&moving, &w, minimum(parameters->slop, parameters->slop_share * least));
  if (share < R(1.0)) ATOMIC_MIN(shares + body, to_uint(share * R(16777216.0)));
}

#endif
