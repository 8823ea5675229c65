/* queries.h - how the queries of <tandem/queries.h> are answered.
 *
 * The AABBs of the bodies at their present poses, and the structure of the broadphase over them, are made for the first
 * query after a change of the state; every query traverses it (shared/queries/body_walk.h). The filters of the bodies
 * stay where they are until they change. A batch uploads no more than its queries.
 */
#pragma once

#include <span>
#include <vector>

#include <tandem/queries.h>
#include <tandem/scene.h>

#include "host/pipeline/step_launches.h"

namespace tandem {

/* Throws InputError with the index of the first query that is not finite, has no direction, or has a negative reach or
 * extent. */
void check_rays(std::span<const Ray> rays);
void check_boxes(std::span<const QueryBox> boxes);
/* Throws InputError also for half-spaces, which cannot be cast, for shapes that no scene could contain, and for lists
 * of different lengths. */
void check_shape_casts(const Shape &shape, std::span<const Pose> poses, std::span<const Vec3> displacements);
void check_overlaps(const Shape &shape, std::span<const Pose> poses);

/* Uploads the indices and filters of the bodies, unless they are the ones that were uploaded last, which `told` keeps.
 * order: body order[i] of the scene is at index i of the body buffers. */
void tell_queried_bodies(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order,
                         std::vector<uint32_t> &told);

/* Launches the kernels that make a structure, QUERY_ of shared/body_codes.h. */
void launch_query_structure(StepLaunches &step, uint32_t structure);

/* The world that answers the queries, which tell_queried_bodies has been called for. structure: the one that was
 * made. */
struct QueryTarget {
  Memory &memory;
  Launcher &launcher;
  uint32_t structure;
};

std::vector<RayHit> cast_rays(const QueryTarget &target, std::span<const Ray> rays);
/* Without reading the hits, which stay in their buffers. */
void cast_rays_on_device(const QueryTarget &target, std::span<const Ray> rays);
void cast_shapes_on_device(const QueryTarget &target, const Shape &shape, std::span<const Pose> poses,
                           std::span<const Vec3> displacements, const QueryFilter &filter);
std::vector<bool> cast_rays_any(const QueryTarget &target, std::span<const Ray> rays);
std::vector<std::vector<RayHit>> cast_rays_all(const QueryTarget &target, std::span<const Ray> rays);
std::vector<std::vector<BoxHit>> cast_boxes(const QueryTarget &target, std::span<const QueryBox> boxes);
std::vector<ShapeCastHit> cast_shapes(const QueryTarget &target, const Shape &shape, std::span<const Pose> poses,
                                      std::span<const Vec3> displacements, const QueryFilter &filter);
std::vector<std::vector<uint32_t>> overlap_shapes(const QueryTarget &target, const Shape &shape,
                                                  std::span<const Pose> poses, const QueryFilter &filter);

} // namespace tandem
