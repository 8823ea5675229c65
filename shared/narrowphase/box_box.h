/* box_box.h - the contact of two boxes: up to four points between faces, or one point between two edges.
 *
 *   separating axis -> a face of a or b -> clip the other box's face -> reduce to four points
 *                   -> an edge of each  -> closest points of the two
 *
 * It follows the contact generation of E. Catto (GDC 2007) and D. Gregorius (GDC 2013, 2015), but has no branch that
 * depends on data, so that all lanes take one path.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_BOX_BOX_H
#define TANDEM_SHARED_NARROWPHASE_BOX_BOX_H

#include "shared/narrowphase/box_axes.h"
#include "shared/narrowphase/pair_lists.h"
#include "shared/narrowphase/point_reduction.h"

/* Two boxes relative to a, and the axis between them. */
typedef struct {
  oriented_box a, b;
  vec3 offset;      /* centre of b seen from the centre of a */
  vec3 normal;      /* unit, from a to b */
  real gap;         /* along the normal */
  uint_lanes code;  /* of the axis, as in box_axes.h */
  uint_lanes edges; /* code of the edge pair that replaces a face axis on whose face no point lies (edges_lead) */
  mask edges_lead;
} box_pair;

SHARED uint_lanes bit_if(mask m, uint bit) { return choose(m, (uint_lanes)1u, (uint_lanes)0u) << bit; }

SHARED vec3 normal_of_axis(oriented_box a, oriented_box b, vec3 offset, uint_lanes code)
{
  mask on_edges = code >= 6u;
  uint_lanes k = choose(on_edges, edge_of_a(code), code), j = choose(on_edges, edge_of_b(code), code - 3u);
  vec3 axis_a = pick3(k, a.x, a.y, a.z), axis_b = pick3(j, b.x, b.y, b.z);
  vec3 across = cross3(axis_a, axis_b);
  vec3 axis = choose3(on_edges, across, choose3(code < 3u, axis_a, axis_b));
  real length = choose(on_edges, length_of(across), (real)R(1.0));
  return scale(axis, sign_of(dot3(axis, offset)) / length);
}

/* The vector from the middle of a box to the middle of that edge along frame.axis which lies farthest in a
 * direction. */
SHARED vec3 support_edge(box_frame frame, vec3 direction)
{
  vec3 u = scale(frame.u, frame.extent_u * sign_of(dot3(frame.u, direction)));
  return add_scaled(u, frame.v, frame.extent_v * sign_of(dot3(frame.v, direction)));
}
SHARED uint_lanes support_bits(box_frame frame, vec3 direction)
{
  return bit_if(dot3(frame.u, direction) < R(0.0), 0u) | bit_if(dot3(frame.v, direction) < R(0.0), 1u);
}

SHARED manifold edge_contact(box_pair pair)
{
  uint_lanes k = edge_of_a(pair.code), j = edge_of_b(pair.code);
  box_frame a = frame_of(pair.a, k), b = frame_of(pair.b, j);
  vec3 inward = negate(pair.normal);
  vec3 middle_a = support_edge(a, pair.normal), middle_b = add(pair.offset, support_edge(b, inward));
  vec3 between = subtract(middle_b, middle_a), across = cross3(a.axis, b.axis);

  /* Closest points middle_a + s axis_a and middle_b + t axis_b. */
  real cosine = dot3(a.axis, b.axis), along_a = dot3(between, a.axis), along_b = dot3(between, b.axis);
  real inverse = R(1.0) / maximum(length_squared(across), R(1e-8));
  real s = clamped((along_a - cosine * along_b) * inverse, -a.extent, a.extent);
  real t = clamped((cosine * along_a - along_b) * inverse, -b.extent, b.extent);
  vec3 on_a = add_scaled(middle_a, a.axis, s), on_b = add_scaled(middle_b, b.axis, t);

  real separation = dot3(between, pair.normal);
  manifold m = single_contact(pair.normal, scale(add(on_a, on_b), R(0.5)), separation, separation == separation);
  m.code =
      (uint_lanes)1u | (k << 1u) | (j << 3u) | (support_bits(a, pair.normal) << 5u) | (support_bits(b, inward) << 7u);
  return m;
}

/* Transforms a vector into the axes of the reference face: u, v and the outward normal. */
SHARED vec3 in_face(box_frame reference, vec3 outward, vec3 v)
{
  return make_vec3(dot3(reference.u, v), dot3(reference.v, v), dot3(outward, v));
}

