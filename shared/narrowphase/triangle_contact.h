/* triangle_contact.h - the contact of a mesh triangle with a convex shape or another triangle. A triangle is part of a
 * surface, not a body of its own.
 *
 *        .---.            Flat surface: the box slides over the seam of two triangles. It is deep in one of them, so
 *        | b |  -->       the shortest way out is sideways (x), which would stop it: an internal-edge contact. A normal
 *    ----'-x-'----        may lean over an edge only as far as the neighbour's normal does, and not at all over a flat
 *      A  |  B            or concave edge. Otherwise the triangle's own normal is taken.
 *
 *                  t   out  n2      convex edge: `out` is kept if it lies between the triangle's normal t and the
 *                   \  |  /         neighbour's normal n2, else t is taken
 *                 ___\_|_/          concave or flat edge: there is no such range, t is taken
 *                     A\B\
 *
 * Triangles are one-sided: a shape with more of itself behind than in front makes no contact. Two triangles that face
 * each other are the surfaces of two solids, and each may be behind the other as far as the thinner solid is thick. A
 * contact whose normal was replaced by the triangle's own counts only above the triangle; the neighbour makes the one
 * beyond. The method follows the talks of G. van den Bergen and E. Catto on mesh contacts, and Bullet's
 * btInternalEdgeUtility.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_TRIANGLE_CONTACT_H
#define TANDEM_SHARED_NARROWPHASE_TRIANGLE_CONTACT_H

#include "shared/narrowphase/convex_contact.h"
#include "shared/narrowphase/time_of_impact.h"

/* Sine of the angle by which a normal may lean where it should not at all: the noise of normals near touching. */
#define LEAN_NOISE R(1e-3)
/* Cosine of 2.5 degrees. */
#define SAME_FACE R(0.999)

/* A triangle in the axes of the pair. */
typedef struct {
  vec3 normal, corner[3], outward[3]; /* outward: unit, in the plane, out across the edge from corner k to the next */
} triangle_sides;

SHARED triangle_sides sides_of(const convex *shape)
{
  triangle_sides t;
  t.normal = from_shape_axes(shape, normal_of_triangle(shape));
  for (uint k = 0u; k < 3u; ++k) t.corner[k] = point_of_shape(shape, triangle_corner(shape, k));
  for (uint k = 0u; k < 3u; ++k) {
    vec3 across = cross3(subtract(t.corner[k == 2u ? 0u : k + 1u], t.corner[k]), t.normal);
    t.outward[k] = scale(across, R(1.0) / length_of(across));
  }
  return t;
}

/* The normal of a neighbour of the triangle, in the axes of the pair. */
SHARED vec3 normal_beyond(const convex *shape, uint neighbour)
{
  vec3 first = mesh_vertex(shape->tables, neighbour, 0u);
  vec3 normal = cross3(subtract(mesh_vertex(shape->tables, neighbour, 1u), first),
                       subtract(mesh_vertex(shape->tables, neighbour, 2u), first));
  return from_shape_axes(shape, scale(normal, R(1.0) / length_of(normal)));
}

/* Whether the surface around the triangle permits a contact normal along the unit direction `out`. */
SHARED mask surface_permits(const convex *shape, const triangle_sides *t, vec3 out)
{
  real up = dot3(out, t->normal);
  if (up < R(0.0)) return 0;
  for (uint k = 0u; k < 3u; ++k) {
    real lean = dot3(out, t->outward[k]);
    uint neighbour = shape->tables.mesh_triangles[shape->triangle * 6u + 3u + k];
    if (lean <= LEAN_NOISE || neighbour == INDEX_NONE) continue;
    vec3 beyond = normal_beyond(shape, neighbour);
    /* The sine of the angle from the neighbour's normal on to `out`, about the edge. */
    if (lean * dot3(beyond, t->normal) - up * dot3(beyond, t->outward[k]) > LEAN_NOISE) return 0;
  }
  return 1;
}

/* Whether more of the other core lies in front of the triangle than behind it. */
SHARED mask in_front(const triangle_sides *t, const convex *other)
{
  vec3 highest = subtract(support_of(other, t->normal), t->corner[0]),
       lowest = subtract(support_of(other, negate(t->normal)), t->corner[0]);
  return dot3(highest, t->normal) + dot3(lowest, t->normal) >= R(0.0);
}

