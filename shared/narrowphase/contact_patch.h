/* contact_patch.h - the points of a contact in the contact's own axes: the overlap of two supporting features, seen
 * along the normal.
 *
 * All methods that find a normal first use it (convex_contact.h, triangle_contact.h, sat_split.h): the features are
 * clipped (polygon_clip.h), the points are reduced to four (contact_points.h) and placed in the world.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CONTACT_PATCH_H
#define TANDEM_SHARED_NARROWPHASE_CONTACT_PATCH_H

#include "shared/narrowphase/polygon_clip.h"

/* The rounding error of a corner. */
SHARED real slack_of_corners(const convex *b) { return R(32.0) * ROUNDING * bounding_radius_of(b); }

SHARED contact_axes contact_axes_of(vec3 normal)
{
  tangents t = tangents_of(normal);
  contact_axes axes = {t.first, t.second, normal};
  return axes;
}

/* The points of a contact in its axes, and the height of the surface of b above each. */
typedef struct {
  contact_axes axes;
  clip_point point[4];
  real height[4];
  uint_lanes code;
} contact_patch;

/* Two supporting features about to be clipped. */
typedef struct {
  outline a, b;
  clipping clip;
  mask b_moves;
} feature_overlap;

SHARED void start_overlap(feature_overlap *overlap, const convex *a, const support_face *face_a, const convex *b,
                          const support_face *face_b, const contact_axes *axes, real reach)
{
  make_outline(&overlap->a, a, face_a, axes);
  make_outline(&overlap->b, b, face_b, axes);
  overlap->b_moves = face_b->corners <= face_a->corners;
  clipping *clip = &overlap->clip;
  clip->moving = overlap->b_moves ? &overlap->b : &overlap->a;
  clip->reference = overlap->b_moves ? &overlap->a : &overlap->b;
  measure_sides(overlap->b_moves ? &overlap->a : &overlap->b);
  clip->sense = overlap->b_moves ? R(1.0) : R(-1.0);
  clip->radii = core_radius(a) + core_radius(b);
  clip->reach = reach;
  clip->slack = slack_of_corners(b);
}

/* The height of the surface of b above a point. */
SHARED real height_of_b(const feature_overlap *overlap, const convex *a, const convex *b, clip_point p)
{
  real on_a = height_of(&overlap->a, p.u, p.v) + core_radius(a),
       on_b = height_of(&overlap->b, p.u, p.v) - core_radius(b);
  return overlap->b_moves ? on_a + p.separation : on_b;
}

/* Whether the overlap misses the deepest point of the shapes. The contact then lies where no features meet face to
 * face. */
SHARED mask misses_deepest(const reduction *r, real gap)
{
  return !r->deepest.point.valid || r->deepest.point.separation > gap + r->lead;
}
SHARED uint_lanes code_of_features(uint a, uint b) { return (a & 0xfffu) | (b & 0xfffu) << 12u; }

/* The overlap of the two supporting features. False if they do not overlap, or only away from the deepest point. */
SHARED mask overlap_patch(contact_patch *patch, const convex *a, const convex *b, core_contact contact, real reach)
{
  patch->axes = contact_axes_of(contact.normal);
  support_face face_a = support_face_of(a, contact.normal), face_b = support_face_of(b, negate(contact.normal));
  patch->code = code_of_features(face_a.feature, face_b.feature);
  if (face_a.corners == 1u || face_b.corners == 1u) return 0;
  feature_overlap overlap;
  start_overlap(&overlap, a, &face_a, b, &face_b, &patch->axes, reach);
  reduction r;
  start_reduction(&r, bounding_radius_of(b), overlap.clip.slack);
  do {
    if (r.pass == 0 || !reduce_kept(&r)) stream_overlap(&r, &overlap.clip);
  } while (next_pass(&r));
  if (misses_deepest(&r, contact.gap - overlap.clip.radii)) return 0;
  finish_reduction(patch->point, &r);
  for (int slot = 0; slot < 4; ++slot) patch->height[slot] = height_of_b(&overlap, a, b, patch->point[slot]);
  return 1;
}

/* A patch that consists of one point of b. */
SHARED void point_patch(contact_patch *patch, const convex *a, const convex *b, core_contact contact, vec3 on_b)
{
  vec3 at = in_contact_axes(&patch->axes, on_b);
  clip_point point = {at.x, at.y, contact.gap - core_radius(a) - core_radius(b), 1};
  for (int slot = 0; slot < 4; ++slot) {
    patch->point[slot] = point;
    patch->point[slot].valid = slot == 0;
    patch->height[slot] = at.z - core_radius(b);
  }
}

/* Transforms a patch from the pair's axes to world axes. */
SHARED manifold placed_manifold(const convex_pair *pair, const contact_patch *patch)
{
  const contact_axes *axes = &patch->axes;
  manifold m;
  vec3 normal = rotate(pair->axes, axes->normal);
  m.normal = pair->swapped ? negate(normal) : normal;
  m.code = patch->code;
  m.impact_time = R(0.0);
  for (int slot = 0; slot < 4; ++slot) {
    clip_point p = patch->point[slot];
    vec3 at = add_scaled(scale(axes->u, p.u), axes->v, p.v);
    at = add_scaled(at, axes->normal, patch->height[slot] - p.separation * R(0.5));
    m.point[slot] = extend(add(pair->origin, rotate(pair->axes, at)), p.separation);
    m.kept[slot] = p.valid;
  }
  return m;
}

#endif