/* The face of one box that the contact lies on, and the face of the other box that is most opposed to it. */
typedef struct {
  mask a_is_reference;
  uint_lanes reference_axis, incident_axis;
  box_frame reference, incident;
  vec3 outward; /* normal of the reference face */
  real facing;  /* side of the incident box that its face is on, 1 or -1 */
} face_pair;

SHARED face_pair facing_faces(box_pair pair)
{
  face_pair f;
  f.a_is_reference = pair.code < 3u;
  oriented_box incident_box = choose_box(f.a_is_reference, pair.b, pair.a);
  f.reference_axis = choose(f.a_is_reference, pair.code, pair.code - 3u);
  f.reference = frame_of(choose_box(f.a_is_reference, pair.a, pair.b), f.reference_axis);
  f.outward = choose3(f.a_is_reference, pair.normal, negate(pair.normal));
  f.incident_axis = most_parallel_axis(incident_box, f.outward);
  f.incident = frame_of(incident_box, f.incident_axis);
  f.facing = -sign_of(dot3(f.incident.axis, f.outward));
  return f;
}

/* The positions of both faces in the plane of the reference face. Coordinates count from the middle of the smaller
 * face, so that the coordinates of a large face do not round them away. */
typedef struct {
  vec3 offset;  /* centre of the incident box seen from the centre of the reference box */
  vec3 to_face; /* middle of the incident face seen from the centre of its box */
  vec3 center;  /* middle of the incident face seen from the middle of the reference face */
  real extent_r, extent_i;
  mask from_incident;
  real origin_u, origin_v; /* seen from the middle of the reference face */
} face_plane;

SHARED face_plane plane_of_faces(box_pair pair, face_pair f)
{
  face_plane plane;
  plane.offset = in_face(f.reference, f.outward, choose3(f.a_is_reference, pair.offset, negate(pair.offset)));
  plane.to_face = in_face(f.reference, f.outward, scale(f.incident.axis, f.incident.extent * f.facing));
  plane.center = add(plane.offset, plane.to_face);
  plane.center.z = plane.center.z - f.reference.extent;
  plane.extent_r = f.reference.extent_u + f.reference.extent_v;
  plane.extent_i = f.incident.extent_u + f.incident.extent_v;
  plane.from_incident = plane.extent_i < plane.extent_r;
  plane.origin_u = choose(plane.from_incident, plane.center.x, (real)R(0.0));
  plane.origin_v = choose(plane.from_incident, plane.center.y, (real)R(0.0));
  return plane;
}

SHARED clip_rectangle reference_rectangle(face_pair f, face_plane plane)
{
  clip_rectangle rectangle;
  rectangle.low_u = -plane.origin_u - f.reference.extent_u;
  rectangle.high_u = f.reference.extent_u - plane.origin_u;
  rectangle.low_v = -plane.origin_v - f.reference.extent_v;
  rectangle.high_v = f.reference.extent_v - plane.origin_v;
  return rectangle;
}

SHARED clip_face incident_face(face_pair f, face_plane plane)
{
  real zero = R(0.0);
  clip_face face;
  face.center = make_vec3(choose(plane.from_incident, zero, plane.center.x),
                          choose(plane.from_incident, zero, plane.center.y), plane.center.z);
  face.p = scale(in_face(f.reference, f.outward, f.incident.u), f.incident.extent_u);
  face.q = scale(in_face(f.reference, f.outward, f.incident.v), f.incident.extent_v);
  face.length_p = f.incident.extent_u;
  face.length_q = f.incident.extent_v;
  return face;
}

SHARED uint_lanes code_of_faces(face_pair f)
{
  return bit_if(!f.a_is_reference, 1u) | (f.reference_axis << 2u) |
         bit_if(dot3(f.reference.axis, f.outward) < R(0.0), 4u) | (f.incident_axis << 5u) |
         bit_if(f.facing < R(0.0), 7u);
}

/* Converts coordinates in the plane to offsets from the centre of a. */
SHARED manifold manifold_of_faces(box_pair pair, face_pair f, face_plane plane, const clip_point *four)
{
  real base_u = choose(f.a_is_reference, plane.origin_u, choose(plane.from_incident, plane.to_face.x, -plane.offset.x));
  real base_v = choose(f.a_is_reference, plane.origin_v, choose(plane.from_incident, plane.to_face.y, -plane.offset.y));
  real base_n = choose(f.a_is_reference, f.reference.extent, plane.to_face.z - plane.center.z);
  manifold m;
  m.normal = pair.normal;
  m.impact_time = R(0.0);
  for (int slot = 0; slot < 4; ++slot) {
    vec3 point = add_scaled(scale(f.reference.u, base_u + four[slot].u), f.reference.v, base_v + four[slot].v);
    point = add_scaled(point, f.outward, base_n + four[slot].separation * R(0.5));
    m.point[slot] = extend(point, four[slot].separation);
    m.kept[slot] = four[slot].valid;
  }
  m.code = code_of_faces(f);
  return m;
}

