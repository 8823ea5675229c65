/* shapes.h - what bodies are made of: vectors, shapes and how they are built.
 *
 * Units are SI, coordinates right-handed. Each shape is described in a frame of its own; a body or a compound places
 * it.
 */
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tandem/export.h>

namespace tandem {

using Vec3 = std::array<float, 3>;
using Point = std::array<double, 3>; /* of the world, m: a float is 6 cm apart from the next 1,000 km away */
using Quat = std::array<float, 4>;   /* x y z w, unit length */

enum class ShapeType : uint32_t {
  sphere = 0,
  box = 1,
  half_space = 2,
  capsule = 3,
  cylinder = 4,
  hull = 5,
  mesh = 6,
  compound = 8
};

struct ConvexHull;   /* host/geometry/convex_hull.h */
struct TriangleMesh; /* host/geometry/triangle_mesh.h */
struct Compound;

/* In the shape's own frame:
 *   sphere      size[0]: radius
 *   box         size: half extents
 *   half_space  all points with y <= 0 (its outward normal is +Y); size is ignored; never dynamic, without a pose of
 *               its own
 *   capsule     hull of two spheres on the Y axis. size: radius of the lower, half the distance of the centres, radius
 *               of the upper
 *   cylinder    along Y, between -size[1] and +size[1]; size[0]: radius of the lower end, size[2]: of the upper. One
 *               may be 0: a cone
 *   hull        `hull`; size is ignored
 *   mesh        the surface `mesh`, solid on the side from which its triangles are seen clockwise: contacts push out on
 *               the other. Size is ignored. A dynamic one should be closed (warnings_of): else its mass is that of a
 *               solid that it is not
 *   compound    `compound`; size is ignored */
struct Shape {
  ShapeType type = ShapeType::box;
  Vec3 size{0.5f, 0.5f, 0.5f};
  std::shared_ptr<const ConvexHull> hull = nullptr; /* these are shared by the copies of a shape */
  std::shared_ptr<const TriangleMesh> mesh = nullptr;
  std::shared_ptr<const Compound> compound = nullptr;
};

/* A shape in a compound; not a half-space, nor another compound. What it leaves open is as its body says. */
struct Child {
  Shape shape;
  Vec3 position{0, 0, 0}; /* in the compound's frame */
  Quat orientation{0, 0, 0, 1};
  float density = 1.0f;             /* > 0, relative to the other children */
  std::optional<uint32_t> material; /* index into Scene::materials */
  std::optional<uint32_t> filter_group, filter_mask;
};

struct Compound {
  std::vector<Child> children;
};

inline Shape sphere_shape(float radius) { return {ShapeType::sphere, {radius, radius, radius}}; }
inline Shape box_shape(float x, float y, float z) { return {ShapeType::box, {x, y, z}}; } /* half extents */
inline Shape capsule_shape(float radius, float half_height)
{
  return {ShapeType::capsule, {radius, half_height, radius}};
}
inline Shape cylinder_shape(float radius, float half_height)
{
  return {ShapeType::cylinder, {radius, half_height, radius}};
}
inline Shape cone_shape(float radius, float half_height)
{
  return {ShapeType::cylinder, {radius, half_height, 0}};
} /* apex up */
/* InputError as convex_hull of host/geometry/convex_hull.h. */
TANDEM_API Shape hull_shape(std::span<const Vec3> points, const std::string &where);
/* InputError as triangle_mesh of host/geometry/triangle_mesh.h. Indices: three a triangle, counter-clockwise seen from
 * outside. */
TANDEM_API Shape mesh_shape(std::span<const Vec3> vertices, std::span<const uint32_t> indices,
                            const std::string &where);
/* A mesh of heights over a grid: heights[z * columns + x] at (x * spacing_x, height, z * spacing_z), centred on the
 * origin across. columns and rows: at least 2 each. InputError otherwise, and for heights that are not finite. */
TANDEM_API Shape height_field_shape(std::span<const float> heights, uint32_t columns, float spacing_x, float spacing_z,
                                    const std::string &where);
TANDEM_API Shape compound_shape(std::vector<Child> children);
inline Shape half_space_shape() { return {ShapeType::half_space, {0, 0, 0}}; }

} // namespace tandem
