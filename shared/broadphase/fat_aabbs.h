/* fat_aabbs.h - fat AABBs, inserted in a dynamic and a static tree: the dynamic AABB trees of CPU engines, in parallel.
 *
 * They follow Presson's tree in Bullet (btDbvt, 2008) and Catto, "Dynamic bounding volume hierarchies" (GDC 2019).
 *
 *        +------------------+   A body keeps its fat box, its pairs with other fat boxes and its place in the tree for
 *        | +----+           |   as long as its bounds stay inside. A body that leaves gets a new fat box, with a
 *        | |  o - - - >     |   margin on all sides and a part of its displacement ahead, and searches for pairs again.
 *        | +----+           |   Few bodies do so in most steps.
 *        +------------------+
 *
 * Fixed bodies, and bodies that have not left their boxes for RESTING_STEPS, are in the static tree: their codes sort
 * behind those of all others, so that the root's children are the two trees. A body that leaves searches both in one
 * traversal. The boxes above a leaf are rebuilt if a leaf of the same tile of the list changed, which is rare in the
 * static tree. Bodies change trees, and the order is rebuilt, as soon as one leaf in sixteen no longer overlaps the box
 * that it was inserted with (hierarchy.h).
 */
#ifndef TANDEM_SHARED_BROADPHASE_FAT_AABBS_H
#define TANDEM_SHARED_BROADPHASE_FAT_AABBS_H

#include "shared/broadphase/hierarchy.h"

#define RESTING_STEPS 32u
#define STATIC_TREE (1u << CURVE_BITS)

/* The margin beyond the bounds on each side, as a share of a body's mean size. */
#define FAT_MARGIN R(0.03125)
/* The margin ahead is the displacement of FAT_STEPS to twice as many steps; the number differs between bodies, so that
 * they do not all leave together. It is limited by a share of the body's mean size, or of the cell of the hybrid's
 * grid, because a body that is small beside others may move far before it overlaps more of them. */
#define FAT_STEPS 8u
#define FAT_DISPLACEMENT R(0.25)
#define FAT_DISPLACEMENT_OF_CELL R(0.125)

SHARED mask box_inside(box_bounds inner_box, box_bounds outer_box)
{
  return outer_box.lower.x <= inner_box.lower.x && inner_box.upper.x <= outer_box.upper.x &&
         outer_box.lower.y <= inner_box.lower.y && inner_box.upper.y <= outer_box.upper.y &&
         outer_box.lower.z <= inner_box.lower.z && inner_box.upper.z <= outer_box.upper.z;
}

SHARED real fat_steps(uint body) { return to_real(FAT_STEPS + (body * 2654435761u >> 16) % FAT_STEPS); }

/* ahead: the displacement to include. cell: of the hybrid's grid, m. */
SHARED box_bounds fattened(box_bounds box, vec3 ahead, real cell)
{
  vec3 extent = subtract(box.upper, box.lower), none = make_vec3(R(0.0), R(0.0), R(0.0));
  real size = (extent.x + extent.y + extent.z) * R(0.33333334), margin = FAT_MARGIN * size,
       most = maximum(FAT_DISPLACEMENT * size, FAT_DISPLACEMENT_OF_CELL * cell);
  vec3 margins = make_vec3(margin, margin, margin),
       displacement =
           make_vec3(clamped(ahead.x, -most, most), clamped(ahead.y, -most, most), clamped(ahead.z, -most, most));
  box_bounds fat = {add(subtract(box.lower, margins), lower_of(displacement, none)),
                    add(add(box.upper, margins), upper_of(displacement, none))};
  return fat;
}

SHARED void update_fat_aabbs_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *bounds,
                                  GLOBAL const float4 *body_velocity, GLOBAL float4 *fat_bounds, GLOBAL uint *body_rest,
                                  GLOBAL uint *body_left, GLOBAL uint *counts, uint i)
{
  box_bounds box = load_bounds(bounds, i);
  if (counts[COUNT_KEPT] != 0u && box_inside(box, load_bounds(fat_bounds, i))) {
    uint rest = body_rest[i];
    body_left[i] = 0u;
    body_rest[i] = rest < RESTING_STEPS ? rest + 1u : rest;
    return;
  }
  vec3 ahead = scale(xyz(load_float4(body_velocity, 2u * i)), parameters->step * fat_steps(i));
  box_bounds fat = fattened(box, ahead, parameters->hybrid_cell);
  store_float4(fat_bounds, 2u * i, extend(fat.lower, R(0.0)));
  store_float4(fat_bounds, 2u * i + 1u, extend(fat.upper, R(0.0)));
  body_left[i] = 1u;
  body_rest[i] = 0u;
  ATOMIC_OR(&counts[COUNT_LEFT], i < counts[COUNT_LARGE] ? 3u : 1u);
}

/* Sets the ranges of the kernels that follow: nothing if no body left its box. A query between steps rebuilds the order
 * of the trees for its own use; the trees are then rebuilt. */
SHARED void plan_trees_item(GLOBAL uint *counts, uint i)
{
  (void)i;
  uint left = counts[COUNT_LEFT];
  counts[COUNT_CHANGED] = left != 0u ? counts[COUNT_BODIES] : 0u;
  counts[COUNT_RAISED] = left != 0u || counts[COUNT_HIERARCHY_KEPT] == 0u ? counts[COUNT_BOUNDED] : 0u;
  counts[COUNT_LARGE_LEFT] = left > 1u ? counts[COUNT_LARGE] : 0u;
  counts[COUNT_LEFT] = 0u;
}

/* Leaf i, if the order of the last step may still hold: writes its box in the pyramid, and marks the tile that
 * changed. */
SHARED void refit_leaves_item(GLOBAL const float4 *fat_bounds, GLOBAL const uint *body_left,
                              GLOBAL const uint *leaf_body, GLOBAL const float4 *inserted_bounds,
                              GLOBAL uint *tile_changed, GLOBAL float4 *box_pyramid, GLOBAL uint *counts, uint i)
{
  if (counts[COUNT_HIERARCHY_KEPT] == 0u) return;
  uint body = leaf_body[i];
  box_bounds fat = load_bounds(fat_bounds, body);
  if (!bounds_overlap(fat, load_bounds(inserted_bounds, i))) ATOMIC_ADD(&counts[COUNT_ESCAPED], 1u);
  if (body_left[body] == 0u) return;
  ATOMIC_OR(&tile_changed[i / TILE], 1u);
  store_leaf(box_pyramid, counts[COUNT_LEAVES] + i, fat, body);
}

SHARED void tree_keys_item(GLOBAL const uint *body_flags, GLOBAL const float4 *fat_bounds, GLOBAL const uint *body_rest,
                           GLOBAL const float4 *grid, GLOBAL const uint *counts, GLOBAL uint *sort_key,
                           GLOBAL uint *sort_value, uint i)
{
  uint body = counts[COUNT_UNBOUNDED] + i;
  mask stands = body_type_of(body_flags[body]) == (uint)BODY_TYPE_FIXED || body_rest[body] == RESTING_STEPS;
  sort_key[i] = curve_key(grid, load_bounds(fat_bounds, body)) | (stands ? STATIC_TREE : 0u);
  sort_value[i] = body;
}

#endif
