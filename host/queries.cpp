/* queries.cpp - checks, packs and unpacks batches of queries; see queries.h. */
#include "host/queries.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host/body_buffers.h"
#include "host/geometry/convex_hull.h"
#include "host/hull_strips.h"
#include "host/shape_bounds.h"
#include "shared/platform.h"

namespace tandem {
namespace {

[[noreturn]] void refuse(const char *what, size_t index, const std::string &why) { throw InputError(fmt::format("{} {}: {}", what, index, why)); }

template <class Vector> bool finite(const Vector &v)
{
  return std::all_of(v.begin(), v.end(), [](auto x) { return std::isfinite(static_cast<float>(x)); });
}
template <class Vector> std::string text(const Vector &v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }
double length(const Vec3 &v) { return std::hypot(double{v[0]}, double{v[1]}, double{v[2]}); }

/* Squares of lengths are taken in float. */
constexpr double shortest = 1e-15, longest = 1e15;

template <class T> void upload(Memory &memory, Buffer buffer, const std::vector<T> &values)
{
  memory.resize(buffer, values.size() * sizeof(T));
  memory.upload(buffer, values.data(), values.size() * sizeof(T));
}

void upload_filters(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order, const std::vector<uint32_t> &filters)
{
  std::vector<uint32_t> bodies;
  for (const uint32_t body : order) bodies.insert(bodies.end(), {body, scene.bodies[body].filter_group, scene.bodies[body].filter_mask, 0u});
  upload(memory, Buffer::query_body, bodies);
  upload(memory, Buffer::query_filter, filters);
}

/* Room for what comes back, and how many there are. */
void make_room(Memory &memory, size_t queries)
{
  const auto count = static_cast<uint32_t>(queries);
  memory.upload(Buffer::counts, &count, sizeof count, COUNT_LENGTH * sizeof count);
  for (const Buffer buffer : {Buffer::query_hit, Buffer::query_point}) memory.resize(buffer, queries * sizeof(row));
  memory.resize(Buffer::query_hit_body, queries * sizeof(uint32_t));
}

template <class Start> std::vector<QueryHit> take_hits(Memory &memory, size_t queries, Start &&start)
{
  const auto hits = memory.read<row>(Buffer::query_hit, queries), points = memory.read<row>(Buffer::query_point, queries);
  const auto bodies = memory.read<uint32_t>(Buffer::query_hit_body, queries);
  std::vector<QueryHit> found(queries);
  for (size_t i = 0; i < queries; ++i) {
    if (bodies[i] == no_body) continue;
    const Point &from = start(i);
    found[i] = {bodies[i], hits[i].w, {from[0] + double{points[i].x}, from[1] + double{points[i].y}, from[2] + double{points[i].z}}, {hits[i].x, hits[i].y, hits[i].z}};
  }
  return found;
}

/* Of a shape in the middle of its body. */
float radius_of(const Shape &shape)
{
  Scene scene;
  scene.shapes = {shape};
  scene.bodies.resize(1);
  return bounding_radius(scene, scene.bodies[0]);
}

/* What a scene would refuse, a sweep refuses: as a body that need not have a mass. */
void check_swept_shape(const Shape &shape)
{
  if (shape.type == ShapeType::half_space || shape.type >= ShapeType::mesh)
    throw InputError("sweep: half_spaces, meshes and compounds cannot be swept; a box, sphere, capsule, cylinder or hull can");
  Scene scene;
  scene.shapes = {shape};
  validate(scene, "sweep");
}

} // namespace

void check_rays(std::span<const Ray> rays)
{
  for (size_t i = 0; i < rays.size(); ++i) {
    const Ray &ray = rays[i];
    if (!finite(ray.origin)) refuse("ray", i, fmt::format("origin is {}; three finite numbers are needed", text(ray.origin)));
    if (!finite(ray.direction) || !(length(ray.direction) >= shortest && length(ray.direction) <= longest))
      refuse("ray", i, fmt::format("direction is {}; a vector of a length from {} to {} is needed", text(ray.direction), shortest, longest));
    if (!(ray.reach >= 0)) refuse("ray", i, fmt::format("reach is {}; a number of at least 0 is needed", ray.reach));
  }
}

void check_sweep(const Shape &shape, std::span<const Pose> poses, std::span<const Vec3> displacements)
{
  check_swept_shape(shape);
  if (poses.size() != displacements.size())
    throw InputError(fmt::format("sweep: {} poses and {} displacements; one of each is needed", poses.size(), displacements.size()));
  for (size_t i = 0; i < poses.size(); ++i) {
    if (!finite(poses[i].position)) refuse("sweep", i, fmt::format("position is {}; three finite numbers are needed", text(poses[i].position)));
    if (!finite(displacements[i]) || length(displacements[i]) > longest)
      refuse("sweep", i, fmt::format("displacement is {}; a vector of at most {} is needed", text(displacements[i]), longest));
    const Quat &q = poses[i].orientation;
    const double square = double{q[0]} * q[0] + double{q[1]} * q[1] + double{q[2]} * q[2] + double{q[3]} * q[3];
    if (!(std::abs(square - 1) < 2e-3))
      refuse("sweep", i, fmt::format("orientation is [{}, {}, {}, {}]; a quaternion of length 1 is needed", q[0], q[1], q[2], q[3]));
  }
}

std::vector<RayHit> cast_rays(Memory &memory, Launcher &launcher, const Scene &scene, const std::vector<uint32_t> &order, std::span<const Ray> rays)
{
  if (rays.empty()) return {};
  std::vector<row> starts, ways;
  std::vector<uint32_t> filters;
  for (const Ray &ray : rays) {
    const std::array<row, 2> place = place_of(ray.origin);
    starts.insert(starts.end(), place.begin(), place.end());
    ways.push_back({ray.direction[0], ray.direction[1], ray.direction[2], ray.reach});
    filters.insert(filters.end(), {ray.filter.group, ray.filter.mask});
  }
  upload_filters(memory, scene, order, filters);
  upload(memory, Buffer::query_start, starts);
  upload(memory, Buffer::query_way, ways);
  make_room(memory, rays.size());
  launcher.launch({Kernel::cast_rays, {}, {}, COUNT_ZERO, COUNT_LENGTH, static_cast<uint32_t>(rays.size())});
  return take_hits(memory, rays.size(), [&](size_t i) -> const Point & { return rays[i].origin; });
}

std::vector<SweepHit> sweep(Memory &memory, Launcher &launcher, const Scene &scene, const std::vector<uint32_t> &order, const Shape &shape,
                            std::span<const Pose> poses, std::span<const Vec3> displacements, const QueryFilter &filter)
{
  if (poses.empty()) return {};
  std::vector<row> starts, turns, ways, vertices{{0, 0, 0, 0}}, strips;
  std::vector<uint32_t> filters;
  for (size_t i = 0; i < poses.size(); ++i) {
    const std::array<row, 2> place = place_of(poses[i].position);
    const Quat q = unit(poses[i].orientation);
    starts.insert(starts.end(), place.begin(), place.end());
    turns.push_back({q[0], q[1], q[2], q[3]});
    ways.push_back({displacements[i][0], displacements[i][1], displacements[i][2], 1});
    filters.insert(filters.end(), {filter.group, filter.mask});
  }
  if (shape.hull) {
    vertices.clear();
    for (const Vec3 &v : shape.hull->vertices) vertices.push_back({v[0], v[1], v[2], 0});
  }
  append_strips(strips, vertices, 3);
  const Vec3 size = kernel_size(shape);
  upload_filters(memory, scene, order, filters);
  upload(memory, Buffer::query_start, starts);
  upload(memory, Buffer::query_turn, turns);
  upload(memory, Buffer::query_way, ways);
  upload(memory, Buffer::query_shape, std::vector<row>{{size[0], size[1], size[2], radius_of(shape)}});
  upload(memory, Buffer::query_vertex, vertices);
  upload(memory, Buffer::query_strip, strips);
  make_room(memory, poses.size());
  launcher.launch({Kernel::sweep_shape, {}, {static_cast<uint32_t>(shape.type), static_cast<uint32_t>(vertices.size())}, COUNT_ZERO, COUNT_LENGTH,
                   static_cast<uint32_t>(poses.size())});
  return take_hits(memory, poses.size(), [&](size_t i) -> const Point & { return poses[i].position; });
}

} // namespace tandem