SHARED mask above_triangle(const triangle_sides *t, vec3 point, real slack)
{
  for (uint k = 0u; k < 3u; ++k)
    if (dot3(subtract(point, t->corner[k]), t->outward[k]) > slack) return 0;
  return 1;
}

/* A pair with at least one triangle. of_a, of_b: whether the shape is a triangle. outside_a: whether b is on the outer
 * side of triangle a. */
typedef struct {
  const convex *a, *b;
  mask of_a, of_b, outside_a, outside_b;
  triangle_sides sides_a, sides_b;
} triangle_pair;

/* thickness: least half extent of the thinner body. */
SHARED void look_at_triangles(triangle_pair *pair, const convex *a, const convex *b, real thickness)
{
  pair->a = a;
  pair->b = b;
  pair->of_a = is_triangle(a);
  pair->of_b = is_triangle(b);
  pair->sides_a = sides_of(pair->of_a ? a : b);
  pair->sides_b = sides_of(pair->of_b ? b : a);
  pair->outside_a = pair->of_a && in_front(&pair->sides_a, b);
  pair->outside_b = pair->of_b && in_front(&pair->sides_b, a);
  if (!pair->of_a || !pair->of_b || dot3(pair->sides_a.normal, pair->sides_b.normal) >= R(0.0)) return;
  pair->outside_a = pair->outside_a || gap_along(a, b, pair->sides_a.normal) > -thickness;
  pair->outside_b = pair->outside_b || gap_along(a, b, negate(pair->sides_b.normal)) > -thickness;
}

SHARED mask normal_permitted(const triangle_pair *pair, vec3 normal)
{
  return (!pair->of_a || surface_permits(pair->a, &pair->sides_a, normal)) &&
         (!pair->of_b || surface_permits(pair->b, &pair->sides_b, negate(normal)));
}
/* Whether the way out leads to the back of a triangle, which means that another face of its solid touches. Between two
 * triangles this proves nothing. */
SHARED mask leads_behind(const triangle_pair *pair, vec3 normal)
{
  if (pair->of_a && pair->of_b) return 0;
  return (pair->of_a && dot3(normal, pair->sides_a.normal) < -LEAN_NOISE) ||
         (pair->of_b && dot3(normal, pair->sides_b.normal) > LEAN_NOISE);
}

/* The contact along a triangle's own normal; of two triangles, along the normal that shows less overlap. The other
 * shape must be outside of at least one. */
SHARED core_contact contact_along_face(const triangle_pair *pair)
{
  core_contact along_a = {pair->sides_a.normal, R(-1e30)}, along_b = {negate(pair->sides_b.normal), R(-1e30)};
  if (pair->outside_a) along_a.gap = gap_along(pair->a, pair->b, along_a.normal);
  if (pair->outside_b) along_b.gap = gap_along(pair->a, pair->b, along_b.normal);
  return along_b.gap > along_a.gap ? along_b : along_a;
}

/* The penetration of a pair with a triangle. Round cores that reach the surface, and two flat triangles that cross,
 * part along a face normal only. */
SHARED core_contact triangle_penetration(const triangle_pair *pair, vec3 up, real tolerance)
{
  const convex *other = pair->of_a ? pair->b : pair->a;
  mask only_face = (pair->of_a && pair->of_b) || other->kind == (uint)SHAPE_SPHERE || is_capsule(other);
  return only_face ? contact_along_face(pair) : penetration(pair->a, pair->b, up, up, tolerance, CONVEX_EXPANSION);
}

/* The triangle whose normal is the contact's; 0 if it is neither's. */
SHARED const triangle_sides *face_of_contact(const triangle_pair *pair, vec3 normal)
{
  if (pair->of_a && dot3(normal, pair->sides_a.normal) > R(0.999999)) return &pair->sides_a;
  if (pair->of_b && dot3(normal, pair->sides_b.normal) < R(-0.999999)) return &pair->sides_b;
  return 0;
}

/* The patch of the deepest point, if it lies above the triangle; for a face contact whose features do not overlap. */
SHARED mask face_point_patch(contact_patch *patch, const triangle_pair *pair, core_contact contact,
                             const triangle_sides *face)
{
  mask on_a = face == &pair->sides_a;
  vec3 deepest = on_a ? support_of(pair->b, negate(contact.normal))
                      : add_scaled(support_of(pair->a, contact.normal), contact.normal, contact.gap);
  real size = minimum(bounding_radius_of(pair->a), bounding_radius_of(pair->b));
  if (!above_triangle(face, deepest, R(1e-4) * size)) return 0;
  point_patch(patch, pair->a, pair->b, contact, deepest);
  return 1;
}

