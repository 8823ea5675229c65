/* collide_convex.h - pairs with a shape that has no test of its own: any two convex shapes, and one above a half-space.
 *
 *            sphere  box  half-space  other
 *   sphere     .      .       .         x        .  a header of its own (sphere_box.h ...)
 *   box               .       .         x        x  here
 *   half-space                -         x        -  neither moves
 *   other                               x        other: capsule, cylinder, cone, hull; a sphere or box beside its body's centre
 *
 * Branches follow the data: shapes of one pair differ too much for lanes.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_COLLIDE_CONVEX_H
#define TANDEM_SHARED_NARROWPHASE_COLLIDE_CONVEX_H

#include "shared/narrowphase/convex_contact.h"
#include "shared/narrowphase/convex_half_space.h"

/* What body_shape, body_convex and body_shape_pose say of a body. offset: the body's centre in the frame of the pair. */
SHARED convex load_convex(GLOBAL const row *shapes, GLOBAL const uint *convexes, GLOBAL const row *poses, GLOBAL const row *orientations,
                          hull_tables tables, vec3 offset, uint body)
{
  quat turned = quat_from(load_row(orientations, body)), own = quat_from(load_row(poses, body * 4u + 1u));
  vec3 center = add(offset, rotate(rotation_of(turned), xyz(load_row(poses, body * 4u))));
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  return convex_of(convexes[body * 2u], xyz(load_row(shapes, body)), rotation_of(quat_multiply(turned, own)), center, none, convexes[body * 2u + 1u],
                   tables);
}

SHARED int takes_part(uint shape) { return shape == SHAPE_SPHERE || shape == SHAPE_BOX || shape == SHAPE_OTHER; }

/* Whatever the normal will be, no gap is closed faster than the bodies approach. */
SHARED real widest_reach(GLOBAL const Parameters *parameters, motion a, real radius_a, motion b, real radius_b)
{
  vec3 approach = subtract(a.linear, b.linear);
  real speed = length_of(approach);
  return reach_of(parameters, a, radius_a, b, radius_b, scale(approach, R(1.0) / maximum(speed, R(1e-20))));
}

/* A pair of convex shapes, seen from the centre of the first one's body in world axes. */
typedef struct {
  convex first, second;
  motion motion_a, motion_b;
  real radius_a, radius_b; /* what turning can swing round: 0 of a sphere */
  real reach;              /* whatever the normal */
} convex_query;

enum { QUERY_OF_OTHERS = 0, QUERY_APART = 1, QUERY_NEAR = 2 };

/* QUERY_APART: not even the balls around the shapes are within reach; the shapes are then not loaded. method: CONVEX_ in its low
 * byte, SUPPORT_ in the next. */
SHARED int load_convex_query(convex_query *query, GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *traits,
                             GLOBAL const row *shapes, GLOBAL const uint *convexes, GLOBAL const row *poses, GLOBAL const uint *headers,
                             GLOBAL const row *vertices, GLOBAL const row *planes, GLOBAL const uint *face_starts, GLOBAL const uint *corners,
                             GLOBAL const uint *edges, GLOBAL const row *strips, GLOBAL const uint *links, GLOBAL const row *positions,
                             GLOBAL const row *orientations, GLOBAL const row *velocities, GLOBAL const Parameters *parameters, uint method, uint i)
{
  uint a = pair_a[i], b = pair_b[i], shape_a = shape_of(traits[a]), shape_b = shape_of(traits[b]);
  if (!takes_part(shape_a) || !takes_part(shape_b) || (shape_a != SHAPE_OTHER && shape_b != SHAPE_OTHER)) return QUERY_OF_OTHERS;
  query->motion_a = load_motion(velocities, a);
  query->motion_b = load_motion(velocities, b);
  real around_a = load_row(shapes, a).w, around_b = load_row(shapes, b).w;
  query->radius_a = choose(shape_a == SHAPE_SPHERE, R(0.0), around_a);
  query->radius_b = choose(shape_b == SHAPE_SPHERE, R(0.0), around_b);
  query->reach = widest_reach(parameters, query->motion_a, query->radius_a, query->motion_b, query->radius_b);
  vec3 offset = offset_between(positions, a, b);
  real farthest = around_a + around_b + query->reach;
  if (length_squared(offset) > farthest * farthest * R(1.0001)) return QUERY_APART;
  hull_tables tables = {headers, vertices, planes, face_starts, corners, edges, strips, links, method >> 8u};
  query->first = load_convex(shapes, convexes, poses, orientations, tables, make_vec3(R(0.0), R(0.0), R(0.0)), a);
  query->second = load_convex(shapes, convexes, poses, orientations, tables, offset, b);
  return QUERY_NEAR;
}

