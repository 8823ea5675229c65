/* hull_buffers.cpp - counts and packs the distinct hulls of a scene; see hull_buffers.h. */
#include "host/scene/hull_buffers.h"

#include <algorithm>

#include <tandem/round_to_float.h>

#include "host/geometry/convex_hull.h"
#include "host/scene/hull_chunks.h"
#include "shared/platform.h"

namespace tandem {
namespace {

void add_hull(std::vector<const ConvexHull *> &hulls, const Shape &shape)
{
  if (shape.hull && std::find(hulls.begin(), hulls.end(), shape.hull.get()) == hulls.end())
    hulls.push_back(shape.hull.get());
  if (!shape.compound) return;
  for (const Child &child : shape.compound->children) add_hull(hulls, child.shape);
}

/* Hulls in the order of the first shape that uses them. */
std::vector<const ConvexHull *> distinct_hulls(const Scene &scene)
{
  std::vector<const ConvexHull *> hulls;
  for (const Shape &shape : scene.shapes) add_hull(hulls, shape);
  return hulls;
}

uint32_t corners_of(const ConvexHull &hull)
{
  size_t corners = 0;
  for (const auto &face : hull.faces) corners += face.size();
  return static_cast<uint32_t>(corners);
}

struct Tables {
  std::vector<uint32_t> headers, face_starts, corners, edges, links;
  std::vector<float4> vertices, planes, chunks;

  void add(const ConvexHull &hull, const HullMaps &maps)
  {
    const auto size = [](const auto &list) { return static_cast<uint32_t>(list.size()); };
    for (uint32_t word :
         {size(vertices), size(hull.vertices), size(planes), size(hull.faces), size(edges) / 4, size(hull.edges),
          size(corners), corners_of(hull), size(chunks), size(links), maps.vertices, maps.faces})
      headers.push_back(word);
    for (const Vec3 &v : hull.vertices) vertices.push_back({v[0], v[1], v[2], 0});
    for (const HullPlane &p : hull.planes)
      planes.push_back({round_to_float(p.normal[0]), round_to_float(p.normal[1]), round_to_float(p.normal[2]),
                        round_to_float(p.distance)});
    for (const auto &face : hull.faces) {
      face_starts.push_back(size(corners));
      corners.insert(corners.end(), face.begin(), face.end());
    }
    for (const HullEdge &e : hull.edges) edges.insert(edges.end(), {e.v0, e.v1, e.face_left, e.face_right});
    append_chunks(chunks, std::span(vertices).last(hull.vertices.size()), 3);
    append_chunks(chunks, std::span(planes).last(hull.faces.size()), 4);
    chunks.push_back(middle_of(std::span(vertices).last(hull.vertices.size())));
    append_links(links, size(hull.vertices), hull.faces, std::span(edges).last(4 * hull.edges.size()));
    append_vertex_map(links, std::span(vertices).last(hull.vertices.size()), maps.vertices);
    append_face_map(links, std::span(planes).last(hull.faces.size()), chunks.back(), maps.faces);
  }
};

} // namespace

HullSizes hull_sizes(const Scene &scene, const HullMaps &maps)
{
  HullSizes sizes;
  const uint64_t cells = 6 * (uint64_t{maps.vertices} * maps.vertices + uint64_t{maps.faces} * maps.faces);
  for (const ConvexHull *hull : distinct_hulls(scene)) {
    ++sizes.hulls;
    sizes.vertices += hull->vertices.size();
    sizes.faces += hull->faces.size();
    sizes.edges += hull->edges.size();
    sizes.corners += corners_of(*hull);
    sizes.chunk_float4s += chunk_float4s(hull->vertices.size(), 3) + chunk_float4s(hull->faces.size(), 4) + 1;
    sizes.links += hull->vertices.size() + 1 + 2 * uint64_t{corners_of(*hull)} + cells;
  }
  return sizes;
}

HullNumbers hull_numbers(const Scene &scene)
{
  HullNumbers numbers;
  for (const ConvexHull *hull : distinct_hulls(scene)) numbers.emplace(hull, static_cast<uint32_t>(numbers.size()));
  return numbers;
}

void stage_hulls(StagedUploads &uploads, const Scene &scene, const HullMaps &maps)
{
  Tables tables;
  for (const ConvexHull *hull : distinct_hulls(scene)) tables.add(*hull, maps);
  tables.face_starts.push_back(static_cast<uint32_t>(tables.corners.size()));
  uploads.add(Buffer::hull_header, std::move(tables.headers));
  uploads.add(Buffer::hull_vertex, std::move(tables.vertices));
  uploads.add(Buffer::hull_plane, std::move(tables.planes));
  uploads.add(Buffer::hull_face_start, std::move(tables.face_starts));
  uploads.add(Buffer::hull_corner, std::move(tables.corners));
  uploads.add(Buffer::hull_edge, std::move(tables.edges));
  uploads.add(Buffer::hull_chunk, std::move(tables.chunks));
  uploads.add(Buffer::hull_link, std::move(tables.links));
}

} // namespace tandem
