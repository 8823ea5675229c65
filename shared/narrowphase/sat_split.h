/* sat_split.h - contacts of polytopes by the separating axis test, in four kernels instead of one:
 * `--narrowphase sat-split`.
 *
 *   find_separating_axis -> find_clipping_faces -> clip_faces -> reduce_contacts
 *      axis and gap           face of each           points          four of them
 *
 * The talks divide the work like this (E. Coumans, "GPU rigid body simulation", 2013 and 2015). Each kernel has one
 * task and needs fewer registers and diverges less than one kernel for all; the price is the buffers in between and
 * repeated loading of the shapes. Both variants call the same functions, so the bits are those of `sat`. Pairs that the
 * short way does not cover (other shapes, features that do not meet, too many points) are passed to convex_contact() by
 * the last kernel.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_SAT_SPLIT_H
#define TANDEM_SHARED_NARROWPHASE_SAT_SPLIT_H

#include "shared/narrowphase/collide_convex.h"

enum { SPLIT_APART = 1, SPLIT_CLIP = 2, SPLIT_WHOLE = 3 };

/* axes: the normal in the axes of the pair, and the gap along it. state: SPLIT_. */
SHARED void find_separating_axis_item(read_listed_part_pairs pairs, read_shapes shapes, read_surfaces surfaces,
                                      read_bodies bodies, GLOBAL const Parameters *parameters,
                                      write_separating_axes axes, uint method, uint i)
{
  if (!HAS_FEATURE(parameters, SAT_SPLIT)) return;
  uint pair;
  if (!is_convex_pair(&pair, parameters, pairs, shapes.flags, PAIR_KIND_CONVEX_CONVEX, i)) return;
  convex_query query;
  mask near = load_convex_query(&query, pairs, shapes, surfaces, bodies, parameters, method, pair);
  axes.state[pair] = near ? SPLIT_WHOLE : SPLIT_APART;
  store_float4(axes.axis, pair, make_vec4(R(0.0), R(0.0), R(0.0), R(0.0)));
  if (!near || !is_polytope(&query.first) || !is_polytope(&query.second)) return;
  convex_pair both = pair_of(&query.first, &query.second);
  core_contact contact =
      separating_hull_axis(&both.a, &both.b, lead_of_faces(&both.a, &both.b, parameters->slop), query.reach).contact;
  axes.state[pair] = contact.gap >= query.reach ? SPLIT_APART : SPLIT_CLIP;
  store_float4(axes.axis, pair, extend(contact.normal, contact.gap));
}

/* faces: of a and b of the pair; INDEX_NONE if no face is turned to the other shape. */
SHARED void find_clipping_faces_item(read_listed_part_pairs pairs, read_shapes shapes, read_surfaces surfaces,
                                     read_bodies bodies, GLOBAL const Parameters *parameters, read_separating_axes axes,
                                     GLOBAL uint *faces, uint method, uint i)
{
  if (!HAS_FEATURE(parameters, SAT_SPLIT)) return;
  uint pair;
  if (!is_convex_pair(&pair, parameters, pairs, shapes.flags, PAIR_KIND_CONVEX_CONVEX, i)) return;
  faces[pair * 2u] = faces[pair * 2u + 1u] = INDEX_NONE;
  if (axes.state[pair] != SPLIT_CLIP) return;
  convex_query query;
  if (!load_convex_query(&query, pairs, shapes, surfaces, bodies, parameters, method, pair)) return;
  convex_pair both = pair_of(&query.first, &query.second);
  vec3 normal = xyz(load_float4(axes.axis, pair));
  support_face face_a = support_face_of(&both.a, normal), face_b = support_face_of(&both.b, negate(normal));
  faces[pair * 2u] = face_a.corners > 2u ? face_a.feature : INDEX_NONE;
  faces[pair * 2u + 1u] = face_b.corners > 2u ? face_b.feature : INDEX_NONE;
}

/* clipped: u, v, separation and height of b, one plane of all pairs for each point. count: the number of points;
 * INDEX_NONE if there are too many or if a face is missing. */
