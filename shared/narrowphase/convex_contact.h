/* convex_contact.h - the manifold of any two convex shapes.
 *
 *   pair_of -> normal and gap by one of four methods -> a face normal instead, if it is as good -> supporting features
 *           -> their overlap seen along the normal -> four points
 *
 * Where the cores are apart, gjk.h gives normal and gap; a separating axis that is not the direction of the closest
 * points would have no contact point on it. Where the cores overlap, the method decides:
 *
 *   CONVEX_EXPANSION   epa.h: the least depth, with 1.6 KiB of private memory
 *   CONVEX_SAMPLED     sampled_depth.h: nearly the least depth, with little memory
 *   CONVEX_AXES        hull_axes.h for boxes and hulls: the least depth, faces first; else as CONVEX_EXPANSION
 *   CONVEX_FIELDS      cube_field.h for boxes and hulls near each other, which also gives points; else as
 *                      CONVEX_EXPANSION
 *
 * Contacts are speculative up to `reach`. A normal always has unit length.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CONVEX_CONTACT_H
#define TANDEM_SHARED_NARROWPHASE_CONVEX_CONTACT_H

#include "shared/narrowphase/contact_patch.h"
#include "shared/narrowphase/cube_field.h"
#include "shared/narrowphase/epa.h"
#include "shared/narrowphase/hull_axes.h"
#include "shared/narrowphase/sampled_depth.h"

/* The lead that an axis needs over a face to be preferred to it (box_axes.h). */
SHARED real lead_of_faces(const convex *a, const convex *b, real slop)
{
  real noise = R(16.0) * ROUNDING * (bounding_radius_of(a) + bounding_radius_of(b));
  return minimum(slop * R(0.1), minimum(least_size(a), least_size(b)) * R(0.01)) + noise;
}

/* The normal of the flat face that a shape turns to a direction; 0 if it has none. */
SHARED vec3 flat_normal_toward(const convex *shape, vec3 direction)
{
  vec3 own = to_shape_axes(shape, direction), none = make_vec3(R(0.0), R(0.0), R(0.0));
  if (is_cylinder(shape)) {
    mask has_cap = (own.y > R(0.0) ? shape->size.z : shape->size.x) > R(0.0);
    return has_cap ? from_shape_axes(shape, make_vec3(R(0.0), sign_of(own.y), R(0.0))) : none;
  }
  if (is_triangle(shape)) return triangle_feature(shape, own).normal;
  if (!is_polytope(shape)) return none;
  uint k = shape->kind == (uint)SHAPE_BOX ? box_face_toward(own) : hull_face_toward(shape, own);
  return from_shape_axes(shape, xyz(plane_of_face(shape, k)));
}

/* The contact along a face normal, if that is nearly as good. A face carries up to four points, while an axis that is
 * hardly better carries fewer and changes with rounding. */
SHARED core_contact prefer_faces(core_contact contact, const convex *a, const convex *b, real lead)
{
  vec3 face_a = flat_normal_toward(a, contact.normal), face_b = negate(flat_normal_toward(b, negate(contact.normal)));
  real least = contact.gap - lead, gap_a = R(-1e30), gap_b = R(-1e30);
  if (dot3(face_a, contact.normal) > R(0.5)) gap_a = gap_along(a, b, face_a);
  if (dot3(face_b, contact.normal) > R(0.5)) gap_b = gap_along(a, b, face_b);
  mask of_b = gap_b > gap_a + lead;
  real gap = of_b ? gap_b : gap_a;
  if (gap < least) return contact;
  contact.normal = of_b ? face_b : face_a;
  contact.gap = gap;
  return contact;
}

/* Depth and normal of two cores that overlap. hint: as in sampled_penetration. tolerance: how much deeper than the
 * least depth the answer may be. Round shapes need more vertices than the polytope can hold, and fixed directions miss
 * the least depth; distance queries then refine the answer. */