SHARED manifold within_reach(GLOBAL const Parameters *parameters, const convex_query *query, manifold m)
{
  return kept_within(m, reach_of(parameters, query->motion_a, query->radius_a, query->motion_b, query->radius_b, m.normal));
}

SHARED void collide_convex_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *traits, GLOBAL const row *shapes,
                                GLOBAL const uint *convexes, GLOBAL const row *poses, GLOBAL const uint *headers, GLOBAL const row *vertices,
                                GLOBAL const row *planes, GLOBAL const uint *face_starts, GLOBAL const uint *corners, GLOBAL const uint *edges,
                                GLOBAL const row *strips, GLOBAL const uint *links, GLOBAL const row *positions, GLOBAL const row *orientations,
                                GLOBAL const row *velocities, GLOBAL const Parameters *parameters, GLOBAL const uint *counts, GLOBAL row *normals,
                                GLOBAL row *points, GLOBAL uint *counts_of_points, GLOBAL uint *features, uint method, uint i)
{
  convex_query query;
  int near = load_convex_query(&query, pair_a, pair_b, traits, shapes, convexes, poses, headers, vertices, planes, face_starts, corners, edges, strips,
                               links, positions, orientations, velocities, parameters, method, i);
  if (near == QUERY_OF_OTHERS) return;
  if (near == QUERY_APART) {
    store_no_manifold(counts[CAPACITY_PAIRS], normals, points, counts_of_points, features, i);
    return;
  }
  manifold m = within_reach(parameters, &query, convex_contact(&query.first, &query.second, query.reach, parameters->slop, method & 255u));
  store_manifold_if(1, m, counts[CAPACITY_PAIRS], normals, points, counts_of_points, features, i);
}

SHARED void collide_convex_half_space_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *traits,
                                           GLOBAL const row *shapes, GLOBAL const uint *convexes, GLOBAL const row *poses,
                                           GLOBAL const uint *headers, GLOBAL const row *vertices, GLOBAL const row *planes,
                                           GLOBAL const uint *face_starts, GLOBAL const uint *corners, GLOBAL const uint *edges,
                                           GLOBAL const row *strips, GLOBAL const uint *links, GLOBAL const row *positions, GLOBAL const row *orientations, GLOBAL const row *velocities,
                                           GLOBAL const Parameters *parameters, GLOBAL const uint *counts, GLOBAL row *normals, GLOBAL row *points,
                                           GLOBAL uint *counts_of_points, GLOBAL uint *features, uint i)
{
  uint a = pair_a[i], b = pair_b[i], shape_a = shape_of(traits[a]), shape_b = shape_of(traits[b]);
  int body_first = shape_a == SHAPE_OTHER && shape_b == SHAPE_HALF_SPACE;
  if (!body_first && !(shape_a == SHAPE_HALF_SPACE && shape_b == SHAPE_OTHER)) return;
  uint body = body_first ? a : b, plane = body_first ? b : a;
  hull_tables tables = {headers, vertices, planes, face_starts, corners, edges, strips, links, SUPPORT_BRUTE_FORCE};
  convex shape = load_convex(shapes, convexes, poses, orientations, tables, make_vec3(R(0.0), R(0.0), R(0.0)), body);
  vec3 up = axis_y(rotation_of(quat_from(load_row(orientations, plane)))), to_plane = offset_between(positions, body, plane);
  real reach = reach_of(parameters, load_motion(velocities, body), load_row(shapes, body).w, load_motion(velocities, plane), R(0.0), negate(up));
  manifold m = convex_on_half_space(&shape, up, inner(up, to_plane), reach);
  if (!body_first) {
    m.normal = up;
    for (int slot = 0; slot < 4; ++slot) m.point[slot] = extend(subtract(xyz(m.point[slot]), to_plane), m.point[slot].w);
  }
  store_manifold_if(1, m, counts[CAPACITY_PAIRS], normals, points, counts_of_points, features, i);
}

#endif
