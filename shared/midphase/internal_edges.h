/* internal_edges.h - drops internal-edge contacts: those at seams between the children of compounds, which another
 * contact of the same two bodies explains.
 *
 *      +------+------+        At rest the upper compound stands a little in the lower one. Child B and child C, which
 *      |  A   |  B   |        share no face, then overlap by that much, and their shortest way out is sideways (x): it
 *      +------x------+        would hold up whatever slides. All its points lie in the surface on which A stands; what
 *      |  C   |  D   |        is no thicker than the penetration that is left in place is no obstacle.
 *      +------+------+
 *
 * For meshes triangle_contact.h uses the neighbours of each triangle instead; the children of a compound have none. Two
 * kernels, as in merge.h: first all manifolds are judged, then internal-edge contacts are dropped.
 */
#ifndef TANDEM_SHARED_MIDPHASE_INTERNAL_EDGES_H
#define TANDEM_SHARED_MIDPHASE_INTERNAL_EDGES_H

#include "shared/midphase/merge.h"

/* Cosine above which normals press the same way, though not in one group. */
#define ACROSS R(0.7)
/* Penetration left in place, and what the solver leaves on top of it. */
#define INTERNAL_EDGE_SHARE R(1.25)

/* Buffers of manifolds, and what counts as thin. */
typedef struct {
  read_manifolds manifolds;
  uint stride;
  real thickness;
} manifold_list;

/* All points of manifold i lie near the plane of manifold j. */
SHARED mask lies_in_plane_of(const manifold_list *list, uint i, uint j)
{
  vec3 normal = xyz(load_float4(list->manifolds.normal, j)), origin = xyz(load_float4(list->manifolds.points, j));
  for (uint k = 0u; k < list->manifolds.count[i]; ++k)
    if (magnitude(dot3(subtract(xyz(load_float4(list->manifolds.points, list->stride * k + i)), origin), normal)) >
        list->thickness)
      return 0;
  return 1;
}

SHARED mask presses(const manifold_list *list, uint j)
{
  for (uint k = 0u; k < list->manifolds.count[j]; ++k)
    if (load_float4(list->manifolds.points, list->stride * k + j).w < list->thickness) return 1;
  return 0;
}

/* Of two that explain each other the earlier one stays. */
SHARED mask explained_by(const manifold_list *list, uint i, uint j)
{
  if (j == i || list->manifolds.count[j] == 0u) return 0;
  if (dot3(xyz(load_float4(list->manifolds.normal, i)), xyz(load_float4(list->manifolds.normal, j))) > ACROSS) return 0;
  if (!presses(list, j) || !lies_in_plane_of(list, i, j)) return 0;
  return j < i || !presses(list, i) || !lies_in_plane_of(list, j, i);
}

SHARED void find_internal_edges_item(GLOBAL const Parameters *parameters, read_pairs pairs, GLOBAL const float4 *shapes,
                                     read_manifolds manifolds, GLOBAL const uint *counts, GLOBAL uint *internal_edge,
                                     uint i)
{
  internal_edge[i] = 0u;
  if (manifolds.count[i] == 0u) return;
  real slop = minimum(parameters->slop, parameters->slop_share * size_between(shapes, pairs.a[i], pairs.b[i]));
  manifold_list list = {manifolds, counts[CAPACITY_PAIRS], slop * INTERNAL_EDGE_SHARE};
  for (uint j = i; j > 0u && same_bodies(pairs.a, pairs.b, i, j - 1u); --j)
    if (explained_by(&list, i, j - 1u)) internal_edge[i] = 1u;
  for (uint j = i + 1u; j < counts[COUNT_PAIRS] && same_bodies(pairs.a, pairs.b, i, j); ++j)
    if (explained_by(&list, i, j)) internal_edge[i] = 1u;
}

SHARED void drop_internal_edges_item(GLOBAL const uint *internal_edge, GLOBAL const uint *counts,
                                     write_manifolds manifolds, uint i)
{
  if (internal_edge[i] == 0u) return;
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  store_manifold_if(1, single_contact(none, none, R(0.0), 0), counts[CAPACITY_PAIRS], manifolds, i);
}

#endif
