/* box_capsule.h - the contacts of a box and a capsule.
 *
 *      o---------x----------x o      The normal n joins the box and the nearest point of the capsule's segment. Above
 *           ^    |          |        a face, the ends of the part of the segment that lies above the face are the
 *         n |    v          v        contacts (x); beside an edge, those of the part beside the edge if both are nearly
 *     +-----------------------+      parallel; elsewhere the nearest point is the only one.
 *
 * Along the segment, the squared distance from the box is convex, and its slope consists of straight pieces that end
 * where the segment passes the plane of a face. So the nearest point lies between two neighbours among the ends and six
 * places, and no item has another number of steps than the others. If the segment enters the box, the least depth along
 * the faces' normals and along those that cross an edge and the segment tells the way out.
 *
 * Pairs that may pass each other within the step are left to follow_box_capsules.h.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_BOX_CAPSULE_H
#define TANDEM_SHARED_NARROWPHASE_BOX_CAPSULE_H

#include "shared/narrowphase/box.h"
#include "shared/narrowphase/capsules.h"

/* The least part of the normal along that of a face for the capsule to lie above the face. */
#define ABOVE_FACE R(0.9)

/* Both are seen from the centre of the box, in world axes. */
typedef struct {
  capsule rod;
  vec3 extent;
  mat3 rotation;      /* of the box */
  mask capsule_first; /* the capsule is body a */
} box_and_capsule;

/* The segment of a capsule in the axes of a box. Places on it go from -1 to 1. */
typedef struct {
  vec3 middle, to_end, extent;
} boxed_segment;

SHARED boxed_segment segment_in_box(const box_and_capsule *pair)
{
  boxed_segment s = {rotate_back(pair->rotation, middle_of_capsule(pair->rod)),
                     rotate_back(pair->rotation, pair->rod.to_end), pair->extent};
  return s;
}
SHARED vec3 point_at_place(const boxed_segment *s, real place) { return add_scaled(s->middle, s->to_end, place); }

/* --- the nearest point ---------------------------------------------------------------------------------------- */
/* Half of the slope of the squared distance. */
SHARED real slope_at_place(const boxed_segment *s, real place)
{
  vec3 p = point_at_place(s, place);
  return dot3(s->to_end, subtract(p, nearest_in_box(p, s->extent)));
}

/* Two places between which the slope changes its sign. Where it is 0 along a part, `low` is the end of that part. */
typedef struct {
  real low, high, slope_low, slope_high;
} slope_bracket;

/* By the place where the segment passes the plane at `plane`. */
SHARED slope_bracket narrowed_bracket(slope_bracket b, const boxed_segment *s, real plane, real middle, real to_end)
{
  mask passes = to_end != R(0.0);
  real place =
      choose(passes, clamped((plane - middle) / choose(passes, to_end, (real)R(1.0)), R(-1.0), R(1.0)), (real)R(-1.0));
  real slope = slope_at_place(s, place);
  mask raises = (slope <= R(0.0)) & (place > b.low), lowers = (slope >= R(0.0)) & (place < b.high);
  slope_bracket next = {choose(raises, place, b.low), choose(lowers, place, b.high), choose(raises, slope, b.slope_low),
                        choose(lowers, slope, b.slope_high)};
  return next;
}
SHARED slope_bracket bracket_within(slope_bracket b, const boxed_segment *s, real extent, real middle, real to_end)
{
  return narrowed_bracket(narrowed_bracket(b, s, extent, middle, to_end), s, -extent, middle, to_end);
}

SHARED real nearest_place(const boxed_segment *s)
{
  slope_bracket b = {R(-1.0), R(1.0), slope_at_place(s, R(-1.0)), slope_at_place(s, R(1.0))};
  mask from_start = b.slope_low >= R(0.0), from_end = b.slope_high <= R(0.0);
  b = bracket_within(b, s, s->extent.x, s->middle.x, s->to_end.x);
  b = bracket_within(b, s, s->extent.y, s->middle.y, s->to_end.y);
  b = bracket_within(b, s, s->extent.z, s->middle.z, s->to_end.z);
  real rise = b.slope_high - b.slope_low;
  mask crosses = (b.low < b.high) & (rise > R(0.0));
  real place = choose(crosses, b.low - b.slope_low * (b.high - b.low) / choose(crosses, rise, (real)R(1.0)),
                      R(0.5) * (b.low + b.high));
  place = choose(from_start & !from_end, (real)R(-1.0), place);
  return choose(from_end & !from_start, (real)R(1.0), place);
}