SHARED core_contact penetration(const convex *a, const convex *b, vec3 up, vec3 hint, real tolerance, uint_lanes method)
{
  core_contact found = {up, R(-1e30)};
  mask rough = 1;
  if (MAY_OCCUR(SAMPLED) && method == (uint)CONVEX_SAMPLED) {
    found = sampled_penetration(a, b, up, hint);
  } else if (MAY_OCCUR(EXPANSION)) {
    epa_result expanded = penetration_by_expansion(a, b, up, tolerance);
    found = expanded.contact;
    rough = expanded.error > tolerance + R(16.0) * ROUNDING * (bounding_radius_of(a) + bounding_radius_of(b)) +
                                 R(1e-5) * magnitude(found.gap);
  }
  return rough ? refined_by_distance(found, a, b) : found;
}

/* What is found about a normal of the pair before features are clipped. */
typedef struct {
  core_contact contact;
  mask apart; /* whether the cores are apart; on_b is then the closest point of b */
  vec3 on_b;
} core_meeting;

/* by_axes: `axis` is the best axis of two polytopes; their closest points are needed only if it separates them. limit:
 * cores farther apart than this make no contact. */
SHARED core_meeting core_meeting_of(const convex_pair *pair, real limit, real lead, uint_lanes method, mask by_axes,
                                    core_contact axis)
{
  const convex *a = &pair->a, *b = &pair->b;
  core_meeting met = {axis, 0, b->center};
  if (by_axes && axis.gap <= R(0.0)) return met;
  gjk_result near =
      closest_points_from(a, b, whole_gap(limit), by_axes ? negate(axis.normal) : subtract(a->center, b->center));
  met.apart = !near.overlapping;
  if (met.apart) {
    met.contact = near.contact;
    met.on_b = near.on_b;
  } else if (!by_axes) {
    /* The tolerance covers the rim between the cap of a cylinder and a face that is nearly parallel to it, which need
     * not be resolved. */
    met.contact = penetration(a, b, pair->up, near.contact.normal, lead * R(0.25), method);
  }
  return met;
}

/* A manifold without points, for shapes too far apart. */
SHARED manifold no_contact(const convex_pair *pair, vec3 normal, real gap)
{
  vec3 placed = rotate(pair->axes, normal);
  return single_contact(pair->swapped ? negate(placed) : placed, pair->origin, gap, 0);
}

/* Both shapes are seen from the centre of the first one's body, in world axes. reach: up to this separation contacts
 * are made, m. slop: penetration left in place, m. */
SHARED manifold convex_contact(const convex *first, const convex *second, real reach, real slop, uint_lanes method)
{
  convex_pair pair = pair_of(first, second);
  const convex *a = &pair.a, *b = &pair.b;
  real radii = core_radius(a) + core_radius(b),
       noise = R(4.0) * ROUNDING * (bounding_radius_of(a) + bounding_radius_of(b));
  real lead = lead_of_faces(a, b, slop);
  mask by_axes = MAY_OCCUR(AXES) && method == (uint)CONVEX_AXES && is_polytope(a) && is_polytope(b);
  core_contact contact = {pair.up, R(-1e30)};
  if (by_axes) {
    contact = separating_hull_axis(a, b, lead, reach).contact;
    if (contact.gap >= reach) return no_contact(&pair, contact.normal, contact.gap);
  }
  /* Features are clipped along up to three normals until they overlap: along the axis found, along a face normal that
   * is nearly as good, and along one that is equal but for rounding. */
  core_meeting met = {contact, 0, b->center};
  contact_patch patch;
  mask found = MAY_OCCUR(FIELDS) && method == (uint)CONVEX_FIELDS && is_polytope(a) && is_polytope(b) &&
               field_patch(&patch, a, b, reach, minimum(reach, lead));
  if (found) return kept_within(placed_manifold(&pair, &patch), reach);
  for (int attempt = by_axes ? 0 : 1; attempt < 3 && !found; ++attempt) {
    if (attempt == 1) met = core_meeting_of(&pair, reach + radii, lead, method, by_axes, contact);
    if (attempt == 1 && met.contact.gap - radii >= reach)
      return no_contact(&pair, met.contact.normal, met.contact.gap - radii);
    contact = attempt == 0 ? contact : prefer_faces(met.contact, a, b, attempt == 1 ? lead : noise);
    found = overlap_patch(&patch, a, b, contact, reach);
  }
  if (!found) point_patch(&patch, a, b, contact, met.apart ? met.on_b : deepest_point_of_b(a, b, contact));
  return kept_within(placed_manifold(&pair, &patch), reach);
}

#endif
