/* box_axes.h - the axis along which two boxes are farthest apart, or overlap least.
 *
 * The separating axis test: the three face normals of each box and the nine directions square to an edge
 * of both. Two boxes are apart if and only if one of these shows a gap (Gottschalk, Lin, Manocha,
 * "OBBTree", SIGGRAPH 1996). Of nearly equal axes the first in this order wins:
 *
 *   code 0-2    face normals of a: x y z
 *   code 3-5    face normals of b
 *   code 6-14   edge of a x edge of b: 6 + 3 k + j
 *
 * A face carries up to four points and an edge one, so a later face, or an edge, must lead by more than what
 * rounding, or the penetration a stack is left with, can move: a box resting on a box keeps its axis.
 *
 * For contacts the axis of two edges must also be inclined. Where faces meet at a small angle it is nearly that of the
 * faces, and leads by a little: its one point would stop one corner of a box that lands, which turns about it, and the
 * next contacts are found a step later, when the corners without a point have sunk in. Points of faces lie on both
 * boxes all the same:
 *
 *      \-----________               What the box of b is above the face of a is measured at each point, so none is
 *       o            o-----\   b     made too early; the normal alone is off by that small angle.
 *      -----------------------  a
 *
 * Boxes rest in one another by the slop. So one that slides over a floor of tiles would meet the side of the next tile,
 * and one in a grid its neighbours' neighbours:
 *
 *       +---------+ -->                    Where two boxes overlap by no more than the slop along one face axis of a
 *       |         |                        box, and are apart or overlap no more along another, only a bar that thin
 *    ---|--+------|-+---------  <- slop    of their edges can touch. Edges count as rounded off by that much: such
 *       +--|------+ |                      boxes are apart. A ledge lower than the slop is slid over, in every
 *                                          direction.
 *     tile |   tile |   tile
 */
#ifndef TANDEM_SHARED_NARROWPHASE_BOX_AXES_H
#define TANDEM_SHARED_NARROWPHASE_BOX_AXES_H

#include "shared/narrowphase/box.h"

typedef struct {
  real separation;
  uint_lanes code;
  uint_lanes edges; /* code of the best axis of two edges */
  mask edges_lead;  /* the separation is theirs, though the code may be that of a face (NEARLY_ALONG) */
} separating_axis;

typedef struct {
  real separation;
  uint_lanes code;
} best_axis;

SHARED best_axis better_axis(best_axis best, real separation, uint code, real lead)
{
  mask better = separation > best.separation + lead;
  best_axis result = best;
  result.separation = choose(better, separation, best.separation);
  result.code = choose(better, (uint_lanes)code, best.code);
  return result;
}

/* One edge of a, along an axis of a whose two neighbours in cyclic order are u and v, against one edge of b:
 * all in the axes of a. `across_b` is how far b reaches along the product of the two, `noise` the rounding
 * error of the gap: the closer the edges come to parallel the less their product says. */
SHARED real edge_separation(real offset_u, real offset_v, real edge_u, real edge_v, real extent_u, real extent_v,
                            real across_b, real noise)
{
  real length = edge_u * edge_u + edge_v * edge_v;
  mask crossed = length > R(1e-8);
  real gap = magnitude(offset_v * edge_u - offset_u * edge_v) - extent_u * magnitude(edge_v) -
             extent_v * magnitude(edge_u) - across_b;
  return choose(crossed, (gap - noise) / square_root(choose(crossed, length, (real)R(1.0))), (real)R(-1e30));
}

/* The three edges of a against one edge of b; across: how far b reaches along their three products. Of the edges the
 * best one wins: only its closest points are sure to lie on both. */
SHARED best_axis edges_against(best_axis best, vec3 offset, vec3 edge, vec3 extent, vec3 across, uint code, real noise)
{
  real along_x = edge_separation(offset.y, offset.z, edge.y, edge.z, extent.y, extent.z, across.x, noise);
  real along_y = edge_separation(offset.z, offset.x, edge.z, edge.x, extent.z, extent.x, across.y, noise);
  real along_z = edge_separation(offset.x, offset.y, edge.x, edge.y, extent.x, extent.y, across.z, noise);
  return better_axis(better_axis(better_axis(best, along_x, code, noise), along_y, code + 3u, noise), along_z,
                     code + 6u, noise);
}

SHARED vec3 in_axes_of(oriented_box box, vec3 v) { return make_vec3(dot3(box.x, v), dot3(box.y, v), dot3(box.z, v)); }
SHARED real sum_of(vec3 v) { return v.x + v.y + v.z; }

/* By how much a later axis must lead, beside rounding. least: the smallest half extent of the pair. */
SHARED real lead_of(real slop, real least) { return minimum(slop * R(0.1), least * R(0.01)); }

/* Cosine of the angle up to which the axis of two edges counts as that of the faces, about 8 degrees; one that no angle
 * has. */
#define NEARLY_ALONG R(0.99)
#define NEVER_ALONG R(2.0)