SHARED vec3 axis_where(mask x, mask y, mask z)
{
  real one = R(1.0), zero = R(0.0);
  return make_vec3(choose(x, one, zero), choose(y, one, zero), choose(z, one, zero));
}

/* From the box to the nearest point of the segment. Between an edge and the segment it is perpendicular to both, and
 * to the segment beside a corner: rounding of the points alone would turn it where they are near each other. */
SHARED vec3 away_from_box(const boxed_segment *s, real place)
{
  vec3 p = point_at_place(s, place), away = subtract(p, nearest_in_box(p, s->extent));
  /* Along these axes the nearest point is not on the border of the box: along two on a face, along one on an edge. */
  mask in_x = magnitude(p.x) < s->extent.x, in_y = magnitude(p.y) < s->extent.y, in_z = magnitude(p.z) < s->extent.z;
  mask beside = magnitude(place) < R(1.0), of_corner = beside & !(in_x | in_y | in_z);
  vec3 edge = axis_where(in_x & !(in_y | in_z), in_y & !(in_x | in_z), in_z & !(in_x | in_y));
  vec3 across = cross3(edge, s->to_end);
  real area = length_squared(across);
  mask crossing = beside & (area > SEGMENTS_CROSS * length_squared(s->to_end));
  away = without_part_along(away, s->to_end, of_corner);
  return choose3(crossing, scale(across, dot3(away, across) / choose(crossing, area, (real)R(1.0))), away);
}

/* --- the way out ---------------------------------------------------------------------------------------------- */
/* How deep a segment is in a box along a direction, the direction, and the place that is deepest. */
typedef struct {
  vec3 outward;
  real depth, place;
} way_out;

SHARED way_out shorter_way(way_out old, mask taken, way_out found)
{
  way_out way = {choose3(taken, found.outward, old.outward), choose(taken, found.depth, old.depth),
                 choose(taken, found.place, old.place)};
  return way;
}

SHARED way_out way_to_face(vec3 axis, real extent, real middle, real to_end)
{
  real side = sign_of(middle);
  way_out way = {scale(axis, side), extent + magnitude(to_end) - magnitude(middle), -side * sign_of(to_end)};
  return way;
}

/* Perpendicular to the segment and to an edge. A way that is hardly shorter than one to a face does not count. */
SHARED way_out shorter_way_across(way_out old, const boxed_segment *s, vec3 edge)
{
  vec3 across = cross3(edge, s->to_end);
  real squared = length_squared(across), one = R(1.0);
  mask offered = squared > R(1e-4) * length_squared(s->to_end);
  vec3 direction = scale(across, one / choose(offered, square_root(squared), one));
  real side = sign_of(dot3(direction, s->middle));
  way_out way;
  way.outward = scale(direction, side);
  way.depth = dot3(absolute(direction), s->extent) - dot3(way.outward, s->middle);
  vec3 corner = multiply(s->extent, make_vec3(sign_of(way.outward.x), sign_of(way.outward.y), sign_of(way.outward.z)));
  vec3 flat = add_scaled(s->to_end, edge, -dot3(s->to_end, edge));
  way.place = place_on_segment(dot3(subtract(corner, s->middle), flat), squared);
  return shorter_way(old, offered & (way.depth < R(0.98) * old.depth), way);
}

SHARED way_out way_out_of_box(const boxed_segment *s)
{
  real one = R(1.0), zero = R(0.0);
  vec3 x = make_vec3(one, zero, zero), y = make_vec3(zero, one, zero), z = make_vec3(zero, zero, one);
  way_out way = way_to_face(x, s->extent.x, s->middle.x, s->to_end.x),
          to_y = way_to_face(y, s->extent.y, s->middle.y, s->to_end.y),
          to_z = way_to_face(z, s->extent.z, s->middle.z, s->to_end.z);
  way = shorter_way(way, to_y.depth < way.depth, to_y);
  way = shorter_way(way, to_z.depth < way.depth, to_z);
  way = shorter_way_across(way, s, x);
  way = shorter_way_across(way, s, y);
  return shorter_way_across(way, s, z);
}

