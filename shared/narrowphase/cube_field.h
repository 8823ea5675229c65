/* cube_field.h - contacts of two polytopes, whose surfaces are both sampled as points and stored as a height field over
 * a cube.
 *
 *   The points of a surface are its corners and three points along each edge. The field of a shape is a cube around its
 *   middle, each cell of which names the face that lies in the direction of the cell's middle. A point of one shape is
 *   looked up in the field of the other one; the plane of the face named there gives the height of the point above the
 *   surface.
 *
 *        .---.---.---.       Points of a (o) are looked up in the field of b, and points of b in that of a. The deepest
 *        |   | \ |   |       of all points gives the normal, and the points over faces with the same normal form the
 *        '---'-c-\---'       contact.
 *          ____|__o_____
 *         |    b        |    This is the "dual surface / height field" contact of the talks (E. Coumans, 2011 and 2013;
 *                            R. Sathe, "Collision detection shader using cube-maps", ShaderX5, 2006).
 *
 * The method is approximate: a cell names one face, and an edge is sampled at its ends and three points between. The
 * four cells around a direction are read, and no face lies farther out than the surface, so a height is never too large
 * (docs/pipeline.md has the errors). If no point of either shape touches the other one, as where two long edges cross,
 * or if a point lies deep, convex_contact() uses its general method instead, so nothing passes through.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CUBE_FIELD_H
#define TANDEM_SHARED_NARROWPHASE_CUBE_FIELD_H

#include "shared/narrowphase/contact_patch.h"

#define EDGE_POINTS 3u
/* Cosine of the angle up to which two faces count as one. */
#define FIELD_SAME_FACE R(0.999)
/* A share of the least size. A point deeper than this may have come in through another face than the one it lies
 * under. */
#define FIELD_DEPTH R(0.1)

/* The middle of a polytope's vertices in its own axes; the cube of its field is centred there. */
SHARED vec3 middle_of_field(const convex *shape)
{
  if (!is_hull(shape)) return make_vec3(R(0.0), R(0.0), R(0.0));
  uint rows = (chunks_of(shape->hull.vertices) * 3u + chunks_of(shape->hull.faces) * 4u) * FLOAT4S_OF_CHUNK;
  return xyz(load_float4(shape->tables.chunks, shape->hull.first_chunk + rows));
}

/* --- the surface as points ---------------------------------------------------------------------------- */

SHARED uint corners_of_polytope(const convex *shape) { return is_hull(shape) ? shape->hull.vertices : 8u; }
SHARED uint surface_points_of(const convex *shape)
{
  return corners_of_polytope(shape) + edges_of(shape) * EDGE_POINTS;
}

/* The point is in the shape's axes. */
SHARED vec3 surface_point(const convex *shape, uint k)
{
  uint corners = corners_of_polytope(shape);
  if (k < corners && is_hull(shape)) return hull_vertex(shape, k);
  if (k < corners)
    return multiply(make_vec3((k & 1u) == 1u ? R(1.0) : R(-1.0), (k & 2u) == 2u ? R(1.0) : R(-1.0),
                              (k & 4u) == 4u ? R(1.0) : R(-1.0)),
                    shape->size);
  polytope_edge edge = edge_of(shape, (k - corners) / EDGE_POINTS);
  return add_scaled(edge.start, edge.along, to_real((k - corners) % EDGE_POINTS + 1u) / R(4.0));
}

/* --- the surface as a field --------------------------------------------------------------------------- */

typedef struct {
  real height; /* above the surface; below 0: inside */
  uint face;
} field_height;

SHARED field_height higher_face(field_height best, const convex *shape, vec3 own, uint face)
{
  vec4 plane = plane_of_face(shape, face);
  field_height found = {dot3(xyz(plane), own) - plane.w, face};
  return found.height > best.height ? found : best;
}

/* own: in the shape's axes. All six faces of a box are tried; of a hull, the faces that the four nearest cells name. */
SHARED field_height height_above_field(const convex *shape, vec3 own)
{
  field_height best = {R(-1e30), 0u};
  if (!is_hull(shape)) {
    for (uint face = 0u; face < 6u; ++face) best = higher_face(best, shape, own, face);
    return best;
  }
  cube_place at = place_on_cube(subtract(own, middle_of_field(shape)));
  uint cells = shape->hull.field_side, map_cells = shape->hull.map_side;
  real half_cell = R(1.0) / to_real(cells);
  GLOBAL const uint *faces = shape->tables.links + shape->hull.first_link + shape->hull.vertices + 1u +
                             2u * shape->hull.corners + 6u * map_cells * map_cells;
  for (uint k = 0u; k < 4u; ++k) {
    cube_place near = {at.side, at.u + ((k & 1u) == 1u ? half_cell : -half_cell),
                       at.v + ((k & 2u) == 2u ? half_cell : -half_cell)};
    best = higher_face(best, shape, own, faces[cell_of_place(near, cells)]);
  }
  return best;
}