/* The slop and what a contact sags more than that, as a share of the slop. */
#define ROUNDED_EDGE R(1.25)
/* The separation of boxes of which only rounded edges meet. */
#define FAR_APART R(1e30)

/* gap: along the three face axes of one box; the middle one is the second largest. Where both show a gap the boxes are
 * apart in any case, and what comes ahead is for the other axes to say. lead: by how much gaps are compared. */
SHARED mask only_edges_meet(vec3 gap, real rounded, real lead)
{
  real second = middle_of(gap);
  return (maximum(gap.x, maximum(gap.y, gap.z)) > -rounded) & (second > -(rounded + R(2.0) * lead)) & (second < lead);
}

/* Edge k of a and edge j of b, from the code of their axis. */
SHARED uint_lanes edge_of_a(uint_lanes code)
{
  return choose(code >= 12u, (uint_lanes)2u, choose(code >= 9u, (uint_lanes)1u, (uint_lanes)0u));
}
SHARED uint_lanes edge_of_b(uint_lanes code) { return code - 6u - edge_of_a(code) * 3u; }

/* The product of axis k with a vector, both in the axes of a box. */
SHARED vec3 across_axis(uint_lanes k, vec3 v)
{
  real zero = R(0.0);
  return pick3(k, make_vec3(zero, -v.z, v.y), make_vec3(v.z, zero, -v.x), make_vec3(-v.y, v.x, zero));
}

/* Whether the axis of two edges is inclined to that of a face. x, y, z: the axes of b, in those of a. */
SHARED mask is_inclined(uint_lanes edges, uint_lanes face, vec3 x, vec3 y, vec3 z, real cosine)
{
  vec3 across = across_axis(edge_of_a(edges), pick3(edge_of_b(edges), x, y, z));
  uint_lanes of_b = face - 3u;
  real along = choose(face < 3u, pick(face, across.x, across.y, across.z), dot3(across, pick3(of_b, x, y, z)));
  return along * along < cosine * cosine * length_squared(across);
}

/* offset: centre of b seen from the centre of a, world axes. slop: penetration left in place; rounded: how much of
 * their edges counts as rounded off. Metres. nearly_along: cosine of the angle up to which the axis of two edges counts
 * as that of the faces. */
SHARED separating_axis separating_axis_of(oriented_box a, oriented_box b, vec3 offset, real slop, real rounded,
                                          real nearly_along)
{
  vec3 to_b = in_axes_of(a, offset);
  vec3 x = in_axes_of(a, b.x), y = in_axes_of(a, b.y), z = in_axes_of(a, b.z);
  vec3 size_x = absolute(x), size_y = absolute(y), size_z = absolute(z);
  vec3 along_b = make_vec3(dot3(to_b, x), dot3(to_b, y), dot3(to_b, z));

  vec3 reach_of_b = add_scaled(add_scaled(scale(size_x, b.extent.x), size_y, b.extent.y), size_z, b.extent.z);
  vec3 reach_of_a = make_vec3(dot3(a.extent, size_x), dot3(a.extent, size_y), dot3(a.extent, size_z));
  vec3 gap_a = subtract(subtract(absolute(to_b), a.extent), reach_of_b);
  vec3 gap_b = subtract(subtract(absolute(along_b), b.extent), reach_of_a);

  real span = sum_of(absolute(to_b)) + sum_of(a.extent) + sum_of(b.extent);
  real noise = span * R(5e-7);
  real lead = lead_of(slop, minimum(least_of(a.extent), least_of(b.extent))) + noise * R(2.0);

  best_axis face = {gap_a.x, 0u};
  face = better_axis(face, gap_a.y, 1u, lead);
  face = better_axis(face, gap_a.z, 2u, lead);
  face = better_axis(face, gap_b.x, 3u, lead);
  face = better_axis(face, gap_b.y, 4u, lead);
  face = better_axis(face, gap_b.z, 5u, lead);

  best_axis edges = {R(-1e30), 6u};
  edges = edges_against(edges, to_b, x, a.extent, add_scaled(scale(size_z, b.extent.y), size_y, b.extent.z), 6u, noise);
  edges = edges_against(edges, to_b, y, a.extent, add_scaled(scale(size_x, b.extent.z), size_z, b.extent.x), 7u, noise);
  edges = edges_against(edges, to_b, z, a.extent, add_scaled(scale(size_y, b.extent.x), size_x, b.extent.y), 8u, noise);
  mask edges_lead = edges.separation - face.separation > lead;
  mask rounded_off =
      (rounded > R(0.0)) & (only_edges_meet(gap_a, rounded, lead) | only_edges_meet(gap_b, rounded, lead));
  real separation = choose(edges_lead, edges.separation, face.separation);
  separating_axis axis = {choose(rounded_off, (real)FAR_APART, separation), face.code, edges.code, edges_lead};
  if (any_of(edges_lead))
    axis.code = choose(edges_lead & is_inclined(edges.code, face.code, x, y, z, nearly_along), edges.code, face.code);
  return axis;
}

#endif