/* --- the contacts --------------------------------------------------------------------------------------------- */
/* A part of the segment. */
typedef struct {
  real enter, leave;
} segment_part;

/* The part between the planes of two opposite faces. */
SHARED segment_part part_between(segment_part part, mask wanted, real extent, real middle, real to_end)
{
  mask passes = to_end != R(0.0), outside = (!passes) & (magnitude(middle) > extent);
  real by = R(1.0) / choose(passes, to_end, (real)R(1.0));
  real first = (-extent - middle) * by, last = (extent - middle) * by;
  real enter = choose(passes, minimum(first, last), choose(outside, (real)R(1.0), (real)R(-1.0))),
       leave = choose(passes, maximum(first, last), choose(outside, (real)R(-1.0), (real)R(1.0)));
  segment_part next = {choose(wanted, maximum(part.enter, enter), part.enter),
                       choose(wanted, minimum(part.leave, leave), part.leave)};
  return next;
}

/* The face or edge beside which a capsule lies. */
typedef struct {
  mask along_x, along_y, along_z; /* the axes along which the feature extends */
  mask has_length;                /* it is a face, or an edge that is nearly parallel to the segment */
  mask is_straight;               /* it is a face, and the contact has its normal */
  vec3 plane; /* the normal of the face; beside an edge, what of the contact's is across it. The box lies below */
} box_feature;

/* Whether the segment is, in part, between the planes of two opposite faces. */
SHARED mask passes_between(real extent, real middle, real to_end)
{
  return magnitude(middle) - magnitude(to_end) < extent;
}

/* Whether a capsule stays beside an edge: it strays from it by little of its length and of its radius. */
SHARED mask is_along(const boxed_segment *s, real radius, vec3 normal_part, vec3 axis)
{
  real strays = length_of(cross3(axis, s->to_end));
  mask beside = length_squared(normal_part) <= CAPSULES_PARALLEL * CAPSULES_PARALLEL;
  return beside & (strays <= CAPSULES_PARALLEL * length_of(s->to_end)) & (strays <= R(0.25) * radius);
}

SHARED box_feature feature_beside(const boxed_segment *s, real radius, vec3 normal)
{
  vec3 size = absolute(normal);
  real one = R(1.0), zero = R(0.0);
  mask in_x = passes_between(s->extent.x, s->middle.x, s->to_end.x),
       in_y = passes_between(s->extent.y, s->middle.y, s->to_end.y),
       in_z = passes_between(s->extent.z, s->middle.z, s->to_end.z);
  mask face_x = (size.x >= ABOVE_FACE) & in_y & in_z, face_y = (size.y >= ABOVE_FACE) & in_x & in_z,
       face_z = (size.z >= ABOVE_FACE) & in_x & in_y;
  mask is_face = face_x | face_y | face_z;
  vec3 along_x = make_vec3(one, zero, zero), along_y = make_vec3(zero, one, zero), along_z = make_vec3(zero, zero, one);
  mask edge_x = (!is_face) & is_along(s, radius, multiply(normal, along_x), along_x),
       edge_y = (!is_face) & is_along(s, radius, multiply(normal, along_y), along_y),
       edge_z = (!is_face) & is_along(s, radius, multiply(normal, along_z), along_z);
  mask is_edge = edge_x | edge_y | edge_z;
  vec3 of_face =
      multiply(axis_where(face_x, face_y, face_z), make_vec3(sign_of(normal.x), sign_of(normal.y), sign_of(normal.z)));
  vec3 of_edge = multiply(normal, axis_where(!edge_x, !edge_y, !edge_z));
  of_edge = choose3(is_edge, scale(of_edge, one / choose(is_edge, length_of(of_edge), one)), normal);
  box_feature f = {(is_face & !face_x) | edge_x,
                   (is_face & !face_y) | edge_y,
                   (is_face & !face_z) | edge_z,
                   is_face | is_edge,
                   is_face & (dot3(of_face, normal) == R(1.0)),
                   choose3(is_face, of_face, of_edge)};
  return f;
}

