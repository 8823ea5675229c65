/* box_axes.h - the axis along which two boxes are separated most, or overlap least.
 *
 * This is the separating axis test: the three face normals of each box and the nine directions perpendicular to an edge
 * of both. Two boxes are apart if and only if one of these axes shows a gap (Gottschalk, Lin, Manocha, "OBBTree",
 * SIGGRAPH 1996). Of nearly equal axes the first one in this order wins:
 *
 *   code 0-2    face normals of a: x y z
 *   code 3-5    face normals of b
 *   code 6-14   edge of a x edge of b: 6 + 3 k + j
 *
 * A face carries up to four points and an edge pair carries one. A later face or an edge pair must therefore lead by
 * more than rounding or the penetration left in a stack can move, so that a box resting on a box keeps its axis.
 *
 * The axis of an edge pair becomes the contact normal only if it is also inclined to the best face axis. Where faces
 * meet at a small angle, the edge axis is nearly that of the faces and leads by little. Its one point would stop one
 * corner of a box that lands; the box would turn about that corner, and its other corners would sink in before they get
 * contacts in the next step. The points of the face lie on both boxes nevertheless:
 *
 *      \-----________               The height of the box b above the face of a is measured at each point, so no
 *       o            o-----\   b     contact is made too early; only the normal is off by that small angle.
 *      -----------------------  a
 *
 * Boxes rest in one another by the slop. A box that slides over a floor of tiles would therefore meet the side of the
 * next tile, and a box in a grid would meet the neighbours of its neighbours:
 *
 *       +---------+ -->                    If two boxes overlap by no more than the slop along one face axis of a
 *       |         |                        box, and are apart or overlap no more along another one, only a bar of
 *    ---|--+------|-+---------  <- slop    their edges that is as thin as the slop can touch. Edges count as rounded
 *       +--|------+ |                      off by that much, so such boxes count as apart. A box therefore slides
 *                                          over a ledge lower than the slop, in every direction.
 *     tile |   tile |   tile
 */
#ifndef TANDEM_SHARED_NARROWPHASE_BOX_AXES_H
#define TANDEM_SHARED_NARROWPHASE_BOX_AXES_H

#include "shared/narrowphase/box.h"

typedef struct {
  real separation;
  uint_lanes code;
  uint_lanes edges; /* code of the best axis of an edge pair */
  mask edges_lead;  /* the separation is that of the edge pair, though the code may be that of a face (NEARLY_ALONG) */
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

/* The separation of one edge of a, along an axis of a whose two neighbours in cyclic order are u and v, from one edge
 * of b. All values are in the axes of a. `across_b` is how far b reaches along the cross product of the two edges.
 * `noise` is the rounding error of the gap; it weighs more the closer the edges come to parallel. */
SHARED real edge_separation(real offset_u, real offset_v, real edge_u, real edge_v, real extent_u, real extent_v,
                            real across_b, real noise)
{
  real length = edge_u * edge_u + edge_v * edge_v;
  mask crossed = length > R(1e-8);
  real gap = magnitude(offset_v * edge_u - offset_u * edge_v) - extent_u * magnitude(edge_v) -
             extent_v * magnitude(edge_u) - across_b;
  return choose(crossed, (gap - noise) / square_root(choose(crossed, length, (real)R(1.0))), (real)R(-1e30));
}

/* The best axis of the three edges of a with one edge of b. across: how far b reaches along the three cross products.
 * Only the best edge pair will do, because only its closest points are sure to lie on both boxes. */
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

/* By how much a later axis must lead, in addition to rounding. least: the smallest half extent of the pair. */
SHARED real lead_of(real slop, real least) { return minimum(slop * R(0.1), least * R(0.01)); }

/* Cosines. Up to the first angle, about 8 degrees, the axis of an edge pair counts as that of the faces; no angle
 * reaches the second. */
#define NEARLY_ALONG R(0.99)
#define NEVER_ALONG R(2.0)

/* The slop and the further sag of a contact under load, as a multiple of the slop. */
#define ROUNDED_EDGE R(1.25)
/* The separation of boxes that touch with nothing but rounded edges. */
#define FAR_APART R(1e30)

/* gap: along the three face axes of one box; the middle one of them is the second largest. Where the two largest both
 * show a gap, the boxes are apart in any case, and the other axes decide about speculative contacts. lead: the margin
 * within which gaps count as equal. */
SHARED mask only_edges_meet(vec3 gap, real rounded, real lead)
{
  real second = middle_of(gap);
  return (maximum(gap.x, maximum(gap.y, gap.z)) > -rounded) & (second > -(rounded + R(2.0) * lead)) & (second < lead);
}

/* Edge k of a and edge j of b, decoded from the code of their axis. */
SHARED uint_lanes edge_of_a(uint_lanes code)
{
  return choose(code >= 12u, (uint_lanes)2u, choose(code >= 9u, (uint_lanes)1u, (uint_lanes)0u));
}
SHARED uint_lanes edge_of_b(uint_lanes code) { return code - 6u - edge_of_a(code) * 3u; }

/* The cross product of axis k with a vector, both in the axes of a box. */
SHARED vec3 across_axis(uint_lanes k, vec3 v)
{
  real zero = R(0.0);
  return pick3(k, make_vec3(zero, -v.z, v.y), make_vec3(v.z, zero, -v.x), make_vec3(-v.y, v.x, zero));
}

/* Whether the axis of an edge pair is inclined to that of a face. x, y, z: the axes of b in the axes of a. */
SHARED mask is_inclined(uint_lanes edges, uint_lanes face, vec3 x, vec3 y, vec3 z, real cosine)
{
  vec3 across = across_axis(edge_of_a(edges), pick3(edge_of_b(edges), x, y, z));
  uint_lanes of_b = face - 3u;
  real along = choose(face < 3u, pick(face, across.x, across.y, across.z), dot3(across, pick3(of_b, x, y, z)));
  return along * along < cosine * cosine * length_squared(across);
}

/* offset: centre of b seen from the centre of a, in world axes. slop: penetration left in place, m. rounded: how much
 * of the edges counts as rounded off, m. nearly_along: cosine of the angle up to which the axis of an edge pair counts
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
