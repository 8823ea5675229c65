/* collide_convex.h - pairs with a shape that has no test of its own: any two convex shapes, and one above a half-space.
 *
 *            sphere  box  half-space  other
 *   sphere     .      .       .         x        .  a header of its own (sphere_box.h ...)
 *   box               .       .         x        x  here
 *   half-space                -         x        -  neither moves
 *   other                               x        other: capsule, cylinder, cone, hull; a sphere or box beside its body's centre;
 *                                                 compound and mesh, of which a pair holds one child or triangle (midphase/leaf_pairs.h)
 *
 * Branches follow the data: shapes of one pair differ too much for lanes.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_COLLIDE_CONVEX_H
#define TANDEM_SHARED_NARROWPHASE_COLLIDE_CONVEX_H

#include "shared/narrowphase/convex_contact.h"
#include "shared/narrowphase/convex_half_space.h"
#include "shared/narrowphase/triangle_contact.h"

/* The part of a body that takes part in a pair. Without trees it is the body's only shape, whose number is that of the body. */
typedef struct { uint body, shape, triangle; } body_part;

SHARED body_part part_of_pair(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_leaf, uint body, uint i, uint side)
{
  body_part part = {body, body, INDEX_NONE};
  if (!HAS_FEATURE(parameters, FEATURE_TREES)) return part;
  part.shape = pair_leaf[i * 4u + side * 2u];
  part.triangle = pair_leaf[i * 4u + side * 2u + 1u];
  return part;
}

/* What body_shape, body_convex and body_shape_pose say of a part. offset: the body's centre in the frame of the pair. */
SHARED convex load_convex(GLOBAL const row *shapes, GLOBAL const uint *convexes, GLOBAL const row *poses, GLOBAL const row *orientations,
                          hull_tables tables, vec3 offset, body_part part)
{
  quat turned = quat_from(load_row(orientations, part.body)), own = quat_from(load_row(poses, part.shape * 4u + 1u));
  vec3 center = add(offset, rotate(rotation_of(turned), xyz(load_row(poses, part.shape * 4u))));
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  mat3 rotation = rotation_of(quat_multiply(turned, own));
  if (part.triangle != INDEX_NONE) return triangle_of(tables, part.triangle, rotation, center);
  return convex_of(convexes[part.shape * 2u], xyz(load_row(shapes, part.shape)), rotation, center, none, convexes[part.shape * 2u + 1u], tables);
}

SHARED int takes_part(uint shape) { return shape == SHAPE_SPHERE || shape == SHAPE_BOX || shape == SHAPE_OTHER; }

/* Whatever the normal will be, no gap is closed faster than the bodies approach. */
SHARED real widest_reach(GLOBAL const Parameters *parameters, motion a, real radius_a, motion b, real radius_b)
{
  vec3 approach = subtract(a.linear, b.linear);
  real speed = length_of(approach);
  return reach_of(parameters, a, radius_a, b, radius_b, scale(approach, R(1.0) / maximum(speed, R(1e-20))));
}

SHARED manifold contact_of_parts(GLOBAL const Parameters *parameters, const convex *first, const convex *second, real reach, real thickness, uint method)
{
  mask triangles = first->kind == (uint)SHAPE_TRIANGLE || second->kind == (uint)SHAPE_TRIANGLE;
  if (HAS_FEATURE(parameters, FEATURE_TREES) && triangles) return triangle_contact(first, second, reach, thickness, parameters->slop);
  return convex_contact(first, second, reach, parameters->slop, method);
}

SHARED void collide_convex_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *traits, GLOBAL const row *shapes,
                                GLOBAL const uint *convexes, GLOBAL const row *poses, GLOBAL const uint *headers, GLOBAL const row *vertices,
                                GLOBAL const row *planes, GLOBAL const uint *face_starts, GLOBAL const uint *corners, GLOBAL const uint *edges,
                                GLOBAL const uint *pair_leaf, GLOBAL const row *mesh_vertices, GLOBAL const uint *mesh_triangles, GLOBAL const row *positions, GLOBAL const row *orientations, GLOBAL const row *velocities,
                                GLOBAL const Parameters *parameters, GLOBAL const uint *counts, GLOBAL row *normals, GLOBAL row *points,
                                GLOBAL uint *counts_of_points, GLOBAL uint *features, uint method, uint i)
{
  uint a = pair_a[i], b = pair_b[i], shape_a = shape_of(traits[a]), shape_b = shape_of(traits[b]);
  if (!takes_part(shape_a) || !takes_part(shape_b) || (shape_a != SHAPE_OTHER && shape_b != SHAPE_OTHER)) return;
  hull_tables tables = {headers, vertices, planes, face_starts, corners, edges, mesh_vertices, mesh_triangles};
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  convex first_shape = load_convex(shapes, convexes, poses, orientations, tables, none, part_of_pair(parameters, pair_leaf, a, i, 0u));
  convex second_shape = load_convex(shapes, convexes, poses, orientations, tables, offset_between(positions, a, b),
                                    part_of_pair(parameters, pair_leaf, b, i, 1u));
  motion motion_a = load_motion(velocities, a), motion_b = load_motion(velocities, b);
  real radius_a = choose(shape_a == SHAPE_SPHERE, R(0.0), load_row(shapes, a).w), radius_b = choose(shape_b == SHAPE_SPHERE, R(0.0), load_row(shapes, b).w);
  manifold m = contact_of_parts(parameters, &first_shape, &second_shape, widest_reach(parameters, motion_a, radius_a, motion_b, radius_b), size_between(shapes, a, b), method);
  m = kept_within(m, reach_of(parameters, motion_a, radius_a, motion_b, radius_b, m.normal));
  store_manifold_if(1, m, counts[CAPACITY_PAIRS], normals, points, counts_of_points, features, i);
}

SHARED void collide_convex_half_space_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *traits,
                                           GLOBAL const row *shapes, GLOBAL const uint *convexes, GLOBAL const row *poses,
                                           GLOBAL const uint *headers, GLOBAL const row *vertices, GLOBAL const row *planes,
                                           GLOBAL const uint *face_starts, GLOBAL const uint *corners, GLOBAL const uint *edges,
                                           GLOBAL const uint *pair_leaf, GLOBAL const row *mesh_vertices, GLOBAL const uint *mesh_triangles, GLOBAL const row *positions, GLOBAL const row *orientations, GLOBAL const row *velocities,
                                           GLOBAL const Parameters *parameters, GLOBAL const uint *counts, GLOBAL row *normals, GLOBAL row *points,
                                           GLOBAL uint *counts_of_points, GLOBAL uint *features, uint i)
{
  uint a = pair_a[i], b = pair_b[i], shape_a = shape_of(traits[a]), shape_b = shape_of(traits[b]);
  int body_first = shape_a == SHAPE_OTHER && shape_b == SHAPE_HALF_SPACE;
  if (!body_first && !(shape_a == SHAPE_HALF_SPACE && shape_b == SHAPE_OTHER)) return;
  uint body = body_first ? a : b, plane = body_first ? b : a;
  hull_tables tables = {headers, vertices, planes, face_starts, corners, edges, mesh_vertices, mesh_triangles};
  convex shape = load_convex(shapes, convexes, poses, orientations, tables, make_vec3(R(0.0), R(0.0), R(0.0)),
                             part_of_pair(parameters, pair_leaf, body, i, body_first ? 0u : 1u));
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
