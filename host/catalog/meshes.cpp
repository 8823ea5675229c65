/* meshes.cpp - the scenes of meshes.h: hulls in a hilly bowl, compounds in a yard, and bodies that slide over a
 * mesh. */
#include "host/catalog/meshes.h"

#include <algorithm>
#include <cmath>

#include <tandem/round_to_float.h>

#include "host/base/trigonometry.h"
#include "host/catalog/builders.h"
#include "host/geometry/shape_mass.h"

namespace tandem {

using namespace scene_builders;

namespace {

/* Sets the mass from the volume and a density in kg / m^3. */
void finish_body(Scene &scene, Body &body, double density)
{
  take_mass_properties(scene, body);
  body.mass = round_to_float(density * mass_properties_of(scene.shapes[body.shape]).mass);
}

/* --- hulls-on-mesh: stones in a hilly bowl ----------------------------------------------------------------- */

/* A height field on a square with this half side: waves, and a rim over the outer eighth. */
Shape bowl(double half_side, uint32_t columns)
{
  std::vector<float> heights;
  const double spacing = 2 * half_side / (columns - 1);
  for (uint32_t i = 0; i < columns * columns; ++i) {
    const double x = (i % columns) * spacing - half_side, z = (i / columns) * spacing - half_side;
    const double rim = std::max(0.0, std::max(std::abs(x), std::abs(z)) / half_side - 0.875) * 8;
    heights.push_back(
        round_to_float(0.4 * sine_cosine(1.1 * x).sine * sine_cosine(0.9 * z).cosine + 0.5 * half_side * rim * rim));
  }
  return height_field_shape(heights, columns, round_to_float(spacing), round_to_float(spacing), "bowl");
}

Scene hulls_on_mesh(const SceneValues &v)
{
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  for (uint32_t k = 0; k < 16; ++k) scene.shapes.push_back(stone(whole(v, "points"), random));
  const CellGrid grid{std::max<int64_t>(1, int64_t(std::ceil(std::sqrt(double(whole(v, "n")) / 4)))), 1.15, 1.6};
  const double half_side = (0.5 * double(grid.side) * grid.cell + 1) / 0.875;
  Body &ground = add_body(scene, add_shape(scene, bowl(half_side, uint32_t(2 * half_side / number(v, "spacing")) + 2)));
  ground.name = "bowl";
  ground.type = BodyType::fixed;
  for (int64_t i = 0; i < whole(v, "n"); ++i) {
    const uint32_t shape =
        random.below(16); /* drawn first, because the order of evaluation of arguments is unspecified */
    Body &body = add_body(scene, shape, grid.place(i, 0.05, random));
    body.orientation = random.orientation();
    finish_body(scene, body, 1000);
  }
  return scene;
}

/* --- compounds: furniture that falls into a yard --------------------------------------------------------------- */

Child part(const Shape &shape, const Vec3 &position)
{
  Child child;
  child.shape = shape;
  child.position = position;
  return child;
}

Shape table()
{
  std::vector<Child> children{part(box_shape(0.4f, 0.04f, 0.3f), {0, 0.3f, 0})};
  for (float x : {-0.34f, 0.34f})
    for (float z : {-0.24f, 0.24f}) children.push_back(part(cylinder_shape(0.04f, 0.15f), {x, 0.11f, z}));
  return compound_shape(std::move(children));
}

Shape dumbbell()
{
  Child bar = part(cylinder_shape(0.05f, 0.3f), {0, 0, 0});
  bar.orientation = {0, 0, 0.70710678f, 0.70710678f};
  return compound_shape({bar, part(sphere_shape(0.2f), {-0.35f, 0, 0}), part(sphere_shape(0.2f), {0.35f, 0, 0})});
}

Shape corner()
{
  return compound_shape({part(box_shape(0.4f, 0.1f, 0.1f), {0, 0, 0}),
                         part(box_shape(0.1f, 0.3f, 0.1f), {0.3f, 0.4f, 0}),
                         part(box_shape(0.1f, 0.1f, 0.3f), {-0.3f, 0, 0.4f})});
}

/* A ring of capsules. */
Shape ring()
{
  std::vector<Child> children;
  for (int k = 0; k < 8; ++k) {
    const double angle = k * 3.14159265358979 / 4;
    const SineCosine whole = sine_cosine(angle), half = sine_cosine(0.5 * angle);
    Child child =
        part(capsule_shape(0.08f, 0.16f), {round_to_float(0.38 * whole.cosine), 0, round_to_float(0.38 * whole.sine)});
    const double s = half.sine, c = half.cosine, root = std::sqrt(0.5); /* about y by -angle, after y onto z */
    child.orientation = {round_to_float(root * c), round_to_float(-root * s), round_to_float(root * s),
                         round_to_float(root * c)};
    children.push_back(child);
  }
  return compound_shape(std::move(children));
}

Scene compounds(const SceneValues &v)
{
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  scene.shapes = {table(), dumbbell(), corner(), ring()};
  CellGrid grid{cube_side(whole(v, "n")), 1.3, 0.8};
  add_ground(scene);
  add_walls(scene, 0.5 * grid.cell * double(grid.side) + 0.5);
  for (int64_t i = 0; i < whole(v, "n"); ++i) {
    Body &body = add_body(scene, uint32_t(i % 4), grid.place(i, 0.05, random));
    body.orientation = random.orientation();
    finish_body(scene, body, 600);
  }
  return scene;
}

/* --- mesh-slide: over the seams of a flat mesh --- */

/* A floor in y = 0 of unequal triangles: the inner vertices of a grid are displaced at random in the plane. */
Shape flat_mesh(double length, double width, double spacing, Random &random)
{
  const auto columns = uint32_t(length / spacing) + 2, rows = uint32_t(width / spacing) + 2;
  std::vector<Vec3> vertices;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < columns * rows; ++i) {
    const uint32_t column = i % columns, row = i / columns;
    const bool inside = column > 0 && row > 0 && column + 1 < columns && row + 1 < rows;
    const double jitter = inside ? 0.2 * spacing : 0; /* too small to invert a triangle */
    vertices.push_back({round_to_float(column * spacing + random.uniform(-jitter, jitter)), 0,
                        round_to_float((row - 0.5 * (rows - 1)) * spacing + random.uniform(-jitter, jitter))});
    if (column + 1 < columns && row + 1 < rows)
      indices.insert(indices.end(), {i, i + columns, i + 1, i + 1, i + columns, i + columns + 1});
  }
  return mesh_shape(vertices, indices, "floor");
}

Scene mesh_slide(const SceneValues &v)
{
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = round_to_float(number(v, "friction"));
  const double speed = number(v, "speed");
  Body &floor = add_body(scene, add_shape(scene, flat_mesh(5 + 5 * speed, 10, 0.4, random)), {-2, 0, 0});
  floor.name = "floor";
  floor.type = BodyType::fixed;
  const Shape sliders[] = {sphere_shape(0.3f),
                           box_shape(0.3f, 0.3f, 0.3f),
                           box_shape(0.5f, 0.05f, 0.4f),
                           capsule_shape(0.2f, 0.3f),
                           cylinder_shape(0.3f, 0.2f),
                           stone(24, random),
                           corner(),
                           table()};
  for (size_t k = 0; k < std::size(sliders); ++k) {
    const uint32_t shape = add_shape(scene, sliders[k]);
    Body &body = add_body(scene, shape,
                          {0,
                           sliders[k].type == ShapeType::compound ? 0.3
                           : sliders[k].type == ShapeType::hull   ? 0.5
                                                                  : double(sliders[k].size[1]),
                           1.2 * (double(k) - 3.5)},
                          10);
    if (sliders[k].type == ShapeType::sphere) body.position[1] = 0.3;
    if (sliders[k].type == ShapeType::capsule) body.orientation = {0.70710678f, 0, 0, 0.70710678f};
    if (sliders[k].type == ShapeType::capsule) body.position[1] = 0.2;
    body.linear_velocity = {round_to_float(speed), 0, 0};
    take_mass_properties(scene, body);
  }
  return scene;
}

} // namespace

std::vector<BuiltInScene> mesh_scenes()
{
  const double most = double(most_bodies - 5);
  return {
      {"hulls-on-mesh",
       "random convex hulls that fall into a hilly bowl, a triangle mesh",
       {{"n", integer, 1000, 1, most, "hulls"},
        {"points", integer, 32, 4, 1000, "vertices of a hull"},
        {"spacing", real, 0.4, 0.05, 10, "edge of the mesh's cells, m"},
        seed_parameter()},
       ground_and_n,
       hulls_on_mesh},
      {"compounds",
       "tables, dumbbells, corners and rings that fall into a yard",
       {{"n", integer, 500, 1, most, "compounds"}, seed_parameter()},
       [](const SceneValues &v) { return 5 + uint64_t(whole(v, "n")); },
       compounds},
      {"mesh-slide",
       "eight shapes slide over the seams of a flat mesh",
       {{"speed", real, 5, 0, 100, "m/s"}, {"friction", real, 0, 0, 10, "of all surfaces"}, seed_parameter()},
       [](const SceneValues &) { return uint64_t{9}; },
       mesh_slide},
  };
}

} // namespace tandem
