/* follow_convexes.h - follows pairs of convex shapes that may pass each other within the step to their impact.
 *
 *   collide_convex or reduce_contacts -> follow_convexes: the contacts of the impact, those of the start, or none
 *
 * It is a kernel of its own because few pairs are followed, which a group first gathers (followed_pairs.h). In one
 * kernel with the manifolds of all pairs, a device would wait for the slowest pair and need the registers of both. The
 * bodies are advanced by conservative_advancement.h.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_FOLLOW_CONVEXES_H
#define TANDEM_SHARED_NARROWPHASE_FOLLOW_CONVEXES_H

#include "shared/narrowphase/collide_convex.h"
#include "shared/narrowphase/followed_pairs.h"
#include "shared/narrowphase/middle_ball.h"

/* Shapes without a contact at the start are followed only because one of them is a triangle. */
SHARED speculation speculation_of_query(GLOBAL const Parameters *parameters, const convex_query *query, manifold start,
                                        toi_input input)
{
  speculation s = speculation_of(parameters, start, query->offset, query->moves, input, least_of_query(query));
  if (!has_points(start)) s.asked = s.reached = 1;
  return s;
}

/* Whether a point lies in front of a face, within the prism above it. */
SHARED mask is_before_face(const convex *shape, const support_face *face, vec3 point)
{
  if (face->corners < 3u) return 0;
  vec3 last = face_corner(shape, face, face->corners - 1u);
  for (uint k = 0u; k < face->corners; ++k) {
    vec3 corner = face_corner(shape, face, k);
    if (dot3(cross3(subtract(corner, last), subtract(point, last)), face->normal) < R(0.0)) return 0;
    last = corner;
  }
  return 1;
}

/* Adds the middle ball of a body that hits a face of the other one while its middle is in front of that face. The query
 * holds the shapes at the impact. The ball is smaller if the shape is not centred on its body. */
SHARED manifold with_middle_of_convex(manifold m, const convex_query *query, vec3 offset)
{
  ball_owner owner = owner_of_ball(query->moves);
  if (!owner.in_a && !owner.in_b) return m;
  const convex *body = owner.in_a ? &query->first : &query->second, *wall = owner.in_a ? &query->second : &query->first;
  vec3 middle = owner.in_a ? make_vec3(R(0.0), R(0.0), R(0.0)) : offset,
       outward = owner.in_a ? negate(m.normal) : m.normal;
  real radius = CORE_SHARE * least_size(body) - length_of(subtract(body->center, middle));
  support_face face = support_face_of(wall, outward);
  if (!(radius > R(0.0)) || !is_before_face(wall, &face, middle) || dot3(face.normal, outward) < WITH_FACE) return m;
  real height = dot3(face.normal, subtract(middle, face_corner(wall, &face, 0u)));
  return with_middle_ball_if(1, m, middle, outward, height, radius);
}

/* The manifold for the whole step. */
SHARED manifold contact_over_step(GLOBAL const Parameters *parameters, convex_query *query, manifold start, uint method)
{
  toi_input input = toi_input_of_query(parameters, query);
  speculation s = speculation_of_query(parameters, query, start, input);
  input.far = input.far || !has_points(start);
  encounter met = meet(parameters, &query->first, &query->second, query->offset, query->moves, input, s);
  if (!met.at_impact && !met.missed) return start;
  manifold m = start;
  if (met.at_impact) m = contact_of_query(parameters, query, method);
  if (met.at_impact && !has_points(m)) { /* a triangle leaves the contact to its neighbour */
    met.at_impact = 0;
    met.missed = 1;
    m = start;
  }
  vec3 offset = offset_after(query->offset, query->moves, met.at_impact ? met.time : R(0.0));
  if (met.at_impact && !met.missed) m = with_middle_of_convex(m, query, offset);
  return as_seen_from_start(parameters, m, met, offset, query->moves);
}

SHARED void follow_pair_of_convexes(read_listed_part_pairs pairs, read_shapes shapes, read_surfaces surfaces,
                                    read_bodies bodies, GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                    write_manifolds manifolds, uint method, uint pair)
{
  convex_query query;
  if (!load_convex_query(&query, pairs, shapes, surfaces, bodies, parameters, method, pair)) return;
  point_planes planes = planes_of(counts);
  manifold start = load_manifold(planes, manifolds, pair);
  store_manifold_if(1, contact_over_step(parameters, &query, start, method & 255u), planes, manifolds, pair);
}

/* local_memory: the list of followed_pairs.h. */
SHARED void follow_convexes_group(read_listed_part_pairs pairs, read_shapes shapes, read_surfaces surfaces,
                                  read_bodies bodies, GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                  write_manifolds manifolds, uint method, LOCAL uint *local_memory, uint group)
{
  if (!HAS_FEATURE(parameters, CONVEX_CONVEX)) return;
  gather_followed_pairs(pairs.of_kind, pairs.a, pairs.b, shapes.flags, parameters, counts, manifolds.count,
                        PAIR_KIND_CONVEX_CONVEX, local_memory, group);
  FOR_EACH_ITEM(k, local_memory[0])
  {
    follow_pair_of_convexes(pairs, shapes, surfaces, bodies, parameters, counts, manifolds, method,
                            local_memory[1u + k]);
  }
}

#endif