/* The contact below a place on the segment, in the axes of the box. */
SHARED vec4 point_under_capsule(const boxed_segment *s, vec3 normal, real radius, real place, real height)
{
  real separation = height - radius;
  return extend(add_scaled(point_at_place(s, place), normal, -(radius + separation * R(0.5))), separation);
}
SHARED vec4 point_above_feature(const boxed_segment *s, vec3 normal, real radius, vec3 plane, real place)
{
  real above = dot3(plane, point_at_place(s, place)) - dot3(absolute(plane), s->extent);
  return point_under_capsule(s, normal, radius, place, above / dot3(plane, normal));
}

/* Where a capsule touches a box, in the axes of the box. */
typedef struct {
  vec3 normal; /* to the capsule */
  real height; /* of the segment above the box along the normal; negative within it */
  real place;
  mask apart; /* the segment is outside */
} box_touch;

SHARED box_touch touch_of_segment(const boxed_segment *s)
{
  box_touch t;
  t.place = nearest_place(s);
  vec3 away = away_from_box(s, t.place);
  t.height = length_of(away);
  /* Of a large box, only the sizes along `away` are what its coordinates are rounded by. */
  real rounded = length_of(s->to_end) * t.height + dot3(absolute(away), s->extent);
  t.apart = t.height * t.height > R(8.0) * ROUNDING * rounded;
  t.normal = scale(away, R(1.0) / choose(t.apart, t.height, (real)R(1.0)));
  if (any_of(!t.apart)) {
    way_out way = way_out_of_box(s);
    t.normal = choose3(t.apart, t.normal, way.outward);
    t.height = choose(t.apart, t.height, -way.depth);
    t.place = choose(t.apart, t.place, way.place);
  }
  return t;
}

/* The part of the segment whose feet, which lie below it along the normal, are on the feature. */
SHARED segment_part part_beside(const boxed_segment *s, const box_touch *t, const box_feature *f)
{
  segment_part part = {R(-1.0), R(1.0)};
  vec3 foot = add_scaled(s->middle, t->normal, -t->height);
  part = part_between(part, f->along_x, s->extent.x, foot.x, s->to_end.x);
  part = part_between(part, f->along_y, s->extent.y, foot.y, s->to_end.y);
  return part_between(part, f->along_z, s->extent.z, foot.z, s->to_end.z);
}

/* In the axes of the box; the normal points to the capsule. The deepest place of a segment within the box may have left
 * it beside the face. */
SHARED manifold contact_in_box(const boxed_segment *s, real radius)
{
  real length = length_of(s->to_end);
  box_touch t = touch_of_segment(s);
  box_feature f = feature_beside(s, radius, t.normal);
  segment_part part = part_beside(s, &t, &f);
  mask within = f.has_length & (!t.apart) & (part.enter <= part.leave);
  t.place = choose(within, clamped(t.place, part.enter, part.leave), t.place);
  manifold m = single_contact(t.normal, t.normal, R(0.0), t.height == t.height);
  m.point[0] = point_under_capsule(s, t.normal, radius, t.place, t.height);

  vec4 first = point_above_feature(s, t.normal, radius, f.plane, part.enter),
       last = point_above_feature(s, t.normal, radius, f.plane, part.leave);
  /* The two have to touch as the nearest point does, but for rounding; of a segment that has entered the box, they may
   * be as much less deep as it leans. */
  real lacks = minimum(first.w, last.w) - (t.height - radius),
       rounded = R(8.0) * ROUNDING * dot3(absolute(t.normal), s->extent) + R(1e-4) * (length + radius),
       leans = choose(t.apart, (real)R(0.0), R(2.0) * magnitude(dot3(s->to_end, t.normal)));
  mask two = m.kept[0] & f.has_length & (t.apart | f.is_straight) & faces_side(s->to_end, t.normal) &
             ((part.leave - part.enter) * length > R(1e-3) * radius) & (lacks <= rounded + leans);
  m.point[0] = choose4(two, first, m.point[0]);
  m.point[1] = choose4(two, last, m.point[1]);
  m.kept[1] = two;
  return m;
}

