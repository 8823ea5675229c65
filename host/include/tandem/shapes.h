/* shapes.h - vectors, shapes and the functions that build shapes; scene.h makes bodies of them.
 *
 * Units are SI, coordinates right-handed. Each shape is described in a frame of its own, which a body or a compound
 * places. Shapes are values: the hulls, meshes and compounds that copies of them share never change, also where worlds
 * of several threads have them.
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
using Point = std::array<double, 3>; /* world coordinates, m: 1,000 km from the origin, neighbouring floats are 6 cm
                                        apart */
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

/* Each is described in its own frame; sizes are in metres:
 *   sphere      size[0]: radius
 *   box         size: half extents
 *   half_space  all points with y <= 0 (its outward normal is +Y); size is ignored; never dynamic, without a pose of
 *               its own
 *   capsule     hull of two spheres on the Y axis. size: radius of the lower, half the distance of the centres, radius
 *               of the upper
 *   cylinder    along Y, between -size[1] and +size[1]; size[0]: radius of the lower end, size[2]: of the upper. One
 *               may be 0: a cone
 *   hull        `hull`; size is ignored
 *   mesh        the surface `mesh`; its triangles are counter-clockwise seen from outside, and contacts push outward.
 *               Size is ignored. A dynamic mesh should be closed (warnings_of), because its mass is computed as
 *               that of a closed solid
 *   compound    `compound`; size is ignored */
struct Shape {
  ShapeType type = ShapeType::box;
  Vec3 size{0.5f, 0.5f, 0.5f};
  std::shared_ptr<const ConvexHull> hull = nullptr; /* pointers: copies of a shape share these */
  std::shared_ptr<const TriangleMesh> mesh = nullptr;
  std::shared_ptr<const Compound> compound = nullptr;
};

/* A shape in a compound; neither a half-space nor another compound. Fields that are not set are taken from the body. */
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
} /* apex at +Y */
/* The convex hull of the points. Throws InputError as convex_hull of host/geometry/convex_hull.h does. */
TANDEM_API Shape hull_shape(std::span<const Vec3> points, const std::string &where);
/* A mesh of triangles, three indices each, counter-clockwise seen from outside. Throws InputError as triangle_mesh of
 * host/geometry/triangle_mesh.h does. */
TANDEM_API Shape mesh_shape(std::span<const Vec3> vertices, std::span<const uint32_t> indices,
                            const std::string &where);
/* A height field as a mesh: heights[z * columns + x] is at (x * spacing_x, height, z * spacing_z), with the grid
 * centred on the origin in x and z. Throws InputError if columns or rows are fewer than 2, or a height is not
 * finite. */
TANDEM_API Shape height_field_shape(std::span<const float> heights, uint32_t columns, float spacing_x, float spacing_z,
                                    const std::string &where);
TANDEM_API Shape compound_shape(std::vector<Child> children);
inline Shape half_space_shape() { return {ShapeType::half_space, {0, 0, 0}}; }

} // namespace tandem
