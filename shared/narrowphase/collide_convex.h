/* collide_convex.h - the collision of pairs whose shapes have no test of their own: any two convex shapes, and a convex
 * shape with a half-space.
 *
 * The table in pairs.def shows which pairs these are. A pair of a compound or a mesh holds one child or one triangle of
 * it (midphase/leaf_pairs.h).
 *
 * The branches depend on data, because the shapes of neighbouring pairs differ too much for lanes.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_COLLIDE_CONVEX_H
#define TANDEM_SHARED_NARROWPHASE_COLLIDE_CONVEX_H

#include "shared/narrowphase/conservative_advancement.h"
#include "shared/narrowphase/convex_contact.h"
#include "shared/narrowphase/convex_half_space.h"
#include "shared/narrowphase/pair_lists.h"
#include "shared/narrowphase/triangle_contact.h"

/* The part of a body that a pair is about. In a scene without trees it is the only shape of the body, and has the
 * body's index. */
typedef struct {
  uint body, shape, triangle;
} body_part;

SHARED body_part part_of_pair(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_leaf, uint body, uint i,
                              uint side)
{
  body_part part = {body, body, INDEX_NONE};
  if (!HAS_FEATURE(parameters, TREES)) return part;
  part.shape = pair_leaf[i * 4u + side * 2u];
  part.triangle = pair_leaf[i * 4u + side * 2u + 1u];
  return part;
}

/* Loads a part from body_shape, body_convex and body_shape_pose. offset: the body's centre in the frame of the pair. */
SHARED convex load_convex(GLOBAL const float4 *shapes, GLOBAL const uint *convexes, GLOBAL const float4 *poses,
                          GLOBAL const float4 *orientations, hull_tables tables, vec3 offset, body_part part)
{
  quat turned = quat_from(load_float4(orientations, part.body)),
       own = quat_from(load_float4(poses, part.shape * 4u + 1u));
  vec3 center = add(offset, rotate(rotation_of(turned), xyz(load_float4(poses, part.shape * 4u))));
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  mat3 rotation = rotation_of(quat_multiply(turned, own));
  if (part.triangle != INDEX_NONE) return triangle_of(tables, part.triangle, rotation, center);
  return convex_of(convexes[part.shape * 2u], xyz(load_float4(shapes, part.shape)), rotation, center, none,
                   convexes[part.shape * 2u + 1u], tables);
}

/* The largest reach for any normal: no gap closes faster than the bodies approach. */
SHARED real widest_reach(GLOBAL const Parameters *parameters, pair_motion moves)
{
  vec3 approach = subtract(subtract(moves.a.linear, moves.b.linear), moves.fall);
  real speed = length_of(approach);
  return reach_of_pair(parameters, moves, scale(approach, R(1.0) / maximum(speed, R(1e-20))));
}

SHARED manifold contact_of_parts(GLOBAL const Parameters *parameters, const convex *first, const convex *second,
                                 real reach, real thickness, uint method)
{
  mask triangles = is_triangle(first) || is_triangle(second);
  if (HAS_FEATURE(parameters, TREES) && triangles)
    return triangle_contact(first, second, reach, thickness, parameters->slop);
  return convex_contact(first, second, reach, parameters->slop, method);
}

/* A pair of convex shapes, seen from the centre of the first one's body in world axes. */
typedef struct {
  convex first, second;
  pair_motion moves;
  vec3 offset;    /* centre of the second one's body */
  real reach;     /* an upper bound, for any normal */
  real thickness; /* of the thinner body */
} convex_query;

/* False if not even the bounding spheres of the bodies are within reach; the shapes are then not loaded. method:
 * CONVEX_ in its low byte, SUPPORT_ in the next. */
SHARED mask load_convex_query(convex_query *query, read_listed_part_pairs pairs, read_shapes shapes,
                              read_surfaces surfaces, read_bodies bodies, GLOBAL const Parameters *parameters,
                              uint method, uint pair)
{
  uint a = pairs.a[pair], b = pairs.b[pair], shape_a = shape_of(shapes.flags[a]), shape_b = shape_of(shapes.flags[b]);
  real around_a = load_float4(shapes.size, a).w, around_b = load_float4(shapes.size, b).w;
  query->moves = load_pair_motion(bodies, parameters, a, b, choose(shape_a == SHAPE_SPHERE, R(0.0), around_a),
                                  choose(shape_b == SHAPE_SPHERE, R(0.0), around_b));
  query->reach = widest_reach(parameters, query->moves);
  query->offset = offset_between(bodies.position, a, b);
  real farthest = around_a + around_b + query->reach;
  if (length_squared(query->offset) > farthest * farthest * R(1.0001)) return 0;
  query->thickness = size_between(shapes.size, a, b);
  hull_tables tables = tables_of(surfaces, method >> 8u);
  query->first = load_convex(shapes.size, shapes.convex, shapes.pose, bodies.orientation, tables,
                             make_vec3(R(0.0), R(0.0), R(0.0)), part_of_pair(parameters, pairs.leaf, a, pair, 0u));
  query->second = load_convex(shapes.size, shapes.convex, shapes.pose, bodies.orientation, tables, query->offset,
                              part_of_pair(parameters, pairs.leaf, b, pair, 1u));
  return 1;
}

SHARED manifold within_reach(GLOBAL const Parameters *parameters, const convex_query *query, manifold m)
{
  return kept_within(m, reach_of_pair(parameters, query->moves, m.normal));
}

/* The manifold of the shapes at the poses that the query holds. */
SHARED manifold contact_of_query(GLOBAL const Parameters *parameters, const convex_query *query, uint method)
{
  return within_reach(
      parameters, query,
      contact_of_parts(parameters, &query->first, &query->second, query->reach, query->thickness, method));
}

