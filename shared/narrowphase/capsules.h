/* capsules.h - the contacts of two capsules, or of a sphere and a capsule.
 *
 *        n ^                          The normal joins the closest points of the two segments. Where the sides of two
 *     (o---x----------o)  b           nearly parallel capsules face each other, the two ends of the part along which
 *       (o-x-------x-----o)  a        they overlap are the contacts (x, with n between them); elsewhere the closest
 *                                     points are the only one. A sphere is a capsule without length.
 *
 * General convex shapes (collide_convex.h) would find the same contacts, one pair at a time. A capsule whose ends
 * differ in radius, or that has continuous collision, is such a shape. A ball of a compound is a capsule here, of no
 * length.
 *
 * Pairs that may pass each other within the step are left to follow_capsules.h.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CAPSULES_H
#define TANDEM_SHARED_NARROWPHASE_CAPSULES_H

#include "shared/narrowphase/closest_segments.h"
#include "shared/narrowphase/pair_lists.h"
#include "shared/narrowphase/time_of_impact.h"

/* Sine of the angle between two segments below which they touch along a line. */
#define CAPSULES_PARALLEL R(0.03)

/* A capsule, seen from any origin in world axes. */
typedef struct {
  vec3 pivot;  /* the centre of its body */
  vec3 middle; /* of the segment, from the pivot */
  vec3 to_end; /* from the middle to the end at the top; 0 for a sphere */
  real radius;
} capsule;

typedef struct {
  capsule a, b;
} capsule_pair;

SHARED capsule capsule_of_collider(GLOBAL const float4 *shapes, GLOBAL const float4 *poses,
                                   GLOBAL const float4 *orientations, vec3 pivot, mask is_sphere, collider of)
{
  vec4 size = load_float4(shapes, of.shape);
  mat3 rotation = rotation_of(quat_from(load_float4(orientations, of.body)));
  vec3 axis = axis_y(rotation_of(quat_from(load_float4(poses, of.shape * 4u + 1u))));
  capsule c;
  c.pivot = pivot;
  c.middle = rotate(rotation, xyz(load_float4(poses, of.shape * 4u)));
  c.to_end = scale(rotate(rotation, axis), choose(is_sphere, (real)R(0.0), size.y));
  c.radius = size.x;
  return c;
}

SHARED vec3 middle_of_capsule(capsule c) { return add(c.pivot, c.middle); }

/* The capsule after a time, seen from a point that moves with the velocity `seen_from`. */
SHARED capsule capsule_after(capsule c, spatial_velocity velocity, vec3 seen_from, real time)
{
  mat3 turn = turn_within(velocity.angular, time);
  c.pivot = add_scaled(c.pivot, subtract(velocity.linear, seen_from), time);
  c.middle = rotate(turn, c.middle);
  c.to_end = rotate(turn, c.to_end);
  return c;
}
SHARED capsule_pair capsules_after(capsule_pair pair, pair_motion moves, real time)
{
  capsule_pair then = {capsule_after(pair.a, moves.a, moves.a.linear, time),
                       capsule_after(pair.b, moves.b, moves.a.linear, time)};
  return then;
}

SHARED segment_points closest_of_capsules(capsule_pair pair)
{
  return closest_of_segments(middle_of_capsule(pair.a), pair.a.to_end, middle_of_capsule(pair.b), pair.b.to_end);
}

/* The gap along a unit normal from a to b. */
SHARED real gap_of_capsules_along(capsule_pair pair, vec3 normal)
{
  return dot3(normal, subtract(middle_of_capsule(pair.b), middle_of_capsule(pair.a))) -
         magnitude(dot3(normal, pair.a.to_end)) - magnitude(dot3(normal, pair.b.to_end)) - pair.a.radius -
         pair.b.radius;
}

/* The normal of two segments that meet, from a to b: perpendicular to both, and if they are parallel, perpendicular to
 * them and as near to `aside` as that allows. */
SHARED vec3 normal_of_crossing(capsule_pair pair, vec3 aside)
{
  real one = R(1.0), squared_a = length_squared(pair.a.to_end), squared_b = length_squared(pair.b.to_end);
  vec3 across = cross3(pair.a.to_end, pair.b.to_end),
       axis = choose3(squared_a >= squared_b, pair.a.to_end, pair.b.to_end);
  real area = length_of(across), squared = maximum(squared_a, squared_b);
  mask crosses = area * area > R(1e-6) * squared_a * squared_b;
  mask behind = dot3(across, subtract(middle_of_capsule(pair.b), middle_of_capsule(pair.a))) < R(0.0);
  real inverse = one / choose(crosses, choose(behind, -area, area), one);

  mask long_enough = squared > R(0.0);
  vec3 unit = scale(axis, one / choose(long_enough, square_root(squared), one));
  vec3 flat = add_scaled(aside, unit, -dot3(aside, unit));
  real length = length_of(flat);
  mask is_aside = length > R(0.1);
  vec3 beside = choose3(is_aside, scale(flat, one / choose(is_aside, length, one)), tangents_of(unit).first);
  return choose3(crosses, scale(across, inverse), beside);
}

