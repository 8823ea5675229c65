/* queries.cpp - checks, packs and unpacks batches of queries; see queries.h. */
#include "host/world/queries.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/base/finite_vector.h"
#include "host/geometry/convex_hull.h"
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/primitives.h"
#include "host/pipeline/scene_counts.h"
#include "host/scene/body_buffers.h"
#include "host/scene/hull_chunks.h"
#include "host/scene/shape_bounds.h"
#include "shared/platform.h"

namespace tandem {
namespace {

[[noreturn]] void refuse(const char *what, size_t index, const std::string &why)
{
  throw InputError(fmt::format("{} {}: {}", what, index, why));
}

double length(const Vec3 &v) { return std::sqrt(double{v[0]} * v[0] + double{v[1]} * v[1] + double{v[2]} * v[2]); }

/* The kernels square lengths in float, which limits their range. */
constexpr double shortest = 1e-15, longest = 1e15;

template <class T> void upload(Memory &memory, Buffer buffer, const std::vector<T> &values)
{
  memory.resize(buffer, values.size() * sizeof(T));
  memory.upload(buffer, values.data(), values.size() * sizeof(T));
}

/* Kernels index the float4s of queries, two for a start, with 32 bits. */
constexpr size_t most_queries = size_t{1} << 31;

void check_number(size_t queries)
{
  if (queries > most_queries)
    throw InputError(fmt::format("{} queries in one batch; at most {} are possible", queries, most_queries));
}

void reserve_hits(Memory &memory, size_t hits)
{
  for (const Buffer buffer : {Buffer::query_hit, Buffer::query_point}) memory.resize(buffer, hits * sizeof(float4));
  memory.resize(Buffer::query_hit_body, hits * sizeof(uint32_t));
}

/* Launches a kernel over all queries; the structure is the last of its values. */
void launch(const QueryTarget &target, Kernel kernel, size_t queries, std::vector<uint32_t> values = {})
{
  values.push_back(target.structure);
  target.launcher.launch({kernel, {}, values, COUNT_ZERO, COUNT_LENGTH, static_cast<uint32_t>(queries)});
}

QueryHit hit_of(uint32_t body, const float4 &hit, const float4 &point, const Point &from)
{
  return {body,
          hit.w,
          {from[0] + double{point.x}, from[1] + double{point.y}, from[2] + double{point.z}},
          {hit.x, hit.y, hit.z}};
}

template <class Start> std::vector<QueryHit> take_hits(Memory &memory, size_t queries, Start &&start)
{
  const auto hits = memory.read<float4>(Buffer::query_hit, queries),
             points = memory.read<float4>(Buffer::query_point, queries);
  const auto bodies = memory.read<uint32_t>(Buffer::query_hit_body, queries);
  std::vector<QueryHit> found(queries);
  for (size_t i = 0; i < queries; ++i)
    if (bodies[i] != no_body) found[i] = hit_of(bodies[i], hits[i], points[i], start(i));
  return found;
}

/* Counts the hits of each query, scans the counts and writes the hits. Returns where the hits of each query start, and
 * the end of the last. */
std::vector<uint32_t> find_all(const QueryTarget &target, Kernel count, Kernel write, size_t queries,
                               const std::vector<uint32_t> &values = {})
{
  Memory &memory = target.memory;
  const auto capacity = static_cast<uint32_t>(queries);
  memory.resize(Buffer::query_found, (queries + 1) * sizeof(uint32_t));
  memory.resize(Buffer::scan_sums,
                std::max(memory.bytes(Buffer::scan_sums), scan_sum_words(queries + 1) * sizeof(uint32_t)));
  launch(target, count, queries, values);
  exclusive_scan(target.launcher, Buffer::query_found, Buffer::query_found, Buffer::scan_sums, COUNT_LENGTH, capacity);
  const std::vector<uint32_t> starts = memory.read<uint32_t>(Buffer::query_found, queries + 1);
  if (starts.back() == UINT32_MAX) /* the scan saturates */
    throw InputError(fmt::format("{} queries have {} hits or more; smaller batches are needed", queries, UINT32_MAX));
  reserve_hits(memory, std::max(starts.back(), 1u));
  launch(target, write, queries, values);
  return starts;
}

/* Orders hits by their fraction along the query, then by body. */
template <class Hit> bool comes_before(const Hit &a, const Hit &b)
{
  return a.fraction != b.fraction ? a.fraction < b.fraction : a.body < b.body;
}

void upload_rays(const QueryTarget &target, std::span<const Ray> rays)
{
  std::vector<float4> starts, paths;
  std::vector<uint32_t> filters;
  for (const Ray &ray : rays) {
    const std::array<float4, 2> place = double_float3_of(ray.origin);
    starts.insert(starts.end(), place.begin(), place.end());
    paths.push_back({ray.direction[0], ray.direction[1], ray.direction[2], ray.reach});
    filters.insert(filters.end(), {ray.filter.group, ray.filter.mask});
  }
  upload(target.memory, Buffer::query_filter, filters);
  upload(target.memory, Buffer::query_start, starts);
  upload(target.memory, Buffer::query_displacement, paths);
  set_length(target.memory, static_cast<uint32_t>(rays.size()));
}

void upload_boxes(const QueryTarget &target, std::span<const QueryBox> boxes)
{
  std::vector<float4> starts, paths, extents;
  std::vector<uint32_t> filters;
  for (const QueryBox &box : boxes) {
    const std::array<float4, 2> place = double_float3_of(box.center);
    const Vec3 &displacement = box.displacement, &half = box.half_extents;
    starts.insert(starts.end(), place.begin(), place.end());
    paths.push_back({displacement[0], displacement[1], displacement[2], 1});
    extents.push_back({half[0], half[1], half[2], 0});
    filters.insert(filters.end(), {box.filter.group, box.filter.mask});
  }
  upload(target.memory, Buffer::query_filter, filters);
  upload(target.memory, Buffer::query_start, starts);
  upload(target.memory, Buffer::query_displacement, paths);
  upload(target.memory, Buffer::query_extent, extents);
  set_length(target.memory, static_cast<uint32_t>(boxes.size()));
}

/* The radius of a shape that is centred in its body. */
float radius_of(const Shape &shape)
{
  Scene scene;
  scene.shapes = {shape};
  scene.bodies.resize(1);
  return bounding_radius(scene, scene.bodies[0]);
}

/* A query refuses the shapes that a scene would refuse for a body that need not have a mass. */
void check_convex(const Shape &shape, const char *query, const char *done)
{
  const ShapeType type = shape.type;
  if (type == ShapeType::half_space || type == ShapeType::mesh || type == ShapeType::compound)
    throw InputError(fmt::format("{}: half_spaces, meshes and compounds cannot be {}; a box, sphere, capsule, cylinder "
                                 "or hull can",
                                 query, done));
  Scene scene;
  scene.shapes = {shape};
  validate(scene, query);
}

void check_pose(const Pose &pose, const char *query, size_t index)
{
  if (!is_finite_vector(pose.position))
    refuse(query, index, fmt::format("position is {}; three finite numbers are needed", vector_text(pose.position)));
  const Quat &q = pose.orientation;
  const double square = double{q[0]} * q[0] + double{q[1]} * q[1] + double{q[2]} * q[2] + double{q[3]} * q[3];
  if (!(std::abs(square - 1) < 2e-3))
    refuse(query, index,
           fmt::format("orientation is [{}, {}, {}, {}]; a quaternion of length 1 is needed", q[0], q[1], q[2], q[3]));
}

/* Uploads a convex shape with its poses and displacements; without displacements they are 0. Returns the number of
 * vertices that a hull has. */
uint32_t upload_shape_queries(const QueryTarget &target, const Shape &shape, std::span<const Pose> poses,
                              std::span<const Vec3> displacements, const QueryFilter &filter)
{
  Memory &memory = target.memory;
  std::vector<float4> starts, turns, paths(poses.size(), float4{0, 0, 0, 1}), vertices{{0, 0, 0, 0}}, chunks;
  std::vector<uint32_t> filters;
  for (const Pose &pose : poses) {
    const std::array<float4, 2> place = double_float3_of(pose.position);
    const Quat q = unit(pose.orientation);
    starts.insert(starts.end(), place.begin(), place.end());
    turns.push_back({q[0], q[1], q[2], q[3]});
    filters.insert(filters.end(), {filter.group, filter.mask});
  }
  for (size_t i = 0; i < displacements.size(); ++i)
    paths[i] = {displacements[i][0], displacements[i][1], displacements[i][2], 1};
  if (shape.hull) {
    vertices.clear();
    for (const Vec3 &v : shape.hull->vertices) vertices.push_back({v[0], v[1], v[2], 0});
  }
  append_chunks(chunks, vertices, 3);
  const Vec3 size = kernel_size(shape);
  upload(memory, Buffer::query_filter, filters);
  upload(memory, Buffer::query_start, starts);
  upload(memory, Buffer::query_turn, turns);
  upload(memory, Buffer::query_displacement, paths);
  upload(memory, Buffer::query_shape, std::vector<float4>{{size[0], size[1], size[2], radius_of(shape)}});
  upload(memory, Buffer::query_vertex, vertices);
  upload(memory, Buffer::query_chunk, chunks);
  set_length(memory, static_cast<uint32_t>(poses.size()));
  return static_cast<uint32_t>(vertices.size());
}

} // namespace

void check_rays(std::span<const Ray> rays)
{
  check_number(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    const Ray &ray = rays[i];
    if (!is_finite_vector(ray.origin))
      refuse("ray", i, fmt::format("origin is {}; three finite numbers are needed", vector_text(ray.origin)));
    if (!is_finite_vector(ray.direction) || !(length(ray.direction) >= shortest && length(ray.direction) <= longest))
      refuse("ray", i,
             fmt::format("direction is {}; a vector of a length from {} to {} is needed", vector_text(ray.direction),
                         shortest, longest));
    if (!(ray.reach >= 0)) refuse("ray", i, fmt::format("reach is {}; a number of at least 0 is needed", ray.reach));
  }
}

void check_boxes(std::span<const QueryBox> boxes)
{
  check_number(boxes.size());
  for (size_t i = 0; i < boxes.size(); ++i) {
    const QueryBox &box = boxes[i];
    if (!is_finite_vector(box.center))
      refuse("box", i, fmt::format("center is {}; three finite numbers are needed", vector_text(box.center)));
    const bool negative = box.half_extents[0] < 0 || box.half_extents[1] < 0 || box.half_extents[2] < 0;
    if (!is_finite_vector(box.half_extents) || negative)
      refuse("box", i,
             fmt::format("half extents are {}; three finite numbers of at least 0 are needed",
                         vector_text(box.half_extents)));
    if (!is_finite_vector(box.displacement) || length(box.displacement) > longest)
      refuse(
          "box", i,
          fmt::format("displacement is {}; a vector of at most {} is needed", vector_text(box.displacement), longest));
  }
}

void check_shape_casts(const Shape &shape, std::span<const Pose> poses, std::span<const Vec3> displacements)
{
  check_convex(shape, "shape cast", "cast");
  check_number(poses.size());
  if (poses.size() != displacements.size())
    throw InputError(fmt::format("shape cast: {} poses and {} displacements; one of each is needed", poses.size(),
                                 displacements.size()));
  for (size_t i = 0; i < poses.size(); ++i) {
    check_pose(poses[i], "shape cast", i);
    if (!is_finite_vector(displacements[i]) || length(displacements[i]) > longest)
      refuse(
          "shape cast", i,
          fmt::format("displacement is {}; a vector of at most {} is needed", vector_text(displacements[i]), longest));
  }
}

void check_overlaps(const Shape &shape, std::span<const Pose> poses)
{
  check_convex(shape, "overlap test", "tested for overlap");
  check_number(poses.size());
  for (size_t i = 0; i < poses.size(); ++i) check_pose(poses[i], "overlap test", i);
}

void tell_queried_bodies(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order,
                         std::vector<uint32_t> &told)
{
  std::vector<uint32_t> bodies;
  bodies.reserve(4 * order.size());
  for (const uint32_t body : order)
    bodies.insert(bodies.end(), {body, scene.bodies[body].filter_group, scene.bodies[body].filter_mask, 0u});
  if (bodies == told && memory.bytes(Buffer::query_body) == bodies.size() * sizeof(uint32_t)) return;
  told.clear(); /* an upload that fails leaves the buffer unknown */
  upload(memory, Buffer::query_body, bodies);
  told = std::move(bodies);
}

void launch_query_structure(StepLaunches &step, uint32_t structure)
{
  step.run(Kernel::compute_query_bounds);
  if (structure == QUERY_HIERARCHY) build_hierarchy(step, false);
  if (structure == QUERY_GRID) sort_into_cells(step);
}

void cast_rays_on_device(const QueryTarget &target, std::span<const Ray> rays)
{
  if (rays.empty()) return reserve_hits(target.memory, 0); /* those of an earlier cast end */
  upload_rays(target, rays);
  reserve_hits(target.memory, rays.size());
  launch(target, Kernel::cast_rays, rays.size());
}

std::vector<RayHit> cast_rays(const QueryTarget &target, std::span<const Ray> rays)
{
  cast_rays_on_device(target, rays);
  return take_hits(target.memory, rays.size(), [&](size_t i) -> const Point & { return rays[i].origin; });
}

std::vector<bool> cast_rays_any(const QueryTarget &target, std::span<const Ray> rays)
{
  if (rays.empty()) return {};
  upload_rays(target, rays);
  target.memory.resize(Buffer::query_found, rays.size() * sizeof(uint32_t));
  launch(target, Kernel::cast_rays_any, rays.size());
  const auto found = target.memory.read<uint32_t>(Buffer::query_found, rays.size());
  return {found.begin(), found.end()};
}

std::vector<std::vector<RayHit>> cast_rays_all(const QueryTarget &target, std::span<const Ray> rays)
{
  if (rays.empty()) return {};
  upload_rays(target, rays);
  const std::vector<uint32_t> starts = find_all(target, Kernel::count_ray_hits, Kernel::write_ray_hits, rays.size());
  const auto hits = target.memory.read<float4>(Buffer::query_hit, starts.back()),
             points = target.memory.read<float4>(Buffer::query_point, starts.back());
  const auto bodies = target.memory.read<uint32_t>(Buffer::query_hit_body, starts.back());
  std::vector<std::vector<RayHit>> found(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    for (uint32_t at = starts[i]; at < starts[i + 1]; ++at)
      found[i].push_back(hit_of(bodies[at], hits[at], points[at], rays[i].origin));
    std::sort(found[i].begin(), found[i].end(), comes_before<RayHit>);
  }
  return found;
}

std::vector<std::vector<BoxHit>> cast_boxes(const QueryTarget &target, std::span<const QueryBox> boxes)
{
  if (boxes.empty()) return {};
  upload_boxes(target, boxes);
  const std::vector<uint32_t> starts = find_all(target, Kernel::count_box_hits, Kernel::write_box_hits, boxes.size());
  const auto hits = target.memory.read<float4>(Buffer::query_hit, starts.back());
  const auto bodies = target.memory.read<uint32_t>(Buffer::query_hit_body, starts.back());
  std::vector<std::vector<BoxHit>> found(boxes.size());
  for (size_t i = 0; i < boxes.size(); ++i) {
    for (uint32_t at = starts[i]; at < starts[i + 1]; ++at) found[i].push_back({bodies[at], hits[at].w});
    std::sort(found[i].begin(), found[i].end(), comes_before<BoxHit>);
  }
  return found;
}

void cast_shapes_on_device(const QueryTarget &target, const Shape &shape, std::span<const Pose> poses,
                           std::span<const Vec3> displacements, const QueryFilter &filter)
{
  if (poses.empty()) return reserve_hits(target.memory, 0);
  const uint32_t vertices = upload_shape_queries(target, shape, poses, displacements, filter);
  reserve_hits(target.memory, poses.size());
  launch(target, Kernel::cast_shapes, poses.size(), {static_cast<uint32_t>(shape.type), vertices});
}

std::vector<ShapeCastHit> cast_shapes(const QueryTarget &target, const Shape &shape, std::span<const Pose> poses,
                                      std::span<const Vec3> displacements, const QueryFilter &filter)
{
  cast_shapes_on_device(target, shape, poses, displacements, filter);
  return take_hits(target.memory, poses.size(), [&](size_t i) -> const Point & { return poses[i].position; });
}

std::vector<std::vector<uint32_t>> overlap_shapes(const QueryTarget &target, const Shape &shape,
                                                  std::span<const Pose> poses, const QueryFilter &filter)
{
  if (poses.empty()) return {};
  const uint32_t vertices = upload_shape_queries(target, shape, poses, {}, filter);
  const uint32_t kind = static_cast<uint32_t>(shape.type) | vertices << SHAPE_KIND_BITS;
  const std::vector<uint32_t> starts =
      find_all(target, Kernel::count_shape_overlaps, Kernel::write_shape_overlaps, poses.size(), {kind});
  const auto bodies = target.memory.read<uint32_t>(Buffer::query_hit_body, starts.back());
  std::vector<std::vector<uint32_t>> found(poses.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    found[i].assign(bodies.begin() + starts[i], bodies.begin() + starts[i + 1]);
    std::sort(found[i].begin(), found[i].end());
  }
  return found;
}

} // namespace tandem