SHARED manifold face_contacts(box_pair pair)
{
  face_pair faces = facing_faces(pair);
  face_plane plane = plane_of_faces(pair, faces);
  real slack = (plane.extent_r + plane.extent_i) * R(2e-6);
  clip_point candidate[CLIP_CANDIDATES], four[4];
  clip_face_by_rectangle(candidate, incident_face(faces, plane), reference_rectangle(faces, plane), slack);
  reduce_points(four, candidate, minimum(plane.extent_r, plane.extent_i), slack);
  return manifold_of_faces(pair, faces, plane, four);
}

/* Each kind of contact is computed only if some item of the group has it. none: a manifold without points, so that it
 * also serves the items whose manifold is computed elsewhere. */
SHARED manifold with_face_contacts(manifold none, mask wanted, box_pair pair, real reach)
{
  if (!any_of(wanted)) return none;
  manifold m = face_contacts(pair);
  for (int slot = 0; slot < 4; ++slot) m.kept[slot] = m.kept[slot] & wanted & (m.point[slot].w < reach);
  return m;
}
SHARED manifold with_edge_contact(manifold m, mask wanted, box_pair pair, real reach)
{
  if (!any_of(wanted)) return m;
  return choose_manifold(wanted, kept_within(edge_contact(pair), reach), m);
}

/* The offset along which boxes are to part whose centres coincide to within a thousandth of their size. It is longer
 * than the lead of an axis. */
SHARED vec3 parting_offset(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_gravity, vec3 offset,
                           real least, uint_lanes a, uint_lanes b)
{
  real little = least * R(0.001);
  mask in_one_place = length_squared(offset) < little * little;
  if (!any_of(in_one_place)) return offset;
  return choose3(in_one_place,
                 scale(parting_direction(parameters, body_gravity, a, b), lead_of(parameters->slop, least) * R(3.0)),
                 offset);
}

/* toward: the offset of the boxes, or the one along which they are to part. rounded, nearly_along: as in
 * separating_axis_of. */
SHARED box_pair along_best_axis(box_pair boxes, vec3 toward, real slop, real rounded, real nearly_along)
{
  separating_axis axis = separating_axis_of(boxes.a, boxes.b, toward, slop, rounded, nearly_along);
  vec3 normal = normal_of_axis(boxes.a, boxes.b, toward, axis.code);
  box_pair pair = {boxes.a, boxes.b, boxes.offset, normal, axis.separation, axis.code, axis.edges, axis.edges_lead};
  return pair;
}

/* The same pair with the axis of its best edge pair. */
SHARED box_pair along_edges(mask wanted, box_pair pair)
{
  box_pair result = pair;
  if (!any_of(wanted)) return result;
  result.code = choose(wanted, pair.edges, pair.code);
  result.normal = choose3(wanted, normal_of_axis(pair.a, pair.b, pair.offset, pair.edges), pair.normal);
  return result;
}

/* The manifold of two boxes at their current poses. Edges that will meet may still lie beside each other when seen
 * along the normal of a face, so the edge pair takes over if no point lies on the face. */
SHARED manifold boxes_contact(GLOBAL const Parameters *parameters, mask wanted, box_pair pair, pair_motion moves)
{
  real reach = reach_of_pair(parameters, moves, pair.normal);
  mask near = wanted & (pair.gap < reach), on_edges = pair.code >= 6u;
  manifold none = single_contact(pair.normal, pair.offset, reach, near & (!near));
  manifold on_face = with_face_contacts(none, near & (!on_edges), pair, reach);
  mask beside = near & (!on_edges) & pair.edges_lead & (!has_points(on_face));
  return with_edge_contact(on_face, (near & on_edges) | beside, along_edges(beside, pair), reach);
}

SHARED box_pair boxes_after(box_pair pair, pair_motion moves, real time)
{
  box_pair then = {turned_box(pair.a, moves.a.angular, time),
                   turned_box(pair.b, moves.b.angular, time),
                   offset_after(pair.offset, moves, time),
                   pair.normal,
                   pair.gap,
                   pair.code,
                   pair.edges,
                   pair.edges_lead};
  return then;
}

