/* queries.h - how the questions of <tandem/queries.h> are answered.
 *
 * Boxes around the bodies as they stand, and the structure of the broadphase over them, are made for the first query
 * after a step; every query walks it (shared/queries/body_walk.h).
 */
#pragma once

#include <span>
#include <vector>

#include <tandem/queries.h>
#include <tandem/scene.h>

#include "host/pipeline/step_launches.h"

namespace tandem {

/* InputError with the index of the first query that is not finite, has no direction, or a negative reach or extent. */
void check_rays(std::span<const Ray> rays);
void check_boxes(std::span<const QueryBox> boxes);
/* Also for half-spaces, which cannot be swept, for shapes that no scene could hold, and for lists of two lengths. */
void check_shape_casts(const Shape &shape, std::span<const Pose> poses, std::span<const Vec3> displacements);

/* The launches that make a structure, QUERY_ of shared/body_codes.h. */
void launch_query_structure(StepLaunches &step, uint32_t structure);

/* Where the questions go. structure: the one that was made; order: body order[i] of the scene stands at i in the body
 * buffers. */
struct QueryTarget {
  Memory &memory;
  Launcher &launcher;
  const Scene &scene;
  const std::vector<uint32_t> &order;
  uint32_t structure;
};

std::vector<RayHit> cast_rays(const QueryTarget &target, std::span<const Ray> rays);
std::vector<bool> cast_rays_any(const QueryTarget &target, std::span<const Ray> rays);
std::vector<std::vector<RayHit>> cast_rays_all(const QueryTarget &target, std::span<const Ray> rays);
std::vector<std::vector<BoxHit>> cast_boxes(const QueryTarget &target, std::span<const QueryBox> boxes);
std::vector<ShapeCastHit> cast_shapes(const QueryTarget &target, const Shape &shape, std::span<const Pose> poses,
                                      std::span<const Vec3> displacements, const QueryFilter &filter);

} // namespace tandem
