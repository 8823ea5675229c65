/* depth_refinement.h - turns a normal of small overlap into one of locally least overlap, by distance queries.
 *
 *     .------.   .--.    b is moved out along the normal until the two are apart. The normal of the closest points is
 *     |  a   |   | b|    then that of the face, the edge pair or the round side nearby, as exact as gjk.h is. It is
 *     '------'   '--'    taken only if it shows less overlap, and the search is repeated from there. It needs no memory
 *                        beyond that of a distance query.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_DEPTH_REFINEMENT_H
#define TANDEM_SHARED_NARROWPHASE_DEPTH_REFINEMENT_H

#include "shared/narrowphase/gjk.h"

#define DEPTH_REFINEMENTS 8

SHARED core_contact shallower(core_contact best, const convex *a, const convex *b, vec3 normal)
{
  core_contact contact = {normal, gap_along(a, b, normal)};
  return contact.gap > best.gap ? contact : best;
}

/* The distance of a from b after b was moved along the normal until the gap is a small part of their sizes. */
SHARED gjk_result distance_moved_apart(const convex *a, const convex *b, core_contact contact, vec3 *shift)
{
  real rounding = R(64.0) * ROUNDING * (bounding_radius_of(a) + bounding_radius_of(b));
  real margin = R(0.02) * (least_size(a) + least_size(b)) + rounding;
  *shift = scale(contact.normal, margin - contact.gap);
  convex moved = *b;
  moved.center = add(b->center, *shift);
  return closest_points(a, &moved, R(1e30));
}

SHARED core_contact refined_by_distance(core_contact best, const convex *a, const convex *b)
{
  for (int round = 0; round < DEPTH_REFINEMENTS; ++round) {
    vec3 shift;
    gjk_result apart = distance_moved_apart(a, b, best, &shift);
    if (apart.overlapping) break;
    real before = best.gap;
    best = shallower(best, a, b, apart.contact.normal);
    if (best.gap - before <= R(1e-5) * magnitude(before)) break;
  }
  return best;
}

/* The point of b deepest inside a along the normal of a contact, for contacts of a single point. */
SHARED vec3 deepest_point_of_b(const convex *a, const convex *b, core_contact contact)
{
  vec3 shift;
  gjk_result apart = distance_moved_apart(a, b, contact, &shift);
  return apart.overlapping ? support_of(b, negate(contact.normal)) : subtract(apart.on_b, shift);
}

#endif
