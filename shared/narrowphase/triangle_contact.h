/* triangle_contact.h - a triangle of a mesh against a convex shape or another triangle: a surface, not a body of its
 * own.
 *
 *        .---.              Flat: the box slides over the seam of two triangles. Deep in one of them its shortest way
 *        | b |  -->         out is sideways (x), which would catch it. A normal may lean over an edge only as far as
 *    ----'-x-'----          the neighbour's does, and over a flat or concave edge not at all: then the triangle's own
 *      A  |  B              normal holds.
 *
 *                  t   out  n2      convex: out lies between t and the neighbour's n2, or t is taken instead
 *                   \  |  /
 *                 ___\_|_/          concave or flat: no wedge, t is taken
 *                     A\B\
 *
 * Triangles are one-sided: a shape with more of itself behind than in front makes no contact. Two triangles that face
 * each other are the skins of two solids, and each may be behind the other as far as the thinner of the solids is. A
 * contact moved to the triangle's own normal counts only above the triangle; the neighbour makes the one beyond. After
 * G. van den Bergen's and E. Catto's talks on mesh contacts, and Bullet's btInternalEdgeUtility.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_TRIANGLE_CONTACT_H
#define TANDEM_SHARED_NARROWPHASE_TRIANGLE_CONTACT_H

#include "shared/narrowphase/convex_contact.h"
#include "shared/narrowphase/time_of_impact.h"

/* Sine of the angle by which a normal may lean where it must not: the noise of normals near touching. */
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

/* Normal of the triangle beyond edge k, in the axes of the pair. */
SHARED vec3 normal_beyond(const convex *shape, uint neighbour)
{
  vec3 first = mesh_vertex(shape->tables, neighbour, 0u);
  vec3 normal = cross3(subtract(mesh_vertex(shape->tables, neighbour, 1u), first),
                       subtract(mesh_vertex(shape->tables, neighbour, 2u), first));
  return from_shape_axes(shape, scale(normal, R(1.0) / length_of(normal)));
}

/* Whether the surface lets a contact push out along a unit direction. */
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

/* More of the other core lies in front of the triangle than behind it. */
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

/* What is known of a pair with a triangle in it. of_a, of_b: the shape is one. outside_a: b is on the outer side of
 * a. */
typedef struct {
  const convex *a, *b;
  mask of_a, of_b, outside_a, outside_b;
  triangle_sides sides_a, sides_b;
} triangle_pair;

/* thickness: of the thinner body. */
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
/* The way out leads into the back of a triangle: another face of its solid touches. Of two triangles, one may well be
 * seen so. */
SHARED mask leads_behind(const triangle_pair *pair, vec3 normal)
{
  if (pair->of_a && pair->of_b) return 0;
  return (pair->of_a && dot3(normal, pair->sides_a.normal) < -LEAN_NOISE) ||
         (pair->of_b && dot3(normal, pair->sides_b.normal) > LEAN_NOISE);
}

/* Along a triangle's own normal; of two the one along which less is in the way. At least one has the other shape
 * outside. */
SHARED core_contact contact_along_face(const triangle_pair *pair)
{
  core_contact along_a = {pair->sides_a.normal, R(-1e30)}, along_b = {negate(pair->sides_b.normal), R(-1e30)};
  if (pair->outside_a) along_a.gap = gap_along(pair->a, pair->b, along_a.normal);
  if (pair->outside_b) along_b.gap = gap_along(pair->a, pair->b, along_b.normal);
  return along_b.gap > along_a.gap ? along_b : along_a;
}

/* Round cores that reach the surface have no way out but up; so have two flat triangles that cross. */
SHARED core_contact triangle_penetration(const triangle_pair *pair, vec3 up, real tolerance)
{
  const convex *other = pair->of_a ? pair->b : pair->a;
  mask only_face = (pair->of_a && pair->of_b) || other->kind == (uint)SHAPE_SPHERE || is_capsule(other);
  return only_face ? contact_along_face(pair) : penetration(pair->a, pair->b, up, up, tolerance, CONVEX_EXPANSION);
}

/* The face whose normal the contact has; 0 where it lies elsewhere. */
SHARED const triangle_sides *face_of_contact(const triangle_pair *pair, vec3 normal)
{
  if (pair->of_a && dot3(normal, pair->sides_a.normal) > R(0.999999)) return &pair->sides_a;
  if (pair->of_b && dot3(normal, pair->sides_b.normal) < R(-0.999999)) return &pair->sides_b;
  return 0;
}

/* Where nothing meets the triangle on its face: the deepest point, if it lies above it. */
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

/* So near a triangle's own normal that the triangle is the face they meet on: of a tilted box's bottom and many
 * triangles each then has its own depth, not that of the box's lowest corner. */
SHARED mask nearly_along_face(const triangle_pair *pair, vec3 normal)
{
  return (pair->outside_a && dot3(normal, pair->sides_a.normal) > SAME_FACE) ||
         (pair->outside_b && dot3(normal, pair->sides_b.normal) < -SAME_FACE);
}

/* A face of the shapes near the normal, where the surface permits it. */
SHARED core_contact permitted_contact(const triangle_pair *pair, core_contact contact, real lead)
{
  if (!normal_permitted(pair, contact.normal)) return contact_along_face(pair);
  core_contact face = prefer_faces(contact, pair->a, pair->b, lead);
  if (nearly_along_face(pair, face.normal)) return contact_along_face(pair);
  return normal_permitted(pair, face.normal) ? face : contact;
}

/* TRIANGLE_APART: nothing is within reach in front of the triangle. TRIANGLE_BESIDE: a shape is, but has no contact
 * here as it stands. */
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
  /* On a face every point above it counts, whether or not the deepest of all is among them: that one may lie above a
   * neighbour. */
  core_contact sought = {contact.normal, face ? R(1e30) : contact.gap};
  if (overlap_patch(patch, a, b, sought, reach)) return TRIANGLE_MEETS;
  if (face) {
    if (face_point_patch(patch, &triangles, contact, face)) return TRIANGLE_MEETS;
    /* Nothing is above a face that was only preferred: the closest points lie on a sharp edge of it, whose other side
     * may be turned away from what comes. */
    if (near.overlapping || !normal_permitted(&triangles, closest.normal) || closest.gap - radii >= reach)
      return TRIANGLE_BESIDE;
    contact = closest;
  }
  point_patch(patch, a, b, contact, near.overlapping ? deepest_point_of_b(a, b, contact) : near.on_b);
  return TRIANGLE_MEETS;
}

/* impact_time of a manifold without points, where the shape is beside the triangle: it may come before it within the
 * step. Not below 0: rusticl makes -0 of the other side of a choice between -1 and 0. */
#define BESIDE R(1e30)

/* As convex_contact; at least one of the two is a triangle. thickness: least half extent of the two bodies, m. */
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
