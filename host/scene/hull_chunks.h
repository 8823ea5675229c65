/* hull_chunks.h - the tables that follow from a hull's vertices, planes and faces: the chunks of shared/float8.h, and
 * the links of shared/narrowphase/hull_support.h. The functions are templates over a record of four numbers, because
 * the reference build has its own. */
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace tandem {

/* The number of float4s of so many entries of so many numbers each. */
inline uint32_t chunk_float4s(size_t entries, uint32_t numbers)
{
  return static_cast<uint32_t>((entries + 7) / 8) * 2 * numbers;
}

/* Appends the first 3 or 4 numbers of each entry, eight entries a chunk; the last chunk is padded with the first
 * entry. */
template <class Row>
void append_chunks(std::vector<Row> &chunks, std::span<const std::type_identity_t<Row>> entries, int numbers)
{
  const auto number = [&](size_t entry, int k) {
    const Row &r = entries[entry < entries.size() ? entry : 0];
    return k == 0 ? r.x : k == 1 ? r.y : k == 2 ? r.z : r.w;
  };
  for (size_t first = 0; first < entries.size(); first += 8)
    for (int k = 0; k < numbers; ++k)
      for (size_t half = first; half < first + 8; half += 4)
        chunks.push_back({number(half, k), number(half + 1, k), number(half + 2, k), number(half + 3, k)});
}

/* faces: corners of each; edges: from, to, left, right. A corner whose side is no edge (a flat hull) gets
 * INDEX_NONE. */
template <class Faces>
void append_links(std::vector<uint32_t> &links, uint32_t vertices, const Faces &faces, std::span<const uint32_t> edges)
{
  std::vector<std::vector<uint32_t>> faces_of(vertices);
  std::vector<uint32_t> edge_of_corner;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> edge_of;
  for (uint32_t e = 0; 4 * e < edges.size(); ++e)
    edge_of[{edges[4 * e], edges[4 * e + 1]}] = edge_of[{edges[4 * e + 1], edges[4 * e]}] = e;
  for (uint32_t f = 0; f < faces.size(); ++f)
    for (size_t c = 0; c < faces[f].size(); ++c) {
      const auto edge = edge_of.find({faces[f][c], faces[f][(c + 1) % faces[f].size()]});
      faces_of[faces[f][c]].push_back(f);
      edge_of_corner.push_back(edge == edge_of.end() ? ~0u : edge->second);
    }
  uint32_t start = vertices + 1;
  for (uint32_t v = 0; v < vertices; start += static_cast<uint32_t>(faces_of[v++].size())) links.push_back(start);
  links.push_back(start);
  for (const auto &list : faces_of) links.insert(links.end(), list.begin(), list.end());
  links.insert(links.end(), edge_of_corner.begin(), edge_of_corner.end());
}

/* The index of the entry with the highest score; of equal ones the lowest. */
template <class Row, class Score> uint32_t highest_of(std::span<Row> entries, const Score &score)
{
  uint32_t best = 0;
  double highest = -1e300;
  for (uint32_t k = 0; k < entries.size(); ++k)
    if (const double height = score(entries[k]); height > highest) highest = height, best = k;
  return best;
}

/* Appends for each cell of hull_support.h's cube of side x side x 6 what `look` returns for the direction through its
 * middle. */
template <class Look> void append_cube(std::vector<uint32_t> &links, uint32_t side, const Look &look)
{
  const auto middle = [&](uint32_t cell) { return 2.0 * (cell + 0.5) / side - 1.0; };
  for (uint32_t face = 0; face < 6; ++face)
    for (uint32_t v = 0; v < side; ++v)
      for (uint32_t u = 0; u < side; ++u) {
        std::array<double, 3> d{};
        d[face / 2] = face % 2 ? -1 : 1, d[(face / 2 + 1) % 3] = middle(u), d[(face / 2 + 2) % 3] = middle(v);
        links.push_back(look(d));
      }
}

inline double along(const auto &row, const std::array<double, 3> &d)
{
  return row.x * d[0] + row.y * d[1] + row.z * d[2];
}

/* Appends the map of the vertex farthest in a direction. */
template <class Row> void append_vertex_map(std::vector<uint32_t> &links, std::span<Row> vertices, uint32_t side)
{
  append_cube(links, side, [&](const std::array<double, 3> &d) {
    return highest_of(vertices, [&](const Row &vertex) { return along(vertex, d); });
  });
}

/* Appends the map of the face that a ray from the middle in a direction hits. */
template <class Row>
void append_face_map(std::vector<uint32_t> &links, std::span<Row> planes, const std::type_identity_t<Row> &middle,
                     uint32_t side)
{
  append_cube(links, side, [&](const std::array<double, 3> &d) {
    return highest_of(planes, [&](const Row &plane) {
      return along(plane, d) / (plane.w - along(plane, {middle.x, middle.y, middle.z}));
    });
  });
}

/* The mean of the vertices. */
template <class Row> Row middle_of(std::span<Row> vertices)
{
  double x = 0, y = 0, z = 0;
  for (const Row &v : vertices) x += v.x, y += v.y, z += v.z;
  const double n = static_cast<double>(vertices.size());
  Row middle{};
  middle.x = static_cast<decltype(middle.x)>(x / n), middle.y = static_cast<decltype(middle.y)>(y / n),
  middle.z = static_cast<decltype(middle.z)>(z / n);
  return middle;
}

} // namespace tandem