/* The gap along a unit normal from a to b. */
SHARED real gap_of_boxes_along(box_pair pair, vec3 normal)
{
  return dot3(pair.offset, normal) - dot3(absolute(in_axes_of(pair.a, normal)), pair.a.extent) -
         dot3(absolute(in_axes_of(pair.b, normal)), pair.b.extent);
}

/* Two boxes at the start of the step, before their best axis is known. */
typedef struct {
  box_pair boxes;
  pair_motion moves;
  toi_input input;
  real least, rounded; /* the smallest half extent; how much of the edges counts as rounded off */
} moving_boxes;

SHARED moving_boxes load_boxes(GLOBAL const float4 *shapes, read_bodies bodies, GLOBAL const Parameters *parameters,
                               uint_lanes a, uint_lanes b)
{
  vec4 shape_a = load_float4(shapes, a), shape_b = load_float4(shapes, b);
  moving_boxes pair;
  pair.moves = load_pair_motion(bodies, parameters, a, b, shape_a.w, shape_b.w);
  pair.boxes.a = oriented_box_of(load_float4(bodies.orientation, a), xyz(shape_a));
  pair.boxes.b = oriented_box_of(load_float4(bodies.orientation, b), xyz(shape_b));
  pair.boxes.offset = pair.boxes.normal = offset_between(bodies.position, a, b);
  pair.boxes.gap = R(0.0);
  pair.boxes.code = pair.boxes.edges = 0u;
  pair.boxes.edges_lead = pair.boxes.gap > R(0.0);
  pair.least = minimum(least_of(pair.boxes.a.extent), least_of(pair.boxes.b.extent));
  pair.input = toi_input_of_step(parameters, pair.moves, pair.least, shape_a.w + shape_b.w);
  pair.rounded = ROUNDED_EDGE * minimum(parameters->slop, parameters->slop_share * pair.least);
  return pair;
}

/* Boxes beside each other, whose faces do not overlap yet when seen along the normal, have no contact at the start of
 * the step, though fast ones may meet within it. The test takes sharp edges, because rounded ones may be apart at the
 * start and still meet. */
SHARED mask may_meet_from_beside(GLOBAL const Parameters *parameters, manifold m, moving_boxes pair, vec3 normal)
{
  mask beside = pair.input.far & !has_points(m);
  if (!any_of(beside)) return beside;
  real gap = gap_of_boxes_along(pair.boxes, normal);
  return beside & (gap > pair.input.touching) & (closing_speed(pair.moves, normal) * parameters->step > gap);
}

/* Pairs that overlap are done, and so are pairs that are apart and do not move far; these are nearly all of a pile. */
SHARED mask may_be_followed(manifold m, toi_input input)
{
  return (least_separation(m) > R(0.0)) & (has_points(m) | input.far);
}

SHARED void collide_box_box_item(read_listed_pairs pairs, GLOBAL const uint *flags, GLOBAL const float4 *shapes,
                                 read_bodies bodies, GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                 write_manifolds manifolds, item_index i)
{
  handled item = handled_pair(parameters, pairs, flags, PAIR_KIND_BOX_BOX, i);
  if (!any_of(item.mine)) return;
  uint_lanes a = item.a, b = item.b;
  mask mine = item.mine;

  moving_boxes pair = load_boxes(shapes, bodies, parameters, a, b);
  vec3 toward = parting_offset(parameters, bodies.gravity, pair.boxes.offset, pair.least, a, b);
  box_pair boxes = along_best_axis(pair.boxes, toward, parameters->slop, pair.rounded, NEARLY_ALONG);
  manifold m = boxes_contact(parameters, mine, boxes, pair.moves);
  store_manifold_if(mine, m, planes_of(counts), manifolds, item.pair);

  mask unsure = mine & may_be_followed(m, pair.input);
  if (!any_of(unsure)) return;
  /* The pair is loaded again, so that a device need not keep it in registers during the contact generation. */
  pair = load_boxes(shapes, bodies, parameters, a, b);
  mask ahead = speculation_of(parameters, m, pair.boxes.offset, pair.moves, pair.input, pair.least).asked |
               may_meet_from_beside(parameters, m, pair, boxes.normal);
  mark_to_follow_if(unsure & ahead, m, manifolds.count, item.pair);
}

#endif
