/* internal_edges.h - drops internal-edge contacts: contacts at seams between the children of compounds that another
 * contact of the same two bodies explains.
 *
 *      +------+------+       At rest the upper compound stands a little in the lower one. Child B and child C, which
 *      |  A   |  B   |       share no face, then overlap by that much, and the shortest way out is sideways (x). Such a
 *      +------x------+       contact would stop a body that slides. All its points lie in the surface on which A
 *      |  C   |  D   |       stands, and an overlap no thicker than the penetration that is left in place is not an
 *      +------+------+       obstacle.
 *
 * For meshes triangle_contact.h uses the neighbours of each triangle instead; the children of a compound have none.
 * There are two kernels, as in merge.h: the first judges all manifolds, the second drops internal-edge contacts.
 */
#ifndef TANDEM_SHARED_MIDPHASE_INTERNAL_EDGES_H
#define TANDEM_SHARED_MIDPHASE_INTERNAL_EDGES_H

#include "shared/midphase/merge.h"

/* Cosine above which two normals push the same way, though not in one group. */
#define ACROSS R(0.7)
/* The penetration left in place and what the solver leaves beyond it, as a multiple of the slop. */
#define INTERNAL_EDGE_SHARE R(1.25)

/* The buffers of manifolds, and the thickness that counts as thin. */
typedef struct {
  read_manifolds manifolds;
  point_planes planes;
  real thickness;
} manifold_list;

/* Whether all points of manifold i lie near the plane of manifold j. */
SHARED mask lies_in_plane_of(const manifold_list *list, uint i, uint j)
{
  vec3 normal = xyz(load_float4(list->manifolds.normal, j)), origin = xyz(load_float4(list->manifolds.points, j));
  for (uint k = 0u; k < list->manifolds.count[i]; ++k)
    if (magnitude(dot3(subtract(xyz(load_manifold_point(list->manifolds.points, list->planes, k, i)), origin),
                       normal)) > list->thickness)
      return 0;
  return 1;
}

SHARED mask presses(const manifold_list *list, uint j)
{
  for (uint k = 0u; k < list->manifolds.count[j]; ++k)
    if (load_manifold_point(list->manifolds.points, list->planes, k, j).w < list->thickness) return 1;
  return 0;
}

/* Whether manifold j explains manifold i. Of two that explain each other, the earlier one stays. */
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
  manifold_list list = {manifolds, planes_of(counts), slop * INTERNAL_EDGE_SHARE};
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
  store_manifold_if(1, single_contact(none, none, R(0.0), 0), planes_of(counts), manifolds, i);
}

#endif