SHARED void clip_faces_item(read_listed_part_pairs pairs, read_shapes shapes, read_surfaces surfaces,
                            read_bodies bodies, GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                            read_separating_axes axes, GLOBAL const uint *faces, write_clipped_points clipped,
                            uint method, uint i)
{
  if (!HAS_FEATURE(parameters, SAT_SPLIT)) return;
  uint pair;
  if (!is_convex_pair(&pair, parameters, pairs, shapes.flags, PAIR_KIND_CONVEX_CONVEX, i)) return;
  clipped.count[pair] = INDEX_NONE;
  if (axes.state[pair] != SPLIT_CLIP || faces[pair * 2u] == INDEX_NONE || faces[pair * 2u + 1u] == INDEX_NONE) return;
  convex_query query;
  if (!load_convex_query(&query, pairs, shapes, surfaces, bodies, parameters, method, pair)) return;
  convex_pair both = pair_of(&query.first, &query.second);
  contact_axes plane = contact_axes_of(xyz(load_float4(axes.axis, pair)));
  support_face face_a = face_of_polytope(&both.a, faces[pair * 2u]),
               face_b = face_of_polytope(&both.b, faces[pair * 2u + 1u]);
  feature_overlap overlap;
  start_overlap(&overlap, &both.a, &face_a, &both.b, &face_b, &plane, query.reach);
  reduction r;
  start_reduction(&r, bounding_radius_of(&both.b), overlap.clip.slack);
  stream_overlap(&r, &overlap.clip);
  if (r.points > STREAM_KEPT) return;
  clipped.count[pair] = r.points;
  for (uint k = 0u; k < r.points; ++k) {
    clip_point p = r.kept[k];
    store_float4(clipped.point, counts[CAPACITY_PAIRS] * k + pair,
                 make_vec4(p.u, p.v, p.separation, height_of_b(&overlap, &both.a, &both.b, p)));
  }
}

SHARED clip_point stored_point(vec4 stored)
{
  clip_point point = {stored.x, stored.y, stored.z, 1};
  return point;
}

/* The patch of the stored points. False if they miss the deepest point. */
SHARED mask reduced_patch(contact_patch *patch, const convex_pair *pair, vec4 axis, read_clipped_points clipped,
                          uint stride, uint i)
{
  uint count = clipped.count[i];
  reduction r;
  start_reduction(&r, bounding_radius_of(&pair->b), slack_of_corners(&pair->b));
  for (uint k = 0u; k < count; ++k) reduce_step(&r, stored_point(load_float4(clipped.point, stride * k + i)));
  while (next_pass(&r)) reduce_kept(&r);
  if (misses_deepest(&r, axis.w)) return 0;
  patch->axes = contact_axes_of(xyz(axis));
  finish_reduction(patch->point, &r);
  for (int slot = 0; slot < 4; ++slot) {
    patch->height[slot] = R(0.0);
    for (uint k = count; k-- > 0u;) {
      vec4 p = load_float4(clipped.point, stride * k + i);
      if (p.x == patch->point[slot].u && p.y == patch->point[slot].v && p.z == patch->point[slot].separation)
        patch->height[slot] = p.w;
    }
  }
  return 1;
}

SHARED void reduce_contacts_item(read_listed_part_pairs pairs, read_shapes shapes, read_surfaces surfaces,
                                 read_bodies bodies, GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                 read_separating_axes axes, GLOBAL const uint *faces, read_clipped_points clipped,
                                 write_manifolds manifolds, uint method, uint i)
{
  if (!HAS_FEATURE(parameters, SAT_SPLIT)) return;
  uint pair;
  if (!is_convex_pair(&pair, parameters, pairs, shapes.flags, PAIR_KIND_CONVEX_CONVEX, i)) return;
  convex_query query;
  point_planes planes = planes_of(counts);
  if (axes.state[pair] == SPLIT_APART ||
      !load_convex_query(&query, pairs, shapes, surfaces, bodies, parameters, method, pair)) {
    store_no_manifold(planes, manifolds, pair);
    return;
  }
  convex_pair both = pair_of(&query.first, &query.second);
  contact_patch patch;
  patch.code = code_of_features(faces[pair * 2u], faces[pair * 2u + 1u]);
  mask reduced = clipped.count[pair] != INDEX_NONE &&
                 reduced_patch(&patch, &both, load_float4(axes.axis, pair), clipped, planes.stride, pair);
  manifold m;
  if (reduced) m = within_reach(parameters, &query, kept_within(placed_manifold(&both, &patch), query.reach));
  else m = contact_of_query(parameters, &query, method & 255u);
  store_start(parameters, &query, m, planes, manifolds, pair);
}

#endif
