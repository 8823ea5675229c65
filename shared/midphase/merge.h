/* merge.h - joins the manifolds of one pair of bodies whose normals agree.
 *
 *      +-----------+             A box on a mesh touches many triangles of one plane. Each leaf gives a manifold, so
 *      |           |             there are sixteen points where four would do. Leaves whose normals agree form a group.
 *    __*__*__*__*__*__           The first leaf of a group gets the best four points of all (contact_points.h), the
 *     /\  |  /\  |  /\           others keep none.
 *
 * There are two kernels, because a manifold must not change while another leaf still reads it: group_manifolds stores
 * the first leaf of the group of each leaf, and merge_manifolds joins. A group of one keeps its manifold to the bit.
 */
#ifndef TANDEM_SHARED_MIDPHASE_MERGE_H
#define TANDEM_SHARED_MIDPHASE_MERGE_H

#include "shared/narrowphase/contact_points.h"
#include "shared/narrowphase/convex.h"

/* Cosine of 8 degrees. */
#define SAME_DIRECTION R(0.99)
/* A share of the step. Impacts no farther apart count as one; the arms of a joined manifold are those of one moment. */
#define SAME_MOMENT R(0.004)
/* A share of the slop: how much more a point may approach in the step when seen along the normal of its group. */
#define SAME_APPROACH R(0.1)
/* The feature code of a joined manifold. Its points are identified by their role in the reduction. */
#define JOINED_CODE 0xffffffu

SHARED mask same_bodies(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, uint i, uint j)
{
  return pair_a[i] == pair_a[j] && pair_b[i] == pair_b[j];
}

/* Whether two normals, with the moments of their impacts, may join. approach: velocity of a relative to b. */
SHARED mask press_alike(GLOBAL const Parameters *parameters, vec4 first, vec4 second, vec3 approach)
{
  real nearer = magnitude(dot3(subtract(xyz(first), xyz(second)), approach)) * parameters->step;
  return dot3(xyz(first), xyz(second)) >= SAME_DIRECTION &&
         nearer <= maximum(SAME_APPROACH * parameters->slop, R(1e-5)) &&
         magnitude(first.w - second.w) <= SAME_MOMENT * parameters->step && keeps_arms(first.w) == keeps_arms(second.w);
}

SHARED mask same_material(GLOBAL const uint *flags, GLOBAL const uint *pair_leaf, uint i, uint j)
{
  return material_of(flags[pair_leaf[i * 4u]]) == material_of(flags[pair_leaf[j * 4u]]) &&
         material_of(flags[pair_leaf[i * 4u + 2u]]) == material_of(flags[pair_leaf[j * 4u + 2u]]);
}

/* The item of the first leaf of a pair of bodies groups all leaves of the pair. */
SHARED void group_manifolds_item(GLOBAL const Parameters *parameters, read_part_pairs pairs, GLOBAL const uint *flags,
                                 GLOBAL const float4 *velocities, read_manifolds manifolds, GLOBAL const uint *counts,
                                 GLOBAL uint *group, uint i)
{
  if (i > 0u && same_bodies(pairs.a, pairs.b, i, i - 1u)) return;
  vec3 approach = subtract(load_velocity(velocities, pairs.a[i]).linear, load_velocity(velocities, pairs.b[i]).linear);
  uint end = counts[COUNT_PAIRS];
  for (uint j = i; j < end && same_bodies(pairs.a, pairs.b, i, j); ++j) {
    group[j] = j;
    if (manifolds.count[j] == 0u) continue;
    vec4 normal = load_float4(manifolds.normal, j);
    for (uint k = i; k < j; ++k) {
      if (group[k] != k || manifolds.count[k] == 0u) continue;
      if (!press_alike(parameters, load_float4(manifolds.normal, k), normal, approach) ||
          !same_material(flags, pairs.leaf, j, k))
        continue;
      group[j] = k;
      break;
    }
  }
}

/* The manifolds of a group in the buffers. */
typedef struct {
  GLOBAL const uint *group, *counts_of_points;
  GLOBAL const float4 *points;
  point_planes planes;
  uint first, end; /* leaves first .. end - 1 may belong to the group of `first` */
} manifold_group;

/* Streams all points of the group through the reduction. With `wanted` it instead returns the offset of the point that
 * has these coordinates. */
SHARED vec3 stream_group(reduction *r, const manifold_group *group, tangents axes, const clip_point *wanted)
{
  vec3 found = make_vec3(R(0.0), R(0.0), R(0.0));
  for (uint j = group->first; j < group->end; ++j) {
    if (group->group[j] != group->first) continue;
    for (uint k = 0u; k < group->counts_of_points[j]; ++k) {
      vec4 point = load_manifold_point(group->points, group->planes, k, j);
      clip_point candidate = {dot3(axes.first, xyz(point)), dot3(axes.second, xyz(point)), point.w, 1};
      if (!wanted) reduce_step(r, candidate);
      else if (candidate.u == wanted->u && candidate.v == wanted->v && candidate.separation == wanted->separation)
        return xyz(point);
    }
  }
  return found;
}

/* first: the unit normal, and the moment of the impact. */
SHARED manifold joined_manifold(const manifold_group *group, vec4 first, real size)
{
  vec3 normal = xyz(first);
  tangents axes = tangents_of(normal);
  clip_point four[4];
  reduction r;
  start_reduction(&r, size, R(32.0) * ROUNDING * size);
  do stream_group(&r, group, axes, 0);
  while (next_pass(&r));
  finish_reduction(four, &r);
  manifold m;
  m.normal = normal;
  m.code = JOINED_CODE;
  m.impact_time = first.w;
  for (int slot = 0; slot < 4; ++slot) {
    m.kept[slot] = four[slot].valid;
    m.point[slot] = extend(stream_group(&r, group, axes, &four[slot]), four[slot].separation);
  }
  return m;
}

SHARED void merge_manifolds_item(read_pairs pairs, GLOBAL const float4 *shapes, GLOBAL const uint *group,
                                 GLOBAL const uint *counts, write_manifolds manifolds, uint i)
{
  if (group[i] != i || manifolds.count[i] == 0u) return;
  point_planes planes = planes_of(counts);
  uint end = i + 1u, members = 0u;
  for (; end < counts[COUNT_PAIRS] && same_bodies(pairs.a, pairs.b, i, end); ++end)
    members = members + (group[end] == i ? 1u : 0u);
  if (members == 0u) return;
  manifold_group all = {group, manifolds.count, manifolds.points, planes, i, end};
  real radius_a = load_float4(shapes, pairs.a[i]).w, radius_b = load_float4(shapes, pairs.b[i]).w;
  real size = radius_a > R(0.0) && (radius_a < radius_b || radius_b <= R(0.0)) ? radius_a : radius_b;
  manifold m = joined_manifold(&all, load_float4(manifolds.normal, i), size);
  manifold nothing = single_contact(m.normal, xyz(m.point[0]), R(0.0), 0);
  for (uint j = i + 1u; j < end; ++j)
    if (group[j] == i) store_manifold_if(1, nothing, planes, manifolds, j);
  store_manifold_if(1, m, planes, manifolds, i);
}

#endif
