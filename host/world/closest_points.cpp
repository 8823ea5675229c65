/* closest_points.cpp - see closest_points.h. */
#include "host/world/closest_points.h"

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/pipeline/scene_counts.h"
#include "shared/platform.h"

namespace tandem {
namespace {

/* Points of a pair are four float4s, which kernels index with 32 bits. */
constexpr size_t most_body_pairs = size_t{1} << 30;

void check_body_pair(const Scene &scene, const BodySlots &slots, const BodyPair &pair, const std::string &entry)
{
  const auto is_half_space = [&](const BodyId &id) {
    return scene.shapes[scene.bodies[id.index].shape].type == ShapeType::half_space;
  };
  for (const BodyId &id : {pair.first, pair.second})
    if (slots.status()[slots.slot_of(entry.c_str(), id)] == BodyStatus::quarantined)
      throw InputError(fmt::format("{}: body {} is in quarantine and has no place", entry, id.index));
  if (pair.first == pair.second)
    throw InputError(fmt::format("{}: body {} with itself; two bodies are needed", entry, pair.first.index));
  if (is_half_space(pair.first) && is_half_space(pair.second))
    throw InputError(
        fmt::format("{}: bodies {} and {} are half-spaces, which have no closest points; one of them may be one", entry,
                    pair.first.index, pair.second.index));
}

/* The answer must not depend on which body comes first, so kernels get the body of the lower index first. */
bool comes_in_order(const BodyPair &pair) { return pair.first.index < pair.second.index; }

Point from_center(const float4 &offset, const float4 &high, const float4 &low)
{
  return {double{offset.x} + double{low.x} + double{high.x}, double{offset.y} + double{low.y} + double{high.y},
          double{offset.z} + double{low.z} + double{high.z}};
}

/* normal: and the distance. points: the two points, and the centre from which they are seen. */
ClosestPoints points_of_pair(const float4 &normal, const float4 *points, bool in_order)
{
  ClosestPoints found;
  found.distance = normal.w;
  if (!(normal.w > 0)) return found;
  const float sign = in_order ? 1.0f : -1.0f;
  found.normal = {sign * normal.x, sign * normal.y, sign * normal.z};
  found.on_first = from_center(points[in_order ? 0 : 1], points[2], points[3]);
  found.on_second = from_center(points[in_order ? 1 : 0], points[2], points[3]);
  return found;
}

} // namespace

void check_closest_points(const Scene &scene, const BodySlots &slots, std::span<const BodyPair> pairs)
{
  if (pairs.size() > most_body_pairs)
    throw InputError(
        fmt::format("closest_points: {} pairs in one batch; at most {} are possible", pairs.size(), most_body_pairs));
  for (size_t i = 0; i < pairs.size(); ++i)
    check_body_pair(scene, slots, pairs[i], fmt::format("closest_points: entry {}", i));
}

std::vector<ClosestPoints> closest_points(Memory &memory, Launcher &launcher, std::span<const BodyPair> pairs,
                                          const std::vector<uint32_t> &index_of_body)
{
  if (pairs.empty()) return {};
  std::vector<uint32_t> indices;
  for (const BodyPair &pair : pairs) {
    const bool in_order = comes_in_order(pair);
    indices.push_back(index_of_body[(in_order ? pair.first : pair.second).index]);
    indices.push_back(index_of_body[(in_order ? pair.second : pair.first).index]);
  }
  memory.resize(Buffer::query_pair, indices.size() * sizeof(uint32_t));
  memory.upload(Buffer::query_pair, indices.data(), indices.size() * sizeof(uint32_t));
  memory.resize(Buffer::closest_normal, pairs.size() * sizeof(float4));
  memory.resize(Buffer::closest_point, 4 * pairs.size() * sizeof(float4));
  set_length(memory, static_cast<uint32_t>(pairs.size()));
  launcher.launch({Kernel::find_closest_points, {}, {}, COUNT_ZERO, COUNT_LENGTH, static_cast<uint32_t>(pairs.size())});
  const auto normals = memory.read<float4>(Buffer::closest_normal, pairs.size()),
             points = memory.read<float4>(Buffer::closest_point, 4 * pairs.size());
  std::vector<ClosestPoints> found;
  found.reserve(pairs.size());
  for (size_t i = 0; i < pairs.size(); ++i)
    found.push_back(points_of_pair(normals[i], &points[4 * i], comes_in_order(pairs[i])));
  return found;
}

} // namespace tandem
