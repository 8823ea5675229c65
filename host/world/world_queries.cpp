/* world_queries.cpp - the functions of <tandem/world.h> that ask where things are: rays, boxes, shape casts, overlaps
 * and closest points. */
#include <tandem/world.h>

#include "host/runtime/interface/floating_point.h"
#include "host/world/answers.h"
#include "host/world/closest_points.h"
#include "host/world/implementation.h"

namespace tandem {

std::vector<RayHit> World::cast_rays(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries",
                        [&] { return tandem::cast_rays(implementation_->query_target(), rays); });
}

std::vector<bool> World::cast_rays_any(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries",
                        [&] { return tandem::cast_rays_any(implementation_->query_target(), rays); });
}

std::vector<std::vector<RayHit>> World::cast_rays_all(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries",
                        [&] { return tandem::cast_rays_all(implementation_->query_target(), rays); });
}

std::vector<std::vector<BoxHit>> World::cast_boxes(std::span<const QueryBox> boxes)
{
  check_boxes(boxes);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries",
                        [&] { return tandem::cast_boxes(implementation_->query_target(), boxes); });
}

std::vector<ShapeCastHit> World::cast_shapes(const Shape &shape, std::span<const Pose> poses,
                                             std::span<const Vec3> displacements, const QueryFilter &filter)
{
  check_shape_casts(shape, poses, displacements);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries", [&] {
    return tandem::cast_shapes(implementation_->query_target(), shape, poses, displacements, filter);
  });
}

std::vector<std::vector<uint32_t>> World::overlap_shapes(const Shape &shape, std::span<const Pose> poses,
                                                         const QueryFilter &filter)
{
  check_overlaps(shape, poses);
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "queries",
                        [&] { return tandem::overlap_shapes(implementation_->query_target(), shape, poses, filter); });
}

std::vector<ClosestPoints> World::closest_points(std::span<const std::pair<BodyId, BodyId>> pairs)
{
  const minicl::ExactFloatingPoint environment;
  return answer_in_turn(*implementation_, "closest points", [&] {
    check_closest_points(implementation_->scene, implementation_->slots, pairs);
    implementation_->settle();
    return tandem::closest_points(implementation_->memory, implementation_->launcher, pairs,
                                  implementation_->index_of_body);
  });
}

void World::cast_rays_on_device(std::span<const Ray> rays)
{
  check_rays(rays);
  const minicl::ExactFloatingPoint environment;
  answer_in_turn(*implementation_, "queries", [&] {
    tandem::cast_rays_on_device(implementation_->target_for_kernels(), rays);
    implementation_->plan.hits = static_cast<uint32_t>(rays.size());
    note(implementation_->log, RecordedCall::cast_rays_on_device, rays);
  });
}

void World::cast_shapes_on_device(const Shape &shape, std::span<const Pose> poses, std::span<const Vec3> displacements,
                                  const QueryFilter &filter)
{
  check_shape_casts(shape, poses, displacements);
  const minicl::ExactFloatingPoint environment;
  answer_in_turn(*implementation_, "queries", [&] {
    tandem::cast_shapes_on_device(implementation_->target_for_kernels(), shape, poses, displacements, filter);
    implementation_->plan.hits = static_cast<uint32_t>(poses.size());
    note(implementation_->log, RecordedCall::cast_shapes_on_device, shape, poses, displacements, filter);
  });
}

} // namespace tandem