/* --- both --------------------------------------------------------------------------------------------- */

/* The purpose of a pass over all points. */
enum { FIELD_DEEPEST = 0, FIELD_REDUCE = 1, FIELD_HEIGHTS = 2 };

typedef struct {
  int purpose;
  mask touches;
  core_contact contact; /* of the deepest point */
  real reach, deep;
  reduction points;
  contact_patch *patch;
} field_search;

SHARED void take_height(contact_patch *patch, clip_point point, real height)
{
  for (int slot = 0; slot < 4; ++slot)
    if (patch->point[slot].u == point.u && patch->point[slot].v == point.v &&
        patch->point[slot].separation == point.separation)
      patch->height[slot] = height;
}

/* sense: 1 for points of a in the field of b, -1 for points of b in the field of a. */
SHARED void look_at_point(field_search *s, vec3 at, vec3 normal, field_height found, real sense)
{
  if (s->purpose == FIELD_DEEPEST) {
    if (found.height >= s->contact.gap) return;
    s->touches = 1;
    s->contact.gap = found.height;
    s->contact.normal = normal;
    s->patch->code = sense > R(0.0) ? code_of_features(0xfffu, found.face) : code_of_features(found.face, 0xfffu);
    return;
  }
  if (dot3(normal, s->contact.normal) < FIELD_SAME_FACE) return;
  vec3 placed = in_contact_axes(&s->patch->axes, at);
  clip_point point = {placed.x, placed.y, found.height, 1};
  if (s->purpose == FIELD_REDUCE) reduce_step(&s->points, point);
  else take_height(s->patch, point, sense > R(0.0) ? placed.z + found.height : placed.z);
}

SHARED void look_at_points(field_search *s, const convex *shape, const convex *field, real sense)
{
  real around = bounding_radius_of(field) + s->reach;
  for (uint k = 0u; k < surface_points_of(shape); ++k) {
    vec3 at = point_of_shape(shape, surface_point(shape, k)), from_field = subtract(at, field->center);
    if (length_squared(from_field) > around * around) continue;
    field_height found = height_above_field(field, to_shape_axes(field, from_field));
    if (found.height >= s->reach) continue;
    look_at_point(s, at, scale(from_shape_axes(field, xyz(plane_of_face(field, found.face))), -sense), found, sense);
  }
}

/* Prepares the pass that follows. False if there is none. */
SHARED mask next_look(field_search *s)
{
  if (s->purpose == FIELD_DEEPEST) {
    s->patch->axes = contact_axes_of(s->contact.normal);
    s->purpose = FIELD_REDUCE;
    s->touches = s->touches && s->contact.gap > -s->deep;
    return s->touches;
  }
  if (s->purpose == FIELD_HEIGHTS) return 0;
  if (next_pass(&s->points)) return 1;
  finish_reduction(s->patch->point, &s->points);
  s->purpose = FIELD_HEIGHTS;
  return 1;
}

/* False if no point of either shape is nearer to the other one than `touching`, or if one lies deep. */
SHARED mask field_patch(contact_patch *patch, const convex *a, const convex *b, real reach, real touching)
{
  field_search s;
  s.purpose = FIELD_DEEPEST;
  s.touches = 0;
  s.reach = reach;
  s.contact.gap = touching;
  s.deep = FIELD_DEPTH * minimum(least_size(a), least_size(b));
  s.contact.normal = make_vec3(R(0.0), R(1.0), R(0.0));
  s.patch = patch;
  patch->code = 0u;
  for (int slot = 0; slot < 4; ++slot) patch->height[slot] = R(0.0);
  start_reduction(&s.points, bounding_radius_of(b), slack_of_corners(b));
  do {
    if (s.purpose == FIELD_REDUCE && s.points.pass > 0 && reduce_kept(&s.points)) continue;
    look_at_points(&s, a, b, R(1.0));
    look_at_points(&s, b, a, R(-1.0));
  } while (next_look(&s));
  return s.touches;
}

#endif