SHARED real least_of_query(const convex_query *query)
{
  return minimum(least_size(&query->first), least_size(&query->second));
}

SHARED toi_input toi_input_of_query(GLOBAL const Parameters *parameters, const convex_query *query)
{
  real size = bounding_radius_of(&query->first) + bounding_radius_of(&query->second);
  return toi_input_of_step(parameters, query->moves, least_of_query(query), size);
}

/* A triangle makes no contact with a shape beside it, so a pair without a contact may still meet within the step if the
 * triangle's plane is approached. */
SHARED mask may_meet_triangle(GLOBAL const Parameters *parameters, const convex_query *query)
{
  mask of_a = is_triangle(&query->first);
  const convex *triangle = of_a ? &query->first : &query->second;
  vec3 normal = from_shape_axes(triangle, normal_of_triangle(triangle));
  real closing = closing_speed(query->moves, of_a ? normal : negate(normal));
  return closing * parameters->step > toi_input_of_query(parameters, query).touching;
}

/* Whether follow_convexes (follow_convexes.h) must process the pair whose manifold at the start of the step is m. */
SHARED mask is_ahead(GLOBAL const Parameters *parameters, const convex_query *query, manifold m)
{
  if (has_points(m))
    return speculation_of(parameters, m, query->offset, query->moves, toi_input_of_query(parameters, query),
                          least_of_query(query))
        .asked;
  return m.impact_time >= BESIDE && may_meet_triangle(parameters, query);
}

SHARED void store_start(GLOBAL const Parameters *parameters, const convex_query *query, manifold m, point_planes planes,
                        write_manifolds manifolds, uint pair)
{
  store_manifold_if(1, m, planes, manifolds, pair);
  mark_to_follow_if(is_ahead(parameters, query, m), m, manifolds.count, pair);
}

/* The pair of item i; false if another kernel handles it. */
SHARED mask is_convex_pair(uint *pair, GLOBAL const Parameters *parameters, read_listed_part_pairs pairs,
                           GLOBAL const uint *flags, uint kind, uint i)
{
  *pair = pair_of_item(parameters, pairs.of_kind, i);
  return is_of_kind(parameters, flags, pairs.a[*pair], pairs.b[*pair], kind);
}

SHARED void collide_convex_item(read_listed_part_pairs pairs, read_shapes shapes, read_surfaces surfaces,
                                read_bodies bodies, GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                write_manifolds manifolds, uint method, uint i)
{
  /* This test lets a device compiler drop the whole kernel in scenes without such pairs. */
  if (!HAS_FEATURE(parameters, CONVEX_CONVEX)) return;
  uint pair;
  point_planes planes = planes_of(counts);
  if (!is_convex_pair(&pair, parameters, pairs, shapes.flags, PAIR_KIND_CONVEX_CONVEX, i)) return;
  convex_query query;
  if (load_convex_query(&query, pairs, shapes, surfaces, bodies, parameters, method, pair))
    store_start(parameters, &query, contact_of_query(parameters, &query, method & 255u), planes, manifolds, pair);
  else store_no_manifold(planes, manifolds, pair);
}

SHARED void collide_convex_half_space_item(read_listed_part_pairs pairs, read_shapes shapes, read_surfaces surfaces,
                                           read_bodies bodies, GLOBAL const Parameters *parameters,
                                           GLOBAL const uint *counts, write_manifolds manifolds, uint i)
{
  uint pair;
  if (!HAS_FEATURE(parameters, CONVEX_HALF_SPACE)) return;
  if (!is_convex_pair(&pair, parameters, pairs, shapes.flags, PAIR_KIND_CONVEX_HALF_SPACE, i)) return;
  uint a = pairs.a[pair], b = pairs.b[pair];
  int body_first = shape_of(shapes.flags[b]) == SHAPE_HALF_SPACE;
  uint body = body_first ? a : b, plane = body_first ? b : a;
  hull_tables tables = tables_of(surfaces, SUPPORT_BRUTE_FORCE);
  convex shape = load_convex(shapes.size, shapes.convex, shapes.pose, bodies.orientation, tables,
                             make_vec3(R(0.0), R(0.0), R(0.0)),
                             part_of_pair(parameters, pairs.leaf, body, pair, body_first ? 0u : 1u));
  vec3 up = axis_y(rotation_of(quat_from(load_float4(bodies.orientation, plane)))),
       to_plane = offset_between(bodies.position, body, plane);
  real radius = load_float4(shapes.size, body).w, height = dot3(up, to_plane), least = least_size(&shape);
  pair_motion moves = load_pair_motion(bodies, parameters, body, plane, radius, R(0.0));
  real reach = reach_of_pair(parameters, moves, negate(up));
  manifold m = convex_on_half_space(&shape, up, height, reach);

  /* A plane has no edge that a body could pass, so only a turning body can miss it. */
  toi_input input = toi_input_of_step(parameters, moves, least, bounding_radius_of(&shape));
  speculation s = speculation_of(parameters, m, to_plane, moves, input, least);
  if (s.asked && fastest_turning(moves) > R(0.0)) {
    encounter met = meet_plane(parameters, &shape, up, &height, moves.a, radius, moves.b, input, s);
    if (met.at_impact) m = convex_on_half_space(&shape, up, height, reach);
    to_plane = offset_after(to_plane, moves, met.at_impact ? met.time : R(0.0));
    m = as_seen_from_start(parameters, m, met, to_plane, moves);
  }
  if (!body_first) {
    m.normal = up;
    for (int slot = 0; slot < 4; ++slot)
      m.point[slot] = extend(subtract(xyz(m.point[slot]), to_plane), m.point[slot].w);
  }
  store_manifold_if(1, m, planes_of(counts), manifolds, pair);
}

#endif