/* A vector without its part along an axis, where that is wanted. */
SHARED vec3 without_part_along(vec3 v, vec3 axis, mask wanted)
{
  real squared = length_squared(axis);
  mask removed = wanted & (squared > R(0.0));
  return add_scaled(v, axis, choose(removed, -dot3(v, axis) / choose(removed, squared, (real)R(1.0)), (real)R(0.0)));
}

/* The vector between the closest points, perpendicular to the segments inside of which they lie. Of long segments that
 * are near each other, rounding of the points alone would turn the normal. */
SHARED vec3 between_closest(capsule_pair pair, segment_points p)
{
  mask inside_a = magnitude(p.place_a) < R(1.0), inside_b = magnitude(p.place_b) < R(1.0);
  vec3 between = subtract(p.on_b, p.on_a), across = cross3(pair.a.to_end, pair.b.to_end);
  real area = length_squared(across);
  mask crossing =
      inside_a & inside_b & (area > SEGMENTS_CROSS * length_squared(pair.a.to_end) * length_squared(pair.b.to_end));
  vec3 flat = without_part_along(without_part_along(between, pair.b.to_end, inside_b), pair.a.to_end, inside_a);
  return choose3(crossing, scale(across, dot3(between, across) / choose(crossing, area, (real)R(1.0))), flat);
}

/* The point of a contact beside a place on the segment of a. below: separation of the surfaces there. */
SHARED vec4 point_beside(vec3 on_a, vec3 normal, real radius, real separation)
{
  return extend(add_scaled(on_a, normal, radius + separation * R(0.5)), separation);
}

/* The part along which two segments overlap, seen along a normal: from `enter` to `leave` on that of a, -1 to 1. */
typedef struct {
  real enter, leave;
  mask wide; /* whether the sides of the capsules face each other along a part of some length */
} side_overlap;

/* Whether the normal meets the side of a capsule rather than an end: it is 60 degrees or more from the axis. */
SHARED mask faces_side(vec3 to_end, vec3 normal)
{
  real along = dot3(to_end, normal), squared = length_squared(to_end);
  return (squared > R(0.0)) & (along * along <= R(0.25) * squared);
}

SHARED side_overlap overlap_of_sides(capsule_pair pair, vec3 normal)
{
  vec3 half_a = pair.a.to_end, half_b = pair.b.to_end;
  vec3 flat_a = add_scaled(half_a, normal, -dot3(half_a, normal)),
       between = subtract(middle_of_capsule(pair.b), middle_of_capsule(pair.a));
  real squared = length_squared(flat_a), along = dot3(flat_a, half_b), across = dot3(normal, cross3(half_a, half_b));
  mask facing = faces_side(half_a, normal) & faces_side(half_b, normal) &
                (magnitude(across) <= CAPSULES_PARALLEL * magnitude(along));
  real inverse = R(1.0) / choose(facing, squared, (real)R(1.0));
  real middle = dot3(flat_a, between) * inverse, reach = magnitude(along) * inverse;
  side_overlap overlap = {maximum(middle - reach, R(-1.0)), minimum(middle + reach, R(1.0)), facing};
  overlap.wide = facing & (overlap.leave - overlap.enter > R(1e-3));
  return overlap;
}

/* The contact above a place on the segment of a, with the part of b that lies beside it. */
SHARED vec4 point_between_sides(capsule_pair pair, vec3 normal, real place)
{
  vec3 on_a = add_scaled(middle_of_capsule(pair.a), pair.a.to_end, place), middle_b = middle_of_capsule(pair.b);
  vec3 flat_b = add_scaled(pair.b.to_end, normal, -dot3(pair.b.to_end, normal));
  real on_b = place_on_segment(dot3(subtract(on_a, middle_b), flat_b), length_squared(flat_b));
  real separation =
      dot3(normal, subtract(add_scaled(middle_b, pair.b.to_end, on_b), on_a)) - pair.a.radius - pair.b.radius;
  return point_beside(on_a, normal, pair.a.radius, separation);
}

