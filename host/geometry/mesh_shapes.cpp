/* mesh_shapes.cpp - shapes of many parts: meshes, height fields as meshes, compounds. They are declared in
 * host/include/tandem/shapes.h. */
#include <cmath>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/geometry/triangle_mesh.h"

namespace tandem {
namespace {

/* Adds both triangles of a cell, counter-clockwise seen from above. */
void add_cell(std::vector<uint32_t> &indices, uint32_t corner, uint32_t columns)
{
  const uint32_t beside = corner + 1, below = corner + columns;
  indices.insert(indices.end(), {corner, below, beside, beside, below, below + 1});
}

} // namespace

Shape mesh_shape(std::span<const Vec3> vertices, std::span<const uint32_t> indices, const std::string &where)
{
  return {ShapeType::mesh,
          {0, 0, 0},
          nullptr,
          std::make_shared<const TriangleMesh>(triangle_mesh(vertices, indices, where))};
}

Shape height_field_shape(std::span<const float> heights, uint32_t columns, float spacing_x, float spacing_z,
                         const std::string &where)
{
  const size_t rows = columns > 0 ? heights.size() / columns : 0;
  if (columns < 2 || rows < 2 || rows * columns != heights.size())
    throw InputError(
        fmt::format("{}: {} heights in {} columns; at least 2 rows of at least 2 columns, all full, are needed", where,
                    heights.size(), columns));
  for (float spacing : {spacing_x, spacing_z})
    if (!(spacing > 0) || !std::isfinite(spacing))
      throw InputError(fmt::format("{}: the spacing is {}; a finite number above 0 is needed", where, spacing));
  std::vector<Vec3> vertices;
  std::vector<uint32_t> indices;
  for (size_t i = 0; i < heights.size(); ++i) {
    const double x = double(i % columns) - 0.5 * (columns - 1), z = double(i / columns) - 0.5 * double(rows - 1);
    vertices.push_back({round_to_float(x * spacing_x), heights[i], round_to_float(z * spacing_z)});
    if (i % columns + 1 < columns && i / columns + 1 < rows) add_cell(indices, static_cast<uint32_t>(i), columns);
  }
  return mesh_shape(vertices, indices, where);
}

Shape compound_shape(std::vector<Child> children)
{
  return {ShapeType::compound,
          {0, 0, 0},
          nullptr,
          nullptr,
          std::make_shared<const Compound>(Compound{std::move(children)})};
}

} // namespace tandem