/* The centre of body b from that of a. */
SHARED vec3 offset_of_box_and_capsule(const box_and_capsule *pair)
{
  return choose3(pair->capsule_first, negate(pair->rod.pivot), pair->rod.pivot);
}

SHARED manifold box_capsule_contact(const box_and_capsule *pair)
{
  boxed_segment s = segment_in_box(pair);
  manifold m = contact_in_box(&s, pair->rod.radius);
  vec3 outward = rotate(pair->rotation, m.normal),
       from_a = choose3(pair->capsule_first, pair->rod.pivot, make_vec3(R(0.0), R(0.0), R(0.0)));
  m.normal = choose3(pair->capsule_first, negate(outward), outward);
  for (int slot = 0; slot < 2; ++slot)
    m.point[slot] = extend(subtract(rotate(pair->rotation, xyz(m.point[slot])), from_a), m.point[slot].w);
  return m;
}

SHARED manifold box_capsule_within_reach(GLOBAL const Parameters *parameters, const box_and_capsule *pair,
                                         pair_motion moves)
{
  manifold m = box_capsule_contact(pair);
  return kept_within(m, reach_of_pair(parameters, moves, m.normal));
}

/* --- the kernel ----------------------------------------------------------------------------------------------- */
typedef struct {
  box_and_capsule pair;
  pair_motion moves;
  toi_input input;
  real least;
} moving_box_and_capsule;

SHARED moving_box_and_capsule load_box_and_capsule(GLOBAL const uint *flags, GLOBAL const float4 *shapes,
                                                   GLOBAL const float4 *poses, read_bodies bodies,
                                                   GLOBAL const Parameters *parameters, collider a, collider b)
{
  mask capsule_first = shape_of(load_uint(flags, a.shape)) == (uint)SHAPE_CAPSULE;
  collider rod = choose_collider(capsule_first, a, b);
  uint_lanes box = choose(capsule_first, b.body, a.body);
  vec4 extent = load_float4(shapes, box);
  moving_box_and_capsule p;
  p.pair.rod = capsule_of_collider(shapes, poses, bodies.orientation, offset_between(bodies.position, box, rod.body),
                                   capsule_first & !capsule_first, rod);
  p.pair.extent = xyz(extent);
  p.pair.rotation = rotation_of(quat_from(load_float4(bodies.orientation, box)));
  p.pair.capsule_first = capsule_first;
  p.moves = load_pair_motion(bodies, parameters, a.body, b.body, load_float4(shapes, a.body).w,
                             load_float4(shapes, b.body).w);
  p.least = minimum(p.pair.rod.radius, least_of(p.pair.extent));
  p.input = toi_input_of_step(parameters, p.moves, p.least, load_float4(shapes, rod.body).w + extent.w);
  return p;
}

SHARED speculation speculation_of_box_and_capsule(GLOBAL const Parameters *parameters, manifold m,
                                                  const moving_box_and_capsule *p)
{
  return speculation_of(parameters, m, offset_of_box_and_capsule(&p->pair), p->moves, p->input, p->least);
}

SHARED void collide_box_capsule_item(read_listed_part_pairs pairs, GLOBAL const uint *flags,
                                     GLOBAL const float4 *shapes, GLOBAL const float4 *poses, read_bodies bodies,
                                     GLOBAL const Parameters *parameters, GLOBAL const uint *counts,
                                     write_manifolds manifolds, item_index i)
{
  handled_parts item = handled_part_pair(parameters, pairs, flags, PAIR_KIND_BOX_CAPSULE, i);
  if (!any_of(item.mine)) return;
  moving_box_and_capsule p = load_box_and_capsule(flags, shapes, poses, bodies, parameters, item.a, item.b);
  manifold m = box_capsule_within_reach(parameters, &p.pair, p.moves);
  store_manifold_if(item.mine, m, planes_of(counts), manifolds, item.pair);
  mark_to_follow_if(item.mine & speculation_of_box_and_capsule(parameters, m, &p).asked, m, manifolds.count, item.pair);
}

#endif