/* The pair is seen from the centre of body a. aside: the direction in which two that lie in each other part. */
SHARED manifold contact_of_capsules(capsule_pair pair, vec3 aside)
{
  segment_points p = closest_of_capsules(pair);
  vec3 between = between_closest(pair, p);
  real distance = length_of(between), radii = pair.a.radius + pair.b.radius;
  real size = length_of(pair.a.to_end) + length_of(pair.b.to_end) + radii;
  mask apart = distance > R(8.0) * ROUNDING * size;
  vec3 normal =
      choose3(apart, scale(between, R(1.0) / choose(apart, distance, (real)R(1.0))), normal_of_crossing(pair, aside));
  real separation = distance - radii;
  manifold m = single_contact(normal, p.on_a, separation, separation == separation);
  m.point[0] = point_beside(p.on_a, normal, pair.a.radius, separation);

  side_overlap overlap = overlap_of_sides(pair, normal);
  vec4 first = point_between_sides(pair, normal, overlap.enter),
       last = point_between_sides(pair, normal, overlap.leave);
  mask two = m.kept[0] & overlap.wide & (minimum(first.w, last.w) <= separation + size * R(1e-4));
  m.point[0] = choose4(two, first, m.point[0]);
  m.point[1] = choose4(two, last, m.point[1]);
  m.kept[1] = two;
  return m;
}

SHARED manifold capsules_within_reach(GLOBAL const Parameters *parameters, capsule_pair pair, vec3 aside,
                                      pair_motion moves)
{
  manifold m = contact_of_capsules(pair, aside);
  return kept_within(m, reach_of_pair(parameters, moves, m.normal));
}

/* Two capsules of a pair as they move. aside: the direction in which two that lie in each other part. */
typedef struct {
  capsule_pair pair;
  vec3 aside;
  pair_motion moves;
  toi_input input;
  real least;
} moving_capsules;

SHARED moving_capsules load_moving_capsules(GLOBAL const uint *flags, GLOBAL const float4 *shapes,
                                            GLOBAL const float4 *poses, read_bodies bodies,
                                            GLOBAL const Parameters *parameters, collider a, collider b)
{
  mask a_is_sphere = shape_of(load_uint(flags, a.shape)) == (uint)SHAPE_SPHERE,
       b_is_sphere = shape_of(load_uint(flags, b.shape)) == (uint)SHAPE_SPHERE;
  real zero = R(0.0);
  moving_capsules p;
  p.pair.a = capsule_of_collider(shapes, poses, bodies.orientation, make_vec3(zero, zero, zero), a_is_sphere, a);
  p.pair.b = capsule_of_collider(shapes, poses, bodies.orientation, offset_between(bodies.position, a.body, b.body),
                                 b_is_sphere, b);
  p.aside = parting_direction(parameters, bodies.gravity, a.body, b.body);
  p.moves =
      load_pair_motion(bodies, parameters, a.body, b.body, choose(a_is_sphere, zero, load_float4(shapes, a.body).w),
                       choose(b_is_sphere, zero, load_float4(shapes, b.body).w));
  p.least = minimum(p.pair.a.radius, p.pair.b.radius);
  real size = length_of(p.pair.a.to_end) + length_of(p.pair.b.to_end) + p.pair.a.radius + p.pair.b.radius;
  p.input = toi_input_of_step(parameters, p.moves, p.least, size);
  return p;
}

SHARED speculation speculation_of_capsules(GLOBAL const Parameters *parameters, manifold m, const moving_capsules *p)
{
  return speculation_of(parameters, m, p->pair.b.pivot, p->moves, p->input, p->least);
}

SHARED void collide_capsules(uint kind, read_listed_part_pairs pairs, GLOBAL const uint *flags,
                             GLOBAL const float4 *shapes, GLOBAL const float4 *poses, read_bodies bodies,
                             GLOBAL const Parameters *parameters, GLOBAL const uint *counts, write_manifolds manifolds,
                             item_index i)
{
  handled_parts item = handled_part_pair(parameters, pairs, flags, kind, i);
  if (!any_of(item.mine)) return;
  moving_capsules p = load_moving_capsules(flags, shapes, poses, bodies, parameters, item.a, item.b);
  manifold m = capsules_within_reach(parameters, p.pair, p.aside, p.moves);
  store_manifold_if(item.mine, m, planes_of(counts), manifolds, item.pair);
  mark_to_follow_if(item.mine & speculation_of_capsules(parameters, m, &p).asked, m, manifolds.count, item.pair);
}

SHARED void collide_capsule_capsule_item(read_listed_part_pairs pairs, GLOBAL const uint *flags,
                                         GLOBAL const float4 *shapes, GLOBAL const float4 *poses, read_bodies bodies,
                                         GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                         write_manifolds manifolds, item_index i)
{
  collide_capsules(PAIR_KIND_CAPSULE_CAPSULE, pairs, flags, shapes, poses, bodies, parameters, counts, manifolds, i);
}

SHARED void collide_sphere_capsule_item(read_listed_part_pairs pairs, GLOBAL const uint *flags,
                                        GLOBAL const float4 *shapes, GLOBAL const float4 *poses, read_bodies bodies,
                                        GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                        write_manifolds manifolds, item_index i)
{
  collide_capsules(PAIR_KIND_SPHERE_CAPSULE, pairs, flags, shapes, poses, bodies, parameters, counts, manifolds, i);
}

#endif