/* Whether the normal is so near a triangle's own that the triangle is the face of contact. Each of many triangles under
 * a tilted box then gets its own depth, not that of the box's lowest corner. */
SHARED mask nearly_along_face(const triangle_pair *pair, vec3 normal)
{
  return (pair->outside_a && dot3(normal, pair->sides_a.normal) > SAME_FACE) ||
         (pair->outside_b && dot3(normal, pair->sides_b.normal) < -SAME_FACE);
}

/* The contact along a face normal near the contact's normal, as far as the surface permits it. */
SHARED core_contact permitted_contact(const triangle_pair *pair, core_contact contact, real lead)
{
  if (!normal_permitted(pair, contact.normal)) return contact_along_face(pair);
  core_contact face = prefer_faces(contact, pair->a, pair->b, lead);
  if (nearly_along_face(pair, face.normal)) return contact_along_face(pair);
  return normal_permitted(pair, face.normal) ? face : contact;
}

/* TRIANGLE_APART: nothing is within reach in front of the triangle. TRIANGLE_BESIDE: a shape is within reach, but has
 * no contact with the triangle at its current pose. */
enum { TRIANGLE_APART = 0, TRIANGLE_BESIDE = 1, TRIANGLE_MEETS = 2 };

SHARED int triangle_patch(contact_patch *patch, const convex_pair *pair, real reach, real thickness, real lead)
{
  const convex *a = &pair->a, *b = &pair->b;
  real radii = core_radius(a) + core_radius(b);
  gjk_result near = closest_points(a, b, reach + radii);
  if (!near.overlapping && near.contact.gap - radii >= reach) return TRIANGLE_APART;
  triangle_pair triangles;
  look_at_triangles(&triangles, a, b, thickness);
  if (!triangles.outside_a && !triangles.outside_b) return TRIANGLE_APART;
  core_contact contact = near.overlapping ? triangle_penetration(&triangles, pair->up, lead * R(0.25)) : near.contact;
  if (leads_behind(&triangles, contact.normal)) return TRIANGLE_BESIDE;
  core_contact closest = contact;
  contact = permitted_contact(&triangles, contact, lead);
  if (contact.gap - radii >= reach) return TRIANGLE_BESIDE;
  const triangle_sides *face = face_of_contact(&triangles, contact.normal);
  /* On a face every point above it counts, whether or not the deepest point of all is among them, because that one may
   * lie above a neighbour. */
  core_contact sought = {contact.normal, face ? R(1e30) : contact.gap};
  if (overlap_patch(patch, a, b, sought, reach)) return TRIANGLE_MEETS;
  if (face) {
    if (face_point_patch(patch, &triangles, contact, face)) return TRIANGLE_MEETS;
    /* Nothing lies above a face that was only preferred. The closest points lie on a sharp edge of it, whose other side
     * may face away from the shape. */
    if (near.overlapping || !normal_permitted(&triangles, closest.normal) || closest.gap - radii >= reach)
      return TRIANGLE_BESIDE;
    contact = closest;
  }
  point_patch(patch, a, b, contact, near.overlapping ? deepest_point_of_b(a, b, contact) : near.on_b);
  return TRIANGLE_MEETS;
}

/* The impact_time of a manifold without points whose shape is beside the triangle and may come in front of it within
 * the step. It is positive, because rusticl returns -0 for the other side of a choice between -1 and 0. */
#define BESIDE R(1e30)

/* The arguments are those of convex_contact; at least one shape is a triangle. thickness: least half extent of the two
 * bodies, m. */
SHARED manifold triangle_contact(const convex *first, const convex *second, real reach, real thickness, real slop)
{
  convex_pair pair = pair_of(first, second);
  contact_patch patch;
  int found = triangle_patch(&patch, &pair, reach, thickness, lead_of_faces(&pair.a, &pair.b, slop));
  if (found == TRIANGLE_MEETS) return kept_within(placed_manifold(&pair, &patch), reach);
  manifold none = single_contact(rotate(pair.axes, pair.up), pair.origin, reach, 0);
  none.impact_time = found == TRIANGLE_BESIDE ? BESIDE : R(0.0);
  return none;
}

#endif
